"""Positions over time: an array, a function of time, or a motion that `check` found."""

from __future__ import annotations

from collections.abc import Callable
from typing import TYPE_CHECKING, Any

import numpy as np

from zwidth.errors import InputError
from zwidth.model.operator.record import as_record

if TYPE_CHECKING:
    from numpy.typing import ArrayLike

    from zwidth.model.operator.operator import Signal

    Path = ArrayLike | Callable[[float], float]

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

    Parameters
    ----------
    witness
        A witness of `check`, or its motion.
    rounds
        How often its repeated parts are done; None as in the witness.
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
            f"the motion was found for a sample period of {period:g} s and is replayed at {given:g} s: "
            "it takes energy out at its own period only; take the device that was checked"
        )


def _position(path: Callable[[float], float], time: float) -> float:
    try:
        position = float(path(time))
    except (TypeError, ValueError):
        position = float("nan")
    if not np.isfinite(position):
        raise InputError(
            "the function of positions must give one finite number for a time in seconds; "
            f"it does not at {time:g} s"
        )
    return position
