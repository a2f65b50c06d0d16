// How a script moves the rod, and whether the answers are right: the curve that starts at the clamp with the reactions must pass
// through the contact with the slope of the parabola, and be straight beyond it. Runge-Kutta, which the library does not use.
import assert from 'node:assert/strict';
import { readFileSync } from 'node:fs';
import { test } from 'node:test';

const file = new URL('target/wasm32-unknown-unknown/release/browser.wasm', import.meta.url);
const compiled = new WebAssembly.Module(readFileSync(process.env.BROWSER_WASM ?? file));
const UP = Math.PI / 2; // slope angle at the clamp, rad
const STIFFNESS = 206e9 * Math.PI * 0.5e-3 ** 4 / 64; // N m^2
const LENGTH = 0.1; // m
const COEFFICIENT = 50; // 1/m

function rod() {
    const wasm = new WebAssembly.Instance(compiled, {}).exports;
    const numbers = (pointer, n) => Array.from(new Float64Array(wasm.memory.buffer, pointer, n));
    return {
        place: wasm.place,
        to: wasm.to,
        reactions: () => numbers(wasm.reactions(), 3),
        contacts: n => numbers(wasm.contacts(), 4 * n),
        shape: () => numbers(wasm.shape(), 202),
        message: () => new TextDecoder().decode(new Uint8Array(wasm.memory.buffer, wasm.message(), wasm.message_length())),
    };
}

/// Slope angle, curvature (1/m) and position (m) at arc length s of the rod with these reactions.
function integrate([x, y, phi], [f0x, f0y, m0z], s) {
    const rate = ([, , phi, kappa]) =>
        [Math.cos(phi), Math.sin(phi), kappa, (f0y * Math.cos(phi) - f0x * Math.sin(phi)) / STIFFNESS];
    const along = (u, k, h) => u.map((value, i) => value + h * k[i]);
    const steps = 2000, h = s / steps;
    let u = [x, y, phi, -m0z / STIFFNESS];
    for (let step = 0; step < steps; step++) {
        const a = rate(u), b = rate(along(u, a, h / 2)), c = rate(along(u, b, h / 2)), d = rate(along(u, c, h));
        u = u.map((value, i) => value + h / 6 * (a[i] + 2 * b[i] + 2 * c[i] + d[i]));
    }
    return { x: u[0], y: u[1], phi: u[2], kappa: u[3] };
}

const close = (value, expected, scale) =>
    assert.ok(Math.abs(value - expected) <= 1e-11 * scale, `${value} is not ${expected}`);

test('it imports nothing', () => assert.deepEqual(WebAssembly.Module.imports(compiled), []));

test('the rod bends around the parabola', () => {
    const wire = rod();
    assert.equal(wire.place(0.05, -0.04, UP), 0);
    const phases = [];
    for (let x = 0.05; x > -0.03; x -= 1e-3) {
        const contacts = wire.to(x, -0.04, UP);
        phases.push(contacts);
        if (contacts === 0) continue;
        assert.equal(contacts, 1, wire.message());
        const [s, cx, cy, force] = wire.contacts(1);
        assert.ok(force > 0 && s <= LENGTH);
        const end = integrate([x, -0.04, UP], wire.reactions(), s);
        close(end.x, cx, LENGTH);
        close(end.y, cy, LENGTH);
        close(end.kappa, 0, 1 / LENGTH);
        close(cy, COEFFICIENT * cx ** 2, LENGTH);
        // beyond a contact along its side the rod is straight, with the parabola's slope
        const shape = wire.shape();
        close(shape[200], end.x + (LENGTH - s) * Math.cos(end.phi), LENGTH);
        close(shape[201], end.y + (LENGTH - s) * Math.sin(end.phi), LENGTH);
        if (s < LENGTH * (1 - 1e-9)) close(Math.sin(end.phi), 2 * COEFFICIENT * cx * Math.cos(end.phi), 1);
    }
    assert.ok(phases.includes(0) && phases.includes(1));
});

test('a stop says why, and the rod stays', () => {
    const wire = rod();
    assert.equal(wire.to(0, 0, UP), -1);
    assert.match(wire.message(), /place first/);
    assert.equal(wire.place(0, 0.1, UP), -1);
    assert.match(wire.message(), /inside/);
    assert.equal(wire.place(0.05, -0.04, UP), 0);
    assert.equal(wire.to(NaN, -0.04, UP), -1);
    assert.equal(wire.to(0.02, -0.04, UP), 1);
    assert.ok(wire.reactions().every(Number.isFinite));
});
