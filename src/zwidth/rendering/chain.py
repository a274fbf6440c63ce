"""The laws in a row, as the loop runs them.

Packed behind the numbers of the environment, for each law: its code, how many numbers and
how many slots it has, its numbers.  In the memory: the force that was applied last, then
the slots of each law.
"""

from __future__ import annotations

from zwidth.compiled import Array, compiled
from zwidth.rendering import (
    braking_pulse,
    damper,
    dither,
    event_transient,
    hysteresis,
    passivity_controller,
    saturation,
    slew_limit,
)
from zwidth.rendering.braking_pulse import BRAKING_PULSE
from zwidth.rendering.damper import DAMPER
from zwidth.rendering.dither import DITHER
from zwidth.rendering.event_transient import EVENT_TRANSIENT
from zwidth.rendering.hysteresis import HYSTERESIS
from zwidth.rendering.passivity_controller import PASSIVITY_CONTROLLER
from zwidth.rendering.saturation import SATURATION
from zwidth.rendering.slew_limit import SLEW_LIMIT

_controlled = passivity_controller.step
_damped = damper.step
_slipping = hysteresis.step
_braked = braking_pulse.step
_tapped = event_transient.step
_slewed = slew_limit.step
_dithered = dither.step
_saturated = saturation.step


@compiled
def after(law: Array, at: int, count: int, memory: Array, slot: int, reading: float, force: float) -> float:
    """The force of the environment through all laws that come after it."""
    applied = memory[slot]
    slot += 1
    for _ in range(count):
        code, size, slots = law[at], int(law[at + 1]), int(law[at + 2])
        if code == PASSIVITY_CONTROLLER:
            force = _controlled(law, at + 3, memory, slot, reading, force, applied)
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
        at += 3 + size
        slot += slots
    return force
