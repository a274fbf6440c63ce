"""What gain files say, in the units of the joint: each law by the code that it is from."""

from __future__ import annotations

import json
from fractions import Fraction
from math import tanh
from pathlib import Path
from typing import Any

import gain_files
import pytest
from gain_files import DAMIAO, GRIPPER, PIPER, SERVOS, YAM, openarm, written
from hypothesis import example, given, settings
from hypothesis import strategies as st
from strategies import texts

import zwidth as zw
from zwidth.data.gains.plant import family, plants
from zwidth.data.gains.read import FAMILIES

CALIBRATION = '{"a": {"id": 1, "drive_mode": 0, "homing_offset": 7, "range_min": 900, "range_max": 3000}}'


def law(side: Any) -> tuple[Fraction, Fraction, Fraction]:
    """Spring, damping against the other arm, damping of its own."""
    return side.stiffness, side.damping, side.local_damping


def test_openarm_has_relative_damping_on_both_sides(tmp_path):
    """kd is of the speed against the other arm, none of its own; the decimals that are written."""
    follower = openarm("Follower", Kd=[2.5] * 8)
    files = written(tmp_path, "leader.yaml", openarm()), written(tmp_path, "follower.yaml", follower)
    gains = zw.read_gains(*files)
    assert (gains.family, gains.is_pair, gains.drives) == ("openarm", True, True)
    assert [joint.name for joint in gains.joints] == ["J1", "J2", "J3", "J4", "J5", "J6", "J7", "gripper"]
    for n, joint in enumerate(gains.joints):
        assert law(joint.leader) == (gain_files.STIFFNESS[n], Fraction(str(gain_files.DAMPING[n])), 0)
        assert law(joint.follower) == (gain_files.STIFFNESS[n], Fraction(5, 2), 0)
        assert joint.leader.source == f"leader.yaml, LeaderArmParam, Kp[{n}]"


def test_compensation_is_the_one_of_the_code(tmp_path):
    """Fc tanh(0.1 k v) + Fv v, at some speeds."""
    (joint, *_), at = zw.read_gains(written(tmp_path, "a.yaml", openarm())).joints, (-2.0, 0.03, 0.7)
    found = joint.leader.compensation
    coulomb, viscous, speed = (float(number) for number in (found.coulomb, found.viscous, found.speed))
    for v in at:
        expected = gain_files.COULOMB[0] * tanh(0.1 * gain_files.STEEPNESS[0] * v) + gain_files.VISCOUS[0] * v
        assert coulomb * tanh(v / speed) + viscous * v == pytest.approx(expected, rel=1e-12)
    assert float(joint.leader.offset) == 0.088


def test_one_side_alone_is_taken_for_both_and_that_is_said(tmp_path):
    alone = zw.read_gains(written(tmp_path, "a.yaml", openarm("Follower")))
    both = zw.read_gains(written(tmp_path, "b.yaml", openarm() + openarm("Follower")))
    assert all(joint.leader == joint.follower for joint in alone.joints)
    assert any("no file gives the leader's gains" in note for note in alone.notes)
    assert not any("no file gives" in note for note in both.notes)


def test_a_fork_may_leave_out_compensation(tmp_path):
    """No Fc, k and Fv: none; k = 0 leaves tanh at 0."""
    without = openarm(Fc=None, k=None, Fv=None, Fo=None)
    plain = zw.read_gains(written(tmp_path, "a.yaml", without))
    flat = zw.read_gains(written(tmp_path, "b.yaml", openarm(k=[0.0] * 8, Fv=[0.0] * 8)))
    assert not any(joint.leader.compensation for joint in (*plain.joints, *flat.joints))


def test_a_law_of_its_own_for_the_leader(tmp_path):
    """`Bilateral`: local damping, on the host, 0.3 of the compensation, none of the follower; notes say one
    thing of Kd. A force that is fed back is refused, and so is the leader's law alone."""
    text = "Bilateral:\n  Kp: [60, 60, 60, 60, 8, 10, 8, 5]\n  Kd: [3, 3, 3, 3, 0.2, 0.2, 0.2, 0.2]\n"
    leader, follower = openarm() + text, openarm("Follower", Kp=[200] * 8)
    gains = zw.read_gains(written(tmp_path, "a.yaml", leader + "  Kf: [0, 0, 0, 0, 0, 0, 0, 0]\n" + follower))
    joint = gains.joints[0]
    assert (law(joint.leader), law(joint.follower)) == ((60, 0, 3), (200, 3, 0))
    whole = zw.read_gains(written(tmp_path, "b.yaml", openarm())).joints[0].leader.compensation
    assert joint.leader.compensation == whole.scaled(Fraction(3, 10))
    assert not joint.follower.compensation
    assert not gains.drives
    assert [note for note in gains.notes if "on both sides" in note or "beyond the end" in note] == []
    alone = zw.read_gains(written(tmp_path, "c.yaml", leader))
    assert law(alone.joints[0].follower) == (240, 3, 0)
    assert any("follower's gains: taken as those of LeaderArmParam" in note for note in alone.notes)
    for name, refused, said in (
        ("d.yaml", leader + "  Kf: [0.1, 0, 0, 0, 0, 0, 0, 0]\n", "measured torque"),
        ("e.yaml", text, "the file with FollowerArmParam"),
    ):
        with pytest.raises(zw.InputError, match=said):
            zw.read_gains(written(tmp_path, name, refused))


def test_i2rt_has_local_damping_on_the_follower_alone(tmp_path):
    """And a leader whose spring is bilateral_kp times as stiff; a gripper beside it is left out."""
    yam, gripper = written(tmp_path, "yam.yml", YAM), written(tmp_path, "linear.yml", GRIPPER)
    gains = zw.read_gains(yam, gripper)
    joint = gains.joints[3]
    assert (law(joint.leader), law(joint.follower)) == ((2, 0, 0), (10, 0, Fraction(3, 2)))
    assert joint.motor == "DM4310"
    assert any("gripper is left out" in note for note in gains.notes)
    assert not joint.follower.compensation
    soft = zw.read_gains(yam, bilateral_kp="0.1").joints[0]
    assert (soft.leader.stiffness, soft.follower.stiffness) == (8, 80)


def test_a_leader_that_feels_nothing_makes_no_pair(tmp_path):
    yam = zw.read_gains(written(tmp_path, "yam.yml", YAM), bilateral_kp=0)
    assert not yam.is_pair
    with pytest.raises(zw.InputError, match="feels nothing"):
        yam.pairs()
    lerobot = zw.read_gains(written(tmp_path, "a.yaml", DAMIAO))
    with pytest.raises(zw.InputError, match="--both"):
        lerobot.pairs()


def test_compensation_of_i2rt_where_it_is_enabled(tmp_path):
    """breakaway tanh(v/eps) of the versions that have it."""
    extra = "friction_comp:\n  enable: {}\n  breakaway: [0.1, 0.2, 0.3, 0, 0, 0]\n  eps: 0.01\n"
    enabled = zw.read_gains(written(tmp_path, "a.yml", YAM + extra.format("true"))).joints[2]
    off = zw.read_gains(written(tmp_path, "b.yml", YAM + extra.format("false"))).joints[2]
    for side in (enabled.leader, enabled.follower):
        assert side.compensation == zw.FrictionCompensation(coulomb="0.3", speed="0.01")
    assert not off.leader.compensation


@pytest.mark.parametrize(
    ("volts", "torque", "supply", "kt", "resistance", "e"),
    [("7.4 V", 17.8, 7.4, 1.2116, 2.676, 1), ("12 V", 44.2, 12, 1.444, 2.030, 0.975)],
)
def test_a_servo_register_is_a_stiffness_by_its_voltage(tmp_path, volts, torque, supply, kt, resistance, e):
    """P = 32: as published, and by duty, voltage and current of a small error."""
    gains = zw.read_gains(written(tmp_path, "a.json", SERVOS), supply_voltage=volts)
    stiffness = float(gains.joints[0].follower.stiffness)
    assert stiffness == pytest.approx(torque, rel=5e-3)
    error = 0.01
    duty = 0.166 * 32 * error * e
    assert stiffness * error == pytest.approx(kt * duty * supply / resistance, rel=1e-12)
    assert gains.joints[0].leader is None


def test_servos_ask_for_their_voltage(tmp_path):
    """And for one they are made for; default coefficients are said."""
    path = written(tmp_path, "a.json", SERVOS)
    with pytest.raises(zw.InputError, match="--supply-voltage"):
        zw.read_gains(path)
    with pytest.raises(zw.InputError, match="≤ 15 V"):
        zw.read_gains(path, supply_voltage=24)
    left, right = {"type": "so101_follower"}, {"position_p_coefficient": 8}
    arms = json.dumps({"robot": {"left_arm_config": left, "right_arm_config": right}})
    gains = zw.read_gains(written(tmp_path, "b.json", arms), supply_voltage="7.4", both=True)
    first, second = (joint.leader.stiffness for joint in gains.joints)
    assert first == 2 * second
    assert any("default of 16" in note for note in gains.notes)


def test_lerobot_with_damiao_drives_has_local_damping(tmp_path):
    """v_des is 0 there: the same kd as OpenArm's is another law."""
    gains = zw.read_gains(written(tmp_path, "a.yaml", DAMIAO), both=True)
    joint = gains.joints[1]
    assert gains.family == "lerobot-damiao"
    assert law(joint.leader) == law(joint.follower) == (240, 0, 5)


def test_a_piper_has_a_row_for_either_end_of_its_unknown_factor(tmp_path):
    joints = zw.read_gains(written(tmp_path, "a.toml", PIPER), both=True).joints
    assert [joint.name for joint in joints] == [
        "J1 ×1", "J1 ×4", "J2 ×1", "J2 ×4", "J3 ×1", "J3 ×4", "J4", "J5", "J6",
    ]  # fmt: skip
    assert law(joints[1].follower) == (40, 0, Fraction(16, 5))


def test_yaml_json_and_toml_are_the_same(tmp_path):
    content = {"LeaderArmParam": {"Kp": [0.1, 30], "Kd": [0.2, 1e-3]}}
    toml = "[LeaderArmParam]\nKp = [0.1, 30]\nKd = [0.2, 1e-3]\n"
    yaml = "LeaderArmParam: {Kp: [0.1, 30], Kd: [0.2, 1e-3]}\n"
    files = {"a.json": json.dumps(content), "a.toml": toml, "a.yaml": yaml}
    found = [zw.read_gains(written(tmp_path, name, text)) for name, text in files.items()]
    numbers = [[law(joint.leader) for joint in gains.joints] for gains in found]
    assert numbers == [[(Fraction(1, 10), Fraction(1, 5), 0), (30, Fraction(1, 1000), 0)]] * 3


@pytest.mark.parametrize(
    ("text", "said"),
    [
        ("a: 1\n", "no gains of a known arm"),
        ("kp: [80]\nkd: [2]\n", "take zwidth pair: --stiffness and --virtual-damping"),
        ("- 1\n", "expected keys"),
        ("a: [1\n", "not YAML: line"),
        ("LeaderArmParam: 3\n", "expected keys below it"),
        (openarm(Kd=[1, 2]), "2 numbers where the arm has 8 joints"),
        (openarm(Kp=["stiff"] * 8), "Kp\\[0\\]"),
        (openarm(Fc=[-0.1] * 8), "must be ≥ 0"),
        ("LeaderArmParam: {Kp: [1, 2]}\n", "Kd is missing"),
        ("LeaderArmParam: {Kp: 240, Kd: 3}\n", "a list with a number for each joint"),
        ("LeaderArmParam: {Kp: [!!python/object/apply:os.getcwd []], Kd: [1]}\n", "Kp\\[0\\]"),
        ("a: " + "[" * 5000, "too deeply|not YAML"),
        (GRIPPER, "a gripper alone"),
        (CALIBRATION, "a LeRobot calibration .* position_p_coefficient"),
        (openarm(Jn=[0.5] * 8), "disturbance observers"),  # whose Kp is no stiffness
        ("Node: {ros__parameters: {Jn: [0.5], Kp: [900]}}\n", "disturbance observers"),
    ],
)
def test_a_file_that_cannot_be_used_is_refused_in_a_line(tmp_path, text, said):
    with pytest.raises(zw.InputError, match=said) as caught:
        zw.read_gains(written(tmp_path, "a.yaml", text))
    assert "\n" not in str(caught.value)


@pytest.mark.parametrize(
    ("others", "options", "said"),
    [
        ((), {"bilateral_kp": 0.1}, "leave it out"),
        ((), {"supply_voltage": 12}, "leave it out"),
        ((), {"both": True}, "leave it out"),
        (("b.yml",), {}, "one kind"),
        (("a.yaml",), {}, "given twice"),
        (("none.yaml",), {}, "there is no file"),
        ((), {"family": "openarms"}, "did you mean"),
    ],
)
def test_options_and_files_of_other_arms_are_refused(tmp_path, others, options, said):
    """They would be ignored."""
    leader = written(tmp_path, "a.yaml", openarm())
    written(tmp_path, "b.yml", YAM)
    with pytest.raises(zw.InputError, match=said):
        zw.read_gains(leader, *(tmp_path / name for name in others), **options)


@pytest.mark.parametrize("family", FAMILIES)
@pytest.mark.parametrize(
    ("text", "said"), [(CALIBRATION, "LeRobot calibration"), ("a: {b: 1}", "no gains of")]
)
def test_a_family_that_is_given_is_looked_for(tmp_path, family, text, said):
    with pytest.raises(zw.InputError, match=said):
        zw.read_gains(written(tmp_path, "a.yaml", text), family=family)


def test_every_published_number_has_its_source():
    for name in FAMILIES:
        known = family(name)
        for value in (known.rate, known.link_delay, known.drive_rate, known.position_step):
            assert value.value > 0
            assert len(value.source) > 10
        assert not known.plant or name in plants()[known.plant].families
    assert all(len(plant.source) > 10 for plant in plants().values())


KEYS = [
    "LeaderArmParam", "Bilateral", "Kp", "Kd", "Fc", "k", "Fv", "kp", "kd", "motor_list", "piper", "type",
    "homing_offset", "friction_comp", "position_p_coefficient", "position_kp", "position_kd",
]  # fmt: skip


MESSES = st.recursive(
    st.none() | st.booleans() | st.floats() | st.integers() | texts(),
    lambda inner: st.lists(inner, max_size=4) | st.dictionaries(st.sampled_from(KEYS), inner, max_size=5),
)


@settings(max_examples=60, deadline=None)
@given(texts() | MESSES.map(json.dumps), st.sampled_from([None, *FAMILIES]))
@example(CALIBRATION, "lerobot-feetech")
@example(CALIBRATION, "lerobot-damiao")
@example("{}", "piper")
def test_whatever_is_in_a_file_there_is_an_answer_or_a_message(tmp_path_factory, text, family):
    """Of a family that is given, too."""
    folder: Path = tmp_path_factory.mktemp("gains")
    for name in ("a.yaml", "a.json", "a.toml"):
        try:
            found = zw.read_gains(
                written(folder, name, text),
                family=family,
                supply_voltage=12 if family == "lerobot-feetech" else None,
            )
        except zw.InputError:
            continue
        assert found.joints
