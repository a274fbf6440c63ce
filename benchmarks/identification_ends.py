"""What do faulty recordings make of the identified finger and the fitted tissue, and is anything said?

    python benchmarks/identification_ends.py [--runs 100] [--seed 0] [--only finger|tissue|tracked]

Fingers of 3 to 15 g, 0.5 to 4 N s/m, 150 to 1200 N/m hold the haptic paddle while steps of ± 1 N shake
it, 20 s at 1 kHz, with a tremor of 0.05 N and 0.02 N of noise in the load cell.  Tissues of 50 to 2000 N/m at
rest, 0.2 to 1.5 times that in the branch and 20 to 300 ms of relaxation are moved by some millimetres, 10 s
at 500 Hz, with noise of 1 % of the force.  All are drawn at random, and every cause by itself is put into a
recording whose truth is known.  A line tells, of all recordings with one cause: how many were refused; of the
95 % intervals of those that were answered, how many missed the truth; the median width of an interval,
and the error at the worst of twenty, both as parts of the true number; and how often something was said
that is not said of the same recording without the fault.
"""

from __future__ import annotations

import argparse
from collections import Counter
from collections.abc import Callable, Iterable
from concurrent.futures import ProcessPoolExecutor
from dataclasses import dataclass
from functools import partial
from typing import NamedTuple

import numpy as np
from scipy.signal import butter, lfilter

import zwidth as zw
from zwidth.model.operator.operator import LinearHand, Operator, Signals

Array = np.ndarray
Recording = dict[str, Array]
Rng = np.random.Generator

NAMES = {
    "finger": ("mass", "damping", "stiffness"),
    "tissue": ("stiffness", "branch_stiffness", "branch_damping"),
}
FINE = 8
"""Instants of a tissue's true motion in each sample."""


class Outcome(NamedTuple):
    """Of one recording: why it was refused, or whether each interval held the truth, how wide it was, how
    far off its middle; and what was said."""

    refused: str | None
    held: tuple[bool, ...] = ()
    widths: tuple[float, ...] = ()
    errors: tuple[float, ...] = ()
    said: frozenset[str] = frozenset()


@dataclass(frozen=True, kw_only=True, eq=False)
class Shaken(Operator):
    """A finger, to which an actuator's push is added."""

    push: Array
    wanted: Array
    constants: LinearHand

    @property
    def hand(self) -> LinearHand:
        return self.constants

    def signals(self, times: Array) -> Signals:
        return Signals(force=self.push, anchor=self.wanted)

    def describe(self, motion: str = "linear") -> str:
        return "a finger that is shaken"


# ---- recordings without a fault


def paddle() -> zw.Device:
    """The haptic paddle of Abbott & Okamura (2005)."""
    return zw.Device(
        mass=0.036, damping=0.15, coulomb_friction=0.12, resolution="22.4 um", sample_period="1 ms"
    )


def finger(rng: Rng, seconds: float = 20.0) -> tuple[Recording, tuple[float, ...]]:
    """A shaken finger as it is, without the load cell's noise; and mass, damping, stiffness."""
    true = rng.uniform(0.003, 0.015), rng.uniform(0.5, 4.0), rng.uniform(150, 1200)
    samples = round(seconds * 1000)
    time = np.arange(samples + 1) * 1e-3
    push = np.repeat(rng.choice([-1.0, 1.0], samples // 10 + 1), 10)[:samples]
    waves = zip(rng.normal(size=12), rng.uniform(0.1, 1.5, 12), rng.uniform(0, 6.28, 12), strict=True)
    wanted = sum(a * np.sin(2 * np.pi * f * time + p) for a, f, p in waves)
    wanted = wanted * 0.0005 / wanted.std() - 1.0
    own = lfilter(*butter(2, [0.016, 0.024], "band"), rng.normal(size=samples))
    hand = Shaken(
        push=push + 0.05 * own / own.std(), wanted=wanted, constants=LinearHand(true[0], true[2], true[1])
    )
    far = zw.Wall(stiffness=1)  # a metre away
    trace = zw.simulate(paddle(), far, hand, seconds, initial_position=wanted[0])
    force = trace.hand_force.values[:samples] - push
    recording = {
        "time": time[:samples],
        "position": trace.measured_position.values[:samples],
        "force": force,  # just after the actuator's step, and just before
        "before": force - true[0] / (true[0] + 0.036) * np.diff(-push, prepend=-push[0]),
        "actuator_force": -push,
    }
    return recording, true


def tissue(rng: Rng, seconds: float = 10.0) -> tuple[Recording, tuple[float, ...]]:
    """A tissue that is moved about at several speeds, on a grid `FINE` times as fine as the samples."""
    rest = np.exp(rng.uniform(np.log(50), np.log(2000)))
    branch = rest * rng.uniform(0.2, 1.5)
    true = rest, branch, branch * np.exp(rng.uniform(np.log(0.02), np.log(0.3)))
    time = np.arange(round(seconds * 500) * FINE) * 2e-3 / FINE
    waves = zip(rng.normal(size=12), np.exp(rng.uniform(np.log(0.3), np.log(10), 12)), strict=True)
    path = sum(a * np.sin(2 * np.pi * f * time + rng.uniform(0, 6.28)) / np.sqrt(f) for a, f in waves)
    path = 0.006 + 0.0012 * path / path.std()
    force = zw.tissue.force_response(zw.StandardLinearSolid(*true), time, path)
    return {"time": time, "position": path, "force": force}, true


# ---- faults


def late(seconds: float, r: Recording) -> Recording:
    """The force is read so much later."""
    return {**r, "force": np.interp(r["time"] - seconds, r["time"], r["force"])}


def filtered(seconds: float, r: Recording) -> Recording:
    """The force goes through a filter of the first order with this time constant.

    y ← e y + (φ − e) f + (1 − φ) f₊,   e = exp(−T/τ),  φ = (1 − e) τ/T, for a force that is straight from f
    at a sample to f₊ just before the next one.
    """
    x = (r["time"][1] - r["time"][0]) / seconds
    e, share = np.exp(-x), -np.expm1(-x) / x
    ends = r.get("before", r["force"])
    pushed = (share - e) * r["force"][:-1] + (1 - share) * ends[1:]
    rest = r["force"][0]
    y = lfilter([1.0], [1, -e], pushed, zi=[e * rest])[0]
    return {**r, "force": np.concatenate([[rest], y])}


def saturated(share: float, scatter: float, rng: Rng, r: Recording) -> Recording:
    """The load cell is at an end of its range in such a share of the samples; noise may come behind it."""
    middle = np.median(r["force"])
    most = np.quantile(np.abs(r["force"] - middle), 1 - share)
    cut = np.clip(r["force"], middle - most, middle + most)
    return {**r, "force": cut + scatter * most * rng.integers(-2, 3, cut.size)}


def dropped(share: float, rng: Rng, r: Recording) -> Recording:
    """Samples are lost one by one; the stamps tell."""
    kept = rng.uniform(size=r["time"].size) > share
    return {name: values[kept] for name, values in r.items()}


def holes(count: int, stamped: bool, rng: Rng, r: Recording) -> Recording:
    """Holes of 50 to 500 ms; the stamps tell, or go on as if nothing was lost."""
    kept, period = np.ones(r["time"].size, dtype=bool), r["time"][1] - r["time"][0]
    for start in rng.integers(200, kept.size - 200, count):
        kept[start : start + round(rng.uniform(0.05, 0.5) / period)] = False
    found = {name: values[kept] for name, values in r.items()}
    return found if stamped else {**found, "time": np.arange(kept.sum()) * period}


def jitter(share: float, rng: Rng, r: Recording) -> Recording:
    """The samples are even and their stamps are not."""
    period = r["time"][1] - r["time"][0]
    return {**r, "time": r["time"] + share * period * rng.uniform(-0.5, 0.5, r["time"].size)}


def drifting(newtons: float, rng: Rng, r: Recording) -> Recording:
    """The zero wanders by so much in 20 s, from 0 on."""
    knots = np.arange(0.0, r["time"][-1] + 20.0, 20.0)
    zero = np.append(0.0, np.cumsum(rng.choice([-newtons, newtons], knots.size - 1)))
    return {**r, "force": r["force"] + np.interp(r["time"], knots, zero)}


def shifted(newtons: float, r: Recording) -> Recording:
    """The zero is off by so much."""
    return {**r, "force": r["force"] + newtons}


def times(factor: float, name: str, r: Recording) -> Recording:
    """The numbers of one column are so many times too large."""
    return {**r, name: factor * r[name]}


def stepped(step: float, name: str, r: Recording) -> Recording:
    """One column is read in steps."""
    return {**r, name: np.rint(r[name] / step) * step}


Fault = Callable[[Rng, Recording], Recording]
BEFORE: dict[str, Fault] = {  # what happens to the true force
    "1 ms late": lambda rng, r: late(0.001, r),
    "2 to 5 ms late": lambda rng, r: late(rng.uniform(0.002, 0.005), r),
    "filter of 1 ms": lambda rng, r: filtered(0.001, r),
    "filter of 2 to 5 ms": lambda rng, r: filtered(rng.uniform(0.002, 0.005), r),
    "force before the step": lambda rng, r: {**r, "force": r.get("before", r["force"])},
}
AFTER: dict[str, Fault] = {  # what happens to what was read
    "plain": lambda rng, r: r,
    "saturated, 10 %": partial(saturated, 0.1, 0.0),
    "saturated, 1 %": partial(saturated, 0.01, 0.0),
    "saturated, noise behind": partial(saturated, 0.1, 2e-4),
    "1 % of samples lost": partial(dropped, 0.01),
    "5 holes": partial(holes, 5, True),
    "5 holes, no stamps": partial(holes, 5, False),
    "uneven stamps": partial(jitter, 0.4),
    "drift 0.05 N in 20 s": partial(drifting, 0.05),
    "drift 2 N in 20 s": partial(drifting, 2.0),
    "zero off by 0.3 N": lambda rng, r: shifted(0.3, r),
    "force turned round": lambda rng, r: times(-1, "force", r),
    "position turned round": lambda rng, r: times(-1, "position", r),
    "force x 1000": lambda rng, r: times(1e3, "force", r),
    "force / 1000": lambda rng, r: times(1e-3, "force", r),
    "position x 1000": lambda rng, r: times(1e3, "position", r),
    "position / 1000": lambda rng, r: times(1e-3, "position", r),
    "force in steps of 0.1 N": lambda rng, r: stepped(0.1, "force", r),
    "position in 0.1 mm": lambda rng, r: stepped(1e-4, "position", r),
}
OF_FINGERS: dict[str, Fault] = {
    "actuator turned round": lambda rng, r: times(-1, "actuator_force", r),
    "actuator x 1000": lambda rng, r: times(1e3, "actuator_force", r),
}
WAYS = {
    "both forces": ((), False),
    "both, device known": ((), True),
    "force of the hand": (("actuator_force",), False),
    "actuator, device known": (("force",), True),
}


def faulty(name: str, rng: Rng, r: Recording, noise: float, every: int) -> Recording:
    """The recording with one fault, its noise and its samples."""
    if name in BEFORE:
        r = BEFORE[name](rng, r)
    r = {key: values[::every].copy() for key, values in r.items() if key != "before"}
    r["force"] += noise * rng.normal(size=r["force"].size)
    return {**AFTER, **OF_FINGERS}.get(name, AFTER["plain"])(rng, r)


# ---- what becomes of them


def of_finger(name: str, way: str, seed: int) -> Outcome:
    """One finger, identified."""
    rng = np.random.default_rng([seed, 1])
    r, true = finger(rng)
    r = faulty(name, rng, r, 0.02, 1)
    without, known = WAYS[way]
    kept = {("hand_force" if k == "force" else k): v for k, v in r.items() if k not in without}
    try:
        resolution = None if name.startswith("position") else 22.4e-6
        log = zw.Log.from_arrays(resolution=resolution, **kept)
        found = zw.identification.identify_finger(log, paddle() if known else None)
    except zw.InputError as error:
        return Outcome(str(error))
    intervals = [found.estimates[n].interval() for n in NAMES["finger"]]
    return _outcome(intervals, true, (f.kind for f in found.findings))


def of_tissue(name: str, way: str, seed: int) -> Outcome:
    """One tissue, fitted."""
    rng = np.random.default_rng([seed, 2])
    r, true = tissue(rng)
    r = faulty(name, rng, r, 0.01 * float(r["force"].std()), FINE)
    try:
        fit = zw.tissue.fit_tissue(r["time"], r["position"], r["force"])
    except zw.InputError as error:
        return Outcome(str(error))
    said = [*fit.remarks, *(f.kind for f in getattr(fit, "findings", ()))]
    return _outcome([fit.interval(n) for n in NAMES["tissue"]], true, said)


def of_track(name: str, way: str, seed: int) -> Outcome:
    """One tissue, tracked: no interval is stated, so one of ± 10 % is looked at."""
    rng = np.random.default_rng([seed, 2])
    r, true = tissue(rng)
    r = faulty(name, rng, r, 0.01 * float(r["force"].std()), FINE)
    guess = (true[0] * 1.5, true[1] / 1.5, true[2])
    noise = 0.01 * float(np.ptp(r["force"])) / 5
    try:
        tracker = zw.tissue.RecursiveSolid(0.002, guess, forgetting="0.9995", noise=noise)
        track = _tracked(tracker, r)
    except zw.InputError as error:
        return Outcome(str(error))
    last = slice(-r["time"].size // 5, None)
    ends = [float(np.median(values[last])) for values in track[:3]]
    said = (f.kind for f in getattr(track, "findings", ()))
    return _outcome([(0.9 * v, 1.1 * v) for v in ends], true, said)


def _tracked(tracker: zw.tissue.RecursiveSolid, r: Recording) -> zw.tissue.Track:
    return tracker.track(r["position"], r["force"], r["time"])


def _outcome(intervals: Iterable[tuple[float, float]], true: Iterable[float], said: Iterable[str]) -> Outcome:
    pairs = list(zip(intervals, true, strict=True))
    return Outcome(
        None,
        tuple(bool(low <= t <= high) for (low, high), t in pairs),
        tuple((high - low) / t for (low, high), t in pairs),
        tuple(abs((low + high) / 2 / t - 1) for (low, high), t in pairs),
        frozenset(said),
    )


# ---- the table

OF = {"finger": of_finger, "tissue": of_tissue, "tracked": of_track}


def line(name: str, outcomes: list[Outcome], plain: list[Outcome]) -> str:
    """A cause in a line."""
    answered = [o for o in outcomes if o.refused is None]
    refused = len(outcomes) - len(answered)
    new = [o.said - p.said for o, p in zip(outcomes, plain, strict=True) if o.refused is None]
    if not answered:
        reason = Counter(o.refused for o in outcomes).most_common(1)[0][0] or ""
        return f"{name:26} {refused:4d}   {'':37} {reason[:90]}"
    held = np.array([o.held for o in answered])
    width = np.median([o.widths for o in answered], axis=0)
    error = np.quantile([max(o.errors) for o in answered], 0.95)
    words = Counter(word[:34] for said in new for word in said)
    most = ", ".join(f"{w} {n}" for w, n in words.most_common(3))
    misses = " ".join(f"{100 * m:3.0f}" for m in 1 - held.mean(axis=0))
    widths = " ".join(f"{100 * w:5.1f}" for w in width)
    numbers = f"{misses}   {widths}   {100 * error:8.1f}   {sum(map(bool, new)):4d}"
    return f"{name:26} {refused:4d}   {numbers}   {most}"


def table(end: str, way: str, runs: int, seed: int, causes: list[str]) -> None:
    """All causes of one way to record."""
    print(f"\n{end}, {way}: {runs} recordings each" if way else f"\n{end}: {runs} recordings each")
    print(f"{'cause':26} refused   missed %      width, %      error, %   said   what")
    plain: list[Outcome] = []
    with ProcessPoolExecutor() as pool:
        for name in causes:
            outcomes = list(pool.map(partial(OF[end], name, way), range(seed, seed + runs), chunksize=4))
            plain = plain or outcomes
            print(line(name, outcomes, plain), flush=True)


def main() -> None:
    """Print the tables."""
    parser = argparse.ArgumentParser(description=__doc__.splitlines()[0])
    parser.add_argument("--runs", type=int, default=100)
    parser.add_argument("--seed", type=int, default=0)
    parser.add_argument("--only", choices=tuple(OF))
    parser.add_argument("--way", choices=tuple(WAYS), help="of the fingers")
    parser.add_argument("--cause", help="this one alone, beside the plain recordings")
    given = parser.parse_args()
    for end in OF if given.only is None else (given.only,):
        fingers = end == "finger"
        causes = [*AFTER, *BEFORE, *(OF_FINGERS if fingers else ())]
        if given.cause:
            causes = ["plain", given.cause]
        for way in (WAYS if given.way is None else (given.way,)) if fingers else ("",):
            table(end, way, given.runs, given.seed, causes)


if __name__ == "__main__":
    main()
