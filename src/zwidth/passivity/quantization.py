"""A spring wall behind an encoder: worst cases, counterexamples, the (β, σ) plane.

The device of Abbott & Okamura (2005): f = K x_enc inside, encoder floor(x/Δ) Δ,
friction f_c sgn ẋ + b ẋ, no delay.  Passive exactly if K ≤ 2b/T and K ≤ 2f_c/Δ,
in the dimensionless plane

    β = b/(K T) ≥ ½,    σ = f_c/(K Δ) ≥ ½

Beyond the first limit fast motions gain energy, beyond the second small ones:
over one sample period, with ξ counts moved, the hand loses at least

    W = K Δ² ξ [(β − ½) ξ + (σ − ½)]

against the spring ½ K (x − Δ/2)² (derived for this project; see
`admissible_speed`).
"""

from __future__ import annotations

from dataclasses import dataclass
from fractions import Fraction
from itertools import pairwise
from math import inf
from typing import Literal, NamedTuple

from zwidth.device import Device
from zwidth.errors import InputError
from zwidth.quantity.exact import Exact, RealLike

Region = Literal["globally stable", "limit cycles", "globally unstable", "locally stable"]
Start = Literal["inside", "surface"]

_HALF = Fraction(1, 2)


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


class PlanePoint(NamedTuple):
    """A device and a stiffness in the dimensionless plane.

    `viscous` is β = b/(K T), `dry` is σ = f_c/(K Δ), infinite for an ideal encoder.
    """

    viscous: Exact
    dry: Exact | float

    @property
    def region(self) -> Region:
        """Where the point lies (Diolaiti, Niemeyer, Barbagli & Salisbury 2006).

        "globally stable" (passive, edges included), "limit cycles" (small
        motions gain energy, large ones lose it), "locally stable" (the reverse),
        "globally unstable".
        """
        fast, small = _at_least_half(self.viscous), _at_least_half(self.dry)
        if fast:
            return "globally stable" if small else "limit cycles"
        return "locally stable" if small else "globally unstable"

    def cycle_loss(self, step: RealLike, start: Start = "inside") -> Exact | float:
        """W/(2 K Δ² ξ) = (β − ½) ξ + σ − ½, or (β − ½) ξ + σ from the surface.

        W is what the hand loses by one sample in and one sample out: "inside"
        from just below one edge to just past the last, "surface" from x = 0 to
        ξ Δ.  Negative where the cycle gains energy.

        Parameters
        ----------
        step
            ξ > 0, encoder counts moved in one sample.
        """
        xi = Exact(step).fraction
        if xi <= 0:
            raise InputError(f"step must be > 0 counts, got {step}: a hand at rest gains nothing")
        if not isinstance(self.dry, Exact):
            return inf
        return Exact((self.viscous.fraction - _HALF) * xi + _surplus(self.dry, start))

    def largest_step(self, start: Start = "inside") -> Exact | float:
        """ξ_max = (σ − ½)/(½ − β), or σ/(½ − β) from the surface [counts per sample].

        The largest step up to which no cycle gains energy: inf for β ≥ ½ where
        small steps lose, 0 where they gain.
        """
        if not isinstance(self.dry, Exact):
            return inf
        surplus, deficit = _surplus(self.dry, start), _HALF - self.viscous.fraction
        if surplus < 0:
            return Exact(0)
        return Exact(surplus / deficit) if deficit > 0 else inf


def plane_point(device: Device, stiffness: RealLike) -> PlanePoint:
    """β = b/(K T) and σ = f_c/(K Δ).

    Parameters
    ----------
    device
        Certain values of b, T, f_c and Δ, without delay.
    stiffness
        K > 0 [N/m; N·m/rad].

    Raises
    ------
    InputError
        If K ≤ 0, a value is an interval, the device has a delay, or f_c = Δ = 0.
    """
    wall = _wall(device, stiffness)
    if wall.step == 0 and wall.friction == 0:
        raise InputError(
            "σ = f_c/(K Δ) has no value for coulomb_friction 0 and resolution 0: "
            "such a device is limited by 2b/T alone; give either of the two"
        )
    dry = Exact(wall.friction / (wall.k * wall.step)) if wall.step else inf
    return PlanePoint(Exact(wall.b / (wall.k * wall.t)), dry)


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
    wall = _wall(device, stiffness)
    distance = Exact(displacement).fraction
    return Exact((wall.b / wall.t - wall.k / 2) * distance**2 + _line(wall, distance))


def linear_worst_case(device: Device, stiffness: RealLike, displacement: RealLike) -> Exact:
    """f_c λ on release, (K Δ − f_c) λ on compression: below J* where K ≤ 2b/T [J].

    Their slopes decide: coming out by λ after going in by λ loses at least
    (2f_c − K Δ) λ.  Parameters as for `worst_case`.
    """
    return Exact(_line(_wall(device, stiffness), Exact(displacement).fraction))


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

    Raises
    ------
    InputError
        If Δ = 0, K ≤ 2b/T, or n is too small.
    """
    wall = _wall(device, stiffness)
    _require_encoder(wall)
    excess = wall.k - 2 * wall.b / wall.t
    if excess <= 0:
        raise InputError(
            f"stiffness {float(wall.k):g} does not exceed 2b/T = {float(2 * wall.b / wall.t):g}: "
            "no press gains energy"
        )
    threshold = 2 * wall.friction / (wall.step * excess)
    n = int(threshold // 1) + 1 if counts is None else int(counts)
    if n <= threshold:
        raise InputError(
            f"counts must exceed f_c/(Δ (K/2 − b/T)) = {float(threshold):g}, got {counts}: "
            "a shorter press loses to Coulomb friction more than it gains"
        )
    depth = n * wall.step
    margin = depth * excess - 2 * wall.friction
    epsilon = wall.step / 8 if wall.b == 0 else min(wall.step / 8, margin * wall.t / wall.b / 8)
    path = depth + 2 * epsilon
    energy = path * (wall.k * depth - 2 * wall.friction - 2 * wall.b / wall.t * path)
    return Counterexample((-epsilon, depth + epsilon, -epsilon), Exact(wall.t), Exact(energy))


def edge_straddle(device: Device, stiffness: RealLike) -> Counterexample:
    """From Δ − ε/2 to Δ + ε/2 in one sample and back in the next: gains energy where K > 2f_c/Δ.

        W = ε (K Δ − 2f_c − 2bε/T)

    The hand goes to Δ − ε/2 once and repeats the rest at will
    (Abbott & Okamura 2005, section III-C).  ε is half of what W > 0 allows.

    Parameters
    ----------
    device, stiffness
        As for `plane_point`, with Δ > 0 and K > 2f_c/Δ.

    Raises
    ------
    InputError
        If Δ = 0 or K ≤ 2f_c/Δ.
    """
    wall = _wall(device, stiffness)
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


def admissible_speed(device: Device, stiffness: RealLike, start: Start = "inside") -> Exact | float:
    """v = (2f_c − K Δ)/(K T − 2b), or 2f_c/(K T − 2b) from the surface; inf for K ≤ 2b/T [m/s; rad/s].

    "inside": no motion whose mean speed over each sample stays at or below v
    gains energy, although the wall is not passive; a faster cycle over a whole
    number of edges does.  0 where K > 2f_c/Δ.
    "surface": above v, going in from x = 0 and out again within two samples
    gains energy.  Below it such a cycle does not; other motions may.

    Parameters
    ----------
    device, stiffness
        As for `plane_point`.
    start
        "inside" or "surface".

    Notes
    -----
    Derived for this project.  With V = ½ K max(x − Δ/2, 0)², the rendered
    force differs from V' by at most K Δ/2 and V' has a slope of at most K, so
    f Δx ≥ ΔV − ½ K Δx² − ½ K Δ |Δx|; friction takes f_c |Δx| + (b/T) Δx².  The
    sum is ≥ ΔV as long as (K/2 − b/T) |Δx| ≤ f_c − K Δ/2.
    """
    wall = _wall(device, stiffness)
    surplus = 2 * wall.friction - (wall.k * wall.step if _is_inside(start) else 0)
    deficit = wall.k * wall.t - 2 * wall.b
    if surplus < 0:
        return Exact(0)
    return Exact(surplus / deficit) if deficit > 0 else inf


class _Wall(NamedTuple):
    k: Fraction
    b: Fraction
    friction: Fraction
    step: Fraction
    t: Fraction


def _wall(device: Device, stiffness: RealLike) -> _Wall:
    k = Exact(stiffness).fraction
    if k <= 0:
        raise InputError(f"stiffness must be > 0, got {stiffness}: without a spring there is no wall")
    if device.exact("delay") != 0:
        raise InputError(
            f"these formulas are for a device without delay, got {float(device.exact('delay')):g} s; "
            "check the wall itself: the exact engine covers every delay"
        )
    values = (device.exact(key) for key in ("damping", "coulomb_friction", "resolution", "sample_period"))
    return _Wall(k, *values)


def _line(wall: _Wall, distance: Fraction) -> Fraction:
    slope = wall.friction if distance >= 0 else wall.k * wall.step - wall.friction
    return slope * distance


def _require_encoder(wall: _Wall) -> None:
    if wall.step == 0:
        raise InputError("resolution must be > 0 here: an ideal encoder has no edges to count")


def _at_least_half(value: float) -> bool:
    return (value.fraction if isinstance(value, Exact) else value) >= _HALF


def _surplus(dry: Exact, start: Start) -> Fraction:
    return dry.fraction - (_HALF if _is_inside(start) else 0)


def _is_inside(start: Start) -> bool:
    if start not in ("inside", "surface"):
        raise InputError(f'start is "inside" or "surface", got {start!r}')
    return start == "inside"
