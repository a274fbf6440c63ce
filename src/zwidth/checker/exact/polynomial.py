"""Polynomials as lists of coefficients, ascending, in whole or rational numbers."""

from __future__ import annotations

from collections.abc import Sequence
from fractions import Fraction
from math import lcm
from typing import Any, TypeVar

from ..document.refusal import spend

Exact = TypeVar("Exact", int, Fraction)


def multiply(a: Sequence[Exact], b: Sequence[Exact], zero: Any = 0) -> list[Exact]:
    """a b; the zero is that of other numbers."""
    spend(len(a) * len(b), _longest(a), _longest(b), each=2)
    out: list[Any] = [zero] * (len(a) + len(b) - 1) if a and b else []
    for i, x in enumerate(a):
        if x:
            for j, y in enumerate(b):
                out[i + j] += x * y
    return out


def add(a: Sequence[Exact], b: Sequence[Exact]) -> list[Exact]:
    """a + b."""
    size = max(len(a), len(b))
    sums: list[Any] = [(a[i] if i < len(a) else 0) + (b[i] if i < len(b) else 0) for i in range(size)]
    return sums


def same(a: Sequence[Exact], b: Sequence[Exact]) -> bool:
    """True if a and b are one polynomial, whatever zeros they end in."""
    return not any(add(a, [-c for c in b]))


def value(ascending: Sequence[Fraction | int], x: Fraction) -> Fraction:
    """a(x), 0 of an empty one."""
    each = _longest((x,))
    spend(3 * len(ascending), len(ascending) * each + _longest(ascending), each, each=1.5)
    total = Fraction(0)
    for c in reversed(ascending):
        total = total * x + c
    return total


def _longest(numbers: Sequence[Any]) -> int:
    """Bits of the longest of them; 0 of others than these, which count for themselves."""
    exact = (x for x in numbers if isinstance(x, (int, Fraction)))
    return max((x.numerator.bit_length() + x.denominator.bit_length() for x in exact), default=0)


def cleared(a: Sequence[Fraction]) -> list[int]:
    """A polynomial times the positive integer that makes it whole."""
    scale = lcm(*(c.denominator for c in a))
    return [c.numerator * (scale // c.denominator) for c in a]


def bits(a: Sequence[int]) -> int:
    """Of the largest coefficient."""
    return max((c.bit_length() for c in a), default=0)


def shifted(descending: Sequence[int]) -> list[int]:
    """A polynomial in z in powers of ζ = z − 1, descending."""
    out: list[int] = []
    for c in descending:  # Horner
        out = [x + y for x, y in zip([*out, 0], [0, *out], strict=True)]
        out[-1] += c
    return out


def in_powers(sums: Sequence[Exact], kind: int) -> list[Exact]:
    """Σ sums_j T_j (kind 1) or Σ sums_j U_j (kind 2) in ascending powers, by Clenshaw's recursion."""
    later: list[Exact] = []
    last: list[Exact] = []
    for c in reversed(sums[1:]):
        later, last = _recurred(c, later, last, 2), later
    return _recurred(sums[0], later, last, kind)


def _recurred(c: Exact, later: list[Exact], last: list[Exact], times: int) -> list[Exact]:
    """c + times x later − last."""
    out: list[Any] = [c, *(times * v for v in later)]
    for i, v in enumerate(last):
        out[i] -= v
    return out


def square_modulus(a: list[int], degree: int) -> list[int]:
    """|Σ a_j e^{−jθ}|² in c = cos θ, with zeros up to a degree."""
    lags = [sum(a[i] * a[i + j] for i in range(len(a) - j)) for j in range(len(a))]
    found = in_powers([lags[0], *(2 * lag for lag in lags[1:])], 1)
    return found + [0] * (degree + 1 - len(found))


# Have two polynomials a common factor?  Euclid's algorithm modulo a prime.


_PRIMES = (2**61 - 1, 2**89 - 1, 2**127 - 1)


def are_coprime(n: list[int], d: list[int]) -> bool:
    """True only of coprime polynomials: those that are so modulo a prime that does not divide the highest
    coefficient of D.  Of a few it is not found out."""
    n, d = _trim(list(n)), _trim(list(d))
    return any(d[-1] % prime and _coprime_modulo(prime, n, d) for prime in _PRIMES)


def _coprime_modulo(prime: int, n: list[int], d: list[int]) -> bool:
    a, b = (_trim([c % prime for c in part]) for part in (d, n))
    while b:
        a, b = b, _remainder(a, b, prime)
    return len(a) == 1


def _trim(a: list[int]) -> list[int]:
    while a and a[-1] == 0:
        a.pop()
    return a


def _remainder(a: list[int], b: list[int], prime: int) -> list[int]:
    inverse = pow(b[-1], -1, prime)
    while len(a) >= len(b):
        ratio, shift = a[-1] * inverse % prime, len(a) - len(b)
        a = a[:shift] + [(x - ratio * y) % prime for x, y in zip(a[shift:], b, strict=True)]
        a = _trim(a)
    return a
