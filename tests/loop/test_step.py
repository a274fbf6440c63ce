"""The exact step, alone: closed forms, stops, stiction, the ledger."""

from __future__ import annotations

import math

import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st
from mpmath import mp, mpf, quad

from zwidth.loop.plant import (
    ACTUATOR_WORK,
    COULOMB,
    DIRECTION,
    FAULT,
    FORCE,
    GOAL,
    HAND_LOSS,
    HAND_WORK,
    POSITION,
    SOURCE_WORK,
    STATE_SIZE,
    STOPS,
    VELOCITY,
    VISCOUS,
    WORK,
    Plant,
    free_response,
)
from zwidth.loop.step import advance

EPS = np.finfo(float).eps


def _plant(**given: float) -> Plant:
    numbers = {
        "mass": 0.036, "hand_mass": 0.0, "damping": 0.15, "coulomb": 0.0, "stiction": 0.0,
        "stiffness": 0.0, "hand_damping": 0.0, "lag": 0.0, "slew": 0.0,
    }  # fmt: skip
    return Plant(**{**numbers, **given})


def _state(x: float = 0.0, v: float = 0.0, f: float = 0.0, goal: float | None = None) -> np.ndarray:
    state = np.zeros(STATE_SIZE)
    state[[POSITION, VELOCITY, DIRECTION, FORCE]] = x, v, np.sign(v), f
    state[GOAL] = f if goal is None else goal
    return state


def _go(plant: Plant, state: np.ndarray, h: float, force=0.0, anchor=0.0, speed=0.0) -> np.ndarray:
    advance(state, plant, force, anchor, speed, h, np.zeros(WORK))
    assert state[FAULT] == 0.0
    return state


@pytest.mark.parametrize("z", [0.0, 1e-9, 1e-3, 0.4, 0.999999, 1.0, 1.000001, 3.7, 60.0, 900.0])
def test_the_responses_of_a_free_mass_are_right_to_rounding(z):
    """h1, h2, h3 against their integrals at 40 digits, on both sides of the change of method."""
    t = 0.0137
    with mp.workdps(40):
        rate = mpf(z / t)
        h1 = -mp.expm1(-rate * mpf(t)) / rate if rate else mpf(t)
        h2 = quad(lambda u: -mp.expm1(-rate * u) / rate if rate else u, [0, mpf(t) / 50, t])
        h3 = quad(lambda u: (-mp.expm1(-rate * u) / rate if rate else u) ** 2, [0, mpf(t) / 50, t])
        for got, true in zip(free_response(z / t, t), (h1, h2, h3), strict=True):
            assert abs(mpf(got) - true) <= 12 * EPS * true


@pytest.mark.parametrize(
    ("name", "stiffness", "damping"),
    [("under", 800.0, 0.4), ("critical", 500.0, 2.0 * math.sqrt(500.0 * 0.05)), ("over", 300.0, 40.0)],
)
def test_the_three_ways_of_damping_meet_their_textbook_forms(name, stiffness, damping):
    """A mass on spring and damper, let go: position and velocity after 0.01 to 40 ms."""
    plant = _plant(mass=0.05, damping=0.0, stiffness=stiffness, hand_damping=damping)
    for t in (1e-5, 1e-3, 7e-3, 4e-2):
        state = _go(plant, _state(x=0.004, v=0.3), t)
        with mp.workdps(40):
            s, w2 = mpf(damping) / (2 * mpf(0.05)), mpf(stiffness) / mpf(0.05)
            root = mp.sqrt(s * s - w2)
            a, b, x0, v0 = -s + root, -s - root, mpf(0.004), mpf(0.3)
            first = (v0 - b * x0) / (a - b)
            second = x0 - first
            x = mp.re(first * mp.exp(a * t) + second * mp.exp(b * t))
            v = mp.re(a * first * mp.exp(a * t) + b * second * mp.exp(b * t))
            assert abs(mpf(float(state[POSITION])) - x) < 4e-17, (name, t)
            assert abs(mpf(float(state[VELOCITY])) - v) < 4e-15 * (1 + abs(b) * t), (name, t)


def test_dry_friction_alone_stops_a_mass_after_m_v_over_f():
    """A mass sliding against Coulomb friction stops after m v²/(2 f_c), and stays."""
    plant = _plant(damping=0.0, coulomb=0.12, stiction=0.12)
    state = _go(plant, _state(v=0.3), 0.2)
    assert state[POSITION] == pytest.approx(0.036 * 0.09 / 0.24, rel=4 * EPS)
    assert state[VELOCITY] == 0.0
    assert state[STOPS] == 1
    assert state[COULOMB] == pytest.approx(0.5 * 0.036 * 0.09, rel=4 * EPS)


def test_both_frictions_stop_a_free_mass():
    """It stops after (m/b)(v₀ − (f_c/b) ln(1 + b v₀/f_c))."""
    state = _go(_plant(coulomb=0.12, stiction=0.12), _state(v=0.3), 0.2)
    way = 0.036 / 0.15 * (0.3 - 0.12 / 0.15 * math.log1p(0.15 * 0.3 / 0.12))
    assert state[POSITION] == pytest.approx(way, rel=100 * EPS)
    assert (state[VELOCITY], state[STOPS]) == (0.0, 1)


def test_stiction_holds_up_to_its_force_and_not_beyond():
    plant = _plant(coulomb=0.1, stiction=0.25)
    assert _go(plant, _state(), 0.01, force=0.25)[POSITION] == 0.0
    state = _go(plant, _state(), 0.01, force=math.nextafter(0.25, 1.0))
    free = _go(_plant(), _state(), 0.01, force=0.15)
    assert state[POSITION] == pytest.approx(free[POSITION], rel=1e-14)


def test_a_moving_anchor_breaks_the_mass_away_when_its_spring_reaches_the_stiction():
    """Rest until k u t = f_s, however the stretch is cut; then motion."""
    plant = _plant(coulomb=0.1, stiction=0.2, stiffness=100.0)
    still = _go(plant, _state(), 0.0199, speed=0.1)
    assert still[POSITION] == 0.0
    assert still[STOPS] == 0
    assert _go(plant, _state(), 0.0201, speed=0.1)[POSITION] > 0.0


def test_a_turn_is_found_even_if_both_ends_move_the_same_way():
    plant = _plant(damping=0.01, stiffness=500.0, coulomb=0.001, stiction=0.001)
    period = 2 * math.pi * math.sqrt(0.036 / 500.0)
    state = _go(plant, _state(x=0.01, v=0.05), 1.003 * period)
    assert state[STOPS] == 2
    assert state[VELOCITY] > 0.0


def test_a_grazing_stop_against_a_receding_force_is_no_turn():
    plant = _plant(damping=0.0, stiffness=100.0, mass=0.01)
    x0 = 0.01
    speed = x0 * 100.0  # the anchor's speed lifts the lowest velocity just above 0
    state = _go(plant, _state(x=0.0, v=speed * 1.000001), 0.02, anchor=0.0, speed=speed * 0.5000001)
    assert state[VELOCITY] > 0.0


@pytest.mark.parametrize("ulps", [-3, -1, 0, 1, 3, 40])
def test_a_hand_that_pushes_with_the_friction_force_waits_for_a_lagging_force(ulps):
    """At rest until F − f_a = −f_c, then M v' = F + f_c − f_a; the last digits of F make no difference."""
    friction, goal, lag, h = 0.003906, 3.0, 7e-4, 0.03125
    force = friction + ulps * np.spacing(friction)
    plant = _plant(mass=1.0, damping=0.0, coulomb=friction, stiction=friction, lag=lag)
    state = _go(plant, _state(goal=goal), h, force)
    with mp.workdps(30):
        e0 = 1 - (mpf(force) + mpf(friction)) / goal  # e^(−t/τ) when the mass breaks away
        start, e1 = -mpf(lag) * mp.log(e0), mp.exp(-mpf(h) / mpf(lag))
        speed = (mpf(force) + mpf(friction) - goal) * (h - start) + goal * mpf(lag) * (e0 - e1)
    assert state[VELOCITY] == pytest.approx(float(speed), rel=1e-13)
    assert state[STOPS] <= 1


@settings(max_examples=120, deadline=None)
@given(
    h=st.sampled_from([1e-5, 1e-3, 0.03]),
    friction=st.sampled_from([0.0, 1e-7]) | st.floats(1e-3, 1.0),
    extra=st.sampled_from([0.0, 1e-17, 0.1]),
    stiffness=st.sampled_from([0.0, 1e-3, 500.0]),
    hand_damping=st.sampled_from([0.0, 1.7]),
    drive=st.sampled_from(["ideal", "lag", "slew", "crawl"]),
    side=st.sampled_from([-1.0, 1.0]),
    ulps=st.integers(-4, 4),
    now=st.sampled_from([0.0, 0.3, -2.718]),
    speed=st.sampled_from([0.0, 0.3, -1e-4]),
    goal=st.floats(-5.0, 5.0),
)
def test_a_mass_at_the_edge_of_friction_moves_on(
    h, friction, extra, stiffness, hand_damping, drive, side, ulps, now, speed, goal
):
    """Held to the last digit: it rests, goes, or stops once more; it never stops without end."""
    plant = _plant(
        coulomb=friction, stiction=friction + extra, stiffness=stiffness, hand_damping=hand_damping,
        lag=7e-4 if drive == "lag" else 0.0, slew={"slew": 900.0, "crawl": 1e-3}.get(drive, 0.0),
    )  # fmt: skip
    edge = side * plant.stiction + now - stiffness * 0.002 - hand_damping * speed
    force = edge + ulps * np.spacing(edge)
    state = _go(plant, _state(0.0, 0.0, now, now if drive == "ideal" else goal), h, force, 0.002, speed)
    assert state[STOPS] <= 4
    assert np.isfinite(state).all()
    if friction > 1e-3 and drive == "ideal" and stiffness == 0.0:
        assert state[VELOCITY] * side >= 0.0
        assert state[POSITION] * side >= 0.0


def _typed(low: float, high: float) -> st.SearchStrategy[float]:
    """Numbers as a person types them, six decimals at most."""
    return st.floats(low, high).map(lambda value: round(value, 6))


@settings(max_examples=120, deadline=None)
@given(
    h=_typed(1e-5, 5e-2),
    mass=_typed(1e-3, 2.0),
    hand_mass=st.sampled_from([0.0, 0.006, 0.3]),
    damping=_typed(0.0, 2.0),
    coulomb=_typed(0.0, 2.0),
    extra=_typed(0.0, 1.0),
    stiffness=st.sampled_from([0.0, 1e-3, 30.0, 500.0, 2e4]),
    hand_damping=st.sampled_from([0.0, 1e-3, 1.7, 30.0]),
    drive=st.sampled_from(["ideal", "lag", "slew"]),
    x=_typed(-0.01, 0.01),
    v=_typed(-1.0, 1.0),
    force=_typed(-5.0, 5.0),
    speed=_typed(-1.0, 1.0),
    goal=_typed(-5.0, 5.0),
)
def test_both_energy_balances_close(
    h, mass, hand_mass, damping, coulomb, extra, stiffness, hand_damping, drive, x, v, force, speed, goal
):
    plant = _plant(
        mass=mass, hand_mass=hand_mass, damping=damping, coulomb=coulomb, stiction=coulomb + extra,
        stiffness=stiffness, hand_damping=hand_damping,
        lag=7e-4 if drive == "lag" else 0.0, slew=900.0 if drive == "slew" else 0.0,
    )  # fmt: skip
    state = _go(plant, _state(x, v, 0.0 if drive != "ideal" else goal, goal), h, force, 0.002, speed)
    kinetic = 0.5 * mass * (state[VELOCITY] ** 2 - v**2)
    own = 0.5 * hand_mass * (state[VELOCITY] ** 2 - v**2)
    spring = 0.5 * stiffness * ((0.002 + speed * h - state[POSITION]) ** 2 - (0.002 - x) ** 2)
    flows = state[[HAND_WORK, ACTUATOR_WORK, VISCOUS, COULOMB, SOURCE_WORK, HAND_LOSS]]
    stored = 0.5 * (mass + hand_mass) * v * v + 0.5 * stiffness * (0.002 - x) ** 2
    moved = np.abs(flows).sum() + stored
    device = kinetic - (state[HAND_WORK] + state[ACTUATOR_WORK] - state[VISCOUS] - state[COULOMB])
    hand = state[SOURCE_WORK] - (state[HAND_WORK] + spring + state[HAND_LOSS] + own)
    assert abs(device) <= 1e-12 * moved
    assert abs(hand) <= 1e-12 * moved
    assert state[[VISCOUS, COULOMB, HAND_LOSS]].min() >= -1e-18


@settings(max_examples=80, deadline=None)
@given(
    h=st.floats(1e-4, 2e-2),
    cut=st.floats(0.01, 0.99),
    stiffness=st.sampled_from([0.0, 40.0, 3e3]),
    lag=st.sampled_from([0.0, 3e-4]),
    v=st.floats(-0.5, 0.5),
    force=st.floats(-3.0, 3.0),
    speed=st.floats(-0.3, 0.3),
)
def test_a_stretch_in_two_parts_ends_where_it_ends_in_one(h, cut, stiffness, lag, v, force, speed):
    plant = _plant(coulomb=0.12, stiction=0.17, stiffness=stiffness, hand_damping=0.8, lag=lag)
    once = _go(plant, _state(v=v, goal=1.0 if lag else 0.0), h, force, 0.001, speed)
    twice = _go(plant, _state(v=v, goal=1.0 if lag else 0.0), cut * h, force, 0.001, speed)
    _go(plant, twice, h - cut * h, force, 0.001 + speed * (cut * h), speed)
    assert abs(once[POSITION] - twice[POSITION]) < 1e-15
    assert abs(once[VELOCITY] - twice[VELOCITY]) < 1e-12
