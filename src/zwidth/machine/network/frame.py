"""What a datagram holds: the packet of a port, or nothing, and when it was sent.

    "zw" 2 0 | sent | echo | held | packet, or nothing | CRC-32        (little-endian)

`sent` is the sender's clock, `echo` the newest `sent` that it has received and `held` how long it has kept
that: now − echo − held is the round trip, whatever the two clocks say.  Which runs of the two ends a packet
is from and for it says itself, see `zwidth.links.Packet`.  A datagram that is cut, mixed, foreign, of another
version or holds a number that is none (NaN, infinity) is not a frame, and is dropped.
"""

from __future__ import annotations

import math
import struct
import zlib
from typing import NamedTuple

from zwidth.errors import InputError
from zwidth.links import Packet

_HEAD = struct.Struct("<4sddd")
_MARK = b"zw\x02\x00"
_SUM = struct.Struct("<I")
_SIZES = [_HEAD.size + _SUM.size, _HEAD.size + Packet.SIZE + _SUM.size]


class Frame(NamedTuple):
    """One message: a packet, or None of a call, and the three times [s]."""

    packet: Packet | None
    sent: float = 0.0
    echo: float = math.nan
    """NaN where nothing has been received yet."""
    held: float = 0.0

    def to_bytes(self) -> bytes:
        """The datagram; of the same numbers always the same bytes."""
        body = _HEAD.pack(_MARK, self.sent, self.echo, self.held)
        body += b"" if self.packet is None else self.packet.to_bytes()
        return body + _SUM.pack(zlib.crc32(body))

    @classmethod
    def from_bytes(cls, datagram: bytes) -> Frame | None:
        """The frame, or None of what is none."""
        if len(datagram) not in _SIZES:
            return None
        body = datagram[: -_SUM.size]
        if _SUM.unpack(datagram[-_SUM.size :])[0] != zlib.crc32(body):
            return None
        mark, sent, echo, held = _HEAD.unpack_from(body)
        if mark != _MARK or not (math.isfinite(sent) and math.isfinite(held)):
            return None
        try:
            packet = Packet.from_bytes(body[_HEAD.size :]) if len(body) > _HEAD.size else None
        except InputError:
            return None
        return cls(packet, sent, echo, held)

    @staticmethod
    def is_of_another_version(datagram: bytes) -> bool:
        """True of what begins as a frame does, with the number of another version."""
        return datagram[:2] == _MARK[:2] and datagram[2:4] != _MARK[2:] and len(datagram) > _HEAD.size
