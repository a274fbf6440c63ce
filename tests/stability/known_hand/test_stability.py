"""Stability with a known hand, against closed forms and against matrices that share no code with it."""

from __future__ import annotations

from fractions import Fraction
from math import sqrt

import numpy as np
import pytest
from stepped_loop import radius

import zwidth as zw
from zwidth.model.operator import Dowel, Finger, PrescribedMotion
from zwidth.model.operator.hand_impedance import as_hand
from zwidth.passivity.linear.exact_algebra import is_schur
from zwidth.passivity.stability.characteristic import (
    PRECISIONS,
    _roots,
    decays,
    family,
    last_stable,
    last_stable_of_each,
)
from zwidth.passivity.stability.known_hand import motion_of, plain_of
from zwidth.quantity.balls import precision

coupled, Hand = zw.stability.coupled_stability, zw.stability.HandImpedance
MASS, PERIOD = Fraction("0.036"), Fraction("0.001")
BARE = zw.Device(mass=MASS, damping=0, sample_period=PERIOD)
PADDLE = zw.catalogue.device("haptic-paddle")


def wall(kappa: Fraction, beta: Fraction) -> zw.Wall:
    return zw.Wall(kappa * MASS / PERIOD**2, beta * MASS / PERIOD)


def reference_radius(device: zw.Device, hand: Hand, stiffness: float, damping: float, delay: float) -> float:
    mass, drag = float(device.mass) + float(hand.mass), float(device.damping) + float(hand.damping)
    flow = np.array([[0, 1, 0], [-float(hand.stiffness) / mass, -drag / mass, -1 / mass], [0, 0, 0]])
    return radius(flow, stiffness, damping, float(device.sample_period), delay)


@pytest.mark.parametrize("beta", ["0.01", "0.3", "0.82843", "1.5", "1.99"])
def test_the_closed_form_without_delay_hand_and_friction(beta: str) -> None:
    """0 < κ < 2β(2 − β)/(2 + β): stable just below, unstable at equality and just above."""
    b = Fraction(beta)
    limit = 2 * b * (2 - b) / (2 + b)
    close = Fraction(1, 10**12)
    assert coupled(BARE, wall(limit * (1 - close), b)).outcome == "stable"
    assert coupled(BARE, wall(limit, b)).outcome == "unstable"
    assert coupled(BARE, wall(limit * (1 + close), b)).outcome == "unstable"
    found = coupled(BARE, wall(limit / 2, b)).max_stiffness
    assert found * float(PERIOD**2 / MASS) == pytest.approx(float(limit), rel=1e-14)


def test_the_stiffest_wall_of_all() -> None:
    """κ = 12 − 8√2 = 0.68629 at β = 2√2 − 2 = 0.82843, and less on either side."""
    best = 2 * sqrt(2) - 2
    limits = [
        coupled(BARE, wall(Fraction(1, 9), Fraction(best + off))).max_stiffness for off in (-1e-3, 0, 1e-3)
    ]
    below, top, above = (float(k or 0) * float(PERIOD**2 / MASS) for k in limits)
    assert top == pytest.approx(12 - 8 * sqrt(2), abs=1e-9)
    assert below < top > above


def test_no_virtual_damping_no_stability() -> None:
    found = coupled(BARE, zw.Wall(1))
    assert found.outcome == "unstable"
    assert found.max_stiffness is None
    assert coupled(BARE, zw.Wall(0, 1)).outcome == "unstable"  # at rest anywhere: it drifts


def test_the_wall_of_salcudean_and_vlaar() -> None:
    """z²(z − 1)² + (z + 1)[k z + b (z − 1)], k = T²K/2m, b = TB/2m: one sample of delay."""
    device = BARE.replace(delay=PERIOD)
    rng = np.random.default_rng(3)
    outcomes = set()
    for k, b in zip(rng.uniform(0.001, 0.12, 60), rng.uniform(0.02, 0.35, 60), strict=True):
        p = np.polymul([1, 0, 0], [1, -2, 1])
        p = np.polyadd(p, np.polymul([1, 1], [k + b, -b]))
        largest = np.abs(np.roots(p)).max()
        found = coupled(device, wall(2 * Fraction(k), 2 * Fraction(b)))
        assert found.outcome == ("stable" if largest < 1 else "unstable")
        assert found.spectral_radius == pytest.approx(largest, abs=1e-9)
        outcomes.add(found.outcome)
    assert outcomes == {"stable", "unstable"}


@pytest.mark.parametrize("delay", ["0", "0.00037", "0.001", "0.0017", "0.003"])
@pytest.mark.parametrize("hand", [None, Finger(), Dowel(force=1, damping=0.2)])
def test_whole_and_fractional_delays_and_hands(delay: str, hand: object) -> None:
    device, held = PADDLE.replace(delay=delay), as_hand(hand)
    for k, b in ((300.0, 0.1), (2000.0, 5.0), (9000.0, 12.0)):
        found = coupled(device, zw.Wall(k, b), hand)
        largest = reference_radius(device, held, k, b, float(delay))
        assert found.spectral_radius == pytest.approx(largest, abs=1e-9)
        assert found.outcome == ("stable" if largest < 1 else "unstable")


@pytest.mark.parametrize("delay", ["0", "0.00037", "0.002"])
def test_the_limit_is_where_the_spectral_radius_reaches_one(delay: str) -> None:
    device, held = PADDLE.replace(delay=delay), as_hand(Finger())
    limit = coupled(device, zw.Wall(100, 3), Finger()).max_stiffness
    low, high = 100.0, 1e5
    for _ in range(60):
        middle = (low + high) / 2
        inside = reference_radius(device, held, middle, 3.0, float(delay)) < 1
        low, high = (middle, high) if inside else (low, middle)
    assert limit == pytest.approx(low, rel=1e-9)
    sides = [coupled(device, zw.Wall(k, 3), Finger()).outcome for k in (limit, np.nextafter(limit, 1e9))]
    assert sides[0] == "stable" != sides[1]


def test_added_mass_scales_the_limit() -> None:
    """Without friction only m + m_h counts: at κ and β kept, K grows with the mass."""
    own = coupled(BARE, zw.Wall(10, 20)).max_stiffness
    doubled = coupled(BARE, zw.Wall(10, 40), Hand(mass=MASS)).max_stiffness
    assert doubled == pytest.approx(2 * own, rel=1e-14)


def test_a_wall_that_is_passive_is_stable_in_every_passive_hand() -> None:
    """At K = 2(b − B)/T, the limit of passivity, 40 hands of all kinds find rest."""
    hands = 10 ** np.random.default_rng(5).uniform([[-4], [-1], [-3]], [[1], [5], [2]], (3, 40))
    at_limit = zw.Wall(200, "0.05")
    assert zw.check(PADDLE, at_limit).outcome == "passive"
    for m, k, c in hands.T:
        assert coupled(PADDLE, at_limit, Hand(mass=m, stiffness=k, damping=c)).outcome == "stable"


def test_an_interval_stands_for_every_hand_in_it() -> None:
    box = Hand(mass=(0, "0.02"), stiffness=(0, 1000), damping=(0, 3))
    found = coupled(PADDLE, zw.Wall(1000, 1), box)
    assert found.outcome == "stable"
    rng = np.random.default_rng(7)
    for m, k, c in rng.uniform(0, [0.02, 1000, 3], (30, 3)):
        one = coupled(PADDLE, zw.Wall(1000, 1), Hand(mass=m, stiffness=k, damping=c))
        assert one.outcome == "stable"
        assert one.max_stiffness >= found.max_stiffness
        assert one.spectral_radius <= found.spectral_radius + 1e-12


def test_an_interval_with_one_unstable_hand_names_it() -> None:
    box = Hand(damping=(0, 3))
    found = coupled(PADDLE, zw.Wall(3000, 1), box)
    assert found.outcome == "unstable"
    damping = found.unstable_hand[1] - float(PADDLE.damping)
    for one, outcome in ((damping, "unstable"), (3, "stable")):
        assert coupled(PADDLE, zw.Wall(3000, 1), Hand(damping=one)).outcome == outcome


def test_an_interval_that_touches_the_limit_is_undecided() -> None:
    """A billionth below the largest stiffness of its worst corner; a millionth below it is proved, and
    above it is refuted."""
    limit = coupled(PADDLE, zw.Wall(1000, 1), Hand(stiffness=1000)).max_stiffness
    box = Hand(mass=(0, "0.02"), stiffness=(0, 1000), damping=(0, 3))
    for off, outcome in ((-1e-6, "stable"), (-1e-9, "undecided"), (1e-6, "unstable")):
        found = coupled(PADDLE, zw.Wall(limit * (1 + off), 1), box)
        assert found.outcome == outcome
        assert found.verify() == (outcome != "undecided")


def test_other_velocity_filters_and_laws() -> None:
    """A filter with a negative leading coefficient is the same filter; the window of two is a filter."""
    filters = (*(zw.rendering.VelocityFilter([n, n], [2 * n, 0]) for n in (1, -1)), zw.rendering.Window(2))
    found = [coupled(PADDLE, zw.Wall(1000, 1, velocity_filter=each)) for each in filters]
    assert {each.outcome for each in found} == {"stable"}
    for other in found[1:]:
        assert other.max_stiffness == pytest.approx(found[0].max_stiffness, rel=1e-14)
    law = coupled(PADDLE, zw.PulseTransferFunction([2000, -1000], [1, 0]))
    assert law.max_stiffness is None
    assert law.spectral_radius == pytest.approx(coupled(PADDLE, zw.Wall(1000, 1)).spectral_radius, abs=1e-12)


def test_rouths_test_agrees_with_the_schur_cohn_recursion() -> None:
    """Two tests of the same polynomials, exact: 300 loops of order 3 to 6, of both kinds."""
    rng = np.random.default_rng(11)
    seen = set()
    for _ in range(300):
        device = BARE.replace(delay=Fraction(int(rng.integers(0, 7)), 3) * PERIOD)
        k, b = Fraction(float(rng.uniform(0, 8000))), Fraction(float(rng.uniform(0, 40)))
        velocity = zw.rendering.BackwardDifference().transfer(PERIOD)
        with precision(PRECISIONS[0]):
            polynomial = family(motion_of(device, Hand()), velocity).at(k, b)
        in_z = [Fraction(0)]
        for c in polynomial:  # ζ = z − 1
            in_z = [x - y for x, y in zip([*in_z, Fraction(0)], [Fraction(0), *in_z], strict=True)]
            in_z[-1] += c
        common = np.lcm.reduce([c.denominator for c in in_z], dtype=object)
        expected = is_schur([int(c * common) for c in reversed(in_z)])
        assert decays(polynomial) == expected
        seen.add(expected)
    assert seen == {True, False}


@pytest.mark.parametrize(
    ("ask", "said"),
    [
        (lambda: coupled(zw.Device(damping=1, rate=1000), zw.Wall(1)), "the device.s mass"),
        (lambda: coupled(PADDLE, zw.Wall(1), 3), "known hand"),
        (lambda: coupled(PADDLE, zw.Wall(1), PrescribedMotion(positions=[0, 1])), "known hand"),
        (lambda: Hand(damping=-1), "no energy of its own"),
    ],
)
def test_what_cannot_be_asked(ask, said) -> None:
    with pytest.raises(zw.InputError, match=said):
        ask()


def test_what_a_claim_rests_on() -> None:
    found = coupled(PADDLE, zw.Wall(300, 0.1, clamped=True), Finger())
    notes = " ".join(found.assumptions)
    assert "contact is kept" in notes
    assert "Coulomb friction" in notes
    assert "never pulls" in notes
    assert str(found).startswith("stable: ")


def test_a_result_shows_in_a_line() -> None:
    found = coupled(PADDLE, zw.Wall(3000, 1), Finger())
    assert repr(found).startswith("<Stability stable: device and hand come to rest")
    assert repr(found).endswith(f"stiffest {found.max_stiffness:.6g}>")


def test_a_hand_that_turns_says_its_numbers_in_rotary_units() -> None:
    knob = zw.rotary(damping="0.001", inertia="1e-5", rate=1000)
    hand = Hand(mass="2e-5", stiffness=(0, 3), damping="0.02")
    said = coupled(knob, zw.Wall(1), hand).scope.hands.impedance
    assert said == "m_h = 2e-05 kg·m², k = 0 … 3 N·m/rad, c = 0.02 N·m·s/rad"
    assert "c = 0.02 N·s/m" in hand.describe()


def test_roots_of_many_polynomials_are_those_of_each() -> None:
    rows = np.random.default_rng(3).normal(size=(40, 6))
    rows[10:20, 0] = rows[15:30, -1] = rows[28:33, :3] = rows[35] = 0.0
    rows[36, 1:] = 0.0
    for row, found in zip(rows, _roots(rows), strict=True):
        assert found.tolist() == np.roots(row).tolist()


@pytest.mark.parametrize("delay", [0, "0.4 ms", "3 ms"])
def test_last_stable_stiffnesses_at_many_dampings_are_those_of_each(delay) -> None:
    device = zw.catalogue.device("haptic-paddle").replace(delay=delay)
    velocity = zw.rendering.BackwardDifference().transfer(PERIOD)
    polynomials = plain_of(motion_of(device, as_hand(Finger())), velocity)
    dampings = np.linspace(-1, 90, 600)
    found = last_stable_of_each(polynomials, dampings)
    assert any(each is not None for each in found[::37])
    assert found[::37] == [last_stable(polynomials, b) for b in dampings[::37].tolist()]
