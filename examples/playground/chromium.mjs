// A page in a headless Chromium, by its debugging protocol over a pipe: no package is needed.
import { spawn } from 'node:child_process';
import { mkdtempSync, rmSync } from 'node:fs';
import { tmpdir } from 'node:os';
import { join } from 'node:path';

/// A page of this size (px) at the address: { evaluate, send, screenshot, errors, close }.
export async function open(command, address, { width, height, dark = false, before = '' }) {
    const profile = mkdtempSync(join(tmpdir(), 'playground-'));
    const child = spawn(command, ['--headless=new', '--no-sandbox', '--disable-gpu', '--remote-debugging-pipe', `--user-data-dir=${profile}`],
        { stdio: ['ignore', 'ignore', 'ignore', 'pipe', 'pipe'] });
    const waiting = new Map(), errors = [];
    let number = 0, buffer = '';
    child.stdio[4].setEncoding('utf8').on('data', part => {
        const messages = (buffer + part).split('\0');
        buffer = messages.pop();
        for (const message of messages.map(text => JSON.parse(text))) {
            if (message.method === 'Runtime.exceptionThrown') errors.push(message.params.exceptionDetails.exception?.description);
            if (message.method === 'Log.entryAdded' && message.params.entry.level === 'error') errors.push(message.params.entry.text);
            waiting.get(message.id)?.(message);
            waiting.delete(message.id);
        }
    });
    const call = (method, params, sessionId) => new Promise((resolve, reject) => {
        waiting.set(++number, ({ result, error }) => error ? reject(new Error(`${method}: ${error.message}`)) : resolve(result));
        child.stdio[3].write(`${JSON.stringify({ id: number, method, params, sessionId })}\0`);
    });
    const { targetId } = await call('Target.createTarget', { url: 'about:blank' });
    const { sessionId } = await call('Target.attachToTarget', { targetId, flatten: true });
    const send = (method, params = {}) => call(method, params, sessionId);
    await send('Runtime.enable');
    await send('Log.enable');
    await send('Page.enable');
    await send('Emulation.setDeviceMetricsOverride', { width, height, deviceScaleFactor: 1, mobile: width < 500 });
    await send('Emulation.setEmulatedMedia', { features: [{ name: 'prefers-color-scheme', value: dark ? 'dark' : 'light' }] });
    if (before) await send('Page.addScriptToEvaluateOnNewDocument', { source: before });
    await send('Page.navigate', { url: address });
    const evaluate = async expression => {
        const { result, exceptionDetails } = await send('Runtime.evaluate', { expression, awaitPromise: true, returnByValue: true });
        if (exceptionDetails) throw new Error(exceptionDetails.exception?.description ?? exceptionDetails.text);
        return result.value;
    };
    const screenshot = async (whole = true) => {
        const { data } = await send('Page.captureScreenshot', { format: 'png', captureBeyondViewport: whole });
        return Buffer.from(data, 'base64');
    };
    const close = async () => {
        const ended = new Promise(resolve => child.once('exit', resolve));
        child.kill();
        await ended;
        rmSync(profile, { recursive: true, force: true, maxRetries: 5 });
    };
    return { evaluate, send, screenshot, errors, close };
}
