"""How far a controller may go: a number, what the device or the body pays for, or "unlimited" in words.

None           what follows from the loop: b of the device, less what a spring wall that is passive by itself
               has spent of it, K (T/2 + delay); T/(2M) of the virtual body
"unlimited"    no limit; only where it is asked for by that word
"""

from __future__ import annotations

from fractions import Fraction
from typing import Literal

from zwidth.errors import InputError
from zwidth.model.device.device import Device
from zwidth.model.environment.environment import Environment
from zwidth.model.environment.wall import wall_of
from zwidth.model.rendering.reading import below
from zwidth.quantity.exact import Exact, ends
from zwidth.quantity.parameter import Parametric

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
