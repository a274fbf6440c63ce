"""Two arms in time: the motions of `check` gain what they say, passive pairs lose, energies close."""

from __future__ import annotations

import numpy as np
import pytest
from scipy.linalg import expm
from strategies import seeds

import zwidth as zw
from zwidth.model.operator import ConstantForce, Finger, Operator, RecordedForce, WitnessMotion

ARM = zw.Device(
    damping="0.1 N*m*s/rad",
    coulomb_friction="0.01 N*m",
    resolution=0,
    rate="1 kHz",
    delay=0,
    motion="rotary",
    mass=0.01,
)
LATE = ARM.replace(delay="1.3 ms", mass=0.4)
TURNS = zw.Device(damping=0.5, rate="1 kHz", motion="rotary")
PAIR = zw.Pair(ARM, ARM, stiffness=20, delay="1 ms")


def got_out(trace) -> float:
    """What both hands got out by the end, as often as it counts."""
    leader, follower = trace["hand_work"].values[:, -1]
    return -(leader + trace.attrs["power_ratio"] * follower)


def replayed(pair: zw.Pair) -> tuple[float, float]:
    """The energy of the witness of an active pair, by its own word and simulated until it rests."""
    verdict = zw.check(pair)
    assert verdict.outcome == "active"
    hands = [WitnessMotion(motion) for motion in (verdict.witness.leader, verdict.witness.follower)]
    tick = pair.sample_period / pair.own_readings
    trace = zw.simulate(pair, *hands, (hands[0].intervals + 1) * tick)
    assert trace.zwidth.energy.closes
    return verdict.witness.energy, got_out(trace)


@pytest.mark.parametrize(
    "changes",
    [
        {"stiffness": 240},
        {"stiffness": 240, "drive_rate": "8 kHz"},
        {"stiffness": 240, "damping": "0.3", "delay": ("0.4 ms", "3 ms")},
        {"stiffness": 240, "follower_stiffness": 300, "local_damping": "0.1", "follower_damping": "-0.02"},
        {"stiffness": 20, "local_damping": "-0.3", "drive_rate": "4 kHz"},
        {"stiffness": 0, "follower_stiffness": 300, "reflection": 1, "damping": "0.1"},
        {"stiffness": 100, "reflection": 1, "follower_reflection": "0.5", "drive_rate": "3 kHz"},
        {"leader": ARM.replace(rate="4 kHz"), "stiffness": 150, "damping": "0.05", "delay": ("1 ms", 0)},
        {"follower": ARM.replace(rate="500 Hz"), "stiffness": 100, "local_damping": "0.05"},
        {"compensation": zw.FrictionCompensation(coulomb="0.012")},
        {"compensation": zw.FrictionCompensation(coulomb="0.05", speed="0.2"), "delay": "2 ms"},
        {"compensation": zw.FrictionCompensation(viscous="0.2"), "drive_rate": "2 kHz"},
        {"leader": LATE, "follower": ARM.replace(delay="0.25 ms"), "stiffness": 400, "delay": "2 ms"},
    ],
)
def test_a_witness_gains_what_it_says_when_it_is_simulated(changes):
    claimed, simulated = replayed(PAIR.replace(**changes))
    assert claimed > 0
    assert simulated == pytest.approx(claimed, rel=1e-9)


def test_a_motion_over_the_edges_of_the_encoders_is_replayed():
    coarse = ARM.replace(damping=2, coulomb_friction="0.001", resolution=2.0**-10)  # exact in binary
    pair = zw.Pair(coarse, coarse, stiffness=20, delay="1 ms")
    assert "Coulomb" in zw.check(pair).limit
    claimed, simulated = replayed(pair)
    assert simulated == pytest.approx(claimed, rel=1e-6)


def test_the_motion_is_that_of_two_masses_by_matrix_exponentials():
    arm = ARM.replace(coulomb_friction=0)
    pair = zw.Pair(
        arm,
        arm.replace(mass=0.03),
        stiffness=50,
        damping="0.02",
        local_damping="0.03",
        delay=("1 ms", "2 ms"),
    )
    random = np.random.default_rng(1)
    pushes = random.normal(size=(2, 60))
    trace = zw.simulate(pair, *(RecordedForce(push) for push in pushes), 0.06)
    x, v = np.zeros((2, 61)), np.zeros((2, 61))
    sides, period = pair.sides, 1e-3
    for k in range(60):
        for i, (side, mass, age) in enumerate(zip(sides, (0.01, 0.03), (2, 1), strict=True)):
            stiff, b, d = (float(g) for g in (side.stiffness, side.virtual_damping, side.local_damping))
            own, own_past = x[i, k], x[i, max(k - 1, 0)]
            its, its_past = x[1 - i, max(k - age, 0)], x[1 - i, max(k - age - 1, 0)]
            f = stiff * (own - its) + b * ((own - own_past) - (its - its_past)) / period
            f += d * (own - own_past) / period
            a = np.array([[0, 1, 0], [0, -0.1 / mass, (pushes[i, k] - f) / mass], [0, 0, 0]])
            x[i, k + 1], v[i, k + 1] = (expm(a * period) @ [x[i, k], v[i, k], 1])[:2]
    assert trace["position"].values == pytest.approx(x, rel=1e-9, abs=1e-12)
    assert trace["velocity"].values == pytest.approx(v, rel=1e-9, abs=1e-10)


@seeds(12)
def test_no_hands_get_more_out_of_a_passive_pair_than_it_holds(seed):
    random = np.random.default_rng(seed)
    arms = [
        ARM.replace(
            damping=f"{random.uniform(0.1, 0.4):.3f}",
            coulomb_friction="0.1",
            resolution=2.0**-12,
            mass=f"{random.uniform(0.005, 0.1):.3f}",
        )
        for _ in (0, 1)
    ]
    pair = zw.Pair(
        *arms,
        stiffness=15,
        delay=(random.uniform(0, 0.003), random.uniform(0, 0.003)),
        compensation=zw.FrictionCompensation(coulomb="0.05", speed=random.choice(["0", "0.1"]))
        if random.uniform() < 0.5
        else None,
    )
    assert zw.check(pair).passive

    def hand() -> Operator:
        pushes = random.normal(scale=random.choice([0.1, 1, 5]), size=300)
        return RecordedForce(np.repeat(pushes, random.integers(1, 30))[:300])

    trace = zw.simulate(pair, hand(), hand(), 0.3, encoder_phase=(random.uniform(), random.uniform()))
    book = trace.zwidth.energy
    assert book.closes
    assert not book.active
    assert not book.arms[0].active, "of one arm alone nothing is claimed"


def test_a_spring_stretched_at_the_start_may_come_back_and_no_more():
    pair = zw.Pair(ARM.replace(coulomb_friction=0), ARM.replace(coulomb_friction=0), stiffness=20)
    away = Finger(start=-0.02, force=0, speed=0.01, stiffness=1)
    trace = zw.simulate(pair, away, ConstantForce(force=0.1), 1.0)
    book = trace.zwidth.energy
    assert trace["actuator_force"].values[:, 0] == pytest.approx([-0.4, 0.4])
    assert book.held_at_start == pytest.approx(0.5 * 20 * 0.02**2)
    assert not book.active


def test_an_active_pair_shakes_by_itself():
    trace = zw.simulate(PAIR.replace(stiffness=200), ConstantForce(force=0.3), None, 0.5)
    assert trace.zwidth.energy.active
    assert np.abs(trace["position"].values[0] - trace["position"].values[1]).max() > 0.5


def test_a_real_wall_gives_back_what_it_took():
    bounced = zw.simulate(PAIR, ConstantForce(force=0.5), zw.Wall(500), 1.0, points_per_sample=4)
    inside = bounced["position"].values[1] > 0
    spring = bounced["hand_spring_energy"].values[1]
    assert inside.any()
    assert spring[inside] == pytest.approx(250 * bounced["position"].values[1][inside] ** 2, rel=1e-12)
    assert not spring[~inside].any()
    assert bounced.zwidth.energy.closes
    assert bounced["hand_force"].values[1, -1] == pytest.approx(-0.5, rel=0.05), "what the leader pushes"


def test_one_arm_of_a_trace_is_a_trace():
    trace = zw.simulate(PAIR, Finger(), zw.Wall(100, 1), 0.1)
    leader = trace.sel(arm="leader")
    assert leader.zwidth.energy.closes
    assert not leader.zwidth.energy.active
    assert trace.zwidth.tracking_error > 0
    with pytest.raises(zw.InputError, match="pair"):
        _ = leader.zwidth.tracking_error


@pytest.mark.parametrize("suffix", [".nc", ".parquet", ".csv"])
def test_a_trace_of_a_pair_comes_back_from_a_file(tmp_path, suffix):
    trace = zw.simulate(PAIR, Finger(), zw.Wall(100, 1), 0.02)
    trace.zwidth.save(tmp_path / f"pair{suffix}")
    assert zw.traces.load_trace(tmp_path / f"pair{suffix}").identical(trace)


@pytest.mark.parametrize(
    ("leader", "follower", "options", "message"),
    [
        (Finger(), None, {"pair": zw.Pair(ARM, ARM.replace(mass=None), stiffness=20)}, "inertia is needed"),
        (Finger(), None, {"pair": zw.Pair(TURNS, TURNS, stiffness=20)}, r"give inertia \[kg\*m\^2\]"),
        (None, zw.Wall(100), {}, "nothing moves"),
        (Finger(), 3, {}, "got int"),
        (Finger(), zw.Wall(100, -1), {}, "give out energy"),
        (Finger(), zw.Wall(100, clamped=True), {}, "clamped"),
        (Finger(), zw.Wall((100, 200)), {}, "one number"),
        (Finger(), None, {"encoder_phase": (0, 1, 2)}, "one for the leader"),
        (Finger(), None, {"encoder_phase": 1.0}, "part of one count"),
        (Finger(), None, {"initial_velocity": 1.0}, "where its hands do"),
    ],
)
def test_what_cannot_be_simulated_is_said(leader, follower, options, message):
    given = {"pair": PAIR, **options}
    with pytest.raises(zw.InputError, match=message):
        zw.simulate(given.pop("pair"), leader, follower, 0.1, **given)
