"""The one number to change, of a loop or a pair: four fifths of the largest value that is proved passive.

The loop is what was found in the recording: the stated device, the identified law, the delay that is seen.
Every value that is given was itself decided, all else as it was.  A damper inside the drive, B_d v(t −
τ_d), takes at the worst frequency −B_d whatever τ_d is, so that loop is decided with B_d less damping in
the device.
"""

from __future__ import annotations

from collections.abc import Callable, Mapping
from dataclasses import dataclass
from math import floor, log10
from typing import Any, Protocol

from zwidth.data.diagnosis.evidence import Evidence
from zwidth.errors import InputError
from zwidth.model.device import Device
from zwidth.model.environment import BackwardDifference, Wall, Window
from zwidth.model.environment.environment import Environment
from zwidth.model.rendering.rendered import laws_of
from zwidth.passivity.check import check, check_by_closed_forms
from zwidth.passivity.covering_wall import covering
from zwidth.passivity.verdict import Verdict
from zwidth.quantity.answered import answered, answers, data_of
from zwidth.quantity.exact import ends
from zwidth.quantity.text import shown

# One number that is lowered until the verdict is passive, with a margin: of a loop as of a pair.

PASSIVE = ("passive", "passive in contact")
"""Outcomes that a change may have."""

_HALVINGS = 14
_MARGIN = 0.8
"""Of the largest value that is passive: at that itself a motion that is there need not die out."""

_DIGITS = 3


class Judged(Protocol):
    """A verdict of any kind of loop."""

    @property
    def outcome(self) -> str:
        """As of `check`."""


@dataclass(frozen=True, kw_only=True)
class Lowered:
    """One number, from where it is to where it may be."""

    parameter: str = answered('its key, such as "stiffness"')
    current: float = answered("where it is, in `unit`", key="from")
    to: float = answered("where it may be")
    unit: str = answered("SI")
    text: str = answered("what to do, in words")
    verdict: Judged
    """What `check` says to what has the number changed."""

    @property
    @answers("of `zwidth check` with it")
    def outcome(self) -> str:
        """Of the verdict."""
        return self.verdict.outcome

    def to_dict(self) -> dict[str, Any]:
        """As plain data."""
        return data_of(self)


def lowered_to(name: str, current: float, to: float, unit: str) -> str:
    return f"lower the {name} from {shown(current, unit, 3)} to {shown(to, unit, 3)}"


def largest(decided: Callable[[float], Judged | None], current: float) -> float | None:
    """The largest value up to the current one that is passive, of a few digits; None where only 0 is, or
    none."""

    def passive(value: float) -> bool:
        verdict = decided(value)
        return verdict is not None and verdict.outcome in PASSIVE

    low, high = 0.0, current
    if not passive(0.0) and not passive(1e-3 * current):
        return None
    if passive(current):
        low = current
    for _ in range(_HALVINGS if low < high else 0):
        middle = 0.5 * (low + high)
        low, high = (middle, high) if passive(middle) else (low, middle)
    to = with_margin(low)
    return to if to > 1e-3 * current and passive(to) else None


def with_margin(limit: float) -> float:
    """Four fifths of a limit, of a few digits."""
    return rounded(_MARGIN * limit)


def rounded(value: float) -> float:
    """Down to three digits."""
    if value <= 0:
        return 0.0
    step = 10.0 ** (floor(log10(value)) - _DIGITS + 1)
    return float(f"{floor(value / step * (1 + 1e-12)) * step:.{_DIGITS}g}")


def text_of(value: float) -> str:
    return f"{value:.6g}"


@dataclass(frozen=True, kw_only=True)
class Change(Lowered):
    """One number of the loop, from where it is to where it may be."""

    device: Device = answered("of the loop with that number changed", only_shown=True)
    environment: Environment = answered("of the same", only_shown=True)
    verdict: Verdict


@dataclass(frozen=True)
class _Loop:
    """The loop in a recording: every number that a change may be of."""

    device: Device
    stiffness: float
    damping: float
    window: int
    compensation: float
    compensation_speed: float
    delay: float
    drive_damping: float
    stated: Environment | None = None

    def built(self, **changes: float) -> tuple[Device, Environment]:
        at = {**self.__dict__, **changes}
        device: Device = self.device.replace(delay=text_of(at["delay"]))
        if at["drive_damping"]:
            left = float(ends(device.damping)[0]) - at["drive_damping"]
            if left < 0:
                raise InputError("the drive's damper may drive more than the device brakes")
            device = device.replace(damping=text_of(left))
        wall = self._law(at)
        if at["compensation"]:
            from zwidth.model.rendering import FrictionCompensation, render

            wall = render(
                wall,
                FrictionCompensation(
                    coulomb=text_of(at["compensation"]), speed=text_of(at["compensation_speed"])
                ),
            )
        return device, wall

    def _law(self, at: Mapping[str, float]) -> Environment:
        """The law as stated, else as found, with the stiffness and the damping of `at`."""
        if self.stated is not None:
            names = [name for name in ("stiffness", "damping") if at[name] != getattr(self, name)]
            return self.stated.replace(**{name: text_of(at[name]) for name in names})
        if not at["damping"]:
            return Wall(text_of(at["stiffness"]))
        estimate = Window(self.window) if self.window > 1 else BackwardDifference()
        return Wall(text_of(at["stiffness"]), text_of(at["damping"]), velocity_filter=estimate)

    def decided(self, **changes: float) -> Verdict | None:
        """The verdict by closed forms; None where there is none."""
        try:
            device, law = self.built(**changes)
            if device.transmission is not None:
                return check(device, law)
            covered = covering(device, law) if laws_of(law) else (device, law)
            return None if covered is None else check_by_closed_forms(*covered)
        except InputError:  # such as a delay of more samples than a proof has room for
            return None


def change_for(cause: str, seen: Evidence, device: Device) -> Change | None:
    """The change that takes a cause away; None where no single number of the loop does, or none is proved."""
    unseen = (cause == "delay" and not seen.sees_delay) or (cause == "actuator limit" and seen.drive is None)
    rigid = cause == "structural resonance" and device.transmission is None
    if seen.law is None or cause not in _PARAMETERS or unseen or rigid:
        return None
    loop = _loop(seen, device, cause)
    for key in _PARAMETERS[cause]:
        current = getattr(loop, key)
        if current <= 0:
            continue
        top = current
        if cause == "actuator limit":
            assert seen.drive is not None
            top = min(current, seen.drive.rate / (seen.vibration.angular * seen.amplitude))
        to = largest(lambda value, key=key: loop.decided(**{key: value}), top)  # type: ignore[misc]
        if to is None:
            continue
        built = loop.built(**{key: to})
        name, unit = _NAMES[key]
        said = seen.unit(unit) if unit != "s" else "s"
        decide = check if laws_of(built[1]) or device.transmission is not None else check_by_closed_forms
        verdict = decide(*built)
        return Change(
            parameter=key,
            current=current,
            to=to,
            unit=said,
            text=lowered_to(name, current, to, said),
            device=built[0],
            environment=built[1],
            verdict=verdict,
        )
    return None


_PARAMETERS = {
    "sampling": ("stiffness", "damping"),
    "delay": ("delay", "stiffness"),
    "differenced velocity": ("damping", "stiffness"),
    "encoder buzz": ("stiffness",),
    "drive damping": ("drive_damping",),
    "friction compensation": ("compensation",),
    "actuator limit": ("stiffness",),
    "structural resonance": ("stiffness",),
}
"""What to change, the first that helps."""

_NAMES = {
    "stiffness": ("stiffness", "stiffness"),
    "damping": ("virtual damping", "virtual_damping"),
    "delay": ("delay", "s"),
    "drive_damping": ("damping inside the drive", "virtual_damping"),
    "compensation": ("compensated Coulomb friction", "coulomb_friction"),
}
"""Each in words, and whose unit it has."""


def law_of(seen: Evidence, device: Device) -> Environment:
    """Spring and damper as they were found, or stated, what compensates friction left out."""
    loop = _loop(seen, device, "")
    return loop._law(loop.__dict__)


def _loop(seen: Evidence, device: Device, cause: str) -> _Loop:
    assert seen.law is not None
    law = seen.law
    told = seen.stated if seen.stated is not None and seen.stated.holds else None
    helped = law.compensation if seen.supplied["friction compensation"] > 0.02 * abs(seen.total) else 0.0
    return _Loop(
        device=device,
        stated=None if told is None else told.environment,
        stiffness=law.stiffness if told is None else told.stiffness,
        damping=law.damping if told is None else told.damping,
        window=law.window,
        compensation=rounded(helped),
        compensation_speed=rounded(law.compensation_speed),
        delay=rounded(seen.delay) if cause == "delay" and seen.sees_delay else seen.known.delay,
        drive_damping=seen.drive.damping if cause == "drive damping" and seen.drive is not None else 0.0,
    )
