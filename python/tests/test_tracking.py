"""Readers of the files of trackers: small files in the layout of each tool, written here byte by byte or by h5py."""

from __future__ import annotations

import importlib
import math
import struct
from collections.abc import Callable
from pathlib import Path
from typing import Any

import numpy as np
import numpy.typing as npt
import pytest

from vibrissa.tracking import Frames, read_deeplabcut, read_frames, read_sleap, read_whisk, read_whiskiwrap

_Points = list[list[float]]

# Two frames of a curve from its tip, whose face is on the left; in pixels.
FIRST: _Points = [[30.0, 8.0], [20.0, 6.0], [10.0, 5.0]]
SECOND: _Points = [[31.0, 9.0], [10.5, 5.0]]
# What else is in frame 0, longer than the whisker.
FUR: _Points = [[0.0, 0.0], [90.0, 0.0]]
CURVES = [(0, 0, FUR), (1, 0, SECOND), (0, 1, FIRST)]


def fault(call: Callable[[], object]) -> str:
    with pytest.raises(ValueError) as caught:
        call()
    return str(caught.value)


# A point of the rod that was not seen.
UNSEEN = [math.nan, math.nan]


def expect(frames: Frames, expected: dict[int, _Points], scale: float, flip: float = -1.0) -> None:
    """The points of the frames are those in pixels, in this order, times the scale."""
    assert frames.numbers.tolist() == sorted(expected)
    assert len(frames) == len(expected)
    for number, points in expected.items():
        np.testing.assert_allclose(frames.of(number), np.array(points) * [scale, flip * scale], rtol=1e-7, atol=1e-15)


# Frames


def test_frames_of_points_are_sorted_by_frame_and_keep_their_order_within() -> None:
    frames = Frames.from_points({7: [[0.3, 0.0], [0.1, 0.2]], 2: [[1.0, 2.0], [3.0, 4.0], [5.0, 6.0]]})
    assert frames.frame.tolist() == [2, 2, 2, 7, 7]
    assert frames.frame.dtype == np.int64
    assert frames.of(7).tolist() == [[0.3, 0.0], [0.1, 0.2]]
    assert np.isnan(frames.sigma).all()
    pairs = Frames.from_points((k, np.array([[0.0, k], [1.0, k]])) for k in range(3))
    assert pairs.y.tolist() == [0.0, 0.0, 1.0, 1.0, 2.0, 2.0]
    with pytest.raises(ValueError, match="read-only"):
        frames.x[0] = 1.0


def test_frames_refuse_what_is_none() -> None:
    one = np.array([0, 0])
    x = np.array([0.0, 1.0])
    assert "frame 4 does not exist, expected one of 0" in fault(lambda: Frames(one, x, x, x + 1.0).of(4))
    assert "expected one dimension and the same length" in fault(lambda: Frames(one, x, x[:1], x))
    assert "frame has entries of type float64, expected integers" in fault(lambda: Frames(x, x, x, x))
    assert "frame 1: sigma is 0.0, expected a positive number" in fault(lambda: Frames(one + 1, x, x, x))
    assert "points, frame 3: has the shape (2,), expected (n, 2)" in fault(lambda: Frames.from_points({3: [1.0, 2.0]}))
    assert "points, frame 3: has one point, expected at least two" in fault(lambda: Frames.from_points({3: [[1.0, 2.0]]}))
    assert "no frame is left" in fault(lambda: Frames.from_points({}))
    twice = [(1, [[0.0, 0.0], [1.0, 0.0]])] * 2
    assert "points, frame 1: is there twice, expected each frame once" in fault(lambda: Frames.from_points(twice))
    falls = np.array([3, 3, 2, 2])
    assert "frame 2 comes after frame 3" in fault(lambda: Frames(falls, *np.ones((3, 4))))


def test_five_faults_are_named_and_the_others_counted() -> None:
    lines = fault(lambda: Frames.from_points({k: [[0.0, 0.0]] for k in range(8)})).splitlines()
    assert len(lines) == 6
    assert lines[4] == "points, frame 4: has one point, expected at least two"
    assert lines[5] == "and 3 more"


# CSV


def test_a_csv_file_is_read_back_without_a_difference(tmp_path: Path) -> None:
    values = np.random.default_rng(1).normal(size=(3, 6))
    for sigma, header in ((np.full(6, np.nan), "frame,x,y"), (np.abs(values[2]), "frame,x,y,sigma")):
        sigma[4] = np.nan
        frames = Frames(np.array([1, 1, 5, 5, 5, 5]), values[0], values[1], sigma)
        frames.write_csv(tmp_path / "a.csv")
        assert (tmp_path / "a.csv").read_text().splitlines()[0] == header
        again = read_frames(tmp_path / "a.csv")
        for name in ("frame", "x", "y", "sigma"):
            np.testing.assert_array_equal(getattr(again, name), getattr(frames, name))


def test_a_csv_file_is_scaled_and_flipped_on_demand(tmp_path: Path) -> None:
    file = tmp_path / "a.csv"
    file.write_text("y,frame,sigma,x,note\n2,0,0.5,1,a\n4,0,,3,b\n")
    expect(read_frames(file), {0: [[1, 2], [3, 4]]}, 1.0, flip=1.0)
    frames = read_frames(file, scale=1e-3, image=True)
    expect(frames, {0: [[1, 2], [3, 4]]}, 1e-3)
    np.testing.assert_array_equal(frames.sigma, [0.5e-3, np.nan])


def test_a_csv_file_with_faults_names_their_lines(tmp_path: Path) -> None:
    file = tmp_path / "a.csv"

    def read(text: str, **arguments: Any) -> str:
        file.write_text(text)
        return fault(lambda: read_frames(file, **arguments))

    assert read("frame,x\n") == f"{file}, line 1: the column 'y' is missing, expected frame,x,y or frame,x,y,sigma; there are frame, x"
    assert "the column 'frame' is missing" in read("")
    assert read("frame,x,y\n3,0,0\n3,1,0\n2,0,0\n2,1,0\n") == (
        f"{file}, line 4: frame 2 comes after frame 3, expected frames that do not decrease"
    )
    assert read("frame,x,y\n0,a,0\n0.5,1,b\n0,1\n0,inf,1\n").splitlines() == [
        f"{file}, line 2: x is 'a', expected a finite number",
        f"{file}, line 3: frame is '0.5', expected an integer",
        f"{file}, line 3: y is 'b', expected a finite number",
        f"{file}, line 4: has 2 cells, expected 3",
        f"{file}, line 5: x is 'inf', expected a finite number",
    ]
    assert read("frame,x,y\n0,0,0\n1,0,0\n1,1,0\n") == f"{file}, frame 0: has one point, expected at least two"
    assert read("frame,x,y\n") == f"{file}: no frame is left, expected at least one of two points"
    assert read("frame,x,y,sigma\n0,0,0,-1\n0,1,1,1\n").startswith(f"{file}, frame 0: sigma is -1.0, expected a positive number")
    for scale in (0.0, -1.0, float("nan")):
        assert f"scale is {scale}, expected a positive number, m for a pixel" in read("frame,x,y\n0,0,0\n0,1,1\n", scale=scale)
    file.write_bytes(b"\xff\xfe\x00")
    assert "is not text" in fault(lambda: read_frames(file))


# WHISK


def whiskbin(curves: list[tuple[int, int, _Points]]) -> bytes:
    """whisker_io_whiskbin1.c."""
    data = b"bwhiskbin1\0\0"
    for frame, number, points in curves:
        x, y = np.array(points, dtype="<f4").T
        data += struct.pack("<3i", number, frame, len(points)) + x.tobytes() + y.tobytes()
        data += np.full(len(points), 1.5, "<f4").tobytes() + np.full(len(points), 900.0, "<f4").tobytes()
    return data + struct.pack("<i", len(curves))


def whiskpoly(curves: list[tuple[int, int, int, list[float], list[float]]]) -> bytes:
    """whisker_io_whiskpoly1.c."""
    data = b"bwhiskpoly1\0\0"
    for frame, number, count, px, py in curves:
        data += struct.pack("<3if6d", number, frame, count, 900.0, *px, *py)
    return data + struct.pack("<i", len(curves))


_Row = tuple[int, int, int, tuple[float, float], tuple[float, float]]


def measured(version: int, rows: list[_Row], bits: int = 64) -> bytes:
    """measurements_io_v0.c to measurements_io_v3.c; rows of frame, number, identity, follicle and tip, the last row first."""
    data = {0: b"", 1: b"measV1\0\0", 2: b"measv2\0\0", 3: b"measv3\0\0"}[version] + struct.pack("<2i", len(rows), 8)
    rest = {0: b"\x07" * (bits // 4), 1: b"", 2: b"y" + b"\x07" * (bits // 8 - 1), 3: b"y"}[version]
    values = b""
    for k, (frame, number, label, follicle, tip) in reversed(list(enumerate(rows))):
        head = struct.pack("<10i", k, frame, number, label, -50, 5, 4, 5, 0, 8) + rest
        numbers = struct.pack("<16d", 99.0, 900.0, 45.0, 0.01, *follicle, *tip, *range(8))
        data += head if version == 0 else head + numbers
        values += numbers
    return data + values if version == 0 else data


ROWS: list[_Row] = [(0, 0, -1, (0.0, 0.0), (90.0, 0.0)), (1, 0, 0, (10.5, 5.0), (31.0, 9.0)), (0, 1, 0, (10.0, 5.0), (30.0, 8.0))]


@pytest.fixture
def whisk(tmp_path: Path) -> tuple[Path, Path]:
    files = tmp_path / "a.whiskers", tmp_path / "a.measurements"
    files[0].write_bytes(whiskbin(CURVES))
    files[1].write_bytes(measured(3, ROWS))
    return files


@pytest.mark.parametrize(("version", "bits"), [(0, 64), (0, 32), (1, 64), (2, 64), (2, 32), (3, 64)])
def test_whisk_curves_of_an_identity_run_from_the_follicle(whisk: tuple[Path, Path], version: int, bits: int) -> None:
    whisk[1].write_bytes(measured(version, ROWS, bits))
    frames = read_whisk(*whisk, whisker=0, scale=2e-5)
    expect(frames, {0: FIRST[::-1], 1: SECOND[::-1]}, 2e-5)
    assert np.isnan(frames.sigma).all()


def test_whisk_follicles_outrank_the_face(whisk: tuple[Path, Path]) -> None:
    # The face at x = -50 is next to the other end.
    whisk[1].write_bytes(measured(3, [(0, 1, 2, (30.0, 8.0), (10.0, 5.0))]))
    expect(read_whisk(*whisk, whisker=2, scale=1.0), {0: FIRST}, 1.0)
    expect(read_whisk(*whisk, whisker=2, base="last", scale=1.0, image=False), {0: FIRST[::-1]}, 1.0, flip=1.0)


def test_whisk_without_measurements(whisk: tuple[Path, Path]) -> None:
    curves = whisk[0]
    expect(read_whisk(curves, whisker=1, base="last", scale=1e-3), {0: FIRST[::-1]}, 1e-3)
    for order in (CURVES, CURVES[::-1]):
        curves.write_bytes(whiskbin(order))
        expect(read_whisk(curves, base="first", scale=1e-3), {0: FUR, 1: SECOND}, 1e-3)
    assert "base is None, expected 'first' or 'last', as there are no measurements" in fault(lambda: read_whisk(curves, scale=1.0))


def test_whisk_in_the_other_formats(tmp_path: Path) -> None:
    file = tmp_path / "a.whiskers"
    file.write_bytes(whiskpoly([(3, 0, 3, [10.0, 20.0, 4.0], [5.0, 0.0, 8.0])]))
    expect(read_whisk(file, base="first", scale=0.5), {3: [[10, 5], [21, 7], [34, 13]]}, 0.5)
    file.write_text("whisker1 (frame,id,time,n,x1,y1,thick1,score1...,xn,yn,thickn,scoren)\n3,0,3,2,1.5,2,1,9,4,5,1,9\n")
    expect(read_whisk(file, base="last", scale=0.5), {3: [[4, 5], [1.5, 2]]}, 0.5)
    file.write_text("whisker1 (...)\n3,0,3,2,1.5,2,1,9\n3,0,3,1,a,2,1,9\n")
    assert fault(lambda: read_whisk(file, base="last", scale=0.5)).splitlines() == [
        f"{file}, line 2: has 8 cells, expected frame, id, frame and n, then 4 for each of n points",
        f"{file}, line 3: cell 5 is 'a', expected a finite number",
    ]


def test_whisk_files_with_faults(whisk: tuple[Path, Path]) -> None:
    curves, measurements = whisk

    def read(**arguments: Any) -> str:
        return fault(lambda: read_whisk(curves, measurements, **({"whisker": 0, "scale": 1.0} | arguments)))

    assert read(whisker=5) == f"{measurements}: no curve is whisker 5, expected one of -1, 0"
    assert read(scale=-2.0, base="end").splitlines() == [
        "scale is -2.0, expected a positive number, m for a pixel",
        "base is 'end', expected 'first' or 'last'",
    ]
    measurements.write_bytes(measured(3, [*ROWS, (9, 4, 0, (0.0, 0.0), (1.0, 1.0))]))
    assert read() == f"{measurements}, frame 9: curve 4 is not in {curves}, expected measurements of that file"
    measurements.write_bytes(measured(3, [(frame, number, 0, *ends) for frame, number, _, *ends in ROWS]))  # type: ignore[misc]
    assert read() == f"{curves}, frame 0: the curves 0, 1 are this whisker, expected one curve"
    measurements.write_bytes(measured(3, ROWS)[:-8])
    assert "for 3 rows of 8 measures, expected measurements of WHISK, version 0 to 3" in read()
    measurements.write_bytes(b"")
    assert "has 0 bytes" in read()
    measurements.write_bytes(measured(3, ROWS))
    good = whiskbin(CURVES)
    curves.write_bytes(good[:-40])
    assert f"{curves}, byte " in read() and "curve 2 has 3 points, expected as many as the rest of the file holds" in read()
    curves.write_bytes(good[:-4] + struct.pack("<i", 7))
    assert read() == f"{curves}: has 3 curves, expected 7, the number at its end"
    curves.write_bytes(b"RIFF....")
    assert "begins with b'RIFF....', expected bwhiskbin1, bwhiskpoly1 or whisker1" in read()
    curves.write_bytes(whiskbin([(0, 0, [[1.0, 1.0]]), (1, 0, SECOND)]))
    assert fault(lambda: read_whisk(curves, base="first", scale=1.0)) == f"{curves}, frame 0: has one point, expected at least two"
    assert fault(lambda: read_whisk(curves, base="first", whisker=3, scale=1.0)) == (
        f"{curves}: no curve has the number 3, expected one of 0"
    )


# WhiskiWrap


def whiskiwrap(file: Path, curves: list[tuple[int, int, _Points]], follicles: bool, rows: int | None = None) -> None:
    """setup_hdf5 and append_whiskers_to_hdf5 of base.py."""
    h5py = pytest.importorskip("h5py")
    columns = [("time", "<u4"), ("id", "<u2"), ("fol_x", "<f4"), ("fol_y", "<f4"), ("pixlen", "<u2")] + [("angle", "<f4")] * follicles
    summary = np.zeros(len(curves), dtype=columns)
    with h5py.File(file, "w") as stored:
        for name, axis in (("pixels_x", 0), ("pixels_y", 1)):
            pixels = stored.create_dataset(name, (len(curves),), dtype=h5py.vlen_dtype(np.dtype("<f4")))
            for k, (_, _, points) in enumerate(curves):
                pixels[k] = np.array(points, dtype="<f4")[:, axis]
        for k, (frame, number, points) in enumerate(curves):
            base = points[-1 if follicles else 0]
            summary[k] = (frame, number, *base, len(points), 0.0)[: len(columns)]
        stored.create_dataset("summary", data=summary[:rows])


def test_whiskiwrap(tmp_path: Path) -> None:
    file = tmp_path / "a.hdf5"
    whiskiwrap(file, CURVES, follicles=True)
    expect(read_whiskiwrap(file, whisker=1, scale=1e-4), {0: FIRST[::-1]}, 1e-4)
    expect(read_whiskiwrap(file, scale=1e-4), {0: FUR[::-1], 1: SECOND[::-1]}, 1e-4)
    expect(read_whiskiwrap(file, base="first", scale=1e-4, image=False), {0: FUR, 1: SECOND}, 1e-4, flip=1.0)
    whiskiwrap(file, CURVES, follicles=False)
    expect(read_whiskiwrap(file, base="last", scale=1e-4), {0: FUR[::-1], 1: SECOND[::-1]}, 1e-4)
    assert fault(lambda: read_whiskiwrap(file, scale=1e-4)) == (
        "base is None, expected 'first' or 'last', as there are no measured follicles in the file"
    )


def test_whiskiwrap_files_with_faults(tmp_path: Path) -> None:
    h5py = pytest.importorskip("h5py")
    file = tmp_path / "a.hdf5"
    whiskiwrap(file, CURVES, follicles=True)
    assert fault(lambda: read_whiskiwrap(file, whisker=6, scale=1.0)) == f"{file}: no curve has the id 6, expected one of 0, 1"
    whiskiwrap(file, CURVES, follicles=True, rows=2)
    assert fault(lambda: read_whiskiwrap(file, scale=1.0)) == (
        f"{file}: summary, pixels_x and pixels_y have [2, 3, 3] rows, expected as many in each"
    )
    with h5py.File(file, "w") as stored:
        stored["summary"] = np.zeros(1)
    assert fault(lambda: read_whiskiwrap(file, scale=1.0)).splitlines() == [
        f"{file}: the dataset 'pixels_x' is missing, expected one of summary",
        f"{file}: the dataset 'pixels_y' is missing, expected one of summary",
    ]
    file.write_text("frame,x,y\n")
    assert fault(lambda: read_whiskiwrap(file, scale=1.0)) == f"{file}: is not an HDF5 file, expected one"
    file.write_bytes(b"\x89HDF\r\n\x1a\nx")
    assert "is damaged" in fault(lambda: read_whiskiwrap(file, scale=1.0))


def test_readers_name_the_package_that_is_missing(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    file = tmp_path / "a.h5"
    file.write_bytes(b"\x89HDF\r\n\x1a\n")

    def missing(name: str, package: str | None = None) -> Any:
        raise ImportError(name)

    monkeypatch.setattr(importlib, "import_module", missing)
    with pytest.raises(ImportError, match=r"needs h5py: pip install vibrissa\[tracking\]"):
        read_sleap(file, scale=1.0)
    with pytest.raises(ImportError, match=r"needs pandas: pip install vibrissa\[tracking\]"):
        read_deeplabcut(file, ["a", "b"], scale=1.0)


# DeepLabCut

PARTS = ["tip", "base", "mid"]
# By frame: x, y, likelihood of each part.
POSES = np.array(
    [
        [[30.0, 3.0, 0.9], [10.0, 1.0, 1.0], [20.0, 2.0, 0.64]],
        [[31.0, 3.0, 0.1], [11.0, 1.0, 0.9], [np.nan, np.nan, np.nan]],
        [[32.0, 3.0, 0.2], [12.0, 1.0, 0.6], [22.0, 2.0, 0.81]],
    ]
)


def deeplabcut(poses: npt.NDArray[np.float64], individuals: list[str] | None = None, frames: list[object] | None = None) -> str:
    """create_df_from_prediction and DataFrame.to_csv; the same poses for each individual, a pixel further."""
    owners = individuals or ["x"]
    cells = [(owner, part, coord) for owner in owners for part in PARTS for coord in ("x", "y", "likelihood")]
    lines = [["scorer", *["DLC"] * len(cells)], ["bodyparts", *[c[1] for c in cells]], ["coords", *[c[2] for c in cells]]]
    if individuals:
        lines.insert(1, ["individuals", *[c[0] for c in cells]])
    for k, pose in enumerate(poses):
        numbers = np.concatenate([(pose + [j, j, 0.0]).ravel() for j in range(len(owners))])
        lines.append([str(frames[k] if frames else k), *["" if np.isnan(value) else repr(float(value)) for value in numbers]])
    return "".join(",".join(line) + "\n" for line in lines)


def test_deeplabcut_points_in_the_order_of_the_argument(tmp_path: Path) -> None:
    file = tmp_path / "a.csv"
    file.write_text(deeplabcut(POSES))
    frames = read_deeplabcut(file, ["base", "mid", "tip"], scale=1e-4)
    # In frame 1 only the base is left, in frame 2 the tip is not likely enough.
    expect(frames, {0: [[10, 1], [20, 2], [30, 3]], 2: [[12, 1], [22, 2], UNSEEN]}, 1e-4)
    assert np.isnan(frames.sigma).all()
    frames = read_deeplabcut(file, ["base", "mid", "tip"], scale=1e-4, pixel_sigma=0.5, least_likelihood=0.0, image=False)
    expect(frames, {0: [[10, 1], [20, 2], [30, 3]], 1: [[11, 1], UNSEEN, [31, 3]], 2: [[12, 1], [22, 2], [32, 3]]}, 1e-4, flip=1.0)
    np.testing.assert_allclose(frames.sigma[:3], 0.5e-4 / np.sqrt([1.0, 0.64, 0.9]))
    file.write_text(deeplabcut(POSES).replace("0.9,", "0.0,"))
    frames = read_deeplabcut(file, ["base", "mid", "tip"], scale=1e-4, pixel_sigma=0.5, least_likelihood=0.0)
    expect(frames, {0: [[10, 1], [20, 2], UNSEEN], 2: [[12, 1], [22, 2], [32, 3]]}, 1e-4)


def test_deeplabcut_individuals(tmp_path: Path) -> None:
    file = tmp_path / "a.csv"
    file.write_text(deeplabcut(POSES, ["m1", "m2"]))
    for individual, j in (("m1", 0), ("m2", 1)):
        frames = read_deeplabcut(file, ["base", "tip"], individual=individual, scale=1.0)
        expect(frames, {0: [[10 + j, 1 + j], [30 + j, 3 + j]]}, 1.0)
    assert fault(lambda: read_deeplabcut(file, ["base", "tip"], scale=1.0)) == f"{file}: individual is None, expected one of m1, m2"
    assert "individual is 'm3', expected one of m1, m2" in fault(lambda: read_deeplabcut(file, ["base", "tip"], individual="m3", scale=1.0))
    file.write_text(deeplabcut(POSES, ["m1"]))
    expect(read_deeplabcut(file, ["base", "tip"], scale=1.0), {0: [[10, 1], [30, 3]]}, 1.0)


def test_deeplabcut_hdf5(tmp_path: Path) -> None:
    pandas = pytest.importorskip("pandas")
    pytest.importorskip("tables")
    for individuals in (None, ["m1", "m2"]):
        (tmp_path / "a.csv").write_text(deeplabcut(POSES, individuals))
        table = pandas.read_csv(tmp_path / "a.csv", header=[0, 1, 2, 3] if individuals else [0, 1, 2], index_col=0)
        table.to_hdf(tmp_path / "a.h5", key="df_with_missing", format="table", mode="w")
        chosen: Any = {"individual": individuals and individuals[1], "scale": 1e-3, "pixel_sigma": 1.0}
        text, binary = (read_deeplabcut(tmp_path / name, ["base", "mid", "tip"], **chosen) for name in ("a.csv", "a.h5"))
        for name in ("frame", "x", "y", "sigma"):
            np.testing.assert_array_equal(getattr(text, name), getattr(binary, name))
    pandas.DataFrame({"a": [1.0]}).to_hdf(tmp_path / "b.h5", key="b")
    assert "the columns have the levels None, expected scorer, bodyparts, coords or" in fault(
        lambda: read_deeplabcut(tmp_path / "b.h5", ["a", "b"], scale=1.0)
    )


def test_deeplabcut_files_with_faults(tmp_path: Path) -> None:
    file = tmp_path / "a.csv"

    def read(text: str, bodyparts: Any = ("base", "tip"), **arguments: Any) -> str:
        file.write_text(text)
        return fault(lambda: read_deeplabcut(file, bodyparts, **({"scale": 1.0} | arguments)))

    good = deeplabcut(POSES)
    assert read(good, ["base", "end"]) == f"{file}: the body part 'end' is missing, expected one of tip, base, mid"
    assert read(good, "base").startswith("bodyparts is 'base', expected at least two names")
    assert read(good, individual="m1") == f"{file}: individual is 'm1', expected None: the file has no individuals"
    assert read(good, scale=0.0, least_likelihood=2.0, pixel_sigma=0.0).splitlines() == [
        "scale is 0.0, expected a positive number, m for a pixel",
        "least_likelihood is 2.0, expected a number from 0 to 1",
        "pixel_sigma is 0.0, expected a positive number of pixels, or None",
    ]
    unknown = POSES.copy()
    unknown[0, 0, 2] = np.nan
    assert read(deeplabcut(unknown)) == f"{file}, frame 0: the likelihood of 'tip' is missing, expected a number from 0 to 1"
    assert read(deeplabcut(POSES, frames=[0, 2, 1])) == f"{file}: frame 1 comes after frame 2, expected frames that increase"
    assert read(deeplabcut(POSES, frames=[0, 1, 1])) == f"{file}, frame 1: is there twice, expected each frame once"
    assert read(deeplabcut(POSES, frames=["img0.png", 1, 2])) == f"{file}, line 4: the frame is 'img0.png', expected an integer"
    assert read(good.replace("30.0", "much")) == f"{file}, line 4, column 2: the cell is 'much', expected a finite number"
    assert read(good.replace("30.0,", "")) == f"{file}, line 4: has 9 cells, expected 10"
    assert read(good, least_likelihood=1.0) == (
        f"{file}: no frame has two points of a likelihood of 1.0 or more, expected a smaller least_likelihood"
    )
    assert "the lines begin with frame, 0, expected scorer, bodyparts, coords or scorer, individuals" in read("frame,x,y\n0,1,2\n")
    assert "of the body part 'base' the column 'likelihood' is missing, expected one of x, y" in read(good.replace("likelihood", "z"))
    assert "there are several scorers" in read(good.replace("DLC", "DLD", 1))


# SLEAP

NODES = ["tip", "base", "mid"]


def sleap_arrays() -> tuple[npt.NDArray[np.float64], npt.NDArray[np.float64]]:
    """tracks of shape (tracks, 2, nodes, frames) and point_scores of shape (tracks, nodes, frames): 2 tracks, 3 nodes, 4 frames."""
    tracks = np.full((2, 2, 3, 4), np.nan)
    scores = np.full((2, 3, 4), np.nan)
    for k, pose in enumerate(POSES):
        tracks[1, :, :, k + 1] = pose[:, :2].T
        scores[1, :, k + 1] = pose[:, 2]
    tracks[0, :, :, 0] = [[5.0, 6.0, 7.0], [1.0, 1.0, 1.0]]
    return tracks, scores


def sleap(file: Path, dims: list[str] | None = None, names: tuple[str, ...] = ("a", "b"), **changed: Any) -> None:
    """write_occupancy_file of write_tracking_h5.py; with ``dims`` as analysis_h5.py does."""
    h5py = pytest.importorskip("h5py")
    tracks, scores = sleap_arrays()
    stored = {"tracks": tracks, "point_scores": scores, "node_names": [s.encode() for s in NODES], "track_names": [s.encode() for s in names]}
    if dims:
        old = ["track", "xy", "node", "frame"]
        stored["tracks"] = tracks.transpose([old.index(name) for name in dims])
        old.remove("xy")
        stored["point_scores"] = scores.transpose([old.index(name) for name in dims if name != "xy"])
    with h5py.File(file, "w") as out:
        for key, value in (stored | changed).items():
            if value is not None:
                out.create_dataset(key, data=value)
        if dims:
            out["tracks"].attrs["dims"] = str(dims).replace("'", '"')


@pytest.mark.parametrize("dims", [None, ["frame", "track", "node", "xy"]])
def test_sleap_hdf5(tmp_path: Path, dims: list[str] | None) -> None:
    file = tmp_path / "a.h5"
    sleap(file, dims)
    for track in (1, "b"):
        frames = read_sleap(file, ["base", "mid", "tip"], track=track, scale=1e-4)
        expect(frames, {1: [[10, 1], [20, 2], [30, 3]], 3: [[12, 1], [22, 2], [32, 3]]}, 1e-4)
    frames = read_sleap(file, ["base", "mid", "tip"], track=1, scale=1e-4, least_score=0.3)
    expect(frames, {1: [[10, 1], [20, 2], [30, 3]], 3: [[12, 1], [22, 2], UNSEEN]}, 1e-4)
    # Set by hand, without scores; nodes in the order of the skeleton.
    expect(read_sleap(file, scale=1.0, image=False), {0: [[5, 1], [6, 1], [7, 1]]}, 1.0, flip=1.0)


def test_sleap_hdf5_without_tracks(tmp_path: Path) -> None:
    file = tmp_path / "a.h5"
    tracks, scores = sleap_arrays()
    sleap(file, names=(), tracks=tracks[1:], point_scores=scores[1:])
    expect(read_sleap(file, ["base", "tip"], scale=1.0), {1: [[10, 1], [30, 3]], 3: [[12, 1], [32, 3]]}, 1.0)
    assert fault(lambda: read_sleap(file, track="b", scale=1.0)) == f"{file}: track is 'b', expected a number from 0 to 0"


def test_sleap_hdf5_files_with_faults(tmp_path: Path) -> None:
    file = tmp_path / "a.h5"
    sleap(file)
    assert fault(lambda: read_sleap(file, track="c", scale=1.0)) == f"{file}: track is 'c', expected a number from 0 to 1, or one of a, b"
    assert "track is 2, expected a number from 0 to 1" in fault(lambda: read_sleap(file, track=2, scale=1.0))
    assert fault(lambda: read_sleap(file, ["base", "end"], scale=1.0)) == f"{file}: the node 'end' is missing, expected one of tip, base, mid"
    assert "nodes is ['base'], expected at least two names" in fault(lambda: read_sleap(file, ["base"], scale=1.0))
    assert "no frame is left" in fault(lambda: read_sleap(file, track=1, least_score=1.5, scale=1.0))
    sleap(file, point_scores=np.zeros((2, 3, 5)), tracks=np.zeros((2, 3, 3, 4)))
    assert fault(lambda: read_sleap(file, scale=1.0)).splitlines() == [
        f"{file}: tracks has the shape (2, 3, 3, 4) in the order ['track', 'xy', 'node', 'frame'], expected 2 for xy and 3 for node",
        f"{file}: point_scores has the shape (2, 3, 5), expected that of tracks, (2, 3, 3, 4), without xy",
    ]
    sleap(file, tracks=None)
    assert "the dataset 'tracks' is missing, expected one of node_names, point_scores, track_names" in fault(
        lambda: read_sleap(file, scale=1.0)
    )


def sleap_csv() -> str:
    """write_csv_file of write_tracking_h5.py."""
    tracks, scores = sleap_arrays()
    lines = ["track,frame_idx,instance.score," + ",".join(f"{n}.x,{n}.y,{n}.score" for n in NODES)]
    for frame in range(4):
        for track, name in enumerate("ab"):
            points = tracks[track, :, :, frame]
            if not np.isnan(points).all():
                cells = np.vstack([points, scores[track, :, frame]]).T.ravel()
                lines.append(f"{name},{frame},0.9," + ",".join("" if np.isnan(value) else repr(float(value)) for value in cells))
    return "\n".join(lines) + "\n"


def test_sleap_csv(tmp_path: Path) -> None:
    file = tmp_path / "a.csv"
    file.write_text(sleap_csv())
    for track in (1, "b"):
        frames = read_sleap(file, ["base", "mid", "tip"], track=track, scale=1e-4)
        expect(frames, {1: [[10, 1], [20, 2], [30, 3]], 3: [[12, 1], [22, 2], [32, 3]]}, 1e-4)
    # Tracks count in the order in which they begin.
    file.write_text(sleap_csv().replace("a,0", "c,0"))
    expect(read_sleap(file, ["tip", "mid"], scale=1.0), {0: [[5, 1], [7, 1]]}, 1.0)


def test_sleap_csv_files_with_faults(tmp_path: Path) -> None:
    file = tmp_path / "a.csv"

    def read(text: str, nodes: list[str] | None, **arguments: Any) -> str:
        file.write_text(text)
        return fault(lambda: read_sleap(file, nodes, **({"scale": 1.0} | arguments)))

    good = sleap_csv()
    assert read(good, None) == (
        f"{file}: nodes is None, expected names from the base to the tip for a CSV file; there are tip, base, mid"
    )
    assert read(good, ["base", "end"]) == f"{file}: the node 'end' is missing, expected one of tip, base, mid"
    assert "the column 'frame_idx' is missing" in read(good.replace("frame_idx", "frame"), ["base", "tip"])
    assert "the column 'base.y' is missing" in read(good.replace("base.y", "base.z"), ["base", "tip"])
    assert read(good.replace("30.0", "far"), ["base", "tip"], track="b") == f"{file}, line 3: tip.x is 'far', expected a finite number"
    assert read(good.replace("b,3", "b,2"), ["base", "tip"], track="b") == f"{file}, frame 2: is there twice, expected each frame once"
    assert read(good + "b,4\n", ["base", "tip"]) == f"{file}, line 6: has 2 cells, expected 12"
    header = good.splitlines()[0] + "\n"
    assert read(header, ["base", "tip"]) == f"{file}: no frame is left, expected at least one of two points"
    assert read("", ["base", "tip"]).startswith(f"{file}: the column 'track' is missing, expected one of none")
