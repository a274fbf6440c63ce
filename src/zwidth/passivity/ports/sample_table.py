"""What samples at single frequencies show of a bound that holds at every frequency of a passive system.

A sample that breaks the bound by more than it may be wrong is of no passive system.  Samples that keep it
prove nothing: neither between them nor beyond them, and no table shows that what has these values is causal
and stable.
"""

from __future__ import annotations

from collections.abc import Callable, Iterator, Sequence
from dataclasses import dataclass
from fractions import Fraction
from functools import cached_property
from itertools import groupby
from typing import Any, ClassVar, Self

import numpy as np
from flint import fmpq, fmpq_mat

from zwidth.errors import InputError
from zwidth.model.environment.system import number_of
from zwidth.passivity.linear.exact_algebra import as_real, negative_direction
from zwidth.passivity.result import Result
from zwidth.quantity.answered import known
from zwidth.quantity.balls import as_fmpq
from zwidth.quantity.exact import Exact
from zwidth.quantity.text import from_to, shown
from zwidth.showing import Part, Table

CLEAR = 1e-9
"""Relative distance from a bound that the rounding of a singular value or an eigenvalue cannot reach."""

_MOST_SHOWN = 8


@dataclass(frozen=True)
class SampleBand:
    """Neighbouring samples low … high [Hz] that break the bound, and the samples beside them that do not.

    The edges lie between `before` and `low`, and between `high` and `after`; None at an end of the table.
    `worst` is what is measured where the bound is broken most.
    """

    low: float
    high: float
    before: float | None
    after: float | None
    worst: float


@dataclass(frozen=True, repr=False)
class SampleTable(Result):
    """What the samples of a table show."""

    _PICTURE: ClassVar[str] = "sample_table_figure"
    _HEAD: ClassVar[str]
    """What the worst of a band is."""
    _NAMES: ClassVar[tuple[str, str]]
    """What the values are, of one port and of several."""
    _UNIT: ClassVar[str]
    _WORST: ClassVar[str]
    """The key of the worst of them."""
    _FOR_A_PROOF: ClassVar[str]
    _BOUND: ClassVar[float]
    """What the values of a passive system keep to."""
    _BEYOND: ClassVar[int]
    """On which side of it they do not: 1 above, −1 below."""

    frequencies: tuple[float, ...] = known("f_k, ascending", unit="Hz")
    values: tuple[float, ...] = known("what the bound is on, to rounding")
    violated: tuple[bool, ...] = known(
        "whether sample k breaks the bound whatever its error, decided exactly: of the decimals of the table"
    )
    possible: tuple[bool, ...] = known("whether it may break the bound within its error")
    errors: tuple[float, ...] = known(
        "by how much a sample may be wrong at most, in the largest singular value"
    )
    ports: int = known("how many there are")

    @classmethod
    def judged(
        cls,
        frequencies: Any,
        samples: Any,
        values: Sequence[float],
        errors: Sequence[Fraction],
        breaks: Callable[[Any, float, Fraction], bool],
    ) -> Self:
        """The table; `breaks(sample, value, slack)` says whether a sample is beyond the bound by more."""
        rows = list(zip(samples, values, errors, strict=True))
        return cls(
            frequencies=tuple(map(float, frequencies)),
            values=tuple(values),
            violated=tuple(breaks(sample, value, e) for sample, value, e in rows),
            possible=tuple(breaks(sample, value, -e) for sample, value, e in rows),
            errors=tuple(map(float, errors)),
            ports=samples.shape[1],
        )

    @property
    def worst(self) -> tuple[float, float]:
        """(value, f [Hz]) of the sample that breaks the bound most, or is nearest to it."""
        value = self.worst_of(self.values)
        return value, self.frequencies[self.values.index(value)]

    def describe(self) -> str:
        """What is shown, in a sentence or two."""
        count, of = sum(self.violated), len(self.violated)
        shown = (
            f"At {count} of {of} samples {self.told_broken()}"
            if count
            else f"At none of the {of} samples {self.told_kept()} That is no proof of passivity."
        )
        return shown + self.told_possible()

    @property
    def violates(self) -> bool:
        """True where some sample is of no passive system.  False is no proof of passivity."""
        return any(self.violated)

    @cached_property
    def bands(self) -> tuple[SampleBand, ...]:
        """Runs of samples that break the bound, in ascending frequency."""
        return tuple(self._band(first, last) for first, last in _runs(self.violated))

    @property
    def assumptions(self) -> tuple[str, ...]:
        """What is not claimed."""
        low, high = self.frequencies[0], self.frequencies[-1]
        exact = (
            "no sample is wrong by more than the error that is given"
            if any(self.errors)
            else "the numbers of the table are taken as exact: give error = … if they are measured"
        )
        return (
            f"nothing is claimed between samples or outside {from_to(low, high, 'Hz', 6)}",
            "nothing is claimed of causality and stability, which no table shows",
            exact,
        )

    def advised(self) -> Iterator[Part]:
        """Where, and what would prove more."""
        if self.bands:
            rows = [[f"{b.low:.6g}", f"{b.high:.6g}", f"{b.worst:.9g}"] for b in self.bands[:_MOST_SHOWN]]
            yield Table(rows=rows, heads=[["from", "to", self._HEAD], ["Hz", "Hz", ""]])
        else:
            yield self._FOR_A_PROOF

    def told_possible(self) -> str:
        """How many samples are undecided within their error, as a sentence that may follow; or nothing."""
        count = sum(self.possible) - sum(self.violated)
        return f" At {count} more it may be so within the error." if count else ""

    def to_dict(self) -> dict[str, Any]:
        """It as plain data, units in the keys."""
        return {
            "format": self._FORMAT,
            "samples": len(self.frequencies),
            "ports": self.ports,
            "lowest_Hz": self.frequencies[0],
            "highest_Hz": self.frequencies[-1],
            "violated_samples": sum(self.violated),
            "possible_samples": sum(self.possible),
            "violated_Hz": [[band.low, band.high] for band in self.bands],
            self._WORST: self.worst[0],
            f"{self._WORST}_at_Hz": self.worst[1],
            "assumptions": list(self.assumptions),
        }

    def worst_of(self, values: Sequence[float]) -> float:
        """The one that breaks the bound most, or is nearest to it."""
        return max(values) if self._BEYOND > 0 else min(values)

    def told_broken(self) -> str:
        """What happens at the samples that break the bound: the end of a sentence."""
        raise NotImplementedError

    def told_kept(self) -> str:
        """What does not happen where none does: the end of a sentence."""
        raise NotImplementedError

    def _band(self, first: int, last: int) -> SampleBand:
        f = self.frequencies
        return SampleBand(
            f[first],
            f[last],
            f[first - 1] if first else None,
            f[last + 1] if last + 1 < len(f) else None,
            self.worst_of(self.values[first : last + 1]),
        )


def read_samples(frequencies: Any, values: Any, what: str) -> tuple[Any, Any]:
    """f [Hz], ascending, and for each a square matrix, of one port a number: (samples, ports, ports)."""
    try:
        f, s = np.asarray(frequencies, dtype=float), np.asarray(values, dtype=complex)
    except (TypeError, ValueError):
        raise InputError(f"f and {what} of a table are arrays of numbers") from None
    if s.ndim == 1:
        s = s.reshape(-1, 1, 1)
    if f.ndim != 1 or s.shape[:1] != f.shape or s.ndim != 3 or s.shape[1] != s.shape[2] or not s.size:
        raise InputError(
            f"{what} has one square matrix for each frequency, shape (samples, ports, ports); got f of shape "
            f"{f.shape} and {what} of shape {s.shape}"
        )
    if not (np.isfinite(f).all() and np.isfinite(s).all()):
        raise InputError(f"f and {what} hold numbers that are not finite")
    if (np.diff(f) <= 0).any():
        raise InputError("the frequencies of a table ascend, each only once; sort them")
    return f, s


def read_errors(error: Any, samples: int) -> list[Fraction]:
    """By how much each sample may be wrong: one number for all, or one for each."""
    given = list(error) if hasattr(error, "__len__") and not isinstance(error, str) else [error] * samples
    if len(given) != samples:
        raise InputError(f"error is one number, or one for each of the {samples} samples; got {len(given)}")
    errors = [Exact(e).fraction for e in given]
    if min(errors) < 0:
        raise InputError(
            f"an error is ≥ 0, got {float(min(errors)):g}: it is by how much a sample may be off"
        )
    return errors


def exactly(sample: Any, key: str) -> tuple[fmpq_mat, fmpq_mat]:
    """The decimals of a matrix, real and imaginary part."""
    parts = (sample.real, sample.imag)
    x, y = (fmpq_mat([[as_fmpq(number_of(v, key)) for v in row] for row in part]) for part in parts)
    return x, y


def has_negative_eigenvalue(real: fmpq_mat, imaginary: fmpq_mat) -> bool:
    """Of a Hermitian matrix, decided exactly."""
    return negative_direction(as_real(real, imaginary)) is not None


def _on_diagonal(value: Fraction, size: int) -> fmpq_mat:
    return fmpq_mat([[as_fmpq(value) * int(i == j) for j in range(size)] for i in range(size)])


def _runs(flags: Sequence[bool]) -> Iterator[tuple[int, int]]:
    """(first, last) of each run of True."""
    for flag, places in groupby(range(len(flags)), flags.__getitem__):
        if flag:
            first, *_, last = [*places] * 2
            yield first, last


#     power in at one frequency = ½ uᴴ ½(G + Gᴴ) u,    λ_min(½(G + Gᴴ)) ≥ 0 at every sample f_k
#
# λ_min moves by no more than G is wrong (Weyl): a sample with λ_min < −e, wrong by e at most, is of no
# passive system.  Of one axis λ_min is Re G.


@dataclass(frozen=True, repr=False)
class ResponseTable(SampleTable):
    """What the samples of a table show; `values` are λ_min(½(G + Gᴴ)), of one axis Re G."""

    _FORMAT = "zwidth response table 1"
    _HEAD: ClassVar[str] = "least Re G"
    _NAMES: ClassVar[tuple[str, str]] = ("Re G", "least eigenvalue of ½(G + Gᴴ)")
    _UNIT: ClassVar[str] = "unit of G"
    _WORST: ClassVar[str] = "least_real_part"
    _FOR_A_PROOF: ClassVar[str] = "For a proof fit a rational G(s) and ask passivity_indices of the fit."
    _BOUND: ClassVar[float] = 0.0
    _BEYOND: ClassVar[int] = -1

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
        return f"the least real part is {value:.9g}, at {shown(at, 'Hz', 6)}".replace("-", "−")


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
    x, y = exactly(sample, "values")
    real, imaginary = (x + x.transpose()) * fmpq(1, 2), (y - y.transpose()) * fmpq(1, 2)
    return has_negative_eigenvalue(real - _on_diagonal(level, len(sample)), imaginary)


#     power in at one frequency = aᴴ (1 − SᴴS) a,    ‖S(f_k)‖ ≤ 1 at every sample f_k
#
# A sample with ‖S‖ > 1 + e, wrong by e at most, is of no passive network: a steady sinusoid of that frequency
# brings back more than it carries.


@dataclass(frozen=True, repr=False)
class ScatteringTable(SampleTable):
    """What the samples of a table show; `values` are ‖S(f_k)‖, the largest singular values."""

    _FORMAT = "zwidth scattering table 1"
    _HEAD: ClassVar[str] = "largest ‖S‖"
    _NAMES: ClassVar[tuple[str, str]] = ("|S|", "largest singular value of S")
    _UNIT: ClassVar[str] = "1"
    _WORST: ClassVar[str] = "largest_gain"
    _FOR_A_PROOF: ClassVar[str] = "For a proof fit a rational S(s) and ask scattering_passivity of the fit."
    _BOUND: ClassVar[float] = 1.0
    _BEYOND: ClassVar[int] = 1

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
        size = f"{gain:.9g}" if gain - 1 > CLEAR else "1 and less than 1e-9 more"
        more = f"more comes back than goes in, most at {shown(at, 'Hz', 6)}: ‖S‖ = {size}"
        return f"{more}. No passive network has these values."

    def told_kept(self) -> str:
        """With the largest ‖S‖."""
        gain, at = self.largest
        return f"does more come back than goes in; the largest ‖S‖ is {gain:.9g}, at {shown(at, 'Hz', 6)}."


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
    x, y = exactly(sample, "s")
    back, turned = x.transpose() * x + y.transpose() * y, y.transpose() * x - x.transpose() * y
    return has_negative_eigenvalue(_on_diagonal(bound * bound, len(sample)) - back, turned)
