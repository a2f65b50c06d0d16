"""Forces from points on a rod: frames of any kind as the compiled part takes them."""

from __future__ import annotations

from collections.abc import Iterable, Mapping, Sequence
from dataclasses import dataclass
from os import PathLike
from typing import Literal

import numpy as np
import numpy.typing as npt

from ._core import Forces, Rod, _forces
from .tracking import Frames

_Points = npt.ArrayLike
# What a force/torque sensor measures, by the names of channels.
_OF_SENSOR = ("Fx", "Fy", "Fz", "Tx", "Ty", "Tz")
FramesLike = Frames | Mapping[int, _Points] | Iterable[_Points]


@dataclass(frozen=True)
class _Flat:
    numbers: list[int]
    ends: list[int]
    points: npt.NDArray[np.float64]
    sigma: list[float]


def _flat(frames: FramesLike, name: str) -> _Flat:
    """The frames in one piece."""
    if isinstance(frames, Frames):
        # frames are in order, and the points of a frame stand together
        numbers, counts = np.unique(frames.frame, return_counts=True)
        points = np.column_stack([frames.x, frames.y])
        return _Flat(numbers.tolist(), np.cumsum(counts).tolist(), points, frames.sigma.tolist())
    numbered = list(frames.items()) if isinstance(frames, Mapping) else list(enumerate(frames))
    kept: list[npt.NDArray[np.float64]] = []
    for number, given in numbered:
        points = np.asarray(given, dtype=float)
        if points.ndim != 2 or points.shape[1] != 2:
            raise ValueError(f"{name}: frame {number} has the shape {points.shape}, expected points of shape (n, 2): x, y in m")
        kept.append(points)
    ends = np.cumsum([len(points) for points in kept]).astype(int).tolist()
    flat = np.concatenate(kept) if kept else np.empty((0, 2))
    return _Flat([int(number) for number, _ in numbered], ends, flat, [float("nan")] * len(flat))


def forces(
    rod: Rod,
    frames: FramesLike | None = None,
    *,
    rest: FramesLike | None = None,
    channels: Mapping[str, npt.ArrayLike] | None = None,
    setup: str | PathLike[str] | None = None,
    visible: Literal["base", "tip", "both", "neither"] = "base",
    sigma: float | None = None,
    friction: float = 0.0,
    contacts: int = 2,
    pole: bool | tuple[float, float] = False,
    pole_radius: float | None = None,
    pole_sigma: float | None = None,
    shortening: float = 0.05,
) -> Forces:
    """The forces on a rod, frame by frame, from points on it, from measured numbers at its base, or from both.

    Each frame is explained by the elastica with the fewest contacts (none, one or two, each on the side or at the tip). With exact points place and
    force are exact to 1e-9 of the length and of E I / L^2, where the frame determines them; standard deviations are those of the points' noise.

    Parameters
    ----------
    rod : Rod
        Any rod, on a rigid clamp or on springs.
    frames : Frames, mapping of frame numbers to arrays, or sequence of arrays, optional
        Points on the rod, of shape (n, 2), m, in order from the base to the tip. NaN where a point was not seen: where that is the first one, the
        base of this frame was not seen, whatever `visible` says, and so for the tip. :mod:`vibrissa.tracking` reads them from files. None with `channels` alone.
    rest : the same, optional
        Frames in which nothing touches the rod, of 5 points or more: its curvature at rest is found from them, in place of that of `rod`.
    channels : mapping of names to arrays, optional
        Measured numbers, one a frame: any of ``x0``, ``y0`` (m), ``phi0`` (rad) of the support, ``base_x``, ``base_y``, ``base_phi`` of the base,
        ``f0x``, ``f0y`` (N), ``m0z`` (N m), at the arc length S in m ``kappa@S`` (curvature, 1/m) and ``x@S``, ``y@S`` (m),
        ``phi@S`` (rad) of a marker, and their standard deviations ``sigma_...``.
        Also ``Fx``, ``Fy``, ``Fz`` (N), ``Tx``, ``Ty``, ``Tz`` (N m) of a force/torque sensor. NaN where one was not measured.
    setup : str or os.PathLike, optional
        How that sensor sits: the table ``[mounting]`` of a setup file. Without it, in the axes of x and y and at the base; it measures the load of
        the rod on it. Without any of its numbers it is an error.
    visible : str
        Which ends of the rod the points show: ``"base"`` (the first point), ``"tip"`` (the last), ``"both"`` or ``"neither"``. With ``"base"`` a
        ``UserWarning`` says by how much forces change if the first point is not the base, unless the points show the rod to its tip or
        the channels ``base_x``, ``base_y`` say where the base is.
    sigma : float, optional
        Standard deviation of each coordinate of the points, m; found from the frames where it is None, which needs 8 points or more a frame to be
        reliable.
    friction : float
        Largest coefficient of Coulomb friction at contacts on the side.
    contacts : int
        Largest number of contacts, 0 to 2.
    pole : bool or (float, float)
        True: all frames that have a contact touch one round pole, which is found from them. Or its centre x, y, m. Then no frame has more than one
        contact, and frames tell each other where the pole is.
    pole_radius : float, optional
        Its radius, m; 0 for an edge. Found from the frames where it is None.
    pole_sigma : float, optional
        Standard deviation of each coordinate of a centre that is given, m; a thousandth of the length of the rod where it is None.
    shortening : float
        Largest apparent shortening of a rod of which both ends are seen, as a share of its length.

    Returns
    -------
    Forces
        ``frames`` and ``contacts`` are its tables.

    Raises
    ------
    ValueError
        Frames or channels are none, `setup` is given without numbers of a sensor, or the frames of the free rod give no shape.

    Examples
    --------
    >>> import numpy as np, vibrissa
    >>> rod = vibrissa.Rod(0.1, bending_stiffness=1e-6)
    >>> line = np.column_stack([np.linspace(0.0, 0.1, 40), np.zeros(40)])
    >>> vibrissa.forces(rod, [line]).frames["verdict"][0].item()
    'free'
    """
    columns = None if channels is None else [(name, np.asarray(values, dtype=float)) for name, values in channels.items()]
    if frames is None:
        if not columns:
            raise ValueError("neither frames nor channels are given, expected points on the rod, measured numbers at its base, or both")
        frames = [np.empty((0, 2))] * len(columns[0][1])
    if setup is not None and not any(name in _OF_SENSOR for name, _ in columns or ()):
        given = ", ".join(channels) if channels else "none"
        raise ValueError(f"setup has no effect: the channels are {given}, expected any of {', '.join(_OF_SENSOR)} beside it")
    free = None if rest is None else _flat(rest, "rest")
    if pole is False and pole_radius is not None:
        raise ValueError("pole_radius is given without pole, expected pole=True, or its centre")
    center: tuple[float, float] | None = None
    if not isinstance(pole, bool):
        try:
            x, y = (float(part) for part in pole)
        except (TypeError, ValueError):
            raise ValueError(f"pole is {pole!r}, expected True, False or its centre (x, y) in m") from None
        center = (x, y)
    elif pole_sigma is not None:
        raise ValueError("pole_sigma is given without the centre of the pole, expected pole=(x, y)")
    prior = None if pole is False else (center, pole_sigma, pole_radius)
    return _forces(rod, _flat(frames, "frames"), free, columns, setup, visible, sigma, friction, contacts, prior, shortening)


__all__: Sequence[str] = ["forces"]
