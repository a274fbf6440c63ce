"""The laws in a row, as the loop runs them.

Packed behind the numbers of the environment, for each law: its code, how many numbers and
how many slots it has, its numbers.  In the memory: the force that was applied last, then
the slots of each law.
"""

from __future__ import annotations

from zwidth.compiled import Array, compiled
from zwidth.rendering import (
    dual_rate,
    energy_bounding,
    energy_tank,
    force_bounding,
    held,
    passive_leap,
    passivity_controller,
)
from zwidth.rendering.dual_rate import DUAL_RATE
from zwidth.rendering.energy_bounding import ENERGY_BOUNDING
from zwidth.rendering.energy_tank import ENERGY_TANK
from zwidth.rendering.force_bounding import FORCE_BOUNDING
from zwidth.rendering.held import HELD
from zwidth.rendering.passive_leap import PASSIVE_LEAP
from zwidth.rendering.passivity_controller import PASSIVITY_CONTROLLER

_controlled = passivity_controller.step
_force_bounded = force_bounding.step
_from_the_tank = energy_tank.step
_energy_bounded = energy_bounding.step
_leapt = passive_leap.step
_local = dual_rate.step
_held = held.step


@compiled
def after(law: Array, at: int, count: int, memory: Array, slot: int, reading: float, force: float) -> float:
    """The force of the environment through all laws that come after it."""
    applied = memory[slot]
    slot += 1
    for _ in range(count):
        code, size, slots = law[at], int(law[at + 1]), int(law[at + 2])
        if code == PASSIVITY_CONTROLLER:
            force = _controlled(law, at + 3, memory, slot, reading, force, applied)
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
