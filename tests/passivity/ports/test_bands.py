"""Bands of violation and the relative index: closed forms, singular values of numpy, the checker."""

from __future__ import annotations

from fractions import Fraction
from math import inf, pi, sqrt

import control
import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st
from matrix_systems import responses

import zwidth as zw

indices = zw.ports.passivity_indices
s = control.tf("s")


def test_a_band_begins_where_the_real_part_vanishes():
    """Re (s + 3)/(s + 1)² = (3 − ω²)/(1 + ω²)²: below 0 from ω = √3 on, below −1/20 where ω² is 4 … 13."""
    index = indices((s + 3) / (s + 1) ** 2).input
    (band,) = index.bands()
    assert (band.low, band.high) == (pytest.approx(sqrt(3) / (2 * pi), rel=1e-14), inf)
    assert str(band) == "from 0.275664 Hz on"
    (inner,) = index.bands("-0.05")  # 20 (3 − x) + (1 + x)² = x² − 18 x + 61
    assert (2 * pi * inner.low) ** 2 == pytest.approx(9 - sqrt(20), rel=1e-12)
    assert (2 * pi * inner.high) ** 2 == pytest.approx(9 + sqrt(20), rel=1e-12)
    assert index.bands(Fraction(-1, 16)) == ()  # it is reached there, and not undercut


def test_two_bands_each_with_a_motion():
    zeros = (s**2 + 0.1 * s + 1) * (s**2 - 0.01 * s + 9)
    found = indices(zeros / ((s + 1) ** 2 * (s + 2) ** 2))
    assert len(found.bands) == 2
    for band in found.bands:
        motion = found.input.refute_in(band)
        assert motion.frequency in band
        assert motion.verify()
    assert found.to_dict()["violated_Hz"] == [[band.low, band.high] for band in found.bands]
    assert "violated 0.0954795 to 0.152316 Hz, 0.473955 to 0.558519 Hz" in repr(found)


@pytest.mark.parametrize(
    ("g", "low", "high"),
    [
        # Re G = (x − 1)² (x − 4)/(1 + x)³ with x = ω²: what touches the level splits no band
        (control.tf([2, -3, -3, -8], [2, 6, 6, 2]), 0, 1 / pi),
        # (1 3; −3 1)/(s + 1) has the eigenvalues (1 ± 3ω)/(1 + ω²): below 0 from 1/3 rad/s on
        (control.tf([[[1], [3]], [[-3], [1]]], [[[1, 1]] * 2] * 2), 1 / (6 * pi), inf),
        # Re z⁻¹ = cos θ is below 0 from a quarter of the rate on, up to half of it
        (control.tf([1], [1, 0], 0.02), 12.5, 25),
    ],
)
def test_there_is_one_band(g, low, high):
    (band,) = indices(g).bands
    assert (band.low, band.high) == (pytest.approx(low, rel=1e-14), pytest.approx(high, rel=1e-14))


@settings(max_examples=8, deadline=None)
@given(st.integers(0, 2**32 - 1), st.sampled_from([1, 2]))
def test_the_relative_index_is_the_largest_singular_value(seed, axes):
    """‖(G − z)(G + z)⁻¹‖ on a dense grid is below R and near it; the bands at 1 are those of Re G < 0."""
    rng = np.random.default_rng(seed)
    order, z = int(rng.integers(1, 4)), 10 ** rng.uniform(-1, 1)
    a = rng.normal(size=(order, order))
    a -= np.eye(order) * (max(np.linalg.eigvals(a).real.max(), 0) + rng.uniform(0.1, 1))
    b, c = rng.normal(size=(order, axes)), rng.normal(size=(axes, order))
    g = control.ss(*(np.round(m, 3) for m in (a, b, c, rng.uniform(0, 1) * np.eye(axes))))
    found = indices(g)
    relative = found.relative(z)
    closed = np.linalg.eigvals(g.A - g.B @ np.linalg.solve(g.D + z * np.eye(axes), g.C))
    if closed.real.max() >= 0:
        assert relative.value == inf
        return
    eye, at = z * np.eye(axes), responses(g, 1j * np.r_[0, np.geomspace(1e-3, 1e4, 3001)])
    most = np.linalg.norm((at - eye) @ np.linalg.inv(at + eye), 2, axis=(1, 2)).max()
    assert most <= relative.value * (1 + 1e-9)
    assert relative.value <= most * (1 + 1e-3)
    assert relative.certificate().verify()
    low, high = relative.bounds
    assert relative.at_most(high)
    assert not relative.at_most(low)
    assert relative.at_most(1) == found.passive
    ends = [[(band.low, band.high) for band in bands] for bands in (relative.bands(), found.bands)]
    assert ends[0] == [pytest.approx(band) for band in ends[1]]


def test_what_comes_back_whole_has_the_relative_index_1():
    """A mass stores and takes nothing: R = 1, and no less is certified; a reference takes energy."""
    relative = indices(0.25 * s).relative("0.3")
    assert relative.value == 1
    assert relative.certificate().verify()
    with pytest.raises(zw.InputError, match="give a higher level"):
        relative.certificate("0.999")
    with pytest.raises(zw.InputError, match="must be > 0"):
        indices(0.25 * s).relative(0)
