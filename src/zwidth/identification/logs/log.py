"""A log: what a haptic device recorded, as runs of evenly spaced samples.

    t(k) = t₀ + k T        x(k) = n(k) q        for every k of a run

within a run no sample is missing.  A log is read in blocks, as often as wanted,
so that it may be longer than the memory.
"""

from __future__ import annotations

from collections.abc import Callable, Iterator
from dataclasses import dataclass, field
from math import inf
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


@dataclass(frozen=True, kw_only=True)
class Log:
    """A recording of a device, read in blocks.

    Parameters
    ----------
    source
        Name of the file, or "arrays".
    motion
        "linear" or "rotary".
    sample_period
        [s] T.
    resolution
        [m; rad] step q of the encoder, inferred or stated; 0 if no step is seen.
    samples
        In all blocks together.
    runs
        How many uninterrupted runs there are.
    channels
        Which of hand_force and actuator_force there are.
    findings
        What was odd, and what was done about it.
    stops
        [N; N·m] readings of the hand's force from which on its sensor is at the lower and at the upper end
        of its range; infinite where none is seen.
    """

    source: str
    motion: Motion
    sample_period: float
    resolution: float
    samples: int
    runs: int = 1
    channels: tuple[str, ...] = ()
    findings: tuple[Finding, ...] = ()
    stops: tuple[float, float] = (-inf, inf)
    _blocks: Callable[[], Iterator[Block]] = field(repr=False, compare=False)

    def blocks(self) -> Iterator[Block]:
        """Every block from the start; may be called as often as needed."""
        return self._blocks()

    @property
    def duration(self) -> float:
        """[s] of all runs together."""
        return self.samples * self.sample_period
