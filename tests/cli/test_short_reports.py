"""Reports in the terminal: the answer first, some fifteen lines, never wider than the page."""

from __future__ import annotations

import re
from collections.abc import Callable
from pathlib import Path

import pytest
from rich.cells import cell_len

from zwidth.cli.main import main

ARM = """[device]
mass = 0.3
damping = 0.4
coulomb_friction = 0.1
resolution = "20 um"
rate = "1 kHz"
"""
TURNS = """[device]
motion = "rotary"
name = "wheel"
inertia = 0.05
damping = 0.2
coulomb_friction = 0.1
resolution = "0.1 mrad"
rate = "1 kHz"
"""
GAINS = "LeaderArmParam:\n  Kp: [20, 25]\n  Kd: [0.05, 0.02]\n"
PADDLE = ("haptic-paddle", "--stiffness")
TOUCH = ("simulate", *PADDLE, "770", "--operator", "dowel", "--duration", "0.1")
SERVED = ("serve", *PADDLE, "100", "--virtual-damping", "0", "--duration", "0.3")

SHORT = {
    "passive": (("check", *PADDLE, "300"), "PASSIVE"),
    "active": (("check", *PADDLE, "770"), "ACTIVE"),
    "of an interval": (("check", *PADDLE, "200 .. 400"), "UNDECIDED"),
    "of a wheel": (("check", "wheel.toml", "--stiffness", "300"), "PASSIVE"),
    "of a chain": (("check", *PADDLE, "770", "--law", "force-bounding"), "PASSIVE"),
    "limit": (("limit", *PADDLE, "100", "--virtual-damping", "0.05"), "BRACKETED"),
    "pair": (("pair", "arm.toml", "--stiffness", "100", "--link-delay", "2 ms"), "PASSIVE"),
    "active pair": (("pair", "arm.toml", "--stiffness", "300", "--link-delay", "5 ms"), "ACTIVE"),
    "simulate": (TOUCH, "ACTIVE"),
    "compare": (("compare", *PADDLE, "2000", "--laws", "wall,virtual-damping"), "wall, 2000 N/m"),
}
"""Command lines, and with what their first line begins; these are short."""

OTHERS = {
    "workspace": (
        ("workspace", "two-link", "--joint-damping", "0.0002", "--stiffness", "500", "--points", "8"),
        "ACTIVE",
    ),
    "gains": (("gains", "leader.yaml", "--plant", "plant.toml"), "PASSIVE"),
    "a joint": (("gains", "leader.yaml", "--plant", "plant.toml", "--joint", "J1"), "PASSIVE"),
    "links": (("links", "arm.toml", "--delay", "20 ms", "--loss", "0.5"), "passive over every link"),
    "map": (
        ("map", "haptic-paddle", "--stiffness", "0:900", "--virtual-damping", "0:1", "--cells", "4x4"),
        "region",
    ),
    "plan": (("plan", "haptic-paddle", "--force-noise", "0.1 N"), "To know b"),
    "devices": (("devices",), "haptic-paddle"),
    "doctor": (("doctor", "haptic-paddle", "--duration", "1 s"), "a loop at 1 kHz"),
    "emit": (("emit", *PADDLE, "150", "--travel", "-9 .. 9 mm", "-o", "out"), "PASSIVE"),
}
"""Those that are as long as they have to be."""

MOST_LINES = 20
"""Of a short report, blank lines among them."""

Run = Callable[..., list[str]]


@pytest.fixture
def run(tmp_path: Path, monkeypatch: pytest.MonkeyPatch, capsys: pytest.CaptureFixture[str]) -> Run:
    """Runs a command line in so many columns, in a folder with some files; the lines that it prints."""
    for name, text in {
        "arm.toml": ARM,
        "wheel.toml": TURNS,
        "leader.yaml": GAINS,
        "plant.toml": "[arm]\ndamping = [0.4, 0.5]\ncoulomb_friction = 0.1\n",
    }.items():
        (tmp_path / name).write_text(text, encoding="utf-8")
    monkeypatch.chdir(tmp_path)

    def runner(*argv: str, columns: int = 80) -> list[str]:
        monkeypatch.setenv("COLUMNS", str(columns))
        status = main(argv)
        out, err = capsys.readouterr()
        assert status != 2, err
        return out.rstrip("\n").split("\n")

    return runner


def _fits(lines: list[str], columns: int) -> bool:
    return all(cell_len(line) <= columns and line == line.rstrip() for line in lines)


@pytest.mark.parametrize("name", [*SHORT, *OTHERS])
def test_a_report_fits_and_begins_with_the_answer(run: Run, name: str) -> None:
    """80 columns, no blanks at line ends, no colours; the answer on the first line."""
    argv, answer = {**SHORT, **OTHERS}[name]
    lines = run(*argv)
    assert lines[0].strip().startswith(answer)
    assert _fits(lines, 80), [line for line in lines if cell_len(line) > 80]
    assert "\x1b" not in "".join(lines)
    assert len(lines) <= MOST_LINES or name in OTHERS


@pytest.mark.parametrize(
    "name", ["passive", "of a chain", "limit", "active pair", "simulate", "compare", "workspace", "gains"]
)
def test_all_prints_the_rest_in_the_same_width(run: Run, name: str) -> None:
    """The same answer, more lines; what the short one has that can be said in both is in both."""
    argv, answer = {**SHORT, **OTHERS}[name]
    short, whole = run(*argv), run(*argv, "--all")
    assert whole[0].strip().startswith(answer)
    assert len(whole) > len(short)
    assert _fits(whole, 80), [line for line in whole if cell_len(line) > 80]
    assert any(line.startswith("--all shows the rest: ") for line in short)
    assert not any(line.startswith("--all") for line in whole)


@pytest.mark.parametrize("columns", [40, 200])
@pytest.mark.parametrize("name", ["passive", "active pair", "plan", "map"])
def test_a_narrow_and_a_wide_terminal(run: Run, name: str, columns: int) -> None:
    """As wide as it is, and never wider than 100."""
    argv, answer = {**SHORT, **OTHERS}[name]
    lines = run(*argv, columns=columns)
    assert lines[0].strip().startswith(answer[:20])
    assert _fits(lines, min(columns, 100)), lines


@pytest.mark.parametrize("name", ["passive", "pair"])
def test_json_is_the_same_with_all_and_without(run: Run, name: str) -> None:
    """--all is of the report alone."""
    argv, _ = SHORT[name]
    assert run(*argv, "--json") == run(*argv, "--json", "--all")


def test_a_served_loop_and_its_recording(run: Run) -> None:
    """The report at the end says where the recording is; what is read from it fits too."""
    served = run(*SERVED, "-o", "session.mcap")
    assert served[-1] == "written: session.mcap"
    assert _fits(served, 80), served
    replayed = run("replay", "session.mcap", "-o", "session.nc")
    assert replayed[0].startswith("law 0: ")
    assert replayed[-1] == "written: session.nc"
    assert _fits(replayed, 80), replayed


def test_saved_touches_beside_each_other(run: Run) -> None:
    """A column for each."""
    run(*TOUCH, "-o", "one.nc")
    run(*TOUCH, "-o", "another_with_a_name_that_is_rather_long.nc")
    lines = run("traces", "one.nc", "another_with_a_name_that_is_rather_long.nc")
    assert _fits(lines, 80), lines


def test_a_saved_proof_is_verified_in_the_same_width(run: Run) -> None:
    """The answer first, and a part for each proof and motion with its own."""
    assert run("check", *PADDLE, "770", "-o", "proof.json")[-1] == "written: proof.json"
    lines = run("verify", "proof.json")
    assert lines[0].startswith(" VALID  all 2 proofs and motions below")
    assert lines[2].startswith(" VALID  A hand can take any amount of energy out")
    assert _fits(lines, 80), lines


def test_workspace_says_what_it_wrote(run: Run) -> None:
    """The verdict and the map, a line each."""
    argv, _ = OTHERS["workspace"]
    assert run(*argv, "-o", "arm.json", "--plot", "arm.svg")[-2:] == ["written: arm.json", "written: arm.svg"]


def test_what_the_actuator_fails_is_said(run: Run) -> None:
    """The claim takes it for ideal: a check that it fails stands in the short report, by its name."""
    lines = run("check", *PADDLE, "100", "--virtual-damping", "0.05")
    assert "actuator     not as ideal as is assumed: force resolution" in lines


def test_a_wide_name_takes_two_columns_a_character(run: Run) -> None:
    """Lines are measured as a terminal shows them."""
    lines = run("check", *PADDLE, "300", "--name", "力覚" * 9, columns=40)
    assert _fits(lines, 40), lines
    assert "力覚" * 9 in re.sub(r"\s", "", "".join(lines))
