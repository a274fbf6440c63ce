"""Compensation of friction in random pairs: nothing that is proved gains, and how wide the gap is.

Of each pair of `random_pairs.py`, at up to nine tenths of its largest stiffness, friction is compensated, on
both sides alike or not, by F up to four times its Coulomb friction.  The largest share of that which is
proved is found to the last double.  There the checker must accept the certificate, and motions of both hands,
drawn at random at any speed, must take nothing out.  Above it nothing may be passive; how much more it takes
until a motion is found is the gap.

    python random_compensation.py [PAIRS] [FIRST SEED]
"""

from __future__ import annotations

import sys
from collections import Counter
from fractions import Fraction

import numpy as np
from random_pairs import passive_limit, random_pair, stiffer

import zwidth as zw
from zwidth.passivity.linear.boundary import largest_holding
from zwidth.passivity.pairs.criterion import PairCriterion
from zwidth.passivity.pairs.evidence import energy_of
from zwidth.passivity.pairs.limits import is_passive, with_share
from zwidth.passivity.pairs.motions import stored_at_start
from zwidth.passivity.witness.motion import Motion

GRID = Fraction(1, 10**9)
GAPS = (1e-9, 1e-6, 1e-3, 1e-2, 0.1, 0.3, 1.0)
MOTIONS = 24


def compensated(seed: int) -> zw.Pair | None:
    """Some pair with a share of its friction compensated; None where without that none is passive."""
    random = np.random.default_rng(seed)
    pair = random_pair(seed)
    limit = passive_limit(pair)
    if limit is None:
        return None
    pair = stiffer(pair, Fraction(f"{limit * random.uniform(0.1, 0.9):.4g}"))
    arms = [_rubbed(pair, name, random.uniform(1, 3)) for name in ("leader", "follower")]
    pair = pair.replace(leader=arms[0], follower=arms[1])
    laws = [_law(arm, random) for arm in arms]
    return pair.replace(compensation=laws[0], follower_compensation=laws[int(random.integers(2))])


def _rubbed(pair: zw.Pair, name: str, times: float) -> zw.Device:
    """With a little more Coulomb friction than the encoders ask for."""
    device: zw.Device = getattr(pair, name)
    here = ("leader", "follower").index(name)
    arms = PairCriterion(pair).arms
    error = float(arms[here].force_error(arms[1 - here]))
    return device.replace(coulomb_friction=f"{times * error:.4g}") if error else device


def _law(arm: zw.Device, random: np.random.Generator) -> zw.FrictionCompensation:
    return zw.FrictionCompensation(
        coulomb=f"{random.choice([0.5, 1.5, 4]) * float(arm.coulomb_friction):.4g}",
        viscous=f"{random.choice([0, 0.05, 0.2]) * float(arm.damping):.4g}",
        speed=f"{random.choice([0, 0.01, 0.1, 1, 10]):g}",
    )


def most_taken(pair: zw.Pair, random: np.random.Generator) -> float:
    """The most energy beyond what was stored, of motions at random [J]."""
    often = pair.own_readings
    arms = PairCriterion(pair).arms
    most = -np.inf
    for trial in range(MOTIONS):
        k = np.arange(int(random.integers(2, 25)) * often)
        turns = random.uniform(0, 0.5 / often)
        motions = []
        for arm in arms:
            x = (
                np.cumsum(random.normal(size=len(k))),
                np.sin(2 * np.pi * turns * k + random.uniform(0, 6)),
                np.minimum(k, len(k) - k) * random.choice([-1.0, 1.0]),
            )[trial % 3]
            path = [round(Fraction(v) / GRID) * GRID for v in 10.0 ** random.uniform(-6, 1) * (x - x[0])]
            turned = [(a + b) / 2 for a, b in zip(path, path[1:], strict=False)] if arm.part else []
            motions.append(Motion(tuple(path), tuple(turned)))
        energy = energy_of(pair, *motions)
        if energy is not None:
            most = max(most, float(energy - stored_at_start(pair)))
    return most


def main() -> int:
    """Measure and print."""
    count = int(sys.argv[1]) if len(sys.argv) > 1 else 1000
    first = int(sys.argv[2]) if len(sys.argv) > 2 else 0
    seen: Counter[str] = Counter()
    for seed in range(first, first + count):
        pair = compensated(seed)
        if pair is None or not is_passive(with_share(pair, Fraction(0))):
            seen["no share is passive"] += 1
            continue
        share = largest_holding(lambda s, pair=pair: is_passive(with_share(pair, s)), 1.0)
        assert share is not None
        exact = Fraction(repr(share))
        below = with_share(pair, exact)
        certificate = zw.check(below).certificate
        seen["certificate accepted" if certificate and certificate.verify() else "WRONG: refused"] += 1
        if most_taken(below, np.random.default_rng(seed)) > 0:
            seen["WRONG: a motion gains where none may"] += 1
            print("wrong", seed)
        sort = "counted" if pair.leader.exact("resolution") else "ideal encoders"
        seen[f"{sort}, {_gap(pair, exact, seen)}"] += 1
    for what, number in sorted(seen.items()):
        print(f"{number:>7} {what}")
    return int(any(what.startswith("WRONG") and number for what, number in seen.items()))


def _gap(pair: zw.Pair, share: Fraction, seen: Counter[str]) -> str:
    """How much more than is proved until a motion is found."""
    for gap in GAPS:
        verdict = zw.check(with_share(pair, share * (1 + Fraction(repr(gap)))))
        if verdict.outcome == "active":
            good = verdict.witness is not None and verdict.witness.verify()
            seen["motion gains" if good else "violation without a motion"] += 1
            return f"active {gap:g} above"
        seen["WRONG: passive above"] += verdict.outcome == "passive"
    return f"undecided {GAPS[-1]:g} above"


if __name__ == "__main__":
    sys.exit(main())
