"""What limits a claim about two arms is in its short form too."""

from __future__ import annotations

import pytest

import zwidth as zw
from zwidth.passivity.pairs.in_short import pair_in_short

ARM = zw.Device(
    mass=0.3, damping=0.4, coulomb_friction=0.1, resolution="20e-6", sample_period="0.001", delay=0
)
BLIND = ARM.replace(resolution=0)


@pytest.mark.parametrize(
    ("pair", "said"),
    [
        (
            zw.Pair(ARM, ARM, stiffness=100, delay="0.002"),
            (
                "two hands of any speed and force",
                "what the spring between the arms holds at the start may come back",
                "both arms read at the same instants",
                "readings of the other arm at most 2 samples old",
                "ideal actuators, no compensation of friction or gravity",
                "encoder steps counted",
            ),
        ),
        (
            zw.Pair(BLIND, BLIND, stiffness=900, follower_stiffness=600, delay="0.002"),
            (
                "counts 1.5 times: one body that holds both arms is not covered",
                "readings of the other arm just 2 samples old, none lost",
                "ideal position sensors",
            ),
        ),
    ],
)
def test_what_limits_a_verdict_on_two_arms(pair: zw.Pair, said: tuple[str, ...]) -> None:
    """Hands, springs, instants, ages of readings, actuators, encoders."""
    found = pair_in_short(zw.check(pair))
    assert [part for part in said if part not in found] == []


def test_what_limits_a_verdict_on_a_held_pair() -> None:
    """Who holds the other arm, and that mass and damping are just those given."""
    pair = zw.Pair(BLIND, BLIND, stiffness=900, delay="0.002")
    found = pair_in_short(zw.check(pair, follower=None))
    for part in (
        "a hand of any speed and force on the leader",
        "nobody on the follower",
        "mass and damping of the follower just as given, both arms at rest at first",
    ):
        assert part in found


def test_what_was_not_given_is_said_of_both_or_of_one() -> None:
    """Taken as 0, of which arm."""
    silent = zw.Device(mass=0.3, damping=0.4, sample_period="0.001", coulomb_friction=0, resolution=0)
    both = zw.check(zw.Pair(silent, silent, stiffness=100))
    assert "delay of both not given, taken as 0" in pair_in_short(both)
    one = zw.check(zw.Pair(BLIND, silent, stiffness=100))
    assert "delay of the follower not given, taken as 0" in pair_in_short(one)
