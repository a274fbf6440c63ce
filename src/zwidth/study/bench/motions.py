"""The motions that a hand tries against every law, one round of each.

Those that take energy out of held springs, encoders and filters: across one edge and back, fast in and fast
out over more and more counts, slow one way and fast the other, with rests at either end, and sinusoids inside
and through the surface; those that earn credit which a law should not give: to and fro over an edge before a
leap, up within a count and out of it.  The same over steps of the converter, and about the depth where the
force limit is reached; small rounds at random beside edges and steps.  And those that are found against the
wall alone, by proof and by value iteration.

Every length is one of the loop's own: a count, the depth of a converter step, that of the force
limit, the way of the fastest hand in a sample.  So the same loop in other units meets the same hand.
"""

from __future__ import annotations

from collections.abc import Iterable, Iterator, Mapping
from dataclasses import dataclass
from fractions import Fraction
from functools import lru_cache
from math import cos, floor, pi

import numpy as np
from numpy.typing import NDArray

from zwidth.errors import InputError
from zwidth.model.device.device import Device
from zwidth.model.environment.environment import Environment
from zwidth.model.environment.wall import Wall, wall_of
from zwidth.model.rendering.rendered import laws_of
from zwidth.passivity.check import check_by_closed_forms
from zwidth.passivity.storage import available_storage
from zwidth.passivity.storage.program import DynamicProgram, program_of
from zwidth.passivity.witness.motion import Motion
from zwidth.passivity.witness.witness import Witness
from zwidth.quantity.exact import Exact, RealLike
from zwidth.quantity.parameter import read_number
from zwidth.quantity.text import shown

USUAL = Fraction(1, 10)
"""Part of the fastest speed below which a hand is tried first: about what a hand reaches, of 10 m/s."""

IDEAL_COUNT = Fraction(9876, 10**6)
"""What stands for a count where the encoder is ideal, as part of the fastest hand's way in a sample."""

EDGE = 0.02
"""How far beside an edge of the encoder a hand turns round, in counts."""

MOVES = 2e9
"""Moves that are looked at in each value iteration against the wall alone."""

LONGEST_ROUND = 2000
"""Samples of a found motion that is tried as one round."""

SMALL = 16
"""Rounds at random in each of the loop's lengths."""

STEPS = (1, 2, 4, 8, 16, 32)
"""Steps of the converter over which a hand goes."""

BESIDE = 100
"""Times that a hand goes to and fro half a step from where it began, for laws that count from there."""

_MARGIN = 1 - 1e-9
"""Of the speed: what reaches it exactly is left out, whichever way it is rounded."""

Floats = NDArray[np.float64]


def count_of(device: Device, fastest: RealLike) -> Fraction:
    """Δ, or what stands for it, for a hand of some speed [m/s]; [m]."""
    return device.exact("resolution") or IDEAL_COUNT * Exact(fastest).fraction * device.exact("sample_period")


def as_speed(device: Device, fastest: RealLike) -> Fraction:
    """The speed of the fastest hand [m/s]."""
    least = 2.5 * EDGE * float(device.exact("resolution") / device.exact("sample_period"))
    speed: Exact = read_number(fastest, "speed", "fastest")
    if speed <= 0 or speed < least:
        raise InputError(
            f"fastest is the speed of a hand [m/s], finite and at least {least:.3g} to cross an edge of the "
            f"encoder and come back, got {fastest}: a hand reaches about 1 m/s"
        )
    return speed.fraction


def speed_of(positions: Floats, period: float) -> float:
    """Largest mean speed over a sample, from round to round too [m/s]."""
    return float(np.max(np.abs(np.diff(positions, append=positions[0])))) / period


def fixed_motions(
    device: Device, fastest: RealLike, environment: Environment | None = None
) -> dict[str, Floats]:
    """One round of each motion of the fixed set, by what it does.

    `fastest`: speed that is not exceeded [m/s].
    `environment`: what is rendered, laws in a chain included: how deep a step of the converter and the force
        limit are; None: motions in counts only.
    """
    stiffnesses = () if environment is None else _stiffnesses(device, environment)
    return dict(_fixed(device, Exact(fastest).fraction, stiffnesses))


@lru_cache(maxsize=16)  # many laws are met by the same hand
def _fixed(device: Device, fastest: Fraction, stiffnesses: tuple[Fraction, ...]) -> dict[str, Floats]:
    count, period = count_of(device, fastest), device.exact("sample_period")
    way = fastest * period / count
    found = _scaled(_in_counts([floor(way * USUAL), floor(way)]), float(count))
    found.update(_scaled({f"{name}, in counts": x for name, x in _small()}, float(count)))
    for stiffness in stiffnesses if device.force_resolution is not None else ():
        length = device.exact("force_resolution") / stiffness
        if 2 * length > device.exact("resolution"):
            found.update(_scaled(_in_steps(float(length)), float(length)))
    for stiffness in stiffnesses if device.force_limit is not None else ():
        deep = float(device.exact("force_limit") / stiffness)
        found.update(_scaled(_about_the_limit(deep), deep))
    found["as far as the fastest hand reaches, inside"] = np.array([1.0, 2.0 - 1e-6]) * float(way * count)
    most = float(fastest) * _MARGIN
    return {name: x for name, x in found.items() if speed_of(x, float(period)) <= most}


def _scaled(motions: Iterable[tuple[str, Floats]] | Mapping[str, Floats], length: float) -> dict[str, Floats]:
    return {name: length * x for name, x in dict(motions).items()}


def _stiffnesses(device: Device, environment: Environment) -> tuple[Fraction, ...]:
    """K of a wall, and for laws that soften it the most that the device's damping pays for, 2b/T."""
    wall = wall_of(environment.met)
    own = None if wall is None else wall.stiffness
    if not isinstance(own, Exact) or own <= 0:
        return ()
    paid = 2 * device.exact("damping") / device.exact("sample_period")
    softer = (paid,) if laws_of(environment) and 0 < paid < own.fraction else ()
    return (own.fraction, *softer)


def _in_counts(reach: list[int]) -> dict[str, Floats]:
    """Of the encoder."""
    found: dict[str, Floats] = {}
    for n in _amplitudes(reach):
        found.update(_strokes(n, "counts"))
        found.update(_sinusoids(n, "counts"))
        found.update(_credited(n))
    for start in (0, 1, 8):  # slowly through a count, out of it over its edge, and back in one sample
        up = np.linspace(start + 1e-6, start + 1 - 1e-6, 20)
        found[f"slowly up within count {start}, then out of it"] = np.append(up, start + 1 + 1e-6)
    return found


def _in_steps(length: float) -> dict[str, Floats]:
    """Of the converter: the force rises in the middle between two of them; the length [m] is for the name."""
    found: dict[str, Floats] = {}
    of = f"steps of {shown(length, 'm', 3)}"
    for n in STEPS:
        found.update(_strokes(n, of))
        found.update(_scaled(_sinusoids(n, of), 1.03))  # never half a step from turn to turn
    for part in (0.02, 0.05, 0.1, 0.2):
        beside = np.tile([0.5 - part, 0.5 + part], BESIDE)
        found[f"in, then {BESIDE} times {part:g} to either side of half {of}"] = np.append(0.0, beside)
    for start in (0, 1, 5):
        for part in (0.002, 0.02, 0.1, 0.23, 0.4):
            found[f"{part:g} to either side of step {start + 1} of {shown(length, 'm', 3)}"] = np.array(
                [start - part, start + part]
            )
    found.update({f"{name}, in {of}": x for name, x in _small()})
    return {name: x + 0.5 for name, x in found.items()}


def _about_the_limit(length: float) -> dict[str, Floats]:
    """Into the limit and back, and to and fro within and beyond it; the length [m] is for the name."""
    of = f"of the {shown(length, 'm', 3)} to the force limit"
    found: dict[str, Floats] = {}
    for low, high in ((0.0, 0.9), (0.5, 1.1), (0.9, 1.1), (0.0, 1.5), (0.99, 1.01)):
        there = np.array([low, high])
        way = np.linspace(low, high, 17)
        found[f"from {low:g} to {high:g} {of} and back"] = there
        found[f"from {low:g} to {high:g} {of}, slowly in and fast out"] = np.concatenate([way, there[:1]])
        found[f"from {low:g} to {high:g} {of}, slowly both ways"] = np.concatenate([way, way[-2:0:-1]])
    found.update({f"{name} {of}": 1 + 0.1 * x for name, x in _small()})
    return found


def _small() -> Iterator[tuple[str, Floats]]:
    """Rounds of a few samples at random beside an edge, in units of the way from one to the next."""
    rng = np.random.default_rng(1)  # the same for every loop
    for number in range(SMALL):
        samples, at = int(rng.integers(2, 11)), int(rng.integers(0, 4))
        size = 10 ** rng.uniform(-2, 0.5)
        yield f"small round {number + 1}", at + size * rng.uniform(-1, 1, samples)


def _amplitudes(reach: list[int]) -> list[int]:
    """In counts: doubled up to 64, then times four; and as far as each of the two speeds reaches."""
    doubled = {2**k for k in range(7)} | {4**k for k in range(4, 20) if 4**k < max(reach)}
    return sorted(doubled | {n for n in reach if n >= 1})


def _strokes(n: int, unit: str) -> Iterator[tuple[str, Floats]]:
    """Over n counts and back, in counts; over one edge where n = 1."""
    for name, start in (("from the surface", 0.0), ("inside", float(n))):
        low, high = start - EDGE, start + n + EDGE - 1
        if n == 1:
            low, high = start + 1 - EDGE, start + 1 + EDGE
        for rest in (1, 2, 4):
            there = [low] * rest + [high] * rest
            yield f"{n} {unit} and back {name}, {rest} samples at each end", np.array(there)
        for slow in (4, 16):
            way = np.linspace(low, high, slow + 1)
            yield f"{n} {unit} {name}, slowly in and fast out", np.concatenate([way, [low]])
            yield f"{n} {unit} {name}, fast in and slowly out", np.concatenate([[low], way[::-1]])


def _sinusoids(n: int, unit: str) -> Iterator[tuple[str, Floats]]:
    for period in (3, 4, 6, 10, 20):
        wave = n * np.array([cos(2 * pi * k / period) for k in range(period)]) + EDGE / 2  # not on an edge
        yield f"a sinusoid of {n} {unit} and {period} samples, inside", wave + 3 * n
        yield f"a sinusoid of {n} {unit} and {period} samples, through the surface", wave


def _credited(n: int) -> Iterator[tuple[str, Floats]]:
    """To and fro over an edge outside, then n counts in and out again, at once or slowly in."""
    for samples in (20, 400):
        jitter = -1 + 0.001 * np.where(np.arange(samples) % 2, 1.0, -1.0)
        way = np.linspace(0, n + 0.5, min(n, 32) + 1)
        yield f"{samples} samples over an edge, then {n} counts in and out", np.append(jitter, n + 0.5)
        yield f"{samples} samples over an edge, then {n} counts slowly in", np.concatenate([jitter, way])


def found_motions(device: Device, wall: Wall, fastest: RealLike) -> dict[str, Floats]:
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
    for speed in (*(part * USUAL * limit for part in (Fraction(1, 4), Fraction(1, 2), 1)), limit):
        cycle = _worst(device, wall, speed)
        if cycle is not None:
            found[f"value iteration against the wall alone, up to {shown(speed, 'm/s', 6)}"] = cycle
    return {n: x for n, x in found.items() if len(x) <= LONGEST_ROUND and speed_of(x, period) <= limit}


def _relatives(device: Device, wall: Wall) -> dict[str, Wall]:
    damping = wall.stiffness.fraction * device.exact("sample_period") / 2
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


def _worst(device: Device, wall: Wall, speed: Fraction) -> Floats | None:
    """The best cycle on a grid twice as deep as one sample's way; None where none gains."""
    bounded = speed * Fraction(999, 1000)  # moves of the grid may be a step longer
    deep = 2 * bounded * device.exact("sample_period")
    try:
        program = program_of(device, wall, deep, bounded)
        assert isinstance(program, DynamicProgram)  # a wall is no row
        told = budget_of(program, MOVES)
        played = available_storage(
            device, wall, speed=bounded, penetration=deep, effort=float("inf"), progress=told
        )
    except (InputError, Spent):  # an ideal encoder, a board that is too large or too small
        return None
    return None if played.witness is None else np.array(played.witness.cycle[:-1])


NODES = 9
"""Places in a cell, about."""


class Spent(Exception):
    """The budget is used up: the iteration was not finished."""


@dataclass
class Budget:
    """What is told of each round of an iteration, and stops it.

    Parameters
    ----------
    rounds
        How many there may be.
    """

    rounds: float

    def __call__(self, improved: int) -> None:
        """One round more."""
        self.rounds -= 1
        if self.rounds < 0:
            raise Spent


def budget_of(program: DynamicProgram, moves: float) -> Budget:
    """For so many moves against one law."""
    width = 2 * program.domain.reach + 1
    states = program.domain.cells * width ** (program.law.memory + program.losses.delay)
    if program.law.relaxing is not None:
        states *= program.domain.cells
    rounds = moves // (states * width * NODES)
    if rounds < 1:
        raise InputError(f"the grid of {states:,} states is too large to be iterated on here")
    return Budget(rounds)
