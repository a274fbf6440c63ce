"""`zwidth pair` with a known hand on one arm: as in Python, saved and verified; one line on bad input."""

from __future__ import annotations

import json
from pathlib import Path

import pytest
from json_page import json_page

import zwidth as zw
from zwidth.cli.main import main

ARM = 'damping = 0.3\nmass = "20 g"\ncoulomb_friction = 0\nresolution = 0\ndelay = 0\nrate = "1 kHz"\n'
FILE = f'[leader]\n{ARM}[follower]\n{ARM}[coupling]\nstiffness = "250 N/m"\nlink_delay = "2 ms"\n'
HAND = "--follower-operator impedance --follower-operator.mass 50g --follower-operator.stiffness"
KNOWN = [*HAND.split(), "0.1 N/mm", "--follower-operator.damping", "2 .. 2.01"]


@pytest.fixture
def file(tmp_path: Path) -> str:
    """A pair that needs a hand to be passive."""
    (tmp_path / "pair.toml").write_text(FILE, encoding="utf-8")
    return str(tmp_path / "pair.toml")


def answer(capsys, *argv: str) -> dict:
    """What --json prints; the exit status is that of its outcome."""
    code = main(["pair", *argv, "--json"])
    told = json.loads(capsys.readouterr().out)
    assert code == {"passive": 0, "active": 1, "undecided": 3}[told["outcome"]]
    return told


def test_a_hand_is_that_of_python(file, capsys):
    """On the follower with its intervals, and nobody on the leader."""
    pair = zw.load(file)
    hand = zw.stability.HandImpedance(mass="50 g", stiffness=100, damping=(2, "2.01"))
    held = answer(capsys, file, *KNOWN)
    assert held == json.loads(zw.check(pair, follower=hand).to_json())
    assert held["outcome"] == "passive"
    alone = answer(capsys, file, "--operator", "nobody")
    assert alone == json.loads(zw.check(pair, leader=None).to_json())
    assert (alone["outcome"], alone["held"]) == ("active", {"arm": "leader", "hand": "nobody"})


@pytest.mark.parametrize(
    ("argv", "words"),
    [
        (KNOWN, "A hand on the arm that is not held takes no energy out"),
        (["--follower-operator", "nobody"], "A hand can take any amount of energy out of the arms below"),
    ],
)
def test_what_is_saved_is_verified(file, argv, words, tmp_path, capsys):
    """As what it is: as evidence about two hands that do what they like it is refused."""
    saved = tmp_path / "held.json"
    main(["pair", file, *argv, "-o", str(saved)])
    assert "known" not in capsys.readouterr().err
    assert main(["verify", str(saved)]) == 0
    assert words in " ".join(capsys.readouterr().out.split())
    told = json.loads(saved.read_text(encoding="utf-8"))
    told = {**told, "format": "zwidth pair 1"}
    saved.write_text(json.dumps(told), encoding="utf-8")
    assert main(["verify", str(saved)]) == 1
    assert "no document of this format has: held" in " ".join(capsys.readouterr().out.split())
    del told["held"]
    saved.write_text(json.dumps(told), encoding="utf-8")
    assert main(["verify", str(saved)]) == 1
    assert "of which a known hand holds one" in " ".join(capsys.readouterr().out.split())


def test_every_key_of_the_json_is_on_its_page(file, capsys):
    """Of both outcomes."""
    page = json_page()
    for argv in (KNOWN, ["--follower-operator", "nobody"]):
        told = answer(capsys, file, *argv)
        keys = {*told, *told["held"], *told["required"]["leader"]}
        assert {key for key in keys if f"`{key}`" not in page} == set()


@pytest.mark.parametrize(
    ("argv", "said"),
    [
        (["--follower-operator", "finger"], '"finger" is no known hand'),
        (["--follower-operator.mass", "3"], "says what the numbers are of"),
        (["--operator", "nobody", "--operator.mass", "3"], "nobody has no mass"),
        (["--operator", "impedance", "--operator.damping", "-3"], "damping must be ≥ 0"),
        (["--operator", "nobody", "--follower-operator", "nobody"], "nobody is left"),
    ],
)
def test_bad_input_ends_in_one_line(file, argv, said, capsys):
    """It says which option."""
    assert main(["pair", file, *argv]) == 2
    captured = capsys.readouterr()
    assert captured.out == ""
    assert captured.err.count("\n") == 1
    assert said in captured.err
