"""A number from data, how well it is known, and the two directions of damping.

    value ∓ (t · error + shift)

t is of Student, for the degrees of freedom that the scatter of the strokes leaves.
"""

from __future__ import annotations

from collections.abc import Iterable, Iterator, Mapping
from dataclasses import dataclass
from math import nan
from typing import NamedTuple

import numpy as np
from scipy.special import stdtrit

from zwidth.data.identification.device.moments import COLUMNS, PAIRS, REGRESSORS, Moments
from zwidth.data.logs import Finding
from zwidth.native.compiled import Array
from zwidth.quantity.exact import Interval
from zwidth.quantity.text import shown

_UNITS = {
    "mass": ("kg", "kg*m^2"),
    "damping": ("N*s/m", "N*m*s/rad"),
    "coulomb_friction": ("N", "N*m"),
    "spring": ("N/m", "N*m/rad"),
    "stiffness": ("N/m", "N*m/rad"),
    "quadratic": ("N*s^2/m^2", "N*m*s^2/rad^2"),
    "force_lag": ("s", "s"),
    "asymmetry": ("N*s/m", "N*m*s/rad"),
    "quadratic_asymmetry": ("N*s^2/m^2", "N*m*s^2/rad^2"),
    "slow": ("N", "N*m"),
}
"""Of each parameter, linear and rotary."""

MOST_CONFIDENCE = 0.999999
"""Beyond it the tails of Student's t say nothing about real data."""


class Estimate(NamedTuple):
    """A number from data.

    Parameters
    ----------
    value
        The best guess, SI units.
    error
        Its standard error, from the scatter of the strokes.
    shift
        What the method itself may be off, from how much pulses twice as long change it.
    degrees
        Degrees of freedom of Student's t.
    unit
        Of all three.
    """

    value: float
    error: float
    shift: float
    degrees: int
    unit: str

    def interval(self, confidence: float = 0.95) -> tuple[float, float]:
        """Where the truth is, this often: value ∓ (t · error + shift)."""
        reach = student(confidence, self.degrees) * self.error + self.shift
        return self.value - reach, self.value + reach

    def beyond(self, confidence: float) -> bool:
        """True where 0 is outside the interval."""
        low, high = self.interval(confidence)
        return low > 0 or high < 0

    def __str__(self) -> str:
        return f"{shown(self.value, self.unit)} (95 %: {shown(Interval(*self.interval()), self.unit)})"


def unit_of(parameter: str, motion: str) -> str:
    return _UNITS[parameter][motion == "rotary"]


def student(confidence: float, degrees: int) -> float:
    """t, standard errors to either side of an interval that holds the truth this often."""
    return float(stdtrit(degrees, 0.5 + confidence / 2))


def perhaps_none(estimates: Mapping[str, Estimate], names: Iterable[str]) -> Iterator[Finding]:
    """Those of the named parameters that may be 0."""
    for name in names:
        if name in estimates and estimates[name].interval(0.95)[0] <= 0:
            word = name.replace("_", " ")
            text = f"the data do not rule out that {word} is 0: {estimates[name]}"
            yield Finding(kind=f"no {word}", text=text)


class Directions(NamedTuple):
    """Damping in each direction. A wall takes back no more than friction takes out in the direction in which
    there is less of it: a hand may be quick that way and slow the other. Of Coulomb friction only the mean of
    both directions counts, what it differs by does no work to and fro."""

    inward: Estimate
    outward: Estimate
    """b of motion into the wall, and out of it [N·s/m; N·m·s/rad]."""
    difference: Estimate
    """Half of what the first has more."""

    @property
    def weaker(self) -> Estimate:
        """The lesser of the two."""
        return min(self.inward, self.outward, key=lambda estimate: estimate.value)

    def least(self, confidence: float) -> float:
        """Below which neither is, this often: whichever is the weaker is above its own lower end."""
        return min(self.inward.interval(confidence)[0], self.outward.interval(confidence)[0])


# From the sums over strokes to parameters, and how well they are known.
#
#     θ = G_AA⁻¹ G_Af        V = G_AA⁻¹ (Σ_s g_s g_sᵀ) G_AA⁻¹ · n/(n − p),   g_s = G_s,Af − G_s,AA θ
#
# V takes the scatter of the strokes for what it is, whatever its cause: noise that is not white,
# friction that is not quite f_c + b |v| (the "sandwich", clustered by stroke; Liang & Zeger 1986).

FEWEST = 6
"""Strokes more than parameters, below which no uncertainty is stated."""


@dataclass(frozen=True)
class Regression:
    """Parameters by least squares."""

    names: tuple[str, ...]
    """Which of `REGRESSORS` were fitted."""
    values: Array
    """θ, SI units."""
    covariance: Array
    """V."""
    degrees: int
    """Degrees of freedom that the scatter of the strokes leaves."""
    residual: float
    """Mean square of what is left of the pulses' force [N²; (N·m)²]."""
    explained: float
    """r², part of the force's variance that is explained."""

    def value(self, name: str) -> float:
        return float(self.values[self.names.index(name)])

    def error(self, name: str) -> float:
        k = self.names.index(name)
        return float(np.sqrt(max(self.covariance[k, k], 0.0)))  # of an exact log rounding leaves less than 0

    def sees(self, name: str, confidence: float) -> bool:
        """True where 0 is outside a parameter's interval."""
        return abs(self.value(name)) > self.reach(confidence) * self.error(name)

    def reach(self, confidence: float) -> float:
        """Standard errors to either side of a two-sided interval of Student's t."""
        return student(confidence, self.degrees)


def regress(
    moments: Moments, names: tuple[str, ...], mass: float | None = None, share: float = 1.0
) -> Regression | None:
    """Fit the named parameters; None where the strokes are too few or too much alike. A mass that is given
    [kg; kg·m²] is not fitted: m a then counts to the force. `share` is the part of the variance of df/dt that
    is motion and not noise, for `force_lag`."""
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
