"""What a link does to packets: delay, jitter, loss in bursts, duplicates.

Packet j is sent at the end of period j, at (j + 1) T, and heard at the first sample by which it has arrived.
"""

from __future__ import annotations

from collections.abc import Iterator
from dataclasses import dataclass
from fractions import Fraction
from math import ceil
from typing import TYPE_CHECKING

import numpy as np

from zwidth.errors import InputError
from zwidth.quantity.exact import Exact
from zwidth.quantity.glossary import Quantity
from zwidth.quantity.parameter import Certain, Count, Parametric, parameter, plain
from zwidth.quantity.text import shown

if TYPE_CHECKING:
    from numpy.typing import NDArray

    Ticks = NDArray[np.int64]

LOST = -1
"""In the place of the sample at which a packet arrives."""

_EARLY = "a packet cannot arrive before it is sent"
_JITTER = Quantity("jitter", "", "s", "s", "at most this much later than the delay, each packet by itself")
_LOSS = plain("loss", "share of the packets that is lost")
_TWICE = plain("duplicates", "share of the packets that arrives twice")
_SHARE = "it is a share of all packets"
_BURST = plain("burst", "packets that are lost in a row, in the mean")


@dataclass(frozen=True)
class Schedule(Parametric):
    """A link that keeps each packet for the delay and up to the jitter more, and loses some.

    Packets overtake each other where the jitter is longer than a sample period.

    Parameters
    ----------
    delay
        ≥ 0, each way [s].
    jitter
        ≥ 0, drawn evenly for each packet [s].
    loss
        Share of the packets that is lost, 0 ≤ loss < 1.
    burst
        How many are lost in a row, in the mean, ≥ 1 (Gilbert 1960); 1 / (1 − loss) where each by itself.
    duplicates
        Share that arrives twice, 0 … 1.
    seed
        Of the draws: the same seed gives the same link.
    """

    delay: Certain = parameter("link_delay", 0, kept=Exact, bound="≥ 0", why=_EARLY, meaning="each way")
    jitter: Certain = parameter(_JITTER, 0, kept=Exact, bound="≥ 0", why=_EARLY)
    loss: Certain = parameter(_LOSS, 0, kept=Exact, bound="≥ 0", why=_SHARE)
    burst: Certain = parameter(_BURST, 1, kept=Exact, bound="> 0", why="a loss is of one packet at least")
    duplicates: Certain = parameter(_TWICE, 0, kept=Exact, bound="≥ 0", why=_SHARE)
    seed: Count = parameter(
        plain("seed", "of the draws"), 1, kept=int, bound="≥ 0", why="it counts the draws"
    )

    def __post_init__(self) -> None:
        super().__post_init__()
        not_one = self.burst < 1 or (self.burst > 1 and not self.loss)
        alone = "so many packets are lost in a row; give both, such as a loss of 0.1"
        for key, wrong, bound, why in (
            ("loss", self.loss >= 1, "below 1", "a link that loses all joins nothing"),
            ("burst", not_one, "≥ 1, and 1 without a loss", alone),
            ("duplicates", self.duplicates > 1, "at most 1", "it is the share that comes twice"),
        ):
            if wrong:
                raise InputError(f"{key} must be {bound}, got {float(getattr(self, key)):g}: {why}")

    def samples_late(self, period: Fraction) -> int:
        """Whole samples that the delay makes, rounded up: so late is a packet without jitter."""
        return ceil(self.delay.fraction / period)

    def arrivals(self, count: int, period: Fraction, way: int) -> tuple[Ticks, Ticks]:
        """At which sample each of `count` packets is heard, and its duplicate; `LOST` where it is not.

        Parameters
        ----------
        count
            Packets.
        period
            T [s].
        way
            0 or 1: there or back; each is drawn by itself, the same for the first packets of more.
        """
        first, second, bursts, doubled = (np.random.default_rng((self.seed, way, k)) for k in range(4))
        sent = np.arange(1, count + 1)
        delay, jitter = (float(given.fraction / period) for given in (self.delay, self.jitter))
        times = [
            np.ceil(delay + draws.random(count) * jitter - 1e-9).astype(np.int64) + sent
            for draws in (first, second)
        ]
        kept = ~np.fromiter(self.losses(iter(bursts.random(count + 1))), np.bool_, count)
        twice = kept & (doubled.random(count) < float(self.duplicates))
        return np.where(kept, times[0], LOST), np.where(twice, times[1], LOST)

    def losses(self, draws: Iterator[float]) -> Iterator[bool]:
        """Of each packet whether it is lost: Gilbert's two states, in the one all are, in the other none.

        Parameters
        ----------
        draws
            Numbers drawn evenly from 0 to 1, one more than packets.
        """
        share = float(self.loss)
        back = 1.0 / max(float(self.burst), 1.0 / (1.0 - share))
        there = share * back / (1.0 - share)
        bad = next(draws) < share
        for draw in draws:
            yield bad
            bad = draw >= back if bad else draw < there

    def describe(self) -> str:
        """The link on one line."""
        told = [f"{shown(self.delay, 's')} each way"]
        if self.jitter:
            told.append(f"up to {shown(self.jitter, 's')} jitter")
        if self.loss:
            bursts = f" in bursts of {float(self.burst):g}" if self.burst > 1 else ""
            told.append(f"{float(self.loss):.0%} lost{bursts}")
        if self.duplicates:
            told.append(f"{float(self.duplicates):.0%} twice")
        return ", ".join(told)
