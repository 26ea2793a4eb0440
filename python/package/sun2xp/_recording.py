"""Recordings of `sun2xp record` and black boxes, as structured arrays."""

from __future__ import annotations

import json
import os
import tempfile
from typing import TYPE_CHECKING, Any, Dict, Iterable, List, Union

import numpy

from . import _sun2xp
from ._types import Mark

if TYPE_CHECKING:
    import pandas  # type: ignore[import-untyped]

    from ._hand import Hand


class Recording:
    """A recording, from `sun2xp.read_recording` or `Hand.black_box`.

    Attributes:
        cycles: for each finger (1 to 3) that has cycles, a structured array with one row for each cycle. docs/python.md
            lists its fields. A number that a cycle does not have is NaN.
        marks: events, warnings, faults, gaps and changes of the stage, in the order of the file.
        description: the hand: its name, the time at which it was opened, and its configuration.
        complete: whether the recorder has finished the file. False while the recorder runs, and if it was killed.
    """

    cycles: Dict[int, numpy.ndarray]
    marks: List[Mark]
    description: Dict[str, Any]
    complete: bool

    def __init__(self, path: Union[str, os.PathLike[str]], fingers: Iterable[int] = ()) -> None:
        description, cycles, marks, self.complete, begin = _sun2xp.read_file(path, list(fingers))
        self._begin = begin or 0
        self.description = json.loads(description)
        self.cycles = {finger: _array(fields, rows) for finger, (fields, rows) in cycles.items()}
        self.marks = [Mark(*mark) for mark in marks]

    def seconds(self, finger: int) -> numpy.ndarray:
        """The times of the cycles of a finger, s: shape (n,). They are counted from the first cycle in the file, even
        if that cycle belongs to a finger that was not read."""
        return (self.cycles[finger]["time"] - self._begin) * 1e-9

    def to_pandas(self, finger: int) -> "pandas.DataFrame":
        """The cycles of a finger as a table, with the seconds since the first cycle as its index. Vectors and matrices
        have a column for each entry, such as `joints_0` and `kx_0_1`. Needs pandas."""
        import pandas

        columns = {}
        cycles = self.cycles[finger]
        for name in cycles.dtype.names or ():
            field = cycles[name]
            for place in numpy.ndindex(field.shape[1:]):
                columns["_".join([name, *map(str, place)])] = field[(slice(None), *place)]
        return pandas.DataFrame(columns, index=pandas.Index(self.seconds(finger), name="seconds"))

    def __repr__(self) -> str:
        counts = ", ".join(f"finger {finger}: {len(cycles)} cycles" for finger, cycles in self.cycles.items())
        return f"<sun2xp.Recording: {counts}, {len(self.marks)} marks>"


def _array(fields, rows: bytearray) -> numpy.ndarray:
    return numpy.frombuffer(rows, dtype=numpy.dtype([(name, kind, tuple(shape)) for name, kind, shape in fields]))


def read_recording(path: Union[str, os.PathLike[str]], fingers: Iterable[int] = ()) -> Recording:
    """Reads a recording of `sun2xp record` or a black box.

    Args:
        path: the file.
        fingers: the fingers to read; all if empty. A minute of a finger at 1000 Hz takes 34 MB of memory, and up to
            three times as much while it is read.

    Raises:
        Error: the file cannot be read, or is neither a recording nor a black box.
    """
    return Recording(path, fingers)


def black_box(hand: "Hand", finger: int) -> Recording:
    """Returns the last two seconds of a finger."""
    with tempfile.TemporaryDirectory() as folder:
        path = os.path.join(folder, "finger.json")
        hand.write_black_box(finger, path)
        return Recording(path)
