"""What unpickling calls."""

from __future__ import annotations

from ._core import Composite, Rod, Scene


def rod(
    length: float,
    bending_stiffness: float | None,
    diameter: float | None,
    youngs_modulus: float | None,
    yield_stress: float | None,
) -> Rod:
    """The rod of these numbers."""
    return Rod(
        length,
        bending_stiffness,
        diameter=diameter,
        youngs_modulus=youngs_modulus,
        yield_stress=yield_stress,
    )


# What a scene has beside its objects.
_SCENE = """
[rod]
length = 1.0
bending_stiffness = 1.0
[sweep]
from = [0.0, 0.0]
to = [1.0, 0.0]
angle = 90.0
step = 1.0
"""


def composite(objects: str) -> Composite:
    """The object of the tables of a scene file."""
    return Scene.parse(objects + _SCENE).objects[0]
