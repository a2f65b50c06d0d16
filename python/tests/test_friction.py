"""Coulomb friction: the numbers of the command, loops there and back, pickling, wrong coefficients."""

from __future__ import annotations

import json
import math
import pickle
import re
import subprocess
from pathlib import Path
from typing import Any

import numpy as np
import numpy.typing as npt
import pytest
from conftest import SCENES
from test_sweep import same

import vibrissa
import vibrissa.plot

MU = 0.3


def with_friction(name: str, friction: str) -> str:
    return f"{(SCENES / f'{name}.toml').read_text()}\n[contact]\nfriction = {friction}\n"


def identical(one: npt.NDArray[Any], other: npt.NDArray[Any]) -> bool:
    """Equal to the last bit, also where a number is NaN."""
    return one.dtype == other.dtype and one.tobytes() == other.tobytes()


def there_and_back(turn: float) -> vibrissa.Path:
    """The clamp goes from x = 80 mm to ``turn`` and back."""
    ends = (0.08, turn, 0.08)
    return vibrissa.Chain.polyline([(x, -0.04, math.pi / 2) for x in ends])


@pytest.fixture
def loop(rod: vibrissa.Rod, parabolas: vibrissa.Composite) -> vibrissa.Scan:
    return vibrissa.sweep(rod, parabolas, there_and_back(-0.04), 2e-4, friction=MU)


@pytest.mark.parametrize(
    "name, friction", [("O1_q40", "0.3"), ("O1_q40", "{ at_rest = 0.3, slipping = 0.2 }"), ("whisking", "0.2")]
)
def test_numbers_are_those_of_the_command(name: str, friction: str, command: list[str], tmp_path: Path) -> None:
    file = tmp_path / "scene.toml"
    file.write_text(with_friction(name, friction))
    scan = vibrissa.Scene.read(file).sweep()
    subprocess.run([*command, "sweep", str(file), "--out", str(tmp_path / "out")], check=True, capture_output=True)
    records = [json.loads(line) for line in (tmp_path / "out/states.jsonl").read_text().splitlines()]
    assert len(records) == len(scan) > 0
    modes = set()
    for i, record in enumerate(records):
        assert all(same(scan.states[i][key], record[key]) for key in ("x0", "f0x", "f0y", "m0z", "energy"))
        assert len(record["contacts"]) == len(scan.contacts[i])
        for row, contact in zip(scan.contacts[i], record["contacts"]):
            assert all(row[key] == contact[key] for key in ("mode", "friction", "slip", "force", "s"))
            modes.add(str(row["mode"]))
    assert "slip-" in modes
    events = [json.loads(line) for line in (tmp_path / "out/events.jsonl").read_text().splitlines()]
    assert [(event["kind"], event["dissipated"]) for event in events] == [
        (row["kind"], row["dissipated"]) for row in scan.events
    ]
    assert scan.dissipated is not None and scan.dissipated >= events[-1]["dissipated"] > 0.0


def test_a_scene_made_here_is_that_of_the_file(
    rod: vibrissa.Rod, parabolas: vibrissa.Composite
) -> None:
    read = vibrissa.Scene.parse(with_friction("O1_q40", str(MU)))
    assert read.friction == [MU]
    scan = vibrissa.sweep(rod, parabolas, read.path, 1e-3, friction=MU)
    np.testing.assert_array_equal(scan.states["m0z"], read.sweep().states["m0z"])
    made = vibrissa.Scene(rod, parabolas, read.path, 1e-3, friction=MU)
    np.testing.assert_array_equal(made.sweep().states["m0z"], scan.states["m0z"])


def test_a_turn_of_the_clamp_makes_the_side_roll_then_slip_the_other_way(loop: vibrissa.Scan) -> None:
    contact = np.array([rows[0] if len(rows) else np.zeros((), rows.dtype) for rows in loop.contacts])
    there, back = (loop.states["leg"] == leg for leg in (0, 1))
    tangent = contact["kind"] == "tangent"
    assert set(contact["mode"][there & tangent]) == {"slip-"}
    # the coordinate of a contact that rolls stays, and the contact moves
    rolls = back & (contact["mode"] == "stick")
    assert rolls.sum() > 5
    assert np.ptp(contact["slip"][rolls]) < 1e-12 and np.ptp(contact["s"][rolls]) > 1e-4
    assert np.all(np.abs(contact["friction"][rolls]) <= MU * contact["force"][rolls] * (1.0 + 1e-12))
    assert list(loop.events["kind"][loop.events["leg"] == 1])[:2] == ["stick", "slip"]
    # the force leans by rho against the contour: K / 2 |F| = sin rho, of either sign
    sine = MU / math.hypot(1.0, MU)
    found = vibrissa.plot.phase_criterion(loop.states, loop.rod) / loop.rod.bending_stiffness
    found /= 2.0 * np.hypot(loop.states["f0x"], loop.states["f0y"]) + (loop.states["phase"] == "free")
    single = loop.states["phase"] == "B"
    for leg, mode, sign in [(there, "slip-", 1.0), (back, "slip+", -1.0)]:
        rows = leg & single & (contact["mode"] == mode)
        assert rows.sum() > 20
        np.testing.assert_allclose(found[rows], sign * sine, atol=1e-9)


def test_work_around_a_loop_is_what_friction_takes(loop: vibrissa.Scan) -> None:
    # f0x dx of the support, free at both ends: the energy is 0 there
    x, force = loop.states["x0"], loop.states["f0x"]
    assert loop.states["energy"][0] == loop.states["energy"][-1] == 0.0
    work = float(np.sum(0.5 * (force[1:] + force[:-1]) * np.diff(x)))
    assert loop.dissipated == pytest.approx(work, rel=2e-3)
    dissipated = loop.events["dissipated"]
    assert np.all(np.diff(dissipated) >= 0.0) and dissipated[-1] <= loop.dissipated
    assert loop.event(-1).dissipated == dissipated[-1]


def test_nothing_is_added_without_friction(rod: vibrissa.Rod, parabolas: vibrissa.Composite, path: vibrissa.ClampPath) -> None:
    smooth = vibrissa.sweep(rod, parabolas, path, 1e-3)
    contacts = smooth.contacts.values
    assert set(contacts["mode"]) == {""} and np.isnan(contacts["friction"]).all() and np.isnan(contacts["slip"]).all()
    assert smooth.dissipated is None and smooth.event(0).dissipated is None
    contact = smooth.state(100).contacts[0]
    assert (contact.mode, contact.friction, contact.slip) == (None, None, None)
    # as in scene files, coefficients of 0 are none
    none = vibrissa.sweep(rod, parabolas, path, 1e-3, friction=0.0)
    assert identical(none.states, smooth.states)
    assert none.dissipated is None


def test_pickling_keeps_friction(loop: vibrissa.Scan) -> None:
    again = pickle.loads(pickle.dumps(loop))
    assert identical(again.contacts.values, loop.contacts.values) and identical(again.events, loop.events)
    assert again.dissipated == loop.dissipated
    event = loop.event(-2)
    assert pickle.loads(pickle.dumps(event)) == event and event.dissipated is not None
    state = loop.state(300)
    assert pickle.loads(pickle.dumps(state)) == state and vibrissa.State.from_json(state.to_json()) == state
    contact = state.contacts[0]
    assert contact.mode is not None
    assert pickle.loads(pickle.dumps(contact)) == contact
    assert eval(repr(contact), {"Contact": vibrissa.Contact}) == contact


@pytest.mark.parametrize("friction", [0.3, (0.3, 0.2), [0.1, (0.3, 0.2)], [[0.1, (0.4, 0.3)], 0.2]])
def test_scenes_keep_friction(rod: vibrissa.Rod, parabolas: vibrissa.Composite, friction: Any) -> None:
    wall = vibrissa.Polygon([(0.3, 0.0), (0.4, 0.0), (0.4, 0.1), (0.3, 0.1)])
    path = vibrissa.ClampPath((0.08, -0.04, math.pi / 2), (-0.02, -0.04, math.pi / 2))
    scene = vibrissa.Scene(rod, [parabolas, wall], path, 1e-3, friction=friction)
    for again in (pickle.loads(pickle.dumps(scene)), vibrissa.Scene.parse(scene.to_toml())):
        assert again.friction == scene.friction is not None and len(scene.friction) == 2
        assert identical(again.sweep().contacts.values, scene.sweep().contacts.values)
    assert vibrissa.Scene(rod, parabolas, there_and_back(-0.02), 1e-3).friction is None


def test_lists_are_of_objects_in_order(rod: vibrissa.Rod, parabolas: vibrissa.Composite, path: vibrissa.ClampPath) -> None:
    far = vibrissa.Line((0.0, 5.0), (1.0, 5.0))
    rough = vibrissa.sweep(rod, [parabolas, far], path, 1e-3, friction=[MU, 0.0])
    np.testing.assert_array_equal(
        rough.states["m0z"], vibrissa.sweep(rod, [parabolas, far], path, 1e-3, friction=MU).states["m0z"]
    )
    np.testing.assert_array_equal(
        vibrissa.sweep(rod, [parabolas, far], path, 1e-3, friction=np.array([MU, 0.5])).states["m0z"], rough.states["m0z"]
    )
    slippery = vibrissa.sweep(rod, [parabolas, far], path, 1e-3, friction=[0.0, MU])
    assert np.isnan(slippery.contacts.values["friction"]).all()


def test_a_simulated_recording_has_friction(rod: vibrissa.Rod, parabolas: vibrissa.Composite) -> None:
    path = vibrissa.ClampPath((0.08, -0.04, math.pi / 2), (0.0, -0.04, math.pi / 2))
    rough = vibrissa.Scene(rod, parabolas, path, 1e-3, friction=MU)
    smooth = vibrissa.Scene(rod, parabolas, path, 1e-3)
    options: Any = {"rate": 100.0, "speed": 0.1}
    samples = vibrissa.simulate(rough, **options)
    np.testing.assert_array_equal(samples["f0y"], rough.sweep().states["f0y"])
    assert identical(samples, vibrissa.simulate(smooth, friction=MU, **options))
    assert identical(vibrissa.simulate(smooth, **options), vibrissa.simulate(rough, friction=0, **options))


def test_a_follower_rolls_before_it_slips_back(rod: vibrissa.Rod, parabolas: vibrissa.Composite) -> None:
    def pose(x: float) -> tuple[float, float, float]:
        return (x, -0.04, math.pi / 2)

    def mode(one: vibrissa.Follower) -> str | None:
        return one.state.contacts[0].mode

    follower = vibrissa.Follower(rod, parabolas, pose(0.09), friction=MU)
    follower.to(pose(-0.02))
    scan = vibrissa.sweep(rod, parabolas, vibrissa.ClampPath(pose(0.09), pose(-0.02)), 0.01, friction=MU)
    assert mode(follower) == "slip-" and follower.state.reactions == pytest.approx(scan.state(-1).reactions, abs=1e-12)
    again = vibrissa.Follower.from_state(rod, parabolas, follower.state, friction=MU)
    for one in (follower, again):
        one.to(pose(-0.0199))
        assert mode(one) == "stick"
        one.to(pose(-0.01))
        assert mode(one) == "slip+"
    with pytest.raises(ValueError, match=r"friction is -1, expected a finite coefficient"):
        vibrissa.Follower(rod, parabolas, pose(0.09), friction=-1)


@pytest.mark.parametrize(
    "friction, message",
    [
        (-0.1, r"friction is -0\.1, expected a finite coefficient, 0 or more"),
        (math.nan, "friction is nan, expected a finite coefficient, 0 or more"),
        (math.inf, "friction is inf, expected a finite coefficient, 0 or more"),
        ([0.3, 0.2], "friction is a list of 2, expected 1: one for each object"),
        ([], "friction is a list of 0, expected 1: one for each object"),
        ([math.nan], "friction is nan, expected a finite coefficient, 0 or more"),
        ((0.2, 0.3), r"friction is \(0\.2, 0\.3\), expected \(at_rest, slipping\) with 0 < slipping <= at_rest"),
        ([[0.3, 0.2, 0.1]], "friction of object 0 is a list of 3, expected 2: one for each piece"),
    ],
)
def test_wrong_coefficients(
    rod: vibrissa.Rod, parabolas: vibrissa.Composite, path: vibrissa.ClampPath, friction: Any, message: str
) -> None:
    with pytest.raises(ValueError, match=message):
        vibrissa.sweep(rod, parabolas, path, 1e-3, friction=friction)
    with pytest.raises(ValueError, match=message):
        vibrissa.Scene(rod, parabolas, path, 1e-3, friction=friction)


@pytest.mark.parametrize("friction", ["0.3", (0.1, 0.2, 0.3), {"at_rest": 0.3}, [None], object()])
def test_what_is_no_coefficient(
    rod: vibrissa.Rod, parabolas: vibrissa.Composite, path: vibrissa.ClampPath, friction: Any
) -> None:
    with pytest.raises(TypeError, match="friction is .*, expected a coefficient"):
        vibrissa.sweep(rod, parabolas, path, 1e-3, friction=friction)


def test_a_contact_has_all_of_friction_or_nothing() -> None:
    with pytest.raises(ValueError, match='mode is "roll", expected'):
        vibrissa.Contact("tip", 0.1, 0.0, 0.0, 0.0, 1.0, mode="roll", friction=0.1, slip=0.0)  # type: ignore[arg-type]
    with pytest.raises(ValueError, match=r"mode is stick, friction 0\.1 and slip None, expected all three"):
        vibrissa.Contact("tip", 0.1, 0.0, 0.0, 0.0, 1.0, mode="stick", friction=0.1)


def test_the_figure_marks_where_contacts_stick(loop: vibrissa.Scan) -> None:
    axes = vibrissa.plot.hysteresis(loop)
    assert axes[-1].get_xlabel() == r"clamp position $\mathregular{x_0}$ in mm"
    figure = axes[0].get_figure(root=True)
    assert figure is not None
    names = [text.get_text() for text in figure.legends[0].get_texts()]
    assert names == ["leg 0 \u2190", "leg 1 \u2192", "a contact sticks or rolls"]
    # -40 to 80 mm, by the size of the numbers in the style, not by that of the settings
    assert len(axes[-1].get_xticks()) >= 7
    # from the turn of the clamp to the event
    slips = float(loop.events["x0"][loop.events["kind"] == "slip"][0])
    for ax in axes:
        (wide,) = [line for line in ax.lines if line.get_linewidth() == 5.0 and np.size(line.get_xydata())]
        x = np.asarray(wide.get_xdata(), dtype=float)
        assert x[0] == pytest.approx(-0.04) and x[-1] == pytest.approx(slips)
        lines = [line for line in ax.lines if line.get_linewidth() == 1.3]
        assert [line.get_color() for line in lines] == ["#332288", "#999933"]
    with pytest.raises(ValueError, match="there are 2 axes, expected three"):
        vibrissa.plot.hysteresis(loop, axes[:2])


def test_the_figure_of_a_rod_that_snaps_has_dotted_jumps() -> None:
    scene = vibrissa.Scene.parse(with_friction("whisking", "0.2"))
    axes = vibrissa.plot.hysteresis(scene.sweep())
    assert any(line.get_linestyle() == ":" for line in axes[2].lines)
    assert axes[-1].get_xlabel().endswith("in degrees")


def blocks(language: str) -> list[str]:
    page = (Path(__file__).parents[2] / "docs/friction.md").read_text()
    return re.findall(rf"^```{language}\n(.*?)^```", page, re.DOTALL | re.MULTILINE)


def test_examples_of_the_page(monkeypatch: pytest.MonkeyPatch, tmp_path: Path) -> None:
    monkeypatch.chdir(tmp_path)
    (python,) = blocks("python")
    names: dict[str, Any] = {}
    exec(python, names)
    assert names["contact"].mode == "slip-" and list(tmp_path.glob("*.png"))
    (toml,) = blocks("toml")
    scene = vibrissa.Scene.parse(toml)
    assert scene.friction == [[(0.5, 0.4), 0.1], 0.3]
    assert scene.sweep().stop is None
