"""The laws in a row, as the loop runs them.

Packed behind the numbers of the environment, for each law: its code, how many numbers and
how many slots it has, its numbers.  In the memory: the force that was applied last, then
the slots of each law.
"""

from __future__ import annotations

from zwidth.compiled import Array, compiled
from zwidth.rendering import passivity_controller
from zwidth.rendering.passivity_controller import PASSIVITY_CONTROLLER

_controlled = passivity_controller.step


@compiled
def after(law: Array, at: int, count: int, memory: Array, slot: int, reading: float, force: float) -> float:
    """The force of the environment through all laws that come after it."""
    applied = memory[slot]
    slot += 1
    for _ in range(count):
        code, size, slots = law[at], int(law[at + 1]), int(law[at + 2])
        if code == PASSIVITY_CONTROLLER:
            force = _controlled(law, at + 3, memory, slot, reading, force, applied)
        at += 3 + size
        slot += slots
    return force
