"""Forces from points on a rod."""

from __future__ import annotations

import math
from pathlib import Path

import numpy as np
import numpy.typing as npt
import pytest

import vibrissa
from vibrissa.tracking import Frames

ROD = vibrissa.Rod(0.1, bending_stiffness=1e-6)
Points = npt.NDArray[np.float64]


def swept() -> tuple[list[vibrissa.State], list[Points]]:
    """States of a rod that is pushed against a peg, and 40 points on each shape."""
    peg = vibrissa.CircularArc((0.06, 0.03), 0.004, 0.0, 2.0 * math.pi)
    scan = vibrissa.sweep(ROD, peg, vibrissa.ClampPath((0.0, 0.0, 0.1), (0.0, 0.04, 0.1)), 1e-3)
    states = [scan.state(k) for k in range(len(scan)) if len(scan.state(k).contacts) == 1 and scan.state(k).contacts[0].force > 1e-5]
    return states, [state.shape(ROD, 40)[:, :2] for state in states]


def test_states_of_a_sweep_are_found_again() -> None:
    states, points = swept()
    assert len(states) > 5
    found = vibrissa.forces(ROD, points)
    assert len(found) == len(states) and found.faults == {}
    table = found.frames
    for state, row in zip(states, table, strict=True):
        contact = state.contacts[0]
        assert row["verdict"] in ("determined", "several")
        if row["verdict"] == "determined":
            assert abs(row["s"] - contact.s) < 1e-8 and abs(row["force"] - contact.force) < 1e-9
        assert abs(row["m0z"] - state.reactions[2]) < 1e-11
    assert found.covariance.shape == (len(states), 6, 6)
    assert set(found.contacts["frame"]) == set(range(len(states)))


def test_channels_alone_and_what_they_cannot_tell() -> None:
    states, _ = swept()
    x0, y0, phi0 = np.array([state.pose for state in states]).T
    f0x, f0y, m0z = np.array([state.reactions for state in states]).T
    whole = vibrissa.forces(ROD, channels={"x0": x0, "y0": y0, "phi0": phi0, "f0x": f0x, "f0y": f0y, "m0z": m0z})
    assert (whole.frames["verdict"] == "determined").all()
    assert np.allclose(whole.frames["s"], [state.contacts[0].s for state in states], atol=1e-6)
    moment = vibrissa.forces(ROD, channels={"x0": x0, "y0": y0, "phi0": phi0, "m0z": m0z})
    assert (moment.frames["verdict"] == "family").all()
    assert len(moment.family) == 20 * len(states)


def test_markers_tell_as_points_do() -> None:
    states, _ = swept()
    x0, y0, phi0 = np.array([state.pose for state in states]).T
    # at every 10 mm
    x, y, phi = np.array([state.shape(ROD, 11)[[3, 7, 10], :3] for state in states]).T
    columns = {"x0": x0, "y0": y0, "phi0": phi0}
    for k, place in enumerate(("0.03", "0.07", "0.1")):
        columns |= {f"x@{place}": x[k], f"y@{place}": y[k], f"phi@{place}": phi[k]}
        columns |= {f"sigma_{name}@{place}": np.full(len(states), 1e-6) for name in ("x", "y", "phi")}
    found = vibrissa.forces(ROD, channels=columns).frames
    assert (found["verdict"] == "determined").sum() > len(states) / 2
    assert np.allclose(found["m0z"], [state.reactions[2] for state in states], rtol=1e-3, atol=1e-9)
    assert np.allclose(found["s"], [state.contacts[0].s for state in states], atol=1e-5)


def test_a_sensor_is_mounted(tmp_path: Path) -> None:
    states, _ = swept()
    x0, y0, phi0 = np.array([state.pose for state in states]).T
    f0x, f0y, m0z = np.array([state.reactions for state in states]).T
    # its x along y of the scene, the clamp 12 mm along its y
    columns = {"x0": x0, "y0": y0, "phi0": phi0, "Fx": -f0y, "Fy": f0x, "Tz": -m0z + 0.012 * f0y}
    setup = tmp_path / "setup.toml"
    setup.write_text("[mounting]\nangle = 90.0\nlever = [0.0, 0.012, 0.0]\n")
    found = vibrissa.forces(ROD, channels=columns, setup=setup)
    assert (found.frames["verdict"] == "determined").all()
    assert np.allclose(found.frames["s"], [state.contacts[0].s for state in states], atol=1e-6)
    with pytest.raises(FileNotFoundError):
        vibrissa.forces(ROD, channels=columns, setup=tmp_path / "none.toml")
    for channels, given in [(None, "none"), ({"m0z": [0.01], "phi0": [0.0]}, "m0z, phi0")]:
        with pytest.raises(ValueError, match=f"setup has no effect: the channels are {given}, expected any of Fx, Fy, Fz, Tx, Ty, Tz"):
            vibrissa.forces(ROD, [np.column_stack([np.linspace(0.0, 0.1, 40), np.zeros(40)])], channels=channels, setup=setup)


def test_frames_of_all_kinds_are_the_same() -> None:
    _, points = swept()
    with_gap = [np.vstack([one[:20], [[np.nan, np.nan]], one[20:]]) for one in points[:3]]
    one = vibrissa.forces(ROD, points[:3]).frames
    for frames in (dict(enumerate(points[:3])), with_gap, Frames.from_points(enumerate(points[:3]))):
        assert (vibrissa.forces(ROD, frames).frames["s"] == one["s"]).all()


def test_the_shape_at_rest_comes_from_free_frames() -> None:
    rng = np.random.default_rng(4)
    bent = vibrissa.Rod(0.1, bending_stiffness=1e-6, natural_curvature=8.0)
    s = np.linspace(0.0, 0.1, 40)

    def arc(phi: float) -> Points:
        line = np.column_stack([np.sin(8.0 * s + phi) - np.sin(phi), np.cos(phi) - np.cos(8.0 * s + phi)]) / 8.0
        return line + rng.normal(0.0, 5e-5, line.shape)

    rest = [arc(0.1 * k) for k in range(6)]
    found = vibrissa.forces(ROD, [arc(1.0)], rest=rest)
    assert found.rest is not None
    curvature, sigma = found.rest[:, 1], found.rest[:, 2]
    assert (abs(curvature - 8.0) < 5.0 * sigma).all() and (sigma < 0.1).all()
    assert found.frames["verdict"][0] == "free"
    assert vibrissa.forces(bent, [arc(1.0)]).frames["verdict"][0] == "free"
    # as if it were straight, the bend is a force
    assert vibrissa.forces(ROD, [arc(1.0)]).frames["verdict"][0] != "free"


def test_an_end_that_was_not_seen_is_not_taken_for_one() -> None:
    states, points = swept()
    rng = np.random.default_rng(1)
    whole = [one + rng.normal(0.0, 5e-5, one.shape) for one in points]
    lost = [np.vstack([[[np.nan, np.nan]] * 4, one[4:]]) for one in whole]
    # a uniform rod does not tell where along it the points are
    found = vibrissa.forces(ROD, lost, sigma=5e-5)
    assert not (found.frames["verdict"] == "determined").any()
    # without the gap the fifth point would be the base, and the moment that at the fifth point
    with pytest.warns(UserWarning, match="the first point is taken for the base.*Then use visible=.tip., or measure the base .base_x, base_y with channels,"):
        wrong = vibrissa.forces(ROD, [one[4:] for one in whole], sigma=5e-5)
    table = wrong.frames[wrong.frames["verdict"] == "determined"]
    true = np.array([states[number].reactions[2] for number in table["frame"]])
    error, otherwise = np.abs(table["m0z"] / true - 1.0), np.abs(table["m0z_if_hidden"] / true - 1.0)
    assert np.median(error) > 0.1 and np.nanmedian(otherwise) < 0.05
    assert abs(np.nanmedian(table["hidden"]) - 0.1 * 4 / 39) < 1e-3


def test_free_frames_of_several_shapes_are_told() -> None:
    states, points = swept()
    rng = np.random.default_rng(2)
    line = np.column_stack([np.linspace(0.0, 0.1, 40), np.zeros(40)])
    free = [line + rng.normal(0.0, 5e-5, line.shape) for _ in range(5)]
    assert vibrissa.forces(ROD, points, rest=free).findings == []
    with_contact = [*free, points[-1]]
    assert any("frame 5 differs most" in finding for finding in vibrissa.forces(ROD, points, rest=with_contact).findings)


def test_free_rods_bound_what_is_not_seen() -> None:
    rng = np.random.default_rng(3)
    line = np.column_stack([np.linspace(0.0, 0.1, 12), np.zeros(12)])
    table = vibrissa.forces(ROD, [line + rng.normal(0.0, 5e-5, line.shape) for _ in range(20)], sigma=5e-5).frames
    free = table[table["verdict"] == "free"]
    # E I / L is 1e-5 N m
    assert len(free) >= 19 and (free["sigma_m0z"] < 1e-6).all() and (free["sigma_m0z"] > 1e-8).all()


def test_mistakes_are_sentences() -> None:
    _, points = swept()
    for arguments, message in [
        ({"frames": [np.zeros(3)]}, "frames: frame 0 has the shape (3,), expected points of shape (n, 2)"),
        ({"frames": points[:1], "visible": "all"}, "visible is 'all', expected 'base', 'tip', 'both' or 'neither'"),
        ({"frames": points[:1], "sigma": 0.0}, "sigma is 0, expected a number larger than 0"),
        ({"frames": points[:1], "contacts": 3}, "contacts is 3, expected 0, 1 or 2"),
        ({"frames": points[:1], "channels": {"f0x": [1.0, 2.0]}}, "the channels have 2 rows, expected one a frame: 1"),
        ({"channels": {"torque": [1.0]}}, "torque is no measured number, expected frame, x, y for points"),
        ({"channels": {"x@0.2": [1.0], "phi@tip": [0.0]}}, r"x@0.2 is at `0.2`, expected an arc length in m, from 0 to 0.1, the length of the rod\nphi@tip"),
        ({"frames": points[:1], "rest": [np.zeros((2, 2))]}, "rest: no frame has 5 points or more and shows an end"),
        ({}, "neither frames nor channels are given"),
    ]:
        with pytest.raises(ValueError, match=message.replace("(", r"\(").replace(")", r"\)").replace(",)", ",)")):
            vibrissa.forces(ROD, **arguments)  # type: ignore[arg-type]
    found = vibrissa.forces(ROD, [points[0], points[0][:1], 1e3 * points[0]])
    assert list(found.frames["verdict"][1:]) == ["fault", "fault"]
    assert found.faults[1].startswith("1 points and 0 channels") and "are the points in mm?" in found.faults[2]


def test_a_pole_tells_places_and_forces_that_moments_alone_do_not() -> None:
    states, points = swept()
    found = vibrissa.forces(ROD, points, sigma=1e-6, pole=True)
    assert found.pole is not None and found.pole["elsewhere"] == []
    # a rod that goes straight past it hardly tells its radius
    sigmas = np.sqrt(np.diag(found.pole["covariance"]))
    away = math.dist(found.pole["center"], (0.06, 0.03)) - abs(found.pole["radius"] - 0.004)
    assert abs(away) < 5.0 * max(*sigmas, 1e-6), found.pole
    x0, y0, phi0 = np.array([state.pose for state in states]).T
    moments = {"base_x": x0, "base_y": y0, "base_phi": phi0, "m0z": np.array([state.reactions[2] for state in states])}
    moments["sigma_m0z"] = np.full(len(states), 1e-9)
    found = vibrissa.forces(ROD, channels=moments, pole=(0.06, 0.03), pole_radius=0.004, pole_sigma=1e-6)
    assert found.pole is not None
    told = found.frames[found.frames["verdict"] == "determined"]
    assert len(told) > len(states) // 2
    truth = {k: state.contacts[0].force for k, state in enumerate(states)}
    for row in told:
        assert abs(row["force"] - truth[int(row["frame"])]) < 6.0 * row["sigma_force"]


def test_poles_that_are_none_are_refused() -> None:
    _, points = swept()
    with pytest.raises(ValueError, match="pole_radius is -1"):
        vibrissa.forces(ROD, points, pole=True, pole_radius=-1.0)
    with pytest.raises(ValueError, match="without pole"):
        vibrissa.forces(ROD, points, pole_radius=1.0)
    with pytest.raises(ValueError, match="pole is not finite"):
        vibrissa.forces(ROD, points, pole=(math.nan, 0.0))
