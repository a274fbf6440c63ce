"""What the checker read, for people: rounded, with prefixes, below the figures; the file has every digit."""

from __future__ import annotations

import json
import re
from pathlib import Path

import pytest

import zwidth as zw
from zwidth.cli.main import main
from zwidth.passivity.verdict import Verdict
from zwidth.show.report.contents import as_read

STOP = """
[environment]
type = "nonlinear-spring"
positions = ["7.85 rad", "7.9 rad", "8 rad"]
forces = [0, 20, 70]
"""
WHEEL = """
[device]
inertia = "0.006 kg*m^2"
damping = "0.05 N*m*s/rad"
counts_per_turn = 65536
rate = "1 kHz"
"""


@pytest.mark.parametrize(
    ("text", "unit", "shown"),
    [
        ("0.00009587379924285257", "rad", "95.8738 µrad"),
        ("24.54369260617025792", "rad/s", "24.5437 rad/s"),
        ("0.001", "s", "1 ms"),
        ("1/3", "N·m", "0.333333 N·m"),
        ("[]", "N·m/rad", "none"),
        ("[0.15000000001, -1/3]", "N/m", "[0.15, -0.333333] N/m"),
        (
            "[[7.85398163, 0], [7.86096295, 3.14159265], [8, 9], [10, 11]]",
            "rad",
            "[[7.85398, 0], [7.86096, 3.14159], [8, 9], …] rad",
        ),
        (
            "[[7.85398163, 0], [7.86096295, 3.14159265], [10.123456, 11]]",
            "",
            "[[7.85398, 0], [7.86096, 3.14159], …]",
        ),
        ("made-and-broken", "", "made-and-broken"),
        ("1" * 400, "s", f"{'1' * 44} s"),
    ],
)
def test_a_value_is_written_as_people_read_it(text: str, unit: str, shown: str) -> None:
    assert as_read(text, unit) == shown


def _rows(page: str) -> dict[str, str]:
    section = page.partition("<h2>What the checker read</h2>")[2].partition("</section>")[0]
    return dict(re.findall(r"<th[^>]*>([^<]*)</th><td[^>]*>([^<]*)</td>", section))


def test_it_stands_after_the_figures_and_says_where_every_digit_is(active: Verdict, active_page: str) -> None:
    assert active_page.index("<h2>Figures</h2>") < active_page.index("<h2>What the checker read</h2>")
    assert "the proof is about the exact numbers, which stand in verdict.json" in active_page
    rows, document = _rows(active_page), json.dumps(active.saved(), default=str)
    assert not [text for text in rows.values() if re.search(r"\d{8}", text) or "[]" in text]
    assert rows["resolution"] == "22.4 µm"
    assert "0.0000224" in document


def test_the_title_is_short_and_names_the_files(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.chdir(tmp_path)
    Path("my-wheel.toml").write_text(WHEEL, encoding="utf-8")
    Path("my-stop.toml").write_text(STOP, encoding="utf-8")
    main(["report", "my-wheel.toml", "my-stop.toml", "-o", "a.html"])
    page = Path("a.html").read_text(encoding="utf-8")
    assert "<h1>my-wheel: nonlinear spring (my-stop.toml)</h1>" in page
    assert "nonlinear spring, 3 points from 7.85 rad to 8 rad" in page.partition("</h1>")[2]
    Path("named.toml").write_text(WHEEL.replace("[device]", '[device]\nname = "a wheel"'), encoding="utf-8")
    main(["report", "named.toml", "--stiffness", "20", "-o", "b.html"])
    assert "<h1>a wheel: wall, 20 N·m/rad</h1>" in Path("b.html").read_text(encoding="utf-8")
    rotary = zw.rotary(damping=0.05, rate=1000)
    assert "<h1>A rotary device: wall, 20 N·m/rad</h1>" in zw.report.html(zw.check(rotary, zw.Wall(20)))
