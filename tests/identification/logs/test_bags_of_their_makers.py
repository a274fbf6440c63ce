"""Bags as the makers' own writers write them: the same samples, chunked, compressed and indexed or not."""

from __future__ import annotations

from pathlib import Path
from struct import pack, unpack_from

import foxglove
import pytest
from identification.logs.test_log_files import assert_same
from known_motion import Recording
from mcap.writer import CompressionType, Writer
from rosbags import rosbag1
from rosbags.typesys import Stores, get_types_from_msg, get_typestore

import zwidth as zw

NAME, DEFINITION, TOPIC = "maker/msg/Sample", "float64 position_m\nfloat64 hand_force_n\n", "/sample"
STAMP = 1_700_000_000_000_000_000


def messages(recording: Recording, ros: int) -> list[tuple[int, bytes]]:
    """Each sample with its time [ns], as ROS 1 or 2 has it."""
    store = get_typestore(Stores.EMPTY)
    store.register(get_types_from_msg(DEFINITION, NAME))
    write = store.serialize_ros1 if ros == 1 else store.serialize_cdr
    made = store.types[NAME]
    samples = zip(*recording, strict=True)
    return [(STAMP + round(t * 1e9), bytes(write(made(x, f), NAME))) for t, x, f in samples]


@pytest.mark.parametrize("compression", ["NONE", "BZ2", "LZ4"])
def test_ros_1_by_rosbags(compression: str, recording: Recording, tmp_path: Path) -> None:
    store = get_typestore(Stores.EMPTY)
    store.register(get_types_from_msg(DEFINITION, NAME))
    writer = rosbag1.Writer(tmp_path / "run.bag")
    if compression != "NONE":
        writer.set_compression(rosbag1.Writer.CompressionFormat[compression])
    with writer:
        topic = writer.add_connection(TOPIC, NAME, typestore=store)
        for stamp, data in messages(recording, 1):
            writer.write(topic, stamp, data)
    assert_same(zw.read_log(tmp_path / "run.bag"), recording)
    if compression == "NONE":
        assert_same(zw.read_log(_with_a_gap(tmp_path / "run.bag")), recording)


def _with_a_gap(path: Path) -> Path:
    """Zero bytes before the index, as a bag has that was gone on with."""
    whole = path.read_bytes()
    at = whole.index(key := b"index_pos=") + len(key)
    (tail,) = unpack_from("<Q", whole, at)
    path.write_bytes(whole[:at] + pack("<Q", tail + 49) + whole[at + 8 : tail] + bytes(49) + whole[tail:])
    return path


@pytest.mark.parametrize(
    ("compression", "chunked"), [("NONE", True), ("NONE", False), ("LZ4", True), ("ZSTD", True)]
)
def test_mcap_by_its_own_library(
    compression: str, chunked: bool, recording: Recording, tmp_path: Path
) -> None:
    with open(tmp_path / "run.mcap", "wb") as file:
        kind = CompressionType[compression]
        writer = Writer(file, chunk_size=9000, compression=kind, use_chunking=chunked)
        writer.start(profile="ros2", library="another")
        schema = writer.register_schema(NAME, "ros2msg", DEFINITION.encode())
        topic = writer.register_channel(TOPIC, "cdr", schema)
        for stamp, data in messages(recording, 2):
            writer.add_message(topic, stamp, data, stamp)
        writer.finish()
    assert_same(zw.read_log(tmp_path / "run.mcap"), recording)


@pytest.mark.parametrize(
    ("encoding", "profile", "compression", "chunked"),
    [
        ("cdr", "ros2", None, True),
        ("cdr", "ros2", None, False),
        ("cdr", "ros2", "Lz4", True),
        ("cdr", "ros2", "Zstd", True),
        ("cdr", None, "Zstd", True),
        ("json", None, None, False),
        ("json", None, "Zstd", True),
    ],
)
def test_mcap_by_foxglove(
    encoding: str,
    profile: str | None,
    compression: str | None,
    chunked: bool,
    recording: Recording,
    tmp_path: Path,
) -> None:
    """Of ROS 2 whether the file says so or not; and JSON, its default."""
    schema = foxglove.Schema(name=NAME, encoding="ros2msg", data=DEFINITION.encode())
    context = foxglove.Context()
    topic = foxglove.Channel(
        TOPIC, schema=schema if encoding == "cdr" else None, message_encoding=encoding, context=context
    )
    options = foxglove.mcap.MCAPWriteOptions(
        profile=profile,
        chunk_size=9000,
        use_chunks=chunked,
        compression=compression and getattr(foxglove.mcap.MCAPCompression, compression),
    )
    said = zip(*recording, strict=True)
    with foxglove.open_mcap(tmp_path / "run.mcap", context=context, writer_options=options):
        for (stamp, data), (_, x, f) in zip(messages(recording, 2), said, strict=True):
            numbers = {"position_m": float(x), "hand_force_N": float(f)}
            topic.log(data if encoding == "cdr" else numbers, log_time=stamp)
    assert_same(zw.read_log(tmp_path / "run.mcap"), recording)
