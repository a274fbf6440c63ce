"""What was found of a document, in words made from what each proof covers, not from what it says."""

from __future__ import annotations

from collections.abc import Iterator

from .document.fields import Row
from .document.number import about
from .scope import ACTIVE, INDEX, KEPT, NO_INDEX, STABLE, UNSTABLE, Scope
from .verdict import Judged, Part

VALID, NOT_VALID = "VALID", "NOT VALID"


def answer(judged: Judged) -> tuple[str, str] | None:
    """The answer to a whole document, and a sentence; None where that of its only evidence says all."""
    if judged.faults:
        return NOT_VALID, "; ".join(judged.faults)
    if len(judged.parts) == 1:
        return None
    wrong = [part.at for part in judged.parts if not part.verification.valid]
    if wrong:
        return (
            NOT_VALID,
            f"{len(wrong)} of the {len(judged.parts)} proofs and motions below: {', '.join(wrong[:12])}",
        )
    return VALID, f"all {len(judged.parts)} proofs and motions below, each of what is stated of it"


def headline(part: Part) -> tuple[str, str]:
    """The answer to one piece of evidence, and what was checked, with the bounds on the hand."""
    found = part.verification
    word, reason = (VALID if found.valid else NOT_VALID), _on_one_line(found.reason, 400)
    if not found.valid or found.energy is not None:
        return word, reason
    if found.scope is None:  # of corners that show different things no headline is that of all
        return word, f"Proved: {reason}"
    return word, f"{_head(found.scope, str(part.evidence.get('kind')))}: {reason}"


def _head(covered: Scope, kind: str) -> str:
    """What a proof shows."""
    if covered.shows in (STABLE, UNSTABLE):
        return "Proved"
    if covered.shows in (INDEX, NO_INDEX):
        return "Of the port below, proved"
    if covered.hands == "beside a known one":
        if covered.shows == ACTIVE:
            return "A hand can take any amount of energy out of the arms below, proved"
        return "A hand on the arm that is not held takes no energy out of the arms below, proved"
    if kind in ("pair", "pair violation"):
        if covered.shows == ACTIVE:
            return "Two hands can take any amount of energy out of the arms below, proved"
        return "The two arms below are passive, proved"
    kept = " as long as contact is kept" if covered.contact == KEPT else ""
    if covered.shows == ACTIVE:
        return "A hand can take any amount of energy out of the loop below, proved"
    if covered.hands == "bounded":
        return "No hand within these bounds takes energy out of the loop below, proved"
    if covered.hands == "activity":
        return f"No hand of this activity goes on gaining energy from the loop below{kept}, proved"
    if kind == "corners":
        return f"Every corner, as the one below, is passive{kept}, proved"
    what = "arm" if kind in ("arm", "null space") else "loop"
    return f"The {what} below is passive{kept}, proved"


def rows(part: Part) -> Iterator[Row]:
    """What entered a proof that holds, and no other entry of the document."""
    found = part.verification
    if "." in part.at:
        yield Row("of the document", _on_one_line(part.at, 100), "", False)
    if found.energy is not None and (found.scope is None or found.scope.shows != NO_INDEX):
        yield Row("energy extracted", about(found.energy), "J", False)
    if not found.valid:
        return
    yield Row("kind", _on_one_line(str(part.evidence.get("kind")), 60), "", False)
    if isinstance(corners := part.evidence.get("corners"), list):
        yield Row("corner below", f"1 of {len(corners)}, each with a proof of its own", "", False)
    for row in found.rows:
        name = "told, not checked" if row.told else _on_one_line(row.name, 60)
        yield Row(name, _on_one_line(f"{row.text} {row.unit}".rstrip(), 300), row.unit, row.told)


def not_checked(judged: Judged) -> str:
    """The entries that nothing proves; "" where there are none."""
    names = dict.fromkeys(place.rpartition(".")[2] for place in judged.told)
    return _on_one_line(", ".join(names), 300)


def _on_one_line(text: str, longest: int) -> str:
    printable = "".join(c if c.isprintable() else "?" for c in text)
    return printable if len(printable) <= longest else f"{printable[: longest - 3]}..."
