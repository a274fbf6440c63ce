"""The keyword `clamped`: what it says, what it leaves alone, what it refuses."""

from __future__ import annotations

import pickle
from fractions import Fraction

import pytest

import zwidth as zw

LAWS = [
    zw.Wall(300, 0.5),
    zw.StandardLinearSolid(290, 731, 40),
    zw.Maxwell(731, 40),
    zw.GeneralizedMaxwell(290, [(731, 40), (5, 2)]),
]


NAMES = {name: getattr(zw.rendering, name) for name in zw.rendering.__all__} | vars(zw)


@pytest.mark.parametrize("law", LAWS)
def test_a_clamped_law_is_another_law_with_the_same_pulse_transfer_function(law) -> None:
    clamped = law.replace(clamped=True)
    period = Fraction(1, 1000)
    assert (law.clamped, clamped.clamped) == (False, True)
    assert clamped != law
    assert clamped.pulse_transfer_function(period) == law.pulse_transfer_function(period)
    assert clamped.describe() == law.describe() + ", never pulls"
    assert clamped.describe("rotary") == law.describe("rotary") + ", never pulls"
    assert pickle.loads(pickle.dumps(clamped)) == clamped
    assert eval(repr(clamped), NAMES) == clamped


@pytest.mark.parametrize("law", LAWS)
@pytest.mark.parametrize("value", [1, 0, None, "true", 1.0])
def test_only_a_bool_says_whether_a_law_is_clamped(law, value) -> None:
    """1 or "true" could be a slip for another argument."""
    with pytest.raises(zw.InputError, match="clamped is True for a law that never pulls, or False; got"):
        law.replace(clamped=value)


def test_laws_without_the_keyword_may_pull() -> None:
    assert not zw.PulseTransferFunction([1], [1]).clamped


def test_no_clamped_law_stands_behind_a_coupling() -> None:
    """The joint of the two would come loose: their H(z) does not say how."""
    with pytest.raises(zw.InputError, match=r"must be linear, .* never pulls"):
        zw.VirtualCoupling(100, 1, zw.Wall(300, clamped=True))
