// The page: each frame moves the clamp a little towards where it is wished, and shows the answer.
(async () => {
    const { MODULE, Rod, Recording, View, Chart, Input, Panel, OBJECTS, WIRE } = globalThis.playground;
    const { preset, stiffness, toText, fromText, toHash, fromHash, toToml, fromToml, isSameEquilibrium, isContact } = globalThis.playground;
    const id = name => document.getElementById(name);

    /// Farthest way of the clamp in a frame, m and rad: a longer one takes longer than a frame. The clamp lags behind a fast hand.
    const FARTHEST = 3e-3, FARTHEST_TURN = 0.08;
    /// Where the clamp may be wished, m from the middle: the page shows about so much.
    const REACH = [0.125, 0.11];
    /// Speed of the scan, m/s, and where it ends, m.
    const SCAN_SPEED = 0.035, SCAN_END = -0.1;
    /// Points of the trail, and their least distance, m: nearer ones cover each other.
    const MOST_POINTS = 4000, POINTS_APART = 0.3e-3;
    const EVENTS = 8;
    /// After a move that was refused, the page rests for so many times as long as the refusal took, so that it stays responsive.
    const RESPITE = 4;
    /// The address follows after so much rest, ms.
    const REST = 700;
    // where the system asks for less motion, a jump leaves no fading shape
    const calm = matchMedia('(prefers-reduced-motion: reduce)');

    const view = new View(id('view')), chart = new Chart(id('chart'));
    const panel = new Panel((name, value) => edit({ ...scene, rod: { ...scene.rod, [name]: value } }));
    const module = await compiled(MODULE);
    // the whisker that is shown, and one to try another scene with
    let rod = new Rod(module), spare = new Rod(module);
    let scene, state, outlines, wish, last;
    let trail = [], events = [], recording, isRecording = false, scanning = false;
    // the chart's time, s: it stands still with the clamp, so that a scan stays in the chart
    let motion = 0, charted;
    let refused, respite = 0, isDirty = true, movedAt = 0, nextEdit;
    // number of the handle that keys move; undefined: they move the clamp
    let chosen;

    async function compiled(base64) {
        const packed = Uint8Array.from(atob(base64), letter => letter.charCodeAt(0));
        const bytes = new Response(new Blob([packed]).stream().pipeThrough(new DecompressionStream('gzip'))).arrayBuffer();
        return WebAssembly.compile(await bytes);
    }

    /// The reason alone: what else a stop says is for sweeps of the command.
    const reason = error => error.message.replace(/^the sweep stopped at .*? rad: /, '').replace(/;.*/, '');

    /// Another scene with the clamp at `pose`, or where it begins if the rod finds no place there. The scene stays as it was if neither does.
    function build(wanted, pose) {
        let failure = '';
        for (const start of [pose, wanted.home]) {
            try {
                ({ outlines, state } = spare.build(wanted, start));
                [rod, spare] = [spare, rod];
                [scene, wish, refused, scanning, isDirty] = [wanted, [...start], undefined, false, true];
                panel.say(failure);
                panel.scene(scene);
                panel.state(state);
                return true;
            } catch (error) {
                failure ||= reason(error);
            }
        }
        panel.say(`Not possible: ${failure}.`);
        isDirty = true;
        return false;
    }

    function clearTrail() {
        trail = [];
        isDirty = true;
    }

    /// A frame's part of the way from the clamp to the wish.
    function nextPose() {
        const way = wish.map((value, index) => value - state.pose[index]);
        const share = Math.min(1, FARTHEST / Math.hypot(way[0], way[1]), FARTHEST_TURN / Math.abs(way[2]));
        return share === 1 ? [...wish] : way.map((value, index) => state.pose[index] + share * value);
    }

    const same = (one, other) => one?.every((value, index) => value === other[index]);

    function move(now) {
        if (same(state.pose, wish) || same(refused, wish) || now < respite) return;
        const before = state, start = performance.now();
        try {
            state = rod.moveTo(nextPose());
            refused = undefined;
            panel.say('');
        } catch (error) {
            // not asked again until the wish changes
            refused = [...wish];
            respite = now + (1 + RESPITE) * (performance.now() - start);
            scanning = false;
            panel.say(`The whisker stays: ${reason(error)}.`);
            return;
        }
        [isDirty, movedAt] = [true, now];
        for (const event of state.events) {
            events.unshift({ ...event, at: now });
            if (event.kind.startsWith('snap') && !calm.matches) view.jumped(before.shape, now);
        }
        events.length = Math.min(events.length, EVENTS);
        if (state.events.length > 0) panel.events(events);
        follow();
        due();
        if (isRecording) record();
        panel.state(state);
    }

    function startRecording() {
        [recording, isRecording] = [new Recording(), true];
        Object.assign(recording, { since: performance.now(), scene });
        record();
    }

    function stopRecording() {
        isRecording = false;
        panel.recording(recording.rows.length, isRecording);
    }

    /// Not by the time of the frame, which began before a click in it.
    function record() {
        recording.add((performance.now() - recording.since) / 1e3, state);
        panel.recording(recording.rows.length, isRecording);
    }

    /// The point that the reactions of this state give.
    function follow() {
        const { recovered, contacts } = state, end = trail.at(-1);
        if (!recovered || end && Math.hypot(recovered.x - end.x, recovered.y - end.y) < POINTS_APART) return;
        const found = isContact(recovered, contacts);
        trail.push({ ...recovered, kind: found ? contacts[0].kind : 'several', found });
        if (trail.length > MOST_POINTS) trail.shift();
    }

    // Handles of the shapes, and what moving them does.
    function handles() {
        if (!id('edit-object').checked) return [];
        return (nextEdit ?? scene).shapes.flatMap(shape => shape.shape === 'parabola' ? [shape.vertex]
            : shape.shape === 'disc' ? [shape.center, [shape.center[0] + shape.radius, shape.center[1]]] : shape.points);
    }

    function moveHandle(moved, point) {
        let index = moved;
        const shapes = structuredClone((nextEdit ?? scene).shapes);
        for (const shape of shapes) {
            const count = shape.shape === 'parabola' ? 1 : shape.shape === 'disc' ? 2 : shape.points.length;
            if (index >= count) {
                index -= count;
                continue;
            }
            if (shape.shape === 'parabola') shape.vertex = point;
            else if (shape.shape === 'polygon') shape.points[index] = point;
            else if (index === 0) shape.center = point;
            else shape.radius = Math.max(2e-3, Math.hypot(point[0] - shape.center[0], point[1] - shape.center[1]));
            break;
        }
        // once a frame
        nextEdit = { ...scene, shapes };
    }

    /// Chooses the handle that keys move: the next or, by `way` -1, the one before; behind the last one the clamp again.
    function choose(way) {
        id('edit-object').checked = isDirty = true;
        // the clamp is one more place in the row
        const places = handles().length + 1, place = ((chosen ?? places - 1) + way + places) % places;
        chosen = place < places - 1 ? place : undefined;
        panel.say(chosen === undefined ? 'Arrow keys move the clamp.'
            : `Arrow keys move handle ${chosen + 1} of ${places - 1} of the object. H: the next one, Esc: the clamp again.`);
    }

    function unchoose() {
        if (chosen === undefined) return false;
        [chosen, isDirty] = [undefined, true];
        panel.say('Arrow keys move the clamp.');
        return true;
    }

    const limited = (value, reach) => Math.min(reach, Math.max(-reach, value));
    const wishes = {
        pose: () => state.pose,
        handles,
        moveHandle,
        moveClamp(dx, dy) {
            scanning = false;
            wish = [limited(wish[0] + dx, REACH[0]), limited(wish[1] + dy, REACH[1]), wish[2]];
        },
        moveChosen(dx, dy) {
            const handle = handles()[chosen];
            if (handle) moveHandle(chosen, [limited(handle[0] + dx, REACH[0]), limited(handle[1] + dy, REACH[1])]);
            else this.moveClamp(dx, dy);
        },
        turn(angle) {
            scanning = false;
            wish = [wish[0], wish[1], limited(wish[2] + angle, 6 * Math.PI)];
        },
        /// By the shorter way.
        turnTo(angle) {
            this.turn(Math.atan2(Math.sin(angle - wish[2]), Math.cos(angle - wish[2])));
        },
        /// Where the whisker could not be followed, a next drag begins at the clamp.
        released() {
            if (refused) [wish, refused] = [[...state.pose], undefined];
        },
        press(key, shift) {
            if (key === 'h') return choose(shift ? -1 : 1), true;
            if (key === 'escape') return unchoose();
            const button = { r: 'reset', s: 'scan', ' ': 'record' }[key];
            if (button) id(button).click();
            return button !== undefined;
        },
    };
    const input = new Input(id('view'), view, wishes);

    function frame(now) {
        const seconds = Math.min(0.05, (now - (last ?? now)) / 1e3);
        last = now;
        input.frame(seconds);
        if (scanning) {
            wish = [Math.max(SCAN_END, wish[0] - SCAN_SPEED * seconds), ...wish.slice(1)];
            if (wish[0] === SCAN_END && state.pose[0] === SCAN_END) scanning = false;
        }
        if (nextEdit) {
            const edited = nextEdit;
            nextEdit = undefined;
            edit(edited);
        }
        move(now);
        if (state !== charted) {
            motion += seconds;
            chart.add(motion, state.reactions);
            charted = state;
        }
        if (isDirty || now - movedAt < 1000) draw(now);
        if (isDirty) chart.draw(motion);
        isDirty = false;
        if (hashDue && now > hashDue) writeHash();
        requestAnimationFrame(frame);
    }

    function draw(now) {
        const { length, diameter, taper } = scene.rod;
        // wires are thin: ten times as thick as to scale
        const base = Math.max(2, Math.min(12, 10 * diameter * view.scale * 0.3));
        view.draw({
            state, outlines, handles: handles(), chosen, hidden: id('hide-object').checked,
            trail: id('show-trail').checked ? trail : [],
            unit: stiffness(scene.rod) / length ** 2, diameters: [base, base * taper],
        }, now);
    }

    let hashDue = 0, lastText = '';
    function writeHash() {
        hashDue = 0;
        const text = toText(scene, state.pose, state.reactions);
        if (text === lastText) return;
        lastText = text;
        history.replaceState(null, '', `#${toHash(text)}`);
    }
    const due = () => { hashDue = performance.now() + REST; };

    /// Opens a scene of an address or a file by `show(scene, pose)`, and says if the whisker is in another equilibrium than when it was saved.
    function restore({ pose, reactions, ...saved }, show) {
        if (!show(saved, pose)) return false;
        if (!same(state.pose, pose)) return true;
        if (reactions && !isSameEquilibrium(reactions, state.reactions, scene.rod)) {
            panel.say('The whisker had other contacts at this pose when this was saved: the way there decides which. Only the scene and the pose are restored.');
        }
        return true;
    }

    /// Opens the scene of the address; says why if it cannot.
    function openAddress(show) {
        const hash = location.hash.slice(1);
        if (hash === '') return false;
        try {
            return restore(fromText(fromHash(hash)), show);
        } catch (error) {
            panel.say(`The address is not opened: ${error.message}.`);
            return false;
        }
    }

    function download(name, type, text) {
        const link = document.createElement('a');
        link.href = URL.createObjectURL(new Blob([text], { type }));
        link.download = name;
        link.click();
        setTimeout(() => URL.revokeObjectURL(link.href), 10000);
    }

    function restart() {
        events = [];
        panel.events(events);
        chart.clear();
        clearTrail();
    }

    /// Another scene, or the same one with the clamp elsewhere. A recording is of one scene.
    function edit(changed, pose = state.pose) {
        const done = build(changed, pose);
        if (done) clearTrail();
        if (isRecording && recording.scene !== scene) stopRecording();
        // also where a slider was refused
        panel.scene(scene);
        due();
        return done;
    }

    for (const [name, [text]] of Object.entries(OBJECTS)) id('object').append(new Option(text, name));
    id('object').addEventListener('change', () => {
        restart();
        chosen = undefined;
        const other = preset(id('object').value);
        edit({ ...scene, ...other }, other.home);
    });
    for (const check of ['show-trail', 'hide-object', 'edit-object']) id(check).addEventListener('change', () => { isDirty = true; });
    id('edit-object').addEventListener('change', unchoose);
    id('clear-trail').addEventListener('click', clearTrail);
    id('reset').addEventListener('click', () => {
        restart();
        edit(scene, scene.home);
    });
    id('scan').addEventListener('click', () => {
        restart();
        scanning = edit(scene, scene.home);
        // the clamp has jumped to the start
        if (isRecording) startRecording();
    });
    id('record').addEventListener('click', () => {
        if (isRecording) stopRecording();
        else startRecording();
    });
    id('csv').addEventListener('click', () => download('recording.csv', 'text/csv', recording.toCsv()));
    id('save').addEventListener('click', () => {
        const [from, to] = recording?.scene === scene ? [recording.poseAt(0), recording.poseAt(-1)] : [scene.home, state.pose];
        download('scene.toml', 'application/toml', toToml(scene, from, to, state.pose, state.reactions));
    });
    id('load').addEventListener('click', () => id('file').click());
    id('file').addEventListener('change', async () => {
        try {
            const [file] = id('file').files;
            const loaded = fromToml(await file.text());
            restart();
            restore(loaded, edit);
        } catch (error) {
            panel.say(`Not loaded: ${error.message}.`);
        }
        id('file').value = '';
    });
    id('share').addEventListener('click', async () => {
        writeHash();
        try {
            await navigator.clipboard.writeText(location.href);
            panel.say('The link is in the clipboard.');
        } catch {
            panel.say('Copy the address of this page: it has the state.');
        }
    });
    addEventListener('hashchange', () => openAddress(edit));
    const fit = () => {
        view.fit();
        chart.fit();
        isDirty = true;
    };
    new ResizeObserver(fit).observe(id('view'));
    matchMedia('(prefers-color-scheme: dark)').addEventListener('change', fit);

    if (!openAddress(build)) {
        // why not: building the first scene says nothing
        const why = id('message').textContent, first = preset('parabolas');
        build({ ...first, rod: { ...WIRE } }, first.home);
        panel.say(why);
    }
    requestAnimationFrame(frame);
})().catch(error => {
    document.getElementById('message').textContent = `This page cannot run here: ${error.message}`;
});
