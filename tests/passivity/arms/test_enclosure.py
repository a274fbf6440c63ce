"""Ranges rounded outward contain what mpmath finds, and are hardly wider; so do slopes."""

from __future__ import annotations

from fractions import Fraction

import mpmath
import numpy as np
import pytest

from zwidth.checker.document.reading import Invalid
from zwidth.checker.exact import enclosure
from zwidth.checker.exact.enclosure import ONE, Jet

mpmath.mp.dps = 60
RNG = np.random.default_rng(20)


def contains(found: tuple[int, int], value: mpmath.mpf) -> bool:
    """The range holds the value."""
    return bool(found[0] <= value * ONE <= found[1])


def ranges(count: int, size: float, width: float) -> list[tuple[int, int]]:
    """Random ranges of up to this width, some of a single number."""
    middles = RNG.uniform(-size, size, count)
    halves = RNG.uniform(0, width, count) * (RNG.random(count) < 0.7)
    return [(int((m - h) * ONE), int((m + h) * ONE)) for m, h in zip(middles, halves, strict=True)]


def inside(found: tuple[int, int]) -> list[mpmath.mpf]:
    """Both ends of a range, and points between them."""
    low, high = (mpmath.mpf(x) / ONE for x in found)
    return [low, high, *(low + (high - low) * t for t in RNG.random(4))]


@pytest.mark.parametrize("width", [0, 1e-6, 0.3, 4])
def test_sine_and_cosine(width: float) -> None:
    """Of angles up to several turns; within half a turn to 2⁻⁶⁸, wider by the square of the range at most."""
    for angle in ranges(60, 20, width) + ranges(60, 3, width):
        found = enclosure.sine_cosine(angle)
        half = (angle[1] - angle[0]) / ONE / 2
        for x in inside(angle):
            assert contains(found[0], mpmath.sin(x))
            assert contains(found[1], mpmath.cos(x))
        middle = (angle[0] + angle[1]) / ONE / 2
        for own, slope in zip(found, (np.cos(middle), np.sin(middle)), strict=True):
            rounding = 2.0**-68 if abs(middle) < np.pi else 1e-9
            assert (own[1] - own[0]) / ONE <= (2 * half * abs(slope) + half**2) * (1 + 1e-12) + rounding


def test_products_squares_roots_and_inverses() -> None:
    """Each contains the function of every point, and ends within two digits of it."""
    for a, b in zip(ranges(200, 5, 2), ranges(200, 3, 2), strict=True):
        product, square = enclosure.times(a, b), enclosure.square(a)
        for x in inside(a):
            assert contains(square, x * x)
            assert all(contains(product, x * y) for y in inside(b))
        ends = [Fraction(x, ONE) * Fraction(y, ONE) for x in a for y in b]
        assert product[0] >= min(ends) * ONE - 1
        assert product[1] <= max(ends) * ONE + 1
        assert square[0] >= 0
        up = (a[0] + 8 * ONE, a[1] + 8 * ONE)
        root, inverse = enclosure.root(up), enclosure.inverse(up)
        assert all(contains(root, mpmath.sqrt(x)) and contains(inverse, 1 / x) for x in inside(up))
        assert abs(root[0] - mpmath.sqrt(mpmath.mpf(up[0]) / ONE) * ONE) < 2


def test_no_root_and_no_inverse_of_what_may_be_negative() -> None:
    """Refused as soon as 0 is in the range."""
    for function in (enclosure.root, enclosure.inverse):
        for range_ in ((0, ONE), (-1, ONE), (-ONE, -1)):
            with pytest.raises(enclosure.NotPositive):
                function(range_)
        assert function((1, ONE))[1] >= ONE


def test_slopes_contain_the_derivatives() -> None:
    """Of a function with all operations, anywhere in a cell, and its values."""

    def of(x, y, root):
        """f = √(3 + x² y)·(x − y)/(2 + y²) − x."""
        return root(3 + x * x * y) * (x - y) / (2 + y * y) - x

    for x, y in zip(ranges(40, 1, 0.3), ranges(40, 1, 0.3), strict=True):
        jets = Jet(x, {0: (ONE, ONE)}), Jet(y, {1: (ONE, ONE)})
        two, three = (Jet((n * ONE, n * ONE)) for n in (2, 3))
        lower = (two + jets[1].squared()).inverse()
        root = (three + jets[0] * jets[0] * jets[1]).root()
        found = root * (jets[0] - jets[1]) * lower - jets[0]
        for u, v in zip(inside(x), inside(y), strict=True):
            assert contains(found.value, of(u, v, mpmath.sqrt))
            for j, order in enumerate(((1, 0), (0, 1))):
                derivative = mpmath.diff(lambda a, b: of(a, b, mpmath.sqrt), (u, v), order)
                assert contains(found.slopes[j], derivative)


def test_a_number_of_the_document_is_between_its_ends() -> None:
    """Rounded outward by less than a digit; one too large is refused."""
    for x in (Fraction(1, 3), Fraction(-7, 11), Fraction(5), Fraction(0)):
        low, high = enclosure.enclosed(x)
        assert low <= x * ONE <= high
        assert high - low <= 1
    for refused in (
        lambda: enclosure.enclosed(Fraction(10**30)),
        lambda: enclosure.sine_cosine((0, 65 * ONE)),
    ):
        with pytest.raises(Invalid, match="too"):
            refused()
