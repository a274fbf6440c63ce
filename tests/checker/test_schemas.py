"""The JSON Schemas that are shipped: those of the declarations, and of one mind with the checker."""

from __future__ import annotations

import json
from collections.abc import Iterator, Mapping
from functools import cache
from typing import Any

import pytest
from cases import Case, all_cases, plain, put, without
from cases import accepted as of_corners
from jsonschema import Draft202012Validator

from zwidth import checker
from zwidth.checker.kinds import KINDS
from zwidth.checker.schema import FOLDER, file_of, text_of, write
from zwidth.quantity.text import to_json

ALL = [*KINDS, "corners"]


@cache
def validator(kind: str) -> Draft202012Validator:
    """Of the file that is shipped."""
    return Draft202012Validator(json.loads((FOLDER / file_of(kind)).read_text(encoding="utf-8")))


@cache
def accepted() -> dict[str, list[Case]]:
    """The true documents among the cases, by kind."""
    found: dict[str, list[Case]] = {kind: [] for kind in ALL}
    for case in all_cases():
        if isinstance(case.document, dict) and not case.refusal:
            found[case.document["kind"]].append(case)
    several = {"kind": "corners", "corners": [found[kind][0].document for kind in ("spring", "contact")]}
    return {**found, "corners": [of_corners("two corners", several)]}


def a_document(kind: str) -> Any:
    """A true one that says little."""
    return min((case.document for case in accepted()[kind]), key=lambda document: len(json.dumps(document)))


@pytest.mark.parametrize("kind", ALL)
def test_what_is_shipped_is_what_is_declared(kind: str) -> None:
    """To the byte; `python -m zwidth.checker.schema` writes it anew."""
    assert (FOLDER / file_of(kind)).read_bytes().decode() == text_of(kind)


def test_nothing_else_is_shipped(tmp_path: Any) -> None:
    """One file for each kind; writing removes what is of none."""
    assert {path.name for path in FOLDER.iterdir()} == set(map(file_of, ALL))
    (tmp_path / "old-kind.json").touch()
    write(tmp_path)
    assert {path.name for path in tmp_path.iterdir()} == set(map(file_of, ALL))


@pytest.mark.parametrize("kind", ALL)
def test_a_schema_is_one(kind: str) -> None:
    """By the rules for schemas of its dialect."""
    Draft202012Validator.check_schema(json.loads(text_of(kind)))


@pytest.mark.parametrize("kind", ALL)
def test_true_documents_fit_their_schema(kind: str) -> None:
    """Every one among the cases, as it stands in a file."""
    for case in accepted()[kind]:
        assert checker.verify(case.document).valid, case.name
        assert validator(kind).is_valid(json.loads(to_json(case.document))), case.name
    assert accepted()[kind]


def entries(document: Any, at: str = "") -> Iterator[tuple[str, Any]]:
    """Every entry of an object or list within, by its path."""
    inner = document.items() if isinstance(document, Mapping) else enumerate(document)
    for key, value in inner:
        yield f"{at}{key}", value
        if isinstance(value, (Mapping, list)):
            yield from entries(value, f"{at}{key}.")


def refused_by_both(kind: str, document: Any) -> bool:
    return not validator(kind).is_valid(document) and not checker.verify(document).valid


@pytest.mark.parametrize("kind", ALL)
def test_an_entry_too_many_is_refused_by_both(kind: str) -> None:
    """At any depth, beside every other."""
    document = a_document(kind)
    inside = [path for path, value in entries(document) if isinstance(value, Mapping)]
    for place in ("", *(f"{path}." for path in inside)):
        assert refused_by_both(kind, put(document, {f"{place}remark": 1})), place


@pytest.mark.parametrize("kind", ALL)
def test_an_entry_too_few_is_refused_by_both(kind: str) -> None:
    """Whatever the schema says is required; of lists of sorts, what no sort does without."""
    document = a_document(kind)
    refused = 0
    for path, _ in entries(document):
        if path.rpartition(".")[2].isdigit():
            continue
        less = without(document, path)
        if not validator(kind).is_valid(less):
            assert not checker.verify(less).valid, path
            refused += 1
    assert refused


@pytest.mark.parametrize("kind", ALL)
def test_another_type_is_refused_by_both(kind: str) -> None:
    """Nothing, and an empty object, stand for no entry."""
    document = a_document(kind)
    for path, _ in entries(document):
        for value in (None, {}):
            assert refused_by_both(kind, put(document, {path: value})), (path, value)


UNITS = ("_N_s_per_m", "_kg", "_N_per_m", "_m_N", "_m", "_N", "_s")


@pytest.mark.parametrize("kind", ALL)
def test_another_unit_is_refused_by_both(kind: str) -> None:
    """Of one entry alone, of a quantity that has one."""
    document = a_document(kind)
    for path, value in entries(document):
        unit = next((unit for unit in UNITS if path.endswith(unit)), None)
        if unit is not None:
            other = put(without(document, path), {f"{path.removesuffix(unit)}_ft": value})
            assert refused_by_both(kind, other), path


@pytest.mark.parametrize(
    ("entry", "value"),
    [
        ("damping_N_s_per_m", -1),
        ("sample_period_s", 0),
        ("unilateral", 1),
        ("numerator", []),
        ("delay_s", "1 s"),
    ],
)
def test_a_value_out_of_its_bounds_is_refused_by_both(entry: str, value: Any) -> None:
    """Of numbers as numbers; as text their form is bounded, and their size by the checker alone."""
    document = put(a_document("spring"), {f"loop.{entry}": value})
    assert refused_by_both("spring", document)


def test_bounds_hold_for_text_as_well() -> None:
    """As the schema's description says: it cannot refuse them, and the checker does."""
    document = plain(put(a_document("spring"), {"loop.damping_N_s_per_m": "-1"}))
    assert validator("spring").is_valid(document)
    assert "must be ≥ 0" in checker.verify(document).reason
    assert "bounds hold" in json.loads(text_of("spring"))["description"]


@pytest.mark.parametrize("text", ["8/-2", "", " 4", "4_0", "nan", "٤", "4,0", "0x4"])
def test_text_that_is_no_number_is_refused_by_both(text: str) -> None:
    """In a place where one must stand."""
    assert refused_by_both("spring", put(a_document("spring"), {"loop.damping_N_s_per_m": text}))


def test_a_document_of_two_motions_is_refused_by_both() -> None:
    """Linear in one entry and rotary in another."""
    document = a_document("spring")
    mixed = put(without(document, "loop.resolution_m"), {"loop.resolution_rad": "0"})
    assert refused_by_both("spring", mixed)
