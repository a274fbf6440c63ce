"""What a measured frequency response of a port shows of passivity, and what it cannot.

    power in at one frequency = ½ uᴴ ½(G + Gᴴ) u,    λ_min(½(G + Gᴴ)) ≥ 0 at every sample f_k

λ_min moves by no more than G is wrong (Weyl): a sample with λ_min < −e, wrong by e at most, is of no passive
system.  Of one axis λ_min is Re G.
"""

from __future__ import annotations

from dataclasses import dataclass
from fractions import Fraction
from typing import Any, ClassVar

import numpy as np

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
class ResponseTable(SampleTable):
    """What the samples of a table show; `values` are λ_min(½(G + Gᴴ)), of one axis Re G."""

    FORMAT = "zwidth response table 1"
    HEAD: ClassVar[str] = "least Re G"
    NAMES: ClassVar[tuple[str, str]] = ("Re G", "least eigenvalue of ½(G + Gᴴ)")
    UNIT: ClassVar[str] = "unit of G"
    WORST: ClassVar[str] = "least_real_part"
    FOR_A_PROOF: ClassVar[str] = "For a proof fit a rational G(s) and ask passivity_indices of the fit."
    BOUND: ClassVar[float] = 0.0
    BEYOND: ClassVar[int] = -1

    @property
    def least(self) -> tuple[float, float]:
        """(λ_min, f [Hz]) of the sample where it is least."""
        return self.worst

    def told_broken(self) -> str:
        """With the least real part."""
        return f"a sinusoid takes energy out; {self._least()}."

    def told_kept(self) -> str:
        """With the least real part."""
        return f"is it shown that a sinusoid takes energy out; {self._least()}."

    def _least(self) -> str:
        value, at = self.least
        return f"the least real part is {value:.9g}, at {at:.6g} Hz".replace("-", "−")


def response_table(frequencies: Any, values: Any, error: Any = 0) -> ResponseTable:
    """Which samples of a measured frequency response no passive system has.

    Parameters
    ----------
    frequencies
        f_k [Hz], ascending.
    values
        G(f_k), complex, of power: velocity → force or the reverse.  One number each, or shape (samples, axes,
        axes).
    error
        By how much a sample may be wrong at most, ≥ 0, in the unit of G: of several axes the largest singular
        value of what it differs by.  One number, or one for each sample.

    Raises
    ------
    InputError
        If they are no such table, or one that is empty or not finite; if an error is negative.
    """
    f, g = read_samples(frequencies, values, "values")
    errors = read_errors(error, len(f))
    least = [float(np.linalg.eigvalsh((sample + sample.conj().T) / 2)[0]) for sample in g]
    return ResponseTable.judged(f, g, least, errors, lambda sample, value, e: _below(sample, value, -e))


def _below(sample: Any, value: float, level: Fraction) -> bool:
    """λ_min < level, of the decimals of the table."""
    if abs(value - float(level)) > CLEAR * float(np.linalg.norm(sample)):
        return value < level
    size = range(len(sample))
    x, y = exactly(sample, "values")
    real = [[(x[i][j] + x[j][i]) / 2 - as_fmpq(level) * int(i == j) for j in size] for i in size]
    imaginary = [[(y[i][j] - y[j][i]) / 2 for j in size] for i in size]
    return has_negative_eigenvalue((real, imaginary))
