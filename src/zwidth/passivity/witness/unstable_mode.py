"""Motions that refute a loop whose criterion is nonnegative but whose environment is not stable.

A negative static stiffness gives energy to a slow press.  An unstable law
builds up force while the hand holds still; the hand then lets itself be moved.
A pole on the unit circle is followed at its own frequency.
"""

from __future__ import annotations

from cmath import phase
from collections.abc import Iterator
from fractions import Fraction
from math import copysign, cos, isfinite, log

from flint import fmpz_poly

from zwidth.passivity.linear.linear import closed_loop, offset_of
from zwidth.passivity.linear.loop import LinearLoop
from zwidth.passivity.witness.motion import Motion, Pattern, Repeat, convolve
from zwidth.passivity.witness.short_sinusoid import forces_of

_LENGTHS = (8, 32, 128, 512, 2048)
_SIZE = 1024


def slow_press(loop: LinearLoop) -> Pattern:
    """A way in at constant speed, ending at rest inside; the repeated sample makes it as long as need be."""
    settle = len(loop.numerator) + len(loop.denominator) + loop.whole_delay + 2
    steady = range(settle + 2)
    return Pattern((*steady, *[settle + 1] * settle), (Repeat(settle, settle + 1, 1),))


PRESS_LENGTHS = tuple(4**k for k in range(1, 40))


def holds(loop: LinearLoop) -> Iterator[Motion]:
    """In by one step, still while the force of an unstable law grows, and one move with the newest force."""
    for length in _LENGTHS:
        x = [0, *[_SIZE] * length]
        force = forces_of(loop, x)[length - loop.whole_delay] if length > loop.whole_delay else 0.0
        if not isfinite(force):
            return
        share = float((1 - loop.part_delay) * loop.period)
        move = force * share / 2 / float(loop.damping) if loop.damping else copysign(_SIZE, force)
        if move and isfinite(move):
            positions = (*map(Fraction, x), _SIZE - Fraction(f"{move:.3g}"))
            yield Motion(positions, positions[:-1] if loop.part_delay else ())


def buildups(loop: LinearLoop, unilateral: bool) -> Iterator[Motion]:
    """Motions that follow an unstable or lossless mode of the law, then let the force do work."""
    seen = fmpz_poly(list(loop.denominator[::-1])).complex_roots()
    if loop.part_delay == 0:
        seen = seen + fmpz_poly(closed_loop(loop, offset_of(loop))[::-1]).complex_roots()
    modes = [complex(float(root.real), float(root.imag)) for root, _ in seen]
    base = _way_in(loop) if unilateral else (0,)
    if base is None:
        return
    for mode in modes:
        if abs(mode) > 1 - 1e-9 and mode.imag >= -1e-12:
            for length in _LENGTHS:
                yield _buildup(loop, mode, length, base)


def _way_in(loop: LinearLoop) -> tuple[int, ...] | None:
    """Whole w to a depth at which the start of a mode leaves x > 0; None where D(1) ≤ 0."""
    at_one = sum(loop.follower)
    if at_one <= 0:
        return None
    depth = 4 * _SIZE * sum(abs(c) for c in loop.follower) // at_one + 1
    ramp = 16 * len(loop.follower)
    return (*(depth * k // ramp for k in range(ramp + 1)), *[depth] * len(loop.follower))


def _buildup(loop: LinearLoop, mode: complex, length: int, base: tuple[int, ...]) -> Motion:
    """w = ρᵏ cos φk (or k cos φk on the unit circle), then one step with the force."""
    rate, angle = abs(mode), phase(mode)
    lossless = rate <= 1 + 1e-9
    if not lossless:  # an envelope beyond 1e18 would need more digits than it is worth
        length = min(length, max(4, int(41 / log(rate))))
    w = list(base)
    for k in range(length):
        w.append(base[-1] + round(_SIZE * (k if lossless else rate**k) * cos(angle * k)))
    x = [Fraction(v) for v in convolve(loop.follower, tuple(w))]
    x.append(x[-1] + _release(loop, convolve(loop.numerator, tuple(w))))
    if not loop.part_delay:
        return Motion(tuple(x))
    return Motion(tuple(x), tuple(a + loop.part_delay * (b - a) for a, b in zip(x, x[1:], strict=False)))


def _release(loop: LinearLoop, forces: list[int]) -> Fraction:
    """The last move: −f T/2b with the mean force f of the interval, where it gains most."""
    content = Fraction(loop.denominator[0], loop.follower[0])
    d, alpha = loop.whole_delay, loop.part_delay
    late = forces[-1 - d] if d < len(forces) else 0
    early = forces[-2 - d] if d + 1 < len(forces) else 0
    mean = (alpha * early + (1 - alpha) * late) / content
    b = loop.damping or max(abs(mean), Fraction(1)) * loop.period / (2 * _SIZE)
    return -Fraction(round(mean * loop.period / (2 * b)))
