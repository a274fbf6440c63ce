"""Contact made and broken with a damped wall: the law is the one it says, and b and f_c cover it."""

from __future__ import annotations

from collections.abc import Mapping
from fractions import Fraction
from typing import Any, NamedTuple

from ..document.fields import Either, Number, Read, Record, document, numbers
from ..document.refusal import Invalid
from ..document.unit import DAMPING, STIFFNESS
from ..exact.polynomial import add, multiply
from ..loop.loop import LOOP, Loop, loop_of, require_law, require_surface

_POLE = Record({"pole": Number(least=0, below=1)})
WALL = Record(
    {
        "stiffness": Number(STIFFNESS, least=0),
        "virtual_damping": Number(DAMPING),
        "weights": Either(_POLE, numbers(), lambda value: isinstance(value, Mapping)),
    }
)
CONTACT = document({"loop": LOOP, "law": WALL})


class _Estimate(NamedTuple):
    """v = W(ζ) (1 − ζ) q/T, ζ = 1/z: W as a fraction, ascending in ζ; Σ|w_j| and T ‖h_v‖₁."""

    top: list[Fraction]
    bottom: list[Fraction]
    gain: Fraction
    variation: Fraction


def contact(told: Read) -> str:
    """b (b − Q) ≥ α(1 − α) (K T + 2 |B| Σ|w_j|)²/4, b ≥ Q, and 2 f_c ≥ (K + |B| ‖h_v‖₁) Δ, with K ≥ 0.

    Q = (2d + 1 + 2α) K T/2 + |B| Σ|w_j|.  Storage: ½ K max(x − Δ/2, 0)², and of each past move its
    square times what the velocity estimate and the delay will still make of it.  Where a delay of d + α
    samples changes the force inside one, the hand leans on the stronger of the two: what that is worth, the
    square of their difference, is in the sum no more than the right side times that of the moves.
    """
    p, law = loop_of(told.loop), told.law
    require_surface(p)
    k, b = law.stiffness, abs(law.virtual_damping)
    estimate = _estimate(law.weights)
    _require_same_law(p, k, law.virtual_damping, estimate)
    reach = k * p.period / 2 * (2 * p.whole + 1 + 2 * p.part) + b * estimate.gain
    inside = p.part * (1 - p.part) / 4 * (k * p.period + 2 * b * estimate.gain) ** 2
    if p.damping < reach or p.damping * (p.damping - reach) < inside:
        raise Invalid("the damping is below what hold, delay and virtual damping of this wall need")
    if 2 * p.coulomb_friction < (k + b * estimate.variation / p.period) * p.resolution:
        raise Invalid("the Coulomb friction is below (K + |B| ‖h_v‖₁) Δ/2")
    return "b and f_c cover this wall, clamped or not, with contact made and broken"


def _estimate(weights: Any) -> _Estimate:
    one = [Fraction(1)]
    if isinstance(weights, Read):
        pole: Fraction = weights.pole
        return _Estimate([1 - pole], [Fraction(1), -pole], Fraction(1), 2 * (1 - pole))
    response = multiply(weights, [Fraction(1), Fraction(-1)])
    gain, variation = (sum(map(abs, w), Fraction(0)) for w in (weights, response))
    return _Estimate(weights, one, gain, variation)


def _require_same_law(p: Loop, k: Fraction, b: Fraction, estimate: _Estimate) -> None:
    """K + B W(ζ) (1 − ζ)/T is N/D."""
    moved = multiply(estimate.top, [b / p.period, -b / p.period])
    top = add(moved, [k * c for c in estimate.bottom])
    message = "H(z) is not the wall of the stiffness, virtual damping and weights given"
    require_law(p, top, estimate.bottom, message)
