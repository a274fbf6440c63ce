"""What the independent checker found, in the terminal."""

from __future__ import annotations

from collections.abc import Iterator, Mapping
from decimal import Decimal
from fractions import Fraction

from rich.table import Table
from rich.text import Text

from zwidth.cli.numerals import shown, unit_text
from zwidth.cli.report import page
from zwidth.cli.table import plain
from zwidth.passivity.certificate import verify_document
from zwidth.passivity.checker import Verification
from zwidth.passivity.document import unit_key
from zwidth.quantity.glossary import GLOSSARY

_EVIDENCE = ("certificate", "witness")


def checked(document: object) -> Verification:
    """What the independent checker says, and of a whole verdict also whether its evidence fits its outcome.

    Raises
    ------
    InputError
        If the document contains no evidence.
    """
    verification = verify_document(document)
    outcome = document.get("outcome") if isinstance(document, Mapping) else None
    if not verification.valid or outcome not in ("passive", "active"):
        return verification
    extracts = verification.energy is not None
    if extracts == (outcome == "active"):
        return verification
    found = "a motion that extracts energy" if extracts else "a proof of passivity"
    return Verification(False, f"the verdict says {outcome}, and its evidence is {found}")


def print_verification(document: object, verification: Verification) -> None:
    """Print whether the document holds, of which loop, and the joules of a motion."""
    word, colour = ("VALID", "green") if verification.valid else ("NOT VALID", "red")
    headline = Table.grid(padding=(0, 1))
    badge = Text(f" {word} ", style=f"bold white on {colour}")
    proof = (
        "The loop below is passive, proved: " if verification.valid and verification.energy is None else ""
    )
    headline.add_row(badge, Text(proof + plain(verification.reason, 400), style="bold"))
    details = Table.grid(padding=(0, 2))
    for name, text in _rows(document, verification):
        details.add_row(Text(name, style="dim"), Text(text))
    with page() as out:
        out.print(headline)
        out.print()
        out.print(details)


def _rows(document: object, verification: Verification) -> Iterator[tuple[str, str]]:
    if verification.energy is not None:
        yield "energy extracted", _joules(verification.energy)
    evidence = _evidence(document)
    corners = _corners(document)
    if corners:
        yield "corner", f"1 of {len(corners)}, each with a proof of its own"
    if "kind" in evidence:
        yield "kind", plain(str(evidence["kind"]))
    loop = evidence.get("loop")
    if isinstance(loop, Mapping):
        known = _known_keys()
        for key, value in loop.items():
            name, unit = known.get(str(key), (str(key), ""))
            yield plain(name), f"{plain(_text(value))} {unit}".rstrip()


def _known_keys() -> dict[str, tuple[str, str]]:
    """The keys of quantities in a document, as words and unit."""
    keys = {
        unit_key(name, motion): (name.replace("_", " "), unit_text(entry.unit_for(motion)))
        for name, entry in GLOSSARY.items()
        for motion in ("linear", "rotary")
    }
    powers = "in descending powers of z"
    return {**keys, "numerator": ("numerator", powers), "denominator": ("denominator", powers)}


def _inner(document: object) -> object:
    """The certificate or witness itself, also where it is part of a verdict."""
    while isinstance(document, Mapping):
        inner = next((document[k] for k in _EVIDENCE if isinstance(document.get(k), Mapping)), None)
        if inner is None:
            break
        document = inner
    return document


def _corners(document: object) -> list[object]:
    inner = _inner(document)
    corners = inner.get("corners") if isinstance(inner, Mapping) and inner.get("kind") == "corners" else None
    return corners if isinstance(corners, list) else []


def _evidence(document: object) -> Mapping[str, object]:
    """What was checked, of several corners the first."""
    inner = _inner(document)
    for corner in _corners(inner)[:1]:
        inner = _inner(corner)
    return inner if isinstance(inner, Mapping) else {}


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
