"""`zwidth doctor`: what is asked about, and what is printed and saved."""

import json
from pathlib import Path

import numpy as np
import pytest

import zwidth as zw
from zwidth.machine.servo import checkup
from zwidth.machine.servo.lateness import Lateness, Measured
from zwidth.machine.servo.priority import Answer, Granted

NO = Granted((Answer("priority", False, "not permitted"), Answer("memory", False, "8 MiB")))


@pytest.fixture
def doctor(monkeypatch, run):
    """Runs the command on a machine that is 40 µs late, and gives (what was measured, what was printed)."""
    measured = {}

    def measure(period, duration, **more):
        measured.update(period=period, duration=duration, core=more["core"])
        return Measured(Lateness(np.full(1000, 40e-6), 0, 0.0, NO), None, NO)

    monkeypatch.setattr(checkup, "measure_lateness", measure)

    def command(line=""):
        told = run(f"doctor {line}").out
        return dict(measured), told

    return command


def test_without_a_device_a_minute_at_a_kilohertz(doctor):
    asked, told = doctor()
    assert asked == {"period": 1e-3, "duration": 60, "core": None}
    assert "a loop at 1 kHz" in told
    assert "stiffness" not in told
    asked, _ = doctor("--rate '4 kHz' --duration '2 s' --core 1")
    assert asked == {"period": 25e-5, "duration": 2, "core": 1}
    assert doctor("--sample-period '2 ms'")[0]["period"] == 2e-3


def test_a_device_alone_has_a_spring(doctor):
    """At its own rate, and the cost is that of K = 2 b/T."""
    asked, told = doctor("--damping 0.35 --rate '2 kHz' --json")
    cost = json.loads(told)["cost"]["max_stiffness_N_per_m"]
    assert asked["period"] == 5e-4
    assert cost["nominal"] == pytest.approx(1400)
    assert cost["longer_period"] == pytest.approx(0.7 / 540e-6)


def test_an_environment_comes_from_options_or_a_file(doctor):
    """The same wall by both roads costs the same, and another than a spring does."""
    wall = '[environment]\ntype = "wall"\nstiffness = 10\nvirtual_damping = 0.04\n'
    Path("wall.toml").write_text(wall, encoding="utf-8")
    asked = ("--stiffness 10 --virtual-damping 0.04", "wall.toml", "")
    costs = [json.loads(doctor(f"haptic-paddle {more} --json")[1])["cost"] for more in asked]
    assert costs[0] == costs[1]
    assert costs[0] != costs[2]
    device = zw.catalogue.device("haptic-paddle")
    nominal = costs[2]["max_stiffness_N_per_m"]["nominal"]
    assert nominal == zw.check(device, zw.Wall(stiffness=1)).max_stiffness


def test_what_is_saved_is_what_is_printed(doctor, refused):
    """As JSON and as a picture; neither is replaced unasked."""
    told = doctor("--duration 1 -o found.json --plot late.svg")[1]
    assert "written: found.json" in told
    assert json.loads(Path("found.json").read_text(encoding="utf-8"))["format"] == "zwidth doctor 1"
    assert Path("late.svg").read_text(encoding="utf-8").startswith("<?xml")
    assert "exists" in refused("doctor -o found.json")


@pytest.mark.parametrize(
    ("line", "said"),
    [
        ("--rate 0", "rate must be > 0"),
        ("--rate '1 kHz' --sample-period '1 ms'", "either --rate or --sample-period"),
        ("--core first", "--core is the number of a core"),
        ("--duration '1 m'", "duration"),
        ("--stiffness 10", "no device is given"),
        ("--law passivity-controller", "no device is given"),
        ("haptic-paddle --type pulse-transfer-function --numerator 1 --denominator 1", "none"),
    ],
)
def test_bad_input_says_what_is_wrong(line, said, refused, monkeypatch):
    """Before anything is measured."""
    monkeypatch.setattr(checkup, "measure_lateness", lambda *_, **__: pytest.fail("it measures"))
    assert said in refused(f"doctor {line}")
