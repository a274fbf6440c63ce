"""`zwidth workspace`: the verdict, the map in files, and one clear line on bad input."""

from __future__ import annotations

import json
from collections.abc import Callable
from pathlib import Path

import pytest
import xarray

from zwidth.cli.main import main

Run = Callable[..., tuple[int, str, str]]
HAPLY = ("workspace", "haply-2diy", "--joint-damping", "0.003", "--points", "20")


@pytest.fixture
def run(capsys: pytest.CaptureFixture[str], tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> Run:
    """Runs a command line in this process and in an empty directory."""
    monkeypatch.chdir(tmp_path)

    def runner(*argv: str) -> tuple[int, str, str]:
        status = main(argv)
        return status, *capsys.readouterr()

    return runner


def test_a_wall_that_holds_everywhere(run: Run) -> None:
    """Status 0, and nothing to change."""
    status, out, _ = run(*HAPLY, "--stiffness", "300")
    words = " ".join(out.split())
    assert status == 0
    assert "PASSIVE No motion of the hand takes energy out with x from -0.05 to 0.05 m" in words
    assert "what to change" not in words
    assert "haply-2diy, 2 joints, 1 kHz" in words
    assert "Encoder steps are not counted." in words


def test_a_wall_that_fails_says_what_to_change(run: Run) -> None:
    """Status 1, the motion, and the damping that would do; with it the status is 0."""
    status, out, _ = run(*HAPLY, "--stiffness", "800", "--json")
    found = json.loads(out)
    assert (status, found["outcome"]) == (1, "active")
    assert found["motion"]["energy_J"] < 0
    enough = 0.003 + found["addition_to_all_N_m_s_per_rad"]
    better = ("workspace", "haply-2diy", "--joint-damping", str(enough), "--points", "20")
    assert run(*better, "--stiffness", "800")[0] == 0
    words = " ".join(run(*HAPLY, "--stiffness", "800")[1].split())
    assert "take" in words
    assert "what to change" in words
    assert "all joints" in words


def test_just_below_the_limit_is_undecided(run: Run) -> None:
    """The points hold, and between two of them the checker finds that the condition fails: status 3."""
    chain = ("workspace", "two-link", "--joint-damping", "0.02,0.012", "--points", "20", "--stiffness")
    found = json.loads(run(*chain, "300", "--json")[1])
    status, out, _ = run(*chain, str(0.9999 * found["largest_stiffness_N_per_m"]))
    words = " ".join(out.split())
    assert status == 3
    assert "between the points" in words
    assert "There is no certificate: the damping is not enough at" in words


def test_the_certificate_is_saved_and_verified(run: Run, tmp_path: Path) -> None:
    """A file .json takes the verdict; `zwidth verify` accepts it, and refuses it once changed."""
    assert run(*HAPLY, "--stiffness", "300", "-o", "proof.json")[0] == 0
    status, out, _ = run("verify", "proof.json")
    words = " ".join(out.split())
    assert status == 0
    assert "VALID The arm below is passive, proved: no motion of the hand" in words
    assert "read without encoder steps; the torque follows the arm" in words
    assert "stiffness [[300, 0], [0, 300]] N/m" in words
    assert "link 0.07 m, rod 0.09 m" in words
    text = (tmp_path / "proof.json").read_text(encoding="utf-8")
    found = json.loads(text)
    assert (found["outcome"], found["certificate"]["kind"]) == ("passive", "arm")
    (tmp_path / "other.json").write_text(text.replace('"300"', '"900"'), encoding="utf-8")
    assert run("verify", "other.json")[0] == 1
    assert run(*HAPLY, "--stiffness", "900", "-o", "active.json")[0] == 1
    assert run("verify", "active.json")[0] == 2


def test_the_map_is_saved_and_drawn(run: Run, tmp_path: Path) -> None:
    """NetCDF with units, a picture; neither is replaced unasked."""
    argv = (*HAPLY, "--stiffness", "800", "--plot", "map.png", "-o", "map.nc")
    assert run(*argv)[0] == 1
    with xarray.open_dataset(tmp_path / "map.nc", engine="h5netcdf") as data:
        assert data["margin"].attrs["units"] == "N*s/m"
        assert data["margin"].shape == (20, 20)
    assert (tmp_path / "map.png").stat().st_size > 10_000
    status, _, err = run(*argv)
    assert status == 2
    assert "--force" in err


@pytest.mark.parametrize(
    ("argv", "words"),
    [
        (("haply-2diy", "--stiffness", "100"), "no source gives the joint damping"),
        (("haply-2diy", "--joint-damping", "0.1"), "which wall"),
        (("haply-2diy", "--joint-damping", "0.1,0.2,0.3", "--stiffness", "1"), "one for each"),
        (("haply-2diy", "--joint-damping", "0.1", "--stiffness", "1", "--hold", "a=1"), "for descriptions"),
        (("phantom", "--joint-damping", "0.1", "--stiffness", "1"), "built in are"),
        (("missing.urdf", "--stiffness", "1"), "missing.urdf"),
        (("two-link", "--joint-damping", "0.1", "--stiffness", "1", "--points", "2.5"), "whole number"),
        (
            ("two-link", "--joint-damping", "0.1", "--stiffness", "1", "-o", "proof.jsn"),
            "a file must end in .json for the verdict",
        ),
        (
            ("two-link", "--joint-damping", "0.1", "--stiffness", "1", "--delay", "0.3 ms"),
            "whole number of samples",
        ),
    ],
)
def test_bad_input_is_one_line(run: Run, argv: tuple[str, ...], words: str) -> None:
    """Status 2, and what to try."""
    status, out, err = run("workspace", *argv)
    assert (status, out) == (2, "")
    assert words in err
    assert err.count("\n") == 1


def test_a_description_from_the_command_line(run: Run, tmp_path: Path) -> None:
    """A URDF with its own damping; one joint held."""
    pytest.importorskip("pinocchio")
    link = '<link name="{}"/>'
    joint = (
        '<joint name="{0}" type="revolute"><parent link="{1}"/><child link="{2}"/><origin xyz="{3} 0 0"/>'
        '<axis xyz="0 0 1"/><limit lower="0.2" upper="1.2" effort="1" velocity="1"/>'
        '<dynamics damping="0.02"/></joint>'
    )
    tip = '<joint name="tip" type="fixed"><parent link="c"/><child link="d"/><origin xyz="0.1 0 0"/></joint>'
    (tmp_path / "arm.urdf").write_text(
        '<robot name="arm">'
        + "".join(link.format(n) for n in "abcd")
        + joint.format("first", "a", "b", 0)
        + joint.format("second", "b", "c", 0.1)
        + tip
        + "</robot>"
    )
    status, out, _ = run(
        "workspace",
        "arm.urdf",
        "--stiffness",
        "200",
        "--hold",
        "second=0.5",
        "--points",
        "10",
        "--frame",
        "d",
    )
    assert status == 0
    assert "second held at 0.5" in " ".join(out.split())
