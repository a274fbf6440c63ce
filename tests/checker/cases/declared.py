"""What is declared of every kind: its JSON Schema as it is shipped, and how a document is shown, `shown.txt`.
Of every format: what documents consist of, `formats.txt`.

    python -m zwidth.checker.schema
    (cd tests/checker && python -m cases.declared)

write all anew.
"""

from __future__ import annotations

from collections.abc import Iterator
from importlib import import_module
from itertools import zip_longest
from pathlib import Path
from pkgutil import iter_modules
from tempfile import TemporaryDirectory
from typing import Any

import zwidth

from . import Case, plain

HERE = Path(__file__).parent


def shown() -> list[str]:
    """The rows of the first document of each kind that is accepted, and of the first that turns."""
    verify = import_module("zwidth.checker").verify
    lines, seen = [], set()
    for name in sorted(module.name for module in iter_modules([str(HERE)]) if module.name != "declared"):
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


def schemas_are_written() -> str:
    """One for each kind; no other is left, and nothing else is touched."""
    schema = import_module("zwidth.checker.schema")
    with TemporaryDirectory() as name:
        folder = Path(name, "new")
        schema.write(folder)
        names = {path.name for path in folder.iterdir()}
        for other in ("other.json", "notes.txt"):
            (folder / other).touch()
        schema.write(folder)
        if {path.name for path in folder.iterdir()} != {*names, "notes.txt"} or "spring.json" not in names:
            return f"{names}"
        return (
            "" if (folder / "spring.json").read_text(encoding="utf-8") == schema.text_of("spring") else "text"
        )


def rows_are_those_that_were_shown() -> str:
    """What a proof shows of itself."""
    return first_other("shown.txt", shown())


def first_other(file: str, now: list[str]) -> str:
    """The first line that is not as in a file."""
    pairs = zip_longest((HERE / file).read_text(encoding="utf-8").splitlines(), now, fillvalue="")
    return next((f"{said!r}, now {line!r}" for said, line in pairs if said != line), "")


def formats() -> list[str]:
    """What a document of each format consists of, and a scope."""
    whole = import_module("zwidth.checker.whole")
    lines = [f"{name}: {one}" for table in (whole.SHAPES, whole._SCOPE) for name, one in table.items()]
    return [*lines, str(whole._OF_A_SCOPE), f"{whole._HANDS}", f"{whole.EVIDENCE}"]


def formats_are_those_that_were_told() -> str:
    """An entry that is missed would be refused, and one more would be told without proof."""
    return first_other("formats.txt", formats())


_MOTION = {"energy", "sample_period", "positions"}
_ARMS = ("leader", "follower")
_PARTS_OF_A_PROOF = {
    "slow hands": {"enough"},
    "storage": {"force_unit", "storage"},
    "coarse storage": {"force_unit", "storage"},
    "row storage": {"force_unit", "storage", "table"},
    "motion": {*_MOTION, "repeats", "switch_positions"},
    "contact motion": {*_MOTION, "repeats", "switch_positions"},
    "touching motion": {*_MOTION, "switch_positions"},
    "row motion": {*_MOTION, "repeats", "forces"},
    "held pair motion": _MOTION,
    "pair motion": {
        "energy", "sample_period", "repeats",
        *(f"{arm}_{what}" for arm in _ARMS for what in ("positions", "switch_positions")),
    },
    "absolute stability": {"center", "convexity", "smoothness", "taps"},
    "vibration": {"inside"},
}  # fmt: skip
_OF_A_ROW = {f"law.{name}" for name in ("counts_force_limit", "counts_force_resolution", "specification")}


def what_is_shown() -> str:
    """All but kind, format and proof, and other parts of one; arms, hand, spring and transmission by their
    names."""
    kinds = import_module("zwidth.checker.kinds")
    for kind in kinds.KINDS:
        record = kinds.fields_of(kind)
        hidden = {name for name, field in _within(record) if not field.shown} - {"proof"}
        right = {"kind", "format", *_PARTS_OF_A_PROOF.get(kind, ())} | (
            _OF_A_ROW if kind.startswith("row ") else set()
        )
        named = {name for name, field in _within(record) if getattr(field, "named", False)}
        arms = {f"loop.{arm}" for arm in _ARMS} if "pair" in kind else set()
        words = {"held": "held", "null space": "spring", "transmission": "transmission"}
        others = {part for word, part in words.items() if word in kind}
        proof = record.fields.get("proof")
        if hidden != right or named != arms | others or (proof and proof.shown):
            return f"{kind}: {hidden} are not shown, {named} by their names"
    return ""


def _within(record: Any, before: str = "") -> Iterator[tuple[str, Any]]:
    """Every entry of what is shown, as in "loop.delay"."""
    for name, field in getattr(record, "fields", {}).items():
        yield before + name, field
        if field.shown:
            yield from _within(field, f"{before}{name}.")


CASES = [
    Case("what is shown", what_is_shown, ""),
    Case("schemas are those that are shipped", schemas_are_those_that_are_shipped, ""),
    Case("schemas are written", schemas_are_written, ""),
    Case("rows", rows_are_those_that_were_shown, ""),
    Case("formats", formats_are_those_that_were_told, ""),
]

if __name__ == "__main__":
    for name, told in (("shown.txt", shown()), ("formats.txt", formats())):
        (HERE / name).write_text("\n".join(told) + "\n", encoding="utf-8")
