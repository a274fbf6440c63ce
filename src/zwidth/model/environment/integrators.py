"""How a body M v̇ + B v + K y = f is stepped with the samples: what each integrator makes of a force.

f_k is the force at the sample k, T the period and a = (f − B v − K y)/M.  Explicit, a force acts over the
step after it:

    forward-euler         y⁺ = y + T v,       v⁺ = v + T a
    semi-implicit-euler   v⁺ = v + T a,       y⁺ = y + T v⁺
    velocity-verlet       y⁺ = 2 y − y⁻ + T² a,    v = (y⁺ − y⁻)/(2T)
    runge-kutta-2, -4     the Taylor series of the motion up to T², T⁴: without B and K the motion itself

Implicit, a force acts over the step that ends with it, and is solved for:

    backward-euler        v = v⁻ + T a,       y = y⁻ + T v
    implicit-midpoint     v = v⁻ + T a,       y = y⁻ + T (v⁻ + v)/2,  with the means of v and y in a
    trapezoidal           the same, with the mean of f as well

The speed that a coupling sees is v at the sample; of implicit-midpoint the mean over the step.

All but the series of order 2 and 4 are, with the polynomials of the table below,

    y/f = T² Y(z)/D(z),    v/f = T V(z)/D(z),    D = M (z − 1)² + B T R(z) + K T² S(z)
"""

from __future__ import annotations

from fractions import Fraction
from math import factorial
from types import MappingProxyType
from typing import Literal, NamedTuple

from zwidth.model.environment.environment import add, multiply

Integrator = Literal[
    "semi-implicit-euler",
    "forward-euler",
    "velocity-verlet",
    "runge-kutta-2",
    "runge-kutta-4",
    "backward-euler",
    "implicit-midpoint",
    "trapezoidal",
]

Polynomial = tuple[Fraction, ...]
"""Descending powers of z."""

POWER_OF_MASS = 8
"""Times M to this power, position, velocity and denominator are polynomials in M."""

_ONE, _ZERO, _HALF = Fraction(1), Fraction(0), Fraction(1, 2)
_Z = (_ONE, _ZERO)
_STEP = (_ONE, -_ONE)
_MEAN = (_HALF, _HALF)
_CENTRAL = multiply(_STEP, _MEAN)


class SteppedBody(NamedTuple):
    """y/f = position/denominator [m/N], v/f = velocity/denominator [m/(N·s)]."""

    position: Polynomial
    velocity: Polynomial
    denominator: Polynomial


class Body(NamedTuple):
    """M > 0 [kg], B ≥ 0 [N·s/m] and K ≥ 0 [N/m] to the ground, T > 0 [s]."""

    mass: Fraction
    damping: Fraction
    stiffness: Fraction
    period: Fraction


class _Scheme(NamedTuple):
    """Y, V, R and S of the module."""

    position: Polynomial
    velocity: Polynomial
    damping: Polynomial
    spring: Polynomial


_SCHEMES = MappingProxyType(
    {
        "forward-euler": _Scheme((_ONE,), _STEP, _STEP, (_ONE,)),
        "semi-implicit-euler": _Scheme(_Z, _STEP, _STEP, _Z),
        "velocity-verlet": _Scheme(_Z, _CENTRAL, _CENTRAL, _Z),
        "backward-euler": _Scheme(
            multiply(_Z, _Z), multiply(_Z, _STEP), multiply(_Z, _STEP), multiply(_Z, _Z)
        ),
        "implicit-midpoint": _Scheme(multiply(_Z, _MEAN), _CENTRAL, _CENTRAL, multiply(_MEAN, _MEAN)),
        "trapezoidal": _Scheme(multiply(_MEAN, _MEAN), _CENTRAL, _CENTRAL, multiply(_MEAN, _MEAN)),
    }
)

_ORDERS = MappingProxyType({"runge-kutta-2": 2, "runge-kutta-4": 4})


def stepped(integrator: Integrator, body: Body) -> SteppedBody:
    """The body as the integrator steps it; common factors are kept."""
    if integrator in _ORDERS:
        return _by_series(body, _ORDERS[integrator])
    scheme, (m, b, k, t) = _SCHEMES[integrator], body
    losses = add(times(b * t, scheme.damping), times(k * t * t, scheme.spring))
    return SteppedBody(
        times(t * t, scheme.position),
        times(t, scheme.velocity),
        add(times(m, multiply(_STEP, _STEP)), losses),
    )


def times(factor: Fraction, polynomial: Polynomial) -> Polynomial:
    """The polynomial with every coefficient times a factor."""
    return tuple(factor * c for c in polynomial)


def _by_series(body: Body, order: int) -> SteppedBody:
    """s⁺ = Φ s + g f, s = (y, v):  Φ = Σ (T A)ⁱ/i! up to the order, g = Σ Tⁱ⁺¹ Aⁱ e/(i + 1)! up to one less.

    Without f that is what every Runge–Kutta method of that order with as many stages does to a linear law.
    """
    m, b, k, t = body

    def forward(y: Fraction, v: Fraction) -> tuple[Fraction, Fraction]:
        """T A (y, v)."""
        return t * v, -t * (k * y + b * v) / m

    def series(state: tuple[Fraction, Fraction], first: int) -> tuple[Fraction, Fraction]:
        """Σ (T A)ⁱ state/(i + first)! over i ≤ order − first."""
        y, v = _ZERO, _ZERO
        for i in range(order - first + 1):
            y, v = y + state[0] / factorial(i + first), v + state[1] / factorial(i + first)
            state = forward(*state)
        return y, v

    (p, r), (q, s), (y, v) = series((_ONE, _ZERO), 0), series((_ZERO, _ONE), 0), series((_ZERO, t / m), 1)
    return SteppedBody((y, q * v - s * y), (v, r * y - p * v), (_ONE, -p - s, p * s - q * r))
