"""Pulses for a shaken finger: straight between samples, so that sums are integrals.

    φ_k of a cubic B-spline, φ(t) straight between:
    ∫ φ ẍ = Σ φ_k (x_{k+1} − 2x_k + x_{k−1})/T         whatever x does between
    ∫ φ x = T Σ φ_k (x_{k−1} + 10 x_k + x_{k+1})/12     where ẍ is constant between, as under a held force
    ∫ φ ẋ = Σ ½(φ_{k−1} − φ_{k+1}) (14 x_k − x_{k−1} − x_{k+1})/12     the same, ẍ smooth enough

A hand that moves a device in strokes of some hertz does not tell such sums from those of smooth pulses, as
`pulses` has them; a perturbation of 50 Hz at 1 kHz does, by (ωT)²/12, a per cent of the finger's mass.
"""

from __future__ import annotations

from typing import TYPE_CHECKING, Any, NamedTuple

import numpy as np
from scipy.interpolate import BSpline

from zwidth.native.compiled import Array

if TYPE_CHECKING:
    from numpy.typing import NDArray

_SPLINE = BSpline.basis_element(np.arange(-2.0, 3.0), extrapolate=False)


class Weights(NamedTuple):
    """A pulse as weights of samples, in the mean over it.

    Parameters
    ----------
    piece
        h, even: samples of each of its four pieces.
    reach
        2h + 1: samples from the middle to the first and to the last weight.
    motion
        Weights that make ẍ T², ẋ T and x.
    force
        Of a force that was measured at the samples.
    held, steps
        Of a held force, and of its rate times T, from −reach − lag on.
    lag
        Samples by which these begin earlier, for the force that was held comes later than its sample.
    """

    piece: int
    reach: int
    motion: tuple[Array, Array, Array]
    force: Array
    held: Array
    steps: Array
    lag: int


def weights(piece: int, delay: float) -> Weights:
    """The pulse of pieces of so many samples.

    Parameters
    ----------
    piece
        h ≥ 2, even.
    delay
        From a sample to its actuator force [samples], ≥ 0.
    """
    reach = 2 * piece + 1
    value = np.nan_to_num(_SPLINE(np.arange(-reach, reach + 1) / piece)) / piece
    bend = np.convolve(value, (1, -2, 1), "same")
    slope = np.convolve(np.convolve(value, (-0.5, 0, 0.5), "same"), (-1 / 12, 14 / 12, -1 / 12), "same")
    lag = int(np.ceil(delay)) + 1
    begins = np.arange(-reach - lag, reach + 2) + delay
    steps = -np.diff(np.interp(begins, np.arange(-reach, reach + 1), value))
    place = value + bend / 12
    return Weights(
        piece, reach, (bend, slope, place), place, np.diff(_integral(value, begins + reach)), steps, lag
    )


def _integral(value: Array, at: NDArray[np.floating[Any]]) -> Array:
    """Of the pulse from its first sample on, straight between samples."""
    whole = np.append(0.0, np.cumsum((value[1:] + value[:-1]) / 2))
    inside = np.clip(at, 0.0, value.size - 1.0)
    k = np.minimum(inside.astype(np.int64), value.size - 2)
    u = inside - k
    found: Array = whole[k] + value[k] * u + (value[k + 1] - value[k]) * u * u / 2
    return found
