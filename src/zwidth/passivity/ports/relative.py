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

from collections.abc import Callable, Iterable
from dataclasses import dataclass
from fractions import Fraction
from functools import partial
from math import inf, isfinite, nextafter, sqrt
from typing import Any

import numpy as np

from zwidth.errors import InputError
from zwidth.passivity.certificate import FORMAT, Certificate
from zwidth.passivity.ports.bands import Band, bands
from zwidth.passivity.ports.documents import proof_document, system_document
from zwidth.passivity.ports.port import Port
from zwidth.passivity.ports.positive_real import OFFSET, is_stable, prove_level
from zwidth.passivity.ports.waves import direct_power_of, power_of, waves_of
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
        return _holds(waves_of(self.port, self.reference), _positive(level))

    def bands(self, level: RealLike = 1) -> tuple[Band, ...]:
        """Where more than this level comes back: the bands of violation at level 1."""
        return bands(power_of(waves_of(self.port, self.reference), _positive(level)), Fraction(0))

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
        _, port = direct_power_of(waves_of(self.port, self.reference), at)
        proof = prove_level(port, Fraction(0))
        if proof is None:
            raise InputError(
                f"the relative index is {self.value:.17g}, so {float(at):.17g} cannot be certified; "
                "give a higher level"
            )
        evidence = proof_document(proof)
        claim = {"index": "input", "level": "0", "system": system_document(port)}
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
    """R of a port at a reference, between two rationals a part in 10¹² from each other."""
    z = Exact(reference).fraction
    if z <= 0:
        raise InputError(
            f"the reference of a wave must be > 0, got {float(z):g}: a + b and a − b are scaled by it"
        )
    if not is_stable(port, OFFSET - z):
        return RelativeIndex(port, z, None, None)
    waves = waves_of(port, z)
    cosine = max((Fraction(1), Fraction(0), Fraction(-1)), key=partial(_reflected, waves))
    low = _lower(_reflected(waves, cosine))
    for _ in range(_MOST_ROUNDS):
        high = low * (1 + _CLOSE)
        above = bands(power_of(waves, high), Fraction(0))
        if not above:
            break
        cosine = max((band.middle for band in above), key=partial(_reflected, waves))
        low = max(high, _lower(_reflected(waves, cosine)))
    low, high = _narrowed(partial(_holds, waves), low, high)
    simple = high.limit_denominator(_SIMPLE)
    if low <= simple < high and _holds(waves, simple):
        high = simple
    return RelativeIndex(port, z, (Fraction(0) if low <= _SMALLEST else low, high), cosine)


def _narrowed(holds: Callable[[Fraction], bool], low: Fraction, high: Fraction) -> tuple[Fraction, Fraction]:
    """Both ends where rounding had put them on the wrong side: `high` holds, `low` does not, or is least."""
    step = _CLOSE
    while not holds(high):
        low, high, step = high, high * (1 + step), 4 * step
    step = _CLOSE
    while low > _SMALLEST and holds(low):
        low, high, step = max(low * (1 - min(step, Fraction(1, 2))), _SMALLEST), low, 4 * step
    while high - low > 2 * _CLOSE * high and high > _SMALLEST:
        middle = Fraction(f"{float((low + high) / 2):.15g}")
        low, high = (low, middle) if holds(middle) else (middle, high)
    return low, high


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


def _holds(waves: Port, level: Fraction) -> bool:
    """‖S‖∞ ≤ level, and S is stable."""
    return prove_level(power_of(waves, level), Fraction(0)) is not None


def _reflected(waves: Port, cosine: Fraction) -> float:
    """The largest singular value of S at c, to rounding; of an S that is stable.

    Beside it where the waves in are not independent, as at c = −1 of polynomials of unlike degrees.
    """
    for beside in (Fraction(0), Fraction(1, 2**20), Fraction(1, 2**12)):
        found = _size_at(waves, cosine * (1 - beside))
        if isfinite(found):
            return found
    return 0.0


def _size_at(waves: Port, cosine: Fraction) -> float:
    zeta = complex(float(cosine), -sqrt(max(float(1 - cosine**2), 0.0)))
    back, into = waves.on_circle
    bits = max(c.bit_length() for side in (back, into) for row in side for p in row for c in p)

    def at(side: Any) -> Any:
        shift = max(bits - 900, 0)
        return np.array(
            [[np.polyval([float(c >> shift) for c in p[::-1]], zeta) for p in row] for row in side]
        )

    try:
        scattering = np.linalg.solve(at(into).T, at(back).T)
    except np.linalg.LinAlgError:
        return inf
    return float(np.linalg.norm(scattering, 2))
