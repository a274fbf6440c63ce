"""Storage functions: single moves between any positions, and motions of hands that keep to the bounds.

Lengths are in counts, energies in J.  A move from state s at x takes out −f d less the true loss, and V,
linear between its knots, must fall by no less; no motion from rest may take out more than V was there, and no
round anything.  That is the claim itself, at random places, and none of the rules by which it is proved.
"""

from __future__ import annotations

import base64
import zlib
from collections.abc import Callable
from fractions import Fraction
from math import ceil
from typing import Any, NamedTuple

import numpy as np

from ..opinion import Opinion, agrees, cannot_say, false, first
from ..plain import entry, exact, exacts, quantity
from .motions import board_force, memory_of

Document = dict[str, Any]
Rng = np.random.Generator
Array = np.ndarray

MOVES, STATES = 3000, 250
MOTIONS, SAMPLES = 192, 64
SLACK = 1e-9


class Board(NamedTuple):
    """The bounds of a document in counts, and its losses."""

    low: float
    high: float
    fastest: float
    count: float
    exact: Fraction
    late: int
    part: float
    period: float
    friction: tuple[Array, Array] | tuple[float, float]

    def lost(self, d: Array, share: float) -> Array:
        """Of a way in counts, in a share of a sample [J]."""
        far = np.abs(d) * self.count
        if isinstance(self.friction[0], float):
            return self.friction[0] * far + self.friction[1] / (share * self.period) * far**2
        v, f = self.friction
        speed = far / (share * self.period)
        slope = max((f[-1] - f[-2]) / (v[-1] - v[-2]), 0.0)
        force = np.where(speed > v[-1], f[-1] + slope * (speed - v[-1]), np.interp(speed, v, f))
        lowest = int(np.argmin(f))
        return far * np.where(speed <= v[lowest], f[lowest], force)


def _decoded(text: str, kind: str = "<i8") -> Array:
    return np.frombuffer(zlib.decompress(base64.b64decode(text)), dtype=kind)


def _board(document: Document, low: float, high: float, fastest: float) -> Board:
    loop = document["loop"]
    period, delay = quantity(loop, "sample_period"), quantity(loop, "delay")
    late = ceil(delay / period)
    pairs = entry(loop, "friction_curve", [])
    if pairs:
        friction: Any = tuple(np.array([float(exact(p[k])) for p in pairs]) for k in (0, 1))
    else:
        friction = (float(quantity(loop, "coulomb_friction")), float(quantity(loop, "damping")))
    part = float(delay / period - late + 1)
    count = quantity(loop, "resolution")
    return Board(low, high, fastest, float(count), count, late, part, float(period), friction)


def _storage(document: Document, rng: Rng) -> Opinion:
    domain, law = document["domain"], document["law"]
    low, high, steps = (int(exact(domain[k])) for k in ("lowest_count", "highest_count", "steps_per_count"))
    fastest = float(exact(domain["largest_move_counts"]))
    board = _board(document, low, high + 1, fastest)
    reach, memory = ceil(exact(domain["largest_move_counts"])), memory_of(law) + board.late
    unit = float(exact(document["force_unit"])) * board.count / steps
    cells, width = high - low + 1, 2 * reach + 1
    relaxes = bool(law.get("relaxing"))
    value = _decoded(document["storage"]).astype(float) * unit
    if relaxes:
        least = 0 if law["surface"] == "penetration" else low
        per = int(exact(domain["levels_per_count"]))
        value = value.reshape(cells, width**board.late, -1, steps + 1)
        wall = _Relaxing(law, board, value, low, reach, least, per)
    else:
        value = value.reshape(cells, width**memory, steps + 1)
        wall = _Plain(law, board, value, low, reach, memory)
    if value.min() < 0:
        return false("V is below 0")
    return first(_single_moves(wall, board, low, high, reach, rng), _attacked(wall, board, law, rng))


class _Plain:
    """A law of readings: states are a cell and differences of remembered readings, the newest first."""

    def __init__(self, law: Document, board: Board, value: Array, low: int, reach: int, memory: int) -> None:
        self.law, self.board, self.value, self.low, self.reach = law, board, value, low, reach
        self.memory, self.size = memory, memory_of(law) + 1
        self.known: dict[tuple[int, ...], float] = {}

    @property
    def older(self) -> int:
        """Histories of one reading less."""
        return self.value.shape[1] // (2 * self.reach + 1) if self.memory else 1

    def readings(self, n: int, h: int) -> list[int]:
        """q_k, q_{k−1}, … in counts."""
        out, width = [n], 2 * self.reach + 1
        for k in range(self.memory):
            out.append(out[-1] + h // width ** (self.memory - 1 - k) % width - self.reach)
        return out

    def forces(self, readings: list[int], level: float) -> tuple[float, float]:
        """What acts before and after the force changes in the interval."""
        late = self.board.late
        return tuple(self.force(tuple(readings[a : a + self.size])) for a in (late, max(late - 1, 0)))  # type: ignore[return-value]

    def force(self, counts: tuple[int, ...]) -> float:
        """Of some readings."""
        if counts not in self.known:
            exactly = [c * self.board.exact for c in counts]
            self.known[counts] = float(board_force(self.law, exactly, Fraction(0)))
        return self.known[counts]

    def levels(self, rng: Rng) -> float:
        """None of these has a memory of its own."""
        return 0.0

    def after(self, readings: list[int], level: float) -> float:
        """As before."""
        return 0.0

    def at(self, n: int, h: int, level: float, x: Array) -> Array:
        """V in a cell, linear between its knots."""
        return np.interp(x - n, np.linspace(0, 1, self.value.shape[2]), self.value[n - self.low, h])

    def state_after(self, n: int, h: int, then: int) -> int:
        """The history after the next reading."""
        return (n - then + self.reach) * self.older + h // (2 * self.reach + 1) if self.memory else 0

    def at_rest(self, x: Array) -> Array:
        """V of a hand that has rested there."""
        still, width = 0, 2 * self.reach + 1
        for k in range(self.memory):
            still += self.reach * width**k
        return np.array(
            [float(self.at(int(np.floor(v)), still, self.initial_state(v), np.array(v))) for v in x]
        )

    def initial_state(self, x: float) -> float:
        """What is remembered there."""
        return 0.0


class _Relaxing(_Plain):
    """Beside one spring an average of the readings; states have its level too."""

    def __init__(
        self, law: Document, board: Board, value: Array, low: int, reach: int, least: int, per: int
    ) -> None:
        super().__init__(law, board, value, low, reach, board.late)
        self.least, self.per = least, per
        self.pole = float(exact(law["relaxing"]["pole"]))

    def forces(self, readings: list[int], level: float) -> tuple[float, float]:
        count = self.board.exact
        f = float(board_force(self.law, [readings[self.board.late] * count], Fraction(level) * count))
        return f, f

    def fed(self, n: int) -> int:
        """What the average is of."""
        return max(n, 0) if self.law["surface"] == "penetration" else n

    def levels(self, rng: Rng) -> float:
        top = (self.value.shape[2] - 1) / self.per
        fine = rng.random() * top
        return self.least + (round(fine * self.per) / self.per if rng.random() < 0.4 else fine)

    def after(self, readings: list[int], level: float) -> float:
        acted = readings[self.board.late]
        if self.law.get("resets") and acted <= 0:
            return 0.0
        return self.pole * level + (1 - self.pole) * self.fed(acted)

    def at(self, n: int, h: int, level: float, x: Array) -> Array:
        place = min(max((level - self.least) * self.per, 0.0), self.value.shape[2] - 1.0)
        i = min(int(place), self.value.shape[2] - 2) if self.value.shape[2] > 1 else 0
        t = place - i
        both = self.value[n - self.low, h]
        line = both[i] * (1 - t) + (both[i + 1] * t if t else 0.0)
        return np.interp(x - n, np.linspace(0, 1, self.value.shape[3]), line)

    def initial_state(self, x: float) -> float:
        n = int(np.floor(x))
        return 0.0 if self.law.get("resets") and n <= 0 else float(self.fed(n))


def _single_moves(wall: _Plain, board: Board, low: int, high: int, reach: int, rng: Rng) -> Opinion:
    """V(s, x) ≥ −f d − loss + V(s', x') at random states and places."""
    each = MOVES // STATES
    scale = float(wall.value.max()) + 1e-300
    histories = wall.value.shape[1]
    for _ in range(STATES):
        n, h, level = int(rng.integers(low, high + 1)), int(rng.integers(histories)), wall.levels(rng)
        readings = wall.readings(n, h)
        if min(readings) < low or max(readings) > high:
            continue
        then = int(rng.integers(max(low, n - reach), min(high, n + reach) + 1))
        steps = wall.value.shape[-1] - 1
        x, goal = (k + _places(rng, each, steps) for k in (n, then))
        early, late = wall.forces(readings, level)
        after, second = wall.after(readings, level), wall.state_after(n, h, then)
        gained, allowed = _best_way(board, x, goal, early, late, rng)
        fall = wall.at(n, h, level, x) - wall.at(then, second, after, goal)
        size = scale + np.abs(gained)
        worst = int(np.argmax(np.where(allowed, (gained - fall) / size, -1.0)))
        if allowed[worst] and gained[worst] - fall[worst] > SLACK * size[worst]:
            return false(
                f"from {x[worst]:.6g} counts with readings {readings} to {goal[worst]:.6g} a move takes out "
                f"{gained[worst]:.6g} J and V falls by {fall[worst]:.6g} J"
            )
    return agrees()


def _places(rng: Rng, size: int, steps: int) -> Array:
    """In a cell: at knots, or anywhere."""
    return np.where(rng.random(size) < 0.5, rng.integers(0, steps + 1, size) / steps, rng.random(size))


def _best_way(
    board: Board, x: Array, goal: Array, early: float, late: float, rng: Rng
) -> tuple[Array, Array]:
    """What a move takes out, and whether it is slow enough; with two forces by way of a random place."""
    d = goal - x
    if board.part == 1:
        return -early * d * board.count - board.lost(d, 1.0), np.abs(d) <= board.fastest
    share = rng.random(len(x)) * 1.5 - 0.25
    turn = x + np.where(rng.random(len(x)) < 0.5, board.part, share) * d
    first_way, second_way = turn - x, goal - turn
    gained = -(early * first_way + late * second_way) * board.count
    gained -= board.lost(first_way, board.part) + board.lost(second_way, 1 - board.part)
    slow = np.abs(first_way) <= board.fastest * board.part
    return gained, slow & (np.abs(second_way) <= board.fastest * (1 - board.part))


def _attacked(wall: Any, board: Board, law: Document, rng: Rng) -> Opinion:
    """Random rounds from rest outside, or anywhere where there is no surface."""
    x, period = _hands(board, law, rng)
    taken, lost = _run(board, law, x)
    start = wall.at_rest(x[:, 0])
    sums = np.cumsum(taken, axis=1)
    over = sums.max(axis=1) - start
    worst = int(np.argmax(over / (lost.sum(axis=1) + start + 1e-300)))
    if over[worst] > SLACK * (lost[worst].sum() + start[worst]):
        return false(
            f"a motion from rest takes out {sums[worst].max():.6g} J, V is {start[worst]:.6g} J there"
        )
    if law.get("relaxing"):
        return agrees()
    gain, cost = taken[:, -period:].sum(axis=1), lost[:, -period:].sum(axis=1)
    best = int(np.argmax(gain / (cost + 1e-300)))
    if gain[best] > SLACK * cost[best] > 0:
        return false(f"a round of {period} samples takes out {gain[best]:.6g} J for {cost[best]:.6g} J lost")
    return agrees()


def _hands(board: Board, law: Document, rng: Rng) -> tuple[Array, int]:
    """Motions within the bounds that end with equal rounds, and the samples of a round."""
    period = int(rng.integers(2, 6)) + board.late
    outside = law["surface"] != "none" and not law.get("relaxing")
    lowest = board.low - (3 * board.fastest if outside else 0)
    shape = rng.uniform(lowest, board.high, (MOTIONS, period))
    edges = np.round(shape) - 10.0 ** -rng.uniform(1, 8, shape.shape) * (rng.random(shape.shape) < 0.6)
    middle = shape.mean(axis=1, keepdims=True)
    near = np.clip(shape, middle - board.fastest / 2, middle + board.fastest / 2)
    shape = np.where(
        rng.random((MOTIONS, 1)) < 0.7, np.where(rng.random((MOTIONS, 1)) < 0.6, edges, shape), near
    )
    shape = np.clip(shape, lowest, board.high * (1 - 1e-12) if board.high > 0 else board.high)
    if law["surface"] == "none":
        start = rng.uniform(board.low, board.high, MOTIONS)
    else:
        start = -rng.uniform(0, min(1.0, -board.low) if board.low < 0 else 0.0, MOTIONS) - 1e-9
        start = np.maximum(start, board.low)
    out = np.empty((MOTIONS, SAMPLES))
    out[:, 0] = start
    share = min(board.part, 1 - board.part) or 1.0
    most = board.fastest * (1.0 if board.part == 1 else 2 * share) * (1 - 1e-12)
    for k in range(1, SAMPLES):
        out[:, k] = np.clip(shape[:, k % period], out[:, k - 1] - most, out[:, k - 1] + most)
    return out, period


def _run(board: Board, law: Document, x: Array) -> tuple[Array, Array]:
    """What is taken out and lost in each interval, the whole move done evenly where two forces act."""
    size = memory_of(law) + 1
    read = np.floor(x)
    old = np.repeat(read[:, :1], size + board.late + 1, axis=1)
    padded = np.concatenate([old, read], axis=1)
    pole, first_level = 0.0, None
    if law.get("relaxing"):
        pole = float(exact(law["relaxing"]["pole"]))
        first_level = _fed(law, padded[:, 0]) * (0.0 if law.get("resets") else 1.0)
    force = np.zeros_like(padded)
    level = first_level
    for k in range(size - 1, padded.shape[1]):
        window = padded[:, k - size + 1 : k + 1][:, ::-1]
        force[:, k] = _forces(law, window, level, board.count)
        if level is not None:
            fed = _fed(law, padded[:, k])
            level = pole * level + (1 - pole) * fed
            level = np.where((padded[:, k] <= 0) & bool(law.get("resets")), 0.0, level)
    now = old.shape[1]
    moves = np.diff(x, axis=1)
    last = moves.shape[1]
    held = force[:, now - board.late : now - board.late + last]
    taken, lost = 0.0, 0.0
    for acting, share in (
        (held, board.part),
        (force[:, now - board.late + 1 : now - board.late + 1 + last], 1 - board.part),
    ):
        if share > 0:
            way = share * moves
            cost = board.lost(way, share)
            taken, lost = (
                taken - acting * way * board.count - cost,
                lost + cost + 1e-14 * np.abs(acting * way) * board.count,
            )
    return taken, lost


def _fed(law: Document, reading: Array) -> Array:
    return np.maximum(reading, 0) if law["surface"] == "penetration" else reading


def _forces(law: Document, window: Array, level: Any, count: float) -> Array:
    """Of many windows of readings at once, in counts, the newest first."""
    q = window[:, 0]
    points = entry(law, "points", [])
    if points:
        x, f = (np.array([float(exact(p[k])) for p in points]) for k in (0, 1))
        out = np.interp(q * count, x, f)
        rate = float(exact(entry(law, "rate_per", 0)))
        if rate:
            out = out * (1 + rate * (q - window[:, 1]) * count)
    else:
        taps = np.array([float(c) for c in exacts(entry(law, "taps"))])
        out = _fed(law, window) @ taps * count
        if level is not None:
            out = out + float(quantity(law["relaxing"], "stiffness")) * (_fed(law, q) - level) * count
    out = np.maximum(out, 0) if law["clamped"] else out
    step, limit = entry(law, "force_step"), entry(law, "force_limit")
    if step is not None:
        out = np.floor(out / float(exact(step)) + 0.5 + 1e-12) * float(exact(step))
    out = out if limit is None else np.clip(out, -float(exact(limit)), float(exact(limit)))
    return out if law["surface"] == "none" else np.where(q <= 0, 0.0, out)


class _Corners(NamedTuple):
    """V on cells of many counts, where a hand has rested: at the corners outside, or anywhere."""

    value: Array
    low: int
    cell: float
    still: int

    def at_rest(self, x: Array) -> Array:
        """The larger of both corners beside y = x − 1 count."""
        place = (x - 1) / self.cell - self.low
        below = np.clip(np.floor(place).astype(int), 0, len(self.value) - 1)
        above = np.clip(np.ceil(place).astype(int), 0, len(self.value) - 1)
        return np.maximum(self.value[below, self.still], self.value[above, self.still])


def _coarse(document: Document, rng: Rng) -> Opinion:
    domain, law = document["domain"], document["law"]
    low, high = (int(exact(domain[k])) for k in ("lowest_cell", "highest_cell"))
    cell, fastest = (float(exact(domain[k])) for k in ("counts_per_cell", "largest_move_cells"))
    board = _board(document, low * cell + 1, high * cell + 1, fastest * cell)
    sheets = law["surface"] != "none"
    memory, reach = memory_of(law) + board.late, ceil(exact(domain["largest_move_cells"])) + sheets
    width = 2 * reach + 1
    value = (
        _decoded(document["storage"]).astype(float)
        * float(exact(document["force_unit"]))
        * cell
        * board.count
    )
    value = value.reshape(-1, width**memory)
    if value.min() < 0:
        return false("V is below 0")
    still = sum(reach * width**k for k in range(memory))
    return _attacked(_Corners(value, low, cell, still), board, law, rng)


def _row(document: Document, rng: Rng) -> Opinion:
    """Single moves from every state of the table, at knots and between."""
    domain, table = document["domain"], document["table"]
    low, high, steps = (int(exact(domain[k])) for k in ("lowest_count", "highest_count", "steps_per_count"))
    fastest, states = exact(domain["largest_move_counts"]), int(exact(table["states"]))
    reach = ceil(fastest)
    board = _board(document, low, high + 1, float(fastest))
    counts, forces = _decoded(table["counts"]), _decoded(table["forces"], "<f8")
    then = _decoded(table["successors"]).reshape(states, 2 * reach + 1)
    value = _decoded(document["storage"]).reshape(states, steps + 1) * (
        float(exact(document["force_unit"])) * board.count / steps
    )
    if value.min() < 0 or len(counts) != states:
        return false("V is below 0, or the table has not one count for each state")
    s = rng.integers(0, states, MOVES)
    move = rng.integers(0, 2 * reach + 1, MOVES)
    goal = then[s, move]
    on_board = (counts[s] + move - reach >= low) & (counts[s] + move - reach <= high)
    if (on_board != (goal >= 0)).any() or (
        counts[goal[on_board]] != (counts[s] + move - reach)[on_board]
    ).any():
        return false("a reading leads to a state of another one")
    x, y = _places(rng, MOVES, steps), _places(rng, MOVES, steps)
    d = move - reach + y - x
    gained = -forces[s] * d * board.count - board.lost(d, 1.0)
    fall = _in_cell(value[s], x) - _in_cell(value[np.maximum(goal, 0)], y)
    size = float(value.max()) + np.abs(gained) + 1e-300
    over = np.where(on_board & (np.abs(d) <= board.fastest), (gained - fall) / size, -1.0)
    worst = int(np.argmax(over))
    if over[worst] > SLACK:
        return false(
            f"from state {s[worst]} a move takes out {gained[worst]:.6g} J, V falls by {fall[worst]:.6g} J"
        )
    return agrees()


def _in_cell(rows: Array, x: Array) -> Array:
    steps = rows.shape[1] - 1
    i = np.minimum((x * steps).astype(int), steps - 1)
    t, at = x * steps - i, np.arange(len(rows))
    return rows[at, i] * (1 - t) + rows[at, i + 1] * t


def _checked(judge: Callable[[Document, Rng], Opinion]) -> Callable[[Document, Rng], Opinion]:
    def judged(document: Document, rng: Rng) -> Opinion:
        if quantity(document["loop"], "delay") / quantity(document["loop"], "sample_period") > 20:
            return cannot_say("the delay is longer than is looked at")
        return judge(document, rng)

    return judged


JUDGES: dict[str, Callable[[Document, Rng], Opinion]] = {
    "storage": _checked(_storage),
    "coarse storage": _checked(_coarse),
    "row storage": _checked(_row),
}
