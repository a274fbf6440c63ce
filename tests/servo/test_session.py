"""A device served: what it is given, when the force ends, and what is refused."""

import dataclasses
import math
import time

import numpy as np
import pytest
import scipy.signal
from played import Library, Played

import zwidth as zw
from zwidth.machine.servo import Placement, Safety, Servo, loop, proving
from zwidth.machine.servo.connection import CLOSED, GARBLED, REFUSED, SILENT, STALE
from zwidth.machine.servo.devices import Simulated

pytestmark = pytest.mark.real_time

T = 1e-3
PADDLE = zw.catalogue.device("haptic-paddle").replace(force_limit=None)
SOFT = zw.Wall(stiffness=300)
INSIDE = np.concatenate([np.full(20, -1e-3), np.linspace(-1e-3, 5e-3, 60), np.full(320, 5e-3)])
"""From outside into the wall, and staying there."""


def at_once(device, law):
    """The verdict of a loop without delay, whatever this machine is like just now."""
    return zw.check(PADDLE, law)


def served(connection, law=SOFT, change=None, anyway=False, duration=None, **arguments):
    with Servo(PADDLE, law, connection, decide=at_once, **arguments) as servo:
        servo.measure("20 ms")
        servo.start(duration, anyway=anyway)
        if change is not None:
            change(servo)
        servo.wait()
    return servo


def until(servo, rows):
    while servo.running and servo.rows.count < rows:
        time.sleep(1e-3)


def column(servo, name):
    return servo.rows.after(0)[1][:, servo.rows.column(name)]


def test_force_pushes_out_of_the_wall_and_never_outside():
    """Along the device's axis the force is −K x inside, 0 outside."""
    device = Played(INSIDE)
    servo = served(device)
    taken = column(servo, "sample")[column(servo, "phase") == 2].astype(int)
    wanted = -300 * np.maximum(INSIDE[taken], 0)
    step = float(PADDLE.exact("force_resolution"))
    assert np.abs(device.forces[taken] - wanted).max() <= step / 2 + 1e-12
    assert column(servo, "phase")[-1] == 3
    assert servo.report().ended == "ended, since the time was over"
    assert not servo.report().failed
    said = {0.0: "At no time", -0.002: "At some time the hand may have got 2 mJ more", None: "is not known"}
    for least, words in said.items():
        report = dataclasses.replace(servo.report(), least=least)
        assert words in " ".join(map(str, report.report()))


def test_wall_lies_where_it_is_placed():
    """With sense −1 and an origin the wall is at smaller readings, and pushes towards greater ones."""
    device = Played(0.2 - INSIDE)
    served(device, placement=Placement(origin=0.2, sense=-1))
    assert device.forces.max() == pytest.approx(1.5, abs=1e-3)
    assert device.forces.min() == 0


@pytest.mark.parametrize("status", [SILENT, GARBLED, STALE])
def test_one_sample_without_a_good_answer_is_bridged(status):
    device = Played(INSIDE, bad={150: status})
    servo = served(device)
    assert device.forces[150] == device.forces[149] != 0
    assert device.forces[151] != 0
    assert servo.report().held == 1
    assert not servo.report().failed


@pytest.mark.parametrize(
    ("bad", "held"),
    [
        ({150: SILENT, 151: SILENT}, 1),
        ({150: GARBLED, 151: STALE}, 1),
        ({150: REFUSED}, 0),
        ({150: CLOSED}, 0),
    ],
)
def test_force_ends_where_the_device_is_lost(bad, held):
    """Within two samples the force is 0, and stays it although the device answers again."""
    device = Played(INSIDE, bad=bad)
    servo = served(device)
    assert device.forces[149] != 0
    assert np.count_nonzero(device.forces[150:]) == held
    assert servo.report().failed
    assert device.closed


@pytest.mark.parametrize("reading", [math.nan, math.inf, 0.5, -0.5])
def test_an_absurd_reading_ends_the_force_at_once(reading):
    readings = INSIDE.copy()
    readings[150] = reading
    device = Played(readings)
    servo = served(device)
    assert not device.forces[150:].any()
    assert servo.report().failed


def test_bridged_samples_allow_for_a_longer_way():
    """After a bridged sample the hand may have moved for two periods."""
    readings = np.concatenate([np.full(50, -0.05), [-0.042, -0.034], np.full(50, -0.034)])
    servo = served(Played(readings, bad={50: SILENT}), safety=Safety(speed=9))
    assert not servo.report().failed
    readings[51:] = -0.03
    servo = served(Played(readings, bad={50: SILENT}), safety=Safety(speed=9))
    assert servo.report().failed


@pytest.mark.parametrize("outside", [False, True])
def test_loop_that_was_held_up_gives_no_force_after(outside):
    """Beyond the longest gap none is taken up again, nor begun: the hand may be deep in the wall by now."""
    readings = np.concatenate([np.full(151, -1e-3), np.full(400, 2e-2)]) if outside else INSIDE
    device = Played(readings, paused=(150, 0.08))
    servo = served(device)
    first = int(column(servo, "sample")[column(servo, "sample") > 150][0])
    assert not device.forces[0 if outside else first :].any()
    assert servo.report().missed >= 70
    assert "did not run for too long" in servo.report().ended


def test_a_short_hold_up_is_missed_samples_only():
    """Deadlines are absolute: after a pause the samples go on where they would have been."""
    device = Played(INSIDE, paused=(150, 0.0055))
    servo = served(device, safety=Safety(longest_gap="1 s"))
    assert servo.report().missed >= 4
    assert device.forces[170] != 0
    numbers = column(servo, "sample")
    assert (np.diff(numbers) >= 1).all()
    late = column(servo, "late_s")
    assert late.min() >= 0
    assert late.max() < T


def test_program_that_hangs_is_noticed(monkeypatch):
    monkeypatch.setattr(loop, "_beat", lambda loop, ended: None)
    device = Played(np.concatenate([INSIDE, np.full(2000, 5e-3)]))
    servo = served(device, safety=Safety(host_timeout="0.5 s"))
    assert device.forces.any()
    assert not device.forces[600:].any()
    assert "program around the loop did not run" in servo.report().ended


def test_force_and_its_change_are_cut():
    device = Played(INSIDE)
    servo = served(device, safety=Safety(force=1, slew=20))
    given = column(servo, "force_N")[column(servo, "phase") == 2]
    numbers = column(servo, "sample")[column(servo, "phase") == 2]
    assert given.max() == 1
    assert (np.abs(np.diff(given)) <= 0.02 * np.diff(numbers) + 1e-12).all()
    assert servo.report().cut == np.count_nonzero(column(servo, "limited")) > 50


def test_law_begins_outside_alone():
    readings = np.concatenate([np.full(60, 5e-3), np.linspace(5e-3, -1e-3, 40), INSIDE])
    device = Played(readings)
    servo = served(device)
    begins = int(column(servo, "sample")[column(servo, "phase") == 2][0])
    assert begins > 90
    assert not device.forces[: begins - 1].any()
    assert device.forces[-1] < -1


def test_law_changes_when_the_hand_is_outside():
    """A new law waits while the hand is inside, the old one is served; it begins without a jump."""
    out = np.linspace(5e-3, -1e-3, 60)
    device = Played(np.concatenate([INSIDE, np.full(400, 5e-3), out, INSIDE]))

    def change(servo):
        until(servo, 120)
        assert servo.change(zw.Wall(stiffness=200)).outcome == "passive"
        with pytest.raises(zw.InputError, match="another law waits to begin"):
            servo.change(zw.Wall(stiffness=400))

    servo = served(device, change=change)
    law, f, x = (column(servo, name) for name in ("law", "force_N", "position_m"))
    began = int(np.flatnonzero(law == 1)[0])
    assert x[began] <= 0
    assert f[began] == f[began - 1] == 0
    assert f[law == 0].max() == pytest.approx(1.5, abs=1e-3)
    assert f[law == 1].max() == pytest.approx(1.0, abs=1e-3)
    assert servo.report().laws == 2


def test_what_is_not_proved_passive_is_refused():
    hard = zw.Wall(stiffness=900)
    with pytest.raises(proving.NotProved, match="active") as refused:
        served(Played(INSIDE), hard)
    assert refused.value.verdict.outcome == "active"

    def change(servo):
        until(servo, 5)
        with pytest.raises(proving.NotProved):
            servo.change(hard)

    served(Played(INSIDE), change=change)
    device = Played(INSIDE)
    served(device, hard, anyway=True)
    assert device.forces.min() == pytest.approx(-4.5, abs=1e-3)


def test_delay_of_the_protocol_is_in_the_verdict():
    """A wall that is passive at once is refused where its force travels with the next question."""

    class Late(Library):
        late = 1

    wall = zw.Wall(stiffness=190)
    with Servo(PADDLE, wall, Late([-1e-3])) as servo:
        servo.measure("50 ms")
        assert servo.judge().outcome == "active"
    with Servo(PADDLE, zw.Wall(stiffness=2), Late([-1e-3])) as servo:
        servo.measure("50 ms")
        assert servo.judge().outcome == "passive"
    assert zw.check(PADDLE, wall).outcome == "passive"


def test_energy_is_that_of_the_rows():
    """Given out −Σ f Δx; taken by friction at least Σ b Δx²/Δt + f_c |Δx|."""
    servo = served(Played(INSIDE))
    x, f, t = (column(servo, name) for name in ("position_m", "force_N", "time_s"))
    moved, took = np.diff(x), np.diff(t)
    out = -np.cumsum(f[:-1] * moved)
    b, f_c = float(PADDLE.exact("damping")), float(PADDLE.exact("coulomb_friction"))
    lost = np.cumsum(b * moved**2 / took + f_c * np.abs(moved))
    live = column(servo, "phase")[1:] == 2
    assert column(servo, "energy_out_J")[1:][live] == pytest.approx(out[live], abs=1e-15)
    assert column(servo, "friction_loss_J")[1:][live] == pytest.approx(lost[live], rel=1e-12)


def test_library_in_python_is_served_alike():
    device = Library(np.concatenate([np.full(20, -1e-3), INSIDE]))
    served(device, duration="150 ms")
    assert min(device.forces) == pytest.approx(-1.5, abs=1e-3)
    assert device.forces[-3:] == [0, 0, 0]


def test_a_cable_that_is_out_is_a_line_that_closed():
    device = Library(INSIDE, fails=120)
    servo = served(device, duration="1 s")
    assert device.forces[-3:] == [0, 0, 0]
    assert min(device.forces) < -1
    assert "the other side has closed" in servo.report().ended
    assert servo.report().failed


class Mistaken(Library):
    def measure(self, until):
        if self.asked == 120:
            raise ZeroDivisionError
        return super().measure(until)


def test_exception_of_a_library_ends_in_no_force():
    device = Mistaken(INSIDE)
    with Servo(PADDLE, SOFT, device, decide=at_once) as servo:
        servo.measure("10 ms")
        servo.start("1 s")
        with pytest.raises(ZeroDivisionError):
            servo.wait()
    assert device.forces[-1] == 0
    assert min(device.forces) < -1
    assert servo.report().failed


def test_exception_of_the_program_ends_in_no_force():
    device, left = Played(np.concatenate([INSIDE, np.full(5000, 5e-3)])), []

    def fail(servo):
        left.append(servo)
        until(servo, 150)
        raise ZeroDivisionError

    with pytest.raises(ZeroDivisionError):
        served(device, change=fail)
    (servo,) = left
    last = int(column(servo, "sample")[-1])
    assert not device.forces[last - 2 : last + 1].any()
    assert "failed" in servo.report().ended


@pytest.mark.parametrize(
    ("device", "law", "operator"),
    [
        (PADDLE, zw.Wall(stiffness=300, damping="0.02"), zw.operators.Finger()),
        (PADDLE.replace(delay="0.0013"), zw.Wall(stiffness=30), zw.operators.Finger(force=3)),
        (PADDLE.replace(resolution=0), zw.Maxwell(stiffness=200, damping=5), zw.operators.Dowel(force=4)),
        (
            PADDLE.replace(rate=2000),
            zw.render(zw.Wall(stiffness=600), zw.rendering.PassivityController()),
            zw.operators.Dowel(force=4),
        ),
    ],
)
def test_served_touch_is_the_simulated_one_to_the_last_bit(device, law, operator):
    simulated = Simulated(device=device, hand=operator, duration="0.6 s")
    with Servo(device, law, simulated) as servo:
        servo.start(anyway=True)
        servo.wait()
    told = servo.rows.after(0)[1]
    rows = {
        name: told[told[:, servo.rows.column("phase")] == 2, i] for i, name in enumerate(servo.rows.COLUMNS)
    }
    taken = rows["sample"].astype(int)
    late, missed = np.zeros(simulated.samples + 1), np.ones(simulated.samples + 1, bool)
    late[taken], missed[taken] = rows["late_s"], False
    trace = zw.simulate(
        device, law, simulated.scripted, "0.6", timing=zw.simulation.Timing(lateness=late, missed=missed)
    )
    energies = ("hand_work", "actuator_work", "viscous_loss", "coulomb_loss", "hand_source_work")
    again = {
        "true_position_m": "position",
        "true_velocity_m_per_s": "velocity",
        "position_m": "measured_position",
        "force_N": "commanded_force",
        **{f"{name}_J": name for name in energies},
    }
    assert taken.size > 500
    for served_name, simulated_name in again.items():
        assert np.array_equal(rows[served_name], trace[simulated_name].values[taken]), served_name


OUTSIDE = np.full(600, -1e-3)
TOUCH = np.concatenate([np.full(300, -1e-3), np.linspace(-1e-3, 2e-3, 100), np.full(200, 2e-3)])


def test_another_run_serves_the_law_that_was_judged_last():
    with Servo(PADDLE, zw.Wall(stiffness=5000), Played(TOUCH), decide=at_once) as servo:
        servo.measure("20 ms")
        servo.start(anyway=True)
        while servo.running and not servo.report().laws:
            time.sleep(1e-3)
        servo.change(zw.Wall(stiffness=200))
        servo.stop()
        servo.wait()
        servo.measure("20 ms")
        servo.start()
        servo.wait()
        assert column(servo, "force_N").max() == pytest.approx(0.4, abs=1e-3)
        assert servo.report().title.startswith("wall, 200 N/m")


def test_report_speaks_of_the_law_that_began():
    """A law that still waits has given no force: its verdict is not that of what was served."""

    def change(servo):
        until(servo, 420)
        servo.change(zw.Wall(stiffness=200))

    found = served(Played(TOUCH), zw.Wall(stiffness=5000), change, anyway=True).report()
    assert found.laws == 1
    assert found.verdict is not None
    assert found.verdict.outcome == "active"
    assert found.title.startswith("wall, 5000 N/m")


def test_law_is_judged_by_the_last_measurement():
    """Measured again, nothing is served with a proof from before."""
    judged = []

    def decide(device, law):
        judged.append(device)
        return zw.check(PADDLE, law)

    with Servo(PADDLE, SOFT, Played(OUTSIDE), decide=decide) as servo:
        servo.measure("20 ms")
        servo.prove()
        before = len(judged)
        servo.measure("20 ms")
        servo.prove()
        assert len(judged) == 2 * before


def test_one_loop_at_a_time_and_none_after_the_end():
    with Servo(PADDLE, SOFT, Played(OUTSIDE), decide=at_once) as servo:
        servo.measure("20 ms")
        servo.start()
        with pytest.raises(zw.InputError, match="runs already"):
            servo.measure("20 ms")
        servo.wait()
        with pytest.raises(zw.InputError, match="measure again"):
            servo.start()
    for use in (servo.measure, servo.start):
        with pytest.raises(zw.InputError, match="let go"):
            use()


@pytest.mark.parametrize("status", [CLOSED, REFUSED])
def test_measurement_that_a_fault_cut_short_is_none(status):
    """Of five samples no share of 99 % is known."""
    with (
        Servo(PADDLE, SOFT, Played(OUTSIDE, bad=dict.fromkeys(range(5, 100), status))) as servo,
        pytest.raises(zw.InputError, match="could not be measured"),
    ):
        servo.measure("90 ms")
    assert servo.measured is None


def test_a_law_without_a_number_ends_the_force():
    """An unstable law that was served all the same grows beyond all numbers; what is given stays finite."""
    diverging = scipy.signal.dlti([1.0, 0.0], [1.0, -10.0], dt=T)
    device = Played(np.concatenate([np.zeros(50), np.full(700, 1e-3)]))
    servo = served(device, law=diverging, anyway=True, safety=Safety(force=1))
    assert np.isfinite(device.forces).all()
    assert device.forces.any()
    assert not device.forces[-10:].any()
    assert "no finite number" in servo.report().ended


def test_law_that_cannot_be_run_reaches_no_device():
    class Unopened(Played):
        def open(self, sample_period):
            raise AssertionError("opened")

    law = zw.render(SOFT, zw.rendering.HalfSamplePrediction())
    with pytest.raises(zw.InputError, match="mass"):
        Servo(PADDLE.replace(mass=None), law, Unopened(INSIDE))


def test_a_detent_begins_at_its_bottom_alone():
    """At its top the force is 0 as well, and all that it holds there would be the hand's."""
    x = np.linspace(-0.02, 0.02, 81)
    forces = 0.4 * np.sin(200 * np.pi * x) + 4 * x
    detent = zw.NonlinearSpring(x.round(6).tolist(), forces.round(6).tolist())
    top = 0.00518  # close to where the force passes 0 downwards
    away = np.linspace(top, 0.0, 60)
    device = Played(np.concatenate([np.full(100, top), away, np.zeros(100)]))
    servo = served(device, detent, safety=Safety(force=10, start_force=0.1))
    begins = int(np.flatnonzero(column(servo, "phase") == 2)[0])  # a row: a sample may have been missed
    assert abs(column(servo, "force_N")[:begins]).max() == 0
    assert abs(column(servo, "position_m")[begins]) < 0.001


def test_the_delay_that_is_judged_covers_an_interval():
    loose = PADDLE.replace(delay=("0.0001", "0.004"))
    with Servo(loose, zw.Wall(stiffness=2), Library([-1e-3])) as servo:
        servo.measure("50 ms")
        delay = servo.measured.delay(loose)
    low, high = float(delay.low), float(delay.high)
    assert 0.0001 <= low <= high
    assert high >= 0.004
