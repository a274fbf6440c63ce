"""Two arms that follow each other: the criterion by other roads, both sides of every limit."""

from __future__ import annotations

from fractions import Fraction

import numpy as np
import pytest
from flint import fmpz_poly
from strategies import seeds

import zwidth as zw
from zwidth.checker.pair.coupling import sides_of
from zwidth.checker.pair.passive import PAIR_PROOF, criterion
from zwidth.passivity.linear.boundary import largest_holding
from zwidth.passivity.pairs import PairCriterion, largest_spring
from zwidth.passivity.pairs.evidence import energy_of, pair_document
from zwidth.passivity.witness.motion import Motion

BILLIONTH = Fraction(1, 10**9)
PADDLE = zw.Device(damping="0.5", coulomb_friction="0.1", resolution=0, delay=0, rate="1 kHz")


def random_pair(seed: int, parts: bool = True, counted: bool = False) -> zw.Pair:
    """Any two arms of 1 kHz, K = 1 N/m."""
    random = np.random.default_rng(seed)

    def arm() -> zw.Device:
        delay = int(random.integers(0, 3)) + (random.choice([0, 0, 0.25, 0.7]) if parts else 0)
        return zw.Device(
            damping=f"{random.uniform(0.1, 2):.3f}",
            coulomb_friction=f"{random.uniform(0.1, 1):.3f}",
            resolution=f"{random.uniform(0.001, 0.1):.4f}" if counted else 0,
            rate="1 kHz",
            delay=f"{delay / 1000:.5f}",
        )

    return zw.Pair(
        arm(),
        arm(),
        stiffness=1,
        damping=f"{random.choice([0, 0, 0.05, 0.1, -0.02]):.3f}",
        local_damping=f"{random.choice([0, 0, 0.05]):.3f}",
        follower_stiffness=f"{random.choice([1, 1, 0.5, 1.6]):.2f}",
        delay=tuple(f"{random.uniform(0, 0.003):.4f}" for _ in (0, 1)),
    )


def stiffer(pair: zw.Pair, stiffness: Fraction) -> zw.Pair:
    """Both springs in proportion."""
    return pair.replace(stiffness=stiffness, follower_stiffness=stiffness / pair.power_ratio)


def limit_of(pair: zw.Pair) -> Fraction | None:
    """The largest stiffness that the criterion allows, to the last double."""
    found = largest_holding(lambda k: not k or PairCriterion(stiffer(pair, k)).holds, 1.0)
    exact = Fraction(repr(found)) if found else None
    return exact if exact and PairCriterion(stiffer(pair, exact / 2)).holds else None


def form_of_work(pair: zw.Pair, samples: int) -> np.ndarray:
    """What two hands give over so many samples, as a matrix in the moves of each part of each sample.

    From the definitions alone: readings, taps, held forces, viscous friction.
    """
    T = float(pair.sample_period)
    moves: list[list[tuple[np.ndarray, np.ndarray]]] = []
    size = 4 * samples
    for i in (0, 1):
        moves.append([])
        for k in range(samples):
            early, late = np.zeros(size), np.zeros(size)
            early[4 * k + 2 * i], late[4 * k + 2 * i + 1] = 1, 1
            moves[i].append((early, late))
    x = [[np.zeros(size)] for _ in (0, 1)]
    for i in (0, 1):
        for early, late in moves[i]:
            x[i].append(x[i][-1] + early + late)

    def reading(i: int, k: int) -> np.ndarray:
        return x[i][k] if k >= 0 else np.zeros(size)

    total = np.zeros((size, size))
    for i, side in enumerate(pair.sides):
        weight = 1.0 if i == 0 else float(pair.power_ratio)
        K, B, D = (float(v) for v in (side.stiffness, side.virtual_damping, side.local_damping))
        age = int(np.ceil(float(side.link_delay / pair.sample_period) - 1e-12))
        whole = int(side.delay // pair.sample_period)
        part = float(side.delay / pair.sample_period - whole)

        def force(k: int, i: int = i, K: float = K, B: float = B, D: float = D, age: int = age) -> np.ndarray:
            own, was = reading(i, k), reading(i, k - 1)
            other, old = reading(1 - i, k - age), reading(1 - i, k - age - 1)
            return K * (own - other) + B * ((own - was) - (other - old)) / T + D * (own - was) / T

        for k, (early, late) in enumerate(moves[i]):
            lengths = (part, 1 - part)
            for move, length, held in zip(
                (early, late), lengths, (force(k - whole - 1), force(k - whole)), strict=True
            ):
                paid = float(side.damping) / (length * T) if length else 1e9
                total += weight * (np.outer(move, held) + paid * np.outer(move, move))
    return (total + total.T) / 2


@seeds(12)
def test_no_motion_of_thirty_samples_gains_below_the_limit(seed):
    """The form of all motions of 30 samples, made from the definitions, has no negative value."""
    pair = random_pair(seed)
    limit = limit_of(pair)
    if limit is None:
        return
    values = np.linalg.eigvalsh(form_of_work(stiffer(pair, limit * Fraction("0.999")), 30))
    assert values[0] >= -1e-9 * values[len(values) // 2]


@pytest.mark.parametrize("seed", [3, 8, 15, 21])
def test_some_motion_of_sixty_samples_gains_well_above_it(seed):
    """At 1.3 of the limit the same form has a negative value."""
    pair = random_pair(seed)
    limit = limit_of(pair)
    assert limit is not None
    values = np.linalg.eigvalsh(form_of_work(stiffer(pair, limit * Fraction("1.3")), 60))
    assert values[0] < 0


@seeds(10)
def test_a_round_takes_what_the_form_says(seed):
    """Σ over a round of any motion by the checker = the sum of Δxᴴ M Δx over its harmonics."""
    pair = random_pair(seed, parts=False)
    bare = pair.replace(
        **{n: getattr(pair, n).replace(coulomb_friction=0, stiction=None) for n in ("leader", "follower")}
    )
    random, q = np.random.default_rng(seed), 7
    paths = [[0, *(int(v) for v in random.integers(-9, 9, q - 1)), 0] for _ in (0, 1)]

    def taken(rounds: int) -> Fraction:
        motions = [Motion(tuple(Fraction(v) for v in path[:-1] * rounds + [0])) for path in paths]
        energy = energy_of(bare, *motions)
        assert energy is not None
        return energy

    moved = np.array([np.fft.fft(np.diff(path)) for path in paths]) / q
    found = sum(
        (moved[:, k].conj() @ PairCriterion(bare).at(2 * np.pi * k / q) @ moved[:, k]).real
        for k in range(1, q)
    )
    assert float(taken(6) - taken(5)) == pytest.approx(-found * q * 1000, rel=1e-9)


@seeds(30)
def test_prover_and_checker_have_one_criterion(seed):
    """Made by other steps: the checker's is that of the prover times 2 − 2c, and its square."""
    pair = random_pair(seed)
    told = PAIR_PROOF.fields["loop"].read(pair_document(pair), "", "linear")
    factor = fmpz_poly([2, -2])
    theirs = criterion(told.sample_period, sides_of(told))
    for mine, its, times in zip(PairCriterion(pair).polynomials, theirs, (1, 1, 2), strict=True):
        a, b = mine * factor**times, fmpz_poly(list(its))
        assert a * b[b.degree()] == b * a[a.degree()]
        assert a.degree() == b.degree()
        assert a[a.degree()] * b[b.degree()] > 0


@seeds(12)
def test_both_sides_of_the_limit(seed):
    """At K (1 − 1e-9) the checker accepts the certificate; at K (1 + 1e-9) a motion of both hands gains."""
    pair = random_pair(seed)
    limit = limit_of(pair)
    if limit is not None:
        below = zw.check(stiffer(pair, limit * (1 - BILLIONTH)))
        assert below.outcome == "passive"
        assert below.certificate.verify()
    above = zw.check(stiffer(pair, limit * (1 + BILLIONTH) if limit else Fraction(1)))
    assert above.outcome == "active"
    assert above.violation.verify()
    assert above.witness.verify()
    assert above.witness.energy > 0


@seeds(12)
def test_both_sides_of_friction(seed):
    """Coulomb friction a part in 10⁹ below what the steps of both encoders ask for, on either side."""
    pair = random_pair(seed, counted=True)
    limit = limit_of(pair)
    if limit is None:
        return
    pair = stiffer(pair, limit / 2)
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


def test_equal_arms_need_the_delay_and_a_sample():
    """b ≥ K (T + round trip/2) for equal arms: Nyquist's half sample twice, and half of what the link adds."""
    for there, back in (("0", "0"), ("1 ms", "1 ms"), ("3 ms", "1 ms"), ("0.4 ms", "0")):
        pair = zw.Pair(PADDLE, PADDLE, stiffness=1, delay=(there, back))
        ages = sum(arm.age for arm in PairCriterion(pair).arms)
        assert float(largest_spring(pair)) == pytest.approx(0.5 / (0.001 * (1 + ages / 2)), rel=1e-15)


@pytest.mark.parametrize(("b", "f"), [(1, 1), (0.5, 2), (0.1, 3)])
def test_as_the_period_vanishes_it_is_the_condition_of_delayed_springs(b, f):
    """T → 0: 4 b_l b_f ≥ K² (there + back)², as Lee & Spong (2006) have it for equal arms: b ≥ K (there + back)/2."""
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
    """A link of 1.2 samples is one of two."""
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
    """Nothing pays for the hold."""
    free = PADDLE.replace(damping=0)
    for device in (free, free.replace(delay="0.3 ms")):
        verdict = zw.check(zw.Pair(device, PADDLE, stiffness=10))
        assert verdict.outcome == "active"
        assert verdict.largest_stiffness is None
        assert verdict.required_damping[0] > 0


def test_a_verdict_tells_what_is_needed():
    """Margins are limits: at them passive, beyond them not."""
    verdict = zw.check(zw.Pair(PADDLE, PADDLE, stiffness=300, delay="1 ms"))
    assert verdict.outcome == "active"
    assert verdict.margin == pytest.approx(250 - 300, abs=1e-3)
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
        ({"stiffness": 0}, "stiffness must be > 0"),
        ({"stiffness": "3 N*m/rad"}, "stiffness"),
        ({"follower_stiffness": -1}, "follower_stiffness must be > 0"),
        ({"delay": (-1, 0)}, "delay there must be ≥ 0"),
        ({"delay": 1}, "at most 400"),
        ({"delay": "soon"}, "delay there"),
        ({"leader": 3}, "leader is a Device, got int"),
        ({"follower": PADDLE.replace(rate="500 Hz")}, "1000 Hz and 500 Hz"),
        ({"follower": PADDLE.replace(motion="rotary")}, "linear leader and a rotary follower"),
        ({"follower": PADDLE.replace(damping=(0.1, 0.2))}, "follower: damping has no single value"),
    ],
)
def test_bad_input_is_told(change, message):
    """What was given, the bound, and why."""
    with pytest.raises(zw.InputError, match=message):
        zw.Pair(**{"leader": PADDLE, "follower": PADDLE, "stiffness": 10, **change})


def test_a_pair_stands_alone():
    """Its coupling is in itself."""
    pair = zw.Pair(PADDLE, PADDLE, stiffness=10)
    with pytest.raises(zw.InputError, match="holds its coupling in itself"):
        zw.check(pair, zw.Wall(10))
    with pytest.raises(zw.InputError, match="the environment is missing"):
        zw.check(PADDLE)
