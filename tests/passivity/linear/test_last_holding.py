"""The last value that holds, found from wherever the search begins."""

from __future__ import annotations

from fractions import Fraction
from math import inf

import pytest
from hypothesis import given
from hypothesis import strategies as st

from zwidth.passivity.linear.boundary import COARSE, largest_holding, smallest_holding

ANYWHERE = st.floats(1e-14, 1e14)


@given(limit=ANYWHERE, guess=ANYWHERE, likely=st.none() | ANYWHERE | st.sampled_from([0.0, inf]))
def test_what_is_likely_changes_no_answer(limit: float, guess: float, likely: float | None) -> None:
    """However wrong it is: to the last double the limit is found, from both sides."""
    at = Fraction(repr(limit))
    assert largest_holding(lambda value: value <= at, guess, likely=likely) == limit
    assert smallest_holding(lambda value: value >= at, guess, likely=likely) == limit


@given(limit=ANYWHERE, guess=ANYWHERE, off=st.floats(-1e-9, 1e-9))
def test_in_coarse_steps_it_holds_and_is_near(limit: float, guess: float, off: float) -> None:
    """On the side that holds, within a grain."""
    at = Fraction(repr(limit))
    near = limit * (1 + off)
    low = largest_holding(lambda value: value <= at, guess, COARSE, near)
    high = smallest_holding(lambda value: value >= at, guess, COARSE, near)
    assert limit * (1 - 5e-7) <= low <= limit <= high <= limit * (1 + 5e-7)


@pytest.mark.parametrize("likely", [None, 0.0, 3.0, inf])
def test_where_all_or_nothing_holds_it_is_said(likely: float | None) -> None:
    """inf, 0 and None, whatever was likely."""
    assert largest_holding(lambda value: True, 2.0, likely=likely) == inf
    assert largest_holding(lambda value: value == 0, 2.0, likely=likely) == 0
    assert largest_holding(lambda value: False, 2.0, likely=likely) is None
    assert smallest_holding(lambda value: True, 2.0, likely=likely) == 0
    assert smallest_holding(lambda value: False, 2.0, likely=likely) is None


def test_where_it_is_likely_few_decisions_do() -> None:
    """Four in place of thirty."""
    asked = []

    def holds(value: Fraction) -> bool:
        asked.append(value)
        return value <= Fraction("312.5")

    assert largest_holding(holds, 7.0, COARSE, 312.5) == 312.5
    assert len(asked) <= 4
