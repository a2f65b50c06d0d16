"""Whiskers by numbers from the literature, as rods that taper. The numbers are those of ``vibrissa init --whisker``."""

from __future__ import annotations

import math
from dataclasses import dataclass

import numpy.typing as npt

from ._core import Rod, _average_whisker, _mean_curvature

__all__ = ["Whisker", "mouse", "rat"]

# A rod's tip is no thinner than this part of its base.
_THINNEST = 0.01


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
        return _mean_curvature(self.curvature_coefficient, self.length)

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

    An estimate: diameter of the tip, 3 um, the least that the code takes. The regressions do not determine it: they give the slope of the radius, so that the
    tip is a small difference of two large numbers. Others take 3 um to 11 um.

    Young's modulus is 3.34 GPa, the mean of 44 halves of 22 whiskers, with a standard deviation of 1.48 GPa: Quist, Faruqi, Hartmann,
    J. Biomech. 44 (2011). Single whiskers differ from all of this; measured numbers are better.
    """
    return Whisker(*_average_whisker("rat", row, column))


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
    return Whisker(*_average_whisker("mouse", row, column))
