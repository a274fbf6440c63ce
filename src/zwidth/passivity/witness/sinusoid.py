"""Motions that refute a loop by H(z): sinusoids, and what builds up where the law is not stable.

Where the criterion is negative over a band of frequencies, the fraction p/q of simplest denominator in the
band gives the shortest periodic motion.  Every period takes out energy and returns the loop to its state;
enough of them pay for going in and out.
"""

from __future__ import annotations

from cmath import phase
from collections.abc import Callable, Iterator
from fractions import Fraction
from math import ceil, copysign, cos, isfinite, log, log2, pi, sin

from flint import arb, fmpq, fmpz_poly

from zwidth.passivity.linear.criterion import closed_loop, offset_of, tightest
from zwidth.passivity.linear.exact_algebra import is_schur, roots_inside
from zwidth.passivity.linear.loop import LinearLoop
from zwidth.passivity.linear.positivity import prove_nonnegative
from zwidth.passivity.witness.motion import Motion, Pattern, Repeat, any_damping, convolve, forces_of
from zwidth.quantity.balls import as_fmpq, middle, precision

LONGEST_PERIOD = 10_000
"""Samples in one period; a criterion violated in a narrower band is shown by no motion."""

LONGEST_LISTED = 5_000
"""Samples in one slow period beyond which a wave of constant speeds is used instead."""

LONGEST_WAY_IN = 50_000
"""Samples in which a filter must come to rest inside the wall."""

_TURN_BITS = 256

_PIECES, _SPEED = 64, 1000
_RAMPS = (1, 16, 256)


def sinusoids(loop: LinearLoop, unilateral: bool) -> Iterator[Pattern]:
    """Patterns at a frequency where the criterion is negative; none in too narrow a band.

    A law with memory behind a unilateral surface is kept in contact: the
    pattern first goes in, the slower the later.
    """
    band = negative_band(loop)
    if band is None:
        return
    turn = simplest_between(*band)
    if band[0] <= turn and turn.numerator == 1 and turn.denominator > LONGEST_LISTED:
        if sum(loop.follower) == 0:  # an integrator never settles at a speed: every sample would be run
            return
        yield _slow_wave(loop, unilateral)
        return
    if turn.denominator > LONGEST_PERIOD:
        return
    cycle = _cycle(loop, turn)
    settled = cycle * (1 + (_memory(loop) + 1) // len(cycle)) if _memory(loop) else ()
    if unilateral and len(loop.numerator) + len(loop.denominator) > 2:
        if sum(loop.follower) <= 0 or not is_schur(loop.denominator[::-1]):
            return  # an unstable filter cannot be led in to rest
        for ramp in _RAMPS if len(cycle) < LONGEST_LISTED else _RAMPS[1:2]:
            pattern = _inside(loop, cycle, settled, ramp)
            if pattern is not None:
                yield pattern
        return
    first = len(settled)
    w = (0, *settled, *cycle, *(0,) * (len(loop.denominator) - 1))
    yield Pattern(w, (Repeat(first, first + len(cycle), 1),))


def _memory(loop: LinearLoop) -> int:
    """Samples after which a periodic w has a periodic force at the device."""
    return len(loop.numerator) + len(loop.denominator) - 2 + loop.whole_delay + (loop.part_delay > 0)


def _inside(loop: LinearLoop, cycle: tuple[int, ...], settled: tuple[int, ...], ramp: int) -> Pattern | None:
    """The cycle on top of a depth: a way in of `ramp` samples, the rounds, a way out, and a last step."""
    at_one = sum(loop.follower)
    depth = max(cycle) * sum(abs(c) for c in loop.follower) // at_one + 1
    rise = [k / ramp for k in range(1, ramp + 1)]
    way_in = _following(loop, rise, depth)
    fall = _following(loop, [1 - v for v in rise[:-1]], depth, start=1.0) if ramp > 1 else ()
    if way_in is None or fall is None:
        return None
    lead = (0, *way_in, *(depth + w for w in settled))
    hold = (depth,) * (_memory(loop) + 1)
    w = (*lead, *(depth + v for v in cycle), *hold, *fall)
    first = len(lead) - 1
    return Pattern(w, (Repeat(first, first + len(cycle), 1),), True)


def _following(loop: LinearLoop, x: list[float], depth: int, start: float = 0.0) -> tuple[int, ...] | None:
    """Whole w that carries the position nearly along x, in parts of the depth, to rest if x ends at 1.

    None where the filter is too slow, or too badly conditioned, to come to rest.
    """
    d, at_one = loop.follower, sum(loop.follower)
    scale = 1 << (64 + 16 * len(d))  # clustered poles cancel many digits
    past = [round(start) * scale] * (len(d) - 1)
    w: list[int] = []
    while len(w) < len(x) or x[-1] == 1:
        target = x[len(w)] if len(w) < len(x) else 1.0
        value = round(target * (1 << 60)) * (scale >> 60) * at_one
        value = (value - sum(a * v for a, v in zip(d[1:], past, strict=True))) // d[0]
        if abs(value) > 2**40 * scale or len(w) > LONGEST_WAY_IN:
            return None
        past = [value, *past[:-1]] if past else []
        w.append((depth * value + scale // 2) // scale)
        if len(w) >= len(x) and all(abs(v - scale) * depth * 2 < scale for v in past):
            break
    if x[-1] == 1:
        w += [depth] * (_memory(loop) + 1)
    return tuple(w)


def _slow_wave(loop: LinearLoop, unilateral: bool) -> Pattern:
    """One very slow wave: pieces of constant speed, in with the first half and out with the second.

    Where only slow motions gain, the length of the pieces is what decides; each is one sample, done many
    times.  Behind a surface the wave stands on a depth that keeps x > 0 while the filter follows.
    """
    settle = _memory(loop) + 2
    lag = sum(i * abs(c) for i, c in enumerate(loop.follower))
    at_one = sum(loop.follower)
    stands = unilateral and settle > 2 and at_one > 0
    base = _SPEED * lag // at_one + _SPEED if stands else 0
    w = [0, *[base] * (settle if stands else 0)]
    repeats = []
    for piece in range(_PIECES):
        speed = round(_SPEED * sin(2 * pi * (piece + 0.5) / _PIECES))
        for _ in range(settle + 2):
            w.append(w[-1] + speed)
        repeats.append(Repeat(len(w) - 3, len(w) - 2, 1))
    w += [base] * settle if stands else [0] * (settle + len(loop.denominator))
    return Pattern(tuple(w), tuple(repeats), stands)


def negative_band(loop: LinearLoop) -> tuple[Fraction, Fraction] | None:
    """Turns per sample ωT/2π, low to high, well inside a band where the criterion is negative."""
    criterion = loop.criterion
    _, cosine = tightest(loop)
    at = as_fmpq(cosine)
    if criterion(at) >= 0:  # beside a pole on the unit circle the need has no largest value
        point = prove_nonnegative(criterion)
        if not isinstance(point, Fraction):
            return None
        at = as_fmpq(point)
    return band_about(criterion, at)


def band_about(p: fmpz_poly, cosine: fmpq) -> tuple[Fraction, Fraction]:
    """The same of any polynomial in cos θ, about a place where it is negative."""
    low, high = Fraction(0), Fraction(1, 2)
    with precision(_TURN_BITS):
        here = _turn(cosine)
        for root in roots_inside(p, _TURN_BITS):
            turn = _turn(as_fmpq(root))
            low, high = (max(low, turn), high) if turn < here else (low, min(high, turn))
    margin = (high - low) / 4
    return low + margin, high if high == Fraction(1, 2) else high - margin


def _turn(cosine: fmpq) -> Fraction:
    return middle(arb(cosine).acos() / (2 * arb.pi()))


def simplest_between(low: Fraction, high: Fraction) -> Fraction:
    """The fraction of smallest denominator in [low, high], 0 ≤ low < high."""
    whole = ceil(low)
    if whole <= high and whole > 0:
        return Fraction(whole)
    below = whole - 1 if whole > low else whole
    if low == below:  # only with low = 0
        return below + Fraction(1, ceil(1 / (high - below)))
    return below + 1 / simplest_between(1 / (high - below), 1 / (low - below))


def _cycle(loop: LinearLoop, turn: Fraction) -> tuple[int, ...]:
    """w(1) … w(q) = A (1 − cos 2π p k/q), rounded, A so large that rounding does not matter."""
    p, q = turn.numerator, turn.denominator
    if q == 2:
        return (1, 0)
    needed = _bits_of_size(loop.criterion, fmpq(2 * p, q))
    bits = 6 + ceil(needed - log2(2 * sin(pi * p / q)))
    if bits <= 44:
        size = float(1 << bits)
        return tuple(round(size * (1 - cos(2 * pi * (p * k % q) / q))) for k in range(1, q + 1))
    with precision(bits + 64):
        return tuple(
            round(middle((1 << bits) * (1 - arb.cos_pi_fmpq(fmpq(2 * (p * k % q), q)))))
            for k in range(1, q + 1)
        )


def _bits_of_size(criterion: fmpz_poly, half_turns: fmpq) -> float:
    """Bits that a wave of this frequency needs, for rounding not to matter beside what it gains."""
    largest = sum(abs(c) for c in criterion.coeffs())
    with precision(512 + criterion.height_bits()):
        gained = criterion(arb.cos_pi_fmpq(half_turns))
        return max(0.0, 0.5 * float((largest / abs(gained)).log_base(2)))


# The shortest motions for laws with memory, to and fro from the surface, every sample listed.  Where a
# criterion is clearly violated the law need not settle first: going to and fro at the violated frequency
# gains from the first rounds on what a slow part of the law takes, such as a tissue that relaxes over
# minutes.  The filter's exact numbers grow with every sample, which bounds the length.


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


def enough_rounds(energy: Callable[[int], Fraction | None], first: int = 2) -> int | None:
    """Rounds after which a repeated motion has gained: energy is affine in them from the first on."""
    one = energy(1)
    if one is not None and one > 0:
        return 1
    before, after = energy(first), energy(first + 1)
    if before is None or after is None or after <= before:
        return None
    return first if before > 0 else first + 1 + ceil(-2 * before / (after - before))


# Of a loop whose criterion is nonnegative but whose environment is not stable: a negative static stiffness
# gives energy to a slow press.  An unstable law builds up force while the hand holds still; the hand then
# lets itself be moved.  A pole on the unit circle is followed at its own frequency.


_HOLDS = (8, 32, 128, 512, 2048)
_STEP = 1024


def slow_press(loop: LinearLoop) -> Pattern:
    """A way in at constant speed, ending at rest inside; the repeated sample makes it as long as need be."""
    settle = len(loop.numerator) + len(loop.denominator) + loop.whole_delay + 2
    steady = range(settle + 2)
    return Pattern((*steady, *[settle + 1] * settle), (Repeat(settle, settle + 1, 1),))


PRESS_LENGTHS = tuple(4**k for k in range(1, 40))


def holds(loop: LinearLoop) -> Iterator[Motion]:
    """In by one step, still while the force of an unstable law grows, and one move with the newest force."""
    for length in _HOLDS:
        x = [0, *[_STEP] * length]
        force = forces_of(loop, x)[length - loop.whole_delay] if length > loop.whole_delay else 0.0
        if not isfinite(force):
            return
        share = float((1 - loop.part_delay) * loop.period)
        move = force * share / 2 / float(loop.damping) if loop.damping else copysign(_STEP, force)
        if move and isfinite(move):
            positions = (*map(Fraction, x), _STEP - Fraction(f"{move:.3g}"))
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
            for length in _HOLDS:
                yield _buildup(loop, mode, length, base)


def _way_in(loop: LinearLoop) -> tuple[int, ...] | None:
    """Whole w to a depth at which the start of a mode leaves x > 0; None where D(1) ≤ 0."""
    at_one = sum(loop.follower)
    if at_one <= 0:
        return None
    depth = 4 * _STEP * sum(abs(c) for c in loop.follower) // at_one + 1
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
        w.append(base[-1] + round(_STEP * (k if lossless else rate**k) * cos(angle * k)))
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
    b = loop.damping or max(abs(mean), Fraction(1)) * loop.period / (2 * _STEP)
    return -Fraction(round(mean * loop.period / (2 * b)))
