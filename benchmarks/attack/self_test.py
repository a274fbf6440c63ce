"""Does the referee know the loops that the package runs?  Its energies and forces beside `zw.simulate`."""

from __future__ import annotations

from fractions import Fraction

import numpy as np

import zwidth as zw

from . import loops, rows
from .motions import COUNTED, DRAG, FRICTION, GATE, POSITION, attack
from .referee import energies


def self_test(number: int = 60) -> int:
    """How many loops disagree; prints them."""
    bad = 0
    for seed in range(number):
        rng = np.random.default_rng([1, seed])
        for name, gap in (("linear law", _linear(rng)), ("row of laws", _row(rng))):
            if gap > 1e-4:
                bad += 1
                print(f"{name}, seed {seed}: off by {gap:.3g}")
    print(f"{2 * number} loops, {bad} disagree")
    return bad


def _linear(rng: np.random.Generator) -> float:
    """Largest difference of what was taken out, over what friction, damping and law moved."""
    kind = str(rng.choice(["linear", "contact", "counts", "delay", "rotary"]))
    case = loops.KINDS[kind](rng)
    loop = case.loop
    if loop.remembers and max(abs(np.roots([float(c) for c in loop.denominator])), default=0) > 1:
        return 0.0
    found = attack(loop, rng, 16, 0, kept=False)
    x = found.positions
    out = float(energies(loop, x, phase=found.phase)[-1]) if loop.part == 0 else 0.0
    if loop.part or len(x) < 3:
        return 0.0
    lost = _lost(loop, x)
    score = (out - (float(loop.stored) if loop.fed == "both" else 0.0)) / lost if lost else 0.0
    gap = 0.0 if found.round or not lost else abs(score - found.score) / max(1.0, abs(score))
    return max(gap, _simulated(case, x, float(found.phase), out, lost))


def _lost(loop, x: tuple[Fraction, ...]) -> float:  # type: ignore[no-untyped-def]
    moved = np.abs(np.diff([float(v) for v in x]))
    return float(loop.friction) * moved.sum() + float(loop.damping / loop.period) * (moved**2).sum()


def _simulated(case: loops.Case, x: tuple[Fraction, ...], phase: float, out: float, lost: float) -> float:
    """The same by the simulator, whose hand is held a little off the edges of counts."""
    loop = case.loop
    if loop.damping == 0 or not lost or (phase and loop.resolution):
        return 0.0  # the simulator's phase moves the hand, not the lattice of readings
    step, given = float(loop.resolution), []
    for v in x:
        here = float(v)
        if step:
            cell = int(v // loop.resolution)
            for _ in range(4):
                seen = np.floor(here / step)
                here = here if seen == cell else float(np.nextafter(here, np.inf if seen < cell else -np.inf))
        given.append(here)
    hand = zw.operators.PrescribedMotion([*given, given[-1]])
    device = case.device.replace(mass=1, force_limit=None)
    try:
        trace = zw.simulate(device, case.law, hand, len(given) * loop.period, amplifier=zw.amplifiers.Ideal())
    except zw.InputError:
        return 0.0
    work = trace["actuator_work"].values[len(x) - 1]
    pushed = float(np.abs(np.diff(trace["actuator_work"].values)).sum())
    return abs(work - (out + lost)) / (lost + pushed)


def _row(rng: np.random.Generator) -> float:
    """Largest difference of the forces of a row, over the largest force."""
    row = rows.draw(rng)
    law = np.zeros(13)
    law[GATE], law[COUNTED], law[FRICTION] = POSITION, row.numbers[rows.COUNT], 0.0
    law[DRAG] = float(row.device.exact("damping") / row.device.exact("sample_period"))
    x = np.concatenate([[0.3], 0.3 + np.cumsum(rng.normal(size=39)) * 10 ** rng.uniform(0, 2)])
    force = np.zeros(x.size)
    rows.forces(law, np.array(row.numbers), x, force)
    device = row.device.replace(mass=1, delay=0)
    hand = zw.operators.PrescribedMotion([*(x * row.unit), x[-1] * row.unit])
    trace = zw.simulate(device, row.law, hand, x.size * device.exact("sample_period"))
    seen = trace["actuator_force"].values[: x.size] / row.unit
    step = row.numbers[rows.STEP]
    gap = np.abs(seen - force).max() - 1.01 * step  # rounding may go to the next step
    return float(gap / max(np.abs(seen).max(), 1e-300))
