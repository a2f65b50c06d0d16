// The scene on a canvas: object, whisker, clamp, contacts with their forces, and the points that the reactions give.
(() => {
    /// Half of the width that is shown, and the middle of it, m.
    const HALF_WIDTH = 0.128, MIDDLE = [0, -0.015];
    /// From the clamp back to the knob that turns it, px.
    const KNOB = 46;
    /// Length of an arrow of a force of EI/L^2, px; arrows grow as the root of the force, so that small ones are seen.
    const ARROW = 42;
    const GHOST_MS = 450;

    const MARKS = {
        tangent: (pen, x, y, r) => pen.arc(x, y, r, 0, 2 * Math.PI),
        tip: (pen, x, y, r) => polygon(pen, [[x, y - 1.3 * r], [x + 1.2 * r, y + r], [x - 1.2 * r, y + r]]),
        corner: (pen, x, y, r) => polygon(pen, [[x, y - 1.4 * r], [x + 1.4 * r, y], [x, y + 1.4 * r], [x - 1.4 * r, y]]),
        notch: (pen, x, y, r) => pen.rect(x - r, y - r, 2 * r, 2 * r),
    };

    /// The same marks in text.
    const SIGNS = { tangent: '●', tip: '▲', corner: '◆', notch: '■' };

    function polygon(pen, points) {
        points.forEach(([x, y], index) => index ? pen.lineTo(x, y) : pen.moveTo(x, y));
        pen.closePath();
    }

    function mark(pen, kind, x, y, radius) {
        pen.beginPath();
        (MARKS[kind] ?? MARKS.tangent)(pen, x, y, radius);
    }

    (globalThis.playground ??= {}).View = class View {
        #canvas;
        #pen;
        #scale;
        #width;
        #height;
        #colour;
        #ghost;
        /// Where the labels of this frame are.
        #labels = [];

        constructor(canvas) {
            this.#canvas = canvas;
            this.fit();
        }

        /// Takes size and colours from the page again.
        fit() {
            const surface = globalThis.playground.surface(this.#canvas);
            [this.#pen, this.#width, this.#height, this.#colour] = [surface.pen, surface.width, surface.height, surface.colour];
            this.#scale = this.#width / (2 * HALF_WIDTH);
        }

        toPixels([x, y]) {
            return [this.#width / 2 + (x - MIDDLE[0]) * this.#scale, this.#height / 2 - (y - MIDDLE[1]) * this.#scale];
        }

        toMetres([x, y]) {
            return [MIDDLE[0] + (x - this.#width / 2) / this.#scale, MIDDLE[1] - (y - this.#height / 2) / this.#scale];
        }

        /// Pixels in a metre.
        get scale() {
            return this.#scale;
        }

        knob([x, y, phi]) {
            const [px, py] = this.toPixels([x, y]);
            return [px - KNOB * Math.cos(phi), py + KNOB * Math.sin(phi)];
        }

        /// The whisker has jumped from this shape.
        jumped(shape, now) {
            this.#ghost = { shape, since: now };
        }

        draw({ state, outlines, trail, handles, chosen, hidden, unit, diameters }, now) {
            const pen = this.#pen;
            pen.clearRect(0, 0, this.#width, this.#height);
            pen.lineJoin = pen.lineCap = 'round';
            this.#grid();
            if (!hidden) for (const outline of outlines) this.#object(outline);
            for (const point of trail) this.#recovered(point);
            handles.forEach((handle, index) => this.#handle(handle, index === chosen));
            this.#fade(now);
            this.#whisker(state.shape, diameters);
            this.#clamp(state.pose);
            this.#labels = [];
            for (const contact of state.contacts) this.#contact(contact, unit);
            this.#ruler();
        }

        #path(numbers) {
            this.#pen.beginPath();
            for (let k = 0; k < numbers.length; k += 2) {
                const [x, y] = this.toPixels([numbers[k], numbers[k + 1]]);
                if (k) this.#pen.lineTo(x, y); else this.#pen.moveTo(x, y);
            }
        }

        #grid() {
            const pen = this.#pen, [left, top] = this.toMetres([0, 0]), [right, bottom] = this.toMetres([this.#width, this.#height]);
            pen.strokeStyle = this.#colour('grid');
            pen.lineWidth = 1;
            pen.beginPath();
            for (let cm = Math.ceil(left * 100); cm <= right * 100; cm++) {
                const [x] = this.toPixels([cm / 100, 0]);
                pen.moveTo(x, 0);
                pen.lineTo(x, this.#height);
            }
            for (let cm = Math.ceil(bottom * 100); cm <= top * 100; cm++) {
                const [, y] = this.toPixels([0, cm / 100]);
                pen.moveTo(0, y);
                pen.lineTo(this.#width, y);
            }
            pen.stroke();
        }

        #ruler() {
            const pen = this.#pen, y = this.#height - 14;
            pen.strokeStyle = pen.fillStyle = this.#colour('faint');
            pen.lineWidth = 2;
            pen.beginPath();
            pen.moveTo(14, y);
            pen.lineTo(14 + 0.02 * this.#scale, y);
            pen.stroke();
            this.#text('20 mm', 14, y - 6);
        }

        #text(text, x, y) {
            this.#pen.font = '12px system-ui, sans-serif';
            this.#pen.fillText(text, x, y);
        }

        /// A label inside the canvas, further down where another one is in its way.
        #label(text, x, y) {
            const left = Math.min(Math.max(4, x), this.#width - 76);
            // below what it would cover where it does not fit beside
            let line = Math.min(Math.max(14, left === x ? y : y + 18), this.#height - 24);
            while (this.#labels.some(([ax, ay]) => Math.abs(ax - left) < 76 && Math.abs(ay - line) < 14)) line += 14;
            this.#labels.push([left, line]);
            this.#text(text, left, line);
        }

        #object(outline) {
            const pen = this.#pen;
            this.#path(outline);
            pen.fillStyle = this.#colour('object');
            pen.fill();
            pen.strokeStyle = this.#colour('edge');
            pen.lineWidth = 1.5;
            pen.stroke();
        }

        #recovered({ x, y, kind, found }) {
            const pen = this.#pen, [px, py] = this.toPixels([x, y]);
            if (found) {
                mark(pen, kind, px, py, kind === 'tip' ? 2.4 : 2.2);
                pen.fillStyle = this.#colour('trail');
                pen.fill();
                return;
            }
            pen.strokeStyle = this.#colour('cross');
            pen.lineWidth = 1.2;
            pen.beginPath();
            for (const side of [-1, 1]) {
                pen.moveTo(px - 3, py - 3 * side);
                pen.lineTo(px + 3, py + 3 * side);
            }
            pen.stroke();
        }

        #handle(at, isChosen) {
            const pen = this.#pen, [x, y] = this.toPixels(at);
            mark(pen, 'notch', x, y, isChosen ? 8 : 5);
            pen.fillStyle = this.#colour(isChosen ? 'edge' : 'page');
            pen.fill();
            pen.strokeStyle = this.#colour('edge');
            pen.lineWidth = 2;
            pen.stroke();
        }

        #fade(now) {
            if (!this.#ghost) return;
            const age = (now - this.#ghost.since) / GHOST_MS;
            if (age >= 1) {
                this.#ghost = undefined;
                return;
            }
            const pen = this.#pen;
            pen.globalAlpha = 1 - age;
            pen.strokeStyle = this.#colour('ghost');
            pen.lineWidth = 3;
            this.#path(this.#ghost.shape);
            pen.stroke();
            pen.globalAlpha = 1;
        }

        /// A ribbon from base to tip, whose width shows the taper.
        #whisker(shape, [base, tip]) {
            const pen = this.#pen, last = shape.length / 2 - 1;
            pen.strokeStyle = this.#colour('rod');
            if (base === tip) {
                pen.lineWidth = base;
                this.#path(shape);
                pen.stroke();
                return;
            }
            const parts = 12;
            for (let part = 0; part < parts; part++) {
                const from = Math.floor(part * last / parts), to = Math.floor((part + 1) * last / parts);
                pen.lineWidth = Math.max(1, base + (tip - base) * (part + 0.5) / parts);
                this.#path(shape.slice(2 * from, 2 * to + 2));
                pen.stroke();
            }
        }

        #clamp(pose) {
            const pen = this.#pen, [x, y] = this.toPixels(pose), [kx, ky] = this.knob(pose);
            pen.strokeStyle = pen.fillStyle = this.#colour('clamp');
            pen.lineWidth = 2;
            pen.beginPath();
            pen.moveTo(x, y);
            pen.lineTo(kx, ky);
            pen.stroke();
            pen.save();
            pen.translate(x, y);
            pen.rotate(-pose[2]);
            pen.fillRect(-20, -9, 20, 18);
            pen.restore();
            pen.beginPath();
            pen.arc(kx, ky, 8, 0, 2 * Math.PI);
            pen.fillStyle = this.#colour('page');
            pen.fill();
            pen.stroke();
        }

        #contact({ kind, x, y, alpha, force, friction }, unit) {
            const pen = this.#pen, [px, py] = this.toPixels([x, y]);
            const [fx, fy] = [force * Math.sin(alpha) + friction * Math.cos(alpha), friction * Math.sin(alpha) - force * Math.cos(alpha)];
            const size = Math.hypot(fx, fy);
            pen.strokeStyle = pen.fillStyle = this.#colour('force');
            if (size > 0) {
                const length = 10 + ARROW * Math.sqrt(size / unit), [ux, uy] = [fx / size, -fy / size];
                const [ex, ey] = [px + length * ux, py + length * uy];
                pen.lineWidth = 2.5;
                pen.beginPath();
                pen.moveTo(px, py);
                pen.lineTo(ex - 7 * ux, ey - 7 * uy);
                pen.stroke();
                pen.beginPath();
                polygon(pen, [[ex, ey], [ex - 9 * ux + 5 * uy, ey - 9 * uy - 5 * ux], [ex - 9 * ux - 5 * uy, ey - 9 * uy + 5 * ux]]);
                pen.fill();
                this.#label(`${SIGNS[kind] ?? ''} ${globalThis.playground.inUnits(size)}`, ex + 8 * ux + (ux < 0 ? -66 : 6), ey + 4 + 10 * uy);
            }
            mark(pen, kind, px, py, 5.5);
            pen.fill();
            pen.strokeStyle = this.#colour('page');
            pen.lineWidth = 1.5;
            pen.stroke();
        }
    };

    /// A force with its unit.
    globalThis.playground.inUnits = force => force >= 1 ? `${force.toFixed(2)} N`
        : force >= 1e-3 ? `${(force * 1e3).toFixed(force < 1e-2 ? 2 : 1)} mN` : `${(force * 1e6).toFixed(0)} µN`;
})();
