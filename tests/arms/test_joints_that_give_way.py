"""Joints that give way between motor and link: by what their motors feel, and what a passive hand gets."""

from __future__ import annotations

import json
from fractions import Fraction
from typing import Any

import numpy as np
import pytest
from described_arms import panda_like, random_arm

import zwidth as zw
from zwidth.checker import verify
from zwidth.cli.main import main
from zwidth.cli.workspace.arm import read_joints
from zwidth.model.arms import PlanarChain, built_in, read_arm

PERIOD, PARTS, SAMPLES = 1e-3, 8, 300
AT, NEAR = np.array([0.7, 1.2]), 0.05
"""The posture, and how far from it the region goes [rad]."""
LINKS = (0.1, 0.1)
MOTORS, BEHIND = (0.003, 0.002), (0.02, 0.015)
"""Damping of both sides of the joints [N·m·s/rad]."""


def arm(damping: Any, **more: Any) -> PlanarChain:
    region = tuple((q - NEAR, q + NEAR) for q in AT)
    return PlanarChain(links=LINKS, damping=damping, joint_range=region, **more)


def limit(damping: Any, **more: Any) -> float:
    """The stiffest wall that is proved, to a percent."""
    found = zw.workspace(arm(damping, **more), zw.Wall(1), rate=1 / PERIOD, points=10)
    return 0.97 * found.largest_stiffness


def links(q: np.ndarray) -> tuple[np.ndarray, np.ndarray]:
    """p and J of many postures, written anew."""
    a, b = q[:, 0], q.sum(axis=1)
    p = LINKS[0] * np.array([np.cos(a), np.sin(a)]) + LINKS[1] * np.array([np.cos(b), np.sin(b)])
    second = LINKS[1] * np.array([-np.sin(b), np.cos(b)])
    first = second + LINKS[0] * np.array([-np.sin(a), np.cos(a)])
    return p.T, np.moveaxis(np.array([first, second]), -1, 0).swapaxes(1, 2)


def taken_by_hands(wall: float, seed: int, hands: int = 60) -> np.ndarray:
    """What passive hands get out of two links on springs, less what was in it at first, over that [1].

    B θ̈ + D_m θ̇ + k (θ − q) = −J(θ)ᵀ f_k and M(q) q̈ + C q̇ + D_l q̇ = k (θ − q) − J(q)ᵀ (K_h (p − p₀) + D_h ṗ),
    each hand with joints of its own; the largest while the readings are inside the region.
    """
    rng = np.random.default_rng(seed)
    rotor, joint, hold, drag = (
        10 ** rng.uniform(*ends, (hands, 1)) for ends in ((-4.3, -3.3), (0.5, 2.5), (2, 4), (-0.5, 1.5))
    )
    heavy = 0.1  # kg, at the end of each link
    start, _ = links(AT[None])

    def slopes(state: np.ndarray, force: np.ndarray) -> np.ndarray:
        q, w, theta, turn = state[:, :2], state[:, 2:4], state[:, 4:6], state[:, 6:8]
        p, j = links(q)
        _, at_motor = links(theta)
        speed = np.einsum("nij,nj->ni", j, w)
        pull = hold * (p - start) + drag * speed
        spring = joint * (theta - q)
        c, s = np.cos(q[:, 1]), np.sin(q[:, 1])
        a, b = LINKS
        m22 = heavy * b * b + 0 * c
        m12 = m22 + heavy * a * b * c
        m11 = 2 * heavy * a * a + m22 + 2 * heavy * a * b * c
        twist = heavy * a * b * s
        own = spring - np.array(BEHIND) * w - np.einsum("nij,ni->nj", j, pull)
        own[:, 0] += twist * (2 * w[:, 0] + w[:, 1]) * w[:, 1]
        own[:, 1] -= twist * w[:, 0] ** 2
        det = m11 * m22 - m12**2
        links_go = np.array([m22 * own[:, 0] - m12 * own[:, 1], m11 * own[:, 1] - m12 * own[:, 0]]).T
        motors = -spring - np.array(MOTORS) * turn - np.einsum("nij,ni->nj", at_motor, force)
        gained = (pull * speed).sum(axis=1, keepdims=True)
        return np.concatenate([w, links_go / det[:, None], turn, motors / rotor, gained], axis=1)

    state = np.zeros((hands, 9))
    state[:, :2] = state[:, 4:6] = AT
    state[:, 6:8] = 0.01 * rng.normal(size=(hands, 2))
    first = (0.5 * rotor * state[:, 6:8] ** 2).sum(axis=1)
    most = np.zeros(hands)
    inside, step = np.ones(hands, dtype=bool), PERIOD / PARTS
    for _ in range(SAMPLES):
        force = wall * (links(state[:, 4:6])[0] - start)
        for _ in range(PARTS):
            one = slopes(state, force)
            two = slopes(state + step / 2 * one, force)
            three = slopes(state + step / 2 * two, force)
            state = state + step / 6 * (one + 2 * two + 2 * three + slopes(state + step * three, force))
        inside &= (np.abs(state[:, 4:6] - AT) < NEAR).all(axis=1)
        state[~inside] = 0
        most = np.where(inside, np.maximum(most, state[:, 8] / first - 1), most)
    return most


def test_the_sum_of_both_sides_promises_a_passive_hand_energy():
    both = np.add(MOTORS, BEHIND)
    assert zw.workspace(arm(both), zw.Wall(0.5 * limit(both)), rate=1 / PERIOD, points=10).passive
    assert taken_by_hands(0.5 * limit(both), seed=1).max() > 10


@pytest.mark.parametrize("seed", range(2))
def test_what_the_motors_feel_pays_for_every_hand_and_stiffness(seed):
    assert taken_by_hands(limit(MOTORS), seed).max() < 1e-6


def test_the_region_is_proved_with_what_the_motors_feel():
    between = zw.Transmission(damping="0.01 N*m*s/rad", handle_damping=(0.02, 0.03), stiffness=50)
    given = arm(MOTORS, transmission=between)
    felt = [Fraction(str(b)) + Fraction(1, 150) for b in MOTORS]
    assert all(0 <= b - Fraction(x) < 1e-17 for b, x in zip(felt, given.at_motors.damping, strict=True))
    assert given.at_motors.at_motors.damping == given.at_motors.damping
    space = zw.workspace(given, zw.Wall(limit(given.at_motors.damping)), rate=1 / PERIOD, points=10)
    assert (space.outcome, space.scope.transmission) == ("passive", "any")
    assert "every stiffness of the joints" in space.claim
    (document,) = space.certificate.documents
    assert verify(document).valid
    told = [Fraction(joint["damping_N_m_s_per_rad"]) for joint in document["arm"]["joints"]]
    assert all(t <= b for t, b in zip(told, felt, strict=True))


def test_beyond_it_nothing_is_refuted():
    given = arm(MOTORS, transmission=[zw.Transmission(handle_damping=0.02)] * 2)
    for more in ({}, {"resolution": (1e-3, 1e-3)}):
        hard = zw.workspace(given.replace(**more), zw.Wall(1e4), rate=1 / PERIOD, points=10)
        assert (hard.outcome, hard.motion, hard.can_be_refuted) == ("undecided", None, False)
        assert "no motion was looked for" in hard.claim
    assert zw.workspace(arm(MOTORS), zw.Wall(1e4), rate=1 / PERIOD, points=10).outcome == "active"


def test_damping_that_joints_share_is_the_motors_too():
    shared = np.array([[0.003, 0.001], [0.001, 0.002]])
    given = arm(shared, transmission=zw.Transmission(damping=0.02, handle_damping=0.02))
    assert np.allclose(given.at_motors.damping, shared + 0.01 * np.eye(2), rtol=1e-14, atol=0)


@pytest.mark.parametrize(
    ("transmission", "message"),
    [
        (zw.Transmission(encoder="handle"), "joint 1 is read at its link"),
        ([zw.Transmission()] * 3, "one for each of 2"),
        ("soft", "one for each of 2"),
    ],
)
def test_what_no_proof_covers_is_refused(transmission, message):
    with pytest.raises(zw.InputError, match=message):
        arm(MOTORS, transmission=transmission)


def test_postures_and_null_space_springs(tmp_path):
    path = panda_like(tmp_path / "panda.urdf")
    soft = zw.Transmission(damping=1, handle_damping=1)
    given = read_arm(path, whole=True, damping=[0.5], transmission=soft)
    rigid = read_arm(path, whole=True, damping=[1])
    asked: dict[str, Any] = {"rate": 1000, "postures": 300}
    one, other = (zw.stiffness_over_postures(a, zw.Wall(1e5), **asked) for a in (given, rigid))
    assert one.stiffness_factor == pytest.approx(other.stiffness_factor, rel=1e-12)
    assert (one.outcome, other.outcome) == ("undecided", "active")
    held = zw.null_space(given, zw.Wall(100), rate=1000, stiffness=20)
    assert (held.outcome, held.loop, held.scope.transmission) == ("undecided", None, "any")


def test_on_the_command_line(tmp_path, capsys):
    path = random_arm(tmp_path / "arm.urdf", 1, 2)
    joints = tmp_path / "joints.toml"
    joints.write_text(
        '[joints.transmission]\ndamping = [0.1, 0]\nhandle_damping = "0.1 N*m*s/rad"\n', encoding="utf-8"
    )
    asked = ["workspace", str(path), "--stiffness", "1", "--joints", str(joints), "--points", "10"]
    assert main([*asked, "--json"]) == 0
    told = json.loads(capsys.readouterr().out)
    own, felt = told["joint_damping_N_m_s_rad"], told["joint_damping_that_motors_feel_N_m_s_rad"]
    assert np.subtract(felt, own) == pytest.approx([0.05, 0], abs=1e-12)
    assert main(asked) == 0
    assert "of the motors' side, which feels" in " ".join(capsys.readouterr().out.split())
    for wrong in ("transmission = 1", "[joints.transmission]\ndamping = [1]\nhandle_damping = [1, 2]",
                  "[joints.transmission]\nlink_damping = 1"):  # fmt: skip
        joints.write_text(wrong if wrong[0] == "[" else f"[joints]\n{wrong}", encoding="utf-8")
        assert main(asked) == 2
        assert "transmission" in capsys.readouterr().err


MJCF = """<mujoco><compiler angle="radian"/><worldbody><body><joint name="motor" axis="0 0 1" damping="1"
  range="-1 1"/><body pos=".1 0 0"><joint name="link" axis="0 0 1" stiffness="{}" damping=".1" range="-1 1"/>
  <site name="hand" pos=".1 0 0"/></body></body></worldbody><actuator>{}</actuator></mujoco>"""


def test_a_spring_of_a_description_is_told_and_one_without_a_motor_refused(tmp_path):
    path = tmp_path / "arm.xml"
    motors = '<motor joint="motor"/>', '<motor joint="motor"/><motor joint="link"/>'
    path.write_text(MJCF.format(50, motors[0]), encoding="utf-8")
    with pytest.raises(zw.InputError, match=r"'link' has a spring and no motor"):
        read_arm(path)
    assert read_arm(path, frame="motor").damping_source
    for stiffness, motor in ((50, motors[1]), (50, ""), (0, motors[0])):
        path.write_text(MJCF.format(stiffness, motor), encoding="utf-8")
        assert ("the spring of link" in read_arm(path).damping_source) == bool(stiffness)
    path = random_arm(tmp_path / "arm.urdf", 1, 2)
    path.write_text(
        path.read_text("utf-8").replace("<dynamics", '<dynamics stiffness="9"', 1), encoding="utf-8"
    )
    assert "the spring of j0" in read_arm(path, damping=[1]).damping_source


def test_legs_are_read_at_their_motors():
    given = built_in("haply-2diy", damping=0.003, transmission=zw.Transmission(handle_damping=0.1))
    plain = built_in("haply-2diy", damping=0.003)
    one, other = (zw.workspace(a, zw.Wall(100), rate=1000, points=20) for a in (given, plain))
    assert (one.outcome, one.largest_stiffness) == (other.outcome, other.largest_stiffness)


def test_each_joint_has_the_units_of_its_motion(tmp_path):
    """A joint that slides takes N/m and refuses N·m/rad, one that turns the other way round."""
    path = random_arm(tmp_path / "arm.urdf", 3, 2, sliding=(1,))
    turns, slides = zw.Transmission(handle_damping="0.1 N*m*s/rad"), zw.Transmission(stiffness="30 N/mm")
    assert read_arm(path, transmission=[turns, slides]).transmissions == (turns, slides)
    for wrong, joint in (([turns, turns], 2), ([slides, slides], 1)):
        with pytest.raises(
            zw.InputError, match=f"joint {joint} is .*, and its transmission is given in units"
        ):
            read_arm(path, transmission=wrong)
    file = tmp_path / "joints.toml"
    file.write_text('[joints.transmission]\nstiffness = ["3 N*m/deg", "30 N/mm"]\n', encoding="utf-8")
    told = read_joints(file)["transmission"]
    assert [one.motion for one in told] == ["rotary", "linear"]
    assert told[1].stiffness == 30000
    assert read_arm(path, transmission=told).transmissions == told
