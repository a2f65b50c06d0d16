"""The next scans: the numbers of the command, tables, a figure, errors."""

from __future__ import annotations

import csv
import math
import shutil
import signal
import subprocess
import threading
import time
from pathlib import Path

import numpy as np
import pytest
from conftest import SCENES

import vibrissa
import vibrissa.plot

NOISE = {"white": {"force": 2.5e-3, "m0z": 6e-5}}
ANGLES = [60.0, 90.0, 120.0]


@pytest.fixture(scope="module")
def found() -> vibrissa.Reconstruction:
    scene = vibrissa.Scene.read(SCENES / "O1_q40.toml")
    samples = vibrissa.simulate(scene, rate=50.0, speed=1e-2, noise=NOISE, seed=10)
    return vibrissa.reconstruct(scene.rod, samples, noise=NOISE, as_is=True)


def plan(found: vibrissa.Reconstruction) -> vibrissa.Plan:
    return vibrissa.plan(found, distances=[0.05, 0.07], angles=[math.radians(angle) for angle in ANGLES], stress="any", hypotheses=2, noise=NOISE)


def test_tables_and_figure(found: vibrissa.Reconstruction) -> None:
    planned = plan(found)
    assert len(planned.candidates) == 12 and len(planned.hypotheses) >= 2
    assert list(planned.chosen["chosen"]) == list(range(1, len(planned.chosen) + 1))
    # those that are ruled out are the last
    assert (planned.candidates["gain"][1:] > planned.candidates["gain"][:-1]).sum() == 0
    assert planned.to_pandas().attrs["units"]["gain"] == "m"
    ax = planned.plot()
    assert planned.plot(ax) is ax
    labels = ax.get_legend_handles_labels()[1]
    assert "touched" in labels and "hypotheses" in labels


def test_numbers_are_those_of_the_command(found: vibrissa.Reconstruction, command: list[str], tmp_path: Path) -> None:
    shutil.copy(SCENES / "O1_q40.toml", tmp_path)
    rows = found.samples
    names = ["x0", "y0", "phi0", "f0x", "f0y", "m0z"]
    lines = [",".join(names), *(",".join(repr(float(row[name])) for name in names) for row in rows)]
    (tmp_path / "recording.csv").write_text("\n".join(lines) + "\n")
    (tmp_path / "noise.toml").write_text("white = { force = 2.5e-3, m0z = 6e-5 }\n")
    rod = ["--rod", "O1_q40.toml", "--noise", "noise.toml"]
    for arguments in (
        ["reconstruct", "recording.csv", *rod, "--as-is", "--out", "result"],
        ["plan", "result", *rod, "--distances", "0.05,0.07", "--angles", "60,90,120", "--stress", "any", "--hypotheses", "2", "--out", "next"],
    ):
        subprocess.run([*command, *arguments], cwd=tmp_path, check=True, capture_output=True)
    ours = plan(found).candidates
    with open(tmp_path / "next/candidates.csv") as file:
        theirs = list(csv.DictReader(file))
    assert [int(row["chosen"] or 0) for row in theirs] == list(ours["chosen"])
    for name in ("angle", "x_from", "y_to", "gain", "gain_sigma", "largest_stress", "sigma", "known_sigma_after"):
        np.testing.assert_array_equal([float(row[name] or "nan") for row in theirs], ours[name], err_msg=name)


def test_ctrl_c_ends_a_plan(found: vibrissa.Reconstruction) -> None:
    timer = threading.Timer(0.5, signal.raise_signal, [signal.SIGINT])
    # a shell that runs the tests in the background lets them ignore Ctrl-C
    before = signal.signal(signal.SIGINT, signal.default_int_handler)
    began = time.monotonic()
    timer.start()
    try:
        # minutes of work
        with pytest.raises(KeyboardInterrupt):
            vibrissa.plan(found, distances=list(np.linspace(0.03, 0.08, 200)), stress="any", noise=NOISE)
    finally:
        signal.signal(signal.SIGINT, before)
    assert time.monotonic() - began < 5.0


def test_wrong_arguments_are_named(found: vibrissa.Reconstruction) -> None:
    local = vibrissa.reconstruct(found.rod, found.samples, noise=NOISE, as_is=True, fit=False)
    with pytest.raises(ValueError, match="no fitted contour, expected one of a recording with noise"):
        vibrissa.plan(local)
    with pytest.raises(ValueError, match="stress is -1 Pa, expected a positive, finite number"):
        vibrissa.plan(found, stress=-1.0)
    with pytest.raises(ValueError, match="distances has 0.2 m, expected more than 0"):
        vibrissa.plan(found, distances=0.2, stress=1e9)
    with pytest.raises(ValueError, match="the largest stress that the rod bears is not known"):
        vibrissa.plan(found)
    spline = vibrissa.ClampSpline([(0.08, -0.04, 1.5), (0.0, -0.05, 1.5), (-0.08, -0.04, 1.5)])
    with pytest.raises(ValueError, match="paths has one of which the parameter is not the way"):
        vibrissa.plan(found, paths=[spline], stress=1e9)


def test_given_paths_come_first_and_the_stress_is_kept(found: vibrissa.Reconstruction) -> None:
    up = math.pi / 2
    paths = [vibrissa.ClampPath((0.08, -0.04, up), (-0.09, -0.04, up)), vibrissa.ClampArc((0.11, -0.06, up), (0.01, -0.06), 0.8, up)]
    planned = vibrissa.plan(found, distances=0.05, angles=up, paths=paths, stress="any", hypotheses=2)
    by_number = np.sort(planned.candidates, order="candidate")
    assert len(by_number) == 4 and list(by_number["pass"]) == ["", "", "left", "right"]
    for row, path in zip(by_number, paths, strict=False):
        np.testing.assert_allclose([row["x_from"], row["y_from"], row["x_to"], row["y_to"]], [*path.start[:2], *path.end[:2]])
        assert row["time"] == pytest.approx(path.length / 1e-3)
    # the scan that is known adds least: only beyond the ends of the contour
    assert by_number["gain"][0] < by_number["gain"][2:].min() and not np.isnan(by_number["gain"]).any()
    limited = vibrissa.plan(found, distances=0.05, angles=up, paths=paths, stress=1e9, hypotheses=2)
    assert (limited.chosen["largest_stress"] <= 1e9).all()
    # a scan that is ruled out has no gain
    assert (np.isnan(limited.candidates["gain"]) == (limited.candidates["largest_stress"] > 1e9)).all()
