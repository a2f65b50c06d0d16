// Pages in a headless Chromium, by its debugging protocol over a pipe: no package is needed.
import { spawn } from 'node:child_process';
import { mkdtempSync, rmSync } from 'node:fs';
import { tmpdir } from 'node:os';
import { join } from 'node:path';

/// The browser of this command: { open, close }.
export function launch(command) {
    const profile = mkdtempSync(join(tmpdir(), 'playground-'));
    const child = spawn(command, ['--headless=new', '--no-sandbox', '--disable-gpu', '--remote-debugging-pipe', `--user-data-dir=${profile}`],
        { stdio: ['ignore', 'ignore', 'ignore', 'pipe', 'pipe'] });
    const waiting = new Map(), sessions = new Map();
    let number = 0, buffer = '';
    child.stdio[4].setEncoding('utf8').on('data', part => {
        const messages = (buffer + part).split('\0');
        buffer = messages.pop();
        for (const message of messages.map(text => JSON.parse(text))) {
            sessions.get(message.sessionId)?.(message);
            waiting.get(message.id)?.(message);
            waiting.delete(message.id);
        }
    });
    const call = (method, params, sessionId) => new Promise((resolve, reject) => {
        waiting.set(++number, ({ result, error }) => error ? reject(new Error(`${method}: ${error.message}`)) : resolve(result));
        child.stdio[3].write(`${JSON.stringify({ id: number, method, params, sessionId })}\0`);
    });

    /// A page of this size (px) at the address, loaded: { evaluate, send, screenshot, errors, close }.
    async function open(address, { width, height, dark = false, before = '' }) {
        const { targetId } = await call('Target.createTarget', { url: 'about:blank' });
        const { sessionId } = await call('Target.attachToTarget', { targetId, flatten: true });
        const errors = [];
        let isLoaded;
        const loaded = new Promise(resolve => { isLoaded = resolve; });
        sessions.set(sessionId, ({ method, params }) => {
            if (method === 'Runtime.exceptionThrown') errors.push(params.exceptionDetails.exception?.description);
            if (method === 'Log.entryAdded' && params.entry.level === 'error') errors.push(params.entry.text);
            if (method === 'Page.loadEventFired') isLoaded();
        });
        const send = (method, params = {}) => call(method, params, sessionId);
        await send('Runtime.enable');
        await send('Log.enable');
        await send('Emulation.setDeviceMetricsOverride', { width, height, deviceScaleFactor: 1, mobile: width < 500 });
        await send('Emulation.setEmulatedMedia', { features: [{ name: 'prefers-color-scheme', value: dark ? 'dark' : 'light' }] });
        // as if it were the window in front: one of several pages has the focus, and draws
        await send('Emulation.setFocusEmulationEnabled', { enabled: true });
        if (before) await send('Page.addScriptToEvaluateOnNewDocument', { source: before });
        await send('Page.enable');
        await send('Page.navigate', { url: address });
        await loaded;
        const evaluate = async expression => {
            const { result, exceptionDetails } = await send('Runtime.evaluate', { expression, awaitPromise: true, returnByValue: true });
            if (exceptionDetails) throw new Error(exceptionDetails.exception?.description ?? exceptionDetails.text);
            return result.value;
        };
        const screenshot = async (whole = true) => {
            const { data } = await send('Page.captureScreenshot', { format: 'png', captureBeyondViewport: whole });
            return Buffer.from(data, 'base64');
        };
        return { evaluate, send, screenshot, errors, close: () => call('Target.closeTarget', { targetId }) };
    }

    async function close() {
        const ended = new Promise(resolve => child.once('exit', resolve));
        child.kill();
        await ended;
        rmSync(profile, { recursive: true, force: true, maxRetries: 5 });
    }
    return { open, close };
}
