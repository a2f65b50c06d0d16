"""Whiskers by numbers from the literature, as rods that taper."""

from __future__ import annotations

import math
from dataclasses import dataclass

import numpy.typing as npt

from ._core import Rod

__all__ = ["Whisker", "rat"]

# A rod's tip is no thinner than this part of its base.
_THINNEST = 0.01


@dataclass(frozen=True)
class Whisker:
    """Size and stiffness of a whisker, a cone of one material.

    Attributes
    ----------
    length : float
        Arc length in m.
    base_diameter, tip_diameter : float
        Diameters in m, linear in the arc length in between.
    youngs_modulus : float
        In Pa.
    source : str
        Where the numbers are from.

    Raises
    ------
    ValueError
        A number that is not positive and finite.
    """

    length: float
    base_diameter: float
    tip_diameter: float
    youngs_modulus: float
    source: str = ""

    def __post_init__(self) -> None:
        for name, unit in (("length", "m"), ("base_diameter", "m"), ("tip_diameter", "m"), ("youngs_modulus", "Pa")):
            value = getattr(self, name)
            if not (value > 0.0 and math.isfinite(value)):
                raise ValueError(f"{name} is {value!r} {unit}, expected a positive, finite number")

    def rod(self, natural_curvature: npt.ArrayLike | None = None) -> Rod:
        """The whisker as a rod. A tip that is thinner than a hundredth of the base has this diameter, the least that a rod may have.

        Parameters
        ----------
        natural_curvature : float or array of shape (n, 2), optional
            Curvature at rest as :class:`vibrissa.Rod` takes it: one number in 1/m, or points of arc length in m and curvature in 1/m. Straight by
            default.
        """
        return Rod(
            self.length,
            diameter=self.base_diameter,
            tip_diameter=max(self.tip_diameter, _THINNEST * self.base_diameter),
            youngs_modulus=self.youngs_modulus,
            natural_curvature=natural_curvature,
        )


def rat(row: int | str, column: int) -> Whisker:
    """A rat's whisker by regressions over the place on the cheek.

    Parameters
    ----------
    row : int or str
        1 to 5, or "A" to "E".
    column : int
        1 (at the back) to 5; row A ends with 4. Others are refused: for column 6 the regressions give lengths from -1 mm to 6 mm and tips of up
        to the diameter of the base and more, and the Greek whiskers lie between the rows.

    Raises
    ------
    ValueError
        A whisker outside these limits.

    Notes
    -----
    With the row i and the column j, in mm: length S = 43 + 1.8 i - 7.6 j, diameter of the base 0.041 + 0.002 S + 0.011 i - 0.0039 j, and
    slope of the radius 0.0012 + 0.00017 i - 0.000066 j + 0.00011 j^2: Belli, Yang, Bresee, Hartmann, J. Neurophysiol. 117 (2017). The tip's
    diameter is that of the base less 2 S times the slope, a small difference of large numbers, and for most whiskers less than a hundredth of
    the base or even negative: the slope is then up to 27 percent more than that of a cone with a sharp tip. Such a whisker has a tip of a
    hundredth of its base, and ``source`` says so.

    Young's modulus is 3.34 GPa, the mean of 44 halves of 22 whiskers, with a standard deviation of 1.48 GPa: Quist, Faruqi, Hartmann,
    J. Biomech. 44 (2011). Single whiskers differ from all of this; measured numbers are better.
    """
    i = "ABCDE".find(row.upper()) + 1 if isinstance(row, str) and len(row) == 1 else row
    if not isinstance(i, int) or not 1 <= i <= 5:
        raise ValueError(f"row is {row!r}, expected 1 to 5, or 'A' to 'E': the Greek whiskers lie between the rows")
    last = 4 if i == 1 else 5
    if not isinstance(column, int) or not 1 <= column <= last:
        raise ValueError(
            f"column is {column!r}, expected 1 to {last} in row {'ABCDE'[i - 1]}: the regressions do not hold for Greek whiskers (column 0), "
            "nor for those at the front"
        )
    length = 43.0 + 1.8 * i - 7.6 * column
    base = 0.041 + 0.002 * length + 0.011 * i - 0.0039 * column
    tip = base - 2.0 * length * (0.0012 + 0.00017 * i - 0.000066 * column + 0.00011 * column**2)
    source = "length and diameters: Belli et al. (2017), regressions; Young's modulus: Quist et al. (2011), mean"
    if tip < _THINNEST * base:
        source += f"; tip: 1/100 of the base, as the regression gives {1e3 * tip:.1f} um"
        tip = _THINNEST * base
    return Whisker(1e-3 * length, 1e-3 * base, 1e-3 * tip, 3.34e9, source)
