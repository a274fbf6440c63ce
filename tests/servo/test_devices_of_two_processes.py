"""Two devices, each served by a process of its own, joined by one line over real sockets; one is killed."""

import json
import subprocess
import sys

import pytest
from free_channels import udp, zenoh

CHILD = """
import json, os, signal, sys
import zwidth as zw
from zwidth.links import WavePort
from zwidth.machine.network import Peer, open_channel
from zwidth.machine.servo import PortRun
from zwidth.machine.servo.devices import Simulated

channel, first, seconds, start = sys.argv[1], sys.argv[2] == "first", float(sys.argv[3]), float(sys.argv[4])
device = zw.Device(mass=0.036, damping=0.15, coulomb_friction=0.12, resolution=22.4e-6, sample_period=2e-3)
hand = zw.operators.Finger(start=start, speed=0.05)
run = PortRun(
    WavePort(device),
    Simulated(device=device, hand=hand, duration=20),
    "line",
    safety=zw.servo.Safety(longest_gap="30 s"),
)
peer = Peer(run, {"line": open_channel(channel, first)}, "2 ms")
assert peer.meet(30) == ()
felt = []
report = peer.run(seconds, lambda k: felt.append(abs(run.forces["line"])))
told = report.to_dict() | {"felt_N": felt, "device": run.report().to_dict()}
print(json.dumps(told), flush=True)
if not first:
    os.kill(os.getpid(), signal.SIGKILL)
run.close()
peer.close()
"""


def _child(channel, side, seconds, start):
    command = [sys.executable, "-c", CHILD, channel, side, str(seconds), str(start)]
    return subprocess.Popen(command, stdout=subprocess.PIPE, text=True)


@pytest.mark.real_time
@pytest.mark.skipif(sys.platform == "win32", reason="a process kills itself")
@pytest.mark.parametrize("kind", [udp, zenoh])
def test_no_side_hears_of_more_than_was_sent_and_a_killed_one_is_felt_as_no_force(kind):
    """Both feel each other while both live; of the dead one nothing is left at the end."""
    channel = kind()
    lives, dies = _child(channel, "first", 2.5, -0.003), _child(channel, "second", 1.2, -0.01)
    alive, dead = (json.loads(child.communicate()[0]) for child in (lives, dies))
    assert (lives.returncode == 0, dies.returncode < 0) == (True, True)
    assert max(alive["felt_N"]) > 0.02
    assert max(dead["felt_N"]) > 0.02
    assert not any(alive["felt_N"][-100:])
    mine, its = alive["links"]["line"], dead["links"]["line"]
    assert mine["last_force_N"] == 0
    assert 0 < mine["energy_received_J"] <= its["energy_sent_J"]
    assert 0 < its["energy_received_J"] <= mine["energy_sent_J"]
    assert alive["device"]["samples"] == alive["steps"] == 1250
