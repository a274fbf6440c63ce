"""Which joints to damp, and by how much, for the least damping in all.

    minimise Σ tᵢ   over t ≥ 0 with M_c + diag(t) ⪰ 0 for every cell c

This is a semidefinite programme.  Every unit vector u asks for Σ uᵢ² tᵢ ≥ −uᵀM_c u, and all of them
together ask for no less than the programme: so linear programmes over some of these cuts bound the sum
from below, and the eigenvectors in which their answer still fails are the next cuts (Kelley 1960).
What the last answer lacks, and room for rounding, is given to every joint.
"""

from __future__ import annotations

import numpy as np
import numpy.typing as npt

Array = npt.NDArray[np.float64]

_GAP = 1e-7
"""Of the sum: how much more than the least is given."""
_ROUNDING = 1e-14
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
    return _ROUNDING * (float(np.abs(matrices).max()) + float(added.max()))


def _over(cuts: Array, sides: Array) -> tuple[Array, float]:
    """The least t ≥ 0 over the cuts; its multipliers say below what no sum is, however it rounds."""
    exact = {"primal_feasibility_tolerance": 1e-10, "dual_feasibility_tolerance": 1e-10}
    from scipy.optimize import linprog  # scipy takes its time

    found = linprog(np.ones(cuts.shape[1]), A_ub=-cuts, b_ub=-sides, method="highs", options=exact)
    multipliers = np.maximum(-found.ineqlin.marginals, 0.0)
    return np.maximum(found.x, 0.0), float(multipliers @ sides / max(1.0, (multipliers @ cuts).max()))
