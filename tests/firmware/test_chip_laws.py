"""Emitted laws on their machines: the same forces everywhere, and the loop closed over an emulated chip."""

from __future__ import annotations

from pathlib import Path

import numpy as np
import pytest
from firmware.baselines.read import touch
from firmware.chip_laws import DEVICE, LAWS, TRAVEL, emitted
from firmware.emulated import cortex
from firmware.emulated.avr import AvrLaw
from firmware.emulated.host import HostLaw, watched
from firmware.emulated.loop import Motion, closed
from firmware.emulated.required import require

import zwidth as zw
from zwidth.machine.firmware.emit import emit

COUNTS = touch(1200, 2600)
HAND = zw.operators.Dowel()


@pytest.mark.parametrize("number", ["fixed", "float"])
@pytest.mark.parametrize("name", LAWS)
def test_other_numbers_are_off_as_was_proved(tmp_path: Path, name: str, number: str) -> None:
    """Each by its own error: half a step of the converter, and its rounding; nothing overflows."""
    require("host")
    forces = []
    for kind in ("double", number):
        (tmp_path / kind).mkdir()
        found = emitted(name, kind)
        law = HostLaw(found.text, tmp_path / kind)
        law.init(3)
        forces.append(law.run(COUNTS) * law.force_per_unit)
    step = float(DEVICE.force_resolution)
    assert np.abs(forces[0] - forces[1]).max() <= found.machine.error + step / 2 + 1e-6
    watched(found.text, COUNTS, tmp_path, 3)


@pytest.mark.parametrize("number", ["fixed", "float"])
@pytest.mark.parametrize("name", ["damped wall", "standard linear solid", "H(z) of order 4"])
def test_the_chips_answer_alike(tmp_path: Path, name: str, number: str) -> None:
    require("host", "avr", "cortex-m4")
    text = emitted(name, number).text
    host = HostLaw(text, tmp_path)
    host.init(0)
    wanted = host.run(COUNTS)
    for sketch in (False, True):
        with AvrLaw(text, sketch=sketch) as law:
            law.init(0)
            assert np.array_equal(law.run(COUNTS).forces, wanted)
    assert np.array_equal(cortex.run(text, COUNTS).forces, wanted)


def test_a_damped_wall_in_300_cycles() -> None:
    require("avr")
    with AvrLaw(emitted("damped wall", "fixed", "arduino").text, sketch=True) as law:
        law.init(0)
        assert law.run(COUNTS).worst <= 300


def on_the_chip(wall: zw.Wall, duration: float) -> Motion:
    require("avr")
    with AvrLaw(emit(DEVICE, wall, target="arduino", anyway=True).text, sketch=True) as law:
        return closed(DEVICE, HAND, duration, law.force, law.init)


def test_the_certified_law_is_quiet_on_the_chip() -> None:
    wall = zw.Wall(150, 0.05)
    assert emit(DEVICE, wall, target="arduino").verdict.outcome == "passive"
    motion = on_the_chip(wall, 1.0)
    trace = zw.simulate(DEVICE, wall, HAND, duration=1.0)
    assert motion.extracted == trace.zwidth.energy.got_out == 0
    assert motion.counts[-1] > 100
    assert not motion.velocity[-100:].any()
    assert np.abs(motion.position - trace["position"].values).max() < 1e-4


def test_the_refuted_law_buzzes_on_the_chip() -> None:
    wall = zw.Wall(770)
    found = emit(DEVICE, wall, target="arduino", anyway=True)
    assert found.verdict.outcome == "active"
    assert "NOT PROVED" in found.text
    motion = on_the_chip(wall, 2.0)
    energy = zw.simulate(DEVICE, wall, HAND, duration=2.0).zwidth.energy
    assert motion.extracted > 0.01
    assert motion.extracted == pytest.approx(energy.got_out, rel=0.1)
    assert np.abs(motion.velocity[-500:]).max() > 0.5


@pytest.mark.parametrize("rate", [1000, 1700])
@pytest.mark.parametrize("delay", ["0 s", "0.4 ms", "1.3 ms"])
def test_it_is_the_loop_of_simulate(rate: int, delay: str) -> None:
    """With the same forces it has the same motion and energy, to the last bit, whatever the delay."""
    values = {"mass": 0.036, "damping": 0.15, "coulomb_friction": 0.12, "resolution": 22.4e-6, "rate": rate}
    device = zw.Device(**values, delay=delay, force_resolution=0.0005, force_limit=9)
    trace = zw.simulate(device, zw.Wall(stiffness=700), HAND, duration=0.5)
    motion = closed(device, HAND, 0.5, lambda counts: 700 * max(22.4e-6 * counts, 0.0))
    names = ("position", "commanded_force", "actuator_force", "hand_work")
    parts = (motion.position, motion.command, motion.force, motion.hand_work)
    for ours, theirs in zip(parts, names, strict=True):
        assert np.array_equal(ours, trace[theirs].values)
    assert motion.command.max() == 9
    assert motion.extracted == trace.zwidth.energy.got_out


@pytest.mark.parametrize("stiffness", [150, 770], ids=["quiet", "buzz"])
@pytest.mark.parametrize(("chip", "number"), [("avr", "fixed"), ("cortex-m4", "float")])
def test_ten_thousand_samples_of_a_touch(tmp_path: Path, chip: str, number: str, stiffness: int) -> None:
    """One loop, motion and energy to the last bit: what the chip answers to each reading is what moved it."""
    require(chip)
    header = emit(DEVICE, zw.Wall(stiffness), number=number, travel=TRAVEL, anyway=True).text
    law = HostLaw(header, tmp_path)
    moved = closed(DEVICE, HAND, 10.0, law.force, law.init)
    assert moved.counts.size == 10_001
    first = int(moved.counts[0])
    if chip == "cortex-m4":  # all readings at once: as long as its forces are the same, so is the loop
        answers = cortex.run(header, moved.counts, first)
        law.init(first)
        assert answers.forces.tobytes() == law.run(moved.counts).tobytes()
        return
    with AvrLaw(header) as avr:
        there = closed(DEVICE, HAND, 10.0, avr.force, avr.init)
    for ours, theirs in zip(vars(there).values(), vars(moved).values(), strict=True):
        assert ours.tobytes() == theirs.tobytes()
    assert (there.extracted > 0.01) == (stiffness == 770)
