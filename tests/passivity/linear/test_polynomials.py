"""Signs and real roots on [−1, 1] and stability, exactly: of known roots, and by another road."""

from __future__ import annotations

from fractions import Fraction
from itertools import product as choices
from math import lcm
from random import Random

import mpmath
import polynomials
import pytest
from flint import fmpz_poly
from hypothesis import given, settings
from hypothesis import strategies as st
from strategies import seeds

from zwidth.checker.exact.roots import inside_unit_circle
from zwidth.passivity.linear import positivity
from zwidth.passivity.linear.exact_algebra import is_schur, rational_roots_inside, real_roots, roots_inside
from zwidth.passivity.linear.positivity import Positivity, TooClose, prove_nonnegative


def integers(*factors):
    """The product of factors in rational coefficients, made whole."""
    total = polynomials.product(*factors)
    scale = lcm(*(c.denominator for c in total))
    return [int(c * scale) for c in total]


def product(*factors):
    """The same of ascending coefficients, as a polynomial."""
    return fmpz_poly(integers(*factors))


def value(p, c):
    """p(c) by Horner, exactly."""
    total = Fraction(0)
    for a in reversed(p.coeffs()):
        total = total * c + int(a)
    return total


def assert_sound(p, nonnegative):
    """The answer is as expected and carries evidence that can be multiplied or evaluated out."""
    answer = prove_nonnegative(p)
    if not nonnegative:
        assert isinstance(answer, Fraction)
        assert -1 < answer < 1
        assert value(p, answer) < 0
        return
    assert isinstance(answer, Positivity)
    ends = [(1, -1)] * answer.at_one + [(1, 1)] * answer.at_minus_one
    rebuilt = product(*ends, answer.square, answer.square, answer.factor) if answer.square else fmpz_poly([])
    ratio = {Fraction(int(a), int(b)) for a, b in zip(p.coeffs(), rebuilt.coeffs(), strict=True) if b}
    assert p == rebuilt or (len(ratio) == 1 and ratio.pop() > 0)
    assert all(value(fmpz_poly(list(answer.factor)), Fraction(k, 97)) > 0 for k in range(-97, 98))


def root(r):
    """c − r."""
    return (-Fraction(r), 1)


TINY = Fraction(1, 10**30)
NEAR = Fraction(1, 2**120)
NONNEGATIVE = {
    "touches inside": [root("0.37"), root("0.37")],
    "touches both ends": [(1, -1), (1, 1)],
    "touches an end to third order": [(1, -1)] * 3,
    "double roots at dyadic points": [root("0.5"), root("0.5"), root("-0.25"), root("-0.25"), (3, 1)],
    "fourfold root at 0 and a simple one at −1": [root(0)] * 4 + [(1, 1)],
    "roots just outside": [(1 + TINY, -1), (1 + TINY, 1)],
    "misses zero by 1e-30": [(Fraction("0.1369") + TINY, Fraction("-0.74"), 1)],
    "two near misses": [(Fraction("0.25") + TINY, -1, 1), (Fraction("0.0625") + TINY, Fraction("0.5"), 1)],
    "a positive constant": [(Fraction("0.003"),)],
    "roots far away": [(7, 2), (11, -3), (5, 1, 1)],
}
NEGATIVE = {
    "c(c − 1/2)": [root(0), root("0.5")],
    "c²(c − 1/4)": [root(0), root(0), root("0.25")],
    "(c − 1/2)(c + 1/2)": [root("0.5"), root("-0.5")],
    "crosses inside": [root("0.37")],
    "crosses next to an end": [(1 - TINY, -1)],
    "crosses next to the other end": [(1 - TINY, 1)],
    "dips by 1e-30": [(Fraction("0.1369") - TINY, Fraction("-0.74"), 1)],
    "dips at a dyadic point": [(-TINY, 0, 1)],
    "negative but for the ends": [(-1, 0, 1)],
    "square times a crossing at the same place": [root("0.625")] * 3,
    "negative between two double roots": [root("-0.5")] * 2 + [root("0.5")] * 2 + [(-2, 1)],
    "a negative constant": [(Fraction("-0.003"),)],
    "negative of a square": [root("0.2"), root("0.2"), (-4,)],
}


@pytest.mark.parametrize("name", [*NONNEGATIVE, *NEGATIVE])
def test_a_sign_that_is_known(name):
    assert_sound(product(*(NONNEGATIVE | NEGATIVE)[name]), name in NONNEGATIVE)


def test_zero():
    assert isinstance(prove_nonnegative(fmpz_poly([])), Positivity)


@pytest.mark.parametrize("seed", range(6))
def test_degree_sixty(seed):
    """Sixty roots: twenty-nine touching pairs inside, then one pair that is or is not a hair apart."""
    random = Random(seed)
    places = [Fraction(random.randint(-999, 999), 1000) for _ in range(29)]
    touching = [f for r in places for f in (root(r), root(r))]
    last = Fraction(random.randint(-999, 999), 1000)
    while last in places:
        last += Fraction(1, 3000)
    hair = Fraction(1, 10**25)
    above, below = (((last * last) + s * hair, -2 * last, 1) for s in (1, -1))
    assert_sound(product(*touching, above), True)
    assert_sound(product(*touching, below), False)


@pytest.mark.filterwarnings("ignore:Descending")
@seeds(20)
def test_against_roots(seed):
    random = Random(seed)
    degree = random.randint(1, 14)
    p = fmpz_poly([random.randint(-50, 50) for _ in range(degree)] + [random.choice([-3, 2, 17])])
    p = p + random.choice([0, 40, 120])
    coefficients = [int(c) for c in p.coeffs()]
    roots = mpmath.polyroots(coefficients[::-1], maxsteps=500, extraprec=500)
    real = sorted(float(r.real) for r in roots if abs(r.imag) < 1e-20 and abs(r.real) < 1)
    cuts = [-1.0, *real, 1.0]
    lowest = min(value(p, Fraction((a + b) / 2)) for a, b in zip(cuts, cuts[1:], strict=False))
    assert_sound(p, lowest > 0)


numbers = st.fractions(-2, 2, max_denominator=64)


@settings(max_examples=60, deadline=None)
@given(
    st.lists(numbers, max_size=5),
    st.lists(numbers, max_size=4),
    st.lists(st.tuples(numbers, st.fractions(Fraction(1, 1000), 1)), max_size=3),
    st.sampled_from([1, -1]),
)
def test_products_of_known_factors(simple, double, complex_pairs, sign):
    """The sign of a product follows from counting the roots of its factors."""
    factors = [(sign,), *(root(r) for r in simple)]
    factors += [root(r) for r in double for _ in (1, 2)]
    factors += [(r * r + s, -2 * r, 1) for r, s in complex_pairs]
    cuts = sorted({Fraction(-1), Fraction(1), *(r for r in simple if -1 < r < 1)})

    def positive(c):
        return sign * (-1) ** sum(r > c for r in simple) > 0

    nonnegative = all(positive((a + b) / 2) for a, b in zip(cuts, cuts[1:], strict=False))
    assert_sound(product(*factors), nonnegative)


def valley(degree, steep, sign):
    """± cⁿ + (steep c − 1)²: all but touches zero at 1/steep, from above or below."""
    return fmpz_poly([0] * degree + [sign]) + fmpz_poly([-1, steep]) ** 2


@pytest.mark.parametrize("sign", [1, -1])
@pytest.mark.parametrize(("degree", "steep"), [(9, 1000), (40, 10**6), (100, 10**4)])
def test_a_valley_that_all_but_touches_zero(monkeypatch, degree, steep, sign):
    """By 1e-240 and more: halving down to it would read a thousand times as many words."""
    monkeypatch.setattr(positivity, "MOST_WORDS", 400_000)
    assert_sound(valley(degree, steep, sign), sign > 0)


@pytest.mark.parametrize("middle", ["0.3", "0.25", "-0.9"])
@pytest.mark.parametrize("gap", [TINY, -TINY])
def test_a_valley_between_other_roots(middle, gap):
    """Beside touching pairs, and at a place that halving meets."""
    r = Fraction(middle)
    assert_sound(product((r * r + gap, -2 * r, 1), root("0.31"), root("0.31"), (3, 1)), gap > 0)


def test_what_is_too_close_is_said_to_be():
    """A valley of 1e-1200 would be decided from numbers that no proof can hold: that is said, at once."""
    with pytest.raises(TooClose, match="so close to zero"):
        prove_nonnegative(valley(240, 10**10, 1))


def test_the_work_on_one_sign_is_bounded(monkeypatch):
    """What is read is counted before it is read, in words."""
    p = product(*NONNEGATIVE["two near misses"])
    assert isinstance(prove_nonnegative(p), Positivity)
    monkeypatch.setattr(positivity, "MOST_WORDS", 20)
    with pytest.raises(TooClose):
        prove_nonnegative(p)


@pytest.mark.parametrize("sign", [1, -1])
def test_a_valley_narrower_than_the_digits_of_its_lowest_point(sign):
    """A tangent beside the interval says nothing of what is in it: more digits are taken."""
    lowest, half = Fraction(1, 3), Fraction(1, 2**300)
    low, high = lowest - half, lowest + half
    dip = (lowest**2 + Fraction(sign, 2**700), -2 * lowest, 1)
    on_unit = (half**2 + Fraction(sign, 2**700), -4 * half**2, 4 * half**2)  # c = low + 2 half t
    answer = positivity._valley(product(dip), product(on_unit), low, high)
    assert answer is True if sign > 0 else value(product(dip), answer) < 0


PLACED = {
    "none": [],
    "dyadic, where halving meets them": ["0", "0.5", "-0.5", "0.25"],
    "thirds": ["1/3", "-2/3"],
    "next to each other": [Fraction("0.3"), Fraction("0.3") + Fraction(1, 10**25)],
    "next to the ends": [1 - TINY, TINY - 1],
    "beyond the ends": ["1.5", "-7", "0.1"],
    "at the ends": ["1", "-1", "0.7"],
    "more than once": ["0.4"] * 3 + ["-0.25"] * 2,
}


@pytest.mark.parametrize("name", PLACED)
def test_placed_roots(name):
    """Each root inside is found once, to 120 bits, and those at the ends and beyond are not."""
    places = {Fraction(r) for r in PLACED[name]}
    expected = sorted(r for r in places if -1 < r < 1)
    found = sorted(roots_inside(product(*map(root, PLACED[name]), (7, 0, 3))))
    assert len(found) == len(expected)
    assert all(abs(a - b) < NEAR for a, b in zip(found, expected, strict=True))


@seeds(12)
def test_random_polynomials(seed):
    random = Random(seed)
    cosines = [random.randint(-(10**6), 10**6) for _ in range(random.randint(2, 40))]
    p = sum((c * fmpz_poly.chebyshev_t(j) for j, c in enumerate(cosines)), fmpz_poly([]))
    expected = sorted(c for c in real_roots(p) if -1 < c < 1)
    found = sorted(roots_inside(p))
    assert len(found) == len(expected)
    assert all(abs(a - b) < NEAR for a, b in zip(found, expected, strict=True))


def test_rational_roots():
    """The rational ones alone, and of these the simple ones inside."""
    p = product(root("0.123456789"), root("-2/7"), *[root("0.5")] * 2, root(3), (-2, 0, 7), (1, 1, 1))
    assert sorted(rational_roots_inside(p)) == [Fraction(-2, 7), Fraction("0.123456789")]


def test_a_root_that_is_nearly_rational():
    """What agrees with a short fraction to 40 digits and is another number is told apart."""
    near = Fraction(1, 3) + Fraction(1, 10**40)
    assert rational_roots_inside(product(root(near))) == [near]
    assert rational_roots_inside(product((Fraction(-1, 9) - Fraction(1, 10**40), 0, 1))) == []


def pair(radius, cosine):
    """z² − 2 r cos φ z + r²: a complex pair."""
    r = Fraction(radius)
    return (1, -2 * r * Fraction(cosine), r * r)


def assert_stable(descending, expected):
    assert is_schur(descending[::-1]) is expected
    assert inside_unit_circle([Fraction(c) for c in descending]) is expected


HAIR = Fraction(1, 10**12)
KNOWN = {
    "real, a hair inside": ([(1, HAIR - 1)], True),
    "real, a hair outside": ([(1, -1 - HAIR)], False),
    "pair, a hair inside": ([pair(1 - HAIR, "0.3")], True),
    "pair, a hair outside": ([pair(1 + HAIR, "0.3")], False),
    "at 1": ([(1, -1), (1, "-0.4")], False),
    "at −1": ([(1, 1), (1, "-0.4")], False),
    "pair on the circle": ([pair(1, "-0.7"), (1, "0.2")], False),
    "double pair on the circle": ([pair(1, "0.6"), pair(1, "0.6")], False),
    "reciprocal pair": ([(1, "-0.4"), (1, "-2.5")], False),
    "reciprocal complex pairs": ([pair("0.8", "0.1"), pair("1.25", "0.1")], False),
    "reciprocal with opposite signs": ([(1, "-0.5"), (1, 2)], False),
    "product of roots −1": ([(1, "-0.5"), (1, 2), (1, "0.1")], False),
    "roots at zero": ([(1, 0), (1, 0), (1, "0.9")], True),
    "a constant": ([(7,)], True),
    "negative leading coefficient": ([(-3, 2)], True),
    "order 40, all close to the circle": ([pair("0.9999", Fraction(k, 21)) for k in range(1, 21)], True),
    "order 40, one pair outside": (
        [pair("0.9999", Fraction(k, 21)) for k in range(1, 20)] + [pair("1.0001", "0.95")],
        False,
    ),
    "order 40, one pair on the circle": (
        [pair("0.99", Fraction(k, 21)) for k in range(1, 20)] + [pair(1, "0.95")],
        False,
    ),
}


@pytest.mark.parametrize("name", KNOWN)
def test_known_roots(name):
    factors, expected = KNOWN[name]
    assert_stable(integers(*factors), expected)


def test_zero_is_not_stable():
    assert not is_schur([])
    assert not is_schur([0, 0])


@seeds(20)
def test_random_roots(seed):
    random = Random(seed)
    factors, stable = [], True
    for _ in range(random.randint(1, 6)):
        radius = Fraction(f"{random.choice([random.uniform(0, 1), random.uniform(0.99, 1.005)]):.4f}")
        cosine = Fraction(f"{random.uniform(-1, 1):.3f}")
        factors.append(
            pair(radius, cosine) if random.random() < 0.6 else (1, random.choice([1, -1]) * radius)
        )
        stable &= radius < 1
    assert_stable(integers((Fraction("-2.3"),), *factors), stable)


def test_every_small_cubic():
    """Small whole numbers make a reflection of exactly 1 on the way, which no balls decide."""
    for descending in choices(range(-3, 4), repeat=4):
        if descending[0]:
            expected = inside_unit_circle([Fraction(c) for c in descending])
            assert is_schur(descending[::-1]) is expected, descending


@pytest.mark.parametrize(("furthest", "expected"), [(1 - HAIR, True), (1 + HAIR, False)])
def test_order_one_hundred_and_ten(furthest, expected):
    """A cluster of poles near 1 and one pole a hair inside or outside: decided, whatever the digits."""
    assert is_schur(integers(*[(1, Fraction("-0.99"))] * 109, (1, -furthest))[::-1]) is expected
