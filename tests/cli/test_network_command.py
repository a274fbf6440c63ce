"""`zwidth network`: what its file may say, and real processes over real sockets, one of them killed."""

import json
import math
import os
import re
import signal
import subprocess
import sys
from fractions import Fraction
from pathlib import Path
from unittest.mock import Mock

import pytest
from free_channels import free_ports

from zwidth.cli.machine.network import _Watch
from zwidth.cli.machine.network_plan import load_plan
from zwidth.cli.main import main
from zwidth.errors import InputError
from zwidth.machine.network import Peer, SharedMemory
from zwidth.machine.network.channel import Channel
from zwidth.quantity.exact import Exact

SCENE = """
[environment]
type = "scene"
port = ""
elements = [
  { type = "line-end", node = "tool", impedance = "0.15 N*s/m", name = "paddle" },
  { type = "mass", node = "tool", mass = "50 g" },
  { type = "spring", first = "tool", second = "bed", stiffness = "100 N/m" },
  { type = "mass", node = "bed", mass = "50 g" },
  { type = "damper", first = "bed", second = "ground", damping = "2 N*s/m" },
]
"""
SECOND_END = '  { type = "line-end", node = "bed", impedance = "0.15 N*s/m", name = "paddle" },\n]'

NETWORK = """
[network]
sample_period = "5 ms"

[[network.part]]
name = "near"
nodes = ["tool"]

[[network.part]]
name = "far"

[[network.device]]
name = "paddle"
source = "haptic-paddle"
"""


ROTARY = """
[device]
motion = "rotary"
inertia = "1e-4 kg*m^2"
damping = "1 mN*m*s/rad"
rate = "1 kHz"
"""


def line(name, first, second, more=""):
    return (
        f'\n[[network.line]]\nname = "{name}"\nchannel = "udp:127.0.0.1:{first},127.0.0.1:{second}"\n{more}\n'
    )


@pytest.fixture(autouse=True)
def _here(tmp_path, monkeypatch):
    monkeypatch.chdir(tmp_path)


def write(text):
    Path("room.toml").write_text(text, encoding="utf-8")


def test_a_plan_says_what_runs_where_and_what_a_line_adds(run):
    write(SCENE + NETWORK)
    run("network room.toml --plan").says(
        "near", "far", "spring tool–bed", "0.5 N·s/m", "2.5 g", "paddle: haptic-paddle", "room-0", "memory:"
    )


@pytest.mark.parametrize(
    ("text", "said"),
    [
        (NETWORK, r"there is no \[environment\]"),
        (SCENE, r"there is no \[network\]"),
        ('[environment]\nstiffness = 3\ntype = "wall"\n' + NETWORK, "a network runs a scene"),
        (SCENE + NETWORK.replace('name = "paddle"', 'name = "handle"'), "holds no line end of the scene"),
        (SCENE + NETWORK.split("[[network.device]]")[0], 'nothing holds the line end "paddle"'),
        (SCENE + NETWORK.replace('nodes = ["tool"]', 'nodes = ["tol"]'), '"tol" of part "near" is no node'),
        (SCENE + NETWORK.replace('nodes = ["tool"]', 'nodes = "tool"'), "nodes is a list"),
        (SCENE + NETWORK.replace('nodes = ["tool"]', "nodes = 3"), "nodes is a list"),
        (SCENE + NETWORK.replace('nodes = ["tool"]', ""), "have no nodes; one may have the rest"),
        (SCENE + NETWORK.replace('"far"', '"near"'), 'part 2].*two of the name "near"'),
        (SCENE + NETWORK.replace('"far"', '""'), "name is empty"),
        (SCENE + NETWORK.replace('"far"', '"paddle"'), '"paddle" is a part and a device'),
        (SCENE + NETWORK.replace("[network]", '[network]\ndelay = "4 ms"', 1), "delay must be ≥ 5 ms, got 4"),
        (SCENE.replace('port = ""', 'port = "bed"') + NETWORK, 'nobody would move the port "bed"'),
        (SCENE.replace("\n]", f"\n{SECOND_END}") + NETWORK, 'two line ends are called "paddle"'),
        (SCENE + NETWORK.replace("haptic-paddle", "rotary.toml"), r"impedance is in N\*m\*s/rad"),
        (SCENE + NETWORK + line("paddle", 1, 2) + line("paddle", 3, 4), 'line 2].*two of the name "paddle"'),
        (  # a radius would tell both at their handles
            SCENE + NETWORK + '\n[[network.device]]\nname = "wheel"\nsource = "rotary.toml"\n',
            r"wheel turns and paddle slides.*handle_radius",
        ),
        (SCENE + NETWORK.replace('sample_period = "5 ms"', ""), "sample_period is missing"),
        (SCENE + NETWORK.replace('"5 ms"', '"-5 ms"'), "sample_period"),
        (SCENE + NETWORK.replace('source = "haptic-paddle"', ""), "source is missing"),
        (SCENE + NETWORK + line("no", 1, 2), 'there is no line "no"'),
        (SCENE + NETWORK + line("paddle", 1, 2, "loss = 2"), "loss must be below 1"),
        (
            SCENE + NETWORK + line("paddle", 1, 2, "burst = 3"),
            "burst must be ≥ 1, and 1 without a loss, got 3",
        ),
        (SCENE + NETWORK + line("paddle", 1, 2, "los = 2"), 'did you mean "loss"'),
        (SCENE + NETWORK + line("paddle", 1, 2, 'impedance = "1 N*s/m"'), "is not cut"),
        (SCENE + NETWORK.partition("[[")[0] + '[network.part]\nname = "near"\n', "written as"),
    ],
)
def test_what_is_no_network_is_refused_in_one_line(refused, text, said):
    Path("rotary.toml").write_text(ROTARY, encoding="utf-8")
    write(text)
    told = refused("network room.toml --plan")
    assert re.search(said, told), told


def test_there_is_no_process_of_another_name(refused):
    write(SCENE + NETWORK)
    told = refused("network room.toml --run fare")
    assert 'no process is called "fare"; there are: near, far, paddle' in told


@pytest.mark.real_time
def test_a_bad_link_is_run_by_real_processes_and_one_that_is_killed_leaves_no_force():
    p = free_ports(4)
    text = SCENE + NETWORK + line("paddle", p[0], p[1], 'delay = "4 ms"\njitter = "4 ms"\nloss = 0.2')
    write(text + line("spring tool–bed", p[2], p[3]))
    command = [sys.executable, "-m", "zwidth", "network", "room.toml", "--duration", "4 s", "--json", "--run"]
    pipes = {"stdout": subprocess.PIPE, "stderr": subprocess.PIPE, "encoding": "utf-8"}
    children = {name: subprocess.Popen([*command, name], **pipes) for name in ("near", "far", "paddle")}
    for text in children["near"].stderr:  # a second in which all run
        if "at 1 s" in text:
            break
    children["far"].send_signal(signal.SIGKILL if os.name == "posix" else signal.SIGTERM)
    ends = {name: json.loads(children[name].communicate()[0]) for name in ("near", "paddle")}
    told = {name: end["processes"][name] for name, end in ends.items()}
    children["far"].communicate()
    assert 0 < told["near"]["steps"] <= 800
    assert 0 < told["paddle"]["steps"] <= 4000
    far = told["near"]["links"]["spring tool–bed"]
    paddle = told["near"]["links"]["paddle"]
    assert far["silent_s"] > 0.2
    assert far["last_force_N"] == 0
    assert 0 < paddle["lost"] < paddle["received"]
    assert paddle["round_trip_s"]["median"] > 0.008
    assert paddle["energy_received_J"] > 0


def test_all_processes_are_started_by_one_command(capfd):
    write(SCENE + NETWORK)
    assert main(["network", "room.toml", "--duration", "0.3 s", "--json"]) == 0
    told = json.loads(capfd.readouterr().out)
    assert told["format"] == "zwidth network 1"
    assert set(told["processes"]) == {"near", "far", "paddle"}
    near, paddle = told["processes"]["near"], told["processes"]["paddle"]
    assert near["links"]["paddle"]["energy_received_J"] <= paddle["links"]["paddle"]["energy_sent_J"]
    assert 0 < near["steps"] <= 60


def test_a_channel_that_cannot_be_opened_leaves_no_other_open():
    """The first side's memory is there to be made again."""
    own = f"test-{os.getpid()}"
    lines = f'\n[[network.line]]\nname = "spring tool–bed"\nchannel = "memory:{own}"\n'
    write(SCENE + NETWORK + lines + '\n[[network.line]]\nname = "paddle"\nchannel = "tcp:1"\n')
    plan = load_plan(Path("room.toml").absolute())
    assert list(plan.runs("near", Exact(1)).lines) == ["paddle", "spring tool–bed"]
    for _ in range(2):
        with pytest.raises(InputError, match="no channel is called 'tcp:1'"):
            plan.peer("near", Exact(1))
    with pytest.raises(InputError, match="there is no shared memory"):
        SharedMemory(own, first=False)


def test_steps_longer_than_a_report_are_told_one_by_one(capsys):
    """A part that steps every three seconds has a line for each step."""
    write(SCENE + NETWORK.replace('"5 ms"', '"3 s"'))
    plan = load_plan(Path("room.toml").absolute())
    nobody = Mock(Channel, receive=list)
    peer = Peer(plan.runs("far", Exact(3)), {"spring tool–bed": nobody}, 3)
    _Watch(peer, "far")(0)
    assert "far at 3 s, spring tool–bed: nothing has come" in capsys.readouterr().err


WHEEL_SCENE = SCENE.replace("N*s/m", "N*m*s/rad").replace("50 g", "0.01 kg*m^2").replace("N/m", "N*m/deg")

WHEEL = """[device]
motion = "rotary"
inertia = "0.006 kg*m^2"
damping = "0.2 N*m*s/rad"
rate = "1 kHz"
delay = "0.4 ms"
"""


def test_a_scene_that_turns(run):
    Path("wheel.toml").write_text(WHEEL, encoding="utf-8")
    write(WHEEL_SCENE + NETWORK.replace('"haptic-paddle"', '"wheel.toml"\nhold_back = true'))
    out = run("network room.toml --plan").out
    assert "100 N·m/deg" in out
    assert "143.2 g" not in out
    assert f"{100 * 180 / math.pi * 0.005**2:.4g} kg·m²" in out  # K τ²
    assert "wheel, each force held back for 600 µs (hand: hands on)" in out
    plan = load_plan(Path("room.toml").absolute())
    assert plan.devices["paddle"].device.exact("delay") == Fraction(1, 1000)
