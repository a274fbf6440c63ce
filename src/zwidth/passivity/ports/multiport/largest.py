"""The largest level at which a port of several axes is positive real.

The roots in σ of Z(σ, c) = e_r(Π_σ), r the rank of D, are the eigenvalues of the Hermitian part
of N D⁻¹ at cos θ = c.  The least of them over c is found from interval to interval: at a level
reached somewhere, the c at which an eigenvalue crosses the level part the circle, and the middle
of some part lies below (Boyd & Balakrishnan 1990, for the largest gain).  That what is found is
the least is proved afterwards.
"""

from __future__ import annotations

from dataclasses import dataclass
from fractions import Fraction

from flint import fmpq, fmpq_poly, fmpz_poly

from zwidth.passivity.linear.roots import real_roots
from zwidth.passivity.ports.multiport.port import MatrixPort
from zwidth.passivity.ports.multiport.positive_real import (
    minors_at,
    prove_minors,
    stable_resolvent,
)
from zwidth.passivity.ports.positive_real import (
    OFFSET,
    Largest,
    NoLevel,
    growing_place,
    places_of,
    proved_below,
    vanishes,
    without_bound,
)
from zwidth.quantity.balls import as_fmpq

_BITS = 320
_TIGHT = Fraction(1, 1 << 80)
_MOST_ROUNDS = 60


@dataclass(frozen=True)
class Spectrum:
    """Z(σ, c) = constant(σ) Σ σʲ varying[j](c), without factors of c alone; the last varying[j] > 0.

    Roots of `constant`, each taken once, are eigenvalues at every frequency.
    """

    constant: fmpq_poly
    varying: tuple[fmpq_poly, ...]

    def at_level(self, level: Fraction) -> fmpq_poly:
        """The varying factor in c."""
        total, sigma = fmpq_poly([]), as_fmpq(level)
        for coefficient in reversed(self.varying):
            total = total * sigma + coefficient
        return total

    def least_at(self, c: Fraction) -> Fraction | None:
        """The least eigenvalue of the varying factor, to 320 bits; None where it has none."""
        at = as_fmpq(c)
        roots = real_roots(fmpq_poly([p(at) for p in self.varying]).numer(), _BITS)
        return min(roots, default=None)

    def is_below(self, c: Fraction, level: Fraction) -> bool:
        """Whether an eigenvalue of the varying factor lies below the level at c: exactly."""
        at, shifted = as_fmpq(c), fmpq_poly([])
        for coefficient in reversed(self.varying):
            shifted = shifted * fmpq_poly([as_fmpq(level), -1]) + coefficient(at)
        signs = {shifted[k] > 0 for k in range(len(self.varying)) if shifted[k] != 0}
        return len(signs) > 1


def largest_matrix_level(port: MatrixPort, root: str = "pole") -> Largest | NoLevel:
    """The largest σ; `root` is what a pole is called in a reason, of the inverse a zero."""
    spectrum = _spectrum(port)
    if spectrum is None:
        return NoLevel("an input without effect is paired with an output that other inputs move")
    if vanishes(spectrum.varying[-1]):
        return NoLevel(without_bound(port.time, root, spectrum.varying[-1](-1) == 0))
    fixed = min(real_roots(spectrum.constant.numer(), _BITS), default=None)
    least, cosine = _minimum(spectrum)
    if least is None or (fixed is not None and fixed <= least + _near(least)):
        assert fixed is not None, "a spectrum has a factor of one kind or the other"
        least, cosine = fixed, None
    low = proved_below(least, lambda level: not isinstance(prove_minors(port, level), Fraction))
    if stable_resolvent(port, OFFSET - low) is None:
        return NoLevel(_not_stable(port, root))
    return Largest(low, _reached(spectrum, low, least, cosine), cosine)


def _spectrum(port: MatrixPort) -> Spectrum | None:
    """Z, from its values at σ = 0 … m; None where e_k is not 0 for some k > r."""
    size = port.axes
    rank = port.rank
    samples = [minors_at(port, level) for level in range(size + 1)]
    if any(minor.degree() >= 0 for minors in samples for minor in minors[rank:]):
        return None
    return _split(_interpolated([minors[rank - 1] for minors in samples[: rank + 1]]))


def _interpolated(values: list[fmpq_poly]) -> list[fmpq_poly]:
    """The coefficients of σʲ from the values at σ = 0, 1, 2 …, by divided differences."""
    newton, row = [values[0]], values
    for step in range(1, len(values)):
        row = [(b - a) * fmpq(1, step) for a, b in zip(row, row[1:], strict=False)]
        newton.append(row[0])
    total: list[fmpq_poly] = []
    for node in range(len(newton) - 1, -1, -1):  # total·(σ − node) + newton[node]
        raised = [fmpq_poly([]), *total]
        total = [a - b * node for a, b in zip(raised, [*total, fmpq_poly([])], strict=True)]
        total[0] += newton[node]
    return total


def _split(coefficients: list[fmpq_poly]) -> Spectrum:
    """Without the factors that depend on c alone, and with those of σ alone apart."""
    common = coefficients[0].numer()
    for p in coefficients[1:]:
        common = common.gcd(p.numer())
    varying = [p // fmpq_poly(common) for p in coefficients]
    columns = _transposed(varying)
    shared = columns[0].numer()
    for p in columns[1:]:
        shared = shared.gcd(p.numer())
    constant = fmpq_poly(shared)
    rest = _transposed([p // constant for p in columns])
    while len(rest) > 1 and rest[-1].degree() < 0:
        rest.pop()
    top = rest[-1]
    if next(v for v in (top(fmpq(k, 997)) for k in range(top.degree() + 2)) if v != 0) < 0:
        rest = [-p for p in rest]
    return Spectrum(_simple(constant), tuple(rest))


def _simple(p: fmpq_poly) -> fmpq_poly:
    """The same roots, each once."""
    return p // fmpq_poly(p.numer().gcd(p.derivative().numer())) if p.degree() > 0 else p


def _transposed(rows: list[fmpq_poly]) -> list[fmpq_poly]:
    """Polynomials of c for every power of σ, as polynomials of σ for every power of c, and back."""
    size = max(p.degree() for p in rows) + 1
    return [fmpq_poly([p[i] for p in rows]) for i in range(size)]


def _minimum(spectrum: Spectrum) -> tuple[Fraction | None, Fraction | None]:
    """The least eigenvalue of the varying factor over [−1, 1], and where."""
    if len(spectrum.varying) == 1:
        return None, None
    least, cosine = _best(spectrum, [Fraction(1), Fraction(0), Fraction(-1)])
    for _ in range(_MOST_ROUNDS):
        level = spectrum.at_level(least).numer()
        crossings = real_roots(level, _BITS) if level.degree() > 0 else []
        edges = [Fraction(-1), *sorted(c for c in crossings if -1 < c < 1), Fraction(1)]
        value, at = _best(spectrum, [(a + b) / 2 for a, b in zip(edges, edges[1:], strict=False)])
        if value >= least - _near(least):
            break
        least, cosine = value, at
    return least, cosine


def _best(spectrum: Spectrum, places: list[Fraction]) -> tuple[Fraction, Fraction]:
    """The least eigenvalue at these c, and of equals the largest c."""
    found = [(value, c) for c in places if (value := spectrum.least_at(c)) is not None]
    least = min(value for value, _ in found)
    return least, max(c for value, c in found if value <= least + _near(least))


def _near(value: Fraction) -> Fraction:
    return _TIGHT * max(abs(value), Fraction(1, 10**30))


def _reached(spectrum: Spectrum, low: Fraction, least: Fraction, cosine: Fraction | None) -> Fraction:
    """`low` where an eigenvalue equals it somewhere; otherwise a level that one is proved to lie below."""
    if spectrum.constant(as_fmpq(low)) == 0 or vanishes(spectrum.at_level(low)):
        return low
    step = _near(least) / (1 << 100)
    while not _is_reached(spectrum, least + step, cosine):
        step *= 1024
    return least + step


def _is_reached(spectrum: Spectrum, level: Fraction, cosine: Fraction | None) -> bool:
    if cosine is not None:
        return spectrum.is_below(cosine, level)
    low = level - 2 * _near(level)
    return bool(spectrum.constant(as_fmpq(low)) * spectrum.constant(as_fmpq(level)) <= 0)


def _not_stable(port: MatrixPort, root: str) -> str:
    """Which pole it is that the port may not have."""
    poles = port.poles()
    growing = None if poles is None else growing_place(places_of(_integers(poles.numer())), port.time)
    if growing is not None:
        return f"there is an unstable {root} at {growing}"
    if port.time == "discrete" and root == "zero":
        return "some output does not answer within the same sample, or a zero on the unit circle is multiple"
    where = "the imaginary axis or at infinity" if port.time == "continuous" else "the unit circle"
    return f"a {root} on {where} is multiple, or its residue is not positive semidefinite"


def _integers(p: fmpz_poly) -> list[int]:
    return [int(c) for c in p.coeffs()]
