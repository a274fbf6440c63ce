"""The last value of a parameter that is proved passive, and the first that is refuted."""

from __future__ import annotations

from dataclasses import dataclass
from math import inf
from pathlib import Path
from typing import Any

from zwidth.passivity.certificate import Certificate
from zwidth.passivity.document import save_json
from zwidth.passivity.scope import Scope
from zwidth.passivity.storage.gain import Gain
from zwidth.passivity.storage.hand_bounds import HandBounds
from zwidth.passivity.storage.row_storage import RowStorage
from zwidth.passivity.storage.storage import Storage
from zwidth.passivity.witness.violation import Violation
from zwidth.passivity.witness.witness import Witness, rounded_energy
from zwidth.passivity.wording import describe_hands, lines
from zwidth.quantity.glossary import unit_suffix
from zwidth.showing import Html, bullets, element


@dataclass(frozen=True)
class Bracket:
    """The last value of a parameter that is proved passive, and the first that is refuted.

    Attributes
    ----------
    parameter, unit
        Which, and its SI unit.
    passive, active
        Proved passive; refuted.  None where no such value was found.
    certificate, witness
        The evidence at either value.
    scope
        What it is about: every hand, or hands within bounds; contact; what of the actuator is counted.
    every_hand
        What is known of every hand, where the bracket is about bounded ones: the
        last value proved passive and the first refuted; None where there is none.
    evaluations, seconds
        Loops decided, and the time that took [s].
    storage
        The storage function at `passive`, to look at; None where a closed condition proves it.
    bounds
        The bounds on the hand, exact; None where the bracket is about every hand.
    violation
        What of the linear criterion is violated at `active`, where closed conditions found it.
    """

    parameter: str
    unit: str
    passive: float | None
    active: float | None
    certificate: Certificate | None
    witness: Gain | Witness | None
    scope: Scope
    every_hand: tuple[float | None, float | None]
    evaluations: int
    seconds: float
    storage: Storage | RowStorage | None = None
    bounds: HandBounds | None = None
    violation: Violation | None = None

    @property
    def hand(self) -> str:
        """The hands that the bracket is about, in words: "every hand", or bounds."""
        return describe_hands(self.scope.hands, self.scope.motion)

    @property
    def assumptions(self) -> tuple[str, ...]:
        """What the proof covers and takes for granted, line by line."""
        return lines(self.scope)

    @property
    def relative_width(self) -> float:
        """|active − passive| over the larger of the two; inf where one is missing."""
        if self.passive is None or self.active is None:
            return inf
        return abs(self.active - self.passive) / max(self.active, self.passive)

    def describe(self) -> str:
        """The bracket in a sentence."""
        name = self.parameter.replace("_", " ").replace("environment.", "").replace("device.", "device ")
        if self.passive is None and self.active is None:
            return f"{name}: nothing was decided in the time given"
        if self.active is None:
            return f"{name}: {self.passive:.6g} {self.unit} is proved passive, and nothing is refuted"
        if self.passive is None:
            return f"{name}: no value is proved passive; {self.active:.6g} {self.unit} is active"
        return (
            f"{name}: {self.passive:.6g} {self.unit} is proved passive, {self.active:.6g} {self.unit} is "
            f"active, for {self.hand}"
        )

    def to_dict(self) -> dict[str, Any]:
        """Values, assumptions and evidence as plain data."""
        suffix = unit_suffix(self.unit)
        document: dict[str, Any] = {
            "format": "zwidth limit 1",
            "parameter": self.parameter,
            f"proved_passive_{suffix}": self.passive,
            f"proved_active_{suffix}": self.active,
            "relative_width": None if self.relative_width == inf else self.relative_width,
            "hand": self.hand,
            "scope": self.scope.to_dict(),
            f"every_hand_{suffix}": list(self.every_hand),
            "assumptions": list(self.assumptions),
            "evaluations": self.evaluations,
        }
        if self.certificate is not None:
            document["certificate"] = self.certificate.to_dict()
        if self.violation is not None:
            document["violation"] = self.violation.to_dict()
        if self.witness is not None:
            document["witness"] = rounded_energy(self.witness.to_dict())
        return document

    def save(self, path: str | Path) -> None:
        """Write the bracket with its evidence as JSON for `zwidth verify`."""
        save_json(path, self.to_dict())

    def __repr__(self) -> str:
        return f"<Bracket {self.describe()}>"

    def _repr_html_(self) -> Html:
        assumed = element("details", element("summary", "assumptions"), bullets(self.assumptions))
        return element("div", self.describe(), assumed)
