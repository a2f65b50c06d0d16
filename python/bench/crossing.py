"""What it costs to cross from Python to Rust: the time in Python over that of the same work in Rust.

Run it in the folder ``python`` with the release build installed (``pip install .``)::

    python bench/crossing.py

It builds and runs ``files/examples/rust_times.rs``, and takes the shortest of several times on both sides, which other work of the
machine disturbs least. Times in Python include the arrays: all fields of states, events and contacts, or all answers and the contour.
Not included are the texts of ``reasons``, which are made when they are asked for.
"""

from __future__ import annotations

import subprocess
import tempfile
import time
from collections.abc import Callable
from pathlib import Path

import vibrissa

HERE = Path(__file__).parents[1]
SCENE = HERE.parent / "scenes" / "O1_q40.toml"
SWEEPS, RECONSTRUCTIONS = 30, 3
SAMPLES = 65_000


def shortest(rounds: int, work: Callable[[], object]) -> float:
    """The shortest time of several, in s."""
    times = []
    for _ in range(rounds):
        begin = time.perf_counter()
        work()
        times.append(time.perf_counter() - begin)
    return min(times)


def main() -> None:
    scene = vibrissa.Scene.read(SCENE)
    step = scene.path.length / 1000.0
    noise = {"white": {"force": 2.5e-3, "m0z": 6e-5}}
    samples = vibrissa.simulate(scene, rate=SAMPLES / scene.path.length, speed=1.0, noise=noise)

    def sweep() -> object:
        scan = vibrissa.sweep(scene.rod, scene.objects, scene.path, step)
        return scan.states, scan.events, scan.contacts

    def reconstruct() -> object:
        found = vibrissa.reconstruct(scene.rod, samples)
        return found.readings, found.contour

    with tempfile.TemporaryDirectory() as folder:
        file = Path(folder) / "recording.csv"
        names = ["t", "x0", "y0", "phi0", "f0x", "f0y", "m0z"]
        rows = [",".join(names)] + [",".join(repr(float(row[name])) for name in names) for row in samples]
        file.write_text("\n".join(rows) + "\n")
        example = ["cargo", "run", "--quiet", "--release", "--package", "rod-files", "--example", "rust_times", "--"]
        arguments = [str(SCENE), str(file), str(SWEEPS), str(RECONSTRUCTIONS)]
        done = subprocess.run([*example, *arguments], cwd=HERE, check=True, capture_output=True, text=True)
    in_rust = [float(number) for number in done.stdout.split()]
    in_python = [shortest(SWEEPS, sweep), shortest(RECONSTRUCTIONS, reconstruct)]
    for what, python, rust in zip(["sweep, 1,000 steps", f"reconstruct, {len(samples)} samples"], in_python, in_rust):
        print(f"{what}: Python {1e3 * python:.2f} ms, Rust {1e3 * rust:.2f} ms, ratio {python / rust:.3f}")


if __name__ == "__main__":
    main()
