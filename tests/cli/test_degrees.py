"""A wheel of 65 536 counts, 1 kHz USB and a delay of part of a sample, in degrees through every command."""

import re
from pathlib import Path

import pytest

WHEEL = """[device]
name = "wheel"
motion = "rotary"
inertia = "60 kg*cm^2"
damping = "0.0009 N*m*s/deg"
coulomb_friction = "0.15 N*m"
counts_per_turn = 65536
rate = "1 kHz"
delay = "1.4 ms"
force_limit = "8 N*m"
"""
STOP = '[environment]\ntype = "wall"\nstiffness = "0.4 N*m/deg"\n'
SOLID = '[environment]\ntype = "maxwell"\nstiffness = 1\nvirtual_damping = 1\n'


@pytest.fixture(autouse=True)
def _files(run):
    plain = WHEEL.replace("0.0009 N*m*s/deg", "0.05")
    texts = {"wheel": WHEEL + STOP, "device": WHEEL, "other": WHEEL + SOLID, "plain": plain}
    for name, text in texts.items():
        Path(f"{name}.toml").write_text(text, encoding="utf-8")


RIM = "--handle-radius '0.15 m' --laws wall"
HANDS = "--operator hands-on --duration '0.2 s'"
FREE = "--operator hands-off --initial-velocity '360 deg/s' --duration '0.2 s'"
CELLS = "--virtual-damping '0:0.001 N*m*s/deg' --cells 4x4"
MAP = f"--stiffness '0.1:1 N*m/deg' {CELLS}"


@pytest.mark.parametrize(
    ("line", "status", "parts"),
    [
        ("check wheel.toml", 0, ["up to 0.466 N·m/deg (now 0.4 N·m/deg)", "Δ = 0.00549316 deg"]),
        (
            "check wheel.toml --stiffness '0.6 N*m/deg' --all",
            1,
            ["required device damping 1.15865 mN·m·s/deg", "deg at up to 1335 deg/s"],
        ),
        (
            f"simulate wheel.toml {HANDS} --operator.speed '60 rpm' --all",
            0,
            ["stiffness 0.106029 N·m/deg", "speed 60 rpm", "start -17.1887 deg", "deepest position"],
        ),
        (f"simulate wheel.toml {FREE}", 0, ["hand hands off", "deg"]),
        (f"compare wheel.toml {RIM} --all", 0, ["touched 150 mm from its axis", "N·m/deg"]),
        (f"map device.toml {MAP}", 0, ["largest K [N·m/deg]", "stable, hands-on", "28.65 deg/s"]),
        ("pair device.toml --stiffness '0.1 N*m/deg' --link-delay '2 ms'", 0, ["go up to 0.154 N·m/deg"]),
        (
            "plan device.toml --force-noise '0.05 N*m' --length '90 deg'",
            0,
            ["strokes of some 90 deg", "deg/s"],
        ),
        ("emit wheel.toml -o emitted", 0, ["wall, 0.4 N·m/deg"]),
        ("play wheel.toml -o play.html", 0, ["wall, 0.4 N·m/deg"]),
    ],
)
def test_a_wheel_in_degrees(run, line, status, parts):
    """Nobody reads radians who typed none; nothing stops the wheel."""
    result = run(line, status)
    said = " ".join((result.out + result.err).split())
    for part in parts:
        assert part in said
    assert not re.search(r"\brad\b", said), said


def test_what_the_page_says(run):
    """A report is in degrees, tables and captions too."""
    said = run("report wheel.toml -o report.html")
    assert "passive" in said.out
    page = Path("report.html").read_text(encoding="utf-8")
    text = re.sub(r"<script.*?</script>|<style.*?</style>|base64,[^\"]*|<[^>]+>", " ", page, flags=re.DOTALL)
    assert "0.466062 N·m/deg" in text
    assert not re.search(r"\brad\b", said.out + said.err + text.split("What the checker read")[0])


def test_documents_are_si(run):
    found = run("check wheel.toml --json").json
    assert found["max_stiffness_N_m_per_rad"] == pytest.approx(26.7034, rel=1e-5)


def test_a_saved_trace_remembers_the_question(run):
    """Its numbers are SI; who reads them together is told in degrees."""
    run(f"simulate wheel.toml {HANDS} -o a.csv")
    assert "deepest [deg]" in run("traces a.csv").words
    run(f"simulate plain.toml --stiffness 20 {HANDS} -o c.csv")
    assert "deepest [rad]" in run("traces c.csv").words


def test_who_types_radians(run):
    assert "N·m/rad" not in run("check wheel.toml").out
    said = run("check plain.toml --stiffness '5 N*m/rad'").out
    assert "5 N·m/rad" in said
    assert "deg" not in said


def test_the_unit_of_a_range_is_of_both_its_ends(run):
    one = run(f"map device.toml {MAP} --json")
    assert run(f"map device.toml --stiffness '0.1 N*m/deg:1 N*m/deg' {CELLS} --json") == one


@pytest.mark.parametrize(
    ("line", "part"),
    [
        ("compare wheel.toml", '--handle-radius "0.15 m" for a wheel'),
        (f"compare wheel.toml {RIM} --law extrapolation", "the bench touches the rim"),
        ("simulate wheel.toml --operator hands-off --duration 1", '--initial-velocity "360 deg/s"'),
        (f"simulate haptic-paddle --stiffness 300 {HANDS}", "holds a device that turns"),
        (f"map other.toml {MAP}", "a map is of walls"),
    ],
)
def test_what_cannot_be_is_said(refused, line, part):
    assert part in refused(line)


def test_a_device_in_its_ranges(run):
    said = run("check moza-r9 --stiffness '2 N*m/deg'", 3).words
    for part in ("measure first damping", "for every device in the ranges: up to 0.034", "delay 0 … 2 ms"):
        assert part in said
    document = run("check moza-r9 --stiffness '2 N*m/deg' --json", 3).json
    assert document["ranges"]["measure_first"]["parameter"] == "damping"
    assert "let go at a turn a second" in run("check moza-r9 --stiffness '0.03 N*m/deg' --all").words
    run("check dynamixel-mx-64 --stiffness 1", None).says("measure first rate: if it is at least 83.89 Hz")
    run("report moza-r9 --stiffness '1 N*m/deg' -o ranges.html", None)
    assert "stated and not measured" in Path("ranges.html").read_text(encoding="utf-8")
