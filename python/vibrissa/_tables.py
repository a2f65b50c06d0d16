"""Structured arrays as tables of pandas and Arrow, which are optional."""

from __future__ import annotations

import importlib
from typing import TYPE_CHECKING, Any

import numpy as np
import numpy.typing as npt

from ._core import UNITS

if TYPE_CHECKING:
    from ._core import Scan

Rows = npt.NDArray[np.void]


def columns(*parts: Rows) -> dict[str, npt.NDArray[Any]]:
    """The fields of structured arrays with the same rows, each in one piece."""
    return {name: np.ascontiguousarray(rows[name]) for rows in parts for name in rows.dtype.names or ()}


def optional(package: str) -> Any:
    """A package that not everybody has installed."""
    try:
        return importlib.import_module(package)
    except ImportError as error:
        name = package.split(".")[0]
        raise ImportError(f"this needs {name}: pip install {name}") from error


def units(names: list[str]) -> dict[str, str]:
    """The units of those columns that have one."""
    return {name: UNITS[name] for name in names if name in UNITS}


def pandas_table(found: dict[str, npt.NDArray[Any]]) -> Any:
    """The columns as a data frame, with their units in its ``attrs``."""
    pd = optional("pandas")

    frame = pd.DataFrame(found)
    frame.attrs["units"] = units(list(found))
    return frame


def arrow_columns(*parts: Rows) -> dict[str, Any]:
    """The fields of structured arrays with the same rows as arrays of Arrow."""
    pa = optional("pyarrow")

    def array(values: npt.NDArray[Any]) -> Any:
        return pa.array(values.tolist(), pa.string()) if values.dtype.kind == "U" else pa.array(values)

    return {name: array(values) for name, values in columns(*parts).items()}


def arrow_table(found: dict[str, Any]) -> Any:
    """Arrays of Arrow as a table, with the unit of each in the metadata of its field."""
    pa = optional("pyarrow")

    def field(name: str, values: Any) -> Any:
        return pa.field(name, values.type, metadata={"unit": UNITS[name]} if name in UNITS else None)

    schema = pa.schema([field(name, values) for name, values in found.items()])
    return pa.Table.from_arrays(list(found.values()), schema=schema)


def to_pandas(*parts: Rows) -> Any:
    """Structured arrays with the same rows as a data frame."""
    return pandas_table(columns(*parts))


def to_arrow(*parts: Rows) -> Any:
    """Structured arrays with the same rows as a table of Arrow."""
    return arrow_table(arrow_columns(*parts))


def _rows(scan: Scan, table: str) -> Rows:
    if table == "contacts":
        return scan.contacts.values
    return scan.events if table == "events" else scan.states


def scan_to_pandas(scan: Scan, table: str) -> Any:
    """``Scan.to_pandas``."""
    found = columns(_rows(scan, table))
    if table == "contacts":
        found = {"state": scan.contacts.parents(), **found}
    return pandas_table(found)


def scan_to_arrow(scan: Scan, table: str) -> Any:
    """``Scan.to_arrow``."""
    pa = optional("pyarrow")

    found = arrow_columns(_rows(scan, table))
    if table == "contacts":
        found = {"state": pa.array(scan.contacts.parents()), **found}
    if table == "states":
        found["contacts"] = scan.contacts.to_arrow()
    return arrow_table(found)
