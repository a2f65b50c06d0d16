"""Exceptions of the package."""

from __future__ import annotations

from typing import TYPE_CHECKING, Any

if TYPE_CHECKING:
    from ._core import Scan

__all__ = ["SweepStopped"]


class SweepStopped(RuntimeError):
    """A sweep, or a move of a follower, could not go on.

    Attributes
    ----------
    reason : str
        Why: ``"no-start"``, ``"step-too-small"``, ``"no-landing"``, ``"end-of-contour"``, ``"line-contact"``,
        ``"clamp-inside"``, ``"chatter"``, ``"no-pose"`` or ``"step-budget"``.
    pose : tuple of float
        Where the clamp was: x (m), y (m), phi (rad).
    tau : float
        Way along the path up to there: m, or rad where the clamp only turns; of a move its share, 0 to 1.
    scan : Scan or None
        All states and transitions before that; None for a move of a follower, and where the exception comes from a worker of a pool.
    """

    __module__ = "vibrissa"

    def __init__(
        self, message: str, reason: str, pose: tuple[float, float, float], tau: float, scan: Scan | None
    ) -> None:
        super().__init__(message)
        self.reason = reason
        self.pose = pose
        self.tau = tau
        self.scan = scan

    def __reduce__(self) -> tuple[Any, ...]:
        return type(self), (str(self), self.reason, self.pose, self.tau, None)
