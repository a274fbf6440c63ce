"""Observer and controller of passivity: by plain loops, on a published plant, what they owe and to whom."""

import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st
from prescribed import follow, wandering

import zwidth as zw
from zwidth.model.rendering import PassivityController

PADDLE = zw.catalogue.device("haptic-paddle")
COURSE = zw.Device(
    mass="0.04",
    damping="0.8",
    coulomb_friction=0,
    resolution="61.36e-6",
    sample_period="0.001",
    force_limit=2,
)
"""The plant of a public course laboratory; its hand is a spring of 400 N/m that pulls from −1 mm to 3 mm."""


def course(law):
    """1.5 s of the course's touch: peak depth, peak to peak over the last 0.5 s [mm], energy [mJ]."""
    hand = zw.operators.Tracking([0.003], mass=0, stiffness=400, damping=0)
    trace = zw.simulate(COURSE, law, hand, 1.5, initial_position=-0.001)
    x = trace["position"].values * 1e3
    return x.max(), np.ptp(x[-500:]), float(trace["actuator_work"].max()) * 1e3


def test_the_course_plant():
    """As published, with Euler steps: 33.53 mm and ≤ 0.01; 1.66 and 17.6 mJ; 0.08 with 0.8 N·s/m at most."""
    peak, tail, _ = course(zw.Wall(400))
    assert peak == pytest.approx(3.53, abs=0.02)
    assert tail <= 0.01
    _, tail, energy = course(zw.Wall(2500))
    assert tail == pytest.approx(1.66, rel=0.05)
    assert energy == pytest.approx(17.6, rel=0.06)
    _, tail, energy = course(zw.render(zw.Wall(2500), PassivityController(largest_damping="0.8")))
    assert tail <= 0.1
    assert energy < 1.5


def test_the_published_observer_misses_the_leak_of_the_hold():
    """It pairs a force with the move before it: of the 18 mJ it sees nothing."""
    law = zw.render(zw.Wall(2500), PassivityController(observer="published", largest_damping="unlimited"))
    assert course(law) == course(zw.Wall(2500))


OPTIONS = {
    "plain": {},
    "unlimited": {"largest_damping": "unlimited"},
    "past": {"observer": "past"},
    "past, limited": {"observer": "past", "largest_damping": "0.07"},
    "past, unlimited": {"observer": "past", "largest_damping": "unlimited"},
    "published": {"observer": "published"},
    "limited": {"largest_damping": "0.3", "largest_force": "0.4"},
    "slow": {"slowest": "0.02"},
    "credited": {"credit": True},
    "spring": {"reference": "spring"},
    "resets": {"resets": True},
    "ceiling": {"ceiling": "0.00001"},
    "forgets": {"forgetting": "0.004"},
    "all": {"credit": True, "resets": True, "ceiling": 0, "slowest": "0.01", "largest_damping": 1},
}


@pytest.mark.parametrize("name", OPTIONS)
def test_it_does_what_a_plain_loop_does(name):
    options = OPTIONS[name]
    law = zw.render(zw.Wall(1500), PassivityController(**options))
    hand = zw.operators.MaliciousTouch(speed=0.4)
    trace = zw.simulate(PADDLE, law, hand, 0.4, amplifier=zw.amplifiers.Ideal())
    read = trace["measured_position"].values
    np.testing.assert_allclose(
        trace["commanded_force"].values, list(plain(read, 1500.0, **options)), rtol=1e-9, atol=1e-12
    )


def plain(
    readings,
    stiffness,
    observer="sampled",
    largest_damping=0.15,
    largest_force=1e300,
    slowest=0,
    credit=False,
    reference="zero",
    resets=False,
    ceiling=1e300,
    forgetting=None,
):
    """The law once more, written down as its docstring has it."""
    period, b, f_c = 0.001, 0.15, 0.12
    before, force_before, energy, added_before, moved_before = readings[0], 0.0, 0.0, 0.0, 0.0
    for x in readings:
        moved = x - before
        wall = stiffness * x if x > 0 else 0.0
        if forgetting is not None and energy > 0:
            energy *= np.exp(-period / float(forgetting))
        friction = f_c * abs(moved) + b / period * moved**2 if credit else 0.0
        if observer == "published":
            energy += wall * moved + added_before * moved_before + friction
            ahead = energy
        else:
            energy += force_before * moved + friction
            ahead = energy + (wall * moved if observer == "sampled" else 0.0)
        if resets and wall == 0:
            energy = ahead = 0.0
        energy, ahead = min(energy, float(ceiling)), min(ahead, float(ceiling))
        target = stiffness / 2 * max(x, 0) ** 2 if reference == "spring" else 0.0
        added = 0.0
        if target > ahead and abs(moved) > float(slowest) * period:
            alpha = np.inf if largest_damping == "unlimited" else float(largest_damping)
            most = min(alpha * abs(moved) / period, float(largest_force))
            added = np.sign(moved) * min((target - ahead) / abs(moved), most)
        before, force_before, added_before, moved_before = x, wall + added, added, moved
        yield wall + added


@pytest.mark.parametrize("stiffness", [300, 800, 2000, 5000])
@pytest.mark.parametrize(
    "hand", [zw.operators.TypicalTouch(), zw.operators.MaliciousTouch(), zw.operators.Dowel()]
)
def test_against_hands_of_some_mass_it_owes_one_sample_at_most(hand, stiffness):
    """Without a limit, where the next move is about the last one: minus the work of one sample at worst."""
    law = zw.render(zw.Wall(stiffness), PassivityController(largest_damping="unlimited"))
    trace = zw.simulate(PADDLE, law, hand, 1.0)
    moves = np.diff(trace["position"].values)
    sample = np.abs(trace["actuator_force"].values[:-1] * moves).max()
    assert float(trace["actuator_work"].max()) <= sample


def test_a_hand_that_turns_back_in_time_takes_energy_out():
    """The controller pays for a move that does not come; without it the wall is passive and proved so."""
    assert zw.check(PADDLE, zw.Wall(300)).outcome == "passive"
    path = np.tile([0.0, 0.7e-3], 300)
    hand = zw.operators.PrescribedMotion(path)
    for law, gains in (
        (zw.Wall(300), False),
        (zw.render(zw.Wall(300), PassivityController(largest_damping="unlimited")), True),
        (zw.render(zw.Wall(300), PassivityController()), False),
        (zw.render(zw.Wall(300), PassivityController(largest_damping="0.3")), True),
    ):
        trace = zw.simulate(PADDLE, law, hand, 0.599, amplifier=zw.amplifiers.Ideal())
        work = trace["hand_work"].values
        assert bool(work[-1] < work[-101]) is gains


def test_a_row_of_laws_is_one_environment():
    one = zw.render(zw.Wall(300), PassivityController())
    two = zw.render(one, PassivityController(largest_force=1))
    assert len(two.laws) == 2
    assert two.environment == zw.Wall(300)
    assert "at most 1 N" in two.describe()
    assert two.unilateral


B, T, K = 0.2, 1e-3, 1700.0
DEVICE = zw.Device(mass="0.05", damping=B, coulomb_friction=0, resolution=0, sample_period="0.001")
UNLIMITED = PassivityController(observer="past", largest_damping="unlimited")


def debts(trace):
    """D_k, what has come out in all at each sample [J]; Δx_{k+1}; what the wall gives in that move [J]."""
    x = trace.position.values
    debt, moves = np.maximum(trace.actuator_work.values, 0.0), np.diff(x)
    return debt, moves, np.maximum(-K * np.maximum(x[:-1], 0.0) * moves, 0.0)


def test_at_a_steady_speed_it_absorbs_exactly_what_came_out():
    """Out of the wall: the debt is what the wall gave in the last sample, to rounding, and then none."""
    out = 2e-3 - 3e-4 * np.arange(20)
    trace = follow(DEVICE, zw.render(zw.Wall(K), UNLIMITED), np.concatenate([[-1e-3], out]))
    debt, _, given = debts(trace)
    assert debt[1] == 0  # the leap in was from outside: it cost nothing, and left no credit
    np.testing.assert_allclose(debt[2:], given[1:], rtol=1e-9, atol=1e-15)
    assert (given[1:7] > 1e-5).all()
    assert (debt[10:] <= 1e-15).all()


paths = st.lists(st.floats(-1, 1), min_size=3, max_size=60).map(lambda v: 4e-3 * np.array(v))
speeds = st.lists(st.floats(0.05, 1), min_size=3, max_size=60).map(lambda v: 3e-3 - np.cumsum(v) * 3e-4)


@settings(max_examples=100, deadline=None)
@given(speeds)
def test_while_a_hand_keeps_its_direction_it_owes_less_and_less(positions):
    """D_{k+1} ≤ max(0, 1 − r) D_k + what the wall gives in the move, r = Δx_{k+1}/Δx_k ≥ 0; no limit."""
    debt, moves, given = debts(follow(DEVICE, zw.render(zw.Wall(K), UNLIMITED), positions))
    # the first move is made before anything was measured, and what the spring held at the start is its own
    ratio = moves[1:] / moves[:-1]
    bound = np.maximum(1 - ratio, 0) * debt[1:-1] + given[1:]
    assert (debt[2:] <= bound + 1e-12 * (debt.max() + given.max())).all()


@settings(max_examples=100, deadline=None)
@given(paths)
def test_by_default_a_turn_costs_no_more_than_the_limit(positions):
    """For every hand D_{k+1} ≤ D_k + what the wall gives, and where it turns + b |Δx_k Δx_{k+1}|/T."""
    law = zw.render(zw.Wall(K), PassivityController(observer="past"))
    debt, moves, given = debts(follow(DEVICE, law, positions))
    turned = np.minimum(moves[1:] * moves[:-1], 0.0)
    bound = debt[1:-1] + given[1:] - B / T * turned
    assert (debt[2:] <= bound + 1e-12 * (debt.max() + given.max() + 1e-6)).all()


def test_nothing_wider_is_so_where_the_hand_turns():
    """Outside the wall the controller acts alone: D_{k+1} = (1 + |r|) D_k in each turn, without a limit."""
    path = np.concatenate([[-1e-3, 2e-3, -1e-3], -1e-3 - 4e-4 * (np.arange(20) % 2 == 0)])
    debt, moves, given = debts(follow(DEVICE, zw.render(zw.Wall(K), UNLIMITED), path))
    ratio = np.abs(moves[3:] / moves[2:-1])
    assert (given[3:] == 0).all()
    np.testing.assert_allclose(debt[4:], (1 + ratio) * debt[3:-1], rtol=1e-9)
    assert debt[-1] > 1e5 * debt[3]


def published(positions, damping):
    """Hannaford & Ryu (2002), series: force and velocity of the same sample; α is paid a sample later."""
    before, paid, energy = positions[0], 0.0, 0.0
    for x in positions:
        velocity = (x - before) / T
        force = K * x + damping * velocity if x > 0 else 0.0
        energy += T * (force * velocity + paid)
        alpha = -energy / (T * velocity**2) if energy < 0 and velocity != 0 else 0.0
        before, paid = x, alpha * velocity**2
        yield force + alpha * velocity


def test_the_published_law_is_as_it_was_published():
    """Unlimited, before a wall whose negative damping it does see: to 1e-13 of the largest force."""
    positions, wall = wandering(), zw.Wall(K, damping="-1.5")
    law = PassivityController(observer="published", largest_damping="unlimited")
    trace = follow(DEVICE, zw.render(wall, law), positions)
    expected = np.array(list(published(positions, -1.5)))
    np.testing.assert_allclose(trace.commanded_force, expected, rtol=0, atol=1e-13 * np.abs(expected).max())
    alone = follow(DEVICE, wall, positions).commanded_force
    assert np.abs(expected - alone).max() > 1e-2
