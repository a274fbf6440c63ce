"""A hand in pose: its six coordinates, how the joints move them, and the bounds on that."""

from __future__ import annotations

from collections.abc import Iterator
from pathlib import Path
from typing import Any

import numpy as np
import numpy.typing as npt
import pytest
from described_arms import random_arm

import zwidth as zw
from zwidth.model.arms import Arm, PlanarChain, PosedArm, Sites, built_in, read_arm
from zwidth.model.arms.described import coordinates, product, rates

Array = npt.NDArray[np.float64]
ARMS = ((2, ()), (6, ()), (7, ()), (4, (1,)))


@pytest.fixture(params=ARMS, ids=["two", "six", "seven", "sliding"])
def arm(request: Any, tmp_path: Path) -> PosedArm:
    """In pose, at rest somewhere off the middle."""
    joints, sliding = request.param
    path = random_arm(tmp_path / "arm.urdf", joints, joints, sliding)
    found = read_arm(path, pose=True, rest={"j0": 0.3, "j1": -0.1})
    assert isinstance(found, PosedArm)
    return found


def _differences(arm: Arm, q: Array, step: float = 1e-6) -> Array:
    moved = [(arm.forward(q + step * e) - arm.forward(q - step * e)) / (2 * step) for e in np.eye(len(q))]
    return np.stack(moved, axis=-1)


def test_the_jacobian_is_the_derivative(arm):
    """By differences, several turns away from the limits of the joints too."""
    rng = np.random.default_rng(1)
    for q in rng.uniform(-7, 7, (6, arm.joint_count)):
        assert arm.jacobian(q) == pytest.approx(_differences(arm, q), abs=1e-8)


def test_the_turn_by_pinocchio(arm, tmp_path):
    """e = 2 sin(φ/2)/φ r with the rotation vector r of pinocchio, and its derivative by Jlog3."""
    pin = pytest.importorskip("pinocchio")
    model = pin.buildModelFromUrdf(str(tmp_path / "arm.urdf"))
    rng, data, tried = np.random.default_rng(2), model.createData(), 0
    number = model.getFrameId(arm.frame)

    def frame(q: Array) -> Any:
        pin.computeJointJacobians(model, data, q)
        return pin.updateFramePlacement(model, data, number).copy()

    rest = frame(np.array(arm.rest))
    for q in rng.uniform(-1, 1, (10, arm.joint_count)):
        turned = frame(q).rotation @ rest.rotation.T
        angular = pin.getFrameJacobian(model, data, number, pin.LOCAL_WORLD_ALIGNED)[3:]
        r = pin.log3(turned)
        phi = np.linalg.norm(r)
        scale, slope = 2 * np.sin(phi / 2) / phi, (np.cos(phi / 2) - 2 * np.sin(phi / 2) / phi) / phi
        by_vector = scale * np.eye(3) + slope / phi * np.outer(r, r)
        expected = by_vector @ pin.Jlog3(turned) @ turned.T @ angular
        e = arm.forward(q)[3:]
        sign = np.sign(e @ r)  # of the quaternion, which may have come round
        assert e == pytest.approx(sign * scale * r, abs=1e-12)
        assert arm.jacobian(q)[3:] == pytest.approx(sign * expected, abs=1e-10)
        tried += phi > 0.3
    assert tried > 3


def test_the_point_is_that_of_the_arm_held_at_a_point(arm, tmp_path):
    """Position, its Jacobian and its bound do not know of the turn; at rest the turn is 0."""
    plain = read_arm(tmp_path / "arm.urdf")
    q = np.random.default_rng(3).uniform(-1, 1, (4, arm.joint_count))
    assert arm.forward(q)[..., :3] == pytest.approx(plain.forward(q), abs=1e-15)
    assert arm.jacobian(q)[..., :3, :] == pytest.approx(plain.jacobian(q), abs=1e-15)
    assert arm.forward(arm.rest)[3:] == pytest.approx(0, abs=1e-15)
    parts = arm.sites(5).parts
    assert parts[..., 0] == pytest.approx(plain.sites(5).change)


def test_no_jump_however_far_it_turns(arm):
    """Joints that go round twice: e changes by no more than the joints do, and comes back after two turns."""
    for i in np.flatnonzero(~np.array(arm.sliding)):
        q = np.tile(arm.rest, (4001, 1))
        q[:, i] += np.linspace(0, 4 * np.pi, 4001)
        e = arm.forward(q)[:, 3:]
        steps = np.linalg.norm(np.diff(e, axis=0), axis=1)
        assert steps.max() <= 4 * np.pi / 4000 * (1 + 1e-12)
        assert e[-1] == pytest.approx(e[0], abs=1e-9)
        assert np.linalg.norm(e, axis=1).max() == pytest.approx(2, rel=1e-6)


def _in_cells(
    arm: PosedArm, sites: Sites, rng: np.random.Generator, count: int
) -> Iterator[tuple[Any, Array]]:
    """Cells, six along each joint that moves, and a corner of each."""
    moving = sum(high > low for low, high in arm.joint_range)
    halves = np.array([(high - low) / 12 for low, high in arm.joint_range])
    for _ in range(count):
        place = tuple(rng.integers(6, size=moving))
        yield place, sites.joints[place] + rng.choice([-1, 1], arm.joint_count) * halves


def test_the_bounds_between_the_points_hold(arm):
    """Of the rows of translation, of those of rotation and of all."""
    sites, most = arm.sites(6), 0.0
    for place, q in _in_cells(arm, sites, np.random.default_rng(4), 60):
        change = arm.jacobian(q) - sites.jacobians[place]
        by_parts = [np.linalg.norm(change[:3], 2), np.linalg.norm(change[3:], 2)]
        assert (by_parts <= sites.parts[place]).all()
        assert np.linalg.norm(change, 2) <= sites.change[place]
        most = max(most, by_parts[1] / sites.parts[place][1])
    assert most > 0.1


def test_the_bounds_hold_for_every_rest(arm):
    """Without a rest the rows are those of the angular velocity, at any rest they are no longer."""
    free = arm.replace(rest=None)
    sites, rng = free.sites(6), np.random.default_rng(14)
    for place, q in _in_cells(arm, sites, rng, 40):
        here = free.resting(q).jacobian(q)
        assert np.linalg.norm((here - sites.jacobians[place])[3:], 2) <= sites.parts[place][1]
        other = arm.replace(rest=rng.uniform(-3, 3, arm.joint_count)).jacobian(q)
        assert np.linalg.eigvalsh(here[3:].T @ here[3:] - other[3:].T @ other[3:])[0] >= -1e-12


def test_the_turning_curvature_is_a_bound(arm):
    """|e(q + s) − e(q) − J s| ≤ ½ h |s|²."""
    rng, most, curvature = np.random.default_rng(5), 0.0, arm.turning_curvature
    for _ in range(200):
        q, step = rng.uniform(-2, 2, arm.joint_count), rng.normal(size=arm.joint_count) * 0.1
        gap = arm.forward(q + step) - arm.forward(q) - arm.jacobian(q) @ step
        bound = curvature * (step @ step) / 2
        assert np.linalg.norm(gap[3:]) <= bound
        most = max(most, np.linalg.norm(gap[3:]) / bound)
    assert most > 0.1


def test_a_turn_takes_no_more_than_the_angle():
    """EᵀE = I − v vᵀ, and a spring K = k I has the moment k sin φ about the axis."""
    rng = np.random.default_rng(6)
    for _ in range(20):
        q = rng.normal(size=4)
        q /= np.linalg.norm(q)
        e_matrix, v = rates(q, np.eye(3)), q[1:]
        assert e_matrix.T @ e_matrix == pytest.approx(np.eye(3) - np.outer(v, v), abs=1e-14)
        phi, axis = 2 * np.arctan2(np.linalg.norm(v), q[0]), v / np.linalg.norm(v)
        assert e_matrix.T @ (7 * coordinates(q)) == pytest.approx(7 * np.sin(phi) * axis, abs=1e-13)
        other = rng.normal(size=4)
        assert product(q, other) @ product(q, other) == pytest.approx(other @ other)


def test_a_planar_chain_turns_by_the_sum_of_its_joints():
    """(x, y, Σq), with the Jacobian by differences; the point is that of the chain without pose."""
    plain = PlanarChain(links=(0.1, 0.07, 0.05), damping=(1, 1, 1))
    arm = plain.replace(pose=True)
    q = np.array([0.3, 1.1, -0.4])
    assert arm.forward(q) == pytest.approx([*plain.forward(q), 1.0])
    assert arm.jacobian(q) == pytest.approx(_differences(arm, q), abs=1e-9)
    assert (arm.turns, plain.turns, arm.turning_curvature, plain.turning_curvature) == (1, 0, 0, None)
    sites = arm.sites(20)
    assert sites.parts[..., 0] == pytest.approx(plain.sites(20).change)
    assert (sites.parts[..., 1] == 0).all()


def test_what_has_no_pose_is_said(tmp_path):
    with pytest.raises(zw.InputError, match="haply-2diy has no pose"):
        built_in("haply-2diy", damping=0.01, pose=True)
    path = random_arm(tmp_path / "arm.urdf", 1, 2)
    with pytest.raises(zw.InputError, match="a point does not turn"):
        read_arm(path, rest={"j0": 0.1})
    with pytest.raises(zw.InputError, match="rest: there is no joint 'wrist'"):
        read_arm(path, pose=True, rest={"wrist": 0.1})
    arm = read_arm(path, pose=True)
    with pytest.raises(zw.InputError, match="shape"):
        arm.replace(rest=(0.1,))
