"""Which seeds were run and what came out, a line for each stretch and kind; the totals as a table."""

from __future__ import annotations

import csv
import os
from collections import Counter
from dataclasses import dataclass, field
from pathlib import Path

from .examine import WORDS, Examined

COLUMNS = (
    "first_seed",
    "last_seed",
    "kind",
    *(w.replace(" ", "_") for w in WORDS),
    "slowest_ms",
    "slowest_seed",
    "most_MB",
)
START, END = "<!-- random_documents: start -->", "<!-- random_documents: end -->"


@dataclass
class Tally:
    """Of one kind: how often each word, the slowest check [s] and its seed, the most that was taken [MB]."""

    words: Counter[str] = field(default_factory=Counter)
    slowest: tuple[float, int] = (0.0, 0)
    room: float = 0.0

    def merge(self, other: Tally) -> None:
        """Take in what another stretch found."""
        self.words.update(other.words)
        self.slowest = max(self.slowest, other.slowest)
        self.room = max(self.room, other.room)


@dataclass
class Stretch:
    """Seeds first to last, all run."""

    first: int
    last: int
    kinds: dict[str, Tally] = field(default_factory=dict)

    def add(self, seed: int, found: Examined) -> None:
        """Count one document."""
        one = Tally(Counter({found.word: 1}), (found.seconds, seed), found.room)
        self.kinds.setdefault(found.written.kind, Tally()).merge(one)

    def merge(self, other: Stretch) -> None:
        """Take in the stretch that follows."""
        self.last = other.last
        for kind, tally in other.kinds.items():
            self.kinds.setdefault(kind, Tally()).merge(tally)


def read(path: Path) -> list[Stretch]:
    """All stretches, in the order of their seeds; none where there is no ledger yet."""
    found: dict[tuple[int, int], Stretch] = {}
    if not path.exists():
        return []
    with path.open(encoding="utf-8", newline="") as lines:
        for row in csv.DictReader(lines):
            ends = int(row["first_seed"]), int(row["last_seed"])
            words = Counter({word: int(row[word.replace(" ", "_")]) for word in WORDS})
            slowest = float(row["slowest_ms"]) / 1000, int(row["slowest_seed"])
            found.setdefault(ends, Stretch(*ends)).kinds[row["kind"]] = Tally(
                words, slowest, float(row["most_MB"])
            )
    return sorted(found.values(), key=lambda s: s.first)


def write(path: Path, stretches: list[Stretch]) -> None:
    """Replace the ledger, whole or not at all."""
    beside = path.with_suffix(".part")
    with beside.open("w", newline="") as lines:
        table = csv.writer(lines, lineterminator="\n")
        table.writerow(COLUMNS)
        for s in stretches:
            for kind, tally in sorted(s.kinds.items()):
                numbers = (tally.words[word] for word in WORDS)
                spent = f"{1000 * tally.slowest[0]:.1f}", tally.slowest[1], f"{tally.room:.0f}"
                table.writerow((s.first, s.last, kind, *numbers, *spent))
    os.replace(beside, path)


def joined(stretches: list[Stretch]) -> list[Stretch]:
    """Neighbours as one."""
    out: list[Stretch] = []
    for s in sorted(stretches, key=lambda s: s.first):
        if out and out[-1].last + 1 == s.first:
            out[-1].merge(s)
        else:
            out.append(Stretch(s.first, s.last))
            out[-1].merge(s)
    return out


def still_to_run(stretches: list[Stretch], first: int, number: int, size: int) -> list[tuple[int, int]]:
    """Pieces of at most so many seeds that no stretch has."""
    pieces, at, end = [], first, first + number
    for s in [*sorted(stretches, key=lambda s: s.first), Stretch(end, end)]:
        while at < min(s.first, end):
            last = min(at + size, s.first, end) - 1
            pieces.append((at, last))
            at = last + 1
        at = max(at, s.last + 1)
    return pieces


def total(stretches: list[Stretch]) -> dict[str, Tally]:
    """All stretches together, by kind."""
    all_of = Stretch(0, 0)
    for s in stretches:
        all_of.merge(s)
    return dict(sorted(all_of.kinds.items()))


def seeds_run(stretches: list[Stretch]) -> str:
    """Which seeds were run, in words."""
    ends = (f"{s.first:,} to {s.last:,}".replace(",", " ") for s in stretches)
    return f"Seeds {', '.join(ends)}:"


def table(stretches: list[Stretch]) -> str:
    """The totals as a Markdown table."""
    rows = [
        "| kind | written | accepted | agreed | cannot say | false | ill-formed accepted | errors "
        "| slowest, s | seed | most, MB |",
        "|---|---:|---:|---:|---:|---:|---:|---:|---:|---:|---:|",
    ]
    everything = Tally()
    for kind, tally in total(stretches).items():
        everything.merge(tally)
        rows.append(_row(kind, tally))
    return "\n".join([*rows, _row("**all**", everything)])


def _row(kind: str, tally: Tally) -> str:
    written = sum(tally.words.values())
    refused, agreed, opened, wrong, ill, errors = (tally.words[word] for word in WORDS)
    cells = (
        kind, written, written - refused - errors, agreed, opened, wrong, ill, errors,
        f"{tally.slowest[0]:.2f}", tally.slowest[1], f"{tally.room:.0f}" if tally.room else "",
    )  # fmt: skip
    return "| " + " | ".join(str(c) for c in cells) + " |"


def into_readme(path: Path, text: str) -> None:
    """Put a table between its two marks."""
    before, _, rest = path.read_text(encoding="utf-8").partition(START)
    _, _, after = rest.partition(END)
    path.write_text(f"{before}{START}\n\n{text}\n\n{END}{after}", encoding="utf-8")
