"""An index of a port of one axis: the documents of its proofs and motions."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass
from fractions import Fraction
from math import cos, pi
from typing import Any

from zwidth.passivity.certificate import positivity_document
from zwidth.passivity.ports.extracted import Extraction
from zwidth.passivity.ports.extraction import find_motion
from zwidth.passivity.ports.index import PassivityIndex
from zwidth.passivity.ports.port import Port
from zwidth.passivity.ports.port_motion import Motion, absorbed, played
from zwidth.passivity.ports.positive_real import OFFSET, pole_places, prove_level


@dataclass(frozen=True, repr=False)
class PortExtraction(Extraction):
    """A motion of one axis."""

    port: Port
    motion: Motion

    def signals(self, points: int = 1000) -> tuple[list[float], list[float], list[float]]:
        """(t [s], u, y), u with a peak of 1; of a discrete port its samples, whatever `points`."""
        t, u, y = played(self.port, self.motion, points)
        if self.document["index"] == "output":
            u, y = y, u
        peak = max(map(abs, u)) or 1.0
        return t, [a / peak for a in u], [a / peak for a in y]

    def _samples(self) -> int:
        return len(self.motion.numbers)


@dataclass(frozen=True, repr=False)
class PortIndex(PassivityIndex):
    """An index of F = N/D: the least Re F."""

    port: Port

    def places(self) -> list[complex]:
        """Poles and zeros of F, to rounding."""
        return [*pole_places(self.port), *pole_places(self.port.inverse())]

    def curve(self, frequencies: Sequence[float]) -> list[float]:
        """Re F at these frequencies [Hz]; ±inf or nan at a pole."""
        port = self.port
        if port.time == "discrete":
            cosines = [Fraction(cos(2 * pi * f * float(port.period))) for f in frequencies]
        else:
            squares = [Fraction(2 * pi * f) ** 2 for f in frequencies]
            cosines = [(1 - x) / (1 + x) for x in squares]
        return [port.real_part_at(c) for c in cosines]

    def _proof(self, level: Fraction) -> dict[str, Any] | None:
        proof = prove_level(self.port, level)
        if proof is None:
            return None
        return {
            "kind": "positive real",
            "proof": {"offset": str(OFFSET), "positivity": positivity_document(proof)},
        }

    def _extraction(self, level: Fraction, cosine: Fraction | None) -> Extraction | None:
        motion = find_motion(self.port, level, cosine)
        if motion is None:
            return None
        taken = -absorbed(self.port, level, motion)
        size = absorbed(self.port, Fraction(0), motion) - absorbed(self.port, Fraction(1), motion)
        document = self._document({"kind": "extraction", "motion": _motion_document(motion)}, level)
        return PortExtraction(document, float(taken / size), self.port, motion)

    def _system(self) -> dict[str, Any]:
        own = self.port if self.name == "input" else self.port.inverse()
        return {
            "time": own.time,
            "numerator": [str(c) for c in reversed(own.numerator)],
            "denominator": [str(c) for c in reversed(own.denominator)],
        }


def _motion_document(motion: Motion) -> dict[str, Any]:
    numbers = [str(x) for x in motion.numbers]
    if motion.kind == "sequence":
        return {"kind": "sequence", "latent": numbers}
    if motion.kind == "burst":
        step, cycles, power = numbers
        return {"kind": "burst", "step_rad_per_s": step, "cycles": cycles, "power": power}
    tau, lowest, *coefficients = numbers
    scaled = {"duration_s": tau, "lowest_power": lowest, "coefficients": coefficients}
    return {"kind": "polynomial", **scaled}
