"""A file of telemetry as the table of a log: times of the samples, positions as read, forces given."""

from __future__ import annotations

from collections.abc import Iterator
from pathlib import Path

from zwidth.data.logs.block import Finding
from zwidth.data.logs.served.contents import COLUMNS
from zwidth.data.logs.table import Table, Values
from zwidth.data.logs.telemetry.about import About
from zwidth.data.logs.telemetry.decoder import Decoder, Samples
from zwidth.data.logs.telemetry.packets import SYNC
from zwidth.errors import InputError

PIECE = 2**17
"""Bytes that are read at once."""


def is_telemetry(start: bytes) -> bool:
    """Whether there is a whole packet among the first bytes of a file."""
    if SYNC not in start:
        return False
    decoder = Decoder()
    try:
        return bool(decoder.take(start, last=True).size or decoder.about is not None)
    except InputError:
        return True  # of another version: who reads it says so


def telemetry_table(path: Path) -> Table:
    """The table of a file of telemetry; its columns are known by what they are called."""
    about = about_of(path)
    position, force = COLUMNS[about.motion]
    resolution = "resolution_m" if about.motion == "linear" else "resolution_rad"
    table = Table(
        source=str(path),
        units={"time_s": None, position: None, force: None},
        read=lambda names: _read(path, about, names, table.notes),
        attributes={
            "motion": about.motion,
            resolution: about.resolution,
            "certificate_sha256": about.certificate,
        },
        means={"time": "time_s", "position": position, "hand_force": None, "actuator_force": force},
    )
    return table


def about_of(path: Path) -> About:
    """What the first text of a file says."""
    decoder = Decoder()
    for _ in samples_of(path, decoder):
        if decoder.about is not None:
            break
    if decoder.about is None:
        raise InputError(
            f"{path} holds {decoder.packets} packets of telemetry and none that says what their numbers are: "
            "it comes every 64 packets, about once a second at 1 kHz; record for longer"
        )
    return decoder.about


def samples_of(path: Path, decoder: Decoder) -> Iterator[Samples]:
    """The samples of a file, piece by piece; the last piece may be empty."""
    with open(path, "rb") as file:
        while data := file.read(PIECE):
            yield decoder.take(data)
    yield decoder.take(b"", last=True)


def findings(decoder: Decoder) -> Iterator[Finding]:
    """What was missing."""
    if decoder.lost:
        text = (
            f"{decoder.lost} packets are missing, and {decoder.damaged} stretches of the file are no packet"
        )
        yield Finding(kind="packets lost", text=text)
    if decoder.dropped:
        text = f"{decoder.dropped} samples were not sent: the line was too slow for them"
        yield Finding(kind="samples dropped", text=text, samples=decoder.dropped)


def _read(
    path: Path, about: About, names: tuple[str, ...], notes: dict[str, Finding]
) -> Iterator[tuple[Values, ...]]:
    decoder = Decoder()
    position, force = COLUMNS[about.motion]
    for samples in samples_of(path, decoder):
        if samples.size:
            columns = {
                "time_s": samples.time(about),
                position: samples.position(about),
                force: samples.given(about),
            }
            yield tuple(columns[name] for name in names)
    notes.update((finding.kind, finding) for finding in findings(decoder))
