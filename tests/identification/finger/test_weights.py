"""Sums over samples that are integrals, where the force is held between them."""

from __future__ import annotations

import numpy as np
import pytest

from zwidth.data.identification.finger.means import weights


def _motion(rng, samples, fine):
    """A motion under a force held over each sample, as read, and as it is between."""
    acceleration = rng.normal(size=samples)
    v = np.concatenate([[0.3], 0.3 + np.cumsum(acceleration)])
    x = np.concatenate([[0.7], 0.7 + np.cumsum((v[:-1] + v[1:]) / 2)])
    u = (np.arange(fine) + 0.5) / fine
    inside_v = v[:-1, None] + acceleration[:, None] * u
    inside_x = x[:-1, None] + v[:-1, None] * u + acceleration[:, None] * u * u / 2
    return acceleration, x, inside_v, inside_x, u


@pytest.mark.parametrize("piece", [4, 10])
def test_sums_are_the_integrals_of_a_held_motion(piece):
    """∫φẍ and ∫φx to rounding of the integration by midpoints; ∫φẋ to the part that smoothness leaves."""
    rng = np.random.default_rng(piece)
    shape = weights(piece, 0.0)
    samples = 2 * shape.reach
    acceleration, x, inside_v, inside_x, u = _motion(rng, samples, 400)
    at = np.arange(samples)[:, None] + u
    place = np.arange(samples + 1)
    # the pulse is the force's weights with their correction undone: solve δ²/12 + 1
    matrix = np.eye(samples + 1) * (10 / 12) + (np.eye(samples + 1, k=1) + np.eye(samples + 1, k=-1)) / 12
    pulse = np.interp(at, place, np.linalg.solve(matrix, shape.force))
    integral = lambda values: (pulse * values).mean(axis=1).sum()  # noqa: E731
    assert shape.motion[0] @ x == pytest.approx(integral(acceleration[:, None] + 0 * u), abs=1e-5)
    assert shape.motion[2] @ x == pytest.approx(integral(inside_x), abs=1e-5)
    assert shape.motion[1] @ x == pytest.approx(integral(inside_v), abs=0.02)


@pytest.mark.parametrize("delay", [0.0, 0.4, 1.0, 2.7])
def test_held_forces_count_from_when_they_act(delay):
    """The weights of a held force are the pulse's parts of the time from its instant to the next one's."""
    shape = weights(6, delay)
    assert shape.held.sum() == pytest.approx(1.0, abs=1e-12)
    centre = np.arange(-shape.reach - shape.lag, shape.reach + 1) + delay + 0.5
    assert shape.held @ centre == pytest.approx(0.0, abs=1e-12)
    assert shape.steps.sum() == pytest.approx(0.0, abs=1e-12)
    assert shape.steps @ centre == pytest.approx(1.0, abs=1e-12)


def test_the_samples_of_either_parity_see_the_same_motion():
    """Cubics come out alike from the even and from the odd samples."""
    shape = weights(8, 0.0)
    k = np.arange(-shape.reach, shape.reach + 1)
    for power in range(4):
        for column in shape.motion:
            halves = [2 * (column * k.astype(float) ** power)[(k & 1) == parity].sum() for parity in (0, 1)]
            assert halves[0] == pytest.approx(halves[1], abs=1e-9)
