"""An index of a port of several axes: the documents of its proofs and motions."""

from __future__ import annotations

from cmath import phase
from collections.abc import Iterable, Sequence
from dataclasses import dataclass
from fractions import Fraction
from typing import Any

from zwidth.passivity.certificate import positivity_document
from zwidth.passivity.ports.extracted import Extraction
from zwidth.passivity.ports.index import PassivityIndex
from zwidth.passivity.ports.multiport.extraction import find_matrix_motion
from zwidth.passivity.ports.multiport.gaussian import answer, place, to_float
from zwidth.passivity.ports.multiport.motion import MatrixMotion, Signals, absorbed, played
from zwidth.passivity.ports.multiport.port import MatrixPort
from zwidth.passivity.ports.multiport.positive_real import MatrixProof, prove_matrix_level
from zwidth.passivity.ports.positive_real import OFFSET, places_of


@dataclass(frozen=True, repr=False)
class MatrixExtraction(Extraction):
    """A motion of several axes."""

    port: MatrixPort
    motion: MatrixMotion

    @property
    def phasors(self) -> list[tuple[float, float]]:
        """Of a burst, each input's (amplitude, the largest 1; phase [rad]) at the middle frequency."""
        if self.kind != "burst":
            return []
        u = self._inputs_at_middle()
        largest = max(u, key=abs)
        return [(abs(a / largest), phase(a / largest)) for a in u]

    def signals(self, points: int = 1000) -> tuple[list[float], Signals, Signals]:
        """(t [s], u, y), a list of signals each, the largest u 1; of a discrete port its samples."""
        t, u, y = played(self.port, self.motion, points)
        if self.document["index"] == "output":
            u, y = y, u
        peak = max(abs(a) for axis in u for a in axis) or 1.0
        return t, [[a / peak for a in axis] for axis in u], [[a / peak for a in axis] for axis in y]

    def _samples(self) -> int:
        return len(self.motion.axes[0])

    def _form(self) -> str:
        return f"{super()._form()} in {self.port.axes} axes"

    def _inputs_at_middle(self) -> list[complex]:
        step, cycles, _ = self.motion.numbers
        side = self.port.inputs if self.document["index"] == "input" else self.port.outputs
        at = place(self.port, step * cycles)
        return [
            complex(to_float(a.real), to_float(a.imaginary)) for a in answer(side, at, self.motion.latent)
        ]


@dataclass(frozen=True, repr=False)
class MatrixIndex(PassivityIndex):
    """An index of a port of several axes: the least eigenvalue of the Hermitian part of N D⁻¹."""

    port: MatrixPort

    def places(self) -> list[complex]:
        """Poles and zeros of the port, to rounding."""
        both = (self.port.poles(), self.port.inverse().poles())
        return [r for p in both if p is not None for r in places_of([int(c) for c in p.numer().coeffs()])]

    def curve(self, frequencies: Sequence[float]) -> list[float]:
        """The least eigenvalue at these frequencies [Hz], to rounding; nan at a pole."""
        return self.curves(frequencies)[0]

    def curves(self, frequencies: Sequence[float]) -> list[list[float]]:
        """All eigenvalues, the least first, each at these frequencies [Hz]."""
        return [list(curve) for curve in zip(*self.port.eigenvalues(frequencies), strict=True)]

    def _proof(self, level: Fraction) -> dict[str, Any] | None:
        proof = prove_matrix_level(self.port, level)
        return None if proof is None else {"kind": "positive real matrix", "proof": _proof_document(proof)}

    def _extraction(self, level: Fraction, cosine: Fraction | None) -> Extraction | None:
        motion = find_matrix_motion(self.port, level, cosine)
        if motion is None:
            return None
        taken = -absorbed(self.port, level, motion)
        size = absorbed(self.port, Fraction(0), motion) - absorbed(self.port, Fraction(1), motion)
        document = self._document({"kind": "matrix extraction", "motion": _motion_document(motion)}, level)
        return MatrixExtraction(document, float(taken / size) if size else float("inf"), self.port, motion)

    def _system(self) -> dict[str, Any]:
        own = self.port if self.name == "input" else self.port.inverse()
        return {
            "time": own.time,
            "numerators": [[_text(reversed(p)) for p in row] for row in own.outputs],
            "denominator": _text(reversed(own.denominator)),
        }


def _proof_document(proof: MatrixProof) -> dict[str, Any]:
    return {
        "offset": str(OFFSET),
        "minors": [
            {"power": minor.power, "positivity": positivity_document(minor.positivity)}
            for minor in proof.minors
        ],
        "resolvent": {
            "numerators": [[_text(reversed(p)) for p in row] for row in proof.numerators],
            "denominator": _text(reversed(proof.denominator)),
        },
    }


def _motion_document(motion: MatrixMotion) -> dict[str, Any]:
    axes = [_text(axis) for axis in motion.axes]
    numbers = [str(x) for x in motion.numbers]
    if motion.kind == "sequence":
        return {"kind": "sequence", "latent": axes}
    if motion.kind == "burst":
        step, cycles, power = numbers
        waves = {"cosine": [a for a, _ in axes], "sine": [b for _, b in axes]}
        return {"kind": "burst", "step_rad_per_s": step, "cycles": cycles, "power": power, **waves}
    tau, lowest = numbers
    return {"kind": "polynomial", "duration_s": tau, "lowest_power": lowest, "coefficients": axes}


def _text(values: Iterable[Fraction | int]) -> list[str]:
    return [str(x) for x in values]
