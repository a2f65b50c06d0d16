// Scenes: objects to choose from, a scene as text for the address of the page, and as a scene file of Vibrissa. SI units, angles in rad.
(() => {
    const UP = Math.PI / 2;

    /// A square of this side with its centre at the middle, turned by an angle.
    const square = (side, [x, y], angle) => [[-1, -1], [1, -1], [1, 1], [-1, 1]].map(([u, v]) => [
        x + side / 2 * (u * Math.cos(angle) - v * Math.sin(angle)),
        y + side / 2 * (u * Math.sin(angle) + v * Math.cos(angle)),
    ]);

    /// Teeth that hang from a bar.
    function comb(teeth, pitch, depth, bar) {
        const left = -(teeth - 1) / 2 * pitch, points = [];
        for (let tooth = 0; tooth < teeth; tooth++) {
            const x = left + tooth * pitch;
            if (tooth > 0) points.push([x - 0.3 * pitch, depth]);
            points.push([x - 0.1 * pitch, 0], [x + 0.1 * pitch, 0]);
            if (tooth < teeth - 1) points.push([x + 0.3 * pitch, depth]);
        }
        const edge = -left + 0.4 * pitch;
        return [...points, [edge, depth + bar], [-edge, depth + bar]];
    }

    /// name: [text, shapes, pose of the clamp (x, y, phi)], all of them free of contact at their pose.
    const OBJECTS = {
        parabolas: ['Two parabolas (paper)', [
            { shape: 'parabola', vertex: [0, 0], coefficient: 50 },
            { shape: 'parabola', vertex: [0.03, 0], coefficient: 50 },
        ], [0.08, -0.04, UP]],
        disc: ['Disc', [{ shape: 'disc', center: [0, 0.02], radius: 0.025 }], [0.08, -0.06, UP]],
        pegs: ['Three pegs', [-0.035, 0, 0.035].map((x, index) =>
            ({ shape: 'disc', center: [x, index === 1 ? -0.008 : 0.005], radius: 0.006 })), [0.08, -0.06, UP]],
        square: ['Square', [{ shape: 'polygon', points: square(0.04, [0, 0.02], 0.4) }], [0.08, -0.06, UP]],
        comb: ['Comb', [{ shape: 'polygon', points: comb(5, 0.022, 0.018, 0.012) }], [0.09, -0.06, UP]],
    };

    /// Steel wire, 100 mm long and 0.5 mm thick, as in the paper.
    const WIRE = { length: 0.1, diameter: 0.5e-3, modulus: 206e9, taper: 1, curvature: 0, friction: 0 };
    /// What the page accepts, by name.
    const LIMITS = {
        length: [0.04, 0.15], diameter: [1e-4, 1e-3], modulus: [1e6, 1e12], taper: [0.1, 1], curvature: [-12, 12], friction: [0, 1],
    };

    /// Relative difference of the reactions of one equilibrium.
    const SAME = 1e-3;

    /// Distance that no drawing shows, m: a quarter of a pixel of a window of 1200 px. Where the method holds, points are exact to 1e-9 m.
    const DRAWN = 5e-5;

    const preset = object => {
        const [, shapes, home] = OBJECTS[object];
        return { object, shapes: structuredClone(shapes), home: [...home] };
    };

    /// EI at the clamp, N m^2.
    const stiffness = ({ diameter, modulus }) => modulus * Math.PI * diameter ** 4 / 64;

    // Numbers from outside: finite, and not so large that the rod could not reach there.
    const isNumber = value => typeof value === 'number' && Math.abs(value) <= 1e4;
    const isPoint = value => Array.isArray(value) && value.length === 2 && value.every(v => isNumber(v) && Math.abs(v) <= 1);
    const isPose = value => Array.isArray(value) && value.length === 3 && value.every(v => isNumber(v) && Math.abs(v) <= 50);
    const isShape = shape => shape?.shape === 'parabola' ? isPoint(shape.vertex) && isNumber(shape.coefficient)
        : shape?.shape === 'disc' ? isPoint(shape.center) && isNumber(shape.radius)
        : shape?.shape === 'polygon' && Array.isArray(shape.points) && shape.points.length <= 100 && shape.points.every(isPoint);

    /// The value of a text in JSON; throws where it is none.
    function parsed(text) {
        try {
            return JSON.parse(text) ?? {};
        } catch {
            throw new Error('it is damaged or cut off');
        }
    }

    /// The scene of a text that `toText` has made, with the reactions at its pose; throws where it is none. Nothing of it is trusted.
    function fromText(text) {
        const { object, shapes, home, pose, rod, reactions } = parsed(text);
        const isRod = Object.entries(LIMITS).every(([name, [least, most]]) =>
            isNumber(rod?.[name]) || name === 'modulus' && least <= rod?.modulus && rod.modulus <= most);
        if (!Object.hasOwn(OBJECTS, object) || !Array.isArray(shapes) || shapes.length === 0 || shapes.length > 20
            || !shapes.every(isShape) || !isPose(home) || !isPose(pose) || !isRod) throw new Error('it is no scene of this page');
        const within = ([name, [least, most]]) => [name, Math.min(most, Math.max(least, rod[name]))];
        const felt = Array.isArray(reactions) && reactions.length === 3 && reactions.every(isNumber) ? { reactions } : {};
        return { object, shapes, home, pose, rod: Object.fromEntries(Object.entries(LIMITS).map(within)), ...felt };
    }

    /// Nanometres and nanoradians are enough to go on from. At one pose there may be several equilibria: the reactions tell which it is.
    const toText = ({ object, shapes, home, rod }, pose, reactions) => JSON.stringify({ object, shapes, home, pose, rod, reactions },
        (_, value) => typeof value === 'number' && Math.abs(value) < 100 ? Number(value.toPrecision(10)) : value);

    // Base64 of the text, in the letters that an address may have.
    const toHash = text => btoa(text).replaceAll('+', '-').replaceAll('/', '_').replace(/=+$/, '');
    function fromHash(hash) {
        try {
            return atob(hash.replaceAll('-', '+').replaceAll('_', '/'));
        } catch {
            throw new Error('it is damaged or cut off');
        }
    }

    /// Whether two reactions are those of one equilibrium, but for the digits of an address: forces relative to EI / L^2.
    function isSameEquilibrium(one, other, rod) {
        const force = stiffness(rod) / rod.length ** 2, units = [force, force, force * rod.length];
        return one.every((value, index) => Math.abs(value - other[index]) <= SAME * (units[index] + Math.abs(value)));
    }

    /// Whether a point that the reactions give is the contact of the simulation. It is not where there are several, and may be another one
    /// where friction turns the force of the contact: the moment vanishes at both.
    const isContact = ({ x, y }, contacts) => contacts.length === 1 && Math.hypot(x - contacts[0].x, y - contacts[0].y) < DRAWN;

    const degrees = angle => Number((angle * 180 / Math.PI).toPrecision(12));
    /// A number as TOML reads a float.
    const float = value => Number.isInteger(value) ? value.toFixed(1) : String(value).replace(/^(-?\d+)e/, '$1.0e');
    const point = values => `[${values.map(float).join(', ')}]`;
    const ENTRY = '# playground: ';

    /// A scene file that `vibrissa sweep` reads: from the first pose of the scene, or of a recording, to another one. The page finds itself in
    /// the comment at the end again.
    function toToml(scene, from, to, now, reactions) {
        const { rod, shapes } = scene;
        const lines = ['# Scene of the playground.', '[rod]', `length = ${float(rod.length)} # m`,
            `diameter = ${float(rod.diameter)} # m`, `youngs_modulus = ${float(rod.modulus)} # Pa`];
        if (rod.taper !== 1) lines.push(`tip_diameter = ${float(rod.diameter * rod.taper)} # m`);
        if (rod.curvature !== 0) lines.push(`natural_curvature = ${float(rod.curvature)} # 1/m`);
        if (rod.friction !== 0) lines.push('', '[contact]', `friction = ${float(rod.friction)}`);
        shapes.forEach((shape, index) => {
            // parabolas are pieces of one object
            if (index === 0 || shape.shape !== 'parabola') lines.push('', '[[object]]');
            lines.push('', '[[object.piece]]');
            if (shape.shape === 'parabola') {
                lines.push('shape = "parabola"', `vertex = ${point(shape.vertex)} # m`, `coefficient = ${float(shape.coefficient)} # 1/m`);
            } else if (shape.shape === 'disc') {
                lines.push('shape = "arc"', `center = ${point(shape.center)} # m`, `radius = ${float(shape.radius)} # m`,
                    'from_angle = 0.0 # degrees', 'to_angle = 360.0');
            } else {
                lines.push('shape = "polygon"', `points = [${shape.points.map(point).join(', ')}] # m`);
            }
        });
        // a sweep that leads nowhere is an error: then it goes to the other side
        const stands = from.every((value, index) => Math.abs(value - to[index]) < 1e-9);
        const [x, y, phi] = stands ? [-from[0] || 0.01, from[1], from[2]] : to;
        lines.push('', '[sweep]', `from = ${point(from.slice(0, 2))} # clamp position, m`, `to = ${point([x, y])}`,
            `angle = ${float(degrees(from[2]))} # clamp direction, degrees`);
        if (phi !== from[2]) lines.push(`angle_to = ${float(degrees(phi))}`);
        // a sweep that only turns has steps of angle
        lines.push(Math.hypot(x - from[0], y - from[1]) > 1e-9 ? 'step = 1e-3 # m' : 'step_angle = 1.0 # degrees');
        return `${lines.join('\n')}\n${ENTRY}${toText(scene, now, reactions)}\n`;
    }

    /// The scene of a file that `toToml` has written; the tables themselves are not read.
    function fromToml(file) {
        const entry = file.split('\n').find(line => line.startsWith(ENTRY));
        if (entry === undefined) throw new Error('only scene files that this page has saved can be loaded');
        return fromText(entry.slice(ENTRY.length));
    }

    Object.assign(globalThis.playground ??= {},
        { OBJECTS, WIRE, LIMITS, preset, stiffness, toText, fromText, toHash, fromHash, toToml, fromToml, isSameEquilibrium, isContact });
})();
