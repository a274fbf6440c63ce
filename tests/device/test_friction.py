"""The largest Coulomb-plus-viscous models below a friction curve, by brute force too."""

from __future__ import annotations

from fractions import Fraction
from itertools import pairwise
from typing import Any

import pytest
from hypothesis import given, settings
from hypothesis import strategies as st

import zwidth as zw

STRIBECK = zw.FrictionCurve([0, 0.01, 0.05, 0.1, 0.2, 0.4], [0.3, 0.2, 0.15, 0.16, 0.18, 0.25])

numbers = st.fractions(0, 10, max_denominator=100)


@st.composite
def curves(draw: st.DrawFn) -> zw.FrictionCurve:
    """Any friction curve of two to eight points, a falling end included."""
    speeds = sorted(draw(st.sets(numbers, min_size=2, max_size=8)))
    return zw.FrictionCurve(speeds, [draw(numbers) for _ in speeds])


def slope(curve: zw.FrictionCurve) -> Fraction:
    """Of the last chord, or 0 where it falls."""
    (v0, v1), (f0, f1) = ([n.fraction for n in part[-2:]] for part in (curve.speeds, curve.forces))
    return max(Fraction(0), (f1 - f0) / (v1 - v0))


def below(curve: zw.FrictionCurve, friction: Fraction, damping: Fraction) -> bool:
    """The definition of a model below the curve."""
    points = zip(curve.speeds, curve.forces, strict=True)
    under = all(friction + damping * v.fraction <= f.fraction for v, f in points)
    return under and friction >= 0 and 0 <= damping <= slope(curve)


def stiffness(model: tuple[Any, Any], period: Fraction, delta: Fraction) -> Fraction:
    """min(2b/T, 2f_c/Δ)."""
    friction, damping = (Fraction(getattr(n, "fraction", n)) for n in model)
    viscous = 2 * damping / period
    return min(viscous, 2 * friction / delta) if delta else viscous


def test_stiction_and_bends():
    assert [tuple(map(str, corner)) for corner in STRIBECK.minorants()] == [
        ("0.15", "0.0"),
        ("0.14", "0.2"),
        ("0.11", "0.35"),
    ]
    assert STRIBECK.largest_damping == 0.35
    assert "last chord" in STRIBECK.assumption


@settings(max_examples=80)
@given(curves())
def test_corners_lie_below_and_cannot_grow(curve):
    corners = curve.minorants()
    step = Fraction(1, 10**9)
    for friction, damping in corners:
        f, b = friction.fraction, damping.fraction
        assert below(curve, f, b)
        assert not below(curve, f + step, b)
        assert not below(curve, f, b + step)
    assert [c.damping for c in corners] == sorted({c.damping for c in corners})
    assert all(p.coulomb_friction > q.coulomb_friction for p, q in pairwise(corners))


@settings(max_examples=80)
@given(curves(), st.fractions(0, 1, max_denominator=50))
def test_the_largest_friction_for_a_damping(curve, part):
    limit = curve.largest_damping.fraction
    friction = curve.largest_coulomb_friction(part * limit).fraction
    assert below(curve, friction, part * limit)
    assert not below(curve, friction + Fraction(1, 10**9), part * limit)
    with pytest.raises(zw.InputError, match="damping must be from 0"):
        curve.largest_coulomb_friction(limit + Fraction(1, 10**9))
    with pytest.raises(zw.InputError, match="damping must be from 0"):
        curve.largest_coulomb_friction(-Fraction(1, 10**9))


@settings(max_examples=80)
@given(curves(), st.fractions("0.001", 1, max_denominator=1000), st.fractions(0, 1, max_denominator=1000))
def test_the_best_model_against_a_search(curve, period, delta):
    best = curve.best(period, delta)
    assert below(curve, best.coulomb_friction.fraction, best.damping.fraction)
    limit = curve.largest_damping.fraction
    reached = stiffness(best, period, delta)
    for i in range(41):
        b = limit * i / 40
        assert stiffness((curve.largest_coulomb_friction(b), b), period, delta) <= reached


def test_the_best_model_balances_both_limits():
    """Where the edge allows it, 2b/T = 2f_c/Δ exactly."""
    model = STRIBECK.best(0.001, Fraction("0.0224"))
    f, b = model.coulomb_friction.fraction, model.damping.fraction
    assert b / Fraction(1, 1000) == f / Fraction("0.0224")
    assert STRIBECK.best(0.001, 0).damping == STRIBECK.largest_damping


@pytest.mark.parametrize(
    ("speeds", "forces"),
    [
        ([1], [1]),
        ([], []),
        ([1, 2], [1]),
        ([1, 1], [1, 2]),
        ([2, 1], [1, 2]),
        ([-1, 1], [1, 2]),
        ([0, 1], [1, -2]),
        ([0, "x"], [1, 2]),
        ([0, float("nan")], [1, 2]),
        (3, [1, 2]),
    ],
)
def test_what_is_no_curve_is_refused(speeds, forces):
    with pytest.raises(zw.InputError, match="friction curve"):
        zw.FrictionCurve(speeds, forces)


@given(curves(), st.sampled_from([0, -1]))
def test_best_needs_a_period(curve, period):
    """T > 0 and Δ ≥ 0."""
    with pytest.raises(zw.InputError, match="sample_period"):
        curve.best(period, 0)
    with pytest.raises(zw.InputError, match="resolution"):
        curve.best(1, -1)
