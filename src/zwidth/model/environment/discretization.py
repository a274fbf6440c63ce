"""From H(s) to H(z): six ways in which a controller is made of a law.

    backward   s = (z − 1)/(T z)            backward Euler
    forward    s = (z − 1)/T                forward Euler
    tustin     s = (2/T)(z − 1)/(z + 1)     trapezoidal rule
    zoh        (1 − z⁻¹) Z{H(s)/s}          exact for a position held between samples
    impulse    T Z{h(t)}                    impulse-invariant
    matched    z = e^{sT} for every pole and finite zero

The first three put a rational function of z in the place of s: their coefficients are rational and exact.
Those of the last three contain e^{sT}; they are computed with error bounds and rounded to the nearest double,
which is what a controller would run.

Polynomials are tuples of Fraction in descending powers, leading one not zero.
"""

from __future__ import annotations

from collections.abc import Callable
from fractions import Fraction
from typing import Any, Literal, get_args

from zwidth.errors import InputError
from zwidth.model.environment import exponential
from zwidth.model.environment.environment import RationalFunction
from zwidth.quantity.parameter import part
from zwidth.quantity.text import shown

Polynomial = tuple[Fraction, ...]
Discretization = Literal["backward", "forward", "tustin", "zoh", "impulse", "matched"]

CHOICES: tuple[str, ...] = get_args(Discretization)
ROUNDED: frozenset[str] = frozenset({"zoh", "impulse", "matched"})
"""Those whose coefficients are rounded to doubles."""

LARGEST_ORDER = 200
"""A transfer function of higher order is refused: no controller runs one."""


def as_discretization(name: object) -> Discretization:
    """Check the name of a discretization."""
    if name not in CHOICES:
        raise InputError(f"discretization is one of {choices()}; got {name!r}")
    return name  # type: ignore[return-value]


def discretized_by(default: Discretization | None) -> Any:
    """The field `discretization` of a law in continuous time."""
    meaning = f"{', '.join(CHOICES[:-1])} or {CHOICES[-1]}"
    return part("word", lambda value, _: as_discretization(value), default, meaning=meaning, words=CHOICES)


def choices() -> str:
    """The six names as a message lists them."""
    return ", ".join(f'"{name}"' for name in CHOICES)


def discretize(
    numerator: Polynomial, denominator: Polynomial, method: Discretization, period: Fraction
) -> RationalFunction:
    """H(z) of H(s) = numerator/denominator for the sample period T > 0 [s].

    Common factors of the two polynomials are kept.
    """
    num, den = trimmed(numerator), trimmed(denominator)
    if len(num) == len(den) == 1:
        return RationalFunction((num[0] / den[0],), (Fraction(1),))
    if method in _SUBSTITUTIONS:
        return _substituted(num, den, method, period)
    if len(num) > len(den):
        raise InputError(
            f"H(s) has more zeros ({len(num) - 1}) than poles ({len(den) - 1}), so it differentiates the "
            f'position, and "{method}" has no value for the derivative of a sampled position; '
            'use "backward" or "tustin", or add the pole of the velocity filter'
        )
    return _EXPONENTIAL[method](num, den, period)


def trimmed(polynomial: Polynomial) -> Polynomial:
    """The polynomial without leading zeros; (0,) for the zero polynomial."""
    for i, coefficient in enumerate(polynomial):
        if coefficient:
            return polynomial[i:]
    return (Fraction(0),)


_EXPONENTIAL: dict[str, Callable[[Polynomial, Polynomial, Fraction], RationalFunction]] = {
    "zoh": exponential.zero_order_hold,
    "impulse": exponential.impulse_invariant,
    "matched": exponential.matched,
}

_Line = tuple[Fraction, Fraction]


def _backward(period: Fraction) -> tuple[_Line, _Line]:
    return (Fraction(1), Fraction(-1)), (period, Fraction(0))


def _forward(period: Fraction) -> tuple[_Line, _Line]:
    return (Fraction(1), Fraction(-1)), (Fraction(0), period)


def _tustin(period: Fraction) -> tuple[_Line, _Line]:
    return (Fraction(2), Fraction(-2)), (period, period)


_SUBSTITUTIONS: dict[str, Callable[[Fraction], tuple[_Line, _Line]]] = {
    "backward": _backward,
    "forward": _forward,
    "tustin": _tustin,
}


def _substituted(num: Polynomial, den: Polynomial, method: str, period: Fraction) -> RationalFunction:
    p, q = _SUBSTITUTIONS[method](period)
    order = max(len(num), len(den)) - 1
    top, bottom = (trimmed(_homogenised(c, p, q, order)) for c in (num, den))
    if len(top) > len(bottom):
        raise InputError(_needs_the_future(num, den, method, period))
    return RationalFunction(top, bottom)


def _homogenised(polynomial: Polynomial, p: _Line, q: _Line, order: int) -> Polynomial:
    """qᴺ P(p/q) by Horner's rule: (…(c₀ p + c₁ q) p + c₂ q²)…, times the q left over."""
    total: Polynomial = (polynomial[0],)
    power: Polynomial = (Fraction(1),)
    for coefficient in polynomial[1:]:
        power = _times(power, q)
        total = tuple(a + coefficient * b for a, b in zip(_times(total, p), power, strict=True))
    for _ in range(order + 1 - len(polynomial)):
        total = _times(total, q)
    return total


def _times(polynomial: Polynomial, line: _Line) -> Polynomial:
    """A polynomial times a z + b, leading zeros kept."""
    a, b = line
    zero = (Fraction(0),)
    return tuple(a * x + b * y for x, y in zip(polynomial + zero, zero + polynomial, strict=True))


def _needs_the_future(num: Polynomial, den: Polynomial, method: str, period: Fraction) -> str:
    if method == "forward":
        return (
            f"H(s) has more zeros ({len(num) - 1}) than poles ({len(den) - 1}); its forward difference needs "
            'samples that are still to come: use "backward" or "tustin"'
        )
    pole = (1 if method == "backward" else 2) / period
    return (
        f'H(s) has an unstable pole at s = {float(pole):g}/s, which "{method}" sends to infinity at the '
        f"sample period {shown(period, 's', 6)}: H(z) would need samples that are still to come"
    )
