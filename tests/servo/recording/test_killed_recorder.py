"""A process that is killed leaves everything that its recorder said was in the file."""

import os
import signal
import subprocess
import sys
from pathlib import Path

import numpy as np
import pytest
from written_rows import drawn

from zwidth.machine.servo.recording.recording import read_recording

TESTS = Path(__file__).parents[2]

WRITER = """
import sys, time
sys.path.insert(0, sys.argv[1])
from written_rows import WrittenRows, drawn
from zwidth.machine.servo.recording.recorder import Recorder
rows = WrittenRows(drawn(200_000), kept=200_000)
recorder = Recorder(rows, sys.argv[2])
while True:
    time.sleep(0.01)
    rows.written += 37
    print(recorder.so_far().rows, flush=True)
"""


@pytest.mark.skipif(sys.platform == "win32", reason="there is no such signal")
def test_after_kill_9(tmp_path):
    """Killed once it has said that the rows of three looks are written; they are read back, bit by bit."""
    path = tmp_path / "run.mcap"
    child = subprocess.Popen(
        [sys.executable, "-c", WRITER, str(TESTS), str(path)], stdout=subprocess.PIPE, text=True
    )
    assert child.stdout is not None
    said = [0]
    while len(set(said)) < 4:
        said.append(int(child.stdout.readline()))
    os.kill(child.pid, signal.SIGKILL)
    child.wait()
    child.stdout.close()
    found = read_recording(path)
    assert not found.whole
    assert found.samples >= said[-1] > 0
    rows = np.column_stack(list(found.columns.values()))
    assert rows.tobytes() == drawn(200_000)[: found.samples].tobytes()
