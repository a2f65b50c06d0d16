"""What moves along a scan or a recording, and how the reactions change meanwhile."""

from __future__ import annotations

import math
from dataclasses import dataclass
from typing import Any, Literal, TypeAlias

import numpy as np
import numpy.typing as npt

from .._core import Reconstruction, Recording, Rod, Scan

Rows: TypeAlias = npt.NDArray[np.void]
Array: TypeAlias = npt.NDArray[np.float64]
# What has poses and reactions; an array has the fields x0, y0, phi0, f0x, f0y, m0z, and perhaps t.
Source: TypeAlias = Scan | Reconstruction | Recording | Rows
Over: TypeAlias = Literal["time", "position", "angle", "way"]

_JUMPS = ["snap", "snap-off", "slip-over"]
_NUMBERS = ["t", "x0", "y0", "phi0", "f0x", "f0y", "m0z"]
_COLUMNS = [*((name, float) for name in _NUMBERS), ("phase", "U32"), ("leg", int), ("sticks", bool), ("jumped", bool)]
# A clamp that moves back by this share of its range begins another pass.
_TURN = 0.02


@dataclass(frozen=True)
class Course:
    """Poses and reactions in order.

    The fields of ``rows``: ``phase``, empty where it is not known; ``leg`` of a path, or pass of a recording; ``sticks``, if a contact does;
    ``jumped``, if the rod has, just before. States just before and after transitions are among them.
    """

    rows: Rows
    rod: Rod | None
    # Numbers of the rows at which something happens, and of those that are reported states or samples.
    marks: npt.NDArray[np.int64]
    states: npt.NDArray[np.int64]
    part: str = "leg"

    def over(self, what: Over | None = None) -> tuple[Array, str, str]:
        """What the rows are drawn over, with its name and unit: unless it is given, the time if there is one, else what moves."""
        rows = self.rows
        name = self._coordinate()
        if what is None:
            is_timed = len(rows) > 0 and bool(np.isfinite(rows["t"]).all())
            to_and_fro = np.ptp(rows["leg"]) > 0 if len(rows) else False
            what = "time" if is_timed else "way" if to_and_fro else "angle" if name == "phi0" else "position"
        if what == "time":
            return rows["t"], "time", "{}s"
        if what == "way":
            return self._way()
        if what == "angle":
            return np.degrees(rows["phi0"]), r"clamp angle $\mathregular{\varphi_0}$", "degrees" + self._sense(rows["phi0"])
        if what != "position":
            raise ValueError(f'over is {what!r}, expected "time", "position", "angle" or "way"')
        name = max("x0", "y0", key=lambda name: float(np.ptp(rows[name])) if len(rows) else 0.0)
        return rows[name], rf"clamp position $\mathregular{{{name[0]}_0}}$", "{}m" + self._sense(rows[name])

    def coordinate(self) -> Over:
        """What of the pose changes most."""
        return "angle" if self._coordinate() == "phi0" else "position"

    def _coordinate(self) -> str:
        length = self.rod.length if self.rod else 0.0
        spans = {name: float(np.ptp(self.rows[name])) if len(self.rows) else 0.0 for name in ("x0", "y0", "phi0")}
        spans["phi0"] *= length or 1e-6
        return max(spans, key=spans.__getitem__)

    def _way(self) -> tuple[Array, str, str]:
        x, y, phi = (np.diff(self.rows[name], prepend=self.rows[name][:1]) for name in ("x0", "y0", "phi0"))
        moved = np.hypot(x, y)
        if not moved.any() and self.rod is not None:
            return np.degrees(np.cumsum(np.abs(phi))), "angle turned by the clamp", "degrees"
        turns = np.abs(phi) * (self.rod.length if self.rod else 0.0)
        on_the_spot = (moved == 0.0) & (turns > 0.0)
        name = "way of the clamp" + (" (turning: of the tip)" if on_the_spot.any() else "")
        return np.cumsum(np.where(on_the_spot, turns, moved)), name, "{}m"

    def _sense(self, values: Array) -> str:
        """The direction of a scan that goes one way."""
        if len(values) < 2 or self.rows["leg"].any():
            return ""
        return " (scan \u2192)" if values[-1] > values[0] else " (\u2190 scan)"


def course(source: Source) -> Course:
    """The rows of a scan, a reconstruction, a recording, or an array of samples."""
    if isinstance(source, Scan):
        return _of_scan(source)
    samples = source if isinstance(source, np.ndarray) else source.samples
    rows = _rows(samples)
    rod, marks = None, np.empty(0, dtype=np.int64)
    if isinstance(source, Reconstruction):
        rod, marks = source.rod, source.kinks["next"]
        rows["phase"] = source.readings["label"]
    elif "phase" in (samples.dtype.names or ()):
        rows["phase"] = samples["phase"]
    has_legs = "leg" in (samples.dtype.names or ())
    found = Course(rows, rod, marks, np.arange(len(rows)), "leg" if has_legs else "pass")
    rows["leg"] = samples["leg"] if has_legs else _passes(rows[found._coordinate()])
    return found


def _rows(samples: Rows, names: dict[str, str] | None = None) -> Rows:
    """Samples as rows; NaN where there is no such number."""
    rows = np.zeros(len(samples), dtype=_COLUMNS)
    for name in _NUMBERS:
        given = (names or {}).get(name, name)
        rows[name] = samples[given] if given in (samples.dtype.names or ()) else math.nan
    return rows


def _of_scan(scan: Scan) -> Course:
    """States and transitions in their order along the path."""
    states, events = _rows(scan.states), scan.events
    for name in ("phase", "leg"):
        states[name] = scan.states[name]
    contacts = scan.contacts
    states["sticks"][contacts.parents()[contacts.values["mode"] == "stick"]] = True
    before, after = _rows(events), _rows(events, {name: f"{name}_after" for name in _NUMBERS})
    for rows, phase in ((before, "from"), (after, "to")):
        rows["phase"], rows["leg"] = events[phase], events["leg"]
    after["jumped"] = np.isin(events["kind"], _JUMPS)
    if states["sticks"].any() or np.isin(events["kind"], ["stick", "slip"]).any():
        for k in range(len(events)):
            event = scan.event(k)
            for rows, state in ((before, event.before), (after, event.after)):
                rows["sticks"][k] = any(contact.mode == "stick" for contact in state.contacts)
    places = _places(before, after, states, scan.rod.length)
    both = np.insert(states, np.repeat(places, 2), np.stack([before, after], axis=1).ravel())
    is_mark = (events["from"] != events["to"]) | np.isin(events["kind"], _JUMPS)
    marks = (places + 2 * np.arange(len(places)))[is_mark]
    numbers = np.arange(len(states))
    return Course(both, scan.rod, marks, numbers + 2 * np.searchsorted(places, numbers, side="right"))


def _places(before: Rows, after: Rows, states: Rows, length: float) -> npt.NDArray[np.int64]:
    """Before which state each event comes: the one whose way from the state before passes nearest to the pose of the event."""
    poses, wanted = (np.column_stack([rows["x0"], rows["y0"], length * rows["phi0"]]) for rows in (states, before))
    places, first = [], 0
    for event, to, pose in zip(before, after["phase"], wanted):
        first = max(first, int(np.searchsorted(states["leg"], event["leg"])))
        end = int(np.searchsorted(states["leg"], event["leg"], side="right"))
        if first < end:
            low = max(first - 1, 0)
            ways = poses[low + 1 : end] - poses[low : end - 1]
            off = pose - poses[low : end - 1]
            squares = np.einsum("ij,ij->i", ways, ways)
            share = np.clip(np.einsum("ij,ij->i", off, ways) / np.where(squares > 0.0, squares, 1.0), 0.0, 1.0)
            gaps = np.linalg.norm(off - share[:, None] * ways, axis=1)
            # beyond the last state that a sweep reached
            is_beyond = len(gaps) and gaps.argmin() == len(gaps) - 1 and share[-1] == 1.0 and gaps[-1] > 1e-9 * length
            first = end if is_beyond or not len(gaps) else low + 1 + int(gaps.argmin())
            # a state at the very pose may be the one just before
            if first < end and np.abs(poses[first] - pose).max() < 1e-9 * length and states["phase"][first] == event["phase"] != to:
                first += 1
        places.append(first)
    return np.array(places, dtype=np.int64)


def _passes(along: Array) -> npt.NDArray[np.int64]:
    """The number of the pass of each sample: the clamp turns back between two passes."""
    turns, least = [], _TURN * float(np.ptp(along)) if len(along) else 0.0
    sense, at, extreme = 0.0, 0, float(along[0]) if len(along) else 0.0
    for i, value in enumerate(along.tolist()):
        if sense * (value - extreme) > 0.0:
            at, extreme = i, value
        elif abs(value - extreme) > least:
            if sense:
                turns.append(at)
            sense, at, extreme = math.copysign(1.0, value - extreme), i, value
    return np.searchsorted(turns, np.arange(len(along)), side="right")


def runs(values: npt.NDArray[Any]) -> list[tuple[int, int, Any]]:
    """Neighbouring rows with one value: first, last + 1, value."""
    starts = [0, *(np.flatnonzero(values[1:] != values[:-1]) + 1).tolist()] if len(values) else []
    return [(a, b, values[a].item()) for a, b in zip(starts, [*starts[1:], len(values)])]
