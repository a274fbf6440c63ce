"""The slow twin of the checks of storage functions, and the checker where nothing but Python is installed."""

from __future__ import annotations

import json
import shutil
import subprocess
import sys
from fractions import Fraction
from pathlib import Path
from random import Random
from typing import Any

import pytest
from cases import plain, put
from cases.linear import CASES as LINEAR
from cases.spring import spring
from cases.storage import CASES, STORAGES, packed, unpacked
from twins import fast, plainly

from zwidth import checker
from zwidth.checker.storage import plainly as choice
from zwidth.checker.storage.plainly import MOST_MOVES

ALLOWED = 40
"""Units by which V may be less than the fast checks want, which allow for their rounding: 33 were found."""
HOUSE = Path(checker.__file__).parent


def stored(name: str) -> Any:
    """A small document, as it stands in a file."""
    return plain(STORAGES[name]["document"])


def less(document: Any, state: int, by: int) -> Any:
    """V lowered at one state."""
    values = unpacked(document["storage"])
    values[state] -= by
    return put(document, {"storage": packed(values)})


@pytest.mark.parametrize("name", STORAGES)
def test_what_is_true_is_accepted_by_both(name: str) -> None:
    """In the same words."""
    assert plainly(stored(name)) == fast(stored(name))
    assert plainly(stored(name)).valid


@pytest.mark.parametrize("name", [name for name in STORAGES if name != "two frictions"])
def test_a_value_too_small_is_refused_by_both(name: str) -> None:
    """Where V is tight, less by no more than the fast checks allow for rounding: a part in 10⁸ or less."""
    tight = [
        state for state in STORAGES[name]["tight"] if unpacked(stored(name)["storage"])[state] >= ALLOWED
    ]
    for state in tight[:: max(1, len(tight) // 6)]:
        lowered = less(stored(name), state, ALLOWED)
        assert "takes out more" in plainly(lowered).words, state
        assert "takes out more" in fast(lowered).words, state


def test_each_triangle_may_have_the_model_of_friction_that_suits_it() -> None:
    """So the twin accepts a little more than the fast check, which gives all moves of a length one model."""
    document = stored("two frictions")
    tight = STORAGES["two frictions"]["tight"]
    accepted = {
        (plainly(lowered).valid, fast(lowered).valid)
        for state in tight
        for by in (1000, 10**10)
        if unpacked(document["storage"])[state] >= by
        for lowered in [less(document, state, by)]
    }
    assert accepted == {(True, False), (False, False)}


@pytest.mark.parametrize("name", STORAGES)
def test_a_device_that_is_worse_is_refused_by_both(name: str) -> None:
    """By some hundredths of its friction, resolution or period."""
    for key, factor in STORAGES[name]["worse"].items():
        size = Fraction(stored(name)["loop"][key]) * (1 + 30 * (Fraction(factor) - 1))
        worse = plain(put(stored(name), {f"loop.{key}": size}))
        assert "takes out more" in plainly(worse).words, key
        assert "takes out more" in fast(worse).words, key


def test_the_twin_accepts_what_the_fast_check_accepts() -> None:
    """And what the one refuses for what it is, not for the size of its numbers, the other refuses."""
    for case in (case for case in CASES if "a unit less" not in case.name):
        document = plain(case.document)
        one, other = fast(document), plainly(document)
        sizes = ("takes out more", "too large to be compared")
        if one.valid or not any(words in one.words for words in sizes):
            assert other.valid is one.valid, (case.name, one, other)


def tampered(rng: Random, values: list[int]) -> list[int]:
    """Some values raised or lowered, by little or much."""
    changed, size = list(values), max(values) >> rng.choice((0, 10, 20))
    for state in rng.sample(range(len(values)), rng.choice((1, 1, 2, 5))):
        changed[state] = max(0, changed[state] + rng.choice((-1, 1)) * rng.randrange(1, size))
    return changed


def better(document: Any) -> Any:
    """A device with so little more friction that it pays for what the fast check allows for its rounding."""
    friction = Fraction(document["loop"]["coulomb_friction_N"])
    return plain(put(document, {"loop.coulomb_friction_N": friction * (1 + Fraction(1, 10**8))}))


ROUNDED = [
    n for n in STORAGES if "relaxing" not in stored(n)["law"] and "coulomb_friction_N" in stored(n)["loop"]
]
"""Where the fast check rounds what moves cost, and nothing else: more friction makes up for it."""


@pytest.mark.parametrize("name", STORAGES)
def test_they_agree_on_values_that_were_tampered_with(name: str) -> None:
    """The twin accepts what the fast check accepts, and no more than it would with a hair more friction."""
    rng, document = Random(name), stored(name)
    accepted = 0
    for _ in range(12):
        told = put(document, {"storage": packed(tampered(rng, unpacked(document["storage"])))})
        one, other = fast(told), plainly(told)
        accepted += other.valid
        assert other == one if one.valid else other.valid is False or fast_enough(name, told)
    assert accepted < 12


def fast_enough(name: str, told: Any) -> bool:
    """True where rounding may be all that the two checks differ in."""
    return name not in ROUNDED or fast(better(told)).valid


def test_a_grid_must_hold_the_average_that_begins_anew() -> None:
    """On a grid outside alone it would be 0, at no level of the grid."""
    law = {"surface": "none", "clamped": False, "taps_N_per_m": [0], "resets": True}
    outside = put(
        stored("solid"),
        {
            "law": {**law, "relaxing": {"pole": 0, "stiffness_N_per_m": 0}},
            "domain.lowest_count": -9,
            "domain.highest_count": -8,
            "domain.steps_per_count": 1,
            "storage": packed([0] * 8),
        },
    )
    assert "begins anew" in fast(outside).words
    assert "leaves the grid" in plainly(outside).words


def test_a_grid_that_is_too_large_is_refused_before_any_work() -> None:
    """In a sentence that names the bound and what would do."""
    large = put(stored("spring"), {"domain.steps_per_count": 1000})
    words = plainly(large).words
    assert str(MOST_MOVES) in words
    assert "without numpy" in words


@pytest.mark.parametrize("name", ["spring", "coarse", "row"])
def test_without_numpy_the_twin_checks(name: str, monkeypatch: pytest.MonkeyPatch) -> None:
    """Where it cannot be imported, whatever the reason."""
    monkeypatch.setitem(sys.modules, "numpy", None)
    monkeypatch.setattr(choice, "FAST", {})
    assert checker.verify(stored(name)).valid


ALONE = """
import json, sys

class NotInstalled:
    def find_spec(self, name, path=None, target=None):
        if name.partition(".")[0] not in {*sys.stdlib_module_names, "checker"}:
            raise ImportError(name)

sys.meta_path.insert(0, NotInstalled())
import checker

print(json.dumps([checker.verify(document)[:2] for document in json.load(sys.stdin)]))
"""


def test_the_folder_of_the_checker_stands_by_itself(tmp_path: Path) -> None:
    """Copied elsewhere, under another name, with nothing but Python: it proves and refuses all the same."""
    shutil.copytree(HOUSE, tmp_path / "checker", ignore=shutil.ignore_patterns("__pycache__"))
    linear = next(c.document for c in LINEAR if not c.refusal)
    false = less(stored("spring"), STORAGES["spring"]["tight"][-1], ALLOWED)
    documents = plain([spring(4), linear, *map(stored, ("spring", "solid", "coarse", "row")), false])
    done = subprocess.run(
        [sys.executable, "-S", "-c", ALONE],  # without the folder of what is installed
        cwd=tmp_path,
        input=json.dumps(documents),
        capture_output=True,
        text=True,
        check=True,
    )
    valid = [found for found, _ in json.loads(done.stdout)]
    assert valid == [True] * 6 + [False], done.stdout
