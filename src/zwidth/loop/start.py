"""Where a touch starts at rest, and what the loop holds where it starts.

A law that acts on both sides of x = 0 has no outside: a hand that starts elsewhere than where its
force is 0 starts in a loaded spring.  With y_0 = x_0 + (φ − ½) Δ, the middle of the count that is read,
and Φ the potential of the law at rest, Φ' = f, a passive loop gives out no more than

    E = Φ(y_0) − min Φ + (f_c + e) s + f_0 s_0

beside the kinetic energy.  e is how far counts and converter steps put the force at rest beside f, s how
far the hand gets from x_0: the friction of the way back, after which the same can be done again.  It is
left out where E holds without it.  f_0 is the force at x_0, s_0 how far the hand goes along it before
the first force arrives.  The proofs are in the documentation, "Energy at the start".
"""

from __future__ import annotations

from dataclasses import dataclass
from fractions import Fraction
from itertools import pairwise
from math import inf
from typing import TYPE_CHECKING

import numpy as np

from zwidth.loop.law import measured
from zwidth.model.environment.environment import Environment, PowerLaw
from zwidth.model.rendering.rendered import laws_of
from zwidth.quantity.exact import Exact

if TYPE_CHECKING:
    from numpy.typing import NDArray

    from zwidth.loop.plant import Plant
    from zwidth.model.device.amplifier import Actuation

    Array = NDArray[np.float64]

DOWNHILL = "the spring pushes away for ever at one end, so that what it holds has no bound"
IN_A_CHAIN = "laws in a chain may hold energy of their own"
LOADED = "the scene is loaded where the touch starts, and pushes the handle"
OF_TWO = "where the law pushes at the start, or a count hides its edge, no bound is known with a transmission"
ON_THE_WAY = "the amplifier has not yet reached the force of the law when the touch starts"


@dataclass(frozen=True, kw_only=True)
class Held:
    """What the loop holds at the start, E without what depends on the motion.

    Attributes
    ----------
    stored
        Φ(y_0) − min Φ [J]; None where no bound is known.
    unknown
        Why none is; "" where one is.
    friction
        f_c + e per way from the start, 0 where it is not needed [N; N·m].
    force
        f_0 [N; N·m].
    """

    stored: float | None = 0.0
    unknown: str = ""
    friction: float = 0.0
    force: float = 0.0

    def bound(self, away: Array, early: int) -> float | None:
        """E [J] for the ways x − x_0 along a touch, the first `early` of them before the first force."""
        if self.stored is None:
            return None
        helped = float(np.max(np.sign(self.force) * away[:early], initial=0.0))
        return self.stored + self.friction * float(np.abs(away).max()) + abs(self.force) * helped


@dataclass(frozen=True, kw_only=True)
class Start:
    """A loop and where its touch starts: numbers of the encoder, the converter, the clock."""

    law: Environment
    plant: Plant
    actuation: Actuation
    period: Fraction
    delay: Fraction
    resolution: float
    phase: float
    position: float
    regular: bool = True
    """False where samples may be late or missing."""

    @property
    def reading(self) -> float:
        """x_m."""
        return measured(self.position, self.resolution, self.phase)

    @property
    def middle(self) -> float:
        """y_0."""
        return self.position + (self.phase - 0.5) * self.resolution

    @property
    def beyond(self) -> float:
        """How far the hand is beyond the edge at which a wall begins."""
        return self.position + self.phase * self.resolution

    def limited(self, force: float) -> float:
        """What the actuator makes of a force at rest, its steps aside."""
        most = self.actuation.limit or inf
        return min(max(force, -most), most)

    def error(self, slope: float) -> float:
        """e: how far the force at rest may lie from f(y), for slopes up to this."""
        return 0.5 * (slope * self.resolution + self.actuation.step)

    def is_paid(self, rise: float, slope: float) -> bool:
        """True where b ≥ L T/2 and f_c ≥ e: then a law without memory and delay gives no more than Φ."""
        enough = self.plant.damping >= 0.5 * rise * float(self.period)
        at_once = self.regular and self.delay == 0
        return at_once and enough and self.plant.coulomb >= self.error(slope)


def rest_position(law: Environment, period: Fraction, start: float) -> float:
    """Where a touch that would start at `start` starts at rest, with nothing stored [m; rad]."""
    met = law.met
    if met.unilateral:
        return start
    if met.starts_at_rest:
        return 0.0  # so that positions in it are those of the handle
    if met.points:
        return _lowest(*_columns(met.points), start)
    stiffness = _static_stiffness(met, period)
    return start if stiffness == 0 else 0.0


def unloaded_range(law: Environment, force: float, here: float) -> tuple[float, float]:
    """Where a law holds no more than ``force`` over the way to where it is at rest [m; rad].

    The places around its rest, the nearest to `here`, up to where it first pushes with `force`.  Everywhere
    for a law that is no list of points: it holds little wherever it pushes little.  Nowhere, from ∞ to −∞,
    for one without a rest.

    Parameters
    ----------
    force
        ≥ 0 [N; N·m].
    here
        [m; rad].
    """
    met = law.met
    if not met.points:
        return -inf, inf
    x, f = _columns(met.points)
    if f[0] > 0.0 or f[-1] < 0.0:
        return inf, -inf
    rest = _lowest(x, f, here)
    grid, forces = _grid(x, f, rest, force)
    beyond = np.abs(forces) >= force if force > 0.0 else np.abs(forces) > 0.0
    left, right = grid[beyond & (grid < rest)], grid[beyond & (grid > rest)]
    low = float(left[-1]) if left.size else -inf
    high = float(right[0]) if right.size else inf
    return low, high


def held_at_start(at: Start, deepest: float) -> Held:
    """What the loop holds at the start; `deepest` is the largest reading of the touch."""
    met = at.law.met
    stepped = met.stepped(at.period)
    if stepped is not None:
        return Held(stored=None, unknown=LOADED) if stepped.stored else Held()
    if met.unilateral and at.reading <= 0.0:
        return Held(stored=at.plant.coulomb * max(at.beyond, 0.0))
    found = _of_law(at, met, deepest)
    if found.force and laws_of(at.law):
        return Held(stored=None, unknown=IN_A_CHAIN)
    if found.force and (at.actuation.lag or at.actuation.slew):
        return Held(stored=None, unknown=ON_THE_WAY)
    return found


def _of_law(at: Start, law: Environment, deepest: float) -> Held:
    if law.points:
        return _of_points(at, *_columns(law.points))
    if law.power_law is not None:
        return _of_contact(at, law.power_law, deepest)
    return _of_linear(at, law)


def _of_linear(at: Start, law: Environment) -> Held:
    stiffness = _static_stiffness(law, at.period)
    if stiffness is None:  # the memory is empty, as after a leap from 0 to x_0 within one sample
        b, fc, x = at.plant.damping, at.plant.coulomb, at.position
        return Held(stored=b / float(at.period) * x * x + fc * abs(x))
    k, y = float(stiffness), at.middle
    stored = 0.5 * max(k, 0.0) * (max(y, 0.0) if law.unilateral else y) ** 2
    force = at.limited(k * at.reading)
    if force == 0.0:
        return Held(stored=stored)
    alone = _is_memoryless(law, at.period)
    exact = (at.resolution == 0.0 or alone) and at.actuation.step == 0.0 and at.actuation.limit == 0.0
    tight = exact or (alone and at.is_paid(max(k, 0.0), abs(k)))
    return Held(stored=stored, friction=0.0 if tight else at.plant.coulomb + at.error(abs(k)), force=force)


def _static_stiffness(law: Environment, period: Fraction) -> Fraction | None:
    """H(1) [N/m; N·m/rad]; None where the law has a pole at 1 and does not settle."""
    numerator, denominator = law.pulse_transfer_function(period)
    below = sum(denominator, Fraction(0))
    return sum(numerator, Fraction(0)) / below if below else None


def _is_memoryless(law: Environment, period: Fraction) -> bool:
    """True where H(z) = H(1), common factors aside."""
    numerator, denominator = law.pulse_transfer_function(period)
    above, below = sum(numerator, Fraction(0)), sum(denominator, Fraction(0))
    padded = (Fraction(0),) * (len(denominator) - len(numerator)) + numerator
    return all(n * below == d * above for n, d in zip(padded, denominator, strict=True))


def _of_contact(at: Start, law: PowerLaw, deepest: float) -> Held:
    """K uⁿ at rest, whose steps are the higher the deeper."""
    k, n, y = float(law.stiffness), float(law.exponent), max(at.middle, 0.0)
    deep = max(deepest, at.reading) + at.resolution
    step = k * (deep**n - max(deep - at.resolution, 0.0) ** n) + 0.5 * at.actuation.step
    return Held(
        stored=k * y ** (n + 1) / (n + 1),
        friction=at.plant.coulomb + step,
        force=at.limited(k * max(at.reading, 0.0) ** n),
    )


def _of_points(at: Start, x: Array, f: Array) -> Held:
    if f[0] > 0.0 or f[-1] < 0.0:
        return Held(stored=None, unknown=DOWNHILL)
    slopes = np.diff(f) / np.diff(x)
    rise, steepest = max(float(slopes.max()), 0.0), float(np.abs(slopes).max())
    grid, forces = _grid(x, f, at.middle, at.actuation.limit)
    potential = _potential(grid, forces)
    stored = float(potential[np.searchsorted(grid, at.middle)] - potential.min())
    paid = at.is_paid(rise, steepest)
    return Held(
        stored=stored,
        friction=0.0 if paid else at.plant.coulomb + at.error(steepest),
        force=at.limited(float(np.interp(at.reading, x, f))),
    )


def _columns(points: tuple[tuple[Exact, Exact], ...]) -> tuple[Array, Array]:
    x, f = zip(*points, strict=True)
    return np.array(x, dtype=np.float64), np.array(f, dtype=np.float64)


def _lowest(x: Array, f: Array, start: float) -> float:
    """The place nearest to `start` at which Φ is least; `start` where it has no least value."""
    if f[0] > 0.0 or f[-1] < 0.0:
        return start
    grid, forces = _grid(x, f, start, 0.0)
    potential = _potential(grid, forces)
    spread = float(potential.max() - potential.min())
    low = grid[potential <= potential.min() + 1e-12 * spread]
    return float(low[np.abs(low - start).argmin()])


def _grid(x: Array, f: Array, place: float, limit: float) -> tuple[Array, Array]:
    """The points, `place`, and where the force is 0 or leaves the limit; the forces within the limit."""
    places = [place, *x]
    for level in (0.0, limit, -limit):
        for (x0, f0), (x1, f1) in pairwise(zip(x, f, strict=True)):
            if (f0 - level) * (f1 - level) < 0.0:
                places.append(x0 + (level - f0) * (x1 - x0) / (f1 - f0))
    grid = np.unique(places)
    forces = np.interp(grid, x, f)
    return grid, np.clip(forces, -limit, limit) if limit else forces


def _potential(grid: Array, forces: Array) -> Array:
    areas = np.diff(grid) * (forces[1:] + forces[:-1]) / 2
    return np.concatenate([[0.0], np.cumsum(areas)])
