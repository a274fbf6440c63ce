"""A motion of the hand, exact, and how one is made from the law's inner signal.

With x = D w the force is f = N w, so a motion made from whole numbers w keeps
exact, short numbers through the filter, and a w that ends in zeros brings the
filter back to rest.  D is taken without its integer content (`follower`).
"""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from dataclasses import dataclass, replace
from decimal import Decimal
from fractions import Fraction
from itertools import pairwise
from math import ceil, floor, log10
from typing import Any, NamedTuple

from zwidth.errors import InputError
from zwidth.passivity.linear.loop import LinearLoop


class Repeat(NamedTuple):
    """The part of a motion from sample `first` to `last`, done `times` times."""

    first: int
    last: int
    times: int


@dataclass(frozen=True)
class Motion:
    """Positions at the samples, with parts that may be done many times."""

    # x(k) [m; rad], from rest to rest; each repeated part is listed once. Where one ends ahead of its start,
    # every round, and all that follows, is that much further on.
    positions: tuple[Fraction, ...]
    # position in each interval at the instant when a delayed force changes; empty for a delay of whole
    # samples
    switch_positions: tuple[Fraction, ...] = ()
    repeats: tuple[Repeat, ...] = ()  # the parts done more than once, in order
    # straight pieces of each interval, at whose ends a position is given
    pieces: int = 1

    def repeated(self, times: int) -> Motion:
        """The same motion with another number of rounds in every repeated part."""
        return replace(self, repeats=tuple(r._replace(times=times) for r in self.repeats))

    def listed(self) -> Motion:
        """The same motion with every round listed, and no repeated part left."""
        x, y = list(self.positions[:1]), list[Fraction]()
        ahead, before = Fraction(0), 0
        for part in (*self.repeats, Repeat(len(self.positions) - 1, len(self.positions) - 1, 1)):
            stretches = [(before, part.first), *[(part.first, part.last)] * part.times]
            advance = self.positions[part.last] - self.positions[part.first]
            for k, (start, stop) in enumerate(stretches):
                ahead += advance if k > 1 else 0  # the list itself holds the first round's advance
                further = self.positions[start + 1 : stop + 1], self.switch_positions[start:stop]
                for there, values in zip((x, y), further, strict=True):
                    there += [v + ahead for v in values] if ahead else values
            before = part.last
        return Motion(tuple(x), tuple(y), pieces=self.pieces)

    def scaled(self, unit: Fraction) -> Motion:
        """The same motion, so many times as large."""
        return replace(
            self,
            positions=tuple(unit * v for v in self.positions),
            switch_positions=tuple(unit * v for v in self.switch_positions),
        )

    @property
    def rounds(self) -> int:
        """How often the repeated parts are done; 1 if none is."""
        return max((r.times for r in self.repeats), default=1)

    @property
    def samples(self) -> int:
        """Intervals in the whole motion."""
        return (len(self.positions) - 1) // self.pieces + sum(
            (r.times - 1) * (r.last - r.first) for r in self.repeats
        )

    @property
    def depth(self) -> Fraction:
        """The deepest position at a sample of the whole motion."""
        return self._deepest(self.positions)

    @property
    def reach(self) -> Fraction:
        """The deepest position of the whole motion, between its samples too."""
        later = self.switch_positions or self.positions[1:]
        return self._deepest((self.positions[0], *map(max, self.positions[1:], later)))

    def peak_speed(self, period: Fraction, part: Fraction) -> Fraction:
        """Largest mean speed over each time in which one force is held, by `part` of a sample late."""
        x, switches = self.positions, self.switch_positions
        if not switches:
            return max(abs(b - a) for a, b in pairwise(x)) / period
        early = max(abs(m - a) for a, m in zip(x[:-1], switches, strict=True)) / part
        late = max(abs(b - m) for b, m in zip(x[1:], switches, strict=True)) / (1 - part)
        return max(early, late) / period

    def _deepest(self, places: tuple[Fraction, ...]) -> Fraction:
        ahead, deepest, after = Fraction(0), max(places), 0
        for part in self.repeats:
            deepest = max(deepest, max(places[after : part.last + 1]) + ahead)
            ahead += (part.times - 1) * (self.positions[part.last] - self.positions[part.first])
            after = part.last
        return max(deepest, max(places[after:]) + ahead)


@dataclass(frozen=True)
class Pattern:
    """A motion in whole numbers: w of the law's direct form, x = unit · D w.

    The parts of w between `first` and `last` of each repeat may be done many times; `ends_inside` says that
    the last move, from the end of w to x = 0, is a step and not part of w.
    """

    w: tuple[int, ...]
    repeats: tuple[Repeat, ...]
    ends_inside: bool = False


def realize(loop: LinearLoop, pattern: Pattern, unit: Fraction, offset: Fraction, times: int) -> Motion:
    """The motion x = unit · D w, with the best instants inside samples.

    `offset` is added away from the ends: it moves the hand off the encoder's edges without changing a count.
    """
    w = pattern.w
    x = [unit * v for v in convolve(loop.follower, w)]
    if pattern.ends_inside:
        x.append(Fraction(0))
    placed = tuple(v + offset if 0 < k < len(x) - 1 else v for k, v in enumerate(x))
    switches = _switches(loop, w, placed, unit) if loop.part_delay else ()
    return Motion(placed, switches, pattern.repeats).repeated(times)


def convolve(a: tuple[int, ...], w: tuple[int, ...]) -> list[int]:
    """(a ∗ w)(k) for k < len(w)."""
    return [sum(c * w[k - i] for i, c in enumerate(a) if c and k >= i) for k in range(len(w))]


def _switches(
    loop: LinearLoop, w: tuple[int, ...], x: tuple[Fraction, ...], unit: Fraction
) -> tuple[Fraction, ...]:
    """Where to be when the force changes: y = x + α Δx − (T/2b) α(1−α) (f_before − f_after).

    There the net work of the interval is least.  Without damping any b will do.
    """
    alpha, d = loop.part_delay, loop.whole_delay
    b = loop.damping or any_damping(loop)
    gain = loop.period / (2 * b) * alpha * (1 - alpha)
    content = Fraction(loop.denominator[0], loop.follower[0])
    force = [unit * f / content for f in convolve(loop.numerator, w)]

    def at(k: int) -> Fraction:
        return force[k] if 0 <= k < len(force) else Fraction(0)

    grid = unit / 4096
    ideal = (x[k] + alpha * (x[k + 1] - x[k]) - gain * (at(k - d - 1) - at(k - d)) for k in range(len(x) - 1))
    return tuple(round(y / grid) * grid for y in ideal)


def forces_of(loop: LinearLoop, x: Sequence[float]) -> list[float]:
    """f(k) to rounding."""
    d = [c / loop.denominator[0] for c in loop.denominator]
    n = [c / loop.denominator[0] for c in loop.numerator]
    f: list[float] = []
    for k in range(len(x)):
        value = sum(c * x[k - i] for i, c in enumerate(n) if k >= i)
        f.append(value - sum(d[i] * f[k - i] for i in range(1, len(d)) if k >= i))
    return f


def any_damping(loop: LinearLoop) -> Fraction:
    """A damping that makes the moves inside a sample large: without damping every size gains."""
    stiffness = Fraction(sum(abs(c) for c in loop.numerator), sum(abs(c) for c in loop.denominator))
    return (stiffness * loop.period * loop.part_delay * (1 - loop.part_delay) or Fraction(1)) / 10**6


def round_up(target: Fraction) -> Fraction:
    """The decimal of one digit at or just above a target > 0."""
    power = Fraction(10) ** floor(log10(target.numerator) - log10(target.denominator))
    return power * ceil(target / power)


REPLAYED = "replayed motion"
KINDS = ("motion", "contact motion", "row motion", REPLAYED)


def saved_motion(document: object, name: str) -> Motion:
    """The motion in a witness, an active verdict or a limit, as `zwidth check` and `zwidth limit` save them.

    `document`: as `read_document` gives it; `name`: of the file, for messages.
    """
    found: Any = document
    for key in ("witness", "hand_motion"):
        if isinstance(found, Mapping) and isinstance(found.get(key), Mapping):
            found = found[key]
    if not isinstance(found, Mapping) or found.get("kind") not in KINDS:
        if isinstance(found, Mapping) and found.get("kind") == "pair motion":
            raise InputError(
                f"{name} holds a motion of two hands, one on each arm, and a witness is one hand: in Python "
                "zwidth.operators.WitnessMotion(verdict.witness.leader)"
            )
        raise InputError(
            f"{name} holds no motion that takes energy out: save one with zwidth check … -o FILE, of a loop "
            "that is active, or with zwidth limit"
        )
    try:
        positions = _column(found, "positions_m", "positions_rad")
        switches = _column(found, "switch_positions_m", "switch_positions_rad")
        parts = found.get("repeats", ())
        parts = [parts] if isinstance(parts, Mapping) else parts  # one part, or a list of them
        repeats = tuple(Repeat(int(r["first"]), int(r["last"]), int(r["times"])) for r in parts)
        pieces = int(found.get("pieces", 1))
    except (TypeError, ValueError, KeyError, ZeroDivisionError) as error:
        raise InputError(f"{name} holds a motion that cannot be read: {error}") from None
    if len(positions) < 2:
        raise InputError(f"{name} holds a motion of fewer than two positions")
    if pieces < 1 or (len(positions) - 1) % pieces:
        raise InputError(
            f"{name} holds a motion of {len(positions)} positions, and none of {pieces} pieces a sample"
        )
    return Motion(positions, switches, repeats, pieces)


def _column(document: Mapping[str, Any], *names: str) -> tuple[Fraction, ...]:
    values = next((document[name] for name in names if name in document), ())
    return tuple(_fraction(value) for value in values)


def _fraction(value: object) -> Fraction:
    if not isinstance(value, (int, str, Decimal)):
        raise ValueError(f"{value!r} is no number")
    return Fraction(value)


# A tiny step to and fro over one edge refutes Coulomb friction against the encoder.  Moving by ε over an edge
# changes the count by one, and with it the force by Δ · (step response); Coulomb friction costs f_c ε each
# way and viscous friction only ε² b/T, so a small enough ε gains (Abbott & Okamura 2005, section III-C).  The
# hand may wait at either side for the force to be as it likes it.


LONGEST_WAIT = 12
"""Samples the hand may wait on one side of an edge, beyond the delay."""

_APPROACH = 64
_HORIZON = 400


@dataclass(frozen=True)
class Waits:
    """How many samples to stay above and below the edge, and the force gained per count."""

    above: int
    below: int
    gain: float


def best_waits(loop: LinearLoop) -> Waits:
    """The waits that gain most force between going out and coming in [N/m], to rounding.

    Twice the Coulomb friction per resolution below this gain is too little.
    """
    response = _impulse_response(loop)
    extra = loop.whole_delay + (1 if loop.part_delay else 0)
    best = Waits(1 + extra, 1 + extra, float("-inf"))
    periods = range(2 * (1 + extra), 2 * (LONGEST_WAIT + extra) + 1)
    turns = {period: [sum(response[r::period]) for r in range(period)] for period in periods}
    for above in range(1, LONGEST_WAIT + 1):
        for below in range(1, LONGEST_WAIT + 1):
            gain = _gain(turns[above + below + 2 * extra], above + extra, loop)
            if gain > best.gain * (1 + 1e-12) + 1e-300:
                best = Waits(above + extra, below + extra, gain)
    return best


def _impulse_response(loop: LinearLoop) -> list[float]:
    """h(k) to rounding, from whole numbers: clustered poles cancel many digits."""
    d, n = loop.denominator, loop.numerator
    bits = 64 + 16 * len(d)
    h: list[int] = []
    for k in range(_HORIZON):
        value = (n[k] << bits) if k < len(n) else 0
        value -= sum(d[i] * h[k - i] for i in range(1, min(k, len(d) - 1) + 1))
        h.append(value // d[0])
    return [float(Fraction(v, 1 << bits)) if abs(v) >> bits < 10**100 else 0.0 for v in h]


def _gain(turn: list[float], above: int, loop: LinearLoop) -> float:
    """Force going out minus force coming in over one settled cycle, per count.

    `turn` is h summed over all cycles that came before, for each sample of a cycle.
    """
    period, d, alpha = len(turn), loop.whole_delay, float(loop.part_delay)

    def force(phase: int) -> float:
        """Computed `phase` samples after coming above."""
        return sum(turn[(phase - k) % period] for k in range(above))

    def applied(phase: int) -> float:
        return alpha * force(phase - d - 1) + (1 - alpha) * force(phase - d)

    return applied(above - 1) - applied(period - 1)


def edge_crossing(
    loop: LinearLoop, coulomb_friction: Fraction, resolution: Fraction, waits: Waits, edge: int
) -> Motion | None:
    """To and fro over the edge `edge` counts from x = 0, going there first; None if that gains nothing."""
    surplus = Fraction(waits.gain) * resolution - 2 * coulomb_friction
    if surplus <= 0:
        return None
    step = resolution / 4
    if loop.damping > 0:
        step = min(step, round_up(surplus * loop.period / (4 * loop.damping)) / 2)
    at = edge * resolution
    below, above = at - step, at  # the floor is taken at the edge itself
    if edge:
        below, above = at - step / 2, at + step / 2
    approach = [below * k / _APPROACH for k in range(_APPROACH + 1)] if edge else [above]
    lead = approach + [below] * (loop.whole_delay + 2)
    cycle = [above] * waits.above + [below] * waits.below
    x = tuple(lead + cycle * 2)
    first = len(lead) + len(cycle) - 1
    switches = tuple(a + loop.part_delay * (b - a) for a, b in zip(x, x[1:], strict=False))
    return Motion(x, switches if loop.part_delay else (), (Repeat(first, len(x) - 1, 1),))
