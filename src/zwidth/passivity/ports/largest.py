"""The largest level at which a port is positive real, and which pole it is that lets none be.

What a port absorbs is largest where its least eigenvalue is least: of one axis that is the least
Re F (`RealPart`), of several the least root of a polynomial in σ and c (`Spectrum`).  That what is
found is the least is proved afterwards.
"""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass
from fractions import Fraction
from functools import cached_property
from itertools import pairwise

from flint import fmpq, fmpq_poly

from zwidth.passivity.linear.exact_algebra import interpolated, real_roots, roots_inside
from zwidth.passivity.ports.circle import Time, growing_place, has_positive_sign, near, places_of, vanishes
from zwidth.passivity.ports.port import Port, common_factor
from zwidth.passivity.ports.positive_real import is_stable, minors_at, prove_minors
from zwidth.quantity.balls import as_fmpq, as_fraction


@dataclass(frozen=True)
class Largest:
    """low ≤ σ* ≤ high: F − low is proved positive real, and Re F(c) reaches high at `cosine`.

    `cosine` is None where it is reached at every frequency.
    """

    low: Fraction
    high: Fraction
    cosine: Fraction | None


@dataclass(frozen=True)
class NoLevel:
    """No σ will do; `reason` says why."""

    reason: str


def largest_level(port: Port, root: str = "pole") -> Largest | NoLevel:
    """The largest σ; `root` is what a pole is called in a reason, of the inverse a zero."""
    values = real_part(port) if port.axes == 1 else spectrum(port)
    if values is None:
        return NoLevel("an input without effect is paired with an output that other inputs move")
    if vanishes(values.weight):
        return NoLevel(_without_bound(port.time, root, values.weight(-1) == 0))
    least, cosine = values.least
    low = _proved_below(least, lambda level: not isinstance(prove_minors(port, level), Fraction))
    if not is_stable(port, low):
        return NoLevel(_not_stable(port, root))
    return Largest(low, values.reached(low), cosine)


def _proved_below(least: Fraction, holds: Callable[[Fraction], bool]) -> Fraction:
    """A level at most `least` that holds: the same one, its simplest neighbour, or one a little less."""
    simple = least.limit_denominator(10**15)
    candidates = [least] if least.denominator < 10**60 else []
    if abs(simple - least) <= near(least):
        candidates.append(simple)
    for level in candidates:
        if holds(level):
            return level
    step = near(least)
    while not holds(least - step):
        step *= 1024
    return least - step


def _without_bound(time: Time, root: str, at_end: bool) -> str:
    """Why no level holds where the real part has a pole of its own."""
    if time == "discrete":
        return f"the real part is without bound at a {root} on the unit circle"
    where = "as the frequency grows" if at_end else f"at a {root} on the imaginary axis"
    return f"the real part is without bound {where}"


def _not_stable(port: Port, root: str) -> str:
    """Which pole it is that the port may not have."""
    continuous, alone = port.time == "continuous", port.axes == 1
    improper = alone and len(port.outputs[0][0]) > len(port.inputs[0][0])
    if improper and not continuous:
        return "the output does not answer the input within the same sample"
    poles = port.poles()
    growing = None if poles is None else growing_place(places_of(poles.numer()), port.time)
    if growing is not None:
        return f"there is an unstable {root} at {growing}"
    if improper:
        return "it grows with the frequency, with a negative sign"
    if not continuous and not alone and root == "zero":
        return "some output does not answer within the same sample, or a zero on the unit circle is multiple"
    where = "the imaginary axis" if continuous else "the unit circle"
    if alone:
        return f"a {root} on {where} is multiple, or has a negative residue"
    where += " or at infinity" if continuous else ""
    return f"a {root} on {where} is multiple, or its residue is not positive semidefinite"


# The least real part of a port of one axis, as the least value of a quotient in c.
#
#     Re F = Re(N D̄)/|D|² = p/w on [−1, 1]
#
# The quotient is least at an end or where p′ w − p w′ = 0: everything that `Spectrum` looks for step
# by step is in the roots of one polynomial.


_BITS = 320


@dataclass(frozen=True)
class RealPart:
    """power/weight in lowest terms, weight > 0 on [−1, 1] but for its zeros."""

    power: fmpq_poly
    weight: fmpq_poly

    @cached_property
    def least(self) -> tuple[Fraction, Fraction | None]:
        """The least value over [−1, 1], and where, of equals the largest c; None: everywhere."""
        p, w = self.power, self.weight
        slope = (p.derivative() * w - p * w.derivative()).numer()
        places = [Fraction(1), Fraction(-1), *roots_inside(slope, _BITS)]
        values = [(self._at(c), c) for c in places]
        least = min(value for value, _ in values)
        flat = p.degree() <= 0 and w.degree() <= 0
        return least, None if flat else max(c for value, c in values if value == least)

    def reached(self, low: Fraction) -> Fraction:
        """`low` where it is a value; otherwise the least, which is one at its c."""
        return low if vanishes(self.power - as_fmpq(low) * self.weight) else self.least[0]

    def _at(self, c: Fraction) -> Fraction:
        at = as_fmpq(c)
        return as_fraction(self.power(at) / self.weight(at))


def real_part(port: Port) -> RealPart:
    """Re F of one axis."""
    p, w = port.real_part
    common = common_factor((p, w))
    p, w = p // common, w // common
    return RealPart(p, w) if has_positive_sign(w) else RealPart(-p, -w)


# The least eigenvalue of a port of several axes over all frequencies.
#
# The roots in σ of Z(σ, c) = e_r(Π_σ), r the rank of D, are the eigenvalues of the Hermitian part
# of N D⁻¹ at cos θ = c.  The least of them over c is found from interval to interval: at a level
# reached somewhere, the c at which an eigenvalue crosses the level part the circle, and the middle
# of some part lies below (Boyd & Balakrishnan 1990, for the largest gain).


_MOST_ROUNDS = 60


@dataclass(frozen=True)
class Spectrum:
    """Z(σ, c) = constant(σ) Σ σʲ varying[j](c), without factors of c alone; the last varying[j] > 0.

    Roots of `constant`, each taken once, are eigenvalues at every frequency.
    """

    constant: fmpq_poly
    varying: tuple[fmpq_poly, ...]

    @property
    def weight(self) -> fmpq_poly:
        """What Z is of the highest power of σ, whose zeros are poles of an eigenvalue."""
        return self.varying[-1]

    @cached_property
    def least(self) -> tuple[Fraction, Fraction | None]:
        """The least eigenvalue over [−1, 1], and where; None: everywhere."""
        fixed = min(real_roots(self.constant.numer(), _BITS), default=None)
        if len(self.varying) > 1:
            least, cosine = self._least_varying()
            if fixed is None or fixed > least + near(least):
                return least, cosine
        assert fixed is not None, "a spectrum has a factor of one kind or the other"
        return fixed, None

    def reached(self, low: Fraction) -> Fraction:
        """`low` where an eigenvalue equals it somewhere; otherwise a level above one, by a proof."""
        if self.constant(as_fmpq(low)) == 0 or vanishes(self._at_level(low)):
            return low
        least, _ = self.least
        step = near(least) / (1 << 100)
        while not self._is_reached(least + step):
            step *= 1024
        return least + step

    def _is_reached(self, level: Fraction) -> bool:
        _, cosine = self.least
        if cosine is not None:
            return self._is_below(cosine, level)
        low = level - 2 * near(level)
        return bool(self.constant(as_fmpq(low)) * self.constant(as_fmpq(level)) <= 0)

    def _least_varying(self) -> tuple[Fraction, Fraction]:
        """The least eigenvalue of the varying factor over [−1, 1], and where."""
        least, cosine = self._best([Fraction(1), Fraction(0), Fraction(-1)])
        for _ in range(_MOST_ROUNDS):
            level = self._at_level(least).numer()
            crossings = real_roots(level, _BITS) if level.degree() > 0 else []
            edges = [Fraction(-1), *sorted(c for c in crossings if -1 < c < 1), Fraction(1)]
            value, at = self._best([(a + b) / 2 for a, b in pairwise(edges)])
            if value >= least - near(least):
                break
            least, cosine = value, at
        return least, cosine

    def _best(self, places: list[Fraction]) -> tuple[Fraction, Fraction]:
        """The least eigenvalue at these c, and of equals the largest c."""
        found = [(value, c) for c in places if (value := self._least_at(c)) is not None]
        least = min(value for value, _ in found)
        return least, max(c for value, c in found if value <= least + near(least))

    def _at_level(self, level: Fraction) -> fmpq_poly:
        """The varying factor in c."""
        total, sigma = fmpq_poly([]), as_fmpq(level)
        for coefficient in reversed(self.varying):
            total = total * sigma + coefficient
        return total

    def _least_at(self, c: Fraction) -> Fraction | None:
        """The least eigenvalue of the varying factor, to 320 bits; None where it has none."""
        at = as_fmpq(c)
        roots = real_roots(fmpq_poly([p(at) for p in self.varying]).numer(), _BITS)
        return min(roots, default=None)

    def _is_below(self, c: Fraction, level: Fraction) -> bool:
        """Whether an eigenvalue of the varying factor lies below the level at c: exactly."""
        at, shifted = as_fmpq(c), fmpq_poly([])
        for coefficient in reversed(self.varying):
            shifted = shifted * fmpq_poly([as_fmpq(level), -1]) + coefficient(at)
        signs = {shifted[k] > 0 for k in range(len(self.varying)) if shifted[k] != 0}
        return len(signs) > 1


def spectrum(port: Port) -> Spectrum | None:
    """Z, from its values at σ = 0 … m; None where e_k is not 0 for some k > r."""
    rank = port.rank
    samples = [minors_at(port, level) for level in range(port.axes + 1)]
    if any(minor.degree() >= 0 for minors in samples for minor in minors[rank:]):
        return None
    levels = [fmpq(level) for level in range(rank + 1)]
    return _split(interpolated([minors[rank - 1] for minors in samples[: rank + 1]], levels))


def _split(coefficients: list[fmpq_poly]) -> Spectrum:
    """Without the factors that depend on c alone, and with those of σ alone apart."""
    common = common_factor(coefficients)
    columns = _transposed([p // common for p in coefficients])
    constant = common_factor(columns)
    rest = _transposed([p // constant for p in columns])
    while len(rest) > 1 and rest[-1].degree() < 0:
        rest.pop()
    if not has_positive_sign(rest[-1]):
        rest = [-p for p in rest]
    if constant.degree() > 0:  # each root once
        constant = constant // common_factor((constant, constant.derivative()))
    return Spectrum(constant, tuple(rest))


def _transposed(rows: list[fmpq_poly]) -> list[fmpq_poly]:
    """Polynomials of c for every power of σ, as polynomials of σ for every power of c, and back."""
    size = max(p.degree() for p in rows) + 1
    return [fmpq_poly([p[i] for p in rows]) for i in range(size)]
