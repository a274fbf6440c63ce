"""Would a mistake in the checker be seen?  Every mutant of it is run against the cases beside this file.

    python tests/checker/mutants.py --sample 1500 --seed 1 --processes 2 --ledger mutants.csv

A mutant is killed by a case that comes out otherwise, by an error that is no refusal, or by taking far longer
than the checker takes.  Each runs in a process forked from one that has everything loaded, and only the cases
that reach its line are run, the quickest first.  What lives is a case to be added in `cases/`, or a line in
`equivalent.toml` that says why nothing false can be accepted because of it and nothing true refused.

A ledger that is there is gone on with, as long as the checker is the same: what is in it is not run
again, but for mutants that lived and are not listed, which a new case may kill.
"""

from __future__ import annotations

import os

os.environ["OPENBLAS_NUM_THREADS"] = os.environ["OMP_NUM_THREADS"] = "1"  # a fork has one thread

import argparse
import ast
import csv
import hashlib
import random
import re
import resource
import signal
import sys
import time
import tomllib
from collections import Counter, defaultdict
from collections.abc import Iterable, Iterator, Mapping, Sequence, Set
from contextlib import contextmanager
from fnmatch import fnmatchcase, translate
from functools import cache
from importlib.abc import Loader, MetaPathFinder
from importlib.machinery import ModuleSpec
from importlib.util import spec_from_loader
from itertools import product
from pathlib import Path
from types import CodeType, FrameType, ModuleType
from typing import Any, NamedTuple

from cases import Case, all_cases, failure
from mutations import Mutant, mutants_of
from rich.console import Console
from rich.progress import Progress
from rich.table import Table

import zwidth

HERE = Path(__file__).parent
PACKAGE = "zwidth.checker"
ROOT = Path(zwidth.__file__).parent / "checker"
LEAST_SECONDS, TIMES_AS_LONG = 2, 20
"""Of the processor, before a case of a mutant counts as one that never ends."""
MOST_BYTES = 2 << 30
"""Beside what is loaded."""
COLUMNS = ("checker", "file", "line", "column", "change", "source", "outcome", "by", "seconds")
OUTCOMES = ("killed", "timed out", "equivalent", "alive")


class Source(NamedTuple):
    """One file of the checker."""

    name: str
    """As in `import`."""
    path: Path
    lines: list[str]
    tree: ast.Module
    code: CodeType

    @property
    def file(self) -> str:
        return str(self.path.relative_to(ROOT))


class Tried(NamedTuple):
    """A mutant and its place."""

    source: Source
    mutant: Mutant

    @property
    def key(self) -> tuple[str, ...]:
        m = self.mutant
        return self.source.file, str(m.line), str(m.column), m.change

    @property
    def text(self) -> str:
        return self.source.lines[self.mutant.line - 1].strip()


def sources() -> list[Source]:
    """Every file of the checker, wherever it stands."""
    found = []
    for path in sorted(ROOT.rglob("*.py")):
        parts = path.relative_to(ROOT).with_suffix("").parts
        name = ".".join((PACKAGE, *(p for p in parts if p != "__init__")))
        text = path.read_text(encoding="utf-8")
        tree = ast.parse(text)
        found.append(Source(name, path, text.splitlines(), tree, compile(tree, str(path), "exec")))
    return found


class _FromMemory(MetaPathFinder, Loader):
    """Imports the checker from code that is held here, the mutated file among it."""

    def __init__(self, held: Iterable[Source]) -> None:
        self.held = {source.name: source for source in held}

    def find_spec(self, name: str, path: Any, target: Any = None) -> ModuleSpec | None:
        source = self.held.get(name)
        if source is None:
            return None
        spec = spec_from_loader(name, self, is_package=source.path.name == "__init__.py")
        assert spec is not None
        spec.origin, spec.has_location = str(source.path), True
        return spec

    def exec_module(self, module: ModuleType) -> None:
        exec(self.held[module.__name__].code, vars(module))


def loaded_anew(held: Iterable[Source]) -> Any:
    """`verify` of a checker made of these sources."""
    for name in [name for name in sys.modules if name == PACKAGE or name.startswith(f"{PACKAGE}.")]:
        del sys.modules[name]
    sys.meta_path.insert(0, _FromMemory(held))
    return __import__(PACKAGE, fromlist=["verify"]).verify


class Reached(NamedTuple):
    """A case, how long it takes, and the lines it runs."""

    case: Case
    seconds: float
    lines: frozenset[tuple[str, int]]


def reached(cases: Sequence[Case], verify: Any) -> list[Reached]:
    """Every case run with the checker as it is, once for the lines and once for the time; the
    quickest first.

    Lines that are run once for each kind are those of its first case.
    """
    found = []
    for case in cases:
        with _lines_run() as lines:
            wrong = failure(case, verify)
        if wrong:
            raise SystemExit(f"{case.name}: {wrong}; the cases must hold before mistakes are looked for")
        start = time.perf_counter()
        failure(case, verify)
        seconds = time.perf_counter() - start
        found.append(Reached(case, seconds, frozenset(lines)))
    return sorted(found, key=lambda r: r.seconds)


@contextmanager
def _lines_run() -> Iterator[set[tuple[str, int]]]:
    """The lines of the checker that are run meanwhile."""
    lines: set[tuple[str, int]] = set()
    within = f"{ROOT}{os.sep}"

    def trace(frame: FrameType, event: str, _: Any) -> Any:
        if not frame.f_code.co_filename.startswith(within):
            return None
        lines.add((frame.f_code.co_filename, frame.f_lineno))
        return trace

    sys.settrace(trace)
    try:
        yield lines
    finally:
        sys.settrace(None)


def to_be_run(tried: Tried, cases: Sequence[Reached], at_load: Set[tuple[str, int]]) -> list[Reached]:
    """The cases that a mutant may change: all, where its line is run when the checker is loaded."""
    first, last = _extent(tried)
    at = str(tried.source.path)
    if tried.mutant.everywhere or any((at, line) in at_load for line in range(first, last + 1)):
        return list(cases)
    return [c for c in cases if any((at, line) in c.lines for line in range(first, last + 1))]


def _extent(tried: Tried) -> tuple[int, int]:
    """The lines of the statement that a mutant is in, without the blocks in it."""
    line, best = tried.mutant.line, (tried.mutant.line, tried.mutant.line)
    for node in ast.walk(tried.source.tree):
        if isinstance(node, ast.stmt) and node.lineno <= line <= (node.end_lineno or line):
            block = getattr(node, "body", None)
            last = block[0].lineno - 1 if block else node.end_lineno or line
            if node.lineno <= line <= max(last, node.lineno):
                best = (node.lineno, max(last, node.lineno))
    return best


def child(tried: Tried, all_sources: Sequence[Source], cases: Sequence[Reached], out: int) -> None:
    """In a process of its own: make the mistake, run the cases, tell the first that sees it."""
    signal.signal(signal.SIGVTALRM, signal.SIG_DFL)
    signal.setitimer(signal.ITIMER_VIRTUAL, LEAST_SECONDS)
    size = int(Path("/proc/self/statm").read_text(encoding="utf-8").split()[0]) * resource.getpagesize()
    resource.setrlimit(resource.RLIMIT_AS, (size + MOST_BYTES, size + MOST_BYTES))
    told = "alive"
    try:
        tried.mutant.make()
        code = compile(ast.fix_missing_locations(tried.source.tree), str(tried.source.path), "exec")
        changed = [s._replace(code=code) if s is tried.source else s for s in all_sources]
        verify = loaded_anew(changed)
        for c in cases:
            signal.setitimer(signal.ITIMER_VIRTUAL, max(LEAST_SECONDS, TIMES_AS_LONG * c.seconds))
            if wrong := failure(c.case, verify):
                told = f"{c.case.name}: {wrong}"
                break
    except BaseException as error:
        told = f"loading it: {type(error).__name__}"
    os.write(out, told.encode()[:2000])
    os._exit(0)


class Running(NamedTuple):
    """A mutant in its process."""

    tried: Tried
    pipe: int
    began: float
    cases: int


def run_all(
    mutants: Sequence[Tried],
    all_sources: Sequence[Source],
    cases: Sequence[Reached],
    at_load: Set[tuple[str, int]],
    processes: int,
) -> Iterator[tuple[Tried, str, str, float]]:
    """Each mutant, what became of it, by which case, and the seconds it took."""
    waiting, running = list(reversed(mutants)), dict[int, Running]()
    while waiting or running:
        while waiting and len(running) < processes:
            tried = waiting.pop()
            pid, started = _forked(tried, all_sources, to_be_run(tried, cases, at_load))
            running[pid] = started
        pid, status = os.wait()
        done = running.pop(pid)
        told = os.read(done.pipe, 4000).decode()
        os.close(done.pipe)
        yield done.tried, *_outcome(told, status, done.cases), time.perf_counter() - done.began


def _forked(tried: Tried, all_sources: Sequence[Source], cases: list[Reached]) -> tuple[int, Running]:
    back, out = os.pipe()
    began = time.perf_counter()
    pid = os.fork()
    if not pid:
        os.close(back)
        child(tried, all_sources, cases, out)
    os.close(out)
    return pid, Running(tried, back, began, len(cases))


def _outcome(told: str, status: int, cases: int) -> tuple[str, str]:
    if os.WIFSIGNALED(status):
        return "timed out", f"signal {os.WTERMSIG(status)}"
    if told == "alive":
        return "alive", "" if cases else "no case comes here"
    return "killed", told


class Equivalent(NamedTuple):
    """Mutants that prove nothing else, and why."""

    file: str
    source: str
    change: str
    reason: str

    def covers(self, named: tuple[str, str, str]) -> bool:
        said = (self.file, self.source, self.change)
        return all(_pattern(one).match(own) for own, one in zip(named, said, strict=True))


@cache
def _pattern(told: str) -> re.Pattern[str]:
    """Text in which a * stands for anything."""
    return re.compile(translate(told.replace("[", "[[]")))


def equivalents() -> list[Equivalent]:
    """What `equivalent.toml` lists: in file, source and change a * stands for anything."""
    with (HERE / "equivalent.toml").open("rb") as file:
        listed = tomllib.load(file).get("mutant", [])
    return [
        Equivalent(e["file"], source, change, e["reason"])
        for e in listed
        for source, change in product(_several(e["source"]), _several(e.get("change", "*")))
    ]


def _several(told: str | list[str]) -> list[str]:
    return [told] if isinstance(told, str) else told


def reason_for(named: tuple[str, str, str], excused: Sequence[Equivalent]) -> str:
    """Why a mutant of a file, source and change proves nothing else; "" if that is not known."""
    return next((e.reason for e in excused if e.covers(named)), "")


def digest(all_sources: Sequence[Source]) -> str:
    """Which checker a ledger is of."""
    text = "\n".join("\n".join((s.file, *s.lines)) for s in all_sources)
    return hashlib.sha256(text.encode()).hexdigest()[:12]


def read_ledger(path: Path, of: str) -> dict[tuple[str, ...], dict[str, str]]:
    """The rows of an earlier run with the same checker."""
    if not path.exists():
        return {}
    with path.open(newline="", encoding="utf-8") as file:
        rows = [row for row in csv.DictReader(file) if row["checker"] == of and row["outcome"] in OUTCOMES]
    return {(row["file"], row["line"], row["column"], row["change"]): row for row in rows}


def settled(rows: Mapping[tuple[str, ...], dict[str, str]], excused: Sequence[Equivalent]) -> dict[Any, Any]:
    """What need not be run again: all but those that lived and are not listed as equivalent."""
    found = {}
    for key, row in rows.items():
        if row["outcome"] in OUTCOMES[:2]:
            found[key] = row
        elif reason := reason_for((row["file"], row["source"], row["change"]), excused):
            found[key] = {**row, "outcome": "equivalent", "by": reason}
    return found


def write_ledger(path: Path, rows: Iterable[Mapping[str, str]]) -> None:
    """All rows anew, in the order of the sources."""
    with path.open("w", newline="", encoding="utf-8") as file:
        writer = csv.DictWriter(file, COLUMNS)
        writer.writeheader()
        writer.writerows(
            sorted(rows, key=lambda r: (r["file"], int(r["line"]), int(r["column"]), r["change"]))
        )


def main() -> int:
    """Exit code 0 if nothing lives that is not listed as equivalent."""
    options = _options()
    console = Console()
    all_sources = sources()
    mutants = [Tried(s, m) for s in all_sources for m in mutants_of(s.tree)]
    total = len(mutants)
    mutants = [m for m in mutants if fnmatchcase(m.source.file, options.only)]
    if options.sample < len(mutants):
        mutants = random.Random(options.seed).sample(mutants, options.sample)
    of = digest(all_sources)
    excused = equivalents()
    rows = settled(read_ledger(options.ledger, of), excused)
    for m in mutants:  # what is listed is not run
        if reason := reason_for((m.source.file, m.text, m.mutant.change), excused):
            told = dict(zip(COLUMNS, (of, *m.key, m.text, "equivalent", reason, "0"), strict=True))
            rows.setdefault(m.key, told)
    left = [m for m in mutants if m.key not in rows]
    console.print(f"{total} mutants of the checker, {len(mutants)} in the sample, {len(left)} to be run")
    with _lines_run() as at_load:
        verify = loaded_anew(all_sources)
    cases = reached(all_cases(), verify)
    console.print(f"{len(cases)} cases, {sum(c.seconds for c in cases):.1f} s")
    began = time.perf_counter()
    new = options.ledger.exists()
    with options.ledger.open("a", newline="", encoding="utf-8") as file, Progress(console=console) as bar:
        writer = csv.DictWriter(file, COLUMNS)
        if not new:
            writer.writeheader()
        task = bar.add_task("mutants", total=len(left))
        for tried, outcome, by, seconds in run_all(left, all_sources, cases, at_load, options.processes):
            entry = (of, *tried.key, tried.text, outcome, by, f"{seconds:.2f}")
            rows[tried.key] = dict(zip(COLUMNS, entry, strict=True))
            writer.writerow(rows[tried.key])
            file.flush()
            bar.advance(task)
    write_ledger(options.ledger, rows.values())
    mine = [rows[m.key] for m in mutants]
    _show(console, mine, len(left), time.perf_counter() - began)
    return int(any(row["outcome"] == "alive" for row in mine))


def _options() -> Any:
    parser = argparse.ArgumentParser(
        description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter
    )
    parser.add_argument("--sample", type=int, default=1500, help="so many mutants at most")
    parser.add_argument("--seed", type=int, default=1, help="which of them")
    parser.add_argument("--processes", type=int, default=2)
    parser.add_argument("--ledger", type=Path, default=Path("mutants.csv"))
    parser.add_argument("--only", default="*", help="files, as loop/*.py below the checker")
    return parser.parse_args()


def _show(console: Console, rows: Sequence[Mapping[str, str]], run: int, seconds: float) -> None:
    counts: dict[str, Counter[str]] = defaultdict(Counter)
    for row in rows:
        counts[row["file"]][row["outcome"]] += 1
    table = Table("file", *OUTCOMES)
    for file, count in sorted(counts.items()):
        table.add_row(file, *(str(count[o] or "") for o in OUTCOMES))
    table.add_row("all", *(str(sum(c[o] for c in counts.values())) for o in OUTCOMES))
    console.print(table)
    for row in rows:
        if row["outcome"] == "alive":
            told = (
                f"{row['file']}:{row['line']}: {row['change']}   [{row['by'] or 'alive'}]   {row['source']}"
            )
            console.print(told, markup=False, highlight=False, soft_wrap=True)
    if run:
        console.print(f"{seconds / run:.2f} s a mutant")


if __name__ == "__main__":
    sys.exit(main())
