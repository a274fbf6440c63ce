"""Pictures of two arms: what is drawn is what the criterion says."""

from __future__ import annotations

from fractions import Fraction

import numpy as np
import pytest

import zwidth as zw
from zwidth.passivity.pairs import PairCriterion, largest_spring
from zwidth.show import plots
from zwidth.show.plots.pair import damping_boundary, link_limits

ARM = zw.Device(damping="0.5", coulomb_friction="0.1", resolution=0, delay=0, rate="1 kHz")
PAIR = zw.Pair(ARM, ARM.replace(damping=1), stiffness=100, damping="0.02", delay="2 ms")


def test_inside_the_boundary_the_pair_is_passive():
    leader, follower = damping_boundary(PAIR)
    for b, f in list(zip(leader, follower, strict=True))[::6]:
        for share, holds in ((1.01, True), (0.99, False)) if np.isfinite(f) else ():
            arms = (ARM.replace(damping=float(damping)) for damping in (b, f * share))
            changed = dict(zip(("leader", "follower"), arms, strict=True))
            assert PairCriterion(PAIR.replace(**changed)).holds is holds


@pytest.mark.parametrize("delay", [("2 ms", "2 ms"), ("2 ms", "3 ms"), ("0", "0"), ("0", "0.5 ms")])
def test_the_stairs_are_the_limits(delay):
    """At every delay at which a reading becomes older, those there and back in proportion."""
    springs = PAIR.replace(damping=0, delay=delay)
    ways = [value.fraction for value in springs.delay]
    ways = ways if any(ways) else [1, 1]
    delays, stiffness = link_limits(springs)
    assert len(delays) > 5
    for mean, limit in zip(delays, stiffness, strict=True):
        share = 2 * Fraction(mean).limit_denominator(10**7) / sum(ways)
        late = springs.replace(delay=(share * ways[0], share * ways[1]))
        assert limit == pytest.approx(float(largest_spring(late)), rel=1e-5)


def test_the_pair_stands_beside_its_own_limit():
    pair = zw.Pair(ARM.replace(damping=2), ARM.replace(damping=2), stiffness=570.9, delay=("2 ms", "3 ms"))
    delays, stiffness = link_limits(pair)
    (here,) = np.flatnonzero(np.isclose(delays, 0.0025))
    assert stiffness[here] == pytest.approx(4000 / 7, rel=1e-6)


@pytest.mark.parametrize("stiffness", [10, 1000])
def test_a_picture_of_either(stiffness, tmp_path):
    verdict = zw.check(PAIR.replace(stiffness=stiffness))
    figure = plots.plot_pair(verdict)
    assert len(figure.axes) == (2 if verdict.passive else 4)
    (mark,) = (line for line in figure.axes[1].lines if line.get_gid() == "pair")
    assert mark.get_ydata()[0] == stiffness
    assert mark.get_xdata()[0] == pytest.approx(2)
    verdict.plot(tmp_path / "pair.png")
    assert (tmp_path / "pair.png").stat().st_size > 1000


def test_the_energy_is_drawn_to_the_end_of_the_motion():
    verdict = zw.check(PAIR.replace(stiffness=1000))
    figure = plots.plot_pair(verdict)
    (curve,) = (line for line in figure.axes[3].lines if line.get_gid() == "energy")
    time, energy = curve.get_data()
    assert (time[0], energy[0]) == (0, 0)
    ends = time[-1] / verdict.witness.duration, energy[-1] / verdict.witness.energy
    for end, label in zip(ends, (figure.axes[3].get_xlabel(), figure.axes[3].get_ylabel()), strict=True):
        prefix = label.rpartition("[")[2][:-2]
        assert end == pytest.approx({"": 1, "m": 1e3, "µ": 1e6}[prefix])


@pytest.mark.parametrize(("damping", "shown"), [("0.9", "linear"), ("0.01", "log")])
def test_far_from_what_is_needed_axes_are_logarithmic(damping, shown):
    """So that what is there and what is needed are both seen, of damping and of stiffness."""
    arm = ARM.replace(damping=damping)
    verdict = zw.check(zw.Pair(arm, arm, stiffness=400, delay="2 ms"))
    above, beside = plots.plot_pair(verdict).axes[:2]
    assert (above.get_xscale(), above.get_yscale(), beside.get_yscale()) == (shown, shown, shown)
    for axes, here in ((above, float(damping)), (beside, 400)):
        assert axes.get_ylim()[0] < here < axes.get_ylim()[1]


def test_where_friction_lacks_the_damping_that_is_enough_says_so():
    arm = ARM.replace(damping=2, coulomb_friction="0.004", resolution="1e-4")
    verdict = zw.check(zw.Pair(arm, arm, stiffness=400))
    assert verdict.outcome == "active"
    words = plots.plot_pair(verdict).axes[0].get_legend().get_texts()
    assert words[0].get_text() == "enough damping, not friction"


# ---- one arm of a pair in a known hand

LIGHT = zw.Device(damping="0.3", mass="0.02", coulomb_friction=0, resolution=0, delay=0, rate="1 kHz")
HAND = zw.stability.HandImpedance(mass=0.05, stiffness=100, damping=(2, "2.1"))


@pytest.mark.parametrize("stiffness", [240, 300])
def test_a_picture_of_a_pair_whose_other_arm_is_held(stiffness, tmp_path):
    """The curve is below the damping of the leader at every frequency exactly if it is passive."""
    verdict = zw.check(zw.Pair(LIGHT, LIGHT, stiffness=stiffness, delay="2 ms"), follower=HAND)
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
    rubbed = LIGHT.replace(coulomb_friction="0.1")
    verdict = zw.check(zw.Pair(LIGHT, rubbed, stiffness=248, delay="2 ms"), follower=HAND)
    assert len(plots.plot_held_pair(verdict).axes) == 1
