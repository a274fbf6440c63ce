"""Documents of a known hand with something absurd in any place: refused or decided, never an exception."""

from __future__ import annotations

import copy
from collections.abc import Iterator
from typing import Any

import pytest

from zwidth.passivity import checker

LOOP = {
    "mass_kg": "0.05",
    "damping_N_s_per_m": "0.7",
    "stiffness_N_per_m": "350",
    "sample_period_s": "0.001",
    "delay_s": "0.0004",
    "numerator": ["1200", "-400"],
    "denominator": ["1", "0"],
}
DOCUMENTS: dict[str, dict[str, Any]] = {
    "stability": {"kind": "stability", "loop": {**LOOP, "mass_kg": ["0.05", "0.07"]}},
    "instability": {"kind": "instability", "loop": {**LOOP, "numerator": ["99000", "-400"]}},
    "vibration": {
        "kind": "vibration",
        "plant": {"numerator": ["2", "0.92"], "denominator": ["1", "-0.5", "0"]},
        "slope": "0.92",
        "gap": "-1",
        "inside": [True, False, False],
    },
}
ABSURD = [
    "1e4000",
    "-1e-4000",
    "0",
    "1/0",
    "",
    None,
    True,
    [],
    {},
    "nan",
    10**300,
    -1,
    ["1", "0"],
    ["0", "1e9"],
]


def places(value: Any, path: tuple[Any, ...] = ()) -> Iterator[tuple[Any, ...]]:
    """Every place of a document, lists and objects too."""
    if path:
        yield path
    items = value.items() if isinstance(value, dict) else enumerate(value) if isinstance(value, list) else ()
    for key, inner in items:
        yield from places(inner, (*path, key))


@pytest.mark.parametrize("name", DOCUMENTS)
def test_as_it_is_and_with_a_part_missing(name: str) -> None:
    """Accepted whole; refused without any one of its entries."""
    document = DOCUMENTS[name]
    assert checker.verify(document).valid
    for path in places(document):
        if isinstance(path[-1], str):
            broken = copy.deepcopy(document)
            inner = broken
            for key in path[:-1]:
                inner = inner[key]
            del inner[path[-1]]
            assert not checker.verify(broken).valid, path


@pytest.mark.parametrize("name", DOCUMENTS)
def test_absurd_values_never_raise(name: str) -> None:
    """Whatever stands in one place, the answer is a verification with a reason."""
    for path in places(DOCUMENTS[name]):
        for value in ABSURD:
            broken = copy.deepcopy(DOCUMENTS[name])
            inner = broken
            for key in path[:-1]:
                inner = inner[key]
            inner[path[-1]] = value
            found = checker.verify(broken)
            assert isinstance(found.reason, str)
            assert found.energy is None
