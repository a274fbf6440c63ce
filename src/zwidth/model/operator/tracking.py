"""A hand of finite bandwidth that follows a path."""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import KW_ONLY, dataclass
from math import inf, pi, sqrt
from typing import TYPE_CHECKING, Any

from zwidth.errors import InputError
from zwidth.model.operator.motion import as_path, check_period, first, listed, sampled
from zwidth.model.operator.operator import LinearHand, Signals
from zwidth.model.operator.parameter import ParametricOperator
from zwidth.model.operator.quantities import DAMPING, MASS, NO_NEGATIVE_DAMPING, NO_NEGATIVE_MASS, STIFFNESS
from zwidth.model.operator.record import RecordedOperator
from zwidth.quantity.parameter import Reads, parameter, part
from zwidth.quantity.text import told_quantity

if TYPE_CHECKING:
    from zwidth.model.operator.motion import Path
    from zwidth.model.operator.operator import Signal


def _path(given: Path | Any, name: str) -> Signal | Callable[[float], float]:
    found = hasattr(given, "motion") or hasattr(given, "listed")
    return listed(given, None)[0] if found else as_path(given)


@dataclass(frozen=True, eq=False, repr=False)
class Tracking(RecordedOperator, ParametricOperator):
    """``f_h = k (x_a(t) − x) + c (ẋ_a(t) − ẋ) − m_h ẍ``, ``x_a(kT) = x_k``.

    The anchor follows the path, straight between the samples; after its end it
    stays at the last position. The hand follows the anchor as fast as k and c
    allow: this is what becomes of a motion of theory, which may change its
    velocity at once, in a hand that cannot.

    Parameters
    ----------
    positions
        x_k [m; rad], at each sample instant; a function of the time [s]; or a
        witness of `check` or its motion, such as `witness.motion.repeated(100)`.
    stiffness
        k ≥ 0 [N/m; N·m/rad].
    damping
        c ≥ 0 [N·s/m; N·m·s/rad].
    mass
        m_h ≥ 0, moves with the handle [kg; kg·m²]. Default 0.
    """

    positions: Reads[Signal | Callable[[float], float], Path | Any] = part(
        "positions", _path, meaning="where the anchor is at the samples"
    )
    _: KW_ONLY
    stiffness: float = parameter(
        STIFFNESS, bound="≥ 0", why="a negative spring drives the handle away", kept=float
    )
    damping: float = parameter(DAMPING, bound="≥ 0", why=NO_NEGATIVE_DAMPING, kept=float)
    mass: float = parameter(MASS, 0.0, bound="≥ 0", why=NO_NEGATIVE_MASS, kept=float)

    def __post_init__(self) -> None:
        self._keep(_period=getattr(self.positions, "sample_period", None))
        super().__post_init__()

    @classmethod
    def of_bandwidth(
        cls,
        positions: Path | Any,
        *,
        frequency: float,
        moved_mass: float,
        damping_ratio: float = 0.7,
        mass: float = 0.0,
    ) -> Tracking:
        """A hand that moves a mass M at a bandwidth f: k = M (2πf)², c = 2ζ √(k M).

        Parameters
        ----------
        positions
            The path, as above.
        frequency
            f > 0 [Hz].
        moved_mass
            M > 0, of device and hand together [kg; kg·m²].
        damping_ratio
            ζ ≥ 0 [1].
        mass
            m_h ≥ 0, the hand's part of it [kg; kg·m²].
        """
        for name, value in {"frequency": frequency, "moved_mass": moved_mass}.items():
            if not 0 < value < inf:
                raise InputError(
                    f"{name} must be > 0 and finite, got {value:g}: a hand moves something, somehow fast"
                )
        stiffness = moved_mass * (2 * pi * frequency) ** 2
        damping = 2 * damping_ratio * sqrt(stiffness * moved_mass)
        return cls(positions, stiffness=stiffness, damping=damping, mass=mass)

    @property
    def hand(self) -> LinearHand:
        """m_h, k and c."""
        return LinearHand(self.mass, self.stiffness, self.damping)

    @property
    def initial_position(self) -> float:
        """Where the path starts [m; rad]."""
        return first(self.positions)

    @property
    def start_is_chosen(self) -> bool:
        """True: the path begins somewhere."""
        return True

    def signals(self, times: Signal) -> Signals:
        """The anchor along the path; None where nothing ties the hand to it."""
        check_period(self.__dict__["_period"], times)
        tied = self.stiffness or self.damping
        return Signals(anchor=sampled(self.positions, times) if tied else None)

    def describe(self, motion: str = "linear") -> str:
        """The hand with its numbers, on one line."""
        path = f"a path from {told_quantity(self.initial_position, 'position', motion)}"
        return f"hand tracking {path}, {self.describe_parameters(motion)}"
