"""Waves without a ledger: the wave held over the period, the device's own damping as the matched damper.

    f = 2 √(w/T) a,    u = √(w/T) Δx − a,    u² = a² − f Δx + (w/T) Δx²        (waves in √J)

Passive whatever the link does if w ≤ b and the displacement is read exactly; else a hand takes energy out,
whatever Coulomb friction there is (docs/theory/links.md).
"""

from __future__ import annotations

from dataclasses import dataclass
from math import sqrt
from typing import ClassVar

from zwidth.links.memory import (
    ACTING,
    ENERGY,
    FRESH,
    HEARD_WAVE,
    NUMBER,
    OWN_NUMBERS,
    PERIOD,
    POSITION,
    RESOLUTION,
    WAVE,
    apply,
)
from zwidth.links.waves import Waves
from zwidth.native.compiled import Array, compiled
from zwidth.quantity.exact import Exact, ends

HELD_WAVES = 2.0

_IMPEDANCE = OWN_NUMBERS


@compiled
def force(p: Array, s: Array) -> float:
    """The force of the newest wave, used once; of a packet that is missing none."""
    root = sqrt(p[_IMPEDANCE] / p[PERIOD])
    received = s[HEARD_WAVE] if s[FRESH] > 0.0 else 0.0
    s[FRESH] = 0.0
    return apply(p, s, 2.0 * root * received)


@compiled
def send(p: Array, s: Array, moved: float) -> None:
    """The wave that goes back."""
    root = sqrt(p[_IMPEDANCE] / p[PERIOD])
    wave = root * moved - s[ACTING] / (2.0 * root)
    s[WAVE] = wave
    s[ENERGY] += wave * wave
    s[POSITION] += wave / root
    s[NUMBER] += 1.0


@dataclass(frozen=True)
class HeldWaves(Waves):
    """Waves without a ledger, ``f = 2 √(w/T) a``, ``u = √(w/T) Δx − a``: each packet's wave used once.

    Parameters
    ----------
    device
        What the port drives.
    impedance
        w > 0 [N·s/m; N·m·s/rad]; None: the device's damping.

    Raises
    ------
    InputError
        If a number is missing or out of its bounds.
    """

    title: ClassVar[str] = "waves without a ledger"
    code: ClassVar[float] = HELD_WAVES
    steps: ClassVar = (force, send)

    @property
    def theorem(self) -> str:
        """w ≤ b, and nothing is rounded off the displacement."""
        w = self.impedance  # the damping where none was given
        if w is None or Exact(w).fraction > ends(self.device.damping)[0] or self.numbers[RESOLUTION] > 0:
            return ""
        return "w ≤ b: in every period the device's damping takes what the hold feeds"
