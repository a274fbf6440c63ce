"""Coulomb friction in the joints against the steps of their encoders, the Jacobian read at the steps, too."""

from __future__ import annotations

from typing import Any

import numpy as np
import numpy.typing as npt
import pytest
from described_arms import random_arm

import zwidth as zw
from zwidth.model.arms import PlanarChain, read_arm
from zwidth.model.arms.encoders import columns_in_cells, encoder_steps, friction_for, size_bound
from zwidth.model.arms.replay import replay_cycle
from zwidth.passivity.certificate import verify_document
from zwidth.passivity.scope import TOLD

Array = npt.NDArray[np.float64]

PERIOD, STIFF = 1e-3, zw.Wall(500)
Q2 = (float(np.deg2rad(140)), float(np.deg2rad(150)))
EXAMPLE: dict[str, Any] = {
    "links": (0.1, 0.1),
    "damping": (0.05, 0.05),
    "resolution": (2 * np.pi / 1000, 2 * np.pi / 50_000),
    "joint_range": ((0.0, 1.0), Q2),
}
"""Its friction pays for the steps of the reading alone, but not for those of the Jacobian at every force."""
FRICTION = (0.01593592, 0.0231231)


def decided(arm: Any, wall: Any = STIFF, points: int = 50, **asked: float | None) -> Any:
    """At 1 kHz."""
    return zw.workspace(arm, wall, rate=1 / PERIOD, points=points, **asked)


def placed(links: tuple[float, ...], q: Array) -> tuple[Array, Array]:
    """p (…, 2) and J (…, 2, m) of a planar chain."""
    bearing = np.cumsum(q, axis=-1)
    ends = np.stack([np.cos(bearing), np.sin(bearing)], axis=-1) * np.array(links)[:, None]
    beyond = np.cumsum(ends[..., ::-1, :], axis=-2)[..., ::-1, :]
    return ends.sum(axis=-2), np.stack([-beyond[..., 1], beyond[..., 0]], axis=-2)


def put_in(arm: PlanarChain, k: Array, b: Array, q: Array, rest: Array) -> tuple[Array, Array]:
    """What the hand puts in on closed paths (…, N, m), the torque held at the readings; the largest force."""
    steps = np.array(arm.resolution)
    p, j = placed(tuple(arm.links), np.floor(q / steps) * steps)
    force = (p - rest[..., None, :]) @ k + (p - np.roll(p, 1, axis=-2)) @ b / PERIOD
    turned = np.roll(q, -1, axis=-2) - q
    work = np.einsum("...kn,...knj,...kj->...", force, j, turned)
    viscous = (turned**2 * np.array(arm.damping)).sum(axis=(-1, -2)) / PERIOD
    rubbed = (np.abs(turned) @ np.array(arm.coulomb_friction)).sum(axis=-1)
    return work + viscous + rubbed, np.linalg.norm(force, axis=-1).max(axis=-1)


def rectangle(steps: Array, joint: int, length: float) -> Array:
    """One joint goes by a length, the others cross their edges, it comes back, they cross again (4, m)."""
    sides = np.where(np.arange(len(steps)) == joint, 0.0, 1e-4 * steps)
    corners = np.array([[1.0, 1e-3], [1.0, -1.0], [-1.0, -1.0], [-1.0, 1e-3]])
    along = np.where(np.arange(len(steps)) == joint, 1.0, 0.0)
    return np.asarray(corners[:, :1] * sides + corners[:, 1:] * along * length)


def attacks(rng: np.random.Generator, arm: PlanarChain, count: int) -> list[Array]:
    """Closed paths in the region, next to edges of the encoders (count, N, m): rectangles small or long, to
    and fro across corners, walks at random; every size is in steps of the encoders or of the region."""
    low, high = np.array(arm.joint_range).T
    steps, m = np.array(arm.resolution), len(arm.links)
    edges = np.round(rng.uniform(low + 2 * steps, high - 2 * steps, (count, 1, m)) / steps) * steps
    found = []
    for joint in range(m):
        signs = rng.choice([-1.0, 1.0], (count, 1, m))
        small = rectangle(steps, joint, 0.3 * steps[joint])
        size = 10 ** rng.uniform(-2, 0, (count, 1, 1))
        found.append(edges + signs * size * small)
        here = edges[:, 0, joint]
        far = np.minimum(here - low[joint], high[joint] - here) * rng.uniform(0.1, 0.9)
        there = far[:, None, None] * np.linspace(0, 1, 60)[:, None] * np.eye(m)[joint]
        around = np.where(np.arange(m) == joint, 0.0, 1e-4 * steps) * np.ones((60, 1))
        found.append(edges + signs * np.concatenate([there + around, there[:, ::-1] - around], axis=1))
    side = np.where(np.arange(6) % 2, 1.0, -1.0)[None, :, None]
    ways = rng.choice([-1.0, 0.0, 1.0], (count, 1, m)) * 10 ** rng.uniform(-3, 0, (count, 1, m))
    found.append(edges + side * ways * steps / 2)
    found.append(edges + rng.uniform(-2, 2, (count, 8, m)) * steps)
    return found


def rests(rng: np.random.Generator, arm: PlanarChain, k: Array, b: Array, q: Array, force: float) -> Array:
    """Where the wall rests so that the largest force of each path is nearly `force`, in any direction."""
    ways = rng.normal(size=(len(q), 2)) @ k
    ways /= np.linalg.norm(ways, axis=-1, keepdims=True)
    middle = placed(tuple(arm.links), q.mean(axis=-2))[0]
    pull = np.full(len(q), force)
    for _ in range(3):
        rest = middle - (pull[:, None] * ways) @ np.linalg.pinv(k)
        pull = np.maximum(pull - 1.0001 * np.maximum(put_in(arm, k, b, q, rest)[1] - force, 0), 0)
    return np.asarray(middle - (pull[:, None] * ways) @ np.linalg.pinv(k))


def random_chain(rng: np.random.Generator) -> tuple[PlanarChain, zw.arms.MatrixWall, float]:
    """A chain of one or two joints that bears a random wall with a fifth to spare, a force, and friction."""
    m = int(rng.integers(1, 3))
    low = rng.uniform(-2, 2, m)
    numbers: dict[str, Any] = {
        "links": tuple(rng.uniform(0.03, 0.3, m)),
        "resolution": tuple(2 * np.pi / 10 ** rng.uniform(2.2, 4, m)),
        "joint_range": tuple(zip(low, low + rng.uniform(0.2, 0.6, m), strict=True)),
    }
    turn = np.linalg.qr(rng.normal(size=(2, 2)))[0]
    k = turn @ np.diag(10 ** rng.uniform(1.5, 3, 2)) @ turn.T
    wall = zw.arms.MatrixWall(k, rng.choice([0.0, 2e-4]) * k)
    force = float(10 ** rng.uniform(0, 2.5))
    bare = PlanarChain(damping=(1.0,) * m, **numbers)
    jacobians = bare.sites(20).jacobians
    load = np.swapaxes(jacobians, -1, -2) @ (k * PERIOD / 2 + np.array(wall.damping)) @ jacobians
    need = 1.2 * np.linalg.eigvalsh(load).max() + 1.01 * bare.curvature * force * PERIOD / 2
    steps = encoder_steps(bare, wall, PERIOD, bare.sites(40))
    enough = tuple(1.00001 * np.array(steps.friction_up_to(force)))
    return bare.replace(damping=tuple(rng.uniform(1, 2, m) * need), coulomb_friction=enough), wall, force


def test_no_attack_gains_where_steps_are_counted():
    """Random chains, walls and counts, the torque of the readings held or following them: up to the force
    that is covered nothing is taken out; with a third of the friction something is."""
    rng, gained, fixed = np.random.default_rng(11), 0, 0
    for _ in range(8):
        arm, wall, force = random_chain(rng)
        space = decided(arm, wall, 10, torque_held_up_to=force)
        assert (space.outcome, space.encoder) == ("passive", "counted"), space.claim
        assert space.largest_forces == (force,)
        k, b = np.array(wall.stiffness), np.array(wall.damping)
        weak = arm.replace(coulomb_friction=tuple(np.array(arm.coulomb_friction) / 3))
        steps = space.encoder_steps
        # What pays twice for the misread position alone, and four times the force at which that is enough.
        alone = arm.replace(coulomb_friction=tuple(2 * np.array(steps.friction)))
        hard = 4 * float((np.array(steps.friction) / steps.friction_per_force).max())
        for q in attacks(rng, arm, 40):
            rest = rests(rng, arm, k, b, q, force)
            energy, largest = put_in(arm, k, b, q, rest)
            kept = largest <= force
            assert (energy[kept] >= -1e-15).all(), (arm, wall, force)
            gained += int((put_in(weak, k, b, q, rest)[0][kept] < 0).sum())
            fixed += int((put_in(alone, k, b, q, rests(rng, arm, k, b, q, hard))[0] < 0).sum())
            found = replay_cycle(arm, wall, PERIOD, 0, q[0], counted=True, rest=rest[0])
            assert found.largest_force > force or found.energy >= -1e-15, (arm, wall, force)
    assert gained > 20
    assert fixed > 20


@pytest.mark.parametrize("held", [True, False])
def test_both_sides_on_one_joint(held):
    """There what is enough is needed: 1 part in 200 above the force that is covered a motion is found."""
    numbers = {"damping": 0.02, "coulomb_friction": 0.005, "resolution": 1e-3}
    arm = PlanarChain(links=(0.08,), joint_range=((-0.5, 0.7),), **{k: (v,) for k, v in numbers.items()})
    wall = zw.Wall(900)
    space = zw.workspace(arm, wall, rate=1 / PERIOD, torque_held_up_to=1.0 if held else None)
    steps = space.encoder_steps
    assert space.encoder == "counted"
    assert steps.friction[0] == pytest.approx(0.08**2 * 900 * 1e-3 / 2, rel=1e-3)
    assert steps.covered[0] == pytest.approx((0.005 - steps.friction[0]) / (0.08e-3 / 2), rel=1e-3)
    if held:
        assert steps.covered[0] < steps.refuted < 1.005 * steps.covered[0]
    else:  # one joint that follows its readings: the force does not matter, but in the proof it does
        assert steps.refuted is None


def test_a_slow_rectangle_across_one_edge():
    """The torque of the second joint changes at an edge of the first, more the harder the wall pushes."""
    arm, wall = PlanarChain(coulomb_friction=FRICTION, **EXAMPLE), zw.Wall(500)
    edge, count = 80 * EXAMPLE["resolution"][0], 4000
    way = np.linspace(Q2[0] + 1e-3, Q2[1] - 1e-3, count)
    path = np.empty((2 * count, 2))
    path[:, 1] = np.concatenate([way, way[::-1]])
    path[:, 0] = edge + np.repeat([1e-6, -1e-6], count)

    def energy(distance: float, held: bool) -> float:
        turned = 2 * np.pi / 24 * np.arange(24)
        hand = arm.forward(path.mean(axis=0))
        places = hand + distance * np.stack([np.cos(turned), np.sin(turned)], axis=-1)
        return min(
            replay_cycle(arm, wall, PERIOD, 0, path, held, counted=True, rest=rest).energy for rest in places
        )

    assert energy(0.2, True) < -1e-3
    assert energy(0.5, True) < -1e-2
    assert energy(0.06, True) > 0
    space = decided(arm)
    assert (space.outcome, space.encoder, space.torque) == ("passive", "counted", "follows")
    assert space.largest_forces == pytest.approx((35.19,), rel=1e-3)
    assert "for wall forces up to 35.19 N, proved. Encoder steps are counted" in space.claim
    steps = space.encoder_steps
    assert steps.motion is not None
    assert steps.refuted == pytest.approx(61.57, rel=1e-2)
    assert f"From {steps.refuted:.4g} N on a motion across their edges takes energy out" in space.claim


@pytest.mark.parametrize(
    ("asked", "force", "outcome"),
    [
        ("largest_force", 35.0, "passive"),
        ("largest_force", 36.0, "undecided"),
        ("largest_force", 61.0, "undecided"),
        ("largest_force", 62.0, "active"),
        ("torque_held_up_to", 35.0, "passive"),
        ("torque_held_up_to", 50.0, "active"),
    ],
)
def test_up_to_a_force_that_is_asked_for(asked, force, outcome):
    """35.19 N are covered; 61.57 N are refuted where the torque follows the readings."""
    arm = PlanarChain(coulomb_friction=FRICTION, **EXAMPLE)
    space = decided(arm, **{asked: force})
    assert (space.outcome, space.encoder, space.largest_forces) == (outcome, "counted", (force,))
    assert space.torque == ("held" if asked == "torque_held_up_to" else "follows")
    if outcome == "active":
        motion, held = space.motion, asked == "torque_held_up_to"
        assert motion.largest_force <= force
        again = replay_cycle(arm, STIFF, PERIOD, 0, motion.joints, held, counted=True, rest=motion.rest)
        assert again.energy == motion.energy < 0
    if outcome == "undecided":
        assert "Coulomb friction covers them up to 35.19 N" in space.claim


def test_without_friction_a_small_force_is_enough():
    assert decided(PlanarChain(**EXAMPLE), largest_force=1).outcome == "active"


def test_friction_that_covers_the_steps_at_no_force():
    """A motion across their edges takes energy out, up to a hundredth below what covers them."""
    bare = decided(PlanarChain(**EXAMPLE))
    for share in (0.0, 0.5, 0.99):
        friction = tuple(share * f for f in bare.encoder_steps.friction)
        arm = PlanarChain(coulomb_friction=friction, **EXAMPLE)
        space = decided(arm)
        assert (space.outcome, space.encoder, space.certificate) == ("active", "counted", None), share
        assert ("Coulomb friction is not given and taken as 0" in space.claim) is (share == 0)
        motion = space.motion
        again = replay_cycle(arm, zw.Wall(500), PERIOD, 0, motion.joints, counted=True, rest=motion.rest)
        assert again.energy == motion.energy < 0


def test_a_proof_without_steps_is_no_proof_of_an_arm_that_has_them():
    """Of parallel arms the steps are not bounded: the outcome, its first words and its status say so."""
    legs = zw.arms.built_in("haply-2diy", damping=0.003, coulomb_friction=0.1)
    space = decided(legs, zw.Wall(100), 20)
    assert (space.outcome, space.encoder) == ("passive without encoder steps", "ideal")
    assert (space.scope.encoder, space.encoder_steps) == ("not counted", None)
    assert space.claim.startswith("Read without steps, no motion of the hand would take energy out")
    assert "of such an arm" in space.claim
    assert TOLD[space.outcome].status == 4
    assert space.certificate.verify()
    without = decided(legs.replace(resolution=(0.0, 0.0)), zw.Wall(100), 20)
    assert (without.outcome, without.scope.encoder) == ("passive", "ideal")
    free = decided(zw.arms.built_in("two-link", damping=0.05), zw.Wall(100), 20)
    assert free.outcome == "passive"
    assert "Encoder steps" not in free.claim


def test_an_arm_whose_damping_fails_is_refuted_behind_its_encoders():
    """The motion is one of the readings; that of an ideal encoder does not do where steps are asked for."""
    arm = PlanarChain(**{**EXAMPLE, "damping": (1e-4, 1e-4)}, coulomb_friction=FRICTION)
    space = decided(arm, points=20)
    assert (space.outcome, space.encoder) == ("active", "counted")
    assert space.motion.encoder == "counted"


def test_what_follows_the_readings_is_added_up_exactly():
    """The work of a torque that follows, by pieces between edges, against ten thousand parts of a period."""
    arm = PlanarChain(**{**EXAMPLE, "resolution": (0.013, 0.007)}, coulomb_friction=(0.01, 0.02))
    rng = np.random.default_rng(3)
    q = np.array([0.5, 2.5]) + rng.uniform(-0.05, 0.05, (5, 2))
    rest, steps = np.array([0.3, -0.1]), np.array(arm.resolution)
    found = replay_cycle(arm, zw.Wall(300, 0.1), PERIOD, 1, q, counted=True, rest=rest)
    p, _ = placed((0.1, 0.1), np.floor(q / steps) * steps)
    read = np.roll(p, 1, axis=0)
    force = 300 * (read - rest) + 0.1 * (read - np.roll(read, 1, axis=0)) / PERIOD
    work, parts = 0.0, 10_000
    for k in range(5):
        way = q[(k + 1) % 5] - q[k]
        at = q[k] + ((np.arange(parts) + 0.5) / parts)[:, None] * way
        _, j = placed((0.1, 0.1), np.floor(at / steps) * steps)
        work += float(np.einsum("n,knj,j->", force[k], j, way / parts))
    assert found.work == pytest.approx(work, rel=1e-3)
    assert found.largest_force == pytest.approx(np.linalg.norm(force, axis=1).max())


def test_each_cell_looks_at_its_neighbours():
    """A reading may lie in the next cell: the bound on the columns holds one step around each."""
    arm = PlanarChain(**{**EXAMPLE, "resolution": (0.05, 0.03)}, coulomb_friction=FRICTION)
    sites, rng = arm.sites(40), np.random.default_rng(6)
    halves = np.array([0.5 / 40, (Q2[1] - Q2[0]) / 80])
    off = rng.uniform(-1, 1, (400, 2)) * (halves + np.array(arm.resolution))
    cells = sites.joints.reshape(-1, 2)[rng.integers(0, 1600, 400)]
    bound = columns_in_cells(arm, sites).reshape(-1, 2)
    index = np.abs(sites.joints.reshape(-1, 1, 2) - cells).sum(axis=-1).argmin(axis=0)
    assert (np.linalg.norm(placed((0.1, 0.1), cells + off)[1], axis=-2) <= bound[index] + 1e-12).all()
    data = decided(arm, zw.Wall(50), 40).data
    own, each, _ = friction_for(arm, zw.Wall(50), PERIOD, columns_in_cells(arm, sites))
    expected = np.maximum((np.array(FRICTION) - own) / each, 0).min(axis=-1)
    assert data["covered_force"].values == pytest.approx(expected)
    assert float(data["covered_force"].min()) < float(data["covered_force"].max())


def test_in_pose_each_block_pays_in_its_own_unit():
    """A planar chain in pose: translation and rotation add up, and metres may be millimetres."""
    chain = {"damping": (0.05, 0.05), "resolution": (2e-3, 2e-3), "joint_range": ((0, 1), (0.5, 1.5))}
    asked = []
    for scale in (1.0, 1000.0):
        arm = PlanarChain(links=(0.1 * scale, 0.08 * scale), pose=True, **chain)
        wall = zw.arms.MatrixWall(np.diag([50 / scale**2, 50 / scale**2, 0.4]), np.zeros((3, 3)), turns=1)
        steps = decided(arm, wall, 20).encoder_steps
        assert steps.friction_per_moment == (0.0, 0.0)
        asked += [steps.friction, steps.friction_up_to(3.0 / scale)]
    assert asked[:2] == [pytest.approx(friction, rel=1e-6) for friction in asked[2:]]
    assert min(asked[0]) > 0.4 * 2e-3


@pytest.mark.parametrize("pose", [False, True])
def test_descriptions_are_counted_with_a_certificate(pose, tmp_path):
    random_arm(tmp_path / "arm.urdf", 4, 3)
    numbers: dict[str, Any] = {"resolution": (1e-4,) * 3, "coulomb_friction": (0.05, 0.04, 0.03)}
    hold = {"j0": 0.1}
    arm = read_arm(tmp_path / "arm.urdf", hold=hold, pose=pose, **numbers)
    wall: Any = zw.arms.MatrixWall.in_pose(40, 0.2) if pose else zw.Wall(40)
    space = decided(arm, wall, 10)
    assert (space.outcome, space.encoder) == ("passive", "counted"), space.claim
    assert len(space.largest_forces) == (2 if pose else 1)
    document = space.certificate.documents[0]
    found = verify_document(document)
    assert found.valid
    assert "its encoder steps counted" in found.reason
    assert ("moments up to" in found.reason) == pose
    document["loop"]["largest_force_N"] = str(1.0001 * space.largest_forces[0])
    if pose:
        document["loop"]["largest_moment_N_m"] = str(1.0001 * space.largest_forces[1])
    assert "must be at least" in verify_document(document).reason


def test_sizes_of_matrices():
    """Never below the largest singular value; exact of k·1 and of k n nᵀ."""
    rng = np.random.default_rng(9)
    for _ in range(200):
        matrix = rng.normal(size=tuple(rng.integers(1, 4, 2)))
        assert size_bound(matrix) >= np.linalg.norm(matrix, 2) * (1 - 1e-12)
    n = np.array([0.6, -0.8, 0.3])
    assert size_bound(7 * np.eye(3)) == pytest.approx(7)
    assert size_bound(7 * np.outer(n, n)) == pytest.approx(7 * n @ n)


@pytest.mark.parametrize(
    ("arm", "asked", "words"),
    [
        (zw.arms.built_in("two-link", damping=0.05), {"largest_force": 3}, "resolution of its joints"),
        (PlanarChain(**EXAMPLE), {"largest_force": 3, "torque_held_up_to": 3}, "leave largest_force out"),
        (PlanarChain(**EXAMPLE), {"largest_force": -3}, "largest_force is the largest force"),
    ],
)
def test_a_largest_force_needs_encoders(arm, asked, words):
    with pytest.raises(zw.InputError, match=words):
        decided(arm, **asked)
