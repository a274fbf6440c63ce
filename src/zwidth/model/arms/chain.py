"""Links in a row that turn in one plane: a paddle, a two-link arm, a redundant finger.

    p = Σ_k l_k (cos φ_k, sin φ_k),   φ_k = q_1 + … + q_k
    ∂p/∂q_i = Σ_{k ≥ i} l_k (−sin φ_k, cos φ_k)

In pose the angle of the last link, φ_m, is the third coordinate.

The Hapkit or any paddle is the chain of one link.  Between two positions the Jacobian cannot change quickly:
the derivative of column i by joint j is the vector from joint max(i, j) to the end turned by 180°, never
longer than the links that lie beyond that joint.
"""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass
from math import pi, prod
from typing import NamedTuple

import numpy as np
import numpy.typing as npt

from zwidth.errors import InputError
from zwidth.model.arms.arm import Arm, Array, Axis, Sites, as_joints, middles
from zwidth.quantity.text import from_to

_MOST_CELLS = 2_000_000
"""Beyond three joints a grid outgrows the memory."""


class Placed(NamedTuple):
    """Where a joint is in the frame of the one before it; it turns about, or slides along, its own z axis.

    p_i = t_i + C_i (Rot_z(q_i) p_{i+1} or p_{i+1} + q_i ẑ), `translation` t_i [m] and `rotation` C_i.
    """

    joint: int  # its place among those of the arm, from 0
    slides: bool
    rotation: Array
    translation: Array


@dataclass(frozen=True, kw_only=True)
class PlanarChain(Arm):
    """A planar chain of revolute joints.

    Parameters
    ----------
    links
        Lengths l_k > 0 [m], from the base to the hand.
    joint_range
        (low, high) of each joint [rad], its region of work; empty: a full
        turn of the first joint, and of the others 0 to π.
    pose
        The hand holds the last link and turns with it: (x, y, angle). Default: it holds a point.
    damping, coulomb_friction, resolution, torque_limit, name
        As of `Arm`, [N·m·s/rad], [N·m], [rad], [N·m].

    Raises
    ------
    InputError
        If a length is not positive, or a range is empty.
    """

    links: Sequence[float]
    joint_range: Sequence[tuple[float, float]] = ()
    pose: bool = False

    def __post_init__(self) -> None:
        links = tuple(float(length) for length in self.links)
        if not links or not all(0 < length < np.inf for length in links):
            raise InputError(f"links must be lengths > 0 m, one at least; got {links}")
        object.__setattr__(self, "links", links)
        super().__post_init__()
        ranges = tuple((float(a), float(b)) for a, b in self.joint_range)
        ranges = ranges or ((-pi, pi), *[(0.0, pi)] * (len(links) - 1))
        if len(ranges) != len(links) or not all(-np.inf < a < b < np.inf for a, b in ranges):
            raise InputError(f"joint_range: (low, high) with low < high for each of {len(links)} joints")
        object.__setattr__(self, "joint_range", ranges)

    @property
    def joint_count(self) -> int:
        return len(self.links)

    @property
    def joint_names(self) -> tuple[str, ...]:
        return tuple(f"q{i + 1}" for i in range(self.joint_count))

    @property
    def turns(self) -> int:
        """1 in pose."""
        return int(self.pose)

    def forward(self, joints: npt.ArrayLike) -> Array:
        """p (…, 2) [m]; in pose (x, y, angle) [m, m, rad]."""
        q = as_joints(joints, self.joint_count)
        point = self._links(q).sum(axis=-2)
        return np.concatenate([point, q.sum(axis=-1, keepdims=True)], axis=-1) if self.pose else point

    def jacobian(self, joints: npt.ArrayLike) -> Array:
        """J (…, 2, m) [m/rad]; in pose a row of ones more."""
        q = as_joints(joints, self.joint_count)
        arms = np.cumsum(self._links(q)[..., ::-1, :], axis=-2)[..., ::-1, :]  # from joint i to the end
        rows = [-arms[..., 1], arms[..., 0]] + [np.ones_like(q)] * self.turns
        return np.stack(rows, axis=-2)

    def placements(self) -> tuple[list[Placed], Array]:
        """Each joint at the end of the link before it, and the hand in the frame of the last one [m]."""
        before, along = (0.0, *self.links), np.array([1.0, 0.0, 0.0])
        joints = [Placed(i, False, np.eye(3), before[i] * along) for i in range(self.joint_count)]
        return joints, self.links[-1] * along

    def sites(self, points: int) -> Sites:
        """Equal cells of the joint range."""
        count = points if self.joint_count < 3 else max(2, round(points ** (2 / self.joint_count)))
        if prod([count] * self.joint_count) > _MOST_CELLS:
            raise InputError(
                f"{self.joint_count} joints make too many cells; give fewer points or a shorter chain"
            )
        axes = tuple(
            Axis(f"q{i + 1}", "rad", middles(low, high, count))
            for i, (low, high) in enumerate(self.joint_range)
        )
        q = np.stack(np.meshgrid(*(a.middles for a in axes), indexing="ij"), axis=-1)
        halves = np.array([(high - low) / (2 * count) for low, high in self.joint_range])
        change = np.full(q.shape[:-1], np.linalg.norm(self.second_derivatives @ halves))
        return Sites(
            axes,
            q,
            self.forward(q),
            self.jacobian(q),
            change,
            "; ".join(f"q{i + 1} from {from_to(*ends, 'rad')}" for i, ends in enumerate(self.joint_range)),
            np.stack([change, np.zeros_like(change)], axis=-1) if self.pose else None,
        )

    @property
    def curvature(self) -> float:
        return float(np.linalg.eigvalsh(self.second_derivatives)[-1])

    @property
    def second_derivatives(self) -> Array:
        """Bounds on |∂²p/∂q_i∂q_j|, the links beyond joint max(i, j), m × m [m/rad²]."""
        beyond = np.cumsum(self.links[::-1])[::-1]
        return np.asarray(np.minimum.outer(beyond, beyond))

    @property
    def turning_curvature(self) -> float | None:
        """0 in pose: the angle is the sum of the joints."""
        return 0.0 if self.pose else None

    def _links(self, q: Array) -> Array:
        bearing = np.cumsum(q, axis=-1)
        return np.asarray(
            np.stack([np.cos(bearing), np.sin(bearing)], axis=-1) * np.array(self.links)[:, None]
        )
