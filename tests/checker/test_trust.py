"""What the page for the sceptic says: its lines are counted, its program runs, what was read is shown."""

from __future__ import annotations

import json
import re
import sys
from fractions import Fraction
from pathlib import Path
from typing import Any

import pytest

import zwidth as zw
from zwidth import checker
from zwidth.checker.kinds import KINDS
from zwidth.quantity.text import to_json

DOCS = Path(__file__).resolve().parents[2] / "docs"
DEVICE = zw.Device(damping="0.2", sample_period="0.001", coulomb_friction=0, resolution=0)
LAW = zw.PulseTransferFunction([300, -150], [1, "-0.2"])


@pytest.fixture(scope="module")
def certificate() -> dict[str, Any]:
    """Of the law that the page takes for an example."""
    found = zw.check(DEVICE, LAW).certificate
    assert found is not None
    read: dict[str, Any] = json.loads(to_json(found.to_dict()))
    return read


def test_the_program_of_the_page_finds_one_ratio(
    certificate: dict[str, Any],
    tmp_path: Path,
    monkeypatch: pytest.MonkeyPatch,
    capsys: pytest.CaptureFixture[str],
) -> None:
    """> 0 at every frequency; with a factor that was changed it finds several."""
    page = (DOCS / "theory" / "certificates.md").read_text(encoding="utf-8")
    (program,) = re.findall(r"```python\n(.*?)```", page, re.DOTALL)
    monkeypatch.chdir(tmp_path)

    def ratios(document: dict[str, Any]) -> tuple[float, float]:
        Path("proof.json").write_text(json.dumps({"certificate": document}), encoding="utf-8")
        exec(program, {})
        low, high = map(float, capsys.readouterr().out.split())
        return low, high

    low, high = ratios(certificate)
    assert 0 < low == pytest.approx(high, rel=1e-9)
    false = json.loads(json.dumps(certificate))
    false["proof"]["positivity"]["factor"][0] = str(
        Fraction(str(false["proof"]["positivity"]["factor"][0])) * 2
    )
    low, high = ratios(false)
    assert high > 1.01 * low


def test_every_kind_has_its_files(monkeypatch: pytest.MonkeyPatch) -> None:
    """Arrays stand behind storage functions alone, and no kind needs the files of all."""
    monkeypatch.syspath_prepend(str(DOCS / "_ext"))
    trust = __import__("trust")
    monkeypatch.delitem(sys.modules, "trust")
    for kind in KINDS:
        files = trust.files_of(kind)
        assert any(file.parent.name == "storage" for file in files) is ("storage" in kind)
        assert sum(map(trust.lines_in, files)) < trust.total() / 2
        assert {"__init__.py", "kinds.py", "scope.py", "fields.py"} <= {file.name for file in files}


def test_what_is_shown_is_what_was_read(certificate: dict[str, Any]) -> None:
    """Name, number and unit of every entry of the loop; nothing of the proof."""
    rows = checker.verify({**certificate, "format": "any words"}).rows
    shown = {row.name: (row.text, row.unit) for row in rows}
    assert shown == {
        "damping": ("0.2", "N·s/m"),
        "coulomb friction": ("0", "N"),
        "resolution": ("0", "m"),
        "sample period": ("0.001", "s"),
        "delay": ("0", "s"),
        "numerator": ("[1500, -750]", ""),
        "denominator": ("[5, -1]", ""),
        "unilateral": ("no", ""),
    }
    assert not any(row.told for row in rows)
