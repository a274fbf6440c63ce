"""Random links against ports: do two hands ever put in less than nothing?

Devices of any damping, friction, encoder and delay; links of 0 to 100 samples each way, with jitter, with
losses of up to half of all packets in bursts, with duplicates, and links that keep all back and let it go
in reverse order; hands that go to and fro, hover over an edge of the encoder, move at random, rest, and take
what there is to take.  What both hands put in is added up; its least value is compared with all work done.

    python random_links.py [SCHEDULES] [FIRST SEED]
"""

from __future__ import annotations

import sys
import time
from concurrent.futures import ProcessPoolExecutor
from functools import partial

import numpy as np

from zwidth.links.attack import Hand, try_hands
from zwidth.links.memory import (
    COULOMB,
    DAMPING,
    LATE,
    LINE,
    NEW_LINE,
    NUMBER,
    NUMBERS_SIZE,
    OWN_NUMBERS,
    PERIOD,
    RESOLUTION,
    STATE_SIZE,
)
from zwidth.links.simulation import End, Wire
from zwidth.links.springs import POSITION_HOLD, TIME_DOMAIN, TWO_LAYER
from zwidth.links.wave_port import WAVE_PORT
from zwidth.links.waves import HELD_WAVES, NAIVE_WAVES
from zwidth.native.compiled import Array

SAMPLES = 200
_WORKERS = 2
_ROUNDING = 1e-9
"""Of the work that was done: less than nothing by more than that is no rounding of the sum."""

WAVES = (WAVE_PORT, HELD_WAVES, NAIVE_WAVES)
KINDS = {
    "waves with a ledger": WAVE_PORT,
    "waves without a ledger": HELD_WAVES,
    "textbook waves": NAIVE_WAVES,
    "positions, last one held": POSITION_HOLD,
    "time-domain passivity": TIME_DOMAIN,
    "two layers": TWO_LAYER,
}


def between(random: np.random.Generator, low: float, high: float) -> float:
    """Evenly in the logarithm."""
    return low * (high / low) ** random.random()


def draw_device(random: np.random.Generator, p: Array) -> None:
    """Any device, at 1 kHz or another rate."""
    p[:] = 0.0
    p[PERIOD] = between(random, 2e-4, 1e-2)
    p[DAMPING] = between(random, 1e-3, 10.0)
    p[COULOMB] = between(random, 1e-3, 1.0) if random.random() < 0.5 else 0.0
    p[RESOLUTION] = between(random, 1e-7, 1e-3) if random.random() < 0.6 else 0.0
    p[LATE] = float(random.integers(0, 4)) if random.random() < 0.3 else 0.0


def draw_wire(random: np.random.Generator, wire: Wire) -> None:
    """One way of a link."""
    count = wire.when.size
    wire.first[:], wire.following[:] = -1, -1
    delay, jitter = random.integers(0, 101), random.integers(0, 30)
    if random.random() < 0.5:
        delay = random.integers(0, 4)
    loss, burst, twice = 0.5 * random.random(), between(random, 1.0, 30.0), 0.3 * random.random()
    kept_back = random.random() < 0.1
    chances, lost = random.random(count), np.zeros(count, dtype=bool)
    bad = False
    for j, chance in enumerate(chances):
        bad = chance >= 1.0 / burst if bad else chance < loss / burst
        lost[j] = bad
    at = np.arange(count)
    wire.when[:] = np.where(lost, -1, at + 1 + delay + random.integers(0, jitter + 1, count))
    if kept_back:
        wire.when[:] = (at // 40 + 1) * 40
    once_more = (random.random(count) < twice) & ~lost
    wire.again[:] = np.where(once_more, at + 1 + random.integers(0, 120, count), -1)


def draw_hand(random: np.random.Generator, p: Array, draws: Array, none: Array) -> Hand:
    """What one hand does."""
    step = p[RESOLUTION] if p[RESOLUTION] > 0.0 else 1e-6
    sizes = (
        0.0,
        1e-6 * step,
        step,
        between(random, 1e-4, 30.0) * p[PERIOD],
        between(random, 1e-4, 1.0) * p[PERIOD],
    )
    size = sizes[random.integers(0, 5)]
    half, until = random.integers(1, 60), random.integers(0, SAMPLES + 1)
    if random.random() < 0.3:
        half = 1
    draws[:] = random.standard_normal(draws.size)
    return Hand(size, half, until, 30.0 * p[PERIOD], draws if random.random() < 0.3 else none)


def attack(
    code: float, random: np.random.Generator, count: int, near: End, far: End, draws: Array, found: Array
) -> None:
    """Into `found`: how many gained; the most that came out, and as a share of the work that was done."""
    none = draws[0, :0]
    positions, forces = np.zeros((2, SAMPLES + 1)), np.zeros((2, SAMPLES))
    for _ in range(count):
        draw_device(random, near.numbers)
        draw_device(random, far.numbers)
        far.numbers[PERIOD] = near.numbers[PERIOD]
        w = between(random, 1e-2, 1e2) * min(near.numbers[DAMPING], far.numbers[DAMPING])
        if random.random() < 0.4:
            w = min(near.numbers[DAMPING], far.numbers[DAMPING])
        for end in (near, far):
            p = end.numbers
            p[OWN_NUMBERS] = w if code <= NAIVE_WAVES else w / p[PERIOD] / random.integers(1, 100)
            p[OWN_NUMBERS + 1] = p[DAMPING] if code == TIME_DOMAIN else 0.5 * p[OWN_NUMBERS] * 1e-4
            if code == WAVE_PORT:
                p[OWN_NUMBERS + 1] = between(random, 0.1, 30.0) * p[PERIOD] if random.random() < 0.5 else 0.0
            p[OWN_NUMBERS + 2] = p[DAMPING]
            end.state[:] = 0.0
            end.state[:LINE] = NEW_LINE
            end.state[NUMBER] = -1.0
            draw_wire(random, end.hears)
        one, other = (
            draw_hand(random, near.numbers, draws[0], none),
            draw_hand(random, far.numbers, draws[1], none),
        )
        positions[:, 0] = -0.5 * one.size, -0.5 * other.size
        out = -try_hands(near, one, far, other, positions, forces)
        work = np.abs(forces * (positions[:, 1:] - positions[:, :-1])).sum()
        if not out <= _ROUNDING * work:
            found[0] += 1.0
        found[1] = max(found[1], out)
        found[2] = max(found[2], out / work if work > 0.0 else 0.0)


def new_end(code: float) -> End:
    """Room for a port and what it hears."""
    ticks = [np.zeros(SAMPLES, dtype=np.int64) for _ in range(2)]
    lists = np.zeros(SAMPLES + 1, dtype=np.int64), np.zeros(2 * SAMPLES, dtype=np.int64)
    return End(
        code, np.zeros(NUMBERS_SIZE), np.zeros(STATE_SIZE), Wire(*ticks, *lists, np.zeros((SAMPLES, 3)))
    )


def run(code: float, seed: int, count: int) -> Array:
    """Some random links."""
    found = np.zeros(3)
    attack(
        code, np.random.default_rng(seed), count, new_end(code), new_end(code), np.zeros((2, SAMPLES)), found
    )
    return found


def main() -> int:
    """A row for each kind of port; 1 where a hand gained from the one that is proved."""
    schedules = int(sys.argv[1]) if len(sys.argv) > 1 else 10_000
    first = int(sys.argv[2]) if len(sys.argv) > 2 else 0
    print("| port | schedules | gained | most taken [J] | of the work done | time [s] |")
    print("|---|---|---|---|---|---|")
    wrong = 0
    for name, code in KINDS.items():
        count = schedules if code == WAVE_PORT else min(schedules, 20_000)
        start = time.perf_counter()
        with ProcessPoolExecutor(_WORKERS) as pool:
            seeds = range(first, first + 1000 * _WORKERS, 1000)
            parts = list(pool.map(partial(run, code, count=count // _WORKERS), seeds))
        gained = sum(int(part[0]) for part in parts)
        wrong += gained if code == WAVE_PORT else 0
        most, share = (max(float(part[i]) for part in parts) for i in (1, 2))
        took = time.perf_counter() - start
        print(f"| {name} | {count} | {gained} | {most:.2g} | {share:.2g} | {took:.0f} |", flush=True)
    return int(wrong > 0)


if __name__ == "__main__":
    sys.exit(main())
