"""Random loops through the simulator: does the energy ledger close in every one?

    python benchmarks/random_simulations.py [--loops 1000000] [--seed 0]

Each loop has its own mass, friction, stiction, wall, encoder, delay, amplifier
and hand, over several orders of magnitude, and runs for 50 samples.  Two
balances are held against each other: what the hand and the actuator put into
the device against what it stores and loses, and what the muscles put into the
hand.  The residual is measured against the energy moved: the sum of losses
and of the largest values of all the others.
"""

from __future__ import annotations

import argparse
import sys
import time

import numpy as np

from zwidth.loop import kernel as k
from zwidth.loop import law as laws
from zwidth.loop.plant import FAULT, STATE_SIZE, STOPS, WORK

SAMPLES = 50
BOUND = 1e-12
_KINDS = 6


def _spread(rng, low, high):
    return low * (high / low) ** rng.random()


def _draw(rng, numbers, law, force, anchor):
    """One random loop; returns (late, offset, period, position, velocity)."""
    kind = int(rng.random() * _KINDS)  # free, damped hand, tied, tied with lag, tied with slew, free with lag
    period = _spread(rng, 1e-4, 2e-2)
    mass = _spread(rng, 1e-3, 3.0)
    rate = 20.0 / period  # of the quickest mode that is drawn
    numbers[:] = 0.0
    numbers[0] = mass
    numbers[1] = 0.0 if rng.random() < 0.5 else _spread(rng, 1e-3, 1.0)
    total = numbers[0] + numbers[1]
    numbers[2] = 0.0 if rng.random() < 0.2 else total * _spread(rng, 1e-3, 1.0) / period
    size = _spread(rng, 1e-2, 20.0)
    numbers[3] = 0.0 if rng.random() < 0.2 else size * _spread(rng, 1e-3, 1.0)
    numbers[4] = numbers[3] * (1.0 if rng.random() < 0.5 else 1.0 + rng.random())
    if kind in (2, 3, 4):
        w = _spread(rng, 0.01 / period, rate)
        numbers[5] = total * w * w
    if kind in (1, 2, 3, 4):
        numbers[6] = 0.0 if rng.random() < 0.2 else total * _spread(rng, 0.01 / period, rate)
    if kind in (3, 5):
        numbers[7] = period * _spread(rng, 0.05, 20.0)
    if kind == 4:
        numbers[8] = size / period * _spread(rng, 0.01, 10.0)
    reach = size * period * period / total * 30.0
    law[:] = 0.0
    law[laws.GATE], law[laws.SECTIONS] = laws.SURFACE, 1.0
    law[laws.RESOLUTION] = 0.0 if rng.random() < 0.3 else reach * _spread(rng, 1e-4, 0.3)
    law[laws.PHASE] = rng.random()
    law[laws.LIMIT] = 20.0 * size
    law[laws.HEADER + 1] = total / period**2 * _spread(rng, 1e-3, 2.0)
    force[:] = size * rng.standard_normal(SAMPLES)
    anchor[0], anchor[1:] = 0.0, np.cumsum(0.1 * reach * rng.standard_normal(SAMPLES))
    late = int(rng.random() * 3)
    offset = 0.0 if rng.random() < 0.4 else period * rng.random()
    return late, offset, period, reach * rng.standard_normal(), reach / period * 0.1 * rng.standard_normal()


def _residuals(loops, rng, worst):
    """The largest residuals relative to the energy moved; `worst` gets the numbers of the worst loop."""
    state, numbers, law = np.zeros(STATE_SIZE), np.zeros(9), np.zeros(laws.HEADER + 2)
    force, anchor = np.zeros(SAMPLES), np.zeros(SAMPLES + 1)
    memory, work, commands = np.zeros(1), np.zeros(WORK), np.zeros(SAMPLES + 1)
    record = np.zeros((k.RECORDED, SAMPLES + 1))
    none, regular = np.empty(0), np.empty((2, 0))
    device, hand, over, faults, stops = 0.0, 0.0, 0, 0, 0.0
    for loop in range(loops):
        late, offset, period, x, v = _draw(rng, numbers, law, force, anchor)
        state[:] = 0.0
        state[0], state[1] = x, v
        state[2] = np.sign(v)
        tied = anchor if numbers[5] + numbers[6] > 0.0 else none
        lengths = np.full(1, period)
        k.run(
            0, SAMPLES + 1, 1, state, numbers, law, memory, work, late, offset, lengths, regular,
            none, force, tied, none, none, commands, record,
        )  # fmt: skip
        faults += 1 if state[FAULT] != 0.0 else 0
        stops += state[STOPS]
        a, b = _closing(record, numbers, anchor)
        over += 1 if max(a, b) > BOUND else 0
        if max(a, b) > max(device, hand):
            worst[:9], worst[9], worst[10], worst[11] = numbers, late, offset, period
            worst[12] = loop
        device, hand = max(device, a), max(hand, b)
    return device, hand, over, faults, stops


def _closing(record, numbers, anchor):
    m, mh, stiffness = numbers[0], numbers[1], numbers[5]
    v, slack = record[k.R_VELOCITY], anchor - record[k.R_POSITION]
    kinetic, own, spring = 0.5 * m * v * v, 0.5 * mh * v * v, 0.5 * stiffness * slack * slack
    w, f, source = record[k.R_HAND_WORK], record[k.R_ACTUATOR_WORK], record[k.R_SOURCE_WORK]
    lost, damped = record[k.R_VISCOUS] + record[k.R_COULOMB], record[k.R_HAND_LOSS]
    a = np.abs(kinetic - kinetic[0] - w - f + lost).max()
    b = np.abs(source - w - (spring - spring[0] + own - own[0]) - damped).max()
    most = (kinetic + own).max() + spring.max() + np.abs(w).max() + np.abs(f).max() + np.abs(source).max()
    moved = most + lost[-1] + damped[-1]
    return (a / moved, b / moved) if moved > 0.0 else (a, b)


def main() -> int:
    raw = argparse.RawDescriptionHelpFormatter
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=raw)
    parser.add_argument("--loops", type=int, default=1_000_000)
    parser.add_argument("--seed", type=int, default=0)
    arguments = parser.parse_args()
    worst = np.zeros(13)
    _residuals(10, np.random.default_rng(1), worst)
    rng = np.random.default_rng(arguments.seed)
    start = time.perf_counter()
    device, hand, over, faults, stops = _residuals(arguments.loops, rng, worst)
    seconds = time.perf_counter() - start
    print(f"{arguments.loops:,} loops of {SAMPLES} samples in {seconds:.0f} s, {stops:,.0f} stops")
    print(f"largest residual over energy moved: device {device:.2e}, hand {hand:.2e}")
    print(f"loops above {BOUND:g}: {over}; loops given up: {faults}")
    if over:
        print("the worst loop:", worst.tolist())
    return 1 if over or faults else 0


if __name__ == "__main__":
    sys.exit(main())
