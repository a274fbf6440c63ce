"""Pages of the gallery that use the bench take the time that they need."""

from __future__ import annotations

import pytest


@pytest.fixture(scope="session", autouse=True)
def _on_the_bench(time_enough_on_the_bench: None) -> None:
    """Its games are decided."""
