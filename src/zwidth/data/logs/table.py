"""What every format gives: named columns, their units and values, piece by piece; what a log is made of."""

from __future__ import annotations

import re
from collections.abc import Callable, Collection, Iterable, Iterator, Mapping
from contextlib import contextmanager
from dataclasses import dataclass, field, replace
from itertools import groupby
from typing import TYPE_CHECKING, Any, Literal, NamedTuple

import numpy as np
from numpy.typing import NDArray

from zwidth.errors import InputError
from zwidth.quantity.answered import answered

if TYPE_CHECKING:
    from zwidth.native.compiled import Array

PIECE = 2**18
"""Rows that are read at once, where the format lets us choose."""

MOST_COLUMNS = 64
"""Of one matrix, or one message: more are no columns of a log."""

LEFT_OUT = "the others are left out"
"""Said of runs, where one is looked at."""

Values = NDArray[Any]


@dataclass(kw_only=True)
class Table:
    """Columns of a file."""

    source: str
    units: Mapping[str, str | None]
    """Every column with the unit that the file states; None if it states none."""
    read: Callable[[tuple[str, ...]], Iterator[tuple[Values, ...]]]
    """Gives the columns named, piece by piece: the same number of rows in each."""
    attributes: Mapping[str, Any] = field(default_factory=dict)
    notes: dict[str, Finding] = field(default_factory=dict)
    """What was odd in the file; complete after `read` came to its end."""
    means: Mapping[str, str | None] = field(default_factory=dict)
    """The column of each quantity, None where there is none, if the format says which: nobody guesses
    then."""
    likely: Mapping[str, str] = field(default_factory=dict)
    """What a unit that nobody states may be, in words, of a column of which the format lets one guess."""
    origin: list[Any] = field(default_factory=list)
    """From which on stamps that are dates are counted, once it is known: in every log of the table."""
    sheet: str = ""
    """Name of the sheet of a workbook; else ""."""
    sheets: tuple[Table, ...] = ()
    """Of a workbook with several tables all of them, this one too: the longest; else empty."""


def understood_sheets(table: Table, understood: Callable[[Table], Any]) -> list[Table]:
    """The sheets of a workbook that are understood; of another file its one table, unasked."""
    found = []
    for each in table.sheets:
        try:
            understood(each)
        except InputError:
            continue
        found.append(each)
    return found or [table]


def in_pieces(
    source: str, columns: Mapping[str, Values], names: tuple[str, ...]
) -> Iterator[tuple[Values, ...]]:
    """Columns that are held in memory, in pieces."""
    rows = check_lengths(source, {name: columns[name].size for name in names})
    for k in range(0, rows, PIECE):
        yield tuple(columns[name][k : k + PIECE] for name in names)


def check_lengths(source: str, sizes: Mapping[str, int]) -> int:
    """The number of rows that all columns have; refuse those that differ."""
    if len(set(sizes.values())) > 1:
        said = ", ".join(f'"{name}" has {size} samples' for name, size in sizes.items())
        raise InputError(f"{source}: {said}; choose columns of one length")
    return next(iter(sizes.values()))


@contextmanager
def readable(source: str) -> Iterator[None]:
    """Whatever a library says of foreign bytes becomes one message."""
    try:
        yield
    except (InputError, KeyboardInterrupt, GeneratorExit):
        raise
    except MemoryError:
        raise InputError(f"{source} cannot be read: it needs more memory than there is") from None
    except Exception as error:  # what the libraries raise on foreign bytes is not documented
        reason = (str(error) or type(error).__name__).splitlines()[0][:200]
        raise InputError(f"{source} cannot be read: {reason}") from None


def listed(names: Mapping[str, Any] | list[str]) -> str:
    """Column names in a message, not more than a person reads."""
    shown = [f'"{name}"' for name in list(names)[:30]]
    more = len(names) - len(shown)
    return ", ".join(shown) + (f" and {more} more" if more > 0 else "")


_SECONDS = re.compile(r"((.*)[._/ ]|)(?:secs?|seconds)", re.IGNORECASE)
_RESTS = {"nanosec": 1, "nanosecond": 1, "nsec": 1, "microsec": 1000, "microsecond": 1000, "usec": 1000}
"""[ns] Of what stands beside whole seconds."""


def with_whole_stamps(table: Table, chosen: Collection[str | None]) -> Table:
    """The table in which whole seconds and the rest of one, as ROS and C write a time, are one column; where
    one of the two is chosen by its name they stay as they are."""
    for seconds in table.units:
        if found := _SECONDS.fullmatch(seconds):
            start, before = found[1], found[2] or ""
            units = {n: _RESTS.get(n.removeprefix(start).lower().rstrip("s")) for n in table.units}
            rests = [n for n, unit in units.items() if unit and n.startswith(start)]
            known = re.search(r"(stamp|time|\bt)$", before, re.IGNORECASE)
            name = before if known else f"{before}.stamp".lstrip(".")
            if len(rests) == 1 and name not in units and not {seconds, *rests} & set(chosen):
                return _joined(table, name, seconds, rests[0], units[rests[0]] or 1)
    return table


def _joined(table: Table, joined: str, seconds: str, rest: str, unit: int) -> Table:
    def read(names: tuple[str, ...]) -> Iterator[tuple[Values, ...]]:
        wanted = {part: None for n in names for part in ((seconds, rest) if n == joined else (n,))}
        for piece in table.read((*wanted,)):
            columns = dict(zip(wanted, piece, strict=True))
            if joined in names:
                columns[joined] = _stamps(columns[seconds], columns[rest] * unit)
            yield tuple(columns[name] for name in names)

    def _stamps(whole: Values, part: Values) -> Values:
        """Nanoseconds; "not a time" where either number is missing."""
        known = np.isfinite(whole) & np.isfinite(part)
        if (np.abs(part[known]) >= 1e9).any():
            raise InputError(
                f'{table.source}: "{rest}" beside "{seconds}" is more than a second, and no rest of one; say '
                f'which is the time with columns={{"time": "{seconds}"}}'
            )
        stamps = np.full(whole.size, np.datetime64("NaT", "ns"))
        stamps[known] = (whole[known].astype(np.int64) * 10**9 + part[known].astype(np.int64)).astype(
            "M8[ns]"
        )
        return stamps

    units = {
        joined if n == seconds else n: "ns" if n == seconds else u
        for n, u in table.units.items()
        if n != rest
    }
    return replace(table, units=units, read=read)


def nearest(wanted: Values, stamps: Values, values: Values) -> Values:
    """The value nearest in time to each wanted stamp; NaN where none is within half a period."""
    if stamps.size == 0 or wanted.size < 2:
        return np.full(wanted.size, np.nan)
    order = np.argsort(stamps, kind="stable")
    stamps, values = stamps[order], values[order]
    right = np.clip(np.searchsorted(stamps, wanted), 0, stamps.size - 1)
    left = np.maximum(right - 1, 0)
    near = np.where(np.abs(stamps[left] - wanted) <= np.abs(stamps[right] - wanted), left, right)
    reach = 0.5 * float(np.nanmedian(np.diff(np.sort(wanted))))
    return np.where(np.abs(stamps[near] - wanted) <= 1.02 * reach, values[near], np.nan)


BLOCK_SIZE = 2**18
"""Most samples in a block."""

Motion = Literal["linear", "rotary"]


class Block(NamedTuple):
    """A stretch without a gap, at most `BLOCK_SIZE` samples.

    Parameters
    ----------
    run
        Which uninterrupted run it belongs to, from 0; consecutive blocks of one run follow each other
        without a gap.
    time
        [s] of each sample.
    position
        [m; rad] as the encoder read it, positive into the wall; whole multiples of the resolution if one is
        known.
    hand_force
        [N; N·m] of the hand on the device, positive into the wall; None if the log has none.
    actuator_force
        [N; N·m] of the actuator, positive out of the wall; None if the log has none.
    """

    run: int
    time: Array
    position: Array
    hand_force: Array | None
    actuator_force: Array | None

    def part(self, where: slice) -> Block:
        columns = (None if column is None else column[where] for column in self[1:])
        return Block(self.run, *columns)  # type: ignore[arg-type]


def joined(blocks: list[Block]) -> Block:
    """Blocks of one run that follow each other, as one."""
    if len(blocks) == 1:
        return blocks[0]
    columns = (
        None if column[0] is None else np.concatenate(column)
        for column in zip(*(block[1:] for block in blocks), strict=True)
    )
    return Block(blocks[0].run, *columns)  # type: ignore[arg-type]


def whole_runs(blocks: Iterable[Block]) -> Iterator[Block]:
    """A block for each run, however long it is."""
    for _, run in groupby(blocks, key=lambda block: block.run):
        yield joined(list(run))


@dataclass(frozen=True, kw_only=True)
class Finding:
    """Something odd in a log, and what was done about it."""

    kind: str = answered('a word for programs, such as "gap" or "jitter"')
    text: str = answered("a sentence for people, with numbers")
    samples: int = answered("how many it concerns; 0 if it concerns all", default=0, only_shown=True)

    def __str__(self) -> str:
        return self.text
