"""What to change: the smallest change that makes an active loop passive, or the slack of a passive one.

Every value given was itself proved passive, all else as it was, and of the same hands as the outcome: a loop
that is passive with contact made and broken stays so.  Where a proof of hands that keep contact is all that
was found, the advice says so.

What is asked for is convex in the K and the B of a wall, and more b, more f_c and a finer encoder never hurt:
beyond their limits nothing holds again.  In a delay, a period or the time constant of a filter that may
be (behind a part of a sample a wall asks for more than behind a whole one): of these the way to the limit is
looked at in steps, and the limit is the first place that fails.
"""

from __future__ import annotations

from collections.abc import Callable, Iterable, Iterator, Mapping
from dataclasses import dataclass, replace
from fractions import Fraction
from functools import cache, cached_property, partial
from math import inf, isinf
from typing import Literal

from zwidth.environment import OnePole, Wall, Window
from zwidth.environment.wall import wall_of
from zwidth.passivity.certificate import Certificate, certify_box
from zwidth.passivity.corners import Loop, worst_corners
from zwidth.passivity.decision import decide
from zwidth.passivity.likely_limits import (
    Change,
    likely_damping,
    likely_friction,
    likely_resolution,
    likely_value,
)
from zwidth.passivity.linear.boundary import (
    COARSE,
    COARSER,
    SMALLEST,
    Holds,
    largest_holding,
    smallest_holding,
)
from zwidth.passivity.parameter_limits import has_stiffness, is_of_high_degree, provable
from zwidth.quantity.exact import Exact, Interval, ends
from zwidth.quantity.glossary import GLOSSARY
from zwidth.quantity.spoken import spoken
from zwidth.quantity.text import alike, in_words, outward_decimal, readable

_NEVER_NOTHING = ("stiffness", "resolution", "link_delay")
"""What nobody can set to 0 and keep what it is there for."""

_WINDOWS = (2, 3, 4, 5, 6, 8, 10, 15, 20)

_EASIEST_FIRST = (
    "stiffness", "virtual_damping", "local_damping", "velocity_filter", "time_constant", "link_delay", "rate",
    "delay", "damping", "resolution", "coulomb_friction",
)  # fmt: skip
"""The law, then the loop, then the machine."""


Likely = Callable[[], float | None]
"""Where a limit may be looked for first; None where nothing is known of that."""


def nowhere() -> None:
    """Nothing is known of where a limit is."""


@dataclass(frozen=True)
class Advice:
    """One parameter, where it is and where it may or must go, both in `unit`.

    `kind` is "change" for a loop that is not passive and "slack" for one that
    is; `to` is None where no value on the safer side was found that would do
    alone, and inf ("any" as plain data) where it may have any value.  `is_alone` where it is no limit
    that keeps it where it is: of values beside it nothing is proved or refuted.  Of an interval it is the end
    that asks for more.
    """

    parameter: str
    current: float | str
    to: float | str | None
    unit: str
    kind: Literal["change", "slack"]
    text: str
    is_alone: bool = False

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
    """Advice as a report says it.

    Parameters
    ----------
    title
        What the lines are.
    changes
        A line for what may be turned, what is changed most easily first.
    at_limit
        What may not be turned by anything, in one line; "" where there is nothing.
    useless
        What it is no use to turn, in one line; "" where there is nothing.
    """

    title: str
    changes: tuple[str, ...]
    at_limit: str
    useless: str

    @property
    def useful(self) -> tuple[str, ...]:
        """All but the useless."""
        return (*self.changes, self.at_limit) if self.at_limit else self.changes


def in_lines(advice: Iterable[Advice], passive: bool) -> InLines:
    """What to change, or what is left, as a report says it."""
    ordered = sorted(advice, key=_rank)
    useless = [a for a in ordered if a.to is None and a.current != 0]
    at_limit = [a for a in ordered if a.kind == "slack" and a.to is not None and a.to == a.current]
    none = "no slack" if passive else "no change found that would do alone"
    return InLines(
        "slack" if passive else "what to change, any one of",
        tuple(item.text for item in ordered if item.to is not None and item not in at_limit),
        "; ".join(_where_it_is(at_limit)),
        f"{none}: {_names(useless)}" if useless else "",
    )


def _where_it_is(advice: Iterable[Advice]) -> Iterator[str]:
    """Those at a limit, and those of whose neighbours nothing is known."""
    sorted_out = {alone: [a for a in advice if a.is_alone is alone] for alone in (False, True)}
    if sorted_out[False]:
        yield f"exactly at the limit: {_names(sorted_out[False])}"
    if sorted_out[True]:
        yield f"proved where it is, and for delays of whole samples alone: {_names(sorted_out[True])}"


def _rank(advice: Advice) -> int:
    name = advice.parameter
    return _EASIEST_FIRST.index(name) if name in _EASIEST_FIRST else len(_EASIEST_FIRST)


def _names(advice: Iterable[Advice]) -> str:
    return ", ".join(_name(a.parameter) for a in advice)


def _name(parameter: str) -> str:
    """In words; "leader.damping" is that of one arm of a pair."""
    arm, _, key = parameter.rpartition(".")
    return in_words(key) + (f" of the {arm}" if arm else "")


@dataclass(frozen=True)
class Knob:
    """A number that one can turn: `holds` of a value that is proved; with `more`, more of it is safer.

    `parameter` is a name of the glossary, behind "leader." or "follower." where it is of one arm.  Where
    its limit may be looked for first says `likely`; `in_samples`, that it is proved for delays of whole
    samples alone.  Where it may fail on the way to a limit that holds, `between` names values on that way.
    Of a number below 0 it is the size, and `sign` is −1.  `hands` is said of whom it holds.
    """

    parameter: str
    current: float
    holds: Holds
    more: bool
    name: str
    likely: Likely = nowhere
    in_samples: bool = False
    between: Between | None = None
    sign: int = 1
    hands: str = ""


Between = Callable[[float], Iterable[float]]
"""Values between where a number is and where it may go."""

_KEPT = " while contact is kept"

_PHASES = (0, 0.2, 0.4, 0.5, 0.6, 0.8)
"""Of a sample: behind which part of it a loop asks for most depends on the law."""

_MOST_SAMPLES = 3


def between_delays(now: float, period: float) -> Between:
    """Delays on the way from one to another: parts of the last samples and of the first [s]."""

    def between(to: float) -> Iterator[float]:
        first = int(now / period)
        last = int(min(to, now + 1000 * period) / period)
        samples = sorted({first, *range(max(first, last - _MOST_SAMPLES + 1), last + 1)})
        yield from ((n + phase) * period for n in samples for phase in _PHASES)

    return between


def between_rates(now: float, delay: float) -> Between:
    """The same of rates behind a delay: at which parts of a sample it ends, and some between [Hz]."""

    def between(to: float) -> Iterator[float]:
        least = to if 0 < to < inf else now / 1000
        yield from between_sizes(now)(least)
        if delay:
            yield from (r / delay for r in between_delays(least * delay, 1)(now * delay))

    return between


def between_sizes(now: float) -> Between:
    """Some values in proportion."""

    def between(to: float) -> Iterator[float]:
        low, high = now or to / 1000, to if 0 < to < inf else now * 1000 if to else now / 1000
        yield from (low * (high / low) ** (part / 6) for part in range(1, 6)) if low and high else ()

    return between


@dataclass(frozen=True)
class Asked:
    """What is to be proved of which loop.

    Parameters
    ----------
    at
        The loop; where it has intervals their corner that asks for most.
    box
        The same with its intervals.
    contact
        As for `provable`.
    """

    at: Loop
    box: Loop
    contact: bool = False

    def is_confirmed(self, advice: Advice) -> bool:
        """Whether between the ends of intervals a value is proved as well, as the checker sees it."""
        if not isinstance(advice.to, float) or advice.to in (advice.current, inf):
            return True
        return self.covers(_TURNED[advice.parameter](self.box, Exact(advice.to).fraction))

    def covers(self, loop: Loop) -> bool:
        """Whether the checker finds it proved for all values of a loop that is provable at its corners."""
        if self.at == self.box:
            return True
        corners = worst_corners(*loop)
        proofs = certify_box(*loop, corners, [decide(*corner) for corner in corners])
        covered = None if proofs is None else Certificate(tuple(proofs)).covered()
        return covered is not None and not (self.contact and covered.contact == "kept")


def advise(
    asked: Asked, passive: bool, or_kept: bool = False, stiffest: Likely = nowhere
) -> tuple[Advice, ...]:
    """Advice on every parameter of a loop.

    Parameters
    ----------
    asked
        The loop, and what is to be proved.
    passive
        True to say how far each parameter may go, False for what to change.
    or_kept
        Whether a proof of hands that keep contact is better than none.
    stiffest
        Its `max_stiffness`, which is then not looked for twice.
    """
    found = tuple(_advised(asked, passive, "" if asked.contact or not or_kept else _KEPT, stiffest))
    if passive or not (asked.contact and or_kept) or any(advice.to is not None for advice in found):
        return found
    return tuple(_advised(replace(asked, contact=False), passive, _KEPT, nowhere))


def _advised(asked: Asked, passive: bool, hands: str, stiffest: Likely) -> Iterator[Advice]:
    kind: Literal["change", "slack"] = "slack" if passive else "change"
    device, law = asked.at
    is_high = is_of_high_degree(*asked.at)
    grain = COARSER if is_high else COARSE
    knobs = [replace(knob, hands=hands) for knob in _Knobs(asked).every(stiffest)]
    if is_high:  # to find where a limit is likely takes as long as to find it
        knobs = [replace(knob, likely=nowhere) for knob in knobs]
    found = turn_all(knobs, device.motion, kind, grain)
    yield from filter(asked.is_confirmed, found)
    wall = wall_of(law)
    if not passive and wall is not None and wall.damping != 0:
        yield from _estimators(asked, wall, hands, grain)


Turned = Callable[[Loop, Fraction], Loop]
"""A loop with a value of one of its parameters."""


@dataclass(frozen=True)
class _Knobs:
    """Those of a loop."""

    asked: Asked

    def every(self, stiffest: Likely) -> Iterator[Knob]:
        """All of them, from the device to the law."""
        law, (whole, of_box) = self.asked.at[1], self.asked.box
        period, delay = ends(whole.sample_period)[1], ends(whole.delay)[1]
        rate = self._searched("rate", 1 / period, True, "rate", float(period))
        between = between_rates(float(1 / period), float(delay))
        yield replace(rate, in_samples=delay > 0 and self._in_samples, between=between)
        yield from self._losses()
        later = self._searched("delay", delay, False, "delay", float(period))
        between = between_delays(float(delay), float(period))
        yield replace(later, in_samples=self._in_samples, between=between)
        wall = wall_of(law)
        if has_stiffness(law):
            now = ends(of_box.stiffness)[1]  # type: ignore[attr-defined]
            on_the_way = None if wall is not None else between_sizes(float(now))
            holds = self._proved("stiffness", now)
            yield Knob("stiffness", float(now), holds, False, "stiffness", stiffest, between=on_the_way)
        if wall is not None:
            yield from self._of_wall(wall)

    def _losses(self) -> Iterator[Knob]:
        """What takes energy out, and the encoder: of these it is known what a loop asks for."""
        decision, contact = decide(*self.asked.at), self.asked.contact
        of_one = replace(decision, setting=replace(decision.setting, resolution=Fraction(1)))
        for key, more, name, likely in (
            ("damping", True, "device damping", lambda: likely_damping(decision, contact)),
            ("coulomb_friction", True, "Coulomb friction", lambda: likely_friction(decision, contact)),
            ("resolution", False, "encoder resolution", lambda: likely_resolution(of_one, contact)),
        ):
            now = self.asked.at[0].exact(key)
            yield Knob(key, float(now), self._proved(key, now), more, name, likely)

    def _of_wall(self, wall: Wall) -> Iterator[Knob]:
        whole = self.asked.box[1]
        if isinstance(getattr(whole, "damping", None), Exact):
            b = wall.damping
            assert isinstance(b, Exact)
            sign, usual = -1 if b < 0 else 1, float(self.asked.at[0].exact("damping")) or 1.0
            yield self._searched("virtual_damping", abs(b.fraction), False, "virtual damping", usual, sign)
        tau = getattr(getattr(whole, "velocity_filter", None), "time_constant", None)
        if isinstance(tau, Exact) and wall.damping != 0:
            name = "filter time constant"
            knob = self._searched("time_constant", tau.fraction, True, name, 0.0)
            yield replace(knob, between=between_sizes(float(tau)))

    def time_constant(self, begin: float) -> Knob:
        """Of a one-pole filter in the place of that of the wall [s]; looked for from `begin` on."""
        change = partial(_TURNED["time_constant"], self.asked.at)
        likely = partial(likely_value, change, self.asked.contact, begin, begin, True)
        holds = self._proved("time_constant", None)
        return Knob("time_constant", 0.0, holds, True, "time constant", likely)

    def _searched(self, key: str, now: Fraction, more: bool, name: str, other: float, sign: int = 1) -> Knob:
        """A knob of which secants say where its limit is likely; `other` as for `likely_value`."""
        change: Change = lambda size: _TURNED[key](self.asked.at, sign * size)  # noqa: E731
        likely = partial(likely_value, change, self.asked.contact, float(now), other, more)
        return Knob(key, float(now), self._proved(key, now, sign), more, name, likely, sign=sign)

    def _proved(self, key: str, now: Fraction | None, sign: int = 1) -> Holds:
        """Whether the loop with a value is proved passive; as it is, it is decided once for all knobs."""
        change: Change = lambda size: _TURNED[key](self.asked.box, sign * size)  # noqa: E731
        return lambda size: self._here if size == now else provable(change, size, self.asked.contact)

    @cached_property
    def _in_samples(self) -> bool:
        """True where contact made and broken is proved, and with a delay half a sample longer never is."""
        device, law = self.asked.at
        decision = decide(device, law)
        if decision.is_spring or not (self.asked.contact or decision.is_clamped):
            return False
        longer = device.exact("delay") + device.exact("sample_period") / 2
        return decide(device.replace(delay=Exact(longer)), law).contact_damping is None

    @cached_property
    def _here(self) -> bool:
        return provable(lambda _: self.asked.box, Fraction(0), self.asked.contact)


def _of_device(key: str, more: bool) -> Turned:
    def turned(loop: Loop, value: Fraction) -> Loop:
        device, law = loop
        return device.replace(**{key: _moved(getattr(device, key), value, more)}), law

    return turned


def _rate(loop: Loop, value: Fraction) -> Loop:
    device, law = loop
    if isinstance(device.sample_period, Interval):
        return _of_device("sample_period", False)(loop, 1 / value)
    return device.replace(rate=Exact(value)), law


def _stiffness(loop: Loop, value: Fraction) -> Loop:
    device, law = loop
    return device, law.replace(stiffness=_moved(law.stiffness, value, False))  # type: ignore[attr-defined]


_TURNED: Mapping[str, Turned] = {
    "rate": _rate,
    "damping": _of_device("damping", True),
    "coulomb_friction": _of_device("coulomb_friction", True),
    "resolution": _of_device("resolution", False),
    "delay": _of_device("delay", False),
    "stiffness": _stiffness,
    "virtual_damping": lambda loop, value: (loop[0], loop[1].replace(damping=Exact(value))),
    "time_constant": lambda loop, value: (loop[0], loop[1].replace(velocity_filter=OnePole(Exact(value)))),
}


def _moved(now: Exact | Interval, value: Fraction, more: bool) -> Exact | Interval:
    """A value, or an interval with its worse end there; one value where its other end would be worse."""
    if not isinstance(now, Interval):
        return Exact(value)
    low, high = ends(now)
    if more:
        return Exact(value) if value >= high else Interval(Exact(value), now.high)
    return Exact(value) if value <= low else Interval(now.low, Exact(value))


def turn_all(
    knobs: Iterable[Knob], motion: str, kind: Literal["change", "slack"], grain: int = COARSE
) -> list[Advice]:
    """`turn` of each; what there is none of, and cannot be less of, is left out."""
    found = [turn(knob, motion, kind, grain) for knob in knobs]
    return [one for one in found if one.kind == "change" or one.to != 0 or one.current != 0]


def turn(knob: Knob, motion: str, kind: Literal["change", "slack"], grain: int = COARSE) -> Advice:
    """How far a knob must be turned, or may be; `grain` as for `largest_holding`."""
    knob = replace(knob, holds=cache(knob.holds))  # at its limit, and for a shorter one, it is asked again
    to = None
    if knob.more or knob.current or kind == "slack":  # nothing is less than 0
        to = _last_proved(knob, grain)
    if kind == "slack" and to is not None:
        to = _first_crossing(knob, to, grain)
    if kind == "change" and to is not None and not _is_change(knob, to):
        to = None
    unit = GLOSSARY[knob.parameter.rpartition(".")[2]].unit_for(motion)
    shown = None if to is None else outward(to, knob, spoken(unit)[0])
    is_alone = to == knob.current and (knob.in_samples or _stands_alone(knob))
    now, signed = knob.sign * knob.current or 0.0, None if to is None else knob.sign * to
    text = _text(replace(knob, in_samples=is_alone), shown, unit, kind)
    return Advice(knob.parameter, now, signed, unit, kind, text, is_alone)


def _stands_alone(knob: Knob) -> bool:
    """True where not even a hair to the safe side holds: a delay of whole samples that asks for less."""
    beside = knob.current * (1 + 1e-9 if knob.more else 1 - 1e-9)
    return knob.between is not None and knob.current > 0 and not knob.holds(Exact(beside).fraction)


def _first_crossing(knob: Knob, to: float, grain: int) -> float:
    """How far it may go, where on the way there a value fails: to before the first that does."""
    if knob.between is None or to == knob.current:
        return to
    end = 0.0 if knob.more and to == inf else to
    ways = sorted((v for v in knob.between(to) if _is_between(knob.current, v, end)), reverse=knob.more)
    failing = next((v for v in ways if not knob.holds(Exact(v).fraction)), None)
    if failing is None:
        return to
    good, bad = knob.current, failing
    while abs(bad - good) > grain * 2.0**-53 * abs(bad):
        middle = (good + bad) / 2
        good, bad = (middle, bad) if knob.holds(Exact(middle).fraction) else (good, middle)
    return _first_crossing(knob, _simplest_near(good, knob.holds, knob.more, grain), grain)


def _is_between(one: float, value: float, other: float) -> bool:
    return min(one, other) < value < max(one, other)


def _last_proved(knob: Knob, grain: int) -> float | None:
    """The last value that is proved, inf or 0 where that is any, None where none is."""
    search = smallest_holding if knob.more else largest_holding
    to = search(knob.holds, knob.current or 1e-4, grain, knob.likely())
    if to is None or to == inf:
        return to
    if knob.more and to <= SMALLEST:
        return inf if knob.parameter == "rate" else 0.0
    return _simplest_near(to, knob.holds, knob.more, grain) if to > SMALLEST else to


def _simplest_near(value: float, holds: Holds, more: bool, grain: int) -> float:
    """The shortest decimal within a grain of the boundary, if it is proved too."""
    near = grain * 2.0**-51
    beyond = value * (1 - near if more else 1 + near)
    for digits in range(1, 9):
        short = float(f"{value:.{digits}g}")
        if min(value, beyond) <= short <= max(value, beyond) and holds(Exact(short).fraction):
            return short
    return value


def _is_change(knob: Knob, to: float) -> bool:
    """A remedy must lie on the safer side of where the parameter is and be something one can set."""
    if to == inf or (to == 0 and knob.parameter.rpartition(".")[2] in _NEVER_NOTHING):
        return False
    return to > knob.current if knob.more else to < knob.current


def outward(value: float, knob: Knob, factor: float = 1.0) -> float:
    """Four significant digits on the safe side, in the unit of which one in SI is `factor`, if proved too.

    Six or more where four are not, or are no farther than where it is.
    """
    if value == 0 or isinf(value) or value == knob.current:
        return value
    for digits in (4, 6, 9, 12):
        rounded = outward_decimal(value * factor, knob.more, digits) / factor
        is_farther = (rounded < knob.current) == (value < knob.current) and rounded != knob.current
        if is_farther and knob.holds(Exact(rounded).fraction):
            return rounded
    return value


def _text(knob: Knob, to: float | None, unit: str, kind: str) -> str:
    name, hands = knob.name, knob.hands
    higher = knob.more == (knob.sign > 0)
    if kind == "change" and to is None:
        return f"no {'higher' if higher else 'lower'} {name} was found that would do alone{hands}"
    if to is None or to == inf:
        return f"{name} may take any value{hands}" if to == inf else f"{name} has no slack"
    size = to * spoken(unit)[0]
    digits = next((n for n in range(6, 17) if abs(float(f"{size:.{n}g}") - size) <= 1e-15 * size), 17)
    near = 4 if digits == 6 and abs(to - knob.current) > 2e-3 * abs(to) else 12
    now, wanted = alike(unit, (knob.sign * knob.current, knob.sign * to), (near, digits))
    if kind == "change":
        return f"{'raise' if higher else 'lower'} the {name} from {now} to {wanted}{hands}"
    if to == knob.current and knob.in_samples:
        return f"{name} is proved where it is, {now}, and for delays of whole samples alone"
    if to == knob.current:
        return f"{name} is exactly at its limit, {now}"
    bound = "as low as" if knob.more else "up to" if knob.sign > 0 else "down to"
    return f"{name} may go {bound} {wanted}{hands} (now {now})"


def _estimators(asked: Asked, wall: Wall, hands: str, grain: int) -> Iterator[Advice]:
    """Another velocity estimator that makes the loop passive, if one of the usual does."""
    now = wall.velocity_filter.describe()
    device, law = asked.box
    for samples in _WINDOWS:
        other = device, law.replace(velocity_filter=Window(samples))
        if provable(lambda _, other=other: other, Fraction(0), asked.contact) and asked.covers(other):  # type: ignore[misc]
            to = f"window of {samples} samples"
            text = f"estimate velocity with a {to} instead of the {now}{hands}"
            yield Advice("velocity_filter", now, to, "", "change", text)
            break
    if wall.velocity_filter.time_constant is None:
        period = float(ends(device.sample_period)[1])
        knob = _Knobs(asked).time_constant(period)
        tau = _first_scanned(knob, period, grain)
        if tau is not None and asked.covers(_TURNED["time_constant"](asked.box, Exact(tau).fraction)):
            shown = outward(tau, knob)
            to = f"one-pole filter of {readable(shown, 's')}"
            text = f"estimate velocity with a {to} (time constant) instead of the {now}{hands}"
            yield Advice("velocity_filter", now, to, "", "change", text)


def _first_scanned(knob: Knob, period: float, grain: int) -> float | None:
    """The smallest time constant found, from one sample to a thousand."""
    for power in range(10):
        if knob.holds(Exact(period * 2**power).fraction):
            return smallest_holding(knob.holds, period * 2**power, grain, knob.likely())
    return None
