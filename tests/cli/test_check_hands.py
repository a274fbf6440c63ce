"""`zwidth check --hands`: what is said of hands that are known, saved, checked, and bad input."""

from __future__ import annotations

import json
from pathlib import Path

import pytest

from zwidth.cli.main import main

WHEEL = """[device]
inertia = "0.03 kg*m^2"
damping = "0.01 N*m*s/rad"
coulomb_friction = "0.05 N*m"
counts_per_turn = 65536
handle_radius = "14 cm"
rate = "1 kHz"
delay = "1.4 ms"
"""
ASKED = ["check", "wheel.toml", "--stiffness", "0.5 N*m/deg", "--hands", "none,hands-on"]


@pytest.fixture(autouse=True)
def _in_a_folder(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.chdir(tmp_path)
    Path("wheel.toml").write_text(WHEEL, encoding="utf-8")


def test_each_hand_is_told_in_degrees(capsys: pytest.CaptureFixture[str]) -> None:
    """About the axis though a radius is given, as the question is in degrees; each hand by itself."""
    assert main(ASKED) == 1
    out = " ".join(capsys.readouterr().out.split())
    assert "K = 0.5 N·m/deg" in out
    assert "none is shaken, at 4.912 Hz; comes to rest up to 0.09187 N·m/deg" in out
    assert "hands-on comes to rest, up to 2.763 N·m/deg" in out
    assert "of each hand alone, as long as it keeps contact; dry friction and encoder steps left out" in out


def test_saved_proofs_are_checked(capsys: pytest.CaptureFixture[str]) -> None:
    """All that is proved is in the file; evidence that shows something else of a hand is refused."""
    assert main([*ASKED, "-o", "proof.json"]) == 1
    assert main(["verify", "proof.json"]) == 0
    out = capsys.readouterr().out
    assert "do not come to rest" in out
    assert "come to rest after every disturbance" in " ".join(out.split())
    document = json.loads(Path("proof.json").read_text(encoding="utf-8"))
    assert {k: v["outcome"] for k, v in document["known_hands"].items()} == {
        "none": "unstable", "hands-on": "stable"
    }  # fmt: skip
    document["known_hands"]["none"]["certificate"] = document["known_hands"]["hands-on"]["certificate"]
    Path("proof.json").write_text(json.dumps(document), encoding="utf-8")
    assert main(["verify", "proof.json"]) == 1
    assert "shows something else" in " ".join(capsys.readouterr().out.split())


def test_json_has_them(capsys: pytest.CaptureFixture[str]) -> None:
    """A document for each."""
    assert main([*ASKED, "--json"]) == 1
    document = json.loads(capsys.readouterr().out)
    assert document["known_hands"]["none"]["format"] == "zwidth stability 1"
    assert main([*ASKED[:-2], "--json"]) == 1
    assert "known_hands" not in json.loads(capsys.readouterr().out)


@pytest.mark.parametrize(
    ("more", "said"),
    [(["--hands", "dowel"], '"dowel"'), (["--hands", "none", "--mass", "1"], "inertia")],
)
def test_bad_input(more: list[str], said: str, capsys: pytest.CaptureFixture[str]) -> None:
    """One message that says what is possible."""
    assert main([*ASKED[:-2], *more]) == 2
    assert said in capsys.readouterr().err
