"""The figure and the numbers of docs/friction.md: loops of a rod with Coulomb friction whose clamp goes there and back.

    python3 studies/hysteresis.py docs

Needs the package vibrissa (pip install ./python), numpy and matplotlib. The rod of Merker et al. (2020), object O1, q = 40 mm.
"""

import math
import sys
from pathlib import Path

import matplotlib

matplotlib.use("Agg")
import matplotlib.pyplot as plt
import numpy as np

import vibrissa
from vibrissa import plot

ROD = vibrissa.Rod(0.1, diameter=0.5e-3, youngs_modulus=206e9)
O1 = vibrissa.Composite([vibrissa.Parabola((0.0, 0.0), 50.0), vibrissa.Parabola((0.03, 0.0), 50.0)])
MU = 0.3
# Cycles after which a loop repeats itself: the first half of one is still different.
CYCLES = 2


def way(*positions):
    return vibrissa.Chain.polyline([(x, -0.04, math.pi / 2) for x in positions])


def loop(out):
    scan = vibrissa.sweep(ROD, O1, way(0.08, -0.04, 0.08), 1e-4, friction=MU)
    axes = plot.hysteresis(scan)
    axes[0].figure.savefig(out / "hysteresis.svg", metadata={"Date": None})
    print(f"loop from 80 mm to -40 mm and back: friction takes {1e3 * scan.dissipated:.3f} mJ")
    for event in scan.events:
        print(f"  leg {event['leg']}: {event['kind']} at {1e3 * event['x0']:.3f} mm, {event['from']} to {event['to']}")


def smooth(x):
    """The reactions without friction at a pose."""
    return vibrissa.sweep(ROD, O1, vibrissa.ClampPath((0.08, -0.04, math.pi / 2), (x, -0.04, math.pi / 2)), 0.1).states[-1]


def at(scan, leg, x):
    """The state of a leg at a pose."""
    found = np.flatnonzero((scan.states["leg"] == leg) & (np.abs(scan.states["x0"] - x) < 1e-9))
    return scan.states[found[0]]


def amplitudes():
    """How wide the loop is where the clamp goes to and fro about x = 0, and what a cycle costs."""
    print("amplitude mm, width of f0x mN, of m0z N mm, work of a cycle uJ, middle of f0x less that without friction mN")
    exact = smooth(0.0)["f0x"]
    for amplitude in (2e-5, 5e-5, 1e-4, 2e-4, 5e-4, 1e-3, 2e-3, 5e-3, 1e-2, 2e-2):
        turns = [amplitude * sign for _ in range(CYCLES) for sign in (-1.0, 1.0)]
        scan = vibrissa.sweep(ROD, O1, way(0.08, *turns), amplitude / 4.0, friction=MU)
        before = vibrissa.sweep(ROD, O1, way(0.08, *turns[:-2]), amplitude / 4.0, friction=MU)
        ways = [at(scan, len(turns) - 2 + k, 0.0) for k in (0, 1)]
        width, moment = (abs(ways[0][name] - ways[1][name]) for name in ("f0x", "m0z"))
        work = scan.dissipated - before.dissipated
        middle = 0.5 * (ways[0]["f0x"] + ways[1]["f0x"]) - exact
        print(f"{1e3 * amplitude:g}, {1e3 * width:.2f}, {1e3 * moment:.3f}, {1e6 * work:.3f}, {1e3 * middle:.2f}")


def dither():
    """What is left of friction where the clamp comes to x = 0 to and fro, in swings that become smaller."""
    exact = smooth(0.0)
    one_way = vibrissa.sweep(ROD, O1, way(0.08, 0.0), 0.1, friction=MU).states[-1]
    print(f"f0x without friction {exact['f0x']:.5f} N, m0z {1e3 * exact['m0z']:.4f} N mm; from one side {one_way['f0x']:.5f} N, {1e3 * one_way['m0z']:.4f} N mm")
    effect = one_way["f0x"] - exact["f0x"]
    print("factor, first side, share of the effect of friction on f0x that is left, %")
    for factor in (0.8, 0.9, 0.95, 0.98):
        for side in (-1.0, 1.0):
            swings, size = [], 2e-3
            while size > 1e-5:
                swings.extend([side * size, -side * size])
                size *= factor
            end = vibrissa.sweep(ROD, O1, way(0.08, *swings, 0.0), 0.1, friction=MU).states[-1]
            print(f"{factor}, {side:+.0f}, {100.0 * (end['f0x'] - exact['f0x']) / effect:.1f}")


def whisking():
    """Where a whisker that turns past a peg snaps off and touches again, with and without friction."""
    file = Path(__file__).parents[1] / "scenes/whisking.toml"
    for friction in (0.0, 0.1, 0.2, 0.3):
        scan = vibrissa.Scene.parse(f"{file.read_text()}\n[contact]\nfriction = {friction}\n").sweep()
        places = [(str(e["kind"]), f"{math.degrees(e['phi0']):.3f}") for e in scan.events if e["kind"] not in ("piece",)]
        peak = np.abs(scan.states["m0z"]).max()
        # without the jump of the snap-off
        jumps = sum(event.before.energy - event.after.energy for event in map(scan.event, range(len(scan.events))))
        taken = "none" if scan.dissipated is None else f"{1e9 * (scan.dissipated - jumps):.3f} nJ"
        print(f"whisking, mu = {friction}: largest moment {1e6 * peak:.3f} uN m, friction takes {taken}: {places}")


if __name__ == "__main__":
    plt.rcParams["svg.hashsalt"] = "vibrissa"
    loop(Path(sys.argv[1]))
    amplitudes()
    dither()
    whisking()
