"""Measured responses and scattering parameters, with what they may be wrong by: what is shown of them."""

from __future__ import annotations

from types import SimpleNamespace

import numpy as np
import pytest
from figure_layout import faults

import zwidth as zw

FIVE = zw.ports.response_table([1, 2, 3, 4, 5], [1 + 2j, -0.2j, -0.3, -0.05 + 1j, 0.4], error=0.1)
NETWORK = SimpleNamespace(f=[1.0, 2.0, 3.0], s=[[[0.96]], [[1.02j]], [[1.04]]])


def test_a_measured_response_with_error_bars():
    found = FIVE
    assert found.violated == (False, False, True, False, False)
    assert found.possible == (False, True, True, True, False)
    assert found.least == (-0.3, 3.0)
    (band,) = found.bands
    assert (band.low, band.high, band.before, band.after, band.worst) == (3.0, 3.0, 2.0, 4.0, -0.3)
    assert "At 1 of 5 samples" in found.describe()
    assert "At 2 more it may be so within the error" in found.describe()
    assert found.to_dict()["possible_samples"] == 3


def test_an_error_of_each_sample_is_met_exactly():
    """Equality is no violation; the decimals of the table count, not its doubles."""
    values = [-0.3, -0.3, -0.30000000000000004]
    found = zw.ports.response_table([1, 2, 3], values, error=[0.3, 0.29999999999999999, 0.3])
    assert found.violated == (False, False, True)
    assert zw.ports.response_table([1], [0.1 + 0.2j], error="0.1").possible == (False,)


def test_the_hermitian_part_decides_for_several_axes():
    """The best system within the error has a negative eigenvalue where a violation is told, else none."""
    rng = np.random.default_rng(3)
    g = rng.normal(size=(40, 3, 3)) + 1j * rng.normal(size=(40, 3, 3)) + 2 * np.eye(3)
    found = zw.ports.response_table(np.arange(1, 41), g, error=0.4)
    for sample, told in zip(g, found.violated, strict=True):
        hermitian = (sample + sample.conj().T) / 2
        vectors = np.linalg.eigh(hermitian)[1]
        best = hermitian + 0.4 * vectors @ vectors.conj().T
        assert told == (np.linalg.eigvalsh(best)[0] < 0)
    assert any(found.violated)
    assert not all(found.violated)


def test_what_a_sampled_law_needs_of_the_device():
    """T H/(z − 1) of a law of 150 N/m and 0.2 N·s/m is a port: −Re of it is b = K T/2 + B at the end."""
    period, f = 1e-3, np.linspace(5, 500, 100)
    z = np.exp(2j * np.pi * f * period)
    law = 150 + 0.2 * (z - 1) / (period * z)
    found = zw.ports.response_table(f, period * law / (z - 1), error=0.01)
    assert -found.least[0] == pytest.approx(0.275)
    assert found.least[1] == 500


def test_scattering_parameters_with_an_error():
    """‖S‖ ≤ 1 + e may be of a passive network; with e = 0.03 a sample of 1.02 may."""
    assert zw.ports.scattering_table(NETWORK).violated == (False, True, True)
    found = zw.ports.scattering_table(NETWORK, error=0.03)
    assert found.violated == (False, False, True)
    assert found.possible == (False, True, True)
    assert found.bands[0].worst == 1.04
    assert zw.ports.scattering_table(NETWORK, error=0.04).violated == (False, False, False)
    assert "wrong by more than the error" in found.assumptions[-1]


def test_the_picture_tells_three_kinds_of_samples_apart():
    figure = FIVE.plot()
    (axes,) = figure.axes
    assert axes.get_title(loc="left") == "1 of 5 samples violate"
    shown = {bars.get_label(): bars.lines[0].get_xydata().tolist() for bars in axes.containers}
    assert shown == {
        "no violation shown": [[1, 1], [5, 0.4]],
        "may violate, within its error": [[2, 0], [4, -0.05]],
        "violates, whatever its error": [[3, -0.3]],
    }
    (at,) = axes.containers[2].lines[2][0].get_segments()
    assert at == pytest.approx(np.array([[3, -0.4], [3, -0.2]]))
    low, high = axes.get_ylim()
    assert low < -0.4 < 1.1 < high
    assert faults(figure) == []
    (axes,) = zw.ports.scattering_table(NETWORK).plot().axes
    assert (axes.get_ylabel(), axes.containers[1].get_label()) == ("|S| [1]", "violates")


@pytest.mark.parametrize(
    ("given", "message"),
    [
        (([1, 2], [1, 2], -0.1), "an error is ≥ 0"),
        (([1, 2], [1, 2], [0.1]), "one for each of the 2 samples"),
        (([1, 2], [1, 2, 3]), "one square matrix for each"),
        (([2, 1], [1, 2]), "ascend"),
        (([1, 2], [1, np.nan]), "not finite"),
        (([1, 2], [[1], "x"]), "arrays of numbers"),
        (([], []), "one square matrix for each"),
    ],
)
def test_what_is_no_table_is_refused(given, message):
    with pytest.raises(zw.InputError, match=message):
        zw.ports.response_table(*given)
