"""Lines of an ODrive's text protocol, read and written by compiled code.

Answers have no number of their own, and an ODrive still busy with one answer drops the next: so there is one
question at a time, and behind one that was not answered another of a different kind is asked first, whose
answer separates the old from the new.
"""

from __future__ import annotations

from math import pi

import numpy as np

from zwidth.machine.servo.connection import (
    CLOSED,
    DESCRIPTOR,
    FORCE,
    GARBLED,
    GOOD,
    OWN,
    READING,
    REFUSED,
    SILENT,
    STALE,
    UNTIL,
    exchanged,
)
from zwidth.machine.servo.devices.frames import dropped
from zwidth.machine.servo.devices.json_text import read_decimal, write_decimal
from zwidth.machine.servo.posix import Bytes, now, pause, read_some, write_all
from zwidth.native.compiled import Array, compiled

# What the connection remembers: bytes in the inbox; the position of the newest answer [rad]; whether a
# position, and whether the state, was asked for and not answered; whether the last measurement failed; in
# this one the answers to earlier questions, and the lines that were none; how many torques were given;
# whether the watchdog runs; where the lines in the outbox end.
HAVE, SEEN, POSITION_ASKED, STATE_ASKED, FAILED, OLD, BAD, COUNT, WATCHED = range(OWN, OWN + 9)
POSITION_END, STATE_END, ON_END, OFF_END, TORQUE_END = range(OWN + 9, OWN + 14)

# Where the lines that never change begin, and what the torque's begins with; it is sent from 0 on.
POSITION, STATE, ON, OFF, TORQUE = 128, 160, 224, 288, 352

TURN = 2.0 * pi
_DECIMALS = 6
_POLL = 20_000
_STATE_EVERY = 16
CLOSED_LOOP = 8
_ASTERISK, _NEWLINE, _RETURN, _BLANK = (ord(c) for c in "*\n\r ")


@compiled
def _take(memory: Array, inbox: Bytes) -> int:
    """Read what has come, and every whole line in it: GOOD, CLOSED, or REFUSED if the device says so."""
    while True:
        count = read_some(int(memory[DESCRIPTOR]), inbox, int(memory[HAVE]))
        if count == -2:
            return CLOSED
        if count <= 0:
            break
        memory[HAVE] += count
    status, have, start = GOOD, int(memory[HAVE]), 0
    for at in range(have):
        if inbox[at] == _NEWLINE:
            if _line(memory, inbox, start, at) == REFUSED:
                status = REFUSED
            start = at + 1
    if start == 0 and have == inbox.shape[0]:  # so long is no line
        memory[BAD] += 1
        start = have
    memory[HAVE] = dropped(inbox, start, have)
    return status


@compiled
def _line(memory: Array, text: Bytes, start: int, end: int) -> int:
    """One answer without its line end: position and velocity, a state, or words, which refuse a command."""
    end = _checked(text, start, end)
    if end < 0:
        memory[BAD] += 1
        return GARBLED
    value, at = read_decimal(text, start, end + 1)
    if at < 0 or not np.isfinite(value):
        memory[BAD] += 1 if at >= 0 else 0
        return REFUSED if at < 0 else GARBLED
    if at == end:
        if memory[STATE_ASKED] > 0:  # or it came twice, and separates nothing
            memory[STATE_ASKED] = memory[POSITION_ASKED] = 0
        return GOOD if value == CLOSED_LOOP else REFUSED
    _, at = read_decimal(text, at + 1, end + 1) if text[at] == _BLANK else (0.0, -1)
    if at != end:
        memory[BAD] += 1
        return GARBLED
    if memory[STATE_ASKED] > 0 or memory[POSITION_ASKED] == 0:
        memory[OLD] += 1
    else:
        memory[POSITION_ASKED] = 0
        memory[SEEN] = TURN * value
    return GOOD


@compiled
def _checked(text: Bytes, start: int, end: int) -> int:
    """Where the asterisk stands, if what is behind it is the checksum of what is before it; −1."""
    total, at = 0, start
    while at < end and text[at] != _ASTERISK:
        total ^= int(text[at])
        at += 1
    stop = end - 1 if end > start and text[end - 1] == _RETURN else end
    if stop - at < 2 or stop - at > 4:
        return -1
    given = 0
    for place in range(at + 1, stop):
        digit = int(text[place]) - 48
        if digit < 0 or digit > 9:
            return -1
        given = 10 * given + digit
    return at if given == total else -1


@compiled
def _send(memory: Array, outbox: Bytes, start: int, end: int) -> bool:
    """Lines that stand ready; a port that does not take so few bytes is gone."""
    return write_all(int(memory[DESCRIPTOR]), outbox[start:], end - start)


@compiled
def _wait(memory: Array, inbox: Bytes, flag: int) -> int:
    """Until the question of this flag has its answer: GOOD; or what went wrong."""
    while True:
        over = now() >= memory[UNTIL]  # the last look is after the time, see `frames.more_bytes`
        status = _take(memory, inbox)
        if status != GOOD or memory[flag] == 0:
            return status
        if over:
            if memory[HAVE] > 0 or memory[BAD] > 0:
                return GARBLED
            return STALE if memory[OLD] > 0 else SILENT
        pause(_POLL)


@compiled
def _append(outbox: Bytes, start: int, end: int, at: int) -> int:
    """A line that stands ready, behind what is to be sent."""
    for place in range(end - start):
        outbox[at + place] = outbox[start + place]
    return at + end - start


@compiled
def _put_torque(memory: Array, outbox: Bytes) -> int:
    at = _append(outbox, TORQUE, int(memory[TORQUE_END]), 0)
    at = write_decimal(memory[FORCE], _DECIMALS, outbox, at)
    total = 0
    for place in range(at):
        total ^= int(outbox[place])
    outbox[at] = _ASTERISK
    at += 1
    for unit in (100, 10, 1):
        if total >= unit or unit == 1:
            outbox[at] = 48 + total // unit % 10
            at += 1
    outbox[at] = _NEWLINE
    return at + 1


@exchanged
def ask_position(memory: Array, inbox: Bytes, outbox: Bytes) -> int:
    """The position; behind a measurement that failed the state first, see the top of the file."""
    status = _take(memory, inbox)
    if status != GOOD:
        return status
    if memory[FAILED] > 0 and memory[POSITION_ASKED] + memory[STATE_ASKED] > 0:
        memory[HAVE] = 0
        memory[STATE_ASKED] = 1
        if not _send(memory, outbox, STATE, int(memory[STATE_END])):
            return CLOSED
    memory[FAILED], memory[OLD], memory[BAD] = 1, 0, 0
    status = _wait(memory, inbox, STATE_ASKED)
    if status != GOOD:
        return status
    memory[POSITION_ASKED] = 1
    if not _send(memory, outbox, POSITION, int(memory[POSITION_END])):
        return CLOSED
    status = _wait(memory, inbox, POSITION_ASKED)
    if status == GOOD:
        memory[READING], memory[FAILED] = memory[SEEN], 0
    return status


@exchanged
def give_torque(memory: Array, inbox: Bytes, outbox: Bytes) -> int:
    """The torque; the watchdog with it where it begins or ends; now and then both again, and the state."""
    end = _put_torque(memory, outbox)
    watched = 1.0 if memory[FORCE] != 0.0 else 0.0
    often = memory[COUNT] % _STATE_EVERY == 0
    if often or watched != memory[WATCHED]:
        if watched > 0:
            end = _append(outbox, ON, int(memory[ON_END]), end)
        else:
            end = _append(outbox, OFF, int(memory[OFF_END]), end)
    if often and memory[FAILED] == 0:
        end = _append(outbox, STATE, int(memory[STATE_END]), end)
        memory[STATE_ASKED] = 1
    memory[WATCHED] = watched
    memory[COUNT] += 1
    return GOOD if _send(memory, outbox, 0, end) else CLOSED
