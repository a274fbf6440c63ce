"""Does a recording promise more than its device has, and what makes it?

    python benchmarks/identification_causes.py [--runs 50] [--seed 0] [--cause falling]

Devices drawn at random (30 to 150 g, b of 0.1 to 0.4 N s/m, f_c of 0.05 to 0.3 N, counts of 5 to 50 um,
0.5 to 2 kHz) are moved for a minute by a hand that wanders some centimetres, with noise of 0.02 to 0.1 N
and a drifting zero on the load cell.  Into each one cause is put.  What is promised is the lower end of
`device(0.9)`, which holds with 95 % for each number.  A wall is promised too stiff where b is larger than
the slope of friction anywhere up to the speed that the device states; f_c too large, where f_c + b |v| is
above friction somewhere there, in the mean of both directions.
"""

from __future__ import annotations

import argparse
import time
from collections import Counter
from concurrent.futures import ProcessPoolExecutor
from dataclasses import dataclass
from math import pi
from pathlib import Path
from typing import Any, NamedTuple

import numpy as np
from in_c import REALS, WHOLE, library
from scipy.signal import lfilter

import zwidth as zw
from zwidth.quantity.exact import ends

Array = np.ndarray
SECONDS, STEP = 60.0, 5e-5
HAND_STIFFNESS, HAND_DAMPING = 400.0, 2.0
LINE, BENT, ARCTAN, LOGARITHM, ROOT = range(5)
CAUSES = (
    "plain",
    "asymmetric",
    "falling",
    "falling one way",
    "Stribeck",
    "cogging",
    "saturated",
    "lagging",
    "eccentric",
    "uneven clock",
    "all, mild",
)


@dataclass(frozen=True, kw_only=True)
class Friction:
    """f_c + g(v) + s exp(−(v/v_s)²), g with the slope b at rest, by a law for each direction."""

    coulomb: float
    inward: float
    outward: float
    law_inward: int = LINE
    law_outward: int = LINE
    bend: float = 1.0
    bump: float = 0.0
    bump_speed: float = 1.0

    def ways(self) -> tuple[tuple[int, float], tuple[int, float]]:
        """Law and slope at rest, into the wall and out of it."""
        return (self.law_inward, self.inward), (self.law_outward, self.outward)

    def least_slope(self, speed: float) -> float:
        """Of g, up to a speed: all laws fall."""
        return min(slope(law, b, self.bend, speed) for law, b in self.ways())

    def most_coulomb(self, damping: float, speed: float) -> float:
        """The largest f_c for which f_c + b |v| is below friction up to a speed, in the mean of both ways."""
        v = np.linspace(0.0, speed, 400)
        rest = self.coulomb + self.bump * np.exp(-((v / self.bump_speed) ** 2)) - damping * v
        above = [viscous(law, b, self.bend, v) + rest for law, b in self.ways()]
        return float(sum(way.min() for way in above) / 2)


def viscous(law: int, b: float, bend: float, v: Any) -> Any:
    """g(v) of a law."""
    if law == BENT:
        return b * v / (1.0 + v / bend)
    if law == ARCTAN:
        return b * bend * np.arctan(v / bend)
    if law == LOGARITHM:
        return b * bend * np.log(1.0 + v / bend)
    if law == ROOT:
        return b * bend * (np.sqrt(1.0 + 2.0 * v / bend) - 1.0)
    return b * v


def slope(law: int, b: float, bend: float, v: float) -> float:
    """g'(v) of a law."""
    u = v / bend
    return b * (1.0, 1 / (1 + u) ** 2, 1 / (1 + u * u), 1 / (1 + u), 1 / np.sqrt(1 + 2 * u))[law]


def moved(wanted: Array, every: int, laws: tuple[int, int], *numbers: float) -> Array:
    """Position, velocity and force of the hand at the samples; friction is taken at the end of each step.

    The numbers: mass, f_c, b inward and outward, bend, bump and its speed, cogging and its pitch.
    """
    out = np.empty((3, wanted.size // every))
    run = library(Path(__file__).with_name("shaken.c")).moved
    run.argtypes = [REALS, WHOLE, WHOLE, REALS, WHOLE, WHOLE, REALS]
    p = np.array([STEP, HAND_STIFFNESS, HAND_DAMPING, *numbers])
    run(wanted, out.shape[1], every, p, *laws, out)
    return out


class Recording(NamedTuple):
    """What was logged, and the friction that was there."""

    log: zw.Log
    friction: Friction


def record(cause: str, seed: int) -> Recording:
    """A minute of a device with one cause."""
    rng = np.random.default_rng([seed, CAUSES.index(cause)])
    mild = cause == "all, mild"
    period = float(rng.choice([5e-4, 1e-3, 2e-3]))
    every = round(period / STEP)
    count = round(SECONDS / period)
    wanted = wandering(rng, count * every)
    typical = float(np.abs(np.diff(wanted[::100])).mean() / (100 * STEP))
    friction, mass = friction_of(cause, rng, typical), rng.uniform(0.03, 0.15)
    strongest = (0.1, 0.6) if cause == "cogging" else (0.0, 0.1 if mild else 0.0)
    position, _, force = moved(
        wanted,
        every,
        (friction.law_inward, friction.law_outward),
        mass,
        friction.coulomb,
        friction.inward,
        friction.outward,
        friction.bend,
        friction.bump,
        friction.bump_speed,
        friction.coulomb * rng.uniform(*strongest),
        10 ** rng.uniform(-3, -2),
    )
    at = np.arange(count) * period
    force = sensed(cause, rng, force, at, period)
    if cause == "eccentric" or mild:
        length, size = rng.uniform(0.02, 0.1), rng.uniform(0.001, 0.001 if mild else 0.01)
        position = position + size * length / (2 * pi) * np.sin(
            2 * pi * position / length + rng.uniform(0, 6)
        )
    stamps = at
    if cause == "uneven clock" or mild:
        late = period * np.clip(
            rng.uniform(0.01, 0.01 if mild else 0.15) * rng.normal(size=count), -0.45, 0.45
        )
        position, force = (np.interp(at + late, at, column) for column in (position, force))
        stamps = at + late if rng.random() < 0.5 else at
    step = 10 ** rng.uniform(-5.3, -4.3)
    read = step * np.floor(position / step)
    return Recording(
        zw.Log.from_arrays(time=stamps, position=read, hand_force=force, resolution=step), friction
    )


def wandering(rng: np.random.Generator, count: int) -> Array:
    """Where a hand wants to be, every `STEP`."""
    at = np.arange(count) * STEP
    waves = zip(rng.normal(size=10), rng.uniform(0.3, 3.5, 10), rng.uniform(0, 2 * pi, 10), strict=True)
    path = sum(a * np.sin(2 * pi * f * at + p) for a, f, p in waves)
    return path * rng.uniform(0.01, 0.025) / path.std()


def friction_of(cause: str, rng: np.random.Generator, typical: float) -> Friction:
    """Friction with a cause, by the mean speed of the hand."""
    mild = cause == "all, mild"
    numbers = {"coulomb": rng.uniform(0.05, 0.3), "inward": rng.uniform(0.1, 0.4)}
    numbers["outward"] = numbers["inward"]
    one = str(rng.choice(["inward", "outward"]))
    if cause == "asymmetric" or mild:
        numbers[one] *= rng.uniform(0.85 if mild else 0.5, 1.0)
    if cause in ("falling", "falling one way") or mild:
        law = int(rng.integers(BENT, ROOT + 1))
        laws = {"law_inward": law, "law_outward": law}
        numbers |= {f"law_{one}": law} if cause == "falling one way" else laws
        numbers["bend"] = typical * 10 ** (rng.uniform(1.0, 1.5) if mild else rng.uniform(0.0, 1.0))
    if cause == "Stribeck" or mild:
        numbers["bump"] = numbers["coulomb"] * (rng.uniform(0, 0.2) if mild else rng.uniform(0.2, 1.0))
        numbers["bump_speed"] = typical * rng.uniform(0.05, 0.5)
    return Friction(**numbers)


def sensed(cause: str, rng: np.random.Generator, force: Array, at: Array, period: float) -> Array:
    """What a load cell makes of the hand's force."""
    mild = cause == "all, mild"
    if cause == "lagging" or mild:  # a filter of the first order, the force straight between samples
        lag = rng.uniform(1e-4, 5e-4) if mild else rng.uniform(5e-4, 4e-3)
        kept = np.exp(-period / lag)
        old = lag / period * (1 - kept) - kept
        force = lfilter([1 - kept - old, old], [1, -kept], force, zi=[force[0] * (kept + old)])[0]
    knots = np.arange(0.0, SECONDS + 20.0, 20.0)
    force = force + np.interp(at, knots, 0.02 * np.cumsum(rng.normal(size=knots.size)))
    force = force + rng.uniform(0.02, 0.1) * rng.normal(size=force.size)
    if cause == "saturated" or mild:
        most = np.quantile(np.abs(force), 1 - (0.005 if mild else rng.uniform(0.01, 0.15)))
        force = np.clip(force, -most, most)
    return force


class Outcome(NamedTuple):
    """Of one recording: why it was refused, or promised b and f_c by what there is, seconds, findings."""

    refused: str | None
    damping: float = 0.0
    coulomb: float = 0.0
    seconds: float = 0.0
    kinds: frozenset[str] = frozenset()


def one(task: tuple[str, int]) -> Outcome:
    """What a recording promises."""
    log, friction = record(*task)
    start = time.perf_counter()
    try:
        found = zw.identify(log)
    except zw.InputError as error:
        return Outcome(str(error))
    seconds = time.perf_counter() - start
    device = found.device(0.9)
    b, f_c = (float(ends(value)[0]) for value in (device.damping, device.coulomb_friction))
    most = friction.most_coulomb(b, found.speed)
    kinds = frozenset(finding.kind for finding in found.findings)
    return Outcome(
        None, b / friction.least_slope(found.speed), f_c / most if most > 0 else f_c, seconds, kinds
    )


def told(cause: str, outcomes: list[Outcome]) -> str:
    """A line of the table."""
    kept = [outcome for outcome in outcomes if outcome.refused is None]
    b, f_c, seconds = (np.array([outcome[k] for outcome in kept]) for k in (1, 2, 3))
    kinds = Counter(kind for outcome in kept for kind in outcome.kinds)
    for common in ("sample period", "resolution", "Coulomb friction"):
        kinds.pop(common, None)
    said = ", ".join(f"{kind} {count}" for kind, count in kinds.most_common())
    return (
        f"{cause:15} {len(kept):4d} answered, {len(outcomes) - len(kept):3d} refused;  "
        f"2b/T too large {np.mean(b > 1):6.1%}, by over 5 % {np.mean(b > 1.05):6.1%}, "
        f"median {np.median(b):.3f};  "
        f"f_c {np.mean(f_c > 1):6.1%}, {np.mean(f_c > 1.05):6.1%}, {np.median(f_c):.3f};  "
        f"{np.median(seconds):.2f} s;  {said}"
    )


def main() -> None:
    """All causes."""
    arguments = argparse.ArgumentParser(description=__doc__.splitlines()[0])
    arguments.add_argument("--runs", type=int, default=50)
    arguments.add_argument("--seed", type=int, default=0)
    arguments.add_argument("--cause", choices=CAUSES)
    given = arguments.parse_args()
    one((CAUSES[0], given.seed))  # compiled once, before the processes start
    for cause in [given.cause] if given.cause else CAUSES:
        tasks = [(cause, given.seed + k) for k in range(given.runs)]
        with ProcessPoolExecutor() as pool:
            print(told(cause, list(pool.map(one, tasks, chunksize=2))), flush=True)


if __name__ == "__main__":
    main()
