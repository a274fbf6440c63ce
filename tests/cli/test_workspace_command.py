"""`zwidth workspace`: the verdict, the map in files, and one clear line on bad input."""

import json
import re
from pathlib import Path

import pytest
import xarray
from described_arms import random_arm

NO_STEPS = "--joint-resolution 0"
CRANKS = "workspace haply-2diy --points 20 --joint-damping"
HAPLY = f"{CRANKS} 0.003 {NO_STEPS}"


def test_a_wall_that_holds_everywhere(run):
    """Status 0, and nothing to change; 4 behind its own encoders, whose steps are not in the proof."""
    words = run(f"{HAPLY} --stiffness 300").words
    assert "PASSIVE No motion of the hand takes energy out with x from -50 to 50 mm" in words
    assert "what to change" not in words
    assert "haply-2diy, 2 joints, 1 kHz" in words
    assert "The arm is taken to be read without steps. The torque" in words
    words = run(f"{CRANKS} 0.003 --stiffness 300", 4).words
    assert "PASSIVE WITHOUT ENCODER STEPS Read without steps, no motion of the hand would take" in words
    assert "Encoder steps are not counted:" in words


def test_a_wall_that_fails_says_what_to_change(run):
    found = run(f"{HAPLY} --stiffness 800 --json", 1).json
    assert found["outcome"] == "active"
    assert found["motion"]["energy_J"] < 0
    enough = 0.003 + found["addition_to_all_N_m_s_per_rad"]
    run(f"{CRANKS} {enough} {NO_STEPS} --stiffness 800")


def test_just_below_the_limit_is_undecided(run):
    """The points hold, and between two of them the checker finds that the condition fails: status 3."""
    chain = "workspace two-link --joint-damping 0.02,0.012 --points 20 --stiffness"
    found = run(f"{chain} 300 --json", None).json
    words = run(f"{chain} {0.9999 * found['largest_stiffness_N_per_m']}", 3).words
    assert "the arm in its region, q1 from 0 to 3.142 rad; q2 from" in words
    assert "N/m in every direction" in words
    assert "between the points" in words
    assert "There is no certificate: the damping is not enough at" in words


def test_the_certificate_is_saved_and_verified(run):
    run(f"{HAPLY} --stiffness 300 -o proof.json")
    words = run("verify proof.json").words
    assert "VALID The arm below is passive, proved: no motion of the hand" in words
    assert "read without encoder steps; the torque follows the arm" in words
    assert "stiffness [[300, 0], [0, 300]] N/m" in words
    assert "link 0.07 m, rod 0.09 m" in words
    text = Path("proof.json").read_text(encoding="utf-8")
    found = json.loads(text)
    assert (found["outcome"], found["certificate"]["kind"]) == ("passive", "arm")
    Path("other.json").write_text(text.replace('"300"', '"900"'), encoding="utf-8")
    run("verify other.json", 1)
    run(f"{HAPLY} --stiffness 900 -o active.json", 1)
    run("verify active.json", 2)


def test_the_map_is_saved_and_drawn(run, refused):
    line = f"{HAPLY} --stiffness 800 --plot map.png -o map.nc"
    run(line, 1)
    with xarray.open_dataset("map.nc", engine="h5netcdf") as data:
        assert data["margin"].attrs["units"] == "N*s/m"
        assert data["margin"].shape == (20, 20)
    assert Path("map.png").stat().st_size > 10_000
    assert "--force" in refused(line)


CHAIN = "two-link --joint-damping 0.1"


COUNTED = (
    "workspace two-link --joint-damping 0.05 --stiffness 200 --joint-resolution 0.001 "
    "--joint-friction 0.01 --points 20"
)


def test_encoder_steps_are_counted_up_to_a_force(run):
    words = run(f"{COUNTED} -o proof.json --all").words
    assert "for wall forces up to 28.6 N, proved. Encoder steps are counted" in words
    assert re.search(r"5.774 mN·m, 2.954 mN·m in q1, q2, and .* more for each newton", words)
    covered = r"encoder steps covered up to 28.6 N; from 89[.0-9]* N on a motion takes energy out"
    assert re.search(covered, words)
    run("verify proof.json").says("its encoder steps counted: force and Jacobian are those of the readings")
    found = run(f"{COUNTED} --json").json
    assert (found["encoder"], found["torque"], found["can_be_refuted"]) == ("counted", "follows", True)
    steps = found["encoder_steps"]
    assert found["largest_forces_N"] == [steps["covered_force_N"]] == [pytest.approx(28.6, rel=1e-3)]
    assert steps["motion"]["energy_J"] < 0
    assert steps["motion"]["largest_force_N"] == steps["refuted_force_N"]
    assert found["wall"]["stiffness_N_per_m"] == [[200, 0], [0, 200]]
    run(f"{COUNTED} --largest-force 40", 3)
    assert "at the readings of the encoders" in run(f"{COUNTED} --largest-force 90", 1).words


def test_a_delay_is_reported_with_its_unit(run):
    run("workspace two-link --joint-damping 0.05 --stiffness 20 --delay 0.003", None).says("3 ms, 3 samples")


def test_a_description_from_the_command_line(run):
    joint = (
        '<joint name="{0}" type="revolute"><parent link="{1}"/><child link="{2}"/><origin xyz="{3} 0 0"/>'
        '<axis xyz="0 0 1"/><limit lower="0.2" upper="1.2" effort="1" velocity="1"/>'
        '<dynamics damping="0.02"/></joint>'
    )
    tip = '<joint name="tip" type="fixed"><parent link="c"/><child link="d"/><origin xyz="0.1 0 0"/></joint>'
    links = "".join(f'<link name="{name}"/>' for name in "abcd")
    joints = joint.format("first", "a", "b", 0) + joint.format("second", "b", "c", 0.1) + tip
    Path("arm.urdf").write_text(f'<robot name="arm">{links}{joints}</robot>', encoding="utf-8")
    words = run("workspace arm.urdf --stiffness 200 --hold second=0.5 --points 10 --frame d").words
    assert "second held at 0.5" in words


HELD = "--hold j1=0,j2=0.1,j3=0,j4=0,j5=0"
POSED = f"workspace arm.urdf --pose --points 10 {HELD}"


@pytest.fixture
def six():
    """A chain of six joints, all but the first held, in arm.urdf."""
    random_arm(Path("arm.urdf"), 4, 6)


def test_a_wall_in_pose(run, six):
    wall = "--stiffness {} --rotational-stiffness '{} N*m/rad' --json"
    found = run(f"{POSED} {wall.format(40000, 400)}", 1).json
    assert found["outcome"] == "active"
    assert found["largest_stiffness_N_per_m"] is found["smallest_margin_N_s_per_m"] is None
    assert found["smallest_margin_in_joints_N_m_s_per_rad"] < 0
    motion = found["motion"]
    assert [len(motion[key][0]) for key in ("joints_rad", "positions_m", "rotations_rad")] == [6, 3, 3]
    assert 0 < sum(found["least_additions_N_m_s_per_rad"]) < 6 * found["addition_to_all_N_m_s_per_rad"]
    factor = 0.9 * found["stiffness_factor"]
    assert run(f"{POSED} {wall.format(40000 * factor, 400 * factor)}").json["outcome"] == "passive"


@pytest.mark.parametrize("rest", ["", "--rest middle"])
def test_the_proof_of_a_wall_in_pose_is_verified(rest, run, six):
    """Saved, read and proved again, with both units in the words; with more of the rotation it is refused."""
    run(f"{POSED} {rest} --stiffness 40 --rotational-stiffness '0.4 N*m/rad' -o proof.json")
    words = run("verify proof.json").words
    where = "from the orientation of rest that is given" if rest else "in every orientation of rest"
    assert f"in pose, with up to 40 N/m and 0.4 N·m/rad, {where}" in words
    assert "stiffness [[40, 0, 0, 0, 0, 0], [0, 40," in words
    assert "0.4]] in N, m, rad" in words
    document = json.loads(Path("proof.json").read_text(encoding="utf-8"))
    document["certificate"]["wall"]["stiffness_N_m_rad"][5][5] = "4000"
    Path("more.json").write_text(json.dumps(document), encoding="utf-8")
    assert run("verify more.json", None).status != 0


def test_a_wall_by_matrices(run, six):
    """A file with units in it says what the options say; couplings need a place of rest."""

    def write():
        rows_written = ", ".join(f"[{', '.join(row)}]" for row in rows)
        Path("wall.toml").write_text(f"[wall]\nstiffness = [{rows_written}]", encoding="utf-8")

    units = ['"4 N/mm"'] * 3 + ['"40 N*m/rad"'] * 3
    rows = [["0"] * i + [unit] + ["0"] * (5 - i) for i, unit in enumerate(units)]
    write()
    by_file = run(f"{POSED} --wall wall.toml --json", None)
    assert by_file == run(f"{POSED} --stiffness 4000 --rotational-stiffness 40 --json", None)
    rows[0][4] = rows[4][0] = "20"
    write()
    assert "say where it rests" in run(f"{POSED} --wall wall.toml --json", 2).err
    by = f"{POSED} --wall wall.toml --json --rest"
    rests = [run(f"{by} {rest}", None).json for rest in ("middle", "j0=0.2")]
    assert "at rest with the joints at" in rests[0]["region"]
    assert rests[0]["region"] != rests[1]["region"]


@pytest.mark.parametrize(
    ("text", "words"),
    [
        ("stiffness = [[1, 0], [0, 1]]", "choose from: wall"),
        ("[wall]\ndamping = [[1, 0], [0, 1]]", "stiffness"),
        ("[wall]\nstiffness = [[1, 0], [0]]", "square matrix"),
        ("[wall]\nstiffness = [[1, 0], [0, -1]]", "negative eigenvalue"),
        ('[wall]\nstiffness = [["1 N*m/rad", 0], [0, 1]]', "N/m"),
        ("[wall]\nstiffness = [[1, 0], [0, 1]]\nmass = 3", "mass"),
    ],
)
def test_a_file_that_is_no_wall(refused, text, words):
    Path("wall.toml").write_text(text, encoding="utf-8")
    assert re.search(words, refused(f"workspace {CHAIN} --wall wall.toml"))


def test_the_least_damping_is_shown(run):
    words = run(f"{HAPLY} --stiffness 800 --all", 1).words
    assert "what to change" in words
    assert "all joints" in words
    assert re.search(r"least in all .* in joint 1, .* in joint 2, together", words)
    words = run("workspace two-link --joint-damping 0.02,0.012 --stiffness 800 --all", 1).words
    assert re.search(r"least in all more damping, [0-9.]+ m?N·m·s/rad in q1; less than [0-9.]+", words)


def test_a_wall_in_pose_is_reported_and_drawn(run):
    wall = "--stiffness 900 --rotational-stiffness '0.5 N*m/rad' --plot map.png"
    words = run(f"workspace two-link --joint-damping 0.02 --pose --points 20 {wall} --all", 1).words
    assert "in the worst direction of the joints" in words
    assert re.search("stiffness 0.9[0-9]* times at every point of the map", words)
    assert "its stiffness times 0.9" in words
    assert Path("map.png").stat().st_size > 10_000


JOINTS = """[joints]
damping = [["20 N*mm*s/rad", 0.005], [0.005, 0.01]]
torque_limit = [0.5, 0.4]
"""
TWO_LINK = "workspace two-link --points 10 --stiffness 200 --joints joints.toml"


def test_joints_that_damp_each_other_come_from_a_file(run):
    Path("joints.toml").write_text(JOINTS, encoding="utf-8")
    run(f"{TWO_LINK} -o proof.json").says("joint damping [[0.02, 0.005], [0.005, 0.01]] N·m·s/rad")
    told = json.loads(Path("proof.json").read_text(encoding="utf-8"))
    assert told["joint_damping_N_m_s_rad"] == [[0.02, 0.005], [0.005, 0.01]]
    assert told["certificate"]["arm"]["damping_N_m_s_rad"] == [["0.02", "0.005"], ["0.005", "0.01"]]
    assert "[[0.02, 0.005], [0.005, 0.01]] in N, m, s, rad" in run("verify proof.json").out


@pytest.mark.parametrize(
    ("text", "options", "words"),
    [
        ("[joints]\ndamping = [[0.02, 0.005], [0.006, 0.01]]", "", "symmetric"),
        ("[joints]\ndamping = [[0.02, 0.0145], [0.0145, 0.01]]", "", "no negative eigenvalue"),
        (
            "[joints]\ndamping = [[0.02, 0.005], 0.01]",
            "",
            "damping: one number for each joint, or a square matrix",
        ),
        ("[joints]\ndamping = 0.02", "", "joints.toml: [joints]: damping is a list"),
        ("[joints]\nfriction = [0.02, 0.01]", "", "friction"),
        ("[wall]\nstiffness = [[1]]", "", "joints.toml"),
        (JOINTS, "--joint-damping 0.02", "--joints FILE says damping already; leave out --joint-damping"),
        ("[joints]\ntorque_limit = [1, 1]", "", "no source gives the joint damping of two-link"),
    ],
)
def test_files_of_joints_that_cannot_be_used(refused, text, options, words):
    Path("joints.toml").write_text(text, encoding="utf-8")
    assert words in refused(f"{TWO_LINK} {options}")


def test_joints_by_file_and_by_options(run):
    Path("joints.toml").write_text("[joints]\ncoulomb_friction = [0.01, 0.01]", encoding="utf-8")
    run(f"{TWO_LINK} --joint-damping 0.02,0.01").says("joint damping 0.02 N·m·s/rad, 0.01 N·m·s/rad")


TWO_LINKS = """<robot name="two"><link name="base"/><link name="upper"/><link name="lower"/><link name="tip"/>
<joint name="shoulder" type="revolute"><parent link="base"/><child link="upper"/><axis xyz="0 0 1"/>
<limit lower="-1.5" upper="1.5" effort="5" velocity="5"/></joint>
<joint name="elbow" type="revolute"><parent link="upper"/><child link="lower"/><origin xyz="0.2 0 0"/>
<axis xyz="0 0 1"/><limit lower="0.3" upper="2.5" effort="5" velocity="5"/></joint>
<joint name="end" type="fixed"><parent link="lower"/><child link="tip"/>
<origin xyz="0.2 0 0"/></joint></robot>"""


@pytest.mark.parametrize(("frame", "said"), [("lower", ", which elbow cannot move (--frame"), ("tip", "")])
def test_a_hand_on_the_axis_of_a_joint_is_told(run, frame, said):
    """The frame of a link is at its joint: a description without a tip maps the wrong point."""
    Path("two.urdf").write_text(TWO_LINKS, encoding="utf-8")
    words = run(
        f"workspace two.urdf --joint-damping 0.02 --stiffness 100 --points 8 --frame {frame}", None
    ).words
    assert f"hand at {frame}{said}" in words
    assert ("cannot move" in words) == (frame == "lower")


def gripper(fingers: int) -> str:
    """A URDF of four damped joints, and fingers without damping at the last."""
    joint = (
        '<joint name="{0}" type="{3}"><parent link="{1}"/><child link="{2}"/><origin xyz="0.1 0 0"/>'
        '<axis xyz="{4}"/><limit lower="-0.5" upper="0.7" effort="9" velocity="1"/>{5}</joint>'
    )
    names, axes = ("base", "pan", "lift", "elbow", "wrist"), ("0 0 1", "0 1 0", "0 1 0", "1 0 0")
    moves = zip(names, names[1:], axes, strict=False)
    parts = [
        joint.format(f"{to}_joint", of, to, "revolute", axis, '<dynamics damping="0.8"/>')
        for of, to, axis in moves
    ]
    each = ["left", "right"][:fingers]
    parts += [joint.format(f"{side}_joint", "wrist", side, "prismatic", "0 1 0", "") for side in each]
    links = "".join(f'<link name="{name}"/>' for name in (*names, *each))
    return f'<robot name="arm">{links}{"".join(parts)}</robot>'


@pytest.mark.parametrize("more", ["", " --postures 300"])
def test_a_finger_without_damping_is_named_and_what_is_typed_works(run, refused, more):
    """It is held, which locks it, or left out; the same numbers as with the hand where it is locked."""
    Path("arm.urdf").write_text(gripper(1), encoding="utf-8")
    line = f"workspace arm.urdf --stiffness 100{more}"
    message = refused(line)
    assert "arm.urdf gives left_joint no damping" in message
    typed = re.findall(r"--(?:hold|frame) [\w=.,]+", message)
    assert typed == ["--hold left_joint=0.1", "--frame wrist"]
    status = 3 if more else 0
    found = [run(f"{line} {option} --json", status).json for option in typed]
    assert [len(each["joint_damping_N_m_s_rad"]) for each in found] == [4, 4]
    assert found[0]["largest_stiffness_N_per_m"] < found[1]["largest_stiffness_N_per_m"]
    assert more or "left_joint locked at 100 mm" in run(f"{line} {typed[0]}").words
    assert "no damping is left in left_joint" in refused(f"{line} --joint-damping 1,1,1,1,0")
    assert "pan_joint, lift_joint" in refused(f"{line} --joint-damping 1,1,1,1")
    assert "arm, 4 joints" in run(f"{line} --frame wrist --joint-damping 1,1,1,1", status).words
    one = run(f"{line} --frame wrist --joint-damping '1 N*m*s/rad' --joint-friction 0.1", status).words
    assert "1 N·m·s/rad in each" in one
    assert "left_joint" not in one
    run(f"{line} --joint-damping '1,1,1,1 N*m*s/rad,20 N*s/m'", status)


@pytest.mark.parametrize("mimic", ["", '<mimic joint="left_joint"/>'])
def test_before_two_fingers_the_frame_is_named(run, refused, mimic):
    """Also where one finger follows the other."""
    text = gripper(2)
    Path("arm.urdf").write_text(f"{mimic}</joint>".join(text.rsplit("</joint>", 1)), encoding="utf-8")
    message = refused("workspace arm.urdf --stiffness 100")
    assert "such as --frame wrist, before" in message
    run(f"workspace arm.urdf --stiffness 100 {re.findall('--frame [a-z]+', message)[-1]}")
