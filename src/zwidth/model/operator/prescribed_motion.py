"""A position that is prescribed or followed: an array, a function of time, a motion that `check` found."""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import KW_ONLY, dataclass, field
from math import inf, pi, sqrt
from typing import TYPE_CHECKING, Any

import numpy as np

from zwidth.errors import InputError
from zwidth.model.operator.operator import (
    STIFFNESS,
    LinearHand,
    Operator,
    ParametricOperator,
    Signals,
    hand_damping,
    hand_mass,
)
from zwidth.model.operator.recorded_force import RecordedOperator, as_record
from zwidth.quantity.parameter import Parametric, Reads, parameter, part
from zwidth.quantity.text import shown, told_quantity

if TYPE_CHECKING:
    from numpy.typing import ArrayLike

    from zwidth.model.operator.operator import Signal

    Path = ArrayLike | Callable[[float], float]


def _switches(given: ArrayLike | None, name: str) -> Signal | None:
    return None if given is None else as_record(given, "switch positions", UNIT)


@dataclass(frozen=True, eq=False, repr=False)
class PrescribedMotion(Parametric, RecordedOperator):
    """``x(kT) = x_k``, at constant velocity between the samples.

    Parameters
    ----------
    positions
        x_k [m; rad], one for each sample instant of the touch, so duration/T + 1
        of them; or a function of the time [s] that gives them.
    switch_positions
        Position in each interval when the force changes, duration/T of them
        [m; rad]; None for a straight line.
    """

    positions: Reads[Signal | Callable[[float], float], Path] = part(
        "positions", lambda given, _: as_path(given), meaning="where the handle is at the samples"
    )
    _: KW_ONLY
    switch_positions: Reads[Signal | None, ArrayLike | None] = part(
        "positions", _switches, None, meaning="where it is when the force changes"
    )

    kinematic = True

    @property
    def initial_position(self) -> float:
        return first(self.positions)

    def signals(self, times: Signal) -> Signals:
        """The positions; a record's length must be that of the touch."""
        if not callable(self.positions):
            _same_length("positions", len(self.positions), len(times), "sample instants")
        if self.switch_positions is not None:
            _same_length("switch_positions", len(self.switch_positions), len(times) - 1, "sample intervals")
        switches = None if self.switch_positions is None else self.switch_positions.copy()
        return Signals(position=sampled(self.positions, times), switch_position=switches)

    def describe(self, motion: str = "linear") -> str:
        if callable(self.positions):
            start = told_quantity(self.initial_position, "position", motion)
            return f"prescribed motion, a function of time, from {start}"
        low, high = (
            told_quantity(x, "position", motion) for x in (self.positions.min(), self.positions.max())
        )
        return f"prescribed motion, {len(self.positions)} positions, {low} to {high}"


def _same_length(what: str, given: int, wanted: int, of: str) -> None:
    if given != wanted:
        raise InputError(
            f"{what} has {given} values, but the touch has {wanted} {of}: each has one position; "
            f"give {wanted} values, or another duration"
        )


UNIT = "m or rad"

LONGEST_MOTION = 5_000_000
"""Samples of a found motion that are listed at most."""


def as_path(positions: Path) -> Signal | Callable[[float], float]:
    """A function of time as it is, anything else as a read-only record."""
    return positions if callable(positions) else as_record(positions, "positions", UNIT)


def sampled(path: Signal | Callable[[float], float], times: Signal) -> Signal:
    """The path at the instants; a record that is shorter stays at its end, a longer one is cut."""
    if callable(path):
        return np.array([_position(path, float(t)) for t in times])
    return held(path, len(times))


def held(record: Signal, length: int) -> Signal:
    """The first `length` values, a copy; after its end the last one stays."""
    rest = max(length - len(record), 0)
    return np.concatenate([record[:length], np.full(rest, record[-1])])


def first(path: Signal | Callable[[float], float]) -> float:
    """Where the path starts, at t = 0 [m; rad]."""
    return _position(path, 0.0) if callable(path) else float(path[0])


def listed(witness: Any, rounds: int | None) -> tuple[Signal, Signal | None]:
    """Positions at the samples and, where there are any, at the instants when the force changes.

    Of a witness of `check`, or its motion; its repeated parts are done `rounds` times, None: as in it.
    """
    motion = getattr(witness, "motion", witness)
    if not all(hasattr(motion, name) for name in ("listed", "repeated", "samples")):
        raise InputError(
            f"expected a witness of a check, such as zw.check(device, wall).witness, "
            f"got {type(witness).__name__}; a passive loop has no witness"
        )
    if rounds is not None:
        if isinstance(rounds, bool) or not isinstance(rounds, int) or rounds < 1:
            raise InputError(f"rounds must be a whole number ≥ 1, got {rounds!r}: a part is done or not")
        motion = motion.repeated(rounds)
    if motion.samples > LONGEST_MOTION:
        raise InputError(
            f"the motion has {motion.samples} samples, more than the {LONGEST_MOTION} that are listed; "
            "limit its repeated parts, such as with rounds=100 or witness.motion.repeated(100)"
        )
    whole = motion.listed()
    switches = [float(v) for v in whole.switch_positions]
    positions = as_record([float(v) for v in whole.positions], "positions", UNIT)
    return positions, as_record(switches, "switch positions", UNIT) if switches else None


def check_period(period: float | None, times: Signal) -> None:
    """Refuse to replay a motion at another sample period than its own, where that is known [s]."""
    given = float(times[-1] - times[0]) / (len(times) - 1)
    if period is not None and abs(given - period) > 1e-6 * period:
        raise InputError(
            f"the motion was found for a sample period of {shown(period, 's', 6)} and is replayed at "
            f"{shown(given, 's', 6)}, where it need not take energy out; take the device that was checked"
        )


def _position(path: Callable[[float], float], time: float) -> float:
    try:
        position = float(path(time))
    except (TypeError, ValueError):
        position = float("nan")
    if not np.isfinite(position):
        raise InputError(
            "the function of positions must give one finite number for a time in seconds; "
            f"it does not at {shown(time, 's', 6)}"
        )
    return position


@dataclass(frozen=True, kw_only=True)
class WitnessMotion(Operator):
    """``x(kT) = x_k`` of a witness: the motion that `check` or `available_storage` found to take energy out.

    After its end the hand stays where it is; of a longer motion the touch sees the beginning.

    Parameters
    ----------
    witness
        A witness, `zw.check(device, environment).witness` or that of `zw.available_storage`, or its motion.
    rounds
        How often its repeated parts are done, ≥ 1; None as in the witness.
    """

    witness: Any = field(kw_only=False)
    rounds: int | None = None

    def __post_init__(self) -> None:
        object.__setattr__(self, "_listed", listed(self.witness, self.rounds))

    @property
    def intervals(self) -> int:
        """Sample intervals of the whole motion: its duration is so many T."""
        return (len(self._positions) - 1) // self._pieces

    kinematic = True

    @property
    def initial_position(self) -> float:
        return float(self._positions[0])

    def signals(self, times: Signal) -> Signals:
        """The positions of the witness, and between the samples when the force changes."""
        check_period(getattr(self.witness, "sample_period", None), times)
        switches: Signal | None = self.__dict__["_listed"][1]
        if switches is not None:
            rest = np.full(max(len(times) - 1 - len(switches), 0), self._positions[-1])
            switches = np.concatenate([switches[: len(times) - 1], rest])
        instants = (len(times) - 1) * self._pieces + 1
        return Signals(position=held(self._positions, instants), switch_position=switches)

    def describe(self, motion: str = "linear") -> str:
        deepest = told_quantity(self._positions.max(), "position", motion)
        return f"motion of a witness, {self.intervals} samples, to {deepest}"

    @property
    def _pieces(self) -> int:
        found: int = getattr(getattr(self.witness, "motion", self.witness), "pieces", 1)
        return found

    @property
    def _positions(self) -> Signal:
        positions: Signal = self.__dict__["_listed"][0]
        return positions


def _path(given: Path | Any, name: str) -> Signal | Callable[[float], float]:
    found = hasattr(given, "motion") or hasattr(given, "listed")
    return listed(given, None)[0] if found else as_path(given)


@dataclass(frozen=True, eq=False, repr=False)
class Tracking(RecordedOperator, ParametricOperator):
    """``f_h = k (x_a(t) − x) + c (ẋ_a(t) − ẋ) − m_h ẍ``, ``x_a(kT) = x_k``.

    The anchor follows the path, straight between the samples; after its end it stays at the last position.
    The hand follows the anchor as fast as k and c allow: this is what becomes of a motion of theory, which
    may change its velocity at once, in a hand that cannot.

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
    damping: float = hand_damping()
    mass: float = hand_mass(0.0)

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
        return LinearHand(self.mass, self.stiffness, self.damping)

    @property
    def initial_position(self) -> float:
        return first(self.positions)

    start_is_chosen = True
    """True: the path begins somewhere."""

    def signals(self, times: Signal) -> Signals:
        """The anchor along the path; None where nothing ties the hand to it."""
        check_period(self.__dict__["_period"], times)
        tied = self.stiffness or self.damping
        return Signals(anchor=sampled(self.positions, times) if tied else None)

    def describe(self, motion: str = "linear") -> str:
        path = f"a path from {told_quantity(self.initial_position, 'position', motion)}"
        return f"hand tracking {path}, {self.describe_parameters(motion)}"
