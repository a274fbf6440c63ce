"""Packets as bytes, links as schedules, and what is refused."""

from __future__ import annotations

import struct
import zlib
from fractions import Fraction

import numpy as np
import pytest

import zwidth as zw
from zwidth.links import Packet, Schedule, WavePort
from zwidth.links.schedule import LOST

PACKET = Packet(7, -1.5e-3, 2.25, -0.125, 2**64 - 1, 2**63)
MS = Fraction(1, 1000)


def test_a_packet_comes_back_from_its_bytes() -> None:
    """Runs, number, wave and sums, bit for bit."""
    data = PACKET.to_bytes()
    assert len(data) == Packet.SIZE == 56
    assert Packet.from_bytes(data) == PACKET


@pytest.mark.parametrize("bit", range(0, 8 * Packet.SIZE, 7))
def test_a_broken_packet_is_refused(bit: int) -> None:
    """One wrong bit anywhere."""
    data = bytearray(PACKET.to_bytes())
    data[bit // 8] ^= 1 << bit % 8
    with pytest.raises(zw.InputError, match="as if it were lost"):
        Packet.from_bytes(bytes(data))


@pytest.mark.parametrize("data", [b"", PACKET.to_bytes()[:-1], PACKET.to_bytes() + b"\0"])
def test_other_lengths_are_refused(data: bytes) -> None:
    """What is no packet at all."""
    with pytest.raises(zw.InputError, match="56 bytes"):
        Packet.from_bytes(data)


@pytest.mark.parametrize(
    ("data", "version"),
    [(struct.pack("<Qddd", 7, 0.0, 1.0, 0.0), 1), (b"zwp\x03" + PACKET.to_bytes()[4:-4] + bytes(9), 3)],
)
def test_packets_of_another_version_are_refused_in_a_sentence(data: bytes, version: int) -> None:
    """The first had no runs, and 36 bytes; of what is still to come the length is not known."""
    with pytest.raises(zw.InputError, match=f"of version {version}, and this port reads version 2"):
        Packet.from_bytes(data + struct.pack("<I", zlib.crc32(data)))


@pytest.mark.parametrize(
    ("numbers", "said"),
    [
        ((-1, 0.0, 0.0, 0.0, 1), "counts from 0"),
        ((0, float("nan"), 0.0, 0.0, 1), "wave of a packet"),
        ((0, 0.0, -1.0, 0.0, 1), "must be ≥ 0 J"),
        ((0, 0.0, 0.0, float("inf"), 1), "position of a packet"),
        ((0, 0.0, 0.0, 0.0, 0), "run of a packet is whole, from 1"),
        ((0, 0.0, 0.0, 0.0, 1, 2**64), "to of a packet is whole, from 0"),
    ],
)
def test_absurd_packets_are_refused(numbers: tuple[int, float, float, float, int], said: str) -> None:
    """No port ever hears of them."""
    with pytest.raises(zw.InputError, match=said):
        Packet(*numbers)


def test_a_port_refuses_what_it_cannot_book() -> None:
    """Bytes, displacements that are no counts or no numbers, delays of part of a sample."""
    device = zw.Device(damping=0.1, resolution="10 um", rate=1000, delay=0)
    port = WavePort(device)
    with pytest.raises(zw.InputError, match="Packet objects"):
        port.receive([PACKET.to_bytes()])
    with pytest.raises(zw.InputError, match="whole number of counts"):
        port.send(1.5e-5)
    port.receive()
    assert port.send(3e10).position == pytest.approx(3e10)  # so far out a double is no whole number of counts
    with pytest.raises(zw.InputError, match="finite"):
        port.send(float("nan"))
    with pytest.raises(zw.InputError, match="whole sample periods"):
        WavePort(device.replace(delay="0.5 ms"))
    with pytest.raises(zw.InputError, match="impedance must be > 0"):
        WavePort(device.replace(damping=0))


def test_a_schedule_keeps_to_its_numbers() -> None:
    """Delay and jitter in samples, the shares of what is lost and doubled, bursts of the length asked for."""
    count = 20_000
    link = Schedule(delay="3 ms", jitter="2 ms", loss=0.3, burst=5, duplicates=0.1)
    when, again = link.arrivals(count, MS, 0)
    kept = when != LOST
    late = (when - np.arange(1, count + 1))[kept]
    assert (late.min(), late.max()) == (4, 5)
    assert kept.mean() == pytest.approx(0.7, abs=0.03)
    starts = np.count_nonzero(np.diff(kept.astype(int)) == -1)
    assert np.count_nonzero(~kept) / starts == pytest.approx(5, rel=0.15)
    assert (again[kept] != LOST).mean() == pytest.approx(0.1, abs=0.02)
    assert np.all(again[~kept] == LOST)


def test_a_schedule_is_the_same_again_and_another_on_the_way_back() -> None:
    """By its seed."""
    link = Schedule(loss=0.5)
    there, same, back = (link.arrivals(100, MS, way)[0] for way in (0, 0, 1))
    other = Schedule(loss=0.5, seed=2).arrivals(100, MS, 0)[0]
    assert np.array_equal(there, same)
    assert not np.array_equal(there, back)
    assert not np.array_equal(there, other)
    link = Schedule(jitter="9 ms", loss=0.3, duplicates=0.5)
    few, more = link.arrivals(50, MS, 0), link.arrivals(300, MS, 0)
    assert all(np.array_equal(a, b[:50]) for a, b in zip(few, more, strict=True))


@pytest.mark.parametrize(
    ("given", "said"), [({"loss": 1}, "below 1"), ({"duplicates": 2}, "at most 1"), ({"delay": -1}, "≥ 0")]
)
def test_links_that_cannot_be_are_refused(given: dict[str, int], said: str) -> None:
    """With the bound."""
    with pytest.raises(zw.InputError, match=said):
        Schedule(**given)
