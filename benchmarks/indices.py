"""How long exact passivity indices take, beside python-control's linear matrix inequality; where they differ.

For random stable systems of one axis, order 4 and 10, two axes of order 4 and three of order 6:

* `zw.ports.passivity_indices`: both indices with their frequencies, exact;
* the same, and the proofs of both written and accepted by the independent checker;
* python-control's `get_input_ff_index` and `get_output_fb_index`, by cvxopt; nothing proved.

Medians, and the rival's over zwidth's.  Then systems with an answer that is known on paper, where a
tolerance decides for the rival: what it says depends on its version and on the processor.
"""

from __future__ import annotations

import platform
import time
import warnings
from collections.abc import Callable
from importlib.metadata import version
from statistics import median

import control
import numpy as np
from control.passivity import get_input_ff_index, get_output_fb_index

import zwidth as zw

SYSTEMS = 100
SIZES = ((1, 4), (1, 10), (2, 4), (3, 6))

s = control.tf("s")
KNOWN = {
    "1/(s + 1) − 1e-9": 1 / (s + 1) - 1e-9,
    "(s + 2.0000001)/(s + 1)²": (s + 2.0000001) / (s + 1) ** 2,
    "the gain 2": control.tf([2], [1]),
    "s + 1": s + 1,
    "2/(s + 2e6)": 2 / (s + 2e6),
    "A = diag(−3, −2)·1e12": control.ss(np.diag([-3e12, -2e12]), [[0], [1]], [[-1, 2]], [[0]]),
    "1/z": control.tf([1], [1, 0], 0.01),
}


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
    found = zw.ports.passivity_indices(system)
    return all(index.certificate().verify() for index in (found.input, found.output))


def by_inequality(system: control.StateSpace) -> tuple[float, float]:
    """Both indices by python-control."""
    return get_input_ff_index(system), get_output_fb_index(system)


def answer(question: Callable[[control.lti.LTI], object], system: control.lti.LTI) -> str:
    """What the rival says, or the name of its exception."""
    try:
        said = question(system)
    except Exception as error:  # whatever it raises is its answer
        return type(error).__name__
    return f"{said:.4g}" if isinstance(said, float) else str(said)


def print_known() -> None:
    """Both answers for each system of `KNOWN`."""
    names = ("control", "cvxopt", "numpy", "scipy")
    print("\n" + ", ".join(f"{name} {version(name)}" for name in names), "on", platform.machine())
    print(f"{'system':<24} {'ispassive':<14} {'input index':<14} {'output index':<14} zwidth: passive, ν, ρ")
    for name, system in KNOWN.items():
        theirs = (answer(q, system) for q in (control.ispassive, get_input_ff_index, get_output_fb_index))
        ours = zw.ports.passivity_indices(system)
        said = " ".join(f"{text:<14}" for text in theirs)
        print(f"{name:<24} {said} {ours.passive}, {ours.input.value:.4g}, {ours.output.value:.4g}")


def print_times() -> None:
    """Medians for each size, and how many answers agree."""
    rng = np.random.default_rng(2026)
    proved(random_system(rng, 2, 2))
    print(f"{SYSTEMS} systems of each size; medians in ms; ratios over zwidth and over zwidth with proofs")
    print(f"{'axes':>4} {'order':>5} {'zwidth':>8} {'proved':>8} {'LMI':>8} {'ratios':>11}  answers")
    for axes, order in SIZES:
        times: dict[str, list[float]] = {"zwidth": [], "proved": [], "lmi": []}
        accepted = near = 0
        for _ in range(SYSTEMS):
            system = random_system(rng, axes, order)
            spent, found = timed(lambda g=system: zw.ports.passivity_indices(g))
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


def main() -> None:
    """Measure and print."""
    warnings.simplefilter("ignore")
    print_times()
    print_known()


if __name__ == "__main__":
    main()
