"""Shapes and contours in the plane."""

from __future__ import annotations

import math
from collections.abc import Sequence
from typing import Any

import numpy as np
from matplotlib.axes import Axes
from matplotlib.collections import LineCollection
from matplotlib.patches import PathPatch
from matplotlib.path import Path

from .._core import Composite, Elastica, Reconstruction, Scan, single
from ._course import Array
from ._palette import FAINT, FIRST, INK, MUTED, OTHERS, SOLID, TRANSITION, phase_color
from ._style import AT_TRANSITION, COLUMN, CONTOUR, LINE, SHAPE, legend, name_axis, new_axes, small

# Room for the numbers and names of axes, and least and largest height of a figure, mm.
_BESIDE, _BELOW, _HEIGHTS = 14.0, 16.0, (45.0, 130.0)
# Dashes and gaps, in widths of the line.
_DASHED = (0, (5.0, 3.0))
# x_min, x_max, y_min, y_max, m.
Window = tuple[float, float, float, float]


def shapes(scan: Scan, ax: Axes | None = None, *, most: int = 60) -> Axes:
    """Draw the objects and the rod along a scan, coloured by phase; shapes just before transitions are dark, those after a snap dashed.

    Parameters
    ----------
    scan : Scan
        What to draw.
    ax : matplotlib.axes.Axes, optional
        Where.
    most : int, optional
        Largest number of shapes besides those at transitions.

    Returns
    -------
    matplotlib.axes.Axes
    """
    curves, window = _curves(scan, most)
    is_own = ax is None
    ax = ax or _new_axes(window)
    object_outline(ax, scan.objects, window)
    named = set()
    for curve, (name, style) in curves:
        ax.plot(curve[:, 0], curve[:, 1], label=None if name in named else name, **style)
        named.add(name)
    return _shown(ax, window, is_own)


def _curves(scan: Scan, most: int) -> tuple[list[tuple[Array, tuple[str, dict[str, Any]]]], Window]:
    """Shapes with the names and styles of their lines, and what they span with the clamp and whole small objects."""
    curves = []
    for i in range(0, len(scan), max(1, -(-len(scan) // most))):
        phase = str(scan.states["phase"][i])
        name = "free" if phase == "free" else f"phase {phase}"
        curves.append((scan.shape(i, 200), (name, {"color": phase_color(phase), "linewidth": SHAPE})))
    # a contact that passes to another piece of the same object, or slips within a phase, changes none
    events = scan.events
    for k in np.flatnonzero((events["from"] != events["to"]) | (events["kind"] == "snap")):
        event, style = scan.event(int(k)), {"color": TRANSITION, "linewidth": AT_TRANSITION}
        curves.append((event.before.shape(scan.rod, 200), ("at a transition", style)))
        if event.kind == "snap":
            curves.append((event.after.shape(scan.rod, 200), ("after a snap", {**style, "linestyle": _DASHED})))
    clamps = np.column_stack([scan.states["x0"], scan.states["y0"]])
    return curves, _window(np.concatenate([clamps, *(curve[:, :2] for curve, _ in curves)]), scan.objects)


def _window(points: Array, objects: Sequence[Composite], margin: float = 0.06) -> Window:
    """What shows all points, and all closed objects that are near them and not much larger."""
    points = points[np.isfinite(points).all(axis=1)]
    low, high = (points.min(axis=0), points.max(axis=0)) if len(points) else (np.zeros(2), np.ones(2))
    more = float((high - low).max())
    near: Window = (low[0] - more, high[0] + more, low[1] - more, high[1] + more)
    for one in objects:
        if one.is_closed:
            outline = _outline(one, near)[:, :2]
            if (outline >= low - more).all() and (outline <= high + more).all():
                low, high = np.minimum(low, outline.min(axis=0)), np.maximum(high, outline.max(axis=0))
    room = margin * float((high - low).max()) or 1e-3
    return low[0] - room, high[0] + room, low[1] - room, high[1] + room


def _new_axes(window: Window) -> Axes:
    """Axes in one column, as high as the window needs."""
    x_min, x_max, y_min, y_max = window
    height = (COLUMN - _BESIDE) * (y_max - y_min) / (x_max - x_min) + _BELOW
    return new_axes(COLUMN, min(max(height, _HEIGHTS[0]), _HEIGHTS[1]))[0]


def _shown(ax: Axes, window: Window, is_own: bool) -> Axes:
    """The axes, with a window in which a metre is as long along y as along x."""
    ax.set_xlim(window[0], window[1])
    ax.set_ylim(window[2], window[3])
    ax.set_aspect("equal")
    name_axis(ax.xaxis, "x", "{}m", [ax.yaxis])
    name_axis(ax.yaxis, "y", "{}m", [ax.xaxis])
    if is_own:
        legend(ax)
    return ax


def object_outline(ax: Axes, objects: Sequence[Composite], window: Window | None = None, **style: Any) -> None:
    """Draw the contours of objects, grey where they are solid.

    Parameters
    ----------
    ax : matplotlib.axes.Axes
        Where.
    objects : list of Composite
        The objects.
    window : tuple of float, optional
        x_min, x_max, y_min, y_max in m; what the axes show where it is not given. Farther away nothing is drawn of contours that have no end.
    **style
        For :class:`matplotlib.collections.LineCollection`. With a style there is only the line.
    """
    window = window or (*ax.get_xlim(), *ax.get_ylim())
    for one in objects:
        outline = _outline(one, window)
        if not style:
            _draw_solid(ax, one, outline, window)
        line = LineCollection([outline[:, :2]], **{"colors": INK, "linewidths": CONTOUR, "capstyle": "butt", "zorder": 2.5, **style})
        ax.add_collection(line, autolim=False)


def _draw_solid(ax: Axes, one: Composite, outline: Array, window: Window) -> None:
    """Fills a closed object; draws strokes on the left of other contours, where the solid is, slanted backwards."""
    if one.is_closed:
        x_min, x_max, y_min, y_max = window
        around = [(x_min, y_min), (x_max, y_min), (x_max, y_max), (x_min, y_max), (x_min, y_min)]
        # a cavity runs clockwise: it is a hole in what is around
        parts = [Path(outline[:, :2]), *([Path(around)] if one.is_cavity else [])]
        ax.add_artist(PathPatch(Path.make_compound_path(*parts), facecolor=SOLID, edgecolor="none", zorder=0.5))
        return
    size = 0.015 * math.hypot(window[1] - window[0], window[3] - window[2])
    way = np.concatenate([[0.0], np.cumsum(np.hypot(*np.diff(outline[:, :2], axis=0).T))])
    k = np.searchsorted(way, np.arange(0.5 * size, way[-1], size))
    # a stroke from a corner would come out on its other side
    k = k[np.abs(np.interp(way[k] + size, way, outline[:, 2]) - np.interp(way[k] - size, way, outline[:, 2])) < 0.8]
    start, angle = outline[k, :2], outline[k, 2] + 0.75 * math.pi
    strokes = np.stack([start, start + size * np.column_stack([np.cos(angle), np.sin(angle)])], axis=1)
    ax.add_collection(LineCollection(list(strokes), colors=MUTED, linewidths=SHAPE, zorder=2.4), autolim=False)


def _outline(one: Composite, window: Window) -> Array:
    """Points of a contour, x, y (m) and tangent angle (rad): near together where a window shows them and where they turn."""
    x_min, x_max, y_min, y_max = window
    size = math.hypot(x_max - x_min, y_max - y_min)
    middle = 0.5 * (x_min + x_max), 0.5 * (y_min + y_max)
    nearest = float(one.closest(*middle)["t"])
    ends = list(one.range)
    for k, step in ((0, -1e-9), (1, 1e-9)):
        if math.isinf(ends[k]):
            # it is followed until it is far away
            ends[k] = nearest
            while math.dist(one.frame(ends[k])[:2], middle) < 2.0 * size:
                ends[k] += step
                step *= 2.0
    t = np.linspace(ends[0], ends[1], max(200, 20 * one.pieces))
    x, y, alpha = one.frame(t)[:3]
    for _ in range(30):
        gaps = np.hypot(np.diff(x), np.diff(y))
        turns = np.abs(np.diff(alpha))
        away = np.maximum(0.0, np.maximum(np.maximum(x_min - x, x - x_max), np.maximum(y_min - y, y - y_max)))
        near = np.minimum(away[1:], away[:-1]) <= 2.0 * gaps
        coarse = near & (gaps > 1e-4 * size) & ((gaps > 0.02 * size) | (turns > 0.05))
        if not coarse.any() or len(t) > 200_000:
            break
        places = np.flatnonzero(coarse)
        more = 0.5 * (t[places] + t[places + 1])
        fresh = one.frame(more)[:3]
        t = np.insert(t, places + 1, more)
        x, y, alpha = (np.insert(old, places + 1, new) for old, new in zip((x, y, alpha), fresh))
    if one.is_closed:
        x, y, alpha = (np.append(values, first) for values, first in ((x, x[0]), (y, y[0]), (alpha, alpha[-1])))
    return np.column_stack([x, y, alpha])


def elastica(found: list[Elastica], ax: Axes | None = None) -> Axes:
    """Draw equilibria of a rod without contacts: stable ones as lines, unstable ones dashed.

    The number of each equilibrium stands beside its shape where this is farthest from the others. A tip whose place and angle are held has a plate across
    the rod, as the clamp has.

    Parameters
    ----------
    found : list of Elastica
        What to draw.
    ax : matplotlib.axes.Axes, optional
        Where.

    Returns
    -------
    matplotlib.axes.Axes
    """
    curves = [one.points for one in found]
    window = _window(np.concatenate([np.zeros((0, 2)), *(points[:, 1:3] for points in curves)]), (), margin=0.1)
    is_own = ax is None
    ax = ax or _new_axes(window)
    named: set[str] = set()
    for one, points in reversed(list(zip(found, curves))):
        style: dict[str, Any] = {"linewidth": LINE} if one.stable else {"linewidth": 0.8, "linestyle": _DASHED}
        name = "stable" if one.stable else "unstable"
        ax.plot(points[:, 1], points[:, 2], color=OTHERS[one.branch % len(OTHERS)], label=None if name in named else name, **style)
        named.add(name)
    held = {one.pose for one in found} | {one.tip for one in found if all(one.tip_held)}
    beside = 0.04 * max((one.rod.length for one in found), default=0.0)
    places = _number_places([points[:, 1:4] for points in curves], sorted(held), beside)
    for one, (x, y, direction) in zip(found, places):
        offset = (6.0 * math.cos(direction), 6.0 * math.sin(direction))
        text: dict[str, Any] = {"textcoords": "offset points", "ha": "center", "va": "center", "fontproperties": small(ax)}
        ax.annotate(str(one.branch), (x, y), offset, color=OTHERS[one.branch % len(OTHERS)], **text)
    for x, y, phi in held:
        # a plate across the rod
        ax.plot([x], [y], marker=(2, 2, math.degrees(phi)), markersize=9.0, markeredgewidth=1.0, color=INK)
    return _shown(ax, window, is_own and len(named) > 1)


# Points of a shape beside which its number may stand, and points of the other shapes from which the distance is measured.
_PLACES, _SHAPE_POINTS = 25, 100


def _number_places(shapes: list[Array], clamps: Sequence[tuple[float, float, float]], beside: float) -> list[tuple[float, float, float]]:
    """For each shape (rows x, y in m, phi in rad) a point on it, x and y, and the direction from there to its number.

    The number stands at about the distance ``beside`` (m) from its own shape, and as far as possible from the other shapes, the clamps and the numbers
    before it.
    """
    thinned = [shape[np.unique(np.linspace(0, len(shape) - 1, _SHAPE_POINTS).astype(int))] for shape in shapes]
    taken = np.array(clamps).reshape(-1, 3)[:, :2]
    places = []
    for k, shape in enumerate(thinned):
        # from the tip on, which is the first of places that are as good
        x, y, phi = np.repeat(shape[np.linspace(len(shape) - 1, 0, _PLACES).astype(int)], 2, axis=0).T
        direction = phi + np.tile([0.5 * math.pi, -0.5 * math.pi], _PLACES)
        number = np.column_stack([x + beside * np.cos(direction), y + beside * np.sin(direction)])
        others = np.concatenate([taken, *(other[:, :2] for j, other in enumerate(thinned) if j != k)])
        free = np.minimum(_distances(number, others), _distances(np.column_stack([x, y]), others))
        # it keeps off its own shape, too, which may come back
        best = int(np.argmax(np.round(np.where(_distances(number, shape[:, :2]) > 0.9 * beside, free, 0.5 * free), 9)))
        places.append((float(x[best]), float(y[best]), float(direction[best])))
        taken = np.append(taken, number[best : best + 1], axis=0)
    return places


def _distances(places: Array, points: Array) -> Array:
    """The distance of each place from the nearest of the points, m; infinite without points."""
    if not len(points):
        return np.full(len(places), math.inf)
    return np.asarray(np.hypot(*(places[:, None] - points).transpose(2, 0, 1)).min(axis=1))


def contour(
    found: Reconstruction, ax: Axes | None = None, *, objects: Sequence[Composite] = (), deviations: float = 2.0
) -> Axes:
    """Draw a reconstructed contour with a band of standard deviations across it.

    Grey behind it is the contour of the fit to the whole recording, dotted where the rod did not touch it.

    Parameters
    ----------
    found : Reconstruction
        What to draw.
    ax : matplotlib.axes.Axes, optional
        Where.
    objects : list of Composite, optional
        The true objects, drawn dashed.
    deviations : float, optional
        Half the width of the band in standard deviations.

    Returns
    -------
    matplotlib.axes.Axes
    """
    rows = found.contour
    window = _window(np.column_stack([rows["x"], rows["y"]]), ())
    is_own = ax is None
    ax = ax or _new_axes(window)
    named: set[str] = set()
    for stretch in np.unique(rows["stretch"]):
        part = rows[rows["stretch"] == stretch]
        color, label = _KINDS[str(part["kind"][0])]
        x, y, across = part["x"], part["y"], deviations * part["sigma"]
        # the normal into the solid is (-sin alpha, cos alpha)
        dx, dy = -np.sin(part["alpha"]) * across, np.cos(part["alpha"]) * across
        band = np.concatenate([[x - dx, y - dy], np.array([x + dx, y + dy])[:, ::-1]], axis=1)
        ax.fill(*band, color=color, alpha=0.25, linewidth=0.0)
        ax.plot(x, y, color=color, linewidth=LINE, label=None if label in named else label)
        named.add(label)
    _draw_fit(ax, found)
    _draw_truth(ax, objects, window)
    if not len(rows):
        ax.text(0.5, 0.5, "no contact points", transform=ax.transAxes, ha="center", va="center")
    return _shown(ax, window, is_own)


def _draw_truth(ax: Axes, objects: Sequence[Composite], window: Window) -> None:
    object_outline(ax, objects, window, linestyles=[_DASHED], linewidths=0.8)
    if objects:
        ax.plot([], [], color=INK, linewidth=0.8, linestyle=_DASHED, label="true contour")


# The contacts of a contour: colours and names.
_KINDS = {"single": (OTHERS[0], "one contact"), "first": (FIRST, "first of two"), "second": (OTHERS[1], "second of two")}


def _draw_fit(ax: Axes, found: Reconstruction) -> None:
    rows = found.fitted
    label: str | None = "contour of the fit"
    for number in np.unique(rows["object"]):
        part = rows[rows["object"] == number]
        points = np.column_stack([part["x"], part["y"]])
        touched = part["known"] == "touched"
        pairs, both = np.stack([points[:-1], points[1:]], axis=1), touched[:-1] & touched[1:]
        for lines, style in ((pairs[both], "solid"), (pairs[~both], "dotted")):
            drawn = LineCollection(list(lines), colors=MUTED, linewidths=0.8, linestyles=style, zorder=1.5)
            ax.add_collection(drawn, autolim=False)
        ax.plot([], [], color=MUTED, linewidth=0.8, label=label)
        label = None


def notches(
    found: Reconstruction, ax: Axes | None = None, *, objects: Sequence[Composite] = (), margin: float = 0.1
) -> Axes:
    """Draw the contact points where there are two contacts, beside those of the same samples if they had one.

    Points that are wrong by more than 0.2 of the rod's length lie outside of the figure.

    Parameters
    ----------
    found : Reconstruction
        What to draw.
    ax : matplotlib.axes.Axes, optional
        Where.
    objects : list of Composite, optional
        The true objects, drawn dashed.
    margin : float, optional
        What is drawn around the points of two contacts, in lengths of the rod.

    Returns
    -------
    matplotlib.axes.Axes

    Raises
    ------
    ValueError
        No point of two contacts was found.
    """
    rows, length = found.readings, found.rod.length
    two = np.isin(rows["label"], ["BA", "BB"])
    first, second = (two & np.isfinite(rows[name]) for name in ("x", "second_x"))
    if not (first.any() or second.any()):
        raise ValueError("the reconstruction has no point of two contacts, expected a scan over a notch")
    naive = single(found.rod, found.samples[two])
    x = np.concatenate([rows["x"][first], rows["second_x"][second]])
    y = np.concatenate([rows["y"][first], rows["second_y"][second]])
    # the naive points are of interest as far as they are near
    wrong = np.hypot(naive["x"] - np.median(x), naive["y"] - np.median(y)) < 0.2 * length + max(np.ptp(x), np.ptp(y))
    x, y = np.concatenate([x, naive["x"][wrong]]), np.concatenate([y, naive["y"][wrong]])
    around = margin * length
    window: Window = (x.min() - around, x.max() + around, y.min() - around, y.max() + around)
    is_own = ax is None
    ax = ax or _new_axes(window)
    clouds: list[tuple[Any, Any, str, dict[str, Any]]] = [
        (rows["x"][~two], rows["y"][~two], "one contact", {"color": FAINT}),
        (naive["x"], naive["y"], "naive: one contact assumed", {"markerfacecolor": "none", "color": MUTED}),
        (rows["x"][first], rows["y"][first], _KINDS["first"][1], {"color": _KINDS["first"][0]}),
        (rows["second_x"][second], rows["second_y"][second], _KINDS["second"][1], {"color": _KINDS["second"][0]}),
    ]
    for place_x, place_y, label, style in clouds:
        ax.plot(place_x, place_y, "o", markersize=2.0, markeredgewidth=0.5, label=label, **style)
    _draw_truth(ax, objects, window)
    return _shown(ax, window, is_own)
