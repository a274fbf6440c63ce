"""Lemma 2 on an arm of two links: its storage along motions, its loss, and what breaks it."""

from __future__ import annotations

from fractions import Fraction

import numpy as np
import pytest
from two_link_arm import Arm

import zwidth as zw
from zwidth.errors import InputError

DAMPING = np.array([[0.031, 0.007], [0.007, 0.019]])
N = 40
STIFFNESS = 9.0


def storage(arm, inputs, delay, damping=DAMPING, hand=lambda t: np.zeros(2)):
    """The storage along a motion, and the motion."""
    run, given = arm.run(inputs, delay, hand)
    data = zw.coupling.loop_storage(
        given, run.positions, run.energies, damping, arm.period, delay * arm.period, run.hand_work
    )
    return data, run


def pushing(seed):
    """A hand that pushes both joints with three tones."""
    random = np.random.default_rng(seed)
    size, pitch, phase = (
        random.normal(0, 0.3, (2, 3)),
        random.uniform(5, 400, (2, 3)),
        random.uniform(0, 6, 3),
    )
    return lambda t: (size * np.sin(pitch * t + phase)).sum(axis=1)


@pytest.mark.parametrize("delay", [0, 1, 3])
@pytest.mark.parametrize("gravity", [0.0, 9.81])
def test_the_loss_of_the_lemma_is_the_change_of_velocity_in_a_sample(delay, gravity):
    """Slack = (1/T)[∫ q̇ᵀδq̇ − T v̄ᵀΛv̄], with a hand, random torques, Λ = δ: to the integrator's accuracy."""
    random = np.random.default_rng(100 + delay)
    arm = Arm(DAMPING, gravity=gravity)
    data, run = storage(arm, random.normal(0, 0.5, (N, 2)), delay, hand=pushing(delay))
    mean = np.diff(run.positions, axis=0) / arm.period
    loss = run.heat / arm.period - np.einsum("ki,ij,kj->k", mean, DAMPING, mean)
    assert np.allclose(data["slack"], loss, rtol=0, atol=1e-9)
    assert loss.max() > 1e-4
    assert data["slack"].min() >= -1e-9


@pytest.mark.parametrize("seed", range(6))
def test_the_storage_never_grows_by_more_than_is_put_in(seed):
    """W(k+1) − W(k) ≤ yᵀu − yᵀΛy + hand for torques of every kind: white, switching, steady."""
    random = np.random.default_rng(seed)
    delay = seed % 3
    kinds = [
        random.normal(0, 1, (N, 2)),
        random.choice([-1.0, 1.0], (N, 2)),
        np.repeat(random.normal(0, 0.1, (1, 2)), N, axis=0),
    ]
    arm = Arm(DAMPING, gravity=9.81 * (seed % 2), start=random.normal(0, 1.5, 4))
    data, _ = storage(arm, kinds[seed % 3], delay, hand=pushing(seed))
    bound = data["supply"] - data["dissipation"] + data["hand"]
    assert np.all(np.diff(data["storage"]) <= bound.values + 1e-8)
    assert np.all(data["storage"] >= 0)


def least_slack(share, seed, rounds=25):
    """The least slack that a search over torques finds when the joints have a share of the damping Λ."""
    random = np.random.default_rng(seed)
    arm = Arm(share * DAMPING, start=np.zeros(4))
    best = np.full((12, 2), 0.05)
    least = np.inf
    for _ in range(rounds):
        tried = best * random.uniform(0.5, 2.5) + random.normal(0, 0.02, best.shape)
        found = float(storage(arm, tried, 1)[0]["slack"].min())
        if found < least:
            best, least = tried, found
    return least


def test_less_damping_than_supposed_breaks_it():
    """A search finds none against Λ = δ, and finds some where the joints have nine tenths of Λ."""
    assert least_slack(1.0, 5) >= -1e-9
    assert least_slack(0.9, 5) < -1e-5


def test_more_than_enough_damping_in_one_direction_does_not_pay_for_another():
    """δ ⪰ Λ is what counts: with the same trace, turned, steady torques find the weak joint."""
    turned = np.array([[0.019, -0.007], [-0.007, 0.031]])
    arm = Arm(turned, start=np.zeros(4))
    data, _ = storage(arm, np.repeat([[0.06, 0.02]], N, axis=0), 0)
    assert data["slack"].min() < -1e-4


def alone(damping, delay, samples=150):
    """The arm thrown at a virtual spring at each joint, one of them one-sided, and left alone."""

    def force(k, q):
        return -STIFFNESS * np.array([max(q[0], 0.0), q[1]])

    arm = Arm(damping * np.eye(2), start=np.array([-0.01, 0.0, 2.0, 1.0]))
    run, given = arm.run((force, samples), delay)
    return zw.coupling.loop_storage(
        given, run.positions, run.energies, arm.damping, arm.period, delay * arm.period
    ), run


@pytest.mark.parametrize("delay", [0, 2])
def test_springs_known_by_their_slopes_never_feed_the_arm(delay):
    """With the damping their slopes ask for, thrown from where they are slack, no energy grows."""
    need = float(zw.coupling.required_damping_by_slopes(0, STIFFNESS, "0.004", Fraction(delay, 250)))
    data, run = alone(need, delay)
    given = (data["supply"] - data["dissipation"]).cumsum()
    assert float(given.max()) <= 1e-9
    assert np.abs(data["supply"]).max() > 0.02
    assert run.energies.max() <= run.energies[0] * (1 + 1e-12)


def test_a_tenth_of_that_damping_feeds_it():
    """The same arm with a tenth of it, two samples late: it soon has three times what it had, and more."""
    _, run = alone(0.1 * float(zw.coupling.required_damping_by_slopes(0, STIFFNESS, "0.004", "0.008")), 2)
    assert run.energies.max() > 3 * run.energies[0]


def at_the_hand(q, stiffness, arm):
    """Torques Jᵀ F of a spring at the end of the arm, and the Hessian of its potential in the joints."""
    l1, l2 = arm.lengths
    place = np.array([l1 * np.sin(q[0]) + l2 * np.sin(q.sum()), -l1 * np.cos(q[0]) - l2 * np.cos(q.sum())])
    a, b = np.array([np.cos(q[0]), np.sin(q[0])]) * l1, np.array([np.cos(q.sum()), np.sin(q.sum())]) * l2
    jacobian = np.array([a + b, b]).T
    force = stiffness * (place - np.array([0.25, -0.1]))
    upward_1, upward_2 = np.array([-a[1], a[0]]), np.array([-b[1], b[0]])
    bend = np.array([[force @ (upward_1 + upward_2), force @ upward_2], [force @ upward_2] * 2])
    return jacobian.T @ force, jacobian.T @ jacobian * stiffness + bend


@pytest.mark.parametrize("delay", [0, 1])
def test_a_spring_at_the_end_of_the_arm_by_its_slopes_in_the_joints(delay):
    """J(q) is held with the force: the slopes of Φ(x(q)) in the joints, curvature included, pay for it."""
    stiffness, grid = 60.0, np.linspace(-np.pi, np.pi, 73)
    probe = Arm(DAMPING)
    slopes = [
        np.linalg.eigvalsh(at_the_hand(np.array([a, b]), stiffness, probe)[1]) for a in grid for b in grid
    ]
    least, greatest = np.min(slopes), np.max(slopes) * 1.01
    need = float(zw.coupling.required_damping_by_slopes(least, greatest, "0.004", Fraction(delay, 250)))
    arm = Arm(need * np.eye(2), start=np.array([0.5, 0.6, 0.0, 0.0]))
    end = np.array(
        [0.23 * np.sin(0.5) + 0.19 * np.sin(1.1) - 0.25, -0.23 * np.cos(0.5) - 0.19 * np.cos(1.1) + 0.1]
    )
    run, given = arm.run((lambda k, q: -at_the_hand(q, stiffness, arm)[0], 120), delay)
    data = zw.coupling.loop_storage(
        given, run.positions, run.energies, arm.damping, arm.period, delay * arm.period
    )
    spring = stiffness / 2 * end @ end
    assert least < 0 < greatest
    assert float((data["supply"] - data["dissipation"]).cumsum().max()) * arm.period <= spring * (1 + 1e-9)
    assert 0.01 * spring < run.energies.max() <= spring


def test_what_a_redundant_arm_can_be_counted_on_to_dissipate():
    """(J δ_m⁻¹ Jᵀ)⁻¹ is the least loss over joint velocities; (Jᵀ)†δ_m J† is that of the least velocity.

    With as many joints as axes they are the same.
    """
    random = np.random.default_rng(2)
    jacobian, damping = random.normal(0, 1, (2, 3)), np.diag([0.03, 0.11, 0.02])
    inverse, v = np.linalg.pinv(jacobian), np.array([0.3, -0.8])
    least, published = (
        np.linalg.inv(jacobian @ np.linalg.inv(damping) @ jacobian.T),
        inverse.T @ damping @ inverse,
    )
    idle = np.linalg.svd(jacobian)[2][2]
    moves = inverse @ v + np.linspace(-3, 3, 6001)[:, None] * idle
    losses = np.einsum("ki,ij,kj->k", moves, damping, moves)
    assert losses.min() == pytest.approx(v @ least @ v, rel=1e-5)
    assert losses.min() < 0.95 * (v @ published @ v)
    square = jacobian[:, :2]
    same = np.linalg.inv(square @ np.linalg.inv(damping[:2, :2]) @ square.T)
    assert np.allclose(same, np.linalg.inv(square).T @ damping[:2, :2] @ np.linalg.inv(square))


@pytest.mark.parametrize(
    ("changes", "words"),
    [
        ({"damping": 0.0}, "positive definite"),
        ({"damping": [[1.0, 0.5], [0.0, 1.0]]}, "symmetric"),
        ({"sample_period": 0.0}, "sample_period"),
        ({"delay": -1}, "delay"),
        ({"delay": 0.0005}, "delay"),
        ({"delay": 0.003}, "in seconds"),
        ({"energies": np.zeros(3)}, "shapes"),
        ({"hand_work": np.zeros(4)}, "hand_work"),
    ],
)
def test_what_does_not_fit_is_refused(changes, words):
    """Each with a message that names it."""
    good = {
        "inputs": np.zeros((3, 2)),
        "positions": np.zeros((4, 2)),
        "energies": np.zeros(4),
        "damping": 1.0,
        "sample_period": 0.001,
    }
    with pytest.raises(InputError, match=words):
        zw.coupling.loop_storage(**{**good, **changes})
