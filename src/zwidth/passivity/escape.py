"""Motions that refute a loop whose criterion is nonnegative but whose environment is not stable.

A negative static stiffness gives energy to a slow press.  An unstable law
builds up force from a small disturbance while the hand holds still; the hand
then lets itself be moved.
"""

from __future__ import annotations

from cmath import phase
from collections.abc import Iterator
from fractions import Fraction
from math import cos

from flint import fmpz_poly

from zwidth.passivity.linear import closed_loop
from zwidth.passivity.loop import LinearLoop
from zwidth.passivity.motion import Motion, Pattern, convolve

_LENGTHS = (8, 32, 128, 512, 2048, 8192, 32768)


def slow_presses(loop: LinearLoop) -> Iterator[Pattern]:
    """Ways in at constant speed, slower and slower, ending at rest inside."""
    for length in _LENGTHS:
        hold = (length,) * (len(loop.numerator) + len(loop.denominator) + loop.whole_delay + 1)
        yield Pattern((*range(length + 1), *hold), ())


def buildups(loop: LinearLoop) -> Iterator[Motion]:
    """Motions that follow an unstable or lossless mode of the law, then let the force do work."""
    offset = loop.damping or Fraction(1)
    seen = fmpz_poly(list(loop.denominator[::-1])).complex_roots()
    if loop.part_delay == 0:
        seen = seen + fmpz_poly(closed_loop(loop, offset)[::-1]).complex_roots()
    modes = [complex(float(root.real), float(root.imag)) for root, _ in seen]
    for mode in modes:
        if abs(mode) > 1 - 1e-9 and mode.imag >= -1e-12:
            for length in _LENGTHS[:5]:
                yield _buildup(loop, mode, length, growing=abs(mode) <= 1 + 1e-9)


def _buildup(loop: LinearLoop, mode: complex, length: int, growing: bool) -> Motion:
    """w = ρᵏ cos φk (or k cos φk on the unit circle), then one step with the force."""
    rate, angle = abs(mode), phase(mode)
    if not growing:  # keep numbers below 2^60: start late rather than overflow
        length = min(length, max(4, int(40 / max(rate - 1, 1e-9))))
    size = 1024.0
    w = [0]
    for k in range(length):
        envelope = size * (k if growing else min(rate**k, 1e18))
        w.append(round(envelope * cos(angle * k)))
    x = [Fraction(v) for v in convolve(loop.follower, tuple(w))]
    content = Fraction(loop.denominator[0], loop.follower[0])
    forces = [f / content for f in convolve(loop.numerator, tuple(w))]
    b = loop.damping or max(abs(forces[-1]), Fraction(1)) * loop.period / 1024
    late = forces[-1 - loop.whole_delay] if loop.whole_delay < len(forces) else Fraction(0)
    x.append(x[-1] - round(late * loop.period / (2 * b)))
    switches = tuple(a + loop.part_delay * (c - a) for a, c in zip(x, x[1:], strict=False))
    return Motion(tuple(x), switches if loop.part_delay else ())
