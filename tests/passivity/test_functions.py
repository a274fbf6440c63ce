"""Functions of numbers within bounds contain what mpmath finds anywhere in them, and hardly more."""

from __future__ import annotations

from fractions import Fraction

import mpmath
import numpy as np
import pytest

from zwidth.checker.arm.cells import constant
from zwidth.checker.document.refusal import Invalid
from zwidth.checker.exact.enclosed import Enclosed, NotPositive, dot, inverse, known, root, sine_cosine

BITS = 80
ONE = 1 << BITS
RNG = np.random.default_rng(20)


@pytest.fixture(autouse=True)
def digits():
    """Of mpmath."""
    with mpmath.workdps(60):
        yield


def number(middle: float, half: float, place: int = 0, radius: float = 0.0) -> Enclosed:
    """The middle and a half width that two εᵢ may share, and a radius of its own."""
    slopes = tuple(int(half * ONE) if i == place else 0 for i in range(2))
    return Enclosed(BITS, int(middle * ONE), slopes, int(radius * ONE))


def at(x: Enclosed, e: tuple[float, float]) -> tuple[mpmath.mpf, mpmath.mpf]:
    """The least and the largest that x may be at a place of the shared εᵢ."""
    middle = mpmath.mpf(x.middle) + sum(s * mpmath.mpf(v) for s, v in zip(x.slopes, e, strict=True))
    return (middle - x.radius) / ONE, (middle + x.radius) / ONE


PLACES = [(0.0, 0.0), (1.0, 1.0), (-1.0, -1.0), *(tuple(RNG.uniform(-1, 1, 2)) for _ in range(6))]
FUNCTIONS = {
    "sine": (lambda x: sine_cosine(x)[0], mpmath.sin, 20.0, 0.0),
    "cosine": (lambda x: sine_cosine(x)[1], mpmath.cos, 20.0, 0.0),
    "root": (root, mpmath.sqrt, 5.0, 5.1),
    "inverse": (inverse, lambda x: 1 / x, 5.0, 5.1),
    "inverse below 0": (inverse, lambda x: 1 / x, 5.0, -10.2),
}


@pytest.mark.parametrize("width", [0, 1e-6, 0.3])
@pytest.mark.parametrize("radius", [0, 1e-5])
@pytest.mark.parametrize("name", FUNCTIONS)
def test_a_function_holds_its_values(name: str, width: float, radius: float) -> None:
    """At every place of the box and both ends of the radius; wider by the square of the reach at most."""
    function, true, size, shift = FUNCTIONS[name]
    for middle in RNG.uniform(-size, size, 30) * (0.99 if shift else 1) + shift:
        least = abs(middle) - width - radius
        if shift and least < 0.5:
            continue
        x = number(middle, width, radius=radius)
        found = function(x)
        for e in PLACES:
            low, high = at(found, e)
            for value in at(x, e):
                assert low <= true(value) <= high
        bend = 1 if not shift else float(max(2 / least**3, 1 / least**1.5))
        steepest = 1 if not shift else float(max(1 / least**2, 1 / least**0.5))
        reach = width + radius
        assert found.radius / ONE <= 1.01 * (bend * reach**2 + steepest * radius) + 2.0**-70


def test_no_root_and_no_inverse_of_what_may_be_0() -> None:
    """Refused as soon as 0 is within the bounds; an inverse of what is below 0 is not."""
    for function in (root, inverse):
        for x in (number(0.1, 0.1), number(0, 0), number(-0.1, 0.05, radius=0.06)):
            with pytest.raises(NotPositive):
                function(x)
    with pytest.raises(NotPositive):
        root(number(-1, 0.1))
    assert inverse(number(-2, 0)).middle == -ONE // 2


def test_a_formula_of_all_of_them() -> None:
    """√(3 + x² y)·(x − y)/(2 + y²) − x at places of a box, the shared parts with it."""
    two, three = (known(Fraction(n), BITS) for n in (2, 3))
    for a, b in RNG.uniform(-1, 1, (40, 2)):
        x, y = number(a, 0.2, 0), number(b, 0.1, 1)
        found = root(three + x * x * y) * (x - y) * inverse(two + y * y) - x
        for e in PLACES:
            (u, _), (v, _) = at(x, e), at(y, e)
            low, high = at(found, e)
            assert low <= mpmath.sqrt(3 + u * u * v) * (u - v) / (2 + v * v) - u <= high


def test_a_sum_of_products_is_that_of_its_terms() -> None:
    """Within their bounds, and no wider but for the roundings that it saves."""
    for _ in range(40):
        pairs = [(number(*RNG.uniform(-1, 1, 2), k % 2), number(*RNG.uniform(-1, 1, 2), 1)) for k in range(3)]
        found = dot(*zip(*pairs, strict=True))
        apart = pairs[0][0] * pairs[0][1] + pairs[1][0] * pairs[1][1] + pairs[2][0] * pairs[2][1]
        assert abs(found.middle - apart.middle) <= 3
        assert found.radius <= apart.radius + 3
        for e in PLACES:
            low, high = at(found, e)
            assert low <= sum(at(x, e)[0] * at(y, e)[0] for x, y in pairs) <= high


def test_what_is_too_large() -> None:
    """Numbers of an arm beyond 2⁶⁴, and angles of many turns."""
    for refused in (lambda: constant(Fraction(10**30)), lambda: sine_cosine(number(65, 0))):
        with pytest.raises(Invalid, match="too"):
            refused()
