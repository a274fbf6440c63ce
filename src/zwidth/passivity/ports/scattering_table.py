"""What a table of scattering parameters shows of passivity, and what it cannot.

    power in at one frequency = aᴴ (1 − SᴴS) a,    ‖S(f_k)‖ ≤ 1 at every sample f_k

A sample with ‖S‖ > 1 is of no passive network: a steady sinusoid of that frequency brings back more
than it carries.  Samples that all keep the bound prove nothing: between them and beyond them a network
may do anything, and no finite table shows that a causal, stable network has these values.
"""

from __future__ import annotations

from collections.abc import Iterator
from dataclasses import dataclass
from functools import cached_property
from typing import Any

import numpy as np
from flint import fmpq

from zwidth.environment.system import number_of
from zwidth.errors import InputError
from zwidth.passivity.linear.elimination import negative_direction
from zwidth.passivity.result import Result
from zwidth.quantity.balls import as_fmpq
from zwidth.showing import Part, Table

_CLEAR = 1e-9
"""How far from 1 the rounding of a singular value cannot reach."""

_MOST_SHOWN = 8


@dataclass(frozen=True)
class SampleBand:
    """Neighbouring samples low … high [Hz] with ‖S‖ > 1, and the samples beside them that keep the bound.

    The edges lie between `before` and `low`, and between `high` and `after`; None at an end of the table.
    """

    low: float
    high: float
    before: float | None
    after: float | None
    largest: float


@dataclass(frozen=True, repr=False)
class ScatteringTable(Result):
    """What the samples of a table show.

    Attributes
    ----------
    frequencies
        f_k [Hz], ascending.
    gains
        ‖S(f_k)‖, the largest singular value, to rounding.
    violated
        Whether it is above 1, decided exactly: of the decimals of the table.
    ports
        How many there are.
    """

    FORMAT = "zwidth scattering table 1"

    frequencies: tuple[float, ...]
    gains: tuple[float, ...]
    violated: tuple[bool, ...]
    ports: int

    @property
    def violates(self) -> bool:
        """True where some sample is of no passive network.  False is no proof of passivity."""
        return any(self.violated)

    @property
    def largest(self) -> tuple[float, float]:
        """(‖S‖, f [Hz]) of the sample where most comes back."""
        k = int(np.argmax(self.gains))
        return self.gains[k], self.frequencies[k]

    @cached_property
    def bands(self) -> tuple[SampleBand, ...]:
        """Runs of samples that violate, in ascending frequency."""
        return tuple(self._band(first, last) for first, last in _runs(self.violated))

    def describe(self) -> str:
        """What is shown, in a sentence or two."""
        count, of = sum(self.violated), len(self.violated)
        gain, at = self.largest
        if count:
            return (
                f"At {count} of {of} samples more comes back than goes in, most at {at:.6g} Hz: "
                f"‖S‖ = {_size(gain)}. No passive network has these values."
            )
        return (
            f"At none of the {of} samples does more come back than goes in; the largest ‖S‖ is {gain:.9g}, "
            f"at {at:.6g} Hz. That is no proof of passivity."
        )

    @property
    def assumptions(self) -> tuple[str, ...]:
        """What is not claimed."""
        low, high = self.frequencies[0], self.frequencies[-1]
        return (
            f"between samples, below {low:.6g} Hz and above {high:.6g} Hz nothing is claimed",
            "nothing is claimed of causality and stability, which no table shows",
            "the numbers of the table are taken as exact: what is violated by less than they are measured "
            "with is not shown",
        )

    def advised(self) -> Iterator[Part]:
        """Where, and what would prove more."""
        if self.bands:
            rows = [[f"{b.low:.6g}", f"{b.high:.6g}", f"{b.largest:.9g}"] for b in self.bands[:_MOST_SHOWN]]
            heads = [["from", "to", "largest ‖S‖"], ["Hz", "Hz", ""]]
            yield Table(rows=rows, heads=heads)
        else:
            yield "For a proof fit a rational S(s) and ask scattering_passivity of the fit."

    def to_dict(self) -> dict[str, Any]:
        """It as plain data, units in the keys."""
        gain, at = self.largest
        return {
            "format": self.FORMAT,
            "samples": len(self.frequencies),
            "ports": self.ports,
            "lowest_Hz": self.frequencies[0],
            "highest_Hz": self.frequencies[-1],
            "violated_samples": sum(self.violated),
            "violated_Hz": [[band.low, band.high] for band in self.bands],
            "largest_gain": gain,
            "largest_gain_at_Hz": at,
            "assumptions": list(self.assumptions),
        }

    def _band(self, first: int, last: int) -> SampleBand:
        f = self.frequencies
        return SampleBand(
            f[first],
            f[last],
            f[first - 1] if first else None,
            f[last + 1] if last + 1 < len(f) else None,
            max(self.gains[first : last + 1]),
        )


def scattering_table(network: Any) -> ScatteringTable:
    """Which samples of a table of scattering parameters no passive network has.

    Parameters
    ----------
    network
        A Network of scikit-rf, or anything with `f` [Hz], ascending, and `s` of shape (samples, ports,
        ports); with `z0`, if there is one, positive and real, or complex if `s_def` is "power": of other
        waves |a|² − |b|² is no power then (Kurokawa 1965).

    Raises
    ------
    InputError
        If it has no such table, one that is empty or not finite, or waves that do not tell power.
    """
    f, s = _read(network)
    _refuse_waves_without_power(network)
    gains = [float(np.linalg.norm(sample, 2)) for sample in s]
    violated = [
        gain > 1 if abs(gain - 1) > _CLEAR else _exceeds(sample)
        for gain, sample in zip(gains, s, strict=True)
    ]
    return ScatteringTable(tuple(map(float, f)), tuple(gains), tuple(violated), s.shape[1])


def _read(network: Any) -> tuple[Any, Any]:
    if not (hasattr(network, "f") and hasattr(network, "s")):
        raise InputError(
            f"a table of scattering parameters is a Network of scikit-rf, or has f [Hz] and s; "
            f"got {network!r}"
        )
    try:
        f, s = np.asarray(network.f, dtype=float), np.asarray(network.s, dtype=complex)
    except (TypeError, ValueError):
        raise InputError("f and s of a table of scattering parameters are arrays of numbers") from None
    if f.ndim != 1 or s.shape[:1] != f.shape or s.ndim != 3 or s.shape[1] != s.shape[2] or not s.size:
        raise InputError(
            f"s has one square matrix for each frequency, shape (samples, ports, ports); got f of shape "
            f"{f.shape} and s of shape {s.shape}"
        )
    if not (np.isfinite(f).all() and np.isfinite(s).all()):
        raise InputError("f and s hold numbers that are not finite")
    if (np.diff(f) <= 0).any():
        raise InputError("the frequencies of a table ascend, each only once; sort them")
    return f, s


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


def _exceeds(sample: Any) -> bool:
    """1 − SᴴS has a negative eigenvalue, of the decimals of the table."""
    size = len(sample)
    x, y = (
        [[as_fmpq(number_of(v, "s")) for v in row] for row in part] for part in (sample.real, sample.imag)
    )

    def pairing(i: int, j: int) -> tuple[fmpq, fmpq]:
        """(SᴴS)_ij."""
        real = sum((x[k][i] * x[k][j] + y[k][i] * y[k][j] for k in range(size)), fmpq(0))
        imaginary = sum((x[k][i] * y[k][j] - y[k][i] * x[k][j] for k in range(size)), fmpq(0))
        return real, imaginary

    form = [[fmpq(0)] * (2 * size) for _ in range(2 * size)]
    for i in range(size):
        for j in range(size):
            real, imaginary = pairing(i, j)
            real = fmpq(int(i == j)) - real
            form[i][j] = form[size + i][size + j] = real
            form[i][size + j], form[size + i][j] = imaginary, -imaginary
    return negative_direction(form) is not None


def _size(gain: float) -> str:
    """A size that is above 1 is told as such."""
    return f"{gain:.9g}" if gain - 1 > _CLEAR else "1 and less than 1e-9 more"


def _runs(flags: tuple[bool, ...]) -> Iterator[tuple[int, int]]:
    """(first, last) of each run of True."""
    first = None
    for k, flag in enumerate((*flags, False)):
        if flag and first is None:
            first = k
        elif not flag and first is not None:
            yield first, k - 1
            first = None
