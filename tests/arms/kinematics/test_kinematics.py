"""Every arm: its Jacobian is the derivative of its position, the bound inside a cell holds; damping."""

from __future__ import annotations

from math import cos, pi, sin
from typing import Any

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st

import zwidth as zw
from zwidth.model.arms import BUILT_IN, Arm, Leg, LeggedArm, PlanarChain, Sites, built_in
from zwidth.model.arms.arm import joint_damping

THREE_LINKS = PlanarChain(links=(0.12, 0.1, 0.05), damping=(0.01, 0.02, 0.03), joint_range=((-1, 1),) * 3)
ARMS = [*(built_in(name, damping=0.003) for name in BUILT_IN), THREE_LINKS]


def _random_sites(arm: Arm, count: int) -> tuple[Sites, list[tuple[int, ...]]]:
    sites = arm.sites(40)
    rng = np.random.default_rng(7)
    shape = sites.change.shape
    return sites, [tuple(int(rng.integers(n)) for n in shape) for _ in range(count)]


@pytest.mark.parametrize("arm", ARMS, ids=lambda arm: f"{arm.name}-{arm.joint_count}")
def test_the_jacobian_is_the_derivative_of_the_position(arm):
    """Central differences of forward()."""
    sites, places = _random_sites(arm, 5)
    for place in places:
        q = sites.joints[place]
        steps = 1e-6 * np.eye(len(q))
        moved = [(arm.forward(q + step) - arm.forward(q - step)) / 2e-6 for step in steps]
        numeric = np.stack(moved, axis=-1)
        assert arm.jacobian(q) == pytest.approx(numeric, abs=2e-9)
        assert sites.jacobians[place] == pytest.approx(numeric, abs=2e-9)
        assert arm.forward(q) == pytest.approx(sites.positions[place], abs=1e-11)


@pytest.mark.parametrize("arm", ARMS, ids=lambda arm: f"{arm.name}-{arm.joint_count}")
def test_the_jacobian_stays_within_its_bound_inside_a_cell(arm):
    """‖J(q) − J‖ ≤ change, at corners and at random points of the cell."""
    sites, places = _random_sites(arm, 60)
    rng = np.random.default_rng(3)
    checked = 0
    for place in places:
        if not np.isfinite(sites.change[place]):
            continue
        shift = rng.choice([-1.0, 1.0, 0.3], sites.joints.shape[-1])
        if isinstance(arm, LeggedArm):
            half = (np.array(arm.upper) - arm.lower)[:2] / 80
            half = np.append(half, half.max())[: len(arm.lower)]
            there = np.linalg.inv(arm.gradients(sites.positions[place] + shift * half))
        else:
            assert isinstance(arm, PlanarChain)
            half = np.array([high - low for low, high in arm.joint_range]) / (2 * sites.change.shape[0])
            there = arm.jacobian(sites.joints[place] + shift * half)
        assert np.linalg.norm(there - sites.jacobians[place], 2) <= sites.change[place] * (1 + 1e-12)
        checked += 1
    assert checked > 30


def test_a_chain_by_complex_numbers():
    """p = Σ l_k e^{jφ_k}, and column i is j times what lies beyond joint i."""
    q = np.array([0.4, -0.9, 1.3])
    tips = np.cumsum(np.array(THREE_LINKS.links) * np.exp(1j * np.cumsum(q)))
    p = THREE_LINKS.forward(q)
    assert complex(*p) == pytest.approx(tips[-1])
    beyond = 1j * (tips[-1] - np.array([0, tips[0], tips[1]]))
    assert THREE_LINKS.jacobian(q)[0] + 1j * THREE_LINKS.jacobian(q)[1] == pytest.approx(beyond)


def test_the_pantograph_by_intersecting_circles():
    """Two circles of 90 mm about the elbows meet at the hand."""
    arm = built_in("haply-2diy", damping=0.001)
    for p in ([0.01, 0.09], [-0.03, 0.11], [0.045, 0.06]):
        left, right = arm.inverse(p)  # type: ignore[attr-defined]
        elbows = np.array(
            [[-0.019 + 0.07 * cos(left), 0.07 * sin(left)], [0.019 + 0.07 * cos(right), 0.07 * sin(right)]]
        )
        middle, apart = elbows.mean(axis=0), elbows[1] - elbows[0]
        height = np.sqrt(0.09**2 - apart @ apart / 4)
        meet = middle + height * np.array([-apart[1], apart[0]]) / np.linalg.norm(apart)
        assert meet == pytest.approx(p, abs=1e-12)
        assert elbows[0][0] < elbows[1][0]


def test_the_falcon_by_its_published_quadratic():
    """tan(θ/2) solves l₂t² + l₁t + l₀ = 0, as the driver's kinematics write it."""
    a, b, c, d, f, r, s = 0.06, 0.1025, 0.01443, 0.01125, -0.025, 0.04, -0.02309
    arm = built_in("falcon", damping=0.001)
    for x, y, z in ([0.0, 0.0, 0.12], [0.02, -0.01, 0.105], [-0.025, 0.028, 0.135]):
        angles = arm.inverse([x, y, z])  # type: ignore[attr-defined]
        for angle, turn in zip(angles, np.radians([105, -15, -135]), strict=True):
            u, v = x * cos(turn) + y * sin(turn) - r, -x * sin(turn) + y * cos(turn) - s
            rod = 2 * d + b * sin(np.arccos((v + f) / b))
            l0 = z**2 + (u + c - a) ** 2 - rod**2
            l1, l2 = -4 * a * z, z**2 + (u + c + a) ** 2 - rod**2
            half = (-l1 - np.sqrt(l1**2 - 4 * l0 * l2)) / (2 * l2)
            assert angle == pytest.approx(2 * np.arctan(half), abs=1e-12)


def test_out_of_reach_is_nan_and_has_no_bound():
    """A region larger than the reach: the cells outside are not numbers, and never proved."""
    arm = built_in("haply-2diy", damping=0.1, lower=(-0.3, -0.3), upper=(0.3, 0.3))
    sites = arm.sites(30)
    outside = ~np.isfinite(sites.jacobians).all(axis=(-1, -2))
    assert 0.3 < outside.mean() < 1
    assert np.isinf(sites.change[outside]).all()
    far = np.hypot(sites.axes[0].middles[:, None] - 0.019, sites.axes[1].middles[None, :]) > 0.16
    assert outside[far].all()


def two_links(damping: Any) -> PlanarChain:
    return PlanarChain(links=(0.1, 0.1), damping=damping)


@pytest.mark.parametrize(
    ("make", "words"),
    [
        (lambda: PlanarChain(links=(0.1, 0), damping=(1, 1)), "links"),
        (lambda: PlanarChain(links=(0.1, 0.1), damping=(1,)), "one for each"),
        (lambda: PlanarChain(links=(0.1,), damping=(-1,)), "≥ 0"),
        (lambda: PlanarChain(links=(0.1,), damping=(1,), joint_range=((1, 1),)), "low < high"),
        (lambda: PlanarChain(links=(0.1,), damping=(1,), torque_limit=(0,)), "torque_limit"),
        (lambda: Leg(base=(0, 0), out=(1, 0), up=(1, 0), link=1, rod=1), "right angles"),
        (lambda: Leg(base=(0, 0), out=(1, 0), up=(0, 1), link=-1, rod=1), "lengths"),
        (lambda: built_in("phantom", damping=1), "built in are"),
        (lambda: built_in("haply-2diy", damping=1, lower=(0, 0), upper=(0, 1)), "corners"),
        (lambda: built_in("two-link", damping=1).forward([1.0]), "2 joints"),
        (lambda: two_links([[0.01, 0.002], [0.003, 0.01]]), r"symmetric: .* only \(δ \+ δᵀ\)/2"),
        (lambda: two_links([[0.01, 0.002], [0.002 * (1 + 1e-9), 0.01]]), "symmetric"),
        (lambda: two_links([[0.04, 0.06], [0.06, 0.09 * (1 - 1e-9)]]), "no negative eigenvalue"),
        (lambda: two_links([[0.01, 1e-9], [1e-9, 0.0]]), "no negative eigenvalue"),
        (lambda: two_links([[-0.01, 0], [0, 0.01]]), "≥ 0 on the diagonal"),
        (lambda: two_links([[0.01, np.nan], [np.nan, 0.01]]), "finite"),
        (lambda: two_links([[0.01, np.inf], [np.inf, 0.01]]), "finite"),
        (lambda: two_links(np.eye(3)), r"for 2 joints is 2 × 2, got the shape \(3, 3\)"),
        (lambda: two_links([[0.01, 0.002]]), r"is 2 × 2, got the shape \(1, 2\)"),
        (lambda: two_links(np.ones((2, 2, 2))), "is 2 × 2"),
        (lambda: two_links([[0.01, 0.0], [0.01]]), "one number for each joint, or a square matrix"),
        (lambda: two_links("thick"), 'damping of q1 is in N.m.s/rad.*got "thick"'),
        (lambda: two_links([0.01]), "give one for each joint, 2 in all; got 1"),
        (lambda: two_links([0.01, -0.01]), "≥ 0 in every joint"),
    ],
)
def test_bad_input_has_one_clear_message(make, words):
    with pytest.raises(zw.InputError, match=words):
        make()


def test_a_paddle_turns_on_a_circle():
    """|J| is the radius of the handle everywhere."""
    arm = built_in("hapkit", damping=0.001)
    q = np.linspace(-pi / 4, pi / 4, 7)[:, None]
    assert np.linalg.norm(arm.jacobian(q), axis=(-1, -2)) == pytest.approx(0.065659)


BELT = np.array([[1.0, 0.0], [-0.7, 1.0]])
"""The second motor sits in the base: its belt turns with q₂ − 0.7 q₁."""
TWO = ("q1", "q2"), (False, False)
SHARED = BELT.T @ np.diag([0.013, 0.008]) @ BELT


def test_a_matrix_is_kept_and_shown():
    arm = built_in("two-link", damping=SHARED)
    rows = tuple(map(tuple, SHARED.tolist()))
    assert arm.damping == rows
    assert f"damping={rows}" in repr(arm)
    assert arm.replace(name="other").damping == rows
    assert arm == built_in("two-link", damping=rows)


def test_a_diagonal_matrix_is_one_number_for_each_joint():
    told = (np.diag([0.02, 0.01]), ((0.02, 0), (0, 0.01)), (0.02, 0.01), [0.02, 0.01])
    assert {joint_damping(damping, *TWO) for damping in told} == {(0.02, 0.01)}
    assert joint_damping([[0.3]], ["q1"], [False]) == joint_damping(0.3, ["q1"], [False]) == (0.3,)


@given(st.integers(0, 2**32 - 1), st.integers(2, 7), st.integers(-6, 6))
def test_shafts_with_friction_give_no_matrix_that_is_refused(seed, joints, power):
    """Aᵀ diag(b) A, singular too, and joints in units that are as far apart as one likes."""
    rng = np.random.default_rng(seed)
    shafts = int(rng.integers(1, joints + 1))
    scale = 10.0 ** (power * rng.random(joints))
    turned = rng.normal(size=(shafts, joints)) * scale
    damping = turned.T @ np.diag(rng.uniform(0.01, 1, shafts)) @ turned
    kept = np.array(joint_damping(damping, ["q"] * joints, [False] * joints))
    assert np.array_equal(kept, kept.T)
    assert np.allclose(kept, damping, rtol=1e-12, atol=0)


def test_at_the_bound_it_is_taken():
    """A matrix of which one motion costs nothing: the other side of what is refused."""
    assert joint_damping([[0.04, 0.06], [0.06, 0.09]], *TWO) == ((0.04, 0.06), (0.06, 0.09))
    assert joint_damping([[0.04, 0.06], [0.06, 0.09 * (1 + 1e-9)]], *TWO)
