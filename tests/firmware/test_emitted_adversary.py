"""No hand gains from emitted code that is proved; where ε is what is lacking, some hand does."""

from __future__ import annotations

from fractions import Fraction
from pathlib import Path
from random import Random

import pytest
from firmware.adversary import HostLaw, Loop, attacked, gained, random_loop, text
from firmware.emulated.required import require

import zwidth as zw
from zwidth.machine.firmware.law import law_program
from zwidth.machine.firmware.machine import machine
from zwidth.machine.firmware.verdict import judged
from zwidth.quantity.exact import Exact


@pytest.mark.parametrize("seed", range(12))
def test_no_motion_contradicts_the_verdict(seed: int, tmp_path: Path) -> None:
    require("host")
    random = Random(seed)
    loop = random_loop(random)
    most, cycle = attacked(loop, random, 60, tmp_path)
    assert not (loop.found.proved and most > 0), (loop.name, float(most), cycle)


def test_a_hand_gains_where_the_converter_is_not_paid_for(tmp_path: Path) -> None:
    """K Δ/2 < f_c, so the law is passive; its steps of 2 and of 1 make up for more than the friction."""
    require("host")
    base = zw.Device(mass="0.1", damping=1, resolution="1e-4", sample_period="0.001", force_resolution="0.04")
    wall = zw.Wall(600)  # 1.5 steps of the converter to a count
    m = machine(law_program(base, wall), "fixed", (-400, 400))
    gains = []
    for friction in (Fraction("0.03"), Fraction("0.03") + Fraction(m.error)):
        device = base.replace(coulomb_friction=Exact(friction * Fraction("1.001")))
        found = judged(device, wall, m)
        assert found.ideal.outcome == "passive"
        assert found.proved == bool(gains)
        law, edge = HostLaw(text(m), tmp_path), Fraction(1, 2**20)
        loop = Loop(device, wall, found)
        gains.append(max(gained(loop, law, [n - edge, n + edge]) for n in range(1, 9)))
    assert gains[0] > 0 > gains[1]


def test_the_steps_of_a_converter_are_not_left_out(tmp_path: Path) -> None:
    """Half a step is more than the friction: nothing is proved, in double either, and a hand gains."""
    require("host")
    device = zw.Device(
        mass="0.1",
        damping="0.102",
        coulomb_friction="0.0425",
        resolution="8.819e-5",
        sample_period="0.00025",
        force_resolution="0.13947",
    )
    wall = zw.Wall("792.9")
    m = machine(law_program(device, wall), "double", (-400, 400))
    found = judged(device, wall, m)
    assert (found.ideal.outcome, found.proved, found.outcome) == ("passive", False, "undecided")
    edge = Fraction(1, 2**20)
    loop, law = Loop(device, wall, found), HostLaw(text(m), tmp_path)
    assert max(gained(loop, law, [n - edge, n + edge]) for n in range(1, 40)) > 0


def test_a_loop_that_is_lost_to_rounding_is_undecided() -> None:
    """That a hand gains with ε less of friction is no proof that it gains from the machine."""
    device = zw.Device(
        mass="0.1", damping=1, coulomb_friction="0.031", resolution="1e-4", sample_period="0.001"
    )
    wall = zw.Wall(600)
    found = judged(device, wall, machine(law_program(device, wall), "fixed", (-400, 400), 0.01))
    assert (found.ideal.outcome, found.verdict.outcome) in {("passive", "passive"), ("passive", "active")}
    assert found.outcome == ("passive" if found.proved else "undecided")
