"""What one port sends to the other: for which run of it, a wave, and the sums of waves and energies so far.

"zwp" 2 | run | to | number | wave | energy | position | CRC-32        (little-endian)
"""

from __future__ import annotations

import struct
import zlib
from dataclasses import dataclass
from math import isfinite

from zwidth.errors import InputError

_LAYOUT = struct.Struct("<4sQQQddd")
_CHECKSUM = struct.Struct("<I")
_MARK = b"zwp\x02"
_FIRST_SIZE = 36
"""Of the first layout, which had no mark and no runs."""
_MOST = 2**53
_RUNS = 2**64


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
        That this port has sent to that run of the other end in all, ≥ 0; it never falls [J].
    position
        Where this port sends the other to: the sum of its waves, as ways; or its own position where no
        waves are sent [m; rad].
    run
        Drawn when a port starts, from 1 to 2⁶⁴ − 1: no other run has the same.
    to
        The run of the other end that it is meant for; 0 where none has been heard of.

    Raises
    ------
    InputError
        If a number is not finite, or below 0 where it cannot be.
    """

    number: int
    wave: float
    energy: float
    position: float
    run: int
    to: int = 0

    SIZE = _LAYOUT.size + _CHECKSUM.size
    """Bytes of a packet."""

    def __post_init__(self) -> None:
        if not (isinstance(self.number, int) and 0 <= self.number < _MOST):
            raise InputError(f"the number of a packet counts from 0, got {self.number!r}")
        for name, least in (("run", 1), ("to", 0)):
            value = getattr(self, name)
            if not (isinstance(value, int) and least <= value < _RUNS):
                raise InputError(f"{name} of a packet is whole, from {least} to 2⁶⁴ − 1, got {value!r}")
        for name in ("wave", "energy", "position"):
            value = getattr(self, name)
            if not (isinstance(value, float) and isfinite(value)):
                raise InputError(f"{name} of a packet is a finite float, got {value!r}")
        if self.energy < 0:
            raise InputError(f"energy of a packet must be ≥ 0 J, got {self.energy:g}: it is what was sent")

    def to_bytes(self) -> bytes:
        """56 bytes, the last four a CRC-32 of the others."""
        told = (self.run, self.to, self.number, self.wave, self.energy, self.position)
        body = _LAYOUT.pack(_MARK, *told)
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
            If it is of another version or length, or its checksum or a number is wrong: such a packet counts
            as lost.
        """
        if len(data) == _FIRST_SIZE or (data[:3] == _MARK[:3] and data[3:4] not in (b"", _MARK[3:])):
            version = 1 if len(data) == _FIRST_SIZE else data[3]
            raise InputError(
                f"a packet of version {version}, and this port reads version {_MARK[3]}: install one "
                "zwidth at both ends; leave it out, as if it were lost"
            )
        if len(data) != cls.SIZE:
            raise InputError(
                f"a packet has {cls.SIZE} bytes, got {len(data)}; leave it out, as if it were lost"
            )
        body, check = data[: _LAYOUT.size], data[_LAYOUT.size :]
        if _CHECKSUM.unpack(check)[0] != zlib.crc32(body):
            raise InputError("the checksum of a packet is wrong; leave it out, as if it were lost")
        mark, run, to, number, wave, energy, position = _LAYOUT.unpack(body)
        if mark != _MARK:
            raise InputError("these bytes are no packet of a port; leave them out, as if they were lost")
        return cls(number, wave, energy, position, run, to)
