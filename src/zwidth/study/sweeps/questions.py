"""The questions of a sweep: what `check`, `limit`, `simulate` and `pair` answer about one loop.

Values are not iterated, which takes seconds.  What closed forms leave open stays
open here, "undecided" or "passive in contact"; `zwidth.check` of that loop spends some seconds more on it.
"""

from __future__ import annotations

import re
from collections.abc import Callable, Mapping
from types import MappingProxyType
from typing import Any, NamedTuple, get_args

from zwidth.errors import InputError
from zwidth.model.device import Device
from zwidth.model.pairs import Pair
from zwidth.model.specification.table import quoted
from zwidth.passivity.budget import LIMITS
from zwidth.passivity.pairs.verdict import LIMITS as LIMITS_OF_A_PAIR
from zwidth.passivity.scope import Contact, Encoder, FedWith, Law, Outcome, Scope, Transmission
from zwidth.passivity.stability.characteristic import Outcome as Rests
from zwidth.quantity.glossary import GLOSSARY
from zwidth.study.sweeps.axes import Column, Columns
from zwidth.study.sweeps.loops import Loop

Answer = Mapping[str, Any]

Line = dict[Any, Any]
"""What is known already of loops that differ in the stiffness of the law alone."""


class Question(NamedTuple):
    """What is asked of each loop.

    `columns`: what is kept of an answer.
    `answer`: the answer of one loop, given what is known of its line: a value for each column.
    `needs`: what the loop must have; raises InputError if it has not.
    """

    columns: Callable[[Loop], Columns]
    answer: Callable[[Loop, Line], Answer]
    needs: Callable[[Loop], None]


_OUTCOME = Column("what is proved of the loop", words=get_args(Outcome))
_CONTACT = Column("contact that the outcome is about", words=get_args(Contact))
_ENCODER = Column("whether the encoder's steps are in it", words=get_args(Encoder))


def _scope(loop: Loop, scope: Scope) -> Answer:
    return {name: getattr(scope, name) for name in _of_a_scope(loop)}


def _of_a_scope(loop: Loop) -> Columns:
    gives_way = isinstance(loop.subject, Device) and loop.subject.transmission is not None
    between = Column("of which transmission that is proved", words=get_args(Transmission)[:3])
    return {**_OF_A_SCOPE, **({"transmission": between} if gives_way else {})}


_OF_A_SCOPE = {
    "contact": _CONTACT,
    "encoder": _ENCODER,
    "fed_with": Column("what a law with a memory must be fed with", words=get_args(FedWith)[:2]),
    "law": Column("what of the law is not exact, or not looked at", words=get_args(Law), several=True),
}


def _stiffness(loop: Loop, meaning: str) -> Column:
    return Column(meaning, GLOSSARY["stiffness"].unit_for(loop.motion))


HANDS = "hands"
"""The option of "check" that names hands, by name a hand or None: of each whether it comes to rest."""


def _checked_columns(loop: Loop) -> Columns:
    return {
        "outcome": _OUTCOME,
        **_of_a_scope(loop),
        "binding": Column("what binds: what is violated, or would be first", words=LIMITS),
        "max_stiffness": _stiffness(loop, "largest passive stiffness, all else as it is"),
        **_columns_of_hands(loop),
    }


def _columns_of_hands(loop: Loop) -> Columns:
    columns: dict[str, Column] = {}
    for name in _hands(loop):
        if not re.fullmatch(r"[a-z]\w*", name, re.ASCII):
            raise InputError(f"a hand is named in small letters, such as finger, got {quoted(name)}")
        about = f"with the hand {name} alone, in sustained contact"
        columns[f"stability_{name}"] = Column(
            f"whether the loop comes to rest {about}", words=get_args(Rests)
        )
        columns[f"max_stable_stiffness_{name}"] = _stiffness(loop, f"up to which stiffness it does {about}")
    return columns


def _hands(loop: Loop) -> Mapping[str, Any]:
    hands: Mapping[str, Any] = loop.options.get(HANDS, {})
    return hands


def checked(loop: Loop, line: Line) -> Answer:
    """What `zwidth.check` says of a loop, by closed forms; the largest stiffness is sought once in a line."""
    from zwidth.passivity.check import check

    options = {key: value for key, value in loop.options.items() if key != HANDS}
    verdict = check(loop.subject, loop.environment, iterate=False, **options)  # type: ignore[arg-type]  # a device, see _one_device
    about = verdict.outcome, verdict.scope.contact
    if about not in line:
        line[about] = getattr(verdict, "max_stiffness", None)
    return {
        "outcome": verdict.outcome,
        **_scope(loop, verdict.scope),
        "binding": getattr(verdict, "limit", ""),
        "max_stiffness": line[about],
        **_of_hands(loop),
    }


def _of_hands(loop: Loop) -> Answer:
    """What `zwidth.stability.coupled_stability` says of each hand."""
    from zwidth.passivity.stability import coupled_stability

    told: dict[str, Any] = {}
    for name, hand in _hands(loop).items():
        found = coupled_stability(loop.subject, loop.environment, hand)  # type: ignore[arg-type]  # a device, see _one_device
        told[f"stability_{name}"], told[f"max_stable_stiffness_{name}"] = found.outcome, found.max_stiffness
    return told


def _limited_columns(loop: Loop) -> Columns:
    from zwidth.passivity.bracket.bracket import parameter_of

    assert isinstance(loop.subject, Device)
    assert loop.environment is not None
    unit = parameter_of(loop.subject, loop.environment, loop.options["parameter"]).unit
    return {
        "proved_passive": Column("last value that is proved passive", unit),
        "proved_active": Column("first value at which a motion takes energy out", unit),
        **_of_a_scope(loop),
    }


def limited(loop: Loop, _: Line) -> Answer:
    """What `zwidth.passive_limit` says of a loop, by closed forms."""
    from zwidth.passivity.bracket.passive_limit import passive_limit

    found = passive_limit(loop.subject, loop.environment, iterate=False, **loop.options)  # type: ignore[arg-type]
    return {
        "proved_passive": found.proved_passive,
        "proved_active": found.proved_active,
        **_scope(loop, found.scope),
    }


def _simulated_columns(loop: Loop) -> Columns:
    from zwidth.loop.trace import UNITS
    from zwidth.loop.traces.measures import COLUMNS

    units = (*UNITS[loop.motion], "J", "1")
    return {name: Column(own.heading, units[own.kind]) for name, own in COLUMNS.items()}


def simulated(loop: Loop, _: Line) -> Answer:
    """The measures of a simulated touch."""
    from zwidth.loop.simulate import simulated as touched
    from zwidth.loop.traces.measures import measure

    options = dict(loop.options)
    duration = options.pop("duration")
    assert isinstance(loop.subject, Device), "see _touched"
    return measure(touched(loop.subject, loop.environment, loop.operator, duration, **options))


def _paired_columns(loop: Loop) -> Columns:
    return {
        "outcome": _OUTCOME,
        "contact": _CONTACT,
        "encoder": _ENCODER,
        "binding": Column("what binds", words=LIMITS_OF_A_PAIR),
        "max_stiffness": _stiffness(loop, "largest passive stiffness of the coupling, all else as it is"),
    }


def paired(loop: Loop, _: Line) -> Answer:
    """What `zwidth.check` says of two arms that follow each other."""
    from zwidth.passivity.pairs import check_pair

    verdict = check_pair(loop.subject)  # type: ignore[arg-type]  # a pair, see _two_arms
    return {
        "outcome": verdict.outcome,
        "contact": verdict.scope.contact,
        "encoder": verdict.scope.encoder,
        "binding": verdict.limit,
        "max_stiffness": verdict.largest_stiffness,
    }


def _one_device(loop: Loop) -> None:
    if isinstance(loop.subject, Pair):
        raise InputError('two arms that follow each other are asked about with of="pair"')
    if not isinstance(loop.subject, Device):
        raise InputError(f"a sweep is of a Device or a Pair, got {type(loop.subject).__name__}")
    if loop.environment is None:
        raise InputError("the environment is missing: what the device renders, such as zw.Wall(300)")


def _held(loop: Loop) -> None:
    """With hands that are known the loop must be one that their stability is known of."""
    _one_device(loop)
    if not isinstance(_hands(loop), Mapping):
        raise InputError(
            'hands are given by their names, such as {"none": None, "finger": zw.operators.Finger()}'
        )
    _of_hands(loop)


def _touched(loop: Loop) -> None:
    if isinstance(loop.subject, Pair):
        raise InputError("the touches of a sweep are of one device: simulate two arms one by one")
    _one_device(loop)
    if loop.operator is None:
        raise InputError("a simulation needs a hand: operator=zw.operators.Finger(), or another")
    if loop.options.get("duration") is None:
        raise InputError('a simulation needs a duration, such as duration="2 s"')


def _two_arms(loop: Loop) -> None:
    if not isinstance(loop.subject, Pair):
        raise InputError('of="pair" is of a zw.Pair: two arms that follow each other')


QUESTIONS: Mapping[str, Question] = MappingProxyType(
    {
        "check": Question(_checked_columns, checked, _held),
        "limit": Question(_limited_columns, limited, _one_device),
        "simulate": Question(_simulated_columns, simulated, _touched),
        "pair": Question(_paired_columns, paired, _two_arms),
    }
)
"""By the command that answers it."""
