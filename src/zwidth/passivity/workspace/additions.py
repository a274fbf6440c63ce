"""How much more damping in the joints would do, or how much softer a wall: what is proved, and what fails.

    fails    what is lacking at some point of the map: less of it, and δ_m − JᵀRJ is not ⪰ 0 there
    enough   what the bounds between the points ask for: more than is needed, most of all of parallel arms

Between the two the independent checker decides, which cuts cells where it must: the first of a few steps
from `fails` to `enough` that it proves is told.  Of an arm with many joints such proofs take long,
and there it is the bounds that decide.
"""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass, replace
from functools import cached_property, partial
from math import isfinite
from typing import Any, NamedTuple

import numpy as np
import numpy.typing as npt

from zwidth.model.arms.joints import as_matrix, least_additions, single_addition
from zwidth.model.arms.wall import MatrixWall
from zwidth.model.environment.environment import certain
from zwidth.model.environment.wall import Wall
from zwidth.passivity.workspace.certificate import arm_certificate
from zwidth.passivity.workspace.question import Question

Array = npt.NDArray[np.float64]

_STEPS = (1 / 8, 1 / 2)
"""Of the way from what fails to what is enough."""

_SOFTER = (0.01, 0.05, 0.2)
"""Than the wall that fails at a point of the map."""

_MOST_PROVED = 4
"""Joints of an arm of which the checker is asked."""

_NEAR = 0.06
"""Of what fails, tried first where the steps are longer: nearer to it the checker needs many cells."""


class Addition(NamedTuple):
    """Damping to be added to each joint [N·m·s/rad]; ∞ where none is enough.

    With it the region is proved, of an arm with more than four joints in doubles alone; with `fails`, or
    less in these proportions, the condition fails at a point.
    """

    enough: tuple[float, ...]
    fails: tuple[float, ...]


@dataclass(frozen=True, kw_only=True)
class Additions:
    """What to add to the damping of the joints for a question.

    Parameters
    ----------
    question
        The arm, the wall and the loop.
    points
        δ_m − JᵀRJ at the points of the map, (points, m, m).
    cells
        The same less what it may lose between them.
    """

    question: Question
    points: Array
    cells: Array

    @cached_property
    def least(self) -> Addition:
        """With the smallest sum."""
        return self._smallest(lambda matrices: np.asarray(least_additions(matrices)[0]))

    @cached_property
    def to_all(self) -> Addition:
        """The same in every joint."""
        return self._smallest(_to_all)

    @cached_property
    def alone(self) -> tuple[Addition, ...]:
        """All in one joint, for each of them."""
        return tuple(self._smallest(partial(_alone, joint)) for joint in range(self._joints))

    @property
    def _joints(self) -> int:
        return int(self.points.shape[-1])

    def stiffest(self, fails: float) -> float | None:
        """How many times as stiff a wall is proved, `fails` at a point of the map; None where none was."""
        if self._joints > _MOST_PROVED:
            return None
        tried = (fails * (1 - softer) for softer in _SOFTER)
        return next((k for k in tried if self._proves(wall=_stiffer(self.question.wall, k))), None)

    def _smallest(self, needed: Callable[[Array], Array]) -> Addition:
        enough = needed(self.cells)
        if not enough.any():
            return Addition(_numbers(enough), _numbers(enough))
        fails = needed(self.points)
        if not all(map(isfinite, fails)):
            return Addition(_numbers(fails), _numbers(fails))
        if self._joints > _MOST_PROVED:
            return Addition(_numbers(enough), _numbers(fails))
        far = np.where(np.isfinite(enough), enough, 4 * fails)  # the bounds alone may ask for no end of it
        steps = [fails + share * (far - fails) for share in _STEPS]
        near = (1 + _NEAR) * fails
        for tried in steps if steps[0].sum() < near.sum() else [near, *steps]:
            damping = as_matrix(self.question.arm.damping) + np.diag(tried)
            if self._proves(arm=self.question.arm.replace(damping=damping)):
                return Addition(_numbers(tried), _numbers(fails))
        return Addition(_numbers(enough), _numbers(fails))

    def _proves(self, **changed: Any) -> bool:
        asked = replace(self.question, **changed)
        loop = (asked.arm, asked.wall, asked.rate, asked.delay_samples, asked.held_to)
        return arm_certificate(*loop)[0] is not None


def _stiffer(wall: Wall | MatrixWall, times: float) -> Wall | MatrixWall:
    if isinstance(wall, Wall):
        return wall.replace(stiffness=times * certain(wall.stiffness, "stiffness"))
    return replace(wall, stiffness=times * np.array(wall.stiffness))


def _to_all(matrices: Array) -> Array:
    lacking = max(0.0, -float(np.linalg.eigvalsh(matrices)[:, 0].min()))
    return np.full(matrices.shape[-1], lacking)


def _alone(joint: int, matrices: Array) -> Array:
    found = np.zeros(matrices.shape[-1])
    found[joint] = single_addition(matrices, joint).max()
    return found


def _numbers(values: Array) -> tuple[float, ...]:
    return tuple(float(value) for value in values)
