"""The picture of one arm of a pair in a known hand: what is drawn is what was found."""

from __future__ import annotations

import numpy as np
import pytest

import zwidth as zw
from zwidth.show import plots

ARM = zw.Device(damping="0.3", mass="0.02", coulomb_friction=0, resolution=0, delay=0, rate="1 kHz")
HAND = zw.stability.HandImpedance(mass=0.05, stiffness=100, damping=(2, "2.1"))


@pytest.mark.parametrize("stiffness", [240, 300])
def test_a_picture_of_either(stiffness, tmp_path):
    """The curve is below the damping of the leader at every frequency exactly if it is passive."""
    verdict = zw.check(zw.Pair(ARM, ARM, stiffness=stiffness, delay="2 ms"), follower=HAND)
    verdict.plot(tmp_path / "held.png")
    damping, limits = plots.plot_held_pair(verdict).axes
    needs = np.asarray(damping.lines[0].get_ydata())
    assert bool((needs <= 0.3).all()) is verdict.passive
    widths = [bar.get_width() for bar in limits.patches]
    assert widths == [
        verdict.largest_stiffness,
        verdict.largest_stiffness_of_any_such_hand,
        verdict.largest_stiffness_of_two_hands,
    ]


def test_without_a_law_that_is_felt_the_limits_stand_alone():
    rubbed = ARM.replace(coulomb_friction="0.1")
    verdict = zw.check(zw.Pair(ARM, rubbed, stiffness=248, delay="2 ms"), follower=HAND)
    assert len(plots.plot_held_pair(verdict).axes) == 1
