"""Arithmetic with error bounds, whose last digit no document shows: what comes out encloses all that went in.

Each case is a check of its own instead of a document; it says what is wrong, or nothing.
"""

from __future__ import annotations

from collections.abc import Callable, Iterator
from importlib import import_module
from itertools import product
from math import ceil, floor, isqrt
from random import Random
from typing import Any

from . import Case, Fraction

ROUNDS = 40


def ranges(random: Random, low: int, high: int) -> Iterator[tuple[int, int]]:
    """Ranges between two numbers, some of one number, and their ends with few digits or many."""
    for _ in range(ROUNDS):
        ends = sorted(random.randrange(low, high) for _ in range(2))
        yield (ends[0], ends[0]) if random.random() < 0.3 else (ends[0], ends[1])


def ranges_are_rounded_outward() -> str:
    """Products, squares, inverses, roots and differences, against whole numbers of 2⁻⁸⁰ without rounding."""
    exact = import_module("zwidth.checker.exact.enclosure")
    one, random = 1 << 80, Random(1)
    both = list(ranges(random, -(10**25), 10**25))
    positive = list(ranges(random, 10**20, 10**26))
    for a, b in product(both, both[:9]):
        products = [Fraction(x * y, one) for x, y in product(a, b)]
        if exact.times(a, b) != (floor(min(products)), ceil(max(products))):
            return f"{a} times {b}"
        if exact.minus(a, b) != (a[0] - b[1], a[1] - b[0]) or exact.plus(a, b) != (a[0] + b[0], a[1] + b[1]):
            return f"{a} and {b}"
    for a in both:
        squares = [Fraction(x * x, one) for x in (*a, *([0] if a[0] <= 0 <= a[1] else []))]
        if exact.square(a) != (floor(min(squares)), ceil(max(squares))):
            return f"{a} squared"
    for low, high in positive:
        if exact.inverse((low, high)) != (floor(Fraction(one * one, high)), ceil(Fraction(one * one, low))):
            return f"1 over {low, high}"
        if exact.root((low, high)) != (isqrt(low * one), isqrt(high * one) + 1):
            return f"the root of {low, high}"
    for refused in ((0, 5), (-3, 5)):
        for function in (exact.inverse, exact.root):
            if not _refuses(function, refused, exact.NotPositive):
                return f"{function.__name__} of {refused}"
    if exact.inverse((1, 1)) != (one * one, one * one) or exact.root((1, 1)) != (isqrt(one), isqrt(one) + 1):
        return "the smallest number"
    return ""


def _refuses(function: Callable[[Any], Any], value: Any, error: type[Exception]) -> bool:
    try:
        function(value)
    except error:
        return True
    return False


def numbers_keep_what_they_share() -> str:
    """Sums, differences, products, shifts and quotients at every corner of what varies, radius and slopes."""
    module = import_module("zwidth.checker.exact.enclosed")
    random, bits = Random(2), 20

    def some() -> Any:
        slopes = tuple(random.randrange(-999, 999) for _ in range(2)) if random.random() < 0.7 else ()
        return module.Enclosed(bits, random.randrange(-(10**7), 10**7), slopes, random.randrange(0, 999))

    for _ in range(ROUNDS):
        a, b = some(), some()
        whole = random.choice((-3, 2, 5))
        for name, found, expected in (
            ("+", a + b, lambda x, y: x + y),
            ("−", a - b, lambda x, y: x - y),
            ("×", a * b, lambda x, y: x * y),
            ("times", a.times(whole), lambda x, _, w=whole: x * w),
            ("over", a.over(7), lambda x, _: x / 7),
            ("up", a.shifted(3), lambda x, _: x * 8),
            ("down", a.shifted(-3), lambda x, _: x / 8),
            ("wider", a.widened(Fraction(1, 10**6)), lambda x, _: x),
            ("finer", a.in_bits(30), lambda x, _: x),
            ("coarser", a.in_bits(9), lambda x, _: x),
        ):
            wrong = _not_enclosed(found, a, b, expected)
            if wrong:
                return f"{name}: {wrong}"
    return ""


def _not_enclosed(found: Any, a: Any, b: Any, expected: Callable[[Fraction, Fraction], Fraction]) -> str:
    """Where the result does not reach, or reaches farther than two units and what is of second order."""
    farthest = Fraction(0)
    for first, second, *shared in product((-1, 1), repeat=4):
        value = expected(_at(a, shared, first), _at(b, shared, second))
        farthest = max(farthest, abs(value - _at(found, shared, 0)))
    radius, unit = Fraction(found.radius, 1 << found.bits), Fraction(1, 1 << found.bits)
    second_order = Fraction(2 * a.reach * b.reach, 1 << 2 * a.bits)
    if farthest > radius:
        return f"{float(farthest)} off, {float(radius)} said"
    return "wider than it need be" if radius > farthest + second_order + 5 * unit else ""


def _at(x: Any, shared: list[int], rest: int) -> Fraction:
    slopes = sum(s * e for s, e in zip(x.slopes, shared, strict=False))
    return Fraction(x.middle + slopes + rest * x.radius, 1 << x.bits)


def signs_are_certain() -> str:
    """Of a number that reaches 0, that does not, and of 0."""
    enclosed = import_module("zwidth.checker.exact.enclosed").Enclosed
    for middle, slopes, radius, sign in (
        (3, (1, -1), 0, 1), (-3, (1, -1), 0, -1), (3, (1, -1), 1, None), (-3, (1, 1), 1, None),
        (0, (), 0, 0), (0, (), 1, None),
        (1, (), 0, 1), (-1, (), 0, -1), (1, (1,), 0, None), (0, (0, 1), 0, None),
    ):  # fmt: skip
        if enclosed(8, middle, slopes, radius).sign != sign:
            return f"the sign of {middle} ± {slopes} ± {radius}"
    return ""


def rational_numbers_are_enclosed() -> str:
    """Quotients that come out and that do not, and both ends of an interval."""
    module = import_module("zwidth.checker.exact.enclosed")
    for value in (Fraction(3, 8), Fraction(1, 3), Fraction(-1, 3), Fraction(-5, 7)):
        found = module.known(value, 9)
        off = abs(value - Fraction(found.middle, 512))
        if off > Fraction(found.radius, 512) or found.radius != (0 if value.denominator == 8 else 1):
            return f"{value}"
    for low, high in (
        (Fraction(1, 3), Fraction(5, 7)),
        (Fraction(1, 2), Fraction(3, 4)),
        (Fraction(1, 3), Fraction(1, 3)),
    ):
        for place in range(3):
            found = module.between(low, high, place, 3, 16)
            if len(found.slopes) != (3 if high > low else 0) or any(
                s for i, s in enumerate(found.slopes) if i != place
            ):
                return f"{low} … {high} at {place}"
            for end, sign in ((low, -1), (high, 1)):
                off = abs(end - _at(found, [sign] * 3, 0)) * (1 << 16)
                if not off <= found.radius <= off + 3:
                    return f"{low} … {high}: {end}"
    return ""


CHECKS = (
    ranges_are_rounded_outward,
    numbers_keep_what_they_share,
    signs_are_certain,
    rational_numbers_are_enclosed,
)

CASES = [Case(check.__name__.replace("_", " "), check, "") for check in CHECKS]
