"""Motions re-run: the energy that a hand takes out, in rational arithmetic."""

from __future__ import annotations

from collections.abc import Sequence
from fractions import Fraction
from math import gcd

from ..document.fields import List, Number, Read, Record, Whole, document, numbers
from ..document.number import JOULES, LENGTH, MOST_BITS, SECONDS, common_scale
from ..document.refusal import Invalid, only_if, spend
from .loop import LOOP, Loop, loop_of

MOST_SAMPLES = 4_000_000

REPEAT = Record({"first": Whole(least=0), "last": Whole(least=0), "times": Whole(least=1)}, shown=False)
"""A part of the motion, listed once, that is done so many times."""

TOLD = {"sample_period": Number(SECONDS, default=None, shown=False), "energy": Number(JOULES, shown=False)}
"""What a motion says of itself, and is compared."""

MOTION = document(
    {
        "loop": LOOP,
        **TOLD,
        "positions": numbers(LENGTH, least=2, most=MOST_SAMPLES, shown=False),
        "switch_positions": numbers(LENGTH, most=MOST_SAMPLES, default=None, shown=False),
        "repeats": List(REPEAT, most=MOST_SAMPLES, default=(), shown=False),
    }
)


def motion_energy(told: Read) -> Fraction:
    """Net energy the hand takes out of the device over a motion from rest to rest [J]."""
    p, positions = loop_of(told.loop), told.positions
    if p.unilateral and positions[0] > 0:
        raise Invalid("the motion must start at rest outside the wall or on its surface")
    start = positions[0] // p.resolution if p.resolution else positions[0]
    if not p.unilateral and start != 0:
        raise Invalid("the motion must start at rest at x = 0")
    switches = switch_positions(told, bool(p.part))
    require_apart(told.repeats, len(positions))
    return _energy_of(p, positions, switches, told.repeats)


def stored_at_start(told: Read) -> Fraction:
    """What even a passive loop may give out once from rest: H(1) Δ²/8, half a count of its spring.

    Nothing for an ideal encoder, nor for a spring wall touched from outside: its
    storage ½ K max(x − Δ/2, 0)² is 0 there.
    """
    p = loop_of(told.loop)
    spring_wall = p.unilateral and not any(p.numerator[1:]) and not any(p.denominator[1:])
    at_one = sum(p.denominator)
    if spring_wall or at_one == 0:
        return Fraction(0)
    return max(sum(p.numerator) / at_one, Fraction(0)) * p.resolution**2 / 8


def switch_positions(told: Read, inside_sample: bool) -> list[Fraction]:
    """Positions at the instant inside each interval when the delayed force changes."""
    only_if(inside_sample, told.switch_positions, "switch_positions")
    found: list[Fraction] = told.positions[:-1] if told.switch_positions is None else told.switch_positions
    if len(found) != len(told.positions) - 1:
        raise Invalid("there must be one switch position in each interval")
    return found


def require_apart(repeats: Sequence[Read], size: int) -> None:
    """Refuse repeated parts that do not lie in the motion, one after the other.

    The positions list each of them once; where one ends ahead of its start,
    every round and all that follows is that much further on.
    """
    before = 0
    for part in repeats:
        if not before <= part.first < part.last < size:
            raise Invalid("repeated parts must lie in the motion, one after the other")
        before = part.last


def _energy_of(p: Loop, x: list[Fraction], y: list[Fraction], repeats: Sequence[Read]) -> Fraction:
    """Energy the hand takes out over the whole motion [J]."""
    per_unit = common_scale((p.resolution, *x, *y), MOST_BITS)
    scale = common_scale((*p.numerator, *p.denominator))
    denominator = [int(c * scale) for c in p.denominator]
    content = gcd(*denominator)
    run = _Run(
        p,
        [int(v * per_unit) for v in x],
        [int(v * per_unit) for v in y],
        int(p.resolution * per_unit),
        [int(c * scale) for c in p.numerator],
        [c // content for c in denominator],
    )
    before = 0
    for part in repeats:
        run.forward(before, part.first)
        run.rounds(part)
        before = part.last
    run.forward(before, len(x) - 1)
    sums = run.sums
    squares = sums[_EARLY] / p.part + sums[_LATE] / (1 - p.part) if p.part else Fraction(sums[_LATE])
    work = Fraction(sums[_WORK], run.scale * content)
    unit = Fraction(1, per_unit)
    return -(unit**2) * (work + p.damping / p.period * squares) - p.coulomb_friction * unit * sums[_PATH]


_WORK, _PATH, _EARLY, _LATE = range(4)


class _Run:
    """The loop in whole numbers of one small length, run sample by sample.

    The filter is in its direct form II: D w = x, f = N w, with D free of common
    factors.  Motions made as x = D w keep w whole however long they are; for
    others w, the forces and the work are kept over a common power of D's first
    coefficient, `scale`.  `ahead` is how far repeated parts have carried the
    hand beyond the list of positions.
    """

    def __init__(
        self, p: Loop, x: list[int], y: list[int], encoder: int, numerator: list[int], denominator: list[int]
    ) -> None:
        self.p, self.x, self.y, self.encoder = p, x, y, encoder
        self.numerator, self.denominator = numerator, denominator
        self.memory = [0] * (len(denominator) - 1)
        self.forces = [0] * (p.whole + 2)
        self.scale = 1
        self.ahead = 0
        self.sums = [0, 0, 0, 0]  # Σ f Δx over scale, Σ |Δx|, Σ Δx² before and after the switch
        self.bits = max(c.bit_length() for c in (*numerator, *denominator))
        self.bits_of_x = max(v.bit_length() for v in x)

    def forward(self, start: int, stop: int) -> None:
        """Run from sample `start` to `stop`."""
        d, inside_sample, sums = self.p.whole, self.p.part != 0, self.sums
        for k in range(start, stop):
            here = self.x[k] + self.ahead
            self._sample(self.encoder * (here // self.encoder) if self.encoder else here)
            late = self.x[k + 1] - self.x[k]
            if inside_sample:
                early, late = self.y[k] - self.x[k], self.x[k + 1] - self.y[k]
                sums[_WORK] += self.forces[d + 1] * early
                sums[_PATH] += abs(early)
                sums[_EARLY] += early * early
            sums[_WORK] += self.forces[d] * late
            sums[_PATH] += abs(late)
            sums[_LATE] += late * late

    def _sample(self, x: int) -> None:
        """Take the measured position x, compute its force and send it on its way."""
        if self.p.unilateral and x <= 0:
            if any(self.memory):
                raise Invalid("the motion leaves the wall, where a law with memory is not defined")
            x = 0
        w = x * self.scale
        for a, past in zip(self.denominator[1:], self.memory, strict=True):
            if past:
                w -= a * past
        w, rest = divmod(w, self.denominator[0])
        if rest:
            w = w * self.denominator[0] + rest
            self._rescale(self.denominator[0])
        force = self.numerator[0] * w
        for b, past in zip(self.numerator[1:], self.memory, strict=True):
            if past:
                force += b * past
        self.forces = [force, *self.forces[:-1]]
        if self.memory:
            self.memory = [w, *self.memory[:-1]]
        bits = w.bit_length() + self.scale.bit_length()
        if bits > MOST_BITS:
            raise Invalid("the exact numbers of the motion grow too long to be checked")
        spend(14 + 4 * len(self.denominator), bits, self.bits)
        spend(2, bits + self.bits_of_x, self.bits_of_x)

    def _rescale(self, factor: int) -> None:
        bits = max(map(int.bit_length, (self.scale, *self.forces, *self.sums)))
        spend(4 + len(self.memory) + len(self.forces), bits, factor.bit_length())
        self.scale *= factor
        self.memory = [factor * w for w in self.memory]
        self.forces = [factor * f for f in self.forces]
        self.sums[_WORK] *= factor

    def rounds(self, part: Read) -> None:
        """All rounds of a repeated part: one by one until the loop has settled, then in closed form.

        A law linear in x that has gone a constant distance on, all of it, does
        the same again with every force larger by the same amount.
        """
        advance = self.x[part.last] - self.x[part.first]
        for done in range(1, part.times + 1):
            memory, forces, scale, sums = self.memory, self.forces, self.scale, list(self.sums)
            lowest = min(self.x[part.first : part.last + 1]) + self.ahead
            self.forward(part.first, part.last)
            self.ahead += advance
            left = part.times - done
            lowest += min(0, advance * left)
            push = self._push(memory, forces, advance, lowest) if scale == self.scale else None
            if push is not None:
                shifts = [w - v for v, w in zip(memory, self.memory, strict=True)]
                self.memory = [w + left * shift for w, shift in zip(self.memory, shifts, strict=True)]
                self.forces = [f + left * push for f in self.forces]
                self.ahead += left * advance
                self.sums = [now + left * (now - was) for was, now in zip(sums, self.sums, strict=True)]
                self.sums[_WORK] += push * advance * (left * (left + 1) // 2)
                break
        self.ahead -= advance  # the list after the part stands one advance ahead already

    def _push(self, memory: list[int], forces: list[int], advance: int, lowest: int) -> int | None:
        """By how much every force grows from round to round; None while the loop has not settled."""
        if advance == 0:
            return 0 if memory == self.memory and forces == self.forces else None
        count = self.encoder or 1
        if (self.p.unilateral and lowest < count) or advance % count:
            return None
        at_one = sum(self.denominator)
        if at_one == 0 or advance * self.scale % at_one:
            return None
        shift = advance * self.scale // at_one
        push = sum(self.numerator) * shift
        settled = all(w - v == shift for v, w in zip(memory, self.memory, strict=True)) and all(
            g - f == push for f, g in zip(forces, self.forces, strict=True)
        )
        return push if settled else None
