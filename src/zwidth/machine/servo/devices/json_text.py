"""Values found in JSON text by compiled code, without building anything (RFC 8259).

The text is walked from an opening brace or bracket on; nothing is supposed of the order of members or of
white space.  Every function takes where a value starts and gives back a place, or −1 where the text is none
or ends too early.  A member's name is compared byte by byte: one written with escapes is not recognized.
"""

from __future__ import annotations

import numpy as np

from zwidth.machine.servo.posix import Bytes
from zwidth.native.compiled import compiled

_QUOTE, _BACKSLASH, _COMMA, _COLON = (ord(c) for c in '"\\,:')
_BRACE, _END_BRACE, _BRACKET, _END_BRACKET = (ord(c) for c in "{}[]")
_SPACE, _TAB, _LINE, _RETURN = (ord(c) for c in " \t\n\r")

ABSENT = -2
"""There is no such member or element; the text itself may be right."""


@compiled
def skip_space(text: Bytes, at: int, end: int) -> int:
    """The next byte that is no white space."""
    while at < end and text[at] in (_SPACE, _TAB, _LINE, _RETURN):
        at += 1
    return at


@compiled
def skip_value(text: Bytes, at: int, end: int) -> int:
    """Behind the value that starts here: a string, an object, an array, or a bare word or number."""
    if at >= end:
        return -1
    if text[at] == _QUOTE:
        return _skip_string(text, at, end)
    if text[at] != _BRACE and text[at] != _BRACKET:
        return _skip_bare(text, at, end)
    depth = 0
    while at < end:
        byte = text[at]
        if byte == _QUOTE:
            at = _skip_string(text, at, end)
            if at < 0:
                return -1
            continue
        if byte in (_BRACE, _BRACKET):
            depth += 1
        elif byte in (_END_BRACE, _END_BRACKET):
            depth -= 1
            if depth == 0:
                return at + 1
        at += 1
    return -1


@compiled
def member(text: Bytes, at: int, end: int, name: Bytes) -> int:
    """Where the value of the member of this name starts, in the object that starts here; ABSENT, −1."""
    if at >= end or text[at] != _BRACE:
        return -1
    at = skip_space(text, at + 1, end)
    if at < end and text[at] == _END_BRACE:
        return ABSENT
    while at < end and text[at] == _QUOTE:
        behind = _skip_string(text, at, end)
        if behind < 0:
            return -1
        found = is_string(text, at, end, name)
        at = skip_space(text, behind, end)
        if at >= end or text[at] != _COLON:
            return -1
        at = skip_space(text, at + 1, end)
        if found:
            return at if at < end else -1
        at = _next(text, at, end, _END_BRACE)
        if at < 0:
            return at
    return -1


@compiled
def first_element(text: Bytes, at: int, end: int) -> int:
    """Where the first element of the array that starts here starts; ABSENT if it is empty, −1."""
    if at >= end or text[at] != _BRACKET:
        return -1
    at = skip_space(text, at + 1, end)
    if at >= end:
        return -1
    return ABSENT if text[at] == _END_BRACKET else at


@compiled
def next_element(text: Bytes, at: int, end: int) -> int:
    """Where the element behind the one that starts here starts; ABSENT if there is none, −1."""
    return _next(text, at, end, _END_BRACKET)


@compiled
def is_string(text: Bytes, at: int, end: int, wanted: Bytes) -> bool:
    """True if the value that starts here is this string, letter by letter."""
    length = wanted.shape[0]
    if at < 0 or at + length + 2 > end or text[at] != _QUOTE or text[at + length + 1] != _QUOTE:
        return False
    for place in range(length):  # noqa: SIM110 (generators are not compiled)
        if text[at + 1 + place] != wanted[place]:
            return False
    return True


@compiled
def _next(text: Bytes, at: int, end: int, closing: int) -> int:
    """Behind this value and its comma; ABSENT if the closing bracket follows, −1."""
    at = skip_value(text, at, end)
    if at < 0:
        return -1
    at = skip_space(text, at, end)
    if at >= end:
        return -1
    if text[at] == closing:
        return ABSENT
    if text[at] != _COMMA:
        return -1
    at = skip_space(text, at + 1, end)
    return at if at < end else -1


@compiled
def _skip_string(text: Bytes, at: int, end: int) -> int:
    """Behind the string whose quote is here."""
    at += 1
    while at < end:
        if text[at] == _QUOTE:
            return at + 1
        at += 2 if text[at] == _BACKSLASH else 1
    return -1


@compiled
def _skip_bare(text: Bytes, at: int, end: int) -> int:
    """Behind true, false, null or a number: up to what ends a value."""
    start = at
    while at < end:
        byte = text[at]
        if byte in (_COMMA, _END_BRACE, _END_BRACKET) or byte <= _SPACE:
            break
        at += 1
    return at if at > start else -1


# Decimal numbers: ``[-]digits[.digits][e[±]digits]`` is read, as JSON and C's ``%f`` write it; C's scanf
# takes what is written.  Up to 15 significant digits, and powers of ten up to 22, the digits and the power
# are floats exactly and only their product or quotient is rounded: the result is the float nearest to the
# decimal (W. D. Clinger, "How to read floating point numbers accurately", PLDI 1990).  Beyond that it is
# within three units of the last place.


_MINUS, _PLUS, _POINT, _ZERO, _NINE, _SMALL_E, _BIG_E = (ord(letter) for letter in "-+.09eE")

_EXACT_POWERS = np.array([10.0**power for power in range(23)])
_KEPT_DIGITS = 18
"""So many fit an int64; what follows changes the value by less than its last place."""

_LARGEST = 1e9
"""No force is greater; with nine decimals its digits fit an int64."""


@compiled
def read_decimal(text: Bytes, start: int, end: int) -> tuple[float, int]:
    """(The number that begins at `start`, where it ends); (0, −1) if none does, or it is not finished.

    It is finished by a byte that cannot belong to it, before `end`: what reaches `end` may go on.
    """
    at, negative = start, False
    if at < end and text[at] == _MINUS:
        negative = True
        at += 1
    digits, kept, power, seen = 0, 0, 0, 0
    fraction = False
    while at < end and (_is_digit(text[at]) or (text[at] == _POINT and not fraction)):
        if text[at] == _POINT:
            fraction = True
        else:
            seen += 1
            if kept < _KEPT_DIGITS:
                digits = 10 * digits + (int(text[at]) - _ZERO)
                kept += 1 if digits > 0 else 0
                power -= 1 if fraction else 0
            else:
                power += 0 if fraction else 1
        at += 1
    if seen == 0 or text[at - 1] == _POINT or at >= end:
        return 0.0, -1
    if text[at] == _SMALL_E or text[at] == _BIG_E:
        exponent, at = _read_exponent(text, at + 1, end)
        if at < 0:
            return 0.0, -1
        power += exponent
    value = _scaled(float(digits), power)
    return -value if negative else value, at


@compiled
def write_decimal(value: float, decimals: int, into: Bytes, start: int) -> int:
    """Write ``value`` with so many decimals, rounded to the nearest; where it ends.

    0 is written for what is no number, and ±10⁹ for what is beyond; at most 12 + `decimals` bytes, which are
    1 to 9.
    """
    if not np.isfinite(value):
        value = 0.0
    value = min(max(value, -_LARGEST), _LARGEST)
    digits = int(abs(value) * _EXACT_POWERS[decimals] + 0.5)
    at = start
    if value < 0.0 and digits > 0:
        into[at] = _MINUS
        at += 1
    length = decimals + 1
    while length < 19 and digits >= 10**length:
        length += 1
    end = at + length + 1
    for place in range(length):
        if place == decimals:
            end -= 1
            into[end] = _POINT
        end -= 1
        into[end] = _ZERO + digits % 10
        digits //= 10
    return at + length + 1


@compiled
def _is_digit(byte: int) -> bool:
    return _ZERO <= byte <= _NINE


@compiled
def _read_exponent(text: Bytes, start: int, end: int) -> tuple[int, int]:
    """(The power of ten, where it ends), −1 as its end if there is none or it reaches `end`."""
    at, negative = start, False
    if at < end and (text[at] == _MINUS or text[at] == _PLUS):
        negative = text[at] == _MINUS
        at += 1
    exponent, first = 0, at
    while at < end and _is_digit(text[at]):
        exponent = min(10 * exponent + (int(text[at]) - _ZERO), 9999)
        at += 1
    if at == first or at >= end:
        return 0, -1
    return -exponent if negative else exponent, at


@compiled
def _scaled(digits: float, power: int) -> float:
    """digits · 10^power, by one rounding where |power| ≤ 22."""
    while power > 22 and digits != 0.0 and digits < 1e300:
        digits *= 1e22
        power -= 22
    while power < -22 and digits != 0.0:
        digits /= 1e22
        power += 22
    if digits == 0.0:
        return 0.0
    if power >= 0:
        return digits * _EXACT_POWERS[min(power, 22)]
    return digits / _EXACT_POWERS[-power]
