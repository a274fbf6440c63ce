"""The laws in a chain, as the loop runs them.

Packed behind the numbers of the environment, for each law: its code, how many numbers and
how many numbers it remembers, its numbers.  In the memory: the force that was applied last, then
the numbers that each law remembers.  Codes from 30 and below 35 change the reading that the environment
is given, the others the force that it gives.
"""

from __future__ import annotations

from zwidth.model.rendering.ahead import (
    EXTRAPOLATION,
    HALF_SAMPLE,
    POLE_MATCHED,
    extrapolation_step,
    half_sample_step,
    pole_matched_step,
)
from zwidth.model.rendering.bounding import (
    ENERGY_BOUNDING,
    FORCE_BOUNDING,
    energy_bounding_step,
    force_bounding_step,
)
from zwidth.model.rendering.crossing import CROSSING, crossing_step
from zwidth.model.rendering.dampers import (
    DAMPER,
    HYSTERESIS,
    RATE_TERM,
    damper_step,
    hysteresis_step,
    rate_term_step,
)
from zwidth.model.rendering.friction_compensation import FRICTION_COMPENSATION
from zwidth.model.rendering.limits import (
    DITHER,
    SATURATION,
    SLEW_LIMIT,
    dither_step,
    saturation_step,
    slew_limit_step,
)
from zwidth.model.rendering.passivity_controller import PASSIVITY_CONTROLLER, passivity_controller_step
from zwidth.model.rendering.pulses import (
    BRAKING_PULSE,
    EVENT_TRANSIENT,
    braking_pulse_step,
    event_transient_step,
)
from zwidth.model.rendering.stores import ENERGY_TANK, PASSIVE_LEAP, energy_tank_step, passive_leap_step
from zwidth.model.rendering.updates import DUAL_RATE, HELD, dual_rate_step, held_step
from zwidth.model.rendering.windowed_controller import WINDOWED_CONTROLLER, windowed_controller_step
from zwidth.native.compiled import Array, compiled
from zwidth.quantity.elementary import tanh


@compiled
def before(law: Array, at: int, count: int, memory: Array, slot: int, reading: float) -> float:
    """The reading that the environment is given, through all laws that come before it."""
    applied = memory[slot]
    slot += 1
    for _ in range(count):
        code, size, remembered = law[at], int(law[at + 1]), int(law[at + 2])
        if code == EXTRAPOLATION:
            reading = extrapolation_step(law, at + 3, memory, slot, reading)
        elif code == HALF_SAMPLE:
            reading = half_sample_step(law, at + 3, memory, slot, reading, applied)
        at += 3 + size
        slot += remembered
    return reading


@compiled
def after(law: Array, at: int, count: int, memory: Array, slot: int, reading: float, force: float) -> float:
    """The force of the environment through all laws that come after it."""
    applied = memory[slot]
    slot += 1
    for _ in range(count):
        code, size, remembered = law[at], int(law[at + 1]), int(law[at + 2])
        if code == PASSIVITY_CONTROLLER:
            force = passivity_controller_step(law, at + 3, memory, slot, reading, force, applied)
        elif code == WINDOWED_CONTROLLER:
            force = windowed_controller_step(law, at + 3, memory, slot, reading, force, applied)
        elif code == RATE_TERM:
            force = rate_term_step(law, at + 3, memory, slot, reading, force, applied)
        elif code == CROSSING:
            force = crossing_step(law, at + 3, memory, slot, reading, force, applied)
        elif code == POLE_MATCHED:
            force = pole_matched_step(law, at + 3, memory, slot, reading, force, applied)
        elif code == DAMPER:
            force = damper_step(law, at + 3, memory, slot, reading, force, applied)
        elif code == HYSTERESIS:
            force = hysteresis_step(law, at + 3, memory, slot, reading, force, applied)
        elif code == BRAKING_PULSE:
            force = braking_pulse_step(law, at + 3, memory, slot, reading, force, applied)
        elif code == EVENT_TRANSIENT:
            force = event_transient_step(law, at + 3, memory, slot, reading, force, applied)
        elif code == SLEW_LIMIT:
            force = slew_limit_step(law, at + 3, memory, slot, reading, force, applied)
        elif code == DITHER:
            force = dither_step(law, at + 3, memory, slot, reading, force, applied)
        elif code == FRICTION_COMPENSATION:
            force = compensation_step(law, at + 3, memory, slot, reading, force, applied)
        elif code == SATURATION:
            force = saturation_step(law, at + 3, memory, slot, reading, force, applied)
        elif code == FORCE_BOUNDING:
            force = force_bounding_step(law, at + 3, memory, slot, reading, force, applied)
        elif code == ENERGY_TANK:
            force = energy_tank_step(law, at + 3, memory, slot, reading, force, applied)
        elif code == ENERGY_BOUNDING:
            force = energy_bounding_step(law, at + 3, memory, slot, reading, force, applied)
        elif code == PASSIVE_LEAP:
            force = passive_leap_step(law, at + 3, memory, slot, reading, force, applied)
        elif code == DUAL_RATE:
            force = dual_rate_step(law, at + 3, memory, slot, reading, force, applied)
        elif code == HELD:
            force = held_step(law, at + 3, memory, slot, reading, force, applied)
        at += 3 + size
        slot += remembered
    return force


_COULOMB, _VISCOUS, _SPEED, _PERIOD = range(4)


@compiled
def compensation_step(p: Array, i: int, s: Array, j: int, x: float, force: float, applied: float) -> float:
    """One sample; p from i and s from j on are this law's."""
    v = (x - s[j]) / p[i + _PERIOD]
    s[j] = x
    if v == 0.0:
        return force
    most, speed = p[i + _COULOMB], p[i + _SPEED]
    bent = tanh(v / speed) if speed > 0.0 else (1.0 if v > 0.0 else -1.0)
    return force - most * bent - p[i + _VISCOUS] * v
