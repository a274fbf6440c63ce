"""The command: its exit statuses, its faces, and one clear line on bad input."""

import json
import shlex
import subprocess
import sys
from pathlib import Path

import pytest
from matplotlib.figure import Figure

import zwidth as zw
from zwidth.cli.decision import decided
from zwidth.cli.options import device_parameters, environment_parameters
from zwidth.cli.page import bar, levels
from zwidth.cli.parsing import joined
from zwidth.model.device import catalogue
from zwidth.model.specification.read import Specification
from zwidth.passivity.check import check_by_closed_forms

PASSIVE = "check haptic-paddle --stiffness 300"
ACTIVE = "check haptic-paddle --stiffness 770"
UNDECIDED = "check haptic-paddle --stiffness '100 .. 900'"


def process(line, **environment):
    """Runs a command line in a process of its own."""
    command = [sys.executable, "-m", "zwidth", *shlex.split(line)]
    env = {"PATH": "/usr/bin:/bin", **environment}
    return subprocess.run(command, capture_output=True, env=env, timeout=600, check=False)


# --- check ------------------------------------------------------------------


@pytest.mark.parametrize(
    ("line", "status", "begins"),
    [
        (PASSIVE, 0, " PASSIVE "),
        (ACTIVE, 1, " ACTIVE "),
        (UNDECIDED, 3, " UNDECIDED "),
        ("devices", 0, ""),
        ("devices phantom", 0, "phantom"),
    ],
)
def test_report_fits_80_columns_without_colour_when_piped(run, line, status, begins):
    """Its outcome first, which the status says too."""
    result = run(line, status)
    assert result.err == ""
    assert result.out.startswith(begins)
    lines = result.out.split("\n")
    assert max(map(len, lines)) <= 80
    assert all(line == line.rstrip() for line in lines)
    assert "\x1b" not in result.out


def test_report_of_the_paddle_at_its_limit(run):
    out = run(f"{PASSIVE} --all").out
    for part in ("equality included", "haptic-paddle: b = 0.15 N·s/m", "K = 300 N/m", "500 Hz"):
        assert part in out
    assert "sampling against viscous" in out
    assert "exactly at the limit: stiffness" in out


def test_report_of_an_active_paddle(run):
    out = run(f"{ACTIVE} --all", 1).out
    assert "takes 1.427 mJ out" in out
    assert "2 samples in 2 ms" in out
    change, useless = "lower the stiffness from 770 N/m to 300 N/m", "none found that would do alone"
    assert out.index(change) < out.index(useless)


def test_report_of_an_interval_says_so(run):
    assert "every value within" in run("check haptic-paddle --stiffness '100 .. 200'").out


def test_json_has_units_in_its_keys(run):
    document = run(f"{ACTIVE} --json", 1).json
    assert document["outcome"] == "active"
    assert document["max_stiffness_N_per_m"] == 300
    assert document["required_damping_N_s_per_m"] == 0.385
    assert set(document["margins"]) == {"damping_N_s_per_m", "coulomb_friction_N"}
    assert {"parameter", "from", "to", "unit"} <= set(document["advice"][0])
    assert document["witness"]["positions_m"][0] == 0
    assert document["witness"]["energy_J"] > 0


def test_negative_values_are_values(run):
    run(f"{ACTIVE} --virtual-damping -1e-3 --json", 1)
    assert joined(["check", "--a", "-1", "-o", "-1", "--b=2", "-3", "--", "-4"]) == [
        "check", "--a=-1", "-o", "-1", "--b=2", "-3", "--", "-4",
    ]  # fmt: skip


def test_two_files(run):
    Path("wheel.toml").write_text(
        '[device]\ninertia = 0.05\ndamping = 0.2\nrate = "1 kHz"\n', encoding="utf-8"
    )
    Path("stop.toml").write_text('[environment]\ntype = "wall"\nstiffness = 400\n', encoding="utf-8")
    assert "wheel: b = 0.2 N·m·s/rad" in run("check wheel.toml stop.toml").out
    run("check wheel.toml stop.toml --stiffness 500", 1)


def test_a_name_is_text_and_never_markup(run):
    run(f"{PASSIVE} --name '[red]:smile:[/red] \x1b[31m'").says("[red]:smile:[/red] ?[31m")


def test_a_long_delay_is_taken_with_its_unit(run):
    assert "without a unit" not in run(f"{PASSIVE} --delay '3 s'", None).err
    assert run(f"{PASSIVE} --delay 0.003", None).status != 2


# --- files ------------------------------------------------------------------


@pytest.mark.parametrize(("line", "status"), [(PASSIVE, 0), (ACTIVE, 1)])
def test_a_saved_verdict_is_verified(run, line, status):
    run(f"{line} -o verdict.json", status)
    out = run("verify verdict.json").out
    assert " VALID " in out
    assert ("mJ" in out) == bool(status)


def test_an_existing_file_is_not_lost(run, refused):
    path = Path("verdict.json")
    path.write_text("mine", encoding="utf-8")
    assert "exists" in refused(f"{PASSIVE} --save verdict.json")
    assert path.read_text(encoding="utf-8") == "mine"
    run(f"{PASSIVE} --save verdict.json --force")
    assert json.loads(path.read_text(encoding="utf-8"))["outcome"] == "passive"


def test_a_forged_proof_is_not_valid(run):
    run(f"{PASSIVE} -o verdict.json")
    path = Path("verdict.json")
    path.write_text(path.read_text(encoding="utf-8").replace('"300"', '"301"'), encoding="utf-8")
    assert "NOT VALID" in run("verify verdict.json", 1).out


@pytest.mark.parametrize("kind", ["spring", "coarse storage", "corners"])
def test_the_schema_of_a_kind_is_printed(run, kind):
    assert run(f"verify --schema '{kind}'").json["title"] == kind


@pytest.mark.parametrize(
    "content", ["", "{", "[]", "3", "{}", '{"outcome": "passive"}', "\x00", "[" * 100_000]
)
def test_what_cannot_be_read_is_bad_input(refused, content):
    Path("broken.json").write_text(content, encoding="utf-8")
    refused("verify broken.json")


def test_plot_gets_the_verdict(run, monkeypatch):
    calls = []
    monkeypatch.setattr("zwidth.show.plots.check_figure", lambda verdict: calls.append(verdict) or Figure())
    run(f"{PASSIVE} --plot loop.SVG")
    assert [verdict.outcome for verdict in calls] == ["passive"]
    assert Path("loop.SVG").read_bytes().startswith(b"<?xml")


def test_every_command_says_what_it_wrote_in_one_way(run):
    """`written: FILE`, a line each; nothing of it in JSON."""
    touch = "simulate haptic-paddle --stiffness 300 --operator dowel --duration 0.02"
    cells = "map haptic-paddle --stiffness 0:9 --virtual-damping 0:1 --cells 2x2"
    for line, files in (
        (f"{PASSIVE} -o a.json --plot a.svg", ["a.json", "a.svg"]),
        (f"{touch} -o t.csv", ["t.csv"]),
        ("traces t.csv --plot t.svg", ["t.svg"]),
        (f"{cells} --plot m.svg", ["m.svg"]),
    ):
        told = [line for line in run(line).out.splitlines() if "written" in line]
        assert told == [f"written: {name}" for name in files]
    assert "written" not in run(f"{PASSIVE} -o b.json --json").out


# --- devices, help ------------------------------------------------------------


def test_devices_lists_every_device_and_source(run):
    out = run("devices").words
    for name in catalogue.names():
        assert name in out
        assert all(d.source[:20] in out for d in catalogue.entry(name).values.values() if d.value is not None)
    unknown = sum(d.value is None for d in catalogue.entry("phantom").values.values())
    assert run("devices phantom").out.count("unknown") == unknown


def test_devices_as_json(run):
    document = run("devices --json").json
    assert tuple(document) == catalogue.names()
    assert document["haptic-paddle"]["values"]["damping_N_s_per_m"]["value"] == 0.15
    assert document["phantom"]["values"]["mass_kg"]["value"] is None


def test_help_names_every_parameter_with_its_unit(run):
    out = run("check --help all").words
    for parameter in (*device_parameters(), *environment_parameters()):
        assert f"{parameter.option} {parameter.metavar} {parameter.help}" in out
    for line in ("--help", "devices --help", "verify -h"):
        run(line)
    assert run("--version").out.startswith("zwidth 0.")


# --- the process --------------------------------------------------------------


@pytest.mark.parametrize("line", [PASSIVE, ACTIVE, f"{ACTIVE} --json", "devices", "check --help"])
def test_ascii_terminal(line):
    result = process(line, PYTHONIOENCODING="ascii", LC_ALL="C")
    assert result.stderr == b""
    assert result.stdout.isascii()
    assert b"?" not in result.stdout.replace(b"passive?", b"")
    if "--json" in line:
        assert "N·s/m" in json.loads(result.stdout)["assumptions"][1]


def test_colour_only_where_it_is_wanted():
    assert b"\x1b[" in process(PASSIVE, FORCE_COLOR="1", TERM="xterm").stdout
    assert b"\x1b[" not in process(PASSIVE, TERM="xterm").stdout


def test_reader_that_leaves():
    writer = subprocess.Popen(
        [sys.executable, "-m", "zwidth", *shlex.split(ACTIVE)], stdout=subprocess.PIPE, stderr=subprocess.PIPE
    )
    writer.stdout.close()
    assert writer.wait(600) == 1
    assert writer.stderr.read() == b""
    writer.stderr.close()


def test_interrupt(run, monkeypatch):
    def interrupted(*_):
        raise KeyboardInterrupt

    monkeypatch.setattr("zwidth.model.specification.read.read_tables", interrupted)
    run(PASSIVE, 130)


@pytest.mark.parametrize("module", ["zwidth.cli.main", "zwidth.cli.options", "zwidth.machine.servo.serving"])
def test_ctrl_c_during_an_import_ends_quietly(module):
    """Status 130 and one line, whichever import it comes in: of the face itself or of a command."""
    code = f"""
import runpy, sys

class Interrupts:
    @staticmethod
    def find_spec(name, path=None, target=None):
        if name == "{module}":
            raise KeyboardInterrupt

sys.meta_path.insert(0, Interrupts)
sys.argv = ["zwidth", "serve", "haptic-paddle", "--stiffness", "250"]
runpy.run_module("zwidth", run_name="__main__")
"""
    ended = subprocess.run([sys.executable, "-c", code], capture_output=True, text=True, check=False)
    assert (ended.returncode, ended.stderr) == (130, "zwidth: interrupted\n")


TOUCH = "simulate haptic-paddle --stiffness 9 --duration 0.1 --operator"
SLOW_TO_LOAD = "matplotlib xarray pandas"
PROOFS = "zwidth.passivity zwidth.checker"
ABSENT = {
    "import zwidth": "numpy scipy matplotlib rich control argparse tomllib",
    # the proof is exact arithmetic: no float array takes part in it
    "import zwidth as zw; zw.check(zw.Device(damping=0.15, rate=1000), zw.Wall(stiffness=300)).to_dict()": (
        "numpy scipy matplotlib rich"
    ),
    "import zwidth; zwidth.simulate, zwidth.traces.load_trace": (
        "scipy.stats matplotlib zwidth.data.identification zwidth.study.bench.bench"
    ),
    "check haptic-paddle --stiffness 300": "numpy scipy matplotlib zwidth.plots",
    "check phantom --stiffness 300 --json": "numpy scipy matplotlib rich",
    "emit --help": "numpy scipy",
    f"{TOUCH} dowel": f"scipy {PROOFS} {SLOW_TO_LOAD}",
    f"{TOUCH} finger --virtual-damping 0.01 --json": f"scipy rich {PROOFS} {SLOW_TO_LOAD}",
    "plan haptic-paddle --force-noise '0.1 N'": f"scipy.stats scipy.optimize {SLOW_TO_LOAD}",
    "gains leader.yaml follower.yaml": "scipy matplotlib xarray",
    "identify session.csv": f"scipy.stats scipy.optimize {SLOW_TO_LOAD}",
    "tissue relaxation.csv phantom": f"scipy.stats scipy.signal {SLOW_TO_LOAD}",
    "diagnose shaking.csv wheel.toml": f"scipy {SLOW_TO_LOAD}",
}
"""By what is run, the modules that are not loaded for it."""


@pytest.mark.parametrize("line", ABSENT)
def test_nothing_is_imported_before_it_is_needed(line):
    code = line if "import" in line else f"from zwidth.cli.main import main; main({shlex.split(line)})"
    absent = f"[m for m in {ABSENT[line].split()} if m in sys.modules]"
    program = f"import sys\n{code}\nsys.exit(str({absent}) if {absent} else 0)"
    samples = zw.samples.path("wheel.toml").parent
    result = subprocess.run([sys.executable, "-c", program], cwd=samples, capture_output=True, timeout=600)
    assert result.returncode == 0, result.stderr


# --- pieces -------------------------------------------------------------------


def test_bars_fill_their_share():
    assert bar(0, 1, 1, 10, fancy=True) == "█" * 10
    assert bar(0.5, 1, 1, 10, fancy=False) == "     #####"
    assert bar(0, 0.0001, 1, 10, fancy=True) == "▏"
    assert bar(0, 0, 1, 10, fancy=True) == bar(0, 0, 0, 10, fancy=True) == ""
    assert bar(0, float("inf"), 1, 3, fancy=False) == "###"
    assert levels([0, 1, 0.5], fancy=True) == "▁█▅"
    assert levels([2, 2], fancy=False) == "__"


def test_the_closed_forms_are_worked_out_once(monkeypatch):
    """Before the game is played, its verdict is what they said, and not one worked out anew."""
    asked = []

    def counted(device, law, contact):
        asked.append(contact)
        return check_by_closed_forms(device, law, contact=contact)

    monkeypatch.setattr(sys.modules["zwidth.passivity.check"], "check_by_closed_forms", counted)
    monkeypatch.setattr(
        "zwidth.passivity.value_iteration_fallback.with_value_iteration",
        lambda device, law, verdict, progress: verdict,
    )
    law = zw.Wall(stiffness=120, damping="0.2", velocity_filter=zw.rendering.Window(3))
    assert decided(Specification(catalogue.device("haptic-paddle"), law)).outcome == "passive in contact"
    assert asked == ["made and broken"]
