"""Frames of a WebSocket: the examples of RFC 6455, and what no server may send."""

import os

import numpy as np
import pytest

from zwidth.machine.servo.devices.websocket import (
    BINARY,
    CLOSE,
    CONTINUATION,
    PING,
    PONG,
    TEXT,
    UNFINISHED,
    WRONG,
    header,
    is_last,
    kind_of,
    next_mask,
    put_frame,
)


def read(data):
    """(Kind, whether it is the last, where its payload starts, where it ends); or what was wrong."""
    first, start, end = header(np.frombuffer(data, np.uint8), 0, len(data))
    return first if first < 0 else (kind_of(first), is_last(first), start, end)


@pytest.mark.parametrize(
    ("frame", "found"),
    [
        ("81 05 48 65 6c 6c 6f", (TEXT, True, 2, 7)),
        ("01 03 48 65 6c", (TEXT, False, 2, 5)),
        ("80 02 6c 6f", (CONTINUATION, True, 2, 4)),
        ("89 05 48 65 6c 6c 6f", (PING, True, 2, 7)),
        ("8a 00", (PONG, True, 2, 2)),
        ("88 02 03 e8", (CLOSE, True, 2, 4)),
        ("82 7e 01 00", (BINARY, True, 4, 260)),
        ("82 7f 00 00 00 00 00 01 00 00", (BINARY, True, 10, 65546)),
    ],
)
def test_frames_of_the_standard(frame, found):
    """Section 5.7, and the closing; the payload need not have come."""
    assert read(bytes.fromhex(frame)) == found


@pytest.mark.parametrize("frame", ["", "81", "82 7e", "82 7e 01", "82 7f 00 00 00 00 00 01 00"])
def test_a_header_that_has_not_come_whole(frame):
    assert read(bytes.fromhex(frame)) == UNFINISHED


@pytest.mark.parametrize(
    ("frame", "why"),
    [
        ("c1 05", "a reserved bit"),
        ("81 85", "a masked payload"),
        ("83 00", "an unknown kind"),
        ("8b 00", "an unknown kind of control frame"),
        ("09 00", "a ping in parts"),
        ("89 7e 00 7e", "a ping of 126 bytes"),
        ("82 7f 80 00 00 00 00 00 00 00", "a length with its greatest bit set"),
    ],
)
def test_what_no_server_may_send(frame, why):
    assert read(bytes.fromhex(frame)) == WRONG, why


def test_the_masked_frame_of_the_standard():
    """Section 5.7: "Hello" under the mask 37 fa 21 3d."""
    into, payload = np.zeros(64, np.uint8), np.frombuffer(b"..Hello..", np.uint8)
    mask = int.from_bytes(bytes.fromhex("37 fa 21 3d"), "little")
    length = put_frame(TEXT, payload, 2, 5, mask, into)
    assert bytes(into[:length]).hex(" ") == "81 85 37 fa 21 3d 7f 9f 4d 51 58"


@pytest.mark.parametrize("count", [0, 1, 125, 126, 127, 300, 65_535])
def test_what_is_masked_is_the_payload_again(count):
    """By Python's integers: the payload is the frame's, exclusive or the mask repeated."""
    payload, into = np.frombuffer(os.urandom(count), np.uint8), np.zeros(count + 14, np.uint8)
    length = put_frame(BINARY, payload, 0, count, 0x12345678, into)
    at = 2 if count < 126 else 4
    frame = bytes(into[:length])
    assert frame[0] == 0x82
    assert frame[1] == 0x80 | (count if count < 126 else 126)
    assert count < 126 or int.from_bytes(frame[2:4], "big") == count
    assert length == at + 4 + count
    mask = (frame[at : at + 4] * (count // 4 + 1))[:count]
    plain = int.from_bytes(frame[at + 4 :], "big") ^ int.from_bytes(mask, "big")
    assert plain == int.from_bytes(payload.tobytes(), "big")


def test_masks_do_not_come_again():
    mask, seen = 0xDEADBEEF, set()
    for _ in range(100_000):
        mask = next_mask(mask)
        assert 0 < mask < 2**32
        seen.add(mask)
    assert len(seen) == 100_000
