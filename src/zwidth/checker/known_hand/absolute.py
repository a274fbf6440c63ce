"""Absolute stability re-proved: x = −G f with f = φ(x), φ(0) = 0 and every slope of φ between 0 and K.

    Re{M (1 + K G)} + q₁ K Re{(1 − z⁻¹) G} + q₂ K [Re{(z − 1) G} − (K/2) |(z − 1) G|²] > 0 for all |z| = 1

    M = m₀ − Σ h_i z⁻ⁱ,  Σ|h_i| < m₀,  h_i ≥ 0 unless φ is odd;  q₁, q₂ ≥ 0;  G stable, strictly proper

Each of the three terms belongs to a sum over the motion that φ does not let below 0: Zames and Falb, the
convexity of Φ = ∫φ, and its slope.  Times |D|² the left side is a cosine polynomial, Σ c_j cos jθ.  With
|cos jθ| ≤ 1 the error bounds of its coefficients are taken off, and what is left is a polynomial in cos θ,
> 0 on [−1, 1] by Bernstein coefficients.
"""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from fractions import Fraction

from ..document.effort import spend
from ..document.fields import Choice, List, Number, Read, Record, Whole, document
from ..document.number import common_scale, down
from ..document.refusal import Invalid
from ..exact.enclosed import Enclosed
from ..exact.polynomial import in_powers
from ..exact.positivity import require_positive
from ..exact.roots import inside_unit_circle
from .plant import PLANT, Plant, given, plant_of

BITS = 320
MOST_TAPS = 400
FURTHEST_TAP = 200

_TAP = Record({"place": Whole(least=-FURTHEST_TAP, most=FURTHEST_TAP), "weight": Number()})
ABSOLUTE_STABILITY = document(
    {
        **PLANT,
        "nonlinearity": Choice("monotone", "odd monotone"),
        "slope": Number(above=0),
        "center": Number(shown=False),
        "taps": List(_TAP, most=MOST_TAPS, shown=False),
        "convexity": Number(least=0, shown=False),
        "smoothness": Number(least=0, shown=False),
    }
)


def absolute(told: Read) -> str:
    """Say what was proved."""
    plant = plant_of(told, BITS)
    _require_stable(told)
    terms = _terms(told, _multiplier(told))
    scale = common_scale(weight for weight, _, _ in terms)
    weights = [(int(weight * scale), at, pair) for weight, at, pair in terms]
    _require_positive(_inequality(plant, weights))
    return (
        f"every {told.nonlinearity} wall with slopes between 0 and {down(told.slope)} brings the loop to rest"
    )


def _require_stable(told: Read) -> None:
    if told.plant is not None:
        if not inside_unit_circle([Fraction(c) for c in given(told.plant)[1]]):
            raise Invalid("G(z) has a pole outside or on the unit circle")
    elif told.loop.hand_stiffness == 0 or told.loop.damping + told.loop.hand_damping == 0:
        raise Invalid("b + c and k must be > 0: else G(z) is not stable")


def _multiplier(told: Read) -> dict[int, Fraction]:
    """The weights of z^i in M."""
    taps = {tap.place: tap.weight for tap in told.taps}
    if len(taps) < len(told.taps) or 0 in taps:
        raise Invalid("every tap has a place of its own, and not 0")
    if told.nonlinearity == "monotone" and any(h < 0 for h in taps.values()):
        raise Invalid("a wall that is not odd allows no negative tap")
    if sum(map(abs, taps.values()), Fraction(0)) >= told.center:
        raise Invalid("the taps must weigh less than the center, all together")
    return {0: told.center, **{-place: -weight for place, weight in taps.items()}}


_Term = tuple[Fraction, int, str]
"""A weight, a power of z, and which product: D D̄, N D̄ or N N̄."""


def _terms(told: Read, multiplier: Mapping[int, Fraction]) -> list[_Term]:
    slope, convex, smooth = told.slope, told.convexity * told.slope, told.smoothness * told.slope
    terms: list[_Term] = []
    for power, weight in multiplier.items():
        terms += [(weight, power, "DD"), (weight * slope, power, "ND")]
    terms += [(convex, 0, "ND"), (-convex, -1, "ND"), (smooth, 1, "ND"), (-smooth, 0, "ND")]
    return [*terms, (-smooth * slope, 0, "NN"), (smooth * slope, 1, "NN")]  # |z − 1|² = 2 − 2 cos θ


def _inequality(plant: Plant, terms: Sequence[tuple[int, int, str]]) -> list[Enclosed]:
    """The coefficients of cos jθ of the left side times |D|²."""
    lags = {
        "DD": _lags(plant.denominator, plant.denominator),
        "ND": _lags(plant.numerator, plant.denominator),
        "NN": _lags(plant.numerator, plant.numerator),
    }
    highest = max(abs(j + at) for _, at, pair in terms for j in lags[pair])
    sums = [Enclosed(plant.bits, 0)] * (highest + 1)
    for weight, at, pair in terms:
        for j, x in lags[pair].items():
            sums[abs(j + at)] = sums[abs(j + at)] + x.times(weight)
    return sums


def _lags(a: Sequence[Enclosed], b: Sequence[Enclosed]) -> dict[int, Enclosed]:
    """a(z) b(1/z) by powers of z, both descending."""
    longest = max(x.middle.bit_length() for x in (*a, *b))
    spend(60 * len(a) * len(b), longest)
    out: dict[int, Enclosed] = {}
    for i, x in enumerate(a):
        for k, y in enumerate(b):
            power = (len(a) - i) - (len(b) - k)
            out[power] = out[power] + x * y if power in out else x * y
    return out


def _require_positive(sums: Sequence[Enclosed]) -> None:
    """> 0 for every θ, whatever the coefficients are within their bounds: |cos jθ| ≤ 1."""
    total = in_powers([x.middle for x in sums], 1)
    total[0] -= sum(x.reach for x in sums)
    while len(total) > 1 and total[-1] == 0:
        total.pop()
    require_positive([Fraction(c) for c in total])
