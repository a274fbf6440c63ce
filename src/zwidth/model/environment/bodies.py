"""Simulated bodies: behind a virtual coupling, and those that a display of admittance renders.

A simulated body behind a virtual coupling, stepped with the samples as people write it.

    f_k = K_c (x_k − y_k) + B_c (w_k − v_k),    w_k = (x_k − x_{k−1})/T
    H(z) = (K_c + B_c (z − 1)/(T z))/(1 + K_c Y + B_c V),    y = Y(z) f,  v = V(z) f

x is the handle, y and v are where the body is and its speed as its integrator has them (`integrators`).
Where they come out of another process, with d samples of delay each way,

    naive       the force goes out, position and speed come back: z^{−2d} Y, z^{−2d} V
    by waves    the sum f + R v goes out and the difference f − R v comes back: the process is seen through
                a transmission line of impedance R, which keeps all energy (Anderson & Spong 1989)

    Y = (T z/(z − 1)) V,    V = (1 − ρ z^{−2d})/(R (1 + ρ z^{−2d})),    ρ = (1 − R U)/(1 + R U)

with U = (z − 1)/(T z) times the body's own Y, for a line that carries the body's moves.
"""

from __future__ import annotations

from dataclasses import dataclass
from fractions import Fraction
from itertools import accumulate
from math import factorial
from types import MappingProxyType
from typing import Literal, NamedTuple, get_args

from zwidth.errors import InputError
from zwidth.model.environment.environment import Environment, RationalFunction, add, multiply
from zwidth.model.environment.wall import NEGATIVE_SPRING
from zwidth.quantity.parameter import Certain, CertainOrNone, Parametric, exact, plain, word
from zwidth.quantity.text import shown

# How a body M v̇ + B v + K y = f is stepped with the samples: what each integrator makes of a force.
#
# f_k is the force at the sample k, T the period and a = (f − B v − K y)/M.  Explicit, a force acts over the
# step after it:
#
#     forward-euler         y⁺ = y + T v,       v⁺ = v + T a
#     semi-implicit-euler   v⁺ = v + T a,       y⁺ = y + T v⁺
#     velocity-verlet       y⁺ = 2 y − y⁻ + T² a,    v = (y⁺ − y⁻)/(2T)
#     runge-kutta-2, -4     the Taylor series of the motion up to T², T⁴: without B and K the motion itself
#
# Implicit, a force acts over the step that ends with it, and is solved for:
#
#     backward-euler        v = v⁻ + T a,       y = y⁻ + T v
#     implicit-midpoint     v = v⁻ + T a,       y = y⁻ + T (v⁻ + v)/2,  with the means of v and y in a
#     trapezoidal           the same, with the mean of f as well
#
# The speed that a coupling sees is v at the sample; of implicit-midpoint the mean over the step.
#
# All but the series of order 2 and 4 are, with the polynomials of the table below,
#
#     y/f = T² Y(z)/D(z),    v/f = T V(z)/D(z),    D = M (z − 1)² + B T R(z) + K T² S(z)

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
_DIFFERENCE = (_ONE, -_ONE)
_MEAN = (_HALF, _HALF)
_CENTRAL = multiply(_DIFFERENCE, _MEAN)


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
        "forward-euler": _Scheme((_ONE,), _DIFFERENCE, _DIFFERENCE, (_ONE,)),
        "semi-implicit-euler": _Scheme(_Z, _DIFFERENCE, _DIFFERENCE, _Z),
        "velocity-verlet": _Scheme(_Z, _CENTRAL, _CENTRAL, _Z),
        "backward-euler": _Scheme(
            multiply(_Z, _Z), multiply(_Z, _DIFFERENCE), multiply(_Z, _DIFFERENCE), multiply(_Z, _Z)
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
        add(times(m, multiply(_DIFFERENCE, _DIFFERENCE)), losses),
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


_GIVES_OUT = "the body itself would give out energy"
_DRIVES = "a damper below 0 drives the body"
_LONGEST = 40
"""Samples of delay each way."""


@dataclass(frozen=True)
class CoupledBody(Environment):
    """A mass behind a virtual coupling, ``f = K_c (x − y) + B_c (w − v)``, as an integrator steps it.

    Parameters
    ----------
    stiffness
        K_c ≥ 0 of the coupling [N/m; N·m/rad].
    damping
        B_c ≥ 0 of the coupling [N·s/m; N·m·s/rad]: the speed of the handle is its backward difference, that
        of the body the integrator's own.
    virtual_mass
        M > 0 of the body [kg; kg·m²].
    body_damping, body_stiffness
        B ≥ 0 and K ≥ 0 from the body to the ground [N·s/m; N·m·s/rad], [N/m; N·m/rad]. Default 0.
    integrator
        "semi-implicit-euler" (default), "forward-euler", "velocity-verlet", "runge-kutta-2" or "-4", with
        the force held over the step; "backward-euler", "implicit-midpoint" or "trapezoidal".
    exchange_delay
        Samples that a message takes each way to the process that steps the body, a whole number up to 40.
        Default 0: one process.
    wave_impedance
        R > 0 [N·s/m; N·m·s/rad], for processes that exchange waves; None (default): force, and position
        and speed.

    Raises
    ------
    InputError
        If a number is outside its bound, the integrator is none of these, or there are waves and no delay.

    References
    ----------
    Colgate, Stanley & Brown, IROS 1995; Anderson & Spong, IEEE Transactions on Automatic Control 34, 1989.
    """

    stiffness: Certain = exact("stiffness", bound="≥ 0", why=NEGATIVE_SPRING)
    damping: Certain = exact("virtual_damping", bound="≥ 0", why=_DRIVES)
    virtual_mass: Certain = exact(
        "virtual_mass", bound="> 0", why="a body without mass has no speed to be stepped"
    )
    body_damping: Certain = exact("body_damping", 0, "≥ 0", _GIVES_OUT)
    body_stiffness: Certain = exact("body_stiffness", 0, "≥ 0", _GIVES_OUT)
    integrator: Integrator = word(*get_args(Integrator))
    exchange_delay: Certain = exact(
        plain("exchange_delay", "samples that a message takes each way to the process of the body", "d"),
        0,
        "≥ 0",
        "a message cannot come before it is sent",
    )
    wave_impedance: CertainOrNone = exact("wave_impedance", None, "> 0", "it is that of a transmission line")

    def __post_init__(self) -> None:
        super().__post_init__()
        d = self.exchange_delay.fraction
        if d.denominator != 1 or d > _LONGEST:
            raise InputError(
                f"exchange_delay is a whole number of samples up to {_LONGEST}, got {self.exchange_delay:g}: "
                "messages are read once a sample; give the delay that is never exceeded"
            )
        if self.wave_impedance is not None and d == 0:
            raise InputError(
                "wave_impedance is that of the line between two processes, and without exchange_delay there "
                "is none: leave it out, or give the delay"
            )

    def pulse_transfer_function(self, sample_period: Fraction) -> RationalFunction:
        """H(z) [N/m]; common factors are kept."""
        t, k, b = sample_period, self.stiffness.fraction, self.damping.fraction
        body = self._exchanged(t)
        loaded = add(body.denominator, add(times(k, body.position), times(b, body.velocity)))
        return RationalFunction(
            multiply((k * t + b, -b), body.denominator), multiply((t, Fraction(0)), loaded)
        )

    def _exchanged(self, period: Fraction) -> SteppedBody:
        """Position and speed as they come back."""
        m, b, k = (n.fraction for n in (self.virtual_mass, self.body_damping, self.body_stiffness))
        body = stepped(self.integrator, Body(m, b, k, period))
        way = (Fraction(1), *[Fraction(0)] * (2 * int(self.exchange_delay)))
        if self.wave_impedance is None:
            return body._replace(denominator=multiply(way, body.denominator))
        r, lag = self.wave_impedance.fraction, (period, Fraction(0))
        moves, still = _mobility(body)
        moved, still = times(r, moves), multiply(lag, still)
        out, back = multiply(way, add(still, moved)), add(still, times(Fraction(-1), moved))
        slower, faster = add(out, times(Fraction(-1), back)), times(r, add(out, back))
        return SteppedBody(
            multiply(lag, slower), multiply(_DIFFERENCE, slower), multiply(_DIFFERENCE, faster)
        )

    def describe(self, motion: str = "linear") -> str:
        named = {"stiffness": "", "damping": "", "virtual_mass": "before a mass of "}
        parts = [f"{before}{self.with_unit(name, motion)}" for name, before in named.items()]
        if self.body_damping or self.body_stiffness:
            parts.append(
                f"on {self.with_unit('body_damping', motion)} and {self.with_unit('body_stiffness', motion)}"
            )
        parts.append(f"by {self.integrator.replace('-', ' ')}")
        if self.exchange_delay:
            parts.append(f"{self.exchange_delay:g} sample{'s' * (self.exchange_delay != 1)} away")
        if self.wave_impedance is not None:
            parts.append(f"through a line of {self.with_unit('wave_impedance', motion)}")
        return f"virtual coupling, {', '.join(parts)}"


def _mobility(body: SteppedBody) -> tuple[Polynomial, Polynomial]:
    """(z − 1) Y, numerator and denominator; without the drift of a free body, which no move shows."""
    if sum(body.denominator):
        return multiply(_DIFFERENCE, body.position), body.denominator
    return body.position, tuple(accumulate(body.denominator[:-1]))


# What a display of admittance renders: a body that answers the hand's force with a velocity.
#
#     implicit   (M + B T + K T²) v_k = M v_{k−1} + T (φ_k − K y_k)
#     explicit   M v_k = M v_{k−1} + T (φ_{k−1} − B v_{k−1} − K y_{k−1})
#                y_{k+1} = y_k + T v_k
#
# φ is the force that was read, y where the body is; its spring ends at y = 0.  Both are the body M v̇ + B v +
# K y = f in one step of Euler, backward and forward: the explicit one answers a sample later.

Integration = Literal["implicit", "explicit"]

INTEGRATIONS: tuple[Integration, ...] = ("implicit", "explicit")


@dataclass(frozen=True)
class VirtualBody(Parametric):
    """A mass with a damper and a spring to the ground, ``M v̇ + B v + K y = f``, stepped with the samples.

    Parameters
    ----------
    mass
        M > 0 [kg].
    damping
        B ≥ 0 [N·s/m].
    stiffness
        K ≥ 0, to y = 0 [N/m].
    integration
        "implicit" (default), Euler backward; "explicit", forward, a sample later.

    Raises
    ------
    InputError
        If a number is outside its bound, or integration is none of the two.
    """

    mass: Certain = exact(
        "mass",
        bound="> 0",
        why="a body without mass follows every jump of the force; a light one is unstable against a stiff "
        "hand, see zwidth.stability.stable_virtual_masses",
    )
    damping: Certain = exact("virtual_damping", 0, "≥ 0", _GIVES_OUT)
    stiffness: Certain = exact("stiffness", 0, "≥ 0", _GIVES_OUT)
    integration: Integration = word(*INTEGRATIONS)

    def describe(self) -> str:
        """The body with its numbers, on one line."""
        parts = [shown(self.mass, "kg", 6)]
        parts += [shown(self.damping, "N*s/m", 6)] if self.damping else []
        parts += [shown(self.stiffness, "N/m", 6)] if self.stiffness else []
        return f"virtual body, {', '.join(parts)}, {self.integration}"
