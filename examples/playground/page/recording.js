// Poses and reactions while the clamp moves, as a table that `vibrissa reconstruct` reads.
(globalThis.playground ??= {}).Recording = class Recording {
    static NAMES = ['t', 'x0', 'y0', 'phi0', 'f0x', 'f0y', 'm0z'];
    /// An hour at 60 samples a second.
    static MOST = 216000;
    rows = [];

    /// A sample at the time `t`, s.
    add(t, { pose, reactions }) {
        if (this.rows.length < Recording.MOST) this.rows.push([t, ...pose, ...reactions]);
    }

    poseAt(index) {
        return this.rows.at(index)?.slice(1, 4);
    }

    toCsv() {
        return `${[Recording.NAMES, ...this.rows].map(row => row.join(',')).join('\n')}\n`;
    }
};
