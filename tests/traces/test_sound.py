"""The force as sound."""

from __future__ import annotations

import wave
from pathlib import Path

import numpy as np
import pytest

import zwidth as zw
from zwidth.loop.traces.files import RATE, waveform

PADDLE = zw.catalogue.device("haptic-paddle")


def _pressing(force: np.ndarray) -> object:
    """A trace whose actuator force is this, one value per millisecond."""
    positions = np.append(force, force[-1]) / 1000.0
    ideal = PADDLE.replace(resolution=0, force_resolution=None)
    motion = zw.operators.PrescribedMotion(positions)
    return zw.simulate(ideal, zw.Wall(1000.0), motion, len(force) / 1000, amplifier=zw.amplifiers.Ideal())


def test_a_buzz_of_100_hz_is_heard_as_100_hz(tmp_path: Path) -> None:
    """The file has the rate it says, one channel, and its strongest tone is that of the force."""
    trace = _pressing(1.0 + 0.2 * np.sin(2 * np.pi * 100 * np.arange(1000) / 1000))
    trace.zwidth.sound(tmp_path / "buzz.wav")
    with wave.open(str(tmp_path / "buzz.wav")) as file:
        assert (file.getnchannels(), file.getsampwidth(), file.getframerate()) == (1, 2, RATE)
        sound = np.frombuffer(file.readframes(file.getnframes()), "<i2").astype(float)
    assert sound.size == RATE
    tone = np.argmax(np.abs(np.fft.rfft(sound * np.hanning(sound.size))))
    assert tone == pytest.approx(100, abs=1)
    assert np.abs(sound).max() == 32767


def test_pressing_steadily_is_silent() -> None:
    assert not waveform(_pressing(np.full(500, 3.7))).any()


def test_no_contact_is_silence_and_no_crash() -> None:
    assert not waveform(_pressing(np.full(50, -1.0))).any()


def test_sound_is_a_wav_file(dowel, tmp_path: Path) -> None:
    with pytest.raises(zw.InputError, match=r"\.wav"):
        dowel.zwidth.sound(tmp_path / "buzz.mp3")
