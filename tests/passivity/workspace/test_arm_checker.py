"""The checker of arms: its matrix by another road, its verdict on both sides, everything it refuses."""

from __future__ import annotations

import copy
from fractions import Fraction
from itertools import product
from typing import Any

import numpy as np
import pytest
from arm_documents import (
    GONE,
    IDENTITY,
    chain_in_pose,
    fractions,
    in_space,
    left_over,
    pantograph,
    places,
    put,
    random_chain,
    texts,
    two_link,
)
from checked import claim, matrix_at

from zwidth import checker
from zwidth.checker.arm import cells as arm_cells
from zwidth.checker.arm.cells import BITS, constant
from zwidth.checker.exact.enclosed import Enclosed
from zwidth.model.arms import Leg, LeggedArm

HELD = {
    "loop": two_link()["loop"] | {"torque": "held", "largest_force_N": "2", "curvature_m_per_rad2": "0.26"}
}


def end_of(arm: dict[str, Any], joints: list[complex]) -> np.ndarray:
    """p(q) by homogeneous matrices, complex for derivatives."""
    placed = np.eye(4, dtype=complex)
    for joint, q in zip(arm["joints"], joints, strict=True):
        step, move = np.eye(4, dtype=complex), np.eye(4, dtype=complex)
        step[:3, :3] = [[float(x) for x in row] for row in joint["rotation"]]
        step[:3, 3] = [float(x) for x in joint["translation_m"]]
        if joint["kind"] == "prismatic":
            move[2, 3] = q
        else:
            move[:2, :2] = [[np.cos(q), -np.sin(q)], [np.sin(q), np.cos(q)]]
        placed = placed @ step @ move
    return (placed @ [*(float(x) for x in arm["end_m"]), 1])[:3]


def surplus_of(document: dict[str, Any], joints: np.ndarray) -> np.ndarray:
    """δ_m − JᵀRJ with derivatives by complex steps."""
    steps = joints + 1e-30j * np.eye(len(joints))
    j = np.stack([end_of(document["arm"], list(step)).imag * 1e30 for step in steps], axis=-1)
    return left_over(document, j[: len(document["wall"]["stiffness_N_per_m"])])


@pytest.mark.parametrize("seed", range(5))
def test_the_matrix_of_a_chain_is_that_of_its_motion(seed: int) -> None:
    rng = np.random.default_rng(seed)
    document = random_chain(rng, int(rng.integers(1, 7)))
    q = rng.uniform(-0.2, 0.3, len(document["arm"]["joints"])).round(6)
    found = matrix_at(document, fractions(q))
    expected = surplus_of(document, q)
    for i, row in enumerate(found):
        assert row == pytest.approx(expected[i, i:], rel=1e-12, abs=1e-14)


@pytest.mark.parametrize("seed", range(5))
def test_the_matrix_of_legs_is_that_of_their_angles(seed: int) -> None:
    rng = np.random.default_rng(seed)
    size = 2 + seed % 2
    legs = []
    for _ in range(size):
        frame = np.linalg.qr(rng.normal(size=(size, size)))[0]
        base = rng.normal(size=size) * 0.02
        legs.append(
            Leg(
                base=base, out=frame[0], up=frame[1], link=0.06, rod=0.1,
                offset=0.02 * (seed % 3 == 0), bend=int(rng.choice([-1, 1])),
            )
        )  # fmt: skip
    arm = LeggedArm(legs=legs, damping=rng.uniform(1, 2, size), lower=[-0.1] * size, upper=[0.1] * size)
    for _ in range(50):
        place = rng.normal(size=size) * 0.06
        if np.isfinite(gradients := arm.gradients(place)).all():
            break
    told = [
        {
            **{key: texts(getattr(leg, key)) for key in ("out", "up")},
            **{f"{key}_m": texts(getattr(leg, key)) for key in ("base", "link", "rod", "offset")},
            "bend": leg.bend,
            "damping_N_m_s_per_rad": repr(b),
        }
        for leg, b in zip(legs, arm.damping, strict=True)
    ]
    box, zeros = ["0"] * size, [["0"] * size] * size
    document = pantograph(arm__legs=told, arm__low_m=box, arm__high_m=box)
    document["wall"] = dict.fromkeys(document["wall"], zeros)
    found = matrix_at(document, fractions(place))
    expected = gradients.T @ np.diag(arm.damping) @ gradients
    for i, row in enumerate(found):
        assert row == pytest.approx(expected[i, i:], rel=1e-8, abs=1e-8 * np.abs(expected).max())


@pytest.mark.parametrize(
    ("document", "place"),
    [
        (random_chain(np.random.default_rng(1), 4), [0.1, -0.15, 0.25, 0.2]),
        (random_chain(np.random.default_rng(5), 3), [0.3, -0.1, 0.22]),
        (two_link(), [1.1, 2.0]),
        (pantograph(), [0.011, 0.083]),
        (in_space(), [0.051, 0.054, 0.058]),
        *((chain_in_pose(1, 4, every, (2,)), [0.1, -0.15, 0.25, 0.2]) for every in (True, False)),
    ],
)
def test_the_slopes_are_those_of_the_matrix(document: dict[str, Any], place: list[float]) -> None:
    width, matrix = 2.0**-20, claim(document).matrix
    middle = [constant(Fraction(repr(x))) for x in place]
    half = 1 << BITS - 20
    cell = [
        Enclosed(BITS, x.middle, tuple(half * (i == j) for i in range(len(place))))
        for j, x in enumerate(middle)
    ]
    enclosing = [s for row in matrix(cell) for s in row]
    for j in range(len(place)):
        ends = []
        for sign in (-1, 1):
            moved = [Enclosed(BITS, x.middle + sign * half * (i == j)) for i, x in enumerate(middle)]
            ends.append([s.middle / 2**BITS for row in matrix(moved) for s in row])
        slopes = np.subtract(ends[1], ends[0]) / (2 * width)
        found = np.array([s.slopes[j] if s.slopes else 0 for s in enclosing], dtype=float) / half
        assert found == pytest.approx(slopes, rel=1e-6, abs=1e-6 * np.abs(slopes).max())
    rest = np.array([s.radius for s in enclosing], dtype=float) / half
    assert (rest <= 0.02 * max(max(map(abs, s.slopes)) for s in enclosing if s.slopes) / half).all()


def test_a_held_torque_takes_its_price_from_every_joint() -> None:
    place = [Fraction("0.7"), Fraction("1.3")]
    free, held = (matrix_at(d, place) for d in (two_link(), two_link(**HELD)))
    assert free[0][0] - held[0][0] == pytest.approx(0.26 * 2 * 0.001 / 2)
    assert free[1][0] - held[1][0] == pytest.approx(0.26 * 2 * 0.001 / 2)
    assert free[0][1] == held[0][1]


@pytest.mark.parametrize("seed", range(6))
def test_the_verdict_on_a_chain_is_that_of_a_fine_grid(seed: int) -> None:
    rng = np.random.default_rng(seed)
    document = random_chain(rng, 1 + seed % 3)
    joints = document["arm"]["joints"]
    axes = [np.linspace(-0.2, 0.3, 13)] * len(joints)
    least = min(np.linalg.eigvalsh(surplus_of(document, np.array(q)))[0] for q in product(*axes))
    for margin, valid in ((0.01, True), (-0.001, False)):
        changed = copy.deepcopy(document)
        for joint in changed["arm"]["joints"]:
            key = next(k for k in joint if k.startswith("damping"))
            joint[key] = str(float(joint[key]) + margin - least)
        found = checker.verify(changed)
        assert found.valid == valid, found.reason
        assert valid or "damping" in found.reason


@pytest.mark.parametrize("stiffness", [[1, 0, 0], [0, 1, 0], [3, 0, 4]])
def test_the_verdict_on_legs_is_that_of_a_fine_grid(stiffness: list[int]) -> None:
    a, b, c = stiffness
    shape = np.array([[a + 1, b], [b, c + 1]])
    legs = [
        Leg(base=(x, 0), out=(1, 0), up=(0, 1), link=0.07, rod=0.09, bend=bend)
        for x, bend in ((-0.019, 1), (0.019, -1))
    ]
    arm = LeggedArm(legs=legs, damping=(0.003, 0.003), lower=(-0.04, 0.06), upper=(0.04, 0.12))
    grid = np.stack(np.meshgrid(np.linspace(-0.04, 0.04, 161), np.linspace(0.06, 0.12, 121)), axis=-1)
    gradients = arm.gradients(grid)
    at_hand = 0.003 * np.swapaxes(gradients, -1, -2) @ gradients
    most = np.linalg.eigvals(np.linalg.solve(at_hand, 0.0005 * shape)).real.max()
    for factor, valid in ((0.99, True), (1.01, False)):
        wall = [[str(round(factor / most * x, 6)) for x in row] for row in shape]
        found = checker.verify(pantograph(wall__stiffness_N_per_m=wall))
        assert found.valid == valid, found.reason


MIXED = {
    "wall__stiffness_N_per_m": [["760", "0"], ["0", "660"]],
    "wall__virtual_damping_N_s_per_m": [["0.03", "0.04"], ["0.04", "-0.03"]],
    "wall__damping_bound_N_s_per_m": [["0.05", "0"], ["0", "0.05"]],
}  # |B| = 0.05


@pytest.mark.parametrize(
    "document",
    [
        two_link(),
        two_link(**MIXED),
        two_link(**MIXED | {"loop__delay_samples": 1, "wall__stiffness_N_per_m": [["250", "0"], ["0", "9"]]}),
        two_link(**HELD),
        pantograph(),
        pantograph(wall__stiffness_N_per_m=[["1", "-1"], ["-1", "1"]]),
    ],
    ids=["chain", "mixed", "delay", "held", "legs", "rank one"],
)  # fmt: skip
def test_what_holds_is_accepted(document: dict[str, Any]) -> None:
    found = checker.verify(document)
    assert found.valid, found.reason
    assert "read without encoder steps" in found.reason
    held = "is held, for forces up to 2 N" if document["loop"]["torque"] == "held" else "follows the arm"
    assert held in found.reason


@pytest.mark.parametrize(
    ("document", "reason"),
    [
        (two_link(wall__stiffness_N_per_m=[["950", "30"], ["30", "750"]]), "not enough"),
        (two_link(arm__joints__1__damping_N_m_s_per_rad="0.011"), "not enough"),
        (two_link(arm__joints__1__translation_m=["0.12", "0", "0"]), "not enough"),
        (two_link(arm__end_m=["0.1", "0", "0"]), "not enough"),
        (two_link(arm__joints__1__low_rad="0.2"), "not enough"),
        (two_link(loop__sample_period_s="0.0012"), "not enough"),
        (two_link(loop__delay_samples=1), "not enough"),
        (two_link(loop__encoder="1000 counts"), "encoder must be ideal or counted"),
        (two_link(loop__torque="is late"), "torque must be follows the arm"),
        (two_link(loop__torque="held"), "is missing"),
        (two_link(loop__sample_period_s="0"), "sample_period_s must be > 0"),
        (two_link(wall__stiffness_N_per_m=[["1", "0"], ["0", "-0.0001"]]), "negative eigenvalue"),
        (two_link(wall__stiffness_N_per_m=[["0", "1"], ["1", "5"]]), "negative eigenvalue"),
        (two_link(wall__stiffness_N_per_m=[["1", "1"], ["0", "1"]]), "not symmetric"),
        (two_link(wall__stiffness_N_per_m=[["1", "1"]]), "as many columns"),
        (
            two_link(**MIXED | {"wall__damping_bound_N_s_per_m": [["0.049", "0"], ["0", "0.051"]]}),
            "is too small",
        ),
        (two_link(**MIXED | {"wall__damping_bound_N_s_per_m": [["1", "0"], ["0", "1"]]}), "not enough"),
        (two_link(wall__virtual_damping_N_s_per_m=[["0.01", "0"], ["0", "0"]]), "is too small"),
        (two_link(wall__virtual_damping_N_s_per_m=[["0", "0"], ["0", "-0.01"]]), "is too small"),
        (two_link(arm__joints__0__rotation=[["1", "0.001", "0"], *IDENTITY[1:]]), "rows of a rotation"),
        (two_link(arm__joints__0__kind="spherical"), "kind must be revolute or prismatic"),
        (two_link(arm__joints__0__low_rad="2"), "low ≤ high"),
        (two_link(arm__joints__0__damping_N_m_s_per_rad="-1"), "damping_N_m_s_per_rad must be ≥ 0"),
        (two_link(arm__joints__0__high_rad="100"), "too many turns"),
        (two_link(arm__end_m=["1e40", "0", "0"]), "too large"),
        (two_link(arm__joints=[]), "joints must have 1 to"),
        (two_link(arm__geometry="wires"), "geometry must be chain or legs"),
        (two_link(**HELD | {"loop__largest_force_N": "60"}), "not enough"),
        (two_link(**HELD | {"loop__curvature_m_per_rad2": "0.2"}), "bend more"),
        (two_link(**HELD | {"loop__delay_samples": 1}), "without a delay"),
        (pantograph(**HELD), "not bounded"),
        (pantograph(wall__stiffness_N_per_m=[["700", "0"], ["0", "700"]]), "not enough"),
        (pantograph(arm__legs__0__bend=-1), "not enough|not reach"),
        (pantograph(arm__legs__0__bend=0), "bend must be -1 or 1"),
        (pantograph(arm__legs__1__link_m="0.08"), "not enough"),
        (pantograph(arm__legs__1__rod_m="0.05"), "not enough|not reach"),
        (pantograph(arm__legs__0__base_m=["-0.03", "0"]), "not enough"),
        (pantograph(arm__legs__0__damping_N_m_s_per_rad="0.0025"), "not enough"),
        (pantograph(arm__low_m=["-0.04", "0.01"]), "not reach"),
        (pantograph(arm__high_m=["0.04", "0.17"]), "not reach"),
        (pantograph(arm__low_m=["0.05", "0.06"]), "low ≤ high"),
        (pantograph(arm__legs=pantograph()["arm"]["legs"][:1]), "legs must have 2 to 3"),
    ],
)  # fmt: skip
def test_what_does_not_hold_is_refused(document: dict[str, Any], reason: str) -> None:
    """Each number that the proof rests on, changed for the worse, and each condition of the theorem."""
    found = checker.verify(document)
    assert not found.valid
    assert any(words in found.reason for words in reason.split("|")), found.reason


SMALL = {"arm__low_m": ["0", "0.08"], "arm__high_m": ["0.002", "0.082"]}


@pytest.mark.parametrize(
    "document", [two_link(), pantograph(**SMALL), *(chain_in_pose(4, 2, every) for every in (True, False))]
)
def test_every_place_is_read_with_care(document: dict[str, Any]) -> None:
    for path in places({k: document[k] for k in ("arm", "wall", "loop")}):
        for junk in (None, "x", [], {}, "1/0", True, "-1"):
            assert isinstance(checker.verify(put(document, path, junk)).valid, bool)


def test_more_cells_than_the_budget_are_refused(monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setattr(arm_cells, "MOST_WORK", 240)
    found = checker.verify(two_link())
    assert (found.valid, found.reason) == (False, "more than 20 cells would be needed")


@pytest.mark.parametrize(("top", "valid"), [(0.2501, True), (0.2499, False)])
def test_a_hill_whose_middle_has_no_slope(top: float, valid: bool) -> None:
    """S = top − x² on [−½, ½]: flat in the middle, and least at the ends; the same off the diagonal."""
    half, high = 1 << BITS - 1, constant(Fraction(repr(top)))
    box = ((-half, half),)
    for matrix in (
        lambda x: [[high - x[0] * x[0]]],
        lambda x: [[high, x[0] * x[0]], [high]],  # ≻ 0 where x² < top
    ):
        if valid:
            assert arm_cells.positive_in(box, matrix) > 0
        else:
            with pytest.raises(arm_cells.Invalid, match=r"not enough|more than"):
                arm_cells.positive_in(box, matrix)


def test_a_dip_between_the_middles_is_seen() -> None:
    """S = 1 − a·bump, positive at every middle of early cells; refused once the dip goes below 0."""
    box = ((0, 1 << BITS),)

    def dipped(depth: float):
        """S(x) = (x − 0.37)² + 0.001 − depth."""
        shift, offset = constant(Fraction("0.37")), constant(Fraction(0.001 - depth))
        return lambda x: [[(x[0] - shift) * (x[0] - shift) + offset]]

    assert arm_cells.positive_in(box, dipped(0.0009)) > 4
    with pytest.raises(arm_cells.Invalid, match=r"not enough at 0\.3"):
        arm_cells.positive_in(box, dipped(0.0011))


def counted(**changes: Any) -> dict[str, Any]:
    """The two links with encoders: friction of each joint for 4 N of the wall, by the formula."""
    document = two_link(
        wall__stiffness_N_per_m=[["500", "0"], ["0", "500"]],
        loop__encoder="counted", loop__torque="follows the readings", loop__largest_force_N="4",
    )  # fmt: skip
    steps, columns = np.array([2e-3, 1e-3]), np.array([0.1816, 0.0901])
    bends = np.array([[columns[max(i, j)] for j in range(2)] for i in range(2)])
    needed = (columns * 500 * (columns @ steps) + 4 * bends @ steps) / 2
    for joint, step, column, own in zip(document["arm"]["joints"], steps, columns, needed, strict=True):
        joint["resolution_rad"], joint["largest_column_m_per_rad"] = str(step), str(column)
        joint["coulomb_friction_N_m"] = repr(float(own * (1 + 2e-6)))
    for path, value in changes.items():
        document = put(document, path, value)
    return document


LESS = repr(float(counted()["arm"]["joints"][0]["coulomb_friction_N_m"]) * (1 - 1e-5))


@pytest.mark.parametrize(
    ("changes", "reason"),
    [
        ({"arm__joints__0__coulomb_friction_N_m": LESS}, "friction of joint 1 must be at least"),
        ({"arm__joints__1__coulomb_friction_N_m": "0.001"}, "friction of joint 2 must be at least"),
        ({"loop__largest_force_N": "4.001"}, "must be at least"),
        ({"arm__joints__1__resolution_rad": "0.00101"}, "must be at least"),
        ({"wall__stiffness_N_per_m": [["500", "1"], ["1", "500"]]}, "must be at least"),
        ({"arm__joints__0__largest_column_m_per_rad": "0.181"}, "longer than it is said to be at"),
        ({"arm__joints__1__largest_column_m_per_rad": "0.09"}, "longer than it is said to be at"),
        ({"loop__torque": "follows the arm"}, "follows the readings, or is held"),
        ({"loop__torque": "held"}, "curvature_m_per_rad2 is missing"),
        ({"loop__largest_force_N": "-1"}, "largest_force_N must be ≥ 0"),
        ({"arm__joints__0__resolution_rad": "-0.001"}, "resolution_rad must be ≥ 0"),
        ({"loop__encoder": "ideal"}, "follows the arm, or is held"),
        ({"arm__joints__1__resolution_rad": GONE}, "resolution is missing"),
        ({"arm__joints__1__coulomb_friction_N_m": GONE}, "coulomb_friction is missing"),
        ({"arm__joints__1__largest_column_m_per_rad": GONE}, "largest_column is missing"),
        ({"arm": pantograph()["arm"]}, "not bounded"),  # how their Jacobian changes over a step
    ],
)
def test_encoder_steps_are_paid_for(changes: dict[str, Any], reason: str) -> None:
    """1 part in 10⁵ less friction than the formula asks for, or anything worse, is refused."""
    found = checker.verify(counted(**changes))
    assert not found.valid
    assert reason in found.reason


HELD_STILL = {f"arm__joints__0__{key}": "0.5" for key in ("low_rad", "high_rad")}


@pytest.mark.parametrize(
    ("changes", "force"),
    [
        ({}, "4"),
        ({"loop__largest_force_N": "2.9999999"}, "2.99999"),
        (HELD_STILL | {"arm__joints__0__resolution_rad": "0.1"}, "4"),  # a joint that is held has no steps
    ],
)
def test_what_the_formula_asks_for_is_accepted(changes: dict[str, Any], force: str) -> None:
    """Words say no more than is proved: the force is rounded down."""
    found = checker.verify(counted(**changes))
    assert found.valid, found.reason
    assert "its encoder steps counted" in found.reason
    assert f"up to {force} N" in found.reason


def test_readings_may_be_a_step_outside_the_region() -> None:
    edge = counted(arm__joints__1__low_rad="0.45", arm__joints__0__largest_column_m_per_rad="0.1756")
    for joint in edge["arm"]["joints"]:
        joint["coulomb_friction_N_m"] = "1"
    longest = float(np.sqrt(0.1**2 + 0.09**2 + 2 * 0.1 * 0.09 * np.cos(0.45)))
    around = float(np.sqrt(0.1**2 + 0.09**2 + 2 * 0.1 * 0.09 * np.cos(0.449)))
    for bound, holds in ((longest * 1.0001, False), (around * 1.0001, True)):
        document = put(edge, "arm__joints__0__largest_column_m_per_rad", repr(bound))
        assert checker.verify(document).valid == holds
