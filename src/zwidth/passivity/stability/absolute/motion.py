"""Motions that a one-sided wall sustains: periodic, and found by solving, not by waiting.

    f = K max(x − g, 0),    x(j) = −Σ G_n(j − i) f(i),    i, j over one period of n samples

The pattern of samples inside is guessed, from simulated motions and from the simplest patterns, and corrected
until the solution has the pattern it was computed for (`corrected`).
"""

from __future__ import annotations

from collections.abc import Iterator
from math import cos, pi, sin
from typing import TYPE_CHECKING, Any, NamedTuple

import numpy as np
from numpy.typing import NDArray
from scipy.linalg import expm
from scipy.optimize import brentq
from scipy.signal import tf2ss

from zwidth.errors import InputError
from zwidth.model.device import Device
from zwidth.model.environment import Wall
from zwidth.model.operator.operator import LinearHand, Operator
from zwidth.passivity.certificate import FORMAT, Certificate
from zwidth.passivity.stability.absolute.criteria import linear_limit
from zwidth.passivity.stability.absolute.plant import Plant
from zwidth.quantity.exact import Exact
from zwidth.quantity.text import exact_text

if TYPE_CHECKING:
    import xarray as xr


_RUNS = 4
_SHORT = 14
"""Periods up to which every pattern with one touch is tried."""

_LARGEST = 1e6
_SMALLEST = 1e-6
"""Of |gap|: a smaller swing is rest, larger positions are on their way to infinity."""

_NEAR = (1.001, 1.002, 1.005, 1.01, 1.02, 1.05, 1.12, 1.25, 1.5)
_FACTORS = (*_NEAR, 1.75, 2.0, 2.5, 3.0, 4.0, 5.0, 5.5, 6.0, 7.0, 8.0, 10.0)
_HALVINGS = 14


class PeriodicMotion(NamedTuple):
    """A motion that repeats itself for ever, without any force from outside.

    `positions` are from where the hand rests without a wall; the wall begins at `gap`. `growth` is the
    largest factor by which a small deviation grows in one period: below 1 the motion attracts. `basin` is the
    share of the simulated starts that did not come to rest; `source` says of which plant it is a motion.
    ``certificate`` lets the independent checker solve for it.
    """

    slope: float
    gap: float
    positions: tuple[float, ...]
    growth: float
    basin: float
    source: dict[str, Any]

    @property
    def period(self) -> int:
        """In samples."""
        return len(self.positions)

    @property
    def inside(self) -> tuple[bool, ...]:
        """Which samples find the wall."""
        return tuple(x > self.gap for x in self.positions)

    @property
    def swing(self) -> float:
        """From the outermost to the innermost sample."""
        return max(self.positions) - min(self.positions)

    @property
    def certificate(self) -> Certificate:
        """Slope, gap and pattern, of kind "vibration": the checker solves for the motion itself."""
        document = {
            "format": FORMAT,
            "kind": "vibration",
            **self.source,
            "slope": exact_text(Exact(self.slope).fraction),
            "gap": exact_text(Exact(self.gap).fraction),
            "inside": list(self.inside),
        }
        return Certificate((document,))


def periodic_motion(plant: Plant, slope: float, gap: float, longest: int = 120) -> PeriodicMotion | None:
    """A periodic motion of at most `longest` samples, confirmed by the checker; None if none was found.

    One that attracts is preferred.

    Parameters
    ----------
    plant
        G.
    slope
        K > 0 of the wall.
    gap
        From where the hand rests to the surface, ≠ 0; < 0 for a hand that presses.
    longest
        Longest period tried [samples], 2 … 1000.
    """
    if not slope > 0 or gap == 0 or not 2 <= longest <= 1000:
        raise InputError(
            f"slope must be > 0, gap not 0 and longest 2 … 1000, got {slope:g}, {gap:g} and {longest}: "
            "a wall at the anchor itself has motions of every size or none"
        )
    runs = simulated(plant, slope, gap)
    alive = [run for run in runs if np.ptp(run) > _SMALLEST * abs(gap)]
    found: PeriodicMotion | None = None
    for guess in _guesses(alive, gap, longest):
        positions = corrected(plant, slope, gap, guess)
        if positions is None or np.ptp(positions) <= _SMALLEST * abs(gap):
            continue
        growth = growth_of(plant, slope, positions > gap)
        if found is not None and growth >= min(found.growth, 1.0):
            continue
        share = len(alive) / len(runs)
        motion = PeriodicMotion(slope, gap, tuple(positions.tolist()), growth, share, plant.source)
        if motion.certificate.verify():
            found = motion
            if growth < 1:
                break
    return found


def smallest_motion(plant: Plant, low: float, gap: float, longest: int = 120) -> PeriodicMotion | None:
    """The periodic motion of the smallest slope found, a few slopes from `low` up to ten times as much tried.

    Not the smallest there is: between those slopes, and with other patterns, there may be others.
    """
    for factor in _FACTORS:
        found = periodic_motion(plant, low * factor, gap, longest)
        if found is not None:
            return _softened(plant, found, low)
    return None


def _guesses(runs: list[Array], gap: float, longest: int) -> Iterator[Array]:
    """One period each: ends of simulated motions, then one touch of every length."""
    finite = [run for run in runs if np.abs(run).max() < _LARGEST * abs(gap)]
    for run in finite[:: max(1, len(finite) // _RUNS)]:
        for period in returns(run, longest):
            yield run[-period:]
    for period in range(2, min(_SHORT, longest) + 1):
        for touches in range(1, period):
            yield np.where(np.arange(period) < touches, gap + 1.0, gap - 1.0)


def _softened(plant: Plant, motion: PeriodicMotion, low: float) -> PeriodicMotion:
    """The same motion, followed to the smallest slope down to which it exists."""
    best, gap = motion, motion.gap
    for _ in range(_HALVINGS):
        slope = (low + best.slope) / 2
        positions = corrected(plant, slope, gap, np.array(best.positions))
        if positions is None or np.ptp(positions) <= _SMALLEST * abs(gap):
            low = slope
            continue
        growth = growth_of(plant, slope, positions > gap)
        softer = motion._replace(slope=slope, positions=tuple(positions.tolist()), growth=growth)
        if softer.certificate.verify():
            best = softer
        else:
            low = slope
    runs = simulated(plant, best.slope, gap)
    moving = sum(bool(np.ptp(run) > _SMALLEST * abs(gap)) for run in runs)
    return best._replace(basin=moving / len(runs))


# Periodic motions of a piecewise linear loop: guessed by simulation, corrected, and then certain.
#
# For a given pattern of samples inside the equation of a periodic motion is linear.  Solve it, take the
# pattern of the solution, and solve again (Newton's method for a piecewise linear equation) until the two
# agree.  Then it is solved once more with error bounds, and the signs of all x − g are certain.


_STARTS = 36
_SETTLING = 6000
_CANDIDATES = 10
_CORRECTIONS = 40
_PRECISION = 256
_LOST = 1e300

Array = NDArray[np.float64]


def simulated(plant: Plant, slope: float, gap: float) -> list[Array]:
    """The last samples of motions from starts all around."""
    a, b, c, _ = tf2ss(plant.numerator, plant.denominator)
    rng = np.random.default_rng(0)
    state = rng.normal(size=(len(a), _STARTS))
    reach = np.zeros(_STARTS)
    free = state.copy()
    for _ in range(200):  # the scale of a start is how far it would swing without a wall
        reach = np.maximum(reach, np.abs(c @ free)[0])
        free = a @ free
    state *= abs(gap) * np.logspace(0.2, 3.5, _STARTS) / reach
    kept = np.empty((_SETTLING, _STARTS))
    with np.errstate(over="ignore", invalid="ignore"):
        for j in range(_SETTLING):
            kept[j] = (c @ state)[0]
            state = a @ state - b @ (slope * np.maximum(kept[j] - gap, 0.0))[None, :]
    kept = np.nan_to_num(kept[-_SETTLING // 4 :], nan=_LOST, posinf=_LOST, neginf=-_LOST)
    return [kept[:, i] for i in range(_STARTS)]


def returns(run: Array, longest: int) -> list[int]:
    """Periods after which the run nearly repeats, the best first."""
    errors = {n: float(np.abs(run[n:] - run[:-n]).max()) for n in range(2, longest + 1)}
    return sorted(errors, key=errors.__getitem__)[:_CANDIDATES]


def corrected(plant: Plant, slope: float, gap: float, positions: Array) -> Array | None:
    n = len(positions)
    angles = 2 * np.pi * np.arange(n) / n
    kernel = np.fft.ifft(plant.response(angles)).real
    moved = kernel[(np.arange(n)[:, None] - np.arange(n)[None, :]) % n]
    inside = positions > gap
    tried: set[bytes] = set()
    while inside.tobytes() not in tried and len(tried) < _CORRECTIONS:
        tried.add(inside.tobytes())
        force = moved * (slope * inside)
        try:
            positions = np.linalg.solve(np.eye(n) + force, gap * force.sum(axis=1))
        except np.linalg.LinAlgError:
            return None
        if ((positions > gap) == inside).all():
            return positions
        inside = positions > gap
    return None


def growth_of(plant: Plant, slope: float, inside: NDArray[np.bool_]) -> float:
    a, b, c, _ = tf2ss(plant.numerator, plant.denominator)
    total = np.eye(len(a))
    for touches in inside:
        total = (a - slope * b @ c if touches else a) @ total
    return float(np.abs(np.linalg.eigvals(total)).max())


# A guess at the motion that a one-sided wall sustains: its mean and its first harmonic, nothing above.
#
#     x = x̄ + a cos ωt,    f = K max(x − g, 0),    inside while |ωt| < β,  cos β = (g − x̄)/a
#
#     gain      N(β) = (K/π)(β − sin β cos β),    1 + N G(e^{jωT}) = 0  ⇒  N = K_lin
#     mean      x̄ = −G(1) (K a/π)(sin β − β cos β)
#     gap       g = a [cos β − G(1) (K/π)(sin β − β cos β)]
#
# A heuristic: it neglects every harmonic, and that a sampled motion meets the surface at samples only.  It
# bounds nothing, from above or below.


class Guess(NamedTuple):
    """`amplitude` a in units of |gap|, `contact` β/π, the share of the time inside."""

    amplitude: float
    contact: float


def describing_guess(plant: Plant, slope: float, gap: float) -> Guess | None:
    """The motion that the describing function expects, None where it expects none.

    Parameters
    ----------
    plant
        G.
    slope
        K of the wall.
    gap
        From where the hand rests to the surface; < 0 for a hand that presses.
    """
    share = linear_limit(plant).slope / slope
    if not share < 1:
        return None
    beta = float(brentq(lambda b: (b - sin(b) * cos(b)) / pi - share, 0.0, pi))
    reach = _reach(plant, slope, beta)
    if gap == 0 or reach / gap <= 0:
        return None
    return Guess(1 / abs(reach), beta / pi)


def _reach(plant: Plant, slope: float, beta: float) -> float:
    """g/a."""
    still = plant.response_at(0.0).real
    return cos(beta) - still * slope / pi * (sin(beta) - beta * cos(beta))


def replay_motion(
    device: Device, hand: LinearHand | Operator, motion: PeriodicMotion, rounds: int = 20
) -> xr.Dataset:
    """Simulate the motion for so many periods, from its first sample on.

    The wall begins at x = 0, the hand is anchored at −gap.  With a delay the forces under way at the first
    sample are missing: a motion that attracts is come back to.

    Parameters
    ----------
    device, hand
        As for `absolute_stability`.
    motion
        A `PeriodicMotion` of them.
    rounds
        Periods to simulate.
    """
    from zwidth.loop.simulate import simulate  # xarray takes its time
    from zwidth.model.operator.prescribed_motion import Tracking

    own = hand.hand if isinstance(hand, Operator) else hand
    period, count = float(device.exact("sample_period")), motion.period * rounds
    tied = Tracking(
        np.full(count + 1, -motion.gap), stiffness=own.stiffness, damping=own.damping, mass=own.mass
    )
    return simulate(
        device,
        Wall(stiffness=motion.slope),
        tied,
        count * period,
        initial_position=motion.positions[0] - motion.gap,
        initial_velocity=_velocity(device, own, motion),
    )


def _velocity(device: Device, hand: LinearHand, motion: PeriodicMotion) -> float:
    """ẋ at the first sample, from the first two positions and the forces between them."""
    mass = float(device.exact("mass")) + hand.mass
    flow = np.zeros((3, 3))
    flow[0, 1], flow[1, 2] = 1.0, -1 / mass
    flow[1, 0], flow[1, 1] = -hand.stiffness / mass, -(float(device.exact("damping")) + hand.damping) / mass
    period = float(device.exact("sample_period"))
    late, part = divmod(float(device.exact("delay")) / period, 1.0)
    whole, rest = expm(flow * period), expm(flow * period * (1 - part))
    new, old = (motion.slope * max(motion.positions[-int(late) - i] - motion.gap, 0.0) for i in (0, 1))
    pushed = rest[0, 2] * new + (whole[0, 2] - rest[0, 2]) * old
    first, second = motion.positions[:2]
    return float((second - whole[0, 0] * first - pushed) / whole[0, 1])
