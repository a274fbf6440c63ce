"""One arm of a pair in a known hand: what the other hand feels by another road, both sides of every limit."""

from __future__ import annotations

from fractions import Fraction

import numpy as np
import pytest
from asked_forces import asked_of
from scipy.linalg import expm
from strategies import seeds

import zwidth as zw
from zwidth.passivity.pairs.held import HeldPair, felt_law
from zwidth.passivity.pairs.held.law import felt

Hand = zw.stability.HandImpedance
ARM = zw.Device(damping="0.3", mass="0.02", coulomb_friction=0, resolution=0, delay=0, rate="1 kHz")
PAIR = zw.Pair(ARM, ARM, stiffness=60, delay="2 ms")
HAND = Hand(mass="50 g", stiffness=100, damping=2)


def random_question(seed: int) -> HeldPair:
    random = np.random.default_rng(seed)

    def arm() -> zw.Device:
        delay = int(random.integers(0, 3)) + float(random.choice([0, 0.25, 0.7]))
        return ARM.replace(
            damping=f"{random.uniform(0.1, 1):.3f}",
            mass=f"{random.uniform(0.01, 1):.3f}",
            delay=f"{delay / 1000:.5f}",
        )

    pair = zw.Pair(
        arm(),
        arm(),
        stiffness=f"{random.choice([0, 20]):.1f}",
        follower_stiffness=f"{random.uniform(10, 30):.2f}",
        reflection=1,
        follower_reflection=f"{random.choice([0, 0.5]):.1f}",
        damping=f"{random.uniform(0, 0.1):.3f}",
        local_damping=f"{random.uniform(-0.05, 0.1):.3f}",
        delay=tuple(f"{random.integers(0, 4) / 1000:.4f}" for _ in (0, 1)),
    )
    mass, stiffness, damping = (f"{random.uniform(0, most):.3f}" for most in (0.2, 300, 3))
    hand = Hand(mass=mass, stiffness=stiffness, damping=damping) if seed % 4 else Hand()
    return HeldPair(pair, "leader" if random.random() < 0.5 else "follower", hand)


def forces_of_the_free_arm(question: HeldPair, path: np.ndarray) -> np.ndarray:
    """What its controller asks for along a path, sample by sample, from the definitions alone."""
    pair, period = question.pair, float(question.pair.sample_period)
    here = 0 if question.free == "leader" else 1
    mass, damping, stiffness = (float(low) for low, _ in question.motion[:3])
    late = float(pair.sides[1 - here].delay) / period
    whole, part = int(late + 1e-9), late - int(late + 1e-9)
    a = np.array([[0, 1, 0], [-stiffness / mass, -damping / mass, -1 / mass], [0, 0, 0]])
    early, rest = expm(a * part * period), expm(a * (1 - part) * period)
    state, read, asked = np.zeros(2), np.zeros((2, len(path))), np.zeros((2, len(path) + whole + 1))

    def reading(i: int, k: int) -> float:
        return float(read[i, k]) if k >= 0 else 0.0

    for k, x in enumerate(path):
        read[here, k], read[1 - here, k] = x, state[0]
        asked[:, k + whole + 1] = [asked_of(pair, i, k, reading) for i in (0, 1)]
        for flow, force in ((early, asked[1 - here, k]), (rest, asked[1 - here, k + 1])):
            state = (flow @ np.array([*state, force]))[:2]
    return asked[here, whole + 1 :]


@seeds(12)
def test_the_law_that_is_felt_is_that_of_both_arms_run(seed: int) -> None:
    """H(z) from the definition of each side, arm and hand by the matrix exponential."""
    question = random_question(seed)
    path = np.random.default_rng(seed).normal(size=80)
    law, _ = felt(question, question.motion)
    top, bottom = ([float(c) for c in part] for part in law)
    forces: list[float] = []
    for k in range(len(path)):
        value = sum(c * path[k - i] for i, c in enumerate(top) if k >= i)
        value -= sum(c * forces[k - i] for i, c in enumerate(bottom) if 0 < i <= k)
        forces.append(value / bottom[0])
    run = forces_of_the_free_arm(question, path)
    np.testing.assert_allclose(forces, run, rtol=0, atol=1e-8 * np.abs(run).max())


@seeds(6)
def test_a_certificate_up_to_the_limit_and_a_violation_beyond(seed: int) -> None:
    question = random_question(seed)
    verdict = zw.check(question.pair, **{question.held: question.hand})
    need = verdict.required_damping
    assert need
    for times, outcome in ((1 - 1e-5, "active"), (1 + 1e-5, "passive")):
        changed = question.with_damping(question.free, Fraction(need * times))
        found = zw.check(changed.pair, **{question.held: question.hand})
        assert found.outcome == outcome
        evidence = found.violation if outcome == "active" else found.certificate
        assert zw.verify(evidence.to_dict()).valid


def test_nobody_and_a_hand_on_either_arm() -> None:
    assert zw.check(UNKNOWN.replace(stiffness=60), follower=None).passive  # where two hands allow it
    stiff = PAIR.replace(stiffness="100.5")
    assert zw.check(stiff).outcome == "active"
    nobody, held = zw.check(stiff, follower=None), zw.check(stiff, follower=HAND)
    assert (nobody.outcome, held.outcome) == ("passive", "passive")
    assert "while nobody holds the follower" in nobody.claim
    assert "beside a damper of 2 N·s/m or more" in held.claim
    assert held.largest_stiffness_of_two_hands == pytest.approx(100)
    assert 200 < held.largest_stiffness_of_any_such_hand < held.largest_stiffness < 300
    for times, outcome in ((0.9999, "passive"), (1.0001, "active")):
        asked = PAIR.replace(stiffness=held.largest_stiffness * times)
        assert zw.check(asked, follower=HAND).outcome == outcome
        assert zw.check(asked, leader=HAND).outcome == outcome  # equal arms


def test_the_hand_may_be_anything_that_damps_as_much() -> None:
    rubbed = PAIR.replace(follower=ARM.replace(coulomb_friction=1), stiffness=200)
    found = zw.check(rubbed, follower=Hand(damping=2))
    assert found.passive
    assert found.with_any_such_hand
    assert found.scope.hands.every
    more = rubbed.replace(follower=rubbed.follower.replace(damping="2.3"))
    assert found.certificate.to_dict() == zw.check(more).certificate.to_dict()


def test_friction_of_the_held_arm_is_not_left_out() -> None:
    """Between the limit of any such hand and that of the linear law nothing is said; beyond it there is a
    motion, whatever friction there is.
    """
    rubbed = PAIR.replace(follower=ARM.replace(coulomb_friction="0.01"))
    near, found = (zw.check(rubbed.replace(stiffness=k), follower=HAND) for k in (248, 260))
    assert (near.outcome, found.outcome) == ("undecided", "active")
    assert "Coulomb friction of the follower" in near.limit
    assert found.largest_stiffness == pytest.approx(found.largest_stiffness_of_any_such_hand)


def test_friction_of_the_free_arm_covers_both_encoders() -> None:
    counted = ARM.replace(resolution="10 um")
    pair = zw.Pair(counted.replace(coulomb_friction=1), counted, stiffness=250, delay="2 ms")
    found = zw.check(pair, follower=HAND)
    assert found.passive
    assert found.scope.encoder == "counted"
    need = found.required_friction
    assert need > 250 * 10e-6
    for times, outcome in ((1 + 1e-6, "passive"), (1 - 1e-6, "undecided")):
        leader = counted.replace(coulomb_friction=need * times)
        assert zw.check(pair.replace(leader=leader), follower=HAND).outcome == outcome


def test_a_hand_within_intervals() -> None:
    between = Hand(mass=(0, "5 g"), stiffness=(90, 100), damping=("1.9", 2))
    passive, active = (zw.check(PAIR.replace(stiffness=k), follower=between) for k in (248, 300))
    assert passive.passive
    assert not passive.with_any_such_hand
    assert zw.verify(passive.certificate.to_dict()).valid
    assert "one of these hands" in active.claim
    assert active.violation.motion.is_certain


@pytest.mark.parametrize(
    ("change", "phrase"),
    [
        ({"drive_rate": "10 kHz"}, "reads itself more often"),
        ({"compensation": zw.FrictionCompensation(coulomb=1, speed=1)}, "friction is compensated"),
    ],
)
def test_what_is_no_linear_law_is_decided_by_two_hands_alone(change: dict, phrase: str) -> None:
    """Proved where they gain nothing; never said to be active for the law that would be felt without."""
    pair = PAIR.replace(leader=ARM.replace(coulomb_friction=2), stiffness=5000, **change)
    found = zw.check(pair, follower=HAND)
    assert found.outcome == "undecided"
    assert phrase in found.limit


def test_the_law_that_is_felt_is_one_for_every_tool() -> None:
    """On both sides of the limit the verdict of one arm is that of the pair; at rest nobody pulls."""
    for stiffness, outcome in ((100.5, "passive"), (102, "active")):
        pair = PAIR.replace(stiffness=stiffness)
        law = felt_law(pair, follower=None)
        assert zw.check(pair.leader, law).outcome == zw.check(pair, follower=None).outcome == outcome
        top, bottom = law.pulse_transfer_function(Fraction(1, 1000))
        assert sum(top) == 0 < sum(bottom)
    with pytest.raises(zw.InputError, match="single numbers"):
        felt_law(PAIR, follower=Hand(mass=(0, 1)))
    with pytest.raises(zw.InputError, match="without drives"):
        felt_law(PAIR.replace(drive_rate="10 kHz"), follower=None)


UNKNOWN = zw.Pair(ARM, ARM.replace(mass=None), stiffness=150, delay="2 ms")


@pytest.mark.parametrize(
    ("pair", "arguments", "phrase"),
    [
        (PAIR, {"leader": None, "follower": HAND}, "nobody is left who could take energy out"),
        (PAIR, {"follower": zw.Wall(100)}, "a known hand is None, a HandImpedance"),
        (PAIR, {"follower": zw.operators.Guide()}, "prescribed motion"),
        (PAIR, {"hand": HAND}, "check\\(pair, follower=hand\\)"),
        (UNKNOWN, {"follower": None}, "depends on its mass"),
    ],
)
def test_bad_input(pair: zw.Pair, arguments: dict, phrase: str) -> None:
    with pytest.raises(zw.InputError, match=phrase):
        zw.check(pair, **arguments)


def test_the_verdict_as_data_and_as_text() -> None:
    found = zw.check(PAIR.replace(stiffness=248), follower=HAND)
    told = found.to_dict()
    assert told["format"] == "zwidth held pair 1"
    assert told["certificate"]["kind"] == "held pair"
    assert told["held"] == {"arm": "follower", "hand": "m_h = 0.05 kg, k = 100 N/m, c = 2 N·s/m"}
    assert told["largest_stiffness_N_per_m"] > told["largest_stiffness_N_per_m_with_any_such_hand"]
    said = "\n".join(found.assumptions)
    for phrase in ("both arms start at rest", "no Coulomb friction in the follower", "just those given"):
        assert phrase in said
    assert dict(found.rows())["on the follower"] == told["held"]["hand"]


@pytest.mark.parametrize(("stiffness", "gains"), [(250, False), (300, True)])
def test_in_the_simulator_the_wave_gains_beyond_the_limit_alone(stiffness: int, gains: bool) -> None:
    pair = zw.Pair(ARM.replace(coulomb_friction="0.05"), ARM, stiffness=300, delay="2 ms")
    wave = zw.check(pair, follower=HAND).witness
    assert wave.verify()
    held = zw.operators.Finger(mass=0.05, stiffness=100, damping=2, force=0, start=0)
    hand = zw.operators.PrescribedMotion(wave.positions)
    trace = zw.simulate(pair.replace(stiffness=stiffness), hand, held, wave.duration)
    work = trace.sel(arm="leader")["hand_work"].values
    assert bool(work.min() < work[0]) is gains
    if gains:
        assert work[0] - work[-1] == pytest.approx(wave.energy, rel=1e-4)


def test_a_wave_is_found_close_to_the_limit() -> None:
    """Half a per cent beyond it, against Coulomb friction of the free arm; none where there are steps."""
    pair = zw.Pair(ARM.replace(coulomb_friction="0.05"), ARM, stiffness=252, delay="2 ms")
    found = zw.check(pair, follower=HAND)
    assert found.outcome == "active"
    assert found.witness.energy > 0
    assert found.to_dict()["witness"]["kind"] == "held pair motion"
    counted = zw.check(pair.replace(leader=pair.leader.replace(resolution="1 um")), follower=HAND)
    assert (counted.outcome, counted.witness) == ("active", None)
