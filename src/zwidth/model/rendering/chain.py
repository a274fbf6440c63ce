"""The laws in a chain, as the loop runs them.

Packed behind the numbers of the environment, for each law: its code, how many numbers and
how many numbers it remembers, its numbers.  In the memory: the force that was applied last, then
the numbers that each law remembers.  Codes from 30 and below 35 change the reading that the environment
is given, the others the force that it gives.
"""

from __future__ import annotations

from zwidth.model.rendering.energy import (
    dual_rate,
    energy_bounding,
    energy_tank,
    force_bounding,
    held,
    passive_leap,
    passivity_controller,
    windowed_controller,
)
from zwidth.model.rendering.force import (
    braking_pulse,
    compensation_step,
    damper,
    dither,
    event_transient,
    friction_compensation,
    hysteresis,
    rate_term,
    saturation,
    slew_limit,
)
from zwidth.model.rendering.prediction import crossing, extrapolation, half_sample, pole_matched
from zwidth.native.compiled import Array, compiled


@compiled
def before(law: Array, at: int, count: int, memory: Array, slot: int, reading: float) -> float:
    """The reading that the environment is given, through all laws that come before it."""
    applied = memory[slot]
    slot += 1
    for _ in range(count):
        code, size, remembered = law[at], int(law[at + 1]), int(law[at + 2])
        if code == extrapolation.EXTRAPOLATION:
            reading = extrapolation.step(law, at + 3, memory, slot, reading)
        elif code == half_sample.HALF_SAMPLE:
            reading = half_sample.step(law, at + 3, memory, slot, reading, applied)
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
        if code == passivity_controller.PASSIVITY_CONTROLLER:
            force = passivity_controller.step(law, at + 3, memory, slot, reading, force, applied)
        elif code == windowed_controller.WINDOWED_CONTROLLER:
            force = windowed_controller.step(law, at + 3, memory, slot, reading, force, applied)
        elif code == rate_term.RATE_TERM:
            force = rate_term.step(law, at + 3, memory, slot, reading, force, applied)
        elif code == crossing.CROSSING:
            force = crossing.step(law, at + 3, memory, slot, reading, force, applied)
        elif code == pole_matched.POLE_MATCHED:
            force = pole_matched.step(law, at + 3, memory, slot, reading, force, applied)
        elif code == damper.DAMPER:
            force = damper.step(law, at + 3, memory, slot, reading, force, applied)
        elif code == hysteresis.HYSTERESIS:
            force = hysteresis.step(law, at + 3, memory, slot, reading, force, applied)
        elif code == braking_pulse.BRAKING_PULSE:
            force = braking_pulse.step(law, at + 3, memory, slot, reading, force, applied)
        elif code == event_transient.EVENT_TRANSIENT:
            force = event_transient.step(law, at + 3, memory, slot, reading, force, applied)
        elif code == slew_limit.SLEW_LIMIT:
            force = slew_limit.step(law, at + 3, memory, slot, reading, force, applied)
        elif code == dither.DITHER:
            force = dither.step(law, at + 3, memory, slot, reading, force, applied)
        elif code == friction_compensation.FRICTION_COMPENSATION:
            force = compensation_step.step(law, at + 3, memory, slot, reading, force, applied)
        elif code == saturation.SATURATION:
            force = saturation.step(law, at + 3, memory, slot, reading, force, applied)
        elif code == force_bounding.FORCE_BOUNDING:
            force = force_bounding.step(law, at + 3, memory, slot, reading, force, applied)
        elif code == energy_tank.ENERGY_TANK:
            force = energy_tank.step(law, at + 3, memory, slot, reading, force, applied)
        elif code == energy_bounding.ENERGY_BOUNDING:
            force = energy_bounding.step(law, at + 3, memory, slot, reading, force, applied)
        elif code == passive_leap.PASSIVE_LEAP:
            force = passive_leap.step(law, at + 3, memory, slot, reading, force, applied)
        elif code == dual_rate.DUAL_RATE:
            force = dual_rate.step(law, at + 3, memory, slot, reading, force, applied)
        elif code == held.HELD:
            force = held.step(law, at + 3, memory, slot, reading, force, applied)
        at += 3 + size
        slot += remembered
    return force
