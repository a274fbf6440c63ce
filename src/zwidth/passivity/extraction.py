"""An input that takes more out of a port than a level allows, with its exact energy.

With φ a signal that begins at rest, u = D φ and y = N φ answer each other through
F = N/D (D and N as differential operators, or of shifts), and what the port absorbs
above the level σ is a quadratic form of φ:

    W = ∫ u y − σ u² dt,   discrete  W = Σ u y − σ u²

burst
    φ = (1 − cos Ωt)ᵏ cos mΩt over one period 2π/Ω: a sinusoid that fades in and
    out.  It has lines at (m + j)Ω, |j| ≤ k, with b_j = (−1)ʲ C(2k, k + j)/2ᵏ, so that
    W = (π/Ω) Σ b_j² [Re N D̄ − σ |D|²], rational but for π.
polynomial
    φ = Σ a_j xʳ⁺ʲ, x = t/τ, on 0 ≤ t ≤ τ, which may end away from rest: for what grows.
sequence
    φ as a list of numbers, for discrete ports; it too may end away from rest.
"""

from __future__ import annotations

from collections.abc import Iterator, Sequence
from dataclasses import dataclass
from fractions import Fraction
from math import acos, comb, cos, log10, pi, sin, sqrt
from typing import Literal

from flint import fmpq, fmpz_poly

from zwidth.passivity.elimination import negative_direction
from zwidth.passivity.port import Port
from zwidth.passivity.positive_real import above_level, pole_places
from zwidth.passivity.positivity import prove_nonnegative

MOST_CYCLES = 1 << 22
LONGEST_SEQUENCE = 1 << 17
_TERMS = 12
_LENGTHS = (2, 4, 8, 16, 32, 48)
_LARGEST_ORDER = 24


@dataclass(frozen=True)
class Motion:
    """φ, see the module.

    Parameters
    ----------
    kind
        "burst", "polynomial" or "sequence".
    numbers
        burst: Ω [rad/s], m, k.  polynomial: τ [s], r, a_0, a_1 …  sequence: φ_0, φ_1 …
    """

    kind: Literal["burst", "polynomial", "sequence"]
    numbers: tuple[Fraction, ...]


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


def absorbed(port: Port, level: Fraction, motion: Motion) -> Fraction:
    """W of a motion, exactly; of a burst W/π."""
    if motion.kind == "burst":
        step, cycles, power = motion.numbers
        return _burst_energy(port, level, step, int(cycles), int(power))
    u, y = signals(port, motion)
    if motion.kind == "sequence":
        return sum((a * b - level * a * a for a, b in zip(u, y, strict=True)), Fraction(0))
    return motion.numbers[0] * _integral(u, _above(y, u, level))


def signals(port: Port, motion: Motion) -> tuple[list[Fraction], list[Fraction]]:
    """u and y: samples of a sequence, coefficients in ascending powers of x of a polynomial."""
    sides = (port.denominator, port.numerator)
    if motion.kind == "sequence":
        u, y = (_shifted(motion.numbers, side, port.order) for side in sides)
    else:
        tau, lowest, *a = motion.numbers
        phi = [Fraction(0)] * int(lowest) + a
        u, y = (_differentiated(phi, side, tau) for side in sides)
    return u, y


def played(port: Port, motion: Motion, points: int) -> tuple[list[float], list[float], list[float]]:
    """(t, u, y) to rounding: the samples, or so many points from beginning to end."""
    if motion.kind == "burst":
        return _played_burst(port, motion, points)
    u, y = signals(port, motion)
    if motion.kind == "sequence":
        return [k * float(port.period) for k in range(len(u))], [*map(float, u)], [*map(float, y)]
    x = [Fraction(k, points - 1) for k in range(points)]
    tau = motion.numbers[0]
    return (
        [float(tau * at) for at in x],
        [float(_horner(u, at)) for at in x],
        [float(_horner(y, at)) for at in x],
    )


def _played_burst(port: Port, motion: Motion, points: int) -> tuple[list[float], list[float], list[float]]:
    """The sum of the lines, each turned and scaled by D or N."""
    step, cycles, power = motion.numbers
    x = [k / (points - 1) for k in range(points)]
    played: list[list[float]] = []
    for side in (port.denominator, port.numerator):
        total = [0.0] * points
        for j, b in lines(int(power)):
            real, imaginary = (float(b * part) for part in on_axis(side, (cycles + j) * step))
            turn = 2 * pi * float(cycles + j)
            total = [
                t + real * cos(turn * at) - imaginary * sin(turn * at) for t, at in zip(total, x, strict=True)
            ]
        played.append(total)
    return [2 * pi / float(step) * at for at in x], played[0], played[1]


def _horner(ascending: Sequence[Fraction], x: Fraction) -> Fraction:
    total = Fraction(0)
    for c in reversed(ascending):
        total = total * x + c
    return total


def _sign_at(form: fmpz_poly, c: Fraction) -> fmpq:
    return form(fmpq(c.numerator, c.denominator))


def _burst(port: Port, level: Fraction, cosine: Fraction) -> Motion | None:
    """As few cycles as are enough; smooth enough for u and y to be without jumps."""
    omega, power = sqrt((1 - cosine) / (1 + cosine)), port.order // 2 + 1
    cycles = power + 1
    while cycles <= MOST_CYCLES:
        step = Fraction(f"{omega / cycles:.9g}")
        if _burst_energy(port, level, step, cycles, power) < 0:
            return Motion("burst", (step, Fraction(cycles), Fraction(power)))
        cycles *= 2
    return None


def _burst_energy(port: Port, level: Fraction, step: Fraction, cycles: int, power: int) -> Fraction:
    total = Fraction(0)
    for j, b in lines(power):
        n, d = (on_axis(side, (cycles + j) * step) for side in (port.numerator, port.denominator))
        total += b * b * (n[0] * d[0] + n[1] * d[1] - level * (d[0] ** 2 + d[1] ** 2))
    return total / step


def lines(power: int) -> Iterator[tuple[int, Fraction]]:
    """(j, b_j) of (1 − cos x)ᵏ = Σ b_j cos jx."""
    for j in range(-power, power + 1):
        yield j, (-1) ** (j % 2) * Fraction(comb(2 * power, power + j), 2**power)


def on_axis(ascending: Sequence[int], omega: Fraction) -> tuple[Fraction, Fraction]:
    """Real and imaginary part of a polynomial at s = jω."""
    parts, power = [Fraction(0), Fraction(0)], Fraction(1)
    for i, c in enumerate(ascending):
        parts[i % 2] += (-1) ** (i // 2) * c * power
        power *= omega
    return parts[0], parts[1]


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
        u, y = ([_shifted(e, side, port.order) for e in units] for side in (port.denominator, port.numerator))
        form = [[_pairing(u[i], y[i], u[j], y[j], level) for j in range(length)] for i in range(length)]
        found = _verified(port, level, negative_direction(form), "sequence", ())
        if found is not None:
            return found
    return None


def _pairing(
    u: Sequence[Fraction],
    y: Sequence[Fraction],
    v: Sequence[Fraction],
    z: Sequence[Fraction],
    level: Fraction,
) -> fmpq:
    total = sum(a * d + b * c - 2 * level * a * c for a, b, c, d in zip(u, y, v, z, strict=True))
    return _q(Fraction(total) / 2)


def _polynomial(port: Port, level: Fraction) -> Motion | None:
    """Polynomials over a few durations, of the pace at which the port grows."""
    lowest = port.order
    if lowest > _LARGEST_ORDER:
        return None
    for tau in _durations(port):
        basis = [[Fraction(0)] * (lowest + j) + [Fraction(1)] for j in range(_TERMS)]
        u = [_differentiated(phi, port.denominator, tau) for phi in basis]
        w = [
            _above(_differentiated(phi, port.numerator, tau), v, level)
            for phi, v in zip(basis, u, strict=True)
        ]
        form = [
            [_q((_integral(u[i], w[j]) + _integral(u[j], w[i])) / 2) for j in range(_TERMS)]
            for i in range(_TERMS)
        ]
        found = _verified(port, level, negative_direction(form), "polynomial", (tau, Fraction(lowest)))
        if found is not None:
            return found
    return None


def _above(y: Sequence[Fraction], u: Sequence[Fraction], level: Fraction) -> list[Fraction]:
    return [b - level * a for a, b in zip(u, y, strict=True)]


def _durations(port: Port) -> list[Fraction]:
    """A few times 1/σ of what grows, and of the size of every pole."""
    places = pole_places(port)
    paces = [p.real for p in places if p.real > 1e-9 * abs(p)] + [abs(p) for p in places if p] + [1.0]
    return [Fraction(f"{factor / pace:.3g}") for factor in (2, 8, 32) for pace in paces]


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
    exact = [Fraction(int(x.p), int(x.q)) for x in direction]
    for digits in (3, 6, 12, 24):
        motion = Motion(kind, (*head, *_rounded(exact, digits)))
        if absorbed(port, level, motion) < 0:
            return motion
    return Motion(kind, (*head, *exact))


def _rounded(values: Sequence[Fraction], digits: int) -> list[Fraction]:
    """To so many digits of the largest, as decimals."""
    largest = max(abs(v) for v in values)
    decade = digits - round(log10(largest)) if largest else 0
    unit = Fraction(10) ** decade
    return [Fraction(round(v * unit)) / unit for v in values]


def _shifted(phi: Sequence[Fraction | int], ascending: Sequence[int], order: int) -> list[Fraction]:
    """Σ a_i φ(k + i − order) for as long as φ is given, φ = 0 before."""
    taps = [(order - i, c) for i, c in enumerate(ascending) if c]
    return [Fraction(sum(c * phi[k - lag] for lag, c in taps if lag <= k)) for k in range(len(phi))]


def _differentiated(phi: Sequence[Fraction], ascending: Sequence[int], tau: Fraction) -> list[Fraction]:
    """Σ c_i φ⁽ⁱ⁾ τ⁻ⁱ, in ascending powers of x = t/τ."""
    total, scale = [Fraction(0)] * len(phi), Fraction(1)
    for c in ascending:
        total = [
            t + c * scale * p
            for t, p in zip(total, [*phi, *[Fraction(0)] * (len(total) - len(phi))], strict=True)
        ]
        phi, scale = [k * p for k, p in enumerate(phi)][1:], scale / tau
    return total


def _integral(a: Sequence[Fraction], b: Sequence[Fraction]) -> Fraction:
    """∫ a b dx over [0, 1]."""
    return sum((x * y / (i + j + 1) for i, x in enumerate(a) if x for j, y in enumerate(b) if y), Fraction(0))


def _q(value: Fraction) -> fmpq:
    return fmpq(value.numerator, value.denominator)
