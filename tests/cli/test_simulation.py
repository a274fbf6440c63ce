"""`zwidth simulate` and `zwidth traces`: files, tables, options, and one clear line on bad input."""

from __future__ import annotations

import json
import os
import subprocess
import sys
from collections.abc import Callable
from pathlib import Path
from typing import NamedTuple

import numpy as np
import pytest

import zwidth as zw
from zwidth.cli.main import main
from zwidth.cli.simulate.tables import KEYS, follower_parameters, operator_parameters, simulation_parameters
from zwidth.model import operator as operators

DOWEL = ("simulate", "haptic-paddle", "--stiffness", "770", "--operator", "dowel", "--duration", "0.2")


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


def test_the_example_of_the_docs_in_a_process_of_its_own(tmp_path: Path) -> None:
    """It reports, draws and saves; the trace comes back as Python would have made it."""
    command = (
        "simulate haptic-paddle --stiffness 770 --operator dowel --duration 2 --plot touch.png -o touch.nc"
    )
    done = subprocess.run(
        [sys.executable, "-m", "zwidth", *command.split()], cwd=tmp_path, capture_output=True, text=True
    )
    assert done.returncode == 0, done.stderr
    assert "ACTIVE" in done.stdout
    assert {p.name for p in tmp_path.iterdir()} == {"touch.png", "touch.nc"}
    trace = zw.traces.load_trace(tmp_path / "touch.nc")
    paddle = zw.catalogue.device("haptic-paddle")
    assert trace.identical(zw.simulate(paddle, zw.Wall(770), zw.operators.Dowel(), 2.0))


def test_the_report_says_what_came_out(run: Run) -> None:
    """An active touch, a quiet one, and one that began inside, each in words."""
    assert "ACTIVE" in run(*DOWEL).out
    assert "got no energy out" in run(*DOWEL, "--force-limit", "0.5").out
    inside = run(*DOWEL, "--initial-position", "20 mm")
    assert "were stored at the start: nothing was gained" in " ".join(inside.out.split())


def test_json_carries_units_in_its_keys(run: Run) -> None:
    """The summary is what Python gives."""
    document = json.loads(run(*DOWEL, "--json").out)
    trace = zw.simulate(zw.catalogue.device("haptic-paddle"), zw.Wall(770), zw.operators.Dowel(), 0.2)
    assert document["deepest_position_m"] == trace.position.values.max()
    assert document["energy"]["hand_work_J"] == float(trace.hand_work[-1])
    assert document["sample_period_s"] == 0.001


def test_everything_can_stand_in_one_file(run: Run, tmp_path: Path) -> None:
    """Tables [operator] and [simulation] beside the two of check; the command line overrides them."""
    Path("touch.toml").write_text(
        '[device]\ncatalogue = "haptic-paddle"\n[environment]\ntype = "wall"\nstiffness = 770\n'
        '[operator]\ntype = "constant-force"\nforce = "3 N"\n'
        '[simulation]\nduration = "0.2 s"\ninitial_position = "-5 mm"\namplifier = "ideal"\n',
        encoding="utf-8",
    )
    document = json.loads(run("simulate", "touch.toml", "--json", "--operator.force", "2 N").out)
    hand = zw.operators.ConstantForce(2.0)
    device = zw.catalogue.device("haptic-paddle")
    ideal = zw.amplifiers.Ideal()
    trace = zw.simulate(device, zw.Wall(770), hand, 0.2, initial_position=-5e-3, amplifier=ideal)
    assert document["energy"]["hand_work_J"] == float(trace.hand_work[-1])


def test_check_says_where_a_table_of_a_touch_belongs(run: Run) -> None:
    """It is not ignored."""
    Path("t.toml").write_text('[operator]\ntype = "dowel"\n', encoding="utf-8")
    result = run("check", "haptic-paddle", "t.toml", "--stiffness", "1")
    assert result.status == 2
    assert "for zwidth simulate" in result.err


def test_every_key_of_a_simulation_is_used(run: Run) -> None:
    """All at once, with every amplifier: nothing is ignored, nothing crashes."""
    common = (
        *DOWEL, "--initial-velocity", "0.1 m/s", "--encoder-phase", "0.3", "--lateness", "0.1 ms",
        "--missed", "0.01", "--seed", "4", "--points-per-sample", "2", "--json",
    )  # fmt: skip
    seen = set()
    for amplifier in ("ideal", "current", "voltage-limited"):
        seen.add(run(*common, "--amplifier", amplifier).out)
    seen.add(run(*common, "--amplifier", "lag", "--amplifier-time-constant", "0.3 ms").out)
    assert len(seen) == 4
    given = {word.removeprefix("--").replace("-", "_") for word in common if word.startswith("--")}
    assert set(KEYS) <= given | {"initial_position", "amplifier", "amplifier_time_constant"}


def test_a_recorded_force_and_a_witness_come_out_of_files(run: Run) -> None:
    """Both bring their own duration; the witness gives the energy that check claims."""
    Path("force.csv").write_text("\n".join(map(str, np.linspace(0, 2, 50))), encoding="utf-8")
    record = ("--operator", "force-record", "--operator.file", "force.csv")
    document = json.loads(run("simulate", "haptic-paddle", "--stiffness", "300", *record, "--json").out)
    assert "50 samples" in document["operator"]
    assert run("check", "haptic-paddle", "--stiffness", "770", "-o", "motion.json").status == 1
    replayed = (
        "simulate", "haptic-paddle", "--stiffness", "770", "--operator", "witness",
        "--operator.file", "motion.json", "--amplifier", "ideal", "--json",
    )  # fmt: skip
    energy = json.loads(run(*replayed).out)["energy"]
    witness = zw.check(zw.catalogue.device("haptic-paddle"), zw.Wall(770)).witness
    assert -energy["hand_work_J"] == pytest.approx(witness.energy, rel=1e-9)


def test_sound_and_pictures_are_written_and_named(run: Run, tmp_path: Path) -> None:
    """The report says where."""
    result = run(*DOWEL, "--sound", "buzz.wav", "--plot", "touch.svg", "-o", "touch.parquet")
    assert all(name in result.out for name in ("buzz.wav", "touch.svg", "touch.parquet"))
    assert all((tmp_path / name).stat().st_size > 1000 for name in ("buzz.wav", "touch.svg", "touch.parquet"))


def test_saved_traces_are_compared(run: Run, tmp_path: Path) -> None:
    """A table with a column per trace, JSON, a picture."""
    run(*DOWEL, "-o", "dowel.nc")
    run(*DOWEL[:5], "malicious", *DOWEL[6:], "-o", "finger.csv")
    table = run("traces", "dowel.nc", "finger.csv", "--plot", "both.png")
    assert "dowel.nc" in table.out
    assert "deepest [m]" in table.out
    assert (tmp_path / "both.png").exists()
    document = json.loads(run("traces", "dowel.nc", "finger.csv", "--json").out)
    assert document["dowel.nc"]["energy_extracted_J"] > 0


BAD = [
    (("--operator", "glove"), ('no hand "glove"',)),
    (("--operator.force", "4 kg"), ("force", "kg")),
    (("--operator.stiffness", "3"), ('hand "dowel" has no "stiffness"',)),
    (("--operator", "finger", "--operator.mass", "-1"), ("mass must be",)),
    (("--duration", "0"), ("duration must be > 0",)),
    (("--duration", "nan"), ("duration",)),
    (("--duration", "1e9"), ("GiB",)),
    (("--duration", "3 m"), ("duration",)),
    (("--mass", "0"), ("mass must be > 0",)),
    (("--sample-period", "0"), ("--sample-period must be > 0",)),
    (("--amplifier", "valve"), ("no amplifier",)),
    (("--amplifier", "lag"), ("amplifier_time_constant",)),
    (("--amplifier-time-constant", "1 ms"), ("belong together",)),
    (("--seed", "3"), ("seed goes with",)),
    (("--missed", "2"), ("probability",)),
    (("--points-per-sample", "1.5"), ("whole number",)),
    (("--encoder-phase", "1"), ("--encoder-phase",)),
    (("--initial-position", "up"), ("--initial-position",)),
    (("-o", "touch.xlsx"), (".nc, .parquet, .csv",)),
    (("--plot", "touch.gif"), (".png",)),
    (("--sound", "touch.mp3"), (".wav",)),
    (("-o", "no/touch.nc"), ("no directory",)),
    (("--operator", "force-record"), ("needs the file",)),
    (("--operator", "force-record", "--operator.file", "none.csv"), ("none.csv",)),
    (("--operator", "witness", "--operator.file", "none.json"), ("none.json",)),
]


@pytest.mark.parametrize(("argv", "parts"), BAD, ids=range(len(BAD)))
def test_bad_input_is_one_line_and_no_file(run: Run, tmp_path: Path, argv, parts) -> None:
    """Status 2, what was given and what to do; nothing is left behind."""
    base = [*DOWEL, "-o", "kept.nc"] if "-o" not in argv else list(DOWEL)
    for option, value in zip(argv[::2], argv[1::2], strict=True):
        if option in base:
            base[base.index(option) + 1] = value
        else:
            base += [option, value]
    result = run(*base)
    assert result.status == 2, result
    assert result.err.count("\n") == 1
    assert all(part in result.err for part in parts), result.err
    assert not list(tmp_path.iterdir())


@pytest.mark.parametrize(
    ("content", "says"),
    [
        ("1\nnan\n2\n", "nan"),
        ("1,2\n3,4\n", "column"),
        ("", "force.csv"),
        ("1\n2\n", "duration"),
        ("a\nb\n", ""),
    ],
)
def test_a_record_that_cannot_be_used_is_refused(run: Run, content: str, says: str) -> None:
    """NaN forces, too many columns, an empty file, too few values, words."""
    Path("force.csv").write_text(content, encoding="utf-8")
    result = run(*DOWEL[:5], "force-record", *DOWEL[6:], "--operator.file", "force.csv")
    assert result.status == 2, result
    assert result.err.count("\n") == 1
    assert says in result.err


@pytest.mark.skipif(not Path("/dev/full").exists(), reason="there is no full device to write to")
@pytest.mark.parametrize("suffix", [".nc", ".csv", ".parquet", ".wav", ".png"])
def test_a_full_disk_is_one_line(run: Run, tmp_path: Path, monkeypatch, suffix: str) -> None:
    """Whatever is written: no traceback, nothing half-written."""
    real = os.replace

    def full(source: object, target: object) -> None:
        if str(target).endswith(suffix):
            raise OSError(28, "No space left on device")
        real(source, target)

    monkeypatch.setattr("os.replace", full)
    option = {".wav": "--sound", ".png": "--plot"}.get(suffix, "-o")
    result = run(*DOWEL, option, f"touch{suffix}")
    assert result.status == 2
    assert "No space left on device" in result.err
    assert not list(tmp_path.iterdir())


def test_ctrl_c_keeps_what_is_finished_and_says_so(run: Run, monkeypatch) -> None:
    """Status 130, the trace is saved up to there."""
    import zwidth.loop.simulate as module

    monkeypatch.setattr(module, "_STRIDE", 50)
    real, calls = module.run_samples, []

    def stopped(*arguments: object) -> None:
        calls.append(1)
        if len(calls) > 2:
            raise KeyboardInterrupt
        real(*arguments)

    monkeypatch.setattr(module, "run_samples", stopped)
    result = run(*DOWEL, "-o", "part.nc")
    assert result.status == 130
    assert "interrupted" in result.out
    assert zw.traces.load_trace("part.nc").sizes["time"] == 100


def test_every_option_of_a_touch_has_a_unit_or_needs_none() -> None:
    """The help of each says what it is and in what unit."""
    for parameter in (*operator_parameters(), *follower_parameters(), *simulation_parameters()):
        assert parameter.help
        assert parameter.metavar


STOP = """
[device]
motion = "rotary"
inertia = "0.006 kg*m^2"
damping = "0.05 N*m*s/rad"
rate = "500 Hz"

[environment]
type = "nonlinear-spring"
positions = ["450 deg", "460 deg"]
forces = ["0 N*m", "20 N*m"]
"""


def test_a_hand_that_met_nothing_says_so(tmp_path: Path, capsys: pytest.CaptureFixture[str]) -> None:
    """Where the stop begins, how far the hand came, and how to start there; not that no energy came out."""
    stop = tmp_path / "stop.toml"
    stop.write_text(STOP, encoding="utf-8")
    touched = ["simulate", str(stop), "--operator", "typical", "--duration", "0.2"]
    assert main(touched) == 0
    said = " ".join(capsys.readouterr().out.split())
    assert "never reached the wall: it begins at 450 deg" in said
    assert "--initial-position '450 deg'" in said
    assert "contacts made" not in said
    assert (
        main(
            [
                *touched[:2],
                "--operator",
                "constant-force",
                "--initial-position",
                "450 deg",
                "--duration",
                "0.2",
            ]
        )
        == 0
    )
    assert "never reached" not in capsys.readouterr().out
    assert main([*touched, "--operator.start", "449 deg"]) == 2
    error = capsys.readouterr().err
    assert "got 449 deg" in error
    assert "--initial-position" in error or "initial_position" in error


def test_hands_are_named_with_a_word_and_one_to_begin_with(capsys: pytest.CaptureFixture[str]) -> None:
    """Where none is given, and where there is none of that name."""
    assert main([*DOWEL[:4], "--duration", "1"]) == 2
    error = capsys.readouterr().err
    assert "begin with --operator typical" in error
    for name, hand in operators.OPERATORS.items():
        assert (f"{name}, " in error) == (hand.motion != "rotary")
    assert main([*DOWEL[:4], "--operator", "hand", "--duration", "1"]) == 2
    assert "begin with typical" in capsys.readouterr().err
