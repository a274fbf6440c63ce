"""What happened before and while the probe pushed: signs, the zero of the force, the surface, the end.

Depth is counted from where the probe meets the tissue, positive inside; force positive out of it.  What a
test is before its load says where both begin; a test that begins loaded has been loaded by a step just
before, as the file counts.  The whole history is kept: a ramp is a ramp, and no ideal step.
"""

from __future__ import annotations

from typing import NamedTuple

import numpy as np

from zwidth.compiled import Array
from zwidth.errors import InputError
from zwidth.identification.logs.block import Finding
from zwidth.identification.tissue.experiment.kind import Kind, changes, noise_of_differences
from zwidth.identification.tissue.experiment.tidy import FEWEST, Trial
from zwidth.identification.tissue.faults import hole_places
from zwidth.quantity.text import shown

TOUCH = 5.0
"""Times its noise by which the force shows that the probe touches."""

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
        Depth at which the probe seems to touch [m]; None where it touches from the start.
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
    """Signs, zero, surface and end of a test.

    Raises
    ------
    InputError
        If nothing pushes, or what is left is too short.
    """
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
    if time.size < FEWEST:
        raise InputError(f"{source}: the probe pushes for {time.size} samples only; {FEWEST} are needed")
    return _whole(time, x, f, kind, False, _surface(x, f, said), said, source)


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
    begins = hole_places(time, x if kind != "creep" else f, source)
    said.extend(_holes(time, begins))
    if begins and kind == "creep":
        raise InputError(
            f"{source} has a hole in time after t = {time[begins[0] - 1]:.4g} s, across which the force "
            "changes: how the tissue crept meanwhile is not known; give the part before it or after it"
        )
    return History(time, x, f, kind, loaded, surface, begins, tuple(said))


def _holes(time: Array, begins: tuple[int, ...]) -> list[Finding]:
    """Every hole in time, and what it does."""
    steps = np.diff(time)
    beside = np.median(np.lib.stride_tricks.sliding_window_view(np.pad(steps, 3, mode="edge"), 7), axis=1)
    holes = np.flatnonzero(steps > 5.0 * beside)
    said = []
    for k in holes[:3].tolist():
        moved = k + 1 in begins
        how = "what the branches hold after it is fitted" if moved else "what is held did not change"
        text = f"no samples from t = {time[k]:.4g} to {time[k + 1]:.4g} s: {how}"
        said.append(Finding(kind="hole", text=text))
    if holes.size > 3:
        said.append(Finding(kind="hole", text=f"and {holes.size - 3} other holes in time"))
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


def _surface(x: Array, f: Array, said: list[Finding]) -> float | None:
    """The depth at which the force begins, where the probe came from outside."""
    noise = noise_of_differences(f)
    touches = f > max(TOUCH * noise, SMALL * float(f.max()))
    first = int(np.argmax(touches))
    if first < 2 or x[first - 1] < SMALL * float(x.max()):
        return None
    after = slice(first, min(first + 6, x.size))
    slope, level = np.polyfit(x[after], f[after], 1) if np.ptp(x[after]) > 0 else (0.0, 0.0)
    guess = -level / slope if slope > 0 else x[first - 1]
    guess = float(np.clip(guess, x[max(first - 3, 0)] - 0.1 * x.max(), x[first]))
    text = f"the probe comes from outside and touches after {shown(guess, 'm', 3)}: that depth is fitted"
    said.append(Finding(kind="surface", text=text))
    return guess
