"""Does the checker accept a false document?  Random ones of every kind, judged a second time by other roads.

Each seed is one document: a valid one with some numbers, terms or choices changed and its claim strengthened
by a little, or one from nothing in the right shape, or one that is ill-formed.  What the checker accepts is
judged in `documents/`, which shares no code with it.

    python benchmarks/random_documents.py --documents 1000000 --first 0 --processes 2 --ledger FILE.csv

runs the seeds that the ledger does not have yet.  When it is stopped, chunks that were not finished are run
again; what is false is made smaller and saved beside the ledger, with the reason.  --only N judges one seed.
"""

# ruff: noqa: E402 (threads are told before numpy is loaded)
from __future__ import annotations

import os

for threads in ("OPENBLAS_NUM_THREADS", "OMP_NUM_THREADS", "MKL_NUM_THREADS", "NUMBA_NUM_THREADS"):
    os.environ.setdefault(threads, "1")  # before numpy: every process is one thread

import argparse
import json
import sys
import time
import warnings
from collections.abc import Iterator, Mapping
from concurrent.futures import ProcessPoolExecutor
from functools import partial
from pathlib import Path
from typing import Any, NamedTuple

from attack.ledger import alone
from documents import ledger, seeds
from documents.examine import FINDINGS, Examined, examine, numbers_of_any_length, told, watch
from documents.grammar import SHARES, Valid, ready
from documents.self_test import self_test
from rich.progress import track

HERE = Path(__file__).parent

SLOW_S, LARGE_MB = 10.0, 1000.0
"""A document that takes more to be checked is named."""

SAVED = 20
"""Findings of each chunk that are made smaller and saved."""


class Told(NamedTuple):
    """What is to be told of a seed: a line, and of a finding its text and the name of its file."""

    line: str
    name: str = ""
    text: str = ""


def chunk(
    work: tuple[int, int], given: Mapping[str, Valid], only: str | None
) -> tuple[ledger.Stretch, list[Told]]:
    """A stretch of seeds: the counts, and what is to be told of some."""
    warnings.simplefilter("ignore")
    watch.begin()
    stretch, noticed = ledger.Stretch(*work), list[Told]()
    for seed in range(work[0], work[1] + 1):
        found = examine(seed, given, only)
        stretch.add(seed, found)
        if found.word in FINDINGS or found.seconds > SLOW_S or found.room > LARGE_MB:
            noticed.append(_noticed(seed, found, small=len(noticed) < SAVED))
    return stretch, noticed


def _noticed(seed: int, found: Examined, *, small: bool) -> Told:
    """As text: a document may be nested too deep to be handed from process to process."""
    kind, spent = found.written.kind, f"{found.seconds:.1f} s, {found.room:.0f} MB"
    line = f"seed {seed}, {kind}, {found.word}: {found.why}; {found.written.how}; {spent}"
    if found.word not in FINDINGS:
        return Told(line)
    name = f"{kind.replace(' ', '-')}-{seed}.json"
    return Told(line, name, told(found, seed) if small else "")


def campaign(given: argparse.Namespace, known: Mapping[str, Valid]) -> int:
    """Run what the ledger does not have; returns how many findings there were."""
    findings, start, ran = 0, time.perf_counter(), 0
    folder = given.ledger.with_name(f"{given.ledger.stem}-findings")
    if not given.ledger.exists():
        given.ledger.parent.mkdir(parents=True, exist_ok=True)
        ledger.write(given.ledger, [])
    with alone(given.ledger):
        done = ledger.read(given.ledger)
        work = ledger.still_to_run(done, given.first, given.documents, given.chunk)
        run = partial(chunk, given=known, only=given.kind)
        try:
            for stretch, noticed in track(_results(run, work, given.processes), "documents", total=len(work)):
                done = ledger.joined([*done, stretch])
                ledger.write(given.ledger, done)
                ran += stretch.last - stretch.first + 1
                findings += _tell(noticed, folder)
        except KeyboardInterrupt:
            print("stopped: chunks that were not finished are run again next time")
    spent = time.perf_counter() - start
    print(f"{ran} documents, {spent:.0f} s, {1000 * spent / max(ran, 1):.2f} ms each, {findings} findings")
    return findings


def _tell(noticed: list[Told], folder: Path) -> int:
    """Print what was noticed, save what was found; how many findings."""
    for one in noticed:
        print(one.line, flush=True)
        if one.text:
            folder.mkdir(parents=True, exist_ok=True)
            (folder / one.name).write_text(one.text, encoding="utf-8")
    return sum(bool(one.name) for one in noticed)


def _results(run: Any, work: list[tuple[int, int]], processes: int) -> Iterator[Any]:
    if processes == 1:
        yield from map(run, work)
        return
    with ProcessPoolExecutor(processes) as pool:
        try:
            yield from pool.map(run, work)
        except KeyboardInterrupt:
            pool.shutdown(wait=False, cancel_futures=True)
            raise


def _alone(seed: int, known: Mapping[str, Valid], only: str | None) -> int:
    """One seed: its document, what is said of it, and the smallest of which the same is."""
    watch.begin()
    found = examine(seed, known, only)
    with numbers_of_any_length():
        print(json.dumps(found.written.document, indent=1, default=str))
    print(f"{found.written.kind}, {found.written.how}: {found.word}, {found.why}")
    print(f"{found.seconds:.3f} s, {found.room:.0f} MB")
    if found.word in FINDINGS:
        print(told(found, seed))
    return int(found.word in FINDINGS)


def main() -> int:
    """Run, and print the totals."""
    raw = argparse.RawDescriptionHelpFormatter
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=raw)
    parser.add_argument("--documents", type=int, default=0, help="how many seeds; 0: only print")
    parser.add_argument("--first", type=int, default=0, help="the first of them")
    parser.add_argument("--processes", type=int, default=1)
    parser.add_argument("--chunk", type=int, default=500, help="seeds that are written down together")
    parser.add_argument("--ledger", type=Path, default=HERE / "random_documents.csv")
    parser.add_argument("--kind", choices=list(SHARES), help="one kind only; needs a ledger of its own")
    parser.add_argument(
        "--only", type=int, metavar="SEED", help="judge this document alone, and write nothing"
    )
    parser.add_argument(
        "--seeds", type=Path, default=seeds.default_path(), help="the valid documents, kept here"
    )
    parser.add_argument("--write-readme", action="store_true")
    parser.add_argument("--self-test", action="store_true", help="can every judge say no?")
    given = parser.parse_args()
    known = ready(seeds.read(given.seeds))
    if given.self_test:
        return int(self_test(known) > 0)
    if given.only is not None:
        return _alone(given.only, known, given.kind)
    if given.kind and given.ledger == HERE / "random_documents.csv":
        parser.error("--kind writes other documents than the campaign does: name another --ledger")
    findings = campaign(given, known) if given.documents else 0
    stretches = ledger.read(given.ledger)
    text = ledger.table(stretches)
    print(text)
    if given.write_readme:
        ledger.into_readme(HERE / "README.md", f"{ledger.seeds_run(stretches)}\n\n{text}")
    return int(findings > 0)


if __name__ == "__main__":
    sys.exit(main())
