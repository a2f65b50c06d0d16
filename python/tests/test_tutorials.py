"""The tutorials: their code runs, prints what they say, and makes their figures.

TUTORIAL_FIGURES=1 writes the figures into the pages.
"""

from __future__ import annotations

import contextlib
import doctest
import io
import os
import re
import runpy
import shutil
import subprocess
from pathlib import Path
from typing import Any

import pytest

TUTORIALS = Path(__file__).parents[2] / "docs" / "tutorials"
BLOCK = re.compile(r"^```(\w+)\n(.*?)^```$", re.DOTALL | re.MULTILINE)


def compare(page: str, said: str, wanted: str) -> None:
    """What is printed is what the page shows, but for parts that it leaves out by ``...``."""
    is_same = doctest.OutputChecker().check_output(wanted, said, doctest.ELLIPSIS)
    assert is_same, f"{page}: printed\n{said}\nexpected\n{wanted}"


def compare_figures(page: str, folder: Path) -> None:
    names = re.findall(r"^!\[[^\]]*\]\(([\w.]+)\)", (TUTORIALS / page).read_text(), re.MULTILINE)
    assert names, page
    for name in names:
        [made] = folder.rglob(name)
        assert 5_000 < made.stat().st_size < 100_000 and (TUTORIALS / name).exists(), name
        if os.environ.get("TUTORIAL_FIGURES"):
            shutil.copy(made, TUTORIALS)


@pytest.mark.parametrize("page", ["whisker.md", "solver.md"])
def test_tutorials_in_python(page: str, monkeypatch: pytest.MonkeyPatch, tmp_path: Path) -> None:
    pytest.importorskip("matplotlib").use("Agg")
    monkeypatch.chdir(tmp_path)
    names: dict[str, Any] = {}
    said = ""
    for kind, block in BLOCK.findall((TUTORIALS / page).read_text()):
        if kind == "text":
            compare(page, said, block)
        else:
            assert kind == "python"
            printed = io.StringIO()
            with contextlib.redirect_stdout(printed):
                exec(block, names)
            said = printed.getvalue()
    compare_figures(page, tmp_path)


def test_logs_of_the_sensor_are_those_of_their_program(monkeypatch: pytest.MonkeyPatch, tmp_path: Path) -> None:
    monkeypatch.chdir(tmp_path)
    runpy.run_path(str(TUTORIALS / "logs.py"))
    for name in ("ati.csv", "stage.txt"):
        assert (tmp_path / name).read_text() == (TUTORIALS / name).read_text(), name


def test_tutorial_of_the_command(command: list[str], tmp_path: Path) -> None:
    for name in ("ati.csv", "stage.txt"):
        shutil.copy(TUTORIALS / name, tmp_path)
    environment = {**os.environ, "PATH": f"{Path(command[0]).parent}{os.pathsep}{os.environ['PATH']}"}
    said = ""
    for kind, block in BLOCK.findall((TUTORIALS / "sensor.md").read_text()):
        if kind == "text":
            compare("sensor.md", said, block)
        elif kind == "sh":
            done = subprocess.run(["bash", "-ec", block], cwd=tmp_path, env=environment, capture_output=True, text=True)
            assert done.returncode == 0, f"{block}{done.stdout}{done.stderr}"
            said = done.stdout
    compare_figures("sensor.md", tmp_path)


def test_tutorial_in_rust_shows_the_example() -> None:
    example = (Path(__file__).parents[2] / "examples" / "cart.rs").read_text()
    blocks = [block for kind, block in BLOCK.findall((TUTORIALS / "simulator.md").read_text()) if kind == "rust"]
    assert blocks
    for block in blocks:
        assert block in example, block
