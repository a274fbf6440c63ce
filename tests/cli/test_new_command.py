"""`zwidth new`: what a person knows becomes a file; what nobody knows is said, and never filled in."""

from __future__ import annotations

import math
import os
import shlex
import subprocess
import sys
from collections.abc import Callable
from io import StringIO
from pathlib import Path

import pytest

import zwidth as zw
from zwidth.cli.main import main
from zwidth.model.specification.read import load_device

Answered = Callable[..., str]

WHEEL = {
    "--motion": "rotary",
    "--inertia": "0.006 kg*m^2",
    "--encoder": "65536 counts/turn",
    "--rate": "1 kHz",
    "--delay": "0.3 ms",
    "--damping": "0.02 N*m*s/rad",
    "--coulomb-friction": "0.05 N*m",
    "--force-limit": "2 N*m",
}


def options(answers: dict[str, str]) -> list[str]:
    """Answers as options."""
    return [word for pair in answers.items() for word in pair]


@pytest.fixture(autouse=True)
def _folder(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.chdir(tmp_path)


@pytest.fixture
def refused(capsys: pytest.CaptureFixture[str]) -> Answered:
    """Runs a command line that cannot be used; its one message."""

    def runner(*argv: str) -> str:
        assert main(["new", *argv]) == 2
        told = capsys.readouterr()
        assert told.err.count("\n") == 1
        return told.err

    return runner


def piped(monkeypatch: pytest.MonkeyPatch, *lines: str) -> None:
    """Answers from a pipe."""
    monkeypatch.setattr("sys.stdin", StringIO("".join(f"{line}\n" for line in lines)))


# --- a device ----------------------------------------------------------------


def test_options_make_the_device_that_they_say(capsys: pytest.CaptureFixture[str]) -> None:
    """And the next command is one that can be typed."""
    assert main(["new", "device", "my-wheel.toml", *options(WHEEL), "--no-questions"]) == 0
    out = capsys.readouterr().out
    device = load_device(["my-wheel.toml"], {})
    same = zw.rotary(
        inertia=0.006,
        damping=0.02,
        coulomb_friction=0.05,
        counts_per_turn=65536,
        rate=1000,
        delay=0.0003,
        force_limit=2,
    )
    assert device.replace(name="device") == same
    assert device.assumed == ()
    assert "zwidth new environment" in out
    check, report = (shlex.split(line) for line in out.splitlines() if "--stiffness" in line)
    assert check[:2] + report[:2] == ["zwidth", "check", "zwidth", "report"]
    assert main(check[1:]) == 0  # a stiffness at which it is passive
    assert main(report[1:]) == 0


def test_answers_from_a_pipe_are_those_of_the_options(monkeypatch: pytest.MonkeyPatch) -> None:
    """In the order of the questions; an empty line where nobody knows, here the handle's radius."""
    assert main(["new", "device", "a.toml", *options(WHEEL), "--no-questions"]) == 0
    answers = [*WHEEL.values()]
    piped(monkeypatch, *answers[:3], "", *answers[3:])
    assert main(["new", "device", "b.toml"]) == 0
    assert Path("a.toml").read_text(encoding="utf-8") == Path("b.toml").read_text(encoding="utf-8")


@pytest.mark.parametrize(
    ("answer", "counts"),
    [("2000 lines", 8000), ("14 bit", 16384), ("4096", 4096), ("1024 cpr", 1024), ("500 ppr", 2000)],
)
def test_an_encoder_as_data_sheets_say_it(answer: str, counts: int) -> None:
    """Four counts a line, 2ⁿ of n bits: 2π/N of a turn."""
    assert main(["new", "device", *options({**WHEEL, "--encoder": answer}), "--no-questions"]) == 0
    assert float(load_device(["my-device.toml"], {}).resolution) == 2 * math.pi / counts


def test_an_encoder_in_degrees(capsys: pytest.CaptureFixture[str]) -> None:
    assert main(["new", "device", *options({**WHEEL, "--encoder": "0.09 deg"}), "--no-questions"]) == 0
    assert float(load_device(["my-device.toml"], {}).resolution) == pytest.approx(math.radians(0.09))


def test_the_data_sheet_of_a_motor_gives_friction_and_largest_torque() -> None:
    """τ = n I/k_v: 270 rpm/V, 0.2 A without load, 10 A at most, a gear of 3."""
    known = {key: value for key, value in WHEEL.items() if key not in ("--coulomb-friction", "--force-limit")}
    sheet = {
        "--motor-friction": "0.2 A",
        "--motor-peak": "10 A",
        "--torque-constant": "270 rpm/V",
        "--gear-ratio": "3",
    }
    assert main(["new", "device", *options({**known, **sheet}), "--no-questions"]) == 0
    device = load_device(["my-device.toml"], {})
    constant = 60 / (2 * math.pi * 270)
    assert float(device.coulomb_friction) == pytest.approx(3 * constant * 0.2, rel=1e-5)
    assert float(device.force_limit) == pytest.approx(3 * constant * 10, rel=1e-5)
    assert "1/(270 rpm/V) x 0.2 A x 3" in Path("my-device.toml").read_text(encoding="utf-8")
    assert "estimate" in Path("my-device.toml").read_text(encoding="utf-8")


def test_a_motor_that_pulls_from_a_drum() -> None:
    """f = τ/r: 5 mN·m of friction at 10 mm are 0.5 N."""
    answers = {
        "--mass": "36 g",
        "--rate": "1 kHz",
        "--damping": "0.1",
        "--motor-friction": "5 mN*m",
        "--drum-radius": "10 mm",
    }
    assert main(["new", "device", *options(answers), "--no-questions"]) == 0
    assert float(load_device(["my-device.toml"], {}).coulomb_friction) == 0.5


def test_a_handle_on_a_lever_is_seen_at_the_hand() -> None:
    """With a radius of 0.1 m, b/r²."""
    answers = {**WHEEL, "--handle-radius": "10 cm"}
    assert main(["new", "device", *options(answers), "--no-questions"]) == 0
    device = load_device(["my-device.toml"], {})
    assert (device.motion, float(device.damping)) == ("linear", pytest.approx(2))


def test_what_is_unknown_is_left_out_and_said(capsys: pytest.CaptureFixture[str]) -> None:
    """No default: without damping there is no verdict, and it is said what to measure first."""
    answers = {"--motion": "linear", "--rate": "1 kHz", "--damping": "don't know"}
    assert main(["new", "device", *options(answers), "--no-questions"]) == 0
    out = capsys.readouterr().out
    text = Path("my-device.toml").read_text(encoding="utf-8")
    keys = [line.partition(" =")[0] for line in text.splitlines() if " = " in line and line[0] != "#"]
    assert keys == ["motion", "rate"]
    assert "# damping is not known. Nothing is proved without it" in text
    assert "zwidth identify" in out
    assert main(["check", "my-device.toml", "--stiffness", "100"]) == 2
    assert main(["check", "my-device.toml", "--damping", "0.1", "--stiffness", "100"]) == 0


@pytest.mark.parametrize(
    ("answers", "part"),
    [
        ({"--rate": "1 ms"}, "rate is in Hz"),
        ({"--damping": "-1 N*m*s/rad"}, "negative friction"),
        ({"--delay": "3"}, '"3 ms"'),
        ({"--encoder": "2.5 bit"}, "whole number of bits"),
        ({"--encoder": "0.09"}, "write the unit"),
        ({"--encoder": "22.4 um"}, "resolution is in rad"),
        ({"--inertia": "0,006"}, '"0.006"'),
        ({"--motion": "sideways"}, "rotary or linear"),
        ({"--drum-radius": "1 cm"}, "--drum-radius"),
        ({"--damping": "unknown", "--motion": "unknown"}, "--motion must be known"),
    ],
)
def test_an_answer_that_cannot_be_used_is_one_message(
    refused: Answered, answers: dict[str, str], part: str
) -> None:
    """Of the device's own words, and no file."""
    assert part in refused("device", *options({**WHEEL, **answers}), "--no-questions")
    assert not Path("my-device.toml").exists()


def test_a_line_in_counts_of_a_device_that_slides_says_how_to_reckon(refused: Answered) -> None:
    answers = {"--motion": "linear", "--encoder": "2000 lines", "--rate": "1 kHz", "--damping": "1"}
    assert "2 π r/N" in refused("device", *options(answers), "--no-questions")


def test_answers_that_end_too_early_are_one_message(
    refused: Answered, monkeypatch: pytest.MonkeyPatch
) -> None:
    """A script that did not say everything learns what is missing."""
    piped(monkeypatch)
    assert "--damping" in refused("device", "--motion", "rotary", "--rate", "1 kHz")
    piped(monkeypatch, "rotary", "6")
    assert "--rate, --damping" in refused("device")


def test_a_wrong_line_of_a_pipe_is_named(refused: Answered, monkeypatch: pytest.MonkeyPatch) -> None:
    piped(monkeypatch, "rotary", "0.006 kg*m^2", "many")
    assert "line 3 of the answers" in refused("device")


def test_answers_from_a_pipe_are_shown_with_their_questions(
    monkeypatch: pytest.MonkeyPatch, capsys: pytest.CaptureFixture[str]
) -> None:
    """And how each was understood; a wrong one is refused with its question."""
    lines = ("wheel", "0.006 kgm²", "2^16", "", "1 kHz", "", "0.05 Nms/rad", "0.1 Nm", "20 Nm")
    piped(monkeypatch, *lines)
    assert main(["new", "device"]) == 0
    out = capsys.readouterr().out
    for part in ("Does the handle turn", "> wheel", "understood: rotary", "understood: 0.05 N·m·s/rad"):
        assert part in out
    piped(monkeypatch, "wheel", "0.006 kgm²", "65,536 counts")
    assert main(["new", "device", "--force"]) == 2
    err = capsys.readouterr().err
    assert "Encoder, at the axis" in err
    assert '"65536"' in err
    assert "65.536" not in err


@pytest.mark.parametrize(
    ("answer", "degrees"),
    [
        ("2^16", 360 / 2**16),
        ("65536 steps", 360 / 2**16),
        ("2^14 counts/rev", 360 / 2**14),
        ("0.0055°", 0.0055),
        ("0.0055 degrees", 0.0055),
    ],
)
def test_an_encoder_as_people_say_it(answer: str, degrees: float) -> None:
    """Powers of two, steps, degrees by sign and by word."""
    assert main(["new", "device", *options({**WHEEL, "--encoder": answer}), "--no-questions"]) == 0
    assert float(load_device(["my-device.toml"], {}).resolution) == pytest.approx(math.radians(degrees))


@pytest.mark.parametrize("word", ["turn", "wheel", "yes", "It turns", "a steering wheel"])
def test_that_it_turns_may_be_said_in_other_words(word: str) -> None:
    """The question names a wheel; "wheel" is an answer."""
    assert main(["new", "device", *options({**WHEEL, "--motion": word}), "--no-questions"]) == 0
    assert load_device(["my-device.toml"], {}).motion == "rotary"


@pytest.mark.parametrize(
    ("option", "answer", "part"),
    [
        ("--handle-radius", "1000", 'write "1000 mm", or "1000 m"'),
        ("--drum-radius", "10", 'write "10 mm", or "10 m"'),
    ],
)
def test_a_length_needs_its_unit(refused: Answered, option: str, answer: str, part: str) -> None:
    """A bare 1000 is hardly a kilometre."""
    motor = {"--motor-friction": "5 mNm", "--mass": "1 kg", "--rate": "1 kHz", "--damping": "1"}
    known = WHEEL if option == "--handle-radius" else motor
    assert part in refused("device", *options({**known, option: answer}), "--no-questions")


def test_a_bare_number_is_written_with_the_unit_it_is_taken_in() -> None:
    """So that the file says what was understood."""
    assert main(["new", "device", *options({**WHEEL, "--damping": "0.02"}), "--no-questions"]) == 0
    assert 'damping = "0.02 N*m*s/rad"' in Path("my-device.toml").read_text(encoding="utf-8")


def test_what_the_motors_data_sheet_says_is_not_lost_in_silence(
    refused: Answered, monkeypatch: pytest.MonkeyPatch
) -> None:
    """Enter at the gear ratio is 1; without the torque constant the file says what it lacks."""
    known = {"--motion": "rotary", "--rate": "1 kHz", "--damping": "0.02"}
    sheet = {"--torque-constant": "0.9 Nm/A", "--motor-friction": "0.2 A", "--force-limit": "20 Nm"}
    given = options({**known, "--inertia": "unknown", "--encoder": "unknown", "--delay": "unknown", **sheet})
    given += options({"--handle-radius": "unknown", "--coulomb-friction": "unknown"})
    assert "--gear-ratio" in refused("device", *given, "--no-questions")
    piped(monkeypatch, "")
    assert main(["new", "device", *given]) == 0
    friction = load_device(["my-device.toml"], {}).coulomb_friction
    assert float(friction or 0) == pytest.approx(0.18)
    current = options({**known, "--motor-friction": "0.2 A"})
    assert main(["new", "device", *current, "--no-questions", "--force"]) == 0
    assert "0.2 A of the motor says it with --torque-constant" in Path("my-device.toml").read_text(
        encoding="utf-8"
    )


def test_a_gear_as_it_is_named(refused: Answered) -> None:
    """5:1 is five turns of the motor in one of the handle; of 1:5 nobody knows which way it is meant."""
    known = {"--motion": "rotary", "--rate": "1 kHz", "--damping": "0.02", "--motor-friction": "5 mNm"}
    assert main(["new", "device", *options({**known, "--gear-ratio": "5:1"}), "--no-questions"]) == 0
    assert float(load_device(["my-device.toml"], {}).coulomb_friction or 0) == pytest.approx(0.025)
    assert "turns more" in refused(
        "device", *options({**known, "--gear-ratio": "1:5"}), "--force", "--no-questions"
    )
    assert "plain number" in refused(
        "device", *options({**known, "--gear-ratio": "5:one"}), "--force", "--no-questions"
    )


def test_a_torque_constant_alone_is_kept_as_a_remark() -> None:
    """One of the few things a data sheet always says."""
    known = {"--motion": "rotary", "--rate": "1 kHz", "--damping": "0.02", "--torque-constant": "0.9 Nm/A"}
    assert main(["new", "device", *options(known), "--no-questions"]) == 0
    assert "torque constant 0.9 Nm/A is known" in Path("my-device.toml").read_text(encoding="utf-8")


def test_a_file_is_kept_unless_force_is_given(refused: Answered) -> None:
    Path("my-device.toml").write_text("mine", encoding="utf-8")
    assert "--force" in refused("device", *options(WHEEL), "--no-questions")
    assert Path("my-device.toml").read_text(encoding="utf-8") == "mine"
    assert main(["new", "device", *options(WHEEL), "--no-questions", "--force"]) == 0
    assert ".toml" in refused("device", "my-device.txt", *options(WHEEL), "--no-questions")
    assert "device" in refused("devise")


def test_in_a_terminal_a_wrong_answer_is_asked_again(tmp_path: Path) -> None:
    """Each question with why it matters; what is wrong with an answer at once, then the question stays."""
    answers = "rotary\n0.006 kg\n0.006 kg*m^2\n?\n\n1 kHz\n\n0.02\n0.05 N*m\n2 N*m\n"
    done = in_a_terminal(tmp_path, answers, "device")
    assert done.returncode == 0, done.stderr
    for part in (
        "Does the handle turn",
        "No proof depends on it",
        "a mass (kg)",
        "an ideal encoder",
        "zwidth check my-device.toml --stiffness",
    ):
        assert part in done.stdout
    assert done.stdout.count("Moment of inertia") == 1
    assert load_device([tmp_path / "my-device.toml"], {}).motion == "rotary"


def in_a_terminal(folder: Path, answers: str, *argv: str) -> subprocess.CompletedProcess[str]:
    """`zwidth new` with answers that are typed."""
    pty = pytest.importorskip("pty")
    here, there = pty.openpty()
    os.write(here, answers.encode())
    done = subprocess.run(
        [sys.executable, "-m", "zwidth", "new", *argv],
        stdin=there,
        capture_output=True,
        encoding="utf-8",
        timeout=120,
        cwd=folder,
        env={**os.environ, "PYTHONIOENCODING": "utf-8"},
    )
    os.close(here)
    os.close(there)
    return done


def test_back_leads_to_the_question_before(tmp_path: Path) -> None:
    """The answers before it are kept, its own is replaced."""
    answers = "back\nwall\nlinear\n300\nback\nback\nrotary\n20 Nm/rad\n\n"
    done = in_a_terminal(tmp_path, answers, "environment")
    assert done.returncode == 0, done.stderr
    assert "This is the first question" in done.stdout
    assert "understood: 300 N/m" in done.stdout
    assert 'stiffness = "20 Nm/rad"' in (tmp_path / "my-environment.toml").read_text(encoding="utf-8")


def test_enter_at_what_must_be_known_ends(tmp_path: Path) -> None:
    """Not asked for ever."""
    done = in_a_terminal(tmp_path, "\n\n\n", "device")
    assert done.returncode == 2
    assert "must be known" in done.stderr


# --- an environment ----------------------------------------------------------


def test_a_wall(capsys: pytest.CaptureFixture[str]) -> None:
    answers = {"--type": "wall", "--motion": "linear", "--stiffness": "200 N/m", "--virtual-damping": "0.05"}
    assert main(["new", "environment", *options(answers), "--no-questions"]) == 0
    assert "my-environment.toml" in capsys.readouterr().out
    loaded = zw.load(zw.samples.path("paddle.toml"), "my-environment.toml")
    assert loaded.environment == zw.Wall(200, 0.05)


def test_detents_and_a_bump_stop_are_those_of_the_library() -> None:
    """To nine digits."""
    row = {
        "--type": "detents",
        "--motion": "rotary",
        "--count": "3",
        "--pitch": "30 deg",
        "--peak": "20 mN*m",
    }
    stop = {
        "--type": "bump-stop",
        "--motion": "rotary",
        "--start": "1 rad",
        "--stiffness": "20 N*m/rad",
        "--hardening": "1000 N*m/rad^3",
        "--depth": "0.1 rad",
    }
    for answers, same in (
        (row, zw.NonlinearSpring.detents(3, math.pi / 6, 0.02)),
        (stop, zw.NonlinearSpring.bump_stop(1, 20, 1000, 0.1, 26)),
    ):
        assert main(["new", "environment", *options(answers), "--no-questions", "--force"]) == 0
        spring = zw.load(zw.samples.path("knob.toml"), "my-environment.toml").environment
        assert [float(x) for x in spring.positions] == pytest.approx([float(x) for x in same.positions])
        assert [float(f) for f in spring.forces] == pytest.approx([float(f) for f in same.forces])


@pytest.mark.parametrize(
    ("answers", "part"),
    [
        ({"--type": "wall", "--motion": "linear"}, "--stiffness"),
        ({"--type": "wal", "--motion": "linear"}, 'did you mean "wall"'),
        ({"--type": "wall", "--motion": "linear", "--stiffness": "20 N*m/rad"}, "stiffness is in N/m"),
        ({"--type": "wall", "--motion": "linear", "--stiffness": "1", "--count": "3"}, "--count"),
        (
            {"--type": "detents", "--motion": "rotary", "--count": "2.5", "--pitch": "1", "--peak": "1"},
            "whole",
        ),
        ({"--type": "wall", "--motion": "linear", "--stiffness": "-3"}, "≥ 0"),
    ],
)
def test_an_environment_that_cannot_be_is_one_message(
    refused: Answered, answers: dict[str, str], part: str
) -> None:
    assert part in refused("environment", *options(answers), "--no-questions")
    assert not Path("my-environment.toml").exists()


@pytest.mark.parametrize("word", ["stop", "bump stop", "Bump-Stop", "bump_stop"])
def test_a_bump_stop_in_other_words(word: str) -> None:
    """And where no depth is said, to the largest torque of the device in the same folder: 20/450 rad."""
    device = {"--motion": "wheel", "--rate": "1 kHz", "--damping": "unknown", "--force-limit": "20 Nm"}
    assert main(["new", "device", *options(device), "--no-questions"]) == 0
    stop = {"--type": word, "--start": "450 deg", "--stiffness": "450"}
    assert main(["new", "environment", *options(stop), "--no-questions"]) == 0
    text = Path("my-environment.toml").read_text(encoding="utf-8")
    assert "f = (450 N*m/rad) u" in text
    assert "the largest of my-device.toml" in text
    spring = zw.load(zw.samples.path("knob.toml"), "my-environment.toml").environment
    assert float(spring.positions[-1] - spring.positions[0]) == pytest.approx(20 / 450, abs=1e-8)
    assert float(spring.forces[-1]) == pytest.approx(20)


def test_the_largest_torque_says_nothing_of_a_device_that_slides(refused: Answered) -> None:
    """20 N*m over N/m is no depth."""
    assert main(["new", "device", *options(WHEEL), "--no-questions"]) == 0
    stop = {"--type": "stop", "--start": "5 mm", "--stiffness": "450 N/m", "--motion": "linear"}
    assert "--depth must be known" in refused("environment", *options(stop), "--no-questions")


def test_what_to_type_next_can_be_typed(capsys: pytest.CaptureFixture[str]) -> None:
    """With a guess of what the device lacks."""
    device = {"--motion": "wheel", "--rate": "1 kHz", "--damping": "unknown"}
    wall = {"--type": "wall", "--stiffness": "20 Nm/rad"}
    assert main(["new", "environment", *options({**wall, "--motion": "wheel"}), "--no-questions"]) == 0
    assert "zwidth new device" in capsys.readouterr().out
    assert main(["new", "device", *options(device), "--no-questions"]) == 0
    capsys.readouterr()
    assert main(["new", "environment", *options(wall), "--no-questions", "--force"]) == 0
    _, *command = shlex.split(capsys.readouterr().out.splitlines()[-1])
    assert "--damping" in command
    assert main(command) == 0


@pytest.mark.parametrize(
    ("known", "damping", "stiffness"),
    [
        ({"--motion": "linear"}, "0.1 N*s/m", "100 N/m"),
        ({"--motion": "rotary"}, "0.01 N*m*s/rad", "0.1 N*m/deg"),
        ({"--motion": "rotary", "--handle-radius": "10 cm"}, "0.01 N*m*s/rad", "100 N/m"),
    ],
)
def test_a_guess_has_its_unit(
    known: dict[str, str], damping: str, stiffness: str, capsys: pytest.CaptureFixture[str]
) -> None:
    """Of a handle on a lever the damping is that of its shaft, and a wall is met by the handle."""
    assert (
        main(
            [
                "new",
                "device",
                *options({**known, "--rate": "1 kHz", "--damping": "unknown"}),
                "--no-questions",
            ]
        )
        == 0
    )
    line = next(line for line in capsys.readouterr().out.splitlines() if "zwidth check" in line)
    _, *command = shlex.split(line)
    assert command[2:] == ["--damping", damping, "--stiffness", stiffness]
    assert main(command) in (0, 1)


def test_the_missing_motion_is_said_before_what_does_not_fit(refused: Answered) -> None:
    """The motion comes first; then what a wall takes."""
    wall = {"--type": "wall", "--stiffness": "10 N*m/deg", "--start": "450 deg"}
    assert "--motion must be known" in refused("environment", *options(wall), "--no-questions")
    told = refused("environment", *options({**wall, "--motion": "rotary"}), "--no-questions")
    assert "--start: nothing asks for it" in told
    assert "--virtual-damping" in told


def test_a_stop_keeps_the_degrees_that_were_typed(tmp_path: Path) -> None:
    """From 450° to 470°, in degrees; hints of a wheel without damping are in torque and angle."""
    stop = tmp_path / "stop.toml"
    typed = ("--motion", "rotary", "--type", "bump-stop", "--start", "450 deg", "--depth", "20 deg")
    more = ("--stiffness", "0.5 N*m/deg", "--hardening", "unknown", "--no-questions")
    assert main(["new", "environment", str(stop), *typed, *more]) == 0
    assert 'positions = ["450 deg", "470 deg"]' in stop.read_text(encoding="utf-8")


def test_hints_for_a_wheel_are_in_torque_and_angle(
    tmp_path: Path, capsys: pytest.CaptureFixture[str]
) -> None:
    """A bare number would be per radian, and too stiff."""
    typed = ("--motion", "rotary", "--rate", "1 kHz", "--damping", "0.02", "--no-questions")
    assert main(["new", "device", str(tmp_path / "wheel.toml"), *typed]) == 0
    line = next(line for line in capsys.readouterr().out.splitlines() if "zwidth check" in line)
    assert line.endswith((' N*m/rad"', ' N*m/deg"'))


def test_the_device_of_an_environment_may_have_any_name(
    refused: Answered, capsys: pytest.CaptureFixture[str]
) -> None:
    """Its motion and its largest torque are taken; the file of a device is not written over."""
    assert main(["new", "device", "my-wheel.toml", *options(WHEEL), "--no-questions"]) == 0
    assert "zwidth new environment --device my-wheel.toml" in capsys.readouterr().out
    stop = options({"--type": "stop", "--start": "450 deg", "--stiffness": "1 N*m/deg"})
    assert (
        main(["new", "environment", "stop.toml", *stop, "--device", "my-wheel.toml", "--no-questions"]) == 0
    )
    out = capsys.readouterr().out
    assert "my-wheel.toml is rotary" in out
    assert "zwidth check my-wheel.toml stop.toml" in out
    assert "the largest of my-wheel.toml" in Path("stop.toml").read_text(encoding="utf-8")
    before = Path("my-wheel.toml").read_bytes()
    for force in ([], ["--force"]):
        told = refused("environment", "my-wheel.toml", *stop, "--no-questions", *force)
        assert "--device my-wheel.toml" in told
    assert Path("my-wheel.toml").read_bytes() == before
    assert "my-weel.toml" in refused("environment", *stop, "--device", "my-weel.toml", "--no-questions")
