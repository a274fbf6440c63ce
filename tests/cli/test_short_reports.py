"""Reports in the terminal: the answer first, some fifteen lines, never wider than the page."""

import re
from pathlib import Path

import pytest
from rich.cells import cell_len

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
PADDLE = "haptic-paddle --stiffness"
TOUCH = f"simulate {PADDLE} 770 --operator dowel --duration 0.1"

SHORT = {
    "passive": (f"check {PADDLE} 300", "PASSIVE"),
    "active": (f"check {PADDLE} 770", "ACTIVE"),
    "of an interval": (f"check {PADDLE} '200 .. 400'", "UNDECIDED"),
    "of a wheel": ("check wheel.toml --stiffness 300", "PASSIVE"),
    "of a chain": (f"check {PADDLE} 770 --law force-bounding", "PASSIVE"),
    "limit": (f"limit {PADDLE} 100 --virtual-damping 0.05", "BRACKETED"),
    "pair": ("pair arm.toml --stiffness 100 --link-delay '2 ms'", "PASSIVE"),
    "active pair": ("pair arm.toml --stiffness 300 --link-delay '5 ms'", "ACTIVE"),
    "simulate": (TOUCH, "GAINED"),
    "compare": (f"compare {PADDLE} 2000 --laws wall,virtual-damping", "wall, 2000 N/m"),
}
"""Command lines, and with what their first line begins; these are short."""

OTHERS = {
    "workspace": ("workspace two-link --joint-damping 0.0002 --stiffness 500 --points 8", "ACTIVE"),
    "gains": ("gains leader.yaml --plant plant.toml", "PASSIVE"),
    "a joint": ("gains leader.yaml --plant plant.toml --joint J1", "PASSIVE"),
    "links": ("links arm.toml --delay '20 ms' --loss 0.5", "passive over every link"),
    "map": ("map haptic-paddle --stiffness 0:900 --virtual-damping 0:1 --cells 4x4", "region"),
    "plan": ("plan haptic-paddle --force-noise '0.1 N'", "To know b"),
    "devices": ("devices", "haptic-paddle"),
    "doctor": ("doctor haptic-paddle --duration '1 s'", "a loop at 1 kHz"),
    "emit": (f"emit {PADDLE} 150 --travel '-9 .. 9 mm' -o out", "PASSIVE"),
}
"""Those that are as long as they have to be."""

BOTH = {**SHORT, **OTHERS}
MOST_LINES = 20
"""Of a short report, blank lines among them."""


@pytest.fixture
def shown(run, monkeypatch):
    """Runs a command line in so many columns, beside some files; its lines fit, and none ends in blanks."""
    plant = "[arm]\ndamping = [0.4, 0.5]\ncoulomb_friction = 0.1\n"
    files = {"arm.toml": ARM, "wheel.toml": TURNS, "leader.yaml": GAINS, "plant.toml": plant}
    for name, text in files.items():
        Path(name).write_text(text, encoding="utf-8")

    def runner(line, columns=80):
        monkeypatch.setenv("COLUMNS", str(columns))
        result = run(line, None)
        assert result.status != 2, result.err
        lines = result.out.rstrip("\n").split("\n")
        most = min(columns, 100)
        assert "--json" in line or all(cell_len(one) <= most and one == one.rstrip() for one in lines), lines
        return lines

    return runner


@pytest.mark.parametrize("name", BOTH)
def test_a_report_fits_and_begins_with_the_answer(shown, name):
    """No colours; the answer on the first line."""
    line, answer = BOTH[name]
    lines = shown(line)
    assert lines[0].strip().startswith(answer)
    assert "\x1b" not in "".join(lines)
    assert len(lines) <= MOST_LINES or name in OTHERS


@pytest.mark.parametrize(
    "name", ["passive", "of a chain", "limit", "active pair", "simulate", "compare", "workspace", "gains"]
)
def test_all_prints_the_rest_in_the_same_width(shown, name):
    """The same answer, more lines; what the short one has that can be said in both is in both."""
    line, answer = BOTH[name]
    short, whole = shown(line), shown(f"{line} --all")
    assert whole[0].strip().startswith(answer)
    assert len(whole) > len(short)
    assert any(one.startswith("--all shows the rest: ") for one in short)
    assert not any(one.startswith("--all") for one in whole)


@pytest.mark.parametrize("columns", [40, 200])
@pytest.mark.parametrize("name", ["passive", "active pair", "plan", "map"])
def test_a_narrow_and_a_wide_terminal(shown, name, columns):
    """As wide as it is, and never wider than 100."""
    line, answer = BOTH[name]
    assert shown(line, columns)[0].strip().startswith(answer[:20])


@pytest.mark.parametrize("name", ["passive", "pair"])
def test_json_is_the_same_with_all_and_without(shown, name):
    line, _ = SHORT[name]
    assert shown(f"{line} --json") == shown(f"{line} --json --all")


def test_a_served_loop_and_its_recording(shown):
    """The report at the end says where the recording is; what is read from it fits too."""
    served = shown(f"serve {PADDLE} 100 --virtual-damping 0 --duration 0.3 -o session.mcap")
    assert served[-1] == "written: session.mcap"
    replayed = shown("replay session.mcap -o session.nc")
    assert replayed[0].startswith("law 0: ")
    assert replayed[-1] == "written: session.nc"


def test_saved_touches_beside_each_other(shown):
    shown(f"{TOUCH} -o one.nc")
    shown(f"{TOUCH} -o another_with_a_name_that_is_rather_long.nc")
    shown("traces one.nc another_with_a_name_that_is_rather_long.nc")


def test_a_saved_proof_is_verified_in_the_same_width(shown):
    """The answer first, and a part for each proof and motion with its own."""
    assert shown(f"check {PADDLE} 770 -o proof.json")[-1] == "written: proof.json"
    lines = shown("verify proof.json")
    assert lines[0].startswith(" VALID  all 2 proofs and motions below")
    assert lines[2].startswith(" VALID  A hand can take any amount of energy out")


def test_workspace_says_what_it_wrote(shown):
    line, _ = OTHERS["workspace"]
    assert shown(f"{line} -o arm.json --plot arm.svg")[-2:] == ["written: arm.json", "written: arm.svg"]


def test_what_the_actuator_fails_is_said(shown):
    """The claim takes it for ideal: a check that it fails stands in the short report, by its name."""
    lines = shown(f"check {PADDLE} 100 --virtual-damping 0.05")
    assert "actuator     not as ideal as is assumed: force resolution" in lines


def test_a_wide_name_takes_two_columns_a_character(shown):
    """Lines are measured as a terminal shows them."""
    lines = shown(f"check {PADDLE} 300 --name {'力覚' * 9}", 40)
    assert "力覚" * 9 in re.sub(r"\s", "", "".join(lines))
