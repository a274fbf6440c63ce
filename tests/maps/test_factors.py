"""The 2⁴ design: effects against areas that have a closed form."""

import pytest

import zwidth as zw

PADDLE = zw.catalogue.device("haptic-paddle")
FINE = {"cells": (20, 20), "hands": {}}  # what is passive alone


def test_effects_are_differences_of_mean_areas():
    """With a fine encoder the passive triangle is b²/T: its effects follow from four numbers."""
    found = zw.maps.z_width_factors(
        PADDLE, (0, 1200), (0, 0.4), rate=(1000, 2000), damping=(0.15, 0.3), resolution=(1e-6, 2e-6), **FINE
    )
    area = found["area"].sel(region="passive")
    corner = {  # cut off at B = 0.4 and K = 1200 only where 2b/T = 1200: nowhere
        ("low", "low"): 0.15**2 * 1000, ("low", "high"): 0.3**2 * 1000,
        ("high", "low"): 0.15**2 * 2000, ("high", "high"): 0.3**2 * 2000,
    }  # fmt: skip
    for (rate, damping), expected in corner.items():
        assert area.sel(rate=rate, damping=damping).values == pytest.approx(expected, rel=0.02)
    effect = found["effect"].sel(region="passive")
    low, tall, fast, both = corner.values()
    assert effect.sel(term="damping").item() == pytest.approx((tall + both - low - fast) / 2, rel=0.03)
    assert effect.sel(term="rate").item() == pytest.approx((fast + both - low - tall) / 2, rel=0.03)
    assert effect.sel(term="rate × damping").item() == pytest.approx((both - tall - fast + low) / 2, rel=0.05)
    assert effect.sel(term="resolution").item() == 0
    assert effect.sizes["term"] == 15


def test_what_colgate_and_brown_found():
    """Damping and rate enlarge what is stable; resolution leaves it as it is."""
    found = zw.maps.z_width_factors(
        PADDLE, (0, 4000), (0, 20), rate=("100 Hz", "1 kHz"), damping=(0.15, 1.5), resolution=(2e-4, 2e-6),
        cells=(24, 24), hands={"none": None},
    )  # fmt: skip
    effect = found["effect"].sel(region="stable_none")
    assert effect.sel(term="rate").item() > 0
    assert effect.sel(term="damping").item() > 0
    assert effect.sel(term="resolution").item() == 0
    finer = found["effect"].sel(region="quiet", term="resolution").item()
    assert finer > 0


def test_two_equal_levels_are_refused():
    """An effect is a difference."""
    levels = {"rate": (1000, "1 kHz"), "damping": (1, 2), "resolution": (0, 1e-5)}
    with pytest.raises(zw.InputError, match="twice"):
        zw.maps.z_width_factors(PADDLE, (0, 1), (0, 1), **levels)
