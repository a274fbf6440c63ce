"""`zwidth emit`: files, a short report, an exit status for each outcome, one clear line on bad input."""

from hashlib import sha256
from pathlib import Path

import pytest

PADDLE = "emit haptic-paddle --stiffness 150 --virtual-damping 0.05"
TRAVEL = "--travel '-60 .. 60 mm'"


@pytest.mark.parametrize(
    ("target", "files"),
    [
        ("c99", {"law.h"}),
        ("arduino", {"law.h", "guard.h", "telemetry.h", "wall.ino"}),
        ("cortex-m", {"law.h", "guard.h", "telemetry.h", "main.c", "startup.c", "law.ld", "Makefile"}),
        ("posix", {"law.h", "guard.h", "telemetry.h", "main.c", "mass.c", "device.h", "Makefile"}),
        ("moteus", {"law.h", "guard.h", "telemetry.h", "main.c", "moteus.c", "device.h", "Makefile"}),
        ("simplefoc", {"law.h", "guard.h", "telemetry.h", "wall.ino"}),
        ("javascript", {"law.mjs"}),
    ],
)
def test_what_is_written_for_a_target(run, target, files):
    run(f"{PADDLE} --target {target} -o wall")
    assert {path.name for path in Path("wall").iterdir()} == files | {"law.certificate.json"}


@pytest.mark.parametrize(
    ("loop", "status"),
    [
        ("--stiffness 150", 0),
        ("--stiffness 770", 1),
        ("--stiffness 150 --law saturation", 3),
        ("--stiffness 150 --contact kept", 0),
        ("--stiffness -5", 2),
    ],
)
def test_the_exit_status(run, loop, status):
    """As `check` has it; nothing is written where it is not 0."""
    run(f"emit haptic-paddle {loop} {TRAVEL} -o wall", status)
    assert Path("wall").exists() == (status == 0)


def test_many_detents_for_a_board(run):
    """The rounding of a search in 50 points is bounded; where nothing bounds it, what would do is told."""
    device = "--inertia 2e-5 --damping 0.001 --coulomb-friction 0.002 --counts-per-turn 16384 --rate 1000"
    points = "--type nonlinear-spring --positions '{}' --forces '{}'"

    def zigzag(n):
        forces = (f"{(-1) ** (k + 1)} mN*m" for k in range(n))
        return points.format(", ".join(str(k / 8) for k in range(n)), ", ".join(forces))

    run(f"emit {device} {zigzag(50)} --target simplefoc -o knob --json")
    message = run(f"emit {device} {zigzag(140)} --target simplefoc -o more", 3).err
    assert "at most 129 points" in message
    assert "--number double" in message


def test_beyond_the_points_of_a_spring(run):
    """Readings that go beyond them: what the law does there; of those that do not nothing is said."""
    spring = "--type nonlinear-spring --positions='-1 mm, 1 mm' --forces='-0.1 N, 0.2 N' -o out --force"
    told = run(f"emit haptic-paddle {spring} --travel '-2 .. 1 mm'").out
    assert "the force stays, -0.1 N below -1 mm, 0.2 N above 1 mm" in " ".join(told.split())
    assert "the force stays" not in run(f"emit haptic-paddle {spring} --travel '-0.9 .. 0.9 mm'").out


def test_anyway(run):
    assert "ACTIVE" in run("emit haptic-paddle --stiffness 770 --anyway -o wall").out
    assert "NOT PROVED" in Path("wall", "law.h").read_text(encoding="utf-8")


@pytest.mark.parametrize("loop", [PADDLE, "emit haptic-paddle --stiffness 770 --anyway"])
@pytest.mark.parametrize("target", ["arduino", "cortex-m", "javascript"])
def test_the_report_is_short(run, loop, target):
    """The outcome first, what its numbers cost, 15 lines of 80 columns at most, and each file."""
    text = run(f"{loop} --target {target} -o wall").out
    lines = text.splitlines()
    assert lines[0].split()[0] in ("PASSIVE", "ACTIVE")
    assert len([line for line in lines if not line.startswith("written: ")]) <= 15
    assert max(map(len, lines)) <= 80
    for word in ("force off by at most", "numbers", "written", "law.certificate.json", "readings from"):
        assert word in text


def test_the_report_as_json(run):
    found = run(f"{PADDLE} {TRAVEL} --target arduino --json -o wall").json
    keys = "format prefix target number outcome statement error_N rounding_N stiffness_cost_N_per_m"
    assert set(found) == {*keys.split(), "certificate_sha256", "files", "verdict"}
    assert (found["target"], found["number"], found["outcome"]) == ("arduino", "fixed", "passive")
    assert 0 < found["rounding_N"] < found["error_N"] < 0.001
    for name, digest in found["files"].items():
        written = Path("wall", name.replace("law.ino", "wall.ino"))
        assert sha256(written.read_bytes()).hexdigest() == digest
    assert found["files"]["law.certificate.json"] == found["certificate_sha256"]
    assert found["verdict"]["outcome"] == "passive"


def test_where_the_files_go(run, refused):
    assert "-o DIRECTORY" in refused(PADDLE)
    Path("file").write_text("mine", encoding="utf-8")
    assert "exists and is no directory" in refused(f"{PADDLE} -o file")
    assert "cannot be made" in refused(f"{PADDLE} -o file/below")
    assert "give that of the directory" in refused(f"{PADDLE} -o law.h")
    assert not Path("law.h").exists()
    run(f"{PADDLE} -o wall")
    Path("wall/law.h").write_text("mine", encoding="utf-8")
    assert "exists; choose another name, or give --force to" in refused(f"{PADDLE} -o wall")
    assert Path("wall/law.h").read_text(encoding="utf-8") == "mine"
    run(f"{PADDLE} -o wall --force")
    assert Path("wall/law.h").read_text(encoding="utf-8") != "mine"


def test_a_changed_certificate_is_noticed(run):
    run(f"{PADDLE} -o .")
    certificate = Path("law.certificate.json")
    named = sha256(certificate.read_bytes()).hexdigest()
    assert f'LAW_CERTIFICATE_SHA256 "{named}"' in Path("law.h").read_text(encoding="utf-8")
    run(f"verify {certificate}")
    text = certificate.read_text(encoding="utf-8")
    certificate.write_text(text.replace("150", "950"), encoding="utf-8")
    assert certificate.read_text(encoding="utf-8") != text
    run(f"verify {certificate}", 1)


def test_an_interval_that_a_loop_cannot_run_with_is_told_with_its_unit(refused):
    """Mass, damping, Coulomb friction and delay may stay intervals; the encoder of a board is one."""
    given = "--damping 0.15 --coulomb-friction 0.1 --rate '1 kHz' --resolution '12 .. 13 um' --stiffness 100"
    assert "resolution is the interval 12 … 13 µm" in refused(f"emit {given} --travel '-60 .. 60 mm' -o wall")
