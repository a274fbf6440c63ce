"""What is promised of devices whose motor and handle move apart, on a cable, a belt or a gear?

    python benchmarks/identification_cables.py [--runs 100] [--plain 20] [--hands 10] [--seconds 30]

Devices at random: 10 to 300 g on each side, swinging against each other at 40 Hz to 2 kHz, friction of both
kinds on both sides, an encoder of 2 to 50 µm at the motor, 1 or 2 kHz.  The motor shakes them, nobody at the
handle.  Of each: whether two masses are seen, how often the 95 % intervals hold the truth, and the promise,
over the largest stiffness that is passive with the true numbers, friction viscous.  The same with a rigid
cable, which is to be one mass; and with a hand that wanders, the motor off, where nothing of it can be seen.
"""

from __future__ import annotations

import argparse
import os
import time
from concurrent.futures import ProcessPoolExecutor

os.environ.setdefault("OPENBLAS_NUM_THREADS", "1")

import numpy as np
from scipy.linalg import expm

import zwidth as zw
from zwidth.data.logs import Log

STEP = 25e-6


def draw(rng, runs, rigid):
    """Numbers of devices at random, an array for each name."""

    def between(low, high):
        return np.exp(rng.uniform(np.log(low), np.log(high), runs))

    bounds = {"m": (0.01, 0.3), "b": (0.03, 0.5), "f": (0.005, 0.2)}
    own = {f"{name}{side}": between(*bounds[name]) for name in bounds for side in (1, 2)}
    own["step"] = between(2e-6, 5e-5)
    own["swing"] = np.full(runs, 1e5) if rigid else between(40, 2000)
    own["both"] = own["m1"] * own["m2"] / (own["m1"] + own["m2"])
    own["k"] = (2 * np.pi * own["swing"]) ** 2 * own["both"]
    own["c"] = 2 * rng.uniform(0.001, 0.05, runs) * np.sqrt(own["k"] * own["both"])
    own["period"] = rng.choice([0.5e-3, 1e-3], runs)
    return own


def record(rng, own, seconds, hands):
    """Positions read, the actuator's forces and those of the hand, of all devices side by side."""
    runs = own["m1"].size
    flows, pushes = np.empty((runs, 4, 4)), np.empty((2, runs, 4))
    for n in range(runs):
        m, o, b, h, k, c = (own[name][n] for name in ("m1", "m2", "b1", "b2", "k", "c"))
        rates = np.zeros((6, 6))
        rates[0, 1] = rates[2, 3] = 1.0
        rates[1] = np.array([-k, -b - c, k, c, -1, 0]) / m
        rates[3] = np.array([k, c, -k, -h - c, 0, 1]) / o
        flow = expm(rates * STEP)
        flows[n], pushes[0, n], pushes[1, n] = flow[:4, :4], flow[:4, 4], flow[:4, 5]
    strikes = np.stack([own["f1"] / own["m1"], own["f2"] / own["m2"]]) * STEP
    whole, every = own["m1"] + own["m2"], np.rint(own["period"] / STEP).astype(int)
    shake = 0.0 if hands else rng.uniform(3, 10, runs) * (own["f1"] + own["f2"]) + 5 * whole
    stiff, steps = 300.0 * whole, round(seconds / STEP)
    waves = rng.normal(size=(8, runs)) * 0.02, rng.uniform(0.3, 3, (8, 1)), rng.uniform(0, 6.28, (8, runs))
    state, hand, motor = np.zeros((runs, 4)), np.zeros(runs), np.zeros(runs)
    held, count, kept = np.zeros(runs), np.zeros(runs, dtype=int), []
    goal = goal_of(0.0, waves)
    state[:, 0] = state[:, 2] = goal
    for i in range(steps):
        at = i % every == 0
        if at.any():
            goal = goal_of(i * STEP, waves)
            read = np.floor(state[:, 0] / own["step"]) * own["step"]
            if hands:
                hand = 30 * stiff / 10 * (goal - state[:, 2])
            else:
                held = np.where(at & (count % 2 == 0), rng.normal(size=runs) * shake, held)
                motor = np.where(at, held - stiff * (goal - read), motor)
            count += at
            kept.append((at, read, motor.copy(), hand.copy()))
        after = np.einsum("nij,nj->ni", flows, state) + pushes[0] * motor[:, None] + pushes[1] * hand[:, None]
        for side, speed in enumerate((1, 3)):
            after[:, speed] = slowed(state[:, speed], after[:, speed], strikes[side])
        state = after
    at, read, motor, hand = (np.array(column) for column in zip(*kept, strict=True))
    return [(read[at[:, n], n], motor[at[:, n], n], hand[at[:, n], n]) for n in range(runs)]


def goal_of(at, waves):
    """Where hand or motor want to be."""
    size, often, phase = waves
    return (size * np.sin(2 * np.pi * often * at + phase)).sum(axis=0) / 2


def slowed(before, after, strike):
    """The speed after a step with friction, which turns with the motion, or holds."""
    way = np.where((before < 0) | ((before == 0) & (after < 0)), -1.0, 1.0)
    before, after = way * before, way * after
    change = after - before
    turned = (change + strike) * (1 - before / np.where(change < -strike, strike - change, 1.0))
    return way * np.where(after >= strike, after - strike, np.where(change >= -strike, 0.0, turned))


def one(task):
    """Of one log: seen, promise, limit, and for each number whether its interval holds it and its width."""
    own, (read, motor, hand), hands, noise = task
    force = {"hand_force": hand + noise} if hands else {"actuator_force": motor}
    log = Log.from_arrays(
        time=np.arange(read.size) * own["period"], position=read, resolution=own["step"], **force
    )
    limit = true_limit(own)
    start = time.perf_counter()
    try:
        found = zw.identify(log)
    except zw.InputError as refusal:
        return {"refused": str(refusal)[:90], "limit": limit, "swing": own["swing"]}
    taken = time.perf_counter() - start
    told = {"seen": found.cable is not None, "limit": limit, "swing": own["swing"], "taken": taken}
    if found.shows("wrong model"):
        return {**told, "refused": "wrong model"}
    told["promise"] = 2 * found.least_damping(0.99) / own["period"]
    told["sum"] = 2 * (own["b1"] + own["b2"]) / own["period"]
    if found.cable is not None:
        pairs = {**found.cable.motor, **{f"2 {n}": e for n, e in found.cable.between.items()}}
        names = ("m1", "b1", "f1", "m2", "b2", "f2", "k", "c")
        truth = dict(zip(pairs, (own[n] for n in names), strict=True))
        told["held"] = {n: e.interval()[0] <= truth[n] <= e.interval()[1] for n, e in pairs.items()}
        told["z"] = {n: round((e.value - truth[n]) / e.error, 1) for n, e in pairs.items()}
    return told


def true_limit(own):
    """Largest stiffness that is passive with the true numbers, where friction is viscous."""
    cable = zw.Transmission(stiffness=own["k"], damping=own["c"], handle_damping=own["b2"])
    device = zw.Device(mass=own["m1"], damping=own["b1"], sample_period=own["period"], transmission=cable)
    return zw.check(device, zw.Wall(stiffness=100)).max_stiffness_viscous


def tell(name, found, verbose):
    """A few lines for one kind of log."""
    good = [f for f in found if "promise" in f]
    seen = [f for f in good if f["seen"]]
    print(f"{name}: {len(found)} logs, {len(found) - len(good)} refused, {len(seen)} seen as two masses")
    for kind, some in (("all", good), ("seen", seen)):
        if some:
            over = np.array([f["promise"] / f["limit"] for f in some])
            both = np.median([f["promise"] / f["sum"] for f in some])
            taken = np.median([f["taken"] for f in some])
            print(
                f"  {kind}: promise over the limit in {(over > 1).sum()} of {over.size}, by 2 % in "
                f"{(over > 1.02).sum()}, at most {over.max():.3g} times, median {np.median(over):.3f}, 0 in "
                f"{(over == 0).sum()}; median {both:.3f} of both sides' 2b/T; {taken:.1f} s a log"
            )
    for key in seen[0]["held"] if seen else ():
        print(f"  {key:26} held in {sum(f['held'][key] for f in seen):3d} of {len(seen)}")
    for one_of in sorted(found, key=lambda f: f["swing"]) if verbose else ():
        print("   ", {k: float(f"{v:.4g}") if isinstance(v, float) else v for k, v in one_of.items()})


def main():
    """All of it."""
    arguments = argparse.ArgumentParser(description=__doc__.splitlines()[0])
    numbers = {"runs": 100, "plain": 20, "hands": 10, "seconds": 30, "seed": 0, "jobs": 2}
    for name, value in numbers.items():
        arguments.add_argument(f"--{name}", type=int, default=value)
    arguments.add_argument("--verbose", action="store_true")
    given = arguments.parse_args()
    kinds = (("shaken", given.runs, False, False), ("shaken, rigid", given.plain, True, False))
    for name, runs, rigid, hands in (*kinds, ("a hand, motor off", given.hands, False, True)):
        if not runs:
            continue
        rng = np.random.default_rng(given.seed)
        own = draw(rng, runs, rigid)
        logs = record(rng, own, given.seconds, hands)
        noises = [0.1 * rng.normal(size=log[0].size) for log in logs]
        tasks = [({k: float(v[n]) for k, v in own.items()}, logs[n], hands, noises[n]) for n in range(runs)]
        with ProcessPoolExecutor(given.jobs) as pool:
            tell(name, list(pool.map(one, tasks)), given.verbose)


if __name__ == "__main__":
    main()
