"""The loop that is varied, and what of it may be: numbers of device, environment, pair, hand and run.

A parameter is named as its option is: `damping` is the device's, `virtual_damping` the environment's,
`velocity_filter.time_constant` its filter's, `environment.stiffness` is of what stands behind a coupling,
`operator.force` of the hand, `transmission.stiffness` of what is between it and the motor.  With one law
in a chain `law.largest_damping` is of that law; with several `law.2.largest_damping` of the second, the
first being next to the environment.  Of a pair `stiffness` is of
its coupling, `leader.damping` and `follower.damping` are of its arms, and `rate`, like every other number of
a device, of both.
"""

from __future__ import annotations

from collections.abc import Callable, Iterable, Mapping
from dataclasses import dataclass, field, fields, is_dataclass, replace
from types import MappingProxyType
from typing import Any, NamedTuple

from zwidth.errors import InputError
from zwidth.missing import suggestion
from zwidth.model.device import Device, Transmission
from zwidth.model.device.rotary import ROTARY, rotary
from zwidth.model.environment import OnePole, Window
from zwidth.model.environment.environment import Environment
from zwidth.model.operator import ParametricOperator
from zwidth.model.pairs import Pair
from zwidth.model.specification.table import quoted
from zwidth.model.specification.values import time_constant_of
from zwidth.quantity.exact import Exact, Interval
from zwidth.quantity.glossary import GLOSSARY
from zwidth.quantity.parameter import parameters_of


@dataclass(frozen=True)
class Loop:
    """One loop, and how it is asked.

    `subject`: a device, or two arms that follow each other.
    `environment`: what a device renders; of a pair None.
    `operator`: the hand of a simulation.
    `options`: further arguments of the question.
    """

    subject: Device | Pair
    environment: Environment | None = None
    operator: Any = None
    options: Mapping[str, Any] = field(default_factory=dict)

    @property
    def motion(self) -> str:
        """ "linear" or "rotary"."""
        return self.subject.motion


class Parameter(NamedTuple):
    """A number of the loop: its name, its unit, in which part of the loop it is, and the key there."""

    name: str
    unit: str
    part: str
    key: str


Changes = dict[str, Exact]


class Part(NamedTuple):
    """A part of a loop.

    `before`: what stands before its keys.
    `units`: the unit of each of its numbers by its key; empty where the loop has no such part.
    `change`: the loop with other numbers in this part.
    """

    before: str
    units: Callable[[Loop], Units]
    change: Callable[[Loop, Changes], Loop]


def parameter(loop: Loop, typed: str) -> Parameter:
    """The number of that name."""
    name = typed.strip().replace("-", "_")
    known = {
        f"{part.before}{_ALIAS.get((label, key), key)}": Parameter(name, unit, label, key)
        for label, part in PARTS.items()
        for key, unit in part.units(loop).items()
    }
    if name not in known:
        raise InputError(_unknown(typed.strip(), name, known))
    return known[name]


def _unknown(typed: str, name: str, known: Iterable[str]) -> str:
    """What may have been meant, or all that can be varied."""
    within = [one for one in known if one.startswith(f"{name}.")]
    if within:
        return f"{quoted(typed)} is no number of its own; what can be varied of it: {', '.join(within)}"
    same = [one for one in known if one.rpartition(".")[2] == name]
    hint = f"did you mean {' or '.join(map(quoted, same))}?" if same else suggestion(name, sorted(known))
    return f"there is no number {quoted(typed)} to vary in this loop; {hint}"


def changed(loop: Loop, values: Mapping[Parameter, float]) -> Loop:
    """The loop with other numbers; those of one part are set at once."""
    parts: dict[str, Changes] = {}
    for own, value in values.items():
        parts.setdefault(own.part, {})[own.key] = Exact(value)
    for label, new in parts.items():
        loop = PARTS[label].change(loop, new)
    return loop


_ALIAS = {
    ("coupling", "damping"): "virtual_damping",
    ("coupling", "follower_damping"): "follower_virtual_damping",
}
"""Keys that are options under another name: there damping is the device's."""


def device_units(motion: str) -> Units:
    """Of every number of a device, and those from which one is made."""
    units = {name: own.unit_for(motion) for name, own in parameters_of(Device).items() if own.is_number}
    turning = {name: ROTARY[name].unit_for(motion) for name in ("inertia", "counts_per_turn")}
    return {**units, "rate": GLOSSARY["rate"].unit, **(turning if motion == "rotary" else {})}


def other_device(device: Device, new: Changes) -> Device:
    """The device with other numbers."""
    arguments = dict(new)
    if "inertia" in arguments:
        arguments["mass"] = arguments.pop("inertia")
    if "counts_per_turn" in arguments:
        counted = rotary(damping=0, rate=1, counts_per_turn=arguments.pop("counts_per_turn"))
        arguments["resolution"] = counted.exact("resolution")  # type: ignore[assignment]  # a rational
    return device.replace(**arguments)


def _of_device(loop: Loop) -> Units:
    return device_units(loop.motion) if isinstance(loop.subject, Device) else {}


def _of_transmission(loop: Loop) -> Units:
    if not isinstance(loop.subject, Device) or loop.subject.transmission is None:
        return {}
    own = parameters_of(Transmission)
    return {name: each.unit_for(loop.motion) for name, each in own.items() if each.is_number}


def _transmission(loop: Loop, new: Changes) -> Loop:
    assert isinstance(loop.subject, Device)
    given = loop.subject.transmission
    assert given is not None
    return replace(loop, subject=loop.subject.replace(transmission=given.replace(**new)))


def _of_arms(loop: Loop) -> Units:
    return device_units(loop.motion) if isinstance(loop.subject, Pair) else {}


def _device(loop: Loop, new: Changes) -> Loop:
    assert isinstance(loop.subject, Device)
    return replace(loop, subject=other_device(loop.subject, new))


def _arms(*names: str) -> Callable[[Loop, Changes], Loop]:
    def change(loop: Loop, new: Changes) -> Loop:
        pair = loop.subject
        return replace(loop, subject=pair.replace(**{n: other_device(getattr(pair, n), new) for n in names}))

    return change


_LINK = ("link_delay", "link_delay_back")
"""Both ways, and the way back alone."""


def _of_coupling(loop: Loop) -> Units:
    if not isinstance(loop.subject, Pair):
        return {}
    own = parameters_of(Pair)
    fields_ = {key: each for key, each in own.items() if each.is_number and key not in ("there", "back")}
    return {key: each.unit_for(loop.motion) for key, each in fields_.items()} | dict.fromkeys(_LINK, "s")


def _coupling(loop: Loop, new: Changes) -> Loop:
    assert isinstance(loop.subject, Pair)
    given: dict[str, Any] = {key: value for key, value in new.items() if key not in _LINK}
    there, back = loop.subject.delay
    both = new.get("link_delay")
    there, back = (there, back) if both is None else (both, both)
    given["delay"] = there, new.get("link_delay_back", back)
    return replace(loop, subject=loop.subject.replace(**given))


def _of_law(loop: Loop) -> Units:
    return {} if loop.environment is None else numbers_within(loop.environment.met, loop.motion)


def _law(loop: Loop, new: Changes) -> Loop:
    law = loop.environment
    assert law is not None
    return replace(loop, environment=law.around(with_numbers(law.met, new)))


def chain_of(environment: Environment | None) -> tuple[Any, ...]:
    """The laws in a chain: asked of an attribute, since numpy takes its time to load."""
    return getattr(environment, "laws", ())


def law_of(name: str, laws: int) -> tuple[int, str]:
    """Which law of a chain a number is of, from 0 on, and its name there: a single law has no number."""
    place, _, rest = name.partition(".") if laws > 1 else ("1", "", name)
    return int(place) - 1, rest


def _of_chain(loop: Loop) -> Units:
    laws = chain_of(loop.environment)
    return {
        f"{number}.{name}" if len(laws) > 1 else name: unit
        for number, law in enumerate(laws, start=1)
        for name, unit in numbers_within(law, loop.motion).items()
    }


def _chain(loop: Loop, new: Changes) -> Loop:
    laws = chain_of(loop.environment)
    changes: list[Changes] = [{} for _ in laws]
    for name, value in new.items():
        place, key = law_of(name, len(laws))
        changes[place][key] = value
    others = tuple(with_numbers(law, own) for law, own in zip(laws, changes, strict=True))
    return replace(loop, environment=replace(loop.environment, laws=others))  # type: ignore[type-var]  # what has laws


def _of_hand(loop: Loop) -> Units:
    if not isinstance(loop.operator, ParametricOperator):
        return {}
    return {name: own.unit_for(loop.motion) for name, own in loop.operator.parameters().items()}


def _hand(loop: Loop, new: Changes) -> Loop:
    return replace(loop, operator=replace(loop.operator, **new))


_RUN = {"duration": "s", "initial_position": "", "initial_velocity": "", "encoder_phase": "1"}
"""Of a simulation; "" where it turns on the motion."""


def _of_run(loop: Loop) -> Units:
    if loop.operator is None:
        return {}
    own = {"initial_position": GLOSSARY["position"], "initial_velocity": GLOSSARY["velocity"]}
    return {key: unit or own[key].unit_for(loop.motion) for key, unit in _RUN.items()}


def _run(loop: Loop, new: Changes) -> Loop:
    return replace(loop, options={**loop.options, **{key: float(value) for key, value in new.items()}})


PARTS: Mapping[str, Part] = MappingProxyType(
    {
        "device": Part("", _of_device, _device),
        "transmission": Part("transmission.", _of_transmission, _transmission),
        "arms": Part("", _of_arms, _arms("leader", "follower")),
        "leader": Part("leader.", _of_arms, _arms("leader")),
        "follower": Part("follower.", _of_arms, _arms("follower")),
        "coupling": Part("", _of_coupling, _coupling),
        "law": Part("", _of_law, _law),
        "chain": Part("law.", _of_chain, _chain),
        "hand": Part("operator.", _of_hand, _hand),
        "run": Part("", _of_run, _run),
    }
)
"""Where a number may be."""


# The numbers of an environment or a law, and behind a dot those of what it is made of.


Units = Mapping[str, str]

_PARTS = ("environment", "velocity_filter", "velocity")
"""Fields that hold something which has numbers itself."""


def numbers_within(thing: Any, motion: str) -> Units:
    """The unit of each number, by its name; none of what has none."""
    found = dict(_own(thing, motion))
    for part in _PARTS:
        inner = getattr(thing, part, None)
        if inner is not None:
            found |= {f"{part}.{name}": unit for name, unit in numbers_within(inner, motion).items()}
    return found


def with_numbers(thing: Any, new: Mapping[str, Any]) -> Any:
    """The thing with other numbers, by the names of `numbers_within`; all of them are set at once."""
    own: dict[str, Any] = {}
    inner: dict[str, dict[str, Any]] = {}
    for name, value in new.items():
        part, _, rest = name.partition(".")
        if rest:
            inner.setdefault(part, {})[rest] = value
        else:
            own[_field(thing, name)] = time_constant_of(value) if name == "cutoff" else value
    own |= {part: with_numbers(getattr(thing, part), numbers) for part, numbers in inner.items()}
    return replace(thing, **own)


def _own(thing: Any, motion: str) -> Units:
    if isinstance(thing, Window):
        return {"samples": "1"}
    if isinstance(thing, OnePole):
        return {"time_constant": "s", "cutoff": "Hz"}
    if isinstance(thing, Environment):  # what may be left out says how it is made: it is given, or not
        given = [
            each.name for each in fields(thing) if isinstance(getattr(thing, each.name), Exact | Interval)
        ]
        return {_name(key): thing.unit_of(key, motion) for key in given}
    if not is_dataclass(thing):
        return {}
    return {key: own.unit_for(motion) for key, own in parameters_of(type(thing)).items() if own.is_number}


def _name(key: str) -> str:
    return "virtual_damping" if key == "damping" else key


def _field(thing: Any, name: str) -> str:
    if name == "cutoff" and isinstance(thing, OnePole):
        return "time_constant"
    return "damping" if name == "virtual_damping" and isinstance(thing, Environment) else name
