"""Every move on small grids of random numbers, beside the same conditions written once more, plainly.

A function is raised until no move takes out more than it falls; then it holds by equality at many states, and
one unit less at one of them is found there.
"""

from __future__ import annotations

from collections.abc import Callable, Iterator, Mapping, Sequence
from fractions import Fraction
from functools import partial
from importlib import import_module
from itertools import pairwise, product
from math import ceil, floor
from random import Random
from typing import Any

import numpy as np

from . import Case

ROUNDS = 6
LOWERED = 6
"""States of each grid that are lowered."""
TRIES = 400

Needs = Callable[[Any], dict[int, int]]
"""The least value of every state that a move from it asks for, by the values of all."""


def storage(name: str) -> Any:
    """A part of the checker, as it is loaded now."""
    return import_module(f"zwidth.checker.storage.{name}")


def kernel(name: str) -> Any:
    """Of the checker, as it is loaded now."""
    return getattr(storage("moves"), name)


def whole(random: Random, shape: Any, low: int, high: int, kind: Any = np.int64) -> Any:
    """Random whole numbers."""
    size = int(np.prod(shape))
    return np.array([random.randrange(low, high) for _ in range(size)], dtype=kind).reshape(shape)


def rising(random: Random, count: int) -> Any:
    """What a move over 0, 1, … steps costs."""
    return np.array([d * 6 + random.randrange(d * d + 1) for d in range(count)])


def compared(value: Any, needs: Needs, look: Callable[[Any], bool]) -> str:
    """What is wrong with a search for a state that fails; `value` is raised on the way."""
    flat = value.reshape(-1)
    for _ in range(TRIES):
        short = {s: v for s, v in needs(value).items() if flat[s] < v}
        if look(value) is not bool(short):
            return f"not told that {sorted(short)[:5]} fail"
        if not short:
            break
        for state, least in short.items():
            flat[state] = least
    else:
        return "there is no such function"
    needed = needs(value)
    tight = [s for s, v in needed.items() if flat[s] == v > 0]
    for state in tight[:: max(1, len(tight) // LOWERED)]:
        flat[state] -= 1
        short = {s for s, v in needs(value).items() if flat[s] < v}
        found = look(value)
        flat[state] += 1
        if found is not bool(short):
            return f"a unit less at {state}: {found}"
    return "" if tight else "nothing is tight"


def history(n: int, n2: int, h: int, reach: int, histories: int) -> int:
    """The moves that are remembered, the last one first, after one more."""
    width = 2 * reach + 1
    return (n - n2 + reach) * (histories // width) + h // width if histories > 1 else 0


def reached(n: int, reach: int, cells: int) -> range:
    """The cells of the next reading."""
    return range(max(0, n - reach), min(cells, n + reach + 1))


def grids(random: Random, memories: tuple[int, ...]) -> Iterator[tuple[int, int, int, int, Any, Any]]:
    """Cells, histories, steps and reach; a value, and which states there are."""
    for round_ in range(ROUNDS):
        reach, steps = random.choice((1, 1, 2)), random.choice((1, 2, 3))
        memory = memories[round_ % len(memories)]
        cells, histories = random.randrange(2, 5), (2 * reach + 1) ** memory
        value = whole(random, (cells, histories, steps + 1), 0, 20)
        exists = np.array([[random.random() < 0.8 for _ in range(histories)] for _ in range(cells)])
        exists[random.randrange(cells)] = True
        yield cells, histories, steps, reach, value, exists


def on_a_grid() -> str:
    """One force in each interval."""
    random = Random(11)
    for cells, histories, steps, reach, value, exists in grids(random, (0, 1, 2, 1)):
        forces = whole(random, (cells, histories), -6, 7)
        costs = rising(random, random.randrange(1, reach * steps + 1) + 1)

        def needs(
            value: Any, f: Any = forces, c: Any = costs, e: Any = exists, r: int = reach
        ) -> dict[int, int]:
            cells, histories, nodes = value.shape
            out: dict[int, int] = {}
            for n, h, j in np.ndindex(value.shape):
                for n2 in reached(n, r, cells) if e[n, h] else ():
                    for j2 in range(nodes):
                        d = (n2 - n) * (nodes - 1) + j2 - j
                        if abs(d) < len(c):
                            then = value[n2, history(n, n2, h, r, histories), j2]
                            state = (n * histories + h) * nodes + j
                            out[state] = max(out.get(state, 0), then - f[n, h] * d - c[abs(d)])
            return out

        wrong = compared(value, needs, partial(_violated, exists, [(forces, costs)], 0, reach))
        if wrong:
            return wrong
    return ""


def _violated(exists: Any, moves: Any, inside: int, reach: int, value: Any) -> bool:
    """Many states at a time, and few."""
    domain = storage("domain")
    found, most = set(), (domain.AT_ONCE, domain.ROOM)
    for domain.AT_ONCE, domain.ROOM in ((1, 1), (8, 1 << 9), most):
        found.add(kernel("violated")(value, exists, moves, inside, reach))
    (one,) = found
    return bool(one)


def in_two_parts_on_a_grid() -> str:
    """Two forces, the second of what all histories share but for the oldest reading."""
    random = Random(12)
    for cells, histories, steps, reach, value, exists in grids(random, (1, 2, 1)):
        width = 2 * reach + 1
        forces, later = (
            whole(random, (cells, histories), -6, 7),
            whole(random, (cells, histories // width), -6, 7),
        )
        second = np.repeat(later, width, axis=1)
        most = reach * steps
        costs, then = (rising(random, random.randrange(1, most + 1) + 1) for _ in range(2))

        def needs(value: Any, f: Any = forces, g: Any = later, c: Any = costs, t: Any = then, e: Any = exists,
                  r: int = reach) -> dict[int, int]:  # fmt: skip
            cells, histories, nodes = value.shape
            steps, out = nodes - 1, {}
            for n, h in np.ndindex(cells, histories):
                goal: dict[int, int] = {}
                for n2 in reached(n, r, cells):
                    for j2 in range(nodes):
                        at = n2 * steps + j2
                        goal[at] = max(goal.get(at, 0), value[n2, history(n, n2, h, r, histories), j2])
                force = g[n, h // (2 * r + 1)]
                middle = {m: _most(goal, m, force, t, goal[m]) for m in goal}
                for j in range(nodes if e[n, h] else 0):
                    out[(n * histories + h) * nodes + j] = _most(middle, n * steps + j, f[n, h], c, 0)
            return out

        wrong = compared(
            value, needs, partial(_violated, exists, [(forces, costs), (second, then)], 0, reach)
        )
        if wrong:
            return wrong
    return ""


def _most(goal: dict[int, int], start: int, force: int, costs: Any, least: int) -> int:
    """The best of all moves from one place."""
    far = {to: abs(to - start) for to in goal if abs(to - start) < len(costs)}
    return max([least, *(goal[to] - force * (to - start) - costs[d] for to, d in far.items())])


def in_a_table() -> str:
    """What follows stands in a table; −1 is off the grid."""
    random = Random(13)
    for _ in range(ROUNDS):
        states, reach, steps = random.randrange(2, 7), random.choice((1, 2)), random.choice((1, 2))
        value = whole(random, (states, steps + 1), 0, 20)
        successors, forces = whole(random, (states, 2 * reach + 1), -1, states), whole(random, states, -6, 7)
        costs = rising(random, random.randrange(1, reach * steps + 1) + 1)

        def needs(value: Any, f: Any = forces, c: Any = costs, then: Any = successors) -> dict[int, int]:
            out: dict[int, int] = {}
            nodes = value.shape[1]
            for (s, move), to in np.ndenumerate(then):
                for j, j2 in np.ndindex(nodes, nodes):
                    d = (move - then.shape[1] // 2) * (nodes - 1) + j2 - j
                    if to >= 0 and abs(d) < len(c):
                        state = s * nodes + j
                        out[state] = max(out.get(state, 0), value[to, j2] - f[s] * d - c[abs(d)])
            return out

        def look(value: Any, rest: Any = (successors, forces, costs)) -> bool:
            return bool(kernel("violated_in_table")(value, *rest))

        wrong = compared(value, needs, look)
        if wrong:
            return wrong
    return ""


def on_a_line() -> str:
    """Corners of cells, two of them at one place; one force, or two."""
    random = Random(14)
    for round_ in range(2 * ROUNDS):
        two, reach = round_ % 2 == 1, random.choice((1, 2))
        corners, histories = (
            random.randrange(3, 7),
            (2 * reach + 1) ** random.choice((1, 2) if two else (0, 1, 2)),
        )
        at = random.randrange(1, corners)
        places = np.array([*range(at), *range(at - 1, corners - 1)])
        value = whole(random, (corners, histories), 0, 20)
        exists = np.array([[random.random() < 0.8 for _ in range(histories)] for _ in range(corners)])
        exists[0] = True
        forces = [whole(random, (corners, histories), -6, 7) for _ in range(2)]
        width = 2 * reach + 1 if two else 1
        forces[1] = np.repeat(forces[1][:, ::width], width, axis=1)  # does not depend on the oldest reading
        costs = [rising(random, random.randrange(1, reach + 1) + 1) for _ in range(2)]

        def needs(value: Any, p: Any = places, f: Any = forces, c: Any = costs, e: Any = exists,
                  r: int = reach, two: bool = two) -> dict[int, int]:  # fmt: skip
            corners, histories = value.shape
            out = {}
            for n, h in np.ndindex(corners, histories):
                goal: dict[int, int] = {}
                for n2 in reached(n, r, corners):
                    best = value[n2, history(n, n2, h, r, histories)]
                    goal[int(p[n2])] = max(goal.get(int(p[n2]), 0), best)
                if two:
                    goal = {m: _most(goal, m, f[1][n, h], c[1], goal[m]) for m in goal}
                if e[n, h]:
                    out[n * histories + h] = _most(goal, int(p[n]), f[0][n, h], c[0], 0)
            return out

        moves = list(zip(forces, costs, strict=True))[: 2 if two else 1]
        corner = value.reshape(corners, histories, 1)
        wrong = compared(corner, lambda v: needs(v[:, :, 0]), partial(_violated, exists, moves, at, reach))
        if wrong:
            return f"{len(moves)}: {wrong}"
    return ""


def numbers_up_to_the_largest_that_are_exact() -> str:
    """A unit of energy counts where the largest value and force together are nearly 2⁵³."""
    violated, random = storage("moves").violated, Random(11)
    costs, exists = [0, 3, 7], np.ones((2, 1), dtype=np.bool_)
    outcomes = set()
    for _ in range(400):
        force = random.choice([1, -1]) * ((1 << 53) // 9 - random.randrange(1, 99, 2))
        value = [
            5 * abs(force) * (force < 0) + force * x + random.choice([0, 1, 1, 2, 3, 3, 4]) for x in range(6)
        ]
        places = [0, 1, 2, 2, 3, 4]
        value = [value[x] for x in places]
        value[3] = value[2]
        wrong = any(
            value[a] < value[b] - force * (places[b] - places[a]) - costs[abs(places[b] - places[a])]
            for a, b in product(range(6), repeat=2)
            if abs(places[b] - places[a]) < len(costs)
        )
        outcomes.add(wrong)
        told = np.array(value, dtype=np.int64).reshape(2, 1, 3)
        moves = [(np.full((2, 1), force), np.array(costs, dtype=object))]
        if violated(told, exists, moves, 0, 1) != wrong:
            return f"force {force}, values {value}: {wrong}"
    return "" if len(outcomes) == 2 else "all alike"


def moves_that_are_longer_than_the_grid() -> str:
    """They lead nowhere."""
    violated, exists = storage("moves").violated, np.ones((2, 1), dtype=np.bool_)
    for nodes, reach, highest in product((1, 2, 3), (1, 2, 3, 6), (0, 1, 2)):
        costs = np.arange(reach * max(1, nodes - 1) + 1).astype(object)
        value = np.zeros((2, 1, nodes), dtype=np.int64)
        value[1, 0, -1] = highest
        if violated(value, exists, [(np.zeros((2, 1), dtype=np.int64), costs)], 0, reach) != (highest > 1):
            return f"{nodes} nodes, moves of {reach} cells, {highest}"
    still, far = np.zeros((8, 1), dtype=np.int64), np.ones((8, 1), dtype=np.bool_)
    for place, last in product(((0, 0), (7, 1)), (1, 9)):  # from one end to the other, and no shorter one
        value = np.zeros((8, 1, 2), dtype=np.int64)
        value[place[0], 0, place[1]] = 5
        if violated(value, far, [(still, np.array([0, *[9] * 6, last], dtype=object))], 0, 7) != (last < 5):
            return f"the longest move, to {place}, at {last}"
    return ""


PART = 1 << 16
"""Of a level."""


def where_a_level_is_passed() -> str:
    """Between the images of three levels, each known to a unit: no sooner and no later than it is said, and
    not much sooner or later; of every state its own.
    """
    random = Random(12)
    images, wanted = [], []
    for state in range(400):
        at, parts, far = random.randrange(1, 3) * PART, random.choice((1, 7)), random.choice((7, 30, 300))
        line = [at + Fraction(k, parts) for k in sorted(random.sample(range(-far, far + 1), 3))]
        images.append(([floor(x) for x in line], [ceil(x) for x in line]))
        for i, (low, high) in enumerate(pairwise(line)):
            if low < at < high:
                wanted.append((state, i, at // PART, (at - low) / (high - low), ceil(high) - floor(low)))
    found = storage("moves")._passing(np.array(images).transpose(1, 0, 2))
    if len(found[0]) != len(wanted):
        return f"{len(found[0])}, not {len(wanted)}"
    for below, passed, early, late, (state, i, level, way, width) in zip(*found, wanted, strict=True):
        if (below, passed) != (3 * state + i, 3 * state + level):
            return f"{below} and {passed} of state {state}"
        room = Fraction(3 * PART, max(width - 2, 1)) + 1
        if not way * PART - room <= early <= way * PART <= late <= min(way * PART + room, PART):
            return f"from {early} to {late}, {float(way * PART)}"
    return ""


LARGE = 1 << 40
"""An energy of which a part in 2¹⁶ is still some energy."""


def a_level_holds_what_the_moves_to_it_pay_for() -> str:
    """One value of many is raised as far as the moves that lead there can pay for, and a unit further; and
    where nothing is stored and nothing costs anything, all is well.
    """
    random, hung = Random(16), 0
    for _ in range(80):
        reach, steps, cells, levels = (random.randrange(*ends) for ends in ((1, 4), (1, 4), (1, 5), (1, 6)))
        histories = random.choice((1, 2 * reach + 1, 9 if reach == 1 else 1))
        value = whole(random, (cells, histories, levels, steps + 1), 0, LARGE >> 12)
        rows = whole(random, (cells, histories), -1, 3)
        forces = whole(random, (2, 3, levels), -LARGE >> 12, LARGE >> 12)
        grain = random.choice((PART, 1000))
        poles = [Fraction(random.randrange(grain // 2, grain), grain) for _ in range(3)]
        starts = [Fraction(random.randrange(floor(grain * (levels - 1) * (1 - p)) + 1), grain) for p in poles]
        images = [[a + p * i for i in range(levels)] for a, p in zip(starts, poles, strict=True)]
        ends = np.array([[[f(x * PART) for x in row] for row in images] for f in (floor, ceil)])
        costs = LARGE + whole(random, random.randrange(1, (reach + 1) * (steps + 1)), 0, LARGE >> 12)
        costs[random.randrange(len(costs)) :] -= LARGE >> 2
        costs[random.randrange(len(costs))] -= LARGE >> 2
        n2, h2, j2 = (random.randrange(size) for size in (cells, histories, steps + 1))
        place = n2, h2, min(levels - 1, random.randrange(1, max(2, levels - 1))), j2
        value[place] = 0
        look = kernel("violated_relaxing")
        if look(0 * value, rows, 0 * forces, ends, 0 * costs, reach):
            return "nothing is something"
        most, passed = _most_held(value, place, rows, forces, images, costs, reach)
        hung += passed
        for given, right in ((floor(most) + 1, True), (floor(most * 511 / 512), False))[most == MORE :]:
            value[place] = given
            if look(value, rows, forces, ends, costs, reach) is not right:
                return f"{given} of {float(most)} at {place} of {value.shape}: not {right}"
    return "" if hung > 20 else f"{hung} hang on a level that is passed"


MORE = LARGE << 3
"""Than is looked for."""


def _most_held(
    value: Any, place: Any, rows: Any, forces: Any, images: Any, costs: Any, reach: int
) -> tuple[Fraction, bool]:
    """The most that may be stored at a place, of which `value` holds 0, and whether a level passed on the way
    is what bounds it.
    """
    (cells, histories, levels, nodes), (n2, h2, level, j2) = value.shape, place
    there, found = value[n2, h2, :, j2], [(Fraction(MORE), False)]

    def bound(left: Sequence[int], own: int, weights: Mapping[int, Fraction], image: Fraction) -> None:
        """Of a move from between two levels; `own` is where the place itself is moved from."""
        part = 1 - abs(image - level)
        if part > weights.get(own, 0):
            other = (1 - part) * int(there[level + (1 if image > level else -1)])
            most = sum(w * left[i] for i, w in weights.items()) - other
            found.append((most / (part - weights.get(own, 0)), len(weights) > 1))

    for n, h, j in product(range(cells), range(histories), range(nodes)):
        d = (n2 - n) * (nodes - 1) + j2 - j
        leads = abs(n2 - n) <= reach and history(n, n2, h, reach, histories) == h2
        if not leads or rows[n, h] < 0 or abs(d) >= len(costs):
            continue
        pushed, line = forces[0 if d > 0 else 1, rows[n, h]], images[rows[n, h]]
        left = [int(value[n, h, i, j] + pushed[i] * d + costs[abs(d)]) for i in range(levels)]
        own = level if (n, h, j) == (n2, h2, j2) else -1
        for i, image in enumerate(line):
            bound(left, own, {i: Fraction(1)}, image)
        for i, (low, high) in enumerate(pairwise(line)):
            if low < level < high:
                way = (level - low) / (high - low)
                bound(left, own, {i: 1 - way, i + 1: way}, Fraction(level))
    return min(found)


CHECKS = (
    on_a_grid,
    in_two_parts_on_a_grid,
    in_a_table,
    on_a_line,
    numbers_up_to_the_largest_that_are_exact,
    moves_that_are_longer_than_the_grid,
    where_a_level_is_passed,
    a_level_holds_what_the_moves_to_it_pay_for,
)

CASES = [Case(check.__name__.replace("_", " "), check, "") for check in CHECKS]
