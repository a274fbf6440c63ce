"""What happened before and while the probe pushed: signs, the zero of the force, the surface, the end.

Depth is counted from where the probe meets the tissue, positive inside; force positive out of it.  What a
test is before its load says where both begin; a test that begins loaded has been loaded by a step just
before, as the file counts.  The whole history is kept: a ramp is a ramp, and no ideal step.
"""

from __future__ import annotations

from typing import NamedTuple

import numpy as np

from zwidth.data.logs.block import Finding
from zwidth.data.tissue.experiment.kind import Kind, changes, noise_of_differences
from zwidth.data.tissue.experiment.tidy import FEWEST, Trial
from zwidth.data.tissue.faults import MOST_HOLES
from zwidth.errors import InputError
from zwidth.native.compiled import Array
from zwidth.quantity.text import shown

TOUCH = 5.0
"""Times its noise by which the force shows that the probe touches."""

HOLE = 4.0
"""Times the longer of the intervals beside it by which one is a hole."""

SMALL = 0.02
"""Of the largest force, below which nothing is touched; and of the way, below which none was gone."""


class History(NamedTuple):
    """A test as it is fitted.

    Parameters
    ----------
    time
        From 0 [s].
    depth
        From where the probe starts, positive inward [m].
    force
        Less its zero before the load, positive out of the tissue [N].
    kind
        Which test it is.
    starts_loaded
        The step came before the first sample.
    surface
        Depth at which the probe may touch [m]; None where it touches from the start.
    begins
        Samples after a hole across which the probe moved.
    """

    time: Array
    depth: Array
    force: Array
    kind: Kind
    starts_loaded: bool
    surface: float | None
    begins: tuple[int, ...]
    findings: tuple[Finding, ...]


def history_of(trial: Trial, kind: Kind, source: str) -> History:
    """Signs, zero, surface and end of a test."""
    held = trial.force if kind == "creep" else trial.indentation
    loaded = kind != "loading" and not changes(held)
    x, f, said = _turned(trial, kind, loaded)
    if loaded:
        text = (
            "the test begins loaded: the step is taken to come just before the first sample, from 0 as the "
            "file counts"
        )
        said.append(Finding(kind="loaded", text=text))
        return _whole(trial.time, x, f, kind, True, None, said, source)
    zero = _zero(f)
    x, f = x - x[0], f - zero
    end = _end(x, f)
    if end < f.size:
        text = f"from t = {shown(float(trial.time[end]), 's', 3)} on the probe is out again: left out"
        said.append(Finding(kind="out", text=text, samples=f.size - end))
    time, x, f = trial.time[:end], x[:end], f[:end]
    surface = _surface(x, f)
    if surface is not None and kind == "creep":
        begin = max(int(np.argmax(x > surface)) - 1, 0)
        said.append(Finding(kind="surface", text="what comes before the probe touches is left out"))
        time, x, f, surface = time[begin:] - time[begin], x[begin:] - x[begin], f[begin:], None
    if time.size < FEWEST:
        raise InputError(f"{source}: the probe pushes for {time.size} samples only; {FEWEST} are needed")
    return _whole(time, x, f, kind, False, surface, said, source)


def _whole(
    time: Array,
    x: Array,
    f: Array,
    kind: Kind,
    loaded: bool,
    surface: float | None,
    said: list[Finding],
    source: str,
) -> History:
    holes = _holes(time)
    begins = _moved(holes, time, x if kind != "creep" else f)
    if len(begins) > MOST_HOLES:
        raise InputError(
            f"{source} has {len(begins)} holes in time across which the probe moved: what the tissue holds "
            "after each is not known; record without losing samples, or give a part with fewer"
        )
    said.extend(_of_holes(time, holes, begins))
    if begins and kind == "creep":
        raise InputError(
            f"{source} has a hole in time after t = {time[begins[0] - 1]:.4g} s, across which the force "
            "changes: how the tissue crept meanwhile is not known; give the part before it or after it"
        )
    return History(time, x, f, kind, loaded, surface, begins, tuple(said))


def _holes(time: Array) -> list[int]:
    """Intervals that are much longer than both beside them."""
    steps = np.diff(time)
    padded = np.concatenate([[0.0], steps, [0.0]])
    return np.flatnonzero(steps > HOLE * np.maximum(padded[:-2], padded[2:])).tolist()


def _moved(holes: list[int], time: Array, given: Array) -> tuple[int, ...]:
    """The samples after those holes across which what is given changed, or beside which it was moving."""
    span, noise = float(np.ptp(given)), TOUCH * noise_of_differences(given)

    def moves(k: int) -> bool:
        if abs(given[k + 1] - given[k]) > max(SMALL * span, noise):
            return True
        gap = time[k + 1] - time[k]
        for side in (slice(max(k - 4, 0), k + 1), slice(k + 1, k + 6)):
            way = float(np.ptp(given[side]))
            if way > max(noise, SMALL * span * float(np.ptp(time[side])) / gap):
                return True
        return False

    return tuple(k + 1 for k in holes if 1 < k + 1 < given.size - 1 and moves(k))


def _of_holes(time: Array, holes: list[int], begins: tuple[int, ...]) -> list[Finding]:
    """Every hole in time, and what it does."""
    said = []
    for k in holes[:3]:
        moved = k + 1 in begins
        how = "what the branches hold after it is fitted" if moved else "what is held did not change"
        text = f"no samples from t = {time[k]:.4g} to {time[k + 1]:.4g} s: {how}"
        said.append(Finding(kind="hole", text=text))
    if len(holes) > 3:
        said.append(Finding(kind="hole", text=f"and {len(holes) - 3} other holes in time"))
    return said


def _turned(trial: Trial, kind: Kind, loaded: bool) -> tuple[Array, Array, list[Finding]]:
    """Depth and force, both positive where the probe pushes."""
    x, f = trial.indentation, trial.force
    push = float(np.median(f)) if loaded else _furthest(f)
    if push == 0.0:
        raise InputError("the force never changes: nothing was pushed, or this is another column")
    if loaded and kind == "relaxation":
        way = float(np.median(x))
    elif loaded:
        way = float(x[-1] - x[0])
    else:
        way = float(x[int(np.argmax(np.abs(f - _zero(f))))] - x[0])
    if way == 0.0:
        raise InputError("the probe is nowhere but at 0: nothing was pushed in, or this is another column")
    said = []
    for name, sign in (("indentation", way), ("force", push)):
        if sign < 0:
            text = f"the {name} counts the other way in this file: turned round"
            said.append(Finding(kind="sign", text=text))
    return x * np.sign(way), f * np.sign(push), said


def _furthest(f: Array) -> float:
    from_zero = f - _zero(f)
    return float(from_zero[int(np.argmax(np.abs(from_zero)))])


def _zero(f: Array) -> float:
    """The force before the load: the mean of what comes before it leaves its noise."""
    noise = max(noise_of_differences(f), 1e-9 * float(np.ptp(f)))
    away = np.abs(f - np.median(f[:3])) > TOUCH * noise
    first = int(np.argmax(away)) if away.any() else f.size
    return float(np.mean(f[: max(min(first, f.size) - 1, 1)]))


def _end(x: Array, f: Array) -> int:
    """Where the probe is out again, after its largest force."""
    top = int(np.argmax(f))
    low = (f < SMALL * f[top]) & (x < 0.5 * x.max())
    low[: top + 1] = False
    return int(np.argmax(low)) if low.any() else f.size


def _surface(x: Array, f: Array) -> float | None:
    """The depth at which the force begins, where the probe may have come from outside."""
    touches = f > max(TOUCH * _noise_before(x, f), SMALL * float(f.max()))
    stays = touches & np.append(touches[1:], True) & np.append(touches[2:], [True, True])
    first = int(np.argmax(stays))
    if first < 2 or x[first] < SMALL * float(x.max()):
        return None
    after = slice(first, min(first + 6, x.size))
    slope, level = np.polyfit(x[after], f[after], 1) if np.ptp(x[after]) > 0 else (0.0, 0.0)
    guess = -level / slope if slope > 0 else x[first - 1]
    return float(np.clip(guess, 0.05 * x[first], x[first]))


def _noise_before(x: Array, f: Array) -> float:
    """Of the force, also where it is no quick one: as it was before the probe moved."""
    still = np.flatnonzero(np.abs(x) > SMALL * float(x.max()))
    before = f[: still[0]] if still.size else f
    quick = noise_of_differences(f)
    return max(quick, float(np.std(before))) if before.size >= 5 else quick


def about_surface(surface: float) -> Finding:
    """That it is fitted."""
    text = f"the probe comes from outside and touches after {shown(surface, 'm', 3)}: that depth is fitted"
    return Finding(kind="surface", text=text)
