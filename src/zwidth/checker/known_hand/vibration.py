"""A motion that a one-sided wall keeps up for ever: solved again, every sample on its side of the surface.

    x = −G f,    f = K max(x − g, 0),    G = N/D:  Σ Dᵢ x(j+i) + K Σ Nᵢ s(j+i) (x(j+i) − g) = 0,  i = 0 … p

With the pattern s of samples inside, s(j+n) = s(j), p positions W determine all that follow, affinely.  After
n samples they are M W + v; the motion repeats itself where (I − M) W = v.  It is one of the wall if then
x(j) > g exactly where s(j) = 1.  A pattern with samples on both sides is not at rest.
"""

from __future__ import annotations

from collections.abc import Mapping
from fractions import Fraction
from typing import Any, NamedTuple

from ..document.reading import Invalid, get, number, numbers, with_no_more_than
from ..exact.enclosed import Enclosed, in_z, known
from .held_motion import Motion, quantity, read_motion, sampled

MOST_ORDER = 60
LONGEST = 1000
MOST_EFFORT = 1_000_000
PRECISIONS = (256, 1024, 4096, 16384)

_Row = list[Enclosed]
"""What a position is made of: a weight of each of the p first ones, and a constant."""


class _Wall(NamedTuple):
    slope: Fraction
    gap: Fraction
    inside: list[bool]


def vibration(document: Mapping[str, Any]) -> str:
    wall = _wall(document)
    order = len(_plant(document, PRECISIONS[0])[1])
    if order**2 * len(wall.inside) > MOST_EFFORT:
        raise Invalid("the motion is too long for a plant of this order")
    answers = (_repeats(*_plant(document, bits), wall, bits) for bits in PRECISIONS)
    if not next((answer for answer in answers if answer is not None), False):
        raise Invalid("the motion with this pattern is not one of the wall")
    return (
        f"a one-sided wall of slope {float(wall.slope):.9g}, {float(wall.gap):.9g} off the hand's rest, "
        f"vibrates for ever: rounds of {len(wall.inside)} samples, {sum(wall.inside)} inside"
    )


def _wall(document: Mapping[str, Any]) -> _Wall:
    slope, gap, inside = number(get(document, "slope")), number(get(document, "gap")), get(document, "inside")
    if slope <= 0:
        raise Invalid("the slope must be > 0")
    if not isinstance(inside, list) or not 2 <= len(inside) <= LONGEST:
        raise Invalid(f"inside must say of 2 … {LONGEST} samples whether they find the wall")
    if not all(isinstance(s, bool) for s in inside) or len(set(inside)) < 2:
        raise Invalid("some samples must find the wall and some not, true or false")
    return _Wall(slope, gap, inside)


def _plant(document: Mapping[str, Any], bits: int) -> tuple[list[Enclosed], list[Enclosed]]:
    """N and D in ascending powers of z without the leading 1 of D, of one length."""
    if "plant" in document:
        if "loop" in document:
            raise Invalid("the document speaks of a plant and of a loop: only one can be meant")
        plant = get(document, "plant")
        top, bottom = (numbers(get(plant, name), MOST_ORDER) for name in ("numerator", "denominator"))
        if not bottom or bottom[0] == 0 or not 0 < len(top) < len(bottom):
            raise Invalid("G(z) must be strictly proper")
        above, below = ([known(c / bottom[0], bits) for c in part] for part in (top, bottom))
    else:
        found = sampled(_touched(get(document, "loop")), bits)
        above, below = in_z(found.numerator), in_z(found.denominator)
        below = [*below, *[Enclosed(bits, 0)] * found.late]
    if len(below) > MOST_ORDER:
        raise Invalid(f"the order of G(z) is more than {MOST_ORDER}")
    padded = [*[Enclosed(bits, 0)] * (len(below) - 1 - len(above)), *above]
    return padded[::-1], below[:0:-1]


def _touched(loop: Any) -> Motion:
    own = [quantity(loop, name) for name in ("mass", "damping")]
    hand = [quantity(loop, f"hand_{name}") for name in ("mass", "damping")]
    if min(low for low, _ in (own[1], *hand)) < 0:
        raise Invalid("b, m_h and c must be ≥ 0")
    mass, damping = ((a[0] + b[0], a[1] + b[1]) for a, b in zip(own, hand, strict=True))
    rest = [quantity(loop, name) for name in ("hand_stiffness", "sample_period", "delay")]
    with_no_more_than(loop, len(own) + len(hand) + len(rest))
    motion = read_motion(mass, damping, *rest)
    if motion.middle != motion:
        raise Invalid("a motion is of certain numbers")
    return motion


def _repeats(above: list[Enclosed], below: list[Enclosed], wall: _Wall, bits: int) -> bool | None:
    """True where every sample is certainly on its side, False where one is not, None where it is open."""
    rows = _positions(above, below, wall, bits)
    start = _solved(rows, len(below), len(wall.inside))
    if start is None:
        return None
    gap, sides = known(wall.gap, bits), list[bool | None]()
    for row, inside in zip(rows, wall.inside, strict=False):
        off = row[-1] - gap
        for weight, x in zip(row, start, strict=False):
            off = off + weight * x
        sides.append(None if off.sign is None else (off.sign > 0) == inside and off.sign != 0)
    return False if False in sides else None if None in sides else True


def _positions(above: list[Enclosed], below: list[Enclosed], wall: _Wall, bits: int) -> list[_Row]:
    """x(0) … x(n + p − 1), made of the first p of them."""
    order, n = len(below), len(wall.inside)
    zero, one = Enclosed(bits, 0), known(Fraction(1), bits)
    stiff = [known(wall.slope, bits) * c for c in above]
    pushed = [c * known(wall.gap, bits) for c in stiff]
    rows = [[one if i == j else zero for i in range(order + 1)] for j in range(order)]
    for j in range(n):
        following = [zero] * (order + 1)
        for i in range(order):
            inside = wall.inside[(j + i) % n]
            weight = below[i] + stiff[i] if inside else below[i]
            following = [x - weight * y for x, y in zip(following, rows[j + i], strict=True)]
            if inside:
                following[-1] = following[-1] + pushed[i]
        rows.append(following)
    return rows


def _solved(rows: list[_Row], order: int, n: int) -> list[Enclosed] | None:
    """The first positions of which x(n + i) = x(i), by Gauss and Jordan."""
    work = [[x - y for x, y in zip(rows[i], rows[n + i], strict=True)] for i in range(order)]
    for k in range(order):
        best = max(range(k, order), key=lambda i: abs(work[i][k].middle))
        work[k], work[best] = work[best], work[k]
        inverse = _inverse(work[k][k])
        if inverse is None:
            return None
        work[k] = [x * inverse for x in work[k]]
        for i in range(order):
            if i != k:
                factor = work[i][k]
                work[i] = [x - factor * y for x, y in zip(work[i], work[k], strict=True)]
    return [row[-1].times(-1) for row in work]


def _inverse(x: Enclosed) -> Enclosed | None:
    """1/x, where x is certainly not 0."""
    least = abs(x.middle) - x.radius
    if least <= 0:
        return None
    one = 1 << 2 * x.bits
    off = one * x.radius // (abs(x.middle) * least) + 2
    return Enclosed(x.bits, one // x.middle, (), off)
