"""A delay that ends within a sample: what a loop that keeps its forces back is told to do, and is told."""

from __future__ import annotations

from fractions import Fraction

import pytest

import zwidth as zw
from zwidth.links import held_back
from zwidth.links.comparison import LinkComparison
from zwidth.quantity.spoken import answers_in

WHEEL = zw.Device(
    mass="0.03", damping="0.05", coulomb_friction="0.05", rate="1000", delay="0.0014", motion="rotary"
)
ROW = {"outcome": "passive", "taken": 0.0, "tracking_error": 0.02, "apart": 0.001, "felt_stiffness": 2.1}


def test_the_force_acts_after_whole_samples() -> None:
    """1.4 ms at 1 kHz are 2 ms, 0.6 ms more; 2 ms stay as they are."""
    late, held = held_back(WHEEL)
    assert (late.exact("delay"), held) == (Fraction(2, 1000), Fraction(6, 10000))
    assert held_back(late) == (late, 0)
    zw.links.WavePort(late)
    with pytest.raises(zw.InputError, match="--hold-back"):
        zw.links.WavePort(WHEEL)


def test_the_answer_says_so() -> None:
    """In the report and in the document, and only where it is so."""
    link = zw.links.Schedule()
    held = LinkComparison({"waves": ROW}, "rotary", link, {}, (Fraction(6, 10000), Fraction(0)))
    assert held.to_dict()["held_back_s"] == [0.0006, 0.0]
    assert any("kept back by 600 µs and 0 s more" in str(part) for part in held.report())
    plain = LinkComparison({"waves": ROW}, "rotary", link, {})
    assert "held_back_s" not in plain.to_dict()
    assert not any("kept back" in str(part) for part in plain.report())


def test_scores_are_told_in_the_angle_that_was_asked_for() -> None:
    """0.02 rad are 1.15 deg, 2.1 N·m/rad are 0.0367 N·m/deg; the document stays SI."""
    found = LinkComparison({"waves": ROW}, "rotary", zw.links.Schedule(), {})
    with answers_in("deg"):
        text = str(found)
    for part in ("deg", "1.15", "0.0573", "N·m/deg", "0.0367"):
        assert part in text
    assert "rad" not in text
    assert found.to_dict()["ports"]["waves"]["tracking_error_rad"] == 0.02


def test_ports_of_ones_own_have_their_own_devices() -> None:
    """There hold_back would say something that is not so."""
    with pytest.raises(zw.InputError, match="standard ports"):
        zw.links.compare(WHEEL, ports={}, hold_back=True)
