"""The types of environment that a specification can name.

`TYPES` is the registry: a new environment is one line.  It feeds the reader
here, the choices and the option help of the command line, and the docs.
"""

from __future__ import annotations

from collections.abc import Mapping
from types import MappingProxyType
from typing import TYPE_CHECKING, Any

from zwidth.errors import InputError
from zwidth.model.environment import Environment
from zwidth.model.kind import Kind, bracketed, kinds
from zwidth.model.specification.table import COMMAND_LINE, Table, located, named_kind
from zwidth.model.specification.values import read
from zwidth.quantity.parameter import Parameter

if TYPE_CHECKING:
    from zwidth.model.scene import Element


DEEPEST = 4
"""Couplings inside couplings; more is a mistake."""

TYPES: Mapping[str, Kind] = MappingProxyType(
    {
        "wall": Kind("environment", "Wall", "spring and damper inside x > 0"),
        "maxwell": Kind("environment", "Maxwell", "spring and dashpot in series"),
        "standard-linear-solid": Kind(
            "environment", "StandardLinearSolid", "spring with one Maxwell branch beside it"
        ),
        "generalized-maxwell": Kind(
            "environment", "GeneralizedMaxwell", "spring with Maxwell branches beside it, a Prony series"
        ),
        "nonlinear-spring": Kind(
            "environment", "NonlinearSpring", "force through points, linear between them and constant beyond"
        ),
        "hunt-crossley": Kind(
            "environment", "HuntCrossley", "contact whose damping grows with the depth, K uⁿ (1 + λ v)"
        ),
        "transfer-function": Kind("environment", "ContinuousTransferFunction", "H(s) with a discretization"),
        "pulse-transfer-function": Kind("environment", "PulseTransferFunction", "H(z)"),
        "virtual-coupling": Kind(
            "rendering", "VirtualCoupling", "spring and damper between the device and another environment"
        ),
        "scene": Kind("scene", "Scene", "masses, springs, contacts, … that give out no energy"),
        "coupled-body": Kind(
            "environment.bodies", "CoupledBody", "mass behind a virtual coupling, as an integrator steps it"
        ),
    }
)


def option_keys() -> dict[str, Parameter]:
    """Every environment key under its name on the command line; with several meanings it has the first.

    There `damping` is the device's, so the environment's is `virtual_damping`;
    `sample_period`, too, is the device's. A key of the environment behind a
    coupling is written `environment.stiffness`.  A scene is given in a file.
    """
    return {
        "virtual_damping" if name == "damping" else name: key
        for name, key in all_keys().items()
        if key.form not in ("environment", "elements", "node") and name != "sample_period"
    }


def all_keys() -> dict[str, Parameter]:
    """Every key of every environment; one with several meanings has the first."""
    keys: dict[str, Parameter] = {}
    for row in TYPES.values():
        for name, key in row.keys.items():
            keys.setdefault(name, key)
    return keys


def build_environment(table: Table, motion: str, depth: int = 0) -> Environment:
    """The environment that a table describes, in the units of the device's motion."""
    kind = named_kind(table, TYPES, "environment of type")
    keys = kind.keys
    if "damping" in keys:
        table.rename("virtual_damping", "damping")
    allowed = ("type", *keys, *(["virtual_damping"] if "damping" in keys else []))
    table.check_keys(allowed, f'an environment of type "{table.text("type")}"')
    if missing := kind.missing(table.values):
        needed = ", ".join(f"{_named(table, key)}{bracketed(keys[key], motion)}" for key in missing)
        raise InputError(f'{table.label}: type "{table.text("type")}" needs {needed}')
    arguments = {key: _read(table, key, keys[key], motion, depth) for key in table.values if key != "type"}
    with located(table.label):
        environment: Environment = kind.made(**arguments)
    return environment


def _named(table: Table, key: str) -> str:
    """A key as it is written where the table was: as an option on the command line."""
    if key == "elements":
        return "elements, one [[environment.elements]] table each, in a file"
    own = "virtual_damping" if key == "damping" else key
    return f"--{own.replace('_', '-')}" if table.label == COMMAND_LINE else own


def _read(table: Table, key: str, own: Parameter, motion: str, depth: int) -> Any:
    value = table.values[key]
    if own.form == "environment":
        return _nested(table, key, value, motion, depth)
    if own.form == "elements":
        return build_elements(value, table.where(key), motion)
    with located(table.where(key)):
        return read(value, key, own, motion)


def _nested(table: Table, key: str, value: object, motion: str, depth: int) -> Environment:
    if not isinstance(value, Mapping):
        raise InputError(
            f'{table.where(key)}: {key} is a table, such as [environment.environment] type = "wall"'
        )
    if depth >= DEEPEST:
        raise InputError(f"{table.label}: more than {DEEPEST} couplings inside each other")
    label = table.label.removesuffix("]") + ".environment]" if table.label.endswith("]") else table.label
    return build_environment(Table(label, value), motion, depth + 1)


ELEMENTS = kinds(
    "scene",
    {
        "Mass": "body that moves along the axis",
        "Spring": "spring between two nodes",
        "Damper": "damper between two nodes",
        "Lever": "rigid lever; of ratio 1 it makes two nodes one",
        "Contact": "surface that pushes and never pulls",
        "CoulombFriction": "dry friction between two nodes",
        "NonlinearSpring": "spring through points",
        "LineEnd": "end of a line to another part of a scene",
    },
)

MOST = 10_000
"""Elements of a scene in a file; more is a mistake."""


def build_elements(value: object, label: str, motion: str) -> list[Element]:
    """The elements that tables describe; `label` says where they stand."""
    if not isinstance(value, list) or not all(isinstance(one, Mapping) for one in value):
        raise InputError(f'{label}: elements are tables, such as [[environment.elements]] type = "mass"')
    if len(value) > MOST:
        raise InputError(f"{label}: {len(value)} elements, more than {MOST}")
    return [_element(Table(f"{label}, element {n}", one), motion) for n, one in enumerate(value, 1)]


def _element(table: Table, motion: str) -> Element:
    kind = named_kind(table, ELEMENTS, "element")
    name, keys = table.text("type"), kind.keys
    table.check_keys(("type", *keys), f'an element of type "{name}"')
    if missing := kind.missing(table.values):
        needed = ", ".join(f"{key}{bracketed(keys[key], motion)}" for key in missing)
        raise InputError(f'{table.label}: type "{name}" needs {needed}')
    with located(table.label):
        arguments = {key: read(v, key, keys[key], motion) for key, v in table.values.items() if key != "type"}
        element: Element = kind.made(**arguments)
        return element
