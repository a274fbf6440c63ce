"""A plan: how to move the device by hand, for how long, and when to stop.

    K ≤ min(2b/T, 2f_c/Δ)

(Abbott & Okamura 2005): of b and f_c only the one that sets the limit must be known well, and the plan gives
the time to the speeds that tell it.  Its guess of m, b, f_c and of the noise may be poor: after each run the
data decide, `MeasurementPlan.reached`.

Of a device on a cable a hand that moves the handle tells the sums of both sides.  Three recordings tell them
apart: the motor shaken, the handle free; the handle held and tapped; the handle free and tapped,

    ω_held² = k/m₁,   ω_free² = k (1/m₁ + 1/m₂),   so   m₁/m₂ = (ω_free/ω_held)² − 1 .
"""

from __future__ import annotations

from collections.abc import Iterator
from dataclasses import dataclass
from math import ceil, inf, pi
from typing import Literal, NamedTuple

import numpy as np
from scipy.special import ndtri

from zwidth.data.identification.device.identify import Identified
from zwidth.data.identification.device.moments import SECONDS
from zwidth.data.identification.device.two_masses import MOST
from zwidth.errors import InputError
from zwidth.model.device.device import Device, in_one
from zwidth.native.compiled import Array
from zwidth.quantity.exact import RealLike, ends
from zwidth.quantity.parameter import read_number
from zwidth.quantity.text import shown, told_quantity
from zwidth.showing import Shown

RUN = 30.0
"""Length of a run [s]: a load cell is zeroed again after it."""

FEWEST_STROKES = 60
"""Below which an interval may be short by chance, and is not believed."""

MARGIN = 1.15
"""Times the speed to be seen, that fast strokes have: they vary, and means over pulses are less."""

LEAST_SHARE = 0.1
"""Of the time for the fast and for the slow strokes: a curved friction shows only where there are both."""


@dataclass(frozen=True, kw_only=True, repr=False)
class MeasurementPlan(Shown):
    """How to move a device so that its limit becomes known.

    Parameters
    ----------
    limits
        Which parameter sets the limit of a wall: "damping" or "coulomb_friction".
    guess
        The device as it was guessed.
    strokes, shares
        Kinds of strokes, and the share of the time for each.
    force_noise
        Standard deviation of the force, per sample [N; N·m].
    precision
        Half-width of the interval that is wanted, in parts of the parameter.
    confidence
        Of that interval.
    speed
        Up to which friction is to be seen, both ways [m/s; rad/s]; None: nothing is asked.
    apart
        The device as it was guessed, where motor and handle move apart: `guess` is then both in one.
    """

    limits: Literal["damping", "coulomb_friction"]
    guess: Device
    strokes: tuple[Stroke, ...]
    shares: tuple[float, ...]
    force_noise: float
    precision: float
    confidence: float
    speed: float | None = None
    apart: Device | None = None

    def errors(self, seconds: float) -> dict[str, float]:
        """Standard errors of mass, damping and Coulomb friction to expect after so much recorded motion.

        Raises
        ------
        InputError
            If seconds is not > 0.
        """
        if not 0 < seconds < inf:
            raise InputError(f"seconds must be > 0, got {seconds!r}: so long the motion was recorded")
        period = float(self.guess.exact("sample_period"))
        variances = np.diag(covariance(self.strokes, self.shares, self.force_noise, period, seconds))
        return dict(zip(PARAMETERS, np.sqrt(variances).tolist(), strict=True))

    @property
    def seconds(self) -> float:
        """Recorded motion after which the limit should be known as well as wanted [s]."""
        reach = float(ndtri(0.5 + self.confidence / 2)) * self.errors(1.0)[self.limits]
        return (reach / (self.precision * float(self.guess.exact(self.limits)))) ** 2

    @property
    def runs(self) -> int:
        """How many runs of `RUN` seconds that is, at least as many as have `FEWEST_STROKES`."""
        each = sum(w * RUN / s.duration for w, s in zip(self.shares, self.strokes, strict=True))
        return max(ceil(self.seconds / RUN), ceil(FEWEST_STROKES / each))

    @property
    def force(self) -> float:
        """Largest force of the hand to expect: m a + b v + f_c [N; N·m]."""
        m, b, f_c = (float(self.guess.exact(name)) for name in PARAMETERS)
        return max(m * s.acceleration for s in self.strokes) + b * max(s.speed for s in self.strokes) + f_c

    def reached(self, found: Identified) -> bool:
        """True where the limit is known as well, and up to the speed, that was wanted: stop.

        Parameters
        ----------
        found
            Of all runs so far together, see `Log.concatenate`.
        """
        value = found.estimates[self.limits].value
        low, high = found.estimates[self.limits].interval(self.confidence)
        seen = self.speed is None or found.speed >= self.speed
        return seen and found.strokes >= FEWEST_STROKES and high - low <= 2 * self.precision * value

    def report(self) -> Iterator[str]:
        """The protocol for a person."""
        return _protocol(self)


def _protocol(plan: MeasurementPlan) -> Iterator[str]:
    symbol, wall = {"damping": ("b", "2b/T"), "coulomb_friction": ("f_c", "2f_c/Δ")}[plan.limits]
    known = f"within ±{shown(plan.precision, '%', 3)} ({shown(plan.confidence, '%')} confidence)"
    yield f"To know {symbol}, which sets the limit K = {wall}, {known}:"
    yield (
        "1. Motor off. Hold the handle by the load cell and by nothing else; "
        f"up to {told_quantity(plan.force, 'force', plan.guess.motion, 2)} will act."
    )
    yield "2. Let go, set the zero of the load cell, start to record."
    for n, (stroke, share) in enumerate(zip(plan.strokes, plan.shares, strict=True), start=3):
        yield f"{n}. {_spoken(stroke, share, plan.guess.motion)}"
    yield (
        f"{3 + len(plan.strokes)}. Stop the recording. Identify all runs so far together. "
        f"With {FEWEST_STROKES} strokes or more, and {symbol} known so well: done. Else go on with 2."
    )
    runs = f"{plan.runs} run{'s' if plan.runs > 1 else ''}"
    yield f"Expected: {runs} of {shown(RUN, 's')}. Vary lengths and times, do not rest, do not hit the stops."
    yield _reached(plan)
    if plan.apart is not None:
        yield from _each_side(plan, plan.apart)


def _each_side(plan: MeasurementPlan, device: Device) -> Iterator[str]:
    """What tells motor and handle apart, and what each recording yields."""
    period, dry = (float(plan.guess.exact(name)) for name in ("sample_period", "coulomb_friction"))
    assert device.transmission is not None
    rings = device.transmission.rings(device.mass)
    held, free = (f", by the guess {shown(f, 'Hz', 3)}" if f else "" for f in rings)
    shake = told_quantity(5 * dry, "force", device.motion, 2)
    yield (
        "So far m, b and f_c are those of motor and handle together, and walls rest on the motor's alone: "
        "b₁ + c b₂/(c + b₂). Record each of these too, the encoder at the motor, in a file of its own."
    )
    yield (
        f"· Nobody at the handle. Let the motor make slow strokes and on top a force of some {shake}, drawn "
        f"anew every other sample, for {shown(MOST * period, 's', 2)}; identify it with the actuator's force "
        "alone: m, b and f_c of each side, k and c."
    )
    yield (
        f"· Clamp the handle, motor off, tap the motor. It rings at f_held = √(k/m₁)/2π{held}, and where the "
        "swing is large against dry friction dies out as e^(−δt): b₁ + c = 2 m₁ δ."
    )
    yield (
        f"· Nobody at the handle, motor off, tap it. Both ring at f_free = √(k (1/m₁ + 1/m₂))/2π{free}: "
        "m₁/m₂ = (f_free/f_held)² − 1; with m₁ + m₂ from the strokes each mass, and k = m₁ (2π f_held)²."
    )
    yield "Where these differ, more gives way than one spring: take the cable off, and rely on the motor's b."


def _reached(plan: MeasurementPlan) -> str:
    """Up to which speed friction will be seen, and what is known of it: a promise ends there."""
    will = max(s.speed for s in plan.strokes) / MARGIN
    seen = told_quantity(will, "friction_speed", plan.guess.motion, 2)
    told = f"Friction will be seen up to some {seen}; at higher speeds it will not be known."
    if plan.guess.friction_speed is None:
        return told
    before = float(ends(plan.guess.friction_speed)[0])
    if before >= will:
        told = f"{told[:-1]}: state the speed that a hand may have."
    so_far = told_quantity(before, "friction_speed", plan.guess.motion, 3)
    return f"So far it was seen up to {so_far}. {told}"


def _spoken(stroke: Stroke, share: float, motion: str) -> str:
    size = told_quantity(stroke.length, "position", motion, 3)
    count = max(round(share * RUN / stroke.duration), 1)
    return f"{count} strokes of some {size}, {shown(stroke.duration, 's', 3)} each, to and fro."


def plan_identification(
    guess: Device | Identified,
    *,
    force_noise: RealLike | None = None,
    length: RealLike = 0.06,
    slow: RealLike = 1.0,
    fast: RealLike = 0.25,
    precision: float = 0.05,
    confidence: float = 0.95,
    speed: RealLike | None = None,
) -> MeasurementPlan:
    """Plan the motion that tells how stiff a wall may be, ``K ≤ min(2b/T, 2f_c/Δ)``.

    Parameters
    ----------
    guess
        A device with mass, damping, Coulomb friction, resolution and sample period, of intervals the
        middle; or what a first run showed.  Of one with a transmission the plan says what tells both sides
        apart too.
    force_noise
        σ > 0 of the measured force, per sample [N; N·m]; None: what the first run showed.
    length
        L > 0 of a stroke that a person can make [m; rad]: as long as the workspace allows.
    slow, fast
        Time of a slow stroke and of the fastest a person can make, slow > fast > 0 [s].
    precision
        Wanted half-width, in parts of the value, between 0 and 1.
    confidence
        Between 0 and 1.
    speed
        Up to which friction is to be seen, into the wall and out of it, > 0 [m/s; rad/s]: the fast strokes
        are made quick enough.  None: what they are.

    Raises
    ------
    InputError
        If a number is outside its bound, or the guess lacks one.
    """
    whole = guess.device(None) if isinstance(guess, Identified) else guess
    device = in_one(whole)
    if force_noise is None:
        if not isinstance(guess, Identified):
            raise InputError("force_noise is needed with a guessed device: σ of the load cell per sample [N]")
        force_noise = guess.force_noise
    noise, length = _positive("force_noise", force_noise, "force"), _positive("length", length, "position")
    slow, fast = _positive("slow", slow, "sample_period"), _positive("fast", fast, "sample_period")
    speed = None if speed is None else _positive("speed", speed, "speed")
    for name, value in {"precision": precision, "confidence": confidence}.items():
        if not 0 < value < 1:
            raise InputError(f"{name} must be between 0 and 1, got {value!r}; 0.05 and 0.95 are usual")
    if slow <= fast:
        given = f"slow {shown(slow, 's', 6)} and fast {shown(fast, 's', 6)}"
        raise InputError(f"a slow stroke takes longer than a fast one, got {given}")
    limits = _limiting(device)
    if speed is not None:
        fast = min(fast, length / 2 * pi / (MARGIN * speed))
    strokes = (Stroke(length, slow), Stroke(length, fast))
    shares = np.clip(best_shares(strokes, limits), LEAST_SHARE, 1 - LEAST_SHARE)
    return MeasurementPlan(
        limits=limits,
        guess=device,
        strokes=strokes,
        shares=tuple(shares.tolist()),
        force_noise=noise,
        precision=precision,
        confidence=confidence,
        speed=speed,
        apart=None if whole.transmission is None else whole,
    )


def _positive(name: str, value: RealLike, quantity: str) -> float:
    return float(read_number(value, quantity, name, bound="> 0", why="no plan can be made without it"))


def _limiting(device: Device) -> Literal["damping", "coulomb_friction"]:
    if device.mass is None:
        told = 'inertia: a rough one is enough, for example --inertia "0.01 kg*m^2"'
        if device.motion == "linear":
            told = 'mass: a rough one is enough, for example --mass "0.1 kg"; a kitchen scale will do'
        raise InputError(f"the guess has no {told}")
    for name in ("damping", "coulomb_friction"):
        if not float(device.exact(name)) > 0:
            raise InputError(
                f"the guess of {name} must be > 0: it shall be known to a part of itself; guess roughly"
            )
    by_damping = device.exact("damping") / device.exact("sample_period")
    coarse = device.exact("resolution")
    if not coarse or by_damping <= device.exact("coulomb_friction") / coarse:
        return "damping"
    return "coulomb_friction"


# Which motion tells a device fastest, and how well a motion will tell it.
#
#     I = (1/(σ² T)) Σ_i w_i M_i,      M = mean of a aᵀ over strokes of one kind,   a = (ẍ, ẋ, sgn ẋ)
#     V(t) = γ² I⁻¹/t
#
# is the covariance of m, b, f_c after t seconds, a share w_i of them spent on strokes of kind i: as for any
# least squares, the guesses of m, b, f_c do not enter, the noise σ of the force and the motion do.  Strokes
# go to and fro, each x = −½L cos(πt/D); the line that the zero of a load cell drifts along in ten seconds is
# taken out of a first, as `identify` does.  γ is what `identify` loses against that, its allowance for the
# method included: `INEFFICIENCY`.  The shares are those with the least cᵀVc, c for the parameter that limits
# the wall (c-optimal; Elfving 1952).  One speed alone does: along a stroke it varies; a slow and a fast one
# do better.

PARAMETERS = ("mass", "damping", "coulomb_friction")

INEFFICIENCY = 1.2
"""γ, on the safe side of what was measured: docs/theory/identification.md."""

SAMPLES = 4000
"""At which the regressors of ten seconds are taken."""


class Stroke(NamedTuple):
    """From one end to the other.

    Parameters
    ----------
    length
        L [m; rad].
    duration
        D [s].
    """

    length: float
    duration: float

    @property
    def acceleration(self) -> float:
        """At the turns [m/s²; rad/s²]."""
        return float(self.length / 2 * (np.pi / self.duration) ** 2)

    @property
    def speed(self) -> float:
        """In the middle [m/s; rad/s]."""
        return float(self.length / 2 * np.pi / self.duration)

    def information(self) -> Array:
        """M, the lines taken out."""
        time = (np.arange(SAMPLES) + 0.5) * SECONDS / SAMPLES
        phase = np.pi * time / self.duration
        way = np.sin(phase)
        columns = [self.acceleration * np.cos(phase), self.speed * way, np.sign(way)]
        matrix = np.stack(columns, axis=1)
        lines = np.linalg.qr(np.stack([np.ones(SAMPLES), time], axis=1))[0]
        matrix -= lines @ (lines.T @ matrix)
        return np.asarray(matrix.T @ matrix / SAMPLES)


def covariance(
    strokes: tuple[Stroke, ...], shares: tuple[float, ...], noise: float, period: float, seconds: float
) -> Array:
    """V of m, b, f_c after t = `seconds` with these shares of each kind; σ = `noise` per sample [N; N·m]."""
    mean = sum(w * s.information() for w, s in zip(shares, strokes, strict=True))
    scale = (INEFFICIENCY * noise) ** 2 * period / seconds
    return np.asarray(scale * np.linalg.inv(mean), dtype=np.float64)


def best_shares(strokes: tuple[Stroke, ...], parameter: str) -> tuple[float, ...]:
    """Shares of the time that make a parameter's variance smallest. By w_i ← w_i √(vᵀ M_i v / vᵀ M v), v =
    M⁻¹ c, which never makes it larger (Fellman 1974)."""
    informations = np.stack([s.information() for s in strokes])
    c = np.eye(len(PARAMETERS))[PARAMETERS.index(parameter)]
    shares = np.full(len(strokes), 1 / len(strokes))
    for _ in range(500):
        v = np.linalg.solve(np.tensordot(shares, informations, 1), c)
        each = np.einsum("i,kij,j->k", v, informations, v)
        shares = shares * np.sqrt(each / (shares @ each))
        shares /= shares.sum()
    return tuple(shares.tolist())
