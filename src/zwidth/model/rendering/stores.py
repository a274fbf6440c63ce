"""Laws that count the energy in a store: an energy tank, energy-consistent sampling.

Energy tank in two layers: the wall pushes with what is in the tank, a damper refills it.

    H ← H + f Δx                              what the hand has put in; f, all of it, was held
    |f_w| ≤ H/|Δx|,  0 where H ≤ 0            the wall's part; Δx the move just made
    f = f_w + d Δx/T,  d = α max(0, H_d − H), d ≤ b

after Franken, Stramigioli et al. (2011); the bound d ≤ b is of this project: without it a hand that goes to
and fro gets more out of the damper than the device takes, and the emptier the tank the stronger the damper.

The bound on f_w supposes that the next move is no longer than the last.  It may be: the hand that stands
still for a sample inside, where the bound is infinite, and then leaps out takes up to K x² for the ½ K x²
that it paid.  The tank then owes, and no second leap is given before it is paid.
"""

from __future__ import annotations

from dataclasses import dataclass
from math import sqrt
from typing import ClassVar

from zwidth.errors import InputError
from zwidth.model.rendering.reading import damping_per_sample
from zwidth.model.rendering.rendering_law import LoopContext, RenderingLaw, Theorem, half_a_step
from zwidth.native.compiled import Array, compiled
from zwidth.quantity.exact import Exact
from zwidth.quantity.glossary import Quantity
from zwidth.quantity.parameter import CertainOrNone, exact, flag
from zwidth.quantity.text import shown

ENERGY_TANK = 21.0

_LEVEL, _REFILL, _MOST = range(3)
_TANK_BEFORE, _TANK_ENERGY = range(2)


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

    level: CertainOrNone = exact(
        "energy",
        None,
        "> 0",
        "it is the energy that the tank is filled to",
        "H_d, to which the tank is filled",
    )
    refill: CertainOrNone = exact(
        Quantity("refill", "α", "s/m^2", "N*m*s/rad/J", "α, damping per lacking energy"),
        None,
        "> 0",
        "without it the tank never fills",
    )
    largest_damping: CertainOrNone = exact(
        "virtual_damping", None, "> 0", "without a damper the tank never fills", "d, by default the device's"
    )

    def numbers(self, at: LoopContext) -> list[float]:
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
        unit = self._unit("largest_damping", motion)
        said = (
            ("to", self.level, "J", ""),
            ("refill", self.refill, unit, " per J"),
            ("at most", self.largest_damping, unit, ""),
        )
        parts = [f"{word} {shown(value, of, 6)}{more}" for word, value, of, more in said if value is not None]
        return f"energy tank ({', '.join(parts)})" if parts else "energy tank"


def _stored_at_the_limit(at: LoopContext) -> float:
    if at.device.force_limit is None or at.stiffness <= 0.0:
        raise InputError(
            "level, the energy that the tank is filled to, has no default here: it is F²/(2K), and "
            "the device has no force_limit or the environment no stiffness; give level in J"
        )
    return float(at.device.exact("force_limit")) ** 2 / (2 * at.stiffness)


@compiled
def energy_tank_step(p: Array, i: int, s: Array, j: int, x: float, force: float, applied: float) -> float:
    """One sample; p from i and s from j on are this law's, `applied` is the force that was held."""
    moved = x - s[j + _TANK_BEFORE]
    energy = s[j + _TANK_ENERGY] + applied * moved
    s[j + _TANK_BEFORE], s[j + _TANK_ENERGY] = x, energy
    damping = min(p[i + _REFILL] * max(p[i + _LEVEL] - energy, 0.0), p[i + _MOST])
    if energy <= 0.0:
        force = 0.0
    elif abs(force * moved) > energy:
        force = energy / abs(moved) if force > 0.0 else -energy / abs(moved)
    total: float = force + damping * moved
    return total


# Energy-consistent sampling: the wall's spring holds exactly the energy that came in.
#
#     E ← E + f Δx + (b/T) Δx² + f_c |Δx|           exact behind a hold: f was held
#     |f| ≤ √(2 K E),   0 where E ≤ 0
#
# The first line is that of Stramigioli, Secchi, van der Schaft & Fantuzzi (2005); the second
# is derived for this project.  The spring of the wall is put into the state that stores E,
# f = √(2 K E), wherever K x would store more; where it stores less the wall is as it was, and
# the rest is kept.  Friction of the device is counted: a spring that holds nothing pushes with
# nothing, takes nothing in, and without it would never begin.
#
# What can come out: for K ≤ 2b/T the wall is never changed, and passive.  A stiffer one can give out, in one
# move of f T/(2b), at most f² (T/(4b) − 1/(2K)) more than came in.  That is booked, E < 0, and the hand feels
# the wall gone until friction has paid for it.  With 2b/T for K nothing can: that is force bounding.

PASSIVE_LEAP = 23.0

_STIFFNESS, _PAID, _FRICTION, _RESETS = range(4)
_LEAP_BEFORE, _LEAP_ENERGY = range(2)


@dataclass(frozen=True, kw_only=True)
class PassiveLeap(RenderingLaw):
    """``|f| ≤ √(2 K E)``: the force of a spring that stores what the hand has put in, to the joule.

    Proved: no hand takes out more than f² (T/(4b) − 1/(2K)), f the largest force, at any time; nothing
    where K ≤ 2b/T.  Refuted for stiffer walls: one leap out takes just that (where f_c = 0).  Hypotheses:
    the device takes at least b and f_c; an encoder without counts; no delay, regular samples, no law
    behind this one, an amplifier without lag; for steps ΔF of the converter K ≤ 2b/T and f_c ≥ ΔF/2.

    Parameters
    ----------
    stiffness
        K of the spring that the energy is kept in [N/m; N·m/rad]; None: the environment's.
    resets
        True to forget credit, not debt, where the force was 0: the hand then begins each contact without
        credit for what its free motion dissipated.

    Raises
    ------
    InputError
        If stiffness is not > 0, or resets not True or False; when it is simulated, if there is no
        stiffness or the device has no damping.
    """

    code: ClassVar[float] = PASSIVE_LEAP
    state_size: ClassVar[int] = 2

    stiffness: CertainOrNone = exact(
        "stiffness",
        None,
        "> 0",
        "the spring keeps the energy",
        "K of that spring, by default the environment's",
    )
    resets: bool = flag("to forget credit where there was no force", False)

    def numbers(self, at: LoopContext) -> list[float]:
        stiffness = at.stiffness if self.stiffness is None else float(self.stiffness)
        if stiffness <= 0.0:
            raise InputError(
                "stiffness has no default here, the environment has none: give the K of the spring that "
                f"the energy is kept in; the environment is {at.environment.describe()}"
            )
        friction = float(at.device.exact("coulomb_friction"))
        return [stiffness, damping_per_sample(at, "a passive leap"), friction, float(self.resets)]

    def theorem(self, at: LoopContext) -> Theorem | None:
        """Where the device renders the spring anyway, and friction pays for the steps of the converter."""
        own = self.stiffness if self.stiffness is not None else getattr(at.environment, "stiffness", None)
        limit = 2 * at.device.exact("damping") / at.device.exact("sample_period")
        if not isinstance(own, Exact) or own.fraction > limit:
            return None
        return Theorem(
            statement="K ≤ 2b/T: no move takes out more than what the spring is known to hold",
            counts_force_steps=True,
            counts_force_limit=True,
            coulomb_friction=half_a_step(at.device),
        )

    def describe(self, motion: str = "linear") -> str:
        parts = [] if self.stiffness is None else [f"a spring of {self.with_unit('stiffness', motion)}"]
        parts += ["resets"] if self.resets else []
        return f"passive leap ({', '.join(parts)})" if parts else "passive leap"


@compiled
def passive_leap_step(p: Array, i: int, s: Array, j: int, x: float, force: float, applied: float) -> float:
    """One sample; p from i and s from j on are this law's, `applied` is the force that was held."""
    moved = x - s[j + _LEAP_BEFORE]
    energy = s[j + _LEAP_ENERGY]
    if p[i + _RESETS] > 0.0 and applied == 0.0:
        energy = min(energy, 0.0)
    energy += applied * moved + p[i + _PAID] * moved * moved + p[i + _FRICTION] * abs(moved)
    s[j + _LEAP_BEFORE], s[j + _LEAP_ENERGY] = x, energy
    room = sqrt(2 * p[i + _STIFFNESS] * max(energy, 0.0))
    bounded: float = min(max(force, -room), room)
    return bounded
