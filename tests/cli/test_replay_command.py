"""`zwidth replay`: what is in a recording, in words, as JSON, as a picture and as NetCDF."""

from __future__ import annotations

import argparse
import json
from pathlib import Path

import numpy as np
import pytest
import xarray as xr
from recordings import paddle
from written_rows import COLUMNS, WrittenRows, drawn

import zwidth as zw
from zwidth import InputError
from zwidth.cli.commands import configure
from zwidth.cli.machine import replay
from zwidth.machine.servo.recording import Recorder, read_recording
from zwidth.model.specification.write import written
from zwidth.show.plots.recordings import recording_figure

WALL = zw.Wall(stiffness=300)


@pytest.fixture
def recorded(tmp_path: Path) -> Path:
    """A spring at readings drawn at random, two samples missed."""
    table = np.delete(drawn(500), [40, 41], axis=0)
    position = COLUMNS.index("position_m")
    table[:, position] *= 1e-3
    table[:, COLUMNS.index("force_N")] = 300.0 * np.maximum(table[:, position], 0.0)
    rows = WrittenRows(table)
    rows.title = "a spring \x1b[31m on a stand-in"
    rows.events.append({"law": "spring", "specification": written(paddle(), WALL)})
    with Recorder(rows, tmp_path / "run.mcap"):
        rows.written = len(table)
    return tmp_path / "run.mcap"


def command(*argv: object) -> int:
    """The command with these arguments."""
    parser = argparse.ArgumentParser()
    configure("replay", parser)
    return replay.run(parser.parse_args([str(word) for word in argv]))


def test_what_is_in_it(recorded: Path, capsys: pytest.CaptureFixture[str]) -> None:
    """Samples, missed ones, the law, and that its forces are these; nothing that a terminal obeys."""
    assert command(recorded) == 0
    out = capsys.readouterr().out
    assert "\x1b" not in out
    assert "missed by the loop  2" in out
    assert "law 0: the simulation gives the same force in all 498 samples" in out


def test_as_json(recorded: Path, capsys: pytest.CaptureFixture[str]) -> None:
    """The same for a program, units in the keys."""
    assert command(recorded, "--json") == 0
    told = json.loads(capsys.readouterr().out)
    assert (told["samples"], told["missed"], told["rows_lost"], told["whole"]) == (498, 2, 0, True)
    assert told["replays"][0]["largest_difference_N"] == 0.0


def test_other_forces_are_status_1(recorded: Path, capsys: pytest.CaptureFixture[str]) -> None:
    """A file that says it was another wall."""
    rows = WrittenRows(np.column_stack(list(read_recording(recorded).columns.values())))
    rows.events.append({"specification": written(paddle(), zw.Wall(stiffness=301))})
    with Recorder(rows, recorded, force=True):
        rows.written = 498
    assert command(recorded) == 1
    assert "another force in" in capsys.readouterr().out


def test_a_law_that_is_not_told_is_no_fault(recorded: Path, capsys: pytest.CaptureFixture[str]) -> None:
    """It cannot be replayed, which is said; the rest is shown."""
    rows = WrittenRows(drawn(20))
    with Recorder(rows, recorded, force=True):
        rows.written = 20
    assert command(recorded) == 0
    assert "law 0: not replayed" in capsys.readouterr().out


def test_a_picture_and_a_file(recorded: Path, capsys: pytest.CaptureFixture[str]) -> None:
    """Written where asked, and never over something else without a word."""
    picture, saved = recorded.with_suffix(".png"), recorded.with_suffix(".nc")
    assert command(recorded, "--plot", picture, "-o", saved) == 0
    assert picture.read_bytes().startswith(b"\x89PNG")
    with xr.open_dataset(saved, engine="h5netcdf", decode_times=False) as data:
        assert np.array_equal(data["commanded_force"], read_recording(recorded).columns["force_N"])
        assert data["measured_position"].attrs["units"] == "m"
    with pytest.raises(InputError, match="exists"):
        command(recorded, "--plot", picture)
    with pytest.raises(InputError, match=r"\.nc"):
        command(recorded, "-o", recorded.with_suffix(".csv"))
    assert "written" in capsys.readouterr().out


def test_what_the_picture_shows(recorded: Path) -> None:
    """Position over the wall, both forces, and a mark where samples were missed."""
    figure = recording_figure(read_recording(recorded).dataset())
    above, middle, below = figure.axes
    labels = [line.get_label() for line in middle.get_lines()[:2]]
    assert labels == ["asked for by the law", "given"]
    assert "position [mm]" in above.get_ylabel()
    assert below.get_lines()[1].get_xdata().size == 1


def test_nothing_to_draw_is_refused(tmp_path: Path) -> None:
    """A recording without rows has no picture."""
    Recorder(WrittenRows(drawn(1)), tmp_path / "run.mcap").close()
    with pytest.raises(InputError, match="nothing to draw"):
        command(tmp_path / "run.mcap", "--plot", tmp_path / "run.png")
