"""A motion of the hand on a device with a transmission that took energy out where the simulator replayed it.

From rest the hand's work is a quadratic form of its speeds, each constant in a piece of a sample: with x the
state of motor, law and delay, x ← A x + B v and the forces' impulses C x + D v.  The form is taken of the
speeds that swing where the criterion is violated, or where the held loop rings, swelling and fading as a few
sines; its least eigenvector is the motion.  A hand that has to stay inside presses first so deep that the
reading does, and comes back in the end.  Friction and steps cost as much as the size, the gain grows with its
square.  All that is a guess: what is told is what came out in the simulator.
"""

from __future__ import annotations

from collections.abc import Iterator
from dataclasses import dataclass
from fractions import Fraction
from functools import cached_property
from math import acos, cos, floor, log10, pi
from typing import TYPE_CHECKING, Any

import numpy as np
from numpy.polynomial.polynomial import polyval

from zwidth.loop.energy import ROUNDING, ledger
from zwidth.loop.simulate import simulated
from zwidth.loop.trace import Trace
from zwidth.model.device import Device
from zwidth.model.device.amplifier import Ideal
from zwidth.model.environment.environment import Environment
from zwidth.model.operator import WitnessMotion
from zwidth.passivity.linear.transmission import Elastic
from zwidth.passivity.result import Result
from zwidth.passivity.scope import unit_key
from zwidth.passivity.witness.motion import REPLAYED, Motion
from zwidth.passivity.wording import size
from zwidth.quantity.exact import Exact, ends
from zwidth.quantity.text import exact_text, quantity_unit, shown

if TYPE_CHECKING:
    from numpy.typing import NDArray

    Array = NDArray[np.float64]

_TRIED = (
    *((64, 1, 4), (512, 1, 4), (64, 8, 3), (512, 8, 3), (256, 32, 2)),
    *((4096, 1, 4), (4096, 4, 3), (20000, 1, 4), (2048, 32, 2)),
)
"""Samples, pieces of each, and sines that it swells by."""

_DEPTH = 1e-3
"""How deep it goes where neither friction nor steps ask for more [m; rad]."""


@dataclass(frozen=True, repr=False)
class ReplayedMotion(Result):
    """What the hand did, and what came out in the simulator: no proof, and nothing that the checker reads."""

    _KEY = "hand_motion"
    _FORMAT = "zwidth hand motion 1"
    device: Device
    environment: Environment
    motion: Motion

    @cached_property
    def trace(self) -> Trace:
        """The touch, friction on both sides and steps of the encoder in it, the actuator ideal."""
        hand = WitnessMotion(self.motion)
        length = hand.intervals * self.device.exact("sample_period")
        return simulated(self.device, self.environment, hand, length, amplifier=Ideal())

    @cached_property
    def energy(self) -> float:
        """Energy that the hand has got out [J]; 0 where it is no more than rounding."""
        book = ledger(self.trace)
        return book.got_out if book.got_out > ROUNDING * book.moved else 0.0

    @property
    def energy_per_cycle(self) -> float:
        """All of it: no part repeats [J]."""
        return self.energy

    @property
    def stays_inside(self) -> bool:
        """Whether nothing left the surface."""
        return bool(self.trace["measured_position"].values.min() >= 0)

    @property
    def sample_period(self) -> float:
        """T [s]."""
        return float(self.device.exact("sample_period"))

    @property
    def unit(self) -> str:
        """Of positions."""
        return quantity_unit("position", self.device.motion)

    @property
    def positions(self) -> tuple[float, ...]:
        """Positions at the samples [m; rad]."""
        return tuple(map(float, self.motion.positions[:: self.motion.pieces]))

    @property
    def depth(self) -> float:
        """Deepest position [m; rad]."""
        return float(self.motion.depth)

    @property
    def peak_speed(self) -> float:
        """Largest speed [m/s; rad/s]."""
        moved = np.diff(np.array(self.motion.positions, dtype=np.float64))
        return float(abs(moved).max()) * self.motion.pieces / self.sample_period

    @property
    def peak_force(self) -> float:
        """Largest actuator force that it asked for [N; N·m]."""
        return float(abs(self.trace["actuator_force"].values).max())

    def to_dict(self) -> dict[str, Any]:
        """The motion as plain data, for `zwidth simulate`."""
        return {
            "format": self._FORMAT,
            "kind": REPLAYED,
            unit_key("sample_period"): self.sample_period,
            "energy_J": self.energy,
            "pieces": self.motion.pieces,
            unit_key("position", self.device.motion).replace("position", "positions"): [
                exact_text(x) for x in self.motion.positions
            ],
        }

    saved = to_dict

    def describe(self) -> str:
        """The motion in a sentence."""
        return (
            f"{self.motion.samples} samples, {size(self.depth, self.peak_speed, self.unit)}, take out "
            f"{shown(self.energy, 'J')}: replayed in the simulator, not checked by the independent checker"
        )


def replayed_motion(
    device: Device, law: Environment, elastic: Elastic, cosine: Fraction | None
) -> ReplayedMotion | None:
    """The first of those tried that takes energy out in the simulator; None if none does."""
    between = device.transmission
    assert between is not None
    most = {name: Exact(ends(value)[1]) for name, value in between.parameters().items()}  # of friction
    own = between.replace(**{"handle_mass": device.mass, **most})  # it plays no part: any mass will do
    device = device.replace(transmission=own)
    ideal = device.replace(
        coulomb_friction=0, stiction=None, resolution=0, transmission=own.replace(handle_coulomb_friction=0)
    )
    for path, pieces in _paths(elastic, cosine, law.unilateral):
        size = _DEPTH / abs(path).max()
        path = path[: _best_end(_replay(ideal, law, path * size, pieces)) * pieces + 1]
        if len(path) <= pieces or not (free := _replay(ideal, law, path * size, pieces)).energy:
            continue
        size *= max(1.0, 2 * _rubbed(device, free) / free.energy)
        for _ in range(4):
            found = _replay(device, law, path * size, pieces)
            if found.energy and (found.stays_inside or not law.unilateral):
                return found
            size *= 4
    return None


def _best_end(free: ReplayedMotion) -> int:
    """The sample by which most has come out, before anything leaves the surface."""
    outside = free.trace["measured_position"].values < 0
    until = int(np.argmax(outside)) if free.environment.unilateral and outside.any() else len(outside)
    return int(np.argmin(free.trace["hand_work"].values[:until]))


def _replay(device: Device, law: Environment, path: Array, pieces: int) -> ReplayedMotion:
    digits = 8 - floor(log10(abs(path).max()))
    places = tuple(Fraction(f"{x:.{max(digits, 0)}f}") for x in path)
    return ReplayedMotion(device, law, Motion(places, pieces=pieces))


def _rubbed(device: Device, free: ReplayedMotion) -> float:
    """What Coulomb friction on both sides takes from a motion, about [J]."""
    own, trace = device.transmission, free.trace
    assert own is not None
    sides = (device.coulomb_friction, "motor_position"), (own.handle_coulomb_friction, "position")
    return sum(
        float(f.fraction) * float(abs(np.diff(trace[name].values)).sum())
        for f, name in sides
        if isinstance(f, Exact)
    )


def _paths(elastic: Elastic, cosine: Fraction | None, inside: bool) -> Iterator[tuple[Array, int]]:
    """Positions at the ends of all pieces, from 0, and how many pieces a sample has."""
    ringing = np.linalg.eigvals(_sample(elastic, 1)[0])
    own = abs(float(np.angle(ringing[np.argmax(abs(ringing))])))
    angles = [own] if cosine is None else [_middle(elastic, float(cosine)), own]
    for samples, pieces, sines in _TRIED:
        sample = _sample(elastic, pieces)
        least, speeds = _least(sample, samples, pieces, sines, angles if pieces == 1 else angles[:1])
        if least < 0:
            yield (_pressed(elastic, sample, speeds) if inside else _summed(speeds)), pieces


def _middle(elastic: Elastic, cosine: float) -> float:
    """The middle of the angles at which the criterion is violated, about."""
    whole = [int(c) for c in elastic.polynomial[0].coeffs()]
    largest = max(map(abs, whole))
    p, start, ends = [c / largest for c in whole], acos(cosine), []
    for side in (-1, 1):
        step = 1e-7
        while 0 < start + side * step < pi and polyval(cos(start + side * step), p) < 0:
            step *= 1.2
        ends.append(min(max(start + side * step, 0.0), pi))
    return sum(ends) / 2


def _sample(elastic: Elastic, pieces: int) -> tuple[Array, Array, Array, Array]:
    """A, B, C and D, with T = 1: of x₁, v₁, x₂, what the law keeps, and the forces on their way."""
    from scipy.linalg import expm  # scipy takes its time

    loop, t, k = elastic.loop, float(elastic.loop.period), float(elastic.stiffness)
    m, h = float(elastic.mass) / t**2, float(elastic.handle_damping) / t
    b, c = float(loop.damping) / t, float(elastic.damping) / t
    whole, part = loop.whole_delay, float(loop.part_delay)
    order = max(len(loop.numerator), len(loop.denominator)) - 1
    n, d = (
        np.array([float(Fraction(x, loop.denominator[0])) for x in a] + [0.0] * (order + 1 - len(a)))
        for a in (loop.numerator, loop.denominator)
    )
    one = np.eye(order + whole + 4 + pieces)
    body, kept, sent, speeds = np.split(one, (3, 3 + order, order + whole + 4))
    newest = body[2 if elastic.at_handle else 0] - d[1:] @ kept
    forces = np.vstack([n[0] * newest + n[1:] @ kept, sent])
    rates = np.zeros((6, 6))  # x₁, v₁, x₂, its speed, the force, and the impulse of the hand
    rates[0, 1] = rates[2, 3] = 1.0
    rates[1, :5] = np.array([-k, -b - c, k, c, -1.0]) / m
    rates[5, :4] = [-k, -c, k, c + h]
    impulses = np.zeros((pieces, len(one)))
    ends = sorted({*(np.arange(pieces + 1) / pieces), part})
    moves = {width: expm(rates * width) for width in {b - a for a, b in zip(ends, ends[1:], strict=False)}}
    for start, end in zip(ends, ends[1:], strict=False):
        piece = min(int((start + end) / 2 * pieces), pieces - 1)
        force = forces[whole + 1 if start < part else whole]
        after = moves[end - start] @ np.vstack([body, speeds[piece], force, 0 * force])
        body = after[:3]
        impulses[piece] += after[5]
    following = np.vstack([body, np.vstack([newest, kept])[:order], forces[: whole + 1]])
    size = len(following)
    return following[:, :size], following[:, size:], impulses[:, :size], impulses[:, size:]


def _least(
    sample: tuple[Array, Array, Array, Array], samples: int, pieces: int, sines: int, angles: list[float]
) -> tuple[float, Array]:
    """The least work for its speeds, and those, a row a sample."""
    a, b, c, d = sample
    k = np.arange(samples)
    swells = [np.sin(pi * (i + 1) * (k + 0.5) / samples) for i in range(sines)]
    waves = [wave for angle in angles for wave in (np.cos(angle * k), np.sin(angle * k))]
    one = np.array([swell * wave for swell in swells for wave in waves]).T
    speeds = np.einsum("kj,pq->kpjq", one, np.eye(pieces)).reshape(samples, pieces, -1)
    state, forces = np.zeros((len(a), speeds.shape[2])), np.empty_like(speeds)
    for i, v in enumerate(speeds):
        forces[i] = c @ state + d @ v
        state = a @ state + b @ v
    flat = speeds.reshape(samples * pieces, -1)
    work = flat.T @ forces.reshape(samples * pieces, -1)
    sizes, mixed = np.linalg.eigh(flat.T @ flat)
    kept = sizes > 1e-9 * sizes[-1]
    to = mixed[:, kept] / np.sqrt(sizes[kept])
    values, vectors = np.linalg.eigh(to.T @ (work + work.T) @ to)
    return float(values[0]), (flat @ (to @ vectors[:, 0])).reshape(samples, pieces)


def _summed(speeds: Array) -> Array:
    """Positions, and a sample of rest at the end."""
    path = np.concatenate([[0.0], np.cumsum(speeds) / speeds.shape[1]])
    return np.append(path, [path[-1]] * speeds.shape[1])


def _pressed(elastic: Elastic, sample: tuple[Array, Array, Array, Array], speeds: Array) -> Array:
    """Positions about a depth at which hand and reading stay inside, with a way in and one out."""
    pieces, path, low = speeds.shape[1], _summed(speeds)[: -speeds.shape[1]], 0.0
    state = np.zeros(len(sample[0]))
    for v in speeds:
        state = sample[0] @ state + sample[1] @ v
        low = min(low, state[2 if elastic.at_handle else 0])
    static = abs(float(elastic.loop.static_stiffness or 0))
    sags = 1.0 if elastic.at_handle else 1 + static / float(elastic.stiffness)
    depth = 1.25 * max(-low * sags, -path.min())
    steps = np.arange(1, max(len(speeds) // 4, 50) * pieces + 1)
    way = (1 - np.cos(pi * steps / steps[-1])) / 2
    end = depth + path[-1]
    return np.concatenate([[0.0], depth * way, depth + path[1:], end * (1 - way), [0.0] * pieces])
