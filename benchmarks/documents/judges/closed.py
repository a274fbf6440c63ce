"""Springs by points and force bounding: random hands, and the inequalities at random places."""

from __future__ import annotations

from collections.abc import Callable
from fractions import Fraction
from typing import Any

import numpy as np

from ..opinion import Opinion, agrees, cannot_say, false
from ..plain import entry, exact, quantity

Document = dict[str, Any]
Rng = np.random.Generator

MOTIONS, SAMPLES, ROUNDS = 96, 48, 6


def _profile(law: Document) -> tuple[np.ndarray, np.ndarray]:
    pairs = entry(law, "points")
    return tuple(np.array([float(exact(p[k])) for p in pairs]) for k in (0, 1))  # type: ignore[return-value]


def _spring(document: Document, rng: Rng) -> Opinion:
    """Rounds of random hands gain nothing, at the edges of counts too; the potential has a lowest value."""
    loop = document["loop"]
    x, f = _profile(document["law"])
    if f[0] > 0 or f[-1] < 0:
        return false("the spring pulls away beyond an end")
    b, fc, step, period, delay = (
        float(quantity(loop, n))
        for n in ("damping", "coulomb_friction", "resolution", "sample_period", "delay")
    )
    late = round(delay / period)
    if late > SAMPLES:
        return cannot_say("the delay is longer than the motions")
    rounds = _rounds(rng, x, step, late)
    moves = np.diff(rounds, axis=1)
    read = np.floor(rounds / step) * step if step else rounds
    force = np.interp(read, x, f)
    held = np.concatenate([np.zeros((len(force), late)), force], axis=1)[:, : moves.shape[1]]
    lost = fc * np.abs(moves) + b / period * moves**2
    out = -held * moves - lost
    n = moves.shape[1] // ROUNDS
    gain, cost = out[:, -n:].sum(axis=1), (lost + 1e-13 * np.abs(held * moves))[:, -n:].sum(axis=1)
    best = int(np.argmax(gain - 1e-9 * cost))
    if gain[best] > 1e-9 * cost[best] > 0:
        return false(f"a round of {n} samples takes out {gain[best]:.6g} for {cost[best]:.6g} lost")
    return agrees()


def _rounds(rng: Rng, x: np.ndarray, step: float, late: int) -> np.ndarray:
    """Rounds again and again, around a point of the profile: of any size, or across the edge of a count."""
    period = int(rng.integers(2, 7)) + late
    around = rng.uniform(x[0], x[-1], (MOTIONS, 1))
    size = (x[-1] - x[0]) * 10.0 ** -rng.uniform(0, 6, (MOTIONS, 1))
    if step:
        fine = rng.random((MOTIONS, 1)) < 0.6
        around = np.where(fine, np.round(around / step) * step, around)
        size = np.where(fine, step * 10.0 ** -rng.uniform(0, 5, (MOTIONS, 1)), size)
    shape = rng.integers(-1, 2, (MOTIONS, period)) - 1e-6 * rng.random((MOTIONS, period))
    one = around + size * shape
    return np.concatenate([*[one] * ROUNDS, one[:, :1]], axis=1)


def _pull(document: Document, rng: Rng) -> Opinion:
    """A slow hand is pulled outwards by more than friction."""
    loop, (_, f) = document["loop"], _profile(document["law"])
    names = ("damping", "coulomb_friction", "resolution", "sample_period", "delay")
    values = [quantity(loop, n) for n in names]
    if min(values[:3]) < 0 or values[3] <= 0 or values[4] < 0:
        return false("there is no loop with such numbers")
    gain = max(f[0], -f[-1]) - float(values[1])
    return agrees() if gain > 0 else false(f"a slow hand gains {gain:.6g} on each length")


def _bounding(document: Document, rng: Rng) -> Opinion:
    """What a move costs against what is credited for it, at random and at the worst; counts; rounding."""
    loop, law = document["loop"], document["law"]
    names = ("damping", "coulomb_friction", "resolution", "sample_period", "force_resolution", "delay")
    b, fc, step, period, rounded, delay = (quantity(loop, n) for n in names)
    beta, phi, size, half, hair, u = (
        quantity(law, n) for n in ("credit", "friction", "count", "half_step", "hair", "roundoff")
    )
    if delay or period <= 0 or min(b, fc, step, rounded) < 0:
        return false("no loop that the law is for")
    if size < step or 2 * half < rounded:
        return false("the law's count or half step is smaller than the device's")
    for _ in range(40):
        psi = phi + (fc + b) * Fraction(float(10.0 ** rng.uniform(-12, 6)))
        kept = (psi - phi) ** 2 / (4 * beta)
        best = (psi - fc) * period / (2 * b) if b else Fraction(1)
        for d in (best, best * Fraction(float(rng.uniform(0.1, 2)))):
            if d > 0 and b / period * d * d + fc * d < psi * d - kept:
                return false(f"a move of {float(d):.6g} against {float(psi):.6g} costs less than is credited")
    if phi * (1 + u) > fc:
        return false("a rounding of the friction credited is more than there is")
    terms = 9 * u
    return (
        agrees()
        if hair >= terms * (1 - hair)
        else false(f"{float(hair):.6g} taken off, {float(terms):.6g} rounded")
    )


JUDGES: dict[str, Callable[[Document, Rng], Opinion]] = {
    "nonlinear spring": _spring,
    "endless pull": _pull,
    "force bounding": _bounding,
}
