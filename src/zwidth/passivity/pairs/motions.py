"""Motions of two hands that take energy out of a pair where the criterion, or friction, is violated.

Three kinds, each made of what is violated:

slow      at θ → 0: both hands go at constant speeds, far, and back; every sample gains.
round     at θ = 2π p/q: both go round, with the phase between them that the form of the energy has.
edge      one hand to and fro over an edge of its encoder, the other crossing one of its own as it does so,
          by next to nothing: the force is low on the way in and high on the way out.
"""

from __future__ import annotations

from collections.abc import Callable, Iterator
from dataclasses import replace
from fractions import Fraction
from math import ceil, pi

import numpy as np

from zwidth.model.device import Device
from zwidth.model.pairs import Pair
from zwidth.passivity.linear.positivity import prove_nonnegative
from zwidth.passivity.pairs.arm import Arm
from zwidth.passivity.pairs.criterion import PairCriterion
from zwidth.passivity.pairs.evidence import PairWitness, energy_of
from zwidth.passivity.witness.motion import Motion, Repeat
from zwidth.passivity.witness.sinusoid import band_about, enough_rounds, simplest_between
from zwidth.quantity.balls import as_fmpq

LONGEST_ROUND = 20_000
"""Samples of one round; a violation in a narrower band is proved without a motion."""

_AMPLITUDE = Fraction(1, 1000)
"""About how far a hand goes where nothing asks for more [m; rad]."""

_SIZES = (6, 10, 14, 18, 22, 28, 36, 44)
"""Bits of the whole numbers that a round motion is made of."""

Path = tuple[list[int], list[int]]


def refute_criterion(criterion: PairCriterion) -> PairWitness | None:
    """A motion where the form of the energy is negative; None if none is found that is short enough."""
    for path, parts in _paths(criterion):
        found = _enlarged(criterion, path, parts)
        if found is not None:
            return found
    return None


def _paths(criterion: PairCriterion) -> Iterator[tuple[Path, tuple[Repeat, ...]]]:
    """Motions in whole numbers, and the parts of them that are done many times; the finer the later."""
    often = criterion.pair.own_readings
    if criterion.slips:
        yield from _inside_samples(criterion)
        return
    if any(p(1) < 0 for p in criterion.polynomials):
        for size in _SIZES:
            yield _slow(criterion, size), out_and_back(often)[1]
    for turn in _turns(criterion):
        samples = often * turn.denominator
        for size in _SIZES if samples <= LONGEST_ROUND else ():
            yield _round(criterion, turn, size), (Repeat(0, samples, 1),)


def out_and_back(often: int) -> tuple[list[int], tuple[Repeat, Repeat]]:
    """Two samples out, two back, a step from reading to reading; the second of each is done many times."""
    way = [*range(2 * often), *range(2 * often, -1, -1)]
    return way, (Repeat(often, 2 * often, 1), Repeat(3 * often, 4 * often, 1))


def _slow(criterion: PairCriterion, bits: int) -> Path:
    speeds = [round(float(v) * 2**bits) for v in np.linalg.eigh(criterion.at(0.0).real)[1][:, 0]]
    way, _ = out_and_back(criterion.pair.own_readings)
    leader, follower = ([speed * k for k in way] for speed in speeds)
    return leader, follower


def _inside_samples(criterion: PairCriterion) -> Iterator[tuple[Path, tuple[Repeat, ...]]]:
    """One arm to and fro from reading to reading of its own, or straight on; the other rests."""
    often = criterion.pair.own_readings
    for here, arm in enumerate(criterion.arms):
        if not arm.slips:
            continue
        length = often * (1 + arm.often % 2)
        rest = [0] * (length + 1)
        step = often // arm.often
        fro = [step - abs(k % (2 * step) - step) for k in range(length + 1)]
        yield (fro, rest) if here == 0 else (rest, fro), (Repeat(0, length, 1),)
        way, parts = out_and_back(often)
        still = [0] * len(way)
        yield (way, still) if here == 0 else (still, way), parts


def _turns(criterion: PairCriterion) -> list[Fraction]:
    """Turns per sample θ/2π of simple denominator where one of the three is negative."""
    points = ((p, prove_nonnegative(p)) for p in criterion.polynomials)
    found = [
        simplest_between(*band_about(p, as_fmpq(point))) for p, point in points if isinstance(point, Fraction)
    ]
    return sorted(found, key=lambda turn: turn.denominator)


def _round(criterion: PairCriterion, turn: Fraction, bits: int) -> Path:
    """One round of both hands, in whole numbers, from 0 to 0.

    Between samples each goes as loses least: of the places φ_l as much as it weighs there over what it loses.
    """
    p, q = turn.numerator, turn.denominator
    theta = 2 * pi * p / q
    vector = np.linalg.eigh(criterion.at(theta))[1][:, 0]
    vector = vector / vector[np.argmax(np.abs(vector))]
    finest = np.arange(q * criterion.pair.own_readings + 1)
    waves = np.zeros((2, len(finest)))
    for row, (arm, amplitude) in enumerate(zip(criterion.arms, vector, strict=True)):
        samples = q * arm.often
        beta, gamma = map(float, arm.inside) if arm.often > 1 else (1.0, 0.0)
        share = arm.shares(theta) / (beta + gamma * np.cos(arm.places(theta)))
        wave = np.zeros(samples + 1)
        for index, part in enumerate(share / share.sum()):
            turned = 2 * pi * ((p + index * q) * np.arange(samples + 1) % samples) / samples
            wave += (amplitude * part * (np.exp(1j * turned) - 1)).real
        waves[row] = np.interp(finest, np.linspace(0, finest[-1], samples + 1), wave)
    waves *= 2.0**bits
    leader, follower = ([round(v) for v in wave] for wave in waves)
    return leader, follower


def _enlarged(criterion: PairCriterion, path: Path, parts: tuple[Repeat, ...]) -> PairWitness | None:
    """Often enough for the way in and out, and large enough for friction and encoders."""
    pair = criterion.pair
    ideal = _without_friction(pair)
    ratio = _units(pair)
    one = _motions(path, parts, ratio, Fraction(1))
    one = with_turns(pair, one)
    times = often_enough(lambda n: energy_of(ideal, *repeated(one, n)), criterion, parts)
    if times is None:
        return None
    long = repeated(one, times)
    gain = energy_of(ideal, *long)
    lost = _rubbed(pair, one, times)
    if gain is None or gain <= 0:
        return None
    widest = max(abs(v) for motion in long for v in motion.positions)
    unit = max(_AMPLITUDE / widest, 2 * lost / gain)
    for _ in range(8):
        unit = Fraction(ceil(unit)) if unit > 1 else _simple(unit)
        if any(side.resolution for side in pair.sides):
            unit = Fraction(ceil(unit))  # whole counts of both
        found = repeated(with_turns(pair, _motions(path, parts, ratio, unit)), times)
        energy = energy_of(pair, *found)
        if energy is not None and energy > stored_at_start(pair):
            return PairWitness(pair, *found, energy)
        unit *= 8
    return None


def stored_at_start(pair: Pair) -> Fraction:
    """K_l (Δ_l + Δ_f)²/8, what the spring between two readings may hold where both arms are at 0 [J]."""
    leader, follower = pair.sides
    return pair.felt_stiffness * (leader.resolution + follower.resolution) ** 2 / 8


def _without_friction(pair: Pair) -> Pair:
    """With ideal encoders too, and no compensation of Coulomb friction: the energy is quadratic in size."""
    law, other = (law.replace(coulomb=0) for law in pair.compensations)
    return pair.replace(
        leader=_bare(pair.leader),
        follower=_bare(pair.follower),
        compensation=law,
        follower_compensation=other,
    )


def _bare(device: Device) -> Device:
    return device.replace(coulomb_friction=0, stiction=None, resolution=0)


def _units(pair: Pair) -> tuple[Fraction, Fraction]:
    """Lengths of which the whole numbers of each hand are: counts where there are any, as alike as may be."""
    steps = [side.resolution for side in pair.sides]
    if not any(steps):
        return Fraction(1), Fraction(1)
    largest = max(steps)
    first, second = (step * max(1, round(largest / step)) if step else largest for step in steps)
    return first, second


def _motions(
    path: Path, parts: tuple[Repeat, ...], ratio: tuple[Fraction, Fraction], unit: Fraction
) -> list[Motion]:
    smallest = min(ratio)
    return [
        Motion(tuple(unit * step * round(v * smallest / step) for v in whole), (), parts)
        for whole, step in zip(path, ratio, strict=True)
    ]


def repeated(motions: list[Motion], times: int) -> tuple[Motion, Motion]:
    leader, follower = (motion.repeated(times) for motion in motions)
    return leader, follower


def often_enough(
    energy: Callable[[int], Fraction | None], criterion: PairCriterion, parts: tuple[Repeat, ...]
) -> int | None:
    """Rounds after which it gains: beyond what is remembered, energy is affine in them."""
    arms = criterion.arms
    memory = (max(arm.oldest for arm in arms) + max(arm.whole for arm in arms) + 6) * max(
        arm.often for arm in arms
    )
    first = 2 + ceil(memory / min(part.last - part.first for part in parts))
    return enough_rounds(energy, first)


def _rubbed(pair: Pair, one: list[Motion], times: int) -> Fraction:
    """No less than what Coulomb friction and its compensation take from the motion at this size [J]."""
    total = Fraction(0)
    for motion, arm in zip(one, PairCriterion(pair).arms, strict=True):
        x = motion.positions
        path = sum((abs(b - a) for a, b in zip(x, x[1:], strict=False)), Fraction(0))
        dry = arm.side.coulomb_friction + arm.side.compensation.coulomb.fraction
        total += arm.weight * dry * path * times  # no less than what is gone
    return total


def _simple(value: Fraction) -> Fraction:
    power = Fraction(1)
    while value * power < 10:
        power *= 10
    return Fraction(ceil(value * power)) / power


def with_turns(pair: Pair, motions: list[Motion]) -> list[Motion]:
    """The best instants inside samples, where a force changes there.

    y = x + α Δx − (T/2b) α (1 − α) (f before − f after), with the forces of a round when all before it were
    the same.
    """
    arms = PairCriterion(pair).arms
    if not any(arm.part for arm in arms):
        return motions
    length = motions[0].samples
    memory = max(arm.oldest + arm.whole for arm in arms) + 4
    times = 2 + ceil(memory / max(1, min(part.last - part.first for part in motions[0].repeats)))
    listed = [motion.repeated(times).listed().positions for motion in motions]
    forces = _forces(arms, listed)
    out = []
    rest = len(forces[0]) - len(listed[0])
    for motion, arm, force in zip(motions, arms, forces, strict=True):
        if not arm.part:
            out.append(motion)
            continue
        places = _places(motion, times)
        gain = arm.period / (2 * arm.paying) * arm.part * (1 - arm.part)
        x = motion.positions
        grid = max(abs(v) for v in (*x, Fraction(1, 10**9))) / 2**40
        y = []
        for k in range(length):
            at = places[k] + rest - arm.whole
            change = force[at - 1] - force[at]
            ideal = x[k] + arm.part * (x[k + 1] - x[k]) - gain * Fraction(change)
            y.append(round(ideal / grid) * grid)
        out.append(replace(motion, switch_positions=tuple(y)))
    return out


def _places(motion: Motion, times: int) -> list[int]:
    """The sample of the listed motion, in the last round of each part, that each one of the short one is."""
    places, shift, before = [], 0, 0
    for part in motion.repeats:
        places += [k + shift for k in range(before, part.first)]
        shift += (times - 1) * (part.last - part.first)
        places += [k + shift for k in range(part.first, part.last)]
        before = part.last
    return places + [k + shift for k in range(before, len(motion.positions) - 1)]


def _forces(arms: tuple[Arm, Arm], paths: list[tuple[Fraction, ...]]) -> list[list[Fraction]]:
    """Forces computed at each sample, with enough of rest before."""
    rest = max(arm.oldest + arm.whole for arm in arms) + 4
    x = [[Fraction(0)] * rest + list(path) for path in paths]
    found = []
    for arm, own, its in zip(arms, x, x[::-1], strict=True):
        mine, heard = arm.own_row, arm.other_row
        found.append(
            [
                sum((c * own[k - n] for n, c in mine.items()), Fraction(0))
                + sum((c * its[k - n] for n, c in heard.items()), Fraction(0))
                if k > arm.oldest
                else Fraction(0)
                for k in range(len(own))
            ]
        )
    return found


def refute_friction(criterion: PairCriterion) -> PairWitness | None:
    """A motion over the edges of the encoders that Coulomb friction of one arm does not pay for."""
    pair, arms = criterion.pair, criterion.arms
    if arms[0].often != arms[1].often:
        return None  # both go over their edges in one rhythm
    for here in (0, 1):
        arm, other = arms[here], arms[1 - here]
        missing = arm.force_error(other) - arm.side.coulomb_friction
        if missing > 0:
            found = _over_an_edge(pair, here, missing)
            if found:
                return found
    return None


def _over_an_edge(pair: Pair, here: int, missing: Fraction) -> PairWitness | None:
    """One hand over its edge, the other's reading in the phase in which the force does most for it."""
    arms = PairCriterion(pair).arms
    arm, other = arms[here], arms[1 - here]
    best = max(
        (_won(arm, other, hold, phase), -hold, phase)
        for hold in _holds(arm)
        for phase in range(0, 2 * hold, arm.often)
    )
    if best[0] <= arm.side.coulomb_friction:
        return None
    return _held(pair, here, best[0] - arm.side.coulomb_friction, -best[1], best[2])


def _holds(arm: Arm) -> set[int]:
    """Readings for which the hand may stay on either side of the edge."""
    if arm.often == 1:
        return {arm.whole + 1, arm.whole + 2, arm.whole + arm.age + 2, arm.whole + arm.oldest + 2}
    ages = {n * arm.often for n in (1, 2, arm.age + 2, arm.oldest + 2)}
    return ages | {1} if arm.often == 2 else ages


def _won(arm: Arm, other: Arm, hold: int, phase: int) -> Fraction:
    """Half of the difference of the forces on the way out and on the way in [N; N·m]."""
    own, its = arm.side.resolution, other.side.resolution

    def force(k: int) -> Fraction:
        back = [arm.often * (k // arm.often - arm.echo_age - i) for i in (0, 1)]
        mine = [-own * ((at // hold) % 2) for at in (k, k - 1, *back)]
        heard = [arm.often * (k // arm.often - arm.age - i) for i in (0, 1)]
        theirs = [-its * (((sample + phase) // hold) % 2) for sample in heard]
        taps = (*arm.own, *arm.echo, *arm.other)
        return sum((c * v for c, v in zip(taps, (*mine, *theirs), strict=True)), Fraction(0))

    # it goes out after the samples 0 … hold − 1, and in after as many below the edge
    return (force(hold - 1 - arm.whole) - force(2 * hold - 1 - arm.whole)) / 2


def _held(pair: Pair, here: int, missing: Fraction, hold: int, phase: int) -> PairWitness | None:
    """`hold` samples above the edge and as many below it, the other by next to nothing."""
    arms = PairCriterion(pair).arms
    arm, other = arms[here], arms[1 - here]
    period = 2 * hold
    wait = -(-(arm.whole + arm.often * (arm.oldest + 4)) // period) * period
    small = _step(arm, missing)
    rate = max(Fraction(1), *(one.weight for one in arms), *(1 / one.weight for one in arms))
    against = other.force_error(arm) + other.side.coulomb_friction
    tiny = _step(other, other.side.coulomb_friction + against)
    if against:
        tiny = min(tiny, small * missing / (16 * rate * against))
    mine = [-small * ((k // hold) % 2) for k in range(wait + period + 1)]
    theirs = [-tiny * (((k + phase) // hold) % 2) if k else Fraction(0) for k in range(wait + period + 1)]
    paths = [mine, theirs] if here == 0 else [theirs, mine]
    part = Repeat(wait, wait + period, 1)
    motions = [
        Motion(tuple(path), tuple(path[:-1]) if one.part else (), (part,))
        for path, one in zip(paths, arms, strict=True)
    ]
    settled = 3 + wait // period
    before, after = (energy_of(pair, *repeated(motions, n)) for n in (settled, settled + 1))
    if before is None or after is None or after <= before:
        return None
    times = settled + 1 + max(0, ceil(2 * (stored_at_start(pair) - before) / (after - before)))
    found = repeated(motions, times)
    energy = energy_of(pair, *found)
    if energy is None or energy <= stored_at_start(pair):
        return None
    return PairWitness(pair, *found, energy)


def _step(arm: Arm, force: Fraction) -> Fraction:
    """How far a hand may go in a sample for viscous friction to take little beside this force."""
    side = arm.side
    near = [side.resolution / 4] if side.resolution else []
    if side.damping and force:
        near.append(force * arm.period / arm.often * (1 - arm.part) / (8 * side.damping))
    return min(near, default=_AMPLITUDE)
