"""Does every motion of device, known hand and wall die out, for all values within intervals?

    P(z) = z^e p(z) H_D(z) + N(z) H_N(z),    −x/f = N/(z^e p) of the motion, f = H x of the law

One value is decided by the recursion of Schur and Cohn.  An interval: its middle, and that from there to
every other value no root meets the unit circle; a box that does not show it is halved.
"""

from __future__ import annotations

from collections.abc import Sequence
from fractions import Fraction
from itertools import product
from math import ceil, comb, isfinite, lcm
from typing import Any, NamedTuple

from ..document.fields import Between, Number, Read, Record, document, numbers
from ..document.number import DAMPING, MASS, SECONDS, STIFFNESS, common_scale
from ..document.refusal import Invalid
from ..exact.enclosed import Enclosed, quotient
from ..exact.polynomial import multiply, shifted
from ..exact.roots import decays
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


# Does no root meet the unit circle, whatever the values within bounds?
#
# Roots move continuously.  Where they lie inside for one value of a box and never meet the circle, they lie
# inside for all.  With z = (1 + w)/(1 − w) and c(w) = c₀ wⁿ + … + cₙ a root at z = −1 is c₀ = 0, one at 1 is
# cₙ = 0, and a pair e^{±jθ} has w₁ + w₂ = 0, which by Orlando's formula
#
#     det H = ± c₀ⁿ⁻¹ Π_{i<j} (wᵢ + wⱼ),    H of order n − 1,  Hᵢⱼ = c_{2j−i}
#
# makes Hurwitz's matrix singular.  It is regular where some matrices C and R, however found, leave so little
# of I − C H R that a vector u > 0 has |I − C H R| u < u.  Two of them, so that of a matrix that is nearly
# singular one entry alone is small, which knows what cancels in det H.


_ROUNDS = 20
_Matrix = list[list[Enclosed]]
_Floats = list[list[float]]


def never_crosses(in_zeta: list[Enclosed]) -> bool:
    """True where no polynomial within the bounds, in descending powers of ζ, has a root on the circle."""
    c = _bilinear(in_zeta)
    if not c[0].sign or not c[-1].sign:
        return False
    matrix = _hurwitz(c)
    sides = _sides([[x.middle / (1 << x.bits) for x in row] for row in matrix])
    return sides is not None and _is_small(_deviation(matrix, *sides), c[0].bits)


def _bilinear(in_zeta: list[Enclosed]) -> list[Enclosed]:
    """Σ a_i (2w)ⁿ⁻ⁱ (1 − w)ⁱ, descending."""
    n = len(in_zeta) - 1
    out = [Enclosed(in_zeta[0].bits, 0)] * (n + 1)
    for i, a in enumerate(in_zeta):
        for k in range(i + 1):
            factor = comb(i, k) << (n - i)
            out[i - k] = out[i - k] + a.times(-factor if k % 2 else factor)
    return out


def _hurwitz(c: list[Enclosed]) -> _Matrix:
    n, zero = len(c) - 1, Enclosed(c[0].bits, 0)
    places = range(1, n)
    return [[c[2 * j - i] if 0 <= 2 * j - i <= n else zero for j in places] for i in places]


def _sides(rows: _Floats) -> tuple[_Floats, _Floats] | None:
    """C, and the columns of R, with C H R near I, in floats: they need not be exact.

    By elimination, the largest number that is left first: what makes H nearly singular comes last.
    """
    size = len(rows)
    work = [row[:] for row in rows]
    left, right = ([[float(i == j) for j in range(size)] for i in range(size)] for _ in range(2))
    for k in range(size):
        top, side = max(product(range(k, size), repeat=2), key=lambda at: abs(work[at[0]][at[1]]))
        pivot = work[top][side]
        if not pivot:
            return None
        work[k], work[top], left[k], left[top] = work[top], work[k], left[top], left[k]
        right[k], right[side] = right[side], right[k]
        for row in work:
            row[k], row[side] = row[side], row[k]
        for i in range(k + 1, size):
            down, across = work[i][k] / pivot, work[k][i] / pivot
            work[i] = _less(work[i], down, work[k])
            left[i] = _less(left[i], down, left[k])
            right[i] = _less(right[i], across, right[k])
        left[k] = [x / pivot for x in left[k]]
    return (left, right) if all(isfinite(x) for row in (*left, *right) for x in row) else None


def _less(row: list[float], factor: float, other: list[float]) -> list[float]:
    return [x - factor * y for x, y in zip(row, other, strict=True)]


def _deviation(matrix: _Matrix, left: _Floats, right: _Floats) -> list[list[int]]:
    """Bounds of |I − C H R|, in units of 2^−bits."""
    if not matrix:
        return []
    bits = matrix[0][0].bits
    close = _turned(right, _turned(left, matrix))
    out = []
    for i, row in enumerate(close):
        middles = [x.middle - (1 << 3 * bits if i == j else 0) for j, x in enumerate(row)]
        out.append([-(-(abs(m) + x.reach) >> 2 * bits) for m, x in zip(middles, row, strict=True)])
    return out


def _turned(weights: _Floats, matrix: _Matrix) -> _Matrix:
    """(W A)ᵀ, times 2^bits: twice so gives C H R."""
    bits = matrix[0][0].bits
    whole = [[_fixed(x, bits) for x in row] for row in weights]
    return [[_weighed(column, row) for row in whole] for column in zip(*matrix, strict=True)]


def _weighed(numbers: Sequence[Enclosed], weights: Sequence[int]) -> Enclosed:
    total = Enclosed(numbers[0].bits, 0)
    for x, weight in zip(numbers, weights, strict=True):
        if x.sign != 0:
            total = total + x.times(weight)
    return total


def _fixed(value: float, bits: int) -> int:
    top, bottom = value.as_integer_ratio()
    return (top << bits) // bottom


def _is_small(bounds: list[list[int]], bits: int) -> bool:
    """B u < u for u = 1 + B + B² + …, cut off."""
    u = [1 << bits] * len(bounds)
    for _ in range(_ROUNDS):
        u = [(1 << bits) + (x >> bits) for x in _applied(bounds, u)]
    return all(x < y << bits for x, y in zip(_applied(bounds, u), u, strict=True))


def _applied(bounds: list[list[int]], u: list[int]) -> list[int]:
    return [sum(x * y for x, y in zip(row, u, strict=True)) for row in bounds]
