"""Recordings, simulated and read, and what they tell."""

from __future__ import annotations

import csv
import json
import subprocess
from pathlib import Path

import numpy as np
import pytest
from conftest import SCENES

import vibrissa

NOISE = {"ar1": {"force": 2.5e-3, "m0z": 6e-5, "correlation": 0.45}}
NOISE_FILE = "ar1 = { force = 2.5e-3, m0z = 6e-5, correlation = 0.45 }\n"


@pytest.fixture
def scene() -> vibrissa.Scene:
    return vibrissa.Scene.read(SCENES / "O1_q40.toml")


def test_a_clean_scan_gives_its_contacts_back(scene: vibrissa.Scene) -> None:
    scan = vibrissa.sweep(scene.rod, scene.objects, scene.path, 5e-5)
    found = vibrissa.reconstruct(scene.rod, scan.states, as_is=True)
    assert [label for _, _, label in found.runs] == ["free", "A", "B", "BB", "BA", "B", "A", "free"]
    readings = found.readings
    single = np.isin(readings["label"], ["A", "B"]) & ~np.isnan(readings["x"])
    truth = np.array([contacts["x"][0] if len(contacts) else np.nan for contacts in scan.contacts])
    assert single.sum() > 1000
    np.testing.assert_allclose(readings["x"][single], truth[single], atol=1e-7)
    both = readings["label"] == "BA"
    second = np.array([contacts["x"][-1] if len(contacts) else np.nan for contacts in scan.contacts])
    assert np.nanmax(np.abs(readings["second_x"] - second)[both]) < 1e-6
    gaps = scene.objects[0].gap(found.contour["x"], found.contour["y"])
    assert len(gaps) > 100 and np.abs(gaps).max() < 1e-6
    assert found.fits and found.explain() == []
    # an array of six columns and a data frame say the same
    columns = ["x0", "y0", "phi0", "f0x", "f0y", "m0z"]
    rows = np.column_stack([scan.states[name] for name in columns])
    for samples in [rows, scan.to_pandas(), {name: scan.states[name].tolist() for name in columns}]:
        again = vibrissa.reconstruct(scene.rod, samples, as_is=True)
        np.testing.assert_array_equal(again.readings["x"], readings["x"])


def test_one_contour_explains_a_recording(scene: vibrissa.Scene, tmp_path: Path) -> None:
    noise = tmp_path / "noise.toml"
    noise.write_text(NOISE_FILE)
    samples = vibrissa.simulate(scene, rate=20, speed=1e-3, noise=noise)
    plain = vibrissa.reconstruct(scene.rod, samples, as_is=True, fit=False)
    assert plain.is_explained is None and plain.contradiction is None and len(plain.fitted) == 0
    found = vibrissa.reconstruct(scene.rod, samples, as_is=True)
    assert found.is_explained and found.contradiction is None
    touched = found.fitted[found.fitted["known"] == "touched"]
    bounded = found.fitted[found.fitted["known"] == "bounded"]
    assert len(bounded) and np.all(bounded["room"] >= 0) and np.all(np.isnan(bounded["sigma"]))
    gaps = scene.objects[0].gap(touched["x"], touched["y"])
    assert len(touched) > 5 and np.all(np.abs(gaps) < 5 * touched["sigma"])
    # the object is two parabolas
    best = found.shapes[(found.shapes["evidence"] == 0) & (found.shapes["parameter"] == "coefficient")]
    assert set(best["shape"]) == {"parabola"} and np.all(np.abs(best["value"] - 50) < 4 * best["sigma"])
    # its points lie on it
    points = found.readings[~np.isnan(found.readings["x"])]
    off = np.abs(scene.objects[0].gap(points["x"], points["y"]))
    assert np.mean(off < 3 * np.hypot(points["sigma_x"], points["sigma_y"])) > 0.95


# The clamp goes there, about a pivot and back, and in the end turns on the spot.
LEGS = "\n[[sweep.leg]]\nangle_to = 80.0\nstep_angle = 1.0\n"
# It only turns, past two objects that rub.
TURNING = """
[rod]
length = 0.1
diameter = 0.5e-3
youngs_modulus = 206e9
[contact]
friction = 0.2
[[object]]
[[object.piece]]
shape = "arc"
center = [-0.02, 0.06]
radius = 0.02
[[object]]
[[object.piece]]
shape = "arc"
center = [0.07, -0.01]
radius = 0.02
[sweep]
from = [0.0, 0.0]
angle = 70.0
angle_to = 100.0
step_angle = 1.0
[[sweep.leg]]
angle_to = 40.0
"""


@pytest.mark.parametrize("text", [(SCENES / "whisking.toml").read_text() + LEGS, TURNING], ids=["legs", "turning"])
def test_all_paths_of_scene_files_are_simulated_as_by_the_command(
    text: str, command: list[str], tmp_path: Path
) -> None:
    (tmp_path / "scene.toml").write_text(text)
    (tmp_path / "noise.toml").write_text(NOISE_FILE + "dropout.probability = 0.1\n")
    options = ["--noise", "noise.toml", "--rate", "20", "--speed", "0.005", "--seed", "5", "--file", "recording.csv"]
    subprocess.run([*command, "simulate", "scene.toml", *options], check=True, capture_output=True, cwd=tmp_path)
    rows = list(csv.DictReader((tmp_path / "recording.csv").open()))
    scene = vibrissa.Scene.read(tmp_path / "scene.toml")
    samples = vibrissa.simulate(scene, rate=20.0, speed=0.005, noise=tmp_path / "noise.toml", seed=5)
    assert len(rows) == len(samples) > 100
    truth = vibrissa.simulate(scene, rate=20.0, speed=0.005)
    assert len(truth) > len(samples) and np.count_nonzero(truth["m0z"]) > 30
    for name in ["t", "x0", "y0", "phi0", "f0x", "f0y", "m0z"]:
        assert [float(row[name]) for row in rows] == samples[name].tolist()


def test_what_cannot_be_simulated_is_said(rod: vibrissa.Rod, parabolas: vibrissa.Composite) -> None:
    spline = vibrissa.ClampSpline([(0.1, -0.1, 1.5), (0.0, -0.1, 1.2), (-0.1, -0.11, 1.5)])
    with pytest.raises(ValueError, match="^the path has no form in scene files, expected straight legs, or legs about"):
        vibrissa.simulate(vibrissa.Scene(rod, parabolas, spline, 1e-3), rate=10.0, speed=1e-3)
    line = vibrissa.Chain.polyline([(0.1, -0.1, 1.5), (0.0, -0.1, 1.5), (0.1, -0.1, 1.5)])
    with pytest.raises(ValueError, match="^rate 1000000 Hz at speed 0.001 m/s asks for 2.0e8 samples on a path of 0.2"):
        vibrissa.simulate(vibrissa.Scene(rod, parabolas, line, 1e-3), rate=1e6, speed=1e-3)


@pytest.mark.parametrize("fit", [True, False])
def test_simulated_and_reconstructed_as_by_the_command(
    scene: vibrissa.Scene, command: list[str], tmp_path: Path, fit: bool
) -> None:
    (tmp_path / "noise.toml").write_text(NOISE_FILE)
    file = tmp_path / "recording.csv"
    options = ["--noise", str(tmp_path / "noise.toml"), "--rate", "500", "--speed", "0.01", "--seed", "3"]
    subprocess.run(
        [*command, "simulate", str(SCENES / "O1_q40.toml"), *options, "--file", str(file)], check=True, capture_output=True
    )
    samples = vibrissa.simulate(scene, rate=500.0, speed=0.01, noise=NOISE, seed=3)
    rows = list(csv.DictReader(file.open()))
    assert len(rows) == len(samples)
    for name in ["t", "x0", "f0x", "f0y", "m0z"]:
        assert [float(row[name]) for row in rows] == samples[name].tolist()
    with_file = vibrissa.simulate(scene, rate=500.0, speed=0.01, noise=tmp_path / "noise.toml", seed=3)
    np.testing.assert_array_equal(with_file["m0z"], samples["m0z"])

    recording = vibrissa.Recording.read(file, scene.rod)
    np.testing.assert_array_equal(recording.samples["f0x"], samples["f0x"])
    found = vibrissa.reconstruct(scene.rod, recording, fit=fit)
    out = tmp_path / "out"
    how = [] if fit else ["--local"]
    done = subprocess.run(
        [*command, "reconstruct", str(file), "--rod", str(SCENES / "O1_q40.toml"), "--out", str(out), *how],
        capture_output=True,
    )
    assert done.returncode in (0, 2), done.stderr
    points = [json.loads(line) for line in (out / "points.jsonl").read_text().splitlines()]
    assert len(points) == len(found)
    for reading, why, point in zip(found.readings, found.reasons, points):
        # the contour of a fit needs no basis: null in the file, empty in the array
        basis = point["basis"] or "" if fit else point["basis"]
        assert reading["label"] == point["label"] and reading["basis"] == basis
        assert why["reason"] == (point["reason"] or "")
        for name in ["x", "y", "s", "alpha", "force", "sigma_x", "systematic_y", "probability"]:
            assert (np.isnan(reading[name]) and point[name] is None) or reading[name] == point[name]
        if point["second"] is not None and point["second"]["x"] is not None:
            assert reading["second_x"] == point["second"]["x"]
    if fit:
        fitted = list(csv.DictReader((out / "fitted.csv").open()))
        assert found.is_explained and [float(row["y"]) for row in fitted] == found.fitted["y"].tolist()
        assert [int(row["object"]) for row in fitted] == found.fitted["object"].tolist()
    contour = list(csv.DictReader((out / "contour.csv").open()))
    assert [float(row["sigma"]) for row in contour] == found.contour["sigma"].tolist()
    report = json.loads((out / "report.json").read_text())
    assert [one["value"] for one in report["calibration"]["sources"]] == found.calibration["value"].tolist()
    assert found.to_pandas("contour").attrs["units"]["sigma"] == "m"
    table = found.to_arrow()
    assert table["label"].to_pylist() == found.readings["label"].tolist()
    assert table["reason"].to_pylist() == found.reasons["reason"].tolist()


def test_a_wrong_rod_is_told(scene: vibrissa.Scene) -> None:
    scan = vibrissa.sweep(scene.rod, scene.objects, scene.path, 1e-4)
    states = scan.to_pandas()
    states["m0z"] = -states["m0z"]
    with pytest.warns(UserWarning, match="recording, units and rod do not fit: "):
        found = vibrissa.reconstruct(scene.rod, states)
    assert not found.fits and found.findings
    explained = found.explain()
    assert sum(share for _, share in explained) == pytest.approx(1.0)


def test_live_answers_come_once_and_in_order(scene: vibrissa.Scene) -> None:
    samples = vibrissa.simulate(scene, rate=2000.0, speed=0.01, noise=NOISE)
    live = vibrissa.Live(scene.rod, samples[:500], as_is=True)
    answers = [live.push(samples[i : i + 100]) for i in range(0, len(samples), 100)] + [live.finish()]
    poses = np.concatenate([part["x0"] for part in answers])
    np.testing.assert_array_equal(poses, samples["x0"])
    labels = np.concatenate([part["label"].astype("U4") for part in answers])
    scan = vibrissa.sweep(scene.rod, scene.objects, scene.path, 0.01 / 2000.0)
    truth = {float(x): phase for x, phase in zip(scan.states["x0"], scan.states["phase"])}
    right = np.mean([label == truth[float(x)] for x, label in zip(poses, labels)])
    assert right > 0.95
    assert len(answers[0]) == 0 and live.delay > 100
    with pytest.raises(ValueError, match="99 usable samples of 99, expected at least 100"):
        vibrissa.Live(scene.rod, samples[:99])


def test_wrong_samples_are_named(scene: vibrissa.Scene, tmp_path: Path) -> None:
    with pytest.raises(ValueError, match="the samples have no column f0x"):
        vibrissa.reconstruct(scene.rod, {"x0": [0.0], "y0": [0.0], "phi0": [0.0]})
    with pytest.raises(ValueError, match=r"the samples have shape \[3, 5\], expected \[n, 6\]"):
        vibrissa.reconstruct(scene.rod, np.zeros((3, 5)))
    with pytest.raises(ValueError, match="0 usable samples of 0"):
        vibrissa.reconstruct(scene.rod, np.zeros((0, 6)))
    with pytest.raises(ValueError, match="false_alarms is -1, expected a positive, finite number"):
        vibrissa.reconstruct(scene.rod, scene.sweep().states, false_alarms=-1.0)
    with pytest.raises(ValueError, match="unknown field `withe`"):
        vibrissa.simulate(scene, rate=100.0, speed=0.01, noise={"withe": {}})
    with pytest.raises(ValueError, match="^rate is 0, expected a positive, finite number"):
        vibrissa.simulate(scene, rate=0.0, speed=0.01)
    with pytest.raises(FileNotFoundError, match="cannot read the recording"):
        vibrissa.Recording.read(tmp_path / "nowhere.csv", scene.rod)
    file = tmp_path / "few.csv"
    file.write_text("x0,y0,phi0,f0x,f0y\n0,0,0,0,0\n")
    with pytest.raises(ValueError, match="no column m0z"):
        vibrissa.Recording.read(file, scene.rod)


def test_single_points_are_exact_where_there_is_one_contact() -> None:
    scene = vibrissa.Scene.read(SCENES / "O1_q40.toml")
    scan = scene.sweep()
    points = vibrissa.single(scan.rod, scan.states)
    one = np.isin(scan.states["phase"], ["A", "B"])
    gap = scan.objects[0].gap
    assert points["fits"][one].all()
    assert np.abs(gap(points["x"][one], points["y"][one])).max() < 1e-13
    two = scan.states["phase"] == "BB"
    assert np.nanmax(np.abs(gap(points["x"][two], points["y"][two]))) > 1e-3
    assert not points["fits"][scan.states["phase"] == "free"].any()


def test_several_recordings_share_a_contour() -> None:
    scans = [vibrissa.Scene.read(SCENES / f"O2_q{q}.toml") for q in (40, 60)]
    samples = [vibrissa.simulate(scene, rate=20, speed=2e-3, noise=NOISE, seed=k) for k, scene in enumerate(scans)]
    rod = scans[0].rod
    found = vibrissa.reconstruct_together(rod, samples, as_is=True)
    assert [one.is_explained for one in found] == [True, True]
    assert np.array_equal(found[0].fitted["x"], found[1].fitted["x"])
    alone = vibrissa.reconstruct(rod, samples[0], as_is=True)
    sigmas = [np.nanmedian(one.fitted["sigma"]) for one in (found[0], alone)]
    assert sigmas[0] < 1.2 * sigmas[1]
    with pytest.raises(ValueError):
        vibrissa.reconstruct_together(rod, [samples[0], np.zeros((3, 6))])
