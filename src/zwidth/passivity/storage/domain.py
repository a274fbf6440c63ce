"""Where the hand may be and how fast it may go, in encoder counts; what the device takes out of a move."""

from __future__ import annotations

from dataclasses import dataclass
from fractions import Fraction
from functools import cached_property
from itertools import pairwise
from math import ceil, floor

import numpy as np
from numpy.typing import NDArray

from zwidth.errors import InputError
from zwidth.model.device.device import Device
from zwidth.model.device.friction import FrictionCurve
from zwidth.passivity.storage.law import FiniteLaw
from zwidth.quantity.exact import Exact, RealLike
from zwidth.quantity.text import shown

RELAXING_COUNTS = {0: 24, 1: 6, 2: 3}
"""The same for a law with a part that relaxes, by samples of delay."""

COUNTS = {0: 256, 1: 64, 2: 16, 3: 7, 4: 4, 5: 3, 6: 2}
"""Counts inside, and counts per sample, that are looked at by default, by readings remembered."""

MOST_DEPTHS = 9000
"""Readings inside at which the force of a contact is written down."""

MOST_STATES = 40_000_000
"""States of the largest grid."""


@dataclass(frozen=True)
class Domain:
    """Where the hand may be and how far it may go in one sample, in counts."""

    # the first and the last cell
    lowest: int
    highest: int
    reach: int  # the largest difference of two successive readings
    # the bounds themselves, which need not be whole counts: no motion goes beyond them.  None: the upper edge
    # of the last cell, and the reach.
    max_depth: Fraction | None = None
    max_speed: Fraction | None = None

    @property
    def cells(self) -> int:
        """How many there are."""
        return self.highest - self.lowest + 1

    @property
    def speed(self) -> Fraction:
        """The longest way in one sample, in counts."""
        return Fraction(self.reach) if self.max_speed is None else self.max_speed

    def every(self, counts: int, remembered: int, sides: bool) -> Domain | None:
        """Cells of so many counts within the bounds, the hand in the first count of each; None without any.

        `remembered` readings before the last one; `sides`: the grid ends outside as it does inside.
        """
        within = self.within
        highest, reach = within.highest // counts, floor((self.speed + 1) / counts)
        if highest < 1 or reach < 1:
            return None
        lowest = 1 - (remembered + 1) * reach
        if sides:
            lowest = -(-within.lowest // counts)
        max_depth = self.highest + 1 if self.max_depth is None else self.max_depth
        return Domain(lowest, highest, reach, Fraction(max_depth) / counts, self.speed / counts)

    @property
    def within(self) -> Domain:
        """Only the cells that lie within the bounds."""
        if self.max_depth is None:
            return self
        highest = floor(self.max_depth) - 1
        beyond = self.lowest < -self.highest - 1  # farther out than deep: no depth counts there
        lowest = self.lowest if beyond else max(self.lowest, -floor(self.max_depth))
        return Domain(lowest, highest, self.reach, self.max_depth, self.max_speed)


def losses_of(device: Device, friction: FrictionCurve | None = None) -> Losses:
    """What the hand meets besides the law."""
    resolution, period, delay = (device.exact(k) for k in ("resolution", "sample_period", "delay"))
    if resolution == 0:
        raise InputError(
            "available storage is computed count by count, and the resolution is 0: an ideal encoder has no "
            "counts; zwidth check decides linear laws there exactly"
        )
    samples = ceil(delay / period)
    part = delay / period - samples + 1
    if friction is not None and part < 1:
        raise InputError(
            f"a friction curve is taken with delays of whole samples of {shown(period, 's', 6)}, got "
            f"{shown(delay, 's', 6)}: take a model below the curve, such as curve.best(…)"
        )
    losses = device.exact("damping"), device.exact("coulomb_friction"), resolution, period
    return Losses(*losses, samples, part, friction)


def domain_for(
    law: FiniteLaw, losses: Losses, penetration: RealLike | None = None, speed: RealLike | None = None
) -> Domain:
    """The cells and the largest move.

    `law`, `losses`: the loop; `penetration`: deepest position of the hand [m; rad], > 0; None: as many counts
    as are quickly gone through. For a law on both sides of x = 0 it holds on both.  `speed`: largest mean
    speed of the hand over a sample, or over each part of it between two changes of the force [m/s; rad/s], >
    0; None likewise.
    """
    if law.relaxing is not None and losses.curve is not None:
        raise InputError("a friction curve is not taken with a law that relaxes: take a model below it")
    if law.relaxing is not None and losses.part < 1:
        raise InputError(
            "available storage of a law that relaxes needs a delay of whole samples of "
            f"{shown(losses.period, 's', 6)}, got {shown(losses.lag, 's', 6)}; zwidth check covers sustained "
            "contact"
        )
    memory = law.memory + losses.delay
    usual = (COUNTS if law.relaxing is None else RELAXING_COUNTS).get(memory, 1)
    max_depth = (
        counts_of("penetration", penetration, losses.resolution) or _extent(law, losses) or Fraction(usual)
    )
    max_speed = counts_of("speed", speed, losses.resolution / losses.period)
    highest = max(1, ceil(max_depth) - 1)
    reach = ceil(max_speed) if max_speed else min(usual, 2 * highest + 1)
    lowest = 1 - (memory + 1) * reach  # beyond it, a hand has been forgotten
    if law.surface == "none":
        lowest = -highest - 1
    elif law.relaxing is not None and law.surface == "position":  # which never is
        lowest = min(lowest, -highest - 1)
    return Domain(lowest, highest, reach, max_depth, max_speed or None)


def too_large(law: FiniteLaw, losses: Losses, domain: Domain) -> str | None:
    """Why a grid has more states than are gone through, in words; None if it has not."""
    if law.power is not None and domain.highest > MOST_DEPTHS:
        return (
            f"a contact is looked at up to {MOST_DEPTHS} counts deep, and penetration is "
            f"{domain.highest + 1} counts: give a smaller one"
        )
    memory = law.memory + losses.delay
    if states_of(law, losses, domain) * 9 <= MOST_STATES:
        return None
    return (
        f"the law remembers {memory} readings before the last one, and {domain.cells} counts with moves "
        f"of up to {domain.reach} counts make too many states: give a smaller penetration or speed"
    )


_LONG = 64  # readings of which there are too many states, however few moves there are: 3 ** 64 of them


def states_of(law: FiniteLaw, losses: Losses, domain: Domain) -> int:
    """Cells, readings before and averages of a grid together; of a long memory, that they are too many."""
    remembered = min(law.memory + losses.delay, _LONG)  # a power of millions is never worked out
    states = int(domain.cells * (2 * domain.reach + 1) ** remembered)
    return states * domain.cells if law.relaxing is not None else states


def counts_of(name: str, value: RealLike | None, unit: Fraction) -> Fraction:
    """A bound on the hand in counts; 0 where there is none."""
    if value is None:
        return Fraction(0)
    exact = Exact(value).fraction
    if exact <= 0:
        raise InputError(f"{name} must be > 0, got {value}: a hand that does not move takes nothing out")
    return exact / unit


def _extent(law: FiniteLaw, losses: Losses) -> Fraction:
    """Counts from 0 to the farthest given point of a spring; beyond it the force is constant."""
    if not law.points:
        return Fraction(0)
    ends = (law.points[0][0] / losses.resolution, law.points[-1][0] / losses.resolution)
    return Fraction(max(abs(floor(ends[0])), abs(ceil(ends[1]))) + 2)


# The least loss over a distance D in a time t, for friction f_c + b v or more at speed v:
#
#     c(D) = f_c D + (b/t) D²
#
# For a measured curve F(v), with every model (f_c, b) below it: no less than the largest of
# these, and no more than F(D/t) D, or F_min D for a hand that stops in between.


Integers = NDArray[np.int64]


@dataclass(frozen=True)
class Losses:
    """What a hand meets besides the law, exact."""

    # b [N·s/m] and f_c [N] of the device
    damping: Fraction
    coulomb_friction: Fraction
    # Δ > 0 [m] and T [s]
    resolution: Fraction
    period: Fraction
    delay: int  # samples from a reading to the last interval in which its force acts
    # part of that interval for which it still does, 0 < part ≤ 1; the force of the reading after it
    # follows.  1 for a delay of whole samples.
    part: Fraction = Fraction(1)
    curve: FrictionCurve | None = None  # friction measured at several speeds, in place of b and f_c

    @property
    def lag(self) -> Fraction:
        """The delay [s]."""
        return (self.delay - 1 + self.part) * self.period

    @cached_property
    def models(self) -> tuple[tuple[Fraction, Fraction], ...]:
        """(f_c, b) of which each holds at every speed."""
        if self.curve is None:
            return ((self.coulomb_friction, self.damping),)
        return tuple((m.coulomb_friction.fraction, m.damping.fraction) for m in self.curve.minorants())

    @property
    def max_friction(self) -> tuple[Fraction, Fraction]:
        """(f_c, b) of which neither is ever exceeded."""
        if self.curve is None:
            return self.coulomb_friction, self.damping
        rise = self.curve.forces[-1].fraction - self.curve.forces[-2].fraction
        chord = self.curve.speeds[-1].fraction - self.curve.speeds[-2].fraction
        return max(f.fraction for f in self.curve.forces), max(rise / chord, Fraction(0))

    def lost(self, move: Fraction, part: Fraction) -> Fraction:
        """What a move in a part of an interval may cost, at constant speed or in slow steps [J]."""
        far = abs(move)
        if self.curve is None:
            return self.coulomb_friction * far + self.damping / (part * self.period) * far**2
        points = [(v.fraction, f.fraction) for v, f in zip(self.curve.speeds, self.curve.forces, strict=True)]
        least, slow = min((f, v) for v, f in points)
        speed = far / (part * self.period)
        return far * (least if speed <= slow else _on_chord(points, speed))


def _on_chord(points: list[tuple[Fraction, Fraction]], speed: Fraction) -> Fraction:
    """The curve at a speed: on its chords, before the first point as there, beyond the last as it rises."""
    if speed <= points[0][0]:
        return points[0][1]
    chords = list(pairwise(points))
    (v0, f0), (v1, f1) = next((chord for chord in chords if speed <= chord[1][0]), chords[-1])
    slope = (f1 - f0) / (v1 - v0)
    return f1 + (slope if speed <= v1 else max(slope, Fraction(0))) * (speed - v1)


def outer_costs(
    losses: Losses, far: Integers, span: Fraction, step: Fraction, unit: Fraction, off: int
) -> Integers:
    """At most what a move over 0, 1, … steps in a time costs, also on the chord between two of them.

    far counts the steps, `off` is by how many force units a force may be off; in force units × steps.
    """
    tables = []
    for friction, damping in losses.models:
        drag = floor(damping / span * step / unit)
        lost = np.where(far <= 1, 0, drag * far**2 - (drag + 3) // 4)
        tables.append((floor(friction / unit) - off) * far + lost)
    if len(tables) == 1:
        return tables[0]
    costs = np.array(tables)
    best = np.argmax(costs[:, :-1] + costs[:, 1:], axis=0)  # the model that is taken between two steps
    before, after = np.concatenate(([best[0]], best)), np.concatenate((best, [best[-1]]))
    column = np.arange(far.size)
    out: Integers = np.minimum(costs[before, column], costs[after, column])
    return out


def inner_costs(
    losses: Losses, far: Integers, span: Fraction, step: Fraction, unit: Fraction, off: int
) -> Integers:
    """At least what it costs, likewise."""
    if losses.curve is None:
        drag = ceil(losses.damping / span * step / unit)
        out: Integers = (floor(losses.coulomb_friction / unit) + off + 1) * far + drag * far**2
        return out
    speeds, forces = (
        np.array([float(v) for v in side]) for side in (losses.curve.speeds, losses.curve.forces)
    )
    speed = far * float(step / span)
    slope = max((forces[-1] - forces[-2]) / (speeds[-1] - speeds[-2]), 0.0)
    on_chord = np.interp(speed, speeds, forces) + slope * np.maximum(speed - speeds[-1], 0)
    slow = speeds[forces.argmin()]
    force = np.where(speed <= slow, forces.min(), on_chord) / float(unit)
    out = (np.ceil(force * (1 + 1e-12)).astype(np.int64) + off + 1) * far
    return out
