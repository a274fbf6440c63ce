"""What limits a claim about two arms is in its short form too."""

from __future__ import annotations

import pytest

import zwidth as zw
from zwidth.passivity.pairs.in_short import pair_in_short

BLIND = zw.Device(mass=0.3, damping=0.4, coulomb_friction=0.1, resolution=0, sample_period="0.001", delay=0)
ARM = BLIND.replace(resolution="20e-6")
SILENT = zw.Device(mass=0.3, damping=0.4, sample_period="0.001", coulomb_friction=0, resolution=0)
SPRINGS = {"stiffness": 900, "delay": "0.002"}


@pytest.mark.parametrize(
    ("pair", "asked", "said"),
    [
        (
            zw.Pair(ARM, ARM, stiffness=100, delay="0.002"),
            {},
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
            zw.Pair(BLIND, BLIND, follower_stiffness=600, **SPRINGS),
            {},
            (
                "counts 1.5 times: one body that holds both arms is not covered",
                "readings of the other arm just 2 samples old, none lost",
                "ideal position sensors",
            ),
        ),
        (
            zw.Pair(BLIND, BLIND, **SPRINGS),
            {"follower": None},
            (
                "a hand of any speed and force on the leader",
                "nobody on the follower",
                "mass and damping of the follower just as given, both arms at rest at first",
            ),
        ),
        (zw.Pair(SILENT, SILENT, stiffness=100), {}, ("delay of both not given, taken as 0",)),
        (zw.Pair(BLIND, SILENT, stiffness=100), {}, ("delay of the follower not given, taken as 0",)),
    ],
    ids=["any two hands", "unequal springs", "one arm held", "neither says its delay", "one does not"],
)
def test_what_limits_a_verdict_on_two_arms(pair, asked, said) -> None:
    found = pair_in_short(zw.check(pair, **asked))
    assert [part for part in said if part not in found] == []
