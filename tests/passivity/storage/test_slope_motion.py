"""A spring given by points that is too steep: a motion to and fro on its rise, checked and simulated."""

from fractions import Fraction
from random import Random

import numpy as np
import pytest

import zwidth as zw
from zwidth import checker
from zwidth.passivity.formulas.nonlinear_spring import certify_spring, spring_need
from zwidth.passivity.storage.domain import losses_of
from zwidth.passivity.storage.law import finite_law
from zwidth.passivity.storage.slope_motion import slope_motion
from zwidth.passivity.wording import claim_of_a_motion

KNOB = zw.Device(
    mass="2e-5",
    motion="rotary",
    damping="2e-4",
    coulomb_friction="2e-4",
    resolution="4e-4",
    sample_period="5e-4",
)
LIMIT = Fraction("0.8")
"""2 b/T of it; the Coulomb friction is enough, s Δ/2 = 0.16 mN·m."""


def centring(slope, reach="0.7", middle=0):
    """Rises through 0 at a place, and saturates at both ends."""
    far, at = Fraction(reach), Fraction(middle)
    points = [at - far - 1, at - far, at + far, at + far + 1]
    return zw.NonlinearSpring(points, [slope * far * side for side in (-1, -1, 1, 1)])


def taken(device, spring, witness):
    """What the hand gets out of the loop in the simulator [J]."""
    hand = zw.operators.WitnessMotion(witness)
    seconds = (hand.intervals + 1) * device.exact("sample_period")
    trace = zw.simulate(device, spring, hand, seconds, amplifier=zw.amplifiers.Ideal(), encoder_phase=0)
    return -float(trace["hand_work"].values[-1])


@pytest.mark.parametrize("middle", [0, "0.30005", "-0.20003"])
def test_a_centring_spring_is_decided_on_both_sides_of_its_limit(middle):
    """s = 2b/T by a thousandth less and a thousandth more, also where no reading is without force."""
    proved = zw.check(KNOB, centring(LIMIT * Fraction("0.999"), middle=middle), iterate=False)
    assert proved.outcome == "passive"
    assert proved.certificate.verify()
    steep = centring(LIMIT * Fraction("1.001"), middle=middle)
    refuted = zw.check(KNOB, steep, iterate=False)
    assert refuted.outcome == "active"
    assert checker.verify(refuted.witness.to_dict()).energy == refuted.witness.exact_energy > 0
    assert taken(KNOB, steep, refuted.witness) == pytest.approx(refuted.witness.energy, rel=1e-6)


def test_what_the_spring_stores_at_the_start_is_no_gain():
    """A hand begins at 0, high above what lies beyond a hill: more comes out than that, ½ · 0.05 · 0.4 J."""
    steep = LIMIT * Fraction("0.02") * Fraction("1.5")
    spring = zw.NonlinearSpring(["-0.4", "-0.2", 0, "0.02"], [0, "0.05", 0, steep])
    refuted = zw.check(KNOB, spring, iterate=False)
    stored = 0.5 * 0.05 * 0.4
    assert refuted.outcome == "active"
    assert refuted.witness.positions[0] == pytest.approx(0, abs=1e-3)
    energy = taken(KNOB, spring, refuted.witness)
    assert energy > stored
    assert energy - stored == pytest.approx(refuted.witness.energy, rel=1e-4)


@pytest.mark.parametrize(
    ("delay", "share"), [("5e-4", "1.2"), ("2e-3", "1.2"), ("2e-4", "1.4"), ("1.2e-3", "1.2")]
)
def test_behind_a_delay(delay, share):
    """Some more than (2d + 1) s T/2 = b, whole samples and parts of one: the hand waits for the force."""
    device = KNOB.replace(delay=delay)
    period = device.exact("sample_period")
    late = 2 * device.exact("delay") / period + 1
    steep = centring(LIMIT / late * Fraction(share), middle="0.00031")
    refuted = zw.check(device, steep, iterate=False)
    assert refuted.outcome == "active"
    assert checker.verify(refuted.witness.to_dict()).energy > 0
    # a place on the edge of a count may be read as on either side of it, in doubles
    assert taken(device, steep, refuted.witness) == pytest.approx(refuted.witness.energy, rel=2e-3)


def test_what_coulomb_friction_pays_for():
    """Detents whose rises are short: proved above 2b/T and refuted a little further on, of every hand."""
    device = KNOB.replace(coulomb_friction="2e-3", resolution="3.8e-4")
    found = zw.limit(device, zw.NonlinearSpring.detents(3, "0.5", "0.2"), "gain")
    assert found.scope.hands.every
    assert found.relative_width < 0.006
    slope = found.proved_passive * 4 * 0.2 / 0.5
    assert slope * 0.25 == pytest.approx(0.8 * 0.25 + 2 * 2e-3, rel=0.01)  # (s − 2b/T) p/2 = 2 f_c
    assert found.certificate.verify()


@pytest.mark.parametrize("seed", range(30))
def test_nothing_is_both_proved_and_refuted(seed):
    """Random springs with about the friction that they need: no motion gains where the checker accepts."""
    rng = Random(seed)
    positions = sorted(rng.sample(range(-400, 400), rng.randint(2, 7)))
    forces = [rng.randint(-100, 100) for _ in positions]
    forces[0], forces[-1] = min(forces[0], 0), max(forces[-1], 0)
    thousandth = Fraction(1, 1000)
    spring = zw.NonlinearSpring([x * thousandth for x in positions], [f * thousandth for f in forces])
    bare = zw.Device(damping=0, coulomb_friction=0, resolution="0.002", sample_period="0.001", delay=0)
    need = spring_need(bare, spring)
    friction = need.coulomb_friction + Fraction(rng.randint(0, 60), 2000)
    device = bare.replace(damping=need.held * Fraction(rng.randint(20, 110), 100), coulomb_friction=friction)
    proved = certify_spring(device, spring).covered() is not None
    found = slope_motion(finite_law(device, spring), losses_of(device), "linear")
    assert not (proved and found)


def test_too_little_coulomb_friction():
    """f_c below s Δ/2 by a fiftieth, with twice the damping that is enough: over one edge, to and fro."""
    spring = centring(LIMIT / 2)
    edge = LIMIT / 2 * KNOB.exact("resolution") / 2
    assert zw.check(KNOB.replace(coulomb_friction=edge), spring, iterate=False).outcome == "passive"
    less = KNOB.replace(coulomb_friction=edge * Fraction("0.98"))
    refuted = zw.check(less, spring, iterate=False)
    assert refuted.outcome == "active"
    assert np.ptp(refuted.witness.cycle) < 2 * float(KNOB.exact("resolution"))


def test_within_the_force_limit_of_the_device():
    """A lock far above the limit: where its force stays within what the actuator gives; above, if nowhere."""
    lock = zw.NonlinearSpring([0, "0.1"], [0, "0.5"])
    weak = KNOB.replace(force_limit="0.1")
    refuted = zw.check(weak, lock, iterate=False)
    assert refuted.outcome == "active"
    assert not refuted.is_beyond_actuator
    assert max(refuted.witness.positions) <= 0.02 + 4e-4
    assert zw.check(weak.replace(force_limit="1e-4"), lock, iterate=False).is_beyond_actuator


def test_the_hand_keeps_to_its_bounds():
    """Of a slow hand near 0 only what it can do; friction outweighs the gain of a slower one."""
    spring = centring(LIMIT * Fraction("1.5"))
    bounds = {"penetration": "0.1", "speed": "20"}
    found = zw.available_storage(KNOB, spring, **bounds)
    assert found.outcome == "active"
    assert found.witness.peak_speed <= 20 * (1 + 1e-12)
    assert found.witness.depth <= 0.1
    assert found.witness.document["bounds"]["depth_rad"] == "0.1"


def test_a_motion_that_goes_on_for_too_long_is_called_so():
    """High on a soft spring a short steep piece: microjoules a round, a quarter of a joule to get there."""
    high = zw.NonlinearSpring(["-1", 0, "1", "1.01"], ["-0.5", 0, "0.5", "0.5085"])
    refuted = zw.check(KNOB, high, iterate=False)
    assert refuted.witness.motion.samples * refuted.witness.sample_period > 60
    assert "although no hand goes on for so long" in refuted.claim
    assert "although" not in claim_of_a_motion(1e-3, 44.9, 0.1, 1.0, "rad")
    with pytest.raises(zw.InputError, match=r"goes on for 6\d.* s before .* the first 2\.05 s of it"):
        zw.replay(refuted)
