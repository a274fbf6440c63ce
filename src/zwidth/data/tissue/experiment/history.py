"""What happened before and while the probe pushed: signs, the zero of the force, the surface, the end.

Depth is counted from where the probe meets the tissue, positive inside; force positive out of it.  What a
test is before its load says where both begin; a test that begins loaded has been loaded by a step just
before, as the file counts.  The whole history is kept: a ramp is a ramp, and no ideal step.
"""

from __future__ import annotations

from collections.abc import Iterator
from itertools import pairwise
from typing import Literal, NamedTuple

import numpy as np

from zwidth.data.logs.table import Finding
from zwidth.data.tissue.experiment.columns import Raw
from zwidth.data.tissue.findings import MOST_HOLES
from zwidth.errors import InputError
from zwidth.native.compiled import Array
from zwidth.quantity.text import from_to, shown

TOUCH = 5.0
"""Times its noise by which the force shows that the probe touches."""

HOLE = 4.0
"""Times the longer of the intervals beside it by which one is a hole."""

SMALL = 0.02
"""Of the largest force, below which nothing is touched; and of the way, below which none was gone."""

PIECES = 40
"""Of a test, in each of which a mean speed and force are taken."""


class History(NamedTuple):
    """A test as it is fitted."""

    time: Array
    """From 0 [s]."""
    depth: Array
    """From where the probe starts, positive inward [m]."""
    force: Array
    """Less its zero before the load, positive out of the tissue [N]."""
    kind: Kind
    starts_loaded: bool
    """The step came before the first sample."""
    surface: float | None
    """Depth at which the probe may touch [m]; None where it touches from the start."""
    begins: tuple[int, ...]
    """Samples after a hole across which the probe moved."""
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
    if kind != "creep":
        _refuse_torn(time, x, f, source)
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
            f"{source} has a hole in time after t = {shown(time[begins[0] - 1], 's')}, across which the "
            "force changes: how the tissue crept meanwhile is not known; give the part before it or after it"
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
        text = f"no samples from t = {from_to(time[k], time[k + 1], 's')}: {how}"
        said.append(Finding(kind="hole", text=text))
    if len(holes) > 3:
        said.append(Finding(kind="hole", text=f"and {len(holes) - 3} other holes in time"))
    return said


def _turned(trial: Trial, kind: Kind, loaded: bool) -> tuple[Array, Array, list[Finding]]:
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


def _refuse_torn(time: Array, x: Array, f: Array, source: str) -> None:
    """Refuse a force that falls while the probe goes on, as where a needle breaks in or a specimen breaks. f
    = ∫ G(t − s) v(s) ds with G ≥ 0, so that at speeds between v and V it never falls below v/V of what it
    was; half of that here, for a probe that first gathers speed, and for speeds between the edges."""
    edges = np.linspace(0, time.size - 1, min(PIECES, time.size // 3) + 1).astype(int)
    speed = np.diff(x[edges]) / np.diff(time[edges])
    first = int(np.argmax(speed > 0.5 * speed.max()))
    level = np.array([f[a:b].mean() for a, b in pairwise(edges)])[first:]
    slowest, quickest = (each.accumulate(speed[first:]) for each in (np.minimum, np.maximum))
    least = 0.5 * np.maximum(slowest, 0.0) / quickest * np.maximum.accumulate(level)
    known = (
        (slowest > 0)
        & (least > TOUCH * noise_of_differences(f))
        & (time[edges[first + 1 :]] > 2 * time[edges[first]])
    )
    if (falls := known & (level < least)).any():
        end = int(np.argmax(falls))
        top, place = level[: end + 1].max(), edges[first + int(np.argmax(level[: end + 1]))]
        at = shown(float(time[place]), "s", 3)
        most, rest = (shown(float(value), "N", 3) for value in (top, level[end]))
        raise InputError(
            f"{source}: the force falls from {most} to {rest} while the probe goes on, from t = {at} on: "
            "something tears, yields or slips, and no model of a tissue here does; give the rows before "
            f"{at} in a file of their own"
        )


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
    text = f"the probe comes from outside and touches after {shown(surface, 'm', 3)}: that depth is fitted"
    return Finding(kind="surface", text=text)


# Which test it is, from the data: what is held.
#
# relaxation   the probe is held, and the force fades
# creep        the force is held, and the probe sinks in
# loading      neither is: the probe goes in, or in and out
#
# Held is what stays in a narrow band for most of the time.  Where both do, it is what stays there longer;
# where they do for nearly as long, as a force that has faded quickly does, it is the quieter: what a machine
# holds it holds by what it measures well.

Kind = Literal["relaxation", "creep", "loading"]
KINDS: tuple[Kind, ...] = ("relaxation", "creep", "loading")

BAND = 0.03
"""Of the range of a quantity, within which it is held."""

MOST = 0.45
"""Of the time, for which something is held in a relaxation or creep test."""

ALIKE = 0.05
"""Of the time; what is held for so little longer is not told apart by it."""

NOISES = 6.0
"""Times its noise, within which a quantity never changes."""


def kind_of(time: Array, indentation: Array, force: Array) -> Kind:
    probe, push = held_for(time, indentation), held_for(time, force)
    if max(probe, push) < MOST:
        return "loading"
    if abs(probe - push) < ALIKE:
        return "relaxation" if _noise(indentation) <= _noise(force) else "creep"
    return "relaxation" if probe >= push else "creep"


def held_for(time: Array, values: Array) -> float:
    """The share of the time for which a quantity stays within `BAND` of its range about one value."""
    span = float(np.ptp(values))
    noise = noise_of_differences(values)
    if span <= NOISES * noise or span == 0.0:
        return 1.0
    width = max(BAND * span, NOISES * noise)
    weight = np.gradient(time)
    order = np.argsort(values)
    ordered, total = values[order], np.concatenate([[0.0], np.cumsum(weight[order])])
    ends = np.searchsorted(ordered, ordered + width, side="right")
    return float((total[ends] - total[: ordered.size]).max() / total[-1])


def _noise(values: Array) -> float:
    """Of a quantity, as a share of its range."""
    span = float(np.ptp(values))
    return noise_of_differences(values) / span if span else 0.0


def noise_of_differences(values: Array) -> float:
    """The standard deviation of white noise on a smooth quantity, by its second differences."""
    if values.size < 4:
        return 0.0
    second = np.diff(values, 2)
    return float(np.median(np.abs(second - np.median(second)))) / 0.6745 / np.sqrt(6.0)


def changes(values: Array) -> bool:
    """True where a quantity goes further than its noise does."""
    return bool(np.ptp(values) > NOISES * noise_of_differences(values) and np.ptp(values) > 0)


FEWEST = 12
"""Samples below which nothing is fitted."""

BACK = 0.5
"""Of the time of a trial by which a stamp falls back where the next trial begins."""


class Trial(NamedTuple):
    """Times that increase from 0, indentation and force as they stand in the file [s], [m], [N]."""

    time: Array
    indentation: Array
    force: Array
    findings: tuple[Finding, ...]


def one_trial(raw: Raw, number: int = 1) -> Trial:
    """The trial of a number from 1, of those that come one after the other."""
    said = list(raw.findings)
    parts, gone = _parts(raw)
    if gone:
        text = f"{gone} of {raw.time.size} rows lack a number and are left out"
        said.append(Finding(kind="missing", text=text, samples=gone))
    part, more = _in_order(parts[number - 1])
    said.extend(more)
    if part.shape[1] < FEWEST:
        raise InputError(
            f"{raw.source}: {part.shape[1]} samples are left; a fit of a tissue needs {FEWEST} at the least"
        )
    return Trial(part[0] - part[0, 0], part[1], part[2], tuple(said))


def places(raws: list[Raw]) -> list[tuple[Raw, int]]:
    """Every trial: where it stands, and its number there."""
    return [(raw, k + 1) for raw in raws for k in range(len(_parts(raw)[0]))]


def _parts(raw: Raw) -> tuple[list[Array], int]:
    """The rows of each trial, and how many rows lack a number."""
    table = np.stack([raw.time, raw.indentation, raw.force])
    finite = np.isfinite(table).all(axis=0)
    label = None if raw.trial is None else raw.trial[finite]
    return _trials(table[:, finite], label), int(np.count_nonzero(~finite))


def _trials(table: Array, label: Array | None) -> list[Array]:
    """Cut where the label changes, or where the time falls back by much of a trial."""
    if not table.shape[1]:
        return [table]
    if label is not None and np.unique(label).size > 1:
        cuts = np.flatnonzero(np.diff(label) != 0) + 1
    else:
        time = table[0]
        cuts_list, begin = [], 0
        for k in (np.flatnonzero(np.diff(time) < 0) + 1).tolist():
            if time[k - 1] - time[k] > BACK * (time[k - 1] - time[begin]):
                cuts_list.append(k)
                begin = k
        cuts = np.array(cuts_list, dtype=int)
    return [part for part in np.split(table, cuts, axis=1) if part.shape[1]]


def _in_order(part: Array) -> tuple[Array, Iterator[Finding]]:
    """Sorted by time, and of samples with one stamp the mean."""
    said = []
    if (np.diff(part[0]) < 0).any():
        out = int(np.count_nonzero(np.diff(part[0]) < 0))
        said.append(Finding(kind="order", text=f"{out} stamps go back: the rows are sorted", samples=out))
        part = part[:, np.argsort(part[0], kind="stable")]
    stamps, where, counts = np.unique(part[0], return_inverse=True, return_counts=True)
    if stamps.size < part.shape[1]:
        same = part.shape[1] - stamps.size
        text = f"{same} rows repeat the stamp before: of such samples the mean is taken"
        said.append(Finding(kind="repeated", text=text, samples=same))
        means = [np.bincount(where.ravel(), weights=column) / counts for column in part[1:]]
        part = np.stack([stamps, *means])
    return part, iter(said)
