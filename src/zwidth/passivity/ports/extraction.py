"""The search for an input that takes more out of a port than a level allows.

Where the criterion is negative a burst at that frequency does, if it is long enough.
Where it is not, and a pole lies where it may not, energy comes out of what grows: the
form W of polynomials (or short sequences) is then not ≥ 0, and elimination says where.
"""

from __future__ import annotations

from collections.abc import Sequence
from fractions import Fraction
from math import acos, cos, log10, pi, sin, sqrt
from typing import Literal

from flint import fmpq, fmpq_poly, fmpz_poly

from zwidth.passivity.linear.elimination import negative_direction
from zwidth.passivity.linear.positivity import prove_nonnegative
from zwidth.passivity.ports.port import Port
from zwidth.passivity.ports.port_motion import (
    Motion,
    above,
    absorbed,
    burst_energy,
    differentiated,
    shifted,
)
from zwidth.passivity.ports.positive_real import above_level, pole_places
from zwidth.quantity.balls import as_fmpq, as_fraction

MOST_CYCLES = 1 << 22
LONGEST_SEQUENCE = 1 << 17
_TERMS = 24
_LENGTHS = (2, 4, 8, 16, 32, 48)
_LARGEST_ORDER = 24


def find_motion(port: Port, level: Fraction, cosine: Fraction | None) -> Motion | None:
    """A motion with W < 0 at the level, looked for at `cosine` first; None if none is found."""
    form = above_level(port, level)
    negative = cosine if cosine is not None and -1 < cosine < 1 and _sign_at(form, cosine) < 0 else None
    if negative is None:
        found = prove_nonnegative(form)
        negative = found if isinstance(found, Fraction) else None
    if port.time == "discrete":
        burst = None if negative is None else _discrete_burst(port, level, negative)
        return burst or _sequence(port, level)
    burst = None if negative is None else _burst(port, level, negative)
    return burst or _polynomial(port, level)


def _sign_at(form: fmpz_poly, c: Fraction) -> fmpq:
    return form(fmpq(c.numerator, c.denominator))


def _burst(port: Port, level: Fraction, cosine: Fraction) -> Motion | None:
    """As few cycles as are enough; smooth enough for u and y to be without jumps."""
    omega, power = sqrt((1 - cosine) / (1 + cosine)), port.order // 2 + 1
    cycles = power + 1
    while cycles <= MOST_CYCLES:
        step = Fraction(f"{omega / cycles:.9g}")
        if burst_energy(port, level, step, cycles, power) < 0:
            return Motion("burst", (step, Fraction(cycles), Fraction(power)))
        cycles *= 2
    return None


def _discrete_burst(port: Port, level: Fraction, cosine: Fraction) -> Motion | None:
    """A windowed cosine in whole numbers and then rest, doubled in length until it is enough."""
    angle, length = acos(float(cosine)), 8
    while length <= LONGEST_SEQUENCE:
        window = [sin(pi * (i + 1) / (length + 1)) ** 2 for i in range(length)]
        for scale in (10, 1000, 10**6):
            phi = [round(scale * g * cos(angle * (i - (length - 1) / 2))) for i, g in enumerate(window)]
            motion = Motion("sequence", tuple(Fraction(x) for x in (*phi, *[0] * port.order)))
            if any(phi) and absorbed(port, level, motion) < 0:
                return motion
        length *= 2
    return None


def _sequence(port: Port, level: Fraction) -> Motion | None:
    """The first of growing lengths at which the form of φ is not ≥ 0."""
    for length in _LENGTHS:
        units = [[int(i == j) for i in range(length)] for j in range(length)]
        u, y = ([shifted(e, side, port.order) for e in units] for side in (port.denominator, port.numerator))
        form = [[_pairing(u[i], y[i], u[j], y[j], level) for j in range(length)] for i in range(length)]
        found = _verified(port, level, negative_direction(form), "sequence", ())
        if found is not None:
            return found
    return None


def _pairing(
    u: Sequence[Fraction | int],
    y: Sequence[Fraction | int],
    v: Sequence[Fraction | int],
    z: Sequence[Fraction | int],
    level: Fraction,
) -> fmpq:
    total = sum(a * d + b * c - 2 * level * a * c for a, b, c, d in zip(u, y, v, z, strict=True))
    return as_fmpq(Fraction(total) / 2)


def _polynomial(port: Port, level: Fraction) -> Motion | None:
    """Polynomials over a few durations, of the pace at which the port grows."""
    lowest = port.order
    if lowest > _LARGEST_ORDER:
        return None
    for tau in paces(pole_places(port)):
        pairs = [_answers(port, level, tau, lowest + j) for j in range(_TERMS)]
        form = [[(_mean(u * z) + _mean(v * w)) / 2 for v, z in pairs] for u, w in pairs]
        found = _verified(port, level, negative_direction(form), "polynomial", (tau, Fraction(lowest)))
        if found is not None:
            return found
    return None


def _answers(port: Port, level: Fraction, tau: Fraction, power: int) -> tuple[fmpq_poly, fmpq_poly]:
    """u and y − σ u of φ = xⁿ."""
    phi = [Fraction(0)] * power + [Fraction(1)]
    u, y = (differentiated(phi, side, tau) for side in (port.denominator, port.numerator))
    first, second = (fmpq_poly([as_fmpq(c) for c in p]) for p in (u, above(y, u, level)))
    return first, second


def _mean(p: fmpq_poly) -> fmpq:
    """∫ p dx over [0, 1]."""
    return p.integral()(1)


def paces(places: Sequence[complex]) -> list[Fraction]:
    """Durations [s]: a few times 1/σ of what grows among the poles, and of the size of every one."""
    rates = [p.real for p in places if p.real > 1e-9 * abs(p)] + [abs(p) for p in places if p] + [1.0]
    return [Fraction(f"{factor / pace:.3g}") for factor in (2, 8, 32) for pace in rates]


def _verified(
    port: Port,
    level: Fraction,
    direction: list[fmpq] | None,
    kind: Literal["polynomial", "sequence"],
    head: tuple[Fraction, ...],
) -> Motion | None:
    """The direction as a motion, in few digits where these are enough."""
    if direction is None:
        return None
    exact = [as_fraction(x) for x in direction]
    for digits in (3, 6, 12, 24):
        motion = Motion(kind, (*head, *rounded(exact, digits)))
        if absorbed(port, level, motion) < 0:
            return motion
    return Motion(kind, (*head, *exact))


def rounded(values: Sequence[Fraction], digits: int) -> list[Fraction]:
    """To so many digits of the largest, as decimals."""
    largest = max(abs(v) for v in values)
    decade = digits - round(log10(largest)) if largest else 0
    unit = Fraction(10) ** decade
    return [Fraction(round(v * unit)) / unit for v in values]
