"""The characteristic polynomial of the loop, and whether its roots lie inside the unit circle.

    P(z) = zᵉ p(z) D(z) + N(z) H_N(z),    H = H_N/D the law, N/(zᵉ p) the plant

For a wall H = K + B V it is linear in K and B:  P = P_0 + K P_K + B P_B.  Written in ζ = z − 1, and with
z = (1 + w)/(1 − w) in w, its roots lie inside the circle exactly if Routh's first column is positive.
In balls that answers for every number in them at once, or does not answer.
"""

from __future__ import annotations

from collections.abc import Callable
from fractions import Fraction
from typing import Literal, NamedTuple

import numpy as np
from numpy.typing import NDArray

from zwidth.loop.sampled_plant import Coefficients, Motion, Number, SampledPlant, ball, plus, sampled, times
from zwidth.model.environment.environment import RationalFunction
from zwidth.quantity.balls import precision

PRECISIONS = (128, 512, 2048)
"""Bits, one after the other, until a certain loop is decided."""


class Family(NamedTuple):
    """P = free + K stiff + B damped, descending powers of ζ, at one precision."""

    free: Coefficients
    stiff: Coefficients
    damped: Coefficients

    def at(self, stiffness: Fraction, damping: Fraction) -> Coefficients:
        """P of one wall."""
        k, b = (_beside(self.free[0], value) for value in (stiffness, damping))
        return plus(self.free, plus([k * c for c in self.stiff], [b * c for c in self.damped]))


def family(motion: Motion, velocity: RationalFunction) -> Family:
    """The polynomials of all walls with one velocity estimate V(z)."""
    plant = sampled(motion)
    above, below = (_in_zeta(plant, part) for part in velocity)
    return Family(_open(plant, below), times(plant.numerator, below), times(plant.numerator, above))


def of_law(motion: Motion, law: RationalFunction) -> Coefficients:
    """P of one law H(z)."""
    plant = sampled(motion)
    above, below = (_in_zeta(plant, part) for part in law)
    return plus(_open(plant, below), times(plant.numerator, above))


def _open(plant: SampledPlant, below: Coefficients) -> Coefficients:
    """zᵉ p D: the loop without its force."""
    product = times(plant.denominator, below)
    for _ in range(plant.late):
        product = plus([*product, 0 * product[0]], product)  # times z = ζ + 1
    return product


def decays(polynomial: Coefficients) -> bool | None:
    """True if every root has |z| < 1 for every value in the balls, False if one has not, None if unknown."""
    rows = bilinear(polynomial)
    sign = 1 if polynomial[0] > 0 else -1  # that of the law's denominator: never in doubt
    upper, lower = ([sign * c for c in rows[start::2]] for start in (0, 1))
    while upper:
        if not upper[0] > 0:
            return False if upper[0] <= 0 else None
        if not lower:
            return True
        if not lower[0] > 0:
            return False if lower[0] <= 0 else None
        ratio = upper[0] / lower[0]
        padded = [*lower[1:], *([0 * lower[0]] * (len(upper) - len(lower)))]
        upper, lower = lower, [a - ratio * b for a, b in zip(upper[1:], padded, strict=True)]
    return True


def bilinear(polynomial: Coefficients) -> Coefficients:
    """Σ a_i (2w)ⁱ (1 − w)ⁿ⁻ⁱ, descending powers of w: Σ a_i ζⁱ times (1 − w)ⁿ, ζ = 2w/(1 − w)."""
    result: Coefficients = [polynomial[0]]  # Horner in 2w, the missing factors of 1 − w put in on the way
    power: Coefficients = [_beside(polynomial[0], Fraction(1))]
    one, two = power[0], 2 * power[0]
    for coefficient in polynomial[1:]:
        power = times(power, [-one, one])
        result = plus(times(result, [two, 0 * two]), [coefficient * c for c in power])
    return result


def as_floats(polynomial: Coefficients) -> NDArray[np.float64]:
    """The middles of the coefficients."""
    return np.array([float(c) if isinstance(c, Fraction) else float(c.mid()) for c in polynomial])


def _in_zeta(plant: SampledPlant, values: tuple[Fraction, ...]) -> Coefficients:
    """A polynomial in z, written in ζ = z − 1, in the numbers of the plant."""
    shifted: list[Fraction] = []
    for value in values:  # Horner: times (ζ + 1), plus the next coefficient
        shifted = [*shifted, Fraction(0)]
        shifted = [c + (shifted[i - 1] if i else 0) for i, c in enumerate(shifted)]
        shifted[-1] += value
    return [_beside(plant.denominator[0], c) for c in shifted]


def _beside(sample: Number, value: Fraction) -> Number:
    return value if isinstance(sample, Fraction) else ball(value)


# Does a loop come to rest, and if its numbers are intervals, is there one in them that does not?
#
# A certain loop is decided, in balls of growing precision.  Of a box the values on a grid are decided: one
# that does not decay settles it.  If all do, "stable" is what is left to be proved; the checker does that.


Outcome = Literal["stable", "unstable", "undecided"]

_ON_A_SIDE = 4
"""Values that are tried along each side of a box, ends included."""

Polynomial = Callable[[Motion], Coefficients]


class Found(NamedTuple):
    """The outcome, and a point of the box that does not decay if there is one."""

    outcome: Outcome
    unstable_hand: Motion | None = None


def decided(motion: Motion, polynomial: Polynomial) -> Found:
    """Whether a certain loop decays; of a box "unstable" with a value in it, or "stable" as a conjecture."""
    answers = [_certain(point, polynomial) for point in motion.grid(_ON_A_SIDE)]
    worst = next((found for found in answers if found.outcome == "unstable"), None)
    return worst or next((found for found in answers if found.outcome == "undecided"), Found("stable"))


def _certain(motion: Motion, polynomial: Polynomial) -> Found:
    for bits in PRECISIONS:
        with precision(bits):
            answer = decays(polynomial(motion))
        if answer is not None:
            return Found("stable") if answer else Found("unstable", motion)
    return Found("undecided")


# Where roots cross the unit circle: the boundaries of stability, by D-decomposition.
#
# P = P_0 + K P_K + B P_B is linear in K and B, so P(e^{jθ}) = 0 is two real equations:
#
#     at every θ   one pair (K, B)                       a curve in the plane of walls
#     at fixed B   −(P_0 + B P_B)/P_K real at some θ      the stiffnesses where stability may change
#     z = 1, −1    one equation each                      straight lines
#
# Floats: for curves and first guesses.  What is claimed is `decided`.


Array = NDArray[np.float64]

_NEAR = 1e-4
"""How far from the circle a computed root may lie: a double one is off by the root of the rounding."""

_ANGLES = np.geomspace(1e-5, np.pi, 600)[:-1]
_HALVINGS = 50
"""Where signs are compared, and how often a place is halved: to the last bits of a double."""

_TOGETHER = 256
"""Virtual dampings at a time: a few megabytes."""

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

    def at(self, stiffness: Array, damping: Array) -> Array:
        """P of each wall, a row each."""
        return self.free + stiffness[:, None] * self.stiff + damping[:, None] * self.damped

    def radii(self, stiffness: Array, damping: Array) -> Array:
        """The largest modulus of a root, of each wall."""
        return np.array([np.abs(1 + roots).max() for roots in _roots(self.at(stiffness, damping))])


def plain(polynomials: Family) -> Plain:
    """The middles of the balls."""
    rows = [as_floats(p) for p in polynomials]
    return Plain(*(np.concatenate([np.zeros(len(rows[0]) - len(row)), row]) for row in rows))


def last_stable(polynomials: Plain, damping: float) -> Crossing | None:
    """The upper end of the last band of stable stiffnesses ≥ 0 at one virtual damping; None without one."""
    return last_stable_of_each(polynomials, np.array([damping]))[0]


def last_stable_of_each(polynomials: Plain, dampings: Array) -> list[Crossing | None]:
    """The same at many."""
    crossings: list[list[Crossing]] = []
    for start in range(0, len(dampings), _TOGETHER):
        crossings += _crossings(polynomials, dampings[start : start + _TOGETHER])
    found = [sorted(c for c in row if c.stiffness > 0) for row in crossings]
    last: list[Crossing | None] = [None] * len(found)
    left = {row: len(each) - 1 for row, each in enumerate(found) if each}  # the band that is looked at
    while left:
        rows = list(left)
        edges = [([0.0, *(c.stiffness for c in found[row])], left[row]) for row in rows]
        middles = np.array([(each[k] + each[k + 1]) / 2 for each, k in edges])
        for row, radius in zip(rows, polynomials.radii(middles, dampings[rows]), strict=True):
            if radius < 1:
                last[row] = found[row][left[row]]
            left[row] -= 1
            if radius < 1 or left[row] < 0:
                del left[row]
    return last


def _crossings(polynomials: Plain, dampings: Array) -> list[list[Crossing]]:
    """All stiffnesses with a root on the circle, at each virtual damping."""
    rest, spring = polynomials.at(np.zeros(len(dampings)), dampings), polynomials.stiff
    # −rest/spring is real on the circle where rest(z) spring(1/z) = rest(1/z) spring(z)
    b = _in_z(spring[None])[0]
    differences = [np.convolve(a, b[::-1]) - np.convolve(a[::-1], b) for a in _in_z(rest)]
    angles: list[list[float]] = []
    for roots, slow in zip(_roots(np.array(differences)), _slow(rest, spring), strict=True):
        near = roots[(np.abs(np.abs(roots) - 1) < _NEAR) & (roots.imag >= 0)]
        angles.append(sorted({0.0, np.pi, *np.abs(np.angle(near)).tolist(), *slow}))
    row = np.repeat(np.arange(len(angles)), [len(each) for each in angles])
    angle = np.array([one for each in angles for one in each])
    zeta = _zeta(angle)
    weight = _values(spring, zeta)
    there = np.abs(weight) > 1e-9 * np.abs(spring).max()
    row, angle, weight = row[there], angle[there], weight[there]
    stiffness = (-_values(rest[row].T, zeta[there]) / weight).real
    found: list[list[Crossing]] = [[] for _ in angles]
    for k, one in zip(row.tolist(), zip(stiffness.tolist(), angle.tolist(), strict=True), strict=True):
        found[k].append(Crossing(*one))
    return found


def _slow(rest: Array, spring: Array) -> list[list[float]]:
    """The angles at which a row of rest/spring becomes real, by its sign: near z = 1 no root is found for
    sure."""

    def twisted(coefficients: Array, angles: Array) -> Array:
        zeta = _zeta(angles)
        return np.asarray((_values(coefficients, zeta) * np.conj(_values(spring, zeta))).imag)

    signs = np.sign(twisted(rest.T[:, :, None], _ANGLES))
    row, place = np.nonzero(np.diff(signs) != 0)
    low, high, sign, turned = _ANGLES[place], _ANGLES[place + 1], signs[row, place], rest[row].T
    for _ in range(_HALVINGS):
        middle = (low + high) / 2
        same = np.sign(twisted(turned, middle)) == sign
        low, high = np.where(same, middle, low), np.where(same, high, middle)
    found: list[list[float]] = [[] for _ in rest]
    for k, angle in zip(row.tolist(), ((low + high) / 2).tolist(), strict=True):
        found[k].append(angle)
    return found


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


def _in_z(polynomials: Array) -> Array:
    """Polynomials in ζ, a row each, written in z."""
    nothing = np.zeros((len(polynomials), 1))
    shifted = nothing[:, :0]
    for coefficient in polynomials.T:
        shifted = np.hstack([shifted, nothing]) - np.hstack([nothing, shifted])
        shifted[:, -1] += coefficient
    return shifted


def _bounding(polynomials: Plain, stiffness: Array, damping: Array) -> NDArray[np.bool_]:
    """True where no root lies outside: the region of stable walls ends at such a point."""
    bounds = np.isfinite(stiffness) & np.isfinite(damping)
    bounds[bounds] = polynomials.radii(stiffness[bounds], damping[bounds]) < 1 + _OUTSIDE
    return bounds


def _values(coefficients: Array, places: NDArray[np.complex128]) -> NDArray[np.complex128]:
    """Of polynomials at places, by Horner's rule; the coefficients along the first axis, descending."""
    total = np.zeros_like(places)
    for coefficient in coefficients:
        total = total * places + coefficient
    return total


def _roots(rows: Array) -> list[Array]:
    """`np.roots` of each row; of all those together that have as many zeros at both ends."""
    found: list[Array] = [np.zeros(0)] * len(rows)
    there = rows != 0
    first, last = there.argmax(axis=1), rows.shape[1] - there[:, ::-1].argmax(axis=1)
    for start, end in {*zip(first.tolist(), last.tolist(), strict=True)}:
        which = np.flatnonzero((first == start) & (last == end) & there.any(axis=1))
        size = end - start - 1
        companions = np.tile(np.eye(size, k=-1), (len(which), 1, 1))
        if size:
            companions[:, 0] = -rows[which, start + 1 : end] / rows[which, start, None]
        roots = np.linalg.eigvals(companions)
        roots = np.hstack([roots, np.zeros((len(which), rows.shape[1] - end))])
        for row, each in zip(which.tolist(), roots, strict=True):
            found[row] = each
    return found
