"""The report in a browser: wide and narrow, light and dark, for everybody."""

from __future__ import annotations

from pathlib import Path

import pytest
from browser import complaints_of_access
from playwright.sync_api import Page


@pytest.fixture(scope="module")
def address(hostile_page: str, tmp_path_factory: pytest.TempPathFactory) -> str:
    path: Path = tmp_path_factory.mktemp("report") / "report.html"
    path.write_text(hostile_page, encoding="utf-8")
    return path.as_uri()


def test_nothing_stands_in_the_way_of_a_reader(page: Page, address: str) -> None:
    page.goto(address)
    assert page.evaluate("document.documentElement.scrollWidth <= innerWidth")
    assert page.evaluate("[...document.images].every(i => i.complete && i.naturalWidth > 100)")
    for scheme in ("light", "dark"):
        page.emulate_media(color_scheme=scheme)  # type: ignore[arg-type]
        found = complaints_of_access(page)
        assert not [(one["id"], one["impact"]) for one in found], scheme


def test_the_proof_can_be_saved(page: Page, address: str) -> None:
    page.goto(address)
    with page.expect_download() as saving:
        page.get_by_role("link", name="Save verdict.json").click()
    assert saving.value.suggested_filename == "verdict.json"
    assert '"outcome": "passive"' in Path(saving.value.path()).read_text(encoding="utf-8")
