"""A port with Herm F ≥ σ in the right half plane or outside the circle, of one axis or of several."""

from __future__ import annotations

from collections.abc import Sequence
from fractions import Fraction
from math import comb, lcm
from typing import NamedTuple

from ..document.fields import List, Number, Read, Record, Whole, document, numbers
from ..document.number import common_scale, down
from ..document.refusal import Invalid, spend
from ..exact.polynomial import add, cleared, multiply, square_modulus, value
from ..exact.positivity import POSITIVITY, product, require_nonnegative, require_positive
from ..exact.roots import in_left_half_plane, inside_unit_circle
from .system import (
    CLAIM,
    MATRIX_SYSTEM,
    MOST_AXES,
    ROWS,
    SYSTEM,
    Polynomial,
    Port,
    part_of,
    port_of,
    square,
    trimmed,
)

# A one-port F = N/D with Re F ≥ σ in the right half plane or outside the circle.
#
# Continuous ports are taken as they are: even and odd parts at s = jω for the sign, Routh's
# table for the roots.

POSITIVE_REAL = document(
    {
        "system": SYSTEM,
        **CLAIM,
        "proof": Record({"offset": Number(above=0), "positivity": POSITIVITY}, shown=False),
    }
)


def positive_real(told: Read) -> str:
    """Re(N D̄) ≥ σ |D|² on the boundary, and N + (g − σ) D has its roots inside, g > 0."""
    p, proof = port_of(told), told.proof
    ((n,),), ((d,),) = p.outputs, p.inputs
    excess, total = (add(n, [(share - p.level) * c for c in d]) for share in (0, proof.offset))
    sign = _on_axis if p.continuous else _on_circle
    require_nonnegative(sign(excess, d, p.order), proof.positivity)
    require_inside([*[Fraction(0)] * (p.order + 1 - len(total)), *total[::-1]], p.continuous)
    return f"the {told.index} index is at least {down(p.level)}"


def require_inside(descending: Polynomial, continuous: bool) -> None:
    """Refuse a polynomial with a root that does not decay, or of less than its degree."""
    inside = in_left_half_plane if continuous else inside_unit_circle
    if not inside(descending):
        raise Invalid("the port is not positive real: a root lies outside")


def _on_circle(m: Polynomial, d: Polynomial, order: int) -> Polynomial:
    """Re(M D̄) = ¼ (|M + D|² − |M − D|²), in c = cos θ."""
    whole = cleared([*m, *d])
    first, second = whole[: len(m)], whole[len(m) :]
    sides = (add(first, [sign * c for c in second]) for sign in (1, -1))
    sums = (square_modulus(side, order) for side in sides)
    return [Fraction(a - b) for a, b in zip(*sums, strict=True)]


def _on_axis(m: Polynomial, d: Polynomial, order: int) -> Polynomial:
    """Re(M D̄) in x = ω², and x = (1 − c)/(1 + c), times (1 + c)ⁿ."""
    even, odd = (multiply(part_of(m, parity), part_of(d, parity)) for parity in (0, 1))
    total = [Fraction(0)] * (order + 1)
    for power, c in enumerate(add(even, [Fraction(0), *odd])):
        if c:
            factor = multiply(_binomial(power, -1), _binomial(order - power, 1))
            total = add(total, [c * f for f in factor])
    return total


def _binomial(power: int, sign: int) -> Polynomial:
    """(1 ± c)ⁿ."""
    return [Fraction(sign**k * comb(power, k)) for k in range(power + 1)]


# A port of several axes with Herm F ≥ σ in the right half plane or outside the circle: proved.
#
# F = N D⁻¹, and Π = ½(Dᴴ N + Nᴴ D) − σ Dᴴ D.  Proved is
#
#     e_k(Π) ≥ 0 on the boundary for every k: the sums of principal minors, as polynomials in c
#     D = (R/π) (N + (g − σ) D) with R/π proper and every root of π inside, g > 0
#
# The sums are computed at more points than the degree, in whole numbers, by Berkowitz's recursion;
# the product is multiplied out.


MOST_POINTS = 4000
MOST_WORK = 40_000_000
_MINOR = Record({"power": Whole(least=0, most=MOST_POINTS), "positivity": POSITIVITY})
POSITIVE_REAL_MATRIX = document(
    {
        "system": MATRIX_SYSTEM,
        **CLAIM,
        "proof": Record(
            {
                "offset": Number(above=0),
                "minors": List(_MINOR, most=MOST_AXES),
                "resolvent": Record({"numerators": ROWS, "denominator": numbers(least=1)}),
            },
            shown=False,
        ),
    }
)
Gaussian = tuple[int, int]


def positive_real_matrix(told: Read) -> str:
    """Every e_k(Π) is nonnegative on the boundary, and the resolvent is stable."""
    p, proof = port_of(told), told.proof
    _require_nonnegative(p, proof.minors)
    _require_stable(p, proof.offset, proof.resolvent)
    return f"the {told.index} index is at least {down(p.level)}"


def _require_nonnegative(p: Port, minors: Sequence[Read]) -> None:
    """e_k = κ |d|^{2·power} (1 − c)ⁱ (1 + c)ʲ s² g with κ > 0, and g > 0 on [−1, 1]."""
    if len(minors) != p.axes:
        raise Invalid("every size of principal minors needs its proof")
    powers = [minor.power for minor in minors]
    claimed = [_product(minor.positivity) for minor in minors]
    degree = max(
        p.axes * p.order, *(len(q) + power * p.order for q, power in zip(claimed, powers, strict=True))
    )
    whole = _whole(p)
    if degree > MOST_POINTS or degree * p.axes**3 * p.order * (1 + whole.bits / 1000) > MOST_WORK:
        raise Invalid("the minors have too high a degree")
    products = p.axes**4 + 4 * p.axes**3 + 4 * p.axes**2 * (p.order + 1)
    spend((degree + 1) * products, whole.bits + 2 * p.order * degree.bit_length(), each=1)
    ratios: list[Fraction | None] = [None] * p.axes
    for step in range(degree + 1):
        c, weight, found = _minors_at(p, whole, Fraction(step + 1, degree // 2 + 2))
        for k, (minor, power, q) in enumerate(zip(found, powers, claimed, strict=True)):
            said = weight**power * value(q, c)
            if ratios[k] is None and said and minor:
                ratios[k] = minor / said
            if minor != (ratios[k] or 0) * said or (ratios[k] or 0) < 0 or (said != 0) != (minor != 0):
                raise Invalid("the factors do not multiply to the sum of the principal minors")


def _product(sign: Read) -> list[int]:
    """(1 − c)ⁱ (1 + c)ʲ s² g times a positive number, with the sign of g confirmed."""
    if sign.at_one + sign.at_minus_one + 2 * len(sign.square) + len(sign.factor) > MOST_POINTS:
        raise Invalid("the factors of a sum of minors are too long")
    require_positive(sign.factor)
    return product(sign)


class _Whole(NamedTuple):
    """The polynomials of a port times `scale`, in whole numbers."""

    scale: int
    inputs: list[list[list[int]]]
    outputs: list[list[list[int]]]
    denominator: list[int]

    @property
    def bits(self) -> int:
        """Of its largest coefficient."""
        sides = (self.inputs, self.outputs)
        return max(c.bit_length() for side in sides for row in side for q in row for c in q)


def _whole(p: Port) -> _Whole:
    sides = (p.inputs, p.outputs)
    scale = lcm(*(x.denominator for side in sides for row in side for q in row for x in q))
    inputs, outputs = ([[[int(c * scale) for c in q] for q in row] for row in side] for side in sides)
    return _Whole(scale, inputs, outputs, [int(c * scale) for c in p.denominator])


def _minors_at(p: Port, whole: _Whole, tangent: Fraction) -> tuple[Fraction, Fraction, list[Fraction]]:
    """(c, |d|², e_1 … e_m) at tan θ/2 = tangent: s = j tan θ/2, all times (1 + c)^order; or z = e^{jθ}."""
    t, b = tangent.numerator, tangent.denominator
    c = Fraction(b * b - t * t, b * b + t * t)
    point, unit = ((0, t), b) if p.continuous else ((b * b - t * t, 2 * t * b), b * b + t * t)
    scale, inputs, outputs, denominator = whole
    u, y = ([[_at(q, point, unit, p.order) for q in row] for row in side] for side in (inputs, outputs))
    top, bottom = p.level.numerator, p.level.denominator
    size = range(p.axes)

    def entry(i: int, j: int) -> Gaussian:
        """2·bottom·Π_ij."""
        real = imaginary = 0
        for k in size:
            for a, z in ((u[k][i], y[k][j]), (y[k][i], u[k][j])):
                real += bottom * (a[0] * z[0] + a[1] * z[1])
                imaginary += bottom * (a[0] * z[1] - a[1] * z[0])
            a, z = u[k][i], u[k][j]
            real -= 2 * top * (a[0] * z[0] + a[1] * z[1])
            imaginary -= 2 * top * (a[0] * z[1] - a[1] * z[0])
        return real, imaginary

    # u, y and d are unit^order · scale too large; (1 + c)^order makes polynomials in c of those in ω²
    d = _at(denominator, point, unit, p.order)
    factor = ((1 + c) if p.continuous else Fraction(1)) ** p.order / Fraction(unit**p.order * scale) ** 2
    sums = _principal_sums([[entry(i, j) for j in size] for i in size])
    share = factor / (2 * bottom)
    return c, factor * (d[0] ** 2 + d[1] ** 2), [s * share ** (k + 1) for k, s in enumerate(sums)]


def _at(ascending: Sequence[int], point: Gaussian, unit: int, order: int) -> Gaussian:
    """unit^order · p(point/unit), a Gaussian integer."""
    real, imaginary, power = 0, 0, unit ** (order + 1 - len(ascending))
    for c in reversed(ascending):
        real, imaginary = real * point[0] - imaginary * point[1], real * point[1] + imaginary * point[0]
        real += c * power
        power *= unit
    return real, imaginary


def _principal_sums(a: list[list[Gaussian]]) -> list[int]:
    """e_1 … e_m of a Hermitian matrix: det(λ + A) grown row by row (Berkowitz 1984), without division."""
    poly: list[Gaussian] = [(1, 0)]
    for n in range(len(a)):
        row = [a[n][k] for k in range(n)]
        column = [_negative(a[k][n]) for k in range(n)]
        toeplitz = [(1, 0), a[n][n]]
        for _ in range(n):
            toeplitz.append(_dot(row, column))
            column = [_negative(_dot(a[k][:n], column)) for k in range(n)]
        poly = [_dot(toeplitz[i::-1], poly[: i + 1]) for i in range(n + 2)]
    return [real for real, _ in poly[1:]]


def _dot(a: Sequence[Gaussian], b: Sequence[Gaussian]) -> Gaussian:
    real = imaginary = 0
    for x, y in zip(a, b, strict=False):
        real += x[0] * y[0] - x[1] * y[1]
        imaginary += x[0] * y[1] + x[1] * y[0]
    return real, imaginary


def _negative(x: Gaussian) -> Gaussian:
    return -x[0], -x[1]


def _require_stable(p: Port, offset: Fraction, resolvent: Read) -> None:
    """R M = π D with M = N + (g − σ) D, R/π proper, and every root of π inside.

    M is invertible then: where M v = 0 it makes D v = 0 and so N v = 0, and one of both is d times 1.
    """
    pi, rows = trimmed(resolvent.denominator), square(resolvent.numerators)
    if not pi or len(rows) != p.axes or max(len(q) for row in rows for q in row) > len(pi):
        raise Invalid("the resolvent must be a proper matrix of the port's size")
    common_scale((*pi, *(c for row in rows for q in row for c in q)))
    share = offset - p.level
    m = [
        [add(n, [share * c for c in d]) for n, d in zip(*pair, strict=True)]
        for pair in zip(p.outputs, p.inputs, strict=True)
    ]
    _require_same_products(rows, m, pi, p.inputs)
    require_inside(pi[::-1], p.continuous)


def _require_same_products(
    rows: list[list[Polynomial]], m: list[list[Polynomial]], pi: Polynomial, d: list[list[Polynomial]]
) -> None:
    size = range(len(m))
    for i in size:
        for j in size:
            total = [-x for x in multiply(pi, d[i][j])] if d[i][j] else []
            for k in size:
                if rows[i][k] and m[k][j]:
                    total = add(total, multiply(rows[i][k], m[k][j]))
            if any(total):
                raise Invalid("the resolvent is not that of the port")
