"""The command: its exit statuses, its faces, and one clear line on bad input."""

from __future__ import annotations

import json
import subprocess
import sys
from collections.abc import Callable
from pathlib import Path
from typing import NamedTuple

import pytest
from matplotlib.figure import Figure

import zwidth as zw
from zwidth.cli.decision import decided
from zwidth.cli.main import main
from zwidth.cli.options import device_parameters, environment_parameters
from zwidth.cli.page import bar, levels
from zwidth.cli.parsing import joined
from zwidth.model.device import catalogue
from zwidth.model.specification.read import Specification
from zwidth.passivity.check import check_by_closed_forms
from zwidth.passivity.verdict import Verdict

PASSIVE = ("check", "haptic-paddle", "--stiffness", "300")
ACTIVE = ("check", "haptic-paddle", "--stiffness", "770")
UNDECIDED = ("check", "haptic-paddle", "--stiffness", "100 .. 900")


class Result(NamedTuple):
    """What one command line left behind."""

    status: int
    out: str
    err: str


Run = Callable[..., Result]


@pytest.fixture
def run(capsys: pytest.CaptureFixture[str]) -> Run:
    """Runs a command line in this process."""

    def runner(*argv: str) -> Result:
        status = main(argv)
        return Result(status, *capsys.readouterr())

    return runner


def process(*argv: str, **environment: str) -> subprocess.CompletedProcess[bytes]:
    """Runs a command line in a process of its own."""
    return subprocess.run(
        [sys.executable, "-m", "zwidth", *argv],
        capture_output=True,
        env={"PATH": "/usr/bin:/bin", **environment},
        timeout=600,
        check=False,
    )


def complaint(result: Result) -> str:
    """The one line that bad input must end in."""
    assert result.status == 2
    assert result.out == ""
    assert result.err.startswith("zwidth: ")
    assert result.err.count("\n") == 1
    return result.err


# --- check ------------------------------------------------------------------


@pytest.mark.parametrize(
    ("argv", "status", "word"), [(PASSIVE, 0, "PASSIVE"), (ACTIVE, 1, "ACTIVE"), (UNDECIDED, 3, "UNDECIDED")]
)
def test_status_and_report_say_the_outcome(run: Run, argv: tuple[str, ...], status: int, word: str) -> None:
    result = run(*argv)
    assert result.status == status
    assert result.err == ""
    assert result.out.startswith(f" {word} ")


@pytest.mark.parametrize("argv", [PASSIVE, ACTIVE, UNDECIDED, ("devices",), ("devices", "phantom")])
def test_report_fits_80_columns_without_colour_when_piped(
    run: Run, argv: tuple[str, ...], monkeypatch: pytest.MonkeyPatch
) -> None:
    monkeypatch.setenv("COLUMNS", "80")
    lines = run(*argv).out.split("\n")
    assert max(map(len, lines)) <= 80
    assert all(line == line.rstrip() for line in lines)
    assert "\x1b" not in "".join(lines)


def test_report_of_the_paddle_at_its_limit(run: Run) -> None:
    out = run(*PASSIVE, "--all").out
    for part in (
        "equality included",
        "haptic-paddle: b = 0.15 N·s/m",
        "K = 300 N/m",
        "sampling against viscous",
        "500 Hz",
    ):
        assert part in out
    assert "exactly at the limit: stiffness" in out


def test_report_of_an_active_paddle(run: Run) -> None:
    out = run(*ACTIVE, "--all").out
    assert "takes 1.427 mJ out" in out
    assert "2 samples in 2 ms" in out
    change, useless = "lower the stiffness from 770 N/m to 300 N/m", "no change found that would do alone"
    assert out.index(change) < out.index(useless)


def test_report_of_an_interval_says_so(run: Run) -> None:
    assert "every value within" in run("check", "haptic-paddle", "--stiffness", "100 .. 200").out


def test_json_has_units_in_its_keys(run: Run) -> None:
    document = json.loads(run(*ACTIVE, "--json").out)
    assert document["outcome"] == "active"
    assert document["max_stiffness_N_per_m"] == 300
    assert document["required_damping_N_s_per_m"] == 0.385
    assert set(document["margins"]) == {"damping_N_s_per_m", "coulomb_friction_N"}
    assert {"parameter", "from", "to", "unit"} <= set(document["advice"][0])
    assert document["witness"]["positions_m"][0] == 0
    assert document["witness"]["energy_J"] > 0


def test_negative_values_are_values(run: Run) -> None:
    result = run(*ACTIVE, "--virtual-damping", "-1e-3", "--json")
    assert result.status == 1
    assert "stiffness must be ≥ 0" in complaint(run("check", "haptic-paddle", "--stiffness", "-0.1 N/m"))


def test_joined_leaves_everything_else_alone() -> None:
    assert joined(["check", "--a", "-1", "-o", "-1", "--b=2", "-3", "--", "-4"]) == [
        "check", "--a=-1", "-o", "-1", "--b=2", "-3", "--", "-4",
    ]  # fmt: skip


def test_two_files(run: Run, tmp_path: Path) -> None:
    wheel, stop = tmp_path / "wheel.toml", tmp_path / "stop.toml"
    wheel.write_text('[device]\ninertia = 0.05\ndamping = 0.2\nrate = "1 kHz"\n')
    stop.write_text('[environment]\ntype = "wall"\nstiffness = 400\n')
    result = run("check", str(wheel), str(stop))
    assert result.status == 0
    assert "wheel: b = 0.2 N·m·s/rad" in result.out
    assert run("check", str(wheel), str(stop), "--stiffness", "500").status == 1


def test_a_name_is_text_and_never_markup(run: Run) -> None:
    result = run(*PASSIVE, "--name", "[red]:smile:[/red] \x1b[31m")
    assert "[red]:smile:[/red] ?[31m" in result.out


@pytest.mark.parametrize(
    ("argv", "parts"),
    [
        (("chek",), ("no command", "check")),
        (("check", "haptic-paddle", "--stifness", "3"), ("--stifness", "did you mean --stiffness")),
        (("check", "haptic-paddle", "--coulomb_friction=3"), ("did you mean --coulomb-friction",)),
        (("check", "haptic-paddle", "--stiff", "3"), ("no option --stiff",)),
        ((*PASSIVE, "--stiffness", "400"), ("twice",)),
        (("check", "haptic-paddle", "--stiffness"), ("expected one argument",)),
        (("check", "haptic-padle", "--stiffness", "3"), ("haptic-paddle",)),
        (("check", "missing.toml"), ("no file",)),
        (("check", "haptic-paddle"), ("no environment",)),
        (("limit", "excalibur", "--stiffness", "3"), ("damping", "zwidth check excalibur answers")),
        (("check",), ("no device",)),
        ((*PASSIVE, "--rate", "1 kg"), ("rate is in Hz",)),
        ((*PASSIVE, "--environment.stiffness", "3"), ("behind a coupling",)),
        ((*PASSIVE, "--plot", "a.txt"), (".png",)),
        ((*PASSIVE, "--plot", "no/such/folder/a.png"), ("no directory",)),
        ((*PASSIVE, "-o", "."), ("directory",)),
        ((*PASSIVE, "-o", "a.svg", "--plot", "a.svg"), ("same file",)),
        ((*PASSIVE, "-o", "a.PNG"), ("--save", "the name of a picture", "give --plot")),
        ((*PASSIVE, "-o", "a\0b"), ("cannot be written",)),
        (("devices", "phanton"), ("phantom",)),
        (("devices", "phantom", "falcon"), ("too many",)),
        (("verify",), ("FILE",)),
        (("verify", "missing.json"), ("missing.json",)),
        (("verify", "--schema", "sprong"), ("no kind of document", 'did you mean "spring"?')),
        (("verify", "a.json", "--schema", "spring"), ("--schema", "no FILE")),
    ],
)
def test_bad_input_is_one_line(run: Run, argv: tuple[str, ...], parts: tuple[str, ...]) -> None:
    message = complaint(run(*argv))
    assert all(part in message for part in parts), message


# --- files ------------------------------------------------------------------


@pytest.mark.parametrize(("argv", "status"), [(PASSIVE, 0), (ACTIVE, 1)])
def test_a_saved_verdict_is_verified(run: Run, argv: tuple[str, ...], status: int, tmp_path: Path) -> None:
    path = tmp_path / "verdict.json"
    assert run(*argv, "-o", str(path)).status == status
    result = run("verify", str(path))
    assert result.status == 0
    assert " VALID " in result.out
    assert ("mJ" in result.out) == bool(status)


def test_an_existing_file_is_not_lost(run: Run, tmp_path: Path) -> None:
    path = tmp_path / "verdict.json"
    path.write_text("mine")
    assert "exists" in complaint(run(*PASSIVE, "--save", str(path)))
    assert path.read_text(encoding="utf-8") == "mine"
    assert run(*PASSIVE, "--save", str(path), "--force").status == 0
    assert json.loads(path.read_text(encoding="utf-8"))["outcome"] == "passive"


def test_a_forged_proof_is_not_valid(run: Run, tmp_path: Path) -> None:
    path = tmp_path / "verdict.json"
    run(*PASSIVE, "-o", str(path))
    path.write_text(path.read_text(encoding="utf-8").replace('"300"', '"301"'), encoding="utf-8")
    result = run("verify", str(path))
    assert result.status == 1
    assert "NOT VALID" in result.out


@pytest.mark.parametrize("kind", ["spring", "coarse storage", "corners"])
def test_the_schema_of_a_kind_is_printed(run: Run, kind: str) -> None:
    result = run("verify", "--schema", kind)
    assert result.status == 0
    assert json.loads(result.out)["title"] == kind


@pytest.mark.parametrize(
    "content", ["", "{", "[]", "3", "{}", '{"outcome": "passive"}', "\x00", "[" * 100_000]
)
def test_what_cannot_be_read_is_bad_input(run: Run, content: str, tmp_path: Path) -> None:
    path = tmp_path / "broken.json"
    path.write_text(content)
    complaint(run("verify", str(path)))


def test_plot_gets_the_verdict(run: Run, tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    calls: list[Verdict] = []
    monkeypatch.setattr("zwidth.show.plots.check_figure", lambda verdict: calls.append(verdict) or Figure())
    path = tmp_path / "loop.SVG"
    assert run(*PASSIVE, "--plot", str(path)).status == 0
    assert [verdict.outcome for verdict in calls] == ["passive"]
    assert path.read_bytes().startswith(b"<?xml")


# --- devices, help ------------------------------------------------------------


def test_devices_lists_every_device_and_source(run: Run) -> None:
    out = " ".join(run("devices").out.split())
    for name in catalogue.names():
        assert name in out
        assert all(d.source[:20] in out for d in catalogue.entry(name).values.values() if d.value is not None)


def test_one_device_has_a_row_for_each_value(run: Run) -> None:
    out = run("devices", "phantom").out
    assert out.count("unknown") == sum(d.value is None for d in catalogue.entry("phantom").values.values())


def test_devices_as_json(run: Run) -> None:
    document = json.loads(run("devices", "--json").out)
    assert tuple(document) == catalogue.names()
    assert document["haptic-paddle"]["values"]["damping_N_s_per_m"]["value"] == 0.15
    assert document["phantom"]["values"]["mass_kg"]["value"] is None


def test_help_names_every_parameter_with_its_unit(run: Run) -> None:
    out = " ".join(run("check", "--help").out.split())
    for parameter in (*device_parameters(), *environment_parameters()):
        assert f"{parameter.option} {parameter.metavar} {parameter.help}" in out
    for argv in (("--help",), ("devices", "--help"), ("verify", "-h")):
        assert run(*argv).status == 0


def test_version(run: Run) -> None:
    assert run("--version").out.startswith("zwidth 0.")


# --- the process --------------------------------------------------------------


@pytest.mark.parametrize("argv", [PASSIVE, ACTIVE, ("devices",), ("check", "--help")])
def test_ascii_terminal(argv: tuple[str, ...]) -> None:
    result = process(*argv, PYTHONIOENCODING="ascii", LC_ALL="C")
    assert result.stderr == b""
    assert result.stdout.isascii()
    assert b"?" not in result.stdout.replace(b"passive?", b"")


def test_json_on_an_ascii_terminal() -> None:
    result = process(*ACTIVE, "--json", PYTHONIOENCODING="ascii")
    assert result.stdout.isascii()
    assert "N·s/m" in json.loads(result.stdout)["assumptions"][1]


def test_colour_only_where_it_is_wanted() -> None:
    assert b"\x1b[" in process(*PASSIVE, FORCE_COLOR="1", TERM="xterm").stdout
    assert b"\x1b[" not in process(*PASSIVE, TERM="xterm").stdout


def test_reader_that_leaves() -> None:
    writer = subprocess.Popen(
        [sys.executable, "-m", "zwidth", *ACTIVE], stdout=subprocess.PIPE, stderr=subprocess.PIPE
    )
    assert writer.stdout is not None
    assert writer.stderr is not None
    writer.stdout.close()
    assert writer.wait(600) == 1
    assert writer.stderr.read() == b""
    writer.stderr.close()


def test_interrupt(run: Run, monkeypatch: pytest.MonkeyPatch) -> None:
    def interrupted(*_: object) -> None:
        raise KeyboardInterrupt

    monkeypatch.setattr("zwidth.model.specification.read.read_tables", interrupted)
    assert run(*PASSIVE).status == 130


FROM_SAMPLES = (
    "import os, zwidth.samples; from zwidth.cli.main import main; os.chdir(*zwidth.samples.__path__); "
)


@pytest.mark.parametrize(
    ("code", "absent"),
    [
        ("import zwidth", ("numpy", "scipy", "matplotlib", "rich", "argparse", "tomllib")),
        (
            "from zwidth.cli.main import main; main(['check', 'haptic-paddle', '--stiffness', '300'])",
            ("numpy", "scipy", "matplotlib", "zwidth.plots"),
        ),
        (
            "from zwidth.cli.main import main; main(['check', 'phantom', '--stiffness', '300', '--json'])",
            ("numpy", "scipy", "matplotlib", "rich"),
        ),
        (
            "from zwidth.cli.main import main; "
            "main(['simulate', 'haptic-paddle', '--stiffness', '9', '--operator', 'dowel', "
            "'--duration', '0.1'])",
            ("scipy", "matplotlib", "xarray", "pandas", "zwidth.passivity", "zwidth.checker"),
        ),
        (
            "from zwidth.cli.main import main; "
            "main(['simulate', 'haptic-paddle', '--stiffness', '9', '--virtual-damping', '0.01', "
            "'--operator', 'finger', '--duration', '0.1', '--json'])",
            ("scipy", "matplotlib", "xarray", "pandas", "zwidth.passivity", "zwidth.checker", "rich"),
        ),
        (
            "from zwidth.cli.main import main; main(['plan', 'haptic-paddle', '--force-noise', '0.1 N'])",
            ("scipy.stats", "scipy.optimize", "matplotlib", "xarray", "pandas"),
        ),
        (f"{FROM_SAMPLES}main(['gains', 'leader.yaml', 'follower.yaml'])", ("scipy", "matplotlib", "xarray")),
        (
            f"{FROM_SAMPLES}main(['identify', 'session.csv'])",
            ("scipy.stats", "scipy.optimize", "matplotlib", "xarray", "pandas"),
        ),
        (
            f"{FROM_SAMPLES}main(['tissue', 'relaxation.csv', 'phantom'])",
            ("scipy.stats", "scipy.signal", "matplotlib", "xarray", "pandas"),
        ),
        (
            f"{FROM_SAMPLES}main(['diagnose', 'shaking.csv', 'wheel.toml'])",
            ("scipy", "matplotlib", "xarray", "pandas"),
        ),
        (
            "import zwidth; zwidth.simulate, zwidth.traces.load_trace",
            ("scipy.stats", "matplotlib", "zwidth.data.identification", "zwidth.study.bench.bench"),
        ),
    ],
)
def test_nothing_is_imported_before_it_is_needed(code: str, absent: tuple[str, ...]) -> None:
    program = f"import sys\n{code}\nsys.exit(str([m for m in {absent} if m in sys.modules] or ''))"
    result = subprocess.run([sys.executable, "-c", program], capture_output=True, timeout=600, check=False)
    assert result.stderr.strip() == b""


# --- pieces -------------------------------------------------------------------


def test_bars_fill_their_share() -> None:
    assert bar(0, 1, 1, 10, fancy=True) == "█" * 10
    assert bar(0.5, 1, 1, 10, fancy=False) == "     #####"
    assert bar(0, 0.0001, 1, 10, fancy=True) == "▏"
    assert bar(0, 0, 1, 10, fancy=True) == bar(0, 0, 0, 10, fancy=True) == ""
    assert bar(0, float("inf"), 1, 3, fancy=False) == "###"


def test_levels_span_the_values() -> None:
    assert levels([0, 1, 0.5], fancy=True) == "▁█▅"
    assert levels([2, 2], fancy=False) == "__"


def test_every_command_says_what_it_wrote_in_one_way(
    run: Run, tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    """`written: FILE`, a line each; nothing of it in JSON."""
    monkeypatch.chdir(tmp_path)
    ranges = ("--stiffness", "0:9", "--virtual-damping", "0:1", "--cells", "2x2")
    touch = ("simulate", "haptic-paddle", "--stiffness", "300", "--operator", "dowel", "--duration", "0.02")
    cases = (
        ((*PASSIVE, "-o", "a.json", "--plot", "a.svg"), ("a.json", "a.svg")),
        ((*touch, "-o", "t.csv"), ("t.csv",)),
        (("traces", "t.csv", "--plot", "t.svg"), ("t.svg",)),
        (("map", "haptic-paddle", *ranges, "--plot", "m.svg"), ("m.svg",)),
    )
    for command, files in cases:
        assert [line for line in run(*command).out.splitlines() if "written" in line] == [
            f"written: {name}" for name in files
        ]
    assert "written" not in run(*PASSIVE, "-o", "b.json", "--json").out


def test_a_missing_number_is_named_as_its_option_is(run: Run) -> None:
    """--damping is the device's: what a Maxwell solid lacks is --virtual-damping."""
    lacking = run("check", "haptic-paddle", "--type", "maxwell", "--stiffness", "300")
    assert lacking.status == 2
    assert "needs --virtual-damping [N*s/m]" in lacking.err


def test_a_long_delay_without_a_unit_is_questioned(run: Run) -> None:
    """3 is three seconds; with its unit it is taken."""
    asked = run(*PASSIVE, "--delay", "3")
    assert asked.status == 2
    assert 'delay 3 without a unit is 3 s between sample and force; write "3 ms", or "3 s"' in asked.err
    assert "without a unit" not in run(*PASSIVE, "--delay", "3 s").err
    assert run(*PASSIVE, "--delay", "0.003").status != 2


def test_the_closed_forms_are_worked_out_once(monkeypatch: pytest.MonkeyPatch) -> None:
    """Before the game is played, its verdict is what they said, and not one worked out anew."""
    once, asked = check_by_closed_forms, list[str]()

    def counted(device: zw.Device, law: zw.Wall, contact: str) -> Verdict:
        asked.append(contact)
        return once(device, law, contact=contact)

    monkeypatch.setattr(sys.modules["zwidth.passivity.check"], "check_by_closed_forms", counted)
    monkeypatch.setattr(
        "zwidth.passivity.value_iteration_fallback.with_value_iteration",
        lambda device, law, verdict, progress: verdict,
    )
    device = catalogue.device("haptic-paddle")
    law = zw.Wall(stiffness=120, damping="0.2", velocity_filter=zw.rendering.Window(3))
    assert decided(Specification(device, law)).outcome == "passive in contact"
    assert asked == ["made and broken"]


@pytest.mark.parametrize("module", ["zwidth.cli.main", "zwidth.cli.options", "zwidth.machine.servo.serving"])
def test_ctrl_c_during_an_import_ends_quietly(module: str) -> None:
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
    assert ended.returncode == 130
    assert ended.stderr == "zwidth: interrupted\n"
