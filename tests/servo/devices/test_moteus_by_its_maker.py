"""Frames and lines of moteus, held against mjbots' own package, which writes and reads both ways."""

from __future__ import annotations

import asyncio
import io
import math

import moteus
import numpy as np
import pytest
from moteus import fdcanusb_device, multiplex, protocol
from servo.emulators.moteus import MoteusEmulator

from zwidth.machine.servo.devices.moteus_frames import (
    ANY,
    FAULT,
    MODE,
    RAW,
    RIGHT,
    TURNS,
    put_data,
    put_question,
    put_stop,
    put_torque,
    remainder,
    understood,
)

INT8, INT16, INT32, F32, IGNORE = range(5)
OUT = np.zeros(512, np.uint8)
LARGEST = float(np.finfo(np.float32).max)


def controller(identifier: int = 1, source: int = 0, transport: object = None) -> moteus.Controller:
    """Theirs, with registers of the types that ours have."""
    asked = moteus.QueryResolution()
    asked.velocity = asked.torque = asked.voltage = asked.temperature = IGNORE
    told = moteus.PositionResolution()
    told.position = told.velocity = told.kp_scale = told.kd_scale = told.ilimit_scale = INT8
    told.watchdog_timeout = INT16
    return moteus.Controller(
        identifier,
        query_resolution=asked,
        position_resolution=told,
        transport=transport or object(),
        source_can_id=source,
    )


def torque_of(torque: float, watchdog: float) -> dict[str, float]:
    """What theirs is asked for in the place of our torque."""
    scales = {"kp_scale": 0.0, "kd_scale": 0.0, "ilimit_scale": 0.0}
    motion = {"position": math.nan, "velocity": 0.0, "feedforward_torque": torque}
    return {**motion, **scales, "watchdog_timeout": watchdog}


def agree(count: int, command: moteus.Command) -> None:
    """The line that was written has their address and data, with a checksum that they take."""
    line = OUT[: count - 1].tobytes()
    plain, checked, right = fdcanusb_device._strip_and_validate_checksum(line)
    assert checked == right
    words = plain.split(b" ")
    assert words[:2] == [b"can", b"send"]
    assert int(words[2], 16) == command.reply_required << 15 | command.source << 8 | command.destination
    data = fdcanusb_device._dehexify(words[3])
    assert data[: len(command.data)] == command.data
    assert set(data[len(command.data) :]) <= {multiplex.NOP}


@pytest.mark.parametrize("checked", [False, True])
@pytest.mark.parametrize(("servo", "source"), [(1, 112), (111, 127), (42, 113)])
def test_questions_and_stops_are_theirs(servo: int, source: int, checked: bool) -> None:
    agree(put_question(OUT, servo, source, checked), controller(servo, source).make_query())
    agree(put_stop(OUT, servo, checked), controller(servo).make_stop())


@pytest.mark.parametrize(
    "torque", [0.0, -0.0, -0.37, 12.5, 2.0**-149, -LARGEST, LARGEST, math.inf, -math.inf, math.nan]
)
@pytest.mark.parametrize(
    ("watchdog", "seconds"), [(1, 0.001), (20, 0.02), (32_000, 32.0), (32_767, 40.0), (ANY, math.nan)]
)
def test_torques_are_theirs(torque: float, watchdog: int, seconds: float) -> None:
    """Every single, and the ends of 16 bits."""
    theirs = controller().make_position(**torque_of(torque, seconds))
    agree(put_torque(OUT, 1, torque, watchdog, True), theirs)


@pytest.mark.parametrize("said", [b"", b"conf get servo.timeout_mode\n", b"x" * 61])
def test_the_stream_of_text_is_theirs(said: bytes) -> None:
    """Padded as their own lines are."""
    for servo, theirs in (
        (0x0001, controller().make_diagnostic_write(said)),
        (0x8001, controller().make_diagnostic_read(48)),
    ):
        OUT[RAW : RAW + len(theirs.data)] = np.frombuffer(theirs.data, np.uint8)
        agree(put_data(OUT, servo, len(theirs.data), True), theirs)


@pytest.mark.parametrize("line", [b"", b"can send 8001 11001d01110f ", bytes(range(256))])
def test_the_checksum_of_a_line_is_theirs(line: bytes) -> None:
    assert remainder(np.frombuffer(line + b"\0", np.uint8).copy(), len(line)) == (
        fdcanusb_device._compute_crc8(line)
    )


@pytest.mark.parametrize("kind", [INT8, INT16, INT32])
@pytest.mark.parametrize(
    "turns", [0.0, -0.0, 0.25, -32768.0, 32767.998, 2.0**-149, LARGEST, math.inf, -math.inf, math.nan]
)
def test_an_answer_of_theirs_is_read_as_they_read_it(kind: int, turns: float) -> None:
    """Modes and faults at both ends of their type, and every single for a position."""
    end = 1 << (8 << kind) - 1
    for mode, fault in ((10, 0), (-end, end - 1), (end - 1, -end)):
        buffer = io.BytesIO()
        writer = protocol.Writer(buffer)
        for register, how, value in ((0x000, kind, mode), (0x001, F32, turns), (0x00F, kind, fault)):
            multiplex.WriteCombiner(writer, multiplex.REPLY_BASE, register, [how]).maybe_write()
            writer.write(value, how)
        theirs = protocol.parse_reply(buffer.getvalue())
        line = fdcanusb_device._append_checksum(b"rcv 170 " + buffer.getvalue().hex().encode() + b" E B F")
        memory = np.full(40, 7.0)
        assert understood(np.frombuffer(line, np.uint8).copy(), len(line), 1, 112, True, memory) == RIGHT
        found = [memory[MODE], memory[TURNS], memory[FAULT]]
        np.testing.assert_array_equal(found, [theirs[register] for register in (0x000, 0x001, 0x00F)])
        assert math.copysign(1.0, memory[TURNS]) == math.copysign(1.0, theirs[0x001])


@pytest.mark.parametrize("checksums", [False, True])
def test_their_host_on_our_emulator(checksums: bool) -> None:
    """It stops, gives torques, reads positions and a setting; a frame asks before it commands."""

    async def hosted(port: str) -> tuple[list[object], bytes]:
        async with moteus.Fdcanusb(port) as transport:
            other = controller(transport=transport)
            await other.set_stop()
            told = [await other.set_position(**torque_of(torque, 0.25), query=True) for torque in (0.0, -1.5)]
            text = moteus.Stream(other, use_flow_control=False)
            return told, await text.command(b"conf get servo.timeout_mode", allow_any_response=True)

    with MoteusEmulator([0.25, math.nan], checksums=checksums) as emulator:
        told, setting = asyncio.run(asyncio.wait_for(hosted(emulator.port), 60.0))
    found = [[one.values[register] for register in (0x000, 0x001, 0x00F)] for one in told]
    np.testing.assert_array_equal(found, [[0, 0.25, 0], [2, math.nan, 0]])
    assert setting == b"12.000000"
    assert [command.force for command in emulator.commands] == [0.0, -1.5]
    assert emulator.watchdogs == [0.25, 0.25]
    assert emulator.complaints == []
