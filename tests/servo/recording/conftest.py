"""A recording of rows that no loop wrote."""

import pytest
from written_rows import WrittenRows

from zwidth.machine.servo.recording.recorder import Recorder
from zwidth.machine.servo.recording.recording import read_recording


@pytest.fixture
def record(tmp_path):
    """Writes rows and events into run.mcap, and reads it back."""

    def through_a_file(table, *events, **others):
        rows = WrittenRows(table, **others)
        rows.events += events
        with Recorder(rows, tmp_path / "run.mcap", force=True):
            rows.written = len(table)
        return read_recording(tmp_path / "run.mcap")

    return through_a_file
