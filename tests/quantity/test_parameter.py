"""Numbers, flags and words that a data class declares once."""

from __future__ import annotations

from dataclasses import dataclass
from fractions import Fraction

import pytest

from zwidth.errors import InputError
from zwidth.quantity import Exact, Interval
from zwidth.quantity.parameter import Parametric, flag, listed, parameter, parameters_of, plain, word
from zwidth.quantity.text import unit_text


@dataclass(frozen=True)
class Thing(Parametric):
    """One field of each form."""

    stiffness: Exact | Interval = parameter("stiffness", bound="≥ 0", why="it is a spring")
    damping: Exact = parameter("damping", "0.1", kept=Exact, bound="> 0", why="it damps", words=("any",))
    start: float = parameter(
        "position", -1, kept=float, bound="≤ 0", why="it is outside", meaning="first place"
    )
    level: Exact | None = parameter(plain("level", "of energy"), None, kept=Exact)
    forces: tuple[Exact, ...] = listed("force", (), meaning="some forces")
    fast: bool = flag("to hurry", False)
    kind: str = word("one", "two", "three")


def test_a_field_keeps_what_it_says():
    thing = Thing(("1 N/mm", "2000 N/m"))
    assert thing.stiffness == Interval(1000, 2000)
    assert thing.damping.fraction == Fraction(1, 10)
    assert type(thing.start) is float
    assert (thing.level, thing.forces, thing.fast, thing.kind) == (None, (), False, "one")
    other = Thing(3, "200 mN*s/m", "-3 mm", 7, ["20 mN", 1], True, "two")
    assert (other.damping.fraction, other.start) == (Fraction(1, 5), -0.003)
    assert [f.fraction for f in other.forces] == [Fraction(1, 50), 1]
    assert Thing(1, "any").damping == "any"
    assert Thing("5 N*m/rad", "0.3 N*m*s/rad", "-2 rad") == Thing(5, "0.3", -2)


@pytest.mark.parametrize(
    ("given", "said"),
    [
        ({"stiffness": -1e-12}, "stiffness must be ≥ 0, got -1e-12: it is a spring"),
        ({"stiffness": (-1, 2)}, "stiffness must be ≥ 0, got -1 … 2: it is a spring"),
        ({"stiffness": "3 N"}, 'stiffness is in N/m; got "3 N", a force'),
        ({"stiffness": None}, "stiffness is in N/m; got nothing where a number belongs"),
        ({"damping": 0}, "damping must be > 0, got 0: it damps"),
        ({"damping": (1, 2)}, r"damping is in N\*s/m; got a list where a number belongs"),
        ({"damping": Interval(1, 2)}, r"damping is in N\*s/m; got .*Interval where a number belongs"),
        ({"damping": float("inf")}, r"damping is in N\*s/m: expected a finite number"),
        ({"start": 1e-12}, "start must be ≤ 0, got 1e-12: it is out"),
        ({"level": "3 J"}, 'level is a plain number; got "3 J"'),
        ({"level": True}, "level is a plain number; got true or false"),
        ({"forces": "1"}, "forces is a list of numbers, got '1'"),
        ({"forces": [1, "1 m"]}, r'forces\[1\] is in N; got "1 m", a length'),
        ({"fast": 1}, "fast is True to hurry, or False; got 1"),
        ({"kind": "four"}, "kind is one of 'one', 'two', 'three', got 'four'"),
    ],
)
def test_a_slip_says_name_bound_and_reason(given, said):
    with pytest.raises(InputError, match=said):
        Thing(**{"stiffness": 0, **given})


def test_the_fields_say_what_a_reader_of_text_asks():
    fields = parameters_of(Thing)
    assert [name for name, own in fields.items() if own.required] == ["stiffness"]
    forms = ["uncertain", "quantity", "quantity", "quantity", "list", "flag", "word"]
    assert [own.form for own in fields.values()] == forms
    assert [fields["start"].unit_for(motion) for motion in ("linear", "rotary")] == ["m", "rad"]
    assert fields["start"].meaning == "first place"
    assert fields["kind"].meaning == "one (default), two or three"
    assert fields["fast"].meaning == "true to hurry"
    assert (fields["damping"].words, fields["kind"].words) == (("any",), ("one", "two", "three"))


def test_a_number_is_shown_with_its_unit():
    thing = Thing(300, level=2)
    assert thing.with_unit("stiffness") == "300 N/m"
    assert thing.with_unit("damping", "rotary") == "0.1 N·m·s/rad"
    assert (thing.with_unit("level"), Thing(1).with_unit("level")) == ("2", "")


def test_a_unit_is_printed_as_people_write_it():
    units = ["1", "N", "N*m*s/rad", "kg*m^2", "m/N/s", "N*m*s/rad/J"]
    assert [unit_text(unit) for unit in units] == ["", "N", "N·m·s/rad", "kg·m²", "m/(N·s)", "N·m·s/(rad·J)"]
