"""Studies: the same rows from any executor, whatever breaks on the way."""

from __future__ import annotations

import json
import math
import os
import signal
import subprocess
import sys
from collections.abc import Callable, Iterator
from concurrent.futures import Executor, Future, ProcessPoolExecutor
from multiprocessing import get_context
from pathlib import Path
from typing import Any

import pytest
from conftest import Hump

import vibrissa

pytest.importorskip("pyarrow")

SCENE = Path(__file__).parents[2] / "studies" / "parabolas.toml"
COUNT = 5 * 6 * 2


@pytest.fixture
def file(tmp_path: Path) -> Path:
    """A study, some of whose scenes are none: the step is 0."""
    file = tmp_path / "study.toml"
    file.write_text(f"""
        scene = {json.dumps(str(SCENE))}
        [[parameter]]
        name = "distance"
        from = -0.2
        to = 0.9
        count = 5
        set = [{{ field = "sweep.from[2]", scale = -1.0 }}, {{ field = "sweep.to[2]", scale = -1.0 }}]
        [[parameter]]
        name = "spacing"
        values = [0.1, 0.2, 0.3, 0.4, 0.5, 0.6]
        set = [{{ field = "contour.piece[2].vertex[1]" }}]
        [[parameter]]
        name = "step"
        values = [0.0, 0.002]
        set = [{{ field = "sweep.step" }}]
        """)
    return file


@pytest.fixture
def serial(file: Path, tmp_path: Path) -> Any:
    return vibrissa.study(file, out=tmp_path / "serial", chunk=4)


def bits(table: Any) -> list[list[Any]]:
    """The cells, with all digits."""
    rows = table.to_pydict().values()
    return [[cell.hex() if isinstance(cell, float) else cell for cell in column] for column in rows]


class At:
    """Does something when so many rows have come."""

    def __init__(self, rows: int, act: Callable[[], object]) -> None:
        self.missing, self.act = rows, act

    def update(self, n: int) -> None:
        before, self.missing = self.missing, self.missing - n
        if before > 0 >= self.missing:
            self.act()


def test_rows_are_those_of_the_command(file: Path, serial: Any, command: list[str], tmp_path: Path) -> None:
    subprocess.run([*command, "study", str(file), "--out", str(tmp_path / "csv")], check=True, capture_output=True)
    table = vibrissa.read_study(tmp_path / "csv")
    assert table.num_rows == COUNT and bits(table) == bits(serial)
    assert table.schema.equals(serial.schema, check_metadata=True)
    assert set(table["status"].to_pylist()) >= {"done", "refused"}
    refused = table.filter([status == "refused" for status in table["status"].to_pylist()]).to_pylist()
    assert all(row["reason"] and row["phases"] is None for row in refused)


def test_a_row_is_what_the_sweep_says(file: Path, serial: Any) -> None:
    study = vibrissa.Study.read(file)
    number = serial["status"].to_pylist().index("done")
    row = serial.to_pylist()[number]
    scan = vibrissa.Scene.parse(study.text(number), study.scene).sweep()
    assert (row["states"], row["largest_moment"]) == (len(scan), abs(scan.states["m0z"]).max())
    assert {name: row[name] for name in study.names} == study.values(number)
    assert serial.schema.field("largest_moment").metadata == {b"unit": b"N m"}
    assert serial.schema.metadata[b"vibrissa"] == vibrissa.__version__.encode()


def test_a_process_pool_that_breaks_goes_on(file: Path, serial: Any, tmp_path: Path) -> None:
    out = tmp_path / "pool"
    with ProcessPoolExecutor(2, mp_context=get_context("spawn")) as pool:

        def kill() -> None:
            os.kill(next(iter(pool._processes)), signal.SIGKILL)

        with pytest.raises(vibrissa.StudyBroken, match="the same call goes on"):
            vibrissa.study(file, pool, out=out, chunk=2, progress=At(6, kill))
    with pytest.raises(ValueError, match="not complete"):
        vibrissa.read_study(out)
    written = {part.name: part.stat().st_ino for part in out.glob("part-*.parquet")}
    assert 0 < len(written) < COUNT / 2
    assert vibrissa.read_study(out, incomplete=True).num_rows == 2 * len(written)
    with ProcessPoolExecutor(2, mp_context=get_context("spawn")) as pool:
        table = vibrissa.study(file, pool, out=out)
    assert bits(table) == bits(serial)
    # nothing was written twice
    assert written.items() <= {part.name: part.stat().st_ino for part in out.glob("part-*.parquet")}.items()


def test_a_run_that_is_killed_goes_on(file: Path, serial: Any, tmp_path: Path) -> None:
    out = tmp_path / "killed"
    program = """
import os, signal, sys, vibrissa
class Kill:
    rows = 0
    def update(self, n):
        self.rows += n
        if self.rows >= 12:
            os.kill(os.getpid(), signal.SIGKILL)
vibrissa.study(sys.argv[1], out=sys.argv[2], chunk=4, progress=Kill())
"""
    done = subprocess.run([sys.executable, "-c", program, str(file), str(out)], check=False)
    assert done.returncode == -signal.SIGKILL
    assert len(list(out.glob("part-*.parquet"))) == 3
    came: list[int] = []
    table = vibrissa.study(file, out=out, progress=type("Told", (), {"update": lambda _, n: came.append(n)})())
    assert bits(table) == bits(serial) and sum(came) == COUNT


def test_a_dask_cluster_that_loses_a_worker(file: Path, serial: Any, tmp_path: Path) -> None:
    distributed = pytest.importorskip("distributed")
    settings = {"n_workers": 3, "threads_per_worker": 1, "processes": True, "host": "127.0.0.1"}
    with distributed.LocalCluster(**settings, dashboard_address=None) as cluster, distributed.Client(cluster) as client:
        workers = client.run(os.getpid)
        assert len(set(workers.values()) | {os.getpid()}) == 4
        killed = []

        def kill() -> None:
            # one that has work
            having = {worker: len(tasks) for worker, tasks in client.processing().items()}
            busiest = max(having, key=lambda worker: having[worker])
            killed.append(having[busiest])
            os.kill(workers[busiest], signal.SIGKILL)

        out = tmp_path / "dask"
        table = vibrissa.study(file, client.get_executor(), out=out, chunk=1, progress=At(5, kill))
        assert killed[0] > 0
    assert len(list(out.glob("part-*.parquet"))) == COUNT
    assert bits(table) == bits(serial)


class Losing(Executor):
    """Loses what it is given the first times."""

    def __init__(self, times: int) -> None:
        self.times = times
        self.submitted: dict[Any, int] = {}

    def submit(self, run: Any, /, *given: Any, **named: Any) -> Future[Any]:
        future: Future[Any] = Future()
        first = given[0][0]
        number = self.submitted[first] = self.submitted.get(first, 0) + 1
        if number <= self.times:
            future.set_exception(ValueError("not enough values to unpack"))
        else:
            future.set_result(run(*given, **named))
        return future


def test_a_chunk_that_the_executor_lost_is_handed_out_again(file: Path, serial: Any, tmp_path: Path) -> None:
    assert bits(vibrissa.study(file, Losing(2), out=tmp_path / "twice", chunk=5)) == bits(serial)
    with pytest.raises(vibrissa.StudyBroken, match="the executor failed: ValueError: not enough values"):
        vibrissa.study(file, Losing(3), out=tmp_path / "ever", chunk=5)


def test_joblib_workers_are_an_executor(file: Path, serial: Any, tmp_path: Path) -> None:
    loky = pytest.importorskip("joblib.externals.loky")
    pool = loky.get_reusable_executor(max_workers=2)
    try:
        assert bits(vibrissa.study(file, pool, out=tmp_path / "loky", chunk=16)) == bits(serial)
    finally:
        pool.shutdown()


def scene(distance: float, coefficient: float) -> vibrissa.Scene:
    rod = vibrissa.Rod(0.1, diameter=0.5e-3, youngs_modulus=206e9)
    path = vibrissa.ClampPath((0.08, -distance, math.pi / 2), (-0.08, -distance, math.pi / 2))
    return vibrissa.Scene(rod, vibrissa.Parabola((0.0, 0.0), coefficient), path, 2e-3)


def scenes() -> Iterator[tuple[dict[str, float], vibrissa.Scene]]:
    return vibrissa.grid(scene, distance=[0.03, 0.05], coefficient=[20.0, 50.0])


def test_scenes_may_be_made_in_python(tmp_path: Path) -> None:
    units = {"distance": "m", "coefficient": "1/m"}
    table = vibrissa.study(scenes(), out=tmp_path / "grid", chunk=3, units=units)
    assert table["distance"].to_pylist() == [0.03, 0.03, 0.05, 0.05]
    assert table.schema.field("coefficient").metadata == {b"unit": b"1/m"}
    expected = [" ".join(phase for phase in one.sweep().phases if phase != "free") for _, one in scenes()]
    assert table["phases"].to_pylist() == expected
    # without parameters
    plain = vibrissa.study((one for _, one in scenes()), out=tmp_path / "plain")
    assert plain["states"].equals(table["states"])


def test_what_is_wrong_is_said(tmp_path: Path, rod: vibrissa.Rod, path: vibrissa.ClampPath) -> None:
    out = tmp_path / "rows"
    wrongs: list[tuple[dict[str, Any], type[Exception], str]] = [
        ({"chunk": 0}, ValueError, "chunk is 0, expected a positive number of scenes"),
        ({"executor": 4}, TypeError, "executor is 4, expected a concurrent.futures.Executor"),
        ({"progress": 3}, TypeError, "progress is 3, expected True or an object"),
        ({"scenes": 3}, TypeError, "scenes is 3, expected a study file"),
        ({"scenes": []}, ValueError, "scenes is empty, expected one scene at least"),
        ({"scenes": [3]}, TypeError, "scene 0 is 3, expected a Scene"),
        ({"scenes": [({"states": 1.0}, scene(0.03, 50.0))]}, ValueError, "a parameter has the name 'states'"),
        ({"scenes": tmp_path / "none.toml"}, OSError, "none.toml"),
    ]
    for wrong, error, text in wrongs:
        with pytest.raises(error, match=text):
            vibrissa.study(**{"scenes": scenes(), "out": out, **wrong})
    assert not out.exists()
    own = vibrissa.Scene(rod, Hump(), path, 1e-3)
    with pytest.raises(ValueError, match="scene 0: object 0 has a piece that scene files have no name for"):
        vibrissa.study([own], out=tmp_path / "own")
    vibrissa.study(scenes(), out=tmp_path / "mine")
    others: list[tuple[Any, str]] = [
        (vibrissa.grid(scene, distance=[0.03, 0.05], coefficient=[20.0, 51.0]), "part-00000000.parquet has other scenes"),
        ([scene(0.03, 50.0)], "whose parameters is .* another study"),
    ]
    for other, text in others:
        with pytest.raises(ValueError, match=text):
            vibrissa.study(other, out=tmp_path / "mine")
    (tmp_path / "foreign").mkdir()
    (tmp_path / "foreign" / "letter.txt").touch()
    with pytest.raises(ValueError, match="which has other files, expected an empty or new directory"):
        vibrissa.study(scenes(), out=tmp_path / "foreign")


def test_damaged_files_are_named(tmp_path: Path) -> None:
    def run() -> Any:
        return vibrissa.study(vibrissa.grid(_scene, distance=[0.03, 0.05, 0.07]), out=tmp_path / "out", chunk=1)

    whole = run()
    part = tmp_path / "out/part-00000001.parquet"
    kept = part.read_bytes()
    for damage in (b"", kept[: len(kept) // 2], b"none"):
        part.write_bytes(damage)
        for refused in (run, lambda: vibrissa.read_study(tmp_path / "out")):
            with pytest.raises(ValueError, match="part-00000001.parquet is damaged.*delete it"):
                refused()
    part.unlink()
    with pytest.raises(ValueError, match="have 2 rows, expected scenes 0 to 2 in order, each once"):
        vibrissa.read_study(tmp_path / "out")
    assert run().equals(whole)
    # what is no part is left alone
    (tmp_path / "out/part-00000001-copy.parquet").write_bytes(kept)
    assert vibrissa.read_study(tmp_path / "out").equals(whole)
    (tmp_path / "out/study.json").write_text("{")
    with pytest.raises(ValueError, match="study.json is damaged"):
        run()


def test_parameters_are_numbers(tmp_path: Path) -> None:
    with pytest.raises(TypeError, match="expected a Scene, or a dict of parameters and then a Scene"):
        vibrissa.study([(_scene(0.05), {"distance": 0.05})], out=tmp_path / "out")  # type: ignore[list-item]
    with pytest.raises(ValueError, match="scene 0 has 'wide' for the parameter 'distance', expected a number"):
        vibrissa.study([({"distance": "wide"}, _scene(0.05))], out=tmp_path / "out")  # type: ignore[dict-item]


def _scene(distance: float) -> vibrissa.Scene:
    path = vibrissa.ClampPath((0.08, -distance, math.pi / 2), (-0.08, -distance, math.pi / 2))
    return vibrissa.Scene(vibrissa.Rod(0.1, 2e-3), vibrissa.Parabola((0.0, 0.0), 50.0), path, 2e-3)
