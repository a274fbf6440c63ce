"""Operators that are a few numbers: units, bounds, comparison, and the page on them."""

from __future__ import annotations

import dataclasses
import inspect
import re
from pathlib import Path

import numpy as np
import pytest

from zwidth.errors import InputError
from zwidth.model import operator as operators
from zwidth.model.operator import OPERATORS, Operator
from zwidth.quantity.parameter import parameters_of
from zwidth.quantity.text import shown
from zwidth.quantity.units import parse_number

TIMES = np.arange(801) * 0.0025
EACH = pytest.mark.parametrize("kind", OPERATORS.values(), ids=list(OPERATORS))


@EACH
def test_works_as_it_is_and_starts_where_its_signals_start(kind):
    hand = kind()
    force, anchor, position, switches = hand.signals(TIMES)
    assert force is None or force.shape == (800,)
    assert anchor is None or anchor.shape == (801,)
    assert position is None or position.shape == (801,)
    assert switches is None
    given = [signal for signal in (force, anchor, position) if signal is not None]
    assert given
    assert all(np.isfinite(signal).all() and signal.dtype == np.float64 for signal in given)
    assert hand.kinematic == (position is not None)
    assert (anchor is not None) == (hand.hand.stiffness > 0 or hand.hand.damping > 0)
    # no force comes from nowhere: anchor and prescribed position begin at the handle
    assert {s[0] for s in (anchor, position) if s is not None} <= {hand.initial_position}


@EACH
def test_every_number_has_units_a_meaning_and_a_place_in_the_docstring(kind):
    text = "".join(inspect.getdoc(k) or "" for k in kind.__mro__)
    for field in dataclasses.fields(kind):
        quantity = kind.parameters()[field.name]
        assert quantity.name == field.name
        assert parse_number(f"3 {quantity.unit}", quantity.unit, "x") == 3
        assert parse_number(f"3 {quantity.rotary_unit}", quantity.rotary_unit, "x") == 3
        assert quantity.meaning
        assert re.search(rf"\b{field.name}\b", text)


@EACH
def test_equal_numbers_are_equal_hands(kind):
    if not dataclasses.fields(kind):
        assert (kind(), hash(kind())) == (kind(), hash(kind()))
        return
    first = dataclasses.fields(kind)[0].name
    value = 0.75 * getattr(kind(), first)
    hand, same = kind(**{first: value}), kind(**{first: value})
    assert hand == same
    assert hash(hand) == hash(same)
    assert hand != kind()
    assert eval(repr(hand), {name: getattr(operators, name) for name in operators.__all__}) == hand


@EACH
def test_describes_itself_with_every_number(kind):
    hand = kind()
    for motion in ("linear", "rotary"):
        line = hand.describe(motion)
        assert "\n" not in line
        for name, quantity in kind.parameters().items():
            assert shown(getattr(hand, name), quantity.unit_for(motion), 6) in line


@EACH
@pytest.mark.parametrize("bad", [float("nan"), float("inf"), "soon", None, True, [1, 2]])
def test_a_number_must_be_finite(kind, bad):
    """What is no finite number is refused by the name of the argument."""
    for name in kind.parameters():
        with pytest.raises(InputError, match=name):
            kind(**{name: bad})


@EACH
def test_each_bound_holds_from_both_sides(kind):
    for field in dataclasses.fields(kind):
        bound = parameters_of(kind)[field.name].bound
        if not bound:
            continue
        past = 1e-12 if bound == "≤ 0" else -1e-12
        with pytest.raises(InputError, match=rf"{field.name} must be {bound}( s)?, got .*: \w+"):
            kind(**{field.name: past})
        if bound == "> 0":
            with pytest.raises(InputError, match=field.name):
                kind(**{field.name: 0})
        else:
            assert getattr(kind(**{field.name: 0}), field.name) == 0


def test_a_number_may_carry_its_unit():
    """ "250 mN" is 0.25 N; for a rotary device a torque is taken; a length is refused."""
    assert operators.Dowel(force="250 mN").force == 0.25
    assert operators.Dowel(force="30 mN*m").force == 0.03
    with pytest.raises(InputError, match="force is in N"):
        operators.Dowel(force="250 mm")


def test_the_registry_cannot_be_changed():
    with pytest.raises(TypeError):
        OPERATORS["mine"] = operators.Dowel


PAGE = (Path(__file__).parents[2] / "docs" / "operators.md").read_text(encoding="utf-8")


def test_every_hand_has_a_section():
    titles = {title.split(" ")[0] for title in re.findall(r"^## (.+)$", PAGE, re.MULTILINE)}
    hands = {
        n
        for n in operators.__all__
        if isinstance(k := getattr(operators, n), type) and issubclass(k, Operator)
    }
    assert hands - {"Operator", "ParametricOperator"} <= titles


def test_the_links_of_the_table_lead_to_sections():
    titles = re.findall(r"^## (.+)$", PAGE, re.MULTILINE)
    anchors = {re.sub(r"[^\w -]", "", title).lower().replace(" ", "-") for title in titles}
    links = re.findall(r"\]\(#([\w-]+)\)", PAGE)
    assert len(links) > 9
    assert set(links) <= anchors
