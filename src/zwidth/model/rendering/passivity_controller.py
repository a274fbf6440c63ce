"""Passivity observer and controller: software friction of just the size that the energy lacks.

Observer, in the energy that the hand has put in (sampled: the force that was held acts
on the move that followed, which is exact behind a hold):

    E_k = E_{k−1} + f_{k−1} (x_k − x_{k−1}) [+ f_c |Δx| + (b/T) Δx²]

Controller, Δx_k = x_k − x_{k−1} taken for the move to come:

    lack = E_ref − (E_k + f_k Δx_k)      "past": E_ref − E_k, what has come out already
    f_k ← f_k + lack/Δx_k    where lack > 0,  |lack/Δx_k| ≤ α |Δx_k|/T and ≤ F

Published in series form by Hannaford & Ryu (2002), with the observer that pairs f_k with
the move before it; with the exact observer by Ryu, Kim & Hannaford (2004).

Without α a hand takes out what it likes: lack/Δx_k of a small move is held over a large one.  With
α it takes out of the controller (α/T) Σ |Δx_k Δx_{k+1}| ≤ (α/T) Σ Δx² at most, and the device's
damping takes (b/T) Σ Δx² in, at least.  So α = b by default, and b − K (T/2 + delay) before a spring wall
that this leaves something of.  Derived: docs, "Passivity controllers".
"""

from __future__ import annotations

from dataclasses import dataclass
from fractions import Fraction
from math import exp
from typing import ClassVar, Literal

from zwidth.errors import InputError
from zwidth.model.device.device import Device
from zwidth.model.environment.environment import Environment
from zwidth.model.environment.wall import wall_of
from zwidth.model.rendering.reading import below
from zwidth.model.rendering.rendering_law import LoopContext, RenderingLaw
from zwidth.native.compiled import Array, compiled
from zwidth.quantity.exact import Exact, RealLike, ends
from zwidth.quantity.parameter import Certain, CertainOrNone, Parametric, Reads, exact, flag, parameter, word
from zwidth.quantity.text import shown

# How far a controller may go: a number, what the device or the body pays for, or "unlimited" in words.
#
# None           what follows from the loop: b of the device, less K (T/2 + delay), what a spring wall that
#                is passive by itself has spent of it; T/(2M) of the virtual body
# "unlimited"    no limit; only where it is asked for by that word

Limit = Exact | Literal["unlimited"] | None

UNLIMITED: Literal["unlimited"] = "unlimited"

NO_LIMIT = 1e300
"""Of a controller without one, as the steps read it: more than any force or damping."""


WHY_A_LIMIT = (
    'it limits what the controller adds; leave it out for what the loop can bear, or say "unlimited"'
)


def largest_damping(given: Limit, device: Device, spring: Exact | None) -> Fraction | None:
    """α of a controller [N·s/m; N·m·s/rad]: as given, or what the device pays for; None: unlimited.

    That is b − K (T/2 + delay) before a spring of K [N/m; N·m/rad] that leaves something of b, so that a
    wall that is proved stays proved where there is no delay; otherwise b.  Of intervals it is the largest
    of any device within.
    """
    if given == UNLIMITED:
        return None
    if given is not None:
        return Exact(given).fraction
    least, most = ends(device.damping)
    if not most > 0:
        raise InputError(
            f"largest_damping was not given and is otherwise b of the device, and {device.name} has none: "
            "nothing would pay for what the controller gives to a hand that turns back; give the damping "
            'that was measured, or largest_damping, or largest_damping="unlimited" for no limit at all'
        )
    stiffness = Fraction(0) if spring is None else spring.fraction
    early, late = (
        period / 2 + delay
        for period, delay in zip(ends(device.sample_period), ends(device.delay), strict=True)
    )
    return most - stiffness * early if least >= stiffness * late else most


def spring_of(environment: Environment) -> Exact | None:
    """K of a wall that is a spring and nothing else; None of all others."""
    wall = wall_of(environment)
    if wall is None or wall.damping:
        return None
    return wall.stiffness if isinstance(wall.stiffness, Exact) else None


def as_read(alpha: Fraction | None) -> float:
    """A limit as the steps read it, rounded down."""
    return NO_LIMIT if alpha is None else below(alpha)


def said(controller: Parametric, name: str, otherwise: str, motion: str = "linear") -> str:
    """One of its limits in a few words; `otherwise` where it was not given."""
    if getattr(controller, name) == UNLIMITED:
        return "no limit: a hand can take out any energy"
    return f"at most {controller.with_unit(name, motion) or otherwise}"


PASSIVITY_CONTROLLER = 1.0

_PERIOD, _DAMPING, _FORCE, _FLOOR, _OBSERVER = range(5)
_FRICTION, _DRAG, _REFERENCE, _RESETS, _CEILING, _KEPT = range(5, 11)
_BEFORE, _ENERGY, _ADDED, _MOVED = range(4)

OBSERVERS = ("sampled", "past", "published")
"""In the order of the numbers that the step knows them by."""

_SAMPLED, _PAST, _PUBLISHED = 0.0, 1.0, 2.0

Observer = Literal["sampled", "past", "published"]


@dataclass(frozen=True, kw_only=True)
class PassivityController(RenderingLaw):
    """Passivity observer and controller in series, ``f ← f + (E_ref − E − f Δx)/Δx`` where that dissipates.

    Parameters
    ----------
    observer
        "sampled": the held force is paired with the move that follows it, exact behind a hold without
        delay; the move to come is taken to be like the last.  "past": the same count without the move to
        come; what has come out is absorbed afterwards.  "published": paired with the move before it
        (Hannaford & Ryu 2002), which takes the leak of the hold for dissipation.
    largest_damping
        α, the damping that the controller adds at most [N·s/m; N·m·s/rad]; None: b of the device, which
        pays for it; less K (T/2 + delay) for a spring wall that is passive by itself.
        "unlimited": no limit, as published; a hand can then take out any energy.
    largest_force
        What it adds at most [N; N·m]; None: no limit but α.  What it cannot pay is carried over.
    slowest
        Speed below which it does nothing [m/s; rad/s]: there counts of the encoder make
        its force large and rough.
    credit
        True to count in what the device dissipates by its own b and f_c.
    reference
        "zero", or "spring" for the energy ½ K x² that the environment's spring stores at x:
        the controller then acts as soon as the hand has put in less (Ryu et al. 2005).
    resets
        True to set the energy to 0 where the law pushes no force: the hand then begins each
        contact without credit from the one before.
    ceiling
        Energy above which no credit is kept [J], ≥ 0: what was dissipated long ago cannot hide
        what comes out now; None: all is kept.

    forgetting
        Time constant in which credit is forgotten, E ← E e^{−T/τ} where E > 0 [s], > 0; a debt never
        is.  None: nothing is forgotten.

    Raises
    ------
    InputError
        If a number is not positive, or a word is not one of these; when it is simulated, if `largest_damping`
        was not given and the device has no damping,
        or the reference is a spring's energy and the environment has no stiffness.
    """

    code: ClassVar[float] = PASSIVITY_CONTROLLER
    state_size: ClassVar[int] = 4

    observer: Observer = word(*OBSERVERS)
    largest_damping: Reads[Limit, RealLike | None] = parameter(
        "virtual_damping",
        None,
        kept=Exact,
        bound="> 0",
        why=WHY_A_LIMIT,
        meaning='α, what it adds at most, by default b of the device; or "unlimited"',
        words=(UNLIMITED,),
    )
    largest_force: CertainOrNone = exact(
        "force", None, "> 0", "it limits what the controller adds; None: none", "what it adds at most"
    )
    slowest: Certain = exact(
        "speed", 0, "≥ 0", "it is a speed below which nothing is added", "speed below which it adds nothing"
    )
    credit: bool = flag("to count in what the device dissipates", False)
    reference: Literal["zero", "spring"] = word("zero", "spring")
    resets: bool = flag("to count anew in each contact", False)
    ceiling: CertainOrNone = exact(
        "energy", None, "≥ 0", "it is the energy that is kept at most", "energy above which no credit is kept"
    )
    forgetting: CertainOrNone = exact(
        "time_constant",
        None,
        "> 0",
        "it is the time in which credit is forgotten",
        "time constant in which credit is forgotten",
    )

    def numbers(self, at: LoopContext) -> list[float]:
        if self.reference == "spring" and at.stiffness <= 0:
            raise InputError(
                'reference="spring" needs an environment with a stiffness; this has none: '
                f"{at.environment.describe()}"
            )
        friction, damping = (
            float(at.device.exact(key)) if self.credit else 0.0 for key in ("coulomb_friction", "damping")
        )
        period = at.period
        return [
            period,
            as_read(largest_damping(self.largest_damping, at.device, spring_of(at.environment))),
            NO_LIMIT if self.largest_force is None else float(self.largest_force),
            float(self.slowest) * period,
            float(OBSERVERS.index(self.observer)),
            friction,
            damping / period,
            at.stiffness / 2 if self.reference == "spring" else 0.0,
            float(self.resets),
            NO_LIMIT if self.ceiling is None else float(self.ceiling),
            1.0 if self.forgetting is None else exp(-period / float(self.forgetting)),
        ]

    def most_damping(self, device: Device, spring: Exact | None) -> Fraction | None:
        return largest_damping(self.largest_damping, device, spring)

    def describe(self, motion: str = "linear") -> str:
        parts = [f"{self.observer} observer", said(self, "largest_damping", "b of the device", motion)]
        if self.largest_force is not None:
            parts.append(f"at most {self.with_unit('largest_force', motion)}")
        parts += [word for word, said in (("device credited", self.credit), ("resets", self.resets)) if said]
        if self.forgetting is not None:
            parts.append(f"forgets credit in {shown(float(self.forgetting), 's', 6)}")
        if self.reference == "spring":
            parts.append("the spring's energy as reference")
        return f"passivity controller ({', '.join(parts)})"


@compiled
def passivity_controller_step(
    p: Array, i: int, s: Array, j: int, x: float, force: float, applied: float
) -> float:
    """One sample; p from i and s from j on are this law's, `applied` is the force that was held."""
    moved = x - s[j + _BEFORE]
    before = s[j + _ENERGY]
    if before > 0.0:
        before *= p[i + _KEPT]
    lost = p[i + _FRICTION] * abs(moved) + p[i + _DRAG] * moved * moved
    if p[i + _OBSERVER] == _PUBLISHED:
        energy = before + force * moved + s[j + _ADDED] * s[j + _MOVED] + lost
        ahead = energy
    else:
        energy = before + applied * moved + lost
        ahead = energy + force * moved if p[i + _OBSERVER] == _SAMPLED else energy
    if p[i + _RESETS] > 0.0 and force == 0.0:
        energy, ahead = 0.0, 0.0
    energy = min(energy, p[i + _CEILING])
    inside = max(x, 0.0)
    lack = p[i + _REFERENCE] * inside * inside - min(ahead, p[i + _CEILING])
    added = 0.0
    if lack > 0.0 and abs(moved) > p[i + _FLOOR]:
        most = min(p[i + _DAMPING] * abs(moved) / p[i + _PERIOD], p[i + _FORCE])
        added = min(lack / abs(moved), most)
        if moved < 0.0:
            added = -added
    s[j + _BEFORE], s[j + _ENERGY], s[j + _ADDED], s[j + _MOVED] = x, energy, added, moved
    return force + added
