"""`zwidth pair` with a known hand on one arm: as in Python, saved and verified; one line on bad input."""

import json
from pathlib import Path

import pytest
from json_page import json_page

import zwidth as zw

ARM = 'damping = 0.3\nmass = "20 g"\ncoulomb_friction = 0\nresolution = 0\ndelay = 0\nrate = "1 kHz"\n'
FILE = f'[leader]\n{ARM}[follower]\n{ARM}[coupling]\nstiffness = "250 N/m"\nlink_delay = "2 ms"\n'
HAND = "--follower-operator impedance --follower-operator.mass 50g --follower-operator.stiffness"
KNOWN = f"{HAND} '0.1 N/mm' --follower-operator.damping '2 .. 2.01'"
NOBODY = "--follower-operator nobody"


@pytest.fixture(autouse=True)
def _file(run):
    """A pair that needs a hand to be passive."""
    Path("pair.toml").write_text(FILE, encoding="utf-8")


def test_a_hand_is_that_of_python(answer):
    pair = zw.load("pair.toml")
    hand = zw.stability.HandImpedance(mass="50 g", stiffness=100, damping=(2, "2.01"))
    held = answer(f"pair.toml {KNOWN}")
    assert held == json.loads(zw.check(pair, follower=hand).to_json())
    assert held["outcome"] == "passive"
    alone = answer("pair.toml --operator nobody")
    assert alone == json.loads(zw.check(pair, leader=None).to_json())
    assert (alone["outcome"], alone["held"]) == ("active", {"arm": "leader", "hand": "nobody"})


@pytest.mark.parametrize(
    ("hand", "status", "words"),
    [
        (KNOWN, 0, "A hand on the arm that is not held takes no energy out"),
        (NOBODY, 1, "A hand can take any amount of energy out of the arms below"),
    ],
)
def test_what_is_saved_is_verified(run, hand, status, words):
    """As what it is: as evidence about two hands that do what they like it is refused."""
    saved = Path("held.json")
    assert "known" not in run(f"pair pair.toml {hand} -o held.json", status).err
    assert words in run("verify held.json").words
    told = {**json.loads(saved.read_text(encoding="utf-8")), "format": "zwidth pair 1"}
    saved.write_text(json.dumps(told), encoding="utf-8")
    assert "no document of this format has: held" in run("verify held.json", 1).words
    del told["held"]
    saved.write_text(json.dumps(told), encoding="utf-8")
    assert "of which a known hand holds one" in run("verify held.json", 1).words


def test_every_key_of_the_json_is_on_its_page(answer):
    page = json_page()
    for hand in (KNOWN, NOBODY):
        told = answer(f"pair.toml {hand}")
        keys = {*told, *told["held"], *told["required"]["leader"]}
        assert {key for key in keys if f"`{key}`" not in page} == set()


@pytest.mark.parametrize(
    ("hands", "said"),
    [
        ("--follower-operator finger", '"finger" is no known hand'),
        ("--follower-operator.mass 3", "says what the numbers are of"),
        ("--operator nobody --operator.mass 3", "nobody has no mass"),
        ("--operator impedance --operator.damping -3", "damping must be ≥ 0"),
        (f"--operator nobody {NOBODY}", "nobody is left"),
    ],
)
def test_bad_input_ends_in_one_line(refused, hands, said):
    assert said in refused(f"pair pair.toml {hands}")
