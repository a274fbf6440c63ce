"""The null-space spring of a redundant arm: loops that take energy out, and how near its rest are none."""

from __future__ import annotations

import json
from pathlib import Path
from typing import Any

import numpy as np
import pytest
from described_arms import panda_like

import zwidth as zw
from zwidth.cli.main import main
from zwidth.model.arms.null_space import (
    Loop,
    NullSpaceSpring,
    Shape,
    gain,
    replay_both,
    shapes,
    task_jacobian,
)
from zwidth.passivity.certificate import read_document, verify_document

REST = (0.2, 1.0, 0.6)
FINGER = zw.arms.PlanarChain(
    links=(0.1, 0.08, 0.06),
    damping=(0.05, 0.05, 0.05),
    coulomb_friction=(0.01, 0.01, 0.01),
    joint_range=((-2, 2), (0, 2.6), (-2, 2.6)),
)
"""Three joints in the plane, a hand at a point: one motion of the joints leaves it where it is."""

ASKED: dict[str, Any] = {"rate": 1000, "stiffness": 0.5, "rest": REST}


def still(joints: np.ndarray, regularization: float = 0.0) -> np.ndarray:
    """P of the finger by its singular vectors."""
    _, sizes, turned = np.linalg.svd(FINGER.jacobian(joints))
    kept = sizes**2 / (sizes**2 + regularization**2)
    return np.eye(3) - turned[:2].T @ np.diag(kept) @ turned[:2]


@pytest.mark.parametrize("regularization", [0.0, 0.05])
def test_the_energy_of_a_loop_is_the_integral_of_the_torque(regularization: float) -> None:
    spring = NullSpaceSpring(stiffness=0.5, damping=0, rest=REST, regularization=regularization)
    centre, first, second = np.array([[0.5, 1.4, 0.2], [0.3, -0.2, 0.4], [0.1, 0.5, 0.2]])

    def at(turn: float) -> np.ndarray:
        return centre + np.cos(turn) * first + np.sin(turn) * second

    def power(turn: float) -> float:
        torque = 0.5 * still(at(turn), regularization) @ (at(turn) - REST)
        return float(torque @ (np.cos(turn) * second - np.sin(turn) * first))

    path = np.array([at(turn) for turn in 2 * np.pi / 20_000 * np.arange(20_000)])
    work = 2 * np.pi / 200 * sum(map(power, 2 * np.pi / 200 * np.arange(200)))
    motion = replay_both(FINGER, zw.Wall(1), spring, 1e-3, 0, path)
    assert abs(work) > 0.01
    assert motion.work == pytest.approx(work, rel=5e-3)  # the hold gives the rest
    assert motion.imposed_by == "links"


@pytest.mark.parametrize("regularization", [0.0, 0.05])
def test_a_loop_beats_friction_and_not_more_of_it(regularization: float) -> None:
    found = zw.null_space(FINGER, zw.Wall(200), regularization=regularization, **ASKED)
    assert found.outcome == "active"
    assert "slow loop" in found.claim
    assert "of a hand at the end alone nothing is said" in found.claim
    spring = NullSpaceSpring(stiffness=0.5, damping=0, rest=REST, regularization=regularization)
    again = replay_both(FINGER, zw.Wall(200), spring, 1e-3, 0, found.loop.joints())
    assert again.energy == pytest.approx(found.slow.energy)
    assert again.energy < 0 < again.loss
    rough = FINGER.replace(coulomb_friction=(0.5, 0.5, 0.5))
    assert zw.null_space(rough, zw.Wall(200), regularization=regularization, **ASKED).slow is None


@pytest.mark.parametrize("regularization", [0.0, 0.1])
def test_near_the_rest_friction_covers_it(regularization: float, tmp_path: Path) -> None:
    asked = {**ASKED, "regularization": regularization}
    found = zw.null_space(FINGER, zw.Wall(200), **asked)
    far = found.covered
    assert far > 0.03
    assert found.outcome == "active"
    assert found.certificate is None
    inside = zw.null_space(FINGER, zw.Wall(200), within=0.9 * far, **asked)
    assert inside.passive
    assert inside.margin is None
    inside.save(tmp_path / "proof.json")
    assert verify_document(read_document(tmp_path / "proof.json")).valid
    beyond = zw.null_space(FINGER, zw.Wall(200), within=1.1 * far, **asked)
    assert (beyond.outcome, beyond.certificate) == ("undecided", None)
    assert beyond.margin < 0
    ways = np.random.default_rng(1).normal(size=(200, 3))
    ways *= far / np.linalg.norm(ways, axis=1, keepdims=True)
    first = still(np.array(REST), regularization)
    lacks = [0.5 * (still(REST + way, regularization) - first) @ way for way in ways]
    assert 0.001 < np.abs(lacks).max() <= 0.01


def test_of_an_arm_with_encoders_it_is_without_their_steps() -> None:
    read = FINGER.replace(resolution=(1e-4,) * 3)
    found = zw.null_space(read, zw.Wall(200), within=0.02, **ASKED)
    assert found.outcome == "passive without encoder steps"
    assert "Encoder steps are not counted." in found.claim


def test_no_smaller_loop_gains() -> None:
    spring = NullSpaceSpring(stiffness=0.5, damping=0, rest=REST)
    best = shapes(FINGER, spring)[0]

    def begins(shape: Shape) -> float:
        """Friction over gain at a small size, by the curl near the rest."""
        given, lost = gain(FINGER, spring, shape, 1e-3)
        return 1e-3 * float(np.sqrt(lost / abs(given)))

    others = np.random.default_rng(0).normal(size=(100, 3, 3))
    for share in (0.1, 1):
        for other in others:
            parts = np.array(best) + share * other
            reach = Loop(*parts, 64).reach((0, 0, 0))
            assert begins(best) <= begins(Shape(*(parts / reach))) * 1.01


def test_the_picture_shows_what_is_known(tmp_path: Path) -> None:
    found = zw.null_space(FINGER, zw.Wall(200), **ASKED)
    loop, joules = found.plot(tmp_path / "a.png").axes
    assert (tmp_path / "a.png").stat().st_size > 1000
    words = {text.get_text() for text in joules.get_legend().get_texts()}
    assert f"proved up to {found.covered:.3g} rad" in words
    assert {"proved", "not known", "active"} <= {text.get_text() for text in joules.texts}
    assert "replayed" in loop.get_title(loc="left")
    inside = zw.null_space(FINGER, zw.Wall(200), within=0.02, **ASKED)
    assert "if larger" in inside.plot().axes[0].get_title(loc="left")
    damper = zw.null_space(FINGER, zw.Wall(20), rate=1000, stiffness=0, damping=0.01, rest=REST)
    assert len(damper.plot().axes) == 1


def test_without_coulomb_friction_nothing_is_covered() -> None:
    smooth = FINGER.replace(coulomb_friction=(), damping=(5.0, 5.0, 5.0))
    found = zw.null_space(smooth, zw.Wall(200), rate=100, stiffness=20, rest=REST)
    assert found.covered == 0
    assert found.outcome == "active"
    assert dict(found.rows())["friction covers"] == "nothing: a joint has no Coulomb friction that is known"


@pytest.mark.parametrize(("share", "active"), [(0.98, False), (1.02, True)])
def test_the_damper_is_paid_for_by_the_joints(share: float, active: bool) -> None:
    asked: dict[str, Any] = {"rate": 1000, "stiffness": 0.2, "rest": REST}
    limit = zw.null_space(FINGER, zw.Wall(50), **asked).largest_damping
    most = 0.05 - 0.0005 * 0.2  # damped alike, and P is as stiff in no direction as in the one it leaves
    assert limit <= most * (1 + 1e-12)
    found = zw.null_space(FINGER, zw.Wall(50), damping=share * limit, **asked)
    assert (found.fast is not None) is active
    frictionless = FINGER.replace(coulomb_friction=())
    damper = zw.null_space(frictionless, zw.Wall(50), rate=1000, stiffness=0, damping=0.04, rest=REST)
    assert damper.slow is None


def test_on_the_command_line(tmp_path, capsys, monkeypatch) -> None:
    monkeypatch.chdir(tmp_path)
    arm = str(panda_like(tmp_path / "panda.urdf"))
    ready = "j2=-0.785,j4=-2.356,j6=1.571,j7=0.785"
    asked = ["workspace", arm, "--pose", "--joint-friction", "0.2"]
    wall = ["--stiffness", "600", "--rotational-stiffness", "30"]
    null = ["--null-stiffness", "20", "--null-rest", ready]
    near = [*asked, *wall, *null, "--within", "1.2 deg"]
    assert main([*near, "-o", "proof.json", "--plot", "a.png"]) == 0
    assert "PASSIVE No motion of the hands" in " ".join(capsys.readouterr().out.split())
    assert (tmp_path / "a.png").exists()
    assert main(["verify", "proof.json"]) == 0
    assert "wherever they hold the arm" in " ".join(capsys.readouterr().out.split())
    proof = json.loads((tmp_path / "proof.json").read_text(encoding="utf-8"))
    proof["certificate"]["spring"]["distance_rad"] = "0.5"
    (tmp_path / "false.json").write_text(json.dumps(proof), encoding="utf-8")
    assert main(["verify", "false.json"]) == 1
    capsys.readouterr()
    assert main([*asked, *wall, *null, "-o", "found.json", "--json"]) == 1
    told = json.loads(capsys.readouterr().out)
    assert told["slow_loop"]["energy_J"] < 0
    assert told == json.loads((tmp_path / "found.json").read_text(encoding="utf-8"))
    (tmp_path / "c.yaml").write_text(
        "c: {ros__parameters: {stiffness: {translation: {x: 600, y: 600, z: 600}, rotation: {x: 30, y: 30, "
        "z: 30}, nullspace_stiffness: 20}, damping: {translation: {x: 0, y: 0, z: 0}, rotation: {x: 0, y: 0, "
        "z: 0}, nullspace_damping: 0}}}"
    )
    file = [*asked, "--wall", "c.yaml", "--null-stiffness", "wall", "--null-rest", ready]
    assert main([*file, "--within", "1.2 deg", "--json"]) == 0
    assert json.loads(capsys.readouterr().out)["certificate"]["spring"]["stiffness_N_m_per_rad"] == "20"
    for wrong, message in (
        ([*asked, *wall, "--within", "1 deg"], "--within is of a null-space spring"),
        ([*asked, *wall, *null, "--points", "9"], "--points is not asked with --null-stiffness"),
        ([*asked, *wall, *null, "-o", "a.nc"], "there is no map: save as .json"),
        ([*asked, *wall, "--null-stiffness", "wall"], "takes the gains of a .yaml file"),
        ([*asked, *wall, "--null-stiffness", "5", "--null-rest", "j9=1"], "there is no joint 'j9'"),
        ([*asked, *wall, "--null-stiffness", "5", "--null-rest", "j2=9"], "j2 can be from -1.7628"),
        (["workspace", "two-link", "--joint-damping", "1", *wall[:2], *null[:2]], "no motion of the joints"),
    ):
        assert main(wrong) == 2
        assert message in " ".join(capsys.readouterr().err.split())


def test_a_joint_that_is_held_does_not_move(tmp_path: Path) -> None:
    arm = panda_like(tmp_path / "panda.urdf")
    asked: dict[str, Any] = {"whole": True, "hold": {"j7": 0.3}}
    held = zw.arms.read_arm(arm, coulomb_friction=(0.2,) * 6 + (0,), damping=(1,) * 6 + (0.1,), **asked)
    found = zw.null_space(held, zw.Wall(300, 1), rate=1000, stiffness=20, damping=3)
    assert (found.fast.joints[:, 6] == 0.3).all()
    assert found.fast.joints[:, :6].std() > 0
    soft = zw.null_space(held, zw.Wall(300), rate=1000, stiffness=20, damping=0.5)
    assert 0.5 < soft.largest_damping < 1
    assert soft.covered > 0


def test_the_jacobian_of_the_task_knows_no_orientation_of_rest(tmp_path: Path) -> None:
    arm = zw.arms.read_arm(panda_like(tmp_path / "panda.urdf"), whole=True, pose=True)
    at = [0.1, -0.7, 0.2, -2.0, 0.3, 1.4, 0.5]
    turned = arm.resting([0.5, 0.3, 0.1, -1.0, 0.2, 0.9, 0.1])
    assert task_jacobian(turned, at) == pytest.approx(task_jacobian(arm, at), abs=1e-12)
