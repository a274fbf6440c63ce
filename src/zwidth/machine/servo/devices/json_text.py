"""Values found in JSON text by compiled code, without building anything (RFC 8259).

The text is walked from an opening brace or bracket on; nothing is supposed of the order of members or of
white space.  Every function takes where a value starts and gives back a place, or −1 where the text is none
or ends too early.  A member's name is compared byte by byte: one written with escapes is not recognized.
"""

from __future__ import annotations

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
