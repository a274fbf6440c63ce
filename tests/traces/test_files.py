"""Traces in files: the same bits back, and never half a file; and as sound."""

from __future__ import annotations

import json
import wave
from pathlib import Path

import numpy as np
import pytest
import xarray as xr

import zwidth as zw
from zwidth.loop.traces.files import RATE, waveform

SUFFIXES = (".nc", ".parquet", ".csv")


@pytest.mark.parametrize("suffix", SUFFIXES)
@pytest.mark.parametrize("which", ["dowel", "finger", "knob"])
def test_a_trace_comes_back_as_it_was(which: str, suffix: str, tmp_path: Path, request) -> None:
    trace = request.getfixturevalue(which)
    path = tmp_path / f"touch{suffix}"
    trace.zwidth.save(path)
    back = zw.traces.load_trace(path)
    xr.testing.assert_identical(trace, back)
    assert repr(back.zwidth.energy) == repr(trace.zwidth.energy)
    assert [p.name for p in tmp_path.iterdir()] == [path.name]


def test_csv_says_the_unit_of_every_column(knob, dowel, tmp_path: Path) -> None:
    for trace, columns in (
        (dowel, {"time_s", "position_m", "velocity_m_per_s", "hand_force_N", "hand_work_J"}),
        (knob, {"position_rad", "velocity_rad_per_s", "actuator_force_N_m"}),
    ):
        trace.zwidth.save(tmp_path / "t.csv", force=True)
        header = (tmp_path / "t.csv").read_text(encoding="utf-8").splitlines()[1]
        assert columns <= set(header.split(","))


def test_csv_is_read_by_numpy_and_parquet_by_pyarrow(dowel, tmp_path: Path) -> None:
    """Nobody needs zwidth to read a trace."""
    import pyarrow.parquet as pq

    dowel.zwidth.save(tmp_path / "t.csv")
    dowel.zwidth.save(tmp_path / "t.parquet")
    table = np.genfromtxt(tmp_path / "t.csv", encoding="utf-8", delimiter=",", names=True, skip_header=1)
    assert (table["position_m"] == dowel.position.values).all()
    assert (pq.read_table(tmp_path / "t.parquet")["position_m"].to_numpy() == dowel.position.values).all()


@pytest.mark.parametrize("suffix", [*SUFFIXES, ".wav", ".png"])
def test_a_failed_write_leaves_the_old_file_and_nothing_else(suffix, dowel, tmp_path, monkeypatch) -> None:
    path = tmp_path / f"old{suffix}"
    path.write_bytes(b"precious")

    def full(*_: object) -> None:
        raise OSError(28, "No space left on device")

    monkeypatch.setattr("os.fsync", full)
    write = {".wav": lambda p: dowel.zwidth.sound(p, force=True), ".png": dowel.zwidth.plot}
    with pytest.raises(zw.InputError, match="No space left on device"):
        write.get(suffix, lambda p: dowel.zwidth.save(p, force=True))(path)
    assert path.read_bytes() == b"precious"
    assert list(tmp_path.iterdir()) == [path]


def test_a_file_is_not_replaced_unasked(dowel, tmp_path: Path) -> None:
    path = tmp_path / "t.nc"
    dowel.zwidth.save(path)
    with pytest.raises(zw.InputError, match="exists"):
        dowel.zwidth.save(path)
    dowel.zwidth.save(path, force=True)


@pytest.mark.parametrize(
    ("name", "says"),
    [("t.xlsx", "ends in .nc, .parquet, .csv"), ("no/t.nc", "there is no directory"), (".", "ends in")],
)
def test_a_place_that_cannot_be_is_refused(name: str, says: str, dowel, tmp_path: Path) -> None:
    with pytest.raises(zw.InputError, match=says):
        dowel.zwidth.save(tmp_path / name)


@pytest.mark.parametrize("suffix", SUFFIXES)
@pytest.mark.parametrize(
    "content",
    [b"", b"hello\nworld\n", b"# {}\na,b\n1,2\n", bytes(range(256)) * 20, None],
    ids=["empty", "words", "table", "bytes", "half a trace"],
)
def test_a_foreign_file_is_refused(suffix: str, content: bytes | None, dowel, tmp_path: Path) -> None:
    path = tmp_path / f"foreign{suffix}"
    if content is None:
        dowel.zwidth.save(path)
        content = path.read_bytes()[: path.stat().st_size // 2 - 7]
    path.write_bytes(content)
    with pytest.raises(zw.InputError) as caught:
        zw.traces.load_trace(path)
    assert "\n" not in str(caught.value)


def test_a_dataset_that_is_no_trace_is_refused() -> None:
    with pytest.raises(zw.InputError, match="no zwidth trace"):
        xr.Dataset({"a": 1}).zwidth  # noqa: B018


def test_the_attributes_are_plain_data(dowel) -> None:
    assert json.loads(json.dumps(dowel.attrs)) == dowel.attrs


# ---- the force as sound


def _pressing(force: np.ndarray) -> object:
    """A trace whose actuator force is this, one value per millisecond."""
    positions = np.append(force, force[-1]) / 1000.0
    ideal = zw.catalogue.device("haptic-paddle").replace(resolution=0, force_resolution=None)
    motion = zw.operators.PrescribedMotion(positions)
    return zw.simulate(ideal, zw.Wall(1000.0), motion, len(force) / 1000, amplifier=zw.amplifiers.Ideal())


def test_a_buzz_of_100_hz_is_heard_as_100_hz(tmp_path: Path) -> None:
    trace = _pressing(1.0 + 0.2 * np.sin(2 * np.pi * 100 * np.arange(1000) / 1000))
    trace.zwidth.sound(tmp_path / "buzz.wav")
    with wave.open(str(tmp_path / "buzz.wav")) as file:
        assert (file.getnchannels(), file.getsampwidth(), file.getframerate()) == (1, 2, RATE)
        sound = np.frombuffer(file.readframes(file.getnframes()), "<i2").astype(float)
    assert sound.size == RATE
    tone = np.argmax(np.abs(np.fft.rfft(sound * np.hanning(sound.size))))
    assert tone == pytest.approx(100, abs=1)
    assert np.abs(sound).max() == 32767


@pytest.mark.parametrize("force", [3.7, -1.0], ids=["a steady one", "no contact"])
def test_a_force_that_does_not_change_makes_no_sound(force: float) -> None:
    assert not waveform(_pressing(np.full(500, force))).any()


def test_sound_is_a_wav_file(dowel, tmp_path: Path) -> None:
    with pytest.raises(zw.InputError, match=r"\.wav"):
        dowel.zwidth.sound(tmp_path / "buzz.mp3")
