"""Absolute stability re-proved: x = −G f with f = φ(x), φ(0) = 0 and every slope of φ between 0 and K.

    Re{M (1 + K G)} + q₁ K Re{(1 − z⁻¹) G} + q₂ K [Re{(z − 1) G} − (K/2) |(z − 1) G|²] > 0 for all |z| = 1

    M = m₀ − Σ h_i z⁻ⁱ,  Σ|h_i| < m₀,  h_i ≥ 0 unless φ is odd;  q₁, q₂ ≥ 0;  G stable, strictly proper

Each of the three terms belongs to a sum over the motion that φ does not let below 0: Zames and Falb, the
convexity of Φ = ∫φ, and its slope.  Times |D|² the left side is a cosine polynomial, Σ c_j cos jθ.  With
|cos jθ| ≤ 1 the error bounds of its coefficients are taken off, and what is left is a polynomial in cos θ,
> 0 on [−1, 1] by Bernstein coefficients.
"""

from __future__ import annotations

from collections.abc import Mapping
from fractions import Fraction
from typing import Any

from ..document.reading import Invalid, get, integer, number
from ..loop.proofs import _in_powers, _multiply, _strictly_positive
from .plant import Enclosed, Plant, read_plant

MOST_TAPS = 400
FURTHEST_TAP = 200


def absolute(document: Mapping[str, Any]) -> str:
    plant, slope = read_plant(document), number(get(document, "slope"))
    if slope <= 0:
        raise Invalid("the slope must be > 0")
    center, taps = _multiplier(document)
    convex, smooth = (number(get(document, name)) for name in ("convexity", "smoothness"))
    if convex < 0 or smooth < 0:
        raise Invalid("convexity and smoothness must be ≥ 0")
    middle, radius = _inequality(plant, slope, center, taps, convex, smooth)
    _positive_cosines(middle, sum(radius.values(), Fraction(0)))
    kind = get(document, "nonlinearity")
    return f"every {kind} wall with slopes between 0 and {float(slope):.9g} brings the loop to rest"


def _multiplier(document: Mapping[str, Any]) -> tuple[Fraction, dict[int, Fraction]]:
    kind = get(document, "nonlinearity")
    if kind not in ("monotone", "odd monotone"):
        raise Invalid('the nonlinearity must be "monotone" or "odd monotone"')
    center, listed = number(get(document, "center")), get(document, "taps")
    if not isinstance(listed, list) or len(listed) > MOST_TAPS:
        raise Invalid("the taps must be a short list")
    taps: dict[int, Fraction] = {}
    for entry in listed:
        place = integer(get(entry, "place"), -FURTHEST_TAP)
        if place == 0 or place in taps or place > FURTHEST_TAP:
            raise Invalid("every tap has a place of its own, near 0 and not 0")
        taps[place] = number(get(entry, "weight"))
    if kind == "monotone" and any(h < 0 for h in taps.values()):
        raise Invalid("a wall that is not odd allows no negative tap")
    if sum(abs(h) for h in taps.values()) >= center:
        raise Invalid("the taps outweigh the center")
    return center, taps


def _inequality(
    plant: Plant,
    slope: Fraction,
    center: Fraction,
    taps: Mapping[int, Fraction],
    convex: Fraction,
    smooth: Fraction,
) -> tuple[dict[int, Fraction], dict[int, Fraction]]:
    """The coefficients of cos jθ of the left side times |D|², and their error bounds."""
    n, d = plant
    middle: dict[int, Fraction] = {}
    radius: dict[int, Fraction] = {}

    def add(weight: Fraction, at: int, terms: tuple[dict[int, Fraction], dict[int, Fraction]]) -> None:
        for total, part, size in ((middle, terms[0], weight), (radius, terms[1], abs(weight))):
            for j, x in part.items():
                total[abs(j + at)] = total.get(abs(j + at), Fraction(0)) + size * x

    direct, through = _lags(d, d), _lags(n, d)
    for place, weight in {0: center, **{i: -h for i, h in taps.items()}}.items():
        add(weight, -place, direct)
        add(weight * slope, -place, through)
    add(convex * slope, 0, through)
    add(-convex * slope, -1, through)
    add(smooth * slope, 1, through)
    add(-smooth * slope, 0, through)
    moved = _lags(n, n)
    add(-smooth * slope**2, 0, moved)  # |z − 1|² = 2 − 2 cos θ
    add(smooth * slope**2, 1, moved)
    return middle, radius


def _lags(a: Enclosed, b: Enclosed) -> tuple[dict[int, Fraction], dict[int, Fraction]]:
    """a(z) b(1/z) by powers of z."""
    size = [abs(x) for x in a.middle], [abs(x) for x in b.middle]
    middle = _multiply(a.middle, b.middle[::-1])
    over = [
        x + y + z
        for x, y, z in zip(
            _multiply(size[0], b.radius[::-1]),
            _multiply(a.radius, size[1][::-1]),
            _multiply(a.radius, b.radius[::-1]),
            strict=True,
        )
    ]
    shift = len(b.middle) - 1
    return {i - shift: x for i, x in enumerate(middle)}, {i - shift: x for i, x in enumerate(over)}


def _positive_cosines(middle: Mapping[int, Fraction], error: Fraction) -> None:
    degree = max((j for j, x in middle.items() if x), default=0)
    total = _in_powers([middle.get(j, Fraction(0)) for j in range(degree + 1)], 1)
    total[0] -= error
    while len(total) > 1 and total[-1] == 0:
        total.pop()
    _strictly_positive(total)
