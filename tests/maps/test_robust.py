"""The boundary that holds for every hand within intervals."""

import numpy as np
import pytest

import zwidth as zw

PADDLE = zw.catalogue.device("haptic-paddle")
BOX = zw.stability.HandImpedance(mass=(0, 0.02), stiffness=(0, 1000), damping=(0, 3))


@pytest.mark.parametrize("delay", ["0", "0.0005"])
def test_both_sides(delay):
    """Below the one no hand of 60 is shaken; just above the other the named one is."""
    device = PADDLE.replace(delay=delay)
    found = zw.maps.robust_boundary(device, BOX, (2, 20), points=3)
    assert (found["guaranteed"] < found["refuted"]).all()
    assert (found["guaranteed"] > 0.995 * found["refuted"]).all()
    rng = np.random.default_rng(3)
    for b in found["virtual_damping"].values:
        at = found.sel(virtual_damping=b)
        wall = zw.Wall(float(at["guaranteed"]), float(b))
        proved = zw.stability.coupled_stability(device, wall, BOX)
        assert proved.outcome == "stable"
        assert proved.verify()
        for m, k, c in rng.uniform((0, 0, 0), (0.02, 1000, 3), (20, 3)):
            hand = zw.stability.HandImpedance(mass=m, stiffness=k, damping=c)
            assert zw.stability.coupled_stability(device, wall, hand).outcome == "stable"
        bare = device.replace(mass=float(at["mass"]), damping=float(at["damping"]))
        worst = zw.stability.HandImpedance(stiffness=float(at["hand_stiffness"]))
        above = zw.Wall(float(at["refuted"]) * (1 + 1e-9), float(b))
        assert zw.stability.coupled_stability(bare, above, worst).outcome == "unstable"


def test_a_certain_hand_has_no_gap():
    """Then both are the largest stable stiffness."""
    found = zw.maps.robust_boundary(PADDLE, zw.operators.Finger(), (1, 2), points=2)
    assert found["guaranteed"].values.tolist() == found["refuted"].values.tolist()
    expected = zw.stability.coupled_stability(PADDLE, zw.Wall(1, 1), zw.operators.Finger()).max_stiffness
    assert found["guaranteed"].values[0] == expected


def test_a_slow_swing_of_the_hand_bounds_the_wall():
    """A heavy, hardly damped handle on a spring: 0.02 rad a sample, where roots lie close.

    b + c = K (T/2 + delay) without virtual damping, but for terms of second order in (ωT).
    """
    device = zw.Device(mass=(0.176, 0.2563), damping=(0.141, 0.2275), sample_period=0.0005, delay=0.00085)
    hand = zw.stability.HandImpedance(mass=(0, 0.04746), stiffness=(0, 448.6), damping=(0, 1.37))
    found = zw.maps.robust_boundary(device, hand, (0, 0.2), points=2).isel(virtual_damping=0)
    assert found["refuted"] == pytest.approx(0.141 / 0.0011, rel=1e-2)
    assert found["guaranteed"] > 0.995 * found["refuted"]


def test_nothing_is_proved_where_a_hand_is_shaken_at_any_stiffness():
    """More virtual damping than an empty handle bears."""
    found = zw.maps.robust_boundary(PADDLE, BOX, (70, 200), points=2)
    assert np.isnan(found["guaranteed"].values[-1])


@pytest.mark.parametrize(
    ("ends", "points", "message"), [((2, 1), 3, "smaller to its larger"), ((1, 2), 1, "2 points")]
)
def test_bad_ranges(ends, points, message):
    with pytest.raises(zw.InputError, match=message):
        zw.maps.robust_boundary(PADDLE, BOX, ends, points=points)
