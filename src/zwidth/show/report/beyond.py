"""What a verdict is not about, so that nobody reads more into it than was proved."""

from __future__ import annotations

from collections.abc import Iterator

from zwidth.passivity.result import Answer
from zwidth.passivity.verdict import Verdict


def beyond(verdict: Answer) -> Iterator[str]:
    """Line by line; what the claim takes for granted stands elsewhere."""
    if verdict.outcome == "active" and not isinstance(verdict, Verdict):
        yield "Whether given hands make this motion: zwidth simulate shows what hands of your choice meet."
    elif verdict.outcome == "active":
        yield (
            "Whether a given hand makes this motion: zwidth check --replay says how stiff a hand must be for "
            "it, and zwidth simulate shows what a hand of your choice meets."
        )
    elif verdict.outcome == "undecided":
        yield "Whether the loop is passive: undecided is neither a proof nor a motion."
    else:
        yield (
            "A device of other numbers: the proof is about those below. Measure the device's own friction; "
            "where there is less of it, or a slower or later loop, ask again."
        )
    yield "What bends between motor, encoder and handle, and torque ripple of the motor."
    yield "Other forces that the same program adds to this law: ask about the law that is their sum."
