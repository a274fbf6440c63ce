"""From the damping of the joints to the hand, and back.

    design rule     δ_m ⪰ Jᵀ R J           ⇔  the hand feels at least R in every direction
    at the hand     δ = (J δ_m⁻¹ Jᵀ)⁻¹     = J⁻ᵀ δ_m J⁻¹ where J is square

The rule is Theorem 3 of Miller, Colgate & Freeman (2004), with J of any shape.  Their
equation (24), (Jᵀ)† δ_m J†, is the same where J is square, or where it has more rows
than columns and the hand moves as the joints let it.  With more joints than coordinates
it supposes that the joints move by J†v, the least sum of squares; joints left to themselves
choose the least loss, which is less: (J δ_m⁻¹ Jᵀ)⁻¹ ⪯ (Jᵀ)† δ_m J†, and only the left side
is equivalent to the rule.  Near a singular position the rule becomes easier, as they say.
"""

from __future__ import annotations

from itertools import product

import numpy as np
import numpy.typing as npt

from zwidth.errors import InputError

Array = npt.NDArray[np.float64]

_ROUNDING = 1e-13
"""Of the largest eigenvalue: a smallest one below this is none, and Cholesky's root is not taken."""


def end_effector_damping(
    jacobian: npt.ArrayLike, damping: npt.ArrayLike, as_published: bool = False
) -> Array:
    """δ, the damping that a hand feels which moves the end, n × n [N·s/m].

    In directions in which the arm cannot move, δ is 0 here: the hand cannot move there either.
    In pose its blocks are in N·s/m, N·s/rad and N·m·s/rad.

    Parameters
    ----------
    jacobian
        J, n × m [m/rad].
    damping
        b_i > 0 of each joint, or the matrix δ_m ≻ 0 [N·m·s/rad].
    as_published
        True for (Jᵀ)† δ_m J†, which is more where the arm is redundant.
    """
    j, delta = np.asarray(jacobian, dtype=np.float64), as_matrix(damping)
    if as_published:
        inverse = np.linalg.pinv(j)
        return np.asarray(inverse.T @ delta @ inverse)
    if np.linalg.eigvalsh(delta)[0] <= 0:
        raise InputError("every joint needs damping > 0: what moves without loss gives the hand none")
    return np.asarray(np.linalg.pinv(j @ np.linalg.solve(delta, j.T), hermitian=True))


def joint_margin(jacobian: Array, damping: npt.ArrayLike, need: Array) -> tuple[Array, Array]:
    """The smallest eigenvalue of δ_m − JᵀRJ [N·m·s/rad], and its direction (…, m) in the joints.

    Parameters
    ----------
    jacobian
        J (…, n, m) [m/rad].
    damping
        b_i of each joint, or the matrix δ_m [N·m·s/rad].
    need
        R, n × n, from `wall_need` [N·s/m].
    """
    values, vectors = np.linalg.eigh(surplus(jacobian, damping, need))
    return values[..., 0], vectors[..., :, 0]


def surplus(jacobian: Array, damping: npt.ArrayLike, need: Array) -> Array:
    """δ_m − JᵀRJ (…, m, m) [N·m·s/rad]."""
    return np.asarray(as_matrix(damping) - np.swapaxes(jacobian, -1, -2) @ need @ jacobian)


def single_additions(matrices: Array) -> Array:
    """The damping that, given to joint i alone, makes a symmetric matrix ⪰ 0 (…, m); ∞ where none does."""
    return np.stack([single_addition(matrices, i) for i in range(matrices.shape[-1])], axis=-1)


def single_addition(matrices: Array, joint: int) -> Array:
    """The damping that, given to one joint alone, makes a symmetric matrix ⪰ 0 (…); ∞ where none does.

    A matrix with M + t eᵢeᵢᵀ ⪰ 0 for some t has the rest of it, without row i, ⪰ 0; and then
    t is what its Schur complement lacks.
    """
    m = matrices.shape[-1]
    rest = [k for k in range(m) if k != joint]
    own, row = matrices[..., joint, joint], matrices[..., joint, rest]
    others = matrices[..., rest, :][..., rest]
    good = np.linalg.eigvalsh(others)[..., 0] > 0 if rest else np.ones(own.shape, dtype=bool)
    safe = np.where(good[..., None, None], others, np.eye(m - 1))
    taken = (row * np.linalg.solve(safe, row[..., None])[..., 0]).sum(axis=-1)
    return np.where(good, np.maximum(taken - own, 0.0), np.inf)


def largest_scale(base: Array, load: Array) -> Array:
    """The largest s ≥ 0 with base − s·load ⪰ 0 (…), for load ⪰ 0; 0 where base is not ≻ 0, ∞ without load."""
    values = np.linalg.eigvalsh(base)
    positive = values[..., 0] > _ROUNDING * np.abs(values[..., -1])
    safe = np.where(positive[..., None, None], base, np.eye(base.shape[-1]))
    root = np.linalg.inv(np.linalg.cholesky(safe))
    most = np.linalg.eigvalsh(root @ load @ np.swapaxes(root, -1, -2))[..., -1]
    with np.errstate(divide="ignore"):
        return np.where(positive, np.where(most > 0, 1 / np.maximum(most, 0.0), np.inf), 0.0)


def end_effector_resolution(
    jacobian: Array, resolution: npt.ArrayLike, direction: npt.ArrayLike | None = None
) -> Array:
    """What one step of every encoder moves the reading at the hand by, at most (…) [m].

    The readings that stand for one position fill the zonotope J·[0, Δ]; this is its width
    Σᵢ |u·Jᵢ| Δᵢ in a direction u, or its largest width.  In pose give the rows of the translation or
    those of the rotation, [rad]: a width across metres and radians has no unit.
    """
    steps = np.asarray(jacobian) * np.asarray(resolution, dtype=np.float64)
    if direction is not None:
        u = np.asarray(direction, dtype=np.float64)
        return np.asarray(np.abs(np.einsum("n,...nm->...m", u / np.linalg.norm(u), steps)).sum(axis=-1))
    m = steps.shape[-1]
    corners = np.array([(1.0, *signs) for signs in product((-1.0, 1.0), repeat=m - 1)])
    return np.asarray(np.linalg.norm(steps @ corners.T, axis=-2).max(axis=-1))


def end_effector_friction(
    jacobian: Array, friction: npt.ArrayLike, direction: npt.ArrayLike | None = None
) -> Array:
    """The largest force of the hand that Coulomb friction holds (…) [N].

    The forces that move no joint are those with |Jᵢ·F| ≤ f_c,i; along a direction u they end at
    min f_c,i/|Jᵢ·u|, and in the weakest direction at min f_c,i/|Jᵢ|.  In pose give the rows of the
    translation, of forces without a moment, or those of the rotation, of moments without a force [N·m].
    """
    j, f = np.asarray(jacobian, dtype=np.float64), np.asarray(friction, dtype=np.float64)
    if direction is None:
        lever = np.linalg.norm(j, axis=-2)
    else:
        u = np.asarray(direction, dtype=np.float64)
        lever = np.abs(np.einsum("n,...nm->...m", u / np.linalg.norm(u), j))
    with np.errstate(divide="ignore", invalid="ignore"):
        return np.asarray(np.where(lever > 0, f / lever, np.inf).min(axis=-1))


def end_effector_inertia(jacobian: npt.ArrayLike, inertia: npt.ArrayLike) -> Array:
    """(J M⁻¹ Jᵀ)⁻¹, the mass that the hand feels, n × n [kg]; 0 where the arm cannot move.

    In pose its blocks are in kg, kg·m and kg·m².

    Parameters
    ----------
    jacobian
        J, n × m [m/rad].
    inertia
        M(q) ≻ 0, m × m [kg·m²].
    """
    j = np.asarray(jacobian, dtype=np.float64)
    return np.asarray(np.linalg.pinv(j @ np.linalg.solve(np.asarray(inertia), j.T), hermitian=True))


def sampled_jacobian_damping(curvature: float, largest_force: float, sample_period: float) -> float:
    """What a controller that holds the torques J(q_k)ᵀF, not the force, asks of every joint: h F T/2.

    Over a period the two differ in work by F·(p(q_{k+1}) − p(q_k) − J(q_k)Δq) ≤ ½ h F |Δq|², and
    c in every joint takes c |Δq|²/T.

    Parameters
    ----------
    curvature
        h, `Arm.curvature` [m/rad²].
    largest_force
        The largest force that the wall renders [N].
    sample_period
        T [s].

    Returns
    -------
    float
        c, to be added to the need of every joint [N·m·s/rad].
    """
    if min(curvature, largest_force) < 0 or sample_period <= 0:
        raise InputError("curvature and largest_force must be ≥ 0, and sample_period > 0 s")
    return curvature * largest_force * sample_period / 2


def as_matrix(damping: npt.ArrayLike) -> Array:
    """δ_m, from one number for each joint or the matrix itself."""
    b = np.asarray(damping, dtype=np.float64)
    return np.diag(b) if b.ndim == 1 else b
