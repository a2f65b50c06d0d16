"""Whiskers by published numbers."""

from __future__ import annotations

import math
from collections.abc import Callable
from typing import Any

import numpy as np
import pytest
from conftest import SCENES

import vibrissa
from vibrissa.whiskers import Whisker, mouse, rat

RAT = {"A": range(0, 5), "B": range(0, 5), "C": range(0, 6), "D": range(0, 6), "E": range(1, 6)}
MOUSE = {"A": range(1, 4), "B": range(0, 4), "C": range(0, 5), "D": range(0, 5), "E": range(1, 5)}


def all_of(make: Callable[[int | str, int], Whisker], places: dict[str, range]) -> dict[tuple[str, int], Whisker]:
    return {(row, column): make(row, column) for row, columns in places.items() for column in columns}


def test_a_rats_c1() -> None:
    whisker = rat("c", 1)
    assert whisker.length == pytest.approx(45.2e-3, rel=1e-12)
    assert whisker.base_diameter == pytest.approx(160.5e-6, rel=1e-12)
    assert (whisker.tip_diameter, whisker.youngs_modulus) == (3e-6, 3.34e9)
    assert whisker.curvature_coefficient == pytest.approx(8.85, rel=1e-12)
    for part in ("Zweifel", "Belli", "Quist", "tip diameter: an estimate", "without standard deviation"):
        assert part in whisker.source
    assert rat(3, 1) == whisker
    assert rat("D", 0).length == pytest.approx(52.6e-3) and rat("E", 5).length == pytest.approx(9.4e-3)


def test_a_mouses_c2() -> None:
    whisker = mouse("C", 2)
    assert whisker.length == pytest.approx(15.3e-3, rel=1e-12)
    assert whisker.base_diameter == pytest.approx(2.0 * 2.1e-3 * 15.3e-3, rel=1e-12)
    assert (whisker.tip_diameter, whisker.youngs_modulus) == (3e-6, 5e9)
    assert whisker.curvature_coefficient == pytest.approx(9.4, rel=1e-12)
    assert whisker.source.startswith("length: measured mean of 12 whiskers, standard deviation 1.3 mm, Bresee et al. (2023); curvature: measured mean of 11 ")
    assert "standard deviation of the coefficient 4.5 1/m, Bresee et al. (2023)" in whisker.source
    for part in ("base diameter: an estimate of +-25 %", "tip diameter: an estimate", "Young's modulus: an estimate"):
        assert part in whisker.source
    assert mouse(3, 2) == whisker


def test_each_whisker_is_a_rod() -> None:
    rats, mice = all_of(rat, RAT), all_of(mouse, MOUSE)
    assert len(rats) == 27 and len(mice) == 21
    for whiskers in (rats, mice):
        for (row, column), whisker in whiskers.items():
            made = whisker.rod()
            assert made.natural_curvature is None
            assert (made.length, made.diameter, made.tip_diameter) == (whisker.length, whisker.base_diameter, whisker.tip_diameter)
            assert whisker.rod(whisker.natural_curvature).natural_curvature == whisker.natural_curvature
            shorter = whiskers.get((row, column + 1))
            assert shorter is None or shorter.length < whisker.length
    # shared by both animals, a mouse's is the smaller one
    assert all(mice[place].length < rats[place].length for place in mice)


def test_the_curvature_at_rest_turns_as_the_parabola() -> None:
    for whisker in [*all_of(rat, RAT).values(), *all_of(mouse, MOUSE).values()]:
        a = whisker.curvature_coefficient
        x = np.linspace(0.0, whisker.length, 20_001)
        arc = np.concatenate([[0.0], np.cumsum(np.hypot(np.diff(x), np.diff(a * x**2)))])
        tip = float(np.interp(whisker.length, arc, x))
        assert whisker.natural_curvature * whisker.length == pytest.approx(math.atan(2.0 * a * tip), rel=1e-6)
        assert 0.5 < whisker.natural_curvature / (2.0 * a) < 1.0
    bent = Whisker(0.02, 60e-6, 3e-6, 3e9, curvature_coefficient=-300.0)
    assert -math.pi / 2.0 < bent.natural_curvature * bent.length < -1.3
    assert Whisker(0.02, 60e-6, 3e-6, 3e9).natural_curvature == 0.0


def test_the_regressions_cannot_tell_a_rats_tip() -> None:
    """docs/whiskers.md: of how many whiskers the regression gives a tip below 3 um, and below 0, and how far the one of the length is off."""
    tips, off = [], []
    for (row, column), whisker in all_of(rat, RAT).items():
        slope = 0.0012 + 0.00017 * ("ABCDE".index(row) + 1) - 0.000066 * column + 0.00011 * column**2
        off.append((column, 43.0 + 1.8 * ("ABCDE".index(row) + 1) - 7.6 * column - 1e3 * whisker.length))
        tips.append(whisker.base_diameter - 2.0 * whisker.length * slope)
    print(sorted(round(1e6 * tip, 1) for tip in tips))
    at_front = [length for column, length in off if column >= 3]
    assert (round(min(at_front), 1), round(max(at_front), 1)) == (1.3, 6.6)
    assert (sum(tip < 3e-6 for tip in tips), sum(tip < 0.0 for tip in tips)) == (18, 16)


@pytest.mark.parametrize(
    ("make", "row", "column", "message"),
    [
        (rat, "C", -1, r"column is -1, expected 0 to 5: the whiskers in row C of a rat of which there are measured averages; 0 is the Greek"),
        (rat, "C", 6, r"column is 6, expected 0 to 5: the whiskers in row C of a rat"),
        (rat, "A", 5, r"column is 5, expected 0 to 4: the whiskers in row A of a rat"),
        (rat, "E", 0, r"column is 0, expected 1 to 5: the whiskers in row E of a rat"),
        (rat, "C", 1.5, r"column is 1.5, expected 0 to 5"),
        (rat, "alpha", 1, r"row is 'alpha', expected 1 to 5, or 'A' to 'E'"),
        (rat, "F", 1, r"row is 'F', expected 1 to 5"),
        (rat, "", 1, r"row is '', expected 1 to 5"),
        (rat, 0, 1, r"row is 0, expected 1 to 5"),
        (mouse, 6, 1, r"row is 6, expected 1 to 5"),
        (mouse, "C", 5, r"column is 5, expected 0 to 4: the whiskers in row C of a mouse"),
        (mouse, "A", 0, r"column is 0, expected 1 to 3: the whiskers in row A of a mouse"),
    ],
)
def test_other_whiskers_are_refused(make: Callable[[Any, Any], Whisker], row: Any, column: Any, message: str) -> None:
    with pytest.raises(ValueError, match=message):
        make(row, column)


def test_a_whisker_of_ones_own() -> None:
    whisker = Whisker(0.02, 60e-6, 0.1e-6, 3e9)
    assert whisker.rod().tip_diameter == pytest.approx(0.6e-6)
    assert whisker.rod(10.0).natural_curvature == 10.0
    points = [[0.0, 8.0], [0.02, 24.0]]
    assert whisker.rod(points).natural_curvature == points
    with pytest.raises(ValueError, match=r"tip_diameter is 0.0 m, expected a positive, finite number"):
        Whisker(0.02, 60e-6, 0.0, 3e9)
    with pytest.raises(ValueError, match=r"curvature_coefficient is nan 1/m, expected a finite number"):
        Whisker(0.02, 60e-6, 1e-6, 3e9, curvature_coefficient=math.nan)


def test_the_whisker_of_the_scene_is_none_of_the_averages() -> None:
    """docs/whiskers.md has the numbers of the scene, of a regression for the length."""
    rod = vibrissa.Scene.read(SCENES / "whisker.toml").rod
    assert (rod.length, rod.diameter, rod.tip_diameter, rod.youngs_modulus) == (0.0408, 151.7e-6, 8.6e-6, 3.34e9)
