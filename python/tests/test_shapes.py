"""Shapes, composites, shapes of one's own."""

from __future__ import annotations

import math
from pathlib import Path

import numpy as np
import numpy.typing as npt
import pytest
from conftest import Hump

import vibrissa

SHAPES: list[vibrissa.Shape] = [
    vibrissa.Line((0.0, 0.0), (1.0, 0.5)),
    vibrissa.Parabola((0.1, 0.2), 3.0),
    vibrissa.Parabola((0.1, 0.2), 3.0, x_from=-1.0),
    vibrissa.CircularArc((0.0, 1.0), 0.5, -math.pi, 0.0),
    vibrissa.EllipticArc((0.0, 0.0), (2.0, 1.0), 0.0, 2.0 * math.pi, rotation=0.3),
    vibrissa.Bezier([(0.0, 0.0), (1.0, 0.0), (1.0, 1.0)]),
    vibrissa.Bezier([(0.0, 0.0), (1.0, 0.0), (2.0, 0.0), (2.0, 1.0)]),
    vibrissa.Spline([(0.0, 0.0), (1.0, 0.2), (2.0, 0.0), (3.0, 0.5)]),
    vibrissa.Spline([(0.0, 0.0), (1.0, 0.2), (2.0, 0.0)], end="clamped", angle_from=0.3),
    vibrissa.Spline([(0.0, 0.0), (1.0, 0.0), (1.0, 1.0), (0.0, 1.0)], end="periodic"),
    vibrissa.Spline([(0.1 * k, 0.01 * (k % 2)) for k in range(20)], smoothing=0.01),
    vibrissa.Polygon([(0.0, 0.0), (1.0, 0.0), (0.0, 1.0)]),
    vibrissa.Svg("M0 0H1V1Z", scale=0.1),
    vibrissa.Graph(lambda x: [np.cos(x), -np.sin(x), -np.cos(x)], -3.0, 3.0),
    vibrissa.Curve(
        lambda t: [[np.cos(t), np.sin(t)], [-np.sin(t), np.cos(t)], [-np.cos(t), -np.sin(t)]], 0.0, 2.0 * math.pi
    ),
]


@pytest.mark.parametrize("shape", SHAPES, ids=repr)
def test_shapes_keep_the_contract(shape: vibrissa.Shape) -> None:
    # no fraction is a vertex, where a contour has two directions
    vibrissa.check_contract(shape, [0.013, 0.21, 0.4, 0.58, 0.77, 0.96])
    moved = shape.moved((0.3, -0.2), angle=0.7, scale=2.0)
    vibrissa.check_contract(moved, [0.013, 0.21, 0.77])
    frame = shape.frame(np.array([[0.1, 0.2], [0.3, 0.4]]))
    assert frame.shape == (5, 2, 2)
    gaps = shape.gap(np.array([0.0, 1.0]), 0.3)
    closest = shape.closest(np.array([0.0, 1.0]), 0.3)
    np.testing.assert_array_equal(closest["gap"], gaps)
    np.testing.assert_allclose(np.hypot(closest["x"] - [0.0, 1.0], closest["y"] - 0.3), np.abs(gaps), atol=1e-12)
    vibrissa.check_contract(shape.reversed(), [0.21])
    np.testing.assert_allclose(shape.reversed().gap(0.2, 0.3), -shape.gap(0.2, 0.3), atol=1e-12)


def test_a_moved_object_has_its_points_moved(parabolas: vibrissa.Composite) -> None:
    moved = parabolas.moved((0.1, 0.2), angle=0.3, scale=2.0)
    x, y, *_ = parabolas.frame(np.linspace(-0.05, 0.05, 11))
    u, v, *_ = moved.frame(moved.closest(0.1 + 2 * (x * math.cos(0.3) - y * math.sin(0.3)),
                                         0.2 + 2 * (x * math.sin(0.3) + y * math.cos(0.3)))["t"])
    np.testing.assert_allclose(u, 0.1 + 2 * (x * math.cos(0.3) - y * math.sin(0.3)), atol=1e-12)
    np.testing.assert_allclose(v, 0.2 + 2 * (x * math.sin(0.3) + y * math.cos(0.3)), atol=1e-12)
    again = vibrissa.Composite(
        [vibrissa.Parabola((0.0, 0.0), 50.0), vibrissa.Parabola((0.03, 0.0), 50.0)],
        position=(0.1, 0.2), angle=0.3, scale=2.0,
    )
    assert again.gap(0.0, 0.0) == moved.gap(0.0, 0.0)
    # a field of a packed structured array is not aligned
    packed = np.zeros(3, [("flag", "?"), ("x", "f8")])
    packed["x"] = [0.1, 0.2, 0.3]
    np.testing.assert_array_equal(moved.gap(packed["x"], 0.0), moved.gap([0.1, 0.2, 0.3], 0.0))
    with pytest.raises(ValueError, match=r"x and y have shapes \[3\] and \[2\]"):
        moved.gap([0.1, 0.2, 0.3], [0.0, 1.0])


def test_composites_know_what_they_are() -> None:
    square = vibrissa.Composite(vibrissa.Polygon([(0.0, 0.0), (1.0, 0.0), (1.0, 1.0), (0.0, 1.0)]))
    assert (square.pieces, square.is_closed, square.is_cavity, square.is_proven) == (4, True, False, True)
    assert square.reversed().is_cavity
    assert square.gap(2.0, 0.5) == 1.0 and square.reversed().gap(2.0, 0.5) == -1.0
    assert not vibrissa.Composite(Hump()).is_proven
    mirrored = vibrissa.Composite(vibrissa.Line((0.0, 1.0), (1.0, 1.0)), mirror=True)
    # the solid is above the line, and below its picture
    assert mirrored.gap(0.5, -0.5) == 0.5


def test_trimmed_shapes_end_where_they_are_cut() -> None:
    part = vibrissa.Parabola((0.0, 0.0), 50.0).trimmed(0.0, 0.01)
    assert part.range == (0.0, 0.01)
    assert part.gap(-0.03, 0.0) == pytest.approx(0.03)
    with pytest.raises(ValueError, match="the shape has several pieces"):
        vibrissa.Polygon([(0.0, 0.0), (1.0, 0.0), (0.0, 1.0)]).trimmed(0.0, 0.5)
    with pytest.raises(ValueError, match="expected the start to be less than the end"):
        part.trimmed(0.01, 0.0)


@pytest.mark.parametrize(
    ("make", "text"),
    [
        (lambda: vibrissa.CircularArc((0.0, 0.0), -1.0, 0.0, 1.0), "radius is -1, expected a positive number"),
        (lambda: vibrissa.Line((0.0, 0.0), (0.0, 0.0)), "two different points"),
        (lambda: vibrissa.Parabola((0.0, math.nan), 1.0), "y of the parabola's vertex is NaN, expected a finite number"),
        (lambda: vibrissa.Bezier([(0.0, 0.0)]), "control has 1 points, expected four or three"),
        (lambda: vibrissa.Spline([(0.0, 0.0), (1.0, 0.0)], end="open"),  # type: ignore[arg-type]
         'end is "open", expected "natural"'),
        (lambda: vibrissa.Polygon([(0.0, 0.0), (0.0, 0.0), (1.0, 0.0)]), "points: point"),
        (lambda: vibrissa.Svg("M0 0H1", scale=-1.0), "scale is -1, expected a positive"),
        (lambda: vibrissa.Composite([]), "at least one piece, got none"),
        (lambda: vibrissa.Graph(lambda x: [x, x], 0.0, 1.0), r"has shape \[2, 97\], expected an array of shape \(3, n\)"),
        (lambda: vibrissa.Composite(Hump()).moved(scale=0.0), "the motion's scale is 0, expected a positive number"),
    ],
)
def test_what_is_no_shape_says_why(make, text: str) -> None:  # type: ignore[no-untyped-def]
    with pytest.raises(ValueError, match=text):
        make()


def test_a_shape_of_ones_own_that_breaks_the_contract_is_refused() -> None:
    class Backwards(Hump):
        def frame(self, t: npt.NDArray[np.float64]) -> npt.NDArray[np.float64]:
            x, y, alpha, speed, turning = super().frame(t)
            return np.array([x, y, alpha, speed, -turning])

    with pytest.raises(ValueError, match="^3: over .* alpha goes from"):
        vibrissa.check_contract(Backwards())
    with pytest.raises(ValueError, match="breaks line 3 of the contract"):
        vibrissa.Composite(Backwards())


def test_an_exception_in_a_shape_of_ones_own_is_raised(rod: vibrissa.Rod, path: vibrissa.ClampPath) -> None:
    class Faulty(Hump):
        calls = 0

        def frame(self, t: npt.NDArray[np.float64]) -> npt.NDArray[np.float64]:
            self.calls += 1
            if self.calls == 100:
                raise RuntimeError("the hundredth call")
            return super().frame(t)

    with pytest.raises(RuntimeError, match="the hundredth call"):
        vibrissa.sweep(rod, Faulty(), path, 1e-3)
    # the next sweep of this thread is not disturbed
    assert len(vibrissa.sweep(rod, vibrissa.Parabola((0.0, 0.0), 50.0), path, 1e-3)) > 0


def test_a_drawing_is_read_from_its_file(tmp_path: Path) -> None:
    file = tmp_path / "square.svg"
    file.write_text('<svg xmlns="http://www.w3.org/2000/svg"><path d="M0 0H10V10H0Z"/></svg>')
    square = vibrissa.Composite(vibrissa.Svg(scale=1e-3, file=file))
    assert square.is_closed and square.pieces == 4


@pytest.mark.parametrize(
    ("number", "found"),
    [
        (None, "None"),
        ("1.0", "1.0"),
        (1j, "complex"),
        (np.datetime64("2020"), "datetime64"),
        ([0.1, None], "None"),
        (np.ma.masked_array([0.1, 0.2], [False, True]), "masked"),
    ],
)
def test_what_numpy_would_take_for_a_number_is_refused(number: object, found: str) -> None:
    with pytest.raises(TypeError, match=f"argument 'x': expected numbers, found .*{found}"):
        vibrissa.Parabola((0.0, 0.0), 50.0).gap(number, 0.0)  # type: ignore[arg-type]


def test_arguments_of_the_wrong_size_are_named() -> None:
    parabola = vibrissa.Parabola((0.0, 0.0), 50.0)
    with pytest.raises(TypeError, match="argument 'vertex': expected two numbers, found 3"):
        vibrissa.Parabola((0.0, 0.0, 0.0), 50.0)
    with pytest.raises(TypeError, match=r"argument 'points': expected points of two coordinates.*found the shape \[3\]"):
        vibrissa.Polygon([0.0, 1.0, 2.0])  # type: ignore[list-item]
    with pytest.raises(TypeError, match="argument 'position': expected two numbers, found 0"):
        parabola.moved(())
    with pytest.raises(TypeError, match="argument 'most_steps': expected a whole number from 0 to .*, found -1"):
        vibrissa.sweep(
            vibrissa.Rod(1.0, 1.0), parabola, vibrissa.ClampPath((0.0, -1.0, 0.0), (0.1, -1.0, 0.0)), 0.1, most_steps=-1
        )


def test_what_a_frame_returns_is_checked() -> None:
    class Single(Hump):
        def frame(self, t: npt.NDArray[np.float64]) -> npt.NDArray[np.float64]:
            return super().frame(t).astype(np.float32)

    class Nothing(Hump):
        def frame(self, t: npt.NDArray[np.float64]) -> npt.NDArray[np.float64]:
            return None  # type: ignore[return-value]

    class Range(Hump):
        range = (0.0, 1.0, 2.0)  # type: ignore[assignment]

    for shape, message in [
        (Single(), r"frame\(t\) returns numbers of type float32, expected float64"),
        (Nothing(), r"frame\(t\): expected numbers, found None"),
        (Range(), "range of the shape: expected two numbers, found 3"),
    ]:
        with pytest.raises(TypeError, match=message):
            vibrissa.Composite(shape)
