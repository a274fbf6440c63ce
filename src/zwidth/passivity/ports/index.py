"""One passivity index of a port, what proves it and what refutes more.

    input   ν = max σ: ∫ uᵀy ≥ σ ∫ uᵀu      G − ν positive real
    output  ρ = max σ: ∫ uᵀy ≥ σ ∫ yᵀy      1/G − ρ positive real, G (1 − ρ G)⁻¹ passive

from rest, for every u and every time (in discrete time sums).  Both are one
question, of F = G and of F = 1/G, of one axis and of several: see `positive_real`.
"""

from __future__ import annotations

from collections.abc import Iterable, Sequence
from dataclasses import dataclass
from fractions import Fraction
from functools import cached_property
from math import inf
from typing import TYPE_CHECKING, Any, Literal

from zwidth.errors import InputError
from zwidth.passivity.certificate import Certificate
from zwidth.passivity.ports.circle import places_of
from zwidth.passivity.ports.evidence import (
    ExtractingInput,
    find_motion,
    index_document,
    motion_document,
    proof_document,
)
from zwidth.passivity.ports.largest import Largest, NoLevel
from zwidth.passivity.ports.motion import absorbed
from zwidth.passivity.ports.port import Port, typed_at_most
from zwidth.passivity.ports.positive_real import Band, bands, prove_level
from zwidth.passivity.result import PassivityAnswer
from zwidth.passivity.scope import Outcome, Scope
from zwidth.quantity.exact import Exact, RealLike
from zwidth.quantity.text import shown
from zwidth.showing import Part, Shown

Which = Literal["input", "output"]


def told_place(frequency: float | None) -> str:
    """Where a value is reached: everywhere, in the limit, or at so many hertz."""
    if frequency is None:
        return "at every frequency"
    return "as the frequency grows" if frequency == inf else f"at {shown(frequency, 'Hz', 6)}"


@dataclass(frozen=True, repr=False)
class PassivityIndex(Shown):
    """The largest level σ of one index, with where it is reached.

    Attributes
    ----------
    name
        "input" or "output".
    port
        F: G for the input index, 1/G for the output index.
    found
        What was found, exact; None where every level holds, for G = 0.
    """

    name: Which
    port: Port
    found: Largest | NoLevel | None

    @cached_property
    def value(self) -> float:
        """The largest double that is proved; −inf where no level holds, inf where every one does."""
        if self.found is None:
            return inf
        if isinstance(self.found, NoLevel):
            return -inf
        return typed_at_most(self.found.low)

    @property
    def exact(self) -> Fraction | None:
        """The index itself where it is rational and was found to be; otherwise None."""
        found = self.found
        return found.low if isinstance(found, Largest) and found.low == found.high else None

    @property
    def bounds(self) -> tuple[Fraction, Fraction] | None:
        """Rationals between which the index lies, proved; None where it is infinite."""
        return (self.found.low, self.found.high) if isinstance(self.found, Largest) else None

    @property
    def frequency(self) -> float | None:
        """Where it is reached [Hz], of equals the lowest; inf in the limit; None: nowhere, or everywhere."""
        if not isinstance(self.found, Largest) or self.found.cosine is None:
            return None
        return self.port.frequency(self.found.cosine)

    @property
    def reason(self) -> str:
        """Why no level holds; empty where one does."""
        return self.found.reason if isinstance(self.found, NoLevel) else ""

    def at_least(self, level: RealLike) -> bool:
        """Whether the index is at least this level, decided exactly."""
        return self.found is None or prove_level(self.port, Exact(level).fraction) is not None

    def certificate(self, level: RealLike | None = None) -> Certificate:
        """The proof that the index is at least this level, by default `value`.

        Raises
        ------
        InputError
            If it is not, or has no finite value.
        """
        if level is None and not isinstance(self.found, Largest):
            raise InputError(f"the {self.name} index is {self.value}; there is nothing to certify")
        at = Fraction(repr(self.value)) if level is None else Exact(level).fraction
        proof = None if self.found is None else prove_level(self.port, at)
        if proof is None:
            raise InputError(
                f"the {self.name} index is {self.value:.17g}, so the level {float(at):.17g} cannot be "
                "certified; give a lower one"
            )
        return Certificate((self._document(proof_document(proof), at),))

    def refute(self, level: RealLike = 0) -> ExtractingInput | None:
        """A motion by which the port gives out more than this level allows.

        None if the level holds; or, though it does not, where no motion was found that the
        checker can sum: growth too slow, too near to the limit.
        """
        if self.at_least(level):
            return None
        cosine = self.found.cosine if isinstance(self.found, Largest) else None
        return self._refuted(Exact(level).fraction, cosine)

    def _refuted(self, at: Fraction, cosine: Fraction | None) -> ExtractingInput | None:
        motion = find_motion(self.port, at, cosine)
        if motion is None:
            return None
        taken = -absorbed(self.port, at, motion)
        size = absorbed(self.port, Fraction(0), motion) - absorbed(self.port, Fraction(1), motion)
        share = float(taken / size) if size else inf
        return ExtractingInput(self._document(motion_document(motion), at), share, self.port, motion)

    def bands(self, level: RealLike = 0) -> tuple[Band, ...]:
        """Where the level is undercut: Re F (the least eigenvalue) < level, in ascending frequency.

        None is not all: a pole where it may not be lets no level hold, whatever the real part; see `reason`.
        """
        return bands(self.port, Exact(level).fraction)

    def refute_in(self, band: Band, level: RealLike = 0) -> ExtractingInput | None:
        """A motion by which the port gives out more than this level allows, near the middle of a band.

        None where none was found that the checker can sum: a narrow band needs a long burst.
        """
        return self._refuted(Exact(level).fraction, band.middle)

    def places(self) -> list[complex]:
        """Poles and zeros of the port, to rounding."""
        both = (self.port.poles(), self.port.inverse().poles())
        return [root for p in both if p is not None for root in places_of(p.numer())]

    def curve(self, frequencies: Sequence[float]) -> list[float]:
        """The real part (least eigenvalue) whose least value is the index, at these frequencies [Hz].

        Of one axis ±inf at a pole of one sign; otherwise nan at a pole.
        """
        return self.curves(frequencies)[0]

    def curves(self, frequencies: Sequence[float]) -> list[list[float]]:
        """All eigenvalues, the least first, each at these frequencies [Hz]."""
        return [list(curve) for curve in zip(*self.port.eigenvalues(frequencies), strict=True)]

    def describe(self) -> str:
        """The index in a line."""
        symbol = {"input": "ν", "output": "ρ"}[self.name]
        if self.found is None:
            return f"{symbol} = ∞: the output is zero"
        if isinstance(self.found, NoLevel):
            return f"{symbol} = −∞: {self.reason}"
        return f"{symbol} = {self.value:.9g} {told_place(self.frequency)}".replace("-", "−")

    def __repr__(self) -> str:
        return f"<PassivityIndex {self.name} {self.describe()}>"

    def report(self) -> Iterable[Part]:
        """Which index, and what it is."""
        yield f"{self.name} index {self.describe()}"

    def _document(self, evidence: dict[str, Any], level: Fraction) -> dict[str, Any]:
        port = self.port if self.name == "input" else self.port.inverse()
        return index_document(self.name, port, level, evidence)


def evidenced(index: PassivityIndex) -> Outcome:
    """ "passive" where the index is proved to be ≥ 0, "active" where a motion shows that it is less."""
    if index.at_least(0):
        return "passive" if index.certificate(0).verify() else "undecided"
    witness = index.refute(0)
    return "active" if witness is not None and witness.verify() else "undecided"


class PortAnswer(PassivityAnswer):
    """Whether a linear port, or of a network the port u → y that its waves make, is passive by itself."""

    if TYPE_CHECKING:
        input: PassivityIndex

    @cached_property
    def outcome(self) -> Outcome:
        """ "passive": ν ≥ 0 with a proof; "active": ν < 0 with a motion; the checker has accepted either."""
        return evidenced(self.input)

    @property
    def scope(self) -> Scope:
        """A linear port by itself: every hand, no surface, no encoder, nothing sampled but what G(z) is."""
        return Scope(contact="both sides", transmission="")

    @property
    def hidden_modes_decay(self) -> bool:
        """False when a mode that cancels between poles and zeros does not decay: nothing here sees it."""
        return self.input.port.hidden_modes_decay

    @property
    def certificate(self) -> Certificate | None:
        """The proof that the port is passive, or S bounded real; None if it is not."""
        return self.input.certificate(0) if self.passive else None

    @cached_property
    def witness(self) -> ExtractingInput | None:
        """A motion from rest, u and y, that takes energy out; None if it is passive, or none was found."""
        return self.input.refute(0)

    @cached_property
    def bands(self) -> tuple[Band, ...]:
        """Where a sinusoid takes energy out, ‖S(jω)‖ > 1, in ascending frequency; () where none does."""
        return self.input.bands()

    def numbers(self) -> dict[str, Any]:
        """What was found, and the bands of violation, as plain data."""
        return {**super().numbers(), "violated_Hz": [[band.low, band.high] for band in self.bands]}

    def __repr__(self) -> str:
        rows = "; ".join(f"{name} {text}" for name, text in self.rows())
        return f"<{type(self).__name__} {self.outcome}: {rows}>"
