"""Exact numbers: real roots of polynomials, roots inside the unit circle, cosines, definite matrices."""

from __future__ import annotations

from collections.abc import Iterator, Sequence
from fractions import Fraction
from functools import lru_cache
from math import lcm
from typing import TypeVar

from flint import arb, arb_poly, fmpq, fmpq_mat, fmpq_poly, fmpz, fmpz_poly

from zwidth.quantity.balls import as_fmpq, ball, middle, precision


def real_roots(p: fmpz_poly, bits: int = 128) -> list[Fraction]:
    """Rationals within rounding at `bits` of each real root."""
    with precision(bits):
        return [middle(root.real) for root, _ in p.complex_roots() if abs(float(root.imag)) <= 1e-30]


def roots_inside(p: fmpz_poly, bits: int = 128) -> list[Fraction]:
    """The same of the roots in (−1, 1) alone, in a fraction of the time.

    Roots that are no further apart than the rounding are one.
    """
    if p.degree() < 1:
        return []
    simple = p // p.gcd(p.derivative())
    return [root_between(simple, low, high, bits) for low, high in _isolated(simple, bits)]


def root_between(p: fmpz_poly, low: Fraction, high: Fraction, bits: int) -> Fraction:
    """The one root of p in (low, high), within rounding at `bits`; `low` where that is `high`."""
    with precision(bits + 4 * p.degree() + 64):  # near a root the powers cancel about as many bits
        return middle(_refined(p, low, high, bits)) if low < high else low


def rational_roots_inside(p: fmpz_poly) -> list[Fraction]:
    """The simple rational roots in (−1, 1), in time bounded by degree and digits, as factoring is not."""
    largest = abs(int(p[p.degree()]))  # denominators divide it: between two such fractions lies 1/largest²
    bits = 2 * largest.bit_length() + 2
    near = (root.limit_denominator(largest) for root in roots_inside(p, bits))
    slope = p.derivative()
    return [root for root in near if _vanishes(p, root, bits) and slope(as_fmpq(root)) != 0]


def _vanishes(p: fmpz_poly, at: Fraction, bits: int) -> bool:
    """True where p(at) = 0; balls see most that are not."""
    with precision(bits):
        if not p(ball(at)).contains(0):
            return False
    return bool(p(as_fmpq(at)) == 0)


def _isolated(p: fmpz_poly, bits: int) -> Iterator[tuple[Fraction, Fraction]]:
    """Open intervals of one root each, of a narrowest perhaps more; or the root itself as both ends."""
    work = [(on_unit_interval(p), Fraction(-1), Fraction(1))]
    while work:
        h, low, high = work.pop()
        changes = sign_changes(h)
        if changes == 0:
            continue
        if changes == 1 or high - low < Fraction(1, 1 << bits):
            yield low, high
            continue
        between = (low + high) / 2
        left, right = halves(h)
        if right[0] == 0:
            yield between, between
        work += [(left, low, between), (right, between, high)]


def _refined(p: fmpz_poly, low: Fraction, high: Fraction, bits: int) -> arb:
    """The root by Newton's steps, and by halving where they leave the interval or shrink too little."""
    slope = p.derivative()
    a, b = ball(low), ball(high)
    rising = not _is_positive_after(p, slope, low)
    x, before, close = (a + b) / 2, b - a, arb(2) ** -bits
    while b - a > close:
        value = p(x)
        if value.contains(0):
            break
        a, b = (x.mid(), b) if (value < 0) == rising else (a, x.mid())
        step = (value / slope(x)).mid()
        if not (abs(step) * 2 < before and a < x - step and x - step < b):
            step = (x - (a + b) / 2).mid()
        x, before = (x - step).mid(), abs(step)
        if before < close:
            break
    return x


def _is_positive_after(p: fmpz_poly, slope: fmpz_poly, at: Fraction) -> bool:
    """The sign of p just above a point, which may be a simple root."""
    point = as_fmpq(at)
    return bool((p(point) or slope(point)) > 0)


# Descartes' rule of signs on halved intervals (Vincent, Collins & Akritas): a polynomial is held mapped, up
# to a positive factor, so that (0, 1) covers the interval.


_SHIFT = fmpz_poly([1, 1])


def on_unit_interval(p: fmpz_poly) -> fmpz_poly:
    """p on [−1, 1], mapped to [0, 1]: c = 2t − 1."""
    return p(fmpz_poly([-1, 2]))


def sign_changes(h: fmpz_poly) -> int:
    """Descartes' bound on the number of roots of h in (0, 1); 0 and 1 are exact."""
    n = h.degree()
    reverse = fmpz_poly([h[n - i] for i in range(n + 1)])
    signs = [c > 0 for c in reverse(_SHIFT).coeffs() if c != 0]
    return sum(1 for a, b in zip(signs, signs[1:], strict=False) if a != b)


def halves(h: fmpz_poly) -> tuple[fmpz_poly, fmpz_poly]:
    """2ⁿ h(t/2), and the same of the right half, 2ⁿ h((t + 1)/2)."""
    n = h.degree()
    left = fmpz_poly([h[i] * (1 << (n - i)) for i in range(n + 1)])
    return left, left(_SHIFT)


# Schur–Cohn recursion: p of degree n is Schur exactly if |p(0)| < |lead| and
# (lead·p − p(0)·p*)/z is, with p* the reversed polynomial.  In balls of growing
# precision that is fast, and a sign that they leave open is decided on integers.


Polynomial = TypeVar("Polynomial", fmpz_poly, arb_poly)

_PRECISIONS = (256, 1024, 4096)  # bits of the balls, one after the other


def is_schur(ascending: Sequence[int]) -> bool:
    """True when every root of Σ a_i zⁱ has modulus < 1."""
    return _is_schur(tuple(ascending))


@lru_cache(maxsize=64)
def _is_schur(ascending: tuple[int, ...]) -> bool:
    """The same; one law is asked about on many devices."""
    p = fmpz_poly(list(ascending))
    if p.degree() < 1:
        return bool(p.degree() == 0)
    if abs(p[0]) >= abs(p[p.degree()]) or p.gcd(_reversed(p)).degree() > 0:
        return False  # roots on the circle, and pairs that mirror each other in it, are common to both
    for bits in _PRECISIONS:
        with precision(bits):
            answer = decays_in_balls(arb_poly(p))
        if answer is not None:
            return answer
    return _on_integers(p)


def decays_in_balls(p: arb_poly) -> bool | None:
    """Whether p is Schur; None where the balls are too wide to tell."""
    while p.degree() > 0:
        ratio = p[0] / p[p.degree()]
        if not abs(ratio) < 1:
            return False if abs(ratio) >= 1 else None
        p = arb_poly((p - ratio * _reversed(p)).coeffs()[1:])
    return True


def _on_integers(p: fmpz_poly) -> bool:
    while p.degree() > 0:
        first, last = p[0], p[p.degree()]
        if abs(first) >= abs(last):
            return False
        p = (last * p - first * _reversed(p)).right_shift(1)
        content = p.content()
        if content > 1:
            p = fmpz_poly([c // content for c in p.coeffs()])
    return True


def _reversed(p: Polynomial) -> Polynomial:
    return type(p)(p.coeffs()[::-1])


# Polynomials on the unit circle, ζ = e^{−jθ}, as polynomials in c = cos θ.


_FEW = 32  # cosines that are added one by one


def real_product(a: Sequence[int], b: Sequence[int]) -> fmpq_poly:
    """Re{a(ζ) b̄(ζ)} = Σ r_j cos jθ of two integer polynomials, ascending in ζ."""
    return fmpq_poly(whole_product(a, b))


def whole_product(a: Sequence[int], b: Sequence[int]) -> fmpz_poly:
    """The same, whose coefficients are whole."""
    size = max(len(a), len(b))
    product, middle = fmpz_poly([*a]) * fmpz_poly([*[0] * (size - len(b)), *b[::-1]]), size - 1
    return from_whole_cosines(
        [product[middle], *[product[middle + j] + product[middle - j] for j in range(1, size)]]
    )


def from_cosines(a: Sequence[fmpq]) -> fmpq_poly:
    """Σ a_j cos jθ as a polynomial in c = cos θ."""
    scale = lcm(*(int(weight.q) for weight in a))
    return fmpq_poly(from_whole_cosines([(weight * scale).p for weight in a])) / scale


def from_whole_cosines(a: Sequence[fmpz | int]) -> fmpz_poly:
    """The same of whole numbers; many of them by halves, with T_{m+k} = 2 T_m T_k − T_{m−k}."""
    if len(a) <= _FEW:
        return sum([w * fmpz_poly.chebyshev_t(j) for j, w in enumerate(a) if w], fmpz_poly([]))
    m = len(a) // 2
    low, high = list(a[:m]), a[m + 1 :]
    for k, weight in enumerate(high, 1):
        low[m - k] -= weight
    upper = from_whole_cosines([a[m], *[2 * weight for weight in high]])
    return from_whole_cosines(low) + fmpz_poly.chebyshev_t(m) * upper


def interpolated(values: Sequence[fmpq_poly], at: Sequence[fmpq]) -> list[fmpq_poly]:
    """The p_j(c) of Σ m^j p_j(c), which is each of the values at its m."""
    width = range(max(value.length() for value in values) or 1)
    powers = fmpq_mat([[m**j for j in range(len(at))] for m in at])
    found = powers.solve(fmpq_mat([[value[k] for k in width] for value in values]))
    return [fmpq_poly(row) for row in found.tolist()]


def as_real(real: fmpq_mat, imaginary: fmpq_mat) -> list[list[fmpq]]:
    """The symmetric matrix (Re −Im; Im Re), of twice the size, with the values of a Hermitian one."""
    rows = list(zip(real.tolist(), imaginary.tolist(), strict=True))
    return [[*r, *(-x for x in i)] for r, i in rows] + [[*i, *r] for r, i in rows]


def negative_direction(matrix: Sequence[Sequence[fmpq]]) -> list[fmpq] | None:
    """x with xᵀ M x < 0; None where M ≥ 0.

    Gaussian elimination of rows and columns alike: the first negative pivot is
    xᵀ M x of the row of the transformation that has led to it.
    """
    m = [list(row) for row in matrix]
    size = len(m)
    path = [[fmpq(int(i == k)) for i in range(size)] for k in range(size)]
    for i in range(size):
        pivot = m[i][i]
        if pivot < 0:
            return path[i]
        if pivot == 0:
            j = next((j for j in range(i + 1, size) if m[i][j] != 0), None)
            if j is None:
                continue
            share = -(m[j][j] + 1) / (2 * m[i][j])  # (share e_i + e_j) gives −1
            return [share * a + b for a, b in zip(path[i], path[j], strict=True)]
        for j in range(i + 1, size):
            ratio = m[i][j] / pivot
            if ratio != 0:
                path[j] = [b - ratio * a for a, b in zip(path[i], path[j], strict=True)]
                for k in range(j, size):
                    m[j][k] -= ratio * m[i][k]
                    m[k][j] = m[j][k]
    return None
