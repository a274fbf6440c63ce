"""From the commanded force to the force at the handle: converter, limit, amplifier.

Each amplifier gives four numbers, 0 where it does not act: the converter's step
ΔF, the largest force F_max, the fastest change of the force, and a time constant.

    Ideal               f_a = f
    CurrentAmplifier    f_a = ΔF round(f/ΔF), |f_a| ≤ F_max: what is known of the device
    VoltageLimited      the same, and |df_a/dt| ≤ (F_max/I_max) U/L
    FirstOrderLag       the same, and τ df_a/dt = f − f_a

The voltage limit is that of Abbott & Okamura 2005, section IV-B: a current amplifier
drives the winding with its full voltage until the current is there.
"""

from __future__ import annotations

from abc import ABC, abstractmethod
from dataclasses import dataclass
from fractions import Fraction
from typing import NamedTuple

from zwidth.errors import InputError
from zwidth.model.device.device import Device
from zwidth.quantity.exact import Exact, ends
from zwidth.quantity.parameter import Certain, Given, Parametric, exact, read_number
from zwidth.quantity.text import shown


class Actuation(NamedTuple):
    """What stands between command and force; 0 where there is no such limit.

    Parameters
    ----------
    step
        ΔF of the converter [N; N·m].
    limit
        F_max [N; N·m].
    slew
        Largest |df_a/dt| [N/s; N·m/s].
    lag
        Time constant τ [s].
    """

    step: float = 0.0
    limit: float = 0.0
    slew: float = 0.0
    lag: float = 0.0


@dataclass(frozen=True)
class Amplifier(ABC):
    """What makes a force of a command."""

    @abstractmethod
    def actuation(self, device: Device) -> Actuation:
        """Its numbers on a device."""

    @abstractmethod
    def describe(self) -> str:
        """In words."""


@dataclass(frozen=True)
class Ideal(Amplifier):
    """Gives every force at once, as the criteria assume: ``f_a = f``."""

    def actuation(self, device: Device) -> Actuation:
        return Actuation()

    def describe(self) -> str:
        return "ideal: any force, at once"


@dataclass(frozen=True)
class CurrentAmplifier(Amplifier):
    """Gives the converter's steps up to the force limit, at once; either only where known."""

    def actuation(self, device: Device) -> Actuation:
        return Actuation(step=_known(device, "force_resolution"), limit=_known(device, "force_limit"))

    def describe(self) -> str:
        return "gives its current at once; converter steps and force limit where known"


@dataclass(frozen=True)
class VoltageLimited(Amplifier):
    """A current amplifier whose voltage drives the winding: ``|df_a/dt| ≤ (F_max/I_max) U/L``."""

    def actuation(self, device: Device) -> Actuation:
        needed = ("force_limit", "current_limit", "supply_voltage", "motor_inductance")
        missing = [key for key in needed if getattr(device, key) is None]
        if missing:
            raise InputError(
                f"a voltage-limited amplifier needs {', '.join(missing)} of the device: the current rises "
                "at U/L and the force per ampere is F_max/I_max"
            )
        force, current, voltage, inductance = (float(device.exact(key)) for key in needed)
        return Actuation(
            step=_known(device, "force_resolution"), limit=force, slew=force / current * voltage / inductance
        )

    def describe(self) -> str:
        return "voltage-limited current amplifier"


@dataclass(frozen=True)
class FirstOrderLag(Parametric, Amplifier):
    """A force that follows its command with a time constant: ``τ df_a/dt = f − f_a``.

    Parameters
    ----------
    time_constant
        τ > 0 [s].
    """

    time_constant: Certain = exact("time_constant", bound="> 0", why="for none take Ideal()")

    def actuation(self, device: Device) -> Actuation:
        return CurrentAmplifier().actuation(device)._replace(lag=float(self.time_constant))

    def describe(self) -> str:
        return f"first-order lag of {shown(float(self.time_constant), 's', 6)}"


def _known(device: Device, key: str) -> float:
    return 0.0 if getattr(device, key) is None else float(device.exact(key))


# Is the actuator close to the ideal force source that the criteria assume?
#
# Two checks (Abbott & Okamura 2005, section IV-B).  The D/A converter's step ΔF should be fine beside the
# force of one encoder count, K Δ: else the converter quantizes more than the encoder.  The current should
# rise in a small part of a sample: in the worst case it goes from 0 to I_max against the inductance of the
# winding, at the rate U/L, and takes I_max L/U.

FINE = Fraction(10)
"""K Δ/ΔF that counts as fine: the order of magnitude that the paper is content with."""

QUICK = Fraction(1, 5)
"""Rise time over T that counts as quick: the paper accepts 0.15 as its worst case."""


@dataclass(frozen=True, kw_only=True)
class ActuatorCheck:
    """One assumption about the actuator, compared with its numbers.

    `value` and `reference` are in `unit`, `ratio` is value/reference; all None
    where a number is unknown, and then `ok` is None too.
    """

    name: str
    value: Exact | None
    unit: str
    reference: Exact | None
    ratio: Exact | None
    ok: bool | None
    text: str


def actuator_checks(device: Device, stiffness: Given | None = None) -> tuple[ActuatorCheck, ...]:
    """Compare the converter with the encoder, and the current's rise with T.

    Parameters
    ----------
    device
        Where a number is an interval, its worst end is taken.
    stiffness
        K of the wall [N/m; N·m/rad]; None where the law has none.
    """
    return _force_resolution(device, stiffness), current_rise(device)


def _force_resolution(device: Device, stiffness: Given | None) -> ActuatorCheck:
    name, unit = "force resolution", device.unit("force_resolution")
    slope = Fraction(0)
    if stiffness is not None:
        slope = ends(read_number(stiffness, "stiffness", "stiffness", uncertain=True, motion=device.motion))[
            0
        ]
    count = slope * ends(device.resolution)[0]
    missing = [] if slope > 0 else ["a stiffness"]
    if count == 0 and slope > 0:
        if "resolution" not in device.assumed:
            return _unknown(name, unit, "an ideal encoder has no count to compare the converter's step with")
        missing.append("the encoder's resolution")
    if device.force_resolution is None:
        missing.append("the converter's step (force_resolution)")
    if missing:
        return _unknown(name, unit, f"not known, for want of {', '.join(missing)}")
    assert device.force_resolution is not None
    step = ends(device.force_resolution)[1]
    ratio = count / step
    text = (
        f"one encoder count is {shown(float(count), unit, 3)} of force, the converter's step "
        f"{shown(float(step), unit, 3)}: {float(ratio):.3g} to 1"
    )
    verdict = "fine" if ratio >= FINE else "not ten times finer, so the converter quantizes too"
    return _check(name, unit, count, step, ratio >= FINE, f"{text}, {verdict}")


def current_rise(device: Device) -> ActuatorCheck:
    """Compare the time that the current takes to rise with T."""
    parts = {k: getattr(device, k) for k in ("motor_inductance", "supply_voltage", "current_limit")}
    missing = [key for key, value in parts.items() if value is None]
    if missing:
        return _unknown("current rise time", "s", f"not known, for want of {', '.join(missing)}")
    inductance, current = ends(parts["motor_inductance"])[1], ends(parts["current_limit"])[1]
    rise = inductance * current / ends(parts["supply_voltage"])[0]
    period = ends(device.sample_period)[0]
    text = (
        f"from 0 to {shown(current, 'A', 6)} the current takes {shown(rise, 's', 3)}, "
        f"{shown(rise / period, '%', 3)} of a sample"
    )
    quick = rise <= QUICK * period
    verdict = "quick" if quick else "too slow for a force that is taken as instant: give it as delay"
    return _check("current rise time", "s", rise, period, quick, f"{text}, {verdict}")


def _check(name: str, unit: str, value: Fraction, reference: Fraction, ok: bool, text: str) -> ActuatorCheck:
    return ActuatorCheck(
        name=name,
        value=Exact(value),
        unit=unit,
        reference=Exact(reference),
        ratio=Exact(value / reference),
        ok=ok,
        text=text,
    )


def _unknown(name: str, unit: str, text: str) -> ActuatorCheck:
    return ActuatorCheck(name=name, value=None, unit=unit, reference=None, ratio=None, ok=None, text=text)
