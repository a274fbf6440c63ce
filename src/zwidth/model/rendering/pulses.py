"""Pulses and transients when the hand enters.

A pulse that stops the device at the first sample inside the wall.

    f ← f + min(m v̂/T, F)    at the first sample with x > 0 after one with x ≤ 0

Held for T it takes the momentum m v̂ out, which the wall's spring would give back.  Braking pulses: Salcudean
& Vlaar (1997); this size, the one that stops m in one sample, is derived for this project.
"""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import KW_ONLY, dataclass
from math import cos, exp, pi, sin
from typing import Any, ClassVar, Literal

from zwidth.errors import InputError
from zwidth.model.rendering.reading import given_or_known, surface
from zwidth.model.rendering.rendering_law import LoopContext, RenderingLaw
from zwidth.model.rendering.velocity import Estimator, estimate, estimated, packed
from zwidth.native.compiled import Array, compiled
from zwidth.quantity.exact import Exact, RealLike
from zwidth.quantity.glossary import Quantity
from zwidth.quantity.parameter import CertainOrNone, Reads, exact, part, word
from zwidth.quantity.text import shown

BRAKING_PULSE = 12.0

_PER_SPEED, _LIMIT, _ESTIMATOR = range(3)
_INSIDE, _PULSE_REMEMBERED = range(2)

UNLIMITED = 1e300


@dataclass(frozen=True)
class BrakingPulse(RenderingLaw):
    """One sample of force at entry, ``f ← f + min(m v̂/T, F)``.

    Parameters
    ----------
    mass
        m > 0, what is to be stopped [kg; kg·m²]; None: the device's.
    limit
        F > 0, the largest pulse [N; N·m]; None: the device's force limit, none where unknown.
    velocity
        `AdaptiveWindow(…)` (default), `TickTime()` or `Kalman(…)`.

    Raises
    ------
    InputError
        If a number is not positive or velocity is none of these; later, if the mass is not
        known, or the environment has no surface.
    """

    code: ClassVar[float] = BRAKING_PULSE

    mass: CertainOrNone = exact(
        "mass", None, "> 0", "it is what the pulse stops", "what is to be stopped, by default the device's"
    )
    limit: CertainOrNone = exact(
        "force", None, "> 0", "it is the largest pulse", "the largest pulse, by default the force limit"
    )
    velocity: Reads[Estimator, Estimator | None] = estimated()

    @property
    def state_size(self) -> int:  # type: ignore[override]  # the estimator's among them, known once it is chosen
        """Whether the hand was inside, and those of the estimator."""
        return _PULSE_REMEMBERED + self.velocity.state_size

    def numbers(self, at: LoopContext) -> list[float]:
        """m/T, F, the estimator's."""
        surface(at, "a braking pulse")
        mass = given_or_known(self.mass, at, "mass", "mass")
        unknown = self.limit is None and at.device.force_limit is None
        limit = UNLIMITED if unknown else given_or_known(self.limit, at, "force_limit", "limit")
        return [mass / at.period, limit, *packed(self.velocity, at)]

    def initial_state(self, reading: float) -> list[float]:
        """A hand that is inside has entered long ago."""
        return [float(reading > 0.0), *self.velocity.initial_state(reading)]

    def describe(self, motion: str = "linear") -> str:
        what = self.with_unit("mass", motion) or "the device"
        most = f", at most {self.with_unit('limit', motion)}" if self.limit is not None else ""
        return f"braking pulse that stops {what}{most} on {self.velocity.describe(motion)}"


@compiled
def braking_pulse_step(p: Array, i: int, s: Array, j: int, x: float, force: float, applied: float) -> float:
    """One sample; p from i and s from j on are this law's."""
    velocity = estimate(p, i + _ESTIMATOR, s, j + _PULSE_REMEMBERED, x)
    before = s[j + _INSIDE]
    s[j + _INSIDE] = 1.0 if x > 0.0 else 0.0
    if x > 0.0 and before == 0.0 and velocity > 0.0:
        force += min(p[i + _PER_SPEED] * velocity, p[i + _LIMIT])
    return force


# What a tap on something hard adds to a wall: a short force in open loop, scaled by the speed of entry.
#
#     f ← f + v̂ g_n         n = 0, 1, …: samples since the entry at v̂, until the hand leaves
#
#     fixed          g = A                                   for the duration
#     decaying       g = A e^{−t/τ} sin 2πft                 t = n T
#     acceleration   g = m d_n                               d: deceleration in a tap of 1 m/s [1/s]
#
# Event-based haptics, Kuchenbecker, Fiene & Niemeyer (2006).  They invert the dynamics of the
# device to play a recorded acceleration; here the device is its mass.  The sizes are derived for
# this project: not told otherwise, each transient takes the momentum m v̂ out, T Σ g = m, and the
# deceleration without a record is half a sine.

EVENT_TRANSIENT = 13.0

_COUNT, _TABLE = range(2)
_PLAYED, _SPEED, _EVENT_REMEMBERED = range(3)

LONGEST_TRANSIENT = 10_000
"""Samples."""

_ARMED, _OVER = -1.0, 1e9

_DEFAULTS = {"duration": Exact("0.01"), "frequency": Exact(100), "time_constant": Exact("0.01")}
_OF_KIND = {
    "fixed": ("amplitude", "duration"),
    "decaying": ("amplitude", "duration", "frequency", "time_constant"),
    "acceleration": ("duration", "record"),
}


def _shaping(quantity: str, meaning: str) -> Any:
    """A number > 0 that shapes the transient."""
    return exact(quantity, None, "> 0", "it shapes the transient", meaning)


def _record(values: Sequence[RealLike] | None, name: str) -> tuple[Exact, ...] | None:
    if values is None:
        return None
    try:
        record = tuple(Exact(value) for value in values)
    except (TypeError, InputError) as error:
        raise InputError(f"{name} is one deceleration [1/s] a sample: {error}") from None
    if not 1 <= len(record) <= LONGEST_TRANSIENT:
        raise InputError(f"{name} has from 1 to {LONGEST_TRANSIENT} samples, got {len(record)}")
    return record


@dataclass(frozen=True)
class EventTransient(RenderingLaw):
    """An open-loop transient at entry, scaled by its speed; armed again when the hand has left.

    Parameters
    ----------
    kind
        "fixed", "decaying" or "acceleration".
    amplitude
        A > 0 of the first two [N·s/m; N·m·s/rad]; None: the transient stops the mass.
    duration
        How long it is played, > 0 [s].  Default 10 ms; decaying 5 τ.
    frequency
        f > 0, less than half the rate [Hz].  Default 100.
    time_constant
        τ > 0 [s].  Default 10 ms.
    record
        d_n, deceleration by unit speed of entry, one number a sample [1/s]; None: half a sine of
        the duration that stops the mass.
    mass
        m > 0 [kg; kg·m²]; None: the device's.
    velocity
        `AdaptiveWindow(…)` (default), `TickTime()` or `Kalman(…)`.

    Raises
    ------
    InputError
        If a number is not positive, the kind does not use it, or kind or velocity is none of
        these; later, if the mass is not known, the environment has no surface, or T is too
        long for the frequency or the duration.
    """

    code: ClassVar[float] = EVENT_TRANSIENT

    kind: Literal["fixed", "decaying", "acceleration"] = word("decaying", "fixed", "acceleration")
    _: KW_ONLY
    amplitude: CertainOrNone = _shaping("virtual_damping", "A, by default what stops the mass")
    duration: CertainOrNone = _shaping("time_constant", "how long it is played")
    frequency: CertainOrNone = _shaping("frequency", "f of the decaying one, by default 100 Hz")
    time_constant: CertainOrNone = _shaping("time_constant", "τ of the decaying one, by default 10 ms")
    record: Reads[tuple[Exact, ...] | None, Sequence[RealLike] | None] = part(
        "list",
        _record,
        None,
        meaning="deceleration in a tap at unit speed, a number a sample",
        quantity=Quantity("record", "d", "1/s", "1/s", ""),
    )
    mass: CertainOrNone = _shaping("mass", "what is to be stopped, by default the device's")
    velocity: Reads[Estimator, Estimator | None] = estimated()

    def __post_init__(self) -> None:
        super().__post_init__()
        for name in ("amplitude", "duration", "frequency", "time_constant", "record"):
            if getattr(self, name) is not None and name not in _OF_KIND[self.kind]:
                has = ", ".join(_OF_KIND[self.kind])
                raise InputError(f"{name} is not of the {self.kind} transient, which has {has}")
        if self.record is not None and self.duration is not None:
            raise InputError("give either record or duration: a record is as long as it is")

    @property
    def state_size(self) -> int:  # type: ignore[override]  # the estimator's among them, known once it is chosen
        """Samples played, speed of entry, and those of the estimator."""
        return _EVENT_REMEMBERED + self.velocity.state_size

    def numbers(self, at: LoopContext) -> list[float]:
        """How many samples, g of each, the estimator's."""
        surface(at, "a transient")
        table = self.table(at)
        return [float(len(table)), *table, *packed(self.velocity, at)]

    def table(self, at: LoopContext) -> list[float]:
        """g_n [N·s/m; N·m·s/rad]."""
        if self.record is not None:
            return [float(d) * self._mass(at) for d in self.record]
        period, count = at.period, self._samples(at.period)
        if self.kind == "acceleration":  # the mean of (π/2D) sin πt/D over each hold: its sum is 1/T
            edges = [cos(pi * n / count) for n in range(count + 1)]
            return [self._mass(at) / period * (a - b) / 2 for a, b in zip(edges, edges[1:], strict=False)]
        shape = [1.0] * count if self.kind == "fixed" else self._decay(count, period)
        scale = float(self.amplitude) if self.amplitude is not None else self._stopping(shape, at)
        return [scale * g for g in shape]

    def _stopping(self, shape: list[float], at: LoopContext) -> float:
        total = sum(shape)
        if total <= 0:
            raise InputError(
                f"no amplitude of this transient stops the mass, its samples add up to {total:g}: give the "
                "amplitude, or a longer duration"
            )
        return self._mass(at) / (at.period * total)

    def _decay(self, count: int, period: float) -> list[float]:
        frequency, tau = self._own("frequency"), self._own("time_constant")
        if frequency * period >= 0.5:
            most, given = shown(0.5 / period, "Hz", 6), shown(frequency, "Hz", 6)
            raise InputError(
                f"frequency must be below half the rate, {most}, got {given}: samples cannot follow it"
            )
        return [exp(-n * period / tau) * sin(2 * pi * frequency * n * period) for n in range(count)]

    def _own(self, name: str) -> float:
        given = getattr(self, name)
        return float(_DEFAULTS[name] if given is None else given)

    def _samples(self, period: float) -> int:
        decay = self.kind == "decaying" and self.duration is None
        length = 5 * self._own("time_constant") if decay else self._own("duration")
        count = round(length / period)
        if not 1 <= count <= LONGEST_TRANSIENT:
            given = f"samples of {shown(period, 's', 6)}, got {shown(length, 's', 6)}"
            raise InputError(f"duration must be from 1 to {LONGEST_TRANSIENT} {given}")
        return count

    def _mass(self, at: LoopContext) -> float:
        return given_or_known(self.mass, at, "mass", "mass")

    def initial_state(self, reading: float) -> list[float]:
        """A hand that is inside has entered long ago."""
        return [_OVER if reading > 0.0 else _ARMED, 0.0, *self.velocity.initial_state(reading)]

    def describe(self, motion: str = "linear") -> str:
        parts: list[str] = [self.kind]
        if self.amplitude is not None:
            parts.append(self.with_unit("amplitude", motion))
        if self.kind == "decaying":
            parts += [shown(self._own("frequency"), "Hz", 6), shown(self._own("time_constant"), "s", 6)]
        if self.record is not None:
            parts.append(f"record of {len(self.record)} samples")
        elif self.kind != "decaying" or self.duration is not None:
            parts.append(f"for {shown(self._own('duration'), 's', 6)}")
        return f"transient at entry ({', '.join(parts)}) on {self.velocity.describe(motion)}"


@compiled
def event_transient_step(p: Array, i: int, s: Array, j: int, x: float, force: float, applied: float) -> float:
    """One sample; p from i and s from j on are this law's."""
    count = int(p[i + _COUNT])
    velocity = estimate(p, i + _TABLE + count, s, j + _EVENT_REMEMBERED, x)
    if x <= 0.0:
        s[j + _PLAYED] = _ARMED
        return force
    if s[j + _PLAYED] == _ARMED:
        s[j + _PLAYED], s[j + _SPEED] = 0.0, max(velocity, 0.0)
    played = int(s[j + _PLAYED])
    if played < count:
        force += s[j + _SPEED] * p[i + _TABLE + played]
        s[j + _PLAYED] += 1.0
    return force
