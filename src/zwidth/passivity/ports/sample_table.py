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
from typing import Any, ClassVar, Self

import numpy as np
from flint import fmpq

from zwidth.errors import InputError
from zwidth.model.environment.system import number_of
from zwidth.passivity.linear.exact_algebra import negative_direction
from zwidth.passivity.result import Result
from zwidth.quantity.balls import as_fmpq
from zwidth.quantity.exact import Exact
from zwidth.showing import Part, Table

CLEAR = 1e-9
"""Relative distance from a bound that the rounding of a singular value or an eigenvalue cannot reach."""

_MOST_SHOWN = 8

Pair = tuple[list[list[fmpq]], list[list[fmpq]]]
"""Real and imaginary part of a matrix."""


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
    """What the samples of a table show.

    Attributes
    ----------
    frequencies
        f_k [Hz], ascending.
    values
        What the bound is on, to rounding.
    violated
        Whether sample k breaks the bound whatever its error, decided exactly: of the decimals of the table.
    possible
        Whether it may break the bound within its error.
    errors
        By how much a sample may be wrong at most, in the largest singular value.
    ports
        How many there are.
    """

    PICTURE: ClassVar[str] = "sample_table_figure"
    HEAD: ClassVar[str]
    """What the worst of a band is."""
    NAMES: ClassVar[tuple[str, str]]
    """What the values are, of one port and of several."""
    UNIT: ClassVar[str]
    WORST: ClassVar[str]
    """The key of the worst of them."""
    FOR_A_PROOF: ClassVar[str]
    BOUND: ClassVar[float]
    """What the values of a passive system keep to."""
    BEYOND: ClassVar[int]
    """On which side of it they do not: 1 above, −1 below."""

    frequencies: tuple[float, ...]
    values: tuple[float, ...]
    violated: tuple[bool, ...]
    possible: tuple[bool, ...]
    errors: tuple[float, ...]
    ports: int

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
            f"between samples, below {low:.6g} Hz and above {high:.6g} Hz nothing is claimed",
            "nothing is claimed of causality and stability, which no table shows",
            exact,
        )

    def advised(self) -> Iterator[Part]:
        """Where, and what would prove more."""
        if self.bands:
            rows = [[f"{b.low:.6g}", f"{b.high:.6g}", f"{b.worst:.9g}"] for b in self.bands[:_MOST_SHOWN]]
            yield Table(rows=rows, heads=[["from", "to", self.HEAD], ["Hz", "Hz", ""]])
        else:
            yield self.FOR_A_PROOF

    def told_possible(self) -> str:
        """How many samples are undecided within their error, as a sentence that may follow; or nothing."""
        count = sum(self.possible) - sum(self.violated)
        return f" At {count} more it may be so within the error." if count else ""

    def to_dict(self) -> dict[str, Any]:
        """It as plain data, units in the keys."""
        return {
            "format": self.FORMAT,
            "samples": len(self.frequencies),
            "ports": self.ports,
            "lowest_Hz": self.frequencies[0],
            "highest_Hz": self.frequencies[-1],
            "violated_samples": sum(self.violated),
            "possible_samples": sum(self.possible),
            "violated_Hz": [[band.low, band.high] for band in self.bands],
            self.WORST: self.worst[0],
            f"{self.WORST}_at_Hz": self.worst[1],
            "assumptions": list(self.assumptions),
        }

    def worst_of(self, values: Sequence[float]) -> float:
        """The one that breaks the bound most, or is nearest to it."""
        return max(values) if self.BEYOND > 0 else min(values)

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


def exactly(sample: Any, key: str) -> Pair:
    """The decimals of a matrix."""
    x, y = ([[as_fmpq(number_of(v, key)) for v in row] for row in p] for p in (sample.real, sample.imag))
    return x, y


def has_negative_eigenvalue(hermitian: Pair) -> bool:
    """Decided exactly, of the real symmetric matrix (Re −Im; Im Re)."""
    real, imaginary = hermitian
    upper = [[*r, *(-v for v in i)] for r, i in zip(real, imaginary, strict=True)]
    lower = [[*i, *r] for r, i in zip(real, imaginary, strict=True)]
    return negative_direction(upper + lower) is not None


def _runs(flags: Sequence[bool]) -> Iterator[tuple[int, int]]:
    """(first, last) of each run of True."""
    first = None
    for k, flag in enumerate((*flags, False)):
        if flag and first is None:
            first = k
        elif not flag and first is not None:
            yield first, k - 1
            first = None
