"""Joint damping at the hand and back, and what walls of several coordinates need."""

from __future__ import annotations

import numpy as np
import numpy.typing as npt
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st

import zwidth as zw
from zwidth.model.arms import (
    damping_at,
    end_effector_damping,
    end_effector_friction,
    end_effector_inertia,
    end_effector_resolution,
    joint_margin,
    sampled_jacobian_damping,
    wall_need,
)
from zwidth.model.arms.joints import largest_scale, single_additions

Array = npt.NDArray[np.float64]
seeds = st.integers(0, 2**32 - 1)


def _symmetric(rng: np.random.Generator, n: int, definite: bool) -> Array:
    m = rng.normal(size=(n, n))
    return np.asarray(m @ m.T if definite else m + m.T)


@given(seeds, st.sampled_from([1, 2, 3, 6]))
@settings(deadline=None)
def test_square_arms_go_both_ways(seed: int, n: int) -> None:
    """δ = J⁻ᵀ δ_m J⁻¹, and Jᵀ δ J gives δ_m back."""
    rng = np.random.default_rng(seed)
    j = rng.normal(size=(n, n)) + 3 * np.eye(n)
    delta_m = _symmetric(rng, n, True) + 0.1 * np.eye(n)
    inverse = np.linalg.inv(j)
    delta = end_effector_damping(j, delta_m)
    size = np.linalg.norm(delta_m) * np.linalg.cond(j) ** 2 * np.linalg.cond(delta_m)
    assert delta == pytest.approx(
        inverse.T @ delta_m @ inverse, abs=1e-12 * size * np.linalg.norm(inverse) ** 2
    )
    assert j.T @ delta @ j == pytest.approx(delta_m, abs=1e-11 * size)
    assert end_effector_damping(j, delta_m, as_published=True) == pytest.approx(delta, abs=1e-10 * size)


@given(seeds)
@settings(deadline=None)
def test_a_redundant_arm_feels_less_than_the_pseudoinverse_says(seed: int) -> None:
    """(J δ_m⁻¹ Jᵀ)⁻¹ ⪯ (Jᵀ)†δ_m J†, with equality for equal joints; the design rule goes with the left."""
    rng = np.random.default_rng(seed)
    j, b = rng.normal(size=(2, 4)), rng.uniform(0.1, 3, 4)
    least, published = end_effector_damping(j, b), end_effector_damping(j, b, as_published=True)
    assert np.linalg.eigvalsh(published - least)[0] >= -1e-9 * np.linalg.norm(published)
    equal = np.full(4, 0.7)
    assert end_effector_damping(j, equal) == pytest.approx(end_effector_damping(j, equal, as_published=True))
    v = rng.normal(size=2)
    free = np.linalg.svd(j)[2][2:].T
    rates = np.linalg.pinv(j) @ v
    best = rates - free @ np.linalg.solve(free.T @ np.diag(b) @ free, free.T @ (b * rates))
    assert best @ (b * best) == pytest.approx(v @ least @ v)
    assert joint_margin(j, b, 0.999 * least)[0] > 0
    assert joint_margin(j, b, 1.001 * least)[0] < 0


@given(seeds)
@settings(deadline=None)
def test_more_joint_damping_never_hurts(seed: int) -> None:
    """The margin and the damping at the hand grow with δ_m."""
    rng = np.random.default_rng(seed)
    j, b, more = rng.normal(size=(3, 3)), rng.uniform(0.1, 1, 3), rng.uniform(0, 1, 3)
    need = _symmetric(rng, 3, True)
    before, after = joint_margin(j, b, need)[0], joint_margin(j, b + more, need)[0]
    assert after >= before - 1e-12 * np.linalg.norm(j) ** 2 * np.linalg.norm(need)
    gained = end_effector_damping(j, b + more) - end_effector_damping(j, b)
    assert np.linalg.eigvalsh(gained)[0] >= -1e-8 * np.linalg.norm(gained)


def test_singular_positions_make_the_rule_easier() -> None:
    """An outstretched arm cannot move outwards: the need of a wall across that direction vanishes."""
    arm = zw.arms.PlanarChain(links=(0.1, 0.1), damping=(0.01, 0.01))
    across = 0.25 * np.diag([1.0, 0.0])  # a wall met along the links, which point along x
    margins = [joint_margin(arm.jacobian([0.0, q]), arm.damping, across)[0] for q in (1.2, 0.6, 0.1, 0.0)]
    assert margins == sorted(margins)
    assert margins[-1] == pytest.approx(0.01)
    delta = end_effector_damping(arm.jacobian([0.0, 0.0]), arm.damping)
    assert delta[0] == pytest.approx(0, abs=1e-9)


@given(seeds, st.integers(0, 4))
@settings(deadline=None, max_examples=40)
def test_the_need_of_a_spring_by_sweeping_frequencies(seed: int, d: int) -> None:
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
@settings(deadline=None, max_examples=60)
def test_the_need_of_a_spring_and_damper_by_sweeping_frequencies(seed: int) -> None:
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


def test_the_frequency_condition_is_that_of_sampled_motions() -> None:
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
def test_one_joint_needs_what_check_needs(delay: int) -> None:
    """The paddle of r: b_θ = r² b, where zw.check has its limit; both sides of it."""
    radius, damping = 0.065659, 0.0011
    arm = zw.arms.PlanarChain(links=(radius,), damping=(damping,), joint_range=((-0.5, 0.5),))
    handle = zw.rotary(damping=damping, rate=1000, handle_radius=radius, delay=delay * 0.001)
    limit = zw.workspace(arm, zw.Wall(100), rate=1000, delay=delay * 0.001, points=10).largest_stiffness
    assert limit == pytest.approx(2 * damping / radius**2 / 0.001 / (2 * delay + 1))
    for factor, outcome in ((1 - 1e-6, "passive"), (1 + 1e-6, "active")):
        assert zw.check(handle, zw.Wall(limit * factor)).outcome == outcome


def test_additions_are_the_smallest() -> None:
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


def test_the_largest_scale_is_the_largest() -> None:
    """base − s·load is singular at s; ∞ without load, 0 where the base is not positive."""
    rng = np.random.default_rng(4)
    base, load = _symmetric(rng, 3, True), _symmetric(rng, 3, True)
    s = largest_scale(base, load)
    assert np.linalg.eigvalsh(base - s * load)[0] == pytest.approx(0, abs=1e-9)
    assert largest_scale(base, 0 * load) == np.inf
    assert largest_scale(base - 100 * np.eye(3), load) == 0


def test_encoder_steps_and_friction_at_the_hand() -> None:
    """The zonotope and the polytope by trying all corners and many directions."""
    rng = np.random.default_rng(6)
    j, steps, friction = rng.normal(size=(2, 3)), rng.uniform(0.1, 1, 3), rng.uniform(0.1, 1, 3)
    corners = np.array(np.meshgrid(*[[0.0, s] for s in steps])).reshape(3, -1)
    readings = j @ corners
    apart = np.linalg.norm(readings[:, :, None] - readings[:, None, :], axis=0).max()
    assert end_effector_resolution(j, steps) == pytest.approx(apart)
    u = np.array([0.6, -0.8])
    assert end_effector_resolution(j, steps, u) == pytest.approx(np.ptp(u @ readings))
    turned = np.linspace(0, np.pi, 20001)
    directions = np.stack([np.cos(turned), np.sin(turned)], axis=-1)
    held = (friction / np.abs(directions @ j)).min(axis=-1)
    assert end_effector_friction(j, friction) == pytest.approx(held.min(), rel=1e-6)
    assert end_effector_friction(j, friction, directions[77]) == pytest.approx(held[77])


def test_the_mass_at_the_hand() -> None:
    """A point mass at the end of the links weighs the same there."""
    arm = zw.arms.PlanarChain(links=(0.1, 0.12), damping=(1, 1))
    j = arm.jacobian([0.3, 1.1])
    assert end_effector_inertia(j, 0.3 * j.T @ j) == pytest.approx(0.3 * np.eye(2))


def test_a_held_jacobian_costs_at_most_its_bound() -> None:
    """F·(Δp − J Δq) ≤ h F |Δq|²/2 with the curvature of the arm, for random steps of a chain."""
    arm = zw.arms.PlanarChain(links=(0.1, 0.12, 0.05), damping=(1, 1, 1))
    curvature, rng = arm.curvature, np.random.default_rng(8)
    most = 0.0
    for _ in range(2000):
        q, step, force = rng.normal(size=3), rng.normal(size=3) * 0.05, rng.normal(size=2)
        gap = force @ (arm.forward(q + step) - arm.forward(q) - arm.jacobian(q) @ step)
        c = sampled_jacobian_damping(curvature, float(np.linalg.norm(force)), 0.001)
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
        (lambda: end_effector_damping(np.eye(2), [1, 0]), "damping > 0"),
        (lambda: sampled_jacobian_damping(-1, 1, 1), "≥ 0"),
    ],
)
def test_bad_input_has_one_clear_message(make: object, words: str) -> None:
    with pytest.raises(zw.InputError, match=words):
        make()  # type: ignore[operator]
