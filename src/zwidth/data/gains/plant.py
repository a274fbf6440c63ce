"""The arms that the gains are for: b, f_c and encoder step of each joint, which no gain file has.

From a TOML file,

    [arm]                                       or [leader] and [follower]
    damping = "0.5 N*m*s/rad"                   one for all joints, or a list
    coulomb_friction = [0.3, 0.3, 0.2]
    resolution = "0.1 mrad"

    [arm.transmission]                          of joints that give way; the above is the motors' side then,
                                                and inertia may stand there, too
    stiffness = [9000, 9000, 5000]
    handle_damping = "0.2 N*m*s/rad"            of the link

or as published for the family, and then they were measured on no arm of the reader's.
"""

from __future__ import annotations

import tomllib
from collections.abc import Mapping, Sequence
from dataclasses import dataclass
from decimal import Decimal
from fractions import Fraction
from functools import cache
from pathlib import Path
from typing import Any

from zwidth.data.gains.file import GainTable, read_table
from zwidth.data.gains.joint import JointGains
from zwidth.errors import InputError
from zwidth.missing import suggestion
from zwidth.model.device import Device
from zwidth.model.specification.table import quoted
from zwidth.model.specification.values import joint_transmissions
from zwidth.quantity.exact import Exact
from zwidth.quantity.glossary import GLOSSARY
from zwidth.quantity.text import shown
from zwidth.quantity.units import parse_number

KEYS = ("damping", "coulomb_friction", "resolution")

GivenPlant = str | Path | Device | Sequence[Device] | None


@dataclass(frozen=True)
class Plant:
    """The numbers of each joint on both sides, as arguments of `Device`, and where they are from."""

    leader: tuple[dict[str, Any], ...]
    follower: tuple[dict[str, Any], ...]
    note: str


def plant_of(joints: Sequence[JointGains], family: Family, given: GivenPlant) -> Plant:
    """What was given, a file, a published name, a device for all joints or for each; else the family's."""
    if isinstance(given, Device):
        given = [given] * len(joints)
    if given is not None and not isinstance(given, (str, Path)):
        return _of_devices(joints, given)
    known = plants()
    if given is None:
        if not family.plant:
            raise InputError(
                f"no source gives damping and friction of the joints of {family.title}: give --plant with a "
                "TOML file that has [arm] damping = … and coulomb_friction = …"
            )
        given = family.plant
    if str(given) in known:
        return _published(joints, family, known[str(given)])
    if isinstance(given, str) and not Path(given).suffix:
        raise InputError(
            f"there is no published plant {quoted(given)}; {suggestion(given, known)}, or a TOML file"
        )
    return plant_of_file(len(joints), given)


def _of_devices(joints: Sequence[JointGains], devices: Sequence[Device]) -> Plant:
    if len(devices) != len(joints) or not all(isinstance(device, Device) for device in devices):
        raise InputError(f"a plant is a Device, or one for each of the {len(joints)} joints")
    if any(device.motion != "rotary" for device in devices):
        raise InputError("the joints of an arm turn: give devices with motion='rotary'")
    rows = tuple({key: device.exact(key) for key in KEYS} for device in devices)
    return Plant(rows, rows, "damping and friction as given by the devices")


def _published(joints: Sequence[JointGains], family: Family, plant: PublishedPlant) -> Plant:
    if family.name not in plant.families:
        raise InputError(
            f"the plant {plant.name} is of {', '.join(plant.families)}, the gains are of {family.name}; give "
            "a TOML file with the numbers of your arm"
        )
    rows = []
    for n, joint in enumerate(joints):
        by_place = plant.joints[n] if len(plant.joints) == len(joints) else None
        found = plant.motors.get(joint.motor, by_place)
        if found is None:
            motor = f" with a {joint.motor}" if joint.motor else ""
            raise InputError(
                f"the plant {plant.name} has no numbers for {joint.name}{motor}; give --plant with a TOML "
                "file that has [arm] damping = [...] and coulomb_friction = [...]"
            )
        rows.append({"damping": found[0], "coulomb_friction": found[1]})
    note = (
        f"damping and friction are published numbers, measured on no arm of yours: {plant.name}, "
        f"{plant.source}"
    )
    return Plant(tuple(rows), tuple(rows), note)


def plant_of_file(joints: int, path: str | Path) -> Plant:
    """The plant of a TOML file, for so many joints."""
    table = read_table(path)
    allowed = ("arm", "leader", "follower")
    for key in table.values:
        if key not in allowed:
            raise InputError(f"{table.label}: a plant has no {quoted(key)}; {suggestion(key, allowed)}")
    if ("arm" in table) == ("leader" in table and "follower" in table) or (
        "arm" in table and len(table.values) > 1
    ):
        raise InputError(f"{table.label}: give [arm] for both arms, or [leader] and [follower]")
    sides = ("arm", "arm") if "arm" in table else ("leader", "follower")
    leader, follower = (_rows(table.table(side), joints) for side in sides)
    return Plant(leader, follower, f"damping and friction of the joints are from {table.label}")


def _rows(table: GainTable, joints: int) -> tuple[dict[str, Any], ...]:
    known = (*KEYS, "transmission", *(("inertia",) if "transmission" in table else ()))
    for key in table.values:
        if key not in known:
            raise InputError(f"{table.label}: an arm has no {quoted(key)}; {suggestion(key, known)}")
    if "damping" not in table:
        raise InputError(f"{table.label}: damping is missing: without it nothing is passive")
    columns: dict[str, list[Any]] = {}
    for key, value in table.values.items():
        if key == "transmission":
            columns[key] = [*joint_transmissions(value, table.label, joints)]
            continue
        own = "mass" if key == "inertia" else key
        unit = GLOSSARY[own].rotary_unit
        if isinstance(value, list):
            columns[own] = table.numbers(key, unit, joints)
        else:
            columns[own] = [parse_number(value, unit, table.where(key))] * joints
    return tuple({key: column[n] for key, column in columns.items()} for n in range(joints))


@dataclass(frozen=True)
class Value:
    """A number [SI] and where it is from."""

    value: Exact
    source: str


@dataclass(frozen=True)
class Family:
    """What a gain file does not say, as published or assumed."""

    name: str
    title: str
    rate: Value
    link_delay: Value
    drive_rate: Value
    position_step: Value
    """[Hz, s, Hz, rad]"""
    motors: tuple[str, ...]
    """Of the joints in the order of the file; none where the file says it."""
    plant: str
    """The published one that is taken where none is given; "" where none is published."""
    largest_stiffness: Value | None = None
    largest_damping: Value | None = None
    """What the drive takes [N·m/rad, N·m·s/rad]; None where that is not known."""


@dataclass(frozen=True)
class PublishedPlant:
    """Damping b [N·m·s/rad] and Coulomb friction f_c [N·m] of joints, in their order or by motor."""

    name: str
    families: tuple[str, ...]
    source: str
    joints: tuple[tuple[Exact, Exact], ...]
    motors: Mapping[str, tuple[Exact, Exact]]


@dataclass(frozen=True)
class Servo:
    """A position servo whose register is P: K = c e P U k_t/R, b = k_t²/R + viscous friction."""

    name: str
    source: str
    highest_voltage: Fraction
    torque_constant: Fraction
    resistance: Fraction
    duty_per_error: Fraction
    efficiency: Fraction
    viscous: Fraction
    coulomb_friction: Fraction

    def stiffness(self, counts: Fraction, voltage: Fraction) -> Fraction:
        """K [N·m/rad]."""
        return (
            self.duty_per_error * self.efficiency * counts * voltage * self.torque_constant / self.resistance
        )

    @property
    def damping(self) -> Fraction:
        """b [N·m·s/rad], with what the motor induces in itself."""
        return self.torque_constant**2 / self.resistance + self.viscous


def family(name: str) -> Family:
    table = _data()[name]
    values = {
        key: Value(Exact(row["value"]), row["source"])
        for key, row in table.items()
        if isinstance(row, Mapping)
    }
    return Family(
        name, table["title"], **values, motors=tuple(table.get("motors", ())), plant=table.get("plant", "")
    )


def plants() -> Mapping[str, PublishedPlant]:
    return {name: _plant(name, table) for name, table in _data()["plants"].items()}


def servo(voltage: Fraction) -> Servo:
    """The servo that is sold for a supply voltage [V].

    Raises
    ------
    InputError
        If none is.
    """
    found = [_servo(name, table) for name, table in _data()["servos"].items()]
    for one in sorted(found, key=lambda one: one.highest_voltage):
        if 0 < voltage <= one.highest_voltage:
            return one
    most, given = shown(max(one.highest_voltage for one in found), "V", 6), shown(voltage, "V", 6)
    raise InputError(f"--supply-voltage must be > 0 and ≤ {most}, as an STS3215 is made for; got {given}")


def _plant(name: str, table: Mapping[str, Any]) -> PublishedPlant:
    joints = zip(table.get("damping", ()), table.get("coulomb_friction", ()), strict=True)
    return PublishedPlant(
        name,
        tuple(table["families"]),
        table["source"],
        tuple((Exact(b), Exact(f)) for b, f in joints),
        {
            motor: (Exact(row["damping"]), Exact(row["coulomb_friction"]))
            for motor, row in table.get("motors", {}).items()
        }
        or _servo_plant(name),
    )


def _servo_plant(name: str) -> Mapping[str, tuple[Exact, Exact]]:
    servos = (_servo(key, row) for key, row in _data()["servos"].items() if key.startswith(f"{name}-"))
    return {one.name: (Exact(one.damping), Exact(one.coulomb_friction)) for one in servos}


def _servo(name: str, table: Mapping[str, Any]) -> Servo:
    numbers = {key: Exact(value).fraction for key, value in table.items() if not isinstance(value, str)}
    return Servo(name, table["source"], **numbers)


@cache
def _data() -> Mapping[str, Any]:
    text = Path(__file__).with_name("families.toml").read_text(encoding="utf-8")
    return tomllib.loads(text, parse_float=Decimal)
