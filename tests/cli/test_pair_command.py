"""`zwidth pair`: two arms that follow each other, decided, reported, saved; one clear line on bad input."""

import json
import re
from fractions import Fraction
from pathlib import Path

import pytest
from json_page import json_page

import zwidth as zw

ARM = '[device]\ndamping = 0.2\ncoulomb_friction = 0.05\nresolution = "10 um"\nrate = "1 kHz"\n'
OTHER = '[device]\ndamping = 0.4\ncoulomb_friction = 0.08\nresolution = "20 um"\nrate = "1 kHz"\n'
PAIR = (
    ARM.replace("[device]", "[leader]")
    + OTHER.replace("[device]", "[follower]")
    + '[coupling]\nstiffness = "50 N/m"\ndamping = "10 mN*s/m"\nlink_delay = "2 ms"\n'
)
LEADER = zw.Device(damping="0.2", coulomb_friction="0.05", resolution="10 um", rate=1000)
FOLLOWER = zw.Device(damping="0.4", coulomb_friction="0.08", resolution="20 um", rate=1000)


TWO = "leader.toml follower.toml"
HELD_ARM = 'damping = 0.3\nmass = "20 g"\ncoulomb_friction = 0\nresolution = 0\ndelay = 0\nrate = "1 kHz"\n'
HELD = f'[leader]\n{HELD_ARM}[follower]\n{HELD_ARM}[coupling]\nstiffness = "250 N/m"\nlink_delay = "2 ms"\n'
HAND = "--follower-operator impedance --follower-operator.mass 50g --follower-operator.stiffness"
KNOWN = f"{HAND} '0.1 N/mm' --follower-operator.damping '2 .. 2.01'"
NOBODY = "--follower-operator nobody"


@pytest.fixture(autouse=True)
def _files(run):
    """Two arms, a pair in one file, and one that needs a hand to be passive."""
    for name, text in {"leader": ARM, "follower": OTHER, "pair": PAIR, "held": HELD}.items():
        Path(f"{name}.toml").write_text(text, encoding="utf-8")


def test_one_file_is_the_pair_of_python(answer):
    pair = zw.Pair(LEADER, FOLLOWER, stiffness=50, damping="0.01", delay="0.002")
    told = answer("pair.toml")
    assert told == json.loads(zw.check(pair).to_json())
    assert told["outcome"] == "passive"
    assert zw.check(zw.load("pair.toml")).to_json() == zw.check(pair).to_json()


def test_options_override_the_coupling(answer):
    """Of a file with all tables, and of two files; `--virtual-damping` is the coupling's."""
    options = "--stiffness '0.2 N/mm' --virtual-damping -0.01 --link-delay-back '3 ms'"
    one, two = answer(f"pair.toml {options}"), answer(f"{TWO} {options} --link-delay '2 ms'")
    pair = zw.Pair(LEADER, FOLLOWER, stiffness=200, damping="-0.01", delay=("0.002", "0.003"))
    assert one == two == json.loads(zw.check(pair).to_json())
    assert one["outcome"] == "active"


def test_the_follower_may_have_gains_of_its_own(answer):
    """Each option is an argument of `Pair`."""
    gains = "--stiffness 40 --local-damping 0.02 --follower-stiffness 80"
    more = "--follower-virtual-damping 0.01 --follower-local-damping 0.03"
    told = answer(f"{TWO} {gains} {more}")
    pair = zw.Pair(
        LEADER, FOLLOWER, stiffness=40, local_damping="0.02", follower_stiffness=80,
        follower_damping="0.01", follower_local_damping="0.03",
    )  # fmt: skip
    assert told == json.loads(zw.check(pair).to_json())
    assert told["power_ratio"] == 0.5


def test_friction_is_compensated_on_both_sides_unless_told(run, answer):
    """Each number of a law is an option; the report says what it takes, and how much of it is passive."""
    law = "--compensation-coulomb '60 mN' --compensation-viscous 0.01 --compensation-speed '0.02 m/s'"
    line = f"{TWO} --stiffness 40 {law} --follower-compensation-coulomb 0"
    told = answer(line)
    law = zw.FrictionCompensation(coulomb="0.06", viscous="0.01", speed="0.02")
    laws = {"compensation": law, "follower_compensation": law.replace(coulomb=0)}
    pair = zw.Pair(LEADER, FOLLOWER, stiffness=40, **laws)
    assert told == json.loads(zw.check(pair).to_json())
    assert told["largest_compensation"] > 0
    said = run(f"pair {line} --all", None).out
    for part in ("compensated in the leader", "largest compensation", "of friction is computed once"):
        assert part in said


def test_one_device_is_both_arms(run):
    """And the report says so; without delay K T/2 is the sum of both dampings in series, b/2."""
    said = run("pair leader.toml --stiffness 200 --all").out
    assert "both arms  leader: b = 0.2 N·s/m" in said
    assert "200 N/m with all else as it is" in said
    run("pair leader.toml --stiffness 200.001", 1)


def test_the_report_of_an_active_pair(run):
    said = run(f"pair {TWO} --stiffness 300 --all", 1).out
    for part in (" ACTIVE ", "leader    b = 0.2", "follower  b = 0.4", "damping of the arms",
                 "largest stiffness", "some motion of both hands gains", "the motion", "extracts",
                 "what to change, any one of", "lower the stiffness from 300 N/m",
                 "at twice the rate a stiffness of up to", "assumes"):  # fmt: skip
        assert part in said


@pytest.mark.parametrize(("stiffness", "kinds"), [(80, ["pair"]), (400, ["pair violation", "pair motion"])])
def test_what_is_saved_is_verified(run, stiffness, kinds):
    """By the checker alone; with the outcome turned round it is refused."""
    Path("verdict.json").write_text("old", encoding="utf-8")
    line = f"pair pair.toml --stiffness {stiffness} -o verdict.json --force"
    assert "written: verdict.json" in run(line, int(stiffness == 400)).out
    said = run("verify verdict.json").out
    assert said.count(" VALID ") == len(kinds) + (len(kinds) > 1)  # of all of it, first
    assert re.findall(r"^kind +(.+)$", said, re.MULTILINE) == kinds
    for arm, damping in (("leader", "0.2"), ("follower", "0.4")):
        assert re.findall(rf"^{arm}: damping +(.+)$", said, re.MULTILINE) == [f"{damping} N·s/m"] * len(kinds)
    document = json.loads(Path("verdict.json").read_text(encoding="utf-8"))
    document["outcome"] = "active" if document["outcome"] == "passive" else "passive"
    Path("verdict.json").write_text(json.dumps(document), encoding="utf-8")
    run("verify verdict.json", 1)


@pytest.mark.parametrize("more", [{}, {"stiffness": 400}, {"stiffness": 150, "delay": "0.004"}])
def test_the_stiffness_elsewhere_is_the_largest_there(more):
    """With half the delay of the link, and at twice the rate."""
    pair = zw.Pair(LEADER, FOLLOWER, **{"stiffness": 60, "delay": "0.001", **more})
    fast = {"leader": LEADER.replace(rate=2000), "follower": FOLLOWER.replace(rate=2000)}
    elsewhere = {"link_delay": {"delay": tuple(Fraction(str(d)) / 2 for d in pair.delay)}, "rate": fast}
    found = zw.check(pair).stiffness_elsewhere
    assert {at.parameter for at in found} <= set(elsewhere)
    assert found
    for at in found:
        changed = pair.replace(**elsewhere[at.parameter])
        said = float(re.search(r"up to ([\d.]+) N/m", at.text)[1])
        assert zw.check(changed.replace(stiffness=said)).passive
        assert zw.check(changed.replace(stiffness=at.stiffness)).passive
        assert not zw.check(changed.replace(stiffness=at.stiffness * 1.001)).passive


def test_a_hand_is_that_of_python(answer):
    pair = zw.load("held.toml")
    hand = zw.stability.HandImpedance(mass="50 g", stiffness=100, damping=(2, "2.01"))
    held = answer(f"held.toml {KNOWN}")
    assert held == json.loads(zw.check(pair, follower=hand).to_json())
    assert held["outcome"] == "passive"
    alone = answer("held.toml --operator nobody")
    assert alone == json.loads(zw.check(pair, leader=None).to_json())
    assert (alone["outcome"], alone["held"]) == ("active", {"arm": "leader", "hand": "nobody"})


@pytest.mark.parametrize(
    ("hand", "status", "words"),
    [
        (KNOWN, 0, "A hand on the arm that is not held takes no energy out"),
        (NOBODY, 1, "A hand can take any amount of energy out of the arms below"),
    ],
)
def test_what_is_saved_of_a_known_hand_is_verified(run, hand, status, words):
    """As what it is: as evidence about two hands that do what they like it is refused."""
    saved = Path("held.json")
    assert "known" not in run(f"pair held.toml {hand} -o held.json", status).err
    assert words in run("verify held.json").words
    told = {**json.loads(saved.read_text(encoding="utf-8")), "format": "zwidth pair 1"}
    saved.write_text(json.dumps(told), encoding="utf-8")
    assert "no document of this format has: held" in run("verify held.json", 1).words
    del told["held"]
    saved.write_text(json.dumps(told), encoding="utf-8")
    assert "of which a known hand holds one" in run("verify held.json", 1).words


def test_every_key_of_the_json_is_on_its_page(answer):
    page = json_page()

    def keys(value):
        if isinstance(value, dict):
            return set(value).union(*map(keys, value.values()))
        return set().union(*map(keys, value)) if isinstance(value, list) else set()

    law = "--compensation-coulomb 0.01 --compensation-speed 0.1"
    found = keys(answer(f"pair.toml {law}")) | keys(answer("pair.toml --stiffness 400"))
    for hand in (KNOWN, NOBODY):
        told = answer(f"held.toml {hand}")
        found |= {*told, *told["held"], *told["required"]["leader"]}
    assert {"leader_positions_m", "largest_stiffness_at", "cosine", "both"} <= found
    assert not [key for key in sorted(found) if f"`{key}`" not in page]


@pytest.mark.parametrize(
    ("line", "parts"),
    [
        ("", ["no arm is given", "[leader]"]),
        ("leader.toml", ["no spring joins the arms", "--stiffness [N/m]"]),
        (f"{TWO} pair.toml --stiffness 3", ["two arms", "3 sources"]),
        ("leader.toml pair.toml", ["[leader]", "given alone"]),
        ("leader.toml --stiffness 0", ["the leader feels no spring", "stiffness of 0", "not follow"]),
        ("leader.toml --stiffness '3 N*m/rad'", ["stiffness is in N/m"]),
        ("leader.toml --stiffness '10 .. 20'", ["stiffness"]),
        ("leader.toml --stiffness 9 --link-delay 3", ["without a unit", '"3 ms"']),
        ("leader.toml --stiffness 9 --link-delay '-1 ms'", ["--link-delay must be ≥ 0", "is sent"]),
        ("leader.toml --stiffness 9 --link-delay 0.49", ["490 samples", "at most 400"]),
        ("leader.toml --stiffness 9 --damping 1", ["no option --damping"]),
        ("leader.toml --stiffness 9 --compensation-coulomb -1", ["--compensation-coulomb must"]),
        ("leader.toml --stiffness 9 --plot a.txt", [".png"]),
        ("leader.toml --stiffness 9 -o no/such/a.json", ["no directory"]),
        ("pair.toml -o there.json", ["--force"]),
        ("no-such-arm --stiffness 9", ["neither a file nor a device"]),
        ("touch --stiffness 9", ["damping"]),
        ("held.toml --follower-operator finger", ['"finger" is no known hand']),
        ("held.toml --follower-operator.mass 3", ["says what the numbers are of"]),
        ("held.toml --operator nobody --operator.mass 3", ["nobody has no mass"]),
        ("held.toml --operator impedance --operator.damping -3", ["damping must be ≥ 0"]),
        (f"held.toml --operator nobody {NOBODY}", ["nobody is left"]),
    ],
)
def test_bad_input_ends_in_one_line(refused, line, parts):
    """What was given, the bound, why, and what to try; a file that is there is kept."""
    Path("there.json").write_text("mine", encoding="utf-8")
    error = refused(f"pair {line}")
    assert all(part in error for part in parts), error
    assert Path("there.json").read_text(encoding="utf-8") == "mine"


@pytest.mark.parametrize("command", ["check", "limit", "plan"])
def test_other_commands_point_to_it(refused, command):
    assert "zwidth pair" in refused(f"{command} pair.toml")
