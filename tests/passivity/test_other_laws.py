"""Laws without H(z) have the same verb: nonlinear springs, contacts, laws in a chain, walls of an arm."""

import json
from fractions import Fraction
from random import Random

import numpy as np
import pytest

import zwidth as zw
from zwidth import checker
from zwidth.checker import judge
from zwidth.model.rendering import ForceBounding, PassivityController, SlewLimit
from zwidth.passivity.certificate import verify_document
from zwidth.passivity.formulas.nonlinear_spring import spring_need

PADDLE = zw.catalogue.device("haptic-paddle")
TINY = Fraction(1, 10**9)
STEEP = zw.NonlinearSpring(["-0.013", "0.002", "0.0071", "0.02"], ["-3.1", "-0.7", "2.9", "1.3"])


def device_for(spring, delay=0, step="0.0003"):
    """A device that has what the slopes ask for: exactly where that is a fraction, else a billionth more."""
    bare = zw.Device(damping=0, coulomb_friction=0, resolution=step, sample_period="0.0013", delay=delay)
    need = spring_need(bare, spring)
    b = Fraction(need.damping).limit_denominator(10**15) * (1 + TINY) if need.within else need.held
    return bare.replace(damping=b, coulomb_friction=need.coulomb_friction)


STEEPEST, PERIOD = Fraction("3.6") / Fraction("0.0051"), Fraction("0.0013")
"""The steepest part of STEEP, which rises, and the sample period."""


def test_a_delay_of_part_of_a_sample_whose_root_is_a_fraction():
    """With L = s and 3/8 of a sample √((1/2 + 3/8)² + 15/64) = 1: b = (15/16) s T, and at its limit."""
    device = device_for(STEEP, delay=PERIOD * 3 / 8).replace(damping=STEEPEST * PERIOD * 15 / 16)
    verdict = zw.check(device, STEEP)
    assert (verdict.outcome, verdict.at_limit) == ("passive", True)
    assert spring_need(device, STEEP).damping == pytest.approx(float(device.damping), rel=1e-12)
    less = device.replace(damping=device.exact("damping") * (1 - TINY))
    assert zw.check(less, STEEP, iterate=False).outcome != "passive"


@pytest.mark.parametrize("delay", [0, "0.0013", "0.0039"])
def test_a_spring_is_proved_at_its_bounds_and_not_below(delay):
    """b = (L/2 + d s) T and f_c = s Δ/2 are enough, and a billionth less of either is not."""
    exact = device_for(STEEP, delay=delay)
    verdict = zw.check(exact, STEEP)
    assert (verdict.outcome, verdict.at_limit) == ("passive", True)
    assert (verdict.scope.contact, verdict.scope.encoder) == ("both sides", "counted")
    assert verdict.decided_by == "the slopes of the spring"
    assert verdict.certificate.verify()
    for name in ("damping", "coulomb_friction"):
        less = exact.replace(**{name: exact.exact(name) * (1 - TINY)})
        assert zw.check(less, STEEP, iterate=False).outcome != "passive"


def test_what_the_slopes_ask_for():
    """By hand: the slopes are 0.16, 3.6/0.0051 and −1.6/0.0129."""
    need = spring_need(device_for(STEEP), STEEP)
    assert float(need.largest_slope) == pytest.approx(3.6 / 0.0051)
    assert float(need.steepest) == pytest.approx(3.6 / 0.0051)
    assert float(need.damping) == pytest.approx(3.6 / 0.0051 * 0.0013 / 2)
    assert float(need.coulomb_friction) == pytest.approx(3.6 / 0.0051 * 0.0003 / 2)


def energy_out(device, spring, x):
    """−∫ (f + b v) dx − f_c ∫|dx| of many motions at once, begun at rest; plain arithmetic.

    Within a sample the force changes from g to h; the hand is where that costs it least but for friction.
    """
    step, period, b = float(device.resolution), float(device.sample_period), float(device.damping)
    samples, part = divmod(device.exact("delay") / device.exact("sample_period"), 1)
    part = float(part)
    read = np.floor(x / step + 1e-9) * step if step else x
    force = np.interp(read, [float(p) for p in spring.positions], [float(f) for f in spring.forces])
    force = np.concatenate([np.repeat(force[:, :1], samples + 1, axis=1), force], axis=1)
    before, after = force[:, : x.shape[1] - 1], force[:, 1 : x.shape[1]]
    move = np.diff(x, axis=1)
    first = part * move - period / (2 * b) * part * (1 - part) * (before - after)
    second = move - first
    dry = float(device.coulomb_friction) * (abs(first) + abs(second))
    viscous = b / period * ((first**2 / part if part else 0) + second**2 / (1 - part))
    return -(before * first + after * second + dry + viscous).sum(axis=1)


@pytest.mark.parametrize("seed", range(6))
def test_no_motion_gains_from_a_spring_that_is_proved(seed):
    """Random springs at their bounds against motions of their own scale: only what was stored comes out."""
    random, rng = Random(seed), np.random.default_rng(seed)
    places = np.cumsum(rng.uniform(0.2, 3.0, 6)) - 5
    forces = rng.normal(size=6)
    forces[0], forces[-1] = -abs(forces[0]), abs(forces[-1])
    spring = zw.NonlinearSpring([f"{x:.4f}" for x in places], [f"{f:.4f}" for f in forces])
    step = random.choice(["0", "0.01", "0.3"])
    device = device_for(spring, delay=random.choice([0, "0.0013", "0.0004", "0.0022"]), step=step)
    assert zw.check(device, spring).outcome == "passive"
    starts = rng.uniform(-6, 8, (400, 1))
    moves = rng.normal(size=(400, 60)) * 10 ** rng.uniform(-3, 1, (400, 1))
    turns = np.cumsum(rng.uniform(0, 3.1, (400, 1)) * np.ones((1, 60)), axis=1)
    waves = 10 ** rng.uniform(-3, 0.7, (400, 1)) * (np.sin(turns) - np.sin(turns[:, :1]))
    x = np.concatenate([starts + np.cumsum(moves, axis=1), starts + waves])
    # no more is stored than Φ(x₀ − Δ/2) − min Φ
    grid = np.linspace(-40, 40, 160_001)
    force = np.interp(grid, [float(p) for p in spring.positions], [float(f) for f in spring.forces])
    potential = np.concatenate([[0], np.cumsum((force[1:] + force[:-1]) / 2 * np.diff(grid))])
    stored = np.interp(x[:, 0] - float(step) / 2, grid, potential) - potential.min()
    assert (energy_out(device, spring, x) <= stored + 1e-3).all()


def test_below_its_bounds_a_motion_takes_energy_out():
    """Half of the damping and no friction: a motion on a rise gains, replayed exactly."""
    spring = zw.NonlinearSpring.detents(2, "0.013", "1.7")
    device = device_for(spring, step="0.0001")
    short = device.replace(damping=device.exact("damping") * Fraction(1, 2), coulomb_friction=0)
    verdict = zw.check(short, spring)
    assert (verdict.outcome, verdict.decided_by) == ("active", "a motion")
    assert checker.verify(verdict.witness.to_dict()).energy > 0
    assert [need.has < need.needed for need in verdict.needs] == [True, True]


def test_a_spring_that_pulls_away_for_ever():
    """Active if Coulomb friction holds less than it pulls; else neither is proved, and the claim says why."""
    away = zw.NonlinearSpring([0, "0.01"], [0, "-0.5"])
    verdict = zw.check(PADDLE, away)
    assert verdict.outcome == "active"
    assert verdict.violation.verify()
    assert "pulls away with 0.5 N" in verdict.claim
    assert verify_document(json.loads(verdict.to_json())).scope.shows == "active"
    assert all(part.verification.valid for part in judge(json.loads(verdict.to_json())).parts)
    held = zw.check(PADDLE.replace(coulomb_friction="0.5", resolution=0), away)
    assert held.outcome == "undecided"
    assert "no lowest value" in held.claim


def test_intervals_of_a_device_are_taken_at_their_worst():
    exact = device_for(STEEP)
    b, friction = (exact.exact(key) for key in ("damping", "coulomb_friction"))
    wide = exact.replace(
        damping=(b, 2 * b), coulomb_friction=(friction, 3 * friction), resolution=("0.0001", "0.0003")
    )
    verdict = zw.check(wide, STEEP)
    assert verdict.outcome == "passive"
    assert set(verdict.scope.intervals) == {"damping", "coulomb_friction", "resolution"}
    lower = wide.replace(damping=(b * (1 - TINY), 2 * b))
    assert zw.check(lower, STEEP, iterate=False).outcome != "passive"


def test_laws_in_a_row():
    """Force bounding and a covering wall prove; the roads are named, and the scope is that of the proof."""
    bounded = zw.check(PADDLE, zw.render(zw.Wall(770), ForceBounding()))
    assert bounded.outcome == "passive"
    assert "any before the last" in bounded.scope.law
    covered = zw.check(PADDLE, zw.render(zw.Wall(100), PassivityController(largest_damping="0.05")))
    assert covered.outcome == "passive"
    assert "covered by a wall" in covered.scope.law
    open_still = zw.check(PADDLE, zw.render(zw.Wall(770), SlewLimit(rate=1000)))
    assert open_still.outcome == "undecided"
    assert open_still.available_storage.outcome == "passive"
    assert "proved passive for hands of up to" in open_still.claim


ARM = zw.arms.PlanarChain(links=(0.1, 0.1), joint_range=((0.5, 0.6), (0.7, 0.8)), damping=(0.05, 0.05))
PAIR = zw.Pair(PADDLE, PADDLE, stiffness=100)


@pytest.mark.parametrize(
    ("asked", "given", "words"),
    [
        ((ARM, zw.Wall(100)), {}, "give rate="),
        ((PADDLE, zw.arms.MatrixWall([[100.0]])), {}, "of several coordinates"),
        ((PADDLE, zw.Wall(100)), {"rate": 1000}, "no rate: its rate and its delay are in the device"),
        (("paddle", zw.Wall(100)), {}, "a Device or an arm"),
        ((PAIR,), {"contact": "kept"}, "a pair takes leader, follower, and no contact"),
        ((PAIR,), {"iterate": False}, "no iterate"),
        ((ARM, zw.Wall(100)), {"rate": "1 kHz", "contact": "kept"}, "an arm takes rate, .*, and no contact"),
        ((ARM, zw.Wall(100)), {"rate": "1 kHz", "speed": 1}, "no speed"),
        ((PADDLE, zw.Wall(100)), {"discretization": "tustin"}, "no discretization: it belongs to the law"),
    ],
)
def test_what_a_subject_does_not_take_is_refused(asked, given, words):
    """With what it takes or lacks: a name that is ignored would be a claim about another question."""
    with pytest.raises(zw.InputError, match=words):
        zw.check(*asked, **given)


def test_arms_and_pairs_have_the_same_verb():
    assert zw.check(ARM, zw.Wall(100), rate="1 kHz", points=4).outcome == "passive"
    assert zw.check(PAIR, contact="made and broken").outcome == zw.check(PAIR).outcome


def test_a_refutation_at_the_worst_of_an_interval_is_not_one_of_the_whole_interval():
    """A pull of 0.5 N beats 0.12 N of Coulomb friction and not 3 N: the interval decides nothing."""
    pulling = zw.NonlinearSpring([-0.01, 0.01], [0.5, 1])
    assert zw.check(PADDLE.replace(coulomb_friction="0.12 N"), pulling).outcome == "active"
    found = zw.check(PADDLE.replace(coulomb_friction=zw.Interval("0.12", "3")), pulling)
    assert (found.outcome, found.finding) == ("undecided", "depends on values")
    assert not any("every value" in line for line in found.assumptions)


@pytest.mark.parametrize(
    "plays_no_part", [{"mass": (1, 2)}, {"force_limit": (50, 60)}, {"supply_voltage": (9, 12)}]
)
def test_an_interval_that_plays_no_part_leaves_a_refutation_as_it_is(plays_no_part):
    """It has no worst end, at which alone the motion would be one."""
    device = zw.Device(damping=1, coulomb_friction=1, resolution=1e-4, rate=1000, **plays_no_part)
    found = zw.check(device, zw.NonlinearSpring([-0.001, 0, 0.001], [-8, 0, 8]))
    assert (found.outcome, found.witness.verify()) == ("active", True)


def test_values_on_one_board_of_counts_say_nothing_of_counts_of_another_size():
    """What value iteration proves holds for the counts it was played with, and not for smaller ones."""
    slew = zw.render(zw.Wall(770), SlewLimit(rate=1000))
    step = PADDLE.exact("resolution")
    rough = PADDLE.replace(coulomb_friction=zw.Interval("0.12", "0.13"))
    assert zw.check(rough, slew).available_storage is not None
    assert zw.check(PADDLE.replace(resolution=zw.Interval(step / 2, step)), slew).available_storage is None
