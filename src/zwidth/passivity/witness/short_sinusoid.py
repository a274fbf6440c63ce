"""The shortest motions for laws with memory: to and fro from the surface, every sample listed.

Where a criterion is clearly violated the law need not settle first: going to
and fro at the violated frequency gains from the first rounds on what a slow
part of the law takes, such as a tissue that relaxes over minutes.  The filter's
exact numbers grow with every sample, which bounds the length.
"""

from __future__ import annotations

from collections.abc import Iterator
from fractions import Fraction
from math import cos, pi

from zwidth.passivity.linear.loop import LinearLoop
from zwidth.passivity.witness.motion import Motion, any_damping
from zwidth.passivity.witness.sinusoid import negative_band, simplest_between

_SIZE = 256


def oscillations(loop: LinearLoop, longest: int) -> Iterator[Motion]:
    """Motions of at most `longest` samples at a violated frequency, shorter first; none in a narrow band."""
    band = negative_band(loop)
    if band is None:
        return
    turn = simplest_between(*band)
    p, q = turn.numerator, turn.denominator
    if q > longest:
        return
    cycle = [round(_SIZE * (1 - cos(2 * pi * (p * k % q) / q))) for k in range(1, q + 1)]
    base = _SIZE // 8  # keeps contact between the rounds
    rounds = 1
    while rounds * q <= longest:
        x = [0, *(base + c for c in cycle * rounds), 0]
        yield Motion(tuple(Fraction(v) for v in x), _switches(loop, x))
        rounds *= 4


def _switches(loop: LinearLoop, x: list[int]) -> tuple[Fraction, ...]:
    """The best places for a force that changes inside a sample, to the nearest 1/16; see `motion`."""
    alpha, d = loop.part_delay, loop.whole_delay
    if not alpha:
        return ()
    force = forces_of(loop, x)
    gain = float(loop.period / (2 * (loop.damping or any_damping(loop))) * alpha * (1 - alpha))

    def at(k: int) -> float:
        return force[k] if k >= 0 else 0.0

    ideal = (
        x[k] + float(alpha) * (x[k + 1] - x[k]) - gain * (at(k - d - 1) - at(k - d))
        for k in range(len(x) - 1)
    )
    return tuple(Fraction(round(16 * y), 16) for y in ideal)


def forces_of(loop: LinearLoop, x: list[int]) -> list[float]:
    """f(k) to rounding."""
    d = [c / loop.denominator[0] for c in loop.denominator]
    n = [c / loop.denominator[0] for c in loop.numerator]
    f: list[float] = []
    for k in range(len(x)):
        value = sum(c * x[k - i] for i, c in enumerate(n) if k >= i)
        f.append(value - sum(d[i] * f[k - i] for i in range(1, len(d)) if k >= i))
    return f
