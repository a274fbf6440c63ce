"""One mass or two fitted to a log by what an observer does not foresee of it.

    e_i = read_i − x₁,   (x₁, v₁, x₂, v₂) += K e_i,   and on to the next sample by the law of motion

K is Kalman's, of steps of the encoder and of a force on both sides that nobody knows, `loose` times what
is applied.  The sum of e² is least near the true numbers, whatever K is (prediction errors; Ljung 1999).  A
loose observer forgets within a few samples: no start is a cycle of the swing off, and a motion that sticks
costs little.  A tight one knows more.
"""

from __future__ import annotations

from dataclasses import dataclass, replace
from math import ceil, log2

import numpy as np

from zwidth.data.identification.device.moments import pieces
from zwidth.data.logs import Log
from zwidth.native.compiled import Array, compiled

NAMES = (
    "mass",
    "damping",
    "coulomb_friction",
    "offset",
    "handle_mass",
    "handle_damping",
    "handle_coulomb_friction",
    "stiffness",
    "inside",
)
"""θ: of the motor's side, what the force has besides, of the handle's side, k and c."""

LOGARITHM = np.array([name in ("mass", "handle_mass", "stiffness") for name in NAMES])
"""Which are fitted by their logarithm: they are above 0."""

_FREE = np.array([name == "offset" for name in NAMES]) | LOGARITHM
"""Which have no lower end; the others are ≥ 0."""

ONE = 4
"""How many of them one mass has, and numbers of a state of two."""

FINE = 31e-6
"""Of the motion where a side turns, friction striking at each step [s]."""

AT_ONCE = 6e-4
"""Of a sample that is gone through at once, where neither side turns [s]: a swing of 400 Hz takes four."""

SKIPPED = 100
"""Samples until an observer has found the motion."""

SMALL = 1e-4
"""Part of each number by which slopes are taken."""

LIVELY = 5e-3
"""In which a force has to change for what swings to be seen [s]."""

LEAST = 1e-9
"""Of masses and stiffness [kg, N/m; kg·m², N·m/rad]."""

OUTLYING = 4.0
"""Standard deviations beyond which a surprise counts as one of so many."""

DOUBLINGS = 12
"""Of the samples that an observer has seen."""

BLOCKS = 80
"""Stretches of the log whose scatter is the measure of uncertainty: longer than any swing."""


@compiled
def _slowed(before: float, after: float, strike: float) -> float:
    """The speed at the end of a step, friction taken from it: a motion that turns within is slowed before and
    driven less after, one that friction holds stays."""
    way = -1.0 if before < 0 or (before == 0 and after < 0) else 1.0
    before, after = way * before, way * after
    if after >= strike:
        return way * (after - strike)
    change = after - before
    if change >= -strike:
        return 0.0
    return way * (change + strike) * (1.0 - before / (strike - change))


@compiled
def _follow(
    whole: Array,
    flow: Array,
    strikes: Array,
    gain: Array,
    force: Array,
    hand: Array,
    late: int,
    parts: int,
    steps: int,
    read: Array,
    begin: Array,
    found: Array,
) -> None:
    """What is not foreseen: a part of a sample at once where neither side turns, else in steps."""
    x, v, y, u = begin[0], begin[1], begin[2], begin[3]
    for i in range(read.shape[0]):
        e = read[i] - x
        found[i] = e
        x, v, y, u = x + gain[0] * e, v + gain[1] * e, y + gain[2] * e, u + gain[3] * e
        h = hand[i]
        for part in range(parts):
            first = part * steps
            f = force[i + 1] if first >= late else force[i]
            p = 1.0 if v > 0 else -1.0
            q = 1.0 if u > 0 else -1.0
            b = whole[1, 0] * x + whole[1, 1] * v + whole[1, 2] * y + whole[1, 3] * u
            b += whole[1, 4] * f + whole[1, 5] * h + whole[1, 6] * p + whole[1, 7] * q
            d = whole[3, 0] * x + whole[3, 1] * v + whole[3, 2] * y + whole[3, 3] * u
            d += whole[3, 4] * f + whole[3, 5] * h + whole[3, 6] * p + whole[3, 7] * q
            if v * b > 0 and u * d > 0 and (first >= late or first + steps <= late):
                a = whole[0, 0] * x + whole[0, 1] * v + whole[0, 2] * y + whole[0, 3] * u
                c = whole[2, 0] * x + whole[2, 1] * v + whole[2, 2] * y + whole[2, 3] * u
                x = a + whole[0, 4] * f + whole[0, 5] * h + whole[0, 6] * p + whole[0, 7] * q
                y = c + whole[2, 4] * f + whole[2, 5] * h + whole[2, 6] * p + whole[2, 7] * q
                v, u = b, d
            else:
                for j in range(first, first + steps):
                    f = force[i + 1] if j >= late else force[i]
                    a = flow[0, 0] * x + flow[0, 1] * v + flow[0, 2] * y + flow[0, 3] * u
                    b = flow[1, 0] * x + flow[1, 1] * v + flow[1, 2] * y + flow[1, 3] * u
                    c = flow[2, 0] * x + flow[2, 1] * v + flow[2, 2] * y + flow[2, 3] * u
                    d = flow[3, 0] * x + flow[3, 1] * v + flow[3, 2] * y + flow[3, 3] * u
                    x, y = a + flow[0, 4] * f + flow[0, 5] * h, c + flow[2, 4] * f + flow[2, 5] * h
                    b += flow[1, 4] * f + flow[1, 5] * h
                    d += flow[3, 4] * f + flow[3, 5] * h
                    v, u = _slowed(v, b, strikes[0]), _slowed(u, d, strikes[1])


@dataclass(frozen=True)
class Fit:
    """Numbers, and what they leave."""

    values: Array
    left: Array
    """What was not foreseen of each reading, an outlying one cut off [m; rad]."""
    slopes: Array
    """By the numbers, or by their logarithms."""
    share: float
    """Mean square of what is left over what the observer expects of the encoder's steps."""

    @property
    def cost(self) -> float:
        """Mean square of what is left."""
        return float(np.mean(self.left**2))

    @property
    def errors(self) -> Array:
        """Of the numbers, or of their logarithms, by the scatter of stretches of the log, no less than by
        white noise (the "sandwich", clustered by stretch)."""
        matrix = self.slopes.T @ self.slopes
        size = np.sqrt(np.diag(matrix)) + 1e-100
        inverse = np.linalg.pinv(matrix / np.outer(size, size), 1e-13) / np.outer(size, size)
        scores = self.slopes * self.left[:, None]
        parts = np.stack([part.sum(axis=0) for part in np.array_split(scores, BLOCKS)])
        spread = inverse @ (parts.T @ parts) @ inverse * BLOCKS / (BLOCKS - size.size)
        found: Array = np.sqrt(np.maximum(np.diag(spread), np.diag(inverse) * self.cost))
        return found


@dataclass(frozen=True)
class Stretches:
    """What an observer sees, in one go each."""

    read: tuple[Array, ...]
    """Positions [m; rad]."""
    force: tuple[Array, ...]
    """Of the actuator, from a sample before [N; N·m]."""
    hand: tuple[Array, ...]
    """Means over each sample [N; N·m]."""
    steps: int
    """Of a sample in which a side turns: a power of 2."""
    late: int
    """Steps by which the actuator's force comes after its sample, less than a sample."""
    period: float
    step: float
    """Of the encoder [m; rad]."""

    def part(self, samples: int) -> Stretches:
        """The middle of the longest."""
        n = int(np.argmax([each.size for each in self.read]))
        at = max((self.read[n].size - samples) // 2, 0)
        cut = slice(at, at + samples)
        read, force, hand = self.read[n][cut], self.force[n][at : at + samples + 1], self.hand[n][cut]
        return replace(self, read=(read,), force=(force,), hand=(hand,))

    def shakes(self, friction: float) -> bool:
        """True where the actuator's force changes within 5 ms by more than twice this and half of itself."""
        whole = max(round(LIVELY / self.period), 1)
        changes = np.concatenate([force[whole:] - force[:-whole] for force in self.force])
        return float(np.std(changes)) > max(2 * friction, self.applied / 2)

    @property
    def applied(self) -> float:
        """Of the forces, root mean square of how they vary [N; N·m]."""
        both = [np.var(f[1:]) + np.var(h) for f, h in zip(self.force, self.hand, strict=True)]
        return float(np.sqrt(np.mean(both)))

    def rates(self, values: Array) -> Array:
        """Of x₁, v₁, x₂, v₂, by these, by the force of actuator and hand and by the ways of both sides."""
        m, b, f = values[: ONE - 1]
        rates = np.zeros((8, 8))
        rates[0, 1], rates[1, 1], rates[1, 4:7] = 1.0, -b / m, np.array([-1.0, 1.0, -f]) / m
        if values.size > ONE:
            other, damping, friction, k, c = values[ONE:]
            rates[1, :4] += np.array([-k, -c, k, c]) / m
            rates[1, 5], rates[2, 3] = 0.0, 1.0
            rates[3] = np.array([k, c, -k, -c - damping, 0.0, 1.0, 0.0, -friction]) / other
        return rates

    def gain(self, values: Array, loose: float) -> tuple[Array, float]:
        """K, and what is expected of e² over that of the encoder's steps."""
        size = 4 if values.size > ONE else 2
        flow = exponential(self.rates(values) * self.period)[:size, :size]
        odd = self.applied * loose * self.period / (self.step / np.sqrt(12))
        scale = np.array([1.0, 1 / self.period, 1.0, 1 / self.period])[:size]
        unknown = np.array([each for m in values[::ONE][: size // 2] for each in (0.0, odd / m)]) / scale
        spread = settled(flow / scale[:, None] * scale, np.diag(unknown**2))
        gain = np.zeros(4)
        gain[:size] = scale * spread[:, 0] / (spread[0, 0] + 1)
        return gain, float(spread[0, 0] + 1)

    def left(self, values: Array, gain: Array) -> Array:
        """What is not foreseen."""
        rates = self.rates(values)
        strikes = -np.array([rates[1, 6], rates[3, 7]]) * self.period / self.steps
        parts = min(power_of_2(self.period / AT_ONCE), self.steps)
        flow, steps, late = exponential(rates * self.period / self.steps), self.steps // parts, self.late
        whole, two, kept = np.linalg.matrix_power(flow, steps), values.size > ONE, []
        for read, force, hand in zip(self.read, self.force, self.hand, strict=True):
            found, speed = np.empty(read.size), (read[8] - read[0]) / (8 * self.period)
            begin = np.array([read[0], speed, read[0] if two else 0.0, speed if two else 1.0])
            pushed = force + values[ONE - 1]
            _follow(whole, flow, strikes, gain, pushed, hand, late, parts, steps, read, begin, found)
            kept.append(found[SKIPPED:])
        return np.concatenate(kept)

    def fit(self, values: Array, loose: float, rounds: int, enough: float = 1e-5) -> Fit:
        """Gauss and Newton, as long as it becomes better."""
        damp = 1e-3
        for _ in range(rounds):
            fit, gain, far = self._seen(values, loose)
            right = fit.slopes.T @ fit.left
            free = (values > 0) | (right > 0) | _FREE[: values.size]
            slopes = fit.slopes * free
            matrix, right = slopes.T @ slopes, right * free
            size = np.sqrt(np.diag(matrix)) + 1e-100
            for _ in range(6):
                scaled = matrix / np.outer(size, size) + damp * np.eye(size.size)
                found = stepped(values, np.linalg.solve(scaled, right / size) / size)
                cost = float(np.mean(np.clip(self.left(found, gain), -far, far) ** 2))
                if cost < fit.cost:
                    break
                damp *= 10
            else:
                break
            values, damp = found, max(damp / 100, 1e-9)
            if 1 - cost / fit.cost < enough:
                break
        return self._seen(values, loose)[0]

    def _seen(self, values: Array, loose: float) -> tuple[Fit, Array, float]:
        gain, expected = self.gain(values, loose)
        base, columns = self.left(values, gain), []
        far = OUTLYING * float(np.median(np.abs(base))) / 0.6745 + self.step
        damping, friction = (float(np.abs(values[at::ONE]).sum()) + 1e-12 for at in (1, 2))
        sizes = (1, damping, friction, friction, 1, damping, friction, 1, damping)[: values.size]
        for k, size in enumerate(sizes):
            step = np.zeros(values.size)
            step[k] = SMALL * size
            columns.append((base - self.left(stepped(values, step), gain)) / step[k])
        inside = np.abs(base) < far
        left = np.clip(base, -far, far)
        share = float(np.mean(left**2)) / (expected * self.step**2 / 12)
        return Fit(values, left, np.stack(columns, axis=1) * inside[:, None], share), gain, far


def settled(flow: Array, unknown: Array) -> Array:
    """Variances before a reading, in the end, of Kalman's filter that reads the first number with a variance
    of 1: Riccati's equation by doubling (Anderson 1978)."""
    one = np.eye(len(flow))
    back, sees, spread = flow.T, np.outer(one[0], one[0]), unknown
    for _ in range(DOUBLINGS):
        less = np.linalg.inv(one + sees @ spread)
        back, sees, spread = (
            back @ less @ back,
            sees + back @ less @ sees @ back.T,
            spread + back.T @ spread @ less @ back,
        )
    return spread


def exponential(matrix: Array) -> Array:
    """Of a small matrix, by its series and squares: that of scipy takes a hundred times as long."""
    halvings = max(0, int(np.ceil(np.log2(np.abs(matrix).sum(axis=1).max() + 1e-300))) + 2)
    small, one = matrix / 2.0**halvings, np.eye(len(matrix))
    found = one
    for term in range(12, 0, -1):
        found = one + small @ found / term
    for _ in range(halvings):
        found = found @ found
    return found


def stepped(values: Array, step: Array) -> Array:
    """Other numbers, none below its end."""
    chosen = LOGARITHM[: values.size]
    grown = np.maximum(values * np.exp(np.clip(np.where(chosen, step, 0.0), -1, 1)), LEAST)
    other = np.where(_FREE[: values.size], values + step, np.maximum(values + step, 0.0))
    found: Array = np.where(chosen, grown, other)
    return found


def stretches(log: Log, delay: float, most: int) -> Stretches:
    """The log as an observer sees it, until there are so many samples; the delay is in samples."""
    steps = power_of_2(log.sample_period / FINE)
    whole, late = divmod(round(delay * steps), steps)
    read: list[Array] = []
    force: list[Array] = []
    hand: list[Array] = []
    for piece in pieces(log):
        x, f, h = piece.block.position, piece.block.actuator_force, piece.block.hand_force
        if x.size < 4 * SKIPPED:
            continue
        f, h = (np.zeros(x.size) if each is None else each for each in (f, h))
        read.append(np.ascontiguousarray(x[whole + 1 : -1]))
        force.append(np.ascontiguousarray(f[: x.size - whole - 1]))
        hand.append(np.ascontiguousarray((h[whole + 1 : -1] + h[whole + 2 :]) / 2))
        if sum(each.size for each in read) >= most:
            break
    step = log.resolution or 1e-7
    return Stretches(tuple(read), tuple(force), tuple(hand), steps, late, log.sample_period, step)


def power_of_2(least: float) -> int:
    """The next one [1]."""
    return 1 << max(ceil(log2(least)), 0)
