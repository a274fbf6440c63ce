"""The proof document of an arm before a wall: its exact numbers, for the checker to prove δ_m ⪰ JᵀRJ.

The document lists what the arm is made of, as decimals: for a chain the fixed placement of
each joint, which turns or slides along the z axis of its own frame, for a parallel arm its legs; the
wall, T, d, and the region; in pose the joints at which the wall's rotation rests, or that it may
anywhere.  A stands for |B|: any A with A ± B ⪰ 0 does.
"""

from __future__ import annotations

from collections.abc import Sequence
from fractions import Fraction
from itertools import combinations
from typing import Any

import flint
import numpy as np
import numpy.typing as npt

from zwidth.checker import verify
from zwidth.model.arms import Arm, DescribedArm, LeggedArm, PlanarChain, PosedArm
from zwidth.model.arms.encoders import Chain, EncoderSteps, moving_steps
from zwidth.model.arms.joints import as_matrix, surplus
from zwidth.model.arms.null_space import NullSpaceSpring, moving, projector, task_jacobian
from zwidth.model.arms.wall import MatrixWall, wall_matrices
from zwidth.model.environment.environment import certain
from zwidth.model.environment.wall import Wall
from zwidth.passivity.certificate import FORMAT, Certificate
from zwidth.passivity.workspace.question import Counting, Question
from zwidth.quantity.text import exact_text

Array = npt.NDArray[np.float64]
Written = LeggedArm | PlanarChain | DescribedArm

_KEYS = ("stiffness_N_per_m", "virtual_damping_N_s_per_m", "damping_bound_N_s_per_m")
_POSE_KEYS = ("stiffness_N_m_rad", "virtual_damping_N_m_s_rad", "damping_bound_N_m_s_rad")
_MARGIN = 1e-12
"""Of the largest entry of its unit: what is added so that rounded matrices are ⪰ 0 to the last digit."""
_POINTS = 8
"""Of the arm, at which the document's matrix is compared with the arm's own."""
_SAME = 1e-9
"""Of the largest entry: how far the document's matrix may be from the arm's, in doubles."""
_CURVED = 2e-6
"""Of the curvature: the checker's lengths are longer by a millionth, and an eigenvalue is rounded."""


def arm_certificate(question: Question, count: Counting | None = None) -> tuple[Certificate | None, str]:
    """A certificate that the checker accepts, and its words; or None, and why there is none.

    With `count` it is of the encoder steps, for forces up to its limits.
    """
    arm = question.arm
    if not isinstance(arm, (LeggedArm, PlanarChain, DescribedArm)):
        return None, "arms of this kind have no certificate"
    if why := unsaid(arm):
        return None, why
    document: dict[str, Any] = {
        "format": FORMAT,
        "kind": "arm",
        "arm": _legs_document(arm) if isinstance(arm, LeggedArm) else chain_document(arm),
        "wall": wall_matrices_document(question.wall, arm.sites(2).jacobians.shape[-2]) | pose_document(arm),
        "loop": _loop_document(question, question.held_to),
    }
    if not _is_of({**document, "loop": _loop_document(question, ())}, arm, question):
        return None, "this arm moves in another way than its document can say"
    if count is not None and count.steps is not None and not isinstance(arm, LeggedArm):
        _add_steps(document, arm, count.steps, count.limits)
    found = verify(document)
    return Certificate((document,)) if found.valid else None, found.reason


def _is_of(document: dict[str, Any], arm: Written, question: Question) -> bool:
    """At a few points the matrix that the checker reads out of the document is the one of the arm's own J.

    Where it is not ≻ 0 the checker has none; nor is the document a proof then.
    """
    sites = arm.sites(2)
    size, count = sites.jacobians.shape[-2:]
    need = question.need(size)
    taken = need.stiffness_share + need.bound
    damping, jacobians = as_matrix(arm.damping), sites.jacobians.reshape(-1, size, count)
    if isinstance(arm, LeggedArm):
        places, inverses = sites.positions.reshape(-1, size), np.linalg.inv(jacobians)
        given = np.swapaxes(inverses, -1, -2) @ damping @ inverses
        found = given - taken
    else:
        own = [at.joint for at in arm.placements()[0]]
        places = sites.joints.reshape(-1, count)[:, own]
        found, given = surplus(jacobians, damping, taken)[:, own][:, :, own], damping
    for place, expected in zip(places[:_POINTS], found[:_POINTS], strict=True):
        rows = verify({**document, "arm": _resting(document["arm"], place)}).surplus
        if not rows:
            continue
        read = np.concatenate(rows)
        upper = np.concatenate([row[i:] for i, row in enumerate(expected)])
        if np.abs(read - upper).max() > _SAME * (np.abs(given).max() + np.abs(expected).max()):
            return False
    return True


def _resting(machine: dict[str, Any], place: Array) -> dict[str, Any]:
    """The arm of a document, its region one place."""
    told = texts(place)
    if machine["geometry"] == "legs":
        return {**machine, "low_m": told, "high_m": told}
    joints = [
        {**joint, **{key: at for key in joint if key.startswith(("low_", "high_"))}}
        for joint, at in zip(machine["joints"], told, strict=True)
    ]
    return {**machine, "joints": joints}


def _legs_document(arm: LeggedArm) -> dict[str, Any]:
    low, high = arm.box()
    legs = [
        {
            "base_m": texts(leg.base),
            "out": texts(leg.out),
            "up": texts(leg.up),
            "link_m": text(leg.link),
            "rod_m": text(leg.rod),
            "offset_m": text(leg.offset),
            "bend": leg.bend,
            **_own_damping(arm, i, "N_m_s_per_rad"),
        }
        for i, leg in enumerate(arm.legs)
    ]
    corners = {"low_m": texts(low), "high_m": texts(high)}
    return {"geometry": "legs", "legs": legs, **corners, **_shared_damping(arm, "N_m_s_per_rad")}


def chain_document(arm: PlanarChain | DescribedArm) -> dict[str, Any]:
    """The joints between base and hand, and the hand."""
    placements, end = arm.placements()
    joints = []
    for at in placements:
        low, high = arm.joint_range[at.joint]
        unit, per = ("m", "N_s_per_m") if at.slides else ("rad", "N_m_s_per_rad")
        joint = {
            "kind": "prismatic" if at.slides else "revolute",
            "rotation": [texts(row) for row in at.rotation],
            "translation_m": texts(at.translation),
            f"low_{unit}": text(low),
            f"high_{unit}": text(high),
            **_own_damping(arm, at.joint, per),
        }
        rest = arm.rest if isinstance(arm, PosedArm) else None
        joints.append(joint if rest is None or at.slides else {**joint, "rest_rad": text(rest[at.joint])})
    own = [at.joint for at in placements]
    return {
        "geometry": "chain",
        "joints": joints,
        "end_m": texts(end),
        **_shared_damping(arm, "N_m_s_rad", own),
    }


def _own_damping(arm: Arm, joint: int, unit: str) -> dict[str, str]:
    """Of one joint; nothing where joints damp each other."""
    b = np.asarray(arm.damping)
    return {f"damping_{unit}": text(b[joint])} if b.ndim == 1 else {}


def _shared_damping(arm: Arm, unit: str, own: Sequence[int] | None = None) -> dict[str, list[list[str]]]:
    """The matrix of joints that damp each other, of those that move the hand; nothing of others."""
    b = np.asarray(arm.damping)
    rows = b if own is None or b.ndim == 1 else b[np.ix_(own, own)]
    return {f"damping_{unit}": _matrix(rows)} if b.ndim == 2 else {}


def unsaid(arm: Written) -> str:
    """Why no document can say how an arm moves and is damped; empty where one can.

    Where a joint that moves the hand is damped together with one that does not, the part of the matrix that
    a document has is more than is lost: the other joint may go along.
    """
    if isinstance(arm, LeggedArm):
        return ""
    if isinstance(arm, DescribedArm) and arm.follows:
        return "joints between base and hand follow others, for which it has no words"
    own = [at.joint for at in arm.placements()[0]]
    others = [i for i in range(arm.joint_count) if i not in own]
    coupled = as_matrix(arm.damping)[np.ix_(own, others)].any()
    return "joints on the way to the hand are damped together with joints beside it" if coupled else ""


def _add_steps(document: dict[str, Any], arm: Chain, steps: EncoderSteps, limits: tuple[float, ...]) -> None:
    """Encoders and Coulomb friction of the joints, bounds on the columns of J, and the forces covered."""
    friction = arm.coulomb_friction
    for joint, at in zip(document["arm"]["joints"], arm.placements()[0], strict=True):
        unit, per = ("m", "N") if at.slides else ("rad", "N_m")
        joint[f"resolution_{unit}"] = text(moving_steps(arm)[at.joint])
        joint[f"coulomb_friction_{per}"] = text(float(friction[at.joint]))
        if not at.slides:
            joint["largest_column_m_per_rad"] = text(steps.columns[at.joint])
    loop = document["loop"]
    loop["encoder"] = "counted"
    loop["torque"] = {"follows the arm": "follows the readings"}.get(loop["torque"], loop["torque"])
    for key, limit in zip(("largest_force_N", "largest_moment_N_m"), limits, strict=False):
        loop[key] = text(limit)


def pose_document(arm: Arm) -> dict[str, Any]:
    """How many coordinates of the wall are rotations, and where it rests: nothing of a point."""
    if not arm.turns:
        return {}
    given = isinstance(arm, PosedArm) and arm.rest is not None
    return {"turns": arm.turns, "rest": "given" if given else "every orientation"}


def wall_matrices_document(wall: Wall | MatrixWall, size: int) -> dict[str, Any]:
    """K, B and what stands for |B|."""
    if isinstance(wall, Wall):
        spring, damper = certain(wall.stiffness, "stiffness"), certain(wall.damping, "damping")
        matrices = [_scalar(x, size) for x in (spring, damper, abs(damper))]
    else:
        k, b = wall_matrices(wall, size)
        stiffness = k if _is_semidefinite(k) else _raised(k, wall.turns)
        bound = _raised(_absolute(b, wall.turns), wall.turns)
        matrices = [_matrix(m) for m in (stiffness, b, bound)]
    keys = _POSE_KEYS if wall.turns else _KEYS
    return dict(zip(keys, matrices, strict=True))


def _absolute(matrix: Array, turns: int) -> Array:
    """|B|, of forces and turns each by itself where B does not couple them: nor does rounding then."""
    point, bound = len(matrix) - turns, np.zeros_like(matrix)
    coupled = turns == 0 or matrix[:point, point:].any()
    for part in (slice(None),) if coupled else (slice(point), slice(point, None)):
        values, vectors = np.linalg.eigh(matrix[part, part])
        bound[part, part] = (vectors * np.abs(values)) @ vectors.T
    return bound


def _is_semidefinite(matrix: Array) -> bool:
    """True when no principal minor of the decimals is negative."""
    exact = [[flint.fmpq(*decimal_of(x).as_integer_ratio()) for x in row] for row in matrix]
    places = range(len(matrix))
    return all(
        flint.fmpq_mat([[exact[i][k] for k in chosen] for i in chosen]).det() >= 0
        for size in places
        for chosen in combinations(places, size + 1)
    )


def _raised(matrix: Array, turns: int) -> Array:
    """With a little more on the diagonal; forces and turns, in units of their own, each by their own size."""
    more, point = np.empty(len(matrix)), len(matrix) - turns
    for part in (slice(point), slice(point, None)):
        more[part] = _MARGIN * np.abs(matrix[part, part]).max(initial=0.0)
    return np.asarray(matrix + np.diag(more))


def _clock(question: Question) -> dict[str, Any]:
    return {
        "sample_period_s": exact_text(1 / decimal_of(question.rate)),
        "delay_samples": question.delay_samples,
    }


def _loop_document(question: Question, held: tuple[float, ...]) -> dict[str, Any]:
    loop: dict[str, Any] = {
        **_clock(question),
        "encoder": "ideal",
        "torque": "held" if held else "follows the arm",
    }
    if held:
        assert question.arm.curvature is not None
        force, *moment = held
        loop["largest_force_N"] = text(force)
        loop["curvature_m_per_rad2"] = text(question.arm.curvature * (1 + _CURVED))
        if moment:
            loop["largest_moment_N_m"] = text(moment[0])
    return loop


def _scalar(value: Fraction, size: int) -> list[list[str]]:
    return [[exact_text(value if i == k else Fraction(0)) for k in range(size)] for i in range(size)]


def _matrix(rows: Array) -> list[list[str]]:
    return [texts(row) for row in (rows + rows.T) / 2]


def texts(values: npt.ArrayLike) -> list[str]:
    """Each the decimal that a double is written as."""
    return [text(v) for v in np.asarray(values, dtype=np.float64)]


def text(value: float) -> str:
    """The decimal that a double is written as."""
    return exact_text(decimal_of(value))


def decimal_of(value: float) -> Fraction:
    """The decimal that a double is written as."""
    return Fraction(repr(float(value)))


# The document of a null-space spring is that of an arm before a wall, with Coulomb friction of each joint,
# and the spring: k, d_n, q_d, λ and the distance.  The checker makes J, P and the bounds on it by itself.


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
        joint["coulomb_friction_N_m"] = text(float(friction[i]))
    del machine["geometry"]
    document = {
        "format": FORMAT,
        "kind": "null space",
        "arm": machine,
        "wall": wall_matrices_document(question.wall, len(task_jacobian(arm, spring.rest)))
        | pose_document(arm),
        "loop": _clock(question),
        "spring": {
            "stiffness_N_m_per_rad": text(spring.stiffness),
            "damping_N_m_s_per_rad": text(spring.damping),
            "rest_rad": texts([spring.rest[i] for i in own]),
            "regularization": text(spring.regularization),
        },
    }
    return (document, "") if _is_of_spring(document, question, spring, own) else (None, _why(document))


def _probe(document: dict[str, Any]) -> dict[str, Any]:
    """Next to the rest and without the damper, where wall and spring are all that is asked of the joints."""
    near = {"damping_N_m_s_per_rad": "0", "distance_rad": text(_NEAR)}
    return {**document, "spring": {**document["spring"], **near}}


def _why(document: dict[str, Any]) -> str:
    found = verify(_probe(document))
    return "this arm moves in another way than its document can say" if found.valid else found.reason


def needed_at_rest(question: Question, spring: NullSpaceSpring) -> tuple[Array, Array]:
    """P at the rest, and what wall and spring ask of the joints there."""
    jacobian = task_jacobian(question.arm, np.asarray(spring.rest))
    need = question.need(len(jacobian))
    inside = projector(jacobian, spring.regularization)
    share = (2 * question.delay_samples + 1) * question.period / 2 * spring.stiffness
    return inside, jacobian.T @ (need.stiffness_share + need.bound) @ jacobian + share * inside


def _is_of_spring(
    document: dict[str, Any], question: Question, spring: NullSpaceSpring, own: list[int]
) -> bool:
    """Next to the rest the matrix that the checker reads out of the document is of the arm's own J and P."""
    rows = verify(_probe(document)).surplus
    if not rows:
        return False
    damping, (_, taken) = as_matrix(question.arm.damping), needed_at_rest(question, spring)
    free = [i for i in own if i in moving(question.arm)]
    expected = (damping - taken)[np.ix_(free, free)]
    upper = np.concatenate([row[i:] for i, row in enumerate(expected)])
    size = np.abs(damping).max() + np.abs(taken).max()
    return bool(np.abs(np.concatenate(rows) - upper).max() <= _SAME * size)
