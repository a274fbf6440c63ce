"""Motions re-run: the energy that a hand takes out, in rational arithmetic."""

from __future__ import annotations

from collections.abc import Mapping
from fractions import Fraction
from math import lcm
from typing import Any, NamedTuple

from .reading import MOST_SAMPLES, Invalid, Loop, get, integer, numbers, read_loop


class _State(NamedTuple):
    """What a sampled loop remembers: the filter's past and the forces on their way.

    `ahead` is how far repeated parts have carried the hand beyond the list.
    """

    memory: tuple[int | Fraction, ...]
    forces: tuple[int | Fraction, ...]
    ahead: int


def motion_energy(document: Mapping[str, Any]) -> Fraction:
    """Net energy the hand takes out of the device over a motion from rest to rest [J]."""
    p = read_loop(document)
    positions = numbers(get(document, _key(document, "positions")), MOST_SAMPLES)
    if len(positions) < 2:
        raise Invalid("a motion has at least two positions")
    if p.unilateral and positions[0] > 0:
        raise Invalid("the motion must start at rest outside the wall or on its surface")
    start = positions[0] // p.resolution if p.resolution else positions[0]
    if not p.unilateral and start != 0:
        raise Invalid("the motion must start at rest at x = 0")
    switches = _switch_positions(document, p, positions)
    repeats = _repeats(document, len(positions))
    return _energy_of(p, positions, switches, repeats)


def _key(document: Mapping[str, Any], name: str) -> str:
    for unit in ("m", "rad"):
        if f"{name}_{unit}" in document:
            return f"{name}_{unit}"
    raise Invalid(f"{name}_m is missing")


def _switch_positions(document: Mapping[str, Any], p: Loop, x: list[Fraction]) -> list[Fraction]:
    """Positions at the instant inside each interval when the delayed force changes."""
    if not p.part:
        return x[:-1]
    y = numbers(get(document, _key(document, "switch_positions")), MOST_SAMPLES)
    if len(y) != len(x) - 1:
        raise Invalid("there must be one switch position in each interval")
    return y


class _Repeat(NamedTuple):
    first: int
    last: int
    times: int


def _repeats(document: Mapping[str, Any], size: int) -> list[_Repeat]:
    """Parts of the motion that are done more than once.

    The positions list each of them once; where one ends ahead of its start,
    every round and all that follows is that much further on.
    """
    entries = document.get("repeats", [])
    if not isinstance(entries, list) or len(entries) > size:
        raise Invalid("repeats must be a list")
    parts = [
        _Repeat(integer(get(e, "first")), integer(get(e, "last")), integer(get(e, "times"), 1))
        for e in entries
    ]
    before = 0
    for part in parts:
        if not before <= part.first < part.last < size:
            raise Invalid("repeated parts must lie in the motion, one after the other")
        before = part.last
    return parts


class _Counts(NamedTuple):
    """The motion and the law in whole numbers of one small length, so that long motions stay fast."""

    x: list[int]
    y: list[int]
    encoder: int  # the encoder's resolution, 0 if ideal
    numerator: list[int]
    denominator: list[int]


class _Sums(NamedTuple):
    """What an energy is made of, in counts: Σ f Δx, Σ |Δx| and Σ Δx² before and after the switch."""

    work: int | Fraction
    path: int
    early: int
    late: int

    def plus(self, other: _Sums) -> _Sums:
        """Both stretches together."""
        return _Sums(
            self.work + other.work, self.path + other.path, self.early + other.early, self.late + other.late
        )


def _energy_of(p: Loop, x: list[Fraction], y: list[Fraction], repeats: list[_Repeat]) -> Fraction:
    """Energy the hand takes out over the whole motion [J]."""
    per_unit = lcm(p.resolution.denominator, *(v.denominator for v in x), *(v.denominator for v in y))
    scale = lcm(*(c.denominator for c in (*p.numerator, *p.denominator)))
    counts = _Counts(
        [int(v * per_unit) for v in x],
        [int(v * per_unit) for v in y],
        int(p.resolution * per_unit),
        [int(c * scale) for c in p.numerator],
        [int(c * scale) for c in p.denominator],
    )
    state = _State((0,) * (len(p.denominator) - 1), (0,) * (p.whole + 2), 0)
    sums = _Sums(0, 0, 0, 0)
    before = 0
    for part in [*repeats, _Repeat(len(x) - 1, len(x) - 1, 1)]:
        gained, state = _run(p, counts, before, part.first, state)
        sums = sums.plus(gained)
        gained, state = _rounds(p, counts, part, state)
        sums = sums.plus(gained)
        before = part.last
    squares = sums.early / p.part + sums.late / (1 - p.part) if p.part else sums.late
    unit = Fraction(1, per_unit)
    force_work = sums.work + p.damping / p.period * squares
    return -(unit**2) * force_work - p.coulomb_friction * unit * sums.path


def _rounds(p: Loop, c: _Counts, part: _Repeat, state: _State) -> tuple[_Sums, _State]:
    """All rounds of a repeated part: one by one until the loop has settled, then in closed form.

    A law linear in x that has gone a constant distance on, all of it, does the
    same again with every force larger by the same amount.
    """
    advance = c.x[part.last] - c.x[part.first]
    sums, done = _Sums(0, 0, 0, 0), 0
    while done < part.times and part.first < part.last:
        gained, following = _run(p, c, part.first, part.last, state)
        push = _uniform_push(p, c, part, state, following, part.times - done)
        left = part.times - done if push is not None else 1
        if push is not None:
            growth = push * advance * (left * (left - 1) // 2)
            gained = _Sums(
                left * gained.work + growth, left * gained.path, left * gained.early, left * gained.late
            )
            following = _State(
                tuple(w + (left - 1) * (w - v) for v, w in zip(state.memory, following.memory, strict=True)),
                tuple(f + (left - 1) * push for f in following.forces),
                state.ahead + left * advance,
            )
        else:
            following = following._replace(ahead=state.ahead + advance)
        sums, state, done = sums.plus(gained), following, done + left
        if done > 1000 + len(c.x) and done < part.times:
            raise Invalid("a repeated part does not settle into a cycle")
    # x in the list after the part stands one advance ahead already
    return sums, state._replace(ahead=state.ahead - advance)


def _uniform_push(
    p: Loop, c: _Counts, part: _Repeat, state: _State, following: _State, left: int
) -> int | Fraction | None:
    """By how much every force grows from this round to each later one; None if not yet settled."""
    advance = c.x[part.last] - c.x[part.first]
    if advance == 0:
        same = following.memory == state.memory and following.forces == state.forces
        return 0 if same else None
    lowest = min(c.x[part.first : part.last + 1]) + state.ahead + min(0, advance * (left - 1))
    if (p.unilateral and lowest <= 0) or (c.encoder and advance % c.encoder):
        return None
    shift = Fraction(advance, sum(c.denominator)) if sum(c.denominator) else None
    if shift is None or any(w - v != shift for v, w in zip(state.memory, following.memory, strict=True)):
        return None
    push = sum(c.numerator) * shift
    if any(g - f != push for f, g in zip(state.forces, following.forces, strict=True)):
        return None
    return push


def _run(p: Loop, c: _Counts, start: int, stop: int, state: _State) -> tuple[_Sums, _State]:
    """The sums of one stretch of the motion, and the state after it.

    The filter runs in its direct form II: D w = x, f = N w, so that motions
    made as x = D w keep short numbers however long they are.
    """
    memory, forces = list(state.memory), list(state.forces)
    work: int | Fraction = 0
    path = early_squares = late_squares = 0
    inside_sample = p.part != 0
    for k in range(start, stop):
        here = c.x[k] + state.ahead
        measured = c.encoder * (here // c.encoder) if c.encoder else here
        forces = [_force(p, c, measured, memory), *forces[:-1]]
        early, late = (c.y[k] - c.x[k], c.x[k + 1] - c.y[k]) if inside_sample else (0, c.x[k + 1] - c.x[k])
        work += forces[p.whole] * late
        path += abs(early) + abs(late)
        late_squares += late * late
        if early:
            work += forces[p.whole + 1] * early
            early_squares += early * early
    sums = _Sums(work, path, early_squares, late_squares)
    return sums, _State(tuple(memory), tuple(forces), state.ahead)


def _force(p: Loop, c: _Counts, x: int, memory: list[int | Fraction]) -> int | Fraction:
    """f(k) from the measured position; updates the memory in place."""
    if p.unilateral and x <= 0:
        if any(memory):
            raise Invalid("the motion leaves the wall, where a law with memory is not defined")
        x = 0
    w: int | Fraction = x
    for a, past in zip(c.denominator[1:], memory, strict=True):
        if past:
            w -= a * past
    w = _divide(w, c.denominator[0])
    force = c.numerator[0] * w
    for b, past in zip(c.numerator[1:], memory, strict=True):
        if past:
            force += b * past
    if memory:
        memory.insert(0, w)
        memory.pop()
    return force


def _divide(a: int | Fraction, b: int) -> int | Fraction:
    if isinstance(a, int):
        quotient, rest = divmod(a, b)
        return quotient if rest == 0 else Fraction(a, b)
    return a / b
