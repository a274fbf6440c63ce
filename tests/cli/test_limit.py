"""`zwidth limit`: both sides of a limit, saved, verified, drawn, and one clear line on bad input."""

from __future__ import annotations

import json
import re
import shlex
from collections.abc import Callable
from pathlib import Path
from typing import Any, NamedTuple

import pytest

import zwidth as zw
from zwidth.cli.main import main
from zwidth.passivity.bracket.passive_limit import BoundedSearch

WALL = ("limit", "haptic-paddle", "--stiffness", "100", "--virtual-damping", "0.05")
BOUNDED = (*WALL, "--penetration", "0.5 mm", "--speed", "0.3 m/s")


class Result(NamedTuple):
    """What one command line left behind."""

    status: int
    out: str
    err: str


Run = Callable[..., Result]


@pytest.fixture
def run(capsys: pytest.CaptureFixture[str], tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> Run:
    """Runs a command line in this process and in an empty directory."""
    monkeypatch.chdir(tmp_path)

    def runner(*argv: str) -> Result:
        status = main(argv)
        return Result(status, *capsys.readouterr())

    return runner


def words(result: Result) -> str:
    """The report on one line."""
    return " ".join(result.out.split())


@pytest.mark.parametrize(
    ("more", "is_told"),
    [
        (("--velocity-filter", "window 2"), True),
        (("--velocity-filter", "window 2", "--effort", "5"), False),
        (("--velocity-filter", "window 2", "--speed", "0.05 m/s"), False),
        ((), False),
    ],
)
def test_what_may_take_long_is_told_before_it_begins(run: Run, monkeypatch, more, is_told) -> None:
    """With what to type instead; nothing where it is a matter of seconds."""

    def begun(_: BoundedSearch) -> None:
        raise zw.InputError("it has begun")

    monkeypatch.setattr(BoundedSearch, "bracket", begun)
    said = " ".join(run(*WALL, "--penetration", "0.224 mm", *more).err.split())
    assert said.endswith("it has begun")
    assert said.startswith("zwidth: this may take up to about 60 s") == is_told
    assert ("--effort 5" in said) == is_told


def test_the_closed_limit_of_every_hand(run: Run) -> None:
    """K = 2 (b − B)/T = 200 N/m: within a per cent on either side."""
    result = run(*WALL)
    assert result.status == 0
    assert result.out.startswith(" BRACKETED ")
    assert "this hand" not in result.out
    document = json.loads(run(*WALL, "--json").out)
    assert document["proved_passive_N_per_m"] <= 200 <= document["proved_active_N_per_m"]
    assert document["relative_width"] < 0.01
    assert document["hand"] == "every hand"
    assert document["certificate"]["kind"] == "contact"


def test_a_bounded_hand_stands_beside_every_hand(run: Run) -> None:
    """Slow hands allow stiffer walls; the report says how slow, and what every hand allows."""
    text = words(run(*BOUNDED, "--all"))
    assert "this hand every hand" in text
    assert "0.3 m/s over one sample (13.39 counts a sample), up to 515.2 µm (23 counts)" in text
    assert "per cycle" in text
    document = json.loads(run(*BOUNDED, "--json").out)
    assert document["proved_passive_N_per_m"] > 2 * document["every_hand_N_per_m"][1]
    assert "certificate" not in document  # as large as the board: --save writes it


def test_what_is_saved_is_verified_on_both_sides(run: Run) -> None:
    """A storage function with its bounds, and a motion with its joules; one forged, and neither passes."""
    assert run(*BOUNDED, "-o", "limit.json").status == 0
    result = run("verify", "limit.json")
    assert result.status == 0
    assert result.out.count(" VALID ") == 1 + 2
    assert "No hand within these bounds" in words(result)
    assert "up to 23 counts inside and with any memory, for moves of up to 13.3928 counts" in words(result)
    assert "is passive, proved" not in words(result)
    document = json.loads(Path("limit.json").read_text(encoding="utf-8"))
    document["certificate"]["loop"]["damping_N_s_per_m"] = "0.1"
    Path("forged.json").write_text(json.dumps(document), encoding="utf-8")
    forged = run("verify", "forged.json")
    assert forged.status == 1
    assert "NOT VALID" in forged.out
    assert " VALID " in forged.out.replace("NOT VALID", "")


def test_bounded_evidence_does_not_carry_a_verdict_for_every_hand(run: Run) -> None:
    """A storage function alone cannot say that a loop is passive."""
    run(*BOUNDED, "-o", "limit.json")
    certificate = json.loads(Path("limit.json").read_text(encoding="utf-8"))["certificate"]
    Path("verdict.json").write_text(
        json.dumps({"outcome": "passive", "certificate": certificate}), encoding="utf-8"
    )
    result = run("verify", "verdict.json")
    assert result.status == 1
    assert "hands within bounds only" in words(result)


def test_the_saved_motion_is_prescribed_to_the_simulator(run: Run) -> None:
    """Its repeats are one object, not a list."""
    run(*BOUNDED, "-o", "limit.json")
    active = json.loads(Path("limit.json").read_text(encoding="utf-8"))["proved_active_N_per_m"]
    result = run(
        "simulate", "haptic-paddle", "--stiffness", str(active), "--virtual-damping", "0.05",
        "--operator", "witness", "--operator.file", "limit.json", "--operator.rounds", "100000",
        "--amplifier", "ideal", "--json",
    )  # fmt: skip
    energy = json.loads(Path("limit.json").read_text(encoding="utf-8"))["witness"]["energy_J"]
    assert -json.loads(result.out)["energy"]["hand_work_J"] == pytest.approx(energy, rel=1e-6)


@pytest.mark.parametrize("more", [(), ("--penetration", "0.5 mm")])
def test_a_picture_is_saved(run: Run, more: tuple[str, ...]) -> None:
    assert run(*WALL, *more, "--plot", "limit.png").status == 0
    assert Path("limit.png").read_bytes().startswith(b"\x89PNG")
    assert "exists" in run(*WALL, "--plot", "limit.png").err
    assert run(*WALL, *more, "--plot", "limit.png", "--force").status == 0


@pytest.mark.parametrize(
    ("parameter", "low", "high"),
    [("virtual-damping", 0.0998, 0.1002), ("damping", 0.0998, 0.1003), ("rate", 499, 501)],
)
def test_a_parameter_is_named_as_its_option(run: Run, parameter: str, low: float, high: float) -> None:
    document = json.loads(run(*WALL, "--parameter", parameter, "--json").out)
    sides = [v for k, v in document.items() if k.startswith("proved_")]
    assert len(sides) == 2
    assert all(low < side < high for side in sides)


def test_one_side_is_status_three(run: Run) -> None:
    """Before no wall at all every damping of the device is passive."""
    loop = ("limit", "haptic-paddle", "--stiffness", "0", "--parameter", "damping")
    result = run(*loop, "--effort", "0.5", "--all")
    assert result.status == 3
    assert result.out.startswith(" ONE SIDE ")
    assert "none known" in result.out


def test_a_search_that_time_ended_says_so(run: Run) -> None:
    """In the report, short and in full, and in the document."""
    cut = (*BOUNDED, "--seconds", "1e-9")
    assert "the time given was over first" in run(*cut).out
    assert "the time given was over first" in run(*cut, "--all").out
    assert json.loads(run(*cut, "--json").out)["cut_by_time"]


def test_the_force_limit_is_counted_in(run: Run) -> None:
    """What the actuator cannot push cannot be taken out."""
    loop = (*BOUNDED, "--force-limit", "0.1 N")
    with_limit = json.loads(run(*loop, "--count-force-limit", "--json").out)
    without = json.loads(run(*loop, "--json").out)
    assert with_limit["proved_passive_N_per_m"] > without["proved_active_N_per_m"]
    assert any("the force limit is counted in" in line for line in with_limit["assumptions"])


def test_the_converter_is_counted_in(run: Run) -> None:
    """Steps that the friction does not cover take the loop apart; without any there is nothing to count."""
    loop = ("limit", "haptic-paddle", "--stiffness", "100", "--speed", "0.1 m/s", "--penetration", "0.3 mm")
    coarse = (*loop, "--force-resolution", "0.05 N", "--parameter", "coulomb-friction")
    found = json.loads(run(*coarse, "--count-force-resolution", "--json").out)
    assert found["proved_active_N"] < 0.025 <= found["proved_passive_N"]
    assert any("the converter steps are counted in" in line for line in found["assumptions"])
    refused = run("limit", "novint-falcon", "--damping", "0.1", *loop[2:], "--count-force-resolution")
    assert refused.status == 2
    assert "no force_resolution" in refused.err


def test_a_contact(run: Run) -> None:
    """K in its own unit, and λ as a parameter."""
    loop = (
        "limit",
        "haptic-paddle",
        "--type",
        "hunt-crossley",
        "--stiffness",
        "1e4",
        "--dissipation",
        "1 s/m",
    )
    found = run(*loop, "--speed", "0.2 m/s", "--penetration", "0.5 mm")
    assert found.status == 0
    assert "N/m^1.5 is proved passive" in found.out
    assert "Hunt–Crossley contact, 10000 N/m^1.5, exponent 1.5, 1 s/m" in words(found)
    short = ("--speed", "0.2 m/s", "--penetration", "0.5 mm", "--parameter", "dissipation", "--json")
    document = json.loads(run(*loop, *short).out)
    assert document["proved_passive_s_per_m"] < document["proved_active_s_per_m"]


@pytest.mark.parametrize(
    ("argv", "part"),
    [
        (("--parameter", "stifness"), 'did you mean "stiffness"'),
        (("--parameter", "velocity-filter"), "not one number"),
        (("--speed", "-1"), "speed must be > 0"),
        (("--speed", "3 N"), "speed is in m/s"),
        (("--seconds", "0"), "seconds must be > 0"),
        (("--effort", "0"), "effort must be > 0"),
        (("--tolerance", "2"), "tolerance must be a number from"),
        (("--resolution", "0", "--penetration", "1 mm"), "resolution is 0"),
        (("--damping", "0.1 .. 0.2"), "no single value"),
        (("--plot", "limit.txt"), ".png"),
        (("--plot", "same.svg", "-o", "same.svg"), "same file"),
    ],
)
def test_bad_input_is_one_line(run: Run, argv: tuple[str, ...], part: str) -> None:
    result = run(*WALL, *argv)
    assert result.status == 2
    assert result.out == ""
    assert result.err.count("\n") == 1
    assert part in result.err


def test_a_spring_given_by_points_has_a_gain(tmp_path: Path, run: Run) -> None:
    """The parameter of a law without a stiffness of its own."""
    Path("detent.toml").write_text(
        '[environment]\ntype = "nonlinear-spring"\npositions = [-0.002, -0.001, 0, 0.001, 0.002]\n'
        "forces = [0, -0.4, 0, 0.4, 0]\n",
        encoding="utf-8",
    )
    result = run("limit", "haptic-paddle", "detent.toml", "--parameter", "gain", "--tolerance", "0.1")
    assert result.status in (0, 3)
    assert "gain" in result.out


def test_python_gives_what_the_command_line_prints(run: Run) -> None:
    document = json.loads(run(*WALL, "--json").out)
    bracket = zw.limit(zw.catalogue.device("haptic-paddle"), zw.Wall(100, 0.05))
    assert bracket.proved_passive == document["proved_passive_N_per_m"]
    assert bracket.proved_active == document["proved_active_N_per_m"]


PAGE = (Path(__file__).resolve().parents[2] / "docs" / "limit.md").read_text(encoding="utf-8")


@pytest.mark.parametrize("command", re.findall(r"^\$ zwidth (.+)$", PAGE, re.MULTILINE))
def test_the_commands_of_the_page_find_both_sides(command: str, run: Run) -> None:
    assert run(*shlex.split(command)).status == 0


def test_the_python_of_the_page_says_what_comes_out(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    """Its comments and the table of speeds are true."""
    monkeypatch.chdir(tmp_path)
    names: dict[str, Any] = {}
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


def test_an_environment_without_a_stiffness_asks_which_limit(
    tmp_path: Path, capsys: pytest.CaptureFixture[str]
) -> None:
    """One message that names --parameter, and what can be asked of the stop and of the device."""
    stop = tmp_path / "stop.toml"
    stop.write_text(
        '[environment]\ntype = "nonlinear-spring"\npositions = [0, "1 cm"]\nforces = [0, "4 N"]\n',
        encoding="utf-8",
    )
    assert main(["limit", "haptic-paddle", str(stop), "--coulomb-friction", "0.1"]) == 2
    error = capsys.readouterr().err
    assert "--parameter" in error
    assert "gain" in error
    assert "rate" in error
    assert error.count("\n") == 1
