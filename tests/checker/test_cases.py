"""Every case of `cases/`: what holds by equality is accepted, what fails by a part in 10⁹ is refused."""

from __future__ import annotations

import pytest
from cases import Case, all_cases, failure

from zwidth import checker


@pytest.mark.parametrize("case", all_cases(), ids=lambda case: case.name)
def test_a_case(case: Case) -> None:
    """The checker accepts what is true, with the facts that are named, and refuses what is false."""
    assert failure(case, checker.verify) == ""
