"""The damping of the joints: what of it the hand feels, and the least that must be added.

From the damping of the joints to the hand, and back.

    design rule     δ_m ⪰ Jᵀ R J           ⇔  the hand feels at least R in every direction
    at the hand     δ = (J δ_m⁻¹ Jᵀ)⁻¹     = J⁻ᵀ δ_m J⁻¹ where J is square

The rule is Theorem 3 of Miller, Colgate & Freeman (2004), with J of any shape.  Their equation (24), (Jᵀ)†
δ_m J†, is the same where J is square, or where it has more rows than columns and the hand moves as the joints
let it.  With more joints than coordinates it supposes that the joints move by J†v, the least sum of squares;
joints left to themselves choose the least loss, which is less: (J δ_m⁻¹ Jᵀ)⁻¹ ⪯ (Jᵀ)† δ_m J†, and only the
left side is equivalent to the rule.  Near a singular position the rule becomes easier, as they say.
"""

from __future__ import annotations

from itertools import product

import numpy as np
import numpy.typing as npt

from zwidth.errors import InputError
from zwidth.quantity.exact import RealLike
from zwidth.quantity.parameter import read_number

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


def sampled_jacobian_damping(curvature: float, largest_force: RealLike, sample_period: RealLike) -> float:
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
    most = read_number(largest_force, "force", "largest_force", bound="≥ 0", why="it is a size")
    period = read_number(
        sample_period, "sample_period", "sample_period", bound="> 0", why="a step takes time"
    )
    if curvature < 0:
        raise InputError(f"curvature must be ≥ 0, got {curvature:g}: it is a bound")
    return curvature * float(most) * float(period) / 2


def as_matrix(damping: npt.ArrayLike) -> Array:
    """δ_m, from one number for each joint or the matrix itself."""
    b = np.asarray(damping, dtype=np.float64)
    return np.diag(b) if b.ndim == 1 else b


# Which joints to damp, and by how much, for the least damping in all.
#
#     minimise Σ tᵢ   over t ≥ 0 with M_c + diag(t) ⪰ 0 for every cell c
#
# This is a semidefinite programme.  Every unit vector u asks for Σ uᵢ² tᵢ ≥ −uᵀM_c u, and all of them
# together ask for no less than the programme: so linear programmes over some of these cuts bound the sum
# from below, and the eigenvectors in which their answer still fails are the next cuts (Kelley 1960).
# What the last answer lacks, and room for rounding, is given to every joint.

_GAP = 1e-7
"""Of the sum: how much more than the least is given."""
_NOISE = 1e-14
"""Of the largest entry: what lies below it is noise of the eigenvalues."""
_ROUNDS = 200
_AT_ONCE = 10
"""Cells that join in one round, those first that fail most."""


def least_additions(matrices: Array) -> tuple[Array, float]:
    """The damping t ≥ 0 of the least sum that makes every matrix M + diag(t) ⪰ 0.

    Parameters
    ----------
    matrices
        M_c, symmetric (cells, m, m) [N·m·s/rad].

    Returns
    -------
    tuple
        t (m) [N·m·s/rad], and a bound below which no sum is [N·m·s/rad].
    """
    worst = -float(np.linalg.eigvalsh(matrices)[:, 0].min())
    joints = matrices.shape[-1]
    if worst <= 0:
        return np.zeros(joints), 0.0
    scaled = matrices / worst
    cuts, sides, added, bound = np.empty((0, joints)), np.empty(0), np.zeros(joints), 0.0
    chosen = np.empty(0, dtype=np.intp)
    for _ in range(_ROUNDS):
        lowest = np.linalg.eigvalsh(scaled + np.diag(added))[:, 0]
        if -lowest.min() <= _enough(scaled, added):
            break
        failing = np.argsort(lowest)[:_AT_ONCE]
        chosen = np.union1d(chosen, failing[lowest[failing] < 0])
        added, bound, cuts, sides = _settled(scaled[chosen], cuts, sides, added)
    lacking = max(0.0, -float(np.linalg.eigvalsh(scaled + np.diag(added))[:, 0].min()))
    added = added + lacking + _noise(scaled, added)
    return worst * added, worst * bound


def _settled(matrices: Array, cuts: Array, sides: Array, added: Array) -> tuple[Array, float, Array, Array]:
    """The answer for a few matrices, a bound on its sum, and the cuts that show it."""
    bound = 0.0
    for _ in range(_ROUNDS):
        values, vectors = np.linalg.eigh(matrices + np.diag(added))
        if -values.min() <= _enough(matrices, added) / 2:
            break
        failing = np.swapaxes(vectors, -1, -2)[values < 0]
        which = np.nonzero(values < 0)[0]
        cuts = np.concatenate([cuts, failing**2])
        sides = np.concatenate([sides, -np.einsum("ki,kij,kj->k", failing, matrices[which], failing)])
        added, bound = _over(cuts, sides)
    return added, bound, cuts, sides


def _enough(matrices: Array, added: Array) -> float:
    """What may be lacking in every joint, to be given to each."""
    return max(_GAP * float(added.mean()), _noise(matrices, added))


def _noise(matrices: Array, added: Array) -> float:
    return _NOISE * (float(np.abs(matrices).max()) + float(added.max()))


def _over(cuts: Array, sides: Array) -> tuple[Array, float]:
    """The least t ≥ 0 over the cuts; its multipliers say below what no sum is, however it rounds."""
    from scipy.optimize import linprog  # scipy takes its time

    exact = {"primal_feasibility_tolerance": 1e-10, "dual_feasibility_tolerance": 1e-10}
    found = linprog(np.ones(cuts.shape[1]), A_ub=-cuts, b_ub=-sides, method="highs", options=exact)
    multipliers = np.maximum(-found.ineqlin.marginals, 0.0)
    return np.maximum(found.x, 0.0), float(multipliers @ sides / max(1.0, (multipliers @ cuts).max()))
