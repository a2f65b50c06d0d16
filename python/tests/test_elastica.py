"""Rods without contacts: against scipy, against differences, and wrong arguments."""

from __future__ import annotations

import math
import re
from pathlib import Path
from typing import Any

import matplotlib as mpl
import numpy as np
import numpy.typing as npt
import pytest

import vibrissa
import vibrissa.plot

mpl.use("Agg")

PAGE = Path(__file__).parents[2] / "docs/elastica.md"
Array = npt.NDArray[np.float64]


@pytest.fixture
def wire() -> vibrissa.Rod:
    return vibrissa.Rod(0.1, bending_stiffness=6.3e-4)


def test_the_code_of_the_page() -> None:
    names: dict[str, Any] = {}
    blocks = re.findall(r"```python\n(.*?)```", PAGE.read_text(), re.DOTALL)
    assert len(blocks) == 3
    for block in blocks:
        exec(block, names)


def test_a_clamped_rod_is_that_of_scipy(wire: vibrissa.Rod) -> None:
    integrate = pytest.importorskip("scipy.integrate")
    loads, pose, tip = [(0.03, 0.1, -0.4), (0.06, -0.2, 0.3)], (0.01, -0.02, 0.4), (0.06, 0.01, 0.3)
    found = vibrissa.elastica(wire, pose, loads, dict(pose=tip), branches="all")
    assert len(found) >= 3
    borders = np.array([0.0, 0.03, 0.06, 0.1])
    length = np.diff(borders)

    # three pieces at once, each over u from 0 to 1: x, y, phi, moment; unknown force of the support
    def rates(_: Array, z: Array, force: Array) -> Array:
        rows = []
        for k in range(3):
            _, _, phi, moment = z[4 * k : 4 * k + 4]
            fx = force[0] + sum(load[1] for load in loads[k:])
            fy = force[1] + sum(load[2] for load in loads[k:])
            rows += [np.cos(phi), np.sin(phi), moment / 6.3e-4, fx * np.sin(phi) - fy * np.cos(phi)]
        return np.asarray(np.array(rows) * np.repeat(length, 4)[:, None])

    def ends(a: Array, b: Array, _: Array) -> Array:
        return np.concatenate([a[:3] - pose, b[:4] - a[4:8], b[4:8] - a[8:12], b[8:11] - tip])

    for one in found[:3]:
        u = np.linspace(0.0, 1.0, 41)
        points = one.points
        guess = np.concatenate(
            [[np.interp(borders[k] + length[k] * u, points[:, 0], points[:, j]) for j in (1, 2, 3, 5)] for k in range(3)]
        )
        solution = integrate.solve_bvp(rates, ends, u, guess, p=np.array(one.tip_load[:2]) * 1.01, tol=1e-9, max_nodes=50_000)
        assert solution.success
        assert solution.p == pytest.approx(one.tip_load[:2], rel=1e-6)
        assert solution.sol(0.0)[3] == pytest.approx(-one.reactions[2], rel=1e-6)
        assert solution.sol(1.0)[11] == pytest.approx(one.tip_load[2], rel=1e-6)


def test_a_whisker_is_that_of_scipy() -> None:
    integrate = pytest.importorskip("scipy.integrate")
    rod = vibrissa.Rod(0.04, diameter=1e-4, tip_diameter=3e-5, youngs_modulus=3e9, natural_curvature=15.0)
    load = (0.04, 2e-6, -4e-6)
    [one] = vibrissa.elastica(rod, (0.0, 0.0, 0.2), [load])

    def rates(s: float, z: Array) -> list[float]:
        stiffness = 3e9 * math.pi * (1e-4 - 7e-5 * s / 0.04) ** 4 / 64.0
        return [math.cos(z[2]), math.sin(z[2]), z[3] / stiffness + 15.0, load[1] * math.sin(z[2]) - load[2] * math.cos(z[2])]

    solution = integrate.solve_ivp(
        rates, (0.0, 0.04), [0.0, 0.0, 0.2, -one.reactions[2]], method="DOP853", rtol=1e-12, atol=1e-16, t_eval=one.points[:, 0]
    )
    assert np.abs(solution.y[:2].T - one.points[:, 1:3]).max() < 1e-12
    assert np.abs(solution.y[3] - one.points[:, 5]).max() < 1e-15
    assert abs(one.points[-1, 5]) < 1e-18 and one.stable


def hessian(one: vibrissa.Elastica, stiffness: float, held: str) -> Array:
    """The second variation by finite elements of the angle, on the variations that the tip allows."""
    n = 120
    points = one.points
    h = points[-1, 0] / n
    middle = np.interp((np.arange(n) + 0.5) * h, points[:, 0], points[:, 3])
    fx, fy, _ = one.tip_load
    weight = h * (fx * np.cos(middle) + fy * np.sin(middle))
    matrix = np.zeros((n + 1, n + 1))
    constraints = np.zeros((2, n + 1))
    for k in range(n):
        matrix[k : k + 2, k : k + 2] += stiffness / h * np.array([[1.0, -1.0], [-1.0, 1.0]])
        matrix[k : k + 2, k : k + 2] += weight[k] * np.array([[2.0, 1.0], [1.0, 2.0]]) / 6.0
        constraints[:, k : k + 2] += 0.5 * h * np.array([[-np.sin(middle[k])] * 2, [np.cos(middle[k])] * 2])
    kept = slice(1, n if "phi" in held else n + 1)
    matrix, constraints = matrix[kept, kept], constraints[["x" in held, "y" in held]][:, kept]
    if not len(constraints):
        return matrix
    # an orthonormal basis of the variations without motion of the tip
    basis = np.linalg.svd(constraints)[2][len(constraints) :].T
    return np.asarray(basis.T @ matrix @ basis)


@pytest.mark.parametrize(
    ("tip", "held"),
    [
        (dict(force=(-40.0, 3.0), moment=0.4), ""),
        (dict(place=(0.6, 0.2)), "x y"),
        (dict(pose=(0.5, 0.3, 1.0)), "x y phi"),
        (dict(pose=(0.3, -0.4, 3.0)), "x y phi"),
        (dict(fx=-30.0, y=0.1, phi=0.2), "y phi"),
    ],
)
def test_unstable_directions_are_those_of_finite_elements(tip: Any, held: str) -> None:
    rod = vibrissa.Rod(1.0, bending_stiffness=1.0)
    found = vibrissa.elastica(rod, (0.0, 0.0, 0.0), tip=tip, branches="all", points=2001)
    assert len(found) >= 2
    for one in found[:5]:
        values = np.linalg.eigvalsh(hessian(one, 1.0, held))
        assert np.count_nonzero(values < 0.0) == one.unstable_directions
        assert one.stable == (one.unstable_directions == 0)


def test_what_an_equilibrium_has(wire: vibrissa.Rod) -> None:
    loads = np.array([[0.05, 0.0, -0.2], [0.0, 0.1, 0.0]])
    found = vibrissa.elastica(wire, (0.0, 0.0, 0.0), loads, dict(place=(0.08, 0.01)), branches=2, points=11)
    assert [one.branch for one in found] == [0, 1]
    one = found[0]
    assert one.points.shape == (11, 6) and one.rod == wire and one.pose == (0.0, 0.0, 0.0)
    assert one.points[-1, 1:4] == pytest.approx(one.tip, abs=1e-15)
    assert one.tip_held == (True, True, False)
    assert np.array(one.reactions[:2]) + one.tip_load[:2] == pytest.approx([-0.1, 0.2], abs=1e-15)
    assert one.potential_energy <= found[1].potential_energy and one.energy > 0.0 and one.residual < 1e-12
    assert repr(one).startswith("<vibrissa.Elastica 0: stable, tip at (80.000, 10.000) mm, ")
    [free] = vibrissa.elastica(wire, (0.0, 0.0, 0.3))
    assert free.energy == 0.0 and free.stable and free.tip[2] == pytest.approx(0.3)
    ax = vibrissa.plot.elastica(found)
    # two shapes and the clamp
    assert len(ax.lines) == 3 and [text.get_text() for text in ax.texts] == ["0", "1"]


def test_a_family_is_one_critical_equilibrium(wire: vibrissa.Rod) -> None:
    # a closed loop slides along itself: an equilibrium at each arc length, all of one energy
    found = vibrissa.elastica(wire, (0.0, 0.0, 0.0), (), dict(pose=(0.0, 0.0, 0.0)), branches="all")
    energies = [one.potential_energy for one in found]
    assert found[0].critical and not found[0].stable and found[0].unstable_directions == 0
    assert len(found) < 8 and all(b > a * 1.001 for a, b in zip(energies, energies[1:])), energies
    assert "critical" in repr(found[0])


def test_wrong_arguments(wire: vibrissa.Rod) -> None:
    def refused(error: type[Exception], message: str, loads: Any = (), tip: Any = None, **others: Any) -> None:
        with pytest.raises(error, match=re.escape(message)):
            vibrissa.elastica(others.pop("rod", wire), others.pop("pose", (0.0, 0.0, 0.0)), loads, tip, **others)

    refused(ValueError, "loads[1]: s is 0.2 m, expected 0 to 0.1 m, the length of the rod", [(0.1, 0, 1), (0.2, 0, 1)])
    refused(ValueError, "loads has the shape [1, 2], expected loads of shape (n, 3): s (m), fx (N), fy (N)", [(0.1, 1.0)])
    refused(ValueError, "loads: the forces add up to 99.0 N, expected at most 63.0 N, which is 1000 E I / L^2", [(0.1, 99.0, 0.0)])
    refused(TypeError, "expected numbers", [("a", 1.0, 2.0)])
    refused(ValueError, "tip: place is (0.1, 0.0) m, 0.1 m from the clamp, expected less than 0.1 m", tip=dict(place=(0.1, 0.0)))
    refused(ValueError, "tip has place and fx, expected one of the two along x", tip=dict(place=(0.05, 0.0), fx=1.0))
    refused(ValueError, "tip has the field angle, expected place, pose or force, or x or fx", tip=dict(angle=1.0))
    refused(ValueError, "tip: phi is 90.0 rad, 14.3 turns from the clamp, expected at most 4", tip=dict(phi=90.0))
    refused(ValueError, "tip: moment is nan, expected a finite number".replace("nan", "NaN"), tip=dict(moment=math.nan))
    refused(TypeError, "tip: place: expected two numbers, found 3", tip=dict(place=(0.0, 0.0, 0.0)))
    refused(ValueError, "pose: x is NaN, expected a finite number", pose=(math.nan, 0.0, 0.0))
    refused(ValueError, "branches is 0, expected a whole number, at least 1, or 'all'", branches=0)
    refused(ValueError, "points is 1, expected a whole number from 2 to", points=1)
    refused(ValueError, "points is -5, expected a whole number from 2 to", points=-5)
    springs = vibrissa.Rod(0.1, 6.3e-4, clamp=vibrissa.ElasticClamp(stiffness_phi=0.4))
    refused(ValueError, "rod: the clamp of the rod has springs or a roller, expected a rod on a rigid clamp", rod=springs)
