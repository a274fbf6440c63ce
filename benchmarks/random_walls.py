"""Do available storage and the closed forms ever contradict each other?  Random walls near their limits.

Springs, damped walls, windows of two and finite filters of velocity, clamped or not,
no delay or one sample, stiffness, damping and friction within a third of what is
needed.  Each loop is decided twice: by the closed forms of `zw.check`, and by value
iteration on a small grid of a dozen counts.  What may not be:

  proof against motion     a certificate of kind "spring" or "contact", and a cycle of
                           moves that gains
  in contact               a certificate for sustained contact, and a cycle of
                           moves that gains without ever leaving the wall
  motion against proof     a storage function, and the witness of the check stays
                           within its bounds and takes out more than was stored
  witness                  a cycle of moves that the checker does not accept, or
                           that has another energy in `zw.simulate`, or from which a
                           stiff hand and the mass of the device get nothing

A certificate for sustained contact that a motion through the surface defeats is no
contradiction, as such a certificate does not speak of it; these are counted apart.

    python benchmarks/random_walls.py [--loops 10000] [--seed 0] [--replays 20]
"""

from __future__ import annotations

import argparse
import sys
import time
from collections import Counter
from dataclasses import dataclass, field
from fractions import Fraction
from itertools import pairwise
from math import floor
from random import Random
from typing import Any

import numpy as np
from rich.progress import track

import zwidth as zw
from zwidth.passivity.check import check_by_closed_forms
from zwidth.passivity.storage.domain import Domain, losses_of
from zwidth.passivity.storage.law import finite_law
from zwidth.passivity.storage.program import DynamicProgram

COUNTS = {0: 12, 1: 12, 2: 6, 3: 3, 4: 2}
"""How deep and how fast the hand is, in counts, by readings remembered."""

COVERS_CONTACT = ("spring", "contact")


@dataclass(frozen=True)
class Loop:
    """A device, a wall, and what kind of wall it is."""

    device: zw.Device
    wall: zw.Wall
    name: str
    program: DynamicProgram


@dataclass
class Tally:
    """What came out, and what should not have."""

    outcomes: Counter[str] = field(default_factory=Counter)
    findings: dict[str, list[str]] = field(default_factory=dict)
    rounds: Counter[str] = field(default_factory=Counter)

    def found(self, kind: str, loop: Loop, said: str = "") -> None:
        """Keep a loop on which something was noticed."""
        self.findings.setdefault(kind, []).append(f"{described(loop)} {said}".rstrip())


def digits(value: Fraction | float) -> Fraction:
    """Four digits, as a person would write it down."""
    return Fraction(f"{float(value):.4g}")


def random_loop(random: Random) -> Loop:
    """A wall and a device that is within a third of what it needs, by the closed forms."""
    period = random.choice([Fraction(1, 1000), Fraction(1, 2000), Fraction(1, 500)])
    step = digits(10 ** random.uniform(-5, -3))
    k = digits(10 ** random.uniform(1, 3.5))
    kind = random.choice(["spring", "backward difference", "backward difference", "window", "filter"])
    share = Fraction(0) if kind == "spring" else digits(random.choice([-1, 1, 1]) * random.uniform(0.02, 2))
    b = digits(share * k * period / 2)
    velocity: Any = zw.rendering.BackwardDifference()
    weights, gain = [Fraction(1)], Fraction(1)
    if kind == "window":
        velocity, weights = zw.rendering.Window(2), [Fraction(1, 2)] * 2
    elif kind == "filter":
        first = Fraction(random.randint(-5, 15), 10)
        velocity, weights = zw.rendering.VelocityFilter([first, 1 - first], [1, 0]), [first, 1 - first]
        gain = sum((abs(w) for w in weights), Fraction(0))
    delay = random.choice([0, 0, 1])
    variation = sum((abs(p - q) for p, q in pairwise([Fraction(0), *weights, Fraction(0)])), Fraction(0))
    damping = (2 * delay + 1) * k * period / 2 + abs(b) * gain
    friction = (k + abs(b) / period * variation) * step / 2
    device = zw.Device(
        mass="0.1",
        damping=digits(damping * digits(random.uniform(0.67, 1.33))),
        coulomb_friction=digits(friction * digits(random.uniform(0.67, 1.33))),
        resolution=step,
        sample_period=period,
        delay=delay * period,
    )
    clamped = random.random() < 0.35
    wall = zw.Wall(k, b, velocity, clamped=clamped)
    law, losses = finite_law(device, wall), losses_of(device)
    memory = law.memory + losses.delay
    counts = COUNTS[memory]
    reach = counts if memory < 2 else random.randint(max(1, counts - 1), counts)
    domain = Domain(1 - (memory + 1) * reach, counts, reach)
    name = f"{kind}{', clamped' if clamped else ''}{', delayed' if delay else ''}"
    return Loop(device, wall, name, DynamicProgram(law, losses, domain, device.motion))


def described(loop: Loop) -> str:
    """The numbers of a loop on one line."""
    d, losses = loop.device, loop.program.losses
    return (
        f"[{loop.name}] K {float(loop.wall.stiffness):g} B {float(loop.wall.damping):g} "
        f"taps {[float(c) for c in loop.program.law.taps]} T {float(losses.period):g} "
        f"step {float(losses.resolution):g} b {float(d.damping):g} f_c {float(d.coulomb_friction):g} "
        f"grid {loop.program.domain.highest}/{loop.program.domain.reach}"
    )


def decide(loop: Loop) -> tuple[str, Any]:
    """ "passive" and a storage function, "active" and a motion, or "undecided", by value iteration alone."""
    for steps, fine in ((8, 1024), (32, None)):
        storage = loop.program.prove(steps)
        if storage is not None:
            return "passive", storage
        motion = None if fine is None else loop.program.refute(fine)
        if motion is not None:
            return "active", motion
    return "undecided", None


def readings(loop: Loop, positions: tuple[float, ...] | tuple[Fraction, ...]) -> list[int]:
    """Encoder counts at the samples."""
    return [floor(Fraction(x) / loop.program.losses.resolution) for x in positions]


def stays_in_contact(loop: Loop, motion: Any) -> bool:
    """True when the cycle never leaves the wall, where an unclamped law is linear."""
    part = motion.motion.repeats[0]
    exact = motion.motion.positions[part.first : part.last + 1]
    return not loop.wall.clamped and min(readings(loop, exact)) > 0


def exact_energy(loop: Loop, positions: tuple[Fraction, ...]) -> Fraction:
    """What a motion from rest takes out of the wall with its surface, by the law's definition [J]."""
    law, losses = loop.program.law, loop.program.losses
    seen = [losses.resolution * n for n in readings(loop, positions)]
    taps, out = max(len(law.taps), 1), Fraction(0)
    for k, (here, there) in enumerate(pairwise(positions)):
        ages = tuple(seen[max(k - losses.delay - i, 0)] for i in range(taps))
        moved = there - here
        out -= law.force(ages) * moved + losses.coulomb_friction * abs(moved)
        out -= losses.damping / losses.period * moved**2
    return out


def within(loop: Loop, positions: tuple[Fraction, ...]) -> bool:
    """True when a motion keeps to the bounds."""
    domain, step = loop.program.domain, loop.program.losses.resolution
    fast = max(abs(b - a) for a, b in pairwise(positions))
    return max(positions) < (domain.highest + 1) * step and fast <= domain.reach * step


def stored_at(loop: Loop, storage: Any, position: Fraction) -> Fraction:
    """V of a hand that rests outside, at most [J]."""
    grid = storage.grid
    cell = max(floor(position / loop.program.losses.resolution), grid.domain.lowest)
    row = storage.value[cell - grid.domain.lowest, grid.histories // 2]
    return Fraction(int(row.max())) * grid.energy_unit


def simulated(loop: Loop, motion: Any) -> tuple[float, float]:
    """(energy by exact arithmetic, energy that the simulated port gives out), for 25 rounds."""
    listed = motion.motion.repeated(25).listed().positions
    positions = [float(x) for x in listed]
    for k, n in enumerate(readings(loop, listed)):  # rounded to a double, the hand may be over an edge
        step = float(loop.program.losses.resolution)
        while floor(positions[k] / step) != n:
            positions[k] = float(
                np.nextafter(positions[k], np.inf if floor(positions[k] / step) < n else -np.inf)
            )
    hand = zw.operators.PrescribedMotion([*positions, positions[-1]])
    duration = len(positions) * loop.program.losses.period
    trace = zw.simulate(
        loop.device, loop.wall, hand, duration, amplifier=zw.amplifiers.Ideal(), encoder_phase=0
    )
    return float(exact_energy(loop, listed)), -float(trace.hand_work[-1])


def tracked(loop: Loop, motion: Any) -> bool:
    """True when a hand that is stiff enough, moving the device's mass, takes energy out of every round."""
    for halvings in (10, 14, 16, 18, 20):
        off_the_edge = 2.0**-halvings  # counts by which a hand that is not rigid stays off an edge
        few, many = (_got_by_tracking(loop, motion, rounds, off_the_edge) for rounds in (30, 60))
        if any(later > sooner for sooner, later in zip(few, many, strict=True)):
            return True
    return False


def _got_by_tracking(loop: Loop, motion: Any, rounds: int, off_the_edge: float) -> list[float]:
    """Energy out by hands of rising stiffness [J]."""
    step = float(loop.program.losses.resolution)
    listed = motion.motion.repeated(rounds).listed().positions
    cells = [n * step for n in readings(loop, listed)]
    positions = [max(float(x), edge + off_the_edge * step) for x, edge in zip(listed, cells, strict=True)]
    mass, period = float(loop.device.mass), float(loop.program.losses.period)
    out = []
    for samples in (0.1, 0.03, 0.01, 0.003):  # time in which the hand follows
        stiffness = mass / (samples * period) ** 2
        hand = zw.operators.Tracking(positions, stiffness=stiffness, damping=2 * (stiffness * mass) ** 0.5)
        duration = len(positions) * loop.program.losses.period
        trace = zw.simulate(loop.device, loop.wall, hand, duration, amplifier=zw.amplifiers.Ideal())
        out.append(-float(trace.hand_work[-1]))
    return out


def compare(loop: Loop, tally: Tally, replay: bool) -> None:
    """Decide a loop twice and write down what was noticed."""
    verdict = check_by_closed_forms(loop.device, loop.wall)
    kind = verdict.certificate.kind if verdict.certificate is not None else ""
    outcome, evidence = decide(loop)
    tally.outcomes[f"check {verdict.outcome} {kind}".strip() + f", storage {outcome}"] += 1
    if outcome == "active":
        if not evidence.verify():
            tally.found("witness: rejected by the checker", loop)
        if not within(loop, evidence.motion.positions):
            tally.found("witness: beyond the bounds of the hand", loop, evidence.describe())
        if verdict.outcome == "passive":
            said = evidence.describe()
            if kind in COVERS_CONTACT:
                tally.found("proof against motion", loop, said)
            elif stays_in_contact(loop, evidence):
                tally.found("in contact", loop, said)
            else:
                tally.found("(sustained contact, defeated through the surface)", loop, said)
        if replay:
            _replay(loop, evidence, tally)
    elif outcome == "passive":
        if replay and not evidence.certificate().verify():
            tally.found("storage function: rejected by the checker", loop)
        if verdict.witness is not None:
            _against_proof(loop, verdict.witness, evidence, tally)


def _against_proof(loop: Loop, witness: Any, storage: Any, tally: Tally) -> None:
    motion = witness.motion.listed() if witness.motion.samples < 20_000 else witness.motion
    positions = motion.positions
    if not within(loop, positions):
        tally.rounds["check active by a hand beyond the grid, storage passive"] += 1
        return
    tally.rounds["check active by a hand on the grid, storage passive"] += 1
    out = exact_energy(loop, positions)
    if out > stored_at(loop, storage, positions[0]):
        tally.found("motion against proof", loop, witness.describe())


def _replay(loop: Loop, motion: Any, tally: Tally) -> None:
    tally.rounds["motions replayed in the simulator"] += 1
    exact, seen = simulated(loop, motion)
    losses, listed = loop.program.losses, motion.motion.repeated(25).listed().positions
    scale = float(losses.coulomb_friction * sum(abs(b - a) for a, b in pairwise(listed)))
    if abs(exact - seen) > 1e-9 * scale:
        tally.found("witness: another energy in the simulator", loop, f"{exact:g} J, simulated {seen:g} J")
    moved = [abs(b - a) for a, b in pairwise(Fraction(x) for x in motion.cycle)]
    lost = sum(losses.coulomb_friction * d + losses.damping / losses.period * d**2 for d in moved)
    if motion.exact_gain < lost / 100:  # so little is lost again in the jerks of a hand that is not rigid
        tally.rounds["of these, gain below 1 % of what friction and damping take"] += 1
        return
    tally.rounds["of these, followed by stiff hands with the device's mass"] += 1
    if not tracked(loop, motion):
        tally.found("witness: no stiff hand gets it", loop, motion.describe())


def main() -> int:
    """Run all and print what was noticed."""
    parser = argparse.ArgumentParser(description="Available storage and the closed forms on random walls.")
    parser.add_argument("--loops", type=int, default=10_000)
    parser.add_argument("--seed", type=int, default=0)
    parser.add_argument("--replays", type=int, default=20, help="replay every so many-th loop")
    given = parser.parse_args()
    tally, start = Tally(), time.perf_counter()
    for number in track(range(given.loops), "loops"):
        loop = random_loop(Random(f"{given.seed} {number}"))
        compare(loop, tally, number % given.replays == 0)
    print(f"{given.loops} loops, seed {given.seed}, {time.perf_counter() - start:.0f} s")
    for text, number in sorted((tally.outcomes + tally.rounds).items()):
        print(f"{number:7d}  {text}")
    for kind, found in sorted(tally.findings.items()):
        print(f"{len(found):7d}  {kind}")
        print(*(f"           {text}" for text in found[:5]), sep="\n")
    wrong = sum(len(found) for kind, found in tally.findings.items() if not kind.startswith("("))
    print(f"{wrong} contradictions")
    return int(wrong > 0)


if __name__ == "__main__":
    sys.exit(main())
