"""Storage functions: every one a smallest, or nearly, so that one unit less at a state is less than a move
takes out.

They stand in `storages.json`, on grids of a few counts or cells.  The prover found them; each was then
lowered state
by state as far as it holds.
"""

from __future__ import annotations

import base64
import json
import zlib
from fractions import Fraction
from math import inf, nan
from pathlib import Path
from struct import pack
from typing import Any

from . import Case, accepted, edge, put, refused, without

STORAGES = json.loads(Path(__file__).with_name("storages.json").read_text(encoding="utf-8"))
TAKES = "takes out more"
AT_MOST = 14
"""States of each storage function that are lowered."""


def unpacked(text: str) -> list[int]:
    raw = zlib.decompress(base64.b64decode(text))
    return [int.from_bytes(raw[i : i + 8], "little", signed=True) for i in range(0, len(raw), 8)]


def packed(values: list[int]) -> str:
    return base64.b64encode(
        zlib.compress(b"".join(v.to_bytes(8, "little", signed=True) for v in values))
    ).decode()


def lowered(document: Any, state: int) -> Any:
    values = unpacked(document["storage"])
    values[state] -= 1
    return put(document, {"storage": packed(values)})


def of(name: str) -> list[Case]:
    """Accepted as it is; refused with a unit less, or with a device that is a little worse."""
    told, loop = STORAGES[name]["document"], STORAGES[name]["document"]["loop"]
    tight, worse = STORAGES[name]["tight"], STORAGES[name]["worse"]
    step = max(1, len(tight) // AT_MOST)
    return [
        accepted(
            name, told, "no move takes out more than the storage function falls", **STORAGES[name]["scope"]
        ),
        *(refused(f"{name}, a unit less at {state}", lowered(told, state), TAKES) for state in tight[::step]),
        *(
            refused(
                f"{name}, {key} × {factor}",
                put(told, {f"loop.{key}": Fraction(loop[key]) * Fraction(factor)}),
                TAKES,
            )
            for key, factor in worse.items()
        ),
    ]


def grid(name: str, phrase: str, **entries: Any) -> Case:
    """A grid that is not what it must be."""
    kind, _, what = name.partition(": ")
    told = put(STORAGES[kind]["document"], {key.replace("__", "."): value for key, value in entries.items()})
    return refused(f"{kind}, {what}", told, phrase)


ROW = STORAGES["row"]["document"]
SPRING = STORAGES["spring"]["document"]
STORED = {
    name: unpacked(STORAGES[name]["document"]["storage"]) for name in ("spring", "solid", "row", "coarse")
}
SHORT = packed(unpacked(SPRING["storage"])[1:])
LONG = packed([*unpacked(SPRING["storage"]), 0])
EMPTY = "is empty"

# the unit where the largest sum, with V = 0, is just too large for the numbers it is kept in
SMALLEST_UNITS = {
    "spring": "7.46902539e-17", "late": "3.99957844e-17", "partly late": "4.37427871e-17",
    "coarse": "1.66119830e-16",
    "coarse part": "1.14502491e-16", "coarse damped": "6.62539142e-17", "row": "8.87484530e-17",
    "solid": "2.98427949e-15", "relaxing": "3.19744231e-15",
}  # fmt: skip
MORE, LESS = 1 + Fraction(1, 10**7), 1 - Fraction(1, 10**7)


def in_units(name: str, unit: Fraction) -> Any:
    told = STORAGES[name]["document"]
    return put(told, {"force_unit": unit, "storage": packed([0] * len(unpacked(told["storage"])))})


def small(kind: str, law: Any, domain: Any, values: list[int], friction: Any, unit: Any = 1) -> Any:
    """A count of 1 m and a sample of 1 s, no damping; numbers that can be worked out by hand."""
    return {
        "format": "zwidth certificate 1",
        "kind": kind,
        "loop": {
            "damping_N_s_per_m": 0,
            "coulomb_friction_N": friction,
            "resolution_m": 1,
            "sample_period_s": 1,
            "delay_s": 0,
        },
        "law": {"surface": "none", "clamped": False, **law},
        "domain": domain,
        "force_unit": unit,
        "storage": packed(values),
    }


def counts(low: int, high: int, **more: Any) -> dict[str, Any]:
    """Moves of a count at most, in one step."""
    ends = {"lowest_count": low, "highest_count": high}
    return {**ends, "largest_move_counts": 1, "steps_per_count": 1, **more}


def cells(low: int, high: int, **more: Any) -> dict[str, Any]:
    """Of a count each; moves of a cell at most."""
    ends = {"lowest_cell": low, "highest_cell": high}
    return {**ends, "counts_per_cell": 1, "largest_move_cells": 1, "remembered": 0, **more}


def relaxing(low: int, high: int, values: list[int], law: Any, **more: Any) -> Any:
    """A spring of 10 N/m, beside it one of 4 N/m that relaxes; 30 N of friction."""
    told = {"taps_N_per_m": [10], "relaxing": {"pole": "1/2", "stiffness_N_per_m": 4}, "resets": False, **law}
    return small("storage", told, counts(low, high, levels_per_count=1, **more), values, 30)


def leading(place: tuple[int, int], to: int) -> Any:
    """The laws in a chain, of states at −2, −1, 0, 1, where one reading leads elsewhere."""
    successors = unpacked(ROW["table"]["successors"])
    successors[3 * place[0] + place[1]] = to
    return put(ROW, {"table.successors": packed(successors)})


def doubles(*values: float) -> str:
    return base64.b64encode(zlib.compress(pack(f"<{len(values)}d", *values))).decode()


def one_state(values: list[int], moves: int = 1) -> Any:
    """A table of one reading, without force."""
    nowhere = [-1] * moves
    table = {"states": 1, "starts": [0], "counts": packed([0]), "forces": doubles(0.0)}
    entries = {"table": {**ROW["table"], **table, "successors": packed([*nowhere, 0, *nowhere])}}
    domain = {"lowest_count": 0, "highest_count": 0, "largest_move_counts": moves, "steps_per_count": 1}
    return put(ROW, {**entries, "domain": domain, "storage": packed(values)})


HUGE = 1 << 61
STEEP = 1 << 46
"""Where numbers are too large to be compared."""
SPRING_OF_1, TOO_LARGE = {"surface": "position", "taps_N_per_m": [1]}, "numbers are too large to be compared"
FORCES_TOO_LARGE = "forces are too large to be compared"
TOO_MUCH, TOO_LONG = "too many numbers", "more effort than"


CASES = [
    *(
        refused(
            f"{name}, a unit just too small", in_units(name, Fraction(u) * LESS), "too large to be compared"
        )
        for name, u in SMALLEST_UNITS.items()
    ),
    *(
        refused(f"{name}, a unit just large enough", in_units(name, Fraction(u) * MORE), TAKES)
        for name, u in SMALLEST_UNITS.items()
        if name != "relaxing"
    ),
    *(
        refused(f"laws in a chain, {what}", leading(place, to), phrase)
        for what, place, to, phrase in (
            ("a reading that leads to one further in", (0, 1), 1, "another reading"),
            ("a reading that leads to one further out", (1, 1), 0, "another reading"),
            ("a reading that leads nowhere", (0, 1), -1, "is not closed"),
            ("a reading that leads past the last state", (0, 1), 4, "is not closed"),
            ("a reading off the grid that leads somewhere", (0, 0), 0, "is not closed"),
        )
    ),
    refused(
        "a grid of a law that relaxes, that ends too near for long moves",
        put(STORAGES["solid"]["document"], {"domain.largest_move_counts": 2}),
        "must reach so far out",
    ),
    refused(
        "a law that relaxes, that stores far more at one level than at the next",
        put(STORAGES["solid"]["document"], {"storage": packed([(i // 9 % 2) << 47 for i in range(36)])}),
        "too large to be compared",
    ),
    accepted("a grid inside a surface", SPRING, "at any position up to 3 counts inside"),
    accepted("a grid of both sides", STORAGES["points"]["document"], "at any position from -3 to 3 counts"),
    refused(
        "cells of a law of points",
        put(
            STORAGES["coarse"]["document"],
            {"law.taps_N_per_m": [], "law.points_m_N": [[0, 0], [1, 1]]},
        ),
        "linear inside",
    ),
    refused(
        "cells that remember more",
        put(STORAGES["coarse damped"]["document"], {"domain.remembered": 2}),
        "another number of readings",
    ),
    *(case for name in STORAGES for case in of(name)),
    *(
        refused(
            f"{name}, a value below 0",
            put(
                STORAGES[name]["document"],
                {"storage": packed([-1, *unpacked(STORAGES[name]["document"]["storage"])[1:]])},
            ),
            "bounded below by 0",
        )
        for name in ("spring", "solid", "row", "coarse")
    ),
    refused("a value too few", put(SPRING, {"storage": SHORT}), "one value for each state"),
    refused("a value too many", put(SPRING, {"storage": LONG}), "one value for each state"),
    *(
        refused(f"laws in a chain that begin {what}", put(ROW, {"table.starts": starts}), phrase)
        for what, starts, phrase in (
            ("nowhere", [], "starts must have 1"),
            ("in a list of one word", "0", "starts must be a list"),
            (
                "in more states than there are",
                [0] * (ROW["table"]["states"] + 1),
                "a state that is not in the table",
            ),
            ("past the last state", [ROW["table"]["states"]], "not in the table"),
        )
    ),
    refused("laws in a chain, a grid of less", put(ROW, {"domain.lowest_count": -1}), "not on the grid"),
    refused("laws in a chain, a grid of more", put(ROW, {"domain.lowest_count": -3}), "is not closed"),
    refused("laws in a chain, a grid of more inside", put(ROW, {"domain.highest_count": 2}), "is not closed"),
    refused(
        "laws in a chain, a state less",
        put(ROW, {"table.states": ROW["table"]["states"] - 1}),
        "one value for each state",
    ),
    refused("laws in a chain, part of a sample late", put(ROW, {"loop.delay_s": "0.0005"}), "whole samples"),
    refused(
        "a grid that ends too near",
        put(STORAGES["damped"]["document"], {"domain.lowest_count": -2}),
        "must reach so far out",
    ),
    refused(
        "a grid of a late force that ends too near",
        put(STORAGES["late"]["document"], {"domain.lowest_count": 0}),
        "must reach so far out",
    ),
    refused(
        "a grid of a law that relaxes that ends too near",
        put(STORAGES["solid late"]["document"], {"domain.lowest_count": 0}),
        "must reach so far out",
    ),
    refused(
        "cells that end too near",
        put(STORAGES["coarse damped"]["document"], {"domain.lowest_cell": -3}),
        "must reach so far out",
    ),
    refused(
        "cells of two sides, one nearer",
        put(STORAGES["coarse two sides"]["document"], {"domain.lowest_cell": -20}),
        "as far on the one side",
    ),
    refused(
        "cells that remember less",
        put(STORAGES["coarse damped"]["document"], {"domain.remembered": 0}),
        "another number of readings",
    ),
    *(
        refused(
            f"cells of a law with {key}",
            put(STORAGES["coarse"]["document"], {f"law.{key}": value}),
            "linear inside",
        )
        for key, value in (
            ("clamped", True),
            ("force_limit_N", 1),
            ("force_step_N", 1),
            ("relaxing", {"pole": 0, "stiffness_N_per_m": 1}),
        )
    ),
    refused(
        "a law that relaxes with a force limit",
        put(STORAGES["solid"]["document"], {"law.force_limit_N": 1}),
        "force limit together",
    ),
    refused(
        "a law that relaxes, part of a sample late",
        put(STORAGES["solid"]["document"], {"loop.delay_s": "0.0005"}),
        "whole samples",
    ),
    *(
        refused(
            f"{name}, too little at the first state alone",
            put(STORAGES[name]["document"], {"storage": packed([0] + [10**13] * (len(STORED[name]) - 1))}),
            "a move takes out more energy",
        )
        for name in STORED
    ),
    accepted(
        "without a surface a grid may lie to one side",
        put(
            SPRING,
            {
                "law": {"surface": "none", "clamped": False, "taps_N_per_m": [0]},
                "domain": {
                    "lowest_count": 1,
                    "highest_count": 2,
                    "largest_move_counts": 1,
                    "steps_per_count": 1,
                },
                "storage": packed([0] * 4),
            },
        ),
        contact="both sides",
    ),
    refused("no base64", put(SPRING, {"storage": "?"}), "cannot be unpacked"),
    refused("nothing packed", put(SPRING, {"storage": "AAAA"}), "cannot be unpacked"),
    refused("a list for a text", put(SPRING, {"storage": [1]}), "must be text"),
    *(
        grid(f"{name}: {what}", phrase, **{f"domain__{key}": value})
        for name in ("spring", "solid", "row")
        for what, key, value, phrase in (
            ("moves of no length", "largest_move_counts", 0, "domain.largest_move_counts must be"),
            ("moves back", "largest_move_counts", -1, "domain.largest_move_counts must be"),
            ("moves without end", "largest_move_counts", 10_000_001, "domain.largest_move_counts must be"),
            ("no step", "steps_per_count", 0, "domain.steps_per_count must be ≥ 1"),
            ("a grid turned round", "highest_count", -9, EMPTY),
            ("a count that is none", "lowest_count", "-1/2", "domain.lowest_count must be"),
            ("a count far off", "lowest_count", -(10**7) - 1, "domain.lowest_count must be"),
        )
    ),
    *(
        refused(
            f"{name}, the force unit is {unit}",
            put(STORAGES[name]["document"], {"force_unit": unit}),
            "force_unit must be > 0",
        )
        for name in ("spring", "solid", "row", "coarse")
        for unit in (0, "-1/1000000")
    ),
    *(
        refused(
            f"{name}, units too small",
            put(STORAGES[name]["document"], {"force_unit": "1e-30"}),
            "too large to be compared",
        )
        for name in ("spring", "solid", "row", "coarse", "points", "limited", "grows")
    ),
    *(
        refused(f"{name} without {key}", without(STORAGES[name]["document"], key), "is missing")
        for name in ("spring", "solid", "row", "coarse")
        for key in ("domain", "force_unit", "storage")
    ),
    refused(
        "a pull of 2⁶⁴ units, which numbers of 64 bits take for 0",
        small("storage", {"taps_N_per_m": [-(1 << 62)]}, counts(4, 4), [0] * 2, 10),
        FORCES_TOO_LARGE,
    ),
    refused(
        "points of a large pull",
        small(
            "storage",
            {"taps_N_per_m": [], "points_m_N": [[0, -(10**17)], [1, 0]]},
            counts(0, 1),
            [0] * 4,
            10,
        ),
        FORCES_TOO_LARGE,
    ),
    # 4 counts at 1 N/m are 2⁵³ units of 2⁻⁵¹ N
    refused(
        "forces of 2⁵³ units",
        small("storage", SPRING_OF_1, counts(-4, 1), [0] * 12, 0, Fraction(1, 1 << 51)),
        FORCES_TOO_LARGE,
    ),
    refused(
        "forces of a little less than 2⁵³ units",
        small("storage", SPRING_OF_1, counts(-4, 1), [0] * 12, 0, Fraction(1, (1 << 51) - 1)),
        TAKES,
    ),
    # 8 cells and a count at 1 N/m are 2⁵³ units
    refused(
        "cells, forces of 2⁵³ units",
        small("coarse storage", SPRING_OF_1, cells(-8, 1), [0] * 11, 0, Fraction(9, 1 << 53)),
        FORCES_TOO_LARGE,
    ),
    refused(
        "cells, forces of a little less than 2⁵³ units",
        small("coarse storage", SPRING_OF_1, cells(-8, 1), [0] * 11, 0, Fraction(9, (1 << 53) - 1)),
        TAKES,
    ),
    refused(
        "cells of a device with a friction curve",
        put(STORAGES["coarse"]["document"], {"loop": STORAGES["curve"]["document"]["loop"]}),
        "one friction model",
    ),
    accepted(
        "cells without a surface may end nearer than a move reaches",
        small("coarse storage", {"taps_N_per_m": [0]}, cells(-2, 1, largest_move_cells=3), [0] * 4, 10),
        contact="both sides",
    ),
    # no force acts outside, and a move of a cell costs φ h − ½ k Δ h − κ h² = 1000 − 50 − 100 J, of which
    # 3 J are kept for rounding
    *edge(
        "cells, more is stored outside",
        *(
            small(
                "coarse storage",
                {"surface": "position", "taps_N_per_m": [100]},
                cells(-2, 1),
                [far, 0, 0, 0, 0],
                1000,
            )
            for far in (847, 851)
        ),
        TAKES,
    ),
    # a move costs 350 − 50 − 100 J, and the wall pulls with 150 N at 1 and with 250 N at 2
    accepted(
        "a wall that pulls, where no cell follows the last one",
        small(
            "coarse storage",
            {"surface": "position", "taps_N_per_m": [-100]},
            cells(-1, 2),
            [0] * 5,
            350,
        ),
    ),
    accepted(
        "a law that relaxes, on a grid outside alone",
        relaxing(-1, 0, [0] * 8, {"surface": "penetration"}),
        "at any position from -1 to 1 counts",
    ),
    accepted(
        "a law that begins anew at the highest count",
        relaxing(-1, 0, [0] * 8, {"surface": "position", "resets": True}),
    ),
    refused(
        "a law that begins anew beyond the grid",
        relaxing(-2, -1, [0] * 8, {"surface": "position", "resets": True}),
        "must hold 0",
    ),
    # 14 N at most and 21 units a move: V + 2 · 14 · 2 + 21
    accepted(
        "a law that relaxes, what is stored just small enough",
        relaxing(0, 1, [HUGE - 78] * 8, {"surface": "penetration"}),
    ),
    refused(
        "a law that relaxes, what is stored just too large",
        relaxing(0, 1, [HUGE - 77] * 8, {"surface": "penetration"}),
        TOO_LARGE,
    ),
    # from one level to the next V rises by so much, and 4 N may act on 2 moves there and back
    refused(
        "a law that relaxes, a rise just small enough",
        relaxing(0, 1, [0, 0, STEEP - 17, STEEP - 17] * 2, {"surface": "penetration"}),
        TAKES,
    ),
    refused(
        "a law that relaxes, a rise just too steep",
        relaxing(0, 1, [0, 0, STEEP - 16, STEEP - 16] * 2, {"surface": "penetration"}),
        TOO_LARGE,
    ),
    refused(
        "a law that relaxes, forces too large together",
        relaxing(
            0,
            1,
            [0] * 8,
            {"taps_N_per_m": [2 * 10**18], "relaxing": {"pole": 0, "stiffness_N_per_m": 10**18}},
        ),
        FORCES_TOO_LARGE,
    ),
    # 3 · 10¹⁰ pairs of places; 10⁷ costs
    refused(
        "a count in so many steps that it takes too long",
        small("storage", SPRING_OF_1, counts(0, 0, steps_per_count=10**5), [0], 0),
        TOO_LONG,
    ),
    refused(
        "a law that relaxes, moves so far that they are too many",
        relaxing(0, 4, [0] * 50, {}, largest_move_counts=10**7),
        TOO_MUCH,
    ),
    refused(
        "a law that relaxes, nothing at the first six states",
        put(
            STORAGES["solid"]["document"],
            {"storage": packed([0] * 6 + [10**13] * (len(STORED["solid"]) - 6))},
        ),
        "a move takes out more energy",
    ),
    *(
        refused(
            f"{name}, levels of no use",
            put(told, {"domain.levels_per_count": 2}),
            "levels_per_count is of no use",
        )
        for name, told in (("spring", SPRING), ("points", STORAGES["points"]["document"]))
    ),
    refused(
        "a law that relaxes, without levels",
        without(STORAGES["solid"]["document"], "domain.levels_per_count"),
        "levels_per_count is missing",
    ),
    refused(
        "a law that relaxes, a friction curve",
        put(
            without(STORAGES["solid"]["document"], "loop.damping_N_s_per_m", "loop.coulomb_friction_N"),
            {
                "loop.friction_curve_m_per_s_N": [[0, 1], [1, 1]],
                "loop.friction_models_N_N_s_per_m": [[0, 0]],
            },
        ),
        "one friction model",
    ),
    accepted(
        "a law that relaxes, moves of two counts, a sample late",
        put(relaxing(-1, 1, [0] * 90, {}, largest_move_counts=2), {"loop.delay_s": 1}),
    ),
    accepted("a law that relaxes, one cell", relaxing(0, 0, [0] * 4, {})),
    accepted("a law that relaxes, outside", relaxing(-5, -3, [0] * 18, {"taps_N_per_m": [1]})),
    *(
        refused(f"a law that relaxes, {name}", relaxing(-3, 1, [0] * 50, law), FORCES_TOO_LARGE)
        for name, law in (
            ("a spring too stiff at the far end", {"taps_N_per_m": [1 << 60]}),
            ("a spring too stiff outwards", {"taps_N_per_m": [-(1 << 60)]}),
            ("a branch too stiff", {"relaxing": {"pole": "1/2", "stiffness_N_per_m": 1 << 59}}),
            ("a branch too stiff outwards", {"relaxing": {"pole": "1/2", "stiffness_N_per_m": -(1 << 59)}}),
        )
    ),
    refused(
        "a law that relaxes, forces outwards too large together",
        relaxing(-1, 1, [0] * 18, {"taps_N_per_m": [-(1 << 46)], "surface": "position"}),
        TOO_LARGE,
    ),
    *(
        refused(
            f"a law that relaxes, one value of {1 << bits} at {place}",
            relaxing(-1, 1, [(1 << bits) * (k == place) for k in range(18)], {}),
            TOO_LARGE,
        )
        for bits, place in ((47, 0), (47, 4), (61, 2))
    ),
    refused(
        "a law that relaxes, what is stored at one reading too large",
        relaxing(-1, 1, [1 << 61] * 6 + [0] * 12, {}),
        TOO_LARGE,
    ),
    accepted("laws in a chain, all states told", ROW, "in any of 4 states that"),
    accepted("laws in a chain, one reading", one_state([0, 0])),
    refused("laws in a chain, one value just too large", one_state([1 << 53, 0]), TOO_LARGE),
    refused(
        "laws in a chain, a state above the grid", put(ROW, {"domain.highest_count": 0}), "is not on the grid"
    ),
    accepted("laws in a chain, the hand begins anywhere", put(ROW, {"table.starts": [0, 1, 2, 3]})),
    refused(
        "laws in a chain, it begins outside, too", put(ROW, {"table.starts": [0, 4]}), "not in the table"
    ),
    refused("laws in a chain, a reading off the grid that leads to −2", leading((0, 0), -2), "is not closed"),
    *(
        refused(
            f"laws in a chain, forces of {forces}",
            put(ROW, {"table.forces": doubles(*forces)}),
            "is no number",
        )
        for forces in ((0.0, nan, 0.0, 1.0), (nan,) * 4, (0.0, 0.0, inf, 0.0))
    ),
    refused("no cell", small("storage", {"taps_N_per_m": [1]}, counts(1, 0), [], 9), EMPTY),
    *(
        refused(
            f"{kind}, one value just too large",
            small(kind, {"taps_N_per_m": [0]}, domain, values, 1),
            TOO_LARGE,
        )
        for kind, domain, values in (
            ("storage", counts(0, 1), [0, 0, 1 << 53, 0]),
            ("coarse storage", cells(-2, 1), [0, 1 << 53, 0, 0]),
        )
    ),
    *(
        refused(
            f"{kind}, forces outwards just too large",
            small(kind, law, domain, [0] * size, 1),
            TOO_LARGE,
        )
        for kind, law, domain, size in (
            ("storage", {"taps_N_per_m": [], "points_m_N": [[0, -(1 << 52)]]}, counts(0, 1), 4),
            ("coarse storage", {**SPRING_OF_1, "taps_N_per_m": [-(1 << 51)]}, cells(-2, 2), 6),
        )
    ),
    refused(
        "forces at the far end too large",
        small("storage", {"taps_N_per_m": [1 << 52]}, counts(0, 2), [0] * 6, 1),
        FORCES_TOO_LARGE,
    ),
    refused(
        "cells, forces outwards above any whole number that is kept",
        small("coarse storage", {**SPRING_OF_1, "taps_N_per_m": [-(1 << 90)]}, cells(-2, 2), [0] * 6, 1),
        FORCES_TOO_LARGE,
    ),
]
