"""Equilibria, followers, derivatives."""

from __future__ import annotations

import copy
import math

import numpy as np
import pytest
from conftest import Hump

import vibrissa

UP = math.pi / 2


@pytest.fixture
def unit() -> vibrissa.Rod:
    return vibrissa.Rod(1.0, 1.0)


@pytest.fixture
def parabola() -> vibrissa.Parabola:
    return vibrissa.Parabola((0.0, 0.0), 5.0)


def test_an_equilibrium_of_given_contacts(unit: vibrissa.Rod, parabola: vibrissa.Parabola) -> None:
    along = vibrissa.Contact("tangent", 0.6, 0.25, 0.3, 1.2, 1.0)
    found = vibrissa.equilibrium(unit, parabola, (0.1, -0.4, UP), [along])
    assert found.solved and found.problem is None and found.state.phase == "B"
    sweep = vibrissa.sweep(unit, parabola, vibrissa.ClampPath((0.5, -0.4, UP), (0.1, -0.4, UP)), 0.1)
    np.testing.assert_allclose(found.state.reactions, sweep.state(-1).reactions, rtol=1e-10)
    beyond = vibrissa.equilibrium(
        unit, parabola, (0.32, -0.4, UP), [vibrissa.Contact("tangent", 0.9, 0.35, 0.6, 1.3, 1.0)]
    )
    assert beyond.problem is not None and "beyond the tip of a rod of 1 m" in beyond.problem
    with pytest.raises(ValueError, match="contact 0: "):
        vibrissa.equilibrium(unit, parabola, (0.1, -0.4, UP), [vibrissa.Contact("tip", 1.0, 0.0, 0.0, 0.0, 1.0, object=3)])
    with pytest.raises(ValueError, match='kind is "side", expected'):
        vibrissa.Contact("side", 0.6, 0.25, 0.3, 1.2, 1.0)  # type: ignore[arg-type]


def test_a_follower_goes_where_a_sweep_goes(unit: vibrissa.Rod, parabola: vibrissa.Parabola) -> None:
    follower = vibrissa.Follower(unit, parabola, (0.5, -0.4, UP))
    items = follower.to((0.2, -0.4, UP))
    assert [item.kind for item in items if isinstance(item, vibrissa.Event)] == ["first-contact"]
    assert items[-1] == follower.state
    tried = copy.copy(follower)
    tried.to((0.2, -0.3, UP))
    assert follower.state.pose == (0.2, -0.4, UP) and tried.state.pose == (0.2, -0.3, UP)
    sweep = vibrissa.sweep(unit, parabola, vibrissa.ClampPath((0.5, -0.4, UP), (0.2, -0.4, UP)), 0.3)
    np.testing.assert_allclose(follower.state.reactions, sweep.state(-1).reactions, rtol=1e-10)
    again = vibrissa.Follower.from_state(unit, parabola, sweep.state(-1))
    again.to((0.2, -0.3, UP))
    np.testing.assert_allclose(again.state.reactions, tried.state.reactions, rtol=1e-9)


def test_a_move_that_fails_leaves_the_rod_where_it_was(unit: vibrissa.Rod) -> None:
    short = vibrissa.Parabola((0.0, 0.0), 5.0, x_from=-0.3, x_to=0.3)
    follower = vibrissa.Follower(unit, short, (0.5, -0.4, UP))
    with pytest.raises(vibrissa.SweepStopped) as caught:
        follower.to((-0.5, -0.4, UP))
    assert caught.value.scan is None and 0.0 < caught.value.tau < 1.0
    assert follower.state.pose == (0.5, -0.4, UP)
    with pytest.raises(vibrissa.SweepStopped, match="the pose to go to has a number that is not finite"):
        follower.to((math.nan, 0.0, 0.0))


def test_a_follower_outlives_what_it_was_made_of(unit: vibrissa.Rod) -> None:
    object = vibrissa.Composite(Hump(), scale=10.0)
    follower = vibrissa.Follower(unit, object, (0.9, -0.4, UP))
    del object
    copied = follower.clone()
    del follower
    assert copied.to((0.5, -0.4, UP))[-1] == copied.state


def test_derivatives_are_those_of_differences(unit: vibrissa.Rod, parabola: vibrissa.Parabola) -> None:
    state = vibrissa.sweep(unit, parabola, vibrissa.ClampPath((0.5, -0.4, UP), (0.1, -0.4, UP)), 0.1).state(-1)
    derivatives = vibrissa.Derivatives(unit, parabola, state)
    stiffness = derivatives.stiffness()
    np.testing.assert_allclose(stiffness, stiffness.T, rtol=1e-10)
    h = 1e-5

    def reactions(rod: vibrissa.Rod, shape: vibrissa.Shape, x: float) -> np.ndarray[tuple[int], np.dtype[np.float64]]:
        return np.array(vibrissa.equilibrium(rod, shape, (x, -0.4, UP), state.contacts).state.reactions)

    by_x = (reactions(unit, parabola, 0.1 + h) - reactions(unit, parabola, 0.1 - h)) / (2 * h)
    np.testing.assert_allclose(stiffness[:, 0], by_x, rtol=1e-6)
    np.testing.assert_array_equal(derivatives.by("clamp_x")[0], stiffness[:, 0])
    sharper = [reactions(unit, vibrissa.Parabola((0.0, 0.0), 5.0 + k * h), 0.1) for k in (-1, 1)]
    rates, contacts = derivatives.by("shape", parameter="coefficient")
    np.testing.assert_allclose(rates, (sharper[1] - sharper[0]) / (2 * h), rtol=1e-6)
    # the contact stays on y = c x^2
    x = state.contacts[0].x
    assert contacts["y"][0] == pytest.approx(x * x + 10.0 * x * contacts["x"][0], rel=1e-10)
    stiffer = [reactions(vibrissa.Rod(1.0, 1.0 + k * h), parabola, 0.1) for k in (-1, 1)]
    np.testing.assert_allclose(derivatives.by("stiffness")[0], (stiffer[1] - stiffer[0]) / (2 * h), rtol=1e-6)
    with pytest.raises(ValueError, match='quantity is "width", expected'):
        derivatives.by("width")
    with pytest.raises(ValueError, match="there is no"):
        derivatives.by("object_x", object=1)
    with pytest.raises(ValueError, match="the state is no equilibrium of this rod"):
        vibrissa.Derivatives(vibrissa.Rod(1.0, 1.1), parabola, state)


def test_derivatives_of_transitions_are_those_of_differences(unit: vibrissa.Rod) -> None:
    clamp = ((1.0, -0.4, math.pi / 2), (-0.5, -0.4, math.pi / 2))
    path = vibrissa.ClampPath(*clamp)

    def events(coefficient: float) -> list[vibrissa.Event]:
        scan = vibrissa.sweep(unit, vibrissa.Parabola((0.0, 0.0), coefficient), path, 0.1)
        return [scan.event(k) for k in range(len(scan.events))]

    h = 1e-4
    low, high = events(5.0 - h), events(5.0 + h)
    found = events(5.0)
    assert [event.kind for event in found] == [event.kind for event in low]
    for event, before, after in zip(found, low, high):
        (rate,) = path.rate(0.0)
        derivatives = vibrissa.TransitionDerivatives(unit, vibrissa.Parabola((0.0, 0.0), 5.0), event, rate)
        # the path goes to the left, its parameter is the way
        way = -(after.pose[0] - before.pose[0]) / (2 * h)
        assert derivatives.by("shape", parameter="coefficient") == pytest.approx(way, abs=1e-6), event.kind
    with pytest.raises(ValueError, match="rate has 2 numbers, expected three"):
        vibrissa.TransitionDerivatives(unit, vibrissa.Parabola((0.0, 0.0), 5.0), found[0], (1.0, 0.0))
