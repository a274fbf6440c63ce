"""Which hands an outcome is about: how fast and how deep, as exact data."""

from __future__ import annotations

from dataclasses import dataclass
from fractions import Fraction
from itertools import pairwise

from zwidth.passivity.document import unit_key
from zwidth.passivity.scope import Hands
from zwidth.passivity.storage.domain import Domain
from zwidth.passivity.storage.law import FiniteLaw
from zwidth.passivity.storage.losses import Losses
from zwidth.passivity.witness.motion import Motion
from zwidth.quantity.text import exact_text


@dataclass(frozen=True)
class HandBounds:
    """Bounds on the hand, exact.

    Parameters
    ----------
    speed
        Largest mean speed over a sample, or over each part of it with one force [m/s; rad/s].
    penetration
        Deepest position that a proof covers, a whole number of counts [m; rad].
    max_depth
        Deepest position of a motion that refutes, at most `penetration` [m; rad].
    outside
        How far outside the hand may go [m; rad]; None: any distance.
    resolution, period
        Δ [m; rad] and T [s].
    """

    speed: Fraction
    penetration: Fraction
    max_depth: Fraction
    outside: Fraction | None
    resolution: Fraction
    period: Fraction

    @property
    def counts_per_sample(self) -> Fraction:
        """The speed in counts a sample."""
        return self.speed * self.period / self.resolution

    @property
    def counts_deep(self) -> int:
        """The depth of a proof in counts."""
        return int(self.penetration / self.resolution)

    def hands(self, in_each_part: bool) -> Hands:
        """The hands of a proof, for its scope."""
        return Hands(
            speed=float(self.speed),
            in_each_part=in_each_part,
            inside=float(self.penetration),
            outside=None if self.outside is None else float(self.outside),
            counts_a_sample=float(self.counts_per_sample),
            counts_inside=float(self.counts_deep),
        )

    def document(self, motion: str) -> dict[str, str]:
        """What a motion keeps to, as data for the checker."""
        length = unit_key("position", motion).removeprefix("position_")
        document = {
            f"speed_{length}_per_s": exact_text(self.speed),
            f"depth_{length}": exact_text(self.max_depth),
        }
        if self.outside is not None:
            far = self.max_depth if self.outside == self.penetration else self.outside
            document[f"outside_{length}"] = exact_text(far)
        return document


def hand_bounds(law: FiniteLaw, losses: Losses, domain: Domain) -> HandBounds:
    """The bounds of a domain, whose cells are those of the losses."""
    step = losses.resolution
    outside: Fraction | None = None
    if law.surface == "none" or (law.relaxing is not None and law.surface == "position"):
        outside = -domain.lowest * step
    max_depth = domain.highest + 1 if domain.max_depth is None else domain.max_depth
    return HandBounds(
        domain.speed * step / losses.period,
        (domain.highest + 1) * step,
        max_depth * step,
        outside,
        step,
        losses.period,
    )


def max_mean_speed(motion: Motion, period: Fraction, part: Fraction) -> Fraction:
    """Largest mean speed over each time in which one force is held [m/s; rad/s]."""
    x, switches = motion.positions, motion.switch_positions
    if not switches:
        return max(abs(b - a) for a, b in pairwise(x)) / period
    early = max(abs(m - a) for a, m in zip(x[:-1], switches, strict=True)) / part
    late = max(abs(b - m) for b, m in zip(x[1:], switches, strict=True)) / (1 - part)
    return max(early, late) / period
