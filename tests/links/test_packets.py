"""Packets as bytes, links as schedules, what is refused, and what the page on links shows."""

from __future__ import annotations

import re
import struct
import zlib
from dataclasses import replace
from fractions import Fraction
from pathlib import Path
from typing import Any

import numpy as np
import pytest

import zwidth as zw
from zwidth.links import Packet, Schedule, WavePort
from zwidth.links.schedule import LOST

PAGE = Path(__file__).parents[2] / "docs" / "links.md"
PACKET = Packet(7, -1.5e-3, 2.25, -0.125, 2**64 - 1, 2**63)
MS = Fraction(1, 1000)
OLD = struct.pack("<Qddd", 7, 0.0, 1.0, 0.0)
"""The first version had no runs, and 36 bytes."""
LATER = b"zwp\x03" + PACKET.to_bytes()[4:-4] + bytes(9)
"""Of what is still to come the length is not known."""


def test_a_packet_comes_back_from_its_bytes() -> None:
    data = PACKET.to_bytes()
    assert len(data) == Packet._SIZE == 56
    assert Packet.from_bytes(data) == PACKET


def broken(bit: int) -> bytes:
    """With one wrong bit."""
    data = bytearray(PACKET.to_bytes())
    data[bit // 8] ^= 1 << bit % 8
    return bytes(data)


@pytest.mark.parametrize(
    ("data", "said"),
    [
        *((broken(bit), "as if it were lost") for bit in range(0, 8 * Packet._SIZE, 7)),
        *((data, "56 bytes") for data in (b"", PACKET.to_bytes()[:-1], PACKET.to_bytes() + b"\0")),
        (OLD + struct.pack("<I", zlib.crc32(OLD)), "of version 1, and this port reads version 2"),
        (LATER + struct.pack("<I", zlib.crc32(LATER)), "of version 3, and this port reads version 2"),
    ],
)
def test_what_is_no_packet_is_refused(data: bytes, said: str) -> None:
    with pytest.raises(zw.InputError, match=said):
        Packet.from_bytes(data)


@pytest.mark.parametrize(
    ("whole", "given", "said"),
    [
        (PACKET, {"number": -1}, "counts from 0"),
        (PACKET, {"wave": float("nan")}, "wave of a packet"),
        (PACKET, {"energy": -1.0}, "must be ≥ 0 J"),
        (PACKET, {"position": float("inf")}, "position of a packet"),
        (PACKET, {"run": 0}, "run of a packet is whole, from 1"),
        (PACKET, {"to": 2**64}, "to of a packet is whole, from 0"),
        (Schedule(), {"loss": 1}, "below 1"),
        (Schedule(), {"duplicates": 2}, "at most 1"),
        (Schedule(), {"delay": -1}, "≥ 0"),
    ],
)
def test_numbers_that_cannot_be_are_refused(whole: Any, given: dict[str, Any], said: str) -> None:
    with pytest.raises(zw.InputError, match=said):
        replace(whole, **given)


def test_a_port_refuses_what_it_cannot_book() -> None:
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
    link = Schedule(loss=0.5)
    there, same, back = (link.arrivals(100, MS, way)[0] for way in (0, 0, 1))
    other = Schedule(loss=0.5, seed=2).arrivals(100, MS, 0)[0]
    assert np.array_equal(there, same)
    assert not np.array_equal(there, back)
    assert not np.array_equal(there, other)
    link = Schedule(jitter="9 ms", loss=0.3, duplicates=0.5)
    few, more = link.arrivals(50, MS, 0), link.arrivals(300, MS, 0)
    assert all(np.array_equal(a, b[:50]) for a, b in zip(few, more, strict=True))


def test_the_first_example_of_the_page_runs(capsys: pytest.CaptureFixture[str]) -> None:
    names: dict[str, Any] = {}
    exec(re.findall(r"```python\n(.*?)```", PAGE.read_text(encoding="utf-8"), re.DOTALL)[0], names)
    assert re.fullmatch(r"-?\d\.\d\d N\n", capsys.readouterr().out)
