"""The command `verify`: what the independent checker finds, in the terminal."""

from __future__ import annotations

import argparse
import json
from collections.abc import Iterator, Mapping
from decimal import Decimal
from fractions import Fraction
from pathlib import Path

from zwidth.checker import (
    Judged,
    Part,
    Row,
    Unreadable,
    Verified,
    answer,
    headline,
    judge_file,
    not_checked,
    rows,
)
from zwidth.cli.output import print_json
from zwidth.cli.page import below, grid, page
from zwidth.cli.page import headline as badge
from zwidth.cli.parsing import heed_angles
from zwidth.errors import InputError
from zwidth.missing import did_you_mean, suggestion
from zwidth.model.specification.table import plain, quoted
from zwidth.quantity.spoken import spoken
from zwidth.quantity.text import shown

_LAWS_IN_A_CHAIN = ("row storage", "row motion")
"""Documents of a table or of forces: the checker knows no law, and the law is stepped again here."""

_COLOURS = {"VALID": "green", "NOT VALID": "red"}


USAGE = "FILE [--angles UNIT]\n       %(prog)s --schema KIND"
OPTIONS = (
    {
        "file=FILE?": "certificate, witness, verdict or limit saved as JSON",
        "--schema KIND": "print the JSON Schema of the documents of a kind, such as spring or corners",
        "--angles UNIT": "beside what the file has, in rad, tell it in deg, turn or rpm",
    },
)


def run(arguments: argparse.Namespace) -> int:
    """`zwidth verify`: 0 where everything holds, else 1."""
    if arguments.schema is not None:
        return _schema(arguments)
    if arguments.file is None:
        raise InputError("which FILE is to be checked? Or --schema KIND for what one must look like")
    heed_angles(arguments)
    found, laws = _with_laws(judged(arguments.file))
    print_judged(found, laws)
    return 0 if found.valid else 1


def _schema(arguments: argparse.Namespace) -> int:
    if arguments.file is not None:
        raise InputError("--schema prints what a document must look like, and checks no FILE")

    print_json(schema(arguments.schema))
    return 0


def judged(path: str) -> Judged:
    """What the checker finds of a file."""
    try:
        return judge_file(path)
    except Unreadable as error:
        missing = did_you_mean(Path(path)) if not Path(path).exists() else ""
        inside = "; name the file in it" if Path(path).is_dir() else ""
        raise InputError(f"{path}: {error}{missing}{inside}") from None


def _with_laws(found: Judged) -> tuple[Judged, dict[str, str]]:
    """Laws in a chain stepped again from their parameters: by where each stands, which it is."""
    parts, laws = list[Part](), dict[str, str]()
    for part in found.parts:
        if part.verification.valid and part.evidence["kind"] in _LAWS_IN_A_CHAIN:
            from zwidth.passivity.storage.chain_document import law_of  # xarray takes its time

            try:
                law = law_of(part.evidence)
                laws |= {} if law is None else {part.at: law}
            except InputError as error:
                part = part._replace(verification=Verified(False, str(error)))
        parts.append(part)
    return found._replace(parts=tuple(parts)), laws


def print_judged(found: Judged, laws: Mapping[str, str]) -> None:
    """Print the answer, whether each piece of evidence holds, of which loop, and the joules of a motion."""
    with page() as out:
        if (whole := answer(found)) is not None:
            out.print(badge(whole[0], _COLOURS[whole[0]], plain(whole[1], 1000)))
        for part in found.parts:
            word, claim = headline(part)
            out.print(badge(word, _COLOURS[word], claim))
            out.print(below(grid(_rows(part, laws.get(part.at)))))
        if told := not_checked(found):
            out.print(f"told, not checked: {told}", style="dim")


def _rows(part: Part, law: str | None) -> Iterator[tuple[str, str]]:
    for row in rows(part):
        if row.name == "energy extracted" and part.verification.energy is not None:
            yield row.name, _joules(part.verification.energy)
        elif not row.told or law is None:
            yield row.name, row.text + _in_other_words(row)
        if row.name == "kind" and law is not None:
            yield "law, stepped again", plain(law, 300)


def _in_other_words(row: Row) -> str:
    """The same, rounded, in the angle that was asked for; "" where that is what the document has."""
    factor, said = spoken(row.unit)
    if factor == 1.0:
        return ""
    try:
        return f" = {factor * float(row.text.removesuffix(f' {row.unit}')):.6g} {said}"
    except ValueError:  # a list of numbers
        return ""


def _joules(energy: Fraction) -> str:
    """Also where a double would overflow: the checker's numbers have no bound but their digits."""
    exact = Decimal(energy.numerator) / Decimal(energy.denominator)
    fits = float(exact) and abs(float(exact)) < float("inf")
    return shown(float(exact), "J", 6) if fits else f"{exact:.6g} J"


def schema(kind: str) -> str:
    """What stands in the file of a kind of document, in lines for people."""
    from importlib.resources import files  # it loads half of the library

    shipped = {
        path.name.removesuffix(".json").replace("-", " "): path
        for path in files("zwidth.checker").joinpath("schemas").iterdir()
    }
    if kind not in shipped:
        raise InputError(f"there is no kind of document {quoted(kind)}; {suggestion(kind, sorted(shipped))}")
    told = json.loads(shipped[kind].read_text(encoding="utf-8"))
    return json.dumps(told, indent=2, ensure_ascii=False)
