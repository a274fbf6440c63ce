"""Contact made and broken with a damped wall: the law is the one it says, and b and f_c cover it."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from fractions import Fraction
from typing import Any, NamedTuple

from ..document.reading import Invalid, Loop, get, number, numbers, quantity, read_loop


class _Estimate(NamedTuple):
    """v = W(ζ) (1 − ζ) q/T, ζ = 1/z: W as a fraction, ascending in ζ; Σ|w_j| and T ‖h_v‖₁."""

    top: list[Fraction]
    bottom: list[Fraction]
    gain: Fraction
    variation: Fraction


def contact(document: Mapping[str, Any]) -> str:
    """b ≥ (2d+1) K T/2 + |B| Σ|w_j| and 2 f_c ≥ (K + |B| ‖h_v‖₁) Δ, with K ≥ 0.

    Storage: ½ K max(x − Δ/2, 0)², and of each past move its square times what
    the velocity estimate and the delay will still make of it.
    """
    p = read_loop(document)
    if not p.unilateral:
        raise Invalid("contact is made and broken with a law that acts inside only")
    if p.part:
        raise Invalid("the delay is no whole number of samples")
    law = get(document, "law")
    k, b = quantity(law, "stiffness"), abs(quantity(law, "virtual_damping"))
    if k < 0:
        raise Invalid(f"the stiffness is negative: {float(k):g}")
    estimate = _estimate(get(law, "weights"))
    _same_law(p, k, quantity(law, "virtual_damping"), estimate)
    if p.damping < (2 * p.whole + 1) * k * p.period / 2 + b * estimate.gain:
        raise Invalid("the damping is below (2d + 1) K T/2 + |B| Σ|w|")
    if 2 * p.coulomb_friction < (k + b * estimate.variation / p.period) * p.resolution:
        raise Invalid("the Coulomb friction is below (K + |B| ‖h_v‖₁) Δ/2")
    return "b and f_c cover this wall, clamped or not, with contact made and broken"


def _estimate(weights: Any) -> _Estimate:
    one = [Fraction(1)]
    if isinstance(weights, Mapping):
        pole = number(get(weights, "pole"))
        if not 0 <= pole < 1:
            raise Invalid("the pole of the velocity estimate must lie in [0, 1)")
        return _Estimate([1 - pole], [Fraction(1), -pole], Fraction(1), 2 * (1 - pole))
    w = numbers(weights)
    response = _times(w, [Fraction(1), Fraction(-1)])
    return _Estimate(w, one, sum(map(abs, w), Fraction(0)), sum(map(abs, response), Fraction(0)))


def _same_law(p: Loop, k: Fraction, b: Fraction, estimate: _Estimate) -> None:
    """K + B W(ζ) (1 − ζ)/T is N/D."""
    moved = _times(estimate.top, [b / p.period, -b / p.period])
    size = max(len(moved), len(estimate.bottom))
    moved, held = ([*c, *[Fraction(0)] * (size - len(c))] for c in (moved, estimate.bottom))
    top = [x + k * y for x, y in zip(moved, held, strict=True)]
    left, right = _times(top, p.denominator), _times(p.numerator, estimate.bottom)
    size = max(len(left), len(right))
    left, right = ([*c, *[Fraction(0)] * (size - len(c))] for c in (left, right))
    if left != right:
        raise Invalid("H(z) is not the wall of the stiffness, virtual damping and weights given")


def _times(a: Sequence[Fraction], b: Sequence[Fraction]) -> list[Fraction]:
    out = [Fraction(0)] * (len(a) + len(b) - 1) if a and b else []
    for i, x in enumerate(a):
        if x:
            for j, y in enumerate(b):
                if y:
                    out[i + j] += x * y
    return out
