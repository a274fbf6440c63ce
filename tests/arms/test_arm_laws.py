"""Joint damping at the hand and back, what walls of several coordinates need; an arm that is simulated."""

from __future__ import annotations

from collections.abc import Callable

import numpy as np
import numpy.typing as npt
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st
from scipy.integrate import solve_ivp

import zwidth as zw
from zwidth.model.arms import PlanarChain, damping_at, joint_margin, wall_need
from zwidth.model.arms.joints import largest_scale, single_additions

Array = npt.NDArray[np.float64]
seeds = st.integers(0, 2**32 - 1)


def _symmetric(rng: np.random.Generator, n: int, definite: bool) -> Array:
    m = rng.normal(size=(n, n))
    return np.asarray(m @ m.T if definite else m + m.T)


@given(seeds, st.sampled_from([1, 2, 3, 6]))
def test_square_arms_go_both_ways(seed, n):
    """δ = J⁻ᵀ δ_m J⁻¹, and Jᵀ δ J gives δ_m back."""
    rng = np.random.default_rng(seed)
    j = rng.normal(size=(n, n)) + 3 * np.eye(n)
    delta_m = _symmetric(rng, n, True) + 0.1 * np.eye(n)
    inverse = np.linalg.inv(j)
    delta = zw.arms.end_effector_damping(j, delta_m)
    size = np.linalg.norm(delta_m) * np.linalg.cond(j) ** 2 * np.linalg.cond(delta_m)
    assert delta == pytest.approx(
        inverse.T @ delta_m @ inverse, abs=1e-12 * size * np.linalg.norm(inverse) ** 2
    )
    assert j.T @ delta @ j == pytest.approx(delta_m, abs=1e-11 * size)
    assert zw.arms.end_effector_damping(j, delta_m, as_published=True) == pytest.approx(
        delta, abs=1e-10 * size
    )


@given(seeds)
def test_a_redundant_arm_feels_less_than_the_pseudoinverse_says(seed):
    """(J δ_m⁻¹ Jᵀ)⁻¹ ⪯ (Jᵀ)†δ_m J†, with equality for equal joints; the design rule goes with the left."""
    rng = np.random.default_rng(seed)
    j, b = rng.normal(size=(2, 4)), rng.uniform(0.1, 3, 4)
    damping = zw.arms.end_effector_damping
    least, published = damping(j, b), damping(j, b, as_published=True)
    assert np.linalg.eigvalsh(published - least)[0] >= -1e-9 * np.linalg.norm(published)
    equal = np.full(4, 0.7)
    assert damping(j, equal) == pytest.approx(damping(j, equal, as_published=True))
    v = rng.normal(size=2)
    free = np.linalg.svd(j)[2][2:].T
    rates = np.linalg.pinv(j) @ v
    best = rates - free @ np.linalg.solve(free.T @ np.diag(b) @ free, free.T @ (b * rates))
    assert best @ (b * best) == pytest.approx(v @ least @ v)
    assert joint_margin(j, b, 0.999 * least)[0] > 0
    assert joint_margin(j, b, 1.001 * least)[0] < 0


def test_singular_positions_make_the_rule_easier():
    """An outstretched arm cannot move outwards: the need of a wall across that direction vanishes."""
    arm = PlanarChain(links=(0.1, 0.1), damping=(0.01, 0.01))
    across = 0.25 * np.diag([1.0, 0.0])  # a wall met along the links, which point along x
    margins = [joint_margin(arm.jacobian([0.0, q]), arm.damping, across)[0] for q in (1.2, 0.6, 0.1, 0.0)]
    assert margins == sorted(margins)
    assert margins[-1] == pytest.approx(0.01)
    delta = zw.arms.end_effector_damping(arm.jacobian([0.0, 0.0]), arm.damping)
    assert delta[0] == pytest.approx(0, abs=1e-9)


@given(seeds, st.integers(0, 4))
def test_the_need_of_a_spring_by_sweeping_frequencies(seed, d):
    """δ ⪰ (2d+1)KT/2: just above, no frequency fails; just below, low ones do."""
    rng = np.random.default_rng(seed)
    k = 500 * _symmetric(rng, 3, True)
    wall, t = zw.arms.MatrixWall(k), 0.001
    (need,) = wall_need(wall, t, d).matrices
    thetas = np.linspace(1e-3, np.pi, 400)
    sweep = [np.linalg.eigvalsh(need - damping_at(x, wall, t, d))[0] for x in thetas]
    assert min(sweep) >= -1e-12 * np.linalg.norm(need)
    short = [np.linalg.eigvalsh(0.99 * need - damping_at(x, wall, t, d))[0] for x in thetas]
    assert min(short) < 0


@given(seeds)
@settings(max_examples=60)
def test_the_need_of_a_spring_and_damper_by_sweeping_frequencies(seed):
    """KT/2 ± B for any symmetric B: the two ends of the cosine are the worst."""
    rng = np.random.default_rng(seed)
    k, b = 300 * _symmetric(rng, 3, True), 0.2 * _symmetric(rng, 3, False)
    delta = _symmetric(rng, 3, True) + rng.uniform(-0.5, 0.5) * np.eye(3)
    wall, t = zw.arms.MatrixWall(k, b), 0.001
    need = wall_need(wall, t)
    assert need.exact
    ends = min(np.linalg.eigvalsh(delta - matrix)[0] for matrix in need.matrices)
    thetas = np.linspace(1e-6, np.pi, 300)
    sweep = min(np.linalg.eigvalsh(delta - damping_at(x, wall, t))[0] for x in thetas)
    assert sweep == pytest.approx(ends, abs=1e-9 * (np.linalg.norm(k) * t + np.linalg.norm(b)))
    envelope = need.stiffness_share + need.bound
    assert all(np.linalg.eigvalsh(envelope - m)[0] >= -1e-12 for m in need.matrices)


def test_the_frequency_condition_is_that_of_sampled_motions():
    """Energy of a closed cycle, summed sample by sample, against R(θ)."""
    rng = np.random.default_rng(11)
    k, b, t = 400 * _symmetric(rng, 2, True), _symmetric(rng, 2, False), 0.001
    wall = zw.arms.MatrixWall(k, b)
    for samples, d in ((2, 0), (7, 0), (9, 1), (12, 3)):
        theta = 2 * np.pi / samples
        w = rng.normal(size=2) + 1j * rng.normal(size=2)
        y = np.real(w[None, :] * np.exp(1j * theta * np.arange(samples))[:, None])
        late, later = np.roll(y, d, axis=0), np.roll(y, d + 1, axis=0)
        work = (((late @ k) + (late - later) / t @ b) * (np.roll(y, -1, axis=0) - y)).sum()
        step = w * (np.exp(1j * theta) - 1)
        # At the Nyquist frequency the sine part of w is not sampled.
        power = samples / 2 if samples > 2 else samples
        step = step if samples > 2 else np.real(step)
        expected = -power / t * np.real(step.conj() @ damping_at(theta, wall, t, d, 2) @ step)
        assert work == pytest.approx(expected, rel=1e-9)


@pytest.mark.parametrize("delay", [0, 1, 3])
def test_one_joint_needs_what_check_needs(delay):
    """The paddle of r: b_θ = r² b, where zw.check has its limit; both sides of it."""
    radius, damping = 0.065659, 0.0011
    arm = PlanarChain(links=(radius,), damping=(damping,), joint_range=((-0.5, 0.5),))
    handle = zw.rotary(damping=damping, rate=1000, handle_radius=radius, delay=delay * 0.001)
    limit = zw.workspace(arm, zw.Wall(100), rate=1000, delay=delay * 0.001, points=10).largest_stiffness
    assert limit == pytest.approx(2 * damping / radius**2 / 0.001 / (2 * delay + 1))
    for factor, outcome in ((1 - 1e-6, "passive"), (1 + 1e-6, "active")):
        assert zw.check(handle, zw.Wall(limit * factor)).outcome == outcome


def test_additions_are_the_smallest():
    """Just enough makes the matrix positive, a little less does not; ∞ where one joint is not enough."""
    rng = np.random.default_rng(2)
    matrices = rng.normal(size=(200, 3, 3))
    matrices = matrices + np.swapaxes(matrices, -1, -2) + 1.5 * np.eye(3)
    additions, finite = single_additions(matrices), 0
    for matrix, row in zip(matrices, additions, strict=True):
        for i, t in enumerate(row):
            unit = np.zeros((3, 3))
            unit[i, i] = 1
            if np.isinf(t):
                assert np.linalg.eigvalsh(matrix + 1e6 * unit)[0] <= 0
            elif t == 0:
                assert np.linalg.eigvalsh(matrix)[0] >= -1e-12
            else:
                finite += 1
                assert np.linalg.eigvalsh(matrix + (t + 1e-9 * (1 + t)) * unit)[0] >= -1e-9
                assert np.linalg.eigvalsh(matrix + 0.999 * t * unit)[0] < 0
    assert finite > 10


def test_the_largest_scale_is_the_largest():
    """base − s·load is singular at s; ∞ without load, 0 where the base is not positive."""
    rng = np.random.default_rng(4)
    base, load = _symmetric(rng, 3, True), _symmetric(rng, 3, True)
    s = largest_scale(base, load)
    assert np.linalg.eigvalsh(base - s * load)[0] == pytest.approx(0, abs=1e-9)
    assert largest_scale(base, 0 * load) == np.inf
    assert largest_scale(base - 100 * np.eye(3), load) == 0


def test_encoder_steps_and_friction_at_the_hand():
    """The zonotope and the polytope by trying all corners and many directions."""
    rng = np.random.default_rng(6)
    j, steps, friction = rng.normal(size=(2, 3)), rng.uniform(0.1, 1, 3), rng.uniform(0.1, 1, 3)
    corners = np.array(np.meshgrid(*[[0.0, s] for s in steps])).reshape(3, -1)
    readings = j @ corners
    apart = np.linalg.norm(readings[:, :, None] - readings[:, None, :], axis=0).max()
    assert zw.arms.end_effector_resolution(j, steps) == pytest.approx(apart)
    u = np.array([0.6, -0.8])
    assert zw.arms.end_effector_resolution(j, steps, u) == pytest.approx(np.ptp(u @ readings))
    turned = np.linspace(0, np.pi, 20001)
    directions = np.stack([np.cos(turned), np.sin(turned)], axis=-1)
    held = (friction / np.abs(directions @ j)).min(axis=-1)
    assert zw.arms.end_effector_friction(j, friction) == pytest.approx(held.min(), rel=1e-6)
    assert zw.arms.end_effector_friction(j, friction, directions[77]) == pytest.approx(held[77])


def test_the_mass_at_the_hand():
    """A point mass at the end of the links weighs the same there."""
    arm = PlanarChain(links=(0.1, 0.12), damping=(1, 1))
    j = arm.jacobian([0.3, 1.1])
    assert zw.arms.end_effector_inertia(j, 0.3 * j.T @ j) == pytest.approx(0.3 * np.eye(2))


def test_a_held_jacobian_costs_at_most_its_bound():
    """F·(Δp − J Δq) ≤ h F |Δq|²/2 with the curvature of the arm, for random steps of a chain."""
    arm = PlanarChain(links=(0.1, 0.12, 0.05), damping=(1, 1, 1))
    curvature, rng = arm.curvature, np.random.default_rng(8)
    most = 0.0
    for _ in range(2000):
        q, step, force = rng.normal(size=3), rng.normal(size=3) * 0.05, rng.normal(size=2)
        gap = force @ (arm.forward(q + step) - arm.forward(q) - arm.jacobian(q) @ step)
        c = zw.arms.sampled_jacobian_damping(curvature, float(np.linalg.norm(force)), 0.001)
        assert gap <= c * step @ step / 0.001
        most = max(most, gap / (c * step @ step / 0.001))
    assert most > 0.3


@pytest.mark.parametrize(
    ("make", "words"),
    [
        (lambda: zw.arms.MatrixWall([[1, 2], [0, 1]]), "symmetric"),
        (lambda: zw.arms.MatrixWall([[1, 2], [2, 1]]), "no negative eigenvalue"),
        (lambda: zw.arms.MatrixWall([[1, 0]]), "square"),
        (lambda: zw.arms.MatrixWall([[np.nan]]), "finite"),
        (lambda: zw.arms.MatrixWall(np.eye(2), np.eye(3)), "both are n × n"),
        (lambda: wall_need(zw.arms.MatrixWall(np.eye(2)), 0.001), "3 × 3 matrices"),
        (lambda: wall_need(zw.Wall(1, 1, clamped=True), 0.001), "clamped"),
        (lambda: wall_need(zw.Wall(1, 1, zw.rendering.Window(3)), 0.001), "backward difference"),
        (lambda: zw.arms.end_effector_damping(np.eye(2), [1, 0]), "damping > 0"),
        (lambda: zw.arms.sampled_jacobian_damping(-1, 1, 1), "≥ 0"),
    ],
)
def test_bad_input_has_one_clear_message(make, words):
    with pytest.raises(zw.InputError, match=words):
        make()


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
    both, second = M2 * L2**2 + coupling * c, M2 * L2**2
    mass = np.array([[(M1 + M2) * L1**2 + second + 2 * coupling * c, both], [both, second]])
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


def test_below_the_limit_no_hand_takes_energy_out():
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


def test_above_the_limit_a_hand_takes_energy_out():
    """Back and forth in the direction that fails at the start, at 1.6 of the stiffness that holds there."""
    here, direction = _worst_direction()
    path = _path(0.002 * direction * (-1.0) ** np.arange(30)[:, None])
    over, under = (_energy(factor * here, path, 30)[0] for factor in (1.6, 0.8))
    assert over < 0 < under
