"""The proof document of a null-space spring beside a wall, and how far from its rest there is one.

The document is that of an arm before a wall, with Coulomb friction of each joint, and the spring: k, d_n,
q_d, λ and the distance.  The checker makes J, the projector and the bounds on it by itself.
"""

from __future__ import annotations

from typing import Any

import numpy as np
import numpy.typing as npt

from zwidth.checker import verify
from zwidth.model.arms import DescribedArm, PlanarChain
from zwidth.model.arms.joints import as_matrix
from zwidth.model.arms.null_space import NullSpaceSpring, moving, projector, task_jacobian
from zwidth.model.arms.wall import wall_need
from zwidth.passivity.certificate import FORMAT, Certificate
from zwidth.passivity.workspace.certificate import (
    chain_document,
    decimal_of,
    pose_document,
    text,
    texts,
    unsaid,
    wall_matrices_document,
)
from zwidth.passivity.workspace.question import Question
from zwidth.quantity.text import exact_text

Array = npt.NDArray[np.float64]

_SAME = 1e-9
"""Of the largest entry: how far the document's matrix may be from the arm's, in doubles."""
_NEAR = 1e-9
"""Of the rest, where the two are compared [rad]."""
_FIRST, _LEAST, _MOST = 0.1, 1e-4, 4.0
"""Distances: the first one tried, and between which one is looked for [rad]."""
_STEP, _CLOSE = 2.0, 1.05
"""By which factor the distance is changed at first, and how near what is proved comes to what is not."""


def null_space_certificate(
    question: Question, spring: NullSpaceSpring, distance: float
) -> tuple[Certificate | None, str]:
    """A certificate of this distance that the checker accepts, and its words; or None, and why not."""
    document, lacks = _begun(question, spring)
    if document is None:
        return None, lacks
    return _certified(document, distance)


def largest_certified(question: Question, spring: NullSpaceSpring) -> tuple[float, str]:
    """A distance from the rest that is proved [rad], the largest to some 5 %; or 0, and why no more is."""
    document, lacks = _begun(question, spring)
    if document is None:
        return 0.0, lacks
    low, high, distance, why = 0.0, _MOST, _FIRST, ""
    while _LEAST < distance < high and high > _CLOSE * low:
        found, said = _certified(document, distance)
        if found:
            low = distance
        else:
            high, why = distance, said
        if low and high < _MOST:
            distance = (low * high) ** 0.5
        else:
            distance = distance * _STEP if low else distance / _STEP
    return low, why


def _certified(document: dict[str, Any], distance: float) -> tuple[Certificate | None, str]:
    asked = {**document, "spring": {**document["spring"], "distance_rad": text(distance)}}
    found = verify(asked)
    return Certificate((asked,)) if found.valid else None, found.reason


def _begun(question: Question, spring: NullSpaceSpring) -> tuple[dict[str, Any] | None, str]:
    """The document but for its distance, once it is seen to be of this arm; or why there is none."""
    arm = question.arm
    assert isinstance(arm, (DescribedArm, PlanarChain))
    if why := unsaid(arm):
        return None, why
    own = [at.joint for at in arm.placements()[0]]
    if set(moving(arm).tolist()) - set(own):
        return None, "a joint that does not move the hand moves, too: hold it"
    friction = arm.coulomb_friction or (0.0,) * arm.joint_count
    if spring.stiffness and not all(friction[i] for i in moving(arm)):
        return None, "a joint has no Coulomb friction that is known"
    machine = chain_document(arm)
    for joint, i in zip(machine["joints"], own, strict=True):
        joint["coulomb_friction_N_m"] = text(friction[i])
    del machine["geometry"]
    document = {
        "format": FORMAT,
        "kind": "null space",
        "arm": machine,
        "wall": wall_matrices_document(question.wall, len(task_jacobian(arm, spring.rest)))
        | pose_document(arm),
        "loop": {
            "sample_period_s": exact_text(1 / decimal_of(question.rate)),
            "delay_samples": question.delay_samples,
        },
        "spring": {
            "stiffness_N_m_per_rad": text(spring.stiffness),
            "damping_N_m_s_per_rad": text(spring.damping),
            "rest_rad": texts([spring.rest[i] for i in own]),
            "regularization": text(spring.regularization),
        },
    }
    return (document, "") if _is_of(document, question, spring, own) else (None, _why(document))


def _probe(document: dict[str, Any]) -> dict[str, Any]:
    """Next to the rest and without the damper, where wall and spring are all that is asked of the joints."""
    near = {"damping_N_m_s_per_rad": "0", "distance_rad": text(_NEAR)}
    return {**document, "spring": {**document["spring"], **near}}


def _why(document: dict[str, Any]) -> str:
    found = verify(_probe(document))
    return "this arm moves in another way than its document can say" if found.valid else found.reason


def _is_of(document: dict[str, Any], question: Question, spring: NullSpaceSpring, own: list[int]) -> bool:
    """Next to the rest the matrix that the checker reads out of the document is of the arm's own J and P."""
    arm, at = question.arm, np.asarray(spring.rest)
    rows = verify(_probe(document)).surplus
    if not rows:
        return False
    jacobian = task_jacobian(arm, at)
    need = wall_need(question.wall, question.period, question.delay_samples, len(jacobian))
    share = (2 * question.delay_samples + 1) * question.period / 2 * spring.stiffness
    damping = as_matrix(arm.damping)
    taken = jacobian.T @ (need.stiffness_share + need.bound) @ jacobian
    taken += share * projector(jacobian, spring.regularization)
    free = [i for i in own if i in moving(arm)]
    expected = (damping - taken)[np.ix_(free, free)]
    upper = np.concatenate([row[i:] for i, row in enumerate(expected)])
    size = np.abs(damping).max() + np.abs(taken).max()
    return bool(np.abs(np.concatenate(rows) - upper).max() <= _SAME * size)
