"""Keeps the machine, its settings and its speed out of the tests; makes `from strategies import …` work."""

from __future__ import annotations

import os
from collections.abc import Iterator
from pathlib import Path

import pytest
from hypothesis import HealthCheck, settings

# no window, and no settings of one's own for pictures: before anything imports matplotlib
os.environ["MPLBACKEND"] = "agg"
os.environ["MATPLOTLIBRC"] = str(Path(__file__).parent / "matplotlibrc")

settings.register_profile(
    "explore",  # --hypothesis-profile=explore: other examples in every run
    deadline=None,  # a busy machine, or one that compiles first, is no mistake
    suppress_health_check=[HealthCheck.too_slow],
    print_blob=True,
)
settings.register_profile("same", settings.get_profile("explore"), derandomize=True, database=None)
settings.load_profile("same")

_TERMINAL = (
    "CLICOLOR_FORCE",
    "FORCE_COLOR",
    "NO_COLOR",
    "PYTHON_COLORS",
    "TTY_COMPATIBLE",
    "TTY_INTERACTIVE",
)


@pytest.fixture(scope="session", autouse=True)
def _plain_terminal() -> Iterator[None]:
    """What is printed is 80 columns wide and has no colours, wherever the tests run."""
    with pytest.MonkeyPatch.context() as patch:
        patch.setenv("COLUMNS", "80")
        for name in _TERMINAL:
            patch.delenv(name, raising=False)
        yield


@pytest.fixture(scope="session", autouse=True)
def _time_enough() -> Iterator[None]:
    """A game that is to be decided is decided, also on a busy machine and where it is compiled first."""
    with pytest.MonkeyPatch.context() as patch:
        patch.setattr("zwidth.passivity.game.SECONDS", 60.0)
        patch.setattr("zwidth.maps.workers._PATIENCE", "600 s")
        yield
