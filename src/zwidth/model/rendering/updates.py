"""Environments that are updated every N samples: a local spring in between, or the force held.

Dual rate: an environment that is updated every N samples, a local spring in between.

    f = F + κ (x − X)                       X, F those of the last update; ≥ 0 for a wall,
                                            0 until the next update where the wall pushed with 0
    s ← s + (f² − F'²)/(2κ) ≥ 0             at an update, f the old spring's force, F' the new one's
    F' = w, limited to √(f² + 2κ s)         w the environment's force

Mahvash & Hayward (2005) published local models with slope ≤ 2b/T, force and potential continuous at updates.
How they choose them is not known here; this is derived for this project: f²/(2κ) is the potential of the
local spring, s what has been put in beyond it.  A force that would have to rise at an update without being
paid for stays continuous; one that has to fall falls, and that pays.
"""

from __future__ import annotations

from dataclasses import dataclass
from math import sqrt
from typing import ClassVar, Literal

from zwidth.model.rendering.passivity_controller import NO_LIMIT
from zwidth.model.rendering.reading import damping_per_sample, updated_every
from zwidth.model.rendering.rendering_law import LoopContext, RenderingLaw, Theorem, half_a_step
from zwidth.native.compiled import Array, compiled
from zwidth.quantity.parameter import CertainOrNone, Count, exact, word

DUAL_RATE = 24.0

_DUAL_SAMPLES, _SLOPE, _PUSHES, _JUMPS, _LIMIT = range(5)
_DUAL_LEFT, _REFERENCE, _DUAL_FORCE, _OFF, _SPARE = range(5)


@dataclass(frozen=True, kw_only=True)
class DualRate(RenderingLaw):
    """``f = F + κ (x − X)`` between updates every N samples, F paid for by potential, κ ≤ 2b/T.

    Proved, where κ ≤ 2b/T and updates are "continuous": no motion of any hand takes energy out, whatever
    the environment and however large N.  Refuted for "jump".  Hypotheses: the device takes at least b; an
    encoder without counts; no delay, regular samples, no law behind this one, an amplifier without lag, with
    no other force limit than the device's, whose steps ΔF, if it has any, cost f_c ≥ ΔF/2.  Where the
    environment is unilateral, its forces below 0 are 0.

    Parameters
    ----------
    samples
        N, samples between two updates.  The first sample updates.
    slope
        κ [N/m; N·m/rad]; None: the environment's stiffness, at most 2b/T.
    updates
        "continuous": at an update the force rises only as far as that is paid for.  "jump": it becomes
        the environment's.

    Raises
    ------
    InputError
        If samples is not a whole number ≥ 1, slope not > 0, or updates none of these words; when it is
        simulated, if slope is None and the device has no damping.
    """

    code: ClassVar[float] = DUAL_RATE
    state_size: ClassVar[int] = 5

    samples: Count = updated_every()
    slope: CertainOrNone = exact(
        "stiffness", None, "> 0", "it is that of a local spring", "κ, by default what b pays for"
    )
    updates: Literal["continuous", "jump"] = word("continuous", "jump")

    def numbers(self, at: LoopContext) -> list[float]:
        if self.slope is None:
            steepest = 2 * damping_per_sample(at, "a local spring without slope")
            slope = min(at.stiffness, steepest) if at.stiffness > 0.0 else steepest
        else:
            slope = float(self.slope)
        limit = at.device.force_limit
        return [
            float(self.samples),
            slope,
            float(at.environment.unilateral),
            float(self.updates == "jump"),
            NO_LIMIT if limit is None else float(at.device.exact("force_limit")),
        ]

    def initial_state(self, reading: float) -> list[float]:
        """No spring yet, and an update is due."""
        return [0.0, reading, 0.0, 1.0, 0.0]

    def theorem(self, at: LoopContext) -> Theorem | None:
        """Where the device can pay for the local spring, and friction for the steps of the converter."""
        slope = 0 if self.slope is None else self.slope.fraction
        paid = slope <= 2 * at.device.exact("damping") / at.device.exact("sample_period")
        if not (paid and self.updates == "continuous"):
            return None
        return Theorem(
            statement="a local spring of at most 2b/T whose force is paid for at every update",
            counts_force_steps=True,
            counts_force_limit=True,
            coulomb_friction=half_a_step(at.device),
        )

    def describe(self, motion: str = "linear") -> str:
        parts = [f"updated every {self.samples} samples"]
        parts += [] if self.slope is None else [f"slope {self.with_unit('slope', motion)}"]
        return f"local spring ({', '.join([*parts, f'{self.updates} updates'])})"


@compiled
def dual_rate_step(p: Array, i: int, s: Array, j: int, x: float, force: float, applied: float) -> float:
    """One sample; p from i and s from j on are this law's."""
    slope, pushes = p[i + _SLOPE], p[i + _PUSHES] > 0.0
    here = 0.0 if s[j + _OFF] > 0.0 else s[j + _DUAL_FORCE] + slope * (x - s[j + _REFERENCE])
    if pushes:
        here = max(here, 0.0)
    if s[j + _DUAL_LEFT] <= 0.0:
        new = max(force, 0.0) if pushes else force
        if p[i + _JUMPS] == 0.0:
            here = min(max(here, -p[i + _LIMIT]), p[i + _LIMIT])  # what was not given was not paid for
            room = sqrt(here * here + 2 * slope * s[j + _SPARE])
            new = min(max(new, -room), room)
            s[j + _SPARE] = max(s[j + _SPARE] + (here - new) * (here + new) / (2 * slope), 0.0)
        s[j + _DUAL_LEFT], s[j + _REFERENCE], s[j + _DUAL_FORCE] = p[i + _DUAL_SAMPLES], x, new
        s[j + _OFF] = 1.0 if pushes and force <= 0.0 else 0.0
        here = new
    s[j + _DUAL_LEFT] -= 1.0
    return here


# An environment that is updated every N samples, its force held in between.
#
#     f_k = F_n,   F_n the environment's force at sample n N,   n N ≤ k < (n + 1) N
#
# as where a slow simulation drives a fast device: Hannaford & Ryu (2002) updated theirs at
# 66.7 Hz, every 15 samples.  For the hand it is a loop of period N T, so a spring needs
# K ≤ 2b/(N T); and with an encoder K ≤ 2 f_c/Δ as before.

HELD = 25.0

_HELD_SAMPLES = 0
_HELD_LEFT, _HELD_FORCE = range(2)


@dataclass(frozen=True, kw_only=True)
class Held(RenderingLaw):
    """The force of every N-th sample, held for N: an environment that is updated slowly.

    It promises nothing: a spring K is passive behind it if and only if it is in a loop of period N T,
    K ≤ min(2b/(N T), 2 f_c/Δ).  The environment itself runs at every sample, so a velocity in it is that
    of one sample; a law behind this one runs at every sample too.

    Parameters
    ----------
    samples
        N, samples between two updates.  The first sample updates.

    Raises
    ------
    InputError
        If samples is not a whole number, at least 1.
    """

    code: ClassVar[float] = HELD
    state_size: ClassVar[int] = 2

    samples: Count = updated_every()

    def numbers(self, at: LoopContext) -> list[float]:
        return [float(self.samples)]

    def initial_state(self, reading: float) -> list[float]:
        """An update is due."""
        return [0.0, 0.0]

    def describe(self, motion: str = "linear") -> str:
        return f"updated every {self.samples} samples"


@compiled
def held_step(p: Array, i: int, s: Array, j: int, x: float, force: float, applied: float) -> float:
    """One sample; p from i and s from j on are this law's."""
    if s[j + _HELD_LEFT] <= 0.0:
        s[j + _HELD_LEFT], s[j + _HELD_FORCE] = p[i + _HELD_SAMPLES], force
    s[j + _HELD_LEFT] -= 1.0
    held: float = s[j + _HELD_FORCE]
    return held
