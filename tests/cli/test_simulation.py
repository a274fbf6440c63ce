"""`zwidth simulate` and `zwidth traces`: files, tables, options, and one clear line on bad input."""

import math
import os
import subprocess
import sys
from pathlib import Path

import numpy as np
import pytest

import zwidth as zw
from zwidth.cli.simulate.tables import KEYS, follower_parameters, operator_parameters, simulation_parameters
from zwidth.model import operator as operators

WALL = "simulate haptic-paddle --stiffness 770"
DOWEL = f"{WALL} --operator dowel --duration 0.2"


def test_the_example_of_the_docs_in_a_process_of_its_own(tmp_path):
    """It reports, draws and saves; the trace comes back as Python would have made it."""
    words = f"-m zwidth {WALL} --operator dowel --duration 2 --plot touch.png -o touch.nc".split()
    done = subprocess.run([sys.executable, *words], cwd=tmp_path, capture_output=True, text=True)
    assert done.returncode == 0, done.stderr
    assert "GAINED" in done.stdout
    assert {p.name for p in tmp_path.iterdir()} == {"touch.png", "touch.nc"}
    trace = zw.traces.load_trace(tmp_path / "touch.nc")
    paddle = zw.catalogue.device("haptic-paddle")
    assert trace.identical(zw.simulate(paddle, zw.Wall(770), zw.operators.Dowel(), 2.0))


def test_the_report_says_what_came_out(run):
    """An active touch, a quiet one, and one that began inside, each in words."""
    assert "GAINED" in run(DOWEL).out
    assert "got no energy out" in run(f"{DOWEL} --force-limit 0.5").out
    run(f"{DOWEL} --initial-position '20 mm'").says("were stored at the start: nothing was gained")


def test_json_carries_units_in_its_keys(run):
    document = run(f"{DOWEL} --json").json
    trace = zw.simulate(zw.catalogue.device("haptic-paddle"), zw.Wall(770), zw.operators.Dowel(), 0.2)
    assert document["deepest_position_m"] == trace.position.values.max()
    assert document["energy"]["hand_work_J"] == float(trace.hand_work[-1])
    assert document["sample_period_s"] == 0.001


def test_everything_can_stand_in_one_file(run):
    """Tables [operator] and [simulation] beside the two of check; the command line overrides them."""
    Path("touch.toml").write_text(
        '[device]\ncatalogue = "haptic-paddle"\n[environment]\ntype = "wall"\nstiffness = 770\n'
        '[operator]\ntype = "constant-force"\nforce = "3 N"\n'
        '[simulation]\nduration = "0.2 s"\ninitial_position = "-5 mm"\namplifier = "ideal"\n',
        encoding="utf-8",
    )
    document = run("simulate touch.toml --json --operator.force '2 N'").json
    hand = zw.operators.ConstantForce(2.0)
    device = zw.catalogue.device("haptic-paddle")
    ideal = zw.amplifiers.Ideal()
    trace = zw.simulate(device, zw.Wall(770), hand, 0.2, initial_position=-5e-3, amplifier=ideal)
    assert document["energy"]["hand_work_J"] == float(trace.hand_work[-1])


def test_check_says_where_a_table_of_a_touch_belongs(refused):
    """It is not ignored."""
    Path("t.toml").write_text('[operator]\ntype = "dowel"\n', encoding="utf-8")
    assert "for zwidth simulate" in refused("check haptic-paddle t.toml --stiffness 1")


def test_every_key_of_a_simulation_is_used(run):
    """All at once, with every amplifier: nothing is ignored, nothing crashes."""
    clock = "--lateness '0.1 ms' --missed 0.01 --seed 4 --points-per-sample 2 --encoder-phase 0.3"
    common = f"{DOWEL} --initial-velocity '0.1 m/s' {clock} --json --amplifier"
    amplifiers = ("ideal", "current", "voltage-limited", "lag --amplifier-time-constant '0.3 ms'")
    assert len({run(f"{common} {amplifier}").out for amplifier in amplifiers}) == 4
    given = {word.removeprefix("--").replace("-", "_") for word in common.split() if word[:2] == "--"}
    assert set(KEYS) <= given | {"initial_position", "amplifier", "amplifier_time_constant"}


def test_a_recorded_force_and_a_witness_come_out_of_files(run):
    """Both bring their own duration; the witness gives the energy that check claims."""
    Path("force.csv").write_text("\n".join(map(str, np.linspace(0, 2, 50))), encoding="utf-8")
    record = "--operator force-record --operator.file force.csv"
    document = run(f"simulate haptic-paddle --stiffness 300 {record} --json").json
    assert "50 samples" in document["operator"]
    run("check haptic-paddle --stiffness 770 -o motion.json", 1)
    replayed = f"{WALL} --operator witness --operator.file motion.json --amplifier ideal"
    energy = run(f"{replayed} --json").json["energy"]
    witness = zw.check(zw.catalogue.device("haptic-paddle"), zw.Wall(770)).witness
    assert -energy["hand_work_J"] == pytest.approx(witness.energy, rel=1e-9)


def test_sound_and_pictures_are_written_and_named(run):
    out = run(f"{DOWEL} --sound buzz.wav --plot touch.svg -o touch.parquet").out
    for name in ("buzz.wav", "touch.svg", "touch.parquet"):
        assert name in out
        assert Path(name).stat().st_size > 1000


def test_saved_traces_are_compared(run):
    run(f"{DOWEL} -o dowel.nc")
    run(f"{WALL} --operator malicious --duration 0.2 -o finger.csv")
    run("traces dowel.nc finger.csv --plot both.png").says("dowel.nc", "deepest [m]")
    assert Path("both.png").exists()
    document = run("traces dowel.nc finger.csv --json").json
    assert document["dowel.nc"]["energy_extracted_J"] > 0


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
def test_a_record_that_cannot_be_used_is_refused(refused, content, says):
    """NaN forces, too many columns, an empty file, too few values, words."""
    Path("force.csv").write_text(content, encoding="utf-8")
    record = "--operator force-record --operator.file force.csv"
    assert says in refused(f"{WALL} {record} --duration 0.2")


@pytest.mark.skipif(not Path("/dev/full").exists(), reason="there is no full device to write to")
@pytest.mark.parametrize("suffix", [".nc", ".csv", ".parquet", ".wav", ".png"])
def test_a_full_disk_is_one_line(refused, monkeypatch, suffix):
    real = os.replace

    def full(source, target):
        if str(target).endswith(suffix):
            raise OSError(28, "No space left on device")
        real(source, target)

    monkeypatch.setattr("os.replace", full)
    option = {".wav": "--sound", ".png": "--plot"}.get(suffix, "-o")
    assert "No space left on device" in refused(f"{DOWEL} {option} touch{suffix}")
    assert not list(Path().iterdir())


def test_ctrl_c_keeps_what_is_finished_and_says_so(run, monkeypatch):
    import zwidth.loop.simulate as module

    monkeypatch.setattr(module, "_STRIDE", 50)
    real, calls = module.run_samples, []

    def stopped(*arguments):
        calls.append(1)
        if len(calls) > 2:
            raise KeyboardInterrupt
        real(*arguments)

    monkeypatch.setattr(module, "run_samples", stopped)
    assert "interrupted" in run(f"{DOWEL} -o part.nc", 130).out
    assert zw.traces.load_trace("part.nc").sizes["time"] == 100


def test_every_option_of_a_touch_has_a_unit_or_needs_none():
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


def test_a_hand_that_met_nothing_says_so(run, refused):
    """Where the stop begins, how far the hand came, and how to start there; not that no energy came out."""
    Path("stop.toml").write_text(STOP, encoding="utf-8")
    touched = "simulate stop.toml --duration 0.2 --operator typical"
    said = run(touched).words
    assert "never reached the wall: it begins at 450 deg" in said
    assert '--initial-position "450 deg"' in said
    assert "contacts made" not in said
    there = "simulate stop.toml --duration 0.2 --operator constant-force --initial-position '450 deg'"
    assert "never reached" not in run(there).out
    error = refused(f"{touched} --operator.start '449 deg'")
    assert "got 449 deg" in error
    assert "--initial-position" in error or "initial_position" in error


def test_what_is_left_alone_and_shakes(run):
    """A centring spring acts everywhere: there is no contact to count, and no hand to get energy out."""
    wheel = "--inertia 0.006 --damping 0.02 --coulomb-friction 0.05 --rate 1000 --delay '2 ms'"
    spring = "--type nonlinear-spring --positions='-90 deg, 90 deg' --forces='-{0} N*m, {0} N*m'"
    said = run(f"simulate {wheel} {spring.format(45)} --operator hands-off --initial-velocity '90 deg/s'").out
    assert said.split()[0] == "SHAKES"
    assert "farthest position" in said
    assert "contacts made" not in said
    assert "2 s of it" in said
    soft = run(f"simulate {wheel} {spring.format(4)} --operator hands-off --initial-velocity '90 deg/s'")
    assert soft.out.split()[0] == "TOUCH"


def test_a_steady_buzz_between_detents_shakes_too(run):
    """It neither grows nor ends: from turn to turn the encoder's steps change the swing a little."""
    knob = "--inertia 2e-5 --damping 2e-4 --coulomb-friction 0.002 --counts-per-turn 16384 --rate 2000"
    row = zw.NonlinearSpring.detents(24, math.radians(15), 0.03)
    where, forces = (", ".join(map(str, numbers)) for numbers in (row.positions, row.forces))
    left = f"{knob} --delay '1 ms' --type nonlinear-spring --positions='{where}' --forces='{forces}'"
    left += " --operator hands-off --initial-velocity '720 deg/s'"
    assert run(f"simulate {left} --duration 8").out.split()[0] == "SHAKES"


def test_a_knob_that_was_typed_in_degrees(run, refused):
    """It is answered in them whatever the hand was typed in, and the hand to begin with is that of a knob."""
    knob = "--inertia 2e-5 --damping 2e-4 --coulomb-friction 0.002 --counts-per-turn 16384 --rate 2000"
    knob += " --type nonlinear-spring --positions='-20 deg, 20 deg' --forces='-0.01, 0.01'"
    hand = "--operator finger --operator.mass 5e-6 --operator.stiffness '0.1 N*m/rad' --operator.damping 1e-3"
    hand += " --operator.force 0.01 --operator.start '-0.2 rad' --operator.speed '2 rad/s' --duration 0.1"
    assert " deg" in run(f"simulate {knob} {hand}").out.split("device")[0]
    assert "rad" not in run(f"simulate {knob} {hand}").out.split("hand  ")[0]
    in_radians = knob.replace("-20 deg, 20 deg", "-0.3, 0.3")
    assert " rad" in run(f"simulate {in_radians} {hand}").out.split("device")[0]
    assert "begin with --operator fingers-on" in refused(f"simulate {knob} --duration 1")
    wheel = knob.replace("2e-5", "0.01")
    assert "begin with --operator hands-on" in refused(f"simulate {wheel} --duration 1")


def test_hands_are_named_with_a_word_and_one_to_begin_with(refused):
    error = refused(f"{WALL} --duration 1")
    assert "begin with --operator typical" in error
    for name, hand in operators.OPERATORS.items():
        assert (f"{name}, " in error) == (hand.motion != "rotary")
    assert "begin with typical" in refused(f"{WALL} --operator hand --duration 1")
