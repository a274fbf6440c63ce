"""Every format gives the same log; columns and units are recognised, or asked for."""

from __future__ import annotations

import bz2
import gzip
import io
import json
import shutil
import sys
from collections.abc import Iterable
from functools import cache
from pathlib import Path
from typing import Any

import h5py
import numpy as np
import pyarrow as pa
import pyarrow.parquet as pq
import pytest
import scipy.io
import xarray as xr

import zwidth as zw
from zwidth.data.logs.columns import name_and_unit
from zwidth.data.logs.table import LEFT_OUT
from zwidth.data.logs.text import text_table

HEADER = ("time_s", "position_mm", "force_N")
UNITS = {"time": "s", "position": "mm", "hand_force": "N"}


def by_name(time: str, position: str, hand_force: str) -> dict[str, str]:
    return {"time": time, "position": position, "hand_force": hand_force}


def text_of(recording, sep=",", header=HEADER, decimal=".") -> str:
    rows = np.stack([recording.time, recording.position * 1e3, recording.force], axis=1).tolist()
    lines = [sep.join(header)] if header else []
    lines += [sep.join(map(repr, row)).replace(".", decimal) for row in rows]
    return "\n".join(lines) + "\n"


def assert_same(log: zw.Log, recording, force: bool = True) -> None:
    blocks = list(log.blocks())
    assert np.abs(np.concatenate([b.time for b in blocks]) - recording.time).max() < 1e-12
    assert np.abs(np.concatenate([b.position for b in blocks]) - recording.position).max() < 1e-15
    if force:
        assert (np.concatenate([b.hand_force for b in blocks]) == recording.force).all()
    assert log.sample_period == 5e-4
    assert log.resolution == pytest.approx(22.4e-6, rel=1e-9)


@pytest.mark.parametrize(
    ("name", "sep", "header", "decimal"),
    [
        ("plain.csv", ",", HEADER, "."),
        ("brackets.csv", ",", ("Time [s]", "enc (mm)", '"load cell [N]"'), "."),
        ("slashes.csv", ",", ("t / s", "x / mm", "F / N"), "."),
        ("german.csv", ";", HEADER, ","),
        ("tab.tsv", "\t", HEADER, "."),
        ("tab.csv", "\t", HEADER, ","),
        ("bars.txt", "|", HEADER, "."),
        ("space.txt", "   ", HEADER, "."),
        ("units-below.csv", ",", ("time,pos,force\ns", "mm", "N"), "."),
        ("preamble.csv", ",", ("Logger 3.1\nday, monday, rain\n\ntime_s", "position_mm", "force_N"), "."),
        ("comment.dat", " ", ("# written by savetxt\n# time_s", "position_mm", "force_N"), "."),
        ("json-comment.csv", ",", ('# {"who": "me"}\ntime_s', "position_mm", "force_N"), "."),
        ("other-delimiter.csv", ";", ("time_s,position_mm,force_N",), "."),
        ("log.csv.gz", ",", HEADER, "."),
        ("log.csv.bz2", ",", HEADER, "."),
    ],
)
def test_texts(name, sep, header, decimal, recording, tmp_path):
    path = tmp_path / name
    packed = {".gz": gzip.compress, ".bz2": bz2.compress}.get(path.suffix, bytes)
    path.write_bytes(packed(text_of(recording, sep, header, decimal).encode()))
    assert_same(zw.read_log(path), recording)


def test_texts_without_a_header_have_numbered_columns(recording, tmp_path):
    path = tmp_path / "bare.txt"
    path.write_text(text_of(recording, " ", ()))
    with pytest.raises(zw.InputError, match='"column 1", "column 2", "column 3"'):
        zw.read_log(path)
    columns = by_name("column 1", "column 2", "column 3")
    with pytest.raises(zw.InputError, match="has no unit"):
        zw.read_log(path, columns=columns)
    assert_same(zw.read_log(path, columns=columns, units=UNITS), recording)


def test_the_first_rows_are_looked_at_once(tmp_path):
    """However many delimiters a line may have, and however often the file is opened."""
    path = tmp_path / "log.csv"
    lines = ["time_s,position_m,hand_force_N,motor_force_N"]
    lines += [f"{k / 1000:.3f},{k % 7 / 1000:.4f},-1.25,0.5" for k in range(1000)]
    path.write_text("\n".join(lines), encoding="utf-8")
    calls = 0

    def count(frame, event, _) -> None:
        nonlocal calls
        calls += event == "call" and "zwidth" in frame.f_code.co_filename

    text_table(path)  # what is imported at first
    path.write_text("\n".join([*lines, "1.0,0.0001,0.25,0.5"]), encoding="utf-8")
    sys.setprofile(count)
    try:
        tables = [text_table(path) for _ in range(3)]
    finally:
        sys.setprofile(None)
    assert list(tables[0].units) == list(tables[2].units) == lines[0].split(",")
    assert calls < 10 * 1000


def test_texts_with_scars(recording, tmp_path):
    path, text = tmp_path / "log.csv", text_of(recording)
    lines = text.splitlines(keepends=True)
    lines[100] = "# the hand let go\n" + lines[100]
    lines[500] = "0.2,0.4\n"
    for content, counts, kinds in (
        (text + text, (2, 8000), {"headers", "restart"}),
        ("".join(lines) + "\0" * 70000, (2, 3999), {"broken rows", "zeros", "gap"}),
        (text[:-9], (1, 3999), {"unfinished"}),
    ):
        path.write_text(content, encoding="utf-8")
        log = zw.read_log(path)
        assert (log.runs, log.samples) == counts
        assert kinds <= {finding.kind for finding in log.findings}


def test_dates_and_integers_in_text(recording, tmp_path):
    nanoseconds = 1_700_000_000_000_000_000 + np.rint(recording.time * 1e9).astype(np.int64)
    dates = nanoseconds.astype("datetime64[ns]").astype(str)
    for name, stamps in (("timestamp", dates), ("t_ns", nanoseconds.tolist())):
        path = tmp_path / f"{name}.csv"
        rows = zip(stamps, (recording.position * 1e3).tolist(), strict=True)
        body = "".join(f"{s},{x},note\n" for s, x in rows)
        path.write_text(f"{name},position_mm,remark\n{body}")
        assert_same(zw.read_log(path), recording, force=False)


def test_parquet_in_any_types(recording, tmp_path):
    counts = np.rint(recording.position / 22.4e-6).astype(np.int16)
    stamps = pa.array(1_700_000_000_000_000 + np.rint(recording.time * 1e6).astype(np.int64)).cast(
        pa.timestamp("us")
    )
    force = pa.field("f_h", pa.float64(), metadata={"units": "mN"})
    schema = pa.schema([("stamp", pa.timestamp("us")), ("enc_counts", pa.int16()), force])
    table = pa.table([stamps, counts, pa.array((recording.force * 1e3).tolist())], schema=schema)
    pq.write_table(table, tmp_path / "log.parquet", row_group_size=999)
    log = zw.read_log(tmp_path / "log.parquet", resolution="22.4 um")
    (block,) = log.blocks()
    assert np.abs(block.hand_force - recording.force).max() < 1e-12
    assert_same(log, recording, force=False)
    with_null = table.set_column(1, "enc_counts", pa.array([None, *counts[1:].tolist()], pa.int16()))
    pq.write_table(with_null, tmp_path / "null.parquet")
    assert zw.read_log(tmp_path / "null.parquet", resolution="22.4 um").samples == 3999


NANOSECONDS = (np.arange(4000) * 500_000 + 86_399 * 10**9).astype(np.int64)
"""From a second before midnight on."""


@pytest.mark.parametrize(
    ("name", "stamps"),
    [
        ("elapsed", pa.array(NANOSECONDS).cast(pa.duration("ns"))),
        ("elapsed", pa.array(NANOSECONDS // 1000).cast(pa.duration("us"))),
        ("clock", pa.array(NANOSECONDS % (86400 * 10**9)).cast(pa.time64("ns"))),
        ("clock", pa.array(NANOSECONDS // 1000 % (86400 * 10**6)).cast(pa.time64("us"))),
        ("__index_level_0__", pa.array(NANOSECONDS).cast(pa.timestamp("ns"))),
        ("__index_level_0__", pa.array(NANOSECONDS).cast(pa.duration("ns"))),
        ("stamp", pa.array(NANOSECONDS.astype("datetime64[ns]").astype(str))),
        ("stamp", pa.array([f"{text}Z" for text in NANOSECONDS.astype("datetime64[ns]").astype(str)])),
        ("t_ns", pa.array([str(n) for n in NANOSECONDS])),
    ],
    ids=range(9),
)
def test_parquet_has_times_of_any_type(name, stamps, recording, tmp_path):
    """Of a frame with an index that nobody named too; times of day go on past midnight."""
    table = pa.table({"remark": ["x"] * 4000, "position_m": recording.position, name: stamps})
    pq.write_table(table, tmp_path / "log.parquet", row_group_size=1500)
    log = zw.read_log(tmp_path / "log.parquet")
    (block,) = log.blocks()
    assert np.abs(block.time - block.time[0] - recording.time).max() < 1e-10
    assert log.sample_period == 5e-4
    assert (block.position == recording.position).all()


def lerobot_dataset(folder: Path, recording, about: dict[str, Any], names: Any) -> Path:
    """Two episodes of one joint in one file."""
    frame = np.tile(np.arange(500), 2)
    state = np.stack([1e3 * recording.position[:1000], np.ones(1000)], axis=1).astype(np.float32)
    columns = {
        "observation.state": pa.FixedSizeListArray.from_arrays(state.ravel(), 2),
        "timestamp": (frame / 30).astype(np.float32),
        "frame_index": frame,
        "episode_index": np.repeat([0, 1], 500),
    }
    (folder / "data" / "chunk-000").mkdir(parents=True)
    (folder / "meta").mkdir()
    features = {"observation.state": {"dtype": "float32", "shape": [2], "names": names}}
    said = json.dumps({**about, "features": features})
    (folder / "meta" / "info.json").write_text(said, encoding="utf-8")
    pq.write_table(pa.table(columns), folder / "data" / "chunk-000" / "file-000.parquet")
    return folder


@pytest.mark.parametrize(
    ("robot", "version", "names", "column", "likely"),
    [
        ("so101_follower", "v3.0", ["pan.pos", "gripper.pos"], "pan.pos", "degrees since LeRobot 0.4.4"),
        ("so101_follower", "v2.1", ["pan.pos", "gripper.pos"], "pan.pos", "mostly -100 … 100"),
        ("so101_follower", "v3.0", ["pan.pos", "gripper.pos"], "gripper.pos", "mostly 0 … 100"),
        ("so100", "v2.1", {"motors": ["main_pan", "main_gripper"]}, "main_pan", "mostly degrees"),
        ("koch_follower", "v3.0", [["pan.pos", "gripper.pos"]], "pan.pos", "mostly -100 … 100"),
        ("lekiwi", "v3.0", {"gripper.pos": 1, "pan.pos": 0}, "pan.pos", "since LeRobot 0.6.0"),
        ("openarm_follower", "v3.0", ["joint_1.pos", "joint_2.pos"], "joint_1.pos", "mostly degrees"),
        ("aloha", "v2.1", ["a"], "0", "use_degrees"),  # names that are not those of two numbers
    ],
)
def test_a_lerobot_dataset_is_a_folder_with_names(robot, version, names, column, likely, recording, tmp_path):
    about = {"robot_type": robot, "codebase_version": version}
    folder = lerobot_dataset(tmp_path / "set", recording, about, names)
    asked = {"columns": {"position": f"observation.state[{column}]"}}
    with pytest.raises(zw.InputError, match=f"has no unit: .*{likely}.*state it"):
        zw.read_log(folder, **asked)
    if "gripper" in column:
        return
    log = zw.read_log(folder, **asked, units={"position": "deg"})
    assert (log.runs, log.samples) == (2, 1000)
    blocks = np.concatenate([block.position for block in log.blocks()])
    assert np.abs(np.degrees(blocks) - 1e3 * recording.position[:1000]).max() < 1e-4
    assert {"no clock", "episodes"} <= {finding.kind for finding in log.findings}


@pytest.mark.parametrize(
    ("names", "ends"),  # of files, and the episode behind the last of each
    [
        (["chunk-000/episode_000000", "chunk-000/episode_000001", "chunk-001/episode_000002"], [1, 2, 3]),
        (["chunk-000/file-000"], [3]),
        (["chunk-000/file-000", "chunk-000/file-001"], [1, 3]),
    ],
    ids=["v2.1", "v3.0 in a file", "v3.0 in two"],
)
def test_a_folder_of_episodes_is_read_whole_or_one_by_its_number(names, ends, recording, tmp_path):
    """By the folder, one inside it, one above it; above several each is named."""
    folder = lerobot_dataset(tmp_path / "user" / "set", recording, {}, ["pan.pos", "b"])
    data = folder / "data"
    (whole,) = data.rglob("*.parquet")
    table = pq.read_table(whole).append_column("task", pa.array([0] * 1000))
    table = pa.concat_tables([table, table.slice(0, 300).set_column(3, "episode_index", pa.array([2] * 300))])
    whole.unlink()
    starts = {0: 0, 1: 500, 2: 1000, 3: 1300}
    for name, first, end in zip(names, [0, *ends], ends, strict=False):
        (data / name).parent.mkdir(exist_ok=True)
        part = table.slice(starts[first], starts[end] - starts[first])
        pq.write_table(part, data / f"{name}.parquet", row_group_size=200)
    asked = {"columns": {"position": "observation.state[pan.pos]"}, "units": {"position": "deg"}}
    for path in (folder, data, folder.parent, tmp_path):
        log = zw.read_log(path, **asked)
        assert (log.runs, log.samples) == (3, 1300)
        assert any("3 episodes of a LeRobot dataset, 0 to 2" in finding.text for finding in log.findings)
    log = zw.read_log(folder, **asked, sheet="1")
    (block,) = log.blocks()
    assert np.abs(np.degrees(block.position) - 1e3 * recording.position[500:1000]).max() < 1e-4
    assert any("episode 1 of 3 episodes" in f.text and LEFT_OUT in f.text for f in log.findings)
    for sheet in ("3", "first"):
        with pytest.raises(zw.InputError, match=f'no episode "{sheet}": there are 3 .*0 to 2'):
            zw.read_log(folder, **asked, sheet=sheet)
    lerobot_dataset(tmp_path / "other", recording, {}, ["pan.pos", "b"])
    with pytest.raises(zw.InputError, match=r'holds 2 LeRobot datasets, ".*other", ".*set": name one'):
        zw.read_log(tmp_path, **asked)


def test_what_is_no_folder_of_episodes_is_refused(recording, tmp_path):
    first = {"time_s": recording.time, "position_m": recording.position}
    for name in "ab":
        pq.write_table(pa.table(first), tmp_path / f"{name}.parquet")
    folder = lerobot_dataset(tmp_path / "set" / "one", recording, {}, None)
    (whole,) = folder.rglob("*.parquet")
    pq.write_table(
        pq.read_table(whole).drop_columns("observation.state"), whole.with_name("file-001.parquet")
    )
    (tmp_path / "bare" / "meta").mkdir(parents=True)
    (tmp_path / "bare" / "meta" / "info.json").write_text("{}", encoding="utf-8")
    state = {"columns": {"position": "observation.state[0]"}, "units": {"position": "deg"}}
    for path, asked, said in (
        (tmp_path / "a.parquet", {"sheet": "1"}, 'no LeRobot dataset: leave sheet="1" out'),
        (tmp_path / "bare", {}, "nothing is in .*data; name a file"),
        (folder, state, 'file-001.* has no column "observation.state", as the first file'),
    ):
        with pytest.raises(zw.InputError, match=said):
            zw.read_log(path, **asked)
    whole.with_name("file-001.parquet").write_bytes(b"PAR1")
    with pytest.raises(zw.InputError, match=r"file-001.parquet cannot be read"):
        zw.read_log(folder, **state)
    for name in ("file-000", "file-001"):
        whole.with_name(f"{name}.parquet").write_bytes(b"version https://git-lfs.github.com/spec/v1\n")
    for path in (folder, whole):
        with pytest.raises(zw.InputError, match=r"file-000\.parquet is a pointer of Git LFS .* git lfs pull"):
            zw.read_log(path, **state)
    for inside in ("set", "bare"):
        shutil.rmtree(tmp_path / inside)
    with pytest.raises(
        zw.InputError, match=r"no LeRobot dataset: name one of its files, such as .*a\.parquet"
    ):
        zw.read_log(tmp_path)


def test_hdf5_groups_matrices_and_compounds(recording, tmp_path):
    path = tmp_path / "log.h5"
    matrix = np.stack([recording.time, recording.position * 1e3, recording.force], axis=1)
    with h5py.File(path, "w") as file:
        for name, unit, values in (("time", "s", 0), ("position", "mm", 1), ("force", "N", 2)):
            data = file.create_dataset(f"robot/left/{name}", data=matrix[:, values], chunks=(700,))
            data.attrs["units"] = unit
        file["tall"], file["wide"] = matrix, matrix.T
        file["label"] = "a text"
        file["rows"] = np.rec.fromarrays(matrix.T, names="time_s,x_mm,fh_N")
    for names in (
        ("robot/left/time", "robot/left/position", "robot/left/force"),
        ("rows.time_s", "rows.x_mm", "rows.fh_N"),
    ):
        assert_same(zw.read_log(path, columns=by_name(*names)), recording)
    for name in ("tall", "wide"):
        columns = by_name(*(f"{name}[{k}]" for k in range(3)))
        assert_same(zw.read_log(path, columns=columns, units=UNITS), recording)
    with pytest.raises(zw.InputError, match="may each be the time"):
        zw.read_log(path)


def test_netcdf_is_unpacked(recording, tmp_path):
    counts = np.rint(recording.position / 22.4e-6)
    counts[50] = np.nan
    time = ("time", recording.time * 1e3, {"units": "milliseconds"})
    data = xr.Dataset({"encoder": ("time", counts * 22.4e-6, {"units": "m"}), "time": time})
    packed = {"encoder": {"dtype": "int16", "scale_factor": 22.4e-6, "_FillValue": -32768}}
    data.to_netcdf(tmp_path / "log.nc", engine="h5netcdf", encoding=packed)
    log = zw.read_log(tmp_path / "log.nc")
    assert log.samples == 3999
    assert log.runs == 2
    assert log.resolution == pytest.approx(22.4e-6, rel=1e-9)


def test_matlab_old_and_new(recording, tmp_path):
    vectors = {"time_s": recording.time, "position_mm": recording.position * 1e3, "force_N": recording.force}
    scipy.io.savemat(tmp_path / "v5.mat", {"log": {"run": vectors}, "note": "hello"})
    assert_same(zw.read_log(tmp_path / "v5.mat"), recording)
    scipy.io.savemat(tmp_path / "matrix.mat", {"data": np.stack(list(vectors.values()))})
    columns = by_name("data[0]", "data[1]", "data[2]")
    assert_same(zw.read_log(tmp_path / "matrix.mat", columns=columns, units=UNITS), recording)
    with h5py.File(tmp_path / "v73.mat", "w", userblock_size=512) as file:
        for name, values in vectors.items():
            file[name] = values[np.newaxis, :]
    with open(tmp_path / "v73.mat", "r+b") as raw:
        raw.write(b"MATLAB 7.3 MAT-file, Platform: GLNXA64")
    assert_same(zw.read_log(tmp_path / "v73.mat"), recording)


def signals_of(recording, labels: tuple[str, str]) -> Any:
    """What a scope of Simulink saves of two axes, as a structure with time."""
    signals = np.empty((1, 2), dtype=[("values", "O"), ("dimensions", "O"), ("label", "O")])
    for k, (values, label) in enumerate(
        zip((1e3 * recording.position, recording.force), labels, strict=True)
    ):
        signals[0, k] = (values[:, np.newaxis], 1.0, label)
    return {"scope": {"time": recording.time[:, np.newaxis], "signals": signals, "blockName": "a/Scope"}}


@pytest.mark.parametrize(
    ("labels", "names", "units"),
    [
        (("position (mm)", "hand force [N]"), (None, None), {}),
        (("read x (mm)", "load (N)"), ("signals[0].read x (mm)", "signals[1].load (N)"), {}),
        (("read x (mm)", "load (N)"), ("signals[0].values", "signals[1].values"), {}),
        (("", "  "), ("signals[0].values", "signals[1].values"), {"position": "mm", "hand_force": "N"}),
    ],
)
def test_signals_of_simulink_are_known_by_label_and_by_place(labels, names, units, recording, tmp_path):
    scipy.io.savemat(tmp_path / "scope.mat", signals_of(recording, labels))
    chosen = {q: f"scope.{n}" for q, n in zip(("position", "hand_force"), names, strict=True) if n}
    assert_same(zw.read_log(tmp_path / "scope.mat", columns=chosen, units=units), recording)


def test_lists_of_matlab_7_3_lead_to_their_numbers(recording, tmp_path):
    with h5py.File(tmp_path / "scope.mat", "w") as file:
        hidden = [file.create_dataset(f"#refs#/{k}", data=values) for k, values in enumerate(recording[:3])]
        label = file.create_dataset("#refs#/label", data=np.frombuffer(b"position", np.uint8).astype("u2"))
        label.attrs["MATLAB_class"] = np.bytes_("char")
        leads = np.array([each.ref for each in (*hidden, label)], dtype=h5py.ref_dtype)
        file["scope/values"] = leads[:, np.newaxis]
    columns = by_name(*(f"scope/values[{k}]" for k in range(3)))
    log = zw.read_log(tmp_path / "scope.mat", columns=columns, units={**UNITS, "position": "m"})
    assert_same(log, recording)
    with pytest.raises(zw.InputError, match=r"values\[2\]\"$"):  # no letters among the numbers
        zw.read_log(tmp_path / "scope.mat")


def test_what_scipy_says_of_a_file_is_a_finding(recording, tmp_path, recwarn):
    whole = io.BytesIO()
    scipy.io.savemat(whole, {"time_s": recording.time, "position_mm": 1e3 * recording.position})
    again = io.BytesIO()
    scipy.io.savemat(again, {"position_mm": 1e3 * recording.position})
    (tmp_path / "log.mat").write_bytes(whole.getvalue() + again.getvalue()[128:])
    log = zw.read_log(tmp_path / "log.mat")
    assert_same(log, recording, force=False)
    assert any('"position_mm"' in finding.text and "\n" not in finding.text for finding in log.findings)
    assert len(recwarn) == 0


def of_numpy(kind: str, path: Path, recording) -> dict[str, Any]:
    """Write it; how to read it."""
    stamps = (1e9 * recording.time).round().astype(np.int64)
    columns = {
        "t_s": recording.time,
        "position_mm": 1e3 * recording.position,
        "hand_force_N": recording.force,
    }
    if kind in ("archive", "compressed"):
        {"archive": np.savez, "compressed": np.savez_compressed}[kind](path, **columns, rate=2000.0)
    elif kind == "fields":
        np.save(path, np.rec.fromarrays(list(columns.values()), names=",".join(columns)))
    elif kind in ("rows", "columns"):
        matrix = np.stack(list(columns.values()), axis=1)
        np.save(path, matrix if kind == "rows" else np.asfortranarray(matrix.T))
        return {"columns": by_name(*(f"data[{k}]" for k in range(3))), "units": UNITS}
    else:
        dates = stamps.astype("timedelta64[ns]") if kind == "durations" else stamps.astype("datetime64[ns]")
        np.savez(path, **{**columns, "t_s": dates})
    return {}


@pytest.mark.parametrize("kind", ["archive", "compressed", "fields", "rows", "columns", "durations", "dates"])
def test_files_of_numpy(kind, recording, tmp_path):
    path = tmp_path / ("log.npy" if kind in ("fields", "rows", "columns") else "log.npz")
    assert_same(zw.read_log(path, **of_numpy(kind, path, recording)), recording)


@pytest.mark.parametrize("storage", ["MCAP", "SQLITE3"])
def test_rosbags(storage, recording, tmp_path):
    from rosbags.rosbag2 import StoragePlugin, Writer
    from rosbags.typesys import Stores, get_typestore

    store = get_typestore(Stores.ROS2_HUMBLE)
    types = store.types
    time_type, header_type = types["builtin_interfaces/msg/Time"], types["std_msgs/msg/Header"]
    vector, wrench = types["geometry_msgs/msg/Vector3"], types["geometry_msgs/msg/Wrench"]
    joint, stamped = types["sensor_msgs/msg/JointState"], types["geometry_msgs/msg/WrenchStamped"]
    path, none = tmp_path / "bag", np.empty(0)
    with Writer(path, version=9, storage_plugin=StoragePlugin[storage]) as writer:
        first = writer.add_connection("/joint_states", joint.__msgtype__, typestore=store)
        second = writer.add_connection("/hand", stamped.__msgtype__, typestore=store)
        for t, x, f in zip(*recording, strict=True):
            now = 1_700_000_000_000_000_000 + round(t * 1e9)
            for connection, late in ((first, 0), (second, 60_000)):
                header = header_type(stamp=time_type(*divmod(now + late, 10**9)), frame_id="")
                push = wrench(force=vector(0.0, 0.0, f), torque=vector(0.0, 0.0, 0.0))
                joints = joint(header, ["stylus"], np.array([x]), none, none)
                message = joints if connection is first else stamped(header, push)
                data = store.serialize_cdr(message, connection.msgtype)
                writer.write(connection, now + late + 300_000, data)
    asked = {"columns": {"hand_force": "/hand.wrench.force.z"}, "units": {"position": "m"}}
    log = zw.read_log(path, **asked)
    assert_same(log, recording)
    assert {"dates", "two topics"} <= {f.kind for f in log.findings}
    with pytest.raises(zw.InputError, match=r"joint_states.position\[stylus\].*has no unit"):
        zw.read_log(path)
    (file,) = [p for p in path.iterdir() if p.suffix in (".mcap", ".db3")]
    assert_same(zw.read_log(file, **asked), recording)
    file.rename(tmp_path / "elsewhere")
    with pytest.raises(
        zw.InputError, match=f"{file.name} is missing" if storage == "MCAP" else "cannot be read"
    ):
        zw.read_log(path, **asked)


JOINTS = """std_msgs/Header header
string[] name
float64[] position
float64[] effort
================================================================================
MSG: std_msgs/Header
builtin_interfaces/Time stamp
string frame_id
================================================================================
MSG: builtin_interfaces/Time
int32 sec
uint32 nanosec
"""
STATE = """string[] joint_names
control_msgs/InterfaceValue[] interface_values
================================================================================
MSG: control_msgs/InterfaceValue
string[] interface_names
float64[] values
"""


@cache
def store_of(kind: str) -> tuple[str, Any]:
    from rosbags.typesys import Stores, get_types_from_msg, get_typestore

    store = get_typestore(Stores.EMPTY)
    name, text = {"joints": ("a/msg/Joints", JOINTS), "state": ("a/msg/State", STATE)}[kind]
    store.register(get_types_from_msg(text, name))
    return name, store


def of_two_joints(time: float, shoulder: float, elbow: float, swapped: bool | None, kind: str) -> bytes:
    """A message of two joints: one type of ROS, another whose lists are in lists, or JSON."""
    names, both = ["shoulder", "elbow"], [[shoulder, 2 * shoulder], [elbow, 3 * elbow]]
    if swapped:
        names, both = names[::-1], both[::-1]
    if swapped is None:
        names = []
    stamp = divmod(1_700_000_000_000_000_000 + round(time * 1e9), 10**9)
    if kind == "json":
        about = {"header": {"stamp": {"sec": stamp[0], "nsec": stamp[1]}}, "names": names}
        state = {"position": [x for x, _ in both], "time_from_start": {"sec": 0, "nanosec": 5}}
        return json.dumps({**about, "state": state, "on": True}).encode()
    name, store = store_of(kind)
    types = store.types
    if kind == "joints":
        header = types["std_msgs/msg/Header"](types["builtin_interfaces/msg/Time"](*stamp), "")
        said = types[name](header, names, *np.array(both).T.copy())
    else:
        of_one = types["control_msgs/msg/InterfaceValue"]
        said = types[name](names, [of_one(["position", "effort"], np.array(values)) for values in both])
    return bytes(store.serialize_cdr(said, name))


def mcap_of(path: Path, kind: str, messages: Iterable[tuple[float, bytes]], **options: Any) -> Path:
    """A file in one topic, as another program writes it."""
    from mcap.writer import Writer

    with open(path, "wb") as file:
        writer = Writer(file, **{"chunk_size": 4000, **options})
        writer.start(profile="" if kind == "json" else "ros2")
        name, form, text = {
            "joints": ("a/msg/Joints", "ros2msg", JOINTS),
            "state": ("a/msg/State", "ros2msg", STATE),
            "json": ("State", "jsonschema", "{}"),
        }[kind]
        schema = writer.register_schema(name, form, text.encode())
        channel = writer.register_channel("/arm", "json" if kind == "json" else "cdr", schema)
        for time, data in messages:
            stamp = 1_700_000_000_000_000_000 + round(time * 1e9)
            writer.add_message(channel, stamp, data, stamp)
        writer.finish()
    return path


@pytest.mark.parametrize("chunked", [True, False])
@pytest.mark.parametrize(
    ("kind", "column"),
    [
        ("joints", "/arm.position[{}]"),
        ("state", "/arm.interface_values[{}].values[position]"),
        ("json", "/arm.state.position[{}]"),
    ],
)
def test_what_a_message_names_is_known_by_its_name(kind, column, chunked, recording, tmp_path):
    """Two joints change places at every third message, and every seventh message is of another one."""
    pytest.importorskip("rosbags")
    messages = [(-5e-4, of_two_joints(-5e-4, 1.0, 2.0, None, kind))]  # without names
    for k, (t, x, f) in enumerate(zip(recording.time[:900], *recording[1:3], strict=False)):
        messages.append((t, of_two_joints(t, x, f, k % 3 == 0, kind)))
        if k % 7 == 0:
            other = messages[-1][1].replace(b"shoulder", b"gripper_")
            messages.append((t + 1e-4, other))
    path = mcap_of(tmp_path / "log.mcap", kind, messages, use_chunking=chunked)
    units = {"position": "m"}
    log = zw.read_log(path, columns={"position": column.format("shoulder"), "hand_force": None}, units=units)
    (block,) = log.blocks()
    assert np.abs(block.position - recording.position[:900]).max() < 1e-15
    said = {finding.kind: finding for finding in log.findings}
    assert (said["messages left out"].samples, "cut" in said) == (130, False)
    assert '"elbow", "gripper_"' in said["names left out"].text
    with pytest.raises(zw.InputError, match=r"no column.*\[shoulder\]"):
        zw.read_log(path, columns={"position": column.format("0")}, units=units)


def test_topics_that_cannot_be_read_do_not_hide_the_others(recording, tmp_path):
    """Of another encoding, of a type that is none, or with bytes that are no message."""
    pytest.importorskip("rosbags")
    from mcap.writer import Writer

    with open(tmp_path / "log.mcap", "wb") as file:
        writer = Writer(file)
        writer.start()
        topics = {"/arm": ("json", "jsonschema", "{}"), "/odd": ("protobuf", "protobuf", "")}
        topics |= {"/wrong": ("cdr", "ros2msg", "float64[ x"), "/bytes": ("cdr", "ros2msg", "float64 x")}
        for topic, (encoding, form, text) in topics.items():
            schema = writer.register_schema("a/msg/B", form, text.encode())
            channel = writer.register_channel(topic, encoding, schema)
            for t, x in zip(recording.time[:500], recording.position, strict=False):
                data = json.dumps({"x_mm": 1e3 * x}).encode() if topic == "/arm" else b"x"
                writer.add_message(channel, 10**18 + round(t * 1e9), data, 10**18)
        writer.finish()
    log = zw.read_log(tmp_path / "log.mcap")
    assert (log.samples, log.sample_period) == (500, 5e-4)
    said = " ".join(finding.text for finding in log.findings)
    assert all(
        topic in said for topic in ("/odd (protobuf)", "/wrong (cdr)", "the topic /bytes cannot be read")
    )


def test_of_a_file_that_was_cut_its_whole_pieces_are_read(recording, tmp_path):
    """Cut anywhere, or damaged in one place."""
    pytest.importorskip("rosbags")
    rows = list(zip(recording.time[:900], *recording[1:3], strict=False))
    path = mcap_of(
        tmp_path / "log.mcap", "joints", ((t, of_two_joints(t, x, f, False, "joints")) for t, x, f in rows)
    )
    whole, (low, high) = path.read_bytes(), (0, 0)
    asked = {
        "columns": {"position": "/arm.position[shoulder]", "hand_force": None},
        "units": {"position": "m"},
    }
    for end in range(300, len(whole), len(whole) // 17):
        path.write_bytes(whole[:end])
        if end < 2 * 600:  # less than a chunk
            with pytest.raises(zw.InputError, match="ends in the middle"):
                zw.read_log(path, **asked)
            low += 1
            continue
        log = zw.read_log(path, **asked)
        high += log.samples < 900
        assert ("cut" in {f.kind for f in log.findings}) == (log.samples < 900)
        blocks = list(log.blocks())
        assert (np.concatenate([b.position for b in blocks]) == recording.position[: log.samples]).all()
    assert low >= 1 <= 8 <= high
    middle = len(whole) // 3
    path.write_bytes(whole[:middle] + bytes([whole[middle] ^ 255]) + whole[middle + 1 :])
    log = zw.read_log(path, **asked)
    assert log.runs == 2
    assert any("the file is damaged" in f.text for f in log.findings)


def test_without_the_library_for_bags_its_name_is_said(tmp_path, monkeypatch):
    path = mcap_of(tmp_path / "log.mcap", "joints", [(0.0, b"")])
    for module in ("rosbags", "rosbags.highlevel", "rosbags.typesys"):
        monkeypatch.setitem(sys.modules, module, None)
    with pytest.raises(zw.InputError, match=r"install .*\[logs\]"):
        zw.read_log(path)


@pytest.mark.parametrize("suffix", ["nc", "parquet", "csv"])
@pytest.mark.parametrize("rotary", [False, True])
def test_traces_of_zwidth_are_logs(suffix, rotary, tmp_path):
    if rotary:
        device = zw.rotary(inertia=2e-5, damping=2e-4, coulomb_friction=2e-3, resolution=1e-4, rate=2000)
        trace = zw.simulate(device, zw.Wall(0.5), zw.operators.Finger(), 0.3, initial_position=-0.05)
    else:
        paddle = zw.catalogue.device("haptic-paddle")
        trace = zw.simulate(paddle, zw.Wall(300.0), zw.operators.Finger(), 0.3, points_per_sample=3)
    trace.zwidth.save(tmp_path / f"trace.{suffix}")
    log = zw.read_log(tmp_path / f"trace.{suffix}")
    at_samples = trace.isel(time=trace.sampled.values)
    (block,) = log.blocks()
    assert log.motion == ("rotary" if rotary else "linear")
    assert log.sample_period == trace.attrs["sample_period_s"]
    assert log.resolution == trace.attrs["resolution_rad" if rotary else "resolution_m"]
    assert np.abs(block.position - at_samples.measured_position.values).max() < 1e-12
    about = trace.attrs
    mass, hand = (
        ("mass_kg_m2", "hand_damping_N_m_s_per_rad") if rotary else ("mass_kg", "hand_damping_N_s_per_m")
    )
    share = about[mass] / (about[mass] + about[f"hand_{mass}"])
    bends = np.diff(at_samples.anchor_position.values, 2) / about["sample_period_s"]
    force = at_samples.hand_force.values
    assert block.hand_force[1:-1] == pytest.approx(force[1:-1] - share * about[hand] * bends / 2, abs=1e-9)
    assert (block.actuator_force == at_samples.actuator_force.values).all()
    (direct,) = zw.Log.from_arrays(trace).blocks()
    assert all((a == b).all() for a, b in zip(direct[1:], block[1:], strict=True))


def test_units_and_factors(recording, tmp_path):
    path = tmp_path / "raw.csv"
    counts = np.rint(recording.position / 22.4e-6).astype(int)
    rows = zip(recording.time.tolist(), counts, recording.force.tolist(), strict=True)
    body = "".join(f"{t!r},{c},{f!r}\n" for t, c, f in rows)
    path.write_text("t_s,enc_counts,load_cell_V\n" + body)
    with pytest.raises(zw.InputError, match="what a count is"):
        zw.read_log(path)
    with pytest.raises(zw.InputError, match="2 N/V"):
        zw.read_log(path, resolution="22.4 um")
    log = zw.read_log(path, resolution="22.4 um", scale={"hand_force": "-2500 mN/V"})
    (block,) = log.blocks()
    assert np.abs(block.hand_force + 2.5 * recording.force).max() < 1e-12
    assert_same(log, recording, force=False)
    turning = zw.read_log(path, counts_per_turn=4096, scale={"hand_force": "0.01 N*m/V"})
    assert (turning.motion, turning.resolution) == ("rotary", pytest.approx(2 * np.pi / 4096, rel=1e-12))
    degrees = zw.read_log(path, units={"position": "deg"}, scale={"hand_force": "0.01 N*m/V", "position": -1})
    (block,) = degrees.blocks()
    assert np.abs(block.position + np.radians(counts)).max() < 1e-12
    with pytest.raises(zw.InputError, match="says of itself that it is in V, and N is given"):
        zw.read_log(path, units={"position": "deg", "hand_force": "N"})
    path.write_text("t_s,enc_counts,load_cell\n" + body)
    with pytest.raises(zw.InputError, match="not a torque"):
        zw.read_log(path, units={"position": "deg", "hand_force": "N"})


@pytest.mark.parametrize(
    ("column", "quantity", "expected"),
    [
        ("position_m", "position", ("position", "m")),
        ("hand_force_N_m", "hand_force", ("hand_force", "N_m")),
        ("Encoder Position [µm]", "position", ("encoder_position", "µm")),
        ("left/enc (counts)", "position", ("enc", "counts")),
        ("x", "position", ("x", None)),
        ("robot.state.time_ms", "time", ("time", "ms")),
        ("/joint_states.position[0]", "position", ("position", None)),
        ("velocity_m_per_s", "position", ("velocity_m_per_s", None)),
    ],
)
def test_names_and_their_units(column, quantity, expected):
    assert name_and_unit(column, quantity) == expected
