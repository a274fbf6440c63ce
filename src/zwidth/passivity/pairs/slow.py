"""A motion at constant speeds, with which compensation of friction gives more than friction takes.

Both hands go at v_l and v_f, far, and back: every sample gains T times

    Σ w (F tanh(|v|/v_s) − f_c) |v| − vᵀ M(0) v,

M(0) the form of the pair at θ → 0 with C counted.  What the way in and the turn cost is gone once the hands
go far enough.
"""

from __future__ import annotations

from fractions import Fraction

import numpy as np
from numpy.typing import NDArray

from zwidth.model.pairs import Pair
from zwidth.passivity.pairs.arm import Arm
from zwidth.passivity.pairs.criterion import PairCriterion
from zwidth.passivity.pairs.evidence import PairWitness, energy_of
from zwidth.passivity.pairs.motions import often_enough, out_and_back, repeated, stored_at_start, with_turns
from zwidth.passivity.witness.motion import Motion

Floats = NDArray[np.float64]

_POINTS = 33
_ZOOMS = 12
_DECADES = 6
_DIGITS = 9


def refute_compensation(pair: Pair) -> PairWitness | None:
    """Both hands at the speeds with which most comes out; None if nothing comes out at any."""
    criterion = PairCriterion(pair)
    speeds = _worst_speeds(criterion)
    if speeds is None:
        return None
    period, often = pair.sample_period, pair.own_readings
    steps = [
        _whole_counts(Fraction(f"{v:.{_DIGITS}g}") * period, arm.side.resolution) / often
        for v, arm in zip(speeds, criterion.arms, strict=True)
    ]
    way, parts = out_and_back(often)
    one = [Motion(tuple(step * k for k in way), (), parts) for step in steps]
    one = with_turns(pair, one)
    stored = stored_at_start(pair)

    def energy(times: int) -> Fraction | None:
        out = energy_of(pair, *repeated(one, times))
        return None if out is None else out - stored

    times = often_enough(energy, criterion, parts)
    if times is None:
        return None
    found = repeated(one, times)
    out = energy_of(pair, *found)
    return PairWitness(pair, *found, out) if out is not None and out > stored else None


def _whole_counts(move: Fraction, count: Fraction) -> Fraction:
    """A move of a sample as it is read alike in every one."""
    if not count or not move:
        return move
    sign = 1 if move > 0 else -1
    return sign * count * max(1, round(abs(move) / count))


def _worst_speeds(criterion: PairCriterion) -> tuple[float, float] | None:
    """Where the gain over the square of both speeds is largest; None where it is nowhere above 0."""
    form = np.real(criterion.at(0.0))
    arms = criterion.arms
    near = [_speed_of(arm, float(form[i, i])) for i, arm in enumerate(arms)]
    if not any(near):
        return None
    middle = [float(np.log(v or max(near))) for v in near]
    half, best = _DECADES * np.log(10), -np.inf
    for _ in range(_ZOOMS):
        line = np.linspace(-half, half, _POINTS)
        first, second = np.meshgrid(middle[0] + line, middle[1] + line, indexing="ij")
        found = _gain(arms, form, np.exp(first), np.exp(second))
        at = np.unravel_index(np.argmax(found), found.shape)
        best, middle, half = float(found[at]), [float(first[at]), float(second[at])], half / 4
    if best <= 0:
        return None
    sign = -1 if form[0, 1] > 0 else 1
    return float(np.exp(middle[0])), sign * float(np.exp(middle[1]))


def _speed_of(arm: Arm, damping: float) -> float:
    """About which compensation of Coulomb friction bends or has paid off; 0 without any [m/s; rad/s]."""
    law = arm.side.compensation
    if law.speed or not law.coulomb:
        return float(law.speed) if law.coulomb else 0.0
    more = float(law.coulomb.fraction - arm.side.coulomb_friction)
    return (more if more > 0 else float(law.coulomb)) / (2 * abs(damping) or 1.0)


def _gain(arms: tuple[Arm, Arm], form: Floats, first: Floats, second: Floats) -> Floats:
    """What a sample gains over T and the squares of both speeds, both > 0, in the better of both senses."""
    total = 2 * abs(form[0, 1]) * first * second
    for i, (arm, v) in enumerate(zip(arms, (first, second), strict=True)):
        law = arm.side.compensation
        bent = np.tanh(v / float(law.speed)) if law.speed else 1.0
        dry = float(law.coulomb) * bent - float(arm.side.coulomb_friction)
        total = total + float(arm.weight) * dry * v - form[i, i] * v**2
    return np.asarray(total / (first**2 + second**2))
