"""A browser for the tests of pages: the Chromium of this machine, without a window.

Where there is none a test that needs it is skipped, and fails where ZWIDTH_EVERY_TARGET is set.
"""

from __future__ import annotations

import os
import shutil
from collections.abc import Iterator
from typing import Any

import pytest
from playwright.sync_api import Browser, Page, sync_playwright

PATIENCE = 120_000
"""For what a page will do, on a machine that has much else to do [ms]."""

WIDE = {"width": 1280, "height": 800}
NARROW = {"width": 390, "height": 844}


def _chromium() -> str:
    found = shutil.which("chromium") or shutil.which("chromium-browser") or shutil.which("google-chrome")
    if found is None:
        reason = "not on this machine: chromium"
        if os.environ.get("ZWIDTH_EVERY_TARGET"):
            pytest.fail(reason)
        pytest.skip(reason)
    return found


@pytest.fixture(scope="module")
def browser() -> Iterator[Browser]:
    """Chromium; --no-sandbox since tests may run as root, in a container.

    It ends with its module: while it runs this thread has an event loop, and no other test may have one.
    """
    path = _chromium()
    with sync_playwright() as playwright:
        started = playwright.chromium.launch(executable_path=path, args=["--no-sandbox"], timeout=PATIENCE)
        yield started
        started.close()


@pytest.fixture(params=[WIDE, NARROW], ids=["1280x800", "390x844"])
def page(browser: Browser, request: pytest.FixtureRequest) -> Iterator[Page]:
    """A page of either size; what its console complains of fails the test, and so does a request abroad."""
    complaints: list[str] = []
    opened = browser.new_page(viewport=request.param)
    opened.set_default_timeout(PATIENCE)
    opened.on("console", lambda m: complaints.append(m.text) if m.type == "error" else None)
    opened.on("pageerror", lambda e: complaints.append(str(e)))
    opened.on("request", lambda r: None if _near(r.url) else complaints.append(f"asks for {r.url}"))
    yield opened
    opened.close()
    assert not complaints


def complaints_of_access(page: Page) -> list[dict[str, Any]]:
    """What axe finds: people read it by keyboard, ear and little contrast."""
    try:
        from axe_playwright_python.sync_playwright import Axe
    except UnicodeDecodeError:
        pytest.skip("the package of axe reads its own script in the encoding of the locale, which has no ©")
    found: list[dict[str, Any]] = Axe().run(page).response["violations"]
    return found


def _near(url: str) -> bool:
    return url.startswith(
        ("data:", "blob:", "about:", "file:", "http://127.0.0.1:", "http://localhost:", "ws:")
    )
