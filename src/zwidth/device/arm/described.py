"""Arms from robot descriptions: URDF and MJCF, read by pinocchio.

The hand is at the origin of one frame, and what counts is its position: three
coordinates.  Viscous and Coulomb friction and the limits of motion and effort
are read from the description where they are not given.
"""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass
from pathlib import Path
from typing import Any

import numpy as np
import numpy.typing as npt

from zwidth.device.arm.arm import Arm, Array, Axis, Sites, as_joints, middles
from zwidth.device.arm.chain import Placed
from zwidth.device.arm.description_file import read_model
from zwidth.errors import InputError

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
        (low, high) of each joint [rad; m]: where low = high the joint is held. Two joints or fewer move.
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

    def sites(self, points: int) -> Sites:
        """Equal cells of the two joints that move, the others held."""
        moving = [i for i, (low, high) in enumerate(self.joint_range) if high > low]
        names = [self.model.names[i + 1] for i in range(self.joint_count)]
        axes = tuple(
            Axis(names[i], _unit(self.model, i), middles(*self.joint_range[i], points)) for i in moving
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
                names, (_unit(self.model, i) for i in range(len(names))), self.joint_range, strict=True
            )
        ]
        rates, between = self._rates()
        change = np.full(q.shape[:-1], np.linalg.norm(rates @ halves[between]))
        return Sites(axes, q, positions, jacobians, change, "; ".join(words))

    def _computed(self, joints: npt.ArrayLike) -> tuple[Array, Array]:
        import pinocchio as pin

        q = as_joints(joints, self.joint_count)
        data, neutral = self.model.createData(), pin.neutral(self.model)
        number = self.model.getFrameId(self.frame)
        flat = q.reshape(-1, self.joint_count)
        positions, jacobians = np.empty((len(flat), 3)), np.empty((len(flat), 3, self.joint_count))
        for k, row in enumerate(flat):
            pin.computeJointJacobians(self.model, data, pin.integrate(self.model, neutral, row))
            placed = pin.updateFramePlacement(self.model, data, number)
            positions[k] = placed.translation
            full = pin.getFrameJacobian(self.model, data, number, pin.LOCAL_WORLD_ALIGNED)
            jacobians[k] = full.reshape(6, -1)[:3]  # one joint alone comes as a plain vector
        return positions.reshape(*q.shape[:-1], 3), jacobians.reshape(*q.shape[:-1], 3, self.joint_count)

    def placements(self) -> tuple[list[Placed], Array]:
        """The joints between base and hand, z turned to each axis, and the hand in the last frame [m]."""
        data, joints, before = self.model.createData(), list[Placed](), np.eye(3)
        for number in self._path():
            at, twist = self.model.jointPlacements[number], np.ravel(data.joints[number].S)
            i = int(self.model.joints[number].idx_v)
            slides = _slides(self.model, i)
            turn = _turned_to(twist[:3] if slides else twist[3:])
            rotation, translation = before.T @ at.rotation @ turn, before.T @ at.translation
            joints.append(Placed(i, slides, np.round(rotation, _DIGITS), translation))
            before = turn
        frame = self.model.frames[self.model.getFrameId(self.frame)]
        return joints, before.T @ frame.placement.translation

    def _path(self) -> list[int]:
        """The joints between the base and the hand, from the base on."""
        path, joint = list[int](), self.model.frames[self.model.getFrameId(self.frame)].parentJoint
        while joint > 0:
            path.insert(0, int(joint))
            joint = self.model.parents[joint]
        return path

    def _rates(self) -> tuple[Array, list[int]]:
        """Bounds on |∂²p/∂q_i∂q_j|: what lies beyond both joints where both turn, 1 where one slides, else 0;
        and which joints lie between the base and the hand."""
        frame = self.model.frames[self.model.getFrameId(self.frame)]
        beyond, length = {}, float(np.linalg.norm(frame.placement.translation))
        for joint in reversed(self._path()):
            i = self.model.joints[joint].idx_v
            if _slides(self.model, i):
                length += max(map(abs, self.joint_range[i]))
            beyond[i] = length
            length += float(np.linalg.norm(self.model.jointPlacements[joint].translation))

        def rate(i: int, j: int) -> float:
            sliding = _slides(self.model, i) + _slides(self.model, j)
            return min(beyond[i], beyond[j]) if sliding == 0 else float(sliding == 1)

        return np.array([[rate(i, j) for j in sorted(beyond)] for i in sorted(beyond)]), sorted(beyond)


def read_arm(
    path: str | Path,
    *,
    frame: str | None = None,
    hold: dict[str, float] | None = None,
    damping: Sequence[float] | None = None,
    coulomb_friction: Sequence[float] | None = None,
    resolution: Sequence[float] = (),
    torque_limit: Sequence[float] | None = None,
) -> DescribedArm:
    """Read an arm from a URDF or MJCF file; needs the extra `arms`, which is pinocchio.

    Parameters
    ----------
    path
        The file, .urdf, .xml or .mjcf. Meshes are not read.
    frame
        The frame at whose origin the hand is; None: the last one.
    hold
        Joints that stay at a value [rad; m], by name; the map moves two joints at most.
        None: of more than two joints, all but the first two are held in the middle of their ranges.
    damping, coulomb_friction, torque_limit
        Of each joint [N·m·s/rad], [N·m], [N·m]; None: those of the description.
    resolution
        Encoder step of each joint [rad; m]; descriptions have none.

    Raises
    ------
    InputError
        If the file cannot be read, a name is not in it, or its joints have no damping at all.
    """
    path = Path(path)
    model = read_model(path)
    m, m_names = int(model.nv), [str(n) for n in model.names][1:]
    if len(m_names) != m:
        raise InputError(f"{path.name}: every joint must turn or slide about one axis")
    frames = [str(f.name) for f in model.frames]
    if frame is not None and frame not in frames:
        raise InputError(f"{path.name} has no frame {frame!r}; it has {', '.join(frames[1:21])}")
    b = tuple(model.damping) if damping is None else tuple(damping)
    if not any(b):
        raise InputError(
            f"{path.name} gives no joint any damping, and without damping no wall is passive; "
            "measure it and give damping, or write <dynamics damping=…/> in the description"
        )
    limits = tuple(model.effortLimit) if torque_limit is None else tuple(torque_limit)
    return DescribedArm(
        model=model,
        frame=frame or frames[-1],
        joint_range=_ranges(model, m_names, hold),
        damping=b,
        coulomb_friction=tuple(model.friction) if coulomb_friction is None else coulomb_friction,
        resolution=resolution,
        torque_limit=limits if all(0 < v < np.inf for v in limits) else (),
        name=str(model.name) or path.stem,
    )


def _ranges(model: Any, names: list[str], hold: dict[str, float] | None) -> tuple[tuple[float, float], ...]:
    unknown = sorted(set(hold or {}) - set(names))
    if unknown:
        raise InputError(f"hold: there is no joint {unknown[0]!r}; there are {', '.join(names)}")
    ranges = []
    for i, name in enumerate(names):
        if hold is not None and name in hold:
            low = high = _held(model, i, name, float(hold[name]))
        else:
            low, high = _limits(model, i)
            if hold is None and i >= 2:
                low = high = (low + high) / 2
        ranges.append((low, high))
    moving = [name for name, (low, high) in zip(names, ranges, strict=True) if high > low]
    if not 1 <= len(moving) <= 2:
        raise InputError(f"the map moves one or two joints, here {len(moving)} would move; hold the others")
    return tuple(ranges)


def _held(model: Any, i: int, name: str, value: float) -> float:
    low, high = _written_limits(model, i) or (-np.inf, np.inf)
    if not (np.isfinite(value) and low <= value <= high):
        bounds = f"from {low:g} to {high:g} {_unit(model, i)}" if np.isfinite(low) else "finite"
        raise InputError(f"hold: {name} can be {bounds}, got {value:g}")
    return value


def _limits(model: Any, i: int) -> tuple[float, float]:
    written = _written_limits(model, i)
    if written is None and _slides(model, i):
        raise InputError(f"joint {i + 1} slides without limits; write them into the description, or hold it")
    return written or (-float(np.pi), float(np.pi))


def _written_limits(model: Any, i: int) -> tuple[float, float] | None:
    joint = next(j for j in model.joints if j.idx_v == i)
    if joint.nq != 1:
        return None
    low, high = (float(limit[joint.idx_q]) for limit in (model.lowerPositionLimit, model.upperPositionLimit))
    return (low, high) if -1e3 < low < high < 1e3 else None


def _turned_to(axis: Array) -> Array:
    """A rotation that takes z to this unit vector."""
    side = np.eye(3)[int(np.argmin(np.abs(axis)))]
    x = np.cross(side, axis)
    x /= np.linalg.norm(x)
    return np.stack([x, np.cross(axis, x), axis], axis=-1)


def _slides(model: Any, i: int) -> bool:
    joint = next(j for j in model.joints if j.idx_v == i)
    return "JointModelP" in joint.shortname()


def _unit(model: Any, i: int) -> str:
    return "m" if _slides(model, i) else "rad"
