// The rod in WebAssembly as an object of JavaScript. A scene is plain data: see scene.js.
(globalThis.playground ??= {}).Rod = class Rod {
    /// The module keeps some kB of each scene, so another instance follows after so many.
    static SCENES_OF_AN_INSTANCE = 50;

    #compiled;
    #wasm;
    #scenes = Infinity;

    /// `compiled` is a WebAssembly.Module.
    constructor(compiled) {
        this.#compiled = compiled;
    }

    /// The scene with the clamp at `pose`: { state, outlines }. Throws an Error with the reason, and is without a rod then.
    build({ shapes, rod }, pose) {
        if (this.#scenes++ >= Rod.SCENES_OF_AN_INSTANCE) {
            this.#wasm = new WebAssembly.Instance(this.#compiled, {}).exports;
            this.#scenes = 1;
        }
        this.#call('clear');
        let joined = true;
        for (const shape of shapes) {
            if (shape.shape === 'polygon') {
                for (const [x, y] of shape.points) this.#call('corner', x, y);
                this.#call('polygon');
            } else if (shape.shape === 'disc') {
                this.#call('disc', ...shape.center, shape.radius);
                this.#call('join');
            } else {
                this.#call('parabola', ...shape.vertex, shape.coefficient);
                joined = false;
            }
        }
        // parabolas are one contour, as in the paper
        if (!joined) this.#call('join');
        this.#call('rod', rod.length, rod.diameter, rod.modulus, rod.taper, rod.curvature, rod.friction);
        return { outlines: this.#call('outlines'), state: this.#call('place', ...pose) };
    }

    /// The state after the clamp has moved straight to `pose`. Throws an Error with the reason; the rod then stays where it was.
    moveTo(pose) {
        return this.#call('move_to', ...pose);
    }

    #call(name, ...numbers) {
        const status = this.#wasm[name](...numbers);
        const bytes = new Uint8Array(this.#wasm.memory.buffer, this.#wasm.answer(), this.#wasm.answer_length());
        const text = new TextDecoder().decode(bytes);
        const answer = text === '' ? null : JSON.parse(text);
        if (status !== 0) throw new Error(answer.failure);
        return answer;
    }
};
