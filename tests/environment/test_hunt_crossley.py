"""The Hunt–Crossley contact: exact forces, units, what it is not, bad input."""

from __future__ import annotations

import pickle
import subprocess
import sys
from decimal import Decimal, localcontext
from fractions import Fraction

import pytest
from hypothesis import given
from hypothesis import strategies as st

import zwidth as zw
from zwidth.model.environment.nonlinear import resting_force

PADDLE = zw.catalogue.device("haptic-paddle")


def test_the_force_is_exact_where_the_exponent_is_whole() -> None:
    """K uⁿ (1 + λ v) with thirds in it."""
    contact = zw.HuntCrossley(Fraction(2, 3), 2, "1.5")
    assert contact.force(Fraction(1, 7), Fraction(1, 3)).fraction == Fraction(2, 3) / 49 * Fraction(3, 2)
    assert zw.HuntCrossley(300, 1).force("0.001").fraction == Fraction(3, 10)
    assert contact.force(Fraction(-1, 7), 5) == 0
    assert contact.force(0, 5) == 0


def test_a_contact_lets_go_without_pulling() -> None:
    """For λ v < −1 no force, or one that pulls where it is not clamped."""
    assert zw.HuntCrossley(300, 2, 3).force("0.1", "-0.5") == 0
    assert zw.HuntCrossley(300, 2, 3, clamped=False).force("0.1", "-0.5").fraction == Fraction(-3, 2)
    assert zw.HuntCrossley(300, 2, 3).force("0.1", "-0.2").fraction == Fraction(12, 10)


@given(
    st.fractions(Fraction(1, 1000), 10**6, max_denominator=1000),
    st.fractions(1, 10, max_denominator=60),
    st.fractions(Fraction(1, 10**6), 2, max_denominator=10**6),
)
def test_a_root_is_rounded_to_seventeen_digits(k: Fraction, n: Fraction, u: Fraction) -> None:
    """With n = a/b, the b-th power of the force is Kᵇ uᵃ, to as many digits."""
    found = resting_force(k, n, u)
    a, b = n.numerator, n.denominator
    ratio = found**b / (k**b * u**a)
    assert abs(ratio - 1) <= b * Fraction(51, 10**18)
    with localcontext(prec=60):
        assert (
            b == 1 or len((Decimal(found.numerator) / found.denominator).normalize().as_tuple().digits) <= 17
        )


def test_a_sphere_on_a_plane_by_default() -> None:
    """n = 3/2: √ of a square is exact."""
    assert zw.HuntCrossley(1000).force("0.0009").fraction == Fraction(27, 1000)


def test_what_it_is_and_says() -> None:
    contact = zw.HuntCrossley(2e4, "1.5", 2)
    assert contact.unilateral
    assert contact.clamped
    assert contact.is_certain
    assert not contact.linear
    assert not contact.spring
    assert contact.describe() == "Hunt–Crossley contact, 20000 N/m^1.5, exponent 1.5, 2 s/m, never pulls"
    assert zw.HuntCrossley(300, 2, clamped=False).describe() == "Hunt–Crossley contact, 300 N/m², exponent 2"
    assert "300 N·m/rad, exponent 1, 2 s/rad" in zw.HuntCrossley(300, 1, 2).describe("rotary")
    assert eval(repr(contact), vars(zw) | {"HuntCrossley": zw.HuntCrossley}) == contact
    assert pickle.loads(pickle.dumps(contact)) == contact
    assert contact.replace(exponent=2).stiffness == 2e4
    units = [contact.unit_of(key) for key in ("stiffness", "exponent", "dissipation")]
    assert units == ["N/m^1.5", "1", "s/m"]


def test_there_is_no_pulse_transfer_function() -> None:
    contact = zw.HuntCrossley(1000)
    with pytest.raises(zw.InputError, match=r"no H\(z\): .*zwidth\.check"):
        contact.pulse_transfer_function(Fraction(1, 1000))
    with pytest.raises(zw.InputError, match="behind a coupling must be linear"):
        zw.VirtualCoupling(100, 1, contact)


def test_it_is_loaded_when_it_is_first_used() -> None:
    code = (
        "import sys, zwidth as zw; assert 'zwidth.model.environment.nonlinear' not in sys.modules; "
        "zw.HuntCrossley(1); assert 'zwidth.model.environment.nonlinear' in sys.modules"
    )
    assert subprocess.run([sys.executable, "-c", code]).returncode == 0


@pytest.mark.parametrize(
    ("arguments", "said"),
    [
        ((-1,), "stiffness must be ≥ 0"),
        ((float("nan"),), "stiffness is a plain number: expected a finite number"),
        (((1, 2),), "stiffness is a plain number; got a list where a number belongs"),
        ((1, "0.9"), "exponent must be from 1 to 10"),
        ((1, 11), "exponent must be from 1 to 10"),
        ((1, None), "exponent is a plain number; got nothing where a number belongs"),
        ((1, 2, "-0.1"), "dissipation must be ≥ 0"),
        ((1, 2, "2 N"), "dissipation is in s/m; got .2 N., a force"),
        ((1, 2, 0, 1), "clamped is True"),
    ],
)
def test_bad_input(arguments: tuple, said: str) -> None:
    with pytest.raises(zw.InputError, match=said) as error:
        zw.HuntCrossley(*arguments)
    assert "\n" not in str(error.value)
