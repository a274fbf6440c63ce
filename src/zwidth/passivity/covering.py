"""A wall on a device whose proof covers laws in a chain.

The proof of a wall with virtual damping is one of |f − K u| ≤ B |v|, whatever the force beside K u is.  Laws
that add no more than α |Δx|/T in all are covered by a wall with B = α.  What compensates friction adds no
more than h + (C + s) |Δx|/T, a line above it: by a wall with C + s more, on a device with h less friction.
"""

from __future__ import annotations

from fractions import Fraction

from zwidth.model.device import Device
from zwidth.model.environment.environment import Environment
from zwidth.model.environment.wall import Wall, wall_of
from zwidth.model.rendering.friction_compensation import FrictionCompensation
from zwidth.model.rendering.rendered import laws_of
from zwidth.passivity.tangents import best_tangent, line_of
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
        bound = link.most_damping(device, wall.stiffness if alone else None)  # type: ignore[arg-type]
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
