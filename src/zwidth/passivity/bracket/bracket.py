"""The last value of a parameter that is proved passive, and the first that is refuted."""

from __future__ import annotations

from dataclasses import dataclass
from math import inf
from typing import Any

from zwidth.passivity.bracket.parameter import more_is_safer
from zwidth.passivity.certificate import Certificate
from zwidth.passivity.result import Result, evidence_of
from zwidth.passivity.scope import Scope
from zwidth.passivity.storage.evidence.gain import Gain
from zwidth.passivity.storage.evidence.storage_function import StorageFunction
from zwidth.passivity.storage.hand_bounds import HandBounds
from zwidth.passivity.storage.row.storage_function import RowStorage
from zwidth.passivity.witness.violation import Violation
from zwidth.passivity.witness.witness import Witness
from zwidth.passivity.wording import describe_hands, lines
from zwidth.quantity.glossary import unit_suffix
from zwidth.quantity.text import at_least, at_most, in_unit, in_words


@dataclass(frozen=True, repr=False)
class Bracket(Result):
    """The last value of a parameter that is proved passive, and the first that is refuted.

    Attributes
    ----------
    parameter, unit
        Which, and its SI unit.
    proved_passive, proved_active
        Proved passive; refuted.  None where no such value was found.
    certificate
        The proof at the one value.
    witness
        The motion at the other.
    scope
        What it is about: every hand, or hands within bounds; contact; what of the actuator is counted.
    every_hand
        What is known of every hand, where the bracket is about bounded ones: the
        last value proved passive and the first refuted; None where there is none.
    evaluations, seconds
        Loops decided, and the time that took [s].
    storage
        The storage function at `proved_passive`, to look at; None where a closed condition proves it.
    bounds
        The bounds on the hand, exact; None where the bracket is about every hand.
    violation
        What of the linear criterion is violated at `proved_active`, where closed conditions found it.
    cut_by_time
        True where a time that was given ended the search: another machine may find a closer one.
    """

    FORMAT = "zwidth limit 1"
    PICTURE = "limit_figure"

    parameter: str
    unit: str
    proved_passive: float | None
    proved_active: float | None
    certificate: Certificate | None
    witness: Gain | Witness | None
    scope: Scope
    every_hand: tuple[float | None, float | None]
    evaluations: int
    seconds: float
    storage: StorageFunction | RowStorage | None = None
    bounds: HandBounds | None = None
    violation: Violation | None = None
    cut_by_time: bool = False

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
        """|proved_active − proved_passive| over the larger of the two; inf where one is missing."""
        if self.proved_passive is None or self.proved_active is None:
            return inf
        return abs(self.proved_active - self.proved_passive) / max(self.proved_active, self.proved_passive)

    def outward(
        self, values: tuple[float | None, float | None], digits: int = 6
    ) -> tuple[float | None, float | None]:
        """A proved and a refuted value so rounded that each still is: away from what is between them."""
        sides = (at_least, at_most) if more_is_safer(self.parameter) else (at_most, at_least)
        proved, refuted = (side(v, self.unit, digits) for side, v in zip(sides, values, strict=True))
        return proved, refuted

    def describe(self) -> str:
        """The bracket in a sentence."""
        name = in_words(self.parameter).replace("environment.", "").replace("device.", "device ")
        if self.proved_passive is None and self.proved_active is None:
            given = "in the time given" if self.cut_by_time else "with the effort given"
            return f"{name}: nothing was decided {given}"
        ends = self.outward((self.proved_passive, self.proved_active))
        passive, active = (in_unit(value, self.unit) for value in ends)
        if self.proved_active is None:
            return f"{name}: {passive} is proved passive, and nothing is refuted"
        if self.proved_passive is None:
            return f"{name}: no value is proved passive; {active} is active"
        return f"{name}: {passive} is proved passive, {active} is active, for {self.hand}"

    def to_dict(self) -> dict[str, Any]:
        """Values, assumptions and evidence as plain data."""
        suffix = unit_suffix(self.unit)
        return {
            "format": self.FORMAT,
            "parameter": self.parameter,
            f"proved_passive_{suffix}": self.proved_passive,
            f"proved_active_{suffix}": self.proved_active,
            "relative_width": None if self.relative_width == inf else self.relative_width,
            "hand": self.hand,
            "scope": self.scope.to_dict(),
            f"every_hand_{suffix}": list(self.every_hand),
            "assumptions": list(self.assumptions),
            "evaluations": self.evaluations,
            **({"cut_by_time": True} if self.cut_by_time else {}),
            **evidence_of(self),
        }
