"""What a report says, from the top down: the verdict, what it covers, the evidence, what the checker read.

Every sentence about the loop is the verdict's own.
"""

from __future__ import annotations

import re
from collections.abc import Iterator, Sequence
from dataclasses import dataclass
from fractions import Fraction
from typing import Any, NamedTuple

from zwidth.checker import EVIDENCE, Verified, verify
from zwidth.passivity.advice import in_lines
from zwidth.passivity.linear_verdict import LinearVerdict
from zwidth.passivity.pairs.evidence import PairWitness
from zwidth.passivity.result import Answer, Evidence
from zwidth.passivity.scope import COLOUR
from zwidth.passivity.storage.gain import Gain, settled_round
from zwidth.passivity.verdict import Verdict
from zwidth.passivity.witness.witness import Witness
from zwidth.quantity.glossary import GLOSSARY
from zwidth.quantity.text import in_words, json_file, shown
from zwidth.show.report.provenance import Provenance, of_verdict
from zwidth.showing import Headline, Lines, Part, Table, printable


@dataclass(frozen=True)
class Section:
    title: str
    parts: Sequence[Part]


@dataclass(frozen=True)
class Contents:
    """A report before it is printed.

    `title`: the device and what it renders.
    `verdict`: the outcome, its colour, and the claim.
    `sections`: the rest, from the top down; the pictures come behind those of `before_pictures`.
    `answer`: whose pictures they are.
    `document`: the verdict with its evidence as a JSON file, as `zwidth check -o` writes it.
    `command`: what makes the report again; "" where it was made in Python.
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
    pieces = [_Examined(name, one.describe(), verify(one.to_dict())) for name, one in _pieces(verdict)]
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


def _before(verdict: Answer, pieces: Sequence[_Examined], title: str) -> Iterator[Section]:
    """What the verdict is, what to change, what it covers, and what it stands on."""
    rows = [(name, text) for name, text in verdict.rows() if name not in _TOLD_BELOW]
    law = verdict.environment.describe(verdict.device.motion) if isinstance(verdict, Verdict) else ""
    if law not in title:
        rows.insert(0, ("law", law))
    yield Section("In numbers", [Table(rows=rows)] if rows else [])
    yield _advice(verdict)
    yield Section("What the claim covers and takes for granted", [Lines(verdict.small_print())])
    yield Section(_EVIDENCE[verdict.outcome], list(_checked(verdict, pieces)))
    motion = getattr(verdict, "witness", None)
    if motion is not None:
        yield Section("The first steps of the motion", list(_first_steps(motion)))


_TOLD_BELOW = ("motion", "decided by")

_EVIDENCE = dict.fromkeys(COLOUR, "The proof") | {
    "active": "The evidence",
    "undecided": "What is known",
    "theorem": "On what it stands",
}


def _after(verdict: Answer, pieces: Sequence[_Examined], provenance: Provenance) -> Iterator[Section]:
    """What stands beside the claim, and where everything comes from."""
    if isinstance(verdict, LinearVerdict):
        checks = [f"{check.name}: {check.text}" for check in verdict.actuator]
        yield Section("The actuator, beside the claim", [Lines(checks)] if checks else [])
    yield Section("What is not covered", [Lines(list(_beyond(verdict)))])
    heads = [("quantity", "value", "where it comes from")]
    rows = provenance.numbers
    yield Section("Where each number comes from", [Table(heads=heads, rows=rows, lefts=3)] if rows else [])
    yield Section("What the checker read", list(_what_was_read(pieces)))


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


NAME = "verdict.json"
"""What the attached document is called."""

_NAMES = {
    "certificate": "The certificate",
    "violation": "The proof that energy comes out",
    "witness": "The motion",
}

_REFEREE = (
    "The independent checker, which shares no code with what found it, computes in exact arithmetic and"
)


class _Examined(NamedTuple):
    """A document of the evidence: what it is called, what it shows, and what the checker found."""

    name: str
    shows: str
    found: Verified


def _checked(verdict: Answer, pieces: Sequence[_Examined]) -> Iterator[Part]:
    """On what the outcome stands, piece by piece."""
    if isinstance(verdict, Verdict):
        yield f"Decided by: {verdict.decided_by}."
    if not pieces:
        yield "There is no document of it that the checker could read."
    for name, shows, found in pieces:
        said = "accepts it" if found.valid else "rejects it"
        yield f"{name}: {shows}. {_REFEREE} {said}: {found.reason}."


def _pieces(verdict: Answer) -> Iterator[tuple[str, Evidence]]:
    for name in EVIDENCE:
        piece = getattr(verdict, name, None)
        if isinstance(piece, Evidence):
            yield _NAMES[name], piece
    best = getattr(verdict, "best_corner", None)
    if best is not None:
        yield "The same at the best values of the intervals", best
    bounded = getattr(verdict, "available_storage", None)
    if bounded is not None and bounded.certificate is not None:
        yield "The certificate for bounded hands", bounded.certificate


_STEPS = 12
"""Instants that are listed."""


class _Steps(NamedTuple):
    """At each instant time [s], position and energy; the force that is held from there on."""

    times: Sequence[float]
    positions: Sequence[float]
    forces: Sequence[float]
    energies: Sequence[float]
    motion: str


def _first_steps(found: Any) -> Iterator[Part]:
    yield f"{found.describe()}."
    if isinstance(found, Witness):
        yield _steps_table(_of_a_witness(found))
    elif isinstance(found, Gain):
        yield "One round of it, once the law does the same in each:"
        yield _steps_table(_of_a_gain(found))
    elif isinstance(found, PairWitness):
        yield _of_both_arms(found)


def _of_both_arms(found: PairWitness) -> Table:
    """Where both are at the first samples."""
    from zwidth.show.plots.style import number, scale

    listed = [[float(x) for x in positions[:_STEPS]] for positions in found.positions]
    factor, unit = scale([x for positions in listed for x in positions], found.pair.leader.unit("position"))
    rows = [(str(k), *(number(factor * x) for x in both)) for k, both in enumerate(zip(*listed, strict=True))]
    return Table(heads=[("sample", "leader", "follower"), ("", unit, unit)], rows=rows, lefts=0)


def _of_a_witness(found: Witness) -> _Steps:
    from zwidth.show.plots.replay import replay  # the pictures play it too

    played = replay(found)
    return _Steps(played.times, played.positions, played.forces, played.energies, found.setting.motion)


def _of_a_gain(found: Gain) -> _Steps:
    once = settled_round(found)
    times = [found.sample_period * t for t in once.times]
    motion = "rotary" if found.unit == "rad" else "linear"
    return _Steps(times, once.positions, once.forces, once.energies, motion)


def _steps_table(steps: _Steps) -> Table:
    from zwidth.show.plots.style import number, scale

    units = ("s", *(GLOSSARY[name].unit_for(steps.motion) for name in ("position", "force")), "J")
    begin = next((max(0, k - 1) for k, force in enumerate(steps.forces) if force), 0)
    columns = []
    for values, unit in zip(steps[:4], units, strict=True):
        listed = values[begin : begin + _STEPS]
        factor, name = scale(listed, unit)
        columns.append((name, [number(factor * value) for value in listed]))
    many = len(steps.times) > begin + _STEPS
    heads = [
        ("time", "position", "force from then on", "energy out so far"),
        tuple(name for name, _ in columns),
    ]
    texts = [texts for _, texts in columns]
    texts[2] += [""] * (len(texts[0]) - len(texts[2]))
    rows = [tuple(row) for row in zip(*texts, strict=True)]
    caption = "from the first force on" if begin else ""
    return Table(heads=heads, rows=[*rows, ("…",) * 4] if many else rows, lefts=0, caption=caption)


def _beyond(verdict: Answer) -> Iterator[str]:
    """What a verdict is not about, so that nobody reads more into it than was proved."""
    given = verdict.scope.transmission
    if verdict.outcome == "active" and (not isinstance(verdict, Verdict) or given == "as given"):
        yield "Whether given hands make this motion: zwidth simulate shows what hands of your choice meet."
    elif verdict.outcome == "active":
        yield (
            "Whether a given hand makes this motion: zwidth check --replay says how stiff a hand must be for "
            "it, and zwidth simulate shows what a hand of your choice meets."
        )
    elif verdict.outcome == "undecided":
        yield "Whether the loop is passive: undecided is neither a proof nor a motion."
    else:
        yield (
            "A device of other numbers: the proof is about those below. Measure the device's own friction; "
            "where there is less of it, or a slower or later loop, ask again."
        )
    ends = {"rigid": "What bends between motor, encoder and handle, and torque", "any": "Torque"}
    yield f"{ends.get(given, 'Backlash of a gear, and torque')} ripple of the motor."
    yield "Other forces that the same program adds to this law: ask about the law that is their sum."


_DIGITS = 6

_LONGEST_LIST = 44
"""Characters of a list that are shown."""

_MOST_ROWS = 24
"""Numbers that entered the proof up to which they are shown."""

_NUMBER = re.compile(r"-?\d+(?:\.\d+)?(?:[eE][+-]?\d+)?(?:/\d+)?")
_LIST = re.compile(r"\[[\[\](),…\s\d./eE+-]*\]")

Rows = tuple[tuple[str, str], ...]


def _what_was_read(pieces: Sequence[_Examined]) -> Iterator[Part]:
    """A table for each piece of evidence; of two that say the same, one."""
    told: list[Rows] = []
    for piece in pieces:
        rows = tuple((in_words(r.name), as_read(r.text, r.unit)) for r in piece.found.rows if not r.told)
        if 0 < len(rows) <= _MOST_ROWS and rows not in told:
            told.append(rows)
            yield Table(rows=rows, caption=piece.name)
    if told:
        yield f"Rounded to {_DIGITS} digits; the proof is about the exact numbers, which stand in {NAME}."


def as_read(text: str, unit: str) -> str:
    """A value of a document with its unit, for people: a number with a prefix, a list in short."""
    if text == "[]":
        return "none"
    if _NUMBER.fullmatch(text):
        return _rounded(text, unit)
    if _LIST.fullmatch(text):
        text = _in_short(_NUMBER.sub(lambda number: _rounded(number[0]), text))
    elif len(text) > _LONGEST_LIST:
        text = f"{text[:_LONGEST_LIST]}…"
    return f"{text} {unit}".rstrip()


def _rounded(text: str, unit: str = "") -> str:
    try:
        return shown(float(Fraction(text)), unit, _DIGITS)
    except (ArithmeticError, ValueError):  # larger than any quantity
        return f"{text[:_LONGEST_LIST]} {unit}".rstrip()


def _in_short(text: str) -> str:
    """So much of a list as fits, its last number, or list of numbers, whole."""
    if len(text) <= _LONGEST_LIST:
        return text
    between = "], " if text.startswith("[[") else ", "
    return f"{text[:_LONGEST_LIST].rpartition(between)[0]}{between}…]"
