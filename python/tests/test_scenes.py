"""Scenes from and to TOML."""

from __future__ import annotations

import math
import pickle
from pathlib import Path

import numpy as np
import pytest
from conftest import SCENES, Hump

import vibrissa

# Scenes with a roller are for the command and for Rust.
FILES = sorted(file for file in SCENES.glob("*.toml") if "roller" not in file.stem)


@pytest.mark.parametrize("file", FILES, ids=lambda file: str(file.stem))
def test_scenes_survive_a_round_trip(file: Path) -> None:
    scene = vibrissa.Scene.read(file)
    again = pickle.loads(pickle.dumps(scene))
    assert again.to_toml() == scene.to_toml()
    assert (again.name, again.rod, again.steps) == (scene.name, scene.rod, scene.steps)
    t = np.linspace(0.0, scene.path.length, 50)
    np.testing.assert_array_equal(again.path.at(t), scene.path.at(t))
    x, y = np.meshgrid(np.linspace(-0.1, 0.1, 9), np.linspace(-0.1, 0.1, 9))
    for one, other in zip(scene.objects, again.objects):
        np.testing.assert_array_equal(one.gap(x, y), other.gap(x, y))


def test_a_roller_is_refused_by_name() -> None:
    with pytest.raises(Exception, match="roller"):
        vibrissa.Scene.read(SCENES / "O1_roller.toml")


def test_objects_can_be_pickled() -> None:
    for file in FILES:
        for one in vibrissa.Scene.read(file).objects:
            again = pickle.loads(pickle.dumps(one))
            assert (again.pieces, again.is_cavity, again.range) == (one.pieces, one.is_cavity, one.range)
            np.testing.assert_array_equal(again.gap([0.01, 0.3], [0.02, -0.1]), one.gap([0.01, 0.3], [0.02, -0.1]))


def test_a_scene_made_here_is_read_again(rod: vibrissa.Rod) -> None:
    objects = [
        vibrissa.Composite(vibrissa.Polygon([(0.0, 0.0), (0.01, 0.0), (0.0, 0.01)]), position=(0.0, 0.04), angle=0.3),
        vibrissa.Composite(
            [vibrissa.CircularArc((0.05, 0.08), 0.02, -math.pi, math.pi)], scale=1.5, mirror=True
        ).moved(angle=-0.1),
    ]
    path = vibrissa.Chain(
        [
            vibrissa.ClampPath((0.1, 0.0, 1.5), (0.01, 0.0, 1.2)),
            vibrissa.ClampPath((0.01, 0.0, 1.2), (0.01, 0.0, 1.7)),
            vibrissa.ClampArc((0.01, 0.0, 1.7), (0.01, -0.01), -0.4),
        ]
    )
    scene = vibrissa.Scene(rod, objects, path, [1e-3, 0.01, 1e-4], name="mine")
    again = vibrissa.Scene.parse(scene.to_toml(), "mine.toml")
    assert again.rod == scene.rod and again.name == "mine"
    np.testing.assert_allclose(again.steps, scene.steps, rtol=1e-15)
    t = np.linspace(0.0, path.length, 50)
    np.testing.assert_allclose(again.path.at(t), path.at(t), atol=1e-16)
    for one, other in zip(objects, again.objects):
        assert other.gap(0.3, 0.2) == pytest.approx(float(one.gap(0.3, 0.2)), rel=1e-15)


def test_what_has_no_form_in_files_is_refused(rod: vibrissa.Rod, path: vibrissa.ClampPath) -> None:
    with pytest.raises(ValueError, match="object 0 has a piece that scene files have no name for"):
        vibrissa.Scene(rod, Hump(), path, 1e-3).to_toml()
    spline = vibrissa.ClampSpline([(0.1, 0.0, 1.5), (0.0, 0.0, 1.2), (-0.1, 0.01, 1.5)])
    with pytest.raises(ValueError, match="the path has no form in scene files"):
        vibrissa.Scene(rod, vibrissa.Line((0.0, 1.0), (1.0, 1.0)), spline, 1e-3).to_toml()


def test_errors_have_their_place() -> None:
    with pytest.raises(ValueError, match=r"^mine\.toml:2:10: rod\.length: length is -1, expected a positive"):
        vibrissa.Scene.parse(
            "[rod]\nlength = -1.0\nbending_stiffness = 1.0\n[[object]]\n[[object.piece]]\nshape = 'line'\n"
            "from = [0, 0]\nto = [1, 0]\n[sweep]\nfrom = [0, 0]\nto = [1, 0]\nangle = 0.0\nstep = 0.1\n",
            "mine.toml",
        )
    with pytest.raises(OSError, match="cannot read the scene nowhere.toml"):
        vibrissa.Scene.read("nowhere.toml")


def test_paths_run_from_start_to_end() -> None:
    start = (0.0, 0.01, 1.2)
    arc = vibrissa.ClampArc(start, (0.0, 0.0), 0.5)
    np.testing.assert_allclose(arc.end, (-0.01 * math.sin(0.5), 0.01 * math.cos(0.5), 1.7), atol=1e-16)
    assert arc.length == pytest.approx(0.005)
    spline = vibrissa.ClampSpline(np.array([start, (0.1, 0.0, 1.3), (0.2, 0.0, 1.2)]))
    np.testing.assert_allclose(spline.at([0.0, spline.length]), [start, (0.2, 0.0, 1.2)], atol=1e-15)
    there_and_back = vibrissa.Chain.polyline([start, (0.1, 0.0, 1.3), start])
    assert there_and_back.start == there_and_back.end == start
    with pytest.raises(ValueError, match="leg 1 starts at"):
        vibrissa.Chain([arc, arc])
