"""A wall behind an encoder: Abbott & Okamura (2005), and what an encoder asks of Coulomb friction.

One sample of motion in the quantized wall f = K floor(x/Δ) Δ is compared with the same motion in an ideal
spring.  Without delay it is passive exactly if K ≤ 2b/T and K ≤ 2f_c/Δ: a fast press refutes the first, a
tiny step to and fro over one edge the second.  The dimensionless plane is in `diolaiti`.
"""

from __future__ import annotations

from dataclasses import dataclass
from fractions import Fraction
from itertools import pairwise
from math import inf
from typing import NamedTuple

from zwidth.errors import InputError
from zwidth.model.device import Device
from zwidth.passivity.formulas.colgate_schenkel import spring_stiffness
from zwidth.passivity.formulas.hypotheses import NEGATIVE_SPRING, NO_CLOCK, nonnegative, number, positive
from zwidth.quantity.exact import Exact, RealLike
from zwidth.quantity.text import shown


class StiffnessLimits(NamedTuple):
    """The two limits of a spring wall [N/m; N·m/rad]; the smaller one binds."""

    sampling: Exact
    quantization: Exact | float


def abbott_okamura_stiffness(
    damping: RealLike, coulomb_friction: RealLike, resolution: RealLike, sample_period: RealLike
) -> StiffnessLimits:
    """K ≤ min(2b/T, 2f_c/Δ): a spring wall with encoder and Coulomb friction, without delay.

    Parameters
    ----------
    damping
        b ≥ 0 of the device [N·s/m; N·m·s/rad].
    coulomb_friction
        f_c ≥ 0 [N; N·m].
    resolution
        Δ ≥ 0 at the handle [m; rad]; with 0 the second limit is infinite.
    sample_period
        T > 0 [s].

    Returns
    -------
    StiffnessLimits
        (2b/T, 2f_c/Δ) [N/m; N·m/rad].

    References
    ----------
    Abbott & Okamura, IEEE Transactions on Robotics 21(5), 2005, equation (3).
    """
    friction = nonnegative("coulomb_friction", coulomb_friction, "friction takes energy, it never gives any")
    step = nonnegative("resolution", resolution, "0 means an ideal encoder")
    quantization = Exact(2 * friction / step) if step else inf
    return StiffnessLimits(Exact(spring_stiffness(damping, sample_period)), quantization)


def quantized_kelvin_voigt_friction(
    stiffness: RealLike, damping: RealLike, resolution: RealLike, sample_period: RealLike
) -> Exact:
    """f_c ≥ (|K + B/T| + |B|/T) Δ/2 for f = K x + B (x(k) − x(k−1))/T behind an encoder.

    For B ≥ 0 that is (K + 2B/T) Δ/2, for −K T ≤ B ≤ 0 it is K Δ/2, and in both cases it is necessary too.
    For B < −K T it is (2|B|/T − K) Δ/2 and only sufficient: crossing one edge to and fro shows that K Δ/2 is
    necessary.  It comes beside b ≥ K T/2 + |B|, for sustained contact, without delay; for B ≥ 0 it covers
    contact made and broken too (`damped_wall_friction`).

    Parameters
    ----------
    stiffness
        K ≥ 0 [N/m; N·m/rad].
    damping
        B of the environment, of either sign [N·s/m; N·m·s/rad].
    resolution
        Δ ≥ 0 at the handle [m; rad].
    sample_period
        T > 0 [s].

    Returns
    -------
    Exact
        Coulomb friction with which the encoder costs nothing [N; N·m].

    Notes
    -----
    Derived for this project.  The encoder reads x − Δ/2 − e with |e| ≤ Δ/2, so
    f = H(x − Δ/2) − H e.  The first part is the ideal loop; the second is at
    most ‖h‖₁ Δ/2, h = (K + B/T, −B/T), and f_c |Δx| pays for it.  Necessary:
    a tiny step over one edge and back gains Δ times the force going out less
    the force coming in, K + 2B/T when made every sample, K after a rest.
    """
    k = nonnegative("stiffness", stiffness, NEGATIVE_SPRING)
    step = nonnegative("resolution", resolution, "0 means an ideal encoder")
    t = positive("sample_period", sample_period, NO_CLOCK)
    rate = number("damping", damping) / t
    return Exact((abs(k + rate) + abs(rate)) * step / 2)


def damped_wall_friction(
    stiffness: RealLike, damping: RealLike, resolution: RealLike, memory: RealLike
) -> Exact:
    """f_c ≥ (K/2 + |B|/t_v) Δ beside `damped_wall_damping`, for an encoder of resolution Δ.

    For B ≥ 0 with the backward difference, without delay, it is necessary too
    (clamped: for K > 0) and is `quantized_kelvin_voigt_friction`.

    Parameters
    ----------
    stiffness
        K ≥ 0 [N/m; N·m/rad].
    damping
        B, of either sign [N·s/m; N·m·s/rad].
    resolution
        Δ ≥ 0 at the handle [m; rad].
    memory
        t_v > 0 of the velocity estimate [s]: T of the backward difference, N T of
        a window of N samples, T + τ of a one-pole filter.

    Returns
    -------
    Exact
        Coulomb friction that is enough [N; N·m].

    Notes
    -----
    Derived for this project; the proof is in the documentation.
    """
    k = nonnegative("stiffness", stiffness, NEGATIVE_SPRING)
    step = nonnegative("resolution", resolution, "0 means an ideal encoder")
    span = positive("memory", memory, "an estimate of velocity spans some time", "delay")
    return Exact((k / 2 + abs(number("damping", damping)) / span) * step)


class QuantizedWall(NamedTuple):
    """K, b, f_c, Δ and T of a spring wall behind an encoder, exact."""

    k: Fraction
    b: Fraction
    friction: Fraction
    step: Fraction
    t: Fraction


def quantized_wall(device: Device, stiffness: RealLike) -> QuantizedWall:
    """The exact numbers of a certain device without delay and a stiffness > 0."""
    k = stiffness_of_wall(stiffness)
    if device.exact("delay") != 0:
        raise InputError(
            f"these formulas are for a device without delay, got {shown(device.exact('delay'), 's', 6)}; "
            "check the wall itself: the exact engine covers every delay"
        )
    values = (device.exact(key) for key in ("damping", "coulomb_friction", "resolution", "sample_period"))
    return QuantizedWall(k, *values)


def stiffness_of_wall(stiffness: RealLike) -> Fraction:
    """K > 0, exact."""
    return positive("stiffness", stiffness, "without a spring there is no wall")


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
    distance = number("displacement", displacement, quantity="position")
    return Exact((wall.b / wall.t - wall.k / 2) * distance**2 + _line(wall, distance))


def linear_worst_case(device: Device, stiffness: RealLike, displacement: RealLike) -> Exact:
    """f_c λ on release, (K Δ − f_c) λ on compression: below J* where K ≤ 2b/T [J].

    Their slopes decide: coming out by λ after going in by λ loses at least
    (2f_c − K Δ) λ.  Parameters as for `worst_case`.
    """
    return Exact(
        _line(quantized_wall(device, stiffness), number("displacement", displacement, quantity="position"))
    )


def fast_press(device: Device, stiffness: RealLike, counts: int | None = None) -> Counterexample:
    """From −ε to nΔ + ε in one sample and back in the next: gains energy where K > 2b/T.

        W = (nΔ + 2ε) [n Δ K − 2f_c − 2 (b/T)(nΔ + 2ε)]

    positive for small ε if n > f_c/(Δ (K/2 − b/T)); close to the limit that is a very fast hand: more than 10
    714 counts, 240 m/s, for K = 301 N/m on the paddle (Abbott & Okamura 2005, section III-C).

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
