"""Sweeps: the numbers of the command, tables, stops, interrupts."""

from __future__ import annotations

import json
import math
import pickle
import signal
import subprocess
import threading
import time
from pathlib import Path

import numpy as np
import numpy.typing as npt
import pytest
from conftest import SCENES, Hump

import vibrissa

PHASES = ["free", "A", "B", "BB", "BA", "B", "A", "free"]


def same(value: float, number: float | None) -> bool:
    """Equal to the last bit; a number that is missing in a file is none here."""
    return math.isnan(value) or math.isinf(value) if number is None else value == number


@pytest.mark.parametrize("name", ["O1_q40", "O3_q60", "comb", "square_tilted", "whisking", "whisker"])
def test_numbers_are_those_of_the_command(name: str, command: list[str], tmp_path: Path) -> None:
    scene = vibrissa.Scene.read(SCENES / f"{name}.toml")
    scan = scene.sweep()
    subprocess.run(
        [*command, "sweep", str(SCENES / f"{name}.toml"), "--out", str(tmp_path / "out")], check=True, capture_output=True
    )
    records = [json.loads(line) for line in (tmp_path / "out/states.jsonl").read_text().splitlines()]
    assert len(records) == len(scan) == len(scan.states) > 0
    for i, record in enumerate(records):
        contacts = record.pop("contacts")
        assert all(
            scan.states[i][key] == value if isinstance(value, (str, bool)) else same(scan.states[i][key], value)
            for key, value in record.items()
        )
        assert len(contacts) == len(scan.contacts[i])
        for row, contact in zip(scan.contacts[i], contacts):
            assert row["kind"] == contact.pop("kind")
            assert (row["object"], row["piece"]) == (contact.pop("object"), contact.pop("piece"))
            assert all(row[key] == value for key, value in contact.items())
    events = [json.loads(line) for line in (tmp_path / "out/events.jsonl").read_text().splitlines()]
    assert len(events) == len(scan.events)
    for row, event in zip(scan.events, events):
        assert (row["kind"], row["from"], row["to"], row["x0"]) == (event["kind"], event["from"], event["to"], event["x0"])
        assert row["m0z_after"] == event["after"]["m0z"]


def test_a_scene_made_here_is_that_of_the_file(
    rod: vibrissa.Rod, parabolas: vibrissa.Composite, path: vibrissa.ClampPath
) -> None:
    read = vibrissa.Scene.read(SCENES / "O1_q40.toml")
    # the file has -0.08999999999999998
    path = vibrissa.ClampPath(path.start, read.path.end)
    scan = vibrissa.sweep(rod, parabolas, path, 1e-3)
    assert scan.phases == PHASES
    np.testing.assert_array_equal(scan.states["m0z"], read.sweep().states["m0z"])


def test_the_shape_begins_at_the_clamp_and_touches_the_object(
    rod: vibrissa.Rod, parabolas: vibrissa.Composite, path: vibrissa.ClampPath
) -> None:
    scan = vibrissa.sweep(rod, parabolas, path, 1e-3)
    i = list(scan.states["phase"]).index("BA")
    shape = scan.shape(i, 2001)
    assert shape.shape == (2001, 3)
    assert tuple(shape[0]) == scan.state(i).pose
    gaps = parabolas.gap(shape[:, 0], shape[:, 1])
    assert gaps.min() > -1e-9
    tip = scan.contacts[i][-1]
    np.testing.assert_allclose(shape[-1, :2], [tip["x"], tip["y"]], atol=1e-12)
    # an inextensible rod: chords of 2,000 parts are as long as the rod to the square of a part's bend
    assert np.hypot(*np.diff(shape[:, :2], axis=0).T).sum() == pytest.approx(rod.length, rel=1e-6)
    np.testing.assert_array_equal(scan.state(i).shape(rod, 2001), shape)
    with pytest.raises(ValueError, match="n is 1, expected at least 2 points"):
        scan.shape(0, 1)
    with pytest.raises(IndexError, match="state 1000 of 171"):
        scan.shape(1000)


def test_tables_of_pandas_and_arrow_have_units(
    rod: vibrissa.Rod, parabolas: vibrissa.Composite, path: vibrissa.ClampPath
) -> None:
    scan = vibrissa.sweep(rod, parabolas, path, 1e-3)
    frame = scan.to_pandas()
    assert frame.attrs["units"]["m0z"] == "N m" and len(frame) == len(scan)
    np.testing.assert_array_equal(frame["f0x"], scan.states["f0x"])
    contacts = scan.to_pandas("contacts")
    forces = contacts.groupby("state")["force"].sum()
    assert forces[100] == sum(contact.force for contact in scan.state(100).contacts)
    table = scan.to_arrow()
    assert table.schema.field("x0").metadata == {b"unit": b"m"}
    lists = table["contacts"].to_pylist()
    assert [len(one) for one in lists] == [len(one) for one in scan.contacts]
    assert lists[100][0]["alpha"] == scan.contacts[100][0]["alpha"]
    assert scan.to_arrow("events")["kind"].to_pylist() == list(scan.events["kind"])
    assert scan.to_arrow("contacts")["state"].to_pylist() == list(contacts["state"])
    with pytest.raises(ValueError, match='table is "rows", expected'):
        scan.to_pandas("rows")  # type: ignore[arg-type]


def test_arrays_cannot_be_written_to(
    rod: vibrissa.Rod, parabolas: vibrissa.Composite, path: vibrissa.ClampPath
) -> None:
    scan = vibrissa.sweep(rod, parabolas, path, 1e-3)
    with pytest.raises(ValueError):
        scan.states["x0"][0] = 1.0
    assert scan.states is scan.states


def test_a_free_rod_has_no_contacts_and_no_events(rod: vibrissa.Rod, parabolas: vibrissa.Composite) -> None:
    scan = vibrissa.sweep(rod, parabolas, vibrissa.ClampPath((0.5, -0.04, 1.5), (0.4, -0.04, 1.5)), 0.05)
    assert scan.phases == ["free"]
    assert len(scan.events) == 0 and scan.events.dtype.names is not None
    assert [len(one) for one in scan.contacts] == [0, 0, 0]
    assert scan.to_arrow()["contacts"].to_pylist() == [[], [], []]


def test_a_sweep_that_stops_has_what_was_computed(rod: vibrissa.Rod, path: vibrissa.ClampPath) -> None:
    short = vibrissa.Parabola((0.0, 0.0), 50.0, x_from=-0.02, x_to=0.02)
    with pytest.raises(vibrissa.SweepStopped, match="the rod came to the end of an open contour") as caught:
        vibrissa.sweep(rod, short, path, 1e-3)
    stopped = caught.value
    assert stopped.reason == "end-of-contour"
    assert stopped.scan is not None and stopped.scan.stop == str(stopped)
    assert len(stopped.scan) == int((0.08 - stopped.pose[0]) / 1e-3) + 1
    assert stopped.tau == pytest.approx(0.08 - stopped.pose[0])


def test_wrong_arguments_are_named(rod: vibrissa.Rod, parabolas: vibrissa.Composite, path: vibrissa.ClampPath) -> None:
    with pytest.raises(ValueError, match="step is -1.0, expected a positive, finite length"):
        vibrissa.sweep(rod, parabolas, path, -1.0)
    with pytest.raises(ValueError, match="step has 2 numbers, expected one, or 1"):
        vibrissa.sweep(rod, parabolas, path, [1.0, 1.0])
    with pytest.raises(ValueError, match="length is -1, expected a positive"):
        vibrissa.Rod(-1.0, 1.0)
    with pytest.raises(ValueError, match="expected bending_stiffness, or diameter and youngs_modulus"):
        vibrissa.Rod(1.0)
    with pytest.raises(ValueError, match="to.x is NaN, expected a finite number"):
        vibrissa.ClampPath((0.0, 0.0, 0.0), (math.nan, 0.0, 0.0))
    with pytest.raises(TypeError, match="argument 'start': expected a pose of three numbers.*found 2"):
        vibrissa.ClampPath((0.0, 0.0), (1.0, 0.0, 0.0))
    with pytest.raises(TypeError, match="argument 'step': expected a number in m .*, found '1mm'"):
        vibrissa.sweep(rod, parabolas, path, "1mm")  # type: ignore[arg-type]
    with pytest.warns(UserWarning, match="phi is 90.0 rad, more than two turns; angles are in rad"):
        vibrissa.ClampPath((0.08, -0.04, 90.0), (-0.08, -0.04, 90.0))
    with pytest.raises(FileNotFoundError, match="cannot read the scene"):
        vibrissa.Scene.read("none.toml")
    with pytest.raises(TypeError, match="the shape is of type int.*points make a Polygon or a Spline"):
        vibrissa.sweep(rod, [3], path, 1e-3)  # type: ignore[list-item]


def test_a_sweep_goes_on_from_a_state(
    rod: vibrissa.Rod, parabolas: vibrissa.Composite, path: vibrissa.ClampPath
) -> None:
    there = vibrissa.sweep(rod, parabolas, path, 1e-3)
    state = there.state(80)
    back = vibrissa.ClampPath(state.pose, path.start)
    again = vibrissa.sweep(rod, parabolas, back, 1e-3, start=pickle.loads(pickle.dumps(state)))
    np.testing.assert_allclose(again.states["f0x"], there.states["f0x"][80::-1], atol=1e-9)
    with pytest.raises(ValueError, match="the path starts at"):
        vibrissa.sweep(rod, parabolas, path, 1e-3, start=state)


def test_ctrl_c_ends_a_long_sweep(rod: vibrissa.Rod, parabolas: vibrissa.Composite, path: vibrissa.ClampPath) -> None:
    timer = threading.Timer(0.3, signal.raise_signal, [signal.SIGINT])
    # a shell that runs the tests in the background lets them ignore Ctrl-C
    before = signal.signal(signal.SIGINT, signal.default_int_handler)
    began = time.monotonic()
    timer.start()
    try:
        with pytest.raises(KeyboardInterrupt):
            vibrissa.sweep(rod, parabolas, path, 1e-8)
    finally:
        signal.signal(signal.SIGINT, before)
    assert time.monotonic() - began < 2.0


def test_other_threads_run_during_a_sweep(
    rod: vibrissa.Rod, parabolas: vibrissa.Composite, path: vibrissa.ClampPath
) -> None:
    ticks = 0
    over = threading.Event()

    def tick() -> None:
        nonlocal ticks
        while not over.wait(1e-3):
            ticks += 1

    thread = threading.Thread(target=tick)
    thread.start()
    time.sleep(0.05)
    before = ticks
    vibrissa.sweep(rod, parabolas, path, 5e-7)
    during = ticks - before
    over.set()
    thread.join()
    assert during > 50


def test_a_shape_of_ones_own_gives_the_sweep_of_the_parabola(rod: vibrissa.Rod, path: vibrissa.ClampPath) -> None:
    vibrissa.check_contract(Hump())
    own = vibrissa.sweep(rod, Hump(), path, 1e-3)
    built_in = vibrissa.sweep(rod, vibrissa.Parabola((0.0, 0.0), 50.0), path, 1e-3)
    assert own.phases == built_in.phases
    for field in ["f0x", "f0y", "m0z"]:
        np.testing.assert_allclose(own.states[field], built_in.states[field], atol=1e-10)
    assert not own.states["gap_proven"].all() and built_in.states["gap_proven"].all()


def swing(t: npt.NDArray[np.float64]) -> npt.ArrayLike:
    zero = np.zeros_like(t)
    return [0.02 + 0.02 * np.cos(t), zero - 0.04, zero + math.pi / 2, -0.02 * np.sin(t), zero, zero]


def test_a_path_of_ones_own_is_that_of_the_library(rod: vibrissa.Rod, parabolas: vibrissa.Composite) -> None:
    path = vibrissa.ClampFunction(swing, math.pi)
    scan = vibrissa.sweep(rod, parabolas, path, math.pi / 4)
    np.testing.assert_allclose(scan.states["x0"], 0.02 + 0.02 * np.cos(math.pi / 4 * np.arange(5)), atol=1e-16)
    np.testing.assert_allclose(path.rate([math.pi / 2]), [[-0.02, 0.0, 0.0]], atol=1e-16)
    straight = vibrissa.sweep(rod, parabolas, vibrissa.ClampPath((0.04, -0.04, math.pi / 2), (0.0, -0.04, math.pi / 2)), 0.02)
    # the middle and the end are the same poses
    for name in ("f0x", "f0y", "m0z"):
        np.testing.assert_allclose(scan.states[name][[2, 4]], straight.states[name][1:], rtol=1e-11)


def test_paths_of_ones_own_are_checked(rod: vibrissa.Rod, parabolas: vibrissa.Composite) -> None:
    def wrong(t: npt.NDArray[np.float64]) -> npt.ArrayLike:
        rows = np.array(swing(t))
        rows[3] *= 2.0
        return rows

    with pytest.raises(ValueError, match="the rate of x of the path is .* at the parameter .*, expected .*, by differences"):
        vibrissa.sweep(rod, parabolas, vibrissa.ClampFunction(wrong, math.pi), 0.1)
    with pytest.raises(ValueError, match=r"has shape \[97\], expected an array of shape \(6, n\)"):
        vibrissa.ClampFunction(lambda t: t)
    with pytest.raises(ValueError, match="length is -1.0, expected a finite number greater than 0"):
        vibrissa.ClampFunction(swing, -1.0)

    def broken(t: npt.NDArray[np.float64]) -> npt.ArrayLike:
        raise KeyError("nothing there")

    with pytest.raises(KeyError, match="nothing there"):
        vibrissa.ClampFunction(broken)


def test_a_stop_comes_from_a_worker(rod: vibrissa.Rod, parabolas: vibrissa.Composite, path: vibrissa.Path) -> None:
    with pytest.raises(vibrissa.SweepStopped) as stopped:
        vibrissa.sweep(rod, parabolas, path, 1e-3, most_steps=3)
    copy = pickle.loads(pickle.dumps(stopped.value))
    assert (str(copy), copy.reason, copy.pose) == (str(stopped.value), "step-budget", stopped.value.pose)
    assert copy.scan is None


def test_a_shape_has_a_limit_of_points(rod: vibrissa.Rod, parabolas: vibrissa.Composite, path: vibrissa.Path) -> None:
    scan = vibrissa.sweep(rod, parabolas, path, 1e-2)
    with pytest.raises(ValueError, match="n is 1000000000000, expected at most 10000000 points"):
        scan.shape(0, 10**12)


def test_a_sweep_has_a_limit_of_states(rod: vibrissa.Rod, parabolas: vibrissa.Composite, path: vibrissa.Path) -> None:
    with pytest.raises(ValueError, match="step is 1e-12, which asks for 1.7e11 states, expected at most 2e7"):
        vibrissa.sweep(rod, parabolas, path, 1e-12)
