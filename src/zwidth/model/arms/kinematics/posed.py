"""An arm from a description whose hand holds the frame, and turns with it: six coordinates.

    y = (p, e),   e = 2 sin(φ/2) u   from the orientation in which the wall rests, in the axes of the base
    ∂y/∂q = (J_p; E J_ω)

The wall renders K y: forces, and in the place of moments those of e, which E of `turn` makes moments;
whoever computes it keeps the sign of the quaternion from sample to sample.  As EᵀE ⪯ I, a wall as stiff
about every axis asks for the most at its rest: with (J_p; J_ω) the proof is for every orientation of rest.
"""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass

import numpy as np
import numpy.typing as npt

from zwidth.model.arms.kinematics.arm import Arm, Array, Sites, as_joints
from zwidth.model.arms.kinematics.described import DescribedArm
from zwidth.model.arms.kinematics.mechanism import Placement
from zwidth.model.arms.kinematics.turn import SECOND_DERIVATIVE, about, coordinates, inverse, product, rates


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
        """3."""
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
