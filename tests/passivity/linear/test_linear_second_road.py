"""The linear criterion by a second road: the game of the hand without an encoder, by value iteration.

Without encoder and Coulomb friction everything that a hand can get is quadratic, and so is the
most it can get in n moves.  A move by δ, with the force g acting for a part α of the interval and
h for the rest, the hand where it is best in between, brings

    −(α g + (1 − α) h) δ − (b/T) δ² + T α (1 − α) (g − h)²/(4b)

The spring's K x δ is ½K (x'² − x²) − ½K δ² and K's share of V is ½K x², which a hand gets back by
retreating slowly from wherever it is.  What is left depends on past moves alone: U = V − ½K x².

    U ← max over δ of  reward + U',      U = zᵀ P z,   from U = 0

It grows without end exactly if the loop is active: then, after some moves, the maximum over δ is
infinite.  Where it settles, it is finite and the loop is passive.  No frequency occurs in this,
no H(z), no polynomial; the laws are written out as a controller would run them.
"""

from __future__ import annotations

from math import exp
from typing import NamedTuple

import numpy as np
import pytest

import zwidth as zw

T = 1e-3
MOVES = 3000
"""After so many it is said that nothing is known."""

SETTLED = 1e-12
"""Relative change by one more move."""


class Law(NamedTuple):
    """f_k = K x_k + y_k, y_k = C q_k: what the law adds to a spring depends on past moves only.

    q_{k+1} = A q_k + B δ_k.
    """

    stiffness: float
    a: np.ndarray
    b: np.ndarray
    c: np.ndarray


def spring(stiffness):
    return Law(stiffness, np.zeros((0, 0)), np.zeros(0), np.zeros(0))


def one_state(stiffness, keeps, takes, gives=1.0):
    """q ← keeps q + takes δ, y = gives q."""
    return Law(stiffness, np.array([[keeps]]), np.array([takes]), np.array([gives]))


def window(stiffness, damping, samples):
    """v = (x_k − x_{k−N})/(N T): the last N moves."""
    moves = np.eye(samples, k=-1)
    return Law(stiffness, moves, np.eye(samples)[0], np.full(samples, damping / (samples * T)))


def low_pass(stiffness, damping, tau):
    """v_k = (τ v_{k−1} + δ_{k−1})/(τ + T)."""
    return one_state(stiffness, tau / (tau + T), 1 / (tau + T), damping)


def maxwell(stiffness, mu, eta, discretization):
    """A branch's force y: ẏ = μ ẋ − y μ/η, in four ways."""
    rate = mu / eta * T
    keeps, takes = {
        "backward": (1 / (1 + rate), mu / (1 + rate)),
        "forward": (1 - rate, mu),
        "tustin": ((1 - rate / 2) / (1 + rate / 2), mu / (1 + rate / 2)),
        "zoh": (exp(-rate), mu),
    }[discretization]
    return one_state(stiffness, keeps, takes)


LAWS = {
    "spring": (zw.Wall(300), spring(300)),
    "damped": (zw.Wall(300, "0.17"), one_state(300, 0.0, 1.0, 0.17 / T)),
    "much damped": (zw.Wall(100, 2), one_state(100, 0.0, 1.0, 2 / T)),
    "negative damping": (zw.Wall(300, "-0.09"), one_state(300, 0.0, 1.0, -0.09 / T)),
    "damping alone": (zw.Wall(0, "0.4"), one_state(0, 0.0, 1.0, 0.4 / T)),
    "window of 2": (zw.Wall(300, "0.3", zw.rendering.Window(2)), window(300, 0.3, 2)),
    "window of 5": (zw.Wall(200, "0.6", zw.rendering.Window(5)), window(200, 0.6, 5)),
    "one pole": (zw.Wall(300, "0.5", zw.rendering.OnePole("0.004")), low_pass(300, 0.5, 0.004)),
    "quick pole": (zw.Wall(300, "0.5", zw.rendering.OnePole("0.0005")), low_pass(300, 0.5, 0.0005)),
    "standard linear solid": (zw.StandardLinearSolid(150, 400, 2), maxwell(150, 400, 2, "backward")),
    "solid by Tustin's rule": (zw.StandardLinearSolid(150, 400, 2, "tustin"), maxwell(150, 400, 2, "tustin")),
    "solid, forward": (zw.StandardLinearSolid(150, 400, 2, "forward"), maxwell(150, 400, 2, "forward")),
    "Maxwell": (zw.Maxwell(500, 3), maxwell(0, 500, 3, "backward")),
    "Maxwell, held": (zw.Maxwell(500, 3, "zoh"), maxwell(0, 500, 3, "zoh")),
}
DELAYS = (0.0, 0.5, 1.0, 1.3)
"""In samples."""


def game(law, damping, delay):
    """(F, G, R, s, c): z' = F z + G δ, reward zᵀ R z + 2 δ s·z − c δ².

    z holds q, then the newest first what y and δ were at as many samples as the delay reaches back.
    """
    whole = int(delay)
    part = delay - whole
    back = whole + (part > 0)
    own = len(law.b)
    size = own + 2 * back
    y_row = np.zeros(size)
    y_row[:own] = law.c

    def force(age):
        """Of the reading at this age, less K times the position now."""
        row = y_row.copy() if age == 0 else np.eye(size)[own + age - 1]
        row[own + back : own + back + age] -= law.stiffness
        return row

    newer, older = force(whole), force(back)
    f, g = np.zeros((size, size)), np.zeros(size)
    f[:own, :own], g[:own] = law.a, law.b
    if back:
        f[own], g[own + back] = y_row, 1.0
        f[own + 1 : own + back, own : own + back - 1] = np.eye(back - 1)
        f[own + back + 1 :, own + back : size - 1] = np.eye(back - 1)
    leaned = newer - older
    gained = T * part * (1 - part) / (4 * damping) * np.outer(leaned, leaned)
    return f, g, gained, -(part * older + (1 - part) * newer) / 2, damping / T - law.stiffness / 2


def outcome(law, damping, delay):
    """ "active" if the most a hand gets in so many moves is infinite, "passive" if it has settled."""
    f, g, gained, s, cost = game(law, damping, delay)
    p = np.zeros_like(f)
    for _ in range(MOVES):
        curvature = cost - g @ p @ g
        if curvature <= 0:
            return "active"
        slope = s + f.T @ p @ g
        after = gained + f.T @ p @ f + np.outer(slope, slope) / curvature
        if not np.abs(after - p).max(initial=0.0) > SETTLED * np.abs(after).max(initial=0.0):
            return "passive"
        p = after
    return "unknown"


def ample(environment, delay):
    """A device without encoder and Coulomb friction, damped more than enough."""
    device = zw.Device(damping=50, coulomb_friction=0, resolution=0, sample_period=T, delay=delay * T)
    return zw.check(device, environment, contact="kept")


@pytest.mark.parametrize("delay", DELAYS)
@pytest.mark.parametrize("name", LAWS)
def test_the_damping_that_is_required(name, delay):
    """Value iteration never contradicts the criterion, and meets it within a per cent from both sides."""
    environment, law = LAWS[name]
    required = ample(environment, delay).required_damping
    assert outcome(law, 0.99 * required, delay) == "active"
    assert outcome(law, (1 - 1e-6) * required, delay) != "passive"
    assert outcome(law, (1 + 1e-6) * required, delay) != "active"
    assert outcome(law, 1.01 * required, delay) == "passive"


@pytest.mark.parametrize("delay", DELAYS)
@pytest.mark.parametrize("name", ["spring", "damped", "window of 5", "one pole", "standard linear solid"])
def test_the_largest_stiffness(name, delay):
    """The same for the stiffness, at a given damping of the device."""
    environment, law = LAWS[name]
    device = zw.Device(damping="1.9", coulomb_friction=0, resolution=0, sample_period=T, delay=delay * T)
    largest = zw.check(device, environment, contact="kept").max_stiffness
    for share, expected in (("0.99", "passive"), ("1.01", "active")):
        assert outcome(law._replace(stiffness=largest * float(share)), 1.9, delay) == expected
        wall = environment.replace(stiffness=largest * float(share))
        assert zw.check(device, wall, contact="kept").outcome == expected
