"""The best moves of a hand in a rhythm: at which samples it is inside, and at which outside.

    energy out = −Σ f_k D_k − κ Σ D_k²,   κ = b/T,  D_k = x_{k+1} − x_k

is a quadratic in the moves, for f is linear in what the law remembers where the hand is inside and 0
outside.  From the last sample backward the most that can be got from a state ξ is ξᵀPξ, and the
best move is linear in ξ (Bellman; the moves are scalars, so that nothing is inverted).  Before the
first sample inside, a law fed with the position is brought to any memory s at the price κ sᵀW⁻¹s,
W the Gramian of what remembers.  All in floating point: what is found is checked elsewhere.
"""

from __future__ import annotations

from collections import deque
from collections.abc import Iterator
from dataclasses import dataclass
from functools import cached_property
from itertools import pairwise
from math import sqrt
from typing import NamedTuple

from zwidth.passivity.linear.loop import LinearLoop

Row = list[float]
Matrix = list[Row]

_ROUNDS = (1, 2, 4, 8, 16, 32)  # how often a rhythm is repeated
_LONGEST_RUN = 1500
_LARGEST_STATE = 14
_ENOUGH = 1.1  # what is got at the surface over what the way in costs, at which the search stops
_TRIED, _HOPELESS, _FEW = 3, 0.75, 4
"""Rhythms after which the search ends if the best pays for less than this share; motions tried in the end."""

_SETTLED = 1.002  # by how much more rounds must pay better to go on


@dataclass(frozen=True)
class Surface:
    """A one-sided law in floats, as the controller runs it, and b/T of the device."""

    loop: LinearLoop
    penetration: bool
    never_pulls: bool

    @cached_property
    def cost(self) -> float:
        """κ = b/T."""
        return float(self.loop.damping / self.loop.period)

    @cached_property
    def numerator(self) -> Row:
        """N over the first coefficient of D."""
        return [c / self.loop.denominator[0] for c in self.loop.numerator]

    @cached_property
    def denominator(self) -> Row:
        """D, beginning with 1."""
        return [c / self.loop.denominator[0] for c in self.loop.denominator]

    @cached_property
    def static(self) -> float:
        """H(1)."""
        return float(self.loop.static_stiffness or 0)

    def forces(self, readings: Row) -> Row:
        """The force of each sample, from rest at the first reading."""
        first, n, d = self.numerator[0], self.numerator[1:], self.denominator[1:]
        start = 0.0 if self.penetration else readings[0]
        held = self.static * start
        u_past, y_past = deque([0.0] * len(n), len(n)), deque([0.0] * len(d), len(d))
        out = []
        for q in readings:
            u = (max(q, 0.0) if self.penetration else q) - start
            y = first * u
            for c, v in zip(n, u_past, strict=True):
                y += c * v
            for c, v in zip(d, y_past, strict=True):
                y -= c * v
            u_past.appendleft(u)
            y_past.appendleft(y)
            f = y + held
            out.append(0.0 if q <= 0 or (self.never_pulls and f < 0) else f)
        return out

    def energy(self, x: Row) -> float:
        """Taken out over a motion of even moves with an ideal encoder, without Coulomb friction."""
        f, late, part = self.forces(x), self.loop.whole_delay, float(self.loop.part_delay)
        f = [0.0] * (late + 1) + f
        total = 0.0
        for k, (a, b) in enumerate(pairwise(x)):
            force = (1 - part) * f[k + 1] + part * f[k]
            total -= (b - a) * (force + self.cost * (b - a))
        return total


def rhythms(surface: Surface) -> Iterator[list[float]]:
    """Motions that gain: the first of a rhythm that gains clearly, else a few of the best."""
    model = _Model(surface)
    if model.size > _LARGEST_STATE or not model.may_be_loaded:
        return
    found: list[_Played] = []
    cycles = _cycles(surface.loop)
    for done, cycle in enumerate(cycles):
        if done == max(_TRIED, len(cycles) // 2) and max((p.pays for p in found), default=0.0) < _HOPELESS:
            return
        best = max(_played(model, cycle), key=lambda played: played.pays, default=None)
        if best is None:
            continue
        found.append(best)
        if best.pays > _ENOUGH:
            yield from _gaining(model, [best])
    found.sort(key=lambda played: -played.pays)
    yield from _gaining(model, [played for played in found[:_FEW] if 1 < played.pays <= _ENOUGH])


def _gaining(model: _Model, found: list[_Played]) -> Iterator[list[float]]:
    for played in found:
        positions = _forward(model, _way_in(model, played), played.symbols, played.gains)
        if model.surface.energy(positions) > 0:
            yield positions


def _cycles(loop: LinearLoop) -> list[str]:
    """Rhythms: T at the surface, just inside; I inside at any depth; O outside."""
    cycles = ["TO", "TOO", "TOOITO", "TIO", "IO", "ITO", "TTO", "IIO"]
    late = loop.whole_delay + (1 if loop.part_delay else 0)
    if not late:
        return cycles
    stays = [f"T{'I' * i}T" for i in range(2 * late + 1)] + ["I" * i for i in range(1, late + 3)]
    return [stay + "O" * away for away in sorted({1, late, late + 1}) for stay in stays] + cycles


class _Model:
    """ξ = (x, w_0 … w_{m−1}, pending forces): f = H(1) x + Σ c_i w_i inside; D w is the law's input.

    H(z) = H(1) + (1 − ζ) C(ζ)/D(ζ), so that w is moved by increments of what the law is fed with.
    """

    def __init__(self, surface: Surface) -> None:
        self.surface, loop = surface, surface.loop
        n, d, k = surface.numerator, surface.denominator, surface.static
        size = max(len(n), len(d))
        rest = [(n[i] if i < len(n) else 0.0) - k * (d[i] if i < len(d) else 0.0) for i in range(size)]
        running, c = 0.0, []
        for v in rest[:-1]:
            running += v
            c.append(running)
        self.back = d[1:]
        self.memory = max(len(c), len(self.back), 1)
        self.output = c + [0.0] * (self.memory - len(c))
        self.pending = loop.whole_delay + (1 if loop.part_delay else 0)
        self.size = 1 + self.memory + self.pending
        self.part = float(loop.part_delay)

    def command(self, inside: bool) -> Row:
        """f_k as a row over ξ_k."""
        if not inside:
            return [0.0] * self.size
        return [self.surface.static, *self.output, *[0.0] * self.pending]

    def applied(self, inside: bool) -> Row:
        """The mean force in the interval that follows."""
        command, first = self.command(inside), 1 + self.memory
        late = self.surface.loop.whole_delay

        def aged(age: int) -> Row:
            return command if age == 0 else [float(i == first + age - 1) for i in range(self.size)]

        newer = aged(late)
        if not self.part:
            return newer
        return [(1 - self.part) * a + self.part * b for a, b in zip(newer, aged(late + 1), strict=True)]

    def step(self, inside: bool, after: bool) -> tuple[list[list[tuple[int, float]]], Row]:
        """ξ' = A ξ + B D, the rows of A by their entries that are not 0."""
        rows: list[list[tuple[int, float]]] = [[(0, 1.0)]]
        fed = [(1 + i, -a) for i, a in enumerate(self.back) if a]
        moved = 1.0
        if self.surface.penetration:
            moved = float(after)
            if after != inside:
                fed.append((0, 1.0 if after else -1.0))
        rows.append(fed)
        rows += [[(i, 1.0)] for i in range(1, self.memory)]
        if self.pending:
            rows.append([(i, c) for i, c in enumerate(self.command(inside)) if c])
            rows += [[(1 + self.memory + i, 1.0)] for i in range(self.pending - 1)]
        return rows, [1.0, moved, *[0.0] * (self.size - 2)]

    @property
    def may_be_loaded(self) -> bool:
        """False where the memory of a law fed with the position has no Gramian to speak of."""
        return self.surface.penetration or bool(self.factor)

    @cached_property
    def response(self) -> Row:
        """1/D: what one increment leaves in w, sample by sample."""
        response, past = [], [0.0] * len(self.back)
        for k in range(_LONGEST_RUN):
            w = (1.0 if k == 0 else 0.0) - sum(a * v for a, v in zip(self.back, past, strict=True))
            past = [w, *past[:-1]] if past else past
            response.append(w)
            if k > self.memory and max(map(abs, response[-self.memory :])) < 3e-3:
                break
        return response

    @cached_property
    def factor(self) -> Matrix:
        """L of the Gramian W = L Lᵀ of (w_k … w_{k−m+1}); empty where there is none."""
        m, response = self.memory, self.response
        lags = [sum(a * b for a, b in zip(response, response[i:], strict=False)) for i in range(m)]
        return _cholesky([[lags[abs(i - j)] for j in range(m)] for i in range(m)]) or []


class _Played(NamedTuple):
    """A rhythm, from the first sample inside: its moves, the best memory and depth to begin with.

    `pays` is what is got over what the way in costs.
    """

    pays: float
    symbols: str
    gains: list[Row]
    direction: Row
    depth: float


def _played(model: _Model, cycle: str) -> Iterator[_Played]:
    """A rhythm done once, twice and more often, as long as more rounds pay better."""
    value = [[0.0] * model.size for _ in range(model.size)]
    gains: list[Row] = []
    symbols, before = "O", 0.0
    for rounds in range(_ROUNDS[-1] + 1):  # before the first, what is still pending acts outside
        ahead = cycle if rounds > 1 else cycle.rstrip("O") if rounds else "O" * model.pending
        for symbol in reversed(ahead):
            earlier = _earlier(model, value, symbol, symbols[0])
            if earlier is None:
                return
            value, symbols = earlier[0], symbol + symbols
            gains.insert(0, earlier[1])
        if rounds in _ROUNDS:
            start = _start(model, value, cycle[0])
            if start is None:
                return
            yield _Played(start[0], symbols, list(gains), *start[1:])
            if start[0] < before * _SETTLED:
                return
            before = start[0]


def _earlier(model: _Model, value: Matrix, symbol: str, after: str) -> tuple[Matrix, Row] | None:
    """P one sample before, and the move as a row over ξ; None where no move is best."""
    n, inside = model.size, symbol != "O"
    rows, b = model.step(inside, after != "O")
    weighted = [[0.0] * n for _ in range(n)]  # P'A
    for r, entries in enumerate(rows):
        for j, a in entries:
            for i in range(n):
                weighted[i][j] += value[i][r] * a
    before = [[0.0] * n for _ in range(n)]  # A'P'A
    for r, entries in enumerate(rows):
        for i, a in entries:
            row, source = before[i], weighted[r]
            for j in range(n):
                row[j] += a * source[j]
    force = model.applied(inside)
    slope = [2 * (b[0] * weighted[0][j] + b[1] * weighted[1][j]) - force[j] for j in range(n)]
    bend = model.surface.cost - sum(b[i] * value[i][j] * b[j] for i in (0, 1) for j in (0, 1))
    if after == "T":
        gain = [-1.0, *[0.0] * (n - 1)]
    elif bend <= 1e-9 * model.surface.cost:
        return None
    else:
        gain = [v / (2 * bend) for v in slope]
    for i in range(n):
        for j in range(n):
            before[i][j] += (gain[i] * slope[j] + gain[j] * slope[i]) / 2 - bend * gain[i] * gain[j]
    return before, gain


def _start(model: _Model, value: Matrix, first: str) -> tuple[float, Row, float] | None:
    """What the best beginning pays, the direction of its memory, its depth; None where no depth is best."""
    cost, m = model.surface.cost, model.memory
    if model.surface.penetration:
        return (value[0][0] + 2 * value[0][1] + value[1][1]) / cost, [], 1.0
    inner, side = [row[1 : 1 + m] for row in value[1 : 1 + m]], value[0][1 : 1 + m]
    depth = value[0][0] if first == "I" else 0.0
    if first == "I":
        if depth >= 0:
            return None
        inner = [[inner[i][j] - side[i] * side[j] / depth for j in range(m)] for i in range(m)]
    largest, direction = _largest(inner, model.factor)
    state = [sum(model.factor[i][j] * direction[j] for j in range(m)) for i in range(m)]
    x = -sum(s * v for s, v in zip(side, state, strict=True)) / depth if depth else 0.0
    return largest / cost, direction, x


def _way_in(model: _Model, played: _Played) -> Row:
    """Positions up to the first sample inside: the cheapest way to that memory, W⁻¹ s = L⁻ᵀ v for s = L v."""
    if model.surface.penetration:
        return [0.0, 1.0]
    m, response = model.memory, model.response
    padded = [*[0.0] * (m - 1), *response]
    dual = _solve_transposed(model.factor, played.direction)
    moves = [sum(dual[i] * padded[m - 1 + k - i] for i in range(m)) for k in range(len(response))]
    sign = -1.0 if played.depth < 0 or (played.depth == 0.0 and sum(moves) < 0) else 1.0
    x = [sign * played.depth]
    for move in moves:
        x.append(x[-1] - sign * move)
    return x[::-1]


def _forward(model: _Model, start: list[float], symbols: str, gains: list[Row]) -> list[float]:
    """The moves in order, each kept on its side of the surface."""
    x = list(start)
    size = max(map(abs, x))
    state = [0.0] * model.size
    fed = [max(v, 0.0) if model.surface.penetration else v for v in x]
    for before, now in pairwise(fed):
        w = now - before - sum(a * v for a, v in zip(model.back, state[1:], strict=False))
        state[1 : 1 + model.memory] = [w, *state[1 : model.memory]]
    state[0] = x[-1]
    least = 1e-6 * size
    x[-1] = max(x[-1], least)
    for symbol, after, gain in zip(symbols[:-1], symbols[1:], gains, strict=True):
        goal = state[0] + sum(k * v for k, v in zip(gain, state, strict=True))
        goal = min(goal, 0.0) if after == "O" else 0.0 if after == "T" else max(goal, 0.0)
        rows, b = model.step(symbol != "O", after != "O")
        move = goal - state[0]
        state = [sum(a * state[j] for j, a in entries) + c * move for entries, c in zip(rows, b, strict=True)]
        x.append(max(goal, least) if after != "O" else goal)
    return x


def _cholesky(a: Matrix) -> Matrix | None:
    n = len(a)
    low = [[0.0] * n for _ in range(n)]
    for i in range(n):
        for j in range(i + 1):
            v = a[i][j] - sum(low[i][k] * low[j][k] for k in range(j))
            if i == j:
                if v <= 1e-13 * a[i][i]:
                    return None
                low[i][i] = sqrt(v)
            else:
                low[i][j] = v / low[j][j]
    return low


def _solve_transposed(low: Matrix, right: Row) -> Row:
    n = len(low)
    y = list(right)
    for i in reversed(range(n)):
        y[i] = (y[i] - sum(low[k][i] * y[k] for k in range(i + 1, n))) / low[i][i]
    return y


def _largest(inner: Matrix, factor: Matrix) -> tuple[float, Row]:
    """The largest eigenvalue of Lᵀ S L and its direction, by powers of a shifted matrix."""
    n = len(inner)
    half = [[sum(inner[i][k] * factor[k][j] for k in range(n)) for j in range(n)] for i in range(n)]
    full = [[sum(factor[k][i] * half[k][j] for k in range(n)) for j in range(n)] for i in range(n)]
    shift = sqrt(sum(v * v for row in full for v in row))
    v = [1.0 + 0.1 * i for i in range(n)]
    for _ in range(60 if n > 1 else 1):
        v = [sum(a * b for a, b in zip(row, v, strict=True)) + shift * v[i] for i, row in enumerate(full)]
        norm = sqrt(sum(c * c for c in v)) or 1.0
        v = [c / norm for c in v]
    image = [sum(a * b for a, b in zip(row, v, strict=True)) for row in full]
    return sum(a * b for a, b in zip(image, v, strict=True)), v
