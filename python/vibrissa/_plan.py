"""The next scans of an object, from what a reconstruction knows of it."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from dataclasses import dataclass, field
from os import PathLike
from typing import TYPE_CHECKING, Any, Literal

import numpy as np
import numpy.typing as npt

from ._core import Path, Reconstruction, _plan

if TYPE_CHECKING:
    from matplotlib.axes import Axes


@dataclass(frozen=True)
class Plan:
    """Candidate scans, and those to make next (:func:`plan`).

    Attributes
    ----------
    candidates : numpy.ndarray
        Structured, one row a scan, the largest gain first: ``candidate``, its number; ``chosen``: its place among the chosen scans from 1, or 0;
        ``angle`` (rad), ``distance`` (m), ``pass`` (``left`` or ``right``); the path of the clamp from ``x_from``, ``y_from`` to ``x_to``, ``y_to``
        (m); ``gain``: expected length of the contour that it touches and that was not touched before, with its standard deviation over the hypotheses,
        ``gain_sigma``, and ``touched``, the length touched at all (m); ``time`` (s), ``largest_moment`` (N m), ``largest_stress`` (Pa, or NaN);
        ``blocked``: whether the clamp runs into the object in a hypothesis; ``swept``: hypotheses that were swept; ``sigma``: median of the
        predicted standard deviations (m); ``known_sigma_after``: median at the points touched before, with this scan (m). The last two are NaN without
        ``noise``. A scan that is blocked, or beyond the largest stress, is ruled out: it is swept no further, its gains and standard deviations are NaN.
    hypotheses : list of numpy.ndarray
        Objects that agree with what is known, the most plausible one first: points x, y (m) of each outline, of shape (n, 2).
    """

    candidates: npt.NDArray[np.void]
    hypotheses: list[npt.NDArray[np.float64]] = field(repr=False)
    _found: Reconstruction = field(repr=False)

    @property
    def chosen(self) -> npt.NDArray[np.void]:
        """The rows of ``candidates`` to make next, in their order."""
        rows = self.candidates[self.candidates["chosen"] > 0]
        return rows[np.argsort(rows["chosen"])]

    def plot(self, ax: Axes | None = None) -> Axes:
        """Draw what is known, the hypotheses, and the paths of the chosen scans.

        Parameters
        ----------
        ax : matplotlib.axes.Axes, optional
            Where.

        Returns
        -------
        matplotlib.axes.Axes
        """
        from .plot._plan import plan

        return plan(self.chosen, self.hypotheses, self._found.fitted, ax)

    def to_pandas(self) -> Any:
        """The candidates as a pandas data frame.

        Returns
        -------
        pandas.DataFrame
            With the units of its columns in ``attrs["units"]``.
        """
        from ._tables import to_pandas

        return to_pandas(self.candidates)


def plan(
    found: Reconstruction,
    *,
    distances: npt.ArrayLike | None = None,
    angles: npt.ArrayLike | None = None,
    paths: Sequence[Path] = (),
    scans: int = 3,
    stress: float | Literal["any"] | None = None,
    noise: Mapping[str, Any] | str | PathLike[str] | None = None,
    rate: float = 500.0,
    speed: float = 1e-3,
    hypotheses: int = 16,
    seed: int = 0,
) -> Plan:
    """Choose the next scans of an object from a reconstruction with a fitted contour, as the command ``vibrissa plan`` does.

    Parameters
    ----------
    found : Reconstruction
        What is known, with its rod.
    distances : float or array_like, optional
        Distances of the clamp's path from the object, m; by default 0.2, 0.35, 0.5, 0.65 and 0.8 lengths of the rod.
    angles : float or array_like, optional
        Directions of the rod at its clamp, rad; by default 24 all around.
    paths : sequence of Path, optional
        Further scans to judge: each a :class:`ClampPath` or :class:`ClampArc` on which the clamp moves. They have the first numbers, in their order.
    scans : int, optional
        Most scans to choose.
    stress : float or "any", optional
        Largest bending stress that the rod bears, Pa; by default its yield stress.
    noise : mapping, str or os.PathLike, optional
        The noise of the sensor as for :func:`simulate`: predicts standard deviations.
    rate : float, optional
        Samples in a second, Hz.
    speed : float, optional
        Speed of the clamp, m/s.
    hypotheses : int, optional
        Objects that are drawn: more take longer, and give more accurate expectations.
    seed : int, optional
        Of the draws: the same one gives the same plan.

    Returns
    -------
    Plan

    Raises
    ------
    ValueError
        The reconstruction has no fitted contour, an argument is not possible, or neither ``stress`` nor the yield stress of the rod is given.
    """
    distances, angles = (None if values is None else np.atleast_1d(np.asarray(values)) for values in (distances, angles))
    candidates, drawn = _plan(found, distances, angles, paths, scans, stress, noise, rate, speed, hypotheses, seed)
    return Plan(candidates, [np.asarray(points) for points in drawn], found)
