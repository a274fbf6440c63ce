"""Arithmetic with error bounds, whose last digit no document shows: what comes out encloses all that went in.

Each case is a check of its own instead of a document; it says what is wrong, or nothing.
"""

from __future__ import annotations

from collections.abc import Callable, Iterator, Sequence
from fractions import Fraction
from functools import cache
from importlib import import_module
from itertools import combinations_with_replacement, cycle, product
from math import comb, floor, isqrt
from random import Random
from typing import Any

from . import Case

ROUNDS = 40
FINE = 400
"""Bits of what is compared with."""


def module(name: str) -> Any:
    """Of the checker, as it is loaded now."""
    return import_module(f"zwidth.checker.{name}")


def some(random: Random, bits: int, low: int, high: int, part: Fraction) -> Any:
    """A number with its middle between two, that may be off by a part of it, in slopes and radius."""
    middle = random.randrange(low, high)
    reach = int(abs(middle) * part)
    slopes = tuple(random.randrange(-(reach // 3), reach // 3 + 1) for _ in range(2))
    return module("exact.enclosed").Enclosed(
        bits, middle, slopes if random.random() < 0.7 else (), random.randrange(0, reach // 3 + 1)
    )


def corners(x: Any) -> Iterator[tuple[Fraction, list[int]]]:
    """What the number may be where all that varies is at an end or the middle, and those ends."""
    for rest, *shared in product((-1, 0, 1), repeat=3):
        yield at(x, shared, rest), shared


def at(x: Any, shared: Sequence[int], rest: int) -> Fraction:
    """The number where what varies has these values."""
    slopes = sum(s * e for s, e in zip(x.slopes, shared, strict=False))
    return Fraction(x.middle + slopes + rest * x.radius, 1 << x.bits)


def outside(found: Any, x: Any, function: Callable[[Fraction], Fraction], room: int) -> str:
    """Where a function of a number is not enclosed, or within far more than there need be."""
    off = max(abs(function(value) - at(found, shared, 0)) for value, shared in corners(x))
    off *= 1 << found.bits
    if off > found.radius:
        return f"{x.middle} ± {x.slopes} ± {x.radius}: {float(off)} off, {found.radius} said"
    return f"{x.middle} ± {x.slopes} ± {x.radius}: too wide" if found.radius > 2 * off + room else ""


def square_root(x: Fraction) -> Fraction:
    """To `FINE` bits."""
    return Fraction(isqrt((x.numerator << 2 * FINE) // x.denominator), 1 << FINE)


@cache
def sine(x: Fraction, first: int = 1) -> Fraction:
    """sin x, or with 0 cos x, to some 300 bits."""
    angle = (x.numerator << FINE) // x.denominator
    term = total = angle if first else 1 << FINE
    for n in range(first, 400, 2):
        term = -(term * angle * angle >> 2 * FINE) // ((n + 1) * (n + 2))
        total += term
    return Fraction(total, 1 << FINE)


def functions_are_rounded_outward() -> str:
    """Inverses, roots, sines and cosines at every corner of what varies."""
    functions, random = module("exact.enclosed"), Random(1)
    for part in (Fraction(0), Fraction(1, 100), Fraction(1, 9), Fraction(3, 4)):
        for bits in (6, 20, 60):
            for _ in range(ROUNDS):
                x = some(random, bits, 1 << bits - 2, 8 << bits, part)
                wide = 8 if part < Fraction(1, 2) else 1 << 4 * bits
                wrong = outside(functions.root(x), x, square_root, wide)
                below = x if random.random() < 0.5 else -x
                wrong = wrong or outside(functions.inverse(below), below, lambda v: 1 / v, 16 * wide)
                if wrong:
                    return wrong
    return ""


def curvature_is_bounded_closely() -> str:
    """Of numbers that vary by a 64th: what a tangent leaves, and a bound above it by less than a quarter."""
    functions, enclosed = module("exact.enclosed"), module("exact.enclosed").Enclosed
    for middle in (1 << 58, 3 << 58, 5 << 60):
        x = enclosed(60, middle, (middle >> 6,))
        for function, right in ((functions.root, square_root), (functions.inverse, lambda v: 1 / v)):
            found = function(x)
            off = max(abs(right(value) - at(found, shared, 0)) for value, shared in corners(x)) * (1 << 60)
            if not off <= found.radius <= Fraction(5, 4) * off:
                return f"{function.__name__} of {middle}: {float(off)} off, {found.radius} said"
    return ""


def what_has_few_bits_is_rounded_outward() -> str:
    """Roots of a unit or two, and inverses of numbers so far from 1 that their slope is a part of a unit."""
    functions, enclosed = module("exact.enclosed"), module("exact.enclosed").Enclosed
    for bits, middle in product(range(4), (*range(1, 9), 13, 29, 63, 200)):
        for slopes, radius in (
            ((), 0),
            ((1,), 0),
            ((), middle - 1),
            ((middle // 2,), middle // 3),
            ((middle // 4,), 0),
        ):
            x = enclosed(bits, middle, slopes, radius)
            if x.reach >= middle:
                continue
            for y, function, right in (
                (x, functions.root, square_root),
                (x, functions.inverse, lambda v: 1 / v),
                (-x, functions.inverse, lambda v: 1 / v),
            ):
                wrong = outside(function(y), y, right, 1 << 40)
                if wrong:
                    return f"{function.__name__}: {wrong}"
    return ""


def a_slope_is_known_to_a_unit() -> str:
    """Of a number so far from 1 that the slope of its inverse is some hundred units."""
    x = module("exact.enclosed").Enclosed(22, 880539593, (21290496,))
    return outside(module("exact.enclosed").inverse(x), x, lambda v: 1 / v, 1 << 40)


def what_may_be_0_has_no_inverse() -> str:
    """Nor a root; the smallest number that is not 0 has both."""
    functions, enclosed = module("exact.enclosed"), module("exact.enclosed").Enclosed
    for function in (functions.inverse, functions.root):
        known = ((0,), (3, (), 3), (-3, (), 3), (3, (), 5), (3, (2, -1)), (3, (2,), 2))
        for x in (enclosed(8, *numbers) for numbers in known):
            if not refuses(function, x, functions.NotPositive):
                return f"{function.__name__} of {x.middle} ± {x.reach}"
        for x in (enclosed(8, 1), enclosed(8, 4, (2, -1)), enclosed(8, 4, (2,), 1)):
            if refuses(function, x, functions.NotPositive):
                return f"no {function.__name__} of {x.middle} ± {x.reach}"
    if enclosed(8, 5).widened(Fraction(3, 100)).radius != 8:
        return "3/100 more"
    return "" if refuses(functions.root, enclosed(8, -5), functions.NotPositive) else "a root of −5"


def refuses(function: Callable[[Any], Any], value: Any, error: type[Exception]) -> bool:
    """True where that error is raised."""
    try:
        function(value)
    except error:
        return True
    return False


def sines_are_rounded_outward() -> str:
    """Of angles small and of several turns, in few and in many bits."""
    functions, random = module("exact.enclosed"), Random(3)
    for bits, turns in product((6, 20, 60), (0, 1, 7, 40)):
        for reach in (0, 3, 1 << bits - 5, 1 << bits - 1):
            for sign in (-1, 1):
                middle = sign * random.randrange(turns << bits, (turns + 1) << bits)
                slopes = (random.randrange(-reach, reach + 1), reach // 2) if reach else ()
                x = module("exact.enclosed").Enclosed(bits, middle, slopes, reach)
                for first, found in zip((1, 0), functions.sine_cosine(x), strict=True):
                    wrong = _not_curved(found, x, first)
                    if wrong:
                        return f"{('cos', 'sin')[first]} {middle / (1 << bits)}, {bits} bits: {wrong}"
    return ""


def series_are_cut_off_outward() -> str:
    """Of small angles and of some turns, each exact: their sine and cosine lie within what is said."""
    functions, enclosed = module("exact.enclosed"), module("exact.enclosed").Enclosed
    angles = ((8, 0), (8, 1), (8, -70), (12, 4096), (20, 3 << 20), (40, -(5 << 40)), (40, 1 << 43))
    for bits, middle in angles:
        for first in (0, 1):
            x = enclosed(bits, middle)
            found = functions._series(x, first)
            off = abs(sine(at(x, (), 0), first) - at(found, (), 0)) * (1 << bits)
            if off > found.radius:
                return f"{('cos', 'sin')[first]} {middle}/2^{bits}: {float(off)} off, {found.radius} said"
    return ""


def _not_curved(found: Any, x: Any, first: int) -> str:
    """The remainder is bounded by the largest curvature, at most 1, within reach."""
    reach = Fraction(x.reach, 1 << x.bits)
    bend = min(1, abs(sine(Fraction(x.middle, 1 << x.bits), first)) + reach)
    slopes = abs(sine(Fraction(x.middle, 1 << x.bits), 1 - first)) * Fraction(x.radius, 1 << x.bits)
    allowed = (slopes + bend * reach**2 / 2) * (1 << x.bits) + 14 + 4 * reach * 2
    wrong = outside(found, x, lambda v: sine(v, first), 1 << 2 * x.bits)
    return wrong or ("too wide" if found.radius > allowed * Fraction(101, 100) else "")


def series_keep_what_their_angle_is_off() -> str:
    """By some units."""
    functions, x = module("exact.enclosed"), module("exact.enclosed").Enclosed(40, 3 << 40, (), 1000)
    if functions._ends(module("exact.enclosed").Enclosed(8, 5, (), 3)) != (2, 8):
        return "the ends of a number"
    found = [functions._series(x, first) for first in (0, 1)]
    wrong = (outside(f, x, lambda v, first=first: sine(v, first), 1 << 16) for first, f in enumerate(found))
    return next((w for w in wrong if w), "")


def angles_have_few_turns() -> str:
    """64 rad is the largest."""
    functions, enclosed = module("exact.enclosed"), module("exact.enclosed").Enclosed
    refusal = import_module("zwidth.checker.document.refusal").Invalid
    most = 64 << 12
    for x, right in (
        (enclosed(12, most), False), (enclosed(12, -most), False), (enclosed(12, most + 1), True),
        (enclosed(12, most, (), 1), True), (enclosed(12, most - 1, (1,)), False),
        (enclosed(12, -most, (1,)), True),
    ):  # fmt: skip
        if refuses(functions.sine_cosine, x, refusal) is not right:
            return f"{x.middle} ± {x.reach}"
    return ""


def expanded(*factors: Sequence[int]) -> list[int]:
    """A product of polynomials, descending."""
    out = [1]
    for factor in factors:
        longer = [0] * (len(out) + len(factor) - 1)
        for (i, x), (j, y) in product(enumerate(out), enumerate(factor)):
            longer[i + j] += x * y
        out = longer
    return out


INSIDE = ([2, -1], [3, 2], [1, 0], [9, -8], [9, 8], [5, -6, 4], [25, 30, 24], [100, 0, 99], [4, 0, 0, 1])
"""Polynomials in z all of whose roots lie inside the unit circle."""
NOT_INSIDE = (
    [1, -1], [1, 1], [1, -2], [2, 3], [5, -6, 5], [1, 0, 1], [5, 6, 5], [25, -30, 26],
    [1, 0, 0, -1], [99, 0, 100],
)  # fmt: skip
"""With one on the circle or outside."""
LEFT = ([1, 1], [1, 1000], [1, 2, 2], [1, 1, 100], [1000, 1])
NOT_LEFT = ([1, 0], [1, -1], [1, 0, 1], [1, -1, 100], [1, 0, -1])


def _threes(two: Sequence[list[int]], third: Sequence[list[int]]) -> Iterator[tuple[list[int], ...]]:
    """Two of one sort, in any order, and one of another."""
    return ((a, b, c) for (a, b), c in product(combinations_with_replacement(two, 2), third))


def roots_are_told_inside_from_outside() -> str:
    """Products of three polynomials whose roots are known; a root on the edge is not inside."""
    roots = module("exact.roots")
    for test, good, bad in (
        (roots.inside_unit_circle, INSIDE, NOT_INSIDE),
        (roots.in_left_half_plane, LEFT, NOT_LEFT),
    ):
        for (*two, third), sign in zip(_threes(good, (*good, *bad)), cycle((1, -3)), strict=False):
            told = [Fraction(sign * c, 7) for c in expanded(*two, third)]
            if test(told) is not (third in good):
                return f"{test.__name__} of {two}, {third}"
        if test([Fraction(0), *told]) or not test([Fraction(3)]):
            return f"{test.__name__} of one that begins with 0, or is constant"
    return ""


def roots_next_to_the_circle_are_told() -> str:
    """By 2^−5000 inside or outside, which no fixed number of bits tells."""
    near = Fraction(1, 1 << 5000)
    for sign, part in product((1, -1), (Fraction(1), Fraction(-1, 2))):
        for root, right in ((1 - near, True), (1 + near, False), (near - 1, True), (-1 - near, False)):
            if module("exact.roots").inside_unit_circle([sign * part, -sign * part * root]) is not right:
                return f"{sign * part} (z − {float(root)})"
    return ""


def what_is_0_somewhere_is_not_positive() -> str:
    """c² in coefficients of Bernstein is 1, −1, 1, or 3, −1, −1, 3; with a little more it is positive."""
    positivity, refusal = module("exact.positivity"), import_module("zwidth.checker.document.refusal").Invalid
    for told in ([0, 0, 1], [0, 0, 1, 0], [0, 0, 1, 0, 0]):
        if not refuses(positivity.require_positive, list(map(Fraction, told)), refusal):
            return f"{told}"
        if refuses(positivity.require_positive, [Fraction(1, 10**9), *map(Fraction, told[1:])], refusal):
            return f"{told} and more"
    return ""


def whole_numbers_decide_every_root() -> str:
    """The same without rounding, where no number of bits is enough."""
    decays, enclosed = module("exact.roots").decays, module("exact.enclosed").Enclosed
    for chosen in _threes(INSIDE, (*INSIDE, *NOT_INSIDE)):
        whole = in_zeta(expanded(*chosen))
        if decays([enclosed(0, c) for c in whole]) is not (chosen[2] in INSIDE):
            return f"of {chosen}"
    return ""


def in_zeta(descending: Sequence[int]) -> list[int]:
    """A polynomial in z in powers of ζ = z − 1."""
    out: list[int] = []
    for c in descending:
        out = [x + y for x, y in zip([*out, 0], [0, *out], strict=True)]
        out[-1] += c
    return out


def what_is_open_is_not_decided() -> str:
    """A sign that the bounds leave open, of every condition of the recursion; what one refutes is refuted."""
    decays, enclosed = module("exact.roots").decays, module("exact.enclosed").Enclosed
    one = 1 << 20
    for told, answer in (
        ([(one, 0), (one // 2, 0)], True), ([(one, 0), (one // 2, one // 2)], None),
        ([(one, 0), (0, 0)], False),
        ([(one, 0), (0, 1)], None), ([(one, 0), (-1, 0)], False), ([(one, 0), (-2, 1)], False),
        ([(one, 0), (2 * one, 0)], False), ([(one, 0), (2 * one, 1)], None),
        ([(one, 0), (2 * one + 2, 1)], False),
        ([(one, 0), (2 * one - 2, 1)], True), ([(one, 0), (one, 2 * one)], None),
        ([(one, 0), (2 * one, 0), (2 * one, 1)], None), ([(one, 0), (2 * one, 0), (2 * one - 2, 1)], True),
        ([(one, 0), (2 * one, 0), (2 * one + 2, 1)], False), ([(one, 0), (0, 0), (one, 0)], False),
    ):  # fmt: skip
        if decays([enclosed(20, m, (), r) for m, r in told]) is not answer:
            return f"{told}"
    return ""


def coprime_polynomials_are_told() -> str:
    """True only of those without a common root, whatever the size of the coefficients; modulo primes."""
    are_coprime = module("exact.polynomial").are_coprime
    if not all(pow(base, p - 1, p) == 1 for p in module("exact.polynomial")._PRIMES for base in (3, 5, 7)):
        return "modulo what is no prime"
    for shared, a, b in product(INSIDE, INSIDE, NOT_INSIDE):
        n, d = ([10**50 * c for c in expanded(*part)[::-1]] for part in ((shared, a), (shared, b)))
        if are_coprime(n, d) or are_coprime([*n, 0], [*d, 0]) or are_coprime([], d):
            return f"{shared} in both"
    for a, b in product(INSIDE, NOT_INSIDE):
        if not are_coprime([*a[::-1], 0], [*b[::-1], 0]) or not are_coprime(b[::-1], a[::-1]):
            return f"{a}, {b}"
    first = 2**61 - 1
    if are_coprime([first], [first]) is not True or not are_coprime([1, 1], [1, first]):
        return "a highest coefficient that one prime divides"
    every = first * (2**89 - 1) * (2**127 - 1)
    return "a root that every prime takes away" if are_coprime([1, every], [1, every]) else ""


def the_circle_becomes_an_axis() -> str:
    """ζ = 2w/(1 − w), times (1 − w)ⁿ, exactly; a constant has no root."""
    crossing, enclosed, random = module("known_hand.rest"), module("exact.enclosed").Enclosed, Random(6)
    for order in range(5):
        told = [random.randrange(-9, 10) for _ in range(order + 1)]
        found = crossing._bilinear([enclosed(8, c, (), abs(c)) for c in told])
        for w in (Fraction(0), Fraction(1), Fraction(-2, 3), Fraction(5)):
            right = sum(c * (2 * w) ** (order - i) * (1 - w) ** i for i, c in enumerate(told))
            if sum(x.middle * w ** (order - i) for i, x in enumerate(found)) != right:
                return f"{told}"
    return "" if crossing.never_crosses([enclosed(8, 3, (), 1)]) else "a constant"


def what_is_left_of_a_matrix_is_bounded() -> str:
    """|I − C H R| for any C and R, rounded up once."""
    crossing, enclosed, random, bits = (
        module("known_hand.rest"),
        module("exact.enclosed").Enclosed,
        Random(8),
        6,
    )
    for size, part, _ in product((1, 2, 3), (1, 16), range(10)):
        h = [
            [enclosed(bits, random.randrange(-200, 200), (), random.randrange(3)) for _ in range(size)]
            for _ in range(size)
        ]
        left, right = (
            [[Fraction(random.randrange(-20, 21), part) for _ in range(size)] for _ in range(size)]
            for _ in range(2)
        )
        found = crossing._deviation(h, *([[float(x) for x in row] for row in side] for side in (left, right)))
        for i, j in product(range(size), repeat=2):
            parts = [(left[i][k] * right[j][m], h[k][m]) for k, m in product(range(size), repeat=2)]
            off = abs((i == j) - sum(c * Fraction(x.middle, 1 << bits) for c, x in parts))
            off += sum(abs(c) * Fraction(x.radius, 1 << bits) for c, x in parts)
            # C, R and their products each have six bits here: nothing but the last step is rounded
            if found[i][j] != -(-off * (1 << bits) // 1):
                return f"{found[i][j]}, not {float(off * (1 << bits))}"
    return ""


def what_is_small_shrinks_every_vector() -> str:
    """Matrices ≥ 0 by their largest eigenvalue: below 1 or not."""
    is_small = module("known_hand.rest")._is_small
    for told, right in (
        ([["0"]], True), ([["1/2"]], True), ([["15/16"]], True), ([["1"]], False), ([["17/16"]], False),
        ([["2"]], False), ([["3"]], False), ([["1/4", "4"], ["1/16", "1/4"]], True), ([], True),
        ([["0", "4"], ["1/8", "0"]], True), ([["0", "4"], ["1/4", "0"]], False), ([["0", "2"], ["2", "0"]],
         False),
        ([["1/2", "1/2"], ["1/2", "1/2"]], False), ([["1/2", "0"], ["9", "1/2"]], True), ([["0", "9"], ["0",
         "1"]], False),
    ):  # fmt: skip
        bounds = [[int(Fraction(x) * 256) for x in row] for row in told]
        if is_small(bounds, 8) is not right:
            return f"{told} is {'not ' * right}small"
    return ""


def no_root_crosses_unseen() -> str:
    """A factor whose root meets the circle at the end of what varies; none where that is far away."""
    if not _never(([-2, 1], [0, 1]), [[5, -6, 4]], Fraction(1, 100)):
        return "a polynomial that begins below 0 is not told"
    for rest in ([], [[1, 0]], [[2, -1]], [[3, 2], [2, -1]], [[5, -6, 4]], [[25, 30, 20], [2, 1]]):
        for moving, reaches in (
            (([9, -8], [0, 1]), 17), (([9, -8], [0, -1]), 1), (([9, 8], [0, 1]), 1), (([2, -1], [0, -1]), 1),
            (([10, -12, 8], [0, 0, 1]), 2), (([10, 12, 8], [0, 0, 1]), 2), (([10, 0, 9], [0, 0, 1]), 1),
            (([20, -37, 18], [0, -1, 0]), 1),
        ):  # fmt: skip
            for part, right in ((Fraction(1), False), (Fraction(101, 100), False), (Fraction(1, 20), True)):
                if _never(moving, rest, part * reaches) is not right:
                    return f"{moving} beside {rest}, {float(part)} of what it takes"
    # two pairs, one of them near the circle: the matrix is nearly singular, and what varies cancels in det H
    near = _never(([10, -12, 8], [0, 0, 1]), [[5, -6, 4]], Fraction(1, 4) * 2)
    return "" if near else "a pair near the circle beside another one"


def _never(moving: Sequence[Sequence[int]], rest: Sequence[Sequence[int]], most: Fraction) -> bool:
    """(a + ε b) q(z), |ε| ≤ most, to 60 bits."""
    enclosed, bits = module("exact.enclosed").Enclosed, 60
    steady, changing = (in_zeta(expanded(part, *rest)) for part in moving)
    changing = [0] * (len(steady) - len(changing)) + changing
    told = [
        enclosed(bits, s << bits, (floor(c * most * (1 << bits)),), 1)
        for s, c in zip(steady, changing, strict=True)
    ]
    found: bool = module("known_hand.rest").never_crosses(told)
    return found


def sums_of_products_are_rounded_once() -> str:
    """As products and their sums are, and no wider."""
    dot, random = module("exact.enclosed").dot, Random(5)
    for count in (1, 2, 5):
        for _ in range(ROUNDS):
            a = [some(random, 20, -(10**7), 10**7, Fraction(1, 50)) for _ in range(count)]
            b = [some(random, 20, -(10**7), 10**7, Fraction(1, 50)) for _ in range(count)]
            if random.random() < 0.3:
                a[0] = module("exact.enclosed").Enclosed(20, 0)
            found = dot(a, b)
            for first, second, *shared in product((-1, 1), repeat=4):
                value = sum(at(x, shared, first) * at(y, shared, second) for x, y in zip(a, b, strict=True))
                if abs(value - at(found, shared, 0)) > Fraction(found.radius, 1 << 20):
                    return f"{count} of them"
            separate = sum((x * y for x, y in zip(a[1:], b[1:], strict=True)), a[0] * b[0])
            if found.radius > separate.radius:
                return f"{count} of them: too wide"
    return ""


def what_may_not_be_0_is_not_left_out() -> str:
    """Of a sum of products: a number near 0 that is not 0, for its radius or a slope."""
    dot, enclosed = module("exact.enclosed").dot, module("exact.enclosed").Enclosed
    five = enclosed(8, 5 << 8)
    for x, right in (
        (enclosed(8, 0), True), (enclosed(8, 0, (), 1), False), (enclosed(8, 0, (0, 1)), False),
        (enclosed(8, 1), False), (enclosed(8, 0, (0, 0)), True),
    ):  # fmt: skip
        if x.is_zero is not right:
            return f"{x.middle} ± {x.slopes} ± {x.radius}"
        for found in (dot([x], [five]), dot([five], [x])):
            if (found.middle, found.reach) != (5 * x.middle, 5 * x.reach):
                return f"five times {x.middle} ± {x.slopes} ± {x.radius}"
    return ""


def what_a_quotient_loses_is_kept() -> str:
    """A unit for each number that does not come out, and none for one that does."""
    enclosed = module("exact.enclosed").Enclosed
    for middle, slope, radius, whole in product(range(-2, 3), range(-2, 3), range(2), (1, 2, 3)):
        x = enclosed(8, middle, (slope,), radius)
        found = x.over(whole)
        lost = (middle % whole != 0) + (slope % whole != 0)
        for value, shared in corners(x):
            if abs(value / whole - at(found, shared, 0)) > Fraction(found.radius, 1 << 8):
                return f"{middle} ± {slope} ± {radius} over {whole}"
        if found.radius != -(-radius // whole) + lost:
            return f"{middle} ± {slope} ± {radius} over {whole}: {found.radius} said"
    return ""


def numbers_keep_what_they_share() -> str:
    """Sums, differences, products, shifts and quotients at every corner of what varies, radius and slopes."""
    enclosed = module("exact.enclosed")
    random, bits = Random(2), 20

    def any_number() -> Any:
        slopes = tuple(random.randrange(-999, 999) for _ in range(2)) if random.random() < 0.7 else ()
        return enclosed.Enclosed(bits, random.randrange(-(10**7), 10**7), slopes, random.randrange(0, 999))

    for _ in range(ROUNDS):
        a, b = any_number(), any_number()
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
        value = expected(at(a, shared, first), at(b, shared, second))
        farthest = max(farthest, abs(value - at(found, shared, 0)))
    radius, unit = Fraction(found.radius, 1 << found.bits), Fraction(1, 1 << found.bits)
    second_order = Fraction(2 * a.reach * b.reach, 1 << 2 * a.bits)
    if farthest > radius:
        return f"{float(farthest)} off, {float(radius)} said"
    return "wider than it need be" if radius > farthest + second_order + 5 * unit else ""


def what_is_kept_apart_cancels() -> str:
    """Each radius an ε of its own; what they share already is shared still."""
    enclosed, apart = module("exact.enclosed").Enclosed, module("exact.enclosed").apart
    told = [enclosed(8, 5, (1, 2), 3), enclosed(8, 7, (), 4), enclosed(8, 9, (1, -2))]
    first, second, third = apart(told)
    if any(
        (x.middle, x.reach) != (y.middle, y.reach) for x, y in zip((first, second, third), told, strict=True)
    ):
        return "others"
    reaches = [(x - y).reach for x, y in ((first, first), (second, second), (first, second), (first, third))]
    if reaches != [0, 0, 3 + 3 + 4, 4 + 3]:
        return f"{reaches}"
    certain = [enclosed(8, 5, (), 3), enclosed(8, 7, (), 4)]
    return "" if [x.slopes for x in apart(certain)] == [(), ()] else "slopes where nothing varies"


def signs_are_certain() -> str:
    """Of a number that reaches 0, that does not, and of 0."""
    enclosed = module("exact.enclosed").Enclosed
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
    enclosed = module("exact.enclosed")
    for value in (Fraction(3, 8), Fraction(1, 3), Fraction(-1, 3), Fraction(-5, 7)):
        found = enclosed.known(value, 9)
        off = abs(value - Fraction(found.middle, 512))
        if off > Fraction(found.radius, 512) or found.radius != (0 if value.denominator == 8 else 1):
            return f"{value}"
    for low, high in (
        (Fraction(1, 3), Fraction(5, 7)),
        (Fraction(1, 2), Fraction(3, 4)),
        (Fraction(1, 3), Fraction(1, 3)),
    ):
        for place in range(3):
            found = enclosed.between(low, high, place, 3, 16)
            if len(found.slopes) != (3 if high > low else 0) or any(
                s for i, s in enumerate(found.slopes) if i != place
            ):
                return f"{low} … {high} at {place}"
            for end, sign in ((low, -1), (high, 1)):
                off = abs(end - at(found, [sign] * 3, 0)) * (1 << 16)
                if not off <= found.radius <= off + 3:
                    return f"{low} … {high}: {end}"
    return ""


def halves_are_the_same_polynomial() -> str:
    """Bernstein coefficients on both halves, times 2ⁿ."""
    split, random = module("exact.positivity")._split, Random(9)
    for degree, _ in product(range(6), range(5)):
        b = [random.randrange(-99, 100) for _ in range(degree + 1)]
        left = [sum(comb(i, k) * b[k] for k in range(i + 1)) << degree - i for i in range(degree + 1)]
        right = [
            sum(comb(i, k) * b[degree - k] for k in range(i + 1)) << degree - i for i in range(degree + 1)
        ][::-1]
        if split(b) != (left, right):
            return f"{b}: {split(b)}"
    return ""


def sizes_of_a_product_are_bounded() -> str:
    """Every coefficient of a polynomial within bounds times one of whole numbers."""
    enclosed, random = module("exact.enclosed").Enclosed, Random(10)
    for first, second in product(range(1, 5), repeat=2):
        a = [enclosed(8, random.randrange(-50, 50), (), random.randrange(5)) for _ in range(first)]
        e = [random.randrange(-9, 10) for _ in range(second)]
        right = [
            abs(sum(a[i].middle * e[k - i] for i in range(first) if 0 <= k - i < second))
            + sum(a[i].radius * abs(e[k - i]) for i in range(first) if 0 <= k - i < second)
            for k in range(first + second - 1)
        ]
        if module("pair.felt")._sizes(a, e) != right:
            return f"{first} by {second}"
    return ""


CHECKS = (
    functions_are_rounded_outward,
    curvature_is_bounded_closely,
    what_has_few_bits_is_rounded_outward,
    a_slope_is_known_to_a_unit,
    what_may_be_0_has_no_inverse,
    sines_are_rounded_outward,
    series_are_cut_off_outward,
    series_keep_what_their_angle_is_off,
    angles_have_few_turns,
    roots_are_told_inside_from_outside,
    roots_next_to_the_circle_are_told,
    what_is_0_somewhere_is_not_positive,
    whole_numbers_decide_every_root,
    what_is_open_is_not_decided,
    coprime_polynomials_are_told,
    the_circle_becomes_an_axis,
    what_is_left_of_a_matrix_is_bounded,
    what_is_small_shrinks_every_vector,
    no_root_crosses_unseen,
    halves_are_the_same_polynomial,
    sizes_of_a_product_are_bounded,
    sums_of_products_are_rounded_once,
    what_may_not_be_0_is_not_left_out,
    what_a_quotient_loses_is_kept,
    numbers_keep_what_they_share,
    what_is_kept_apart_cancels,
    signs_are_certain,
    rational_numbers_are_enclosed,
)

CASES = [Case(check.__name__.replace("_", " "), check, "") for check in CHECKS]
