"""What is printed here does not depend on whether something has been compiled before."""

from __future__ import annotations

from collections.abc import Iterator

import pytest


@pytest.fixture(scope="session", autouse=True)
def compiled_before() -> Iterator[None]:
    """Nobody is told to wait for the compiler."""
    with pytest.MonkeyPatch.context() as patch:
        patch.setattr("zwidth.compiled.is_compiled", lambda chapter: True)
        yield
