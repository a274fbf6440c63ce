"""The device: what the hand holds.

Model (Abbott & Okamura 2005, section II), x > 0 inside the wall:

    m ẍ = f_h − f_a − f_f,    f_f = f_c sgn ẋ + b ẋ   (when moving)

The position is read every sample period T by an encoder of resolution Δ; the force computed from the sample
at kT is applied at kT + delay and held until the next one arrives.
"""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass, fields
from fractions import Fraction
from typing import Any, Literal

from zwidth.errors import InputError
from zwidth.model.device.transmission import Transmission
from zwidth.quantity.exact import Exact, Interval, ends, middle
from zwidth.quantity.glossary import GLOSSARY
from zwidth.quantity.parameter import (
    Given,
    Parametric,
    Reads,
    Uncertain,
    UncertainOrNone,
    parameter,
    parameters_of,
    read_number,
)
from zwidth.quantity.text import in_words, shown
from zwidth.showing import Html, Table, one_line

Motion = Literal["linear", "rotary"]

_ZERO_IF_UNKNOWN = ("coulomb_friction", "resolution", "delay")
_OF_A_BODY = ("mass", "damping", "coulomb_friction", "stiction")
_DIGITS = 6
"""Of a number in a notebook."""
_ZeroIfUnknown = Reads[Exact | Any, Given | None]


@dataclass(frozen=True, init=False)
class Device(Parametric):
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
        Time from the sample to its force, any real number ≥ 0 [s]. Not given: taken as 0, see `assumed`.
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
    transmission
        What gives way between motor and hand, a `Transmission`; mass, damping, friction and stiction are then
        those on the motor's side. None: motor, encoder and hand move as one.
    """

    mass: UncertainOrNone = parameter(
        "mass",
        None,
        bound="> 0",
        why="a device has inertia; the criteria do not depend on it, the motions do",
    )
    damping: Uncertain = parameter(
        "damping", bound="≥ 0", why="negative friction would itself generate energy"
    )
    coulomb_friction: _ZeroIfUnknown = parameter(
        "coulomb_friction", None, bound="≥ 0", why="negative friction would itself generate energy"
    )
    stiction: UncertainOrNone = parameter(
        "stiction",
        None,
        bound="≥ 0",
        why="it is the friction that holds the device at rest; leave it out if unknown",
    )
    friction_speed: UncertainOrNone = parameter(
        "friction_speed",
        None,
        bound="> 0",
        why="it is the largest speed at which friction was seen; leave it out otherwise",
    )
    resolution: _ZeroIfUnknown = parameter(
        "resolution", None, bound="≥ 0", why="it is the size of one encoder count; use 0 for an ideal sensor"
    )
    sample_period: _ZeroIfUnknown = parameter(
        "sample_period",
        None,
        bound="> 0",
        why="the force is held for T; a continuous loop has no hold to certify",
    )
    delay: _ZeroIfUnknown = parameter(
        "delay", None, bound="≥ 0", why="a force cannot be applied before its sample is taken"
    )
    force_limit: UncertainOrNone = parameter(
        "force_limit",
        None,
        bound="> 0",
        why="it is the largest magnitude the actuator gives; leave it out if unknown",
    )
    force_resolution: UncertainOrNone = parameter(
        "force_resolution", None, bound="> 0", why="it is one step of the converter; leave it out if unknown"
    )
    motor_inductance: UncertainOrNone = parameter(
        "motor_inductance", None, bound="> 0", why="leave it out if unknown"
    )
    supply_voltage: UncertainOrNone = parameter(
        "supply_voltage", None, bound="> 0", why="leave it out if unknown"
    )
    current_limit: UncertainOrNone = parameter(
        "current_limit", None, bound="> 0", why="leave it out if unknown"
    )
    motion: Motion = "linear"
    name: str = "device"
    transmission: Transmission | None = None

    def __init__(
        self,
        *,
        mass: Given | None = None,
        damping: Given,
        coulomb_friction: Given | None = None,
        stiction: Given | None = None,
        friction_speed: Given | None = None,
        resolution: Given | None = None,
        sample_period: Given | None = None,
        rate: Given | None = None,
        delay: Given | None = None,
        force_limit: Given | None = None,
        force_resolution: Given | None = None,
        motor_inductance: Given | None = None,
        supply_voltage: Given | None = None,
        current_limit: Given | None = None,
        motion: Motion = "linear",
        name: str = "device",
        transmission: Transmission | None = None,
    ) -> None:
        if motion not in ("linear", "rotary"):
            raise InputError(f'motion is "linear" or "rotary", got {motion!r}')
        if not (transmission is None or isinstance(transmission, Transmission)):
            raise InputError(f"transmission is a zwidth.Transmission, got {type(transmission).__name__}")
        if transmission is not None:
            transmission.require(motion, str(name))
        everything = locals()
        given: dict[str, Given | None] = {key: everything[key] for key in parameters_of(Device)}
        given["sample_period"] = _period(sample_period, rate)
        assumed = tuple(key for key in _ZERO_IF_UNKNOWN if given[key] is None)
        given.update(dict.fromkeys(assumed, 0))
        read = {key: _read(key, value, motion) for key, value in given.items()}
        label = one_line(str(name))
        self._keep(**read, _assumed=assumed, motion=motion, name=label, transmission=transmission)
        _check_stiction(self)

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
        known = self.transmission is None or self.transmission.is_certain
        return known and not any(isinstance(getattr(self, f.name), Interval) for f in fields(self))

    @property
    def motor_side(self) -> Device:
        """The same device without its transmission: what the actuator moves at once."""
        return self if self.transmission is None else self.replace(transmission=None)

    def replace(self, **changes: Any) -> Device:
        """The same device with some arguments changed (`rate` counts as one)."""
        if "rate" in changes and "sample_period" not in changes:
            changes["sample_period"] = _period(None, changes.pop("rate"))
        if changes.keys() <= parameters_of(Device).keys() and None not in changes.values():
            read = {key: _read(key, value, self.motion) for key, value in changes.items()}
            assumed = tuple(key for key in self.assumed if key not in changes)
            device: Device = self._changed(**read, _assumed=assumed)
            _check_stiction(device)
            return device
        given = {f.name: getattr(self, f.name) for f in fields(self) if f.name not in self.assumed}
        return Device(**{**given, **changes})

    def exact(self, key: str) -> Fraction:
        """The rational value of a certain parameter.

        Raises
        ------
        InputError
            If the parameter is an interval or unknown; or if it is that of one of two bodies, and it was not
            asked of `motor_side`.
        """
        if (
            self.transmission is not None and key in _OF_A_BODY
        ):  # whoever asks for one number, and does not say of which, counts one body
            require_rigid(self, f"what asks for one {in_words(key)}")
        value = getattr(self, key)
        if not isinstance(value, Exact):
            given = "it is unknown" if value is None else f"it is the interval {shown(value, self.unit(key))}"
            raise InputError(f"{key} has no single value, {given}; give one, of an interval each end in turn")
        return value.fraction

    def parameters(self) -> Mapping[str, Exact | Interval]:
        """The known parameters by name, SI."""
        known = {f.name: getattr(self, f.name) for f in fields(self)}
        return {k: v for k, v in known.items() if isinstance(v, (Exact, Interval))}

    def unit(self, quantity: str) -> str:
        """The SI unit that a quantity of the glossary has here: of "force" "N", of a rotary device "N*m"."""
        return GLOSSARY[quantity].unit_for(self.motion)

    def key(self, quantity: str) -> str:
        """The key of a quantity in a file, unit included: "force_N", of a rotary device "force_N_m"."""
        return GLOSSARY[quantity].key_for(self.motion)

    def __repr__(self) -> str:
        inside = ", ".join(f"{k}={_shown(v)}" for k, v in self.parameters().items())
        extra = f", motion={self.motion!r}" if self.motion != "linear" else ""
        extra += f", transmission={self.transmission!r}" if self.transmission is not None else ""
        return f"Device({inside}{extra}, name={self.name!r})"

    def _repr_html_(self) -> Html:
        known = self.parameters().items()
        names = {k: in_words(k, self.motion) for k, _ in known}
        rows = [(GLOSSARY[k].symbol, names[k], shown(v, self.unit(k), _DIGITS)) for k, v in known]
        if self.transmission is not None:
            for k, v in self.transmission.parameters().items():
                own = parameters_of(Transmission)[k]
                told = shown(v, own.unit_for(self.motion), _DIGITS)
                rows.append((own.quantity.symbol, f"transmission: {in_words(k)}", told))
            rows.append(("", "encoder at the", self.transmission.encoder))
        return Table(caption=self.name, rows=rows).html


def in_one(device: Device) -> Device:
    """Of each number the middle, and of both sides of a transmission the sum: what a hand moves."""
    own = {name: middle(value) for name, value in device.parameters().items() if isinstance(value, Interval)}
    behind = {} if device.transmission is None else device.transmission.parameters()
    for name in _OF_A_BODY:
        if f"handle_{name}" in behind and (motor := middle(getattr(device, name))) is not None:
            own[name] = motor + (middle(behind[f"handle_{name}"]) or 0.0)
    return device.motor_side.replace(**own)


def require_rigid(device: Device, what: str) -> None:
    """Refuse a device with a transmission; `what` counts motor, encoder and hand as one.

    Raises
    ------
    InputError
        If the device has one: what to give in its place.
    """
    if device.transmission is not None:
        raise InputError(
            f"{what} counts motor, encoder and hand as one, and {device.name} has a transmission between "
            "them, which zwidth check decides. To ask of the motor alone leave out [device.transmission] and "
            "--transmission, in Python take device.motor_side"
        )


def _shown(value: Exact | Interval) -> str:
    return str(value) if isinstance(value, Interval) else f"{float(value):.12g}"


def _reciprocal(value: Exact | Interval) -> Exact | Interval:
    low, high = ends(value)
    return Exact(1 / low) if low == high else Interval(1 / high, 1 / low)


def _period(sample_period: Given | None, rate: Given | None) -> Given:
    if (sample_period is None) == (rate is None):
        given = "neither" if rate is None else "both"
        raise InputError(
            f"give either sample_period [s] or rate [Hz], got {given}; the hold's energy leak "
            'grows with T, so no verdict exists without it: for example rate = "1 kHz"'
        )
    if sample_period is not None:
        return sample_period
    assert rate is not None
    why = "a loop that never samples renders nothing"
    return _reciprocal(read_number(rate, GLOSSARY["rate"], "rate", uncertain=True, bound="> 0", why=why))


def _check_stiction(device: Device) -> None:
    if device.stiction is not None and ends(device.stiction)[0] < ends(device.coulomb_friction)[0]:
        raise InputError(
            f"stiction must be ≥ coulomb_friction, got {device.stiction} below {device.coulomb_friction}: "
            "friction at rest is at least that of sliding; leave it out if both are the same"
        )


def _read(key: str, value: Given | None, motion: str) -> Exact | Interval | None:
    """A number in SI, or a text with a unit of this motion, such as "22.4 um" or "0.1 .. 0.2 N"."""
    own = parameters_of(Device)[key]
    if value is None:
        if own.required:
            raise InputError(
                f"{key} [{own.unit_for(motion)}] is needed and was not given: measure it, or give a guess "
                f'and see what would follow, for example {key} = "0.1 {own.unit_for(motion)}"'
            )
        return None
    number: Exact | Interval = read_number(
        value, own.quantity, key, uncertain=True, bound=own.bound, why=own.why, motion=motion
    )
    return number
