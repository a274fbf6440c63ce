"""How far a hand has turned: three coordinates that are smooth in the joints, however far it turns.

The unit quaternion Q = (w, v) = (cos φ/2, u sin φ/2) from the orientation in which a wall rests to
that of the hand, in the axes of the base, follows the angular velocity ω by Q̇ = ½ (0, ω) ⊗ Q.  So

    e = 2 v = 2 sin(φ/2) u,   ė = E ω,   E = w I − [v]×,   EᵀE = I − v vᵀ ⪯ I.

A spring K in e has the energy ½ eᵀK e = 2 vᵀK v and the moment EᵀK e, which is k sin φ about u for
K = k I: the elastic moment of Caccavale, Natale, Siciliano & Villani (1999).  Along a chain Q is a product
of constant quaternions and of (cos q/2, a sin q/2), so that it is smooth in all joints and

    |∂e/∂qᵢ| ≤ 1,   |∂²e/∂qᵢ∂qⱼ| ≤ ½.
"""

from __future__ import annotations

import numpy as np
import numpy.typing as npt

Array = npt.NDArray[np.float64]

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
