"""Units as recordings spell them."""

from __future__ import annotations

import pytest

from zwidth.quantity.units import spelled, unit_of


@pytest.mark.parametrize(
    ("written", "meant"),
    [("msec", "ms"), (" µm ", "um"), ("°", "deg"), ("Nm", "N*m"), ("mN·m", "mN*m"), ("N mm", "N*mm")],
)
def test_a_spelling_is_the_unit_that_is_meant(written, meant):
    assert unit_of(spelled(written)) == unit_of(meant)


def test_what_is_no_unit_is_left_as_it_is():
    assert spelled("parsec") == "parsec"
