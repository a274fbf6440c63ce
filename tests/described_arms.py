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
    path.write_text(f'<robot name="random">{"".join(parts)}</robot>')
    return path


def _placed(rng: np.random.Generator) -> str:
    rpy = " ".join(map(str, rng.uniform(-2, 2, 3)))
    return f'<origin {_xyz(rng.uniform(-0.2, 0.2, 3))} rpy="{rpy}"/>'


def _xyz(vector: np.ndarray) -> str:
    return f'xyz="{" ".join(map(str, vector))}"'
