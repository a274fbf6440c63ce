"""The dimensionless plane of a spring wall behind an encoder, and how fast a hand may move.

The plane is that of Diolaiti, Niemeyer, Barbagli & Salisbury (2006), the device that of Abbott & Okamura
(2005): f = K x_enc inside, encoder floor(x/Δ) Δ, friction f_c sgn ẋ + b ẋ, no delay.  Passive exactly if

    β = b/(K T) ≥ ½    and    σ = f_c/(K Δ) ≥ ½

Left of the first limit fast motions gain energy, below the second small ones:
a hand that moves ξ counts in one sample loses at least

    K Δ² ξ [(β − ½) ξ + (σ − ½)]

against the spring ½ K (x − Δ/2)² (derived for this project, see `admissible_speed`).
"""

from __future__ import annotations

from fractions import Fraction
from math import inf
from typing import Literal, NamedTuple

from zwidth.errors import InputError
from zwidth.model.device import Device
from zwidth.passivity.formulas.abbott_okamura import quantized_wall
from zwidth.quantity.exact import Exact, RealLike

Region = Literal["globally stable", "limit cycles", "globally unstable", "locally stable"]
Start = Literal["inside", "surface"]

_HALF = Fraction(1, 2)


class PlanePoint(NamedTuple):
    """A device and a stiffness in the dimensionless plane.

    `viscous` is β = b/(K T), `dry` is σ = f_c/(K Δ), infinite for an ideal encoder.
    """

    viscous: Exact
    dry: Exact | float

    @property
    def region(self) -> Region:
        """Where the point lies (Diolaiti, Niemeyer, Barbagli & Salisbury 2006).

        "globally stable" (passive, edges included), "limit cycles" (small motions gain energy, large ones
        lose it), "locally stable" (the reverse), "globally unstable".
        """
        fast, small = _at_least_half(self.viscous), _at_least_half(self.dry)
        if fast:
            return "globally stable" if small else "limit cycles"
        return "locally stable" if small else "globally unstable"


def plane_point(device: Device, stiffness: RealLike) -> PlanePoint:
    """β = b/(K T) and σ = f_c/(K Δ).

    Parameters
    ----------
    device
        Certain values of b, T, f_c and Δ, without delay.
    stiffness
        K > 0 [N/m; N·m/rad].
    """
    wall = quantized_wall(device, stiffness)
    if wall.step == 0 and wall.friction == 0:
        raise InputError(
            "σ = f_c/(K Δ) has no value for coulomb_friction 0 and resolution 0: "
            "such a device is limited by 2b/T alone; give either of the two"
        )
    dry = Exact(wall.friction / (wall.k * wall.step)) if wall.step else inf
    return PlanePoint(Exact(wall.b / (wall.k * wall.t)), dry)


def admissible_speed(device: Device, stiffness: RealLike, start: Start = "inside") -> Exact | float:
    """v = (2f_c − K Δ)/(K T − 2b), or 2f_c/(K T − 2b) from the surface; inf for K ≤ 2b/T [m/s; rad/s].

    "inside": no motion whose mean speed over each sample stays at or below v
    gains energy, although the wall is not passive; a faster cycle over a whole
    number of edges does.  0 where K > 2f_c/Δ.
    "surface": no motion from x = 0 in and out again within two samples gains
    energy up to v; a faster one over a whole number of edges does.  Other
    motions may gain below it.

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
    wall = quantized_wall(device, stiffness)
    surplus = 2 * wall.friction - (wall.k * wall.step if _is_inside(start) else 0)
    deficit = wall.k * wall.t - 2 * wall.b
    if surplus < 0:
        return Exact(0)
    return Exact(surplus / deficit) if deficit > 0 else inf


def _at_least_half(value: float) -> bool:
    return (value.fraction if isinstance(value, Exact) else value) >= _HALF


def _is_inside(start: Start) -> bool:
    if start not in ("inside", "surface"):
        raise InputError(f'start is "inside" or "surface", got {start!r}')
    return start == "inside"
