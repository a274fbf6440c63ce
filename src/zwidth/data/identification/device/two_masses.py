"""Whether motor and handle move apart, on a cable, a belt or a gear, and the numbers of both sides.

    m₁ ẍ₁ = −f_a − b₁ ẋ₁ − f_c1 sgn ẋ₁ + k (x₂ − x₁) + c (ẋ₂ − ẋ₁)
    m₂ ẍ₂ =       − b₂ ẋ₂ − f_c2 sgn ẋ₂ − k (x₂ − x₁) − c (ẋ₂ − ẋ₁)

One mass and two are fitted to the same log (`observer`), and what both leave of the encoder's readings is
compared.  Only the actuator tells the two sides apart: from the hand's force at the handle to the motor's
position the path is the same with the two sides exchanged (reciprocity),

    x₁ / f_h = (c s + k) / ((m₁ s² + b₁ s)(m₂ s² + b₂ s) + (c s + k)((m₁ + m₂) s² + (b₁ + b₂) s)) .
"""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass
from math import pi, sqrt

import numpy as np
from scipy.special import chdtri

from zwidth.data.identification.device.choice import SURE
from zwidth.data.identification.device.estimate import Estimate, student, unit_of
from zwidth.data.identification.device.observer import (
    BLOCKS,
    LOGARITHM,
    NAMES,
    ONE,
    Fit,
    Stretches,
    stretches,
)
from zwidth.data.logs import Log
from zwidth.native.compiled import Array

_LIKE = {name: name.removeprefix("handle_") for name in NAMES} | {"inside": "damping"}
"""Whose unit is meant."""

MOST, FEW = 60_000, 3_000
"""Samples that are used, and on which starts are compared."""

FEWEST = 2_000
"""Samples below which nothing is concluded."""

LOOSE = 0.03
"""Of the observer by which starts are compared."""

TIGHTER = (0.1, 0.03, 0.01)
"""Of the observers of the best starts, one after the other."""

ROUNDS = 8
"""Of Gauss and Newton at most, with each of them."""

STARTS = tuple(20.0 * 2 ** (step / 2) for step in range(11))
"""Frequencies at which the two may swing against each other [Hz]."""

DAMPED, KEPT = 0.1, 5
"""Twice the ratio to critical damping of that swing, and how many of the starts are gone on from."""

ALIKE = 0.1
"""Part by which masses or stiffness of two starts that both are kept differ at least."""

SHARES = (0.5, 0.1)
"""Of the mass, what may be behind the cable."""

PART = 0.5
"""Of what the observer before the last finds otherwise, that is taken for the error of the method."""

EXPLAINED = 1.2
"""Times the surprise expected of the encoder's steps that may be left."""


@dataclass(frozen=True)
class TwoMasses:
    """Both sides of what gives way."""

    motor: Mapping[str, Estimate]
    """By name of a parameter of `Device`."""
    between: Mapping[str, Estimate]
    """By name of a parameter of `Transmission`."""
    both: Estimate
    """Damping of both sides, by one mass [N·s/m; N·m·s/rad]: that of one is no more."""
    explain: bool
    """True where they leave no more than the encoder's steps."""

    def relied_on(self, motor: float, inside: float, handle: float) -> float:
        """b₁ + c b₂/(c + b₂) ≥ 0, which the motor feels whatever the hand does [N·s/m; N·m·s/rad]."""
        motor, inside, handle = (max(each, 0.0) for each in (motor, inside, handle))
        return motor + (inside * handle / (inside + handle) if inside else 0.0)

    @property
    def damping(self) -> Estimate:
        """The best guess of it, its error as if the errors of all three went one way."""
        b, c, h = (max(each.value, 0.0) for each in self._three)
        weights = (1.0, (h / (c + h)) ** 2, (c / (c + h)) ** 2) if c + h else (1.0, 0.0, 0.0)
        error = sum(w * each.error for w, each in zip(weights, self._three, strict=True))
        return self.motor["damping"]._replace(value=self.relied_on(b, c, h), error=error)

    def least_damping(self, confidence: float) -> float:
        """The same of the low ends of all three, and no more than both sides have."""
        least = self.relied_on(*(each.interval(confidence)[0] for each in self._three))
        return min(least, max(self.both.interval(confidence)[0], 0.0))

    @property
    def _three(self) -> tuple[Estimate, Estimate, Estimate]:
        return self.motor["damping"], self.between["damping"], self.between["handle_damping"]

    @property
    def resonance(self) -> float:
        """At which the two swing against each other, nobody at the handle [Hz]."""
        one, other = self.motor["mass"].value, self.between["handle_mass"].value
        return sqrt(self.between["stiffness"].value * (1 / one + 1 / other)) / (2 * pi)


def seen_to_swing(log: Log, one: Mapping[str, Estimate], delay: float) -> bool:
    """True where the log would show what swings: the actuator shakes, nobody at the handle."""
    if log.channels != ("actuator_force",):
        return False
    seen = stretches(log, delay, MOST)
    enough = sum(read.size for read in seen.read) >= FEWEST
    return enough and seen.shakes(one["coulomb_friction"].value)


def two_masses(log: Log, one: Mapping[str, Estimate], delay: float) -> TwoMasses | None:
    """Both sides, where a log surely shows two: of the actuator's force alone, nobody at the handle.

    `one` has mass, damping and Coulomb friction of one mass; the delay is in samples.
    """
    seen = stretches(log, delay, MOST)
    alone = _tightened(seen, np.array([*(max(one[name].value, 1e-6) for name in NAMES[: ONE - 1]), 0.0]))
    two = _tightened(seen, *_starts(seen, alone.values))
    if not _surely_less(two, alone):
        return None
    errors = two.errors * np.where(LOGARITHM, two.values, 1.0)
    shifts = PART * np.abs(two.values - seen.fit(two.values, TIGHTER[-2], ROUNDS).values)
    found = {
        name: Estimate(
            float(value), float(error), float(shift), BLOCKS - len(NAMES), unit_of(_LIKE[name], log.motion)
        )
        for name, value, error, shift in zip(NAMES, two.values, errors, shifts, strict=True)
        if name != "offset"
    }
    motor = {name: found.pop(name) for name in NAMES[: ONE - 1]}
    return TwoMasses(
        motor,
        {("damping" if name == "inside" else name): found[name] for name in found},
        one["damping"],
        not log.resolution or two.share <= EXPLAINED,
    )


def _starts(seen: Stretches, alone: Array) -> list[Array]:
    """Numbers of two masses that are worth to go on from, all of the log in view."""
    few, (m, b, f, offset), tried = seen.part(FEW), alone, []
    for frequency in STARTS:
        for share in SHARES:
            one, other = (1 - share) * m, share * m
            k = (2 * pi * frequency) ** 2 * one * other / m
            c = DAMPED * 2 * pi * frequency * one * other / m
            tried.append(few.fit(np.array([one, b / 2, f / 2, offset, other, b / 2, f / 2, k, c]), LOOSE, 5))
    kept: list[Array] = []
    for fit in sorted(tried, key=lambda fit: fit.cost):
        if all(abs(np.log(fit.values[[0, 4, 7]] / each[[0, 4, 7]])).max() > ALIKE for each in kept):
            kept.append(fit.values)
    return kept[:KEPT]


def _tightened(seen: Stretches, *starts: Array) -> Fit:
    """The best of these, each observer but half as many as the one before."""
    for loose in TIGHTER:
        found = sorted((seen.fit(values, loose, ROUNDS) for values in starts), key=lambda fit: fit.cost)
        starts = tuple(fit.values for fit in found[: (len(starts) + 1) // 2])
    return found[0]


def _surely_less(two: Fit, alone: Fit) -> bool:
    """True where two masses leave less than one, more than chance explains."""
    scale = two.cost * two.slopes.shape[0] / two.left.size
    parts = np.array([part.sum() for part in np.array_split(alone.left**2 - two.left**2, BLOCKS)]) / scale
    reach = student(SURE, BLOCKS - 1) * float(parts.std()) * sqrt(BLOCKS)
    return bool(parts.sum() > max(chdtri(len(NAMES) - ONE, 1 - SURE), reach))
