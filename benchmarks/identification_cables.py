"""What is promised of devices whose motor and handle move apart, on a cable, a belt or a gear?

    python benchmarks/identification_cables.py [--logs 100] [--first 0] [--plain 20] [--seconds 20]

Each log has its own seed; `--jobs` batches of 100 run side by side. Devices at random: 20 to 500 g, the
motor's side 0.2 to 50 times the handle's, swinging against each other at 20 to 400 Hz on a cable, a belt
or a gear; friction of both kinds on both sides; an encoder of 1 to 50 µm at the motor, 500 Hz to 4 kHz,
a load cell with 5 to 200 mN of noise. Four kinds of log: a hand that wanders, the motor off (held); the
same with taps (tapped); the motor moves to and fro, nobody at the handle (free), or shakes (shaken). Of
each: whether two masses are seen, how often the 95 % intervals hold the truth, and the promise, over the
largest stiffness that is passive with the true numbers, friction viscous. A promise with the condition
that motor and handle move as one is counted by itself. Then the same devices with a rigid cable.
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
TICK = 10
"""Steps of the shortest sample."""
BATCH = 100
KINDS = ("held", "tapped", "free", "shaken")
DAMPED = {"cable": (0.001, 0.03), "belt": (0.02, 0.2), "gear": (0.005, 0.1)}
"""Ratio of the damping of the swing to the critical one."""


def draw(seed, rigid):
    """A device at random, and how it is recorded."""
    rng = np.random.default_rng(seed)

    def between(low, high):
        return float(np.exp(rng.uniform(np.log(low), np.log(high))))

    whole, ratio = between(0.02, 0.5), between(0.2, 50)
    own = {"m1": whole * ratio / (1 + ratio), "m2": whole / (1 + ratio)}
    own |= {f"b{side}": between(0.02, 0.5) for side in (1, 2)}
    own |= {f"f{side}": between(0.005, 0.3) for side in (1, 2)}
    own["step"], own["swing"], own["noise"] = between(1e-6, 5e-5), between(20, 400), between(0.005, 0.2)
    own["what"] = str(rng.choice(list(DAMPED)))
    own["kind"] = KINDS[seed % len(KINDS)]
    damped = between(*DAMPED[own["what"]])
    both = own["m1"] * own["m2"] / whole
    own["k"] = (2 * np.pi * (2e4 if rigid else own["swing"])) ** 2 * both
    own["c"] = 2 * damped * np.sqrt(own["k"] * both)
    own["period"] = float(rng.choice([0.25e-3, 0.5e-3, 1e-3, 2e-3]))
    own["shake"] = rng.uniform(3, 10) * (own["f1"] + own["f2"]) + 5 * whole
    own["stiff"] = 300 * whole + 60 * (own["f1"] + own["f2"])
    own["waves"] = rng.normal(size=8) * 0.02, rng.uniform(0.3, 3, 8), rng.uniform(0, 6.28, 8)
    own["taps"] = rng.uniform(0.003, 0.008), rng.uniform(2, 8) * (own["f1"] + own["f2"]) + 50 * whole
    return own


def record(seeds, owns, seconds):
    """Counts, the actuator's forces and those of the hand, of all devices side by side."""
    runs = len(owns)
    flows, pushes = np.empty((4, 4, runs)), np.empty((2, 4, runs))
    for n, own in enumerate(owns):
        m, o, b, h, k, c = (own[name] for name in ("m1", "m2", "b1", "b2", "k", "c"))
        rates = np.zeros((6, 6))
        rates[0, 1] = rates[2, 3] = 1.0
        rates[1] = np.array([-k, -b - c, k, c, -1, 0]) / m
        rates[3] = np.array([k, c, -k, -h - c, 0, 1]) / o
        flow = expm(rates * STEP)
        flows[:, :, n], pushes[0, :, n], pushes[1, :, n] = flow[:4, :4], flow[:4, 4], flow[:4, 5]

    def column(name):
        return np.array([own[name] for own in owns])

    strikes = np.stack([column("f1") / column("m1"), column("f2") / column("m2")]) * STEP
    every, step, stiff = np.rint(column("period") / STEP).astype(int), column("step"), column("stiff")
    kind = np.array([own["kind"] for own in owns])
    by_hand, tapped = np.isin(kind, ("held", "tapped")), kind == "tapped"
    shake = np.where(kind == "shaken", column("shake"), 0.0)
    rngs = [np.random.default_rng([seed, 1]) for seed in seeds]
    steps = round(seconds / STEP)
    held = np.stack([rng.normal(size=steps // TICK // 2 + 1) for rng in rngs], axis=1) * shake
    beats = np.zeros((steps, runs), dtype=np.float32)
    for n in np.flatnonzero(tapped):
        length, size = owns[n]["taps"]
        tap = size * np.sin(np.pi * np.arange(0, length, STEP) / length)
        for at in np.cumsum(rngs[n].uniform(0.2, 0.6, int(seconds / 0.6)) / STEP).astype(int):
            part = beats[at : at + tap.size, n]
            part += rngs[n].choice([-1, 1]) * tap[: part.size]
    sizes, often, phases = (np.stack([own["waves"][part] for own in owns], axis=1) for part in range(3))

    def goal_of(at):
        return (sizes * np.sin(2 * np.pi * often * at + phases)).sum(axis=0) / 2

    state, motor, goal = np.zeros((4, runs)), np.zeros(runs), goal_of(0.0)
    state[0] = state[2] = goal
    ticks, before = -(-steps // TICK), np.zeros(runs)
    counts = np.empty((ticks, runs), dtype=np.int32)
    forces = np.empty((2, ticks, runs), dtype=np.float32)
    for i in range(steps):
        if i % TICK == 0:
            tick, at = i // TICK, i % every == 0
            goal = goal_of(i * STEP)
            read = np.floor(state[0] / step)
            motor = np.where(
                at & ~by_hand, held[i // (2 * every), np.arange(runs)] - stiff * (goal - read * step), motor
            )
        hand = by_hand * (3 * stiff * (goal - state[2]) - 0.1 * np.sqrt(stiff) * state[3]) + beats[i]
        if i % TICK == 0:
            counts[tick], forces[0, tick], forces[1, tick] = read, motor, (hand + before) / 2
        before = hand
        after = (flows * state).sum(axis=1) + pushes[0] * motor + pushes[1] * hand
        after[1] = slowed(state[1], after[1], strikes[0])
        after[3] = slowed(state[3], after[3], strikes[1])
        state = after
    logs = []
    for n, own in enumerate(owns):
        part = slice(None, None, every[n] // TICK)
        read, motor, hand = counts[part, n] * own["step"], *(forces[:, part, n].astype(float))
        noise = own["noise"] * rngs[n].normal(size=read.size)
        logs.append((read, {"hand_force": hand + noise} if by_hand[n] else {"actuator_force": motor}))
    return logs


def slowed(before, after, strike):
    """The speed after a step with friction, which turns with the motion, or holds."""
    way = np.where((before < 0) | ((before == 0) & (after < 0)), -1.0, 1.0)
    before, after = way * before, way * after
    change = after - before
    turned = (change + strike) * (1 - before / np.where(change < -strike, strike - change, 1.0))
    return way * np.where(after >= strike, after - strike, np.where(change >= -strike, 0.0, turned))


def one(task):
    """Of one log: seen, promise, limit, and for each number whether its interval holds it and its width."""
    seed, own, (read, force) = task
    log = Log.from_arrays(
        time=np.arange(read.size) * own["period"], position=read, resolution=own["step"], **force
    )
    names = ("kind", "what", "swing", "period", "step", "m1", "m2", "b1", "b2", "c", "f1", "f2")
    told = {"seed": seed, "limit": true_limit(own), **{name: own[name] for name in names}}
    start = time.process_time()
    try:
        found = zw.identify(log)
    except zw.InputError as refusal:
        return {**told, "refused": str(refusal)[:90]}
    told |= {"seen": found.cable is not None, "taken": time.process_time() - start}
    told["shows"] = [finding.kind for finding in found.findings]
    if found.shows("wrong model"):
        return {**told, "refused": "wrong model"}
    told["promise"] = 2 * found.least_damping(0.99) / own["period"]
    told["as one"] = found.as_one
    told["sum"] = 2 * (own["b1"] + own["b2"]) / own["period"]
    if found.cable is not None:
        pairs = {**found.cable.motor, **{f"2 {n}": e for n, e in found.cable.between.items()}}
        truth = dict(
            zip(pairs, (own[n] for n in ("m1", "b1", "f1", "m2", "b2", "f2", "k", "c")), strict=True)
        )
        told["held"] = {n: e.interval()[0] <= truth[n] <= e.interval()[1] for n, e in pairs.items()}
        told["z"] = {n: round((e.value - truth[n]) / e.error, 1) for n, e in pairs.items()}
        told["wide"] = {n: round(e.error / truth[n], 3) for n, e in pairs.items()}
    return told


def true_limit(own):
    """Largest stiffness that is passive with the true numbers, where friction is viscous."""
    cable = zw.Transmission(stiffness=own["k"], damping=own["c"], handle_damping=own["b2"])
    device = zw.Device(mass=own["m1"], damping=own["b1"], sample_period=own["period"], transmission=cable)
    return zw.check(device, zw.Wall(stiffness=100)).max_stiffness_viscous


def tell(name, found):
    """A few lines for one kind of log."""
    good = [f for f in found if "promise" in f]
    if not good:
        return
    seen = [f for f in good if f["seen"]]
    print(
        f"{name}: {len(found)} logs, {len(found) - len(good)} refused, {len(seen)} seen as two masses; "
        f"{np.median([f['taken'] for f in good]):.2f} s a log, at most {max(f['taken'] for f in good):.1f}"
    )
    outright = [f for f in good if not f["as one"]]
    for kind, some in (("outright", outright), ("if as one", [f for f in good if f["as one"]])):
        if some:
            over = np.array([f["promise"] / f["limit"] for f in some])
            both = np.median([f["promise"] / f["sum"] for f in some])
            share = f"{100 * (over > 1).mean():.1f} %"
            print(
                f"  promised {kind}: {over.size}, over the limit {(over > 1).sum()} ({share}), by 2 % "
                f"{(over > 1.02).sum()}, at most {over.max():.3g} times, median {np.median(over):.3f}, "
                f"nothing {(over == 0).sum()}; median {both:.3f} of both sides"
            )
    held = [f["held"] for f in seen]
    for key in held[0] if held else ():
        print(f"    {key:26} held in {sum(each[key] for each in held):3d} of {len(held)}")
    if held:
        every = [value for each in held for value in each.values()]
        print(f"    all of them held in {100 * np.mean(every):.1f} %")


def main():
    """All of it."""
    arguments = argparse.ArgumentParser(description=__doc__.splitlines()[0])
    for name, value in {"logs": 100, "first": 0, "plain": 20, "seconds": 20, "jobs": 1}.items():
        arguments.add_argument(f"--{name}", type=int, default=value)
    arguments.add_argument("--verbose", action="store_true")
    given = arguments.parse_args()
    for name, logs, rigid in (("apart", given.logs, False), ("rigid", given.plain, True)):
        batches = [
            range(given.first + at, given.first + min(at + BATCH, logs)) for at in range(0, logs, BATCH)
        ]
        with ProcessPoolExecutor(given.jobs) as pool:
            found = [
                told
                for part in pool.map(batch, batches, [rigid] * len(batches), [given.seconds] * len(batches))
                for told in part
            ]
        for kind in KINDS:
            tell(f"{name}, {kind}", [f for f in found if f["kind"] == kind])
        tell(f"{name}, all", found)
        for one_of in found if given.verbose else ():
            print("   ", {k: float(f"{v:.4g}") if isinstance(v, float) else v for k, v in one_of.items()})


def batch(seeds, rigid, seconds):
    """Some logs, drawn, recorded side by side and identified."""
    owns = [draw(seed, rigid) for seed in seeds]
    return [one(task) for task in zip(seeds, owns, record(seeds, owns, seconds), strict=True)]


if __name__ == "__main__":
    main()
