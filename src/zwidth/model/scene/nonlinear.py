"""Elements that are not linear: each is a monotone map from v̄ to f̄ in every state.

    f̄ = [V(d + T v̄) − V(d)]/(T v̄)      the mean force on the way, V convex

is the discrete gradient of a potential (Gonzalez 1996): what is taken in is V(d + T v̄) − V(d) exactly,
however stiff the spring and however long the step.
"""

from __future__ import annotations

from dataclasses import dataclass
from itertools import pairwise
from typing import ClassVar

from zwidth.errors import InputError
from zwidth.model.environment.environment import with_unit
from zwidth.model.environment.nonlinear import MOST_POINTS
from zwidth.model.scene.element import GIVES_OUT, Between, NonlinearLaw, label, node
from zwidth.quantity.parameter import Certain, Numbers, exact, listed

CONTACT, COULOMB, POINTS = 0.0, 1.0, 2.0
"""Which law the compiled step takes."""


@dataclass(frozen=True)
class Contact(Between):
    """A surface that pushes and never pulls, ``f = max(0, K δ + B dδ/dt)``, δ the depth.

    The first node meets the second from below: δ = max(0, y_first − y_second − gap).  Against "ground" it is
    a wall for motions towards +; with "ground" first, one for motions towards −.

    Parameters
    ----------
    first, second
        What touches what; "ground" for a wall.
    stiffness
        K > 0 [N/m; N·m/rad].
    damping
        B ≥ 0, of the depth [N·s/m; N·m·s/rad].  Default 0.
    gap
        How far apart they are at first; < 0 for a contact that is loaded [m; rad].  Default 0.
    name
        Its name in tables and plots; by default made of its nodes.
    """

    symbol: ClassVar[str] = "C"

    first: str = node("what touches")
    second: str = node("what is touched")
    stiffness: Certain = exact("stiffness", bound="> 0", why=GIVES_OUT)
    damping: Certain = exact("virtual_damping", 0, "≥ 0", "it would give out energy")
    gap: Certain = exact("position", 0, meaning="how far apart they are at first")
    name: str = label()

    @property
    def law(self) -> NonlinearLaw:
        return NonlinearLaw(CONTACT, (float(self.stiffness), float(self.damping), float(self.gap)))

    def describe(self, motion: str = "linear") -> str:
        numbers = [
            with_unit("stiffness", self.stiffness, motion),
            *([with_unit("virtual_damping", self.damping, motion)] if self.damping else []),
            *([f"gap {with_unit('position', self.gap, motion)}"] if self.gap else []),
        ]
        return f"{self.title} {', '.join(numbers)}"


@dataclass(frozen=True)
class CoulombFriction(Between):
    """Dry friction between two nodes, ``f = F sgn v``, any force up to F while they stick.

    Parameters
    ----------
    first, second
        What slides on what.
    force
        F > 0 [N; N·m].
    name
        Its name in tables and plots; by default made of its nodes.
    """

    symbol: ClassVar[str] = "F"

    first: str = node("what slides")
    second: str = node("what it slides on")
    force: Certain = exact("force", bound="> 0", why=GIVES_OUT, meaning="of dry friction")
    name: str = label()

    @property
    def title(self) -> str:
        return super().title.replace("coulombfriction", "friction")

    @property
    def law(self) -> NonlinearLaw:
        """F, and room for what the step makes of it."""
        return NonlinearLaw(COULOMB, (float(self.force), 0.0))

    def describe(self, motion: str = "linear") -> str:
        return f"{self.title} {with_unit('force', self.force, motion)}"


@dataclass(frozen=True)
class NonlinearSpring(Between):
    """A spring through points, linear between them and constant beyond, whose force never falls.

    Parameters
    ----------
    first, second
        Its ends; d = y_first − y_second.
    positions
        d_i, strictly increasing, 2 at least [m; rad].
    forces
        f_i, as many, nowhere decreasing, the first ≤ 0 and the last ≥ 0 [N; N·m]: then its energy has a
        least value and the step a single answer.
    name
        Its name in tables and plots; by default made of its nodes.
    """

    symbol: ClassVar[str] = "N"

    positions: Numbers = listed("position", meaning="stretches of the points, increasing")
    forces: Numbers = listed("force", meaning="forces at the points, nowhere decreasing")
    name: str = label()

    def __post_init__(self) -> None:
        super().__post_init__()
        x, f = ([n.fraction for n in numbers] for numbers in (self.positions, self.forces))
        if len(x) != len(f) or not 2 <= len(x) <= MOST_POINTS:
            raise InputError(
                f"a spring through points has from 2 to {MOST_POINTS} positions and a force at each; "
                f"got {len(x)} and {len(f)}"
            )
        if any(low >= high for low, high in pairwise(x)):
            raise InputError("positions must increase strictly: put the points in order")
        if any(low > high for low, high in pairwise(f)):
            raise InputError(
                "forces must not decrease with the position: between a detent's places of rest the force "
                "of a step has more than one answer; render such a spring as zwidth.NonlinearSpring"
            )
        if f[0] > 0 or f[-1] < 0:
            raise InputError(
                "forces must begin at 0 or below and end at 0 or above: otherwise the spring pushes away for "
                "ever and gives out energy without bound"
            )

    @property
    def title(self) -> str:
        return super().title.replace("nonlinearspring", "nonlinear spring")

    @property
    def law(self) -> NonlinearLaw:
        """How many points, their positions and their forces."""
        numbers = (float(len(self.positions)), *map(float, self.positions), *map(float, self.forces))
        return NonlinearLaw(POINTS, numbers)

    def describe(self, motion: str = "linear") -> str:
        low, high = (with_unit("position", x, motion) for x in (self.positions[0], self.positions[-1]))
        return f"{self.title} {len(self.positions)} points from {low} to {high}"
