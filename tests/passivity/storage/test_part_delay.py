"""A delay of part of a sample: the force changes between two samples, and the hand may be anywhere then."""

from __future__ import annotations

from fractions import Fraction
from itertools import pairwise

import pytest
from counted_device import device

import zwidth as zw
from zwidth import checker
from zwidth.passivity.bracket import passive_limit
from zwidth.passivity.storage import available_storage
from zwidth.passivity.storage.program import program_of

BOUNDS = {"penetration": "0.0008", "speed": "0.8"}


def bracket(delay, wall=None):
    """Of the stiffness of a spring, for a device that is limited by damping and friction alike."""
    return passive_limit(device("0.3", "0.02", delay), wall or zw.Wall(100), "stiffness", **BOUNDS)


@pytest.mark.parametrize(
    "wall", [zw.Wall(100), zw.Wall(100, clamped=True), zw.NonlinearSpring.detents(1, "0.0008", "0.05")]
)
@pytest.mark.parametrize("delay", ["0.1", "0.5", "0.9"])
def test_both_sides(delay, wall):
    """Within 1 %, each side with its evidence, more than closed forms prove of every hand."""
    name = "gain" if isinstance(wall, zw.NonlinearSpring) else "stiffness"
    found = passive_limit(device("0.3", "0.02", delay), wall, name, **BOUNDS)
    assert found.relative_width <= 0.01
    assert found.certificate.verify()
    assert found.witness.verify()
    if found.every_hand[0] is not None:
        assert found.proved_passive > found.every_hand[0]


def test_it_joins_the_delays_of_whole_samples():
    """From both sides: a change of the force right after or right before a sample is none."""
    whole = [bracket(d) for d in (0, 1)]
    for near, exact in zip(("0.001", "0.999"), whole, strict=True):
        found = bracket(near)
        assert found.proved_passive == pytest.approx(exact.proved_passive, rel=0.02)
        # no faster in the short part
        assert found.proved_active == pytest.approx(exact.proved_active, rel=0.03)
    between = [bracket(d) for d in ("0.3", "0.6")]
    ordered = [whole[0], *between, whole[1]]
    assert all(a.proved_passive > b.proved_active for a, b in pairwise(ordered))


def test_longer_than_a_sample():
    found = available_storage(device("0.3", "0.02", "1.5"), zw.Wall(50), **BOUNDS)
    assert found.outcome == "passive"
    assert found.certificate.verify()
    found = available_storage(device("0.1", "0.01", "1.5"), zw.Wall(300), **BOUNDS)
    assert found.outcome == "active"
    assert found.witness.verify()


def test_where_the_hand_is_between_samples_matters():
    """The motion that goes straight from sample to sample gains less, and may not gain at all."""
    held = device("0.3", "0.02", "0.5")
    found = available_storage(held, zw.Wall(bracket("0.5").proved_active), **BOUNDS).witness
    document = found.to_dict()
    x = document["positions_m"]
    straight = {**document, "switch_positions_m": [(a + b) / 2 for a, b in pairwise(x)]}
    best = checker.verify(document)
    assert best.valid
    other = checker.verify(straight)
    assert other.gain < found.exact_gain


def test_the_motion_keeps_to_its_bounds_in_each_part():
    for delay in ("0.2", "0.7"):
        part = Fraction(delay)
        motion = available_storage(device("0.1", "0.02", delay), zw.Wall(700), **BOUNDS).witness.motion
        x, y = motion.positions, motion.switch_positions
        assert len(y) == len(x) - 1
        most = Fraction("0.0008") * (1 + Fraction(1, 1000))
        for before, there, after in zip(x, y, x[1:], strict=False):
            assert abs(there - before) <= most * part
            assert abs(after - there) <= most * (1 - part)
        assert max(*x, *y) <= Fraction("0.0008")


def test_a_delay_of_very_many_samples_is_too_large_at_once() -> None:
    """A search that raises the rate comes there: the power of the number of moves is not worked out."""
    device = zw.Device(
        damping="0.02", coulomb_friction="0.05", resolution="1e-4", rate="1e15 Hz", delay="0.3 ms"
    )
    program = program_of(device, zw.NonlinearSpring(["0.35", "0.6"], [0, 5]))
    assert program.too_large is not None
    assert program.refute(4) is None
