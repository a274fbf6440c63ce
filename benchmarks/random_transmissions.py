"""Motor, transmission and hand: is the criterion right on random plants, and do prover and checker agree?

Masses, damping, cables of 20 Hz to 20 kHz, delays up to three samples, the encoder at either end, walls with
virtual damping of either sign, solids, filters to order 6, laws that are unstable or integrate.  Each law is
made stiffer to its limit: at (1 − 1e-6) of it a certificate must be accepted, at (1 + 1e-6) a violation, and
one of both at two other gains, of either sign.  Of every eighth plant that is not too stiff the form in the
time domain of the tests has to say the same, at (1 ± 1e-3) of the limit.

    python random_transmissions.py [PLANTS] [FIRST SEED]
    python random_transmissions.py motions [PLANTS] [FIRST SEED] [SECONDS]

The second tells how often, at 1.01 of the limit, a motion is found that takes energy out in the simulator.
"""

from __future__ import annotations

import sys
import time
from collections import Counter
from fractions import Fraction
from pathlib import Path

import numpy as np
from random_plants import random_law

import zwidth as zw
from zwidth.passivity.linear.transmission import Elastic, ElasticProof, decide_elastic
from zwidth.passivity.transmission import elastic_of

sys.path.insert(0, str(Path(__file__).parents[1] / "tests" / "passivity"))
from transmission_lifted import Lifted, Plant

NEAR, CLEAR = Fraction(1, 10**6), Fraction(1, 1000)
EVERY = 8
STIFFEST = 400
"""Radians of the motor in a sample, beyond which the checker's work is too much."""
LARGEST_TURN = 30
"""Beyond it a period would have to be cut into too many pieces."""


def _number(value: float) -> str:
    return f"{value:.6g}"


def plant(rng: np.random.Generator) -> zw.Device:
    """Any device with a transmission that the criterion covers."""
    period = 10 ** rng.uniform(-4, -2.5)
    mass = 10 ** rng.uniform(-6, 1)
    damping = mass / period * 10 ** rng.uniform(-4, 0) * (rng.random() > 0.05)
    stiffness = mass * (2 * np.pi * 10 ** rng.uniform(1.3, 4.3)) ** 2
    inside = 2 * np.sqrt(stiffness * mass) * 10 ** rng.uniform(-5, 0.5) * (rng.random() > 0.3)
    outside = mass / period * 10 ** rng.uniform(-5, 1) * (rng.random() > 0.1 or not damping or not inside)
    delay = period * (0, int(rng.integers(0, 4)), rng.uniform(0, 3))[int(rng.integers(3))]
    numbers = {"stiffness": stiffness, "damping": inside, "handle_damping": outside}
    return zw.Device(
        mass=_number(mass),
        damping=_number(damping),
        sample_period=_number(period),
        delay=_number(delay),
        transmission=zw.Transmission(
            **{name: _number(value) for name, value in numbers.items()},
            encoder=("motor", "handle")[int(rng.random() < 0.4)],
        ),
    )


def law(rng: np.random.Generator, period: float) -> zw.PulseTransferFunction:
    """H(z) with H(1) or its largest coefficient near 1."""
    sort = int(rng.integers(8))
    if sort < 2:
        wall = zw.Wall(1, damping=_number(period * rng.normal() * 10 ** rng.uniform(-1, 2) * sort))
    elif sort == 2:
        wall = zw.StandardLinearSolid(
            1, _number(10 ** rng.uniform(-1, 2)), _number(period * 10 ** rng.uniform(-1, 3))
        )
    elif sort == 3:
        pole = rng.uniform(0, 1)
        share = rng.uniform(0, 1) * (1 - pole)
        return zw.PulseTransferFunction([1, _number(share - 1)], [1, -1])
    elif sort == 4:
        return zw.PulseTransferFunction(*random_law(rng, int(rng.integers(1, 4)), 1.1))
    else:
        return zw.PulseTransferFunction(*random_law(rng, int(rng.integers(1, 7)), 0.99))
    h = wall.pulse_transfer_function(Fraction(_number(period)))
    return zw.PulseTransferFunction(h.numerator, h.denominator)


class Loops:
    """A device and a law, the more the stiffer."""

    def __init__(self, seed: int) -> None:
        rng = np.random.default_rng(seed)
        while True:
            self.device = plant(rng)
            self.law = law(rng, float(self.device.sample_period))
            found = elastic_of(self.device, self.at(Fraction(1)))
            if found is not None and found.turn < STIFFEST:
                break
        loop = self.elastic(Fraction(1)).loop
        self.start = float((loop.damping + self.device.transmission.handle_damping.fraction) / loop.period)

    def at(self, gain: Fraction) -> zw.PulseTransferFunction:
        """The law times a factor."""
        h = self.law.pulse_transfer_function(self.device.exact("sample_period"))
        return zw.PulseTransferFunction([gain * c for c in h.numerator], h.denominator)

    def elastic(self, gain: Fraction) -> Elastic:
        """What is decided."""
        found = elastic_of(self.device, self.at(gain))
        assert found is not None
        return found

    def holds(self, gain: Fraction) -> bool:
        """Whether the prover has a proof."""
        return isinstance(decide_elastic(self.elastic(gain)), ElasticProof)

    def limit(self) -> Fraction | None:
        """A gain below which a proof is found and above which none; None without one."""
        gains = [Fraction(_number(self.start * 4.0**power)) for power in range(4, -24, -1)]
        above = below = None
        for gain in gains:
            if self.holds(gain):
                below = gain
                break
            above = gain
        if above is None or below is None:
            return None
        while above - below > below * NEAR / 8:
            middle = Fraction(f"{float(above + below) / 2:.12g}")
            below, above = (middle, above) if self.holds(middle) else (below, middle)
        return below


def one(seed: int) -> tuple[list[str], list[str]]:
    """What is wrong, and the sorts of what was decided."""
    rng = np.random.default_rng([seed, 1])
    loops = Loops(seed)
    limit = loops.limit()
    around = limit or Fraction(_number(loops.start))
    gains = {around * Fraction(_number(rng.choice([-1, 1]) * 10 ** rng.uniform(-2, 2))): "" for _ in range(2)}
    if limit:
        gains |= {limit * (1 - NEAR): "passive", limit * (1 + NEAR): "active"}
    wrong, sorts = [], ["a limit" if limit else "no limit"]
    for gain, outcome in gains.items():
        verdict = zw.check(loops.device, loops.at(gain), contact="kept", iterate=False)
        evidence = verdict.certificate or verdict.violation
        if verdict.outcome not in ([outcome] if outcome else ["passive", "active"]):
            wrong.append(f"{verdict.outcome} at {gain}, {outcome}: {verdict.claim}")
        elif evidence is None or not evidence.verify():
            wrong.append(f"{verdict.outcome} at {gain} without evidence")
        else:
            sorts.append(
                f"{verdict.outcome}: {getattr(decide_elastic(loops.elastic(gain)), 'reason', 'criterion')}"
            )
    if seed % EVERY == 0 and loops.elastic(around).turn < LARGEST_TURN:
        sorts.append("in the time domain")
        clear = {limit * (1 - CLEAR), limit * (1 + CLEAR)} if limit else set()
        others = {gain for gain, outcome in gains.items() if not outcome}
        wrong += [text for gain in clear | others if (text := lifted(loops.elastic(gain)))]
    return wrong, sorts


def lifted(elastic: Elastic) -> str:
    """What the time domain says otherwise."""
    pieces, it = int(max(32, 3 * elastic.turn)), Plant.of(elastic)
    decision = decide_elastic(elastic)
    cosine = getattr(decision, "cosine", None)
    form = Lifted(it, pieces)
    least = form.worst()[0]
    if cosine is not None:
        least = min(least, form.least(float(np.arccos(float(cosine)))))
    passive = it.growth < 1 and it.at_rest >= 0 and least >= 0
    if passive is isinstance(decision, ElasticProof):
        return ""
    return f"growth {it.growth}, at rest {it.at_rest}, least {least}, and {decision}"


def motion(seed: int) -> str:
    """What became of the search for a motion, in a word or two."""
    loops = Loops(seed)
    limit = loops.limit()
    if limit is None:
        return "no limit"
    verdict = zw.check(loops.device, loops.at(limit * Fraction(101, 100)), contact="kept", iterate=False)
    if verdict.outcome != "active":
        return f"{verdict.outcome} at 1.01"
    turns = loops.elastic(limit).turn
    try:
        found = verdict.witness
    except zw.InputError as error:
        return f"not simulated: {str(error)[:60]}"
    sort = verdict.violation.refutation.reason
    if found is not None:
        return f"found: {sort}"
    return f"not found: {sort}, {'over' if turns > LARGEST_TURN else 'up to'} {LARGEST_TURN} radians a sample"


def motions(count: int = 1000, first: int = 0, seconds: int = 600) -> int:
    """Run as many as the time allows, and print."""
    end, seen = time.monotonic() + seconds, Counter[str]()
    for seed in range(first, first + count):
        if time.monotonic() > end:
            break
        start = time.perf_counter()
        told = motion(seed)
        seen[told] += 1
        if "not" in told:
            print(f"seed {seed}: {told}, {time.perf_counter() - start:.1f} s", flush=True)
    for what, number in sorted(seen.items()):
        print(f"{number:>7} {what}")
    return 0


def main() -> int:
    """Run and print."""
    if sys.argv[1:2] == ["motions"]:
        return motions(*map(int, sys.argv[2:]))
    count = int(sys.argv[1]) if len(sys.argv) > 1 else 1000
    first = int(sys.argv[2]) if len(sys.argv) > 2 else 0
    seen: Counter[str] = Counter()
    bad, longest = 0, (0.0, 0)
    for seed in range(first, first + count):
        start = time.perf_counter()
        wrong, sorts = one(seed)
        longest = max(longest, (time.perf_counter() - start, seed))
        seen.update(sorts)
        for text in wrong:
            print(f"seed {seed}: {text}", flush=True)
        bad += bool(wrong)
    for what, number in sorted(seen.items()):
        print(f"{number:>7} {what}")
    print(f"{bad} wrong of {count}; the longest took {longest[0]:.1f} s (seed {longest[1]})")
    return int(bool(bad))


if __name__ == "__main__":
    sys.exit(main())
