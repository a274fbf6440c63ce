"""A tissue that changes under the hand: a naive wall gives out energy, this one never does."""

from __future__ import annotations

from fractions import Fraction

import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st

import zwidth as zw
from zwidth.data.tissue import AdaptiveSolid, RecursiveSolid, Solid, force_response, required_damping

DAMPING, T = 0.27, 1e-3
PHANTOM = zw.Device(damping=DAMPING, rate=1000)


def put_in(positions, forces):
    """What hand and damping have put in after each sample: f Δx + (b/T) Δx² [J]."""
    moved = np.diff(positions)
    return np.cumsum(forces[:-1] * moved + DAMPING / T * moved**2)


def naive(positions, solids):
    """The same law with the parameters of the moment put in at once."""
    e, u, forces = 0.0, 0.0, []
    for x, (mu0, mu1, eta) in zip(positions, solids, strict=True):
        now = max(x, 0.0)
        e = eta / (eta + mu1 * T) * (e + now - u)
        u = now
        forces.append(mu0 * u + mu1 * e if x > 0 else 0.0)
    return np.array(forces)


STROKE = np.concatenate([np.linspace(-1e-4, 2e-3, 400), np.linspace(2e-3, -1e-4, 400)])
STIFFER = np.where(np.arange(800)[:, None] < 400, [[100, 50, 5]], [[400, 100, 10]])


def test_a_naive_wall_gives_out_energy_although_each_frozen_wall_is_passive():
    """In against the soft tissue, out against the stiff one: 0.5 mJ, ½ Δμ0 u² less what was dissipated."""
    for mu0, mu1, eta in (STIFFER[0], STIFFER[-1]):
        assert zw.check(PHANTOM, zw.StandardLinearSolid(int(mu0), int(mu1), int(eta))).outcome == "passive"
    assert put_in(STROKE, naive(STROKE, STIFFER))[-1] < -4e-4


def test_the_adaptive_wall_gives_out_none_and_is_stiff_in_the_end():
    """The rise is bought with what is dissipated; outside it is free, so the next contact has all of it."""
    rendered = AdaptiveSolid(PHANTOM, (100, 50, 5)).render(STROKE, STIFFER)
    assert put_in(STROKE, rendered.force).min() >= 0
    at_the_turn = rendered.stiffness[400]
    assert 100 < at_the_turn < 120
    assert rendered.stiffness[-1] == 400
    assert rendered.branch_damping[-1] == pytest.approx(10)


@st.composite
def contacts(draw):
    """Moves of all sizes, in and out, and targets of all sizes, changing now and then."""
    samples = draw(st.integers(5, 60))
    size = 10.0 ** draw(st.floats(-6, -2))
    moves = draw(st.lists(st.floats(-1, 1), min_size=samples, max_size=samples))
    start = draw(st.floats(-1, 1))
    target = st.tuples(st.floats(0, 1e4), st.floats(0, 1e4), st.floats(0, 100))
    targets = draw(st.lists(target, min_size=1, max_size=8))
    every = draw(st.integers(1, 9))
    x = size * (start + np.cumsum(moves))
    return x, np.array([targets[k // every % len(targets)] for k in range(samples)])


@settings(max_examples=120, deadline=None)
@given(contacts())
def test_no_motion_and_no_change_takes_energy_out(contact):
    """For every motion, from inside too, and every sequence of targets; the wall itself stays passive."""
    positions, targets = contact
    rendered = AdaptiveSolid(PHANTOM, (100, 50, 1)).render(positions, targets)
    total = put_in(positions, rendered.force)
    moves = np.diff(positions)
    scale = max(np.abs(rendered.force[:-1] * moves).max(), DAMPING / T * (moves**2).max(), 1e-300)
    assert total.min() >= -1e-12 * len(positions) * scale
    assert rendered.energy.min() >= -1e-12 * len(positions) * scale
    needs = [required_damping(Solid(*row), T) for row in np.array(rendered[1:4]).T]
    assert max(needs) <= DAMPING * (1 + 1e-9)


def test_a_hand_that_knows_the_law():
    """Pushes, waits for the tissue to stiffen, then the leap that takes most out: nothing, 60 times."""
    for seed in range(60):
        random = np.random.default_rng(seed)
        wall = AdaptiveSolid(PHANTOM, (100, 50, 1))
        x, f, total, most = -1e-4, wall.force(-1e-4), 0.0, 0.0
        for k in range(400):
            if k % 7 == 0:
                wall.retune(tuple(10 ** random.uniform([0, 0, -3], [4, 4, 2])))
            best_leap = -f * T / (2 * DAMPING)
            move = abs(random.normal(0, 3e-4)) if k // 20 % 2 == 0 else best_leap * random.uniform(0.5, 1.5)
            total += f * move + DAMPING / T * move**2
            x += move
            f = wall.force(x)
            most = max(most, total)
            assert total >= -1e-12 * most


def test_the_account_is_what_was_put_in_and_is_not_stored():
    """E + V = put in, with V = ½ μ0 u² + ½ (μ1/a) e² of the solid of the moment, computed anew."""
    rng = np.random.default_rng(3)
    x = 1e-3 * np.sin(0.05 * np.arange(300)) + np.cumsum(rng.normal(0, 3e-5, 300)) - 1e-4
    targets = np.repeat(10 ** rng.uniform([1, 1, -1], [3.5, 3.5, 1], (30, 3)), 10, axis=0)
    rendered = AdaptiveSolid(PHANTOM, (100, 50, 1)).render(x, targets)
    total = np.append(0.0, put_in(x, rendered.force))
    u = np.maximum(x, 0)
    mu0, mu1, eta = rendered[1:4]
    decay = eta / (eta + mu1 * T)
    inside = u > 0
    e = (rendered.force - mu0 * u) / mu1
    stored = 0.5 * mu0 * u**2 + 0.5 * mu1 / decay * e**2
    assert (total - rendered.energy)[inside] == pytest.approx(stored[inside], rel=1e-8, abs=1e-15)
    assert np.count_nonzero(inside) > 100


def test_the_frozen_bound_is_reached():
    """At b = b_req one motion at the Nyquist frequency costs nothing: less damping would not do."""
    solid = Solid(200.0, 300.0, 0.05)
    need = required_damping(solid, T)
    decay = 0.05 / (0.05 + 0.3)
    # to and fro about a depth at rest, e at ±a d/(1 + a): held forces against moves of d
    d, depth = 1e-5, 1e-3
    e = decay * d / (1 + decay)
    forces = 200 * (depth + d / 2 * np.array([1, -1])) + 300 * e * np.array([1, -1])
    gained = forces[0] * -d + forces[1] * d + 2 * need / T * d**2
    assert gained == pytest.approx(0, abs=1e-12 * forces[0] * d)


def test_required_damping_is_the_closed_form():
    """And a target that asks for more is scaled down to it, its relaxation time kept."""
    solid = Solid(300.0, 150.0, 7.0)
    exact = zw.formulas.standard_linear_solid_damping(300, 150, 7, Fraction(1, 1000))
    assert required_damping(solid, T) == pytest.approx(float(exact), rel=1e-15)
    wall = AdaptiveSolid(PHANTOM, (1, 1, 1))
    scaled = wall.retune((3000, 1500, 70))
    assert required_damping(scaled, T) == pytest.approx(DAMPING, rel=1e-9)
    assert required_damping(scaled, T) <= DAMPING
    assert scaled.branch_damping / scaled.branch_stiffness == pytest.approx(70 / 1500, rel=1e-9)
    assert scaled.branch_stiffness / scaled.stiffness == pytest.approx(0.5, rel=1e-12)
    wall.force(-1.0)
    assert wall.required_damping <= DAMPING


def test_an_unchanged_solid_is_the_environment():
    """Entered from outside, never retuned: the forces of the simulator's standard linear solid."""
    t = T * np.arange(301)
    x = 1e-3 * (np.sin(60 * t - 1) + 0.4 * np.sin(333 * t)) - 2e-4
    wall = AdaptiveSolid(PHANTOM, (300, 150, 2))
    forces = [wall.force(here) for here in x]
    law, hand = zw.StandardLinearSolid(300, 150, 2), zw.operators.PrescribedMotion(x)
    trace = zw.simulate(PHANTOM.replace(mass=0.1), law, hand, 0.3, amplifier=zw.amplifiers.Ideal())
    assert forces == pytest.approx(trace.commanded_force.values, rel=1e-9, abs=1e-12)
    assert np.count_nonzero(forces) > 50


def test_an_observed_tissue_is_what_is_rendered():
    """A probe on a tissue of 120, 60 N/m and 0.1 s; the hand feels it after the next contact."""
    t = T * np.arange(20_000)
    probe = 0.006 + 0.003 * np.sin(4.4 * t) + 0.001 * np.sin(19.5 * t)
    force = force_response(zw.StandardLinearSolid(120, 60, 6), t, probe)
    force += np.random.default_rng(1).normal(0, 0.005, t.size)
    hand = 2e-3 * np.sin(9 * t)
    tracking = RecursiveSolid(T, (10, 5, 0.5), forgetting="0.9998", noise="0.005")
    wall = AdaptiveSolid(PHANTOM, (10, 5, 0.5), tracking=tracking)
    felt = []
    for x, *sample in zip(hand, probe, force, strict=True):
        wall.observe(*sample)
        felt.append(wall.force(x))
    assert tuple(wall.solid) == pytest.approx((120, 60, 6), rel=0.1)
    assert put_in(hand, np.array(felt)).min() >= 0


def test_what_is_met_inside_begins_as_nothing():
    """Nobody has paid for a spring that is there at once; outside, the first sample has all of it."""
    inside = AdaptiveSolid(PHANTOM, (100, 50, 1))
    assert inside.force(1e-3) == 0.0
    outside = AdaptiveSolid(PHANTOM, (100, 50, 1))
    outside.force(-1e-3)
    assert outside.force(1e-3) > 0.1


def test_largest_energy():
    """With no credit kept, a rise is bought from the last move alone, or waits for the contact to end."""
    walls = (AdaptiveSolid(PHANTOM, (100, 50, 5), largest_energy=most) for most in (None, 0))
    free, strict = (wall.render(STROKE, STIFFER) for wall in walls)
    assert strict.energy.max() <= 0
    assert 100 < strict.stiffness[400] < 101 < free.stiffness[400]
    assert strict.stiffness[-1] == 400


@pytest.mark.parametrize(
    ("make", "words"),
    [
        (lambda wall: AdaptiveSolid(zw.Device(damping=0, rate=1000), (1, 1, 1)), "this one has none"),
        (lambda wall: AdaptiveSolid(PHANTOM.replace(delay="0.001"), (1, 1, 1)), "proved without delay"),
        (lambda wall: AdaptiveSolid(PHANTOM, (1, 1, 1), largest_energy=-1), "largest_energy must be ≥ 0"),
        (lambda wall: wall.retune((1, -1, 1)), "≥ 0 and finite"),
        (lambda wall: wall.retune((1, float("nan"), 1)), "≥ 0 and finite"),
        (lambda wall: wall.force(float("nan")), "must be finite, got nan"),
        (lambda wall: wall.observe(0.0, 0.0), "give tracking="),
        (lambda wall: wall.render([0.0, 1.0], [[1, 1, 1]]), "give as many rows"),
    ],
)
def test_bad_input(make, words):
    with pytest.raises(zw.InputError, match=words):
        make(AdaptiveSolid(PHANTOM, (1, 1, 1)))
