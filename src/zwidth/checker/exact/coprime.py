"""Have two polynomials a common factor?  Euclid's algorithm modulo a prime."""

from __future__ import annotations

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
