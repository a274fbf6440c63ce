"""Whatever a file holds: one message, no traceback, and bounded memory."""

from __future__ import annotations

import gzip
import subprocess
import sys
from pathlib import Path

import h5py
import numpy as np
import pyarrow as pa
import pyarrow.parquet as pq
import pytest
import scipy.io

import zwidth as zw
from zwidth.model.operator.recorded_force import read_column

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
