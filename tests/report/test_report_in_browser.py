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


def test_no_table_is_cut_on_paper(page: Page, address: str) -> None:
    """Each is shorter than the 265 mm that A4 has between its margins, and goes to the next page whole."""
    page.goto(address)
    page.emulate_media(media="print")
    page.set_viewport_size({"width": 673, "height": 900})  # 178 mm
    tables = page.locator("table").evaluate_all(
        "all => all.map((one) => [getComputedStyle(one).breakInside, one.clientHeight, one.scrollWidth])"
    )
    assert len(tables) > 2
    assert all(kept == "avoid" and height < 1001 and width <= 673 for kept, height, width in tables)


def test_the_proof_can_be_saved(page: Page, address: str) -> None:
    page.goto(address)
    with page.expect_download() as saving:
        page.get_by_role("link", name="Save verdict.json").click()
    assert saving.value.suggested_filename == "verdict.json"
    assert '"outcome": "passive"' in Path(saving.value.path()).read_text(encoding="utf-8")
