"""Intervals: which single values of the parameters decide for all of them.

More damping and Coulomb friction never hurt, a finer encoder never hurts, and
mass plays no part: one end of each decides.  The other parameters are decided
by the corners of their box where the requirements are convex or monotone in
each of them separately, since such a function is largest at a corner:

* K and B of a wall with any velocity filter and delay, and the elastic spring
  of a viscoelastic solid: they enter H linearly, the required damping is a
  supremum of convex functions of H, and ‖h‖₁ is convex;
* T and the delay of a spring: b* = (KT/4)[2d+1+2α + √((2d+1)² + 8α(d+1))]
  increases in K, T and the delay, and K Δ/2 does not depend on them;
* T of a wall without delay whose velocity filter is fixed in samples: the
  requirement is K T/2 plus a constant, and ‖h‖₁ is convex in 1/T;
* T of a fixed H(z) without delay: the requirement is proportional to T;
* every parameter of a standard linear solid (backward, Tustin) and of a wall
  with a one-pole filter and B ≥ 0, without delay: the required damping is
  μ0T/2 + μ1η1T/(2η1+μ1T), (T/2)(μ0+μ1) and KT/2 + B T/(2τ+T), and ‖h‖₁ is
  μ0 + 2μ1η1/(μ1T+η1), μ0 + μ1 max(1, 4η1/(μ1T+2η1)) and K + 2B/(T+τ);
* every parameter of a wall without delay for which the conditions for contact
  made and broken hold at every corner: they increase in K and |B|, the one for
  b in T, the one for f_c in 1/T and 1/(T+τ).  What the multiplier asks for is never
  more, and does so as well: K T/2 + |B| times a number of the filter, for one pole
  one that falls with τ/T.

Elsewhere the corners are still looked at, but prove nothing for what is between.
"""

from __future__ import annotations

from collections.abc import Iterator
from dataclasses import fields, is_dataclass
from fractions import Fraction
from itertools import product
from typing import Any

from zwidth.device import Device
from zwidth.environment import (
    BackwardDifference,
    GeneralizedMaxwell,
    OnePole,
    PulseTransferFunction,
    StandardLinearSolid,
    Wall,
)
from zwidth.environment.environment import Environment
from zwidth.errors import InputError
from zwidth.quantity.exact import Exact, Interval, ends

Loop = tuple[Device, Environment]

MOST_CORNERS = 64
_TIMING = ("sample_period", "delay")


def worst_corners(device: Device, environment: Environment) -> list[Loop]:
    """The certain loops at the corners of the box of parameters.

    Raises
    ------
    InputError
        If more than six parameters of law and timing are intervals.
    """
    device = _at_ends(device, damping=0, coulomb_friction=0, resolution=1)
    timings = [_values(getattr(device, key)) for key in _TIMING]
    laws = list(_variants(environment))
    if len(laws) * len(timings[0]) * len(timings[1]) > MOST_CORNERS:
        raise InputError(
            f"the intervals have more than {MOST_CORNERS} corners; give single values for some parameters"
        )
    return [
        (device.replace(sample_period=period, delay=delay), law)
        for period, delay, law in product(*timings, laws)
    ]


def corners_decide(device: Device, environment: Environment, contact: bool = False) -> bool:
    """True when passivity at every corner proves it for every value in the box.

    `contact` is True when every corner is covered with contact made and broken.
    """
    uncertain = _uncertain_fields(environment)
    timing = {key for key in _TIMING if isinstance(getattr(device, key), Interval)}
    if not uncertain and not timing:
        return True
    undelayed = ends(device.delay) == (0, 0)
    if isinstance(environment, Wall):
        return (contact and undelayed) or _wall(environment, uncertain, timing, undelayed)
    if isinstance(environment, StandardLinearSolid):
        return (uncertain <= {"stiffness"} and not timing) or (undelayed and _has_closed_form(environment))
    if isinstance(environment, GeneralizedMaxwell):
        return uncertain <= {"stiffness"} and not timing
    return isinstance(environment, PulseTransferFunction) and undelayed and not uncertain


def _wall(wall: Wall, uncertain: set[str], timing: set[str], undelayed: bool) -> bool:
    if wall.spring:
        return True
    filter_is_certain = "velocity_filter" not in uncertain
    if not timing and filter_is_certain:
        return True
    if not undelayed:
        return False
    if isinstance(wall.velocity_filter, OnePole):
        return ends(wall.damping)[0] >= 0
    return filter_is_certain


def _has_closed_form(solid: StandardLinearSolid) -> bool:
    positive = ends(solid.branch_stiffness)[0] >= 0 and ends(solid.branch_damping)[0] >= 0
    return positive and str(solid.discretization) in ("backward", "tustin")


def best_corner(device: Device, environment: Environment) -> Loop | None:
    """A loop that is active only if every loop in the box is; None where none is known."""
    device = _at_ends(device, damping=1, coulomb_friction=1, resolution=0)
    timing = any(isinstance(getattr(device, key), Interval) for key in _TIMING)
    if not timing and not _uncertain_fields(environment):
        return device, environment
    ideal_and_undelayed = ends(device.delay) == (0, 0) and ends(device.resolution) == (0, 0)
    if not isinstance(environment, Wall):
        return None
    backward = isinstance(environment.velocity_filter, BackwardDifference) and ideal_and_undelayed
    if not (environment.spring or backward) or (environment.clamped and not environment.spring):
        return None
    low, high = ends(environment.damping)
    least = Fraction(0) if low <= 0 <= high else min(low, high, key=abs)
    stiffness = Exact(ends(environment.stiffness)[0])
    return (
        _at_ends(device, sample_period=0, delay=0),
        environment.replace(stiffness=stiffness, damping=Exact(least)),
    )


def _at_ends(device: Device, **which: int) -> Device:
    """The device with the low (0) or the high (1) end of the named parameters."""
    uncertain = {key: end for key, end in which.items() if isinstance(getattr(device, key), Interval)}
    chosen = {key: Exact(ends(getattr(device, key))[end]) for key, end in uncertain.items()}
    return device.replace(**chosen) if chosen else device


def _uncertain_fields(part: Any) -> set[str]:
    """Fields in which an interval is found, at any depth."""
    return {f.name for f in fields(part) if len(list(_variants(getattr(part, f.name)))) > 1}


def _variants(value: Any) -> Iterator[Any]:
    """The value with every interval in it, at any depth, replaced by either end."""
    if isinstance(value, Interval):
        yield from (value.low, value.high)
    elif isinstance(value, tuple):
        yield from (tuple(choice) for choice in product(*(list(_variants(v)) for v in value)))
    elif is_dataclass(value) and not isinstance(value, type):
        yield from _variants_of_fields(value)
    else:
        yield value


def _variants_of_fields(value: Any) -> Iterator[Any]:
    names = [f.name for f in fields(value)]
    choices = [list(_variants(getattr(value, name))) for name in names]
    if all(len(choice) == 1 for choice in choices):
        yield value
        return
    for chosen in product(*choices):
        yield type(value)(**dict(zip(names, chosen, strict=True)))


def _values(value: Exact | Interval) -> list[Exact]:
    return [value.low, value.high] if isinstance(value, Interval) else [value]
