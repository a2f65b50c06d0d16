"""An object, explored by a simulated rig."""

from __future__ import annotations

import math

import numpy as np
import pytest

import vibrissa

NOISE = {"white": {"force": 2.5e-3, "m0z": 6e-5}}
BOX = (-0.025, -0.02, 0.02, 0.025)  # m


@pytest.fixture(scope="module")
def rod() -> vibrissa.Rod:
    return vibrissa.Rod(0.1, diameter=0.5e-3, youngs_modulus=206e9, yield_stress=1.5e9)


@pytest.fixture(scope="module")
def circle() -> vibrissa.CircularArc:
    return vibrissa.CircularArc((0.0, 0.0), 0.015, 0.4, 0.4 + 2.0 * math.pi)


def explorer(rod: vibrissa.Rod, **settings: object) -> vibrissa.Explorer:
    return vibrissa.Explorer(rod, BOX, noise=NOISE, rate=100.0, speed=1e-2, as_is=True, **settings)  # type: ignore[arg-type]


def measured(rod: vibrissa.Rod, circle: vibrissa.CircularArc, path: vibrissa.Path, seed: int) -> np.ndarray:
    return vibrissa.simulate(vibrissa.Scene(rod, circle, path, 1e-3), rate=100.0, speed=1e-2, noise=NOISE, seed=seed)


def test_proposals_and_what_is_known(rod: vibrissa.Rod, circle: vibrissa.CircularArc) -> None:
    exploring = explorer(rod, most_scans=2)
    first = exploring.propose()
    assert first is not None and first.purpose == "approach" and math.isnan(first.value)
    again = exploring.propose()
    assert again is not None and again.path.start == first.path.start
    # 1.5 GPa at the surface of the wire
    assert first.stop_moment == pytest.approx(1.5e9 * math.pi * 0.5e-3**3 / 32.0)
    with pytest.raises(ValueError, match="expected the start of the proposed path"):
        exploring.update(measured(rod, circle, first.path, 1)[500:])
    exploring.update(measured(rod, circle, first.path, 1))
    touched = exploring.known[exploring.known["known"] == "touched"]
    assert len(touched) > 5 and np.abs(np.hypot(touched["x"], touched["y"]) - 0.015).max() < 5e-4
    second = exploring.propose()
    assert second is not None and second.purpose == "contour" and second.value > 2e-3
    assert 0.0 < second.largest_stress <= 1.5e9
    exploring.update(measured(rod, circle, second.path, 2))
    assert exploring.finished == "most scans" and exploring.propose() is None
    assert exploring.left_out.shape == (0, 2)


def test_an_exploration_goes_on_from_a_reconstruction(rod: vibrissa.Rod, circle: vibrissa.CircularArc) -> None:
    up = math.pi / 2
    path = vibrissa.ClampPath((0.13, -0.06, up), (-0.13, -0.06, up))
    found = vibrissa.reconstruct(rod, measured(rod, circle, path, 3), noise=NOISE, as_is=True)
    exploring = explorer(rod, stage=(-0.2, -0.2, 0.2, 0.2), angles=[0.0, math.pi, -up], sigma=1e-4)
    exploring.add(found)
    assert len(exploring.known) == len(found.fitted)
    proposal = exploring.propose()
    assert proposal is not None and proposal.purpose == "contour"
    assert any(math.isclose(proposal.path.start[2], angle) for angle in (0.0, math.pi, -up))
    assert np.abs([proposal.path.start[:2], proposal.path.end[:2]]).max() <= 0.2


def test_wrong_arguments_are_named(rod: vibrissa.Rod) -> None:
    with pytest.raises(ValueError, match="the largest stress of the rod is not known"):
        explorer(vibrissa.Rod(0.1, diameter=0.5e-3, youngs_modulus=206e9))
    with pytest.raises(ValueError, match="stage is"):
        explorer(rod, stage=(0.1, 0.0, 0.0, 0.1))
    with pytest.raises(ValueError, match="no scan was proposed"):
        explorer(rod).update(np.zeros((10, 6)))
