"""An identified device written down: a table, a document, a [device] of a specification, what it allows."""

from __future__ import annotations

from collections.abc import Callable, Iterable
from decimal import ROUND_CEILING, ROUND_FLOOR, ROUND_HALF_EVEN, Context
from fractions import Fraction
from math import inf
from pathlib import Path
from typing import TYPE_CHECKING, Any, NamedTuple

import numpy as np

from zwidth.model.device.device import Device
from zwidth.model.device.transmission import Transmission
from zwidth.model.specification.write import toml
from zwidth.quantity.answered import data_of
from zwidth.quantity.exact import Exact, Interval, ends
from zwidth.quantity.glossary import GLOSSARY, unit_suffix
from zwidth.quantity.parameter import parameters_of
from zwidth.quantity.spoken import spoken
from zwidth.quantity.text import as_decimal, in_a_table, quantity_unit, shown, told_quantity, unit_text
from zwidth.showing import Lines, Part, Table, one_line

if TYPE_CHECKING:
    from zwidth.data.identification.device.estimate import Estimate
    from zwidth.data.identification.device.numbers import IdentifiedNumbers

SYMBOLS = {
    "mass": "m",
    "damping": "b",
    "coulomb_friction": "f_c",
    "slow": "f_s",
    "spring": "k",
    "force_lag": "τ_f",
}
"""Of what may have been identified, in this order."""

NAMES = {
    "mass": "mass",
    "damping": "damping",
    "coulomb_friction": "Coulomb friction",
    "slow": "more friction at rest",
    "spring": "a spring, or gravity on an arc",
    "force_lag": "force recorded late by",
    "2b/T": "wall by damping",
    "2f_c/Δ": "wall by Coulomb friction",
}

BOTH_SIDES = (
    "m, b and f_c are the sum of both sides of a cable, belt or gear; where the motor swings on it only its "
    "own side pays (a shaken log shows it)"
)
"""What is taken for granted of every device: motor, encoder and hand move as one."""


_BETWEEN = parameters_of(Transmission)


EACH_SIDE = (
    "m, b and f_c are those of the motor's side; a wall rests on b + c b₂/(c + b₂), for every stiffness of "
    "the cable and every mass behind it"
)
"""What is said instead where the log shows that they do not."""

OF_WALLS = (
    "intervals of m, b and f_c are of the mean of both ways; that of a wall begins at the least friction, "
    "either way and at any speed seen"
)
"""Which interval is of what."""


def assumed(identified: IdentifiedNumbers) -> str:
    """Whose numbers these are."""
    return BOTH_SIDES if identified.cable is None else EACH_SIDE


class Row(NamedTuple):
    """A number as people read it."""

    symbol: str
    name: str
    value: str
    interval: str
    unit: str


def named(key: str, motion: str) -> str:
    """A parameter as people call it: of what turns the mass is an inertia."""
    return "inertia" if key == "mass" and motion == "rotary" else NAMES[key]


def rows(identified: IdentifiedNumbers, confidence: float = 0.95) -> list[Row]:
    def of(symbol: str, name: str, estimate: Estimate) -> Row:
        return _row(symbol, name, estimate.value, estimate.interval(confidence), estimate.unit)

    table = []
    if identified.mass is not None:
        unit = quantity_unit("mass", identified.motion)
        table.append(Row("m", named("mass", identified.motion), f"{identified.mass:.4g}", "as given", unit))
    for key, symbol in SYMBOLS.items():
        if key in identified.estimates:
            table.append(of(symbol, named(key, identified.motion), identified.estimates[key]))
        if key == "damping" and identified.shows("damping by direction"):
            for name in ("inward", "outward"):
                table.append(of("b", f"  {name}", getattr(identified.directions, name)))
    if identified.cable is not None:
        for key, estimate in identified.cable.between.items():
            symbol, name = _BETWEEN[key].quantity.symbol, key.replace("_", " ").replace("coulomb", "Coulomb")
            table.append(of(symbol, name if key.startswith("handle") else f"{name} of the cable", estimate))
    stiffness = GLOSSARY["stiffness"].unit_for(identified.motion)
    for limit in limits(identified):
        within = limit.interval(confidence)
        table.append(_row(limit.symbol, NAMES[limit.symbol], limit.value, within, stiffness))
    return table


def facts(identified: IdentifiedNumbers) -> str:
    noise, offset = (
        told_quantity(value, "force", identified.motion, 3)
        for value in (identified.force_noise, identified.offset)
    )
    inward = told_quantity(identified.fastest[0], "friction_speed", identified.motion, 3)
    outward = told_quantity(identified.fastest[1], "friction_speed", identified.motion, 3)
    return (
        f"r² = {identified.explained:.4f}, noise {noise} per sample, offset {offset}; "
        f"{identified.strokes} strokes, {identified.pulses} means over "
        f"{shown(identified.pulse_length, 's', 3)}; T = {shown(identified.sample_period, 's', 6)}, "
        f"Δ = {told_quantity(identified.resolution, 'position', identified.motion)}\n"
        f"friction seen up to {inward} into the wall, {outward} out of it"
    )


def title(identified: IdentifiedNumbers) -> str:
    return f"device identified from {source_name(identified)}"


def source_name(identified: IdentifiedNumbers) -> str:
    return one_line(Path(identified.source).name or identified.source)


def report(identified: IdentifiedNumbers, confidence: float = 0.95) -> Iterable[Part]:
    """The table, what it rests on, and what was found besides."""
    heads = [("", "", "best guess", percent(confidence), "")]
    yield Table(caption=title(identified), heads=heads, rows=rows(identified, confidence))
    yield ""
    yield facts(identified)
    yield assumed(identified)
    yield OF_WALLS
    if identified.findings:
        yield Lines(identified.findings)


def _row(symbol: str, name: str, value: float, ends: tuple[float, float], unit: str) -> Row:
    factor, told = spoken(unit)
    interval = " … ".join(in_a_table(factor * end) for end in ends)
    return Row(symbol, name, in_a_table(factor * value), interval, unit_text(told))


FORMAT = "zwidth identification 1"

_QUANTITY = {"spring": "stiffness", "force_lag": "delay", "slow": "coulomb_friction"}
"""Whose unit is meant, where the name is not in the glossary."""


def to_dict(identified: IdentifiedNumbers, confidence: float) -> dict[str, Any]:

    def key(name: str, quantity: str | None = None) -> str:
        unit = GLOSSARY[quantity or _QUANTITY.get(name, name)].unit_for(identified.motion)
        return f"{name}_{unit_suffix(unit)}"

    document: dict[str, Any] = {
        "format": FORMAT,
        "confidence": confidence,
        **data_of(identified),
        "advice": list(advice(identified, confidence)),
        "assumptions": [assumed(identified)],
    }
    for name, estimate in identified.estimates.items():
        document[key(name)] = _estimate(estimate, confidence)
    if identified.cable is not None:
        document["transmission"] = {
            f"{name}_{unit_suffix(_BETWEEN[name].unit_for(identified.motion))}": _estimate(each, confidence)
            for name, each in identified.cable.between.items()
        }
    for name in ("inward", "outward"):
        estimate = getattr(identified.directions, name)
        document[key(f"damping_{name}", "damping")] = _estimate(estimate, confidence)
    for name, speed in zip(("inward", "outward"), identified.fastest, strict=True):
        document[key(f"seen_{name}", "friction_speed")] = speed
    for name in ("inward", "outward"):
        estimate = getattr(identified.slopes, name)
        document[key(f"slope_{name}", "damping")] = _estimate(estimate, confidence)
    for limit in limits(identified):
        low, high = limit.interval(confidence)
        document[key(f"stiffest_by_{limit.parameter}", "stiffness")] = {
            "value": limit.value,
            "interval": [low, high],
        }
    return document


def _estimate(estimate: Estimate, confidence: float) -> dict[str, Any]:
    return {
        "value": estimate.value,
        "standard_error": estimate.error,
        "shift": estimate.shift,
        "degrees_of_freedom": estimate.degrees,
        "interval": list(estimate.interval(confidence)),
    }


# An identified device as the [device] table of a specification, each number with where it comes from.
#
#     damping = [0.147324, 0.154487]  # N·s/m: 0.1509 identified, 99 % interval
#
# Ends of intervals are rounded outwards, to six digits: what is proved for the file is proved for the
# interval.  Numbers of the log itself are written in full.

DIGITS = 6
"""Significant digits of an identified number."""


def to_toml(identified: IdentifiedNumbers, device: Device, confidence: float | None) -> str:
    lines = [f"# {line}" for line in _story(identified, confidence)]
    lines += ["", "[device]", f"name = {toml(device.name)}", f'motion = "{device.motion}"']
    for key, value in device.parameters().items():
        if key not in device.assumed:
            name = "inertia" if key == "mass" and device.motion == "rotary" else key
            shown = _value(value, key in identified.estimates)
            if key == "friction_speed":
                shown = _rounded(ends(value)[0], ROUND_FLOOR)  # no farther than was seen
            lines.append(f"{name} = {shown}  # {_origin(identified, key, device.motion, confidence)}")
    if device.transmission is not None:
        lines += ["", "[device.transmission]"]
        for key, value in device.transmission.parameters().items():
            unit = unit_text(_BETWEEN[key].unit_for(device.motion))
            lines.append(f"{key} = {_value(value, True)}  # {unit}: identified, as the numbers above")
    return "\n".join(lines) + "\n"


def _story(identified: IdentifiedNumbers, confidence: float | None) -> list[str]:
    story = [
        f"Identified from {source_name(identified)}: {identified.strokes} strokes, {identified.pulses} means "
        f"over {shown(identified.pulse_length, 's', 3)}, r² = {identified.explained:.4f}.",
        "m ẍ + b ẋ + f_c sgn ẋ = f_h − f_a, in means over smooth pulses inside strokes.",
        f"{assumed(identified)}.",
    ]
    story += [
        f"{finding}" for finding in identified.findings if finding.kind in ("wrong model", "bent friction")
    ]
    if confidence is not None:
        story += [f"{name} may be 0: {why}." for name, why in perhaps_zero(identified, confidence).items()]
    if confidence is None:
        return [*story, "Best guesses: what is proved of them is not proved of the device."]
    return [
        *story,
        f"Lower ends of damping and Coulomb friction: both together with {percent(confidence)} confidence.",
    ]


def _origin(identified: IdentifiedNumbers, key: str, motion: str, confidence: float | None) -> str:
    unit = quantity_unit(key, motion)
    if key in identified.estimates:
        best = f"{unit}: {identified.estimates[key].value:.4g} identified"
        return best if confidence is None else f"{best}, {percent(confidence)} interval"
    if key in ("sample_period", "resolution"):
        return f"{unit}: of the log"
    if key == "friction_speed":
        return f"{unit}: the fastest motion seen in both directions; beyond it b and f_c are assumed"
    return f"{unit}: as given"


def _value(value: Exact | Interval, identified: bool) -> str:
    if isinstance(value, Interval):
        low = _rounded(value.low.fraction, ROUND_FLOOR)
        return f"[{low}, {_rounded(value.high.fraction, ROUND_CEILING)}]"
    if identified:
        return _rounded(value.fraction, ROUND_HALF_EVEN)
    written = as_decimal(value.fraction)
    if written is None:
        return toml(f"{value.fraction.numerator}/{value.fraction.denominator}")
    return _plain(float(written))


def _rounded(value: Fraction, rounding: str) -> str:
    number = Context(prec=DIGITS, rounding=rounding)
    return _plain(float(number.divide(value.numerator, value.denominator)))


def _plain(number: float) -> str:
    """As TOML writes a float: with a point, or an exponent."""
    return repr(number + 0.0)


# What identified numbers allow a spring wall: K ≤ 2 b/T, and at rest K ≤ 2 f_c/Δ (Abbott & Okamura 2005,
# equations 21 and 25).  Both are linear in what was identified: their intervals are those of b and f_c, times
# 2/T and 2/Δ.

NARROW = 3.0
"""Ratio of quick to slow speeds (upper to lower tenth) below which b and f_c are hard to tell apart."""


class Limit(NamedTuple):
    parameter: str
    """"damping" or "coulomb_friction"."""
    symbol: str
    """2b/T or 2f_c/Δ."""
    factor: float
    """By which the parameter becomes a stiffness; inf where Δ is 0."""
    estimate: Estimate
    best: float
    """The best guess of what counts of it [N·s/m, N; N·m·s/rad, N·m]."""
    least: Callable[[float], float]
    """What it is at least, with a confidence."""

    @property
    def value(self) -> float:
        """The best guess [N/m; N·m/rad]."""
        return self.factor * self.best

    def interval(self, confidence: float) -> tuple[float, float]:
        """Where the truth is, this often; what is negative allows no stiffness [N/m; N·m/rad]."""
        low, high = self.least(confidence), self.estimate.interval(confidence)[1]
        return self.factor * low, self.factor * max(high, low)


def limits(identified: IdentifiedNumbers) -> tuple[Limit, ...]:
    """Both bounds, where the parameters were identified and the encoder has a step."""
    found = []
    if "damping" in identified.estimates:
        factor = 2 / identified.sample_period
        estimate, best = identified.estimates["damping"], identified.best_damping()
        if identified.cable is not None:
            estimate = identified.cable.damping
        found.append(Limit("damping", "2b/T", factor, estimate, best, identified.least_damping))
    if "coulomb_friction" in identified.estimates and identified.resolution > 0:
        factor = 2 / identified.resolution
        estimate, least = identified.estimates["coulomb_friction"], identified.least_coulomb_friction
        found.append(Limit("coulomb_friction", "2f_c/Δ", factor, estimate, estimate.value, least))
    return tuple(found)


def perhaps_zero(identified: IdentifiedNumbers, confidence: float) -> dict[str, str]:
    """Which of damping and Coulomb friction may be 0 for a wall at this confidence, and why, in words."""
    return {
        NAMES[limit.parameter]: _why_zero(identified, limit, confidence)
        for limit in limits(identified)
        if limit.least(confidence) <= 0
    }


def _why_zero(identified: IdentifiedNumbers, limit: Limit, confidence: float) -> str:
    """By the lowest of what a wall rests on: the number itself, one direction, the slope at the end."""
    at = f"at {told_quantity(identified.speed, 'friction_speed', identified.motion, 3)}"
    ways = {"into the wall": "inward", "out of the wall": "outward"}
    known = [("it", limit.estimate, "a longer log")]
    for way, name in ways.items() if limit.parameter == "damping" and identified.cable is None else ():
        known.append((f"that {way}", getattr(identified.directions, name), f"more strokes {way}"))
        slope = getattr(identified.slopes, name)
        known.append((f"the slope of friction {at} {way}", slope, f"more strokes {way} {at}"))
    what, estimate, more = min(known, key=lambda each: each[1].interval(confidence)[0])
    low, high = estimate.interval(confidence)
    if low > 0:
        return "lower bounds of friction by speed leave none above the damping; slower strokes would tell"
    known_to = shown(Interval(low, high), estimate.unit, 2)
    return f"{what} is known only to {known_to}, {percent(confidence)}; {more} would tell"


def advice(identified: IdentifiedNumbers, confidence: float) -> tuple[str, ...]:
    """Which number limits the stiffest wall, and how to know it better."""
    if identified.shows("wrong model"):
        if identified.cable is not None:
            return ("log once more, nobody at the handle, the motor shaking it harder, and quicker",)
        return ("fit Coulomb friction too: these numbers are of another model than the device",)
    found = limits(identified)
    binding = min(found, key=lambda limit: limit.interval(confidence)[0])
    name = NAMES[binding.parameter]
    least = told_quantity(binding.interval(confidence)[0], "stiffness", identified.motion, 4)
    lines = [f"{name} limits the wall: {binding.symbol} ≥ {least} at {percent(confidence)}"]
    longer, why = _times_longer(binding.estimate, confidence), perhaps_zero(identified, confidence)
    if name in why:
        lines.append(f"{name} may be 0 for a wall: {why[name]}")
    elif longer < inf:
        lines.append(
            f"a log {longer:.2g} times as long would halve the interval of {name}, "
            "which narrows as 1/√duration"
        )
    else:
        lines.append(
            f"a longer log would not halve the interval of {name}: half of it and more is what means over "
            f"{shown(identified.pulse_length, 's', 3)} may be off; smoother, longer strokes allow longer ones"
        )
    unit = GLOSSARY["friction_speed"].unit_for(identified.motion)
    inward, outward = (shown(fast, unit, 3) for fast in identified.fastest)
    lines.append(
        f"friction was seen up to {inward} into the wall and {outward} out of it; at higher "
        "speeds it is not known: log quicker strokes, zwidth plan --speed says which"
    )
    slow, quick = np.quantile(np.abs(identified.seen["speed"].values), [0.1, 0.9])
    if quick < NARROW * slow:
        lines.append(
            f"most of the motion is between {shown(slow, unit, 2)} and {shown(quick, unit, 2)}: slower and "
            "quicker strokes tell damping and Coulomb friction apart"
        )
    return tuple(lines)


def percent(confidence: float) -> str:
    """0.99 as "99 %", never more than it is."""
    return shown(int(confidence * 1e6 + 1e-6) / 1e6, "%", 6)


def _times_longer(estimate: Estimate, confidence: float) -> float:
    """n for which reach/√n + shift is half of what reach + shift is."""
    _, high = estimate.interval(confidence)
    whole = high - estimate.value
    rest = whole / 2 - estimate.shift
    return float(((whole - estimate.shift) / rest) ** 2) if rest > 0 else inf
