"""A spring wall behind an encoder: worst-case energy, and the motions that refute passivity.

Abbott & Okamura (2005): one sample of motion in the quantized wall
f = K floor(x/Δ) Δ is compared with the same motion in an ideal spring.  Passive
exactly if K ≤ 2b/T and K ≤ 2f_c/Δ: a fast press refutes the first, a tiny step
to and fro over one edge the second.  The dimensionless plane is in
`stability_plane`; its names are here too.
"""

from __future__ import annotations

from dataclasses import dataclass
from fractions import Fraction
from itertools import pairwise

from zwidth.errors import InputError
from zwidth.model.device import Device
from zwidth.passivity.formulas.stability_plane import (
    PlanePoint,
    QuantizedWall,
    admissible_speed,
    catalogue_coordinates,
    plane_point,
    quantized_wall,
)
from zwidth.quantity.exact import Exact, RealLike

__all__ = [
    "Counterexample",
    "PlanePoint",
    "admissible_speed",
    "catalogue_coordinates",
    "edge_crossing",
    "fast_press",
    "linear_worst_case",
    "plane_point",
    "worst_case",
]


@dataclass(frozen=True)
class Counterexample:
    """A motion that takes energy out of a quantized spring wall.

    Parameters
    ----------
    positions
        At the samples, constant velocity in between, at rest at both ends; it
        ends where it started [m; rad].
    sample_period
        T [s].
    energy
        What the hand gains by it, each time it is done [J].
    """

    positions: tuple[Fraction, ...]
    sample_period: Exact
    energy: Exact

    @property
    def peak_speed(self) -> float:
        """The largest speed of the motion [m/s; rad/s]."""
        x = self.positions
        return float(max(abs(b - a) for a, b in pairwise(x)) / self.sample_period.fraction)


def worst_case(device: Device, stiffness: RealLike, displacement: RealLike) -> Exact:
    """J*(λ) = α λ² + f_c λ on release, α λ² + (K Δ − f_c) λ on compression [J].

    λ = x0 − xT is how far the hand comes out in one sample, α = b/T − K/2.  The
    wall takes at least J* more than an ideal spring would, whatever the phase of
    the encoder (Abbott & Okamura 2005, equations (11) and (15), figures 4, 5).

    Parameters
    ----------
    device, stiffness
        As for `plane_point`.
    displacement
        λ [m; rad]: ≥ 0 on release, < 0 on compression.
    """
    wall = quantized_wall(device, stiffness)
    distance = Exact(displacement).fraction
    return Exact((wall.b / wall.t - wall.k / 2) * distance**2 + _line(wall, distance))


def linear_worst_case(device: Device, stiffness: RealLike, displacement: RealLike) -> Exact:
    """f_c λ on release, (K Δ − f_c) λ on compression: below J* where K ≤ 2b/T [J].

    Their slopes decide: coming out by λ after going in by λ loses at least
    (2f_c − K Δ) λ.  Parameters as for `worst_case`.
    """
    return Exact(_line(quantized_wall(device, stiffness), Exact(displacement).fraction))


def fast_press(device: Device, stiffness: RealLike, counts: int | None = None) -> Counterexample:
    """From −ε to nΔ + ε in one sample and back in the next: gains energy where K > 2b/T.

        W = (nΔ + 2ε) [n Δ K − 2f_c − 2 (b/T)(nΔ + 2ε)]

    positive for small ε if n > f_c/(Δ (K/2 − b/T)); close to the limit that is
    a very fast hand: more than 10 714 counts, 240 m/s, for K = 301 N/m on the
    paddle (Abbott & Okamura 2005, section III-C).

    Parameters
    ----------
    device, stiffness
        As for `plane_point`, with Δ > 0 and K > 2b/T.
    counts
        n; the smallest that gains if not given.
    """
    wall = quantized_wall(device, stiffness)
    _require_encoder(wall)
    excess = wall.k - 2 * wall.b / wall.t
    if excess <= 0:
        raise InputError(
            f"stiffness {float(wall.k):g} does not exceed 2b/T = {float(2 * wall.b / wall.t):g}: "
            "no press gains energy"
        )
    threshold = 2 * wall.friction / (wall.step * excess)
    n = Exact(threshold // 1 + 1 if counts is None else counts).fraction
    if n.denominator != 1 or n <= threshold:
        raise InputError(
            f"counts is a whole number above f_c/(Δ (K/2 − b/T)) = {float(threshold):g}, got {counts}: "
            "a shorter press loses to Coulomb friction more than it gains"
        )
    depth = n * wall.step
    margin = depth * excess - 2 * wall.friction
    epsilon = wall.step / 8 if wall.b == 0 else min(wall.step / 8, margin * wall.t / wall.b / 8)
    path = depth + 2 * epsilon
    energy = path * (wall.k * depth - 2 * wall.friction - 2 * wall.b / wall.t * path)
    return Counterexample((-epsilon, depth + epsilon, -epsilon), Exact(wall.t), Exact(energy))


def edge_crossing(device: Device, stiffness: RealLike) -> Counterexample:
    """From Δ − ε/2 to Δ + ε/2 in one sample and back in the next: gains energy where K > 2f_c/Δ.

        W = ε (K Δ − 2f_c − 2bε/T)

    The hand goes to Δ − ε/2 once and repeats the rest at will
    (Abbott & Okamura 2005, section III-C).  ε is half of what W > 0 allows.

    Parameters
    ----------
    device, stiffness
        As for `plane_point`, with Δ > 0 and K > 2f_c/Δ.
    """
    wall = quantized_wall(device, stiffness)
    _require_encoder(wall)
    margin = wall.k * wall.step - 2 * wall.friction
    if margin <= 0:
        raise InputError(
            f"stiffness {float(wall.k):g} does not exceed 2f_c/Δ = "
            f"{float(2 * wall.friction / wall.step):g}: no small step over an edge gains energy"
        )
    epsilon = wall.step / 2 if wall.b == 0 else min(wall.step / 2, margin * wall.t / wall.b / 4)
    energy = epsilon * (margin - 2 * wall.b * epsilon / wall.t)
    below, above = wall.step - epsilon / 2, wall.step + epsilon / 2
    return Counterexample((below, above, below), Exact(wall.t), Exact(energy))


def _line(wall: QuantizedWall, distance: Fraction) -> Fraction:
    slope = wall.friction if distance >= 0 else wall.k * wall.step - wall.friction
    return slope * distance


def _require_encoder(wall: QuantizedWall) -> None:
    if wall.step == 0:
        raise InputError("resolution must be > 0 here: an ideal encoder has no edges to count")
