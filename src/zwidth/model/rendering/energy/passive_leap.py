"""Energy-consistent sampling: the wall's spring holds exactly the energy that came in.

    E ← E + f Δx + (b/T) Δx² + f_c |Δx|           exact behind a hold: f was held
    |f| ≤ √(2 K E),   0 where E ≤ 0

The first line is that of Stramigioli, Secchi, van der Schaft & Fantuzzi (2005); the second
is derived for this project.  The spring of the wall is put into the state that stores E,
f = √(2 K E), wherever K x would store more; where it stores less the wall is as it was, and
the rest is kept.  Friction of the device is counted: a spring that holds nothing pushes with
nothing, takes nothing in, and without it would never begin.

What can come out: for K ≤ 2b/T the wall is never changed, and passive.  A stiffer one can
give out, in one move of f T/(2b), at most f² (T/(4b) − 1/(2K)) more than came in.  That is
booked, E < 0, and the hand feels the wall gone until friction has paid for it.  With 2b/T
for K nothing can: that is force bounding.
"""

from __future__ import annotations

from dataclasses import dataclass
from math import sqrt
from typing import ClassVar

from zwidth.errors import InputError
from zwidth.model.rendering.reading import damping_per_sample
from zwidth.model.rendering.rendering_law import LoopContext, RenderingLaw
from zwidth.model.rendering.theorem import Theorem, half_a_step
from zwidth.native.compiled import Array, compiled
from zwidth.quantity.exact import Exact
from zwidth.quantity.parameter import CertainOrNone, flag, parameter

PASSIVE_LEAP = 23.0

_STIFFNESS, _PAID, _FRICTION, _RESETS = range(4)
_BEFORE, _ENERGY = range(2)


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

    stiffness: CertainOrNone = parameter(
        "stiffness",
        None,
        kept=Exact,
        bound="> 0",
        why="the spring keeps the energy",
        meaning="K of that spring, by default the environment's",
    )
    resets: bool = flag("to forget credit where there was no force", False)

    def numbers(self, at: LoopContext) -> list[float]:
        """As the step reads them.

        Raises
        ------
        InputError
            If there is no stiffness, or the device has no damping.
        """
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
        """The law with its numbers, in a few words."""
        parts = [] if self.stiffness is None else [f"a spring of {self.with_unit('stiffness', motion)}"]
        parts += ["resets"] if self.resets else []
        return f"passive leap ({', '.join(parts)})" if parts else "passive leap"


@compiled
def step(p: Array, i: int, s: Array, j: int, x: float, force: float, applied: float) -> float:
    """One sample; p from i and s from j on are this law's, `applied` is the force that was held."""
    moved = x - s[j + _BEFORE]
    energy = s[j + _ENERGY]
    if p[i + _RESETS] > 0.0 and applied == 0.0:
        energy = min(energy, 0.0)
    energy += applied * moved + p[i + _PAID] * moved * moved + p[i + _FRICTION] * abs(moved)
    s[j + _BEFORE], s[j + _ENERGY] = x, energy
    room = sqrt(2 * p[i + _STIFFNESS] * max(energy, 0.0))
    bounded: float = min(max(force, -room), room)
    return bounded
