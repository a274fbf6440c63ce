"""The loop closed over an emulated chip: the passive wall comes to rest, the active one gives energy."""

from __future__ import annotations

import numpy as np
import pytest
from firmware.baselines.read import fixed_wall
from firmware.emulated.avr import AvrLaw
from firmware.emulated.loop import Motion, closed
from firmware.emulated.required import require

import zwidth as zw

PADDLE = zw.catalogue.device("haptic-paddle")
HAND = zw.operators.Dowel()


def on_the_chip(stiffness: float, damping: float = 0.0, duration: float = 1.0) -> Motion:
    require("avr")
    with AvrLaw(fixed_wall(stiffness, damping)) as law:
        return closed(PADDLE, HAND, duration, law.force, law.init)


@pytest.mark.parametrize("rate", [1000, 1700])
@pytest.mark.parametrize("delay", ["0 s", "0.4 ms", "1.3 ms"])
def test_it_is_the_loop_of_simulate(rate: int, delay: str) -> None:
    """With the same forces it has the same motion and energy, to the last bit, whatever the delay."""
    values = {"mass": 0.036, "damping": 0.15, "coulomb_friction": 0.12, "resolution": 22.4e-6, "rate": rate}
    device = zw.Device(**values, delay=delay, force_resolution=0.0005, force_limit=9)
    trace = zw.simulate(device, zw.Wall(stiffness=700), HAND, duration=0.5)
    motion = closed(device, HAND, 0.5, lambda counts: 700 * max(22.4e-6 * counts, 0.0))
    for ours, theirs in (
        (motion.position, "position"),
        (motion.command, "commanded_force"),
        (motion.force, "actuator_force"),
        (motion.hand_work, "hand_work"),
    ):
        assert np.array_equal(ours, trace[theirs].values)
    assert motion.command.max() == 9
    assert motion.extracted == trace.zwidth.energy.got_out


def test_the_passive_wall_is_quiet_on_the_chip() -> None:
    assert zw.check(PADDLE, zw.Wall(stiffness=150, damping=0.05)).outcome == "passive"
    motion = on_the_chip(150, 0.05)
    assert motion.extracted == 0
    assert motion.counts[-1] > 100
    assert not motion.velocity[-100:].any()
    trace = zw.simulate(PADDLE, zw.Wall(stiffness=150, damping=0.05), HAND, duration=1.0)
    assert np.abs(motion.position - trace["position"].values).max() < 1e-4


def test_the_active_wall_buzzes_on_the_chip() -> None:
    assert zw.check(PADDLE, zw.Wall(stiffness=770)).outcome == "active"
    motion = on_the_chip(770, duration=2.0)
    assert motion.extracted == pytest.approx(0.034, abs=0.004)
    assert np.abs(motion.velocity[-500:]).max() > 0.5
