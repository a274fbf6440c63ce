"""Arms, their documents and their motions: `from arm_documents import put, two_link`."""

from __future__ import annotations

import copy
from collections.abc import Iterator
from fractions import Fraction
from pathlib import Path
from typing import Any

import numpy as np
import numpy.typing as npt
from scipy.spatial.transform import Rotation

from zwidth.model.arms.replay import replay_cycle

IDENTITY = [["1", "0", "0"], ["0", "1", "0"], ["0", "0", "1"]]
GONE = object()


def texts(rows: npt.ArrayLike) -> Any:
    """The same in decimals."""
    array = np.asarray(rows, dtype=np.float64)
    return repr(float(array)) if array.ndim == 0 else [texts(row) for row in array]


def fractions(values: npt.ArrayLike) -> list[Fraction]:
    """The decimals of doubles."""
    return [Fraction(repr(float(x))) for x in np.asarray(values)]


def put(document: dict[str, Any], path: str, value: Any) -> dict[str, Any]:
    """A copy with one place changed, named as in arm__joints__0__low_rad; GONE takes it away."""
    document = copy.deepcopy(document)
    *way, last = [int(key) if key.isdigit() else key for key in path.split("__")]
    inner: Any = document
    for key in way:
        inner = inner[key]
    if value is GONE:
        del inner[last]
    else:
        inner[last] = value
    return document


def places(part: Any, path: tuple[str, ...] = ()) -> Iterator[str]:
    """Of every number, list and table of a document."""
    for key, value in part.items() if isinstance(part, dict) else enumerate(part):
        yield "__".join((*path, str(key)))
        if isinstance(value, (dict, list)):
            yield from places(value, (*path, str(key)))


def left_over(document: dict[str, Any], j: np.ndarray) -> np.ndarray:
    """δ_m − JᵀRJ of a wall without damping."""
    (stiffness,) = (value for key, value in document["wall"].items() if key.startswith("stiffness"))
    b = [float(v) for joint in document["arm"]["joints"] for k, v in joint.items() if k.startswith("damping")]
    return np.diag(b) - 0.0005 * j.T @ np.array(stiffness, dtype=float) @ j


def _document(
    arm: dict[str, Any], stiffness: npt.ArrayLike, pose: bool = False, **wall: Any
) -> dict[str, Any]:
    unit, per = ("N_m_rad", "N_m_s_rad") if pose else ("N_per_m", "N_s_per_m")
    zeros = texts(np.zeros_like(stiffness))
    wall |= {f"stiffness_{unit}": texts(stiffness), f"virtual_damping_{per}": zeros}
    loop = {"sample_period_s": "0.001", "delay_samples": 0, "encoder": "ideal", "torque": "follows the arm"}
    return {
        "format": "zwidth certificate 1",
        "kind": "arm",
        "arm": arm,
        "wall": wall | {f"damping_bound_{per}": zeros},
        "loop": loop,
    }


def _changed(document: dict[str, Any], changes: dict[str, Any]) -> dict[str, Any]:
    for path, value in changes.items():
        document = put(document, path, value)
    return document


def two_link(**changes: Any) -> dict[str, Any]:
    """Links of 0.1 and 0.09 m before a wall in the plane; 1 in 30 below what it bears."""
    joints = [
        {
            "kind": "revolute",
            "rotation": IDENTITY,
            "translation_m": [x, "0", "0"],
            "low_rad": low,
            "high_rad": high,
            "damping_N_m_s_per_rad": b,
        }
        for x, low, high, b in (("0", "0", "1.5", "0.02"), ("0.1", "0.6", "2.4", "0.013"))
    ]
    arm = {"geometry": "chain", "joints": joints, "end_m": ["0.09", "0", "0"]}
    return _changed(_document(arm, [[860, 30], [30, 750]]), changes)


def pantograph(**changes: Any) -> dict[str, Any]:
    """Five bars, elbows outwards; 1 in 20 below what it bears."""
    leg = {"out": ["1", "0"], "up": ["0", "1"], "link_m": "0.07", "rod_m": "0.09", "offset_m": "0"}
    legs = [
        {**leg, "base_m": [x, "0"], "bend": bend, "damping_N_m_s_per_rad": "0.003"}
        for x, bend in (("-0.019", 1), ("0.019", -1))
    ]
    box = {"low_m": ["-0.04", "0.06"], "high_m": ["0.04", "0.12"]}
    return _changed(_document({"geometry": "legs", "legs": legs, **box}, 650 * np.eye(2)), changes)


def in_space() -> dict[str, Any]:
    """A leg in each direction of space, with hinges that stand off."""
    leg = {**pantograph()["arm"]["legs"][0], "offset_m": "0.02", "base_m": ["0.04", "-0.01", "0.02"]}
    legs = [{**leg, "out": IDENTITY[i], "up": IDENTITY[i - 1], "bend": (-1) ** i} for i in range(3)]
    arm = {"geometry": "legs", "legs": legs, "low_m": ["0.05"] * 3, "high_m": ["0.06"] * 3}
    return {**random_chain(np.random.default_rng(2), 1), "arm": arm}


def random_chain(rng: np.random.Generator, size: int) -> dict[str, Any]:
    """Joints of both kinds with any placement."""
    joints = []
    for _ in range(size):
        turn = np.linalg.qr(rng.normal(size=(3, 3)))[0]
        slides = rng.random() < 0.3
        joints.append(_joint(turn, rng.normal(size=3) * 0.1, slides, rng.uniform(0.1, 0.3)))
    root = rng.normal(size=(3, 3)) * 15
    stiffness = root @ root.T
    arm = {"geometry": "chain", "joints": joints, "end_m": ["0.05", "-0.02", "0.08"]}
    return _document(arm, (stiffness + stiffness.T) / 2)


def _joint(turn: np.ndarray, offset: np.ndarray, slides: bool, damping: float) -> dict[str, Any]:
    unit, per = ("m", "N_s_per_m") if slides else ("rad", "N_m_s_per_rad")
    placed = {
        "rotation": texts(turn),
        "translation_m": texts(offset),
        f"low_{unit}": "-0.2",
        f"high_{unit}": "0.3",
    }
    return {"kind": "prismatic" if slides else "revolute", **placed, f"damping_{per}": texts(damping)}


def chain_in_pose(seed: int, size: int, every: bool, slides: tuple[int, ...] = ()) -> dict[str, Any]:
    """Joints with any placement; the wall couples forces and turns if its rest is given."""
    rng, joints = np.random.default_rng(seed), []
    for i in range(size):
        turn, offset = Rotation.random(rng=rng).as_matrix(), rng.normal(size=3) * 0.1
        joint = _joint(turn, offset, i in slides, rng.uniform(0.1, 0.3) * (20 if i in slides else 1))
        if i > 1:
            joint["high_m" if i in slides else "high_rad"] = "-0.2"
        rest = texts(rng.uniform(-1, 1))
        joints.append(joint if every or i in slides else {**joint, "rest_rad": rest})
    root = np.diag([20.0] * 3 + [2.0] * 3) @ rng.normal(size=(6, 6))
    stiffness = root @ root.T + np.diag([1e-9] * 6)
    if every:
        stiffness[:3, 3:] = stiffness[3:, :3] = 0
        stiffness[3:, 3:] = 4 * np.eye(3)
    arm = {"geometry": "chain", "joints": joints, "end_m": ["0.05", "-0.02", "0.08"]}
    rest = "every orientation" if every else "given"
    return _document(arm, (stiffness + stiffness.T) / 2, True, turns=3, rest=rest)


def described(path: Path, joints: list[tuple[str, str, str, str, float]], holder: str, end: str) -> Path:
    """An arm of joints (kind, axis, xyz, rpy, damping) in a row, the hand at `end` of the link `holder`."""
    parts = [
        f'<joint name="j{i}" type="{kind}"><parent link="l{i}"/><child link="l{i + 1}"/>'
        f'<origin xyz="{xyz}" rpy="{rpy}"/><axis xyz="{axis}"/>'
        f'<limit lower="-0.3" upper="0.4" effort="1" velocity="1"/><dynamics damping="{damping}"/></joint>'
        for i, (kind, axis, xyz, rpy, damping) in enumerate(joints)
    ]
    hand = f'<parent link="{holder}"/><child link="tip"/><origin xyz="{end}"/>'
    parts.append(f'<joint name="t" type="fixed">{hand}</joint>')
    links = "".join(f'<link name="{n}"/>' for n in [*(f"l{i}" for i in range(len(joints) + 1)), "tip"])
    path.write_text(f'<robot name="arm">{links}{"".join(parts)}</robot>', encoding="utf-8")
    return path


def least_left(arm: Any, wall: Any, delay: int, rng: np.random.Generator, cycles: int, most: int) -> float:
    """Of random and alternating closed paths, small and across the region: none takes energy out.

    The least energy of all, in parts of what the joints damp.
    """
    (low, high), least = np.array(arm.joint_range).T, np.inf
    for _ in range(cycles):
        middle, size, samples = rng.uniform(low, high), 10 ** rng.uniform(-4, 0), int(rng.integers(2, most))
        shape = rng.normal(size=2) * np.cos(2 * np.pi / samples * np.arange(samples))[:, None]
        if rng.random() < 0.5:
            shape = rng.normal(size=(samples, 2))
        motion = replay_cycle(arm, wall, 0.001, delay, np.clip(middle + size * shape, low, high))
        assert motion.energy >= -1e-12 * motion.loss
        if motion.loss:
            least = min(least, motion.energy / motion.loss)
    return least
