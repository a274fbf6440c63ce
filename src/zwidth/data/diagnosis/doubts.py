"""What in a recording speaks against naming any cause from it: another kind of motion, a unit, a sensor.

The probabilities are of things that shake for one reason and go on to.  What dies out, noise, the hum of the
mains, or a column in another unit is none of these, whatever is likeliest among them.
"""

from __future__ import annotations

import numpy as np

from zwidth.data.diagnosis.drive import Drive
from zwidth.data.diagnosis.evidence import Evidence
from zwidth.quantity.text import shown

_DIES = -0.9
"""Logarithm of the motion's size at the end of the stretch over that at its start."""

_REGULAR = 0.7
"""Share of the variance in frequency and harmonics, by the degrees of freedom, that a vibration has."""

_IRREGULAR = {"velocity-weakening friction": 0.4, "differenced velocity": -np.inf, "encoder buzz": -np.inf}
"""The same of what jumps: between counts, from sample to sample, or where it sticks."""

_ANOTHER_UNIT = 100.0
_GAIN = 1.3
_ALIKE = 1e-2
"""Share of a motor's force that a multiple of its command may leave over."""

_MAINS = (50.0, 60.0, 100.0, 120.0)
"""[Hz]"""

_NEAR = 0.15
"""[Hz] of the mains, to which it is kept."""


def doubt(cause: str, seen: Evidence) -> str | None:
    """What to look at or to record before this cause is named; None where nothing speaks against it."""
    vibration = seen.vibration
    if vibration.growth < _DIES:
        return "a stretch in which it goes on: in this one it dies out by itself"
    if vibration.regular_by_chance < _IRREGULAR.get(cause, _REGULAR):
        return "a stretch in which it goes to and fro evenly: in this one it is more noise than vibration"
    d = seen.drive
    if d is not None and _is_multiple(d):
        return (
            f"both forces in one unit: the motor's is {d.gain:.3g} times the command, as of a scale or a "
            "motor constant that is another one"
        )
    size = 1.0 if seen.moves_as is None else abs(seen.moves_as)
    if not 1 / _ANOTHER_UNIT < size < _ANOTHER_UNIT:
        return f"units and mass once more: to move so takes {size:.2g} times the force in the file"
    mains = min(_MAINS, key=lambda at: abs(at - vibration.frequency))
    if cause == "structural resonance" and abs(mains - vibration.frequency) < _NEAR:
        return f"the same with the motor off: {shown(mains, 'Hz', 3)} may be hum of the mains in a sensor"
    return None


def _is_multiple(d: Drive) -> bool:
    """Whether the motor's force is another multiple of the command, better than anything else would do."""
    other = min(d.by_delay, d.by_damper, d.by_rate)
    return d.by_gain < min(_ALIKE, other / 4) and not 1 / _GAIN < d.gain < _GAIN
