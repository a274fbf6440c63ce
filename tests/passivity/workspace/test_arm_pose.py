"""Walls in pose: both sides of their limits, the motion that refutes, and what the map says of two units."""

from __future__ import annotations

from pathlib import Path
from typing import Any

import numpy as np
import numpy.typing as npt
import pytest
from arm_documents import described, least_left
from described_arms import random_arm

import zwidth as zw
from zwidth.model.arms import Arm, PlanarChain, built_in, read_arm, wall_need
from zwidth.model.arms.wall import loss_in_pose
from zwidth.passivity.workspace import Workspace

Array = npt.NDArray[np.float64]


def _arm(folder: Path, joints: int, moving: int = 2, **options: Any) -> Arm:
    """In pose; all but the first joints are held somewhere."""
    path = random_arm(folder / "arm.urdf", 10 + joints, joints)
    hold = {f"j{i}": 0.03 * i for i in range(moving, joints)}
    return read_arm(path, pose=True, hold=hold, **{"rest": {}, **options})


def _space(arm: Arm, wall: zw.arms.MatrixWall, points: int = 40, **options: Any) -> Workspace:
    return zw.workspace(arm, wall, rate=1000, points=points, **options)


def _times(wall: zw.arms.MatrixWall, factor: float) -> zw.arms.MatrixWall:
    return zw.arms.MatrixWall(factor * np.array(wall.stiffness), wall.damping, turns=wall.turns)


def _coupled(seed: int, damped: bool = False) -> zw.arms.MatrixWall:
    """Six coordinates, all coupled."""
    rng = np.random.default_rng(seed)
    units = np.diag([20.0] * 3 + [2.0] * 3)
    root, virtual = units @ rng.normal(size=(6, 6)), 0.01 * units @ rng.normal(size=(6, 2))
    return zw.arms.MatrixWall(root @ root.T, damped * virtual @ virtual.T, turns=3)


WALLS = {
    "as stiff every way": zw.arms.MatrixWall.in_pose(500, 5),
    "rotation alone": zw.arms.MatrixWall.in_pose(0, 5),
    "coupled": _coupled(1),
    "coupled and damped": _coupled(2, True),
}


@pytest.mark.parametrize("kind", WALLS)
def test_both_sides_of_the_limit_of_six_joints(kind: str, tmp_path: Path) -> None:
    arm, wall = _arm(tmp_path, 6, moving=1), WALLS[kind]
    limit = _space(arm, wall).stiffness_factor
    over = _space(arm, _times(wall, 1.001 * limit))
    assert over.outcome == "active"
    assert over.motion is not None
    under = _space(arm, _times(wall, 0.999 * limit))
    assert under.outcome != "active"
    assert (under.data["margin_in_joints"] >= 0).all()
    assert _space(arm, _times(wall, 0.8 * limit)).outcome == "passive"


@pytest.mark.parametrize("kind", ["as stiff every way", "rotation alone"])
def test_both_sides_wherever_the_wall_rests(kind: str, tmp_path: Path) -> None:
    """Refuted by a wall that rests at the worst point; what is proved is so for every rest, and every rest
    allows as much or more."""
    arm, wall = _arm(tmp_path, 6, moving=1, rest=None), WALLS[kind]
    limit = _space(arm, wall).stiffness_factor
    over = _space(arm, _times(wall, 1.001 * limit))
    assert over.outcome == "active"
    assert np.linalg.norm(over.motion.positions[:, 3:], axis=1).max() < 0.2  # it turns about that rest
    under = _space(arm, _times(wall, 0.9 * limit))
    assert under.outcome == "passive"
    assert "in every orientation of rest" in under.claim
    for q in np.random.default_rng(9).uniform(-3, 3, (6, 6)):
        assert _space(arm.replace(rest=q), wall).stiffness_factor >= limit * (1 - 1e-12)


def test_the_reported_energy_by_pinocchio(tmp_path: Path) -> None:
    """Summed again with rotation vectors from pinocchio, without the code that found it."""
    pin = pytest.importorskip("pinocchio")
    arm: Any = _arm(tmp_path, 6, moving=1)
    wall = WALLS["as stiff every way"]
    wall = _times(wall, 1.05 * _space(arm, wall).stiffness_factor)
    motion = _space(arm, wall).motion
    model = pin.buildModelFromUrdf(str(tmp_path / "arm.urdf"))
    data, number = model.createData(), model.getFrameId(arm.frame)
    placed = []
    for q in (np.array(arm.rest), *motion.joints):
        pin.forwardKinematics(model, data, q)
        placed.append(pin.updateFramePlacement(model, data, number).copy())
    turns = [pin.log3(each.rotation @ placed[0].rotation.T) for each in placed[1:]]
    y = [
        np.concatenate([each.translation, np.sinc(np.linalg.norm(r) / 2 / np.pi) * r])  # 2 sin(φ/2)/φ r
        for each, r in zip(placed[1:], turns, strict=True)
    ]
    energy = 0.0
    for k, now in enumerate(y):
        after = (k + 1) % len(y)
        energy += (np.array(wall.stiffness) @ (now - y[0])) @ (y[after] - now)
        energy += np.array(arm.damping) @ (motion.joints[after] - motion.joints[k]) ** 2 / 0.001
    assert energy == pytest.approx(motion.energy, rel=1e-6)
    assert energy < 0


def test_seven_joints_are_proved_up_to_what_a_hand_feels(tmp_path: Path) -> None:
    """The factor is that of (J δ_m⁻¹ Jᵀ)⁻¹."""
    arm, wall = _arm(tmp_path, 7, moving=1), WALLS["coupled"]
    space = _space(arm, wall, 200)
    (need,) = wall_need(wall, 0.001, 0, 6).matrices
    factors = []
    for q in arm.sites(200).joints:
        j = arm.jacobian(q)
        felt = np.linalg.inv(j @ np.diag(1 / np.array(arm.damping)) @ j.T)
        factors.append(1 / np.linalg.eigvals(np.linalg.solve(felt, need)).real.max())
    assert space.stiffness_factor == pytest.approx(min(factors), rel=1e-6)
    assert _space(arm, _times(wall, 0.95 * min(factors)), 200).outcome == "passive"


def test_one_joint_that_turns_the_hand(tmp_path: Path) -> None:
    """e = 2 sin(q/2) in a rotation alone: b = cos²(q/2) KT/2, so that K = 2b/T is the limit at the rest."""
    arm = read_arm(random_arm(tmp_path / "arm.urdf", 3, 1), pose=True, rest={"j0": 0.0}, damping=(0.004,))
    space = _space(arm, zw.arms.MatrixWall.in_pose(0, 1), 401)
    angles = space.data["j0"].values
    assert space.data["stiffness_factor"].values == pytest.approx(8 / np.cos(angles / 2) ** 2, rel=1e-9)
    assert space.stiffness_factor == pytest.approx(8, rel=1e-6)
    assert _space(arm, zw.arms.MatrixWall.in_pose(0, 8 * 0.99), 401).outcome == "passive"
    assert _space(arm, zw.arms.MatrixWall.in_pose(0, 8 * 1.001), 401).outcome == "active"


@pytest.mark.parametrize("joints", [2, 4])
def test_without_rotational_stiffness_it_is_the_wall_of_a_point(joints: int, tmp_path: Path) -> None:
    arm = _arm(tmp_path, joints)
    point = read_arm(tmp_path / "arm.urdf", hold={f"j{i}": 0.03 * i for i in range(2, joints)})
    for stiffness in (200, 3000):
        posed = _space(arm, zw.arms.MatrixWall.in_pose(stiffness, 0))
        plain = zw.workspace(point, zw.Wall(stiffness), rate=1000, points=40)
        for name in ("margin_in_joints", "stiffness_factor", "addition_to_one"):
            assert posed.data[name].values == pytest.approx(plain.data[name].values, rel=1e-9, abs=1e-12)
        assert posed.stiffness_factor == pytest.approx(plain.stiffness_factor)
        assert posed.stiffness_factor * stiffness == pytest.approx(plain.largest_stiffness)
        assert posed.outcome == plain.outcome


@pytest.mark.parametrize("delay", [0, 2])
@pytest.mark.parametrize("kind", ["coupled", "coupled and damped"])
def test_no_closed_path_in_a_proved_region_takes_energy_out(kind: str, delay: int, tmp_path: Path) -> None:
    rng, seed = np.random.default_rng(delay), 1 + len(kind) % 2
    path = random_arm(tmp_path / "arm.urdf", seed, 2)
    arm: Any = read_arm(path, pose=True, rest={"j0": 0.2})
    wall, late = WALLS[kind], delay / 1000
    wall = _times(wall, 0.9 * _space(arm, wall, 20, delay=late).stiffness_factor)
    assert _space(arm, wall, 20, delay=late).outcome == "passive"
    assert least_left(arm, wall, delay, rng, 200, 12) < 0.7


def test_the_loss_between_the_points_does_not_depend_on_units() -> None:
    rng = np.random.default_rng(7)
    root, j = rng.normal(size=(6, 6)), rng.normal(size=(6, 4))
    need, parts, units = root @ root.T, np.array([0.02, 0.01]), np.diag([1000.0] * 3 + [1.0] * 3)
    loss = loss_in_pose(need, j, parts, 3)
    back = np.linalg.inv(units)
    assert loss_in_pose(back @ need @ back, units @ j, parts * [1000, 1], 3) == pytest.approx(loss)
    most = 0.0
    for _ in range(300):
        change = rng.normal(size=(6, 4))
        for rows, bound in ((slice(3), 0.02), (slice(3, 6), 0.01)):
            change[rows] *= bound / np.linalg.norm(change[rows], 2)
        before, after = (np.linalg.eigvalsh(np.eye(4) - x.T @ need @ x)[0] for x in (j, j + change))
        assert before - after <= loss
        most = max(most, before - after)
    assert most > 0.1 * loss


def test_a_held_torque_in_pose() -> None:
    ranges = (0.2, 0.9), (0.5, 1.2)
    arm = PlanarChain(links=(0.1, 0.08), damping=(0.02, 0.015), joint_range=ranges, pose=True)
    wall = zw.arms.MatrixWall.in_pose(100, 0.5, planar=True)
    free, held = (_space(arm, wall, 20, torque_held_up_to=up_to) for up_to in (None, (10, 3)))
    assert held.stiffness_factor < free.stiffness_factor
    assert held.outcome == "passive"
    assert "up to 10 N and 3 N·m" in held.claim
    rng = np.random.default_rng(8)
    for _ in range(100):
        path = rng.uniform([0.2, 0.5], [0.9, 1.2], (1, 2)) + 0.01 * rng.normal(size=(5, 2))
        y, turned = arm.forward(path), np.roll(path, -1, axis=0) - path
        push = rng.normal(size=3)
        push = np.array([*(5 * push[:2] / np.linalg.norm(push[:2])), 2 * np.sign(push[2])])
        force = (y - y[0]) @ np.array(wall.stiffness) + push
        work = np.einsum("ki,kij,kj->", force, arm.jacobian(path), turned)
        assert work + (np.array(arm.damping) * turned**2).sum() / 0.001 >= 0


def test_the_turn_costs_where_the_torque_is_held(tmp_path: Path) -> None:
    arm = _arm(tmp_path, 3)
    wall, held = zw.arms.MatrixWall.in_pose(100, 1), (4, 2)
    price = (arm.curvature * 4 + 1.5 * 2) * 0.001 / 2
    more = arm.replace(damping=tuple(np.array(arm.damping) + price))
    found = [_space(arm, wall), _space(more, wall, torque_held_up_to=held)]
    assert found[0].stiffness_factor == pytest.approx(found[1].stiffness_factor, rel=1e-9)


def test_the_map_keeps_metres_and_radians_apart(tmp_path: Path) -> None:
    options: Any = {"resolution": (0.001,) * 6, "coulomb_friction": (0.02,) * 6, "torque_limit": (2.0,) * 6}
    arm = _arm(tmp_path, 6, **options)
    space = _space(arm, WALLS["coupled"], 8)
    data, q = space.data, arm.sites(8).joints[3, 5]
    assert space.largest_stiffness is None
    assert "margin" not in data
    assert {"hand_x", "hand_y", "hand_z"} <= set(data.coords)
    j = arm.jacobian(q)
    (need,) = wall_need(space.wall, 0.001, 0, 6).matrices
    values, vectors = np.linalg.eigh(np.diag(arm.damping) - j.T @ need @ j)
    cell = {"j0": 3, "j1": 5}
    assert float(data["margin_in_joints"][cell]) == pytest.approx(values[0])
    mapped = [float(data[f"direction_{i + 1}"][cell]) for i in range(6)]
    assert abs(mapped @ vectors[:, 0]) == pytest.approx(1)
    moved = j @ vectors[:, 0]
    assert float(data["worst_translation"][cell]) == pytest.approx(np.linalg.norm(moved[:3]))
    assert float(data["worst_rotation"][cell]) == pytest.approx(np.linalg.norm(moved[3:]))
    for prefix, rows, units in (("", j[:3], ("m", "N")), ("rotational_", j[3:], ("rad", "N*m"))):
        assert data[f"{prefix}resolution"].attrs["units"] == units[0]
        assert data[f"{prefix}friction"].attrs["units"] == units[1]
        least = (0.02 / np.linalg.norm(rows, axis=0)).min()
        assert float(data[f"{prefix}friction"][cell]) == pytest.approx(least)
        assert float(data[f"{prefix}force_limit"][cell]) == pytest.approx(100 * least)


def test_a_planar_chain_in_pose() -> None:
    arm = PlanarChain(links=(0.1, 0.08), damping=(0.02, 0.01), joint_range=((0.2, 0.9),) * 2, pose=True)
    wall = zw.arms.MatrixWall.in_pose(600, 8, planar=True)
    limit = _space(arm, wall, 20).stiffness_factor
    assert _space(arm, _times(wall, 1.001 * limit), 20).outcome == "active"
    assert _space(arm, _times(wall, 0.95 * limit), 20).outcome == "passive"
    over = _space(arm, _times(wall, 2 * limit), 20)
    assert "hand_z" not in over.data.coords
    better = arm.replace(damping=tuple(np.add(arm.damping, over.least_additions)))
    assert _space(better, over.wall, 20).outcome == "passive"


def test_walls_and_hands_that_do_not_fit(tmp_path: Path) -> None:
    posed, anyhow, asked = _arm(tmp_path, 2), _arm(tmp_path, 2, rest=None), {"rate": 1000, "points": 4}
    wall_of, planar = zw.arms.MatrixWall, zw.arms.MatrixWall.in_pose(1, 1, planar=True)
    for ask, words in (
        (lambda: zw.workspace(anyhow, WALLS["coupled"], **asked), "say where it rests"),
        (lambda: zw.workspace(anyhow, wall_of(np.diag([1, 1, 1, 2, 2, 3]), turns=3), **asked), "every axis"),
        (lambda: zw.workspace(posed, zw.Wall(500), **asked), "are not one stiffness"),
        (lambda: zw.workspace(posed, wall_of(np.eye(6)), **asked), "turns=3"),
        (lambda: zw.workspace(posed, planar, **asked), "turns=3"),
        (
            lambda: zw.workspace(PlanarChain(links=(0.1,), damping=(1,), pose=True), zw.Wall(1), **asked),
            "planar=True",
        ),
        (lambda: zw.workspace(built_in("two-link", damping=1), planar, **asked), "held at a point"),
        (lambda: wall_of(np.eye(4), turns=1), "3 and 1 in the plane"),
        (lambda: zw.workspace(posed, WALLS["coupled"], **asked, torque_held_up_to=5), "largest moment"),
    ):
        with pytest.raises(zw.InputError, match=words):
            ask()


def test_a_wall_in_pose_in_words() -> None:
    text = zw.arms.MatrixWall.in_pose(500, 5, 0.1).describe()
    assert text == (
        "wall of 6 coordinates, stiffness 500 to 500 N/m, virtual damping 0.1 to 0.1 N·s/m; "
        "of the rotation stiffness 5 to 5 N·m/rad"
    )


def test_a_wrist_that_no_hand_can_hold_is_not_refuted(tmp_path: Path) -> None:
    """Four axes through the hand but for rounding: one motion of the joints leaves it where it is."""
    axes = ("1 0 0", "0 1 0", "0.6 0.8 0", "0 0 1")
    joints = [
        ("revolute", axis, f"{i}e-12 {i * i}e-12 0", "0.1 0.2 0.3", 0.01) for i, axis in enumerate(axes)
    ]
    path = described(tmp_path / "wrist.urdf", joints, "l4", "0 0 0")
    wall, arm = zw.arms.MatrixWall.in_pose(0, 1), read_arm(path, pose=True, hold={"j2": 0.1, "j3": 0.1})
    limit = _space(arm, wall, 10).stiffness_factor
    assert _space(arm, _times(wall, 1.5 * limit), 10).outcome == "undecided"


def test_shows_itself_without_a_stiffness_in_one_unit(tmp_path: Path) -> None:
    space = _space(_arm(tmp_path, 3), zw.arms.MatrixWall.in_pose(10, 0.1), points=5)
    assert "times as stiff holds at every point" in repr(space)
    assert len(repr(space)) < 600
