"""Which motion tells a device fastest, and how well a motion will tell it.

    I = (1/(σ² T)) Σ_i w_i M_i,      M = mean of a aᵀ over strokes of one kind,   a = (ẍ, ẋ, sgn ẋ)
    V(t) = γ² I⁻¹/t

is the covariance of m, b, f_c after t seconds, a share w_i of them spent on strokes of kind i:
as for any least squares, the guesses of m, b, f_c do not enter, the noise σ of the force and
the motion do.  Strokes go to and fro, each x = −½L cos(πt/D); the line that the zero of a load
cell drifts along in ten seconds is taken out of a first, as `identify` does.

γ is what `identify` loses against that, its allowance for the method included: `INEFFICIENCY`.

The shares are those with the least cᵀVc, c for the parameter that limits the wall (c-optimal;
Elfving 1952).  One speed alone does: along a stroke it varies; a slow and a fast one do better.
"""

from __future__ import annotations

from typing import NamedTuple

import numpy as np

from zwidth.data.identification.device.pieces import SECONDS
from zwidth.native.compiled import Array

PARAMETERS = ("mass", "damping", "coulomb_friction")

INEFFICIENCY = 1.2
"""γ, on the safe side of what was measured: docs/experiment.md."""

SAMPLES = 4000
"""At which the regressors of ten seconds are taken."""


class Stroke(NamedTuple):
    """From one end to the other.

    Parameters
    ----------
    length
        L [m; rad].
    duration
        D [s].
    """

    length: float
    duration: float

    @property
    def acceleration(self) -> float:
        """At the turns [m/s²; rad/s²]."""
        return float(self.length / 2 * (np.pi / self.duration) ** 2)

    @property
    def speed(self) -> float:
        """In the middle [m/s; rad/s]."""
        return float(self.length / 2 * np.pi / self.duration)

    def information(self) -> Array:
        """M, the lines taken out."""
        time = (np.arange(SAMPLES) + 0.5) * SECONDS / SAMPLES
        phase = np.pi * time / self.duration
        way = np.sin(phase)
        columns = [self.acceleration * np.cos(phase), self.speed * way, np.sign(way)]
        matrix = np.stack(columns, axis=1)
        lines = np.linalg.qr(np.stack([np.ones(SAMPLES), time], axis=1))[0]
        matrix -= lines @ (lines.T @ matrix)
        mean: Array = matrix.T @ matrix / SAMPLES
        return mean


def covariance(
    strokes: tuple[Stroke, ...], shares: tuple[float, ...], noise: float, period: float, seconds: float
) -> Array:
    """V of m, b, f_c.

    Parameters
    ----------
    strokes
        Their kinds.
    shares
        Of the time, ≥ 0, of each.
    noise
        σ of the force, per sample [N; N·m].
    period
        T [s].
    seconds
        t of recorded motion.
    """
    mean = sum(w * s.information() for w, s in zip(shares, strokes, strict=True))
    scale = (INEFFICIENCY * noise) ** 2 * period / seconds
    return np.asarray(scale * np.linalg.inv(mean), dtype=np.float64)


def best_shares(strokes: tuple[Stroke, ...], parameter: str) -> tuple[float, ...]:
    """Shares of the time that make a parameter's variance smallest.

    By w_i ← w_i √(vᵀ M_i v / vᵀ M v), v = M⁻¹ c, which never makes it larger (Fellman 1974).
    """
    informations = np.stack([s.information() for s in strokes])
    c = np.eye(len(PARAMETERS))[PARAMETERS.index(parameter)]
    shares = np.full(len(strokes), 1 / len(strokes))
    for _ in range(500):
        v = np.linalg.solve(np.tensordot(shares, informations, 1), c)
        each = np.einsum("i,kij,j->k", v, informations, v)
        shares = shares * np.sqrt(each / (shares @ each))
        shares /= shares.sum()
    return tuple(shares.tolist())
