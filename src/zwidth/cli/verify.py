"""The command `verify`: what the independent checker finds, in the terminal."""

from __future__ import annotations

import argparse
from collections.abc import Iterator, Mapping, Sequence
from decimal import Decimal
from fractions import Fraction
from typing import Any, NamedTuple

from zwidth.checker import Scope, Verified
from zwidth.cli.options import Once, heed_angles
from zwidth.cli.output import print_json
from zwidth.cli.page import below, grid, headline, page
from zwidth.errors import InputError
from zwidth.passivity.certificate import evidence, read_document, verify_document
from zwidth.passivity.result import EVIDENCE
from zwidth.quantity.spoken import spoken
from zwidth.quantity.text import shown
from zwidth.specification.table import plain

_LAWS_IN_A_ROW = ("row storage", "row motion")
"""Documents of a table or of forces: the checker knows no law, and the law is stepped again here."""

_OF_BOUNDED_HANDS = "zwidth worst hand 1"
"""A document that claims nothing of hands beyond its bounds."""

_OF_TWO_ARMS = ("pair", "pair violation")
"""Proofs about arms that follow each other."""

_ONE_BY_ONE = {
    "zwidth gains 1": "joints",
    "zwidth held joints 1": "joints",
    "zwidth passive masses 1": "verdicts",
    "zwidth each 1": "devices",
}
"""Documents that hold one for each joint, device, or of some masses, and where."""

_BESIDE_A_KNOWN_ONE = "beside a known one"
_OF_A_HELD_PAIR = "zwidth held pair 1"
"""Hands on the free one of two arms, and the documents about them."""

_OF_A_PORT = ("zwidth indices 1", "zwidth scattering 1")
"""A document about a port by itself."""


def configure(parser: argparse.ArgumentParser) -> None:
    """The arguments of `zwidth verify`."""
    parser.usage = "%(prog)s FILE [--angles UNIT]\n       %(prog)s --schema KIND"
    parser.add_argument(
        "file", metavar="FILE", nargs="?", help="certificate, witness, verdict or limit saved as JSON"
    )
    parser.add_argument(
        "--schema",
        metavar="KIND",
        action=Once,
        help="print the JSON Schema of the documents of a kind, such as spring or corners",
    )
    parser.add_argument(
        "--angles",
        metavar="UNIT",
        action=Once,
        help="beside what the file has, in rad, tell it in deg, turn or rpm",
    )


def run(arguments: argparse.Namespace) -> int:
    """`zwidth verify`: 0 where everything holds, else 1."""
    if arguments.schema is not None:
        return _schema(arguments)
    if arguments.file is None:
        raise InputError("which FILE is to be checked? Or --schema KIND for what one must look like")
    heed_angles(arguments)
    found = verifications(read_document(arguments.file))
    print_verifications(found)
    return 0 if all(part.verification.valid for part in found) else 1


def _schema(arguments: argparse.Namespace) -> int:
    if arguments.file is not None:
        raise InputError("--schema prints what a document must look like, and checks no FILE")
    from zwidth.cli.schemas import schema

    print_json(schema(arguments.schema))
    return 0


class Part(NamedTuple):
    """One certificate or witness of a document, and what the checker says of it.

    Of laws in a chain `law` says which they are, if they were stepped again and gave what the document lists.
    """

    evidence: Mapping[str, Any]
    verification: Verified
    law: str | None = None


def verifications(document: object) -> list[Part]:
    """What the independent checker says of each piece of evidence, and whether it fits the outcome claimed.

    Raises
    ------
    InputError
        If the document contains no evidence.
    """
    told = document if isinstance(document, Mapping) else {}
    if inside := _ONE_BY_ONE.get(str(told.get("format"))):
        return [part for one in _listed(told, inside) for part in verifications(one)]
    found = _of_the_loop(document, told)
    hands = told.get("known_hands")
    return [*found, *(_of_hands(hands) if isinstance(hands, Mapping) else [])]


def _of_hands(hands: Mapping[str, object]) -> Iterator[Part]:
    """Of each hand that is known what is proved, and that it shows what is said of that hand."""
    for one in hands.values():
        if not isinstance(one, Mapping) or one.get("outcome") != "undecided":
            for part in verifications(one):
                outcome = one.get("outcome") if isinstance(one, Mapping) else None
                covered = part.verification.scope
                shows = None if covered is None else covered.shows
                yield _refused(part, str(outcome), None if shows == outcome else "shows something else")


def _of_the_loop(document: object, told: Mapping[str, Any]) -> list[Part]:
    found = [_with_law(Part(part, verify_document(part))) for part in evidence(document)]
    outcome = told.get("outcome")
    if outcome not in ("passive", "passive in contact", "active"):
        return found
    scopes = [part.verification.scope for part in found]
    bounded = all(scope is not None and scope.hands == "bounded" for scope in scopes)
    if outcome != "active" and bounded and told.get("format") != _OF_BOUNDED_HANDS:
        return [_refused(part, outcome, "covers hands within bounds only") for part in found]
    return [_refused(part, outcome, _misfit(part, outcome, told)) for part in found]


def _listed(told: Mapping[str, Any], key: str) -> Sequence[object]:
    """Those of which something is proved."""
    listed = told.get(key)
    if not isinstance(listed, Sequence) or isinstance(listed, str):
        raise InputError(f"no evidence found: the document has no {key}")
    found = [
        one
        for one in listed
        if not isinstance(one, Mapping) or one.get("outcome") != "undecided" or set(EVIDENCE) & set(one)
    ]
    if not found:
        raise InputError(f"no evidence found: nothing was proved of any of the {key}")
    return found


def _with_law(part: Part) -> Part:
    """Laws in a chain stepped again from the parameters in the document."""
    if not part.verification.valid or part.evidence["kind"] not in _LAWS_IN_A_ROW:
        return part
    from zwidth.passivity.storage.row.document import law_of  # the compiler of their steps takes its time

    try:
        return part._replace(law=law_of(part.evidence))
    except InputError as error:
        return part._replace(verification=Verified(False, str(error)))


def _refused(part: Part, outcome: str, misfit: str | None) -> Part:
    """Evidence that does not show what the document says; an invalid part stays as it is."""
    if misfit is None or not part.verification.valid:
        return part
    return part._replace(
        verification=Verified(False, f"the verdict says {outcome}, and its evidence {misfit}")
    )


def _misfit(part: Part, outcome: str, told: Mapping[str, Any]) -> str | None:
    """Why evidence that is valid does not show an outcome; None where it does."""
    covered = part.verification.scope
    if covered is None:
        return "is of corners that show different things"
    if covered.shows in ("stable", "unstable"):
        return "is of a hand that is known"
    if covered.hands == _BESIDE_A_KNOWN_ONE and told.get("format") != _OF_A_HELD_PAIR:
        return "is of two arms of which a known hand holds one"
    if covered.shows in ("index at least", "index below"):
        return _misfit_of_a_port(part.evidence, covered.shows, outcome, told)
    if outcome == "active":
        return None if covered.shows == "active" else "is a proof of passivity"
    if covered.shows == "active":
        return "shows that energy comes out"
    kept = covered.contact == "kept" and covered.hands == "every"
    if kept and outcome == "passive" and _contact(told) != "kept":
        return "covers a hand that keeps contact only"
    return None


def _misfit_of_a_port(
    evidence: Mapping[str, Any], shows: str, outcome: str, told: Mapping[str, Any]
) -> str | None:
    """The same of a port: it is passive for an input index of 0 or more, and active for one below."""
    if told.get("format") not in _OF_A_PORT:
        return "is of a port"
    level = Fraction(str(evidence["level"]))
    if evidence["index"] == "input" and (shows, outcome, level) in (
        ("index at least", "passive", 0),
        ("index below", "active", 0),
    ):
        return None
    return "is of another level"


def _contact(told: Mapping[str, Any]) -> object:
    """The contact that a document says it is about."""
    scope = told.get("scope")
    return scope.get("contact") if isinstance(scope, Mapping) else None


def print_verifications(parts: Sequence[Part]) -> None:
    """Print whether each holds, of which loop, and the joules of a motion."""
    with page() as out:
        for part in parts:
            word, colour = ("VALID", "green") if part.verification.valid else ("NOT VALID", "red")
            out.print(headline(word, colour, _claim(part)))
            out.print(below(grid(_rows(part))))


def _claim(part: Part) -> str:
    """What was checked, with the bounds on the hand where there are some."""
    reason, covered = plain(part.verification.reason, 400), part.verification.scope
    if not part.verification.valid or part.verification.energy is not None:
        return reason
    if covered is None:  # of corners that show different things no headline is that of all
        return f"Proved: {reason}"
    return f"{_head(covered, str(part.evidence.get('kind')))}: {reason}"


def _head(covered: Scope, kind: str) -> str:
    """What a proof shows, in words made from what the checker found it to cover."""
    if covered.shows in ("stable", "unstable"):
        return "Proved"
    if covered.shows in ("index at least", "index below"):
        return "Of the port below, proved"
    if covered.hands == _BESIDE_A_KNOWN_ONE:
        if covered.shows == "active":
            return "A hand can take any amount of energy out of the arms below, proved"
        return "A hand on the arm that is not held takes no energy out of the arms below, proved"
    if kind in _OF_TWO_ARMS:
        if covered.shows == "active":
            return "Two hands can take any amount of energy out of the arms below, proved"
        return "The two arms below are passive, proved"
    kept = " as long as contact is kept" if covered.contact == "kept" else ""
    if covered.shows == "active":
        return "A hand can take any amount of energy out of the loop below, proved"
    if covered.hands == "bounded":
        return "No hand within these bounds takes energy out of the loop below, proved"
    if covered.hands == "activity":
        return f"No hand of this activity goes on gaining energy from the loop below{kept}, proved"
    if kind == "corners":
        return f"Every corner, as the one below, is passive{kept}, proved"
    what = "arm" if kind in ("arm", "null space") else "loop"
    return f"The {what} below is passive{kept}, proved"


def _rows(part: Part) -> Iterator[tuple[str, str]]:
    """What the checker read, and no other entry of the document."""
    found = part.verification
    if found.energy is not None and (found.scope is None or found.scope.shows != "index below"):
        yield "energy extracted", _joules(found.energy)
    if not found.valid:
        return
    yield "kind", plain(str(part.evidence.get("kind")))
    if isinstance(corners := part.evidence.get("corners"), list):
        yield "corner below", f"1 of {len(corners)}, each with a proof of its own"
    if part.law is not None:
        yield "law, stepped again", plain(part.law, 300)
    for row in found.rows:
        if row.told and part.law is not None:
            continue
        name = "told, not checked" if row.told else plain(row.name)
        yield name, plain(f"{row.text} {row.unit}".rstrip(), 300) + _in_other_words(row.text, row.unit)


def _in_other_words(number: str, unit: str) -> str:
    """The same, rounded, in the angle that was asked for; "" where that is what the document has."""
    factor, said = spoken(unit)
    if factor == 1.0:
        return ""
    try:
        return f" = {factor * float(number):.6g} {said}"
    except ValueError:  # a list of numbers
        return ""


def _joules(energy: Fraction) -> str:
    """Also where a double would overflow: the checker's numbers have no bound but their digits."""
    value = float(Decimal(energy.numerator) / Decimal(energy.denominator))
    if value and abs(value) < float("inf"):
        return shown(value, "J", 6)
    return f"{Decimal(energy.numerator) / Decimal(energy.denominator):.6g} J"
