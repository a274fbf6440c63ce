"""A motion of the free arm re-run while a known hand holds the other: what it takes out at the least.

    a x_h = −g f_h,    f_h = A_h x_h + C_h x,    f = A x + C x_h,    all from rest at 0

Straight from sample to sample, an interval costs (1 − α) f(k−d) Δx + α f(k−d−1) Δx + b Δx²/T + f_c |Δx|.
The held arm is where numbers with bounds say: those grow from sample to sample, and bits are there for that.
"""

from __future__ import annotations

from collections.abc import Sequence
from fractions import Fraction
from typing import Any

from ..document.effort import spend
from ..document.fields import Read, document, numbers
from ..document.refusal import Invalid
from ..document.unit import LENGTH
from ..exact.enclosed import Enclosed, in_z, known
from ..known_hand.held_motion import sampled
from ..loop.motion import TOLD
from .coupling import PAIR
from .felt import Held
from .held import HELD, held_of

LONGEST = 10_000
BITS_A_SAMPLE = 2
"""Of |a₁| + |a₂| < 3 for each sample, at most."""

HELD_MOTION = document(
    {"loop": PAIR, "held": HELD, **TOLD, "positions": numbers(LENGTH, least=2, most=LONGEST, shown=False)}
)


def held_motion_energy(told: Read) -> Fraction:
    """What comes out at least [J]."""
    held, path = held_of(told), told.positions
    if held.motion.middle != held.motion:
        raise Invalid("a motion is re-run with single values of a hand, not with intervals")
    if held.arm.coulomb_friction or held.free.resolution or held.arm.resolution:
        raise Invalid("a motion is re-run without encoders, and without Coulomb friction of the held arm")
    if path[0]:
        raise Invalid("the motion must start at rest at 0")
    bits = held.bits + BITS_A_SAMPLE * len(path)
    spend(12 * len(path), bits, bits)
    forces = _forces(held._replace(bits=bits), [known(x, bits) for x in path])
    return -_cost(held, path, forces)


def _forces(held: Held, path: list[Enclosed]) -> list[Enclosed]:
    """Those of the free arm as they are computed, times `scale`."""
    found, zero = sampled(held.motion, held.bits), Enclosed(held.bits, 0)
    drag, push = in_z(found.denominator)[1:], in_z(found.numerator)
    late = found.late + len(drag) + 1 - len(push)
    own, other, its_own, its_other = held.taps
    where, its, forces = list[Enclosed](), list[Enclosed](), list[Enclosed]()
    for k in range(len(path)):
        moved = _tapped(drag, where, k - 1, zero) + _tapped(push, its, k - late, zero)
        where.append(-moved)
        its.append(_tapped(its_own, where, k, _tapped(its_other, path, k, zero)).over(held.scale))
        forces.append(_tapped(own, path, k, _tapped(other, where, k, zero)))
    return forces


def _tapped(taps: Sequence[Any], values: Sequence[Enclosed], newest: int, total: Enclosed) -> Enclosed:
    """With Σ taps_i values(newest − i), of whole numbers or of numbers with bounds."""
    for age, c in enumerate(taps[: max(newest + 1, 0)]):
        if isinstance(c, Enclosed):
            total = total + values[newest - age] * c
        elif c:
            total = total + values[newest - age].times(c)
    return total


def _cost(held: Held, path: list[Fraction], forces: list[Enclosed]) -> Fraction:
    """At most [J]."""
    free, bits = held.free, forces[0].bits
    total, rubbed = Enclosed(bits, 0), Fraction(0)
    for k in range(len(path) - 1):
        move = path[k + 1] - path[k]
        rubbed += free.damping * move**2 / held.period + free.coulomb_friction * abs(move)
        for late, share in ((free.whole, 1 - free.part), (free.whole + 1, free.part)):
            if share and k >= late:
                total = total + forces[k - late] * known(move * share, bits)
    return Fraction(total.middle + total.reach, held.scale << bits) + rubbed
