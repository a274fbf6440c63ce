"""Coulomb friction in the joints against the steps of their encoders."""

from __future__ import annotations

from typing import Any

import numpy as np
import numpy.typing as npt
import pytest

import zwidth as zw
from zwidth.device.arm import Arm

Array = npt.NDArray[np.float64]

PERIOD, STEP = 1e-3, 2e-3


def put_in(arm: Arm, stiffness: float, virtual: float, friction: Array, q: Array) -> Array:
    """What the hand puts in on closed paths (…, N, m) with encoders, straight from sample to sample [J]."""
    p, read = arm.forward(q), arm.forward(np.floor(q / STEP) * STEP)
    force = stiffness * (read - p.mean(axis=-2, keepdims=True))
    force = force + virtual * (read - np.roll(read, 1, axis=-2)) / PERIOD
    moved, turned = np.roll(p, -1, axis=-2) - p, np.roll(q, -1, axis=-2) - q
    viscous = (turned**2 * np.asarray(arm.damping)).sum(axis=(-1, -2)) / PERIOD
    return np.asarray((force * moved).sum(axis=(-1, -2)) + viscous + (np.abs(turned) @ friction).sum(axis=-1))


def paths(rng: np.random.Generator, low: Array, high: Array, size: float) -> Array:
    """Closed paths in a region: half of them random, half to and fro over edges of the encoders."""
    count, samples, joints = 4000, 6, len(low)
    middle = rng.uniform(low + size, high - size, (count, 1, joints))
    q = middle + rng.uniform(-size, size, (count, samples, joints))
    edges = np.round(middle[: count // 2] / STEP) * STEP
    side = np.where(np.arange(samples) % 2, 1.0, -1.0)[None, :, None]
    q[: count // 2] = edges + size * 1e-3 * side * rng.choice([-1.0, 0.0, 1.0], (count // 2, 1, joints))
    return q


@pytest.mark.parametrize(("stiffness", "virtual"), [(200.0, 0.0), (100.0, 0.05)])
@pytest.mark.parametrize(
    ("name", "ranges"), [("hapkit", [(-0.5, 0.5)]), ("two-link", [(0.2, 2.0), (0.6, 2.4)])]
)
def test_both_sides(name: str, ranges: Any, stiffness: float, virtual: float) -> None:
    """With that friction no path of 12 000 gains, at random or over the edges; with 0.35 of it some do."""
    damping = tuple(0.01 for _ in ranges)
    arm = zw.arms.built_in(name, damping=damping, resolution=STEP, joint_range=ranges)
    space = zw.workspace(arm, zw.Wall(stiffness, virtual), rate=1 / PERIOD)
    assert space.outcome == "passive"
    assert "not counted" in space.claim
    friction = np.array(space.encoder_friction)
    low, high = np.array(ranges).T
    rng = np.random.default_rng(5)
    for size in (1e-3, 1e-2, 0.1):
        q = paths(rng, low, high, size)
        assert put_in(arm, stiffness, virtual, friction, q).min() > -1e-15
        assert size > 1e-3 or put_in(arm, stiffness, virtual, 0.35 * friction, q).min() < 0


def test_counted_in_the_claim() -> None:
    """As soon as the friction of every joint is enough."""
    numbers = {"damping": 0.01, "resolution": STEP}
    space = zw.workspace(zw.arms.built_in("two-link", **numbers), zw.Wall(100), rate=1000)
    enough = tuple(1.001 * f for f in space.encoder_friction)
    for friction, words in ((enough, "are counted"), ((enough[0], 0.99 * enough[1] / 1.001), "not counted")):
        arm = zw.arms.built_in("two-link", coulomb_friction=friction, **numbers)
        assert words in zw.workspace(arm, zw.Wall(100), rate=1000).claim


def test_held_torques_are_not_counted() -> None:
    """They read J at the encoder, too."""
    arm = zw.arms.built_in("two-link", damping=0.05, resolution=STEP, coulomb_friction=1.0)
    space = zw.workspace(arm, zw.Wall(100), rate=1000, torque_held_up_to=1.0)
    assert "not counted" in space.claim


def test_in_pose_each_block_pays_in_its_own_unit() -> None:
    """A planar chain in pose: translation and rotation add up, and metres may be millimetres."""

    def friction(scale: float) -> tuple[float, ...]:
        arm = zw.arms.PlanarChain(
            links=(0.1 * scale, 0.08 * scale), damping=(0.05, 0.05), resolution=(STEP, STEP),
            joint_range=((0, 1), (0.5, 1.5)), pose=True,
        )  # fmt: skip
        wall = zw.MatrixWall(np.diag([50 / scale**2, 50 / scale**2, 0.4]), np.zeros((3, 3)), turns=1)
        return zw.workspace(arm, wall, rate=1000, points=20).encoder_friction

    assert friction(1.0) == pytest.approx(friction(1000.0), rel=1e-9)
    only_turns = 0.4 * 2 * STEP
    assert all(value > only_turns for value in friction(1.0))


def test_without_encoders_nothing_is_asked() -> None:
    """Then no friction is needed."""
    arm = zw.arms.built_in("two-link", damping=0.05)
    assert zw.workspace(arm, zw.Wall(100), rate=1000).encoder_friction == ()
