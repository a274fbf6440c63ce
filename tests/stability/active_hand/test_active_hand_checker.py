"""The checker of kind "active hand" accepts what is proved and nothing else."""

from __future__ import annotations

import json
from fractions import Fraction
from typing import Any

import numpy as np
import pytest
from tampered import tampered

import zwidth as zw
from zwidth import checker
from zwidth.checker.active_hand import _least_cosine
from zwidth.passivity.stability.shaking_hand import band_of
from zwidth.quantity.text import to_json

PADDLE = zw.Device(mass=0.036, damping=0.15, rate=1000, coulomb_friction=0.12, resolution=22.4e-6)
KEPT, BROKEN = 0, 1


def proofs(wall: zw.Wall) -> tuple[dict[str, Any], dict[str, Any]]:
    """Contact kept, and contact broken, as they come out of a file."""
    document = json.loads(to_json(zw.stability.tolerated_activity(PADDLE, wall).to_dict()))
    kept, broken = (document[key]["certificate"] for key in ("contact_kept", "contact_broken"))
    assert kept["kind"] == broken["kind"] == "active hand"
    return kept, broken


@pytest.mark.parametrize("wall", [zw.Wall(150), zw.Wall(100, 0.05), zw.Wall(20, 0.12), zw.Wall(300)])
def test_accepted(wall: zw.Wall) -> None:
    for proof in proofs(wall):
        found = checker.verify(proof)
        assert found.valid, found.reason


@pytest.mark.parametrize(
    ("which", "path", "value"),
    [
        *((KEPT, "activity_N_s_per_m", value) for value in ("0.16", "-0.01")),
        *((KEPT, "below_Hz", value) for value in ("11", "0", "501")),
        (KEPT, "proof.cosine", "0.999"),
        (KEPT, "proof.angle", "0.06"),
        (KEPT, "loop.damping_N_s_per_m", "0.14"),
        (KEPT, "loop.numerator", ["160", "-50"]),
        (KEPT, "loop.delay_s", "0.0005"),
        (KEPT, "loop.coulomb_friction_N", "0.0001"),
        (KEPT, "proof.stability.kind", "closed loop"),
        (KEPT, "proof.in_band.factor", ["1"]),
        (KEPT, "proof.in_band.square", ["1", "1"]),
        (KEPT, "proof.positivity.factor", ["1"]),
        *((BROKEN, "activity_N_s_per_m", value) for value in ("0.06", "0.04")),
        (BROKEN, "loop.damping_N_s_per_m", "0.14"),
        (BROKEN, "proof.reduced.kind", "force bounding"),
        (BROKEN, "proof.reduced.loop.damping_N_s_per_m", "0.15"),
        (BROKEN, "proof.reduced.loop.numerator", ["100", "-50"]),
    ],
)
def test_tampered(which: int, path: str, value: Any) -> None:
    proof = proofs(zw.Wall(100, 0.05))[which]
    assert not checker.verify(tampered(proof, path.split("."), value)).valid


@pytest.mark.parametrize("hertz", [0.01, 10, 123.4, 499, 500])
def test_ends_of_the_band(hertz: float) -> None:
    band = band_of(Fraction(str(hertz)), Fraction(1, 1000))
    angle = 2 * np.pi * hertz / 1000
    assert 0 <= float(band.angle) - angle < 1e-15
    assert -2e-15 < float(band.cosine) - np.cos(angle) <= 1e-16
    assert band.cosine <= _least_cosine(band.angle)


@pytest.mark.parametrize("turn", ["3.1416", "4", "6.2203", "6.2831853", "12.5"])
def test_an_angle_beyond_half_a_turn_covers_all(turn: str) -> None:
    """cos rises again there: a narrow band at its cosine is not all that is below the angle."""
    kept, _ = proofs(zw.Wall(100, 0.05))
    wide = tampered(tampered(kept, ["below_Hz"], "400"), ["proof", "angle"], turn)
    assert not checker.verify(wide).valid
    assert _least_cosine(Fraction(turn)) == -1


def test_activity_is_in_its_unit() -> None:
    kept, _ = proofs(zw.Wall(100, 0.05))
    activity = kept.pop("activity_N_s_per_m")
    turned = checker.verify({**kept, "activity_N_m_s_per_rad": activity})
    assert "of a rotary one" in turned.reason
    assert "unit of activity" in checker.verify({**kept, "activity_mN_s_per_m": activity}).reason
