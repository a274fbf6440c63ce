"""The passivity observer and controller: by a plain loop, on a published plant, against a bad hand."""

import numpy as np
import pytest

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
