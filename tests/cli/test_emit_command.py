"""`zwidth emit`: files, a short report, an exit status for each outcome, one clear line on bad input."""

from __future__ import annotations

import json
import subprocess
import sys
from hashlib import sha256
from pathlib import Path

import pytest

from zwidth.cli.main import main

PADDLE = ["emit", "haptic-paddle", "--stiffness", "150", "--virtual-damping", "0.05"]
TRAVEL = ["--travel", "-60 .. 60 mm"]


@pytest.mark.parametrize(
    ("target", "files"),
    [
        ("c99", {"law.h"}),
        ("arduino", {"law.h", "guard.h", "telemetry.h", "wall.ino"}),
        ("cortex-m", {"law.h", "guard.h", "telemetry.h", "main.c", "startup.c", "law.ld", "Makefile"}),
        ("posix", {"law.h", "guard.h", "telemetry.h", "main.c", "mass.c", "device.h", "Makefile"}),
        ("moteus", {"law.h", "guard.h", "telemetry.h", "main.c", "moteus.c", "device.h", "Makefile"}),
        ("simplefoc", {"law.h", "guard.h", "telemetry.h", "wall.ino"}),
        ("javascript", {"law.mjs"}),
    ],
)
def test_what_is_written_for_a_target(tmp_path: Path, target: str, files: set[str]) -> None:
    """The law, its certificate, and the main program that the target has; status 0."""
    assert main([*PADDLE, "--target", target, "-o", str(tmp_path / "wall")]) == 0
    assert {path.name for path in (tmp_path / "wall").iterdir()} == files | {"law.certificate.json"}


@pytest.mark.parametrize(
    ("loop", "status"),
    [
        (["--stiffness", "150"], 0),
        (["--stiffness", "770"], 1),
        (["--stiffness", "150", "--law", "saturation"], 3),
        (["--stiffness", "150", "--contact", "kept"], 0),
        (["--stiffness", "-5"], 2),
    ],
)
def test_the_exit_status(tmp_path: Path, loop: list[str], status: int) -> None:
    """As `check` has it; nothing is written where it is not 0."""
    folder = tmp_path / "wall"
    assert main(["emit", "haptic-paddle", *loop, *TRAVEL, "-o", str(folder)]) == status
    assert folder.exists() == (status == 0)


def test_anyway(tmp_path: Path, capsys: pytest.CaptureFixture[str]) -> None:
    """What is refuted is written where somebody insists; report and header say so."""
    folder = tmp_path / "wall"
    assert main(["emit", "haptic-paddle", "--stiffness", "770", "--anyway", "-o", str(folder)]) == 0
    assert "ACTIVE" in capsys.readouterr().out
    assert "NOT PROVED" in (folder / "law.h").read_text(encoding="utf-8")


@pytest.mark.parametrize("loop", [PADDLE, ["emit", "haptic-paddle", "--stiffness", "770", "--anyway"]])
@pytest.mark.parametrize("target", ["arduino", "cortex-m", "javascript"])
def test_the_report_is_short(
    tmp_path: Path,
    capsys: pytest.CaptureFixture[str],
    monkeypatch: pytest.MonkeyPatch,
    loop: list[str],
    target: str,
) -> None:
    """The outcome first, what its numbers cost, 15 lines of 80 columns at most, and each file."""
    monkeypatch.setenv("COLUMNS", "80")
    monkeypatch.chdir(tmp_path)
    assert main([*loop, "--target", target, "-o", "wall"]) == 0
    lines = capsys.readouterr().out.splitlines()
    assert lines[0].split()[0] in ("PASSIVE", "ACTIVE")
    assert len([line for line in lines if not line.startswith("written: ")]) <= 15
    assert max(map(len, lines)) <= 80
    text = "\n".join(lines)
    for word in ("force off by at most", "numbers", "written", "law.certificate.json", "readings from"):
        assert word in text


def test_the_report_as_json(tmp_path: Path, capsys: pytest.CaptureFixture[str]) -> None:
    """Units in the keys, the files by their SHA-256, the verdict as `check` gives it."""
    folder = tmp_path / "wall"
    assert main([*PADDLE, *TRAVEL, "--target", "arduino", "--json", "-o", str(folder)]) == 0
    found = json.loads(capsys.readouterr().out)
    assert set(found) == {
        "format",
        "prefix",
        "target",
        "number",
        "outcome",
        "statement",
        "error_N",
        "rounding_N",
        "stiffness_cost_N_per_m",
        "certificate_sha256",
        "files",
        "verdict",
    }
    assert (found["target"], found["number"], found["outcome"]) == ("arduino", "fixed", "passive")
    assert 0 < found["rounding_N"] < found["error_N"] < 0.001
    for name, digest in found["files"].items():
        written = folder / name.replace("law.ino", "wall.ino")
        assert sha256(written.read_bytes()).hexdigest() == digest
    assert found["files"]["law.certificate.json"] == found["certificate_sha256"]
    assert found["verdict"]["outcome"] == "passive"


@pytest.mark.parametrize(
    ("more", "said"),
    [
        (["--target", "toaster"], "target is one of c99, arduino"),
        (["--target", "arduino", "--number", "double"], "double has 32 bits on an AVR"),
        (["--number", "half"], "number is double or float or fixed"),
        (["--travel", "60 .. -60 mm"], "travel"),
        (["--travel", "60 mm"], "travel"),
        (["--travel", "-1000 .. 1000 km"], "more than 32 bits hold"),
        (["--prefix", "9walls"], "prefix begins names in C"),
        (["--target", "arduino", "--prefix", "guard"], "guard.h is a file of the main program"),
        (["--number", "fixed", "--resolution", "unknown"], "resolution"),
        (["--rate", "990 .. 1010 Hz"], "interval"),
        (["--delay", "0 .. 0.2 ms", "--law", "passivity-controller"], "give one number"),
        (["--force-unit", "-1"], "--force-unit must be > 0"),
    ],
)
def test_bad_input(tmp_path: Path, capsys: pytest.CaptureFixture[str], more: list[str], said: str) -> None:
    """One message, status 2, nothing written."""
    assert main([*PADDLE, *more, "-o", str(tmp_path / "wall")]) == 2
    shown = capsys.readouterr()
    assert shown.out == ""
    assert said in shown.err
    assert not (tmp_path / "wall").exists()


def test_where_the_files_go(tmp_path: Path, capsys: pytest.CaptureFixture[str]) -> None:
    """A directory is needed, no file; what is there is replaced only where that is asked for."""
    assert main(PADDLE) == 2
    assert "-o DIRECTORY" in capsys.readouterr().err
    (tmp_path / "file").write_text("mine")
    assert main([*PADDLE, "-o", str(tmp_path / "file")]) == 2
    assert "exists and is no directory" in capsys.readouterr().err
    assert main([*PADDLE, "-o", str(tmp_path / "file" / "below")]) == 2
    assert "cannot be made" in capsys.readouterr().err
    folder = str(tmp_path / "wall")
    assert main([*PADDLE, "-o", folder]) == 0
    (tmp_path / "wall" / "law.h").write_text("mine")
    capsys.readouterr()
    assert main([*PADDLE, "-o", folder]) == 2
    assert "exists" in capsys.readouterr().err
    assert (tmp_path / "wall" / "law.h").read_text() == "mine"
    assert main([*PADDLE, "-o", folder, "--force"]) == 0
    assert (tmp_path / "wall" / "law.h").read_text() != "mine"


def test_a_changed_certificate_is_noticed(tmp_path: Path) -> None:
    """`zwidth verify` accepts the one that is written, and not one whose number is another."""
    assert main([*PADDLE, "-o", str(tmp_path)]) == 0
    certificate = tmp_path / "law.certificate.json"
    named = sha256(certificate.read_bytes()).hexdigest()
    assert f'LAW_CERTIFICATE_SHA256 "{named}"' in (tmp_path / "law.h").read_text(encoding="utf-8")
    assert main(["verify", str(certificate)]) == 0
    text = certificate.read_text(encoding="utf-8")
    certificate.write_text(text.replace("150", "950"), encoding="utf-8")
    assert certificate.read_text(encoding="utf-8") != text
    assert main(["verify", str(certificate)]) == 1


def test_its_help_loads_no_numerical_library(tmp_path: Path) -> None:
    """`zwidth emit --help` imports neither numpy nor scipy."""
    code = (
        "import sys\nfrom zwidth.cli.main import main\n"
        "try: main(['emit', '--help'])\nexcept SystemExit: pass\n"
        "sys.exit(str([m for m in ('numpy', 'scipy') if m in sys.modules] or ''))"
    )
    done = subprocess.run(
        [sys.executable, "-c", code], capture_output=True, text=True, env={"PYTHONPATH": ":".join(sys.path)}
    )
    assert done.stderr.strip() == ""
