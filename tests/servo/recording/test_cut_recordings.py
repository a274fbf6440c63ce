"""A recording that was cut off, changed or broken is read up to there, never beyond, never with an error."""

from __future__ import annotations

import shutil
from pathlib import Path

import numpy as np
import pytest
from written_rows import COLUMNS, drawn

from zwidth import InputError
from zwidth.identification.logs.served.contents import Head
from zwidth.servo.recording.mcap import McapFile
from zwidth.servo.recording.parquet import ParquetFolder
from zwidth.servo.recording.recording import read_recording

EACH = 50
"""Rows of a chunk, and of a part."""

HEAD = Head(columns=COLUMNS, motion="linear", period=1e-3, title="a wall", about={"laws": []})
TABLE = drawn(20 * EACH)
TAKEN = np.arange(len(TABLE)) * 1_000_000


def pieces() -> list[slice]:
    """The rows of each chunk or part."""
    return [slice(k, k + EACH) for k in range(0, len(TABLE), EACH)]


@pytest.fixture
def chunked(tmp_path: Path) -> tuple[Path, list[int]]:
    """A file, and where each of its chunks ends: before the index of its messages."""
    file = McapFile(tmp_path / "run.mcap", HEAD)
    ends = []
    for k in pieces():
        file.write(TABLE[k], TAKEN[k], [], 0)
        index = 9 + 6 + 16 * EACH  # kind and size; channel and bytes; a time and a place for each row
        ends.append(file.size - index)
    file.close()
    return tmp_path / "run.mcap", ends


@pytest.fixture
def folder(tmp_path: Path) -> Path:
    """A folder of parts, 0 without rows and then one for each piece."""
    written = ParquetFolder(tmp_path / "run.parquet", HEAD)
    for n, k in enumerate(pieces()):
        written.write(TABLE[k], TAKEN[k], [], 2 * n * 10**9)
    written.close()
    return tmp_path / "run.parquet"


def is_prefix(path: Path, rows: int) -> None:
    """Exactly so many rows are read, as they were written; there is no end."""
    found = read_recording(path)
    assert not found.whole
    assert found.samples == rows
    assert np.column_stack(list(found.columns.values())).tobytes() == TABLE[:rows].tobytes()


def test_cut_at_any_byte(chunked: tuple[Path, list[int]], tmp_path: Path) -> None:
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


def test_changed_bytes_end_what_is_read(chunked: tuple[Path, list[int]], tmp_path: Path) -> None:
    """The checksum of a chunk sees them: none of its rows is believed."""
    path, ends = chunked
    data = bytearray(path.read_bytes())
    data[ends[6] - 40] ^= 1
    changed = tmp_path / "changed.mcap"
    changed.write_bytes(data)
    is_prefix(changed, 6 * EACH)


def test_a_chunk_that_is_passed_over_ends_what_is_read(
    chunked: tuple[Path, list[int]], tmp_path: Path
) -> None:
    """A record of an unknown kind is passed over; the rows behind it are not those that follow."""
    path, ends = chunked
    data = bytearray(path.read_bytes())
    index = 9 + 6 + 16 * EACH
    assert data[ends[3] + index] == 6  # the kind of the next chunk
    data[ends[3] + index] = 0x86
    changed = tmp_path / "changed.mcap"
    changed.write_bytes(data)
    is_prefix(changed, 4 * EACH)


def test_any_changed_byte_is_no_crash(chunked: tuple[Path, list[int]], tmp_path: Path) -> None:
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


def test_a_whole_file_reads_to_its_end(chunked: tuple[Path, list[int]], folder: Path) -> None:
    """Otherwise the tests above would show little."""
    for path in (chunked[0], folder):
        assert read_recording(path).whole
        assert read_recording(path).samples == len(TABLE)


@pytest.mark.parametrize("share", [0.0, 0.3, 0.99])
def test_a_part_that_is_cut_ends_what_is_read(folder: Path, share: float) -> None:
    """As one that is missing does: what follows is not put where it does not belong."""
    before = read_recording(folder)
    broken = sorted(folder.iterdir())[8]
    rows = EACH * (8 - 1) + EACH  # part 1 holds the first two pieces, each later one a piece more
    assert before.whole
    data = broken.read_bytes()
    broken.write_bytes(data[: int(share * len(data))])
    is_prefix(folder, rows)
    broken.unlink()
    is_prefix(folder, rows)


def test_a_changed_byte_ends_what_is_read_of_a_folder(folder: Path) -> None:
    """A part has a checksum of all that it holds; one that fails it is not believed."""
    part = sorted(folder.iterdir())[6]
    data = part.read_bytes()
    random = np.random.default_rng(3)
    for place in (len(data) // 4, data.index(b"a wall"), *random.integers(4, len(data), 60)):
        changed = bytearray(data)
        changed[place] ^= 1
        part.write_bytes(changed)
        found = read_recording(folder)
        if not found.whole:
            is_prefix(folder, EACH * 6)
            continue
        assert np.column_stack(list(found.columns.values())).tobytes() == TABLE.tobytes()


def test_a_part_under_its_first_name_is_passed_over(folder: Path, tmp_path: Path) -> None:
    """A process that was killed while it wrote a part leaves such a file; pandas passes it over too."""
    import pandas as pd

    (folder / f".zwidth-{'0' * 32}.part").write_bytes(b"PAR1 and no more")
    assert read_recording(folder).whole
    assert len(pd.read_parquet(folder)) == len(TABLE)


def test_parts_of_two_recordings_are_not_joined(folder: Path, tmp_path: Path) -> None:
    """A part with other columns, or with another number than its name says, ends what is read."""
    parts = sorted(folder.iterdir())
    shutil.copy(parts[5], parts[4])
    is_prefix(folder, EACH * 4)
    parts[0].write_bytes(parts[0].read_bytes()[:-1])
    with pytest.raises(InputError, match="part-000000"):
        read_recording(folder)
    parts[0].unlink()
    with pytest.raises(InputError, match="no recording"):
        read_recording(folder)


def test_what_is_no_recording_is_refused(tmp_path: Path) -> None:
    """A text, an empty folder, nothing at all: each with one message."""
    (tmp_path / "text.mcap").write_text("time,position\n0,1\n")
    (tmp_path / "empty.parquet").mkdir()
    for name in ("text.mcap", "empty.parquet", "nothing.mcap"):
        with pytest.raises(InputError):
            read_recording(tmp_path / name)


def test_a_recording_of_another_version_is_refused(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    """Rather than read wrongly."""
    for later in ("run.mcap", "run.parquet"):
        with monkeypatch.context() as patch:
            patch.setattr("zwidth.identification.logs.served.contents.FORMAT", "zwidth recording 2")
            (McapFile if later == "run.mcap" else ParquetFolder)(tmp_path / later, HEAD).close()
        with pytest.raises(InputError, match="zwidth recording 2"):
            read_recording(tmp_path / later)
