"""Does every motion of device, known hand and wall die out, for all values within intervals?

    P(z) = z^e p(z) H_D(z) + N(z) H_N(z),    −x/f = N/(z^e p) of the motion, f = H x of the law

One value is decided by the recursion of Schur and Cohn.  An interval: its middle, and that from there to
every other value no root meets the unit circle; a box that does not show it is halved.
"""

from __future__ import annotations

from fractions import Fraction
from math import ceil, lcm
from typing import Any, NamedTuple

from ..document.fields import Between, Number, Read, Record, document, numbers
from ..document.number import common_scale
from ..document.refusal import Invalid
from ..document.unit import DAMPING, MASS, SECONDS, STIFFNESS
from ..exact.crossing import never_crosses
from ..exact.enclosed import Enclosed, quotient
from ..exact.polynomial import multiply, shifted
from ..exact.schur_cohn import decays
from .held_motion import Motion, Sampled, motion_of, sampled, sampled_free

MOST_ORDER = 300
MOST_BOXES = 1000
MOST_HALVINGS = 45
MOST_EFFORT = 5_000_000
SERIES = 150
"""What the series of the motion costs in each box, beside its order³, times η + δ."""
MOST_EXACT = 8_000_000
BOX_BITS = 128
PRECISIONS = (128, 512, 2048)


KNOWN_HAND = document(
    {
        "loop": Record(
            {
                "mass": Between(MASS, above=0),
                "damping": Between(DAMPING, least=0),
                "stiffness": Between(STIFFNESS, least=0),
                "sample_period": Number(SECONDS, above=0),
                "delay": Number(SECONDS, least=0),
                "numerator": numbers(least=1, most=MOST_ORDER),
                "denominator": numbers(least=1, most=MOST_ORDER),
            }
        )
    }
)
"""Device and hand together, and H(z) of the law in descending powers of z."""

_Numbers = list[Any]
"""All Enclosed or all Fraction."""


class Loop(NamedTuple):
    """What moves, and the law that pushes it."""

    motion: Motion
    above: list[int]  # H(z), in descending powers of ζ, both in whole numbers
    below: list[int]


def stability(told: Read) -> str:
    """That every motion dies out."""
    loop = _read(told.loop)
    middle = loop.motion.middle
    if not comes_to_rest(loop._replace(motion=middle)):
        raise Invalid("that all roots lie inside the unit circle could not be confirmed")
    if middle == loop.motion:
        return "device, hand and wall come to rest after every disturbance, contact kept"
    boxes = _covered(loop)
    return (
        "device, hand and wall come to rest for every value in the intervals, contact kept, "
        f"{boxes} box{'es' * (boxes != 1)}"
    )


def instability(told: Read) -> str:
    """That one does not."""
    loop = _read(told.loop)
    if loop.motion.middle != loop.motion:
        raise Invalid("that a loop does not come to rest is proved of single values, not of intervals")
    if comes_to_rest(loop) is not False:
        raise Invalid("that a root lies on or outside the unit circle could not be confirmed")
    return "device, hand and wall do not come to rest, contact kept: a disturbance does not die out"


def _read(loop: Read) -> Loop:
    motion = motion_of(loop.mass, loop.damping, loop.stiffness, loop.sample_period, loop.delay)
    above, below = loop.numerator, loop.denominator
    if below[0] == 0 or len(above) > len(below):
        raise Invalid("H(z) must be proper, with a denominator that does not begin with 0")
    scale = common_scale((*above, *below))
    return Loop(motion, *(shifted([int(c * scale) for c in part]) for part in (above, below)))


def comes_to_rest(loop: Loop) -> bool | None:
    """Of a certain loop, with more and more bits; without spring and damper exactly."""
    for bits in PRECISIONS:
        answer = decays(_characteristic(loop, bits))
        if answer is not None:
            return answer
    if not loop.motion.is_free:
        return None
    whole = _exactly(loop)
    cost = len(whole) ** 2 * max(c.middle.bit_length() for c in whole)
    return decays(whole) if cost <= MOST_EXACT else None


def _characteristic(loop: Loop, bits: int) -> list[Enclosed]:
    """P, monic, in descending powers of ζ."""
    above, below = ([quotient(c, loop.below[0], bits) for c in part] for part in (loop.above, loop.below))
    return _closed(sampled(loop.motion, bits), above, below, Enclosed(bits, 0))


def _exactly(loop: Loop) -> list[Enclosed]:
    """A whole multiple of P, its first coefficient > 0, of a motion without spring and damper."""
    found = _closed(sampled_free(loop.motion), loop.above, loop.below, Fraction(0))
    scale = lcm(*(c.denominator for c in found)) * (1 if loop.below[0] > 0 else -1)
    return [Enclosed(0, int(c * scale)) for c in found]


def _closed(plant: Sampled, above: _Numbers, below: _Numbers, zero: Any) -> _Numbers:
    free = multiply(plant.denominator, below, zero)
    for _ in range(plant.late):  # times z = ζ + 1
        free = [x + y for x, y in zip([*free, zero], [zero, *free], strict=True)]
    force = multiply(plant.numerator, above, zero)
    ahead = len(free) - len(force)
    return [*free[:ahead], *(x + y for x, y in zip(free[ahead:], force, strict=True))]


def _covered(loop: Loop) -> int:
    """In how many boxes no root was found to meet the circle."""
    order = len(loop.below) + 1 + int(loop.motion.late) + (loop.motion.late % 1 > 0)
    most = min(MOST_BOXES, MOST_EFFORT // (order**3 + ceil(SERIES * loop.motion.norm)))
    wall = Fraction(loop.above[-1], loop.below[-1]) if loop.below[-1] else Fraction(0)  # H at z = 1
    left, tried, shown = [(loop.motion, 0)], 0, 0
    while left:
        box, halved = left.pop()
        tried += 1
        if tried > most or halved > MOST_HALVINGS:
            raise Invalid(f"that every value comes to rest was not confirmed in {tried} boxes")
        if never_crosses(_characteristic(loop._replace(motion=box), BOX_BITS)):
            shown += 1
        else:
            left += [(half, halved + 1) for half in box.halves(loop.motion, wall)]
    return shown
