"""The transformed blocks: the delay sum, the device's excess, and the linear criterion by another road."""

from __future__ import annotations

from fractions import Fraction

import numpy as np
import pytest
from scipy.signal import cont2discrete

import zwidth as zw
from zwidth.errors import InputError

T = Fraction(1, 1000)
WALLS = [
    zw.Wall(220, "0.03"),
    zw.VirtualCoupling(300, "0.05", zw.Wall(900, "0.2")),
    zw.PulseTransferFunction([400, -250], [1, "-0.6"]),
]


def device(damping, delay=0, mass="0.04"):
    """A device at 1 kHz."""
    return zw.Device(mass=mass, damping=damping, rate=1000, delay=delay * T)


def test_the_delay_sum_is_the_difference_it_stands_for():
    """(1 − z⁻¹)/T · A = (1 − z^{−d−1})/2α, and A(1) = (d + 1) T/2α."""
    hertz = np.array([0.7, 33.0, 240.0, 500.0])
    late = np.exp(-2j * np.pi * hertz / 1000)
    a = zw.coupling.delay_sum(hertz, "0.15", T, 3 * T)
    assert np.allclose((1 - late) * 1000 * a, (1 - late**4) / 0.3, rtol=1e-12)
    assert zw.coupling.delay_sum([0.0], "0.15", T, 3 * T)[0] == pytest.approx(4e-3 / 0.3)


@pytest.mark.parametrize("delay", [0, 1, 4])
def test_the_device_gains_what_the_lemma_says(delay):
    """Re{1/Ĝ} ≥ b at every frequency, and is b where the device follows the force at once."""
    heavy = zw.coupling.transformed_blocks(device("0.15", delay), WALLS[0])
    assert heavy["excess"].min() >= 0.15 * (1 - 1e-9)
    assert heavy["excess"].max() > 0.3
    light = zw.coupling.transformed_blocks(device("0.15", delay, None), WALLS[0])
    assert np.allclose(light["excess"], 0.15, rtol=1e-9)


def test_the_mean_velocity_is_that_of_the_held_force():
    """Ĝ less its feedthrough is (x(k+1) − x(k))/(T F) of a zero-order hold, by scipy."""
    hertz = np.array([3.0, 71.0, 455.0])
    blocks = zw.coupling.transformed_blocks(device("0.15"), WALLS[0], hertz)
    numerator, denominator, _ = cont2discrete(([1.0], [0.04, 0.15, 0.0]), 1e-3)
    z = np.exp(2j * np.pi * hertz / 1000)
    moved = np.polyval(numerator.ravel(), z) / np.polyval(denominator, z) * (z - 1) / 1e-3
    assert np.allclose(blocks["device"], moved / z + (1 - 1 / z) / 0.3, rtol=1e-9)


@pytest.mark.parametrize("delay", [0, 1, 2])
@pytest.mark.parametrize("environment", WALLS)
def test_the_shortage_reaches_b_just_at_the_need(environment, delay):
    """Above the need that `check` finds, −Re Ĉ < b at all frequencies; below, it exceeds b at one."""
    verdict = zw.check(device(1, delay), environment, contact="kept")
    need = verdict.required_damping
    above = zw.coupling.transformed_blocks(device(need * 1.001, delay), environment)
    below = zw.coupling.transformed_blocks(device(need * 0.99, delay), environment)
    assert np.all(above["shortage"] < need * 1.001)
    assert (below["shortage"] > need * 0.99).any()


@pytest.mark.parametrize("delay", [0, 1, 3])
def test_the_transformation_loses_nothing(delay):
    """Σ f̂ŷ + b ŷ² = Σ [z^{−d−1}f v̄ + b v̄²] − ¼ Σ f²/b over the forces on their way, for any f and v̄."""
    random = np.random.default_rng(delay)
    f, v, b = random.normal(0, 3, 50), random.normal(0, 1, 50), 0.37
    late = np.concatenate([np.zeros(delay + 1), f])[:50]
    y = v - (f - late) / (2 * b)
    on_their_way = np.sum(f[50 - delay - 1 :] ** 2) / (4 * b)
    assert np.sum(f * y + b * y**2) == pytest.approx(np.sum(late * v + b * v**2) - on_their_way, rel=1e-12)


def test_what_does_not_fit_is_refused():
    """No damping, parts of a sample, frequencies beyond half the rate."""
    with pytest.raises(InputError, match="damping"):
        zw.coupling.transformed_blocks(device(0), WALLS[0])
    with pytest.raises(InputError, match="whole number"):
        zw.coupling.transformed_blocks(device(1, Fraction(1, 3)), WALLS[0])
    with pytest.raises(InputError, match="half the rate"):
        zw.coupling.transformed_blocks(device(1), WALLS[0], [501.0])
    with pytest.raises(InputError, match="damping"):
        zw.coupling.delay_sum([1.0], 0, T)
