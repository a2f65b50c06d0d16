// The scripts of the page without a browser: the rod against the states of the library, the files that the page saves, and what it loads.
//   PLAYGROUND_WASM     the module, if it is not in target/
//   PLAYGROUND_STATES   states.jsonl of `vibrissa sweep scenes/O1_q40.toml`; without it the states are not compared
//   PLAYGROUND_SAVED    a folder for a saved scene and recording, which the command then reads
import assert from 'node:assert/strict';
import { execFileSync } from 'node:child_process';
import { mkdtempSync, readFileSync, readdirSync, rmSync, writeFileSync } from 'node:fs';
import { tmpdir } from 'node:os';
import { join } from 'node:path';
import { test } from 'node:test';
import { fileURLToPath } from 'node:url';

const here = name => new URL(name, import.meta.url);
const path = process.env.PLAYGROUND_WASM ?? here('target/wasm32-unknown-unknown/release/playground.wasm');
const module = new WebAssembly.Module(readFileSync(path));
for (const script of ['rod.js', 'scene.js', 'recording.js']) await import(here(`page/${script}`));
const { Rod, Recording, OBJECTS, WIRE, preset, toText, fromText, toHash, fromHash, toToml, fromToml, isSameEquilibrium, isContact } = globalThis.playground;
const scene = (object, rod = {}) => ({ ...preset(object), rod: { ...WIRE, ...rod } });

/// The scan of the paper with so many states in a mm: all states, the events, and the recording of it.
function scan(dense = 1) {
    const rod = new Rod(module), states = [], events = [], recording = new Recording();
    const paper = scene('parabolas');
    states.push(rod.build(paper, paper.home).state);
    for (let step = 80 * dense - 1; step >= -90 * dense; step--) {
        const state = rod.moveTo([step / dense / 1e3, -0.04, Math.PI / 2]);
        states.push(state);
        events.push(...state.events);
    }
    states.forEach((state, index) => recording.add(index / 60, state));
    return { states, events, recording };
}

test('the module imports nothing', () => assert.deepEqual(WebAssembly.Module.imports(module), []));

test('the scan of the paper has its phases', () => {
    const { states, events } = scan();
    const phases = [states[0].phase, ...events.map(event => event.to)];
    assert.equal(phases.join(' '), 'free A B BB BA B A free');
    assert.deepEqual(events.map(event => event.kind),
        ['first-contact', 'tip-to-tangent', 'touch', 'tangent-to-tip', 'release', 'tangent-to-tip', 'snap-off']);
});

test('its states are those of the library', { skip: !process.env.PLAYGROUND_STATES }, () => {
    const expected = readFileSync(process.env.PLAYGROUND_STATES, 'utf8').trim().split('\n').map(line => JSON.parse(line));
    const { states } = scan();
    const units = [WIRE.length, globalThis.playground.stiffness(WIRE)], force = units[1] / units[0] ** 2;
    const off = (value, known, unit) => assert.ok(Math.abs(value - known) <= 1e-12 * unit, `${value} is not ${known}`);
    assert.equal(states.length, expected.length);
    states.forEach(({ phase, pose, reactions, contacts }, index) => {
        const known = expected[index];
        assert.equal(phase, known.phase);
        off(pose[0], known.x0, WIRE.length);
        off(reactions[0], known.f0x, force);
        off(reactions[1], known.f0y, force);
        off(reactions[2], known.m0z, force * WIRE.length);
        contacts.forEach((contact, number) => {
            for (const name of ['s', 'x', 'y']) off(contact[name], known.contacts[number][name], WIRE.length);
            off(contact.force, known.contacts[number].force, force);
        });
    });
});

test('single contacts come back from the reactions', () => {
    const { states } = scan();
    const single = states.filter(({ contacts }) => contacts.length === 1);
    assert.ok(single.length > 100);
    for (const { recovered, contacts: [contact], pose } of single) {
        assert.equal(recovered.kind, contact.kind, `at ${pose}`);
        assert.ok(Math.hypot(recovered.x - contact.x, recovered.y - contact.y) < 1e-9);
        assert.ok(isContact(recovered, [contact]) && !isContact(recovered, [contact, contact]));
    }
    assert.equal(states[0].recovered, null);
});

// It was drawn as a contact, 30 mm from the object.
test('with friction the point may be none, and is not drawn as a contact', () => {
    const rod = new Rod(module), rubs = scene('parabolas', { taper: 0.3, curvature: 6, friction: 0.4 });
    rubs.shapes[1].vertex = [0.052, -0.01];
    const states = [rod.build(rubs, rubs.home).state];
    for (let x = 79; x > 0; x--) states.push(rod.moveTo([x / 1e3, -0.04, Math.PI / 2]));
    const off = ({ recovered, contacts: [contact] }) => Math.hypot(recovered.x - contact.x, recovered.y - contact.y);
    const wrong = states.filter(state => state.contacts.length === 1 && off(state) > 0.02);
    assert.ok(wrong.length > 5 && wrong.every(({ recovered, contacts }) => !isContact(recovered, contacts)), `${wrong.length}`);
});

test('each object lets a rod of each kind pass, with friction and without', () => {
    for (const object of Object.keys(OBJECTS)) {
        for (const kind of [{}, { friction: 0.3 }, { taper: 0.3 }, { curvature: -5, taper: 0.1 }]) {
            const rod = new Rod(module), { shapes, rod: wire, home } = scene(object, kind);
            rod.build({ shapes, rod: wire }, home);
            let most = 0;
            for (let x = home[0]; x > -0.02; x -= 2e-3) most = Math.max(most, rod.moveTo([x, home[1], home[2]]).contacts.length);
            assert.ok(most > 0, object);
        }
    }
});

test('a failure has a reason, and the rod stays where it was', () => {
    const rod = new Rod(module), paper = scene('parabolas');
    assert.throws(() => rod.build({ ...paper, rod: { ...paper.rod, length: -1 } }, paper.home), /length is -1/);
    assert.throws(() => rod.moveTo([0, 0, 0]), /no rod yet/);
    assert.throws(() => rod.build(paper, [0, 0.1, 0]), /inside/);
    rod.build(paper, paper.home);
    assert.throws(() => rod.moveTo([NaN, 0, 0]), /not finite/);
    assert.throws(() => rod.moveTo([0.015, 0.2, Math.PI / 2]), /the sweep stopped/);
    assert.deepEqual(rod.moveTo(paper.home).pose, paper.home);
});

test('many scenes fit into one page', () => {
    const rod = new Rod(module), paper = scene('comb');
    for (let k = 0; k < 120; k++) rod.build(paper, paper.home);
    assert.equal(rod.build(paper, paper.home).outlines.length, 1);
});

test('a scene comes back from the address and from a file', () => {
    for (const object of Object.keys(OBJECTS)) {
        const drawn = scene(object, { friction: 0.2, taper: 0.5, curvature: -3 }), pose = [0.07, -0.05, 1.6];
        const back = fromText(fromHash(toHash(toText(drawn, pose))));
        assert.deepEqual(back.pose, pose);
        assert.deepEqual(back.rod, drawn.rod);
        assert.deepEqual(fromToml(toToml(drawn, drawn.home, pose, pose)), back);
    }
    const text = toText(scene('disc'), [0, 0, 0]);
    for (const wrong of ['', '{}', 'null', '[]', text.replace('0.025', '"r"'), text.replace('disc', 'toString')]) {
        assert.throws(() => fromText(wrong));
    }
    assert.throws(() => fromText('null'), /no scene of this page/);
    assert.throws(() => fromText(fromHash('AAAA')), /damaged or cut off/);
    assert.throws(() => fromHash('AAAAA'), /damaged or cut off/);
    assert.throws(() => fromToml('[rod]\nlength = 0.1\n'), /this page has saved/);
});

test('an address tells which equilibrium it is', () => {
    const { states } = scan(), { rod } = scene('parabolas');
    const { pose, reactions } = states.find(({ phase }) => phase === 'B');
    const saved = fromText(toText(scene('parabolas'), pose, reactions));
    assert.ok(isSameEquilibrium(saved.reactions, reactions, rod));
    assert.ok(!isSameEquilibrium(saved.reactions, states[0].reactions, rod));
    assert.equal(fromText(toText(scene('parabolas'), pose)).reactions, undefined);
});

test('many overlapping discs do not hold the page up', () => {
    const rod = new Rod(module), { rod: wire, home } = scene('disc');
    rod.build({ shapes: Array.from({ length: 20 }, () => ({ shape: 'disc', center: [0, 0.02], radius: 0.02 })), rod: wire }, home);
    const start = performance.now();
    for (let x = home[0]; x > 0.02; x -= 2e-3) rod.moveTo([x, -0.04, home[2]]);
    assert.ok(performance.now() - start < 5000);
});

test('the command reads what the page saves', { skip: !process.env.PLAYGROUND_SAVED }, () => {
    const save = (name, text) => writeFileSync(`${process.env.PLAYGROUND_SAVED}/${name}`, text);
    const { recording } = scan(4);
    save('recording.csv', recording.toCsv());
    save('parabolas.toml', toToml(scene('parabolas'), recording.poseAt(0), recording.poseAt(-1), recording.poseAt(-1)));
    for (const object of Object.keys(OBJECTS)) {
        const { home, ...drawn } = scene(object, { friction: 0.2, taper: 0.5, curvature: -3 });
        save(`${object}-bent.toml`, toToml(drawn, home, [home[0] - 0.02, home[1], home[2] + 0.1], home));
    }
});

test('the page is below 1 MB and asks no other host', t => {
    const site = mkdtempSync(join(tmpdir(), 'playground-site-'));
    t.after(() => rmSync(site, { recursive: true }));
    execFileSync(fileURLToPath(here('build')), [path instanceof URL ? fileURLToPath(path) : path, site]);
    const files = readdirSync(site);
    assert.ok(files.includes('index.html') && files.includes('module.js'));
    let size = 0;
    for (const file of files) {
        const text = readFileSync(join(site, file), 'utf8');
        size += text.length;
        // a name space is no address that is asked
        const plain = file === 'module.js' ? text.replace(/'[A-Za-z0-9+/=]*'/, '') : text.replaceAll('http://www.w3.org/2000/svg', '');
        assert.doesNotMatch(plain, /https?:|\/\/[a-z]+\.[a-z]|@import|\bfetch\b|XMLHttpRequest|WebSocket/i, file);
    }
    assert.ok(size < 1e6, `${size} bytes`);
});
