"""Two arms in one loop: the simulator's own forces, refused unless proved, both at 0 after a fault of one."""

import numpy as np
import pytest
from servo.played import Library, Played

import zwidth as zw
from zwidth.errors import InputError
from zwidth.machine.servo import loop
from zwidth.machine.servo import pair as module
from zwidth.machine.servo.connection import CLOSED, SILENT, Placement
from zwidth.machine.servo.devices.simulated import Simulated
from zwidth.machine.servo.pair import PairNotProved, PairServo
from zwidth.machine.servo.pair_law import PairLaw
from zwidth.machine.servo.priority import RealTime
from zwidth.machine.servo.safety import Safety

STEP = 22.4e-6
ARM = zw.Device(
    mass=0.036, damping=0.15, coulomb_friction=0.12, resolution=STEP, sample_period=1e-3, force_limit=5
)
PAIR = zw.Pair(
    ARM, ARM.replace(mass=0.05, damping="0.2"), stiffness=40, damping="0.01", delay=("2 ms", "3 ms")
)


@pytest.fixture(autouse=True)
def clock(monkeypatch):
    """A clock that stands still between deadlines: no sample is late; what it is added is."""
    time = [0, 0]

    def until(due, spin):
        time[0] = max(time[0], due)
        if time[1]:
            time[0], time[1] = time[0] + time[1], 0
        return 0

    for place in (module, loop):
        monkeypatch.setattr(place, "now", lambda: time[0])
    monkeypatch.setattr(loop, "until", until)
    monkeypatch.setattr(module, "await_sample", loop.await_sample.py_func)
    monkeypatch.setattr(module, "RealTime", lambda: RealTime(priority=0, memory=False))
    return time


@pytest.fixture
def _at_once(monkeypatch):
    """Served without a measurement before: the first reading of a script is that of the first sample."""
    monkeypatch.setattr(PairServo, "measure", lambda self: None)
    monkeypatch.setattr(PairServo, "judge", lambda self: zw.check(self.pair))


at_once = pytest.mark.usefixtures("_at_once")


HANDS = (zw.operators.Finger(start=0.0, speed=0.05), zw.operators.Finger(start=0.0, speed=0.02, force=0.6))


def simulated(pair):
    devices = zip((pair.leader, pair.follower), HANDS, strict=True)
    return [Simulated(device=device, hand=hand, duration=1.5) for device, hand in devices]


def seen(arms):
    """What the law is asked and gives from now on: rows of both readings and both forces."""
    rows, law = [], arms._law.forces

    def forces(x, y):
        rows.append((x, y, *law(x, y)))
        return rows[-1][2:]

    arms._law.forces = forces
    return rows


@pytest.mark.parametrize("pair", [PAIR, PAIR.replace(reflection="0.5", follower_stiffness=30)])
def test_a_served_pair_is_the_simulated_one(pair):
    """To the last bit; and its energies are W = −Σ f Δx of each arm, and b Δx²/T + f_c |Δx|, summed here."""
    wanted = zw.simulate(pair, *HANDS, 1.5)
    with PairServo(pair, *simulated(pair)) as arms:
        rows = seen(arms)
        report = arms.run("1.5 s", anyway=True)
    found = np.array(rows[: wanted.sizes["time"]]).T
    assert found.shape[1] == 1501
    for i, arm in enumerate(("leader", "follower")):
        told = wanted.sel(arm=arm)
        assert np.array_equal(found[i], told["measured_position"].values)
        assert np.array_equal(found[2 + i], told["commanded_force"].values)
    assert np.abs(found[2:]).max() > 0.1
    assert report.samples == 1501
    assert report.ended == "ended, since the time was over"
    moved, forces = np.diff(np.array(rows)[:, :2], axis=0), np.array(rows)[:-1, 2:]
    loss = (np.array([0.15, 0.2]) * moved**2 / 1e-3 + 0.12 * np.abs(moved)).sum(axis=0)
    assert report.energy_out == pytest.approx(tuple(-(forces * moved).sum(axis=0)), rel=1e-9)
    assert report.friction_loss == pytest.approx(tuple(loss), rel=1e-9)


def test_a_law_that_is_served_for_long_is_that_of_all_its_readings():
    """By the formula of `zwidth.model.pairs`, over arrays that were filled many times."""
    law = PairLaw(PAIR)
    random = np.random.default_rng(4)
    x, y = (np.cumsum(random.integers(-3, 4, 20_000)) * STEP for _ in range(2))
    found = np.array([law.forces(*both) for both in zip(x, y, strict=True)])

    def before(values, samples):
        return np.concatenate([np.full(samples, values[0]), values[: len(values) - samples]])

    def speed(values):
        return (values - before(values, 1)) / 1e-3

    there, back = before(x, 2), before(y, 3)
    leader = 40 * (x - back) + 0.01 * (speed(x) - speed(back))
    follower = 40 * (y - there) + 0.01 * (speed(y) - speed(there))
    limit = lambda f: np.clip(f, -5, 5)  # noqa: E731
    assert found[:, 0] == pytest.approx(limit(leader), abs=1e-11)
    assert found[:, 1] == pytest.approx(limit(follower), abs=1e-11)
    assert (np.abs(found) < 5).mean() > 0.1


SWING = np.round(20 * np.sin(0.03 * np.arange(200))) * STEP
REST = np.zeros(200)


def played(bad=None):
    """A pair of scripts that part slowly, and begin together."""
    return Played(SWING, bad), Played(-SWING)


def served(leader, follower, duration="0.15 s", **more):
    with PairServo(PAIR, leader, follower, **more) as arms:
        return arms.run(duration, anyway=True)


@pytest.mark.parametrize(
    ("bad", "ended", "held"),
    [
        ({60: SILENT}, "the time was over", 1),
        ({60: SILENT, 61: SILENT}, "no answer in time", 1),
        ({60: CLOSED}, "closed", 0),
    ],
)
@at_once
def test_a_fault_of_one_arm_ends_the_force_of_both(bad, ended, held):
    leader, follower = played(bad)
    report = served(leader, follower)
    assert ended in report.ended
    assert report.held == held
    assert report.failed == (ended != "the time was over")
    for connection in (leader, follower):
        assert connection.forces[50:59].all()
        assert connection.closed == 1
        if report.failed:
            assert not connection.forces[62:].any()
    if not report.failed:
        assert leader.forces[61] != 0.0


@pytest.mark.parametrize(("value", "said"), [(float("nan"), "no number"), (0.05, "jumped")])
@at_once
def test_a_reading_that_cannot_be_ends_both(value, said):
    leader, follower = played()
    follower.readings[90] = value
    report = served(leader, follower)
    assert said in report.ended
    assert not leader.forces[90:].any()
    assert leader.forces[80:90].all()


@pytest.mark.parametrize(
    ("one", "other", "ended"), [(SWING, -SWING, True), (REST, REST, True), (REST, REST + 0.01, False)]
)
@at_once
def test_a_gap_of_more_than_50_ms_ends_a_law_that_is_served_and_not_one_that_waits(one, other, ended, clock):
    """Though it gave no force: where the arms stand together the law is served, and 1 cm apart it waits."""
    leader, follower = Played(one), Played(other)
    with PairServo(PAIR, leader, follower) as arms:
        rows, law = seen(arms), arms._law.forces

        def stall(x, y):
            clock[1] = 60_000_000 if len(rows) == 70 else 0
            return law(x, y)

        arms._law.forces = stall
        report = arms.run("0.18 s", anyway=True)
    assert ("did not run" in report.ended) == ended
    assert report.missed == 60
    assert leader.forces[50:70].any() == one.any()
    assert not leader.forces[72:].any()


@at_once
def test_arms_that_begin_apart_wait_until_their_forces_are_near_0():
    """Force 0 until then; from there the law, as if both had always been there."""
    leader, follower = played()
    follower.readings = leader.readings + np.linspace(0.02, -0.02, 200)
    report = served(leader, follower, "0.199 s")
    begun = int(np.argmax(leader.forces != 0.0))
    apart = np.abs(leader.readings - follower.readings)
    begun -= begun > 0 and 40 * apart[begun - 1] <= 0.05  # the first force may be 0 exactly
    assert begun > 50
    assert (40 * apart[:begun] > 0.05).all()
    assert 40 * apart[begun] <= 0.05
    assert not leader.forces[:begun].any()
    assert not follower.forces[:begun].any()
    assert leader.forces[begun : begun + 50].any()
    assert report.samples == 200


@at_once
def test_the_safety_cuts_and_counts():
    leader, follower = played()
    report = served(leader, follower, safety=Safety(force="20 mN"))
    assert max(np.abs(leader.forces).max(), np.abs(follower.forces).max()) == pytest.approx(0.02)
    assert report.cut > 50


@at_once
def test_readings_and_forces_are_along_each_arm_s_own_axis():
    """A follower that is measured the other way round feels the same, turned round."""
    plain, turned = played(), played()
    turned[1].readings = 0.3 - turned[1].readings
    served(*plain)
    served(*turned, placements=(Placement(), Placement(origin=0.3, sense=-1)))
    assert turned[0].forces == pytest.approx(plain[0].forces, abs=1e-9)
    assert turned[1].forces == pytest.approx(-plain[1].forces, abs=1e-9)
    assert plain[1].forces.any()


def test_what_is_not_proved_is_refused_and_gives_no_force():
    stiff = PAIR.replace(stiffness=4000, damping=0)
    leader, follower = played()
    with PairServo(stiff, leader, follower) as arms:
        with pytest.raises(PairNotProved, match="this pair is not served, it is active") as refused:
            arms.run("0.1 s")
        assert refused.value.verdict.outcome == "active"
        assert not leader.forces.any()
        assert arms.run("0.1 s", anyway=True).samples == 101


def test_the_delay_that_was_measured_is_in_the_verdict(monkeypatch):
    """Of real arms: what is passive at once may not be a millisecond later."""
    asked = []

    def check(pair):
        asked.append(pair)
        return zw.check(pair)

    monkeypatch.setattr(module, "check", check)
    with PairServo(PAIR, Library([0.0]), Library([0.0])) as arms:
        arms.measured = module.measured(np.full(9, 30e-6), np.full(9, 240e-6), 0, 0)
        arms.judge()
    assert asked[0].leader.delay == asked[0].follower.delay == 240e-6
    assert asked[0].leader.sample_period == 1e-3
    assert asked[1].leader.sample_period == asked[1].follower.sample_period == pytest.approx(1.03e-3)


@pytest.mark.parametrize(
    ("make", "said"),
    [
        (lambda one, other: PairServo(ARM, one, other), "is a zwidth.Pair"),
        (
            lambda one, other: PairServo(PAIR.replace(leader=ARM.replace(rate=5000)), one, other),
            "measured and computed at one rate, got 5 kHz, 1 kHz",
        ),
        (lambda one, other: PairServo(PAIR.replace(drive_rate=10_000), one, other), "drive_rate of 10000"),
        (lambda one, other: PairServo(PAIR, one, ARM), "follower is reached by one of"),
        (lambda one, other: PairServo(PAIR, one, other, safety=Safety(slew=3)), "leave out slew"),
    ],
)
def test_what_cannot_be_served_is_refused(make, said):
    with pytest.raises(InputError, match=said):
        make(*played())


def test_an_arm_that_does_not_answer_is_told():
    leader, follower = played(dict.fromkeys(range(200), SILENT))
    with PairServo(PAIR, leader, follower) as arms, pytest.raises(InputError, match="no answer in time"):
        arms.run("0.1 s")
    assert not follower.forces.any()
    assert leader.closed == follower.closed == 1


def test_a_report_has_units_and_says_what_was_met():
    report = served(*played(), safety=Safety(start_force=1))
    told = report.to_dict()
    assert told["format"] == "zwidth served pair 1"
    assert told["samples"] == 151
    assert set(told["energy_out_J"]) == {"leader", "follower"}
    assert "emulators or simulations" in repr(report)


def test_it_is_ended_from_another_thread():
    with PairServo(PAIR, *played()) as arms:
        law = arms._law.forces
        arms._law.forces = lambda x, y: arms.stop() or law(x, y)
        report = arms.run("2.9 s", anyway=True)
    assert report.ended == "ended, since it was asked to end"
    assert report.samples < 5
    assert not report.failed
