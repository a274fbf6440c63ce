"""Values of a specification, read as the fields of the classes say.

Quantities; words, true and false; polynomials, lists of quantities, Maxwell branches and velocity
filters: a TOML number, list, table or word, or one text on the command line.
"""

from __future__ import annotations

import math
import re
from collections.abc import Callable, Mapping
from fractions import Fraction
from types import MappingProxyType
from typing import Any

from zwidth.errors import InputError
from zwidth.missing import suggestion
from zwidth.model.device.transmission import NOT_OF_IT, Transmission, motion_told
from zwidth.model.environment import BackwardDifference, OnePole, VelocityFilter, Window
from zwidth.model.environment.velocity import VelocityEstimator
from zwidth.model.specification.table import Table, located, quoted
from zwidth.quantity.exact import Exact, Interval, ends
from zwidth.quantity.glossary import GLOSSARY
from zwidth.quantity.parameter import Parameter, parameters_of, read_number
from zwidth.quantity.units import parse, parse_number


def read(value: Any, key: str, own: Parameter, motion: str) -> Any:
    """The value of one key, in the unit of the device's motion."""
    unit = own.unit_for(motion)
    if own.form == "uncertain":
        return parse(value, unit, key)
    if own.form == "quantity":
        named = isinstance(value, str) and value in own.words
        return value if named else parse_number(value, unit, key)
    if own.form == "word":
        return word(value, key, own.words)
    if own.form == "list":
        return quantities(value, unit, key)
    if own.form == "branches":
        return branches(value, motion)
    return _READ[own.form](value, key)


def word(value: object, key: str, words: tuple[str, ...]) -> str:
    """One of the words that a key may have."""
    if not isinstance(value, str):
        raise InputError(f'{key} is a text in quotes, such as {key} = "{words[0]}"')
    if value not in words:
        raise InputError(f"{key}: there is no {quoted(value)}; {suggestion(value, words)}")
    return value


def coefficients(value: object, key: str) -> list[Exact]:
    """The coefficients of a polynomial: a list, or a text such as "1, -0.5"."""
    if isinstance(value, str):
        value = re.split(r"[\s,]+", _without_decimal_commas(value, key))
    if not isinstance(value, list):
        raise InputError(f"{key} is a list of numbers in descending powers, such as {key} = [1, 0.5]")
    return [parse_number(c, "1", key) for c in value]


def quantities(value: object, unit: str, key: str) -> list[Exact]:
    """Several values of one quantity: a list, or a text such as "0, 1 mm, 2 mm"."""
    if isinstance(value, str):
        value = [part.strip() for part in _without_decimal_commas(value, key).split(",")]
    if not isinstance(value, list):
        raise InputError(f"{key} is a list of numbers, such as {key} = [0, 0.01]")
    numbers = [parse_number(v, unit, f"{key}[{i}]") for i, v in enumerate(value)]
    units = [str(v).lstrip("+-0123456789.eE ") for v in value]
    others = [its for its in units if its and its[0] != "/" and parse_number(f"1 {its}", unit, key) != 1]
    for own, number, its in zip(value, numbers, units, strict=True):
        if isinstance(own, str) and number and others and not its:  # 10 in "0, 10, 20 deg" would be rad
            raise InputError(f'{key}: {own} has no unit; write "{own} {others[0]}", or "{own} {unit}"')
    return numbers


def _without_decimal_commas(text: str, key: str) -> str:
    """What stands in the brackets of a list; "0, 0,4 N" may be two numbers or three, and is refused."""
    inside = text.strip("[] \t\n")
    doubtful = re.search(r"(?<![\d.])\d+,\d+(?![\d.])", inside)
    if doubtful and re.search(r",\s|;", inside):
        raise InputError(
            f"{key}: {quoted(doubtful[0])} may be one number or two, in {quoted(inside)}; a fraction has a "
            f'point, "{doubtful[0].replace(",", ".")}", and between two numbers stand a comma and a space'
        )
    return inside


def branches(value: object, motion: str) -> list[tuple[Exact | Interval, Exact | Interval]]:
    """Maxwell branches: pairs (μ, η), or a text such as "800:3, 200:20"."""
    if isinstance(value, str):
        value = [pair.split(":") for pair in value.split(",")]
    if not isinstance(value, list) or not all(isinstance(b, list) and len(b) == 2 for b in value):
        raise InputError(
            "branches is a list of pairs of stiffness and damping, such as branches = [[800, 3], [200, 20]]; "
            'on the command line "800:3, 200:20"'
        )
    spring, dashpot = (GLOSSARY[f"branch_{key}"].unit_for(motion) for key in ("stiffness", "damping"))
    return [(parse(k, spring, "branch stiffness"), parse(b, dashpot, "branch damping")) for k, b in value]


def flag(value: object, key: str) -> bool:
    """True or false, as TOML has them, or the same as a text."""
    known = {"true": True, "false": False}
    if isinstance(value, bool):
        return value
    if isinstance(value, str) and value.strip() in known:
        return known[value.strip()]
    given = quoted(value) if isinstance(value, str) else f"a value of type {type(value).__name__}"
    raise InputError(f"{key} is true or false; got {given}")


def as_text(value: object, key: str) -> str:
    """The name of a node, or of an element."""
    if not isinstance(value, str):
        raise InputError(f'{key} is a name in quotes, such as {key} = "tool"')
    return value


FILTERS: Mapping[str, tuple[str, ...]] = MappingProxyType(
    {
        "backward-difference": (), "window": ("samples",), "one-pole": ("time_constant", "cutoff"),
        "filter": ("numerator", "denominator"),
    }
)  # fmt: skip
"""The types of velocity filter and their keys."""


def velocity_filter(
    value: object, key: str = "velocity_filter"
) -> BackwardDifference | Window | OnePole | VelocityFilter:
    """A velocity estimator from a table, or a text such as "window 5" or "one-pole 50 Hz"."""
    if isinstance(value, str):
        value = _filter_table(value)
    if not isinstance(value, Mapping):
        raise InputError(f'{key} is {{ type = "…" }} with one of the types {", ".join(FILTERS)}')
    table = Table(key, value)
    name = table.text("type") if "type" in value else ""
    if name not in FILTERS:
        raise InputError(f"{key}: there is no type {quoted(name)}; {suggestion(name, FILTERS)}")
    table.check_keys(("type", *FILTERS[name]), f'a filter of type "{name}"')
    arguments = {k: v for k, v in table.values.items() if k != "type"}
    if len(arguments) != (1 if name == "one-pole" else len(FILTERS[name])):
        needed = " or ".join(FILTERS[name]) if name == "one-pole" else " and ".join(FILTERS[name])
        raise InputError(f'{key}: type "{name}" needs {needed}')
    return _filter(name, arguments)


def _filter(name: str, arguments: Mapping[str, object]) -> VelocityEstimator:
    if name == "window":
        return Window(parse_number(arguments["samples"], "1", "samples"))  # type: ignore[arg-type]  # checks it is whole
    if name == "one-pole":
        return OnePole(_time_constant(arguments))
    if name == "filter":
        return VelocityFilter(*(coefficients(arguments[k], k) for k in FILTERS["filter"]))
    return BackwardDifference()


def _time_constant(arguments: Mapping[str, object]) -> Exact | Interval:
    if "cutoff" not in arguments:
        return parse(arguments["time_constant"], "s", "time_constant")
    cutoff = parse(arguments["cutoff"], "Hz", "cutoff")
    low, high = ends(cutoff)
    slow, fast = map(time_constant_of, (low, high))
    return slow if low == high else Interval(fast, slow)


def time_constant_of(cutoff: Exact | Fraction) -> Exact:
    """τ = 1/(2πf) [s] of a cut-off frequency [Hz], rounded to a double as a controller would hold it."""
    if cutoff <= 0:
        raise InputError(f"cutoff must be > 0 Hz, got {float(cutoff):g}: the filter would pass nothing")
    return Exact(1 / (2 * math.pi * float(cutoff)))


def _filter_table(text: str) -> dict[str, object]:
    name, _, rest = text.strip().partition(" ")
    if not rest:
        return {"type": name}
    if name == "one-pole":
        return {"type": name, "cutoff" if rest.strip().endswith("Hz") else "time_constant": rest}
    if name == "filter":
        parts = rest.split("/")
        return {"type": name, **dict(zip(("numerator", "denominator"), parts, strict=False))}
    return {"type": name, (*FILTERS.get(name, ()), "samples")[0]: rest}


_READ: Mapping[str, Callable[[Any, str], Any]] = MappingProxyType(
    {"coefficients": coefficients, "flag": flag, "node": as_text, "velocity filter": velocity_filter}
)
"""By form, what has no unit."""


BETWEEN = "transmission."
"""What stands before a key of the transmission on the command line."""


def transmission_of(between: Table, motion: str) -> Transmission:
    """What a table of a transmission describes, "linear", "rotary", or "" where its units say which."""
    known = parameters_of(Transmission)
    for key in NOT_OF_IT.keys() & between.values.keys():
        raise InputError(f"{between.where(key)}: a transmission has no {key}: {NOT_OF_IT[key]}")
    between.check_keys(known, "a transmission")
    read: dict[str, Any] = {}
    for key, value in between.values.items():
        kind, name = known[key], BETWEEN + key
        with located(between.where(key)):
            read[key] = (
                word(value, name, kind.words)
                if kind.words
                else read_number(
                    value, kind.quantity, name, uncertain=True, bound=kind.bound, why=kind.why, motion=motion
                )
            )
    return Transmission(**read, motion=motion or motion_told(between.values))


def joint_transmissions(given: object, label: str, joints: int | None = None) -> tuple[Transmission, ...]:
    """Those of a table of joints, where a key has a list one for each; without `joints` else one for all."""
    if not isinstance(given, Mapping):
        raise InputError(f"{label}: transmission is a table of its own, such as [joints.transmission]")
    lists = {len(values) for values in given.values() if isinstance(values, list)}
    counts = lists | ({joints} if joints else set()) or {1}
    if len(counts) > 1:
        raise InputError(f"{label}: each list of transmission has one value for each joint, all as long")
    rows = [
        {key: values[n] if isinstance(values, list) else values for key, values in given.items()}
        for n in range(counts.pop())
    ]
    return tuple(transmission_of(Table(label, row), "") for row in rows)
