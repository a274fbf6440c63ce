"""The linear criterion, decided exactly for one loop and over an interval of delays; where it is tightest.

Passive exactly if q(c) ≥ 0 on [−1, 1] (see `loop`) and H is stable, in one of two exact senses:

open loop
    every pole of H is inside the unit circle and H(1) ≥ 0.  A motion that ends
    away from its start then leaves ½ H(1) x² behind (Parseval for the rest).
closed loop, for α = 0
    b + T z⁻ᵈ H/(z − 1) is positive real.  With n/d that function in lowest
    terms this holds exactly if n + g d is Schur for one g > 0 and
    Re(n d̄) ≥ 0 on the circle, since (n − g d)/(n + g d) is then bounded by 1
    outside it.  This also decides poles on the unit circle.

For 0 < α < 1 a pole on the unit circle makes q negative beside it. Necessity: Colgate & Schenkel 1997;
sufficiency with stability: Fardad & Bamieh 2009; the fractional delay is derived in the documentation.
"""

from __future__ import annotations

from dataclasses import dataclass, replace
from fractions import Fraction
from functools import lru_cache
from itertools import accumulate
from math import acos, floor, inf, pi
from typing import TYPE_CHECKING, Literal, NamedTuple

from flint import fmpq_poly

from zwidth.errors import InputError
from zwidth.passivity.linear.exact_algebra import is_schur, roots_inside
from zwidth.passivity.linear.loop import LinearLoop
from zwidth.passivity.linear.positivity import Positivity, TooClose, prove_nonnegative
from zwidth.quantity.text import shown

if TYPE_CHECKING:
    import numpy as np
    from numpy.typing import ArrayLike, NDArray

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
    denominator = [x - y for x, y in zip([*loop.denominator, 0], [0, *loop.denominator], strict=True)]
    if sum(loop.numerator) == 0:  # (1 − ζ) divides N: cancel it
        numerator = list(accumulate(numerator[:-1]))
        denominator = list(loop.denominator)
    size = max(len(numerator), len(denominator))
    numerator += [0] * (size - len(numerator))
    denominator += [0] * (size - len(denominator))
    scale = total.denominator * loop.period.denominator
    return [int((total * y + loop.period * x) * scale) for x, y in zip(numerator, denominator, strict=True)]


# At a given damping the tightest frequency is a root of a polynomial; raising b
# to what that frequency needs and looking again converges in a few steps (Newton
# for a fractional programme, Dinkelbach 1967).  This finds the place; what is
# claimed there is decided exactly elsewhere.


_FLAT = 1e-12  # relative difference below which two frequencies are equally tight


@lru_cache(maxsize=16)
def tightest(loop: LinearLoop) -> tuple[float, Fraction]:
    """(required damping [N·s/m], cos ωT) where the criterion is tightest.

    Of equally tight frequencies the highest is given: there the motion that
    shows a violation is the shortest.
    """
    best, cosine = _best(loop, [Fraction(-1), Fraction(0), Fraction(1), *_poles_on_circle(loop)])
    for _ in range(12):
        candidates = _stationary(loop.with_damping(_rational(max(best, 0.0))))
        value, at = _best(loop, [*candidates, cosine])
        if value <= best * (1 + 1e-15) or value == inf:
            best, cosine = (value, at) if value > best else (best, cosine)
            break
        best, cosine = value, at
    return best, cosine


def frequency(cosine: Fraction, period: Fraction) -> float:
    """ω/2π [Hz] of cos ωT."""
    turns = acos(max(-1.0, min(1.0, float(cosine)))) / (2 * pi)
    return turns / float(period)


def _best(loop: LinearLoop, cosines: list[Fraction]) -> tuple[float, Fraction]:
    needs = [(loop.required_damping_at(c), c) for c in cosines]
    top = max(need for need, _ in needs)
    least = top if top == inf else top - abs(top) * _FLAT
    return top, min(c for need, c in needs if need >= least)


def _poles_on_circle(loop: LinearLoop) -> list[Fraction]:
    """Where |D|² vanishes, and the need may be without bound."""
    if is_schur(loop.denominator[::-1]):
        return []
    return roots_inside(loop.dissipation.numer())


def _stationary(loop: LinearLoop) -> list[Fraction]:
    """Points of (−1, 1) where criterion/|D|² is stationary."""
    p, weight = fmpq_poly(loop.criterion), loop.dissipation
    slope = (p.derivative() * weight - p * weight.derivative()).numer()
    return roots_inside(slope)


def _rational(value: float) -> Fraction:
    return Fraction(value).limit_denominator(10**24) if value < inf else Fraction(0)


_POINTS = 2000


def sampled_frequencies(given: ArrayLike | None, period: float) -> NDArray[np.float64]:
    """Those that were given, or 2000 evenly between 0 and 1/(2T) [Hz]."""
    import numpy as np  # a criterion needs none of it

    nyquist = 0.5 / period
    if given is None:
        return np.asarray((np.arange(_POINTS) + 0.5) * (nyquist / _POINTS), dtype=np.float64)
    hertz = np.atleast_1d(np.asarray(given, dtype=np.float64))
    if hertz.ndim != 1 or not np.all((hertz > 0) & (hertz <= nyquist * (1 + 1e-12))):
        raise InputError(f"frequencies must lie above 0 and up to half the rate, {shown(nyquist, 'Hz', 6)}")
    return hertz


# A delay known only within an interval, with any stable law.  Inside one sample, delay = (d + α) T, the
# criterion times b is
#
#     p(c, α) = (2b²/T) |D|² + b [(1 − α) h_d(c) + α h_{d+1}(c)] − (T/2) α(1−α) |N|² .
#
# α(1−α) lies below its tangent at the middle of any piece of the interval, and
# with the tangent in its place p is affine in α, so that it is nonnegative on
# the piece if it is at both ends: two polynomials, each with its exact proof.


SMALLEST_PIECE = Fraction(1, 512)
"""Samples; a delay that is proved only in smaller pieces than this stays undecided."""

MOST_PIECES = 30_000
"""Pieces that are tried, times degree: some seconds' work; an interval that needs more stays undecided."""


class Piece(NamedTuple):
    """Delays from `low` to `high` [samples], and the proofs at both ends."""

    low: Fraction
    high: Fraction
    at_low: Positivity
    at_high: Positivity


def prove_delays(loop: LinearLoop, proof: LinearProof, longest: Fraction) -> tuple[Piece, ...] | None:
    """Pieces that cover the delays from the loop's own to `longest` [s]; None where that fails.

    `proof` is the loop's, with H stable in the open loop.
    """
    if proof.stability != "open loop" or loop.damping == 0:
        return None
    low, high = loop.whole_delay + loop.part_delay, longest / loop.period
    work = _at_whole_samples(low, high)[::-1]
    pieces: list[Piece] = []
    left = MOST_PIECES // (10 + loop.order + floor(high))
    while work:
        low, high = work.pop()
        left -= 1
        piece = _prove(loop, low, high)
        if piece is not None:
            pieces.append(piece)
        elif high - low <= SMALLEST_PIECE or left <= 0:
            return None
        else:
            middle = (low + high) / 2
            work += [(middle, high), (low, middle)]
    return tuple(pieces)


def _at_whole_samples(low: Fraction, high: Fraction) -> list[tuple[Fraction, Fraction]]:
    """The interval cut at whole samples."""
    cuts = [low, *(Fraction(k) for k in range(floor(low) + 1, floor(high) + 1) if k < high), high]
    return list(zip(cuts, cuts[1:], strict=False))


def _prove(loop: LinearLoop, low: Fraction, high: Fraction) -> Piece | None:
    whole = floor(low)
    middle = (low + high) / 2 - whole
    proofs = []
    for end in (low, high):
        part = end - whole
        tangent = middle * (1 - middle) + (1 - 2 * middle) * (part - middle)
        at_end = replace(loop, whole_delay=whole, part_delay=part)
        try:
            found = prove_nonnegative(at_end.bounded_criterion(tangent))
        except TooClose:
            return None
        if isinstance(found, Fraction):
            return None
        proofs.append(found)
    return Piece(low, high, *proofs)
