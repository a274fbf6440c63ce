"""What to change: the smallest change that makes an active loop passive, or the slack of a passive one.

Every value given was itself proved passive, all else as it was.
"""

from __future__ import annotations

from collections.abc import Iterable, Iterator
from dataclasses import dataclass
from fractions import Fraction
from math import ceil, floor, inf, isinf, log10
from typing import Literal

from zwidth.device import Device
from zwidth.environment import OnePole, Wall, Window
from zwidth.environment.environment import Environment
from zwidth.environment.wall import wall_of
from zwidth.passivity.linear.boundary import (
    COARSE,
    COARSER,
    SMALLEST,
    Holds,
    largest_holding,
    smallest_holding,
)
from zwidth.passivity.parameter_limits import Change, has_stiffness, is_of_high_degree, provable, stiffness_of
from zwidth.quantity.exact import Exact
from zwidth.quantity.glossary import GLOSSARY
from zwidth.quantity.spoken import spoken
from zwidth.quantity.text import in_words, readable

_NEVER_NOTHING = ("stiffness", "resolution", "link_delay")
"""What nobody can set to 0 and keep what it is there for."""

_WINDOWS = (2, 3, 4, 5, 6, 8, 10, 15, 20)

_EASIEST_FIRST = (
    "stiffness", "virtual_damping", "local_damping", "velocity_filter", "time_constant", "link_delay", "rate",
    "delay", "damping", "resolution", "coulomb_friction",
)  # fmt: skip
"""The law, then the loop, then the machine."""


@dataclass(frozen=True)
class Advice:
    """One parameter, where it is and where it may or must go, both in `unit`.

    `kind` is "change" for a loop that is not passive and "slack" for one that
    is; `to` is None where no value of this parameter alone would do, and inf
    ("any" as plain data) where it may have any value.
    """

    parameter: str
    current: float | str
    to: float | str | None
    unit: str
    kind: Literal["change", "slack"]
    text: str

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
    return InLines(
        "slack" if passive else "what to change, any one of",
        tuple(item.text for item in ordered if item.to is not None and item not in at_limit),
        f"exactly at the limit: {_names(at_limit)}" if at_limit else "",
        f"{'no slack' if passive else 'no change alone would do'}: {_names(useless)}" if useless else "",
    )


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

    `parameter` is a name of the glossary, behind "leader." or "follower." where it is of one arm.
    """

    parameter: str
    current: float
    holds: Holds
    more: bool
    name: str


def advise(
    device: Device, environment: Environment, passive: bool, contact: bool = False
) -> tuple[Advice, ...]:
    """Advice on every parameter of a certain loop; `contact` as for `provable`."""
    kind: Literal["change", "slack"] = "slack" if passive else "change"
    grain = COARSER if is_of_high_degree(device, environment) else COARSE
    knobs = _knobs(device, environment, contact)
    found = [turn(knob, device.motion, kind, grain) for knob in knobs]
    wall = wall_of(environment)
    if not passive and wall is not None and wall.damping != 0:
        found.extend(_estimators(device, wall, contact))
    return tuple(found)


def _knobs(device: Device, environment: Environment, contact: bool) -> Iterator[Knob]:
    def on_device(key: str) -> Holds:
        return _proved(lambda value: (device.replace(**{key: Exact(value)}), environment), contact)

    rate = _proved(lambda value: (device.replace(rate=Exact(value)), environment), contact)
    yield Knob("rate", float(device.exact("sample_period") ** -1), rate, True, "rate")
    for key, more in (("damping", True), ("coulomb_friction", True), ("resolution", False), ("delay", False)):
        name = {"damping": "device damping", "resolution": "encoder resolution"}.get(key, in_words(key))
        yield Knob(key, float(device.exact(key)), on_device(key), more, name)
    if has_stiffness(environment):
        now = float(stiffness_of(environment))
        change: Change = lambda k: (device, environment.replace(stiffness=Exact(k)))  # noqa: E731
        yield Knob("stiffness", now, _proved(change, contact), False, "stiffness")
    if (wall := wall_of(environment)) is not None:
        b = wall.damping
        assert isinstance(b, Exact)
        sign = -1 if b < 0 else 1
        law: Change = lambda v: (device, environment.replace(damping=Exact(sign * v)))  # noqa: E731
        yield Knob("virtual_damping", abs(float(b)), _proved(law, contact), False, "virtual damping")
        yield from _time_constant(device, wall, contact)


def _proved(change: Change, contact: bool) -> Holds:
    """Whether the loop with a value is proved passive; `contact` as for `provable`."""
    return lambda value: provable(change, value, contact)


def _time_constant(device: Device, wall: Wall, contact: bool) -> Iterator[Knob]:
    now = wall.velocity_filter.time_constant
    if isinstance(now, Exact) and wall.damping != 0:
        change: Change = lambda t: (device, wall.replace(velocity_filter=OnePole(Exact(t))))  # noqa: E731
        yield Knob("time_constant", float(now), _proved(change, contact), True, "filter time constant")


def turn(knob: Knob, motion: str, kind: Literal["change", "slack"], grain: int = COARSE) -> Advice:
    """How far a knob must be turned, or may be; `grain` as for `largest_holding`."""
    search = smallest_holding if knob.more else largest_holding
    to = search(knob.holds, knob.current or 1e-4, grain)
    if to is not None and SMALLEST < to < inf:
        to = _simplest_near(to, knob.holds, knob.more, grain)
    if knob.more and to is not None and to <= SMALLEST:
        to = inf if knob.parameter == "rate" else 0.0
    if kind == "change" and to is not None and not _is_change(knob, to):
        to = None
    unit = GLOSSARY[knob.parameter.rpartition(".")[2]].unit_for(motion)
    shown = None if to is None else outward(to, knob, spoken(unit)[0])
    return Advice(knob.parameter, knob.current, to, unit, kind, _text(knob, shown, unit, kind))


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
            return f"no value of {knob.name} alone would do"
        verb = "raise" if knob.more else "lower"
        return f"{verb} the {knob.name} from {now} to {readable(to, unit, 6)}"
    if to is None or to == inf:
        return f"{knob.name} may take any value" if to == inf else f"{knob.name} has no slack"
    if to == knob.current:
        return f"{knob.name} is exactly at its limit, {now}"
    bound = "as low as" if knob.more else "up to"
    return f"{knob.name} may go {bound} {readable(to, unit, 6)} (now {now})"


def _estimators(device: Device, wall: Wall, contact: bool) -> Iterator[Advice]:
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
        change: Change = lambda t: (device, wall.replace(velocity_filter=OnePole(Exact(t))))  # noqa: E731
        knob = Knob("time_constant", 0.0, _proved(change, contact), True, "time constant")
        tau = _first_scanned(knob, device)
        if tau is not None:
            shown = outward(tau, knob)
            to = f"one-pole filter of {readable(shown, 's')}"
            text = f"estimate velocity with a {to} (time constant) instead of the {now}"
            yield Advice("velocity_filter", now, to, "", "change", text)


def _first_scanned(knob: Knob, device: Device) -> float | None:
    """The smallest time constant found, from one sample to a thousand."""
    period = float(device.exact("sample_period"))
    for power in range(10):
        if knob.holds(Exact(period * 2**power).fraction):
            return smallest_holding(knob.holds, period * 2**power)
    return None
