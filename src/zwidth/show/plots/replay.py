"""A witness played back sample by sample: position, held force, energy taken out.

Arithmetic is exact for short motions, as in the checker, and in floating point
for long ones; the encoder's counts are exact in both.
Only the first few rounds of a repeated part are played.
"""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass
from fractions import Fraction
from typing import NamedTuple

from zwidth.passivity.witness.motion import Motion
from zwidth.passivity.witness.touching import TouchedSetting
from zwidth.passivity.witness.witness import Setting, Witness

ROUNDS = 3
"""Rounds of a repeated part that are shown."""

WHOLE = "the whole motion"
"""The caption of a motion that is shown from start to end."""

_LEAD = 60
"""Samples before a repeated part up to which they are shown too."""

_EXACT = 300
"""Samples up to which arithmetic is exact; beyond, digits grow and time with them."""

_MANY = 10**9
"""Rounds from which on they are told to four digits."""

_FULL = 20_000
"""Samples of a motion with several repeated parts up to which all of it is played."""


@dataclass(frozen=True)
class Replay:
    """What is shown of a motion.

    Parameters
    ----------
    times, positions, energies
        At the samples and at the instants when a delayed force changes
        [s; m or rad; J]; the energy is counted from the first of them.
    forces
        The force applied from each of these instants to the next [N or N·m].
    sampled
        Indices of the samples in `times`.
    caption
        What is shown of how much.
    """

    times: list[float]
    positions: list[float]
    energies: list[float]
    forces: list[float]
    sampled: list[int]
    caption: str


_Real = Fraction | float


class _Step(NamedTuple):
    """From one instant to the next at constant velocity under one force."""

    length: Fraction
    move: _Real
    force: _Real


def replay(witness: Witness) -> Replay:
    """Play a witness, shortened to what can be seen."""
    x, y, first, caption = _unrolled(witness)
    steps = _steps(witness.setting, x, y)
    zero: _Real = Fraction(0) if len(x) <= _EXACT else 0.0
    per_sample = 2 if witness.setting.loop.part_delay else 1
    times, positions, energies = [zero], [zero + x[0]], [zero]
    setting = witness.setting
    for step in steps:
        times.append(times[-1] + step.length)
        positions.append(positions[-1] + step.move)
        energies.append(energies[-1] + _gain(setting, step))
    start = first * per_sample
    return Replay(
        [float(t) for t in times[start:]],
        [float(p) for p in positions[start:]],
        [float(e - energies[start]) for e in energies[start:]],
        [float(s.force) for s in steps[start:]],
        list(range(0, len(times) - start, per_sample)),
        caption,
    )


def _gain(setting: Setting, step: _Step) -> _Real:
    """−f Δx − f_c |Δx| − b Δx²/Δt."""
    rubbed = setting.coulomb_friction * (step.move if step.move > 0 else -step.move)
    viscous = setting.loop.damping * step.move * step.move / step.length
    return -step.force * step.move - rubbed - viscous


def _unrolled(witness: Witness) -> tuple[list[Fraction], list[Fraction], int, str]:
    """(positions, switch positions, first sample shown, caption)."""
    motion = witness.motion
    parts = [r for r in motion.repeats if r.times > 1]
    if not parts:
        x, y = _play(motion, motion.rounds)
        return x, y, 0, WHOLE
    if len(parts) == 1 and parts[0].times > ROUNDS:
        x, y = _play(motion, ROUNDS)
        part = parts[0]
        stop = part.first + ROUNDS * (part.last - part.first)
        first = 0 if part.first <= _LEAD else part.first
        y = y[:stop] if y else y
        times = f"{part.times:,}" if part.times < _MANY else f"{part.times:.4g}"
        return x[: stop + 1], y, first, f"{ROUNDS} of {times} rounds"
    rounds = motion.rounds if motion.samples <= _FULL else ROUNDS
    x, y = _play(motion, rounds)
    whole = rounds == motion.rounds
    return x, y, 0, WHOLE if whole else f"shortened: repeated parts {ROUNDS} times each"


def _play(motion: Motion, most: int) -> tuple[list[Fraction], list[Fraction]]:
    """All positions in time, each repeated part at most so often."""
    order: list[tuple[int, Fraction]] = []  # index into the list, how far ahead
    ahead, before = Fraction(0), 0
    for part in motion.repeats:
        order += [(k, ahead) for k in range(before, part.first)]
        times = min(part.times, most)
        advance = motion.positions[part.last] - motion.positions[part.first]
        for r in range(times):
            order += [(k, ahead + r * advance) for k in range(part.first, part.last)]
        ahead += (times - 1) * advance
        before = part.last
    order += [(k, ahead) for k in range(before, len(motion.positions))]
    x = [motion.positions[k] + shift for k, shift in order]
    y = [motion.switch_positions[k] + shift for k, shift in order[:-1]] if motion.switch_positions else []
    return x, y


def _steps(setting: Setting, x: Sequence[Fraction], y: Sequence[Fraction]) -> list[_Step]:
    loop, forces = setting.loop, _forces(setting, x)
    late, alpha = loop.whole_delay, loop.part_delay

    def applied(k: int) -> _Real:
        return forces[k] if k >= 0 else Fraction(0)

    steps = []
    for k in range(len(x) - 1):
        middle = y[k] if alpha else x[k]
        if alpha:
            steps.append(_Step(alpha * loop.period, middle - x[k], applied(k - late - 1)))
        steps.append(_Step((1 - alpha) * loop.period, x[k + 1] - middle, applied(k - late)))
    return steps


def _forces(setting: Setting, x: Sequence[Fraction]) -> list[_Real]:
    """f(k) by the direct form D w = x, f = N w, from the position that the encoder reads."""
    n, d, count = setting.loop.numerator, setting.loop.denominator, setting.resolution
    if isinstance(setting, TouchedSetting):
        return list(setting.forces(tuple(x)))
    zero: _Real = Fraction(0) if len(x) <= _EXACT else 0.0
    past: list[_Real] = []  # w, the newest last
    forces = []
    for position in x:
        read = count * (position // count) if count else position
        inside = max(read, Fraction(0)) if setting.unilateral else read
        w = inside - sum((a * past[-i] for i, a in enumerate(d) if 0 < i <= len(past)), zero)
        past.append(w / d[0])
        forces.append(sum((a * past[-1 - i] for i, a in enumerate(n) if i < len(past)), zero))
    return forces
