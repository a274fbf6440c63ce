"""No hand gains from emitted code that is proved; where ε is what is lacking, some hand does."""

from __future__ import annotations

from dataclasses import replace
from fractions import Fraction
from pathlib import Path
from random import Random

import numpy as np
import pytest
from firmware.adversary import Loop, attacked, gained, random_loop, text
from firmware.emulated.host import HostLaw
from firmware.emulated.required import require

import zwidth as zw
from zwidth.errors import InputError
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
        mass="0.1", damping="0.102", coulomb_friction="0.0425", resolution="8.819e-5", rate=4000
    ).replace(force_resolution="0.13947")
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


# ---- chains that end in force bounding pay for the rounding of 24 bits themselves


PADDLE = zw.catalogue.device("haptic-paddle")
STIFF = zw.render(zw.Wall(2000, 1), zw.rendering.SlewLimit(2000), zw.rendering.ForceBounding())


def test_the_certificate_has_the_rounding_of_float() -> None:
    found = zw.emit(PADDLE, STIFF, number="float")
    assert found.judged.outcome == "passive"
    document = found.verdict.certificate.to_dict()
    assert Fraction(document["law"]["roundoff"]) == Fraction(1, 2**24)
    assert zw.verify(document).scope is not None
    document["law"]["hair"] = str(Fraction(1, 2**48))
    assert zw.verify(document).scope is None


def test_no_motion_gains_from_the_emitted_law(tmp_path: Path) -> None:
    """Walks, jumps and edges between two counts: the hand has put in at least as much as it has taken out."""
    require("host")
    found = zw.emit(PADDLE, STIFF, number="float", travel="-50 .. 50 mm")
    law, random = HostLaw(found.text, tmp_path), np.random.default_rng(3)
    b, friction, count, period = (
        float(PADDLE.exact(key)) for key in ("damping", "coulomb_friction", "resolution", "sample_period")
    )
    for size in (1, 3, 40, 1500):
        n = np.clip(np.cumsum(random.integers(-size, size + 1, 20_000)), -2000, 2000).astype(np.int32)
        law.init(int(n[0]))
        force = np.asarray(law.run(n), dtype=float)
        assert np.abs(force).max() > 0.1
        moves = count * np.diff(n.astype(float))
        put_in = np.cumsum(force[:-1] * moves + friction * np.abs(moves) + b / period * moves**2)
        assert put_in.min() >= -1e-9 * np.abs(put_in).max()


def test_a_delay_is_not_left_out() -> None:
    """Force bounding is proved without delay: neither a delay nor an interval of them is taken for none."""
    late = PADDLE.replace(delay=zw.Interval(0, zw.Exact("0.0002")))
    with pytest.raises(InputError, match="reckon with one number"):
        zw.emit(late, STIFF, number="float")
    with pytest.raises(InputError, match="not emitted"):
        zw.emit(PADDLE.replace(delay="0.2 ms"), STIFF, number="float")
    machine = zw.emit(PADDLE, STIFF, number="float").machine
    undecided = replace(zw.check(PADDLE, zw.Wall(100)), outcome="undecided", certificate=None)
    assert not judged(late, STIFF, machine, lambda *_: undecided).proved
