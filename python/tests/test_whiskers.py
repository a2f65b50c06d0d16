"""Whiskers by published regressions."""

from __future__ import annotations

from typing import Any

import pytest
from conftest import SCENES

import vibrissa
from vibrissa.whiskers import Whisker, rat


def test_a_rats_c1_is_that_of_the_scene() -> None:
    rod = vibrissa.Scene.read(SCENES / "whisker.toml").rod
    assert rod.diameter is not None and rod.tip_diameter is not None
    whisker = rat("c", 1)
    assert whisker.length == pytest.approx(rod.length, rel=1e-9)
    assert whisker.base_diameter == pytest.approx(rod.diameter, rel=1e-9)
    assert whisker.tip_diameter == pytest.approx(rod.tip_diameter, abs=0.05e-6)
    assert whisker.youngs_modulus == rod.youngs_modulus
    assert "Belli" in whisker.source and "Quist" in whisker.source and "tip" not in whisker.source
    assert rat(3, 1) == whisker
    made = whisker.rod([[0.0, 8.0], [whisker.length, 24.0]])
    assert isinstance(made, vibrissa.Rod)
    assert made.length == whisker.length
    assert made.diameter == whisker.base_diameter
    assert made.tip_diameter == whisker.tip_diameter
    assert made.natural_curvature == [[0.0, 8.0], [whisker.length, 24.0]]


def test_each_whisker_of_a_rat_is_a_rod() -> None:
    lengths = {}
    for row in range(1, 6):
        for column in range(1, 5 if row == 1 else 6):
            whisker = rat(row, column)
            made = whisker.rod()
            assert made.tip_diameter is not None and made.tip_diameter >= 0.01 * whisker.base_diameter
            assert ("regression gives" in whisker.source) == (whisker.tip_diameter <= 0.010001 * whisker.base_diameter)
            lengths[row, column] = whisker.length
    assert all(lengths[row, column] > lengths[row, column + 1] for row, column in lengths if (row, column + 1) in lengths)
    assert "the regression gives -1.4 um" in rat("C", 2).source


@pytest.mark.parametrize(
    ("row", "column", "message"),
    [
        ("C", 0, r"column is 0, expected 1 to 5 in row C: the regressions do not hold for Greek whiskers"),
        ("C", 6, r"column is 6, expected 1 to 5 in row C"),
        ("A", 5, r"column is 5, expected 1 to 4 in row A"),
        ("C", 1.5, r"column is 1.5, expected 1 to 5"),
        ("alpha", 1, r"row is 'alpha', expected 1 to 5, or 'A' to 'E': the Greek whiskers lie between the rows"),
        ("F", 1, r"row is 'F', expected 1 to 5"),
        ("", 1, r"row is '', expected 1 to 5"),
        (0, 1, r"row is 0, expected 1 to 5"),
    ],
)
def test_whiskers_outside_the_regressions_are_refused(row: Any, column: Any, message: str) -> None:
    with pytest.raises(ValueError, match=message):
        rat(row, column)


def test_a_whisker_of_ones_own() -> None:
    whisker = Whisker(0.02, 60e-6, 0.1e-6, 3e9)
    assert whisker.rod().tip_diameter == pytest.approx(0.6e-6)
    assert whisker.rod(10.0).natural_curvature == 10.0
    with pytest.raises(ValueError, match=r"tip_diameter is 0.0 m, expected a positive, finite number"):
        Whisker(0.02, 60e-6, 0.0, 3e9)
