"""Two arms that shake for one reason, simulated, and the logs they leave: for `diagnosis_pairs.py`.

It knows nothing of the diagnosis.  Two arms, a coupling, hands and a logger are drawn at random, and one
fault is put in.  A draw counts where the arms shake with the fault and are quiet without it, all else
unchanged.  Integrated in steps of T/20, semi-implicit, with Coulomb friction that holds.
"""

from __future__ import annotations

from dataclasses import dataclass, field, replace
from pathlib import Path
from typing import Any

import numpy as np
from in_c import REALS, WHOLE, library
from numpy.typing import NDArray

import zwidth as zw

Array = NDArray[np.float64]

CAUSES = (
    "link delay",
    "sampling",
    "delay",
    "damping",
    "local damping",
    "friction compensation",
    "actuator limit",
)

FINE = 20
"""Steps of the integrator in a sample period."""


@dataclass(frozen=True, kw_only=True)
class Arms:
    """All numbers of a pair, in SI units, leader first where there are two, and its fault."""

    cause: str
    period: float
    mass: tuple[float, float]
    viscous: tuple[float, float]
    coulomb: tuple[float, float]
    resolution: float
    stiffness: float
    damping: float = 0.0
    local_damping: float = 0.0
    compensation: float = 0.0
    delay: int = 0
    link: int = 0
    limit: float = 0.0
    slew: float = 0.0
    hand_stiffness: float = 0.0
    hand_damping: float = 0.0
    kick: float = 0.0
    duration: float = 2.0
    mended: dict[str, Any] = field(default_factory=dict)

    def without_fault(self) -> Arms:
        """The same without the fault."""
        return replace(self, **self.mended)


@dataclass(frozen=True)
class Moved:
    """At the samples, a row for each arm: the reading, what was asked for, what the motor gave, speed."""

    measured: Array
    commanded: Array
    applied: Array
    velocity: Array


def run(arms: Arms) -> Moved:
    """Simulate it."""
    steps = round(arms.duration / arms.period)
    numbers = np.array(
        [
            *arms.mass, *arms.viscous, *arms.coulomb, arms.resolution, arms.period, arms.stiffness,
            arms.damping, arms.local_damping, arms.compensation, arms.limit, arms.hand_stiffness,
            arms.hand_damping, arms.kick, arms.slew,
        ]
    )  # fmt: skip
    return Moved(*_integrate(numbers, arms.delay, arms.link, steps))


def _integrate(p: Array, late: int, link: int, steps: int) -> Array:
    out = np.zeros((4, 2, steps))
    arms = library(Path(__file__).with_name("shaken.c")).arms
    arms.argtypes = [REALS, *[WHOLE] * 4, REALS]
    arms(p, late, link, steps, FINE, out)
    return out


def shakes(arms: Arms, made: Moved) -> bool:
    """True where an arm goes on to the end: ten counts, six cycles in a third of the time, 2 Hz."""
    swings = _swings(arms, made)
    last = made.velocity[:, -made.velocity.shape[1] // 3 :]
    arm = int(np.argmax(np.ptp(last, axis=1)))
    power = np.abs(np.fft.rfft((last[arm] - last[arm].mean()) * np.hanning(last.shape[1]))) ** 2
    peak = int(np.argmax(power))
    fast = peak >= 6 and peak / (last.shape[1] * arms.period) >= 2.0
    return bool(swings[-1] > 10 * arms.resolution and swings[-1] > 0.3 * swings[0] and fast)


def quiet(arms: Arms, made: Moved) -> bool:
    """True where both have come to rest, or are going to: two counts, or below half of what it was."""
    swings = _swings(arms, made)
    return bool(swings[-1] < 2 * arms.resolution or swings[-1] < 0.5 * swings[0])


def _swings(arms: Arms, made: Moved) -> Array:
    """[rad] peak to peak of the arm that swings further, in eighths of two thirds of the time, no drift."""
    moved = np.cumsum(made.velocity, axis=1) * arms.period
    pieces = np.array_split(moved[:, -2 * moved.shape[1] // 3 :], 8, axis=1)
    found = []
    for piece in pieces:
        k = np.arange(piece.shape[1])
        found.append(max(np.ptp(x - np.polyval(np.polyfit(k, x, 1), k)) for x in piece))
    return np.array(found)


def draw(rng: np.random.Generator, cause: str) -> tuple[Arms, Moved]:
    """Arms that shake for this reason alone, and their motion."""
    for _ in range(4000):
        arms = _drawn(rng, cause)
        made = run(arms)
        if np.isfinite(made.measured).all() and np.ptp(made.measured) < 50 and shakes(arms, made):
            mended = arms.without_fault()
            if quiet(mended, run(mended)):
                return arms, made
    raise RuntimeError(f"no draw of {cause} shakes with its fault alone")


def _log(rng: np.random.Generator, low: float, high: float) -> float:
    return float(np.exp(rng.uniform(np.log(low), np.log(high))))


def _drawn(rng: np.random.Generator, cause: str) -> Arms:
    period = 1.0 / float(rng.choice([250, 500, 500, 1000, 1000]))
    mass = _log(rng, 0.003, 0.05)
    masses = mass, mass * _log(rng, 0.6, 1.6)
    natural = _log(rng, 20.0, min(150.0, 0.3 / period))
    stiffness = mass * natural**2
    swing = _log(rng, 0.02, 0.1)
    viscous = 2 * _log(rng, 0.01, 0.06) * mass * natural
    link = int(rng.integers(0, 4))
    held = stiffness * period * (0.5 + link)
    calm = max(viscous, held * _log(rng, 1.3, 3.0))
    base: dict[str, Any] = {
        "period": period,
        "mass": masses,
        "stiffness": stiffness,
        "resolution": 2 * np.pi / float(rng.choice([4096, 16384, 65536])),
        "limit": stiffness * swing * _log(rng, 1.0, 4.0),
        "kick": natural * swing * rng.uniform(0.3, 1.0),
        "hand_stiffness": stiffness * _log(rng, 0.02, 0.3) if rng.random() < 0.6 else 0.0,
        "duration": float(np.clip(100 * 2 * np.pi / natural, 1.5, 5.0)),
        "link": link,
    }
    friction = _log(rng, 0.002, 0.02) * stiffness * swing
    changes: dict[str, Any]
    if cause == "link delay":
        base["link"] = link = int(rng.integers(1, 15))
        calm = max(0.5 * stiffness * period * 1.3, stiffness * period * (0.5 + link) / _log(rng, 1.5, 6.0))
        changes = {"link": 0}
    elif cause == "sampling":
        base["link"] = 0
        calm = 0.5 * stiffness * period / _log(rng, 1.5, 5.0)
        softer = 0.7 * 2 * calm / period
        changes = {"stiffness": softer}
    elif cause == "delay":
        base["delay"] = late = int(rng.integers(1, 12))
        calm = max(calm, 0.0) if late > 2 else calm
        changes = {"delay": 0}
    elif cause == "damping":
        base["link"] = link = int(rng.integers(1, 10))
        calm = stiffness * period * (0.5 + link) * _log(rng, 1.3, 2.5)
        base["damping"] = calm * _log(rng, 0.6, 5.0)
        changes = {"damping": 0.0}
    elif cause == "local damping":
        base["local_damping"] = -calm * _log(rng, 1.1, 3.0)
        changes = {"local_damping": 0.0}
    elif cause == "actuator limit":
        base["kick"] *= rng.uniform(1.0, 3.0)
        base["slew"] = stiffness * swing * natural * _log(rng, 0.1, 1.0)
        base["limit"] = stiffness * swing * _log(rng, 1.5, 10.0)
        changes = {"slew": 0.0}
    else:
        friction *= 4
        base["compensation"] = friction * _log(rng, 1.2, 4.0)
        changes = {"compensation": 0.6 * friction}
    if cause not in ("damping", "local damping") and rng.random() < 0.3:
        base["damping"] = calm * _log(rng, 0.02, 0.15)
    return Arms(
        cause=cause,
        **base,
        viscous=(calm, calm * _log(rng, 0.8, 1.25)),
        coulomb=(friction, friction * _log(rng, 0.8, 1.25)),
        hand_damping=calm * _log(rng, 0.1, 1.0) if base["hand_stiffness"] else 0.0,
        mended=changes,
    )


@dataclass(frozen=True)
class Logged:
    """A file, and what its owner knows of the arms: nothing, or numbers that are somewhat wrong."""

    path: Path
    pair: zw.Pair | None
    columns: str


def write_log(rng: np.random.Generator, arms: Arms, made: Moved, path: Path) -> Logged:
    """Log it: the command, the motor's force or both, with noise; of one in ten nobody knows the arms."""
    which = str(rng.choice(["both", "commanded", "applied"], p=[0.75, 0.15, 0.10]))
    steps = made.measured.shape[1]
    start = int(steps * rng.choice([0.0, 0.0, 0.3]))
    columns = {"time_s": [f"{k * arms.period:.6f}" for k in range(start, steps)]}
    for a, arm in enumerate(("leader", "follower")):
        columns[f"{arm}_position_rad"] = [f"{x:.7g}" for x in made.measured[a, start:]]
        size = float(np.std(made.applied[a])) or 1.0
        noise = size * float(rng.choice([0.0, 0.003, 0.02])) * rng.normal(size=steps)
        if which != "applied":
            columns[f"{arm}_commanded_torque_N_m"] = [f"{f:.6g}" for f in made.commanded[a, start:]]
        if which != "commanded":
            columns[f"{arm}_motor_torque_N_m"] = [f"{f:.6g}" for f in (made.applied[a] + noise)[start:]]
    lines = [",".join(columns), *(",".join(row) for row in zip(*columns.values(), strict=True))]
    path.write_text("\n".join(lines) + "\n", encoding="utf-8")
    return Logged(path, _as_its_owner_knows_it(rng, arms), which)


def _as_its_owner_knows_it(rng: np.random.Generator, arms: Arms) -> zw.Pair | None:
    if rng.random() < 0.1:
        return None
    devices = [
        zw.Device(
            motion="rotary",
            mass=arms.mass[a] * float(f"{rng.uniform(0.85, 1.15):.3f}"),
            damping=arms.viscous[a] * float(f"{rng.uniform(0.85, 1.15):.3f}"),
            coulomb_friction=arms.coulomb[a] * float(f"{rng.uniform(0.85, 1.15):.3f}"),
            resolution=arms.resolution,
            sample_period=arms.period,
        )
        for a in range(2)
    ]
    return zw.Pair(*devices, stiffness=1)
