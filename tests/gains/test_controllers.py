"""Parameter files of ros2_control: what their numbers are, and which joints are passive by closed forms."""

from __future__ import annotations

import json
from math import sqrt
from pathlib import Path

import numpy as np
import pytest
from described_arms import panda_like

import zwidth as zw
from zwidth.cli.main import main
from zwidth.data.gains import check_controllers, read_controllers

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
COMPLIANCE = "c: {ros__parameters: {stiffness: {trans_x: 500, trans_y: 500, trans_z: 500}}}"


FORCE = "c: {ros__parameters: {solver: {error_scale: 0.5}, pd_gains: {trans_x: {p: 0.05}, rot_z: {p: 1.5}}}}"


def written(folder: Path, text: str, name: str = "controllers.yaml") -> Path:
    """A file."""
    path = folder / name
    path.write_text(text, encoding="utf-8")
    return path


def device(damping: float) -> zw.Device:
    """A joint."""
    return zw.Device(damping=damping, rate=1, motion="rotary")


def test_keys_that_are_given_twice_are_one_table(tmp_path: Path) -> None:
    """franka_ros2 writes /** again for each controller, and ROS joins them."""
    found = read_controllers(written(tmp_path, FRANKA))
    assert [(float(j.stiffness), float(j.damping)) for j in found.joints] == [(600, 30), (250, 5)]
    assert found.rate == 1000
    with pytest.raises(zw.InputError, match="line 4: p is given twice"):
        read_controllers(written(tmp_path, "a:\n  gains:\n    j: {p: 1,\n      p: 2}\n"))


@pytest.mark.parametrize(("share", "outcome"), [(1.001, "passive"), (0.999, "active")])
def test_each_joint_is_decided_by_its_closed_form(tmp_path: Path, share: float, outcome: str) -> None:
    """Of a spring p one period late b = 3 p T/2; a little less is active."""
    text = FRANKA.replace("[30.0, 5.0]", "[0.0, 0.0]")
    found = check_controllers(read_controllers(written(tmp_path, text)), device(3 * 600 * 0.0005 * share))
    assert found.joints[0].verdict.outcome == outcome
    assert found.joints[0].needed == pytest.approx(0.9)
    assert found.joints[1].verdict.passive
    assert found.outcome == outcome


def test_an_integrator_gives_energy_out(tmp_path: Path) -> None:
    """H(z) of all three gains, against a slow hand; without it the joint is passive."""
    controllers = read_controllers(written(tmp_path, TRAJECTORY))
    found = check_controllers(controllers, device(5), delay=0)
    assert [joint.verdict.outcome for joint in found.joints] == ["passive", "active"]
    law = found.joints[1].verdict.environment.pulse_transfer_function(1)
    z = np.exp(0.7j)
    numbers = [np.polyval([float(c) for c in side], z) for side in (law.numerator, law.denominator)]
    assert numbers[0] / numbers[1] == pytest.approx(120 + 4 / 500 / (z - 1) + 0.2 * 500 * (z - 1) / z)
    assert found.claim == "Energy comes out of elbow."


def test_an_impedance_is_a_wall_at_the_end(tmp_path: Path) -> None:
    """D = 2 ζ √K, as the controller has it, with what the wall leaves out."""
    (one,) = read_controllers(written(tmp_path, CARTESIAN)).cartesian
    assert one.stiffness == (200, 300, 400, 20, 30, 40)
    assert one.damping[:3] == pytest.approx((2 * sqrt(200), sqrt(300), 0))
    assert one.damping[3:] == pytest.approx([2 * sqrt(k) for k in (20, 30, 40)])
    assert np.diag(one.wall(0).stiffness).tolist() == [200, 300, 400]
    assert one.wall(3).turns == 3
    assert (one.nullspace, one.nullspace_damping) == (10, pytest.approx(2 * sqrt(10)))
    assert any("null-space spring of 10 N·m/rad" in note for note in one.notes(3))
    assert not any("null-space" in note for note in one.notes(3, with_null_space=True))
    assert any("difference of two readings" in note for note in one.notes(0))


@pytest.mark.parametrize(
    ("text", "message"),
    [
        (COMPLIANCE, "stiffness: of an admittance"),
        (FORCE, "pd_gains: of an admittance"),
        (FORCE.replace("pd_", "pid_"), "pid_gains: of an admittance"),
        ("a: {ros__parameters: {x: 1}}", "no gains of a controller"),
        (TRAJECTORY.replace("[effort]", "[velocity]"), "where the command is an effort"),
        (CARTESIAN.replace(", z: 400.0", ""), "z is missing"),
    ],
)
def test_what_is_no_spring_and_damper_is_refused(tmp_path: Path, text: str, message: str) -> None:
    """With what it is, and what would be read."""
    with pytest.raises(zw.InputError, match=message):
        read_controllers(written(tmp_path, text))


def test_on_the_command_line(tmp_path: Path, capsys: pytest.CaptureFixture[str]) -> None:
    """Joints with a plant; an impedance goes on to an arm, at the rate of its file, and says what is "
    "left out."""
    plant = written(tmp_path, "[arm]\ndamping = [1.2, 0.8]\n", "plant.toml")
    joints, end = written(tmp_path, TRAJECTORY), written(tmp_path, CARTESIAN, "end.yaml")
    assert main(["gains", str(joints)]) == 2
    assert "give --plant" in capsys.readouterr().err
    assert main(["gains", str(joints), "--plant", str(plant), "--json"]) == 1
    assert json.loads(capsys.readouterr().out)["joints"][1]["outcome"] == "active"
    assert main(["gains", str(end)]) == 3
    assert "zwidth workspace ARM.urdf --pose --wall" in capsys.readouterr().out
    arm = panda_like(tmp_path / "panda.urdf", damping=30)
    asked = ["workspace", str(arm), "--wall", str(end), "--postures", "200", "--json"]
    assert main(asked) == 2
    assert 'give --rate "500 Hz"' in capsys.readouterr().err
    assert main([*asked, "--rate", "500 Hz"]) == 3
    told = json.loads(capsys.readouterr().out)
    assert any("null-space" in note for note in told["wall_leaves_out"])
    assert told["wall"]["stiffness_N_per_m"][2][2] == 400
