"""The elements of a scene that a specification can name, each a table of its own.

    [[environment.elements]]        in a table that has type = "scene", and port, the node that is held
    type = "spring"
    first = "handle"
    second = "tool"
    stiffness = "300 N/m"

`ELEMENTS` is the registry: a new element is one line.
"""

from __future__ import annotations

from collections.abc import Mapping
from types import MappingProxyType
from typing import TYPE_CHECKING, Any

from zwidth.errors import InputError
from zwidth.model.kind import Kind, bracketed
from zwidth.model.specification.table import Table, located, quoted, suggestion
from zwidth.model.specification.values import read

if TYPE_CHECKING:
    from zwidth.model.scene import Element

ELEMENTS: Mapping[str, Kind] = MappingProxyType(
    {
        "mass": Kind("scene.element", "Mass", "body that moves along the axis"),
        "spring": Kind("scene.element", "Spring", "spring between two nodes"),
        "damper": Kind("scene.element", "Damper", "damper between two nodes"),
        "lever": Kind("scene.element", "Lever", "rigid lever; of ratio 1 it makes two nodes one"),
        "contact": Kind("scene.nonlinear", "Contact", "surface that pushes and never pulls"),
        "coulomb-friction": Kind("scene.nonlinear", "CoulombFriction", "dry friction between two nodes"),
        "nonlinear-spring": Kind("scene.nonlinear", "NonlinearSpring", "spring through points"),
        "line-end": Kind("scene.line_end", "LineEnd", "end of a line to another part of a scene"),
    }
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
    if "type" not in table.values:
        raise InputError(f"{table.label}: type is missing; it may be: {', '.join(ELEMENTS)}")
    name = table.text("type")
    if name not in ELEMENTS:
        raise InputError(f"{table.label}: there is no element {quoted(name)}; {suggestion(name, ELEMENTS)}")
    kind = ELEMENTS[name]
    keys = kind.keys
    table.check_keys(("type", *keys), f'an element of type "{name}"')
    if missing := kind.missing(table.values):
        needed = ", ".join(f"{key}{bracketed(keys[key], motion)}" for key in missing)
        raise InputError(f'{table.label}: type "{name}" needs {needed}')
    arguments: dict[str, Any] = {}
    for key in table.values:
        if key != "type":
            with located(table.label):
                arguments[key] = read(table.values[key], key, keys[key], motion)
    with located(table.label):
        element: Element = kind.made(**arguments)
    return element
