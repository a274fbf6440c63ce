"""An arm of two links in a plane, for Lemma 2: torques held over each sample, everything between integrated.

M(q) q̈ + C(q, q̇) q̇ + ∇U(q) + δ q̇ = τ + τ_h(t)
"""

from __future__ import annotations

from dataclasses import dataclass, field

import numpy as np
from scipy.integrate import solve_ivp


@dataclass(frozen=True)
class Run:
    """What happened: at the edges of the samples, and inside each."""

    positions: np.ndarray
    energies: np.ndarray
    hand_work: np.ndarray
    heat: np.ndarray


@dataclass(frozen=True)
class Arm:
    """Two uniform rods with a weight at the end, optionally in gravity."""

    damping: np.ndarray
    masses: tuple[float, float] = (0.31, 0.17)
    lengths: tuple[float, float] = (0.23, 0.19)
    load: float = 0.08
    gravity: float = 0.0
    period: float = 0.004
    start: np.ndarray = field(default_factory=lambda: np.array([0.4, 1.1, 0.7, -1.9]))

    def inertia(self, q2):
        (m1, m2), (l1, l2), m3 = self.masses, self.lengths, self.load
        own = m1 * l1**2 / 3 + (m2 + m3) * l1**2
        far = m2 * l2**2 / 3 + m3 * l2**2
        mixed = (m2 / 2 + m3) * l1 * l2 * np.cos(q2)
        return np.array([[own + far + 2 * mixed, far + mixed], [far + mixed, far]])

    def potential(self, q):
        """U ≥ 0: 0 where both links hang."""
        (m1, m2), (l1, l2), m3 = self.masses, self.lengths, self.load
        a, b = (m1 / 2 + m2 + m3) * l1, (m2 / 2 + m3) * l2
        return self.gravity * (a * (1 - np.cos(q[0])) + b * (1 - np.cos(q[0] + q[1])))

    def energy(self, state):
        q, v = state[:2], state[2:4]
        return 0.5 * v @ self.inertia(q[1]) @ v + self.potential(q)

    def derivative(self, t, state, torque, hand):
        """Of q, q̇, the work of the hand and the heat."""
        q, v = state[:2], state[2:4]
        (m1, m2), (l1, l2), m3 = self.masses, self.lengths, self.load
        swing = (m2 / 2 + m3) * l1 * l2 * np.sin(q[1])
        coriolis = swing * np.array([-v[1] * (2 * v[0] + v[1]), v[0] ** 2])
        a, b = (m1 / 2 + m2 + m3) * l1, (m2 / 2 + m3) * l2
        weight = self.gravity * np.array(
            [a * np.sin(q[0]) + b * np.sin(q[0] + q[1]), b * np.sin(q[0] + q[1])]
        )
        push, friction = hand(t), self.damping @ v
        acceleration = np.linalg.solve(self.inertia(q[1]), torque + push - coriolis - weight - friction)
        return np.concatenate([v, acceleration, [push @ v, v @ friction]])

    def run(self, inputs, delay, hand=lambda t: np.zeros(2)):
        """Inputs u(k), or a function of k and the position at the end of sample k that gives it."""
        given: list[np.ndarray] = []
        state, edges, works = self.start, [self.start], []
        for k in range(inputs[1] if isinstance(inputs, tuple) else len(inputs)):
            torque = given[k - delay - 1] if k > delay else np.zeros(2)
            t = k * self.period
            found = solve_ivp(
                self.derivative,
                (t, t + self.period),
                np.concatenate([state, np.zeros(2)]),
                method="DOP853",
                args=(torque, hand),
                rtol=1e-12,
                atol=1e-13,
            )
            state, work = found.y[:4, -1], found.y[4:, -1]
            edges.append(state)
            works.append(work)
            given.append(inputs[0](k, state[:2]) if isinstance(inputs, tuple) else inputs[k])
        steps = np.array(edges)
        hand_work, heat = np.array(works).T
        return Run(steps[:, :2], np.array([self.energy(s) for s in steps]), hand_work, heat), np.array(given)
