"""A recording is a log as it stands: `zwidth identify` knows its columns, units and signs by themselves."""

from pathlib import Path

import numpy as np
import pytest
from known_motion import COULOMB, DAMPING, MASS, PERIOD, STEP, paddle
from written_rows import COLUMNS, WrittenRows, drawn

import zwidth as zw
from zwidth.machine.servo.devices import Simulated
from zwidth.machine.servo.recording.recorder import Recorder
from zwidth.machine.servo.recording.recording import read_recording
from zwidth.machine.servo.ring import PHASES, column_names


def moved(kept=1 << 20):
    recording = paddle()
    table = drawn(len(recording.time))
    table[:, COLUMNS.index("time_s")] = recording.time
    table[:, COLUMNS.index("position_m")] = recording.position
    table[:, COLUMNS.index("force_N")] = -recording.force
    return WrittenRows(table, kept=kept, period=PERIOD)


def written(rows, path):
    with Recorder(rows, path):
        rows.written = len(rows.after(0)[1]) or 20_000
    return path


@pytest.fixture(scope="module")
def path(tmp_path_factory):
    return written(moved(), tmp_path_factory.mktemp("recorded") / "run.mcap")


def test_a_recording_is_identified(path):
    """As from arrays, number for number; the signs are those that make the mass positive and right."""
    known = paddle()
    found = zw.identify(path)
    log = zw.Log.from_arrays(time=known.time, position=known.position, actuator_force=-known.force)
    same = zw.identify(log)
    truth = {"mass": MASS, "damping": DAMPING, "coulomb_friction": COULOMB}
    for name, true in truth.items():
        assert found.estimates[name].value == same.estimates[name].value
        assert found.estimates[name].value == pytest.approx(true, rel=0.05)


def test_a_log_of_a_recording(path):
    log = zw.read_log(path)
    known = paddle()
    assert (log.motion, log.sample_period, log.channels) == ("linear", PERIOD, ("actuator_force",))
    assert log.resolution == pytest.approx(STEP, rel=1e-9)
    blocks = list(log.blocks())
    assert np.concatenate([b.position for b in blocks]) == pytest.approx(known.position, abs=1e-12)
    assert np.array_equal(np.concatenate([b.actuator_force for b in blocks]), -known.force)


def test_a_sample_without_an_answer_has_no_position(tmp_path):
    """What stands in the row then is an older reading: the log begins a new run behind it."""
    rows = moved()
    rows._table[4000:4003, COLUMNS.index("status")] = 1.0
    log = zw.read_log(written(rows, tmp_path / "run.mcap"))
    assert log.runs == 2
    assert log.samples == 20_000 - 3


def test_what_was_lost_or_cut_is_said(tmp_path):
    path = written(moved(kept=15_000), tmp_path / "run.mcap")
    lost = {finding.kind: finding.samples for finding in zw.read_log(path).findings}
    assert lost["rows lost"] == 5000
    assert "cut off" not in lost
    path.write_bytes(path.read_bytes()[:-100])
    assert "cut off" not in {finding.kind for finding in zw.read_log(path).findings}  # the index alone is cut
    data = path.read_bytes()
    path.write_bytes(data[: data.index(b"zwidth end")])
    assert "cut off" in {finding.kind for finding in zw.read_log(path).findings}


def test_another_column_can_be_chosen(path):
    """Names and units as they stand in the file; None leaves a quantity out."""
    log = zw.read_log(path, columns={"actuator_force": "wished_force_N"})
    assert log.channels == ("actuator_force",)
    assert zw.read_log(path, columns={"actuator_force": None}).channels == ()
    assert read_recording(path).log(sample_rate=1000).samples == 20_000


def test_a_rotary_recording(tmp_path):
    rows = moved()
    rows.motion = "rotary"
    rows.COLUMNS = tuple(name.replace("_N", "_N_m") if name.endswith("_N") else name for name in COLUMNS)
    rows.COLUMNS = tuple("position_rad" if name == "position_m" else name for name in rows.COLUMNS)
    log = zw.read_log(written(rows, tmp_path / "run.mcap"))
    assert log.motion == "rotary"
    assert log.channels == ("actuator_force",)


def test_a_recording_as_a_dataset(path, tmp_path):
    data = read_recording(path).dataset()
    units = {name: variable.attrs["units"] for name, variable in data.data_vars.items()}
    assert units == {
        **dict.fromkeys(["sample", "status", "phase", "law", "limited"], "1"),
        **dict.fromkeys(["late", "exchange"], "s"),
        "measured_position": "m",
        **dict.fromkeys(["wished_force", "commanded_force"], "N"),
        **dict.fromkeys(["energy_out", "friction_loss"], "J"),
    }
    assert np.array_equal(data["commanded_force"].values, -paddle().force)
    assert zw.Log.from_arrays(data).channels == ("actuator_force",)
    data.to_netcdf(tmp_path / "run.nc", engine="h5netcdf")


PAGE = (Path(__file__).parents[3] / "docs" / "recording.md").read_text(encoding="utf-8")


def test_every_column_is_on_the_page():
    """In the order of the rows; of what a simulated device tells, position and velocity."""
    device = zw.catalogue.device("haptic-paddle")
    columns = column_names(Simulated(device=device, hand=zw.operators.Finger(), duration="10 ms"))
    own = columns[: columns.index("true_position_m") + 2]
    places = [PAGE.index(f"`{name}`") for name in own]
    assert places == sorted(places)


def test_every_phase_is_on_the_page():
    row = next(line for line in PAGE.splitlines() if line.startswith("| `phase` |"))
    assert [row.find(name) for name in PHASES] == sorted(row.find(name) for name in PHASES)
    assert all(f"{number} {name}" in row for number, name in enumerate(PHASES))
