"""Reports are looked at in a browser; one of each kind is enough for most tests."""

from __future__ import annotations

import pytest
from browser import browser as browser
from browser import page as page

import zwidth as zw
from zwidth.passivity.verdict import Verdict

PADDLE = zw.catalogue.device("haptic-paddle")
HOSTILE = "<script>alert(1)</script> & $\\frac{$ \x1b[2J \u202e\"'"


@pytest.fixture(scope="session")
def active() -> Verdict:
    return zw.check(PADDLE, zw.Wall(770))


@pytest.fixture(scope="session")
def hostile() -> Verdict:
    """A passive loop of a device whose name would be obeyed, if anything did."""
    return zw.check(PADDLE.replace(name=HOSTILE), zw.Wall(200, 0.01))


@pytest.fixture(scope="session")
def active_page(active: Verdict) -> str:
    return zw.report.html(active)


@pytest.fixture(scope="session")
def hostile_page(hostile: Verdict) -> str:
    return zw.report.html(hostile)
