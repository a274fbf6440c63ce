"""Laws that look ahead by a model of device and finger, and extrapolation, which needs none.

The identified device and finger, as the laws know them that look ahead.

    M ẍ = −D ẋ − k (x − x_a) − f,    M = m + m_h,  D = b + c
    ξ_{k+1} = Φ ξ_k + Γ (f_k − k x_a),    ξ = (x, v)ᵀ, f_k held over the sample

Φ = e^{AT} and Γ = ∫₀ᵀ e^{As} ds (0, −1/M)ᵀ are exact behind a hold.  The velocity is the
one with which the model goes from reading to reading under the force that was held:

    x_k = φ₁₁ x_{k−1} + φ₁₂ v_{k−1} + γ₁ (f_{k−1} − k x_a)        gives v_{k−1}, and so v_k

exact where the model is; with readings rounded to Δ it errs by some Δ/T, as a difference does.  A
steady push d that the model does not know makes v_k err by −d T/(2M), T/2 later the place by −⅜ d T²/M.

Hypotheses: the finger is a mass on a spring and a damper whose other end stands still at x_a,
which Gillespie & Cutkosky (1996) take a finger for during some 30 ms; no Coulomb friction, no
delay, a regular clock, no amplifier lag.  Matrices after them; the velocity derived for this project.
"""

from __future__ import annotations

from dataclasses import dataclass
from functools import lru_cache
from typing import TYPE_CHECKING, ClassVar, NamedTuple

import numpy as np

from zwidth.errors import InputError
from zwidth.model.environment.wall import wall_of
from zwidth.model.rendering.rendering_law import LoopContext, RenderingLaw
from zwidth.native.compiled import Array, compiled
from zwidth.quantity.exact import ends
from zwidth.quantity.parameter import Certain, CertainOrNone, exact, plain
from zwidth.quantity.text import shown

if TYPE_CHECKING:
    from numpy.typing import NDArray

    Matrix = NDArray[np.float64]

FF, FV, VF, VV, GX, GV, REST = range(7)
"""Where a step finds Φ row by row, Γ and k x_a."""
MODEL = 7

SHORTEST = 1e-6
"""φ₁₂/T below which positions say nothing about velocities."""


_NOT_MEANT = "of the device, where its own is not meant"
_PASSIVE = "device and finger are passive"


class Plant(NamedTuple):
    """Device and finger moving together: M [kg], D [N·s/m], k [N/m], x_a [m]."""

    mass: float
    damping: float
    stiffness: float
    position: float

    def matrix(self, stiffness: float = 0.0, damping: float = 0.0) -> Matrix:
        """A of ξ̇ = A ξ, with a wall's spring and damper if any."""
        k, d = self.stiffness + stiffness, self.damping + damping
        return np.array([[0.0, 1.0], [-k / self.mass, -d / self.mass]])

    def held(self, time: float) -> tuple[Matrix, Matrix]:
        """(Φ, Γ) of a force held for a time [s]."""
        return _held(self, time)

    def numbers(self, time: float) -> list[float]:
        """The same as a step reads them."""
        phi, gamma = self.held(time)
        return [*phi.ravel().tolist(), *gamma.tolist(), self.stiffness * self.position]


@dataclass(frozen=True, kw_only=True)
class Modelled(RenderingLaw):
    """A law that knows device and finger.

    Parameters
    ----------
    mass
        m > 0, of the device [kg; kg·m²]; None: the device's.
    damping
        b ≥ 0, of the device [N·s/m; N·m·s/rad]; None: the device's.
    finger_mass
        m_h ≥ 0 [kg; kg·m²].
    finger_stiffness
        k ≥ 0 [N/m; N·m/rad].
    finger_damping
        c ≥ 0 [N·s/m; N·m·s/rad].
    finger_position
        x_a, where the finger's spring is at rest [m; rad].
    """

    mass: CertainOrNone = exact("mass", None, "> 0", "a force moves it; None: the device's", _NOT_MEANT)
    damping: CertainOrNone = exact("damping", None, "≥ 0", _PASSIVE, _NOT_MEANT)
    finger_mass: Certain = exact("mass", 0, "≥ 0", _PASSIVE, "of the finger that the law reckons with")
    finger_stiffness: Certain = exact("stiffness", 0, "≥ 0", _PASSIVE, "of that finger")
    finger_damping: Certain = exact("damping", 0, "≥ 0", _PASSIVE, "of that finger")
    finger_position: Certain = exact("position", 0, meaning="where that finger is at rest")

    def plant(self, at: LoopContext) -> Plant:
        """Device and finger, what was left out taken from the device.

        Raises
        ------
        InputError
            If no mass is known, or the model swings half a turn between two readings.
        """
        if self.mass is None and at.device.mass is None:
            raise InputError(
                f"{type(self).__name__} computes where a mass goes and the device has none: give mass [kg]"
            )
        mass = at.device.exact("mass") if self.mass is None else self.mass
        damping = at.device.exact("damping") if self.damping is None else self.damping
        plant = Plant(
            float(mass) + float(self.finger_mass),
            float(damping) + float(self.finger_damping),
            float(self.finger_stiffness),
            float(self.finger_position),
        )
        if turns_over(plant.matrix(), at.period) or plant.held(at.period)[0][0, 1] < SHORTEST * at.period:
            raise InputError(
                f"device and finger swing, or come to rest, within one sample of {shown(at.period, 's', 6)}: "
                "two readings do not tell a velocity; sample faster, or give less finger_stiffness or damping"
            )
        return plant

    def wall(self, at: LoopContext) -> tuple[float, float]:
        """(K, B) of the wall that is met [N/m, N·s/m].

        Raises
        ------
        InputError
            If it is no wall.
        """
        wall = wall_of(at.environment)
        if wall is None:
            raise InputError(
                f"{type(self).__name__} computes how a wall K x + B v would move the hand and needs a Wall, "
                f"got {at.environment.describe()}"
            )
        return float(ends(wall.stiffness)[0]), float(ends(wall.damping)[0])

    def describe_model(self, motion: str = "linear") -> str:
        """What it knows of the finger, in a few words."""
        device = [
            f"{name} {self.with_unit(name, motion)}"
            for name in ("mass", "damping")
            if getattr(self, name) is not None
        ]
        own = ("finger_mass", "finger_stiffness", "finger_damping")
        finger = [self.with_unit(name, motion) for name in own if getattr(self, name) != 0]
        return ", ".join([*device, f"finger {', '.join(finger)}" if finger else "no finger"])


@lru_cache(maxsize=64)  # a law asks for the same at every touch
def _held(plant: Plant, time: float) -> tuple[Matrix, Matrix]:
    from scipy.linalg import expm  # scipy takes its time

    both = np.zeros((3, 3))
    both[:2, :2] = plant.matrix()
    both[1, 2] = -1 / plant.mass
    step = expm(both * time)
    step.setflags(write=False)
    return step[:2, :2], step[:2, 2]


def turns_over(matrix: Matrix, period: float) -> bool:
    """True where ξ̇ = A ξ swings half a turn or more in one sample."""
    return bool(np.max(np.abs(np.linalg.eigvals(matrix).imag)) * period >= np.pi)


@compiled
def speed_before(p: Array, i: int, before: float, x: float, applied: float) -> float:
    """v_{k−1}, with which the model comes from the reading before to this one."""
    v: float = (x - p[i + FF] * before - p[i + GX] * (applied - p[i + REST])) / p[i + FV]
    return v


@compiled
def speed(p: Array, i: int, before: float, x: float, applied: float) -> float:
    """v_k of the same."""
    first = speed_before(p, i, before, x, applied)
    v: float = p[i + VF] * before + p[i + VV] * first + p[i + GV] * (applied - p[i + REST])
    return v


@compiled
def estimated(p: Array, i: int, s: Array, j: int, x: float, applied: float) -> float:
    """v_k; remembers, from j on, the reading and that there was one; 0 at the first."""
    v = speed(p, i, s[j], x, applied) if s[j + 1] > 0.0 else 0.0
    s[j], s[j + 1] = x, 1.0
    return v


# Half-sample prediction: the wall is evaluated where the hand will be in the middle of the hold.
#
#     ξ̂ = Φ(T/2) ξ_k + Γ(T/2) (f_{k−1} − k x_a),    f_k = law(x̂)
#
# A force held from kT to (k+1)T stands for the one at (k + ½)T.  With device and finger known, `modelled`,
# the state is predicted to that instant under the force that is still applied, and the environment reads x̂
# in the place of x_k (Gillespie & Cutkosky 1996, whose text was not consulted: that the force of the
# prediction is f_{k−1} and the state comes from two readings is derived for this project).
#
# On the way f_{k−1} acts, not f_k, which is what will act: behind an elastic wall the bounces then die out
# slowly.  Where the wall is crossed nothing is repaired: see `CrossingCorrection`.

HALF_SAMPLE = 31.0

_HALF = MODEL
"""Where the same numbers for half a sample begin."""


@dataclass(frozen=True, kw_only=True)
class HalfSamplePrediction(Modelled):
    """Before the environment, ``x̂ = (Φ(T/2) ξ_k + Γ(T/2) (f_{k−1} − k x_a))₁``.

    Takes the parameters of a model of device and finger: mass, damping (None: the
    device's), finger_mass, finger_stiffness, finger_damping and finger_position.
    """

    code: ClassVar[float] = HALF_SAMPLE
    state_size: ClassVar[int] = 2

    def numbers(self, at: LoopContext) -> list[float]:
        """Φ, Γ and k x_a for a sample, then for half of one.

        Raises
        ------
        InputError
            As `Modelled.plant`.
        """
        plant = self.plant(at)
        return [*plant.numbers(at.period), *plant.numbers(at.period / 2)]

    def describe(self, motion: str = "linear") -> str:
        return f"half-sample prediction ({self.describe_model(motion)})"


@compiled
def half_sample_step(p: Array, i: int, s: Array, j: int, x: float, applied: float) -> float:
    """x̂ of one sample; p from i and s from j on are this law's, `applied` is the force that was held."""
    v = estimated(p, i, s, j, x, applied)
    i += _HALF
    ahead: float = p[i + FF] * x + p[i + FV] * v + p[i + GX] * (applied - p[i + REST])
    return ahead


# Digital design: the held loop gets the poles of the continuous one.
#
#     f_k = g_x x_k + g_v v̂_k    if x_k > 0,   0 outside
#     eig(Φ + Γ (g_x, g_v)) = e^{sT},    s: M s² + (D + B) s + k + K = 0
#
# The wall K, B against device and finger M, D, k, `modelled`, has two poles; the two gains
# give them, mapped by e^{sT}, to the same plant behind the hold.  Trace and determinant
# are linear in the gains (Γ is −, for f slows):
#
#     tr Φ + γ₁ g_x + γ₂ g_v = e^{s₁T} + e^{s₂T}
#     det Φ + (γ₁ φ₂₂ − γ₂ φ₁₂) g_x + (γ₂ φ₁₁ − γ₁ φ₂₁) g_v = e^{(s₁+s₂)T}
#
# For a free mass, D = B = k = 0, ω² = K/M: g_x = (2M/T²)(1 − cos ωT) = K (1 − (ωT)²/12 + …)
# and g_v = g_x T/2, a virtual damping of the size that `Extrapolation` has.  The idea is
# Gillespie & Cutkosky's (1996); the equations are derived for this project.
#
# Pressed on slowly the wall is g_x, not K, stiff.  Poles are those of contact: what is gained or
# lost where the surface is crossed remains.

POLE_MATCHED = 36.0

_POSITION, _VELOCITY, _CLAMPED = range(MODEL, MODEL + 3)


@dataclass(frozen=True, kw_only=True)
class PoleMatched(Modelled):
    """In the place of a wall, ``f = g_x x + g_v v̂ if x > 0`` with the poles e^{sT} of K x + B v.

    Takes the parameters of a model of device and finger: mass, damping (None: the
    device's), finger_mass, finger_stiffness, finger_damping and finger_position.
    """

    code: ClassVar[float] = POLE_MATCHED
    state_size: ClassVar[int] = 2

    def numbers(self, at: LoopContext) -> list[float]:
        """The model, g_x, g_v and whether the wall never pulls.

        Raises
        ------
        InputError
            As `Modelled.plant`; if the environment is no wall, or swings half a turn in one sample.
        """
        stiffness, damping = self.wall(at)
        plant = self.plant(at)
        if turns_over(plant.matrix(stiffness, damping), at.period):
            raise InputError(
                f"against {shown(stiffness, 'N/m', 6)} the model swings half a turn or more in a sample of "
                f"{shown(at.period, 's', 6)}, as against a softer wall; sample faster, or take a softer one"
            )
        gains = matched(plant, stiffness, damping, at.period)
        return [*plant.numbers(at.period), *gains, float(at.environment.clamped)]

    def gains(self, at: LoopContext) -> tuple[float, float]:
        """(g_x, g_v) [N/m, N·s/m]; raises as `numbers`."""
        numbers = self.numbers(at)
        return numbers[_POSITION], numbers[_VELOCITY]

    def describe(self, motion: str = "linear") -> str:
        return f"poles matched ({self.describe_model(motion)})"


def matched(plant: Plant, stiffness: float, damping: float, period: float) -> tuple[float, float]:
    """(g_x, g_v) of the equations above."""
    from scipy.linalg import expm  # scipy takes its time

    phi, gamma = plant.held(period)
    goal = expm(plant.matrix(stiffness, damping) * period)
    (ff, fv), (vf, vv) = phi
    gx, gv = gamma
    rows = np.array([[gx, gv], [gx * vv - gv * fv, gv * ff - gx * vf]])
    wanted = [np.trace(goal) - np.trace(phi), np.linalg.det(goal) - np.linalg.det(phi)]
    position, velocity = np.linalg.solve(rows, wanted)
    return float(position), float(velocity)


@compiled
def pole_matched_step(p: Array, i: int, s: Array, j: int, x: float, force: float, applied: float) -> float:
    """One sample; p from i and s from j on are this law's, `applied` is the force that was held."""
    v = estimated(p, i, s, j, x, applied)
    if x <= 0.0:
        return 0.0
    f: float = p[i + _POSITION] * x + p[i + _VELOCITY] * v
    return max(f, 0.0) if p[i + _CLAMPED] > 0.0 else f


# Extrapolation: the environment meets the hand where it will be when half of the hold is over.
#
#     x̂_k = x_k + n (x_k − x_{k−1})
#
# A held force is on average half a sample old.  Before a linear wall, n = ½ makes
#
#     K x̂_k = K x_k + (K T/2) (x_k − x_{k−1})/T,    H(z) = K (1.5 − 0.5 z⁻¹)
#
# which is the wall with a virtual damping B = K T/2 on the backward difference: it pays the hold at low
# frequencies and, like any virtual damping, costs passivity at high ones.  Prediction by half a sample:
# Gillespie & Cutkosky (1996); this, its first order and without a model, derived for this project.

EXTRAPOLATION = 30.0


@dataclass(frozen=True, kw_only=True)
class Extrapolation(RenderingLaw):
    """Before the environment, ``x̂ = x_k + n (x_k − x_{k−1})``.

    An encoder's count is multiplied by 1 + n, and a count up and down by 1 + 2n.

    Parameters
    ----------
    samples
        n ≥ 0 [samples]: ½ for the hold; ½ and the delay in samples with a delay.

    Raises
    ------
    InputError
        If samples is negative.
    """

    code: ClassVar[float] = EXTRAPOLATION
    state_size: ClassVar[int] = 1

    samples: Certain = exact(
        plain("samples", "n, by default ½"),
        "0.5",
        "≥ 0",
        "the force is applied after the reading, not before",
    )

    def numbers(self, at: LoopContext) -> list[float]:
        return [float(self.samples)]

    def describe(self, motion: str = "linear") -> str:
        return f"extrapolated by {float(self.samples):g} samples"


@compiled
def extrapolation_step(p: Array, i: int, s: Array, j: int, x: float) -> float:
    """One sample; p from i and s from j on are this law's."""
    moved: float = p[i] * (x - s[j])
    s[j] = x
    return x + moved
