"""What a report says, from the top down, in parts that a page and a PDF print alike.

The verdict comes first, then what it covers, then the evidence; every sentence about the loop is
the verdict's own.
"""

from __future__ import annotations

from collections.abc import Iterator, Sequence
from dataclasses import dataclass

from zwidth.passivity.advice import in_lines
from zwidth.passivity.linear_verdict import LinearVerdict
from zwidth.passivity.result import Answer
from zwidth.passivity.scope import COLOUR
from zwidth.passivity.verdict import Verdict
from zwidth.quantity.text import json_file
from zwidth.show.report.beyond import beyond
from zwidth.show.report.motion import first_steps
from zwidth.show.report.proof import Examined, checked, examined
from zwidth.show.report.provenance import Provenance, of_verdict
from zwidth.show.report.what_was_read import what_was_read
from zwidth.showing import Headline, Lines, Part, Table, printable


@dataclass(frozen=True)
class Section:
    """A heading, and what stands below it."""

    title: str
    parts: Sequence[Part]


@dataclass(frozen=True)
class Contents:
    """A report before it is printed.

    Parameters
    ----------
    title
        The device and what it renders.
    verdict
        The outcome, its colour, and the claim.
    sections
        The rest, from the top down; the pictures come behind those of `before_pictures`.
    answer
        Whose pictures they are.
    document
        The verdict with its evidence as a JSON file, as `zwidth check -o` writes it.
    command
        What makes the report again; "" where it was made in Python.
    """

    title: str
    verdict: Headline
    before_pictures: Sequence[Section]
    after_pictures: Sequence[Section]
    answer: Answer
    document: bytes
    command: str


def contents(verdict: Answer, provenance: Provenance | None = None) -> Contents:
    """What a report of a verdict says; `provenance` by default what can be seen of the loop."""
    if provenance is None:
        provenance = of_verdict(verdict) if isinstance(verdict, Verdict) else Provenance(())
    pieces = examined(verdict)
    title = _title(verdict, provenance)
    return Contents(
        title,
        Headline(verdict.outcome, COLOUR[verdict.outcome], verdict.claim),
        tuple(_with_something(_before(verdict, pieces, title))),
        tuple(_with_something(_after(verdict, pieces, provenance))),
        verdict,
        json_file(verdict.saved()),
        provenance.command,
    )


def _title(verdict: Answer, provenance: Provenance) -> str:
    """The device, and in short what it renders; the files that they are of."""
    pair = getattr(verdict, "pair", None)
    if pair is not None:
        return printable(f"{pair.leader.name} and {pair.follower.name}: {pair.describe()}")
    if not isinstance(verdict, Verdict):
        return verdict.describe()
    device, of, file = verdict.device, provenance.device_file, provenance.environment_file
    named = " ".join(device.name.split()) if device.name != "device" else of
    name = named or f"A {device.motion} device"
    beside = f" ({file})" if file and file != of else ""
    return printable(f"{name}: {_law_in_short(verdict)}{beside}")


def _law_in_short(verdict: Verdict) -> str:
    """The law in a few words: as much of its description as fits, up to a comma."""
    first, *others = verdict.environment.describe(verdict.device.motion).split(", ")
    told = first if len(first) <= _LONGEST else f"{first[:_LONGEST]}…"
    for other in others:
        if len(told) + len(other) > _SHORT:
            break
        told += f", {other}"
    return told


_SHORT, _LONGEST = 40, 60
"""Characters of a law in the title: with its numbers, and of its name alone."""


def _before(verdict: Answer, pieces: Sequence[Examined], title: str) -> Iterator[Section]:
    """What the verdict is, what to change, what it covers, and what it stands on."""
    rows = [(name, text) for name, text in verdict.rows() if name not in _TOLD_BELOW]
    law = verdict.environment.describe(verdict.device.motion) if isinstance(verdict, Verdict) else ""
    if law not in title:
        rows.insert(0, ("law", law))
    yield Section("In numbers", [Table(rows=rows)] if rows else [])
    yield _advice(verdict)
    yield Section("What the claim covers and takes for granted", [Lines(verdict.small_print())])
    yield Section(_EVIDENCE[verdict.outcome], list(checked(verdict, pieces)))
    motion = getattr(verdict, "witness", None)
    if motion is not None:
        yield Section("The first steps of the motion", list(first_steps(motion)))


_TOLD_BELOW = ("motion", "decided by")

_EVIDENCE = dict.fromkeys(COLOUR, "The proof") | {
    "active": "The evidence",
    "undecided": "What is known",
    "theorem": "On what it stands",
}


def _after(verdict: Answer, pieces: Sequence[Examined], provenance: Provenance) -> Iterator[Section]:
    """What stands beside the claim, and where everything comes from."""
    if isinstance(verdict, LinearVerdict):
        checks = [f"{check.name}: {check.text}" for check in verdict.actuator]
        yield Section("The actuator, beside the claim", [Lines(checks)] if checks else [])
    yield Section("What is not covered", [Lines(list(beyond(verdict)))])
    heads = [("quantity", "value", "where it comes from")]
    rows = provenance.numbers
    yield Section("Where each number comes from", [Table(heads=heads, rows=rows, lefts=3)] if rows else [])
    yield Section("What the checker read", list(what_was_read(pieces)))


def _advice(verdict: Answer) -> Section:
    """The smallest changes that would do, or how much of each number is to spare."""
    advice = getattr(verdict, "advice", ())
    slack = any(one.kind == "slack" for one in advice)
    told = in_lines(advice, slack)
    useful, useless = told.useful, told.useless
    elsewhere = [one.text for one in getattr(verdict, "stiffness_elsewhere", ())]
    lines = [*useful, *elsewhere, *([useless] if useless else [])]
    title = "How far each number may go" if slack else "What to change, any one of"
    return Section(title, [Lines(lines)] if lines else [])


def _with_something(sections: Iterator[Section]) -> Iterator[Section]:
    return (section for section in sections if section.parts)
