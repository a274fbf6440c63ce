"""A recording that was cut off, changed or broken is read up to there, never beyond, never with an error."""

import os
import signal
import subprocess
import sys
from pathlib import Path

import numpy as np
import pytest
from written_rows import COLUMNS, drawn

from zwidth import InputError
from zwidth.data.logs.contents import Head
from zwidth.machine.servo.recording.recorder import McapFile
from zwidth.machine.servo.recording.recording import read_recording

EACH = 50
"""Rows of a chunk."""
INDEX = 9 + 6 + 16 * EACH
"""Bytes behind it: kind and size; channel and bytes; a time and a place for each row."""

HEAD = Head(columns=COLUMNS, motion="linear", period=1e-3, title="a wall", about={"laws": []})
TABLE = drawn(20 * EACH)
TAKEN = np.arange(len(TABLE)) * 1_000_000


@pytest.fixture
def chunked(tmp_path):
    """A file, and where each of its chunks ends: before the index of its messages."""
    file = McapFile(tmp_path / "run.mcap", HEAD)
    ends = []
    for k in range(0, len(TABLE), EACH):
        file.write(TABLE[k : k + EACH], TAKEN[k : k + EACH], [], 0)
        ends.append(file.size - INDEX)
    file.close()
    whole = read_recording(tmp_path / "run.mcap")
    assert (whole.whole, whole.samples) == (True, len(TABLE))
    return tmp_path / "run.mcap", ends


def is_prefix(path, rows):
    """Exactly so many rows are read, as they were written; there is no end."""
    found = read_recording(path)
    assert not found.whole
    assert found.samples == rows
    assert np.column_stack(list(found.columns.values())).tobytes() == TABLE[:rows].tobytes()


def test_cut_at_any_byte(chunked, tmp_path):
    """Every whole chunk is read, and no other; before its head a file is no recording."""
    path, ends = chunked
    data = path.read_bytes()
    head = data.index(b"zwidth_msgs")  # behind the metadata with the head
    random = np.random.default_rng(11)
    places = {*map(int, random.integers(head, len(data) - 1, 40)), *ends[:3], *(end - 1 for end in ends[:3])}
    last = data.rindex(b"zwidth end", 0, data.rindex(b"zwidth end"))  # the first of the two is the record
    for place in sorted(places):
        cut = tmp_path / "cut.mcap"
        cut.write_bytes(data[:place])
        if place < last:
            is_prefix(cut, EACH * sum(end <= place for end in ends))
    for place in (*random.integers(9, 100, 10), 0, 8):
        cut.write_bytes(data[:place])
        with pytest.raises(InputError, match="no recording"):
            read_recording(cut)


@pytest.mark.parametrize(
    ("chunk", "place", "flipped"),
    [(6, -40, 1), (3, INDEX, 0x80)],
    ids=["which the checksum sees", "to an unknown kind of record, which is passed over"],
)
def test_a_changed_byte_ends_what_is_read(chunked, chunk, place, flipped):
    """The rows of the chunk are not believed, and those behind it do not follow."""
    path, ends = chunked
    data = bytearray(path.read_bytes())
    assert place < 0 or data[ends[chunk] + place] == 6  # the kind of the next chunk
    data[ends[chunk] + place] ^= flipped
    path.write_bytes(data)
    is_prefix(path, (chunk + (place > 0)) * EACH)


def test_any_changed_byte_is_no_crash(chunked, tmp_path):
    """What is read is a beginning of what was written, or the file is refused; it is whole only if all is."""
    path, ends = chunked
    data = path.read_bytes()
    random = np.random.default_rng(5)
    changed = tmp_path / "changed.mcap"
    refused = 0
    for place in random.integers(8, ends[1], 200):
        broken = bytearray(data)
        broken[place] ^= 1 << int(random.integers(8))
        changed.write_bytes(broken)
        try:
            found = read_recording(changed)
        except InputError:
            refused += 1
            continue
        assert (tuple(found.columns), found.about, found.period) == (COLUMNS, HEAD.about, HEAD.period)
        assert np.column_stack(list(found.columns.values())).tobytes() == TABLE[: found.samples].tobytes()
        assert not found.whole or found.samples == len(TABLE)
    assert 0 < refused < 200


def test_what_is_no_recording_is_refused(tmp_path):
    (tmp_path / "text.mcap").write_text("time,position\n0,1\n")
    (tmp_path / "folder.mcap").mkdir()
    for name in ("text.mcap", "folder.mcap", "nothing.mcap"):
        with pytest.raises(InputError):
            read_recording(tmp_path / name)


def test_a_recording_of_another_version_is_refused(tmp_path, monkeypatch):
    with monkeypatch.context() as patch:
        patch.setattr("zwidth.data.logs.contents.FORMAT", "zwidth recording 2")
        McapFile(tmp_path / "run.mcap", HEAD).close()
    with pytest.raises(InputError, match="zwidth recording 2"):
        read_recording(tmp_path / "run.mcap")


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
    command = [sys.executable, "-c", WRITER, str(Path(__file__).parents[2]), str(path)]
    child = subprocess.Popen(command, stdout=subprocess.PIPE, text=True)
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
