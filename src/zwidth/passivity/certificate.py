"""A certificate: a proof that a loop is passive, as data that anyone can check.

It holds the loop's exact numbers, the criterion's factors with a squarefree
part that is positive on [−1, 1], and what proves the environment stable.
"""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass
from decimal import Decimal
from fractions import Fraction
from pathlib import Path
from typing import Any

from zwidth.checker import Scope, Unreadable, Verified, judge, read_file, verify
from zwidth.errors import InputError
from zwidth.missing import did_you_mean
from zwidth.model.device import Device
from zwidth.model.environment.environment import Environment
from zwidth.passivity.corners import Loop, corners_decide
from zwidth.passivity.criterion_choice import Decision
from zwidth.passivity.linear.contact import DampedWall, RelaxingLaw
from zwidth.passivity.linear.criterion import LinearProof, Piece, prove_delays
from zwidth.passivity.linear.one_norm import NormBound
from zwidth.passivity.linear.positivity import Positivity
from zwidth.passivity.result import Evidence
from zwidth.passivity.scope import unit_key
from zwidth.quantity.exact import Exact, ends
from zwidth.quantity.text import exact_text

FORMAT = "zwidth certificate 1"


@dataclass(frozen=True, repr=False)
class Certificate(Evidence):
    """A proof of passivity for one loop, or for every corner of an interval.

    Parameters
    ----------
    documents
        One proof per corner, each complete by itself.
    """

    documents: tuple[dict[str, Any], ...]

    def verify(self) -> bool:
        """True when the independent checker accepts every proof."""
        return self.covered() is not None

    def covered(self) -> Scope | None:
        """What the proofs cover together, as the independent checker finds it; None where it rejects one."""
        return verify(self.to_dict()).scope if self.documents else None

    @property
    def kind(self) -> str:
        """Of the first document: "spring", "contact", "linear", "positive real", "stability", …"""
        return str(self.documents[0]["kind"])

    @property
    def is_of_springs(self) -> bool:
        """True when every part is the proof of a spring."""
        return all(document["kind"] == "spring" for document in self.documents)

    def to_dict(self) -> dict[str, Any]:
        """The certificate as plain data."""
        if len(self.documents) == 1:
            return self.documents[0]
        return {"format": FORMAT, "kind": "corners", "corners": list(self.documents)}

    def describe(self) -> str:
        """Its kind, and of how many parts it is."""
        parts = "1 part" if len(self.documents) == 1 else f"{len(self.documents)} parts"
        return f"{self.kind} certificate, {parts}"


def certify(decision: Decision) -> dict[str, Any]:
    """The proof document of a provable decision."""
    kind = decision.kind
    document = _document(decision, kind)
    if isinstance(decision.wall, DampedWall) and kind == "contact":
        document["law"] = wall_document(decision.wall, decision.setting.motion)
    elif isinstance(decision.wall, RelaxingLaw) and kind == "relaxing contact":
        document["law"] = _relaxing_law(decision.wall, decision.setting.motion)
    elif kind == "multiplier contact":
        document |= _multiplier(decision)
    elif kind != "spring":
        document["proof"] = linear_proof(decision)
    return document


def _document(decision: Decision, kind: str) -> dict[str, Any]:
    return {"format": FORMAT, "kind": kind, "loop": decision.setting.loop_document()}


def linear_proof(decision: Decision) -> dict[str, Any]:
    """The linear criterion, and with an encoder the bound on ‖h‖₁."""
    proof = decision.viscous
    assert isinstance(proof, LinearProof), "only a provable decision is certified"
    document = _proof(proof)
    if decision.setting.resolution:
        assert decision.norm is not None
        document["norm"] = _norm(decision.norm)
    return document


def wall_document(wall: DampedWall, motion: str) -> dict[str, Any]:
    return {
        unit_key("stiffness", motion): exact_text(wall.stiffness),
        unit_key("virtual_damping", motion): exact_text(wall.damping),
        "weights": wall.estimate.document,
    }


def _relaxing_law(law: RelaxingLaw, motion: str) -> dict[str, Any]:
    stiffness = unit_key("stiffness", motion)
    return {
        stiffness: exact_text(law.stiffness),
        "parts": [{"pole": str(p.pole), stiffness: exact_text(p.stiffness)} for p in law.parts],
        "fed_with": law.fed_with,
        "never_pulls": law.never_pulls,
    }


def _multiplier(decision: Decision) -> dict[str, Any]:
    law = decision.multiplier
    assert law is not None, "only a provable decision is certified"
    assert law.choice is not None
    sign = law.memory.proof(law.choice.multiplier, law.left(decision.loop))
    assert sign is not None, "more damping than is needed keeps the sign"
    proof: dict[str, Any] = {"multiplier": str(law.choice.multiplier)}
    proof["positivity"] = positivity_document(sign)
    if decision.setting.resolution:
        assert law.norm is not None
        proof["norm"] = _norm(law.norm)
    return {"law": {"fed_with": "position", "never_pulls": law.never_pulls}, "proof": proof}


def certify_box(
    device: Device, law: Environment, corners: Sequence[Loop], decisions: Sequence[Decision]
) -> list[dict[str, Any]] | None:
    """Proofs that together cover the whole box of parameters, or None."""
    if corners_decide(device, law, all(d.is_spring or d.covers_contact for d in decisions)):
        return [certify(d) for d in decisions]
    shortest, longest = ends(device.delay)
    if any(d.is_clamped for d in decisions):  # contact is covered for certain delays only
        return None
    if shortest == longest or not corners_decide(device.replace(delay=Exact(shortest)), law):
        return None
    proofs = []
    for corner, decision in zip(corners, decisions, strict=True):
        if decision.is_spring:  # the longest delay decides; both ends are among the corners
            proofs.append(certify(decision))
        elif corner[0].exact("delay") == shortest:
            assert isinstance(decision.viscous, LinearProof), "provable decisions only"
            pieces = prove_delays(decision.loop, decision.viscous, longest)
            if pieces is None:
                return None
            proofs.append(certify_delays(decision, pieces, longest))
    return proofs


def certify_delays(decision: Decision, pieces: Sequence[Piece], longest: Fraction) -> dict[str, Any]:
    """The proof document of a provable decision for every delay up to `longest` [s]."""
    document, proof = _document(decision, "delays"), linear_proof(decision)
    del proof["positivity"]
    proof["pieces"] = [
        {
            "low": str(piece.low),
            "high": str(piece.high),
            "at_low": positivity_document(piece.at_low),
            "at_high": positivity_document(piece.at_high),
        }
        for piece in pieces
    ]
    return {**document, "proof": proof, "delay_high_s": exact_text(longest)}


def _norm(norm: NormBound) -> dict[str, Any]:
    return {
        "modes": [{"pole": str(mode.pole), "residue": str(mode.residue)} for mode in norm.modes],
        "rest_numerator": [str(c) for c in norm.rest_numerator],
        "rest_denominator": [str(c) for c in norm.rest_denominator],
        "inverse": [str(c) for c in norm.inverse],
    }


def _proof(proof: LinearProof) -> dict[str, Any]:
    stability: dict[str, Any] = {"kind": proof.stability}
    if proof.offset is not None:
        stability["offset"] = str(proof.offset)
    return {"stability": stability, "positivity": positivity_document(proof.positivity)}


def positivity_document(sign: Positivity) -> dict[str, Any]:
    """A proof of a sign as plain data."""
    return {
        "at_one": sign.at_one,
        "at_minus_one": sign.at_minus_one,
        "square": [str(Decimal(c)) for c in sign.square],  # str(int) stops at 4300 digits
        "factor": [str(Decimal(c)) for c in sign.factor],
    }


def verify_document(document: object) -> Verified:
    """Check a saved certificate, violation or witness, or a report that holds some of these, read as JSON.

    Raises
    ------
    InputError
        If it contains neither.
    """
    try:
        found = judge(document)
    except Unreadable as error:
        raise InputError(str(error)) from None
    results = [part.verification for part in found.parts]
    wrong = [*found.faults, *(r.reason for r in results if not r.valid)]
    if wrong:
        refused = next((r for r in results if not r.valid), None)
        return refused if refused and not found.faults else Verified(False, wrong[0])
    if len(results) == 1:
        return results[0]
    energy = next((r.energy for r in results if r.energy is not None), None)
    return Verified(
        True, "; and ".join(r.reason for r in results), energy
    )  # of several, each has its own scope


def read_document(path: str | Path) -> object:
    """Read a JSON file with every number as the decimal that is written.

    Raises
    ------
    InputError
        If it cannot be read, is too large, is not JSON, or gives a key twice in one object.
    """
    try:
        return read_file(path)
    except Unreadable as error:
        missing = "" if Path(path).exists() else did_you_mean(Path(path))
        raise InputError(f"{path}: {error}{missing}") from None
