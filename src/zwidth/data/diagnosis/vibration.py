"""Where in a recording it vibrates, how fast and how far.

    x(t) = a + c t + Σ_n (A_n cos nωt + B_n sin nωt) + rest,    n = 1 … 5

The stretch is the last one in which the motion, its drift over most of a second taken off, stays above a
third of its usual size.  The frequency is the peak of its spectrum; how far it is known, the scatter of
four pieces.
"""

from __future__ import annotations

from dataclasses import dataclass, replace
from itertools import chain
from typing import TYPE_CHECKING, Literal

import numpy as np

from zwidth.quantity.text import shown

if TYPE_CHECKING:
    from numpy.typing import NDArray

    from zwidth.native.compiled import Array

    Phasors = NDArray[np.complex128]

LOWEST = 1.5
"""[Hz] what is slower may be a movement of the hand, and must be regular to be a vibration."""

SLOWEST = 0.4
"""[Hz] of a regular one."""

QUICK = (12.0, 6.0, 3.0)
"""[Hz] at least, of a buzz in a part of a recording in which a hand moves: that motion is a drift to it."""

_IN_A_PART = 97.0
"""Percentile of the size of what shakes in a thirtieth of the recording or more."""

_EDGE = 1.25
"""Times the lower end of a search, below which its drift eats the motion: the other may see it better."""

_ROUNDING = 1e-9
"""Of the position: what is smaller is no motion."""

_REGULAR, _IRREGULAR = 0.85, 0.5
"""Share of the variance in the frequency and its harmonics."""

HARMONICS = 5
MOST_CYCLES = 25
FEWEST_CYCLES = 5
SHORTEST_CYCLES = 4
STEADY = 0.95
"""Share of the variance in the frequency and its harmonics from which a stretch is looked at as it is."""

_BLOCK = 0.2
"""[s] pieces in which the size of the motion is looked at."""

_DRIFT = 0.7
"""[s] over which a mean is taken for the drift."""


@dataclass(frozen=True, kw_only=True)
class Vibration:
    """A stretch of a recording that vibrates."""

    rows: slice
    """Which of its rows: those in which the frequency stays."""
    around: slice
    """Those in which it vibrates, these and more: a law is found where more happens."""
    frequency: float
    frequency_spread: float
    """[Hz] and how far it is known, one standard deviation."""
    swing: float
    """[m; rad] from end to end of the motion, 5th to 95th percentile stretched to a sine's."""
    regular: float
    """Share of the motion's variance in the frequency and its harmonics, 0 to 1."""
    regular_by_chance: float
    """The same with what as many free numbers would explain of noise taken off."""
    growth: float
    """Logarithm of the amplitude in the last quarter of `around` over that in the first, or twice that of
    its second half where it is more: what dies out goes on to, after a start it stays."""

    of_force: bool = False
    """Whether it is the force's, and the motion shows none."""

    @property
    def angular(self) -> float:
        """[rad/s] ω."""
        return 2 * np.pi * self.frequency


def find(position: Array, period: float, force: Array | None = None) -> Vibration | None:
    """The stretch that vibrates; None where nothing goes to and fro often enough.

    A slow one, a wheel that wobbles, is looked for where no faster one is found that is regular, and quick
    ones in a part, under the motion of a hand; each must itself be regular; else one of the force, in a part.
    """
    found = _above(LOWEST, position, period)
    if found is None or found.regular < _IRREGULAR or found.frequency < _EDGE * LOWEST:
        slow = _above(SLOWEST, position, period)
        if (
            slow is not None
            and slow.regular > _REGULAR
            and (
                found is None
                or (slow.frequency < LOWEST and found.regular < _IRREGULAR)
                or (slow.frequency > found.frequency / _EDGE and slow.regular > found.regular)
            )
        ):
            return slow
    if found is None or found.regular < _IRREGULAR:
        quick = (_above(lowest, position, period, _IN_A_PART) for lowest in QUICK)
        most = position.size if found is None else (found.around.stop - found.around.start) // 2
        jumps = () if force is None else (_reversing(position, force, period, most),)
        parts = (one for one in quick if one is not None and one.regular > _REGULAR)
        return next(chain(parts, filter(None, jumps)), found)
    return found


def _reversing(position: Array, force: Array, period: float, most: int) -> Vibration | None:
    """The longest stretch in which a force jumps to and fro over half of its range, whatever moves there."""
    jumps = np.diff(force)
    at = np.flatnonzero(np.abs(jumps) > 0.5 * np.ptp(force))
    back = at[1:][jumps[at[1:]] * jumps[at[:-1]] < 0]
    longest = max(np.split(back, np.flatnonzero(np.diff(back) * period > _BLOCK) + 1), key=len)
    rows = slice(int(longest[:1].sum()), int(longest[-1:].sum()) + 2)
    if longest.size < 2 * FEWEST_CYCLES or rows.stop - rows.start > most or not np.ptp(position[rows]):
        return None
    frequency = peak(_without_line(force[rows]), period)
    return replace(_measured(position, rows, rows, frequency, period), of_force=True)


def nothing(time: Array) -> str:
    """What is said of a recording in which nothing vibrates, and what it would take."""
    seconds = float(time[-1] - time[0])
    least = max(SLOWEST, FEWEST_CYCLES / seconds) if seconds else SLOWEST
    return (
        f"Nothing goes to and fro {FEWEST_CYCLES} times in the longest stretch without a gap, "
        f"{shown(seconds, 's', 2)}: only a vibration faster than {shown(least, 'Hz', 2)} would be seen."
    )


def _above(lowest: float, position: Array, period: float, large: float = 75.0) -> Vibration | None:
    """The vibration of no less than so many hertz."""
    slower = LOWEST / lowest
    moving = position - _mean(position, 0.5 * _DRIFT * slower, period, "edge")
    rows = _stretch(moving, period, _BLOCK * slower, large)
    if rows.stop - rows.start < 16:
        return None
    y = _without_line(position[rows])
    if np.std(y) <= _ROUNDING * np.abs(position).max():
        return None
    frequency = peak(y, period, lowest)
    length = int(MOST_CYCLES / frequency / period)
    if rows.stop - rows.start > length >= 64:
        rows = slice(rows.stop - length, rows.stop)
        y = _without_line(position[rows])
        frequency = peak(y, period, lowest)
    if frequency * y.size * period < FEWEST_CYCLES:
        return None
    around = rows
    rows, frequency = _steadiest(position, rows, frequency, period, lowest)
    return _measured(position, rows, around, frequency, period, lowest)


def _measured(
    position: Array, rows: slice, around: slice, frequency: float, period: float, lowest: float = LOWEST
) -> Vibration:
    """What is in these rows at that frequency."""
    y = _without_line(position[rows])
    pieces = [peak(_without_line(part), period, lowest) for part in np.array_split(y, 4)]
    spread = max(float(np.std(pieces)) / 2, 0.02 / (y.size * period))
    _, rest = fitted(y, frequency, period)
    whole = _without_line(position[around])
    regular = float(1 - np.var(rest) / np.var(y))
    orders = sum(n * frequency * period < 0.5 for n in range(1, HARMONICS + 1))
    freedom = max(y.size - 2 * orders - 3, 1)
    low, high = np.percentile(y - _mean(y, 1 / frequency, period, "reflect"), (5, 95))
    return Vibration(
        rows=rows,
        around=around,
        frequency=frequency,
        frequency_spread=spread,
        swing=float(high - low) / float(np.cos(np.pi * 0.05)),
        regular=regular,
        regular_by_chance=1 - (1 - regular) * (y.size - 1) / freedom,
        growth=max(_growth(whole), 2 * _growth(whole[whole.size // 2 :])),
    )


def _steadiest(
    position: Array, rows: slice, frequency: float, period: float, lowest: float
) -> tuple[slice, float]:
    """A shorter stretch where the frequency drifts in the whole one: half of it, down to so many cycles."""
    best = _share(position, rows, frequency, period)
    while best < STEADY:
        whole = rows.stop - rows.start
        half = max(whole // 2, int(np.ceil(SHORTEST_CYCLES / frequency / period)), 16)
        if half > 0.8 * whole:
            break
        tried = []
        for start in np.unique(np.linspace(rows.start, rows.stop - half, 5).astype(int)):
            part = slice(int(start), int(start) + half)
            own = peak(_without_line(position[part]), period, lowest)
            if abs(own - frequency) < 0.3 * frequency:
                tried.append((_share(position, part, own, period), part, own))
        if not tried or max(share for share, _, _ in tried) <= best:
            break
        best, rows, frequency = max(tried, key=lambda one: one[0])
    return rows, frequency


def _share(position: Array, rows: slice, frequency: float, period: float) -> float:
    """Of the motion's variance in the frequency and its harmonics."""
    y = _without_line(position[rows])
    return float(1 - np.var(fitted(y, frequency, period)[1]) / (np.var(y) or 1.0))


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


def peak(values: Array, period: float, lowest: float = LOWEST) -> float:
    """[Hz] of the highest peak of the spectrum, weighted between position and velocity."""
    size = 4 * values.size
    spectrum = np.abs(np.fft.rfft((values - values.mean()) * np.hanning(values.size), size))
    frequencies = np.fft.rfftfreq(size, period)
    weighted = spectrum * frequencies**0.75
    weighted[frequencies < max(lowest, 2.5 / (values.size * period))] = 0.0
    k = int(np.argmax(weighted))
    if not 0 < k < weighted.size - 1:
        return float(frequencies[max(k, 1)])
    before, here, after = np.log(weighted[k - 1 : k + 2] + 1e-300)
    bend = before - 2 * here + after
    shift = 0.5 * (before - after) / bend if bend < 0 else 0.0
    return float(frequencies[k] + np.clip(shift, -1, 1) * (frequencies[1] - frequencies[0]))


def _mean(values: Array, half_time: float, period: float, beyond: Literal["edge", "reflect"]) -> Array:
    """Over so long on either side, at most a quarter of all; and how they go on beyond their ends."""
    half = max(1, min(int(half_time / period), values.size // 4))
    total = np.concatenate([[0.0], np.cumsum(np.pad(values, half, mode=beyond))])
    return np.asarray((total[2 * half + 1 :] - total[: -2 * half - 1]) / (2 * half + 1))


def _stretch(moving: Array, period: float, block: float, large: float) -> slice:
    """The longest stretch whose blocks stay above a third of the size of the large ones, at that percentile;
    the later of equals."""
    size = max(8, round(block / period))
    blocks = moving.size // size
    if blocks < 3:
        return slice(0, moving.size)
    rms = moving[: blocks * size].reshape(blocks, size).std(axis=1)
    strong = np.flatnonzero(rms > np.percentile(rms, large) / 3)
    runs = np.split(strong, np.flatnonzero(np.diff(strong) > 1) + 1)
    longest = max(reversed(runs), key=len).tolist() or [0, -1]
    stop = moving.size if longest[-1] + 1 == blocks else (longest[-1] + 1) * size
    return slice(longest[0] * size, stop)


def _without_line(y: Array) -> Array:
    k = np.arange(y.size)
    return y - np.polyval(np.polyfit(k, y, 1), k)


def _growth(y: Array) -> float:
    return (
        0.0
        if y.size < 64
        else float(np.log((np.std(y[-y.size // 4 :]) + 1e-300) / (np.std(y[: y.size // 4]) + 1e-300)))
    )
