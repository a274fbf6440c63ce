"""The boundary of stability in the plane of walls, by two roads."""

import numpy as np
import pytest

import zwidth as zw
from zwidth.model.operator import Finger

PADDLE = zw.catalogue.device("haptic-paddle")
BARE = zw.Device(mass=0.036, damping=0, rate=1000)
K_SCALE, B_SCALE = 1e-6 / 0.036, 1e-3 / 0.036


def test_the_curve_without_delay_is_the_closed_form():
    """κ = 2β(2 − β)/(2 + β) on every point that bounds; the largest near κ = 0.68629 at β = 0.82843."""
    found = zw.maps.stability_boundary(BARE, points=4000)
    here = found["bounds"].values & (found["stiffness"].values > 1e-3)
    kappa = found["stiffness"].values[here] * K_SCALE
    beta = found["virtual_damping"].values[here] * B_SCALE
    assert len(kappa) > 1000
    assert kappa == pytest.approx(2 * beta * (2 - beta) / (2 + beta), abs=1e-12)
    assert kappa.max() == pytest.approx(12 - 8 * np.sqrt(2), abs=1e-5)
    assert beta[kappa.argmax()] == pytest.approx(2 * np.sqrt(2) - 2, abs=1e-2)


def test_one_sample_of_delay_in_the_plane_of_salcudean_and_vlaar():
    """k = T²K/2m, b = TB/2m: z²(z − 1)² + (z + 1)[k z + b (z − 1)] has its outermost root on the circle."""
    found = zw.maps.stability_boundary(BARE, delay=0.001, points=400)
    here = found["bounds"].values & (found["stiffness"].values > 1)
    assert here.sum() > 50
    walls = (found[name].values[here][::5] for name in ("stiffness", "virtual_damping"))
    for stiffness, damping in zip(*walls, strict=True):
        k, b = stiffness * K_SCALE / 2, damping * B_SCALE / 2
        p = np.polyadd(np.polymul([1, 0, 0], [1, -2, 1]), np.polymul([1, 1], [k + b, -b]))
        assert np.abs(np.roots(p)).max() == pytest.approx(1, abs=1e-7)


@pytest.mark.parametrize("delay", [0, 0.0003, 0.001, 0.0025, 0.004])
@pytest.mark.parametrize("hand", [None, Finger()])
def test_both_sides_of_the_curve(delay, hand):
    """Bisection's answer: a thousandth below a bounding point is stable, a thousandth above is not."""
    found = zw.maps.stability_boundary(PADDLE, hand, delay, points=150)
    device = PADDLE.replace(delay=delay)
    curve = found.isel(point=found["frequency"].values < 499)
    here = curve["bounds"].values & (curve["stiffness"].values > 100) & (curve["virtual_damping"].values > 0)
    assert here.sum() >= 5
    stiffness, damping = (curve[name].values[here][::2] for name in ("stiffness", "virtual_damping"))
    for k, b in zip(stiffness, damping, strict=True):
        # the region is convex enough here: towards (0, B of the top) is inside
        top = float(curve["virtual_damping"].values[here][curve["stiffness"].values[here].argmax()])
        inward = zw.Wall(k * 0.999, b + 0.001 * (top - b))
        outward = zw.Wall(k * 1.001, max(b - 0.001 * (top - b), 0))
        assert zw.stability.coupled_stability(device, inward, hand).outcome == "stable"
        assert zw.stability.coupled_stability(device, outward, hand).outcome == "unstable"


def test_frequencies_are_those_of_the_poles():
    """At a bounding point the pole nearest to the circle has the frequency that stands there."""
    found = zw.maps.stability_boundary(PADDLE, Finger(), points=40)
    for n in np.flatnonzero(found["bounds"].values[:40] & (found["stiffness"].values[:40] > 100)):
        one = found.isel(point=n)
        wall = zw.Wall(one["stiffness"].item(), one["virtual_damping"].item())
        there = zw.stability.coupled_stability(PADDLE, wall, Finger())
        assert there.frequency == pytest.approx(one["frequency"].item(), rel=1e-6)
        assert there.spectral_radius == pytest.approx(1, abs=1e-8)


@pytest.mark.parametrize(
    ("device", "hand", "points", "message"),
    [
        (PADDLE, zw.stability.HandImpedance(mass=(0, 1)), 9, "one device and one hand"),
        (zw.Device(damping=1, rate=1000), None, 9, "the device.s mass"),
        (PADDLE, None, 1, "two ends"),
    ],
    ids=["an interval", "no mass", "one point"],
)
def test_what_has_no_boundary(device, hand, points, message):
    with pytest.raises(zw.InputError, match=message):
        zw.maps.stability_boundary(device, hand, points=points)
