"""Short motions against laws with memory."""

from __future__ import annotations

import pytest

import zwidth as zw

PADDLE = zw.catalogue.device("haptic-paddle")
SLOW = {
    "solid of 10 s": zw.StandardLinearSolid(310, 20, 200),
    "Prony series to minutes": zw.GeneralizedMaxwell("605.2", [("44.43", "3.623"), ("20.31", 5978)], "zoh"),
    "rounded": zw.GeneralizedMaxwell("22.5", [("291.6", "4.233"), ("115.6", "94.16")], "matched"),
    "damped wall": zw.Wall(100, "0.2"),
}


@pytest.mark.parametrize("delay", ["0", "0.0004", "0.001"])
@pytest.mark.parametrize("name", SLOW)
def test_a_clear_violation_is_shown_by_a_short_motion(name, delay):
    """However slowly a law relaxes, a clear violation is shown within two hundred samples, in contact."""
    verdict = zw.check(PADDLE.replace(delay=delay), SLOW[name])
    assert verdict.outcome == "active"
    witness = verdict.witness
    assert witness.verify()
    assert witness.motion.samples <= 202
    x = witness.motion.positions
    assert x[0] == x[-1] == 0
    assert min(x[1:-1]) > 0
