"""Which seeds were run and what came out, a line for each stretch and kind; totals for the README."""

from __future__ import annotations

import csv
import fcntl
import os
from collections import Counter
from collections.abc import Iterator
from contextlib import contextmanager
from dataclasses import dataclass, field
from pathlib import Path

from .judge import OUTCOMES, Judged

COLUMNS = ("first_seed", "last_seed", "kind", *(o.replace(" ", "_") for o in OUTCOMES), "wrong", "touched")
START, END = "<!-- random_verdicts: start -->", "<!-- random_verdicts: end -->"


@dataclass
class Stretch:
    """Seeds first to last, all run: for each kind how often each outcome, "wrong" and "touched"."""

    first: int
    last: int
    kinds: dict[str, Counter[str]] = field(default_factory=dict)

    def add(self, judged: Judged) -> None:
        """Count one loop."""
        tally = self.kinds.setdefault(judged.kind, Counter())
        tally[judged.outcome] += 1
        tally["wrong"] += bool(judged.wrong)
        tally["touched"] += judged.touched

    def merge(self, other: Stretch) -> None:
        """Take in the stretch that follows."""
        self.last = other.last
        for kind, tally in other.kinds.items():
            self.kinds.setdefault(kind, Counter()).update(tally)


def read(path: Path) -> list[Stretch]:
    """All stretches, in the order of their seeds."""
    found: dict[tuple[int, int], Stretch] = {}
    with path.open(encoding="utf-8", newline="") as lines:
        for row in csv.DictReader(lines):
            ends = int(row["first_seed"]), int(row["last_seed"])
            stretch = found.setdefault(ends, Stretch(*ends))
            names = zip(COLUMNS[3:], (*OUTCOMES, "wrong", "touched"), strict=True)
            stretch.kinds[row["kind"]] = Counter({name: int(row[column]) for column, name in names})
    return sorted(found.values(), key=lambda s: s.first)


def write(path: Path, stretches: list[Stretch]) -> None:
    """Replace the ledger, whole or not at all."""
    beside = path.with_suffix(".part")
    with beside.open("w", newline="") as lines:
        table = csv.writer(lines, lineterminator="\n")
        table.writerow(COLUMNS)
        for s in joined(stretches):
            for kind, tally in sorted(s.kinds.items()):
                numbers = (tally[name] for name in (*OUTCOMES, "wrong", "touched"))
                table.writerow((s.first, s.last, kind, *numbers))
    os.replace(beside, path)


def joined(stretches: list[Stretch]) -> list[Stretch]:
    """Neighbours as one."""
    out: list[Stretch] = []
    for s in sorted(stretches, key=lambda s: s.first):
        if out and out[-1].last + 1 == s.first:
            out[-1].merge(s)
        else:
            out.append(Stretch(s.first, s.last, {k: Counter(t) for k, t in s.kinds.items()}))
    return out


def next_seed(stretches: list[Stretch]) -> int:
    """The first seed that was never run, nor any after it."""
    return max((s.last for s in stretches), default=-1) + 1


@contextmanager
def alone(path: Path) -> Iterator[None]:
    """Only one run at a time may take seeds from a ledger."""
    with path.open("a", encoding="utf-8") as held:
        try:
            fcntl.flock(held, fcntl.LOCK_EX | fcntl.LOCK_NB)
        except BlockingIOError:
            raise SystemExit(
                f"another run takes seeds from {path}: wait for it, or name another ledger"
            ) from None
        yield


def table(stretches: list[Stretch]) -> str:
    """The totals as a Markdown table."""
    all_of = Stretch(0, 0)
    for s in stretches:
        all_of.merge(s)
    rows = [
        "| kind | loops | passive | passive in contact | of these, defeated by touching | theorem | active "
        "| undecided | refused | wrong |",
        "|---|---:|---:|---:|---:|---:|---:|---:|---:|---:|",
    ]
    sums: Counter[str] = Counter()
    for kind, tally in sorted(all_of.kinds.items()):
        sums.update(tally)
        rows.append(_row(kind, tally))
    return "\n".join([*rows, _row("**all**", sums)])


def _row(kind: str, tally: Counter[str]) -> str:
    loops = sum(tally[o] for o in OUTCOMES)
    undecided = f"{tally['undecided']} ({100 * tally['undecided'] / max(loops, 1):.1f} %)"
    cells = (
        kind, loops, tally["passive"], tally["passive in contact"], tally["touched"], tally["theorem"],
        tally["active"], undecided, tally["refused"], tally["wrong"],
    )  # fmt: skip
    return "| " + " | ".join(str(c) for c in cells) + " |"


def into_readme(path: Path, text: str) -> None:
    """Put a table between its two marks."""
    before, _, rest = path.read_text(encoding="utf-8").partition(START)
    _, _, after = rest.partition(END)
    path.write_text(f"{before}{START}\n\n{text}\n\n{END}{after}", encoding="utf-8")
