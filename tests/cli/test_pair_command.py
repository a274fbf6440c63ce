"""`zwidth pair`: two arms that follow each other, decided, reported, saved; one clear line on bad input."""

from __future__ import annotations

import json
import re
from fractions import Fraction
from pathlib import Path

import pytest
from json_page import json_page

import zwidth as zw
from zwidth.cli.main import main

ARM = '[device]\ndamping = 0.2\ncoulomb_friction = 0.05\nresolution = "10 um"\nrate = "1 kHz"\n'
OTHER = '[device]\ndamping = 0.4\ncoulomb_friction = 0.08\nresolution = "20 um"\nrate = "1 kHz"\n'
PAIR = (
    ARM.replace("[device]", "[leader]")
    + OTHER.replace("[device]", "[follower]")
    + '[coupling]\nstiffness = "50 N/m"\ndamping = "10 mN*s/m"\nlink_delay = "2 ms"\n'
)
LEADER = zw.Device(damping="0.2", coulomb_friction="0.05", resolution="10 um", rate=1000)
FOLLOWER = zw.Device(damping="0.4", coulomb_friction="0.08", resolution="20 um", rate=1000)


@pytest.fixture
def files(tmp_path: Path) -> dict[str, str]:
    """Two arms, and a pair in one file."""
    texts = {"leader": ARM, "follower": OTHER, "pair": PAIR}
    for name, text in texts.items():
        (tmp_path / f"{name}.toml").write_text(text, encoding="utf-8")
    return {name: str(tmp_path / f"{name}.toml") for name in texts}


def answer(capsys, *argv: str) -> dict:
    """What --json prints; the exit status is that of its outcome."""
    code = main(["pair", *argv, "--json"])
    told = json.loads(capsys.readouterr().out)
    assert code == {"passive": 0, "active": 1, "undecided": 3}[told["outcome"]]
    return told


def test_one_file_is_the_pair_of_python(files, capsys):
    """The same numbers as `zw.check(zw.Pair(…))`, units converted."""
    pair = zw.Pair(LEADER, FOLLOWER, stiffness=50, damping="0.01", delay="0.002")
    told = answer(capsys, files["pair"])
    assert told == json.loads(zw.check(pair).to_json())
    assert told["outcome"] == "passive"
    assert zw.check(zw.load(files["pair"])).to_json() == zw.check(pair).to_json()


def test_options_override_the_coupling(files, capsys):
    """Of a file with all tables, and of two files; `--virtual-damping` is the coupling's."""
    options = ["--stiffness", "0.2 N/mm", "--virtual-damping", "-0.01", "--link-delay-back", "3 ms"]
    one = answer(capsys, files["pair"], *options)
    two = answer(capsys, files["leader"], files["follower"], *options, "--link-delay", "2 ms")
    pair = zw.Pair(LEADER, FOLLOWER, stiffness=200, damping="-0.01", delay=("0.002", "0.003"))
    assert one == two == json.loads(zw.check(pair).to_json())
    assert one["outcome"] == "active"


def test_the_follower_may_have_gains_of_its_own(files, capsys):
    """Each option is an argument of `Pair`."""
    options = {"stiffness": "40", "local-damping": "0.02", "follower-stiffness": "80"}
    more = {"follower-virtual-damping": "0.01", "follower-local-damping": "0.03"}
    argv = [word for key, value in (options | more).items() for word in (f"--{key}", value)]
    told = answer(capsys, files["leader"], files["follower"], *argv)
    pair = zw.Pair(
        LEADER, FOLLOWER, stiffness=40, local_damping="0.02", follower_stiffness=80,
        follower_damping="0.01", follower_local_damping="0.03",
    )  # fmt: skip
    assert told == json.loads(zw.check(pair).to_json())
    assert told["power_ratio"] == 0.5


def test_friction_is_compensated_on_both_sides_unless_told(files, capsys):
    """Each number of a law is an option; the report says what it takes, and how much of it is passive."""
    argv = ["--stiffness", "40", "--compensation-coulomb", "60 mN", "--compensation-viscous", "0.01"]
    argv += ["--compensation-speed", "0.02 m/s", "--follower-compensation-coulomb", "0"]
    told = answer(capsys, files["leader"], files["follower"], *argv)
    law = zw.FrictionCompensation(coulomb="0.06", viscous="0.01", speed="0.02")
    pair = zw.Pair(
        LEADER, FOLLOWER, stiffness=40, compensation=law, follower_compensation=law.replace(coulomb=0)
    )
    assert told == json.loads(zw.check(pair).to_json())
    assert told["largest_compensation"] > 0
    main(["pair", files["leader"], files["follower"], *argv, "--all"])
    said = capsys.readouterr().out
    for part in ("compensated in the leader", "largest compensation", "of friction is computed once"):
        assert part in said


def test_one_device_is_both_arms(files, capsys):
    """And the report says so; without delay K T/2 is the sum of both dampings in series, b/2."""
    assert main(["pair", files["leader"], "--stiffness", "200", "--all"]) == 0
    said = capsys.readouterr().out
    assert "both arms  leader: b = 0.2 N·s/m" in said
    assert "200 N/m with all else as it is" in said
    assert main(["pair", files["leader"], "--stiffness", "200.001"]) == 1


def test_the_report_of_an_active_pair(files, capsys):
    """The limit, what each arm needs, the frequency, the motion of both hands, and what to change."""
    assert main(["pair", files["leader"], files["follower"], "--stiffness", "300", "--all"]) == 1
    said = capsys.readouterr().out
    for part in (" ACTIVE ", "leader    b = 0.2", "follower  b = 0.4", "damping of the arms",
                 "largest stiffness", "some motion of both hands gains", "the motion", "extracts",
                 "what to change, any one of", "lower the stiffness from 300 N/m",
                 "at twice the rate a stiffness of up to", "assumes"):  # fmt: skip
        assert part in said


@pytest.mark.parametrize(
    ("stiffness", "kinds"), [("80", ["pair"]), ("400", ["pair violation", "pair motion"])]
)
def test_what_is_saved_is_verified(files, stiffness, kinds, tmp_path, capsys):
    """By the checker alone; with the outcome turned round it is refused."""
    path = tmp_path / "verdict.json"
    status = main(["pair", files["pair"], "--stiffness", stiffness, "-o", str(path)])
    assert status == (len(kinds) > 1)
    assert f"written: {path}" in capsys.readouterr().out
    assert main(["verify", str(path)]) == 0
    said = capsys.readouterr().out
    assert said.count(" VALID ") == len(kinds) + (len(kinds) > 1)  # of all of it, first
    assert re.findall(r"^kind +(.+)$", said, re.MULTILINE) == kinds
    for arm, damping in (("leader", "0.2"), ("follower", "0.4")):
        assert re.findall(rf"^{arm}: damping +(.+)$", said, re.MULTILINE) == [f"{damping} N·s/m"] * len(kinds)
    document = json.loads(path.read_text(encoding="utf-8"))
    document["outcome"] = "active" if document["outcome"] == "passive" else "passive"
    path.write_text(json.dumps(document), encoding="utf-8")
    assert main(["verify", str(path)]) == 1


def test_a_file_that_exists_is_kept(files, tmp_path, capsys):
    """Unless --force says otherwise."""
    path = tmp_path / "there.json"
    path.write_text("mine")
    argv = ["pair", files["pair"], "-o", str(path)]
    assert main(argv) == 2
    assert "--force" in capsys.readouterr().err
    assert path.read_text() == "mine"
    assert main([*argv, "--force"]) == 0
    assert path.read_text() != "mine"


@pytest.mark.parametrize("more", [{}, {"stiffness": 400}, {"stiffness": 150, "delay": "0.004"}])
def test_every_value_of_the_advice_is_passive(more):
    """What is advised was tried: with it alone changed the verdict is passive."""
    pair = zw.Pair(LEADER, FOLLOWER, **{"stiffness": 60, "delay": "0.001", **more})
    verdict = zw.check(pair)
    assert any(advice.to is not None for advice in verdict.advice)
    for advice in verdict.advice:
        if advice.to is None or advice.to == float("inf"):
            continue
        assert zw.check(_changed(pair, advice.parameter, advice.to)).passive, advice
    for at in verdict.stiffness_elsewhere:
        changed = (
            pair.replace(delay=tuple(Fraction(str(d)) / 2 for d in pair.delay))
            if at.parameter == "link_delay"
            else _changed(pair, "rate", 2000)
        )
        said = float(re.search(r"up to ([\d.]+) N/m", at.text)[1])
        assert zw.check(changed.replace(stiffness=said)).passive
        assert zw.check(changed.replace(stiffness=at.stiffness)).passive
        assert not zw.check(changed.replace(stiffness=at.stiffness * 1.001)).passive


def _changed(pair: zw.Pair, parameter: str, to: float) -> zw.Pair:
    arm, _, key = parameter.rpartition(".")
    if arm:
        return pair.replace(**{arm: getattr(pair, arm).replace(**{key: to})})
    if parameter == "link_delay":
        return pair.replace(delay=to)
    if parameter in ("stiffness", "local_damping"):
        return pair.replace(**{parameter: to})
    least = {"rate": 0.0}.get(parameter, to)
    arms = {"leader": pair.leader, "follower": pair.follower}
    return pair.replace(
        **{
            name: device.replace(**{parameter: max(to, float(device.exact(parameter))) if least else to})
            for name, device in arms.items()
        }
    )


def test_every_key_of_the_json_is_on_its_page(files, capsys):
    """Whoever reads it by program finds each key explained, of the proof and of the motion too."""
    page = json_page()

    def keys(value: object) -> set[str]:
        if isinstance(value, dict):
            return set(value).union(*map(keys, value.values()))
        return set().union(*map(keys, value)) if isinstance(value, list) else set()

    law = ["--compensation-coulomb", "0.01", "--compensation-speed", "0.1"]
    found = keys(answer(capsys, files["pair"], *law))
    found |= keys(answer(capsys, files["pair"], "--stiffness", "400"))
    assert {"leader_positions_m", "largest_stiffness_at", "cosine", "both"} <= found
    assert not [key for key in sorted(found) if f"`{key}`" not in page]


@pytest.mark.parametrize(
    ("argv", "parts"),
    [
        ([], ("no arm is given", "[leader]")),
        (["leader"], ("no spring joins the arms", "--stiffness [N/m]")),
        (["leader", "follower", "pair", "--stiffness", "3"], ("two arms", "3 sources")),
        (["leader", "pair"], ("[leader]", "given alone")),
        (["leader", "--stiffness", "0"], ("the leader feels no spring", "stiffness of 0", "not follow")),
        (["leader", "--stiffness", "3 N*m/rad"], ("stiffness is in N/m",)),
        (["leader", "--stiffness", "10 .. 20"], ("stiffness",)),
        (["leader", "--stiffness", "9", "--link-delay", "3"], ("without a unit", '"3 ms"')),
        (["leader", "--stiffness", "9", "--link-delay", "-1 ms"], ("--link-delay must be ≥ 0", "is sent")),
        (["leader", "--stiffness", "9", "--link-delay", "0.49"], ("490 samples", "at most 400")),
        (["leader", "--stiffness", "9", "--damping", "1"], ("no option --damping",)),
        (["leader", "--stiffness", "9", "--compensation-coulomb", "-1"], ("--compensation-coulomb must",)),
        (["leader", "--stiffness", "9", "--plot", "a.txt"], (".png",)),
        (["leader", "--stiffness", "9", "-o", "no/such/a.json"], ("no directory",)),
        (["no-such-arm", "--stiffness", "9"], ("neither a file nor a device",)),
        (["touch", "--stiffness", "9"], ("damping",)),
    ],
)  # fmt: skip
def test_bad_input_ends_in_one_line(files, argv, parts, capsys):
    """Status 2: what was given, the bound, why, and what to try."""
    assert main(["pair", *(files.get(word, word) for word in argv)]) == 2
    error = capsys.readouterr().err
    assert error.count("\n") == 1
    assert all(part in error for part in parts), error


@pytest.mark.parametrize("command", ["check", "limit", "plan"])
def test_other_commands_point_to_it(files, command, capsys):
    """Whoever gives them a pair is told who reads one."""
    assert main([command, files["pair"]]) == 2
    assert "zwidth pair" in capsys.readouterr().err
