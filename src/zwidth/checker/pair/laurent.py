"""Polynomials in ζ = e^{−jθ} and in its conjugate, by powers of ζ."""

from __future__ import annotations

from collections.abc import Iterable, Mapping, Sequence
from fractions import Fraction

from ..document.effort import spend
from ..exact.polynomial import bits, in_powers

Laurent = dict[int, Fraction]


def from_ascending(a: Iterable[Fraction], late: int = 0) -> Laurent:
    """ζ^late times a polynomial."""
    return {k + late: c for k, c in enumerate(a) if c}


def conjugate(a: Laurent) -> Laurent:
    """On the unit circle."""
    return {-k: c for k, c in a.items()}


def times(a: Laurent, b: Laurent) -> Laurent:
    """The product."""
    found: Laurent = {}
    for i, x in a.items():
        for j, y in b.items():
            found[i + j] = found.get(i + j, Fraction(0)) + x * y
    return found


def weighted(*parts: tuple[Fraction | int, Laurent]) -> Laurent:
    """A sum, each with its factor."""
    found: Laurent = {}
    for factor, a in parts:
        for k, c in a.items():
            found[k] = found.get(k, Fraction(0)) + factor * c
    return found


def in_cosine(a: Mapping[int, int]) -> list[int]:
    """The real part, ascending in c = cos θ."""
    degree = max(map(abs, a), default=0)
    sums = [a.get(0, 0), *(a.get(k, 0) + a.get(-k, 0) for k in range(1, degree + 1))]
    spend(degree**2, bits(sums) + degree)
    return in_powers(sums, 1)


def square_in_cosine(a: Mapping[int, int]) -> list[int]:
    """|a|², ascending in c."""
    size = max(a, default=0) - min(a, default=0) + 1
    longest = bits(list(a.values()))
    spend(size**2, longest, longest)
    row: Sequence[int] = [a.get(k + min(a, default=0), 0) for k in range(size)]
    lags = [sum(row[i] * row[i + j] for i in range(size - j)) for j in range(size)]
    return in_powers([lags[0], *(2 * lag for lag in lags[1:])], 1)
