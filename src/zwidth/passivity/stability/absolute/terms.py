"""What a criterion may add up to make its frequency inequality positive.

Each term belongs to a sum over the motion that no wall with slopes between 0 and K can make negative;
f = φ(x), Φ = ∫φ, w = x − f/K, W = 1 + K G:

    circle       Re W                                   Σ f w ≥ 0
    tap i        Re{(1 − z⁻ⁱ) W}                        Σ f (w(j) − w(j − i)) ≥ 0, f a monotone function of w
    odd tap i    Re{(1 + z⁻ⁱ) W}                        Σ f (w(j) + w(j − i)) ≥ 0, if φ is odd
    convexity    K Re{(1 − z⁻¹) G}                      Φ(x) − Φ(x⁻) ≤ f (x − x⁻)
    smoothness   K [Re{(z − 1) G} − (K/2)|(z − 1) G|²]  Φ(x⁺) − Φ(x) ≤ f (x⁺ − x) + (K/2)(x⁺ − x)²

A sum of them with weights ≥ 0, the circle's > 0, that is > 0 at every frequency proves the loop stable.
"""

from __future__ import annotations

from typing import Any, Literal, NamedTuple

import numpy as np
from numpy.typing import NDArray

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
