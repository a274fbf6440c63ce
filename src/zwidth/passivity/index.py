"""One passivity index of a port, what proves it and what refutes more.

    input   ν = max σ: ∫ u y ≥ σ ∫ u²      G − ν positive real
    output  ρ = max σ: ∫ u y ≥ σ ∫ y²      1/G − ρ positive real, G/(1 − ρ G) passive

from rest, for every u and every time (in discrete time sums).  Both are one
question, of F = G and of F = 1/G: see `positive_real`.
"""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass
from fractions import Fraction
from functools import cached_property
from math import cos, inf, nextafter, pi
from pathlib import Path
from typing import Any, Literal

from zwidth.errors import InputError
from zwidth.passivity import checker
from zwidth.passivity.certificate import FORMAT, Certificate, positivity_document
from zwidth.passivity.document import to_json
from zwidth.passivity.extraction import find_motion
from zwidth.passivity.port import Port
from zwidth.passivity.port_motion import Motion, absorbed, played
from zwidth.passivity.positive_real import OFFSET, Largest, NoLevel, prove_level
from zwidth.quantity.exact import Exact, RealLike

Which = Literal["input", "output"]


@dataclass(frozen=True)
class Extraction:
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
        if self.motion.kind != "burst":
            return None
        step, cycles, _ = self.motion.numbers
        return float(step * cycles) / (2 * pi)

    def signals(self, points: int = 1000) -> tuple[list[float], list[float], list[float]]:
        """(t [s], u, y), u with a peak of 1; of a discrete port its samples, whatever `points`."""
        t, u, y = played(self.port, self.motion, points)
        if self.document["index"] == "output":
            u, y = y, u
        peak = max(map(abs, u)) or 1.0
        return t, [a / peak for a in u], [a / peak for a in y]

    def verify(self) -> bool:
        """True when the independent checker sums the same sign."""
        return checker.verify(self.document).valid

    def to_dict(self) -> dict[str, Any]:
        """The motion as plain data."""
        return self.document

    def save(self, path: str | Path) -> None:
        """Write it as JSON for `zwidth verify`."""
        Path(path).write_text(to_json(self.document) + "\n", encoding="utf-8")

    def describe(self) -> str:
        """The motion in a sentence."""
        of = "∫u²" if self.document["index"] == "input" else "∫y²"
        if self.port.time == "discrete":
            of = of.replace("∫", "Σ")
        form = {
            "burst": f"a burst of {self.frequency or 0:.6g} Hz",
            "polynomial": f"a polynomial over {float(self.motion.numbers[0]):.4g} s",
            "sequence": f"{len(self.motion.numbers)} samples",
        }[self.kind]
        return f"{form}, from rest: {self.share:.4g} {of} comes out above the level"

    def __repr__(self) -> str:
        return f"<Extraction {self.describe()}>"

    def _repr_html_(self) -> str:
        return f"<p>{self.describe()}</p>"


@dataclass(frozen=True)
class PassivityIndex:
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
        value = float(self.found.low)
        while Fraction(repr(value)) > self.found.low:
            value = nextafter(value, -inf)
        return value

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
        document = {
            **self._document("positive real", at),
            "proof": {"offset": str(OFFSET), "positivity": positivity_document(proof)},
        }
        return Certificate((document,))

    def refute(self, level: RealLike = 0) -> Extraction | None:
        """A motion by which the port gives out more than this level allows.

        None if the level holds; or, though it does not, where no motion was found that the
        checker can sum: growth too slow, too near to the limit.
        """
        at = Exact(level).fraction
        if self.at_least(level):
            return None
        cosine = self.found.cosine if isinstance(self.found, Largest) else None
        motion = find_motion(self.port, at, cosine)
        if motion is None:
            return None
        taken = -absorbed(self.port, at, motion)
        size = absorbed(self.port, Fraction(0), motion) - absorbed(self.port, Fraction(1), motion)
        document = {**self._document("extraction", at), "motion": _motion_document(motion)}
        return Extraction(document, float(taken / size), self.port, motion)

    def curve(self, frequencies: Sequence[float]) -> list[float]:
        """Re F at these frequencies [Hz]; ±inf or nan at a pole."""
        port = self.port
        if port.time == "discrete":
            cosines = [Fraction(cos(2 * pi * f * float(port.period))) for f in frequencies]
        else:
            squares = [Fraction(2 * pi * f) ** 2 for f in frequencies]
            cosines = [(1 - x) / (1 + x) for x in squares]
        return [port.real_part_at(c) for c in cosines]

    def describe(self) -> str:
        """The index in a line."""
        symbol = {"input": "ν", "output": "ρ"}[self.name]
        if self.found is None:
            return f"{symbol} = ∞: the output is zero"
        if isinstance(self.found, NoLevel):
            return f"{symbol} = −∞: {self.reason}"
        f = self.frequency
        place = (
            "at every frequency" if f is None else "as the frequency grows" if f == inf else f"at {f:.6g} Hz"
        )
        return f"{symbol} = {self.value:.9g} {place}".replace("-", "−")

    def __repr__(self) -> str:
        return f"<PassivityIndex {self.name} {self.describe()}>"

    def _repr_html_(self) -> str:
        return f"<p>{self.name} index {self.describe()}</p>"

    def _document(self, kind: str, level: Fraction) -> dict[str, Any]:
        own = self.port if self.name == "input" else self.port.inverse()
        system = {
            "time": own.time,
            "numerator": [str(c) for c in reversed(own.numerator)],
            "denominator": [str(c) for c in reversed(own.denominator)],
        }
        return {"format": FORMAT, "kind": kind, "index": self.name, "level": str(level), "system": system}


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
