"""What scans can touch: closed forms, the numbers of the command, errors."""

from __future__ import annotations

import csv
import math
import shutil
import subprocess
from pathlib import Path

import numpy as np
import pytest
from conftest import SCENES

import vibrissa


def test_of_a_circle_as_much_is_touched_as_the_straight_rod_reaches() -> None:
    rod = vibrissa.Rod(0.1, 6.3e-4)
    circle = vibrissa.CircularArc((0.0, 0.0), 0.03, 0.4, 0.4 + 2 * math.pi)
    found = vibrissa.reach(rod, circle, [0.085, 0.05], [0.3])
    # one at 15 mm above the nearest point, one at the widest place
    expected = [2 * 0.03 * math.acos(0.5), math.pi * 0.03]
    for distance, length in zip([0.085, 0.05], expected, strict=True):
        passes = found.scans[found.scans["distance"] == distance]
        assert list(passes["pass"]) == ["left", "right"]
        assert np.all(passes["single"] < length)
    assert found.share("single") == pytest.approx(0.5, abs=1e-9)
    assert found.share("several") == 0.0


def test_numbers_are_those_of_the_command(command: list[str], tmp_path: Path) -> None:
    shutil.copy(SCENES / "O1_q40.toml", tmp_path)
    arguments = ["reach", "O1_q40.toml", "--distances", "0.03,0.05", "--out", "out"]
    subprocess.run([*command, *arguments], cwd=tmp_path, check=True, capture_output=True)
    scene = vibrissa.Scene.read(SCENES / "O1_q40.toml")
    found = vibrissa.reach(scene.rod, scene.objects, [0.03, 0.05])
    with open(tmp_path / "out/outline.csv") as file:
        rows = list(csv.DictReader(file))
    assert [row["touched"] for row in rows] == list(found.parts["touched"])
    assert [float(row["to"]) for row in rows] == list(found.parts["end"])


def test_wrong_arguments_are_named() -> None:
    rod, circle = vibrissa.Rod(0.1, 6.3e-4), vibrissa.CircularArc((0.0, 0.0), 0.02, 0.0, 2 * math.pi)
    with pytest.raises(ValueError, match="distances has 0.2 m, expected more than 0 and less than the rod's length"):
        vibrissa.reach(rod, circle, 0.2)
    with pytest.raises(ValueError, match="touched is 'often', expected"):
        vibrissa.reach(rod, circle, 0.05).share("often")
