"""What a machine and the link to a device are like: lateness of the samples, time that a question takes."""

from __future__ import annotations

from collections.abc import Iterable
from dataclasses import dataclass
from fractions import Fraction
from math import ceil
from typing import Any

import numpy as np

from zwidth.model.device.device import Device
from zwidth.native.compiled import Array
from zwidth.quantity.exact import Exact, Interval, ends
from zwidth.showing import Part, Shown

_MICROSECOND = Fraction(1, 1_000_000)


@dataclass(frozen=True, repr=False)
class Measured(Shown):
    """Of a loop that ran with force 0.

    Parameters
    ----------
    samples, missed
        How many were taken, and how many were not because the loop came a period late or more.
    lateness
        Median, 99 % and largest [s].
    exchange
        From the start of a sample to its force being on its way: median, 99 % and largest [s].
    waits
        Samples for which a force waits by the protocol.
    """

    samples: int
    missed: int
    lateness: tuple[float, float, float]
    exchange: tuple[float, float, float]
    waits: int

    @property
    def supposed(self) -> tuple[Fraction, Fraction]:
        """Lateness and exchange that a verdict supposes, which 99 % of the samples keep to [s]."""
        return _rounded_up(self.lateness[1]), _rounded_up(self.exchange[1])

    def delay(self, device: Device) -> Exact | Interval:
        """What a verdict is asked for: that of the device, or what 99 % keep to, whichever is longer [s]."""
        link = self.supposed[1] + self.waits * ends(device.sample_period)[1]
        low, high = (max(link, end) for end in ends(device.delay))
        return Exact(low) if low == high else Interval(low, high)

    def longest_period(self, period: Fraction) -> Fraction:
        """T and the lateness that 99 % of the samples keep to [s]."""
        return period + self.supposed[0]

    def to_dict(self) -> dict[str, Any]:
        """The same with a unit in every key."""
        names = ("median", "of_99_percent", "largest")
        return {
            "samples": self.samples,
            "missed_samples": self.missed,
            "lateness_s": dict(zip(names, self.lateness, strict=True)),
            "exchange_s": dict(zip(names, self.exchange, strict=True)),
            "samples_a_force_waits": self.waits,
        }

    def report(self) -> Iterable[Part]:
        """Two lines."""
        more = f", and {self.waits} sample more by the protocol" if self.waits else ""
        yield f"{self.samples} samples with force 0: late by {_told(self.lateness)}; {self.missed} missed"
        yield f"from a sample to its force on its way: {_told(self.exchange)}{more}"


def measured(late: Array, exchange: Array, missed: int, waits: int) -> Measured:
    """From the columns of a run."""
    return Measured(late.size, missed, _three(late), _three(exchange), waits)


def _three(times: Array) -> tuple[float, float, float]:
    p50, p99, most = np.quantile(times, [0.5, 0.99, 1.0], method="higher")
    return float(p50), float(p99), float(most)


def _told(times: tuple[float, float, float]) -> str:
    p50, p99, most = (f"{1e6 * t:.3g}" for t in times)
    return f"{p50} µs median, {p99} µs in 99 %, {most} µs at most"


def _rounded_up(seconds: float) -> Fraction:
    return ceil(seconds * 1_000_000) * _MICROSECOND
