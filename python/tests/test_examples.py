"""The examples of the docstrings, and the code of the README."""

from __future__ import annotations

import doctest
import inspect
import re
from pathlib import Path
from types import ModuleType
from typing import Any

import pytest

import vibrissa
import vibrissa._core
import vibrissa.plot

README = Path(__file__).parents[1] / "README.md"


@pytest.mark.parametrize(("module", "least"), [(vibrissa, 15), (vibrissa._core, 6)])
def test_examples_of_docstrings(module: ModuleType, least: int) -> None:
    found = doctest.testmod(module)
    assert found.failed == 0 and found.attempted >= least


def test_code_of_the_readme(monkeypatch: pytest.MonkeyPatch, tmp_path: Path) -> None:
    monkeypatch.chdir(tmp_path)
    names: dict[str, Any] = {}
    blocks = re.findall(r"```python\n(.*?)```", README.read_text(), re.DOTALL)
    assert len(blocks) >= 3
    for block in blocks:
        exec(block, names)
    assert names["scan"].phases and list(tmp_path.glob("*.png"))


def test_code_of_the_page_on_speed(capsys: pytest.CaptureFixture[str]) -> None:
    page = (README.parents[1] / "docs/speed-against-error.md").read_text()
    (block,) = re.findall(r"```python\n(.*?)```", page, re.DOTALL)
    names: dict[str, Any] = {}
    exec(block, names)
    assert re.fullmatch(r"1001 states, 7 events in [0-9.]+ ms\n", capsys.readouterr().out)
    # a thousand times what it takes: not a measurement, but no trial of seconds either
    assert min(names["times"]) < 2.0


def test_everything_public_has_a_docstring() -> None:
    for name in vibrissa.__all__:
        one = getattr(vibrissa, name)
        if name in ("UNITS", "__version__"):
            continue
        assert inspect.getdoc(one), name
        if inspect.isclass(one):
            own = [member for member in vars(one) if not member.startswith("_")]
            assert all(inspect.getdoc(getattr(one, member)) for member in own if not name == "SweepStopped"), name
