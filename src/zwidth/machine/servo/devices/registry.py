"""The connections that a specification can name, and their keys.

[connection]
type = "odrive"
port = "/dev/ttyACM0"
"""

from __future__ import annotations

from collections.abc import Mapping
from importlib import import_module
from types import MappingProxyType
from typing import Any, NamedTuple

from zwidth.errors import InputError
from zwidth.machine.servo.connection import Connection
from zwidth.missing import suggestion
from zwidth.model.specification.table import Table, located, quoted
from zwidth.quantity.glossary import Quantity
from zwidth.quantity.parameter import read_number

SIMULATED = "simulated"
"""The one that needs the device itself, and a hand."""


class Key(NamedTuple):
    """A key of a connection, of the form "text", "whole", "flag", or "number", whose unit is SI."""

    meaning: str
    form: str = "text"
    unit: str = ""


class Way(NamedTuple):
    """A class of connections; its module is imported when it is asked for."""

    class_name: str
    module: str
    meaning: str
    keys: Mapping[str, Key]
    needed: tuple[str, ...] = ()

    @property
    def made(self) -> type[Connection]:
        """The class."""
        made: type[Connection] = getattr(
            import_module(f"zwidth.machine.servo.devices.{self.module}"), self.class_name
        )
        return made


_PORT = Key("serial port, such as /dev/ttyACM0")
_BAUD = Key("bits per second of the port", "whole")
_AXIS = Key("axis of the device")
_NUMBER = Key("number of the device on its bus", "whole")
_REVERSE = Key("true: a positive command turns it towards smaller readings", "flag")
_WATCHDOG = Key("after so long without a command the device gives no force", "number", "s")

CONNECTIONS: Mapping[str, Way] = MappingProxyType({
    "inverse": Way("Inverse", "inverse", "the Haply Inverse service", {
        "axis": _AXIS, "device": Key("its identifier, where the service has several"),
        "address": Key("host and port of the service"),
    }),
    "haply": Way("HaplyPantograph", "haply", "a Haply 2DIY", {
        "port": _PORT, "axis": _AXIS, "version": Key("of the 2DIY: 3 or 2", "whole"),
    }, ("port",)),
    "haply-motor": Way("HaplyMotor", "haply", "one motor at a Haply board", {
        "port": _PORT, "counts": Key("of its encoder in one turn", "number", "1"),
        "offset": Key("angle at which it stands when it is opened", "number", "rad"),
        "rotation": Key("ccw or cw, as the angle grows"), "motor": Key("the same for its torque"),
    }, ("port", "counts")),
    "hapkit": Way("Hapkit", "hapkit", "a Hapkit with the sketch of examples/hapkit", {
        "port": _PORT, "baud": _BAUD, "count": Key("way of the handle in one count", "number", "m"),
    }, ("port", "count")),
    "force-dimension": Way("ForceDimension", "force_dimension",
                           "omega, delta, sigma through the maker's library", {
        "axis": _AXIS, "index": Key("number of the device, from 0", "whole"),
        "simulator": Key("true: the maker's simulator", "flag"),
    }),
    "moteus": Way("Moteus", "moteus", "a moteus behind a CAN adapter, or at its own UART", {
        "port": _PORT, "identifier": _NUMBER, "watchdog": _WATCHDOG,
        "checksums": Key("true: frames carry a checksum", "flag"), "baud": _BAUD,
    }, ("port",)),
    "odrive": Way("ODrive", "odrive", "an ODrive by its text protocol", {
        "port": _PORT, "axis": Key("0 or 1", "whole"), "baud": _BAUD, "watchdog": _WATCHDOG,
    }, ("port",)),
    "dynamixel": Way("Dynamixel", "dynamixel", "a Dynamixel servo, X series", {
        "port": _PORT, "identifier": _NUMBER, "baud": _BAUD, "watchdog": _WATCHDOG,
        "torque_per_current": Key("torque of one ampere", "number", "N*m/A"),
        "current_unit": Key("current of one unit, where the model is unknown", "number", "A"),
        "reverse": _REVERSE,
    }, ("port", "torque_per_current")),
    "feetech": Way("Feetech", "feetech", "a Feetech STS servo", {
        "port": _PORT, "identifier": _NUMBER, "baud": _BAUD,
        "full_duty_torque": Key("torque at full duty and standstill", "number", "N*m"), "reverse": _REVERSE,
    }, ("port", "full_duty_torque")),
})  # fmt: skip


def keys() -> dict[str, tuple[Key, list[str]]]:
    """Every key, and which connections have it."""
    found: dict[str, tuple[Key, list[str]]] = {}
    for name, way in CONNECTIONS.items():
        for key, own in way.keys.items():
            found.setdefault(key, (own, []))[1].append(name)
    return found


def build_connection(table: Table) -> Connection:
    """The connection that a table describes."""
    kind = table.text("type")
    if kind not in CONNECTIONS:
        hint = suggestion(kind, (SIMULATED, *CONNECTIONS))
        raise InputError(f"{table.where('type')}: there is no connection {quoted(kind)}; {hint}")
    way = CONNECTIONS[kind]
    table.check_keys(("type", *way.keys), f"the connection {quoted(kind)}")
    for key in way.needed:
        if key not in table.values:
            what = way.keys[key].meaning
            raise InputError(f"{table.label}: the connection {quoted(kind)} needs {key}: {what}")
    values = {key: _value(table, key, way.keys[key]) for key in table.values if key != "type"}
    with located(table.label):
        made: Any = way.made
        built: Connection = made(**values)
        return built


def _value(table: Table, name: str, key: Key) -> Any:
    given = table.values[name]
    if key.form == "text":
        return table.text(name)
    if key.form == "flag":
        if isinstance(given, bool) or given in ("true", "false"):
            return given in (True, "true")
        raise InputError(f"{table.where(name)}: {name} is true or false, got {given!r}")
    with located(table.where(name)):
        unit = key.unit or "1"
        number = read_number(given, Quantity(name, name, unit, unit, key.meaning), name)
    if key.form == "whole":
        if number.fraction.denominator != 1:
            raise InputError(f"{table.where(name)}: {name} is a whole number, got {given!r}")
        return int(number.fraction)
    return float(number)
