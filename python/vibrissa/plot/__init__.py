"""Figures on Matplotlib, in the style and the colours of the command's figures.

Each function draws into axes that are given, or makes a figure of its own, as wide as one column of a journal (85 mm), and returns the axes. It does not
change the settings of Matplotlib. Data are in SI units, angles in degrees; the numbers on axes have a prefix that suits them, such as mm or µN·m.
Lines have labels: ``ax.legend()`` explains them in axes of yours. :func:`style` has fonts and sizes for such axes.

Matplotlib is an optional dependency: ``pip install vibrissa[plot]``.
"""

from .._tables import optional as _optional

_optional("matplotlib")

from ._along import criterion, forces, hysteresis, phase_criterion, reactions  # noqa: E402
from ._palette import phase_color  # noqa: E402
from ._plane import contour, elastica, notches, object_outline, shapes  # noqa: E402
from ._style import style  # noqa: E402
from ._sweep import animate, sweep  # noqa: E402

__all__ = [
    "animate",
    "contour",
    "criterion",
    "elastica",
    "forces",
    "hysteresis",
    "notches",
    "object_outline",
    "phase_color",
    "phase_criterion",
    "reactions",
    "shapes",
    "style",
    "sweep",
]
