"""What a datagram holds: a few numbers, and when it was sent.

    "zw" 1 0 | run | to | number | sent | echo | held | n | n doubles | CRC-32        (little-endian)

`sent` is the sender's clock, `echo` the newest `sent` that it has received and `held` how long it has kept
that: now − echo − held is the round trip, whatever the two clocks say.  `run` is drawn when a side starts,
and `to` is that of the other side: nothing that an earlier run sent is taken.  A datagram that is cut, mixed,
foreign or holds a number that is none (NaN, infinity) is not a frame, and is dropped.
"""

from __future__ import annotations

import math
import struct
import zlib
from typing import NamedTuple

from zwidth.network.channel import LARGEST

_HEAD = struct.Struct("<4sIIQdddI")
_MARK = b"zw\x01\x00"
_SUM = struct.Struct("<I")
MOST_NUMBERS = (LARGEST - _HEAD.size - _SUM.size) // 8


class Frame(NamedTuple):
    """One message: its number from 0, its numbers, and the three times [s]."""

    number: int
    values: tuple[float, ...]
    sent: float = 0.0
    echo: float = math.nan
    """NaN where nothing has been received yet."""
    held: float = 0.0
    run: int = 0
    to: int = 0
    """0 where the other side has not been heard of."""

    def to_bytes(self) -> bytes:
        """The datagram; of the same numbers always the same bytes."""
        if len(self.values) > MOST_NUMBERS:
            raise ValueError(f"a frame holds {MOST_NUMBERS} numbers, not {len(self.values)}")
        n = len(self.values)
        body = _HEAD.pack(_MARK, self.run, self.to, self.number, self.sent, self.echo, self.held, n)
        body += struct.pack(f"<{n}d", *self.values)
        return body + _SUM.pack(zlib.crc32(body))

    @classmethod
    def from_bytes(cls, datagram: bytes) -> Frame | None:
        """The frame, or None of what is none."""
        if not _HEAD.size + _SUM.size <= len(datagram) <= LARGEST:
            return None
        body = datagram[: -_SUM.size]
        if _SUM.unpack(datagram[-_SUM.size :])[0] != zlib.crc32(body):
            return None
        mark, run, to, number, sent, echo, held, n = _HEAD.unpack_from(body)
        if mark != _MARK or len(body) != _HEAD.size + 8 * n:
            return None
        values = struct.unpack_from(f"<{n}d", body, _HEAD.size)
        if not all(map(math.isfinite, (*values, sent, held))):
            return None
        return cls(number, values, sent, echo, held, run, to)
