"""How long an exact verdict with certificate takes, beside a grid and an LMI.

For random laws of order 2, 6 and 10, at 1 % above the required damping:

* `zw.check`: exact decision, certificate, and the independent checker's approval; the same at 1 % below
  it, with a violation that the checker approves;
* the criterion on a NumPy grid of 100 000 frequencies, nothing proved;
* python-control's `ispassive` of b + T H/(z − 1), nothing proved.

Medians, and each rival's median over zwidth's; then whole checks of python-control systems of order 1 to 6.
"""

from __future__ import annotations

import time
import warnings
from collections.abc import Callable
from statistics import median

import control
import numpy as np
from random_plants import random_law

import zwidth as zw

PERIOD = 1e-3
LAWS = 25
GRID = 100_000


def on_grid(num: list[float], den: list[float]) -> float:
    """The largest required damping on the grid [N·s/m]."""
    theta = np.linspace(np.pi / GRID, np.pi, GRID)
    z = np.exp(1j * theta)
    h = np.polyval(num, z) / np.polyval(den, z)
    return float(np.max(PERIOD / 2 * np.real((1 - 1 / z) * h) / (1 - np.cos(theta))))


def lmi_system(num: list[float], den: list[float], damping: float) -> control.StateSpace:
    """b + T H(z)/(z − 1), which is positive real exactly if the loop is passive."""
    bottom = np.polymul(den, [1, -1])
    top = np.polyadd(damping * bottom, PERIOD * np.asarray(num))
    return control.ss(control.tf(top, bottom, PERIOD))


def timed(action: Callable[[], object]) -> tuple[float, object]:
    start = time.perf_counter()
    result = action()
    return time.perf_counter() - start, result


def main() -> None:
    """Measure and print."""
    warnings.simplefilter("ignore")
    rng = np.random.default_rng(2026)
    print(f"{LAWS} laws per order; medians in ms; ratios over zwidth")
    print(
        f"{'order':>5} {'zwidth':>8} {'active':>8} {'grid':>8} {'LMI':>8} {'grid/zwidth':>12} "
        f"{'LMI/zwidth':>11}  verdicts"
    )
    for order in (2, 6, 10):
        times: dict[str, list[float]] = {"zwidth": [], "active": [], "grid": [], "lmi": []}
        agree = refuted = wrong_lmi = 0
        for _ in range(LAWS):
            num, den = random_law(rng, order, 0.95)
            need = max(on_grid(num, den), 1e-4)
            device = zw.Device(mass=0.1, damping=1.01 * need, sample_period=PERIOD)
            law = zw.PulseTransferFunction(num, den)
            system = lmi_system(num, den, 0.99 * need)
            spent, verdict = timed(lambda d=device, h=law: zw.check(d, h))
            times["zwidth"].append(spent)
            agree += verdict.outcome == "passive" and verdict.certificate.verify()
            below = device.replace(damping=0.99 * need)
            spent, verdict = timed(lambda d=below, h=law: zw.check(d, h))
            times["active"].append(spent)
            refuted += verdict.outcome == "active" and verdict.violation.verify()
            times["grid"].append(timed(lambda n=num, d=den: on_grid(n, d))[0])
            spent, answer = timed(lambda s=system: control.ispassive(s))
            times["lmi"].append(spent)
            wrong_lmi += bool(answer)
        ms = {name: 1e3 * median(values) for name, values in times.items()}
        print(
            f"{order:>5} {ms['zwidth']:>8.2f} {ms['active']:>8.2f} {ms['grid']:>8.2f} {ms['lmi']:>8.2f} "
            f"{ms['grid'] / ms['zwidth']:>12.1f} {ms['lmi'] / ms['zwidth']:>11.1f}  "
            f"{agree}/{LAWS} certified at +1 %, {refuted}/{LAWS} refuted at -1 %; the LMI calls "
            f"{wrong_lmi}/{LAWS} passive there"
        )
    systems()


def systems() -> None:
    """Whole checks of python-control systems of order 1 to 6, passive and active."""
    rng = np.random.default_rng(13)
    times: dict[str, list[float]] = {"passive": [], "active": []}
    for k in range(20 * LAWS):
        num, den = random_law(rng, 1 + k % 6, 0.95)
        need = max(on_grid(num, den), 1e-4)
        system = control.tf(num, den, PERIOD)
        for share in (1.01, 0.99, 0.5):
            device = zw.Device(mass=0.1, damping=share * need, sample_period=PERIOD)
            spent, verdict = timed(lambda d=device, s=system: zw.check(d, s))
            times[verdict.outcome].append(spent)
    for outcome, values in times.items():
        print(
            f"python-control system in, {outcome} out: median {1e3 * median(values):.2f} ms of {len(values)}"
        )


if __name__ == "__main__":
    main()
