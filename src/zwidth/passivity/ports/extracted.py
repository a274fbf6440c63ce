"""A motion by which a port gives out more than a level of its index allows."""

from __future__ import annotations

from abc import ABC, abstractmethod
from dataclasses import dataclass
from fractions import Fraction
from math import pi
from typing import Any, Literal, Protocol

from zwidth.passivity.ports.port import Time
from zwidth.passivity.result import Evidence


class AnyPort(Protocol):
    """What an index and a motion ask of a port, of one axis or of several."""

    @property
    def time(self) -> Time:
        """ "continuous" or "discrete"."""

    @property
    def period(self) -> Fraction:
        """T [s] of a discrete port."""

    @property
    def hidden_modes_decay(self) -> bool:
        """False when a mode that the port does not show does not decay."""

    def frequency(self, cosine: Fraction) -> float:
        """ω/2π [Hz] of c = cos θ."""


class AnyMotion(Protocol):
    """A latent motion φ, with its numbers as `port_motion` has them."""

    @property
    def kind(self) -> Literal["burst", "polynomial", "sequence"]:
        """How φ is made."""

    @property
    def numbers(self) -> tuple[Fraction, ...]:
        """burst: Ω [rad/s], m, k.  polynomial: τ [s] …"""


@dataclass(frozen=True, repr=False)
class Extraction(Evidence, ABC):
    """An input from rest by which a port gives out more than a level of its index allows.

    Attributes
    ----------
    document
        The system, the level and the motion, as the independent checker reads them.
    share
        What comes out above the level, per ∫ u² (∫ y² for the output index).
    port, motion
        F and φ, from which u and y follow.
    """

    document: dict[str, Any]
    share: float
    port: AnyPort
    motion: AnyMotion

    @property
    def kind(self) -> str:
        """ "burst", a sinusoid that fades in and out; "polynomial" or "sequence"."""
        return self.motion.kind

    @property
    def frequency(self) -> float | None:
        """Of a burst, its middle frequency [Hz]; None for another motion."""
        if self.motion.kind != "burst":
            return None
        step, cycles, _ = self.motion.numbers
        return float(step * cycles) / (2 * pi)

    @abstractmethod
    def signals(self, points: int = 1000) -> tuple[list[float], Any, Any]:
        """(t [s], u, y), u with a peak of 1; of a discrete port its samples, whatever `points`.

        With several axes u and y are lists of one signal for each.
        """

    def to_dict(self) -> dict[str, Any]:
        """The motion as plain data."""
        return self.document

    def describe(self) -> str:
        """The motion in a sentence."""
        of = "∫u²" if self.document["index"] == "input" else "∫y²"
        if self.port.time == "discrete":
            of = of.replace("∫", "Σ")
        return f"{self._form()}, from rest: {self.share:.4g} {of} comes out above the level"

    def _form(self) -> str:
        if self.kind == "burst":
            return f"a burst of {self.frequency or 0:.6g} Hz"
        if self.kind == "polynomial":
            return f"a polynomial over {float(self.motion.numbers[0]):.4g} s"
        return f"{self._samples()} samples"

    @abstractmethod
    def _samples(self) -> int:
        """How many numbers a sequence has for each axis."""

    def __repr__(self) -> str:
        return f"<Extraction {self.describe()}>"
