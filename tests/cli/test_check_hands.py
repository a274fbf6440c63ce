"""`zwidth check --hands` and `--active-below`: what is said of hands, saved, checked, and bad input."""

import json
from pathlib import Path

import pytest

WHEEL = """[device]
inertia = "0.03 kg*m^2"
damping = "0.01 N*m*s/rad"
coulomb_friction = "0.05 N*m"
counts_per_turn = 65536
handle_radius = "14 cm"
rate = "1 kHz"
delay = "1.4 ms"
"""
OF_A_WHEEL = "check wheel.toml --stiffness '0.5 N*m/deg'"
HANDS = f"{OF_A_WHEEL} --hands none,hands-on"
DAMPED = "check haptic-paddle --stiffness 100 --virtual-damping 0.05 --active-below '10 Hz'"


@pytest.fixture(autouse=True)
def _wheel(run):
    Path("wheel.toml").write_text(WHEEL, encoding="utf-8")


def test_each_hand_is_told_in_degrees(run):
    """About the axis though a radius is given, as the question is in degrees; each hand by itself."""
    out = run(HANDS, 1).words
    assert "K = 0.5 N·m/deg" in out
    assert "none is shaken, at 4.912 Hz; comes to rest up to 0.09187 N·m/deg" in out
    assert "hands-on comes to rest, up to 2.763 N·m/deg" in out
    assert "of each hand alone, as long as it keeps contact; dry friction and encoder steps left out" in out


def test_saved_proofs_are_checked(run):
    """All that is proved is in the file; evidence that shows something else of a hand is refused."""
    run(f"{HANDS} -o proof.json", 1)
    run("verify proof.json").says("do not come to rest", "come to rest after every disturbance")
    document = json.loads(Path("proof.json").read_text(encoding="utf-8"))
    hands = document["known_hands"]
    found = [(name, hand["outcome"]) for name, hand in hands.items()]
    assert found == [("none", "unstable"), ("hands-on", "stable")]
    hands["none"]["certificate"] = hands["hands-on"]["certificate"]
    Path("proof.json").write_text(json.dumps(document), encoding="utf-8")
    assert "shows something else" in run("verify proof.json", 1).words


def test_json_has_them(run):
    assert run(f"{HANDS} --json", 1).json["known_hands"]["none"]["format"] == "zwidth stability 1"
    assert "known_hands" not in run(f"{OF_A_WHEEL} --json", 1).json


def test_an_active_hand(run):
    run(DAMPED).says(
        "an active hand",
        "up to 0.149901 N·s/m, contact kept",
        "up to 0.05 N·s/m, contact broken too",
        "too active",
    )
    document = run(f"{DAMPED} --json").json
    found = document["active_hand"]
    assert (document["outcome"], found["below_Hz"]) == ("passive", 10)
    assert found["contact_broken"]["activity_N_s_per_m"] == 0.05
    assert found["shaking_hand"]["frequency_Hz"] == pytest.approx(8)


def test_proofs_of_an_active_hand_are_saved_and_verified(run):
    """All three proofs are in the file and checked; one spoilt is found."""
    run(f"{DAMPED} -o proof.json")
    out = run("verify proof.json").out
    assert out.count("VALID") == 1 + 3
    assert out.count("No hand of this activity") == 2
    assert "10 Hz" in out
    document = json.loads(Path("proof.json").read_text(encoding="utf-8"))
    document["active_hand"]["contact_kept"]["certificate"]["activity_N_s_per_m"] = "0.2"
    Path("proof.json").write_text(json.dumps(document), encoding="utf-8")
    run("verify proof.json", 1)


@pytest.mark.parametrize(
    ("line", "said"),
    [
        (f"{OF_A_WHEEL} --hands dowel", '"dowel"'),
        (f"{OF_A_WHEEL} --hands none --mass 1", "inertia"),
        ("check moza-r9 --stiffness 1 --hands none", "give it"),
        ("check haptic-paddle --stiffness 100 --active-below '700 Hz'", "half the rate"),
        ("check haptic-paddle --stiffness 100 --active-below soon", "--active-below"),
        ("check haptic-paddle --stiffness 100 --active-below '10 m'", "--active-below"),
    ],
)
def test_bad_input(refused, line, said):
    assert said in refused(line)
