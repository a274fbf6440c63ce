"""Is a document valid: does every piece of evidence in it hold, and show what the document states?"""

from __future__ import annotations

import json
from collections.abc import Iterator, Mapping
from fractions import Fraction
from pathlib import Path
from typing import Any, NamedTuple

from .document.fields import Row
from .document.file import read_file
from .document.number import about
from .document.refusal import Invalid, one_document
from .one import Verified, verify
from .scope import ACTIVE, COUNTED, INDEX, KEPT, NO_INDEX, PASSIVE, RIGID, STABLE, UNSTABLE, Scope
from .whole import IN_CONTACT, NO_STEPS, PAPER, UNDECIDED, Statement, read_whole

_BETTER, _WORSE = (PASSIVE, STABLE), (ACTIVE, UNSTABLE)
"""What a certificate shows, and what a violation and a motion."""
_SHOWN_BY = {
    PASSIVE: PASSIVE, IN_CONTACT: PASSIVE, NO_STEPS: PASSIVE,
    ACTIVE: ACTIVE, STABLE: STABLE, UNSTABLE: UNSTABLE,
}  # fmt: skip
"""What evidence has to show for an outcome; for others none can."""
_OF_ALL = {PASSIVE: (PASSIVE,), IN_CONTACT: (PASSIVE, IN_CONTACT), NO_STEPS: (PASSIVE, NO_STEPS)}
"""What is stated of each in a list, where it is stated of all of them."""


class Part(NamedTuple):
    """A piece of evidence, where in the document it stands, and what was found of it."""

    at: str
    evidence: Mapping[str, Any]
    verification: Verified


class Judged(NamedTuple):
    """What was found of a document.

    Parameters
    ----------
    parts
        Each piece of evidence.
    faults
        What else is wrong: what is stated and shown by nothing.
    told
        Where entries stand that nothing proves.
    """

    parts: tuple[Part, ...]
    faults: tuple[str, ...] = ()
    told: tuple[str, ...] = ()

    @property
    def valid(self) -> bool:
        """True if all evidence holds, and shows what is stated."""
        return not self.faults and all(part.verification.valid for part in self.parts)


def judge_file(path: str | Path) -> Judged:
    """Judge a file of JSON; reading it counts as effort, too.

    Raises
    ------
    Unreadable
        If it cannot be read, is too large, is not JSON, or has nothing in it that can be checked.
    """
    with one_document():
        return judge(read_file(path))


def judge(document: object) -> Judged:
    """Judge a document: one piece of evidence, or whatever zwidth saves with some in it.

    Raises
    ------
    Unreadable
        If nothing in it can be checked.
    """
    with one_document():
        try:
            whole = read_whole(document)
        except Invalid as error:
            return Judged((), (str(error),))
        seen: dict[str, Verified] = {}
        parts = [_part(stated, name, seen) for stated in whole.statements for name in stated.evidence]
        faults = [fault for stated in whole.statements for fault in _not_shown(stated)]
        return Judged(tuple(parts), tuple(faults), whole.told)


def _part(stated: Statement, name: str, seen: dict[str, Verified]) -> Part:
    """A piece of evidence, checked once where it is given more often, and held against what is stated."""
    evidence = stated.evidence[name]
    same = json.dumps(evidence, default=str)
    if same not in seen:
        seen[same] = verify(evidence)
    found = seen[same]
    misfit = _misfit(stated, name, evidence, found.scope) if found.valid and name else None
    if misfit is not None:
        says = (
            f"the verdict says {stated.outcome}, and its"
            if stated.outcome
            else f"this {name} is no such thing: the"
        )
        found = Verified(False, f"{says} evidence {misfit}")
    return Part(stated.place(name), evidence, found)


def _not_shown(stated: Statement) -> Iterator[str]:
    """An outcome for which there is no evidence of its kind."""
    said, at = stated.outcome, f" in {stated.at}" if stated.at else ""
    if said in (None, UNDECIDED):
        return
    if said == PAPER:
        yield f"the outcome{at} is a theorem, a proof on paper: no evidence shows it"
    elif stated.listed is not None:
        one = said == ACTIVE and ACTIVE in stated.listed
        if not one and not (stated.listed and all(other in _OF_ALL.get(said, ()) for other in stated.listed)):
            yield f"the outcome{at} is {said}, and not that of all that it lists"
    elif not stated.evidence:
        yield f"the outcome{at} is {said}, and no evidence shows it"


def _misfit(stated: Statement, name: str, evidence: Mapping[str, Any], covered: Scope | None) -> str | None:
    """Why evidence that is valid does not show what is stated; None where it does."""
    if covered is None:
        return "is of corners that show different things"
    shows, said = covered.shows, stated.outcome or _implied(stated, name)
    if (misfit := _of_other_hands(stated, covered)) is not None:
        return misfit
    if shows in (INDEX, NO_INDEX):
        return _misfit_of_a_port(evidence, shows, said)
    joined = stated.scope.get("transmission", RIGID) if stated.scope else covered.transmission
    if covered.transmission and joined != covered.transmission:
        return "is of one transmission, of the numbers in it"
    if shows == ACTIVE and not covered.transmission and joined in ("any", "as given"):
        return "is of motor and hand that move as one"
    needed = _SHOWN_BY.get(str(said))
    if (shows not in (_BETTER if name == "certificate" else _WORSE)) if needed is None else needed != shows:
        return {
            PASSIVE: "is a proof of passivity",
            ACTIVE: "shows that energy comes out",
            STABLE: "shows something else: that it comes to rest",
            UNSTABLE: "shows something else: that it does not come to rest",
        }[shows]
    return _narrower(stated, said, covered) if shows == PASSIVE and needed else None


def _implied(stated: Statement, name: str) -> str | None:
    """What evidence has to show where no outcome says it."""
    return stated.shape.states and stated.shape.states[name != "certificate"]


def _of_other_hands(stated: Statement, covered: Scope) -> str | None:
    hands, allowed = covered.hands, stated.shape.hands
    if covered.shows in (INDEX, NO_INDEX):
        return None if "port" in allowed else "is of a port"
    if hands in allowed:
        return None
    return {
        "known": "is of a hand that is known",
        "beside a known one": "is of two arms of which a known hand holds one",
        "bounded": "covers hands within bounds only",
    }.get(hands, "is of other hands")


def _narrower(stated: Statement, said: str | None, covered: Scope) -> str | None:
    """Where a proof of passivity covers less than the scope that is stated."""
    scope = stated.scope
    kept = stated.shape.kept or scope.get("contact") == KEPT or said == IN_CONTACT
    if covered.contact == KEPT and not kept:
        return "covers a hand that keeps contact only"
    hands = scope.get("hands")
    which = hands.get("which") if isinstance(hands, Mapping) else None
    if covered.hands == "bounded" and which not in (None, "bounded"):
        return "covers hands within bounds only"
    if which == "activity" and covered.hands != "activity":
        return "covers no hand that gives out energy"
    if scope.get("encoder") == COUNTED and covered.encoder != COUNTED:
        return "leaves out the steps of the encoder"
    for counted, name in ((covered.force_limit, "force_limit"), (covered.force_steps, "force_steps")):
        if scope.get(f"{name}_counted") is True and not counted:
            return f"leaves out the {name.replace('_', ' ')}"
    if covered.fed_with and scope and not kept and scope.get("fed_with") != covered.fed_with:
        return f"is of a law that is fed with the {covered.fed_with}"
    return None


def _misfit_of_a_port(evidence: Mapping[str, Any], shows: str, said: str | None) -> str | None:
    """A port is passive for an input index of 0 or more, and active for one below."""
    level = Fraction(str(evidence["level"]))
    fits = evidence["index"] == "input" and level == 0
    wanted = {PASSIVE: INDEX, ACTIVE: NO_INDEX, UNDECIDED: shows}.get(str(said))
    if wanted != shows:
        return "shows something else of the port"
    return None if fits or said == UNDECIDED else "is of another level"


# What was found of a document, in words made from what each proof covers, not from what it says.


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
