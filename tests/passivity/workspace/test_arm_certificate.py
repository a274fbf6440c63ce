"""An arm's certificate: what `workspace` says with one and without one, and that it is of the arm."""

from __future__ import annotations

import copy
import json
from fractions import Fraction
from pathlib import Path

import numpy as np
import numpy.typing as npt
import pytest
from checked import matrix_at

import zwidth as zw
from zwidth import checker
from zwidth.checker.arm import cells as arm_cells
from zwidth.model.arms import Arm, PlanarChain, Sites, built_in
from zwidth.passivity.certificate import read_document, verify_document

ARM = built_in("two-link", damping=(0.02, 0.012))


def test_the_saved_verdict_verifies(tmp_path: Path) -> None:
    space = zw.workspace(ARM, zw.Wall("610.1", "0.01"), rate=1500, points=20)
    space.save(tmp_path / "proof.json")
    document = read_document(tmp_path / "proof.json")
    found = verify_document(document)
    assert found.valid
    assert "the torque follows the arm" in found.reason
    assert isinstance(document, dict)
    certificate = document["certificate"]
    assert certificate["wall"]["stiffness_N_per_m"] == [["610.1", "0"], ["0", "610.1"]]
    assert certificate["wall"]["damping_bound_N_s_per_m"] == [["0.01", "0"], ["0", "0.01"]]
    assert certificate["loop"]["sample_period_s"] == "1/1500"
    assert [j["damping_N_m_s_per_rad"] for j in certificate["arm"]["joints"]] == ["0.02", "0.012"]
    changed = copy.deepcopy(document)
    changed["certificate"]["wall"]["stiffness_N_per_m"] = [["1500", "0"], ["0", "1500"]]
    assert not verify_document(changed).valid


def test_a_budget_too_small_leaves_a_theorem(monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setattr(arm_cells, "MOST_WORK", 60)
    space = zw.workspace(ARM, zw.Wall(500), rate=1000, points=20)
    assert (space.outcome, space.certificate) == ("theorem", None)
    assert "There is no certificate: more than 5 cells would be needed." in space.claim


def test_an_arm_that_moves_otherwise_has_no_certificate() -> None:
    """A chain whose links carry the hand by another law than the document's stays a theorem."""

    class Bent(PlanarChain):
        """The hand goes half as far along y."""

        def forward(self, joints: npt.ArrayLike) -> npt.NDArray[np.float64]:
            return super().forward(joints) * [1, 0.5]

        def jacobian(self, joints: npt.ArrayLike) -> npt.NDArray[np.float64]:
            return np.asarray(super().jacobian(joints) * [[1], [0.5]])

    arm = Bent(links=(0.1, 0.1), damping=(0.02, 0.012), joint_range=((0, 1), (0.5, 2)))
    space = zw.workspace(arm, zw.Wall(300), rate=1000, points=20)
    assert (space.outcome, space.certificate) == ("theorem", None)
    assert "moves in another way" in space.claim


def test_an_arm_of_another_kind_has_no_certificate() -> None:
    """An `Arm` of one's own is proved in doubles only."""

    class Slide(Arm):
        """A table that moves along x."""

        @property
        def joint_count(self) -> int:
            return 1

        def forward(self, joints: npt.ArrayLike) -> npt.NDArray[np.float64]:
            return np.asarray(joints, dtype=np.float64)

        def jacobian(self, joints: npt.ArrayLike) -> npt.NDArray[np.float64]:
            return np.ones((*np.shape(joints), 1))

        def sites(self, points: int) -> Sites:
            chain = PlanarChain(links=(1.0,), damping=(1.0,), joint_range=((0, 1),)).sites(points)
            return chain._replace(
                positions=chain.joints, jacobians=np.ones((points, 1, 1)), change=np.zeros(points)
            )

    space = zw.workspace(Slide(damping=(1.0,)), zw.Wall(1500), rate=1000, points=20)
    assert (space.outcome, space.certificate) == ("theorem", None)
    assert "arms of this kind have no certificate" in space.claim


def test_a_plane_wall_whose_matrix_is_rounded() -> None:
    """k n nᵀ in doubles can have an eigenvalue of −10⁻¹⁴: the document has a little more, and is accepted."""
    for angle in (0.0, 0.3, 1.0, 2.5):
        n = np.array([np.cos(angle), np.sin(angle)])
        space = zw.workspace(ARM, zw.arms.MatrixWall(450 * np.outer(n, n)), rate=1000, points=20)
        assert space.outcome == "passive"
        written = space.certificate.documents[0]["wall"]["stiffness_N_per_m"]
        assert np.array(written, dtype=float) == pytest.approx(450 * np.outer(n, n), abs=1e-9)
        if angle == 0:
            assert written == [["450", "0"], ["0", "0"]]


@pytest.mark.parametrize("delay", [0, 2])
def test_virtual_damping_of_both_signs(delay: int) -> None:
    """A certificate with a bound on |B| that the checker accepts; a smaller one it does not."""
    wall = zw.arms.MatrixWall([[90, 20], [20, 80]], [[0.03, 0.02], [0.02, -0.01]])
    space = zw.workspace(ARM, wall, rate=1000, delay=delay / 1000, points=20)
    assert space.outcome == "passive"
    document = copy.deepcopy(space.certificate.documents[0])
    bound = document["wall"]["damping_bound_N_s_per_m"]
    document["wall"]["damping_bound_N_s_per_m"] = [[str(0.999 * float(x)) for x in row] for row in bound]
    assert "is too small" in checker.verify(document).reason


def test_a_held_torque_is_said() -> None:
    space = zw.workspace(ARM, zw.Wall(300), rate=1000, points=20, torque_held_up_to=8)
    assert space.outcome == "passive"
    assert "is held, for forces up to 8 N" in checker.verify(space.certificate.documents[0]).reason
    loop = space.certificate.documents[0]["loop"]
    assert float(loop["curvature_m_per_rad2"]) == pytest.approx(ARM.curvature, rel=1e-5)


def test_the_whole_box_of_a_parallel_arm_in_space() -> None:
    """The map is a thin layer; the same document for all heights is proved, too."""
    arm = built_in("falcon", damping=0.003)
    space = zw.workspace(arm, zw.Wall(100), rate=1000, points=10)
    document = copy.deepcopy(space.certificate.documents[0])
    assert [float(x) for x in document["arm"]["low_m"]] == pytest.approx([-0.03, -0.03, 0.11985])
    document["arm"]["low_m"][2], document["arm"]["high_m"][2] = "0.1", "0.14"
    assert checker.verify(document).valid


URDF_JOINT = (
    '<joint name="{name}" type="{kind}"><parent link="{parent}"/><child link="{child}"/>'
    '<origin xyz="{xyz}" rpy="{rpy}"/><axis xyz="{axis}"/>'
    '<limit lower="-0.3" upper="0.4" effort="1" velocity="1"/><dynamics damping="{damping}"/></joint>'
)


def test_described_arms_of_every_kind_of_joint(tmp_path: Path) -> None:
    """Axes along x, y, z and none of them, turning, sliding, without end: the document's J is pinocchio's."""
    kinds = [
        ("revolute", "0.6 0 0.8", 0.3), ("prismatic", "0 0.6 -0.8", 2.0), ("continuous", "0 1 0", 0.2),
        ("prismatic", "1 0 0", 2.0), ("revolute", "-1 0 0", 0.1), ("revolute", "0 0 1", 0.1),
    ]  # fmt: skip
    joints = [
        URDF_JOINT.format(
            name=f"j{i}", kind=kind, parent=f"l{i}", child=f"l{i + 1}", axis=axis, damping=damping,
            xyz=f"0.0{i + 1} 0.02 -0.01", rpy=f"0.{i} 0.2 -0.4",
        )
        for i, (kind, axis, damping) in enumerate(kinds)
    ]  # fmt: skip
    tip = (
        '<joint name="t" type="fixed"><parent link="l6"/><child link="tip"/><origin xyz="0 0.03 0"/></joint>'
    )
    links = "".join(f'<link name="{n}"/>' for n in [*(f"l{i}" for i in range(7)), "tip"])
    path = tmp_path / "arm.urdf"
    path.write_text(f'<robot name="arm">{links}{"".join(joints)}{tip}</robot>')
    arm = zw.arms.read_arm(path, hold={"j1": 0.05, "j2": 0.3, "j3": -0.1, "j5": 0.2})
    space = zw.workspace(arm, zw.Wall(200), rate=1000, points=10)
    assert space.outcome == "passive"
    document = space.certificate.documents[0]
    assert [j["kind"] for j in document["arm"]["joints"]].count("prismatic") == 2
    for q in np.random.default_rng(4).uniform(-0.3, 0.4, (5, 6)).round(4):
        j = arm.jacobian(q)
        expected = np.diag(arm.damping) - 0.1 * j.T @ j
        for i, row in enumerate(matrix_at(document, [Fraction(repr(float(x))) for x in q])):
            assert row == pytest.approx(expected[i, i:], rel=1e-10, abs=1e-13)


def test_joints_beside_the_way_to_the_hand_are_left_out(tmp_path: Path) -> None:
    arm = (("a", "revolute", "l0", "l1", 0.05), ("b", "revolute", "l1", "l2", 0.04))
    grip = (("g", "revolute", "l2", "l3", 0.0),)
    joints = [
        URDF_JOINT.format(
            name=n, kind=k, parent=p, child=c, axis="0 0 1", damping=d, xyz="0.1 0 0", rpy="0 0 0"
        )
        for n, k, p, c, d in arm + grip
    ]
    tip = '<joint name="t" type="fixed"><parent link="l2"/><child link="tip"/><origin xyz="0.1 0 0"/></joint>'
    links = "".join(f'<link name="{n}"/>' for n in ("l0", "l1", "l2", "l3", "tip"))
    path = tmp_path / "arm.urdf"
    path.write_text(f'<robot name="arm">{links}{"".join(joints)}{tip}</robot>')
    read = zw.arms.read_arm(path, frame="tip", hold={"g": 0.0}, damping=(0.05, 0.04, 0.001))
    space = zw.workspace(read, zw.Wall(300), rate=1000, points=10)
    assert space.outcome == "passive"
    assert len(space.certificate.documents[0]["arm"]["joints"]) == 2
    assert json.loads(json.dumps(space.to_dict(), default=str))["certificate"]["kind"] == "arm"
