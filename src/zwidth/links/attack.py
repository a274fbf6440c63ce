"""Motions of two hands that take energy out of two ports, if any of those that are tried does."""

from __future__ import annotations

from collections.abc import Iterator
from dataclasses import dataclass
from fractions import Fraction
from functools import cached_property
from math import floor
from typing import TYPE_CHECKING, Any, ClassVar

import numpy as np

from zwidth.links.kernel import End
from zwidth.links.memory import ACTING, COULOMB, DAMPING, LATE, PERIOD, RESOLUTION
from zwidth.links.packet import Packet
from zwidth.links.port import Port
from zwidth.links.schedule import LOST, Schedule
from zwidth.links.two_hands import Hand, try_hands
from zwidth.links.wire import wire_of
from zwidth.passivity.result import Result
from zwidth.quantity.glossary import unit_suffix
from zwidth.quantity.text import shown

if TYPE_CHECKING:
    from numpy.typing import NDArray

    from zwidth.native.compiled import Array

SPEEDS = (1e-3, 1e-2, 0.1, 1.0, 10.0)
"""Of the hands that are tried [m/s; rad/s]."""
_SAMPLES, _ROUNDS = 400, 4
"""How long each motion is at least, also in times that a wave goes there and back."""
_ROUNDING = 1e-9
"""Of all work that is done: what comes out beyond that is not of rounding."""


@dataclass(frozen=True, repr=False)
class LinkWitness(Result):
    """A motion of two hands, one on each device, that takes energy out over one link.

    Attributes
    ----------
    ports, schedule
        Leader first; what the link does.
    positions
        Of each hand at every sample [m; rad], at constant speed between two; a row for each.
    """

    FORMAT: ClassVar[str] = "zwidth link motion 1"

    leader: Port
    follower: Port
    schedule: Schedule
    positions: NDArray[np.float64]

    @cached_property
    def exact_energy(self) -> Fraction:
        """What comes out of both ends [J], the kinetic energy aside; 0 where it may be of rounding.

        Each port is run again with what the encoder reads; the work of its forces, which are doubles, on
        the way between the positions is added up exactly.
        """
        samples = self.positions.shape[1] - 1
        period = self.leader.device.exact("sample_period")
        ports = [self.leader.anew(), self.follower.anew()]
        for port, other in zip(ports, reversed(ports), strict=True):
            port.meet(other.run)
        due: list[dict[int, list[Packet]]] = [{}, {}]
        times = [self.schedule.arrivals(samples, period, way) for way in (0, 1)]
        total = done = Fraction(0)
        for k in range(samples):
            told = []
            for end, port in enumerate(ports):
                port.receive(due[end].pop(k, ()))
                force = Fraction(float(port.state[ACTING]))
                x, after = (Fraction(float(v)) for v in self.positions[end, k : k + 2])
                total += force * (after - x) - _lost(port, after - x)
                done += abs(force * (after - x))
                told.append(port.send(float(_read(port, after) - _read(port, x))))
            for end, packet in enumerate(told):
                for arrivals in times[end]:
                    if arrivals[k] != LOST:
                        due[1 - end].setdefault(int(arrivals[k]), []).append(packet)
        return total if total > done * Fraction(_ROUNDING) else Fraction(0)

    @property
    def energy(self) -> float:
        """What comes out [J], rounded."""
        return float(self.exact_energy)

    def to_dict(self) -> dict[str, Any]:
        """The motion as plain data, units in the keys."""
        unit = unit_suffix(self.leader.device.unit("position"))
        leader, follower = (row.tolist() for row in self.positions)
        return {
            "format": self.FORMAT,
            f"leader_positions_{unit}": leader,
            f"follower_positions_{unit}": follower,
            "energy_J": self.energy,
        }

    def describe(self) -> str:
        """In a sentence."""
        period = self.leader.device.exact("sample_period")
        time = shown(float((self.positions.shape[1] - 1) * period), "s")
        return f"two hands take {shown(self.energy, 'J')} out in {time}"


def _lost(port: Port, way: Fraction) -> Fraction:
    numbers = [Fraction(float(port.numbers[i])) for i in (DAMPING, COULOMB, PERIOD)]
    return numbers[0] * way**2 / numbers[2] + numbers[1] * abs(way)


def _read(port: Port, x: Fraction) -> Fraction:
    step = Fraction(float(port.numbers[RESOLUTION]))
    return step * floor(x / step) if step else x


def most_taken(
    leader: Port, follower: Port, schedule: Schedule, samples: int | None = None
) -> LinkWitness | None:
    """The motion of those tried that takes most out; None where none takes any.

    Parameters
    ----------
    leader, follower
        Ports of one sample period; their state plays no part.
    schedule
        What the link does.
    samples
        How long each motion is; None: four times there and back, and 400 at least.
    """
    period = leader.device.exact("sample_period")
    there_and_back = 2 * (1 + schedule.samples_late(period) + int(leader.numbers[LATE]))
    count = max(_SAMPLES, _ROUNDS * there_and_back) if samples is None else samples
    times = [schedule.arrivals(count, period, way) for way in (0, 1)]
    best, least = None, 0.0
    for one, other in _hands(leader, there_and_back, schedule.seed, count):
        ends = [
            End(port.code, port.numbers, port.fresh_state(), wire_of(*times[1 - end], count))
            for end, port in enumerate((leader, follower))
        ]
        positions, forces = np.zeros((2, count + 1)), np.zeros((2, count))
        positions[:, 0] = [-_start(one), -_start(other)]
        out = try_hands(ends[0], one, ends[1], other, positions, forces)
        if out < least and np.isfinite(forces).all():
            best, least = _cut(positions, forces, leader, follower), out
    if best is None:
        return None
    witness = LinkWitness(leader, follower, schedule, best)
    return witness if witness.exact_energy > 0 else None


def _start(hand: Hand) -> float:
    """Half a way before an edge."""
    return hand.size / 2


def _cut(positions: Array, forces: Array, leader: Port, follower: Port) -> Array:
    """Up to where most has come out."""
    out = np.zeros(forces.shape[1])
    for end, port in enumerate((leader, follower)):
        p, moved = port.numbers, np.diff(positions[end])
        out += forces[end] * moved - p[DAMPING] * moved**2 / p[PERIOD] - p[COULOMB] * abs(moved)
    return positions[:, : int(np.argmax(np.cumsum(out))) + 2]


def _hands(port: Port, round_trip: int, seed: int, samples: int) -> Iterator[tuple[Hand, Hand]]:
    """To and fro in time with the link, at many speeds, or over one edge; the other held, or moving too."""
    none = np.empty(0)
    draws = np.random.default_rng(seed).normal(size=samples)
    sizes = [speed * float(port.numbers[PERIOD]) for speed in SPEEDS] + port.telling_ways()
    most = max(sizes)
    still, greedy = Hand(0.0, 1, samples, most, none), Hand(0.0, 1, 0, most, none)
    for size in sizes:
        for half in {1, round_trip // 2, round_trip, samples}:
            for until in (samples // 2, samples):
                hand = Hand(size, half, until, most, none)
                yield from ((hand, still), (hand, hand), (hand, greedy))
        yield Hand(size, samples, samples // 2, most, draws), still
