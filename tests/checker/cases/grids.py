"""Forces, averages and costs on a grid, state by state, beside the law itself.

A table of forces is rounded by some units, and says by how many at most.
"""

from __future__ import annotations

import sys
from collections.abc import Iterator
from fractions import Fraction
from importlib import import_module
from itertools import product
from math import ceil, floor
from types import SimpleNamespace
from typing import Any

from . import Case, plain, put
from .storage import STORAGES, STORED, TAKES, one_state, packed, relaxing

STEP, PERIOD = Fraction(1, 10), Fraction(1, 4)
UNIT = Fraction(1, 10**7)
PART = 1 << 16
LOW, HIGH = -3, 4
SURFACES = ("position", "penetration", "none")


def storage(name: str) -> Any:
    """A part of the checker, as it is loaded now."""
    return import_module(f"zwidth.checker.storage.{name}")


def law(surface: str = "position", **more: Any) -> Any:
    """A spring of 7/3 N/m, if nothing else is said."""
    plain = {"points": [], "clamped": False, "limit": None, "relaxing": None, "resets": False}
    told = {"taps": [Fraction(7, 3)], **plain, **more, "surface": surface}
    return import_module("zwidth.checker.contact.law").Law(**told)


def losses(delay: int = 0, part: Fraction = Fraction(1), *models: Any, period: Fraction = PERIOD) -> Any:
    """Friction and damping, as they are told."""
    told = list(models) or [(Fraction(1, 3), Fraction(2, 7))]
    return import_module("zwidth.checker.contact.law").Losses(told, [], STEP, period, delay, part)


def laws() -> Iterator[Any]:
    """Of every sort."""
    damped, pushed = [Fraction(7, 3), Fraction(-5, 7)], [Fraction(1), Fraction(-2, 3), Fraction(2, 9)]
    points = [
        (Fraction(-1, 5), Fraction(-1, 3)),
        (Fraction(1, 7), Fraction(1, 9)),
        (Fraction(2, 7), Fraction(3, 2)),
    ]
    for surface, taps in product(SURFACES, ([Fraction(7, 3)], damped, pushed)):
        yield law(surface, taps=taps)
        yield law(surface, taps=taps, clamped=True)
        yield law(surface, taps=taps, limit=Fraction(1, 2))
        yield law(surface, taps=taps, step=Fraction(3, 25), clamped=True)
        yield law(surface, taps=taps, step=Fraction(3, 25), limit=Fraction(1, 3))
    for surface in ("position", "none"):
        yield law(surface, taps=[], points=points)
        yield law(surface, taps=[], points=points, rate=Fraction(-8, 3))
        yield law(surface, taps=[], points=points, rate=Fraction(9, 5), clamped=True, step=Fraction(1, 8))
        yield law(surface, taps=[], points=points, step=Fraction(1, 8))


def forces_on_a_grid_are_those_of_the_law() -> str:
    """For every reading that is remembered, of every age."""
    grid = storage("grid")
    for told, delay, reach in product(laws(), (0, 1), (1, 2)):
        memory = told.memory + delay
        for age in {delay, max(delay - 1, 0)}:
            found, off = grid._forces(told, losses(delay), UNIT, LOW, HIGH, reach, memory, age)
            states = product(range(LOW, HIGH + 1), product(range(-reach, reach + 1), repeat=memory))
            for force, (n, moves) in zip(found.ravel(), states, strict=True):
                readings = [n + sum(moves[:a]) for a in range(memory + 1)][age : age + told.memory + 1]
                if not all(LOW <= r <= HIGH for r in readings):
                    continue
                wrong = told.force([r * STEP for r in readings]) - int(force) * UNIT
                if abs(wrong) > off * UNIT:
                    return f"{told}, age {age}: {float(wrong)} N at {readings}"
        if off > 12 * (memory + 1) + 2:
            return f"off by {off}"
    return ""


def many_forces_are_computed_in_parts() -> str:
    """However many at once."""
    grid = storage("grid")
    told = law(taps=[Fraction(7, 3), Fraction(-5, 7)], step=Fraction(3, 25))
    whole, _ = grid._forces(told, losses(), UNIT, LOW, HIGH, 2, 1, 0)
    most, grid.AT_ONCE = grid.AT_ONCE, 11
    try:
        parts, _ = grid._forces(told, losses(), UNIT, LOW, HIGH, 2, 1, 0)
    finally:
        grid.AT_ONCE = most
    return "" if (whole == parts).all() else "other forces in parts"


def states_are_those_with_all_readings_on_the_grid() -> str:
    """Of a grid of counts, and of cells."""
    grid, coarse, domain = storage("grid"), storage("coarse"), storage("domain")
    for reach, memory in product((1, 2), (0, 1, 2)):
        found = grid._exists(LOW, HIGH, reach, memory).ravel()
        moves = list(product(range(-reach, reach + 1), repeat=memory))
        if moves != domain.histories_of(reach, memory):
            return "other histories"
        for exists, (n, moved) in zip(found, product(range(LOW, HIGH + 1), moves), strict=True):
            if exists != all(LOW <= n + sum(moved[:a]) <= HIGH for a in range(memory + 1)):
                return f"{n}, {moved}"
        line = coarse._Line(STEP, Fraction(reach), reach, memory, [-2, -1, 0, 0, 1], [])
        for exists, (n, moved) in zip(coarse._exists(line).ravel(), product(range(5), moves), strict=True):
            if exists != all(0 <= n + sum(moved[:a]) < 5 for a in range(memory + 1)):
                return f"cells, {n}, {moved}"
    return ""


def costs_are_below_what_is_lost() -> str:
    """φ D + β (D² − ¼) for D ≥ 2, by some units less; of two models the larger between any two steps."""
    domain = storage("domain")
    for max_move, steps, part in product(
        (Fraction(2), Fraction(5, 2)), (1, 3), (Fraction(1), Fraction(2, 5))
    ):
        told, off = losses(0, part), 4
        found = domain.costs_of(told, UNIT, off, part, max_move, steps)
        if len(found) != ceil(max_move * steps * part) + 1:
            return f"{len(found)} costs"
        friction, damping = told.models[0]
        for d, cost in enumerate(found):
            drag = damping / (part * PERIOD) * STEP / steps * (d * d - Fraction(1, 4)) if d > 1 else 0
            lacks = (friction * d + drag) / UNIT - int(cost) - off * d
            if not 0 <= lacks <= d + d * d + 1:
                return f"{float(lacks)} units at {d}"
    three = [(Fraction(1), Fraction(0)), (Fraction(1, 2), Fraction(1, 2)), (Fraction(0), Fraction(1))]
    for steps, several in product(range(1, 30), (three, three[::2])):
        one, *each = (
            domain.costs_of(losses(0, Fraction(1), *models), UNIT, 4, Fraction(1), Fraction(40), steps)
            for models in (several, *([m] for m in several))
        )
        best = [max(each, key=lambda c: c[d] + c[d + 1]) for d in range(len(one) - 1)]
        if list(one) != [min(c[d] for c in best[max(d - 1, 0) : d + 1]) for d in range(len(one))]:
            return f"of {len(several)} models, {steps} steps"
    return ""


def a_law_that_relaxes_on_levels() -> str:
    """Its force inwards and outwards, and where each level of its average goes, down and up."""
    relaxing, low, high, per, unit = storage("grid"), -2, 2, 2, Fraction(1, 100)
    for surface, clamped, resets in product(SURFACES, (False, True), (False, True)):
        told = law(surface, taps=[Fraction(3)], relaxing=(Fraction(2, 3), Fraction(5)), resets=resets)
        least = 0 if surface == "penetration" else low
        averages = [(least + Fraction(i, per)) * STEP for i in range((high - least) * per + 1)]
        args = low, high, least, per, len(averages)
        forces = relaxing._level_forces(told._replace(clamped=clamped), 30, 25, *args)
        images = relaxing._images(told, *args)
        for n in range(low, high + 1):
            line = [told.force([n * STEP], average) / unit for average in averages]
            for i, average in enumerate(averages):
                outwards = max(line[i], Fraction(0)) if clamped else line[i]
                inwards = Fraction(0) if clamped and min(line[max(i - 1, 0) : i + 2]) <= 0 else line[i]
                if [*forces[:, n - low, i]] != [inwards, outwards]:
                    return f"forces {forces[:, n - low, i]}, not {inwards}, {outwards}, at {n}, {i} of {told}"
                place = (told.averaged(average, n * STEP) / STEP - least) * per * PART
                if [*images[:, n - low, i]] != [floor(place), ceil(place)]:
                    return f"images {images[:, n - low, i]}, not {float(place)}, at {n}, {i} of {told}"
    return ""


def forces_that_do_not_fit_are_refused() -> str:
    """Whatever they come from, and however large all but one of their causes are."""
    grid, huge, low = storage("grid"), Fraction(1 << 53), [(Fraction(0), Fraction(1))]
    steep, none = [(Fraction(0), huge / 2)], {"taps": [Fraction(1)]}
    told = [
        (law(**none, limit=huge), 1, 1), (law(**none, step=huge), 1, 1),
        (law(taps=[], points=low, rate=huge), 1, 10), (law(taps=[], points=low, rate=-huge), 1, 10),
        (law(taps=[], points=steep, limit=huge / 2), 1, 1), (law(taps=[], points=steep, step=huge / 2), 1, 1),
        (law(taps=[], points=steep, limit=huge / 4, step=huge / 4), 1, 1),
        (law(taps=[], points=steep, rate=Fraction(5)), 1, 2),
        (law(taps=[-huge], clamped=True), 10, 1),
    ]  # fmt: skip
    refused = import_module("zwidth.checker.document.refusal").Invalid
    for one, farthest, reach in told:
        for unit, fits in ((Fraction(1), False), (Fraction(3), True)):
            try:
                grid._require_small(one, losses(), unit, farthest, reach)
            except refused:
                if fits:
                    return f"{one} fits in units of {unit}"
            else:
                if not fits:
                    return f"{one} does not fit"
    return ""


def cells_reach_as_far_on_both_sides() -> str:
    """Of a law without a surface, but for a count."""
    coarse = storage("coarse")
    told = SimpleNamespace(counts_per_cell=1, largest_move_cells=Fraction(1), remembered=0, highest_cell=2)
    refused = import_module("zwidth.checker.document.refusal").Invalid
    for low, holds in ((-4, True), (-3, True), (-2, False), (-1, False)):
        told.lowest_cell = low
        try:
            coarse._line(told, losses(), law("none"))
        except refused:
            if holds:
                return f"refused from {low}"
        else:
            if not holds:
                return f"accepted from {low}"
    return ""


def words_of_cells() -> str:
    """How far and how fast, in the units of the device."""
    coarse = storage("coarse")
    cells = SimpleNamespace(counts_per_cell=Fraction(3), highest_cell=7, largest_move_cells=Fraction(5))
    for units, length in (("linear", "m"), ("rotary", "rad")):
        said = coarse.proved(SimpleNamespace(domain=cells, units=units), losses())
        if f"up to 2.1 {length} and" not in said or f"up to 6 {length}/s over" not in said:
            return said
    return ""


def forces_and_costs_of_levels() -> str:
    """A level is a part of a count; costs are those of the longest move, in steps."""
    relaxing_grid = import_module("zwidth.checker.storage.grid")
    asked: dict[str, Any] = {}
    kept = relaxing_grid._level_forces, relaxing_grid.costs_of

    def told(name: str, real: Any) -> Any:
        def call(*given: Any) -> Any:
            asked[name] = given
            return real(*given)

        return call

    relaxing_grid._level_forces, relaxing_grid.costs_of = told("forces", kept[0]), told("costs", kept[1])
    try:
        grid = relaxing(-1, 1, [0] * 45, {}, largest_move_counts=3, steps_per_count=2)
        grid = put(grid, {"domain.levels_per_count": 2})
        import_module("zwidth.checker").verify(plain(grid))
    finally:
        relaxing_grid._level_forces, relaxing_grid.costs_of = kept
    found = [*asked["forces"][1:3], *asked["costs"][4:]]
    return "" if found == [10, 2, 3, 2] else f"{found}"


def costs_of_a_table() -> str:
    """Of the whole interval and the longest move."""
    row, asked = import_module("zwidth.checker.storage.row"), list[Any]()
    kept = row.costs_of
    row.costs_of = lambda *given: asked.extend(given[3:]) or kept(*given)
    try:
        import_module("zwidth.checker").verify(plain(one_state([0, 0], 2)))
    finally:
        row.costs_of = kept
    return "" if asked == [1, 2, 1] else f"{asked}"


def averages_go_where_the_law_sends_them() -> str:
    """Forces by reading and level, inwards and outwards, and the images of all levels."""
    relaxing = storage("grid")
    for surface, clamped, resets, per_count in product(SURFACES, (False, True), (False, True), (1, 3)):
        if clamped and surface == "none":
            continue
        told = law(surface, clamped=clamped, resets=resets, relaxing=(Fraction(2, 7), Fraction(50, 3)))
        least = 0 if surface == "penetration" else LOW
        levels = (HIGH - least) * per_count + 1
        spring, branch = (int(k * STEP / UNIT) for k in (told.taps[0], told.relaxing[1] / per_count))
        both = relaxing._level_forces(told, spring, branch, LOW, HIGH, least, per_count, levels)
        images = relaxing._images(told, LOW, HIGH, least, per_count, levels)
        for n in range(LOW, HIGH + 1):
            averages = [least + Fraction(i, per_count) for i in range(levels)]
            exact = [told.force([n * STEP], a * STEP) for a in averages]
            free = [told._replace(clamped=False).force([n * STEP], a * STEP) for a in averages]
            for i, a in enumerate(averages):
                flat = clamped and min(free[max(i - 1, 0) : i + 2]) <= 0
                for force, right in (
                    (both[0, n - LOW, i], 0 if flat else exact[i]),
                    (both[1, n - LOW, i], exact[i]),
                ):
                    if abs(int(force) * UNIT - right) > (levels + 9) * UNIT:
                        return f"{surface}, {clamped}: {n}, {float(a)}: {int(force) * float(UNIT)} N"
                image = (told.averaged(a * STEP, n * STEP) / STEP - least) * per_count * PART
                ends = images[0, n - LOW, i], images[1, n - LOW, i]
                if ends != (image // 1, -(-image // 1)):
                    return f"{surface}, {resets}: the image of {float(a)} at {n}"
    for reach, delay in product((1, 2), (0, 1, 2)):
        rows = relaxing._rows(LOW, HIGH, reach, delay).ravel()
        for row, (n, moves) in zip(
            rows, product(range(LOW, HIGH + 1), product(range(-reach, reach + 1), repeat=delay)), strict=True
        ):
            readings = [n + sum(moves[:a]) for a in range(delay + 1)]
            if row != (readings[-1] - LOW if all(LOW <= r <= HIGH for r in readings) else -1):
                return f"the row of {readings}"
    return ""


def forces_at_corners_are_those_of_the_law() -> str:
    """Σ c_j (y_{k−j} + Δ/2), where the last reading is inside, or fed with those that are."""
    coarse = storage("coarse")
    length = Fraction(3, 2)
    for surface, taps, delay in product(SURFACES, ([5], [5, -2]), (0, 1)):
        sheets = surface != "none"
        told = law(surface, taps=[Fraction(c, 3) for c in taps])
        memory, age = len(taps) - 1 + delay, delay
        places = [*range(-4, 1), *range(0 if sheets else 1, 4)]
        inside = [not sheets or k >= 5 for k in range(len(places))]
        line = coarse._Line(length, Fraction(1), 2, memory, places, inside)
        found, off = coarse._forces(told, losses(delay), line, UNIT, age)
        states = product(range(len(places)), product(range(-2, 3), repeat=memory))
        for force, (n, moves) in zip(found.ravel(), states, strict=True):
            corners = [n + sum(moves[:a]) for a in range(memory + 1)][age:]
            if not all(0 <= k < len(places) for k in corners):
                continue
            fed = [
                places[k] * length + STEP / 2 if inside[k] or surface != "penetration" else 0 for k in corners
            ]
            right = (
                sum((c * u for c, u in zip(told.taps, fed, strict=True)), Fraction(0))
                if inside[corners[0]]
                else 0
            )
            if abs(right - int(force) * UNIT) > off * UNIT:
                return f"{surface}, {taps}, {delay}: {int(force) * float(UNIT)} N at {corners}"
        if off > 5 * len(taps):
            return f"off by {off}"
    return ""


def costs_of_cells_are_below_what_is_lost() -> str:
    """φ D + L(D), where the friction has paid for half a count."""
    coarse = storage("coarse")
    for taps, part, max_move in product(
        ([5], [5, -2], [-5, 2]), (Fraction(1), Fraction(2, 5)), (Fraction(3), Fraction(7, 2))
    ):
        told = law(taps=[Fraction(c, 3) for c in taps])
        line = coarse._Line(Fraction(3, 2), max_move, 4, 0, [], [])
        kappa = Fraction(max(sum(c for c in taps if c > 0), -sum(c for c in taps if c < 0)), 3)
        device = losses(0, part, (Fraction(9), Fraction(2)))
        found = coarse._costs(told, device, line, UNIT, 4, part)
        if len(found) != ceil(max_move * part) + 1:
            return f"{len(found)} costs"
        friction = 9 - sum(abs(c) for c in told.taps) * STEP / 2
        drag = 2 / (part * PERIOD) * line.length
        for d, cost in enumerate(found):
            bent = (
                drag * d * d - (drag + kappa * line.length) / 4 if d > 1 else -kappa * line.length * (d == 1)
            )
            lacks = (friction * d + bent) / UNIT - int(cost) - 4 * d
            if not 0 <= lacks <= d + d * d + 2:
                return f"{taps}: {float(lacks)} units at {d}"
    return ""


def without_numpy_the_twin_checks() -> str:
    """Of each kind of storage function, where nothing is stored."""
    numpy, modules = sys.modules.get("numpy"), sys.modules
    for name in ("spring", "coarse", "row"):
        told = plain(put(STORAGES[name]["document"], {"storage": packed([0] * len(STORED[name]))}))
        modules["numpy"] = None  # type: ignore[assignment]
        try:
            found = import_module("zwidth.checker").verify(told)
        finally:
            del modules["numpy"]
            if numpy is not None:
                modules["numpy"] = numpy
        if found.valid or "with the readings" not in found.reason or TAKES not in found.reason:
            return f"{name}: {found.reason}"
    return ""


CHECKS = (
    forces_on_a_grid_are_those_of_the_law,
    many_forces_are_computed_in_parts,
    states_are_those_with_all_readings_on_the_grid,
    costs_are_below_what_is_lost,
    a_law_that_relaxes_on_levels,
    forces_that_do_not_fit_are_refused,
    cells_reach_as_far_on_both_sides,
    words_of_cells,
    forces_and_costs_of_levels,
    costs_of_a_table,
    averages_go_where_the_law_sends_them,
    forces_at_corners_are_those_of_the_law,
    costs_of_cells_are_below_what_is_lost,
    without_numpy_the_twin_checks,
)

CASES = [Case(check.__name__.replace("_", " "), check, "") for check in CHECKS]
