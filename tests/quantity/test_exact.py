"""A number means the decimal that a person typed."""

import copy
import pickle
from decimal import Decimal
from fractions import Fraction

import pytest
from hypothesis import given
from hypothesis import strategies as st

from zwidth.errors import InputError
from zwidth.quantity.exact import LARGEST_EXPONENT, Exact, Interval, as_parameter, ends


@pytest.mark.parametrize("value", [0.15, "0.15", Decimal("0.15"), Fraction(3, 20), Exact("0.15")])
def test_every_spelling_of_a_number_is_the_same(value):
    """0.15 is 3/20, not the binary number next to it."""
    number = Exact(value)
    assert number.fraction == Fraction(3, 20)
    assert number == 0.15


@given(st.floats(1e-30, 1e30))
def test_a_float_stands_for_its_shortest_decimal(value):
    number = Exact(value)
    assert float(number) == value
    assert number.fraction == Fraction(repr(value))


@pytest.mark.parametrize("clone", [copy.copy, copy.deepcopy, lambda x: pickle.loads(pickle.dumps(x))])
def test_copies_stay_exact(clone):
    assert clone(Exact(Fraction(1, 3))).fraction == Fraction(1, 3)


@pytest.mark.parametrize("value", [True, None, "x", "", float("inf"), "nan", [], {}, 1j])
def test_what_is_no_finite_number_is_refused(value):
    with pytest.raises(InputError, match="number"):
        Exact(value)


@pytest.mark.parametrize("sign", [1, -1])
def test_the_bounds_of_the_magnitude(sign):
    """Accepted at 1e-40 and 1e40, refused just beyond."""
    limit = Fraction(10) ** LARGEST_EXPONENT
    for inside in (limit, 1 / limit, Fraction(0)):
        assert Exact(sign * inside).fraction == sign * inside
    for outside in (limit + 1, 1 / (limit + 1)):
        with pytest.raises(InputError, match="magnitudes"):
            Exact(sign * outside)


def test_intervals_are_ordered_and_closed():
    assert ends(Interval(1, 1)) == (1, 1)
    assert ends(as_parameter((0.1, 0.2))) == (Fraction(1, 10), Fraction(1, 5))
    with pytest.raises(InputError, match="swap"):
        Interval(Fraction(1, 3), Fraction(1, 3) - Fraction(1, 10**30))
    with pytest.raises(InputError, match="two ends"):
        as_parameter((1, 2, 3))
