"""What is simulated besides the loop: the hand, and how the simulation is run.

    [operator]              [simulation]
    type = "dowel"          duration = "2 s"
    force = "4 N"           amplifier = "ideal"

Every key of [operator] is an option `--operator.force`, its type `--operator`;
every key of [simulation] is an option under its own name.
"""

from __future__ import annotations

from collections.abc import Callable, Iterator, Mapping
from types import MappingProxyType
from typing import Any, NamedTuple

from zwidth.cli.parsing import Parameter
from zwidth.errors import InputError
from zwidth.missing import suggestion
from zwidth.model.device import Device
from zwidth.model.device import amplifier as amplifiers
from zwidth.model.device.amplifier import Amplifier
from zwidth.model.environment import Wall
from zwidth.model.operator import (
    OPERATORS,
    HandsOff,
    Operator,
    ParametricOperator,
    RecordedForce,
    WitnessMotion,
)
from zwidth.model.operator.named import usual_kind
from zwidth.model.specification.table import COMMAND_LINE, Table, located, plain, quoted
from zwidth.quantity.glossary import GLOSSARY, Quantity
from zwidth.quantity.spoken import of_less_weight
from zwidth.quantity.units import parse_number

OPERATOR, FOLLOWER = "operator", "follower_operator"
"""The hand, and that on the follower of a pair; on the command line with a dot before its keys."""

RECORD, WITNESS, WALL = "force-record", "witness", "wall"
"""Operators that come out of a file; and what else may hold a follower."""

IN_A_WORD: Mapping[str, str] = MappingProxyType(
    {
        "constant-force": "the same push always",
        "cycle": "in and out each sample",
        "dowel": "a stick pressed on",
        "finger": "a finger of your numbers",
        "fingers-on": "thumb and finger on a knob",
        "guide": "a motor that pushes in",
        "hands-off": "let go",
        "hands-on": "two hands on a wheel",
        "malicious": "fast and loose",
        "soft": "a touch barely above friction",
        "typical": "a usual touch",
        RECORD: "measured forces of a file",
        WITNESS: "the motion that takes energy out, of a file",
    }
)
"""What each hand is."""

THROWN, _BESIDE = {"linear": "0.2 m/s", "rotary": "360 deg/s"}, {"linear": "1 mm", "rotary": "5 deg"}
"""How a device is let go, for example, by its motion."""

AMPLIFIERS = ("current", "ideal", "voltage-limited", "lag")


def _q(name: str, unit: str, rotary_unit: str, meaning: str) -> Quantity:
    return Quantity(name, name.rpartition("_")[2].upper(), unit, rotary_unit, meaning)


KEYS: dict[str, Quantity] = {
    "duration": _q("duration", "s", "s", "how long is simulated; not needed with a record or a witness"),
    "initial_position": _q("initial_position", "m", "rad", "where the device starts, > 0 inside the wall"),
    "initial_velocity": _q("initial_velocity", "m/s", "rad/s", "of the device at the start"),
    "encoder_phase": _q("encoder_phase", "1", "1", "part of a count by which the encoder is shifted, 0 to 1"),
    "amplifier": _q("amplifier", "", "", f"{', '.join(AMPLIFIERS)} (default: current)"),
    "amplifier_time_constant": _q("amplifier_time_constant", "s", "s", "of the amplifier that lags"),
    "lateness": _q("lateness", "s", "s", "each sample is late by up to so much"),
    "missed": _q("missed", "1", "1", "probability that a sample is missed"),
    "seed": _q("seed", "1", "1", "of the random lateness and misses"),
    "points_per_sample": _q("points_per_sample", "1", "1", "instants recorded per sample (default: 1)"),
}
"""The keys of [simulation]."""


_WALL_KEYS = {"stiffness": GLOSSARY["stiffness"], "damping": GLOSSARY["virtual_damping"]}
"""Of a real wall that a follower meets."""


class Touch(NamedTuple):
    """A hand, and the arguments of `simulate` that go with it; duration None: as long as the hand's own."""

    operator: Operator
    duration: float | None
    options: dict[str, Any]


def operator_parameters() -> Iterator[Parameter]:
    before = f"{OPERATOR}."
    kinds = ", ".join((*OPERATORS, RECORD, WITNESS))
    yield Parameter(
        OPERATOR,
        "TYPE",
        f"the hand, or that on the leader; begin with typical, of what turns hands-on: {kinds}",
    )
    yield Parameter(before + "file", "FILE", f"of a {RECORD} or {WITNESS}")
    yield Parameter(before + "column", "COLUMN", f"of the file of a {RECORD}, where it has several")
    yield Parameter(before + "rounds", "N", f"how often a {WITNESS} does its cycle (default: 100 at most)")
    for name, (quantity, kinds_with) in _shared().items():
        yield Parameter(before + name, quantity.symbol, _help(quantity, kinds_with))


def follower_parameters() -> Iterator[Parameter]:
    """The options of what holds the follower of a pair."""
    before = f"{FOLLOWER}."
    kinds = ", ".join((*OPERATORS, RECORD, WALL))
    yield Parameter(FOLLOWER, "TYPE", f"what holds the follower of a pair: {kinds} (default: nobody)")
    yield Parameter(before + "file", "FILE", f"of a {RECORD}")
    yield Parameter(before + "column", "COLUMN", f"of the file of a {RECORD}, where it has several")
    own = _shared()
    for name, quantity in _WALL_KEYS.items():
        own[name] = (quantity, [*own.get(name, (quantity, []))[1], WALL])
    for name, (quantity, kinds_with) in own.items():
        yield Parameter(before + name, quantity.symbol, _help(quantity, kinds_with))


def _help(quantity: Quantity, kinds: list[str]) -> str:
    units = quantity.unit
    if units != quantity.rotary_unit:
        units += f"; rotary {quantity.rotary_unit}"
    return f"{quantity.meaning} [{units}]; of {', '.join(kinds)}"


def simulation_parameters() -> Iterator[Parameter]:
    for key, quantity in KEYS.items():
        unit = "" if quantity.unit in ("", "1") else f" [{quantity.unit}]"
        if quantity.unit != quantity.rotary_unit:
            unit = f" [{quantity.unit}; rotary {quantity.rotary_unit}]"
        yield Parameter(key, quantity.symbol, quantity.meaning + unit)


def _shared() -> dict[str, tuple[Quantity, list[str]]]:
    """Every number of an operator, and which operators have it."""
    found: dict[str, tuple[Quantity, list[str]]] = {}
    for kind, operator in OPERATORS.items():
        for name, quantity in operator.parameters().items():
            found.setdefault(name, (quantity, []))[1].append(kind)
    return found


def build_touch(
    operator: Table | None, simulation: Table | None, overrides: Mapping[str, str], device: Device
) -> Touch:
    """The hand on a device and the run that tables and command line describe."""
    motion = device.motion
    hand_table = operator or Table(COMMAND_LINE, {})
    run_table = simulation or Table(COMMAND_LINE, {})
    for key, value in overrides.items():
        if key == OPERATOR:
            hand_table.override("type", value)
        elif key.startswith(f"{OPERATOR}."):
            hand_table.override(key.removeprefix(f"{OPERATOR}."), value)
        else:
            run_table.override(key, value)
    hand = build_hand(hand_table, device, OPERATOR)
    run_table.check_keys(KEYS, "a simulation")
    options = _options(run_table, motion)
    if isinstance(hand, HandsOff) and not {"initial_position", "initial_velocity"} & options.keys():
        raise InputError(
            "hands-off moves nothing by itself: say how it is let go, "
            f'--initial-velocity "{THROWN[motion]}" or --initial-position "{_BESIDE[motion]}"'
        )
    return Touch(hand, options.pop("duration", None), options)


def build_follower(
    table: Table | None, overrides: Mapping[str, str], device: Device
) -> Operator | Wall | None:
    """What holds the follower of a pair, as tables and command line describe it; None for nobody."""
    table = table or Table(COMMAND_LINE, {})
    for key, value in overrides.items():
        table.override("type" if key == FOLLOWER else key.removeprefix(f"{FOLLOWER}."), value)
    if not table.values:
        return None
    if table.values.get("type") != WALL:
        return build_hand(table, device, FOLLOWER)
    table.check_keys(("type", *_WALL_KEYS), "a wall that the follower meets")
    if "stiffness" not in table.values:
        raise InputError(f"{table.label}: the wall that the follower meets needs a stiffness")
    numbers = {
        name: _number(table, name, quantity, device.motion)
        for name, quantity in _WALL_KEYS.items()
        if name in table.values
    }
    with located(table.label):
        return Wall(numbers["stiffness"], numbers.get("damping", 0))


def build_hand(table: Table, device: Device, option: str = OPERATOR) -> Operator:
    """The hand on a device that a table describes; `option` is what it is called on the command line."""
    motion = device.motion
    begin = "typical" if motion == "linear" else usual_kind(device)
    if "type" not in table.values:
        kinds = "; ".join(f"{name}, {IN_A_WORD[name]}" for name in _fitting(motion))
        flag = f"--{option.replace('_', '-')}"
        raise InputError(
            f'no hand is given: begin with {flag} {begin} --duration "2 s", or take one of: {kinds}'
        )
    kind = table.text("type")
    if kind == RECORD:
        return _record(table)
    if kind == WITNESS:
        return _witness(table)
    if kind not in OPERATORS:
        hint = f"{suggestion(kind, _fitting(motion))}; begin with {begin}"
        raise InputError(f"{table.where('type')}: there is no hand {quoted(kind)}; {hint}")
    build: type[ParametricOperator] = OPERATORS[kind]
    if build.motion not in ("", motion):
        raise InputError(
            f"{table.where('type')}: {kind} holds a device that turns, this one is {motion}: take {begin}"
        )
    parameters = build.parameters()
    table.check_keys(("type", *parameters), f"the hand {quoted(kind)}")
    with of_less_weight():
        values = {
            name: _number(table, name, parameters[name], motion) for name in table.values if name != "type"
        }
    with located(table.label):
        try:
            return build(**values)
        except InputError as error:
            raise InputError(_in_their_words(str(error), table.values, values)) from None


def _fitting(motion: str) -> tuple[str, ...]:
    """The hands that can hold a device that moves so."""
    return (*(name for name, one in OPERATORS.items() if one.motion in ("", motion)), RECORD, WITNESS)


def _in_their_words(message: str, typed: Mapping[str, object], read: Mapping[str, float]) -> str:
    """A message with the number as it was typed, 449 deg, in the place of 7.83653."""
    for name, value in read.items():
        if message.startswith(f"{name} "):
            return message.replace(f"got {value:g}", f"got {plain(str(typed[name]), 60)}")
    return message


def _record(table: Table) -> Operator:
    table.check_keys(("type", "file", "column"), f"the hand {RECORD}")
    if "file" not in table.values:
        raise InputError(f"{table.label}: a {RECORD} needs the file of its forces: --{OPERATOR}.file")
    return RecordedForce.from_file(table.text("file"), table.values.get("column"))  # type: ignore[arg-type]


def _witness(table: Table) -> Operator:
    from zwidth.passivity.certificate import read_document
    from zwidth.passivity.witness.motion import saved_motion

    table.check_keys(("type", "file", "rounds"), f"the hand {WITNESS}")
    if "file" not in table.values:
        raise InputError(
            f"{table.label}: a {WITNESS} needs the file that zwidth check or limit saved: --{OPERATOR}.file"
        )
    name = table.text("file")
    motion = saved_motion(read_document(name), name)
    rounds = 100
    if "rounds" in table.values:
        rounds = _whole(table, "rounds", Quantity("rounds", "N", "1", "1", "rounds of a cycle"))
    return WitnessMotion(motion, rounds=min(rounds, motion.rounds))


def _options(table: Table, motion: str) -> dict[str, Any]:
    options: dict[str, Any] = {}
    for key in table.values:
        if key in ("points_per_sample", "seed"):
            options[key] = _whole(table, key, KEYS[key])
        elif key != "amplifier":
            options[key] = _number(table, key, KEYS[key], motion)
    amplifier = _amplifier(table, options.pop("amplifier_time_constant", None))
    if amplifier is not None:
        options["amplifier"] = amplifier
    clock = {key: options.pop(key) for key in ("lateness", "missed", "seed") if key in options}
    if set(clock) == {"seed"}:
        raise InputError(f"{table.where('seed')}: seed goes with lateness or missed, and neither is given")
    if clock:
        from zwidth.loop.timing import Timing

        options["timing"] = Timing(**clock)
    return options


def _amplifier(table: Table, time_constant: float | None) -> Amplifier | None:
    kind = table.text("amplifier") if "amplifier" in table.values else None
    if kind not in (None, *AMPLIFIERS):
        hint = suggestion(kind, AMPLIFIERS)
        raise InputError(f"{table.where('amplifier')}: there is no amplifier {quoted(kind)}; {hint}")
    if (kind == "lag") != (time_constant is not None):
        raise InputError(
            f"{table.label}: amplifier lag and amplifier_time_constant belong together: give both or neither"
        )
    if kind == "lag":
        assert time_constant is not None
        return amplifiers.FirstOrderLag(time_constant)
    plain: dict[str, Callable[[], Amplifier]] = {
        "ideal": amplifiers.Ideal,
        "voltage-limited": amplifiers.VoltageLimited,
        "current": amplifiers.CurrentAmplifier,
    }
    return None if kind is None else plain[kind]()


def _number(table: Table, key: str, quantity: Quantity, motion: str) -> float:
    with located(table.where(key)):
        return float(parse_number(table.values[key], quantity.unit_for(motion), key))


def _whole(table: Table, key: str, quantity: Quantity) -> int:
    value = _number(table, key, quantity, "linear")
    if value != int(value):
        raise InputError(f"{table.where(key)}: {key} is a whole number, got {value:g}")
    return int(value)
