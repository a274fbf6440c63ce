"""`zwidth gains`: joint by joint, decided, reported, saved; one clear line on bad input."""

from __future__ import annotations

import json
import re
from pathlib import Path

import pytest

import zwidth as zw
from zwidth.cli.main import main

LEADER = "LeaderArmParam:\n  Kp: [20, 25]\n  Kd: [0.05, 0.02]\n"
FOLLOWER = LEADER.replace("Leader", "Follower").replace("25", "26")
PLANT = "[arm]\ndamping = [0.4, 0.5]\ncoulomb_friction = 0.1\n"
YAM = 'motor_list: [[1, "DM4340"], [2, "DM4310"]]\nkp: [80, 10]\nkd: [5, 1.5]\n'
SERVOS = '{"position_p_coefficient": 16}'
LINK = ["--link-delay", "2 ms", "--link-delay-back", "3 ms", "--drive-rate", "10 kHz"]


@pytest.fixture
def files(tmp_path: Path) -> dict[str, str]:
    """Gains of three kinds, and a plant."""
    texts = {
        "leader.yaml": LEADER,
        "follower.yaml": FOLLOWER,
        "plant.toml": PLANT,
        "yam.yml": YAM,
        "so.json": SERVOS,
    }
    for name, text in texts.items():
        (tmp_path / name).write_text(text, encoding="utf-8")
    return {name.partition(".")[0]: str(tmp_path / name) for name in texts}


def test_it_says_what_python_says(files, capsys):
    """The same JSON; the exit status is that of the worst joint."""
    argv = [files["leader"], files["follower"], "--plant", files["plant"], *LINK]
    assert main(["gains", *argv, "--json"]) == 0
    told = json.loads(capsys.readouterr().out)
    gains = zw.read_gains(files["leader"], files["follower"])
    found = zw.check_gains(gains, plant=files["plant"], delay=("0.002", "0.003"), drive_rate=10_000)
    assert told == json.loads(found.to_json())
    assert told["outcome"] == "passive"
    assert told["joints"][1]["follower"]["stiffness_N_m_per_rad"] == "26"
    slow = ["gains", files["leader"], "--plant", files["plant"], "--link-delay", "0.2"]
    assert main(slow) == 1
    assert "are looked for where readings are at most 100 samples" in " ".join(
        capsys.readouterr().out.split()
    )


def test_the_report_has_a_row_for_each_joint(files, capsys):
    """Gains, verdict, what is passive, and what was assumed."""
    assert main(["gains", files["leader"], "--plant", files["plant"]]) == 0
    said = capsys.readouterr().out
    for part in (
        "PASSIVE Of 2 joints, each by itself: 2 passive.",
        "joint K kd b verdict limit with ideal drive",
        "joint largest K best K with kd b needed",
        "assumes",
        "no file gives the follower's gains",
        "rate 1 kHz: enactic/openarm_teleop",
    ):
        assert part in " ".join(said.split())
    assert len(re.findall(r"^ +J[12] ", said, re.MULTILINE)) == 4


def test_ideal_drives_and_bilateral_kp(files, capsys):
    """Options of the law and of the arms."""
    assert main(["gains", files["yam"]]) == 1
    assert "kd in the drive" in capsys.readouterr().out
    assert main(["gains", files["yam"], "--ideal-drive", "--bilateral-kp", "0.1", "--json"]) == 0
    told = json.loads(capsys.readouterr().out)
    assert [joint["leader"]["stiffness_N_m_per_rad"] for joint in told["joints"]] == ["8", "1"]


def test_a_limp_leader_is_told_and_not_decided(files, capsys):
    """3 without --both."""
    argv = ["gains", files["so"], "--supply-voltage", "7.4 V"]
    assert main(argv) == 3
    said = capsys.readouterr().out
    assert "The leader feels nothing" in said
    assert "8.899" in said
    assert main([*argv, "--json"]) == 3
    assert json.loads(capsys.readouterr().out)["joints"][0]["leader"] is None
    assert main([*argv, "--both"]) == 0


@pytest.mark.parametrize("options", [[], ["--rate", "20 Hz", "--link-delay", "0.4"]])
def test_what_is_saved_is_verified(files, options, tmp_path, capsys):
    """A proof or a violation for each joint; with an outcome turned round it is refused."""
    path = tmp_path / "gains.json"
    argv = ["gains", files["leader"], "--plant", files["plant"], *options]
    status = main([*argv, "-o", str(path)])
    assert f"written: {path}" in capsys.readouterr().out
    assert main(["verify", str(path)]) == 0
    assert capsys.readouterr().out.count(" VALID ") == 1 + 2
    document = json.loads(path.read_text(encoding="utf-8"))
    assert status == (document["outcome"] == "active")
    document["joints"][1]["outcome"] = "active" if status == 0 else "passive"
    path.write_text(json.dumps(document), encoding="utf-8")
    assert main(["verify", str(path)]) == 1
    assert main([*argv, "-o", str(path)]) == 2


def test_one_joint_has_the_report_of_its_pair(files, tmp_path, capsys):
    """The same numbers, the notes on the gains, a file that is verified, a picture."""
    argv = ["gains", files["leader"], "--plant", files["plant"], *LINK, "--joint", "J2"]
    saved, drawn = tmp_path / "pair.json", tmp_path / "pair.png"
    assert main([*argv, "-o", str(saved), "--plot", str(drawn)]) == 0
    said = " ".join(capsys.readouterr().out.split())
    for part in ("PASSIVE No motion of two hands", "stiffness may go up to", "of the gains", "FREQUENCY"):
        assert part in said
    assert drawn.exists()
    assert main(["verify", str(saved)]) == 0
    capsys.readouterr()
    assert main([*argv, "--json"]) == 0
    told = json.loads(capsys.readouterr().out)
    pair = zw.read_gains(files["leader"]).pairs(files["plant"], None, ("0.002", "0.003"), 10_000)["J2"]
    assert told.pop("notes")
    assert told == json.loads(zw.check(pair).to_json())
    assert main([*argv[:-1], "J9"]) == 2
    assert 'there is no joint "J9"' in capsys.readouterr().err
    assert main(["gains", files["leader"], "--plot", str(tmp_path / "b.png")]) == 2
    assert "--joint" in capsys.readouterr().err


def test_a_document_without_proofs_is_no_evidence(tmp_path, capsys):
    """Nothing is said to be valid of nothing."""
    for joints, status, said in (
        ([], 2, "no evidence"),
        (3, 1, "joints must be a list"),
        ([{"outcome": "undecided"}], 2, "no evidence"),
    ):
        path = tmp_path / "gains.json"
        path.write_text(json.dumps({"format": "zwidth gains 1", "joints": joints}), encoding="utf-8")
        assert main(["verify", str(path)]) == status
        assert said in "".join(capsys.readouterr())


@pytest.mark.parametrize(
    ("options", "said"),
    [
        (["--plant", "none.toml"], "there is no file"),
        (["--drive-rate", "500 Hz"], "whole times"),
        (["--link-delay-back", "1 ms"], "give --link-delay"),
        (["--link-delay", "-1 ms"], "≥ 0"),
        (["--link-delay", "2"], 'write "2 ms"'),
        (["--rate", "fast"], "rate"),
        (["--bilateral-kp", "0.1"], "belongs to gains of i2rt"),
        (["--both"], "leave it out"),
        (["--family", "nothing"], "there is no family"),
    ],
)
def test_bad_input_is_one_line(files, options, said, capsys):
    """On standard error, status 2."""
    plant = [] if "--plant" in options else ["--plant", files["plant"]]
    assert main(["gains", files["leader"], *plant, *options]) == 2
    error = capsys.readouterr().err
    assert error.count("\n") == 1
    assert said in error


def test_gains_of_a_follower_alone_are_not_saved(files, tmp_path, capsys):
    """There is no verdict to save."""
    argv = ["gains", files["so"], "--supply-voltage", "12", "-o", str(tmp_path / "a.json")]
    assert main(argv) == 2
    assert "--both" in capsys.readouterr().err
