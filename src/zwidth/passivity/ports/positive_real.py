"""Whether a port is positive real at a level, the proof, and the bands of frequency where it is not.

    uᵀy ≥ σ uᵀu wherever Re s > 0 (|z| > 1), for F = N D⁻¹:  Re F ≥ σ

holds exactly if

    Π_σ = ½(Dᴴ N + Nᴴ D) − σ Dᴴ D ⪰ 0 on the axis (circle)
    D (N + (g − σ) D)⁻¹ is stable, for one g > 0 and then for every

since S = (F − σ − g)(F − σ + g)⁻¹ has ‖S‖ ≤ 1 on the boundary by the first line and no pole by the
second, so ‖S‖ ≤ 1 everywhere; and a positive real F − σ plus g > 0 has no zero.  Poles on the axis need
no case of their own: a simple one with a positive residue passes both lines, any other fails one.

The first says that no e_k(Π_σ), the sum of the principal minors of size k, is negative: with
Π_σ Hermitian, det(λ + Π_σ) = Σ e_k λ^{m−k} then has no root λ > 0.  Each e_k is a polynomial in
c = cos θ, for the coefficients are real and θ and −θ give the same; most of them have a power of
|d|² as a factor, which is left out of the proof of the sign.
"""

from __future__ import annotations

from collections.abc import Iterator, Sequence
from dataclasses import dataclass
from fractions import Fraction
from itertools import pairwise
from math import comb, inf

from flint import fmpq, fmpq_poly, fmpz_poly

from zwidth.passivity.linear.exact_algebra import roots_inside
from zwidth.passivity.linear.positivity import Positivity, prove_nonnegative, where_negative
from zwidth.passivity.ports.circle import ONE, all_outside, decays
from zwidth.passivity.ports.port import Port, leverrier
from zwidth.quantity.balls import as_fmpq, as_fraction
from zwidth.quantity.text import from_to, shown

OFFSET = Fraction(1)
"""The g > 0 of every proof."""


@dataclass(frozen=True)
class Minor:
    """e_k = |d|^{2·power} q with q ≥ 0 on [−1, 1]."""

    power: int
    positivity: Positivity


@dataclass(frozen=True)
class Resolvent:
    """The stable matrix R/π = D (N + (g − σ) D)⁻¹ in ascending powers."""

    denominator: tuple[Fraction, ...]
    numerators: tuple[tuple[tuple[Fraction, ...], ...], ...]


@dataclass(frozen=True)
class Proof:
    """The signs of e_1 … e_m; of several axes with R/π, which of one is D and N + (g − σ) D themselves."""

    minors: tuple[Minor, ...]
    resolvent: Resolvent | None


def prove_level(port: Port, level: Fraction) -> Proof | None:
    """The proof that the port is positive real at the level; None if it is not."""
    minors = prove_minors(port, level)
    if isinstance(minors, Fraction):
        return None
    if port.axes == 1:
        return Proof(minors, None) if is_stable(port, level) else None
    resolvent = _stable_resolvent(port, level)
    return None if resolvent is None else Proof(minors, resolvent)


def is_stable(port: Port, level: Fraction) -> bool:
    """True when D (N + (g − σ) D)⁻¹ is stable."""
    if port.axes > 1:
        return _stable_resolvent(port, level) is not None
    ((n,),), ((d,),) = port.on_circle
    gain = OFFSET - level
    return all_outside([x * gain.denominator + y * gain.numerator for x, y in zip(n, d, strict=True)])


def prove_minors(port: Port, level: Fraction) -> tuple[Minor, ...] | Fraction:
    """The proof that Π_σ ⪰ 0 on the whole circle, or a rational c of (−1, 1) where it is not."""
    proved = []
    for k, minor in enumerate(minors_at(port, as_fmpq(level))):
        q, power = _without_weight(minor, port, k)
        sign = prove_nonnegative(q)
        if isinstance(sign, Fraction):
            return where_negative(minor.numer(), sign)  # beside a zero of |d|², where Π_σ vanishes
        proved.append(Minor(power, sign))
    return tuple(proved)


def minors_at(port: Port, level: fmpq | int) -> list[fmpq_poly]:
    """e_1 … e_m of Π_σ, in c."""
    if port.axes == 1:
        power, size = port.real_part
        return [power - size * level]
    if not port.is_direct:
        return [minor.real for minor in leverrier(port.form(level), ONE).minors]
    axes, shift = port.axes, port.weight * -level  # Π_σ = Π_0 − σ|d|²
    fixed = [fmpq_poly([1]), *port.minors_at_zero]
    powers = [fmpq_poly([1])]
    for _ in range(axes):
        powers.append(powers[-1] * shift)
    return [
        sum((comb(axes - j, k - j) * fixed[j] * powers[k - j] for j in range(k + 1)), fmpq_poly([]))
        for k in range(1, axes + 1)
    ]


def _without_weight(minor: fmpq_poly, port: Port, most: int) -> tuple[fmpz_poly, int]:
    """(q, power) with minor = |d|^{2·power} q up to a positive factor, power ≤ most."""
    power = 0
    while minor.degree() >= 0 and power < most and minor % port.weight == 0:
        minor, power = minor // port.weight, power + 1
    return minor.numer(), power


def _stable_resolvent(port: Port, level: Fraction) -> Resolvent | None:
    """R/π if it is proper and every root of π decays."""
    found = port.resolvent(as_fmpq(OFFSET - level))
    if found is None:
        return None
    denominator, numerators = found
    proper = all(entry.degree() <= denominator.degree() for row in numerators for entry in row)
    if not proper or not decays([int(c) for c in denominator.numer().coeffs()], port.time):
        return None
    return Resolvent(_fractions(denominator), tuple(tuple(map(_fractions, row)) for row in numerators))


def _fractions(p: fmpq_poly) -> tuple[Fraction, ...]:
    return tuple(as_fraction(c) for c in p.coeffs())


# An eigenvalue of Π_σ changes its sign only at a root of the last sum of principal minors that does not
# vanish everywhere: the product of the eigenvalues that are not zero throughout.  Between two roots
# one point decides, exactly (the eigenvalues on the axis of the Hamiltonian matrix are the same roots:
# Boyd, Balakrishnan & Kabamba, Mathematics of Control, Signals and Systems 2, 1989).


_BITS = 320
_MOST_TOLD = 4


@dataclass(frozen=True)
class Band:
    """Frequencies low < f < high [Hz], all below the level but for single ones; `high` is inf without end.

    Attributes
    ----------
    low, high
        The edges [Hz], roots of a polynomial, each as the double that is nearest to what was found.
    cosines
        The same edges as c = cos θ on the circle, to 320 bits, the larger first.
    """

    low: float
    high: float
    cosines: tuple[Fraction, Fraction]

    @property
    def middle(self) -> Fraction:
        """A c inside."""
        first, last = self.cosines
        return (first + last) / 2

    def __contains__(self, frequency: float) -> bool:
        return self.low < frequency < self.high

    def __str__(self) -> str:
        if self.high == inf:
            return "all frequencies" if self.low == 0 else f"from {shown(self.low, 'Hz', 6)} on"
        return from_to(self.low, self.high, "Hz", 6)


def bands(port: Port, level: Fraction) -> tuple[Band, ...]:
    """Where the least eigenvalue of the Hermitian part is below the level, in ascending frequency."""
    edges: list[tuple[Fraction, Fraction]] = []
    for first, last in _broken(port, level):
        if edges and edges[-1][1] == first:
            edges[-1] = (edges[-1][0], last)
        else:
            edges.append((first, last))
    return tuple(Band(port.frequency(c), port.frequency(d), (c, d)) for c, d in edges)


def in_words(found: Sequence[Band]) -> str:
    """Bands on a line, the first few."""
    told = ", ".join(str(band) for band in found[:_MOST_TOLD])
    return told + (f" and {len(found) - _MOST_TOLD} more" if len(found) > _MOST_TOLD else "")


def _broken(port: Port, level: Fraction) -> Iterator[tuple[Fraction, Fraction]]:
    """Intervals of c between neighbouring roots, downwards, with a negative eigenvalue in their middle."""
    minors = [minor for minor in minors_at(port, as_fmpq(level)) if minor.degree() >= 0]
    if not minors:
        return
    places = [Fraction(1), *sorted(roots_inside(minors[-1].numer(), _BITS), reverse=True), Fraction(-1)]
    for first, last in pairwise(places):
        middle = as_fmpq((first + last) / 2)
        if any(minor(middle) < 0 for minor in minors):
            yield first, last
