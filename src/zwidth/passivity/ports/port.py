"""A linear one-port F = N/D, in continuous or discrete time, on one circle.

    s = (1 − ζ)/(1 + ζ)   continuous: Re s > 0 is |ζ| < 1, ω = tan(θ/2)
    z = 1/ζ               discrete:   |z| > 1 is |ζ| < 1, ωT = θ

so that with c = cos θ both are questions about polynomials on [−1, 1]:
ω² = (1 − c)/(1 + c), and c = −1 is ω = ∞ or the Nyquist frequency.
Everything is rational.
"""

from __future__ import annotations

from collections.abc import Iterable, Sequence
from dataclasses import dataclass
from fractions import Fraction
from functools import cached_property
from math import acos, inf, lcm, pi, sqrt
from typing import Any, Literal

from flint import fmpq_poly, fmpz_poly

from zwidth.environment.environment import Environment
from zwidth.environment.system import Polynomial, is_system, read_system
from zwidth.errors import InputError
from zwidth.passivity.linear.cosines import real_product
from zwidth.passivity.linear.loop import LARGEST_DEGREE
from zwidth.passivity.linear.schur import is_schur
from zwidth.quantity.balls import as_fmpq, as_fraction

Time = Literal["continuous", "discrete"]


@dataclass(frozen=True)
class Port:
    """F = N/D in lowest terms, N and D integer polynomials in ascending powers of s or z.

    Parameters
    ----------
    numerator, denominator
        Coprime integer coefficients; the denominator's last is not zero.
    time
        "continuous" or "discrete".
    period
        T [s] of a discrete port; 1 where it does not say.
    hidden_modes_decay
        False when a factor that N and D had in common does not decay: it is not
        seen at the port and no index speaks of it.
    """

    numerator: tuple[int, ...]
    denominator: tuple[int, ...]
    time: Time
    period: Fraction
    hidden_modes_decay: bool = True

    @property
    def order(self) -> int:
        """The larger degree of N and D."""
        return max(len(self.numerator), len(self.denominator)) - 1

    @property
    def is_zero(self) -> bool:
        """True for F = 0."""
        return not any(self.numerator)

    def inverse(self) -> Port:
        """1/F, what the port is from its output to its input."""
        return Port(self.denominator, self.numerator, self.time, self.period, self.hidden_modes_decay)

    @cached_property
    def on_circle(self) -> tuple[tuple[int, ...], tuple[int, ...]]:
        """N and D as polynomials in ascending powers of ζ, both of length order + 1."""
        return (
            in_zeta(self.numerator, self.order, self.time),
            in_zeta(self.denominator, self.order, self.time),
        )

    @cached_property
    def real_part(self) -> tuple[fmpq_poly, fmpq_poly]:
        """Re(N D̄) and |D|² as polynomials in c, times the same positive factor."""
        n, d = self.on_circle
        return real_product(n, d), real_product(d, d)

    def is_stable_with(self, gain: Fraction) -> bool:
        """True when N + gain · D has every root in the open left half plane (inside the circle)."""
        n, d = self.on_circle
        total = [x * gain.denominator + y * gain.numerator for x, y in zip(n, d, strict=True)]
        return total[0] != 0 and _outside_circle(total)

    def real_part_at(self, c: Fraction) -> float:
        """Re F at cos θ = c; ±inf or nan at a pole."""
        p, w = (as_fraction(v) for v in (r(as_fmpq(c)) for r in self.real_part))
        if w == 0:
            return inf if p > 0 else -inf if p < 0 else float("nan")
        try:
            return float(p / w)
        except OverflowError:
            return inf if p > 0 else -inf

    def frequency(self, cosine: Fraction) -> float:
        """ω/2π [Hz] of c = cos θ; inf for a continuous port at c = −1."""
        return frequency_of(cosine, self.time, self.period)


def read_port(thing: Environment | Any, period: Fraction | None = None) -> Port:
    """A port from a system of python-control or scipy.signal, or from an environment's H(z).

    Raises
    ------
    InputError
        If it is neither, has several inputs or outputs, is not causal in discrete time or of
        too high an order, or does not say whether its time is continuous.
    """
    if isinstance(thing, Environment):
        if period is None:
            raise InputError("an environment has an H(z) at a sample period only; give the device it runs on")
        h = thing.pulse_transfer_function(period)
        return port(h.numerator, h.denominator, "discrete", period)
    if not is_system(thing):
        raise InputError(
            f"a port is a system of python-control or scipy.signal, or an environment; got {thing!r}"
        )
    system = read_system(thing)
    time = said_time(system.time, (system.numerator, system.denominator))
    return port(system.numerator, system.denominator, time, system.sample_period or Fraction(1))


def said_time(time: Time | Literal["unsaid"], polynomials: Iterable[Polynomial]) -> Time:
    """The time that a system says, or any of a constant one."""
    if time == "unsaid" and any(any(p[:-1]) for p in polynomials):
        raise InputError(
            "the system has dt=None and so does not say whether it is G(s) or G(z); give it a dt: 0 for "
            "continuous time, the sample period or True for discrete time"
        )
    return "discrete" if time == "discrete" else "continuous"


def frequency_of(cosine: Fraction, time: Time, period: Fraction) -> float:
    """ω/2π [Hz] of c = cos θ; inf in continuous time at c = −1."""
    if time == "discrete":
        return acos(max(-1.0, min(1.0, float(cosine)))) / (2 * pi * float(period))
    if cosine == -1:
        return inf
    return sqrt((1 - cosine) / (1 + cosine)) / (2 * pi)


def port(numerator: Polynomial, denominator: Polynomial, time: Time, period: Fraction) -> Port:
    """The port of two polynomials in descending powers, in lowest terms."""
    scale = lcm(*(c.denominator for c in (*numerator, *denominator)))
    n, d = (fmpz_poly([int(c * scale) for c in reversed(p)]) for p in (numerator, denominator))
    if d.degree() < 0:
        raise InputError("the denominator of the transfer function is zero")
    if time == "discrete" and n.degree() > d.degree():
        raise InputError("G(z) has more zeros than poles: it would need samples that are still to come")
    order = max(n.degree(), d.degree())
    if order > LARGEST_DEGREE:
        raise InputError(f"the system has order {order}; at most {LARGEST_DEGREE} is decided")
    common = n.gcd(d)
    n, d = n // common, d // common
    decay = n.degree() < 0 or decays([int(c) for c in common.coeffs()], time)
    top = tuple(int(c) for c in n.coeffs()) or (0,)
    return Port(top, tuple(int(c) for c in d.coeffs()), time, period, decay)


def decays(ascending: Sequence[int], time: Time) -> bool:
    """True when every root lies in the open left half plane (inside the circle)."""
    q = in_zeta(ascending, len(ascending) - 1, time)
    return q[0] != 0 and _outside_circle(q)


def _outside_circle(in_zeta: Sequence[int]) -> bool:
    """Every root ζ has |ζ| > 1: from rigorous balls about them, or where these touch the circle exactly."""
    p = fmpz_poly(list(in_zeta))
    sizes = [abs(root) for root, _ in p.complex_roots()] if p.degree() > 0 else []
    if any(size < 1 for size in sizes):
        return False
    return all(size > 1 for size in sizes) or is_schur(in_zeta[::-1])


def in_zeta(ascending: Sequence[int], order: int, time: Time) -> tuple[int, ...]:
    """p(z) ζⁿ, or p(s) (1 + ζ)ⁿ, as a polynomial in ζ with n = order."""
    if time == "discrete":
        padded = [*ascending, *[0] * (order + 1 - len(ascending))]
        return tuple(padded[::-1])
    total, minus, plus = fmpz_poly([]), fmpz_poly([1, -1]), fmpz_poly([1, 1])
    for power, coefficient in enumerate(ascending):
        if coefficient:
            total += coefficient * minus**power * plus ** (order - power)
    return tuple(int(total[i]) for i in range(order + 1))
