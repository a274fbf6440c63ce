"""Where the verdict on a law may change as one of its parameters grows.

N and D of H are polynomials in a parameter m > 0, and so is the criterion q(c, m).  Between two
neighbouring roots of

    disc_c q,   q(±1, m),   res(N, D),   N(ζ = 1, m),   D(ζ = 1, m)

(of q without its squares, of N and D without what they have in common for all m) the verdict is one.
No root of q in [−1, 1] appears there, is lost, or leaves at ±1: q ≥ 0 holds throughout or nowhere.  Where
it holds, no pole comes to the unit circle, for there q would be crossed, unless N vanishes with D;
and the sign of H(1) changes with N or D at ζ = 1 alone.  The proof is in the documentation.
"""

from __future__ import annotations

from collections.abc import Callable, Iterator, Sequence
from fractions import Fraction
from math import lcm

from flint import Ordering, fmpq_poly, fmpz_mpoly, fmpz_mpoly_ctx, fmpz_poly

from zwidth.errors import InputError
from zwidth.model.environment.environment import RationalFunction
from zwidth.passivity.linear.exact_algebra import interpolated, roots_inside
from zwidth.passivity.linear.loop import LinearLoop
from zwidth.quantity.balls import as_fmpq

Law = Callable[[Fraction], RationalFunction]
"""H(z) at a value of the parameter; N and D are polynomials in it."""

_RING = fmpz_mpoly_ctx.get(("c", "m"), Ordering.lex)
MOST_WORK = 300_000_000
"""The fifth power of the degree in c, times the square of that in m: some seconds."""

_CIRCLE = ({"c": 1}, {"c": -1})


def critical_values(law: Law, degree: int, loop: LinearLoop, scale: Fraction) -> list[Fraction]:
    """The values m > 0, ascending and to rounding, between which the verdict is one.

    `law`: H(z) as a function of m; `degree`: the highest power of m in N and D, or a higher one; `loop`: on
    the same device: its b, T and delay are taken; `scale`: a value of the size that is looked for.
    """
    numbers = [Fraction(i) for i in range(1, 2 * degree + 2)]
    loops = _on_one_scale([law(scale * number) for number in numbers], loop)
    criterion = _interpolated([_criterion(one) for one in loops], numbers)
    sides = [
        _interpolated([fmpq_poly(list(side)) for side in found], numbers)
        for found in zip(*((one.numerator, one.denominator) for one in loops), strict=True)
    ]
    found = {root for p in (*_of_criterion(criterion), *_of_law(*sides)) for root in _positive_roots(p)}
    return [scale * root for root in sorted(found)]


def _on_one_scale(laws: Sequence[RationalFunction], loop: LinearLoop) -> list[LinearLoop]:
    """N and D of all as integers, by one factor, ascending in ζ; nothing is cancelled."""
    whole = lcm(*(c.denominator for h in laws for side in h for c in side))
    sizes = [len(h.denominator) for h in laws]
    assert len(set(sizes)) == 1, "one order for all values"
    return [
        LinearLoop(
            (*[0] * (sizes[0] - len(h.numerator)), *(int(c * whole) for c in h.numerator)),
            tuple(int(c * whole) for c in h.denominator),
            loop.damping,
            loop.period,
            loop.whole_delay,
            loop.part_delay,
        )
        for h in laws
    ]


def _criterion(loop: LinearLoop) -> fmpq_poly:
    """q(c), times b where the delay has a part of a sample, not scaled."""
    b, t, alpha = loop.damping, loop.period, loop.part_delay
    if alpha == 0:
        return as_fmpq(2 * b / t) * loop.dissipation + loop.hold
    damped = as_fmpq(2 * b * b / t) * loop.dissipation + as_fmpq(b) * loop.hold
    return damped - as_fmpq(t * alpha * (1 - alpha) / 2) * loop.switching


def _interpolated(values: Sequence[fmpq_poly], at: Sequence[Fraction]) -> fmpz_mpoly:
    """The polynomial in c and m of these polynomials in c, times a positive integer."""
    rows = interpolated(values, [as_fmpq(m) for m in at])
    whole = lcm(1, *(int(row.denom()) for row in rows))
    return _RING.from_dict(
        {(j, i): int(c * whole) for i, row in enumerate(rows) for j, c in enumerate(row.coeffs()) if c}
    )


def _of_criterion(q: fmpz_mpoly) -> Iterator[fmpz_poly]:
    """What vanishes where a root of q comes, goes, or passes an end of [−1, 1]."""
    for factor, times in q.factor_squarefree()[1]:
        if times % 2 == 0:
            continue
        if factor.degrees()[0] < 1:
            yield _in_m(factor)
            continue
        for end in _CIRCLE:
            yield _in_m(factor.subs(end))
        n, powers = factor.degrees()
        if n**5 * powers**2 > MOST_WORK:
            raise InputError(
                f"the criterion is of degree {n} in cos ωT and {powers} in the parameter, and where its sign "
                "changes would take minutes to find: give a shorter delay, or check single values"
            )
        if n > 1:
            yield _in_m(factor.discriminant("c"))


def _of_law(n: fmpz_mpoly, d: fmpz_mpoly) -> Iterator[fmpz_poly]:
    """What vanishes where N and D have a root in common, or H(1) its zero or pole."""
    common = n.gcd(d)
    n, d = n // common, d // common
    if n.degrees()[0] > 0 and d.degrees()[0] > 0:
        yield _in_m(n.resultant(d, "c"))
    for side in (n, d):
        yield _in_m(side.subs({"c": 1}))


def _in_m(p: fmpz_mpoly) -> fmpz_poly:
    """What has no c, as a polynomial of one variable."""
    powers = {monomial[1]: int(c) for monomial, c in p.to_dict().items()}
    return fmpz_poly([powers.get(i, 0) for i in range(max(powers, default=-1) + 1)])


def _positive_roots(p: fmpz_poly) -> Iterator[Fraction]:
    """The roots m > 0, by m = (1 + t)/(1 − t)."""
    degree = p.degree()
    up, down = fmpz_poly([1, 1]), fmpz_poly([1, -1])
    moved = sum((c * up**i * down ** (degree - i) for i, c in enumerate(p.coeffs())), fmpz_poly())
    for t in roots_inside(moved):
        if -1 < t < 1:
            yield (1 + t) / (1 - t)
