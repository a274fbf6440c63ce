"""Systems of several axes, given row by row: `from matrix_systems import matrix, random_system`."""

from __future__ import annotations

import control
import numpy as np


def matrix(rows, dt=0):
    """A transfer matrix of (numerator, denominator) pairs."""
    num = [[entry[0] for entry in row] for row in rows]
    den = [[entry[1] for entry in row] for row in rows]
    return control.tf(num, den, dt)


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
