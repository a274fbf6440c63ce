"""The damping that H(z) of several axes needs: walls in closed form, and one axis at a time."""

from __future__ import annotations

from fractions import Fraction
from math import isclose

import control
import numpy as np
import pytest
from matrix_systems import matrix

import zwidth as zw

indices, PERIOD = zw.ports.passivity_indices, 0.001


def wall(stiffness, damping, late=0):
    """K + B (z − 1)/(T z), answered so many samples late."""
    k, b = np.array(stiffness), np.array(damping) * 1000
    den = [1, 0] + [0] * late
    return matrix(
        [[([x + y, -y], den) for x, y in zip(*row, strict=True)] for row in zip(k, b, strict=True)], PERIOD
    )


@pytest.mark.parametrize("damping", [[[0.2, 0.1], [0.1, 0.3]], [[0.2, 0.3], [0.3, 0.2]]])
def test_a_wall_of_two_axes(damping):
    """The largest eigenvalue of T K/2 ± B, of the theory of arms; B may be of both signs."""
    stiffness = np.array([[500, 100], [100, 300]])
    found = indices(wall(stiffness, damping)).sampled_damping
    ends = [np.linalg.eigvalsh(PERIOD * stiffness / 2 + sign * np.array(damping)).max() for sign in (1, -1)]
    assert isclose(found.required, max(ends), rel_tol=1e-12)
    assert isclose(found.frequency, 500)


@pytest.mark.parametrize("late", [0, 1, 3])
def test_a_late_spring_of_two_axes(late):
    """(2d + 1) T/2 times the largest stiffness, whether H(z) is late or the device."""
    stiffness = [[500, 100], [100, 300]]
    need = (2 * late + 1) * PERIOD / 2 * np.linalg.eigvalsh(stiffness).max()
    zero = np.zeros((2, 2))
    own = indices(wall(stiffness, zero, late)).sampled_damping
    device = zw.Device(damping="1.5", rate=1000, delay=Fraction(late, 1000))
    of_device = indices(wall(stiffness, zero), device).sampled_damping
    for found in (own, of_device):
        assert isclose(found.required, need, rel_tol=1e-12)
        assert isclose(found.frequency, 0 if late else 500, abs_tol=1e-9)
    assert of_device.margin == 1 - of_device.required / 1.5


def test_axes_that_do_not_act_on_each_other_need_the_larger_damping():
    parts, nothing = [([90, -60, 5], [1, -0.5, 0.25]), ([40, 30, -50], [1, 0.3, 0])], ([0], [1])
    alone = [indices(control.tf(*part, 0.002)).sampled_damping.required for part in parts]
    both = indices(matrix([[parts[0], nothing], [nothing, parts[1]]], 0.002)).sampled_damping
    assert isclose(both.required, max(alone), rel_tol=1e-12)


def test_a_stiffness_that_turns_cannot_be_damped():
    """K = (k κ; −κ k) pushes round: no damping is enough, however slow the circle."""
    found = indices(wall([[500, 100], [-100, 500]], np.zeros((2, 2)))).sampled_damping
    assert found.required is None
    assert found.margin is None
    assert "no damping" in found.describe()


@pytest.mark.parametrize(
    ("device", "message"),
    [({"rate": 2000}, "made for the sample period"), ({"rate": 1000, "delay": "0.0005"}, "whole samples")],
)
def test_devices_that_do_not_fit(device, message):
    with pytest.raises(zw.InputError, match=message):
        indices(wall([[500, 100], [100, 300]], np.zeros((2, 2))), zw.Device(damping=1, **device))


def test_a_discrete_system_without_a_rate_has_no_sampled_damping():
    """dt = True says that it is discrete and no more."""
    one, nothing = ([1], [1]), ([0], [1])
    assert indices(matrix([[one, nothing], [nothing, one]], True)).sampled_damping is None
