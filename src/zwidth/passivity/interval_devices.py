"""A device of the catalogue of which some numbers are known within stated ranges only.

A verdict on its intervals is a verdict on every device in the ranges: more damping and Coulomb friction
never hurt, a finer encoder never does, and where period, delay or law are intervals their corners are
proved to decide (`corners`).  Beside it stands here what a person asks next: how stiff a wall may be for
every device in the ranges and for the most favourable one, and which number to measure first.  Every
stiffness and every value said to be enough was itself proved, on the rest of the ranges as intervals.
"""

from __future__ import annotations

from collections.abc import Iterator, Mapping
from dataclasses import dataclass, replace
from fractions import Fraction
from math import inf, isfinite
from typing import Any, NamedTuple

from zwidth.errors import InputError
from zwidth.model.device import Device
from zwidth.model.device.catalogue import DeviceInRange, Range
from zwidth.model.environment.environment import Environment
from zwidth.passivity.advice import digits_of
from zwidth.passivity.check import check_by_closed_forms
from zwidth.passivity.corners import Loop
from zwidth.passivity.linear.boundary import COARSER, largest_holding
from zwidth.passivity.parameter_limits import has_stiffness, provable, stiffness_of
from zwidth.passivity.scope import unit_key
from zwidth.passivity.transmission import seen_at_motor
from zwidth.passivity.verdict import Verdict
from zwidth.quantity.answered import answered, data_of, known
from zwidth.quantity.exact import Exact, Interval, ends
from zwidth.quantity.glossary import GLOSSARY
from zwidth.quantity.spoken import spoken
from zwidth.quantity.text import in_words, outward_decimal, shown, told_quantity

_BETTER = {"damping": 1, "coulomb_friction": 1, "resolution": 0, "sample_period": 0, "delay": 0}
"""Of what a verdict depends on: which end, low or high, asks for less."""

_RATE = "rate"


class Measure(NamedTuple):
    """The number to measure first."""

    key: str  # a parameter of the device
    # from here on, to the better end of its range, the loop is passive for every device in the other ranges,
    # in SI; None where no part of its range is proved to be enough
    enough: float | None
    times: float  # how many times the largest stiffness grows over its range; inf from none at all


@dataclass(frozen=True, kw_only=True)
class OverRanges:
    """What holds over the ranges of a device."""

    _BESIDES = (
        ("stated", "of each number, with its unit in the key: `low`, `high`, and `why` this range"),
        (
            "measure_first",
            "null, or `parameter`; `enough`, from which value on it alone settles the question, null "
            "where none does; `times_the_stiffness`, how many times the largest stiffness grows over "
            "its range, null where from 0",
        ),
    )

    name: str = known("of the device")
    ranges: Mapping[str, Range] = known("what is stated, by parameter of the device")
    motion: str = known('"linear" or "rotary"')
    every: float | None = answered(
        "a stiffness up to which a wall is proved passive for every device in the ranges, all else as asked; "
        "0 where none is, null where the law has no stiffness or any is passive",
        key="passive_for_every_device_stiffness",
        quantity="stiffness",
        finite=True,
    )
    best: float | None = answered(
        "the same for the most favourable device",
        key="passive_for_the_best_device_stiffness",
        quantity="stiffness",
        finite=True,
    )
    first: Measure | None = known(
        "what to measure first; None where nothing is left to know, or it cannot be told"
    )

    def rows(self) -> Iterator[tuple[str, str]]:
        """What holds for every device, what to measure first, what is stated."""
        if self.every is not None and self.best is not None:
            yield "stiffness", self._stiffness()
        if self.first is not None:
            yield "measure first", self._first(self.first)
        yield (
            "ranges",
            f"{self.stated()}; stated, not measured: zwidth devices {self.name} says why; below are the "
            "numbers of the worst corner",
        )

    def stated(self) -> str:
        """The ranges, in a line."""
        return ", ".join(_told(key, own) for key, own in self.ranges.items())

    def why(self) -> Iterator[str]:
        """Each range, and why it is stated."""
        yield from (f"{_told(key, own)}: {own.why}" for key, own in self.ranges.items())

    def to_dict(self) -> dict[str, Any]:
        """It as plain data, a unit in every key of a physical quantity."""
        ranges = {
            unit_key(_key(key, own), self.motion): {"low": own.low, "high": own.high, "why": own.why}
            for key, own in self.ranges.items()
        }
        first = None
        if self.first is not None:
            enough = {unit_key(self.first.key, self.motion): self.first.enough}
            times = self.first.times if isfinite(self.first.times) else None
            first = {"parameter": self.first.key, "enough": enough, "times_the_stiffness": times}
        return {"stated": ranges, **data_of(self), "measure_first": first}

    def _stiffness(self) -> str:
        assert self.every is not None
        assert self.best is not None
        every, best = (_stiffness(value, self.motion) for value in (self.every, self.best))
        return f"passive for every device in the ranges: {every}; for the most favourable: {best}"

    def _first(self, first: Measure) -> str:
        name = _named(first.key, self.ranges[first.key])
        if first.enough is not None:
            side = "at least" if _BETTER[first.key] or name == _RATE else "at most"
            unit = GLOSSARY[_key(first.key, self.ranges[first.key])].unit_for(self.motion)
            value = 1 / first.enough if name == _RATE else first.enough
            enough = shown(value, unit, digits_of(value, unit))
            return f"{name}: if it is {side} {enough}, this is passive for every device in the other ranges"
        grows = "from none" if first.times == inf else f"{first.times:.2g} times"
        return f"{name}: over its range the largest stiffness grows {grows}, more than over any other"


def _key(key: str, own: Range) -> str:
    """What the range is of: of a period it is stated as a rate."""
    return _RATE if own.unit == "Hz" else key


def _named(key: str, own: Range) -> str:
    return in_words(_key(key, own))


def _told(key: str, own: Range) -> str:
    return f"{_named(key, own)} {shown(own.interval, own.unit)}"


def _stiffness(value: float, motion: str) -> str:
    if value == inf:
        return "any"
    return f"up to {told_quantity(value, 'stiffness', motion)}" if value else "none is proved"


def over_ranges(found: DeviceInRange, law: Environment, verdict: Verdict) -> OverRanges:
    """What holds for every device in the ranges, for the most favourable, and what to measure first.

    `found`: the device, with its ranges; `law`: what is rendered; `verdict`: what `check` says of both.
    """
    device, keys, of_box = found.device, [key for key in found.ranges if key in _BETTER], verdict
    said = OverRanges(
        name=device.name, ranges=found.ranges, motion=device.motion, every=None, best=None, first=None
    )
    if not (law.has_transfer_function and law.is_certain and has_stiffness(law)):
        return said
    if device.transmission is not None:
        if device.transmission.encoder != "motor":
            return said
        device = seen_at_motor(device)
        of_box = check_by_closed_forms(device, law)
    favourable = _at_end(device, keys, better=True)
    every = _proved_up_to(device, law, of_box)
    best = _proved_up_to(favourable, law, check_by_closed_forms(favourable, law))
    first = None if verdict.outcome in ("passive", "active") else _first(device, keys, law, of_box)
    return replace(said, every=every, best=best, first=first)


def _at_end(device: Device, keys: list[str], better: bool) -> Device:
    """The device with one end of these parameters, the one that asks for less, or the other."""
    chosen = {
        key: Exact(ends(getattr(device, key))[_BETTER[key] if better else 1 - _BETTER[key]]) for key in keys
    }
    return device.replace(**chosen) if chosen else device


def _proved_up_to(device: Device, law: Environment, verdict: Verdict) -> float:
    """A stiffness that `check` proves for the whole box of parameters, near the largest; 0 for none.

    It is the one of the verdict's advice, where that is of contact made and broken.
    """
    told = _advised(verdict, "stiffness")
    if told and isfinite(told) and _is_passive(device, law.replace(stiffness=Exact(told))):
        return told
    largest = _largest(device, law)
    if largest in (0.0, inf):
        return largest
    factor = spoken(GLOSSARY["stiffness"].unit_for(device.motion))[0]
    for digits in (3, 2):
        rounded = outward_decimal(largest * factor, False, digits) / factor
        if rounded > 0 and _is_passive(device, law.replace(stiffness=Exact(f"{rounded:.15g}"))):
            return rounded
    return 0.0


def _is_passive(device: Device, law: Environment) -> bool:
    """Whether every device in the box is, contact made and broken; what cannot be decided is not."""
    try:
        return check_by_closed_forms(device, law).outcome == "passive"
    except InputError:
        return False


def _largest(device: Device, law: Environment) -> float:
    """The largest stiffness that holds at all corners, to a part in a thousand; 0 for none."""

    def at(k: Fraction) -> Loop:
        return device, law.replace(stiffness=Exact(k))

    now = float(stiffness_of(law)) or 1.0
    return largest_holding(lambda k: provable(at, k, contact=True), now, COARSER) or 0.0


def _first(device: Device, keys: list[str], law: Environment, verdict: Verdict) -> Measure | None:
    """The parameter that moves the answer most, the others at their worst; else the others at their best."""
    if not keys:
        return None
    worst, best = _largest(device, law), _largest(_at_end(device, keys, better=True), law)
    told_apart = []
    for key in keys:
        others = [other for other in keys if other != key]
        alone = _largest(_at_end(device, [key], better=True), law)
        kept_back = _largest(_at_end(_at_end(device, [key], better=False), others, better=True), law)
        told_apart.append((_ratio(alone, worst), _ratio(best, kept_back), key))
    gains, loses, key = max(told_apart)
    if gains <= 1.001 and loses <= 1.001:
        return None
    settled = {other: value for other in keys if (value := _enough(device, other, law, verdict)) is not None}
    if key not in settled and settled:
        key = next(iter(settled))
    return Measure(key, settled.get(key), gains if gains > 1.001 else loses)


def _ratio(more: float, less: float) -> float:
    return 1.0 if more == less else inf if less == 0 else more / less


def _enough(device: Device, key: str, law: Environment, verdict: Verdict) -> float | None:
    """From where on one parameter alone makes the loop passive, to the better end of its range; proved.

    It is what the advice of the verdict says, in the same digits.
    """
    low, high = ends(getattr(device, key))
    told = _advised(verdict, _RATE if key == "sample_period" else key)
    if not told:
        return None
    value = Exact(1 / Exact(told).fraction if key == "sample_period" else told)
    if not low <= value <= high:
        return None
    part = Interval(value, Exact(high)) if _BETTER[key] else Interval(Exact(low), value)
    return float(value) if _is_passive(device.replace(**{key: part}), law) else None


def _advised(verdict: Verdict, parameter: str) -> float | None:
    """What the advice of a verdict says of a parameter, all else within its range."""
    return next((advice.told for advice in verdict.advice if advice.parameter == parameter), None)
