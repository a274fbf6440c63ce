"""Numbers of a storage function or a table: of 64 bits, little-endian, deflated, in base 64."""

from __future__ import annotations

import base64
import zlib
from math import prod
from struct import unpack
from typing import Any

from ..document.effort import reserve, spend
from ..document.refusal import Invalid

WHOLE, DOUBLE = "<i8", "<f8"


def values_of(text: str, shape: tuple[int, ...], kind: str = WHOLE) -> Any:
    """An array of that shape, exactly."""
    import numpy as np  # loaded only where a storage function is to be checked

    return np.frombuffer(_unpacked(text, prod(shape)), dtype=kind).reshape(shape)


def listed(text: str, count: int, kind: str = WHOLE) -> list[Any]:
    """The same as a list."""
    return list(unpack(f"<{count}{'d' if kind == DOUBLE else 'q'}", _unpacked(text, count)))


def _unpacked(text: str, count: int) -> bytes:
    size = 8 * count
    reserve(2 * size)
    spend(0.1 * count)
    try:
        packed = base64.b64decode(text, validate=True)
        raw = zlib.decompressobj().decompress(packed, size + 1)
    except (ValueError, zlib.error) as error:
        raise Invalid(f"a storage function or table cannot be unpacked: {error}") from None
    if len(raw) != size:
        raise Invalid("the storage function has not one value for each state")
    return raw


def storage_of(text: str, shape: tuple[int, ...]) -> Any:
    """V, which is nowhere below 0."""
    value = values_of(text, shape)
    if value.min() < 0:
        raise Invalid("a storage function must be bounded below by 0")
    return value
