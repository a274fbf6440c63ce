"""The page on gain files says what comes out."""

from __future__ import annotations

import re
from fractions import Fraction
from pathlib import Path
from typing import Any

import pytest
from gain_files import written

import zwidth as zw
from zwidth.passivity.pairs.limits import with_share

PAGE = (Path(__file__).parents[2] / "docs" / "gain-files.md").read_text(encoding="utf-8")


@pytest.fixture(scope="module")
def names(tmp_path_factory: pytest.TempPathFactory) -> dict[str, Any]:
    """What its example makes."""
    found: dict[str, Any] = {}
    (example,) = re.findall(r"```python\n(.*?)```", PAGE, re.DOTALL)
    with pytest.MonkeyPatch.context() as patch:
        patch.chdir(tmp_path_factory.mktemp("page"))
        exec(example, found)
    return found


def test_the_table_is_what_comes_out(names):
    without = zw.check_gains(names["gains"], ideal_drive=True, compensated=False)
    rows = [
        [cell.strip() for cell in line.strip("|").split("|")]
        for line in PAGE.splitlines()
        if re.match(r"\| (J\d|gripper) \|", line)
    ]
    assert len(rows) == 8
    for row, joint, bare in zip(rows, names["verdict"].joints, without.joints, strict=True):
        share = "all" if joint.compensation == 1 else f"{100 * joint.compensation:.0f} %"
        gains = joint.gains.leader
        assert row == [
            joint.name,
            f"{float(gains.stiffness):g}",
            f"{float(gains.damping):g}",
            f"{float(joint.model.damping[0]):g}",
            joint.outcome,
            bare.outcome,
            share,
            f"{joint.required_damping:g}",
        ]


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
    (text,) = re.findall(r"```toml\n(.*?)```", PAGE, re.DOTALL)
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
