"""One count of an encoder, as data sheets say it: counts, lines, bits, or an angle or a length."""

from __future__ import annotations

import re

from zwidth.cli.asking.numbers import need_unit, understood
from zwidth.cli.asking.written import Row
from zwidth.errors import InputError
from zwidth.model.device import Device
from zwidth.model.device.rotary import rotary
from zwidth.quantity.units import parse_number

LINES = 4
"""Counts that quadrature decoding makes of one line."""

_LARGEST_BITS = 40

_COUNTED = re.compile(
    r"(?P<number>2\s*(\^|\*\*)\s*(?P<power>[0-9]{1,2})|[^a-z°^]+?)\s*"
    r"(?P<unit>counts?|steps?|cpr|lines?|ppr|bits?)?(\s*(/|per)\s*(turn|rev(olution)?))?",
    re.IGNORECASE,
)

_GEARED = re.compile(r"(?P<encoder>.+?)\s*(?:[x×]|\btimes\b)\s*(?P<ratio>[0-9.]+)\s*", re.IGNORECASE)
"""An encoder on the motor, and the turns of the motor in one of the handle."""


def read_encoder(answer: str, motion: str) -> Row:
    """The row of the file that says the size of one count."""
    if motion == "linear":
        if re.search(r"count|step|cpr|line|ppr|bit|\^", answer, re.IGNORECASE):
            raise InputError(
                f'of a device that slides the step is a length, got "{answer[:40]}"; with N counts in a turn '
                "of a drum of radius r it is 2 π r/N, of 10 mm and 2000 counts 31.4 um"
            )
        step = parse_number(answer, "m", "resolution")
        need_unit(answer, step, "m", "resolution")
        Device(damping=0, rate=1, resolution=step)
        return Row("resolution", answer)
    geared = _GEARED.fullmatch(answer)
    if geared is not None:
        return _of_the_motor(geared["encoder"], geared["ratio"])
    counted = _COUNTED.fullmatch(answer)
    if counted is None:
        rotary(damping=0, rate=1, resolution=parse_number(answer, "rad", "resolution"))
        return Row("resolution", answer)
    number = str(2 ** int(counted["power"])) if counted["power"] else counted["number"]
    counts, remark = _counts(number, (counted["unit"] or "counts").lower(), answer)
    if float(counts) < 1:
        raise InputError(
            f'an encoder has 1 count in a turn or more, got "{answer[:40]}"; of an angle write the unit'
        )
    rotary(damping=0, rate=1, counts_per_turn=counts)
    return Row("counts_per_turn", counts, remark)


def _of_the_motor(encoder: str, typed: str) -> Row:
    """The row of an encoder on a motor that turns several times in one turn of the handle."""
    ratio = parse_number(typed, "1", "turns of the motor in one of the handle").fraction
    if ratio <= 0:
        raise InputError(f'the motor turns more than 0 times in one turn of the handle, got "{typed[:40]}"')
    row = read_encoder(encoder, "rotary")
    if row.key != "counts_per_turn":
        raise InputError(
            f'behind "x {typed[:20]}" stand the turns of the motor in one of the handle, and before it the '
            f'counts in a turn of the motor, as in "980 counts/turn x 17.45"; got "{encoder[:40]}"'
        )
    counts = f"{float(parse_number(str(row.value), '1', 'counts').fraction * ratio):.12g}"
    rotary(damping=0, rate=1, counts_per_turn=counts)
    of_one = row.remark or f"{row.value} counts in a turn"
    remark = f"{of_one} of the motor, which turns {typed} times in one of the handle"
    return Row("counts_per_turn", counts, remark)


def encoder_understood(answer: str, motion: str) -> str:
    """What one count is, in SI; how many there are in a turn."""
    row = read_encoder(answer, motion)
    unit = "rad" if motion == "rotary" else "m"
    if row.key == "resolution":
        return understood(parse_number(answer, unit, "resolution"), unit)
    step = rotary(damping=0, rate=1, counts_per_turn=str(row.value)).resolution
    remark = f" ({row.remark})" if row.remark else ""
    return f"{row.value} counts in a turn{remark}, one is {understood(step, unit)}"


def _counts(number: str, unit: str, answer: str) -> tuple[str, str]:
    """Counts in a turn, and what was made of the answer."""
    value = parse_number(number, "1", f"number of {unit.removesuffix('s')}s").fraction
    if unit.startswith("bit"):
        if value.denominator != 1 or not 0 < value <= _LARGEST_BITS:
            raise InputError(
                f'an encoder has a whole number of bits, at most {_LARGEST_BITS}, got "{answer[:40]}"'
            )
        return str(2 ** int(value)), f"{value} bits: 2 to the power of {value} counts in a turn"
    if unit.startswith(("line", "ppr")):
        return f"{float(LINES * value):.12g}", f"{number.strip()} lines in a turn, {LINES} counts each"
    return f"{float(value):.12g}", ""
