"""Where in a recording it vibrates, how fast and how far.

    x(t) = a + c t + Σ_n (A_n cos nωt + B_n sin nωt) + rest,    n = 1 … 5

The stretch is the last one in which the motion, its drift over most of a second taken off, stays above a
third of its usual size.  The frequency is the peak of its spectrum; how far it is known, the scatter of
four pieces.
"""

from __future__ import annotations

from dataclasses import dataclass
from typing import TYPE_CHECKING

import numpy as np

if TYPE_CHECKING:
    from numpy.typing import NDArray

    Array = NDArray[np.float64]
    Phasors = NDArray[np.complex128]

LOWEST = 1.5
"""[Hz] what is slower is a movement of the hand."""

HARMONICS = 5
MOST_CYCLES = 25
FEWEST_CYCLES = 5

_BLOCK = 0.2
"""[s] pieces in which the size of the motion is looked at."""


@dataclass(frozen=True, kw_only=True)
class Vibration:
    """A stretch of a recording that vibrates.

    Parameters
    ----------
    rows
        Which of its rows.
    frequency, frequency_spread
        [Hz] and how far it is known, one standard deviation.
    swing
        [m; rad] from end to end of the motion, 5th to 95th percentile stretched to a sine's.
    regular
        Share of the motion's variance in the frequency and its harmonics, 0 to 1.
    growth
        [1/s] of the amplitude, 0 where it stays.
    """

    rows: slice
    frequency: float
    frequency_spread: float
    swing: float
    regular: float
    growth: float

    @property
    def angular(self) -> float:
        """[rad/s] ω."""
        return 2 * np.pi * self.frequency


def find(time: Array, position: Array, period: float) -> Vibration | None:
    """The stretch that vibrates; None where nothing goes to and fro often enough."""
    moving = position - _drift(position, period)
    rows = _stretch(moving, period)
    if rows.stop - rows.start < 16:
        return None
    y = _without_line(position[rows])
    if not y.any():
        return None
    frequency = peak(y, period)
    length = int(MOST_CYCLES / frequency / period)
    if rows.stop - rows.start > length >= 64:
        rows = slice(rows.stop - length, rows.stop)
        y = _without_line(position[rows])
        frequency = peak(y, period)
    if frequency * y.size * period < FEWEST_CYCLES:
        return None
    pieces = [peak(_without_line(part), period) for part in np.array_split(y, 4)]
    spread = max(float(np.std(pieces)) / 2, 0.02 / (y.size * period))
    _, rest = fitted(y, frequency, period)
    low, high = np.percentile(y - _slow(y, frequency, period), (5, 95))
    return Vibration(
        rows=rows,
        frequency=frequency,
        frequency_spread=spread,
        swing=float(high - low) / float(np.cos(np.pi * 0.05)),
        regular=float(1 - np.var(rest) / np.var(y)),
        growth=_growth(y),
    )


def phasors(values: Array, frequency: float, period: float) -> Phasors:
    """Complex amplitudes of the frequency and its harmonics: values ≈ Re Σ_n P_n exp(j n ω t), t from 0."""
    return fitted(values, frequency, period)[0]


def fitted(values: Array, frequency: float, period: float) -> tuple[Phasors, Array]:
    """The phasors, and what is left over."""
    t = np.arange(values.size) * period
    orders = [n for n in range(1, HARMONICS + 1) if n * frequency * period < 0.5]
    columns = [np.ones_like(t), t]
    for n in orders:
        columns += [np.cos(2 * np.pi * n * frequency * t), np.sin(2 * np.pi * n * frequency * t)]
    table = np.stack(columns, axis=1)
    solution = np.linalg.lstsq(table, values, rcond=None)[0]
    found = np.zeros(HARMONICS, dtype=np.complex128)
    found[: len(orders)] = solution[2::2] - 1j * solution[3::2]
    return found, values - table @ solution


def peak(values: Array, period: float) -> float:
    """[Hz] of the highest peak of the spectrum, weighted between position and velocity."""
    size = 4 * values.size
    spectrum = np.abs(np.fft.rfft((values - values.mean()) * np.hanning(values.size), size))
    frequencies = np.fft.rfftfreq(size, period)
    weighted = spectrum * frequencies**0.75
    weighted[frequencies < max(LOWEST, 2.5 / (values.size * period))] = 0.0
    k = int(np.argmax(weighted))
    if not 0 < k < weighted.size - 1:
        return float(frequencies[max(k, 1)])
    before, here, after = np.log(weighted[k - 1 : k + 2] + 1e-300)
    bend = before - 2 * here + after
    shift = 0.5 * (before - after) / bend if bend < 0 else 0.0
    return float(frequencies[k] + np.clip(shift, -1, 1) * (frequencies[1] - frequencies[0]))


def _drift(position: Array, period: float) -> Array:
    """A mean over about 0.7 s."""
    half = max(1, min(int(0.35 / period), position.size // 4))
    padded = np.pad(position, half, mode="edge")
    total = np.concatenate([[0.0], np.cumsum(padded)])
    mean: Array = (total[2 * half + 1 :] - total[: -2 * half - 1]) / (2 * half + 1)
    return mean


def _slow(y: Array, frequency: float, period: float) -> Array:
    """A mean over about two cycles."""
    half = max(1, min(int(1 / frequency / period), y.size // 4))
    padded = np.pad(y, half, mode="reflect")
    total = np.concatenate([[0.0], np.cumsum(padded)])
    mean: Array = (total[2 * half + 1 :] - total[: -2 * half - 1]) / (2 * half + 1)
    return mean


def _stretch(moving: Array, period: float) -> slice:
    """The longest stretch whose blocks stay above a third of the size of the large ones; the later of
    equals.
    """
    size = max(8, round(_BLOCK / period))
    blocks = moving.size // size
    if blocks < 3:
        return slice(0, moving.size)
    rms = moving[: blocks * size].reshape(blocks, size).std(axis=1)
    strong = rms > np.percentile(rms, 75) / 3
    best, start = (0, 0), None
    for k, on in enumerate([*strong, False]):
        if on and start is None:
            start = k
        elif not on and start is not None:
            if k - start >= best[1] - best[0]:
                best = (start, k)
            start = None
    stop = moving.size if best[1] == blocks else best[1] * size
    return slice(best[0] * size, stop)


def _without_line(y: Array) -> Array:
    k = np.arange(y.size)
    return y - np.polyval(np.polyfit(k, y, 1), k)


def _growth(y: Array) -> float:
    return (
        0.0
        if y.size < 64
        else float(np.log((np.std(y[-y.size // 4 :]) + 1e-300) / (np.std(y[: y.size // 4]) + 1e-300)))
    )
