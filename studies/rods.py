"""The figures and numbers of docs/taper-curvature.md: what a taper and a curvature at rest change on object O1 of Merker et al. (2020).

    python3 studies/rods.py docs

Needs the package vibrissa (pip install ./python), numpy and matplotlib. Lengths in lengths of the rod, stiffness 1 at the clamp.
"""

import math
import sys
from pathlib import Path

import matplotlib

matplotlib.use("Agg")
import matplotlib.pyplot as plt
import numpy as np
from matplotlib.ticker import FormatStrFormatter, LogLocator, NullFormatter

import vibrissa

O1 = vibrissa.Composite([vibrissa.Parabola((0.0, 0.0), 5.0), vibrissa.Parabola((0.3, 0.0), 5.0)])
BASE = 0.01
MODULUS = 64.0 / (math.pi * BASE**4)
DISTANCES = [0.3, 0.4, 0.5]
TAPERS = np.linspace(0.0, 0.9, 37)
CURVATURES = np.linspace(-2.0, 2.0, 41)
COLOURS = ["#4477aa", "#ee6677", "#228833"]


def swept(rod, distance):
    """A sweep from outside to outside, or as far as it came."""
    way = vibrissa.ClampPath((1.6, -distance, math.pi / 2), (-1.6, -distance, math.pi / 2))
    try:
        return vibrissa.sweep(rod, O1, way, 5e-3)
    except vibrissa.SweepStopped as stopped:
        return stopped.scan


def slope(rod, state):
    """Derivatives of f0x, f0y, m0z by the way of the clamp, which goes to -x."""
    return -vibrissa.Derivatives(rod, O1, state).stiffness()[:, 0]


def transition(event):
    """What a transition is called here, if it is one of the three."""
    before, after = (0 if phase == "free" else len(phase) for phase in (event.before.phase, event.after.phase))
    if event.kind == "tip-to-tangent" and (before, after) == (1, 1):
        return "A to B"
    return {(1, 2): "one contact to two", (2, 1): "two contacts to one"}.get((before, after))


def kinks(rod, distance):
    """The first of each transition: the jump of the force's slope, that of the moment's, and the first over the range of the force in
    the scan; not a number where the reactions jump."""
    scan = swept(rod, distance)
    force = np.hypot(scan.states["f0x"], scan.states["f0y"])
    found = {}
    for number in range(len(scan.events)):
        event = scan.event(number)
        name = transition(event)
        if name is None or name in found:
            continue
        if event.kind in ("snap", "snap-off", "slip-over"):
            found[name] = (math.nan, math.nan, math.nan)
            continue
        jump = slope(rod, event.after) - slope(rod, event.before)
        size = math.hypot(jump[0], jump[1])
        found[name] = (size, abs(jump[2]), size / np.ptp(force))
    return found


def gap(rod, distance):
    """Width of the notch that no contact comes to; not a number where the sweep stops early or never touches both walls."""
    scan = swept(rod, distance)
    contacts = scan.contacts.values
    left, right = (contacts["x"][contacts["piece"] == piece] for piece in (0, 1))
    if scan.stop is not None or len(left) == 0 or len(right) == 0:
        return math.nan
    return right.min() - left.max()


def of_tapers(out):
    names = ["one contact to two", "two contacts to one", "A to B"]
    figure, axes = plt.subplots(2, 3, figsize=(180 / 25.4, 110 / 25.4), sharex=True, layout="constrained")
    for distance, colour in zip(DISTANCES, COLOURS):
        rods = [
            vibrissa.Rod(1.0, diameter=BASE, youngs_modulus=MODULUS, tip_diameter=(1.0 - taper) * BASE) for taper in TAPERS
        ]
        found = [kinks(rod, distance) for rod in rods]
        for column, name in zip(axes.T, names):
            values = np.array([one.get(name, (math.nan,) * 3) for one in found])
            column[0].semilogy(TAPERS, values[:, 0], color=colour, label=f"q = {distance} L")
            column[1].semilogy(TAPERS, values[:, 2], color=colour)
            kept = np.flatnonzero(np.isfinite(values[:, 0]))
            ends = [(f"{TAPERS[k]:.3f}", *(f"{value:.3g}" for value in values[k])) for k in kept[[0, -1]]]
            print(f"q = {distance}, {name}: taper, jump of force, of moment, over the range: {ends[0]} to {ends[1]}")
    for axis in axes.flat:
        axis.yaxis.set_major_locator(LogLocator(subs=(1.0, 2.0, 5.0)))
        axis.yaxis.set_major_formatter(FormatStrFormatter("%g"))
        axis.yaxis.set_minor_formatter(NullFormatter())
    for column, name in zip(axes.T, names):
        column[0].set_title(name, fontsize=8)
        column[1].set_xlabel("taper 1 − d(tip) / d(clamp)")
    axes[0, 0].set_ylabel("|jump of f0′| in EI(0) / L³")
    axes[1, 0].set_ylabel("|jump of f0′| over the range of |f0| in 1 / L")
    axes[0, 0].legend(frameon=False)
    figure.savefig(out / "taper-kinks.svg", metadata={"Date": None})


def of_curvatures(out):
    figure, (left, right) = plt.subplots(1, 2, figsize=(180 / 25.4, 75 / 25.4), layout="constrained")
    for distance, colour in zip([0.3, 0.4, 0.5, 0.6], [*COLOURS, "#ccbb44"]):
        gaps = np.array(
            [gap(vibrissa.Rod(1.0, 1.0, natural_curvature=curvature), distance) for curvature in CURVATURES]
        )
        left.plot(CURVATURES, gaps, color=colour, label=f"q = {distance} L")
        straight, least = gaps[len(gaps) // 2], int(np.nanargmin(gaps))
        print(
            f"q = {distance}: untouched width of the straight rod {straight:.3f}, least {gaps[least]:.3f} at curvature "
            f"{CURVATURES[least]:.1f}; {np.count_nonzero(np.isnan(gaps))} of {len(gaps)} sweeps stop or touch one wall"
        )
    left.set_xlabel("curvature at rest in 1 / L (positive: the tip ahead)")
    left.set_ylabel("untouched width of the notch in L")
    left.legend(frameon=False)
    x = np.linspace(-0.2, 0.62, 400)
    right.plot(x, np.minimum(5.0 * x**2, 5.0 * (x - 0.3) ** 2), color="grey", linewidth=0.8)
    # touched points, each rod's further off the contour than the last one's
    for number, (curvature, colour) in enumerate([(-1.0, COLOURS[0]), (0.0, "black"), (1.0, COLOURS[1])], 1):
        contacts = swept(vibrissa.Rod(1.0, 1.0, natural_curvature=curvature), 0.4).contacts.values
        out_by = 0.012 * number
        xs, ys = contacts["x"] + out_by * np.sin(contacts["alpha"]), contacts["y"] - out_by * np.cos(contacts["alpha"])
        right.plot(xs, ys, ".", markersize=2, color=colour, label=f"{curvature:+.0f} / L, {out_by:.3f} L off" if curvature else f"straight, {out_by:.3f} L off")
    right.set(xlabel="x in L", ylabel="y in L", xlim=(-0.2, 0.62), ylim=(-0.06, 0.45))
    right.set_title("contacts at q = 0.4 L, drawn off the contour", fontsize=8)
    right.set_aspect("equal")
    right.legend(frameon=False, loc="upper center", markerscale=4, title="curvature at rest")
    figure.savefig(out / "curvature-reach.svg", metadata={"Date": None})


if __name__ == "__main__":
    place = Path(sys.argv[1])
    plt.rcParams.update({"font.size": 8, "svg.hashsalt": "vibrissa"})
    of_tapers(place)
    of_curvatures(place)
