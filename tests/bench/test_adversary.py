"""The hand that tries to take energy out: which motions it knows, how fast it is, what it refutes."""

import re

import numpy as np
import pytest

import zwidth as zw
from zwidth.model.rendering import EnergyBounding, ForceBounding, PassiveLeap, PassivityController
from zwidth.study.bench import standard_laws
from zwidth.study.bench.adversary import attack
from zwidth.study.bench.motions import fixed_motions, found_motions, speed_of

PADDLE = zw.catalogue.device("haptic-paddle")
COARSE = zw.Device(
    mass="0.036", damping="0.15", coulomb_friction="0.0001", resolution="0.00005", sample_period="0.001"
)
"""Hardly any dry friction and wide counts."""


def replayed(device, law, found):
    """What the motion takes out when it is simulated again [J]."""
    motion = found.motion
    trace = zw.simulate(device, law, motion, (len(motion.positions) - 1) * device.exact("sample_period"))
    return float(trace["kinetic_energy"][-1] - trace["hand_work"][-1])


@pytest.mark.parametrize("fastest", [0.02, 1.0, 7.5, 40.0])
@pytest.mark.parametrize("device", [PADDLE, PADDLE.replace(resolution=0), COARSE])
def test_no_motion_is_faster_than_it_may_be_and_one_is_nearly_so_fast(device, fastest):
    """The fastest goes as far in a sample as whole counts allow."""
    speeds = [speed_of(x, 1e-3) for x in fixed_motions(device, fastest).values()]
    assert max(speeds) <= fastest
    count = float(device.exact("resolution")) or 1e-4
    assert max(speeds) > fastest - 2 * count / 1e-3
    assert all(len(x) > 1 for x in fixed_motions(device, fastest).values())


def test_what_is_found_against_the_wall_alone():
    """Proof and game: on the paddle 600 N/m is refuted below 1 m/s by the game, by 2.02 m/s by the proof."""
    found = found_motions(PADDLE, zw.Wall(600), 10.0)
    alone = found["the motion that refutes the wall alone"]
    peak = zw.check(PADDLE, zw.Wall(600)).witness.peak_speed
    assert speed_of(alone, 1e-3) == pytest.approx(peak, rel=1e-12)
    assert max(speed_of(x, 1e-3) for x in found_motions(PADDLE, zw.Wall(600), 1.0).values()) <= 1.0
    for name, motion in found.items():
        if "damping" not in name:
            only = {name: motion}
            assert attack(PADDLE, zw.Wall(600), fastest=10.0, known=only).extracts
    assert not any("alone" in name for name in found_motions(PADDLE, zw.Wall(300), 10.0))


def test_a_law_that_does_what_the_wall_does_falls_with_it():
    """The controller as published sees nothing: refuted at 600 N/m, as the wall is."""
    law = zw.render(zw.Wall(600), PassivityController(observer="published"))
    found = zw.compare(PADDLE, zw.Wall(600), {"published": law})
    assert found.scores["status"].item() == "active"
    shown = found.attacks["published"]
    assert replayed(PADDLE, law, shown) == pytest.approx(shown.total, rel=1e-9)
    assert shown.total > 0


def test_motions_found_against_the_wall_refute_laws_behind_which_it_stands():
    """Where the wall begins to give, no motion of the fixed set gains up to 1 m/s; that of values does."""
    wall = zw.Wall(534)
    known = found_motions(PADDLE, wall, 1.0)
    for stage in (PassiveLeap(), PassivityController(observer="published")):
        law = zw.render(wall, stage)
        assert not attack(PADDLE, law, fastest=1.0).extracts
        found = attack(PADDLE, law, fastest=1.0, known=known)
        assert "value iteration against the wall alone" in found.name
        assert found.extracts
        assert replayed(PADDLE, law, found) == pytest.approx(found.total, rel=1e-9)


def test_a_gain_that_needs_more_than_a_hand_has_says_how_fast():
    """Slower than (2f_c − K Δ)/(K T − 2b) nothing comes out of 350 N/m; the evidence names the speed."""
    wall = zw.Wall(350)
    law = zw.render(wall, PassivityController(observer="published"))
    limit = zw.check(PADDLE, wall).admissible_speed
    assert 4 < limit < 5
    assert not attack(PADDLE, law, fastest=limit).extracts
    found = attack(PADDLE, law)
    assert found.extracts
    assert limit < found.speed <= 10
    assert re.search(r"J out, at up to \d+(\.\d+)? m/s$", str(found))
    slow = attack(PADDLE, zw.Wall(2000))
    assert slow.speed <= 1
    assert "m/s" not in str(slow)
    told = zw.compare(PADDLE, wall, {"published": law}, fastest=3.0)
    assert told.scores["status"].item() == "undecided"


def test_credit_that_is_not_due_is_found_out():
    """Counts break energy bounding and the public force bounding, as proved on paper; not the counted law."""
    wall = zw.Wall(5000)
    known = found_motions(COARSE, wall, 10.0)
    for stage in (ForceBounding(encoder="ideal"), EnergyBounding()):
        law = zw.render(wall, stage)
        found = attack(COARSE, law, known=known)
        assert found.extracts
        assert replayed(COARSE, law, found) > 0
    assert not attack(COARSE, zw.render(wall, ForceBounding()), known=known).extracts


def test_force_bounding_withstands_on_other_devices():
    """Devices at random, walls far too stiff: the certificate is never beside a motion that gains."""
    rng = np.random.default_rng(5)
    for _ in range(4):
        b, fc, count = 10 ** rng.uniform(-1.5, 0.5), 10 ** rng.uniform(-4, -0.5), 10 ** rng.uniform(-5, -3.5)
        device = zw.Device(mass=0.1, damping=b, coulomb_friction=fc, resolution=count, sample_period=0.001)
        wall = zw.Wall(20 * b / 0.001)
        law = standard_laws(device, wall)["force-bounding"]
        assert zw.formulas.check_bounding(device, law).outcome == "passive"
        assert not attack(device, law, known=found_motions(device, wall, 10.0)).extracts


@pytest.mark.parametrize("fastest", [0, -1, 1e-6, float("inf"), float("nan")])
def test_a_speed_that_no_hand_has(fastest):
    with pytest.raises(zw.InputError, match=r"fastest is (the speed of a hand|in m/s: expected a finite)"):
        attack(PADDLE, zw.Wall(300), fastest=fastest)
    with pytest.raises(zw.InputError, match=r"fastest is (the speed of a hand|in m/s: expected a finite)"):
        zw.compare(PADDLE, zw.Wall(300), {"wall": zw.Wall(300)}, fastest=fastest)
