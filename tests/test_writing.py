"""Files are written whole or not at all, whatever stands in their place."""

import csv
import errno
import os
import re
import secrets
from io import StringIO
from pathlib import Path
from stat import S_IMODE

import pytest
from full_disk import full_disk
from hypothesis import given
from hypothesis import strategies as st

import zwidth as zw
from zwidth.cli.main import main
from zwidth.quantity.text import save_json
from zwidth.writing import check_target, csv_cell, csv_text, writing_whole

LOOP = zw.Device(mass=0.04, damping=0.15, sample_period=0.001), zw.Wall(200)


def test_what_fails_half_way_leaves_the_old_file(tmp_path):
    path = tmp_path / "proof.json"
    save_json(path, {"whole": 1})
    old = path.read_text(encoding="utf-8")

    def half():
        with writing_whole(path) as file:
            file.write(b"{")
            raise KeyboardInterrupt

    with pytest.raises(KeyboardInterrupt):
        half()
    assert path.read_text(encoding="utf-8") == old
    assert list(tmp_path.iterdir()) == [path]


def test_a_link_stays_a_link(tmp_path):
    link, file = tmp_path / "link.json", tmp_path / "file.json"
    link.symlink_to(file)
    save_json(link, {"whole": 1})
    assert link.is_symlink()
    assert file.read_text(encoding="utf-8") == '{\n  "whole": 1\n}\n'


@pytest.mark.skipif(not Path("/dev/null").is_char_device(), reason="there is no /dev/null")
def test_a_device_stays_a_device():
    save_json("/dev/null", {"whole": 1})
    assert Path("/dev/null").is_char_device()


@pytest.mark.skipif(not Path("/dev/full").exists(), reason="there is no full device to write to")
def test_a_full_device_is_one_message():
    with pytest.raises(zw.InputError, match=f"/dev/full cannot be written: {os.strerror(errno.ENOSPC)}"):
        save_json("/dev/full", {"whole": 1})


def test_a_place_that_is_not_there_is_said(tmp_path):
    """Of verdicts, certificates, maps of arms and pictures alike."""
    verdict = zw.check(*LOOP)
    for save in (verdict.save, verdict.certificate.save):
        with pytest.raises(zw.InputError, match=f"cannot be written: {os.strerror(errno.ENOENT)}"):
            save(tmp_path / "none" / "proof.json")
    with pytest.raises(zw.InputError, match="cannot be written"):
        verdict.save(tmp_path / "zero\0byte.json")


def test_a_directory_is_one_message(tmp_path):
    with pytest.raises(zw.InputError, match="cannot be written"):
        save_json(tmp_path, {"whole": 1})
    assert list(tmp_path.iterdir()) == []


def test_nobody_knows_the_name_before(tmp_path):
    """It is another each time, and long enough that none is guessed."""
    names = set()
    for _ in range(2):
        with writing_whole(tmp_path / "proof.json"):
            names |= {path.name for path in tmp_path.iterdir()} - {"proof.json"}
    assert len(names) == 2
    assert min(len(name) for name in names) > 32


def test_a_long_name_is_no_obstacle(tmp_path):
    """What the folder takes can be written, up to its last character."""
    path = tmp_path / ("n" * (os.pathconf(tmp_path, "PC_NAME_MAX") if hasattr(os, "pathconf") else 200))
    save_json(path, {"whole": 1})
    assert path.is_file()


def test_a_link_in_the_way_is_not_followed(tmp_path, monkeypatch):
    """Even where the name was guessed: what it leads to stays as it is, and so does the link."""
    monkeypatch.setattr(secrets, "token_hex", lambda *_: "guessed")
    other, path = tmp_path / "other", tmp_path / "proof.json"
    other.write_text("of another", encoding="utf-8")
    with writing_whole(path):
        trap = next(p for p in tmp_path.iterdir() if "guessed" in p.name)
    trap.symlink_to(other)
    path.unlink()
    with pytest.raises(zw.InputError, match="cannot be written"):
        save_json(path, {"whole": 1})
    assert other.read_text(encoding="utf-8") == "of another"
    assert trap.is_symlink()
    assert not path.exists()


@pytest.mark.skipif(os.name != "posix", reason="permissions are those of POSIX")
def test_permissions_are_those_of_the_umask(tmp_path):
    """The group may read what is written; a private file stays private when it is replaced."""
    path = tmp_path / "proof.json"
    before = os.umask(0o027)
    try:
        save_json(path, {"whole": 1})
        assert S_IMODE(path.stat().st_mode) == 0o640
        path.chmod(0o600)
        save_json(path, {"whole": 2})
        assert S_IMODE(path.stat().st_mode) == 0o600
    finally:
        os.umask(before)


@pytest.mark.skipif(not hasattr(os, "geteuid") or os.geteuid() == 0, reason="root may write everywhere")
def test_what_may_not_be_written_is_kept(tmp_path):
    """A write-protected file, though its folder could be written; and a folder that cannot be."""
    path = tmp_path / "proof.json"
    path.write_text("kept", encoding="utf-8")
    path.chmod(0o400)
    with pytest.raises(zw.InputError, match=os.strerror(errno.EACCES)):
        save_json(path, {"whole": 1})
    assert path.read_text(encoding="utf-8") == "kept"
    tmp_path.chmod(0o500)
    try:
        with pytest.raises(zw.InputError, match=os.strerror(errno.EACCES)):
            save_json(tmp_path / "new.json", {"whole": 1})
    finally:
        tmp_path.chmod(0o700)


@pytest.mark.skipif(not Path("/dev/fd").is_dir(), reason="pipes have no names")
def test_a_pipe_is_written_itself():
    """As for --save /dev/stdout."""
    reader, writer = os.pipe()
    save_json(f"/dev/fd/{writer}", {"whole": 1})
    os.close(writer)
    with open(reader, encoding="utf-8") as pipe:
        assert pipe.read() == '{\n  "whole": 1\n}\n'


def _saved(trace, path):
    trace.zwidth.save(path, force=True)


FORMATS = {
    **dict.fromkeys(("touch.nc", "touch.parquet", "touch.csv"), _saved),
    "touch.wav": lambda trace, path: trace.zwidth.sound(path, force=True),
    "touch.png": lambda trace, path: trace.zwidth.plot(path),
    "touch.svg": lambda trace, path: trace.zwidth.plot(path),
    "both.pdf": lambda trace, path: zw.traces.compare_traces(trace, trace).plot(path),
    "measures.json": lambda trace, path: save_json(path, zw.traces.compare_traces(trace).to_dict()),
}


@pytest.fixture(scope="module")
def trace():
    """A short touch."""
    return zw.simulate(*LOOP, zw.operators.ConstantForce(1), 0.02)


@pytest.mark.parametrize("name", FORMATS)
def test_a_full_disk_keeps_the_old_file(name, trace, tmp_path):
    """One message in every format, and nothing but the old file; HDF5 would end the process."""
    path = tmp_path / name
    path.write_text("old", encoding="utf-8")
    with full_disk(), pytest.raises(zw.InputError, match=f"{name} cannot be written: ") as caught:
        FORMATS[name](trace, path)
    assert "\n" not in str(caught.value)
    assert path.read_text(encoding="utf-8") == "old"
    assert list(tmp_path.iterdir()) == [path]


_WRITES = re.compile(
    r"\.(to_netcdf|to_csv|savefig|write_text|write_bytes)\(|(?<!wave\.)open\([^)\n]*[\"'][wax]b?\+?[\"']"
)


def test_only_one_place_opens_files_to_write():
    """So that no format forgets what is promised here; pictures are drawn in memory.

    The schemas are written by developers, into the source itself.
    """
    source = Path(zw.__file__).parent
    writers = {p for p in source.rglob("*.py") if _WRITES.search(p.read_text(encoding="utf-8"))}
    of_users = {source / "writing.py", source / "show" / "plots" / "style.py"}
    assert writers == {*of_users, source / "checker" / "schema.py"}


TEXT = "=+-@\t\r\n\"',;ax1.e ＝＋ü"


@given(st.lists(st.lists(st.text(TEXT) | st.floats(allow_nan=False), min_size=2), min_size=1))
def test_text_is_text_in_every_spreadsheet(rows):
    """No cell begins as a formula does that is no number; what is read back is what was written."""
    read = list(csv.reader(StringIO(csv_text(rows), newline="")))
    assert [[csv_cell(cell) for cell in row] for row in read] == [[str(cell) for cell in row] for row in rows]
    for cell in (cell for row in read for cell in row):
        try:
            float(cell)
        except ValueError:
            assert not cell.startswith(("=", "+", "-", "@", "\t", "\r", "＝", "＋"))


def test_a_trace_is_no_formula_either(trace, tmp_path):
    """The attributes in the first line hold what others named; numbers are as they were."""
    named = trace.assign_attrs(device="a,=HYPERLINK(1);+1,-2", environment="@x")
    named.zwidth.save(tmp_path / "t.csv")
    first = (tmp_path / "t.csv").read_text(encoding="utf-8").partition("\n")[0]
    assert not re.search("[,;][=+@-]", first)
    assert zw.traces.load_trace(tmp_path / "t.csv").identical(named)


OUTPUTS = (
    ("check haptic-paddle --stiffness 100", "--save", "x.json"),
    ("check haptic-paddle --stiffness 100", "--plot", "x.png"),
    ("limit haptic-paddle --stiffness 100", "-o", "x.json"),
    ("simulate haptic-paddle --stiffness 100", "-o", "x.nc"),
    ("simulate haptic-paddle --stiffness 100", "--plot", "x.svg"),
    ("simulate haptic-paddle --stiffness 100", "--sound", "x.wav"),
    ("compare haptic-paddle --stiffness 100", "-o", "x.json"),
    ("play haptic-paddle --stiffness 100 --no-browser", "-o", "x.html"),
    ("report haptic-paddle --stiffness 100", "-o", "x.html"),
    ("serve haptic-paddle --stiffness 100", "-o", "x.mcap"),
    ("emit haptic-paddle --stiffness 100", "-o", "folder"),
    ("sweep haptic-paddle --stiffness 100 --vary delay=0,1e-4", "-o", "x.parquet"),
    ("sweep haptic-paddle --stiffness 100 --vary delay=0,1e-4", "-o", "x.zarr"),
    ("sweep haptic-paddle --stiffness 100 --vary delay=0,1e-4", "--plot", "x.pdf"),
    ("map haptic-paddle --stiffness 0:9 --virtual-damping 0:1 --cells 2x2", "-o", "x.zarr"),
    ("map haptic-paddle --stiffness 0:9 --virtual-damping 0:1 --cells 2x2", "--certify", "x.json"),
    ("each haptic-paddle hapkit --stiffness 100", "-o", "x.csv"),
    ("identify session.csv", "-o", "x.toml"),
    ("diagnose shaking.csv wheel.toml", "-o", "x.toml"),
    ("tissue relaxation.csv", "-o", "x.toml"),
    ("gains arms.yaml", "-o", "x.yaml"),
    ("pair haptic-paddle --stiffness 50", "-o", "x.json"),
    ("links haptic-paddle", "-o", "x.json"),
    ("workspace arm.urdf --stiffness 100", "-o", "x.json"),
    ("replay run.mcap", "-o", "x.nc"),
    ("traces touch.nc", "--plot", "x.png"),
    ("doctor", "-o", "x.json"),
    ("new device", "", "x.toml"),
    ("examples", "", "folder"),
)


@pytest.mark.parametrize(("command", "option", "name"), OUTPUTS)
def test_no_command_follows_a_link_that_leads_nowhere(command, option, name, tmp_path, monkeypatch, capsys):
    """Without --force it is told before anything is computed, and nothing is made where it leads."""
    monkeypatch.chdir(tmp_path)
    (tmp_path / name).symlink_to(tmp_path / "chosen by another")
    given = {word for word in command.split() if word.endswith((".csv", ".toml", ".yaml"))}
    for each in given:  # inputs that are not there would be told first
        (tmp_path / each).write_text("a: 1\n", encoding="utf-8")
    assert main([*command.split(), *option.split(), name]) == 2
    assert re.search("exists|leads nowhere|no folder", capsys.readouterr().err)
    assert {each.name for each in tmp_path.iterdir()} == {name, *given}


def test_what_may_not_be_written_is_told_before(tmp_path, monkeypatch):
    """A protected file, a folder into which nothing may be put; a pipe or a device takes what comes."""
    path = tmp_path / "x.json"
    closed = {str(tmp_path)}
    monkeypatch.setattr(os, "access", lambda place, mode: str(place) not in closed)
    with pytest.raises(zw.InputError, match="nothing may be put into"):
        check_target(path, force=False)
    path.touch()
    closed = {str(path)}
    with pytest.raises(zw.InputError, match="protected"):
        check_target(path, force=True)
    check_target(Path(os.devnull), force=True)
