"""Is any verdict wrong?  Random loops at (1 ± 1e-9) of their limit, both sides proved.

Orders 1 to 10, poles up to radius 0.999, without delay, with one sample and with any
fraction of up to three.  At (1 + 1e-9) of the required damping the verdict must be
passive with a certificate that the checker accepts, at (1 − 1e-9) active with a violation
that it accepts; of every fiftieth loop the motion, where one is short enough, takes out
energy, recomputed in rational arithmetic.  The required damping is also compared with a
fine evaluation of the criterion from its definition.

    python benchmarks/random_loops.py [NUMBER] [PROCESSES] [FIRST SEED]
"""

from __future__ import annotations

import sys
import time
from concurrent.futures import ProcessPoolExecutor
from fractions import Fraction
from statistics import median

import numpy as np
from random_plants import random_law
from rich.progress import track

import zwidth as zw

PERIOD = 1e-3
NEAR = Fraction(1, 10**9)
MOTIONS = 50
"""One loop in so many has its motion made: so near to the limit they are long."""


def by_definition(num: list[float], den: list[float], delay: float) -> tuple[float, float]:
    """(largest required damping on a grid, rounding error to expect) [N·s/m], from complex arithmetic.

    (1 − 1/z)/(1 − cos θ) is written as j e^{−jθ/2}/sin(θ/2), which does not cancel at small θ.
    """
    theta = np.concatenate([np.linspace(0, np.pi, 4001)[1:], np.geomspace(1e-4, 1e-2, 200)])
    z = np.exp(1j * theta)
    h = np.polyval(num, z) / np.polyval(den, z)
    whole = np.floor(delay / PERIOD + 1e-12)
    part = min(max(delay / PERIOD - whole, 0.0), 1.0)
    mixed = (1 - part + part / z) * z**-whole * h
    a = -PERIOD / 2 * np.imag(np.exp(-0.5j * theta) * mixed) / np.sin(theta / 2)
    needs = (a + np.sqrt(a**2 + PERIOD**2 * part * (1 - part) * abs(h) ** 2)) / 2 if part else a
    conditioning = np.polyval(np.abs(num), 1.0) / np.abs(np.polyval(den, z)).min()
    return float(np.max(needs)), 1e-11 * PERIOD * float(conditioning) / 1e-4


def one(seed: int) -> tuple[str, float, int]:
    """(what went wrong or "", seconds, samples of the motion)."""
    rng = np.random.default_rng(seed)
    order = int(rng.integers(1, 11))
    num, den = random_law(rng, order, 0.999)
    microseconds = (0, 1000, int(rng.integers(1, 3000)))[int(rng.integers(0, 3))]
    delay = Fraction(microseconds, 10**6)
    device = zw.Device(mass=0.1, damping=1, sample_period=PERIOD, delay=delay)
    law = zw.PulseTransferFunction(num, den)
    start = time.perf_counter()
    required = zw.check(device, law).required_damping
    if required is None:
        return f"seed {seed}: no damping would do", 0.0, 0
    if required == 0:
        return "", time.perf_counter() - start, 0
    limit = Fraction(repr(required))
    above = zw.check(device.replace(damping=limit * (1 + NEAR)), law)
    below = zw.check(device.replace(damping=limit * (1 - NEAR)), law)
    spent = time.perf_counter() - start
    motion = below.witness if seed % MOTIONS == 0 else None
    seen, rounding = by_definition(num, den, float(delay))
    wrong = [
        above.outcome != "passive" and f"{above.outcome} above the limit",
        above.certificate is not None and not above.certificate.verify() and "certificate rejected",
        below.outcome != "active" and f"{below.outcome} below the limit",
        below.outcome == "active" and not below.violation.verify() and "violation rejected",
        motion is not None and not motion.exact_energy > 0 and "no energy",
        seen > required + rounding and f"the definition asks for {seen} > {required}",
    ]
    said = "; ".join(w for w in wrong if w)
    samples = motion.motion.samples if motion is not None else 0
    return (f"seed {seed}, order {order}: {said}" if said else ""), spent, samples


def main() -> int:
    """Run all and print what was wrong."""
    number = int(sys.argv[1]) if len(sys.argv) > 1 else 10_000
    processes = int(sys.argv[2]) if len(sys.argv) > 2 else 2
    first = int(sys.argv[3]) if len(sys.argv) > 3 else 0
    with ProcessPoolExecutor(processes) as pool:
        seeds = range(first, first + number)
        results = list(track(pool.map(one, seeds, chunksize=20), "loops", total=number))
    wrong = [text for text, _, _ in results if text]
    print(*wrong, sep="\n")
    times = [1e3 * spent for _, spent, _ in results]
    longest = max(samples for _, _, samples in results)
    print(
        f"{number} loops, {len(wrong)} wrong; limit and both verdicts: median {median(times):.0f} ms, "
        f"worst {max(times):.0f} ms; longest motion {longest:.3g} samples"
    )
    return int(bool(wrong))


if __name__ == "__main__":
    sys.exit(main())
