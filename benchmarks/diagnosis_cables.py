"""Does the diagnosis tell a motor that swings on its cable from a late force, and from a loop at rest?

    python benchmarks/diagnosis_cables.py [--runs 40] [--seed 23]

Motor and handle on a cable, held by a hand and knocked once: at 1.5 times the stiffness that the cable bears,
at 0.8 times, and at 0.8 times with a force two to five samples late that nobody states.  What shakes grows
with that hand; every second file has the command alone.  The device is told with numbers up to 10 % wrong.
"""

from __future__ import annotations

import argparse
from collections import Counter
from dataclasses import dataclass
from math import pi
from typing import Any

import numpy as np
from scipy.linalg import expm

import zwidth as zw
from zwidth.model.operator.operator import LinearHand, Operator, Signals

PERIOD = 1e-3
SHARE = {"on its cable": 1.5, "at rest": 0.8, "late": 0.8}
ONE_BODY = 0.62
"""Of what one body bears, up to which limits are drawn: 1.5 times as much is passive without the cable."""


@dataclass(frozen=True, kw_only=True)
class Knocked(Operator):
    """A hand that holds, and gets a push within one sample."""

    hand: LinearHand = LinearHand()  # noqa: RUF009
    push: float

    def signals(self, times: Any) -> Signals:
        """One push, 20 samples after the start."""
        force = np.where(np.arange(times.size - 1) == 20, self.push, 0.0)
        return Signals(force=force, anchor=np.zeros_like(times))

    def describe(self, motion: str = "linear") -> str:
        return "a hand that is knocked"


def main() -> None:
    """Draw, simulate, diagnose, count."""
    parser = argparse.ArgumentParser(
        description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter
    )
    parser.add_argument("--runs", type=int, default=40, help="of each kind")
    parser.add_argument("--seed", type=int, default=23)
    given = parser.parse_args()
    counts: Counter[tuple[str, str, str]] = Counter()
    for kind in SHARE:
        for run in range(given.runs):
            rng = np.random.default_rng([given.seed, run, len(kind)])
            both = run % 2 == 0
            found = diagnosed(rng, kind, both)
            says = found.cause or ("no vibration" if found.seen is None else "cannot tell")
            counts[kind, "both forces" if both else "command", says] += 1
    for (kind, file, says), count in sorted(counts.items()):
        print(f"{kind:14}{file:14}{says:30}{count}")


def diagnosed(rng: np.random.Generator, kind: str, both: bool) -> Any:
    """Of one log."""
    device, stiffness, late, hand, growth = drawn(rng, kind)
    law = zw.PulseTransferFunction([stiffness], [1])
    knocked = Knocked(hand=hand, push=(hand.mass + 0.03) * _between(rng, 0.3, 1.0) / PERIOD)
    seconds = min(6.0, max(1.5, 3 / max(abs(growth), 0.5)))
    trace = zw.simulate(device.replace(delay=late * PERIOD), law, knocked, seconds, initial_position=0.0)
    log = trace[["measured_position", "commanded_force"]]
    if both:
        log["actuator_force"] = trace.actuator_force + rng.normal(0, 0.003, trace.sizes["time"])
    return zw.diagnose(log, told(rng, device))


def drawn(rng: np.random.Generator, kind: str) -> tuple[zw.Device, float, int, LinearHand, float]:
    """A device, K, samples by which the force is late, the hand, and how fast it grows [1/s]."""
    while True:
        mass, damping = _between(rng, 0.015, 0.08), _between(rng, 0.03, 0.12)
        cable = zw.Transmission(
            stiffness=(2 * pi * _between(rng, 25, 180)) ** 2 * mass,
            damping=rng.choice([0.0, _between(rng, 0.001, 0.02)]),
            handle_mass=mass * _between(rng, 0.4, 2.5),
            handle_damping=damping * _between(rng, 0.8, 4),
            handle_coulomb_friction=_between(rng, 0.001, 0.006),
        )
        dry, step = _between(rng, 0.001, 0.006), _between(rng, 2e-6, 1e-5)
        device = zw.Device(
            mass=mass, damping=damping, coulomb_friction=dry, resolution=step, rate=1000, transmission=cable
        )
        hand = LinearHand(_between(rng, 0.1, 0.5), _between(rng, 1500, 20000), _between(rng, 0.2, 3))
        late = int(rng.integers(2, 6)) if kind == "late" else 0
        bears = zw.check(device, zw.Wall(10.0)).max_stiffness_viscous
        if bears and bears < ONE_BODY * 2 * (damping + float(cable.handle_damping)) / PERIOD:
            growth = _growth(device, SHARE[kind] * bears, hand, late)
            if kind == "at rest" or 1 <= growth <= 60:
                return device, SHARE[kind] * bears, late, hand, growth


def told(rng: np.random.Generator, device: zw.Device) -> zw.Device:
    """The same with numbers that are wrong."""
    cable = device.transmission

    def wrong(of: Any, names: tuple[str, ...]) -> dict[str, float]:
        return {name: float(getattr(of, name)) * (1 + rng.uniform(-0.1, 0.1)) for name in names}

    behind = wrong(cable, ("stiffness", "handle_mass", "handle_damping"))
    return device.replace(**wrong(device, ("mass", "damping")), transmission=cable.replace(**behind))


def _between(rng: np.random.Generator, low: float, high: float) -> float:
    return float(np.exp(rng.uniform(np.log(low), np.log(high))))


def _growth(device: zw.Device, stiffness: float, hand: LinearHand, late: int) -> float:
    """Of the fastest growing mode, dry friction left out."""
    m, b = float(device.mass), float(device.damping)
    at = {name: float(value) for name, value in device.transmission.parameters().items()}
    k, c, other = at["stiffness"], at["damping"], at["handle_mass"] + hand.mass
    rates = np.zeros((5, 5))
    rates[0, 1] = rates[2, 3] = 1
    rates[1] = np.array([-k, -b - c, k, c, -1]) / m
    rates[3] = np.array([k, c, -k - hand.stiffness, -c - at["handle_damping"] - hand.damping, 0]) / other
    flow = expm(rates * PERIOD)
    step = np.zeros((4 + late, 4 + late))
    step[:4, :4] = flow[:4, :4]
    if late:
        step[:4, 4] = flow[:4, 4]
        step[np.arange(4, 3 + late), np.arange(5, 4 + late)] = 1
        step[3 + late, 0] = stiffness
    else:
        step[:4, 0] += stiffness * flow[:4, 4]
    return float(np.log(np.abs(np.linalg.eigvals(step)).max()) / PERIOD)


if __name__ == "__main__":
    main()
