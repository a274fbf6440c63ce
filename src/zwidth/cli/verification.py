"""What the independent checker found, in the terminal."""

from __future__ import annotations

from collections.abc import Iterator, Mapping
from decimal import Decimal
from fractions import Fraction

from rich.table import Table
from rich.text import Text

from zwidth.cli.numerals import shown
from zwidth.cli.report import page
from zwidth.cli.table import plain
from zwidth.passivity.checker import Verification

_EVIDENCE = ("certificate", "witness")


def print_verification(document: object, verification: Verification) -> None:
    """Print whether the document holds, of which loop, and the joules of a motion."""
    word, colour = ("VALID", "green") if verification.valid else ("NOT VALID", "red")
    headline = Table.grid(padding=(0, 1))
    badge = Text(f" {word} ", style=f"bold white on {colour}")
    headline.add_row(badge, Text(plain(verification.reason, 400), style="bold"))
    details = Table.grid(padding=(0, 2))
    for name, text in _rows(document, verification):
        details.add_row(Text(name, style="dim"), Text(text))
    with page() as out:
        out.print(headline)
        out.print(details)


def _rows(document: object, verification: Verification) -> Iterator[tuple[str, str]]:
    if verification.energy is not None:
        yield "energy extracted", _joules(verification.energy)
    evidence = _evidence(document)
    if "kind" in evidence:
        yield "kind", plain(str(evidence["kind"]))
    loop = evidence.get("loop")
    if isinstance(loop, Mapping):
        for key, value in loop.items():
            yield plain(str(key)), plain(_text(value))


def _evidence(document: object) -> Mapping[str, object]:
    """The certificate or witness itself, also inside a verdict or of the first corner."""
    if not isinstance(document, Mapping):
        return {}
    for key in _EVIDENCE:
        if isinstance(document.get(key), Mapping):
            return _evidence(document[key])
    corners = document.get("corners")
    if document.get("kind") == "corners" and isinstance(corners, list) and corners:
        return _evidence(corners[0])
    return document


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
