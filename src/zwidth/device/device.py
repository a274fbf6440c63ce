"""The device: what the hand holds.

Model (Abbott & Okamura 2005, section II), x > 0 inside the wall:

    m ẍ = f_h − f_a − f_f,    f_f = f_c sgn ẋ + b ẋ   (when moving)

The position is read every sample period T by an encoder of resolution Δ; the
force computed from the sample at kT is applied at kT + delay and held until
the next one arrives.
"""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass, fields
from fractions import Fraction
from typing import Any, Literal

from zwidth.errors import InputError
from zwidth.quantity.exact import Exact, Interval, RealLike, as_parameter, ends
from zwidth.quantity.glossary import GLOSSARY
from zwidth.quantity.text import quantity_unit
from zwidth.quantity.units import parse
from zwidth.showing import Html, Table

Parameter = RealLike | Interval | tuple[RealLike, RealLike]
Motion = Literal["linear", "rotary"]


@dataclass(frozen=True, init=False, eq=True)
class Device:
    """A haptic device as its sampled loop sees it.

    ``m ẍ = f_h − f_a − f_c sgn ẋ − b ẋ``, sampled every T through an encoder of
    resolution Δ.  Every number may be an `Interval` (or a pair of ends); a
    verdict then holds for every value in it.  A text may carry a unit, "1 kHz".

    Parameters
    ----------
    mass
        Inertia at the handle, > 0 [kg; kg·m² if rotary]; None where unknown. No
        criterion depends on it: only a simulated motion needs it.
    damping
        Viscous friction b of the device itself, ≥ 0 [N·s/m; N·m·s/rad].
    coulomb_friction
        Coulomb friction f_c, ≥ 0 [N; N·m]. Not given: taken as 0, see `assumed`.
    stiction
        Largest friction at rest, ≥ f_c [N; N·m]; None: f_c. Only a simulated motion needs
        it: a hand that proves or refutes passivity overcomes it by an impulse.
    friction_speed
        Speed up to which b and f_c were seen to be no more than friction is, > 0 [m/s; rad/s]; every claim
        names it. None: they hold at every speed.
    resolution
        Encoder resolution Δ at the handle, ≥ 0, 0 for an ideal sensor [m; rad].
        Not given: taken as 0, see `assumed`.
    sample_period, rate
        T [s] or 1/T [Hz], > 0; exactly one of the two.
    delay
        Time from the sample to its force, any real number ≥ 0 [s]. Not given:
        taken as 0, see `assumed`.
    force_limit
        Largest actuator force, > 0 [N; N·m]; None where unknown.
    force_resolution
        Step of the D/A converter, > 0 [N; N·m]; None where unknown.
    motor_inductance, supply_voltage, current_limit
        Of motor and amplifier, > 0 [H, V, A]; None where unknown.
    motion
        "linear" (metres, newtons) or "rotary" (radians, newton metres).
    name
        For reports.

    Raises
    ------
    InputError
        If a number is missing, not finite, or outside its bound.
    """

    mass: Exact | Interval | None
    damping: Exact | Interval
    coulomb_friction: Exact | Interval
    stiction: Exact | Interval | None
    friction_speed: Exact | Interval | None
    resolution: Exact | Interval
    sample_period: Exact | Interval
    delay: Exact | Interval
    force_limit: Exact | Interval | None
    force_resolution: Exact | Interval | None
    motor_inductance: Exact | Interval | None
    supply_voltage: Exact | Interval | None
    current_limit: Exact | Interval | None
    motion: Motion
    name: str

    def __init__(
        self,
        *,
        mass: Parameter | None = None,
        damping: Parameter,
        coulomb_friction: Parameter | None = None,
        stiction: Parameter | None = None,
        friction_speed: Parameter | None = None,
        resolution: Parameter | None = None,
        sample_period: Parameter | None = None,
        rate: Parameter | None = None,
        delay: Parameter | None = None,
        force_limit: Parameter | None = None,
        force_resolution: Parameter | None = None,
        motor_inductance: Parameter | None = None,
        supply_voltage: Parameter | None = None,
        current_limit: Parameter | None = None,
        motion: Motion = "linear",
        name: str = "device",
    ) -> None:
        if motion not in ("linear", "rotary"):
            raise InputError(f'motion is "linear" or "rotary", got {motion!r}')
        period = _period(sample_period, rate)
        given: dict[str, Parameter | None] = {
            "mass": mass,
            "damping": damping,
            "coulomb_friction": coulomb_friction,
            "stiction": stiction,
            "friction_speed": friction_speed,
            "resolution": resolution,
            "sample_period": period,
            "delay": delay,
            "force_limit": force_limit,
            "force_resolution": force_resolution,
            "motor_inductance": motor_inductance,
            "supply_voltage": supply_voltage,
            "current_limit": current_limit,
        }
        assumed = tuple(key for key in _ZERO_IF_UNKNOWN if given[key] is None)
        given.update(dict.fromkeys(assumed, 0))
        for key, value in given.items():
            object.__setattr__(self, key, _validated(key, value, motion))
        _check_stiction(self)
        object.__setattr__(self, "_assumed", assumed)
        object.__setattr__(self, "motion", motion)
        object.__setattr__(self, "name", str(name))

    @property
    def assumed(self) -> tuple[str, ...]:
        """The parameters that were not given and are therefore taken as 0.

        Some of "coulomb_friction", "resolution", "delay". An ideal encoder and
        an instant computation are favourable assumptions: a claim must name
        them. Devices compare equal whether a 0 was given or assumed.
        """
        return tuple(self.__dict__["_assumed"])

    @property
    def rate(self) -> Exact | Interval:
        """Samples per second, 1/T [Hz]."""
        return _reciprocal(self.sample_period)

    @property
    def is_certain(self) -> bool:
        """True when no parameter is an interval."""
        return not any(isinstance(getattr(self, f.name), Interval) for f in fields(self))

    def replace(self, **changes: Any) -> Device:
        """The same device with some arguments changed (`rate` counts as one)."""
        given = {f.name: getattr(self, f.name) for f in fields(self) if f.name not in self.assumed}
        if "rate" in changes and "sample_period" not in changes:
            del given["sample_period"]
        return Device(**{**given, **changes})

    def exact(self, key: str) -> Fraction:
        """The rational value of a certain parameter.

        Raises
        ------
        InputError
            If the parameter is an interval or unknown.
        """
        value = getattr(self, key)
        if not isinstance(value, Exact):
            given = "it is unknown" if value is None else f"it is the interval {value}"
            raise InputError(f"{key} has no single value, {given}; give one, of an interval each end in turn")
        return value.fraction

    def parameters(self) -> Mapping[str, Exact | Interval]:
        """The known parameters by name, SI."""
        known = {f.name: getattr(self, f.name) for f in fields(self)}
        return {k: v for k, v in known.items() if isinstance(v, (Exact, Interval))}

    def __repr__(self) -> str:
        inside = ", ".join(f"{k}={_shown(v)}" for k, v in self.parameters().items())
        extra = f", motion={self.motion!r}" if self.motion != "linear" else ""
        return f"Device({inside}{extra}, name={self.name!r})"

    def _repr_html_(self) -> Html:
        known = self.parameters().items()
        rows = [(GLOSSARY[k].symbol, k, _shown(v), quantity_unit(k, self.motion)) for k, v in known]
        return Table(caption=self.name, rows=rows).html


def _shown(value: Exact | Interval) -> str:
    return str(value) if isinstance(value, Interval) else f"{float(value):.12g}"


def _reciprocal(value: Exact | Interval) -> Exact | Interval:
    low, high = ends(value)
    return Exact(1 / low) if low == high else Interval(1 / high, 1 / low)


def _period(sample_period: Parameter | None, rate: Parameter | None) -> Parameter:
    if (sample_period is None) == (rate is None):
        given = "neither" if rate is None else "both"
        raise InputError(
            f"give either sample_period [s] or rate [Hz], got {given}; the hold's energy leak "
            'grows with T, so no verdict exists without it: for example rate = "1 kHz"'
        )
    if sample_period is not None:
        return sample_period
    assert rate is not None
    parameter = _read(rate, "Hz", "rate")
    if ends(parameter)[0] <= 0:
        raise InputError(f"rate must be > 0 Hz, got {parameter}; a loop that never samples renders nothing")
    return _reciprocal(parameter)


def _check_stiction(device: Device) -> None:
    if device.stiction is not None and ends(device.stiction)[0] < ends(device.coulomb_friction)[0]:
        raise InputError(
            f"stiction must be ≥ coulomb_friction, got {device.stiction} below {device.coulomb_friction}: "
            "friction at rest is at least that of sliding; leave it out if both are the same"
        )


_ZERO_IF_UNKNOWN = ("coulomb_friction", "resolution", "delay")

_WHY = {
    "mass": (True, "a device has inertia; the criteria do not depend on it, the motions do"),
    "damping": (False, "negative friction would itself generate energy"),
    "coulomb_friction": (False, "negative friction would itself generate energy"),
    "stiction": (False, "it is the friction that holds the device at rest; leave it out if unknown"),
    "friction_speed": (
        True,
        "it is the largest speed at which friction was seen; leave it out otherwise",
    ),
    "resolution": (False, "it is the size of one encoder count; use 0 for an ideal sensor"),
    "sample_period": (True, "the force is held for T; a continuous loop has no hold to certify"),
    "delay": (False, "a force cannot be applied before its sample is taken"),
    "force_limit": (True, "it is the largest magnitude the actuator gives; leave it out if unknown"),
    "force_resolution": (True, "it is one step of the converter; leave it out if unknown"),
    "motor_inductance": (True, "leave it out if unknown"),
    "supply_voltage": (True, "leave it out if unknown"),
    "current_limit": (True, "leave it out if unknown"),
}


def _validated(key: str, value: Parameter | None, motion: str) -> Exact | Interval | None:
    strict, why = _WHY[key]
    unit = GLOSSARY[key].unit_for(motion)
    if value is None:
        if key == "damping":
            raise InputError(f"{key} [{unit}] is needed and was not given")
        return None
    parameter = _read(value, unit, key)
    low = ends(parameter)[0]
    if low < 0 or (strict and low == 0):
        bound = ">" if strict else "≥"
        raise InputError(f"{key} must be {bound} 0 {unit}, got {parameter}: {why}")
    return parameter


def _read(value: Parameter, unit: str, key: str) -> Exact | Interval:
    """A number in SI, or a text with its unit, such as "22.4 um" or "0.1 .. 0.2 N"."""
    if isinstance(value, (str, tuple, list)):
        return parse(value, unit, key)
    try:
        return as_parameter(value)
    except InputError as error:
        raise InputError(f"{key} [{unit}]: {error}") from None
