// The reactions over the last seconds of motion: a lane each, with a scale of its own.
(() => {
    const SECONDS = 8;
    const LANES = [['f0x', 'mN', 1e3, []], ['f0y', 'mN', 1e3, [7, 4]], ['m0z', 'N mm', 1e3, [2, 4]]];

    /// With about two digits.
    const short = value => value === 0 ? '0' : String(Number(value.toPrecision(2)));

    (globalThis.playground ??= {}).Chart = class Chart {
        #canvas;
        #pen;
        #width;
        #height;
        #colour;
        #rows = [];

        constructor(canvas) {
            this.#canvas = canvas;
            this.fit();
        }

        fit() {
            const surface = globalThis.playground.surface(this.#canvas);
            [this.#pen, this.#width, this.#height, this.#colour] = [surface.pen, surface.width, surface.height, surface.colour];
        }

        add(seconds, reactions) {
            this.#rows.push([seconds, ...reactions]);
            while (this.#rows[0][0] < seconds - SECONDS) this.#rows.shift();
        }

        clear() {
            this.#rows = [];
        }

        draw(seconds) {
            const pen = this.#pen, tall = this.#height / LANES.length;
            pen.clearRect(0, 0, this.#width, this.#height);
            pen.font = '11px system-ui, sans-serif';
            LANES.forEach(([name, unit, factor, dash], lane) => {
                const head = lane * tall + 12, top = head + 5, bottom = (lane + 1) * tall - 4;
                const values = this.#rows.map(row => row[lane + 1] * factor);
                const [low, high] = [Math.min(0, ...values), Math.max(0, ...values)];
                // a rod that was free all the time has a line at zero
                const y = value => bottom - (value - low) / (high - low || 1) * (bottom - top);
                pen.setLineDash([]);
                pen.lineWidth = 1;
                pen.strokeStyle = this.#colour('line');
                pen.beginPath();
                pen.moveTo(0, y(0));
                pen.lineTo(this.#width, y(0));
                pen.stroke();
                pen.setLineDash(dash);
                pen.lineWidth = 2;
                pen.strokeStyle = this.#colour(name);
                pen.beginPath();
                this.#rows.forEach((row, index) => {
                    const x = this.#width * (1 - (seconds - row[0]) / SECONDS);
                    if (index) pen.lineTo(x, y(values[index])); else pen.moveTo(x, y(values[index]));
                });
                pen.stroke();
                pen.fillStyle = this.#colour('text');
                pen.fillText(`${name}, ${unit}`, 2, head);
                pen.fillStyle = this.#colour('faint');
                const range = `${short(low)} to ${short(high)}`;
                pen.fillText(range, this.#width - pen.measureText(range).width - 2, head);
            });
            pen.setLineDash([]);
        }
    };
})();
