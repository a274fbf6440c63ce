"""What lateness costs in stiffness: the largest proved one as given, and with the lateness."""

from fractions import Fraction

import pytest

import zwidth as zw
from zwidth.errors import InputError
from zwidth.machine.servo.lateness import stiffness_cost
from zwidth.quantity.answered import data_of

PLAIN = {"damping": "0.35", "rate": "2 kHz"}


@pytest.mark.parametrize("late", [0.0, 17e-6, 210e-6])
def test_a_spring_loses_by_the_longer_period(late):
    """K = 2 b/T of a spring on a device without friction, delay and counts (Colgate & Schenkel 1997)."""
    found = stiffness_cost(zw.Device(**PLAIN), zw.Wall(stiffness=3), late)
    by = Fraction(round(late * 1e9), 10**9)
    assert found.nominal == pytest.approx(2 * 0.35 * 2000)
    assert found.longer_period == pytest.approx(float(2 * Fraction("0.35") / (Fraction(1, 2000) + by)))
    assert (found.later_force < found.longer_period) if late else (found.later_force == found.nominal)


@pytest.mark.parametrize("stage", ["longer_period", "later_force"])
def test_both_figures_are_limits_of_loops_that_check_knows(stage):
    """Passive at the figure, not just above it: `zwidth.check` of the device with this period and delay."""
    late = Fraction("0.000083")
    device = zw.catalogue.device("haptic-paddle")
    wall = zw.Wall(stiffness=20, damping="0.02")
    found = stiffness_cost(device, wall, float(late))
    period, delay = device.exact("sample_period") + late, device.exact("delay")
    slow = device.replace(sample_period=period, delay=delay + late * (stage == "later_force"))
    limit = getattr(found, stage)
    kept = "kept" if found.contact == "kept" else "made and broken"
    outcomes = [
        zw.check(slow, wall.replace(stiffness=limit * factor), contact=kept).outcome for factor in (1, 1.001)
    ]
    assert outcomes[0] in ("passive", "passive in contact")
    assert outcomes[1] not in ("passive", outcomes[0])


def test_a_law_without_stiffness_is_refused():
    law = zw.PulseTransferFunction(numerator=[3, -1], denominator=[1, 0])
    with pytest.raises(InputError, match="has none: name a wall"):
        stiffness_cost(zw.Device(**PLAIN), law, 1e-5)


def test_an_uncertain_period_is_refused_and_an_uncertain_friction_is_not():
    """The least friction decides; a period between two ends has no one cost."""
    wall = zw.Wall(stiffness=3)
    between = stiffness_cost(zw.Device(damping=(0.3, 0.4), rate=1000), wall, 5e-5)
    least = stiffness_cost(zw.Device(damping=0.3, rate=1000), wall, 5e-5)
    assert between == least
    with pytest.raises(InputError, match="single values"):
        stiffness_cost(zw.Device(damping=0.3, rate=(900, 1000)), wall, 5e-5)


def test_what_is_saved_has_units_and_says_what_has_no_bound():
    """JSON knows no infinity: a device without delay and a wall that is passive at any stiffness."""
    found = stiffness_cost(
        zw.Device(damping="0.2", rate="1 kHz", motion="rotary"), zw.Wall(stiffness=1), 1e-4
    )
    document = data_of(found)
    assert set(document["max_stiffness_N_m_per_rad"]) == {"nominal", "longer_period", "later_force"}
    assert document["lateness_s"] == 1e-4
    assert document["any_stiffness"] == []
    assert "N·m/rad" in str(found.table())
