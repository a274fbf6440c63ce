"""Motor, transmission and hand by another road: one sample period in the time domain, cut into pieces.

In each piece the speed of the hand's side is a straight line, and the next period is the last one times
e^{jθ}; the motor moves exactly.  What the hand puts in is a Hermitian form of the speeds: its least
eigenvalue is < 0 only where a hand gains, and the more pieces, the less above the truth.  T = 1.
"""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np
from scipy.linalg import expm
from scipy.optimize import minimize_scalar

from zwidth.passivity.linear.transmission import Elastic

Array = np.ndarray


@dataclass(frozen=True)
class Plant:
    """m, b₁, k, c and b₂ with T = 1 s; N and D ascending in 1/z; the delay in samples."""

    mass: float
    damping: float
    stiffness: float
    inside: float
    handle_damping: float
    numerator: tuple[float, ...]
    denominator: tuple[float, ...]
    delay: float
    at_handle: bool

    @classmethod
    def of(cls, elastic: Elastic) -> Plant:
        """The one that is decided, its numbers rounded."""
        loop, t = elastic.loop, elastic.loop.period
        numbers = (
            elastic.mass / t**2, loop.damping / t, elastic.stiffness,
            elastic.damping / t, elastic.handle_damping / t,
        )  # fmt: skip
        law = (tuple(map(float, part)) for part in (loop.numerator, loop.denominator))
        return cls(*map(float, numbers), *law, float(loop.whole_delay + loop.part_delay), elastic.at_handle)

    @property
    def growth(self) -> float:
        """The largest factor in a period by which something grows or decays while the hand's side is held."""
        whole, part = int(self.delay), self.delay - int(self.delay)
        early, late = (self.moved(time)[:2] for time in (part, 1 - part))
        order = max(len(self.numerator), len(self.denominator)) - 1
        n, d = (np.pad(c, (0, order + 1 - len(c))) for c in (self.numerator, self.denominator))
        # x₁, v₁; what the law keeps, in its transposed form; the forces that are on their way
        count = 2 + order + whole + 1
        step = np.zeros((count, count))
        read = np.zeros(count)
        read[0] = not self.at_handle
        force = n[0] / d[0] * read
        if order:
            force = force + np.eye(count)[2]
        for i in range(order):
            following = np.eye(count)[3 + i] if i + 1 < order else np.zeros(count)
            step[2 + i] = following + (n[i + 1] * read - d[i + 1] * force) / d[0]
        waiting = [force, *np.eye(count)[2 + order :]]  # of this sample, of the one before, …
        for i in range(whole + 1):
            step[2 + order + i] = waiting[i]
        step[:2] = late[:, :2] @ (early[:, :2] @ np.eye(2, count) + np.outer(early[:, 6], waiting[whole + 1]))
        step[:2] += np.outer(late[:, 6], waiting[whole])
        return float(max(abs(np.linalg.eigvals(step))))

    @property
    def at_rest(self) -> float:
        """The stiffness that a hand feels that has come to rest."""
        top, bottom = sum(self.numerator), sum(self.denominator)
        return top / bottom if self.at_handle else self.stiffness * top / (self.stiffness * bottom + top)

    def force(self, z: complex) -> complex:
        """H(z)."""
        return complex(np.polyval(self.numerator[::-1], 1 / z) / np.polyval(self.denominator[::-1], 1 / z))

    def moved(self, time: float) -> Array:
        """x₁, v₁, x, ∫ and ∫∫ of the cable's force after it, of x₁, v₁, x, v, 0, 0, F and v̇ before."""
        m, b, k, c = self.mass, self.damping, self.stiffness, self.inside
        rates = np.zeros((8, 8))
        rates[0, 1] = rates[2, 3] = rates[3, 7] = rates[5, 4] = 1
        rates[1] = np.array([-k, -b - c, k, c, 0, 0, -1, 0]) / m
        rates[4, :4] = [-k, -c, k, c]
        return np.asarray(expm(rates * time))[[0, 1, 2, 4, 5]]


class Lifted:
    """The form of the hand's speeds in one period: of each piece its mean, and √3 times half its rise."""

    def __init__(self, plant: Plant, pieces: int) -> None:
        self.plant = plant
        part = plant.delay - int(plant.delay)
        counts = [int(np.ceil(pieces * share)) for share in (part, 1 - part)]
        self.widths = np.repeat([part, 1 - part], counts) / np.repeat(np.maximum(counts, 1), counts)
        size = 5 + 2 * len(self.widths)
        # columns: x₁, v₁, x at the start, the force before and after it changes, the speeds
        state, self.work = np.eye(3, size), np.zeros((size - 5, size))
        moves = {width: plant.moved(width) for width in set(self.widths)}
        one, root = np.eye(size), np.sqrt(3)
        for i, width in enumerate(self.widths):
            mean, rise = one[5 + 2 * i], one[6 + 2 * i]
            inputs = [
                mean - root * rise,
                0 * mean,
                0 * mean,
                one[4 if i >= counts[0] else 3],
                2 * root / width * rise,
            ]
            after = moves[width] @ np.vstack([state, *inputs])
            state = after[:3]
            self.work[2 * i] = after[3]
            self.work[2 * i + 1] = root * (after[3] - 2 / width * after[4])
        self.state = state

    def form(self, angle: float) -> Array:
        """Of the speeds times the root of their time, at θ in (0, π]."""
        plant, count, z = self.plant, 2 * len(self.widths), np.exp(1j * angle)
        force = plant.force(z) * z ** -int(plant.delay)
        of_speeds = np.zeros((5 + count, count), complex)
        of_speeds[5:] = np.eye(count)
        of_speeds[2, ::2] = self.widths / (z - 1)
        of_start = np.zeros((5 + count, 2), complex)
        of_start[0, 0] = of_start[1, 1] = 1
        held = np.array([force / z, force])
        if plant.at_handle:
            of_speeds[3:5] = np.outer(held, of_speeds[2])
        else:
            of_start[3:5, 0] = held
        end = self.state[:2]
        start = np.linalg.solve(z * np.eye(2) - end @ of_start, end @ of_speeds)
        power = self.work @ (of_speeds + of_start @ start)
        scale = np.sqrt(np.repeat(self.widths, 2))
        power = power / np.outer(scale, scale) + plant.handle_damping * np.eye(count)
        return (power + power.conj().T) / 2

    def least(self, angle: float) -> float:
        """The least eigenvalue."""
        return float(np.linalg.eigvalsh(self.form(angle))[0])

    def worst(self, angles: int = 60) -> tuple[float, float]:
        """The least eigenvalue of all, and its θ."""
        grid = np.concatenate([np.geomspace(1e-3, 0.04, 6), np.linspace(0.05, np.pi, angles)])
        values = [self.least(angle) for angle in grid]
        i = int(np.argmin(values))
        low, high = grid[max(i - 1, 0)], grid[min(i + 1, len(grid) - 1)]
        found = minimize_scalar(self.least, bounds=(low, high), method="bounded", options={"xatol": 1e-7})
        return min((values[i], float(grid[i])), (float(found.fun), float(found.x)))

    def worst_speeds(self, angle: float, most: int = 12) -> Array:
        """Those of the least eigenvalue, as amplitudes of the frequencies θ + 2πn, n = −most … most."""
        mean, rise = np.linalg.eigh(self.form(angle))[1][:, 0].reshape(-1, 2).T / np.sqrt(self.widths)
        fine = 16
        place = (np.arange(fine) + 0.5) / fine
        times = (np.cumsum(self.widths) - self.widths)[:, None] + self.widths[:, None] * place
        speeds = (mean[:, None] + np.sqrt(3) * rise[:, None] * (2 * place - 1)) * self.widths[:, None] / fine
        turns = angle + 2 * np.pi * np.arange(-most, most + 1)
        return np.array([(speeds * np.exp(-1j * turn * times)).sum() for turn in turns])


def put_in(
    plant: Plant, handle_mass: float, angle: float, speeds: Array, periods: int, pieces: int = 40
) -> Array:
    """What a hand has put in after each period, by a force that stays the same in each piece of it.

    `speeds` of its side, amplitudes of θ + 2πn, n = −N … N, one column a motion, say the force.
    From the state in which that goes on, both masses, the cable and the law move by themselves.  Real and
    imaginary part are two motions: the sum of their work, in which what comes and goes with 2θ cancels.
    """
    m, b, k, c = plant.mass, plant.damping, plant.stiffness, plant.inside
    half, whole, part, z = len(speeds) // 2, int(plant.delay), plant.delay % 1, np.exp(1j * angle)
    s = 1j * (angle + 2 * np.pi * np.arange(-half, half + 1))[:, None]
    pull, own = k + c * s, m * s * s + (b + c) * s + k
    hold = plant.force(z) * z**-whole * (1 - 1 / z) * np.exp(-s * part) / s
    if plant.at_handle:
        reading = (speeds / s).sum(0)
    else:
        reading = (pull * speeds / s / own).sum(0) / (1 + (hold / own).sum())
    motor = (pull * speeds / s - hold * reading) / own
    force = (handle_mass * s + plant.handle_damping) * speeds + pull * (speeds / s - motor)
    rates = np.zeros((6, 6))
    rates[0, 1] = rates[2, 3] = 1
    rates[1] = np.array([-k, -b - c, k, c, -1, 0]) / m
    rates[3] = np.array([k, c, -k, -c - plant.handle_damping, 0, 1]) / handle_mass
    ends = np.unique(np.append(np.linspace(0, 1, pieces + 1), part))
    moves = [expm(rates * width)[:4] for width in np.diff(ends)]
    pushes = [(force * np.exp(s * (x + y) / 2)).sum(0) for x, y in zip(ends, ends[1:], strict=False)]

    def moved(state: Array, early: Array, late: Array, turned: complex) -> tuple[Array, Array]:
        """The state after a period, and the work in it."""
        work = np.zeros(speeds.shape[1])
        for begin, move, push in zip(ends, moves, pushes, strict=False):
            acting = np.broadcast_to(late if begin >= part else early, push.shape)
            after = move @ np.vstack([state, acting, push * turned])
            work = work + (np.conj(push * turned) * (after[2] - state[2])).real
            state = after
        return state, work

    read = 2 if plant.at_handle else 0
    nothing, none = np.zeros((4, speeds.shape[1])), np.zeros(1)
    step = np.array([moved(nothing + one[:, None], none, none, 0)[0][:, 0] for one in np.eye(4)]).T
    law = plant.force(z) * z**-whole
    step = step + np.outer(
        moved(nothing, law / z * np.ones(1), law * np.ones(1), 0)[0][:, 0], np.eye(4)[read]
    )
    state = np.linalg.solve(z * np.eye(4) - step, moved(nothing, none, none, 1)[0])
    before = range(1, len(plant.numerator) + len(plant.denominator) + whole + 2)
    readings, forces = (
        [state[read] * z**-i for i in before],
        [plant.force(z) * state[read] * z**-i for i in before],
    )
    found = [np.zeros(speeds.shape[1])]
    for period in range(periods):
        readings.insert(0, state[read])
        told = sum(n * x for n, x in zip(plant.numerator, readings, strict=False))
        told = told - sum(d * x for d, x in zip(plant.denominator[1:], forces, strict=False))
        forces.insert(0, told / plant.denominator[0])
        state, work = moved(state, forces[whole + 1], forces[whole], z**period)
        found.append(found[-1] + work)
    return np.array(found)
