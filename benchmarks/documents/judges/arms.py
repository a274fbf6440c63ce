"""Arms: where the hand is by homogeneous matrices and arcs, Jacobians by differences, at random places."""

from __future__ import annotations

from collections.abc import Callable
from typing import Any

import numpy as np
from scipy.spatial.transform import Rotation

from ..opinion import Opinion, agrees, cannot_say, false
from ..plain import exact

Document = dict[str, Any]
Rng = np.random.Generator
Array = np.ndarray

PLACES, STEP = 24, 1e-6
SLACK = 1e-6
"""Relative, of what differences may be off."""


def _number(value: Any) -> float:
    return float(exact(value))


def _matrix(rows: Any) -> Array:
    return np.array([[_number(x) for x in row] for row in rows])


def _wall(document: Document) -> tuple[Array, Array, Array]:
    wall = document["wall"]
    pose = "turns" in wall
    ends = ("N_m_rad", "N_m_s_rad", "N_m_s_rad") if pose else ("N_per_m", "N_s_per_m", "N_s_per_m")
    names = ("stiffness", "virtual_damping", "damping_bound")
    return tuple(_matrix(wall[f"{n}_{e}"]) for n, e in zip(names, ends, strict=True))  # type: ignore[return-value]


def _arm(document: Document, rng: Rng) -> Opinion:
    """The joints' damping less what the wall takes, at random places, and what else the proof asks for."""
    k, b, a = _wall(document)
    loop = document["loop"]
    size = np.abs(k).max() + np.abs(a).max() + 1e-300
    for name, matrix in (("K", k), ("A + B", a + b), ("A − B", a - b)):
        if np.linalg.eigvalsh(matrix)[0] < -1e-9 * size:
            return false(f"{name} has a negative eigenvalue")
    period, delay = _number(loop["sample_period_s"]), int(_number(loop["delay_samples"]))
    need = (2 * delay + 1) * period / 2 * k + a
    if document["arm"]["geometry"] == "legs":
        return _legs(document["arm"], need, rng)
    return _chain(document, need, period, rng)


def _damping(arm: Document, parts: list[Document]) -> Array:
    """A matrix, of joints or legs that damp each other or of numbers of their own."""
    whole = [value for key, value in arm.items() if key.startswith("damping_")]
    if whole:
        return _matrix(whole[0])
    return np.diag([_number(v) for part in parts for k, v in part.items() if k.startswith("damping_")])


class Chain:
    """Joints as in the document."""

    def __init__(self, arm: Document) -> None:
        self.joints = arm["joints"]
        self.end = np.array([_number(x) for x in arm["end_m"]])
        self.slides = [j["kind"] == "prismatic" for j in self.joints]
        unit = ["m" if s else "rad" for s in self.slides]
        self.low = np.array([_number(j[f"low_{u}"]) for j, u in zip(self.joints, unit, strict=True)])
        self.high = np.array([_number(j[f"high_{u}"]) for j, u in zip(self.joints, unit, strict=True)])
        self.damping = _damping(arm, self.joints)
        self.frames = [
            (_matrix(j["rotation"]), np.array([_number(x) for x in j["translation_m"]])) for j in self.joints
        ]

    def placed(self, q: Array) -> tuple[Array, Array]:
        """Where the hand is, and its orientation."""
        point, turned = np.zeros(3), np.eye(3)
        for (rotation, translation), slides, x in zip(self.frames, self.slides, q, strict=True):
            point = point + turned @ translation
            turned = turned @ rotation
            if slides:
                point = point + turned[:, 2] * x
            else:
                s, c = np.sin(x), np.cos(x)
                turned = turned @ np.array([[c, -s, 0], [s, c, 0], [0, 0, 1.0]])
        return point + turned @ self.end, turned

    def jacobian(self, q: Array, of: Callable[[Array], Array]) -> Array:
        """By central differences of a function of the joints."""
        steps = np.eye(len(q)) * STEP
        return np.stack([(of(q + h) - of(q - h)) / (2 * STEP) for h in steps], axis=-1)


def _chain(document: Document, need: Array, period: float, rng: Rng) -> Opinion:
    arm, wall, loop = Chain(document["arm"]), document["wall"], document["loop"]
    turns = int(_number(wall["turns"])) if "turns" in wall else 0
    held, counted = loop["torque"] == "held", loop["encoder"] == "counted"
    limits = [_number(loop.get(n, 0)) for n in ("largest_force_N", "largest_moment_N_m")]
    low, high = arm.low, arm.high
    if counted:
        found = _friction(document, arm, limits, period, turns, rng)
        if found.word != "agrees":
            return found
    if held and int(_number(loop["delay_samples"])):
        return false("a held torque is proved without delay")
    for place in range(PLACES):
        q = _place(low, high, place, rng)
        if turns == 1:
            of = lambda v: np.append(arm.placed(v)[0][:2], v.sum())  # noqa: E731
        elif turns == 3:
            of = _pose(arm, wall, document, rng)
        else:
            of = lambda v: arm.placed(v)[0][: len(need)]  # noqa: E731
        j = arm.jacobian(q, of)
        surplus = arm.damping - j.T @ need @ j
        if held:
            surplus -= np.eye(len(q)) * _price(arm, q, limits, period, turns)
        least, size = np.linalg.eigvalsh(surplus)[0], np.abs(arm.damping).max() + np.abs(j.T @ need @ j).max()
        if least < -SLACK * size:
            return false(f"the damping falls short by {-least:.6g} at {np.round(q, 6).tolist()}")
    return agrees()


def _place(low: Array, high: Array, place: int, rng: Rng) -> Array:
    """Corners first, then anywhere."""
    share = rng.integers(0, 2, len(low)) if place < PLACES // 3 else rng.random(len(low))
    return low + share * (high - low)


def _pose(arm: Chain, wall: Document, document: Document, rng: Rng) -> Callable[[Array], Array]:
    """Position, and twice the vector of the quaternion from the orientation of rest."""
    if wall["rest"] == "given":
        rest = np.array([_number(j.get("rest_rad", 0)) for j in document["arm"]["joints"]])
        start = Rotation.from_matrix(arm.placed(rest)[1])
    else:
        start = Rotation.random(random_state=int(rng.integers(2**31)))

    def of(q: Array) -> Array:
        point, turned = arm.placed(q)
        quaternion = (Rotation.from_matrix(turned) * start.inv()).as_quat()
        reference = of.__dict__.setdefault("reference", quaternion)
        return np.concatenate([point, 2 * quaternion[:3] * np.sign(quaternion @ reference)])

    return of


def _price(arm: Chain, q: Array, limits: list[float], period: float, turns: int) -> float:
    """What a torque that is held costs at least here: second derivatives along random directions."""
    if turns:
        return 0.0
    most, n = 0.0, len(q)
    directions = np.vstack([np.eye(n), np.random.default_rng(1).normal(size=(4, n))])
    for d in directions / np.linalg.norm(directions, axis=1)[:, None]:
        h = 1e-4 * d
        bend = (arm.placed(q + h)[0] - 2 * arm.placed(q)[0] + arm.placed(q - h)[0]) / 1e-8
        most = max(most, float(np.linalg.norm(bend)))
    return most * (1 - 1e-5) * limits[0] * period / 2


def _friction(
    document: Document, arm: Chain, limits: list[float], period: float, turns: int, rng: Rng
) -> Opinion:
    """Columns as long as they are at random places, and the friction that the steps ask for with these."""
    if turns:
        return agrees()
    k, b, _ = _wall(document)
    units = ["m" if s else "rad" for s in arm.slides]
    joints = list(zip(arm.joints, units, strict=True))
    steps = np.array([_number(j[f"resolution_{u}"]) for j, u in joints]) * (arm.high > arm.low)
    own = np.array([_number(j[f"coulomb_friction_{'N' if u == 'm' else 'N_m'}"]) for j, u in joints])
    said = [1.0 if u == "m" else _number(j["largest_column_m_per_rad"]) for j, u in joints]
    longest = np.zeros(len(steps))
    for place in range(PLACES):
        q = _place(arm.low - steps, arm.high + steps, place, rng)
        j = arm.jacobian(q, lambda v: arm.placed(v)[0])
        longest = np.maximum(longest, np.linalg.norm(j, axis=0))
    if (longest > np.array(said) * (1 + SLACK)).any():
        return false(f"a column is {longest.max():.9g} long")
    size = np.linalg.norm(k, 2) + 2 * np.linalg.norm(b, 2) / period
    least = longest * size * (longest @ steps) / 2
    if (own < least * (1 - SLACK)).any():
        return false(f"the friction of a joint is below {least.max():.9g}")
    return agrees()


def _legs(arm: Document, need: Array, rng: Rng) -> Opinion:
    low, high = (np.array([_number(x) for x in arm[n]]) for n in ("low_m", "high_m"))
    damping = _damping(arm, arm["legs"])
    for leg in arm["legs"]:
        axes = np.array([[_number(x) for x in leg[n]] for n in ("out", "up")])
        if np.abs(axes @ axes.T - np.eye(2)).max() > SLACK:
            return false("the plane of a leg has axes that are no unit vectors at right angles")
    for place in range(PLACES):
        p = _place(low, high, place, rng)
        steps = np.eye(len(p)) * STEP
        try:
            gradients = np.array(
                [
                    [(_angle(leg, p + h) - _angle(leg, p - h)) / (2 * STEP) for h in steps]
                    for leg in arm["legs"]
                ]
            )
        except ValueError:
            return false(f"the arm does not reach {np.round(p, 6).tolist()}")
        if np.abs(gradients).max() > 1e5:
            return cannot_say("too close to a singular place")
        surplus = gradients.T @ damping @ gradients - need
        if np.linalg.eigvalsh(surplus)[0] < -10 * SLACK * (np.abs(surplus).max() + np.abs(need).max()):
            return false(f"the damping is not enough at {np.round(p, 6).tolist()}")
    return agrees()


def _angle(leg: Document, p: Array) -> float:
    """Of the link in its plane, by the law of cosines."""
    base, out, up = (np.array([_number(x) for x in leg[n]]) for n in ("base_m", "out", "up"))
    seen = p - base
    u, w = seen @ out, seen @ up
    link, rod, offset = (_number(leg[n]) for n in ("link_m", "rod_m", "offset_m"))
    length = rod + offset
    if len(p) == 3:
        across = seen @ np.cross(up, out)
        length = offset + np.sqrt(_inside(rod**2 - across**2))
    far = np.hypot(u, w)
    cosine = (link**2 + far**2 - length**2) / (2 * link * far)
    if abs(cosine) >= 1:
        raise ValueError("out of reach")
    return float(np.arctan2(w, u) + (1 if leg["bend"] > 0 else -1) * np.arccos(cosine))


def _inside(x: float) -> float:
    if x <= 0:
        raise ValueError("out of reach")
    return x


JUDGES: dict[str, Callable[[Document, Rng], Opinion]] = {"arm": _arm}
