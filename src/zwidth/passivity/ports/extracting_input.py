"""An input by which a port gives out more than a level of its index allows."""

from __future__ import annotations

from cmath import phase
from dataclasses import dataclass
from fractions import Fraction
from math import pi
from typing import Any

from zwidth.passivity.ports.gaussian import answer, place, to_float
from zwidth.passivity.ports.motion import Motion, played
from zwidth.passivity.ports.port import Port
from zwidth.passivity.result import Evidence


@dataclass(frozen=True, repr=False)
class ExtractingInput(Evidence):
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
    port: Port
    motion: Motion

    @property
    def kind(self) -> str:
        """ "burst", a sinusoid that fades in and out; "polynomial" or "sequence"."""
        return self.motion.kind

    @property
    def frequency(self) -> float | None:
        """Of a burst, its middle frequency [Hz]; None for another motion."""
        return None if self.kind != "burst" else float(self._middle()) / (2 * pi)

    @property
    def phasors(self) -> list[tuple[float, float]]:
        """Of a burst, each input's (amplitude, the largest 1; phase [rad]) at the middle frequency."""
        if self.kind != "burst":
            return []
        side = self.port.inputs if self._is_of_input() else self.port.outputs
        found = answer(side, place(self.port, self._middle()), self.motion.latent)
        u = [complex(to_float(a.real), to_float(a.imaginary)) for a in found]
        largest = max(u, key=abs)
        return [(abs(a / largest), phase(a / largest)) for a in u]

    def signals(self, points: int = 1000) -> tuple[list[float], Any, Any]:
        """(t [s], u, y), u with a peak of 1; of a discrete port its samples, whatever `points`.

        With several axes u and y are lists of one signal for each.
        """
        t, u, y = played(self.port, self.motion, points)
        if not self._is_of_input():
            u, y = y, u
        peak = max(abs(a) for axis in u for a in axis) or 1.0
        u, y = ([[a / peak for a in axis] for axis in side] for side in (u, y))
        return (t, u[0], y[0]) if self.port.axes == 1 else (t, u, y)

    def to_dict(self) -> dict[str, Any]:
        """The motion as plain data."""
        return self.document

    def describe(self) -> str:
        """The motion in a sentence."""
        of = "∫u²" if self._is_of_input() else "∫y²"
        if self.port.time == "discrete":
            of = of.replace("∫", "Σ")
        axes = f" in {self.port.axes} axes" if self.port.axes > 1 else ""
        return f"{self._form()}{axes}, from rest: {self.share:.4g} {of} comes out above the level"

    def _form(self) -> str:
        if self.kind == "burst":
            return f"a burst of {self.frequency or 0:.6g} Hz"
        if self.kind == "polynomial":
            return f"a polynomial over {float(self.motion.numbers[0]):.4g} s"
        return f"{len(self.motion.axes[0])} samples"

    def _is_of_input(self) -> bool:
        return bool(self.document["index"] == "input")

    def _middle(self) -> Fraction:
        """The middle frequency of a burst [rad/s]."""
        step, cycles, _ = self.motion.numbers
        return step * cycles
