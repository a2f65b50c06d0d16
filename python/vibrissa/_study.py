"""Studies: many scenes on the workers of any executor, and one row for each.

The caller's process cuts the scenes into chunks, hands them out and writes a part of the table for each chunk that comes back.
Workers need neither the files of the study nor Arrow, only this package.
"""

from __future__ import annotations

import hashlib
import itertools
import json
import os
from collections.abc import Iterable, Iterator, Mapping
from concurrent.futures import FIRST_COMPLETED, Executor, Future, wait
from dataclasses import dataclass
from pathlib import Path
from typing import Any, TypeAlias

from . import _study_files as files
from ._core import Scene, Study, __version__, _study_row

__all__ = ["StudyBroken", "grid", "study"]

# Chunks that are handed out and not back: enough for a large cluster, and some MB of texts.
_AHEAD = 1000
# Times that a chunk is handed out before the study breaks off.
_TRIES = 3

_Source: TypeAlias = str | os.PathLike[str] | Study | Iterable[Scene | tuple[Mapping[str, float], Scene]]


class StudyBroken(RuntimeError):
    """A worker or the executor failed. What was written stays; the same call goes on after it.

    Its ``__cause__`` is the exception of the executor.
    """

    __module__ = "vibrissa"


@dataclass(frozen=True)
class Task:
    """A scene for a worker: the values of its parameters; its text, or why there is none; the file that it is in."""

    values: tuple[float, ...]
    text: str | None
    reason: str | None
    file: str


def grid(make: Any, /, **values: Iterable[float]) -> Iterator[tuple[dict[str, float], Scene]]:
    """The scenes of all combinations of values; the last parameter changes fastest.

    Parameters
    ----------
    make : callable
        Makes the :class:`Scene` from the parameters as keywords.
    **values : iterable of float
        The values of each parameter.

    Yields
    ------
    tuple
        The parameters as a dict, and the scene.

    Examples
    --------
    >>> import vibrissa
    >>> def make(distance: float) -> vibrissa.Scene:
    ...     rod = vibrissa.Rod(0.1, 2e-3)
    ...     path = vibrissa.ClampPath((0.08, -distance, 1.57), (-0.08, -distance, 1.57))
    ...     return vibrissa.Scene(rod, vibrissa.Parabola((0.0, 0.0), 50.0), path, 1e-3)
    >>> table = vibrissa.study(vibrissa.grid(make, distance=[0.03, 0.05]), out="out/distances")  # doctest: +SKIP
    """
    for chosen in itertools.product(*(tuple(one) for one in values.values())):
        parameters = dict(zip(values, chosen, strict=True))
        yield parameters, make(**parameters)


def rows(chunk: list[Task]) -> list[tuple[Any, ...]]:
    """What a worker does: the rows of some scenes, from ``status`` on."""
    return [_row(task) for task in chunk]


def _row(task: Task) -> tuple[Any, ...]:
    if task.text is None:
        return files.refused(task.reason or "")
    try:
        return _study_row(task.text, task.file)
    except (KeyboardInterrupt, SystemExit, GeneratorExit):
        raise
    except BaseException as error:  # a panic of the library is no Exception
        return files.refused(f"{type(error).__name__}: {error}")


def _tasks(scenes: _Source) -> tuple[Iterator[Task], list[str], int | None]:
    """The scenes, the names of their parameters, and how many there are, where that is known."""
    if isinstance(scenes, (str, os.PathLike)):
        scenes = Study.read(scenes)
    if isinstance(scenes, Study):
        return _of_study(scenes), scenes.names, len(scenes)
    try:
        given = iter(scenes)
    except TypeError:
        raise TypeError(f"scenes is {scenes!r}, expected a study file, a Study or an iterable of scenes") from None
    first = next(given, None)
    if first is None:
        raise ValueError("scenes is empty, expected one scene at least")
    names = list(first[0]) if isinstance(first, tuple) and isinstance(first[0], Mapping) else []
    count = len(scenes) if isinstance(scenes, (list, tuple)) else None
    return _of_scenes(itertools.chain([first], given), names), names, count


def _of_study(study: Study) -> Iterator[Task]:
    file = os.fspath(study.scene)
    for number in range(len(study)):
        text, reason = study._text_or_reason(number)
        yield Task(tuple(study.values(number).values()), text, reason, file)


def _of_scenes(scenes: Iterable[Any], names: list[str]) -> Iterator[Task]:
    for number, given in enumerate(scenes):
        values, scene = given if isinstance(given, tuple) and len(given) == 2 else ({}, given)
        if not isinstance(scene, Scene) or not isinstance(values, Mapping):
            raise TypeError(f"scene {number} is {given!r}, expected a Scene, or a dict of parameters and then a Scene")
        if list(values) != names:
            raise ValueError(f"scene {number} has the parameters {list(values)}, expected those of the first: {names}")
        try:
            text = scene.to_toml()
        except ValueError as error:
            raise ValueError(f"scene {number}: {error}") from error
        yield Task(tuple(_number(number, *one) for one in values.items()), text, None, "scene.toml")


def _number(scene: int, name: str, value: Any) -> float:
    try:
        return float(value)
    except (TypeError, ValueError):
        raise ValueError(f"scene {scene} has {value!r} for the parameter {name!r}, expected a number") from None


def _chunks(tasks: Iterator[Task], size: int) -> Iterator[list[Task]]:
    while chunk := list(itertools.islice(tasks, size)):
        yield chunk


def _digest(chunk: list[Task]) -> str:
    """What tells one chunk from another: its scenes and their parameters, to the last bit."""
    texts = [[[value.hex() for value in task.values], task.text, task.reason] for task in chunk]
    return hashlib.sha256(json.dumps(texts).encode()).hexdigest()


def study(
    scenes: _Source,
    executor: Executor | None = None,
    *,
    out: str | os.PathLike[str],
    chunk: int = 128,
    progress: Any = None,
    units: Mapping[str, str] | None = None,
) -> Any:
    """Sweep many scenes on the workers of an executor, and write one row for each.

    The rows go to Parquet files in ``out``, one for each chunk of scenes, each complete or not there at all. A run that is
    interrupted, killed or broken goes on after what it has written when the same call is made again; the table is the same to the
    last bit, whatever the executor. A scene that cannot be swept is a row with its reason.

    Parameters
    ----------
    scenes : str, os.PathLike, Study or iterable
        A study file as ``docs/studies.md`` describes it, or scenes: each a :class:`Scene`, or a dict of its parameters and a scene
        (:func:`grid`). Scenes are taken as they would be written to a file, so their shapes must have a name there.
    executor : concurrent.futures.Executor, optional
        Who sweeps: a ``ProcessPoolExecutor``, ``client.get_executor()`` of Dask, an ``MPIPoolExecutor`` of mpi4py, ... Without it,
        this process does, one scene after the other.
    out : str or os.PathLike
        The directory of the rows, which is made.
    chunk : int, optional
        Scenes of a task and of a file. A run that goes on keeps that of its beginning.
    progress : bool or object with ``update(n)``, optional
        True shows a bar of tqdm; anything else is told how many rows have come.
    units : mapping, optional
        Units of the parameters, for the metadata.

    Returns
    -------
    pyarrow.Table
        All rows, as :func:`read_study` gives them: the columns of ``docs/studies.md``.

    Raises
    ------
    ValueError
        An argument is not possible, or ``out`` has the rows of other scenes or of another version.
    StudyBroken
        A worker or the executor failed.
    """
    if isinstance(chunk, bool) or not isinstance(chunk, int) or chunk < 1:
        raise ValueError(f"chunk is {chunk!r}, expected a positive number of scenes")
    if executor is not None and not callable(getattr(executor, "submit", None)):
        raise TypeError(f"executor is {executor!r}, expected a concurrent.futures.Executor")
    files.arrow()
    tasks, names, count = _tasks(scenes)
    for name in names:
        if not isinstance(name, str) or name in files.COLUMNS:
            raise ValueError(f"a parameter has the name {name!r}, expected one that no column has")
    directory = Path(out)
    begun = files.begin(directory, {"version": __version__, "parameters": names, "units": dict(units or {})}, chunk)
    told = _told(progress, count)
    total = 0

    def missing() -> Iterator[tuple[files.Part, list[Task]]]:
        nonlocal total
        for one in _chunks(tasks, begun["chunk"]):
            part = files.Part(total, _digest(one), [task.values for task in one])
            total += len(one)
            if files.is_written(directory, part):
                told.update(len(one))
            else:
                yield part, one

    def write(part: files.Part, found: list[tuple[Any, ...]]) -> None:
        files.write(directory, begun, part, found)
        told.update(len(found))

    try:
        if executor is None:
            for part, one in missing():
                write(part, rows(one))
        else:
            _hand_out(executor, missing(), write)
    finally:
        getattr(told, "close", lambda: None)()
    files.finish(directory, begun, total)
    return files.read_study(directory)


def _hand_out(executor: Executor, missing: Iterator[tuple[files.Part, list[Task]]], write: Any) -> None:
    """Chunks to the executor, and what comes back to the files, in whatever order it comes.

    ``rows`` raises nothing, so what a future raises is of the executor. Dask's has an error for a result that its worker took along
    when it died; such a chunk is handed out again.
    """
    waiting: dict[Future[list[tuple[Any, ...]]], tuple[files.Part, list[Task], int]] = {}
    try:
        while True:
            for part, one in itertools.islice(missing, _AHEAD - len(waiting)):
                waiting[_submit(executor, one)] = (part, one, 1)
            if not waiting:
                return
            for future in wait(waiting, return_when=FIRST_COMPLETED).done:
                part, one, tries = waiting.pop(future)
                try:
                    found = future.result()
                except Exception as error:
                    if tries == _TRIES:
                        raise _broken(error) from error
                    waiting[_submit(executor, one)] = (part, one, tries + 1)
                else:
                    write(part, found)
    finally:
        for future in waiting:
            future.cancel()


def _submit(executor: Executor, chunk: list[Task]) -> Future[list[tuple[Any, ...]]]:
    try:
        return executor.submit(rows, chunk)
    except Exception as error:
        raise _broken(error) from error


def _broken(error: BaseException) -> StudyBroken:
    reason = f"{type(error).__name__}: {error}"
    return StudyBroken(f"the executor failed: {reason}; the same call goes on after what was written")


class _Silent:
    def update(self, n: int) -> None:
        """Nobody is told."""


def _told(progress: Any, count: int | None) -> Any:
    if progress is None or progress is False:
        return _Silent()
    if progress is True:
        from tqdm import tqdm

        return tqdm(total=count, unit="scenes")
    if not callable(getattr(progress, "update", None)):
        raise TypeError(f"progress is {progress!r}, expected True or an object with update(n)")
    return progress
