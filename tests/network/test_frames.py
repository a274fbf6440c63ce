"""Frames: the same bytes always, nothing else accepted, each used once, and counted."""

import math
import random
import struct
import zlib

import pytest

from zwidth.links import Packet
from zwidth.network import Frame, Link
from zwidth.network.frame import MOST_NUMBERS
from zwidth.network.monitor import WINDOW


class Wire:
    """A list of datagrams that the test fills and empties."""

    def __init__(self):
        self.sent, self.coming = [], []

    def send(self, datagram):
        self.sent.append(datagram)

    def receive(self):
        found, self.coming = self.coming, []
        return found


def test_a_frame_comes_back_as_it_was():
    draw = random.Random(1)
    for n in (0, 1, 2, MOST_NUMBERS):
        frame = Frame(draw.randrange(2**64), tuple(draw.gauss(0, 1e3) for _ in range(n)), 1.5, 0.25, 1e-4)
        assert Frame.from_bytes(frame.to_bytes()) == frame
    first = Frame.from_bytes(Frame(0, (1.0,)).to_bytes())
    assert math.isnan(first.echo)
    with pytest.raises(ValueError, match="holds"):
        Frame(0, (0.0,) * (MOST_NUMBERS + 1)).to_bytes()


def test_nothing_else_is_a_frame():
    whole = Frame(7, (1.0, -2.0), 3.0, 2.0, 0.1).to_bytes()
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
        assert Frame.from_bytes(Frame(0, (bad,)).to_bytes()) is None
        assert Frame.from_bytes(Frame(0, (), bad).to_bytes()) is None
    wrong = whole[:44] + struct.pack("<I", 3) + whole[48:-4]
    assert Frame.from_bytes(wrong + struct.pack("<I", zlib.crc32(wrong))) is None


def packet(number, energy=0.0, wave=0.5):
    return Packet(number, wave, energy, 0.25)


def told(number, energy=0.0, sent=0.0):
    return Frame(number, (0.5, energy, 0.25), sent=sent).to_bytes()


def test_each_packet_is_taken_once_and_all_are_counted():
    now = [10.0]
    wire = Wire()
    link = Link(wire, clock=lambda: now[0])
    frames = {k: told(k, 0.25 * (k + 1), float(k)) for k in range(10)}
    wire.coming = [frames[0], frames[2], frames[2], frames[1], b"noise", frames[5]]
    assert link.receive() == [packet(k, 0.25 * (k + 1)) for k in (0, 2, 1, 5)]
    now[0] = 11.0
    wire.coming = [
        frames[1],
        frames[5],
        Frame(6, (1.0, 2.0)).to_bytes(),
        Frame(6, (1.0, -2.0, 0.0)).to_bytes(),
    ]
    assert link.receive() == []
    link.send(packet(0, 4.0))
    seen = link.report()
    assert (seen.received, seen.lost, seen.doubled, seen.late, seen.foreign) == (4, 2, 3, 1, 3)
    assert (seen.energy_received, seen.energy_sent) == (1.5, 4.0)
    assert (seen.rate, seen.silent) == (4.0, 1.0)
    assert math.isnan(seen.round_trip[0])
    assert "4 received" in repr(seen)
    back = Frame.from_bytes(wire.sent[0])
    assert (back.number, back.echo, back.held) == (0, 5.0, 1.0)


def test_the_round_trip_needs_no_common_clock():
    here, there = [0.0], [1e6]
    a, b = Wire(), Wire()
    one, other = Link(a, clock=lambda: here[0]), Link(b, clock=lambda: there[0])

    def wait(seconds):
        here[0] += seconds
        there[0] += seconds

    for k in range(200):
        one.send(packet(k))
        wait(0.003)
        b.coming, a.sent = a.sent, []
        other.receive()
        wait(0.010)
        other.send(packet(k))
        wait(0.004)
        a.coming, b.sent = b.sent, []
        one.receive()
    assert one.report().round_trip == pytest.approx((0.007, 0.007, 0.007), abs=1e-9)


def test_what_is_too_old_to_be_remembered_is_not_taken():
    wire = Wire()
    link = Link(wire)
    for k in range(3 * WINDOW):
        if k != 5:
            wire.coming.append(told(k))
    assert len(link.receive()) == 3 * WINDOW - 1
    wire.coming = [told(5), told(3 * WINDOW - 1)]
    assert link.receive() == []
    assert link.report().doubled == 2


def test_nothing_is_taken_for_what_an_earlier_run_sent():
    a, b = Wire(), Wire()
    one, other = Link(a), Link(b)
    one.call()
    other.call()
    a.coming, b.coming = list(b.sent), list(a.sent)
    assert one.call()
    assert other.call()
    a.sent.clear()
    for k in range(3):
        one.send(packet(k, 1.0 + k))
    late, b.coming = list(a.sent), list(a.sent)
    assert len(other.receive()) == 3
    third, fresh = Wire(), Wire()  # both start again, and what was on its way comes now
    again, new = Link(third), Link(fresh)
    again.call()
    new.call()
    third.coming, fresh.coming = list(fresh.sent), [*late, *third.sent]
    assert again.call()
    new.receive()
    again.send(packet(0, 0.5))
    fresh.coming = [*late, third.sent[-1]]
    new.call()
    fresh.coming = [*late, *third.sent]
    new.receive()
    assert new.report().energy_received == 0.5
