"""`zwidth limit`: both sides of a limit, saved, verified, drawn, and one clear line on bad input."""

import json
import re
from pathlib import Path

import pytest

import zwidth as zw
from zwidth.passivity.bracket.passive_limit import BoundedSearch

WALL = "limit haptic-paddle --stiffness 100 --virtual-damping 0.05"
BOUNDED = f"{WALL} --penetration '0.5 mm' --speed '0.3 m/s'"


@pytest.mark.parametrize(
    ("more", "is_told"),
    [
        ("--velocity-filter 'window 2'", True),
        ("--velocity-filter 'window 2' --effort 5", False),
        ("--velocity-filter 'window 2' --speed '0.05 m/s'", False),
        ("", False),
    ],
)
def test_what_may_take_long_is_told_before_it_begins(run, monkeypatch, more, is_told):
    """With what to type instead; nothing where it is a matter of seconds."""

    def begun(_):
        raise zw.InputError("it has begun")

    monkeypatch.setattr(BoundedSearch, "bracket", begun)
    said = " ".join(run(f"{WALL} --penetration '0.224 mm' {more}", 2).err.split())
    assert said.endswith("it has begun")
    assert said.startswith("zwidth: this may take up to about 60 s") == is_told
    assert ("--effort 5" in said) == is_told


def test_the_closed_limit_of_every_hand(run):
    """K = 2 (b − B)/T = 200 N/m: within a per cent on either side."""
    result = run(WALL)
    assert result.out.startswith(" BRACKETED ")
    assert "this hand" not in result.out
    document = run(f"{WALL} --json").json
    assert document["proved_passive_N_per_m"] <= 200 <= document["proved_active_N_per_m"]
    assert document["relative_width"] < 0.01
    assert document["hand"] == "every hand"
    assert document["certificate"]["kind"] == "contact"
    bracket = zw.limit(zw.catalogue.device("haptic-paddle"), zw.Wall(100, 0.05))
    assert bracket.proved_passive == document["proved_passive_N_per_m"]
    assert bracket.proved_active == document["proved_active_N_per_m"]


def test_a_bounded_hand_stands_beside_every_hand(run):
    text = run(f"{BOUNDED} --all").words
    assert "this hand every hand" in text
    assert "0.3 m/s over one sample (13.39 counts a sample), up to 515.2 µm (23 counts)" in text
    assert "per cycle" in text
    document = run(f"{BOUNDED} --json").json
    assert document["proved_passive_N_per_m"] > 2 * document["every_hand_N_per_m"][1]
    assert "certificate" not in document  # as large as the board: --save writes it


def test_what_is_saved_is_verified_on_both_sides(run):
    """A storage function with its bounds, and a motion with its joules; one forged, and neither passes.

    That motion can be simulated, and a storage function alone cannot say that a loop is passive.
    """
    run(f"{BOUNDED} -o limit.json")
    result = run("verify limit.json")
    assert result.out.count(" VALID ") == 1 + 2
    assert "No hand within these bounds" in result.words
    assert "up to 23 counts inside and with any memory, for moves of up to 13.3928 counts" in result.words
    assert "is passive, proved" not in result.words
    document = json.loads(Path("limit.json").read_text(encoding="utf-8"))
    alone = {"outcome": "passive", "certificate": document["certificate"]}
    Path("verdict.json").write_text(json.dumps(alone), encoding="utf-8")
    assert "hands within bounds only" in run("verify verdict.json", 1).words
    loop = f"haptic-paddle --stiffness {document['proved_active_N_per_m']} --virtual-damping 0.05"
    motion = "--operator witness --operator.file limit.json --operator.rounds 100000"
    energy = run(f"simulate {loop} {motion} --amplifier ideal --json").json["energy"]
    assert -energy["hand_work_J"] == pytest.approx(document["witness"]["energy_J"], rel=1e-6)
    document["certificate"]["loop"]["damping_N_s_per_m"] = "0.1"
    Path("forged.json").write_text(json.dumps(document), encoding="utf-8")
    forged = run("verify forged.json", 1).out
    assert "NOT VALID" in forged
    assert " VALID " in forged.replace("NOT VALID", "")


@pytest.mark.parametrize("more", ["", "--penetration '0.5 mm'"], ids=["every hand", "bounded"])
def test_a_picture_is_saved(run, refused, more):
    run(f"{WALL} {more} --plot limit.png")
    assert Path("limit.png").read_bytes().startswith(b"\x89PNG")
    assert "exists" in refused(f"{WALL} --plot limit.png")
    run(f"{WALL} {more} --plot limit.png --force")


@pytest.mark.parametrize(
    ("parameter", "low", "high"),
    [("virtual-damping", 0.0998, 0.1002), ("damping", 0.0998, 0.1003), ("rate", 499, 501)],
)
def test_a_parameter_is_named_as_its_option(run, parameter, low, high):
    document = run(f"{WALL} --parameter {parameter} --json").json
    sides = [v for k, v in document.items() if k.startswith("proved_")]
    assert len(sides) == 2
    assert all(low < side < high for side in sides)


def test_the_stiffness_that_is_sought_need_not_be_given(run):
    """2 (b − B)/T of the paddle, B typed or none; the report has the wall that is proved."""
    assert "environment wall: K = 300 N/m" in run("limit haptic-paddle").words
    found = run("limit haptic-paddle --virtual-damping 0.05 --json").json
    assert found["proved_passive_N_per_m"] == pytest.approx(200, rel=0.01)
    assert "needs --stiffness" in run("limit haptic-paddle --type maxwell", 2).err


def test_the_room_of_a_proof_ends_a_search(run):
    """A delay of 120 samples is the last that is decided: it is printed as such, and check says the same."""
    loop = "--damping 20 --rate '10 kHz' --stiffness 100"
    said = run(f"limit {loop} --parameter delay", 3).words
    (last,) = re.findall(r"delay: ([\d.]+ ms) is proved passive", said)
    assert 11.9 < float(last.split()[0]) < 12.1
    assert re.search(r"beyond the search ended at 12\.\d* ms: .*is 121; at most 120", said)
    run(f"check {loop} --delay '{last}'")


def test_one_side_is_status_three(run):
    """Before no wall at all every damping of the device is passive."""
    out = run("limit haptic-paddle --stiffness 0 --parameter damping --effort 0.5 --all", 3).out
    assert out.startswith(" ONE SIDE ")
    assert "none known" in out


def test_a_search_that_time_ended_says_so(run):
    cut = f"{BOUNDED} --seconds 1e-9"
    assert "the time given was over first" in run(cut, None).out
    assert "the time given was over first" in run(f"{cut} --all", None).out
    assert run(f"{cut} --json", None).json["cut_by_time"]


def test_the_force_limit_is_counted_in(run):
    """What the actuator cannot push cannot be taken out."""
    loop = f"{BOUNDED} --force-limit '0.1 N'"
    with_limit = run(f"{loop} --count-force-limit --json", 3).json
    without = run(f"{loop} --json").json
    assert with_limit["proved_passive_N_per_m"] > without["proved_active_N_per_m"]
    assert any("the force limit is counted in" in line for line in with_limit["assumptions"])


def test_the_converter_is_counted_in(run, refused):
    """Steps that the friction does not cover take the loop apart; without any there is nothing to count."""
    hand = "--stiffness 100 --speed '0.1 m/s' --penetration '0.3 mm' --count-force-resolution"
    coarse = "limit haptic-paddle --force-resolution '0.05 N' --parameter coulomb-friction"
    found = run(f"{coarse} {hand} --json").json
    assert found["proved_active_N"] < 0.025 <= found["proved_passive_N"]
    assert any("the converter steps are counted in" in line for line in found["assumptions"])
    assert "no force_resolution" in refused(
        f"limit --damping 0.1 --rate 1000 --coulomb-friction 0.1 --resolution '20 um' {hand}"
    )


def test_a_contact(run):
    contact = "haptic-paddle --type hunt-crossley --stiffness 1e4 --dissipation '1 s/m'"
    loop = f"limit {contact} --speed '0.2 m/s' --penetration '0.5 mm'"
    found = run(loop)
    assert "N/m^1.5 is proved passive" in found.out
    assert "Hunt–Crossley contact, 10000 N/m^1.5, exponent 1.5, 1 s/m" in found.words
    document = run(f"{loop} --parameter dissipation --json").json
    assert document["proved_passive_s_per_m"] < document["proved_active_s_per_m"]


def test_a_spring_given_by_points_has_a_gain(run):
    """The parameter of a law without a stiffness of its own."""
    Path("detent.toml").write_text(
        '[environment]\ntype = "nonlinear-spring"\npositions = [-0.002, -0.001, 0, 0.001, 0.002]\n'
        "forces = [0, -0.4, 0, 0.4, 0]\n",
        encoding="utf-8",
    )
    result = run("limit haptic-paddle detent.toml --parameter gain --tolerance 0.1", None)
    assert result.status in (0, 3)
    assert "gain" in result.out
    assert "proved nonlinear spring, 5 points" in result.words  # the forces to write: a gain is no option


@pytest.mark.parametrize("more", ["", "--parameter stiffness"])
def test_an_environment_without_a_stiffness_asks_which_limit(refused, more):
    Path("stop.toml").write_text(
        '[environment]\ntype = "nonlinear-spring"\npositions = [0, "1 cm"]\nforces = [0, "4 N"]\n',
        encoding="utf-8",
    )
    error = refused(f"limit haptic-paddle stop.toml --coulomb-friction 0.1 {more}")
    assert all(part in error for part in ("--parameter", "gain", "rate"))


PAGE = (Path(__file__).resolve().parents[2] / "docs" / "limit.md").read_text(encoding="utf-8")


@pytest.mark.parametrize("command", re.findall(r"^\$ zwidth (.+)$", PAGE, re.MULTILINE))
def test_the_commands_of_the_page_find_both_sides(command, run):
    run(command)


def test_the_python_of_the_page_says_what_comes_out(tmp_path, monkeypatch):
    monkeypatch.chdir(tmp_path)
    names = {}
    exec("".join(re.findall(r"```python\n(.*?)```", PAGE, re.DOTALL)), names)
    bracket, found = names["bracket"], names["found"]
    assert f"# ({bracket.proved_passive:g}, {bracket.proved_active:g})" in PAGE
    assert f"# ({bracket.every_hand[0]:g}, {bracket.every_hand[1]:g})" in PAGE
    assert found.outcome == "passive"
    for speed in ("0.1", "0.25", "0.5", "1"):
        row = zw.limit(names["paddle"], names["wall"], speed=speed, penetration="0.002")
        (found,) = re.findall(rf"^\| {re.escape(speed)} m/s \| (\d+) N/m \| (\d+) N/m \|$", PAGE, re.M)
        for told, value in zip(map(float, found), (row.proved_passive, row.proved_active), strict=True):
            assert told == pytest.approx(value, rel=0.015)  # the bracket may be one per cent wide
