"""Joints that damp each other: both sides of the limit, with certificates and motions replayed."""

from __future__ import annotations

import json
from typing import Any

import numpy as np
import numpy.typing as npt
import pytest
from described_arms import random_arm

import zwidth as zw
from zwidth.checker import verify
from zwidth.model.arms import Arm, LeggedArm, PlanarChain, built_in, read_arm
from zwidth.model.arms.arm import ArmMotion
from zwidth.model.arms.joints import as_matrix

Array = npt.NDArray[np.float64]

PERIOD, NEAR = 0.001, 1e-3
"""NEAR: of the limit."""
SMALL = ((0.7, 0.7002), (1.2, 1.2002))
"""So small a region that it has one limit."""


def random_damping(seed: int, joints: int, size: float = 0.02) -> Array:
    """δ ≻ 0 with couplings of either sign."""
    root = np.random.default_rng(seed).normal(size=(joints, joints))
    return size * (root @ root.T / joints + 0.2 * np.eye(joints))


def chain(damping: Any, **more: Any) -> PlanarChain:
    return PlanarChain(links=(0.1, 0.08), damping=damping, joint_range=SMALL, **more)


def pantograph(damping: Any) -> Arm:
    return built_in("haply-2diy", damping=damping, lower=(0.02, 0.08), upper=(0.0202, 0.0802), resolution=0)


def decided(arm: Arm, wall: Any = 10, points: int = 4, **asked: float) -> Any:
    """At 1 kHz, of a wall or a stiffness."""
    wall = zw.Wall(wall) if isinstance(wall, float | int) else wall
    return zw.workspace(arm, wall, rate=1 / PERIOD, points=points, **asked)


def limit_by_hand(arm: Arm, at: Array) -> float:
    """2/T times the least eigenvalue of J⁻ᵀδJ⁻¹, with J by differences."""
    steps = np.eye(len(at)) * 1e-6
    j = np.stack([(arm.forward(at + h) - arm.forward(at - h)) / 2e-6 for h in steps], axis=-1)
    inverse = np.linalg.inv(j)
    return float(2 / PERIOD * np.linalg.eigvalsh(inverse.T @ as_matrix(arm.damping) @ inverse)[0])


def energy_by_hand(arm: Arm, motion: ArmMotion, stiffness: float) -> float:
    """What a hand puts in on a closed path, with the friction of its shafts: the loss is Σ β (cᵀΔq)²/T."""
    rates, shafts = np.linalg.eigh(np.array(arm.damping))
    p, turned = arm.forward(motion.joints), np.roll(motion.joints, -1, axis=0) - motion.joints
    work = (stiffness * (p - motion.rest) * (np.roll(p, -1, axis=0) - p)).sum()
    return float(work + (rates * (turned @ shafts) ** 2).sum() / PERIOD)


@pytest.mark.parametrize("build", [chain, pantograph])
@pytest.mark.parametrize("seed", range(6))
def test_both_sides_of_the_limit(build, seed):
    """A thousandth below it the checker accepts the proof; above it a motion takes energy out."""
    arm = build(random_damping(seed, 2))
    sites = arm.sites(2)
    at = sites.joints.reshape(-1, 2).mean(axis=0)
    limit = limit_by_hand(arm, at)
    below = decided(arm, (1 - 4 * NEAR) * limit)
    assert below.outcome == "passive"
    assert below.certificate.verify()
    above = decided(arm, (1 + 4 * NEAR) * limit)
    assert above.outcome == "active"
    assert above.motion.energy == pytest.approx(
        energy_by_hand(arm, above.motion, above.wall.stiffness), rel=1e-6
    )
    assert above.motion.energy < 0


@pytest.mark.parametrize("seed", range(4))
def test_couplings_count(seed):
    """The diagonal alone would say another limit: a verdict that forgot the rest would be wrong."""
    damping = random_damping(seed, 2)
    limits = [
        decided(chain(d)).largest_stiffness for d in (damping, np.diag(damping), damping * [[1, -1], [-1, 1]])
    ]
    assert abs(limits[0] / limits[1] - 1) > 0.02
    assert abs(limits[0] / limits[2] - 1) > 0.02


def test_a_document_with_more_than_there_is_is_refused():
    """Couplings that are turned round, or left out, from a document that holds."""
    arm = chain(random_damping(2, 2))
    limit = decided(arm).largest_stiffness
    space = decided(arm, 0.999 * limit)
    document = json.loads(json.dumps(space.certificate.to_dict()))
    assert verify(document).valid
    (a, c), (_, b) = document["arm"]["damping_N_m_s_rad"]
    other = c.removeprefix("-") if c.startswith("-") else f"-{c}"
    truths = []
    for coupling in (other, "0"):
        document["arm"]["damping_N_m_s_rad"] = [[a, coupling], [coupling, b]]
        changed = chain([[float(a), float(coupling)], [float(coupling), float(b)]])
        holds = limit_by_hand(changed, np.array([0.7001, 1.2001])) > 0.999 * limit
        assert verify(document).valid is bool(holds)
        truths.append(bool(holds))
    assert not all(truths)


@pytest.mark.parametrize(
    ("pose", "wall"),
    [
        (False, lambda factor: zw.Wall(100 * factor)),
        (True, lambda factor: zw.arms.MatrixWall.in_pose(100 * factor, factor, planar=True)),
    ],
)
def test_a_redundant_chain_and_a_pose_are_proved(pose, wall):
    ranges = ((0.2, 0.21), (0.5, 0.51), (0.4, 0.41))
    damping = random_damping(5, 3)
    arm = PlanarChain(links=(0.1, 0.08, 0.05), damping=damping, joint_range=ranges, pose=pose)
    factor = decided(arm, wall(1), 6).stiffness_factor
    outcomes = [decided(arm, wall(times * factor), 6).outcome for times in (0.97, 1.03)]
    assert outcomes == ["passive", "active"]


@pytest.mark.parametrize("seed", range(3))
def test_held_torques_cost_every_motion_of_the_joints(seed):
    """c q̇ᵀq̇ with c = h F T/2: proved up to the force at which δ − c − JᵀRJ is singular, and not beyond."""
    arm, stiffness = chain(random_damping(seed, 2)), 20.0
    j = arm.jacobian(np.array([0.7001, 1.2001]))
    left = np.linalg.eigvalsh(np.array(arm.damping) - PERIOD / 2 * stiffness * j.T @ j)[0]
    most = 2 * left / (arm.curvature * PERIOD)
    forces = ((1 - 2 * NEAR) * most, (1 + 2 * NEAR) * most)
    outcomes = [decided(arm, stiffness, torque_held_up_to=force).outcome for force in forces]
    assert outcomes == ["passive", "undecided"]


def test_encoder_steps_are_counted_beside_couplings():
    """They are covered joint by joint, by Coulomb friction, which no matrix shares out."""
    arm = chain(random_damping(1, 2), resolution=(1e-5, 1e-5), coulomb_friction=(0.01, 0.01))
    space = decided(arm, 100)
    assert (space.outcome, space.encoder) == ("passive", "counted")
    alone = chain(tuple(np.diag(arm.damping)), resolution=(1e-5, 1e-5), coulomb_friction=(0.01, 0.01))
    other = decided(alone, 100)
    assert space.largest_forces == other.largest_forces


def test_three_legs_with_couplings():
    region = {"lower": (0.0, 0.0, 0.119), "upper": (0.0004, 0.0004, 0.121)}
    arm = built_in("falcon", damping=random_damping(3, 3, 0.004), resolution=0, **region)
    assert isinstance(arm, LeggedArm)
    limit = decided(arm, 100).largest_stiffness
    outcomes = [decided(arm, times * limit).outcome for times in (0.995, 1.005)]
    assert outcomes == ["passive", "active"]


def test_a_joint_beside_the_way_to_the_hand(tmp_path):
    """Damped together with one that moves the hand it goes along, and less is lost: no certificate."""
    path = random_arm(tmp_path / "arm.urdf", 4, 3)
    b = random_damping(9, 3, 0.3)
    apart = b.copy()
    apart[:2, 2] = apart[2, :2] = 0.0
    arms = (read_arm(path, frame="l2", hold={"j2": 0.0}, damping=d) for d in (apart, b))
    spaces = [decided(arm, 5, 8) for arm in arms]
    assert [space.outcome for space in spaces] == ["passive", "theorem"]
    assert "damped together with joints beside it" in spaces[1].claim
    assert len(spaces[0].certificate.to_dict()["arm"]["damping_N_m_s_rad"]) == 2


def test_the_advice_is_enough():
    """With the damping that is asked for added to the diagonal the region is proved."""
    damping = random_damping(0, 2)
    limit = decided(chain(damping)).largest_stiffness
    space = decided(chain(damping), 1.5 * limit)
    more = damping + np.diag(space.least_additions)
    assert zw.workspace(chain(more), space.wall, rate=1 / PERIOD, points=4).outcome == "passive"
    short = damping + 0.9 * np.diag(space.least_additions)
    assert zw.workspace(chain(short), space.wall, rate=1 / PERIOD, points=4).outcome == "active"


@pytest.mark.parametrize("damping", [random_damping(0, 2), (0.02, 0.01)])
def test_the_verdict_says_the_damping(damping):
    told = decided(chain(damping)).to_dict()["joint_damping_N_m_s_rad"]
    assert np.shape(told) == np.shape(damping)
    assert np.allclose(told, damping, rtol=1e-12)
