"""The discretizations whose coefficients contain e^{sT}.

Each is computed in ball arithmetic, at growing precision, until every coefficient is known to the nearest
double.  A coefficient is then that double and, as every float here, stands for its shortest decimal.

Time is counted in sample periods: H(s) is first written in σ = sT.
"""

from __future__ import annotations

from collections.abc import Callable
from fractions import Fraction
from functools import reduce
from typing import Any

import flint

from zwidth.errors import InputError
from zwidth.model.environment.environment import RationalFunction
from zwidth.quantity.balls import ball, precision

Polynomial = tuple[Fraction, ...]
Balls = list[Any]
"""Coefficients as `flint.arb`, descending powers of z."""

_PRECISIONS = (256, 512, 1280, 2560, 5120, 10240, 20480)
LARGEST_ORDER = 40
"""Beyond this the coefficients, as doubles, no longer say where the poles are."""


def zero_order_hold(numerator: Polynomial, denominator: Polynomial, period: Fraction) -> RationalFunction:
    """(1 − z⁻¹) Z{H(s)/s}: the force of H(s) when the position is held between samples.

    With x' = A x + B u, y = C x + D u for H:  Φ = e^{AT}, Γ = ∫₀ᵀ e^{As} B ds and
    H(z) = D + C (zI − Φ)⁻¹ Γ  (Franklin, Powell & Workman, Digital Control, 4.3).
    """

    return _at_rest(_sampled(numerator, denominator, period, True), numerator, denominator)


def impulse_invariant(numerator: Polynomial, denominator: Polynomial, period: Fraction) -> RationalFunction:
    """D + T Σ h(kT) z⁻ᵏ, with D = H(∞) and h the impulse response of H(s) − D.

    The sample h(0) is h(0⁺), counted in full.
    """

    return _sampled(numerator, denominator, period, False)


def _sampled(
    numerator: Polynomial, denominator: Polynomial, period: Fraction, held: bool
) -> RationalFunction:
    def compute() -> tuple[Balls, Balls]:
        a, output, direct = _state_space(numerator, denominator, period)
        order = len(output)
        flow = _flow(a)
        phi = flint.arb_mat([[flow[i, j] for j in range(order)] for i in range(order)])
        start = [[flow[i, order] if held else flint.arb(int(i == order - 1))] for i in range(order)]
        num, den = _transfer(phi, flint.arb_mat(start), output)
        # h(kT) = C Φᵏ B is one sample ahead of C (zI − Φ)⁻¹ B: times z
        num = [flint.arb(0), *num] if held else [*num, flint.arb(0)]
        return [n + ball(direct) * d for n, d in zip(num, den, strict=True)], den

    return _rounded(compute, denominator)


def matched(numerator: Polynomial, denominator: Polynomial, period: Fraction) -> RationalFunction:
    """Poles and finite zeros at z = e^{sT}; all but one of the zeros at infinity at z = −1.

    The gain is that of H(s) at low frequencies: with H(s) → g sᵏ as s → 0, H(z) → g ((z − 1)/T)ᵏ as z → 1.
    For k = 0 this is the gain at rest (Franklin, Powell & Workman, Digital Control, 6.2).
    """
    num, zeros_at_0 = _without_origin(_in_periods(numerator, period))
    den, poles_at_0 = _without_origin(_in_periods(denominator, period))
    missing = max(len(denominator) - len(numerator) - 1, 0)

    def compute() -> tuple[Balls, Balls]:
        top = _with_roots(num, zeros_at_0, missing)
        bottom = _with_roots(den, poles_at_0, 0)
        gain = ball(num[-1] / den[-1]) * _value_at_1(den) / (_value_at_1(num) * 2**missing)
        return [gain * c for c in top], bottom

    return _at_rest(_rounded(compute, denominator), numerator, denominator)


def _in_periods(polynomial: Polynomial, period: Fraction) -> Polynomial:
    """P(σ/T), descending powers of σ."""
    order = len(polynomial) - 1
    return tuple(c / period ** (order - i) for i, c in enumerate(polynomial))


def _without_origin(polynomial: Polynomial) -> tuple[Polynomial, int]:
    """The polynomial divided by its power of σ, and that power."""
    rest = polynomial
    while rest[-1] == 0 and len(rest) > 1:
        rest = rest[:-1]
    return rest, len(polynomial) - len(rest)


def _state_space(
    numerator: Polynomial, denominator: Polynomial, period: Fraction
) -> tuple[list[list[Fraction]], list[Fraction], Fraction]:
    """A, C and D of the controllable companion form; B is the last unit vector."""
    den = _in_periods(denominator, period)
    num = _in_periods(numerator, period)
    order = len(den) - 1
    monic = [c / den[0] for c in den]
    padded = [Fraction(0)] * (order + 1 - len(num)) + [c / den[0] for c in num]
    direct = padded[0]
    output = [b - direct * a for a, b in zip(monic[1:], padded[1:], strict=True)][::-1]
    shift = [[Fraction(int(j == i + 1)) for j in range(order)] for i in range(order - 1)]
    return [*shift, [-c for c in monic[:0:-1]]], output, direct


def _flow(a: list[list[Fraction]]) -> Any:
    """exp of [[A, B], [0, 0]], which is [[Φ, Γ], [0, 1]]."""
    rows = [[*map(ball, row), flint.arb(int(i == len(a) - 1))] for i, row in enumerate(a)]
    return flint.arb_mat([*rows, [flint.arb(0)] * (len(a) + 1)]).exp()


def _transfer(phi: Any, start: Any, output: list[Fraction]) -> tuple[Balls, Balls]:
    """Numerator and denominator of C (zI − Φ)⁻¹ start.

    The numerator is the denominator times the response z⁻¹ C start + z⁻² C Φ start + …
    """
    row = flint.arb_mat([[ball(c) for c in output]])
    response, state = [], start
    for _ in output:
        response.append((row * state)[0, 0])
        state = phi * state
    den = phi.charpoly().coeffs()[::-1]
    num = [sum((den[i] * response[j - i] for i in range(j + 1)), flint.arb(0)) for j in range(len(output))]
    return num, den


def _with_roots(polynomial: Polynomial, at_1: int, at_minus_1: int) -> Balls:
    """∏ (z − e^σ) over the roots σ, times (z − 1)^at_1 (z + 1)^at_minus_1."""
    roots = [r.exp() for r in _roots(polynomial)]
    roots += [flint.acb(1)] * at_1 + [flint.acb(-1)] * at_minus_1
    product = reduce(lambda p, r: p * flint.acb_poly([-r, 1]), roots, flint.acb_poly([1]))
    return [c.real for c in product.coeffs()[::-1]]


def _value_at_1(polynomial: Polynomial) -> Any:
    """∏ (1 − e^σ) over the roots; never zero: no rational polynomial has the root 2πj."""
    return reduce(lambda p, r: p * (1 - r.exp()), _roots(polynomial), flint.acb(1)).real


def _roots(polynomial: Polynomial) -> list[Any]:
    exact: Any = flint.fmpq_poly([flint.fmpq(c.numerator, c.denominator) for c in polynomial[::-1]])
    return [flint.acb(root) for root, count in exact.complex_roots() for _ in range(count)]


def _rounded(compute: Callable[[], tuple[Balls, Balls]], denominator: Polynomial) -> RationalFunction:
    if len(denominator) - 1 > LARGEST_ORDER:
        raise InputError(
            f"H(s) has order {len(denominator) - 1}, above {LARGEST_ORDER}: rounded to doubles, its "
            'coefficients would not say where its poles are; use "backward", "forward" or "tustin"'
        )
    for bits in _PRECISIONS:
        with precision(bits):
            num, den = compute()
            top, bottom = ([_nearest_double(c) for c in part] for part in (num, den))
        if None not in top and None not in bottom:
            return RationalFunction(_decimals(top), _decimals(bottom))
    raise InputError(
        "H(s) has modes so fast against the sample period that no double holds the coefficients of H(z); "
        "check the unit of the coefficients"
    )


def _at_rest(rounded: RationalFunction, numerator: Polynomial, denominator: Polynomial) -> RationalFunction:
    """With H(0) = 0 the last coefficient of N(z) is set so that N(1) = 0 in spite of the rounding.

    A law that relaxes to no force must not be left with a static stiffness of −1e-14.
    """
    top = rounded.numerator
    if numerator[-1] != 0 or denominator[-1] == 0:
        return rounded
    return RationalFunction((*top[:-1], -sum(top[:-1], Fraction(0))), rounded.denominator)


def _nearest_double(value: Any) -> float | None:
    """The double nearest to every number in the ball, None if there are several."""
    if not value.is_finite():
        return None
    try:
        low, high = (float(_exactly(end)) for end in (value.lower(), value.upper()))
    except OverflowError:
        return None
    return low if low == high else None


def _exactly(value: Any) -> Fraction:
    mantissa, exponent = (int(part) for part in value.man_exp())
    # below the smallest double there is nothing to tell apart, and 2^exponent may be vast
    if mantissa.bit_length() + exponent < -1100:
        return Fraction(0)
    if mantissa.bit_length() + exponent > 1100:
        raise OverflowError
    return Fraction(mantissa) * Fraction(2) ** exponent


def _decimals(values: list[float | None]) -> Polynomial:
    exact = [Fraction(repr(v)) for v in values if v is not None]
    while len(exact) > 1 and exact[0] == 0:
        exact = exact[1:]
    return tuple(exact)
