"""What unpickling calls."""

from __future__ import annotations

from typing import Any

from . import _core
from ._core import Chain, ClampArc, ClampPath, Composite, Path, Scene


def made(name: str, arguments: dict[str, Any]) -> Any:
    """An object of the class of that name."""
    return getattr(_core, name)(**arguments)


def called(thing: Any, method: str, arguments: tuple[Any, ...]) -> Any:
    """What a method of an object gives."""
    return getattr(thing, method)(*arguments)


def path(legs: list[Any]) -> Path:
    """The path of a scene: legs from pose to pose, or with pivot and angle."""
    made: list[Path] = []
    for first, second in legs:
        if isinstance(second, float):
            made.append(ClampArc(made[-1].end, first, second))
        else:
            made.append(ClampPath(first, second))
    return made[0] if len(made) == 1 else Chain(made)


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
