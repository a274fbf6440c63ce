"""What a recorder writes is what the loop wrote, to the last bit; what it could not write it says."""

import sys

import numpy as np
import pytest
from full_disk import full_disk
from written_rows import COLUMNS, WrittenRows, drawn

from zwidth import InputError
from zwidth.machine.servo.recording.recorder import Recorder
from zwidth.machine.servo.recording.recording import read_recording


def stacked(recording):
    assert tuple(recording.columns) == COLUMNS
    return np.column_stack(list(recording.columns.values()))


def test_what_is_read_is_what_was_written(tmp_path):
    table = drawn(5000)
    table[7, 3:6] = np.inf, -0.0, 5e-324
    rows = WrittenRows(table)
    recorder = Recorder(rows, tmp_path / "run.mcap")
    said = dict(rows.about)
    rows.about["later"] = "is not in the file"
    rows.written = 3000
    rows.events.append({"event": "law changed", "sample": 2999, "specification": 'type = "wall"'})
    rows.events.append({"event": "ended", "sample": np.int64(4999), "why": "µ ended “it”"})
    rows.written = 5000
    done = recorder.close()
    assert (done.rows, done.rows_lost, done.failure) == (5000, 0, None)
    assert "5,000 rows, none lost" in done.describe()
    found = read_recording(done.path)
    assert stacked(found).tobytes() == table.tobytes()
    assert (found.motion, found.period, found.title, found.about) == ("linear", 1e-3, rows.title, said)
    assert found.events == [rows.events[0], {**rows.events[1], "sample": 4999}]
    assert (found.whole, found.rows_lost, found.samples) == (True, 0, 5000)


def test_rows_that_the_ring_wrote_over_are_counted(tmp_path):
    """A recorder that comes too late says how many are lost, and between which samples."""
    rows = WrittenRows(drawn(1000), kept=100)
    with Recorder(rows, tmp_path / "run.mcap") as recorder:
        rows.written = 1000
    done = recorder.close()
    assert (done.rows, done.rows_lost) == (100, 900)
    assert "900 rows were lost" in done.describe()
    found = read_recording(done.path)
    assert (found.whole, found.rows_lost, found.missed) == (True, 900, 0)
    assert found.events == [{"event": "rows lost", "rows": 900, "after_sample": None, "before_sample": 900.0}]
    assert stacked(found).tobytes() == drawn(1000)[900:].tobytes()


def test_missed_samples_are_not_lost_rows(record):
    """The loop numbers its samples: what is missing in the numbers was never a row."""
    found = record(np.delete(drawn(100), [10, 11, 50], axis=0))
    assert (found.missed, found.rows_lost) == (3, 0)


def test_a_recording_without_rows_is_whole(record):
    found = record(drawn(0))
    assert found.whole
    assert found.samples == 0
    assert "samples" in repr(found)


def test_what_is_there_is_replaced_only_when_asked(tmp_path):
    path = tmp_path / "run.mcap"
    for seed in (1, 2):
        rows = WrittenRows(drawn(40 * seed, seed))
        with Recorder(rows, path, force=seed == 2):
            rows.written = 40 * seed
    assert stacked(read_recording(path)).tobytes() == drawn(80, 2).tobytes()
    with pytest.raises(InputError, match="exists; choose another name"):
        Recorder(WrittenRows(drawn(1)), path)
    assert read_recording(path).samples == 80


@pytest.mark.parametrize("name", ["run.csv", "run", "run.parquet", "missing/run.mcap"])
def test_a_place_that_cannot_be_written_is_refused_before_the_loop_begins(tmp_path, name):
    with pytest.raises(InputError):
        Recorder(WrittenRows(drawn(1)), tmp_path / name)
    assert not list(tmp_path.iterdir())


def test_a_full_disk_ends_the_recording_and_nothing_else(tmp_path):
    rows = WrittenRows(drawn(4000))
    recorder = Recorder(rows, tmp_path / "run.mcap")
    before = recorder.so_far().size
    with full_disk(largest=before + 50_000):
        rows.written = 4000
        done = recorder.close()
    assert done.failure is not None
    assert "the recording ended early" in done.describe()
    assert (tmp_path / "run.mcap").stat().st_size == before
    found = read_recording(tmp_path / "run.mcap")
    assert not found.whole
    assert found.samples == done.rows == 0


@pytest.mark.parametrize("compressed", [True, False])
def test_a_table_that_others_read(compressed, record, tmp_path, monkeypatch):
    """Compressed or, where nothing is installed that could, not."""
    with monkeypatch.context() as without:
        if not compressed:
            without.setitem(sys.modules, "pyarrow", None)
        found = record(drawn(300), {"event": "began"})
        assert found.whole
    assert ((tmp_path / "run.mcap").stat().st_size < 300 * 8 * 17) == compressed
    from rosbags.highlevel import AnyReader
    from rosbags.typesys import Stores, get_typestore

    with AnyReader([tmp_path / "run.mcap"], default_typestore=get_typestore(Stores.LATEST)) as reader:
        found, stamps, told = [], [], []
        for connection, stamp, raw in reader.messages():
            message = reader.deserialize(raw, connection.msgtype)
            if connection.topic == "/zwidth/events":
                told.append(message.data)
                continue
            stamps.append(stamp)
            found.append([getattr(message, name.lower()) for name in COLUMNS])
    assert np.array(found).tobytes() == drawn(300).tobytes()
    assert told == ['{"event": "began"}']
    assert np.diff(stamps) == pytest.approx(1e6, abs=2)  # [ns], rounded


def test_the_index_leads_to_every_chunk(tmp_path):
    reader = pytest.importorskip("mcap.reader")
    rows = WrittenRows(drawn(300))
    with Recorder(rows, tmp_path / "run.mcap"):
        rows.written = 300
    with open(tmp_path / "run.mcap", "rb") as file:
        opened = reader.make_reader(file, validate_crcs=True)
        summary = opened.get_summary()
        assert summary.statistics.message_count == 300
        assert [m.name for m in opened.iter_metadata()] == ["zwidth recording", "zwidth end"]
        samples = opened.iter_messages(topics=["/zwidth/model/samples"])
        assert [message.sequence for _, _, message in samples] == list(range(300))


def test_a_file_that_another_program_wrote_anew(record, tmp_path):
    """Other chunks and compression, channels inside, messages of others between: the rows are the same."""
    mcap_reader, mcap_writer = pytest.importorskip("mcap.reader"), pytest.importorskip("mcap.writer")
    record(drawn(700), {"event": "began"})
    with open(tmp_path / "run.mcap", "rb") as file, open(tmp_path / "anew.mcap", "wb") as anew:
        reader = mcap_reader.make_reader(file)
        writer = mcap_writer.Writer(anew, chunk_size=9000, compression=mcap_writer.CompressionType.LZ4)
        writer.start(profile="ros2", library="another")
        said = list(reader.iter_metadata())
        writer.add_metadata(said[0].name, said[0].metadata)
        other = writer.register_channel("/other", "json", 0)
        channels = {}
        for schema, channel, message in reader.iter_messages():
            if channel.topic not in channels:
                kind = writer.register_schema(schema.name, schema.encoding, schema.data)
                channels[channel.topic] = writer.register_channel(channel.topic, "cdr", kind)
            if message.sequence % 7 == 0:
                writer.add_message(other, message.log_time, b"{}", message.log_time)
            place = channels[channel.topic]
            writer.add_message(place, message.log_time, message.data, message.publish_time, message.sequence)
        writer.add_metadata(said[1].name, said[1].metadata)
        writer.finish()
    found = read_recording(tmp_path / "anew.mcap")
    assert stacked(found).tobytes() == drawn(700).tobytes()
    assert found.events == [{"event": "began"}]
    assert found.whole


def test_a_file_that_foxglove_wrote_anew(tmp_path):
    """Its numbers of messages begin at 1, its chunks are its own: the rows are the same."""
    import foxglove
    from mcap.reader import make_reader

    rows = WrittenRows(drawn(700))
    rows.events.append({"event": "began"})
    with Recorder(rows, tmp_path / "run.mcap"):
        rows.written = 700
    context = foxglove.Context()
    with open(tmp_path / "run.mcap", "rb") as file:
        reader = make_reader(file, validate_crcs=True)
        begins, ends = reader.iter_metadata()
        with foxglove.open_mcap(tmp_path / "anew.mcap", context=context) as writer:
            writer.write_metadata(begins.name, begins.metadata)
            topics = {}
            for schema, channel, message in reader.iter_messages():
                kind = foxglove.Schema(name=schema.name, encoding=schema.encoding, data=schema.data)
                if channel.topic not in topics:
                    topics[channel.topic] = foxglove.Channel(
                        channel.topic, schema=kind, message_encoding="cdr", context=context
                    )
                topics[channel.topic].log(message.data, log_time=message.log_time)
            writer.write_metadata(ends.name, ends.metadata)
    found = read_recording(tmp_path / "anew.mcap")
    assert stacked(found).tobytes() == drawn(700).tobytes()
    assert found.events == rows.events
    assert found.whole
