"""A violation of the linear criterion: by itself a proof that a loop is active.

A frequency at which the criterion is negative, a negative static stiffness or
an unstable law: each lets a hand take out any amount of energy, whatever
Coulomb friction and encoder are (docs/theory/criterion.md).  The proof is a
number and a sign; the motion that shows it is made when it is asked for.
"""

from __future__ import annotations

from dataclasses import dataclass
from fractions import Fraction
from functools import cached_property
from typing import Any

from zwidth.passivity.document import loop_document
from zwidth.passivity.linear.linear import LinearRefutation, offset_of
from zwidth.passivity.linear.supremum import frequency
from zwidth.passivity.result import Evidence
from zwidth.passivity.scope import Contact
from zwidth.passivity.witness.refutation import refute_linear
from zwidth.passivity.witness.witness import Setting, Witness
from zwidth.quantity.text import exact_text, told_quantity

FORMAT = "zwidth violation 1"


@dataclass(frozen=True, repr=False)
class Violation(Evidence):
    """A proof that a hand can take any amount of energy out of a loop.

    Parameters
    ----------
    setting
        The loop, with Coulomb friction, encoder and surface.
    refutation
        What is violated, and where.
    """

    setting: Setting
    refutation: LinearRefutation

    @property
    def frequency(self) -> float | None:
        """A frequency at which the criterion is violated [Hz]; None where something else is."""
        cosine = self.refutation.cosine
        return None if cosine is None else frequency(cosine, self.setting.loop.period)

    @cached_property
    def witness(self) -> Witness | None:
        """A motion that takes energy out; None where none that was found is short enough to be checked."""
        return refute_linear(self.setting, self.refutation.reason)

    @property
    def contact(self) -> Contact:
        """A hand that stays inside finds it; or there is no surface."""
        return "kept" if self.setting.unilateral else "both sides"

    def to_dict(self) -> dict[str, Any]:
        """The violation as plain data."""
        s = self.setting
        loop = loop_document(s.loop, s.coulomb_friction, s.resolution, s.unilateral, s.motion)
        return {"format": FORMAT, "kind": "violation", "loop": loop, "proof": self._proof()}

    def _proof(self) -> dict[str, Any]:
        reason, cosine = self.refutation.reason, self.refutation.cosine
        if cosine is not None:
            return {"kind": reason, "cosine": exact_text(cosine)}
        if reason == "unstable environment" and self.setting.loop.part_delay == 0:
            return {"kind": reason, "offset": exact_text(offset_of(self.setting.loop))}
        return {"kind": reason}

    def describe(self) -> str:
        """What is violated, in words."""
        if self.frequency is not None:
            return f"at {self.frequency:.6g} Hz the linear criterion is violated"
        if self.refutation.reason == "negative static stiffness":
            return f"pressed slowly, the law pulls the hand in ({self._static()})"
        return "the law is unstable by itself"

    def _static(self) -> str:
        stiffness = float(self.setting.loop.static_stiffness or Fraction(0))
        return f"static stiffness {told_quantity(stiffness, 'stiffness', self.setting.motion)}"
