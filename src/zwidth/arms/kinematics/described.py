"""Arms from robot descriptions, computed by pinocchio.

The hand is at the origin of one frame, and what counts is its position: three
coordinates.  In pose the turn of the frame counts too: `posed`.
"""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass
from typing import Any

import numpy as np
import numpy.typing as npt

from zwidth.arms.kinematics.arm import Arm, Array, Axis, Sites, as_joints, middles
from zwidth.arms.kinematics.chain import Placed
from zwidth.errors import InputError

_MOST_MAPPED = 2
"""Joints of a map of cells."""

_DIGITS = 15
"""Of rotations, which descriptions give as angles: what is beyond is the rounding of a sine."""


@dataclass(frozen=True, kw_only=True)
class DescribedArm(Arm):
    """An arm that pinocchio computes; made by `read_arm`.

    Parameters
    ----------
    model
        A `pinocchio.Model` whose joints have one coordinate each.
    frame
        Name of the frame at whose origin the hand is.
    joint_range
        (low, high) of each joint [rad; m]: where low = high the joint is held. On a map of cells two joints
        or fewer move.
    damping, coulomb_friction, resolution, torque_limit, name
        As of `Arm`.
    """

    model: Any
    frame: str
    joint_range: Sequence[tuple[float, float]]

    @property
    def joint_count(self) -> int:
        return int(self.model.nv)

    def forward(self, joints: npt.ArrayLike) -> Array:
        """p (…, 3) [m]."""
        return self._computed(joints)[0]

    def jacobian(self, joints: npt.ArrayLike) -> Array:
        """J (…, 3, m) [m/rad; 1], in the axes of the base."""
        return self._computed(joints)[1]

    @property
    def curvature(self) -> float:
        """h [m/rad²]."""
        return float(np.linalg.eigvalsh(self._rates()[0])[-1])

    @property
    def second_derivatives(self) -> Array:
        """Bounds on |∂²p/∂q_i∂q_j| in the region and one encoder step around it, m × m [m/rad²; m/rad]."""
        rates, between = self._rates()
        full = np.zeros((self.joint_count, self.joint_count))
        full[np.ix_(between, between)] = rates
        return full

    def sites(self, points: int) -> Sites:
        """Equal cells of the two joints that move, the others held."""
        moving = [i for i, (low, high) in enumerate(self.joint_range) if high > low]
        if len(moving) > _MOST_MAPPED:
            raise InputError(
                f"a map of cells moves one or two joints, here {len(moving)} would move: hold the others, or "
                "ask for postures, zwidth.stiffness_over_postures or --postures"
            )
        names = [self.model.names[i + 1] for i in range(self.joint_count)]
        axes = tuple(
            Axis(names[i], unit_of(self.model, i), middles(*self.joint_range[i], points)) for i in moving
        )
        q = np.empty((*[points] * len(moving), self.joint_count))
        q[...] = [low for low, _ in self.joint_range]
        for axis, grid in zip(moving, np.meshgrid(*(a.middles for a in axes), indexing="ij"), strict=True):
            q[..., axis] = grid
        positions, jacobians = self._computed(q)
        halves = np.array([(high - low) / (2 * points) for low, high in self.joint_range])
        words = [
            f"{name} {f'from {low:.4g} to {high:.4g}' if high > low else f'held at {low:.4g}'} {unit}"
            for name, unit, (low, high) in zip(
                names, (unit_of(self.model, i) for i in range(len(names))), self.joint_range, strict=True
            )
        ]
        rates, between = self._rates()
        change = np.full(q.shape[:-1], np.linalg.norm(rates @ halves[between]))
        return Sites(axes, q, positions, jacobians, change, "; ".join(words))

    def placed(self, joints: npt.ArrayLike) -> tuple[Array, Array]:
        """Position and Jacobian of `sites` at any joints (…, m): in pose of every rest, or of `rest`."""
        return self._computed(joints)

    def _computed(self, joints: npt.ArrayLike) -> tuple[Array, Array]:
        positions, jacobians = self._placed(joints)
        return positions, jacobians[..., :3, :]

    def _placed(self, joints: npt.ArrayLike) -> tuple[Array, Array]:
        """p (…, 3), and the Jacobians of velocity and angular velocity (…, 6, m)."""
        import pinocchio as pin

        q = as_joints(joints, self.joint_count)
        data, neutral = self.model.createData(), pin.neutral(self.model)
        number = self._number()
        flat = q.reshape(-1, self.joint_count)
        positions, jacobians = np.empty((len(flat), 3)), np.empty((len(flat), 6, self.joint_count))
        for k, row in enumerate(flat):
            pin.computeJointJacobians(self.model, data, pin.integrate(self.model, neutral, row))
            placed = pin.updateFramePlacement(self.model, data, number)
            positions[k] = placed.translation
            full = pin.getFrameJacobian(self.model, data, number, pin.LOCAL_WORLD_ALIGNED)
            jacobians[k] = full.reshape(6, -1)  # one joint alone comes as a plain vector
        return positions.reshape(*q.shape[:-1], 3), jacobians.reshape(*q.shape[:-1], 6, self.joint_count)

    def _number(self) -> int:
        """Of the frame; where a link and a joint share the name, of the link."""
        import pinocchio as pin

        named = [i for i, frame in enumerate(self.model.frames) if frame.name == self.frame]
        links = [i for i in named if self.model.frames[i].type == pin.FrameType.BODY]
        return (links or named)[-1]

    @property
    def sliding(self) -> tuple[bool, ...]:
        """Of each joint whether it slides; the others turn."""
        return tuple(slides(self.model, i) for i in range(self.joint_count))

    def placements(self) -> tuple[list[Placed], Array]:
        """The joints between base and hand, z turned to each axis, and the hand in the last frame [m]."""
        data, joints, before = self.model.createData(), list[Placed](), np.eye(3)
        for number in self._path():
            at, twist = self.model.jointPlacements[number], np.ravel(data.joints[number].S)
            i = int(self.model.joints[number].idx_v)
            sliding = slides(self.model, i)
            turn = _turned_to(twist[:3] if sliding else twist[3:])
            rotation, translation = before.T @ at.rotation @ turn, before.T @ at.translation
            joints.append(Placed(i, sliding, np.round(rotation, _DIGITS), translation))
            before = turn
        frame = self.model.frames[self._number()]
        return joints, before.T @ frame.placement.translation

    def _path(self) -> list[int]:
        """The joints between the base and the hand, from the base on."""
        path, joint = list[int](), self.model.frames[self._number()].parentJoint
        while joint > 0:
            path.insert(0, int(joint))
            joint = self.model.parents[joint]
        return path

    def _rates(self) -> tuple[Array, list[int]]:
        """Bounds on |∂²p/∂q_i∂q_j|: what lies beyond both joints where both turn, 1 where one slides, else 0;
        and which joints lie between the base and the hand."""
        frame = self.model.frames[self._number()]
        beyond, length = {}, float(np.linalg.norm(frame.placement.translation))
        for joint in reversed(self._path()):
            i = self.model.joints[joint].idx_v
            if slides(self.model, i):
                length += max(map(abs, self.joint_range[i])) + (
                    self.resolution[i] if self.resolution else 0.0
                )
            beyond[i] = length
            length += float(np.linalg.norm(self.model.jointPlacements[joint].translation))

        def rate(i: int, j: int) -> float:
            sliding = slides(self.model, i) + slides(self.model, j)
            return min(beyond[i], beyond[j]) if sliding == 0 else float(sliding == 1)

        return np.array([[rate(i, j) for j in sorted(beyond)] for i in sorted(beyond)]), sorted(beyond)


def _turned_to(axis: Array) -> Array:
    """A rotation that takes z to this unit vector."""
    side = np.eye(3)[int(np.argmin(np.abs(axis)))]
    x = np.cross(side, axis)
    x /= np.linalg.norm(x)
    return np.stack([x, np.cross(axis, x), axis], axis=-1)


def slides(model: Any, i: int) -> bool:
    """Whether coordinate i is that of a sliding joint."""
    joint = next(j for j in model.joints if j.idx_v == i)
    return "JointModelP" in joint.shortname()


def unit_of(model: Any, i: int) -> str:
    """Of coordinate i."""
    return "m" if slides(model, i) else "rad"
