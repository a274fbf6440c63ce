"""Two arms that no two hands take energy out of: the form of the work in both speeds is nowhere negative.

With Δx = (z − 1) x, gᵢᵢ = bᵢ (1 − ζ) + T ζ Aᵢ and gᵢⱼ = T ζ Cᵢ for forces fᵢ = Aᵢ xᵢ + Cᵢ xⱼ, delays and all,
the work of a motion is the integral over the unit circle of Δxᴴ M Δx/T,

    |1 − ζ|² M = Herm(G (1 − ζ̄)) − |1 − ζ|² Σᵢ T² αᵢ (1 − αᵢ)/(4 bᵢ) hᵢᴴ hᵢ,

where the last term is what a hand wins inside samples whose force changes at αᵢ T, hᵢ being row i without
that delay.  With both Kᵢ in the ratio of the weights the pole at ζ = 1 has the residue of a spring, which is
not negative.  So M ⪰ 0 at every θ is enough, and necessary; that is M_ll ≥ 0, M_ff ≥ 0 and det M ≥ 0,
polynomials in c = cos θ (docs/theory/pairs.md).

With m readings of its own in a sample an arm loses the least, for given moves in whole samples, if

    Mᵢᵢ = m (β + γ) (t − g c)/(m (t − g c) + γ u (1 − c)),    β = b − K T/2m ≥ |γ|,  γ = B + D,

t = γᵐ T_m(β/γ), u = γᵐ⁻¹ U_{m−1}(β/γ), g = (−γ)ᵐ; where β < |γ| it gains inside a sample, by itself.

Compensation of friction under a line h + s v (`coupling`) takes h of Coulomb friction, s/2 of damping and
C + s/2 of local damping.  Beside the square of a large round F is as nothing: what is negative with s = 0 is
a violation.
"""

from __future__ import annotations

from collections.abc import Iterable, Iterator, Mapping, Sequence
from fractions import Fraction
from typing import NamedTuple

from ..document.fields import Number, Read, Record, document
from ..document.number import DAMPING, about, common_scale
from ..document.refusal import Invalid, only_if, spend
from ..exact.polynomial import add, bits, in_powers, multiply, value
from ..exact.positivity import POSITIVITY, require_nonnegative
from .coupling import NO_LINE, PAIR, TANGENTS, Line, Side, line_of, sides_of

# Polynomials in ζ = e^{−jθ} and in its conjugate, by powers of ζ.

Laurent = dict[int, Fraction]


def from_ascending(a: Iterable[Fraction], late: int = 0) -> Laurent:
    """ζ^late times a polynomial."""
    return {k + late: c for k, c in enumerate(a) if c}


def conjugate(a: Laurent) -> Laurent:
    """On the unit circle."""
    return {-k: c for k, c in a.items()}


def times(a: Laurent, b: Laurent) -> Laurent:
    """The product."""
    found: Laurent = {}
    for i, x in a.items():
        for j, y in b.items():
            found[i + j] = found.get(i + j, Fraction(0)) + x * y
    return found


def weighted(*parts: tuple[Fraction | int, Laurent]) -> Laurent:
    """A sum, each with its factor."""
    found: Laurent = {}
    for factor, a in parts:
        for k, c in a.items():
            found[k] = found.get(k, Fraction(0)) + factor * c
    return found


def in_cosine(a: Mapping[int, int]) -> list[int]:
    """The real part, ascending in c = cos θ."""
    degree = max(map(abs, a), default=0)
    sums = [a.get(0, 0), *(a.get(k, 0) + a.get(-k, 0) for k in range(1, degree + 1))]
    spend(degree**2, bits(sums) + degree)
    return in_powers(sums, 1)


def square_in_cosine(a: Mapping[int, int]) -> list[int]:
    """|a|², ascending in c."""
    size = max(a, default=0) - min(a, default=0) + 1
    longest = bits(list(a.values()))
    spend(size**2, longest, longest)
    row: Sequence[int] = [a.get(k + min(a, default=0), 0) for k in range(size)]
    lags = [sum(row[i] * row[i + j] for i in range(size - j)) for j in range(size)]
    return in_powers([lags[0], *(2 * lag for lag in lags[1:])], 1)


LOSS = Record({"damping": Number(DAMPING), "local_damping": Number(DAMPING)})
LOSSES = Record({"leader": LOSS, "follower": LOSS}, default=None)
"""β' and γ' in the place of β and γ, β' + γ' cos φ ≤ β + γ cos φ at every φ: of fewer digits, for powers."""
PAIR_PROOF = document(
    {
        "loop": PAIR,
        "proof": Record(
            {
                "leader": POSITIVITY,
                "follower": POSITIVITY,
                "both": POSITIVITY,
                "tangents": TANGENTS,
                "losses": LOSSES,
            },
            shown=False,
        ),
    }
)
PAIR_VIOLATION = document(
    {"loop": PAIR, "proof": Record({"cosine": Number(least=-1, below=1)}, default=None, shown=False)}
)
_STEP = from_ascending([Fraction(1), Fraction(-1)])
_SQUARE = times(_STEP, conjugate(_STEP))
_MOST_BITS = 100_000


class Criterion(NamedTuple):
    """What must not be negative for c in [−1, 1], ascending in c: times 2 − 2c, the last (2 − 2c)²."""

    leader: list[int]
    follower: list[int]
    both: list[int]


def pair(told: Read) -> str:
    """Friction and encoders too."""
    sides = sides_of(told.loop)
    lines = _lines(told, sides)
    if told.proof.losses is not None and told.loop.own_readings == 1:
        raise Invalid("proof.losses are of a drive that reads its arm more often, and there is none")
    found = criterion(told.loop, sides, lines, told.proof.losses)
    if found is None:
        raise Invalid("an arm gains by itself inside a sample")
    for name in Criterion._fields:
        require_nonnegative([Fraction(c) for c in getattr(found, name)], getattr(told.proof, name))
    for side, line, error in zip(sides, lines, _errors(told.loop, sides, lines), strict=True):
        if side.coulomb_friction < error + line.height:
            less = f" and {about(line.height)} of compensation" if side.law is not None else ""
            raise Invalid(
                f"Coulomb friction of {about(side.coulomb_friction)} is below the force error of both "
                f"encoders, {about(error)}{less}"
            )
    counted = any(side.resolution for side in sides)
    more = ", and Coulomb friction covers the steps of both encoders" if counted else ""
    if not any(_beyond_springs(side, line) for side, line in zip(sides, lines, strict=True)):
        more += "; younger readings, another in each sample, change nothing"
    return f"the work of both hands is nowhere negative{more}"


def _beyond_springs(side: Side, line: Line) -> bool:
    """True where a younger reading may be worse: damping, a change inside a sample, friction compensated."""
    past = (side.own[1], side.other[1], side.echo[1], line.moving, side.part)
    return any(past)


def _lines(told: Read, sides: tuple[Side, Side]) -> tuple[Line, Line]:
    """The tangent of each compensation."""
    given = told.proof.tangents
    only_if(any(side.law is not None for side in sides), given, "proof.tangents")
    leader, follower = sides
    if given is None:
        return NO_LINE, NO_LINE
    return (
        line_of(leader.law, given.leader, given.speed),
        line_of(follower.law, given.follower, given.speed),
    )


def pair_violation(told: Read) -> str:
    """A frequency at which some motion of both hands takes energy out, or without one a drive that does."""
    sides = sides_of(told.loop)
    lines = [line_of(side.law, Fraction(1)) for side in sides]
    found = criterion(told.loop, sides, lines)
    if found is None and any(line.moving for line in lines):
        raise Invalid(
            "an arm gains by itself inside a sample, unless compensation of its viscous friction brakes"
        )
    proof = only_if(found is not None, told.proof, "proof")
    if found is None:
        return "an arm gains by itself inside a sample"
    c = proof.cosine
    spend(sum(map(len, found)), bits(found.both), 2 * c.denominator.bit_length() * len(found.both))
    if all(value([Fraction(x) for x in part], c) >= 0 for part in found):
        raise Invalid("the work of both hands is not negative at this frequency")
    return "at one frequency a motion of both hands takes energy out in every round"


def _errors(told: Read, sides: Sequence[Side], lines: Sequence[Line]) -> Iterator[Fraction]:
    """The largest error of each force: half a count of each reading, all at their worst."""
    period = told.sample_period
    spent = [_spent(side, line, period) for side, line in zip(sides, lines, strict=True)]
    for side, other, line in zip(spent, spent[::-1], lines, strict=True):
        taps = readings(side)[0].values() if side.often == 1 else (*side.own, *side.echo)
        mine, its = sum(map(abs, taps)), sum(map(abs, side.other))
        unsure = (line.still if side.often == 1 else line.still + line.moving) / period
        yield (mine * side.resolution + its * other.resolution) / 2 + unsure * side.resolution


def _spent(side: Side, line: Line, period: Fraction) -> Side:
    """With less damping and local damping, which are both as quick as the rest; a drive's are quicker."""
    if side.law is None or side.often > 1:
        return side
    less = line.moving / period
    newest, last = side.own
    return side._replace(damping=side.damping - line.still, own=[newest - less, last + less])


def criterion(
    told: Read, arms: Sequence[Side], lines: Sequence[Line] = (NO_LINE, NO_LINE), losses: Read | None = None
) -> Criterion | None:
    """The diagonal of the form, and its determinant; None where the drive of an arm alone lets it gain."""
    period = told.sample_period
    sides = [_spent(side, line, period) for side, line in zip(arms, lines, strict=True)]
    for side in sides:
        if side.part and side.damping <= 0:
            raise Invalid("without damping a force that changes inside a sample gives energy for free")
    rows = [_row(side, period) for side in sides]
    lost = [_inside(side, period) for side in sides]
    own = [weighted((1, times(rows[i][0], conjugate(_STEP)))) for i in (0, 1)]
    crossed = weighted(
        (Fraction(1, 2), times(rows[0][1], conjugate(_STEP))),
        (Fraction(1, 2), times(conjugate(rows[1][1]), _STEP)),
    )
    for i, (loss, mine, its) in enumerate(lost):
        if not loss:
            continue
        own[i] = weighted((1, own[i]), (-loss, times(_SQUARE, times(mine, conjugate(mine)))))
        own[1 - i] = weighted((1, own[1 - i]), (-loss, times(_SQUARE, times(its, conjugate(its)))))
        mixed = times(conjugate(mine), its) if i == 0 else times(conjugate(its), mine)
        crossed = weighted((1, crossed), (-loss, times(_SQUARE, mixed)))
    if told.own_readings > 1:
        return _driven(told, sides, lines, crossed, losses)
    forms = (*own, crossed)
    scale = common_scale([c for form in forms for c in form.values()], _MOST_BITS)
    leader, follower, cross = ({k: int(c * scale) for k, c in form.items()} for form in forms)
    diagonal = in_cosine(leader), in_cosine(follower)
    spend(len(diagonal[0]) * len(diagonal[1]), bits(diagonal[0]), bits(diagonal[1]))
    return Criterion(*diagonal, add(multiply(*diagonal), [-c for c in square_in_cosine(cross)]))


class _Loss(NamedTuple):
    """What an arm loses at least in a sample, top over bottom, both positive; ascending in c."""

    top: list[Fraction]
    bottom: list[Fraction]


def _driven(
    told: Read, sides: Sequence[Side], lines: Sequence[Line], crossed: Laurent, losses: Read | None
) -> Criterion | None:
    """The same with what each arm loses at least, times both bottoms."""
    lost = []
    for name, side, line in zip(("leader", "follower"), sides, lines, strict=True):
        less = None if losses is None else getattr(losses, name)
        own = _least_loss(side, getattr(told, name).stiffness, told.sample_period, less)
        if own is None:
            return None
        lost.append(_helped(own, side, line))
    tops, bottoms = zip(*lost, strict=True)
    backs = [_back(side, told.sample_period) for side in sides]
    coefficients = [c for form in (crossed, *backs) for c in form.values()]
    scale = common_scale([*coefficients, *(c for line in (*tops, *bottoms) for c in line)], _MOST_BITS)
    first_top, second_top = ([int(c * scale) for c in top] for top in tops)
    first_bottom, second_bottom = ([int(c * scale) for c in bottom] for bottom in bottoms)
    first_back, second_back, cross = (
        {k: int(c * scale) for k, c in form.items()} for form in (*backs, crossed)
    )
    square = square_in_cosine(cross)
    first = _with_back(first_top, first_bottom, first_back, scale)
    second = _with_back(second_top, second_bottom, second_back, scale)
    spend(9 * len(square), bits(square) + 2 * bits(first_bottom), bits(first_bottom))
    product = multiply(first, second)
    both = add(product, [-c for c in multiply(square, multiply(first_bottom, second_bottom))])
    return Criterion(first, second, both)


def _least_loss(side: Side, stiffness: Fraction, period: Fraction, less: Read | None) -> _Loss | None:
    """Of one reading in a sample β + γ c, of several as above; None where the arm gains by itself."""
    often = side.often
    beta = side.weight * (side.damping - stiffness * period / (2 * often))
    gamma = -side.weight * side.own[1] * period / often
    if less is not None:
        if beta - less.damping < abs(gamma - less.local_damping):
            raise Invalid("a move inside a sample loses less than the proof counts")
        beta, gamma = less.damping, less.local_damping
    if often == 1:
        return _Loss([beta, gamma], [Fraction(1), Fraction(0)])
    if beta < abs(gamma):
        return None
    if beta == -gamma:
        raise Invalid("the drive of an arm is at the very edge of gaining by itself")
    size = bits([beta.numerator, beta.denominator, gamma.numerator, gamma.denominator])
    spend(20 * often, often * size, size)
    t, t_next, u, u_next = Fraction(1), beta, Fraction(0), Fraction(1)
    for _ in range(often):
        t, t_next = t_next, 2 * beta * t_next - gamma**2 * t
        u, u_next = u_next, 2 * beta * u_next - gamma**2 * u
    g = (-gamma) ** often
    level, slope = often * t, -often * g
    top = [(beta + gamma) * level, (beta + gamma) * slope]
    return _Loss(top, [level + gamma * u, slope - gamma * u])


def _helped(lost: _Loss, side: Side, line: Line) -> _Loss:
    """What is left once compensation, computed once in T, has taken its part of top/bottom.

    Of an arm that reads itself once a sample it was taken before, with its damping.
    """
    if side.law is None or side.often == 1:
        return lost
    still, moving = side.weight * line.still, side.weight * line.moving
    (a, b), (p, q) = lost
    return lost._replace(top=[a - still * p, b - still * q - moving * p, -moving * q])


def _back(side: Side, period: Fraction) -> Laurent:
    """What the readings that come back add to the form, once a sample, times |1 − ζ|²."""
    echo = from_ascending(side.echo, side.echo_age + 1)
    return weighted((side.weight * period, times(echo, conjugate(_STEP))))


def _with_back(top: list[int], bottom: list[int], back: dict[int, int], scale: int) -> list[int]:
    """Top times 2 − 2c, and what comes back over the same bottom; both times `scale`."""
    found = [scale * c for c in multiply(top, [2, -2])]
    spend(len(back) * len(bottom), scale.bit_length(), bits(bottom))
    return add(found, multiply(in_cosine(back), bottom))


def _row(side: Side, period: Fraction) -> tuple[Laurent, Laurent]:
    """gᵢᵢ and gᵢⱼ."""
    mixed = from_ascending([1 - side.part, side.part], side.whole + 1)
    own, other = readings(side)
    rubbed = weighted((side.weight * side.damping, _STEP))
    gain = side.weight * period
    return weighted((1, rubbed), (gain, times(mixed, own))), weighted((gain, times(mixed, other)))


def _inside(side: Side, period: Fraction) -> tuple[Fraction, Laurent, Laurent]:
    """T² α (1 − α)/(4 b), and the row hᵢ."""
    if not side.part:
        return Fraction(0), {}, {}
    loss = side.weight * period**2 * side.part * (1 - side.part) / (4 * side.damping)
    return loss, *readings(side)


def readings(side: Side) -> tuple[Laurent, Laurent]:
    """The row of all its own readings, and of the other's."""
    own, echo = from_ascending(side.own), from_ascending(side.echo, side.echo_age)
    return weighted((1, own), (1, echo)), from_ascending(side.other, side.age)
