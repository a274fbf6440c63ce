"""The motions that a hand tries against every law, one round of each.

Those that take energy out of held springs, encoders and filters: across one edge and back,
fast in and fast out over more and more counts, slow one way and fast the other, with
rests at either end, and sinusoids inside and through the surface; those that earn credit which
a law should not give: to and fro over an edge before a leap, up within a count and out of it.
And those that are found against the wall alone, by proof and by the game of the worst hand.
"""

from __future__ import annotations

from collections.abc import Iterator
from fractions import Fraction
from math import cos, isfinite, pi

import numpy as np
from numpy.typing import NDArray

from zwidth.device.device import Device
from zwidth.environment.wall import Wall
from zwidth.errors import InputError
from zwidth.passivity.check import check_by_closed_forms
from zwidth.passivity.motion import Motion
from zwidth.passivity.witness import Witness
from zwidth.passivity.worst_hand import worst_hand

REALISTIC = 1.0
"""Speed about which a hand reaches [m/s]: what gains below it is tried first."""

IDEAL_COUNT = 1e-4
"""What stands for a count where the encoder is ideal [m]."""

EDGE = 0.02
"""How far beside an edge of the encoder a hand turns round, in counts."""

SECONDS = 2.0
"""Time for each game against the wall alone."""

LONGEST_ROUND = 2000
"""Samples of a found motion that is tried as one round."""

Floats = NDArray[np.float64]


def count_of(device: Device) -> float:
    """Δ, or what stands for it [m]."""
    return float(device.exact("resolution")) or IDEAL_COUNT


def as_speed(device: Device, fastest: float) -> float:
    """The speed of the fastest hand [m/s].

    Raises
    ------
    InputError
        If it does not cross an edge of the encoder within a sample, or is no finite number.
    """
    least = 2.5 * EDGE * count_of(device) / float(device.exact("sample_period"))
    if not (isfinite(fastest) and fastest >= least):
        raise InputError(
            f"fastest is the speed of a hand [m/s], finite and at least {least:.3g} to cross an edge of the "
            f"encoder and come back, got {fastest}: a hand reaches about {REALISTIC:g} m/s"
        )
    return float(fastest)


def speed_of(positions: Floats, period: float) -> float:
    """Largest mean speed over a sample, from round to round too [m/s]."""
    return float(np.max(np.abs(np.diff(positions, append=positions[0])))) / period


def fixed_motions(device: Device, fastest: float) -> dict[str, Floats]:
    """One round of each motion of the fixed set, by what it does; none faster than `fastest` [m/s]."""
    count, period = count_of(device), float(device.exact("sample_period"))
    found: dict[str, Floats] = {}
    for n in _amplitudes(count, period, fastest):
        found.update(_strokes(n))
        found.update(_sinusoids(n))
        found.update(_credited(n))
    found.update(_within_a_count())
    moved = {name: count * positions for name, positions in found.items()}
    return {name: x for name, x in moved.items() if speed_of(x, period) <= fastest}


def _amplitudes(count: float, period: float, fastest: float) -> list[int]:
    """In counts: doubled up to 64, then times four; and as far as each of the two speeds reaches."""
    reach = [int(speed * period / count) for speed in (min(REALISTIC, fastest), fastest)]
    doubled = {2**k for k in range(7)} | {4**k for k in range(4, 20) if 4**k < max(reach)}
    return sorted(doubled | {n for n in reach if n >= 1})


def _strokes(n: int) -> Iterator[tuple[str, Floats]]:
    """Over n counts and back, in counts; over one edge where n = 1."""
    for name, start in (("from the surface", 0.0), ("inside", float(n))):
        low, high = start - EDGE, start + n + EDGE - 1
        if n == 1:
            low, high = start + 1 - EDGE, start + 1 + EDGE
        for rest in (1, 2, 4):
            there = [low] * rest + [high] * rest
            yield f"{n} counts and back {name}, {rest} samples at each end", np.array(there)
        for slow in (4, 16):
            way = np.linspace(low, high, slow + 1)
            yield f"{n} counts {name}, slowly in and fast out", np.concatenate([way, [low]])
            yield f"{n} counts {name}, fast in and slowly out", np.concatenate([[low], way[::-1]])


def _sinusoids(n: int) -> Iterator[tuple[str, Floats]]:
    for period in (3, 4, 6, 10, 20):
        wave = n * np.array([cos(2 * pi * k / period) for k in range(period)])
        yield f"a sinusoid of {n} counts and {period} samples, inside", wave + 3 * n
        yield f"a sinusoid of {n} counts and {period} samples, through the surface", wave


def _credited(n: int) -> Iterator[tuple[str, Floats]]:
    """To and fro over an edge outside, then n counts in and out again, at once or slowly in."""
    for samples in (20, 400):
        jitter = -1 + 0.001 * np.where(np.arange(samples) % 2, 1.0, -1.0)
        way = np.linspace(0, n + 0.5, min(n, 32) + 1)
        yield f"{samples} samples over an edge, then {n} counts in and out", np.append(jitter, n + 0.5)
        yield f"{samples} samples over an edge, then {n} counts slowly in", np.concatenate([jitter, way])


def _within_a_count() -> Iterator[tuple[str, Floats]]:
    """Slowly through a count, out of it over its edge, and back in one sample."""
    for start in (0, 1, 8):
        up = np.linspace(start + 1e-6, start + 1 - 1e-6, 20)
        yield f"slowly up within count {start}, then out of it", np.append(up, start + 1 + 1e-6)


def found_motions(device: Device, wall: Wall, fastest: float) -> dict[str, Floats]:
    """One round of each motion that takes energy out of the wall alone, or with half a sample of damping.

    Parameters
    ----------
    device
        Every number certain.
    wall
        Without laws.
    fastest
        Speed that is not exceeded [m/s].

    Raises
    ------
    InputError
        If that is no speed of a hand.
    """
    limit, period = as_speed(device, fastest), float(device.exact("sample_period"))
    found: dict[str, Floats] = {}
    for name, relative in _relatives(device, wall).items():
        witness = check_by_closed_forms(device, relative).witness
        if isinstance(witness, Witness) and not witness.motion.switch_positions:
            found[f"the motion that refutes {name}"] = _round(witness.motion)
    for speed in sorted({min(part * REALISTIC, limit) for part in (0.25, 0.5, 1)} | {limit}):
        cycle = _worst(device, wall, speed)
        if cycle is not None:
            found[f"the worst hand against the wall alone, up to {speed:g} m/s"] = cycle
    return {n: x for n, x in found.items() if len(x) <= LONGEST_ROUND and speed_of(x, period) <= limit}


def _relatives(device: Device, wall: Wall) -> dict[str, Wall]:
    damping = wall.stiffness.fraction * device.exact("sample_period") / 2  # type: ignore[union-attr]
    return {
        "the wall alone": wall,
        "the wall with damping K T/2": wall.replace(damping=damping),
        "the wall with damping −K T/2": wall.replace(damping=-damping),
    }


def _round(motion: Motion) -> Floats:
    """The part that is done again and again if it closes, else the whole motion, from rest to rest."""
    for part in motion.repeats:
        if part.times > 1 and motion.positions[part.first] == motion.positions[part.last]:
            return np.array([float(x) for x in motion.positions[part.first : part.last]])
    whole = motion.listed() if motion.samples <= LONGEST_ROUND else motion
    return np.array([float(x) for x in whole.positions[:-1]])


def _worst(device: Device, wall: Wall, speed: float) -> Floats | None:
    """The cycle of the worst hand on a board twice as deep as one sample's way; None where none gains."""
    bounded = Fraction(str(speed)) * Fraction(999, 1000)  # the game's moves may be a step longer
    deep = 2 * bounded * device.exact("sample_period")
    try:
        played = worst_hand(device, wall, speed=bounded, penetration=deep, seconds=SECONDS)
    except InputError:  # an ideal encoder, a board that is too large or too small
        return None
    return None if played.witness is None else np.array(played.witness.cycle[:-1])
