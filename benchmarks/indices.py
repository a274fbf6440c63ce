"""How long exact passivity indices take, beside python-control's linear matrix inequality.

For random stable systems of one axis, order 4 and 10, two axes of order 4 and three of order 6:

* `zw.passivity_indices`: both indices with their frequencies, exact;
* the same, and the proofs of both written and accepted by the independent checker;
* python-control's `get_input_ff_index` and `get_output_fb_index`, by cvxopt; nothing proved.

Medians, and the rival's over zwidth's.
"""

from __future__ import annotations

import time
import warnings
from collections.abc import Callable
from statistics import median

import control
import numpy as np
from control.passivity import get_input_ff_index, get_output_fb_index

import zwidth as zw

SYSTEMS = 100
SIZES = ((1, 4), (1, 10), (2, 4), (3, 6))


def random_system(rng: np.random.Generator, axes: int, order: int) -> control.StateSpace:
    """Masses, springs and dampers that are felt at some of them, with a throughput; three digits."""
    turning = rng.normal(size=(order, order))
    a = turning - turning.T - np.diag(rng.uniform(0.2, 2, order))
    b = rng.normal(size=(order, axes))
    return control.ss(np.round(a, 3), np.round(b, 3), np.round(b, 3).T, 0.25 * np.eye(axes))


def timed(action: Callable[[], object]) -> tuple[float, object]:
    start = time.perf_counter()
    result = action()
    return time.perf_counter() - start, result


def proved(system: control.StateSpace) -> bool:
    """Both indices, with proofs that the checker accepts."""
    found = zw.passivity_indices(system)
    return all(index.certificate().verify() for index in (found.input, found.output))


def by_inequality(system: control.StateSpace) -> tuple[float, float]:
    """Both indices by python-control."""
    return get_input_ff_index(system), get_output_fb_index(system)


def main() -> None:
    """Measure and print."""
    warnings.simplefilter("ignore")
    rng = np.random.default_rng(2026)
    proved(random_system(rng, 2, 2))
    print(f"{SYSTEMS} systems of each size; medians in ms; ratios over zwidth and over zwidth with proofs")
    print(f"{'axes':>4} {'order':>5} {'zwidth':>8} {'proved':>8} {'LMI':>8} {'ratios':>11}  answers")
    for axes, order in SIZES:
        times: dict[str, list[float]] = {"zwidth": [], "proved": [], "lmi": []}
        accepted = near = 0
        for _ in range(SYSTEMS):
            system = random_system(rng, axes, order)
            spent, found = timed(lambda g=system: zw.passivity_indices(g))
            times["zwidth"].append(spent)
            spent, good = timed(lambda g=system: proved(g))
            times["proved"].append(spent)
            accepted += bool(good)
            spent, pair = timed(lambda g=system: by_inequality(g))
            times["lmi"].append(spent)
            near += bool(np.allclose(pair, (found.input.value, found.output.value), rtol=1e-4, atol=1e-6))
        ms = {name: 1e3 * median(values) for name, values in times.items()}
        print(
            f"{axes:>4} {order:>5} {ms['zwidth']:>8.2f} {ms['proved']:>8.2f} {ms['lmi']:>8.2f} "
            f"{ms['lmi'] / ms['zwidth']:>7.1f} {ms['lmi'] / ms['proved']:>3.1f}  "
            f"{accepted}/{SYSTEMS} accepted; {near}/{SYSTEMS} agree to 1e-4"
        )


if __name__ == "__main__":
    main()
