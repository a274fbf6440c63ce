"""Haply boards over USB, as the 2DIY and earlier kits have them: encoders and motors, by binary frames.

    to the board    0, device                                                               reset
                    1, device, motors, encoders, 0, 0, (offset, counts) of each encoder     setup
                    2, device, torque of each motor                                         torques, then read
    from the board  device, angle of each encoder          to every frame of type 2, and to no other

Each number is a single, little-endian: torques [N·m], angles and offsets [degrees], counts per turn.  Motors
and encoders are a byte with a bit for each port in use, then a byte for each of them, 0 clockwise and 1
counterclockwise.  All go by the number of their port.

Sources: Haply's hAPI in Java (Board, Device, Pantograph 3.0, 2021), its Python port HaplyHAPI 1.0.1, and the
firmware of the boards M0 (0.3) and M3 (1.5).  Where the older hAPI (2.0) differs, with links of 0.05 and
0.07 m and a tenth of the torque, the newer one is followed.

A frame has no checksum, no number and no mark of its beginning.  So answers are counted: none is asked for
before all that are on their way have come, or one would be taken for another.
"""

from __future__ import annotations

import math
import struct
from abc import abstractmethod
from collections.abc import Sequence
from contextlib import suppress
from dataclasses import dataclass
from typing import Any, ClassVar, Literal

import numpy as np

from zwidth.errors import InputError
from zwidth.machine.servo.connection import (
    CLOSED,
    DESCRIPTOR,
    FORCE,
    GARBLED,
    GOOD,
    LEAVES,
    OWN,
    READING,
    SETS,
    SILENT,
    STATUS,
    UNTIL,
    Opened,
    Setting,
    exchanged,
)
from zwidth.machine.servo.devices.frames import get_float32, more_bytes, put_float32, unwritten
from zwidth.machine.servo.devices.serial_port import SerialConnection
from zwidth.machine.servo.posix import Bytes, now, write_all
from zwidth.native.compiled import Array, compiled
from zwidth.quantity.parameter import one_of
from zwidth.quantity.text import shown
from zwidth.quantity.units import in_si

RESET, SETUP, EXCHANGE = 0, 1, 2

# What is remembered, from OWN on: the device's number and its count of motors; answers that are on their way,
# and bytes that are in the inbox; which axis; the place in a frame of joint 1 and of joint 2; the lengths of
# the arms; the torques last given, in the order of a frame; what `locate` found.
DEVICE, MOTORS, OWED, HELD, AXIS, FIRST, SECOND = range(OWN, OWN + 7)
ARMS = SECOND + 1
TORQUES = ARMS + 3
FOUND = TORQUES + 2

_FIRST_ANSWER = 2e9
"""How long the board is waited for when it is opened [ns]."""


@dataclass(frozen=True)
class HaplyJoint:
    """A motor and its encoder at one port of the board.

    Parameters
    ----------
    port
        1 or 2; they are counted from 1 without a gap, as the firmware needs it.
    rotation
        "ccw" or "cw": which way the angle grows; `motor` the same for the torque, None: as the angle.
    offset
        Angle at which the joint stands when the board is opened [rad].
    counts
        Counts of the encoder in one turn of the joint, quadrature counted.
    """

    port: int
    rotation: str
    offset: float
    counts: float
    motor: str | None = None

    def __post_init__(self) -> None:
        one_of("rotation", self.rotation, "ccw", "cw")
        one_of("motor", self.motor, None, "ccw", "cw")
        one_of("port", self.port, 1, 2)
        if not math.isfinite(self.offset):
            raise InputError(f"offset is an angle in rad, got {self.offset}; give where the joint rests")
        if not 0 < self.counts < math.inf:
            raise InputError(
                f"counts must be > 0, got {self.counts}: an angle is so many of them; for the 2DIY give 4880"
            )


_VERSIONS = {
    2: (
        (HaplyJoint(2, "ccw", math.radians(241.0), 10752.0),
         HaplyJoint(1, "cw", math.radians(-61.0), 10752.0)),
        (0.07, 0.09, 0.0),
    ),
    3: (
        (HaplyJoint(2, "ccw", math.radians(168.0), 4880.0), HaplyJoint(1, "ccw", math.radians(12.0), 4880.0)),
        (0.07, 0.09, 0.038),
    ),
}  # fmt: skip
"""Joints 1 and 2, and the lengths l, L and d [m], by the hardware version: of HaplyHAPI 1.0.1."""


# Where the tip of a pantograph is, and which torques give it a force: five bars, two motors side by side.
#
#     A = l (cos θ₁, sin θ₁),   B = (d, 0) + l (cos θ₂, sin θ₂)
#     |P − A| = |P − B| = L,    P the one of the two points that lies to the left of A → B
#     τᵢ = F · ∂P/∂θᵢ           (the power of the torques is that of the force)
#
# with u = P − A and w = P − B, and D = u_x w_y − u_y w_x, the constraints give
#
#     ∂P/∂θ₁ = (u · ∂A/∂θ₁)/D (w_y, −w_x),   ∂P/∂θ₂ = (w · ∂B/∂θ₂)/D (−u_y, u_x).
#
# The origin is the axis of the first motor, x points from it to the second, y away from the base to the hand.
# Campion, Wang and Hayward 2005 (the Pantograph Mk-II), with the axes and the signs of Haply's hAPI.


@compiled
def locate(first: float, second: float, arms: Array, found: Array) -> bool:
    """Position of the tip and its change with the angles; False where the arms cannot meet.

    Of θ₁, θ₂ [rad] and the arms l, L, d [m]; `found` takes x, y [m], ∂x/∂θ₁, ∂y/∂θ₁, ∂x/∂θ₂, ∂y/∂θ₂ [m/rad].
    """
    inner, outer, base = arms[0], arms[1], arms[2]
    ax, ay = inner * math.cos(first), inner * math.sin(first)
    bx, by = base + inner * math.cos(second), inner * math.sin(second)
    hx, hy = bx - ax, by - ay
    apart = math.sqrt(hx * hx + hy * hy)
    if not 0.0 < apart < 2.0 * outer:  # no number is in no interval either
        return False
    height = math.sqrt(outer * outer - 0.25 * apart * apart) / apart
    ux, uy = 0.5 * hx - height * hy, 0.5 * hy + height * hx
    wx, wy = ux - hx, uy - hy
    area = ux * wy - uy * wx
    if area == 0.0:
        return False
    along_first = (uy * ax - ux * ay) / area
    along_second = (wy * (bx - base) - wx * by) / area
    found[0], found[1] = ax + ux, ay + uy
    found[2], found[3] = along_first * wy, -along_first * wx
    found[4], found[5] = -along_second * uy, along_second * ux
    return True


@compiled
def _send(memory: Array, outbox: Bytes) -> bool:
    """The torques as they were last given, in a frame that is answered."""
    outbox[0], outbox[1] = EXCHANGE, int(memory[DEVICE])
    end = 2
    for i in range(int(memory[MOTORS])):
        end = put_float32(outbox, end, memory[TORQUES + i])
    return write_all(int(memory[DESCRIPTOR]), outbox, end)


@compiled
def _collect(memory: Array, inbox: Bytes, wanted: int) -> int:
    """Wait until the inbox has so many answers at least, none in part; each must be of our device."""
    size, held = 1 + 4 * int(memory[MOTORS]), int(memory[HELD])
    while True:
        whole = held >= wanted * size and held % size == 0
        until = 0 if whole else int(memory[UNTIL])
        count = more_bytes(int(memory[DESCRIPTOR]), inbox, held, until)
        if count == -2:
            return CLOSED
        if count == 0:
            break
        held += count
        memory[HELD] = held
    if not whole:
        return SILENT if held % size == 0 else GARBLED
    for at in range(0, held, size):
        if inbox[at] != int(memory[DEVICE]):
            return GARBLED
    return GOOD


@compiled
def _read(memory: Array, inbox: Bytes) -> int:
    """The reading, of the last answer in the inbox."""
    at = int(memory[HELD]) - 4 * int(memory[MOTORS])
    first = math.radians(get_float32(inbox, at + 4 * int(memory[FIRST])))
    second = math.radians(get_float32(inbox, at + 4 * int(memory[SECOND])))
    if memory[AXIS] == 2:
        memory[FOUND + 2] = 1.0
        memory[READING] = first
        return GOOD if math.isfinite(first) else GARBLED
    # the arms cannot turn round: a greater angle is none that was measured
    if not (abs(first) <= 2 * math.pi and abs(second) <= 2 * math.pi):
        return GARBLED
    if not locate(first, second, memory[ARMS : ARMS + 3], memory[FOUND : FOUND + 6]):
        return GARBLED
    memory[READING] = memory[FOUND + int(memory[AXIS])]
    return GOOD


@compiled
def _ask(memory: Array, inbox: Bytes, outbox: Bytes) -> int:
    """Take what is on its way, ask, and read the answer."""
    status = _collect(memory, inbox, int(memory[OWED]))
    if status != GOOD:
        return status
    memory[OWED] = memory[HELD] = 0.0
    if not _send(memory, outbox):
        return unwritten(int(memory[DESCRIPTOR]), inbox)
    memory[OWED] = 1.0
    status = _collect(memory, inbox, 1)
    if status != GOOD:
        return status
    status = _read(memory, inbox)
    memory[OWED] = memory[HELD] = 0.0
    return status


@exchanged
def _measure(memory: Array, inbox: Bytes, outbox: Bytes) -> int:
    status = _ask(memory, inbox, outbox)
    if status == GARBLED:  # where the next answer begins is not known: nothing of this is kept
        memory[OWED] = memory[HELD] = 0.0
    return status


@exchanged
def _apply(memory: Array, inbox: Bytes, outbox: Bytes) -> int:
    force, along = memory[FORCE], FOUND + 2 + int(memory[AXIS]) % 2
    memory[TORQUES + int(memory[FIRST])] = force * memory[along]
    if memory[AXIS] < 2:
        memory[TORQUES + int(memory[SECOND])] = force * memory[along + 2]
    if not _send(memory, outbox):
        return unwritten(int(memory[DESCRIPTOR]), inbox)
    memory[OWED] += 1.0
    return GOOD


class _Haply(SerialConnection):
    """The board with its joints; which of their angles or positions is the axis."""

    maker: ClassVar[str] = "Haply's firmware M3 1.5 and M0 0.3, hAPI of 2021, HaplyHAPI 1.0.1"
    settings: ClassVar[tuple[Setting, ...]] = (
        ("setup: ports, rotations, offsets, counts", "", "sign, size and place: of motors and encoders alike",
         SETS, "hAPI, Device.deviceSetParameters"),
        ("torque of each motor", "", "the force; the other axis is free", SETS, "hAPI, Board.transmit"),
        ("arms at rest at their offsets", "", "sign and place: where they stand is taken for it", LEAVES,
         "hAPI, Pantograph"),
        ("no watchdog", "", "end: the last torques act until the power is cut", LEAVES, "firmware"),
        ("limit of a motor", "0.123 N·m", "size, and direction where one of two is cut", LEAVES,
         "firmware M3 1.5"),
        ("links", "70, 90, 38 mm", "size: torques of a force", LEAVES, "HaplyHAPI, Pantograph"),
    )  # fmt: skip
    measure: ClassVar[Any] = staticmethod(_measure)
    apply: ClassVar[Any] = staticmethod(_apply)

    baud = 115200

    def __init__(self, port: str, number: int, joints: Sequence[HaplyJoint]) -> None:
        if not (isinstance(number, int) and 1 <= number <= 255):
            raise InputError(
                f"number is a whole one from 1 to 255, got {number!r}: the board keeps 0 for no device; "
                "any other will do, such as 5"
            )
        self.port, self.number, self.joints = port, number, tuple(joints)
        if sorted(joint.port for joint in self.joints) != list(range(1, len(self.joints) + 1)):
            raise InputError(
                f"the joints are at ports {', '.join(str(joint.port) for joint in self.joints)}: "
                "the firmware counts directions from port 1 on without a gap; plug in at 1, or at 1 and 2"
            )

    @property
    def on_silence(self) -> str:
        """The firmware has no watchdog."""
        return "holds the last torques until it is given others or loses its power: it has no watchdog"

    def _prepare(self, opened: Opened) -> None:
        """The joints must stand at their offsets, where the count begins."""
        memory = opened.memory
        memory[DEVICE], memory[MOTORS] = self.number, len(self.joints)
        memory[FIRST], memory[SECOND] = self.joints[0].port - 1, self.joints[-1].port - 1
        self._set_axis(memory)
        self._write(bytes((RESET, 0)))
        self._write(self._setup())
        memory[UNTIL] = now() + _FIRST_ANSWER
        status = self.measure(*opened)
        if status != GOOD:
            raise InputError(
                f"the board at {self.port} gave, when asked for its angles: {STATUS[status]}; "
                "is it a Haply board with its firmware, are the joints at their offsets, "
                "and the hardware version and the links those of this device?"
            )

    @abstractmethod
    def _set_axis(self, memory: Array) -> None:
        """Write which axis is measured, and what the compiled functions need for it."""

    def _setup(self) -> bytes:
        by_port = sorted(self.joints, key=lambda joint: joint.port)
        used = (1 << len(by_port)) - 1
        motors = bytes((joint.motor or joint.rotation) == "ccw" for joint in by_port)
        encoders = bytes(joint.rotation == "ccw" for joint in by_port)
        numbers = [value for joint in by_port for value in (math.degrees(joint.offset), joint.counts)]
        head = bytes((SETUP, self.number, used, *motors, used, *encoders, 0, 0))
        return head + struct.pack(f"<{len(numbers)}f", *numbers)

    def _write(self, frame: bytes) -> None:
        with suppress(OSError):  # a board that is gone does not answer either
            self._line.write(frame)

    def _end(self, opened: Opened) -> None:
        count = len(self.joints)
        self._write(struct.pack(f"<BB{count}f", EXCHANGE, self.number, *([0.0] * count)))


class HaplyPantograph(_Haply):
    """The tip of a Haply 2DIY, or of another pantograph at a Haply board, along x or y [m, N].

    Parameters
    ----------
    port
        Serial port of the board, "/dev/ttyACM0".
    axis
        "x" from motor 1 to motor 2, or "y" away from the base; the other is free.
    version
        Of the hardware: 3 the 2DIY in plastic, 2 the one on a metal plate.
    number
        By which the board is to know the device, 1 to 255.
    joints
        HaplyJoint 1 and joint 2, at the origin and at x = d; None: those of the version.
    links
        Lengths of an arm at a motor, of one at the tip, and between the motors, l, L and d [m]; None:
        those of the version.
    """

    motion: ClassVar[Literal["linear", "rotary"]] = "linear"

    def __init__(
        self,
        port: str,
        axis: str = "x",
        *,
        version: int = 3,
        number: int = 5,
        joints: Sequence[HaplyJoint] | None = None,
        links: tuple[float, float, float] | None = None,
    ) -> None:
        self.axis = one_of("axis", axis, "x", "y")
        self.version = one_of("version", version, 3, 2)
        own_joints, own_links = _VERSIONS[version]
        super().__init__(port, number, own_joints if joints is None else joints)
        self.links = own_links if links is None else links
        self._check()

    def _check(self) -> None:
        if len(self.joints) != 2:
            raise InputError(
                f"a pantograph has 2 joints, got {len(self.joints)}; take HaplyMotor for a single motor"
            )
        if len(self.links) != 3 or not all(map(math.isfinite, self.links)):
            raise InputError(f"links are three lengths l, L and d in metres, got {self.links!r}")
        if min(self.links[:2]) <= 0 or self.links[2] < 0:
            raise InputError(
                f"links must be > 0, > 0 and ≥ 0 m, got {self.links!r}: they are the arms and the base; "
                "measure them between the axes"
            )

    def describe(self) -> str:
        """Which device, over what, which axis: one line."""
        lengths = ", ".join(shown(length, "m", 6) for length in self.links)
        return (
            f"Haply board at {self.port}, device {self.number}, {self.axis} of a pantograph "
            f"with links of {lengths}; no watchdog"
        )

    def _set_axis(self, memory: Array) -> None:
        memory[AXIS] = ("x", "y").index(self.axis)
        memory[ARMS : ARMS + 3] = np.array(self.links)


class HaplyMotor(_Haply):
    """One motor at port 1 of a Haply board, with its own encoder [rad, N·m]: a knob, a paddle.

    Parameters
    ----------
    port
        As of `HaplyPantograph`.
    counts, offset, rotation, motor
        As of `HaplyJoint`.
    number
        As of `HaplyPantograph`.
    """

    motion: ClassVar[Literal["linear", "rotary"]] = "rotary"

    def __init__(
        self,
        port: str,
        counts: float,
        *,
        offset: float | str = 0.0,
        rotation: str = "ccw",
        motor: str | None = None,
        number: int = 5,
    ) -> None:
        super().__init__(
            port, number, (HaplyJoint(1, rotation, in_si(offset, "rad", "offset"), counts, motor),)
        )

    def describe(self) -> str:
        """Which device, over what, which axis: one line."""
        return (
            f"Haply board at {self.port}, device {self.number}, the motor at port 1, "
            f"{self.joints[0].counts:g} counts per turn; no watchdog"
        )

    def _set_axis(self, memory: Array) -> None:
        memory[AXIS] = 2
