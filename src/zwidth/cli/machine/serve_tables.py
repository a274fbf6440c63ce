"""The tables [connection] and [safety] of `zwidth serve`, and their options."""

from __future__ import annotations

import argparse
from collections.abc import Callable, Iterable, Mapping
from typing import TYPE_CHECKING

from zwidth.cli.options import given
from zwidth.cli.parsing import Parameter
from zwidth.errors import InputError
from zwidth.model.specification.table import COMMAND_LINE, Table

if TYPE_CHECKING:
    from zwidth.machine.servo import Connection, Placement

CONNECTION, SAFETY, OPERATOR = "connection", "safety", "operator"


def connection_parameters() -> list[Parameter]:
    from zwidth.machine.servo.devices.registry import CONNECTIONS, SIMULATED, keys

    kinds = ", ".join((SIMULATED, *CONNECTIONS))
    found = [
        Parameter(CONNECTION, "TYPE", f"{kinds} (default: {SIMULATED})"),
        Parameter(f"{CONNECTION}.origin", "x_0", "reading at the surface [m; rotary rad] (default: 0)"),
        Parameter(f"{CONNECTION}.sense", "±1", "-1 where the wall is at smaller readings (default: 1)"),
    ]
    for name, (key, owners) in keys().items():
        unit = f" [{key.unit}]" if key.unit else ""
        text = f"{key.meaning}{unit}; of {', '.join(owners)}"
        found.append(Parameter(f"{CONNECTION}.{name}", name.rpartition("_")[2].upper(), text))
    return found


def safety_parameters() -> list[Parameter]:
    from zwidth.machine.servo.safety import MEANINGS, Safety
    from zwidth.quantity.parameter import parameters_of

    found = []
    for name, own in parameters_of(Safety).items():
        units = own.quantity.unit
        if units != own.quantity.rotary_unit:
            units += f"; rotary {own.quantity.rotary_unit}"
        bracket = "" if units == "1" else f" [{units}]"
        found.append(Parameter(f"{SAFETY}.{name}", own.quantity.symbol, MEANINGS[name] + bracket))
    return found


def reached(table: Table, motion: str) -> tuple[Connection | None, Placement | None]:
    """The connection of a table, and where the wall is; None and None for the simulated one."""
    from zwidth.machine.servo import Placement
    from zwidth.machine.servo.devices.registry import SIMULATED, build_connection

    place = Table(table.label, {k: table.values.pop(k) for k in ("origin", "sense") if k in table.values})
    kind = table.values.get("type", SIMULATED)
    if kind == SIMULATED:
        if place.values:
            raise InputError("the simulated device has its wall at 0: leave out origin and sense")
        table.check_keys(("type",), "the simulated connection")
        return None, None
    return build_connection(table), Placement.read(place, motion)


def told(
    arguments: argparse.Namespace,
    tables: Mapping[str, Table],
    name: str,
    parameters: Callable[[], Iterable[Parameter]],
) -> Table:
    """The table of a name, with what was typed in its place."""
    return merged(tables.get(name), given(arguments, [p.key for p in parameters()]), name)


def merged(table: Table | None, typed: Mapping[str, str], name: str) -> Table:
    """A table of the file, with what was typed in its place."""
    found = Table(COMMAND_LINE, {}) if table is None else table
    for key, value in typed.items():
        found.override("type" if key == name else key.removeprefix(f"{name}."), value)
    return found
