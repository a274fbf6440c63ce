"""The sorts of entries that a document has: what each takes, what it refuses, and how it is shown.

Each case asks a sort directly, as no kind of document has all of them beside one another.
"""

from __future__ import annotations

from collections.abc import Callable, Iterator
from decimal import Decimal
from fractions import Fraction
from importlib import import_module
from typing import Any

from . import Case


def fields() -> Any:
    """As it is loaded now."""
    return import_module("zwidth.checker.document.fields")


def file() -> Any:
    """What reads a document by them."""
    return import_module("zwidth.checker.document.file")


def refusal(read: Callable[..., Any], *given: Any) -> str:
    """What is said against it; "" where it is taken."""
    try:
        read(*given)
    except Exception as error:
        return f"{type(error).__name__}: {error}"
    return ""


def first_wrong(pairs: Iterator[tuple[Any, Any]]) -> str:
    """The first that is not as it should be."""
    return next((f"{found!r}, not {right!r}" for found, right in pairs if found != right), "")


def _record() -> Any:
    """One entry of each sort, some of them left out."""
    f = fields()
    unit = import_module("zwidth.checker.document.number")
    inner = {"own_part": f.Number(unit.LENGTH), "hidden": f.Number(default=None, shown=False)}
    return f.Record(
        {
            "some_damping": f.Number(unit.DAMPING),
            "count": f.Whole(),
            "is_so": f.Flag(),
            "is_not": f.Flag(),
            "sort": f.Choice("this", 3),
            "remark": f.Words(5),
            "given_default": f.Number(default=7),
            "other_default": f.Number(default=7),
            "required": f.Words(5),
            "lengths": f.numbers(unit.LENGTH),
            "rows": f.List(f.numbers()),
            "sorts": f.List(f.Choice("this", "that")),
            "interval": f.Between(unit.LENGTH),
            "point": f.Between(unit.LENGTH),
            "named": f.Record(inner, named=True),
            "unnamed": f.Record(inner),
            "nothing": f.Record(inner, default=None),
            "list": f.List(f.Record(inner)),
            "one": f.OneOf("kind", {"a": f.Record({"size": f.Number(unit.LENGTH)}), "b": f.Record({})}),
            "either": f.Either(f.Record(inner), f.numbers(), lambda told: not isinstance(told, list)),
            "other": f.Either(
                f.Record(inner), f.numbers(unit.SECONDS), lambda told: not isinstance(told, list)
            ),
            "packed": f.Packed(),
        },
        default=None,
    )


_TOLD = {
    "some_damping_N_s_per_m": "1/3",
    "count": 4,
    "is_so": True,
    "is_not": False,
    "sort": 3,
    "remark": "12345",
    "other_default": 8,
    "required": "",
    "lengths_m": [1, "0.5"],
    "rows": [[1], []],
    "sorts": ["this", "that"],
    "interval_m": [1, 2],
    "point_m": 1,
    "named": {"own_part_m": 1},
    "unnamed": {"own_part_m": 2, "hidden": 3},
    "list": [{"own_part_m": 1}, {"own_part_m": 2}],
    "one": {"kind": "a", "size_m": 6},
    "either": {"own_part_m": 5},
    "other": list(range(13)),
    "packed": "AA==",
}
_ROWS = [
    ("some damping", "1/3", "N·s/m", False),
    ("count", "4", "", False),
    ("is so", "yes", "", False),
    ("is not", "no", "", False),
    ("sort", "3", "", False),
    ("remark", "12345", "", True),
    ("other default", "8", "", False),
    ("required", "", "", True),
    ("lengths", "[1, 0.5]", "m", False),
    ("rows", "[[1], []]", "", False),
    ("sort 1", "this", "", False),
    ("sort 2", "that", "", False),
    ("interval", "1 to 2", "m", False),
    ("point", "1", "m", False),
    ("named: own part", "1", "m", False),
    ("own part", "2", "m", False),
    ("list 1", "own part 1 m", "", False),
    ("list 2", "own part 2 m", "", False),
    ("size", "6", "m", False),
    ("kind", "a", "", False),
    ("own part", "5", "m", False),
    ("other", "[0, 1, 2, 3, 4, 5, 6, 7, 8, 9, 10, 11, …]", "s", False),
]


_ROTARY = {
    "some_damping_N_s_per_m": "some_damping_N_m_s_per_rad",
    **{f"{name}_m": f"{name}_rad" for name in ("lengths", "interval", "point", "own_part", "size")},
}


def rows_of_every_sort() -> str:
    """What is a part of the proof is not shown, nor what is left out; all else is."""
    turned = [_turned(row) for row in _ROWS]
    return first_wrong(iter([(_rows(_TOLD), _ROWS), (_rows(_turning(_TOLD)), turned)]))


def _rows(told: Any) -> list[tuple[Any, ...]]:
    record = fields().document({"told": _record()})
    read, motion = file().read_document(record, {"format": "words", "told": told})
    return [tuple(row) for row in record.rows("", read, motion)]


def _turning(told: Any) -> Any:
    """The same of a device that turns."""
    if isinstance(told, dict):
        return {_ROTARY.get(key, key): _turning(value) for key, value in told.items()}
    return [_turning(value) for value in told] if isinstance(told, list) else told


def _turned(row: tuple[Any, ...]) -> tuple[Any, ...]:
    name, text, unit, told = row
    return name, text.replace(" m", " rad"), {"m": "rad", "N·s/m": "N·m·s/rad"}.get(unit, unit), told


def sorts_take_what_they_declare() -> str:
    """A true or a text of digits is no number of a choice; text has a largest length; bytes are no list."""
    f = fields()
    taken = [
        (f.Choice(1, "b"), 1), (f.Choice(1, "b"), "b"), (f.Words(3), "abc"), (f.List(f.Number()), (1, 2)),
        (f.Between(f.NONE), [1, 1]), (f.Flag(), False), (f.Packed(), ""), (f.Whole(), "4/2"),
    ]  # fmt: skip
    not_taken = [
        (f.Choice(1, "b"), 1.0, "at must be 1 or b"), (f.Choice(1, "b"), True, "at must be 1 or b"),
        (f.Choice(1, "b"), ["b"], "at must be 1 or b"), (f.Choice(1, "b"), "1", "at must be 1 or b"),
        (f.Words(3), "abcd", "at must be text of at most 3 letters"),
        (f.Words(3), 3, "at must be text of at most 3 letters"),
        (f.List(f.Number()), b"12", "at must be a list"), (f.List(f.Number()), "12", "at must be a list"),
        (f.List(f.Number(least=0)), [1, -1], "at[1] must be ≥ 0, got -1"),
        (f.Whole(), "1/2", "at must be a whole number, got 0.5"),
        (f.Whole(), "b", "at: expected a number, got 'b'"),
        (f.Between(f.NONE, least=0), [-1, 1], "at must be ≥ 0, got -1"),
        (f.Between(f.NONE), [2, 1], "at must begin at the smaller end of the interval"),
        (f.OneOf("kind", {"a": f.Record({})}), {"kind": 1}, "at.kind must be a"),
    ]  # fmt: skip
    return first_wrong(
        (refusal(sort.read, value, "at", "linear"), "") for sort, value in taken
    ) or first_wrong(
        (refusal(sort.read, value, "at", "linear"), f"Invalid: {said}") for sort, value, said in not_taken
    )


def keys_that_are_unknown() -> str:
    """A quantity in another unit is told as one, in any order; of a long name the beginning is."""
    f, unit = fields(), import_module("zwidth.checker.document.number")
    record = f.Record({n: f.Number(u, default=None) for n, u in [("z", unit.LENGTH), ("size", unit.NONE)]})
    said = {
        "z": "the unit of z must be that of z_m, got p.z",
        "z_rad": "the unit of z must be that of z_m, got p.z_rad",
        "size_m": "entries that no proof of this kind has: p.size_m",
        "zed": "entries that no proof of this kind has: p.zed",
        "x" * 60 + "y": f"entries that no proof of this kind has: p.{'x' * 60}",
    }
    return first_wrong(
        (refusal(record.read, {key: 1}, "p", "linear"), f"Invalid: {right}") for key, right in said.items()
    )


def every_key_has_its_motion() -> str:
    """Linear or rotary by any key within, at any depth; a key that both have says nothing."""
    f, record = file(), _record()
    linear, rotary = f._keys_of_one_motion(record)
    mixed = "one document has the units of a linear device or of a rotary one: interval_m and lengths_rad"
    both = {"lengths_rad": [], "list": [{"x": [{"interval_m": 1}]}]}
    return first_wrong(
        iter(
            [
                (linear, set(_ROTARY)),
                (rotary, set(_ROTARY.values())),
                (f._motion(record, _TOLD), "linear"),
                (f._motion(record, {"list": [[{"own_part_rad": 1}]]}), "rotary"),
                (f._motion(record, {"count": 1}), "linear"),
                (refusal(f._motion, record, both), f"Invalid: {mixed}"),
            ]
        )
    )


def levels_are_counted_once() -> str:
    """Objects and lists within one another, twelve of them."""
    f = file()
    for make in (lambda inner: {"k": inner}, lambda inner: [inner]):
        deep: Any = {}
        for _ in range(f.MOST_LEVELS - 1):
            deep = make(deep)
        if said := refusal(list, f._told(deep)):
            return said
        if not refusal(list, f._told(make(deep))):
            return "a level too many"
    return ""


def numbers_of_every_type() -> str:
    """As Python has them: a float is the decimal that is written of it."""
    number = import_module("zwidth.checker.document.number").number
    tenth, whole = Fraction(1, 10), Fraction(4)
    pairs = [(0.1, tenth), ("0.1", tenth), (Decimal("0.1"), tenth), (tenth, tenth), (4, whole), (4.0, whole)]
    pairs += [
        (large, large) for large in (10**5000, Fraction(1, 10**5000))
    ]  # as text: too many digits for `int`
    return first_wrong((number(given), right) for given, right in pairs) or first_wrong(
        (refusal(number, given), f"Invalid: expected a number, got {type(given).__name__}")
        for given in (True, None, [4], b"4", 4j)
    )


def numbers_for_people() -> str:
    """All digits of a decimal that ends soon, a fraction as long as it is short, else about as much."""
    exactly = import_module("zwidth.checker.document.number").exactly
    pairs = [
        (Fraction(1, 4), "0.25"),
        (Fraction(-1, 3), "-1/3"),
        (Fraction(0), "0"),
    ]
    long = [
        (Fraction(1, 3 * 2**120), "/"),
        (Fraction(1, 3 * 2**126), "about"),
        (Fraction(2**64 - 59, 2**64 - 1), "/"),
        (Fraction(2**64 - 59, 2**64 + 1), "about"),
        (Fraction(1, 2**199), "e-60"),
        (Fraction(-(2**199)), "-8034"),
        (Fraction(1, 2**200), "about"),
        (Fraction(-(2**200)), "about"),
    ]
    return first_wrong((exactly(x), text) for x, text in pairs) or first_wrong(
        (word in exactly(x) and (word == "about") == ("about" in exactly(x)), True) for x, word in long
    )


def effort_is_counted_in_a_document() -> str:
    """And not outside of one; what is begun inside another goes on with its count."""
    effort = import_module("zwidth.checker.document.refusal")
    counts = [effort.spent()]
    with effort.one_document():
        effort.spend(3, each=1)
        with effort.one_document():
            effort.spend(4, each=1)
        counts.append(effort.spent())
    return first_wrong(zip([*counts, effort.spent()], [0, 7, 0], strict=True))


def parts_of_a_proof_are_not_shown() -> str:
    """Where a motion is, how often a part of it is done, and a law for who has it."""
    places = (("loop", "MOTION"), ("contact", "CONTACT_MOTION"), ("contact", "ROW_MOTION"))
    for name, kind in places:
        record = getattr(import_module(f"zwidth.checker.{name}.motion"), kind)
        for inner in ("positions", "switch_positions", "repeats", "forces"):
            if inner in record.fields and record.fields[inner].shown:
                return f"{inner} of {kind}"
    law = import_module("zwidth.checker.contact.law").TOLD_LAW
    return "specification" if law.fields["specification"].shown else ""


CHECKS = [
    rows_of_every_sort, sorts_take_what_they_declare, keys_that_are_unknown, every_key_has_its_motion,
    levels_are_counted_once, numbers_of_every_type, numbers_for_people,
    effort_is_counted_in_a_document, parts_of_a_proof_are_not_shown,
]  # fmt: skip
CASES = [Case(check.__name__.replace("_", " "), check, "") for check in CHECKS]
