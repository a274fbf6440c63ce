"""Haply Inverse3, Inverse3x and Minverse, through the service that runs beside them (version 3.5).

The service listens for WebSockets on port 10001 and speaks JSON.  Once reached it tells of every device; from
then on it sends one state for each message that it gets (docs.haply.co, "WebSocket Protocol").  The message
here is the force, and the state that answers it has the position: each force leaves at once, and the position
that answers it is read one sample period later.  So the law works on a position that is one period old, less
the time that the loop needs between the two, and nothing is waited for as long as the service answers within
a period.  In a sampled loop that is the same as a force one sample late.

The service changes forces on their way (docs.haply.co, "Filters"): a damper of oscillations that cannot be
turned off, a force gate, damping, a factor.  A certificate knows none of these.
"""

from __future__ import annotations

import json
import os
import socket
import time
from contextlib import suppress
from typing import Any, ClassVar, Literal

import numpy as np

from zwidth.errors import InputError
from zwidth.machine.servo.connection import (
    CLOSED,
    DESCRIPTOR,
    FORCE,
    GARBLED,
    GOOD,
    INDEX,
    LEAVES,
    OWN,
    READING,
    REFUSED,
    REFUSES,
    SETS,
    SILENT,
    STALE,
    STATUS,
    TELLS,
    UNTIL,
    CompiledConnection,
    Opened,
    Setting,
    blank,
    exchanged,
)
from zwidth.machine.servo.devices import websocket
from zwidth.machine.servo.devices.json_text import (
    ABSENT,
    first_element,
    is_string,
    member,
    next_element,
    read_decimal,
    skip_space,
    write_decimal,
)
from zwidth.machine.servo.posix import Bytes, check_supported, now, pause, read_some, write_all
from zwidth.native.compiled import Array, compiled

# What the connection remembers: the last force given [N]; the position of the newest answer [m]; how many
# questions have no answer yet; how many answers came so far; bytes in the inbox, and how many of them are the
# payload of a message that goes on; number of the last sample; the next mask; which axis; of the command its
# length, where in it the number and the device's name stand, and how long the name is.
GIVEN, SEEN, PENDING, ANSWERS, HAVE, MESSAGE, LAST = range(OWN, OWN + 7)
MASK, AXIS, LENGTH, NUMBER, NAME, NAME_LENGTH = range(OWN + 7, OWN + 13)

_TEMPLATE = 512
"""Where in the outbox the command stands, unmasked; the frame that is sent is written from 0 on."""

_DECIMALS = 6
_WIDTH = 12 + _DECIMALS
_INBOX = 2 * 65536 + websocket.LONGEST_HEADER
_LONGEST_NAME = 64
_ANSWER_TIME = 2.0
_LAST_WORD = 0.5
_WHOLE_STATE = b'{"session":{"force_render_full_state":{}}}'
_ASKED_AGAIN, _BETWEEN = 4, 0.25
"""How often the service is asked for its devices where it lists none, and after how long [s]."""
_POLL = 20_000

_DEVICES, _ID, _STATE, _POSITION, _CONDITION, _READY = (
    np.frombuffer(name, np.uint8)
    for name in (b"inverse3", b"device_id", b"state", b"cursor_position", b"status", b"ready")
)
_AXES = np.frombuffer(b"xyz", np.uint8)


@compiled
def _ask(memory: Array, inbox: Bytes, outbox: Bytes) -> int:
    """Send the force given last; what has come before that is no answer to it."""
    if _take(memory, inbox, outbox) == CLOSED:
        return CLOSED
    number = _TEMPLATE + int(memory[NUMBER])
    end = write_decimal(memory[GIVEN], _DECIMALS, outbox, number)
    outbox[end : number + _WIDTH] = 32
    if not _send(memory, websocket.TEXT, outbox, _TEMPLATE, int(memory[LENGTH]), outbox):
        return CLOSED
    memory[PENDING] += 1
    return GOOD


@compiled
def _send(memory: Array, kind: int, payload: Bytes, start: int, count: int, outbox: Bytes) -> bool:
    """One frame; False if the system does not take it, and nothing can be sent behind half a frame."""
    mask = websocket.next_mask(int(memory[MASK]))
    memory[MASK] = mask
    length = websocket.put_frame(kind, payload, start, count, mask, outbox)
    return write_all(int(memory[DESCRIPTOR]), outbox, length)


@compiled
def _take(memory: Array, inbox: Bytes, outbox: Bytes) -> int:
    """Read what has come, and every whole message in it: the last one decides."""
    while True:
        count = read_some(int(memory[DESCRIPTOR]), inbox, int(memory[HAVE]))
        if count == -2:
            return CLOSED
        if count <= 0:
            return _frames(memory, inbox, outbox)
        memory[HAVE] += count


@compiled
def _frames(memory: Array, inbox: Bytes, outbox: Bytes) -> int:
    """Take whole frames off the inbox, whose first bytes are the payload of a message that goes on."""
    status, message, have = GOOD, int(memory[MESSAGE]), int(memory[HAVE])
    at = message
    while status != CLOSED:
        first, start, end = websocket.header(inbox, at, have)
        if first == websocket.WRONG or end - at > inbox.shape[0] - message:
            status = GARBLED
            break
        if first == websocket.UNFINISHED or end > have:
            break
        kind = websocket.kind_of(first)
        if kind == websocket.CLOSE:
            status = CLOSED
        elif kind == websocket.PING:
            if not _send(memory, websocket.PONG, inbox, start, end - start, outbox):
                status = CLOSED
        elif kind != websocket.PONG:
            _move(inbox, start, end, message)
            message += end - start
            if websocket.is_last(first):
                status = _answer(memory, inbox, message, outbox)
                message = 0
        at = end
    _move(inbox, at, have, message)
    memory[MESSAGE], memory[HAVE] = message, message + have - at
    return status


@compiled
def _move(data: Bytes, start: int, end: int, to: int) -> None:
    """Bytes towards the front, in their order."""
    if start != to:
        for place in range(end - start):
            data[to + place] = data[start + place]


@compiled
def _answer(memory: Array, text: Bytes, end: int, outbox: Bytes) -> int:
    """One state of the service: count it, and keep the position in it."""
    memory[PENDING] = max(0.0, memory[PENDING] - 1.0)
    memory[ANSWERS] += 1
    name = _TEMPLATE + int(memory[NAME])
    device = _find_device(text, end, outbox[name : name + int(memory[NAME_LENGTH])])
    if device < 0:
        return REFUSED if device == ABSENT else GARBLED
    status = member(text, device, end, _CONDITION)
    if status >= 0:
        ready = member(text, status, end, _READY)
        if ready >= 0 and text[ready] == ord("f"):
            return REFUSED
    at = member(text, device, end, _STATE)
    at = member(text, at, end, _POSITION) if at >= 0 else at
    axis = int(memory[AXIS])
    if at >= 0:
        at = member(text, at, end, _AXES[axis : axis + 1])
    if at < 0:
        return GARBLED
    value, behind = read_decimal(text, at, end)
    if behind < 0 or not np.isfinite(value):
        return GARBLED
    memory[SEEN] = value
    return GOOD


@compiled
def _find_device(text: Bytes, end: int, name: Bytes) -> int:
    """Where the object of the device of this name starts; ABSENT if the service does not have it, −1."""
    devices = member(text, skip_space(text, 0, end), end, _DEVICES)
    at = first_element(text, devices, end) if devices >= 0 else devices
    while at >= 0:
        if is_string(text, member(text, at, end, _ID), end, name):
            return at
        at = next_element(text, at, end)
    return at


@exchanged
def _measure(memory: Array, inbox: Bytes, outbox: Bytes) -> int:
    """The position that answers the last force; a newer one where that was not given in the last period."""
    if memory[PENDING] <= 0 or memory[INDEX] != memory[LAST] + 1:
        status = _ask(memory, inbox, outbox)
        if status != GOOD:
            return status
    memory[LAST] = memory[INDEX]
    before = memory[ANSWERS]
    while True:
        over = now() >= memory[UNTIL]  # the last look is after the time, see `frames.more_bytes`
        status = _take(memory, inbox, outbox)
        if status != GOOD:
            return status
        if memory[PENDING] <= 0:
            memory[READING] = memory[SEEN]
            return GOOD
        if over:
            if memory[HAVE] > 0:
                return GARBLED
            return STALE if memory[ANSWERS] > before else SILENT
        pause(_POLL)


@exchanged
def _apply(memory: Array, inbox: Bytes, outbox: Bytes) -> int:
    """The force as a message, whose answer the next measurement reads."""
    memory[GIVEN] = memory[FORCE]
    return _ask(memory, inbox, outbox)


class Inverse(CompiledConnection):
    """One axis of a Haply Inverse3 or Minverse, by its service; no force along the two others.

    Parameters
    ----------
    axis
        Of the service's frame, x to the right, y forward, z up unless the session is configured otherwise.
    device
        The `device_id` that the service gives it, "049D"; None takes the only one.
    address
        Where the service listens, "host:port".

    Raises
    ------
    InputError
        If the axis or the address is none.
    """

    motion = "linear"
    late = 1
    maker = "Inverse service 3.5, docs.haply.co"
    settings: ClassVar[tuple[Setting, ...]] = (
        ("set_cursor_force", "", "the force, of the other two axes 0", SETS, "WebSocket Protocol"),
        ("mount.scale, transform.scale", "1", "size: a scaled position is no metre", REFUSES,
         "WebSocket Protocol"),
        ("status.ready", "", "end: a device that is not ready gives no force", REFUSES, "WebSocket Protocol"),
        ("filters: force_gate, damping", "", "size: a force is filtered, a damper added", TELLS, "Filters"),
        ("damper of oscillations", "on", "size: always", TELLS, "Filters"),
        ("force_scale", "1", "size: a factor of all forces", LEAVES, "Filters"),
        ("gravity_compensation", "", "size: a force of the service's own is added", LEAVES, "Filters"),
        ("preset and basis of the session", "", "sign: which way x, y, z are", LEAVES, "WebSocket Protocol"),
    )  # fmt: skip
    measure = _measure
    apply = _apply

    _known: ClassVar[tuple[str, ...]] = ("x", "y", "z")

    def __init__(
        self,
        axis: Literal["x", "y", "z"] = "z",
        *,
        device: str | None = None,
        address: str = "localhost:10001",
    ) -> None:
        if axis not in self._known:
            raise InputError(f"the axis of an Inverse must be x, y or z, got {axis!r}")
        host, colon, port = address.rpartition(":")
        if not colon or not host or not port.isdecimal() or not 0 < int(port) < 65536:
            raise InputError(
                f"the address of the Inverse service must be host:port, localhost:10001, got {address!r}"
            )
        self.axis, self.device, self.address = axis, device, address
        self._host, self._port = host, int(port)
        self._filters = ""
        self._line: socket.socket | None = None
        self._opened: Opened | None = None

    def open(self, sample_period: float) -> Opened:
        """Reach the service, choose the device, give it force 0 and read one answer."""
        check_supported()
        line, behind = websocket.connect(self._host, self._port, "/", _ANSWER_TIME)
        self._line = line
        try:
            for again in range(_ASKED_AGAIN + 1):
                if again:  # for one that it has not found yet, as other clients do
                    time.sleep(_BETWEEN)
                    websocket.send_text(line, _WHOLE_STATE)
                message, behind = websocket.read_message(line, behind)
                if devices := _inventory(message, self.address):
                    break
            self._choose(devices)
            line.setblocking(False)
            self._opened = self._memory(line.fileno(), behind)
            self._try_once(self._opened)
        except InputError:
            self.close()
            raise
        except (AttributeError, TypeError, ValueError, OSError) as error:
            self.close()
            raise InputError(
                f"the service at {self.address} says what is not understood here: {error}"
            ) from None
        return self._opened

    def close(self) -> None:
        """Force 0, then the end of the line, once the service has read both."""
        line, self._line = self._line, None
        opened, self._opened = self._opened, None
        if line is None:
            return
        with suppress(OSError):
            if opened is not None:
                opened.memory[FORCE] = 0.0
                _apply(*opened)
                length = websocket.put_frame(websocket.CLOSE, opened.inbox, 0, 0, 1, opened.outbox)
                line.send(bytes(opened.outbox[:length]))
            # a line closed with bytes unread is reset, and the force 0 could be lost with it
            line.settimeout(_LAST_WORD)
            line.shutdown(socket.SHUT_WR)
            until = now() + _LAST_WORD * 1e9
            while line.recv(65536) and now() < until:
                pass
        line.close()

    @property
    def on_silence(self) -> str:
        """The service's documentation does not say it."""
        return "not documented: the service may hold the last force, and also when the line is lost"

    def describe(self) -> str:
        """Which device, over what, which axis, and what the service does to the force."""
        return (
            f"Haply Inverse {self.device or '(the only one)'}, axis {self.axis}, by its service at "
            f"{self.address}; the service filters the force{self._filters}, which no certificate covers; "
            "only an emulator of it has been met"
        )

    def _choose(self, devices: list[dict[str, Any]]) -> None:
        """The device asked for, or the only one; refused where its metres would not be metres."""
        names = [str(device.get("device_id")) for device in devices]
        if not devices:
            raise InputError(
                f"the service at {self.address} has no Inverse; is it plugged in, powered and calibrated?"
            )
        if self.device is None and len(devices) > 1:
            raise InputError(f"the service has several devices; give one of {', '.join(names)}")
        name = self.device or names[0]
        if name not in names:
            raise InputError(f"the service has no device {name!r}, but {', '.join(names)}")
        if not name.isascii() or not name.isalnum() or len(name) > _LONGEST_NAME:
            raise InputError(
                f"the device's name {name!r} is not of letters and digits, as the service gives them"
            )
        found = devices[names.index(name)]
        if found.get("status", {}).get("ready") is False:
            raise InputError(
                f"the Inverse {name} is not ready: {json.dumps(found['status'])}; look at it in the Haply Hub"
            )
        _check_scale(name, found)
        self.device = name
        filters = found.get("config", {}).get("filters")
        self._filters = f" ({json.dumps(filters)} and its damper of oscillations)" if filters else ""

    def _memory(self, descriptor: int, behind: bytes) -> Opened:
        """The command with room for one number, and nothing asked yet."""
        opened = blank(13, inbox=_INBOX, outbox=1024)
        head = f'{{"inverse3":[{{"device_id":"{self.device}","commands":{{"set_cursor_force":{{"values":{{'
        values = ",".join(f'"{axis}":{"#" * _WIDTH if axis == self.axis else "0"}' for axis in self._known)
        text = (head + values + "}}}}]}").encode()
        opened.outbox[_TEMPLATE : _TEMPLATE + len(text)] = np.frombuffer(text, np.uint8)
        opened.inbox[: len(behind)] = np.frombuffer(behind, np.uint8)
        memory = opened.memory
        memory[DESCRIPTOR], memory[HAVE] = descriptor, len(behind)
        memory[MASK] = int.from_bytes(os.urandom(4), "little") | 1
        memory[AXIS], memory[LENGTH] = self._known.index(self.axis), len(text)
        memory[NUMBER] = text.index(b"#")
        memory[NAME], memory[NAME_LENGTH] = text.index(str(self.device).encode()), len(str(self.device))
        return opened

    def _try_once(self, opened: Opened) -> None:
        """One question with force 0, and its answer."""
        opened.memory[UNTIL] = now() + _ANSWER_TIME * 1e9
        status = _measure(*opened)
        if status != GOOD:
            raise InputError(
                f"the service at {self.address} did not answer a force of 0 with a position of the device "
                f"{self.device}: {STATUS[status]}; version 3.5 of the service is spoken here"
            )


def _inventory(message: bytes, address: str) -> list[dict[str, Any]]:
    try:
        devices = json.loads(message).get("inverse3", [])
        if all(isinstance(device, dict) for device in devices):
            return list(devices)
    except (ValueError, AttributeError, TypeError):
        pass
    raise InputError(f"what listens at {address} sent no list of devices; is it the Haply Inverse service?")


def _check_scale(name: str, device: dict[str, Any]) -> None:
    """A scaled position is not metres, and the force along it would not be newtons."""
    places = (device.get("config", {}).get("mount", {}), device.get("state", {}).get("transform", {}))
    for place in places:
        scale = place.get("scale", {})
        if any(float(scale.get(axis, 1)) != 1.0 for axis in ("x", "y", "z")):
            raise InputError(
                f"the service scales the positions of {name} by {json.dumps(scale)}, so that they are not "
                "metres of the device and no stiffness is what it says; set the scale of its mount and its "
                "transform to 1"
            )
