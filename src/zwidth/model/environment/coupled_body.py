"""A simulated body behind a virtual coupling, stepped with the samples as people write it.

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
from typing import get_args

from zwidth.errors import InputError
from zwidth.model.environment.environment import Environment, RationalFunction, add, multiply
from zwidth.model.environment.integrators import Body, Integrator, Polynomial, SteppedBody, stepped, times
from zwidth.model.environment.wall import NEGATIVE_SPRING
from zwidth.quantity.exact import Exact
from zwidth.quantity.parameter import Certain, CertainOrNone, parameter, plain, word

_GIVES_OUT = "the body itself would give out energy"
_DRIVES = "a damper below 0 drives the body"
_STEP = (Fraction(1), Fraction(-1))
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

    stiffness: Certain = parameter("stiffness", kept=Exact, bound="≥ 0", why=NEGATIVE_SPRING)
    damping: Certain = parameter("virtual_damping", kept=Exact, bound="≥ 0", why=_DRIVES)
    virtual_mass: Certain = parameter(
        "virtual_mass", kept=Exact, bound="> 0", why="a body without mass has no speed to be stepped"
    )
    body_damping: Certain = parameter("body_damping", 0, kept=Exact, bound="≥ 0", why=_GIVES_OUT)
    body_stiffness: Certain = parameter("body_stiffness", 0, kept=Exact, bound="≥ 0", why=_GIVES_OUT)
    integrator: Integrator = word(*get_args(Integrator))
    exchange_delay: Certain = parameter(
        plain("exchange_delay", "samples that a message takes each way to the process of the body", "d"),
        0,
        kept=Exact,
        bound="≥ 0",
        why="a message cannot come before it is sent",
    )
    wave_impedance: CertainOrNone = parameter(
        "wave_impedance", None, kept=Exact, bound="> 0", why="it is that of a transmission line"
    )

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
        return SteppedBody(multiply(lag, slower), multiply(_STEP, slower), multiply(_STEP, faster))

    def describe(self, motion: str = "linear") -> str:
        """The law with its numbers, on one line."""
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
        return multiply(_STEP, body.position), body.denominator
    return body.position, tuple(accumulate(body.denominator[:-1]))
