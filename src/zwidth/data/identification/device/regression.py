"""From the sums over strokes to parameters, and how well they are known.

    θ = G_AA⁻¹ G_Af        V = G_AA⁻¹ (Σ_s g_s g_sᵀ) G_AA⁻¹ · n/(n − p),   g_s = G_s,Af − G_s,AA θ

V takes the scatter of the strokes for what it is, whatever its cause: noise that is not white,
friction that is not quite f_c + b |v| (the "sandwich", clustered by stroke; Liang & Zeger 1986).
"""

from __future__ import annotations

from dataclasses import dataclass
from math import nan

import numpy as np

from zwidth.data.identification.device.estimate import student
from zwidth.data.identification.device.moments import COLUMNS, PAIRS, REGRESSORS, Moments
from zwidth.native.compiled import Array

FEWEST = 6
"""Strokes more than parameters, below which no uncertainty is stated."""


@dataclass(frozen=True)
class Regression:
    """Parameters by least squares.

    Parameters
    ----------
    names
        Which of `REGRESSORS` were fitted.
    values
        θ, SI units.
    covariance
        V.
    degrees
        Degrees of freedom that the scatter of the strokes leaves.
    residual
        Mean square of what is left of the pulses' force [N²; (N·m)²].
    explained
        r², part of the force's variance that is explained.
    """

    names: tuple[str, ...]
    values: Array
    covariance: Array
    degrees: int
    residual: float
    explained: float

    def value(self, name: str) -> float:
        """One parameter."""
        return float(self.values[self.names.index(name)])

    def error(self, name: str) -> float:
        """Its standard error."""
        k = self.names.index(name)
        return float(np.sqrt(self.covariance[k, k]))

    def sees(self, name: str, confidence: float) -> bool:
        """True where 0 is outside a parameter's interval."""
        return abs(self.value(name)) > self.reach(confidence) * self.error(name)

    def reach(self, confidence: float) -> float:
        """Standard errors to either side of a two-sided interval of Student's t."""
        return student(confidence, self.degrees)


def regress(
    moments: Moments, names: tuple[str, ...], mass: float | None = None, share: float = 1.0
) -> Regression | None:
    """Fit the named parameters; None where the strokes are too few or too much alike.

    A mass that is given [kg; kg·m²] is not fitted: m a then counts to the force.  `share` is the part of the
    variance of df/dt that is motion and not noise, for `force_lag`.
    """
    degrees = moments.strokes - len(names) - moments.lines
    if degrees < FEWEST:
        return None
    chosen = [REGRESSORS.index(name) for name in names]
    known = np.zeros(COLUMNS)
    known[-1] = 1.0
    if mass is not None:
        known[REGRESSORS.index("mass")] = -mass
    matrix = moments.sum[np.ix_(chosen, chosen)]
    right = moments.sum[chosen] @ known
    if not tells_apart(matrix, 1e10):
        return None
    if "force_lag" in names and share != 1.0:
        lag = names.index("force_lag")
        matrix[lag, lag] -= (1 - share) / np.linalg.inv(matrix)[lag, lag]
    values: Array = np.asarray(np.linalg.solve(matrix, right), dtype=np.float64)
    residual = known.copy()  # the combination of columns that is left: f − m a − Σ θ A
    residual[chosen] -= values
    selection = np.zeros((len(chosen), len(moments.square)))
    for row, k in enumerate(chosen):
        selection[row, PAIRS[k]] = residual
    scatter = selection @ moments.square @ selection.T
    inverse = np.linalg.inv(matrix)
    spare = moments.pulses - len(names) - moments.lines
    few = moments.strokes / (moments.strokes - 1) * moments.pulses / spare if spare > 0 else nan
    covariance: Array = inverse @ scatter @ inverse.T * few
    left = float(residual @ moments.sum @ residual)
    whole = float(known @ moments.sum @ known)
    return Regression(
        names, values, covariance, degrees, max(left, 0.0) / spare, 1 - left / whole if whole > 0 else nan
    )


def tells_apart(matrix: Array, most: float) -> bool:
    """True where normal equations, scaled to ones on the diagonal, have at most this condition number."""
    size = np.sqrt(np.abs(np.diag(matrix)))
    return bool((size > 0).all() and np.linalg.cond(matrix / np.outer(size, size)) <= most)


def offset(moments: Moments, fit: Regression, mass: float | None) -> float:
    """What the force has besides the fitted terms, f̄ − m ā − Σ θ Ā in means over the pieces [N; N·m]."""
    known = moments.means[-1] - (mass or 0.0) * moments.means[0]
    terms = sum(fit.value(name) * moments.means[REGRESSORS.index(name)] for name in fit.names)
    return float((known - terms) / max(moments.pieces, 1))
