"""Polynomials with rational coefficients, multiplied out by hand: `from polynomials import product`."""

from __future__ import annotations

from fractions import Fraction


def product(*factors):
    """The product of lists of coefficients, in whichever order of powers they are all given."""
    total = [Fraction(1)]
    for factor in factors:
        out = [Fraction(0)] * (len(total) + len(factor) - 1)
        for i, x in enumerate(total):
            for j, y in enumerate(factor):
                out[i + j] += x * Fraction(y)
        total = out
    return total
