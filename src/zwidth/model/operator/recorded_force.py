"""A hand that pushes as it was recorded; values given one per sample, and columns of text files."""

from __future__ import annotations

import csv
from collections.abc import Iterable, Iterator
from dataclasses import dataclass, fields
from itertools import islice
from pathlib import Path
from typing import TYPE_CHECKING, Any, TextIO

import numpy as np

from zwidth.errors import InputError
from zwidth.model.operator.operator import Operator, Signals
from zwidth.quantity.parameter import Parametric, Reads, part
from zwidth.quantity.text import shown, told_quantity

if TYPE_CHECKING:
    from numpy.typing import ArrayLike

    from zwidth.model.operator.operator import Signal


def as_record(values: ArrayLike, what: str, unit: str) -> Signal:
    """One finite number per sample, as a read-only array of its own."""
    try:
        record = np.array(values, dtype=np.float64)
    except (TypeError, ValueError, OverflowError):
        raise InputError(
            f"{what} [{unit}] is one number per sample, such as [0.0, 0.5, 1.0]; "
            f"got a {type(values).__name__} that is not"
        ) from None
    if record.ndim != 1:
        raise InputError(
            f"{what} [{unit}] is one number per sample, in one row; got {record.ndim} dimensions, "
            f"shape {record.shape}: give one column"
        )
    if record.size == 0:
        raise InputError(f"{what} [{unit}] is one number per sample; got none")
    if not np.isfinite(record).all():
        first = int(np.flatnonzero(~np.isfinite(record))[0])
        raise InputError(
            f"{what} [{unit}] must be finite, got {record[first]} at index {first}: no hand gives that; "
            "cut the record there or fill the gap"
        )
    record.setflags(write=False)
    return record


@dataclass(frozen=True, kw_only=True, eq=False, repr=False)
class RecordedOperator(Operator):
    """An operator that holds arrays: equal when their values are."""

    def __eq__(self, other: object) -> bool:
        if type(other) is not type(self):
            return NotImplemented
        return self._key() == other._key()

    def __hash__(self) -> int:
        return hash((type(self), self._key()))

    def __repr__(self) -> str:
        inside = ", ".join(f"{f.name}={_shown(getattr(self, f.name))}" for f in fields(self))
        return f"{type(self).__name__}({inside})"

    def _key(self) -> tuple[Any, ...]:
        # -0.0 + 0.0 is 0.0: equal values have equal bytes
        values = (getattr(self, f.name) for f in fields(self))
        return tuple((v + 0.0).tobytes() if isinstance(v, np.ndarray) else v for v in values)


def _shown(value: Any) -> str:
    return f"<{value.size} values>" if isinstance(value, np.ndarray) else repr(value)


def _record(given: ArrayLike, name: str) -> Signal:
    return as_record(given, "recorded force", "N or N·m")


@dataclass(frozen=True, eq=False, repr=False)
class RecordedForce(Parametric, RecordedOperator):
    """``f_h = F_k`` from the sample instant kT to (k+1)T.

    Parameters
    ----------
    newtons
        F_k, positive into the wall, one value for each sample interval of the
        touch, so duration/T of them [N; N·m].
    """

    newtons: Reads[Signal, ArrayLike] = part("force record", _record, meaning="the force of each interval")

    @classmethod
    def from_file(cls, path: str | Path, column: str | int | None = None) -> RecordedForce:
        """The force in one column of a text file, one line per sample interval.

        Parameters
        ----------
        path
            A CSV file, or one number on each line; "#" starts a comment. The first line may be names.
        column
            Its name, or its number from 0; not needed where there is only one.
        """
        return cls(read_column(path, column))

    def signals(self, times: Signal) -> Signals:
        given, wanted = len(self.newtons), len(times) - 1
        if given != wanted:
            duration = given * (times[1] - times[0])
            raise InputError(
                f"the recorded force has {given} values, but the touch has {wanted} sample intervals: each "
                f"interval holds one value; give {wanted} values, or a duration of {shown(duration, 's', 9)}"
            )
        return Signals(force=self.newtons.copy())

    def describe(self, motion: str = "linear") -> str:
        low, high = self.newtons.min(), self.newtons.max()
        highest = told_quantity(high, "force", motion)
        return f"recorded force, {len(self.newtons)} samples, {low:.6g} to {highest}"


MOST_LINES = 50_000_000
"""Lines read at most: 14 hours at 1 kHz."""

LONGEST_LINE = 2**20
"""Characters of the longest line."""


def read_column(path: str | Path, column: str | int | None = None) -> list[float]:
    """The numbers of one column, by its name or its number from 0, line by line; None: the only one.

    Comma, semicolon or blank separates; "#" starts a comment; the first line may be names.
    """
    try:
        with Path(path).open(encoding="utf-8-sig", newline="") as lines:
            return _numbers(path, _lines(path, lines), column)
    except OSError as error:
        raise InputError(f"{path} cannot be read: {error.strerror or error}") from None
    except (UnicodeDecodeError, csv.Error):
        raise InputError(f"{path} is not a text file of numbers; give one number on each line") from None


def _lines(path: str | Path, file: TextIO) -> Iterator[str]:
    while line := file.readline(LONGEST_LINE + 1):
        if len(line) > LONGEST_LINE:
            raise InputError(f"{path} has a line of more than {LONGEST_LINE} characters; it is no table")
        yield line


def _numbers(path: str | Path, lines: Iterable[str], column: str | int | None) -> list[float]:
    index, width, numbers = -1, 0, list[float]()
    for number, line in enumerate(islice(lines, MOST_LINES), start=1):
        cells = _cells(line)
        if not cells:
            continue
        if width == 0:
            width = len(cells)
            header = cells if any(_float(cell) is None for cell in cells) else None
            index = _index(path, header, width, column)
            if header:
                continue
        if len(cells) != width:
            raise InputError(f"{path}, line {number}: {len(cells)} values where the first line has {width}")
        value = _float(cells[index])
        if value is None:
            raise InputError(f"{path}, line {number}: expected a number, got {cells[index][:40]!r}")
        numbers.append(value)
    if not numbers:
        raise InputError(f"{path} holds no number; give one on each line")
    return numbers


def _cells(line: str) -> list[str]:
    text = line.split("#", 1)[0].strip()
    for separator in (",", ";", "\t"):
        if separator in text:
            return [cell.strip() for cell in next(csv.reader([text], delimiter=separator))]
    return text.split()


def _float(cell: str) -> float | None:
    try:
        return float(cell)
    except ValueError:
        return None


def _index(path: str | Path, header: list[str] | None, width: int, column: str | int | None) -> int:
    names = f": {', '.join(header)}" if header else ""
    if column is None:
        if width > 1:
            raise InputError(f"{path} has {width} columns{names}; say which one holds the force")
        return 0
    if isinstance(column, str):
        if header is None or column not in header:
            raise InputError(f"{path} has no column {column!r}{names or ', its columns have no names'}")
        if header.count(column) > 1:
            raise InputError(f"{path} has more than one column {column!r}; give its number, counted from 0")
        return header.index(column)
    if not 0 <= column < width:
        raise InputError(f"{path} has no column {column}: it has {width}, counted from 0")
    return column
