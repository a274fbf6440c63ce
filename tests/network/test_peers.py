"""Peers on a clock that the test turns: what they step, hear and say; and what a silent one is felt as."""

import random

import numpy as np
import pytest
from network.tube import Tube

import zwidth as zw
from zwidth.errors import InputError
from zwidth.links import Schedule, WavePort
from zwidth.machine.network import Lossy
from zwidth.machine.network.peer import Peer
from zwidth.machine.network.runs import DeviceRun, PartRun
from zwidth.model.scene import Contact, Damper, LineEnd, Mass, Scene, Spring
from zwidth.model.scene.parts import Part

PADDLE = zw.Device(mass=0.036, damping=0.15, coulomb_friction=0.12, resolution=22.4e-6, sample_period=1e-3)


class Clock:
    """A time that passes when it is asked to, and a little whenever it is looked at."""

    def __init__(self):
        self.now = 0.0

    def __call__(self):
        self.now += 1e-6
        return self.now

    def sleep(self, seconds):
        self.now += seconds


def room(*names):
    """A tool of 50 g before a bed, held by lines of these names."""
    lines = [LineEnd("tool", 0.15, name) for name in names]
    bed = Contact("tool", "ground", 80, gap=0.003)
    return Part("room", Scene([*lines, Mass("tool", 0.05), Damper("tool", "ground", 0.2), bed], ""))


def together(peers, clock, seconds, tick=1e-3):
    """Step each peer whenever its period is over."""
    for k in range(round(seconds / tick)):
        clock.now = k * tick
        for every, peer in peers:
            if k % every == 0:
                peer.step()


def test_two_people_in_one_scene_over_different_bad_links_take_out_no_energy():
    clock = Clock()
    hands = {"ann": zw.operators.Finger(), "bob": zw.operators.Finger(start=-0.01, speed=0.05)}
    runs, channels, peers = {}, {}, []
    for i, (name, hand) in enumerate(hands.items()):
        runs[name] = DeviceRun(WavePort(PADDLE), hand, 2, name)
        here, there = Tube.pair()
        bad = Schedule(delay=0.004 * (1 + 5 * i), jitter=0.01, loss=0.4, duplicates=0.2, seed=i)
        peers.append((1, Peer(runs[name], {name: Lossy(here, bad, clock=clock)}, "1 ms", clock=clock)))
        channels[name] = Lossy(there, bad, way=1, clock=clock)
    scene = PartRun(room(*hands), "5 ms")
    peers.append((5, Peer(scene, channels, "5 ms", clock=clock)))
    together(peers, clock, 2)
    spent = 0.0
    for run in runs.values():
        trace = run.trace()
        spent = spent + trace["hand_work"].values - trace["kinetic_energy"].values
    assert spent.min() > -1e-12
    account = scene.account()
    lost = float(account["lost"].sel(element="damper tool"))
    assert lost > 1e-6
    assert spent[-1] > lost + float(account["stored"].sum())


def test_a_peer_that_is_gone_is_felt_as_no_force():
    clock = Clock()
    run = DeviceRun(WavePort(PADDLE), zw.operators.Finger(), 2, "line")
    here, there = Tube.pair()
    device = Peer(run, {"line": here}, "1 ms")
    scene = Peer(PartRun(room("line"), "5 ms"), {"line": there}, "5 ms")
    together([(1, device), (5, scene)], clock, 1)
    together([(1, device)], clock, 0.5)
    force = run.trace()["actuator_force"].values
    assert np.abs(force[:1000]).max() > 0.05
    assert not force[1012:1500].any()


class Echoing(Tube):
    """Brings what it has brought before once more, now and then: of every run that was at the other side."""

    def __init__(self, mine, other):
        super().__init__(mine, other)
        self.old, self.draw = [], random.Random(4)

    def receive(self):
        found = super().receive()
        self.old += found
        return found + [self.draw.choice(self.old) for _ in range(self.draw.choice([0, 1, 2])) if self.old]


def test_a_process_that_starts_anew_is_felt_again_and_nothing_is_given_twice():
    """The scene's process three times, over a link that repeats; the device and its hand go on."""
    clock = Clock()
    push = zw.operators.RecordedForce(0.5 * np.sin(0.02 * np.arange(2000)))
    run = DeviceRun(WavePort(PADDLE), push, 2, "line")
    here, there = Echoing.pair()
    device = Peer(run, {"line": here}, "1 ms", clock=clock)
    for _ in range(3):
        scene = Peer(PartRun(room("line"), "5 ms"), {"line": there}, "5 ms", clock=clock)
        together([(1, device), (5, scene)], clock, 0.5)
        seen, told = device.links["line"].report(), scene.links["line"].report()
        assert told.energy_received <= seen.energy_sent
    trace = run.trace()
    force = np.abs(trace["actuator_force"].values)
    assert min(force[500 * k : 500 * (k + 1)].max() for k in range(3)) > 0.05
    assert (trace["hand_work"].values - trace["kinetic_energy"].values).min() > -1e-12


def test_the_pace_is_kept_and_what_is_late_is_made_up_for():
    clock = Clock()
    here, _ = Tube.pair()
    peer = Peer(PartRun(room("line"), "5 ms"), {"line": here}, "5 ms", clock=clock, sleep=clock.sleep)

    def each(k):
        if k == 30:
            clock.now += 0.1

    report = peer.run("0.5 s", each)
    assert (report.steps, report.late) == (100, 19)
    assert clock.now == pytest.approx(0.5, abs=0.006)
    assert report.lateness[0] < 1e-4
    assert report.lateness[2] == pytest.approx(0.095, abs=1e-3)
    assert "100 steps, 19 by more" in repr(report)
    assert report.links["line"].sent == 100
    assert peer.run(1, stop=lambda: True).steps == 0
    peer.close()
    assert not here.is_open


def test_every_line_has_a_channel():
    here, _ = Tube.pair()
    with pytest.raises(InputError, match="a channel is wanted for each of the lines line, got other"):
        Peer(PartRun(room("line"), "5 ms"), {"other": here}, "5 ms")


def test_a_device_ends_with_its_duration():
    run = DeviceRun(WavePort(PADDLE), zw.operators.Finger(), 0.002, "line")
    run.step()
    run.step()
    with pytest.raises(InputError, match="was simulated for 2 samples"):
        run.step()


def test_a_spring_at_the_scene_s_port_is_felt_by_a_part_alone():
    part = Part("alone", Scene([Spring("handle", "ground", 100)]))
    run = PartRun(part, "1 ms")
    run.step(move=0.01)
    run.step(move=0.0)
    assert run.felt == pytest.approx(1.0)
