"""Figures on Matplotlib, with the colours of the command's figures.

Each function draws into axes that are given, or makes a figure, and returns the axes. Lengths are in mm, moments in N mm.
Matplotlib is an optional dependency: ``pip install vibrissa[plot]``.
"""

from __future__ import annotations

import math
from typing import TYPE_CHECKING, Any

import numpy as np
import numpy.typing as npt

from ._core import Composite, Elastica, Reconstruction, Rod, Scan, single
from ._tables import optional

if TYPE_CHECKING:
    from matplotlib.animation import FuncAnimation
    from matplotlib.axes import Axes

__all__ = [
    "animate",
    "contour",
    "criterion",
    "elastica",
    "hysteresis",
    "notches",
    "object_outline",
    "phase_color",
    "phase_criterion",
    "reactions",
    "shapes",
    "sweep",
]

_FREE = "#969696"
# Okabe and Ito (2008), as in the figures of the command: the number of contacts, and whether the last one is at the tip.
_COLORS = {
    (1, True): "#009e73",
    (1, False): "#0072b2",
    (2, True): "#e69f00",
    (2, False): "#d55e00",
    (3, True): "#cc79a7",
    (3, False): "#56b4e9",
}
_TRANSITION = "#332288"
# Of the legs of a path, in turn.
_LEGS = ["#0072b2", "#d55e00", "#009e73", "#cc79a7"]
_QUANTITIES = [("f0x", 1.0, "$f_{0x}$ in N"), ("f0y", 1.0, "$f_{0y}$ in N"), ("m0z", 1e3, "$m_{0z}$ in N mm")]
_KINDS = {"single": "#0072b2", "first": "#882255", "second": "#999933"}

_Rows = npt.NDArray[np.void]


def phase_color(phase: str) -> str:
    """The colour of a phase; those of more than three contacts share colours.

    Parameters
    ----------
    phase : str
        Such as ``"free"``, ``"A"`` or ``"BBA"``.

    Returns
    -------
    str
        ``#rrggbb``.
    """
    return _FREE if phase == "free" else _COLORS[min(len(phase), 3), phase.endswith("A")]


def _pyplot() -> Any:
    return optional("matplotlib.pyplot")


def _axes(ax: Axes | None) -> Axes:
    if ax is not None:
        return ax
    plt = _pyplot()

    made: Axes = plt.figure(layout="constrained").add_subplot()
    return made


def _runs(phases: npt.NDArray[Any]) -> list[tuple[int, int, str]]:
    """Neighbouring rows with one phase: first, last + 1, phase."""
    starts = [0, *(np.flatnonzero(phases[1:] != phases[:-1]) + 1).tolist()] if len(phases) else []
    return [(a, b, str(phases[a])) for a, b in zip(starts, [*starts[1:], len(phases)])]


def _way(rows: _Rows, length: float) -> tuple[npt.NDArray[np.float64], str]:
    """What changes most of the pose of the clamp, and its label; of several legs, the way so far."""
    if len(rows) and "leg" in (rows.dtype.names or ()) and rows["leg"].max() > 0:
        x, y, phi = (np.diff(rows[name], prepend=rows[name][0]) for name in ("x0", "y0", "phi0"))
        moved = np.hypot(x, y)
        return 1e3 * np.cumsum(np.where(moved > 0.0, moved, length * np.abs(phi))), "way of the clamp in mm"
    name, factor, label = _coordinate(rows, length)
    return factor * rows[name], label


def _coordinate(rows: _Rows, length: float) -> tuple[str, float, str]:
    """The coordinate of the clamp that changes most, the factor for its unit in figures, and its label."""
    spans = {"x0": np.ptp(rows["x0"]), "y0": np.ptp(rows["y0"]), "phi0": length * np.ptp(rows["phi0"])}
    name = max(spans, key=lambda name: float(spans[name]))
    if name == "phi0":
        return name, math.degrees(1.0), r"$\varphi_0$ in degrees"
    return name, 1e3, f"${name[0]}_0$ in mm"


def object_outline(
    ax: Axes, objects: list[Composite], window: tuple[float, float, float, float], *, points: int = 300, **style: Any
) -> None:
    """Draw the contours of objects in a window.

    Parameters
    ----------
    ax : matplotlib.axes.Axes
        Where.
    objects : list of Composite
        The objects.
    window : tuple of float
        x_min, x_max, y_min, y_max in m.
    points : int, optional
        Points along each side of a grid. The line along which the gap vanishes is interpolated between them, so that a corner is
        cut by up to the distance of two points.
    **style
        For :meth:`matplotlib.axes.Axes.contour`.
    """
    x_min, x_max, y_min, y_max = window
    x, y = np.meshgrid(np.linspace(x_min, x_max, points), np.linspace(y_min, y_max, points))
    for one in objects:
        # a shape in Python takes 100 times as long
        gap = one.gap(x, y) if one.is_proven else _gap_near_zero(one, x, y)
        ax.contour(1e3 * x, 1e3 * y, gap, levels=[0.0], **{"colors": "black", "linewidths": 1.2, **style})


# Points of a grid along each side of a block.
_BLOCK = 10


def _gap_near_zero(one: Composite, x: npt.NDArray[np.float64], y: npt.NDArray[np.float64]) -> npt.NDArray[np.float64]:
    """The gap at the points of a grid where it may vanish nearby; elsewhere that of a point of the same block, with the same sign.

    A gap is a distance: it changes by no more than the way between two points.
    """
    rows, columns = (np.minimum(np.arange(n) // _BLOCK * _BLOCK + _BLOCK // 2, n - 1) for n in x.shape)
    chosen = np.ix_(np.unique(rows), np.unique(columns))
    numbers = np.ix_(np.unique(rows, return_inverse=True)[1], np.unique(columns, return_inverse=True)[1])
    gap: npt.NDArray[np.float64] = one.gap(x[chosen], y[chosen])[numbers]
    # of the farthest point of a block, and one point more, since the line lies between points
    reach = (_BLOCK + 1) * np.hypot(x[0, 1] - x[0, 0], y[1, 0] - y[0, 0])
    near = np.abs(gap) <= reach
    gap[near] = one.gap(x[near], y[near])
    return gap


def shapes(scan: Scan, ax: Axes | None = None, *, most: int = 60) -> Axes:
    """Draw the objects and the rod along a scan, coloured by phase; shapes just before transitions are dark.

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
    ax = _axes(ax)
    seen = []
    for i in range(0, len(scan), max(1, -(-len(scan) // most))):
        shape = scan.shape(i, 200)
        seen.append(shape)
        ax.plot(1e3 * shape[:, 0], 1e3 * shape[:, 1], color=phase_color(scan.states["phase"][i]), linewidth=0.7)
    # a contact that passes to another piece of the same object changes no phase
    for k in np.flatnonzero(scan.events["kind"] != "piece"):
        shape = scan.event(int(k)).before.shape(scan.rod, 200)
        seen.append(shape)
        ax.plot(1e3 * shape[:, 0], 1e3 * shape[:, 1], color=_TRANSITION, linewidth=1.2)
    if seen:
        points = np.concatenate(seen)
        margin = 0.05 * scan.rod.length
        low, high = points[:, :2].min(axis=0) - margin, points[:, :2].max(axis=0) + margin
        object_outline(ax, scan.objects, (low[0], high[0], low[1], high[1]))
    ax.set_aspect("equal")
    ax.set_xlabel("x in mm")
    ax.set_ylabel("y in mm")
    return ax


def reactions(scan: Scan, axes: npt.NDArray[Any] | list[Axes] | None = None) -> list[Axes]:
    """Draw f0x, f0y and m0z along a scan, coloured and named by phase.

    Parameters
    ----------
    scan : Scan
        What to draw.
    axes : sequence of three matplotlib.axes.Axes, optional
        Where.

    Returns
    -------
    list of matplotlib.axes.Axes
    """
    axes = _three(axes)
    along, label = _way(scan.states, scan.rod.length)
    for ax, (name, factor, text) in zip(axes, _QUANTITIES):
        _by_phase(ax, along, factor * scan.states[name], scan.states["phase"])
        ax.set_ylabel(text)
    _name_phases(axes[0], along, scan.states["phase"])
    axes[-1].set_xlabel(label)
    return axes


def _three(axes: npt.NDArray[Any] | list[Axes] | None) -> list[Axes]:
    """The axes that are given, or new ones, for f0x, f0y and m0z."""
    if axes is None:
        plt = _pyplot()

        axes = plt.subplots(3, 1, sharex=True, layout="constrained", figsize=(6.0, 6.0))[1]
    axes = list(axes)
    if len(axes) != 3:
        raise ValueError(f"there are {len(axes)} axes, expected three: for f0x, f0y and m0z")
    return axes


def hysteresis(scan: Scan, axes: npt.NDArray[Any] | list[Axes] | None = None) -> list[Axes]:
    """Draw f0x, f0y and m0z over the position of the clamp, each leg of its path in a colour of its own.

    Where the clamp goes there and back, the area between the lines of f0x is the work that friction and snaps take. Wide, pale lines:
    a contact sticks (at the tip) or rolls (along the side). Dotted: the rod jumps.

    Parameters
    ----------
    scan : Scan
        What to draw, of a path with two or more legs.
    axes : sequence of three matplotlib.axes.Axes, optional
        Where.

    Returns
    -------
    list of matplotlib.axes.Axes
    """
    axes = _three(axes)
    coordinate, unit, label = _coordinate(scan.states, scan.rod.length)
    legs = _legs(scan, coordinate)
    for ax, (name, factor, text) in zip(axes, _QUANTITIES):
        for number, rows in legs:
            color = _LEGS[number % len(_LEGS)]
            arrow = "\u2192" if rows[coordinate][-1] > rows[coordinate][0] else "\u2190"
            x, y = unit * rows[coordinate], factor * rows[name]
            # a line is broken before the first row after a jump
            starts = [0, *np.flatnonzero(rows["jumped"]).tolist(), len(rows)]
            for k, (a, b) in enumerate(zip(starts[:-1], starts[1:])):
                ax.plot(x[a:b], y[a:b], color=color, linewidth=1.2, label=None if k else f"leg {number} {arrow}")
                if a > 0:
                    ax.plot(x[a - 1 : a + 1], y[a - 1 : a + 1], color=color, linewidth=0.8, linestyle="dotted")
            for a, b, sticks in _runs(rows["sticks"].astype(str)):
                if sticks == "True":
                    ax.plot(x[a:b], y[a:b], color=color, linewidth=6.0, alpha=0.35, solid_capstyle="butt", marker=None)
        ax.axhline(0.0, color="#cdcdcd", linewidth=0.6, zorder=0)
        ax.set_ylabel(text)
    if any(rows["sticks"].any() for _, rows in legs):
        axes[0].plot([], [], color="#7a7a7a", linewidth=6.0, alpha=0.35, label="a contact sticks or rolls")
    axes[0].legend(frameon=False, loc="lower left", bbox_to_anchor=(0.0, 1.0), ncols=3, borderaxespad=0.2)
    axes[-1].set_xlabel(label)
    return axes


def _legs(scan: Scan, coordinate: str) -> list[tuple[int, _Rows]]:
    """The states of each leg with those at its transitions, from the last state of the leg before on, in order.

    ``sticks``: a contact does; ``jumped``: the rod has, just before.
    """
    names = [coordinate, "f0x", "f0y", "m0z"]
    columns = [*((name, float) for name in names), ("leg", int), ("sticks", bool), ("jumped", bool)]

    def rows(count: int) -> _Rows:
        return np.zeros(count, dtype=columns)

    states = rows(len(scan))
    for name in (*names, "leg"):
        states[name] = scan.states[name]
    contacts = scan.contacts
    states["sticks"][contacts.parents()[contacts.values["mode"] == "stick"]] = True
    before, after = rows(len(scan.events)), rows(len(scan.events))
    for name in names:
        before[name], after[name] = scan.events[name], scan.events[f"{name}_after"]
    after["jumped"] = np.isin(scan.events["kind"], ["snap", "snap-off", "slip-over"])
    for k in range(len(scan.events)):
        event = scan.event(k)
        for row, state in ((before, event.before), (after, event.after)):
            row["sticks"][k] = any(contact.mode == "stick" for contact in state.contacts)
            row["leg"][k] = scan.events["leg"][k]
    made, last = [], rows(0)
    for number in np.unique(states["leg"]).tolist():
        reported = states[states["leg"] == number]
        on_way = np.diff(np.concatenate([last, reported])[coordinate])
        own = scan.events["leg"] == number
        moments = np.stack([before[own], after[own]], axis=1).ravel()
        if np.all(on_way > 0.0) or np.all(on_way < 0.0):
            # a pose of the leg tells when it is; transitions come before a state at their pose
            sense = math.copysign(1.0, on_way[0]) if len(on_way) else 1.0
            both = np.concatenate([moments, reported])
            both = both[np.argsort(sense * both[coordinate], kind="stable")]
        else:
            both = reported
        # where the path turns, the modes of the contacts are chosen anew
        last["sticks"] = both["sticks"][:1]
        made.append((int(number), np.concatenate([last, both])))
        last = both[-1:].copy()
        last["jumped"] = False
    return made


def _by_phase(
    ax: Axes, along: npt.NDArray[np.float64], values: npt.NDArray[np.float64], phases: npt.NDArray[Any]
) -> None:
    for a, b, phase in _runs(phases):
        marker = "." if b - a == 1 else None
        ax.plot(along[a:b], values[a:b], color=phase_color(phase), linewidth=1.4, marker=marker)
        if a > 0:
            ax.axvline(0.5 * (along[a - 1] + along[a]), color="#cdcdcd", linewidth=0.6, zorder=0)


def _name_phases(ax: Axes, along: npt.NDArray[np.float64], phases: npt.NDArray[Any]) -> None:
    from matplotlib.transforms import blended_transform_factory

    place = blended_transform_factory(ax.transData, ax.transAxes)
    letter = 0.03 * float(np.ptp(along)) if len(along) else 0.0
    ends = -np.inf
    for a, b, phase in sorted(_runs(phases), key=lambda run: float(along[run[0]] + along[run[1] - 1])):
        middle, half = 0.5 * float(along[a] + along[b - 1]), 0.5 * letter * len(phase)
        # a name that would lie on its neighbour is left out; the colour tells the phase
        if middle - half > ends:
            ax.text(middle, 1.03, phase, transform=place, ha="center", color=phase_color(phase), fontsize="small")
            ends = middle + half


def criterion(scan: Scan, ax: Axes | None = None) -> Axes:
    """Draw the phase criterion ``K = m0z^2 - 2 E I (f0y sin phi0 + f0x cos phi0)`` along a scan.

    It is zero while the last contact is tangential (B, BB, ...), and negative while it is at the tip.

    Parameters
    ----------
    scan : Scan
        What to draw.
    ax : matplotlib.axes.Axes, optional
        Where.

    Returns
    -------
    matplotlib.axes.Axes
    """
    ax = _axes(ax)
    states = scan.states
    along, label = _way(states, scan.rod.length)
    _by_phase(ax, along, 1e6 * phase_criterion(states, scan.rod), states["phase"])
    _name_phases(ax, along, states["phase"])
    ax.axhline(0.0, color="black", linewidth=0.6, zorder=0)
    ax.set_xlabel(label)
    ax.set_ylabel("K in (N mm)²")
    return ax


# Of equilibria without contacts, in turn: none of these is that of a phase.
_BRANCHES = ["#332288", "#999933", "#882255"]


def elastica(found: list[Elastica], ax: Axes | None = None) -> Axes:
    """Draw equilibria of a rod without contacts: stable ones as lines, unstable ones dashed, each with its number at the tip.

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
    ax = _axes(ax)
    tips = np.array([one.tip[:2] for one in found])
    held = len(found) > 1 and bool(np.ptp(tips, axis=0).max() < 1e-9 * found[0].rod.length)
    for one in reversed(found):
        points = one.points
        color = _BRANCHES[one.branch % len(_BRANCHES)]
        line, width = ("solid", 2.0) if one.stable else ("dashed", 1.2)
        ax.plot(1e3 * points[:, 1], 1e3 * points[:, 2], color=color, linestyle=line, linewidth=width)
        # all tips that are held are at one place
        x, y, phi = points[len(points) // 2, 1:4] if held else one.tip
        side = math.pi / 2 if held else 0.0
        beside = (8.0 * math.cos(phi + side), 8.0 * math.sin(phi + side))
        ax.annotate(
            str(one.branch),
            (1e3 * x, 1e3 * y),
            beside,
            textcoords="offset points",
            ha="center",
            va="center",
            color=color,
            fontsize="small",
        )
    ax.set_aspect("equal")
    ax.set_xlabel("x in mm")
    ax.set_ylabel("y in mm")
    return ax


def phase_criterion(states: _Rows, rod: Rod) -> npt.NDArray[np.float64]:
    """The phase criterion of states or samples, in N^2 m^2.

    Parameters
    ----------
    states : numpy.ndarray
        With the fields ``phi0``, ``f0x``, ``f0y`` and ``m0z``.
    rod : Rod
        The rod, uniform and straight at rest: other rods have no such criterion.

    Returns
    -------
    numpy.ndarray

    Raises
    ------
    ValueError
        The rod is another one.
    """
    if not rod.is_uniform:
        raise ValueError(f"rod is {rod}, expected a uniform, straight one: for others the phase criterion does not hold")
    along = states["f0y"] * np.sin(states["phi0"]) + states["f0x"] * np.cos(states["phi0"])
    found: npt.NDArray[np.float64] = states["m0z"] ** 2 - 2.0 * rod.bending_stiffness * along
    return found


def _beside_each_other() -> list[Axes]:
    """Axes for shapes on the left, and three for the reactions on the right."""
    plt = _pyplot()

    figure = plt.figure(figsize=(10.0, 5.5), layout="constrained")
    grid = figure.add_gridspec(3, 2, width_ratios=[1.3, 1.0])
    left = figure.add_subplot(grid[:, 0])
    top = figure.add_subplot(grid[0, 1])
    right = [top, *(figure.add_subplot(grid[row, 1], sharex=top) for row in (1, 2))]
    for ax in right[:2]:
        ax.tick_params(labelbottom=False)
    return [left, *right]


def sweep(scan: Scan) -> list[Axes]:
    """The figure of a sweep: shapes on the left, reactions on the right.

    Parameters
    ----------
    scan : Scan
        What to draw.

    Returns
    -------
    list of matplotlib.axes.Axes
        That of the shapes, and those of f0x, f0y and m0z. ``axes[0].figure.savefig(file)`` writes the figure.
    """
    left, *right = _beside_each_other()
    shapes(scan, left)
    reactions(scan, right)
    return [left, *right]


def contour(
    found: Reconstruction, ax: Axes | None = None, *, objects: list[Composite] | None = None, deviations: float = 2.0
) -> Axes:
    """Draw a reconstructed contour with a band of standard deviations across it.

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
    ax = _axes(ax)
    rows = found.contour
    named: set[str] = set()
    for stretch in np.unique(rows["stretch"]):
        part = rows[rows["stretch"] == stretch]
        kind = str(part["kind"][0])
        x, y = 1e3 * part["x"], 1e3 * part["y"]
        across = 1e3 * deviations * part["sigma"]
        # the normal into the solid is (-sin alpha, cos alpha)
        dx, dy = -np.sin(part["alpha"]) * across, np.cos(part["alpha"]) * across
        band = np.concatenate([[x - dx, y - dy], np.array([x + dx, y + dy])[:, ::-1]], axis=1)
        ax.fill(*band, color=_KINDS[kind], alpha=0.25, linewidth=0.0)
        label = {"single": "one contact", "first": "first of two", "second": "second of two"}[kind]
        ax.plot(x, y, color=_KINDS[kind], linewidth=1.4, label=None if kind in named else label)
        named.add(kind)
    if objects and len(rows):
        margin = 0.1 * max(np.ptp(rows["x"]), np.ptp(rows["y"]))
        low = rows["x"].min() - margin, rows["y"].min() - margin
        high = rows["x"].max() + margin, rows["y"].max() + margin
        object_outline(ax, objects, (low[0], high[0], low[1], high[1]), linestyles="dashed", linewidths=1.0)
    if not len(rows):
        ax.text(0.5, 0.5, "no contact points", transform=ax.transAxes, ha="center", va="center")
    if named:
        ax.legend(frameon=False, loc="lower left", bbox_to_anchor=(0.0, 1.0), ncols=len(named), borderaxespad=0.2)
    ax.set_aspect("equal")
    ax.set_xlabel("x in mm")
    ax.set_ylabel("y in mm")
    return ax


def notches(
    found: Reconstruction, ax: Axes | None = None, *, objects: list[Composite] | None = None, margin: float = 0.1
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
        The true objects.
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
    ax = _axes(ax)
    naive = single(found.rod, found.samples[two])
    x = np.concatenate([rows["x"][first], rows["second_x"][second]])
    y = np.concatenate([rows["y"][first], rows["second_y"][second]])
    # the naive points are of interest as far as they are near
    wrong = np.hypot(naive["x"] - np.median(x), naive["y"] - np.median(y)) < 0.2 * length + max(np.ptp(x), np.ptp(y))
    x, y = np.concatenate([x, naive["x"][wrong]]), np.concatenate([y, naive["y"][wrong]])
    around = margin * length
    window = x.min() - around, x.max() + around, y.min() - around, y.max() + around
    if objects:
        object_outline(ax, objects, window, linewidths=0.8)
    clouds: list[tuple[Any, Any, str, dict[str, Any]]] = [
        (rows["x"][~two], rows["y"][~two], "one contact", {"color": "#bdbdbd"}),
        (naive["x"], naive["y"], "two contacts, taken for one", {"markerfacecolor": "none", "color": "#7a7a7a"}),
        (rows["x"][first], rows["y"][first], "first of two", {"color": _KINDS["first"]}),
        (rows["second_x"][second], rows["second_y"][second], "second of two", {"color": _KINDS["second"]}),
    ]
    for place_x, place_y, label, style in clouds:
        ax.plot(1e3 * place_x, 1e3 * place_y, "o", markersize=3.0, markeredgewidth=0.6, label=label, **style)
    ax.set_xlim(1e3 * window[0], 1e3 * window[1])
    ax.set_ylim(1e3 * window[2], 1e3 * window[3])
    ax.set_aspect("equal")
    ax.legend(frameon=False, loc="lower left", bbox_to_anchor=(0.0, 1.0), ncols=2, borderaxespad=0.2)
    ax.set_xlabel("x in mm")
    ax.set_ylabel("y in mm")
    return ax


def animate(scan: Scan, *, frames: int = 120, interval: float = 50.0) -> FuncAnimation:
    """A moving figure of a sweep: the rod at its objects on the left, the reactions up to now on the right.

    Parameters
    ----------
    scan : Scan
        What to draw.
    frames : int, optional
        Largest number of frames, equally far apart in the states of the scan; the last one is its last state.
    interval : float, optional
        Time of a frame in ms.

    Returns
    -------
    matplotlib.animation.FuncAnimation
        ``animation.save("sweep.gif", writer="pillow")`` writes it; ``.mp4`` needs ffmpeg. In a notebook,
        ``IPython.display.HTML(animation.to_jshtml())`` shows it.

    Raises
    ------
    ValueError
        The scan has no states, or ``frames`` is less than 1.
    """
    from matplotlib.animation import FuncAnimation

    if not len(scan):
        raise ValueError("the scan has 0 states, expected one or more")
    if frames < 1:
        raise ValueError(f"frames is {frames}, expected 1 or more")
    left, *right = _beside_each_other()
    chosen = np.unique(np.linspace(len(scan) - 1, 0, min(frames, len(scan))).round().astype(int))
    # the axes are those of the whole scan, which then fades
    shapes(scan, left)
    reactions(scan, right)
    for line in [line for ax in (left, *right) for line in ax.lines]:
        line.set_alpha(0.15)
    along, _ = _way(scan.states, scan.rod.length)
    values = [scan.states["f0x"], scan.states["f0y"], 1e3 * scan.states["m0z"]]
    (rod,) = left.plot([], [], linewidth=2.0)
    (touches,) = left.plot([], [], "o", color="black", markersize=4.0)
    dots = [ax.plot([], [], "o", markersize=5.0)[0] for ax in right]
    title = left.set_title(" ")

    def draw(i: int) -> list[Any]:
        state = scan.state(int(i))
        color = phase_color(state.phase)
        shape = 1e3 * scan.shape(int(i), 200)
        rod.set_data(shape[:, 0], shape[:, 1])
        rod.set_color(color)
        touches.set_data([1e3 * one.x for one in state.contacts], [1e3 * one.y for one in state.contacts])
        for dot, value in zip(dots, values):
            dot.set_data([along[i]], [value[i]])
            dot.set_color(color)
        title.set_text(state.phase)
        return [rod, touches, *dots, title]

    return FuncAnimation(left.get_figure(root=True), draw, frames=chosen, interval=interval)  # type: ignore[arg-type]
