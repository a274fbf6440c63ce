"""How often do the 95 % intervals of `zwidth tissue` hold the truth, and how often is the model right?

    python benchmarks/tissue_intervals.py [--tests 1000] [--choices 260] [--seed 0] [--kind relaxation]
        [--jobs 1] [--csv FILE]

Each test draws a kind (relaxation, creep, loading), a model (Kelvin–Voigt, Maxwell, standard linear solid,
generalized Maxwell of two branches; of loading a Hunt–Crossley contact too), its numbers, and a record:

    stiffness           50 to 2000 N/m, a branch 0.3 to 1.5 times that
    relaxation times    0.05 to 2 s; of two branches the slower 8 to 30 times the quicker
    motion              1 to 8 mm: a smooth ramp of 40 to 400 ms, or of 8 samples where that is longer, and a
                        hold; or strokes in and out at two speeds (of a Maxwell body in alone)
    time                6 to 20 times the slowest relaxation time, from any first stamp; a third of the tests
                        is sampled unevenly: a relaxation or creep test more and more seldom, strokes at
                        random within a third of a step; a third comes from outside, but for Kelvin–Voigt
                        solids, whose force jumps at the touch, between two samples (--touch: those too)
    samples             200 to 600
    noise               0.2 to 2 % of the largest response, normal; white in one half, in the other with a
                        memory of 1 to 4 samples (exponential); on the force, in creep on the depth
    zero                of the force off by up to a fifth of its largest

The true response comes from a motion eight times as finely sampled.  The test is then read as arrays, as a
spreadsheet is: nobody says which kind or model it is.  A line tells of each parameter, fitted with the true
model, how many of the 95 % intervals hold the truth, how often it is said not to be identifiable (such
intervals do not count), and the median of its standard deviation.  Of the first tests, as many as --choices
says, every model is fitted: how often the one that is taken is the true one, and how often that is among
those that are not told apart.
"""

from __future__ import annotations

import argparse
import csv
import sys
from collections import defaultdict
from concurrent.futures import ProcessPoolExecutor
from functools import partial
from pathlib import Path
from typing import Any, NamedTuple

import numpy as np

import zwidth as zw
from zwidth.data.tissue.experiment.choice import label
from zwidth.data.tissue.model import Model, Record, as_model

Array = np.ndarray
Rng = np.random.Generator

TOUCH = "--touch" in sys.argv

FINE = 8
"""Instants of the true motion in each sample."""

CASES = (
    *(
        ("relaxation", name)
        for name in ("kelvin-voigt", "maxwell", "standard-linear-solid", "generalized-maxwell")
    ),
    *(
        ("creep", name)
        for name in ("kelvin-voigt", "maxwell", "standard-linear-solid", "generalized-maxwell")
    ),
    *(
        ("loading", name)
        for name in (
            "kelvin-voigt",
            "maxwell",
            "standard-linear-solid",
            "generalized-maxwell",
            "hunt-crossley",
        )
    ),
)


class Truth(NamedTuple):
    """What was drawn."""

    kind: str
    model: Model
    values: tuple[float, ...]
    noise: float
    memory: float


def log_uniform(rng: Rng, low: float, high: float) -> float:
    return float(np.exp(rng.uniform(np.log(low), np.log(high))))


def drawn_values(name: str, rng: Rng) -> tuple[float, ...]:
    """Parameters in the order of the model."""
    k, ratio, tau = log_uniform(rng, 50, 2000), log_uniform(rng, 0.3, 1.5), log_uniform(rng, 0.05, 2)
    if name == "kelvin-voigt":
        return k, k * log_uniform(rng, 0.03, 0.3)
    if name == "maxwell":
        return k, k * tau
    if name == "standard-linear-solid":
        return k, ratio * k, ratio * k * tau
    if name == "hunt-crossley":
        n = rng.uniform(1.2, 2.2)
        return k / 0.004 ** (n - 1), n, log_uniform(rng, 1, 15)
    quick, other = log_uniform(rng, 0.05, 0.15), log_uniform(rng, 0.3, 1.5)
    slow = quick * log_uniform(rng, 8, 30)
    return k, other * k, other * k * quick, ratio * k, ratio * k * slow


def slowest(model: Model, values: tuple[float, ...]) -> float:
    if not model.linear:
        return 0.5
    parts = model.elements(values)
    times = [eta / mu for mu, eta in parts.branches] or [parts.dashpot / parts.spring]
    return max(*times, 0.2) if len(times) > 1 else max(times[0], 0.2)


def smooth(t: Array) -> Array:
    """From 0 to 1 as a careful machine goes."""
    s = np.clip(t, 0.0, 1.0)
    return s**3 * (10 - 15 * s + 6 * s**2)


def slope(t: Array) -> Array:
    """The derivative of `smooth`."""
    s = np.clip(t, 0.0, 1.0)
    return 30 * s**2 * (1 - s) ** 2


def drawn(kind: str, name: str, rng: Rng) -> tuple[Truth, tuple[Array, Array, Array]]:
    """A test: the truth, and its times, depths and forces as they are recorded."""
    model = as_model(name, None, "force")
    values = drawn_values(name, rng)
    span = rng.uniform(6, 20) * slowest(model, values)
    count = int(rng.integers(200, 601))
    before = 0.05 * span if rng.random() < 0.7 else 0.0
    time = stamps(span, before, count, kind, rng)
    fine = np.interp(np.arange(FINE * (count - 1) + 1) / FINE, np.arange(count), time)
    ramp = max(log_uniform(rng, 0.04, 0.4), 8 * float(np.diff(time[time >= before])[:20].max()))
    depth, force = response(kind, model, values, fine, before, ramp, span, rng)
    depth, force = depth[::FINE], force[::FINE]
    clean = depth if kind == "creep" else force
    size = float(np.abs(clean).max()) if kind == "creep" else float(np.abs(force).max())
    level = log_uniform(rng, 0.002, 0.02)
    memory = 0.0 if rng.random() < 0.5 else rng.uniform(1, 4) * float(np.median(np.diff(time)))
    noisy = clean + level * size * noise(time, memory, rng)
    depth, force = (noisy, force) if kind == "creep" else (depth, noisy)
    depth = depth + rng.uniform(-0.05, 0.05)
    force = force + rng.uniform(-0.2, 0.2) * float(np.abs(force).max())
    signs = rng.choice([-1, 1], 2)
    return Truth(kind, model, values, level, memory), (
        time + rng.uniform(0, 100),
        signs[0] * depth,
        signs[1] * force,
    )


def stamps(span: float, before: float, count: int, kind: str, rng: Rng) -> Array:
    """Even, or in one test of three not: more and more seldom after the load, or at random about even."""
    even = np.linspace(0.0, before + span, count)
    if rng.random() < 2 / 3:
        return even
    if kind == "loading":
        return even + rng.uniform(-1, 1, count) * (even[1] - even[0]) / 3
    early = int(0.15 * count) if before else 0
    later = np.geomspace(span / 500, span * (1 + 1 / 500), count - early) - span / 500
    return np.concatenate([np.linspace(0.0, before, early, endpoint=False), before + later])


def response(
    kind: str, model: Model, values: Any, time: Array, before: float, ramp: float, span: float, rng: Rng
) -> tuple[Array, Array]:
    """Depth and force of the true tissue."""
    far = rng.uniform(0.001, 0.008)
    since = time - before
    if kind == "creep":
        force = log_uniform(rng, 0.2, 5.0) * smooth(since / ramp)
        return model.predict(values, Record(time, np.zeros_like(time), force, "position", 0.0)), force
    returns = model.name != "maxwell"  # what has relaxed to nothing lets the probe go
    if kind == "relaxation":
        path, speed = far * smooth(since / ramp), far * slope(since / ramp) / ramp
    else:
        path, speed = strokes(since, far, span, returns, rng)
    outside = far * rng.uniform(0.05, 0.3) if before and rng.random() < 0.5 else 0.0
    if model.name == "kelvin-voigt" and not TOUCH:
        outside = 0.0
    depth = path * (1 + outside / far) - outside
    inside = np.maximum(depth, 0.0)
    if model.name == "kelvin-voigt":  # a difference of two instants is the speed of neither
        return depth, values[0] * inside + values[1] * speed * (1 + outside / far) * (depth > 0)
    force = model.predict(values, Record(time, inside, np.zeros_like(time), "force", None))
    return depth, force


def strokes(since: Array, far: float, span: float, returns: bool, rng: Rng) -> tuple[Array, Array]:
    """In at two speeds, and, if it returns, some way out in between, never all the way; and its speed."""
    slow, quick = span * rng.uniform(0.25, 0.4), span * rng.uniform(0.04, 0.1)
    path, speed, at, level = np.zeros_like(since), np.zeros_like(since), 0.0, 0.0
    for k in range(40):
        duration = slow if k % 3 == 0 else quick
        deep, out = rng.uniform(0.7, 1.0), rng.uniform(0.3, 0.5)
        goal = far * (deep if k % 2 == 0 else out) if returns else level + 0.2 * far * deep
        path += (goal - level) * smooth((since - at) / duration)
        speed += (goal - level) * slope((since - at) / duration) / duration
        at, level = at + duration, goal
        if at > since[-1]:
            break
    return path, speed


def noise(time: Array, memory: float, rng: Rng) -> Array:
    """Of variance 1, with a memory [s]."""
    white = rng.normal(size=time.size)
    if not memory:
        return white
    rho = np.exp(-np.diff(time) / memory)
    found = np.empty_like(white)
    found[0] = white[0]
    for k, r in enumerate(rho):
        found[k + 1] = r * found[k] + np.sqrt(1 - r * r) * white[k + 1]
    return found


def tried(
    seed: tuple[int, int], choices: int, cases: tuple[tuple[str, str], ...] = CASES
) -> list[dict[str, Any]]:
    """One test: a row for each parameter."""
    rng = np.random.default_rng(seed)
    kind, name = cases[seed[1] % len(cases)]
    choosing = seed[1] < choices
    truth, arrays = drawn(kind, name, rng)
    common = {
        "test": seed[1],
        "kind": kind,
        "model": label(truth.model),
        "noise": truth.noise,
        "memory": truth.memory,
    }
    try:
        test = zw.tissue.fit_test(*arrays, models=() if choosing else (label(truth.model),))
    except zw.InputError as error:
        return [{**common, "refused": str(error)}]
    own = label(truth.model)
    common["seen_as"] = test.test.kind
    if choosing:
        common["taken"] = label(test.best.model)
        common["rivals"] = " ".join(test.rivals)
    common["is_noise"] = test.is_noise
    if test.test.kind != kind and (kind == "creep") != (test.test.kind == "creep"):
        return [common]
    fit = test[own]
    rows = []
    for parameter, value in zip(truth.model.parameters, truth.values, strict=True):
        low, high = fit.interval(parameter)
        rows.append(
            {
                **common,
                "parameter": parameter,
                "truth": value,
                "low": low,
                "high": high,
                "spread": fit.spreads[parameter],
                "held": low <= value <= high,
                "known": fit.spreads[parameter] <= 0.5,
            }
        )
    return rows


def main() -> None:
    parser = argparse.ArgumentParser(
        description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter
    )
    parser.add_argument("--tests", type=int, default=1000)
    parser.add_argument("--choices", type=int, default=260)
    parser.add_argument("--seed", type=int, default=0)
    parser.add_argument("--kind", choices=sorted({kind for kind, _ in CASES}))
    parser.add_argument("--jobs", type=int, default=1)
    parser.add_argument("--csv", type=Path)
    parser.add_argument("--touch", action="store_true")
    arguments = parser.parse_args()
    seeds = [(arguments.seed, k) for k in range(arguments.tests)]
    cases = tuple(case for case in CASES if arguments.kind in (None, case[0]))
    with ProcessPoolExecutor(arguments.jobs) as pool:
        found = pool.map(partial(tried, choices=arguments.choices, cases=cases), seeds, chunksize=5)
        rows = [row for each in found for row in each]
    if arguments.csv:
        write(arguments.csv, rows)
    report(rows)


def write(path: Path, rows: list[dict[str, Any]]) -> None:
    names = list(dict.fromkeys(key for row in rows for key in row))
    with open(path, "w", encoding="utf-8", newline="") as file:
        writer = csv.DictWriter(file, names)
        writer.writeheader()
        writer.writerows(rows)


def report(rows: list[dict[str, Any]]) -> None:
    tests = {row["test"]: row for row in rows}
    print(f"{len(tests)} tests; refused: {sum('refused' in row for row in tests.values())}")
    for why in sorted({row["refused"] for row in tests.values() if "refused" in row})[:5]:
        print("  ", why)
    seen = [row for row in tests.values() if "seen_as" in row]
    print(f"kind right: {share([row['seen_as'] == row['kind'] for row in seen])}")
    print(f"left over is said to be no noise: {share([not row['is_noise'] for row in seen])}")
    seen = [row for row in seen if "taken" in row]
    print("\nintervals of the true model      held       not known   median spread")
    groups: dict[tuple[str, str, str], list[dict[str, Any]]] = defaultdict(list)
    for row in rows:
        if "parameter" in row:
            for name in (row["model"], "all"):
                groups["every kind", name, "" if name == "all" else row["parameter"]].append(row)
            groups[row["kind"], "all", ""].append(row)
            groups["white" if not row["memory"] else "memory", "all", ""].append(row)
    for (kind, model, parameter), found in sorted(groups.items()):
        known = [row for row in found if row["known"]]
        spread = float(np.median([row["spread"] for row in known])) if known else float("nan")
        left = len(found) - len(known)
        text = f"{kind} {model} {parameter}"
        print(f"{text:48} {share([row['held'] for row in known]):>18} {left:5} {100 * spread:8.2f} %")
    print("\nmodel taken                                  right   right or not told apart")
    for kind, model in dict.fromkeys((row["kind"], row["model"]) for row in seen):
        own = [row for row in seen if (row["kind"], row["model"]) == (kind, model)]
        print_models(f"{kind} {model}", own)
    print_models("all", seen)
    for row in seen:
        if row["taken"] != row["model"]:
            groups["wrong", row["model"], row["taken"]].append(row)
    for (what, model, taken), found in sorted(groups.items()):
        if what == "wrong":
            print(f"   {model} taken for {taken}: {len(found)}")


def print_models(text: str, rows: list[dict[str, Any]]) -> None:
    right = [row["taken"] == row["model"] for row in rows]
    either = [r or row["model"] in row["rivals"].split() for r, row in zip(right, rows, strict=True)]
    print(f"{text:34} {share(right):>16} {share(either):>18}")


def share(of: list[bool]) -> str:
    return f"{100 * np.mean(of):.1f} % of {len(of)}" if of else "none"


if __name__ == "__main__":
    main()
