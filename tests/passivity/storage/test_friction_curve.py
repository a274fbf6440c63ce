"""Friction measured at several speeds: proofs use all models below it, motions pay what the curve says."""

from __future__ import annotations

from fractions import Fraction
from random import Random

import numpy as np
import pytest
from strategies import seeds

import zwidth as zw
from zwidth.passivity.bracket import passive_limit
from zwidth.passivity.storage import available_storage
from zwidth.passivity.storage.domain import Losses, inner_costs, outer_costs

PERIOD, RESOLUTION = Fraction(1, 1000), Fraction(1, 10000)
DEVICE = zw.Device(damping=0, coulomb_friction=0, resolution=RESOLUTION, sample_period=PERIOD)
STRIBECK = zw.FrictionCurve([0, "0.02", "0.1", "0.3", "0.8"], ["0.09", "0.04", "0.026", "0.05", "0.12"])
DEPTH = "0.0012"


def admissible(curve, fastest):
    """min over v of 2 F(v)/(Δ + v T), F the lower hull: the line K Δ/2 + (K T/2) v just below it."""
    speeds = [Fraction(n, 2000) * Fraction(fastest) for n in range(2001)]

    def hull(v):
        return max(m.coulomb_friction.fraction + m.damping.fraction * v for m in curve.minorants())

    return float(min(2 * hull(v) / (RESOLUTION + v * PERIOD) for v in speeds))


@pytest.mark.parametrize("speed", ["0.1", "0.3", "1.2"])
def test_a_spring_below_the_curve(speed):
    """Its limit is that of the steepest line K Δ/2 + (K T/2) v below the friction, up to the hand's speed."""
    found = passive_limit(DEVICE, zw.Wall(100), friction=STRIBECK, penetration=DEPTH, speed=speed)
    assert found.relative_width <= 0.01
    assert found.proved_passive == pytest.approx(admissible(STRIBECK, speed), rel=0.01)
    assert found.proved_active == pytest.approx(admissible(STRIBECK, speed), rel=0.01)
    assert found.certificate.verify()
    assert found.witness.verify()
    best = STRIBECK.best(PERIOD, RESOLUTION)
    alone = min(2 * best.damping / PERIOD, 2 * best.coulomb_friction / RESOLUTION)
    assert found.proved_passive >= 0.98 * float(alone)
    one = DEVICE.replace(damping=best.damping, coulomb_friction=best.coulomb_friction)
    single = passive_limit(one, zw.Wall(100), penetration=DEPTH, speed=speed)
    assert found.proved_passive >= 0.99 * single.proved_passive


@seeds(12)
def test_the_costs_enclose_the_loss(seed):
    """Outer costs at most, inner ones at least; between two steps the chord of outer ones is below too."""
    random = Random(seed)
    speeds = sorted(random.sample(range(1, 100), 4))
    curve = zw.FrictionCurve(
        [Fraction(v, 50) for v in speeds], [Fraction(random.randint(1, 30), 100) for _ in speeds]
    )
    losses = Losses(Fraction(0), Fraction(0), RESOLUTION, PERIOD, 0, Fraction(1), curve)
    step, unit = RESOLUTION / 8, Fraction(1, 2**30)
    far = np.arange(120, dtype=np.int64)
    low, high = (rule(losses, far, PERIOD, step, unit, 3) for rule in (outer_costs, inner_costs))
    assert low[0] == high[0] == 0
    for _ in range(200):
        d = Fraction(random.randint(0, 118_000), 1000)
        true = losses.lost(d * step, Fraction(1)) / (unit * step)
        at, part = int(d), d - int(d)
        assert int(low[at]) * (1 - part) + int(low[at + 1]) * part <= true
        if d == at:
            assert true <= int(high[at])
    assert all(losses.lost(n * step, Fraction(1)) / (unit * step) <= int(high[n]) for n in range(120))


@pytest.mark.parametrize(
    ("change", "arguments", "said"),
    [
        ({"delay": "0.0005"}, {}, "whole samples"),
        ({}, {"parameter": "coulomb_friction"}, "plays no part"),
        ({}, {"friction": (1, 2)}, "FrictionCurve"),
    ],
)
def test_what_it_refuses(change, arguments, said):
    with pytest.raises(zw.InputError, match=said):
        passive_limit(DEVICE.replace(**change), zw.Wall(100), **{"friction": STRIBECK, **arguments})
    with pytest.raises(zw.InputError, match="relaxes"):
        available_storage(DEVICE, zw.Maxwell(100, 1), friction=STRIBECK)
