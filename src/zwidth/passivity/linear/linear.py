"""The linear criterion, decided exactly for one loop.

Passive exactly if q(c) ≥ 0 on [−1, 1] (see `loop`) and H is stable, in one of
two exact senses:

open loop
    every pole of H is inside the unit circle and H(1) ≥ 0.  A motion that ends
    away from its start then leaves ½ H(1) x² behind (Parseval for the rest).
closed loop, for α = 0
    b + T z⁻ᵈ H/(z − 1) is positive real.  With n/d that function in lowest
    terms this holds exactly if n + g d is Schur for one g > 0 and
    Re(n d̄) ≥ 0 on the circle, since (n − g d)/(n + g d) is then bounded by 1
    outside it.  This also decides poles on the unit circle.

For 0 < α < 1 a pole on the unit circle makes q negative beside it.
Necessity: Colgate & Schenkel 1997; sufficiency with stability: Fardad &
Bamieh 2009; the fractional delay is derived in the documentation.
"""

from __future__ import annotations

from dataclasses import dataclass
from fractions import Fraction
from functools import lru_cache
from typing import Literal

from zwidth.passivity.linear.loop import LinearLoop
from zwidth.passivity.linear.positivity import Positivity, TooClose, prove_nonnegative
from zwidth.passivity.linear.schur import is_schur

Reason = Literal["criterion", "negative static stiffness", "unstable environment", "too close to zero"]


@dataclass(frozen=True)
class LinearProof:
    """Why a linear loop is passive: a stable H and a nonnegative criterion."""

    stability: Literal["open loop", "closed loop"]
    offset: Fraction | None
    positivity: Positivity


@dataclass(frozen=True)
class LinearRefutation:
    """Why a linear loop is not proved passive; `cosine` is where the criterion is negative.

    "too close to zero": its sign would take more work than is spent on it, and the loop may be passive.
    """

    reason: Reason
    cosine: Fraction | None


@lru_cache(maxsize=64)
def decide_linear(loop: LinearLoop) -> LinearProof | LinearRefutation:
    """Decide the linear criterion exactly, equality counted as passive."""
    positivity = _sign(loop)
    if isinstance(positivity, Fraction):
        fastest = Fraction(-1)  # to and fro from sample to sample: the shortest motion, where it will do
        return LinearRefutation("criterion", fastest if loop.criterion(-1) < 0 else positivity)
    stable, offset = is_schur(loop.denominator[::-1]), None
    if stable and sum(loop.numerator) < 0:
        return LinearRefutation("negative static stiffness", None)
    if not stable:
        offset = offset_of(loop)
        if loop.part_delay or not is_schur(closed_loop(loop, offset)[::-1]):
            return LinearRefutation("unstable environment", None)
    if positivity is None:
        return LinearRefutation("too close to zero", None)
    return LinearProof("open loop" if stable else "closed loop", offset, positivity)


def _sign(loop: LinearLoop) -> Positivity | Fraction | None:
    """Of the criterion; None where it comes too close to zero."""
    try:
        return prove_nonnegative(loop.criterion)
    except TooClose:
        return None


def offset_of(loop: LinearLoop) -> Fraction:
    """The number g > 0 that closed-loop proofs use; any would do."""
    return loop.damping or Fraction(1)


def closed_loop(loop: LinearLoop, offset: Fraction) -> list[int]:
    """n + g d of b + T ζ^{d+1} N/((1 − ζ) D) in lowest terms, ascending in ζ, as integers."""
    total = loop.damping + offset
    numerator = [0] * (loop.whole_delay + 1) + list(loop.numerator)
    denominator = _times_one_minus_zeta(loop.denominator)
    if sum(loop.numerator) == 0:  # (1 − ζ) divides N: cancel it
        numerator = _over_one_minus_zeta(numerator)
        denominator = list(loop.denominator)
    size = max(len(numerator), len(denominator))
    numerator += [0] * (size - len(numerator))
    denominator += [0] * (size - len(denominator))
    scale = total.denominator * loop.period.denominator
    return [int((total * y + loop.period * x) * scale) for x, y in zip(numerator, denominator, strict=True)]


def _times_one_minus_zeta(a: tuple[int, ...]) -> list[int]:
    return [x - y for x, y in zip([*a, 0], [0, *a], strict=True)]


def _over_one_minus_zeta(a: list[int]) -> list[int]:
    """a/(1 − ζ) for a(1) = 0: the running sums."""
    total, quotient = 0, []
    for coefficient in a[:-1]:
        total += coefficient
        quotient.append(total)
    return quotient
