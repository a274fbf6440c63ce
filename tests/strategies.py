"""Hypothesis strategies that several test files share."""

from __future__ import annotations

from collections.abc import Callable
from decimal import Decimal
from fractions import Fraction
from typing import Any

from hypothesis import Phase, given, settings
from hypothesis import strategies as st

import zwidth as zw


def seeds(number: int) -> Callable[[Callable[..., None]], Callable[..., None]]:
    """Runs a test for so many seeds of its random numbers; the one that fails is named."""

    def decorated(test: Callable[..., None]) -> Callable[..., None]:
        # no seed is simpler than another: to shrink one would take long and tell nothing
        limits = settings(max_examples=number, phases=(Phase.explicit, Phase.reuse, Phase.generate))
        return limits(given(seed=st.integers(0, 10**9))(test))

    return decorated


def decimals(low: str, high: str, places: int = 6) -> st.SearchStrategy[Decimal]:
    """Numbers as a person types them, of either end included."""
    return st.decimals(Decimal(low), Decimal(high), places=places, allow_nan=False, allow_infinity=False)


def zero_or(low: float, high: float) -> st.SearchStrategy[float]:
    """Nothing, or a number that a physical quantity may have."""
    return st.just(0.0) | st.floats(low, high)


def fractions(low: str = "0.001", high: str = "1000") -> st.SearchStrategy[Fraction]:
    """Positive rationals with modest denominators."""
    return st.fractions(Fraction(low), Fraction(high), max_denominator=10**6)


@st.composite
def devices(draw: st.DrawFn, **fixed: Any) -> zw.Device:
    """Certain linear devices with typical numbers; `fixed` arguments are kept."""
    drawn: dict[str, Any] = {
        "mass": draw(decimals("0.001", "2")),
        "damping": draw(decimals("0.001", "2")),
        "coulomb_friction": draw(decimals("0", "1")),
        "resolution": draw(decimals("0", "0.001", places=8)),
        "sample_period": draw(decimals("0.0001", "0.01")),
        "delay": draw(decimals("0", "0.005")),
    }
    return zw.Device(**{**drawn, **fixed})


WORDS = (
    *("device", "environment", "type", "wall", "damping", "rate", "stiffness"),
    *("1 kHz", "22.4 um", "0.1..0.2", "nan", "-1", "1e999", "µm", "N*s/m", "one-pole", ""),
)
"""Words near to valid input, where a parser is most easily confused."""


def texts() -> st.SearchStrategy[str]:
    """Any text, and texts made of words that mean something."""
    return st.text(max_size=60) | st.lists(st.sampled_from(WORDS), max_size=4).map(" ".join)


def toml_values() -> st.SearchStrategy[Any]:
    """Whatever tomllib may return, dates apart, nested three deep."""
    numbers = st.sampled_from([1, 300, Decimal("0.15"), 10**4000, Decimal("1e-99999")])
    leaves = texts() | st.booleans() | st.integers() | st.decimals() | numbers

    def nested(inner: st.SearchStrategy[Any]) -> st.SearchStrategy[Any]:
        return st.lists(inner, max_size=3) | st.dictionaries(texts(), inner, max_size=3)

    return st.recursive(leaves, nested, max_leaves=8)
