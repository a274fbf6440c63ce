"""Things that shake, each for one reason: the loop with its fault, and its motion, for `diagnosis.py`.

It knows nothing of the diagnosis.  `shaken_draws.py` draws such things, `shaken_logs.py` logs their motion.

Sampling, delay, velocity estimate, encoder, compensation of friction and the amplifier's voltage are those of
`zw.simulate`.  What it lacks is integrated here in steps of T/40: a damper inside the drive, friction that
falls with speed, and a handle on a springy shaft.
"""

from __future__ import annotations

from dataclasses import dataclass, field, replace
from pathlib import Path
from typing import Any

import numpy as np
from in_c import REALS, WHOLE, library
from numpy.typing import NDArray

import zwidth as zw
from zwidth.model.device.amplifier import VoltageLimited

Array = NDArray[np.float64]

CAUSES = (
    "sampling",
    "delay",
    "differenced velocity",
    "encoder buzz",
    "drive damping",
    "friction compensation",
    "velocity-weakening friction",
    "actuator limit",
    "structural resonance",
)

FINE = 40
"""Steps of the integrator here in a sample period."""


@dataclass(frozen=True, kw_only=True)
class Thing:
    """All numbers of one loop, in SI units, and its fault."""

    cause: str
    motion: str
    mass: float
    damping: float
    coulomb: float
    resolution: float
    period: float
    stiffness: float
    virtual_damping: float = 0.0
    window: int = 1
    two_sided: bool = False
    delay: float = 0.0
    limit: float = 0.0
    slew: float = 0.0
    compensation: float = 0.0
    compensation_speed: float = 0.0
    hand_mass: float = 0.0
    hand_stiffness: float = 0.0
    hand_damping: float = 0.0
    press: float = 0.0
    drag: float = 0.0
    kick: float = 0.0
    drive_damping: float = 0.0
    drive_lag: float = 0.0
    stiction: float = 0.0
    stribeck_speed: float = 1.0
    shaft: float = 0.0
    shaft_damping: float = 0.0
    handle_mass: float = 0.0
    sensor_on_handle: bool = False
    duration: float = 2.0
    phase: float = 0.3
    mended: dict[str, Any] = field(default_factory=dict)

    def without_fault(self) -> Thing:
        """The same without the fault."""
        return replace(self, **self.mended)

    @property
    def device(self) -> zw.Device:
        """Its true numbers."""
        return zw.Device(
            motion=self.motion,
            mass=self.mass,
            damping=self.damping,
            coulomb_friction=self.coulomb,
            resolution=self.resolution,
            sample_period=self.period,
            delay=self.delay,
            **(
                {
                    "force_limit": self.limit,
                    "current_limit": 1.0,
                    "motor_inductance": 1.0,
                    "supply_voltage": self.slew / self.limit,
                }
                if self.slew
                else {"force_limit": self.limit}
                if self.limit
                else {}
            ),
        )


@dataclass(frozen=True)
class Run:
    """At the samples: time, what the encoder read, what was asked for, what the motor gave, true speed."""

    time: Array
    measured: Array
    commanded: Array
    applied: Array
    velocity: Array


def run(thing: Thing) -> Run:
    """Simulate it."""
    if thing.cause in ("drive damping", "velocity-weakening friction", "structural resonance"):
        return _run_here(thing)
    law: Any
    if thing.two_sided:
        law = _two_sided(thing)
    else:
        law = zw.Wall(
            stiffness=thing.stiffness,
            damping=thing.virtual_damping,
            velocity_filter=zw.rendering.Window(thing.window),
        )
    if thing.compensation:
        law = zw.render(
            law, zw.FrictionCompensation(coulomb=thing.compensation, speed=thing.compensation_speed)
        )
    trace = zw.simulate(
        thing.device,
        law,
        _hand(thing),
        thing.duration,
        initial_position=0.0 if thing.two_sided else -0.3 * _depth(thing),
        initial_velocity=thing.kick,
        encoder_phase=thing.phase,
        amplifier=VoltageLimited() if thing.slew else None,
    )
    names = ("time", "measured_position", "commanded_force", "actuator_force", "velocity")
    return Run(*(np.asarray(trace[name].values, dtype=float) for name in names))


def _two_sided(thing: Thing) -> Any:
    """K + B (1 − z⁻ᴺ)/(N T) on both sides."""
    k, b, n, t = thing.stiffness, thing.virtual_damping, thing.window, thing.period
    if not b:
        return zw.PulseTransferFunction([k], [1.0])
    gain = b / (n * t)
    return zw.PulseTransferFunction([k + gain, *[0.0] * (n - 1), -gain], [1.0, *[0.0] * n])


def _depth(thing: Thing) -> float:
    return thing.press / thing.stiffness if thing.press else 20 * thing.resolution


def _hand(thing: Thing) -> Any:
    if not thing.hand_stiffness:
        return zw.operators.ConstantForce(force=thing.press)
    return zw.operators.Finger(
        mass=thing.hand_mass,
        stiffness=thing.hand_stiffness,
        damping=thing.hand_damping,
        force=thing.press * (1 + thing.hand_stiffness / thing.stiffness),
        speed=max(thing.kick, 1e-3),
        start=0.0 if thing.two_sided else -0.3 * _depth(thing),
    )


def _run_here(thing: Thing) -> Run:
    steps = round(thing.duration / thing.period)
    numbers = np.array(
        [
            thing.mass, thing.damping, thing.coulomb, thing.resolution, thing.period, thing.stiffness,
            thing.virtual_damping, thing.two_sided, thing.limit, thing.hand_mass, thing.hand_stiffness,
            thing.hand_damping, thing.press, thing.drag, thing.kick, thing.drive_damping, thing.drive_lag,
            max(thing.stiction, thing.coulomb), thing.stribeck_speed, thing.shaft, thing.shaft_damping,
            thing.handle_mass, thing.sensor_on_handle, thing.phase,
        ],
        dtype=float,
    )  # fmt: skip
    late = round(thing.delay / thing.period)
    out = _integrate(numbers, thing.window, late, steps)
    return Run(np.arange(steps) * thing.period, *out)


def _integrate(p: Array, window: int, late: int, steps: int) -> Array:
    out, behind = np.zeros((4, steps)), max(1, round(p[16] / p[4] * FINE))  # lag and sample period
    thing = library(Path(__file__).with_name("shaken.c")).thing
    thing.argtypes = [REALS, *[WHOLE] * 5, *[REALS] * 3]
    thing(p, window, late, steps, FINE, behind, np.zeros(steps + window), np.zeros(behind), out)
    return out


def shakes(thing: Thing, made: Run) -> bool:
    """True where it goes on shaking to the end, as far as a log can show: four counts, six cycles, 2 Hz;
    and in three times the time: what dies out slowly does not live on what feeds it.

    The encoder's own buzz may be as small as half a count.
    """
    if not np.isfinite(made.measured).all():
        return False
    least = 0.5 if thing.cause == "encoder buzz" else 4.0
    swings = _swings(thing, made)
    if swings[-1] < least * thing.resolution or swings[-1] < 0.3 * swings[0]:
        return False
    last = made.velocity[-made.time.size // 3 :]
    power = np.abs(np.fft.rfft((last - last.mean()) * np.hanning(last.size))) ** 2
    peak = int(np.argmax(power))
    if peak < 6 or peak / (last.size * thing.period) < 2.0:
        return False
    later = _swings(thing, run(replace(thing, duration=3 * thing.duration)))
    return bool(later[-1] > 0.5 * swings[-1])


def quiet(thing: Thing, made: Run) -> bool:
    """True where it has come to rest, or is going to: a tenth of a count, or below half of what it was."""
    if not np.isfinite(made.measured).all():
        return False
    swings = _swings(thing, made)
    return bool(swings[-1] < 0.1 * thing.resolution or (swings[-1] < 0.5 * swings[0] and thing.kick > 0))


def _swings(thing: Thing, made: Run) -> Array:
    """[m; rad] mean peak to peak of the true motion in two thirds of the time: pieces of an eighth, a line
    taken off.
    """
    moved = np.cumsum(made.velocity) * thing.period
    pieces = np.array_split(moved[-2 * made.time.size // 3 :], 8)
    return np.array(
        [np.ptp(p - np.polyval(np.polyfit(np.arange(p.size), p, 1), np.arange(p.size))) for p in pieces]
    )
