"""The damping that springs known by their slopes ask for: closed form, form, motions that gain."""

from __future__ import annotations

from fractions import Fraction

import numpy as np
import pytest

import zwidth as zw
from zwidth.errors import InputError
from zwidth.passivity.coupling.loop_forms import (
    DIRECT,
    best_form,
    largest_need,
    least_multiplier,
    slopes_form,
)

T = Fraction(1, 1000)


@pytest.mark.parametrize("delay", [0, 1, 2, 5])
@pytest.mark.parametrize("least", [-500, -310, 0, 120, 500])
def test_it_is_the_need_of_a_delayed_spring(delay, least):
    """(2d + 1) K T/2, whatever the least slope from −K up: that of `formulas.spring_damping`."""
    found = zw.coupling.required_damping_by_slopes(least, 500, T, delay * T)
    assert found == zw.formulas.spring_damping(500, T, delay * T)


@pytest.mark.parametrize("delay", [0, 1, 2, 3])
def test_the_closed_form_is_the_best_of_the_form(delay):
    """At slopes −μ within (1 + 1/d) L the searched multiplier finds no less and no more."""
    for least in (-470, -333, 0, 200):
        slopes = zw.coupling.SlopeBounds(least, 470, bounded_below=True)
        searched, _ = largest_need(best_form(slopes, DIRECT, delay), T)
        assert searched == pytest.approx(
            float(zw.coupling.required_damping_by_slopes(least, 470, T, delay * T)), rel=1e-7
        )


def test_the_edge_of_the_closed_form():
    """At d |μ| = (d + 1) L it still holds; past it more is asked for, without a jump."""
    at = float(zw.coupling.required_damping_by_slopes(-750, 500, T, 2 * T))
    past = zw.coupling.required_damping_by_slopes(-751, 500, T, 2 * T)
    far = zw.coupling.required_damping_by_slopes(-1500, 500, T, 2 * T)
    assert at == 1.25
    assert at <= past < at * 1.001
    assert far > 1.2 * at


@pytest.mark.parametrize(("least", "delay"), [(-3000, 1), (-800, 2), (-1200, 3)])
def test_beyond_the_closed_form_the_number_itself_is_proved(least, delay):
    """The float that is returned holds by exact arithmetic; a millionth less does not."""
    need = zw.coupling.required_damping_by_slopes(least, 500, T, delay * T)
    there = zw.Device(damping=need, sample_period=T, delay=delay * T)
    assert zw.coupling.transformed_condition(
        there, zw.coupling.SlopeBounds(least, 500, bounded_below=True)
    ).holds
    short = there.replace(damping=need * (1 - 1e-6))
    assert not zw.coupling.transformed_condition(
        short, zw.coupling.SlopeBounds(least, 500, bounded_below=True)
    ).holds


def wavy(random, slopes):
    """A spring of random pieces whose slopes are the two bounds: places and forces."""
    points = np.cumsum(random.uniform(0.2, 1.5, 41)) - 17
    forces = np.concatenate([[0.0], np.cumsum(np.diff(points) * random.choice(slopes, 40))])
    return points, forces - np.interp(0.0, points, forces)


def potential(points, forces, x):
    """Φ(x) with Φ(0) = 0, piece by piece; constant forces beyond the ends."""
    grid = np.unique(np.concatenate([points, [0.0, x]]))
    f = np.interp(grid, points, forces)
    areas = np.concatenate([[0.0], np.cumsum(np.diff(grid) * (f[1:] + f[:-1]) / 2)])
    return np.interp(x, grid, areas) - np.interp(0.0, grid, areas)


def gain(points, forces, moves, damping, delay):
    """What the hand gets beyond the spring's potential: Φ(x_N) − Σ [f(k−1−d) D + b D²], T = 1."""
    x = np.concatenate([[0.0], np.cumsum(moves)])
    f = np.interp(np.concatenate([np.zeros(delay), x[:-1]]), points, forces)[: len(moves)]
    return potential(points, forces, x[-1]) - float(np.sum(f * moves + damping * moves**2))


def searched_gain(slopes, damping, delay, rounds=400):
    """The largest such gain, beside Σ D², that a search finds over random springs."""
    best = -np.inf
    for seed in range(5):
        random = np.random.default_rng(seed)
        points, forces = wavy(random, slopes)
        moves = random.normal(0, 0.3, 24)
        for _ in range(rounds):
            tried = moves.copy()
            tried[random.integers(24)] += random.normal(0, 0.3)
            value = gain(points, forces, tried, damping, delay) / np.sum(tried**2)
            if value > best or value > gain(points, forces, moves, damping, delay) / np.sum(moves**2):
                moves = tried
                best = max(best, value)
    return best


@pytest.mark.parametrize(("least", "delay"), [(-1.0, 0), (-1.9, 1), (-1.4, 2), (-4.0, 2), (0.0, 3)])
def test_a_search_over_springs_and_motions_gains_nothing(least, delay):
    """At the need, springs of extreme slopes give no more than their potential; at a third of it they do."""
    need = float(zw.coupling.required_damping_by_slopes(Fraction(least), 1, 1, delay))
    assert searched_gain((least, 1.0), need, delay) <= 1e-12
    assert searched_gain((least, 1.0), need / 3, delay) > 1e-3


@pytest.mark.parametrize("delay", [0, 1, 3])
def test_curvature_within_a_matrix_is_paid_by_it(delay):
    """−H ⪯ ∇²Φ ⪯ H in two joints: (2d + 1) H T/2 is enough for every motion tried; a fifth of it is not."""
    random = np.random.default_rng(delay)
    heights, waves = np.array([0.4, -0.7, 0.2]), random.normal(0, 1, (3, 2))
    matrix = np.einsum("i,ij,ik->jk", np.abs(heights), waves, waves) * (2 * delay + 1) / 2
    over, under = [], []
    for _ in range(400):
        q = np.cumsum(random.normal(0, random.choice([0.1, 1.0]), (20, 2)), axis=0) + random.uniform(-5, 5, 2)
        force = -(heights * np.sin(q @ waves.T)) @ waves
        q, force = np.vstack([q[:1], q]), np.vstack([*[force[:1]] * (delay + 1), force])
        moves, stored = np.diff(q, axis=0), heights @ np.cos(q @ waves.T)[[0, -1]].T
        work = np.sum(force[: len(moves)] * moves)
        heat = np.einsum("ki,ij,kj->", moves, matrix, moves)
        over.append(work + heat - np.diff(stored)[0])
        under.append(work + heat / 5 - np.diff(stored)[0])
    assert min(over) >= -1e-12
    assert min(under) < -1e-3


def test_below_the_need_a_spring_is_active():
    """One per cent below, `check` has a motion for the spring of greatest slope; at the need a proof."""
    need = zw.coupling.required_damping_by_slopes(-500, 500, T, T)
    spring = zw.PulseTransferFunction([500], [1])
    below = zw.Device(damping=Fraction(99, 100) * need.fraction, sample_period=T, delay=T)
    assert zw.check(below, spring).outcome == "active"
    assert zw.check(below.replace(damping=need), spring).outcome == "passive"


def test_the_trapezoid_lies_within_the_parallelogram():
    """|½(f₀ + f₁) e − ΔΦ| ≤ (Δf − μe)(Le − Δf)/(2(L − μ)) over random pieces, and is reached by a kink."""
    random = np.random.default_rng(3)
    low, high = -0.7, 1.3
    for _ in range(300):
        points, forces = wavy(random, (low, high))
        a, b = random.uniform(-8, 8, 2)
        e, change = b - a, np.interp(b, points, forces) - np.interp(a, points, forces)
        middle = (np.interp(b, points, forces) + np.interp(a, points, forces)) / 2
        error = middle * e - (potential(points, forces, b) - potential(points, forces, a))
        bound = (change - low * e) * (high * e - change) / (2 * (high - low))
        assert abs(error) <= bound + 1e-12
    kink = (np.array([-2.0, 0.0, 2.0]), np.array([-2 * low, 0.0, 2 * high]))
    error = (-low + 2 * high) / 2 * 3 - (potential(*kink, 2.0) - potential(*kink, -1.0))
    change = 2 * high + low
    assert error == pytest.approx((change - 3 * low) * (3 * high - change) / (2 * (high - low)))


def test_any_multiplier_is_sound():
    """Whatever g, the form asks for no less than the best one."""
    slopes, best = (
        zw.coupling.SlopeBounds(-100, 300, bounded_below=True),
        float(zw.coupling.required_damping_by_slopes(-100, 300, T, T)),
    )
    for more in (0, Fraction(1, 900), Fraction(1, 100)):
        need, _ = largest_need(slopes_form(slopes, least_multiplier(slopes) + more, DIRECT, 1), T)
        assert need >= best * (1 - 1e-9)


def test_the_slopes_of_a_spring_given_by_points():
    """Detents have ±4F/p; a magnet that lets go on one side has the steeper fall as its least slope."""
    detents = zw.coupling.SlopeBounds.of(zw.NonlinearSpring.detents(3, "0.01", 2))
    assert (detents.least, detents.greatest) == (-800, 800)
    magnet = zw.coupling.SlopeBounds.of(zw.NonlinearSpring(["-0.01", 0, "0.002"], [-3, "0.5", 0]))
    assert (magnet.least, magnet.greatest) == (-250, 350)
    assert zw.coupling.SlopeBounds.of(zw.NonlinearSpring([0, 1], [-1, 2])).least == 0


@pytest.mark.parametrize(
    "spring",
    [zw.NonlinearSpring([0, 1], [1, 2]), zw.NonlinearSpring([0, 1], [0, -1]), zw.Wall(1, 0)],
)
def test_a_spring_that_leads_away_has_no_such_slopes(spring):
    """Its potential has no least value: refused, as is what is no spring by points."""
    with pytest.raises(InputError):
        zw.coupling.SlopeBounds.of(spring)


@pytest.mark.parametrize(
    ("arguments", "words"),
    [
        ((3, 2, T), "least slope"),
        ((0, 2, 0), "sample_period"),
        ((0, 2, T, T / 2), "whole number"),
        ((0, 2, T, -T), "delay"),
    ],
)
def test_what_does_not_fit_is_refused(arguments, words):
    """Each with a message that names it."""
    with pytest.raises(InputError, match=words):
        zw.coupling.required_damping_by_slopes(*arguments)


def test_a_class_states_that_its_potentials_are_bounded_below():
    """Where slopes do not force it, from 0 down; above 0 it is so by itself, and False is nobody's class."""
    for least in (-100, 0):
        with pytest.raises(InputError, match="bounded_below=True"):
            zw.coupling.SlopeBounds(least, 250)
        assert zw.coupling.SlopeBounds(least, 250, bounded_below=True).bounded_below
    assert zw.coupling.SlopeBounds("0.1", 250).bounded_below
    with pytest.raises(InputError, match="no device is passive"):
        zw.coupling.SlopeBounds(1, 250, bounded_below=False)


def test_the_spring_that_refutes_the_class_without_it():
    """−100 N/m has slopes from −100 to 250; before it the device is active, and the claim leaves it out."""
    paddle = zw.catalogue.device("haptic-paddle").replace(coulomb_friction=0, resolution=0)
    assert zw.check(paddle, zw.PulseTransferFunction([-100], [1])).outcome == "active"
    found = zw.coupling.transformed_condition(paddle, zw.coupling.SlopeBounds(-100, 250, bounded_below=True))
    assert found.holds
    assert "slopes from -100 to 250 N/m whose potential is bounded below" in found.claim
    assert found.claim in repr(found)
    assert found.scope.law == ("potential bounded below",)


@pytest.mark.parametrize(("count", "encoder"), [(0, "ideal"), ("1e-5", "not counted")])
def test_what_it_covers_is_data(count, encoder):
    """Contact made and broken; an encoder with counts is not in it, in the claim too."""
    device = zw.Device(damping=1, rate=1000, resolution=count)
    found = zw.coupling.transformed_condition(device, zw.coupling.SlopeBounds(0, 500, bounded_below=True))
    assert (found.scope.contact, found.scope.encoder) == ("made and broken", encoder)
    assert ("counts of the encoder are not in it" in found.claim) == bool(float(count))
    short = zw.coupling.transformed_condition(
        device.replace(damping="0.1"), zw.coupling.SlopeBounds(0, 500, bounded_below=True)
    )
    assert short.claim.startswith("No promise for every static spring")
    assert zw.coupling.transformed_condition(device, zw.coupling.PassivityExcess(0, 1)).scope.law == (
        "energy at first bounded",
    )


def slow_gain(points, forces, start, end, damping, samples=4000):
    """What a slow motion from `start` to `end` gets out without delay, T = 1; slower loses less."""
    x = np.linspace(start, end, samples + 1)
    moves = np.diff(x)
    return -float(np.sum(np.interp(x[:-1], points, forces) * moves + damping * moves**2))


def test_slow_motions_tell_potentials_that_have_no_lower_bound():
    """Random springs of one class: with stops slow motions get out what is stored, else ten times as much."""
    random, low, high = np.random.default_rng(4), -1.0, 1.5
    need = float(zw.coupling.required_damping_by_slopes(Fraction(low), Fraction(high), 1))
    refuted = 0
    for _ in range(40):
        points, forces = wavy(random, (low, high))
        kept = forces[0] <= 0 <= forces[-1]
        spring = zw.NonlinearSpring(points.tolist(), forces.tolist())
        grid = np.linspace(points[0], points[-1], 2001)
        stored = -min(potential(points, forces, x) for x in grid[::20]) + 0.5
        far = 10 * (stored + 40) / max(abs(forces[0]), abs(forces[-1]), 0.1)
        best = max(slow_gain(points, forces, 0.0, side * far, need) for side in (-1, 1))
        if kept:
            assert zw.coupling.SlopeBounds.of(spring).bounded_below
            assert max(slow_gain(points, forces, 0.0, x, need) for x in grid[::100]) <= stored
            assert best <= stored
        else:
            with pytest.raises(InputError, match="leads away"):
                zw.coupling.SlopeBounds.of(spring)
            refuted += best > 3 * stored
    assert refuted >= 10
