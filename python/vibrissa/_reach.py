"""What of an object straight scans can touch."""

from __future__ import annotations

import math
from collections.abc import Sequence
from dataclasses import dataclass
from typing import Any

import numpy as np
import numpy.typing as npt

from ._core import Rod, Shape, _reach


@dataclass(frozen=True)
class Reach:
    """What the scans of a grid touch (:func:`reach`).

    Attributes
    ----------
    scans : numpy.ndarray
        Structured, one row a scan: ``angle`` (rad), ``distance`` (m), ``pass`` (``left`` or ``right``), lengths that are touched with one
        contact (``single``) and with several contacts (``several``), m, ``touched_share`` of all outlines, ``snaps``, ``largest_moment`` (N m),
        ``largest_stress`` (Pa, or NaN), and ``stop``: why the sweep stopped early.
    parts : numpy.ndarray
        Structured, the outlines in parts: ``object``, from 0, ``start`` and ``end`` (arc length, m), ``touched`` by any of the scans (``single``,
        ``several``, that is only with several contacts, or ``never``), and the ends ``x_start``, ``y_start``, ``x_end``, ``y_end`` (m).
    length : float
        Length of all outlines, m.
    """

    scans: npt.NDArray[np.void]
    parts: npt.NDArray[np.void]
    length: float

    def share(self, touched: str) -> float:
        """Share of all outlines that is touched so by any of the scans.

        Parameters
        ----------
        touched : str
            ``single``, ``several`` or ``never``.

        Returns
        -------
        float
        """
        if touched not in ("single", "several", "never"):
            raise ValueError(f"touched is {touched!r}, expected 'single', 'several' or 'never'")
        chosen = self.parts[self.parts["touched"] == touched]
        return float(np.sum(chosen["end"] - chosen["start"])) / self.length


def reach(
    rod: Rod,
    objects: Shape | Sequence[Shape] | Any,
    distances: npt.ArrayLike,
    angles: npt.ArrayLike = math.pi / 2,
) -> Reach:
    """Sweep a rod past objects on many straight scans, on all cores, and collect what the contacts go over, without friction.

    Parameters
    ----------
    rod : Rod
        The rod.
    objects : Shape, Composite, or sequence of them
        The objects.
    distances : float or array_like
        Distances of the clamp's path from the object's nearest point along the rod, m: more than 0, less than the length of the rod.
    angles : float or array_like, optional
        Directions of the rod at its clamp, rad. The clamp moves across this direction, to both sides.

    Returns
    -------
    Reach

    Raises
    ------
    ValueError
        A distance or angle is not possible, or an object goes on for ever within reach.

    Examples
    --------
    >>> import math, vibrissa
    >>> rod, circle = vibrissa.Rod(0.1, 6.3e-4), vibrissa.CircularArc((0.0, 0.0), 0.02, 0.0, 2 * math.pi)
    >>> found = vibrissa.reach(rod, circle, 0.05)
    >>> round(found.share("single"), 9)
    0.5
    """
    scans, parts, length = _reach(rod, objects, np.atleast_1d(distances), np.atleast_1d(angles))
    return Reach(scans, parts, length)
