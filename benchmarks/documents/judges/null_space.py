"""Null-space springs: the projector by singular vectors of Jacobians by differences, at random places."""

from __future__ import annotations

from collections.abc import Callable
from typing import Any

import numpy as np
from scipy.spatial.transform import Rotation

from ..opinion import Opinion, agrees, cannot_say, false
from .arms import SLACK, STEP, Chain, _matrix, _number

Document = dict[str, Any]
Rng = np.random.Generator
Array = np.ndarray

PLACES = 60


class Redundant(Chain):
    """A chain, and what of its hand a projector knows."""

    def __init__(self, document: Document) -> None:
        super().__init__(document["arm"])
        wall, spring = document["wall"], document["spring"]
        self.turns = int(_number(wall["turns"])) if "turns" in wall else 0
        self.size = len(wall[f"stiffness_{'N_m_rad' if self.turns else 'N_per_m'}"])
        self.rest = np.array([_number(x) for x in spring["rest_rad"]])
        self.regularization = _number(spring["regularization"])

    def task(self, q: Array) -> Array:
        """J of velocity, and in pose of angular velocity."""
        rows = self.jacobian(q, lambda v: self.placed(v)[0])[: self.size - self.turns]
        if not self.turns:
            return rows
        steps = np.eye(len(q)) * STEP
        turned = [
            Rotation.from_matrix(self.placed(q + h)[1] @ self.placed(q - h)[1].T).as_rotvec() for h in steps
        ]
        return np.vstack([rows, np.stack(turned, axis=-1)[3 - self.turns :] / (2 * STEP)])

    def projector(self, q: Array) -> Array:
        """Of the motions that leave the hand where it is."""
        _, sizes, rows = np.linalg.svd(self.task(q), full_matrices=False)
        if not self.regularization and sizes[-1] <= 1e-4 * sizes[0]:
            raise ValueError("singular")
        kept = sizes**2 / (sizes**2 + self.regularization**2)
        return np.eye(len(q)) - rows.T @ np.diag(kept) @ rows

    def anywhere(self, distance: float, rng: Rng) -> Array:
        """In the ranges and within a distance of the rest, mostly as far as that."""
        way = rng.normal(size=len(self.rest)) * (rng.random(len(self.rest)) < rng.choice((0.4, 1.0)))
        share = 1.0 if rng.random() < 0.7 else rng.random()
        far = share * distance * way / max(float(np.linalg.norm(way)), 1e-300)
        return np.clip(self.rest + far, self.low, self.high)


def _null_space(document: Document, rng: Rng) -> Opinion:
    """What friction is asked for at random places, and what is left of the joints' damping."""
    arm, wall, loop, spring = (Redundant(document), *(document[n] for n in ("wall", "loop", "spring")))
    if (arm.rest < arm.low).any() or (arm.rest > arm.high).any() or any(arm.slides):
        return false("the spring rests outside the ranges, or a joint slides")
    ends = ("N_m_rad", "N_m_s_rad", "N_m_s_rad") if arm.turns else ("N_per_m", "N_s_per_m", "N_s_per_m")
    names = ("stiffness", "virtual_damping", "damping_bound")
    k, b, a = (_matrix(wall[f"{n}_{e}"]) for n, e in zip(names, ends, strict=True))
    size = np.abs(k).max() + np.abs(a).max() + 1e-300
    if any(np.linalg.eigvalsh(m)[0] < -1e-9 * size for m in (k, a + b, a - b)):
        return false("a matrix of the wall has a negative eigenvalue")
    share = (2 * int(_number(loop["delay_samples"])) + 1) * _number(loop["sample_period_s"]) / 2
    friction = np.array([_number(j["coulomb_friction_N_m"]) for j in document["arm"]["joints"]])
    stiffness, damping = (_number(spring[f"{n}_per_rad"]) for n in ("stiffness_N_m", "damping_N_m_s"))
    distance, free = _number(spring["distance_rad"]), arm.high > arm.low
    try:
        first = arm.projector(arm.rest)
        for _ in range(PLACES):
            q, other = arm.anywhere(distance, rng), arm.anywhere(distance, rng)
            lack = stiffness * np.abs((arm.projector(q) - first) @ (q - arm.rest))
            room = SLACK * stiffness * distance
            if (lack > friction + room)[free].any():
                return false(f"friction lacks {(lack - friction)[free].max():.6g} N·m at {q.tolist()}")
            j = arm.task(q)
            taken = j.T @ (share * k + a) @ j + share * stiffness * first + damping * arm.projector(other)
            left = (arm.damping - taken)[np.ix_(free, free)]  # a joint that is held has no speed
            least = np.linalg.eigvalsh(left)[0] if free.any() else 0.0
            if "turns" in wall and wall["rest"] == "given":
                continue  # away from its rest a wall in pose asks for less
            if least < -SLACK * (np.abs(arm.damping).max() + np.abs(taken).max()):
                return false(f"the damping falls short by {-least:.6g} at {q.tolist()}")
    except ValueError:
        return cannot_say("a singular position")
    return agrees()


JUDGES: dict[str, Callable[[Document, Rng], Opinion]] = {"null space": _null_space}
