"""Parameter files of ros2_control: what their numbers are, which joints are passive, and gains that are."""

from __future__ import annotations

import json
import re
from math import sqrt
from pathlib import Path

import numpy as np
import pytest
import yaml
from described_arms import panda_like
from gain_files import written

import zwidth as zw
from zwidth.cli.main import main
from zwidth.data.gains import (
    Controllers,
    borne_impedance,
    check_controllers,
    passive_gains,
    read_controllers,
)
from zwidth.data.gains.controllers import is_of_controllers
from zwidth.data.gains.file import read_table
from zwidth.data.gains.passive import PassiveGains
from zwidth.model.arms import read_arm

FRANKA = """
/**:
  controller_manager:
    ros__parameters:
      update_rate: 1000
/**:
  joint_impedance_example_controller:
    ros__parameters:
      k_gains: [600.0, 250.0]
      d_gains: [30.0, 5.0]
"""
TRAJECTORY = """
controller_manager:
  ros__parameters:
    update_rate: 500
arm_controller:
  ros__parameters:
    joints: [shoulder, elbow]
    command_interfaces: [effort]
    gains:
      shoulder: {p: 200.0, i: 0.0, d: 0.5}
      elbow: {p: 120.0, i: 4.0, d: 0.2, ff_velocity_scale: 1.0}
"""
CARTESIAN = """
cartesian_impedance_controller:
  ros__parameters:
    update_frequency: 500.0
    stiffness:
      translation: {x: 200.0, y: 300.0, z: 400.0}
      rotation: {x: 20.0, y: 30.0, z: 40.0}
      nullspace_stiffness: 10.0
    damping:
      translation: {x: 1.0, y: 0.5, z: 0.0}
"""
ARM = """
controller_manager: {ros__parameters: {update_rate: 1000}}
arm:
  ros__parameters:
    gains:
      good: {p: 123.456, d: 0.125}
      "no": {p: 100000, i: 2.0, d: 0.0}
/**: {impedance: {ros__parameters: {k_gains: [500.0], d_gains: [30.0]}}}
"""
MOVED = """
/**/controller_manager:
  ros__parameters:
    arm: {type: joint_trajectory_controller/JointTrajectoryController}
    own: {type: maker/JointPositionCommandController}
    torque: {type: maker/TorqueCommandController}
    state: {type: joint_state_broadcaster/JointStateBroadcaster}
/**/arm: {ros__parameters: {joints: [a], command_interfaces: [COMMANDS]}}
/**/own: {ros__parameters: {robot_name: x}}
/**/torque: {ros__parameters: {robot_name: x, interface_name: effort}}
"""
SERVO = "a: {{ros__parameters: {{{}, reference_and_state_interfaces: [{}], gains: {{j: {{p: 9}}}}}}}}"
ONE_TYPE = "a: {{type: {}, joints: [x]}}"
GAINS_K = "a: {ros__parameters: {k_gains: [5], d_gains: [1]}}"
COMPLIANCE = "c: {ros__parameters: {stiffness: {trans_x: 500, trans_y: 500, trans_z: 500}}}"
PID = """
robot:
  states: {type: joint_state_controller/JointStateController, publish_rate: 50}
  shoulder: {type: effort_controllers/JointPositionController, joint: j1, pid: {p: 90.0, d: 0.4}}
  wheel: {type: effort_controllers/JointVelocityController, joint: j2, pid: {p: 2.0}}
  rail: {type: position_controllers/JointTrajectoryController, gains: {j3: {p: 7}}}
"""
RATIOS = "joints: {j1: {kp: 80, damping_ratio: 0.25}, j2: {kp: 900, damping_ratio: 1}}"
TASK = """
end:
  ros__parameters:
    task: {k_pos_x: 400, k_pos_y: 300, k_pos_z: 200, d_pos_y: 7,
           k_rot_x: 30, k_rot_y: 20, k_rot_z: 10, d_rot_z: -1}
    nullspace: {stiffness: 2.0}
"""
FORCE = "c: {ros__parameters: {solver: {error_scale: 0.5}, pd_gains: {trans_x: {p: 0.05}, rot_z: {p: 1.5}}}}"


NAME = "controllers.yaml"


def device(damping: float = 1) -> zw.Device:
    return zw.Device(damping=damping, rate=1, motion="rotary")


def test_keys_that_are_given_twice_are_one_table(tmp_path):
    """franka_ros2 writes /** again for each controller, and ROS joins them."""
    found = read_controllers(written(tmp_path, NAME, FRANKA))
    assert [(float(j.stiffness), float(j.damping)) for j in found.joints] == [(600, 30), (250, 5)]
    assert found.rate == 1000
    with pytest.raises(zw.InputError, match="line 4: p is given twice"):
        read_controllers(written(tmp_path, NAME, "a:\n  gains:\n    j: {p: 1,\n      p: 2}\n"))


@pytest.mark.parametrize(("share", "outcome"), [(1.001, "passive"), (0.999, "active")])
def test_each_joint_is_decided_by_its_closed_form(tmp_path, share, outcome):
    """Of a spring p one period late b = 3 p T/2; a little less is active."""
    text = FRANKA.replace("[30.0, 5.0]", "[0.0, 0.0]")
    controllers = read_controllers(written(tmp_path, NAME, text))
    found = check_controllers(controllers, device(3 * 600 * 0.0005 * share))
    assert found.joints[0].verdict.outcome == outcome
    assert found.joints[0].needed == pytest.approx(0.9)
    assert found.joints[1].verdict.passive
    assert found.outcome == outcome
    if outcome == "passive":  # at half the rate the delay of one period is twice as long, and it is active
        assert found.claim.endswith("can take energy out of this loop.")


GIVING_WAY = "[arm]\ndamping = 1\n[arm.transmission]\nhandle_damping = 0.5\n{}"


@pytest.mark.parametrize("more", ["", "stiffness = [9000, 50]", "damping = [0, 0.5]"])
def test_a_gear_that_gives_way_is_as_any_cable(tmp_path, more):
    given = read_controllers(written(tmp_path, "controllers.yaml", TRAJECTORY.replace("i: 4.0", "i: 0.0")))
    plant = written(tmp_path, "arm.toml", GIVING_WAY.format(more))
    found = check_controllers(given, str(plant))
    scopes = {joint.verdict.scope.transmission for joint in found.joints}
    assert (found.outcome, scopes) == ("passive", {"any"})
    gains = passive_gains(given, str(plant), stiffest=True)
    felt = [0.8, 0.8 * 1.25 if "damping" in more else 0.8]
    assert [float(j.verdict.device.exact("damping")) for j in gains.joints] == pytest.approx(felt, rel=1e-12)
    assert any("motors' side" in note for note in found.notes)


def test_with_the_inertia_of_the_motors_a_gear_is_decided_as_given(tmp_path):
    """Refuted then, too; without a gear that gives way no number of the plant is an inertia."""
    given = read_controllers(written(tmp_path, "controllers.yaml", TRAJECTORY))
    heavy = GIVING_WAY.format("stiffness = 9000").replace("[arm]", '[arm]\ninertia = "0.1 kg*m^2"')
    for text, outcome in ((GIVING_WAY.format("stiffness = 9000"), "undecided"), (heavy, "active")):
        found = check_controllers(given, str(written(tmp_path, "arm.toml", text)))
        assert {joint.verdict.scope.transmission for joint in found.joints} == {"any", "as given"}
        assert found.outcome == outcome
    with pytest.raises(zw.InputError, match='an arm has no "inertia"'):
        check_controllers(given, str(written(tmp_path, "arm.toml", "[arm]\ndamping = 1\ninertia = 1")))


def test_a_gear_that_gives_way_is_written_as_a_table(tmp_path):
    given = read_controllers(written(tmp_path, "controllers.yaml", TRAJECTORY))
    for more in ("stiffness = [1]", "stiffness = [1, 2, 3]", 'encoder = "link"', "k = 1"):
        plant = written(tmp_path, "arm.toml", GIVING_WAY.format(more))
        with pytest.raises(zw.InputError, match="transmission"):
            check_controllers(given, str(plant))


def test_an_integrator_gives_energy_out(tmp_path):
    """H(z) of all three gains, against a slow hand; without it the joint is passive."""
    controllers = read_controllers(written(tmp_path, NAME, TRAJECTORY))
    found = check_controllers(controllers, device(5), delay=0)
    assert [joint.verdict.outcome for joint in found.joints] == ["passive", "active"]
    law = found.joints[1].verdict.environment.pulse_transfer_function(1)
    z = np.exp(0.7j)
    numbers = [np.polyval([float(c) for c in side], z) for side in (law.numerator, law.denominator)]
    assert numbers[0] / numbers[1] == pytest.approx(120 + 4 / 500 / (z - 1) + 0.2 * 500 * (z - 1) / z)
    assert found.claim.startswith("Of 2 joints, each by itself: 1 passive, 1 active. elbow: A ")
    assert found.claim.endswith(
        "Gains that are proved are written by -o passive.yaml, in Python by passive_gains."
    )


def test_an_impedance_is_a_wall_at_the_end(tmp_path):
    """D = 2 ζ √K, as the controller has it, with what the wall leaves out."""
    (one,) = read_controllers(written(tmp_path, NAME, CARTESIAN)).cartesian
    assert one.stiffness == (200, 300, 400, 20, 30, 40)
    assert one.damping[:3] == pytest.approx((2 * sqrt(200), sqrt(300), 0))
    assert one.damping[3:] == pytest.approx([2 * sqrt(k) for k in (20, 30, 40)])
    assert np.diag(one.wall(0).stiffness).tolist() == [200, 300, 400]
    assert one.wall(3).turns == 3
    assert (one.nullspace, one.nullspace_damping) == (10, pytest.approx(2 * sqrt(10)))
    assert any("null-space spring of 10 N·m/rad" in note for note in one.notes(3))
    assert not any("null-space" in note for note in one.notes(3, with_null_space=True))
    assert any("difference of two readings" in note for note in one.notes(0))


def laws(found: Controllers) -> list[tuple[str, float, float]]:
    return [(law.name, float(law.stiffness), float(law.damping)) for law in found.joints]


def test_what_a_file_has_beside_is_told(tmp_path):
    """Of several controllers, and of ROS 1, whose gains act on what their type says."""
    found = read_controllers(written(tmp_path, NAME, PID))
    assert laws(found) == [("j1", 90, 0.4)]
    left = " ".join(note for note in found.notes if note.startswith("left out"))
    for part in (
        "robot/states (joint_state",
        'robot, wheel, pid: gains act on "effort',
        'robot/rail (position_controllers/JointTrajectoryController): it commands "position_controllers/',
    ):
        assert part in left
    servo = SERVO.format("command_interface: effort", "position, velocity")
    assert laws(read_controllers(written(tmp_path, NAME, servo))) == [("j", 9, 0)]
    moved = read_controllers(written(tmp_path, NAME, GAINS_K + MOVED.replace("COMMANDS", "velocity")))
    assert len(moved.joints) == 1
    assert any('left out: /**/arm: it commands "velocity"' in note for note in moved.notes)
    both = read_controllers(written(tmp_path, NAME, TRAJECTORY + CARTESIAN + COMPLIANCE))
    assert (len(both.joints), len(both.cartesian)) == (2, 1)
    assert sum("left out" in note for note in both.notes) == 2
    again = passive_gains(found, device(), rate=1000)
    assert "ros__parameters" not in again.to_yaml()
    own = yaml.safe_load(again.to_yaml())["robot"]["shoulder"]["pid"]
    assert own == {"p": 90, "i": 0, "d": 0.4}


def test_dampers_of_ratios_and_of_crisp(tmp_path):
    """ζ √k and at most what the drive takes; D of CRISP as it stands, and 2 √K where none does."""
    ratios = read_controllers(written(tmp_path, NAME, RATIOS))
    assert laws(ratios) == [("j1", 80, 0.25 * sqrt(80)), ("j2", 500, 5)]
    with pytest.raises(zw.InputError, match="damping_ratio tie"):
        passive_gains(ratios, device(), rate=1000)
    (one,) = read_controllers(written(tmp_path, NAME, TASK)).cartesian
    assert one.stiffness == (400, 300, 200, 30, 20, 10)
    assert one.damping == pytest.approx((40, 7, *(2 * sqrt(k) for k in (200, 30, 20, 10))))
    assert one.nullspace == 2
    with pytest.raises(zw.InputError, match="typed as k_pos_x"):
        borne_impedance(one, read_arm(panda_like(tmp_path / "panda.urdf"), pose=True, whole=True), rate=1000)


@pytest.mark.parametrize(
    ("text", "message"),
    [
        ("a: {type: x/Y}", "no gains of a controller"),
        ("a: {ros__parameters: {Jn: [1], Kp: [900]}}", "disturbance observers"),
        ("gazebo_ros_control: {pid_gains: {j: {p: 1}}}", "Gazebo simulates"),
        ("a: {ros__parameters: {admittance: {mass_x: 1}, task: {k_pos_x: 1}}}", "of an admittance"),
        (TASK.replace("task", "use_operational_space: true\n    task"), "multiplied by the arm's mass"),
        (TASK.replace("k_rot_y", "k_rot"), "k_rot_y is missing"),
        (TASK.replace("k_pos_y: 300", "k_pos_y: 0"), "a damper without a spring"),
        ("joints: {a: {damping_ratio: 1}}", "kp: give a number"),
        (COMPLIANCE, "stiffness: of an admittance"),
        (COMPLIANCE.replace("{stiff", "{command_interface: position, stiff"), "stiffness: of an admittance"),
        (FORCE, "pd_gains: of an admittance"),
        (FORCE.replace("pd_", "pid_"), "pid_gains: of an admittance"),
        ("a: {ros__parameters: {x: 1}}", "no gains of a controller"),
        (TRAJECTORY.replace("[effort]", "[velocity]"), "commanded by arm_controller: a hand there"),
        (
            MOVED.replace("COMMANDS", "position"),
            "by /../arm, /../own: a hand there feels the drive's own loop",
        ),
        (MOVED.replace("COMMANDS", "effort"), "speeds are commanded by /../own: "),
        (SERVO.format("command_interfaces: [position, velocity]", "position"), "are commanded by a: "),
        (SERVO.format("command_interface: position", "position"), "are commanded by a: "),
        (SERVO.format("command_interface: effort", "velocity, acceleration"), 'on "effort by velocity, '),
        (ONE_TYPE.format("velocity_controllers/JointGroupVelocityController"), r"are commanded by a \("),
        (ONE_TYPE.format("pos_vel_controllers/JointTrajectoryController"), r"are commanded by a \("),
        (CARTESIAN.replace(", z: 400.0", ""), "z is missing"),
    ],
)
def test_what_is_no_spring_and_damper_is_refused(tmp_path, text, message):
    path = written(tmp_path, NAME, text)
    assert is_of_controllers(read_table(path))
    with pytest.raises(zw.InputError, match=message):
        read_controllers(path)


def test_checks_on_the_command_line(tmp_path, capsys):
    plant = written(tmp_path, "plant.toml", "[arm]\ndamping = [1.2, 0.8]\n")
    joints, end = written(tmp_path, NAME, TRAJECTORY), written(tmp_path, "end.yaml", CARTESIAN)
    assert main(["gains", str(joints)]) == 2
    assert "give --plant" in capsys.readouterr().err
    assert main(["gains", str(joints), "--plant", str(plant), "--json"]) == 1
    assert json.loads(capsys.readouterr().out)["joints"][1]["outcome"] == "active"
    assert main(["gains", str(end)]) == 3
    printed = " ".join(capsys.readouterr().out.replace("\\\n", "").split())  # a long line goes on in the next
    assert "zwidth workspace ARM.urdf --pose --wall" in printed
    arm = panda_like(tmp_path / "panda.urdf", damping=30)
    asked = ["workspace", str(arm), "--wall", str(end), "--postures", "200", "--json"]
    assert main(asked) == 2
    assert 'give --rate "500 Hz"' in capsys.readouterr().err
    assert main([*asked, "--rate", "500 Hz"]) == 3
    told = json.loads(capsys.readouterr().out)
    assert any("null-space" in note for note in told["wall_leaves_out"])
    assert told["wall"]["stiffness_N_per_m"][2][2] == 400


def found(folder: Path, **asked: object) -> PassiveGains:
    controllers = read_controllers(written(folder, "arm.yaml", ARM))
    return passive_gains(controllers, device(), **asked)  # type: ignore[arg-type]


def test_what_is_proved_stays_and_what_is_not_is_the_nearest(tmp_path):
    """A spring one period late needs 3 p T/2; one that is kept has as much of its d as 0.8 b pays for."""
    good, spring, damped = found(tmp_path).joints
    assert (float(good.law.stiffness), float(good.law.damping)) == (123.456, 0.125)
    assert float(spring.law.stiffness) == 533.3
    assert (spring.law.integral, spring.law.damping) == (0, 0)
    assert damped.law.stiffness == 500
    assert 0 < damped.law.damping < 1
    device, more = damped.verdict.device, damped.law.damping * 1001 / 1000
    assert float(device.damping) == 0.8
    held = zw.PulseTransferFunction([500 + more * 1000, -more * 1000], [1, 0])
    assert zw.check(device, held).outcome == "active"
    assert all(joint.verdict.passive for joint in (good, spring, damped))


def test_the_stiffest_needs_its_damper(tmp_path):
    """Some d lets the spring be stiffer than 2 b/3 T; 2 % more is active; half the share, half of both."""
    whole, half = found(tmp_path, stiffest=True, share=1).joints[0], found(tmp_path, stiffest=True, share=0.5)
    p, d = float(whole.law.stiffness), float(whole.law.damping)
    assert p > 1.1 / 0.0015
    stiffer = zw.PulseTransferFunction([1.02 * p + 1000 * d, -1000 * d], [1, 0])
    assert zw.check(whole.verdict.device, stiffer).outcome == "active"
    assert float(half.joints[0].law.stiffness) == pytest.approx(p / 2, rel=1e-3)


def test_the_file_has_the_types_that_ros_asks_for_and_is_read_again(tmp_path):
    """Doubles with a point, a whole rate, names that YAML would take for a truth value; units in comments."""
    gains = found(tmp_path)
    gains.save(tmp_path / "passive.yaml")
    text = (tmp_path / "passive.yaml").read_text(encoding="utf-8")
    tree = yaml.safe_load(text)
    assert tree["controller_manager"] == {"ros__parameters": {"update_rate": 1000}}
    own = tree["arm"]["ros__parameters"]["gains"]
    assert list(own) == ["good", "no"]
    assert {type(value) for row in own.values() for value in row.values()} == {float}
    assert "p: 533.3  # N*m/rad; your file: 100000" in text
    assert "no 0.8" in text
    again = read_controllers(tmp_path / "passive.yaml")
    laws = [(law.name, law.stiffness, law.integral, law.damping) for law in again.joints]
    assert laws == [(j.law.name, j.law.stiffness, 0, j.law.damping) for j in gains.joints]
    assert again.rate == 1000


def test_the_page_shows_what_comes_out(tmp_path):
    page = (Path(__file__).parents[2] / "docs" / "gain-files.md").read_text(encoding="utf-8")
    (asked,) = re.findall(r"```yaml\n(.*?)```", page, re.DOTALL)
    controllers = read_controllers(written(tmp_path, NAME, asked))
    text = passive_gains(controllers, device()).to_yaml()
    (beside,) = re.findall(r"`(i: .*your file.*?)`", page)
    assert f"{beside}\n" in text


def test_writing_on_the_command_line(tmp_path, capsys):
    arm, plant = written(tmp_path, "arm.yaml", ARM), written(tmp_path, "plant.toml", "[arm]\ndamping = 1\n")
    out, proofs = tmp_path / "passive.yaml", tmp_path / "proofs.json"
    asked = ["gains", str(arm), "--plant", str(plant)]
    assert main([*asked, "-o", str(out)]) == 1
    assert "written, each proved with 80 % of b" in capsys.readouterr().out
    assert main(["gains", str(out), "--plant", str(plant), "-o", str(proofs)]) == 0
    assert main(["verify", str(proofs)]) == 0
    assert capsys.readouterr().out.count("VALID") == 1 + 3
    assert main([*asked, "-o", str(out)]) == 2
    assert "exists" in capsys.readouterr().err
    assert main([*asked, "-o", str(arm), "--force"]) == 2
    assert "choose another name" in capsys.readouterr().err
    assert main([*asked, "--share", "0.5"]) == 2
    assert "add -o" in capsys.readouterr().err
    assert arm.read_text(encoding="utf-8") == ARM


@pytest.mark.parametrize(
    ("joint", "share", "message"),
    [
        ({"damping": 1}, 0, "0 < share"),
        ({"damping": 0}, 1, "no gains of good are proved: 0 N"),
        ({"damping": 1, "resolution": 1e-4}, 1, "give coulomb_friction"),
    ],
)
def test_what_cannot_be_is_refused(tmp_path, joint, share, message):
    controllers = read_controllers(written(tmp_path, "arm.yaml", ARM))
    with pytest.raises(zw.InputError, match=message):
        passive_gains(controllers, zw.Device(**joint, rate=1, motion="rotary"), share=share)


END = """
end:
  ros__parameters:
    stiffness:
      translation: {x: 600.0, y: 500.0, z: 400.0}
      nullspace_stiffness: 20
"""


def test_an_impedance_that_postures_bear(tmp_path, capsys):
    """K stays, ζ goes down to what 0.8 of the damping pays for: all of it pays for 1.25 times as much."""
    arm, end = panda_like(tmp_path / "panda.urdf"), written(tmp_path, "end.yaml", END)
    out = tmp_path / "borne.yaml"
    asked = ["workspace", str(arm), "--rate", "1 kHz", "--postures", "100"]
    assert main([*asked, "--wall", str(end), "-o", str(out)]) == 1
    assert "ζ = 0.0" in capsys.readouterr().out
    own = yaml.safe_load(out.read_text(encoding="utf-8"))["end"]["ros__parameters"]
    assert own["stiffness"] == {"translation": {"x": 600.0, "y": 500.0, "z": 400.0}}
    (zeta,) = set(own["damping"]["translation"].values())
    assert 0.005 < zeta < 0.02
    assert "between them nothing is proved" in " ".join(out.read_text(encoding="utf-8").split())
    assert main([*asked, "--wall", str(out), "--json"]) == 3
    told = json.loads(capsys.readouterr().out)
    assert 1.25 < told["damping_factor"] < 1.5
    for more, part in (
        (["--wall", str(end), "-o", str(end), "--force"], "choose another name"),
        (["--stiffness", "9", "-o", str(tmp_path / "a.yaml")], "whose names it takes"),
        (["--stiffness", "9", "--share", "1"], "add -o passive.yaml"),
    ):
        assert main([*asked, *more]) == 2
        assert part in capsys.readouterr().err
