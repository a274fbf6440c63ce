"""Is a motion that is commanded taken for a fault?  Joints that follow a target, in loops that are quiet.

    python benchmarks/commanded.py FOLDER [--logs 300] [--seed 1] [--kinds other] [--target 0.3]

It knows nothing of the diagnosis.  Each joint is driven by f = K (r − x) + D (ṙ − v), or − D v, with or
without what a controller adds (gravity, inertia, its part of the friction); the target r does something, and
the loop comes to rest where the target does: a draw that does not is not counted.  `--kinds known` are those
that the limits of the diagnosis were looked at with, `other` those that they were not.  A share of the files
has a column of the target.
"""

from __future__ import annotations

import argparse
from collections import Counter
from collections.abc import Callable
from dataclasses import dataclass
from pathlib import Path
from typing import Any

import numpy as np

import zwidth as zw

Array = np.ndarray
FINE = 8
"""Steps of the integrator in a sample period."""
SAMPLES = 6000


@dataclass(frozen=True)
class Joints:
    """One row for each joint; SI units."""

    period: Array
    mass: Array
    damping: Array
    coulomb: Array
    resolution: Array
    gravity: Array
    stiffness: Array
    braking: Array
    """D."""
    of_target: Array
    """1 where D brakes against the target's speed, 0 where against standing still."""
    helped: Array
    """Share of the friction, of gravity and of inertia that the controller adds."""
    late: Array
    """Samples."""
    limit: Array
    size: Array
    """Of the target's motion, from the middle."""
    frequency: Array
    """[Hz] of the target."""


def drawn(rng: np.random.Generator, count: int) -> Joints:
    """Joints of arms, wheels and paddles with gains that are usual."""

    def log(low: float, high: float) -> Array:
        return np.exp(rng.uniform(np.log(low), np.log(high), count))

    period = 1 / rng.choice([100.0, 200, 250, 500, 1000], count)
    mass = log(0.003, 0.5)
    natural = log(8.0, 60.0)
    natural = np.minimum(natural, 0.12 / period)
    stiffness = mass * natural**2
    braking = 2 * rng.uniform(0.3, 1.0, count) * mass * natural
    size = log(0.05, 0.5)
    frequency = rng.uniform(0.5, 1.0, count) * np.minimum(natural / (2 * np.pi) * log(0.1, 1.0), 6.0)
    damping = braking * log(0.02, 0.5)
    damping = np.maximum(damping, 0.6 * (stiffness * period / 2))
    coulomb = stiffness * size * log(0.003, 0.1)
    return Joints(
        period=period,
        mass=mass,
        damping=damping,
        coulomb=coulomb,
        resolution=2 * np.pi / rng.choice([4096.0, 16384, 65536, 1e6], count),
        gravity=rng.choice([0.0, 0.0, 1.0], count) * stiffness * size * log(0.1, 1.0),
        stiffness=stiffness,
        braking=braking,
        of_target=rng.choice([0.0, 1.0], count),
        helped=rng.choice([0.0, 0.0, 0.7, 0.9], count),
        late=rng.choice([0, 0, 1], count),
        limit=rng.choice([np.inf, np.inf, 1.0], count) * stiffness * size * log(0.3, 2.0),
        size=size,
        frequency=np.clip(frequency, 0.45, 6.0),
    )


def _phase(j: Joints, t: Array) -> Array:
    return (t * j.frequency) % 1.0


def _eased(s: Array) -> Array:
    return s**3 * (10 - 15 * s + 6 * s**2)


def sine(j: Joints, rng: np.random.Generator) -> Callable[[Array], Array]:
    """A sweep stopped at one frequency."""
    return lambda t: j.size * np.sin(2 * np.pi * j.frequency * t)


def minimum_jerk(j: Joints, rng: np.random.Generator) -> Callable[[Array], Array]:
    """To and fro between two places."""

    def at(t: Array) -> Array:
        p = _phase(j, t)
        return j.size * (2 * _eased(np.where(p < 0.5, 2 * p, 2 - 2 * p)) - 1)

    return at


def trapezoid(j: Joints, rng: np.random.Generator) -> Callable[[Array], Array]:
    """To and fro at one speed, with ramps of a tenth of the way."""

    def at(t: Array) -> Array:
        p = _phase(j, t)
        s = np.where(p < 0.5, 2 * p, 2 - 2 * p)
        r = 0.1
        eased = np.where(
            s < r, s * s / (2 * r), np.where(s > 1 - r, 1 - r - (1 - s) ** 2 / (2 * r), s - r / 2)
        )
        return j.size * (2 * eased / (1 - r) - 1)

    return at


def teleoperated(j: Joints, rng: np.random.Generator) -> Callable[[Array], Array]:
    """A leader that a hand moves: five tones around one frequency."""
    shares = rng.uniform(0.6, 1.4, (5, j.size.size))
    starts = rng.uniform(0, 2 * np.pi, (5, j.size.size))
    sizes = rng.uniform(0.2, 1.0, (5, j.size.size))
    return lambda t: (
        j.size
        * (sizes * np.sin(2 * np.pi * shares * j.frequency * t + starts)).sum(axis=0)
        / sizes.sum(axis=0)
    )


def with_rests(j: Joints, rng: np.random.Generator) -> Callable[[Array], Array]:
    """Pick and place: there, a rest, back, a rest."""
    rest = rng.uniform(0.1, 0.3, j.size.size)

    def at(t: Array) -> Array:
        p = _phase(j, t)
        s = np.where(p < 0.5, p, 1 - p) * 2
        return j.size * (2 * _eased(np.clip((s - rest / 2) / (1 - rest), 0, 1)) - 1)

    return at


def stations(j: Joints, rng: np.random.Generator) -> Callable[[Array], Array]:
    """From one of four places to the next, in a rhythm."""
    places = rng.uniform(-1, 1, (4, j.size.size))

    def at(t: Array) -> Array:
        turn = t * j.frequency * 2
        now = np.floor(turn).astype(int) % 4
        s = _eased(np.clip((turn % 1.0) / 0.8, 0, 1))
        column = np.arange(j.size.size)
        return j.size * (places[now, column] * (1 - s) + places[(now + 1) % 4, column] * s)

    return at


def gait(j: Joints, rng: np.random.Generator) -> Callable[[Array], Array]:
    """A leg's joint: three harmonics."""
    parts = rng.uniform(0.1, 0.6, (2, j.size.size))
    starts = rng.uniform(0, 2 * np.pi, (2, j.size.size))

    def at(t: Array) -> Array:
        turn = 2 * np.pi * j.frequency * t
        return j.size * (
            np.sin(turn)
            + parts[0] * np.sin(2 * turn + starts[0])
            + 0.5 * parts[1] * np.sin(3 * turn + starts[1])
        )

    return at


def steps(j: Joints, rng: np.random.Generator) -> Callable[[Array], Array]:
    """A square wave, as gains are tuned with."""
    return lambda t: np.where(_phase(j, t) < 0.5, 0.3, -0.3) * j.size


def beating(j: Joints, rng: np.random.Generator) -> Callable[[Array], Array]:
    """Two sines close to each other, of a circle that is drawn by two joints."""
    other = rng.uniform(0.8, 0.95, j.size.size)
    return lambda t: (
        j.size
        * 0.5
        * (np.sin(2 * np.pi * j.frequency * t) + np.sin(2 * np.pi * other * j.frequency * t + 1.0))
    )


def waypoints(j: Joints, rng: np.random.Generator) -> Callable[[Array], Array]:
    """A policy's actions, ten to thirty a second, held."""
    rate = rng.choice([10.0, 20, 30], j.size.size)
    smooth = teleoperated(j, rng)
    return lambda t: smooth(np.floor(t * rate) / rate)


KINDS = {
    "known": (sine, minimum_jerk, trapezoid, teleoperated),
    "other": (with_rests, stations, gait, steps, beating, waypoints),
}


@dataclass(frozen=True)
class Moved:
    """At the samples, a column for each joint."""

    time: Array
    measured: Array
    commanded: Array
    applied: Array
    target: Array


def run(j: Joints, target: Callable[[Array], Array], kick: Array | None = None) -> Moved:
    """Integrate: friction is taken off implicitly, so that it sticks."""
    count = j.size.size
    shape = (SAMPLES, count)
    time, measured, commanded, applied, targets = (np.zeros(shape) for _ in range(5))
    x = target(np.zeros(count))
    v = np.zeros(count) if kick is None else kick
    dt = j.period / FINE
    asked = np.zeros((2, count))
    before_x, before_r, before_rd = np.round(x / j.resolution) * j.resolution, x.copy(), np.zeros(count)
    speed = np.zeros(count)
    for k in range(SAMPLES):
        t = k * j.period
        r = target(t)
        m = np.round(x / j.resolution) * j.resolution
        speed = 0.5 * speed + 0.5 * (m - before_x) / j.period
        rd = (r - before_r) / j.period
        ahead = j.helped * (
            j.coulomb * np.tanh(rd / (0.05 * j.size * j.frequency + 1e-9))
            + j.gravity * np.cos(m)
            + j.mass * np.clip((rd - before_rd) / j.period, -1e3, 1e3)
        )
        f = j.stiffness * (r - m) + j.braking * (j.of_target * rd - speed) + ahead
        f = np.clip(f, -j.limit, j.limit)
        asked = np.stack([f, asked[0]])
        given = np.where(j.late == 0, asked[0], asked[1])
        time[k], measured[k], commanded[k], applied[k], targets[k] = t, m, f, given, r
        before_x, before_r, before_rd = m, r, rd
        for _ in range(FINE):
            v = v + dt / j.mass * (given - j.damping * v - j.gravity * np.cos(x))
            v = np.sign(v) * np.maximum(np.abs(v) - dt * j.coulomb / j.mass, 0.0)
            x = x + dt * v
    return Moved(time, measured, commanded, applied, targets)


def quiet(j: Joints) -> Array:
    """Which of the loops come to rest where the target stands still."""
    made = run(j, lambda t: np.zeros(j.size.size), kick=2 * np.pi * j.frequency * j.size)
    last = made.measured[-SAMPLES // 5 :]
    return np.isfinite(last).all(axis=0) & (np.ptp(last, axis=0) <= 2 * j.resolution + 1e-3 * j.size)


def written(rng: np.random.Generator, j: Joints, made: Moved, k: int, path: Path, target: bool) -> Any:
    """Log one joint as people do; what its owner knows of the device."""
    every = int(rng.choice([1, 1, 2]))
    seconds = float(rng.uniform(4, 16))
    rows = slice(0, min(SAMPLES, int(seconds / j.period[k])), every)
    which = str(rng.choice(["both", "commanded", "applied"], p=[0.3, 0.35, 0.35]))
    noise = float(np.std(made.applied[:, k])) * rng.choice([0.0, 0.003, 0.02]) * rng.normal(size=SAMPLES)
    columns = {"time_s": made.time[rows, k], "position_rad": made.measured[rows, k]}
    if which != "applied":
        columns["commanded_torque_N_m"] = made.commanded[rows, k]
    if which != "commanded":
        columns["motor_torque_N_m"] = (made.applied[:, k] + noise)[rows]
    if target:
        columns["target_position_rad"] = made.target[rows, k]
    table = np.column_stack(list(columns.values()))
    lines = [",".join(columns), *(",".join(f"{value:.7g}" for value in row) for row in table)]
    path.write_text("\n".join(lines) + "\n", encoding="utf-8")
    about = [float(f"{rng.uniform(0.85, 1.15):.3f}") for _ in range(3)]
    if rng.random() < 0.4:
        return None
    return zw.Device(
        motion="rotary",
        mass=float(j.mass[k]) * about[0],
        damping=float(j.damping[k]) * about[1],
        coulomb_friction=float(j.coulomb[k]) * about[2],
        resolution=float(j.resolution[k]),
        sample_period=float(j.period[k]),
    )


def logs(folder: Path, count: int, seed: int, kinds: str, share: float) -> list[tuple[str, Path, Any, bool]]:
    """Draw them, in the same order for a seed: kind, file, device, whether the target is in it."""
    folder.mkdir(parents=True, exist_ok=True)
    found = []
    for n, kind in enumerate(KINDS[kinds]):
        rng = np.random.default_rng([seed, n])
        wanted = -(-count // len(KINDS[kinds]))
        j = drawn(rng, 3 * wanted)
        still = np.flatnonzero(quiet(j))[:wanted]
        made = run(j, kind(j, rng))
        for k in still:
            with_target = bool(rng.random() < share)
            path = folder / f"{kind.__name__}{k}.csv"
            found.append((kind.__name__, path, written(rng, j, made, k, path, with_target), with_target))
    return found[:count] if len(found) > count else found


def main() -> int:
    """Draw, ask, count; 1 where more than 2 % are given a cause."""
    raw = argparse.RawDescriptionHelpFormatter
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=raw)
    parser.add_argument("folder", type=Path)
    parser.add_argument("--logs", type=int, default=300)
    parser.add_argument("--seed", type=int, default=1)
    parser.add_argument("--kinds", choices=KINDS, default="other")
    parser.add_argument(
        "--target", type=float, default=0.3, help="share of files with a column of the target"
    )
    given = parser.parse_args()
    said: Counter[tuple[str, str]] = Counter()
    for kind, path, device, _ in logs(given.folder, given.logs, given.seed, given.kinds, given.target):
        found = zw.diagnose(path, device)
        said[kind, found.cause or ("still" if found.frequency is None else "cannot tell")] += 1
        if found.cause is not None:
            print(f"{path.name}: {found.cause} ({found.confidence:.2f})")
    named = sum(n for (_, what), n in said.items() if what not in ("cannot tell", "still"))
    total = sum(said.values())
    for (kind, what), n in sorted(said.items()):
        print(f"{kind:16} {what:28} {n}")
    print(f"{total} logs of motion that was commanded: {named} given a cause ({100 * named / total:.1f} %)")
    return int(named > 0.02 * total)


if __name__ == "__main__":
    raise SystemExit(main())
