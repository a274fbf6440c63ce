"""`zwidth report`: decides as `zwidth check`, and writes one file."""

import re
from base64 import b64decode
from pathlib import Path

import pytest

import zwidth as zw

PADDLE = "haptic-paddle --damping 0.16"


@pytest.fixture(scope="module", autouse=True)
def undrawn():
    """Pictures take their time, and are looked at in tests/report."""
    with pytest.MonkeyPatch.context() as patch:
        patch.setattr("zwidth.show.report.html_page.pictures", lambda verdict: [])
        yield patch


@pytest.mark.parametrize(("stiffness", "status"), [("300", 0), ("770", 1)])
def test_the_status_is_that_of_check(run, stiffness, status):
    """One line says the outcome, the next which file was written; `zwidth verify` takes the proof in it."""
    command = f"report {PADDLE} --stiffness {stiffness} -o report.html"
    *said, written = run(command, status).out.splitlines()
    verdict = zw.check(zw.catalogue.device("haptic-paddle", damping="0.16"), zw.Wall(int(stiffness)))
    assert " ".join(said) == f"{verdict.outcome}: {verdict.claim}"
    assert written == "written: report.html"
    page = Path("report.html").read_text(encoding="utf-8")
    assert f"zwidth {command}" in page
    assert "typed: --damping 0.16" in page
    saved = re.search(r"data:application/json;base64,([\w+/=]+)", page)
    Path("verdict.json").write_bytes(b64decode(saved[1]))
    run("verify verdict.json")


def test_what_is_asked_beside_the_loop_is_asked_again(run):
    """Laws, contact and negative numbers stand in the command of the report, and what it says holds there."""
    asked = "--rate '1 kHz' --damping 0.5 --stiffness 100"
    run(f"report {asked} --virtual-damping -0.01 --contact kept -o a.html")
    page = Path("a.html").read_text(encoding="utf-8")
    assert "--contact kept --damping 0.5" in page
    assert "--virtual-damping=-0.01" in page
    assert "contact is kept: the hand stays inside" in page
    run(f"report {asked} --law force-bounding -o a.html --force")
    assert "typed: --law force-bounding" in Path("a.html").read_text(encoding="utf-8")


@pytest.mark.parametrize(
    ("options", "message"),
    [
        ("-o report.txt", "written as .html"),
        ("-o report.pdf", "print it to PDF from the browser"),
        ("-o there.html", "exists"),
        ("-o nowhere/report.html", "no directory"),
        ("", "-o/--save"),
        ("-o report.html --stiffness stiff", "stiff"),
    ],
)
def test_bad_input_is_one_line_and_writes_nothing(refused, options, message):
    """Before anything is computed."""
    Path("there.html").write_text("kept", encoding="utf-8")
    stiffness = "" if "--stiffness" in options else "--stiffness 300"
    assert message in refused(f"report {PADDLE} {stiffness} {options}")
    assert [path.name for path in Path().iterdir()] == ["there.html"]
    assert Path("there.html").read_text(encoding="utf-8") == "kept"


PAIR = """
[device]
catalogue = "haptic-paddle"
[coupling]
stiffness = 100
"""


def test_a_file_of_two_arms_has_a_report(run, refused):
    """Its numbers stand in it; one beside it would be ignored, and is refused."""
    Path("arms.toml").write_text(PAIR, encoding="utf-8")
    run("report arms.toml -o report.html")
    page = Path("report.html").read_text(encoding="utf-8")
    assert "No motion of two hands" in page
    assert "zwidth report arms.toml -o report.html" in page
    assert "stand in their file" in refused("report arms.toml -o report.html --force --stiffness 50")
