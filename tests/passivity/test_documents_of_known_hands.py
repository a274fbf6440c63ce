"""Documents of a known hand with something absurd in any place: refused or decided, never an exception."""

from __future__ import annotations

import copy
from collections.abc import Iterator
from typing import Any

import pytest

from zwidth import checker

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


HELD = {
    "mass_kg": "0.036",
    "damping_N_s_per_m": "0.15",
    "hand_mass_kg": "0.006",
    "hand_damping_N_s_per_m": "1.7",
    "hand_stiffness_N_per_m": "500",
    "sample_period_s": "0.001",
    "delay_s": "0",
}
OF_LOOPS: dict[str, dict[str, Any]] = {
    "stability": DOCUMENTS["stability"],
    "absolute stability": {
        "kind": "absolute stability",
        "nonlinearity": "monotone",
        "loop": HELD,
        "slope": "10",
        "center": "1",
        "taps": [],
        "convexity": "0",
        "smoothness": "0",
    },
    "spring": {
        "kind": "spring",
        "loop": {
            "damping_N_s_per_m": "0.15",
            "coulomb_friction_N": "0.12",
            "resolution_m": "0.00002",
            "sample_period_s": "0.001",
            "delay_s": "0",
            "numerator": ["100"],
            "denominator": ["1"],
            "unilateral": True,
        },
    },
}


@pytest.mark.parametrize("name", OF_LOOPS)
def test_what_is_not_read_is_refused(name: str) -> None:
    """An entry beside those of the proof would be shown as if it had been checked."""
    document = OF_LOOPS[name]
    assert checker.verify(document).valid, checker.verify(document).reason
    for key in ("coulomb_friction_mN", "force_limit_N", "virtual_wall"):
        found = checker.verify({**document, "loop": {**document["loop"], key: "1"}})
        assert not found.valid
    noted = checker.verify({**document, "loop": {**document["loop"], "note": 1}})
    assert noted.reason == "entries that no proof of this kind has: loop.note"


@pytest.mark.parametrize("name", OF_LOOPS)
def test_a_number_is_in_its_unit(name: str) -> None:
    """A damping in mN·s/m, or in no unit at all, is not read as one in N·s/m."""
    document = OF_LOOPS[name]
    loop = {key: value for key, value in document["loop"].items() if key != "damping_N_s_per_m"}
    damping = document["loop"]["damping_N_s_per_m"]
    for key in ("", "_N_s_per_mm", "_N_s", "_kg", "_mN_s_per_m", "_N_per_m"):
        found = checker.verify({**document, "loop": {**loop, f"damping{key}": damping}})
        assert not found.valid, key
        assert "unit of damping must be that of damping_N_s_per_m" in found.reason
