"""An arm's certificate: what `workspace` says with one and without one, and that it is of the arm."""

from __future__ import annotations

import copy
import json
from pathlib import Path
from typing import Any

import numpy as np
import pytest
from arm_documents import described, fractions
from checked import matrix_at

import zwidth as zw
from zwidth import checker
from zwidth.checker.arm import cells as arm_cells
from zwidth.model.arms import Arm, PlanarChain, built_in
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
    arm = built_in("falcon", damping=0.003)
    space = zw.workspace(arm, zw.Wall(100), rate=1000, points=10)
    document = copy.deepcopy(space.certificate.documents[0])
    assert [float(x) for x in document["arm"]["low_m"]] == pytest.approx([-0.03, -0.03, 0.11985])
    document["arm"]["low_m"][2], document["arm"]["high_m"][2] = "0.1", "0.14"
    assert checker.verify(document).valid


def test_described_arms_of_every_kind_of_joint(tmp_path: Path) -> None:
    """Axes along x, y, z and none of them, turning, sliding, without end: the document's J is pinocchio's."""
    kinds = [
        ("revolute", "0.6 0 0.8", 0.3), ("prismatic", "0 0.6 -0.8", 2.0), ("continuous", "0 1 0", 0.2),
        ("prismatic", "1 0 0", 2.0), ("revolute", "-1 0 0", 0.1), ("revolute", "0 0 1", 0.1),
    ]  # fmt: skip
    joints = [
        (kind, axis, f"0.0{i + 1} 0.02 -0.01", f"0.{i} 0.2 -0.4", damping)
        for i, (kind, axis, damping) in enumerate(kinds)
    ]
    path = described(tmp_path / "arm.urdf", joints, "l6", "0 0.03 0")
    arm = zw.arms.read_arm(path, hold={"j1": 0.05, "j2": 0.3, "j3": -0.1, "j5": 0.2})
    space = zw.workspace(arm, zw.Wall(200), rate=1000, points=10)
    assert space.outcome == "passive"
    document = space.certificate.documents[0]
    assert [j["kind"] for j in document["arm"]["joints"]].count("prismatic") == 2
    for q in np.random.default_rng(4).uniform(-0.3, 0.4, (5, 6)).round(4):
        j = arm.jacobian(q)
        expected = np.diag(arm.damping) - 0.1 * j.T @ j
        for i, row in enumerate(matrix_at(document, fractions(q))):
            assert row == pytest.approx(expected[i, i:], rel=1e-10, abs=1e-13)


def test_joints_beside_the_way_to_the_hand_are_left_out(tmp_path: Path) -> None:
    joints = [("revolute", "0 0 1", "0.1 0 0", "0 0 0", damping) for damping in (0.05, 0.04, 0.0)]
    path = described(tmp_path / "arm.urdf", joints, "l2", "0.1 0 0")
    read = zw.arms.read_arm(path, frame="tip", hold={"j2": 0.0}, damping=(0.05, 0.04, 0.001))
    space = zw.workspace(read, zw.Wall(300), rate=1000, points=10)
    assert space.outcome == "passive"
    assert len(space.certificate.documents[0]["arm"]["joints"]) == 2
    assert json.loads(json.dumps(space.to_dict(), default=str))["certificate"]["kind"] == "arm"


class Bent(PlanarChain):
    """The hand goes half as far along y."""

    def forward(self, joints: Any) -> Any:
        return super().forward(joints) * [1, 0.5]

    def jacobian(self, joints: Any) -> Any:
        return super().jacobian(joints) * [[1], [0.5]]


class Slide(Arm):
    """A table that moves along x."""

    @property
    def joint_count(self) -> int:
        return 1

    def forward(self, joints: Any) -> Any:
        return np.asarray(joints, dtype=np.float64)

    def jacobian(self, joints: Any) -> Any:
        return np.ones((*np.shape(joints), 1))

    def sites(self, points: int) -> Any:
        chain = PlanarChain(links=(1.0,), damping=(1.0,), joint_range=((0, 1),)).sites(points)
        ones, zeros = np.ones((points, 1, 1)), np.zeros(points)
        return chain._replace(positions=chain.joints, jacobians=ones, change=zeros)


BENT = Bent(links=(0.1, 0.1), damping=(0.02, 0.012), joint_range=((0, 1), (0.5, 2)))


@pytest.mark.parametrize(
    ("arm", "stiffness", "work", "words"),
    [
        (BENT, 300, arm_cells.MOST_WORK, "moves in another way"),
        (Slide(damping=(1.0,)), 1500, arm_cells.MOST_WORK, "arms of this kind have no certificate"),
        (ARM, 500, 60, "There is no certificate: more than 5 cells would be needed."),
    ],
    ids=["links that carry the hand otherwise", "a kind of one's own", "a budget too small"],
)
def test_what_has_no_certificate_stays_a_theorem(arm, stiffness, work, words, monkeypatch) -> None:
    monkeypatch.setattr(arm_cells, "MOST_WORK", work)
    space = zw.workspace(arm, zw.Wall(stiffness), rate=1000, points=20)
    assert (space.outcome, space.certificate) == ("theorem", None)
    assert words in space.claim
