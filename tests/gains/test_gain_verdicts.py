"""Which joints are passive with the gains of a file: by hand-made pairs, closed forms, M(θ); and the page."""

from __future__ import annotations

import json
import re
from dataclasses import replace
from fractions import Fraction
from pathlib import Path
from typing import Any

import numpy as np
import pytest
from gain_files import DAMIAO, PIPER, SERVOS, YAM, openarm, written

import zwidth as zw
from zwidth.data.gains import ArmGains
from zwidth.data.gains.joint import CoupledJoint
from zwidth.passivity.pairs.limits import is_passive, with_share


def arm(damping: object = "0.5", **more: object) -> zw.Device:
    return zw.Device(damping=damping, rate=1, motion="rotary", **more)


def gains_of(folder, stiffness: str = "30", damping: str = "0", **lists: object) -> ArmGains:
    """OpenArm-like gains of two joints, without compensation."""
    none = dict.fromkeys(("Fc", "k", "Fv", "Fo"))
    numbers = {"Kp": [stiffness, 20], "Kd": [damping, damping], **none, **lists}
    text = openarm(**numbers).replace("'", "")
    return zw.read_gains(written(folder, "a.yaml", text))


def test_the_pair_is_the_one_made_by_hand(tmp_path):
    """OpenArm's J1: relative damping, compensation, and its drive."""
    gains = zw.read_gains(written(tmp_path, "a.yaml", openarm() + openarm("Follower")))
    given = arm("0.5", coulomb_friction="0.4", resolution="0.0001")
    pair = gains.pairs(plant=given, rate="500 Hz", delay=("2 ms", "4 ms"), drive_rate="10 kHz")["J1"]
    device = given.replace(rate=500, delay=0)
    law = zw.FrictionCompensation(coulomb="0.306", viscous="0.063", speed=1 / Fraction("2.8417"))
    coupling = {"stiffness": 240, "damping": 3, "delay": ("0.002", "0.004"), "drive_rate": 10_000}
    by_hand = zw.Pair(device, device, compensation=law, **coupling)
    assert pair.sides == by_hand.sides
    assert (pair.sample_period, pair.own_readings) == (by_hand.sample_period, by_hand.own_readings)
    left_out = gains.pairs(plant=given, rate=500, delay=0, drive_rate=0, compensated=False)["J1"]
    assert left_out.drive_rate is None
    assert not any(left_out.compensations)


def test_i2rt_counts_the_followers_hand_by_the_ratio_of_the_springs(tmp_path):
    """K_l = β kp, and D on the follower alone."""
    pair = zw.read_gains(written(tmp_path, "a.yml", YAM)).pairs()["J4"]
    assert pair.power_ratio == Fraction(1, 5)
    assert [side.local_damping for side in pair.sides] == [0, Fraction(3, 2)]
    assert [side.virtual_damping for side in pair.sides] == [0, 0]


def test_outcomes_are_those_of_the_pairs(tmp_path):
    gains = zw.read_gains(written(tmp_path, "a.yaml", openarm()))
    found = zw.check_gains(gains)
    by_hand = {name: zw.check(pair).outcome for name, pair in gains.pairs().items()}
    assert {joint.name: joint.outcome for joint in found.joints} == by_hand
    assert found.outcome == "active"
    plain = zw.check_gains(gains, ideal_drive=True, compensated=False)
    assert {joint.outcome for joint in plain.joints} == {"passive"}
    assert plain.outcome == "passive"


@pytest.mark.parametrize(("ages", "b"), [((1, 1), "0.5"), ((2, 4), "0.21"), ((0, 0), "0.09")])
def test_the_stiffest_spring_is_the_closed_form(tmp_path, ages, b):
    """b = K (T + (n_l + n_f) T/2) of equal arms with springs alone: within a digit below, never above."""
    gains = gains_of(tmp_path)
    delay = tuple(Fraction(n, 1000) for n in ages)
    joint = zw.check_gains(gains, plant=arm(b), delay=delay, drive_rate=0).joints[0]
    limit = Fraction(b) / (Fraction(1, 1000) * (1 + Fraction(sum(ages), 2)))
    stiffest = joint.stiffest.gains[0].stiffness
    assert limit * Fraction(98, 100) <= stiffest <= limit
    assert zw.check(joint.stiffest.pair()).outcome == "passive"


@pytest.mark.parametrize(("age", "b"), [(2, "0.5"), (5, "0.21"), (1, "0.07")])
def test_the_best_gains_are_where_both_ends_of_the_spectrum_bind(tmp_path, age, b):
    """K (n + 1) T = b + 2B and K T = b − 2B: K = 2b/((n + 2) T), of equal arms and ages, no drives."""
    gains = gains_of(tmp_path, damping="0.01")
    joint = zw.check_gains(gains, plant=arm(b), delay=Fraction(age, 1000), drive_rate=0).joints[0]
    top = 2 * Fraction(b) * 1000 / (age + 2)
    best = joint.best.gains[0]
    assert top * Fraction(97, 100) <= best.stiffness <= top
    assert float(best.damping) == pytest.approx((float(b) - float(top) / 1000) / 2, rel=0.05)
    assert zw.check(joint.best.pair()).outcome == "passive"


@pytest.mark.parametrize("ideal", [False, True])
def test_every_gain_that_is_told_was_proved_and_no_less_damping_would_do(tmp_path, ideal):
    """With drives and compensation: b needed holds, 2 % less of it does not."""
    gains = zw.read_gains(written(tmp_path, "a.yaml", openarm()))
    setting = {"plant": arm("0.6", coulomb_friction="0.7"), "delay": "2 ms", "ideal_drive": ideal}
    for joint in zw.check_gains(gains, **setting).joints[::3]:
        need = Fraction(str(joint.required_damping))
        assert zw.check(joint.model.with_damping(need, need).pair()).outcome == "passive"
        less = need * Fraction(98, 100)
        assert not is_passive(joint.model.with_damping(less, less).pair())
        for told in (joint.stiffest, joint.best):
            if told is not None:
                assert zw.check(told.pair()).outcome == "passive"
                assert told.gains[0].stiffness <= 500


def worst(joint: CoupledJoint) -> float:
    """The least eigenvalue of M(θ) of equal arms where kd in the drive is a damper, by the law on a grid."""
    mine, b = joint.gains[0], float(joint.damping[0])
    n, inside = round(float(joint.delay[0].fraction * 1000)), float(joint.drive_rate)
    k, relative = float(mine.stiffness), float(mine.damping)
    z = np.exp(1j * np.linspace(1e-3, np.pi, 4001))
    received = -(z ** -(n + 1)) * (k * 1e-3 / (1 - 1 / z) + relative)
    own = b + relative - k / (2 * inside)
    return float(np.min(own - np.abs(received.real)))


@pytest.mark.parametrize("b", ["0.002", "0.02", "0.05", "0.2"])
@pytest.mark.parametrize(
    ("stiffness", "damping"), [("240", "3"), ("60", "0.5"), ("24", "0.2"), ("24", "0.02")]
)
def test_an_ideal_drive_is_a_damper(tmp_path, stiffness, damping, b):
    """The sign of M(θ) by the definition of the law, in floats."""
    gains = gains_of(tmp_path, stiffness, damping)
    joint = zw.check_gains(gains, plant=arm(b), delay="3 ms", ideal_drive=True).joints[0]
    least = worst(joint.model)
    assert abs(least) > 1e-4, "too near to be told in floats"
    assert (joint.outcome == "passive") == (least > 0)
    as_option = zw.check_gains(gains, plant=arm(b), delay="3 ms").joints[0]
    assert as_option.with_ideal_drive == joint.outcome
    assert joint.with_ideal_drive is None
    assert "b holds it" in joint.to_dict()["assumptions"][-1]


def test_what_was_taken_for_granted_is_said(tmp_path):
    gains = zw.read_gains(written(tmp_path, "a.yaml", openarm()))
    plain = " ".join(zw.check_gains(gains).notes)
    for part in ("FREQUENCY", "not measured", "Damiao drive is not published", "measured on no arm of yours",
                 "steps of 381.5 µrad", "to and fro at 10 kHz", "tanh(0.1 k v)"):  # fmt: skip
        assert part in plain
    setting = {"rate": 1000, "delay": "1 ms", "drive_rate": "5 kHz", "compensated": False}
    plant = arm(resolution=0.0001, coulomb_friction=1)
    given = " ".join(zw.check_gains(gains, plant=plant, **setting).notes)
    for part in ("FREQUENCY", "not measured", "not published", "no arm of yours", "steps of 0.0003815"):
        assert part not in given
    assert "compensation of friction is left out" in given


def test_gains_beyond_what_a_drive_takes_are_named(tmp_path):
    """A kd over 5 is cut off by the drive without a word."""
    text = DAMIAO.replace("0.3, 0.3, 0.3, 0.3", "12, 0.3, 0.3, 0.3")
    gains = zw.read_gains(written(tmp_path, "a.yaml", text), both=True)
    (note,) = [note for note in zw.check_gains(gains).notes if "is more than 5" in note]
    assert note.startswith("kd of J5 ")


def test_plants_are_read_for_each_arm_and_joint(tmp_path):
    gains = gains_of(tmp_path)
    text = (
        '[leader]\ndamping = [0.5, "600 mN*m*s/rad"]\ncoulomb_friction = 0.1\n[follower]\ndamping = "0.7"\n'
    )
    plant = written(tmp_path, "arm.toml", text)
    first, second = gains.pairs(plant=plant).values()
    assert [side.damping for side in first.sides] == [Fraction(1, 2), Fraction(7, 10)]
    assert second.sides[0].damping == Fraction(3, 5)
    assert [side.coulomb_friction for side in second.sides] == [Fraction(1, 10), 0]


@pytest.mark.parametrize(
    ("text", "said"),
    [
        ("[arm]\ncoulomb_friction = 0.1\n", "damping is missing"),
        ("[arm]\ndamping = [0.1]\n", "1 numbers where the arm has 2 joints"),
        ("[arm]\ndamping = 0.1\nfriction = 1\n", "an arm has no"),
        ("[leader]\ndamping = 0.1\n", "or \\[leader\\] and \\[follower\\]"),
        ("[arms]\ndamping = 0.1\n", "did you mean"),
        ('[arm]\ndamping = "0.1 N"\n', "damping"),
        ("[arm]\ndamping = -1\n", "≥ 0"),
    ],
)
def test_a_plant_that_cannot_be_used_is_refused(tmp_path, text, said):
    with pytest.raises(zw.InputError, match=said):
        gains_of(tmp_path).pairs(plant=written(tmp_path, "arm.toml", text))


def test_published_plants_are_of_their_own_arms(tmp_path):
    piper = zw.read_gains(written(tmp_path, "a.toml", PIPER), both=True)
    with pytest.raises(zw.InputError, match="no source gives"):
        piper.pairs()
    assert len(piper.pairs(plant=arm())) == 9
    with pytest.raises(zw.InputError, match="is of openarm"):
        piper.pairs(plant="openarm-identified")
    big = YAM.replace('[0x01, "DM4340"]', '[0x01, "DM6248"]')
    with pytest.raises(zw.InputError, match="no numbers for J1 with a DM6248"):
        zw.read_gains(written(tmp_path, "b.yml", big)).pairs()
    with pytest.raises(zw.InputError, match="no published plant"):
        piper.pairs(plant="pipers")


def test_a_servo_brakes_by_what_its_motor_induces(tmp_path):
    """b = k_t²/R + viscous friction of the servo of that voltage."""
    gains = zw.read_gains(written(tmp_path, "a.json", SERVOS), supply_voltage=12, both=True)
    (pair,) = gains.pairs().values()
    assert float(pair.sides[0].damping) == pytest.approx(1.444**2 / 2.030 + 0.0305, rel=1e-12)


def test_shown_and_saved(tmp_path):
    found = zw.check_gains(gains_of(tmp_path, damping="0.05"), plant=arm(), delay="2 ms")
    told = json.loads(found.to_json())
    assert told["format"] == "zwidth gains 1"
    assert told["outcome"] == found.outcome == "passive"
    assert [joint["name"] for joint in told["joints"]] == ["J1", "J2"]
    best = told["joints"][0]["best"]["leader"]["stiffness_N_m_per_rad"]
    assert best == float(found.joints[0].best.gains[0].stiffness)
    assert f"{best:.4g}" in repr(found)
    assert "<table" in found._repr_html_()
    assert "certificate" in found.saved()["joints"][0]


def test_a_rate_that_drives_are_not_assumed_for(tmp_path):
    """The assumed rate of a drive becomes a whole number of times any rate; at its own rate there is none."""
    gains = gains_of(tmp_path)
    odd = gains.pairs(plant=arm(), rate="300 Hz", delay=0)["J1"]
    assert odd.own_readings == 66
    assert gains.pairs(plant=arm(), rate="20 kHz", delay=0)["J1"].drive_rate is None
    with pytest.raises(zw.InputError, match="rate must be > 0"):
        gains.pairs(plant=arm(), rate=0)


def test_gains_scale_together(tmp_path):
    """Of unlike sides the best gains keep their proportion, to the digits told."""
    gains = zw.read_gains(written(tmp_path, "a.yml", YAM))
    best = zw.check_gains(gains, ideal_drive=True).joints[0].best
    leader, follower = best.gains
    assert float(leader.stiffness / follower.stiffness) == pytest.approx(0.2, rel=1e-2)
    assert (leader.damping, leader.local_damping, follower.damping) == (0, 0, 0)
    assert 0 < follower.local_damping <= 5
    assert zw.check(replace(best).pair()).outcome == "passive"


PAGE = (Path(__file__).parents[2] / "docs" / "gain-files.md").read_text(encoding="utf-8")


@pytest.fixture(scope="module")
def names(tmp_path_factory: pytest.TempPathFactory) -> dict[str, Any]:
    found: dict[str, Any] = {}
    (example,) = re.findall(r"```python\n(.*?)```", PAGE, re.DOTALL)
    with pytest.MonkeyPatch.context() as patch:
        patch.chdir(tmp_path_factory.mktemp("page"))
        exec(example, found)
    return found


def test_the_table_is_what_comes_out(names):
    without = zw.check_gains(names["gains"], ideal_drive=True, compensated=False)
    lines = re.findall(r"^\| ((?:J\d|gripper) \|.*) \|$", PAGE, re.MULTILINE)
    rows = [line.split(" | ") for line in lines]
    assert len(rows) == 8
    for row, joint, bare in zip(rows, names["verdict"].joints, without.joints, strict=True):
        share = "all" if joint.compensation == 1 else f"{100 * joint.compensation:.0f} %"
        gains = joint.gains.leader
        numbers = [f"{float(x):g}" for x in (gains.stiffness, gains.damping, joint.model.damping[0])]
        assert row == [joint.name, *numbers, joint.outcome, share, f"{joint.required_damping:g}"]
        assert bare.outcome == "passive"


def test_the_gains_for_drives_that_take_differences_are_what_comes_out(names):
    found = zw.check_gains(names["gains"])
    assert {joint.outcome for joint in found.joints} == {"active"}
    best = {j.name: j.best.gains[0] for j in found.joints if j.best is not None}
    told = {name: f"{float(g.stiffness):g} with {float(g.damping):g}" for name, g in best.items()}
    assert set(told) == {"J1", "J2", "J6", "J7", "gripper"}
    assert told["J7"] == told["gripper"]
    assert f"J1 {told['J1']}, J2 {told['J2']}, J6 {told['J6']}, J7 and the gripper {told['J7']}." in PAGE


def test_with_the_other_plant_the_answers_are_others(names):
    found = zw.check_gains(names["gains"], plant="damiao-mujoco")
    passive = [joint.name for joint in found.joints if joint.outcome == "passive"]
    assert passive == ["J5", "J6", "J7", "gripper"]
    undecided = [joint.name for joint in found.joints if joint.with_ideal_drive == "undecided"]
    assert undecided == ["J3", "J4"]


def test_its_plant_is_read(names, tmp_path):
    text, transmission = re.findall(r"```toml\n(.*?)```", PAGE, re.DOTALL)
    assert transmission.startswith("[arm.transmission]")
    pairs = names["gains"].pairs(plant=written(tmp_path, "my-arm.toml", text))
    assert [float(pair.sides[0].damping) for pair in pairs.values()][:3] == [0.5, 0.4, 0.6]


def test_just_above_the_largest_share_a_motion_gains(names):
    """A ten-thousandth on either side of it, where the page says that both are found."""
    pairs = names["gains"].pairs(ideal_drive=True)
    for joint, more in (dict.fromkeys(("J3", "J5", "J6", "J7"), "0.0001") | {"J4": "0.1"}).items():
        share = Fraction(repr(zw.check(pairs[joint]).largest_compensation))
        assert zw.check(with_share(pairs[joint], share * Fraction("0.9999"))).outcome == "passive"
        beyond = zw.check(with_share(pairs[joint], share * (1 + Fraction(more))))
        assert beyond.outcome == "active"
        assert beyond.witness.verify()
    for joint in ("J1", "J2"):
        share = Fraction(repr(zw.check(pairs[joint]).largest_compensation))
        assert zw.check(with_share(pairs[joint], share * Fraction("1.1"))).outcome == "undecided"
