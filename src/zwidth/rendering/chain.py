"""The laws in a row, as the loop runs them.

Packed behind the numbers of the environment, for each law: its code, how many numbers and
how many slots it has, its numbers.  In the memory: the force that was applied last, then
the slots of each law.  Codes from 30 and below 35 change the reading that the environment
is given, the others the force that it gives.
"""

from __future__ import annotations

from zwidth.compiled import Array, compiled
from zwidth.rendering.energy import (
    dual_rate,
    energy_bounding,
    energy_tank,
    force_bounding,
    held,
    passive_leap,
    passivity_controller,
    windowed_controller,
)
from zwidth.rendering.energy.dual_rate import DUAL_RATE
from zwidth.rendering.energy.energy_bounding import ENERGY_BOUNDING
from zwidth.rendering.energy.energy_tank import ENERGY_TANK
from zwidth.rendering.energy.force_bounding import FORCE_BOUNDING
from zwidth.rendering.energy.held import HELD
from zwidth.rendering.energy.passive_leap import PASSIVE_LEAP
from zwidth.rendering.energy.passivity_controller import PASSIVITY_CONTROLLER
from zwidth.rendering.energy.windowed_controller import WINDOWED_CONTROLLER
from zwidth.rendering.force import (
    braking_pulse,
    damper,
    dither,
    event_transient,
    hysteresis,
    rate_term,
    saturation,
    slew_limit,
)
from zwidth.rendering.force.braking_pulse import BRAKING_PULSE
from zwidth.rendering.force.damper import DAMPER
from zwidth.rendering.force.dither import DITHER
from zwidth.rendering.force.event_transient import EVENT_TRANSIENT
from zwidth.rendering.force.hysteresis import HYSTERESIS
from zwidth.rendering.force.rate_term import RATE_TERM
from zwidth.rendering.force.saturation import SATURATION
from zwidth.rendering.force.slew_limit import SLEW_LIMIT
from zwidth.rendering.prediction import crossing, extrapolation, half_sample, pole_matched
from zwidth.rendering.prediction.crossing import CROSSING
from zwidth.rendering.prediction.extrapolation import EXTRAPOLATION
from zwidth.rendering.prediction.half_sample import HALF_SAMPLE
from zwidth.rendering.prediction.pole_matched import POLE_MATCHED

_controlled = passivity_controller.step
_windowed = windowed_controller.step
_leading = rate_term.step
_extrapolated = extrapolation.step
_predicted = half_sample.step
_corrected = crossing.step
_matched = pole_matched.step
_damped = damper.step
_slipping = hysteresis.step
_braked = braking_pulse.step
_tapped = event_transient.step
_slewed = slew_limit.step
_dithered = dither.step
_saturated = saturation.step
_force_bounded = force_bounding.step
_from_the_tank = energy_tank.step
_energy_bounded = energy_bounding.step
_leapt = passive_leap.step
_local = dual_rate.step
_held = held.step


@compiled
def before(law: Array, at: int, count: int, memory: Array, slot: int, reading: float) -> float:
    """The reading that the environment is given, through all laws that come before it."""
    applied = memory[slot]
    slot += 1
    for _ in range(count):
        code, size, slots = law[at], int(law[at + 1]), int(law[at + 2])
        if code == EXTRAPOLATION:
            reading = _extrapolated(law, at + 3, memory, slot, reading)
        elif code == HALF_SAMPLE:
            reading = _predicted(law, at + 3, memory, slot, reading, applied)
        at += 3 + size
        slot += slots
    return reading


@compiled
def after(law: Array, at: int, count: int, memory: Array, slot: int, reading: float, force: float) -> float:
    """The force of the environment through all laws that come after it."""
    applied = memory[slot]
    slot += 1
    for _ in range(count):
        code, size, slots = law[at], int(law[at + 1]), int(law[at + 2])
        if code == PASSIVITY_CONTROLLER:
            force = _controlled(law, at + 3, memory, slot, reading, force, applied)
        elif code == WINDOWED_CONTROLLER:
            force = _windowed(law, at + 3, memory, slot, reading, force, applied)
        elif code == RATE_TERM:
            force = _leading(law, at + 3, memory, slot, reading, force, applied)
        elif code == CROSSING:
            force = _corrected(law, at + 3, memory, slot, reading, force, applied)
        elif code == POLE_MATCHED:
            force = _matched(law, at + 3, memory, slot, reading, force, applied)
        elif code == DAMPER:
            force = _damped(law, at + 3, memory, slot, reading, force, applied)
        elif code == HYSTERESIS:
            force = _slipping(law, at + 3, memory, slot, reading, force, applied)
        elif code == BRAKING_PULSE:
            force = _braked(law, at + 3, memory, slot, reading, force, applied)
        elif code == EVENT_TRANSIENT:
            force = _tapped(law, at + 3, memory, slot, reading, force, applied)
        elif code == SLEW_LIMIT:
            force = _slewed(law, at + 3, memory, slot, reading, force, applied)
        elif code == DITHER:
            force = _dithered(law, at + 3, memory, slot, reading, force, applied)
        elif code == SATURATION:
            force = _saturated(law, at + 3, memory, slot, reading, force, applied)
        elif code == FORCE_BOUNDING:
            force = _force_bounded(law, at + 3, memory, slot, reading, force, applied)
        elif code == ENERGY_TANK:
            force = _from_the_tank(law, at + 3, memory, slot, reading, force, applied)
        elif code == ENERGY_BOUNDING:
            force = _energy_bounded(law, at + 3, memory, slot, reading, force, applied)
        elif code == PASSIVE_LEAP:
            force = _leapt(law, at + 3, memory, slot, reading, force, applied)
        elif code == DUAL_RATE:
            force = _local(law, at + 3, memory, slot, reading, force, applied)
        elif code == HELD:
            force = _held(law, at + 3, memory, slot, reading, force, applied)
        at += 3 + size
        slot += slots
    return force
