"""Quantities along a scan: reactions, the phase criterion, forces of a film."""

from __future__ import annotations

from collections.abc import Callable, Sequence
from typing import Any, TypeAlias

import numpy as np
import numpy.typing as npt
from matplotlib.artist import Artist
from matplotlib.axes import Axes
from matplotlib.backend_bases import RendererBase
from matplotlib.text import Text
from matplotlib.transforms import Bbox

from .._core import Forces, Reconstruction, Rod, Scan
from ._course import Array, Course, Over, Rows, Source, course, runs
from ._palette import FAINT, INK, OTHERS, TRANSITION, phase_color
from ._style import COLUMN, LINE, MARK, legend, name_axis, new_axes, small

_Draw: TypeAlias = Callable[[Axes, Course, Array, Array], None]
_REACTIONS = [(name, rf"$\mathregular{{{name[0]}_{{{name[1:]}}}}}$", unit) for name, unit in (("f0x", "{}N"), ("f0y", "{}N"), ("m0z", "{}N·m"))]
# The line behind another one where a contact sticks.
_STICKS: dict[str, Any] = {"linewidth": 5.0, "alpha": 0.35, "solid_capstyle": "butt"}
# More columns of points than this cannot be told apart.
_COLUMNS = 1500


def reactions(source: Source, axes: Sequence[Axes] | None = None, *, over: Over | None = None) -> list[Axes]:
    """Draw f0x, f0y and m0z along a scan or a recording: coloured and named by phase, or by pass where phases are not known.

    Vertical lines are transitions; for a reconstruction kinks and jumps. A wide, grey line: a contact sticks or rolls.

    Parameters
    ----------
    source : Scan, Reconstruction, Recording or numpy.ndarray
        What to draw; an array has the fields of ``Recording.samples``.
    axes : sequence of three matplotlib.axes.Axes, optional
        Where.
    over : str, optional
        ``"time"``, ``"position"`` or ``"angle"`` of the clamp, or ``"way"``. Without it the time where it is recorded. Otherwise the position of the
        clamp, the angle where it mainly turns, and the way where it goes to and fro.

    Returns
    -------
    list of matplotlib.axes.Axes
    """
    found = course(source)
    axes = _stack(found, axes, over, _draw)
    _name_phases(axes[0], found.over(over)[0], found)
    return axes


def hysteresis(source: Source, axes: Sequence[Axes] | None = None) -> list[Axes]:
    """Draw f0x, f0y and m0z over position or angle of the clamp, each leg of its path, or pass of a recording, in a colour of its own.

    Where the clamp goes there and back, the area between the lines of f0x is the work that friction and snaps take. Wide, pale lines:
    a contact sticks (at the tip) or rolls (along the side). Dotted: the rod jumps.

    Parameters
    ----------
    source : Scan, Reconstruction, Recording or numpy.ndarray
        What to draw: a path with several legs, or a recording with several passes.
    axes : sequence of three matplotlib.axes.Axes, optional
        Where.

    Returns
    -------
    list of matplotlib.axes.Axes
    """
    found = course(source)
    return _stack(found, axes, found.coordinate(), _draw_passes)


def _stack(found: Course, axes: Sequence[Axes] | None, over: Over | None, draw: _Draw) -> list[Axes]:
    """Draws the three reactions."""
    along, *label = found.over(over)
    drawn = _three(axes)
    for ax, (name, text, unit) in zip(drawn, _REACTIONS):
        draw(ax, found, along, found.rows[name])
        name_axis(ax.yaxis, text, unit, numbers=6)
    _name_abscissa(drawn, *label)
    if axes is None:
        legend(drawn[0])
    return drawn


def criterion(source: Scan | Reconstruction, ax: Axes | None = None, *, over: Over | None = None) -> Axes:
    """Draw the phase criterion ``K = m0z^2 - 2 E I (f0y sin phi0 + f0x cos phi0)`` along a scan.

    Without friction it is zero while the last contact is tangential (B, BB, ...), and negative while it is at the tip.

    Parameters
    ----------
    source : Scan or Reconstruction
        What to draw, of a uniform, straight rod on a rigid clamp.
    ax : matplotlib.axes.Axes, optional
        Where.
    over : str, optional
        As in :func:`reactions`.

    Returns
    -------
    matplotlib.axes.Axes

    Raises
    ------
    ValueError
        The rod is another one, which has no such criterion.
    """
    found = course(source)
    values = phase_criterion(found.rows, source.rod)
    ax = ax or new_axes(COLUMN, 55.0)[0]
    along, *label = found.over(over)
    _draw(ax, found, along, values)
    _name_phases(ax, along, found)
    name_axis(ax.yaxis, _CRITERION, "({}N·m)²", numbers=6)
    _name_abscissa([ax], *label)
    return ax


_CRITERION = (
    r"$\mathregular{K = m_{0z}^2 - 2 EI\,(f_{0y}\,\sin\,\varphi_0}$" + "\n" + r"$\mathregular{+\ f_{0x}\,\cos\,\varphi_0)}$"
)


def phase_criterion(states: Rows, rod: Rod) -> Array:
    """The phase criterion of states or samples, in N^2 m^2.

    Parameters
    ----------
    states : numpy.ndarray
        With the fields ``phi0``, ``f0x``, ``f0y`` and ``m0z``.
    rod : Rod
        The rod, uniform and straight at rest, on a rigid clamp: other rods have no such criterion.

    Returns
    -------
    numpy.ndarray

    Raises
    ------
    ValueError
        The rod is another one.
    """
    if not rod.is_uniform:
        raise ValueError(f"rod is {rod}, expected a uniform, straight one on a rigid clamp: for others the phase criterion does not hold")
    along = states["f0y"] * np.sin(states["phi0"]) + states["f0x"] * np.cos(states["phi0"])
    found: Array = states["m0z"] ** 2 - 2.0 * rod.bending_stiffness * along
    return found


def forces(found: Forces, axes: Sequence[Axes] | None = None, *, rate: float | None = None) -> list[Axes]:
    """Draw force and arc length of the contact next to the base, and the moment at the base, over the frames of a film.

    Bars are standard deviations. Frames without contacts of their own are left out: those whose verdict is "family", "not explained" or "fault".

    Parameters
    ----------
    found : Forces
        What to draw.
    axes : sequence of three matplotlib.axes.Axes, optional
        Where.
    rate : float, optional
        Frames per second, to draw over time.

    Returns
    -------
    list of matplotlib.axes.Axes
    """
    axes = _three(axes)
    rows = found.frames[~np.isin(found.frames["verdict"], ["family", "not explained", "fault"])]
    at = rows["frame"] / (rate or 1.0)
    for ax, (name, text, unit) in zip(axes, [("force", "force", "{}N"), ("s", "arc length", "{}m"), _REACTIONS[2]]):
        values, sigma = rows[name], rows[f"sigma_{name}"]
        if name != "m0z":
            values = np.where(rows["verdict"] == "free", np.nan, values)
        ax.errorbar(at, values, np.where(np.isfinite(sigma), sigma, 0.0), fmt="none", ecolor=FAINT, elinewidth=LINE)
        # frames that do not follow each other are not connected
        for part in np.split(np.arange(len(rows)), np.flatnonzero(np.diff(rows["frame"]) > 1) + 1):
            ax.plot(at[part], values[part], color=OTHERS[0], linewidth=0.8, marker=".", markersize=2.5)
        ax.axhline(0.0, color=FAINT, linewidth=MARK, zorder=0)
        name_axis(ax.yaxis, text, unit, numbers=6)
    _name_abscissa(axes, *(("time", "{}s") if rate else ("frame", "")))
    return axes


def _three(axes: Sequence[Axes] | None) -> list[Axes]:
    """The axes that are given, or new ones, for f0x, f0y and m0z."""
    axes = new_axes(COLUMN, 95.0, rows=3) if axes is None else list(axes)
    if len(axes) != 3:
        raise ValueError(f"there are {len(axes)} axes, expected three: for f0x, f0y and m0z")
    return axes


def _name_abscissa(axes: Sequence[Axes], name: str, unit: str) -> None:
    for ax in axes:
        name_axis(ax.xaxis, name if ax is axes[-1] else "", unit)
    figure = axes[0].get_figure(root=True)
    if figure is not None and len(axes) > 1:
        figure.align_ylabels(axes)


def _draw(ax: Axes, found: Course, along: Array, values: Array) -> None:
    """A quantity, coloured by phase, with the marks."""
    if not (found.rows["phase"] != "").any():
        _draw_passes(ax, found, along, values)
        return
    for a, b, _ in (run for run in runs(found.rows["sticks"]) if run[2]):
        ax.plot(along[a:b], values[a:b], color="#7a7a7a", **_STICKS)
    for a, b, phase in runs(found.rows["phase"]):
        ax.plot(*_thinned(along[a:b], values[a:b]), color=phase_color(phase), linewidth=LINE, solid_capstyle="butt")
    for place in along[found.marks]:
        ax.axvline(place, color=TRANSITION, linewidth=MARK, zorder=0.9)
    for place in along[np.flatnonzero(np.diff(found.rows["leg"]))]:
        ax.axvline(place, color=FAINT, linewidth=2 * MARK, zorder=0.8)
    ax.axhline(0.0, color=FAINT, linewidth=MARK, zorder=0)


def _draw_passes(ax: Axes, found: Course, along: Array, values: Array) -> None:
    """A quantity, coloured by leg or pass, from the last row of the one before on."""
    rows = found.rows
    numbers = runs(rows["leg"])
    goes_one_way = bool((np.diff(along) >= 0.0).all())
    for a, b, number in numbers:
        color = OTHERS[number % len(OTHERS)]
        a = max(a - 1, 0)
        way = 0.0 if goes_one_way else along[b - 1] - along[a]
        sense = " \u2192" if way > 0.0 else " \u2190" if way < 0.0 else ""
        label = f"{found.part} {number}{sense}" if len(numbers) > 1 else None
        # a line is broken before the first row after a jump
        starts = [a, *(a + 1 + np.flatnonzero(rows["jumped"][a + 1 : b])).tolist(), b]
        for first, last in zip(starts, starts[1:]):
            ax.plot(*_thinned(along[first:last], values[first:last]), color=color, linewidth=LINE, label=None if first > a else label)
            if first > a:
                ax.plot(along[first - 1 : first + 1], values[first - 1 : first + 1], color=color, linewidth=0.8, linestyle="dotted")
        for first, last, _ in (run for run in runs(rows["sticks"][a:b]) if run[2]):
            ax.plot(along[a + first : a + last], values[a + first : a + last], color=color, **_STICKS)
    if rows["sticks"].any():
        ax.plot([], [], color="#7a7a7a", label="a contact sticks or rolls", **_STICKS)
    ax.axhline(0.0, color=FAINT, linewidth=MARK, zorder=0)


def _thinned(along: Array, values: Array) -> tuple[Array, Array]:
    """The least and the largest value of each of many columns, in order, where there are more rows than can be seen."""
    each = len(along) // _COLUMNS
    if each < 4:
        return along, values
    columns = values[: len(values) // each * each].reshape(-1, each)
    first = np.arange(len(columns)) * each
    kept = np.unique(np.concatenate([[0, len(along) - 1], first + columns.argmin(axis=1), first + columns.argmax(axis=1)]))
    return along[kept], values[kept]


class _PhaseNames(Artist):
    """Names of phases above axes; where two would overlap, the second is in a row above, and where that is full, it is left out."""

    def __init__(self, ax: Axes, names: list[tuple[float, float, str]]) -> None:
        super().__init__()
        self.names, self.font, self.on = names, small(ax), ax
        self.set_clip_on(False)

    def placed(self, renderer: RendererBase) -> list[Text]:
        box, size = self.on.bbox, self.font.get_size_in_points() * float(renderer.points_to_pixels(1.0))  # type: ignore[arg-type]
        ends, texts = [-np.inf, -np.inf], []
        for first, last, name in self.names:
            ends_in_view = np.clip(self.on.transData.transform([(first, 0.0), (last, 0.0)])[:, 0], box.x0, box.x1)
            text = Text(float(ends_in_view.mean()), 0.0, name, color=INK, ha="center", fontproperties=self.font)
            text.set_figure(self.on.figure)
            extent = text.get_window_extent(renderer)
            row = next((row for row in (0, 1) if extent.x0 > ends[row]), None)
            if row is not None:
                ends[row] = extent.x1 + 0.8 * size  # nearer, two names read as one
                text.set_y(box.y1 + (0.4 + 1.2 * row) * size)
                texts.append(text)
        return texts

    def get_window_extent(self, renderer: RendererBase | None = None) -> Bbox:
        # both rows are kept free, so that the axes do not change with what fits
        size, box = self.font.get_size_in_points() / 72.0 * self.on.figure.dpi, self.on.bbox
        return Bbox([[box.x0, box.y1], [box.x1, box.y1 + 2.6 * size]])

    def draw(self, renderer: RendererBase) -> None:
        for text in self.placed(renderer):
            text.draw(renderer)


def _name_phases(ax: Axes, along: npt.NDArray[np.float64], found: Course) -> None:
    """Names the phases above axes, from left to right."""
    named = [(float(along[a]), float(along[b - 1]), phase) for a, b, phase in runs(found.rows["phase"]) if phase]
    if named:
        ax.add_artist(_PhaseNames(ax, sorted(named, key=lambda name: name[0] + name[1])))
