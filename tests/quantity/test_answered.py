"""What a result says, declared once: plain data, rows, and the page of keys."""

from __future__ import annotations

from dataclasses import dataclass
from functools import cached_property
from math import inf
from pathlib import Path

import pytest

from zwidth.quantity.answered import answered, answers, data_of, declared, known, plain, rows_of
from zwidth.quantity.documented import Documented


@dataclass(frozen=True)
class _Part(Documented):
    size: int = answered("of the file", unit="bytes")


@dataclass(frozen=True, repr=False)
class _Pressed(Documented):
    _FORMAT = "zwidth pressed 1"

    motion: str = answered("linear or rotary")
    stiffness: float | None = answered("how stiff it is", quantity="stiffness", row="largest stiffness")
    late: tuple[float, float] = answered("late", unit="s", names=("half", "all"), row=("half", "at most"))
    part: _Part | None = answered("a part", default=None)
    cut: bool | None = answered("only where it was cut", default=None, optional=True)
    note: str = known("for a screen", default="")
    file: Path = answered("where it is", default=Path("a", "b"))

    @property
    @answers("twice as much", quantity="stiffness", key="doubled")
    def twice(self) -> float:
        return 2 * (self.stiffness or 0)

    @cached_property
    @answers("of the part", stands_as={"bytes": "size"})
    def inner(self) -> _Part | None:
        return self.part


def test_plain_data_has_the_unit_of_the_motion_in_each_key():
    pressed = _Pressed("rotary", 2.0, (0.1, 0.2), _Part(7))
    assert pressed.to_dict() == {
        "format": "zwidth pressed 1",
        "motion": "rotary",
        "stiffness_N_m_per_rad": 2.0,
        "late_s": {"half": 0.1, "all": 0.2},
        "part": {"size_bytes": 7},
        "file": str(Path("a", "b")),
        "doubled_N_m_per_rad": 4.0,
        "bytes": 7,
    }
    assert _Pressed("linear", None, (0, 0), cut=True).to_dict()["cut"] is True


@dataclass(frozen=True)
class _Seen:
    """Neither saved nor shown by itself."""

    silent: float = answered("since it was heard", unit="s", finite=True)

    @property
    @answers(unit="s", finite=True)
    def twice(self) -> tuple[float, float]:
        """Twice as
        long.

        No more.
        """
        return (2 * self.silent, 1.0)


def test_a_part_says_what_it_declares_and_a_number_without_bound_is_null():
    assert plain([_Seen(inf)]) == [{"silent_s": None, "twice_s": [None, 1.0]}]
    assert declared(_Seen)["twice"].meaning == "twice as long"


def test_a_part_that_is_missing_is_null():
    """Its keys stay, so that whoever reads them needs to ask nothing."""
    data = data_of(_Pressed("linear", None, (0.0, 0.0)))
    assert (data["part"], data["bytes"], data["stiffness_N_per_m"]) == (None, None, None)
    assert "cut" not in data
    assert "note" not in data


def test_rows_are_what_has_words_and_each_number_has_its_unit():
    assert list(rows_of(_Pressed("linear", None, (1e-3, inf)))) == [
        ("largest stiffness", "none"),
        ("half", "1 ms"),
        ("at most", "any"),
    ]


def test_names_and_entries_of_a_tuple_must_be_as_many():
    """One name too few would leave a number out of every file."""
    with pytest.raises(ValueError, match="zip"):
        data_of(_Pressed("linear", 1.0, (0.0, 1.0, 2.0)))


def test_what_is_declared_is_known_of_class_and_result():
    names = ["motion", "stiffness", "late", "part", "cut", "note", "file", "twice", "inner"]
    assert list(declared(_Pressed)) == list(declared(_Pressed("linear", 1, (0, 0)))) == names


@dataclass(frozen=True)
class _About:
    motion: str


@dataclass(frozen=True, repr=False)
class _Limits(Documented):
    motion: str = known("no unit: how the hand moves")
    factors: tuple[float | None, ...] = answered("what may be", unit="N", finite=True)
    words: tuple[str, ...] = answered("if any", optional=True, default=())
    nothing: float | None = answered("if known", optional=True, default=0.0)

    @property
    def scope(self) -> _About:
        return _About("rotary")

    @property
    @answers(quantities=True)
    def needs(self) -> dict[str, dict[str, float]]:
        """What is needed."""
        return {"leader": {"damping": 1.0}}

    @property
    @answers("how likely each cause is")
    def likely(self) -> dict[str, float]:
        return {"delay": 0.5}


def test_units_are_those_of_the_scope_and_of_quantities_inside():
    """What is without bound is null, what is empty is left out, a 0 is not; a docstring says what it is."""
    limits = _Limits("to and fro", (inf, None, 2.0))
    assert limits.to_dict() == {
        "factors_N": [None, None, 2.0],
        "nothing": 0.0,
        "needs": {"leader": {"damping_N_m_s_per_rad": 1.0}},
        "likely": {"delay": 0.5},
    }
    assert _Limits("", (), ("a",)).to_dict()["words"] == ["a"]
    assert declared(limits)["needs"].meaning == "what is needed"
