"""From weights to a certificate: rounded to rationals, proved exactly, the slope lowered until that holds."""

from __future__ import annotations

from fractions import Fraction
from typing import Any

from zwidth.checker import verify
from zwidth.passivity.certificate import FORMAT
from zwidth.passivity.stability.absolute.plant import Plant
from zwidth.passivity.stability.absolute.search import Found
from zwidth.passivity.stability.absolute.terms import Criterion, Term
from zwidth.quantity.text import exact_text

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
