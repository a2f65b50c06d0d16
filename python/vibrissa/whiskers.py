"""Whiskers by numbers from the literature, as rods that taper."""

from __future__ import annotations

import math
from collections.abc import Mapping
from dataclasses import dataclass
from typing import TypeVar

import numpy.typing as npt

from ._core import Rod

__all__ = ["Whisker", "mouse", "rat"]

# A rod's tip is no thinner than this part of its base.
_THINNEST = 0.01
# Diameter of a tip in m: the least that the code of WHISKiT Physics takes (Whisker.cpp, a radius of 1.5 um). Twice as much makes the middle of a
# whisker with a base of 160 um stiffer by 8 %.
_TIP = 3e-6
# Diameter of a mouse's base as a part of the length: 67 um of 16 mm, the defaults of the Janelia package Whisker.
_MOUSE_BASE = 4.2e-3
# Newton steps to the end of a parabola: from above, on a convex function, they converge for all lengths.
_STEPS = 50

_Numbers = TypeVar("_Numbers")

# By row, from the first column that is told: length in mm, coefficient of the parabola in 1/mm. param_s_a.csv of whisker_param_average_rat in
# SeNSE-lab/whiskitphysics, without the whiskers C6, D6 and E6.
_RAT: dict[str, tuple[int, list[tuple[float, float]]]] = {
    "A": (0, [(39.9, 0.00596), (31.0, 0.0118), (25.1, 0.0123), (15.4, 0.0178), (10.7, 0.0222)]),
    "B": (0, [(46.8, 0.00681), (40.8, 0.00914), (29.3, 0.0149), (20.7, 0.0166), (11.8, 0.0244)]),
    "C": (0, [(52.8, 0.00694), (45.2, 0.00885), (32.6, 0.0118), (22.9, 0.0136), (13.3, 0.0233), (7.68, 0.0185)]),
    "D": (0, [(52.6, 0.00809), (45.9, 0.00859), (35.3, 0.0104), (25.5, 0.0130), (17.1, 0.0178), (10.9, 0.0239)]),
    "E": (1, [(44.1, 0.0101), (34.6, 0.0101), (24.4, 0.0142), (15.5, 0.0224), (9.4, 0.0192)]),
}


@dataclass(frozen=True)
class _Mean:
    """A mean with the standard deviation of single whiskers and their number."""

    value: float
    deviation: float
    count: int


def _means(length: tuple[float, float, int], coefficient: tuple[float, float, int]) -> tuple[_Mean, _Mean]:
    return _Mean(*length), _Mean(*coefficient)


# The same in mm and 1/mm: S_2D and Acoef_2D of mouse_all.mat in SeNSE-lab/BreseeEtAl_JEB2023_dataFiles, version 1, both sides of 8 mice; the file
# counts columns from 1. Left out are A0, the Greek whisker above the rows, and the whiskers at the front.
_MOUSE: dict[str, tuple[int, list[tuple[_Mean, _Mean]]]] = {
    "A": (
        1,
        [
            _means((18.3, 1.5, 13), (0.0071, 0.0037, 14)),
            _means((12.3, 1.2, 12), (0.0128, 0.0061, 13)),
            _means((8.5, 2.1, 12), (0.0173, 0.0140, 9)),
        ],
    ),
    "B": (
        0,
        [
            _means((21.2, 5.0, 13), (0.0063, 0.0033, 12)),
            _means((18.9, 2.5, 12), (0.0093, 0.0046, 12)),
            _means((14.2, 1.7, 11), (0.0143, 0.0058, 12)),
            _means((10.3, 2.8, 13), (0.0164, 0.0093, 10)),
        ],
    ),
    "C": (
        0,
        [
            _means((19.7, 4.0, 13), (0.0057, 0.0029, 12)),
            _means((19.3, 2.9, 12), (0.0075, 0.0042, 12)),
            _means((15.3, 1.3, 12), (0.0094, 0.0045, 11)),
            _means((12.7, 2.6, 13), (0.0120, 0.0055, 12)),
            _means((9.5, 3.0, 13), (0.0216, 0.0136, 12)),
        ],
    ),
    "D": (
        0,
        [
            _means((20.3, 4.6, 11), (0.0111, 0.0027, 10)),
            _means((19.7, 1.0, 11), (0.0088, 0.0036, 12)),
            _means((14.7, 1.8, 10), (0.0118, 0.0055, 9)),
            _means((11.4, 2.4, 13), (0.0142, 0.0077, 13)),
            _means((8.9, 2.2, 13), (0.0153, 0.0096, 12)),
        ],
    ),
    "E": (
        1,
        [
            _means((16.7, 2.0, 12), (0.0138, 0.0034, 12)),
            _means((13.7, 2.7, 11), (0.0126, 0.0071, 11)),
            _means((11.5, 3.6, 12), (0.0182, 0.0064, 11)),
            _means((8.9, 2.4, 13), (0.0211, 0.0115, 13)),
        ],
    ),
}


@dataclass(frozen=True)
class Whisker:
    """Size, stiffness and shape at rest of a whisker, a cone of one material.

    Attributes
    ----------
    length : float
        Arc length in m.
    base_diameter, tip_diameter : float
        Diameters in m, linear in the arc length in between.
    youngs_modulus : float
        In Pa.
    source : str
        Where the numbers are from, and which of them are estimates.
    curvature_coefficient : float
        Coefficient a in 1/m of the parabola y = a x^2 that the whisker has at rest, with its base at x = y = 0. The curvature at the base is 2 a. 0 for
        a straight whisker, the default. Positive bends it to the left, seen from its base.

    Raises
    ------
    ValueError
        A size or modulus that is not positive and finite, or a coefficient that is not finite.
    """

    length: float
    base_diameter: float
    tip_diameter: float
    youngs_modulus: float
    source: str = ""
    curvature_coefficient: float = 0.0

    def __post_init__(self) -> None:
        for name, unit in (("length", "m"), ("base_diameter", "m"), ("tip_diameter", "m"), ("youngs_modulus", "Pa")):
            value = getattr(self, name)
            if not (value > 0.0 and math.isfinite(value)):
                raise ValueError(f"{name} is {value!r} {unit}, expected a positive, finite number")
        if not math.isfinite(self.curvature_coefficient):
            raise ValueError(f"curvature_coefficient is {self.curvature_coefficient!r} 1/m, expected a finite number")

    @property
    def natural_curvature(self) -> float:
        """Mean curvature at rest in 1/m, as :meth:`rod` takes it: the angle between the ends of the parabola over the length.

        The parabola itself has 2 a at the base and less at the tip. Whiskers of one place differ: the standard deviation is some 30 % for rats (an
        estimate) and 50 % for mice (the median). A film of the whisker at rest (``rest`` of :func:`vibrissa.forces`) is better.
        """
        # the slope u at the tip: 4 a L = u sqrt(1 + u^2) + asinh u
        goal = 4.0 * abs(self.curvature_coefficient) * self.length
        slope = 0.5 * goal
        for _ in range(_STEPS):
            root = math.sqrt(1.0 + slope * slope)
            slope -= (slope * root + math.asinh(slope) - goal) / (2.0 * root)
        return math.copysign(math.atan(slope) / self.length, self.curvature_coefficient)

    def rod(self, natural_curvature: npt.ArrayLike | None = None) -> Rod:
        """The whisker as a rod. A tip that is thinner than a hundredth of the base has this diameter, the least that a rod may have.

        Parameters
        ----------
        natural_curvature : float or array of shape (n, 2), optional
            Curvature at rest as :class:`vibrissa.Rod` takes it: one number in 1/m, such as the property of this name, or points of arc length in m and
            curvature in 1/m. Straight by default, whatever ``curvature_coefficient`` is.
        """
        return Rod(
            self.length,
            diameter=self.base_diameter,
            tip_diameter=max(self.tip_diameter, _THINNEST * self.base_diameter),
            youngs_modulus=self.youngs_modulus,
            natural_curvature=natural_curvature,
        )


def rat(row: int | str, column: int) -> Whisker:
    """An average whisker of a rat by its place on the cheek.

    Parameters
    ----------
    row : int or str
        1 to 5, or "A" to "E".
    column : int
        0 (the Greek whisker behind the row) to 4 in the rows A and B, to 5 in C and D; 1 to 5 in E.

    Raises
    ------
    ValueError
        A whisker outside these limits.

    Notes
    -----
    Measured: length and ``curvature_coefficient``, the averages of 27 whiskers that the Hartmann laboratory publishes with WHISKiT Physics
    (SeNSE-lab/whiskitphysics; Zweifel, Bush, Abraham, Murphey, Hartmann, PNAS 118 (2021)), without standard deviations.

    By a regression: diameter of the base in mm, 0.041 + 0.002 S + 0.011 i - 0.0039 j with the length S in mm, the row i and the column j: Belli, Yang,
    Bresee, Hartmann, J. Neurophysiol. 117 (2017), as in that code.

    An estimate: diameter of the tip, 3 um, the least that the code takes. The regressions cannot tell it: they give the slope of the radius, so that the
    tip is a small difference of two large numbers. Others take 3 um to 11 um.

    Young's modulus is 3.34 GPa, the mean of 44 halves of 22 whiskers, with a standard deviation of 1.48 GPa: Quist, Faruqi, Hartmann,
    J. Biomech. 44 (2011). Single whiskers differ from all of this; measured numbers are better.
    """
    letter, (length, coefficient) = _place("rat", _RAT, row, column)
    base = 0.041 + 0.002 * length + 0.011 * ("ABCDE".index(letter) + 1) - 0.0039 * column
    source = (
        "length and curvature: measured averages, without standard deviations, of the code of WHISKiT Physics (Zweifel et al. 2021); base diameter: "
        "regression with this length, Belli et al. (2017); tip diameter: an estimate; Young's modulus: measured mean, standard deviation 1.48 GPa, "
        "Quist et al. (2011)"
    )
    return Whisker(1e-3 * length, 1e-3 * base, _TIP, 3.34e9, source, 1e3 * coefficient)


def mouse(row: int | str, column: int) -> Whisker:
    """An average whisker of a mouse by its place on the cheek.

    Parameters
    ----------
    row : int or str
        1 to 5, or "A" to "E".
    column : int
        1 to 3 in row A, 0 (the Greek whisker behind the row) to 3 in B, 0 to 4 in C and D, 1 to 4 in E.

    Raises
    ------
    ValueError
        A whisker outside these limits.

    Notes
    -----
    Measured: length and ``curvature_coefficient``, means of 9 to 14 whiskers that were plucked and scanned. ``source`` has their standard deviations
    and numbers. Computed from the data of Bresee, Belli, Luo, Hartmann, J. Exp. Biol. 226 (2023)
    (SeNSE-lab/BreseeEtAl_JEB2023_dataFiles, version 1).

    Estimates: diameter of the base, 4.2e-3 of the length, from 67 um at 16 mm, the defaults of the Janelia package Whisker (the whisker is not
    named there). It may be off by 25 %: forces, which go with its fourth power, are then too small by a factor of 2.4 or too large by one of 3.2.
    Diameter of the tip, 3 um, as for :func:`rat`. Young's modulus, 5 GPa, the default of the same package.
    """
    _, (length, coefficient) = _place("mouse", _MOUSE, row, column)
    source = (
        f"length: measured mean of {length.count} whiskers, standard deviation {length.deviation} mm; curvature: measured mean of "
        f"{coefficient.count} whiskers, standard deviation of the coefficient {1e3 * coefficient.deviation:.1f} 1/m, both of the data of "
        "Bresee et al. (2023); base diameter: an estimate of +-25 %, 4.2e-3 of the length; tip diameter: an estimate; Young's modulus: an estimate, "
        "the default of the Janelia package Whisker"
    )
    base = _MOUSE_BASE * 1e-3 * length.value
    return Whisker(1e-3 * length.value, base, _TIP, 5e9, source, 1e3 * coefficient.value)


def _place(animal: str, table: Mapping[str, tuple[int, list[_Numbers]]], row: int | str, column: int) -> tuple[str, _Numbers]:
    """The letter of a row, and the numbers of a whisker in it."""
    i = "ABCDE".find(row.upper()) + 1 if isinstance(row, str) and len(row) == 1 else row
    if not isinstance(i, int) or not 1 <= i <= 5:
        raise ValueError(f"row is {row!r}, expected 1 to 5, or 'A' to 'E'")
    letter = "ABCDE"[i - 1]
    first, whiskers = table[letter]
    last = first + len(whiskers) - 1
    if not isinstance(column, int) or not first <= column <= last:
        raise ValueError(
            f"column is {column!r}, expected {first} to {last}: the whiskers in row {letter} of a {animal} of which there are measured averages; "
            "0 is the Greek whisker"
        )
    return letter, whiskers[column - first]
