"""Rods: how a cut is carried along them, by two ways that share nothing.

A cut is (x, y, phi, m) with the moment m. x' = cos phi, y' = sin phi, phi' = m / stiffness + curvature, m' = A cos phi + B sin phi.
"""

import cone
import gauss
import jacobi
import taylor
from mpmath import mpf


class Uniform:
    """Straight at rest, of stiffness 1: the moment is the curvature."""

    OTHER = "Jacobi elliptic functions"

    def by_taylor(self, cut, a, b, start, end):
        return taylor.advance(cut, a, b, end - start)

    def by_other(self, cut, a, b, start, end):
        return jacobi.advance(cut, a, b, end - start)


class Sections:
    """Parts of constant stiffness and natural curvature, each up to an arc length; the last one goes on."""

    OTHER = "Jacobi elliptic functions"

    def __init__(self, sections):
        self.sections = sections

    def _carried(self, advance, cut, a, b, start, end):
        ends = [section["to"] for section in self.sections[:-1]] + [max(start, end) + 1]
        parts = []
        for begin, stop, section in zip([mpf(-1)] + ends[:-1], ends, self.sections):
            low, high = max(begin, min(start, end)), min(stop, max(start, end))
            if low < high:
                parts.append((low, high, section["stiffness"], section["curvature"]))
        for low, high, stiffness, curvature in parts if start < end else reversed(parts):
            x, y, phi, m = cut
            way = high - low if start < end else low - high
            *place, kappa = advance([x, y, phi, m / stiffness + curvature], a / stiffness, b / stiffness, way)
            cut = [*place, stiffness * (kappa - curvature)]
        return cut

    def by_taylor(self, *asked):
        return self._carried(taylor.advance, *asked)

    def by_other(self, *asked):
        return self._carried(jacobi.advance, *asked)


class Cone:
    """The diameter falls linearly, the stiffness is (1 - taper s)^4; the natural curvature is c0 + c1 s."""

    OTHER = gauss.NAME

    def __init__(self, taper, curvature):
        self.taper, self.curvature = taper, curvature

    def by_taylor(self, cut, a, b, start, end):
        return cone.advance(cut, a, b, start, end, self.taper, self.curvature)

    def by_other(self, cut, a, b, start, end):
        stiffness = lambda s: (1 - self.taper * s) ** 4
        return gauss.advance(cut, a, b, start, end, stiffness, lambda s: self.curvature[0] + self.curvature[1] * s)


def of(described):
    """The rod of the field `rod`, with exact numbers."""
    if described is None:
        return Uniform()
    if "sections" in described:
        return Sections(described["sections"])
    return Cone(described["taper"], described["curvature"])
