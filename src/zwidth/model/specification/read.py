"""A device and an environment from TOML files and the command line.

    [device]                            [environment]
    damping = "0.15 N*s/m"              type = "wall"
    rate = "1 kHz"                      stiffness = 300

One file or two, or the name of a catalogue device in the place of the first; plain numbers are SI and exact
as typed.  Every parameter can be overridden under its own name; `damping` is then the device's,
`virtual_damping` the wall's.  Nothing is ignored: an unknown key is an error.
"""

from __future__ import annotations

from collections.abc import Callable, Iterable, Mapping, Sequence
from dataclasses import dataclass, field
from decimal import Decimal
from fractions import Fraction
from functools import partial
from pathlib import Path
from typing import Any, TypeVar

from zwidth.errors import InputError
from zwidth.missing import did_you_mean, near_file, suggestion
from zwidth.model.device import Device, Transmission, catalogue
from zwidth.model.device.catalogue import DeviceInRange, Range
from zwidth.model.device.rotary import ROTARY, rotary
from zwidth.model.environment import Environment
from zwidth.model.specification.environments import build_environment, option_keys
from zwidth.model.specification.laws import NOT_PROVED, ROW
from zwidth.model.specification.table import COMMAND_LINE, Table, located, plain, quoted
from zwidth.model.specification.values import BETWEEN, transmission_of
from zwidth.quantity.exact import Exact, Interval, ends
from zwidth.quantity.glossary import GLOSSARY
from zwidth.quantity.parameter import parameters_of
from zwidth.quantity.spoken import angles_in
from zwidth.quantity.units import parse

T = TypeVar("T")

_HARDLY = {"s": (Fraction(1, 2), "ms"), "kg": (Fraction(5), "g")}
"""Without a unit, so long a delay and so large a mass are questioned; what is meant most often."""

LARGEST_FILE = 1 << 20
"""Bytes; a specification is a page of text."""

_OWN_KEYS = (*catalogue.PROPERTIES, *ROTARY, "motion", "name")
DEVICE_KEYS = (*_OWN_KEYS, "catalogue", *(BETWEEN + key for key in parameters_of(Transmission)))
"""The keys of a [device] table, those of its transmission as on the command line."""

LOOP_TABLES = ("device", "environment")
WITH_LAWS = (*LOOP_TABLES, "law")
TABLES = (*WITH_LAWS, "operator", "simulation")
"""The tables of a specification: of a loop, with laws behind its environment, and of a touch to simulate."""

PAIR_TABLES = ("leader", "follower", "coupling")
"""The tables of two arms that follow each other."""

_ONE_OF = (("rate", "sample_period"), ("resolution", "counts_per_turn"))
"""Two ways to say the same: overriding one puts the other aside."""


@dataclass(frozen=True)
class Specification:
    """What is to be checked: a device against an environment.

    `ranges` says by parameter of the device what of it the catalogue states as a range.
    """

    device: Device
    environment: Environment
    ranges: Mapping[str, Range] = field(default_factory=dict)


def load(sources: Sequence[Path | str], overrides: Mapping[str, str] | None = None) -> Specification:
    """Read files or catalogue names, then the command line's parameters.

    Parameters
    ----------
    sources
        TOML files with [device] and [environment]; a name in the catalogue stands for a [device].
    overrides
        Values by name, as typed: {"rate": "2 kHz", "virtual_damping": "0.1"}.
        Without an [environment] they describe a wall, or the `type` they give.

    Raises
    ------
    InputError
        If anything cannot be used: it says where it stands and what is allowed.
    """
    return specified(read_tables(sources), overrides)


def specified(tables: Mapping[str, Table], overrides: Mapping[str, str] | None = None) -> Specification:
    """The device and the environment of tables, as `load` reads them."""
    return built(*merged(tables, overrides))


def merged(tables: Mapping[str, Table], overrides: Mapping[str, str] | None = None) -> tuple[Table, Table]:
    """The tables of device and environment, with the command line's parameters in them."""
    names = {key.replace("-", "_"): value for key, value in (overrides or {}).items()}
    device_names = {key: value for key, value in names.items() if key in DEVICE_KEYS}
    environment_names = {key: value for key, value in names.items() if key not in DEVICE_KEYS}
    device, environment = _device_table(tables, device_names), environment_table(tables, environment_names)
    keep_axis(device, environment.values)
    return device, environment


def keep_axis(device: Table, rendered: object) -> None:
    """Leave a device about its axis where what it renders is told in angles, not at the handle.

    The radius only says where the same device is looked at: K [N·m/rad] about the axis is K/r² at the handle.
    """
    if "handle_radius" in device.values and angles_in(rendered):
        del device.values["handle_radius"]
        device.values.setdefault("motion", "rotary")


def built(device_table: Table, environment: Table, in_range: bool = True) -> Specification:
    """The device and the environment that two tables describe.

    Of the catalogue with stated ranges in the place of what nobody published; without `in_range` it is asked
    for.
    """
    found = _in_range(device_table) if in_range else DeviceInRange(build_device(device_table), {})
    return Specification(found.device, build_environment(environment, found.device.motion), found.ranges)


def _in_range(table: Table) -> DeviceInRange:
    if "catalogue" in table.values:
        return _catalogued(table, catalogue.in_range)
    return DeviceInRange(build_device(table), {})


def load_device(sources: Sequence[Path | str], overrides: Mapping[str, str]) -> Device:
    """The device alone: files with a [device] or names of the catalogue, then the command line's values."""
    return build_device(_device_table(read_tables(sources, ("device",)), overrides))


def specified_device(tables: Mapping[str, Table], overrides: Mapping[str, str]) -> Device:
    """The device of tables, with the command line's parameters."""
    return build_device(_device_table(tables, overrides))


def specified_in_range(tables: Mapping[str, Table], overrides: Mapping[str, str]) -> DeviceInRange:
    """The same; one of the catalogue with stated ranges in the place of what nobody published."""
    return _in_range(_device_table(tables, overrides))


def build_device(table: Table) -> Device:
    """The device that a table describes."""
    if "catalogue" in table.values:
        return _catalogued(table, catalogue.device)
    table.check_keys((*DEVICE_KEYS, "transmission"), "a device")
    turning = [key for key in ROTARY if key in table.values]
    motion = table.text("motion") if "motion" in table.values else "rotary" if turning else "linear"
    if turning and motion == "linear":
        raise InputError(
            f"{table.label}: {turning[0]} belongs to a rotary device, and motion is linear; drop one"
        )
    arguments = _arguments(table, motion)
    arguments.setdefault("damping", None)  # Device says that it is missing
    with located(table.label):
        if motion != "rotary":
            return Device(**arguments)
        if "mass" in arguments:
            raise InputError("a rotary device has an inertia [kg*m^2], not a mass")
        arguments.pop("motion", None)
        return rotary(**arguments)


def _device_value(table: Table, key: str, motion: str) -> Any:
    if key in ("name", "motion"):
        return table.text(key)
    unit = (ROTARY.get(key) or GLOSSARY[key]).unit_for(motion)
    with located(table.where(key)):
        value = parse(table.values[key], unit, key)
        if key == "delay":
            question_unit(table.values[key], value, key)
        return value


def _arguments(table: Table, motion: str) -> dict[str, Any]:
    """The values of a device's table, of its transmission in one."""
    own = {key: _device_value(table, key, motion) for key in table.values if key in _OWN_KEYS}
    inner = table.values.get("transmission", {})
    if not isinstance(inner, dict):
        raise InputError(f"{table.label}: transmission is a table, written [device.transmission]")
    between = Table(table.label.replace("[device]", "[device.transmission]"), inner)
    for key, value in table.values.items():
        if key.startswith(BETWEEN):
            between.override(key.removeprefix(BETWEEN), value)
    given = between.values or "transmission" in table.values
    return {**own, "transmission": transmission_of(between, motion)} if given else own


def question_unit(written: object, number: Exact | Interval, name: str, unit: str = "s") -> None:
    """Ask for the unit of a time or a mass that is hardly meant in seconds or kilograms."""
    (least, usual), most = _HARDLY[unit], ends(number)[1]
    if most >= least and not (isinstance(written, str) and any(map(str.isalpha, written))):
        bare = f"{float(most):g}"
        raise InputError(
            f"{name} {bare} without a unit is {bare} {unit}{_BETWEEN.get(name, '')}; write "
            f'"{bare} {usual}", or "{bare} {unit}" if that is meant'
        )


_BETWEEN = {"delay": " between sample and force"}
"""What lies between, where the name alone does not say it."""


def _catalogued(table: Table, build: Callable[..., T]) -> T:
    """What `build` makes of a device of the catalogue and the numbers beside its name."""
    table.check_keys((*DEVICE_KEYS, "transmission"), "a device")
    name = table.text("catalogue")
    with located(table.label):
        motion = catalogue.entry(name).motion
    foreign = [key for key in ROTARY if key in table.values and motion == "linear"]
    asked = table.text("motion") if "motion" in table.values else motion
    if foreign or asked != motion:
        there = "linear, at its handle" if motion == "linear" else "rotary, at its axis"
        raise InputError(f"{table.label}: {name} is {there}; drop {', '.join(foreign) or 'motion'}")
    arguments = _arguments(table, motion)
    with located(table.label):
        return build(name, **arguments)


def read_tables(sources: Sequence[Path | str], kinds: Sequence[str] = LOOP_TABLES) -> dict[str, Table]:
    """The tables in files, by kind."""
    tables: dict[str, Table] = {}
    for source in sources:
        for kind, table in _read(source, kinds).items():
            if kind in tables:
                raise InputError(
                    f"both {tables[kind].label} and {table.label} give the {kind}; "
                    "leave one out, or set single parameters on the command line"
                )
            tables[kind] = table
    return tables


def _read(source: Path | str, kinds: Sequence[str]) -> dict[str, Table]:
    if str(source) in catalogue.names():
        return {"device": Table(str(source), {"catalogue": str(source)})}
    name = _shown(source)
    tables = tables_of(_text(source), name, kinds)
    device = tables.get("device")
    if device is not None and "name" not in device.values and "catalogue" not in device.values:
        device.values["name"] = Path(source).stem
    return tables


def tables_of(text: str, name: str, kinds: Sequence[str] = LOOP_TABLES) -> dict[str, Table]:
    """The tables of a text, by kind; `name` says in messages where it stands."""
    content = _parse(text, name)
    for key, value in content.items():
        if key == "law" and key not in kinds:
            raise InputError(f"{name}: [[law]]: {NOT_PROVED}")
        if key not in kinds:
            if key == "environment":
                raise InputError(f"{name}: [environment]: {_ALONE}")
            hint = _CHECKED_BY.get(key) or suggestion(key, kinds)
            raise InputError(f"{name}: there is no table or key {quoted(key)} in a specification; {hint}")
        if key == "law":
            if not isinstance(value, list) or not all(isinstance(one, dict) for one in value):
                raise InputError(f"{name}: laws are tables in a row, each with [[law]] above its keys")
            content[key] = {ROW: value}
        elif not isinstance(value, dict):
            raise InputError(f"{name}: {key} is a table, written [{key}] above its keys")
    if not content:
        raise InputError(f"{name}: the file has none of the tables {', '.join(f'[{k}]' for k in kinds)}")
    return {
        key: Table(f"{name}: [[law]]" if key == "law" else f"{name}: [{key}]", value)
        for key, value in content.items()
    }


_ALONE = (
    "this command takes a device alone; put [environment] into a file of its own, and zwidth check, simulate "
    "and others take both files"
)

_CHECKED_BY = {
    **dict.fromkeys((*TABLES, "follower_operator"), "it is for zwidth simulate"),
    **dict.fromkeys(PAIR_TABLES, "it is of two arms that follow each other: zwidth pair decides them"),
}
"""Who reads a table that a command does not."""


_READ_BY = {
    **dict.fromkeys((".urdf", ".mjcf", ".xml"), "a description of an arm is for zwidth workspace"),
    **dict.fromkeys((".yaml", ".yml", ".json"), "gains of controllers and of arms are for zwidth gains"),
    ".csv": "a recording is for zwidth identify, diagnose or tissue",
}
"""Who reads a file of another kind."""


def refuse_settings(text: str, name: str) -> None:
    """Of OpenFFBoard's configurator a profile, or a copy of the flash: no number has a unit."""
    if any(all(f'"{key}":' in text for key in keys.split()) for keys in ("cls cmd value", "flash addr val")):
        raise InputError(
            f"{name}: settings of a force-feedback wheel (OpenFFBoard) without units: effects, 0 to 255, are "
            "parts of what only its firmware knows. Measure torque against angle and speed: zwidth check "
            'openffboard-wheel --stiffness "5 N*m/rad" --virtual-damping "0.1 N*m*s/rad"; why it shakes, '
            "zwidth diagnose RECORDING tells"
        )


def _parse(text: str, name: str) -> dict[str, Any]:
    import tomllib  # only where a file is read

    try:
        return tomllib.loads(text, parse_float=Decimal)
    except tomllib.TOMLDecodeError as error:
        refuse_settings(text, name)
        other = _READ_BY.get(Path(name).suffix.lower())
        if other is not None:
            raise InputError(f"{name}: not TOML, which devices and laws are written in; {other}") from None
        raise InputError(f"{name}: not TOML: {plain(str(error), 160)}") from None
    except (ValueError, ArithmeticError):  # what int and Decimal refuse
        raise InputError(f"{name}: a number or date in it is larger than any quantity") from None
    except RecursionError:
        raise InputError(f"{name}: nested too deeply for a specification") from None


def _text(source: Path | str) -> str:
    path, name = Path(source), f'"{_shown(source)}"'
    return text_of(path, name, "specification", "TOML file", partial(_not_there, path, name))


def text_of(path: Path, name: str, what: str, kind: str, missing: Callable[[], str]) -> str:
    """The text of a file that is a page: what is no file, larger, or no UTF-8 is refused.

    `name`, `what`, `kind`: the file, what it holds and what such files are, in messages.
    `missing`: what is said where there is none.
    """
    try:
        if path.is_dir():
            raise InputError(f"{name} is a directory; give the {kind} in it")
        if not path.exists():
            raise InputError(missing())
        if not path.is_file():
            raise InputError(f"{name} is not a regular file")
        with path.open("rb") as file:
            content = file.read(LARGEST_FILE + 1)
    except (OSError, ValueError) as error:
        if isinstance(error, InputError):
            raise
        reason = getattr(error, "strerror", None) or str(error)
        raise InputError(f"{name} cannot be read: {reason}") from None
    if len(content) > LARGEST_FILE:
        raise InputError(f"{name} is larger than {LARGEST_FILE // 1024} KiB; a {what} is a page of text")
    try:
        return content.decode("utf-8-sig")
    except UnicodeDecodeError as error:
        raise InputError(f"{name} is not UTF-8 text (byte {error.start}); save it as UTF-8") from None


def refuse_missing(sources: Iterable[Path | str]) -> None:
    """Refuse what is neither a device of the catalogue nor there, before one of them is read."""
    for source in sources:
        if str(source) not in catalogue.names() and not Path(source).exists():
            raise InputError(_not_there(Path(source), f'"{_shown(source)}"'))


def _not_there(path: Path, name: str) -> str:
    """What to say where there is no such file: one beside it, or a device of the catalogue, near in name."""
    if path.suffix == ".toml":
        return f"there is no file {name}{did_you_mean(path)}"
    from zwidth.model.arms import BUILT_IN  # only for this message

    if str(path) in BUILT_IN:
        return (
            f"{name} is an arm of several joints, which zwidth workspace reads; here it takes a single axis"
        )
    near = near_file(path, catalogue.names())
    hint = suggestion(near or str(path), [near] if near else catalogue.names())
    return f"{name} is neither a file nor a device of the catalogue; {hint}"


def _shown(source: Path | str) -> str:
    """The path on one line; of a long one the end, where the file's name stands."""
    text = str(source)
    return plain(text if len(text) <= 100 else f"...{text[-97:]}", 100)


def _device_table(tables: Mapping[str, Table], overrides: Mapping[str, str]) -> Table:
    table = tables.get("device")
    if table is None:
        if not overrides:
            raise InputError(
                "no device is given: name one of the catalogue, give a file with a [device] table, "
                "or set --damping and --rate"
            )
        table = Table(COMMAND_LINE, {})
    for key, value in overrides.items():
        others = [other for pair in _ONE_OF if key in pair for other in pair if other != key]
        table.override(key, value, instead_of=others)
    return table


def environment_table(tables: Mapping[str, Table], overrides: Mapping[str, str]) -> Table:
    """The table of the environment, with the command line's parameters in it."""
    table = tables.get("environment")
    known = option_keys()
    if table is None:
        if not overrides:
            raise InputError(
                'no environment is given: set --stiffness for a wall, such as "500 N/m", or of a device that '
                'turns "1 N*m/deg"; or write an [environment] table'
            )
        table = Table(COMMAND_LINE, {"type": "wall"})
    for key, value in overrides.items():
        if key.removeprefix("environment.") not in ("type", *known):
            every = {*DEVICE_KEYS, *known, "type"}
            options = sorted(one for one in every if one.startswith(BETWEEN) == key.startswith(BETWEEN))
            raise InputError(
                f"{COMMAND_LINE}: there is no parameter {quoted(key)}; {suggestion(key, options)}"
            )
        _override_environment(table, key, value)
    return table


def _override_environment(table: Table, key: str, value: str) -> None:
    if key.startswith("environment."):
        inner = table.values.get("environment")
        if not isinstance(inner, dict):
            raise InputError(
                f"{COMMAND_LINE}: {key} needs an environment behind a coupling, and there is none"
            )
        key = key.removeprefix("environment.")
        if key == "virtual_damping":
            inner.pop("damping", None)
        inner[key] = value
        return
    table.override(key, value, instead_of=("damping",) if key == "virtual_damping" else ())
