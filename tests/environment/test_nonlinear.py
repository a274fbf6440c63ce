"""Springs through points and contacts of Hunt and Crossley: exact forces, what they say and refuse."""

import pickle
import subprocess
import sys
from decimal import Decimal, localcontext
from fractions import Fraction

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st

import zwidth as zw
from zwidth.model.environment.nonlinear import resting_force

places = st.fractions(-2, 2, max_denominator=997)
tables = st.lists(places, min_size=2, max_size=12, unique=True).flatmap(
    lambda x: st.tuples(st.just(sorted(x)), st.lists(places, min_size=len(x), max_size=len(x)))
)


@given(tables, st.fractions(-3, 3, max_denominator=999))
def test_the_force_is_linear_between_points_and_constant_beyond(table, x):
    positions, forces = table
    spring = zw.NonlinearSpring(positions, forces)
    expected = np.interp(float(x), [float(p) for p in positions], [float(f) for f in forces])
    assert float(spring.force(x)) == pytest.approx(expected, rel=1e-9, abs=1e-9)
    assert [spring.force(p).fraction for p in positions] == forces


@given(tables)
def test_the_largest_slope_bounds_every_secant(table):
    """f(y) − f(x) ≤ s (y − x) for x < y, with equality for one pair of points; never below 0."""
    spring = zw.NonlinearSpring(*table)
    slope = spring.largest_slope.fraction
    x, f = ([v.fraction for v in values] for values in (spring.positions, spring.forces))
    secants = [(f[j] - f[i]) / (x[j] - x[i]) for i in range(len(x)) for j in range(i + 1, len(x))]
    assert slope == max(0, *secants)


def test_the_force_is_exact():
    spring = zw.NonlinearSpring([0, "0.03"], [0, Fraction(1, 3)])
    assert spring.force("0.01").fraction == Fraction(1, 9)
    assert spring.largest_slope.fraction == Fraction(100, 9)


def test_detents_are_a_triangle_wave_through_places_of_rest():
    """f = 0 and rising at 0, p, 2p; ±F a quarter of a pitch beside; nothing far away."""
    spring = zw.NonlinearSpring.detents(3, 0.02, 0.5)
    assert [float(spring.force(k * Fraction(1, 50))) for k in range(3)] == [0, 0, 0]
    quarters = [spring.force(Fraction(n, 200)) for n in range(-2, 11)]
    assert quarters == [0, -0.5, 0, 0.5, 0, -0.5, 0, 0.5, 0, -0.5, 0, 0.5, 0]
    assert spring.force(-1) == spring.force(1) == 0
    assert spring.largest_slope.fraction == 4 * Fraction(1, 2) / Fraction(2, 100)
    assert len(zw.NonlinearSpring.detents(1, 1, 1).positions) == 4


def test_a_bump_stop_hardens_and_its_chords_are_as_near_as_promised():
    """K u + H u³ at the points, above it by at most ¾ H D³/(n − 1)² between them."""
    start, k, h, depth, points = Fraction(1, 10), 200, 10**6, Fraction(2, 100), 9
    spring = zw.NonlinearSpring.bump_stop(start, k, h, depth, points)
    assert len(spring.positions) == points
    bound = Fraction(3, 4) * h * depth**3 / (points - 1) ** 2
    for n in range(101):
        u = depth * n / 100
        over = spring.force(start + u).fraction - (k * u + h * u**3)
        assert 0 <= over <= bound
    assert spring.force(0) == 0
    assert spring.force(1) == spring.forces[-1] == float(k * depth + h * depth**3)
    assert len(zw.NonlinearSpring.bump_stop(0, 1, 0, 1).positions) == 32


def test_it_is_bilateral_nonlinear_and_says_its_numbers():
    spring = zw.NonlinearSpring([-0.01, 0, 0.02], [-1, 0, 4])
    assert not any([spring.unilateral, spring.linear, spring.spring, spring.clamped])
    assert spring.is_certain
    assert spring.describe() == (
        "nonlinear spring, 3 points from -10 mm to 20 mm, force -1 N to 4 N, slope up to 200 N/m"
    )
    assert spring.describe("rotary").endswith("from -0.01 rad to 0.02 rad, force -1 N·m to 4 N·m, "
                                              "slope up to 200 N·m/rad")  # fmt: skip
    assert eval(repr(spring), vars(zw) | {"NonlinearSpring": zw.NonlinearSpring}) == spring
    assert pickle.loads(pickle.dumps(spring)) == spring
    assert spring.replace(forces=[0, 0, 0]).largest_slope == 0


def test_the_force_of_a_contact_is_exact_where_the_exponent_is_whole():
    """K uⁿ (1 + λ v) with thirds in it."""
    contact = zw.HuntCrossley(Fraction(2, 3), 2, "1.5")
    assert contact.force(Fraction(1, 7), Fraction(1, 3)).fraction == Fraction(2, 3) / 49 * Fraction(3, 2)
    assert zw.HuntCrossley(300, 1).force("0.001").fraction == Fraction(3, 10)
    assert contact.force(Fraction(-1, 7), 5) == 0
    assert contact.force(0, 5) == 0
    assert zw.HuntCrossley(1000).force("0.0009").fraction == Fraction(27, 1000)  # a sphere on a plane


def test_a_contact_lets_go_without_pulling():
    """For λ v < −1 no force, or one that pulls where it is not clamped."""
    assert zw.HuntCrossley(300, 2, 3).force("0.1", "-0.5") == 0
    assert zw.HuntCrossley(300, 2, 3, clamped=False).force("0.1", "-0.5").fraction == Fraction(-3, 2)
    assert zw.HuntCrossley(300, 2, 3).force("0.1", "-0.2").fraction == Fraction(12, 10)


@given(
    st.fractions(Fraction(1, 1000), 10**6, max_denominator=1000),
    st.fractions(1, 10, max_denominator=60),
    st.fractions(Fraction(1, 10**6), 2, max_denominator=10**6),
)
def test_a_root_is_rounded_to_seventeen_digits(k, n, u):
    """With n = a/b, the b-th power of the force is Kᵇ uᵃ, to as many digits."""
    found = resting_force(k, n, u)
    a, b = n.numerator, n.denominator
    ratio = found**b / (k**b * u**a)
    assert abs(ratio - 1) <= b * Fraction(51, 10**18)
    with localcontext(prec=60):
        assert (
            b == 1 or len((Decimal(found.numerator) / found.denominator).normalize().as_tuple().digits) <= 17
        )


def test_what_a_contact_is_and_says():
    contact = zw.HuntCrossley(2e4, "1.5", 2)
    assert (contact.unilateral, contact.clamped, contact.is_certain) == (True, True, True)
    assert (contact.linear, contact.spring) == (False, False)
    assert contact.describe() == "Hunt–Crossley contact, 20000 N/m^1.5, exponent 1.5, 2 s/m, never pulls"
    assert zw.HuntCrossley(300, 2, clamped=False).describe() == "Hunt–Crossley contact, 300 N/m², exponent 2"
    assert "300 N·m/rad, exponent 1, 2 s/rad" in zw.HuntCrossley(300, 1, 2).describe("rotary")
    assert eval(repr(contact), vars(zw) | {"HuntCrossley": zw.HuntCrossley}) == contact
    assert pickle.loads(pickle.dumps(contact)) == contact
    assert contact.replace(exponent=2).stiffness == 2e4
    units = [contact.unit_of(key) for key in ("stiffness", "exponent", "dissipation")]
    assert units == ["N/m^1.5", "1", "s/m"]


def test_they_are_loaded_when_one_is_first_used():
    """Few loops have one."""
    code = (
        "import sys, zwidth as zw; assert 'zwidth.model.environment.nonlinear' not in sys.modules; "
        "from zwidth.model.environment import NonlinearSpring as same; assert zw.NonlinearSpring is same; "
        "assert zw.HuntCrossley(1)"
    )
    assert subprocess.run([sys.executable, "-c", code]).returncode == 0


@pytest.mark.parametrize("law", [zw.NonlinearSpring([0, 1], [0, 1]), zw.HuntCrossley(1000)])
def test_there_is_no_pulse_transfer_function(law):
    with pytest.raises(zw.InputError, match=r"no H\(z\): .*zwidth\.check"):
        law.pulse_transfer_function(Fraction(1, 1000))
    with pytest.raises(zw.InputError, match="behind a coupling must be linear"):
        zw.VirtualCoupling(100, 1, law)


@pytest.mark.parametrize(
    ("make", "message"),
    [
        (lambda: zw.NonlinearSpring([0, 1], [0]), "a force at each position; got 2 and 1"),
        (lambda: zw.NonlinearSpring([0], [0]), "2 to 10000 points, got 1"),
        (lambda: zw.NonlinearSpring(range(10001), range(10001)), "2 to 10000 points, got 10001"),
        (
            lambda: zw.NonlinearSpring([0, 1, 1], [0, 1, 2]),
            r"strictly; positions\[1\] is 1 and positions\[2\]",
        ),
        (lambda: zw.NonlinearSpring("01", [0, 1]), "positions is a list of numbers, got '01'"),
        (lambda: zw.NonlinearSpring([0, 1], 5), "forces is a list of numbers, got 5"),
        (lambda: zw.NonlinearSpring([0, float("nan")], [0, 1]), r"positions\[1\] is in m: expected"),
        (lambda: zw.NonlinearSpring([0, 1], [0, True]), r"forces\[1\] is in N; got true or false"),
        (lambda: zw.NonlinearSpring([0, "1e-39"], [0, 100]), "the largest slope of a nonlinear spring: "),
        (
            lambda: zw.NonlinearSpring([0, 1], [0, 1]).force("x"),
            "position is in m; got .x.: expected a number",
        ),
        (lambda: zw.NonlinearSpring.detents(0, 1, 1), "count is a whole number from 1 to 10000, got 0"),
        (lambda: zw.NonlinearSpring.detents(2.0, 1, 1), "count is a whole number"),
        (lambda: zw.NonlinearSpring.detents(True, 1, 1), "count is a whole number"),
        (lambda: zw.NonlinearSpring.detents(1, 0, 1), "pitch must be > 0, got 0"),
        (lambda: zw.NonlinearSpring.detents(1, 1, -1), "force must be > 0, got -1"),
        (lambda: zw.NonlinearSpring.bump_stop(0, -1, 0, 1), "stiffness must be ≥ 0, got -1"),
        (lambda: zw.NonlinearSpring.bump_stop(0, 1, -1, 1), "hardening must be ≥ 0"),
        (lambda: zw.NonlinearSpring.bump_stop(0, 1, 1, 0), "depth must be > 0"),
        (lambda: zw.NonlinearSpring.bump_stop(0, 1, 1, 1, 1), "points is a whole number from 2 to 10000"),
        (lambda: zw.NonlinearSpring.bump_stop("x", 1, 1, 1), "start is in m; got .x.: expected a number"),
        (lambda: zw.HuntCrossley(-1), "stiffness must be ≥ 0"),
        (lambda: zw.HuntCrossley(float("nan")), "stiffness is a plain number: expected a finite number"),
        (lambda: zw.HuntCrossley((1, 2)), "stiffness is a plain number; got a list where a number belongs"),
        (lambda: zw.HuntCrossley(1, "0.9"), "exponent must be from 1 to 10"),
        (lambda: zw.HuntCrossley(1, 11), "exponent must be from 1 to 10"),
        (lambda: zw.HuntCrossley(1, None), "exponent is a plain number; got nothing where a number belongs"),
        (lambda: zw.HuntCrossley(1, 2, "-0.1"), "dissipation must be ≥ 0"),
        (lambda: zw.HuntCrossley(1, 2, "2 N"), "dissipation is in s/m; got .2 N., a force"),
        (lambda: zw.HuntCrossley(1, 2, 0, 1), "clamped is True"),
    ],
)
def test_bad_input_has_one_clear_message(make, message):
    with pytest.raises(zw.InputError, match=message) as error:
        make()
    assert "\n" not in str(error.value)
