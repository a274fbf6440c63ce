"""Numbers of a document as a judge reads them: by the names of docs/json.md."""

from __future__ import annotations

from collections.abc import Sequence
from fractions import Fraction
from typing import Any

import flint
from attack.referee import Fed, PlainLoop
from flint import fmpq, fmpz_poly

ENDINGS = (
    "", "_N_s_per_m", "_N_m_s_per_rad", "_N_per_m", "_N_m_per_rad", "_N", "_N_m", "_m", "_rad", "_s", "_kg",
    "_kg_m2", "_m_N", "_rad_N_m", "_m_per_s", "_rad_per_s", "_Hz", "_per_m", "_per_rad", "_m_per_s_N",
    "_rad_per_s_N_m", "_N_N_s_per_m", "_N_m_N_m_s_per_rad",
)  # fmt: skip


def exact(value: Any) -> Fraction:
    """A number, or its text."""
    return Fraction(value) if isinstance(value, (int, Fraction)) else Fraction(str(value))


def exacts(values: Sequence[Any]) -> list[Fraction]:
    """A list of them."""
    return [exact(v) for v in values]


def entry(table: Any, name: str, default: Any = None) -> Any:
    """What stands under a name with any unit."""
    return next((table[name + e] for e in ENDINGS if name + e in table), default)


def quantity(table: Any, name: str) -> Fraction:
    """A number by its name."""
    return exact(entry(table, name))


def law_of(loop: Any) -> tuple[list[Fraction], list[Fraction]]:
    """N and D in ascending powers of 1/z, of one length, D beginning with 1."""
    above, below = exacts(loop["numerator"]), exacts(loop["denominator"])
    above = [Fraction(0)] * (len(below) - len(above)) + above
    return [c / below[0] for c in above], [c / below[0] for c in below]


def plain_loop(loop: Any, fed: Fed = "both", *, clamped: bool = False, **changes: Any) -> PlainLoop:
    """The loop of a document, its law fed so."""
    above, below = law_of(loop)
    numbers = {
        "damping": quantity(loop, "damping"),
        "friction": quantity(loop, "coulomb_friction"),
        "period": quantity(loop, "sample_period"),
        "resolution": quantity(loop, "resolution"),
        "delay": quantity(loop, "delay"),
    }
    return PlainLoop(tuple(above), tuple(below), fed, clamped, **{**numbers, **changes})


def in_lowest_terms(above: list[Fraction], below: list[Fraction]) -> tuple[list[Fraction], list[Fraction]]:
    """Without a common factor; ascending in 1/z, D beginning with 1."""
    n, d = (flint.fmpq_poly([fmpq(c.numerator, c.denominator) for c in side]) for side in (above, below))
    common = n.gcd(d)
    parts = [[Fraction(int(c.p), int(c.q)) for c in (side // common).coeffs()] for side in (n, d)]
    first = parts[1][0]
    return tuple([c / first for c in part] for part in parts)  # type: ignore[return-value]


def roots_of(ascending: Sequence[Fraction]) -> list[tuple[flint.acb, int]]:
    """Roots, enclosed, with how often each occurs."""
    scale = 1
    for c in ascending:
        scale = scale * c.denominator // _gcd(scale, c.denominator)
    whole = fmpz_poly([int(c * scale) for c in ascending])
    return [(root, times) for root, times in whole.complex_roots()] if whole.degree() > 0 else []


def _gcd(a: int, b: int) -> int:
    while b:
        a, b = b, a % b
    return a


def poles_of(below: Sequence[Fraction]) -> list[tuple[flint.acb, int]]:
    """Poles in z of 1/D, D ascending in 1/z; those at 0 are left out."""
    return roots_of(list(below)[::-1])
