"""Bands of frequency in which a port gives out what a level forbids: the least eigenvalue is below it.

    Π_σ(c) = ½(Dᴴ N + Nᴴ D) − σ Dᴴ D,    of one axis Re G < σ

An eigenvalue of Π_σ changes its sign only at a root of the last sum of principal minors that does not
vanish everywhere: the product of the eigenvalues that are not zero throughout.  Between two roots
one point decides, exactly (the eigenvalues on the axis of the Hamiltonian matrix are the same roots:
Boyd, Balakrishnan & Kabamba, Mathematics of Control, Signals and Systems 2, 1989).
"""

from __future__ import annotations

from collections.abc import Iterator, Sequence
from dataclasses import dataclass
from fractions import Fraction
from itertools import pairwise
from math import inf

from zwidth.passivity.linear.exact_algebra import roots_inside
from zwidth.passivity.ports.port import Port
from zwidth.passivity.ports.positive_real import minors_at
from zwidth.quantity.balls import as_fmpq

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
            return "all frequencies" if self.low == 0 else f"from {self.low:.6g} Hz on"
        return f"{self.low:.6g} to {self.high:.6g} Hz"


def bands(port: Port, level: Fraction) -> tuple[Band, ...]:
    """Where the least eigenvalue of the Hermitian part is below the level, in ascending frequency."""
    edges: list[tuple[Fraction, Fraction]] = []
    for first, last in _below(port, level):
        if edges and edges[-1][1] == first:
            edges[-1] = (edges[-1][0], last)
        else:
            edges.append((first, last))
    return tuple(Band(port.frequency(c), port.frequency(d), (c, d)) for c, d in edges)


def in_words(found: Sequence[Band]) -> str:
    """Bands on a line, the first few."""
    told = ", ".join(str(band) for band in found[:_MOST_TOLD])
    return told + (f" and {len(found) - _MOST_TOLD} more" if len(found) > _MOST_TOLD else "")


def _below(port: Port, level: Fraction) -> Iterator[tuple[Fraction, Fraction]]:
    """Intervals of c between neighbouring roots, downwards, with a negative eigenvalue in their middle."""
    minors = [minor for minor in minors_at(port, as_fmpq(level)) if minor.degree() >= 0]
    if not minors:
        return
    places = [Fraction(1), *sorted(roots_inside(minors[-1].numer(), _BITS), reverse=True), Fraction(-1)]
    for first, last in pairwise(places):
        middle = as_fmpq((first + last) / 2)
        if any(minor(middle) < 0 for minor in minors):
            yield first, last
