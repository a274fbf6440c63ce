"""A motion that touches and leaves a law with memory, re-run: the energy it takes out, exactly."""

from __future__ import annotations

from fractions import Fraction
from math import gcd, lcm

from ..document.fields import Choice, Flag, Read, Record, document, numbers
from ..document.number import LENGTH, common_scale
from ..document.refusal import Invalid, spend
from ..exact.roots import inside_unit_circle
from ..loop.loop import LOOP, Loop, loop_of, require_surface
from ..loop.motion import TOLD, switch_positions

MOST_POSITIONS = 50_000
MOST_EFFORT = 2e6
"""Of the samples that the law is run for: products times a thousand bits of their factors, about."""

TOUCHING_MOTION = document(
    {
        "loop": LOOP,
        "law": Record({"fed_with": Choice("penetration", "position"), "never_pulls": Flag()}),
        **TOLD,
        "positions": numbers(LENGTH, least=2, most=MOST_POSITIONS, shown=False),
        "switch_positions": numbers(LENGTH, most=MOST_POSITIONS, default=None, shown=False),
    }
)


def touching_motion_energy(told: Read) -> Fraction:
    """Energy the hand takes out over one motion from rest outside, back to where it began [J].

    The law is fed with the reading q, or with max(q, 0); it pushes where q > 0 only, and if it never
    pulls a force below 0 is given as 0.  H is stable, so that it forgets while the hand rests outside,
    and the motion may be made again and again.
    """
    p, x = loop_of(told.loop), told.positions
    switches = switch_positions(told, bool(p.part))
    _require_sound(p, x)
    unit = lcm(*(v.denominator for v in (*x, *switches)))
    path, early_squares, late_squares = 0, 0, 0
    ways = [0] * len(x)  # how far the hand moves under the force of each sample
    for k, (here, at, there) in enumerate(zip(x, switches, x[1:], strict=False)):
        early, late = int((at - here) * unit), int((there - at) * unit)
        path += abs(early) + abs(late)
        early_squares += early * early
        late_squares += late * late
        for move, sample in ((early, k - p.whole - 1), (late, k - p.whole)):
            if sample >= 0:
                ways[sample] += move
    work = _work(p, x, ways, told.law.fed_with == "penetration", told.law.never_pulls)
    squares = late_squares / (1 - p.part) + (early_squares / p.part if p.part else 0)
    return -(work + p.coulomb_friction * path + p.damping / p.period * squares / unit) / unit


def _require_sound(p: Loop, x: list[Fraction]) -> None:
    require_surface(p)
    if _read(p, x[0]) > 0 or x[0] != x[-1]:
        raise Invalid("the motion must begin at rest outside and return to where it began")
    if not inside_unit_circle(p.denominator):
        raise Invalid("H(z) has a pole outside or on the unit circle: it does not forget")


def _read(p: Loop, x: Fraction) -> Fraction:
    return p.resolution * (x // p.resolution) if p.resolution else x


def _work(p: Loop, x: list[Fraction], ways: list[int], penetration: bool, never_pulls: bool) -> Fraction:
    """Σ f times its way, f of the samples inside: the direct form D w = u in whole numbers, f = N w.

    u is counted from the first reading, at which the law rests with the force H(1) q; w after k
    samples is a whole number over the k-th power of the first coefficient of D.
    """
    q = [_read(p, position) for position in x]
    last = max((k for k, reading in enumerate(q) if reading > 0), default=-1)
    rest = Fraction(0) if penetration else q[0]
    u = [max(reading, Fraction(0)) if penetration else reading - rest for reading in q[: last + 1]]
    held = rest * sum(p.numerator, Fraction(0)) / sum(p.denominator, Fraction(0))
    scale = common_scale((*p.numerator, *p.denominator))
    top, bottom = ([int(c * scale) for c in part] for part in (p.numerator, p.denominator))
    content = gcd(*bottom)
    bottom = [c // content for c in bottom]
    unit = lcm(held.denominator, *(v.denominator for v in u))
    at_rest = int(held * unit) * content
    lead, order = bottom[0], len(bottom) - 1
    feed = [c * lead**i for i, c in enumerate(top)]
    back = [c * lead ** max(i - 1, 0) for i, c in enumerate(bottom)]
    longest = max(map(int.bit_length, (*feed, *back)))
    past, power, effort, work = [0] * order, 1, 0.0, 0
    for k, v in enumerate(u):
        effort += (order + 2) * (1 + power.bit_length() / 1000)
        if effort > MOST_EFFORT:
            raise Invalid("the motion is too long, or its exact numbers grow too long, to be checked")
        spend(2 * order + 4, power.bit_length(), longest)
        w = int(v * unit) * power - sum(a * old for a, old in zip(back[1:], past, strict=True))
        power *= lead
        work *= lead
        if q[k] > 0:
            f = at_rest * power + feed[0] * w + sum(b * old for b, old in zip(feed[1:], past, strict=True))
            if not never_pulls or (f > 0) == (power > 0):
                work += f * ways[k]
        past = [w, *past[:-1]] if order else past
    return Fraction(work, power * unit * content)
