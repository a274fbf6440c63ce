"""Where roots cross the unit circle: the boundaries of stability, by D-decomposition.

P = P_0 + K P_K + B P_B is linear in K and B, so P(e^{jθ}) = 0 is two real equations:

    at every θ   one pair (K, B)                       a curve in the plane of walls
    at fixed B   −(P_0 + B P_B)/P_K real at some θ      the stiffnesses where stability may change
    z = 1, −1    one equation each                      straight lines

Floats: for curves and first guesses.  What is claimed is decided by `decide`.
"""

from __future__ import annotations

from typing import NamedTuple

import numpy as np
from numpy.typing import NDArray

from zwidth.stability.known_hand.characteristic import Family, as_floats

Array = NDArray[np.float64]

_NEAR = 1e-4
"""How far from the circle a computed root may lie: a double one is off by the root of the rounding."""

_ANGLES = np.geomspace(1e-5, np.pi, 600)[:-1]
_HALVINGS = 50
"""Where signs are compared, and how often a place is halved: to the last bits of a double."""

_OUTSIDE = 1e-7
"""Beyond the circle by more than this a root counts as outside."""


class Crossing(NamedTuple):
    """A stiffness at which roots lie on the circle, and their angle θ = ωT, 0 … π."""

    stiffness: float
    angle: float


class Curve(NamedTuple):
    """Walls with a root at e^{jθ}, and whether the region of stable ones ends there."""

    angle: Array
    stiffness: Array
    damping: Array
    bounds: NDArray[np.bool_]


class Plain(NamedTuple):
    """A `Family` in floats, descending powers of ζ = z − 1, all of one length."""

    free: Array
    stiff: Array
    damped: Array

    def at(self, stiffness: float, damping: float) -> Array:
        """P of one wall."""
        return self.free + stiffness * self.stiff + damping * self.damped

    def radius(self, stiffness: float, damping: float) -> float:
        """The largest modulus of a root."""
        return float(np.abs(1 + np.roots(self.at(stiffness, damping))).max())


def plain(polynomials: Family) -> Plain:
    """The middles of the balls."""
    rows = [as_floats(p) for p in polynomials]
    return Plain(*(np.concatenate([np.zeros(len(rows[0]) - len(row)), row]) for row in rows))


def last_stable(polynomials: Plain, damping: float) -> Crossing | None:
    """The upper end of the last band of stable stiffnesses ≥ 0 at one virtual damping; None without one."""
    found = sorted(c for c in crossings(polynomials, damping) if c.stiffness > 0)
    edges = [0.0, *(c.stiffness for c in found)]
    for k in range(len(found) - 1, -1, -1):
        if polynomials.radius((edges[k] + edges[k + 1]) / 2, damping) < 1:
            return found[k]
    return None


def crossings(polynomials: Plain, damping: float) -> list[Crossing]:
    """All stiffnesses with a root on the circle at one virtual damping."""
    rest, spring = polynomials.at(0.0, damping), polynomials.stiff
    # −rest/spring is real on the circle where rest(z) spring(1/z) = rest(1/z) spring(z)
    a, b = _in_z(rest), _in_z(spring)
    roots = np.roots(np.convolve(a, b[::-1]) - np.convolve(a[::-1], b))
    near = roots[(np.abs(np.abs(roots) - 1) < _NEAR) & (roots.imag >= 0)]
    angles = {0.0, np.pi, *(float(angle) for angle in np.abs(np.angle(near))), *_slow(rest, spring)}
    found = []
    for angle in sorted(angles):
        zeta = _zeta(np.array(angle))
        weight = np.polyval(spring, zeta)
        if abs(weight) > 1e-9 * np.abs(spring).max():
            found.append(Crossing(float((-np.polyval(rest, zeta) / weight).real), angle))
    return found


def _slow(rest: Array, spring: Array) -> list[float]:
    """The angles at which rest/spring becomes real, by its sign: near z = 1 no root is found for sure."""

    def twisted(angles: Array) -> Array:
        zeta = _zeta(angles)
        return np.asarray((np.polyval(rest, zeta) * np.conj(np.polyval(spring, zeta))).imag)

    low = _ANGLES[:-1][np.diff(np.sign(twisted(_ANGLES))) != 0]
    high = _ANGLES[1:][np.isin(_ANGLES[:-1], low)]
    sign = np.sign(twisted(low))
    for _ in range(_HALVINGS):
        middle = (low + high) / 2
        same = np.sign(twisted(middle)) == sign
        low, high = np.where(same, middle, low), np.where(same, high, middle)
    return [float(angle) for angle in (low + high) / 2]


def curve(polynomials: Plain, angles: Array) -> Curve:
    """The wall with a root at each e^{jθ}, 0 < θ < π."""
    free, stiff, damped = (np.polyval(p, _zeta(angles)) for p in polynomials)
    # two real equations: free + K stiff + B damped = 0
    determinant = (np.conj(stiff) * damped).imag
    with np.errstate(divide="ignore", invalid="ignore"):
        stiffness = -(np.conj(damped) * free).imag / (np.conj(damped) * stiff).imag
        damping = -(np.conj(stiff) * free).imag / determinant
    return Curve(angles, stiffness, damping, _bounding(polynomials, stiffness, damping))


def line(polynomials: Plain, angle: float, damping: Array) -> Curve:
    """The walls with a root at z = 1 or −1, angle 0 or π: K for each B."""
    free, stiff, damped = (float(np.polyval(p, np.cos(angle) - 1)) for p in polynomials)
    nowhere = abs(stiff) <= 1e-9 * float(np.abs(polynomials.stiff).max())
    stiffness = np.full(len(damping), np.nan) if nowhere else -(free + damping * damped) / stiff
    return Curve(np.full(len(damping), angle), stiffness, damping, _bounding(polynomials, stiffness, damping))


def _zeta(angles: Array) -> NDArray[np.complex128]:
    """e^{jθ} − 1 without cancellation."""
    return np.asarray(2j * np.sin(angles / 2) * np.exp(0.5j * angles), dtype=np.complex128)


def _in_z(polynomial: Array) -> Array:
    """A polynomial in ζ, written in z."""
    shifted = np.zeros(0)
    for coefficient in polynomial:
        shifted = np.append(shifted, 0.0) - np.append(0.0, shifted)
        shifted[-1] += coefficient
    return shifted


def _bounding(polynomials: Plain, stiffness: Array, damping: Array) -> NDArray[np.bool_]:
    """True where no root lies outside: the region of stable walls ends at such a point."""
    return np.array(
        [
            bool(np.isfinite(k) and np.isfinite(b) and polynomials.radius(k, b) < 1 + _OUTSIDE)
            for k, b in zip(stiffness, damping, strict=True)
        ]
    )
