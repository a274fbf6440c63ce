"""`zwidth check --active-below`: report, JSON, saved proofs, and bad input."""

from __future__ import annotations

import json
from pathlib import Path

import pytest

from zwidth.cli.main import main

DAMPED = [
    "check",
    "haptic-paddle",
    "--stiffness",
    "100",
    "--virtual-damping",
    "0.05",
    "--active-below",
    "10 Hz",
]


def test_report(capsys: pytest.CaptureFixture[str]) -> None:
    """A section of its own, with both numbers and the hand that is too active."""
    assert main(DAMPED) == 0
    out = capsys.readouterr().out
    assert "an active hand" in out
    assert "up to 0.149901 N·s/m, contact kept" in out
    assert "up to 0.05 N·s/m, contact broken too" in out
    assert "too active" in out


def test_json(capsys: pytest.CaptureFixture[str]) -> None:
    """The verdict, and what is known of active hands."""
    assert main([*DAMPED, "--json"]) == 0
    document = json.loads(capsys.readouterr().out)
    assert document["outcome"] == "passive"
    assert document["active_hand"]["below_Hz"] == 10
    assert document["active_hand"]["contact_broken"]["activity_N_s_per_m"] == 0.05
    assert document["active_hand"]["shaking_hand"]["frequency_Hz"] == pytest.approx(8)


def test_saved_and_verified(capsys: pytest.CaptureFixture[str], tmp_path: Path) -> None:
    """All three proofs are in the file and checked; one spoilt is found."""
    file = tmp_path / "proof.json"
    assert main([*DAMPED, "-o", str(file)]) == 0
    capsys.readouterr()
    assert main(["verify", str(file)]) == 0
    out = capsys.readouterr().out
    assert out.count("VALID") == 1 + 3
    assert out.count("No hand of this activity") == 2
    assert "10 Hz" in out
    document = json.loads(file.read_text(encoding="utf-8"))
    document["active_hand"]["contact_kept"]["certificate"]["activity_N_s_per_m"] = "0.2"
    file.write_text(json.dumps(document))
    assert main(["verify", str(file)]) == 1


@pytest.mark.parametrize(
    ("typed", "words"), [("700 Hz", "half the rate"), ("soon", "--active-below"), ("10 m", "--active-below")]
)
def test_bad_input(typed: str, words: str, capsys: pytest.CaptureFixture[str]) -> None:
    """One line that says what was given and what is possible."""
    assert main(["check", "haptic-paddle", "--stiffness", "100", "--active-below", typed]) == 2
    err = capsys.readouterr().err
    assert words in err
    assert len(err.strip().splitlines()) == 1
