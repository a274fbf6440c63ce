"""What is published about arms whose gain files are read: `families.toml`, each value with its source."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass
from decimal import Decimal
from fractions import Fraction
from functools import cache
from typing import Any

from zwidth.errors import InputError
from zwidth.quantity.exact import Exact


@dataclass(frozen=True)
class Value:
    """A number [SI] and where it is from."""

    value: Exact
    source: str


@dataclass(frozen=True)
class Family:
    """What a gain file does not say, as published or assumed.

    Attributes
    ----------
    rate, link_delay, drive_rate, position_step
        [Hz, s, Hz, rad], each with its source.
    motors
        Of the joints in the order of the file; none where the file says it.
    plant
        The published plant that is taken where none is given; "" where none is published.
    largest_stiffness, largest_damping
        What the drive takes [N·m/rad, N·m·s/rad]; None where that is not known.
    """

    name: str
    title: str
    rate: Value
    link_delay: Value
    drive_rate: Value
    position_step: Value
    motors: tuple[str, ...]
    plant: str
    largest_stiffness: Value | None = None
    largest_damping: Value | None = None


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
    """What is published about a family."""
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
    """All published plants by name."""
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
    raise InputError(
        f"--supply-voltage must be > 0 and at most {float(found[-1].highest_voltage):g} V, what an STS3215 "
        f"is made for, got {float(voltage):g} V"
    )


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
    import tomllib  # both on first use, to keep `import zwidth` fast
    from pathlib import Path

    text = Path(__file__).with_name("families.toml").read_text(encoding="utf-8")
    return tomllib.loads(text, parse_float=Decimal)
