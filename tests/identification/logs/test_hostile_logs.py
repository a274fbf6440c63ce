"""Files made to fill the memory, to lead to other files, or to run what is in them: one message each."""

from __future__ import annotations

import bz2
import gzip
import struct
import zlib
from pathlib import Path

import h5py
import numpy as np
import pyarrow as pa
import pyarrow.parquet as pq
import pytest
from scipy.io import savemat

import zwidth as zw
from zwidth import reading

SIZE = 4_000_000
"""[bytes] What the small files below become, far beyond what the tests allow."""


@pytest.fixture(autouse=True)
def little_is_allowed(monkeypatch: pytest.MonkeyPatch) -> None:
    """A megabyte, so that the files of the tests are quickly made."""
    monkeypatch.setattr(reading, "FREE", 2**20)
    monkeypatch.setattr(reading, "LARGEST_CHUNK", 2**20)


def refused(path: Path, message: str) -> None:
    """Reading it is one line that says so."""
    with pytest.raises(zw.InputError, match=message) as caught:
        zw.read_log(path, columns={"time": "time_s", "position": "position_mm"})
    assert "\n" not in str(caught.value)


@pytest.mark.parametrize(("suffix", "pressed"), [(".gz", gzip.compress), (".bz2", bz2.compress)])
def test_compressed_text_that_grows_is_refused(suffix: str, pressed, tmp_path: Path) -> None:
    """Counted while it is read, since it says nothing of its size itself."""
    path = tmp_path / f"log.csv{suffix}"
    rows = "".join(f"{k},{k % 7}\n" for k in range(100)) + "100,0\n" * (SIZE // 6)
    path.write_bytes(pressed(f"time_s,position_mm\n{rows}".encode()))
    refused(path, "would become")


def test_parquet_that_grows_is_refused(tmp_path: Path) -> None:
    """Half a million times the same number takes some bytes."""
    path = tmp_path / "log.parquet"
    pq.write_table(pa.table({"time_s": np.zeros(SIZE // 8), "position_mm": np.zeros(SIZE // 8)}), path)
    assert path.stat().st_size < 5000
    refused(path, "would become")


def test_hdf5_that_declares_more_than_it_holds_is_refused(tmp_path: Path) -> None:
    """Numbers that were never written are filled in by the library, as many as are declared."""
    path = tmp_path / "log.h5"
    with h5py.File(path, "w") as file:
        for name in ("time_s", "position_mm"):
            file.create_dataset(name, shape=(2**50,), dtype="f8", chunks=(2**10,), fillvalue=1.0)
    refused(path, "would become")


def test_hdf5_in_too_large_pieces_is_refused(tmp_path: Path) -> None:
    """A piece is expanded whole, however little of it is wanted."""
    path = tmp_path / "log.h5"
    with h5py.File(path, "w") as file:
        for name in ("time_s", "position_mm"):
            file.create_dataset(name, data=np.zeros(2**15), chunks=(2**15,), maxshape=(None,))
            file.create_dataset(f"{name}_raw", data=np.random.default_rng(1).random(2**15))
    with pytest.MonkeyPatch.context() as patch:
        patch.setattr(reading, "LARGEST_CHUNK", 2**17)
        refused(path, "in smaller pieces")


def test_hdf5_whose_pieces_grow_is_refused(tmp_path: Path) -> None:
    """The library expands a piece to its end, far beyond what the dataset declares."""
    path = tmp_path / "log.h5"
    with h5py.File(path, "w") as file:
        for name in ("time_s", "position_mm"):
            data = file.create_dataset(name, shape=(100,), dtype="f8", chunks=(100,), compression="gzip")
            data.id.write_direct_chunk((0,), zlib.compress(bytes(SIZE)))
    refused(path, "in smaller pieces")


def test_hdf5_compressed_many_times_over_is_refused(tmp_path: Path) -> None:
    """Each time a thousandfold."""
    path = tmp_path / "log.h5"
    filters = h5py.h5p.create(h5py.h5p.DATASET_CREATE)
    filters.set_chunk((100,))
    filters.set_deflate(9)
    filters.set_deflate(9)
    with h5py.File(path, "w") as file:
        for name in (b"time_s", b"position_mm"):
            h5py.h5d.create(file.id, name, h5py.h5t.NATIVE_DOUBLE, h5py.h5s.create_simple((100,)), filters)
    refused(path, "2 times over")


def test_hdf5_does_not_lead_to_other_files(tmp_path: Path) -> None:
    """Not by a link, which is not followed; not by numbers that are kept elsewhere."""
    secret = tmp_path / "secret"
    secret.write_bytes(np.arange(100.0).tobytes())
    with h5py.File(tmp_path / "other.h5", "w") as file:
        file["position_mm"] = np.arange(100.0)
    linked, kept = tmp_path / "linked.h5", tmp_path / "kept.h5"
    with h5py.File(linked, "w") as file:
        file["time_s"] = np.arange(100.0)
        file["position_mm"] = h5py.ExternalLink("other.h5", "/position_mm")
    refused(linked, "position_mm")
    with h5py.File(kept, "w") as file:
        file["time_s"] = np.arange(100.0)
        file.create_dataset("position_mm", shape=(100,), dtype="f8", external=[(str(secret), 0, 800)])
    refused(kept, "are elsewhere")


def test_hdf5_is_not_put_together_of_other_files(tmp_path: Path) -> None:
    """As a virtual dataset is."""
    path = tmp_path / "log.h5"
    with h5py.File(tmp_path / "other.h5", "w") as file:
        file["x"] = np.arange(100.0)
    layout = h5py.VirtualLayout(shape=(100,), dtype="f8")
    layout[:] = h5py.VirtualSource(str(tmp_path / "other.h5"), "x", shape=(100,))
    with h5py.File(path, "w") as file:
        file["time_s"] = np.arange(100.0)
        file.create_virtual_dataset("position_mm", layout)
    refused(path, "are elsewhere")


def test_matlab_that_grows_is_refused(tmp_path: Path) -> None:
    """By what its compressed variables really become."""
    path = tmp_path / "log.mat"
    savemat(path, {"time_s": np.zeros(SIZE // 8), "position_mm": np.zeros(SIZE // 8)}, do_compression=True)
    assert path.stat().st_size < SIZE // reading.RATIO
    refused(path, "would become")


def _mcap(chunks: list[tuple[str, bytes, int]], indexed: bool) -> bytes:
    """A file with these chunks, (how compressed, bytes, size that it says), or with their index alone."""

    def word(text: bytes) -> bytes:
        return struct.pack("<I", len(text)) + text

    def record(kind: int, content: bytes) -> bytes:
        return struct.pack("<BQ", kind, len(content)) + content

    magic, data, index = b"\x89MCAP0\r\n", b"", b""
    start = magic + record(1, word(b"ros2") + word(b"zwidth"))
    for codec, content, declared in chunks:
        place = len(start + data)
        head = struct.pack("<QQQI", 0, 1, declared, 0) + word(codec.encode())
        chunk = head + struct.pack("<Q", len(content)) + content
        data += record(0x05 if indexed else 0x06, chunk)
        about = struct.pack("<QQQQ", 0, 1, place, len(chunk) + 9) + word(b"") + struct.pack("<Q", 0)
        index += record(0x08, about + word(codec.encode()) + struct.pack("<QQ", len(content), declared))
    summary = len(start + data)
    footer = record(2, struct.pack("<QQI", summary, 0, 0))
    return start + data + index + footer + magic


@pytest.mark.parametrize("indexed", [False, True])
@pytest.mark.parametrize("declared", [2**60, SIZE, 100])
@pytest.mark.parametrize("codec", ["zstd", "lz4"])
def test_chunks_that_grow_are_refused(codec: str, declared: int, indexed: bool, tmp_path: Path) -> None:
    """By what they say, and by what they really become; where the index leads too."""
    pytest.importorskip("rosbags")
    path = tmp_path / "log.mcap"
    content = pa.compress(bytes(SIZE), codec="lz4" if codec == "lz4" else "zstd", asbytes=True)
    path.write_bytes(_mcap([(codec, content, declared)], indexed))
    refused(path, "in smaller pieces")


def _rosbag1(codec: bytes, content: bytes, declared: int, place: int | None) -> bytes:
    """A bag of ROS 1 with one chunk, and an index that says where it is."""

    def record(content: bytes, **fields: bytes) -> bytes:
        named = [name.encode() + b"=" + value for name, value in fields.items()]
        header = b"".join(struct.pack("<I", len(field)) + field for field in named)
        return struct.pack("<I", len(header)) + header + struct.pack("<I", len(content)) + content

    magic = b"#ROSBAG V2.0\n"
    zero = struct.pack("<I", 0)
    one = struct.pack("<I", 1)

    def head(index: int) -> bytes:
        return record(
            b" " * 100, op=b"\x03", index_pos=struct.pack("<Q", index), conn_count=zero, chunk_count=one
        )

    start = magic + head(0)
    chunk = record(content, op=b"\x05", compression=codec, size=struct.pack("<I", declared))
    begun = len(start) if place is None else place
    times = {"start_time": bytes(8), "end_time": bytes(8)}
    about = record(b"", op=b"\x06", ver=one, chunk_pos=struct.pack("<Q", begun), count=zero, **times)
    return magic + head(len(start + chunk)) + chunk + about


@pytest.mark.parametrize("declared", [2**32 - 1, 100])
def test_chunks_of_ros_1_that_grow_are_refused(declared: int, tmp_path: Path) -> None:
    """By what they say, and by what they really become."""
    pytest.importorskip("rosbags")
    path = tmp_path / "log.bag"
    path.write_bytes(_rosbag1(b"bz2", bz2.compress(bytes(SIZE)), declared, None))
    refused(path, "in smaller pieces")


def test_an_index_of_ros_1_leads_to_its_chunks(tmp_path: Path) -> None:
    """And to no bytes that were not looked at."""
    pytest.importorskip("rosbags")
    path = tmp_path / "log.bag"
    path.write_bytes(_rosbag1(b"bz2", bz2.compress(bytes(100)), 100, 50))
    refused(path, "index leads to")


@pytest.mark.parametrize("grown", [False, True])
def test_messages_that_are_compressed_one_by_one(grown: bool, recording, tmp_path: Path) -> None:
    """They are read, unless one becomes too large."""
    pytest.importorskip("rosbags")
    from rosbags.rosbag2 import CompressionFormat, CompressionMode, Writer
    from rosbags.typesys import Stores, get_typestore

    store = get_typestore(Stores.ROS2_HUMBLE)
    number, text = store.types["std_msgs/msg/Float64"], store.types["std_msgs/msg/String"]
    path = tmp_path / "bag"
    writer = Writer(path, version=9)
    writer.set_compression(CompressionMode.MESSAGE, CompressionFormat.ZSTD)
    with writer:
        place = writer.add_connection("/position", number.__msgtype__, typestore=store)
        words = writer.add_connection("/words", text.__msgtype__, typestore=store)
        for t, x in zip(recording.time[:500], recording.position, strict=False):
            data = store.serialize_cdr(number(x), place.msgtype)
            writer.write(place, 10**18 + round(t * 1e9), data)
        if grown:
            writer.write(words, 10**18, store.serialize_cdr(text(" " * SIZE), words.msgtype))
    if grown:
        refused(path, "in smaller pieces")
    else:
        log = zw.read_log(path, columns={"position": "/position.data"}, units={"position": "m"})
        assert log.samples == 500


def test_a_bag_that_grows_on_the_disk_is_refused(tmp_path: Path) -> None:
    """A whole file of a bag is unpacked to the disk."""
    pytest.importorskip("rosbags")
    path = tmp_path / "bag"
    path.mkdir()
    (path / "metadata.yaml").write_text("rosbag2_bagfile_information: {}", encoding="utf-8")
    for content, message in ((bytes(SIZE), "would become"), (b"\x89MCAP0\r\n", "unpack it first")):
        (path / "bag").write_bytes(pa.compress(content, codec="zstd", asbytes=True))
        refused(path, message)


def test_zip_archives_and_arrays_of_objects_are_not_read(tmp_path: Path) -> None:
    """NumPy's own files are no logs: nothing in them is expanded or run."""
    for name in ("log.npz", "log.npy"):
        path = tmp_path / name
        np_file = {"position_mm": np.array([{"run": "this"}], dtype=object)}
        if name == "log.npz":
            np.savez_compressed(path, **np_file)
        else:
            np.save(path, np_file["position_mm"])
        refused(path, "zip archive" if name == "log.npz" else "no text|no table")


def test_what_a_recording_becomes_is_read(tmp_path: Path) -> None:
    """The bounds are far from what is recorded: a log of the size of the tests' bombs, compressed."""
    path = tmp_path / "log.csv.gz"
    rows = "".join(f"{k / 1000},{round(1e3 * np.sin(k / 97))}\n" for k in range(SIZE // 40))
    text = f"time_s,position_mm\n{rows}".encode()
    path.write_bytes(gzip.compress(text))
    assert len(text) > reading.FREE
    assert zw.read_log(path).samples == SIZE // 40
