"""telemetry.h, compiled here: what goes over the line is what was sampled, read by the format alone."""

from __future__ import annotations

import ctypes
from collections.abc import Iterable
from pathlib import Path

import numpy as np
import pytest
from firmware.tools import DATA, KINDS, UNIT, library
from firmware.written_packets import FIRST, SERVING, TEXT, unpacked
from strategies import seeds

from zwidth.data.logs.telemetry import Decoder

SENT = {1: 5 / 32767, 2: 5 / 32767, 3: 2**-12, 4: 0.01}
"""[N] in a unit that is sent: a share of the limit of 5 N, or the law's own where it is whole."""


@pytest.fixture(scope="module")
def folder(tmp_path_factory: pytest.TempPathFactory) -> Path:
    return tmp_path_factory.mktemp("sender")


def sender(folder: Path, kind: int = 1, *options: str) -> ctypes.CDLL:
    found = library(DATA / "sender.c", folder, f"-DLAW_KIND={kind}", *options)
    found.sample.argtypes = [ctypes.c_uint32, ctypes.c_int32, ctypes.c_double, ctypes.c_int]
    found.begin()
    return found


def drained(line: ctypes.CDLL, most: int = 10**9) -> bytes:
    found = bytearray()
    while len(found) < most and (byte := line.next()) >= 0:
        found.append(byte)
    return bytes(found)


def told(line: ctypes.CDLL, samples: Iterable[tuple[int, float]]) -> bytes:
    """What it sends of counts and forces, a millisecond apart, each as it comes."""
    data = b""
    for k, (counts, force) in enumerate(samples):
        line.sample(1000 * k, counts, force, SERVING)
        data += drained(line)
    return data


@pytest.mark.parametrize("kind", KINDS)
def test_every_sample_arrives(folder: Path, kind: int) -> None:
    """Positions exactly, forces to half a unit of what is sent; read by the decoder and by struct alike."""
    line, random = sender(folder, kind), np.random.default_rng(5)
    counts = np.cumsum(random.integers(-300, 300, 1000))
    forces = np.rint(random.uniform(-5, 5, 1000) / UNIT[kind]) if kind > 2 else random.uniform(-5, 5, 1000)
    forces[:2] = [5 / UNIT[kind], -5 / UNIT[kind]]
    data = told(line, zip(counts.tolist(), forces.tolist(), strict=True))
    line.close_packet()
    data += drained(line)
    texts, found = unpacked(data)
    assert len(texts) == 1
    assert [row[1] for row in found] == list(range(0, 1_000_000, 1000))
    assert [row[2] for row in found] == counts.tolist()
    assert [row[4] & FIRST for row in found] == [FIRST] * 16 + [0] * 984
    decoder = Decoder()
    samples = decoder.take(data, last=True)
    about = decoder.about
    assert about.force_unit == pytest.approx(SENT[kind], rel=1e-15)
    assert samples.counts.tolist() == counts.tolist()
    assert samples.force.tolist() == [row[3] for row in found]
    error = np.abs(samples.given(about) - forces * UNIT[kind])
    assert error.max() <= (0.51 * SENT[kind] if kind < 3 else 1e-12)
    assert (decoder.packets, decoder.lost, decoder.damaged, decoder.dropped) == (63, 0, 0, 0)


def test_it_fits_a_line_of_115200_baud_at_1_kilohertz(folder: Path) -> None:
    """Ten bits a byte: 11 520 bytes a second; the texts are counted as well."""
    sent = len(told(sender(folder), ((k % 400, 1.0) for k in range(10_000))))
    assert sent / 10 < 11_520
    assert sent / 10_000 < 5.5  # bytes a sample


def test_the_text_has_the_numbers_of_the_header_to_the_last_digit(folder: Path) -> None:
    texts, _ = unpacked(told(sender(folder), [(0, 0.0)] * (130 * 16)))
    assert texts == [TEXT] * 3


def test_a_force_beyond_what_can_be_sent_is_sent_as_the_largest(folder: Path) -> None:
    for kind in KINDS:
        line = sender(folder, kind)
        for k, force in enumerate((7.0, -7.0, 2e5, -2e5)):
            line.sample(1000 * k, 0, force / UNIT[kind], SERVING)
        line.close_packet()
        _, found = unpacked(drained(line))
        most = round(5 / SENT[kind])
        assert [row[3] for row in found] == [most, -most, most, -most]


def test_what_does_not_continue_a_packet_begins_another(folder: Path) -> None:
    """Another status, a sample that was left out, a way too far for 16 bits; a cut force does not."""
    line = sender(folder)
    rows = [
        (0, 0, SERVING), (1000, 1, SERVING), (2000, 2, SERVING | 0x40), (3000, 3, SERVING),
        (4000, 4, 2 | 2 << 2), (6000, 5, 2 | 2 << 2), (7400, 5 + 32767, 2 | 2 << 2),
        (8400, 5 - 32768, 2 | 2 << 2), (9400, -(2**31), 2 | 2 << 2), (10400, 2**31 - 1, 3),
    ]  # fmt: skip
    for time, counts, status in rows:
        line.sample(time, counts, 0.0, status)
    line.close_packet()
    _, found = unpacked(drained(line))
    assert [row[2] for row in found] == [counts for _, counts, _ in rows]
    assert [row[0] for row in found] == [0, 0, 0, 0, 1, 2, 2, 2, 3, 4]
    assert [row[4] & ~FIRST for row in found[:5]] == [SERVING | 0x40] * 4 + [2 | 2 << 2]


def test_what_finds_no_room_is_dropped_and_counted(folder: Path) -> None:
    line = sender(folder)
    for k in range(16 * 10):
        line.sample(1000 * k, k, 0.0, SERVING)
    line.close_packet()
    decoder = Decoder()
    first = decoder.take(drained(line))
    assert first.counts.tolist() == list(range(48))
    for k in range(160, 176):
        line.sample(1000 * k, k, 0.0, SERVING)
    line.close_packet()
    second = decoder.take(drained(line))
    assert second.counts.tolist() == list(range(160, 176))
    assert (decoder.dropped, decoder.lost) == (112, 0)


@seeds(8)
def test_a_packet_is_whole_however_samples_and_bytes_take_turns(folder: Path, seed: int) -> None:
    """The sampler and the sender share a ring: what is sent is in order, and was sampled."""
    random = np.random.default_rng(seed)
    line, data, k = sender(folder, 1, f"-DTELEMETRY_RING={random.choice([128, 256, 512, 4096])}"), b"", 0
    for _ in range(300):
        for _ in range(random.integers(0, 40)):
            line.sample(1000 * k, k, 0.0, SERVING)
            k += 1
        data += drained(line, int(random.integers(0, 200)))
    line.close_packet()
    data += drained(line)
    _, found = unpacked(data)
    counts = [row[2] for row in found]
    assert counts == sorted(set(counts))
    assert all(time == 1000 * n for _, time, n, _, _ in found)
    decoder = Decoder()
    decoder.take(data, last=True)
    assert decoder.lost == 0


def test_the_sequence_and_the_clock_go_round(folder: Path) -> None:
    line, data = sender(folder), b""
    line.continue_from(65535)
    start = 2**32 - 20_000
    for k in range(48):
        line.sample((start + 1000 * k) % 2**32, k, 0.0, SERVING)
        data += drained(line)
    line.close_packet()
    decoder = Decoder()
    samples = decoder.take(data + drained(line), last=True)
    assert np.allclose(samples.time(decoder.about), 1e-6 * (start + 1000 * np.arange(48)), rtol=0, atol=1e-9)
    assert decoder.lost == 0
    assert set(samples.start) == {0}
