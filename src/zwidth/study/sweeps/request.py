"""What a sweep is of: one loop, the parameters that are varied, and the question asked of each."""

from __future__ import annotations

from collections.abc import Iterable, Mapping
from dataclasses import dataclass, fields, is_dataclass, replace
from fractions import Fraction
from functools import cached_property
from math import prod
from typing import Any

import numpy as np

from zwidth.errors import InputError
from zwidth.missing import suggestion
from zwidth.model.specification.table import quoted
from zwidth.quantity.exact import Exact, Interval
from zwidth.study.chunks.layout import Layout
from zwidth.study.sweeps.axes import OF_EVERY_SWEEP, Axis, Columns, axis
from zwidth.study.sweeps.loops import Loop, Parameter, changed, parameter
from zwidth.study.sweeps.questions import HANDS, QUESTIONS, Question
from zwidth.study.sweeps.springs import Springs, is_of_walls, springs

FORMAT = "zwidth sweep 1"

MOST_LOOPS = 20_000_000
"""Of one sweep; more are a mistake in the numbers."""

MOST_AXES = 8
"""Parameters that are varied at once."""

BY_CLOSED_FORMS, BY_LINES, ONE_BY_ONE, SLOW = 16_384, 4096, 64, 4
"""Loops that are computed and kept at a time, by how long one of them takes."""

_SLOW = ("limit", "simulate", "pair")


@dataclass(frozen=True)
class Request:
    """All that the bits of a sweep depend on.

    `of`: the question, by the command that answers it.
    `loop`: with its numbers before they are varied.
    `parameters`, `axes`: what is varied, and its values.
    `at_once`: loops that are computed and kept at a time, at most.
    """

    of: str
    loop: Loop
    parameters: tuple[Parameter, ...]
    axes: tuple[Axis, ...]
    at_once: int = 1

    @property
    def question(self) -> Question:
        """What is asked."""
        return QUESTIONS[self.of]

    @cached_property
    def columns(self) -> Columns:
        """What is kept of each answer."""
        return {**self.question.columns(self.loop), **OF_EVERY_SWEEP}

    @cached_property
    def springs(self) -> Springs | None:
        """The loops as springs, where all of them are."""
        return springs(self.loop, self.parameters, self.axes) if self._by_closed_forms_alone else None

    @property
    def of_walls(self) -> bool:
        """Whether loops that differ in their stiffness alone are walls."""
        return (
            self._by_closed_forms_alone
            and self.stiffness_axis is not None
            and is_of_walls(self.loop, self.parameters)
        )

    @property
    def _by_closed_forms_alone(self) -> bool:
        """Whether verdicts on one mass are all that is asked for: known hands are looked at loop by loop."""
        rigid = getattr(self.loop.subject, "transmission", None) is None
        return rigid and self.of == "check" and HANDS not in self.loop.options

    @property
    def size(self) -> int:
        """How many loops there are."""
        return prod(len(own.values) for own in self.axes)

    @property
    def chunk(self) -> tuple[int, ...]:
        """Loops along each axis that are computed and kept at a time."""
        sizes = [1] * len(self.axes)
        left = self.at_once
        stiffness = self.stiffness_axis
        for k in sorted(range(len(sizes)), key=lambda k: (k != stiffness, -k)):
            sizes[k] = min(len(self.axes[k].values), left)
            left = max(1, left // sizes[k])
        return tuple(sizes)

    @property
    def stiffness_axis(self) -> int | None:
        """The axis of the law's stiffness: loops that differ in it alone are kept together."""
        found = (k for k, own in enumerate(self.parameters) if (own.part, own.key) == ("law", "stiffness"))
        return next(found, None)

    @cached_property
    def layout(self) -> Layout:
        """The arrays of the sweep."""
        about: dict[str, Mapping[str, Any]] = {name: own.about() for name, own in self.columns.items()}
        about |= {own.name: {"units": own.unit} for own in self.axes}
        return Layout(
            "sweep",
            FORMAT,
            self.describe(),
            {own.name: own.array for own in self.axes},
            self.chunk,
            {name: own.kind for name, own in self.columns.items()},
            about,
        )

    def at(self, place: tuple[int, ...]) -> Loop:
        """One loop, by its place along each axis."""
        values = (own.values[n] for own, n in zip(self.axes, place, strict=True))
        return changed(self.loop, dict(zip(self.parameters, values, strict=True)))

    def describe(self) -> dict[str, Any]:
        """The request as JSON holds it; exact numbers as text."""
        return {
            "of": self.of,
            "loop": described(self.loop),
            "axes": {own.name: [own.unit, *map(repr, own.values)] for own in self.axes},
            "chunk": list(self.chunk),
        }


def request(of: str, loop: Loop, vary: Mapping[str, object]) -> Request:
    """Read what `sweep` is given."""
    if of not in QUESTIONS:
        raise InputError(f"a sweep is of {', '.join(QUESTIONS)}, got {quoted(str(of))}; "
                         f"{suggestion(str(of), QUESTIONS)}")  # fmt: skip
    QUESTIONS[of].needs(loop)
    if not vary:
        raise InputError('nothing is varied: vary={"stiffness": "100:3000:50"}, on the command line --vary')
    if len(vary) > MOST_AXES:
        raise InputError(f"at most {MOST_AXES} parameters are varied at once, got {len(vary)}")
    parameters = tuple(parameter(loop, str(typed)) for typed in vary)
    _refuse_the_same(parameters)
    axes = tuple(
        axis(own.name, given, own.unit) for own, given in zip(parameters, vary.values(), strict=True)
    )
    asked = Request(of, loop, parameters, axes)
    if asked.size > MOST_LOOPS:
        raise InputError(f"a sweep has at most {MOST_LOOPS} loops, got {asked.size}: take fewer values")
    _check_ends(asked)
    return replace(asked, at_once=_at_once(asked))


def _at_once(asked: Request) -> int:
    if asked.of in _SLOW:
        return SLOW
    if asked.springs is not None:
        return BY_CLOSED_FORMS
    return BY_LINES if asked.of_walls else ONE_BY_ONE


def _refuse_the_same(parameters: Iterable[Parameter]) -> None:
    """A parameter twice, or two of which one is made of the other."""
    made = {
        "rate": "sample_period",
        "counts_per_turn": "resolution",
        "inertia": "mass",
        "cutoff": "time_constant",
    }
    seen: dict[tuple[str, str], str] = {}
    for own in parameters:
        owner, dot, key = own.key.rpartition(".")
        number = own.part, owner + dot + made.get(key, key)
        if number in seen:
            raise InputError(f"{seen[number]} and {own.name} are the same number: vary one of them")
        seen[number] = own.name


def _check_ends(asked: Request) -> None:
    """Refuse what cannot be before the work starts: each parameter at its ends, the others at their first."""
    first = [own.values[0] for own in asked.axes]
    for k, own in enumerate(asked.axes):
        for value in {min(own.values), max(own.values)}:
            values = [*first[:k], value, *first[k + 1 :]]
            try:
                loop = changed(asked.loop, dict(zip(asked.parameters, values, strict=True)))
                asked.question.needs(loop)
            except InputError as error:
                raise InputError(f"at {own.told(value)}: {error}") from None
    _ = asked.columns


def described(thing: Any) -> Any:
    """Whatever a loop is made of as plain data, exact numbers as text."""
    if isinstance(thing, Exact):
        return str(thing.fraction)
    if isinstance(thing, Interval):
        return [described(thing.low), described(thing.high)]
    if is_dataclass(thing) and not isinstance(thing, type):
        own = {each.name: described(getattr(thing, each.name)) for each in fields(thing)}
        return {"type": type(thing).__name__, **own}
    if isinstance(thing, Mapping):
        return {str(key): described(value) for key, value in thing.items()}
    if isinstance(thing, tuple | list):
        return [described(one) for one in thing]
    if isinstance(thing, np.ndarray):
        return described(thing.tolist())
    if isinstance(thing, Fraction):
        return str(thing)
    if thing is None or isinstance(thing, bool | int | str):
        return thing
    if isinstance(thing, float):
        return repr(thing)
    return {"type": type(thing).__name__, **{k: described(v) for k, v in sorted(vars(thing).items())}}
