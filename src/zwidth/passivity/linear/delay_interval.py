"""A delay known only within an interval, with any stable law.

Inside one sample, delay = (d + α) T, the criterion times b is

    p(c, α) = (2b²/T) |D|² + b [(1 − α) h_d(c) + α h_{d+1}(c)] − (T/2) α(1−α) |N|² .

α(1−α) lies below its tangent at the middle of any piece of the interval, and
with the tangent in its place p is affine in α, so that it is nonnegative on
the piece if it is at both ends: two polynomials, each with its exact proof.
"""

from __future__ import annotations

from dataclasses import replace
from fractions import Fraction
from math import floor
from typing import NamedTuple

from zwidth.passivity.linear.linear import LinearProof
from zwidth.passivity.linear.loop import LinearLoop
from zwidth.passivity.linear.positivity import Positivity, TooClose, prove_nonnegative

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
