"""How active a hand may be below a frequency: proved, refuted by a hand, and by other roads."""

from __future__ import annotations

from dataclasses import replace
from pathlib import Path

import numpy as np
import pytest
from stepped_loop import radius

import zwidth as zw
from zwidth.passivity.stability.shaking_hand import ShakingHand

tolerated = zw.stability.tolerated_activity
B, T = 0.15, 1e-3


def paddle(**changes: object) -> zw.Device:
    numbers = {"mass": 0.036, "damping": B, "rate": 1000, "coulomb_friction": 0.12, "resolution": 22.4e-6}
    return zw.Device(**(numbers | changes))  # type: ignore[arg-type]


def law(wall: zw.Wall, theta: np.ndarray, delay: int = 0) -> np.ndarray:
    z = np.exp(1j * theta)
    return np.asarray((float(wall.stiffness) + float(wall.damping) * (1 - 1 / z) / T) * z**-delay)


def impedance(hand: ShakingHand, omega: np.ndarray) -> np.ndarray:
    s, w1 = 1j * omega, 2 * np.pi * hand.frequency
    resonance = 2 * hand.sharpness * w1 * s / (s * s + 2 * hand.sharpness * w1 * s + w1 * w1)
    drive = hand.activity + hand.damping
    return np.asarray(hand.mass * s + hand.stiffness / s + hand.damping - drive * resonance)


def shaken(wall: zw.Wall, hand: ShakingHand, activity: float, delay: int = 0) -> float:
    """The largest pole of device, wall and this hand with another activity."""
    w1, whole = 2 * np.pi * hand.frequency, 0.036 + hand.mass
    wide, drive, drag = 2 * hand.sharpness * w1, activity + hand.damping, B + hand.damping
    flow = np.zeros((5, 5))
    flow[0, 1] = 1
    flow[1] = [-hand.stiffness / whole, -drag / whole, drive / whole, 0, -1 / whole]
    flow[2, 1:4] = [wide, -wide, -w1]
    flow[3, 2] = w1
    return radius(flow, float(wall.stiffness), float(wall.damping), T, delay * T)


def by_discs(wall: zw.Wall, below: float, delay: int = 0) -> float:
    """The largest activity by the discs of 1/Z, summed over the aliases, on a grid."""
    theta = np.linspace(1e-4, 2 * np.pi * below * T, 400)
    line = (1 - np.exp(-1j * theta)) * law(wall, theta, delay) / T
    others = (theta[:, None] + 2 * np.pi * np.r_[-20000:0, 1:20001]) / T
    rest = (1 / (others**2 * B)).sum(axis=1)
    low, high = 0.0, 2.0
    for _ in range(60):
        a = (low + high) / 2
        own = 1 / ((theta / T) ** 2 * (B - a))
        inside = line.real * (own + rest) < 1
        if a > B:  # the outside of a disc: the sum must be one too, and the law's inverse inside it
            inside = (own + rest < 0) & (line.real * (own + rest) > 1)
        low, high = (a, high) if inside.all() else (low, a)
    return low


@pytest.mark.parametrize("stiffness", [20, 150, 299])
@pytest.mark.parametrize("below", [0.1, 10, 200])
def test_spring(stiffness: float, below: float) -> None:
    """A spring leaves b − K T/2, however slow the hand is: exact from both sides."""
    found = tolerated(paddle(), zw.Wall(stiffness), below)
    assert found.activity == pytest.approx(B - stiffness * T / 2, rel=1e-12)
    assert found.with_contact_broken == pytest.approx(B - stiffness * T / 2, rel=1e-12)


def test_the_limit_of_passivity_leaves_nothing() -> None:
    """At K = 2b/T not the least activity is allowed; beyond, nothing is claimed."""
    assert tolerated(paddle(), zw.Wall(300)).activity == 0
    beyond = tolerated(paddle(), zw.Wall(301))
    assert beyond.activity is None
    assert beyond.certificate is None
    assert "Not even every passive hand" in str(beyond)


@pytest.mark.parametrize(
    ("wall", "below", "delay"),
    [
        *((zw.Wall(k, 0.05), 10, 0) for k in (150, 100)),
        *((zw.Wall(20, 0.12), below, 0) for below in (10, 40)),
        *((zw.Wall(50, 0.02), 10, 1), (zw.Wall(30, 0.01), 25, 2)),
    ],
)
def test_against_the_discs_of_all_linear_hands(wall: zw.Wall, below: float, delay: int) -> None:
    """The same limit, less θ₀²/12 at most, where 1/Z of device and hand is summed over its aliases."""
    found = tolerated(paddle(delay=delay * T), wall, below)
    exact = by_discs(wall, below, delay)
    loss = (2 * np.pi * below * T) ** 2 / 12
    assert exact * (1 - 2 * loss) - 1e-6 <= found.activity <= exact * (1 + 1e-6)


@pytest.mark.parametrize(
    ("wall", "delay"),
    [
        *((wall, 0) for wall in (zw.Wall(150), zw.Wall(290), zw.Wall(100, 0.05), zw.Wall(20, 0.12))),
        *((zw.Wall(50), 1), (zw.Wall(30, 0.01), 2)),
    ],
)
def test_a_hand_that_is_too_active(wall: zw.Wall, delay: int) -> None:
    found = tolerated(paddle(delay=delay * T), wall)
    hand = found.hand
    assert found.activity < hand.activity < found.activity * 1.003 + 1e-4
    assert shaken(wall, hand, hand.activity, delay) > 1
    assert shaken(wall, hand, found.activity, delay) < 1
    grown = np.log(2) * T / np.log(shaken(wall, hand, hand.activity, delay))
    assert grown == pytest.approx(hand.doubling_time, rel=1e-3)


def test_that_hand_is_of_the_kind() -> None:
    """Re Z ≥ −a everywhere, −a at its own frequency, and ≥ 0 from f₀ on."""
    hand = tolerated(paddle(), zw.Wall(100, 0.05)).hand
    frequencies = np.unique(np.concatenate([np.geomspace(0.01, 5000, 5000), [hand.frequency]]))
    real = impedance(hand, 2 * np.pi * frequencies).real
    assert real.min() == pytest.approx(-hand.activity, rel=1e-9)
    assert (real[frequencies >= 10] >= 0).all()
    assert hand.frequency < 10


def test_no_linear_hand_of_this_activity_shakes_the_loop() -> None:
    rng = np.random.default_rng(7)
    wall = zw.Wall(120, 0.03)
    allowed = tolerated(paddle(), wall).activity
    edge = 2 * np.pi * 10
    for _ in range(300):
        w1 = edge * rng.uniform(0.05, 0.9)
        zeta = 10 ** rng.uniform(-3, -0.5)
        wide = (2 * zeta * w1 * edge) ** 2
        beta = wide / ((edge**2 - w1**2) ** 2 + wide)
        mass = 10 ** rng.uniform(-3, 1)
        hand = ShakingHand(
            mass=mass,
            stiffness=max(0.0, (0.036 + mass) * w1**2 - 120) * rng.uniform(0.9, 1.1),
            activity=allowed * (1 - 1e-6),
            frequency=w1 / 2 / np.pi,
            damping=allowed * beta / (1 - beta),
            sharpness=zeta,
            doubling_time=1.0,
        )
        assert shaken(wall, hand, hand.activity) < 1


def test_more_active_than_the_device_is_damped() -> None:
    """A wall that dissipates at low frequencies carries such a hand; off it the device shakes."""
    found = tolerated(paddle(), zw.Wall(20, 0.12))
    assert found.activity > B > found.with_contact_broken
    hand = found.hand
    # alone with a spring in the place of the wall's
    free = replace(hand, stiffness=hand.stiffness + 20)
    assert shaken(zw.Wall(0), free, found.activity) > 1


def test_at_single_frequencies() -> None:
    """`at` is the closed form; its least in the band is what is proved, less θ₀²/12."""
    found = tolerated(paddle(), zw.Wall(150, 0.05))
    assert found.at(10)[0] == pytest.approx(found.activity, rel=1e-3)
    assert found.at([1, 5, 10, 400])[-1] < found.at(10)[0]


def test_part_of_a_sample_late() -> None:
    """Then b − a is taken everywhere, and no hand is sought."""
    late = paddle(delay=0.0005)
    found = tolerated(late, zw.Wall(50, 0.02))
    assert zw.check(late.replace(damping=B - found.activity * 0.999), zw.Wall(50, 0.02)).is_proved
    assert zw.check(late.replace(damping=B - found.activity * 1.001), zw.Wall(50, 0.02)).outcome == "active"
    assert found.hand is None


def test_a_clamped_wall_is_covered_with_contact_broken() -> None:
    """The linear criterion says nothing of it; the conditions for contact do."""
    found = tolerated(paddle(), zw.Wall(100, 0.05, clamped=True))
    assert found.activity == found.with_contact_broken == pytest.approx(0.05)


def test_the_table_of_the_documentation() -> None:
    page = Path(__file__).parents[3] / "docs/theory/known-hand.md"
    rows = [line.split("|") for line in page.read_text(encoding="utf-8").splitlines() if " N/m" in line]
    rows = [row for row in rows if len(row) == 6]
    assert len(rows) == 5
    for _, name, kept, hand, broken, _ in rows:
        words = name.replace(",", "").split()
        numbers = [float(w) for w in words if w.replace(".", "").isdigit()]
        found = tolerated(paddle(delay=T if "late" in name else 0), zw.Wall(*numbers))
        for text, value in ((kept, found.activity), (broken, found.with_contact_broken)):
            assert float(text) == pytest.approx(value, rel=1e-3)
        assert float(hand.split()[0]) == pytest.approx(found.hand.activity, rel=1e-3)


def test_slow_growth_is_told_in_minutes_and_hours() -> None:
    found = tolerated(paddle(), zw.Wall(290))
    assert found.hand.describe().endswith(f"doubles every {found.hand.doubling_time / 3600:.3g} h")
    quick = replace(found.hand, doubling_time=100.0)
    assert quick.describe().endswith("doubles every 100 s")
    assert replace(quick, doubling_time=150.0).describe().endswith("doubles every 2.5 min")


def test_a_band_with_a_unit_and_a_device_that_turns() -> None:
    found = tolerated(paddle(), zw.Wall(100), "0.01 kHz")
    assert found.below == 10
    assert repr(found).startswith("<ToleratedActivity below 10 Hz: up to 0.1 N·s/m, contact kept; at any")
    turned = tolerated(zw.Device(mass=1e-4, damping=1e-3, rate=1000, motion="rotary"), zw.Wall(1.0))
    assert turned.activity == pytest.approx(5e-4)
    assert turned.to_dict()["contact_kept"]["activity_N_m_s_per_rad"] == turned.activity
    assert turned.hand.to_dict().keys() & {"inertia_kg_m2", "mass_kg_m2"}


@pytest.mark.parametrize(
    ("ask", "words"),
    [
        (lambda: tolerated(paddle(), zw.Wall(100), 0), "must be > 0"),
        (lambda: tolerated(paddle(), zw.Wall(100), 501), "at most half the rate"),
        (lambda: tolerated(paddle(), zw.Wall(100), "10 s"), r'below is in Hz; got "10 s", a time'),
        (lambda: tolerated(paddle(damping=(0.1, 0.2)), zw.Wall(100)), "no single value"),
        (lambda: tolerated(paddle(), zw.Wall(150, 0.05)).at(600), "half the rate"),
        (lambda: tolerated(paddle(delay=0.0005), zw.Wall(50, 0.02)).at(5), "whole samples"),
    ],
)
def test_what_cannot_be_asked(ask, words) -> None:
    with pytest.raises(zw.InputError, match=words):
        ask()
