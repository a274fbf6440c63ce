"""What a proof and a motion of a port are as plain data: of one axis single numbers, of several matrices."""

from __future__ import annotations

from collections.abc import Iterable
from fractions import Fraction
from typing import Any

from zwidth.passivity.certificate import positivity_document
from zwidth.passivity.ports.motion import Motion
from zwidth.passivity.ports.port import Port
from zwidth.passivity.ports.positive_real import OFFSET, Proof


def system_document(port: Port) -> dict[str, Any]:
    """G of a port from inputs to outputs."""
    denominator = _text(reversed(port.denominator))
    if port.axes == 1:
        numerator = _text(reversed(port.outputs[0][0]))
        return {"time": port.time, "numerator": numerator, "denominator": denominator}
    numerators = [[_text(reversed(p)) for p in row] for row in port.outputs]
    return {"time": port.time, "numerators": numerators, "denominator": denominator}


def proof_document(proof: Proof) -> dict[str, Any]:
    """The kind of a proof, and the proof."""
    if proof.resolvent is None:
        positivity = positivity_document(proof.minors[0].positivity)
        return {"kind": "positive real", "proof": {"offset": str(OFFSET), "positivity": positivity}}
    minors = [{"power": m.power, "positivity": positivity_document(m.positivity)} for m in proof.minors]
    resolvent = {
        "numerators": [[_text(reversed(p)) for p in row] for row in proof.resolvent.numerators],
        "denominator": _text(reversed(proof.resolvent.denominator)),
    }
    told = {"offset": str(OFFSET), "minors": minors, "resolvent": resolvent}
    return {"kind": "positive real matrix", "proof": told}


def motion_document(motion: Motion) -> dict[str, Any]:
    """The kind of a motion's document, and the motion."""
    alone = len(motion.axes) == 1
    told = {"kind": motion.kind, **_numbers(motion)}
    return {"kind": "extraction" if alone else "matrix extraction", "motion": told}


def _numbers(motion: Motion) -> dict[str, Any]:
    rows = [_text(axis) for axis in motion.axes]
    axes = rows[0] if len(rows) == 1 else rows
    if motion.kind == "sequence":
        return {"latent": axes}
    numbers = _text(motion.numbers)
    if motion.kind == "polynomial":
        return {"duration_s": numbers[0], "lowest_power": numbers[1], "coefficients": axes}
    burst = dict(zip(("step_rad_per_s", "cycles", "power"), numbers, strict=True))
    if len(rows) == 1:  # a phase of its own would move all of the burst and no more
        return burst
    return {**burst, "cosine": [a for a, _ in rows], "sine": [b for _, b in rows]}


def _text(values: Iterable[Fraction | int]) -> list[str]:
    return [str(x) for x in values]
