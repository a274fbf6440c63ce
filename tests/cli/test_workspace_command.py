"""`zwidth workspace`: the verdict, the map in files, and one clear line on bad input."""

from __future__ import annotations

import json
import re
from collections.abc import Callable
from pathlib import Path

import pytest
import xarray
from described_arms import random_arm

from zwidth.cli.main import main

Run = Callable[..., tuple[int, str, str]]
HAPLY = (
    "workspace", "haply-2diy", "--joint-damping", "0.003", "--joint-resolution", "0", "--points", "20",
)  # fmt: skip


@pytest.fixture
def run(capsys: pytest.CaptureFixture[str], tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> Run:
    """Runs a command line in this process and in an empty directory."""
    monkeypatch.chdir(tmp_path)

    def runner(*argv: str) -> tuple[int, str, str]:
        status = main(argv)
        return status, *capsys.readouterr()

    return runner


def test_a_wall_that_holds_everywhere(run: Run) -> None:
    """Status 0, and nothing to change; 4 behind its own encoders, whose steps are not in the proof."""
    status, out, _ = run(*HAPLY, "--stiffness", "300")
    words = " ".join(out.split())
    assert status == 0
    assert "PASSIVE No motion of the hand takes energy out with x from -0.05 to 0.05 m" in words
    assert "what to change" not in words
    assert "haply-2diy, 2 joints, 1 kHz" in words
    assert "The arm is taken to be read without steps. The torque" in words
    status, out, _ = run(*HAPLY[:4], "--stiffness", "300", "--points", "20")
    words = " ".join(out.split())
    assert status == 4
    assert "PASSIVE WITHOUT ENCODER STEPS Read without steps, no motion of the hand would take" in words
    assert "Encoder steps are not counted:" in words


def test_a_wall_that_fails_says_what_to_change(run: Run) -> None:
    """Status 1, the motion, and damping with which the status is 0."""
    status, out, _ = run(*HAPLY, "--stiffness", "800", "--json")
    found = json.loads(out)
    assert (status, found["outcome"]) == (1, "active")
    assert found["motion"]["energy_J"] < 0
    enough = 0.003 + found["addition_to_all_N_m_s_per_rad"]
    better = (*HAPLY[:3], str(enough), *HAPLY[4:])
    assert run(*better, "--stiffness", "800")[0] == 0


def test_just_below_the_limit_is_undecided(run: Run) -> None:
    """The points hold, and between two of them the checker finds that the condition fails: status 3."""
    chain = ("workspace", "two-link", "--joint-damping", "0.02,0.012", "--points", "20", "--stiffness")
    found = json.loads(run(*chain, "300", "--json")[1])
    status, out, _ = run(*chain, str(0.9999 * found["largest_stiffness_N_per_m"]))
    words = " ".join(out.split())
    assert status == 3
    assert "the arm in its region, q1 from 0 to 3.142 rad; q2 from" in words
    assert "N/m in every direction" in words
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
        (("haply-2diy", "--joint-damping", "0.1", "--stiffness", "1", "--pose"), "has no pose"),
        (("two-link", "--joint-damping", "0.1", "--rotational-stiffness", "1"), "add --pose"),
        (("two-link", "--joint-damping", "0.1", "--stiffness", "1", "--rest", "a=1"), "add --pose"),
        (("two-link", "--joint-damping", "0.1", "--pose"), "which wall"),
        (
            ("two-link", "--joint-damping", "1", "--stiffness", "1", "--torque-held-up-to", "1,2,3"),
            "a moment",
        ),
        (
            ("two-link", "--joint-damping", "0.1", "--wall", "w.toml", "--stiffness", "1"),
            "leave out --stiffness",
        ),
        (("two-link", "--joint-damping", "0.1", "--wall", "w.toml"), "no file"),
        (
            ("two-link", "--joint-damping", "0.1", "--stiffness", "1", "-o", "proof.jsn"),
            "a file must end in .json for the verdict",
        ),
        (
            ("two-link", "--joint-damping", "0.1", "--stiffness", "1", "--delay", "0.3 ms"),
            "whole number of samples",
        ),
        (
            ("two-link", "--joint-damping", "0.1", "--stiffness", "1", "--delay", "3"),
            "delay is 3 s, 3000 samples",
        ),
        (
            ("two-link", "--joint-damping", "0.1", "--stiffness", "1", "--largest-force", "3"),
            "--joint-resolution 0.001",
        ),
        (
            ("two-link", "--joint-damping", "1", "--stiffness", "1", "--largest-force", "1,2,3"),
            "--largest-force: a force",
        ),
    ],
)
def test_bad_input_is_one_line(run: Run, argv: tuple[str, ...], words: str) -> None:
    """Status 2, and what to try."""
    status, out, err = run("workspace", *argv)
    assert (status, out) == (2, "")
    assert words in err
    assert err.count("\n") == 1


COUNTED = (
    "workspace", "two-link", "--joint-damping", "0.05", "--stiffness", "200", "--joint-resolution", "0.001",
    "--joint-friction", "0.01", "--points", "20",
)  # fmt: skip


def test_encoder_steps_are_counted_up_to_a_force(run: Run) -> None:
    """In words, as data, in the certificate; between what is covered and what is refuted: status 3."""
    status, out, _ = run(*COUNTED, "-o", "proof.json", "--all")
    words = " ".join(out.split())
    assert status == 0
    assert "for wall forces up to 28.6 N, proved. Encoder steps are counted" in words
    assert re.search(r"0.005774 N·m, 0.002954 N·m in joint 1, 2, and .* more for each newton", words)
    assert re.search(
        r"encoder steps covered up to 28.6 N; from 89[.0-9]* N on a motion takes energy out", words
    )
    words = " ".join(run("verify", "proof.json")[1].split())
    assert "its encoder steps counted: force and Jacobian are those of the readings" in words
    found = json.loads(run(*COUNTED, "--json")[1])
    assert (found["encoder"], found["torque"], found["can_be_refuted"]) == ("counted", "follows", True)
    steps = found["encoder_steps"]
    assert found["largest_forces_N"] == [steps["covered_force_N"]] == [pytest.approx(28.6, rel=1e-3)]
    assert steps["motion"]["energy_J"] < 0
    assert steps["motion"]["largest_force_N"] == steps["refuted_force_N"]
    assert found["wall"]["stiffness_N_per_m"] == [[200, 0], [0, 200]]
    assert run(*COUNTED, "--largest-force", "40")[0] == 3
    status, out, _ = run(*COUNTED, "--largest-force", "90")
    assert status == 1
    assert "at the readings of the encoders" in " ".join(out.split())


def test_a_delay_is_reported_with_its_unit(run: Run) -> None:
    """A number without one is in seconds."""
    out = run("workspace", "two-link", "--joint-damping", "0.05", "--stiffness", "20", "--delay", "0.003")[1]
    assert "3 ms, 3 samples" in out


def test_a_description_from_the_command_line(run: Run, tmp_path: Path) -> None:
    """A URDF with its own damping; one joint held."""
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


HELD = "j1=0,j2=0.1,j3=0,j4=0,j5=0"
POSED = ("workspace", "arm.urdf", "--pose", "--points", "10", "--hold", HELD, "--json")


def test_a_wall_in_pose(run: Run, tmp_path: Path) -> None:
    """Its factor, the least damping, the motion with its turns; a wall of that factor holds."""
    random_arm(tmp_path / "arm.urdf", 4, 6)
    status, out, _ = run(*POSED, "--stiffness", "40000", "--rotational-stiffness", "400 N*m/rad")
    found = json.loads(out)
    assert (status, found["outcome"]) == (1, "active")
    assert found["largest_stiffness_N_per_m"] is found["smallest_margin_N_s_per_m"] is None
    assert found["smallest_margin_in_joints_N_m_s_per_rad"] < 0
    motion = found["motion"]
    assert [len(motion[key][0]) for key in ("joints_rad", "positions_m", "rotations_rad")] == [6, 3, 3]
    assert 0 < sum(found["least_additions_N_m_s_per_rad"]) < 6 * found["addition_to_all_N_m_s_per_rad"]
    factor = 0.9 * found["stiffness_factor"]
    better = run(*POSED, "--stiffness", str(40000 * factor), "--rotational-stiffness", str(400 * factor))
    assert (better[0], json.loads(better[1])["outcome"]) == (0, "passive")


@pytest.mark.parametrize("rest", [(), ("--rest", "middle")])
def test_the_proof_of_a_wall_in_pose_is_verified(rest: tuple[str, ...], run: Run, tmp_path: Path) -> None:
    """Saved, read and proved again, with both units in the words; with more of the rotation it is refused."""
    random_arm(tmp_path / "arm.urdf", 4, 6)
    wall = ("--stiffness", "40", "--rotational-stiffness", "0.4 N*m/rad")
    assert run(*POSED[:-1], *rest, *wall, "-o", "proof.json")[0] == 0
    status, out, _ = run("verify", "proof.json")
    where = "from the orientation of rest that is given" if rest else "in every orientation of rest"
    assert status == 0
    words = " ".join(out.split())
    assert f"in pose, with up to 40 N/m and 0.4 N·m/rad, {where}" in words
    assert "stiffness [[40, 0, 0, 0, 0, 0], [0, 40," in words
    assert "0.4]] in N, m, rad" in words
    document = json.loads((tmp_path / "proof.json").read_text(encoding="utf-8"))
    document["certificate"]["wall"]["stiffness_N_m_rad"][5][5] = "4000"
    (tmp_path / "more.json").write_text(json.dumps(document))
    assert run("verify", "more.json")[0] != 0


def test_a_wall_by_matrices(run: Run, tmp_path: Path) -> None:
    """A file with units in it says what the options say; couplings need a place of rest."""
    random_arm(tmp_path / "arm.urdf", 4, 6)

    def write() -> None:
        path.write_text("[wall]\nstiffness = [" + ", ".join(f"[{', '.join(row)}]" for row in rows) + "]")

    rows = [["0"] * 6 for _ in range(6)]
    for i in range(6):
        rows[i][i] = '"4 N/mm"' if i < 3 else '"40 N*m/rad"'
    path = tmp_path / "wall.toml"
    write()
    by_file = run(*POSED, "--wall", "wall.toml")[1]
    assert by_file == run(*POSED, "--stiffness", "4000", "--rotational-stiffness", "40")[1]
    rows[0][4] = rows[4][0] = "20"
    write()
    assert "say where it rests" in run(*POSED, "--wall", "wall.toml")[2]
    found = json.loads(run(*POSED, "--wall", "wall.toml", "--rest", "middle")[1])
    assert "at rest with the joints at" in found["region"]
    assert found["region"] != json.loads(run(*POSED, "--wall", "wall.toml", "--rest", "j0=0.2")[1])["region"]


@pytest.mark.parametrize(
    ("text", "words"),
    [
        ("stiffness = [[1, 0], [0, 1]]", "it may be: wall"),
        ("[wall]\ndamping = [[1, 0], [0, 1]]", "stiffness"),
        ("[wall]\nstiffness = [[1, 0], [0]]", "square matrix"),
        ("[wall]\nstiffness = [[1, 0], [0, -1]]", "negative eigenvalue"),
        ('[wall]\nstiffness = [["1 N*m/rad", 0], [0, 1]]', "N/m"),
        ("[wall]\nstiffness = [[1, 0], [0, 1]]\nmass = 3", "mass"),
    ],
)
def test_a_file_that_is_no_wall(run: Run, tmp_path: Path, text: str, words: str) -> None:
    """Status 2, and one line with the place and what is expected."""
    (tmp_path / "wall.toml").write_text(text)
    status, _, err = run("workspace", "two-link", "--joint-damping", "0.1", "--wall", "wall.toml")
    assert status == 2
    assert re.search(words, err)
    assert err.count("\n") == 1


def test_the_least_damping_is_shown(run: Run) -> None:
    """Which joints, how much each, and how much together."""
    words = " ".join(run(*HAPLY, "--stiffness", "800", "--all")[1].split())
    assert "what to change" in words
    assert "all joints" in words
    assert re.search(r"least in all .* in joint 1, .* in joint 2, together", words)
    one = run("workspace", "two-link", "--joint-damping", "0.02,0.012", "--stiffness", "800", "--all")[1]
    words = " ".join(one.split())
    assert re.search(r"least in all [0-9.]+ N·m·s/rad more damping in joint 1; less than [0-9.]+", words)


def test_a_wall_in_pose_is_reported_and_drawn(run: Run, tmp_path: Path) -> None:
    """A planar chain: the margin in the joints, the factor, a picture."""
    pose = ("workspace", "two-link", "--joint-damping", "0.02", "--pose", "--points", "20")
    wall = ("--stiffness", "900", "--rotational-stiffness", "0.5 N*m/rad", "--plot", "map.png")
    status, out, _ = run(*pose, *wall, "--all")
    words = " ".join(out.split())
    assert status == 1
    assert "in the worst direction of the joints" in words
    assert re.search("stiffness 0.9[0-9]* times at every point of the map", words)
    assert "its stiffness times 0.9" in words
    assert (tmp_path / "map.png").stat().st_size > 10_000


JOINTS = """[joints]
damping = [["20 N*mm*s/rad", 0.005], [0.005, 0.01]]
torque_limit = [0.5, 0.4]
"""
TWO_LINK = ("workspace", "two-link", "--points", "10", "--stiffness", "200")


def test_joints_that_damp_each_other_come_from_a_file(run: Run) -> None:
    """A matrix in [joints], in the report and in JSON; the proof is of it."""
    Path("joints.toml").write_text(JOINTS, encoding="utf-8")
    status, out, _ = run(*TWO_LINK, "--joints", "joints.toml", "-o", "proof.json")
    assert status == 0
    assert "joint damping [[0.02, 0.005], [0.005, 0.01]] N·m·s/rad" in " ".join(out.split())
    told = json.loads(Path("proof.json").read_text(encoding="utf-8"))
    assert told["joint_damping_N_m_s_rad"] == [[0.02, 0.005], [0.005, 0.01]]
    assert told["certificate"]["arm"]["damping_N_m_s_rad"] == [["0.02", "0.005"], ["0.005", "0.01"]]
    status, out, _ = run("verify", "proof.json")
    assert status == 0
    assert "[[0.02, 0.005], [0.005, 0.01]] in N, m, s, rad" in out


@pytest.mark.parametrize(
    ("text", "options", "words"),
    [
        ("[joints]\ndamping = [[0.02, 0.005], [0.006, 0.01]]", (), "symmetric"),
        ("[joints]\ndamping = [[0.02, 0.0145], [0.0145, 0.01]]", (), "no negative eigenvalue"),
        (
            "[joints]\ndamping = [[0.02, 0.005], 0.01]",
            (),
            "joints.toml: [joints]: damping is one number for each",
        ),
        ("[joints]\ndamping = 0.02", (), "joints.toml: [joints]: damping is a list"),
        ("[joints]\nfriction = [0.02, 0.01]", (), "friction"),
        ("[wall]\nstiffness = [[1]]", (), "joints.toml"),
        (
            JOINTS,
            ("--joint-damping", "0.02"),
            "--joints FILE says damping already; leave out --joint-damping",
        ),
        ("[joints]\ntorque_limit = [1, 1]", (), "no source gives the joint damping of two-link"),
    ],
)
def test_files_of_joints_that_cannot_be_used(
    run: Run, text: str, options: tuple[str, ...], words: str
) -> None:
    """One line each, status 2."""
    Path("joints.toml").write_text(text, encoding="utf-8")
    status, _, err = run(*TWO_LINK, "--joints", "joints.toml", *options)
    assert status == 2
    assert words in err
    assert err.count("\n") == 1


def test_joints_by_file_and_by_options(run: Run) -> None:
    """What the file leaves out may come from options."""
    Path("joints.toml").write_text("[joints]\ncoulomb_friction = [0.01, 0.01]", encoding="utf-8")
    status, out, _ = run(*TWO_LINK, "--joints", "joints.toml", "--joint-damping", "0.02,0.01")
    assert status == 0
    assert "joint damping 0.02, 0.01 N·m·s/rad" in " ".join(out.split())
