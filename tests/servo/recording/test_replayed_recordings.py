"""A recording simulated again gives the recorded forces, and of a simulated device the trace, bit by bit."""

import numpy as np
import pytest
from recordings import paddle
from written_rows import COLUMNS, drawn

import zwidth as zw
from zwidth import InputError
from zwidth.loop.energy import ledger
from zwidth.loop.timing import Timing
from zwidth.machine.servo import Placement, Safety
from zwidth.machine.servo.devices import Simulated
from zwidth.machine.servo.recording import Recorder, read_recording, replay, touch_of, trace_of
from zwidth.machine.servo.session import Servo
from zwidth.model.rendering import Damper, ForceBounding, PassivityController, TickTime, Window, render
from zwidth.model.specification.write import written

SLOW = Safety(longest_gap="60 s", host_timeout="60 s")
"""A machine that stands still makes a loop miss samples, and does not end it."""
SAMPLES = 1500
WALL = zw.Wall(stiffness=300, damping="0.2 N*s/m")


@pytest.fixture
def save(record):
    return lambda table, device, *laws, **others: record(
        table, *({"specification": written(device, law)} for law in laws), **others
    )


def column(table, name):
    return table[:, COLUMNS.index(name)]


def touched(device, law, seed):
    """A hand goes in and out of the wall; the clock is late and misses samples: a loop would write this."""
    timing = Timing(lateness=6e-4, missed=0.04, seed=seed)
    times = 1e-3 * np.arange(SAMPLES + 1)
    hand = zw.operators.PrescribedMotion(-1e-3 * np.cos(20 * times) + 3e-3 * np.sin(7.1 * times))
    trace = zw.simulate(device, law, hand, SAMPLES * device.exact("sample_period"), timing=timing)
    taken = np.flatnonzero(timing.skipped(SAMPLES) == 0)
    table = drawn(len(taken))
    column(table, "sample")[:] = taken
    column(table, "late_s")[:] = timing.late(SAMPLES, 1e-3)[taken]
    column(table, "time_s")[:] = trace["time"].values[taken]
    column(table, "position_m")[:] = trace["measured_position"].values[taken]
    column(table, "force_N")[:] = trace["commanded_force"].values[taken]
    return table


@pytest.mark.parametrize(
    "law",
    [
        WALL,
        zw.Wall(stiffness=300, damping="0.2 N*s/m", velocity_filter=Window(samples=5)),
        render(WALL, PassivityController()),
        render(WALL, Damper(damping="0.1 N*s/m", velocity=TickTime())),
        render(zw.Wall(stiffness=3000), ForceBounding()),
    ],
    ids=["wall", "window", "passivity controller", "time between ticks", "force bounding"],
)
def test_a_touch_is_replayed(save, law):
    """Walls, estimators and laws with a memory; late and missed samples; a saturated, stepped converter."""
    device = paddle(force_limit=0.5, force_resolution="1 mN")
    table = touched(device, law, seed=4)
    found = replay(save(table, device, law))
    assert found.different == 0
    assert found.samples == len(table) < SAMPLES
    assert np.unique(column(table, "force_N")).size > 10
    assert np.abs(column(table, "force_N")).max() == 0.5
    assert "to the last bit" in found.describe()


def test_forces_by_another_road(save):
    """K max(x, 0) at readings that jump and lie between the encoder's counts: nothing is rounded."""
    table = drawn(400)
    position = column(table, "position_m")
    position *= 1e-3
    position[17] = np.nextafter(22.4e-6, 0.0)
    column(table, "force_N")[:] = 300.0 * np.maximum(position, 0.0)
    found = replay(save(table, paddle(), zw.Wall(stiffness=300)))
    assert (found.samples, found.different) == (400, 0)


def test_a_force_that_is_not_the_laws_is_found(save):
    """By how much, and in how many samples; not where the safety cut it, and says so."""
    device = paddle()
    table = touched(device, WALL, seed=2)
    deep = int(np.argmax(column(table, "force_N")))
    column(table, "force_N")[deep] += 0.25
    found = replay(save(table, device, WALL))
    assert (found.samples, found.different) == (len(table), 1)
    assert found.largest == pytest.approx(0.25)
    assert "another force in 1 of" in found.describe()
    column(table, "limited")[deep] = 1.0
    found = replay(save(table, device, WALL))
    assert (found.samples, found.different) == (len(table) - 1, 0)


def test_another_law_gives_other_forces(save):
    table = touched(paddle(), WALL, seed=2)
    assert replay(save(table, paddle(), WALL), environment=zw.Wall(stiffness=299)).different > 100


def test_a_sample_without_an_answer_is_missed(save):
    """Its row has an old reading and the force held: the law did not run."""
    device = paddle()
    table = touched(device, WALL, seed=9)
    whole = len(table)
    added = np.repeat(table[700:701], 2, axis=0)
    gap = int(column(table, "sample")[701] - column(table, "sample")[700])
    column(table, "sample")[701:] += 2
    column(added, "sample")[:] += gap + np.arange(2)
    column(added, "status")[:] = 1.0
    table = np.insert(table, 701, added, axis=0)
    found = replay(save(table, device, WALL))
    assert (found.samples, found.different) == (whole, 0)


def test_the_second_law_begins_at_rest(save):
    """What the first one remembered is gone; each is replayed by its own number."""
    device, soft = paddle(), zw.Wall(stiffness=100, damping="0.1 N*s/m")
    first, second = touched(device, WALL, seed=1), touched(device, soft, seed=3)
    column(second, "sample")[:] += column(first, "sample")[-1] + 1
    column(second, "law")[:] = 1.0
    recording = save(np.concatenate([first, second]), device, WALL, soft)
    for law, rows in enumerate((first, second)):
        found = replay(recording, law=law)
        assert (found.samples, found.different) == (len(rows), 0)
    with pytest.raises(InputError, match="law 2"):
        replay(recording, law=2)


def test_what_cannot_be_replayed_is_refused(save):
    """Lost rows, another rate, a law of one's own, one that needs the step of an encoder without steps."""
    device, law = paddle(), render(WALL, Damper(damping="0.1 N*s/m", velocity=TickTime()))
    table = touched(device, law, seed=5)
    with pytest.raises(InputError, match="rows were lost"):
        replay(save(table, device, law, kept=len(table) - 30))
    with pytest.raises(InputError, match="the device that was served"):
        replay(save(table, device, law, period=2e-3))
    with pytest.raises(InputError, match="give device and environment"):
        replay(save(table, device))
    column(table, "position_m")[:] += 1e-6
    with pytest.raises(InputError, match="whole multiples"):
        replay(save(table, device, law))


def test_rows_that_were_lost_behind_a_law_do_not_matter(save):
    """The ring wrote over rows of the time before: the law began later."""
    device = paddle()
    table = touched(device, WALL, seed=5)
    before = drawn(200)
    for name in ("phase", "law"):
        column(before, name)[:] = 0.0
    column(table, "sample")[:] += 200
    recording = save(np.concatenate([before, table]), device, WALL, kept=len(table) + 60)
    assert recording.rows_lost == 140
    assert replay(recording).different == 0


def test_the_clock_of_a_recording(save):
    device = paddle()
    touch = touch_of(save(touched(device, WALL, seed=8), device, WALL))
    timing = Timing(lateness=6e-4, missed=0.04, seed=8)
    skipped = timing.skipped(SAMPLES)
    last = int(np.flatnonzero(skipped == 0)[-1])
    assert np.array_equal(touch.timing.skipped(last), skipped[: last + 1])
    expected = np.where(skipped == 0, timing.late(SAMPLES, 1e-3), 0.0)
    assert np.array_equal(touch.timing.late(last, 1e-3), expected[: last + 1])
    assert touch.duration == last * device.exact("sample_period")


def serve(device, hand, folder, **more):
    simulated = Simulated(device=device, hand=hand, duration="300 ms")
    with Servo(device, WALL, simulated, safety=SLOW, **more) as servo:
        servo.measure("20 ms")
        with Recorder(servo.rows, folder / "run.mcap") as recorder:
            servo.start(anyway=True)
            servo.wait()
    recording = read_recording(folder / "run.mcap")
    assert recording.samples == servo.rows.count == recorder.close().rows
    return recording


@pytest.mark.parametrize(
    "placement", [Placement(), Placement(origin=-3.3e-6, sense=-1)], ids=["at a count", "between counts"]
)
def test_a_served_touch_is_replayed(tmp_path, placement):
    """A loop in real time, whatever this machine made it miss: the same forces, and nothing lost."""
    hand = zw.operators.Finger(force=1.5, speed=0.3, start=-2e-3)
    recording = serve(paddle(rate="500 Hz", sample_period=None), hand, tmp_path, placement=placement)
    assert recording.whole
    assert replay(recording).different == 0
    data = recording.dataset()  # its true position is told in the device's own coordinates
    answered = data["status"].values == 0
    away = np.abs(data["position"].values - data["measured_position"].values)[answered]
    assert away.max() < 22.4e-6 * (1 + 1e-9)


def tracking(size):
    times = 2e-3 * np.arange(151)
    path = -size * np.cos(30 * times) + 2e-3 * np.sin(61 * times)
    return zw.operators.Tracking(path, stiffness=300.0, damping=1.0)


@pytest.fixture(scope="module")
def served(tmp_path_factory):
    """In real time, with whatever lateness this machine has; a delay, and friction at rest."""
    device = paddle(rate="500 Hz", sample_period=None, stiction=0.2, delay="0.7 ms")
    return serve(device, tracking(2e-3), tmp_path_factory.mktemp("served"))


def test_the_trace_is_what_was_served(served):
    """Positions, velocities, forces and energies at the samples, bit by bit; and its energies add up."""
    trace = trace_of(served, tracking(2e-3))
    good = served.columns["phase"] == 2.0
    at = served.columns["sample"][good].astype(int)
    pairs = {
        **{name: f"{name}_J" for name in ("hand_work", "viscous_loss", "coulomb_loss")},
        **{"time": "time_s", "measured_position": "position_m", "commanded_force": "force_N"},
        **{"position": "true_position_m", "velocity": "true_velocity_m_per_s"},
    }
    for name, column in pairs.items():
        assert np.array_equal(trace[name].values[at], served.columns[column][good]), name
    assert trace.attrs["format"] == "zwidth trace 1"
    assert ledger(trace).closes


def test_another_hand_is_refused(served):
    with pytest.raises(InputError, match="with this hand the position is another"):
        trace_of(served, tracking(2.001e-3))


def test_a_real_device_has_no_such_trace(record):
    with pytest.raises(InputError, match="of a real device"):
        trace_of(record(drawn(10)), tracking(2e-3))
