"""Is any outcome of `zw.check` wrong?  Random loops of all kinds, attacked by a referee of its own.

Each seed is one loop: any H(z), one-sided walls and solids with memory, encoders with
Coulomb friction, delays, laws in a chain, intervals, wheels; damping and friction are within
1e-9 to 0.3 of a limit.  What the package says is held against `attack/`, which shares no
code with it: the linear criterion in enclosed complex numbers, motions against what is
called passive, the motion run again of what is called active.

    python benchmarks/random_verdicts.py 20000 --processes 2

takes the next seeds that were never run and writes what came out to random_verdicts.csv.
When it is stopped, the chunks that were not finished are lost and are run again; --write-readme
puts the totals into README.md; --seed N judges one loop and says what it is.
"""

from __future__ import annotations

import argparse
import signal
import sys
import time
import warnings
from concurrent.futures import ProcessPoolExecutor
from pathlib import Path

import numpy as np
from attack import ledger, rows
from attack.brackets import bracket
from attack.judge import Judged, judge
from attack.loops import KINDS, SHARES
from attack.self_test import self_test
from rich.progress import track

HERE = Path(__file__).parent
CAMPAIGN = 20_251
"""The first half of every seed."""

PATIENCE = 120
"""Seconds of the processor after which a loop is given up, and said to be wrong."""


class _TooLong(Exception):
    """A loop took longer than anybody would wait."""


def one(seed: int, only: str | None = None) -> tuple[Judged, str]:
    """(what came out of a seed, the loop in words where something was noticed)."""
    rng = np.random.default_rng([CAMPAIGN, seed])
    kind = str(rng.choice(list(SHARES), p=list(SHARES.values())))
    kind = only or kind
    case = rows.draw(rng) if kind == "rows" else KINDS[kind](rng)
    signal.signal(signal.SIGPROF, _stop)
    signal.setitimer(signal.ITIMER_PROF, PATIENCE)
    try:
        found = rows.judge(case, rng) if kind == "rows" else judge(case, rng)
    except _TooLong:
        found = Judged(kind, "undecided", f"not decided in {PATIENCE} s")
    except Exception as error:  # what the user would see as a traceback
        found = Judged(kind, "refused", f"{type(error).__name__}: {error}")
    finally:
        signal.setitimer(signal.ITIMER_PROF, 0)
    return found, f"{case.device!r}, {case.law!r}" if found.wrong else ""


def _stop(*_: object) -> None:
    raise _TooLong


def chunk(work: tuple[int, int, str | None]) -> tuple[ledger.Stretch, list[str], float, int]:
    """A stretch of seeds: the counts, what was wrong, the longest time of a loop [s] and its seed."""
    warnings.simplefilter("ignore")
    first, last, only = work
    stretch, wrong, longest, slowest = ledger.Stretch(first, last), [], 0.0, first
    for seed in range(first, last + 1):
        start = time.perf_counter()
        found, words = one(seed, only)
        spent = time.perf_counter() - start
        if spent > longest:
            longest, slowest = spent, seed
        stretch.add(found)
        if found.wrong:
            wrong.append(f"seed {seed}, {found.kind}, {found.outcome}: {found.wrong}; {words}")
    return stretch, wrong, longest, slowest


def campaign(number: int, processes: int, size: int, path: Path, only: str | None) -> int:
    """Run the next seeds; returns how many outcomes were wrong."""
    if not path.exists():
        ledger.write(path, [])
    with ledger.alone(path):
        done = ledger.read(path)
        first = ledger.next_seed(done)
        ends = range(first, first + number, size)
        work = [(a, min(a + size, first + number) - 1, only) for a in ends]
        wrong, start, longest = 0, time.perf_counter(), (0.0, first)
        try:
            for stretch, said, slow, seed in track(_results(work, processes), "chunks", total=len(work)):
                done = ledger.joined([*done, stretch])
                ledger.write(path, done)
                longest = max(longest, (slow, seed))
                wrong += len(said)
                for line in said:
                    print(line, flush=True)
        except KeyboardInterrupt:
            print("stopped: chunks that were not finished are run again next time")
        ran = ledger.next_seed(done) - first
    spent = time.perf_counter() - start
    seeds = f"seeds {first} to {first + ran - 1}"
    print(f"{ran} loops, {seeds}, {spent:.0f} s, {ran / spent:.0f} a second, {wrong} wrong")
    print(f"longest: seed {longest[1]}, {longest[0]:.1f} s")
    return wrong


def _results(work: list[tuple[int, int, str | None]], processes: int):  # type: ignore[no-untyped-def]
    if processes == 1:
        yield from map(chunk, work)
        return
    with ProcessPoolExecutor(processes) as pool:
        try:
            yield from pool.map(chunk, work)
        except KeyboardInterrupt:
            pool.shutdown(wait=False, cancel_futures=True)
            raise


def main() -> int:
    """Run, and print the totals."""
    raw = argparse.RawDescriptionHelpFormatter
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=raw)
    parser.add_argument("loops", type=int, nargs="?", default=0, help="how many seeds to run; 0: only print")
    parser.add_argument("--processes", type=int, default=1)
    parser.add_argument("--chunk", type=int, default=200, help="seeds that are written down together")
    parser.add_argument("--ledger", type=Path, default=HERE / "random_verdicts.csv")
    parser.add_argument("--kind", choices=list(SHARES), help="one kind only; needs a ledger of its own")
    parser.add_argument("--seed", type=int, help="judge this loop alone, and write nothing")
    parser.add_argument("--write-readme", action="store_true")
    parser.add_argument("--brackets", type=int, default=0, help="so many brackets, their motions looked at")
    parser.add_argument("--self-test", action="store_true", help="the referee beside the simulator")
    given = parser.parse_args()
    if given.brackets:
        wrong = [said for seed in range(given.brackets) if (said := bracket(seed))]
        print(*wrong, f"{given.brackets} brackets, {len(wrong)} wrong", sep="\n")
        return int(bool(wrong))
    if given.self_test:
        return int(self_test() > 0)
    if given.seed is not None:
        found, words = one(given.seed, given.kind)
        print(found, words, sep="\n")
        return int(bool(found.wrong))
    if given.kind and given.ledger == HERE / "random_verdicts.csv":
        parser.error("--kind runs seeds that are not those of the campaign: name another --ledger")
    wrong = (
        campaign(given.loops, given.processes, given.chunk, given.ledger, given.kind) if given.loops else 0
    )
    text = ledger.table(ledger.read(given.ledger))
    print(text)
    if given.write_readme:
        ledger.into_readme(HERE / "README.md", text)
    return int(wrong > 0)


if __name__ == "__main__":
    sys.exit(main())
