"""Storage functions: every one a smallest, or nearly, so that one unit less at a state is less than a move
takes out.

They stand in `storages.json`, on boards of a few counts or cells.  The prover found them; each was then
lowered state
by state as far as it holds.
"""

from __future__ import annotations

import base64
import json
import zlib
from fractions import Fraction
from pathlib import Path
from typing import Any

from . import Case, accepted, put, refused, without

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


def board(name: str, phrase: str, **entries: Any) -> Case:
    """A board that is not what it must be."""
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

CASES = [
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
        refused(f"laws in a row that begin {what}", put(ROW, {"table.starts": starts}), phrase)
        for what, starts, phrase in (
            ("nowhere", [], "where a hand may begin"),
            ("in a list of one word", "0", "where a hand may begin"),
            ("in more states than there are", [0] * (ROW["table"]["states"] + 1), "where a hand may begin"),
            ("past the last state", [ROW["table"]["states"]], "not in the table"),
        )
    ),
    refused("laws in a row, a board of less", put(ROW, {"domain.lowest_count": -1}), "not on the board"),
    refused("laws in a row, a board of more", put(ROW, {"domain.lowest_count": -3}), "is not closed"),
    refused("laws in a row, a board of more inside", put(ROW, {"domain.highest_count": 2}), "is not closed"),
    refused(
        "laws in a row, a state less",
        put(ROW, {"table.states": ROW["table"]["states"] - 1}),
        "one value for each state",
    ),
    refused("laws in a row, part of a sample late", put(ROW, {"loop.delay_s": "0.0005"}), "whole samples"),
    refused(
        "a board that ends too near",
        put(STORAGES["damped"]["document"], {"domain.lowest_count": -2}),
        "must reach so far out",
    ),
    refused(
        "a board of a late force that ends too near",
        put(STORAGES["late"]["document"], {"domain.lowest_count": 0}),
        "must reach so far out",
    ),
    refused(
        "a board of a law that relaxes that ends too near",
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
            "from state 0 a move",
        )
        for name in STORED
    ),
    accepted(
        "without a surface a board may lie to one side",
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
        board(f"{name}: {what}", phrase, **{f"domain__{key}": value})
        for name in ("spring", "solid", "row")
        for what, key, value, phrase in (
            ("moves of no length", "largest_move_counts", 0, "longest move must be > 0"),
            ("moves back", "largest_move_counts", -1, "longest move must be > 0"),
            ("moves without end", "largest_move_counts", 10_000_001, "longest move must be > 0"),
            ("no step", "steps_per_count", 0, "whole number of at least 1"),
            ("a board turned round", "highest_count", -9, EMPTY),
            ("a count that is none", "lowest_count", "-1/2", "whole number of ordinary size"),
            ("a count far off", "lowest_count", -(10**7) - 1, "whole number of ordinary size"),
        )
    ),
    *(
        refused(
            f"{name}, the force unit is {unit}", put(STORAGES[name]["document"], {"force_unit": unit}), phrase
        )
        for name, phrase in (("spring", EMPTY), ("solid", EMPTY), ("row", EMPTY), ("coarse", "must be > 0"))
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
]
