"""The least damping in all: feasible, and no more than the programme asks for."""

from __future__ import annotations

import cvxopt
import numpy as np
import numpy.typing as npt
import pytest

import zwidth as zw
from zwidth.model.arms import built_in, least_additions
from zwidth.model.arms.joints import single_additions
from zwidth.passivity.workspace.verdict import Additions

Array = npt.NDArray[np.float64]


def _matrices(seed: int, cells: int, joints: int) -> Array:
    """What damped joints lack before random walls."""
    rng = np.random.default_rng(seed)
    root = rng.normal(size=(cells, joints, joints))
    return np.diag(rng.uniform(0.5, 1.5, joints)) - 0.4 * root @ np.swapaxes(root, -1, -2)


@pytest.mark.parametrize(("cells", "joints"), [(80, 1), (30, 2), (1, 4), (3000, 3), (1, 6), (200, 7)])
def test_it_is_enough_and_the_least(cells, joints):
    """Every matrix is ⪰ 0 with it, and its sum is the lower bound to 1e-6; less of it fails."""
    for seed in range(3):
        matrices = _matrices(seed, cells, joints)
        added, bound = least_additions(1e-3 * matrices)
        assert (added >= 0).all()
        assert np.linalg.eigvalsh(1e-3 * matrices + np.diag(added)).min() >= 0
        assert bound <= added.sum() <= bound * (1 + 1e-6)
        assert bound > 0
        assert np.linalg.eigvalsh(1e-3 * matrices + np.diag(0.999 * added)).min() < 0


def test_of_an_arm_with_many_joints_the_bounds_decide():
    """Each bracket goes from what the points ask for to what the cells do, and nothing is proved."""
    points = _matrices(4, 20, 6)
    cells = points - 0.01 * np.eye(6)
    space = zw.workspace(built_in("two-link", damping=0.1), zw.Wall(1), rate=1000, points=2)
    added = Additions(question=space.added.question, points=points, cells=cells)
    for found, ask in ((added.least, least_additions), (added.to_all, _in_each)):
        assert found.enough == pytest.approx(ask(cells)[0])
        assert found.fails == pytest.approx(ask(points)[0])


def _in_each(matrices: Array) -> tuple[Array]:
    return (np.full(matrices.shape[-1], -np.linalg.eigvalsh(matrices).min()),)


def test_it_is_that_of_a_semidefinite_solver():
    """cvxopt on the same programme."""
    cvxopt.solvers.options["show_progress"] = False
    for seed, joints in ((1, 2), (2, 3), (3, 6)):
        matrices = _matrices(seed, 8, joints)
        columns = cvxopt.matrix(-np.stack([np.outer(e, e).ravel() for e in np.eye(joints)], axis=-1))
        solved = cvxopt.solvers.sdp(
            cvxopt.matrix(1.0, (joints, 1)),
            Gl=cvxopt.matrix(-np.eye(joints)),
            hl=cvxopt.matrix(0.0, (joints, 1)),
            Gs=[columns] * len(matrices),
            hs=[cvxopt.matrix(m) for m in matrices],
        )
        assert least_additions(matrices)[0].sum() == pytest.approx(solved["primal objective"], rel=1e-5)


def test_nothing_is_added_where_nothing_lacks():
    """Zero, and zero as the bound; what lacks by rounding alone gets no more than rounding."""
    good = np.eye(3)[None] + np.zeros((5, 3, 3))
    assert (least_additions(good)[0] == 0).all()
    added, _ = least_additions(np.diag([1.0, 0.5, -1e-17])[None])
    assert added.max() < 1e-13


def test_one_matrix_of_one_joint_and_one_joint_that_is_enough():
    """−M of a number; and never more than one joint alone, or all alike."""
    assert least_additions(np.array([[[-0.3]], [[-0.7]]]))[0] == pytest.approx([0.7])
    for seed in range(20):
        matrices = _matrices(seed, 5, 3)
        added = least_additions(matrices)[0].sum()
        alone = single_additions(matrices).max(axis=0).min()
        alike = -3 * np.linalg.eigvalsh(matrices).min()
        assert added <= min(alone, alike) * (1 + 1e-6)


@pytest.mark.parametrize("name", ["two-link", "haply-2diy", "falcon"])
def test_the_least_damping_proves_the_region(name):
    """With it the region is proved; a little less is refuted, and so is the same sum shared out alike."""
    arm = built_in(name, damping=(0.004, 0.002, 0.003)[: 3 if name == "falcon" else 2], resolution=0)
    space = zw.workspace(arm, zw.Wall(900), rate=1000, points=20)
    added, before = np.array(space.least_additions), np.array(arm.damping)
    enough, fails = space.added.least
    assert sum(fails) < sum(enough) < 1.1 * sum(fails)

    def outcome(more: Array) -> str:
        return zw.workspace(
            arm.replace(damping=tuple(before + more)), space.wall, rate=1000, points=20
        ).outcome

    assert outcome(added) == "passive"
    assert outcome(0.995 * np.array(fails)) == "active"
    if name != "haply-2diy":  # its motors stand alike, and so does the least
        assert outcome(np.full(len(added), added.sum() / len(added))) == "active"
