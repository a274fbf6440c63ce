"""Whatever a file holds, and whatever it was made for: one message, no traceback, and bounded memory."""

from __future__ import annotations

import bz2
import gzip
import io
import struct
import subprocess
import sys
import zipfile
import zlib
from pathlib import Path

import h5py
import numpy as np
import pyarrow as pa
import pyarrow.parquet as pq
import pytest
import scipy.io
from scipy.io import savemat

import zwidth as zw
from zwidth import reading
from zwidth.model.operator.recorded_force import read_column

SIZE = 4_000_000
"""[bytes] What the small files below become, far beyond what the tests allow."""


@pytest.fixture(autouse=True)
def little_is_allowed(monkeypatch: pytest.MonkeyPatch) -> None:
    """A megabyte, so that the files of the tests are quickly made."""
    monkeypatch.setattr(reading, "FREE", 2**20)
    monkeypatch.setattr(reading, "LARGEST_CHUNK", 2**20)


def refused(path: Path, message: str) -> None:
    with pytest.raises(zw.InputError, match=message) as caught:
        zw.read_log(path, columns={"time": "time_s", "position": "position_mm"})
    assert "\n" not in str(caught.value)


@pytest.mark.parametrize(("suffix", "pressed"), [(".gz", gzip.compress), (".bz2", bz2.compress)])
def test_compressed_text_that_grows_is_refused(suffix, pressed, tmp_path):
    """Counted while it is read, since it says nothing of its size itself."""
    path = tmp_path / f"log.csv{suffix}"
    rows = "".join(f"{k},{k % 7}\n" for k in range(100)) + "100,0\n" * (SIZE // 6)
    path.write_bytes(pressed(f"time_s,position_mm\n{rows}".encode()))
    refused(path, "would become")


def test_parquet_that_grows_is_refused(tmp_path):
    """Half a million times the same number takes some bytes."""
    path = tmp_path / "log.parquet"
    pq.write_table(pa.table({"time_s": np.zeros(SIZE // 8), "position_mm": np.zeros(SIZE // 8)}), path)
    assert path.stat().st_size < 5000
    refused(path, "would become")


def _declared(file: h5py.File, name: str) -> None:
    """Numbers that were never written are filled in by the library, as many as are declared."""
    file.create_dataset(name, shape=(2**50,), dtype="f8", chunks=(2**10,), fillvalue=1.0)


def _large_piece(file: h5py.File, name: str) -> None:
    """A piece is expanded whole, however little of it is wanted."""
    file.create_dataset(name, data=np.zeros(2**15), chunks=(2**15,), maxshape=(None,))
    file.create_dataset(f"{name}_raw", data=np.random.default_rng(1).random(2**15))


def _piece_that_grows(file: h5py.File, name: str) -> None:
    """The library expands a piece to its end, far beyond what the dataset declares."""
    data = file.create_dataset(name, shape=(100,), dtype="f8", chunks=(100,), compression="gzip")
    data.id.write_direct_chunk((0,), zlib.compress(bytes(SIZE)))


def _many_times_over(file: h5py.File, name: str) -> None:
    """Compressed, each time a thousandfold."""
    filters = h5py.h5p.create(h5py.h5p.DATASET_CREATE)
    filters.set_chunk((100,))
    filters.set_deflate(9)
    filters.set_deflate(9)
    space = h5py.h5s.create_simple((100,))
    h5py.h5d.create(file.id, name.encode(), h5py.h5t.NATIVE_DOUBLE, space, filters)


@pytest.mark.parametrize(
    ("make", "message"),
    [
        (_declared, "would become"),
        (_large_piece, "in smaller pieces"),
        (_piece_that_grows, "in smaller pieces"),
        (_many_times_over, "2 times over"),
    ],
)
def test_hdf5_that_grows_is_refused(make, message, tmp_path, monkeypatch):
    path = tmp_path / "log.h5"
    with h5py.File(path, "w") as file:
        for name in ("time_s", "position_mm"):
            make(file, name)
    if make is _large_piece:
        monkeypatch.setattr(reading, "LARGEST_CHUNK", 2**17)
    refused(path, message)


def test_hdf5_does_not_lead_to_other_files(tmp_path):
    """By a link, which is not followed; by numbers that are kept elsewhere; put together of others."""
    path, other, secret = (tmp_path / name for name in ("log.h5", "other.h5", "secret"))
    secret.write_bytes(np.arange(100.0).tobytes())
    with h5py.File(other, "w") as file:
        file["position_mm"] = np.arange(100.0)
    layout = h5py.VirtualLayout(shape=(100,), dtype="f8")
    layout[:] = h5py.VirtualSource(str(other), "position_mm", shape=(100,))
    stored = {"shape": (100,), "dtype": "f8", "external": [(str(secret), 0, 800)]}
    for make, message in (
        (
            lambda at: at.update(position_mm=h5py.ExternalLink("other.h5", "/position_mm")),
            "position_mm",
        ),
        (lambda at: at.create_dataset("position_mm", **stored), "are elsewhere"),
        (lambda at: at.create_virtual_dataset("position_mm", layout), "are elsewhere"),
    ):
        with h5py.File(path, "w") as file:
            file["time_s"] = np.arange(100.0)
            make(file)
        refused(path, message)


def test_matlab_that_grows_is_refused(tmp_path):
    path = tmp_path / "log.mat"
    savemat(path, {"time_s": np.zeros(SIZE // 8), "position_mm": np.zeros(SIZE // 8)}, do_compression=True)
    assert path.stat().st_size < SIZE // reading.RATIO
    refused(path, "would become")


def _mcap(codec: str, content: bytes, declared: int, indexed: bool) -> bytes:
    """A file with one chunk that says a size, or with one that is no chunk and an index that leads to it."""

    def word(text: bytes) -> bytes:
        return struct.pack("<I", len(text)) + text

    def record(kind: int, content: bytes) -> bytes:
        return struct.pack("<BQ", kind, len(content)) + content

    magic, name = b"\x89MCAP0\r\n", word(codec.encode())
    start = magic + record(1, word(b"ros2") + word(b"zwidth"))
    chunk = struct.pack("<QQQI", 0, 1, declared, 0) + name + struct.pack("<Q", len(content)) + content
    data = record(0x05 if indexed else 0x06, chunk)
    about = struct.pack("<QQQQ", 0, 1, len(start), len(chunk) + 9) + word(b"") + struct.pack("<Q", 0)
    index = record(0x08, about + name + struct.pack("<QQ", len(content), declared))
    footer = record(2, struct.pack("<QQI", len(start + data), 0, 0))
    return start + data + index + footer + magic


@pytest.mark.parametrize("indexed", [False, True])
@pytest.mark.parametrize("declared", [2**60, SIZE, 100])
@pytest.mark.parametrize("codec", ["zstd", "lz4"])
def test_chunks_that_grow_are_refused(codec, declared, indexed, tmp_path):
    """By what they say, or as no whole ones by what they become; the index is not followed."""
    pytest.importorskip("rosbags")
    path = tmp_path / "log.mcap"
    content = pa.compress(bytes(SIZE), codec=codec, asbytes=True)
    path.write_bytes(_mcap(codec, content, declared, indexed))
    refused(path, "no whole message" if indexed or declared == 100 else "in smaller pieces")


def _rosbag1(codec: bytes, content: bytes, declared: int, place: int | None) -> bytes:
    """A bag of ROS 1 with one chunk, and an index that says where it is."""

    def record(content: bytes, **fields: bytes) -> bytes:
        named = [name.encode() + b"=" + value for name, value in fields.items()]
        header = b"".join(struct.pack("<I", len(field)) + field for field in named)
        return struct.pack("<I", len(header)) + header + struct.pack("<I", len(content)) + content

    def head(index: int) -> bytes:
        at = struct.pack("<Q", index)
        return record(b" " * 100, op=b"\x03", index_pos=at, conn_count=zero, chunk_count=one)

    magic, zero, one = b"#ROSBAG V2.0\n", struct.pack("<I", 0), struct.pack("<I", 1)
    start = magic + head(0)
    chunk = record(content, op=b"\x05", compression=codec, size=struct.pack("<I", declared))
    begun = struct.pack("<Q", len(start) if place is None else place)
    times = {"start_time": bytes(8), "end_time": bytes(8)}
    about = record(b"", op=b"\x06", ver=one, chunk_pos=begun, count=zero, **times)
    return magic + head(len(start + chunk)) + chunk + about


@pytest.mark.parametrize(
    ("size", "declared", "place", "message"),
    [
        (SIZE, 2**32 - 1, None, "in smaller pieces"),  # by what it says
        (SIZE, 100, None, "in smaller pieces"),  # by what it really becomes
        (100, 100, 50, "index leads to"),  # to bytes that were not looked at
    ],
)
def test_chunks_of_ros_1_that_grow_are_refused(size, declared, place, message, tmp_path):
    pytest.importorskip("rosbags")
    path = tmp_path / "log.bag"
    path.write_bytes(_rosbag1(b"bz2", bz2.compress(bytes(size)), declared, place))
    refused(path, message)


@pytest.mark.parametrize("grown", [False, True])
def test_messages_that_are_compressed_one_by_one(grown, recording, tmp_path):
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


def test_a_bag_that_grows_on_the_disk_is_refused(tmp_path):
    """A whole file of a bag is unpacked to the disk."""
    pytest.importorskip("rosbags")
    path = tmp_path / "bag"
    path.mkdir()
    (path / "metadata.yaml").write_text("rosbag2_bagfile_information: {}", encoding="utf-8")
    for content, message in ((bytes(SIZE), "would become"), (b"\x89MCAP0\r\n", "unpack it first")):
        (path / "bag").write_bytes(pa.compress(content, codec="zstd", asbytes=True))
        refused(path, message)


@pytest.mark.parametrize(("name", "save"), [("log.npz", np.savez_compressed), ("log.npy", np.save)])
def test_arrays_of_objects_are_not_read(name, save, tmp_path):
    """Nothing pickled is run, nothing becomes larger than the file says, and no head is believed."""
    path = tmp_path / name
    save(path, np.array([{"run": "this"}], dtype=object))
    refused(path, "pickled")
    save(path, np.zeros(SIZE // 8))
    if name == "log.npz":
        refused(path, "would become")
    head = io.BytesIO()
    np.lib.format.write_array_header_1_0(head, {"descr": "<f8", "fortran_order": False, "shape": (2**50,)})
    (tmp_path / "log.npy").write_bytes(head.getvalue() + bytes(800))
    if name == "log.npz":
        with zipfile.ZipFile(path, "w") as archive:
            archive.write(tmp_path / "log.npy", "position_m.npy")
    refused(path, "cannot be read")


def test_what_a_recording_becomes_is_read(tmp_path):
    """The bounds are far from what is recorded: a log of the size of the tests' bombs, compressed."""
    path = tmp_path / "log.csv.gz"
    rows = "".join(f"{k / 1000},{round(1e3 * np.sin(k / 97))}\n" for k in range(SIZE // 40))
    text = f"time_s,position_mm\n{rows}".encode()
    path.write_bytes(gzip.compress(text))
    assert len(text) > reading.FREE
    assert zw.read_log(path).samples == SIZE // 40


GOOD = "time_s,position_mm,force_N\n" + "".join(f"{k / 1000},{k % 37},{k % 11}\n" for k in range(2000))
RANDOM = np.random.default_rng(1).bytes(20000)


@pytest.mark.parametrize(
    ("content", "message"),
    [
        (b"", "is empty"),
        (b"\n\n  \n", "is empty"),
        (b"\0" * 5000, "no text"),
        (RANDOM, "no text|no table"),
        (b"time_s,position_mm\n", "no table of numbers"),
        (b"once upon a time\nthere was a wall\n", "no table of numbers"),
        (GOOD.replace("time_s", "when").encode(), 'known to be the time.*"when"'),
        (GOOD.replace("position_mm", "where_mm").encode(), 'known to be the position.*"where_mm"'),
        (GOOD.replace("force_N", "pos_mm").encode(), "may each be the position"),
        (GOOD.replace("force_N", "position_mm").encode(), r'"position_mm", "position_mm \(2\)" may each be'),
        (GOOD.replace("force_N", "time_s").encode(), r'"time_s", "time_s \(2\)" may each be the time'),
        (b"\x89MCAP0\r\n" + RANDOM, "ends in the middle, after 20008 bytes: was it copied whole"),
        (b"\x89MCAP", "ends in the middle"),
        (GOOD.replace("_mm", "").encode(), "has no unit"),
        (GOOD.replace("_mm", " [furlong]").encode(), "furlong"),
        (GOOD.replace("_mm", " [kg]").encode(), "not a length"),
        (GOOD.replace("force_N", "force [N*m]").encode(), "not a force"),
        (GOOD.replace("0.5,", "0.5,oops ", 1).encode(), "near line 502"),
        (GOOD.replace("\n", "\noops", 1).encode(), "near line 2"),
        ((GOOD * 9 + "1,2\n" * 3000).encode(), "another number of columns"),
        (b"time_s,position_mm,force_N\n" + b"0.1,far,2\n" * 50, '"position_mm" holds text, such as "far"'),
        (b"time_s,position_mm\n0,1\n", "fewer than two rows"),
        (b"time_s,position_mm\n" + b"0.001,1\n" * 50, "time stands still"),
        (b"time_s,position_mm\n" + b"".join(b"%f,1\n" % (k / 1000) for k in range(50)), "never changes"),
        (b"PK\x03\x04" + RANDOM, "zip archive"),
        (b"CDF\x01" + RANDOM, "NetCDF 3"),
        (b"PAR1" + RANDOM, "cannot be read"),
        (b"\x89HDF\r\n\x1a\n" + RANDOM, "cannot be read"),
        (b"MATLAB 5.0 MAT-file" + RANDOM, "cannot be read"),
        (b"SQLite format 3\0" + RANDOM, "cannot be read"),
        (b"#ROSBAG V2.0\n" + RANDOM, "cannot be read"),
    ],
)
def test_foreign_content_is_one_message(content, message, tmp_path):
    path = tmp_path / "log.csv"
    path.write_bytes(content)
    with pytest.raises(zw.InputError, match=message) as caught:
        zw.read_log(path)
    assert "\n" not in str(caught.value)
    assert len(str(caught.value)) < 1200


def test_missing_files_and_directories(tmp_path):
    with pytest.raises(zw.InputError, match="no such file"):
        zw.read_log(tmp_path / "none.csv")
    with pytest.raises(zw.InputError, match="no rosbag2"):
        zw.read_log(tmp_path)


def outcome(path: Path) -> tuple[str, int]:
    try:
        log = zw.read_log(path)
        return log.source, sum(b.time.size for b in log.blocks())
    except zw.InputError as error:
        return str(error), 0


def test_a_column_that_is_there_twice_is_told_elsewhere_too(tmp_path):
    path, text = tmp_path / "log.parquet", tmp_path / "log.csv"
    pq.write_table(pa.Table.from_arrays([pa.array([1.0, 2.0])] * 2, names=["position_m"] * 2), path)
    with pytest.raises(zw.InputError, match='more than one column "position_m"'):
        zw.read_log(path)
    text.write_text("a,b,a\n1,2,3\n", encoding="utf-8")
    with pytest.raises(zw.InputError, match="more than one column 'a'; give its number"):
        read_column(text, "a")
    assert read_column(text, 2) == [3.0]


@pytest.mark.parametrize("keep", [0.2, 0.6, 0.95, 0.999])
@pytest.mark.parametrize("kind", ["parquet", "h5", "mat", "csv", "gz"])
def test_truncated_files(kind, keep, tmp_path):
    """A copy that was cut short: a message, or the part that is there with a word about it."""
    columns = {"time_s": np.arange(3000) / 1000, "position_mm": np.arange(3000) % 41 * 1.0}
    path = tmp_path / f"log.{kind}"
    if kind == "parquet":
        pq.write_table(pa.table(columns), path)
    elif kind == "h5":
        with h5py.File(path, "w") as file:
            for name, values in columns.items():
                file[name] = values
    elif kind == "mat":
        scipy.io.savemat(path, columns)
    else:
        path.write_bytes(GOOD.encode() if kind == "csv" else gzip.compress(GOOD.encode()))
    content = path.read_bytes()
    path.write_bytes(content[: int(keep * len(content))])
    said, samples = outcome(path)
    assert str(path) in said
    assert samples < 2000
    assert samples == 0 or kind in ("csv", "mat")


def test_any_damage_is_a_message_or_a_log(tmp_path):
    random, whole = np.random.default_rng(7), b"".join(GOOD.encode().splitlines(keepends=True)[:500])
    path = tmp_path / "log.csv"
    for _ in range(60):
        content = bytearray(whole)
        for place in random.integers(0, len(content), random.integers(1, 30)):
            content[place] = random.choice(list(b"0123456789,;\n\t .-eE#\0\xff\"'x"))
        path.write_bytes(content)
        said, samples = outcome(path)
        assert str(path) in said
        assert samples <= 600


def test_columns_of_different_lengths(tmp_path):
    path = tmp_path / "log.h5"
    with h5py.File(path, "w") as file:
        file["time_s"], file["position_mm"] = np.arange(100) / 1000, np.arange(90.0)
    with pytest.raises(zw.InputError, match="one length"):
        zw.read_log(path)


@pytest.mark.parametrize(
    ("arguments", "message"),
    [
        ({"columns": {"hand_force": "force_n"}}, 'did you mean "force_N"'),
        ({"columns": {"force": "force_N"}}, 'no quantity "force"'),
        ({"units": {"actuator_force": "N"}}, "the log has no actuator_force"),
        ({"scale": {"hand_force": 0}}, "must not be 0"),
        ({"scale": {"hand_force": "0 N/V"}}, "must not be 0"),
        ({"scale": {"hand_force": "two N/V"}}, "no factor"),
    ],
)
def test_a_slip_in_a_dictionary_is_not_silently_ignored(arguments, message, tmp_path):
    path = tmp_path / "log.csv"
    path.write_text(GOOD)
    with pytest.raises(zw.InputError, match=message):
        zw.read_log(path, **arguments)
    assert zw.read_log(path, columns={"hand_force": None}).channels == ()


MEASURED = """
import sys
import zwidth as zw
try:
    log = zw.read_log(sys.argv[1])
    said = str(sum(block.time.size for block in log.blocks()))
except zw.InputError as error:
    said = str(error)
with open("/proc/self/status") as status:  # the peak that getrusage knows may be that of the parent
    peak = next(line for line in status if line.startswith("VmHWM:"))
print(int(peak.split()[1]) // 1024, said)
"""

measured = pytest.mark.skipif(not Path("/proc/self/status").exists(), reason="only Linux says the peak so")


def peak(path: Path, more: str = "") -> tuple[int, str]:
    """[MiB] most memory of a process that reads a file, and what it said."""
    script = MEASURED.replace("sys.argv[1]", f"sys.argv[1]{more}")
    command = [sys.executable, "-c", script, str(path)]
    run = subprocess.run(command, capture_output=True, text=True, check=True)
    memory, _, said = run.stdout.strip().partition(" ")
    return int(memory), said


@measured
@pytest.mark.parametrize("start", [b"", GOOD.encode(), b"PAR1", b"MATLAB 5.0 MAT-file"])
def test_three_gigabytes_of_nothing(start, tmp_path):
    """A sparse file is neither loaded nor believed, whatever it begins with."""
    path = tmp_path / "log.csv"
    with open(path, "wb") as file:
        file.write(start)
        file.truncate(3 * 2**30)
    memory, said = peak(path)
    assert memory < 1500  # half the file: libraries and a block for each processor are less
    assert said == "2000" if start == GOOD.encode() else "log.csv" in said


@measured
def test_a_sparse_hdf5_is_read_in_slices(tmp_path):
    """Three datasets of 1 GB each, never written: nothing moves, and memory stays bounded."""
    path = tmp_path / "log.h5"
    with h5py.File(path, "w") as file:
        for name in ("position_m", "force_N"):
            file.create_dataset(name, shape=(2**25,), dtype="f8", chunks=(2**18,))
        file["position_m"][: 2**18] = np.arange(2**18) % 97 * 1e-5
        file["force_N"][: 2**18] = np.arange(2**18) % 13 * 1.0
        file["position_m"].attrs["units"] = "m"
    memory, said = peak(path, ", sample_rate=1000")
    assert said == str(2**25)
    assert memory < 900
