// The page in a browser: that it starts from a folder, follows mouse, finger and keys, and fits into a narrow window. Runs after `build`.
//   PLAYGROUND_CHROMIUM   the command of a Chromium; without it nothing is tested here
//   PLAYGROUND_PAGE       the folder that `build` wrote, if it is not site/playground
//   PLAYGROUND_PICTURES   a folder for screenshots
import assert from 'node:assert/strict';
import { writeFileSync } from 'node:fs';
import { join } from 'node:path';
import { after, test } from 'node:test';
import { fileURLToPath, pathToFileURL } from 'node:url';
import { launch } from './chromium.mjs';

const { PLAYGROUND_CHROMIUM: chromium, PLAYGROUND_PICTURES: pictures } = process.env;
const folder = process.env.PLAYGROUND_PAGE ?? fileURLToPath(new URL('../../site/playground', import.meta.url));
const address = pathToFileURL(join(folder, 'index.html')).href;
const skip = !chromium;
const browser = chromium && launch(chromium);
// also after a failure: the tests would wait for the browser for ever
after(() => browser?.close());
/// Keeps how long each frame's script takes, ms.
const TIMED = `globalThis.frames_ms = [];
    const request = requestAnimationFrame;
    globalThis.requestAnimationFrame = call => request(now => {
        const start = performance.now();
        call(now);
        frames_ms.push(performance.now() - start);
    });`;
const seconds = count => new Promise(resolve => setTimeout(resolve, 1000 * count));
/// Asks until the answer is yes: a machine with other work takes longer.
async function until(what, ask) {
    for (let tries = 0; !await ask(); tries++) {
        assert.ok(tries < 100, what);
        await seconds(0.1);
    }
}
const text = (page, name) => page.evaluate(`document.getElementById('${name}').textContent`);

async function started(t, options) {
    const page = await browser.open(address, { before: TIMED, ...options });
    // a page behind another one draws no frames
    t.after(page.close);
    await until('the page starts', async () => await text(page, 'xy') !== '');
    return page;
}

async function picture(page, name) {
    if (pictures) writeFileSync(`${pictures}/${name}.png`, await page.screenshot());
}

async function drag(page, path) {
    const box = await page.evaluate(`(({ x, y, width, height }) => ({ x, y, width, height }))(document.getElementById('view').getBoundingClientRect())`);
    const at = ([x, y]) => ({ x: box.x + x * box.width, y: box.y + y * box.height, button: 'left', clickCount: 1 });
    await page.send('Input.dispatchMouseEvent', { type: 'mousePressed', ...at(path[0]) });
    for (const point of path.slice(1)) {
        await page.send('Input.dispatchMouseEvent', { type: 'mouseMoved', ...at(point), buttons: 1 });
        await seconds(0.02);
    }
    await page.send('Input.dispatchMouseEvent', { type: 'mouseReleased', ...at(path.at(-1)) });
}

test('the scan of the paper', { skip, timeout: 120e3 }, async t => {
    const page = await started(t, { width: 1200, height: 900 });
    await page.evaluate(`document.getElementById('record').click(); document.getElementById('scan').click()`);
    const phases = [];
    for (let tries = 0; tries < 1000; tries++) {
        const phase = await text(page, 'phase');
        if (phases.at(-1) !== phase) {
            phases.push(phase);
            await picture(page, `scan-${phases.length}-${phase}`);
        }
        if (Number((await text(page, 'xy')).split(',')[0]) <= -99.9) break;
        await seconds(0.03);
    }
    // what is recorded is the scan alone, in the order of time
    await page.evaluate(`URL.createObjectURL = blob => (globalThis.saved = blob, 'about:blank#'); HTMLAnchorElement.prototype.click = () => {};
        document.getElementById('record').click(); document.getElementById('csv').click()`);
    const rows = (await page.evaluate('saved.text()')).trim().split('\n').map(row => row.split(','));
    assert.deepEqual(rows.shift(), ['t', 'x0', 'y0', 'phi0', 'f0x', 'f0y', 'm0z']);
    assert.ok(rows.length > 30 && rows.slice(1).every(([time, x0], index) => +time > +rows[index][0] && +x0 < +rows[index][1]));
    if (pictures) writeFileSync(`${pictures}/scan.csv`, await page.evaluate('saved.text()'));
    // a short phase may pass between two looks
    assert.match(phases.join(' '), /^free A B (BB )?(BA )?B (A )?free$/);
    const ms = (await page.evaluate('frames_ms')).sort((a, b) => a - b);
    const share = part => ms[Math.floor(part * (ms.length - 1))].toFixed(2);
    console.log(`script of a frame: median ${share(0.5)} ms, 99 % ${share(0.99)} ms, most ${share(1)} ms of ${ms.length}`);
    assert.deepEqual(page.errors, []);
});

for (const [name, options] of Object.entries({ wide: { width: 1280, height: 800, dark: true }, narrow: { width: 390, height: 844 },
    small: { width: 320, height: 568 } })) {
    test(`a ${name} window has room for all`, { skip, timeout: 60e3 }, async t => {
        const page = await started(t, options);
        await picture(page, name);
        assert.ok(await page.evaluate('document.documentElement.scrollWidth <= innerWidth'), 'it scrolls sideways');
        const isSeen = part => `(box => box.top >= 0 && box.bottom <= innerHeight)(document.getElementById('${part}').getBoundingClientRect())`;
        assert.ok(await page.evaluate(isSeen('view')), 'the drawing is not seen');
        // a slider moves what is in view, on a telephone too
        await page.evaluate(`document.getElementById('friction').scrollIntoView({ block: 'end' })`);
        if (name === 'narrow') assert.ok(await page.evaluate(isSeen('view')), 'the drawing is gone');
        assert.ok(await page.evaluate(`(slider => {
            const box = slider.getBoundingClientRect();
            return document.elementFromPoint(box.x + box.width / 2, box.y + box.height / 2) === slider;
        })(document.getElementById('friction'))`), 'the slider is covered');
        if (pictures) writeFileSync(`${pictures}/${name}-slider.png`, await page.screenshot(false));
        assert.deepEqual(page.errors, []);
    });
}

test('keys move the clamp and reach all buttons', { skip, timeout: 60e3 }, async t => {
    const page = await started(t, { width: 1000, height: 800 });
    const codes = { Tab: 9, ArrowLeft: 37, ArrowRight: 39 };
    const key = (type, name, modifiers = 0) =>
        page.send('Input.dispatchKeyEvent', { type, key: name, code: name, windowsVirtualKeyCode: codes[name], modifiers });
    const hold = async (name, modifiers, what, ask) => {
        await key('keyDown', name, modifiers);
        await until(what, ask);
        await key('keyUp', name, modifiers);
    };
    // the drawing comes first, then what is below it in its order
    const order = [];
    for (let count = 0; count < 4; count++) {
        await key('keyDown', 'Tab');
        await key('keyUp', 'Tab');
        order.push(await page.evaluate('document.activeElement.id'));
        if (count > 0) continue;
        await hold('ArrowLeft', 0, 'arrows move', async () => (await text(page, 'xy')).startsWith('7'));
        await hold('ArrowRight', 8, 'shift and arrow turn', async () => Number(await text(page, 'phi')) < 85);
        await picture(page, 'keys');
    }
    assert.deepEqual(order, ['view', 'scan', 'reset', 'record']);
    assert.deepEqual(page.errors, []);
});

test('keys move the handles of the object', { skip, timeout: 60e3 }, async t => {
    const page = await started(t, { width: 1000, height: 800 });
    const tap = async (key, modifiers = 0) => {
        for (const type of ['keyDown', 'keyUp']) await page.send('Input.dispatchKeyEvent', { type, key, code: key, modifiers });
    };
    await page.evaluate(`(chooser => { chooser.value = 'disc'; chooser.dispatchEvent(new Event('change')); })(document.getElementById('object'))`);
    await page.evaluate(`document.getElementById('view').focus()`);
    const shape = () => page.evaluate(`JSON.parse(playground.fromHash(location.hash.slice(1) || btoa('{"shapes":[{}]}'))).shapes[0]`);
    await until('the address has the disc', async () => (await shape()).radius === 0.025);
    const clamp = await text(page, 'xy');
    // the centre, then the radius, then the clamp again
    await tap('h');
    assert.match(await text(page, 'message'), /move handle 1 of 2 /);
    for (let count = 0; count < 5; count++) await tap('ArrowUp');
    await until('the centre moves', async () => (await shape()).center[1] >= 0.0219999);
    await picture(page, 'handle');
    await tap('h');
    assert.match(await text(page, 'message'), /move handle 2 of 2 /);
    const [before] = [(await shape()).radius];
    for (let count = 0; count < 5; count++) await tap('ArrowRight');
    await until('the radius grows', async () => (await shape()).radius >= before + 0.0019);
    assert.equal(await text(page, 'xy'), clamp);
    await tap('Escape');
    assert.equal(await text(page, 'message'), 'Arrow keys move the clamp.');
    await tap('ArrowLeft');
    await until('the clamp moves', async () => await text(page, 'xy') !== clamp);
    assert.deepEqual(page.errors, []);
});

test('mouse, sliders and objects', { skip, timeout: 120e3 }, async t => {
    const page = await started(t, { width: 1000, height: 800 });
    const place = async () => (await text(page, 'xy')).split(',').map(Number);
    const [x] = await place();
    await drag(page, Array.from({ length: 20 }, (_, k) => [0.9 - 0.015 * k, 0.9]));
    await seconds(0.3);
    assert.ok((await place())[0] < x - 40, `the mouse drags the clamp: ${await place()} ${await text(page, 'message')}`);
    assert.notEqual(await text(page, 'phase'), 'free');
    await picture(page, 'dragged');
    const slide = (name, value) => page.evaluate(`(slider => { slider.value = ${value}; slider.dispatchEvent(new Event('input')); })(document.getElementById('${name}'))`);
    for (const [name, value] of [['taper', 0.3], ['friction', 0.3], ['curvature', 4], ['length', 120], ['diameter', 0.3]]) await slide(name, value);
    for (const object of ['disc', 'pegs', 'square', 'comb']) {
        await page.evaluate(`(chooser => { chooser.value = '${object}'; chooser.dispatchEvent(new Event('change')); })(document.getElementById('object'))`);
        await page.evaluate(`document.getElementById('scan').click()`);
        await until(`the scan past ${object} touches it`, async () => await text(page, 'phase') !== 'free');
        await picture(page, object);
        const ms = (await page.evaluate('frames_ms.splice(0)')).sort((a, b) => a - b);
        console.log(`${object}: 99 % ${ms[Math.floor(0.99 * (ms.length - 1))].toFixed(2)} ms, ${await text(page, 'phase')} ${await text(page, 'message')}`);
    }
    await page.evaluate(`document.getElementById('reset').click()`);
    await until('the address has the state', async () => (await page.evaluate('location.hash')).length > 100);
    assert.deepEqual(page.errors, []);
});

test('a finger drags the clamp', { skip, timeout: 120e3 }, async t => {
    const page = await started(t, { width: 360, height: 740 });
    await page.evaluate(`document.getElementById('hide-object').click()`);
    const box = await page.evaluate(`(({ x, y, width, height }) => ({ x, y, width, height }))(document.getElementById('view').getBoundingClientRect())`);
    const touch = (type, ...at) => page.send('Input.dispatchTouchEvent',
        { type, touchPoints: at.map(([x, y]) => ({ x: box.x + x * box.width, y: box.y + y * box.height })) });
    await touch('touchStart', [0.9, 0.9]);
    for (let k = 0; k <= 60; k++) {
        await touch('touchMove', [0.9 - 0.01 * k, 0.9]);
        await seconds(0.01);
    }
    await touch('touchEnd');
    await until('the clamp follows', async () => Number((await text(page, 'xy')).split(',')[0]) < -20);
    await picture(page, 'touched');
    assert.deepEqual(page.errors, []);
});

test('a handle changes the object, a link and a file bring it back', { skip, timeout: 120e3 }, async t => {
    const page = await started(t, { width: 1000, height: 800 });
    await page.evaluate(`(chooser => { chooser.value = 'disc'; chooser.dispatchEvent(new Event('change')); })(document.getElementById('object'))`);
    await page.evaluate(`document.getElementById('edit-object').click()`);
    // the centre of the disc, at (0, 20) mm, to the right and downwards
    const middle = 0.5 - 0.035 / 0.256 * 4 / 3;
    await drag(page, Array.from({ length: 11 }, (_, k) => [0.5 + 0.01 * k, middle + 0.01 * k]));
    const state = `JSON.parse(playground.fromHash(location.hash.slice(1) || btoa('{"shapes":[{}]}'))).shapes[0].center ?? [0, 0]`;
    await until('the handle moves the centre', async () => {
        const [x, y] = await page.evaluate(state);
        return Math.abs(x - 0.0256) < 1e-4 && y < 0.01;
    });
    const [x, y] = await page.evaluate(state);
    await picture(page, 'edited');
    // what the page saves, it loads
    await page.evaluate(`globalThis.saved = []; URL.createObjectURL = blob => (saved.push(blob), 'about:blank#');
        HTMLAnchorElement.prototype.click = () => {}; document.getElementById('save').click()`);
    const toml = await page.evaluate('saved[0].text()');
    assert.match(toml, /shape = "arc"/);
    await page.evaluate(`document.getElementById('object').value = 'comb'; document.getElementById('object').dispatchEvent(new Event('change'))`);
    await page.evaluate(`(files => {
        files.items.add(new File([saved[0]], 'scene.toml'));
        document.getElementById('file').files = files.files;
        document.getElementById('file').dispatchEvent(new Event('change'));
    })(new DataTransfer())`);
    await until('the file brings the disc back', async () => {
        const [loaded, ...rest] = await page.evaluate(`[document.getElementById('object').value, ...${state}]`);
        return loaded === 'disc' && rest[0] === x && rest[1] === y;
    });
    // a link of another scene, and one of nothing
    await page.evaluate(`location.hash = playground.toHash(playground.toText({ ...playground.preset('square'), rod: playground.WIRE }, [0.07, -0.06, 1.5]))`);
    await until('the link is opened', async () => await text(page, 'xy') === '70.0, -60.0');
    await page.evaluate(`location.hash = 'nothing'`);
    await seconds(0.3);
    assert.equal(await text(page, 'xy'), '70.0, -60.0');
    assert.match(await text(page, 'message'), /^The address is not opened/);
    await page.evaluate(`location.hash = playground.toHash(playground.toText({ ...playground.preset('square'), rod: playground.WIRE }, [0.06, -0.06, 1.5], [1, 0, 0]))`);
    await until('another equilibrium is told', async () => /other contacts/.test(await text(page, 'message')));
    assert.equal(await text(page, 'xy'), '60.0, -60.0');
    assert.deepEqual(page.errors, []);
});
