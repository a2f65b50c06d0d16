"""The style of figures: fonts, sizes, and units with prefixes."""

from __future__ import annotations

import math
from collections.abc import Sequence
from contextlib import AbstractContextManager
from typing import Any

import matplotlib as mpl
import numpy as np
from matplotlib import pyplot as plt
from matplotlib.axes import Axes
from matplotlib.axis import Axis
from matplotlib.figure import Figure
from matplotlib.font_manager import FontProperties, fontManager
from matplotlib.layout_engine import ConstrainedLayoutEngine
from matplotlib.ticker import Formatter, MaxNLocator

# Widths of a figure in a journal with two columns, mm.
COLUMN, PAGE = 85.0, 175.0
# Widths of lines, points: a quantity, a shape of the rod, one at a transition, a contour, a mark.
LINE, SHAPE, AT_TRANSITION, CONTOUR, MARK = 1.3, 0.5, 0.9, 1.5, 0.4

_PREFIXES = {-12: "p", -9: "n", -6: "µ", -3: "m", 0: "", 3: "k", 6: "M"}


def style() -> AbstractContextManager[None]:
    """The style of the figures, for axes of your own: ``with vibrissa.plot.style(): ...``.

    Letters of 7 and 8 pt, in Arial or a font like it.

    Returns
    -------
    contextlib.AbstractContextManager
        Within it Matplotlib has these settings.
    """
    installed = {font.name for font in fontManager.ttflist}
    like_arial = [name for name in ("Arial", "Helvetica", "Liberation Sans") if name in installed]
    style: dict[Any, Any] = {
        "font.family": [*like_arial[:1], "DejaVu Sans"],
        "font.size": 8.0,
        "axes.labelsize": 8.0,
        "axes.titlesize": 8.0,
        "legend.fontsize": 7.0,
        "legend.frameon": False,
        "axes.linewidth": 0.6,
        "axes.labelpad": 2.5,
        "axes.spines.top": False,
        "axes.spines.right": False,
        "figure.dpi": 200.0,
        "pdf.fonttype": 42,
    }
    for axis in ("xtick", "ytick"):
        style |= {f"{axis}.labelsize": 7.0, f"{axis}.major.width": 0.6, f"{axis}.major.size": 2.5, f"{axis}.major.pad": 2.0}
    return mpl.rc_context(style)


def new_axes(width: float, height: float, rows: int = 1) -> list[Axes]:
    """Axes above each other with one abscissa, in a figure of this size in mm."""
    with style():
        return list(new_figure(width, height).subplots(rows, 1, sharex=True, squeeze=False)[:, 0])


def new_figure(width: float, height: float) -> Figure:
    """A figure of this size in mm."""
    layout = ConstrainedLayoutEngine(w_pad=0.03, h_pad=0.03, hspace=0.0, wspace=0.04)
    return plt.figure(figsize=(width / 25.4, height / 25.4), layout=layout)


def small(ax: Axes) -> FontProperties:
    """The font of the names of axes, somewhat smaller."""
    font = ax.xaxis.label.get_fontproperties().copy()
    font.set_size(0.875 * font.get_size_in_points())
    return font


def legend(ax: Axes) -> None:
    """Says above a figure of its own what the artists of axes are."""
    handles, labels = ax.get_legend_handles_labels()
    figure = ax.get_figure(root=True)
    if handles and figure is not None:
        # as many columns as there is room for
        for columns in range(int(figure.get_size_inches()[0]), 0, -1):
            drawn = figure.legend(handles, labels, loc="outside upper left", ncols=columns, frameon=False, prop=small(ax), handlelength=1.8)
            if columns == 1 or drawn.get_window_extent().width <= figure.bbox.width:
                break
            drawn.remove()
        # colours of thin lines are hard to see
        for line in drawn.get_lines():
            line.set_linewidth(max(line.get_linewidth(), LINE))


class _Prefixed(Formatter):
    """Numbers of SI units on axes, with the prefix that suits all of them.

    The name of the axis has the unit with the prefix, where nobody has written another one.
    """

    def __init__(self, name: str, unit: str, alike: Sequence[Axis]) -> None:
        self.name, self.unit, self.alike = name, unit, alike
        self.written = ""

    def _power(self) -> int:
        """The power of ten of the prefix, from what the axes show."""
        largest = max(float(np.abs(axis.get_view_interval()).max()) for axis in self.alike)
        # the prefix of a square counts twice
        step = 6 if self.unit.endswith("²") else 3
        power = step * math.floor(math.log10(largest) / step) if largest > 0.0 else 0
        known = [power for power in _PREFIXES if power % step == 0 and (power <= 0 or self.unit != "{}s")]
        return min(max(power, known[0]), known[-1]) if "{}" in self.unit else 0

    def __call__(self, x: float, pos: int | None = None) -> str:
        return f"{x / 10.0 ** self._power():g}"

    def format_ticks(self, values: Any) -> list[str]:
        power = self._power()
        numbers = np.asarray(values, dtype=float) / 10.0**power
        decimals = next((d for d in range(6) if np.allclose(numbers * 10**d, np.rint(numbers * 10**d), atol=1e-6)), 6)
        self._write_name(power)
        return [f"{number + 0.0:.{decimals}f}".replace("-", "\u2212") for number in np.round(numbers, decimals)]

    def _write_name(self, power: int) -> None:
        assert isinstance(self.axis, Axis)
        if self.name and self.axis.get_label_text() == self.written:
            prefix = _PREFIXES[power // 2 if self.unit.endswith("²") else power]
            self.written = " in ".join(part for part in (self.name, self.unit.format(prefix)) if part)
            self.axis.set_label_text(self.written)


def name_axis(axis: Axis, name: str, unit: str, alike: Sequence[Axis] = (), numbers: int | None = None) -> None:
    """Names an axis, and writes its numbers in a unit such as ``"{}N"``, whose prefix suits this axis and those that are alike.

    Without a place for a prefix, as in ``"degrees"``, the unit stays as it is; without a name there is only the scale. ``numbers`` is the largest count
    of them; without it as many as there is room for.
    """
    # the locator asks for the size of numbers when they are drawn, perhaps outside of the style
    axis.set_tick_params(labelsize=axis.get_major_ticks(1)[0].label1.get_fontsize())
    axis.set_major_locator(MaxNLocator(numbers or "auto", steps=[1, 2, 5, 10]))
    formatter = _Prefixed(name, unit, [axis, *alike])
    if name:
        axis.set_label_text("")
    axis.set_major_formatter(formatter)
    formatter.format_ticks(axis.get_majorticklocs())
