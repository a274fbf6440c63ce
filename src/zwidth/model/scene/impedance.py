"""The impedance of a linear scene at its port, exact in its parameters.

    s = (2/T)(z − 1)/(z + 1)       spring K/s, damper B, mass m s
    Z(s) = det Y(s)/det Y_ff(s)    Y the node matrix with the port, Y_ff without

Y is positive real, and so is Z.  s Y is a matrix of polynomials; of its leading minors, which Bareiss's
elimination gives without a fraction, the last is its determinant and the one before that of Y_ff.
"""

from __future__ import annotations

from collections.abc import Sequence
from fractions import Fraction

import flint

from zwidth.model.environment.environment import RationalFunction
from zwidth.model.scene.element import Element, Ties, unheld

_S = flint.fmpq_poly([0, 1])
_POWER = {1: 0, 0: 1, -1: 2}
"""The power of s that an element has in s Y, by how it reflects."""


_ONE = Fraction(2)
"""The step at which K T/2 of a spring is K, and 2m/T of a mass is m."""


def impedance(elements: Sequence[Element], net: Ties) -> RationalFunction:
    """Z(s) [N·s/m], common factors cancelled; the elements are linear and none is a lever."""
    size = len(net.roots) + 1  # the port last
    y = [[flint.fmpq_poly([0]) for _ in range(size)] for _ in range(size)]
    for element, across in zip(elements, net.across, strict=True):
        r = element.resistance(_ONE)
        own = flint.fmpq_poly([0] * _POWER[element.reflection] + [_q(r)])
        weights = [*across.free.items(), *([(size - 1, across.port)] if across.port else [])]
        for i, a in weights:
            for j, b in weights:
                y[i][j] += own * _q(a * b)
    below, above = _minors(y, net.roots)
    top, bottom = above, below * _S  # Z(s) = det(s Y)/(s det(s Y_ff))
    common = top.gcd(bottom)
    return _ratio(top // common, bottom // common)


def _minors(y: list[list[flint.fmpq_poly]], roots: Sequence[str]) -> tuple[flint.fmpq_poly, flint.fmpq_poly]:
    """The last two leading minors; 1 before the first.  Before the last none is 0 where all is held."""
    before = flint.fmpq_poly([1])
    for k in range(len(y) - 1):
        if not y[k][k]:
            raise unheld(roots[k])
        for i in range(k + 1, len(y)):
            for j in range(k + 1, len(y)):
                y[i][j] = (y[i][j] * y[k][k] - y[i][k] * y[k][j]) // before
        before = y[k][k]
    return before, y[-1][-1]


def sampled(z: RationalFunction, period: Fraction) -> RationalFunction:
    """Z(s) in z, s = (2/T)(z − 1)/(z + 1)."""
    top, bottom = (_ascending(side) for side in z)
    order = max(top.degree(), bottom.degree())
    minus, plus = flint.fmpq_poly([-1, 1]) * _q(2 / period), flint.fmpq_poly([1, 1])
    num, den = (
        sum((p[i] * minus**i * plus ** (order - i) for i in range(p.degree() + 1)), 0 * _S)
        for p in (top, bottom)
    )
    return _ratio(num, den)


def _ratio(num: flint.fmpq_poly, den: flint.fmpq_poly) -> RationalFunction:
    """Descending powers, the denominator led by 1."""
    lead = den[den.degree()]
    return RationalFunction(_descending(num / lead), _descending(den / lead))


def from_position(z: RationalFunction, period: Fraction) -> RationalFunction:
    """E(z) = Z (z − 1)/(T z) [N/m], of the mean force of the step that ends at a position."""
    num, den = (_ascending(side) for side in z)
    num, den = num * flint.fmpq_poly([-1, 1]), den * flint.fmpq_poly([0, _q(period)])
    common = num.gcd(den)
    return _ratio(num // common, den // common)


def _ascending(side: Sequence[Fraction]) -> flint.fmpq_poly:
    return flint.fmpq_poly([_q(c) for c in reversed(side)])


def _q(number: Fraction) -> flint.fmpq:
    return flint.fmpq(number.numerator, number.denominator)


def _descending(polynomial: flint.fmpq_poly) -> tuple[Fraction, ...]:
    coefficients = [Fraction(int(c.p), int(c.q)) for c in polynomial.coeffs()] or [Fraction(0)]
    return tuple(reversed(coefficients))
