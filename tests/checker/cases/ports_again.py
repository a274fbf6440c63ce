"""What the checker finds of ports, counted a second time: criteria at points of the circle, derivatives.

And ports that only a wrong count would take for passive.
"""

from __future__ import annotations

from collections.abc import Sequence
from fractions import Fraction
from importlib import import_module
from random import Random
from typing import Any

from . import Case, put, refused
from .linear import signs
from .positive_real_matrix import CONSTANT, ONE, proved

ROUNDS = 8


def part(name: str) -> Any:
    """Of what the checker knows of ports, as it is loaded now."""
    return import_module(f"zwidth.checker.port.{name}")


def _some(random: Random, size: int) -> list[Fraction]:
    return [Fraction(random.randrange(-5, 6), random.randrange(1, 4)) for _ in range(size)]


def _at(ascending: Sequence[Fraction], point: tuple[Fraction, Fraction]) -> tuple[Fraction, Fraction]:
    real = imaginary = Fraction(0)
    for c in reversed(ascending):
        real, imaginary = (
            real * point[0] - imaginary * point[1] + c,
            real * point[1] + imaginary * point[0],
        )
    return real, imaginary


def real_parts_on_the_boundary() -> str:
    """Re(M D̄) at some points, times what is positive; neither need be as long as the other."""
    index, random = part("index"), Random(1)
    for _ in range(ROUNDS):
        m, d = (_some(random, random.randrange(1, 4)) for _ in range(2))
        order = max(len(m), len(d)) - 1
        ratios = set()
        for t in (Fraction(1, 3), Fraction(2, 3), Fraction(3)):
            c, sine = (1 - t * t) / (1 + t * t), 2 * t / (1 + t * t)
            for name, point, weight in (
                ("_on_circle", (c, sine), Fraction(1)),
                ("_on_axis", (Fraction(0), t), (1 + c) ** order),
            ):
                (a, b), (x, y) = _at(m, point), _at(d, point)
                found = sum(k * c**i for i, k in enumerate(getattr(index, name)(m, d, order)))
                right = (a * x + b * y) * weight
                if (found > 0) - (found < 0) != (right > 0) - (right < 0):
                    return f"{name}: {m}, {d} at {t}"
                if right:
                    ratios.add((name, found / right))
        if len(ratios) > 2:
            return f"{m}, {d}: {ratios}"
    return ""


def values_at_a_point() -> str:
    """unit^order p(point/unit), of whole numbers."""
    random = Random(2)
    for order in range(4):
        p, unit = (
            [random.randrange(-9, 10) for _ in range(random.randrange(order + 2))],
            random.randrange(1, 6),
        )
        point = random.randrange(-5, 6), random.randrange(1, 6)
        right = _at([Fraction(c) for c in p], (Fraction(point[0], unit), Fraction(point[1], unit)))
        if part("index")._at(p, point, unit, order) != tuple(unit**order * x for x in right):
            return f"{p} at {point} over {unit}"
    return ""


def derivatives_are_those_of_powers() -> str:
    """Σ c_i dⁱφ/dtⁱ: of tᵏ it is k (k − 1) … tᵏ⁻ⁱ."""
    random = Random(3)
    for _ in range(ROUNDS):
        side, phi = _some(random, random.randrange(1, 4)), _some(random, random.randrange(1, 5))
        right = [Fraction(0)] * len(phi)
        for k, x in enumerate(phi):
            for i, c in enumerate(side[: k + 1]):
                falling = Fraction(1)
                for j in range(i):
                    falling *= k - j
                right[k - i] += c * x * falling
        if part("motion")._operated(side, phi) != right:
            return f"{side}, {phi}"
    return ""


# Re(1 + 2/z) = 1 + 2c, and at one point alone it is as good as a constant
AT_ONE_POINT = proved([(0, ONE)], ([[[1, 0]]], [3, 2]), 2, [[[1, 2]]], [1, 0], 0, time="discrete")
# d = z + 1/3: at c = 3/5 and at 0 alone 1 + 177/125 c is as |d|⁴
_BETA = Fraction(177, 125)
_TOP = (1 - _BETA / 3) * Fraction(9, 8)
_REST = _BETA - _TOP / 3
AT_TWO_POINTS = proved(
    [(2, ONE)],
    ([[[1, Fraction(1, 3)]]], [_TOP + 2, _REST + Fraction(2, 3)]),
    2,
    [[[_TOP, _REST]]],
    [1, Fraction(1, 3)],
    0,
    time="discrete",
)
NEGATIVE = proved([(0, ONE)], ([[[1]]], ["1/2"]), 1, [[["-1/2"]]], [1], 0)
# −(z + 2)/(z − 2): Re > 0 on the circle, and with g = 1 nothing is left of z
OUTSIDE = {
    "kind": "positive real",
    "index": "input",
    "level": 0,
    "system": {"time": "discrete", "numerator": [-1, -2], "denominator": [1, -2]},
    "proof": {"offset": 1, "positivity": signs()},
}
NOTHING = proved([(0, ONE)], ([[[]]], [0]), 1, [[[1]]], [1], 0)
FACTORS, PROPER = "do not multiply to the sum", "must be a proper matrix of the port's size"
LARGER = [[[2], [-1], []], [[-1], [2], []], [[], [], [1]]]

CHECKS = [real_parts_on_the_boundary, values_at_a_point, derivatives_are_those_of_powers]
CASES = [
    *(Case(check.__name__.replace("_", " "), check, "") for check in CHECKS),
    refused("a constant at one point", AT_ONE_POINT, FACTORS),
    refused("a power at two points", AT_TWO_POINTS, FACTORS),
    refused("a half of less than nothing", NEGATIVE, FACTORS),
    refused("a root that is infinitely far out", OUTSIDE, "a root lies outside"),
    refused("a resolvent of nothing", NOTHING, PROPER),
    refused("a resolvent of more axes", put(CONSTANT, {"proof.resolvent.numerators": LARGER}), PROPER),
    refused(
        "minors of more axes",
        put(CONSTANT, {"proof.minors": [*CONSTANT["proof"]["minors"], CONSTANT["proof"]["minors"][0]]}),
        "every size of principal minors",
    ),
    refused("a row too short", put(CONSTANT, {"system.numerators": [[[2], [1]], [[1]]]}), "as many columns"),
]
