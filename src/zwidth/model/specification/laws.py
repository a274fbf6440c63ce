"""The laws in a chain behind an environment that a specification can name.

    [[law]]                                  --law extrapolation,passivity-controller
    type = "passivity-controller"
    largest_damping = "0.8 N*s/m"

`zwidth.rendering.LAWS` is the registry.  The order of the tables is the order of the laws, from the
environment to the actuator.  On the command line a law has its defaults; laws there take the place of
the file's.
"""

from __future__ import annotations

from collections.abc import Iterable, Mapping
from typing import TYPE_CHECKING, Any

from zwidth.errors import InputError
from zwidth.model.environment import Environment
from zwidth.model.kind import Kind, bracketed
from zwidth.model.rendering import ESTIMATORS, LAWS
from zwidth.model.specification.table import COMMAND_LINE, Table, located, named_kind
from zwidth.model.specification.values import read
from zwidth.quantity.parameter import Parameter

if TYPE_CHECKING:
    from zwidth.model.rendering import Estimator, RenderingLaw

NOT_PROVED = (
    "laws in a chain have no place in this command: zwidth check decides them, zwidth limit says how far one "
    "may go, zwidth compare judges them, zwidth simulate shows a touch"
)
"""What commands say to them that take a device alone, or a wall."""

MOST = 16
"""Laws in a chain; more is a mistake."""

ROW = "row"
"""The one key of the table in which the laws of a file are kept."""


def with_laws(
    environment: Environment, table: Table | None, typed: Iterable[str] | None, motion: str
) -> Environment:
    """The environment behind the laws that were given; itself where there are none.

    What stood behind each `--law`, `typed`, takes the place of a file's [[law]] tables.
    """
    return behind_laws(environment, law_tables(table, typed), motion)


def law_tables(table: Table | None, typed: Iterable[str] | None) -> list[Table]:
    """The table of each law, as `with_laws` takes them."""
    tables = _tables(table) if typed is None else [*_named(typed)]
    if len(tables) > MOST:
        raise InputError(f"{tables[MOST].label}: more than {MOST} laws in a chain")
    return tables


def behind_laws(environment: Environment, tables: Iterable[Table], motion: str) -> Environment:
    """The environment behind the law of each table; itself where there are none."""
    laws = [build_law(law, motion) for law in tables]
    if not laws:
        return environment
    from zwidth.model.rendering import render

    return render(environment, *laws)


def _tables(table: Table | None) -> list[Table]:
    if table is None:
        return []
    row = table.values[ROW]
    assert isinstance(row, list)
    many = len(row) > 1
    return [Table(f"{table.label} {n}" if many else table.label, one) for n, one in enumerate(row, 1)]


def _named(typed: Iterable[str]) -> Iterable[Table]:
    for names in typed:
        for name in names.split(","):
            yield Table(f"{COMMAND_LINE}: --law", {"type": name.strip()})


def build_law(table: Table, motion: str) -> RenderingLaw:
    """The law that a table describes, in the units of the device's motion."""
    law: RenderingLaw = _built(table, LAWS, "law", motion)
    return law


def _built(table: Table, kinds: Mapping[str, Kind], what: str, motion: str) -> Any:
    kind = named_kind(table, kinds, what)
    name = table.text("type")
    table.check_keys(("type", *kind.keys), f'a {what} of type "{name}"')
    if missing := kind.missing(table.values):
        needed = ", ".join(f"{key}{bracketed(kind.keys[key], motion)}" for key in missing)
        where = ", in a [[law]] table of a file" if table.label.startswith(COMMAND_LINE) else ""
        raise InputError(f'{table.label}: the {what} "{name}" needs {needed}{where}')
    with located(table.label):
        arguments = {
            key: _read(table.values[key], key, kind.keys[key], motion)
            for key in table.values
            if key != "type"
        }
        return kind.made(**arguments)


def _read(value: object, key: str, own: Parameter, motion: str) -> Any:
    return _velocity(value, key, motion) if own.form == "velocity" else read(value, key, own, motion)


def _velocity(value: object, key: str, motion: str) -> Estimator:
    values = {"type": value} if isinstance(value, str) else value
    if not isinstance(values, Mapping):
        raise InputError(f'{key} is {{ type = "…" }} with one of the types {", ".join(ESTIMATORS)}')
    estimator: Estimator = _built(Table(key, values), ESTIMATORS, "velocity", motion)
    return estimator
