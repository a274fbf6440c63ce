"""The identified device and finger, as the laws know them that look ahead.

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
from typing import TYPE_CHECKING, NamedTuple

import numpy as np

from zwidth.errors import InputError
from zwidth.model.environment.wall import wall_of
from zwidth.model.rendering.rendering_law import LoopContext, RenderingLaw
from zwidth.native.compiled import Array, compiled
from zwidth.quantity.exact import Exact, ends
from zwidth.quantity.parameter import Certain, CertainOrNone, parameter

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

    mass: CertainOrNone = parameter(
        "mass", None, kept=Exact, bound="> 0", why="a force moves it; None: the device's", meaning=_NOT_MEANT
    )
    damping: CertainOrNone = parameter(
        "damping", None, kept=Exact, bound="≥ 0", why=_PASSIVE, meaning=_NOT_MEANT
    )
    finger_mass: Certain = parameter(
        "mass", 0, kept=Exact, bound="≥ 0", why=_PASSIVE, meaning="of the finger that the law reckons with"
    )
    finger_stiffness: Certain = parameter(
        "stiffness", 0, kept=Exact, bound="≥ 0", why=_PASSIVE, meaning="of that finger"
    )
    finger_damping: Certain = parameter(
        "damping", 0, kept=Exact, bound="≥ 0", why=_PASSIVE, meaning="of that finger"
    )
    finger_position: Certain = parameter("position", 0, kept=Exact, meaning="where that finger is at rest")

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
                f"device and finger swing, or come to rest, within one sample of {at.period:g} s: two "
                "readings do not tell a velocity; sample faster, or give less finger_stiffness or damping"
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
