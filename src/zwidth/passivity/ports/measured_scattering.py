"""What a table of scattering parameters shows of passivity, and what it cannot.

    power in at one frequency = aᴴ (1 − SᴴS) a,    ‖S(f_k)‖ ≤ 1 at every sample f_k

A sample with ‖S‖ > 1 + e, wrong by e at most, is of no passive network: a steady sinusoid of that frequency
brings back more than it carries.
"""

from __future__ import annotations

from dataclasses import dataclass
from fractions import Fraction
from typing import Any, ClassVar

import numpy as np
from flint import fmpq

from zwidth.errors import InputError
from zwidth.passivity.ports.sample_table import (
    CLEAR,
    SampleTable,
    exactly,
    has_negative_eigenvalue,
    read_errors,
    read_samples,
)
from zwidth.quantity.balls import as_fmpq


@dataclass(frozen=True, repr=False)
class ScatteringTable(SampleTable):
    """What the samples of a table show; `values` are ‖S(f_k)‖, the largest singular values."""

    FORMAT = "zwidth scattering table 1"
    HEAD: ClassVar[str] = "largest ‖S‖"
    NAMES: ClassVar[tuple[str, str]] = ("|S|", "largest singular value of S")
    UNIT: ClassVar[str] = "1"
    WORST: ClassVar[str] = "largest_gain"
    FOR_A_PROOF: ClassVar[str] = "For a proof fit a rational S(s) and ask scattering_passivity of the fit."
    BOUND: ClassVar[float] = 1.0
    BEYOND: ClassVar[int] = 1

    @property
    def gains(self) -> tuple[float, ...]:
        """‖S(f_k)‖."""
        return self.values

    @property
    def largest(self) -> tuple[float, float]:
        """(‖S‖, f [Hz]) of the sample where most comes back."""
        return self.worst

    def told_broken(self) -> str:
        """With the largest ‖S‖."""
        gain, at = self.largest
        return (
            f"more comes back than goes in, most at {at:.6g} Hz: ‖S‖ = {_size(gain)}. No passive network has "
            "these values."
        )

    def told_kept(self) -> str:
        """With the largest ‖S‖."""
        gain, at = self.largest
        return f"does more come back than goes in; the largest ‖S‖ is {gain:.9g}, at {at:.6g} Hz."


def scattering_table(network: Any, error: Any = 0) -> ScatteringTable:
    """Which samples of a table of scattering parameters no passive network has.

    Parameters
    ----------
    network
        A Network of scikit-rf, or anything with `f` [Hz], ascending, and `s` of shape (samples, ports,
        ports); with `z0`, if there is one, positive and real, or complex if `s_def` is "power": of other
        waves |a|² − |b|² is no power then (Kurokawa 1965).
    error
        By how much a sample may be wrong at most, ≥ 0: the largest singular value of what it differs by.
        One number, or one for each sample.

    Raises
    ------
    InputError
        If it has no such table, one that is empty or not finite, or waves that do not tell power.
    """
    if not (hasattr(network, "f") and hasattr(network, "s")):
        raise InputError(
            f"a table of scattering parameters is a Network of scikit-rf, or has f [Hz] and s; "
            f"got {network!r}"
        )
    f, s = read_samples(network.f, network.s, "s")
    _refuse_waves_without_power(network)
    errors = read_errors(error, len(f))
    gains = [float(np.linalg.norm(sample, 2)) for sample in s]
    return ScatteringTable.judged(
        f, s, gains, errors, lambda sample, gain, e: e <= -1 or _exceeds(sample, gain, 1 + e)
    )


def _refuse_waves_without_power(network: Any) -> None:
    z0 = np.asarray(getattr(network, "z0", 50.0), dtype=complex)
    if not (z0.real > 0).all():
        raise InputError("the reference z0 of every port has a positive real part: a wave carries power")
    waves = getattr(network, "s_def", None)
    if (z0.imag != 0).any() and waves != "power":
        raise InputError(
            f"z0 is complex and s_def is {waves!r}: for such waves |a|² − |b|² is not the power; renormalize "
            "to a real z0, or to s_def = 'power'"
        )


def _exceeds(sample: Any, gain: float, bound: Fraction) -> bool:
    """‖S‖ > bound, of the decimals of the table."""
    if abs(gain - float(bound)) > CLEAR:
        return gain > bound
    size = range(len(sample))
    x, y = exactly(sample, "s")
    square = as_fmpq(bound * bound)
    real = [[square * int(i == j) for j in size] for i in size]
    imaginary = [[fmpq(0) for _ in size] for _ in size]
    for i in size:
        for j in size:
            for k in size:
                real[i][j] -= x[k][i] * x[k][j] + y[k][i] * y[k][j]
                imaginary[i][j] -= x[k][i] * y[k][j] - y[k][i] * x[k][j]
    return has_negative_eigenvalue((real, imaginary))


def _size(gain: float) -> str:
    """A size that is above 1 is told as such."""
    return f"{gain:.9g}" if gain - 1 > CLEAR else "1 and less than 1e-9 more"
