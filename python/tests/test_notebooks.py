"""The notebooks run to their ends, and draw."""

from __future__ import annotations

import runpy
from pathlib import Path

import pytest

NOTEBOOKS = Path(__file__).parents[1] / "notebooks"


@pytest.mark.parametrize("file", sorted(NOTEBOOKS.glob("*.py")), ids=lambda file: str(file.stem))
def test_notebooks_run_to_the_end(file: Path, monkeypatch: pytest.MonkeyPatch, tmp_path: Path) -> None:
    plt = pytest.importorskip("matplotlib.pyplot")
    monkeypatch.chdir(NOTEBOOKS)
    plt.close("all")
    runpy.run_path(str(file))
    figures = plt.get_fignums()
    assert figures
    for number in figures:
        picture = tmp_path / f"{file.stem}-{number}.png"
        plt.figure(number).savefig(picture, dpi=60)
        assert picture.stat().st_size > 5_000
    plt.close("all")
