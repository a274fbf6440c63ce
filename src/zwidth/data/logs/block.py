"""What a log is made of: blocks of samples, and what was odd in it."""

from __future__ import annotations

from collections.abc import Iterable, Iterator
from dataclasses import dataclass
from itertools import groupby
from typing import TYPE_CHECKING, Literal, NamedTuple

import numpy as np

if TYPE_CHECKING:
    from numpy.typing import NDArray

    Array = NDArray[np.float64]

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
        """Some of its samples."""
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
    """Something odd in a log, and what was done about it.

    Parameters
    ----------
    kind
        A word for programs, such as "gap" or "jitter".
    text
        A sentence for people, with numbers.
    samples
        How many samples it concerns; 0 if it concerns all.
    """

    kind: str
    text: str
    samples: int = 0

    def __str__(self) -> str:
        return self.text
