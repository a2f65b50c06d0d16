"""What of an object straight scans can touch."""

from __future__ import annotations

from dataclasses import dataclass, field
from typing import TYPE_CHECKING, Any

import numpy as np
import numpy.typing as npt

from ._core import Scene, _reach

if TYPE_CHECKING:
    from matplotlib.axes import Axes

# How scans may touch a part of an outline.
_HOW = ("single", "several", "never")


@dataclass(frozen=True)
class Reach:
    """What the scans of a grid touch (:func:`reach`).

    Attributes
    ----------
    scans : numpy.ndarray
        Structured, one row a scan: ``angle`` (rad), ``distance`` (m), ``pass`` (``left`` or ``right``), lengths that are touched with one
        contact (``single``) and with several contacts (``several``), m, ``touched_share`` of all outlines, ``snaps``, ``largest_moment`` (N m),
        ``largest_stress`` (Pa, or NaN), and ``reason``: why the sweep stopped early.
    parts : numpy.ndarray
        Structured, the outlines in parts: ``object``, from 0, ``start`` and ``end`` (arc length, m), ``how`` any of the scans touches it (``single``,
        ``several``, that is only with several contacts, or ``never``), and the ends ``x_start``, ``y_start``, ``x_end``, ``y_end`` (m).
    length : float
        Length of all outlines, m.
    """

    scans: npt.NDArray[np.void]
    parts: npt.NDArray[np.void]
    length: float
    _lines: list[tuple[str, list[list[float]]]] = field(repr=False)

    def share(self, how: str) -> float:
        """Share of all outlines that is touched so by any of the scans.

        Parameters
        ----------
        how : str
            ``single``, ``several`` or ``never``.

        Returns
        -------
        float
        """
        if how not in _HOW:
            raise ValueError(f"how is {how!r}, expected 'single', 'several' or 'never'")
        chosen = self.parts[self.parts["how"] == how]
        return float(np.sum(chosen["end"] - chosen["start"])) / self.length

    def lines(self) -> list[tuple[str, npt.NDArray[np.float64]]]:
        """The parts as lines.

        Returns
        -------
        list of tuple
            For each row of ``parts`` how it is touched, and points x, y (m) along it, of shape (n, 2).
        """
        return [(how, np.asarray(points)) for how, points in self._lines]

    def plot(self, ax: Axes | None = None) -> Axes:
        """Draw the outlines, coloured by how they are touched.

        Parameters
        ----------
        ax : matplotlib.axes.Axes, optional
            Where.

        Returns
        -------
        matplotlib.axes.Axes
        """
        from .plot._plan import reach

        return reach(self.lines(), {how: self.share(how) for how in _HOW}, ax)

    def to_pandas(self, table: str = "scans") -> Any:
        """The scans, or the parts of the outlines, as a pandas data frame.

        Parameters
        ----------
        table : {"scans", "parts"}, optional
            Which.

        Returns
        -------
        pandas.DataFrame
            With the units of its columns in ``attrs["units"]``.
        """
        from ._tables import to_pandas

        if table not in ("scans", "parts"):
            raise ValueError(f"table is {table!r}, expected 'scans' or 'parts'")
        return to_pandas(self.scans if table == "scans" else self.parts)


def reach(scene: Scene, distances: npt.ArrayLike | None = None, angles: npt.ArrayLike | None = None) -> Reach:
    """Sweep the rod of a scene past its objects on many straight scans, and collect what the contacts touch, as the command ``vibrissa reach`` does.

    Each scan is swept in both directions, on all cores, without friction.

    Parameters
    ----------
    scene : Scene
        Rod and objects. Of its path only the first angle is used.
    distances : float or array_like, optional
        Distances of the clamp's path from the object's nearest point along the rod, m: more than 0, less than the length of the rod. By default
        33 distances from 0.1 to 0.9 lengths of the rod.
    angles : float or array_like, optional
        Directions of the rod at its clamp, rad; by default that of the scene's path. The clamp moves across this direction.

    Returns
    -------
    Reach

    Raises
    ------
    ValueError
        A distance or angle is not possible, an object goes on for ever within reach, or the scene has friction.

    Examples
    --------
    >>> import math, vibrissa
    >>> rod, circle = vibrissa.Rod(0.1, 6.3e-4), vibrissa.CircularArc((0.0, 0.0), 0.02, 0.0, 2 * math.pi)
    >>> path = vibrissa.ClampPath((0.2, -0.07, math.pi / 2), (-0.2, -0.07, math.pi / 2))
    >>> found = vibrissa.reach(vibrissa.Scene(rod, circle, path, 1e-3), distances=0.05)
    >>> round(found.share("single"), 9)
    0.5
    """
    given = [None if values is None else np.atleast_1d(np.asarray(values)) for values in (distances, angles)]
    return Reach(*_reach(scene, *given))
