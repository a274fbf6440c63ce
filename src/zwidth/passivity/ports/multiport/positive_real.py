"""Whether a port of several axes is positive real at a level, and the proof.

    Π_σ = ½(Dᴴ N + Nᴴ D) − σ Dᴴ D ⪰ 0 on the axis (circle)
    D (N + (g − σ) D)⁻¹ is stable, for one g > 0 and then for every

The first says that no e_k(Π_σ), the sum of the principal minors of size k, is negative: with
Π_σ Hermitian, det(λ + Π_σ) = Σ e_k λ^{m−k} then has no root λ > 0.  Each e_k is a polynomial in
c = cos θ, for the coefficients are real and θ and −θ give the same; most of them have a power of
|d|² as a factor, which is left out of the proof of the sign.
"""

from __future__ import annotations

from dataclasses import dataclass
from fractions import Fraction
from math import comb

from flint import fmpq, fmpq_poly, fmpz_poly

from zwidth.passivity.linear.positivity import Positivity, prove_nonnegative, where_negative
from zwidth.passivity.ports.multiport.circle import ONE
from zwidth.passivity.ports.multiport.leverrier import leverrier
from zwidth.passivity.ports.multiport.port import MatrixPort
from zwidth.passivity.ports.port import decays
from zwidth.passivity.ports.positive_real import OFFSET


@dataclass(frozen=True)
class Minor:
    """e_k = |d|^{2·power} q with q ≥ 0 on [−1, 1]."""

    power: int
    positivity: Positivity


@dataclass(frozen=True)
class MatrixProof:
    """The signs of e_1 … e_m, and the stable matrix R/π = D (N + (g − σ) D)⁻¹ in ascending powers."""

    minors: tuple[Minor, ...]
    denominator: tuple[Fraction, ...]
    numerators: tuple[tuple[tuple[Fraction, ...], ...], ...]


def prove_matrix_level(port: MatrixPort, level: Fraction) -> MatrixProof | None:
    """The proof that the port is positive real at the level; None if it is not."""
    minors = prove_minors(port, level)
    if isinstance(minors, Fraction):
        return None
    stable = stable_resolvent(port, OFFSET - level)
    return None if stable is None else MatrixProof(minors, *stable)


def prove_minors(port: MatrixPort, level: Fraction) -> tuple[Minor, ...] | Fraction:
    """The proof that Π_σ ⪰ 0 on the whole circle, or a rational c of (−1, 1) where it is not."""
    proved = []
    for k, minor in enumerate(minors_at(port, fmpq(level.numerator, level.denominator))):
        q, power = without_weight(minor, port.weight, k)
        sign = prove_nonnegative(q)
        if isinstance(sign, Fraction):
            return where_negative(minor.numer(), sign)  # beside a zero of |d|², where Π_σ vanishes
        proved.append(Minor(power, sign))
    return tuple(proved)


def minors_at(port: MatrixPort, level: fmpq | int) -> list[fmpq_poly]:
    """e_1 … e_m of Π_σ, in c."""
    if not port.is_direct:
        return [minor.real for minor in leverrier(port.form(level), ONE).minors]
    size, shift = port.axes, port.weight * -level  # Π_σ = Π_0 − σ|d|²
    fixed = [fmpq_poly([1]), *port.minors_at_zero]
    powers = [fmpq_poly([1])]
    for _ in range(size):
        powers.append(powers[-1] * shift)
    return [
        sum((comb(size - j, k - j) * fixed[j] * powers[k - j] for j in range(k + 1)), fmpq_poly([]))
        for k in range(1, size + 1)
    ]


def without_weight(minor: fmpq_poly, weight: fmpq_poly, most: int) -> tuple[fmpz_poly, int]:
    """(q, power) with minor = weight^power · q up to a positive factor, power ≤ most."""
    power = 0
    while minor.degree() >= 0 and power < most and minor % weight == 0:
        minor, power = minor // weight, power + 1
    return minor.numer(), power


def stable_resolvent(
    port: MatrixPort, gain: Fraction
) -> tuple[tuple[Fraction, ...], tuple[tuple[tuple[Fraction, ...], ...], ...]] | None:
    """R/π = D (N + gain·D)⁻¹ if it is proper and every root of π decays."""
    found = port.resolvent(fmpq(gain.numerator, gain.denominator))
    if found is None:
        return None
    denominator, numerators = found
    proper = all(entry.degree() <= denominator.degree() for row in numerators for entry in row)
    if not proper or not decays([int(c) for c in denominator.numer().coeffs()], port.time):
        return None
    return _fractions(denominator), tuple(tuple(_fractions(p) for p in row) for row in numerators)


def _fractions(p: fmpq_poly) -> tuple[Fraction, ...]:
    return tuple(Fraction(int(c.p), int(c.q)) for c in p.coeffs())
