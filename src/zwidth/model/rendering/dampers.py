"""Laws that dissipate: a damper, a spring that slips, a term in the rate of the force.

A damper behind any environment, fed by a velocity estimator that is not linear.

    f ← f + B v̂    if x > 0     (everywhere, where the environment has no surface)

The estimator runs outside too, so that it knows the velocity at the first sample inside.
`Wall(damping=…)` is the same with a linear estimator, and has certificates.
"""

from __future__ import annotations

from dataclasses import KW_ONLY, dataclass
from fractions import Fraction
from typing import ClassVar

from zwidth.errors import InputError
from zwidth.model.device.device import Device
from zwidth.model.rendering.reading import stiffness as stiffness_of
from zwidth.model.rendering.rendering_law import LoopContext, RenderingLaw
from zwidth.model.rendering.velocity import Estimator, estimate, estimated, packed
from zwidth.native.compiled import Array, compiled
from zwidth.quantity.exact import Exact
from zwidth.quantity.parameter import Certain, CertainOrNone, Reads, exact, flag

DAMPER = 10.0

_DAMPING, _DAMPER_SURFACE, _DAMPER_CLAMPED, _ESTIMATOR = range(4)


@dataclass(frozen=True)
class Damper(RenderingLaw):
    """Virtual damping on an estimated velocity, ``f ← f + B v̂ if x > 0``.

    Parameters
    ----------
    damping
        B ≥ 0 [N·s/m; N·m·s/rad].
    velocity
        `AdaptiveWindow(…)` (default), `TickTime()` or `Kalman(…)`.
    clamped
        True: the sum never pulls, ``f ← max(0, f + B v̂)``.  Default False.

    Raises
    ------
    InputError
        If B < 0, or one of the others is none of these.
    """

    code: ClassVar[float] = DAMPER

    damping: Certain = exact(
        "virtual_damping", bound="≥ 0", why="a negative damper drives the hand", meaning="B of the damper"
    )
    velocity: Reads[Estimator, Estimator | None] = estimated()
    clamped: bool = flag("for a sum that never pulls", False)

    @property
    def state_size(self) -> int:  # type: ignore[override]  # it is the estimator's, known once it is chosen
        """Those of the estimator."""
        return self.velocity.state_size

    def numbers(self, at: LoopContext) -> list[float]:
        """B, whether there is a surface, whether it is clamped, the estimator's."""
        gates = [float(at.environment.unilateral), float(self.clamped)]
        return [float(self.damping), *gates, *packed(self.velocity, at)]

    def initial_state(self, reading: float) -> list[float]:
        return self.velocity.initial_state(reading)

    def describe(self, motion: str = "linear") -> str:
        never = ", never pulls" if self.clamped else ""
        return f"damper of {self.with_unit('damping', motion)} on {self.velocity.describe(motion)}{never}"


@compiled
def damper_step(p: Array, i: int, s: Array, j: int, x: float, force: float, applied: float) -> float:
    """One sample; p from i and s from j on are this law's."""
    velocity = estimate(p, i + _ESTIMATOR, s, j, x)
    if p[i + _DAMPER_SURFACE] > 0.0 and x <= 0.0:
        return force
    force += p[i + _DAMPING] * velocity
    return max(force, 0.0) if p[i + _DAMPER_CLAMPED] > 0.0 else force


# Friction inside the wall that depends on the way, not on the speed: a spring that slips.
#
#     s ← clamp(s + k Δu, −h … h),   f ← f + s    inside,   s = 0 outside,   u = max(x, 0)
#
# That rate-independent hysteresis makes a wall stiffer to render is from Goldfarb & Wang
# (1999); this law, the elastic–plastic element of Prandtl, and its size are derived for this
# project.  A cycle of depth D ≫ h/k takes 2 h D out.  The hold leaks ½ K (v T)² a sample,
# ½ K v T D on the way in and again on the way out, so that
#
#     h ≥ ½ K v_max T
#
# pays for it up to the speed v_max.  A velocity is not needed: no noise of the encoder is
# amplified, only a step of k Δ is felt.
#
# What is kept is not s but z = u − s/k, where the spring would be relaxed: it moves only while
# the spring slips, so that a hand that goes to and fro finds the same forces again, to the bit.

HYSTERESIS = 11.0

_FORCE, _STIFFNESS, _SLIPS_SURFACE, _SLIPS_CLAMPED = range(4)
_RELAXED = 0


@dataclass(frozen=True)
class Hysteresis(RenderingLaw):
    """Rate-independent hysteresis, ``s ← clamp(s + k Δu, ±h)``, ``f ← f + s`` inside.

    Parameters
    ----------
    force
        h > 0, where the spring slips [N; N·m]; None: ½ K v_max T, of the environment's K.
    stiffness
        k > 0 [N/m; N·m/rad]; None: K, so that it slips after half the way of a sample at v_max.
    fastest
        v_max > 0 [m/s; rad/s]; needed where `force` is not given, and only there.
    clamped
        True: the sum never pulls, ``f ← max(0, f + s)``.  Default False: a hand that leaves
        is held back by h just before the surface.

    Raises
    ------
    InputError
        If a number is not positive, or both or none of force and fastest are given; later, if
        K is needed and the environment has none.
    """

    code: ClassVar[float] = HYSTERESIS
    state_size: ClassVar[int] = 1

    force: CertainOrNone = exact(
        "force",
        None,
        "> 0",
        "it is the force at which the spring slips",
        "h, at which the spring slips; this or fastest is needed",
    )
    stiffness: CertainOrNone = exact(
        "stiffness",
        None,
        "> 0",
        "it is the spring that slips",
        "k of that spring, by default the environment's",
    )
    _: KW_ONLY
    fastest: CertainOrNone = exact(
        "speed",
        None,
        "> 0",
        "it is the speed up to which the hysteresis pays for the hold",
        "speed up to which it pays for the hold",
    )
    clamped: bool = flag("for a sum that never pulls", False)

    def __post_init__(self) -> None:
        if (self.force is None) == (self.fastest is None):
            raise InputError(
                f"give either force [N] or fastest [m/s], got {'neither' if self.force is None else 'both'}: "
                "the width h is ½ K v_max T for a hand that is never faster than v_max"
            )
        super().__post_init__()

    def numbers(self, at: LoopContext) -> list[float]:
        """h, k, whether there is a surface, whether it is clamped."""
        if self.force is None:
            assert self.fastest is not None
            k = stiffness_of(at, "force was not given and is otherwise ½ K v_max T")
            width = k * float(self.fastest) * at.period / 2
        else:
            width = float(self.force)
        spring = (
            stiffness_of(at, "stiffness was not given and is otherwise K")
            if self.stiffness is None
            else float(self.stiffness)
        )
        return [width, spring, float(at.environment.unilateral), float(self.clamped)]

    def initial_state(self, reading: float) -> list[float]:
        return [reading]

    def describe(self, motion: str = "linear") -> str:
        force, stiffness, fastest = (
            self.with_unit(name, motion) for name in ("force", "stiffness", "fastest")
        )
        width = f"±{force}" if force else f"the width for {fastest}"
        spring = f", spring of {stiffness}" if stiffness else ""
        return f"hysteresis of {width}{spring}{', never pulls' if self.clamped else ''}"


@compiled
def hysteresis_step(p: Array, i: int, s: Array, j: int, x: float, force: float, applied: float) -> float:
    """One sample; p from i and s from j on are this law's."""
    outside = p[i + _SLIPS_SURFACE] > 0.0 and x <= 0.0
    if outside:
        s[j + _RELAXED] = 0.0
        return force
    width, stiffness = p[i + _FORCE], p[i + _STIFFNESS]
    s[j + _RELAXED] = min(max(s[j + _RELAXED], x - width / stiffness), x + width / stiffness)
    force += min(max(stiffness * (x - s[j + _RELAXED]), -width), width)
    return max(force, 0.0) if p[i + _SLIPS_CLAMPED] > 0.0 else force


# A term in the rate of the force, after the input-to-state stable approach: no energy is counted.
#
#     f_k ← f_k + τ (f_k − f_{k−1})/T
#
# on the force that comes in.  Before a spring of slope K it is damping of K τ in contact.  The first
# force is taken as it is: it has been there for ever.
#
# Jafari, Nabeel & Ryu (2015) bound what a loop with hysteresis may give out and do not ask that nothing
# comes out.  Their law, as two public programs have it, is this and v − (1/μ) df/dt in the place of the
# velocity, μ no less than any slope of the force; on an impedance display that is a spring of μ in series,
# x − f/μ in the place of x, and is left out here.  The promises are derived for this project, with
# 0 ≤ slope ≤ K of what is before it and without counts:
#
#     every hand     no energy comes out where b ≥ K T/2 + K τ; necessary for a spring on both sides
#     a spring       behind τ = T/2 gives out (K/4) Σ (Δx_k − Δx_{k−1})² + (K/4) Δx² at most while contact
#                    lasts: little where the hand's speed changes slowly

RATE_TERM = 17.0

_SAMPLES = 0
_BEGUN, _LAST = range(2)


@dataclass(frozen=True)
class RateTerm(RenderingLaw):
    """``f ← f + τ (f − f_{k−1})/T``: the force leads by τ.

    Proved of a wall with this law alone behind it: no hand takes energy out where b ≥ K T/2 + K τ; with an
    encoder f_c ≥ (K + 2 K τ/T) Δ/2 as well.  `zwidth.check` says so with a certificate.

    Parameters
    ----------
    time_constant
        τ > 0 [s]; None: T/2, what the hold is late by.

    Notes
    -----
    Jafari, Nabeel & Ryu (2015), the term of the force.
    """

    code: ClassVar[float] = RATE_TERM
    state_size: ClassVar[int] = 2

    time_constant: CertainOrNone = exact(
        "time_constant",
        None,
        "> 0",
        "it is how far the force leads; without it the law does nothing",
        "τ, by default T/2",
    )

    def numbers(self, at: LoopContext) -> list[float]:
        return [0.5 if self.time_constant is None else float(self.time_constant) / at.period]

    def initial_state(self, reading: float) -> list[float]:
        """The first force is taken as it is: it has been there for ever."""
        return [0.0, 0.0]

    def most_damping(self, device: Device, spring: Exact | None) -> Fraction | None:
        """K τ where the force that comes in is that of a spring: it changes by K |Δx| at most."""
        lead = device.sample_period if self.time_constant is None else self.time_constant
        if spring is None or not isinstance(lead, Exact):
            return None
        return spring.fraction * lead.fraction / (2 if self.time_constant is None else 1)

    def describe(self, motion: str = "linear") -> str:
        return f"rate term of {self.with_unit('time_constant', motion) or 'T/2'}"


@compiled
def rate_term_step(p: Array, i: int, s: Array, j: int, x: float, force: float, applied: float) -> float:
    """One sample; p from i and s from j on are this law's."""
    last = s[j + _LAST] if s[j + _BEGUN] > 0.0 else force
    s[j + _BEGUN], s[j + _LAST] = 1.0, force
    return force + p[i + _SAMPLES] * (force - last)
