"""An input of several axes that takes more out of a port than a level allows, with its exact energy.

As `port_motion`, with one latent signal φ_i for each axis, u = D φ and y = N φ:

    W = ∫ uᵀy − σ uᵀu dt,   discrete  W = Σ uᵀy − σ uᵀu

burst
    φ_i = (1 − cos Ωt)ᵏ (α_i cos mΩt + β_i sin mΩt) over one period 2π/Ω: every axis with an
    amplitude and a phase of its own.  With a_i = α_i − jβ_i and the lines b_j of `port_motion`
    W = (π/Ω) Σ b_j² aᴴ Π_σ a at (m + j)Ω.
polynomial
    φ_i = Σ a_ij xʳ⁺ʲ, x = t/τ, on 0 ≤ t ≤ τ.
sequence
    φ_i as a list of numbers, for discrete ports.
"""

from __future__ import annotations

from collections.abc import Callable, Sequence
from dataclasses import dataclass
from fractions import Fraction
from math import cos, pi, sin
from typing import Literal

from flint import fmpq

from zwidth.passivity.ports.multiport.gaussian import Gaussian, absorbed_at, answer
from zwidth.passivity.ports.multiport.port import MatrixPort
from zwidth.passivity.ports.port_motion import differentiated, integral, lines, shifted
from zwidth.quantity.balls import as_fmpq, as_fraction

Signals = list[list[float]]
Signal = Sequence[Fraction | int]


@dataclass(frozen=True)
class MatrixMotion:
    """φ, see the module.

    Parameters
    ----------
    kind
        "burst", "polynomial" or "sequence".
    numbers
        burst: Ω [rad/s], m, k.  polynomial: τ [s], r.  sequence: none.
    axes
        For each axis: burst α_i, β_i; polynomial a_i0, a_i1 …; sequence φ_i(0), φ_i(1) …
    """

    kind: Literal["burst", "polynomial", "sequence"]
    numbers: tuple[Fraction, ...]
    axes: tuple[tuple[Fraction, ...], ...]

    @property
    def latent(self) -> list[Gaussian]:
        """a_i = α_i − jβ_i of a burst."""
        return [Gaussian(as_fmpq(alpha), -as_fmpq(beta)) for alpha, beta in self.axes]


def absorbed(port: MatrixPort, level: Fraction, motion: MatrixMotion) -> Fraction:
    """W of a motion, exactly; of a burst W/π."""
    if motion.kind == "burst":
        return _burst_energy(port, level, motion)
    if motion.kind == "sequence":
        u, y = samples(port, motion)
        return _summed(u, y, _dotted, level)
    u, y = polynomials(port, motion)
    return motion.numbers[0] * _summed(u, y, integral, level)


def _summed(
    u: list[Signal], y: list[Signal], pairing: Callable[[Signal, Signal], Fraction | int], level: Fraction
) -> Fraction:
    return sum((pairing(a, b) - level * pairing(a, a) for a, b in zip(u, y, strict=True)), Fraction(0))


def _dotted(a: Signal, b: Signal) -> Fraction | int:
    return sum(x * z for x, z in zip(a, b, strict=True))


def _burst_energy(port: MatrixPort, level: Fraction, motion: MatrixMotion) -> Fraction:
    """W/π, line by line."""
    step, cycles, power = motion.numbers
    total, latent = fmpq(0), motion.latent
    for j, b in lines(int(power)):
        at = Gaussian(fmpq(0), as_fmpq((cycles + j) * step))
        total += as_fmpq(b * b) * absorbed_at(port, level, at, latent)
    return as_fraction(total) / step


def samples(port: MatrixPort, motion: MatrixMotion) -> tuple[list[Signal], list[Signal]]:
    """u and y of a sequence, axis by axis."""

    def answer_of(row: tuple[tuple[int, ...], ...]) -> Signal:
        return _added([shifted(phi, p, port.order) for phi, p in zip(motion.axes, row, strict=True)])

    return [answer_of(row) for row in port.inputs], [answer_of(row) for row in port.outputs]


def polynomials(port: MatrixPort, motion: MatrixMotion) -> tuple[list[Signal], list[Signal]]:
    """u and y of a polynomial, in ascending powers of x = t/τ, axis by axis."""
    tau, lowest = motion.numbers
    latent = [[Fraction(0)] * int(lowest) + list(a) for a in motion.axes]

    def answer_of(row: tuple[tuple[int, ...], ...]) -> Signal:
        return _added([differentiated(phi, p, tau) for phi, p in zip(latent, row, strict=True)])

    return [answer_of(row) for row in port.inputs], [answer_of(row) for row in port.outputs]


def _added(signals: Sequence[Signal]) -> Signal:
    return [sum(column) for column in zip(*signals, strict=True)]


def played(port: MatrixPort, motion: MatrixMotion, points: int) -> tuple[list[float], Signals, Signals]:
    """(t, u, y) to rounding: the samples, or so many points from beginning to end."""
    if motion.kind == "burst":
        return _played_burst(port, motion, points)
    if motion.kind == "sequence":
        u, y = samples(port, motion)
        times = [k * float(port.period) for k in range(len(u[0]))]
        return times, [[float(x) for x in a] for a in u], [[float(x) for x in b] for b in y]
    tau, x = motion.numbers[0], [Fraction(k, points - 1) for k in range(points)]
    first, second = (
        [[float(_horner(p, at)) for at in x] for p in side] for side in polynomials(port, motion)
    )
    return [float(tau * at) for at in x], first, second


def _played_burst(
    port: MatrixPort, motion: MatrixMotion, points: int
) -> tuple[list[float], Signals, Signals]:
    """The sum of the lines, each turned and scaled by D or N."""
    step, cycles, power = motion.numbers
    x = [k / (points - 1) for k in range(points)]
    sides: list[Signals] = []
    for entries in (port.inputs, port.outputs):
        total = [[0.0] * points for _ in range(port.axes)]
        for j, b in lines(int(power)):
            turn, at = 2 * pi * float(cycles + j), Gaussian(fmpq(0), as_fmpq((cycles + j) * step))
            for axis, line in enumerate(answer(entries, at, motion.latent)):
                real, imaginary = (float(as_fraction(v) * b) for v in line)
                total[axis] = [
                    t + real * cos(turn * at) - imaginary * sin(turn * at)
                    for t, at in zip(total[axis], x, strict=True)
                ]
        sides.append(total)
    return [2 * pi / float(step) * at for at in x], sides[0], sides[1]


def _horner(ascending: Signal, x: Fraction) -> Fraction:
    total = Fraction(0)
    for c in reversed(ascending):
        total = total * x + c
    return total
