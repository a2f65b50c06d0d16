"""Pickling and copying, exact to the last bit."""

from __future__ import annotations

import copy
import math
import pickle
from concurrent.futures import ProcessPoolExecutor
from multiprocessing import get_context
from typing import Any

import numpy as np
import numpy.typing as npt
import pytest
from conftest import SCENES, Hump

import vibrissa


def wave(x: npt.NDArray[np.float64]) -> list[npt.NDArray[np.float64]]:
    return [np.cos(x), -np.sin(x), -np.cos(x)]


def circle(t: npt.NDArray[np.float64]) -> npt.NDArray[np.float64]:
    one = np.array([np.cos(t), np.sin(t)])
    turned = np.array([-np.sin(t), np.cos(t)])
    return np.array([one, turned, -one])


def swing(t: npt.NDArray[np.float64]) -> list[npt.NDArray[np.float64]]:
    zero = np.zeros_like(t)
    return [0.3 + 0.2 * np.cos(t), zero - 0.4, zero + math.pi / 2, -0.2 * np.sin(t), zero, zero]


SHAPES = [
    vibrissa.Line((0.0, 0.0), (0.1, 0.07)),
    vibrissa.Parabola((0.01, 0.0), 50.0, x_from=-0.1),
    vibrissa.CircularArc((0.0, 0.05), 0.02, -1.1, 2.3),
    vibrissa.EllipticArc((0.0, 0.05), (0.02, 0.01), -1.1, 2.3, rotation=0.7),
    vibrissa.Bezier([(0.0, 0.0), (0.01, 0.0), (0.02, 0.01)]),
    vibrissa.Spline([(0.0, 0.0), (0.01, 0.003), (0.02, 0.0)], end="clamped", angle_from=0.3),
    vibrissa.Polygon([(0.0, 0.0), (0.01, 0.0), (0.0, 0.01)]),
    vibrissa.Svg("M 0 0 L 10 0 L 0 10 Z", scale=1e-3),
    vibrissa.Graph(wave, -3.0, 3.0),
    vibrissa.Curve(circle, 0.1, 0.9),
    vibrissa.Parabola((0.01, 0.0), 50.0).moved((0.1, 0.2), 0.3, 1.7, True).trimmed(-0.01, 0.02).reversed(),
    vibrissa.Composite([vibrissa.Parabola((0.0, 0.0), 50.0), vibrissa.Parabola((0.03, 0.0), 50.0)], angle=0.1),
    vibrissa.Composite(Hump(), scale=1.5).moved((0.1, 0.2)).reversed(),
    vibrissa.Composite((Hump(),), reversed=True),
    *vibrissa.Scene.read(SCENES / "comb.toml").objects,
]

PATHS = [
    vibrissa.ClampPath((0.1, 0.0, 1.5), (0.01, 0.0, 1.2)),
    vibrissa.ClampArc((0.01, 0.0, 1.7), (0.01, -0.01), -0.4),
    vibrissa.ClampArc((0.01, 0.0, 1.7), (0.01, -0.01), -0.4, phi_end=0.1),
    vibrissa.ClampSpline([(0.1, 0.0, 1.5), (0.01, 0.0, 1.2), (0.0, 0.03, 1.2)]),
    vibrissa.ClampFunction(swing, 2.0),
    vibrissa.Chain.polyline([(0.1, 0.0, 1.5), (0.01, 0.0, 1.2), (0.0, 0.03, 1.2)]),
    vibrissa.Chain(
        [
            vibrissa.ClampPath((0.1, 0.0, 1.5), (0.01, 0.0, 1.2)),
            vibrissa.ClampArc((0.01, 0.0, 1.2), (0.01, -0.01), -0.4),
        ]
    ),
    vibrissa.Scene.read(SCENES / "O1_q40.toml").path,
    vibrissa.Scene.read(SCENES / "whisking.toml").path,
]


@pytest.mark.parametrize("shape", SHAPES, ids=lambda shape: type(shape).__name__)
def test_shapes(shape: vibrissa.Shape) -> None:
    start, end = (max(-1.0, shape.range[0]), min(1.0, shape.range[1]))
    t = np.linspace(start, end, 101)
    for again in (pickle.loads(pickle.dumps(shape)), copy.deepcopy(shape)):
        assert type(again) is type(shape) and again.range == shape.range
        np.testing.assert_array_equal(again.frame(t), shape.frame(t))
        np.testing.assert_array_equal(again.gap(0.01, 0.02), shape.gap(0.01, 0.02))


@pytest.mark.parametrize("path", PATHS, ids=lambda path: type(path).__name__)
def test_paths(path: vibrissa.Path) -> None:
    t = np.linspace(0.0, path.length, 101)
    for again in (pickle.loads(pickle.dumps(path)), copy.deepcopy(path)):
        assert again.length == path.length
        np.testing.assert_array_equal(again.at(t), path.at(t))


def same(one: Any, other: Any) -> None:
    for field in one.dtype.names:
        np.testing.assert_array_equal(one[field], other[field])


def test_scans_with_their_events_and_contacts() -> None:
    rod = vibrissa.Rod(0.1, diameter=0.5e-3, youngs_modulus=206e9)
    path = vibrissa.ClampPath((0.08, -0.04, math.pi / 2), (-0.09, -0.04, math.pi / 2))
    for shape in (Hump(), vibrissa.Parabola((0.0, 0.0), 50.0)):
        scan = vibrissa.sweep(rod, shape, path, 1e-3)
        again = pickle.loads(pickle.dumps(scan))
        same(scan.states, again.states)
        same(scan.events, again.events)
        same(scan.contacts.values, again.contacts.values)
        np.testing.assert_array_equal(scan.shape(60), again.shape(60))
        assert again.rod == scan.rod and again.stop is None
        assert pickle.loads(pickle.dumps(scan.event(0))) == scan.event(0)
        (contact,) = scan.state(60).contacts
        assert pickle.loads(pickle.dumps(contact)) == contact


def test_scenes_with_a_shape_of_ones_own() -> None:
    path = vibrissa.ClampPath((0.08, -0.04, math.pi / 2), (-0.09, -0.04, math.pi / 2))
    scene = vibrissa.Scene(vibrissa.Rod(0.1, 2e-3), Hump(), path, 1e-3, name="hump")
    again = pickle.loads(pickle.dumps(scene))
    assert (again.name, again.rod, again.steps) == ("hump", scene.rod, [1e-3])
    same(again.sweep().states, scene.sweep().states)


def swept(radius: float) -> vibrissa.Scan:
    rod = vibrissa.Rod(0.1, 2e-3)
    disc = vibrissa.CircularArc((0.0, 0.06), radius, -math.pi, math.pi)
    return vibrissa.sweep(rod, disc, vibrissa.ClampPath((0.06, 0.0, math.pi / 2), (-0.02, 0.0, math.pi / 2)), 1e-3)


def test_scans_come_back_from_other_processes() -> None:
    with ProcessPoolExecutor(2, mp_context=get_context("spawn")) as pool:
        for radius, scan in zip((0.01, 0.02), pool.map(swept, (0.01, 0.02))):
            same(scan.states, swept(radius).states)


def test_what_computes_is_not_pickled() -> None:
    follower = vibrissa.Follower(vibrissa.Rod(1.0, 1.0), vibrissa.Parabola((0.0, 0.0), 5.0), (0.5, -0.4, 1.5))
    with pytest.raises(TypeError, match=r"cannot pickle '(vibrissa\.)?Follower' object"):
        pickle.dumps(follower)
