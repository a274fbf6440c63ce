"""Proofs about a pair of which a known hand holds one arm, as documents that the independent checker reads.

They hold the pair, and arm and hand together; the checker forms the law that is felt by itself.
"""

from __future__ import annotations

from dataclasses import dataclass
from fractions import Fraction
from typing import Any

from zwidth.loop.sampled_plant import Motion
from zwidth.passivity.linear.criterion import frequency
from zwidth.passivity.pairs.evidence import CERTIFICATE, VIOLATION, pair_document
from zwidth.passivity.pairs.held.law import HeldPair
from zwidth.passivity.result import Evidence
from zwidth.quantity.text import exact_text


@dataclass(frozen=True, repr=False)
class HeldCertificate(Evidence):
    """A proof that the hand on the free arm takes no energy out, for every hand within the intervals.

    Attributes
    ----------
    question
        The pair and the hand.
    """

    question: HeldPair

    def to_dict(self) -> dict[str, Any]:
        """The proof as plain data."""
        return {
            "format": CERTIFICATE,
            "kind": "held pair",
            **held_document(self.question, self.question.motion),
        }

    def describe(self) -> str:
        """What was proved, in words."""
        return f"with the {self.question.held} held, the work of the other hand is nowhere negative"


@dataclass(frozen=True, repr=False)
class HeldViolation(Evidence):
    """A frequency at which some motion of the free arm takes energy out in every round.

    Attributes
    ----------
    question
        The pair and the hand.
    motion
        Arm and hand together, certain: one of those within the intervals.
    cosine
        cos ωT.
    """

    question: HeldPair
    motion: Motion
    cosine: Fraction

    @property
    def frequency(self) -> float:
        """Where [Hz]."""
        return frequency(self.cosine, self.question.pair.sample_period)

    def to_dict(self) -> dict[str, Any]:
        """The violation as plain data."""
        return {
            "format": VIOLATION,
            "kind": "held pair violation",
            **held_document(self.question, self.motion),
            "proof": {"cosine": exact_text(self.cosine)},
        }

    def describe(self) -> str:
        """What is violated, in words."""
        return f"at {self.frequency:.6g} Hz some motion of the {self.question.free} gains in every round"


def held_document(question: HeldPair, motion: Motion) -> dict[str, Any]:
    """The pair, and arm and hand together."""
    return {
        "loop": pair_document(question.pair),
        "held": {"arm": question.held, **motion.told(question.pair.motion)},
    }
