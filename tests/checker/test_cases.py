"""Every case of `cases/`: what holds by equality is accepted, what fails by a part in 10⁹ is refused."""

from __future__ import annotations

import pytest
from cases import cases_of, failure, files

from zwidth import checker


@pytest.mark.parametrize("file", files())
def test_the_cases_of_a_file(file: str) -> None:
    """The checker accepts what is true, with the facts that are named, and refuses what is false."""
    said = {case.name: failure(case, checker.verify) for case in cases_of(file)}
    assert said
    assert {name: wrong for name, wrong in said.items() if wrong} == {}
