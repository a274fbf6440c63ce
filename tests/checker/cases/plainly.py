"""The slow twin of the checks of storage functions, beside a plain search of the same moves.

On grids of a few positions a function is raised until no move takes out more than it falls.  It then holds
by equality at many places: the twin accepts it, and refuses it with one unit less at one of them.  Here all
is in metres, newtons and joules, and a place of V is found by listing the states one after the other.
"""

from __future__ import annotations

from collections.abc import Callable, Iterator, Mapping, Sequence
from fractions import Fraction
from functools import partial
from importlib import import_module
from itertools import accumulate, pairwise, product
from math import ceil
from random import Random
from struct import pack
from typing import Any, NamedTuple

from . import Case, plain, put, without
from .rotary import CASES as ROTARY
from .storage import CASES as STORAGE
from .storage import packed, unpacked

KINDS = ("storage", "coarse storage", "row storage")
TAKES = "takes out more"
ROUNDS = 200
LOWERED = 2000
"""Values looked at again, about, on each grid: the larger it is the fewer places are lowered."""


def checker(name: str) -> Any:
    """A part of the checker, as it is loaded now."""
    return import_module(f"zwidth.checker.{name}")


def told_by(document: Any) -> Any:
    """What the checker reads."""
    kinds = checker("kinds")
    told, _ = checker("document.file").read_document(kinds.fields_of(kinds.kind_of(document)), document)
    return told


def plainly(document: Any) -> tuple[bool, str]:
    """Whether the twin accepts, and what it says."""
    try:
        with checker("document.refusal").one_document():
            told = told_by(document)
            return True, checker("storage.plainly").PLAINLY[told.kind](told)
    except checker("document.refusal").Invalid as error:
        return False, str(error)


# --- the documents of the other files -----------------------------------------------------------

OTHER_WORDS = {
    "a move takes out more energy": TAKES,
    "is empty": "a state of the table is not on the grid",
    "must hold 0": "the average leaves the grid",
    "too many numbers": "without numpy at most",
    "more effort than": "without numpy at most",
}
"""What the twin says where the fast check says something else."""
FOR_ITS_NUMBERS = "too large to be compared"
ROUNDED = ("a unit less", "two frictions, sample_period_s")
"""What the fast check refuses, and the twin need not: it rounds nothing, and each triangle has its model."""


def as_the_fast_check(kind: str) -> str:
    """What the fast check accepts the twin accepts, and what it refuses for what it says the twin refuses."""
    for case in (*STORAGE, *ROTARY):
        document = plain(case.document)
        if document.get("kind") != kind or FOR_ITS_NUMBERS in case.refusal:
            continue
        if any(words in case.name for words in ROUNDED):
            continue
        valid, words = plainly(document)
        phrase = case.refusal or case.words
        if valid is bool(case.refusal) or not (phrase in words or OTHER_WORDS.get(phrase, phrase) in words):
            return f"{case.name}: {valid}, {words}"
    return ""


# --- the same conditions once more ----------------------------------------------------------------

Weights = Sequence[tuple[int, Fraction]]
"""Places of V, each times a number: between two of them V is linear."""


class Bound(NamedTuple):
    """Σ V here ≥ `gain` + Σ V then, in units of V."""

    here: Weights
    gain: Fraction
    then: Weights

    def lacks(self, value: Sequence[int]) -> Fraction:
        """By how much it fails."""
        then = sum((w * value[place] for place, w in self.then), self.gain)
        return then - sum(w * value[place] for place, w in self.here)


Condition = Sequence[Sequence[Bound]]
"""Of one of these, by model of friction, all bounds must hold."""


class Board(NamedTuple):
    """So many values, what must hold of them, and the position and readings of each for people."""

    size: int
    conditions: list[Condition]
    at: dict[int, str]
    kinks: Mapping[str, Sequence[Condition]] = {}
    """Of the conditions those between two levels of an average, by the level and by what has a kink there."""


def lacking(condition: Condition, value: Sequence[int]) -> Fraction:
    """0 or less if it holds."""
    return min(max(bound.lacks(value) for bound in way) for way in condition)


def conditions_of(
    here: Mapping[int, Weights],
    goal: Mapping[int, Sequence[Weights]],
    gains: Callable[[int, int], Sequence[Fraction] | None],
) -> Iterator[Condition]:
    """At each place one model does; of several, at all three corners of a triangle the same one."""
    moves: dict[tuple[int, int], list[list[Bound]]] = {}
    for (x, weights), (p, ends) in product(here.items(), goal.items()):
        brings = gains(x, p)
        if brings is not None:
            moves[x, p] = [[Bound(weights, gain, then) for then in ends] for gain in brings]
    yield from moves.values()
    if any(len(ways) > 1 for ways in moves.values()):
        for x, p in moves:
            for third in ((x, p + 1), (x + 1, p)):
                corners = [moves.get(corner) for corner in ((x, p), (x + 1, p + 1), third)]
                if None not in corners:
                    yield [[b for way in ways for b in way] for ways in zip(*corners, strict=True)]  # type: ignore[misc]


def distances(part: Fraction, max_move: Fraction) -> int:
    """The longest move in a part of an interval, in steps: rounded up."""
    return ceil(max_move * part)


def best_way(
    x: int,
    p: int,
    parts: Sequence[tuple[Fraction, Callable[[int], Fraction], int]],
    between: Sequence[int],
) -> Fraction | None:
    """The most that a move brings, in joules: over any place where its force changes."""
    (force, cost, far), *later = parts
    if not later:
        return None if abs(p - x) > far else -force * (p - x) - cost(abs(p - x))
    ((next_force, next_cost, next_far),) = later
    found = [
        -force * (m - x) - cost(abs(m - x)) - next_force * (p - m) - next_cost(abs(p - m))
        for m in between
        if abs(m - x) <= far and abs(p - m) <= next_far
    ]
    return max(found, default=None)


def intervals(losses: Any) -> list[tuple[int, Fraction]]:
    """How old the reading is that acts, and the part of the interval."""
    both = [(losses.delay, losses.part), (losses.delay - 1, 1 - losses.part)]
    return [(age, part) for age, part in both if part]


def lost(
    model: tuple[Fraction, Fraction], step: Fraction, time: Fraction, bend: Fraction = Fraction(0)
) -> Callable[[int], Fraction]:
    """f_c d + b/t (d² − h²/4) for two steps or more; a force that bends by κ over a step costs κ h²/4."""
    friction, damping = model

    def cost(steps: int) -> Fraction:
        d = steps * step
        if steps < 2:
            return friction * d - bend * step * step * steps
        return friction * d + damping / time * (d * d - step * step / 4) - bend * step * step / 4

    return cost


def histories(low: int, high: int, reach: int, memory: int) -> dict[tuple[int, ...], int]:
    """Readings, the newest first, and their place; those with one off the grid have a place and no use."""
    listed = product(range(low, high + 1), product(range(-reach, reach + 1), repeat=memory))
    states = [tuple(accumulate((newest, *moves))) for newest, moves in listed]
    return {s: place for place, s in enumerate(states) if all(low <= r <= high for r in s)}


def after(state: tuple[int, ...], states: Mapping[tuple[int, ...], int], reach: int) -> list[tuple[int, ...]]:
    """The states that may follow."""
    found = ((state[0] + move, *state)[: len(state)] for move in range(-reach, reach + 1))
    return [then for then in found if then in states]


def on_counts(told: Any) -> Board:
    """Each state of readings and average, each position in its cell, each that may follow."""
    parts_of_law = checker("contact.law")
    law, losses, domain = parts_of_law.law_of(told.law), parts_of_law.losses_of(told.loop), told.domain
    reach, steps = ceil(domain.largest_move_counts), domain.steps_per_count
    states = histories(domain.lowest_count, domain.highest_count, reach, law.memory + losses.delay)
    width = (2 * reach + 1) ** (law.memory + losses.delay)
    step = losses.resolution / steps
    joule = 1 / (told.force_unit * step)
    levels = levels_of(told, law)
    size = (domain.highest_count - domain.lowest_count + 1) * width * len(levels) * (steps + 1)
    conditions: list[Condition] = []
    at: dict[int, str] = {}
    kinks: dict[str, list[Condition]] = {}

    def places(state: tuple[int, ...], j: int, average: Fraction) -> Weights:
        """V at a node, between two levels."""
        k = max(i for i, level in enumerate(levels) if level <= average)
        first = (states[state] * len(levels) + k) * (steps + 1) + j
        if levels[k] == average:
            return [(first, Fraction(1))]
        share = (average - levels[k]) / (levels[k + 1] - levels[k])
        return [(first, 1 - share), (first + steps + 1, share)]

    for state, acting in ((state, state[losses.delay] * losses.resolution) for state in states):
        for average, kink in averages(levels, law, losses, acting).items():
            here = {state[0] * steps + j: places(state, j, average) for j in range(steps + 1)}
            for x, weights in here.items():
                at.update({p: f"at {x}, with the readings {', '.join(map(str, state))}," for p, _ in weights})
            goal: dict[int, list[Weights]] = {}
            for then in after(state, states, reach):
                led = law.averaged(average * losses.resolution, acting) / losses.resolution
                for j in range(steps + 1):
                    goal.setdefault(then[0] * steps + j, []).append(places(then, j, led))
            told_parts = [
                [
                    (
                        law.force(
                            [q * losses.resolution for q in state[age:][: law.memory + 1]],
                            average * losses.resolution,
                        )
                        * step,
                        lost(model, step, part * losses.period),
                        distances(part, domain.largest_move_counts * steps),
                    )
                    for age, part in intervals(losses)
                ]
                for model in losses.models
            ]
            found = list(conditions_of(here, goal, partial(gains, told_parts, list(goal), joule)))
            conditions += found
            if kink:
                kinks.setdefault(kink, []).extend(found)
    return Board(size, conditions, at, kinks)


def gains(models: Any, between: Sequence[int], joule: Fraction, x: int, p: int) -> list[Fraction] | None:
    """By model of friction, in units of V."""
    found = [best_way(x, p, parts, between) for parts in models]
    return None if None in found else [gain * joule for gain in found if gain is not None]


def levels_of(told: Any, law: Any) -> list[Fraction]:
    """Of the average, in counts: from the lowest reading, or from 0 if fed with the penetration."""
    if law.relaxing is None:
        return [Fraction(0)]
    domain = told.domain
    least = 0 if law.surface == "penetration" else domain.lowest_count
    most = max(domain.highest_count, least + 1)
    return [
        least + Fraction(i, domain.levels_per_count)
        for i in range((most - least) * domain.levels_per_count + 1)
    ]


def averages(levels: Sequence[Fraction], law: Any, losses: Any, acting: Fraction) -> dict[Fraction, str]:
    """All levels, and places between where the next average is a level, or the force changes its sign."""
    found = dict.fromkeys(levels, "")
    free = law._replace(clamped=False)
    for i, (low, high) in enumerate(pairwise(levels)):
        ends = [law.averaged(a * losses.resolution, acting) / losses.resolution for a in (low, high)]
        forces = [free.force([acting], a * losses.resolution) for a in (low, high)]
        crossed = [(*ends, level, "the next average is a level") for level in levels]
        if law.clamped:
            crossed.append((*forces, Fraction(0), "the force changes its sign"))
        for first, last, wanted, what in crossed:
            if min(first, last) < wanted < max(first, last):
                at = low + (wanted - first) / (last - first) * (high - low)
                found.setdefault(at, f"{what}, past level {i}")
    return found


def on_cells(told: Any) -> Board:
    """The ends of cells; at a surface the one at 0 twice, outside and inside."""
    parts_of_law = checker("contact.law")
    law, losses, domain = parts_of_law.law_of(told.law), parts_of_law.losses_of(told.loop), told.domain
    surface, count = law.surface != "none", losses.resolution
    outside = [(y, False) for y in range(domain.lowest_cell, 1) if surface]
    ends = outside + [(y, True) for y in range(0 if surface else domain.lowest_cell, domain.highest_cell + 1)]
    reach = ceil(domain.largest_move_cells) + surface
    states = histories(0, len(ends) - 1, reach, domain.remembered)
    cell = domain.counts_per_cell * count
    joule = 1 / (told.force_unit * cell)
    ((friction, damping),) = losses.models
    model = friction - sum(map(abs, law.taps)) * count / 2, damping
    bend = max(sum(c for c in law.taps if c > 0), -sum(c for c in law.taps if c < 0))
    conditions: list[Condition] = []
    for state, place in states.items():
        parts = []
        for age, part in intervals(losses):
            force = Fraction(0)
            for tap, corner in zip(law.taps, state[age:], strict=False):
                y, inside = ends[corner]
                if inside or law.surface == "position":
                    force += tap * (y * cell + count / 2)
            acts = force if ends[state[age]][1] else Fraction(0)
            far = distances(part, domain.largest_move_cells)
            parts.append((acts * cell, lost(model, cell, part * losses.period, bend), far))
        goal: dict[int, list[Weights]] = {}
        for then in after(state, states, reach):
            goal.setdefault(ends[then[0]][0], []).append([(states[then], Fraction(1))])
        here = {ends[state[0]][0]: [(place, Fraction(1))]}
        conditions += conditions_of(here, goal, partial(gains, [parts], list(goal), joule))
    at = {
        place: f"at {ends[state[0]][0]}, with the readings {', '.join(map(str, state))},"
        for state, place in states.items()
    }
    return Board(len(ends) * (2 * reach + 1) ** domain.remembered, conditions, at)


def in_a_table(told: Any) -> Board:
    """Each state that is listed, and each that it leads to."""
    losses, domain, table = checker("contact.law").losses_of(told.loop), told.domain, told.table
    reach, steps = ceil(domain.largest_move_counts), domain.steps_per_count
    step = losses.resolution / steps
    counts, flat = unpacked(table.counts), unpacked(table.successors)
    listed = checker("storage.domain")
    conditions: list[Condition] = []
    at = {}

    def nodes(state: int) -> dict[int, Weights]:
        first = counts[state] * steps
        return {first + j: [(state * (steps + 1) + j, Fraction(1))] for j in range(steps + 1)}

    for state, force in enumerate(listed.listed(table.forces, table.states, listed.DOUBLE)):
        goal: dict[int, list[Weights]] = {}
        for then in flat[state * (2 * reach + 1) : (state + 1) * (2 * reach + 1)]:
            for p, weights in nodes(then).items() if then >= 0 else ():
                goal.setdefault(p, []).append(weights)
        far = distances(Fraction(1), domain.largest_move_counts * steps)
        models = [[(Fraction(force) * step, lost(m, step, losses.period), far)] for m in losses.models]
        here = nodes(state)
        at.update(
            {
                weights[0][0]: f"at {j}, with the readings {counts[state]},"
                for j, weights in enumerate(here.values())
            }
        )
        conditions += conditions_of(
            here, goal, partial(gains, models, list(goal), 1 / (told.force_unit * step))
        )
    return Board(table.states * (steps + 1), conditions, at)


SEARCHES = dict(zip(KINDS, (on_counts, on_cells, in_a_table), strict=True))


def raised(conditions: Sequence[Condition], least: Sequence[int]) -> list[int] | None:
    """From the least values until all holds; nothing if it never does."""
    value = list(least)
    for _ in range(ROUNDS):
        still = True
        for condition in conditions:
            if lacking(condition, value) <= 0:
                continue
            still = False
            way = min(condition, key=lambda way: max(bound.lacks(value) for bound in way))
            for bound in way:
                short = bound.lacks(value)
                if short > 0:
                    then = dict(bound.then)
                    helps, place = max((weight - then.get(place, 0), place) for place, weight in bound.here)
                    if helps <= 0:
                        return None
                    value[place] += ceil(short / helps)
        if still:
            return value
    return None


# --- the grids ------------------------------------------------------------------------------------

UNIT = Fraction(1, 7_000_003)
PERIOD = {"sample_period_s": "1/4"}
DEVICE = {"damping_N_s_per_m": "1/20", "resolution_m": "1/10", "delay_s": 0, **PERIOD}
POINTS = [["-1/5", "-1/3"], ["1/20", "1/30"], ["1/7", "1/9"], ["2/7", "2/3"]]
CURVE = {
    "friction_curve_m_per_s_N": [[0, "3/10"], ["1/4", "1/4"], ["1/2", "2/5"], [1, "9/10"], [2, 2]],
    "friction_models_N_N_s_per_m": [["1/5", "1/5"], ["1/4", 0], [0, "4/5"]],
    "resolution_m": "1/10",
    "delay_s": 0,
    **PERIOD,
}
TWO_MODELS = {
    **CURVE,
    "friction_curve_m_per_s_N": [[0, 3], [1, 3], [2, 5]],
    "friction_models_N_N_s_per_m": [["1/4", 0], ["1/6", "4/5"]],
}
ONE_MODEL = {**CURVE, "friction_models_N_N_s_per_m": [["1/5", "1/5"]]}


def friction(newtons: Any, delay: Any = 0) -> Any:
    """A device with Coulomb friction."""
    return {**DEVICE, "coulomb_friction_N": newtons, "delay_s": delay}


def stored(kind: str, loop: Any, law: Any, domain: Any) -> Any:
    """A document without its storage function."""
    head = {"format": "zwidth certificate 1", "kind": kind, "loop": loop, "law": law, "domain": domain}
    return {**head, "force_unit": UNIT, "storage": packed([0])}


def counts(device: Any, low: int, high: int, steps: int, taps: Any, move: Any = 1, **law: Any) -> Any:
    """A grid of counts."""
    domain = {
        "lowest_count": low,
        "highest_count": high,
        "largest_move_counts": move,
        "steps_per_count": steps,
    }
    per_count = {"levels_per_count": law.pop("levels")} if "levels" in law else {}
    told = {"surface": "position", "clamped": False, "taps_N_per_m": list(taps), **law}
    return stored("storage", device, told, {**domain, **per_count})


def relaxing(pole: Any, stiffness: Any, resets: bool = False, levels: int = 1) -> Any:
    """A branch beside the spring."""
    told = {"pole": pole, "stiffness_N_per_m": stiffness}
    return {"relaxing": told, "resets": resets, "levels": levels}


def cells(
    device: Any,
    low: int,
    high: int,
    taps: Any,
    move: Any = 1,
    remembered: int = 0,
    each: Any = "3/2",
    **law: Any,
) -> Any:
    """A line of cells, each of so many counts."""
    domain = {
        "lowest_cell": low,
        "highest_cell": high,
        "counts_per_cell": each,
        "largest_move_cells": move,
        "remembered": remembered,
    }
    told = {"surface": "position", "clamped": False, "taps_N_per_m": list(taps), **law}
    return stored("coarse storage", device, told, domain)


LEADS = ((-1, 0, 1), (0, 1, 2), (1, 3, -1), (1, 3, -1))
"""From each state, for the readings one lower, the same and one higher."""


def table(
    device: Any, steps: int, move: Any = 1, force: float = 0.28125, side: int = 1, leads: Any = LEADS
) -> Any:
    """Readings −1, 0, 1, and 1 again, where the force has fallen; of the other side they are 1, 0, −1, −1."""
    forces = [side * f for f in (0.0, -0.0625, force, 0.125)]
    told = {
        "states": 4,
        "starts": [0, 1, 2, 3],
        "counts": packed([side * count for count in (-1, 0, 1, 1)]),
        "successors": packed([then for row in leads for then in row[::side]]),
        "forces": packed([int.from_bytes(pack("<d", f), "little", signed=True) for f in forces]),
    }
    domain = {"lowest_count": -1, "highest_count": 1, "largest_move_counts": move, "steps_per_count": steps}
    law = {"description": "a law in a chain", "counts_force_limit": False, "counts_force_resolution": False}
    return {**stored("row storage", device, law, domain), "table": told}


def listed_backwards(document: Any) -> Any:
    """The same states, the last one first."""
    told = document["table"]
    flat = unpacked(told["successors"])
    rows = [flat[i : i + 3] for i in range(0, len(flat), 3)]
    return put(
        document,
        {
            "table.counts": packed(unpacked(told["counts"])[::-1]),
            "table.forces": packed(unpacked(told["forces"])[::-1]),
            "table.successors": packed(
                [3 - then if then >= 0 else then for row in rows[::-1] for then in row]
            ),
        },
    )


ONE, TWO, THREE = ("7/3",), ("7/3", "-4/5"), ("1", "-2/3", "2/9")
NEITHER, FED = {"surface": "none"}, {"surface": "penetration"}
CLAMPED = {"clamped": True}
BRANCH = relaxing("1/3", "5/3")

HIGH, HIGHER = 3_000_000, 100_000_000
SEED = 2
"""With others a move of two cells in a part of a sample is nowhere the one that takes out the most."""

# with little more friction than there must be for a storage function
GRIDS = {
    "a spring": counts(friction("9/40"), 0, 2, 2, ONE),
    "a spring, of long moves": counts(friction("9/40"), -1, 2, 3, ONE, "3/2"),
    "a spring on both sides": counts(friction("9/40"), -2, 1, 2, ONE, **NEITHER),
    "a damped wall": counts(friction("7/40"), -1, 2, 2, TWO),
    "a damped wall fed with the penetration": counts(friction("7/40"), -1, 2, 2, TWO, **FED),
    "a damped wall, clamped": counts(friction("3/20"), -1, 2, 2, ("7/3", -2), **CLAMPED),
    "a law of three readings": counts(friction("3/40"), -2, 1, 1, THREE),
    "a damped wall of long moves": counts(friction("7/40"), -3, 1, 1, TWO, 2),
    "a force limit": counts(friction("1/8"), -1, 2, 1, TWO, force_limit_N="1/5"),
    "a converter": counts(friction("1/5"), 0, 2, 2, ONE, force_step_N="1/7"),
    "points": counts(friction("3/10"), -2, 3, 2, (), points_m_N=POINTS, **NEITHER),
    "points inside a surface, that grow": counts(
        friction("1/5"), -1, 2, 2, (), points_m_N=POINTS, rate_per_m="9/5"
    ),
    "a sample late": counts(friction("1/8", "1/4"), -1, 1, 2, ONE),
    "a damped wall, two samples late": counts(friction("1/8", "1/2"), -3, 1, 1, (2, -1)),
    "a third of a sample late": counts(friction("1/8", "1/12"), -1, 1, 2, ONE),
    "a damped wall, three quarters of a sample late": counts(friction("1/8", "3/16"), -2, 1, 1, TWO),
    "a sample and a third late": counts(friction("3/40", "1/3"), -2, 1, 2, ["1"], "4/5"),
    "a third of a sample late, of short moves": counts(friction("1/8", "1/12"), -1, 1, 3, ONE, "2/3"),
    "two frictions": counts(CURVE, -1, 1, 3, (4,), 2),
    "two frictions, clamped": counts(CURVE, -1, 1, 2, (4, "-4/5"), **CLAMPED),
    "a curve of one model": counts(ONE_MODEL, -1, 1, 2, ONE, 2),
    "cells": cells(friction("3/4"), -2, 3, ONE, "3/2"),
    "cells fed with the penetration": cells(friction("3/4"), -2, 2, TWO, remembered=1, **FED),
    "cells of a damped wall": cells(friction("3/4"), -2, 2, TWO, remembered=1),
    "cells of a law that falls": cells(friction("3/4"), -2, 2, (1, -2), remembered=1),
    "cells of a law that falls, of long moves": cells(friction("7/10"), -4, 2, (1, -2), 2, remembered=1),
    "cells of both sides": cells(friction("27/40"), -3, 2, ONE, 2, **NEITHER),
    "cells of both sides, the one a count longer": cells(friction("21/40"), -3, 2, ONE, 4, each=1, **NEITHER),
    "cells, a sample late": cells(friction("9/10", "1/4"), -2, 2, ONE, remembered=1),
    "cells, a third of a sample late": cells(friction("9/10", "1/12"), -2, 2, ONE, remembered=1),
    "cells, three quarters of a sample late": cells(
        friction("9/10", "3/16"), -3, 2, ONE, "3/2", remembered=1
    ),
    "cells of a damped wall, half a sample late": cells(friction("3/4", "1/8"), -3, 1, TWO, remembered=2),
    "laws in a chain": table(friction("7/40"), 2),
    "laws in a chain, of short moves": table(friction("7/40"), 3, "2/3"),
    "laws in a chain, the last listed first": listed_backwards(table(friction("7/40"), 2)),
    "laws in a chain, two frictions": table(CURVE, 2),
    "laws in a chain, two frictions, of the other side": table(CURVE, 2, side=-1),
    "a law that relaxes": counts(friction("1/4"), -1, 1, 1, ONE, **BRANCH),
    "a law that relaxes slowly": counts(friction("2/5"), -1, 1, 1, ONE, **relaxing("4/5", "5/3")),
    "a law that relaxes, clamped": counts(friction("9/40"), -1, 1, 2, ONE, **BRANCH, **CLAMPED),
    "a law that relaxes slowly, clamped": counts(
        friction("1/2"), 0, 2, 1, [1], **relaxing("3/4", 3, levels=2), **CLAMPED, **FED
    ),
    "a law that relaxes, fed with the penetration": counts(
        friction("7/20"), 0, 2, 1, ONE, **relaxing("1/3", "5/3", levels=2), **FED
    ),
    "a law that relaxes at once": counts(
        friction("13/40"), 0, 2, 1, ONE, **relaxing(0, "5/3"), **CLAMPED, **FED
    ),
    "a law that relaxes, with a branch of no stiffness": counts(
        friction("1/8"), 0, 1, 1, ONE, **relaxing("1/2", 0), **CLAMPED, **FED
    ),
    "a law that begins anew": counts(friction("3/8"), -1, 2, 1, ONE, **relaxing("1/2", "5/3", resets=True)),
    "a law that begins anew, fed with the penetration": counts(
        friction("13/20"), 0, 2, 1, ONE, **relaxing("3/4", "5/3", resets=True, levels=2), **CLAMPED, **FED
    ),
    "a law that relaxes on both sides": counts(
        friction("9/20"), -1, 1, 1, ONE, **relaxing("2/5", "5/3", levels=2), **NEITHER
    ),
    "a law that relaxes, deep inside": counts(friction("11/40"), 2, 3, 1, ONE, **BRANCH),
    "a law that relaxes, far outside": counts(friction("1/40"), -2, -2, 1, ONE, **BRANCH, **NEITHER),
    "a law that relaxes, a sample late": counts(friction("9/40", "1/4"), -1, 1, 1, ONE, **BRANCH, **FED),
}


def refused_with_a_unit_less(name: str, highest: int = 0) -> str:
    """Accepted as it is; with a unit less at a place, refused if and only if a move then takes out more.

    The values are raised from 0, or from random ones, and then more is stored at some places than need be.
    """
    document, random = plain(GRIDS[name]), Random(f"{name} {SEED}")
    told = told_by(document)
    grid = SEARCHES[told.kind](told)
    least = [random.choice((0, highest and random.randrange(highest))) for _ in range(grid.size)]
    value = raised(grid.conditions, least)
    if value is None:
        return "there is no such function"
    valid, words = plainly({**document, "storage": packed(value)})
    if not valid:
        return words
    of_place: dict[int, list[Condition]] = {}
    for condition in grid.conditions:
        for place in {place for way in condition for bound in way for place, _ in bound.here}:
            of_place.setdefault(place, []).append(condition)
    places = [place for place in grid.at if value[place] > 0]
    tight = 0
    for place in places[:: max(1, len(places) * grid.size // LOWERED)]:
        less = [v - (k == place) for k, v in enumerate(value)]
        short = any(lacking(condition, less) > 0 for condition in of_place[place])
        valid, words = plainly({**document, "storage": packed(less)})
        where = TAKES if "two frictions" in name else f"{grid.at[place]} a move {TAKES}"
        if valid is short or (short and where not in words):
            return f"a unit less at {place}, {grid.at[place]}: {valid}, {words}"
        tight += short
    return "" if tight else "nothing is tight"


BETWEEN = {
    "a law that relaxes slowly, clamped": {
        "the force changes its sign, past level 2": (
            "0 0 0 0 0 0 0 0 0 0 0 1575001 0 787501 0 1 0 1 0 1 2100001 4200002 1050001 4200002 1 4200002 "
            "1 3266668 1 0"
        ),
        "the next average is a level, past level 0": (
            "0 1 0 1 0 1 0 1 0 1 1 3500002 1 2100001 1 1 1 1 1 1 2100002 9800004 1050002 9800004 1 1 1 0 1 0"
        ),
        "the next average is a level, past level 2": (
            "0 0 0 0 0 0 0 525001 0 2100001 0 1575001 0 1050001 0 1050001 2100001 1050001 2100001 1050001 "
            "2100001 3150002 1050001 2100002 1050001 1050001 1050001 1 1050001 0"
        ),
        "the next average is a level, past level 3": (
            "2 3500003 2 3500003 2 3500003 12600005 4112503 12600005 9100004 3500003 7000004 3500003 "
            "7000004 3500003 7000004 5950003 7000004 9100004 7000004 7000004 9100005 7000004 8050005 "
            "7000004 7000004 7000004 5950005 7000004 4900004"
        ),
    },
    "a law that begins anew, fed with the penetration": {
        "the next average is a level, past level 0": (
            "2 4550003 9177782 4550003 2 4550003 2 4550003 2 4550003 4550003 5308337 4550003 4870837 "
            "4550003 4433337 4550003 4433337 4550003 4433337 5600004 6066671 5016670 5045838 4433337 "
            "4316671 4433337 3733337 4433337 3150004"
        ),
        "the next average is a level, past level 2": (
            "0 0 0 0 0 0 0 0 0 0 0 758334 0 466667 0 466667 1166667 466667 1166667 466667 1050001 1516668 "
            "466667 933334 466667 350001 466667 0 466667 0"
        ),
        "the next average is a level, past level 3": (
            "4 4550005 4 4550005 4 4550005 17474082 4550005 4 4550005 4550005 9100006 4550005 9100006 "
            "4550005 9100006 9605561 9100006 9605561 9100006 9100006 10150007 9100006 9566673 9100006 "
            "8983340 9100006 8400007 9100006 7816673"
        ),
    },
    "a law that relaxes on both sides": {
        "the next average is a level, past level 1": (
            "0 1225494 292161 1225494 875494 1225494 1458828 1789219 20000000 20000000 1225494 1614710 "
            "1225494 1565689 1225494 1516668 1450984 1516668 1676474 1516668 20000000 20000000 1639220 "
            "3500002 1516668 2916669 1516668 3645835 1516668 1"
        ),
        "the next average is a level, past level 2": (
            "1 1516668 3645835 1516668 2916669 1516668 3500002 1639220 20000000 20000000 1516668 1676474 "
            "1516668 1450984 1516668 1225494 1565689 1225494 1614710 1225494 20000000 20000000 1789219 "
            "1458828 1225494 875494 1225494 292161 1225494 0"
        ),
    },
}
"""Values found by a linear program: they fail most at one of the kinks, and nowhere else.

A line between two levels is above the function there where it is concave: where the next average passes a
level, or where the force of a clamped law becomes 0 for a hand that moves inwards."""


def refused_for_what_is_between_two_levels(name: str) -> str:
    """All holds but at kinks of one sort between two levels, where a move takes out more."""
    document = plain(GRIDS[name])
    told = told_by(document)
    grid = SEARCHES[told.kind](told)
    for kink, values in BETWEEN[name].items():
        value = [int(v) for v in values.split()]
        left_out = set(map(id, grid.kinks[kink]))
        for condition in grid.conditions:
            if id(condition) not in left_out and lacking(condition, value) > 0:
                return f"{kink}: more is wrong"
        if all(lacking(condition, value) <= 0 for condition in grid.kinks[kink]):
            return f"{kink}: nothing is wrong"
        valid, words = plainly({**document, "storage": packed(value)})
        if valid or TAKES not in words:
            return f"{kink}: {words}"
    return ""


TRIANGLES = (
    (CURVE, 0.28125, "0 0 0 0 0 218751 218751 568751 656252 218751 0 0"),
    (CURVE, 0.28125, "0 0 1341945 1341945 116946 1429446 1429446 1998197 1516947 1429446 1009134 134134"),
    (
        TWO_MODELS,
        -0.3125,
        "1868763 1745948 2535715 2535715 549154 1861654 1861654 3174154 2736653 1861654 986654 2736653",
    ),
)
"""Of laws in a chain, the device, the force at 1 and values: at one triangle of moves each corner has a model
of friction that will do, and no model all three."""


def refused_for_one_triangle() -> str:
    """On each side, where the same nodes of a cell stand in the opposite order."""
    for (device, force, values), side in product(TRIANGLES, (1, -1)):
        value = [int(v) for v in values.split()]
        if side < 0:
            value = [v for state in range(0, len(value), 3) for v in value[state : state + 3][::-1]]
        document = plain(table(device, 2, force=force, side=side))
        wrong = [c for c in in_a_table(told_by(document)).conditions if lacking(c, value) > 0]
        if len(wrong) != 1 or len(wrong[0][0]) < 3:
            return f"{len(wrong)} are wrong"
        valid, words = plainly({**document, "storage": packed(value)})
        if valid or TAKES not in words:
            return words
    return ""


# --- what is refused before any move is tried -----------------------------------------------------

ALONE = counts(friction(1), -1, -1, 1, ONE, **NEITHER)
ON_ITS_SURFACE = counts(friction(1), 0, 0, 1, ONE, **BRANCH, **FED)

MOVES = [
    ("a spring of one reading", ALONE, [2 * 6]),
    ("a spring", GRIDS["a spring"], [9 * 9]),
    ("a damped wall of long moves", GRIDS["a damped wall of long moves"], [50 * 10]),
    ("two frictions", GRIDS["two frictions"], [12 * 20 * 3]),
    ("a third of a sample late", GRIDS["a third of a sample late"], [27 * 9, 9 * 9**2]),
    ("a law that relaxes", GRIDS["a law that relaxes"], [2 * 18 * 6]),
    ("cells", GRIDS["cells"], [7 * 7]),
    ("cells, a third of a sample late", GRIDS["cells, a third of a sample late"], [30 * 5**2]),
    ("laws in a chain", GRIDS["laws in a chain"], [12 * 9]),
    ("laws in a chain, two frictions", GRIDS["laws in a chain, two frictions"], [12 * 9 * 3]),
]
"""Knots, times those that a move from one leads to, and how often each is looked at.  A line has one of each;
of two parts of an interval, every place between is one more."""


def moves_are_counted() -> str:
    """A grid with as many moves as can be checked, and with one more."""
    plainly_now = checker("storage.plainly")
    most = plainly_now.MOST_MOVES
    try:
        for name, document, numbers in MOVES:
            for moves in numbers:
                plainly_now.MOST_MOVES = moves - 1
                valid, words = plainly(plain(document))
                if valid or f"has {moves} moves: without numpy at most {moves - 1}" not in words:
                    return f"{name}: {words}"
            plainly_now.MOST_MOVES = max(numbers)
            _, words = plainly(plain(document))
            if "without numpy" in words:
                return f"{name}: {words}"
    finally:
        plainly_now.MOST_MOVES = most
    return ""


FORGOTTEN = "has been forgotten"
AT_THEIR_EDGE = (
    "a spring",
    "a damped wall",
    "a damped wall fed with the penetration",
    "a law of three readings",
    "a damped wall of long moves",
    "a sample late",
    "a damped wall, two samples late",
    "a third of a sample late",
    "a law that relaxes, fed with the penetration",
    "a law that relaxes, a sample late",
    "cells",
    "cells of a damped wall",
    "cells, a sample late",
    "cells of a damped wall, half a sample late",
)
"""They begin at 1 − (m + 1) r, with m readings remembered and moves of up to r; cells at −(m + 1) r."""


def nearer(document: Any) -> Any:
    """The lowest reading one higher."""
    key = next(key for key in document["domain"] if key.startswith("lowest_"))
    return put(document, {f"domain.{key}": document["domain"][key] + 1})


REFUSED = [
    *(
        (
            f"laws in a chain, where a reading off the grid leads to {then}",
            table(friction("7/40"), 2, leads=((then, 0, 1), *LEADS[1:])),
            "is not closed",
        )
        for then in (-2, -3, 0, 4, 99)
    ),
    (
        "laws in a chain that begin in a state of the table and in another",
        put(GRIDS["laws in a chain"], {"table.starts": [0, 4]}),
        "not in the table",
    ),
    *((f"{name}, one reading less", nearer(GRIDS[name]), FORGOTTEN) for name in AT_THEIR_EDGE),
    (
        "cells of both sides, the one a tenth of a count too short",
        put(GRIDS["cells of both sides, the one a count longer"], {"domain.counts_per_cell": "9/10"}),
        "as far on the one side",
    ),
    (
        "cells with two frictions",
        put(GRIDS["cells"], {"loop": CURVE}),
        "one friction model",
    ),
    (
        "a law that relaxes with two frictions",
        put(GRIDS["a law that relaxes"], {"loop": CURVE}),
        "one friction",
    ),
    (
        "a law that relaxes, without levels",
        without(GRIDS["a law that relaxes"], "domain.levels_per_count"),
        "levels_per_count is missing",
    ),
    (
        "a spring with levels",
        put(GRIDS["a spring"], {"domain.levels_per_count": 1}),
        "levels_per_count is of no use",
    ),
    *(
        (
            f"a law that begins anew, on a grid outside alone, from {low} to {high}",
            counts(friction(1), low, high, 1, [0], **relaxing(0, 0, resets=True), **NEITHER),
            "leaves the grid",
        )
        for low, high in ((-9, -8), (-2, -2))
    ),
    *(
        (
            f"laws in a chain, a force of {force}",
            table(friction("7/40"), 2, force=force),
            "a force is no number",
        )
        for force in (float("inf"), float("nan"))
    ),
]


def refused_before_any_move() -> str:
    """All values are 0: they are as many as there must be."""
    for name, told, phrase in REFUSED:
        document = plain(told)
        for size in range(1, 300):
            valid, words = plainly({**document, "storage": packed([0] * size)})
            if "one value for each state" not in words:
                break
        if valid or phrase not in words:
            return f"{name}: {valid}, {words}"
    return ""


def accepted_where_nothing_moves_far() -> str:
    """A single reading, with much friction: nothing need be stored, on two levels of an average."""
    for document, size in ((ALONE, 2), (ON_ITS_SURFACE, 4)):
        valid, words = plainly(plain({**document, "storage": packed([0] * size)}))
        if not valid:
            return words
    return ""


CASES = [
    *(Case(f"{kind}, as the fast check", partial(as_the_fast_check, kind), "") for kind in KINDS),
    *(Case(name, partial(refused_with_a_unit_less, name), "") for name in GRIDS),
    *(
        Case(f"{name}, with more stored here and there", partial(refused_with_a_unit_less, name, highest), "")
        for name, told in GRIDS.items()
        if (highest := HIGH if "relaxing" in told["law"] else HIGHER if "late" in name else 0)
    ),
    *(
        Case(f"{name}, between two levels", partial(refused_for_what_is_between_two_levels, name), "")
        for name in BETWEEN
    ),
    *(
        Case(check.__name__.replace("_", " "), check, "")
        for check in (
            refused_for_one_triangle,
            moves_are_counted,
            refused_before_any_move,
            accepted_where_nothing_moves_far,
        )
    ),
]
