"""An input that takes more out of a port than a level allows, with its exact energy.

With φ a signal for each axis that begins at rest, u = D φ and y = N φ answer each other through
the port (D and N as differential operators, or of shifts), and what the port absorbs above the
level σ is a quadratic form of φ:

    W = ∫ uᵀy − σ uᵀu dt,   discrete  W = Σ uᵀy − σ uᵀu

burst
    φ_i = (1 − cos Ωt)ᵏ (α_i cos mΩt + β_i sin mΩt) over one period 2π/Ω: a sinusoid that fades in and
    out, every axis with an amplitude and a phase of its own.  It has lines at (m + j)Ω, |j| ≤ k, with
    b_j = (−1)ʲ C(2k, k + j)/2ᵏ, so that with a_i = α_i − jβ_i
    W = (π/Ω) Σ b_j² aᴴ Π_σ a, Π_σ at each line: rational but for π.
polynomial
    φ_i = Σ a_ij xʳ⁺ʲ, x = t/τ, on 0 ≤ t ≤ τ, which may end away from rest: for what grows.
sequence
    φ_i as a list of numbers, for discrete ports; it too may end away from rest.
"""

from __future__ import annotations

from collections.abc import Callable, Iterator, Sequence
from dataclasses import dataclass
from fractions import Fraction
from functools import partial
from math import comb, cos, pi, sin
from typing import Literal

from flint import fmpq, fmpq_mat, fmpq_poly, fmpz

from zwidth.passivity.linear.exact_algebra import as_real
from zwidth.passivity.ports.port import Polynomials, Port
from zwidth.quantity.balls import as_fmpq, as_fraction

Played = list[list[float]]
Signals = list[fmpq_poly]
Axes = tuple[tuple[Fraction, ...], ...]


@dataclass(frozen=True)
class Motion:
    """φ, see the module; for each axis α_i, β_i, or a_i0, a_i1 …, or φ_i(0), φ_i(1) …

    `numbers` of a burst are Ω [rad/s], m, k; of a polynomial τ [s], r; of a sequence none.
    """

    kind: Literal["burst", "polynomial", "sequence"]
    numbers: tuple[Fraction, ...]
    axes: Axes


def absorbed(port: Port, level: Fraction, motion: Motion) -> Fraction:
    """W of a motion, exactly; of a burst W/π."""
    if motion.kind == "burst":
        return _burst_energy(port, level, motion)
    pairing, unit = (_dotted, Fraction(1)) if motion.kind == "sequence" else (_integral, motion.numbers[0])
    return unit * _paired(answers(port, motion), level, pairing)


def absorbed_in_samples(port: Port, level: Fraction, rows: Sequence[Sequence[int]]) -> Fraction:
    """W of a sequence of whole numbers, a row for each axis."""
    return _paired(_in_samples(port, [fmpq_poly(list(row)) for row in rows], len(rows[0])), level, _dotted)


def _paired(
    sides: tuple[Signals, Signals], level: Fraction, pairing: Callable[[fmpq_poly, fmpq_poly], fmpq]
) -> Fraction:
    sigma, total = as_fmpq(level), fmpq(0)
    for u, y in zip(*sides, strict=True):
        total += pairing(u, y - sigma * u)
    return as_fraction(total)


def _dotted(p: fmpq_poly, q: fmpq_poly) -> fmpq:
    both = zip(p.numer().coeffs(), q.numer().coeffs(), strict=False)
    return fmpq(sum((a * b for a, b in both), fmpz(0)), p.denom() * q.denom())


def _integral(p: fmpq_poly, q: fmpq_poly) -> fmpq:
    return (p * q).integral()(1)


def _burst_energy(port: Port, level: Fraction, motion: Motion) -> Fraction:
    """W/π, line by line."""
    step, cycles, power = motion.numbers
    total = fmpq(0)
    for j, b in _lines(int(power)):
        at = fmpq(0), as_fmpq((cycles + j) * step)
        total += as_fmpq(b * b) * absorbed_at(port, level, at, motion.axes)
    return as_fraction(total) / step


def answers(port: Port, motion: Motion) -> tuple[Signals, Signals]:
    """u and y of a polynomial in x = t/τ, or of a sequence Σ u(k) xᵏ; axis by axis."""
    rows = [[as_fmpq(a) for a in row] for row in motion.axes]
    if motion.kind == "sequence":
        return _in_samples(port, [fmpq_poly(row) for row in rows], len(rows[0]))
    tau, lowest = motion.numbers
    latent = [fmpq_poly([fmpq(0)] * int(lowest) + row) for row in rows]
    return _both_sides(port, latent, partial(_differentiated, pace=1 / as_fmpq(tau)))


def _in_samples(port: Port, latent: Signals, length: int) -> tuple[Signals, Signals]:
    return _both_sides(port, latent, partial(_shifted, order=port.order, length=length))


def _both_sides(
    port: Port, latent: Signals, apply: Callable[[fmpq_poly, Sequence[int]], fmpq_poly]
) -> tuple[Signals, Signals]:
    def answer_of(side: Polynomials) -> Signals:
        return [
            sum((apply(phi, p) for phi, p in zip(latent, row, strict=True)), fmpq_poly([])) for row in side
        ]

    return answer_of(port.inputs), answer_of(port.outputs)


def _shifted(phi: fmpq_poly, ascending: Sequence[int], order: int, length: int) -> fmpq_poly:
    """Σ a_i φ(k + i − order) while φ is given, φ = 0 before."""
    lags = [0] * (order + 1 - len(ascending)) + list(ascending[::-1])
    return fmpq_poly((phi * fmpq_poly(lags)).coeffs()[:length])


def _differentiated(phi: fmpq_poly, ascending: Sequence[int], pace: fmpq) -> fmpq_poly:
    total = fmpq_poly([])
    for c in ascending:
        total += c * phi
        phi = phi.derivative() * pace
    return total


def played(port: Port, motion: Motion, points: int) -> tuple[list[float], Played, Played]:
    """(t, u, y) to rounding: the samples, or so many points from beginning to end."""
    if motion.kind == "burst":
        return _played_burst(port, motion, points)
    sides = answers(port, motion)
    if motion.kind == "sequence":
        length = range(len(motion.axes[0]))
        u, y = ([[to_float(p[k]) for k in length] for p in side] for side in sides)
        return [k * float(port.period) for k in length], u, y
    x = [Fraction(k, points - 1) for k in range(points)]
    u, y = ([[to_float(p(as_fmpq(at))) for at in x] for p in side] for side in sides)
    return [float(motion.numbers[0] * at) for at in x], u, y


def _played_burst(port: Port, motion: Motion, points: int) -> tuple[list[float], Played, Played]:
    """The sum of the lines, each turned and scaled by D or N."""
    step, cycles, power = motion.numbers
    x = [k / (points - 1) for k in range(points)]
    sides: list[Played] = []
    for entries in (port.inputs, port.outputs):
        total = [[0.0] * points for _ in range(port.axes)]
        for j, b in _lines(int(power)):
            turn, at = 2 * pi * float(cycles + j), (fmpq(0), as_fmpq((cycles + j) * step))
            for axis, line in enumerate(answer(entries, at, motion.axes)):
                real, imaginary = (float(as_fraction(v) * b) for v in line)
                total[axis] = [
                    t + real * cos(turn * at) - imaginary * sin(turn * at)
                    for t, at in zip(total[axis], x, strict=True)
                ]
        sides.append(total)
    return [2 * pi / float(step) * at for at in x], sides[0], sides[1]


def _lines(power: int) -> Iterator[tuple[int, Fraction]]:
    """(j, b_j) of (1 − cos x)ᵏ = Σ b_j cos jx."""
    for j in range(-power, power + 1):
        yield j, (-1) ** (j % 2) * Fraction(comb(2 * power, power + j), 2**power)


Point = tuple[fmpq, fmpq]
"""Real and imaginary part, rational."""


def place(port: Port, tangent: Fraction) -> Point:
    """s = jω, ω = tangent; or z = e^{jθ}, tan θ/2 = tangent: rational on the unit circle."""
    t = as_fmpq(tangent)
    if port.time == "continuous":
        return fmpq(0), t
    return (1 - t * t) / (1 + t * t), 2 * t / (1 + t * t)


def answer(side: Polynomials, at: Point, axes: Axes) -> list[Point]:
    """D φ or N φ of φ = a eˢᵗ, a_i = α_i − jβ_i."""
    real, imaginary = _parts(side, at)
    alpha, beta = (fmpq_mat([[as_fmpq(x)] for x in column]) for column in zip(*axes, strict=True))
    told = real * alpha + imaginary * beta, imaginary * alpha - real * beta
    return list(zip(*(part.entries() for part in told), strict=True))


def absorbed_at(port: Port, level: Fraction, at: Point, axes: Axes) -> fmpq:
    """aᴴ Π_σ a: what a line of the latent a absorbs above the level."""
    alpha, beta = zip(*axes, strict=True)
    a = fmpq_mat([[as_fmpq(x)] for x in (*alpha, *(-b for b in beta))])
    return (a.transpose() * fmpq_mat(as_real(*form_at(port, level, at))) * a)[0, 0]


def form_at(port: Port, level: Fraction, at: Point) -> tuple[fmpq_mat, fmpq_mat]:
    """Π_σ at a point, its real and its imaginary part."""
    (u, v), (y, z) = (_parts(side, at) for side in (port.inputs, port.outputs))
    y, z = y - u * as_fmpq(level), z - v * as_fmpq(level)
    real, imaginary = u.transpose() * y + v.transpose() * z, u.transpose() * z - v.transpose() * y
    return (real + real.transpose()) * fmpq(1, 2), (imaginary - imaginary.transpose()) * fmpq(1, 2)


def _parts(side: Polynomials, at: Point) -> tuple[fmpq_mat, fmpq_mat]:
    """Of D or N at a point x + jy: what is left of each entry over (s − x)² + y² is a line in s."""
    (x, y), size = at, len(side)
    over = fmpq_poly([x * x + y * y, -2 * x, 1])
    lines = [fmpq_poly(list(p)) % over for row in side for p in row]
    real, imaginary = [p[0] + p[1] * x for p in lines], [p[1] * y for p in lines]
    return fmpq_mat(size, size, real), fmpq_mat(size, size, imaginary)


def to_float(value: fmpq) -> float:
    """The nearest double."""
    return float(as_fraction(value))
