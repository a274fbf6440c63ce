"""What to change: the smallest change that makes an active loop passive, or the slack of a passive one.

Every value given was itself proved passive, all else as it was.
"""

from __future__ import annotations

from collections.abc import Callable, Iterable, Iterator
from dataclasses import dataclass, replace
from fractions import Fraction
from functools import cache, cached_property, partial
from math import ceil, floor, inf, isinf, log10
from typing import Literal

from zwidth.device import Device
from zwidth.environment import OnePole, Wall, Window
from zwidth.environment.environment import Environment
from zwidth.environment.wall import wall_of
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
from zwidth.passivity.parameter_limits import has_stiffness, is_of_high_degree, provable, stiffness_of
from zwidth.quantity.exact import Exact
from zwidth.quantity.glossary import GLOSSARY
from zwidth.quantity.spoken import spoken
from zwidth.quantity.text import alike, in_words, readable

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
    that keeps it where it is: of values beside it nothing is proved or refuted.
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
    samples alone.
    """

    parameter: str
    current: float
    holds: Holds
    more: bool
    name: str
    likely: Likely = nowhere
    in_samples: bool = False


def advise(
    device: Device,
    environment: Environment,
    passive: bool,
    contact: bool = False,
    stiffest: Likely = nowhere,
) -> tuple[Advice, ...]:
    """Advice on every parameter of a certain loop.

    Parameters
    ----------
    device, environment
        The loop, without intervals.
    passive
        True to say how far each parameter may go, False for what to change.
    contact
        As for `provable`.
    stiffest
        Its `max_stiffness`, which is then not looked for twice.
    """
    kind: Literal["change", "slack"] = "slack" if passive else "change"
    is_high = is_of_high_degree(device, environment)
    grain = COARSER if is_high else COARSE
    knobs = list(_Knobs(device, environment, contact).every(stiffest))
    if is_high:  # to find where a limit is likely takes as long as to find it
        knobs = [replace(knob, likely=nowhere) for knob in knobs]
    found = [turn(knob, device.motion, kind, grain) for knob in knobs]
    wall = wall_of(environment)
    if not passive and wall is not None and wall.damping != 0:
        found.extend(_estimators(device, wall, contact, grain))
    return tuple(found)


@dataclass(frozen=True)
class _Knobs:
    """Those of a loop; `contact` as for `provable`."""

    device: Device
    environment: Environment
    contact: bool

    def every(self, stiffest: Likely) -> Iterator[Knob]:
        """All of them, from the device to the law."""
        period = self.device.exact("sample_period")
        delay = self.device.exact("delay")
        rate = self._searched("rate", 1 / period, self._device("rate"), True, "rate", float(period))
        yield replace(rate, in_samples=delay > 0 and self._in_samples)
        yield from self._losses()
        later = self._searched("delay", delay, self._device("delay"), False, "delay", float(period))
        yield replace(later, in_samples=self._in_samples)
        if has_stiffness(self.environment):
            now, change = stiffness_of(self.environment).fraction, self._law("stiffness")
            yield Knob("stiffness", float(now), self._proved(change, now), False, "stiffness", stiffest)
        if (wall := wall_of(self.environment)) is not None:
            yield from self._of_wall(wall)

    def _losses(self) -> Iterator[Knob]:
        """What takes energy out, and the encoder: of these it is known what a loop asks for."""
        decision, contact = decide(self.device, self.environment), self.contact
        of_one = replace(decision, setting=replace(decision.setting, resolution=Fraction(1)))
        for key, more, name, likely in (
            ("damping", True, "device damping", lambda: likely_damping(decision, contact)),
            ("coulomb_friction", True, "Coulomb friction", lambda: likely_friction(decision, contact)),
            ("resolution", False, "encoder resolution", lambda: likely_resolution(of_one, contact)),
        ):
            now = self.device.exact(key)
            yield Knob(key, float(now), self._proved(self._device(key), now), more, name, likely)

    def _of_wall(self, wall: Wall) -> Iterator[Knob]:
        b = wall.damping
        assert isinstance(b, Exact)
        law = self._law("damping", -1 if b < 0 else 1)
        usual = float(self.device.exact("damping")) or 1.0
        yield self._searched("virtual_damping", abs(b.fraction), law, False, "virtual damping", usual)
        tau = wall.velocity_filter.time_constant
        if isinstance(tau, Exact) and b != 0:
            change = self._filter(wall)
            yield self._searched("time_constant", tau.fraction, change, True, "filter time constant", 0.0)

    def time_constant(self, wall: Wall, begin: float) -> Knob:
        """Of a one-pole filter in the place of that of the wall [s]; looked for from `begin` on."""
        change = self._filter(wall)
        likely = partial(likely_value, change, self.contact, begin, begin, True)
        holds: Holds = lambda value: provable(change, value, self.contact)  # noqa: E731
        return Knob("time_constant", 0.0, holds, True, "time constant", likely)

    def _searched(self, key: str, now: Fraction, change: Change, more: bool, name: str, other: float) -> Knob:
        """A knob of which secants say where its limit is likely; `other` as for `likely_value`."""
        likely = partial(likely_value, change, self.contact, float(now), other, more)
        return Knob(key, float(now), self._proved(change, now), more, name, likely)

    def _device(self, key: str) -> Change:
        return lambda value: (self.device.replace(**{key: Exact(value)}), self.environment)

    def _law(self, key: str, sign: int = 1) -> Change:
        return lambda value: (self.device, self.environment.replace(**{key: Exact(sign * value)}))

    def _filter(self, wall: Wall) -> Change:
        return lambda value: (self.device, wall.replace(velocity_filter=OnePole(Exact(value))))

    def _proved(self, change: Change, now: Fraction) -> Holds:
        """Whether the loop with a value is proved passive; as it is, it is decided once for all knobs."""
        return lambda value: self._here if value == now else provable(change, value, self.contact)

    @cached_property
    def _in_samples(self) -> bool:
        """True where contact made and broken is proved, and with a delay half a sample longer never is."""
        decision = decide(self.device, self.environment)
        if decision.is_spring or not (self.contact or decision.is_clamped):
            return False
        longer = self.device.exact("delay") + self.device.exact("sample_period") / 2
        return decide(self.device.replace(delay=Exact(longer)), self.environment).contact_damping is None

    @cached_property
    def _here(self) -> bool:
        return provable(lambda _: (self.device, self.environment), Fraction(0), self.contact)


def turn(knob: Knob, motion: str, kind: Literal["change", "slack"], grain: int = COARSE) -> Advice:
    """How far a knob must be turned, or may be; `grain` as for `largest_holding`."""
    knob = replace(knob, holds=cache(knob.holds))  # at its limit, and for a shorter one, it is asked again
    to = None
    if knob.more or knob.current or kind == "slack":  # nothing is less than 0
        to = _last_proved(knob, grain)
    if kind == "change" and to is not None and not _is_change(knob, to):
        to = None
    unit = GLOSSARY[knob.parameter.rpartition(".")[2]].unit_for(motion)
    shown = None if to is None else outward(to, knob, spoken(unit)[0])
    is_alone = knob.in_samples and to == knob.current
    return Advice(knob.parameter, knob.current, to, unit, kind, _text(knob, shown, unit, kind), is_alone)


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
    """Four significant digits on the safe side, in the unit of which one in SI is `factor`, if proved too."""
    if value == 0 or isinf(value):
        return value
    told = value * factor
    scale = 10.0 ** (floor(log10(abs(told))) - 3)
    rounded = float(f"{(ceil(told / scale) if knob.more else floor(told / scale)) * scale:.4g}") / factor
    return rounded if knob.holds(Exact(rounded).fraction) else value


def _text(knob: Knob, to: float | None, unit: str, kind: str) -> str:
    now = readable(knob.current, unit)
    if kind == "change":
        if to is None:
            return f"no {'higher' if knob.more else 'lower'} {knob.name} was found that would do alone"
        verb = "raise" if knob.more else "lower"
        now, wanted = alike(unit, (knob.current, to), (4, 6))
        return f"{verb} the {knob.name} from {now} to {wanted}"
    if to is None or to == inf:
        return f"{knob.name} may take any value" if to == inf else f"{knob.name} has no slack"
    if to == knob.current and knob.in_samples:
        return f"{knob.name} is proved where it is, {now}, and for delays of whole samples alone"
    if to == knob.current:
        return f"{knob.name} is exactly at its limit, {now}"
    bound = "as low as" if knob.more else "up to"
    now, most = alike(unit, (knob.current, to), (4, 6))
    return f"{knob.name} may go {bound} {most} (now {now})"


def _estimators(device: Device, wall: Wall, contact: bool, grain: int) -> Iterator[Advice]:
    """Another velocity estimator that makes the loop passive, if one of the usual does."""
    now = wall.velocity_filter.describe()
    for samples in _WINDOWS:
        law = wall.replace(velocity_filter=Window(samples))
        if provable(lambda _, law=law: (device, law), Fraction(0), contact):  # type: ignore[misc]
            to = f"window of {samples} samples"
            text = f"estimate velocity with a {to} instead of the {now}"
            yield Advice("velocity_filter", now, to, "", "change", text)
            break
    if wall.velocity_filter.time_constant is None:
        knobs = _Knobs(device, wall, contact)
        period = float(device.exact("sample_period"))
        knob = knobs.time_constant(wall, period)
        tau = _first_scanned(knob, period, grain)
        if tau is not None:
            shown = outward(tau, knob)
            to = f"one-pole filter of {readable(shown, 's')}"
            text = f"estimate velocity with a {to} (time constant) instead of the {now}"
            yield Advice("velocity_filter", now, to, "", "change", text)


def _first_scanned(knob: Knob, period: float, grain: int) -> float | None:
    """The smallest time constant found, from one sample to a thousand."""
    for power in range(10):
        if knob.holds(Exact(period * 2**power).fraction):
            return smallest_holding(knob.holds, period * 2**power, grain, knob.likely())
    return None
