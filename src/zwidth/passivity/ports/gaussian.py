"""Vectors and matrices of exact complex numbers, at one frequency."""

from __future__ import annotations

from collections.abc import Sequence
from fractions import Fraction
from typing import NamedTuple

from flint import fmpq

from zwidth.passivity.ports.port import Polynomials, Port
from zwidth.quantity.balls import as_fmpq, as_fraction


class Gaussian(NamedTuple):
    """real + j imaginary, rationals."""

    real: fmpq
    imaginary: fmpq


Vector = Sequence[Gaussian]
ZERO = Gaussian(fmpq(0), fmpq(0))


def place(port: Port, tangent: Fraction) -> Gaussian:
    """s = jω, ω = tangent; or z = e^{jθ}, tan θ/2 = tangent: rational on the unit circle."""
    t = as_fmpq(tangent)
    if port.time == "continuous":
        return Gaussian(fmpq(0), t)
    return Gaussian((1 - t * t) / (1 + t * t), 2 * t / (1 + t * t))


def answer(side: Polynomials, at: Gaussian, latent: Vector) -> list[Gaussian]:
    """D φ or N φ of φ = latent · eˢᵗ."""
    return [_dot([value(p, at) for p in row], latent) for row in side]


def value(ascending: Sequence[int], at: Gaussian) -> Gaussian:
    """A polynomial at a point."""
    total = ZERO
    for c in reversed(ascending):
        total = _times(total, at)
        total = Gaussian(total.real + c, total.imaginary)
    return total


def absorbed_at(port: Port, level: Fraction, at: Gaussian, latent: Vector) -> fmpq:
    """φᴴ Π_σ φ: what a line of the latent φ absorbs above the level."""
    u, y = (answer(side, at, latent) for side in (port.inputs, port.outputs))
    sigma, total = as_fmpq(level), fmpq(0)
    for a, b in zip(u, y, strict=True):
        total += a.real * b.real + a.imaginary * b.imaginary - sigma * (a.real**2 + a.imaginary**2)
    return total


def form_at(port: Port, level: Fraction, at: Gaussian) -> list[list[Gaussian]]:
    """Π_σ at a point, by polarization of its columns."""
    sigma, size = as_fmpq(level), range(port.axes)
    u, y = ([[value(side[k][j], at) for k in size] for j in size] for side in (port.inputs, port.outputs))
    above = [
        [
            Gaussian(b.real - sigma * a.real, b.imaginary - sigma * a.imaginary)
            for a, b in zip(p, q, strict=True)
        ]
        for p, q in zip(u, y, strict=True)
    ]

    def entry(i: int, j: int) -> Gaussian:
        left = _dot([_conjugate(a) for a in u[i]], above[j])
        right = _dot([_conjugate(a) for a in above[i]], u[j])
        return Gaussian((left.real + right.real) / 2, (left.imaginary + right.imaginary) / 2)

    return [[entry(i, j) for j in size] for i in size]


def to_float(value: fmpq) -> float:
    """The nearest double."""
    return float(as_fraction(value))


def _dot(row: Vector, column: Vector) -> Gaussian:
    total = ZERO
    for a, b in zip(row, column, strict=True):
        product = _times(a, b)
        total = Gaussian(total.real + product.real, total.imaginary + product.imaginary)
    return total


def _times(a: Gaussian, b: Gaussian) -> Gaussian:
    return Gaussian(a.real * b.real - a.imaginary * b.imaginary, a.real * b.imaginary + a.imaginary * b.real)


def _conjugate(a: Gaussian) -> Gaussian:
    return Gaussian(a.real, -a.imaginary)
