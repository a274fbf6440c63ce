"""The damping of an arm's joints, one number for each or a matrix: what is kept, and what is refused."""

from __future__ import annotations

from typing import Any

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st

from zwidth.errors import InputError
from zwidth.model.arms import PlanarChain, built_in
from zwidth.model.arms.arm import joint_damping

BELT = np.array([[1.0, 0.0], [-0.7, 1.0]])
"""The second motor sits in the base: its belt turns with q₂ − 0.7 q₁."""
SHARED = BELT.T @ np.diag([0.013, 0.008]) @ BELT


def test_a_matrix_is_kept_and_shown():
    """As rows, in what the arm says of itself, and in arms made of it."""
    arm = built_in("two-link", damping=SHARED)
    rows = tuple(map(tuple, SHARED.tolist()))
    assert arm.damping == rows
    assert f"damping={rows}" in repr(arm)
    assert arm.replace(name="other").damping == rows
    assert arm == built_in("two-link", damping=rows)


def test_a_diagonal_matrix_is_one_number_for_each_joint():
    """The same arm, by whatever way it is told."""
    told = (np.diag([0.02, 0.01]), ((0.02, 0), (0, 0.01)), (0.02, 0.01), [0.02, 0.01])
    assert {joint_damping(damping, 2) for damping in told} == {(0.02, 0.01)}
    assert joint_damping([[0.3]], 1) == joint_damping(0.3, 1) == (0.3,)


@given(st.integers(0, 2**32 - 1), st.integers(2, 7), st.integers(-6, 6))
def test_shafts_with_friction_give_no_matrix_that_is_refused(seed: int, joints: int, power: int):
    """Aᵀ diag(b) A, singular too, and joints in units that are as far apart as one likes."""
    rng = np.random.default_rng(seed)
    shafts = int(rng.integers(1, joints + 1))
    scale = 10.0 ** (power * rng.random(joints))
    turned = rng.normal(size=(shafts, joints)) * scale
    damping = turned.T @ np.diag(rng.uniform(0.01, 1, shafts)) @ turned
    kept = np.array(joint_damping(damping, joints))
    assert np.array_equal(kept, kept.T)
    assert np.allclose(kept, damping, rtol=1e-12, atol=0)


@pytest.mark.parametrize(
    ("damping", "words"),
    [
        ([[0.01, 0.002], [0.003, 0.01]], r"symmetric: .* only \(δ \+ δᵀ\)/2"),
        ([[0.01, 0.002], [0.002 * (1 + 1e-9), 0.01]], "symmetric"),
        ([[0.04, 0.06], [0.06, 0.09 * (1 - 1e-9)]], "no negative eigenvalue"),
        ([[0.01, 1e-9], [1e-9, 0.0]], "no negative eigenvalue"),
        ([[-0.01, 0], [0, 0.01]], "≥ 0 on the diagonal"),
        ([[0.01, np.nan], [np.nan, 0.01]], "finite"),
        ([[0.01, np.inf], [np.inf, 0.01]], "finite"),
        (np.eye(3), r"for 2 joints is 2 × 2, got the shape \(3, 3\)"),
        ([[0.01, 0.002]], r"is 2 × 2, got the shape \(1, 2\)"),
        (np.ones((2, 2, 2)), "is 2 × 2"),
        ([[0.01, 0.0], [0.01]], "one number for each joint, or a square matrix"),
        ("thick", "one number for each joint, or a square matrix"),
        ([0.01], "give one for each joint, 2 in all; got 1"),
        ([0.01, -0.01], "≥ 0 in every joint"),
    ],
)
def test_what_cannot_be_friction_is_refused(damping: Any, words: str):
    """In one message that says why."""
    with pytest.raises(InputError, match=words):
        PlanarChain(links=(0.1, 0.1), damping=damping)


def test_at_the_bound_it_is_taken():
    """A matrix of which one motion costs nothing: the other side of what is refused."""
    assert joint_damping([[0.04, 0.06], [0.06, 0.09]], 2) == ((0.04, 0.06), (0.06, 0.09))
    assert joint_damping([[0.04, 0.06], [0.06, 0.09 * (1 + 1e-9)]], 2)
