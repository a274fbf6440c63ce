"""Motions of two hands that take energy out of two ports, if any of those that are tried does."""

from __future__ import annotations

from collections.abc import Iterator
from dataclasses import dataclass
from fractions import Fraction
from functools import cached_property
from math import floor
from typing import TYPE_CHECKING, Any, ClassVar, NamedTuple

import numpy as np

from zwidth.links.memory import ACTING, COULOMB, DAMPING, LATE, PERIOD, RESOLUTION
from zwidth.links.port import Packet, Port
from zwidth.links.schedule import LOST, Schedule
from zwidth.links.simulation import End, deliver, law_force, law_send, post, wire_of
from zwidth.loop.law import measured
from zwidth.native.compiled import Array, compiled
from zwidth.passivity.result import Result
from zwidth.passivity.wording import takes_once
from zwidth.quantity.glossary import unit_suffix

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

    _FORMAT: ClassVar[str] = "zwidth link motion 1"

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
            "format": self._FORMAT,
            f"leader_positions_{unit}": leader,
            f"follower_positions_{unit}": follower,
            "energy_J": self.energy,
        }

    def describe(self) -> str:
        """In a sentence."""
        period = self.leader.device.exact("sample_period")
        lasts = float((self.positions.shape[1] - 1) * period)
        return takes_once("two hands, one on each device,", self.energy, "pair", lasts)


def _lost(port: Port, way: Fraction) -> Fraction:
    numbers = [Fraction(float(port.numbers[i])) for i in (DAMPING, COULOMB, PERIOD)]
    return numbers[0] * way**2 / numbers[2] + numbers[1] * abs(way)


def _read(port: Port, x: Fraction) -> Fraction:
    step = Fraction(float(port.numbers[RESOLUTION]))
    return step * floor(x / step) if step else x


def most_taken(leader: Port, follower: Port, schedule: Schedule) -> LinkWitness | None:
    """The motion of those tried that takes most out; None where none takes any.

    Each lasts four times there and back over the link, and 400 samples at least.

    Parameters
    ----------
    leader, follower
        Ports of one sample period; their state plays no part.
    schedule
        What the link does.
    """
    period = leader.device.exact("sample_period")
    there_and_back = 2 * (1 + schedule.samples_late(period) + int(leader.numbers[LATE]))
    count = max(_SAMPLES, _ROUNDS * there_and_back)
    times = [schedule.arrivals(count, period, way) for way in (0, 1)]
    best, least = None, 0.0
    for one, other in _hands(leader, there_and_back, schedule.seed, count):
        ends = [
            End(port.code, port.numbers, port.fresh_state(), wire_of(*times[1 - end], count))
            for end, port in enumerate((leader, follower))
        ]
        positions, forces = np.zeros((2, count + 1)), np.zeros((2, count))
        positions[:, 0] = [-one.size / 2, -other.size / 2]  # half a way before an edge
        out = try_hands(ends[0], one, ends[1], other, positions, forces)
        if out < least and np.isfinite(forces).all():
            best, least = _cut(positions, forces, leader, follower), out
    if best is None:
        return None
    witness = LinkWitness(leader, follower, schedule, best)
    return witness if witness.exact_energy > 0 else None


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


# Two hands that try to take energy out: they hold each speed within a period, and no law can ask for more.
#
# In a period a hand that goes Δx puts in
#
#     b Δx²/T + f_c |Δx| − f Δx
#
# beside the kinetic energy, which comes back: no motion between two samples costs it less.  For the force f
# most comes out at Δx = (|f| − f_c) T/(2b) sgn f, (|f| − f_c)² T/(4b).


class Hand(NamedTuple):
    """What one hand does.

    Until sample `until` it goes `size` [m; rad] in each period, or `draws` times that where there are any,
    and turns round after every `half` periods.  Then it takes what there is to take, at most `most` in a
    period, and rests where the force is below friction.
    """

    size: float
    half: int
    until: int
    most: float
    draws: Array


@compiled
def displacement(hand: Hand, p: Array, k: int, force: float) -> float:
    """Where a hand goes in period k."""
    if k < hand.until:
        way: float = hand.size * (hand.draws[k] if hand.draws.size > 0 else 1.0)
        return way if (k // hand.half) % 2 == 0 else -way
    more = abs(force) - p[COULOMB]
    if more <= 0.0:
        return 0.0
    far = min(more * p[PERIOD] / (2.0 * p[DAMPING]), hand.most) if p[DAMPING] > 0.0 else hand.most
    return far if force > 0.0 else -far


@compiled
def put_in(p: Array, force: float, moved: float) -> float:
    """What a hand puts in over a period [J]."""
    work: float = (p[DAMPING] * abs(moved) / p[PERIOD] + p[COULOMB]) * abs(moved) - force * moved
    return work


@compiled
def reading(p: Array, x: float) -> float:
    """Of an encoder whose edges are at whole counts."""
    return measured(x, p[RESOLUTION], 0.0)


@compiled
def try_hands(near: End, leader: Hand, far: End, follower: Hand, positions: Array, forces: Array) -> float:
    """The least that both hands have put in, over all samples [J]; below 0 it has come out of nothing.

    Both arrays have a row for each end; positions starts with where each hand starts.
    """
    samples = forces.shape[1]
    total, least = 0.0, 0.0
    for k in range(samples):
        total += one_end(near, leader, k, positions[0, :], forces[0, :])
        total += one_end(far, follower, k, positions[1, :], forces[1, :])
        post(far.hears, near.state)
        post(near.hears, far.state)
        least = min(least, total)
    return least


@compiled
def one_end(end: End, hand: Hand, k: int, positions: Array, forces: Array) -> float:
    """A period of one end: hear, push, move, and make a packet; returns what the hand puts in."""
    deliver(end.hears, k, end.state)
    p = end.numbers
    law_force(end.code, p, end.state)
    f = end.state[ACTING]
    x = positions[k]
    after = x + displacement(hand, p, k, f)
    law_send(end.code, p, end.state, reading(p, after) - reading(p, x))
    positions[k + 1], forces[k] = after, f
    return put_in(p, f, after - x)
