"""A two-link arm with mass, a held wall force and a hand: below the limit no energy comes out, above it does.

The equations of motion are integrated by scipy, with M(q), C(q, q̇) and the Jacobian at
every instant; nothing of the code under test takes part, but its limit.
"""

from __future__ import annotations

from collections.abc import Callable

import numpy as np
import numpy.typing as npt
import pytest
from scipy.integrate import solve_ivp

import zwidth as zw
from zwidth.model.arms import PlanarChain, joint_margin, wall_need

Array = npt.NDArray[np.float64]
Reference = Callable[[float], tuple[Array, Array]]

L1, L2 = 0.1, 0.1
M1, M2 = 0.002, 0.001
"""Point masses at the elbow and at the hand [kg]; light, for a hand that forces its motion on them."""
DAMPING = np.array([0.02, 0.012])
T = 0.001
GRIP, DRAG = 20_000.0, 60.0
"""The hand: a spring and a damper to a point that it moves [N/m], [N·s/m]."""
START = np.array([0.7, 1.2])
ARM = PlanarChain(links=(L1, L2), damping=tuple(DAMPING), joint_range=((0.6, 0.8), (1.1, 1.3)))


def _position(q: Array) -> Array:
    return np.array([L1 * np.cos(q[0]) + L2 * np.cos(q.sum()), L1 * np.sin(q[0]) + L2 * np.sin(q.sum())])


def _jacobian(q: Array) -> Array:
    s1, c1, s2, c2 = np.sin(q[0]), np.cos(q[0]), np.sin(q.sum()), np.cos(q.sum())
    return np.array([[-L1 * s1 - L2 * s2, -L2 * s2], [L1 * c1 + L2 * c2, L2 * c2]])


def _acceleration(q: Array, rates: Array, torque: Array) -> Array:
    """M q̈ = τ − C q̇ − δ_m q̇ for two point masses."""
    c, s = np.cos(q[1]), np.sin(q[1])
    coupling = M2 * L1 * L2
    mass = np.array(
        [
            [(M1 + M2) * L1**2 + M2 * L2**2 + 2 * coupling * c, M2 * L2**2 + coupling * c],
            [M2 * L2**2 + coupling * c, M2 * L2**2],
        ]
    )
    turning = coupling * s * np.array([-rates[1] * (2 * rates[0] + rates[1]), rates[0] ** 2])
    return np.linalg.solve(mass, torque - turning - DAMPING * rates)


def _energy(stiffness: float, reference: Reference, samples: int) -> tuple[float, float]:
    """What the hand has put in at the end, and the least that it ever had, starting at rest [J]."""
    rest = _position(START)

    def flow(t: float, state: Array, wall: Array) -> Array:
        q, rates = state[:2], state[2:4]
        j = _jacobian(q)
        v = j @ rates
        where, speed = reference(t)
        hand = GRIP * (where - _position(q)) + DRAG * (speed - v)
        return np.array([*rates, *_acceleration(q, rates, j.T @ (hand - wall)), hand @ v])

    state, least = np.array([*START, 0.0, 0.0, 0.0]), 0.0
    for k in range(samples):
        held = stiffness * (_position(state[:2]) - rest)
        found = solve_ivp(
            flow, (k * T, (k + 1) * T), state, method="LSODA", args=(held,), rtol=1e-6, atol=1e-10
        )
        state, least = found.y[:, -1], min(least, float(found.y[4].min()))
    return float(state[4]), least


def _path(corners: Array) -> Reference:
    """Straight from corner to corner, one for each sample, from the wall's rest."""
    points = np.vstack([np.zeros(2), corners]) + _position(START)

    def reference(t: float) -> tuple[Array, Array]:
        k = min(int(t / T), len(points) - 2)
        step = points[k + 1] - points[k]
        return points[k] + step * (t / T - k), step / T

    return reference


def _limit() -> float:
    return zw.workspace(ARM, zw.Wall(100), rate=1 / T, points=40).largest_stiffness


def _worst_direction() -> tuple[float, Array]:
    """The stiffness that the start just holds, and the direction in which it would fail."""
    j = _jacobian(START)
    inverse = np.linalg.inv(j)
    here = float(2 / T * np.linalg.eigvalsh(inverse.T @ np.diag(DAMPING) @ inverse)[0])
    (need,) = wall_need(zw.Wall(here), T, 0, 2).matrices
    margin, joints = joint_margin(ARM.jacobian(START), DAMPING, need)
    assert margin == pytest.approx(0, abs=1e-12)
    return here, np.asarray(j @ joints / np.linalg.norm(j @ joints))


def test_below_the_limit_no_hand_takes_energy_out() -> None:
    """Hands that climb from the most dangerous motion, at 0.97 of the stiffness that holds in the region."""
    here, direction = _worst_direction()
    stiffness, rng = 0.97 * _limit(), np.random.default_rng(1)
    assert stiffness < here
    shape, cheapest = direction * (-1.0) ** np.arange(12)[:, None], np.inf
    for attempt in range(12):
        tried = shape + (0.2 if attempt else 0) * rng.normal(size=shape.shape)
        tried *= 0.002 / np.abs(tried).max()
        energy, least = _energy(stiffness, _path(np.vstack([tried, np.zeros((2, 2))])), 14)
        assert least >= -1e-9
        if energy < cheapest:
            shape, cheapest = tried / 0.002, energy
    assert cheapest > 0
    path = _path(np.vstack([0.002 * shape, np.zeros((2, 2))]))
    assert _energy(1.6 * here, path, 14)[0] < cheapest


def test_above_the_limit_a_hand_takes_energy_out() -> None:
    """Back and forth in the direction that fails at the start, at 1.6 of the stiffness that holds there."""
    here, direction = _worst_direction()
    path = _path(0.002 * direction * (-1.0) ** np.arange(30)[:, None])
    over, under = (_energy(factor * here, path, 30)[0] for factor in (1.6, 0.8))
    assert over < 0 < under
