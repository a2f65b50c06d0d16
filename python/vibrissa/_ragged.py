"""Lists of different lengths in one array."""

from __future__ import annotations

from collections.abc import Iterator
from dataclasses import dataclass
from typing import Any

import numpy as np
import numpy.typing as npt

__all__ = ["Ragged"]


@dataclass(frozen=True, eq=False)
class Ragged:
    """Lists of different lengths, in the list layout of Arrow.

    List i is ``values[offsets[i]:offsets[i + 1]]``, which ``ragged[i]`` gives.

    Attributes
    ----------
    offsets : numpy.ndarray
        Where each list begins, and where the last one ends: int64.
    values : numpy.ndarray
        The rows of all lists one after another, a structured array.
    """

    offsets: npt.NDArray[np.int64]
    values: npt.NDArray[np.void]

    def __len__(self) -> int:
        return len(self.offsets) - 1

    def __getitem__(self, i: int) -> npt.NDArray[np.void]:
        count = len(self)
        if not -count <= i < count:
            raise IndexError(f"list {i} of {count}")
        i %= count
        found: npt.NDArray[np.void] = self.values[self.offsets[i] : self.offsets[i + 1]]
        return found

    def __iter__(self) -> Iterator[npt.NDArray[np.void]]:
        return (self[i] for i in range(len(self)))

    def __repr__(self) -> str:
        return f"<vibrissa.Ragged of {len(self)} lists, {len(self.values)} rows>"

    def parents(self) -> npt.NDArray[np.int64]:
        """For each row of ``values`` the number of its list.

        Returns
        -------
        numpy.ndarray
        """
        return np.repeat(np.arange(len(self)), np.diff(self.offsets))

    def to_arrow(self) -> Any:
        """The lists as an Arrow array of lists of structs, which shares the offsets.

        Returns
        -------
        pyarrow.LargeListArray
        """
        from ._tables import arrow_columns, optional

        pa = optional("pyarrow")

        columns = arrow_columns(self.values)
        structs = pa.StructArray.from_arrays(list(columns.values()), names=list(columns))
        return pa.LargeListArray.from_arrays(pa.array(self.offsets), structs)
