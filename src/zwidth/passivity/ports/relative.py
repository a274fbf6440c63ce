"""The relative index of a port: how much of a wave comes back, at most.

    R = least with ∫ |y − z u|² ≤ R² ∫ |y + z u|²,   R = ‖S‖∞,   S = (G − z)(G + z)⁻¹

from rest.  S is the scattering matrix at the reference z, in the unit of y/u; the port is passive if and
only if R ≤ 1, whatever z (Anderson & Vongpanitlerd, Network Analysis and Synthesis, 1973, sec. 2.6-2.7).
For R itself the reference counts: it says against what "all comes back" is measured.

R holds if and only if the port of u' = R a − b, y' = R a + b, a = y + z u, b = y − z u is positive real at
level 0; so one decision and one kind of proof serve here too.  The largest is found from band to band
(Bruinsma & Steinbuch, Systems & Control Letters 14, 1990).
"""

from __future__ import annotations

from collections.abc import Iterable
from dataclasses import dataclass
from fractions import Fraction
from math import inf, nextafter, sqrt
from typing import Any

import numpy as np
from flint import fmpq_poly

from zwidth.errors import InputError
from zwidth.passivity.certificate import FORMAT, Certificate
from zwidth.passivity.ports.bands import Band, bands
from zwidth.passivity.ports.documents import proof_document, system_document
from zwidth.passivity.ports.leverrier import leverrier, multiplied
from zwidth.passivity.ports.port import Polynomials, Port, in_lowest_terms
from zwidth.passivity.ports.positive_real import OFFSET, is_stable, prove_level
from zwidth.passivity.ports.reading import from_polynomials
from zwidth.quantity.exact import Exact, RealLike
from zwidth.showing import Part, Shown

_CLOSE = Fraction(1, 10**12)
"""Relative distance of the two ends between which R is told."""

_SIMPLE = 10**5
"""Denominators of levels that are tried for R itself, such as 1."""

_MOST_ROUNDS = 60

_SMALLEST = Fraction(1, 10**9)
"""Below it R is not told apart from 0."""


@dataclass(frozen=True, repr=False)
class RelativeIndex(Shown):
    """How much of a wave comes back from a port, at most, with where.

    Attributes
    ----------
    port
        G.
    reference
        z, in the unit of output over input.
    bounds
        Rationals between which R lies, both decided exactly; None where it is without bound: some wave from
        rest comes back without end.
    cosine
        c = cos θ of the frequency at which R is reached, to some digits; None where it is without bound.
    """

    port: Port
    reference: Fraction
    bounds: tuple[Fraction, Fraction] | None
    cosine: Fraction | None

    @property
    def value(self) -> float:
        """The least double that is proved; inf where none is."""
        if self.bounds is None:
            return inf
        value = float(self.bounds[1])
        while Fraction(repr(value)) < self.bounds[1]:
            value = nextafter(value, inf)
        return value

    @property
    def frequency(self) -> float | None:
        """Where it is reached [Hz]; inf in the limit; None where R is without bound."""
        return None if self.cosine is None else self.port.frequency(self.cosine)

    def at_most(self, level: RealLike) -> bool:
        """Whether R is at most this level, decided exactly."""
        return _holds(self.port, self.reference, _positive(level))

    def bands(self, level: RealLike = 1) -> tuple[Band, ...]:
        """Where more than this level comes back: the bands of violation at level 1."""
        return bands(_turned(self.port, self.reference, _positive(level)), Fraction(0))

    def certificate(self, level: RealLike | None = None) -> Certificate:
        """The proof that R is at most the level, by default `value`: of the port (u', y') that it makes.

        Raises
        ------
        InputError
            If it is more, or has no finite value.
        """
        if level is None and self.bounds is None:
            raise InputError("the relative index is without bound; there is nothing to certify")
        at = Fraction(repr(self.value)) if level is None else _positive(level)
        turned = direct(_turned(self.port, self.reference, at))
        proof = None if turned is None else prove_level(turned, Fraction(0))
        if turned is None or proof is None:
            raise InputError(
                f"the relative index is {self.value:.17g}, so {float(at):.17g} cannot be certified; "
                "give a higher level"
            )
        evidence = proof_document(proof)
        claim = {"index": "input", "level": "0", "system": system_document(turned)}
        return Certificate(({"format": FORMAT, "kind": evidence["kind"], **claim, **evidence},))

    def describe(self) -> str:
        """The index in a line."""
        if self.bounds is None:
            return "R = ∞: there is an unstable pole, or a wave comes back without end"
        f = self.frequency
        place = "as the frequency grows" if f == inf else f"at {f:.6g} Hz"
        return f"R = {self.value:.9g} {place}"

    def __repr__(self) -> str:
        return f"<RelativeIndex {self.describe()}>"

    def report(self) -> Iterable[Part]:
        """What it is."""
        yield f"relative index {self.describe()}"


def relative_index(port: Port, reference: RealLike = 1) -> RelativeIndex:
    """R of a port at a reference, between two rationals a part in 10¹² from each other.

    Raises
    ------
    InputError
        If the reference is not positive.
    """
    z = Exact(reference).fraction
    if z <= 0:
        raise InputError(
            f"the reference of a wave must be > 0, got {float(z):g}: a + b and a − b are scaled by it"
        )
    if not is_stable(port, OFFSET - z):
        return RelativeIndex(port, z, None, None)
    cosine = max((Fraction(1), Fraction(0), Fraction(-1)), key=lambda c: _reflected(port, z, c))
    low = _lower(_reflected(port, z, cosine))
    for _ in range(_MOST_ROUNDS):
        high = low * (1 + _CLOSE)
        above = bands(_turned(port, z, high), Fraction(0))
        if not above:
            break
        cosine = max((band.middle for band in above), key=lambda c: _reflected(port, z, c))
        low = max(high, _lower(_reflected(port, z, cosine)))
    while not _holds(port, z, high):
        high *= 1 + _CLOSE
    while low > _SMALLEST and _holds(port, z, low):  # a rounding above what is reached
        low *= 1 - _CLOSE
    simple = high.limit_denominator(_SIMPLE)
    if low <= simple < high and _holds(port, z, simple):
        high = simple
    return RelativeIndex(port, z, (Fraction(0) if low <= _SMALLEST else low, high), cosine)


def _positive(level: RealLike) -> Fraction:
    value = Exact(level).fraction
    if value <= 0:
        raise InputError(
            f"a level of the relative index must be > 0, got {float(value):g}: it is a ratio of sizes"
        )
    return value


def _lower(value: float) -> Fraction:
    """In few digits, and not 0."""
    return max(Fraction(f"{value:.15g}"), _SMALLEST)


def _holds(port: Port, z: Fraction, level: Fraction) -> bool:
    """‖S‖∞ ≤ level, and S is stable."""
    return prove_level(_turned(port, z, level), Fraction(0)) is not None


def _turned(port: Port, z: Fraction, level: Fraction) -> Port:
    """The port of u' = R a − b and y' = R a + b, in whole numbers."""
    top, bottom = level.numerator, level.denominator
    more, less = top + bottom, top - bottom

    def mixed(of_n: int, of_d: int) -> Polynomials:
        return tuple(
            tuple(_sum(n, of_n * z.denominator, d, of_d * z.numerator) for n, d in zip(*rows, strict=True))
            for rows in zip(port.outputs, port.inputs, strict=True)
        )

    outputs, inputs = mixed(more, less), mixed(less, more)
    denominator = inputs[0][0] if port.axes == 1 else port.denominator
    return Port(outputs, inputs, denominator, port.time, port.period, port.hidden_modes_decay)


def _sum(n: tuple[int, ...], of_n: int, d: tuple[int, ...], of_d: int) -> tuple[int, ...]:
    size = max(len(n), len(d))
    first, second = ((*p, *(0,) * (size - len(p))) for p in (n, d))
    total = [x * of_n + y * of_d for x, y in zip(first, second, strict=True)]
    while len(total) > 1 and not total[-1]:
        total.pop()
    return tuple(total)


def direct(port: Port) -> Port | None:
    """The same port as N/d, as a document has it; None where u' has no inverse."""
    if port.axes == 1:
        return port if any(port.inputs[0][0]) else None
    n, d = ([[fmpq_poly(list(p)) for p in row] for row in side] for side in (port.outputs, port.inputs))
    found = leverrier(d, fmpq_poly([1]))
    fraction = in_lowest_terms(multiplied(n, found.adjugate), found.minors[-1])
    if fraction is None:
        return None
    return from_polynomials(fraction[1], fraction[0], port.time, port.period, port.hidden_modes_decay)


def _reflected(port: Port, z: Fraction, cosine: Fraction) -> float:
    """The largest singular value of S at c, to rounding."""
    zeta = complex(float(cosine), -sqrt(max(float(1 - cosine**2), 0.0)))
    n, d = port.on_circle
    bits = max(c.bit_length() for side in (n, d) for row in side for p in row for c in p)

    def at(side: Any) -> Any:
        shift = max(bits - 900, 0)
        return np.array(
            [[np.polyval([float(c >> shift) for c in p[::-1]], zeta) for p in row] for row in side]
        )

    outputs, inputs = at(n), at(d) * float(z)
    try:
        waves = np.linalg.solve((outputs + inputs).T, (outputs - inputs).T)
    except np.linalg.LinAlgError:
        return inf
    return float(np.linalg.norm(waves, 2))
