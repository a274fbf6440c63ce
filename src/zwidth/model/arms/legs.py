"""Arms in parallel: five-bar pantographs, delta robots, the Falcon.

Every leg has a motor that turns a link of length l in a plane (u, w); its end, the elbow, holds the hand by a
rod.  With p′ = p − a seen from the motor and v̂ = w × u the normal of the plane,

    (p′_u − l cos θ)² + (p′_w − l sin θ)² = ℓ²,   ℓ = D + √(b² − p′_v²).

D = 0: a rod of length b, and the leg of a delta robot; p′_v = 0: a planar pantograph.
D > 0: a parallelogram whose hinges stand off by D in all (Tsai & Stamper 1996; the
Falcon).  Each leg is solved by itself, and so is its gradient:

    ∇θ = n / (n · e′),   n = (p′ − e) in the plane + ℓ p′_v/√(b² − p′_v²) v̂,   J = (∇θ₁, …)ᵀ⁻¹
"""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass
from typing import NamedTuple

import numpy as np
import numpy.typing as npt

from zwidth.errors import InputError
from zwidth.model.arms.arm import Arm, Array, Axis, Sites, as_joints, middles
from zwidth.quantity.text import from_to, shown

_NEWTON_STEPS = 60
_REACHED = 1e-12
"""Of the largest angle error at which the forward problem is solved [rad]."""
_LAYER = 1 / 400
"""Half the thickness of a layer in space, of the width of the region."""
_ANGLES = (1.03, 1.1, 1.3, 3.0)
"""How much more than to first order the angle of a leg may change in a cell; the best bound counts."""


@dataclass(frozen=True, kw_only=True)
class Leg:
    """One leg of a parallel arm.

    Parameters
    ----------
    base
        a: the axis of the motor less the offset of the joint at the hand [m].
    out, up
        Unit vectors u, w of the plane in which the link turns; θ = 0 along u.
    link, rod
        Lengths l and b [m].
    offset
        D ≥ 0, what the hinges of the rod add in the plane [m]. Default 0.
    bend
        −1 or +1: which of the two elbows; θ = bearing of the hand + bend · γ.
    """

    base: Sequence[float]
    out: Sequence[float]
    up: Sequence[float]
    link: float
    rod: float
    offset: float = 0.0
    bend: int = -1

    def __post_init__(self) -> None:
        for key in ("base", "out", "up"):
            object.__setattr__(self, key, tuple(float(v) for v in getattr(self, key)))
        if not (0 < self.link < np.inf and 0 < self.rod < np.inf and 0 <= self.offset < np.inf):
            raise InputError("link and rod must be > 0 m and offset ≥ 0: they are lengths")
        if self.bend not in (-1, 1):
            raise InputError(f"bend is −1 or +1, the side on which the elbow is; got {self.bend}")
        frame = np.array([self.out, self.up], dtype=np.float64)
        if frame.shape[1] != len(self.base) or not np.allclose(frame @ frame.T, np.eye(2), atol=1e-9):
            raise InputError("out and up must be unit vectors at right angles, as long as base")


class Posture(NamedTuple):
    """A leg at a point: its angle, and what the bounds are made of."""

    angle: Array
    normal: Array  # n (…, dim)
    lever: Array  # n · e′, 0 where the leg is stretched
    aside: Array  # p′_v
    length: Array  # ℓ


@dataclass(frozen=True, kw_only=True)
class LeggedArm(Arm):
    """A parallel arm: as many legs as the hand has coordinates.

    Parameters
    ----------
    legs
        Two legs in the plane, or three in space.
    lower, upper
        Opposite corners of the region of work [m]; in space the grid is a
        thin layer half way between the lower and the upper height.
    damping, coulomb_friction, resolution, torque_limit, name
        As of `Arm`, of the motors' axes.

    Raises
    ------
    InputError
        If legs and coordinates do not match, or the region is empty.
    """

    legs: Sequence[Leg]
    lower: Sequence[float]
    upper: Sequence[float]

    def __post_init__(self) -> None:
        object.__setattr__(self, "legs", tuple(self.legs))
        super().__post_init__()
        dim = len(self.legs)
        if dim not in (2, 3) or any(len(leg.base) != dim for leg in self.legs):
            raise InputError("a parallel arm has two legs in the plane or three in space")
        low, high = np.asarray(self.lower, dtype=np.float64), np.asarray(self.upper, dtype=np.float64)
        if low.shape != (dim,) or high.shape != (dim,) or not (low[:2] < high[:2]).all():
            raise InputError(
                f"lower and upper are the corners of the region, {dim} coordinates each [m], lower < upper"
            )
        object.__setattr__(self, "lower", tuple(map(float, low)))
        object.__setattr__(self, "upper", tuple(map(float, high)))

    @property
    def joint_count(self) -> int:
        return len(self.legs)

    def inverse(self, positions: npt.ArrayLike) -> Array:
        """The angles at a point, (…, n) → (…, n) [rad]; NaN where a leg does not reach."""
        p = np.asarray(positions, dtype=np.float64)
        return np.stack([posture(leg, p).angle for leg in self.legs], axis=-1)

    def gradients(self, positions: npt.ArrayLike) -> Array:
        """J⁻¹ = ∂θ/∂p at a point (…, n, n) [rad/m]."""
        p = np.asarray(positions, dtype=np.float64)
        rows = [posture(leg, p) for leg in self.legs]
        return np.stack([r.normal / r.lever[..., None] for r in rows], axis=-2)

    def forward(self, joints: npt.ArrayLike) -> Array:
        """The point with these angles, next to the middle of the region, by Newton's method; else NaN."""
        q = as_joints(joints, self.joint_count)
        p = np.broadcast_to((np.asarray(self.lower) + self.upper) / 2, q.shape).copy()
        with np.errstate(invalid="ignore", divide="ignore"):
            for _ in range(_NEWTON_STEPS):
                short = q - self.inverse(p)
                if not np.nanmax(np.abs(short), initial=0.0) > _REACHED:
                    break
                p = p + np.einsum("...ij,...j->...i", _inverted(self.gradients(p)), short)
            p[np.abs(q - self.inverse(p)).max(axis=-1) > 1e3 * _REACHED] = np.nan
        return p

    def jacobian(self, joints: npt.ArrayLike) -> Array:
        """J (…, n, n) [m/rad]; NaN where the arm does not reach or gives way."""
        return _inverted(self.gradients(self.forward(joints)))

    def box(self) -> tuple[Array, Array]:
        """Opposite corners of what the cells cover [m]: in space, of one thin layer."""
        low, high = np.array(self.lower), np.array(self.upper)
        if len(low) == 3:
            middle, thick = (low[2] + high[2]) / 2, _LAYER * (high[0] - low[0])
            low[2], high[2] = middle - thick, middle + thick
        return low, high

    def sites(self, points: int) -> Sites:
        """Equal cells of the region; in space, of one thin layer."""
        low, high = np.asarray(self.lower), np.asarray(self.upper)
        x, y = middles(low[0], high[0], points), middles(low[1], high[1], points)
        halves = [(high[k] - low[k]) / (2 * points) for k in (0, 1)]
        axes = (Axis("x", "m", x), Axis("y", "m", y))
        coordinates = list(np.meshgrid(x, y, indexing="ij"))
        words = f"x from {from_to(low[0], high[0], 'm')}, y from {from_to(low[1], high[1], 'm')}"
        if len(low) == 3:
            z, thick = (low[2] + high[2]) / 2, _LAYER * float(high[0] - low[0])
            coordinates.append(np.full_like(coordinates[0], z))
            halves.append(thick)
            words += f", z = {shown(z, 'm')} ± {shown(thick, 'm', 2)}"
        p = np.stack(coordinates, axis=-1)
        radius = float(np.linalg.norm(halves))
        rows = [posture(leg, p) for leg in self.legs]
        with np.errstate(invalid="ignore", divide="ignore"):
            gradients = np.stack([r.normal / r.lever[..., None] for r in rows], axis=-2)
            jacobians = _inverted(gradients)
            parts = [gradient_change(leg, r, radius) for leg, r in zip(self.legs, rows, strict=True)]
            change = _inverse_change(jacobians, np.sqrt(sum(part**2 for part in parts)))
        angles = np.stack([r.angle for r in rows], axis=-1)
        outside = np.asarray(~np.isfinite(jacobians).all(axis=(-1, -2)))
        positions = np.where(outside[..., None], np.nan, p)
        return Sites(axes, angles, positions, jacobians, np.where(outside, np.inf, change), words)


def posture(leg: Leg, p: Array) -> Posture:
    """Solve one leg; NaN where it does not reach."""
    out, up = np.asarray(leg.out), np.asarray(leg.up)
    seen = p - np.asarray(leg.base)
    along, high = seen @ out, seen @ up
    normal_axis = np.cross(up, out) if len(out) == 3 else np.zeros(2)
    aside = seen @ normal_axis
    with np.errstate(invalid="ignore", divide="ignore"):
        root = np.sqrt(leg.rod**2 - aside**2)
        length = leg.offset + root
        distance = np.hypot(along, high)
        gamma = np.arccos((distance**2 + leg.link**2 - length**2) / (2 * distance * leg.link))
        angle = np.arctan2(high, along) + leg.bend * gamma
        dx, dy = along - leg.link * np.cos(angle), high - leg.link * np.sin(angle)
        normal = dx[..., None] * out + dy[..., None] * up + (length * aside / root)[..., None] * normal_axis
        lever = leg.link * (dy * np.cos(angle) - dx * np.sin(angle))
    return Posture(angle, normal, lever, aside, length)


def gradient_change(leg: Leg, at: Posture, radius: float) -> Array:
    """A bound on |∇θ(p) − ∇θ| for |p − p₀| ≤ r; ∞ where none follows.

    As long as |θ − θ₀| ≤ t the elbow has moved by no more than l t, so that n moves by
    no more than N = g r + l t and the lever by L = l (r + l t) + (ℓ + r + l t) l t: if the lever
    stays positive and r (|n| + N)/(|lever| − L) ≤ t, then |θ − θ₀| cannot leave t.
    """
    tries = [_change_within(leg, at, radius, t) for t in _ANGLES]
    return np.asarray(np.minimum.reduce(tries))


def _change_within(leg: Leg, at: Posture, radius: float, times: float) -> Array:
    """The bound with t = `times` r |∇θ|."""
    low = np.sqrt(np.maximum(leg.rod**2 - (np.abs(at.aside) + radius) ** 2, 0.0))
    with np.errstate(invalid="ignore", divide="ignore", over="ignore"):
        # n moves with p at rate 1 in the plane, and across it at rate 1 + D b²/√(b² − p′_v²)³.
        rate = 1 + leg.offset * leg.rod**2 / low**3
        size, lever = np.linalg.norm(at.normal, axis=-1), np.abs(at.lever)
        t = times * radius * size / lever
        n_change = rate * radius + leg.link * t
        in_plane = at.length + radius + leg.link * t
        lever_change = leg.link * (radius + leg.link * t) + in_plane * leg.link * t
        least = lever - lever_change
        inside = (least > 0) & ((size + n_change) * radius <= t * least) & (low > 0)
        bound = n_change / least + size * lever_change / (lever * least)
    return np.where(inside, bound, np.inf)


def _inverse_change(jacobians: Array, change: Array) -> Array:
    """‖J − J₀‖ ≤ ‖J₀‖² ε/(1 − ‖J₀‖ ε) where ‖J⁻¹ − J₀⁻¹‖ ≤ ε."""
    size = np.sqrt((jacobians**2).sum(axis=(-1, -2)))
    room = 1 - size * change
    return np.where(room > 0, size**2 * change / np.where(room > 0, room, 1.0), np.inf)


def _inverted(matrices: Array) -> Array:
    """The inverses, NaN where a matrix is singular or not a number."""
    good = np.asarray(np.isfinite(matrices).all(axis=(-1, -2)))
    good &= np.abs(np.linalg.det(np.where(good[..., None, None], matrices, 0.0))) > 0
    inverse = np.linalg.inv(np.where(good[..., None, None], matrices, np.eye(matrices.shape[-1])))
    return np.where(good[..., None, None], inverse, np.nan)
