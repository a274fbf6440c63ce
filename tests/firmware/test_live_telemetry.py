"""Telemetry while it comes: the rows that live graphs draw."""

from __future__ import annotations

import io
from collections.abc import Iterator
from threading import Event

import numpy as np
import pytest
from firmware.written_packets import FIRST, SERVING, packed, samples, text

from zwidth.errors import InputError
from zwidth.machine.firmware.telemetry import LiveTelemetry
from zwidth.machine.servo.live.rows import ENERGY_OUT, FRICTION_LOSS, POSITION, Tally, Watched

COUNT, UNIT = 2.24e-5, 5 / 32767


class WrittenLine:
    def __init__(self, data: bytes, size: int = 37) -> None:
        self._pieces: Iterator[bytes] = iter([data[i : i + size] for i in range(0, len(data), size)])
        self.gone = Event()

    def read(self, size: int, /) -> bytes:
        piece = next(self._pieces, b"")
        if not piece:
            self.gone.set()
        return piece


def watched(data: bytes, **options: float) -> LiveTelemetry:
    line = WrittenLine(data)
    rows = LiveTelemetry(line, **options)
    assert line.gone.wait(60)
    rows.close()
    return rows


def motion(packets: int) -> tuple[np.ndarray, np.ndarray, list[bytes]]:
    k = np.arange(16 * packets)
    counts = np.rint(300 * np.sin(0.02 * k)).astype(int)
    forces = np.rint(9000 * np.cos(0.017 * k)).astype(int)
    return counts, forces, packed(counts.tolist(), forces.tolist())


def test_rows_are_what_a_served_loop_writes() -> None:
    counts, forces, made = motion(40)
    rows = watched(text() + b"".join(made), damping=0.15, coulomb_friction=0.02)
    news = Watched(rows).news()
    x, f = COUNT * counts, UNIT * forces
    moved = np.diff(x)
    work = np.concatenate([[0], -np.cumsum(f[:-1] * moved)])
    loss = np.concatenate([[0], np.cumsum(0.15 * moved**2 / 1e-3 + 0.02 * np.abs(moved))])
    assert (rows.period, rows.motion, news.skipped, news.missed) == (0.001, "linear", 0, 0)
    assert np.allclose(news.curves[:, POSITION], x, rtol=0, atol=1e-15)
    assert np.allclose(news.curves[:, ENERGY_OUT], work, rtol=0, atol=1e-12)
    assert np.allclose(news.curves[:, FRICTION_LOSS], loss, rtol=0, atol=1e-12)
    assert np.allclose(np.diff(news.times), 1e-3, rtol=0, atol=1e-12)
    tally = Tally(rows)
    tally.add(news)
    assert tally.line.startswith("serving, law 0 · at 0.6 s · +1.4")


def test_nothing_is_added_over_what_is_missing() -> None:
    """Between two packets with one lost the motion is not known; the clock goes on."""
    counts, forces, made = motion(10)
    news = Watched(watched(text() + b"".join(made[:4] + made[5:]))).news()
    x, f = COUNT * counts, UNIT * forces
    steps = -f[:-1] * np.diff(x)
    known = np.concatenate([steps[:63], steps[80:]]).sum()
    assert news.curves[-1, ENERGY_OUT] == pytest.approx(known, abs=1e-12)
    assert news.times[64] - news.times[63] == pytest.approx(0.017)


def test_time_goes_on_where_the_machine_is_started_anew() -> None:
    _, _, made = motion(6)
    again = samples(0, 0, [0] * 16, [0] * 16, status=SERVING | FIRST)
    news = Watched(watched(text() + b"".join(made) + again)).news()
    assert (np.diff(news.times) > 0).all()
    assert len(news.rows) == 7 * 16


def test_the_newest_rows_are_kept() -> None:
    _, _, made = motion(20)
    rows = watched(text() + b"".join(made), kept=100)
    count, found = rows.after(0)
    assert (count, len(found)) == (320, 100)
    assert found[-1, rows.COLUMNS.index("sample")] == 319
    count, found = rows.after(310)
    assert len(found) == 10


def test_a_line_that_never_says_what_its_numbers_are_is_refused() -> None:
    _, _, made = motion(3)
    for data in (b"", b"".join(made)):
        with pytest.raises(InputError, match="none said what"):
            LiveTelemetry(io.BytesIO(data))


def test_the_text_may_come_after_samples_and_say_radians() -> None:
    _, _, made = motion(3)
    rows = watched(b"".join(made) + text(flags=1))
    assert rows.after(0)[0] == 48
    assert {"position_rad", "force_N_m"} <= set(rows.COLUMNS)
