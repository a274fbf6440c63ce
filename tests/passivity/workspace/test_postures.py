"""All postures of an arm with seven joints: the least stiffness, where it is, and a motion beyond it."""

from __future__ import annotations

import json
from itertools import product
from pathlib import Path

import numpy as np
import pytest
from described_arms import panda_like

import zwidth as zw
from zwidth.cli.main import main
from zwidth.model.arms.encoders import covered_factors
from zwidth.show import plots

READY = (0, -np.pi / 4, 0, -3 * np.pi / 4, 0, np.pi / 2, np.pi / 4)


@pytest.fixture(scope="module")
def panda(tmp_path_factory: pytest.TempPathFactory) -> Path:
    return panda_like(tmp_path_factory.mktemp("arm") / "panda.urdf", damping=0.8)


def test_the_joints_are_placed_as_published(panda: Path) -> None:
    """At the maker's ready posture the flange is 0.307 m ahead and 0.590 m up."""
    arm = zw.arms.read_arm(panda, whole=True)
    assert arm.forward(READY) == pytest.approx([0.30689, 0, 0.59028], abs=1e-5)


def test_no_posture_of_others_is_worse(panda: Path) -> None:
    arm = zw.arms.read_arm(panda, whole=True)
    found = zw.stiffness_over_postures(arm, zw.Wall(500), rate=1000, postures=3000)
    low, high = np.array(arm.joint_range).T
    others = np.random.default_rng(5).uniform(low, high, (3000, 7))
    sizes = np.linalg.norm(arm.jacobian(others), 2, axis=(-2, -1))
    stiffest = 2 * 0.8 * 1000 / sizes**2  # damped alike: K T/2 |J|² ≤ b
    assert stiffest.min() >= found.largest_stiffness
    assert np.linalg.norm(arm.jacobian(found.worst), 2) ** 2 == pytest.approx(1600 / found.largest_stiffness)
    assert found.outcome == "undecided"
    assert "nothing is proved" in found.claim
    least = float(found.data["largest_stiffness"].min())
    assert least == pytest.approx(found.largest_stiffness)
    assert int(found.data["postures"].sum()) >= 3000


def test_beyond_it_a_motion_of_the_joints_takes_energy_out(panda: Path) -> None:
    arm = zw.arms.read_arm(panda, whole=True)
    limit = zw.stiffness_over_postures(arm, zw.Wall(500), rate=1000, postures=1000).largest_stiffness
    over = zw.stiffness_over_postures(arm, zw.Wall(1.01 * limit), rate=1000, postures=1000)
    under = zw.stiffness_over_postures(arm, zw.Wall(0.99 * limit), rate=1000, postures=1000)
    assert (over.outcome, under.outcome) == ("active", "undecided")
    assert over.motion.imposed_by == "links"
    assert over.motion.energy < 0
    assert "hands that hold the links" in over.claim
    assert plots.postures_figure(over).axes[0].get_ylabel() == "height [m]"


def test_the_damper_is_told_what_the_joints_pay_for(panda: Path) -> None:
    arm = zw.arms.read_arm(panda, whole=True)
    found = zw.stiffness_over_postures(arm, zw.Wall(300, 5), rate=1000, postures=300)
    share = found.damping_factor
    assert 0 < share < 1
    for times, holds in ((0.98, True), (1.02, False)):
        again = zw.stiffness_over_postures(arm, zw.Wall(300, 5 * times * share), rate=1000, postures=300)
        assert (again.stiffness_factor >= 1) is holds
    assert found.stiffness_factor == 0
    assert dict(found.rows())["stiffness"].startswith("none")
    said = dict(found.rows())["virtual damping"]
    slowest = float(said.split("slower than ")[1].split(" Hz")[0])
    worst = float(np.linalg.norm(arm.jacobian(found.worst), 2)) ** 2
    assert 0.8 / worst > 0.15 - 5 * np.cos(2 * np.pi * 0.99 * slowest / 1000)
    assert zw.stiffness_over_postures(arm, zw.Wall(300), rate=1000, postures=100).damping_factor is None


def test_friction_covers_the_encoder_steps_of_a_wall(panda: Path) -> None:
    asked = {"coulomb_friction": (0.3, 0.3, 0.3, 0.2, 0.1, 0.1, 0.05), "resolution": (2e-4,)}
    arm = zw.arms.read_arm(panda, whole=True, **asked)
    found = zw.stiffness_over_postures(arm, zw.Wall(500), rate=1000, postures=300)
    signs = np.array(list(product((-1, 1), repeat=7))) * 1e-4
    low, high = np.array(arm.joint_range).T
    least = []
    for place in np.random.default_rng(3).uniform(low, high, (100, 7)):
        jacobian = arm.jacobian(place)
        torques = np.abs(signs @ jacobian.T @ jacobian).max(axis=0)  # of 1 N/m
        least.append((np.array(arm.coulomb_friction)[:-1] / torques[:-1]).min())  # the last moves nothing
        mine = covered_factors(arm, zw.Wall(500), 1e-3, jacobian)
        assert mine * 500 == pytest.approx(least[-1])
        damped = covered_factors(arm, zw.Wall(500, 0.5), 1e-3, jacobian)
        assert damped == pytest.approx(max(mine - 2, 0))  # 2 B/T is another 1000 N/m
    assert found.encoder_factor * 500 < np.median(least)
    assert "a stiffer wall may buzz" in dict(found.rows())["encoder steps"]
    assert found.data["encoder_factor"].min() == pytest.approx(found.encoder_factor)
    bare = zw.arms.read_arm(panda, whole=True, resolution=(2e-4,))
    alone = zw.stiffness_over_postures(bare, zw.Wall(500), rate=1000, postures=100)
    assert (found.numbers()["encoder_factor"], alone.encoder_factor) == (found.encoder_factor, 0)
    assert "no Coulomb friction is known" in dict(alone.rows())["encoder steps"]


def test_in_pose_factors_are_told(panda: Path) -> None:
    """Metres and radians have no common stiffness."""
    arm = zw.arms.read_arm(panda, whole=True, pose=True)
    found = zw.stiffness_over_postures(arm, zw.arms.MatrixWall.in_pose(200, 10), rate=1000, postures=500)
    assert found.largest_stiffness is None
    assert found.stiffness_factor > 1
    assert "times everywhere" in dict(found.rows())["stiffness"]


def test_on_the_command_line(panda: Path, tmp_path: Path, capsys: pytest.CaptureFixture[str]) -> None:
    asked = ["workspace", str(panda), "--stiffness", "500", "--postures", "500"]
    assert main([*asked, "-o", str(tmp_path / "map.nc"), "--plot", str(tmp_path / "map.png")]) == 3
    assert "at every posture tried" in capsys.readouterr().out
    assert (tmp_path / "map.nc").exists()
    assert (tmp_path / "map.png").exists()
    assert main([*asked, "--json"]) == 3
    assert json.loads(capsys.readouterr().out)["postures"] == 500
    assert main([*asked, "--points", "20"]) == 2
    assert "leave it out with --postures" in capsys.readouterr().err


def test_what_cannot_be_asked(panda: Path) -> None:
    arm = zw.arms.read_arm(panda, whole=True)
    with pytest.raises(zw.InputError, match="7 would move"):
        zw.workspace(arm, zw.Wall(500), rate=1000)
    with pytest.raises(zw.InputError, match="from a description"):
        zw.stiffness_over_postures(zw.arms.built_in("hapkit", damping=1), zw.Wall(1), rate=1000)
    with pytest.raises(zw.InputError, match="from 100 to"):
        zw.stiffness_over_postures(arm, zw.Wall(500), rate=1000, postures=3)
