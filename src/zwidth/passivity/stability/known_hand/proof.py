"""What is said of a known hand, as a document for the independent checker.

It holds the loop alone: the checker forms its characteristic polynomial and cuts the intervals itself.
"""

from __future__ import annotations

from typing import Any

from zwidth.loop.sampled_plant import Motion
from zwidth.model.environment.environment import RationalFunction
from zwidth.passivity.certificate import FORMAT
from zwidth.passivity.scope import unit_key
from zwidth.passivity.stability.known_hand.decide import Found
from zwidth.quantity.text import exact_text


def evidence(found: Found, motion: Motion, transfer: RationalFunction, units: str) -> dict[str, Any] | None:
    """A document of kind "stability", or of kind "instability" with the unstable_hand; None for undecided."""
    if found.outcome == "undecided":
        return None
    kind = "stability" if found.outcome == "stable" else "instability"
    return {
        "format": FORMAT,
        "kind": kind,
        "loop": _loop(motion if found.unstable_hand is None else found.unstable_hand, transfer, units),
    }


def _loop(motion: Motion, transfer: RationalFunction, units: str) -> dict[str, Any]:
    return {
        **motion.told(units),
        unit_key("sample_period", units): exact_text(motion.period),
        unit_key("delay", units): exact_text(motion.delay),
        "numerator": [exact_text(c) for c in transfer.numerator],
        "denominator": [exact_text(c) for c in transfer.denominator],
    }
