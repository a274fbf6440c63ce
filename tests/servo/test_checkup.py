"""`zw.servo.doctor`: lateness, what it costs in stiffness and what to change, in one report."""

import json
from fractions import Fraction

import numpy as np
import pytest

import zwidth as zw
from zwidth.errors import InputError
from zwidth.machine.servo import checkup as module
from zwidth.machine.servo.checkup import doctor
from zwidth.machine.servo.lateness import Lateness, Measured, stiffness_cost
from zwidth.machine.servo.priority import Answer, Granted
from zwidth.quantity.answered import data_of

YES = Granted((Answer("priority", True, "SCHED_FIFO 40"), Answer("memory", True, "all")))
NO = Granted((Answer("priority", False, "SCHED_FIFO 40: not permitted"), Answer("memory", False, "8 MiB")))
SLOW = np.full(1000, 80e-6)
PULSES = zw.PulseTransferFunction(numerator=[3, -1], denominator=[1, 0])
FAST = np.concatenate([np.full(997, 2e-7), np.full(3, 30e-6)])


@pytest.fixture
def machine(monkeypatch):
    """A machine that is as late as the test says; what was asked of it."""
    asked = {}

    def put(real_time=True):
        ordinary = Lateness(SLOW, 4, 0.0, NO)
        best = Lateness(FAST, 0, 5e-5, YES) if real_time else None

        def measure(period, duration, **more):
            asked.update(period=period, duration=duration, **more)
            return Measured(ordinary, best, YES if real_time else NO)

        monkeypatch.setattr(module, "measure_lateness", measure)
        return asked

    return put


def test_the_cost_is_that_of_the_loop_as_it_would_be_served(machine):
    """With real-time priority where it is granted, else without; K = 2 b/T of a spring."""
    device = zw.Device(damping="0.35", rate="2 kHz", name="wheel")
    machine()
    found = doctor(device, duration=2)
    assert found.cost.lateness == 30e-6
    assert found.cost.longer_period == pytest.approx(0.7 / 530e-6)
    machine(real_time=False)
    found = doctor(device, duration=2)
    assert found.cost.lateness == 80e-6
    assert found.cost.longer_period == pytest.approx(0.7 / 580e-6)
    assert "real-time priority was not granted: SCHED_FIFO 40: not permitted" in repr(found)


def test_the_period_is_given_or_of_the_device_or_a_millisecond(machine):
    """In this order; and what is given is that of the device as well."""
    asked = machine()
    device = zw.Device(damping="0.35", rate="2 kHz")
    doctor(duration=3)
    assert (asked["period"], asked["duration"]) == (1e-3, 3)
    doctor(device, duration=1)
    assert asked["period"] == 5e-4
    found = doctor(device, zw.Wall(stiffness=7), sample_period="4 ms", duration=4)
    assert asked["period"] == 4e-3
    assert found.cost.nominal == pytest.approx(0.7 / 4e-3)


def test_what_is_saved_has_a_unit_in_every_key(machine, tmp_path):
    """And says the same as the report; without a device there is no cost."""
    machine()
    found = doctor(duration=1)
    found.save(tmp_path / "found.json")
    told = json.loads((tmp_path / "found.json").read_text())
    assert told["format"] == "zwidth doctor 1"
    assert told["ordinary"]["lateness_s"]["of_99_percent"] == 80e-6
    assert told["real_time"]["lateness_s"]["of_99_9_percent"] == 30e-6
    assert (told["real_time"]["missed"], told["cost"]) == (0, None)
    assert {finding["about"] for finding in told["findings"]} >= {"kernel", "load", "clock"}
    assert "99.9 %" in repr(found)


def test_the_picture_shows_every_step_of_both(machine, tmp_path):
    machine()
    found = doctor(duration=1)
    figure = found.plot(tmp_path / "late.png")
    (axes,) = figure.axes
    assert (axes.get_xscale(), axes.get_yscale()) == ("log", "log")
    steps = [patch.get_path().vertices[:, 1].max() for patch in axes.patches]
    assert max(steps) == 1000
    assert (tmp_path / "late.png").stat().st_size > 0


@pytest.mark.parametrize(
    ("arguments", "said"),
    [
        ({"sample_period": "10 us"}, "sample_period must be ≥ 20 µs"),
        ({"duration": "0.9 s"}, "duration must be ≥ 1 s, got 900 ms"),
        ({"environment": zw.Wall(stiffness=1)}, "give one as well"),
        ({"device": zw.Device(damping=1, rate=1000), "environment": PULSES}, "has none: name a wall"),
    ],
)
def test_what_cannot_be_told_is_refused_before_the_wait(arguments, said, monkeypatch):
    def never(*_, **__):
        raise AssertionError

    monkeypatch.setattr(module, "measure_lateness", never)
    with pytest.raises(InputError, match=said):
        doctor(**arguments)


def test_it_measures_this_machine():
    found = doctor(sample_period="1 ms", duration="1 s")
    for lateness in (found.ordinary, found.real_time):
        if lateness is not None:
            assert 0 < len(lateness.late) <= 1000
            assert (lateness.late >= 0).all()


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
    device = zw.Device(damping="0.2", rate="1 kHz", motion="rotary")
    found = stiffness_cost(device, zw.Wall(stiffness=1), 1e-4)
    document = data_of(found)
    assert set(document["max_stiffness_N_m_per_rad"]) == {"nominal", "longer_period", "later_force"}
    assert document["lateness_s"] == 1e-4
    assert document["any_stiffness"] == []
    assert "N·m/rad" in str(found.table())
