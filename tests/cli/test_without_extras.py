"""Without what an extra brings: everything that the first page shows, and one message for the rest."""

import subprocess
import sys
from itertools import product
from pathlib import Path
from types import SimpleNamespace

import numpy as np
import pytest
from written_rows import WrittenRows, drawn

import zwidth as zw
from zwidth.installing import line
from zwidth.machine.servo.recording import Recorder

LOGS = ("openpyxl", "pyarrow", "rosbags")
CORE = (
    "check wheel.toml bumpstop.toml",
    "simulate wheel.toml bumpstop.toml --operator hands-on --duration '0.1 s' --plot a.png -o a.csv",
    "identify session.csv --plot b.png",
    "map wheel.toml --stiffness '0:30 N*m/rad' --virtual-damping '0:0.1 N*m*s/rad' --cells 5x4 --plot c.png",
    "report wheel.toml bumpstop.toml -o d.html",
    "tissue relaxation.csv --plot e.png",
    "diagnose shaking.csv",
)
ALONE = """
import shlex, sys
sys.modules.update(dict.fromkeys({without!r}))
from zwidth.cli.main import main
for line in {lines!r}:
    assert main(shlex.split(line)) in (0, 1), line
"""


def test_the_first_page_needs_no_extra(run):
    """In a process of its own, which would find any of them loaded at the top of a module."""
    run("examples .")
    code = ALONE.format(without=LOGS, lines=CORE)
    done = subprocess.run([sys.executable, "-c", code], capture_output=True, text=True, check=False)
    assert done.returncode == 0, done.stderr
    assert all(Path(name).stat().st_size for name in ("a.png", "a.csv", "b.png", "c.png", "d.html", "e.png"))


@pytest.fixture
def plain(monkeypatch):
    """From then on none of them is installed."""

    def begin():
        for name in [*LOGS, "compression.zstd", *sys.modules]:
            if name.partition(".")[0] in (*LOGS, "compression"):
                monkeypatch.setitem(sys.modules, name, None)

    return begin


def log_in(path: Path) -> Path:
    """A file, or a folder, of the kind that its name says, as one that begins as such."""
    rows = {"time_s": np.arange(100) / 1000, "position_m": np.arange(100) * 1e-3}
    text = "time_s,position_m\n" + "".join(f"{t},{x}\n" for t, x in zip(*rows.values(), strict=True))
    if path.name in ("log.parquet", "lerobot"):
        import pyarrow as pa
        import pyarrow.parquet as pq

        file = path
        if path.name == "lerobot":
            file = path / "data" / "chunk-000" / "episode.parquet"
            file.parent.mkdir(parents=True)
            (path / "meta").mkdir()
            (path / "meta" / "info.json").write_text("{}", encoding="utf-8")
        pq.write_table(pa.table(rows), file)
    elif path.suffix == ".xlsx":
        from openpyxl import Workbook

        book = Workbook()
        for row in text.splitlines():
            book.active.append([*row.split(",")])
        book.save(path)
    elif path.suffix == ".zst":
        import pyarrow as pa

        path.write_bytes(pa.compress(text.encode(), "zstd", asbytes=True))
    elif path.name == "rosbag2":
        path.mkdir()
        (path / "metadata.yaml").write_text("storage_identifier: sqlite3\n", encoding="utf-8")
    elif path.suffix == ".bag":
        path.write_bytes(b"#ROSBAG V2.0\n")
    elif path.name.startswith("ros-"):
        from mcap.writer import CompressionType, Writer

        with open(path, "wb") as file:
            writer = Writer(file, compression=getattr(CompressionType, path.stem.partition("-")[2].upper()))
            writer.start()
            schema = writer.register_schema("a/msg/State", "ros2msg", b"float64 position\n")
            writer.add_message(writer.register_channel("/arm", "cdr", schema), 1, bytes(12), 1)
            writer.finish()
    else:
        written = WrittenRows(drawn(100))
        with Recorder(written, path):
            written.written = 100
    return path


KINDS = {
    "log.parquet": "pyarrow",
    "lerobot": "pyarrow",
    "book.xlsx": "openpyxl",
    "log.csv.zst": "pyarrow",
    "rosbag2": "rosbags",
    "ros1.bag": "rosbags",
    "ros-none.mcap": "rosbags",
    "ros-zstd.mcap": "pyarrow",
    "ros-lz4.mcap": "pyarrow",
    "served.mcap": "pyarrow",
}


@pytest.mark.parametrize(
    ("command", "name"), [*product(("identify", "diagnose", "tissue"), KINDS), ("replay", "served.mcap")]
)
def test_a_file_of_others_says_what_to_type(command, name, refused, plain, tmp_path):
    log_in(tmp_path / name)
    plain()
    said = refused(f"{command} {name}")
    assert f"{name} is not read: " in said
    assert f"takes {KINDS[name]}, which is not installed; type" in said
    assert line("logs") in said


def test_python_itself_expands_zstd_where_it_can(plain, monkeypatch, tmp_path):
    """From 3.14 on; here a module of that name stands in for it."""
    import pyarrow as pa

    packed = log_in(tmp_path / "log.csv.zst")
    own = SimpleNamespace(open=lambda file: pa.CompressedInputStream(str(file), "zstd"))
    plain()
    monkeypatch.setitem(sys.modules, "compression.zstd", own)
    assert zw.read_log(packed).samples == 100


def test_both_extras_that_a_table_of_a_sweep_takes_are_one_command(refused, plain, monkeypatch):
    plain()
    monkeypatch.setitem(sys.modules, "zarr", None)
    said = refused("sweep haptic-paddle --vary stiffness=100:300:3 -o a.parquet")
    assert line("logs,maps") in said
    assert all(name in said for name in ("pyarrow", "zarr"))


@pytest.mark.parametrize(
    "command",
    [
        "simulate haptic-paddle --stiffness 300 --operator hands-on -o a.parquet",
        "sweep haptic-paddle --vary stiffness=100:300:3 -o a.parquet",
        "traces a.parquet a.parquet",
    ],
)
def test_parquet_says_what_to_type(command, refused, plain, tmp_path):
    log_in(tmp_path / "log.parquet").rename("b.parquet" if "-o" in command else "a.parquet")
    plain()
    said = refused(command)
    assert f"a.parquet is not {'written' if '-o' in command else 'read'}: Parquet takes pyarrow, " in said
    assert line("logs") in said
    with pytest.raises(zw.InputError, match="Parquet takes pyarrow"):
        zw.load_sweep(next(tmp_path.glob("?.parquet")))
