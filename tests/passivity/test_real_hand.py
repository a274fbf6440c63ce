"""Witnesses replayed by the simulator: the same energy, and what a real hand leaves of it."""

from __future__ import annotations

import random

import pytest
from hypothesis import HealthCheck, given, settings
from hypothesis import strategies as st
from strategies import decimals, seeds

import zwidth as zw
from zwidth.passivity import finite_stiffness as module

PADDLE = zw.catalogue.device("haptic-paddle")
COARSE = PADDLE.replace(resolution=2.24e-3)

LOOPS = {
    "spring": (PADDLE, zw.Wall(770)),
    "encoder": (COARSE, zw.Wall(240)),
    "damped": (PADDLE, zw.Wall(300, damping=0.2)),
    "fractional delay": (PADDLE.replace(delay=3e-4), zw.Wall(400)),
    "delay of a sample": (PADDLE.replace(delay=1e-3), zw.Wall(400)),
    "delay and damping": (PADDLE.replace(delay=1.3e-3), zw.Wall(300, damping=0.1)),
    "solid": (PADDLE, zw.StandardLinearSolid(500, 200, 0.6)),
    "window": (PADDLE, zw.Wall(200, damping=0.3, velocity_filter=zw.rendering.Window(4))),
    "any H(z)": (PADDLE, zw.PulseTransferFunction([500.0, -100.0], [1.0, 0.0])),
    "knob": (zw.rotary(inertia=2e-5, damping=2e-4, rate=1000), zw.Wall(1.0)),
}


def _replayed(device: zw.Device, environment: object, rounds: int = 30) -> tuple[float, float]:
    """(energy by exact arithmetic, energy that the simulated port gives out)."""
    witness = zw.check(device, environment).witness
    assert witness is not None
    motion = witness.motion.repeated(min(rounds, witness.motion.rounds))
    hand = zw.operators.WitnessMotion(motion)
    duration = (hand.intervals + 1) * device.exact("sample_period")
    trace = zw.simulate(device, environment, hand, duration, amplifier=zw.amplifiers.Ideal())
    return float(witness.setting.energy(motion) or 0), -float(trace.hand_work[-1])


@pytest.mark.parametrize("name", LOOPS)
def test_the_simulated_port_gives_out_what_the_proof_counts(name: str) -> None:
    """Every kind of law and delay: the checker's rational arithmetic and the simulator agree."""
    exact, simulated = _replayed(*LOOPS[name])
    assert exact > 0
    assert simulated == pytest.approx(exact, rel=1e-9)


@seeds(30)
def test_the_motion_of_intervals_is_of_the_corner_that_is_told(seed: int) -> None:
    """Damping, delay, resolution or stiffness within ranges: whatever values are active, some or all, motion,
    proof and numbers are of one loop, and its simulated port gives out what is claimed."""
    rng = random.Random(seed)
    several = {"damping": (0.1, 0.2), "delay": (0, 0.00025), "resolution": (0, 0.0003)}
    chosen = {key: ends for key, ends in several.items() if rng.random() < 0.6}
    stiffness = rng.choice([400, 900, (300, 1200)])
    device = PADDLE.replace(**chosen, coulomb_friction=rng.choice([0, 0.05]))
    verdict = zw.check(device, zw.Wall(stiffness, damping=rng.choice([0, 0.05])), iterate=False)
    if verdict.witness is None:
        return
    at, proved = verdict.device, verdict.violation or verdict.witness
    assert proved.setting == verdict.decision.setting == verdict.witness.setting
    told = {key: float(getattr(at, key)) for key in chosen}
    own = {"stiffness": float(verdict.environment.stiffness)} if isinstance(stiffness, tuple) else {}
    assert (verdict.active_at or {}) == told | own
    motion = verdict.witness.motion.repeated(min(30, verdict.witness.motion.rounds))
    hand = zw.operators.WitnessMotion(motion)
    duration = (hand.intervals + 1) * at.exact("sample_period")
    trace = zw.simulate(at, verdict.environment, hand, duration, amplifier=zw.amplifiers.Ideal())
    exact = float(verdict.witness.setting.energy(motion) or 0)
    assert -float(trace.hand_work[-1]) == pytest.approx(exact, rel=1e-9)


def test_the_replay_of_an_interval_gives_out_what_its_proof_counts() -> None:
    """500 N/m, a delay within 0 … 0.25 ms: active at every value, the motion that of the worst."""
    wide = zw.Device(
        mass=0.02, damping=0.15, coulomb_friction=0.1, resolution=13.1e-6, rate=1000, delay=(0, 0.00025)
    )
    verdict = zw.check(wide, zw.Wall(500))
    found = zw.replay(verdict)
    assert (verdict.outcome, verdict.active_at) == ("active", {"delay": 0.00025})
    assert found.replayed == pytest.approx(found.claimed, rel=1e-9)
    assert found.claimed == pytest.approx(verdict.witness.energy)


@settings(max_examples=40, deadline=None, suppress_health_check=[HealthCheck.filter_too_much])
@given(
    stiffness=decimals("400", "3000", places=0),
    damping=decimals("-0.2", "0.2", places=3),
    delay=st.sampled_from(["0", "0.0002", "0.001", "0.0017"]),
    resolution=st.sampled_from(["0", "0.00001", "0.0005"]),
)
def test_any_active_loop_is_active_in_the_simulator(stiffness, damping, delay, resolution) -> None:
    device = PADDLE.replace(delay=delay, resolution=resolution)
    wall = zw.Wall(stiffness, damping)
    if zw.check(device, wall).witness is None:
        return
    exact, simulated = _replayed(device, wall, rounds=5)
    assert simulated == pytest.approx(exact, rel=1e-7, abs=1e-15)


@pytest.mark.parametrize(
    ("name", "stiffness", "bandwidth"),
    [("spring", 5.92e4, 204), ("encoder", 3.23e5, 477), ("fractional delay", 2.47e3, 41.7)],
)
def test_the_softest_hand_is_a_limit_from_both_sides(name, stiffness, bandwidth) -> None:
    """A tenth softer gets nothing out, a tenth stiffer does; the figures are those of the docs."""
    device, environment = LOOPS[name]
    verdict = zw.check(device, environment)
    softest = zw.replay(verdict).softest
    assert softest.stiffness == pytest.approx(stiffness, rel=0.02)
    assert softest.bandwidth == pytest.approx(bandwidth, rel=0.02)
    motion, _ = module._shortened(verdict.witness.motion)
    for factor, gets in ((0.9, False), (1.1, True)):
        k = factor * softest.stiffness
        damping = 2 * (k * float(device.mass)) ** 0.5
        assert (module._got_out(verdict, device, motion, k, damping) > 0) is gets


def test_an_ever_stiffer_hand_comes_to_the_ideal_one() -> None:
    """The energy rises with the stiffness and tends to what the proof counts, never beyond."""
    result = zw.replay(zw.check(*LOOPS["spring"]))
    energies = [hand.energy for hand in result.curve]
    assert result.replayed == pytest.approx(result.claimed, rel=1e-9)
    assert 0.98 < result.best_share <= 1.0 + 1e-9
    assert energies[0] == 0.0
    assert all(a <= b * (1 + 1e-6) for a, b in zip(energies, energies[1:], strict=False))


def test_a_heavier_device_asks_for_a_stiffer_hand_of_the_same_bandwidth() -> None:
    """The conservatism that grows with the mass: stiffness as the mass, bandwidth as it was."""
    quarter, own, four = zw.replay(zw.check(*LOOPS["spring"])).thresholds
    assert own.stiffness / quarter.stiffness == pytest.approx(4, rel=0.05)
    assert four.stiffness / own.stiffness == pytest.approx(4, rel=0.05)
    assert four.bandwidth == pytest.approx(quarter.bandwidth, rel=0.03)


def test_it_shows_itself_with_units() -> None:
    result = zw.replay(zw.check(*LOOPS["knob"]))
    assert "N·m/rad" in repr(result)
    assert result._repr_html_().startswith("<table>")
    assert "stiffness_N_m_per_rad" in result.to_dict()["hands"][0]


@pytest.mark.parametrize(
    ("verdict", "how", "says"),
    [
        (lambda: zw.check(PADDLE, zw.Wall(200)), {}, "passive: it has no motion"),
        (lambda: zw.check(PADDLE.replace(mass=None), zw.Wall(770)), {}, "mass is needed"),
        (lambda: "active", {}, "takes a verdict"),
        (lambda: zw.check(*LOOPS["spring"]), {"damping_ratio": 0.0}, "damping_ratio"),
    ],
)
def test_what_cannot_be_replayed_is_refused(verdict, how: dict[str, float], says: str) -> None:
    with pytest.raises(zw.InputError, match=says):
        zw.replay(verdict(), **how)
