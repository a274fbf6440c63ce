"""`zwidth report`: decides as `zwidth check`, and writes one file."""

from __future__ import annotations

import re
from base64 import b64decode
from pathlib import Path

import pytest

import zwidth as zw
from zwidth.cli.main import main

PADDLE = ["haptic-paddle", "--damping", "0.16"]


@pytest.fixture(scope="module", autouse=True)
def undrawn() -> object:
    """Pictures take their time, and are looked at in tests/report."""
    with pytest.MonkeyPatch.context() as patch:
        patch.setattr("zwidth.show.report.html_page.pictures", lambda verdict: [])
        yield patch


@pytest.mark.parametrize(("stiffness", "status"), [("300", 0), ("770", 1)])
def test_the_status_is_that_of_check(
    stiffness: str, status: int, tmp_path: Path, capsys: pytest.CaptureFixture[str]
) -> None:
    """One line says the outcome, the next which file was written."""
    path = tmp_path / "report.html"
    assert main(["report", *PADDLE, "--stiffness", stiffness, "-o", str(path)]) == status
    *said, written = capsys.readouterr().out.splitlines()
    verdict = zw.check(zw.catalogue.device("haptic-paddle", damping="0.16"), zw.Wall(int(stiffness)))
    assert " ".join(said) == f"{verdict.outcome}: {verdict.claim}"
    assert written == f"written: {path}"
    page = path.read_text(encoding="utf-8")
    assert f"zwidth report haptic-paddle --damping 0.16 --stiffness {stiffness} -o report.html" in page
    assert "typed: --damping 0.16" in page


def test_what_is_asked_beside_the_loop_is_asked_again(tmp_path: Path) -> None:
    """Laws, contact and negative numbers stand in the command of the report, and what it says holds there."""
    path = tmp_path / "a.html"
    asked = ["--rate", "1 kHz", "--damping", "0.5", "--stiffness", "100", "--virtual-damping", "-0.01"]
    assert main(["report", *asked, "--contact", "kept", "-o", str(path)]) == 0
    page = path.read_text(encoding="utf-8")
    assert "--contact kept --damping 0.5" in page
    assert "--virtual-damping=-0.01" in page
    assert "contact is kept: the hand stays inside" in page
    assert main(["report", *asked[:6], "--law", "force-bounding", "-o", str(path), "--force"]) in (0, 1, 3, 4)
    assert "typed: --law force-bounding" in path.read_text(encoding="utf-8")


def test_the_proof_of_a_page_is_verified(tmp_path: Path, capsys: pytest.CaptureFixture[str]) -> None:
    """What its link saves, `zwidth verify` takes."""
    path = tmp_path / "report.html"
    main(["report", *PADDLE, "--stiffness", "300", "-o", str(path)])
    found = re.search(r"data:application/json;base64,([\w+/=]+)", path.read_text(encoding="utf-8"))
    assert found
    (tmp_path / "verdict.json").write_bytes(b64decode(found[1]))
    assert main(["verify", str(tmp_path / "verdict.json")]) == 0
    capsys.readouterr()


@pytest.mark.parametrize(
    ("options", "message"),
    [
        (["-o", "report.txt"], "written as .html"),
        (["-o", "report.pdf"], "print it to PDF from the browser"),
        (["-o", "there.html"], "exists"),
        (["-o", "nowhere/report.html"], "no directory"),
        ([], "-o/--save"),
        (["-o", "report.html", "--stiffness", "stiff"], "stiff"),
    ],
)
def test_bad_input_is_one_line_and_writes_nothing(
    options: list[str],
    message: str,
    tmp_path: Path,
    monkeypatch: pytest.MonkeyPatch,
    capsys: pytest.CaptureFixture[str],
) -> None:
    """Before anything is computed."""
    monkeypatch.chdir(tmp_path)
    Path("there.html").write_text("kept", encoding="utf-8")
    stiffness = [] if "--stiffness" in options else ["--stiffness", "300"]
    assert main(["report", *PADDLE, *stiffness, *options]) == 2
    said = capsys.readouterr().err
    assert message in said
    assert said.count("\n") == 1
    assert [path.name for path in tmp_path.iterdir()] == ["there.html"]
    assert Path("there.html").read_text(encoding="utf-8") == "kept"


PAIR = """
[device]
catalogue = "haptic-paddle"
[coupling]
stiffness = 100
"""


def test_a_file_of_two_arms_has_a_report(tmp_path: Path, capsys: pytest.CaptureFixture[str]) -> None:
    """Its numbers stand in it; one beside it would be ignored, and is refused."""
    (tmp_path / "arms.toml").write_text(PAIR, encoding="utf-8")
    asked = ["report", str(tmp_path / "arms.toml"), "-o", str(tmp_path / "report.html")]
    assert main(asked) == 0
    page = (tmp_path / "report.html").read_text(encoding="utf-8")
    assert "No motion of two hands" in page
    assert "zwidth report arms.toml -o report.html" in page
    capsys.readouterr()
    assert main([*asked, "--force", "--stiffness", "50"]) == 2
    assert "stand in their file" in capsys.readouterr().err
