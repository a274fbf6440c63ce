"""Is a network of which the waves are known passive?

    b = S a,    power in = |a|² − |b|²,    passive ⇔ S bounded real: stable, ‖S(jω)‖ ≤ 1 at every frequency

(Anderson & Vongpanitlerd, Network Analysis and Synthesis, 1973, ch. 2.)  With u = a − Σb and y = a + Σb,
Σ of signs, uᵀy is that power, and some Σ makes u invertible: then S is bounded real exactly if u → y
is positive real, which is decided, proved and refuted as for every other port.
"""

from __future__ import annotations

from dataclasses import dataclass
from fractions import Fraction
from functools import cached_property
from typing import Any

from zwidth.passivity.certificate import Certificate
from zwidth.passivity.ports.bands import Band, in_words
from zwidth.passivity.ports.extracting_input import ExtractingInput
from zwidth.passivity.ports.index import PassivityIndex, evidenced
from zwidth.passivity.ports.largest import largest_level
from zwidth.passivity.ports.reading import assumed_period, read_port
from zwidth.passivity.ports.relative import RelativeIndex, relative_index
from zwidth.passivity.ports.waves import direct_power_of
from zwidth.passivity.result import PassivityAnswer
from zwidth.passivity.scope import Outcome, Scope


@dataclass(frozen=True, repr=False)
class ScatteringPassivity(PassivityAnswer):
    """What `scattering_passivity` found.

    Attributes
    ----------
    signs
        Σ: which sign each b has in u = a − Σb and y = a + Σb.
    input
        The input index of u → y; ≥ 0 where S is bounded real.
    assumed
        What is assumed of the sample period; () where it is said.
    """

    FORMAT = "zwidth scattering 1"

    signs: tuple[int, ...]
    input: PassivityIndex
    assumed: tuple[str, ...] = ()

    @cached_property
    def outcome(self) -> Outcome:
        """ "passive" with a proof, "active" with waves; the checker has accepted either."""
        return evidenced(self.input)

    @property
    def claim(self) -> str:
        """The outcome in a sentence."""
        if self.outcome == "undecided":
            return "Nothing that the checker accepts was found: nothing is proved."
        if self.outcome == "passive":
            return "No waves into this network, from rest, bring back more than they carry."
        return "Waves into this network, from rest, bring back more than they carry."

    @property
    def assumptions(self) -> tuple[str, ...]:
        """That of which S is the waves; and a sample period that nobody says."""
        return ("every port has a positive real reference, which S was made with", *self.assumed)

    @cached_property
    def gain(self) -> RelativeIndex:
        """‖S‖∞: how much of a wave comes back, at most."""
        return relative_index(self.input.port)

    @property
    def margin(self) -> float:
        """1 − ‖S‖∞."""
        return 1 - self.gain.value

    @cached_property
    def bands(self) -> tuple[Band, ...]:
        """Where ‖S(jω)‖ > 1, in ascending frequency."""
        return self.input.bands()

    @property
    def hidden_modes_decay(self) -> bool:
        """False when a mode that cancels between poles and zeros does not decay: no wave shows it."""
        return self.input.port.hidden_modes_decay

    @property
    def certificate(self) -> Certificate | None:
        """The proof that S is bounded real: of u → y; None if it is not."""
        return self.input.certificate(0) if self.passive else None

    @cached_property
    def witness(self) -> ExtractingInput | None:
        """Signals u and y by which more comes back; None if S is bounded real, or none were found."""
        return self.input.refute(0)

    def waves(self, points: int = 1000) -> tuple[list[float], list[list[float]], list[list[float]]] | None:
        """(t [s], a, b) of the witness, a signal for each port; None where there is no witness."""
        if self.witness is None:
            return None
        t, u, y = self.witness.signals(points)
        if len(self.signs) == 1:
            u, y = [u], [y]
        a = [[(p + q) / 2 for p, q in zip(*axis, strict=True)] for axis in zip(u, y, strict=True)]
        b = [
            [sign * (q - p) / 2 for p, q in zip(*axis, strict=True)]
            for sign, axis in zip(self.signs, zip(u, y, strict=True), strict=True)
        ]
        return t, a, b

    @property
    def scope(self) -> Scope:
        """A linear network by itself."""
        return Scope(contact="both sides", transmission="")

    def rows(self) -> list[tuple[str, str]]:
        """The main numbers as (name, text) for a report."""
        rows = [("largest gain", self.gain.describe().replace("R = ", "‖S‖ = "))]
        if self.bands:
            rows.append(("violated", in_words(self.bands)))
        if not self.hidden_modes_decay:
            rows.append(("hidden", "a cancelled mode does not decay"))
        return rows

    def numbers(self) -> dict[str, Any]:
        """The signs Σ, ‖S‖∞ and the bands of violation, as plain data."""
        return {
            "signs": list(self.signs),
            "largest_gain": self.gain.value,
            "violated_Hz": [[band.low, band.high] for band in self.bands],
        }

    def __repr__(self) -> str:
        rows = "; ".join(f"{name} {text}" for name, text in self.rows())
        return f"<ScatteringPassivity {self.outcome}: {rows}>"


def scattering_passivity(system: Any) -> ScatteringPassivity:
    """Whether S is bounded real, exactly, with a proof or with waves that bring back more than they carry.

    Parameters
    ----------
    system
        S, a rational matrix from incident waves a to reflected waves b, each port with a positive real
        reference: a system of python-control, scipy.signal or harold, continuous or discrete.  For a
        table of measured or simulated samples there is `scattering_table`.

    Raises
    ------
    InputError
        As `passivity_indices`.
    """
    signs, port = direct_power_of(read_port(system), Fraction(1))
    return ScatteringPassivity(
        signs, PassivityIndex("input", port, largest_level(port)), assumed_period(system)
    )
