"""What the tests share: the scene of the README, and the command."""

from __future__ import annotations

import math
import os
import shutil
import subprocess
from pathlib import Path

import numpy as np
import numpy.typing as npt
import pytest

import vibrissa

SCENES = Path(__file__).parents[2] / "scenes"


class Hump:
    """The parabola ``y = 50 x^2`` by 10 x, as a shape of one's own."""

    range = (-1.0, 1.0)

    def frame(self, t: npt.NDArray[np.float64]) -> npt.NDArray[np.float64]:
        x = 0.1 * t
        slope = 100.0 * x
        return np.array([x, 50.0 * x * x, np.arctan(slope), 0.1 * np.hypot(1.0, slope), 10.0 / (1.0 + slope**2)])


@pytest.fixture
def rod() -> vibrissa.Rod:
    return vibrissa.Rod(0.1, diameter=0.5e-3, youngs_modulus=206e9)


@pytest.fixture
def parabolas() -> vibrissa.Composite:
    return vibrissa.Composite([vibrissa.Parabola((0.0, 0.0), 50.0), vibrissa.Parabola((0.03, 0.0), 50.0)])


@pytest.fixture
def path() -> vibrissa.ClampPath:
    return vibrissa.ClampPath((0.08, -0.04, math.pi / 2), (-0.09, -0.04, math.pi / 2))


@pytest.fixture
def command() -> list[str]:
    """The command, from VIBRISSA_COMMAND or the search path."""
    found = os.environ.get("VIBRISSA_COMMAND") or shutil.which("vibrissa")
    if found is None:
        pytest.skip("no command vibrissa: set VIBRISSA_COMMAND to compare with it")
    subprocess.run([found, "--version"], check=True, capture_output=True)
    return [found]
