"""Intervals: which single values of the parameters decide for all of them.

More damping and Coulomb friction never hurt, a finer encoder never hurts, and
mass plays no part: one end of each decides.  For the parameters of the law and
the loop's timing the requirement is monotone or convex, so that the corners of
the box decide, in these cases and no others:

* K and B of a wall, with any velocity filter and delay, at one T: the required
  damping is a supremum of convex functions of (K, B), and ‖h‖₁ is convex;
* the elastic spring of a viscoelastic solid (it adds K to H), likewise;
* T and delay too, for a spring: b* = (KT/4)[2d+1+2α + √((2d+1)² + 8α(d+1))]
  increases in K, T and the delay;
* T for a backward-difference wall without delay: K T/2 + |B| increases and
  (K + 2|B|/T) Δ/2 decreases in T, so both ends are kept.
"""

from __future__ import annotations

from collections.abc import Iterator
from dataclasses import fields
from fractions import Fraction
from itertools import product

from zwidth.device import Device
from zwidth.environment import BackwardDifference, GeneralizedMaxwell, StandardLinearSolid, Wall
from zwidth.environment.environment import Environment
from zwidth.quantity.exact import Exact, Interval, ends

Loop = tuple[Device, Environment]


def worst_corners(device: Device, environment: Environment) -> list[Loop] | None:
    """Certain loops that are all passive exactly if every loop in the box is; None if not known."""
    device = _ends(device, damping=0, coulomb_friction=0, resolution=1)
    if not _box_is_decided_by_corners(device, environment):
        return None
    return list(_corners(device, environment))


def best_corner(device: Device, environment: Environment) -> Loop | None:
    """The loop that is active only if every loop in the box is; None if not known."""
    device = _ends(device, damping=1, coulomb_friction=1, resolution=0)
    if device_is_certain(device) and environment.is_certain:
        return device, environment
    spring = environment.spring and isinstance(environment, Wall)
    backward = isinstance(environment, Wall) and isinstance(environment.velocity_filter, BackwardDifference)
    if not (spring or (backward and ends(device.delay) == (0, 0) and ends(device.resolution) == (0, 0))):
        return None
    assert isinstance(environment, Wall)
    low, high = ends(environment.damping)
    least = Fraction(0) if low <= 0 <= high else min(low, high, key=abs)
    device = _ends(device, sample_period=0, delay=0)
    return device, environment.replace(stiffness=Exact(ends(environment.stiffness)[0]), damping=Exact(least))


def device_is_certain(device: Device) -> bool:
    """True when nothing that a criterion depends on is an interval."""
    keys = ("damping", "coulomb_friction", "resolution", "sample_period", "delay")
    return not any(isinstance(getattr(device, key), Interval) for key in keys)


def _ends(device: Device, **which: int) -> Device:
    """The device with the low (0) or the high (1) end of the named parameters."""
    chosen = {key: Exact(ends(getattr(device, key))[end]) for key, end in which.items()}
    return device.replace(**chosen)


def _box_is_decided_by_corners(device: Device, environment: Environment) -> bool:
    uncertain = {f.name for f in fields(environment) if isinstance(getattr(environment, f.name), Interval)}
    timing = {key for key in ("sample_period", "delay") if isinstance(getattr(device, key), Interval)}
    wall = isinstance(environment, Wall)
    additive = {"stiffness", "damping"} if wall else {"stiffness"}
    known = isinstance(environment, (Wall, StandardLinearSolid, GeneralizedMaxwell))
    if not known and not environment.is_certain:
        return False
    if uncertain - additive or not _parts_are_certain(environment, uncertain):
        return False
    if not timing:
        return True
    if environment.spring and wall:
        return True
    backward = isinstance(environment, Wall) and isinstance(environment.velocity_filter, BackwardDifference)
    return backward and timing == {"sample_period"} and ends(device.delay) == (0, 0)


def _parts_are_certain(environment: Environment, uncertain: set[str]) -> bool:
    """No interval hides in a filter, a branch or an inner environment."""
    certain = environment.replace(**{name: Exact(ends(getattr(environment, name))[1]) for name in uncertain})
    velocity = getattr(environment, "velocity_filter", None)
    return certain.is_certain and not isinstance(getattr(velocity, "time_constant", None), Interval)


def _corners(device: Device, environment: Environment) -> Iterator[Loop]:
    timing = [_values(getattr(device, key)) for key in ("sample_period", "delay")]
    names = [f.name for f in fields(environment) if isinstance(getattr(environment, f.name), Interval)]
    laws = [_values(getattr(environment, name)) for name in names]
    for (period, delay), values in product(product(*timing), product(*laws)):
        changed = dict(zip(names, values, strict=True))
        yield (
            device.replace(sample_period=period, delay=delay),
            environment.replace(**changed) if changed else environment,
        )


def _values(value: Exact | Interval) -> list[Exact]:
    return [value.low, value.high] if isinstance(value, Interval) else [value]
