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
from matplotlib.colors import to_hex

import vibrissa
import vibrissa.plot


def scene(objects: vibrissa.Shape, angle: float = math.pi / 2) -> vibrissa.Scene:
    return vibrissa.Scene(vibrissa.Rod(0.1, 6.3e-4), objects, vibrissa.ClampPath((0.2, -0.07, angle), (-0.2, -0.07, angle)), 1e-3)


def test_of_a_circle_as_much_is_touched_as_the_straight_rod_reaches() -> None:
    circle = vibrissa.CircularArc((0.0, 0.0), 0.03, 0.4, 0.4 + 2 * math.pi)
    found = vibrissa.reach(scene(circle, 0.3), [0.085, 0.05])
    assert list(found.scans["pass"]) == ["left", "right"] * 2 and set(found.scans["angle"]) == {0.3}
    # from a place 15 mm above the nearest point the rod touches two sixths of the circle, from one as high as its centre half of it
    for distance, length in [(0.085, 2 * 0.03 * math.acos(0.5)), (0.05, math.pi * 0.03)]:
        one = vibrissa.reach(scene(circle, 0.3), distance)
        assert one.share("single") * one.length == pytest.approx(length, abs=1e-10)
    assert found.share("single") == pytest.approx(0.5, abs=1e-9)
    assert found.share("several") == 0.0 and found.share("never") == pytest.approx(0.5, abs=1e-9)


def test_numbers_are_those_of_the_command(command: list[str], tmp_path: Path) -> None:
    shutil.copy(SCENES / "O1_q40.toml", tmp_path)
    subprocess.run([*command, "reach", "O1_q40.toml", "--distances", "0.03,0.05", "--out", "out"], cwd=tmp_path, check=True, capture_output=True)
    found = vibrissa.reach(vibrissa.Scene.read(SCENES / "O1_q40.toml"), [0.03, 0.05])
    with open(tmp_path / "out/outline.csv") as file:
        rows = list(csv.DictReader(file))
    assert [row["touched"] for row in rows] == list(found.parts["how"])
    for theirs, ours in [("from", "start"), ("to", "end")]:
        assert [float(row[theirs]) for row in rows] == list(found.parts[ours])
    with open(tmp_path / "out/scans.csv") as file:
        rows = list(csv.DictReader(file))
    for name in ("angle", "distance", "single", "several", "touched_share", "snaps", "largest_moment", "largest_stress"):
        assert [float(row[name]) for row in rows] == list(found.scans[name]), name


def test_tables_and_figure() -> None:
    found = vibrissa.reach(scene(vibrissa.CircularArc((0.0, 0.0), 0.02, 0.0, 2 * math.pi)), 0.05)
    frame = found.to_pandas("parts")
    assert frame.attrs["units"]["start"] == "m" and len(frame) == len(found.parts)
    assert len(found.to_pandas()) == 2
    assert all(np.allclose(np.hypot(*points.T), 0.02) for _, points in found.lines())
    ax = found.plot()
    assert {to_hex(line.get_color()) for line in ax.lines} == {"#332288", "#882255"}
    assert found.plot(ax) is ax
    with pytest.raises(ValueError, match="table is 'contour', expected 'scans' or 'parts'"):
        found.to_pandas("contour")


def test_wrong_arguments_are_named() -> None:
    one = scene(vibrissa.CircularArc((0.0, 0.0), 0.02, 0.0, 2 * math.pi))
    with pytest.raises(ValueError, match="distances has 0.2 m, expected more than 0 and less than the rod's length"):
        vibrissa.reach(one, 0.2)
    with pytest.raises(ValueError, match="how is 'often', expected"):
        vibrissa.reach(one, 0.05).share("often")
    rough = vibrissa.Scene(one.rod, one.objects, one.path, 1e-3, friction=0.2)
    with pytest.raises(ValueError, match="the scene has friction, expected none"):
        vibrissa.reach(rough, 0.05)
