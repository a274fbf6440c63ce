"""A one-sided wall against a plant that is known: it comes to rest, or vibrates for ever."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from fractions import Fraction
from typing import NamedTuple

from ..document.fields import Choice, Flag, List, Number, Read, Record, Whole, document, numbers
from ..document.number import DAMPING, MASS, SECONDS, STIFFNESS, about, common_scale, down
from ..document.refusal import Invalid, only_if, spend
from ..exact.enclosed import Enclosed, NotPositive, in_z, inverse, known, quotient
from ..exact.polynomial import in_powers
from ..exact.positivity import require_positive
from ..exact.roots import inside_unit_circle
from .held_motion import Motion, motion_of, sampled

# The plant of a one-sided wall: a device in a tied hand, or as given.
#
# x = −G f,    G = N/D, strictly proper

MOST_ORDER = 300
PLANT = {
    "plant": Record(
        {"numerator": numbers(least=1, most=MOST_ORDER), "denominator": numbers(least=1, most=MOST_ORDER)},
        default=None,
    ),
    "loop": Record(
        {
            "mass": Number(MASS, above=0),
            "damping": Number(DAMPING, least=0),
            "hand_mass": Number(MASS, least=0),
            "hand_damping": Number(DAMPING, least=0),
            "hand_stiffness": Number(STIFFNESS, least=0),
            "sample_period": Number(SECONDS, above=0),
            "delay": Number(SECONDS, least=0),
        },
        default=None,
    ),
}
"""One of both: G(z) in descending powers of z, or device and hand."""


class Plant(NamedTuple):
    """N and D in descending powers of z, within bounds."""

    numerator: list[Enclosed]
    denominator: list[Enclosed]

    @property
    def bits(self) -> int:
        """Of their fixed point; 0 where both are whole numbers."""
        return self.denominator[0].bits


def plant_of(told: Read, bits: int) -> Plant:
    """The plant of a document; computed with so many bits where it is not given."""
    if told.plant is not None:
        only_if(False, told.loop, "loop")
        return Plant(*([Enclosed(0, c) for c in part] for part in given(told.plant)))
    loop = only_if(True, told.loop, "loop")
    found = sampled(_touched(loop), bits)
    zero = Enclosed(bits, 0)
    return Plant(in_z(found.numerator), [*in_z(found.denominator), *[zero] * found.late])


def given(plant: Read) -> tuple[list[int], list[int]]:
    """N and D in whole numbers, in descending powers of z."""
    top, bottom = plant.numerator, plant.denominator
    if bottom[0] == 0 or len(top) >= len(bottom):
        raise Invalid("G(z) must be strictly proper")
    scale = common_scale((*top, *bottom))
    first, second = ([int(c * scale) for c in part] for part in (top, bottom))
    return first, second


def _touched(loop: Read) -> Motion:
    mass, damping, k = loop.mass + loop.hand_mass, loop.damping + loop.hand_damping, loop.hand_stiffness
    return motion_of((mass, mass), (damping, damping), (k, k), loop.sample_period, loop.delay)


# Absolute stability re-proved: x = −G f with f = φ(x), φ(0) = 0 and every slope of φ between 0 and K.
#
#     Re{M (1 + K G)} + q₁ K Re{(1 − z⁻¹) G} + q₂ K [Re{(z − 1) G} − (K/2) |(z − 1) G|²] > 0 for all |z| = 1
#
#     M = m₀ − Σ h_i z⁻ⁱ,  Σ|h_i| < m₀,  h_i ≥ 0 unless φ is odd;  q₁, q₂ ≥ 0;  G stable, strictly proper
#
# Each of the three terms belongs to a sum over the motion that φ does not let below 0: Zames and Falb, the
# convexity of Φ = ∫φ, and its slope.  Times |D|² the left side is a cosine polynomial, Σ c_j cos jθ.  With
# |cos jθ| ≤ 1 the error bounds of its coefficients are taken off, and what is left is a polynomial in cos θ,
# > 0 on [−1, 1] by Bernstein coefficients.


BITS = 320
MOST_TAPS = 400
FURTHEST_TAP = 200
_TAP = Record({"place": Whole(least=-FURTHEST_TAP, most=FURTHEST_TAP), "weight": Number()})
ABSOLUTE_STABILITY = document(
    {
        **PLANT,
        "nonlinearity": Choice("monotone", "odd monotone"),
        "slope": Number(above=0),
        "center": Number(shown=False),
        "taps": List(_TAP, most=MOST_TAPS, shown=False),
        "convexity": Number(least=0, shown=False),
        "smoothness": Number(least=0, shown=False),
    }
)


def absolute(told: Read) -> str:
    """Say what was proved."""
    plant = plant_of(told, BITS)
    _require_stable(told)
    terms = _terms(told, _multiplier(told))
    scale = common_scale(weight for weight, _, _ in terms)
    weights = [(int(weight * scale), at, pair) for weight, at, pair in terms]
    _require_positive(_inequality(plant, weights))
    return (
        f"every {told.nonlinearity} wall with slopes between 0 and {down(told.slope)} brings the loop to rest"
    )


def _require_stable(told: Read) -> None:
    if told.plant is not None:
        if not inside_unit_circle([Fraction(c) for c in given(told.plant)[1]]):
            raise Invalid("G(z) has a pole outside or on the unit circle")
    elif told.loop.hand_stiffness == 0 or told.loop.damping + told.loop.hand_damping == 0:
        raise Invalid("b + c and k must be > 0: else G(z) is not stable")


def _multiplier(told: Read) -> dict[int, Fraction]:
    """The weights of z^i in M."""
    taps = {tap.place: tap.weight for tap in told.taps}
    if len(taps) < len(told.taps) or 0 in taps:
        raise Invalid("every tap has a place of its own, and not 0")
    if told.nonlinearity == "monotone" and any(h < 0 for h in taps.values()):
        raise Invalid("a wall that is not odd allows no negative tap")
    if sum(map(abs, taps.values()), Fraction(0)) >= told.center:
        raise Invalid("the taps must weigh less than the center, all together")
    return {0: told.center, **{-place: -weight for place, weight in taps.items()}}


_Term = tuple[Fraction, int, str]
"""A weight, a power of z, and which product: D D̄, N D̄ or N N̄."""


def _terms(told: Read, multiplier: Mapping[int, Fraction]) -> list[_Term]:
    slope, convex, smooth = told.slope, told.convexity * told.slope, told.smoothness * told.slope
    terms: list[_Term] = []
    for power, weight in multiplier.items():
        terms += [(weight, power, "DD"), (weight * slope, power, "ND")]
    terms += [(convex, 0, "ND"), (-convex, -1, "ND"), (smooth, 1, "ND"), (-smooth, 0, "ND")]
    return [*terms, (-smooth * slope, 0, "NN"), (smooth * slope, 1, "NN")]  # |z − 1|² = 2 − 2 cos θ


def _inequality(plant: Plant, terms: Sequence[tuple[int, int, str]]) -> list[Enclosed]:
    """The coefficients of cos jθ of the left side times |D|²."""
    lags = {
        "DD": _lags(plant.denominator, plant.denominator),
        "ND": _lags(plant.numerator, plant.denominator),
        "NN": _lags(plant.numerator, plant.numerator),
    }
    highest = max(abs(j + at) for _, at, pair in terms for j in lags[pair])
    sums = [Enclosed(plant.bits, 0)] * (highest + 1)
    for weight, at, pair in terms:
        for j, x in lags[pair].items():
            sums[abs(j + at)] = sums[abs(j + at)] + x.times(weight)
    return sums


def _lags(a: Sequence[Enclosed], b: Sequence[Enclosed]) -> dict[int, Enclosed]:
    """a(z) b(1/z) by powers of z, both descending."""
    longest = max(x.middle.bit_length() for x in (*a, *b))
    spend(60 * len(a) * len(b), longest)
    out: dict[int, Enclosed] = {}
    for i, x in enumerate(a):
        for k, y in enumerate(b):
            power = (len(a) - i) - (len(b) - k)
            out[power] = out[power] + x * y if power in out else x * y
    return out


def _require_positive(sums: Sequence[Enclosed]) -> None:
    """> 0 for every θ, whatever the coefficients are within their bounds: |cos jθ| ≤ 1."""
    total = in_powers([x.middle for x in sums], 1)
    total[0] -= sum(x.reach for x in sums)
    while len(total) > 1 and total[-1] == 0:
        total.pop()
    require_positive([Fraction(c) for c in total])


# A motion that a one-sided wall keeps up for ever: solved again, every sample on its side of the surface.
#
#     x = −G f,    f = K max(x − g, 0),    G = N/D:  Σ Dᵢ x(j+i) + K Σ Nᵢ s(j+i) (x(j+i) − g) = 0,  i = 0 … p
#
# With the pattern s of samples inside, s(j+n) = s(j), p positions W determine all that follow, affinely.
# After n samples they are M W + v; the motion repeats itself where (I − M) W = v.  It is one of the wall if
# then x(j) > g exactly where s(j) = 1.  A pattern with samples on both sides is not at rest.


MOST_POSITIONS = 60
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
    if order > MOST_POSITIONS or order**2 * len(told.inside) > MOST_EFFORT:
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
