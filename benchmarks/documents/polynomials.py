"""Numbers drawn near a limit, and polynomials of fractions multiplied out."""

from __future__ import annotations

from collections.abc import Sequence
from fractions import Fraction
from random import Random
from typing import Any

Document = dict[str, Any]
Polynomial = list[Fraction]
"""Ascending."""

Laurent = dict[int, Fraction]
"""By powers of z, or of 1/z."""

PERIODS = ("0.001", "0.0005", "1/1024", "0.01")


def short(rng: Random, low: float, high: float, digits: int = 3) -> Fraction:
    """A number of few digits, even in its logarithm."""
    value = low * (high / low) ** rng.random()
    return Fraction(f"{value:.{digits}g}")


def close(rng: Random, value: Fraction) -> Fraction:
    """At a limit, or a little to either side of it."""
    if rng.random() < 0.15:
        return value
    return value * (
        1 + rng.choice((-1, 1)) * Fraction(rng.randint(1, 99), 10 ** rng.choice((2, 3, 5, 8, 11, 14)))
    )


def texts(values: Sequence[Fraction]) -> list[str]:
    """As documents have them."""
    return [str(v) for v in values]


def times(a: Polynomial, b: Polynomial) -> Polynomial:
    """A product."""
    out = [Fraction(0)] * (len(a) + len(b) - 1)
    for i, x in enumerate(a):
        for j, y in enumerate(b):
            out[i + j] += x * y
    return out


def plus(a: Polynomial, b: Polynomial, share: Fraction | int = 1) -> Polynomial:
    """A sum."""
    size = max(len(a), len(b))
    return [(a[i] if i < len(a) else 0) + share * (b[i] if i < len(b) else 0) for i in range(size)]  # type: ignore[misc]


def in_cosine(a: Polynomial, b: Polynomial) -> Polynomial:
    """Re{a(ζ) b(1/ζ)} on the circle, in powers of c = cos θ."""
    found: dict[int, Fraction] = {}
    for i, x in enumerate(a):
        for j, y in enumerate(b):
            found[abs(i - j)] = found.get(abs(i - j), Fraction(0)) + x * y
    total, before, now = [found.get(0, Fraction(0))], [Fraction(1)], [Fraction(0), Fraction(1)]
    for k in range(1, max(found, default=0) + 1):
        total = plus(total, now, found.get(k, Fraction(0)))
        before, now = now, plus([Fraction(0), *(2 * c for c in now)], before, -1)
    return total


def over_one_less(q: Polynomial) -> Polynomial:
    """q/(1 − c), of a q that is 0 at 1."""
    out, rest = [], Fraction(0)
    for c in q[:-1]:
        rest += c
        out.append(rest)
    return out or [Fraction(0)]


def positivity(q: Polynomial) -> Document:
    """The factors of a sign, all in one."""
    while len(q) > 1 and not q[-1]:
        q = q[:-1]
    return {"at_one": 0, "at_minus_one": 0, "square": ["1"], "factor": texts(q)}


def laurent_times(a: Laurent, b: Laurent) -> Laurent:
    """A product."""
    out: Laurent = {}
    for i, x in a.items():
        for j, y in b.items():
            out[i + j] = out.get(i + j, Fraction(0)) + x * y
    return out


def laurent_sum(*terms: tuple[Fraction, Laurent]) -> Laurent:
    """A sum, each with its share."""
    out: Laurent = {}
    for share, part in terms:
        for k, v in part.items():
            out[k] = out.get(k, Fraction(0)) + share * v
    return out


def reciprocal(p: Laurent) -> Laurent:
    """At 1/z."""
    return {-k: v for k, v in p.items()}


def symmetric_in_cosine(p: Laurent) -> Polynomial:
    """Σ p_k zᵏ with p_{−k} = p_k, in powers of c."""
    size = max(map(abs, p), default=0)
    half = [p.get(0, Fraction(0)), *(2 * p.get(k, Fraction(0)) for k in range(1, size + 1))]
    return in_cosine(half, [Fraction(1)])
