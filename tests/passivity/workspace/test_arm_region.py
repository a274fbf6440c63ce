"""The map of a workspace: its verdict on both sides of the limit, its advice, its motion."""

from __future__ import annotations

import json
import re
from typing import Any

import numpy as np
import pytest
from arm_documents import least_left

import zwidth as zw
from zwidth.model.arms import BUILT_IN, PlanarChain, built_in, joint_margin, wall_need
from zwidth.passivity.workspace import Workspace

TWO_LINK = built_in("two-link", damping=(0.02, 0.012))
DAMPING = {"hapkit": 0.001, "two-link": (0.02, 0.012), "haply-2diy": (0.003, 0.002), "falcon": 0.003}


def _space(name: str, stiffness: float, **options: Any) -> Workspace:
    arm = built_in(name, damping=DAMPING[name], resolution=0)
    return zw.workspace(arm, zw.Wall(stiffness), rate=1000, points=30, **options)


@pytest.mark.parametrize("name", BUILT_IN)
def test_both_sides_of_the_largest_stiffness(name: str) -> None:
    limit = _space(name, 100).largest_stiffness
    over = _space(name, 1.01 * limit)
    assert over.outcome == "active"
    assert over.motion.energy < 0
    assert over.certificate is None
    under = _space(name, 0.99 * limit)
    assert under.outcome == "passive"
    assert (under.data["margin"] >= 0).all()
    assert under.data["proved"].all()
    assert (under.addition_to_all, set(under.additions)) == (0, {0.0})
    assert under.motion is None
    assert under.certificate.verify()


def test_a_map_shows_in_a_line() -> None:
    space = _space("hapkit", 100)
    assert repr(space).startswith("<Workspace passive: No motion of the hand takes energy out with q1")
    assert "proved: a wall of up to 463.9 N/m holds at every point of the map. The arm" in repr(space)
    active = _space("hapkit", 2 * space.largest_stiffness)
    said = (
        r"of this map a motion of the hand takes .*J out in 2 ms, .*: lower the stiffness from 927.8 N/m to 4"
    )
    assert re.search(said, active.claim)
    assert active.claim in repr(active)
    assert json.loads(active.to_json())["claim"] == active.claim
    to = active.advice[0].to
    assert _space("hapkit", to).outcome == "passive"


@pytest.mark.parametrize("name", [name for name in BUILT_IN if name != "haply-2diy"])  # a minute; see below
def test_the_advice_is_enough_and_little_more_than_fails(name: str) -> None:
    space = _space(name, 2 * _space(name, 100).largest_stiffness)
    b = np.array(space.arm.damping)
    everywhere, alone = space.added.to_all, space.added.alone
    assert 0 < everywhere.fails[0] < everywhere.enough[0] < 1.1 * everywhere.fails[0]
    cases = [(everywhere.enough, True), (0.995 * np.array(everywhere.fails), False)]
    cases += [(one.enough, True) for one in alone if np.isfinite(one.enough).all()][:1]
    for more, good in cases:
        arm = built_in(name, damping=tuple(b + more), resolution=0)
        assert (zw.workspace(arm, space.wall, rate=1000, points=30).outcome == "passive") is good


def test_one_joint_can_be_enough() -> None:
    arm = built_in("haply-2diy", damping=(0.0015, 0.008), resolution=0)
    space = zw.workspace(arm, zw.Wall(400), rate=1000, points=30)
    assert np.isfinite(space.additions[0])
    assert set(np.unique(space.data["joint_to_damp"])) <= {0.0, 1.0}
    better = arm.replace(damping=(0.0015 + space.additions[0], 0.008))
    assert zw.workspace(better, zw.Wall(400), rate=1000, points=30).outcome == "passive"


@pytest.mark.parametrize("name", ["two-link", "haply-2diy", "falcon"])
def test_proved_cells_hold_at_random_points_inside(name: str) -> None:
    lowest = _space(name, 100).data["largest_stiffness"].quantile([0.0, 1.0]).values
    space = _space(name, 0.5 * float(lowest.sum()))
    proved = np.argwhere(space.data["proved"].values)
    assert 0 < len(proved) < space.data["proved"].size
    arm, rng = space.arm, np.random.default_rng(9)
    n = arm.forward(arm.sites(2).joints[0, 0]).shape[-1]
    (need,) = wall_need(space.wall, 0.001, 0, n).matrices
    axes = [space.data[name].values for name in space.data["margin"].dims]
    for place in proved[rng.integers(len(proved), size=200)]:
        half = [axis[1] - axis[0] for axis in axes]
        point = [axis[k] + rng.uniform(-0.5, 0.5) * h for axis, k, h in zip(axes, place, half, strict=True)]
        if isinstance(arm, PlanarChain):
            jacobian = arm.jacobian(point)
        else:
            height = [0.12] if n == 3 else []
            jacobian = np.linalg.inv(arm.gradients([*point, *height]))
        assert joint_margin(jacobian, arm.damping, need)[0] >= 0


def test_the_margin_is_that_at_the_hand() -> None:
    """The smallest eigenvalue of J⁻ᵀδ_mJ⁻¹ − KT/2, and its eigenvector."""
    space = _space("two-link", 700)
    for place in ((3, 4), (20, 11), (29, 29)):
        q = [float(space.data[f"q{i + 1}"][k]) for i, k in enumerate(place)]
        inverse = np.linalg.inv(space.arm.jacobian(q))
        values, vectors = np.linalg.eigh(inverse.T @ np.diag(space.arm.damping) @ inverse - 0.35 * np.eye(2))
        cell = {f"q{i + 1}": k for i, k in enumerate(place)}
        assert float(space.data["margin"][cell]) == pytest.approx(values[0])
        mapped = [float(space.data[f"direction_{axis}"][cell]) for axis in "xy"]
        assert abs(mapped @ vectors[:, 0]) == pytest.approx(1)
        assert float(space.data["largest_stiffness"][cell]) == pytest.approx(2000 * (values[0] + 0.35))


@pytest.mark.parametrize("delay", [0, 2])
@pytest.mark.parametrize("damped", [False, True])
def test_no_closed_path_in_a_proved_region_takes_energy_out(delay: int, damped: bool) -> None:
    rng = np.random.default_rng(delay + 10 * damped)
    root = rng.normal(size=(2, 2))
    virtual = rng.normal(size=(2, 2)) * 0.02
    k, b = root @ root.T, damped * (virtual + virtual.T)
    asked: Any = {"rate": 1000, "delay": delay / 1000, "points": 20}
    k *= (
        0.95
        * zw.workspace(TWO_LINK, zw.arms.MatrixWall(k, b), **asked).largest_stiffness
        / np.linalg.norm(k, 2)
    )
    wall = zw.arms.MatrixWall(k, b)
    assert zw.workspace(TWO_LINK, wall, **asked).outcome == "passive"
    assert least_left(TWO_LINK, wall, delay, rng, 400, 20) < 0.6


def test_a_wall_without_stiffness() -> None:
    """A damper alone: any stiffness would do where it needs nothing, and none where it asks too much."""
    free = zw.workspace(TWO_LINK, zw.Wall(0), rate=1000, points=20)
    assert (free.outcome, free.largest_stiffness) == ("passive", np.inf)
    damped = zw.workspace(TWO_LINK, zw.Wall(0, 3), rate=1000, points=20)
    assert (damped.outcome, damped.largest_stiffness) == ("active", 0)


def test_the_reported_energy_is_that_of_the_reported_motion() -> None:
    arm = built_in("haply-2diy", damping=(0.003, 0.002))
    for wall, delay in ((zw.Wall(900), 0), (zw.Wall(900, 0.1), 0), (zw.Wall(500), 2), (zw.Wall(300, 0.3), 1)):
        motion = zw.workspace(arm, wall, rate=1000, points=20, delay=delay / 1000).motion
        k, b, p, q = float(wall.stiffness), float(wall.damping), motion.positions, motion.joints
        assert arm.inverse(p) == pytest.approx(q, abs=1e-9)
        total = 0.0
        for i in range(len(p)):
            read, before = p[i - delay], p[i - delay - 1]
            moved, turned = p[(i + 1) % len(p)] - p[i], q[(i + 1) % len(p)] - q[i]
            force = k * (read - p[0]) + b * (read - before) / 0.001
            total += force @ moved + np.array([0.003, 0.002]) @ turned**2 / 0.001
        assert total == pytest.approx(motion.energy, rel=1e-6)
        assert total < 0


def test_a_wall_with_one_normal_asks_for_less() -> None:
    arm = built_in("haply-2diy", damping=0.003)
    every = zw.workspace(arm, zw.Wall(500), rate=1000, points=12)
    one = zw.workspace(arm, zw.arms.MatrixWall([[500, 0], [0, 0]]), rate=1000, points=12)
    assert one.largest_stiffness > 1.02 * every.largest_stiffness
    over = zw.arms.MatrixWall([[1.01 * one.largest_stiffness, 0], [0, 0]])
    assert zw.workspace(arm, over, rate=1000, points=12).outcome == "active"


@pytest.mark.parametrize("delay", [0, 1, 2])
def test_virtual_damping_and_delay(delay: int) -> None:
    free = zw.workspace(TWO_LINK, zw.Wall(100), rate=1000, points=20, delay=delay / 1000).largest_stiffness
    with_b = zw.workspace(TWO_LINK, zw.Wall(100, 0.05), rate=1000, points=20, delay=delay / 1000)
    assert free - with_b.largest_stiffness == pytest.approx(2 * 0.05 / 0.001 / (2 * delay + 1))
    assert (
        zw.workspace(TWO_LINK, zw.Wall(10, 2), rate=1000, points=20, delay=delay / 1000).outcome == "active"
    )


def test_coulomb_friction_hides_small_motions_only() -> None:
    arm = built_in("two-link", damping=0.006, coulomb_friction=0.004)
    space = zw.workspace(arm, zw.Wall(900), rate=1000, points=20)
    assert space.outcome == "active"
    assert np.ptp(space.motion.joints, axis=0).max() > 0.001
    heavy = zw.workspace(arm.replace(coulomb_friction=(5, 5)), zw.Wall(900), rate=1000, points=20)
    assert heavy.outcome == "undecided"


class _Raised(PlanarChain):
    """A chain in the plane whose hand is told with a third coordinate, as descriptions do."""

    def forward(self, joints: Any) -> Any:
        flat = super().forward(joints)
        return np.concatenate([flat, 0.3 + 0 * flat[..., :1]], axis=-1) @ TILT.T

    def jacobian(self, joints: Any) -> Any:
        flat = super().jacobian(joints)
        return TILT @ np.concatenate([flat, 0 * flat[..., :1, :]], axis=-2)

    def sites(self, points: int) -> Any:
        found = super().sites(points)
        return found._replace(positions=self.forward(found.joints), jacobians=self.jacobian(found.joints))


class _Still(_Raised):
    """The hand on the axis of the only joint."""

    def jacobian(self, joints: Any) -> Any:
        return 0 * super().jacobian(joints)


def test_a_hand_that_nothing_moves_has_no_limit() -> None:
    arm = _Still(links=(0.1,), damping=(0.05,), joint_range=((0, 1),))
    still = zw.workspace(arm, zw.Wall(500), rate="1 kHz", delay="2 ms", points=10)
    assert (still.outcome, still.largest_stiffness, still.delay_samples) == ("theorem", np.inf, 2)
    assert (still.data["margin"] == np.inf).all()


TILT = np.linalg.qr(np.array([[1.0, 0.3, 0.2], [0.1, 2.0, -0.4], [-0.5, 0.3, 1.4]]))[0]


def test_an_arm_that_cannot_leave_its_plane_has_the_margins_in_it() -> None:
    """Three joints and three coordinates, and J of rank two: the margin is 1/λ(J δ_m⁻¹ Jᵀ) less KT/2."""
    b = (0.05, 0.03, 0.02)
    arm = _Raised(links=(0.1, 0.08, 0.05), damping=b, joint_range=((0.3, 0.9),) * 3)
    space = zw.workspace(arm, zw.Wall(100), rate=1000, points=12)
    j = arm.sites(12).jacobians
    felt = 1 / np.linalg.eigvalsh(j / np.array(b) @ np.swapaxes(j, -1, -2))[..., -1]
    assert space.data["margin"].values == pytest.approx(felt - 100 * 0.001 / 2, rel=1e-5)
    assert space.data["largest_stiffness"].values == pytest.approx(felt * 2 / 0.001, rel=1e-5)
    across = zw.workspace(arm, zw.arms.MatrixWall(900 * np.outer(*2 * [TILT[:, 2]])), rate=1000, points=12)
    assert across.largest_stiffness > 1e12
    assert across.outcome != "undecided"


def test_an_undamped_joint_is_refuted_and_told_what_it_lacks() -> None:
    arm = PlanarChain(links=(0.1, 0.1), damping=(0.02, 0.0), joint_range=((0, 1), (1, 2)))
    space = zw.workspace(arm, zw.Wall(500), rate=1000, points=30)
    assert (space.outcome, space.largest_stiffness) == ("active", 0)
    assert space.additions[0] == np.inf
    better = arm.replace(damping=(0.02, space.additions[1]))
    assert zw.workspace(better, zw.Wall(500), rate=1000, points=30).outcome in ("passive", "theorem")


def test_a_held_torque_asks_for_more() -> None:
    """c = h F T/2 of every joint; with that much more damping the margin is what it was."""
    free = zw.workspace(TWO_LINK, zw.Wall(300), rate=1000, points=20)
    held = zw.workspace(TWO_LINK, zw.Wall(300), rate=1000, points=20, torque_held_up_to=8)
    price = np.linalg.eigvalsh([[0.2, 0.1], [0.1, 0.1]])[-1] * 8 * 0.001 / 2
    assert held.largest_stiffness < free.largest_stiffness
    more = TWO_LINK.replace(damping=(0.02 + price, 0.012 + price))
    repaid = zw.workspace(more, zw.Wall(300), rate=1000, points=20, torque_held_up_to=8)
    assert repaid.largest_stiffness == pytest.approx(free.largest_stiffness)
    assert "held over a period" in held.claim
    assert "follow the arm" in free.claim


def test_the_map_is_labelled() -> None:
    arm = built_in("haply-2diy", damping=0.004, coulomb_friction=0.002, resolution=0.0013, torque_limit=0.1)
    data = zw.workspace(arm, zw.Wall(300), rate=1000, points=12).data
    assert data["margin"].dims == ("x", "y")
    assert {"resolution", "friction", "force_limit"} <= set(data)
    assert all("units" in data[name].attrs for name in data if name != "proved")
    least = (0.1 / np.linalg.norm(arm.jacobian(arm.sites(12).joints[5, 7]), axis=0)).min()
    assert float(data["force_limit"][5, 7]) == pytest.approx(least)


def test_a_redundant_arm_is_proved_and_refuted_by_hands_on_its_links() -> None:
    arm = PlanarChain(links=(0.1, 0.08, 0.05), damping=(0.05, 0.03, 0.02), joint_range=((0.3, 0.9),) * 3)
    limit = zw.workspace(arm, zw.Wall(100), rate=1000, points=60).largest_stiffness
    assert zw.workspace(arm, zw.Wall(limit / 3), rate=1000, points=60).outcome == "passive"
    over = zw.workspace(arm, zw.Wall(limit * 2), rate=1000, points=60)
    assert (over.outcome, over.can_be_refuted, over.motion.imposed_by) == ("active", False, "links")
    assert "hands that hold the links" in over.claim
    assert "a hand at the end alone" in over.claim
    assert _space("two-link", 1).can_be_refuted


CHAIN = built_in("two-link", damping=0.01)


@pytest.mark.parametrize(
    ("arm", "wall", "options", "words"),
    [
        (CHAIN, zw.Wall(100), {"rate": 0}, "rate"),
        (CHAIN, zw.Wall(100), {"delay": 0.0005}, "whole number of samples"),
        (CHAIN, zw.Wall(100), {"delay": -1}, "delay"),
        (CHAIN, zw.Wall(100), {"delay": 3}, 'got 3 s, 3000 at 1 kHz.*write "3 ms"'),
        (CHAIN, zw.Wall(100), {"points": 1}, "points"),
        *(
            (CHAIN, zw.Wall(100), {"torque_held_up_to": force}, "largest force")
            for force in (-1, "much", (1, 2))
        ),
        (CHAIN, zw.Wall(100), {"torque_held_up_to": 1, "delay": 0.001}, "without delay"),
        ("two-link", zw.Wall(100), {}, "first argument"),
        (
            built_in("haply-2diy", damping=0.01, lower=(1, 1), upper=(2, 2)),
            zw.Wall(100),
            {},
            "reaches no point",
        ),
        (PlanarChain(links=(0.1,) * 3, damping=(0.1, 0, 0.1)), zw.Wall(100), {}, "no damping is left in q2"),
        *((CHAIN, thing, {}, "is a Wall or a MatrixWall") for thing in (3, zw.HuntCrossley(100, 1))),
    ],
)
def test_bad_input_has_one_clear_message(arm: Any, wall: Any, options: dict[str, Any], words: str) -> None:
    with pytest.raises(zw.InputError, match=words):
        zw.workspace(arm, wall, **{"rate": 1000, "points": 20, **options})
