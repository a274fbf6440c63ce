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
from typing import NamedTuple

from zwidth.errors import InputError
from zwidth.model.device.device import Device
from zwidth.quantity.exact import Exact
from zwidth.quantity.parameter import Certain, Parametric, parameter


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
        return "current amplifier: converter steps and force limit where known, at once"


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

    time_constant: Certain = parameter("time_constant", kept=Exact, bound="> 0", why="for none take Ideal()")

    def actuation(self, device: Device) -> Actuation:
        return CurrentAmplifier().actuation(device)._replace(lag=float(self.time_constant))

    def describe(self) -> str:
        return f"first-order lag of {float(self.time_constant):.6g} s"


def _known(device: Device, key: str) -> float:
    return 0.0 if getattr(device, key) is None else float(device.exact(key))
