"""A real device at the end of a line, and two in processes: forces, packets, the end of both at a fault."""

import json
import subprocess
import sys

import numpy as np
import pytest
from free_channels import udp, zenoh
from network.tube import Tube
from servo.played import Library, Played

import zwidth as zw
from zwidth.errors import InputError
from zwidth.links import WavePort
from zwidth.machine.network import Peer
from zwidth.machine.network.runs import DeviceRun
from zwidth.machine.servo import port_run
from zwidth.machine.servo.connection import CLOSED, GARBLED, REFUSED, SILENT, Placement
from zwidth.machine.servo.devices.simulated import Simulated
from zwidth.machine.servo.port_run import PortRun
from zwidth.machine.servo.safety import Safety

STEP = 22.4e-6
PADDLE = zw.Device(mass=0.036, damping=0.15, coulomb_friction=0.12, resolution=STEP, sample_period=1e-3)
LATE = PADDLE.replace(delay=1e-3)
"""As a real device: a force waits for the next reading."""


@pytest.fixture(autouse=True)
def time(monkeypatch):
    """The clock is a period on whenever a run looks at it: how busy this machine is does not matter."""
    passed = [0, 1_000_000]

    def now():
        passed[0] += passed[1]
        return passed[0]

    monkeypatch.setattr(port_run, "now", now)
    return passed


def pushed(run, count, seed=5):
    """What another end sends to a port that is moved to and fro: packets, one a period."""
    random = np.random.default_rng(seed)
    port = WavePort(PADDLE)
    port.meet(run.port.run)
    packets = []
    for k in range(count):
        port.receive()
        ways = round(40 * np.sin(0.02 * k)) + int(random.integers(-3, 4))
        packets.append(port.send(ways * STEP))
    return packets


def without_runs(packets):
    return [packet and (packet.number, packet.wave, packet.energy, packet.position) for packet in packets]


def later(samples):
    """A library whose protocol carries a force so many samples later."""
    return type("Later", (Library,), {"late": samples})


def run_on(connection, device=LATE, **more):
    return PortRun(WavePort(device), connection, "line", **more)


def stepped(run, count):
    return [run.step({"line": [packet]}).get("line") for packet in pushed(run, count)]


def test_a_simulated_device_feels_what_the_simulator_s_own_run_gives_it():
    """Force by force and packet by packet, to the last bit; a period's packet is sent at the next step."""
    hand = zw.operators.Finger()
    given = DeviceRun(WavePort(PADDLE), hand, 1, "line")
    wanted, forces = [], []
    for packet in pushed(given, 800):
        wanted.append(given.step({"line": [packet]})["line"])
        forces.append(given.forces["line"])
    run = run_on(Simulated(device=PADDLE, hand=hand, duration=1), PADDLE, longest_period=1e-3)
    sent, served = [], []
    for packet in pushed(run, 800):
        sent.append(run.step({"line": [packet]}).get("line"))
        served.append(run.forces["line"])
    assert max(map(abs, served)) > 0.05
    assert served == forces
    assert sent[0] is None
    assert without_runs(sent[1:]) == without_runs(wanted[:-1])


@pytest.mark.parametrize(("late", "waits"), [(0, 1), (0, 3), (1, 1), (1, 2)])
def test_a_force_is_given_at_the_reading_from_which_the_port_lets_it_act(late, waits):
    """`delay` samples after its own; a protocol that carries it with the next question does one of them."""
    readings = np.round(30 * np.sin(0.05 * np.arange(300))) * STEP
    connection = later(late)(readings)
    run = run_on(connection, PADDLE.replace(delay=waits * 1e-3))
    acting = []
    for packet in pushed(run, 300):
        run.step({"line": [packet]})
        acting.append(run.forces["line"])
    assert max(map(abs, acting)) > 0.01
    at_the_device = [0.0] * late + connection.forces
    assert at_the_device[: len(acting)] == acting


def test_what_the_packets_tell_is_never_more_than_what_came_and_was_put_in():
    """The energy sent, against that received and the work of the hand: w = force × way, summed here."""
    readings = np.cumsum(np.random.default_rng(2).integers(-20, 21, 600)) * STEP
    run = run_on(Library(readings))
    came = sent = work = 0.0
    before = None
    for k, packet in enumerate(pushed(run, 600)):
        if before is not None:
            work += run.forces["line"] * (readings[k] - before)
        told = run.step({"line": [packet]}).get("line")
        came, before = packet.energy, readings[k]
        if told is not None:
            sent = told.energy
            lost = 0.15 * np.sum(np.diff(readings[: k + 1]) ** 2) / 1e-3
            lost += 0.12 * np.sum(np.abs(np.diff(readings[: k + 1])))
            assert sent <= came - work + lost + 1e-15
    assert sent > 0
    assert came > 0


def test_a_reading_s_zero_and_sense_change_nothing():
    """x = sense (reading − origin): the packets are the same, the forces along the axis turned round."""
    readings = np.round(50 * np.sin(0.03 * np.arange(200))) * STEP
    plain, turned = Library(readings), Library(1000 * STEP - readings)
    runs = [run_on(plain), run_on(turned, placement=Placement(origin=300 * STEP, sense=-1))]
    told = [without_runs(stepped(run, 200)) for run in runs]
    assert told[0] == told[1]
    assert plain.forces == [-f for f in turned.forces]
    assert any(plain.forces)


@pytest.mark.parametrize(
    ("bad", "held"), [({40: SILENT}, 1), ({40: GARBLED, 50: SILENT}, 2), ({40: SILENT, 41: SILENT}, None)]
)
def test_one_sample_without_an_answer_is_held_and_two_end_the_force(bad, held):
    """Held: the force stays, nothing is sent.  Ended: force 0 for good, and silence."""
    connection = Played(np.round(30 * np.sin(0.05 * np.arange(100))) * STEP, bad)
    run = run_on(connection, PADDLE)
    told = stepped(run, 100)
    forces = connection.forces
    if held is not None:
        assert run.ended == ""
        assert run.report().held == held
        assert [k for k, packet in enumerate(told) if packet is None] == [0, *bad]
        assert [packet.number for packet in told if packet is not None] == list(range(99 - held))
    else:
        assert "no answer in time" in run.ended
        assert told[42:] == [None] * 58
        assert forces[39] != 0.0
        assert not forces[41:].any()
        assert run.forces == {"line": 0.0}
        assert run.report().held == 1


@pytest.mark.parametrize(
    ("change", "bad", "said"),
    [
        ({}, {60: CLOSED}, "closed"),
        ({}, {60: REFUSED}, "reports a fault"),
        ({60: float("nan")}, {}, "no number"),
        ({60: 0.02}, {}, "jumped"),
        ({60: 0.4 * STEP}, {}, "whole number of counts"),
    ],
)
def test_a_fault_ends_force_and_packets_at_once(change, bad, said):
    readings = np.round(20 * np.sin(0.05 * np.arange(100))) * STEP
    for k, value in change.items():
        readings[k] = value
    connection = Played(readings, bad)
    run = run_on(connection, PADDLE)
    told = stepped(run, 100)
    assert said in run.ended
    assert run.report().to_dict()["ended"] == run.ended
    assert all(packet is not None for packet in told[1:60])
    assert told[61:] == [None] * 39
    assert connection.forces[58:60].all()
    assert not connection.forces[60:].any()
    run.close()
    assert connection.closed == 1


class Unplugged(Library):
    def apply(self, force):
        return CLOSED if len(self.forces) >= 50 else super().apply(force)


@pytest.mark.parametrize(
    "connection",
    [
        Library(np.round(20 * np.sin(0.05 * np.arange(100))) * STEP, fails=50),
        Unplugged(np.round(20 * np.sin(0.05 * np.arange(100))) * STEP),
    ],
)
def test_a_cable_that_is_out_is_a_line_that_closed(connection):
    run = run_on(connection)
    told = stepped(run, 100)
    assert "has closed" in run.ended
    assert run.failed
    assert len([packet for packet in told if packet is not None]) in (49, 50)
    assert told[51:] == [None] * 49


def test_a_loop_that_did_not_run_ends_the_force_and_long_periods_are_counted(time):
    """1.2 T by default; 50 ms end it."""
    connection = Played(np.round(30 * np.sin(0.05 * np.arange(200))) * STEP)
    run = run_on(connection, PADDLE)
    packets = pushed(run, 200)
    for k in range(100):
        time[1] = 1_199_000 if k % 10 else 1_201_000
        run.step({"line": [packets[k]]})
    assert run.report().later == 9
    assert run.ended == ""
    time[1] = 51_000_000
    run.step({"line": [packets[100]]})
    assert "did not run" in run.ended
    assert connection.forces[99] != 0.0
    assert connection.forces[100] == 0.0


def test_a_gap_ends_a_port_that_gave_no_force_just_then(time):
    """Nobody is at the other end; the hand may have gone far by the next reading."""
    run = run_on(Played(np.zeros(30)), PADDLE)
    for _ in range(20):
        run.step()
    assert run.forces == {"line": 0.0}
    assert run.ended == ""
    time[1] = 51_000_000
    run.step()
    assert "did not run" in run.ended


@pytest.mark.parametrize(("counts", "ended"), [(10_000, False), (20_000, True)])
def test_how_far_a_hand_goes_is_asked_of_the_time_that_passed(counts, ended, time):
    """10 m/s: in 30 ms not 0.45 m, but 0.22 m."""
    readings = np.zeros(30)
    readings[20:] = counts * STEP
    run = run_on(Played(readings), PADDLE)
    packets = pushed(run, 30)
    for k in range(30):
        time[1] = 30_000_000 if k == 20 else 1_000_000
        run.step({"line": [packets[k]]})
    assert ("jumped" in run.ended) == ended


def test_the_safety_s_force_is_the_port_s_own_limit():
    """So that what is given is what is booked: the port without it would give more."""
    readings = np.zeros(300)
    free, limited = Library(readings), Library(readings)
    runs = [run_on(free), run_on(limited, safety=Safety(force="30 mN"))]
    for run in runs:
        stepped(run, 300)
        assert max(map(abs, free.forces)) > 0.03
    assert max(map(abs, limited.forces)) == pytest.approx(0.03)
    assert runs[1].port.device.force_limit == 0.03


@pytest.mark.parametrize(
    ("arguments", "said"),
    [
        ({"device": PADDLE}, "delay must be ≥ 1 ms, got 0 s"),
        ({"connection": later(2)([0.0])}, "delay must be ≥ 2 ms, got 1 ms"),
        ({"safety": Safety(slew=5)}, "leave out slew"),
        ({"longest_period": "0.9 ms"}, "longest_period must be ≥ 1 ms"),
        ({"device": zw.Device(damping=1, rate=1000, delay=1e-3, motion="rotary")}, "connection is linear"),
    ],
)
def test_what_does_not_go_together_is_refused(arguments, said):
    with pytest.raises(InputError, match=said):
        run_on(**{"connection": Library([0.0]), **arguments})


def test_two_devices_over_one_line_take_nothing_from_each_other_and_one_alone_feels_nothing():
    devices = {
        "ann": Simulated(device=LATE, hand=zw.operators.Finger(), duration=2),
        "bob": Simulated(device=LATE, hand=zw.operators.Finger(start=-0.01, speed=0.05), duration=2),
    }
    runs = {name: run_on(device) for name, device in devices.items()}
    channels = dict(zip(("ann", "bob"), Tube.pair(), strict=True))
    peers = {name: Peer(run, {"line": channels[name]}, 1e-3) for name, run in runs.items()}
    felt, put_in = {"ann": [], "bob": []}, []
    for k in range(1500):
        for name, peer in peers.items():
            if name == "ann" or k < 1000:
                peer.step()
                felt[name].append(abs(runs[name].forces["line"]))
        memories = [run._axis._opened.memory for run in runs.values()]
        told = {name: i for i, name in enumerate(devices["ann"].tells, start=8)}
        work = sum(m[told["hand_work_J"]] for m in memories)
        moving = sum(0.5 * 0.036 * m[told["true_velocity_m_per_s"]] ** 2 for m in memories)
        put_in.append(work - moving)
    assert min(put_in) > -1e-12
    assert put_in[-1] > 1e-6
    assert max(felt["bob"]) > 0.02
    assert max(felt["ann"][:1000]) > 0.02
    assert not any(felt["ann"][1012:])
    for one, other in (("ann", "bob"), ("bob", "ann")):
        heard, sent = peers[one].links["line"].report(), peers[other].links["line"].report()
        assert 0 < heard.energy_received <= sent.energy_sent
    for peer in peers.values():
        peer.close()


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
