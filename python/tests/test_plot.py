"""Figures: what is drawn, where, in which colours, and that it can be read."""

from __future__ import annotations

import itertools
import math
from collections.abc import Iterator
from pathlib import Path
from typing import Any

import matplotlib as mpl

mpl.use("Agg")

import matplotlib.pyplot as plt
import numpy as np
import numpy.typing as npt
import pytest
from conftest import SCENES, Hump
from matplotlib.axes import Axes
from matplotlib.backends.backend_agg import FigureCanvasAgg
from matplotlib.colors import to_hex
from matplotlib.figure import Figure
from matplotlib.text import Text

import vibrissa
import vibrissa.plot
from vibrissa.plot._along import _PhaseNames
from vibrissa.plot._course import course, runs
from vibrissa.plot._palette import FAINT, FIRST, MUTED, OTHERS, TRANSITION
from vibrissa.plot._plane import _outline

Array = npt.NDArray[np.float64]


@pytest.fixture(scope="module")
def scan() -> vibrissa.Scan:
    return vibrissa.Scene.read(SCENES / "O1_q40.toml").sweep()


@pytest.fixture(scope="module")
def whisking() -> vibrissa.Scan:
    return vibrissa.Scene.read(SCENES / "whisking.toml").sweep()


@pytest.fixture(scope="module")
def samples() -> npt.NDArray[np.void]:
    scene = vibrissa.Scene.read(SCENES / "O1_q40.toml")
    return vibrissa.simulate(scene, rate=500.0, speed=0.01, noise={"white": {"force": 2.5e-3, "m0z": 6e-5}})


@pytest.fixture(scope="module")
def found(scan: vibrissa.Scan, samples: npt.NDArray[np.void]) -> vibrissa.Reconstruction:
    return vibrissa.reconstruct(scan.rod, samples)


@pytest.fixture(autouse=True)
def settings_stay_and_figures_go() -> Iterator[None]:
    before = dict(mpl.rcParams)
    yield
    assert dict(mpl.rcParams) == before
    plt.close("all")


def figure_of(ax: Axes) -> Figure:
    figure = ax.get_figure(root=True)
    assert figure is not None
    return figure


def assert_legible(ax: Axes, width: float = 85.0) -> None:
    """A figure of this width in mm, in which all texts have 7 pt or more, are inside, and do not overlap."""
    figure = figure_of(ax)
    assert figure.get_size_inches()[0] == pytest.approx(width / 25.4)
    canvas = FigureCanvasAgg(figure)
    canvas.draw()  # type: ignore[no-untyped-call]
    renderer = canvas.get_renderer()  # type: ignore[no-untyped-call]
    texts = [text for text in figure.findobj(Text) if isinstance(text, Text) and text.get_text().strip() and text.get_visible()]
    # an axis also has numbers beyond its ends, which are not drawn
    for axis in [axis for one in figure.axes for axis in (one.xaxis, one.yaxis)]:
        low, high = sorted(axis.get_view_interval())
        beyond = {id(tick.label1) for tick in axis.get_major_ticks() if not low <= tick.get_loc() <= high}
        texts = [text for text in texts if id(text) not in beyond]
    for names in figure.findobj(_PhaseNames):
        assert isinstance(names, _PhaseNames)
        texts += names.placed(renderer)
    boxes = [(text.get_text(), text.get_window_extent(renderer)) for text in texts]
    assert len(boxes) > 8 and all(float(text.get_fontsize()) >= 6.99 for text in texts)
    for name, box in boxes:
        assert figure.bbox.x0 <= box.x0 and box.x1 <= figure.bbox.x1 and figure.bbox.y0 <= box.y0 and box.y1 <= figure.bbox.y1, name
    for (one, a), (other, b) in itertools.combinations(boxes, 2):
        assert min(a.x1, b.x1) - max(a.x0, b.x0) < 0.5 or min(a.y1, b.y1) - max(a.y0, b.y0) < 0.5, (one, other)


def lines_of(ax: Axes) -> list[tuple[str, Array, Array]]:
    """Colour, x and y of the lines of a quantity, without marks."""
    lines = [line for line in ax.lines if line.get_linewidth() == 1.3 and len(np.asarray(line.get_xdata())) > 1]
    return [(to_hex(line.get_color()), np.asarray(line.get_xdata()), np.asarray(line.get_ydata())) for line in lines]


def test_colours_are_those_of_the_command() -> None:
    palette = (SCENES.parent / "cli/src/figure/palette.rs").read_text()
    phases = [vibrissa.plot.phase_color(phase) for phase in ["free", "A", "B", "BA", "BB", "BBA", "BBB", "BBBB"]]
    for color in [*phases, FAINT, FIRST, MUTED, TRANSITION, *OTHERS[:3]]:
        numbers = ", ".join(str(int(color[k : k + 2], 16)) for k in (1, 3, 5))
        assert f"RGBColor({numbers})" in palette, color
    assert not set(phases) & set(OTHERS)


def test_the_figure_of_a_sweep(scan: vibrissa.Scan) -> None:
    left, *right = vibrissa.plot.sweep(scan)
    # 57 shapes and one for each transition
    assert len(left.lines) == 57 + len(scan.events)
    drawn = lines_of(right[0])
    assert [color for color, _, _ in drawn] == [vibrissa.plot.phase_color(phase) for phase in scan.phases]
    # lines begin and end at the transitions
    for k, event in enumerate(scan.events):
        assert (drawn[k][1][-1], drawn[k][2][-1]) == (event["x0"], event["f0x"])
        assert (drawn[k + 1][1][0], drawn[k + 1][2][0]) == (event["x0_after"], event["f0x_after"])
    moments = np.concatenate([y for _, _, y in lines_of(right[2])])
    assert set(scan.states["m0z"]) <= set(moments)
    assert_legible(left, 175.0)
    assert [ax.get_ylabel().split(" in ")[1] for ax in right] == ["mN", "mN", "mN·m"]
    assert all(sum(label.get_visible() for label in ax.get_yticklabels()) >= 3 for ax in (left, *right))
    assert [any(label.get_visible() for label in ax.get_xticklabels()) for ax in right] == [False, False, True]
    assert right[2].get_xlabel() == "clamp position $\\mathregular{x_0}$ in mm (\u2190 scan)"
    assert (left.get_xlabel(), left.get_ylabel()) == ("x in mm", "y in mm")


@pytest.mark.parametrize("name", ["whisking", "comb", "ring_gear"])
def test_figures_of_other_scenes_are_legible(name: str) -> None:
    other = vibrissa.Scene.read(SCENES / f"{name}.toml").sweep()
    left, *right = vibrissa.plot.sweep(other)
    assert_legible(left, 175.0)
    assert_legible(vibrissa.plot.reactions(other)[0])
    ax = vibrissa.plot.shapes(other)
    assert_legible(ax)
    (x_min, x_max), (y_min, y_max) = ax.get_xlim(), ax.get_ylim()
    for line in ax.lines:
        x, y = np.asarray(line.get_xdata()), np.asarray(line.get_ydata())
        assert x_min < x.min() and x.max() < x_max and y_min < y.min() and y.max() < y_max


def test_small_objects_are_in_view_as_a_whole() -> None:
    rod = vibrissa.Rod(0.1, diameter=0.5e-3, youngs_modulus=206e9)
    peg = vibrissa.Composite(vibrissa.CircularArc((0.03, 0.09), 2e-4, 0.0, 2.0 * math.pi))
    far = vibrissa.Composite(vibrissa.CircularArc((0.0, 0.9), 2e-4, 0.0, 2.0 * math.pi))
    ax = vibrissa.plot.shapes(vibrissa.sweep(rod, [peg, far], vibrissa.ClampPath((0.0, 0.0, math.pi / 2), (0.01, 0.0, math.pi / 2)), 1e-3))
    assert 0.0302 < ax.get_xlim()[1] < 0.1 and ax.get_ylim()[1] < 0.2
    outline = np.asarray(ax.collections[0].get_paths()[0].vertices, dtype=float)
    assert np.hypot(*(outline - [0.03, 0.09]).T) == pytest.approx(2e-4)


def test_outlines_are_exact(scan: vibrissa.Scan) -> None:
    window = (-0.03, 0.06, -0.01, 0.03)
    ax = plt.figure().add_subplot()
    vibrissa.plot.object_outline(ax, scan.objects, window, colors="red")
    (line,) = ax.collections
    points = np.asarray(line.get_paths()[0].vertices)
    seen = points[(points[:, 1] < 0.03)]
    assert np.abs(scan.objects[0].gap(seen[:, 0], seen[:, 1])).max() < 1e-12
    # as far as the window, with the corner, without gaps
    assert seen[0, 0] < -0.024 and seen[-1, 0] > 0.054 and np.hypot(*(seen - [0.015, 0.01125]).T).min() < 1e-5
    assert np.hypot(*np.diff(seen, axis=0).T).max() < 3e-3
    # a shape of one's own
    own = vibrissa.Composite(Hump())
    points = _outline(own, window)[:, :2]
    assert len(points) > 100 and np.abs(own.gap(points[::20, 0], points[::20, 1])).max() < 1e-9


def test_axes_can_be_passed_in(scan: vibrissa.Scan, found: vibrissa.Reconstruction) -> None:
    _, axes = plt.subplots(2, 3)
    assert vibrissa.plot.criterion(scan, axes[0, 0]) is axes[0, 0]
    assert vibrissa.plot.shapes(scan, axes[0, 1], most=5) is axes[0, 1]
    assert vibrissa.plot.contour(found, axes[0, 2]) is axes[0, 2]
    assert vibrissa.plot.reactions(scan, axes[1])[2] is axes[1, 2]
    assert not figure_of(axes[0, 0]).legends and {line.get_label() for line in axes[0, 1].lines} >= {"free", "phase B", "at a transition"}
    with pytest.raises(ValueError, match="there are 2 axes, expected three"):
        vibrissa.plot.reactions(scan, list(axes[0, :2]))


def test_the_criterion(scan: vibrissa.Scan, found: vibrissa.Reconstruction) -> None:
    # it vanishes while the last contact is tangential, and is negative at the tip
    criterion = vibrissa.plot.phase_criterion(scan.states, scan.rod)
    phases = scan.states["phase"]
    scale = np.abs(criterion).max()
    assert np.abs(criterion[np.isin(phases, ["B", "BB"])]).max() < 1e-12 * scale
    assert criterion[np.isin(phases, ["A", "BA"])].max() < 0.0
    for ax in (vibrissa.plot.criterion(scan), vibrissa.plot.criterion(found, over="position")):
        assert "2 EI" in ax.get_ylabel() and ax.get_ylabel().endswith("in (mN·m)²")
        assert_legible(ax)
    ax.set_ylim(-5e-3, 0.0)
    figure_of(ax).canvas.draw()
    # the prefix of a square counts twice
    assert ax.get_ylabel().endswith("in (mN·m)²") and ax.get_yticklabels()[0].get_text() == "\u22125000"
    soft = vibrissa.Rod(0.1, 6e-4, clamp=vibrissa.ElasticClamp(stiffness_phi=0.4))
    path = vibrissa.ClampPath((0.05, -0.04, math.pi / 2), (0.04, -0.04, math.pi / 2))
    with pytest.raises(ValueError, match="expected a uniform, straight one on a rigid clamp"):
        vibrissa.plot.criterion(vibrissa.sweep(soft, scan.objects, path, 5e-3))
    assert not plt.get_fignums()[2:]


def test_units_have_the_prefix_of_what_is_seen(whisking: vibrissa.Scan) -> None:
    axes = vibrissa.plot.reactions(whisking)
    assert [ax.get_ylabel().split(" in ")[1] for ax in axes] == ["µN", "µN", "µN·m"]
    axes[0].set_ylim(-2e-3, 2e-3)
    axes[1].set_ylabel("a name of one's own")
    figure_of(axes[0]).canvas.draw()
    assert axes[0].get_ylabel().endswith(" in mN") and axes[1].get_ylabel() == "a name of one's own"
    numbers = {text.get_position()[1]: text.get_text() for text in axes[0].get_yticklabels()}
    assert numbers[-0.001] == "\u22121" and numbers[0.002] == "2"


def test_what_moves_is_the_abscissa(scan: vibrissa.Scan, whisking: vibrissa.Scan, samples: npt.NDArray[np.void]) -> None:
    turning = vibrissa.sweep(scan.rod, scan.objects, vibrissa.ClampPath((0.0, -0.09, 1.0), (0.0, -0.09, 2.0)), 0.05)
    untimed = samples.copy()
    untimed["t"] = np.nan
    names = [
        (scan, None, "clamp position"),
        (turning, None, "clamp angle"),
        (whisking, None, "way of the clamp in mm"),
        (whisking, "angle", "clamp angle"),
        (samples, None, "time in s"),
        (untimed, None, "clamp position"),
        (samples, "position", "clamp position"),
    ]
    for source, over, name in names:
        axes = vibrissa.plot.reactions(source, over=over)  # type: ignore[arg-type]
        assert axes[2].get_xlabel().startswith(name), (over, name)
    assert axes[2].get_xlabel().endswith("in mm (\u2190 scan)")
    with pytest.raises(ValueError, match="over is 'x0', expected \"time\""):
        vibrissa.plot.reactions(scan, over="x0")  # type: ignore[arg-type]


def test_several_legs_are_drawn_over_the_way(whisking: vibrissa.Scan) -> None:
    lines = [x for _, x, _ in lines_of(vibrissa.plot.reactions(whisking)[0])]
    assert all(np.diff(np.concatenate(lines)) >= 0.0)
    # 10 mm there and back, and two turns of 60 degrees about a pivot 8 mm away
    assert lines[-1][-1] == pytest.approx(0.02 + 2.0 * 0.008 * np.pi / 3, rel=0.01)


def test_transitions_stand_between_the_states_around_them(whisking: vibrissa.Scan) -> None:
    for one in (whisking, vibrissa.Scene.read(SCENES / "pegs.toml").sweep()):
        rows = course(one).rows
        # the phases of the rows are those of the scan: no state is on the wrong side of a transition
        assert [phase for _, _, phase in runs(rows["phase"])] == one.phases
        assert np.all(np.diff(rows["leg"]) >= 0)


def test_passes_of_a_recording_have_colours_of_their_own(scan: vibrissa.Scan, samples: npt.NDArray[np.void]) -> None:
    noise = 1e-5 * np.random.default_rng(1).standard_normal(3 * len(samples))
    three = np.concatenate([samples, samples[::-1], samples])
    three["x0"] += noise
    three["t"] = np.arange(len(three)) / 500.0
    axes = vibrissa.plot.hysteresis(three)
    assert [color for color, _, _ in lines_of(axes[0])] == OTHERS[:3]
    texts = [text.get_text() for text in figure_of(axes[0]).legends[0].get_texts()]
    assert texts == ["pass 0 \u2190", "pass 1 \u2192", "pass 2 \u2190"]
    assert_legible(axes[0])
    _, x, y = lines_of(vibrissa.plot.reactions(three)[1])[1]
    # as long as a pass, with all that can be seen of it, and few points
    assert x[-1] - x[0] == pytest.approx(len(samples) / 500.0, rel=0.02) and len(x) < 4000
    assert y.max() == samples["f0y"].max()


def test_a_reconstruction_over_time(found: vibrissa.Reconstruction) -> None:
    axes = vibrissa.plot.reactions(found)
    assert axes[2].get_xlabel() == "time in s"
    marks = [line for line in axes[0].lines if to_hex(line.get_color()) == TRANSITION]
    assert len(marks) == len(found.kinks)
    assert [color for color, _, _ in lines_of(axes[0])] == [vibrissa.plot.phase_color(label) for _, _, label in found.runs]
    assert_legible(axes[0])


def test_forces_of_a_film_over_frames_and_time() -> None:
    rod = vibrissa.Rod(0.04, diameter=1e-4, tip_diameter=3e-5, youngs_modulus=3e9)
    peg = vibrissa.CircularArc((-0.003, 0.026), 0.001, 0.0, 2.0 * math.pi)
    scan = vibrissa.sweep(rod, peg, vibrissa.ClampPath((0.0, 0.0, 1.2), (0.0, 0.0, 1.9)), 0.05)
    film = vibrissa.forces(rod, [scan.shape(i, 30)[:, :2] for i in range(len(scan))], sigma=1e-6)
    for rate, name in ((None, "frame"), (500.0, "time in ms")):
        axes = vibrissa.plot.forces(film, rate=rate)
        assert axes[2].get_xlabel() == name
        assert [ax.get_ylabel() for ax in axes] == ["force in µN", "arc length in mm", r"$\mathregular{m_{0z}}$ in nN·m"]
        assert np.nanmax(np.asarray(axes[0].lines[0].get_ydata(), dtype=float)) == film.frames["force"][film.frames["verdict"] != "free"].max()
        assert_legible(axes[0])


def test_axes_of_ones_own_have_the_style() -> None:
    with vibrissa.plot.style():
        ax = plt.figure().add_subplot()
        vibrissa.plot.object_outline(ax, [vibrissa.Composite(Hump())], (-0.1, 0.1, 0.0, 0.1))
        vibrissa.plot.elastica(vibrissa.elastica(vibrissa.Rod(0.1, 6e-4), (0.0, 0.0, 0.0)), ax)
    figure_of(ax).canvas.draw()
    assert {text.get_fontsize() for text in ax.get_xticklabels()} == {7.0}
    assert ax.xaxis.label.get_fontsize() == 8.0 and not ax.spines["top"].get_visible()


@pytest.mark.parametrize("tip", [(0.07, 0.0, 0.0), (0.07, 0.04, 0.0), (0.05, 0.02, 1.0)])
def test_the_numbers_of_equilibria_are_beside_their_own_shapes(tip: tuple[float, float, float]) -> None:
    found = vibrissa.elastica(vibrissa.Rod(0.1, 6e-4), (0.0, 0.0, 0.0), tip={"pose": tip}, branches="all")
    assert len(found) > 3
    ax = vibrissa.plot.elastica(found)
    assert_legible(ax)
    to_pixels = ax.transData.transform
    numbers = [text for text in ax.texts if text.get_text().isdigit()]
    assert [text.get_text() for text in numbers] == [str(one.branch) for one in found]
    for text in numbers:
        box = text.get_window_extent()
        middle = np.array([0.5 * (box.x0 + box.x1), 0.5 * (box.y0 + box.y1)])
        away = [np.hypot(*(to_pixels(one.points[:, 1:3]) - middle).T).min() for one in found]
        assert int(np.argmin(away)) == int(text.get_text())
    # a plate at the clamp and one at the tip
    plates = [line for line in ax.lines if isinstance(line.get_marker(), tuple)]
    places = {tuple(np.round(np.asarray(line.get_xydata(), dtype=float)[0], 9).tolist()) for line in plates}
    assert places == {(0.0, 0.0), tip[:2]}


def test_helpers_are_not_public() -> None:
    assert not {"annotations", "optional"} & {*dir(vibrissa), *dir(vibrissa.plot)}


def test_the_contour_has_a_band_of_two_deviations(scan: vibrissa.Scan, found: vibrissa.Reconstruction) -> None:
    ax = vibrissa.plot.contour(found, objects=scan.objects)
    rows = found.contour
    part = rows[rows["stretch"] == rows["stretch"][0]]
    corners = ax.patches[0].get_xy()  # type: ignore[attr-defined]
    width = np.hypot(*(corners[0] - corners[2 * len(part) - 1]))
    assert width == pytest.approx(4.0 * part["sigma"][0])
    assert len(ax.patches) == len(np.unique(rows["stretch"]))
    assert_legible(ax)


def test_the_notch_has_the_points_of_both_contacts(scan: vibrissa.Scan) -> None:
    fine = vibrissa.sweep(scan.rod, scan.objects, scan.path, 5e-5)
    found = vibrissa.reconstruct(scan.rod, fine.states)
    ax = vibrissa.plot.notches(found, objects=scan.objects)
    one, naive, first, second = ax.lines[:4]
    gap = scan.objects[0].gap
    for line, largest in [(first, 1e-6), (second, 1e-6)]:
        x, y = np.asarray(line.get_xdata()), np.asarray(line.get_ydata())
        assert len(x) > 10 and np.abs(gap(x, y)).max() < largest
    x, y = np.asarray(naive.get_xdata()), np.asarray(naive.get_ydata())
    off = np.abs(gap(x, y))
    assert np.nanmax(off) > 1e-3 and len(one.get_xdata()) > len(x)  # type: ignore[arg-type]
    assert_legible(ax)
    # its names are long for the width of a column
    (legend,) = figure_of(ax).legends
    assert legend.get_window_extent().width <= figure_of(ax).bbox.width
    with pytest.raises(ValueError, match="no point of two contacts"):
        vibrissa.plot.notches(vibrissa.reconstruct(scan.rod, fine.states[: int(np.flatnonzero(found.readings["label"] == "BB")[0])]))


def test_a_sweep_moves(scan: vibrissa.Scan, tmp_path: Path) -> None:
    animation = vibrissa.plot.animate(scan, frames=2)
    file = tmp_path / "sweep.gif"
    animation.save(file, writer="pillow", dpi=40)
    from PIL import Image

    with Image.open(file) as image:
        assert image.n_frames == 2  # type: ignore[attr-defined]
    with pytest.raises(ValueError, match="frames is 0, expected 1 or more"):
        vibrissa.plot.animate(scan, frames=0)
