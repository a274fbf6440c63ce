"""What one port sends to the other: a number, a wave, and the sums of all waves and energies so far."""

from __future__ import annotations

import struct
import zlib
from dataclasses import dataclass
from math import isfinite

from zwidth.errors import InputError

_LAYOUT = struct.Struct("<Qddd")
_CHECKSUM = struct.Struct("<I")
_MOST = 2**53


@dataclass(frozen=True, slots=True)
class Packet:
    """What a port sends after each period.

    The sums make a lost packet harmless: the next one tells what it told.

    Parameters
    ----------
    number
        0 for the first that a port sends, then one more each time.
    wave
        Of the period that has ended, the square root of its energy with the sign of its push [√J].
    energy
        That this port has sent in all, ≥ 0; it never falls [J].
    position
        Where this port sends the other to: the sum of its waves, as ways; or its own position where no
        waves are sent [m; rad].

    Raises
    ------
    InputError
        If a number is not finite, or below 0 where it cannot be.
    """

    number: int
    wave: float
    energy: float
    position: float

    SIZE = _LAYOUT.size + _CHECKSUM.size
    """Bytes of a packet."""

    def __post_init__(self) -> None:
        if not (isinstance(self.number, int) and 0 <= self.number < _MOST):
            raise InputError(f"the number of a packet counts from 0, got {self.number!r}")
        for name in ("wave", "energy", "position"):
            value = getattr(self, name)
            if not (isinstance(value, float) and isfinite(value)):
                raise InputError(f"{name} of a packet is a finite float, got {value!r}")
        if self.energy < 0:
            raise InputError(f"energy of a packet must be ≥ 0 J, got {self.energy:g}: it is what was sent")

    def to_bytes(self) -> bytes:
        """36 bytes, the last four a CRC-32 of the others."""
        body = _LAYOUT.pack(self.number, self.wave, self.energy, self.position)
        return body + _CHECKSUM.pack(zlib.crc32(body))

    @classmethod
    def from_bytes(cls, data: bytes) -> Packet:
        """The packet again.

        Parameters
        ----------
        data
            As `to_bytes` made it.

        Raises
        ------
        InputError
            If it is of another length, or its checksum or a number is wrong: such a packet counts as lost.
        """
        if len(data) != cls.SIZE:
            raise InputError(
                f"a packet has {cls.SIZE} bytes, got {len(data)}; leave it out, as if it were lost"
            )
        body, check = data[: _LAYOUT.size], data[_LAYOUT.size :]
        if _CHECKSUM.unpack(check)[0] != zlib.crc32(body):
            raise InputError("the checksum of a packet is wrong; leave it out, as if it were lost")
        return cls(*_LAYOUT.unpack(body))


FIRST = Packet(0, 0.0, 0.0, 0.0)
"""Of a port that has neither moved nor been pushed."""
