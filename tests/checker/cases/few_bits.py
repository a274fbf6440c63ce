"""Arithmetic of the checker in so few bits that a unit of the last digit shows, beside exact fractions.

Quick checks, each of one function; `arithmetic.py` asks the same of many bits.
"""

from __future__ import annotations

from collections.abc import Iterator
from contextlib import contextmanager
from fractions import Fraction
from importlib import import_module
from itertools import product
from math import cos, sin
from random import Random
from types import SimpleNamespace
from typing import Any

from . import Case
from .arithmetic import at, expanded, in_zeta, module, refuses


def number(bits: int, middle: int, slopes: tuple[int, ...] = (), radius: int = 0) -> Any:
    return module("exact.enclosed").Enclosed(bits, middle, slopes, radius)


def refusal() -> type[Exception]:
    found: type[Exception] = import_module("zwidth.checker.document.refusal").Invalid
    return found


@contextmanager
def limited(where: Any, **limits: Any) -> Iterator[None]:
    """A module with other limits for a while."""
    before = {name: getattr(where, name) for name in limits}
    vars(where).update(limits)
    try:
        yield
    finally:
        vars(where).update(before)


def some(random: Random, bits: int = 3, certain: float = 0.3) -> Any:
    """A small number on either side of 0."""
    slopes = (random.randrange(-9, 10), random.randrange(-9, 10)) if random.random() > certain else ()
    return number(bits, random.randrange(-40, 41), slopes, random.choice((0, 0, 1, 3)))


def what_two_numbers_make() -> str:
    """Sums and differences without any loss; products, alone and summed, within what is said."""
    random, dot, ends = Random(1), module("exact.enclosed").dot, tuple(product((-1, 1), repeat=4))
    for _ in range(25):
        a, b, c, d = (some(random) for _ in range(4))
        if random.random() < 0.4:
            a, c = number(3, a.middle), number(3, c.middle)  # then all that is lost is lost to rounding
        values = [(s, [at(x, s, r) for x, r in zip((a, b, c, d), (p, q, p, -q), strict=True)])
                  for p, q, *s in ends]  # fmt: skip
        for name, found, right in (
            ("+", a + b, [w + x for _, (w, x, _, _) in values]),
            ("−", a - b, [w - x for _, (w, x, _, _) in values]),
            ("×", a * b, [w * x for _, (w, x, _, _) in values]),
            ("× and ×", dot((a, c), (b, d)), [w * x + y * z for _, (w, x, y, z) in values]),
        ):
            away = 8 * max(abs(v - at(found, s, 0)) for v, (s, _) in zip(right, values, strict=True))
            if away > found.radius or (away < found.radius and name in "+−"):
                return f"{name}: {away} off, {found.radius} said"
    return "" if number(3, 5, (), 2).widened(Fraction(1, 3)).radius == 2 + 3 else "wider by a third"


def an_interval_about_zero_keeps_its_ends() -> str:
    """Its middle comes out, half of it does not."""
    found = module("exact.enclosed").between(Fraction(-1, 3), Fraction(1, 3), 0, 1, 4)
    return "" if (found.middle, found.slopes, found.radius) == (0, (5,), 1) else "−1/3 … 1/3"


def roots_and_inverses_reach_their_ends() -> str:
    """Of small numbers and large ones, in few bits and in many."""
    functions, random = module("exact.enclosed"), Random(2)
    told = [number(7, 984, (171,))]  # where nearly every rounding goes to one side
    for bits, _ in product((1, 5, 40), range(16)):
        m = random.randrange(3, 300) if bits < 9 else random.randrange(1 << bits, 4 << bits)
        most = m // random.choice((3, 5, 20)) if bits < 9 else 50
        slopes = (random.randrange(-most, most + 1),) if random.random() < 0.3 else ()
        told.append(number(bits, m, slopes, random.randrange(most + 1)))
    for x in told:
        if x.reach >= x.middle:
            continue
        root, over, under = functions.root(x), functions.inverse(x), functions.inverse(-x)
        for shared, rest in product((-1, 0, 1), repeat=2):
            value = at(x, (shared,), rest)
            low, high = _ends(root, shared)
            if not max(low, Fraction(0)) ** 2 <= value <= high**2:
                return f"the root of {x.middle} ± {x.slopes} ± {x.radius}, {x.bits} bits"
            for sign, found in ((1, over), (-1, under)):
                low, high = _ends(found, shared)
                if not low <= sign / value <= high:
                    return f"the inverse of {sign * x.middle} ± {x.slopes} ± {x.radius}, {x.bits} bits"
    return ""


def _ends(x: Any, shared: int) -> tuple[Fraction, Fraction]:
    """Where a number lies at one end of what varies."""
    here, room = at(x, (shared,), 0), Fraction(x.radius, 1 << x.bits)
    return here - room, here + room


def sines_reach_their_ends() -> str:
    """Of angles near 0, near a right one and below 0, off by little and by much; not much wider."""
    one = 1 << 20
    for middle, reach in product((-70, -50, 0, 100, 200), (0, one // 32, 2 * one)):
        for slopes, radius in (((), reach), ((reach, -reach // 2), reach // 3)):
            x = number(20, middle * one // 64, slopes, radius)
            for function, rate, found in zip(
                (sin, cos), (cos, sin), module("exact.enclosed").sine_cosine(x), strict=True
            ):
                places = [(at(x, s, r), at(found, s, 0)) for r, *s in product((-1, 0, 1), repeat=3)]
                most = max(abs(function(v) - here) for v, here in places) * one
                wide = x.reach / one
                bend = min(1, abs(function(middle / 64)) + wide) * wide**2 / 2
                room = one * bend + abs(rate(middle / 64)) * radius + 8 + 5 * wide
                if not most <= found.radius + 1e-3 or found.radius > room:
                    return (
                        f"{function.__name__} of {middle} ± {slopes} ± {radius}: {most}, {found.radius} said"
                    )
    return ""


def polynomials_of_one_coefficient() -> str:
    """A constant is its own value, of any length; of no coefficients nothing is made."""
    circle, one_norm = module("pair.felt"), module("pair.felt").one_norm
    if circle.at([number(3, 5)], Fraction(1, 2)).middle != 5:
        return "a constant on the circle"
    if one_norm([number(0, 3)], [number(0, 1)]) != 3 or one_norm(
        [number(8, 3)], [number(8, -256)]
    ) != Fraction(3, 256):
        return "a constant filter"
    return "" if module("exact.polynomial").multiply([1, 2], []) == [] else "times nothing"


def what_may_ring_for_ever_has_no_norm() -> str:
    """1/(1 + ζ ε), |ε| ≤ 1; with less there is a bound, and of a divisor that begins below 0, too."""
    one_norm = module("pair.felt").one_norm
    for first, radius in ((8, 8), (8, 9), (-8, 8)):
        told = [number(3, first), number(3, 0, (), radius)]
        if not refuses(lambda bottom: one_norm([number(3, 8)], bottom), told, refusal()):
            return f"{first} ± {radius}"
    for sign in (1, -1):
        found = one_norm([number(20, 1 << 20)], [number(20, sign << 20), number(20, -sign << 19)])
        if not 2 <= found <= Fraction(2001, 1000):
            return f"{sign}/(1 − ζ/2): {float(found)}"
    half = number(20, 1 << 19)
    found = one_norm([number(20, 1 << 20), half], [number(20, 1 << 20), -half])  # 1 + ζ + ζ²/2 + …
    return "" if 3 <= found <= Fraction(3001, 1000) else f"(1 + ζ/2)/(1 − ζ/2): {float(found)}"


def products_that_are_too_long() -> str:
    """Of too many factors at either end; where there is no square nothing is multiplied."""
    positivity = module("exact.positivity")
    for q, at_one, at_minus_one, square, right in (
        ([1, 1], 0, 1, [1], True), ([1, -1], 1, 0, [1], True), ([1, 0, -1], 1, 1, [1], True),
        ([1, 2], 0, 2, [1], False), ([1, -2], 2, 0, [1], False), ([1, 1], 1, 1, [1], False),
        ([0, 0], 1, 1, [], True), ([1, 0], 1, 1, [], False),
    ):  # fmt: skip
        proof = SimpleNamespace(
            at_one=at_one,
            at_minus_one=at_minus_one,
            square=list(map(Fraction, square)),
            factor=[Fraction(1)],
        )
        if (
            refuses(
                lambda p, q=q: positivity.require_nonnegative(list(map(Fraction, q)), p), proof, refusal()
            )
            is right
        ):
            return f"{q}"
    return ""


def work_that_never_ends_is_left() -> str:
    """(c² − ½)² is never above 0 nor seen to be 0; a root on the circle is open in any number of bits."""
    positivity, roots = module("exact.positivity"), module("exact.roots")
    with limited(positivity, MOST_SPLITS=20):
        square = [Fraction(c) for c in (1, 0, -4, 0, 4)]
        if not refuses(positivity.require_positive, square, refusal()):
            return "the sign of a square"
    with limited(roots, MOST_EXACT=0):
        if not refuses(roots.inside_unit_circle, [Fraction(c) for c in (5, -6, 5)], refusal()):
            return "a root on the circle"
        if not roots.inside_unit_circle([Fraction(c) for c in (5, -6, 4)]):
            return "a root inside it"
    many = [number(64, c << 64) for c in in_zeta([2, *[0] * 29, 1])]
    return "" if module("exact.roots").decays(many) else "many roots inside it"


def half_planes_are_told() -> str:
    """Products of two with known roots, of which one may lie on the axis or to the right."""
    test = module("exact.roots").in_left_half_plane
    good, bad = ([1, 1], [1, 1000], [1, 2, 2], [1000, 1]), ([1, 0], [1, -1], [1, 0, 1], [1, -1, 100])
    for first, second in product(good, (*good, *bad)):
        if test(list(map(Fraction, expanded(first, second)))) is not (second in good):
            return f"{first}, {second}"
    return ""


def hurwitz_has_zeros_that_are_exact() -> str:
    """Beside the coefficients, c₀ … cₙ with 2j − i below or above."""
    crossing, order = module("known_hand.rest"), 4
    told = [number(3, 10 + i, (), 1) for i in range(order + 1)]
    for i, row in enumerate(crossing._hurwitz(told), start=1):
        for j, x in enumerate(row, start=1):
            place = 2 * j - i
            right = (10 + place, 1) if 0 <= place <= order else (0, 0)
            if (x.middle, x.radius) != right:
                return f"{i}, {j}"
    return ""


def matrices_without_an_inverse_show_nothing() -> str:
    """A pair of roots just on the circle; one so near that the inverse is beyond any float."""
    crossing = module("known_hand.rest")
    for told in ([5, -6, 5], expanded([1, 0, 1], [25, -30, 25])):
        if crossing.never_crosses([number(8, c << 8) for c in in_zeta(told)]):
            return f"{told}"
    near = [number(1100, c << 1100) for c in in_zeta([5, -6, 5])]
    near[-1] = near[-1] - number(1100, 1 << 60)
    return "" if not crossing.never_crosses(near) else "a pair next to the circle"


CHECKS = (
    what_two_numbers_make,
    an_interval_about_zero_keeps_its_ends,
    roots_and_inverses_reach_their_ends,
    sines_reach_their_ends,
    polynomials_of_one_coefficient,
    what_may_ring_for_ever_has_no_norm,
    products_that_are_too_long,
    work_that_never_ends_is_left,
    half_planes_are_told,
    hurwitz_has_zeros_that_are_exact,
    matrices_without_an_inverse_show_nothing,
)

CASES = [Case(check.__name__.replace("_", " "), check, "") for check in CHECKS]
