"""Every entry of every kind as it is declared, and how it is shown: `declared.txt` and `shown.txt`.

A line of the first is an entry: its key, of a slide and of a turn, ? where it may be left out, and what
it may be.  The second has the rows of one accepted document of each kind.
"""

from __future__ import annotations

from collections.abc import Iterator
from importlib import import_module
from pathlib import Path
from typing import Any

import zwidth

from . import Case, plain

HERE = Path(__file__).parent
FILES = (
    "absolute", "active_hand", "arm", "contact", "contact_motion", "delays", "force_bounding", "linear",
    "motion", "multiplier_contact", "nonlinear_spring", "positive_real", "positive_real_matrix", "quantized",
    "relaxing_contact", "rest", "rotary", "row_motion", "slow_hands", "spring", "storage",
    "touching_motion", "vibration", "violation",
)  # fmt: skip


def entries(schema: Any, path: str) -> Iterator[str]:
    """The lines of what is declared."""
    if "properties" in schema:
        closed = "" if schema["additionalProperties"] is False and schema["type"] == "object" else ", or more"
        yield f"{path}: these{closed}"
        for key, inner in schema["properties"].items():
            yield from entries(inner, f"{path}.{key}{'' if key in schema['required'] else '?'}")
    elif "oneOf" in schema:
        for place, inner in enumerate(schema["oneOf"]):
            yield from entries(inner, f"{path}/{place}")
    elif "items" in schema and "properties" in schema["items"] | schema["items"].get("oneOf", [{}])[0]:
        yield f"{path}: {_sizes(schema)}"
        yield from entries(schema["items"], f"{path}[]")
    else:
        yield f"{path}: {_sort(schema)}"


def _sizes(schema: Any) -> str:
    return f"{schema['type']} of {schema['minItems']} to {schema['maxItems']}"


def _sort(schema: Any) -> str:
    """What is no object, in a line."""
    if "anyOf" in schema:
        return " or ".join(map(_sort, schema["anyOf"]))
    if "items" in schema:
        return f"{_sizes(schema)} × ({_sort(schema['items'])})"
    if "pattern" in schema:
        return "text"
    return ", ".join(f"{name} {told}" for name, told in schema.items())


def declared() -> list[str]:
    """Of every kind; the key of a turn where it is another."""
    kinds = import_module("zwidth.checker.kinds")
    lines = []
    for kind in kinds.KINDS:
        sides = (entries(kinds.fields_of(kind).schema(motion), kind) for motion in ("linear", "rotary"))
        lines += [
            a if a == b else f"{a} | {b.rpartition(':')[0].rpartition('.')[2]}"
            for a, b in zip(*sides, strict=True)
        ]
    return lines


def shown() -> list[str]:
    """The rows of the first document of each kind that is accepted, and of the first that turns."""
    verify = import_module("zwidth.checker").verify
    lines, seen = [], set()
    for name in FILES:
        for case in import_module(f"{__package__}.{name}").CASES:
            kind = "" if case.refusal or callable(case.document) else case.document["kind"], name == "rotary"
            if kind[0] and kind not in seen:
                seen.add(kind)
                rows = verify(plain(case.document)).rows
                lines += [f"{kind[0]}, {case.name}", *("  " + " | ".join(map(str, row)) for row in rows)]
    return lines


def schemas_are_those_that_are_shipped() -> str:
    """Of every kind, and of corners, to the byte."""
    schema = import_module("zwidth.checker.schema")
    for kind in (*import_module("zwidth.checker.kinds").KINDS, "corners"):
        file = Path(zwidth.__file__).with_name("checker") / "schemas" / f"{kind.replace(' ', '-')}.json"
        if schema.text_of(kind).encode() != file.read_bytes():
            return f"the schema of {kind}"
    return ""


def differs(name: str, lines: list[str]) -> str:
    """The first line that is not as in the file."""
    told = (HERE / name).read_text(encoding="utf-8").splitlines()
    pairs = zip([*told, *[""] * len(lines)], [*lines, *[""] * len(told)], strict=False)
    return next((f"{said!r}, now {line!r}" for said, line in pairs if said != line), "")


CASES = [
    Case("entries", lambda: differs("declared.txt", declared()), ""),
    Case("schemas are those that are shipped", schemas_are_those_that_are_shipped, ""),
    Case("rows", lambda: differs("shown.txt", shown()), ""),
]

if __name__ == "__main__":
    (HERE / "declared.txt").write_text("\n".join(declared()) + "\n", encoding="utf-8")
    (HERE / "shown.txt").write_text("\n".join(shown()) + "\n", encoding="utf-8")
