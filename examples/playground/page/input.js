// Pointer and keys on the canvas, as wishes: where the clamp shall be, or a handle of the object.
(() => {
    /// A finger is as wide as this, px.
    const NEAR = { touch: 30, pen: 22, mouse: 16 };
    /// Speeds with keys: m/s and rad/s, and what a single press does at least.
    const SPEED = 0.05, TURN = 1, TAP = 0.4e-3, TAP_TURN = 0.01;
    const ARROWS = { ArrowLeft: [-1, 0], ArrowRight: [1, 0], ArrowUp: [0, 1], ArrowDown: [0, -1] };

    const apart = ([ax, ay], [bx, by]) => Math.hypot(ax - bx, ay - by);

    /// `wishes` has pose(), moveClamp(dx, dy), moveChosen(dx, dy), turnTo(angle), turn(angle), handles(), moveHandle(index, point), press(key,
    /// shift).
    (globalThis.playground ??= {}).Input = class Input {
        #view;
        #canvas;
        #wishes;
        #held = new Map();
        #drag;

        constructor(canvas, view, wishes) {
            [this.#canvas, this.#view, this.#wishes] = [canvas, view, wishes];
            canvas.addEventListener('pointerdown', event => this.#down(event));
            canvas.addEventListener('pointermove', event => this.#move(event));
            for (const end of ['pointerup', 'pointercancel', 'lostpointercapture']) canvas.addEventListener(end, event => this.#up(event));
            canvas.addEventListener('keydown', event => this.#key(event));
            canvas.addEventListener('keyup', event => this.#held.delete(event.key));
            canvas.addEventListener('blur', () => this.#held.clear());
        }

        /// Held keys move the clamp, or the handle that keys have chosen, by so much in `seconds`.
        frame(seconds) {
            for (const [key, { shift, slow }] of this.#held) this.#go(key, shift, seconds * (slow ? 0.1 : 1));
        }

        #go(key, shift, seconds, least = [0, 0]) {
            const [x, y] = ARROWS[key];
            const way = Math.max(least[0], SPEED * seconds);
            if (!shift) this.#wishes.moveChosen(x * way, y * way);
            // counterclockwise to the left, as the whisker tilts
            else this.#wishes.turn((y - x) * Math.max(least[1], TURN * seconds));
        }

        #key(event) {
            if (event.ctrlKey || event.metaKey) return;
            if (event.key in ARROWS) {
                // the first press moves by a little at once; what is held goes on with the frames
                if (!event.repeat) {
                    const slow = event.altKey ? 0.1 : 1;
                    this.#go(event.key, event.shiftKey, 0, [TAP * slow, TAP_TURN * slow]);
                }
                this.#held.set(event.key, { shift: event.shiftKey, slow: event.altKey });
            } else if (event.repeat || !this.#wishes.press(event.key.toLowerCase(), event.shiftKey)) {
                return;
            }
            event.preventDefault();
        }

        #at(event) {
            const box = this.#canvas.getBoundingClientRect();
            return [event.clientX - box.left - this.#canvas.clientLeft, event.clientY - box.top - this.#canvas.clientTop];
        }

        #down(event) {
            if (this.#drag || event.button !== 0) return;
            const at = this.#at(event), near = NEAR[event.pointerType] ?? NEAR.mouse;
            const handles = this.#wishes.handles().map(handle => apart(this.#view.toPixels(handle), at));
            const handle = handles.indexOf(Math.min(...handles));
            this.#drag = { pointer: event.pointerId, at, kind: 'clamp' };
            if (handle >= 0 && handles[handle] < near) Object.assign(this.#drag, { kind: 'handle', handle });
            else if (apart(this.#view.knob(this.#wishes.pose()), at) < near) this.#drag.kind = 'knob';
            this.#canvas.setPointerCapture(event.pointerId);
            this.#canvas.classList.add('dragging');
            this.#canvas.focus({ preventScroll: true });
            event.preventDefault();
        }

        #move(event) {
            const drag = this.#drag;
            if (!drag || drag.pointer !== event.pointerId) return;
            const at = this.#at(event);
            if (drag.kind === 'handle') {
                this.#wishes.moveHandle(drag.handle, this.#view.toMetres(at));
            } else if (drag.kind === 'knob') {
                const [x, y] = this.#view.toPixels(this.#wishes.pose());
                // the knob is behind the clamp; y goes down on the canvas
                this.#wishes.turnTo(Math.atan2(at[1] - y, x - at[0]));
            } else {
                this.#wishes.moveClamp((at[0] - drag.at[0]) / this.#view.scale, (drag.at[1] - at[1]) / this.#view.scale);
            }
            drag.at = at;
        }

        #up(event) {
            if (this.#drag?.pointer !== event.pointerId) return;
            this.#drag = undefined;
            this.#canvas.classList.remove('dragging');
            this.#wishes.released();
        }
    };
})();
