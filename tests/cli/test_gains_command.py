"""`zwidth gains`: joint by joint, decided, reported, saved; one clear line on bad input."""

import json
import re
from pathlib import Path

import pytest

import zwidth as zw

LEADER = "LeaderArmParam:\n  Kp: [20, 25]\n  Kd: [0.05, 0.02]\n"
FILES = {
    "leader.yaml": LEADER,
    "follower.yaml": LEADER.replace("Leader", "Follower").replace("25", "26"),
    "plant.toml": "[arm]\ndamping = [0.4, 0.5]\ncoulomb_friction = 0.1\n",
    "yam.yml": 'motor_list: [[1, "DM4340"], [2, "DM4310"]]\nkp: [80, 10]\nkd: [5, 1.5]\n',
    "so.json": '{"position_p_coefficient": 16}',
}
ARMS = "gains leader.yaml --plant plant.toml"
LINK = "--link-delay '2 ms' --link-delay-back '3 ms' --drive-rate '10 kHz'"


@pytest.fixture(autouse=True)
def _files(run):
    """Gains of three kinds, and a plant."""
    for name, text in FILES.items():
        Path(name).write_text(text, encoding="utf-8")


def test_it_says_what_python_says(run):
    told = run(f"gains leader.yaml follower.yaml --plant plant.toml {LINK} --json").json
    gains = zw.read_gains("leader.yaml", "follower.yaml")
    found = zw.check_gains(gains, plant="plant.toml", delay=("0.002", "0.003"), drive_rate=10_000)
    assert told == json.loads(found.to_json())
    assert told["outcome"] == "passive"
    assert told["joints"][1]["follower"]["stiffness_N_m_per_rad"] == "26"
    run(f"{ARMS} --link-delay 0.2", 1).says("are looked for where readings are at most 100 samples")


def test_the_report_has_a_row_for_each_joint(run):
    said = run(ARMS)
    for part in (
        "PASSIVE Of 2 joints, each by itself: 2 passive. J",
        ": No motion of two hands, one on each arm, however fast or skilled, can take energy out of this ",
        "joint K kd b verdict limit with ideal drive",
        "joint largest K best K with kd b needed",
        "assumes",
        "no file gives the follower's gains",
        "rate 1 kHz: enactic/openarm_teleop",
    ):
        assert part in said.words
    assert len(re.findall(r"^ +J[12] ", said.out, re.MULTILINE)) == 4


def test_ideal_drives_and_bilateral_kp(run):
    assert "kd in the drive" in run("gains yam.yml", 1).out
    told = run("gains yam.yml --ideal-drive --bilateral-kp 0.1 --json").json
    assert [joint["leader"]["stiffness_N_m_per_rad"] for joint in told["joints"]] == ["8", "1"]


def test_a_limp_leader_is_told_and_not_decided(run, refused):
    """3 without --both."""
    limp = "gains so.json --supply-voltage '7.4 V'"
    run(limp, 3).says("The leader feels nothing", "--both asks", "8.899")
    assert "no verdict for elbow; --both makes one" in refused(f"{limp} --joint elbow")
    assert run(f"{limp} --json", 3).json["joints"][0]["leader"] is None
    run(f"{limp} --both")


@pytest.mark.parametrize("outcome", ["passive", "active"])
def test_what_is_saved_is_verified(run, refused, outcome):
    """A proof or a violation for each joint; with an outcome turned round it is refused."""
    line = f"{ARMS} -o gains.json" + (" --rate '20 Hz' --link-delay 0.4" if outcome == "active" else "")
    assert "written: gains.json" in run(line, int(outcome == "active")).out
    assert run("verify gains.json").out.count(" VALID ") == 1 + 2
    document = json.loads(Path("gains.json").read_text(encoding="utf-8"))
    assert document["outcome"] == outcome
    document["joints"][1]["outcome"] = "passive" if outcome == "active" else "active"
    Path("gains.json").write_text(json.dumps(document), encoding="utf-8")
    run("verify gains.json", 1)
    refused(line)


def test_one_joint_has_the_report_of_its_pair(run):
    joint = f"{ARMS} {LINK} --joint J2"
    said = run(f"{joint} -o pair.json --plot pair.png").words
    for part in ("PASSIVE No motion of two hands", "stiffness may go up to", "of the gains", "FREQUENCY"):
        assert part in said
    assert Path("pair.png").exists()
    run("verify pair.json")
    told = run(f"{joint} --json").json
    pair = zw.read_gains("leader.yaml").pairs("plant.toml", None, ("0.002", "0.003"), 10_000)["J2"]
    assert told.pop("notes")
    assert told == json.loads(zw.check(pair).to_json())


@pytest.mark.parametrize(
    ("joints", "status", "said"),
    [
        ([], 2, "no evidence"),
        (3, 1, "joints must be a list"),
        ([{"outcome": "undecided"}], 2, "no evidence"),
    ],
)
def test_a_document_without_proofs_is_no_evidence(run, joints, status, said):
    """Nothing is said to be valid of nothing."""
    document = {"format": "zwidth gains 1", "joints": joints}
    Path("gains.json").write_text(json.dumps(document), encoding="utf-8")
    result = run("verify gains.json", status)
    assert said in result.out + result.err


@pytest.mark.parametrize(
    ("line", "said"),
    [
        ("gains leader.yaml --plant none.toml", "there is no file"),
        ("gains leader.yaml --plot b.png", "--joint"),
        ("gains so.json --supply-voltage 12 -o a.json", "--both"),
        (f"{ARMS} --joint J9", 'there is no joint "J9"'),
        (f"{ARMS} --drive-rate '500 Hz'", "whole times"),
        (f"{ARMS} --link-delay-back '1 ms'", "give --link-delay"),
        (f"{ARMS} --link-delay '-1 ms'", "≥ 0"),
        (f"{ARMS} --link-delay 2", 'write "2 ms"'),
        (f"{ARMS} --rate fast", "rate"),
        (f"{ARMS} --bilateral-kp 0.1", "belongs to gains of i2rt"),
        (f"{ARMS} --both", "leave it out"),
        (f"{ARMS} --family nothing", "there is no family"),
    ],
)
def test_bad_input_is_one_line(refused, line, said):
    assert said in refused(line)
