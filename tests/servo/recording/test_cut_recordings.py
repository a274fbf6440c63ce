"""A recording that was cut off, changed or broken is read up to there, never beyond, never with an error."""

import numpy as np
import pytest
from written_rows import COLUMNS, drawn

from zwidth import InputError
from zwidth.data.logs.contents import Head
from zwidth.machine.servo.recording.recorder import McapFile
from zwidth.machine.servo.recording.recording import read_recording

EACH = 50
"""Rows of a chunk."""

HEAD = Head(columns=COLUMNS, motion="linear", period=1e-3, title="a wall", about={"laws": []})
TABLE = drawn(20 * EACH)
TAKEN = np.arange(len(TABLE)) * 1_000_000


def pieces():
    return [slice(k, k + EACH) for k in range(0, len(TABLE), EACH)]


@pytest.fixture
def chunked(tmp_path):
    """A file, and where each of its chunks ends: before the index of its messages."""
    file = McapFile(tmp_path / "run.mcap", HEAD)
    ends = []
    for k in pieces():
        file.write(TABLE[k], TAKEN[k], [], 0)
        index = 9 + 6 + 16 * EACH  # kind and size; channel and bytes; a time and a place for each row
        ends.append(file.size - index)
    file.close()
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


def test_changed_bytes_end_what_is_read(chunked, tmp_path):
    path, ends = chunked
    data = bytearray(path.read_bytes())
    data[ends[6] - 40] ^= 1
    changed = tmp_path / "changed.mcap"
    changed.write_bytes(data)
    is_prefix(changed, 6 * EACH)


def test_a_chunk_that_is_passed_over_ends_what_is_read(chunked, tmp_path):
    """A record of an unknown kind is passed over; the rows behind it are not those that follow."""
    path, ends = chunked
    data = bytearray(path.read_bytes())
    index = 9 + 6 + 16 * EACH
    assert data[ends[3] + index] == 6  # the kind of the next chunk
    data[ends[3] + index] = 0x86
    changed = tmp_path / "changed.mcap"
    changed.write_bytes(data)
    is_prefix(changed, 4 * EACH)


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
        assert tuple(found.columns) == COLUMNS
        assert found.about == HEAD.about
        assert found.period == HEAD.period
        assert np.column_stack(list(found.columns.values())).tobytes() == TABLE[: found.samples].tobytes()
        assert not found.whole or found.samples == len(TABLE)
    assert 0 < refused < 200


def test_a_whole_file_reads_to_its_end(chunked):
    """Otherwise the tests above would show little."""
    assert read_recording(chunked[0]).whole
    assert read_recording(chunked[0]).samples == len(TABLE)


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
