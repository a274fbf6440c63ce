"""Random pairs of arms, one in a known hand or in nobody's, on both sides of their limit.

Delays of whole samples and of part of one, links of 0 to 6 samples each way, unequal arms, springs, dampers,
forces that are sent, hands of mass, spring and damper, leader or follower held; ideal encoders, no Coulomb
friction.  The largest stiffness with just this hand is found; a part in 10⁶ below it the checker must accept
a certificate, a part in 10⁶ above it a violation.  Both are attacked in the simulator by a wave of the free
arm at the worst frequency, swelling and dying away: below the limit it must not gain, and it is counted how
often it gains a fiftieth above.

    python random_held_pairs.py [PAIRS] [FIRST SEED]
"""

from __future__ import annotations

import sys
import time
from collections import Counter
from fractions import Fraction
from math import acos
from statistics import median

import numpy as np

import zwidth as zw
from zwidth.passivity.linear.criterion import tightest
from zwidth.passivity.pairs.held import HeldPair
from zwidth.passivity.pairs.held.law import felt_loop
from zwidth.passivity.pairs.held.verdict import largest_held_stiffness

MILLIONTH = Fraction(1, 10**6)
LONGEST = 6_000
"""Samples of a wave."""


def random_question(seed: int) -> HeldPair:
    """Any two arms, and a hand on one of them."""
    random = np.random.default_rng(seed)
    period = Fraction(int(random.choice([1, 2, 5])), 1000)

    def number(low: float, high: float) -> str:
        return f"{np.exp(random.uniform(np.log(low), np.log(high))):.4g}"

    def arm() -> zw.Device:
        delay = Fraction(int(random.integers(0, 3)))
        if random.random() < 0.3:
            delay += Fraction(int(random.integers(1, 100)), 100)
        return zw.Device(
            damping=number(0.1, 5),
            mass=number(0.02, 2),
            coulomb_friction=0,
            resolution=0,
            sample_period=period,
            delay=delay * period,
        )

    leader, follower = arm(), arm()
    share = float(random.choice([0, 0, 0.1, 0.3])) * float(leader.damping)
    sent = random.random() < 0.2
    pair = zw.Pair(
        leader,
        follower,
        stiffness=0 if sent else 1,
        follower_stiffness=number(0.5, 2) if sent or random.random() < 0.3 else None,
        reflection=1 if sent else 0,
        damping=f"{share:.4g}",
        local_damping=f"{float(random.choice([0, 0, 0.2])) * float(leader.damping):.4g}",
        delay=tuple(str(int(random.integers(0, 7)) * period) for _ in (0, 1)),
    )
    hand = zw.stability.HandImpedance()
    if random.random() < 0.7:
        hand = zw.stability.HandImpedance(
            mass=number(0.001, 1), stiffness=number(1, 1000), damping=number(0.01, 5)
        )
    return HeldPair(pair, "leader" if random.random() < 0.3 else "follower", hand)


def asked(question: HeldPair) -> zw.passivity.pairs.held.HeldVerdict:
    """The verdict."""
    return zw.check(question.pair, **{question.held: question.hand})


def wave(question: HeldPair, samples: int) -> tuple[float, float]:
    """What a wave at the worst frequency takes out at most, and how much energy moved [J]."""
    law, _ = felt_loop(question, question.motion)
    theta = acos(float(tightest(law)[1]))
    theta = max(theta, 20 * np.pi / samples)
    k = np.arange(samples + 1)
    path = 0.01 * np.sin(np.pi * k / samples) ** 2 * np.sin(theta * k)
    path[-1] = 0
    hand = question.hand
    holds = (
        None
        if hand.is_nobody
        else zw.operators.Finger(
            mass=float(hand.mass),
            stiffness=float(hand.stiffness),
            damping=float(hand.damping),
            force=0,
            start=0,
        )
    )
    both = {question.free: zw.operators.PrescribedMotion(path), question.held: holds}
    trace = zw.simulate(
        question.pair, both["leader"], both["follower"], float(samples * question.pair.sample_period)
    )
    free = trace.sel(arm=question.free)
    work = free["hand_work"].values
    return float(work[0] - work.min()), float(np.abs(free["actuator_work"].values).max())


def main(pairs: int, first: int) -> int:
    """How many verdicts are wrong."""
    said, gains, wrong, seconds = Counter[str](), [], 0, []
    for seed in range(first, first + pairs):
        question = random_question(seed)
        largest = largest_held_stiffness(question)
        if not largest or largest == float("inf"):
            said["no limit"] += 1
            continue
        begun = time.perf_counter()
        below, above = (
            asked(question.stiffened(Fraction(largest) * (1 + sign * MILLIONTH))) for sign in (-1, 1)
        )
        seconds.append((time.perf_counter() - begun) / 2)
        two = below.largest_stiffness_of_any_such_hand
        if two:
            gains.append(largest / two)
        said[f"below: {below.outcome}"] += 1
        said[f"above: {above.outcome}"] += 1
        if below.outcome == "active" or above.outcome == "passive":
            wrong += 1
            print(f"seed {seed}: {below.outcome} below, {above.outcome} above", flush=True)
        if any(arm.part for arm in question.arms[:1]):
            continue
        out, moved = wave(question.stiffened(Fraction(largest) * (1 - MILLIONTH)), LONGEST)
        if below.passive and out > 1e-11 * moved:
            wrong += 1
            print(f"seed {seed}: {out} J of {moved} J came out of a passive pair", flush=True)
        out, moved = wave(question.stiffened(Fraction(largest) * Fraction(51, 50)), LONGEST)
        said["a fiftieth above: gains" if out > 1e-11 * moved else "a fiftieth above: nothing came out"] += 1
    for what, count in sorted(said.items()):
        print(f"{count:6}  {what}")
    print(
        f"limit with just this hand / with anything that damps as much: median {median(gains):.4g}, "
        f"largest {max(gains):.4g}; {1e3 * median(seconds):.1f} ms a verdict; {wrong} wrong"
    )
    return wrong


if __name__ == "__main__":
    numbers = [int(a) for a in sys.argv[1:]]
    sys.exit(1 if main(*(*numbers, *(100, 0)[len(numbers) :])) else 0)
