"""A wall on a device whose proof covers laws in a chain.

The proof of a wall with virtual damping is one of |f − K u| ≤ B |v|, whatever the force beside K u is.  Laws
that add no more than α |Δx|/T in all are covered by a wall with B = α.  What compensates friction adds no
more than h + (C + s) |Δx|/T, a line above it: by a wall with C + s more, on a device with h less friction.
"""

from __future__ import annotations

from collections.abc import Callable, Iterator
from decimal import ROUND_CEILING, Context
from fractions import Fraction
from math import cosh, exp, tanh
from typing import NamedTuple

from zwidth.model.device import Device
from zwidth.model.environment.environment import Environment
from zwidth.model.environment.wall import Wall, wall_of
from zwidth.model.rendering.friction_compensation import FrictionCompensation
from zwidth.model.rendering.rendered import laws_of
from zwidth.quantity.balls import ball, middle, precision
from zwidth.quantity.exact import Exact, ends


def covering(device: Device, law: Environment) -> tuple[Device, Wall] | None:
    """The device and the wall whose proof is one of this law on this device; None where none is known."""
    chain, wall = laws_of(law), wall_of(law.met)
    if not chain or wall is None or wall.damping or wall.clamped:
        return None
    total = Fraction(0)
    compensation: list[FrictionCompensation] = []
    for n, link in enumerate(chain):
        if isinstance(link, FrictionCompensation):
            compensation.append(link)
            continue
        alone = n == 0 and isinstance(wall.stiffness, Exact)
        bound = link.most_damping(device, wall.stiffness if alone else None)
        if bound is None:
            return None
        total += bound
    if len(compensation) > 1:
        return None
    if not compensation:
        return device, wall.replace(damping=total)
    return _compensated(device, wall, compensation[0], total)


def _compensated(
    device: Device, wall: Wall, law: FrictionCompensation, damping: Fraction
) -> tuple[Device, Wall] | None:
    """Under the line that Coulomb friction pays for beside the encoder; None where it pays for none."""
    has, count, period = (device.exact(key) for key in ("coulomb_friction", "resolution", "sample_period"))
    stiffness = ends(wall.stiffness)[1]

    def missing(height: Fraction, slope: Fraction) -> Fraction:
        added = damping + law.viscous.fraction + slope
        return height + (stiffness + 2 * added / period) * count / 2 - has

    r = best_tangent(
        law,
        float(count / period / law.speed.fraction) if law.speed else 0.0,
        lambda height, slope: float(missing(Fraction(height), Fraction(slope))),
        lambda r: missing(*line_of(law, r)) <= 0,
    )
    line = line_of(law, r)
    if line.height > has:
        return None
    added = damping + law.viscous.fraction + line.slope
    less = device.replace(coulomb_friction=has - line.height) if line.height else device
    return less, wall.replace(damping=added)


# Friction lines: a tangent of F tanh(v/v_s) at tanh = r lies above it for every v > 0,
#
#     F tanh(v/v_s) ≤ h + s v,    s = (F/v_s)(1 − r²),    h = F (r − (1 − r²) artanh r)
#
# h is what it takes of Coulomb friction, s what it takes of damping.  The larger r, the more of the one and
# the less of the other.


_BITS = 200
_ROUNDED_UP = Fraction(1, 2**120)
"""More than what artanh in so many bits, and in the checker's, is off by, in proportion."""

_DIGITS = 12  # of 1 − r
_FARTHEST = 30.0  # artanh r beyond which 1 − r² is as nothing


class Line(NamedTuple):
    """h [N; N·m] and s [N·s/m; N·m·s/rad]."""

    height: Fraction
    slope: Fraction


def line_of(law: FrictionCompensation, r: Fraction) -> Line:
    """The tangent at r, its height rounded up; at r = 1 what is never exceeded."""
    most = law.coulomb.fraction
    if r == 1 or not most:
        return Line(most, Fraction(0))
    rest = 1 - r**2
    with precision(_BITS):
        far = middle(ball(r).atanh()) * (1 - _ROUNDED_UP)
    return Line(most * (r - rest * far), most / law.speed.fraction * rest)


def best_tangent(
    law: FrictionCompensation,
    move: float,
    missing: Callable[[float, float], float],
    pays: Callable[[Fraction], bool],
) -> Fraction:
    """The largest r that friction pays for; 0 if there is none.

    `law`: which compensation; `move`: of an encoder count in a sample, as a multiple of v_s; `missing`: what
    Coulomb friction lacks for a line of height h and slope s, beside the steps of the encoders, to rounding
    [N; N·m]; `pays`: whether, exactly, it lacks nothing for the tangent at r.
    """
    if not law.coulomb or not law.speed or pays(Fraction(1)):
        return Fraction(1)
    most, speed = float(law.coulomb), float(law.speed)

    def lacks(x: float) -> bool:
        rest = 1 / cosh(x) ** 2
        return missing(most * (tanh(x) - rest * x), most / speed * rest) > 0

    # encoders make a steep line cost friction too: what is missing is least at one of these, or between
    low = next((x for x in (move, move / 2, 0.0) if x < _FARTHEST and not lacks(x)), None)
    if low is None:
        return Fraction(0)
    high = _FARTHEST
    for _ in range(60):
        x = (low + high) / 2
        low, high = (low, x) if lacks(x) else (x, high)
    return next((r for r in map(_at, _just_below(low)) if pays(r)), Fraction(0))


def _just_below(x: float) -> Iterator[float]:
    """The same, and a little less, for what rounding hides."""
    yield x
    for power in range(12):
        yield x * (1 - 10.0 ** (power - 13))


def _at(x: float) -> Fraction:
    """tanh x, rounded down so that 1 − r has few digits."""
    if x < 0.1:
        return Fraction(round(tanh(x) * 10**_DIGITS), 10**_DIGITS)
    rest = 2 / (exp(2 * x) + 1)
    return 1 - Fraction(Context(prec=_DIGITS, rounding=ROUND_CEILING).create_decimal_from_float(rest))
