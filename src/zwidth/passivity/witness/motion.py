"""A motion of the hand, exact, and how one is made from the law's inner signal.

With x = D w the force is f = N w, so a motion made from whole numbers w keeps
exact, short numbers through the filter, and a w that ends in zeros brings the
filter back to rest.  D is taken without its integer content (`follower`).
"""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass, replace
from decimal import Decimal
from fractions import Fraction
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
        return Motion(tuple(x), tuple(y))

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
        return len(self.positions) - 1 + sum((r.times - 1) * (r.last - r.first) for r in self.repeats)

    @property
    def depth(self) -> Fraction:
        """The deepest position of the whole motion."""
        ahead, deepest, after = Fraction(0), max(self.positions), 0
        for part in self.repeats:
            advance = self.positions[part.last] - self.positions[part.first]
            deepest = max(deepest, max(self.positions[after : part.last + 1]) + ahead)
            ahead += (part.times - 1) * advance
            after = part.last
        return max(deepest, max(self.positions[after:]) + ahead)


@dataclass(frozen=True)
class Pattern:
    """A motion in whole numbers: w of the law's direct form, x = unit · D w.

    The parts of w between `first` and `last` of each repeat may be done many
    times; `ends_inside` says that the last move, from the end of w to x = 0,
    is a step and not part of w.
    """

    w: tuple[int, ...]
    repeats: tuple[Repeat, ...]
    ends_inside: bool = False


def realize(loop: LinearLoop, pattern: Pattern, unit: Fraction, offset: Fraction, times: int) -> Motion:
    """The motion x = unit · D w, with the best instants inside samples.

    `offset` is added away from the ends: it moves the hand off the encoder's
    edges without changing a count.
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


def any_damping(loop: LinearLoop) -> Fraction:
    """A damping that makes the moves inside a sample large: without damping every size gains."""
    stiffness = Fraction(sum(abs(c) for c in loop.numerator), sum(abs(c) for c in loop.denominator))
    return (stiffness * loop.period * loop.part_delay * (1 - loop.part_delay) or Fraction(1)) / 10**6


def round_up(target: Fraction) -> Fraction:
    """The decimal of one digit at or just above a target > 0."""
    power = Fraction(10) ** floor(log10(target.numerator) - log10(target.denominator))
    return power * ceil(target / power)


KINDS = ("motion", "contact motion", "row motion")


def saved_motion(document: object, name: str) -> Motion:
    """The motion in a witness, an active verdict or a limit, as `zwidth check` and `zwidth limit` save them.

    `document`: as `read_document` gives it; `name`: of the file, for messages.
    """
    found: Any = document
    if isinstance(found, Mapping) and isinstance(found.get("witness"), Mapping):
        found = found["witness"]
    if not isinstance(found, Mapping) or found.get("kind") not in KINDS:
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
    except (TypeError, ValueError, KeyError, ZeroDivisionError) as error:
        raise InputError(f"{name} holds a motion that cannot be read: {error}") from None
    if len(positions) < 2:
        raise InputError(f"{name} holds a motion of fewer than two positions")
    return Motion(positions, switches, repeats)


def _column(document: Mapping[str, Any], *names: str) -> tuple[Fraction, ...]:
    values = next((document[name] for name in names if name in document), ())
    return tuple(_fraction(value) for value in values)


def _fraction(value: object) -> Fraction:
    if not isinstance(value, (int, str, Decimal)):
        raise ValueError(f"{value!r} is no number")
    return Fraction(value)
