"""`zwidth replay`: what is in a recording, in words, as JSON, as a picture and as NetCDF."""

from pathlib import Path

import numpy as np
import pytest
import xarray as xr
from recordings import paddle
from written_rows import COLUMNS, WrittenRows, drawn

import zwidth as zw
from zwidth.machine.servo.recording import Recorder, read_recording
from zwidth.model.specification.write import written
from zwidth.show.plots.recordings import recording_figure

WALL = zw.Wall(stiffness=300)


def record(table, *events, title="a wall"):
    """run.mcap, with these rows."""
    rows = WrittenRows(table)
    rows.title, rows.events = title, [*events]
    with Recorder(rows, Path("run.mcap"), force=True):
        rows.written = len(table)


@pytest.fixture
def recorded(run):
    """A spring at readings drawn at random, two samples missed."""
    table = np.delete(drawn(500), [40, 41], axis=0)
    position = COLUMNS.index("position_m")
    table[:, position] *= 1e-3
    table[:, COLUMNS.index("force_N")] = 300.0 * np.maximum(table[:, position], 0.0)
    spring = {"law": "spring", "specification": written(paddle(), WALL)}
    record(table, spring, title="a spring \x1b[31m on a stand-in")
    return Path("run.mcap")


def test_what_is_in_it(run, recorded):
    out = run("replay run.mcap").out
    assert "\x1b" not in out
    assert "missed by the loop  2" in out
    assert "law 0: the simulation gives the same force in all 498 samples" in out
    told = run("replay run.mcap --json").json
    assert (told["samples"], told["missed"], told["rows_lost"], told["whole"]) == (498, 2, 0, True)
    assert told["replays"][0]["largest_difference_N"] == 0.0


def test_other_forces_are_status_1(run, recorded):
    """A file that says it was another wall."""
    table = np.column_stack(list(read_recording(recorded).columns.values()))
    record(table, {"specification": written(paddle(), zw.Wall(stiffness=301))})
    assert "another force in" in run("replay run.mcap", 1).out


def test_a_law_that_is_not_told_is_no_fault(run):
    """It cannot be replayed, which is said; the rest is shown."""
    record(drawn(20))
    assert "law 0: not replayed" in run("replay run.mcap").out


def test_a_picture_and_a_file(run, refused, recorded):
    assert "written" in run("replay run.mcap --plot run.png -o run.nc").out
    assert Path("run.png").read_bytes().startswith(b"\x89PNG")
    with xr.open_dataset("run.nc", engine="h5netcdf", decode_times=False) as data:
        assert np.array_equal(data["commanded_force"], read_recording(recorded).columns["force_N"])
        assert data["measured_position"].attrs["units"] == "m"
    assert "exists" in refused("replay run.mcap --plot run.png")
    assert ".nc" in refused("replay run.mcap -o run.csv")


def test_what_the_picture_shows(recorded):
    """Position over the wall, both forces, and a mark where samples were missed."""
    figure = recording_figure(read_recording(recorded).dataset())
    above, middle, below = figure.axes
    labels = [line.get_label() for line in middle.get_lines()[:2]]
    assert labels == ["asked for by the law", "given"]
    assert "position x [mm]" in above.get_ylabel()
    assert below.get_lines()[1].get_xdata().size == 1


def test_nothing_to_draw_is_refused(refused):
    Recorder(WrittenRows(drawn(1)), Path("run.mcap")).close()
    assert "nothing to draw" in refused("replay run.mcap --plot run.png")
