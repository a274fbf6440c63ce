"""A sweep as a labelled Dataset: a dimension for each parameter, a variable for each entry of the answers."""

from __future__ import annotations

from typing import Any

import xarray as xr

from zwidth.errors import InputError
from zwidth.model.device import Device
from zwidth.model.environment.environment import Environment
from zwidth.passivity.scope import scope_of
from zwidth.quantity.exact import Interval
from zwidth.quantity.text import to_json
from zwidth.study.chunks.layout import Layers
from zwidth.study.sweeps.columns import REFUSED
from zwidth.study.sweeps.questions import HANDS
from zwidth.study.sweeps.request import FORMAT, Request
from zwidth.study.sweeps.within import with_numbers

_OF_EACH = ("contact", "encoder", "fed_with", "law", "damping", "coulomb_friction", "clamped")
"""Entries of a scope that may be another at every loop: they are variables, or the loop's own numbers."""


def dataset(asked: Request, layers: Layers) -> xr.Dataset:
    """The sweep with words in the place of numbers."""
    dims = tuple(own.name for own in asked.axes)
    coordinates = {own.name: (own.name, own.array, {"units": own.unit}) for own in asked.axes}
    variables: dict[str, Any] = {}
    for name, own in asked.columns.items():
        variables[name] = (dims, own.shown(layers[name]), own.told())
    return xr.Dataset(variables, coordinates, attributes(asked, layers))


def attributes(asked: Request, layers: Layers) -> dict[str, str]:
    """What is the same of every loop, and what an answer means."""
    loop = asked.loop
    told = {
        "format": FORMAT,
        "of": asked.of,
        "motion": loop.motion,
        "loop": _in_words(asked),
        "answers": _MEANING[asked.of] + (OF_HANDS if HANDS in loop.options else ""),
    }
    if asked.of in ("check", "limit"):
        assert isinstance(loop.subject, Device)
        assert loop.environment is not None
        common = scope_of(loop.subject, loop.environment).to_dict()
        told["scope"] = to_json({k: v for k, v in common.items() if not k.startswith(_OF_EACH)}, indent=None)
    refused = layers[REFUSED]
    if refused.any():
        told["first_refused"] = _why(asked, tuple(int(n[0]) for n in refused.nonzero()))
    return told


def _in_words(asked: Request) -> str:
    """The loop before its numbers are varied, on one line."""
    loop = asked.loop
    if not isinstance(loop.subject, Device):
        return loop.subject.describe()
    law = "" if loop.environment is None else f"; {_ranges(asked).describe(loop.motion)}"
    hand = "" if loop.operator is None else f"; {loop.operator.describe(loop.motion)}"
    return f"{loop.subject.name}{law}{hand}"


def _ranges(asked: Request) -> Environment:
    """The environment with the ranges of its numbers, where it can have intervals."""
    law = asked.loop.environment
    assert law is not None
    varied = {
        own.key: Interval(min(axis.values), max(axis.values))
        for own, axis in zip(asked.parameters, asked.axes, strict=True)
        if own.part == "law" and "." not in own.key
    }
    try:
        return law.around(with_numbers(law.met, varied))
    except InputError:
        return law


def _why(asked: Request, place: tuple[int, ...]) -> str:
    """Why a loop cannot be."""
    values = ", ".join(own.told(own.values[n]) for own, n in zip(asked.axes, place, strict=True))
    try:
        asked.question.answer(asked.at(place), {})
    except InputError as error:
        return f"{values}: {error}"
    return values


_MEANING = {
    "check": "what zwidth check says of each loop by closed forms, of every hand, for the contact and the "
    "encoder beside it; what is undecided, or passive in contact alone, zwidth check may decide by value "
    "iteration. No proof and no motion is kept: zwidth check -o writes that of a loop, checked",
    "limit": "what zwidth limit finds by closed forms, of every hand; NaN where they find nothing",
    "simulate": "measures of one simulated touch: what this hand did, and nothing about another",
    "pair": "what zwidth pair says of each pair: two hands, one on each arm. zwidth pair -o writes the "
    "evidence of a pair",
}
"""What is claimed, by the question."""

OF_HANDS = (
    ". Stability is of each hand alone, as long as it keeps contact, dry friction and encoder steps left "
    "out: what zwidth check --hands says"
)
