"""A port: between a sampled device and a link, it turns packets into a force and a move into a packet."""

from __future__ import annotations

import secrets
import struct
import zlib
from collections.abc import Callable, Iterable
from dataclasses import dataclass, field, replace
from fractions import Fraction
from math import inf, isfinite, nextafter
from typing import ClassVar, TypeVar

import numpy as np

from zwidth.errors import InputError
from zwidth.links import memory
from zwidth.model.device import Device, require_rigid
from zwidth.native.compiled import Array
from zwidth.quantity.exact import ends
from zwidth.quantity.parameter import Parametric, parameters_of

P = TypeVar("P", bound="Port")

_TINY = 1e-6
"""Way over an edge of the encoder [counts]."""
_WHOLE = 1e-3
"""How far a displacement may be from whole counts [counts]."""
_ULP = 2.0**-51
"""Of so many counts: the difference of two readings far out is rounded, and so is its quotient."""


@dataclass(slots=True)
class _Other:
    """Of the other end: the run that is sent to, whether it has answered, and the lines of runs before."""

    run: int = 0
    answered: bool = False
    kept: dict[int, Array] = field(default_factory=dict)


@dataclass(frozen=True)
class Port(Parametric):
    """One end of a link.  Each period: ``receive``, then the device moves, then ``send``.

    A port is a run: it draws a number, which every packet tells with that of the run that it is meant for.
    What is told is a sum for each run of the other end, and only a packet that has this port's own number
    counts: energy is never counted by two runs, whenever either end starts anew (docs/theory/pairs.md).

    Parameters
    ----------
    device
        What the port drives.  Of a number that is an interval the worse end counts.
    """

    title: ClassVar[str]
    """What the law is called."""
    code: ClassVar[float]
    """By which the compiled law is known."""
    steps: ClassVar[tuple[Callable[[Array, Array], float], Callable[[Array, Array, float], None]]]
    """What is compiled: the force of a period, and what is sent after it."""

    device: Device
    numbers: Array = field(init=False, repr=False, compare=False)
    state: Array = field(init=False, repr=False, compare=False)
    run: int = field(init=False, repr=False, compare=False)
    """Of this port alone: drawn when it is made."""
    _other: _Other = field(init=False, repr=False, compare=False)

    def __post_init__(self) -> None:
        super().__post_init__()
        if not isinstance(self.device, Device):
            raise InputError(f"device is a Device, got {type(self.device).__name__}")
        require_rigid(self.device, "a port")
        self.complete()
        self._keep(numbers=np.array(self._numbers()), state=self.fresh_state())
        self._keep(run=secrets.randbelow(2**64 - 1) + 1, _other=_Other())

    def complete(self) -> None:
        """Fill in what was not given."""

    def _numbers(self) -> list[float]:
        own = [float(getattr(self, name)) for name in parameters_of(type(self))]
        told = [
            -rounded_down(-self.device.exact("sample_period")),
            rounded_down(ends(self.device.damping)[0]),
            rounded_down(ends(self.device.coulomb_friction)[0]),
            float(self.device.exact("resolution")),
            0.0 if self.device.force_limit is None else float(ends(self.device.force_limit)[0]),
            0.0 if self.device.force_resolution is None else float(self.device.exact("force_resolution")),
            float(_samples_late(self.device)),
        ]
        return [*told, *own, *[0.0] * (memory.NUMBERS_SIZE - len(told) - len(own))]

    def fresh_state(self) -> Array:
        """Before the first packet."""
        state = np.zeros(memory.STATE_SIZE)
        state[: memory.LINE] = memory.NEW_LINE
        state[memory.NUMBER] = -1.0
        return state

    def anew(self: P) -> P:
        """The same port before its first packet, another run."""
        return replace(self)

    def warm(self) -> None:
        """Have the step functions found in their library before a clock runs; this port stays as it is."""
        one, other = self.anew(), self.anew()
        other.meet(one.run)
        other.receive()
        one.receive([other.send(0.0)])
        one.send(0.0)

    def meet(self, run: int) -> None:
        """Send to this run of the other end from now on; ``receive`` finds it by itself in what it hears.

        What was sent before is not for it: the sums that it is told begin at 0, where both ends are now.
        """
        other, s = self._other, self.state
        if run != other.run:
            other.kept[other.run] = s[: memory.LINE].copy()
            s[: memory.LINE] = other.kept.get(run, memory.NEW_LINE)
        other.run = run

    def _is_for_this_run(self, packet: Packet) -> bool:
        """Whose packets have this run's number is who is sent to; before the first, whoever is heard."""
        if packet.run == self.run:
            return False
        mine = packet.to == self.run
        if mine or not self._other.answered:
            self.meet(packet.run)
            self._other.answered |= mine
        return mine

    has_ledger: ClassVar[bool] = False
    """True where a ledger pays for every force, which has a certificate."""

    @property
    def theorem(self) -> str:
        """Why it is passive whatever the link does, by a proof on paper; "" where there is none."""
        return ""

    def telling_ways(self) -> list[float]:
        """Ways in a period that the numbers of this port suggest to a hand that wants to take energy out."""
        step = float(self.numbers[memory.RESOLUTION])
        return [_TINY * step, step] if step else []

    def receive(self, packets: Iterable[Packet] = ()) -> float:
        """The force that the actuator is to give next, positive along x [N; N·m].

        It acts in the period that begins now or, of a device with a delay, after that.

        Parameters
        ----------
        packets
            All that have come since the last call, in any order; none is no mistake.

        Raises
        ------
        InputError
            If one of them is no `Packet`, or ``send`` has not been called since the last time.
        """
        if self.state[memory.MOVING]:
            raise InputError(
                "receive is called once in a period, got it twice without send between: two forces in one "
                "period cannot be booked; give it all packets that have come, also none"
            )
        for packet in packets:
            if not isinstance(packet, Packet):
                raise InputError(
                    f"packets are Packet objects, got {packet!r}; bytes: Packet.from_bytes(data)"
                )
            if self._is_for_this_run(packet):
                memory.hear(self.state, float(packet.number), packet.wave, packet.energy, packet.position)
        self.state[memory.MOVING] = 1.0
        return float(self.steps[0](self.numbers, self.state))

    @property
    def force(self) -> float:
        """The force that acts in this period, positive along x [N; N·m]."""
        return float(self.state[memory.ACTING])

    def send(self, displacement: float) -> Packet:
        """The packet for the other end, after the device has moved.

        Parameters
        ----------
        displacement
            By how much the reading has changed over the period, positive along x; of an encoder a whole
            number of counts [m; rad].

        Raises
        ------
        InputError
            If it is not finite, or no whole number of counts; or ``receive`` has not been called since the
            last time.
        """
        moved = float(displacement)
        if not isfinite(moved):
            raise InputError(f"displacement must be finite, got {displacement!r}")
        step = self.numbers[memory.RESOLUTION]
        counts = round(moved / step) if step > 0 else 0
        if step > 0 and abs(moved / step - counts) > _WHOLE + _ULP * abs(counts):
            raise InputError(
                f"displacement is a whole number of counts of {step:g}, got {moved:g}: give the "
                "difference of two readings as they are, not filtered"
            )
        if not self.state[memory.MOVING]:
            raise InputError(
                "send is called once in a period, after receive, got it without: each force is booked once; "
                "where nothing has come call receive() all the same"
            )
        self.steps[1](self.numbers, self.state, counts * step if step > 0 else moved)
        self.state[memory.MOVING] = 0.0
        s = self.state
        wave, energy, position = (float(s[i]) for i in (memory.WAVE, memory.ENERGY, memory.POSITION))
        return Packet(int(s[memory.NUMBER]), wave, energy, position, self.run, self._other.run)

    def describe(self) -> str:
        """The law with its numbers, on one line."""
        own, motion = parameters_of(type(self)), self.device.motion
        told = [f"{own[name].quantity.symbol} = {self.with_unit(name, motion)}" for name in own]
        return ", ".join([self.title, *told])


def rounded_down(value: Fraction) -> float:
    """The largest double that is no larger: no more is counted on than there is."""
    near = float(value)
    return nextafter(near, -inf) if Fraction(near) > value else near


def _samples_late(device: Device) -> int:
    """Whole periods from reading to force."""
    late = device.exact("delay") / device.exact("sample_period")
    if late.denominator > 1 or late > memory.MOST_LATE:
        raise InputError(
            f"from reading to force a port takes whole sample periods, at most {memory.MOST_LATE}, got "
            f"{float(late):g}: else two forces act in one period; let the loop keep each force until the "
            "sample ends, as hold_back, or --hold-back, takes for granted"
        )
    return int(late)


# What one port sends to the other: for which run of it, a wave, and the sums of waves and energies so far.
#
# "zwp" 2 | run | to | number | wave | energy | position | CRC-32        (little-endian)


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
    """

    number: int
    wave: float
    energy: float
    position: float
    run: int
    to: int = 0

    _SIZE = _LAYOUT.size + _CHECKSUM.size
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
        if len(data) != cls._SIZE:
            raise InputError(
                f"a packet has {cls._SIZE} bytes, got {len(data)}; leave it out, as if it were lost"
            )
        body, check = data[: _LAYOUT.size], data[_LAYOUT.size :]
        if _CHECKSUM.unpack(check)[0] != zlib.crc32(body):
            raise InputError("the checksum of a packet is wrong; leave it out, as if it were lost")
        mark, run, to, number, wave, energy, position = _LAYOUT.unpack(body)
        if mark != _MARK:
            raise InputError("these bytes are no packet of a port; leave them out, as if they were lost")
        return cls(number, wave, energy, position, run, to)
