"""Energy tank in two layers: the wall pushes with what is in the tank, a damper refills it.

    H ← H + f Δx                              what the hand has put in; f, all of it, was held
    |f_w| ≤ H/|Δx|,  0 where H ≤ 0            the wall's part; Δx the move just made
    f = f_w + d Δx/T,  d = α max(0, H_d − H), d ≤ b

after Franken, Stramigioli et al. (2011); the bound d ≤ b is of this project: without it a
hand that goes to and fro gets more out of the damper than the device takes, and the emptier
the tank the stronger the damper.

The bound on f_w supposes that the next move is no longer than the last.  It may be: the hand
that stands still for a sample inside, where the bound is infinite, and then leaps out takes
up to K x² for the ½ K x² that it paid.  The tank then owes, and no second leap is given
before it is paid.
"""

from __future__ import annotations

from dataclasses import dataclass
from typing import ClassVar

from zwidth.errors import InputError
from zwidth.model.rendering.reading import damping_per_sample
from zwidth.model.rendering.rendering_law import LoopContext, RenderingLaw
from zwidth.native.compiled import Array, compiled
from zwidth.quantity.exact import Exact
from zwidth.quantity.glossary import Quantity
from zwidth.quantity.parameter import CertainOrNone, parameter
from zwidth.quantity.text import told

ENERGY_TANK = 21.0

_LEVEL, _REFILL, _MOST = range(3)
_BEFORE, _ENERGY = range(2)


@dataclass(frozen=True, kw_only=True)
class EnergyTank(RenderingLaw):
    """``|f| ≤ H/(|v| T)`` and 0 where the tank H is empty; a damper ``d = α max(0, H_d − H)`` refills it.

    Proved, for d ≤ b: the energy taken out is never more than ``|f_w| (|Δx'| − |Δx|)`` of one sample, f_w the
    wall's part, Δx the move before it and Δx' the move under it, towards the outside.  So none comes out
    where no such move is longer than the one before.  Refuted for other hands, and without any limit
    where d may exceed b: docs, "Laws that bound the force".  Hypotheses: an encoder without counts; no
    delay, regular samples, no law behind this one, an amplifier without lag.

    Parameters
    ----------
    level
        H_d, the energy that the damper fills the tank to [J]; None: what the wall stores at the
        device's force limit F, F²/(2K).
    refill
        α, damping of the damper per energy that is missing [N·s/m per J; N·m·s/rad per J]; None: b/H_d.
    largest_damping
        Of the damper [N·s/m; N·m·s/rad]; None: b of the device, the most that is proved.

    Raises
    ------
    InputError
        If a number is not positive; when it is simulated, if a default has nothing to be computed from.
    """

    code: ClassVar[float] = ENERGY_TANK
    state_size: ClassVar[int] = 2

    level: CertainOrNone = parameter(
        "energy",
        None,
        kept=Exact,
        bound="> 0",
        why="it is the energy that the tank is filled to",
        meaning="H_d, to which the tank is filled",
    )
    refill: CertainOrNone = parameter(
        Quantity("refill", "α", "s/m^2", "N*m*s/rad/J", "α, damping per lacking energy"),
        None,
        kept=Exact,
        bound="> 0",
        why="without it the tank never fills",
    )
    largest_damping: CertainOrNone = parameter(
        "virtual_damping",
        None,
        kept=Exact,
        bound="> 0",
        why="without a damper the tank never fills",
        meaning="d, by default the device's",
    )

    def numbers(self, at: LoopContext) -> list[float]:
        """As the step reads them.

        Raises
        ------
        InputError
            If a default has nothing to be computed from.
        """
        level = _stored_at_the_limit(at) if self.level is None else float(self.level)
        most = (
            damping_per_sample(at, "an energy tank without largest_damping")
            if self.largest_damping is None
            else float(self.largest_damping) / at.period
        )
        if self.refill is None:
            return [level, damping_per_sample(at, "an energy tank without refill") / level, most]
        return [level, float(self.refill) / at.period, most]

    def describe(self, motion: str = "linear") -> str:
        """The law with its numbers, in a few words."""
        unit = self._unit("largest_damping", motion)
        said = (
            ("to", self.level, "J", ""),
            ("refill", self.refill, unit, " per J"),
            ("at most", self.largest_damping, unit, ""),
        )
        parts = [f"{word} {told(value, of)}{more}" for word, value, of, more in said if value is not None]
        return f"energy tank ({', '.join(parts)})" if parts else "energy tank"


def _stored_at_the_limit(at: LoopContext) -> float:
    if at.device.force_limit is None or at.stiffness <= 0.0:
        raise InputError(
            "level, the energy that the tank is filled to, has no default here: it is F²/(2K), and "
            "the device has no force_limit or the environment no stiffness; give level in J"
        )
    return float(at.device.exact("force_limit")) ** 2 / (2 * at.stiffness)


@compiled
def step(p: Array, i: int, s: Array, j: int, x: float, force: float, applied: float) -> float:
    """One sample; p from i and s from j on are this law's, `applied` is the force that was held."""
    moved = x - s[j + _BEFORE]
    energy = s[j + _ENERGY] + applied * moved
    s[j + _BEFORE], s[j + _ENERGY] = x, energy
    damping = min(p[i + _REFILL] * max(p[i + _LEVEL] - energy, 0.0), p[i + _MOST])
    if energy <= 0.0:
        force = 0.0
    elif abs(force * moved) > energy:
        force = energy / abs(moved) if force > 0.0 else -energy / abs(moved)
    total: float = force + damping * moved
    return total
