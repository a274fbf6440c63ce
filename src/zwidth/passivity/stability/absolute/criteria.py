"""Weights that prove a slope: a linear programme over a growing grid, then exact and as a certificate.

Nothing found here is believed: it is rounded and proved afterwards.
"""

from __future__ import annotations

from fractions import Fraction
from math import inf
from typing import Any, Literal, NamedTuple

import numpy as np
from numpy.typing import NDArray
from scipy.optimize import brentq, linprog

from zwidth.checker import verify
from zwidth.passivity.certificate import FORMAT
from zwidth.passivity.stability.absolute.plant import Plant
from zwidth.quantity.text import exact_text

_FINE = 6000
_COARSE = 60
_ROUNDS = 30
_LEAST = 1e-2
"""Of sin²(θ/2), below which frequencies count alike: there the circle's term alone is left."""

_KEPT = 0.1
"""Of the margin on the grid, that must be left between its points."""

_PRECISION = 1e-6
"""Relative, of the slope."""


class Found(NamedTuple):
    """A slope and the weights that seem to prove it."""

    slope: float
    weights: dict[Term, float]


def largest_slope(plant: Plant, criterion: Criterion, reach: int, most: float) -> Found | None:
    """The largest slope up to `most` that the criterion seems to prove, by bisection; None if none does."""
    search = _Search(plant, terms_of(criterion, reach))
    low, high = most * 1e-6, most
    best = search.weights(low)
    if best is None:
        return None
    found = Found(low, best)
    while high > low * (1 + _PRECISION):
        middle = (low * high) ** 0.5
        weights = search.weights(middle)
        if weights is None:
            high = middle
        else:
            low, found = middle, Found(middle, weights)
    return found


class _Search:
    def __init__(self, plant: Plant, terms: tuple[Term, ...]) -> None:
        self.terms = terms
        self.angles = frequencies(plant)
        self.response = plant.response(self.angles)
        self.chosen = set(range(0, len(self.angles), _COARSE)) | {len(self.angles) - 1}

    def weights(self, slope: float) -> dict[Term, float] | None:
        """The weights with the largest margin, None where there is none."""
        table = columns(self.terms, self.response, self.angles, slope)
        size = np.abs(1 + slope * self.response) + 1e-9
        table /= (size * (np.sin(self.angles / 2) ** 2 + _LEAST))[:, None]
        scale = np.abs(table).max(axis=0)
        table /= scale
        for _ in range(_ROUNDS):
            margin, weights = _programme(table[sorted(self.chosen)])
            if weights is None or margin <= 0:
                return None
            total = table @ weights
            worst = _valleys(total, margin * _KEPT)
            if not worst:
                break
            self.chosen |= set(worst)
        else:
            return None
        return {t: w / s for t, w, s in zip(self.terms, weights.tolist(), scale.tolist(), strict=True)}


def _programme(table: Array) -> tuple[float, NDArray[np.float64] | None]:
    """max t with table v ≥ t, v ≥ 0 and Σ v = 1."""
    rows, size = table.shape
    cost = np.zeros(size + 1)
    cost[-1] = -1
    total = np.append(np.ones(size), 0.0)[None, :]
    limits = [(0, None)] * size + [(None, None)]
    bound = np.hstack([-table, np.ones((rows, 1))])
    result = linprog(
        cost, A_ub=bound, b_ub=np.zeros(rows), A_eq=total, b_eq=[1.0], bounds=limits, method="highs"
    )
    if not result.success:
        return 0.0, None
    return -result.fun, np.maximum(result.x[:-1], 0.0)


def _valleys(total: Array, level: float) -> list[int]:
    """Where the sum is lowest and below the level: one place in each dip."""
    padded = np.concatenate([[np.inf], total, [np.inf]])
    dips = (padded[1:-1] <= padded[:-2]) & (padded[1:-1] <= padded[2:]) & (total < level)
    return [int(i) for i in np.flatnonzero(dips)]


def frequencies(plant: Plant) -> Array:
    """Even, even in the logarithm, and close about every pole near the circle."""
    even = np.linspace(0.0, np.pi, _FINE)
    low = np.pi * np.logspace(-6, 0, _FINE // 2)
    poles = np.roots(plant.denominator)
    near = [np.abs(np.angle(p)) + (1 - abs(p)) * np.linspace(-20, 20, 801) for p in poles if abs(p) > 0.5]
    return np.unique(np.clip(np.concatenate([even, low, *near]), 0.0, np.pi))


# What a criterion may add up to make its frequency inequality positive.
#
# Each term belongs to a sum over the motion that no wall with slopes between 0 and K can make negative;
# f = φ(x), Φ = ∫φ, w = x − f/K, W = 1 + K G:
#
#     circle       Re W                                   Σ f w ≥ 0
#     tap i        Re{(1 − z⁻ⁱ) W}                        Σ f (w(j) − w(j − i)) ≥ 0, f monotone in w
#     odd tap i    Re{(1 + z⁻ⁱ) W}                        Σ f (w(j) + w(j − i)) ≥ 0, if φ is odd
#     convexity    K Re{(1 − z⁻¹) G}                      Φ(x) − Φ(x⁻) ≤ f (x − x⁻)
#     smoothness   K [Re{(z − 1) G} − (K/2)|(z − 1) G|²]  Φ(x⁺) − Φ(x) ≤ f (x⁺ − x) + (K/2)(x⁺ − x)²
#
# A sum of them with weights ≥ 0, the circle's > 0, that is > 0 at every frequency proves the loop stable.


Array = NDArray[np.float64]
Kind = Literal["circle", "tap", "odd tap", "convexity", "smoothness"]
Criterion = Literal["circle", "Tsypkin", "Jury–Lee", "Zames–Falb", "Zames–Falb, odd"]
CRITERIA: tuple[Criterion, ...] = ("circle", "Tsypkin", "Jury–Lee", "Zames–Falb", "Zames–Falb, odd")


class Term(NamedTuple):
    """One of the terms above; `place` is i, 0 where there is none."""

    kind: Kind
    place: int = 0


def terms_of(criterion: Criterion, reach: int) -> tuple[Term, ...]:
    """What the criterion may use; `reach` is the largest |i|."""
    circle = Term("circle")
    places = [i for i in range(-reach, reach + 1) if i]
    if criterion == "circle":
        return (circle,)
    if criterion == "Tsypkin":
        return circle, Term("convexity")
    if criterion == "Jury–Lee":
        return circle, Term("smoothness")
    taps = tuple(Term("tap", i) for i in places)
    odd = tuple(Term("odd tap", i) for i in places) if criterion == "Zames–Falb, odd" else ()
    return circle, *taps, *odd


def columns(terms: tuple[Term, ...], response: NDArray[np.complex128], angles: Array, slope: float) -> Array:
    """The value of every term at every frequency."""
    z, loop = np.exp(1j * angles), 1 + slope * response

    def value(term: Term) -> Any:
        if term.kind == "circle":
            return loop.real
        if term.kind == "convexity":
            return slope * ((1 - 1 / z) * response).real
        if term.kind == "smoothness":
            moved = (z - 1) * response
            return slope * (moved.real - slope / 2 * np.abs(moved) ** 2)
        sign = -1 if term.kind == "tap" else 1
        return ((1 + sign * z**-term.place) * loop).real

    return np.column_stack([value(term) for term in terms])


# The slope at which a linear spring in the place of the wall makes the loop unstable: no proof goes beyond.
#
# K = −1 / G(e^{jθ}) where G is real and < 0, the smallest over θ in [0, π]


class LinearLimit(NamedTuple):
    """`slope` K, inf for none, and `angle` θ = ωT of the vibration there."""

    slope: float
    angle: float


def linear_limit(plant: Plant) -> LinearLimit:
    """The smallest slope with a closed-loop pole on the unit circle."""

    def imaginary(angle: float) -> float:
        return plant.response_at(angle).imag

    angles = frequencies(plant)[1:-1]
    sides = plant.response(angles).imag
    places = np.flatnonzero(np.sign(sides[:-1]) * np.sign(sides[1:]) < 0)
    crossings = [brentq(imaginary, angles[i], angles[i + 1], xtol=1e-15) for i in places]
    candidates = np.array([0.0, *crossings, np.pi])
    values = plant.response(candidates).real
    slopes = [(float(-1 / g), float(a)) for g, a in zip(values, candidates, strict=True) if g < 0]
    return LinearLimit(*min(slopes, default=(inf, 0.0)))


_STEPS = (0, 2e-6, 1e-5, 3e-5, 1e-4, 3e-4, 1e-3, 3e-3, 1e-2, 3e-2, 0.1)
"""How far the slope is lowered, relatively, before the weights are given up."""

_GRAIN = 1 << 44
_OWN = Fraction(1, 1 << 36)
"""Of the largest weight: least weight of the circle's own term, so that the center outweighs the taps."""

_DIGITS = 7


def proved(plant: Plant, criterion: Criterion, found: Found) -> tuple[Fraction, dict[str, Any]] | None:
    """(K, document) with the largest K near the one found that the independent checker accepts."""
    for step in _STEPS:
        slope = _rounded_down(found.slope * (1 - step))
        document = _document(plant, criterion, slope, found.weights)
        if verify(document).valid:
            return slope, document
    return None


def _document(
    plant: Plant, criterion: Criterion, slope: Fraction, weights: dict[Term, float]
) -> dict[str, Any]:
    most = max(weights.values())
    exact = {term: Fraction(round(w / most * _GRAIN), _GRAIN) for term, w in weights.items()}
    center, taps = _OWN, dict[int, Fraction]()
    other = {"convexity": Fraction(0), "smoothness": Fraction(0)}
    for term, weight in exact.items():
        if term.kind in other:
            other[term.kind] = weight
            continue
        center += weight
        if term.place:
            sign = 1 if term.kind == "tap" else -1
            taps[term.place] = taps.get(term.place, Fraction(0)) + sign * weight
    return {
        "format": FORMAT,
        "kind": "absolute stability",
        **plant.source,
        "nonlinearity": "odd monotone" if criterion == "Zames–Falb, odd" else "monotone",
        "slope": exact_text(slope),
        "center": exact_text(center),
        "taps": [{"place": i, "weight": exact_text(h)} for i, h in sorted(taps.items()) if h],
        **{name: exact_text(weight) for name, weight in other.items()},
    }


def _rounded_down(slope: float) -> Fraction:
    """To seven digits, towards 0."""
    exact = Fraction(slope)
    unit = Fraction(10) ** (len(str(int(slope))) - _DIGITS if slope >= 1 else -_DIGITS)
    return exact // unit * unit
