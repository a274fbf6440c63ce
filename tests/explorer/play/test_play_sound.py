"""What is heard: nothing of rest, a low tone of a press, and far more of a buzz."""

from __future__ import annotations

from pathlib import Path

import numpy as np
from explorer.play.engines import run_node

_RUN = """\
import { Waveform } from "OURS/sound.mjs";
const forces = {
    rest: () => 0,
    press: () => 2,
    buzz: (k) => 2 + (k % 4 < 2 ? 1 : -1),
    wobble: (k) => 2 * Math.sin((2 * Math.PI * 3 * k) / 1000),
};
const heard = {};
for (const [name, force] of Object.entries(forces)) {
    const wave = new Waveform(48000, 0.001, 4);
    for (let k = 0; k < 2000; k += 1) wave.push(force(k));
    heard[name] = [...wave.take()];
    if (wave.take().length) throw new Error("taken twice");
}
console.log(JSON.stringify(heard));
"""


def test_a_buzz_is_heard_above_a_press(tmp_path: Path) -> None:
    """48 samples of sound for each of a force at 1 kHz, none beyond 1; a wobble of 3 Hz is heard as well."""
    heard = {name: np.array(wave) for name, wave in run_node(_RUN, tmp_path).items()}
    loud = {name: float(wave[len(wave) // 2 :].std()) for name, wave in heard.items()}
    assert all(abs(wave.size - 96_000) <= 1 for wave in heard.values())
    assert all(np.abs(wave).max() <= 1.0 for wave in heard.values())
    assert loud["rest"] == 0.0
    assert 0.0 < loud["press"] < 0.2 * loud["buzz"]
    assert loud["wobble"] > loud["press"]
    spectrum = np.abs(np.fft.rfft(heard["buzz"][48_000:]))
    assert abs(int(spectrum.argmax()) - 250) <= 1
