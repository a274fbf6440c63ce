"""Lines and frames of mjbots' moteus: registers in a CAN frame, the frame as hexadecimal text.

    can send ADDRESS DATA        to the adapter (fdcanusb, mjcanfd-usb, or a moteus's own UART), which says OK
    rcv ADDRESS DATA flags       from it

An address of 16 bits is ``source · 256 + destination``; bit 15 asks for an answer, which goes to the source.
The data are groups of registers, one byte for what is done and the type of the values, the number of
registers in its low two bits or in a byte behind it, then the first register, then the values, little-endian.
A line may end in `` *XX``, the remainder of all before the asterisk divided by x⁸ + x⁷ + x⁴ + x² + x + 1;
from a UART it always does once the host's lines do, and lines of the host without one are then refused.

A stream of text goes through the same frames: 40 channel count TEXT to the controller, 42 channel most asks
for what it has to say, 41 channel count TEXT says it; channel 1 takes "conf get NAME" (mjbots, "Diagnostic
protocol"; lib/python/moteus/multiplex.py, lines 39 to 41).

Sources: mjbots, moteus documentation, "CAN protocol", "Register reference" and "UART"; fdcanusb, README.
"""

from __future__ import annotations

from zwidth.machine.servo.connection import OWN
from zwidth.machine.servo.devices.frames import get_float32, get_signed, put, put_float32
from zwidth.machine.servo.posix import Bytes
from zwidth.native.compiled import Array, compiled

# What a line is to the one who asked.
NOT_OURS, RIGHT, EARLIER, BROKEN, FAILED = range(5)

# What an answer says, in the memory of the connection: the mode, the fault, the position [turns].
MODE, FAULT, TURNS = range(OWN, OWN + 3)

NO_CHECKSUM = -1
"""In the place of a fault: the controller took no line, for it wants checksums."""

STOPPED, OPERATING = 0, 10
"""Of the register "mode"; between them are a fault (1) and what comes before operating (2 to 4)."""

ANY = -(1 << 15)
"""In 16 bits, what stands for no number: of the watchdog, that there is none."""

RAW = 256
"""Where in the outbox a frame is put together, before it is written as text at the beginning."""

_SEND = tuple(b"can send ")
_CHECKSUM = 0x97
_DIGITS = tuple(b"0123456789abcdef")


@compiled
def put_question(out: Bytes, servo: int, source: int, checked: bool) -> int:
    """Ask for mode, position and fault; how many bytes to send."""
    at = _bytes(out, RAW, (0x11, 0x00, 0x1D, 0x01, 0x11, 0x0F))
    return _line(out, 0x8000 | source << 8 | servo, at - RAW, checked)


@compiled
def put_torque(out: Bytes, servo: int, torque: float, watchdog: int, checked: bool) -> int:
    """A torque [N·m] in the position mode without its gains, good for `watchdog` [ms]; no answer comes.

    The integral part of the position loop has a scale of its own, and must be 0 as well.
    """
    at = _bytes(out, RAW, (0x01, 0x00, OPERATING, 0x02, 0x20, 0x80, 0x00, 0x0D, 0x22))
    at = put_float32(out, at, torque)
    at = put(out, _bytes(out, at, (0x02, 0x23, 0x00, 0x00, 0x05, 0x27)), 2, watchdog)
    at = _bytes(out, at, (0x01, 0x2B, 0x00))
    return _line(out, servo, at - RAW, checked)


@compiled
def put_stop(out: Bytes, servo: int, checked: bool) -> int:
    """The driver off and its faults forgotten."""
    at = _bytes(out, RAW, (0x01, 0x00, STOPPED))
    return _line(out, servo, at - RAW, checked)


@compiled
def put_data(out: Bytes, address: int, size: int, checked: bool) -> int:
    """A frame of the `size` bytes that stand at `RAW`, filled up to a length that there is on the bus."""
    at, length = RAW + size, size if size <= 8 else (size + 3) // 4 * 4
    if length > 24:
        length = 32 if length <= 32 else (48 if length <= 48 else 64)
    while at < RAW + length:
        out[at] = 0x50
        at += 1
    return _line(out, address, length, checked)


@compiled
def understood(line: Bytes, count: int, servo: int, source: int, checked: bool, memory: Array) -> int:
    """What a line without its end is; of the right one the numbers are written into the memory.

    The line is overwritten by the bytes that it spells.
    """
    if _begins(line, count, (69, 82, 82, 32, 99, 104, 101, 99, 107, 115, 117, 109)):  # ERR checksum
        memory[FAULT] = NO_CHECKSUM
    size = addressed(line, count, servo, source, checked)
    if size < 0:
        return -1 - size
    return RIGHT if _registers(line, size, memory) else BROKEN


@compiled
def addressed(line: Bytes, count: int, servo: int, source: int, checked: bool) -> int:
    """How many bytes the frame has that goes to this source, now at the line's beginning; else −1 − what."""
    if count == 0:
        return -1 - NOT_OURS
    count = _without_checksum(line, count, checked)
    if count < 2:
        return -1 - BROKEN
    if _begins(line, count, (69, 82, 82)):  # ERR
        return -1 - FAILED
    if count == 2 and line[0] == 79 and line[1] == 75:  # OK
        return -1 - NOT_OURS
    if not _begins(line, count, (114, 99, 118, 32)):  # rcv and a space
        return -1 - BROKEN
    at, address = 4, 0
    while at < count and line[at] != 32:
        digit = _digit(line[at])
        if digit < 0:
            return -1 - BROKEN
        address = address << 4 | digit
        at += 1
    if (address >> 8) & 0xFF != servo or address >> 16 != 0:
        return -1 - NOT_OURS
    size = _spelled(line, at + 1, count)
    if size < 0:
        return -1 - BROKEN
    return size if address & 0xFF == source else -1 - EARLIER


@compiled
def _bytes(out: Bytes, at: int, what: tuple[int, ...]) -> int:
    for i in range(len(what)):
        out[at + i] = what[i]
    return at + len(what)


@compiled
def _line(out: Bytes, address: int, size: int, checked: bool) -> int:
    """The text of a frame of so many bytes."""
    at = _bytes(out, 0, _SEND)
    for shift in (12, 8, 4, 0):
        out[at] = _DIGITS[(address >> shift) & 0xF]
        at += 1
    out[at] = 32
    at += 1
    for i in range(size):
        byte = int(out[RAW + i])
        out[at], out[at + 1] = _DIGITS[byte >> 4], _DIGITS[byte & 0xF]
        at += 2
    if checked:
        out[at] = 32
        rest = remainder(out, at + 1)
        out[at + 1], out[at + 2], out[at + 3] = 42, _DIGITS[rest >> 4], _DIGITS[rest & 0xF]
        at += 4
    out[at] = 10
    return at + 1


@compiled
def remainder(line: Bytes, count: int) -> int:
    """Of the first bytes of a line, divided by x⁸ + x⁷ + x⁴ + x² + x + 1, highest bit first."""
    rest = 0
    for i in range(count):
        rest ^= int(line[i])
        for _ in range(8):
            rest = ((rest << 1) ^ _CHECKSUM if rest & 0x80 else rest << 1) & 0xFF
    return rest


@compiled
def _without_checksum(line: Bytes, count: int, checked: bool) -> int:
    """How long the line is without it; −1 if it is wrong, or missing where there must be one."""
    star = count - 3
    if star < 0 or line[star] != 42:
        return -1 if checked else count
    high, low = _digit(line[star + 1]), _digit(line[star + 2])
    if high < 0 or low < 0 or high << 4 | low != remainder(line, star):
        return -1
    while star > 0 and line[star - 1] == 32:
        star -= 1
    return star


@compiled
def _begins(line: Bytes, count: int, word: tuple[int, ...]) -> bool:
    if count < len(word):
        return False
    same = True
    for i in range(len(word)):
        same = same and line[i] == word[i]
    return same


@compiled
def _digit(letter: int) -> int:
    """Of sixteen, in either case; −1 for what is none."""
    if 48 <= letter <= 57:
        return int(letter) - 48
    small = int(letter) | 32
    return small - 87 if 97 <= small <= 102 else -1


@compiled
def _spelled(line: Bytes, start: int, count: int) -> int:
    """Write the bytes that the word at `start` spells to the line's beginning; how many, −1 if it is none."""
    size = 0
    while start + 2 * size < count and line[start + 2 * size] != 32:
        if start + 2 * size + 1 >= count:
            return -1
        high, low = _digit(line[start + 2 * size]), _digit(line[start + 2 * size + 1])
        if high < 0 or low < 0:
            return -1
        line[size] = high << 4 | low
        size += 1
    return size


@compiled
def _registers(data: Bytes, size: int, memory: Array) -> bool:
    """Read the registers of an answer; False unless all that were asked for are there, and no others."""
    at, found = 0, 0
    while at < size:
        kind = int(data[at])
        at += 1
        if kind == 0x50:  # fills a frame up to a length that there is
            continue
        if kind & 0xF0 != 0x20 or at >= size:
            return False
        number, width = kind & 3, 1 << ((kind >> 2) & 3)
        width = min(width, 4)  # both whole numbers and floats of four bytes
        if number == 0:
            number = int(data[at])
            at += 1
        if at >= size or at + 1 + number * width > size:
            return False
        register = int(data[at])
        at += 1
        for i in range(number):
            found |= _kept(data, at, kind & 0x0C, width, register + i, memory)
            at += width
    return found == 7


@compiled
def _kept(data: Bytes, at: int, kind: int, width: int, register: int, memory: Array) -> int:
    """Remember one register; a bit for each of the three, 8 for any other."""
    if register == 0x001 and kind == 0x0C:
        memory[TURNS] = get_float32(data, at)
        return 2
    if kind == 0x0C or register not in (0x000, 0x00F):
        return 8
    memory[MODE if register == 0x000 else FAULT] = get_signed(data, at, width)
    return 1 if register == 0x000 else 4
