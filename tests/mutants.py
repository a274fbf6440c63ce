"""Would a mistake in the physics be seen?  Small ones are put in; the tests that reach them run.

    python tests/mutants.py --rooms passivity/linear quantity --sample 300 --seed 1 --ledger mutants.csv

First every test runs once, and is asked which lines of these rooms it reaches.  Then each mutant (see
`checker/mutations.py`) is put into the functions of a process forked from one that has all tests collected,
and the tests that reach its line are run, the quickest first, until one fails: that killed it.  A mutant is
alive when all have passed that fit into --seconds.  Step functions that are translated to C are left out:
what runs is not the Python that would be changed.
"""

from __future__ import annotations

import argparse
import ast
import csv
import gc
import os
import pickle
import random
import resource
import signal
import sys
import time
from collections import Counter, defaultdict
from pathlib import Path
from types import CodeType, FrameType, FunctionType
from typing import Any, NamedTuple

import pytest

sys.path[:0] = [str(Path(__file__).parent / "checker")]
from mutations import mutants_of  # noqa: E402 (it stands beside the checker's cases)

SOURCE = Path(__file__).resolve().parent.parent / "src" / "zwidth"
ROOMS = ("passivity/linear", "quantity", "loop", "data/identification/device")
COLUMNS = ("file", "line", "column", "change", "source", "outcome", "by", "seconds")


class Place(NamedTuple):
    """Of a mutant: enough to make it again."""

    file: str
    number: int
    line: int
    column: int
    change: str


def places(rooms: list[str]) -> list[Place]:
    """Every mutant inside a function that runs as Python."""
    found = []
    for path in sorted(path for room in rooms for path in (SOURCE / room).rglob("*.py")):
        tree = ast.parse(path.read_text(encoding="utf-8"))
        for number, one in enumerate(mutants_of(tree)):
            if not one.everywhere and not _in_c(tree, one.line):
                found.append(Place(str(path), number, one.line, one.column, one.change))
    return found


def _in_c(tree: ast.Module, line: int) -> bool:
    return any(
        isinstance(node, ast.FunctionDef)
        and node.lineno <= line <= (node.end_lineno or 0)
        and any("compiled" in ast.unparse(decorator) for decorator in node.decorator_list)
        for node in ast.walk(tree)
    )


def put_in(place: Place) -> bool:
    """Change the functions of this process; False where nothing that runs is another."""
    tree = ast.parse(Path(place.file).read_text(encoding="utf-8"))
    before = _codes(compile(tree, place.file, "exec"))
    list(mutants_of(tree))[place.number].make()
    after = _codes(compile(ast.fix_missing_locations(tree), place.file, "exec"))
    changed = {key: after[key] for key in before if key in after and before[key] != after[key]}
    made = False
    for function in [one for one in gc.get_objects() if isinstance(one, FunctionType)]:
        code = function.__code__
        other = (
            changed.get((code.co_qualname, code.co_firstlineno)) if code.co_filename == place.file else None
        )
        if other is not None and len(other.co_freevars) == len(code.co_freevars):
            function.__code__ = other
            made = True
    return made


def _codes(code: CodeType) -> dict[tuple[str, int], CodeType]:
    found = {(code.co_qualname, code.co_firstlineno): code}
    for inner in code.co_consts:
        if isinstance(inner, CodeType):
            found |= _codes(inner)
    return found


class Tried:
    """The tests, once collected: run for what they reach, and again with a mutant in."""

    def __init__(self, given: argparse.Namespace) -> None:
        self.given, self.failed = given, ""
        self.folder = str(SOURCE)

    def pytest_runtest_logreport(self, report: Any) -> None:
        if report.failed:
            self.failed = report.nodeid

    @pytest.hookimpl(tryfirst=True)
    def pytest_runtestloop(self, session: Any) -> bool:
        items = {item.nodeid: item for item in session.items}
        reached = self._reached(list(items.values()))
        seconds = {name: spent for name, (spent, _) in reached.items()}
        by_line: dict[tuple[str, int], list[str]] = defaultdict(list)
        for name in sorted(seconds, key=seconds.__getitem__):
            for line in reached[name][1]:
                by_line[line].append(name)
        drawn = places(self.given.rooms)
        random.Random(self.given.seed).shuffle(drawn)
        per_room: Counter[str] = Counter()
        done, ledger = self._ledger()
        for place in drawn:
            room = next(room for room in self.given.rooms if place.file.startswith(str(SOURCE / room)))
            if per_room[room] == self.given.sample:
                continue
            per_room[room] += 1
            key = (
                str(Path(place.file).relative_to(SOURCE)),
                str(place.line),
                str(place.column),
                place.change,
            )
            if key in done:
                continue
            tests = [items[name] for name in by_line[place.file, place.line] if name in items]
            tests.sort(
                key=lambda item: item.get_closest_marker("soak") is not None
            )  # these last, else as they are
            begun = time.monotonic()
            outcome, by = self._tried(place, tests, seconds) if tests else ("not reached", "")
            text = Path(place.file).read_text(encoding="utf-8").splitlines()[place.line - 1].strip()
            ledger.writerow([*key, text, outcome, by, f"{time.monotonic() - begun:.2f}"])
            self.file.flush()
        self.file.close()
        return True

    def _ledger(self) -> tuple[set[tuple[str, ...]], Any]:
        path = Path(self.given.ledger)
        rows = rows_of(path)
        self.file = path.open("a", encoding="utf-8", newline="")
        writer = csv.writer(self.file, lineterminator="\n")
        writer.writerows([] if rows else [COLUMNS])
        return {tuple(row[name] for name in COLUMNS[:4]) for row in rows}, writer

    def _reached(self, items: list[Any]) -> dict[str, tuple[float, set[tuple[str, int]]]]:
        kept = Path(f"{self.given.ledger}.reached")
        if kept.exists():
            return pickle.loads(kept.read_bytes())
        pieces = []
        for part in range(self.given.processes):
            piece = kept.with_suffix(f".{part}")
            pieces.append(piece)
            if os.fork() == 0:
                _silent()
                piece.write_bytes(pickle.dumps(self._lines(items[part :: self.given.processes])))
                os._exit(0)
        for _ in pieces:
            os.wait()
        found = {name: one for piece in pieces for name, one in pickle.loads(piece.read_bytes()).items()}
        kept.write_bytes(pickle.dumps(found))
        return found

    def _lines(self, items: list[Any]) -> dict[str, tuple[float, set[tuple[str, int]]]]:
        found = {}
        lines: set[tuple[str, int]] = set()
        rooms = tuple(str(SOURCE / room) for room in self.given.rooms)

        def called(frame: FrameType, event: str, argument: Any) -> Any:
            return passed if frame.f_code.co_filename.startswith(rooms) else None

        def passed(frame: FrameType, event: str, argument: Any) -> Any:
            lines.add((frame.f_code.co_filename, frame.f_lineno))
            return passed

        for item in items:
            lines.clear()
            self.failed, begun = "", time.monotonic()
            sys.settrace(called)
            item.config.hook.pytest_runtest_protocol(item=item, nextitem=None)
            sys.settrace(None)
            if lines and not self.failed:
                found[item.nodeid] = (time.monotonic() - begun, set(lines))
        return found

    def _tried(self, place: Place, items: list[Any], seconds: dict[str, float]) -> tuple[str, str]:
        reads, writes = os.pipe()
        child = os.fork()
        if child == 0:
            _silent()
            resource.setrlimit(resource.RLIMIT_CPU, (self.given.seconds, self.given.seconds + 5))
            signal.signal(signal.SIGALRM, signal.SIG_DFL)
            signal.alarm(4 * self.given.seconds)  # of a clock, for what waits for ever
            self.failed = ""
            if not put_in(place):
                os.write(writes, b"-")
                os._exit(0)
            signal.signal(signal.SIGVTALRM, signal.SIG_DFL)
            for item in items:
                signal.setitimer(signal.ITIMER_VIRTUAL, 2 + 20 * seconds[item.nodeid])
                item.config.hook.pytest_runtest_protocol(item=item, nextitem=None)
                if self.failed:
                    soak = " (soak)" if item.get_closest_marker("soak") else ""
                    os.write(writes, (self.failed + soak).encode())
                    os._exit(0)
            os.write(writes, b"+")
            os._exit(0)
        os.close(writes)
        said = b"".join(iter(lambda: os.read(reads, 4096), b"")).decode()
        os.close(reads)
        _, status = os.waitpid(child, 0)
        if said == "-":
            return "not made", ""
        if said == "+":
            return "alive", ""
        if said:
            return "killed", said
        ended = os.WTERMSIG(status) if os.WIFSIGNALED(status) else 0
        if ended in (signal.SIGALRM, signal.SIGVTALRM):
            return "killed", "a test does not end"
        return ("alive so far", "") if ended == signal.SIGXCPU else ("killed", "the process ended")


def rows_of(path: Path) -> list[dict[str, str]]:
    """What was tried so far."""
    if not path.exists():
        return []
    with path.open(encoding="utf-8", newline="") as file:
        return list(csv.DictReader(file))


def _silent() -> None:
    nothing = os.open(os.devnull, os.O_RDWR)
    for number in (0, 1, 2):
        os.dup2(nothing, number)


def main() -> int:
    """Run, and print what lives."""
    raw = argparse.RawDescriptionHelpFormatter
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=raw)
    parser.add_argument("--rooms", nargs="+", default=list(ROOMS), help="folders of the source")
    parser.add_argument("--sample", type=int, default=300, help="mutants of each room")
    parser.add_argument("--seed", type=int, default=0)
    parser.add_argument("--seconds", type=int, default=60, help="of the processor, for one mutant")
    parser.add_argument("--processes", type=int, default=2, help="for the first run of the tests")
    parser.add_argument("--ledger", default="mutants.csv", help="what was tried; gone on with where it is")
    parser.add_argument("--tests", nargs="+", default=["tests"])
    given = parser.parse_args()
    options = ["-m", "", "-q", "-n", "0", "-p", "no:cacheprovider", "-p", "no:faulthandler", *given.tests]
    pytest.main(options, plugins=[Tried(given)])
    rows = rows_of(Path(given.ledger))
    for room in given.rooms:
        own = Counter(row["outcome"] for row in rows if row["file"].startswith(room))
        killed, tried = own["killed"], sum(own.values()) - own["not made"]
        late = sum(row["by"].endswith("(soak)") for row in rows if row["file"].startswith(room))
        share = killed / max(tried, 1)
        print(f"{room}: {killed} of {tried} killed ({share:.1%}), {late} in the soak; {dict(own)}")
    return 0


if __name__ == "__main__":
    sys.exit(main())
