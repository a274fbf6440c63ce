"""A wave port never gives out more than it was sent: booked once more in exact arithmetic."""

from __future__ import annotations

import random
from collections.abc import Callable
from dataclasses import replace
from fractions import Fraction
from math import floor
from typing import Any

import pytest
from strategies import seeds

import zwidth as zw
from zwidth.errors import InputError
from zwidth.links import Packet, WavePort
from zwidth.links.memory import ACTING, COUNTED, ENERGY, HEARD_ENERGY, NUMBER
from zwidth.links.wave_port import RESERVE
from zwidth.native.compiled import Array

PERIODS = 150
SCHEDULES = 2000


def arm(damping: str = "0.15", friction: str = "0", resolution: str = "0", **more: object) -> zw.Device:
    return zw.Device(
        damping=damping, coulomb_friction=friction, resolution=resolution, rate=1000, **{"delay": 0, **more}
    )


class Ends:
    """Two ports and a link that does what it likes with packets, and what two hands put in, exactly: ≥ 0.

    Within a period each hand moves at constant speed: no motion between two readings costs it less.
    """

    def __init__(
        self, devices: list[zw.Device], draw: random.Random, keeps_all: bool = False, **law: object
    ) -> None:
        self.ports = [WavePort(device, **law) for device in devices]
        self.draw, self.keeps_all = draw, keeps_all
        self.on_the_way: list[list[Packet]] = [[], []]
        self.at = [Fraction(draw.random()) * port.device.exact("resolution") for port in self.ports]
        self.work = Fraction(0)
        self.forces = [0.0, 0.0]

    def arrived(self, end: int) -> list[Packet]:
        waiting, draw = self.on_the_way[end], self.draw
        out = [draw.choice(waiting) for _ in range(draw.choice([0, 0, 1, 1, 2, 3]))] if waiting else []
        if self.keeps_all and draw.random() < 0.5:
            out += waiting[-1:]
        if not self.keeps_all and draw.random() < 0.05:
            waiting.clear()
        return out

    def period(self, move: Callable[[int, float], float]) -> None:
        for end, port in enumerate(self.ports):
            port.receive(self.arrived(end))
            self.forces[end] = float(port.state[ACTING])
        for end, port in enumerate(self.ports):
            device, before = port.device, self.at[end]
            moved = Fraction(move(end, self.forces[end]))
            self.at[end] = after = before + moved
            lost = device.exact("damping") * moved**2 / device.exact("sample_period")
            lost += device.exact("coulomb_friction") * abs(moved)
            self.work += lost - Fraction(self.forces[end]) * moved
            step = device.exact("resolution")
            counts = floor(after / step) - floor(before / step) if step else 0
            read = float(counts * step) if step else float(moved)
            self.on_the_way[1 - end].append(port.send(read))
            assert port.state[RESERVE] >= -1e-15
        assert self.work >= 0


def greedy(ends: Ends) -> Callable[[int, float], float]:
    """What takes most in this period, a leap, a small move, or one to and fro over an edge."""

    def move(end: int, force: float) -> float:
        device, draw = ends.ports[end].device, ends.draw
        step = float(device.resolution) or 1e-5
        most = force * 1e-3 / (2 * float(device.damping))
        return draw.choice([most, most, draw.gauss(0, 30 * step), draw.gauss(0, step / 3), 0.0])

    return move


@seeds(5)
@pytest.mark.parametrize("friction", ["0", "0.12"])
@pytest.mark.parametrize("resolution", ["0", "22.4e-6"])
@pytest.mark.parametrize(("impedance", "late"), [("0.04", 0), ("0.15", 0), ("1", 0), ("0.15", 1), ("1", 3)])
def test_two_hands_never_take_energy_out(impedance, late, resolution, friction, seed) -> None:
    """Not a joule, whatever impedance: in exact arithmetic, so that rounding is on the safe side too."""
    device = arm(friction=friction, resolution=resolution, delay=Fraction(late, 1000))
    ends = Ends([device, device], random.Random(seed), impedance=impedance)
    move = greedy(ends)
    largest = 0.0
    for _ in range(PERIODS):
        ends.period(move)
        largest = max(largest, *map(abs, ends.forces))
    assert largest > 1e-3


def test_a_hand_inside_one_count_gains_nothing() -> None:
    """It rests at the lower edge, goes up with each push and comes back slowly: no reading ever changes.

    Without what a force that grows is charged, each push would be free.
    """
    device = arm(resolution="22.4e-6")
    port, told, taken, height = WavePort(device), 1e-6, 0.0, 20e-6
    port.receive()
    sent = port.send(0.0).energy
    seen = 0.0
    for k in range(200):
        force = port.receive([Packet(2 * k + 1, 0.0, told, (k + 1) * 6e-5, 9, port.run)])
        seen = max(seen, force)
        taken += force * height - 0.15 * height**2 / 0.001
        sent = port.send(0.0).energy
        for _ in range(20):
            taken -= port.receive() * height / 20 + 0.15 * (height / 20) ** 2 / 0.001
            sent = port.send(0.0).energy
        assert taken <= told - sent
    assert seen > 2 * 0.15 * height / 0.001


def moved(port: WavePort, way: float, to: WavePort) -> Packet:
    """The packet of a period in which nothing has come."""
    port.meet(to.run)
    port.receive()
    return port.send(way)


def test_an_older_packet_changes_nothing() -> None:
    other, *ports = (WavePort(arm()) for _ in range(3))
    packets = [moved(other, 1e-4, ports[0]) for _ in range(4)]
    forces: list[list[float]] = [[], []]
    for k, old in ((0, 0), (3, 1), (3, 2), (3, 0)):
        for port, heard, found in zip(ports, ([k], [k, old]), forces, strict=True):
            found.append(port.receive([replace(packets[i], to=port.run) for i in heard]))
            port.send(1e-4)
    assert forces[0] == forces[1]
    assert forces[0][2] > 0


def test_what_is_lost_comes_with_the_next_packet() -> None:
    """The sums of lost packets are those of the ones that arrive, so the forces are the same later."""
    sender, whole, lossy = (WavePort(arm()) for _ in range(3))
    for port in (whole, lossy):
        port.receive()
        port.send(0.0)
    packets = [moved(sender, way, whole) for way in (0.0, 1e-4, 1e-4, 1e-4)]
    every, some = [], []
    for arriving in (1, 2, 3, None, None):
        every.append(whole.receive([packets[arriving]] if arriving else []))
        some.append(lossy.receive([replace(packets[3], to=lossy.run)] if arriving == 3 else []))
        whole.send(1e-4)
        lossy.send(1e-4)
    assert every[:3] == pytest.approx([0.03] * 3, rel=1e-9)
    assert some[2:] == pytest.approx([0.03] * 3, rel=1e-9)
    assert every[3:] == pytest.approx([0.0, 0.0], abs=1e-9)


def test_one_push_and_six_followers_one_after_another() -> None:
    device = arm(friction="0.05")
    leader, told = WavePort(device), list[Packet]()
    work, back = Fraction(0), list[Packet]()

    def hold(port: WavePort, packets: list[Packet], way: float | None = None) -> Packet:
        """A hand that goes so far, or is taken along as is best for it."""
        nonlocal work
        force = port.receive(packets)
        best = max(abs(force) - 0.05, 0.0) * 1e-3 / 0.3
        way = way if way is not None else best if force > 0 else -best
        moved, lost = Fraction(way), device.exact("damping") / device.exact("sample_period")
        work += lost * moved**2 + Fraction(1, 20) * abs(moved) - Fraction(force) * moved
        return port.send(way)

    follower = WavePort(device)
    for k in range(13):
        told.append(hold(leader, back, 0.0 if k < 3 else 1e-3))
        back = [hold(follower, told[-1:])] if k < 3 else []
    found = [work]
    for _ in range(7):
        hold(follower, told[:1])
        for _ in range(100):
            hold(follower, told[-1:])
        found.append(work)
        follower = WavePort(device)
    assert found[0] == pytest.approx(2e-3)
    assert 0 < found[1] < 1e-3
    assert found[2:] == found[1:2] * 6


def test_who_has_answered_is_sent_to_and_nobody_else() -> None:
    """Not a run whose old packets come again, nor the port itself over a link that sends all back."""
    port, other, gone = (WavePort(arm()) for _ in range(3))
    assert port.receive([Packet(0, 0.1, 1.0, 1e-3, port.run, port.run)]) == 0
    assert port.send(0.0).to == 0
    for stranger, to in ((gone, 0), (other, 0), (gone, 0), (other, port.run), (gone, 0), (gone, other.run)):
        port.receive([replace(moved(stranger, 0.0, port), to=to)])
        told = port.send(0.0).to
    assert told == other.run


class Purse(WavePort):
    """Takes what it hears of, and sends on whole parts of it: sums of whole numbers, without rounding."""

    draw: random.Random

    def take(self, s: Array) -> float:
        s[RESERVE] += s[HEARD_ENERGY] - s[COUNTED]
        s[COUNTED] = s[HEARD_ENERGY]
        return 0.0

    def give(self, s: Array, _: float) -> None:
        part = self.draw.randint(0, int(s[RESERVE]))
        s[RESERVE] -= part
        s[ENERGY] += part
        s[NUMBER] += 1.0

    @property
    def steps(self) -> Any:
        return (lambda _, s: self.take(s)), (lambda _, s, moved: self.give(s, moved))


def test_no_order_of_packets_and_of_starts_gives_a_joule_twice() -> None:
    """A link that keeps every packet of every run and brings any of them to whoever runs, whenever it likes.

    Purses that are left and those that are held are never more than there were at first; and once the old
    packets are gone, two that hear each other are sent to again.
    """
    device, draw = arm(), random.Random(2)
    Purse.draw = draw
    largest = 0
    for _ in range(SCHEDULES):
        ends, sent = [Purse(device), Purse(device)], [list[Packet](), list[Packet]()]
        left, restarts = 0, draw.choice([0.0, 0.05, 0.2])
        for purse in ends:
            purse.state[RESERVE] = 1000.0
        for _ in range(12):
            for end, purse in enumerate(ends):
                if draw.random() < restarts:
                    left += int(purse.state[RESERVE])
                    ends[end] = purse = purse.anew()
                waiting = sent[1 - end]
                recent = waiting[-3:] if draw.random() < 0.7 else waiting
                purse.receive(draw.choice(recent) for _ in range(draw.randint(0, 2)) if recent)
                sent[end].append(purse.send(0.0))
            held = sum(int(purse.state[RESERVE]) for purse in ends)
            assert left + held <= 2000
            largest = max(largest, *(int(purse.state[COUNTED]) for purse in ends))
        for _ in range(3):
            for end, purse in enumerate(ends):
                purse.receive(sent[1 - end][-1:])
                sent[end].append(purse.send(0.0))
        assert [packets[-1].to for packets in sent] == [purse.run for purse in reversed(ends)]
    assert largest > 1000


@seeds(12)
@pytest.mark.parametrize("resolution", ["0", "22.4e-6"])
def test_two_hands_take_nothing_out_whichever_end_starts_anew(resolution: str, seed: int) -> None:
    """And the packets of all runs come again: in exact arithmetic, over all runs of both ends."""
    device, draw = arm(friction="0.02", resolution=resolution), random.Random(seed)
    ends = Ends([device, device], draw, impedance=draw.choice(["0.04", "0.15", "1"]), keeps_all=True)
    move, felt = greedy(ends), 0
    for k in range(PERIODS):
        for end, port in enumerate(ends.ports):
            if draw.random() < 0.03:
                ends.ports[end] = port.anew()
        ends.period(move)
        felt += k > PERIODS // 2 and any(ends.forces)
    assert felt


def test_an_actuator_that_gives_less_is_booked_as_it_gives() -> None:
    device = arm(friction="0.02", resolution="1e-5", force_limit="0.03", force_resolution="0.004")
    ends = Ends([device, device], random.Random(3))
    move, seen = greedy(ends), set()
    for _ in range(PERIODS):
        ends.period(move)
        seen |= set(map(abs, ends.forces))
    assert max(seen) == pytest.approx(0.028)
    assert all(Fraction(f).limit_denominator(10**6) % Fraction(4, 1000) == 0 for f in seen)


@seeds(3)
def test_unlike_ends_take_nothing_out_of_each_other(seed: int) -> None:
    draw = random.Random(seed)
    leader = arm(damping="0.5", friction="0.05", resolution="5e-5")
    follower = arm(damping="0.03", delay="1 ms")
    ends = Ends([leader, follower], draw, smoothing="3 ms")
    move = greedy(ends)
    for _ in range(PERIODS):
        ends.period(move)


def test_ends_of_two_rates_come_to_the_same_place() -> None:
    slow, quick = WavePort(arm()), WavePort(zw.Device(damping="0.15", rate=2000, delay=0))
    there, back = list[Packet](), list[Packet]()
    gone = followed = 0.0
    for k in range(200):
        slow.receive(back)
        forces, back = [], []
        for _ in range(2):
            forces.append(quick.receive(there))
            there = []
            way = forces[-1] * 0.0005 / 0.15  # without a mass: f = b v
            followed += way
            back.append(quick.send(way))
        assert forces[0] == pytest.approx(forces[1], abs=1e-9)
        step = 2e-5 if k < 150 else 0.0
        gone += step
        there = [slow.send(step)]
    assert followed == pytest.approx(gone, rel=1e-9)


def test_receive_and_send_are_called_in_turn() -> None:
    """A force that is booked twice would bring energy back twice, and a way under two forces has no work."""
    port, other = WavePort(arm()), WavePort(arm())
    port.receive([moved(other, 0.0, port)])
    with pytest.raises(InputError, match="receive is called once in a period"):
        port.receive()
    port.send(0.0)
    with pytest.raises(InputError, match="send is called once in a period"):
        port.send(0.0)
    assert port.receive([moved(other, 1e-3, port)]) > 0


def test_the_force_of_a_period_is_the_one_that_acts_in_it() -> None:
    port, other = WavePort(arm(delay=Fraction(2, 1000))), WavePort(arm())
    computed, acted = [], []
    for _ in range(6):
        computed.append(port.receive([moved(other, 1e-4, port)]))
        acted.append(port.force)
        port.send(0.0)
    assert acted == [0.0, 0.0, *computed[:4]]
    assert max(map(abs, acted)) > 0
