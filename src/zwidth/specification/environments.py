"""The types of environment that a specification can name.

`TYPES` is the registry: a new environment is one row.  It feeds the reader
here, the choices and the option help of the command line, and the docs.
"""

from __future__ import annotations

from collections.abc import Mapping
from importlib import import_module
from types import MappingProxyType
from typing import Any, Literal, NamedTuple

from zwidth.environment import Environment
from zwidth.errors import InputError
from zwidth.quantity.glossary import GLOSSARY
from zwidth.quantity.units import parse, parse_number
from zwidth.specification.table import COMMAND_LINE, Table, located, quoted, suggestion
from zwidth.specification.values import branches, coefficients, flag, quantities, velocity_filter

Form = Literal[
    "quantity",
    "number",
    "coefficients",
    "branches",
    "word",
    "flag",
    "list",
    "velocity filter",
    "environment",
]

DEEPEST = 4
"""Couplings inside couplings; more is a mistake."""


class Key(NamedTuple):
    """One key of an environment table, an argument of its class."""

    form: Form
    meaning: str
    quantity: str = ""
    required: bool = True


class EnvironmentType(NamedTuple):
    """A type of environment: its class and its keys."""

    module: str
    class_name: str
    meaning: str
    keys: Mapping[str, Key]


def _number(quantity: str, required: bool = True) -> Key:
    return Key("quantity", GLOSSARY[quantity].meaning, quantity, required)


_DISCRETIZATION = Key("word", "backward, forward, tustin, zoh, impulse or matched", required=False)
_CLAMPED = Key(
    "flag",
    "true for a law that never pulls, f = max(0, …); by default only of a Hunt–Crossley contact",
    required=False,
)
_NUMERATOR = Key("coefficients", "numerator, descending powers")
_DENOMINATOR = Key("coefficients", "denominator, descending powers")

TYPES: Mapping[str, EnvironmentType] = MappingProxyType(
    {
        "wall": EnvironmentType(
            "zwidth.environment",
            "Wall",
            "spring and damper inside x > 0",
            {
                "stiffness": _number("stiffness"),
                "damping": _number("virtual_damping", required=False),
                "velocity_filter": Key(
                    "velocity filter",
                    "backward-difference, window N, one-pole τ or f, filter",
                    required=False,
                ),
                "clamped": _CLAMPED,
            },
        ),
        "maxwell": EnvironmentType(
            "zwidth.environment",
            "Maxwell",
            "spring and dashpot in series",
            {
                "stiffness": _number("stiffness"),
                "damping": _number("virtual_damping"),
                "discretization": _DISCRETIZATION,
                "clamped": _CLAMPED,
            },
        ),
        "standard-linear-solid": EnvironmentType(
            "zwidth.environment",
            "StandardLinearSolid",
            "spring with one Maxwell branch beside it",
            {
                "stiffness": _number("stiffness"),
                "branch_stiffness": _number("branch_stiffness"),
                "branch_damping": _number("branch_damping"),
                "discretization": _DISCRETIZATION,
                "clamped": _CLAMPED,
            },
        ),
        "generalized-maxwell": EnvironmentType(
            "zwidth.environment",
            "GeneralizedMaxwell",
            "spring with Maxwell branches beside it, a Prony series",
            {
                "stiffness": _number("stiffness"),
                "branches": Key("branches", "pairs of branch stiffness and branch damping"),
                "discretization": _DISCRETIZATION,
                "clamped": _CLAMPED,
            },
        ),
        "nonlinear-spring": EnvironmentType(
            "zwidth.environment",
            "NonlinearSpring",
            "force through points, linear between them and constant beyond",
            {
                "positions": Key("list", "positions of the points, increasing", "position"),
                "forces": Key("list", "forces at the points, > 0 towards smaller positions", "force"),
            },
        ),
        "hunt-crossley": EnvironmentType(
            "zwidth.environment",
            "HuntCrossley",
            "contact whose damping grows with the depth, K uⁿ (1 + λ v)",
            {
                "stiffness": Key("number", "K of a Hunt–Crossley contact, in N/mⁿ"),
                "exponent": _number("exponent", required=False),
                "dissipation": _number("dissipation", required=False),
                "clamped": _CLAMPED,
            },
        ),
        "transfer-function": EnvironmentType(
            "zwidth.environment",
            "ContinuousTransferFunction",
            "H(s) with a discretization",
            {"numerator": _NUMERATOR, "denominator": _DENOMINATOR, "discretization": _DISCRETIZATION},
        ),
        "pulse-transfer-function": EnvironmentType(
            "zwidth.environment",
            "PulseTransferFunction",
            "H(z)",
            {
                "numerator": _NUMERATOR,
                "denominator": _DENOMINATOR,
                "sample_period": _number("sample_period", required=False),
            },
        ),
        "virtual-coupling": EnvironmentType(
            "zwidth.rendering",
            "VirtualCoupling",
            "spring and damper between the device and another environment",
            {
                "stiffness": _number("stiffness"),
                "damping": _number("virtual_damping"),
                "environment": Key("environment", "the environment behind the coupling"),
            },
        ),
    }
)


def option_keys() -> dict[str, Key]:
    """Every environment key under its name on the command line; with several meanings it has the first.

    There `damping` is the device's, so the environment's is `virtual_damping`;
    `sample_period`, too, is the device's. A key of the environment behind a
    coupling is written `environment.stiffness`.
    """
    return {
        "virtual_damping" if name == "damping" else name: key
        for name, key in all_keys().items()
        if key.form != "environment" and name != "sample_period"
    }


def all_keys() -> dict[str, Key]:
    """Every key of every environment; one with several meanings has the first."""
    keys: dict[str, Key] = {}
    for row in TYPES.values():
        for name, key in row.keys.items():
            keys.setdefault(name, key)
    return keys


def build_environment(table: Table, motion: str, depth: int = 0) -> Environment:
    """The environment that a table describes, in the units of the device's motion.

    Raises
    ------
    InputError
        If the type or a key is unknown, missing, or has a value it cannot have.
    """
    row = _row(table)
    if "damping" in row.keys:
        table.rename("virtual_damping", "damping")
    allowed = ("type", *row.keys, *(["virtual_damping"] if "damping" in row.keys else []))
    table.check_keys(allowed, f'an environment of type "{table.text("type")}"')
    missing = [key for key, k in row.keys.items() if k.required and key not in table.values]
    if missing:
        needed = ", ".join(f"{_named(table, key)}{_unit(row.keys[key], motion)}" for key in missing)
        raise InputError(f'{table.label}: type "{table.text("type")}" needs {needed}')
    arguments = {
        key: _read(table, key, row.keys[key], motion, depth) for key in table.values if key != "type"
    }
    with located(table.label):
        environment: Environment = getattr(import_module(row.module), row.class_name)(**arguments)
    return environment


def _named(table: Table, key: str) -> str:
    """A key as it is written where the table was: as an option on the command line."""
    own = "virtual_damping" if key == "damping" else key
    return f"--{own.replace('_', '-')}" if table.label == COMMAND_LINE else own


def _row(table: Table) -> EnvironmentType:
    if "type" not in table.values:
        raise InputError(f"{table.label}: type is missing; it may be: {', '.join(TYPES)}")
    name = table.text("type")
    if name not in TYPES:
        hint = suggestion(name, TYPES)
        raise InputError(f"{table.where('type')}: there is no environment of type {quoted(name)}; {hint}")
    return TYPES[name]


def _unit(key: Key, motion: str) -> str:
    return f" [{GLOSSARY[key.quantity].unit_for(motion)}]" if key.quantity else ""


def _read(table: Table, key: str, kind: Key, motion: str, depth: int) -> Any:
    value = table.values[key]
    if kind.form == "environment":
        return _nested(table, key, value, motion, depth)
    if kind.form == "word":
        return table.text(key)
    with located(table.where(key)):
        if kind.form == "quantity":
            return parse(value, GLOSSARY[kind.quantity].unit_for(motion), key)
        if kind.form == "number":
            return parse_number(value, "1", key)
        if kind.form == "list":
            return quantities(value, GLOSSARY[kind.quantity].unit_for(motion), key)
        if kind.form == "coefficients":
            return coefficients(value, key)
        if kind.form == "branches":
            return branches(value, motion)
        if kind.form == "flag":
            return flag(value, key)
        return velocity_filter(value)


def _nested(table: Table, key: str, value: object, motion: str, depth: int) -> Environment:
    if not isinstance(value, Mapping):
        raise InputError(
            f'{table.where(key)}: {key} is a table, such as [environment.environment] type = "wall"'
        )
    if depth >= DEEPEST:
        raise InputError(f"{table.label}: more than {DEEPEST} couplings inside each other")
    label = table.label.removesuffix("]") + ".environment]" if table.label.endswith("]") else table.label
    return build_environment(Table(label, value), motion, depth + 1)
