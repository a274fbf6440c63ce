"""What a header declares of itself is read as its compiler reads it."""

from __future__ import annotations

import pytest
from firmware.baselines.read import text
from firmware.emulated.built import defined


@pytest.mark.parametrize(
    ("written", "number"),
    [("1.0", 1.0), ("0x1p-20", 2.0**-20), ("9.5e-07f", 9.5e-07), ("(-32767)", -32767.0), ("+3", 3.0)],
)
def test_numbers_of_a_header(written: str, number: float) -> None:
    assert (
        defined(f"#define LAW_FORCE 2\n  #define TOUCH_FORCE_PER_UNIT  {written}\n", "FORCE_PER_UNIT")
        == number
    )


def test_a_header_without_the_number() -> None:
    assert defined(text("fixed16"), "FORCE_LIMIT") == 16.5
    with pytest.raises(AssertionError, match="FORCE_STEP"):
        defined(text("fixed16"), "FORCE_STEP")
