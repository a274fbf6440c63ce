"""An identified device as the [device] table of a specification, each number with where it comes from.

    damping = [0.147324, 0.154487]  # N·s/m: 0.1509 identified, 99 % interval

Ends of intervals are rounded outwards, to six digits: what is proved for the file is proved for
the interval.  Numbers of the log itself are written in full.
"""

from __future__ import annotations

from decimal import ROUND_CEILING, ROUND_FLOOR, ROUND_HALF_EVEN, Context
from fractions import Fraction
from typing import TYPE_CHECKING

from zwidth.data.identification.device.limits import percent
from zwidth.data.identification.device.table import BOTH_SIDES, source_name
from zwidth.model.device.device import Device
from zwidth.model.specification.write import toml
from zwidth.quantity.exact import Exact, Interval, ends
from zwidth.quantity.text import as_decimal, quantity_unit

if TYPE_CHECKING:
    from zwidth.data.identification.device.numbers import IdentifiedNumbers

DIGITS = 6
"""Significant digits of an identified number."""


def to_toml(identified: IdentifiedNumbers, device: Device, confidence: float | None) -> str:
    """The text of the file, see `Identified.to_toml`."""
    lines = [f"# {line}" for line in _story(identified, confidence)]
    lines += ["", "[device]", f"name = {toml(device.name)}", f'motion = "{device.motion}"']
    for key, value in device.parameters().items():
        if key not in device.assumed:
            name = "inertia" if key == "mass" and device.motion == "rotary" else key
            shown = _value(value, key in identified.estimates)
            if key == "friction_speed":
                shown = _rounded(ends(value)[0], ROUND_FLOOR)  # no farther than was seen
            lines.append(f"{name} = {shown}  # {_origin(identified, key, device.motion, confidence)}")
    return "\n".join(lines) + "\n"


def _story(identified: IdentifiedNumbers, confidence: float | None) -> list[str]:
    milliseconds = 1e3 * identified.pulse_length
    story = [
        f"Identified from {source_name(identified)}: {identified.strokes} strokes, {identified.pulses} means "
        f"over {milliseconds:.3g} ms, r² = {identified.explained:.4f}.",
        "m ẍ + b ẋ + f_c sgn ẋ = f_h − f_a, in means over smooth pulses inside strokes.",
        f"{BOTH_SIDES}.",
    ]
    story += [
        f"{finding}" for finding in identified.findings if finding.kind in ("wrong model", "bent friction")
    ]
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
