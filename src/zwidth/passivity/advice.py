"""How far one number must be turned for a loop to become passive, or may be, and how a report lists it."""

from __future__ import annotations

from collections.abc import Callable, Iterable, Iterator
from dataclasses import dataclass, replace
from fractions import Fraction
from functools import cache
from math import inf, isinf
from typing import Literal

from zwidth.passivity.linear.boundary import (
    COARSE,
    SMALLEST,
    Holds,
    asked_seldom,
    largest_holding,
    smallest_holding,
)
from zwidth.quantity.exact import Exact
from zwidth.quantity.glossary import GLOSSARY
from zwidth.quantity.spoken import spoken
from zwidth.quantity.text import in_words, outward_decimal, shown

Kind = Literal["change", "slack"]

_EASIEST_FIRST = (
    "stiffness", "virtual_damping", "local_damping", "velocity_filter", "time_constant", "link_delay", "rate",
    "delay", "damping", "resolution", "coulomb_friction",
)  # fmt: skip
"""The law, then the loop, then the machine."""


@dataclass(frozen=True)
class Advice:
    """One parameter, where it is and where it may or must go, both in `unit`.

    `kind` is "change" for a loop that is not passive and "slack" for one that is; `to` is None where no value
    on the safer side was found that would do alone, and inf ("any" as plain data) where it may have any.
    `is_alone` where it is no limit that keeps it where it is: of values beside it nothing is proved or
    refuted.  Of an interval it is the end that asks for more.  `told` is `to` as the text says it, rounded to
    the safe side; None where it is no number that was turned.
    """

    parameter: str
    current: float | str
    to: float | str | None
    unit: str
    kind: Kind
    text: str
    is_alone: bool = False
    told: float | None = None

    @property
    def is_at_limit(self) -> bool:
        """True of slack that is none."""
        return self.kind == "slack" and self.to == self.current

    def to_dict(self) -> dict[str, object]:
        """As plain data: parameter, from, to, unit, kind, text."""
        to = "any" if isinstance(self.to, float) and isinf(self.to) else self.to
        return {
            "parameter": self.parameter,
            "from": self.current,
            "to": to,
            "unit": self.unit,
            "kind": self.kind,
            "text": self.text,
        }


@dataclass(frozen=True)
class InLines:
    """Advice as a report says it: a title, and under it what may be turned, easiest first, a line each.

    Then in one line each, "" where there is nothing: what is `at_limit`, and what it is `useless` to turn.
    """

    title: str
    changes: tuple[str, ...]
    at_limit: str
    useless: str

    @property
    def useful(self) -> tuple[str, ...]:
        """All but the useless."""
        return (*self.changes, self.at_limit) if self.at_limit else self.changes


def easiness(parameter: str) -> int:
    """The place of a parameter among those that may be turned, the easiest first."""
    return (*_EASIEST_FIRST, parameter).index(parameter)


def easiest_first(advice: Iterable[Advice]) -> list[Advice]:
    """The same in the order of a report."""
    return sorted(advice, key=lambda item: easiness(item.parameter))


def in_lines(advice: Iterable[Advice], passive: bool) -> InLines:
    """What to change, or what is left, as a report says it."""
    ordered = easiest_first(advice)
    useless = [a for a in ordered if a.to is None and a.current != 0]
    at_limit = [a for a in ordered if a.to is not None and a.is_at_limit]
    none = "no slack" if passive else "none found that would do alone"
    return InLines(
        "slack" if passive else "what to change, any one of",
        tuple(item.text for item in ordered if item.to is not None and item not in at_limit),
        "; ".join(_where_it_is(at_limit)),
        f"{none}: {_names(useless)}" if useless else "",
    )


def with_what_to_do(found: str, advice: Iterable[Advice], outcome: str) -> str:
    """A sentence of what was found, without its point, and the first change of `advice`, or the slack."""
    first = next((a.text for a in advice if a.to is not None and not a.is_at_limit), "")
    if not first:
        return f"{found}."
    return f"{found}. For a proof, {first}." if outcome == "undecided" else f"{found}: {first}."


def _where_it_is(advice: Iterable[Advice]) -> Iterator[str]:
    """Those at a limit, and those of whose neighbours nothing is known."""
    words = "exactly at the limit", "proved where it is, and for delays of whole samples alone"
    for is_alone, where in enumerate(words):
        if these := [a for a in advice if a.is_alone == is_alone]:
            yield f"{where}: {_names(these)}"


def _names(advice: Iterable[Advice]) -> str:
    """In words; "leader.damping" is that of one arm of a pair."""
    parts = (item.parameter.rpartition(".") for item in advice)
    return ", ".join(in_words(key) + (f" of the {arm}" if arm else "") for arm, _, key in parts)


# Every value given was itself proved, all else as it was.  Where the proof may fail on the way to a limit
# that holds, the way is looked at in steps, and the limit is the first place that fails.


_NEVER_NOTHING = ("stiffness", "resolution", "link_delay")
"""What nobody can set to 0 and keep what it is there for."""

Guess = Callable[[], float | None]
"""Where a limit may be looked for first; None where nothing is known of that."""

Between = Callable[[float], Iterable[float]]
"""Values between where a number is and where it may go."""

_PHASES = (0, 0.2, 0.4, 0.5, 0.6, 0.8)
"""Of a sample: behind which part of it a loop asks for most depends on the law."""

_MOST_SAMPLES = 3

_BESIDE = (Fraction(1, 2**30),)  # how far beside a limit that is known but for rounding it is asked


@dataclass(frozen=True)
class Knob:
    """A number that one can turn: `holds` of a value that is proved; with `more`, more of it is safer.

    `parameter` is a name of the glossary, behind "leader." or "follower." where it is of one arm.  Where
    its limit may be looked for first says `likely`; where it is, but for rounding, `near`; `in_samples`,
    that it is proved for delays of whole samples alone.  Where it may fail on the way to a limit that holds,
    `between` names values on that way.  Of a number below 0 it is the size, and `sign` is −1.  `hands` is
    said of whom it holds.
    """

    parameter: str
    current: float
    holds: Holds
    more: bool
    name: str
    likely: Guess = lambda: None
    in_samples: bool = False
    between: Between | None = None
    sign: int = 1
    hands: str = ""
    near: Guess = lambda: None

    def proves(self, value: float) -> bool:
        """Whether a value is proved, as the decimal that it is written as."""
        return self.holds(Exact(value).fraction)

    def is_change(self, to: float) -> bool:
        """A remedy must lie on the safer side of where it is and be something one can set."""
        is_none = to == inf or (to == 0 and self.parameter.rpartition(".")[2] in _NEVER_NOTHING)
        return not is_none and (to > self.current if self.more else to < self.current)

    @property
    def stands_alone(self) -> bool:
        """True where not even a hair to the safe side holds: a delay of whole samples that asks for less."""
        beside = self.current * (1 + 1e-9 if self.more else 1 - 1e-9)
        return self.in_samples or (self.between is not None and self.current > 0 and not self.proves(beside))


def between_delays(now: float, period: float, to: float) -> Iterator[float]:
    """Delays on the way from one to another: parts of the last samples and of the first [s]."""
    first = int(now / period)
    last = int(min(to, now + 1000 * period) / period)
    samples = sorted({first, *range(max(first, last - _MOST_SAMPLES + 1), last + 1)})
    yield from ((n + phase) * period for n in samples for phase in _PHASES)


def between_rates(now: float, delay: float, to: float) -> Iterator[float]:
    """The same of rates behind a delay: at which parts of a sample it ends, and some between [Hz]."""
    least = to if 0 < to < inf else now / 1000
    yield from between_sizes(now, least)
    if delay:
        yield from (r / delay for r in between_delays(least * delay, 1, now * delay))


def between_sizes(now: float, to: float) -> Iterator[float]:
    """Some values in proportion."""
    low, high = now or to / 1000, to if 0 < to < inf else now * 1000 if to else now / 1000
    yield from (low * (high / low) ** (part / 6) for part in range(1, 6)) if low and high else ()


def turn_all(knobs: Iterable[Knob], motion: str, kind: Kind, grain: int = COARSE) -> list[Advice]:
    """`turn` of each; what there is none of, and cannot be less of, is left out."""
    found = [turn(knob, motion, kind, grain) for knob in knobs]
    return [one for one in found if one.kind == "change" or one.to != 0 or one.current != 0]


def turn(knob: Knob, motion: str, kind: Kind, grain: int = COARSE) -> Advice:
    """How far a knob must be turned, or may be; `grain` as for `largest_holding`."""
    seldom = asked_seldom(knob.holds, near, _BESIDE, not knob.more) if (near := knob.near()) else knob.holds
    knob = replace(knob, holds=cache(seldom))  # at its limit, and for a shorter one, it is asked again
    to = None
    if knob.more or knob.current or kind == "slack":  # nothing is less than 0
        to = _last_proved(knob, grain)
    if to is not None and kind == "slack":
        to = _first_crossing(knob, to, grain)
    elif to is not None and not knob.is_change(to):
        to = None
    unit = GLOSSARY[knob.parameter.rpartition(".")[2]].unit_for(motion)
    is_alone = to == knob.current and knob.stands_alone
    told = None if to is None else outward(to, knob, spoken(unit)[0])
    text = _text(knob, told, unit, kind, is_alone)
    now, to = knob.sign * knob.current or 0.0, None if to is None else knob.sign * to
    return Advice(knob.parameter, now, to, unit, kind, text, is_alone, told)


def _first_crossing(knob: Knob, to: float, grain: int) -> float:
    """How far it may go, where on the way there a value fails: to before the first that does."""
    if knob.between is None or to == knob.current:
        return to
    least, most = sorted((knob.current, 0.0 if knob.more and to == inf else to))
    ways = sorted((v for v in knob.between(to) if least < v < most), reverse=knob.more)
    failing = next((v for v in ways if not knob.proves(v)), None)
    if failing is None:
        return to
    good, bad = knob.current, failing
    while abs(bad - good) > grain * 2.0**-53 * abs(bad):
        middle = (good + bad) / 2
        good, bad = (middle, bad) if knob.proves(middle) else (good, middle)
    return _first_crossing(knob, _simplest_near(good, knob, grain), grain)


def _last_proved(knob: Knob, grain: int) -> float | None:
    """The last value that is proved, inf or 0 where that is any, None where none is."""
    search = smallest_holding if knob.more else largest_holding
    to = search(knob.holds, knob.current or 1e-4, grain, knob.likely())
    if to is None or to == inf:
        return to
    if knob.more and to <= SMALLEST:
        return inf if knob.parameter == "rate" else 0.0
    return _simplest_near(to, knob, grain) if to > SMALLEST else to


def _simplest_near(value: float, knob: Knob, grain: int) -> float:
    """The shortest decimal within a grain of the boundary, if it is proved too."""
    near = grain * 2.0**-51
    low, high = sorted((value, value * (1 - near if knob.more else 1 + near)))
    shorter = (float(f"{value:.{digits}g}") for digits in range(1, 9))
    return next((v for v in shorter if low <= v <= high and knob.proves(v)), value)


def outward(value: float, knob: Knob, factor: float = 1.0) -> float:
    """Four significant digits on the safe side, in the unit of which one in SI is `factor`, if proved too.

    Six or more where four are not, or are no farther than where it is.
    """
    if value == 0 or isinf(value) or value == knob.current:
        return value
    for digits in (4, 6, 9, 12):
        rounded = outward_decimal(value * factor, knob.more, digits) / factor
        is_farther = (rounded < knob.current) == (value < knob.current) and rounded != knob.current
        if is_farther and knob.proves(rounded):
            return rounded
    return value


def digits_of(value: float, unit: str) -> int:
    """In how many significant digits a number is told to the last, in the unit that is spoken; 6 at least."""
    size = value * spoken(unit)[0]
    return next((n for n in range(6, 17) if abs(float(f"{size:.{n}g}") - size) <= 1e-15 * size), 17)


def _text(knob: Knob, to: float | None, unit: str, kind: Kind, is_alone: bool) -> str:
    name, hands = knob.name, knob.hands
    higher = knob.more == (knob.sign > 0)
    if kind == "change" and to is None:
        return f"no {'higher' if higher else 'lower'} {name} was found that would do alone{hands}"
    if to is None or to == inf:
        return f"{name} may take any value{hands}" if to == inf else f"{name} has no slack"
    digits = digits_of(to, unit)
    near = 4 if digits == 6 and abs(to - knob.current) > 2e-3 * abs(to) else 12
    now, wanted = shown(knob.sign * knob.current, unit, near), shown(knob.sign * to, unit, digits)
    if kind == "change":
        verb = "bring" if knob.sign < 0 else "raise" if higher else "lower"  # -3 to -1 is neither to a person
        return f"{verb} the {name} from {now} to {wanted}{hands}"
    if to == knob.current:
        alone = f"proved where it is, {now}, and for delays of whole samples alone"
        return f"{name} is {alone if is_alone else f'exactly at its limit, {now}'}"
    bound = "as low as" if knob.more else "up to" if knob.sign > 0 else "down to"
    return f"{name} may go {bound} {wanted}{hands} (now {now})"
