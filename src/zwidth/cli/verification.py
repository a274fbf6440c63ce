"""What the independent checker found, in the terminal."""

from __future__ import annotations

from collections.abc import Iterator, Mapping, Sequence
from decimal import Decimal
from fractions import Fraction
from typing import Any, NamedTuple

from rich.table import Table
from rich.text import Text

from zwidth.cli.arm_rows import arm_rows
from zwidth.cli.numerals import shown, unit_text
from zwidth.cli.report import page
from zwidth.cli.table import plain
from zwidth.passivity.certificate import evidence, verify_document
from zwidth.passivity.checker import Verification
from zwidth.passivity.document import unit_key, unit_suffix
from zwidth.quantity.glossary import GLOSSARY

_OF_A_KNOWN_HAND = {"absolute stability", "stability", "instability", "vibration"}
"""Kinds of proofs that say of one hand whether it comes to rest, and nothing of passivity."""

_OF_A_PORT = {"positive real", "positive real matrix", "extraction", "matrix extraction"}
"""Kinds that say of a port on which side of a level its index lies."""

_BOUNDED = {"storage", "coarse storage", "row storage", "slow hands"}
"""Proofs of hands within bounds: storage functions speak of the hands on their board only."""

_TABLES = {
    **dict.fromkeys(_OF_A_PORT, ("system", "motion")),
    **dict.fromkeys(("contact", "force bounding"), ("loop", "law")),
    **dict.fromkeys((*_BOUNDED, "contact motion", "row motion"), ("loop", "law", "domain", "bounds")),
}
"""What a document of each kind is of, besides its loop: only what is checked is shown."""

_CONTACT_KEPT = {"linear", "quantized", "delays"}
"""Kinds that take a one-sided law for the line that it is inside."""

_OF_BOUNDED_HANDS = "zwidth worst hand 1"
"""A document that claims nothing of hands beyond its bounds."""


class Part(NamedTuple):
    """One certificate or witness of a document, and what the checker says of it."""

    evidence: Mapping[str, Any]
    verification: Verification


def verifications(document: object) -> list[Part]:
    """What the independent checker says of each piece of evidence, and whether it fits the outcome claimed.

    Raises
    ------
    InputError
        If the document contains no evidence.
    """
    parts = evidence(document)
    outcome = document.get("outcome") if isinstance(document, Mapping) else None
    bounded = isinstance(document, Mapping) and document.get("format") == _OF_BOUNDED_HANDS
    found = [Part(part, verify_document(part)) for part in parts]
    if outcome == "passive" and not bounded and all(map(_is_bounded, parts)):
        return [_misfit(p, outcome, "covers hands within bounds only") for p in found]
    if outcome in ("passive", "active"):
        for kinds, what in ((_OF_A_KNOWN_HAND, "is of a hand that is known"), (_OF_A_PORT, "is of a port")):
            if any(_kinds(part) & kinds for part in parts):
                return [_misfit(p, outcome, what) for p in found]
    misfit = {"passive": "is a motion that extracts energy", "active": "is a proof of passivity"}
    return [
        _misfit(p, outcome, misfit[outcome])
        if outcome in ("passive", "active") and (p.verification.energy is not None) != (outcome == "active")
        else p
        for p in found
    ]


def _misfit(part: Part, outcome: str, what: str) -> Part:
    """Evidence that does not show what the document says; an invalid part stays as it is."""
    if not part.verification.valid:
        return part
    return part._replace(
        verification=Verification(False, f"the verdict says {outcome}, and its evidence {what}")
    )


def _is_bounded(part: Mapping[str, object]) -> bool:
    return bool(_kinds(part) & _BOUNDED)


def print_verifications(parts: Sequence[Part]) -> None:
    """Print whether each holds, of which loop, and the joules of a motion."""
    with page() as out:
        for part in parts:
            headline = Table.grid(padding=(0, 1))
            word, colour = ("VALID", "green") if part.verification.valid else ("NOT VALID", "red")
            badge = Text(f" {word} ", style=f"bold white on {colour}")
            headline.add_row(badge, Text(_claim(part), style="bold"))
            details = Table.grid(padding=(0, 2))
            for name, text in _rows(part):
                details.add_row(Text(name, style="dim"), Text(text))
            out.print(headline)
            out.print()
            out.print(details)
            out.print()


def _claim(part: Part) -> str:
    """What was checked, with the bounds on the hand where there are some."""
    reason = plain(part.verification.reason, 400)
    if not part.verification.valid or part.verification.energy is not None:
        return reason
    heads = {_head(single) for single in _singles(part.evidence)}
    return f"{heads.pop() if len(heads) == 1 else 'Proved'}: {reason}"


def _head(single: Mapping[str, object]) -> str:
    """What a proof of this kind shows."""
    kind, kept = single.get("kind"), " as long as contact is kept" if _keeps_contact(single) else ""
    if kind in _BOUNDED:
        return "No hand within these bounds takes energy out of the loop below, proved"
    if kind in _OF_A_PORT:
        return "Of the port below, proved"
    if kind in _OF_A_KNOWN_HAND:
        return "Proved"
    if kind == "active hand":
        return f"No hand of this activity goes on gaining energy from the loop below{kept}, proved"
    return f"The {'arm' if kind == 'arm' else 'loop'} below is passive{kept}, proved"


def _keeps_contact(single: Mapping[str, object]) -> bool:
    """True where a one-sided law is covered only while the hand stays inside."""
    loop, proof = single.get("loop"), single.get("proof")
    if not isinstance(loop, Mapping) or loop.get("unilateral") is not True:
        return False
    if single.get("kind") == "active hand":
        reduced = proof.get("reduced") if isinstance(proof, Mapping) else None
        return not isinstance(reduced, Mapping) or reduced.get("kind") in _CONTACT_KEPT
    return single.get("kind") in _CONTACT_KEPT


def _singles(evidence: Mapping[str, object]) -> list[Mapping[str, object]]:
    """A proof, or those of its corners."""
    corners = evidence.get("corners") if evidence.get("kind") == "corners" else None
    parts = corners if isinstance(corners, list) else [evidence]
    return [part for part in parts if isinstance(part, Mapping)]


def _kinds(evidence: Mapping[str, object]) -> set[object]:
    return {str(part.get("kind")) for part in _singles(evidence)}


def _rows(part: Part) -> Iterator[tuple[str, str]]:
    if part.verification.energy is not None and part.evidence.get("kind") not in (
        "extraction",
        "matrix extraction",
    ):
        yield "energy extracted", _joules(part.verification.energy)
    singles = _singles(part.evidence)
    if part.evidence.get("kind") == "corners":
        yield "corner", f"1 of {len(singles)}, each with a proof of its own"
    if not singles:
        return
    shown_part = singles[0]
    if "kind" in shown_part:
        yield "kind", plain(str(shown_part["kind"]))
    known = _known_keys()
    for key, value in shown_part.items():
        if key in known and not isinstance(value, (Mapping, list)):
            name, unit = known[key]
            yield name, f"{plain(_text(value))} {unit}"
    for table in _TABLES.get(str(shown_part.get("kind")), ("loop",)):
        content = shown_part.get(table)
        for key, value in content.items() if isinstance(content, Mapping) else ():
            name, unit = known.get(str(key), (str(key).replace("_", " "), ""))
            yield plain(name), f"{plain(_text(value))} {unit}".rstrip()
    if shown_part.get("kind") == "arm":
        yield from arm_rows(shown_part)


def _known_keys() -> dict[str, tuple[str, str]]:
    """The keys of quantities in a document, as words and unit."""
    keys = {
        unit_key(name, motion): (name.replace("_", " "), unit_text(entry.unit_for(motion)))
        for name, entry in GLOSSARY.items()
        for motion in ("linear", "rotary")
    }
    powers = "in descending powers of z"
    taps = {f"taps_{unit_suffix(u)}": ("taps", unit_text(u)) for u in ("N/m", "N*m/rad")}
    damping = [
        (unit_suffix(u), unit_text(u)) for u in map(GLOSSARY["damping"].unit_for, ("linear", "rotary"))
    ]
    hand = {"below_Hz": ("below", "Hz"), **{f"activity_{key}": ("activity", unit) for key, unit in damping}}
    return {
        **keys,
        **taps,
        **hand,
        "numerator": ("numerator", powers),
        "denominator": ("denominator", powers),
    }


def _text(value: object) -> str:
    if isinstance(value, list):
        return f"[{', '.join(str(v) for v in value[:12])}{', …' if len(value) > 12 else ''}]"
    return str(value)


def _joules(energy: Fraction) -> str:
    """Also where a double would overflow: the checker's numbers have no bound but their digits."""
    value = float(Decimal(energy.numerator) / Decimal(energy.denominator))
    if value and abs(value) < float("inf"):
        return shown(value, "J", 6)
    return f"{Decimal(energy.numerator) / Decimal(energy.denominator):.6g} J"
