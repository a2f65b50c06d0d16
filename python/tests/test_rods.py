"""Rods that taper, consist of sections, or are bent at rest."""

from __future__ import annotations

import copy
import math
import pickle

import numpy as np
import pytest
from conftest import SCENES

import vibrissa

TAPERED = vibrissa.Rod(0.1, diameter=1e-3, tip_diameter=2e-4, youngs_modulus=3e9)
DIAMETERS = vibrissa.Rod(0.1, diameter=np.array([[0.0, 1e-3], [0.03, 0.8e-3], [0.06, 0.9e-3], [0.1, 2e-4]]), youngs_modulus=3e9)
BENT = vibrissa.Rod(0.1, 2e-3, natural_curvature=4.0)
MEASURED = vibrissa.Rod(
    0.1,
    diameter=1e-3,
    tip_diameter=2e-4,
    youngs_modulus=3e9,
    natural_curvature=np.array([[0.0, 1.0], [0.05, 2.0], [0.1, 6.0]]),
)
SECTIONS = vibrissa.Rod(
    0.1,
    sections=[vibrissa.Section(0.06, 2e-3), vibrissa.Section(0.04, diameter=5e-4, youngs_modulus=3e9, natural_curvature=3.0)],
)
SOFT = vibrissa.Rod(0.1, 2e-3, clamp=vibrissa.ElasticClamp(stiffness_x=500.0, stiffness_phi=0.4))
TAPERED_SOFT = vibrissa.Rod(
    0.1, diameter=1e-3, tip_diameter=2e-4, youngs_modulus=3e9, natural_curvature=2.0, clamp=vibrissa.ElasticClamp(stiffness_phi=0.1)
)
DISC = vibrissa.CircularArc((0.0, 0.06), 0.02, -math.pi, math.pi)
PATH = vibrissa.ClampPath((0.06, 0.0, math.pi / 2), (-0.02, 0.0, math.pi / 2))


@pytest.mark.parametrize(
    "rod",
    [TAPERED, DIAMETERS, BENT, MEASURED, SECTIONS, SOFT, TAPERED_SOFT],
    ids=["tapered", "diameters", "bent", "measured", "sections", "soft", "tapered-soft"],
)
class TestAnyRod:
    def test_is_the_same_after_pickling_and_from_its_text(self, rod: vibrissa.Rod) -> None:
        names = {"Rod": vibrissa.Rod, "Section": vibrissa.Section, "ElasticClamp": vibrissa.ElasticClamp}
        assert pickle.loads(pickle.dumps(rod)) == rod == copy.deepcopy(rod) == eval(repr(rod), names)
        assert not rod.is_uniform and rod != vibrissa.Rod(0.1, rod.bending_stiffness)

    def test_is_swept_as_in_a_scene_file(self, rod: vibrissa.Rod) -> None:
        scene = vibrissa.Scene(rod, DISC, PATH, 1e-3)
        again = vibrissa.Scene.parse(scene.to_toml())
        assert again.rod == rod
        scan, other = scene.sweep(), again.sweep()
        for field in ("phase", "f0x", "f0y", "m0z", "min_gap", "energy"):
            np.testing.assert_array_equal(scan.states[field], other.states[field])
        assert "B" in scan.phases and scan.states["stable"].all()

    def test_shape_and_derivatives(self, rod: vibrissa.Rod) -> None:
        scan = vibrissa.sweep(rod, DISC, PATH, 1e-3)
        number = next(i for i, phase in enumerate(scan.states["phase"]) if phase == "B")
        state = scan.state(number)
        points = scan.shape(number, 1001)
        np.testing.assert_array_equal(points, state.shape(rod, 1001))
        # the tangent of the shape is its slope, and its contact lies on the disc
        ways = np.diff(points[:, :2], axis=0)
        np.testing.assert_allclose(np.arctan2(ways[:, 1], ways[:, 0]), 0.5 * (points[1:, 2] + points[:-1, 2]), atol=1e-5)
        (contact,) = state.contacts
        assert math.hypot(contact.x, contact.y - 0.06) == pytest.approx(0.02, abs=1e-12)
        # the exact stiffness against differences of states
        follower = vibrissa.Follower.from_state(rod, DISC, state)
        x, y, phi = state.pose
        h = 1e-6
        reactions = []
        for way in (h, -h):
            moved = follower.clone()
            moved.to((x + way, y, phi))
            reactions.append(np.array(moved.state.reactions))
        stiffness = vibrissa.Derivatives(rod, DISC, state).stiffness()
        np.testing.assert_allclose((reactions[0] - reactions[1]) / (2.0 * h), stiffness[:, 0], rtol=1e-4, atol=1e-6)

    def test_equilibria_are_those_of_the_sweep(self, rod: vibrissa.Rod) -> None:
        scan = vibrissa.sweep(rod, DISC, PATH, 1e-3)
        state = next(state for state in map(scan.state, range(len(scan))) if state.phase == "B")
        found = vibrissa.equilibrium(rod, DISC, state.pose, state.contacts)
        assert found.solved and found.problem is None
        np.testing.assert_allclose(found.state.reactions, state.reactions, rtol=1e-9)

    def test_single_contacts_are_found_sample_by_sample(self, rod: vibrissa.Rod) -> None:
        scan = vibrissa.sweep(rod, DISC, PATH, 1e-3)
        points = vibrissa.single(rod, scan.states)
        kinds = {"free": "free", "A": "tip", "B": "tangent"}
        one = np.isin(scan.states["phase"], list(kinds))
        assert one.sum() > 40
        assert [kinds[phase] for phase in scan.states["phase"][one]] == list(points["kind"][one])
        fits = points["fits"]
        np.testing.assert_allclose(np.hypot(points["x"][fits], points["y"][fits] - 0.06), 0.02, atol=1e-11)

    def test_recordings_are_reconstructed(self, rod: vibrissa.Rod) -> None:
        scan = vibrissa.sweep(rod, DISC, PATH, 1e-3)
        felt = vibrissa.simulate(vibrissa.Scene(rod, DISC, PATH, 1e-3), rate=10.0, speed=0.01)
        for field in ("x0", "f0x", "f0y", "m0z"):
            np.testing.assert_array_equal(felt[field], scan.states[field][: len(felt)])
        if rod is SOFT:
            return
        with pytest.raises(ValueError, match="rod is Rod.*expected a uniform, straight one"):
            vibrissa.Live(rod, scan.states)
        dense = vibrissa.sweep(rod, DISC, PATH, 5e-5)
        found = vibrissa.reconstruct(rod, dense.states)
        kinds = {"BA": "several", "BB": "several"}
        labels, phases = ([kinds.get(one, one) for one in many] for many in (found.readings["label"], dense.states["phase"]))
        assert np.mean(np.array(labels) == np.array(phases)) > 0.99
        assert len(found.calibration) > 20 and np.max(np.abs(found.calibration["taken"])) < 1e-9
        np.testing.assert_array_equal(found.readings["x0"], dense.states["x0"])
        single = np.isin(found.readings["label"], ["A", "B"]) & np.isfinite(found.readings["x"])
        distance = np.hypot(found.readings["x"][single], found.readings["y"][single] - 0.06)
        # where the reactions change fast, exact ones look noisy, and points have standard deviations
        sigma = np.hypot(found.readings["sigma_x"][single], found.readings["sigma_y"][single])
        off = np.abs(distance - 0.02)
        assert single.sum() > 500 and np.all(off < 1e-12 + 3.0 * sigma) and np.median(off) < 1e-9 and off.max() < 1e-7

    def test_the_stress_is_known_where_the_diameter_is(self, rod: vibrissa.Rod) -> None:
        known = np.isfinite(vibrissa.sweep(rod, DISC, PATH, 1e-3).states["max_stress"])
        assert known.all() if rod in (TAPERED, DIAMETERS, MEASURED, TAPERED_SOFT) else not known.any()


def test_scans_of_a_clamp_on_springs_are_reconstructed() -> None:
    clamp = vibrissa.ElasticClamp(stiffness_x=400.0, stiffness_y=300.0, stiffness_phi=0.4)
    rod = vibrissa.Rod(0.1, 2e-3, clamp=clamp)
    notch = vibrissa.Composite([vibrissa.Parabola((0.0, 0.0), 50.0), vibrissa.Parabola((0.03, 0.0), 50.0)])
    path = vibrissa.ClampPath((0.08, -0.04, math.pi / 2), (-0.09, -0.04, math.pi / 2))
    scan = vibrissa.sweep(rod, notch, path, 1e-4)
    found = vibrissa.reconstruct(rod, scan.states, as_is=True)
    same = found.readings["label"] == scan.states["phase"]
    assert same.mean() > 0.999 and {"A", "B", "BA"} <= set(scan.states["phase"])
    single = np.isin(found.readings["label"], ["A", "B"]) & np.isfinite(found.readings["x"])
    assert single.sum() > 1000
    gaps = notch.gap(found.readings["x"][single], found.readings["y"][single])
    assert np.abs(gaps).max() < 1e-10
    live = vibrissa.Live(rod, scan.states[:150], as_is=True)
    answers = np.concatenate([live.push(scan.states), live.finish()])
    right = answers["label"] == scan.states["phase"][: len(answers)]
    assert right.mean() > 0.9


def test_derivatives_by_what_makes_the_rod() -> None:
    scan = vibrissa.sweep(SOFT, DISC, PATH, 1e-3)
    state = next(state for state in map(scan.state, range(len(scan))) if state.phase == "B")
    derivatives = vibrissa.Derivatives(SOFT, DISC, state)

    def pressed(curvature: float = 0.0, stiffness: float = 0.4) -> float:
        clamp = vibrissa.ElasticClamp(stiffness_x=500.0, stiffness_phi=stiffness)
        rod = vibrissa.Rod(0.1, 2e-3, natural_curvature=curvature, clamp=clamp)
        return float(vibrissa.equilibrium(rod, DISC, state.pose, state.contacts).state.contacts[0].force)

    by_curvature = (pressed(curvature=1e-3) - pressed(curvature=-1e-3)) / 2e-3
    by_stiffness = (pressed(stiffness=0.4 + 1e-5) - pressed(stiffness=0.4 - 1e-5)) / 2e-5
    assert derivatives.by("natural_curvature")[1]["force"][0] == pytest.approx(by_curvature, rel=1e-6)
    assert derivatives.by("clamp_stiffness_phi")[1]["force"][0] == pytest.approx(by_stiffness, rel=1e-6)
    touch = vibrissa.TransitionDerivatives(SOFT, DISC, scan.event(0), PATH.rate(0.0))
    assert touch.by("clamp_stiffness_phi") == pytest.approx(0.0, abs=1e-12)  # a free rod has not given way
    with pytest.raises(ValueError, match="taper"):
        derivatives.by("taper")
    with pytest.raises(ValueError, match="section 3"):
        vibrissa.Derivatives(SECTIONS, DISC, vibrissa.sweep(SECTIONS, DISC, PATH, 1e-3).state(40)).by(
            "section_stiffness", section=3
        )


def test_two_diameters_are_the_cone() -> None:
    table = vibrissa.Rod(0.1, diameter=[(0.0, 1e-3), (0.1, 2e-4)], youngs_modulus=3e9)
    one, other = (vibrissa.sweep(rod, DISC, PATH, 1e-3) for rod in (table, TAPERED))
    assert one.states.tobytes() == other.states.tobytes()


def test_what_is_no_clamp() -> None:
    with pytest.raises(ValueError, match="stiffness_phi of the clamp is 0"):
        vibrissa.ElasticClamp(stiffness_phi=0.0)
    with pytest.raises(ValueError, match="yield_stress is given for a rod"):
        vibrissa.Rod(0.1, 2e-3, yield_stress=1e9, clamp=vibrissa.ElasticClamp(stiffness_x=1.0))
    assert vibrissa.Rod(0.1, 2e-3, clamp=vibrissa.ElasticClamp()).is_uniform


def test_sections_of_one_kind_are_a_uniform_rod() -> None:
    parts = vibrissa.Rod(0.1, sections=[vibrissa.Section(0.03, 2e-3), vibrissa.Section(0.07, 2e-3)])
    one, other = (vibrissa.sweep(rod, DISC, PATH, 1e-3) for rod in (vibrissa.Rod(0.1, 2e-3), parts))
    for field in ("f0x", "f0y", "m0z"):
        np.testing.assert_allclose(one.states[field], other.states[field], rtol=1e-9, atol=1e-12)


def test_what_a_rod_has() -> None:
    assert TAPERED.tip_diameter == 2e-4 and TAPERED.diameter == 1e-3 and TAPERED.sections == []
    assert TAPERED.bending_stiffness == pytest.approx(3e9 * math.pi * 1e-12 / 64.0, rel=1e-15)
    assert DIAMETERS.diameter == [[0.0, 1e-3], [0.03, 0.8e-3], [0.06, 0.9e-3], [0.1, 2e-4]] and DIAMETERS.tip_diameter is None
    assert DIAMETERS.bending_stiffness == TAPERED.bending_stiffness
    assert BENT.natural_curvature == 4.0 and MEASURED.natural_curvature == [[0.0, 1.0], [0.05, 2.0], [0.1, 6.0]]
    first, second = SECTIONS.sections
    assert SECTIONS.bending_stiffness == first.bending_stiffness == 2e-3
    assert (second.diameter, second.youngs_modulus, second.natural_curvature) == (5e-4, 3e9, 3.0)
    assert vibrissa.Scene.read(SCENES / "whisker.toml").rod.natural_curvature == [[0.0, 8.0], [0.0408, 24.0]]


@pytest.mark.parametrize(
    ("arguments", "message"),
    [
        ({}, "expected bending_stiffness, or diameter and youngs_modulus"),
        ({"bending_stiffness": 1.0, "diameter": 1e-3, "youngs_modulus": 1e9}, "given beside diameter or youngs_modulus"),
        ({"bending_stiffness": 1.0, "tip_diameter": 1e-4}, "tip_diameter is given beside bending_stiffness"),
        ({"diameter": 1e-3, "youngs_modulus": 1e9, "tip_diameter": 0.0}, "tip_diameter is 0, expected a positive"),
        ({"diameter": 1e-3, "youngs_modulus": 1e9, "tip_diameter": 1e-6}, "tip_diameter"),
        ({"diameter": 0.0, "youngs_modulus": 1e9, "tip_diameter": 1e-6}, "diameter is 0, expected a positive"),
        ({"diameter": [1e-3, 2e-3], "youngs_modulus": 1e9}, r"diameter has the shape \[2\], expected a number \(m\), or points"),
        ({"diameter": [[0.0, 1e-3], [0.1, 1e-4]]}, "missing field `youngs_modulus`"),
        ({"diameter": [[0.0, 1e-3], [0.1, 1e-4]], "youngs_modulus": 1e9, "tip_diameter": 1e-4}, "tip_diameter is given beside the diameters"),
        (
            {"diameter": [[0.0, 1e-3], [0.05, 0.0], [0.09, 1e-4]], "youngs_modulus": 1e9},
            "diameter of point 2 is 0.0 m, expected a positive, finite number; point 3 of diameter has the arc length 0.09 m, expected 0.1 m",
        ),
        ({"bending_stiffness": 1.0, "natural_curvature": math.nan}, "natural_curvature is NaN"),
        ({"bending_stiffness": 1.0, "natural_curvature": [1.0, 2.0]}, r"shape \[2\], expected a number"),
        ({"bending_stiffness": 1.0, "natural_curvature": [[0.0, 1.0], [0.0, 2.0]]}, "point 2 of natural_curvature has the arc length 0"),
        ({"bending_stiffness": 1.0, "natural_curvature": [[0.0, 1.0], [0.09, 2.0]]}, "point 2 of natural_curvature .* 0.09 m, expected 0.1 m"),
        ({"bending_stiffness": 1.0, "natural_curvature": [[0.01, 1.0], [0.1, 2.0]]}, "point 1 of natural_curvature .* 0.01 m, expected 0.0 m"),
        ({"bending_stiffness": 1.0, "natural_curvature": 100.0}, "crosses itself"),
        ({"bending_stiffness": 1.0, "natural_curvature": 1e300}, "turns the rod by .* rad at rest, expected at most 100 rad"),
        ({"bending_stiffness": 1.0, "natural_curvature": 1.0, "yield_stress": 1e9}, "yield_stress is given for a rod"),
        ({"sections": [vibrissa.Section(0.05, 1.0)]}, "add up to 0.05, expected 0.1"),
        ({"bending_stiffness": 1.0, "sections": [vibrissa.Section(0.1, 1.0)]}, "given beside sections"),
        ({"natural_curvature": 1.0, "sections": [vibrissa.Section(0.1, 1.0, natural_curvature=2.0)]}, "one of the two"),
    ],
)
def test_what_is_no_rod(arguments: dict[str, object], message: str) -> None:
    with pytest.raises(ValueError, match=message):
        vibrissa.Rod(0.1, **arguments)  # type: ignore[arg-type]


def test_what_is_no_section() -> None:
    for arguments, message in [
        ((0.0, 1.0), "length is 0"),
        ((0.1, -1.0), "bending_stiffness is -1"),
        ((0.1,), "expected bending_stiffness, or diameter and youngs_modulus"),
    ]:
        with pytest.raises(ValueError, match=message):
            vibrissa.Section(*arguments)
    with pytest.raises(ValueError, match="natural_curvature"):
        vibrissa.Section(0.1, 1.0, natural_curvature=math.inf)


@pytest.mark.parametrize(
    "rod",
    [
        vibrissa.Rod(0.1, diameter=5e-4, youngs_modulus=206e9, tip_diameter=5e-4),
        vibrissa.Rod(0.1, diameter=[[0.0, 5e-4], [0.04, 5e-4], [0.1, 5e-4]], youngs_modulus=206e9),
        vibrissa.Rod(0.1, diameter=5e-4, youngs_modulus=206e9, natural_curvature=0.0),
        vibrissa.Rod(0.1, sections=[vibrissa.Section(length, diameter=5e-4, youngs_modulus=206e9) for length in (0.03, 0.07)]),
    ],
    ids=["cone of equal ends", "equal diameters", "curvature 0", "equal sections"],
)
def test_a_rod_is_uniform_however_it_is_written(rod: vibrissa.Rod) -> None:
    plain = vibrissa.Rod(0.1, diameter=5e-4, youngs_modulus=206e9)
    assert rod.is_uniform and plain.is_uniform
    noise = {"white": {"force": 2.5e-3, "m0z": 6e-5}}
    samples, alike = (
        vibrissa.simulate(vibrissa.Scene(one, DISC, PATH, 1e-3), rate=1000.0, speed=0.01, noise=noise) for one in (rod, plain)
    )
    assert samples.tobytes() == alike.tobytes()
    # what only uniform rods have: corrections of errors that samples share, and answers while a sensor is read
    found, of_plain = (vibrissa.reconstruct(one, samples, fit=False) for one in (rod, plain))
    assert len(found.calibration) > 0 and np.array_equal(found.calibration, of_plain.calibration)
    assert np.array_equal(found.readings["x"], of_plain.readings["x"], equal_nan=True)
    assert vibrissa.Live(rod, samples[:1000]).delay == vibrissa.Live(plain, samples[:1000]).delay
