"""What the page on scenes says is what comes out."""

from __future__ import annotations

import re
from pathlib import Path
from typing import Any

import pytest

PAGE = Path(__file__).parents[2] / "docs" / "scenes.md"


def test_the_examples_of_the_page_run(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.chdir(tmp_path)
    names: dict[str, Any] = {}
    page = PAGE.read_text(encoding="utf-8")
    for code in re.findall(r"```python\n(.*?)```", page, re.DOTALL):
        exec(code, names)
    verdict = names["zw"].check(names["device"], names["coupled"])
    assert verdict.outcome == "passive"
    assert verdict.needs[0].needed == pytest.approx(0.45)
    run = names["run"]
    assert f"{1e3 * run.positions['drawer']:.1f} mm" in page
    account, words = run.account(), " ".join(page.split())
    for title, *numbers in zip(
        account.element.values, *(account[name].values for name in ("work", "stored", "lost")), strict=True
    ):
        assert " ".join([title, *(f"{abs(n):.6f}" for n in numbers)]) in words
    assert Path("drawer.png").exists()
    assert [part.name for part in names["parts"].parts] == ["hand", "rest"]
