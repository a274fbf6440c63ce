"""Whether motor and handle move apart, on a cable, a belt or a gear, and the numbers of both sides.

    m₁ ẍ₁ = −f_a − b₁ ẋ₁ − f_c1 sgn ẋ₁ + k (x₂ − x₁) + c (ẋ₂ − ẋ₁)
    m₂ ẍ₂ =       − b₂ ẋ₂ − f_c2 sgn ẋ₂ − k (x₂ − x₁) − c (ẋ₂ − ẋ₁)

One mass and two are fitted to the same log: the log is cut into windows, in each of which the motion follows
from the actuator's force, which is known, and from where the window begins, which is fitted too.  What both
leave of the encoder's readings is compared.  Only the actuator tells the two sides apart: from the hand's
force at the handle to the motor's position the path is the same with the two sides exchanged (reciprocity),

    x₁ / f_h = (c s + k) / ((m₁ s² + b₁ s)(m₂ s² + b₂ s) + (c s + k)((m₁ + m₂) s² + (b₁ + b₂) s)) .
"""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass, replace
from math import pi, sqrt

import numpy as np
from numpy.typing import NDArray
from scipy.special import chdtri

from zwidth.data.identification.device.choice import SURE
from zwidth.data.identification.device.estimate import Estimate, student, unit_of
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

_LOGARITHM = np.array([name in ("mass", "handle_mass", "stiffness") for name in NAMES])
"""Which are fitted by their logarithm: they are above 0."""

_LIKE = {name: name.removeprefix("handle_") for name in NAMES} | {"inside": "damping"}
"""Whose unit is meant."""

ONE = 4
"""How many of them one mass has, and numbers of a state of two."""

STEPS, FINE = 4, 12
"""Of a sample, friction striking at each: while the numbers are looked for, and at the end."""

AT_ONCE = 6e-4
"""Of a sample that is gone through at once, where neither side turns [s]: a swing of 400 Hz takes four."""

FIRST, SHORT, LONG = 24, 48, 160
"""Samples of a window: short ones first, in which no start is a cycle of the swing off."""

FEW = 150
"""Windows on which starts are compared."""

MOST = 60_000
"""Samples that are used."""

STARTS = tuple(40.0 * 2 ** (eighth / 8) for eighth in range(49))
"""Frequencies at which the two may swing against each other [Hz]."""

LOST = 2
"""Times the median of what is left of a window, beyond which its beginning was not found."""

SMALL = 1e-4
"""Part of each number, and of the way of a window, by which slopes are taken."""

STILL = 12
"""Counts that a window moves at least."""

FEWEST = 24
"""Windows below which nothing is concluded."""

EXPLAINED, CLOSELY = 1.1, 1.05
"""Times the variance of an encoder's step that one mass may leave before two are tried, and two in all."""


@dataclass(frozen=True)
class TwoMasses:
    """Both sides of what gives way."""

    motor: Mapping[str, Estimate]
    """By name of a parameter of `Device`."""
    between: Mapping[str, Estimate]
    """By name of a parameter of `Transmission`."""
    both: Estimate
    """Damping of both sides, by one mass [N·s/m; N·m·s/rad]: that of one is no more."""
    explain: bool
    """True where they leave no more than the encoder's steps."""

    def relied_on(self, motor: float, inside: float, handle: float) -> float:
        """b₁ + c b₂/(c + b₂) ≥ 0, which the motor feels whatever the hand does [N·s/m; N·m·s/rad]."""
        motor, inside, handle = (max(each, 0.0) for each in (motor, inside, handle))
        return motor + (inside * handle / (inside + handle) if inside else 0.0)

    @property
    def damping(self) -> Estimate:
        """The best guess of it, its error as if the errors of all three went one way."""
        b, c, h = (max(each.value, 0.0) for each in self._three)
        weights = (1.0, (h / (c + h)) ** 2, (c / (c + h)) ** 2) if c + h else (1.0, 0.0, 0.0)
        error = sum(w * each.error for w, each in zip(weights, self._three, strict=True))
        return self.motor["damping"]._replace(value=self.relied_on(b, c, h), error=error)

    def least_damping(self, confidence: float) -> float:
        """The same of the low ends of all three, and no more than both sides have."""
        least = self.relied_on(*(each.interval(confidence)[0] for each in self._three))
        return min(least, max(self.both.interval(confidence)[0], 0.0))

    @property
    def _three(self) -> tuple[Estimate, Estimate, Estimate]:
        return self.motor["damping"], self.between["damping"], self.between["handle_damping"]

    @property
    def resonance(self) -> float:
        """At which the two swing against each other, nobody at the handle [Hz]."""
        one, other = self.motor["mass"].value, self.between["handle_mass"].value
        return sqrt(self.between["stiffness"].value * (1 / one + 1 / other)) / (2 * pi)


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
def _swing(
    whole: Array,
    flow: Array,
    strikes: Array,
    force: Array,
    late: int,
    parts: int,
    steps: int,
    begin: Array,
    found: Array,
) -> None:
    """The motor's position at each sample of each window, from the state at its beginning: a part of a sample at
    once where neither side turns in it, else in steps."""
    for w in range(begin.shape[0]):
        x, v, y, u = begin[w, 0], begin[w, 1], begin[w, 2], begin[w, 3]
        for i in range(found.shape[1]):
            found[w, i] = x
            for part in range(parts):
                first = part * steps
                f = force[w, i + 1] if first >= late else force[w, i]
                p = 1.0 if v > 0 else -1.0
                q = 1.0 if u > 0 else -1.0
                b = whole[1, 0] * x + whole[1, 1] * v + whole[1, 2] * y + whole[1, 3] * u
                b += whole[1, 4] * f + whole[1, 5] * p + whole[1, 6] * q
                d = whole[3, 0] * x + whole[3, 1] * v + whole[3, 2] * y + whole[3, 3] * u
                d += whole[3, 4] * f + whole[3, 5] * p + whole[3, 6] * q
                if v * b > 0 and u * d > 0 and (first >= late or first + steps <= late):
                    a = whole[0, 0] * x + whole[0, 1] * v + whole[0, 2] * y + whole[0, 3] * u
                    c = whole[2, 0] * x + whole[2, 1] * v + whole[2, 2] * y + whole[2, 3] * u
                    x = a + whole[0, 4] * f + whole[0, 5] * p + whole[0, 6] * q
                    y = c + whole[2, 4] * f + whole[2, 5] * p + whole[2, 6] * q
                    v, u = b, d
                else:
                    for j in range(first, first + steps):
                        f = force[w, i + 1] if j >= late else force[w, i]
                        a = flow[0, 0] * x + flow[0, 1] * v + flow[0, 2] * y + flow[0, 3] * u + flow[0, 4] * f
                        b = flow[1, 0] * x + flow[1, 1] * v + flow[1, 2] * y + flow[1, 3] * u + flow[1, 4] * f
                        c = flow[2, 0] * x + flow[2, 1] * v + flow[2, 2] * y + flow[2, 3] * u + flow[2, 4] * f
                        d = flow[3, 0] * x + flow[3, 1] * v + flow[3, 2] * y + flow[3, 3] * u + flow[3, 4] * f
                        x, y = a, c
                        v, u = _slowed(v, b, strikes[0]), _slowed(u, d, strikes[1])


@dataclass(frozen=True)
class _Fit:
    """Numbers, and the state at the beginning of every window."""

    values: Array
    begin: Array
    left: Array
    """Sum of squares that is left of each window [m²; rad²]."""
    errors: Array | None = None
    """Of the numbers, or of their logarithms: by the scatter of the windows, no less than by white noise."""

    @property
    def found(self) -> NDArray[np.bool_]:
        """Windows whose beginning was found; of some, where the motion turns, it is not."""
        return self.left <= LOST * np.median(self.left)

    @property
    def cost(self) -> float:
        """What is left, of a window that is lost no more than of the worst that is not."""
        return float(np.minimum(self.left, LOST * np.median(self.left)).sum())


@dataclass(frozen=True)
class _Windows:
    """Stretches of the log, side by side."""

    read: Array
    """Positions, a row for each [m; rad]."""
    force: Array
    """Those of the actuator, from some samples before [N; N·m]."""
    late: int
    """Steps by which the force comes after its sample, less than a sample."""
    period: float
    steps: int

    def first(self, count: int) -> _Windows:
        return replace(self, read=self.read[:count], force=self.force[:count])

    def swing(self, values: Array, begin: Array) -> Array:
        """Positions of the motor, of one mass or of two."""
        m, b, f, offset = values[:ONE]
        rates, strikes = np.zeros((7, 7)), np.array([f / m, 0.0])
        rates[0, 1], rates[1, 1], rates[1, 4] = 1.0, -b / m, -1 / m
        if values.size > ONE:
            other, damping, friction, k, c = values[ONE:]
            rates[1, :4] += np.array([-k, -c, k, c]) / m
            rates[2, 3] = 1.0
            rates[3, :4] = np.array([k, c, -k, -c - damping]) / other
            strikes[1] = friction / other
        rates[1, 5], rates[3, 6] = -strikes
        parts = next(n for n in (1, 2, 4, self.steps) if self.period / n <= AT_ONCE or n == self.steps)
        step, steps = self.period / self.steps, self.steps // parts
        flow = _exponential(rates * step)
        whole, found = np.linalg.matrix_power(flow, steps), np.empty(self.read.shape)
        _swing(
            whole, flow, strikes * step, self.force + offset, self.late, parts, steps, begin, found
        )
        return found

    def starting(self, values: Array) -> _Fit:
        """Windows that begin as their first samples move."""
        few = min(12, self.read.shape[1])
        _, v, x = np.polyfit(np.arange(few) * self.period, self.read[:, :few].T, 2)
        return self.begun(_Fit(values, np.stack([x, v, x, v], axis=1), np.full(x.size, np.inf)), 4)

    def begun(self, fit: _Fit, rounds: int) -> _Fit:
        """The same numbers with better beginnings, each window for itself."""
        begin, best, left, rest = fit.begin, fit.begin, np.full(len(fit.begin), np.inf), self.read
        for last in range(rounds + 1):
            found = self.read - self.swing(fit.values, begin)
            better = (found**2).sum(axis=1) < left
            best, rest = np.where(better[:, None], begin, best), np.where(better[:, None], found, rest)
            left = (rest**2).sum(axis=1)
            if last == rounds:
                break
            moved = self.moved(fit.values, best)
            change = _solved(moved, np.einsum("wij,wi->wj", moved, rest))
            begin = best.copy()
            begin[:, : moved.shape[2]] += np.where(better[:, None], change, change / 4)
        return _Fit(fit.values, best, left)

    def moved(self, values: Array, begin: Array) -> Array:
        """By how much positions change with the state at the beginning."""
        base, columns = self.swing(values, begin), []
        way = 10 * SMALL * float(np.median(np.ptp(self.read, axis=1)))
        speed = way / (self.read.shape[1] * self.period)
        for k, size in enumerate((way, speed, way, speed)[: 4 if values.size > ONE else 2]):
            other = begin.copy()
            other[:, k] += size
            columns.append((self.swing(values, other) - base) / size)
        return np.stack(columns, axis=2)

    def better(self, fit: _Fit, rounds: int, enough: float = 1e-5) -> _Fit:
        """Gauss and Newton, beginnings and all, as long as it becomes better."""
        damp, parts = 100 * enough, None
        for _ in range(rounds):
            parts = self._normal(fit)
            matrix, right = parts[0].sum(axis=0), parts[1].sum(axis=0)
            size = np.sqrt(np.diag(matrix)) + 1e-300
            for _ in range(6):
                scaled = matrix / np.outer(size, size) + damp * np.eye(size.size)
                step = np.linalg.solve(scaled, right / size) / size
                found = self.begun(replace(fit, values=_stepped(fit.values, step)), 2 if enough > 1e-6 else 4)
                if found.cost < fit.cost:
                    break
                damp *= 10
            else:
                break
            gain, fit, damp = 1 - found.cost / fit.cost, found, max(damp / 100, 1e-12)
            if gain < enough:
                break
        assert parts is not None
        matrix = parts[0].sum(axis=0)
        size = np.sqrt(np.diag(matrix)) + 1e-300
        matrix = np.linalg.pinv(matrix / np.outer(size, size)) / np.outer(size, size)
        count, spare = len(fit.begin), self.read.shape[1] - ONE
        scatter = parts[1].T @ parts[1] * count / max(count - 1, 1)
        white = np.diag(matrix) * float(fit.left[fit.found].mean()) / spare
        return replace(fit, errors=np.sqrt(np.maximum(np.diag(matrix @ scatter @ matrix), white)))

    def _normal(self, fit: _Fit) -> tuple[Array, Array]:
        """Normal equations of each window, its beginning left free."""
        base, columns = self.swing(fit.values, fit.begin), []
        damping, friction = (float(np.abs(fit.values[at::ONE]).sum()) for at in (1, 2))
        sizes = (1, damping, friction, friction, 1, damping, friction, 1, damping)[: fit.values.size]
        for k, size in enumerate(sizes):
            step = np.zeros(fit.values.size)
            step[k] = SMALL * size
            columns.append((self.swing(_stepped(fit.values, step), fit.begin) - base) / step[k])
        slopes = np.stack(columns, axis=2) * fit.found[:, None, None]
        moved, rest = self.moved(fit.values, fit.begin), self.read - base
        across = _solved(moved, np.einsum("wij,wik->wjk", moved, slopes))
        slopes = slopes - np.einsum("wij,wjk->wik", moved, across)
        rest = rest - np.einsum("wij,wj->wi", moved, _solved(moved, np.einsum("wij,wi->wj", moved, rest)))
        return np.einsum("wij,wik->wjk", slopes, slopes), np.einsum("wij,wi->wj", slopes, rest)


def _exponential(matrix: Array) -> Array:
    """Of a small matrix, by its series and squares: that of scipy takes a hundred times as long."""
    halvings = max(0, int(np.ceil(np.log2(np.abs(matrix).sum(axis=1).max() + 1e-300))) + 2)
    small, one = matrix / 2.0**halvings, np.eye(len(matrix))
    found = one
    for term in range(12, 0, -1):
        found = one + small @ found / term
    for _ in range(halvings):
        found = found @ found
    return found


def _solved(columns: Array, right: Array) -> Array:
    """Least squares in each window, also where a column moves nothing."""
    matrix = np.einsum("wij,wik->wjk", columns, columns)
    size = np.sqrt(np.einsum("wjj->wj", matrix)) + 1e-300
    scaled = matrix / size[:, :, None] / size[:, None, :] + 1e-10 * np.eye(size.shape[1])
    right = right[:, :, None] if right.ndim == 2 else right
    found: Array = np.linalg.solve(scaled, right / size[:, :, None]) / size[:, :, None]
    return found[:, :, 0] if found.shape[2] == 1 else found


def _stepped(values: Array, step: Array) -> Array:
    chosen = _LOGARITHM[: values.size]
    grown = values * np.exp(np.clip(np.where(chosen, step, 0.0), -1, 1))
    found: Array = np.where(chosen, grown, values + step)
    return found


def _windows(log: Log, samples: int, delay: float, steps: int = STEPS) -> _Windows:
    whole, late = divmod(round(delay * steps), steps)
    read, force, seen = [], [], 0
    for piece in pieces(log):
        x, f = piece.block.position, piece.block.actuator_force
        assert f is not None
        for at in range(whole + 1, x.size - samples + 1, samples):
            if np.ptp(x[at : at + samples]) >= STILL * log.resolution:
                read.append(x[at : at + samples])
                force.append(f[at - whole - 1 : at - whole + samples])
        seen += x.size
        if seen >= MOST:
            break
    return _Windows(np.array(read), np.array(force), late, log.sample_period, steps)


def two_masses(log: Log, one: Mapping[str, Estimate], delay: float) -> TwoMasses | None:
    """Both sides, where a log surely shows two: of the actuator's force alone, nobody at the handle.

    `one` has mass, damping and Coulomb friction of one mass; the delay is in samples.
    """
    short, long = (_windows(log, *how) for how in ((SHORT, delay), (LONG, delay, FINE)))
    if min(len(short.read), len(long.read)) < FEWEST:
        return None
    alone = short.better(short.starting(np.array([*(one[name].value for name in NAMES[: ONE - 1]), 0.0])), 6)
    if log.resolution and _per_reading(alone, SHORT - 2) <= EXPLAINED * log.resolution**2 / 12:
        return None
    few, tried = _windows(log, FIRST, delay).first(FEW), []
    m, b, f, offset = alone.values * [0.5, 0.5, 0.5, 1.0]
    for frequency in STARTS:
        start = np.array([m, b, f, offset, m, b, f, (2 * pi * frequency) ** 2 * m / 2, b / 4])
        tried.append(few.better(few.starting(start), 3))
    tried.sort(key=lambda fit: fit.cost)
    two = min((short.better(short.starting(fit.values), 12) for fit in tried[:2]), key=lambda fit: fit.cost)
    kept = alone.found & two.found
    gain = ((alone.left - two.left) / _per_reading(two, SHORT - ONE))[kept]
    reach = student(SURE, gain.size - 1) * float(gain.std()) * sqrt(gain.size)
    if gain.sum() <= max(chdtri(len(NAMES) - ONE, 1 - SURE), reach):
        return None
    fit = long.better(long.starting(two.values), 24, 1e-8)
    assert fit.errors is not None
    errors = fit.errors * np.where(_LOGARITHM, fit.values, 1.0)
    degrees = int(fit.found.sum()) - len(NAMES)
    found = {
        name: Estimate(float(value), float(error), 0.0, degrees, unit_of(_LIKE[name], log.motion))
        for name, value, error in zip(NAMES, fit.values, errors, strict=True)
        if name != "offset"
    }
    motor = {name: found.pop(name) for name in NAMES[: ONE - 1]}
    return TwoMasses(
        motor,
        {("damping" if name == "inside" else name): found[name] for name in found},
        one["damping"],
        not log.resolution or _per_reading(fit, LONG - ONE) <= CLOSELY * log.resolution**2 / 12,
    )


def _per_reading(fit: _Fit, spare: int) -> float:
    """Mean square of what is left of a reading, `spare` of them in a window [m²; rad²]."""
    return float(fit.left[fit.found].mean()) / spare
