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
from math import comb, cos, pi, sin
from typing import Literal

from zwidth.passivity.ports.port import Port


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


def absorbed(port: Port, level: Fraction, motion: Motion) -> Fraction:
    """W of a motion, exactly; of a burst W/π."""
    if motion.kind == "burst":
        step, cycles, power = motion.numbers
        return burst_energy(port, level, step, int(cycles), int(power))
    if motion.kind == "sequence":
        u, y = samples(port, motion)
        return sum(a * b for a, b in zip(u, y, strict=True)) - level * sum(a * a for a in u)
    p, q = polynomials(port, motion)
    return motion.numbers[0] * integral(p, above(q, p, level))


def samples(port: Port, motion: Motion) -> tuple[list[Fraction | int], list[Fraction | int]]:
    """u and y of a sequence."""
    return (
        shifted(motion.numbers, port.denominator, port.order),
        shifted(motion.numbers, port.numerator, port.order),
    )


def polynomials(port: Port, motion: Motion) -> tuple[list[Fraction], list[Fraction]]:
    """u and y of a polynomial, in ascending powers of x = t/τ."""
    tau, lowest, *a = motion.numbers
    phi = [Fraction(0)] * int(lowest) + a
    return differentiated(phi, port.denominator, tau), differentiated(phi, port.numerator, tau)


def played(port: Port, motion: Motion, points: int) -> tuple[list[float], list[float], list[float]]:
    """(t, u, y) to rounding: the samples, or so many points from beginning to end."""
    if motion.kind == "burst":
        return _played_burst(port, motion, points)
    if motion.kind == "sequence":
        u, y = samples(port, motion)
        return [k * float(port.period) for k in range(len(u))], [*map(float, u)], [*map(float, y)]
    tau, x = motion.numbers[0], [Fraction(k, points - 1) for k in range(points)]
    sides = polynomials(port, motion)
    p, q = ([float(_horner(side, at)) for at in x] for side in sides)
    return [float(tau * at) for at in x], p, q


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


def burst_energy(port: Port, level: Fraction, step: Fraction, cycles: int, power: int) -> Fraction:
    """W/π of a burst, line by line."""
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


def above(y: Sequence[Fraction], u: Sequence[Fraction], level: Fraction) -> list[Fraction]:
    """y − σ u."""
    return [b - level * a for a, b in zip(u, y, strict=True)]


def shifted(phi: Sequence[Fraction | int], ascending: Sequence[int], order: int) -> list[Fraction | int]:
    """Σ a_i φ(k + i − order) while φ is given, φ = 0 before; whole numbers stay ints, which are fast."""
    plain = [x.numerator if x.denominator == 1 else x for x in phi]
    taps = [(order - i, c) for i, c in enumerate(ascending) if c]
    return [sum(c * plain[k - lag] for lag, c in taps if lag <= k) for k in range(len(plain))]


def differentiated(phi: Sequence[Fraction], ascending: Sequence[int], tau: Fraction) -> list[Fraction]:
    """Σ c_i φ⁽ⁱ⁾ τ⁻ⁱ, in ascending powers of x = t/τ."""
    total, scale = [Fraction(0)] * len(phi), Fraction(1)
    for c in ascending:
        total = [
            t + c * scale * p
            for t, p in zip(total, [*phi, *[Fraction(0)] * (len(total) - len(phi))], strict=True)
        ]
        phi, scale = [k * p for k, p in enumerate(phi)][1:], scale / tau
    return total


def integral(a: Sequence[Fraction | int], b: Sequence[Fraction | int]) -> Fraction:
    """∫ a b dx over [0, 1]."""
    products = ((i + j + 1, x * y) for i, x in enumerate(a) if x for j, y in enumerate(b) if y)
    return sum((xy * Fraction(1, power) for power, xy in products), Fraction(0))
