"""A log: what a haptic device recorded, as runs of evenly spaced samples.

    t(k) = t₀ + k T        x(k) = n(k) q        for every k of a run

within a run no sample is missing.  A log is read in blocks, as often as wanted,
so that it may be longer than the memory.
"""

from __future__ import annotations

from collections.abc import Callable, Iterator, Mapping, Sequence
from dataclasses import dataclass, field, replace
from math import inf, isclose
from typing import TYPE_CHECKING

from zwidth.data.logs.arrays import table_of
from zwidth.data.logs.block import Block, Finding, Motion
from zwidth.data.logs.build import contents, stated_period
from zwidth.data.logs.scales import meaning_of
from zwidth.errors import InputError

if TYPE_CHECKING:
    import xarray as xr
    from numpy.typing import ArrayLike

SAME = 1e-3
"""Relative difference below which two sample periods, or two resolutions, are one that was measured twice."""


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

    @classmethod
    def from_arrays(
        cls,
        data: xr.Dataset | None = None,
        /,
        *,
        time: ArrayLike | None = None,
        position: ArrayLike | None = None,
        hand_force: ArrayLike | None = None,
        actuator_force: ArrayLike | None = None,
        columns: Mapping[str, str | None] | None = None,
        units: Mapping[str, str] | None = None,
        scale: Mapping[str, object] | None = None,
        sample_rate: object = None,
        sample_period: object = None,
        resolution: object = None,
        counts_per_turn: object = None,
        motion: Motion | None = None,
    ) -> Log:
        """A log from arrays in SI units, or from the variables of a Dataset with their units.

        Parameters
        ----------
        data
            A Dataset whose variables have the attribute `units`, such as a trace; instead of the arrays.
        time
            [s] stamp of each sample; or leave it out and state the rate.
        position
            [m; rad] positive into the wall.
        hand_force
            [N; N·m] of the hand on the device, positive into the wall.
        actuator_force
            [N; N·m] of the actuator, positive out of the wall.
        columns, units, scale, sample_rate, sample_period, resolution, counts_per_turn
            As for `zwidth.read_log`.
        motion
            "linear", where nothing else is said, or "rotary".

        Raises
        ------
        InputError
            If the arrays are of different lengths, or nothing can be learnt from them.
        """
        given = {
            "time": time,
            "position": position,
            "hand_force": hand_force,
            "actuator_force": actuator_force,
        }
        arrays = {name: values for name, values in given.items() if values is not None}
        period = stated_period(sample_rate, sample_period)
        if motion is None and data is None:
            motion = "rotary" if counts_per_turn is not None else "linear"
        table, names = table_of(data, arrays, columns, units, motion or "linear")
        meaning = meaning_of(
            table,
            names,
            units=units,
            scale=scale,
            resolution=resolution,
            counts_per_turn=counts_per_turn,
            motion=motion,
        )
        return cls(**contents(table, meaning, period))

    @classmethod
    def concatenate(cls, logs: Sequence[Log]) -> Log:
        """One log of the runs of all, one after the other; none is read before it is wanted.

        Parameters
        ----------
        logs
            Of the same device: as often sampled, with the same encoder and the same forces.

        Raises
        ------
        InputError
            If there is none, or they differ in that.
        """
        if not logs:
            raise InputError("there is no log to join; give one at least")
        first = logs[0]
        for log in logs[1:]:
            _same(first, log)

        def blocks() -> Iterator[Block]:
            before = 0
            for log in logs:
                for block in log.blocks():
                    yield block._replace(run=block.run + before)
                before += log.runs

        return replace(
            first,
            source=", ".join(log.source for log in logs),
            samples=sum(log.samples for log in logs),
            runs=sum(log.runs for log in logs),
            findings=tuple(
                replace(finding, text=f"{log.source}: {finding.text}")
                for log in logs
                for finding in log.findings
            ),
            stops=(max(log.stops[0] for log in logs), min(log.stops[1] for log in logs)),
            _blocks=blocks,
        )

    def blocks(self) -> Iterator[Block]:
        """Every block from the start; may be called as often as needed."""
        return self._blocks()

    @property
    def duration(self) -> float:
        """[s] of all runs together."""
        return self.samples * self.sample_period


def _same(first: Log, log: Log) -> None:
    if not isclose(log.sample_period, first.sample_period, rel_tol=SAME):
        raise InputError(
            f"{first.source} has a sample period of {first.sample_period:g} s and {log.source} of "
            f"{log.sample_period:g} s: the limit 2b/T is another for each; identify them one by one"
        )
    for what in ("motion", "resolution", "channels"):
        one, other = getattr(first, what), getattr(log, what)
        if one != other and not (what == "resolution" and isclose(one, other, rel_tol=SAME)):
            raise InputError(
                f"{first.source} and {log.source} differ in their {what}, {one!r} and {other!r}: "
                "only logs of one device, recorded alike, can be joined"
            )
