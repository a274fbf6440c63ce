"""`zwidth identify`: a device from a log, its file and plot, the walls it allows; one line on bad input."""

import shutil
from pathlib import Path

import numpy as np
import pytest
from known_motion import STEP, paddle

COUNTS = "--column position=enc --column hand-force=F1_N --unit position=counts --resolution '22.4 um'"
"""What log.csv does not say itself."""


@pytest.fixture(scope="module")
def logs(tmp_path_factory):
    """Logs: log.csv in counts, plain.csv that explains itself, free.csv without force, and bad ones."""
    folder = tmp_path_factory.mktemp("logs")
    time, position, force = paddle()

    def write(name, header, *columns):
        table = np.stack(columns, axis=1)
        np.savetxt(folder / name, table, delimiter=",", header=header, comments="", fmt="%.9g")

    write("log.csv", "t_s,enc,F1_N", time, np.rint(position / STEP), force)
    write("plain.csv", "time_s,position_mm,hand_force_N", time, 1e3 * position, force)
    write("odd.csv", "t_s,a,b", time, position, force)
    write("free.csv", "time_s,position_mm", time, 1e3 * position)
    write("short.csv", "time_s,position_mm,hand_force_N", time[:90], 1e3 * position[:90], force[:90])
    return folder


@pytest.fixture(autouse=True)
def _logs(run, logs):
    """Copies of them."""
    shutil.copytree(logs, ".", dirs_exist_ok=True)


def test_the_report(run):
    result = run("identify plain.csv --all")
    assert result.err == ""
    assert result.out.startswith(" IDENTIFIED  Spring walls up to ")
    text = result.words
    for part in (
        "plain.csv: 20 s, 20000 samples",
        "T = 1 ms, Δ = 22.4 µm, hand force",
        "95 % interval",
        "2b/T",
        "2f_c/Δ",
        "r² = ",
        "a mass and a damper alone would have",
        "damping limits the wall",
        "times as long would halve the interval",
        "resolution 22.4 µm from the positions",
    ):
        assert part in text


def test_columns_units_and_steps_on_the_command_line(run):
    """Odd names and counts give the same device as a log that explains itself."""
    one = run(f"identify log.csv {COUNTS} --json").json
    other = run("identify plain.csv --json").json
    assert one["resolution_m"] == pytest.approx(other["resolution_m"], rel=1e-12)
    assert one["damping_N_s_per_m"]["value"] == pytest.approx(other["damping_N_s_per_m"]["value"], rel=1e-5)
    assert one["log"] == other["log"] == {
        "samples": 20_000, "runs": 1, "duration_s": 20.0, "channels": ["hand_force"],
    }  # fmt: skip


def test_the_saved_device_is_what_check_reads(run):
    """A wall below the limit of the report is proved on the file, one above it is not."""
    limit = run("identify plain.csv -o mine.toml --json").json["stiffest_by_damping_N_per_m"]
    low, high = limit["interval"]
    run(f"check mine.toml --stiffness {0.999 * low:g}")
    run(f"check mine.toml --stiffness {1.001 * low:g}", 3)
    run(f"check mine.toml --stiffness {1.01 * high:g}", 1)


def test_an_environment_is_checked_at_once(run):
    limit = run("identify plain.csv --json").json["stiffest_by_damping_N_per_m"]
    easy = run(f"identify plain.csv --stiffness {0.5 * limit['interval'][0]:g}").words
    assert "passive for 99.9999 % or more of what the data allow" in easy
    between = f"{(limit['interval'][0] + limit['value']) / 2:g}"
    document = run(f"identify plain.csv --stiffness {between} --json", 3).json
    assert 0 < document["passive_for"] < 0.99
    assert document["check"]["outcome"] == "undecided"
    hard = run(f"identify plain.csv --stiffness {2 * limit['value']:g}", 1).words
    assert "not proved passive, even for the best guess" in hard


def test_the_confidence_is_the_stated_one(run):
    """A wall that is proved at 80 % need not be at 99.9 %; 80% and 0.8 are the same."""
    found = run("identify plain.csv --json --confidence 95%").json
    low, _ = found["stiffest_by_damping_N_per_m"]["interval"]
    for confidence, status in (("'80 %'", 0), ("0.8", 0), ("99.9%", 3)):
        run(f"identify plain.csv --stiffness {low:.6g} --confidence {confidence}", status)


def test_an_environment_from_a_file(run):
    Path("wall.toml").write_text('[environment]\ntype = "wall"\nstiffness = 1\n', encoding="utf-8")
    assert "K = 1 N/m" in run("identify plain.csv wall.toml").words
    assert "K = 2 N/m" in run("identify plain.csv wall.toml --stiffness 2").words


def test_a_delay_counts_in_the_wall_and_in_the_file(run):
    """Half a sample of delay takes half of what damping allows, about; the file has it too."""
    delayed = run("identify plain.csv --delay '0.5 ms' -o d.toml").words
    stiffest = float(delayed.split("Spring walls up to ")[1].split()[0])
    plain = float(run("identify plain.csv").words.split("Spring walls up to ")[1].split()[0])
    assert 0.4 * plain < stiffest < 0.55 * plain
    assert "delay = 0.0005  # s: as given" in Path("d.toml").read_text(encoding="utf-8")
    run(f"check d.toml --stiffness {0.999 * stiffest:g}")
    assert run(f"check d.toml --stiffness {1.002 * stiffest:g}", None).status in (1, 3)


def test_the_wrong_model_is_the_headline(run, refused):
    """A mass and a damper are fitted where asked for, and no wall is allowed by them."""
    result = run("identify plain.csv --model viscous --stiffness 1", 3)
    assert result.out.startswith(" WRONG MODEL  Coulomb friction is seen")
    assert "fit Coulomb friction too" in result.words
    assert "no device has them" in refused("identify plain.csv --model viscous -o no.toml")
    assert not Path("no.toml").exists()


def test_several_logs_are_one(run, refused):
    header, *lines = Path("plain.csv").read_text(encoding="utf-8").splitlines(keepends=True)
    half = len(lines) // 2
    Path("one.csv").write_text(header + "".join(lines[:half]), encoding="utf-8")
    Path("two.csv").write_text(header + "".join(lines[half:]), encoding="utf-8")
    found, again = run("identify plain.csv --json").json, run("identify one.csv two.csv --json").json
    key = "damping_N_s_per_m"
    assert again[key]["value"] == pytest.approx(found[key]["value"], rel=0.02)
    assert again["strokes"] == pytest.approx(found["strokes"], abs=4)
    Path("slow.csv").write_text(header + "".join(lines[::2]), encoding="utf-8")
    assert "identify them one by one" in refused("identify one.csv slow.csv")


def test_files_are_not_replaced_unasked(run, refused):
    for option, path in (("-o", "mine.toml"), ("--plot", "fig.png")):
        Path(path).write_text("old", encoding="utf-8")
        assert "exists" in refused(f"identify plain.csv {option} {path}")
        assert Path(path).read_text(encoding="utf-8") == "old"
    result = run("identify plain.csv -o mine.toml --plot fig.png --force")
    assert "written: mine.toml" in result.words
    assert "[device]" in Path("mine.toml").read_text(encoding="utf-8")
    assert Path("fig.png").read_bytes().startswith(b"\x89PNG")


@pytest.mark.parametrize(
    ("argv", "said"),
    [
        ("nothing.csv", "there is no file"),
        ("log.csv", "--unit position=mm"),
        ("odd.csv", "--column position=…"),
        ("log.csv --column position=enc", "--unit position=mm"),
        ("log.csv --column position=enc --unit position=counts", '"22.4 um" or --counts-per-turn 4096'),
        ("free.csv", "give the mass"),
        ("plain.csv --column hand_force=none", "give the mass"),
        ("plain.csv both.toml", "the device comes from the log"),
        ("plain.csv --column enc", "--column is written --column position=VALUE"),
        ("plain.csv --column pos=enc", "there is no quantity"),
        ("plain.csv --unit position=mm --unit position=m", "names a quantity twice"),
        ("plain.csv --confidence 100%", "--confidence must be"),
        ("plain.csv --confidence 0", "--confidence must be"),
        ("plain.csv --zero yes", "--zero is drifts, constant, exact"),
        ("plain.csv --model best", "--model is coulomb-viscous or viscous"),
        ("plain.csv --motion round", "--motion is linear or rotary"),
        ("plain.csv --mass '3 m'", "mass is in kg"),
        ("plain.csv --rate '50 Hz'", "1 ms apart"),
        ("plain.csv -o mine.txt", "a device is saved as TOML"),
        ("plain.csv --plot mine.txt", "must end in .png"),
        ("short.csv", "move to and fro"),
        ("plain.csv --stiff 3", "did you mean --stiffness?"),
    ],
)
def test_bad_input_ends_in_one_line(refused, argv, said):
    """What was given, and what to type instead, in options and not in Python."""
    both = "[device]\ndamping = 1\nrate = 1\n[environment]\nstiffness = 1\n"
    Path("both.toml").write_text(both, encoding="utf-8")
    message = refused(f"identify {argv}")
    assert said in message
    assert "={" not in message
