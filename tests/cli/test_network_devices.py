"""`zwidth network` with a real device at a line: an emulated board, in processes joined by real sockets."""

import json
import math
import re
import signal
import subprocess
import sys
from pathlib import Path

import pytest
from free_channels import udp, zenoh
from servo.emulators.faults import Fault
from servo.emulators.hapkit import HapkitEmulator

from zwidth.cli.machine.network_plan import load_plan
from zwidth.machine.servo.port_run import PortRun
from zwidth.quantity.exact import Exact

SCENE = """
[environment]
type = "scene"
port = ""
elements = [
  { type = "line-end", node = "tool", impedance = "0.5 N*s/m", name = "paddle" },
  { type = "mass", node = "tool", mass = "50 g" },
  { type = "spring", first = "tool", second = "ground", stiffness = "40 N/m" },
]
"""

NETWORK = """
[network]
sample_period = "8 ms"

[[network.part]]
name = "room"

[[network.device]]
name = "paddle"
source = "real.toml"
CONNECTION
"""

REAL = """
[device]
damping = "0.5 N*s/m"
coulomb_friction = "0.1 N"
resolution = "20 um"
sample_period = "8 ms"
force_limit = "3 N"
force_resolution = "1 mN"
"""

KIT = 'connection = { type = "hapkit", port = "PORT", count = "20 um" }\n'
SLOW = 'safety = { force = "1.5 N", bad_answers = 200, longest_gap = "30 s" }\n'
"""This machine may be busy."""


@pytest.fixture(autouse=True)
def here(tmp_path, monkeypatch):
    """A file of a network names that of its device from where it is run."""
    monkeypatch.chdir(tmp_path)


def write(connection, port="/dev/null", channel=""):
    """The file of a network, with its device beside it."""
    Path("real.toml").write_text(REAL, encoding="utf-8")
    line = f'\n[[network.line]]\nname = "paddle"\nchannel = "{channel}"\n' if channel else ""
    text = SCENE + NETWORK.replace("CONNECTION", connection.replace("PORT", port)) + line
    Path("room.toml").write_text(text, encoding="utf-8")


def process(name):
    command = [
        sys.executable,
        *["-m", "zwidth", "network", "room.toml", "--json", "--duration", "3s", "--run"],
        name,
    ]
    return subprocess.Popen(command, stdout=subprocess.PIPE, stderr=subprocess.PIPE, encoding="utf-8")


def plan():
    return load_plan(Path("room.toml").absolute()).runs("paddle", Exact(1))


@pytest.mark.real_time
@pytest.mark.parametrize("channel", [udp, zenoh])
def test_a_board_feels_the_scene_and_no_force_once_the_scene_is_killed(channel):
    """Its handle goes to and fro by 4 mm; no side hears of more energy than the other sent."""
    with HapkitEmulator(lambda exchange: round(200 * math.sin(0.05 * exchange))) as board:
        write(KIT + SLOW, board.port, channel())
        children = {name: process(name) for name in ("room", "paddle")}
        seen = []
        for text in children["paddle"].stderr:
            seen.append(text)
            if "at 1 s" in text:
                break
        felt = len(board.commands)
        children["room"].send_signal(signal.SIGKILL)
        children["room"].communicate()
        told = json.loads(children["paddle"].communicate()[0])["processes"]["paddle"]
    assert children["paddle"].returncode == 0
    about = next(text for text in seen if "Hapkit at" in text)
    assert "if nothing comes any more: sets its force to 0" in about
    forces = [command.force for command in board.commands]
    assert max(map(abs, forces[:felt])) > 0.01
    assert max(map(abs, forces)) <= 1.5
    assert not any(forces[-20:])
    link = told["links"]["paddle"]
    assert link["received"] > 10
    assert link["silent_s"] > 0.2
    assert link["last_force_N"] == 0
    assert told["device"]["ended"] == "ended, since the time was over"
    assert told["device"]["samples"] <= told["steps"]


@pytest.mark.real_time
def test_a_board_that_fails_ends_its_process_with_force_0_and_status_1(run, monkeypatch):
    """Two bad answers in a row; nobody is at the other end, and nothing was felt."""
    monkeypatch.setattr("zwidth.cli.machine.network._MEETING", 0.0)
    with HapkitEmulator(lambda exchange: exchange, Fault.GARBAGE, at=20) as board:
        write(KIT + 'safety = { longest_gap = "30 s" }\n', board.port, udp())
        told = run("network room.toml --run paddle --duration 30s --json", 1).json["processes"]["paddle"]
    assert "no whole frame" in told["device"]["ended"] or "no answer in time" in told["device"]["ended"]
    assert told["steps"] < 3000
    assert board.commands[-1].force == 0.0


def test_a_plan_says_how_a_device_is_reached_and_reaches_none(run, refused, monkeypatch):
    """No such port is there; the delay that was not given is the shortest that a port can have."""
    monkeypatch.setattr("zwidth.cli.machine.network._MEETING", 0.0)
    write(KIT + SLOW, "/dev/no-such-port", udp())
    assert "paddle: real, Hapkit at /dev/no-such-port" in run("network room.toml --plan").out
    port_run = plan()
    assert isinstance(port_run, PortRun)
    assert port_run.port.device.exact("delay") == port_run.port.device.exact("sample_period")
    assert port_run.port.device.force_limit == 1.5
    assert "/dev/no-such-port" in run("network room.toml --run paddle", 2).err


def test_a_place_and_a_longest_period_stand_with_the_connection():
    kit = KIT.replace("count", 'origin = "1 mm", sense = -1, longest_period = "9 ms", count')
    write(kit)
    port_run = plan()
    assert isinstance(port_run, PortRun)
    assert (port_run.placement.origin, port_run.placement.sense) == (1e-3, -1)
    assert port_run.port.device.sample_period == 9e-3


@pytest.mark.parametrize(
    ("more", "said"),
    [
        (KIT + 'operator = { type = "finger" }', "leave out one of the two"),
        ('safety = { force = "2 N" }', "this one has no connection"),
        ('connection = "hapkit"', "connection is a table, such as"),
        (KIT + 'safety = "2 N"', "safety is a table, such as"),
        (KIT.replace("count", "counts"), "counts"),
        (KIT.replace('type = "hapkit"', 'type = "hapkid"'), 'did you mean "hapkit"'),
        (KIT + 'safety = { forces = "2 N" }', "forces"),
        (KIT + 'safety = { slew = "2 N/s" }', "leave out slew"),
        (KIT.replace("count", 'longest_period = "7 ms", count'), "longest_period must be ≥ 8 ms"),
    ],
)
def test_what_is_no_real_device_is_refused_in_one_line(refused, more, said):
    """Before anything is reached."""
    write(more)
    assert re.search(said, refused("network room.toml --run paddle"))
