"""One WebSocket between this program and another (RFC 6455): opened in Python, used by compiled code.

A frame is two bytes (FIN and what it is; MASK and a length), the rest of a longer length, from a client a
mask of four bytes, and the payload.  A message is one data frame, or several whose last one has FIN; pings,
pongs and the closing may stand between them.  Only what a client on one machine needs is here: no extensions,
no subprotocols, no encryption.
"""

from __future__ import annotations

import base64
import hashlib
import os
import socket
from contextlib import suppress

import numpy as np

from zwidth.errors import InputError
from zwidth.machine.servo.posix import Bytes
from zwidth.native.compiled import compiled

_GUID = b"258EAFA5-E914-47DA-95CA-C5AB0DC85B11"
"""RFC 6455, section 1.3: what the answer to the handshake is made with."""

CONTINUATION, TEXT, BINARY, CLOSE, PING, PONG = 0x0, 0x1, 0x2, 0x8, 0x9, 0xA
_FIN, _RESERVED, _MASKED = 0x80, 0x70, 0x80

LARGEST_CONTROL = 125
"""Bytes in the payload of a ping, pong or closing frame."""

LONGEST_HEADER = 14

UNFINISHED, WRONG = -1, -2


def connect(host: str, port: int, path: str, seconds: float) -> tuple[socket.socket, bytes]:
    """The open line, and what came behind the handshake already."""
    where = f"ws://{host}:{port}{path}"
    try:
        line = socket.create_connection((host, port), timeout=seconds)
    except (OSError, ValueError) as error:  # ValueError: a host's name that cannot be one
        reason = getattr(error, "strerror", None) or str(error)
        raise InputError(f"nothing answers at {where}: {reason}") from None
    try:
        line.setsockopt(socket.IPPROTO_TCP, socket.TCP_NODELAY, 1)
        return line, _handshake(line, f"{host}:{port}", path)
    except (OSError, ValueError) as error:
        line.close()
        raise InputError(f"what answers at {where} is no WebSocket: {error}") from None


def _handshake(line: socket.socket, host: str, path: str) -> bytes:
    """Ask for the upgrade, check the answer; what came behind it."""
    key = base64.b64encode(os.urandom(16))
    line.sendall(
        f"GET {path} HTTP/1.1\r\nHost: {host}\r\nUpgrade: websocket\r\nConnection: Upgrade\r\n".encode()
        + b"Sec-WebSocket-Version: 13\r\nSec-WebSocket-Key: "
        + key
        + b"\r\n\r\n"
    )
    answer = b""
    while b"\r\n\r\n" not in answer:
        part = line.recv(4096)
        if not part or len(answer) > 65536:
            raise ValueError("it ended without an answer to the handshake")
        answer += part
    head, _, behind = answer.partition(b"\r\n\r\n")
    first, *lines = head.split(b"\r\n")
    if first.split()[1:2] != [b"101"]:
        raise ValueError(f"it said {first.decode(errors='replace')!r}")
    fields = {
        name.strip().lower(): value.strip() for name, _, value in (field.partition(b":") for field in lines)
    }
    if fields.get(b"sec-websocket-accept") != base64.b64encode(hashlib.sha1(key + _GUID).digest()):
        raise ValueError("its answer to the handshake belongs to another key")
    return behind


def read_message(line: socket.socket, behind: bytes) -> tuple[bytes, bytes]:
    """(The payload of the next message, what came behind it), waiting as long as the line's timeout."""
    message, data = b"", behind
    while True:
        first, start, end = header(np.frombuffer(data, np.uint8), 0, len(data))
        if first == WRONG or (first >= 0 and kind_of(first) == CLOSE):
            raise InputError("what listens there sent no WebSocket message where one was due")
        if first == UNFINISHED or end > len(data):
            data += _more(line)
            continue
        if kind_of(first) < CLOSE:
            message += data[start:end]
        data = data[end:]
        if kind_of(first) < CLOSE and is_last(first):
            return message, data


def send_text(line: socket.socket, text: bytes) -> None:
    """One message, before the loop; a line that is gone is told by the answer that does not come."""
    into = np.zeros(len(text) + LONGEST_HEADER, np.uint8)
    mask = int.from_bytes(os.urandom(4), "little")
    length = put_frame(TEXT, np.frombuffer(text, np.uint8).copy(), 0, len(text), mask, into)
    with suppress(OSError):
        line.sendall(bytes(into[:length]))


def _more(line: socket.socket) -> bytes:
    try:
        part = line.recv(65536)
    except OSError:
        part = b""
    if not part:
        raise InputError("what listens there sent no WebSocket message in time")
    return part


@compiled
def header(data: Bytes, start: int, end: int) -> tuple[int, int, int]:
    """(What the frame that starts here is, with FIN; where its payload starts; where it ends).

    (UNFINISHED, 0, 0) where the header has not come whole; (WRONG, 0, 0) for what no server may send:
    reserved bits, a masked payload, an unknown kind, a control frame in parts or too long.  The payload may
    reach beyond `end`.
    """
    if end - start < 2:
        return UNFINISHED, 0, 0
    first, second = int(data[start]), int(data[start + 1])
    kind, length, at = first & 0x0F, second & 0x7F, start + 2
    if first & _RESERVED or second & _MASKED or kind not in (CONTINUATION, TEXT, BINARY, CLOSE, PING, PONG):
        return WRONG, 0, 0
    if kind >= CLOSE and (not first & _FIN or length > LARGEST_CONTROL):
        return WRONG, 0, 0
    more = 2 if length == 126 else (8 if length == 127 else 0)
    if end - at < more:
        return UNFINISHED, 0, 0
    if more > 0:
        length = 0
        for place in range(more):
            length = (length << 8) | int(data[at + place])
        at += more
    if length < 0:  # the greatest bit of a length of 8 bytes is 0
        return WRONG, 0, 0
    return first & (_FIN | 0x0F), at, at + length


@compiled
def is_last(first: int) -> bool:
    """True where a message ends with this frame."""
    return first & _FIN != 0


@compiled
def kind_of(first: int) -> int:
    """CONTINUATION, TEXT, BINARY, CLOSE, PING or PONG."""
    return first & 0x0F


@compiled
def put_frame(kind: int, payload: Bytes, start: int, count: int, mask: int, into: Bytes) -> int:
    """Write one whole frame of a client, of 65 535 bytes at most, its payload masked; its length.

    The mask's 32 bits must be new for every frame; a mask protects from nothing on one machine, but a server
    closes a line without it (section 5.3).
    """
    into[0] = _FIN | kind
    if count <= LARGEST_CONTROL:
        into[1] = _MASKED | count
        at = 2
    else:
        into[1] = _MASKED | 126
        into[2] = count >> 8
        into[3] = count & 0xFF
        at = 4
    for place in range(4):
        into[at + place] = (mask >> (8 * place)) & 0xFF
    for place in range(count):
        into[at + 4 + place] = payload[start + place] ^ into[at + (place & 3)]
    return at + 4 + count


@compiled
def next_mask(mask: int) -> int:
    """Another one after this one: xorshift over 32 bits (Marsaglia, J. Statistical Software 8(14), 2003)."""
    mask ^= (mask << 13) & 0xFFFFFFFF
    mask ^= mask >> 17
    mask ^= (mask << 5) & 0xFFFFFFFF
    return mask
