"""Every command line that the help, a list or a report prints can be typed as it stands."""

from __future__ import annotations

import re
import shlex
from collections.abc import Iterator
from math import exp
from pathlib import Path

import pytest

import zwidth as zw
from zwidth.cli import main as command_line
from zwidth.cli.commands import COMMANDS
from zwidth.cli.main import WELCOME
from zwidth.cli.start.examples import copy_to
from zwidth.cli.start.tour import STEPS, THEN
from zwidth.model.samples import EXAMPLES

BAD_INPUT = 2

COPIES = {
    "my-wheel.toml": "wheel.toml",
    "my-bumpstop.toml": "bumpstop.toml",
    "shaking.toml": "wheel.toml",
    "wheel.csv": "shaking.csv",
    "my-pair.toml": "arms.toml",
    "my-arms.toml": "arms.toml",
    "my-knob.toml": "knob.toml",
    "my-paddle.toml": "paddle.toml",
    "my-device.toml": "paddle.toml",
    "my-arm.urdf": "arm.urdf",
}
"""Files that the help names as one's own, and the samples that are like them."""

SIMULATED = "simulate haptic-paddle --stiffness 300 --duration 0.1 --operator"
MADE = {
    "my-wall.toml": "new environment my-wall.toml --device wheel.toml --type wall --stiffness '20 N*m/rad' "
    "--no-questions",
    "finger.nc": f"{SIMULATED} finger -o finger.nc",
    "dowel.nc": f"{SIMULATED} dowel -o dowel.nc",
    "session.mcap": "serve haptic-paddle --stiffness 250 --duration 0.3 -o session.mcap",
}
"""Files that a command makes."""

WALL = '[environment]\ntype = "wall"\nstiffness = '
HANDS = '\n[operator]\ntype = "hands-on"\n[simulation]\nduration = "0.2 s"\n'
JOINT = "{command_interfaces: [effort], joints: [elbow], gains: {elbow: {p: 120.0, i: 0.0, d: 0.2}}}"
PRESSED = [f"{k / 100},{0.5 * (k > 20)},{(k > 20) * (3100 - 1500 * exp(0.25 - k / 80))}" for k in range(400)]
TEXTS = {
    "my-touch.toml": f'{WALL}"20 N*m/rad"{HANDS}',
    "my-laws.toml": f"{WALL}500\n",
    "my-arm.toml": "[arm]\ndamping = 0.5\ncoulomb_friction = 0.1\n",
    "yam.yml": 'motor_list: [[1, "DM4340"], [2, "DM4310"]]\nkp: [80, 10]\nkd: [5, 1.5]\n',
    "so101.json": '{"robot": {"type": "so101_follower", "position_p_coefficient": 32}}',
    "controllers.yaml": "controller_manager: {ros__parameters: {update_rate: 500}}\n"
    f"arm: {{ros__parameters: {JOINT}}}\n",
    "impedance.yaml": "a: {ros__parameters: {update_frequency: 500.0, stiffness: {nullspace_stiffness: 10.0, "
    "translation: {x: 200.0, y: 300.0, z: 400.0}, rotation: {x: 20.0, y: 30.0, z: 40.0}}}}\n",
    "creep.csv": "\n".join(["time_s,force_N,z", *PRESSED]),
}
"""Files of which there is no sample."""

CHANGED = {
    **{own: (sample, {}) for own, sample in COPIES.items()},
    "swing.csv": ("session.csv", {r",[^,\n]*$": ""}),
    "counts.csv": ("session.csv", {"position_mm": "enc", r"(\d)\.(\d\d),(?=[^,]*$)": r"\1\2,"}),
    "log.csv": ("shaking.csv", {"angle_deg,.*": "position_mm,cmd,motor_force_N"}),
}
"""A sample, and what to replace in it."""

HARMLESS = {
    "new device$": "--motion linear --damping 0.2 --rate '2 kHz' --no-questions",
    "new environment --device": "--type wall --stiffness 100 --no-questions",
    "play": "--no-browser",
    "doctor$": "--duration 1",
    "serve haptic-paddle": "--duration 0.2",
}
"""How a line begins that asks, opens a browser or takes its time, and what keeps it from that."""

PARSED = {
    "workspace ARM.urdf": "no such file; run in tests/cli/test_gains_command.py",
    "explore": "it serves a page until it is ended; run in tests/explorer",
    "serve my-": "it asks for a device at a port; run in tests/servo",
    "network room.toml --duration": "it runs for 10 s; run in tests/cli/test_network_command.py",
    "network room.toml --run": "it serves until it is ended; run in tests/cli/test_network_command.py",
    "doctor haptic-paddle": "it measures for 10 s; run in tests/cli/test_doctor_command.py",
    "map .*--cells 1000x1000": "a million walls; run in tests/maps",
    "(map|sweep) .*tcp://": "it asks a cluster; run in tests/maps and tests/sweeps",
}
"""How a line begins that is read and not run, and why."""

WRITES = {"-o", "--save", "--plot", "--sound", "--certify"}


def lines_of(text: str) -> list[str]:
    """The command lines of a text, each set in on its own line; what it means may stand behind two blanks."""
    text = re.sub(r"\\\n +", "", text)
    found = re.findall(r"^ {2,}(?:\$ )?zwidth (\w+\b(?:(?! {2,}).)*)", text, re.M)
    return [call for line in found for call in line.split(" && zwidth ")]


def in_the_help() -> Iterator[str]:
    told = [own.epilog for own in COMMANDS.values()] + [WELCOME, THEN]
    told += [f"  {step.command}" for step in (*STEPS, *EXAMPLES)]
    told += [f"  {line}" for line in re.findall(r"zwidth completion \w+", COMMANDS["completion"].epilog)]
    for text in told:
        yield from lines_of(text)


HELP = tuple(dict.fromkeys(in_the_help()))


def begun(line: str, table: dict[str, str]) -> str:
    return next((said for begins, said in table.items() if re.match(begins, line)), "")


def put(name: str) -> None:
    """A file of this name, where it is one that somebody would have."""
    if name in CHANGED:
        sample, changes = CHANGED[name]
        text = zw.samples.path(sample).read_text(encoding="utf-8")
        for old, new in changes.items():
            text = re.sub(old, new, text, flags=re.M)
        Path(name).write_text(text, encoding="utf-8")
    elif name in TEXTS:
        Path(name).write_text(TEXTS[name], encoding="utf-8")
    elif name in MADE:
        assert command_line.main(shlex.split(MADE[name])) == 0


@pytest.fixture
def typed(tmp_path, monkeypatch, capsys):
    """Types a line beside the files that it reads: anything but bad input may come of it; what it prints."""
    monkeypatch.chdir(tmp_path)
    monkeypatch.setenv("COLUMNS", "300")

    def typing(line: str) -> str:
        words = shlex.split(f"{line} {begun(line, HARMLESS)}")
        if words[0] != "examples" and not Path("wheel.toml").exists():
            copy_to(Path(), force=False)
        for before, word in zip(words, words[1:], strict=False):
            if words[0] != "new" and before not in WRITES and not Path(word).exists():
                put(word)
        capsys.readouterr()
        with monkeypatch.context() as patch:
            if begun(line, PARSED):
                patch.setattr(command_line, "run", lambda *_: 0)
            status = command_line.main(words)
        out, err = capsys.readouterr()
        assert status != BAD_INPUT, f"zwidth {line}: {err}"
        return out + err

    return typing


@pytest.mark.parametrize("line", HELP, ids=[line[:90] for line in HELP])
def test_a_line_of_the_help_runs(line, typed):
    typed(line)


ASKED = (
    "examples .",
    "new device mine.toml --motion linear --damping unknown --rate unknown --no-questions",
    "new device mine.toml --motion linear --damping 0.2 --rate '2 kHz' --no-questions",
    "new device mine.toml --motion rotary --damping unknown --rate '2 kHz' --no-questions",
    "new environment mine.toml --device wheel.toml --type wall --stiffness '2 N*m/rad' --no-questions",
    "new environment mine.toml --type wall --stiffness 100 --motion linear --no-questions",
    "diagnose shaking.csv wheel.toml",
    "diagnose shaking.csv wheel.toml -o mended.toml",
    "diagnose shaking.csv wheel.toml bumpstop.toml",
    "gains impedance.yaml",
)
"""Lines whose reports end with what to type next."""


@pytest.mark.parametrize("asked", ASKED)
def test_what_a_report_says_to_type_next_runs(asked, typed):
    """As it stands there, beside the files that were asked about."""
    lines = lines_of(typed(asked))
    assert lines
    for line in lines:
        typed(line)


def test_nothing_is_kept_from_running_in_vain():
    """Every exception is one for some line of the help or of a report."""
    lines = (*HELP, "workspace ARM.urdf", "new environment --device")
    for begins in (*HARMLESS, *PARSED):
        assert any(re.match(begins, line) for line in lines), begins
