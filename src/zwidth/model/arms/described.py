"""Arms from robot descriptions, held at a point or in pose.

Arms from robot descriptions.

The hand is at the origin of one frame, and what counts is its position: three
coordinates.  In pose the turn of the frame counts too: `posed`.
"""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass, field

import numpy as np
import numpy.typing as npt

from zwidth.errors import InputError
from zwidth.model.arms.arm import Arm, Array, Axis, Sites, as_joints, middles
from zwidth.model.arms.chain import Placed
from zwidth.model.arms.mechanism import Frame, Joint, Mechanism, Placement, turned

MOST_MAPPED = 2
"""Joints of a map of cells."""

_DIGITS = 15
"""Of rotations, which descriptions give as angles: what is beyond is the rounding of a sine."""


@dataclass(frozen=True, kw_only=True)
class DescribedArm(Arm):
    """An arm that a file describes; made by `read_arm`.

    Parameters
    ----------
    model
        The table of its joints; those that follow another (mimic joints) move with it, and are no joints of
        the arm: J and friction are those of the mechanism.
    frame
        Name of the frame at whose origin the hand is.
    damping_source
        What is to be known of damping that comes from the description; empty: it was given.
    joint_range
        (low, high) of each joint [rad; m]: where low = high the joint is held. On a map of cells two joints
        or fewer move.
    damping, coulomb_friction, resolution, torque_limit, name
        As of `Arm`.
    """

    model: Mechanism = field(repr=False)
    frame: str
    joint_range: Sequence[tuple[float, float]]
    damping_source: str = ""

    def __post_init__(self) -> None:
        super().__post_init__()
        for joint in self._path():
            if (own := self.model.coordinates[joint.coordinate]).bare:
                raise InputError(
                    f"joint {own.name!r} has a spring and no motor, as of a drive that gives way, and a wall "
                    "has no torque there: take it out of the description, and say of the joint that has the "
                    "motor what is behind it: transmission, of --joints FILE as [joints.transmission]"
                )

    @property
    def joint_count(self) -> int:
        return len(self.model.coordinates)

    @property
    def joint_names(self) -> tuple[str, ...]:
        return self.model.names

    @property
    def locked(self) -> tuple[str, ...]:
        """Joints without damping that are held, in words."""
        return self.model.fixed

    @property
    def follows(self) -> bool:
        """Whether joints between base and hand are not those of the arm one for one, in their order."""
        own = [joint.coordinate for joint in self._path()]
        return own != sorted(set(own)) or any(joint.factor != 1 for joint in self._path())

    def forward(self, joints: npt.ArrayLike) -> Array:
        """p (…, 3) [m]."""
        return self._computed(joints)[0]

    def jacobian(self, joints: npt.ArrayLike) -> Array:
        """J (…, 3, m) [m/rad; 1], in the axes of the base."""
        return self._computed(joints)[1]

    @property
    def curvature(self) -> float:
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
        if len(moving) > MOST_MAPPED:
            raise InputError(
                f"a map of cells moves one or two joints, here {len(moving)} would move: hold the others, or "
                "ask for postures, zwidth.stiffness_over_postures or --postures"
            )
        names, units = self.joint_names, ["m" if slides else "rad" for slides in self.sliding]
        axes = tuple(Axis(names[i], units[i], middles(*self.joint_range[i], points)) for i in moving)
        q = np.empty((*[points] * len(moving), self.joint_count))
        q[...] = [low for low, _ in self.joint_range]
        for axis, grid in zip(moving, np.meshgrid(*(a.middles for a in axes), indexing="ij"), strict=True):
            q[..., axis] = grid
        positions, jacobians = self._computed(q)
        halves = np.array([(high - low) / (2 * points) for low, high in self.joint_range])
        words = [
            f"{name} {f'from {low:.4g} to {high:.4g}' if high > low else f'held at {low:.4g}'} {unit}"
            for name, unit, (low, high) in zip(names, units, self.joint_range, strict=True)
        ]
        rates, between = self._rates()
        change = np.full(q.shape[:-1], np.linalg.norm(rates @ halves[between]))
        return Sites(axes, q, positions, jacobians, change, "; ".join([*words, *self.locked]))

    def placed(self, joints: npt.ArrayLike) -> tuple[Array, Array]:
        """Position and Jacobian of `sites` at any joints (…, m): in pose of every rest, or of `rest`."""
        return self._computed(joints)

    def _computed(self, joints: npt.ArrayLike) -> tuple[Array, Array]:
        positions, jacobians = self._placed(joints)
        return positions, jacobians[..., :3, :]

    def _placed(self, joints: npt.ArrayLike) -> tuple[Array, Array]:
        """p (…, 3), and the Jacobians of velocity and angular velocity (…, 6, m)."""
        q = as_joints(joints, self.joint_count)
        at, so_far = np.zeros((*q.shape[:-1], 3)), np.broadcast_to(np.eye(3), (*q.shape[:-1], 3, 3))
        passed = []
        for joint in self._path():
            at = at + so_far @ np.array(joint.at.translation)
            so_far = so_far @ np.array(joint.at.rotation)
            axis = so_far @ np.array(joint.axis)
            passed.append((joint, axis, at))
            value = joint.factor * q[..., joint.coordinate] + joint.offset
            if joint.slides:
                at = at + value[..., None] * axis
            else:
                so_far = so_far @ turned(joint.axis, value)
        position = at + so_far @ np.array(self._frame.at.translation)
        jacobian = np.zeros((*q.shape[:-1], 6, self.joint_count))
        for joint, axis, at in passed:
            moved = axis if joint.slides else np.cross(axis, position - at)
            jacobian[..., :3, joint.coordinate] += joint.factor * moved
            jacobian[..., 3:, joint.coordinate] += 0.0 if joint.slides else joint.factor * axis
        return position, jacobian

    @property
    def _frame(self) -> Frame:
        return self.model.frame(self.frame)

    @property
    def sliding(self) -> tuple[bool, ...]:
        return tuple(each.slides for each in self.model.coordinates)

    def placements(self) -> tuple[list[Placed], Array]:
        """The joints between base and hand, z turned to each axis, and the hand in the last frame [m].

        Of joints that follow others there is no such list: it is of an arm in which `follows` is False.
        """
        joints, before, moved = list[Placed](), np.eye(3), np.zeros(3)
        for joint in self._path():
            turn, axis = _turned_to(np.array(joint.axis)), np.array(joint.axis)
            rotation = before @ np.array(joint.at.rotation) @ turn
            translation = before @ np.array(joint.at.translation) + moved
            joints.append(Placed(joint.coordinate, joint.slides, np.round(rotation, _DIGITS), translation))
            before, moved = turn.T, np.zeros(3)
            if joint.slides:
                moved = joint.offset * np.array([0.0, 0.0, 1.0])
            elif joint.offset:
                before = turn.T @ turned(axis, joint.offset)
        return joints, before @ np.array(self._frame.at.translation) + moved

    def _path(self) -> list[Joint]:
        """The joints between the base and the hand, from the base on."""
        return self.model.path(self._frame)

    def _rates(self) -> tuple[Array, list[int]]:
        """Bounds on |∂²p/∂q_i∂q_j|, and which coordinates move the hand.

        Of two joints: what lies beyond both where both turn, 1 where one slides, else 0; summed over those
        that a coordinate moves, times their factors.
        """
        beyond, length, path = list[float](), float(np.linalg.norm(self._frame.at.translation)), self._path()
        for joint in reversed(path):
            if joint.slides:
                i = joint.coordinate
                travel = max(map(abs, self.joint_range[i])) + (
                    float(self.resolution[i]) if self.resolution else 0.0
                )
                length += abs(joint.factor) * travel + abs(joint.offset)
            beyond.insert(0, length)
            length += float(np.linalg.norm(joint.at.translation))
        sliding = np.array([joint.slides for joint in path], dtype=np.int64)
        each = np.where(np.add.outer(sliding, sliding) == 0, np.minimum.outer(beyond, beyond), 0.0)
        each[np.add.outer(sliding, sliding) == 1] = 1.0
        own = sorted({joint.coordinate for joint in path})
        shares = np.array([[abs(j.factor) * (j.coordinate == i) for i in own] for j in path])
        return shares.T @ each @ shares, own


def _turned_to(axis: Array) -> Array:
    """A rotation that takes z to this unit vector."""
    side = np.eye(3)[int(np.argmin(np.abs(axis)))]
    x = np.cross(side, axis)
    x /= np.linalg.norm(x)
    return np.stack([x, np.cross(axis, x), axis], axis=-1)


# How far a hand has turned: three coordinates that are smooth in the joints, however far it turns.
#
# The unit quaternion Q = (w, v) = (cos φ/2, u sin φ/2) from the orientation in which a wall rests to
# that of the hand, in the axes of the base, follows the angular velocity ω by Q̇ = ½ (0, ω) ⊗ Q.  So
#
#     e = 2 v = 2 sin(φ/2) u,   ė = E ω,   E = w I − [v]×,   EᵀE = I − v vᵀ ⪯ I.
#
# A spring K in e has the energy ½ eᵀK e = 2 vᵀK v and the moment EᵀK e, which is k sin φ about u for
# K = k I: the elastic moment of Caccavale, Natale, Siciliano & Villani (1999).  Along a chain Q is a product
# of constant quaternions and of (cos q/2, a sin q/2), so that it is smooth in all joints and
#
#     |∂e/∂qᵢ| ≤ 1,   |∂²e/∂qᵢ∂qⱼ| ≤ ½.

SECOND_DERIVATIVE = 0.5
"""Of e by two joints that turn: two factors of ½ in Q, and e = 2 v."""


def product(a: Array, b: Array) -> Array:
    """a ⊗ b of quaternions (w, x, y, z), (…, 4)."""
    real = a[..., 0] * b[..., 0] - (a[..., 1:] * b[..., 1:]).sum(axis=-1)
    vector = a[..., :1] * b[..., 1:] + b[..., :1] * a[..., 1:] + np.cross(a[..., 1:], b[..., 1:])
    return np.concatenate([real[..., None], vector], axis=-1)


def inverse(a: Array) -> Array:
    """Of a unit quaternion (…, 4)."""
    return np.asarray(a * np.array([1.0, -1.0, -1.0, -1.0]))


def about(axis: Array, angle: Array) -> Array:
    """(cos q/2, a sin q/2) of a unit vector a and angles (…)."""
    half = np.asarray(angle)[..., None] / 2
    return np.concatenate([np.cos(half), np.sin(half) * axis], axis=-1)


def coordinates(turned: Array) -> Array:
    """e of quaternions (…, 4) → (…, 3) [rad]."""
    return 2 * turned[..., 1:]


def rates(turned: Array, angular: Array) -> Array:
    """∂e/∂q = E J_ω, from the Jacobian of the angular velocity (…, 3, m)."""
    across = np.cross(turned[..., None, 1:], np.swapaxes(angular, -1, -2))
    return np.asarray(turned[..., :1, None] * angular - np.swapaxes(across, -1, -2))


# An arm from a description whose hand holds the frame, and turns with it: six coordinates.
#
#     y = (p, e),   e = 2 sin(φ/2) u   from the orientation in which the wall rests, in the axes of the base
#     ∂y/∂q = (J_p; E J_ω)
#
# The wall renders K y: forces, and in the place of moments those of e, which E of `turn` makes moments;
# whoever computes it keeps the sign of the quaternion from sample to sample.  As EᵀE ⪯ I, a wall as stiff
# about every axis asks for the most at its rest: with (J_p; J_ω) the proof is for every orientation of rest.


@dataclass(frozen=True, kw_only=True)
class PosedArm(DescribedArm):
    """An arm that a file describes, held by its frame; made by `read_arm(…, pose=True)`.

    Parameters
    ----------
    rest
        The joints at which the frame has the orientation in which the wall rests [rad; m]. None: `sites` are
        for every orientation of rest; `forward` and `jacobian` for the middle of the ranges.
    model, frame, damping_source, joint_range, damping, coulomb_friction, resolution, torque_limit, name
        As of `DescribedArm`.

    Raises
    ------
    InputError
        If `rest` has another number of joints.
    """

    rest: Sequence[float] | None = None

    def __post_init__(self) -> None:
        super().__post_init__()
        if self.rest is not None:
            object.__setattr__(self, "rest", tuple(as_joints(self.rest, self.joint_count).tolist()))

    @property
    def turns(self) -> int:
        return 3

    @property
    def turning_curvature(self) -> float:
        """Of e, |Σ ∂²e/∂q_i∂q_j w_i w_j| ≤ ½ (Σ |w_i|)² over the joints that turn the hand [1/rad].

        Of n joints ½ n |w|²; one that moves several counts with the square of the sum of their factors.
        """
        return SECOND_DERIVATIVE * float((self._turning().sum(axis=0) ** 2).sum())

    @property
    def rests_anywhere(self) -> bool:
        """True without `rest`."""
        return self.rest is None

    def resting(self, joints: npt.ArrayLike) -> Arm:
        """With the wall at rest at these joints, unless `rest` says where."""
        return self if self.rest is not None else self.replace(rest=joints)

    def forward(self, joints: npt.ArrayLike) -> Array:
        """y (…, 6) [m, rad]."""
        return self._posed(joints, self._rest())[0]

    def jacobian(self, joints: npt.ArrayLike) -> Array:
        """∂y/∂q (…, 6, m) [m/rad, 1; of a sliding joint 1, 0]."""
        return self._posed(joints, self._rest())[1]

    def sites(self, points: int) -> Sites:
        """As of `DescribedArm`, with a bound of its own for the rows of rotation."""
        sites, turning = super().sites(points), self._turning()
        halves = turning @ np.diff(self.joint_range)[:, 0] / (2 * points)  # of each joint that turns
        if self.rest is None:  # an axis turns with the joints before it, |∂aᵢ/∂qⱼ| ≤ 1 for j < i
            columns, words = np.cumsum(halves) - halves, "in every orientation of rest of the wall"
        else:
            columns = np.full(len(turning), SECOND_DERIVATIVE * halves.sum())
            values = ", ".join(f"{value:.4g}" for value in self.rest)
            words = f"the rotation of the wall at rest with the joints at {values}"
        columns = turning.T @ columns
        turned = np.full_like(sites.change, np.linalg.norm(columns))
        return sites._replace(
            change=np.hypot(sites.change, turned),
            parts=np.stack([sites.change, turned], axis=-1),
            region=f"{sites.region}; {words}",
        )

    def _rest(self) -> npt.ArrayLike:
        return self.rest if self.rest is not None else np.mean(self.joint_range, axis=1)

    def _computed(self, joints: npt.ArrayLike) -> tuple[Array, Array]:
        return self._posed(joints, self.rest)

    def _posed(self, joints: npt.ArrayLike, rest: npt.ArrayLike | None) -> tuple[Array, Array]:
        """y and ∂y/∂q; without a rest as at the rest itself, where e = 0 and E = I."""
        positions, full = self._placed(joints)
        turned = np.broadcast_to([1.0, 0.0, 0.0, 0.0], (*positions.shape[:-1], 4))
        if rest is not None:
            turned = product(self._quaternion(joints), inverse(self._quaternion(rest)))
        return (
            np.concatenate([positions, coordinates(turned)], axis=-1),
            np.concatenate([full[..., :3, :], rates(turned, full[..., 3:, :])], axis=-2),
        )

    def _quaternion(self, joints: npt.ArrayLike) -> Array:
        """Of the frame, without a jump of its sign between any two positions (…, 4)."""
        q = as_joints(joints, self.joint_count)
        turned = np.broadcast_to(_unit(self._frame.at), (*q.shape[:-1], 4))
        for joint in reversed(self._path()):
            if not joint.slides:
                value = joint.factor * q[..., joint.coordinate] + joint.offset
                turned = product(about(np.array(joint.axis), value), turned)
            turned = product(_unit(joint.at), turned)
        return turned

    def _turning(self) -> Array:
        """|factor| of each joint that turns the hand, from the base on, by the coordinate that moves it."""
        path = [joint for joint in self._path() if not joint.slides]
        rows = [[abs(j.factor) * (j.coordinate == i) for i in range(self.joint_count)] for j in path]
        return np.array(rows).reshape(len(path), self.joint_count)


def _unit(at: Placement) -> Array:
    from scipy.spatial.transform import Rotation

    x, y, z, w = Rotation.from_matrix(at.rotation).as_quat()
    return np.array([w, x, y, z])
