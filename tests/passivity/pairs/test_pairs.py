"""Two arms that follow each other: the criterion by other roads, both sides of limits, motions in time."""

from __future__ import annotations

import re
from dataclasses import replace
from fractions import Fraction
from itertools import pairwise, product
from typing import Any

import numpy as np
import pytest
from asked_forces import age_of, asked_of
from flint import fmpz_poly
from strategies import seeds

import zwidth as zw
from zwidth.checker.pair.coupling import sides_of
from zwidth.checker.pair.passive import PAIR_PROOF, criterion
from zwidth.passivity.linear.boundary import largest_holding
from zwidth.passivity.linear.positivity import Positivity, prove_nonnegative
from zwidth.passivity.pairs import PairCriterion, largest_spring
from zwidth.passivity.pairs.evidence import MOST, energy_in_time, energy_of, pair_document
from zwidth.passivity.witness.motion import Motion, Repeat

BILLIONTH = Fraction(1, 10**9)
PADDLE = zw.Device(damping="0.5", coulomb_friction="0.1", resolution=0, delay=0, rate="1 kHz")


def random_pair(seed: int, parts=True, counted=False, drives=False, reflected=False) -> zw.Pair:
    """Any two arms of 1 kHz, K = 1 N/m; with forces that are sent, if so wanted."""
    random = np.random.default_rng(seed)

    def arm() -> zw.Device:
        delay = int(random.integers(0, 3)) + (random.choice([0, 0, 0.25, 0.7]) if parts else 0)
        delay = 0 if drives else delay
        return zw.Device(
            damping=f"{random.uniform(0.1, 2):.3f}",
            coulomb_friction=f"{random.uniform(0.1, 1):.3f}",
            resolution=f"{random.uniform(0.001, 0.1):.4f}" if counted else 0,
            rate="1 kHz",
            delay=f"{delay / 1000:.5f}",
        )

    pair = zw.Pair(
        arm(),
        arm(),
        stiffness=1,
        damping=f"{random.choice([0, 0, 0.05, 0.1, -0.02]):.3f}",
        local_damping=f"{random.choice([0, 0, 0.05]):.3f}",
        follower_stiffness=f"{random.choice([1, 1, 0.5, 1.6]):.2f}",
        delay=tuple(f"{random.uniform(0, 0.003):.4f}" for _ in (0, 1)),
        drive_rate=1000 * int(random.integers(2, 6)) if drives is True else None,
    )
    if drives == "unequal":
        quick = {str(random.choice(["leader", "follower"])): int(random.integers(2, 6))}
        pair = pair.replace(**{n: getattr(pair, n).replace(rate=1000 * m) for n, m in quick.items()})
    if not reflected:
        return pair
    return pair.replace(
        stiffness=f"{random.choice([0, 0, 0.5]):.1f}",
        reflection=f"{random.choice([1, 0.4]):.1f}",
        follower_reflection=f"{random.choice([0, 0, 0.3]):.1f}",
    )


def limit_of(pair: zw.Pair) -> Fraction | None:
    """The largest stiffness that the criterion allows, to the last double."""
    found = largest_holding(lambda k: not k or PairCriterion(pair.stiffened(k)).holds, 1.0)
    exact = Fraction(repr(found)) if found else None
    return exact if exact and PairCriterion(pair.stiffened(exact / 2)).holds else None


def acting(pair: zw.Pair, i: int, moves: int, *given: Any) -> list:
    """What is held from tick to tick, after the whole samples of the delay."""
    forces = [asked_of(pair, i, k, *given) for k in range(moves)]
    return [0 * forces[0]] * (int(pair.sides[i].delay // pair.sample_period) + 1) + forces


def part_of(side: Any, pair: zw.Pair) -> float:
    """What its delay is beyond whole samples, in samples."""
    return float(side.delay / pair.sample_period % 1)


def form_of_work(pair: zw.Pair, samples: int, younger: np.random.Generator | None = None) -> np.ndarray:
    """What two hands give over so many samples, as a matrix in the moves of each part of each reading.

    Held forces and viscous friction.  With `younger` each reading that is received is as old as said or
    less, at random.
    """
    step, moves = float(pair.sample_period) / pair.own_readings, samples * pair.own_readings
    size = 4 * moves
    unit = np.eye(size).reshape(moves, 2, 2, size)  # of each reading and arm the early and the late move
    x = np.concatenate((np.zeros((1, 2, size)), np.cumsum(unit.sum(axis=2), axis=0)))
    ages: dict[tuple[int, int], int] = {}

    def age(i: int, j: int) -> int:
        most = age_of(pair, i)
        return most if younger is None else ages.setdefault((i, j), int(younger.integers(0, most + 1)))

    total = np.zeros((size, size))
    for i, side in enumerate(pair.sides):
        weight, part = 1.0 if i == 0 else float(pair.power_ratio), part_of(side, pair)
        forces = acting(pair, i, moves, lambda i, k: x[max(k, 0), i], age)
        for k in range(moves):
            for n, length in enumerate((part, 1 - part)):
                move = unit[k, i, n]
                paid = float(side.damping) / (length * step) if length else 1e9
                total += weight * np.outer(move, forces[k + n] + paid * move)
    return (total + total.T) / 2


KINDS = list(product([False, True, "unequal"], [False, True]))
of_each_kind = pytest.mark.parametrize(("drives", "reflected"), KINDS)


@of_each_kind
@pytest.mark.parametrize("seed", range(6))
def test_short_motions_against_the_limit(seed, drives, reflected):
    """The form of them all, made from the definitions, is nowhere negative just below, and is well above."""
    pair = random_pair(seed, drives=drives, reflected=reflected)
    limit = limit_of(pair)
    if limit is None:
        return
    samples = 12 if drives else 30
    values = np.linalg.eigvalsh(form_of_work(pair.stiffened(limit * Fraction("0.999")), samples))
    assert values[0] >= -1e-9 * values[len(values) // 2]
    assert np.linalg.eigvalsh(form_of_work(pair.stiffened(limit * 2), samples))[0] < 0


@of_each_kind
@seeds(3)
def test_younger_readings_change_nothing_for_springs_alone(seed, drives, reflected):
    random = np.random.default_rng(seed)
    pair = random_pair(seed, parts=False, drives=drives, reflected=reflected)
    delay = tuple(Fraction(int(n), 1000) for n in random.integers(0, 6, 2))
    pair = pair.replace(damping=0, local_damping=0, delay=delay)
    below = pair.stiffened(limit_of(pair) * Fraction("0.999"))
    verdict = zw.check(below.replace(leader=rubbed(below.leader), follower=rubbed(below.follower)))
    assert any("or any younger one" in text for text in verdict.assumptions)
    assert "younger" in zw.verify(verdict.certificate.to_dict()).reason
    for _ in range(2):
        values = np.linalg.eigvalsh(form_of_work(below, 8 if drives else 20, random))
        assert values[0] >= -1e-9 * values[len(values) // 2]


def rubbed(device: zw.Device) -> zw.Device:
    """With friction for any encoder."""
    return device.replace(coulomb_friction=10)


def test_a_damper_asks_for_readings_as_old_as_said():
    """With B two readings of other ages jump: nothing is said of younger ones."""
    verdict = zw.check(zw.Pair(PADDLE, PADDLE, stiffness=50, damping="0.05", delay="2 ms"))
    assert verdict.passive
    assert any("none comes later or sooner" in text for text in verdict.assumptions)
    assert "younger" not in zw.verify(verdict.certificate.to_dict()).reason


@seeds(10)
def test_a_round_takes_what_the_form_says(seed):
    """Σ over a round of any motion by the checker = the sum of Δxᴴ M Δx over its harmonics."""
    pair = random_pair(seed, parts=False)
    smooth = {"coulomb_friction": 0, "stiction": None}
    bare = pair.replace(leader=pair.leader.replace(**smooth), follower=pair.follower.replace(**smooth))
    random, q = np.random.default_rng(seed), 7
    paths = [[0, *(int(v) for v in random.integers(-9, 9, q - 1)), 0] for _ in (0, 1)]

    def energy_out(rounds: int) -> Fraction:
        return energy_of(bare, *(Motion(tuple(map(Fraction, path[:-1] * rounds + [0]))) for path in paths))

    moved = np.array([np.fft.fft(np.diff(path)) for path in paths]) / q
    found = sum(
        (moved[:, k].conj() @ PairCriterion(bare).at(2 * np.pi * k / q) @ moved[:, k]).real
        for k in range(1, q)
    )
    assert float(energy_out(6) - energy_out(5)) == pytest.approx(-found * q * 1000, rel=1e-9)


def taken(pair: zw.Pair, motions: list[Motion]) -> float:
    """Energy out of a motion, every reading listed, from the definitions."""
    step, total = float(pair.sample_period) / pair.own_readings, 0.0
    counts = [side.resolution for side in pair.sides]
    read = [
        [float(count * (x // count) if count else x) for x in motion.positions]
        for count, motion in zip(counts, motions, strict=True)
    ]
    for i, (side, motion) in enumerate(zip(pair.sides, motions, strict=True)):
        weight, part = 1.0 if i == 0 else float(pair.power_ratio), part_of(side, pair)
        path = [float(x) for x in motion.positions]
        turns = [float(x) for x in motion.switch_positions] or path
        reading = lambda i, k: read[i][max(k, 0)]  # noqa: E731
        forces = acting(pair, i, len(path) - 1, reading)
        for k, (x, z) in enumerate(pairwise(path)):
            for held, move, length in (
                (forces[k], turns[k] - x, part),
                (forces[k + 1], z - turns[k], 1 - part),
            ):
                rubbed = float(side.damping) / (length * step) * move**2 if length else 0.0
                total -= weight * (held * move + rubbed + float(side.coulomb_friction) * abs(move))
    return total


@of_each_kind
@seeds(15)
def test_energy_of_any_motion_by_the_definitions(drives, reflected, seed):
    pair = random_pair(seed, drives=drives, reflected=reflected, counted=True)
    random, often, motions = np.random.default_rng(seed), pair.own_readings, []
    for arm in PairCriterion(pair).arms:
        count = arm.side.resolution
        x = [Fraction(0), *(Fraction(int(v), 7) * count for v in random.integers(-40, 40, 6 * often))]
        x[4 * often] = x[2 * often] + count * int(random.integers(-3, 4))  # whole counts on in each round
        y = tuple(v + count * Fraction(int(random.integers(-9, 9)), 5) for v in x[:-1]) if arm.part else ()
        motions.append(Motion(tuple(x), y, (Repeat(2 * often, 4 * often, 40),)))
    by_definition = taken(pair, [motion.listed() for motion in motions])
    assert float(energy_of(pair, *motions)) == pytest.approx(by_definition, rel=1e-9)


@of_each_kind
@seeds(12)
def test_prover_and_checker_have_one_criterion(drives, reflected, seed):
    """Made by other steps: the checker's is that of the prover times 2 − 2c, and its square."""
    pair = random_pair(seed, drives=drives, reflected=reflected)
    told = PAIR_PROOF.fields["loop"].read(pair_document(pair), "", "linear")
    factor = fmpz_poly([2, -2])
    theirs = criterion(told, sides_of(told))
    if PairCriterion(pair).slips:
        assert theirs is None
        return
    for mine, its, times in zip(PairCriterion(pair).polynomials, theirs, (1, 1, 2), strict=True):
        a, b = mine * factor**times, fmpz_poly(list(its))
        assert a * b[b.degree()] == b * a[a.degree()]
        assert a.degree() == b.degree()
        assert a[a.degree()] * b[b.degree()] > 0


@of_each_kind
@seeds(8)
def test_both_sides_of_the_limit(drives, reflected, seed):
    pair = random_pair(seed, drives=drives, reflected=reflected)
    limit = limit_of(pair)
    if limit is not None:
        below = zw.check(pair.stiffened(limit * (1 - BILLIONTH)))
        assert below.outcome == "passive"
        assert below.certificate.verify()
    above = zw.check(pair.stiffened(limit * (1 + BILLIONTH) if limit else Fraction(1)))
    assert above.outcome == "active"
    assert above.violation.verify()
    assert above.witness.verify()
    assert above.witness.energy > 0


@seeds(12)
def test_both_sides_of_friction(seed):
    pair = random_pair(seed, counted=True)
    limit = limit_of(pair)
    if limit is None:
        return
    pair = pair.stiffened(limit / 2)
    needed = zw.check(pair).required_friction

    def rubbed(leader: Fraction, follower: Fraction) -> zw.Pair:
        arms = zip(("leader", "follower"), (leader, follower), strict=True)
        return pair.replace(**{n: getattr(pair, n).replace(coulomb_friction=f) for n, f in arms})

    first, second = (Fraction(repr(f)) for f in needed)
    assert zw.check(rubbed(first * (1 + BILLIONTH), second * (1 + BILLIONTH))).outcome == "passive"
    for less in ((first * (1 - BILLIONTH), second * 2), (first * 2, second * (1 - BILLIONTH))):
        verdict = zw.check(rubbed(*less))
        assert verdict.outcome != "passive"
        if pair.damping >= 0:
            assert verdict.outcome == "active"
            assert verdict.witness.verify()


def test_springs_have_a_closed_form():
    """(b_l − (2d_l + 1) KT/2)(w b_f − (2d_f + 1) KT/2) = (N KT/2)², and without delay 1/b + 1/b' = 2/(KT)."""
    plain = zw.Pair(PADDLE, PADDLE.replace(damping="0.25"), stiffness=1)
    assert largest_spring(plain) == pytest.approx(2 / 0.001 / (1 / 0.5 + 1 / 0.25), rel=1e-15)
    for seed in range(40):
        pair = random_pair(seed, parts=False).replace(damping=0, local_damping=0)
        assert float(largest_spring(pair)) == pytest.approx(float(limit_of(pair)), rel=1e-14)


@pytest.mark.parametrize("reflected", [False, True])
@seeds(20)
def test_springs_are_decided_at_rest_as_by_every_frequency(reflected, seed):
    pair = random_pair(seed, reflected=reflected)
    pair = pair.replace(damping=zw.Exact(0), local_damping=zw.Exact(0))
    limit = limit_of(pair)
    near = [] if limit is None else [pair.stiffened(limit * (1 + n * BILLIONTH)) for n in (-1, 0, 1)]
    for one in (pair, *near):
        criterion = PairCriterion(one)
        assert criterion.of_springs
        assert criterion.holds == (not isinstance(criterion.signs, Fraction))
        proofs = [prove_nonnegative(p) for p in criterion.polynomials]
        assert criterion.holds == all(isinstance(proof, Positivity) for proof in proofs)


@pytest.mark.parametrize(
    "change",
    [
        *({"stiffness": zw.Exact(k)} for k in (2, -2, 0)),
        *({"delay": (zw.Exact("0.001"), zw.Exact(back))} for back in ("0.4", "-0.4")),
        *({"follower_damping": zw.Exact("-0.02")}, {"delay": (0, "401 ms")}, {"drive_rate": zw.Exact(1500)}),
        *(
            {"follower": PADDLE.replace(**numbers)}
            for numbers in ({"rate": "3.5 kHz"}, {"coulomb_friction": 0.2})
        ),
        {"leader": PADDLE.replace(damping=(1, 2))},
    ],
)
def test_what_is_changed_alone_is_read_as_if_all_were_given(change):
    pair = zw.Pair(PADDLE, PADDLE, stiffness=1, delay="1 ms")
    given = {"leader": PADDLE, "follower": PADDLE, "stiffness": 1, "delay": "1 ms", **change}
    try:
        wanted = zw.Pair(**given)
    except zw.InputError as refused:
        with pytest.raises(zw.InputError, match=f"^{re.escape(str(refused))}$"):
            pair.replace(**change)
        return
    changed = pair.replace(**change)
    assert changed == wanted
    assert (changed.sides, changed.readings) == (wanted.sides, wanted.readings)


@pytest.mark.parametrize("ages", [(0, 0), (1, 0), (2, 3)])
@pytest.mark.parametrize("shares", [(1, 0), ("0.5", 0), (1, "0.5")])
def test_springs_whose_force_is_sent(ages, shares):
    """(b_l − κ Σ (2 lag + 1) K)(w b_f − …) ≥ (N S κ)²: what comes back is as old as there and back."""
    ratio, n = Fraction(shares[0]), sum(ages) + 1
    back = Fraction(shares[1])
    numbers = {"follower_stiffness": 1, "reflection": ratio, "follower_reflection": back}
    delay = tuple(Fraction(age, 1000) for age in ages)
    pair = zw.Pair(PADDLE, PADDLE.replace(damping="0.8"), stiffness=0, delay=delay, **numbers)
    found = limit_of(pair)
    weight = pair.power_ratio
    assert weight == ratio, "the leader's spring is that which is sent to it"
    kappa = found / 2000 / ratio  # K_f T/2
    leader = Fraction(1, 2) - kappa * ratio * (2 * n - 1)
    follower = weight * (Fraction(4, 5) - kappa)
    assert float(leader * follower) == pytest.approx(float(n * ratio * kappa) ** 2, rel=1e-9)
    if ages == (0, 0):  # without any delay it is the same as positions sent
        sent = pair.replace(stiffness=ratio, reflection=0, follower_reflection=0)
        assert found == pytest.approx(limit_of(sent))


def test_a_spring_inside_the_drive_needs_less():
    """20 kHz beside 200 Hz: b ≥ KT/2 (N + 1/100) for equal arms, where N + 1 was asked for."""
    arm = zw.Device(damping=1, coulomb_friction="0.1", resolution=0, delay=0, rate="200 Hz")
    for age, gained in ((0, 2 / 1.01), (1, 4 / 3.01), (2, 6 / 5.01)):
        slow = zw.Pair(arm, arm, stiffness=1, delay=Fraction(age, 200))
        fast = slow.replace(drive_rate="20 kHz")
        limit = limit_of(fast)
        assert float(limit / limit_of(slow)) == pytest.approx(gained, rel=1e-12)
        assert zw.check(fast.stiffened(limit * Fraction("0.99"))).outcome == "passive"
        above = zw.check(fast.stiffened(limit * Fraction("1.01")))
        assert above.outcome == "active"
        assert above.witness.verify()


def test_a_drive_that_reads_a_thousand_times_has_a_proof_of_few_digits():
    arm = PADDLE.replace(damping="0.52234567891234", rate=20)
    springs = {"stiffness": "4.123456789", "damping": "0.123456789"}
    pair = zw.Pair(arm, arm, **springs, delay="20 ms", drive_rate="20 kHz")
    verdict = zw.check(pair)
    assert verdict.passive
    criterion = PairCriterion(pair)
    for arm_, (beta, gamma) in zip(criterion.arms, verdict.certificate.losses, strict=True):
        whole, part = arm_.inside
        assert 0 < beta < whole
        assert whole - beta >= abs(part - gamma)
        assert len(str(beta)) < 9


@pytest.mark.parametrize("damping", ["0.999", "1.001"])
def test_a_drive_that_gains_by_itself(damping):
    """b < K T/2m + |B + D|: to and fro from reading to reading of one's own, the other arm at rest."""
    arm = zw.Device(damping=1, coulomb_friction="0.1", resolution=0, delay=0, rate="200 Hz")
    pair = zw.Pair(arm, arm, stiffness="0.1", local_damping=damping, drive_rate="800 Hz")
    assert PairCriterion(pair).slips is (damping == "1.001")
    if damping == "1.001":
        verdict = zw.check(pair)
        assert verdict.outcome == "active"
        assert verdict.violation.verify()
        assert verdict.violation.cosine is verdict.violation.frequency is None
        assert "the drive of an arm alone" in verdict.violation.describe()
        assert "proof" not in verdict.violation.to_dict()
        assert verdict.witness.verify()


def test_what_is_held_for_how_long():
    arm = zw.Device(damping=1, coulomb_friction="0.1", resolution=0, delay=0, rate="200 Hz")
    pair = zw.Pair(arm, arm, stiffness="0.1")
    assert "each force is held for a period" in " ".join(zw.check(pair).assumptions)
    inside = " ".join(zw.check(pair.replace(drive_rate="800 Hz")).assumptions)
    assert "each drive reads its own arm 4 times in it" in inside
    assert "each force is held" not in inside


def test_steps_of_encoders_that_a_drive_reads():
    """Own counts weigh with the drive's rate, the other's with that of the references."""
    arm = zw.Device(damping=1, coulomb_friction=1, resolution="1e-3", delay=0, rate="200 Hz")
    pair = zw.Pair(arm, arm, stiffness=10, delay="5 ms", drive_rate="20 kHz")
    verdict = zw.check(pair)
    assert verdict.outcome == "passive"
    assert verdict.required_friction == (0.01, 0.01)
    rough = arm.replace(coulomb_friction="0.00999")
    less = zw.check(pair.replace(leader=rough))
    assert less.outcome == "active"
    assert less.witness.verify()
    damped = zw.check(pair.replace(local_damping="0.01"))
    assert damped.required_friction[0] == pytest.approx(0.01 + 0.01 * 20_000 * 1e-3)


@pytest.mark.parametrize(("b", "f"), [(1, 1), (0.5, 2), (0.1, 3)])
def test_as_the_period_vanishes_it_is_the_condition_of_delayed_springs(b, f):
    """T → 0: 4 b_l b_f ≥ K² (there + back)²; for equal arms b ≥ K (there + back)/2 (Lee & Spong 2006)."""
    there, back, rate = 0.02, 0.03, 80_000
    arms = [zw.Device(damping=v, coulomb_friction=0, resolution=0, delay=0, rate=rate) for v in (b, f)]
    coarse = [arm.replace(rate=4_000) for arm in arms]
    limit = 2 * np.sqrt(b * f) / (there + back)
    near, far = (
        float(largest_spring(zw.Pair(*pair, stiffness=1, delay=(there, back))))
        for pair in (coarse, [arm.replace(rate=8_000) for arm in arms])
    )
    assert near < far < limit
    assert far == pytest.approx(limit, rel=2e-2)
    assert 2 * far - near == pytest.approx(limit, rel=1e-3)  # what is left goes with T


def test_a_reading_is_used_at_the_next_sample():
    late, later = (zw.Pair(PADDLE, PADDLE, stiffness=1, delay=d) for d in ("1.2 ms", "2 ms"))
    assert largest_spring(late) == largest_spring(later)


def test_unequal_springs_are_equal_ones_of_a_heavier_follower():
    """K_f = K_l/w counts the follower's work w times: as if its friction were w times as much."""
    pair = zw.Pair(PADDLE, PADDLE, stiffness=100, follower_stiffness=25, delay="2 ms")
    equal = zw.Pair(PADDLE, PADDLE.replace(damping=2), stiffness=100, delay="2 ms")
    assert pair.power_ratio == 4
    assert PairCriterion(pair).polynomials == PairCriterion(equal).polynomials
    assert "counts 4 times" in " ".join(zw.check(pair).assumptions)


@pytest.mark.parametrize("age", [0, 1, 2, 5])
@pytest.mark.parametrize("damping", [0, "0.05", "0.1", "0.2", "0.24"])
def test_damping_of_the_coupling_helps_and_then_hurts(age, damping):
    """Equal arms: K (n + 1) T ≤ b + 2B by slow motions, K T ≤ b − 2B by those of every other sample.

    So with a late link some B raises the limit, and from b/2 on nothing is passive at this rate.
    """
    pair = zw.Pair(PADDLE, PADDLE, stiffness=1, damping=damping, delay=f"{age} ms")
    slow, fast = (0.5 + 2 * float(damping)) / (0.001 * (age + 1)), (0.5 - 2 * float(damping)) / 0.001
    assert float(limit_of(pair)) == pytest.approx(min(slow, fast), rel=1e-12)
    assert limit_of(pair.replace(damping="0.2501")) is None


def test_an_arm_without_damping_is_active():
    free = PADDLE.replace(damping=0)
    for device in (free, free.replace(delay="0.3 ms")):
        verdict = zw.check(zw.Pair(device, PADDLE, stiffness=10))
        assert verdict.outcome == "active"
        assert verdict.largest_stiffness is None
        assert verdict.required_damping[0] > 0


def test_a_verdict_tells_what_is_needed():
    verdict = zw.check(zw.Pair(PADDLE, PADDLE, stiffness=300, delay="1 ms"))
    assert verdict.outcome == "active"
    assert verdict.margin == pytest.approx(1 - 300 / 250, abs=1e-5)
    assert verdict.required_damping[0] == verdict.required_damping[1] > 0.5
    enough = PADDLE.replace(damping=verdict.required_damping[0] * 1.0001)
    assert zw.check(zw.Pair(enough, PADDLE, stiffness=300, delay="1 ms")).outcome == "passive"
    document = verdict.to_dict()
    assert document["largest_stiffness_N_per_m"] == pytest.approx(250, rel=1e-6)
    assert zw.verify(document["violation"]).valid
    assert zw.verify(document["witness"]).valid


@pytest.mark.parametrize(
    ("change", "message"),
    [
        ({"stiffness": 0}, "the leader feels no spring"),
        ({"stiffness": "3 N*m/rad"}, "stiffness"),
        ({"follower_stiffness": -1}, "follower_stiffness must be ≥ 0"),
        ({"follower_stiffness": 0}, "the follower feels no spring"),
        ({"reflection": -1}, "reflection must be ≥ 0"),
        ({"delay": (-1, 0)}, "delay there must be ≥ 0"),
        ({"delay": 1}, "at most 400"),
        ({"delay": "soon"}, "delay there"),
        ({"drive_rate": 1500}, "whole times the 1 kHz"),
        ({"drive_rate": "20 kHz", "leader": PADDLE.replace(delay="1 ms")}, "without delay"),
        ({"leader": 3}, "leader is a Device, got int"),
        ({"follower": PADDLE.replace(rate="600 Hz")}, "1 kHz and 600 Hz"),
        ({"follower": PADDLE.replace(motion="rotary")}, "linear leader and a rotary follower"),
        ({"follower": PADDLE.replace(damping=(0.1, 0.2))}, "follower: damping has no single value"),
    ],
)
def test_bad_input_is_told(change, message):
    with pytest.raises(zw.InputError, match=message):
        zw.Pair(**{"leader": PADDLE, "follower": PADDLE, "stiffness": 10, **change})


def test_a_pair_stands_alone():
    pair = zw.Pair(PADDLE, PADDLE, stiffness=10)
    with pytest.raises(zw.InputError, match="holds its coupling in itself"):
        zw.check(pair, zw.Wall(10))
    with pytest.raises(zw.InputError, match="the environment is missing"):
        zw.check(PADDLE)


COUNTED = PADDLE.replace(resolution="1e-4")
SLOW = zw.Pair(COUNTED, COUNTED, stiffness=300, delay="4 ms")


@pytest.mark.parametrize(
    "pair",
    [
        SLOW,
        zw.Pair(PADDLE.replace(delay="0.4 ms"), COUNTED, stiffness=300, delay="2 ms"),
        zw.Pair(COUNTED, COUNTED, stiffness=90, damping="0.3", delay="2 ms"),
        zw.Pair(COUNTED.replace(coulomb_friction="0.004"), COUNTED, stiffness=50, delay="2 ms"),
        zw.Pair(COUNTED, COUNTED, stiffness=300, local_damping="0.6", delay="1 ms", drive_rate="3 kHz"),
    ],
)
def test_every_beginning_is_a_motion_of_its_own(pair):
    witness = zw.check(pair).witness
    times, energies = energy_in_time(witness)
    listed = [motion.listed() for motion in (witness.leader, witness.follower)]
    step = pair.sample_period / pair.own_readings
    assert len(times) > 3
    assert times[-1] == witness.samples * step
    assert energies[-1] == witness.exact_energy
    for time, energy in list(zip(times, energies, strict=True))[1:]:
        last = int(time / step)
        parts = [
            replace(m, positions=m.positions[: last + 1], switch_positions=m.switch_positions[:last])
            for m in listed
        ]
        assert energy_of(pair, *parts) == energy


def test_of_many_rounds_some_are_told():
    witness = zw.check(SLOW).witness
    many = replace(witness, leader=witness.leader.repeated(10**6), follower=witness.follower.repeated(10**6))
    times, energies = energy_in_time(many)
    assert len(times) == len(energies) == 1 + 2 * (1 + MOST)
    assert times == sorted(set(times))
    assert times[-1] == Fraction(2 + 2 * 10**6, 1000)
