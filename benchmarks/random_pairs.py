"""Random pairs of arms on both sides of their limit: the proof, and the motion of both hands.

Delays of whole samples and of part of one, links of 0 to 12 samples each way, unequal damping, coupling with
and without B and D, equal and unequal stiffness, ideal encoders and counted ones, some with drives, some of
unequal rates, some with forces that are sent.  The largest stiffness that is passive is found to the last
double; a part in 10⁹ below it the checker must accept the certificate, a part in 10⁹ above it a motion,
replayed, must take energy out.  Of every tenth pair a motion a tenth above the limit is simulated too.

    python random_pairs.py [PAIRS] [FIRST SEED]
"""

from __future__ import annotations

import sys
import time
from collections import Counter
from fractions import Fraction
from statistics import median

import numpy as np

import zwidth as zw
from zwidth.passivity.linear.boundary import largest_holding
from zwidth.passivity.pairs import PairWitness
from zwidth.passivity.pairs.criterion import PairCriterion

BILLIONTH = Fraction(1, 10**9)
LONGEST = 20_000
"""Samples of a motion that is simulated."""


def random_pair(seed: int) -> zw.Pair:
    """Any two arms."""
    random = np.random.default_rng(seed)
    period = Fraction(int(random.choice([1, 2, 5, 10])), 1000)
    counted = random.random() < 0.3

    def number(low: float, high: float) -> str:
        return f"{np.exp(random.uniform(np.log(low), np.log(high))):.4g}"

    def arm() -> zw.Device:
        delay = Fraction(int(random.integers(0, 4)))
        if random.random() < 0.3:
            delay += Fraction(int(random.integers(1, 100)), 100)
        return zw.Device(
            damping=number(0.05, 5),
            coulomb_friction=1000 if counted else number(0.01, 1),
            resolution=number(1e-6, 1e-3) if counted else 0,
            sample_period=period,
            delay=delay * period,
            motion="rotary" if seed % 2 else "linear",
        )

    leader, follower = arm(), arm()
    often = int(random.choice([1, 1, 1, 2, 5, 20, 100]))
    if often > 1:
        leader, follower = leader.replace(delay=0), follower.replace(delay=0)
    share = random.choice([0, 0.1, 0.4, -0.2]) * float(leader.damping)
    local = random.choice([0, 0, 0.3]) * float(leader.damping)
    more = {"follower_stiffness": number(0.5, 2)} if random.random() < 0.3 else {}
    link = tuple(Fraction(int(random.integers(0, 25)), 2) * period for _ in (0, 1))
    if often > 1 and random.random() < 0.5:
        quick = period / often
        leader, follower = (
            (leader.replace(sample_period=quick), follower)
            if random.random() < 0.5
            else (leader, follower.replace(sample_period=quick))
        )
    elif often > 1:
        more |= {"drive_rate": often / period}
    if random.random() < 0.3:
        more |= {"reflection": number(0.2, 2), "follower_reflection": random.choice(["0", "0.5"])}
    return zw.Pair(
        leader,
        follower,
        stiffness=1,
        damping=f"{share:.4g}",
        local_damping=f"{local:.4g}",
        delay=link,
        **more,
    )


def stiffer(pair: zw.Pair, stiffness: Fraction) -> zw.Pair:
    """Both springs in proportion."""
    return pair.stiffened(stiffness)


def replayed(witness: PairWitness | None) -> float | None:
    """What the simulator makes of a motion over what it is said to take out; None where that is not compared.

    Not of long ones, nor of counts, nor of small differences of large works: it computes in doubles.
    """
    if witness is None or witness.samples > LONGEST:
        return None
    pair = witness.pair
    if any(side.resolution for side in pair.sides):
        return None
    hands = [zw.operators.WitnessMotion(motion) for motion in (witness.leader, witness.follower)]
    tick = pair.sample_period / pair.own_readings
    trace = zw.simulate(pair, *hands, (witness.samples + 1) * tick, progress=None)
    moved = float(np.abs(trace["hand_work"].values).max())
    if witness.energy < 1e-9 * moved:
        return None
    leader, follower = trace["hand_work"].values[:, -1]
    return float(-(leader + float(pair.power_ratio) * follower) / witness.energy)


def passive_limit(pair: zw.Pair) -> float | None:
    """The largest stiffness that the criterion allows, to the last double."""

    def holds(k: Fraction) -> bool:
        return not k or PairCriterion(stiffer(pair, k)).holds

    found = largest_holding(holds, 1.0)
    return found if found and holds(Fraction(found) / 2) else None


def main() -> int:
    """Measure and print."""
    count = int(sys.argv[1]) if len(sys.argv) > 1 else 10_000
    first = int(sys.argv[2]) if len(sys.argv) > 2 else 0
    seen: Counter[str] = Counter()
    times: dict[str, list[float]] = {"passive": [], "active": [], "motion": []}
    for seed in range(first, first + count):
        pair = random_pair(seed)
        limit = passive_limit(pair)
        if limit is None:
            seen["no stiffness is passive"] += 1
            pair = stiffer(pair, Fraction(1))
            sides = [(pair, "active")]
        else:
            exact = Fraction(repr(limit))
            sides = [
                (stiffer(pair, exact * (1 - BILLIONTH)), "passive"),
                (stiffer(pair, exact * (1 + BILLIONTH)), "active"),
            ]
        if seed % 10 == 0:
            share = replayed(zw.check(stiffer(pair, Fraction(repr(limit or 1.0)) * Fraction("1.1"))).witness)
            if share is not None:
                seen["simulated, as much" if abs(share - 1) < 1e-6 else "WRONG: simulated"] += 1
        for loop, expected in sides:
            began = time.perf_counter()
            verdict = zw.check(loop)
            times[expected].append(time.perf_counter() - began)
            if verdict.outcome != expected:
                wrong = "" if verdict.outcome == "undecided" else "WRONG: "
                seen[f"{wrong}{verdict.outcome} where {expected}"] += 1
            elif expected == "passive":
                seen["certificate accepted"] += bool(verdict.certificate.verify())
            else:
                began = time.perf_counter()
                witness = verdict.witness
                times["motion"].append(time.perf_counter() - began)
                good = witness is not None and witness.verify() and witness.energy > 0
                seen["motion gains" if good else "violation without a motion"] += 1
                if not good:
                    print("no motion", seed)
                assert verdict.violation is None or verdict.violation.verify()
    for what, number in seen.most_common():
        print(f"{number:>7} {what}")
    for what, values in times.items():
        print(f"{what:>8}: median {1e3 * median(values):.2f} ms, worst {1e3 * max(values):.1f} ms")
    return int(any(what.startswith("WRONG") for what in seen))


if __name__ == "__main__":
    sys.exit(main())
