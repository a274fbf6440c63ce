"""Robot descriptions for tests: joints in a row about axes of any direction."""

from __future__ import annotations

from pathlib import Path

import numpy as np


def random_arm(path: Path, seed: int, joints: int, sliding: tuple[int, ...] = ()) -> Path:
    """A URDF with joints j0, j1, …, placed and turned at random, each damped and with limits of its own."""
    rng = np.random.default_rng(seed)
    parts = [f'<link name="l{i}"/>' for i in range(joints + 2)]
    for i in range(joints):
        kind = "prismatic" if i in sliding else "revolute"
        axis = rng.normal(size=3)
        parts.append(
            f'<joint name="j{i}" type="{kind}"><parent link="l{i}"/><child link="l{i + 1}"/>'
            f"{_placed(rng)}<axis {_xyz(axis / np.linalg.norm(axis))}/>"
            f'<limit lower="{-rng.uniform(0.2, 0.5)}" upper="{rng.uniform(0.2, 0.5)}" '
            'effort="5" velocity="1"/>'
            f'<dynamics damping="{rng.uniform(0.2, 0.6)}"/></joint>'
        )
    parts.append(
        f'<joint name="hand" type="fixed"><parent link="l{joints}"/><child link="l{joints + 1}"/>'
        f"{_placed(rng)}</joint>"
    )
    path.write_text(f'<robot name="random">{"".join(parts)}</robot>', encoding="utf-8")
    return path


def _placed(rng: np.random.Generator) -> str:
    rpy = " ".join(map(str, rng.uniform(-2, 2, 3)))
    return f'<origin {_xyz(rng.uniform(-0.2, 0.2, 3))} rpy="{rpy}"/>'


def _xyz(vector: np.ndarray) -> str:
    return f'xyz="{" ".join(map(str, vector))}"'


PANDA = (
    # x, y, z [m] and roll [rad] in the frame of the joint before, limits [rad], effort [N·m]
    (0, 0, 0.333, 0, -2.8973, 2.8973, 87),
    (0, 0, 0, -np.pi / 2, -1.7628, 1.7628, 87),
    (0, -0.316, 0, np.pi / 2, -2.8973, 2.8973, 87),
    (0.0825, 0, 0, np.pi / 2, -3.0718, -0.0698, 87),
    (-0.0825, 0.384, 0, -np.pi / 2, -2.8973, 2.8973, 12),
    (0, 0, 0, np.pi / 2, -0.0175, 3.7525, 12),
    (0.088, 0, 0, np.pi / 2, -2.8973, 2.8973, 12),
)
"""A Franka Panda by its published Denavit–Hartenberg parameters (Craig) and limits; the flange at 0.107 m."""


def panda_like(path: Path, damping: float = 1.0) -> Path:
    """A URDF of seven joints placed as those of a Panda, damped alike."""
    parts = [f'<link name="l{i}"/>' for i in range(len(PANDA) + 2)]
    for i, (x, y, z, roll, low, high, effort) in enumerate(PANDA):
        parts.append(
            f'<joint name="j{i + 1}" type="revolute"><parent link="l{i}"/><child link="l{i + 1}"/>'
            f'<origin xyz="{x} {y} {z}" rpy="{roll} 0 0"/><axis xyz="0 0 1"/>'
            f'<limit lower="{low}" upper="{high}" effort="{effort}" velocity="2"/>'
            f'<dynamics damping="{damping}"/></joint>'
        )
    parts.append(
        f'<joint name="flange" type="fixed"><parent link="l{len(PANDA)}"/><child link="l{len(PANDA) + 1}"/>'
        '<origin xyz="0 0 0.107"/></joint>'
    )
    path.write_text(f'<robot name="panda-like">{"".join(parts)}</robot>', encoding="utf-8")
    return path
