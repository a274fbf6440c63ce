"""The checker's numbers with error bounds, functions of them and the held motion, against mpmath."""

from __future__ import annotations

from collections.abc import Sequence
from fractions import Fraction

import mpmath
import numpy as np
import pytest

from zwidth.checker.exact.enclosed import Enclosed, in_z, inverse, known, root, sine_cosine
from zwidth.checker.known_hand.held_motion import motion_of, sampled, sampled_free

BITS = 200


def value(x: Enclosed, places: Sequence[Fraction] = ()) -> tuple[Fraction, Fraction]:
    """Smallest and largest value where the shared εᵢ have these values."""
    middle = x.middle + sum(s * e for s, e in zip(x.slopes, places, strict=bool(x.slopes)))
    return Fraction(middle - x.radius, 1 << x.bits), Fraction(middle + x.radius, 1 << x.bits)


def real(x: Fraction) -> mpmath.mpf:
    return mpmath.mpf(x.numerator) / x.denominator


def test_a_polynomial_shifted_to_z() -> None:
    """2ζ³ − 5ζ + 7 with ζ = z − 1 is 2z³ − 6z² + z + 10."""
    found = in_z([known(Fraction(c), BITS) for c in (2, 0, -5, 7)])
    assert [x.middle >> BITS for x in found] == [2, -6, 1, 10]


@pytest.mark.parametrize(
    ("mass", "damping", "stiffness", "period", "delay", "digits"),
    [
        ("0.036", "0.15", "0", "0.001", "0", 50),
        ("0.2", "0", "930", "0.002", "0.0013", 50),
        ("0.05", "3.1", "420", "0.0005", "0.00213", 50),
        ("0.0004", "9", "21000", "0.002", "0.0007", 15),
    ],
)
def test_the_held_motion_is_that_of_matrix_exponentials(
    mass: str, damping: str, stiffness: str, period: str, delay: str, digits: int
) -> None:
    """They hold those of mpmath's expm at 80 digits; a motion that is fast within a sample costs bits."""
    ends = [(Fraction(x),) * 2 for x in (mass, damping, stiffness)]
    motion = motion_of(*ends, Fraction(period), Fraction(delay))
    found = sampled(motion, BITS)
    with mpmath.workdps(80):
        m, d, k, t, late = (mpmath.mpf(x) for x in (mass, damping, stiffness, period, delay))
        flow = mpmath.matrix([[0, 1, 0], [-k / m, -d / m, 1 / m], [0, 0, 0]])
        part = float(motion.late % 1)
        whole = mpmath.expm(flow * t)
        state, force = whole[:2, :2], whole[:2, 2]
        now = mpmath.expm(flow * (t - (late - int(motion.late) * t)))[:2, 2]
        trace, det = state[0, 0] + state[1, 1], state[0, 0] * state[1, 1] - state[0, 1] * state[1, 0]
        expected = [mpmath.mpf(1), 2 - trace, 1 - trace + det]

        def row(g: object) -> list:
            """C adj(zI − Φ) g in ζ = z − 1."""
            return [g[0], g[0] * (1 - state[1, 1]) + state[0, 1] * g[1]]

        top = row(force)
        if part:
            late_row, early = row(now), row(force - now)
            top = [late_row[0], late_row[0] + late_row[1] + early[0], late_row[1] + early[1]]
        assert found.late == int(motion.late) + (part > 0)
        for mine, true in zip([*found.denominator, *found.numerator], [*expected, *top], strict=True):
            low, high = value(mine)
            assert high - low < Fraction(1, 10**digits)
            slack = mpmath.mpf(10) ** -70 * max(abs(trace), 1)
            assert real(low) - slack <= true <= real(high) + slack


@pytest.mark.parametrize("delay", ["0", "0.0003", "0.0017"])
def test_a_free_mass_is_exact(delay: str) -> None:
    """Without spring and damper the enclosure holds the rational polynomials, to 10⁻⁵⁰."""
    zero = (Fraction(0),) * 2
    motion = motion_of((Fraction(1, 30),) * 2, zero, zero, Fraction(1, 1000), Fraction(delay))
    ball, exact = sampled(motion, BITS), sampled_free(motion)
    assert ball.late == exact.late
    pairs = zip([*ball.numerator, *ball.denominator], [*exact.numerator, *exact.denominator], strict=True)
    for mine, true in pairs:
        low, high = value(mine)
        assert low <= true <= high
        assert high - low < Fraction(1, 10**50)


# Functions, in fewer bits


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
    rng, one = np.random.default_rng(20), 1 << 80
    places = [Fraction(float(e)) for e in (0, 1, -1, *rng.uniform(-1, 1, 6))]
    for middle in rng.uniform(-size, size, 30) * (0.99 if shift else 1) + shift:
        least = abs(middle) - width - radius
        if shift and least < 0.5:
            continue
        x = Enclosed(80, int(middle * one), (int(width * one),), int(radius * one))
        found = function(x)
        with mpmath.workdps(60):
            for e in places:
                low, high = map(real, value(found, [e]))
                for end in value(x, [e]):
                    assert low <= true(real(end)) <= high
        bend = 1 if not shift else float(max(2 / least**3, 1 / least**1.5))
        steepest = 1 if not shift else float(max(1 / least**2, 1 / least**0.5))
        reach = width + radius
        assert found.radius / one <= 1.01 * (bend * reach**2 + steepest * radius) + 2.0**-70
