"""`zwidth identify`: a device from a log, its file and plot, the walls it allows; one line on bad input."""

from __future__ import annotations

import json
import shutil
from collections.abc import Callable
from pathlib import Path
from typing import NamedTuple

import numpy as np
import pytest
from known_motion import STEP, paddle

from zwidth.cli.main import main

COUNTS = (
    *("--column", "position=enc", "--column", "hand-force=F1_N"),
    *("--unit", "position=counts", "--resolution", "22.4 um"),
)
"""What log.csv does not say itself."""


class Result(NamedTuple):
    """What one command line left behind."""

    status: int
    out: str
    err: str


Run = Callable[..., Result]


@pytest.fixture(scope="module")
def logs(tmp_path_factory: pytest.TempPathFactory) -> Path:
    """Logs: log.csv in counts, plain.csv that explains itself, free.csv without force, and bad ones."""
    folder = tmp_path_factory.mktemp("logs")
    time, position, force = paddle()

    def write(name: str, header: str, *columns: np.ndarray) -> None:
        np.savetxt(
            folder / name, np.stack(columns, axis=1), delimiter=",", header=header, comments="", fmt="%.9g"
        )

    write("log.csv", "t_s,enc,F1_N", time, np.rint(position / STEP), force)
    write("plain.csv", "time_s,position_mm,hand_force_N", time, 1e3 * position, force)
    write("odd.csv", "t_s,a,b", time, position, force)
    write("free.csv", "time_s,position_mm", time, 1e3 * position)
    write("short.csv", "time_s,position_mm,hand_force_N", time[:90], 1e3 * position[:90], force[:90])
    return folder


@pytest.fixture
def run(
    capsys: pytest.CaptureFixture[str], tmp_path: Path, monkeypatch: pytest.MonkeyPatch, logs: Path
) -> Run:
    """Runs `zwidth identify` in this process, beside copies of the logs."""
    shutil.copytree(logs, tmp_path, dirs_exist_ok=True)
    monkeypatch.chdir(tmp_path)

    def runner(*argv: str, command: str = "identify") -> Result:
        status = main((command, *argv))
        return Result(status, *capsys.readouterr())

    return runner


def words(result: Result) -> str:
    """The report on one line."""
    return " ".join(result.out.split())


def test_the_report(run: Run) -> None:
    """What the log is, the numbers with intervals, the stiffest wall, what to do next."""
    result = run("plain.csv", "--all")
    assert (result.status, result.err) == (0, "")
    assert result.out.startswith(" IDENTIFIED  Spring walls up to ")
    text = words(result)
    for part in (
        "plain.csv: 20 s, 20000 samples",
        "T = 1 ms, Δ = 22.4 µm, hand force",
        "95 % interval",
        "2b/T",
        "2f_c/Δ",
        "r² = ",
        "a mass–damper model of the same data would say",
        "damping limits the wall",
        "times as long would halve the interval",
        "resolution 2.24e-05 m from the positions",
    ):
        assert part in text


def test_columns_units_and_steps_on_the_command_line(run: Run) -> None:
    """Odd names and counts give the same device as a log that explains itself."""
    one = json.loads(run("log.csv", *COUNTS, "--json").out)
    other = json.loads(run("plain.csv", "--json").out)
    assert one["resolution_m"] == pytest.approx(other["resolution_m"], rel=1e-12)
    assert one["damping_N_s_per_m"]["value"] == pytest.approx(other["damping_N_s_per_m"]["value"], rel=1e-5)
    assert one["log"] == other["log"] == {
        "samples": 20_000, "runs": 1, "duration_s": 20.0, "channels": ["hand_force"],
    }  # fmt: skip


def test_the_saved_device_is_what_check_reads(run: Run) -> None:
    """A wall below the limit of the report is proved on the file, one above it is not."""
    limit = json.loads(run("plain.csv", "-o", "mine.toml", "--json").out)["stiffest_by_damping_N_per_m"]
    low, high = limit["interval"]
    assert run("mine.toml", "--stiffness", f"{0.999 * low:g}", command="check").status == 0
    assert run("mine.toml", "--stiffness", f"{1.001 * low:g}", command="check").status == 3
    assert run("mine.toml", "--stiffness", f"{1.01 * high:g}", command="check").status == 1


def test_an_environment_is_checked_at_once(run: Run) -> None:
    """For how much of what the data allow it is passive; the status is that of check."""
    limit = json.loads(run("plain.csv", "--json").out)["stiffest_by_damping_N_per_m"]
    easy = run("plain.csv", "--stiffness", f"{0.5 * limit['interval'][0]:g}")
    assert easy.status == 0
    assert "passive for 99.9999 % or more of what the data allow" in words(easy)
    between = f"{(limit['interval'][0] + limit['value']) / 2:g}"
    undecided = run("plain.csv", "--stiffness", between, "--json")
    assert undecided.status == 3
    document = json.loads(undecided.out)
    assert 0 < document["passive_for"] < 0.99
    assert document["check"]["outcome"] == "undecided"
    hard = run("plain.csv", "--stiffness", f"{2 * limit['value']:g}")
    assert hard.status == 1
    assert "not proved passive, even for the best guess" in words(hard)


def test_the_confidence_is_the_stated_one(run: Run) -> None:
    """A wall that is proved at 80 % need not be at 99.9 %; 80% and 0.8 are the same."""
    low, _ = json.loads(run("plain.csv", "--json", "--confidence", "95%").out)["stiffest_by_damping_N_per_m"][
        "interval"
    ]
    assert run("plain.csv", "--stiffness", f"{low:.6g}", "--confidence", "80 %").status == 0
    assert run("plain.csv", "--stiffness", f"{low:.6g}", "--confidence", "0.8").status == 0
    assert run("plain.csv", "--stiffness", f"{low:.6g}", "--confidence", "99.9%").status == 3


def test_an_environment_from_a_file(run: Run) -> None:
    """Its parameters can be overridden; a device in the same file is refused."""
    Path("wall.toml").write_text('[environment]\ntype = "wall"\nstiffness = 1\n', encoding="utf-8")
    assert "K = 1 N/m" in words(run("plain.csv", "wall.toml"))
    assert "K = 2 N/m" in words(run("plain.csv", "wall.toml", "--stiffness", "2"))
    Path("both.toml").write_text(
        "[device]\ndamping = 1\nrate = 1\n[environment]\nstiffness = 1\n", encoding="utf-8"
    )
    result = run("plain.csv", "both.toml")
    assert result.status == 2
    assert "the device comes from the log" in result.err


def test_a_delay_counts_in_the_wall_and_in_the_file(run: Run) -> None:
    """Half a sample of delay takes half of what damping allows, about; the file has it too."""
    delayed = run("plain.csv", "--delay", "0.5 ms", "-o", "d.toml")
    stiffest = float(words(delayed).split("Spring walls up to ")[1].split()[0])
    plain = float(words(run("plain.csv")).split("Spring walls up to ")[1].split()[0])
    assert 0.4 * plain < stiffest < 0.55 * plain
    assert "delay = 0.0005  # s: as given" in Path("d.toml").read_text(encoding="utf-8")
    assert run("d.toml", "--stiffness", f"{0.999 * stiffest:g}", command="check").status == 0
    assert run("d.toml", "--stiffness", f"{1.002 * stiffest:g}", command="check").status != 0


def test_a_free_motion_needs_the_mass(run: Run) -> None:
    """Without force and mass there is one line on what to do; leaving the force out is possible."""
    result = run("free.csv")
    assert result.status == 2
    assert "give the mass" in result.err
    assert run("plain.csv", "--column", "hand_force=none").status == 2


def test_the_wrong_model_is_the_headline(run: Run) -> None:
    """A mass and a damper are fitted where asked for, and no wall is allowed by them."""
    result = run("plain.csv", "--model", "viscous", "--stiffness", "1")
    assert result.out.startswith(" WRONG MODEL  Coulomb friction is seen")
    assert "fit Coulomb friction too" in words(result)
    assert result.status == 3
    result = run("plain.csv", "--model", "viscous", "-o", "no.toml")
    assert result.status == 2
    assert "no device has them" in result.err
    assert not Path("no.toml").exists()


def test_several_logs_are_one(run: Run) -> None:
    """Runs of one device are identified together; a log of another rate is refused."""
    header, *lines = Path("plain.csv").read_text(encoding="utf-8").splitlines(keepends=True)
    half = len(lines) // 2
    Path("one.csv").write_text(header + "".join(lines[:half]), encoding="utf-8")
    Path("two.csv").write_text(header + "".join(lines[half:]), encoding="utf-8")
    whole, parts = run("plain.csv", "--json"), run("one.csv", "two.csv", "--json")
    found, again = json.loads(whole.out), json.loads(parts.out)
    key = "damping_N_s_per_m"
    assert again[key]["value"] == pytest.approx(found[key]["value"], rel=0.02)
    assert again["strokes"] == pytest.approx(found["strokes"], abs=4)
    Path("slow.csv").write_text(header + "".join(lines[::2]), encoding="utf-8")
    assert "identify them one by one" in run("one.csv", "slow.csv").err


def test_files_are_not_replaced_unasked(run: Run) -> None:
    """Plot and device are kept; with --force both are written anew."""
    for path in ("mine.toml", "fig.png"):
        Path(path).write_text("old", encoding="utf-8")
        option = "-o" if path.endswith("toml") else "--plot"
        result = run("plain.csv", option, path)
        assert result.status == 2
        assert "exists" in result.err
        assert Path(path).read_text(encoding="utf-8") == "old"
    result = run("plain.csv", "-o", "mine.toml", "--plot", "fig.png", "--force")
    assert "written: mine.toml" in words(result)
    assert "[device]" in Path("mine.toml").read_text(encoding="utf-8")
    assert Path("fig.png").read_bytes().startswith(b"\x89PNG")


@pytest.mark.parametrize(
    ("argv", "said"),
    [
        (("nothing.csv",), "there is no such file"),
        (("log.csv",), "--unit position=mm"),
        (("odd.csv",), "--column position=…"),
        (("log.csv", "--column", "position=enc"), "--unit position=mm"),
        (
            ("log.csv", "--column", "position=enc", "--unit", "position=counts"),
            '--resolution "22.4 um" or --counts-per-turn 4096',
        ),
        (("plain.csv", "--column", "enc"), "--column is written --column position=VALUE"),
        (("plain.csv", "--column", "pos=enc"), "there is no quantity"),
        (("plain.csv", "--unit", "position=mm", "--unit", "position=m"), "names a quantity twice"),
        (("plain.csv", "--confidence", "100%"), "--confidence must be"),
        (("plain.csv", "--confidence", "0"), "--confidence must be"),
        (("plain.csv", "--zero", "yes"), "--zero is drifts, constant, exact"),
        (("plain.csv", "--model", "best"), "--model is coulomb-viscous or viscous"),
        (("plain.csv", "--motion", "round"), "--motion is linear or rotary"),
        (("plain.csv", "--mass", "3 m"), "mass is in kg"),
        (("plain.csv", "--rate", "50 Hz"), "0.001 s apart"),
        (("plain.csv", "-o", "mine.txt"), "a device is saved as TOML"),
        (("plain.csv", "--plot", "mine.txt"), "must end in .png"),
        (("short.csv",), "move to and fro"),
        (("plain.csv", "--stiff", "3"), "did you mean --stiffness?"),
    ],
)
def test_bad_input_ends_in_one_line(run: Run, argv: tuple[str, ...], said: str) -> None:
    """What was given, and what to type instead, in options and not in Python."""
    result = run(*argv)
    assert (result.status, result.out) == (2, "")
    assert result.err.count("\n") == 1
    assert said in result.err
    assert "={" not in result.err
