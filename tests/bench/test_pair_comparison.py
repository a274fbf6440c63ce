"""Ways to join two arms, beside each other: the numbers of each come from its verdict and its traces."""

import json

import pytest

import zwidth as zw
from zwidth.study.bench.pairs import HARD, missing_damping, schemes

ARM = zw.Device(damping=0.4, coulomb_friction="0.02", resolution="1 um", rate="1 kHz", delay=0, mass=0.05)
PAIR = zw.Pair(ARM, ARM, stiffness=100, delay="1 ms")


@pytest.fixture(scope="module")
def compared():
    """Three schemes, each with its arms."""
    forces = PAIR.replace(stiffness=0, follower_stiffness=100, reflection=1)
    return zw.compare({"positions": PAIR, "forces": forces, "loose": PAIR.replace(stiffness=400)})


def test_a_hard_wall_is_felt_through_the_spring(compared):
    for name, stiffness in (("positions", 100), ("forces", 100)):
        felt = float(compared.scores["felt_stiffness"].sel(scheme=name))
        assert felt == pytest.approx(stiffness * HARD / (HARD + 1), rel=0.03)


def test_outcomes_and_limits_are_those_of_the_verdicts(compared):
    assert compared.scores["outcome"].values.tolist() == ["passive", "passive", "active"]
    for name, verdict in compared.verdicts.items():
        assert verdict.outcome == str(compared.scores["outcome"].sel(scheme=name).values)
        limit = float(compared.scores["largest_stiffness"].sel(scheme=name))
        assert limit == pytest.approx(verdict.largest_stiffness)
    assert compared.scores["largest_stiffness"].values[1] < compared.scores["largest_stiffness"].values[0]


def test_missing_damping_makes_up_for_what_is_missing():
    """Both arms with so much more are passive, with a little less not: M(θ) gets the same on its diagonal."""
    hot = PAIR.replace(stiffness=400)
    lack = missing_damping(hot)
    assert lack > 0
    for share, outcome in ((1.001, "passive"), (0.999, "active")):
        arm = ARM.replace(damping=0.4 + share * lack, coulomb_friction=1)
        assert zw.check(hot.replace(leader=arm, follower=arm)).outcome == outcome
    assert missing_damping(PAIR) == 0


def test_as_a_table_and_as_json(compared):
    told = json.loads(compared.to_json())
    assert set(told["schemes"]) == {"positions", "forces", "loose"}
    assert told["schemes"]["positions"]["motion_energy_J"] is None
    assert told["schemes"]["loose"]["motion_energy_J"] > 0
    assert told["schemes"]["forces"]["tracking_error_m"] > 0
    assert "felt at the leader" in repr(compared)
    assert "<table" in compared._repr_html_()


@pytest.mark.parametrize(
    ("given", "message"),
    [
        (({},), "by name"),
        (({"a": 3},), "by name"),
        (({"a": PAIR}, zw.Wall(100)), "as they are"),
        (({"a": PAIR.replace(leader=ARM.replace(mass=None))},), "mass is needed"),
    ],
)
def test_what_cannot_be_compared_is_said(given, message):
    with pytest.raises(zw.InputError, match=message):
        zw.compare(*given)


def test_every_scheme_is_as_stiff_for_both_hands():
    """What the leader feels, and how often the follower's work counts, are those of the given pair."""
    pair = PAIR.replace(follower_stiffness=250, damping="0.02")
    ways = schemes(pair)
    assert list(ways) == ["position–position", "position–force", "four channels"]
    for way in ways.values():
        assert way.felt_stiffness == 100
        assert way.power_ratio == pair.power_ratio
    mixed = pair.replace(reflection="0.3")
    assert schemes(mixed)["as given"] == mixed
