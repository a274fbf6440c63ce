"""The motion that refutes the linear criterion: a sinusoid of exactly p periods in q samples.

Where the criterion is negative over a band of frequencies, the fraction p/q
of simplest denominator in the band gives the shortest periodic motion.  Every
period takes out energy and returns the loop to its state; enough of them pay
for going in and out.
"""

from __future__ import annotations

from fractions import Fraction
from math import ceil, cos, log2, pi, sin

from flint import arb, ctx, fmpq, fmpz_poly

from zwidth.passivity.loop import LinearLoop
from zwidth.passivity.motion import Pattern, Repeat
from zwidth.passivity.supremum import tightest

LONGEST_PERIOD = 500_000
"""Samples in one period; a criterion violated in a narrower band stays undecided."""

LONGEST_LISTED = 5_000
"""Samples in one slow period beyond which a wave of constant speeds is used instead."""

_PIECES, _SPEED = 64, 1000

_RAMPS = (1, 10, 100, 1000, 10_000, 100_000)


def sinusoids(loop: LinearLoop, unilateral: bool) -> list[Pattern]:
    """Patterns at a frequency where the criterion is negative, the shortest first.

    A law with memory behind a unilateral surface is kept in contact: the
    pattern first goes in, the slower the later in the list.
    """
    band = _negative_band(loop)
    if band is None:
        return []
    turn = _simplest_between(*band)
    if band[0] <= turn and turn.numerator == 1 and turn.denominator > LONGEST_LISTED:
        return [_slow_wave(loop)]
    if turn.denominator > LONGEST_PERIOD:
        return []
    cycle = _cycle(loop, turn)
    settled = cycle * (1 + (_memory(loop) + 1) // len(cycle)) if _memory(loop) else ()
    if unilateral and len(loop.numerator) + len(loop.denominator) > 2:
        return [_inside(loop, cycle, settled, ramp) for ramp in _RAMPS]
    first = len(settled)
    w = (0, *settled, *cycle, *(0,) * (len(loop.denominator) - 1))
    return [Pattern(w, (Repeat(first, first + len(cycle), 1),))]


def _memory(loop: LinearLoop) -> int:
    """Samples after which a periodic w has a periodic force at the device."""
    return len(loop.numerator) + len(loop.denominator) - 2 + loop.whole_delay + (loop.part_delay > 0)


def _inside(loop: LinearLoop, cycle: tuple[int, ...], settled: tuple[int, ...], ramp: int) -> Pattern:
    """The cycle on top of a constant depth, with a slow way in and most of the way out."""
    at_one = sum(loop.denominator)
    span = max(cycle) * sum(abs(c) for c in loop.denominator)
    depth = 2 * (span // at_one + 1) if at_one else 0
    rise = tuple(depth * k // ramp for k in range(ramp + 1))
    hold = (depth,) * (_memory(loop) + 1)
    bottom = depth // 8 + 1
    fall = tuple(depth - (depth - bottom) * k // ramp for k in range(1, ramp + 1))
    lead = rise + hold + tuple(depth + w for w in settled)
    w = lead + tuple(depth + v for v in cycle) + hold + fall + (bottom,) * len(hold)
    first = len(lead) - 1
    return Pattern(w, (Repeat(first, first + len(cycle), 1),), True)


def _slow_wave(loop: LinearLoop) -> Pattern:
    """One very slow wave: pieces of constant speed, in with the first half and out with the second.

    Where only slow motions gain, the length of the pieces is what decides; each
    is one sample, done many times.
    """
    settle = _memory(loop) + 2
    w, repeats = [0], []
    for piece in range(_PIECES):
        speed = round(_SPEED * sin(2 * pi * (piece + 0.5) / _PIECES))
        for _ in range(settle + 1):
            w.append(w[-1] + speed)
        repeats.append(Repeat(len(w) - 2, len(w) - 1, 1))
    w += [0] * (settle + len(loop.denominator))
    return Pattern(tuple(w), tuple(repeats))


def _negative_band(loop: LinearLoop) -> tuple[Fraction, Fraction] | None:
    """Turns per sample ωT/2π, low to high, well inside a band where the criterion is negative."""
    criterion = loop.criterion
    _, cosine = tightest(loop)
    at = fmpq(cosine.numerator, cosine.denominator)
    if criterion(at) >= 0:
        return None
    low, high = Fraction(0), Fraction(1, 2)
    saved = ctx.prec
    try:
        ctx.prec = 256
        here = _turn(arb(at))
        for root, _ in criterion.complex_roots():
            if abs(float(root.imag)) <= 1e-40 and -1 <= float(root.real) <= 1:
                turn = _turn(root.real)
                low, high = (max(low, turn), high) if turn < here else (low, min(high, turn))
    finally:
        ctx.prec = saved
    margin = (high - low) / 4
    return low + margin, high if high == Fraction(1, 2) else high - margin


def _turn(cosine: arb) -> Fraction:
    bounded = max(min(cosine.mid(), arb(1)), arb(-1))
    value = (bounded.acos() / (2 * arb.pi())).mid().fmpq()
    return Fraction(int(value.p), int(value.q))


def _simplest_between(low: Fraction, high: Fraction) -> Fraction:
    """The fraction of smallest denominator in [low, high], 0 ≤ low < high."""
    whole = ceil(low)
    if whole <= high and whole > 0:
        return Fraction(whole)
    below = whole - 1 if whole > low else whole
    if low == below:  # only with low = 0
        return below + Fraction(1, ceil(1 / (high - below)))
    return below + 1 / _simplest_between(1 / (high - below), 1 / (low - below))


def _cycle(loop: LinearLoop, turn: Fraction) -> tuple[int, ...]:
    """w(1) … w(q) = A (1 − cos 2π p k/q), rounded, A so large that rounding does not matter."""
    p, q = turn.numerator, turn.denominator
    if q == 2:
        return (1, 0)
    saved = ctx.prec
    try:
        ctx.prec = 512
        depth = abs(float(_evaluate(loop.criterion, arb.cos_pi_fmpq(fmpq(2 * p, q)))))
        largest = float(sum(abs(c) for c in loop.criterion.coeffs()))
        bits = 6 + ceil(max(0.0, 0.5 * log2(largest / depth)) - log2(2 * sin(pi * p / q)))
        if bits <= 44:
            size = float(1 << bits)
            return tuple(round(size * (1 - cos(2 * pi * (p * k % q) / q))) for k in range(1, q + 1))
        ctx.prec = bits + 64
        return tuple(
            _nearest((1 << bits) * (1 - arb.cos_pi_fmpq(fmpq(2 * (p * k % q), q)))) for k in range(1, q + 1)
        )
    finally:
        ctx.prec = saved


def _nearest(value: arb) -> int:
    middle = value.mid().fmpq()
    return round(Fraction(int(middle.p), int(middle.q)))


def _evaluate(p: fmpz_poly, at: arb) -> arb:
    total = arb(0)
    for c in reversed(p.coeffs()):
        total = total * at + c
    return total
