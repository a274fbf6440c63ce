"""Systems of several axes, given row by row: `from matrix_systems import matrix, random_system`."""

from __future__ import annotations

import control
import numpy as np
import scipy.linalg

NOTHING, LAG = ([0], [1]), ([1], [1, 1])


def matrix(rows, dt=0):
    """A transfer matrix of (numerator, denominator) pairs."""
    num = [[entry[0] for entry in row] for row in rows]
    den = [[entry[1] for entry in row] for row in rows]
    return control.tf(num, den, dt)


def diagonal(first, second):
    """Two axes that do not act on each other."""
    return matrix([[first, NOTHING], [NOTHING, second]])


def over(den, rows):
    """Numerators over one denominator."""
    return matrix([[(num, den) for num in row] for row in rows])


def in_state_space(g):
    """Entry by entry: python-control converts several axes only with a library that is not asked for."""
    if isinstance(g, control.StateSpace):
        return g
    rows = []
    for i in range(g.noutputs):
        entries = [control.ss(control.tf(g.num[i][j], g.den[i][j])) for j in range(g.ninputs)]
        row = control.append(*entries)
        rows.append((row.A, row.B, np.ones((1, len(entries))) @ row.C, row.D.sum(axis=0)[None]))
    a, b, c, d = zip(*rows, strict=True)
    return control.ss(scipy.linalg.block_diag(*a), np.vstack(b), scipy.linalg.block_diag(*c), np.vstack(d))


def random_system(seed, order=4, axes=2, throughput=0.5, discrete=False):
    """A stable state space whose Hermitian part is of either sign, in decimals of three digits."""
    rng = np.random.default_rng(seed)
    a = rng.normal(size=(order, order))
    a -= (np.linalg.eigvals(a).real.max() + rng.uniform(0.1, 1)) * np.eye(order)
    if discrete:
        a = np.linalg.solve(np.eye(order) - 0.3 * a, np.eye(order) + 0.3 * a)
    b, c = rng.normal(size=(order, axes)), rng.normal(size=(axes, order))
    d = rng.normal(size=(axes, axes)) * 0.2 + throughput * np.eye(axes)
    parts = (np.round(part, 3) for part in (a, b, (b.T + 0.4 * c), d))
    return control.ss(*parts, 0.01 if discrete else 0)


def responses(system, points):
    """C (z I − A)⁻¹ B + D at every point, one matrix after another."""
    shifted = np.asarray(points)[:, None, None] * np.eye(len(system.A)) - system.A
    return system.C @ np.linalg.solve(shifted, system.B[None]) + system.D


def least_eigenvalue(response):
    """Of the Hermitian part of a matrix, or of each of several."""
    return np.linalg.eigvalsh((response + response.conj().swapaxes(-1, -2)) / 2)[..., 0]
