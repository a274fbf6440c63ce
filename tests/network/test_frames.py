"""Frames: the same bytes always, nothing else accepted, each used once, and counted."""

import math
import random
import struct
import zlib

import pytest
from network.tube import Tube

from zwidth.links import Packet
from zwidth.machine.network import Frame, Link
from zwidth.machine.network.peer import WINDOW


def test_a_frame_comes_back_as_it_was():
    draw = random.Random(1)
    for _ in range(20):
        held = Packet(
            draw.randrange(2**53), draw.gauss(0, 1e3), draw.random(), -0.5, draw.randrange(1, 2**64), 3
        )
        for one in (held, None):
            frame = Frame(one, 1.5, 0.25, 1e-4)
            assert Frame.from_bytes(frame.to_bytes()) == frame
    assert math.isnan(Frame.from_bytes(Frame(held).to_bytes()).echo)


def test_nothing_else_is_a_frame():
    whole = Frame(packet(7, 2.0), 3.0, 2.0, 0.1).to_bytes()
    draw = random.Random(2)
    for length in range(len(whole)):
        assert Frame.from_bytes(whole[:length]) is None
    assert Frame.from_bytes(whole + b"\0") is None
    for _ in range(2000):
        bent = bytearray(whole)
        bent[draw.randrange(len(bent))] ^= 1 << draw.randrange(8)
        assert Frame.from_bytes(bytes(bent)) is None
        assert Frame.from_bytes(draw.randbytes(draw.randrange(200))) is None
    for bad in (math.nan, math.inf):
        assert Frame.from_bytes(Frame(None, bad).to_bytes()) is None
    for wrong in (whole[:28] + b"x" + whole[29:-4], b"zw\x01\x00" + whole[4:-4]):
        assert Frame.from_bytes(wrong + struct.pack("<I", zlib.crc32(wrong))) is None


def packet(number, energy=0.0, run=1, to=2):
    return Packet(number, 0.5, energy, 0.25, run, to)


def told(number, energy=0.0, sent=0.0, **runs):
    return Frame(packet(number, energy, **runs), sent=sent).to_bytes()


def test_each_packet_is_taken_once_and_all_are_counted():
    now = [10.0]
    wire = Tube([], [])
    link = Link(wire, clock=lambda: now[0])
    frames = {k: told(k, 0.25 * (k + 1), float(k)) for k in range(10)}
    link.send(packet(0, run=2, to=0))
    wire.mine += [frames[0], frames[2], frames[2], frames[1], b"noise", frames[5]]
    assert link.receive() == [packet(k, 0.25 * (k + 1)) for k in (0, 2, 1, 5)]
    now[0] = 11.0
    wire.mine += [frames[1], frames[5], frames[6][:-1], b"zw\x01\x00" + bytes(72)]
    assert link.receive() == []
    link.send(packet(1, 4.0, run=2, to=1))
    seen = link.report()
    assert (seen.received, seen.lost, seen.doubled, seen.late, seen.foreign) == (4, 2, 3, 1, 3)
    assert (seen.energy_received, seen.energy_sent) == (1.5, 4.0)
    assert (seen.rate, seen.silent) == (4.0, 1.0)
    assert math.isnan(seen.round_trip[0])
    assert "4 received" in repr(seen)
    assert "3 datagrams, 1 of another version of zwidth" in repr(seen)
    back = Frame.from_bytes(wire.other[1])
    assert (back.packet.number, back.echo, back.held) == (1, 5.0, 1.0)


def test_the_round_trip_needs_no_common_clock():
    here, there = [0.0], [1e6]
    a, b = Tube.pair()
    one, other = Link(a, clock=lambda: here[0]), Link(b, clock=lambda: there[0])

    def wait(seconds):
        here[0] += seconds
        there[0] += seconds

    for k in range(200):
        one.send(packet(k))
        wait(0.003)
        other.receive()
        wait(0.010)
        other.send(packet(k, run=2, to=1))
        wait(0.004)
        one.receive()
    assert one.report().round_trip == pytest.approx((0.007, 0.007, 0.007), abs=1e-9)


def test_what_is_too_old_to_be_remembered_is_not_taken():
    wire = Tube([], [])
    link = Link(wire)
    for k in range(3 * WINDOW):
        if k != 5:
            wire.mine.append(told(k))
    assert len(link.receive()) == 3 * WINDOW - 1
    wire.mine += [told(5), told(3 * WINDOW - 1)]
    assert link.receive() == []
    assert link.report().doubled == 2


def test_each_run_of_the_other_side_is_counted_by_itself():
    """Its numbers begin anew; of energy what is for this side, and of what was sent what was for each run."""
    wire = Tube([], [])
    link = Link(wire)
    for k, (to, energy) in enumerate([(0, 1.0), (1, 2.0), (1, 3.0), (4, 0.5)]):
        link.send(packet(k, energy, run=2, to=to))
    wire.mine += [told(k, 0.5 * k) for k in (7, 9)]
    wire.mine += [told(k, 0.25 * k, run=4) for k in (0, 1, 1, 3)] + [told(10, 8.0, to=5)]
    assert len(link.receive()) == 6
    seen = link.report()
    assert (seen.received, seen.lost, seen.doubled, seen.late) == (6, 2, 1, 0)
    assert (seen.energy_sent, seen.energy_received) == (1.0 + 3.0 + 0.5, 4.5 + 0.75)
