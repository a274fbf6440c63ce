"""Files of telemetry: whole, cut, damaged; as a log, as a Dataset, to identify a device from."""

from __future__ import annotations

from pathlib import Path

import numpy as np
import pytest
from firmware.written_packets import FIRST, SERVING, TEXT, packed, packet, samples, text
from strategies import seeds

import zwidth as zw
from zwidth.data.logs.telemetry import Decoder
from zwidth.errors import InputError
from zwidth.machine.firmware.telemetry import REASONS, read_telemetry

ENDED_BY_A_JUMP = 2 | 2 << 2


def stroke(packets: int, *, first: int = 0) -> list[bytes]:
    """Packets of a sine: 16 samples each, positions within ±500 counts."""
    k = np.arange(16 * first, 16 * (first + packets))
    counts, forces = np.rint(500 * np.sin(0.01 * k)), np.rint(3000 * np.cos(0.013 * k))
    return packed(counts.astype(int).tolist(), forces.astype(int).tolist(), first)


def recorded(folder: Path, line: bytes) -> Path:
    (folder / "line.bin").write_bytes(line)
    return folder / "line.bin"


def test_a_log(tmp_path: Path) -> None:
    path = recorded(tmp_path, text() + b"".join(stroke(200)))
    log = zw.read_log(path)
    (block,) = log.blocks()
    k = np.arange(3200)
    assert (log.sample_period, log.resolution, log.samples) == (0.001, 2.24e-5, 3200)
    assert log.channels == ("actuator_force",)
    assert np.allclose(block.position, 2.24e-5 * np.rint(500 * np.sin(0.01 * k)), rtol=0, atol=1e-12)
    assert np.allclose(
        block.actuator_force, 5 / 32767 * np.rint(3000 * np.cos(0.013 * k)), rtol=0, atol=1e-12
    )


def test_a_rotary_law(tmp_path: Path) -> None:
    said = TEXT.replace("force_per_unit 1.0", "force_per_unit 0.0025")
    path = recorded(tmp_path, text(said, flags=3) + b"".join(stroke(200)))
    assert zw.read_log(path).motion == "rotary"
    data = read_telemetry(path)
    assert data.position.attrs["units"] == "rad"
    assert data.actuator_force.attrs["units"] == "N*m"
    assert data.actuator_force.values[1] == pytest.approx(0.0025 * round(3000 * np.cos(0.013)))


def test_a_dataset_that_is_a_log_as_well(tmp_path: Path) -> None:
    jumped = samples(200, 3_200_000, [0] * 16, [0] * 16, status=ENDED_BY_A_JUMP)
    path = recorded(tmp_path, text() + b"".join(stroke(200)) + jumped)
    data = read_telemetry(path)
    assert data.time.values[3199] == pytest.approx(3.199)
    assert data.phase.values[[0, 3200]].tolist() == [1, 2]
    assert "jumped" in REASONS[int(data.reason.values[-1])]
    assert data.attrs["certificate_sha256"].startswith("9f86d081")
    log = zw.Log.from_arrays(data)
    assert (log.samples, log.sample_period, log.resolution) == (3216, 0.001, 2.24e-5)


def test_a_recording_that_began_and_ended_within_a_packet(tmp_path: Path) -> None:
    packets = [*stroke(100), text(), *stroke(100, first=100)]
    path = recorded(tmp_path, b"".join(packets)[40:-40])
    data = read_telemetry(path)
    assert data.sizes["time"] == 16 * 198
    assert (data.attrs["lost_packets"], data.attrs["damaged_stretches"]) == (0, 0)
    assert zw.read_log(path).samples == 16 * 198


@seeds(12)
def test_damaged_and_lost_packets_are_counted_and_the_others_right(seed: int) -> None:
    """Any bit wrong, any packet missing, cut anywhere: what is read was sent, the rest is counted."""
    random = np.random.default_rng(seed)
    packets = [text(), *stroke(60)]
    lost = set(random.choice(np.arange(2, 59), 12, replace=False).tolist())
    damaged = {i for i in lost if random.random() < 0.5}
    line = bytearray()
    for i, one in enumerate(packets):
        if i in damaged:
            wrong = bytearray(one)
            wrong[random.integers(len(wrong))] ^= 1 << int(random.integers(8))
            line += wrong
        elif i not in lost:
            line += one
    decoder = Decoder()
    parts, at = [], 0
    while at < len(line):
        size = int(random.integers(1, 300))
        parts.append(decoder.take(bytes(line[at : at + size])))
        at += size
    parts.append(decoder.take(b"", last=True))
    sent = [i - 1 for i in range(1, 61) if i not in lost]
    counts = np.concatenate([part.counts for part in parts])
    k = np.concatenate([np.arange(16 * i, 16 * (i + 1)) for i in sent])
    assert counts.tolist() == np.rint(500 * np.sin(0.01 * k)).astype(int).tolist()
    assert decoder.lost == 12
    stretches = sum(i in damaged and i - 1 not in damaged for i in lost)
    bridged = sum(
        i in damaged and not {*range(j + 1, i)} - lost for i in damaged for j in damaged if j < i - 1
    )
    assert stretches - bridged <= decoder.damaged <= stretches


def test_what_looks_like_a_packet_within_one_is_none() -> None:
    """The bytes of a whole packet, checksum and all, as the forces and positions of another."""
    inner = samples(7, 0, [0], [0])  # 23 bytes: with one more, six positions and forces
    data = text() + packet(2, 3, bytes(11) + inner + b"\0")
    decoder = Decoder()
    found = decoder.take(data, last=True)
    assert found.size == 6
    assert (decoder.packets, decoder.damaged) == (1, 0)


def test_a_machine_that_is_started_anew(tmp_path: Path) -> None:
    begun = samples(0, 0, [0] * 16, [0] * 16, status=SERVING | FIRST)
    before, after = stroke(100, first=50), [begun, *stroke(99, first=1)]
    path = recorded(tmp_path, text() + b"".join(before) + text() + b"".join(after))
    data = read_telemetry(path)
    assert data.start.values.tolist() == [0] * 1600 + [1] * 1600
    assert data.time.values[1600] == 0.0
    assert (data.attrs["lost_packets"], data.attrs["dropped_samples"]) == (0, 0)
    assert zw.read_log(path).runs == 2


def test_a_gap_is_a_gap_of_the_log(tmp_path: Path) -> None:
    packets = stroke(200)
    path = recorded(tmp_path, text() + b"".join(packets[:90] + packets[95:]))
    log = zw.read_log(path)
    assert (log.runs, log.samples) == (2, 195 * 16)
    assert any(finding.kind == "packets lost" and "5 packets" in str(finding) for finding in log.findings)


def test_a_device_is_identified_from_its_telemetry(tmp_path: Path) -> None:
    mass, damping, resolution = 0.1, 0.8, 2.24e-5
    t = 0.001 * np.arange(20_000)
    x = 0.006 * np.sin(9.0 * t) + 0.004 * np.sin(23.0 * t)
    v = 0.054 * np.cos(9.0 * t) + 0.092 * np.cos(23.0 * t)
    a = -0.486 * np.sin(9.0 * t) - 2.116 * np.sin(23.0 * t)
    counts = np.floor(x / resolution).astype(int)
    forces = np.rint(-(mass * a + damping * v) / (5 / 32767)).astype(int)
    path = recorded(tmp_path, text() + b"".join(packed(counts.tolist(), forces.tolist())))
    found = zw.identify(path, mass=mass, model="viscous", zero="exact")
    assert found.estimates["damping"].value == pytest.approx(damping, rel=0.02)


@pytest.mark.parametrize(
    ("texts", "why"),
    [
        ([TEXT.replace("telemetry 1", "telemetry 2")], "telemetry 2"),
        ([TEXT.replace("period_s 0.001\n", "")], "period_s"),
        ([TEXT.replace("resolution 2.24e-05", "resolution 0.0")], "> 0"),
        ([TEXT.replace("force_most 5.0", "force_most (LIMIT)")], "numbers"),
        ([TEXT, TEXT.replace("2.24e-05", "1e-05")], "two laws"),
        ([], "says what"),
    ],
)
def test_a_text_that_says_too_little_or_too_much_is_refused(
    tmp_path: Path, texts: list[str], why: str
) -> None:
    """By one message, from both readers; counts are no lengths."""
    line = b"".join(stroke(20))
    path = recorded(tmp_path, b"".join(text(said) + line for said in texts) or line)
    for read in (zw.read_log, read_telemetry):
        with pytest.raises(InputError, match=why):
            read(path)


def test_a_table_that_has_the_two_letters_is_a_table(tmp_path: Path) -> None:
    """The checksum decides, not two bytes."""
    path = tmp_path / "zW.csv"
    rows = "".join(f"{0.001 * k:.3f},{np.sin(0.01 * k):.4f}\n" for k in range(500))
    path.write_text(f"# zW\ntime_s,position_m\n{rows}", encoding="utf-8")
    assert zw.read_log(path).samples == 500
