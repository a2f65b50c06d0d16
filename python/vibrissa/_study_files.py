"""The files of a study: parts of its table in Parquet, and what they are of."""

from __future__ import annotations

import json
import os
import re
from collections.abc import Callable, Sequence
from dataclasses import dataclass
from pathlib import Path
from typing import Any

# The columns beside the parameters, which stand after the first: type and unit.
COLUMNS = {
    "scene": ("int64", ""),
    "status": ("string", ""),
    "phases": ("string", ""),
    "cycle": ("string", ""),
    "snaps": ("int64", ""),
    "several": ("float64", "m"),
    "naive_error": ("float64", "m"),
    "touched": ("float64", ""),
    "largest_moment": ("float64", "N m"),
    "states": ("int64", ""),
    "reason": ("string", ""),
}

_STUDY = "study.json"
_DIGEST = b"scenes"


@dataclass(frozen=True)
class Part:
    """Some scenes: the number of the first, what tells them from others, the values of their parameters."""

    first: int
    digest: str
    values: list[tuple[float, ...]]

    @property
    def file(self) -> str:
        return f"part-{self.first:08}.parquet"


def arrow() -> Any:
    """Arrow, which is optional."""
    try:
        import pyarrow
    except ImportError as error:
        raise ImportError("studies need pyarrow: pip install pyarrow") from error
    return pyarrow


def refused(reason: str) -> tuple[Any, ...]:
    """The row of a scene that is none, from ``status`` on."""
    return ("refused", None, None, None, None, None, None, None, None, reason)


def _publish(file: Path, write: Any) -> None:
    """A file that is complete or not there at all, also where the machine stops."""
    temporary = file.with_name(f".{file.name}.{os.getpid()}")
    try:
        with open(temporary, "wb") as stream:
            write(stream)
            stream.flush()
            os.fsync(stream.fileno())
        os.replace(temporary, file)
    finally:
        temporary.unlink(missing_ok=True)


def _record(directory: Path, record: dict[str, Any]) -> None:
    text = json.dumps(record, indent=2) + "\n"
    _publish(directory / _STUDY, lambda stream: stream.write(text.encode()))


def begin(directory: Path, record: dict[str, Any], chunk: int) -> dict[str, Any]:
    """The record of the directory: the one that is there, which must be of the same study, or one that the first part brings."""
    file = directory / _STUDY
    if not file.exists():
        if directory.exists() and any(directory.iterdir()):
            raise ValueError(f"out is {directory}, which has other files, expected an empty or new directory")
        return {**record, "chunk": chunk, "scenes": None}
    found = _recorded(directory)
    for name, value in record.items():
        if found.get(name) != value:
            raise ValueError(f"out is {directory}, whose {name} is {found.get(name)!r}, expected {value!r}: another study")
    return found


def _recorded(directory: Path) -> dict[str, Any]:
    file = directory / _STUDY
    try:
        record: dict[str, Any] = json.loads(file.read_text())
    except ValueError as error:
        raise ValueError(f"{file} is damaged ({error}), expected the record of a study; use a new directory") from error
    return record


def _parts(directory: Path) -> list[Path]:
    return sorted(file for file in directory.iterdir() if re.fullmatch(r"part-\d{8,}\.parquet", file.name))


def _read(read: Callable[[Path], Any], file: Path) -> Any:
    """What a reader of Parquet makes of a file."""
    try:
        return read(file)
    except (arrow().ArrowInvalid, OSError) as error:
        raise ValueError(f"{file} is damaged ({error}); delete it, and make the same call of study again") from error


def is_written(directory: Path, part: Part) -> bool:
    """Whether the part is there. It must be of the same scenes."""
    file = directory / part.file
    if not file.exists():
        return False
    arrow()
    import pyarrow.parquet as pq

    if (_read(pq.read_schema, file).metadata or {}).get(_DIGEST) != part.digest.encode():
        raise ValueError(f"out is {directory}, whose {part.file} has other scenes, expected those of this study")
    return True


def schema(record: dict[str, Any], metadata: dict[str, str]) -> Any:
    """The schema of the table, with the units of its columns."""
    pa = arrow()

    def field(name: str, kind: str, unit: str) -> Any:
        return pa.field(name, pa.type_for_alias(kind), metadata={"unit": unit} if unit else None)

    (scene, of_scene), *others = COLUMNS.items()
    fields = [field(scene, *of_scene)]
    fields += [field(name, "float64", record["units"].get(name, "")) for name in record["parameters"]]
    fields += [field(name, *column) for name, column in others]
    known = {"vibrissa": record["version"], "parameters": json.dumps(record["parameters"])}
    return pa.schema(fields, metadata={**known, **metadata})


def write(directory: Path, record: dict[str, Any], part: Part, rows: Sequence[tuple[Any, ...]]) -> None:
    """Write a part."""
    pa = arrow()
    import pyarrow.parquet as pq

    if len(rows) != len(part.values):
        raise RuntimeError(f"{len(rows)} rows came for {len(part.values)} scenes, expected as many")
    if not (directory / _STUDY).exists():
        directory.mkdir(parents=True, exist_ok=True)
        _record(directory, record)
    whole = [(part.first + n, *values, *row) for n, (values, row) in enumerate(zip(part.values, rows, strict=True))]
    form = schema(record, {_DIGEST.decode(): part.digest})
    arrays = [pa.array(column, field.type) for column, field in zip(zip(*whole, strict=True), form, strict=True)]
    _publish(directory / part.file, lambda stream: pq.write_table(pa.Table.from_arrays(arrays, schema=form), stream))


def finish(directory: Path, record: dict[str, Any], scenes: int) -> None:
    """Note that all scenes are there."""
    later = _parts(directory)[-1]
    if int(later.stem.removeprefix("part-")) >= scenes or record["scenes"] not in (None, scenes):
        raise ValueError(f"out is {directory}, which has rows of more than {scenes} scenes, expected those of this study")
    if record["scenes"] is None:
        _record(directory, {**record, "scenes": scenes})


def read_study(directory: str | os.PathLike[str], *, incomplete: bool = False) -> Any:
    """The rows of a study, of :func:`study` or of the command ``vibrissa study``.

    Parameters
    ----------
    directory : str or os.PathLike
        The directory of the rows.
    incomplete : bool, optional
        Give what is there of a run that is not complete, too.

    Returns
    -------
    pyarrow.Table
        In the order of the scenes. The schema has the version and the names of the parameters in its metadata; a field has its unit.

    Raises
    ------
    FileNotFoundError
        The directory has no study.
    ValueError
        The run is not complete, or files were damaged or lost since.
    """
    place = Path(directory)
    record = _recorded(place)
    if "parameters" not in record:
        return _of_command(place, record, incomplete)
    if record["scenes"] is None and not incomplete:
        raise ValueError(f"directory is {place}, whose run is not complete; make the same call of study again to continue")
    import pyarrow.parquet as pq

    form = schema(record, {})
    parts = [_read(pq.ParquetFile, file).read().cast(form) for file in _parts(place)]
    table = arrow().concat_tables(parts) if parts else form.empty_table()
    scenes = table["scene"].to_pylist()
    if record["scenes"] is not None and scenes != list(range(record["scenes"])):
        raise ValueError(
            f"directory is {place}, whose files have {len(scenes)} rows, expected scenes 0 to {record['scenes'] - 1} in order, each once;"
            " make the same call of study again for those that are missing"
        )
    return table


def _of_command(place: Path, record: dict[str, Any], incomplete: bool) -> Any:
    """The tables of the command."""
    pa = arrow()
    from pyarrow import csv

    whole = place / "rows.csv"
    if not whole.exists():
        hint = "; give the same command again to continue" if not incomplete else ", and its parts have no names of columns"
        raise ValueError(f"directory is {place}, whose run is not complete{hint}")
    with csv.open_csv(whole) as reader:
        names = reader.schema.names
    known = {"version": record["version"], "units": {}, "parameters": names[1 : names.index("status")]}
    form = schema(known, {})
    convert = csv.ConvertOptions(
        column_types={field.name: field.type for field in form}, null_values=[""], strings_can_be_null=True
    )
    table = csv.read_csv(whole, convert_options=convert, parse_options=csv.ParseOptions(newlines_in_values=True))
    return pa.Table.from_arrays(table.columns, schema=form)
