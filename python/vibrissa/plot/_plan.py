"""What scans can touch, and which to make next."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from typing import Any

import numpy as np
import numpy.typing as npt
from matplotlib.axes import Axes

from ._palette import FAINT, INK, MUTED, OTHERS
from ._plane import _new_axes, _shown, _window
from ._style import CONTOUR, LINE, SHAPE

# Colours and names, those of the command's figure.
_TOUCHED = {"single": (OTHERS[0], "one contact"), "several": (OTHERS[1], "several contacts only"), "never": (OTHERS[2], "never")}
_KNOWN = {"touched": INK, "bounded": OTHERS[1], "unknown": MUTED}
# Length of the line that shows the rod, in lengths of the path, and size of a point, points.
_ROD, _POINT = 0.08, 2.0


def reach(
    lines: Sequence[tuple[str, npt.NDArray[np.float64]]], shares: Mapping[str, float], ax: Axes | None = None
) -> Axes:
    """Draws the lines of outlines, coloured by how they are touched, with the share of each kind."""
    window = _window(np.concatenate([points for _, points in lines]), [])
    is_own = ax is None
    ax = ax or _new_axes(window)
    for how, (colour, name) in _TOUCHED.items():
        label: str | None = f"{name} {100.0 * shares[how]:.1f} %"
        for points in (points for one, points in lines if one == how):
            ax.plot(points[:, 0], points[:, 1], color=colour, linewidth=2.0 * CONTOUR, label=label, solid_capstyle="butt")
            label = None
    return _shown(ax, window, is_own)


def plan(
    scans: npt.NDArray[np.void],
    hypotheses: Sequence[npt.NDArray[np.float64]],
    known: npt.NDArray[np.void],
    ax: Axes | None = None,
) -> Axes:
    """Draws what is known, hypotheses, and the paths of the clamp of some scans with the rod's direction."""
    points = np.column_stack([known["x"], known["y"]])
    ends = [np.column_stack([scans[f"x_{end}"], scans[f"y_{end}"]]) for end in ("from", "to")]
    window = _window(np.concatenate([points, *ends]), [])
    is_own = ax is None
    ax = ax or _new_axes(window)
    for number, outline in enumerate(hypotheses):
        ax.plot(outline[:, 0], outline[:, 1], color=FAINT, linewidth=SHAPE, label=None if number else "hypotheses")
    style: dict[str, Any] = {"linestyle": "none", "marker": "o", "markersize": _POINT}
    for name, colour in _KNOWN.items():
        if (chosen := known["known"] == name).any():
            ax.plot(points[chosen, 0], points[chosen, 1], color=colour, label=name, **style)
    for number, (row, start, end) in enumerate(zip(scans, *ends, strict=True)):
        tip = start + _ROD * np.hypot(*(end - start)) * np.array([np.cos(row["angle"]), np.sin(row["angle"])])
        way = np.array([tip, start, end])
        ax.plot(way[:, 0], way[:, 1], color=OTHERS[0], linewidth=LINE, label=None if number else "clamp, with the rod's direction")
        ax.annotate(str(number + 1), start, color=OTHERS[0], textcoords="offset points", xytext=(-4.0, -4.0), ha="right", va="top")
    return _shown(ax, window, is_own)
