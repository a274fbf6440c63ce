"""Every move on small grids of random numbers, beside the same conditions written once more, plainly.

A function is raised until no move takes out more than it falls; then it holds by equality at many states, and
one unit less at one of them is found there.
"""

from __future__ import annotations

from collections.abc import Callable, Iterator, Sequence
from fractions import Fraction
from functools import partial
from importlib import import_module
from itertools import product
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


PART = 1 << 16
ROOM = 4
"""Units by which roundings may move what is asked for."""


def relaxing() -> str:
    """At every level and where a move passes one: accepted only where it holds, and with some units more."""
    random = Random(15)
    told = [0, 0]
    for _ in range(2 * ROUNDS):
        reach, steps, cells = 1, random.choice((1, 2)), random.randrange(1, 4)
        histories, levels = random.choice(((1, 1), (1, 2), (1, 4), (3, 1), (3, 2), (3, 4), (9, 1), (9, 2)))
        value = whole(random, (cells, histories, levels, steps + 1), 0, 60)
        rows = whole(random, (cells, histories), -1, cells)
        both = [whole(random, (cells, levels), -6, 7) for _ in range(2)]
        pole = Fraction(random.randrange(0, 8), random.choice((8, 11)))
        start = [Fraction(random.randrange(1000), 1000) * (levels - 1) * (1 - pole) for _ in range(cells)]
        images = [[min(a + pole * i, Fraction(levels - 1)) for i in range(levels)] for a in start]
        ends = [np.array([[f(x * PART) for x in row] for row in images]) for f in (int, ceil)]
        costs = rising(random, random.randrange(1, steps + 1) + 1) + 2 * ROOM

        def deficits(value: Any, rows: Any = rows, both: Any = both, images: Any = images, costs: Any = costs,
                     steps: int = steps) -> Iterator[tuple[Fraction, tuple[Any, ...]]]:  # fmt: skip
            """By how much each condition fails, and the values that would mend it."""
            cells, histories, levels, nodes = value.shape
            for n, h in np.ndindex(cells, histories):
                row = rows[n, h]
                for n2 in reached(n, 1, cells) if row >= 0 else ():
                    then = value[n2, history(n, n2, h, 1, histories)]
                    for j, j2 in np.ndindex(nodes, nodes):
                        d = (n2 - n) * steps + j2 - j
                        if abs(d) >= len(costs):
                            continue
                        force = both[0 if d > 0 else 1][row]
                        have = [
                            Fraction(int(value[n, h, i, j] + force[i] * d + costs[abs(d)]))
                            for i in range(levels)
                        ]
                        line = images[row]
                        for i in range(levels):
                            yield _at(then[:, j2], line[i]) - have[i], ((n, h, i, j),)
                            level = int(line[i]) + 1
                            if i + 1 < levels and line[i] < level < line[i + 1]:
                                s = (level - line[i]) / (line[i + 1] - line[i])
                                lacks = int(then[level, j2]) - (1 - s) * have[i] - s * have[i + 1]
                                yield lacks, ((n, h, i, j), (n, h, i + 1, j))

        tables = rows, np.stack(both), np.stack(ends), costs, reach

        def look(value: Any, tables: Any = tables) -> bool:
            return bool(kernel("violated_relaxing")(value, *tables))

        for _ in range(TRIES):
            worst = max((lack for lack, _ in deficits(value)), default=Fraction(-99))
            found = look(value)
            if (worst > 0 and not found) or (worst <= -ROOM and found):
                return f"{found}, where {float(worst)} units are lacking"
            told[found] += 1
            if worst <= -ROOM:
                break
            for lack, states in list(deficits(value)):
                for state in states if lack > -ROOM else ():
                    value[state] += max(1, ceil((lack + ROOM) / 2))
        else:
            return "there is no such function"
    return "" if min(told) >= ROUNDS else "nothing was told apart"


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


def where_a_level_is_passed() -> str:
    """Between the images of two levels, each known to a unit: no sooner and no later than it is said, and not
    much sooner or later; of every state its own.
    """
    random, part = Random(12), 1 << 16
    images, wanted = [], []
    for state in range(300):
        at = random.randrange(1, 3) * part
        low, high = (at + sign * Fraction(random.randrange(300), 7) for sign in (-1, 1))
        images.append(((floor(low), floor(high)), (ceil(low), ceil(high))))
        if ceil(low) <= at < ceil(high) and floor(low) < at:
            wanted.append((state, at // part, (at - low) / (high - low), ceil(high) - floor(low)))
    found = storage("moves")._passing(np.array(images).transpose(1, 0, 2))
    if len(found[0]) != len(wanted):
        return f"{len(found[0])}, not {len(wanted)}"
    for below, passed, early, late, (state, level, way, width) in zip(*found, wanted, strict=True):
        if (below, passed) != (2 * state, 2 * state + level):
            return f"{below} and {passed} of state {state}"
        room = Fraction(4 * part, max(width - 2, 1)) + 2
        if not way * part - room <= early <= way * part <= late <= min(way * part + room, part):
            return f"from {early} to {late}, {float(way * part)}"
    return ""


def a_level_that_is_passed_counts() -> str:
    """Between two levels whose images lie to either side of a third one, where V is largest."""
    poles, starts, sizes = (
        (Fraction(1, 2), Fraction(3, 4)),
        (Fraction(5, 8), Fraction(7, 8)),
        (0, 4000, -4000),
    )
    for pole, start, first, second, (i, level) in product(
        poles, starts, sizes, sizes, ((0, 1), (1, 1), (2, 1), (1, 2))
    ):
        images = [min(max(level - 1 + start + pole * (k - i), Fraction(0)), Fraction(3)) for k in range(4)]
        value = np.zeros((1, 1, 4, 2), dtype=np.int64)
        value[0, 0, level, 1] = 30_000
        there = (1 - start) / pole  # the part of the way from level i to the next whose image is that level
        needed = 30_000 - (1 - there) * first - there * second
        pushed = [first if k == i else second if k == i + 1 else 0 for k in range(4)]
        for inwards, cost, right in ((True, 50, -1), (True, -50, 0), (False, 50, -1)):
            least = int(needed) + cost if inwards else 30_000 + cost
            have = [least + (force if inwards else 0) for force in pushed]
            then = [_at(value[0, 0, :, 1], image) for image in images]
            if any(h < v for h, v in zip(have, then, strict=True)):
                right = 0
            found = _from_one_cell(value, images, pushed, inwards, 30_000, least)
            if found is (right < 0):
                return f"{pole}, {start}, {first}, {second}, {i}, {level}, {cost}: {found}"
    return ""


def _from_one_cell(
    value: Any, images: Sequence[Fraction], pushed: Sequence[int], inwards: bool, stays: int, moves: int
) -> bool:
    """On a grid of one cell of one step: forces one way, and what it costs to stay and to move.

    The second row of the tables is that of the cell; of the first nothing counts.
    """
    rows, none, other = np.ones((1, 1), np.int64), np.zeros((2, len(pushed)), np.int64), [0] * len(pushed)
    own = np.array([other, pushed])
    forces = [own, none] if inwards else [none, own]
    ends = [np.array([other, [f(x * PART) for x in images]]) for f in (int, ceil)]
    costs = np.array([stays, moves])
    return bool(kernel("violated_relaxing")(value, rows, np.stack(forces), np.stack(ends), costs, 1))


LARGE = 1 << 40
"""An energy of which a part in 2¹⁶ is still some energy."""


def an_image_between_two_parts_of_a_level_counts_at_both() -> str:
    """At a third of a level V is at most what it is at one of the two 65536ths beside it."""
    for larger in (0, 1):
        value = np.zeros((1, 1, 2, 2), dtype=np.int64)
        value[0, 0, larger, 1] = LARGE
        there = Fraction(1 if larger else 2, 3) * LARGE
        beside = (LARGE >> 16) * (21846 if larger else PART - 21845)
        for least, right in ((int(there), 0), (beside - 1, 0), (beside, -1)):
            found = _from_one_cell(value, [Fraction(1, 3)] * 2, [0, 0], True, LARGE, least)
            if found is (right < 0):
                return f"{larger}, {least} of {float(there)}: {found}"
    return ""


def a_level_that_is_passed_at_once_counts() -> str:
    """The image of level 0 is half a part short of level 1, where V is largest: soon it is too little."""
    images = [1 - Fraction(1, 2 * PART) + Fraction(i, 2) for i in range(3)]
    value = np.zeros((1, 1, 3, 2), dtype=np.int64)
    value[0, 0, 1, 1] = LARGE
    pushed = [0, -(LARGE >> 1) + (1 << 27), 0]  # at level 1 there is enough for V half way to level 2
    # a part in 2¹⁶ of the way to level 1, level 1 is passed: about 2²³ are lacking there
    for least, right in ((LARGE, 0), (LARGE + (1 << 22), 0), (LARGE + (1 << 25), -1)):
        found = _from_one_cell(value, images, pushed, True, LARGE, least)
        if found is (right < 0):
            return f"{least - LARGE} more: {found}"
    return ""


def _at(values: Any, level: Fraction) -> Fraction:
    """Between two levels, on a line."""
    below = min(int(level), len(values) - 1)
    above = min(below + 1, len(values) - 1)
    return int(values[below]) + (level - below) * int(values[above] - values[below])


def two_cells_are_crossed_in_one_move() -> str:
    """From the first node to the last of three cells of one step, of a law that relaxes."""
    rows, both = np.zeros((3, 1), np.int64), np.zeros((2, 1, 1), np.int64)
    for most in (3, 4):
        value = np.zeros((3, 1, 1, 2), dtype=np.int64)
        value[2, 0, 0, 1] = value[2, 0, 0, 0] = value[1, 0, 0, 1] = value[1, 0, 0, 0] = value[0, 0, 0, 1] = 10
        costs = np.array([0, 10, 10, 10 if most == 4 else 9])
        if kernel("violated_relaxing")(value, rows, both, both, costs, 2) is not (most == 3):
            return f"{costs}"
    return ""


CHECKS = (
    two_cells_are_crossed_in_one_move,
    on_a_grid,
    in_two_parts_on_a_grid,
    in_a_table,
    on_a_line,
    relaxing,
    numbers_up_to_the_largest_that_are_exact,
    moves_that_are_longer_than_the_grid,
    where_a_level_is_passed,
    a_level_that_is_passed_counts,
    an_image_between_two_parts_of_a_level_counts_at_both,
    a_level_that_is_passed_at_once_counts,
)

CASES = [Case(check.__name__.replace("_", " "), check, "") for check in CHECKS]
