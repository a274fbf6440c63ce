"""`zwidth new`: what a person knows becomes a file; what nobody knows is said, and never filled in."""

import math
import os
import shlex
import subprocess
import sys
from io import StringIO
from pathlib import Path

import pytest

import zwidth as zw
from zwidth.model.specification.read import load_device

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
LITTLE = {"--motion": "rotary", "--rate": "1 kHz", "--damping": "0.02"}
"""The least that is asked of a wheel."""


def options(answers):
    """Answers as options."""
    return " ".join(f"{option} {shlex.quote(answer)}" for option, answer in answers.items())


def text(name="my-device.toml"):
    return Path(name).read_text(encoding="utf-8")


@pytest.fixture
def make(run):
    """What is printed where answers become a file, of a device unless another kind is said."""
    return lambda answers, more="device": run(f"new {more} {options(answers)} --no-questions").out


@pytest.fixture
def device(make):
    """The device that answers make."""

    def runner(answers):
        make(answers)
        return load_device(["my-device.toml"], {})

    return runner


@pytest.fixture
def unusable(refused):
    """The one message where answers cannot be used."""
    return lambda answers, more="device": refused(f"new {more} {options(answers)} --no-questions")


@pytest.fixture
def piped(run, monkeypatch):
    """Runs a line with answers from a pipe."""

    def runner(lines, line="new device", status=0):
        monkeypatch.setattr("sys.stdin", StringIO("".join(f"{one}\n" for one in lines)))
        return run(line, status)

    return runner


# --- a device ----------------------------------------------------------------


def test_options_make_the_device_that_they_say(run, make):
    out = make(WHEEL, "device my-wheel.toml")
    found = load_device(["my-wheel.toml"], {})
    numbers = {"inertia": 0.006, "damping": 0.02, "coulomb_friction": 0.05, "rate": 1000, "delay": 0.0003}
    assert found.replace(name="device") == zw.rotary(**numbers, counts_per_turn=65536, force_limit=2)
    assert found.assumed == ()
    assert "zwidth new environment" in out
    check, report = (line.strip() for line in out.splitlines() if "--stiffness" in line)
    assert check.startswith("zwidth check ")
    assert report.startswith("zwidth report ")
    run(check.removeprefix("zwidth "))  # a stiffness at which it is passive
    run(report.removeprefix("zwidth "))


def test_answers_from_a_pipe_are_those_of_the_options(make, piped):
    """In the order of the questions; an empty line where nobody knows, here the handle's radius."""
    make(WHEEL, "device a.toml")
    answers = [*WHEEL.values()]
    piped([*answers[:3], "", *answers[3:]], "new device b.toml")
    assert text("a.toml") == text("b.toml")


@pytest.mark.parametrize(
    ("answer", "counts"),
    [
        ("2000 lines", 8000),  # four counts a line
        ("500 ppr", 2000),
        ("14 bit", 2**14),
        ("4096", 4096),
        ("1024 cpr", 1024),
        ("2^16", 2**16),
        ("65536 steps", 2**16),
        ("2^14 counts/rev", 2**14),
        ("0.09 deg", 4000.0),
        ("0.0055°", 360 / 0.0055),
        ("0.0055 degrees", 360 / 0.0055),
    ],
)
def test_an_encoder_as_data_sheets_and_people_say_it(device, answer, counts):
    resolution = 2 * math.pi / counts
    found = float(device({**WHEEL, "--encoder": answer}).resolution)
    assert found == (resolution if isinstance(counts, int) else pytest.approx(resolution))


def test_the_data_sheet_of_a_motor_gives_friction_and_largest_torque(device):
    """τ = n I/k_v: 270 rpm/V, 0.2 A without load, 10 A at most, a gear of 3."""
    known = {key: value for key, value in WHEEL.items() if key not in ("--coulomb-friction", "--force-limit")}
    motor = {"--motor-friction": "0.2 A", "--motor-peak": "10 A", "--torque-constant": "270 rpm/V"}
    found = device({**known, **motor, "--gear-ratio": "3"})
    constant = 60 / (2 * math.pi * 270)
    assert float(found.coulomb_friction) == pytest.approx(3 * constant * 0.2, rel=1e-5)
    assert float(found.force_limit) == pytest.approx(3 * constant * 10, rel=1e-5)
    assert "1/(270 rpm/V) x 0.2 A x 3" in text()
    assert "estimate" in text()


def test_a_motor_that_pulls_from_a_drum(device):
    """f = τ/r: 5 mN·m of friction at 10 mm are 0.5 N."""
    known = {"--mass": "36 g", "--rate": "1 kHz", "--damping": "0.1"}
    found = device({**known, "--motor-friction": "5 mN*m", "--drum-radius": "10 mm"})
    assert float(found.coulomb_friction) == 0.5


def test_a_handle_on_a_lever_is_seen_at_the_hand(device):
    """With a radius of 0.1 m, b/r²."""
    found = device({**WHEEL, "--handle-radius": "10 cm"})
    assert (found.motion, float(found.damping)) == ("linear", pytest.approx(2))


def test_what_is_unknown_is_left_out_and_said(run, refused, make):
    """No default: without damping there is no verdict, and it is said what to measure first."""
    out = make({"--motion": "linear", "--rate": "1 kHz", "--damping": "don't know"})
    keys = [line.partition(" =")[0] for line in text().splitlines() if " = " in line and line[0] != "#"]
    assert keys == ["motion", "rate"]
    assert "# damping is not known. Nothing is proved without it" in text()
    assert "zwidth identify" in out
    refused("check my-device.toml --stiffness 100")
    run("check my-device.toml --damping 0.1 --stiffness 100")


SLIDES = {"--motion": "linear", "--rate": "1 kHz", "--damping": "1"}
MOTOR = {"--motor-friction": "5 mNm", "--mass": "1 kg", "--rate": "1 kHz", "--damping": "1"}
SHEET = {"--torque-constant": "0.9 Nm/A", "--motor-friction": "0.2 A", "--force-limit": "20 Nm"}


@pytest.mark.parametrize(
    ("answers", "part"),
    [
        ({**WHEEL, "--rate": "1 ms"}, "rate is in Hz"),
        ({**WHEEL, "--damping": "-1 N*m*s/rad"}, "negative friction"),
        ({**WHEEL, "--delay": "3"}, '"3 ms"'),
        ({**WHEEL, "--encoder": "2.5 bit"}, "whole number of bits"),
        ({**WHEEL, "--encoder": "0.09"}, "write the unit"),
        ({**WHEEL, "--encoder": "22.4 um"}, "resolution is in rad"),
        ({**WHEEL, "--inertia": "0,006"}, '"0.006"'),
        ({**WHEEL, "--motion": "sideways"}, "rotary or linear"),
        ({**WHEEL, "--drum-radius": "1 cm"}, "--drum-radius"),
        ({**WHEEL, "--damping": "unknown", "--motion": "unknown"}, "--motion must be known"),
        ({**SLIDES, "--encoder": "2000 lines"}, "2 π r/N"),  # how to reckon
        # a bare 1000 is hardly a kilometre
        ({**WHEEL, "--handle-radius": "1000"}, 'write "1000 mm", or "1000 m"'),
        ({**MOTOR, "--drum-radius": "10"}, 'write "10 mm", or "10 m"'),
        ({**LITTLE, "--inertia": "unknown", **SHEET}, "--gear-ratio"),
        # of 1:5 nobody knows which way it is meant
        ({**LITTLE, "--motor-friction": "5 mNm", "--gear-ratio": "1:5"}, "turns more"),
        ({**LITTLE, "--motor-friction": "5 mNm", "--gear-ratio": "5:one"}, "plain number"),
    ],
)
def test_an_answer_that_cannot_be_used_is_one_message(unusable, answers, part):
    assert part in unusable(answers)
    assert not Path("my-device.toml").exists()


@pytest.mark.parametrize(
    ("lines", "line", "part"),
    [
        ([], "new device --motion rotary --rate '1 kHz'", "--damping"),
        (["rotary", "6"], "new device", "--rate, --damping"),
        (["rotary", "0.006 kg*m^2", "many"], "new device", "line 3 of the answers"),
    ],
)
def test_answers_that_end_too_early_or_are_wrong_are_one_message(piped, lines, line, part):
    """A script that did not say everything learns what is missing."""
    err = piped(lines, line, 2).err
    assert part in err
    assert err.count("\n") == 1


def test_answers_from_a_pipe_are_shown_with_their_questions(piped):
    """And how each was understood; a wrong one is refused with its question."""
    lines = ("wheel", "0.006 kgm²", "2^16", "", "1 kHz", "", "0.05 Nms/rad", "0.1 Nm", "20 Nm")
    out = piped(lines).out
    for part in ("Does the handle turn", "> wheel", "understood: rotary", "understood: 0.05 N·m·s/rad"):
        assert part in out
    err = piped(("wheel", "0.006 kgm²", "65,536 counts"), "new device --force", 2).err
    assert "Encoder, at the axis" in err
    assert '"65536"' in err
    assert "65.536" not in err


@pytest.mark.parametrize("word", ["turn", "wheel", "yes", "It turns", "a steering wheel"])
def test_that_it_turns_may_be_said_in_other_words(device, word):
    """The question names a wheel; "wheel" is an answer."""
    assert device({**WHEEL, "--motion": word}).motion == "rotary"


@pytest.mark.parametrize(
    ("answers", "line"),
    [
        ({"--damping": "0.02"}, 'damping = "0.02 N*m*s/rad"'),  # the unit in which a bare number is taken
        ({"--torque-constant": "0.9 Nm/A"}, "torque constant 0.9 Nm/A is known"),  # alone, kept as a remark
        ({"--motor-friction": "0.2 A"}, "0.2 A of the motor says it with --torque-constant"),
    ],
)
def test_the_file_says_what_was_understood(make, answers, line):
    make({**LITTLE, **answers})
    assert line in text()


def test_enter_at_the_gear_ratio_is_1(piped):
    """What the motor's data sheet says is not lost in silence."""
    asked = ("--inertia", "--encoder", "--delay", "--handle-radius", "--coulomb-friction")
    unknown = dict.fromkeys(asked, "unknown")
    piped([""], f"new device {options({**LITTLE, **unknown, **SHEET})}")
    assert float(load_device(["my-device.toml"], {}).coulomb_friction) == pytest.approx(0.18)


def test_a_gear_as_it_is_named(device):
    """5:1 is five turns of the motor in one of the handle."""
    found = device({**LITTLE, "--motor-friction": "5 mNm", "--gear-ratio": "5:1"})
    assert float(found.coulomb_friction) == pytest.approx(0.025)


def test_a_file_is_kept_unless_force_is_given(make, unusable, refused):
    Path("my-device.toml").write_text("mine", encoding="utf-8")
    assert "--force" in unusable(WHEEL)
    assert text() == "mine"
    make(WHEEL, "device --force")
    assert text() != "mine"
    assert ".toml" in unusable(WHEEL, "device my-device.txt")
    assert "device" in refused("new devise")


def in_a_terminal(folder, answers, kind):
    """`zwidth new` with answers that are typed."""
    pty = pytest.importorskip("pty")
    here, there = pty.openpty()
    os.write(here, answers.encode())
    command = [sys.executable, "-m", "zwidth", "new", kind]
    environment = {**os.environ, "PYTHONIOENCODING": "utf-8"}
    run = {"capture_output": True, "encoding": "utf-8", "timeout": 120, "cwd": folder, "env": environment}
    done = subprocess.run(command, stdin=there, **run)
    os.close(here)
    os.close(there)
    return done


def test_in_a_terminal_a_wrong_answer_is_asked_again(tmp_path):
    """Each question with why it matters; what is wrong with an answer at once, then the question stays."""
    answers = "rotary\n0.006 kg\n0.006 kg*m^2\n?\n\n1 kHz\n\n0.02\n0.05 N*m\n2 N*m\n"
    done = in_a_terminal(tmp_path, answers, "device")
    assert done.returncode == 0, done.stderr
    for part in ("Does the handle turn", "No proof depends on it", "a mass (kg)", "an ideal encoder"):
        assert part in done.stdout
    assert "zwidth check my-device.toml --stiffness" in done.stdout
    assert done.stdout.count("Moment of inertia") == 1
    assert load_device([tmp_path / "my-device.toml"], {}).motion == "rotary"


def test_back_leads_to_the_question_before(tmp_path):
    """The answers before it are kept, its own is replaced."""
    answers = "back\nwall\nlinear\n300\nback\nback\nrotary\n20 Nm/rad\n\n"
    done = in_a_terminal(tmp_path, answers, "environment")
    assert done.returncode == 0, done.stderr
    assert "This is the first question" in done.stdout
    assert "understood: 300 N/m" in done.stdout
    assert 'stiffness = "20 Nm/rad"' in text(tmp_path / "my-environment.toml")


def test_enter_at_what_must_be_known_ends(tmp_path):
    done = in_a_terminal(tmp_path, "\n\n\n", "device")
    assert done.returncode == 2
    assert "must be known" in done.stderr


# --- an environment ----------------------------------------------------------


def environment_of(sample):
    """The environment that was made, for a device of the samples."""
    return zw.load(zw.samples.path(sample), "my-environment.toml").environment


def test_a_wall(make):
    answers = {"--type": "wall", "--motion": "linear", "--stiffness": "200 N/m", "--virtual-damping": "0.05"}
    assert "my-environment.toml" in make(answers, "environment")
    assert environment_of("paddle.toml") == zw.Wall(200, 0.05)


ROW = {"--type": "detents", "--count": "3", "--pitch": "30 deg", "--peak": "20 mN*m"}
STOP = {"--type": "bump-stop", "--start": "1 rad", "--stiffness": "20 N*m/rad", "--depth": "0.1 rad"}


@pytest.mark.parametrize(
    ("answers", "same"),
    [
        (ROW, zw.NonlinearSpring.detents(3, math.pi / 6, 0.02)),
        ({**STOP, "--hardening": "1000 N*m/rad^3"}, zw.NonlinearSpring.bump_stop(1, 20, 1000, 0.1, 26)),
    ],
    ids=["detents", "bump stop"],
)
def test_detents_and_a_bump_stop_are_those_of_the_library(make, answers, same):
    make({**answers, "--motion": "rotary"}, "environment")
    spring = environment_of("wheel.toml")
    assert [float(x) for x in spring.positions] == pytest.approx([float(x) for x in same.positions])
    assert [float(f) for f in spring.forces] == pytest.approx([float(f) for f in same.forces])


FLAT = {"--type": "wall", "--motion": "linear"}


@pytest.mark.parametrize(
    ("answers", "parts"),
    [
        (FLAT, ["--stiffness"]),
        ({**FLAT, "--type": "wal"}, ['did you mean "wall"']),
        ({**FLAT, "--stiffness": "20 N*m/rad"}, ["stiffness is in N/m"]),
        ({**FLAT, "--stiffness": "1", "--count": "3"}, ["--count"]),
        ({**ROW, "--motion": "rotary", "--count": "2.5"}, ["whole"]),
        ({**FLAT, "--stiffness": "-3"}, ["≥ 0"]),
        # the missing motion is said before what does not fit
        ({"--type": "wall", "--stiffness": "10 N*m/deg", "--start": "450 deg"}, ["--motion must be known"]),
        (
            {"--type": "wall", "--motion": "rotary", "--stiffness": "10 N*m/deg", "--start": "450 deg"},
            ["--start: nothing asks for it", "--virtual-damping"],
        ),
    ],
)
def test_an_environment_that_cannot_be_is_one_message(unusable, answers, parts):
    message = unusable(answers, "environment")
    assert all(part in message for part in parts), message
    assert not Path("my-environment.toml").exists()


@pytest.mark.parametrize("word", ["stop", "bump stop", "Bump-Stop", "bump_stop"])
def test_a_bump_stop_in_other_words(make, word):
    """And where no depth is said, to the largest torque of the device in the same folder: 20/450 rad."""
    make({"--motion": "wheel", "--rate": "1 kHz", "--damping": "unknown", "--force-limit": "20 Nm"})
    make({"--type": word, "--start": "450 deg", "--stiffness": "450"}, "environment")
    assert "f = (450 N*m/rad) u" in text("my-environment.toml")
    assert "the largest of my-device.toml" in text("my-environment.toml")
    spring = environment_of("wheel.toml")
    assert float(spring.positions[-1] - spring.positions[0]) == pytest.approx(20 / 450, abs=1e-8)
    assert float(spring.forces[-1]) == pytest.approx(20)


def test_the_largest_torque_says_nothing_of_a_device_that_slides(make, unusable):
    """20 N*m over N/m is no depth."""
    make(WHEEL)
    stop = {"--type": "stop", "--start": "5 mm", "--stiffness": "450 N/m", "--motion": "linear"}
    assert "--depth must be known" in unusable(stop, "environment")


def test_what_to_type_next_can_be_typed(run, make):
    wall = {"--type": "wall", "--stiffness": "20 Nm/rad"}
    assert "zwidth new device" in make({**wall, "--motion": "wheel"}, "environment")
    make({"--motion": "wheel", "--rate": "1 kHz", "--damping": "unknown"})
    line = make(wall, "environment --force").splitlines()[-1].strip()
    assert "--damping" in line
    assert run(line.removeprefix("zwidth "), None).status in (0, 1)


@pytest.mark.parametrize(
    ("known", "damping", "stiffness"),
    [
        ({"--motion": "linear"}, "0.1 N*s/m", "100 N/m"),
        ({"--motion": "rotary"}, "0.0001 N*m*s/rad", "0.1 N*m/deg"),
        ({"--motion": "rotary", "--handle-radius": "10 cm"}, "0.0001 N*m*s/rad", "100 N/m"),
    ],
)
def test_a_guess_has_its_unit(run, make, known, damping, stiffness):
    """Of a handle on a lever the damping is that of its shaft, and a wall is met by the handle."""
    out = make({**known, "--rate": "1 kHz", "--damping": "unknown"})
    line = next(line.strip() for line in out.splitlines() if "zwidth check" in line).removeprefix("zwidth ")
    assert ("of a knob (a wheel has 0.02)" in out) == ("0.0001" in damping)
    assert shlex.split(line)[2:] == ["--damping", damping, "--stiffness", stiffness]
    assert run(line, None).status in (0, 1)


def test_a_stop_keeps_the_degrees_that_were_typed(make):
    angles = {
        "--start": "450 deg",
        "--depth": "20 deg",
        "--stiffness": "0.5 N*m/deg",
        "--hardening": "unknown",
    }
    make({"--motion": "rotary", "--type": "bump-stop", **angles}, "environment")
    assert 'positions = ["450 deg", "470 deg"]' in text("my-environment.toml")


def test_hints_for_a_wheel_are_in_torque_and_angle(make):
    """A bare number would be per radian, and too stiff."""
    line = next(line for line in make(LITTLE).splitlines() if "zwidth check" in line)
    assert line.endswith((' N*m/rad"', ' N*m/deg"'))


def test_the_device_of_an_environment_may_have_any_name(make, unusable):
    """Its motion and its largest torque are taken; the file of a device is not written over."""
    assert "zwidth new environment --device my-wheel.toml" in make(WHEEL, "device my-wheel.toml")
    stop = {"--type": "stop", "--start": "450 deg", "--stiffness": "1 N*m/deg"}
    out = make(stop, "environment stop.toml --device my-wheel.toml")
    assert "my-wheel.toml is rotary" in out
    assert "zwidth check my-wheel.toml stop.toml" in out
    assert "the largest of my-wheel.toml" in text("stop.toml")
    before = Path("my-wheel.toml").read_bytes()
    for force in ("", "--force"):
        assert "--device my-wheel.toml" in unusable(stop, f"environment my-wheel.toml {force}")
    assert Path("my-wheel.toml").read_bytes() == before
    assert "my-weel.toml" in unusable(stop, "environment --device my-weel.toml")
