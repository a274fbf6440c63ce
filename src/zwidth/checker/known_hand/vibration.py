"""A motion that a one-sided wall keeps up for ever: solved again, every sample on its side of the surface.

    x = −G f,    f = K max(x − g, 0),    G = N/D:  Σ Dᵢ x(j+i) + K Σ Nᵢ s(j+i) (x(j+i) − g) = 0,  i = 0 … p

With the pattern s of samples inside, s(j+n) = s(j), p positions W determine all that follow, affinely.  After
n samples they are M W + v; the motion repeats itself where (I − M) W = v.  It is one of the wall if then
x(j) > g exactly where s(j) = 1.  A pattern with samples on both sides is not at rest.
"""

from __future__ import annotations

from fractions import Fraction

from ..document.fields import Flag, List, Number, Read, document
from ..document.number import about
from ..document.refusal import Invalid
from ..exact.enclosed import Enclosed, known, quotient
from ..exact.functions import NotPositive, inverse
from .plant import PLANT, plant_of

MOST_ORDER = 60
LONGEST = 1000
MOST_EFFORT = 1_000_000
PRECISIONS = (256, 1024, 4096, 16384)

_Row = list[Enclosed]
"""What a position is made of: a weight of each of the p first ones, and a constant."""


VIBRATION = document(
    {
        **PLANT,
        "slope": Number(above=0),
        "gap": Number(),
        "inside": List(Flag(), least=2, most=LONGEST, shown=False),
    }
)


def vibration(told: Read) -> str:
    """Say what was proved."""
    if len(set(told.inside)) < 2:
        raise Invalid("the pattern must have samples inside the wall and samples outside")
    order = len(_plant(told, PRECISIONS[0])[1])
    if order > MOST_ORDER or order**2 * len(told.inside) > MOST_EFFORT:
        raise Invalid("the order of G(z) is too high, or the motion too long for it")
    answers = (_repeats(*_plant(told, bits), told, bits) for bits in PRECISIONS)
    if not next((answer for answer in answers if answer is not None), False):
        raise Invalid("the motion with this pattern is not one of the wall")
    return (
        f"a one-sided wall of slope {about(told.slope)}, {about(told.gap)} off the hand's rest, "
        f"vibrates for ever: rounds of {len(told.inside)} samples, {sum(told.inside)} inside"
    )


def _plant(told: Read, bits: int) -> tuple[list[Enclosed], list[Enclosed]]:
    """N and D in ascending powers of z without the leading 1 of D, of one length."""
    found = plant_of(told, bits)
    above, below = found.numerator, found.denominator
    if found.bits == 0:
        lead = below[0].middle
        above, below = ([quotient(c.middle, lead, bits) for c in part] for part in (above, below))
    padded = [*[Enclosed(bits, 0)] * (len(below) - 1 - len(above)), *above]
    return padded[::-1], below[:0:-1]


def _repeats(above: list[Enclosed], below: list[Enclosed], wall: Read, bits: int) -> bool | None:
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
        sides.append(None if off.sign is None else off.sign == (1 if inside else -1))
    return False if False in sides else None if None in sides else True


def _positions(above: list[Enclosed], below: list[Enclosed], wall: Read, bits: int) -> list[_Row]:
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
        try:
            over = inverse(work[k][k])
        except NotPositive:
            return None
        work[k] = [x * over for x in work[k]]
        for i in range(order):
            if i != k:
                factor = work[i][k]
                work[i] = [x - factor * y for x, y in zip(work[i], work[k], strict=True)]
    return [row[-1].times(-1) for row in work]
