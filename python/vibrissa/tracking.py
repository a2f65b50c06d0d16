"""Shapes of a rod that were tracked in a video: readers of the files of trackers.

Each reader returns :class:`Frames` in m: the points of one rod from its base to its tip, frame by frame. ``scale`` is the size of a pixel in m,
the same over the whole image. In an image y points down; with ``image=True`` y becomes -y, so that angles count counter-clockwise as in the
rest of the package. A file that does not hold what is expected gives one ValueError with all faults, of which it names the first five.

HDF5 files need h5py, those of DeepLabCut pandas and PyTables: ``pip install vibrissa[tracking]``.
"""

from __future__ import annotations

import csv
import importlib
import json
import math
import os
import struct
from collections.abc import Iterable, Mapping, Sequence
from dataclasses import dataclass
from itertools import groupby
from pathlib import Path
from typing import Any, Literal

import numpy as np
import numpy.typing as npt

__all__ = ["Frames", "read_deeplabcut", "read_frames", "read_sleap", "read_whisk", "read_whiskiwrap"]

_File = str | os.PathLike[str]
_Floats = npt.NDArray[np.float64]
# A frame, its points (n, 2) in pixels, and their sigma (n) in pixels.
_Shape = tuple[int, _Floats, _Floats]
# A traced curve: its frame, its number within the frame, its points (n, 2) in pixels.
_Segment = tuple[int, int, _Floats]

_SHOWN = 5


@dataclass(frozen=True, eq=False)
class Frames:
    """Tracked points in m, one entry a point: sorted by frame, and from the base to the tip within a frame.

    Attributes
    ----------
    frame : array of int64, shape (n,)
        Number of the frame, which never decreases.
    x, y : array of float64, shape (n,)
        Position in m; both NaN where a point of the rod was not seen. Where that is the first or the last point of a frame, the end of the rod
        was not seen.
    sigma : array of float64, shape (n,)
        Standard deviation of x and of y in m, NaN where it is unknown.

    Raises
    ------
    ValueError
        Arrays of different length; frames that decrease; a position that is neither finite nor NaN; a sigma that is not positive; a frame of one point;
        no frame.
    """

    frame: npt.NDArray[np.int64]
    x: _Floats
    y: _Floats
    sigma: _Floats

    def __post_init__(self) -> None:
        if np.asarray(self.frame).dtype.kind not in "iu":
            raise ValueError(f"frame has entries of type {np.asarray(self.frame).dtype}, expected integers")
        for name, kind in (("frame", np.int64), ("x", np.float64), ("y", np.float64), ("sigma", np.float64)):
            values = np.array(getattr(self, name), dtype=kind)
            values.flags.writeable = False
            object.__setattr__(self, name, values)
        shapes = {name: getattr(self, name).shape for name in ("frame", "x", "y", "sigma")}
        if len(set(shapes.values())) > 1 or self.frame.ndim != 1:
            raise ValueError(f"the arrays have the shapes {shapes}, expected one dimension and the same length")
        _refuse(_faults("Frames", self.frame, self.x, self.y, self.sigma))

    def __len__(self) -> int:
        """Number of frames."""
        return len(self.numbers)

    @property
    def numbers(self) -> npt.NDArray[np.int64]:
        """The numbers of the frames, increasing, each once."""
        return np.unique(self.frame)

    def of(self, frame: int) -> _Floats:
        """The points of one frame in m, from the base to the tip: shape (n, 2).

        Raises
        ------
        ValueError
            No point has this frame.
        """
        first, end = np.searchsorted(self.frame, [frame, frame + 1])
        if first == end:
            raise ValueError(f"frame {frame} does not exist, expected one of {_some(self.numbers.tolist())}")
        return np.column_stack([self.x[first:end], self.y[first:end]])

    def write_csv(self, path: _File) -> None:
        """Writes the columns ``frame,x,y``, and ``sigma`` if one is known (empty where it is not), in digits that :func:`read_frames` reads
        back without a difference.
        """
        columns: list[list[str]] = [[str(k) for k in self.frame.tolist()]]
        columns += [["" if math.isnan(value) else repr(value) for value in values.tolist()] for values in (self.x, self.y)]
        names = ["frame", "x", "y"]
        if not np.isnan(self.sigma).all():
            names.append("sigma")
            columns.append(["" if math.isnan(value) else repr(value) for value in self.sigma.tolist()])
        lines = [",".join(row) for row in zip(*columns, strict=True)]
        Path(path).write_text("\n".join([",".join(names), *lines]) + "\n", encoding="utf-8", newline="\n")

    @classmethod
    def from_points(cls, points: Mapping[int, npt.ArrayLike] | Iterable[tuple[int, npt.ArrayLike]]) -> Frames:
        """Frames of given points in m; sigma is unknown.

        Parameters
        ----------
        points : mapping or iterable of pairs
            The number of a frame, and its points from the base to the tip: shape (n, 2), n at least 2. Frames in any order, each once.
        """
        faults: list[str] = []
        shapes: list[_Shape] = []
        for frame, given in points.items() if isinstance(points, Mapping) else points:
            rows = np.asarray(given, dtype=np.float64)
            if rows.ndim == 2 and rows.shape[1] == 2:
                shapes.append((int(frame), rows, np.full(len(rows), np.nan)))
            else:
                faults.append(f"points, frame {frame}: has the shape {rows.shape}, expected (n, 2)")
        shapes.sort(key=lambda shape: shape[0])
        _check_increasing("points", [shape[0] for shape in shapes], faults)
        return _frames("points", shapes, faults, 1.0, False)


def read_frames(file: _File, *, scale: float = 1.0, image: bool = False) -> Frames:
    """Frames, in m, of a CSV file with the columns ``frame``, ``x``, ``y``, and ``sigma`` if it is known; others are ignored.

    Parameters
    ----------
    file : path
        One line a point, from the base to the tip; frames must not decrease. An empty ``sigma`` is unknown, and a point with empty ``x`` and
        ``y`` was not seen.
    scale : float
        m for a unit of the file; also of ``sigma``.
    image : bool
        Whether y points down in the file.

    Raises
    ------
    ValueError
        A column that is missing; a cell that is no number; frames that decrease; a frame of one point; no frame.
    """
    faults = _scale_faults(scale)
    rows = _csv_rows(file)
    header = [name.strip() for name in rows[0][1]] if rows else []
    for name in ("frame", "x", "y"):
        if name not in header:
            faults.append(f"{file}, line 1: the column {name!r} is missing, expected frame,x,y or frame,x,y,sigma; there are {_some(header)}")
    _refuse(faults)
    last: int | None = None
    points: list[tuple[int, float, float, float]] = []
    for line, cells in rows[1:]:
        where = f"{file}, line {line}"
        if len(cells) != len(header):
            faults.append(f"{where}: has {len(cells)} cells, expected {len(header)}")
            continue
        row = dict(zip(header, cells, strict=True))
        frame = _integer(row["frame"], f"{where}: frame", faults)
        x, y = (_number(row[name], f"{where}: {name}", faults, gaps=True) for name in ("x", "y"))
        sigma = _number(row.get("sigma", ""), f"{where}: sigma", faults, gaps=True)
        if frame is None:
            continue
        if last is not None and frame < last:
            faults.append(f"{where}: frame {frame} comes after frame {last}, expected frames that do not decrease")
        last = frame
        points.append((frame, x, y, sigma))
    _refuse(faults)
    shapes = []
    for frame, group in groupby(points, key=lambda point: point[0]):
        values = np.array([point[1:] for point in group])
        shapes.append((frame, values[:, :2], values[:, 2]))
    return _frames(file, shapes, faults, scale, image)


def read_whisk(
    whiskers: _File,
    measurements: _File | None = None,
    *,
    scale: float,
    whisker: int | None = None,
    base: Literal["first", "last"] | None = None,
    image: bool = True,
) -> Frames:
    """Frames, in m, of one whisker in files of WHISK; sigma is unknown.

    Parameters
    ----------
    whiskers : path
        A ``.whiskers`` file in the format bwhiskbin1 (the usual one), bwhiskpoly1 (a parabola for each curve, evaluated at as many points as
        were traced) or whisker1 (text).
    measurements : path, optional
        The ``.measurements`` file of the same curves, version 0 to 3. It has the identity of each curve and which of its ends is the follicle.
    scale : float
        m for a pixel.
    whisker : int, optional
        With measurements the identity (0, 1, ..., -1 for what is no whisker; all are 0 before ``classify``), else the number of the curve
        within its frame, which means little. By default the longest curve of each frame.
    base : "first" or "last", optional
        Which end of a curve is the base. By default the end next to the follicle of the measurements (to the face in version 0, whose file
        does not tell reliably where the measures of a curve are).
    image : bool
        Whether y points down in the file.

    Raises
    ------
    ValueError
        A file of another format or cut off; no curve of this whisker, or two in a frame; a curve that was measured but is not in the file of
        curves; neither measurements nor ``base``; a curve of one point.

    Notes
    -----
    Layout from the sources of WHISK (nclack/whisk): whisker_io_whiskbin1.c, whisker_io_whiskpoly1.c, whisker_io_whisker1.c;
    measurements_io_v0.c to measurements_io_v3.c; the rule for the follicle from ``_side`` of measure.c. Little-endian.
    """
    faults = _scale_faults(scale) + _base_faults(base, measurements is None, "measurements")
    segments = _whiskers(whiskers, faults)
    measured = {} if measurements is None else _measurements(measurements, faults)
    _refuse(faults)
    if measurements is not None:
        there = {(frame, number) for frame, number, _ in segments}
        chosen = {key for key, (label, _) in measured.items() if whisker is None or label == whisker}
        for frame, number in sorted(chosen - there):
            faults.append(f"{measurements}, frame {frame}: curve {number} is not in {whiskers}, expected measurements of that file")
        labels = sorted({label for label, _ in measured.values()})
        if not chosen and whisker is not None:
            faults.append(f"{measurements}: no curve is whisker {whisker}, expected one of {_some(labels)}")
        segments = [segment for segment in segments if segment[:2] in chosen]
    elif whisker is not None:
        numbers = sorted({number for _, number, _ in segments})
        segments = [segment for segment in segments if segment[1] == whisker]
        if not segments:
            faults.append(f"{whiskers}: no curve has the number {whisker}, expected one of {_some(numbers)}")
    _refuse(faults)
    follicles = {key: point for key, (_, point) in measured.items()}
    return _frames(whiskers, _one_each(whiskers, segments, whisker is None, base, follicles, faults), faults, scale, image)


def read_whiskiwrap(
    file: _File, *, scale: float, whisker: int | None = None, base: Literal["first", "last"] | None = None, image: bool = True
) -> Frames:
    """Frames, in m, of one whisker in an HDF5 file of WhiskiWrap; sigma is unknown.

    Parameters
    ----------
    file : path
        Row k of the table ``summary`` (columns ``time``, the frame, ``id``, and ``fol_x``, ``fol_y``) is of the curve whose points are row k of
        ``pixels_x`` and of ``pixels_y``.
    scale : float
        m for a pixel.
    whisker : int, optional
        ``id`` of the curve. WhiskiWrap does not identify whiskers: this is a number within the frame. By default the longest curve of each frame.
    base : "first" or "last", optional
        Which end of a curve is the base. By default the end next to ``fol_x``, ``fol_y``; these are measured only in a table that was made
        with ``measure=True``, which also has ``angle``, and are the first point in others, where ``base`` must be given.
    image : bool
        Whether y points down in the file.

    Raises
    ------
    ImportError
        h5py is not there.
    ValueError
        Tables or columns that are missing or of different length; no curve of this id, or two in a frame; a curve of one point.

    Notes
    -----
    Layout from base.py of WhiskiWrap (cxrodgers/WhiskiWrap): ``WhiskerSeg``, ``WhiskerSeg_measure``, ``setup_hdf5``, ``append_whiskers_to_hdf5``.
    """
    faults = _scale_faults(scale)
    segments: list[_Segment] = []
    follicles: dict[tuple[int, int], _Floats] = {}
    with _hdf5(file) as stored:
        _missing(file, "the dataset", ["summary", "pixels_x", "pixels_y"], list(stored), faults)
        _refuse(faults)
        summary = stored["summary"][()]
        columns = list(summary.dtype.names or ())
        _missing(file, "the column of summary", ["time", "id", "fol_x", "fol_y"], columns, faults)
        lengths = [len(stored[name]) for name in ("summary", "pixels_x", "pixels_y")]
        if len(set(lengths)) > 1:
            faults.append(f"{file}: summary, pixels_x and pixels_y have {lengths} rows, expected as many in each")
        faults += _base_faults(base, "angle" not in columns, "measured follicles in the file")
        _refuse(faults)
        wanted = np.flatnonzero(np.ones(len(summary), dtype=bool) if whisker is None else summary["id"] == whisker)
        for k in wanted.tolist():
            frame, number = int(summary["time"][k]), int(summary["id"][k])
            x, y = (np.asarray(stored[name][k], dtype=np.float64) for name in ("pixels_x", "pixels_y"))
            if len(x) != len(y):
                faults.append(f"{file}, frame {frame}: curve {number} has {len(x)} x and {len(y)} y, expected as many of both")
                continue
            segments.append((frame, number, np.column_stack([x, y])))
            follicles[frame, number] = np.array([summary["fol_x"][k], summary["fol_y"][k]], dtype=np.float64)
        if not len(wanted) and whisker is not None:
            numbers = np.unique(summary["id"]).tolist()
            faults.append(f"{file}: no curve has the id {whisker}, expected one of {_some(numbers)}")
    _refuse(faults)
    return _frames(file, _one_each(file, segments, whisker is None, base, follicles, faults), faults, scale, image)


def read_deeplabcut(
    file: _File,
    bodyparts: Sequence[str],
    *,
    scale: float,
    individual: str | None = None,
    least_likelihood: float = 0.6,
    pixel_sigma: float | None = None,
    image: bool = True,
) -> Frames:
    """Frames, in m, of the body parts along one rod in a file of DeepLabCut.

    Parameters
    ----------
    file : path
        What ``analyze_videos`` writes: CSV with the header rows ``scorer``, ``bodyparts``, ``coords``, and ``individuals`` after the first if
        there are several animals; or HDF5 with the same table of pandas. The first column, or the index, is the frame.
    bodyparts : sequence of str
        Their names, from the base to the tip: at least two.
    scale : float
        m for a pixel.
    individual : str, optional
        Which one, if the file has several.
    least_likelihood : float
        Points of less are left out, as are those without a position; frames with fewer than two others too.
    pixel_sigma : float, optional
        Standard deviation, in pixels, of a point of likelihood 1; sigma is ``pixel_sigma * scale / sqrt(likelihood)``. Unknown by default.
    image : bool
        Whether y points down in the file.

    Raises
    ------
    ImportError
        The file is HDF5, and pandas or PyTables is not there.
    ValueError
        Another header; body parts, an individual or columns that are missing; a cell that is no number; a position without a likelihood; frames
        that do not increase; no frame that is left.

    Notes
    -----
    Layout from ``create_df_from_prediction`` of deeplabcut/pose_estimation_pytorch/apis/videos.py (DeepLabCut/DeepLabCut): the header, and a
    row for each frame, by ``DataFrame.to_hdf`` and ``DataFrame.to_csv``.
    """
    faults = _scale_faults(scale)
    bodyparts = _names("bodyparts", bodyparts, faults)
    if not 0.0 <= least_likelihood <= 1.0:
        faults.append(f"least_likelihood is {least_likelihood!r}, expected a number from 0 to 1")
    if pixel_sigma is not None and not (pixel_sigma > 0.0 and math.isfinite(pixel_sigma)):
        faults.append(f"pixel_sigma is {pixel_sigma!r}, expected a positive number of pixels, or None")
    _refuse(faults)
    levels, frames, values = (_deeplabcut_hdf if _is_hdf5(file) else _deeplabcut_csv)(file, faults)
    if len(set(levels["scorer"])) > 1:
        faults.append(f"{file}: there are several scorers, expected one; there are {_some(list(dict.fromkeys(levels['scorer'])))}")
    individuals = list(dict.fromkeys(levels.get("individuals", [])))
    if individual is None and len(individuals) > 1:
        faults.append(f"{file}: individual is None, expected one of {_some(individuals)}")
    elif individual is not None and individual not in individuals:
        expected = f"expected one of {_some(individuals)}" if individuals else "expected None: the file has no individuals"
        faults.append(f"{file}: individual is {individual!r}, {expected}")
    _refuse(faults)
    individual = individual if individual is not None or not individuals else individuals[0]
    owners = levels.get("individuals", [None] * len(levels["scorer"]))
    columns = {
        (part, coord): values[:, k]
        for k, (owner, part, coord) in enumerate(zip(owners, levels["bodyparts"], levels["coords"], strict=True))
        if owner == individual
    }
    _missing(file, "the body part", bodyparts, list(dict.fromkeys(part for part, _ in columns)), faults)
    _refuse(faults)
    for part in bodyparts:
        _missing(file, f"of the body part {part!r} the column", ["x", "y", "likelihood"], [c for p, c in columns if p == part], faults)
    _refuse(faults)
    x, y, likelihood = (np.column_stack([columns[part, coord] for part in bodyparts]) for coord in ("x", "y", "likelihood"))
    tracked = ~(np.isnan(x) | np.isnan(y))
    for k, j in np.argwhere(tracked & np.isnan(likelihood)).tolist():
        faults.append(f"{file}, frame {frames[k]}: the likelihood of {bodyparts[j]!r} is missing, expected a number from 0 to 1")
    _check_increasing(file, frames, faults)
    kept = tracked & (likelihood >= least_likelihood) & (likelihood > 0.0)
    if len(frames) and not faults and not (kept.sum(axis=1) >= 2).any():
        faults.append(f"{file}: no frame has two points of a likelihood of {least_likelihood} or more, expected a smaller least_likelihood")
    sigma = np.full(x.shape, np.nan)
    if pixel_sigma is not None:
        sigma[kept] = pixel_sigma / np.sqrt(likelihood[kept])
    return _frames(file, _filtered(frames, x, y, sigma, kept), faults, scale, image)


def read_sleap(
    file: _File,
    nodes: Sequence[str] | None = None,
    *,
    scale: float,
    track: int | str = 0,
    least_score: float = 0.2,
    image: bool = True,
) -> Frames:
    """Frames, in m, of the nodes along one rod in an analysis file of SLEAP; sigma is unknown.

    Parameters
    ----------
    file : path
        HDF5 with ``tracks``, ``node_names``, ``track_names`` and ``point_scores``, or CSV with the columns ``track``, ``frame_idx``, and
        ``node.x``, ``node.y``, ``node.score`` for each node. Frames of an HDF5 file count from 0, which is the first frame with a label if it
        was not exported with all frames.
    nodes : sequence of str, optional
        Their names, from the base to the tip: at least two. By default all nodes of an HDF5 file in the order of the skeleton; a CSV file does
        not keep that order reliably, so that they must be given.
    scale : float
        m for a pixel.
    track : int or str
        The track: its name, or its place among the tracks of the file (of a CSV file, in the order in which they begin).
    least_score : float
        Points of less are left out, as are those without a position; frames with fewer than two others too. Points without a score were set by
        hand, and stay.
    image : bool
        Whether y points down in the file.

    Raises
    ------
    ImportError
        The file is HDF5, and h5py is not there.
    ValueError
        Datasets, columns, nodes or a track that are missing; a shape that does not fit; a cell that is no number; two instances of the track in
        a frame; no frame that is left.

    Notes
    -----
    Layout from sleap/info/write_tracking_h5.py (talmolab/sleap): ``tracks`` has the shape (tracks, 2, nodes, frames), ``point_scores`` (tracks,
    nodes, frames). sleap_io/io/analysis_h5.py (talmolab/sleap-io) also writes other orders, which it names in the attribute ``dims``, and
    sleap_io/io/csv.py the columns of nodes in alphabetical order.
    """
    faults = _scale_faults(scale)
    chosen = None if nodes is None else _names("nodes", nodes, faults)
    if math.isnan(least_score):
        faults.append(f"least_score is {least_score!r}, expected a number")
    _refuse(faults)
    frames, x, y, scores = (_sleap_hdf5 if _is_hdf5(file) else _sleap_csv)(file, chosen, track, faults)
    _check_increasing(file, frames, faults)
    kept = ~(np.isnan(x) | np.isnan(y) | (scores < least_score))
    return _frames(file, _filtered(frames, x, y, np.full(x.shape, np.nan), kept), faults, scale, image)


def _refuse(faults: list[str]) -> None:
    """One error for all faults, if there are any."""
    if faults:
        more = [f"and {len(faults) - _SHOWN} more"] if len(faults) > _SHOWN else []
        raise ValueError("\n".join(faults[:_SHOWN] + more))


def _frames(file: _File, shapes: Iterable[_Shape], faults: list[str], scale: float, image: bool) -> Frames:
    """Shapes in pixels, sorted by frame, as frames in m."""
    shapes = list(shapes)
    lengths = [len(points) for _, points, _ in shapes]
    frame = np.repeat(np.array([shape[0] for shape in shapes], dtype=np.int64), lengths)
    points = np.concatenate([np.empty((0, 2)), *(points for _, points, _ in shapes)])
    sigma = np.concatenate([np.empty(0), *(sigma for _, _, sigma in shapes)])
    # Where faults left no shape, that there is none is no fault of the file.
    _refuse(faults if faults and not shapes else faults + _faults(file, frame, points[:, 0], points[:, 1], sigma))
    # 0 is added as a flipped 0 would be -0.
    return Frames(frame, scale * points[:, 0], (-scale if image else scale) * points[:, 1] + 0.0, scale * sigma)


def _faults(file: _File, frame: npt.NDArray[np.int64], x: _Floats, y: _Floats, sigma: _Floats) -> list[str]:
    """What no frames may have."""
    faults = []
    if not len(frame):
        faults.append(f"{file}: no frame is left, expected at least one of two points")
    for k in np.flatnonzero(np.diff(frame) < 0).tolist():
        faults.append(f"{file}: frame {frame[k + 1]} comes after frame {frame[k]}, expected frames that do not decrease")
    seen = ~(np.isnan(x) & np.isnan(y))
    for k in np.flatnonzero(seen & ~(np.isfinite(x) & np.isfinite(y))).tolist():
        faults.append(f"{file}, frame {frame[k]}: a point is ({x[k]}, {y[k]}), expected finite numbers, or two NaN for a point that was not seen")
    for k in np.flatnonzero(~(np.isnan(sigma) | (np.isfinite(sigma) & (sigma > 0.0)))).tolist():
        faults.append(f"{file}, frame {frame[k]}: sigma is {sigma[k]}, expected a positive number, or none where it is unknown")
    numbers, counts = np.unique(frame[seen], return_counts=True)
    faults += [f"{file}, frame {number}: has one point, expected at least two" for number in numbers[counts == 1].tolist()]
    faults += [f"{file}, frame {number}: has no point, expected at least two" for number in np.setdiff1d(frame, frame[seen]).tolist()]
    return faults


def _scale_faults(scale: float) -> list[str]:
    return [] if scale > 0.0 and math.isfinite(scale) else [f"scale is {scale!r}, expected a positive number, m for a pixel"]


def _base_faults(base: object, needed: bool, without: str) -> list[str]:
    if base in ("first", "last") or (base is None and not needed):
        return []
    return [f"base is {base!r}, expected 'first' or 'last'" + (f", as there are no {without}" if base is None else "")]


def _names(argument: str, names: Sequence[str], faults: list[str]) -> list[str]:
    """The names in an argument: a list of two or more."""
    found = [names] if isinstance(names, str) else list(names)
    if len(found) < 2 or len(set(found)) < len(found):
        faults.append(f"{argument} is {names!r}, expected at least two names, each once, from the base to the tip")
    return found


def _missing(file: _File, what: str, names: Iterable[str], there: list[str], faults: list[str]) -> None:
    faults += [f"{file}: {what} {name!r} is missing, expected one of {_some(there)}" for name in names if name not in there]


def _some(values: Sequence[object]) -> str:
    """Values in a sentence; of many the first ones."""
    shown = ", ".join(str(value) for value in values[:12])
    return f"{shown}, ... ({len(values)} in all)" if len(values) > 12 else shown or "none"


def _check_increasing(file: _File, frames: Sequence[int], faults: list[str]) -> None:
    for before, after in zip(frames, frames[1:], strict=False):
        if after == before:
            faults.append(f"{file}, frame {after}: is there twice, expected each frame once")
        elif after < before:
            faults.append(f"{file}: frame {after} comes after frame {before}, expected frames that increase")


def _filtered(frames: Sequence[int], x: _Floats, y: _Floats, sigma: _Floats, kept: npt.NDArray[np.bool_]) -> list[_Shape]:
    """The points of those frames that have two or more; arrays of shape (frames, points). Those that are not kept become NaN: which points of the
    rod were not seen is known.
    """
    x, y, sigma = (np.where(kept, values, np.nan) for values in (x, y, sigma))
    return [(int(frames[k]), np.column_stack([x[k], y[k]]), sigma[k]) for k in np.flatnonzero(kept.sum(axis=1) >= 2).tolist()]


def _one_each(
    file: _File,
    segments: list[_Segment],
    longest: bool,
    base: Literal["first", "last"] | None,
    follicles: Mapping[tuple[int, int], _Floats],
    faults: list[str],
) -> list[_Shape]:
    """One curve for each frame, from its base."""

    def length(segment: _Segment) -> float:
        return float(np.hypot(*np.diff(segment[2], axis=0).T).sum())

    shapes = []
    for frame, group in groupby(sorted(segments, key=lambda segment: segment[0]), key=lambda segment: segment[0]):
        found = list(group)
        if len(found) > 1 and not longest:
            faults.append(f"{file}, frame {frame}: the curves {_some([number for _, number, _ in found])} are this whisker, expected one curve")
            continue
        _, number, points = max(found, key=length)
        if base is None:
            first, last = (math.dist(points[k], follicles[frame, number]) for k in (0, -1))
            turned = last < first
        else:
            turned = base == "last"
        shapes.append((frame, points[::-1] if turned else points, np.full(len(points), np.nan)))
    return shapes


def _csv_rows(file: _File) -> list[tuple[int, list[str]]]:
    """The rows of a CSV file that are not empty, with the numbers of their lines."""
    try:
        with open(file, newline="", encoding="utf-8-sig") as stream:
            reader = csv.reader(stream)
            return [(reader.line_num, row) for row in reader if row]
    except (UnicodeDecodeError, csv.Error) as error:
        raise ValueError(f"{file}: is not text ({error}), expected a CSV file") from error


def _number(cell: str, where: str, faults: list[str], gaps: bool = False) -> float:
    """A finite number; NaN for an empty cell if there may be gaps."""
    try:
        value = math.nan if gaps and not cell.strip() else float(cell)
    except ValueError:
        value = math.inf
    if math.isfinite(value) or (gaps and math.isnan(value)):
        return value
    faults.append(f"{where} is {cell!r}, expected a finite number")
    return math.nan


def _integer(cell: object, where: str, faults: list[str]) -> int | None:
    """The number of a frame."""
    try:
        value = float(str(cell))
    except ValueError:
        value = math.nan
    if value.is_integer():
        return int(value)
    faults.append(f"{where} is {cell!r}, expected an integer")
    return None


def _optional(package: str) -> Any:
    """A package that only this module needs."""
    try:
        return importlib.import_module(package)
    except ImportError as error:
        raise ImportError(f"this file needs {package}: pip install vibrissa[tracking]") from error


def _is_hdf5(file: _File) -> bool:
    with open(file, "rb") as stream:
        return stream.read(8) == b"\x89HDF\r\n\x1a\n"


def _hdf5(file: _File) -> Any:
    """An HDF5 file, open to read."""
    if not _is_hdf5(file):
        raise ValueError(f"{file}: is not an HDF5 file, expected one")
    h5py = _optional("h5py")
    try:
        return h5py.File(file, "r")
    except OSError as error:
        raise ValueError(f"{file}: is damaged ({error}), expected an HDF5 file") from error


def _whiskers(file: _File, faults: list[str]) -> list[_Segment]:
    """The curves of a ``.whiskers`` file."""
    data = Path(file).read_bytes()
    # C writes the zero that ends a literal after the one in it.
    for magic in (b"bwhiskbin1\0\0", b"bwhiskpoly1\0\0"):
        if data.startswith(magic):
            return _binary_whiskers(file, data, len(magic), b"poly" in magic, faults)
    if data.startswith(b"whisker1"):
        return _text_whiskers(file, faults)
    faults.append(f"{file}: begins with {data[:12]!r}, expected bwhiskbin1, bwhiskpoly1 or whisker1")
    return []


def _binary_whiskers(file: _File, data: bytes, at: int, poly: bool, faults: list[str]) -> list[_Segment]:
    """Records of id, frame and number of points (int32), then x, y, thickness and score of each point (float32); or the median score (float32),
    and three coefficients of x and of y over 0 to 1 (float64), the constant first. At the end the number of records (int32).
    """
    segments: list[_Segment] = []
    end = len(data) - 4
    while at < end:
        number, frame, count = struct.unpack_from("<3i", data, at) if at + 12 <= end else (0, 0, 0)
        size = 12 + (52 if poly else 16 * count)
        if count < 1 or at + size > end:
            faults.append(f"{file}, byte {at}: curve {len(segments)} has {count} points, expected as many as the rest of the file holds")
            return segments
        if poly:
            powers = np.vander(np.linspace(0.0, 1.0, count), 3, increasing=True)
            points = powers @ np.frombuffer(data, "<f8", 6, at + 16).reshape(2, 3).T
        else:
            points = np.frombuffer(data, "<f4", 2 * count, at + 12).reshape(2, count).T.astype(np.float64)
        segments.append((frame, number, points))
        at += size
    written = struct.unpack_from("<i", data, end)[0] if at == end else None
    if written != len(segments):
        faults.append(f"{file}: has {len(segments)} curves, expected {written}, the number at its end")
    return segments


def _text_whiskers(file: _File, faults: list[str]) -> list[_Segment]:
    """Lines of frame, id, frame and number of points, then x, y, thickness and score of each point."""
    segments: list[_Segment] = []
    for line, cells in _csv_rows(file)[1:]:
        where = f"{file}, line {line}"
        head = [_integer(cell, f"{where}: cell {k + 1}", faults) for k, cell in enumerate(cells[:4])]
        if len(head) < 4 or None in head or len(cells) != 4 + 4 * (head[3] or 0):
            faults.append(f"{where}: has {len(cells)} cells, expected frame, id, frame and n, then 4 for each of n points")
            continue
        values = [_number(cell, f"{where}: cell {k + 5}", faults) for k, cell in enumerate(cells[4:])]
        segments.append((head[0] or 0, head[1] or 0, np.array(values).reshape(-1, 4)[:, :2]))
    return segments


def _measurements(file: _File, faults: list[str]) -> dict[tuple[int, int], tuple[int, _Floats]]:
    """Frame and number of each curve of a ``.measurements`` file: its identity, and a point in pixels that is next to its base.

    The numbers of rows and of measures n (int32), then for each row ten int32 (row, frame, number, identity, x and y of the face, which measures
    are x and y of the follicle, whether velocities are valid, n), the axis of the face since version 2, n measures and n velocities (float64).
    """
    data = Path(file).read_bytes()
    # Bytes before the measures: version 2 has those of the machine that wrote it, 64 or 32 bits. Version 0 has no header, and pointers in the
    # rows; all measures are after all rows.
    sizes = {b"measV1\0\0": [40], b"measv2\0\0": [48, 44], b"measv3\0\0": [41]}.get(data[:8], [])
    at = 8 if sizes else 0
    old = not sizes and not data.startswith(b"meas")
    sizes = [56, 48] if old else sizes
    rows, n = struct.unpack_from("<2i", data, at) if len(data) >= at + 8 else (-1, -1)
    fitting = [size for size in sizes if rows >= 0 and n >= 0 and len(data) == at + 8 + rows * (size + 16 * n)]
    if not fitting:
        faults.append(f"{file}: has {len(data)} bytes for {rows} rows of {n} measures, expected measurements of WHISK, version 0 to 3")
        return {}
    head = ["row", "frame", "number", "label", "face_x", "face_y", "col_x", "col_y", "valid", "n"]
    fields: list[Any] = [(name, "<i4") for name in head] + [("rest", f"V{fitting[0] - 40}")] * (fitting[0] > 40)
    fields += [] if old else [("measures", "<f8", (n,)), ("velocities", "<f8", (n,))]
    found: dict[tuple[int, int], tuple[int, _Floats]] = {}
    for row in np.frombuffer(data, np.dtype(fields), rows, at + 8):
        frame, number, x, y = (int(row[name]) for name in ("frame", "number", "col_x", "col_y"))
        known = not old and 0 <= x < n and 0 <= y < n and x != y
        point = row["measures"][[x, y]] if known else np.array([row["face_x"], row["face_y"]], dtype=np.float64)
        if (frame, number) in found:
            faults.append(f"{file}, frame {frame}: curve {number} is there twice, expected each curve once")
        found[frame, number] = int(row["label"]), point
    return found


_HEADERS = [["scorer", "bodyparts", "coords"], ["scorer", "individuals", "bodyparts", "coords"]]
_Table = tuple[dict[str, list[str]], list[int], _Floats]


def _deeplabcut_csv(file: _File, faults: list[str]) -> _Table:
    """The rows of the header by their names, the frames, and the numbers of a CSV file."""
    rows = _csv_rows(file)
    header = next((names for names in _HEADERS if [row[0] for _, row in rows[: len(names)]] == names), None)
    if header is None:
        begins = _some([row[0] for _, row in rows[:4]])
        raise ValueError(f"{file}, line 1: the lines begin with {begins}, expected {' or '.join(map(_some, _HEADERS))}")
    names = {name: row[1:] for name, (_, row) in zip(header, rows, strict=False)}
    width = len(rows[0][1])
    for line, row in rows:
        if len(row) != width:
            faults.append(f"{file}, line {line}: has {len(row)} cells, expected {width}")
    _refuse(faults)
    body = rows[len(header) :]
    frames = [_integer(row[0], f"{file}, line {line}: the frame", faults) for line, row in body]
    values = [
        [_number(cell, f"{file}, line {line}, column {k + 2}: the cell", faults, gaps=True) for k, cell in enumerate(row[1:])] for line, row in body
    ]
    _refuse(faults)
    return names, [frame for frame in frames if frame is not None], np.array(values).reshape(len(body), width - 1)


def _deeplabcut_hdf(file: _File, faults: list[str]) -> _Table:
    """The same of an HDF5 file."""
    pandas = _optional("pandas")
    _optional("tables")
    try:
        table = pandas.read_hdf(file)
    except (ValueError, KeyError, TypeError, AttributeError, RuntimeError) as error:
        raise ValueError(f"{file}: has no table of pandas that can be read ({error}), expected one") from error
    names = list(getattr(table, "columns", pandas.Index([])).names)
    if names not in _HEADERS:
        raise ValueError(f"{file}: the columns have the levels {_some(names)}, expected {' or '.join(map(_some, _HEADERS))}")
    frames = [_integer(index, f"{file}, row {k}: the frame", faults) for k, index in enumerate(table.index)]
    _refuse(faults)
    levels = {name: [str(value) for value in table.columns.get_level_values(name)] for name in names}
    return levels, [frame for frame in frames if frame is not None], table.to_numpy(dtype=np.float64)


_Tracked = tuple[list[int], _Floats, _Floats, _Floats]


def _track_of(file: _File, track: int | str, names: list[str], count: int) -> int:
    """The place of a track among those that are there."""
    if isinstance(track, str) and track in names:
        return names.index(track)
    if not isinstance(track, str) and 0 <= track < count:
        return track
    expected = f"a number from 0 to {count - 1}" if count else "a track: the file has none"
    raise ValueError(f"{file}: track is {track!r}, expected {expected}" + (f", or one of {_some(names)}" if names else ""))


def _sleap_hdf5(file: _File, nodes: list[str] | None, track: int | str, faults: list[str]) -> _Tracked:
    """Frames, and x, y and scores of shape (frames, nodes), of one track of an HDF5 file."""
    with _hdf5(file) as stored:
        _missing(file, "the dataset", ["tracks", "node_names"], list(stored), faults)
        _refuse(faults)
        known, tracks = (
            [name.decode() for name in stored[key][()].tolist()] if key in stored else [] for key in ("node_names", "track_names")
        )
        order = json.loads(stored["tracks"].attrs.get("dims", '["track", "xy", "node", "frame"]'))
        shape = stored["tracks"].shape
        sizes = dict(zip(order, shape, strict=False))
        if len(shape) != 4 or set(sizes) != {"track", "xy", "node", "frame"} or sizes["xy"] != 2 or sizes["node"] != len(known):
            faults.append(f"{file}: tracks has the shape {shape} in the order {order}, expected 2 for xy and {len(known)} for node")
        points = stored["tracks"][()]
        scores = stored["point_scores"][()] if "point_scores" in stored else None
    flat = [name for name in order if name != "xy"]
    if scores is not None and scores.shape != tuple(sizes.get(name) for name in flat):
        faults.append(f"{file}: point_scores has the shape {scores.shape}, expected that of tracks, {shape}, without xy")
    nodes = known if nodes is None else nodes
    _missing(file, "the node", nodes, known, faults)
    _refuse(faults)
    columns = [known.index(name) for name in nodes]
    place = _track_of(file, track, tracks, sizes["track"])
    x, y = points.transpose([order.index(name) for name in ("track", "xy", "frame", "node")])[place][:, :, columns]
    if scores is None:
        scores = np.full(x.shape, np.nan)
    else:
        scores = scores.transpose([flat.index(name) for name in ("track", "frame", "node")])[place][:, columns]
    return list(range(len(x))), x.astype(np.float64), y.astype(np.float64), scores.astype(np.float64)


def _sleap_csv(file: _File, nodes: list[str] | None, track: int | str, faults: list[str]) -> _Tracked:
    """The same of a CSV file."""
    rows = _csv_rows(file)
    header = rows[0][1] if rows else []
    known = [name[:-2] for name in header if name.endswith(".x")]
    _missing(file, "the column", ["track", "frame_idx"], header, faults)
    if nodes is None:
        faults.append(f"{file}: nodes is None, expected names from the base to the tip for a CSV file; there are {_some(known)}")
    _missing(file, "the node", nodes or [], known, faults)
    _missing(file, "the column", [f"{name}.y" for name in nodes or [] if name in known], header, faults)
    for line, row in rows[1:]:
        if len(row) != len(header):
            faults.append(f"{file}, line {line}: has {len(row)} cells, expected {len(header)}")
    _refuse(faults)
    lines = [(line, dict(zip(header, row, strict=True))) for line, row in rows[1:]]
    tracks = list(dict.fromkeys(row["track"] for _, row in lines))
    name = tracks[_track_of(file, track, tracks, len(tracks))] if tracks else ""
    lines = [(line, row) for line, row in lines if row["track"] == name]
    frames = [_integer(row["frame_idx"], f"{file}, line {line}: frame_idx", faults) for line, row in lines]
    x, y, scores = (
        np.array(
            [
                [_number(row.get(node + end, ""), f"{file}, line {line}: {node}{end}", faults, gaps=True) for node in nodes or []]
                for line, row in lines
            ]
        ).reshape(len(lines), -1 if lines else 0)
        for end in (".x", ".y", ".score")
    )
    _refuse(faults)
    return [frame for frame in frames if frame is not None], x, y, scores
