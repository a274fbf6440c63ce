"""The samples of a record that teach a tracker nothing: at an end of the sensor's range, and after a hole."""

from __future__ import annotations

from collections.abc import Iterator
from typing import TYPE_CHECKING

import numpy as np

from zwidth.data.logs import Finding
from zwidth.data.logs.stops import beyond
from zwidth.data.tissue.faults import HELD, stops_of
from zwidth.errors import InputError
from zwidth.model.environment.modes import samples
from zwidth.native.compiled import Array

if TYPE_CHECKING:
    from numpy.typing import ArrayLike, NDArray

AGAINST = -0.5
"""Correlation of depth and force, inside, below which a record is of no tissue: a solid resists."""

FAR = 100.0
"""Times by which a start may be wrong before its units are doubted."""

FEWEST = 30
"""Samples inside below which nothing is said of the sign."""


def passed_over(
    position: Array, force: Array, time: ArrayLike | None, period: float, stiffness: float
) -> tuple[NDArray[np.bool_], tuple[Finding, ...]]:
    """Which samples of a record are passed over, and why: at an end of the sensor's range, and after a hole.

    `stiffness` is that at once, of the solid that the tracker starts from [N/m; N·m/rad].
    """
    _check_sign(position, force)
    passed, findings = np.zeros(force.size, dtype=bool), [*_units(position, force, stiffness)]
    stopped = _stopped(position, force)
    if stopped.any():
        passed |= stopped
        text = f"the sensor is at an end of its range in {stopped.sum()} samples, which are passed over"
        findings.append(Finding(kind="saturated", text=text, samples=int(stopped.sum())))
    if time is not None and force.size > 1:
        after = np.append(False, np.diff(samples(time, force, "force")[0]) > 1.5 * period)
        if after.any():
            passed |= after
            text = f"{after.sum()} holes in time; after each the tracker begins anew with what it knows"
            findings.append(Finding(kind="hole", text=text, samples=int(after.sum())))
    return passed, tuple(findings)


def _stopped(position: Array, force: Array) -> NDArray[np.bool_]:
    """At a stop while the probe moves; a force that stays where the probe is held is no stop."""
    found = np.zeros(force.size, dtype=bool)
    low, high = stops_of(force)
    for at in (beyond(force, (low, np.inf)), beyond(force, (-np.inf, high))):
        if at.any() and np.ptp(position[at]) > HELD * np.ptp(position):
            found |= at
    return found


def _units(position: Array, force: Array, stiffness: float) -> Iterator[Finding]:
    """Said where the force goes about by far more or less than the start would make of the motion."""
    inside = position > 0
    moved = float(np.ptp(position[inside])) if inside.any() else 0.0
    if position.size >= FEWEST and not inside.any():
        text = (
            "the position is never inside the tissue, x > 0: nothing is learnt; does it count the other way?"
        )
        yield Finding(kind="outside", text=text)
    if not moved:
        return
    times = float(np.ptp(force[inside])) / moved / stiffness
    if not 1 / FAR <= times <= FAR:
        text = (
            f"the force goes about {times:.3g} times as much as that of the solid at the start: most likely "
            "a unit is off by 1000, mm for m or mN for N"
        )
        yield Finding(kind="units", text=text)


def _check_sign(position: Array, force: Array) -> None:
    inside = position > 0
    if np.count_nonzero(inside) < FEWEST:
        return
    depth, push = position[inside], force[inside]
    if np.std(depth) == 0 or np.std(push) == 0 or np.corrcoef(depth, push)[0, 1] > AGAINST:
        return
    raise InputError(
        "the force falls where the probe goes deeper, and no tissue pulls it in: give positions that "
        "are positive "
        "inside the tissue and forces that are positive out of it; one of the two counts the other way"
    )
