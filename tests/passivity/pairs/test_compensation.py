"""Compensation of friction in two arms: the line above tanh, both sides of the limit, and what it needs."""

from __future__ import annotations

from fractions import Fraction
from math import atanh, tanh

import numpy as np
import pytest
from strategies import seeds

import zwidth as zw
from zwidth.passivity.covering_wall import line_of
from zwidth.passivity.pairs.criterion import PairCriterion, spending
from zwidth.passivity.pairs.evidence import energy_of
from zwidth.passivity.witness.motion import Motion

BILLIONTH = Fraction(1, 10**9)
ARM = zw.Device(damping=1, coulomb_friction="0.1", resolution=0, delay=0, rate="1 kHz")
Law = zw.FrictionCompensation
LAW = Law(coulomb="0.3", viscous="0.06", speed="0.35")
PAIR = zw.Pair(ARM, ARM, stiffness=100, delay="2 ms", compensation=LAW)


def both(**changes: object) -> dict[str, zw.Device]:
    return dict.fromkeys(("leader", "follower"), ARM.replace(**changes))


def with_share(pair: zw.Pair, share: Fraction) -> zw.Pair:
    """So many times the compensation of both sides."""
    law, other = pair.compensations
    return pair.replace(compensation=law.scaled(share), follower_compensation=other.scaled(share))


def largest_share(pair: zw.Pair) -> Fraction:
    """The most that is proved, to a part in 10¹²."""
    low, high = Fraction(0), Fraction(1)
    while zw.check(with_share(pair, high)).passive:
        low, high = high, 2 * high
    for _ in range(45):
        middle = (low + high) / 2
        low, high = (middle, high) if zw.check(with_share(pair, middle)).passive else (low, middle)
    return low


@seeds(15)
def test_a_line_is_above_and_touches(seed):
    """F tanh(v/v_s) ≤ h + s v, and at v = v_s artanh r they are one."""
    random = np.random.default_rng(seed)
    law = Law(coulomb=f"{random.uniform(0.1, 9):.3f}", speed=f"{random.uniform(0.01, 9):.3f}")
    r = 1 - Fraction(random.random()).limit_denominator(10**6) / 10 ** int(random.integers(0, 6))
    height, slope = map(float, line_of(law, r))
    most, speed = float(law.coulomb), float(law.speed)
    for v in [0, *np.exp(random.uniform(-9, 4, 50)) * speed]:
        assert most * tanh(v / speed) <= height + slope * v + 1e-12 * most
    touched = speed * atanh(float(r))
    assert most * tanh(touched / speed) == pytest.approx(height + slope * touched, rel=1e-9)


SHAPES = {
    "springs": {},
    "drives": {"drive_rate": "20 kHz"},
    "delays": both(delay="2 ms"),
    "tanh alone": {"compensation": LAW.replace(viscous=0)},
    "no friction": both(coulomb_friction=0),
    "all of it": both(coulomb_friction=3),
    "sign": {"compensation": Law(coulomb="0.3")},
    "D": {"follower_stiffness": 100, "local_damping": "-0.1", "delay": ("1 ms", "5 ms")},
}


@pytest.mark.parametrize("shape", SHAPES)
def test_both_sides_of_the_largest_share(shape):
    pair = PAIR.replace(**SHAPES[shape])
    share = largest_share(pair)
    assert zw.check(pair).largest_compensation == pytest.approx(float(share), rel=1e-6)
    below = zw.check(with_share(pair, share * (1 - BILLIONTH)))
    assert below.certificate.verify()
    above = zw.check(with_share(pair, share * (1 + BILLIONTH)))
    assert above.outcome == "active"
    assert above.witness.verify()
    assert above.witness.energy > 0


def test_a_delay_within_a_sample_leaves_a_gap():
    """What a hand wins there is reckoned with less damping than it has: a part in 10³ above it is active."""
    pair = PAIR.replace(**both(delay="1.3 ms"))
    share = largest_share(pair)
    assert zw.check(with_share(pair, share)).passive
    above = zw.check(with_share(pair, share * Fraction("1.001")))
    assert above.outcome == "active"
    assert above.witness.verify()


def test_what_it_costs_has_closed_forms():
    """Springs, equal arms: C + s ≤ b − K T (n + 1), s = F/v_s without friction, 0 with enough of it."""
    left = 1 - 100 * 0.001 * 3
    for friction, taken in ((0, 0.06 + 0.3 / 0.35), (9, 0.06)):
        share = largest_share(PAIR.replace(**both(coulomb_friction=friction)))
        assert float(share) == pytest.approx(left / taken, rel=1e-9)
    dry = PAIR.replace(compensation=Law(coulomb="0.1"))
    assert float(largest_share(dry)) == 1


def test_the_limit_is_where_constant_speeds_gain():
    """Springs, equal arms: the most over v of φ(v) − f_c over v is what damping is left."""
    v = np.linspace(1e-4, 2, 200_000)
    left = 1 - 100 * 0.001 * 3
    share = float(largest_share(PAIR))
    most = ((share * (0.3 * np.tanh(v / 0.35) + 0.06 * v) - 0.1) / v).max()
    assert most == pytest.approx(left, rel=1e-8)


def test_each_side_has_its_own():
    one = PAIR.replace(follower_compensation=Law())
    bare = PAIR.replace(compensation=None)
    assert PAIR.compensations == (LAW, LAW)
    assert one.compensations == (LAW, Law())
    assert bare.compensations == (Law(),) * 2
    assert zw.check(one).largest_compensation > zw.check(PAIR).largest_compensation
    assert zw.check(one).required_friction[1] == 0
    assert zw.check(bare).largest_compensation is None


def test_needs_are_limits():
    pair = with_share(PAIR, Fraction("1.7")).replace(follower_compensation=LAW)
    verdict = zw.check(pair)
    assert verdict.outcome == "active"
    assert "compensation of friction" in verdict.limit
    needs = {"damping": verdict.required_damping, "coulomb_friction": verdict.required_friction}
    for key, needed in needs.items():
        for size, passive in ((1.00001, True), (0.99999, False)):
            leader = ARM.replace(**{key: needed[0] * size})
            assert zw.check(pair.replace(leader=leader)).passive is passive
    assert verdict.largest_stiffness is None or verdict.largest_stiffness < 100
    advice = {advice.parameter: advice for advice in verdict.advice}["compensation"]
    assert zw.check(with_share(pair, Fraction(repr(advice.to)))).passive
    assert "% of what it is" in advice.text


def test_a_round_that_is_large_enough_knows_nothing_of_tanh():
    """With C too large there is a frequency, and a motion, however much F brakes."""
    pair = PAIR.replace(compensation=LAW.replace(viscous="0.8"))
    bare = PAIR.replace(compensation=None, local_damping="-0.8")
    assert PairCriterion(pair).polynomials == PairCriterion(bare).polynomials
    verdict = zw.check(pair)
    assert verdict.violation.verify()
    assert verdict.witness.verify()


@seeds(12)
def test_any_mean_of_past_moves_is_covered_by_the_wider_proof(seed):
    """It takes C + s of damping and none of local damping: never less than the proof of the last move."""
    random = np.random.default_rng(seed)
    pair = PAIR.replace(
        damping=f"{random.choice([0, 0.2, 0.3]):.1f}",
        drive_rate=random.choice([None, 5000]),
        compensation=LAW.scaled(Fraction(int(random.integers(1, 14)), 10)),
    )
    wider, narrower = spending(pair, any_mean=True), spending(pair)
    verdict = zw.check(pair)
    assert verdict.passive is narrower.proves
    assert narrower.proves or not wider.proves
    if verdict.passive:
        assert verdict.certificate.any_mean is wider.proves
        assert verdict.certificate.verify()
    for theta in random.uniform(0, np.pi, 5):
        gap = np.diag(narrower.at(theta) - wider.at(theta)).real
        assert (gap >= -1e-9).all()


def taken_with(pair: zw.Pair, x: np.ndarray, weights: np.ndarray) -> float:
    """Energy out of a motion of both hands from rest, the speed a mean of past moves, by the definitions."""
    period, total = float(pair.sample_period), 0.0
    age = int(pair.there.fraction / pair.sample_period)
    late = np.concatenate((np.zeros((2, age)), x[:, : x.shape[1] - age]), axis=1)
    for i, side in enumerate(pair.sides):
        law, moves = side.compensation, np.diff(x[i], prepend=x[i, 0])
        v = np.convolve(moves, weights)[: len(moves)] / period
        force = float(side.stiffness) * (x[i] - late[1 - i])
        force -= float(law.coulomb) * np.tanh(v / float(law.speed)) + float(law.viscous) * v
        moved = np.diff(x[i])
        total -= (force[:-1] * moved + float(side.damping) / period * moved**2).sum()
        total -= float(side.coulomb_friction) * np.abs(moved).sum()
    return total


@pytest.mark.parametrize("age", [0, 1, 2, 5])
@seeds(10)
def test_late_and_filtered_speeds_gain_nothing_where_the_proof_covers_them(age, seed):
    """Rounds in which it comes a whole turn late drive most; with a little more straight ways gain."""
    random = np.random.default_rng(seed)
    law = Law(coulomb="0.3", viscous="0.2", speed="0.35")
    pair = PAIR.replace(stiffness=1, compensation=law)
    low, high = 0.0, 8.0
    for _ in range(40):
        share = (low + high) / 2
        within = spending(with_share(pair, Fraction(share)), any_mean=True).proves
        low, high = (share, high) if within else (low, share)
    tight = with_share(pair, Fraction(low))
    assert zw.check(tight).certificate.any_mean
    weights = np.eye(6)[age] if random.random() < 0.5 else np.full(age + 1, 1 / (age + 1))
    turn = np.arange(12 * (age + 1) * 20) / (age + 1)
    for size in 10 ** random.uniform(-6, 0, 8):
        wave = np.sin(2 * np.pi * turn) + 0.1 * random.normal(size=(2, len(turn)))
        ramp = np.minimum(np.arange(len(turn)), len(turn) - 1 - np.arange(len(turn))) * np.ones((2, 1))
        for x in (wave, ramp):
            x = size * (x - x[:, :1]) * random.choice([-1, 1], size=(2, 1))
            assert taken_with(tight, x, weights) <= 1e-9 * size**2
    more, there = with_share(pair, Fraction(low) * Fraction("1.1")), np.arange(400)
    way = np.minimum(there, 399 - there) * np.array([[1.0], [-1.0]]) * float(pair.sample_period)
    assert max(taken_with(more, v * way, weights) for v in np.geomspace(0.01, 3, 40)) > 0


def test_encoders_are_paid_first():
    """F ≤ f_c − e costs no damping; of C half a count each way is in e."""
    arm = ARM.replace(resolution="1e-4", coulomb_friction="0.5")
    pair = zw.Pair(arm, arm, stiffness=100, delay="2 ms", drive_rate="20 kHz")
    left = Fraction(1, 2) - 100 * Fraction("1e-4")
    law = Law(coulomb=left, speed="0.01")
    assert spending(pair.replace(compensation=law)).tangents == (1, 1)
    assert zw.check(pair.replace(compensation=law)).passive
    more = spending(pair.replace(compensation=law.replace(viscous="0.1")))
    assert more.missing_friction == (0, 0) or max(more.tangents) < 1
    wide = PairCriterion(pair.replace(compensation=law.replace(viscous="0.1")))
    assert float(wide.missing_friction[0]) == pytest.approx(0.1 * 1e-4 / 0.001)


@pytest.mark.parametrize("drives", [False, True])
@seeds(15)
def test_no_motion_gains_where_none_is_said_to(drives, seed):
    random = np.random.default_rng(seed)

    def number(low: float, high: float) -> str:
        return f"{np.exp(random.uniform(np.log(low), np.log(high))):.3g}"

    arms = [ARM.replace(damping=number(0.5, 2), coulomb_friction=number(0.01, 1)) for _ in (0, 1)]
    pair = zw.Pair(
        *arms,
        stiffness=100,
        damping=random.choice(["0", "0.1"]),
        delay="1 ms",
        drive_rate="4 kHz" if drives else None,
        compensation=Law(coulomb=number(0.01, 2), viscous=number(0.01, 0.2), speed=number(0.01, 3)),
    )
    share = zw.check(pair).largest_compensation
    tight = with_share(pair, Fraction(repr(share)) * Fraction("0.999"))
    assert zw.check(tight).passive
    often, grid = pair.own_readings, Fraction(1, 10**9)
    for trial in range(8):
        k = np.arange(12 * often)
        turns = random.uniform(0, 0.5 / often)
        paths = []
        for _ in (0, 1):
            size = float(number(1e-6, 1))
            x = [
                np.cumsum(random.normal(size=len(k))),
                np.sin(2 * np.pi * turns * k + random.uniform(0, 6)),
                np.minimum(k, len(k) - k) * random.choice([-1, 1]),
            ][trial % 3]
            paths.append(Motion(tuple(round(Fraction(float(v)) / grid) * grid for v in size * (x - x[0]))))
        assert energy_of(tight, *paths) <= 0


@pytest.mark.parametrize(
    ("given", "message"),
    [
        ({"follower_compensation": 3}, "follower_compensation is a FrictionCompensation or None, got int"),
        ({"coulomb": -1}, "coulomb must be ≥ 0"),
        ({"viscous": "-1 N*s/m"}, "helps the motion"),
        ({"speed": -1}, "sign of the speed"),
        ({"coulomb": "3 s"}, "coulomb"),
        ({"coulomb": (1, 2)}, "coulomb"),
    ],
)
def test_numbers_of_a_law_have_bounds(given, message):
    with pytest.raises(zw.InputError, match=message):
        (PAIR.replace if "follower_compensation" in given else Law)(**given)


def test_it_is_told():
    verdict = zw.check(PAIR)
    assert "compensation of friction by 0.3 N tanh(v/(0.35 m/s)) and 0.06 N·s/m" in PAIR.describe()
    assert "any mean of each arm's moves over past samples" in " ".join(verdict.assumptions)
    taken = zw.check(with_share(PAIR, Fraction(2)))
    assert "mean speed of each arm since its last sample" in " ".join(taken.assumptions)
    numbers = verdict.to_dict()
    assert numbers["largest_compensation"] == verdict.largest_compensation
    taken = numbers["compensation_takes"]["leader"]
    assert taken["coulomb_friction_N"] == pytest.approx(0.1)
    assert 0.06 < taken["damping_N_s_per_m"] < 0.06 + 0.3 / 0.35
    shown = dict(verdict.rows())["largest compensation"].partition(" %")[0]
    assert 0 <= 100 * verdict.largest_compensation - float(shown) < 0.1  # what is shown is passive, too
