"""The checker of a hand in pose: its matrix by other roads, its verdict on both sides, what it refuses."""

from __future__ import annotations

from pathlib import Path
from typing import Any

import numpy as np
import numpy.typing as npt
import pytest
from arm_documents import GONE, chain_in_pose, fractions, put, texts
from checked import matrix_at
from described_arms import random_arm
from scipy.spatial.transform import Rotation

import zwidth as zw
from zwidth import checker
from zwidth.checker.arm.pose import _quaternion, _rotation
from zwidth.model.arms import PlanarChain, read_arm

Array = npt.NDArray[np.float64]


def whole(rows: list[list[float]]) -> Array:
    """A symmetric matrix from its rows from the diagonal on."""
    upper = np.array([[0.0] * i + list(row) for i, row in enumerate(rows)])
    return np.asarray(upper + np.triu(upper, 1).T)


@pytest.mark.parametrize("joints", [3, 6, 7])
@pytest.mark.parametrize("rest", [None, {}, {"j0": 2.5, "j1": -3.0}])
def test_the_matrix_is_that_of_the_arm(joints: int, rest: Any, tmp_path: Path) -> None:
    """The saved document and pinocchio's Jacobian, in the region and beyond, past half a turn, too."""
    hold = {f"j{i}": 0.03 * i for i in range(1, joints)}
    path = random_arm(tmp_path / "arm.urdf", joints, joints, sliding=(2,))
    arm = read_arm(path, pose=True, hold=hold, rest=rest)
    wall = zw.arms.MatrixWall.in_pose(30, 0.5)
    if rest is not None:
        couple = np.zeros((6, 6))
        couple[:3, 3:] = 0.2 * np.arange(9).reshape(3, 3)
        wall = zw.arms.MatrixWall(np.array(wall.stiffness) + couple + couple.T, turns=3)
    space = zw.workspace(arm, wall, rate=1000, points=4)
    document = space.certificate.documents[0]
    for q in np.random.default_rng(5).uniform(-4, 4, (6, joints)).round(4):
        j = (arm if rest is not None else arm.resting(q)).jacobian(q)
        expected = np.diag(arm.damping) - 0.0005 * j.T @ np.array(wall.stiffness) @ j
        assert whole(matrix_at(document, fractions(q))) == pytest.approx(expected, rel=1e-10, abs=1e-12)


def test_every_orientation_of_rest_asks_for_no_less_than_any() -> None:
    """What is left for a rest that is given is as much or more, and the same at the rest itself."""
    rng, most = np.random.default_rng(3), 0.0
    every = chain_in_pose(2, 5, True, (1,))
    for _ in range(20):
        q, rest = rng.uniform(-3, 3, (2, 5)).round(4)
        given = put(every, "wall__rest", "given")
        for i in (0, 2, 3, 4):  # the other one slides
            given = put(given, f"arm__joints__{i}__rest_rad", repr(float(rest[i])))
        least, at_rest = whole(matrix_at(every, fractions(q))), whole(matrix_at(every, fractions(rest)))
        more = np.linalg.eigvalsh(whole(matrix_at(given, fractions(q))) - least)
        assert more[0] > -1e-15
        most = max(most, more[-1])
        assert whole(matrix_at(given, fractions(rest))) == pytest.approx(at_rest, abs=1e-15)
    assert most > 1e-3


def test_a_wall_that_is_not_alike_about_every_axis_is_taken_at_its_stiffest() -> None:
    """With every orientation of rest ρ is at least the largest eigenvalue of R_e."""
    document = chain_in_pose(2, 3, True)
    turned = np.array(document["wall"]["stiffness_N_m_rad"], dtype=float)
    turned[3:, 3:] = [[2, 0.5, 0], [0.5, 3, -0.25], [0, -0.25, 1]]
    q = fractions([0.1, 0.2, -0.2])
    alike = turned.copy()
    alike[3:, 3:] = 3.75 * np.eye(3)  # 0.5 + 3 + 0.25
    walls = (put(document, "wall__stiffness_N_m_rad", texts(stiffness)) for stiffness in (turned, alike))
    found, expected = (whole(matrix_at(wall, q)) for wall in walls)
    assert found == pytest.approx(expected, rel=1e-14)


def space_of(arm: Any, factor: float = 1, stiffness: tuple[float, float] = (500, 5), **shape: Any) -> Any:
    """Of a wall in pose that is so many times as stiff."""
    wall = zw.arms.MatrixWall.in_pose(*(factor * k for k in stiffness), **shape)
    return zw.workspace(arm, wall, rate=1000, points=20)


@pytest.mark.parametrize("rest", [None, {}])
@pytest.mark.parametrize("joints", [3, 6, 7])
def test_both_sides_of_the_limit(joints: int, rest: Any, tmp_path: Path) -> None:
    hold = {f"j{i}": 0.03 * i for i in range(2 if joints == 3 else 1, joints)}
    arm = read_arm(random_arm(tmp_path / "arm.urdf", 10 + joints, joints), pose=True, hold=hold, rest=rest)
    limit = space_of(arm).stiffness_factor
    under = space_of(arm, 0.99 * limit)
    assert under.outcome == "passive"
    document = under.certificate.documents[0]
    over = 1.01 / 0.99 * np.array(document["wall"]["stiffness_N_m_rad"], dtype=float)
    found = checker.verify(put(document, "wall__stiffness_N_m_rad", texts(over)))
    assert not found.valid
    assert "not enough" in found.reason
    refuted = space_of(arm, 1.01 * limit)
    assert refuted.outcome == "active"
    assert refuted.motion.imposed_by == ("end" if joints < 7 else "links")


def test_units_may_be_far_apart(tmp_path: Path) -> None:
    """A plane wall in doubles of 300 N/m beside a rotation of 10⁻⁴ N·m/rad: neither rounds the other away."""
    n, virtual = np.array([2.0, -1.0, 2.0]) / 3, np.array([[0.1, 0.02, 0], [0.02, -0.2, 0.03], [0, 0.03, 0]])
    stiffness, damping = np.zeros((2, 6, 6))
    stiffness[:3, :3], stiffness[3:, 3:] = 300 * np.outer(n, n), 1e-4 * np.eye(3)
    damping[:3, :3], damping[3:, 3:] = virtual, -1e-9 * np.eye(3)
    arm = read_arm(random_arm(tmp_path / "arm.urdf", 3, 2), pose=True)
    space = zw.workspace(arm, zw.arms.MatrixWall(stiffness, damping, turns=3), rate=1000, points=8)
    assert space.outcome == "passive"
    bound = np.array(space.certificate.documents[0]["wall"]["damping_bound_N_m_s_rad"], dtype=float)
    assert bound[3:, 3:] == pytest.approx(1e-9 * np.eye(3), rel=1e-9)
    assert not bound[:3, 3:].any()


HELD = {"torque": "held", "largest_force_N": "0.4", "curvature_m_per_rad2": "5", "largest_moment_N_m": "0.5"}


@pytest.mark.parametrize(("size", "slides"), [(3, ()), (5, (1, 2))])
def test_a_held_torque_pays_for_forces_and_turns(size: int, slides: tuple[int, ...]) -> None:
    free = chain_in_pose(4, size, True, slides)
    held = {**free, "loop": {**free["loop"], **HELD}}
    q = fractions([0.1] * size)
    price = (5 * 0.4 + (size - len(slides)) / 2 * 0.5) * 0.001 / 2
    taken = whole(matrix_at(free, q)) - whole(matrix_at(held, q))
    assert taken == pytest.approx(price * np.eye(size), abs=1e-15)
    assert "up to 0.4 N and moments up to 0.5 N·m" in checker.verify(held).reason
    for value, reason in ((GONE, "largest_moment_N_m is missing"), ("-1", "largest_moment_N_m must be ≥ 0")):
        assert reason in checker.verify(put(held, "loop__largest_moment_N_m", value)).reason


def planar() -> dict[str, Any]:
    """Two links that hold (x, y, angle), and what `workspace` writes of them, 1 % below the limit."""
    arm = PlanarChain(links=(0.1, 0.08), damping=(0.02, 0.01), joint_range=((0.2, 0.9),) * 2, pose=True)
    asked: Any = {"stiffness": (600, 8), "planar": True}
    space = space_of(arm, 0.99 * space_of(arm, **asked).stiffness_factor, **asked)
    assert space.outcome == "passive"
    return space.certificate.documents[0]


def test_a_chain_in_the_plane() -> None:
    document = planar()
    stiffness = np.array(document["wall"]["stiffness_N_m_rad"], dtype=float)
    arm = PlanarChain(links=(0.1, 0.08), damping=(0.02, 0.01), pose=True)
    j = arm.jacobian([0.4, 0.7])
    expected = np.diag(arm.damping) - 0.0005 * j.T @ stiffness @ j
    assert whole(matrix_at(document, fractions([0.4, 0.7]))) == pytest.approx(expected, abs=1e-15)
    reason = checker.verify(document).reason
    assert f"up to {stiffness[0, 0]:g} N/m and {stiffness[2, 2]:g} N·m/rad, in every orientation" in reason
    tilted = texts(Rotation.from_rotvec([0.1, 0, 0]).as_matrix())
    assert "same axis" in checker.verify(put(document, "arm__joints__1__rotation", tilted)).reason
    stiffer = put(document, "wall__stiffness_N_m_rad__2__2", repr(1.1 * float(stiffness[2, 2])))
    assert "not enough" in checker.verify(stiffer).reason


STIFF = texts(np.diag([1.0, 1, 1, 2000, 2000, 2000]))
COUPLED = texts(np.eye(6) + np.eye(6, k=3) * 0.1 + np.eye(6, k=-3) * 0.1)
MIRROR = texts(np.diag([1.0, 1, -1]))


@pytest.mark.parametrize(
    ("every", "path", "value", "reason"),
    [
        (True, "wall__stiffness_N_m_rad", STIFF, "not enough"),
        (False, "wall__stiffness_N_m_rad", STIFF, "not enough"),
        (True, "wall__stiffness_N_m_rad", COUPLED, "one orientation of rest"),
        (True, "wall__damping_bound_N_m_s_rad", COUPLED, "one orientation of rest"),
        (True, "wall__stiffness_N_m_rad", texts(np.diag([1.0, 1, 1, 1, 1, -1e-9])), "negative eigenvalue"),
        (True, "wall__stiffness_N_m_rad", texts(np.eye(3)), "6 rows"),
        (True, "wall__virtual_damping_N_m_s_rad", texts(0.01 * np.eye(6)), "is too small"),
        (True, "wall__turns", GONE, "unit of stiffness"),
        (True, "wall__turns", 1, "3 rows"),
        (True, "wall__turns", 0, "turns must be 1 or 3"),
        (True, "wall__turns", 2, "turns must be 1 or 3"),
        (True, "wall__rest", GONE, "rest is missing"),
        (True, "wall__rest", "anywhere", "rest must be every orientation or given"),
        (False, "wall__rest", "every orientation", "one orientation of rest"),
        (False, "arm__joints__1__rest_rad", GONE, "rest_rad is missing"),
        (False, "arm__joints__1__rest_rad", "1e9", "too many turns"),
        (True, "arm__joints__1__rotation", MIRROR, "must not mirror"),
        (False, "arm__joints__1__rotation", MIRROR, "must not mirror"),
        (True, "arm__joints__1__rotation__0__0", "2", "rows of a rotation"),
        (True, "arm__joints__0__high_rad", "100", "too many turns"),
        (True, "arm__joints__2__damping_N_m_s_per_rad", "0.0001", "not enough"),
        (True, "loop__delay_samples", 200, "not enough"),
        (True, "arm__geometry", "legs", "no proof of this kind has"),
    ],
)  # fmt: skip
def test_what_does_not_hold_is_refused(every: bool, path: str, value: Any, reason: str) -> None:
    document = chain_in_pose(4, 4, every)
    assert checker.verify(document).valid
    found = checker.verify(put(document, path, value))
    assert not found.valid
    assert reason in found.reason


@pytest.mark.parametrize("rest", [None, {}])
def test_other_axes_and_a_larger_region_are_refused(rest: Any, tmp_path: Path) -> None:
    path = random_arm(tmp_path / "arm.urdf", 13, 3)
    arm = read_arm(path, pose=True, hold={"j2": 0.1}, rest=rest)
    document = space_of(arm, 0.98 * space_of(arm).stiffness_factor).certificate.documents[0]
    joints = document["arm"]["joints"]

    turns = [Rotation.from_rotvec([angle, 0, 0]).as_matrix() for angle in (-0.3, 0.3)]
    rotation = np.array(joints[2]["rotation"], dtype=float)
    further = repr(float(joints[2]["low_rad"]) - 1)
    for key, any_of in (("rotation", [texts(rotation @ turn) for turn in turns]), ("low_rad", [further])):
        found = [checker.verify(put(document, f"arm__joints__2__{key}", value)) for value in any_of]
        assert any("not enough" in each.reason for each in found)


def test_the_rotation_of_a_quaternion_is_exact() -> None:
    """Of rounded ones, half turns among them: rational, orthogonal, and next to what was given."""
    halves = [np.diag(d) for d in ((1.0, -1, -1), (-1, 1, -1), (-1, -1, 1), (1, 1, 1))]
    rng = np.random.default_rng(0)
    for rotation in (*halves, *(Rotation.random(rng=rng).as_matrix() for _ in range(20))):
        exact = _rotation(_quaternion([fractions(row) for row in rotation]))
        for i, a in enumerate(exact):
            for k, b in enumerate(exact):
                assert sum(x * y for x, y in zip(a, b, strict=True)) == (i == k)
        assert np.array(exact, dtype=float) == pytest.approx(rotation, abs=1e-15)
