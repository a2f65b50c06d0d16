// Numbers and texts beside the drawing.
(() => {
    const { inUnits, stiffness } = globalThis.playground;
    const id = name => document.getElementById(name);
    /// Only what changes is written: a screen reader speaks each change.
    const put = (element, text) => { if (element.textContent !== text) element.textContent = text; };

    const CONTACTS = { tangent: '● side (B)', tip: '▲ tip (A)', corner: '◆ corner', notch: '■ notch' };
    const MODES = { 'slip+': ', slips', 'slip-': ', slips', stick: ', sticks' };

    /// Sliders: a step of what they show in SI units, and the label of a value that they show.
    const SLIDERS = {
        length: [1e-3, value => `${value} mm`],
        diameter: [1e-3, (value, rod) => `${value.toFixed(2)} mm, EI ${(stiffness(rod) * 1e6).toPrecision(3)} N mm²`],
        taper: [1, value => value === 1 ? 'no taper' : value.toFixed(2)],
        curvature: [1, value => value === 0 ? 'straight' : `${value} /m`],
        friction: [1, value => value === 0 ? 'none' : value.toFixed(2)],
    };

    function phaseText(phase) {
        if (phase === 'free') return 'no contact';
        const tip = phase.endsWith('A'), sides = phase.length - (tip ? 1 : 0);
        const side = sides === 0 ? '' : sides === 1 ? 'one contact along the side' : `${sides} contacts along the side`;
        return [side, tip ? 'the tip touches' : ''].filter(Boolean).join(', ');
    }

    /// In thousandths, without a sign of zero.
    const milli = value => (value * 1e3).toFixed(2).replace(/^-(0\.0+)$/, '$1');

    function item(text, note = '') {
        const element = document.createElement('li'), small = document.createElement('small');
        element.textContent = text;
        small.textContent = note;
        element.append(small);
        return element;
    }

    globalThis.playground.Panel = class Panel {
        /// Calls `change(name, value)` with a value in SI units when a slider moves.
        constructor(change) {
            for (const [name, [unit]] of Object.entries(SLIDERS)) {
                // the product has digits of rounding, which would stand in files
                id(name).addEventListener('input', () => change(name, Number((id(name).value * unit).toPrecision(6))));
            }
        }

        say(text) {
            put(id('message'), text);
        }

        scene({ object, rod }) {
            for (const [name, [unit, label]] of Object.entries(SLIDERS)) {
                const value = Number((rod[name] / unit).toPrecision(6));
                id(name).value = value;
                put(id(name).parentElement.querySelector('output'), label(value, rod));
                id(name).setAttribute('aria-valuetext', label(value, rod));
            }
            id('object').value = object;
        }

        state({ phase, pose: [x, y, phi], reactions, contacts }) {
            ['f0x', 'f0y', 'm0z'].forEach((name, index) => put(id(name), milli(reactions[index])));
            put(id('xy'), `${(x * 1e3).toFixed(1)}, ${(y * 1e3).toFixed(1)}`);
            put(id('phi'), (phi * 180 / Math.PI).toFixed(1));
            put(id('phase'), phase);
            put(id('phase-text'), phaseText(phase));
            put(id('spoken'), `Phase ${phase}: ${phaseText(phase)}`);
            id('contacts').replaceChildren(...contacts.map(({ kind, force, s, mode }) =>
                item(`${CONTACTS[kind] ?? kind}: ${inUnits(force)} at ${(s * 1e3).toFixed(1)} mm${MODES[mode] ?? ''}`)));
        }

        events(events) {
            id('events').replaceChildren(...events.map(({ kind, from, to, pose }) =>
                item(`${kind}: ${from} → ${to} `, `x ${(pose[0] * 1e3).toFixed(1)} mm`)));
        }

        recording(rows, isRecording) {
            put(id('recorded'), `${rows} samples`);
            if ((id('record').getAttribute('aria-pressed') === 'true') === isRecording) return;
            id('record').setAttribute('aria-pressed', isRecording);
            put(id('record'), isRecording ? '■ Stop' : '● Record');
            id('csv').disabled = isRecording;
        }
    };
})();
