"""What a device takes out of a move, by friction, and when its forces act.

The least loss over a distance D in a time t, for friction f_c + b v or more at speed v:

    c(D) = f_c D + (b/t) D²

For a measured curve F(v), with every model (f_c, b) below it: no less than the largest of
these, and no more than F(D/t) D, or F_min D for a hand that stops in between.
"""

from __future__ import annotations

from dataclasses import dataclass
from fractions import Fraction
from functools import cached_property
from itertools import pairwise
from math import ceil, floor

import numpy as np
from numpy.typing import NDArray

from zwidth.model.device.friction import FrictionCurve

Integers = NDArray[np.int64]


@dataclass(frozen=True)
class Losses:
    """What a hand meets besides the law, exact.

    Parameters
    ----------
    damping, coulomb_friction
        b [N·s/m] and f_c [N] of the device.
    resolution, period
        Δ > 0 [m] and T [s].
    delay
        Samples from a reading to the last interval in which its force acts.
    part
        Part of that interval for which it still does, 0 < part ≤ 1; the force of the
        reading after it follows.  1 for a delay of whole samples.
    curve
        Friction measured at several speeds, in place of b and f_c.
    """

    damping: Fraction
    coulomb_friction: Fraction
    resolution: Fraction
    period: Fraction
    delay: int
    part: Fraction = Fraction(1)
    curve: FrictionCurve | None = None

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
