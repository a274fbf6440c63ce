"""Systems as harold 1.0.2 holds them, made here without it: its arrays and names."""

from types import SimpleNamespace

import control
import numpy as np
import pytest

import zwidth as zw
from zwidth.model.environment import as_environment


def transfer(num, den, period=None):
    """A Transfer: of one axis a row in a matrix, of several a list of rows of such."""
    if np.ndim(num) == 1:
        return SimpleNamespace(num=np.array([num]), den=np.array([den]), shape=(1, 1), SamplingPeriod=period)
    rows = [[[np.array([p]) for p in row] for row in side] for side in (num, den)]
    return SimpleNamespace(num=rows[0], den=rows[1], shape=(len(num), len(num[0])), SamplingPeriod=period)


def state(a, b, c, d, period=None):
    """A State: its matrices in small letters."""
    a, b, c, d = map(np.array, (a, b, c, d))
    return SimpleNamespace(a=a, b=b, c=c, d=d, shape=d.shape, SamplingPeriod=period)


A, B, C, D = [[0.0, 1.0], [-1.0, -2.0]], [[0.0], [1.0]], [[3.0, 1.0]], [[0.0]]


@pytest.mark.parametrize("system", [transfer([1.0, 3], [1.0, 2, 1]), state(A, B, C, D)])
def test_one_axis_in_continuous_time(system):
    """(s + 3)/(s + 1)²: as python-control's."""
    found = zw.ports.passivity_indices(system)
    theirs = zw.ports.passivity_indices(control.tf([1, 3], [1, 2, 1]))
    assert found.input.exact == theirs.input.exact
    assert found.sampled_damping is None


def test_a_gain_without_states():
    """Matrices of size 0 beside D."""
    assert (
        zw.ports.passivity_indices(
            state(np.zeros((0, 0)), np.zeros((0, 0)), np.zeros((0, 0)), [[5.0]])
        ).margin
        == 5
    )


def test_several_axes():
    """(1 3; −3 1)/(s + 1), one denominator for each entry."""
    found = zw.ports.passivity_indices(transfer([[[1.0], [3.0]], [[-3.0], [1.0]]], [[[1.0, 1.0]] * 2] * 2))
    theirs = zw.ports.passivity_indices(control.tf([[[1], [3]], [[-3], [1]]], [[[1, 1]] * 2] * 2))
    assert found.input.value == theirs.input.value


def test_a_sampled_law_is_an_environment_with_its_period():
    """350 − 200/z at 1 kHz, from position to force: what it needs and the verdict of check."""
    law = transfer([350.0, -200.0], [1.0, 0.0], 0.001)
    assert as_environment(law).sample_period == 1e-3
    assert zw.ports.passivity_indices(law).sampled_damping.required == 0.275
    assert zw.check(zw.Device(damping=0.3, rate=1000), law).passive
    assert zw.check(zw.Device(damping=0.27, rate=1000), law).outcome == "active"
