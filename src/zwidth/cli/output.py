"""Writing to the terminal, to pipes and to files, whatever their encoding and however they end."""

from __future__ import annotations

import codecs
import json
import os
import re
import sys
from collections.abc import Callable, Iterable, Iterator, Sequence
from contextlib import contextmanager
from dataclasses import replace
from importlib import import_module
from pathlib import Path
from typing import Any, TextIO
from unicodedata import combining, east_asian_width

from zwidth.errors import InputError
from zwidth.model.specification.table import plain
from zwidth.showing import OBEYED, Lines, Part, Table, printable
from zwidth.writing import check_target

Report = Callable[[], Iterable[Part] | None]
"""Gives the parts of a report, or prints it; what only a report takes is loaded by it."""


def printed(by: str, *told: object) -> Report:
    """What prints these, "pair.gains_report:print_held" of the command line, loaded when it does."""
    module, _, name = by.partition(":")
    return lambda: getattr(import_module(f"zwidth.cli.{module}"), name)(*told)


PICTURES = (".png", ".svg", ".pdf")

_ASCII = {
    "·": "*", "−": "-", "–": "-", "—": "-", "…": "...", "≥": ">=", "≤": "<=", "×": "x", "±": "+-",
    "²": "^2", "³": "^3", "°": "deg", "µ": "u", "μ": "mu", "Δ": "Delta", "Σ": "sum", "α": "alpha", "π": "pi",
    "β": "beta", "η": "eta", "λ": "lambda", "σ": "sigma", "τ": "tau", "ω": "omega", "∞": "inf",
    "“": '"', "”": '"', "’": "'", "✓": "+", "✗": "!", "→": "->",
}  # fmt: skip
"""How characters of this field are written where the terminal has ASCII only."""


def tolerate_encoding() -> None:
    """Let standard output and error spell out what their encoding lacks, instead of failing.

    A terminal of a session that asks for the locale C has ASCII, whatever Python writes to it.
    """
    codecs.register_error("zwidth", _spelled)
    for stream in (sys.stdout, sys.stderr):
        reconfigure = getattr(stream, "reconfigure", None)
        if reconfigure is not None:
            asked = next((v for name in ("LC_ALL", "LC_CTYPE", "LANG") if (v := os.environ.get(name))), "")
            only_ascii = asked in ("C", "POSIX") and stream.isatty()
            reconfigure(errors="zwidth", **({"encoding": "ascii"} if only_ascii else {}))


def spelled(text: str) -> str:
    """The text as standard output will show it: what its encoding lacks is spelled out."""
    encoding = getattr(sys.stdout, "encoding", None) or "utf-8"
    return text.encode(encoding, "zwidth").decode(encoding)


def _spelled(error: UnicodeError) -> tuple[str | bytes, int]:
    assert isinstance(error, UnicodeEncodeError)
    lost = error.object[error.start : error.end]
    return "".join(_ASCII.get(c) or _without_accents(c) for c in lost), error.end


def _without_accents(character: str) -> str:
    from unicodedata import normalize  # only for the few terminals that need it

    return normalize("NFKD", character).encode("ascii", "ignore").decode() or "?"


def encodes(text: str, stream: TextIO | None = None) -> bool:
    """True when the stream (by default standard output) can show the text as it is."""
    encoding = getattr(stream or sys.stdout, "encoding", None) or "utf-8"
    try:
        text.encode(encoding)
    except UnicodeEncodeError:
        return False
    return True


@contextmanager
def quiet_pipe(stream: TextIO | None = None) -> Iterator[None]:
    """Write inside, and do not complain when the reader, such as `head`, has left."""
    stream = stream or sys.stdout
    if stream is None:  # the process was started without it
        yield
        return
    try:
        yield
        stream.flush()
    except OSError as error:
        # What is buffered must not fail again when Python closes the stream.
        os.dup2(os.open(os.devnull, os.O_WRONLY), stream.fileno())
        if not isinstance(error, BrokenPipeError):
            raise InputError(f"the output cannot be written: {error.strerror or error}") from None


def print_text(text: object) -> None:
    """Print what may hold text of others, in lines that fit the terminal, which obeys none of it."""
    _print_lines(wrapped(spelled(printable(str(text))), columns()))


def print_report(parts: Iterable[Part]) -> None:
    """Print what a result says of itself, in lines that fit the terminal, which obeys none of it."""
    _print_lines(fitted(parts, columns(), lambda text: spelled(printable(text))))


def _print_lines(lines: Iterable[str]) -> None:
    """All at once: several processes may write to one terminal."""
    with quiet_pipe():
        print("\n".join(line.rstrip() for line in lines))


def print_message(message: object, command: str = "") -> None:
    """A message of this program on standard error, in lines that fit; a command in one, to be copied."""
    lines = [*message_lines(f"zwidth: {message}"), *[f"  {spelled(command)}"] * bool(command)]
    with quiet_pipe(sys.stderr):
        print("\n".join(lines), file=sys.stderr)


def message_lines(text: str) -> list[str]:
    return [*wrapped(spelled(text), columns())]


def print_json(text: str) -> None:
    """Print JSON, which is UTF-8: for any other encoding in ASCII; escaped is what a terminal would obey."""
    text = OBEYED.sub(lambda found: f"\\u{ord(found[0]):04x}", text)
    if codecs.lookup(getattr(sys.stdout, "encoding", None) or "utf-8").name != "utf-8":
        text = "".join(c if c.isascii() else json.dumps(c)[1:-1] for c in text)
    with quiet_pipe():
        print(text)


def target(option: str, given: str | None, suffixes: Sequence[str], force: bool) -> Path | None:
    """The file of an option, checked before anything is computed; None where none was asked for."""
    if given is None:
        return None
    path = Path(given)
    if path.suffix.lower() not in suffixes:
        raise InputError(f"{option}: the file must end in {', '.join(suffixes)}, got {given!r}")
    check_target(path, force, "--force")
    return path


def targets(
    plot: str | None, save: str | None, force: bool, option: str = "--save"
) -> tuple[Path | None, Path | None]:
    """The files of --plot and --save, or what takes its place, checked before anything is computed."""
    picture = target("--plot", plot, PICTURES, force)
    document = None if save is None else Path(save)
    if document is None:
        return picture, None
    if picture == document:
        raise InputError(f"--plot and {option} name the same file")
    if document.suffix.lower() in PICTURES:
        raise InputError(
            f"{option}: {document.name!r} is the name of a picture, and what is saved is none; "
            "for a picture give --plot"
        )
    check_target(document, force, "--force")
    return picture, document


def say_written(*paths: Path | None) -> None:
    """Say on standard output which files were written; None for one that was not asked for."""
    with quiet_pipe():
        for path in paths:
            if path is not None:
                print(f"written: {plain(str(path), 200)}")


def give_out(
    found: Any,
    save: Path | None,
    plot: Path | None,
    as_json: bool,
    report: Report | None = None,
    document: Callable[[], str] | None = None,
) -> None:
    """Save a result and its picture where that was asked for, and tell it.

    `report` and `document` stand in the place of its own.
    """
    if save is not None:
        found.save(save)
    if plot is not None:
        found.plot(plot)
    print_found(as_json, document or found.to_json, report or found.report, save, plot)


def print_found(as_json: bool, document: Callable[[], str], report: Report, *written: Path | None) -> None:
    """Print JSON; or the report, and say which files were written."""
    if as_json:
        print_json(document())
        return
    parts = report()
    if parts is not None:
        print_report(parts)
    say_written(*written)


PIPED, WIDEST, NARROWEST = 80, 100, 20
"""Columns without a terminal; the most that read well; the fewest into which words are put."""

GLUE = "\ue000"
"""Stands for a blank at which no line may break; whoever prints it puts the blank back."""

_BETWEEN = "  "
_MARK = re.compile(r"\s*([·*✓✗-]|\d+\.) ")


def columns() -> int:
    """The columns of a report: those of COLUMNS or of the terminal, at most 100; 80 without either."""
    return min(max(_there(), NARROWEST), WIDEST)


def _there() -> int:
    asked = os.environ.get("COLUMNS", "")
    if asked.isdecimal() and int(asked):
        return int(asked)
    if sys.stdout is None or not sys.stdout.isatty():
        return PIPED
    try:
        return os.get_terminal_size(sys.stdout.fileno()).columns or PIPED
    except (OSError, ValueError):  # it says that it is a terminal, and has no size
        return PIPED


def width_of(text: str) -> int:
    """The columns that a text takes: two for a wide character, none for an accent that stands on another."""
    return sum(0 if combining(c) else 2 if east_asian_width(c) in "WF" else 1 for c in text)


def wrapped(text: str, width: int) -> Iterator[str]:
    """The text in lines of at most `width` columns, broken at blanks; inside a word, or inside
    quotes, only where it must be.

    What belongs to an item of a list goes on under its own beginning.
    """
    for line in text.split("\n"):
        if width_of(line) <= width:
            yield line
        else:
            yield from _broken(line, width)


def _broken(line: str, width: int) -> Iterator[str]:
    so_far, blank = "", ""
    indent = line[: len(line) - len(line.lstrip())]
    mark = _MARK.match(line)
    hanging = " " * (len(mark[0]) if mark else len(indent))
    for word in _words(line, width - len(hanging)):
        joined = f"{so_far}{blank}{word}" if so_far else indent + word
        if width_of(joined) <= width:
            so_far, blank = joined, " "
            continue
        if so_far.strip():
            yield so_far
        so_far, blank = (hanging if so_far.strip() else indent) + word, " "
        while width_of(so_far) > width:
            head = _as_much_as_fits(so_far, width)
            yield head
            so_far = hanging + so_far[len(head) :]
    yield so_far


_QUOTED = r"""(?<!\w)'[^'\s][^']*'(?!\w)|(?<!\w)"[^"\s][^"]*"(?!\w)"""
_WORD = re.compile(rf"(?:{_QUOTED}|\S)+")


def _words(line: str, width: int) -> Iterator[str]:
    """What stands between blanks, and what is quoted in one piece where it fits into a line."""
    for found in _WORD.finditer(line):
        yield from [found[0]] if width_of(found[0]) <= width else found[0].split()


def _as_much_as_fits(text: str, width: int) -> str:
    """At least one character more than blanks, else it would never end."""
    length = next((n for n in range(len(text)) if width_of(text[: n + 1]) > width), len(text))
    return text[: max(length, len(text) - len(text.lstrip()) + 1)]


def fitted(parts: Iterable[Part], width: int, spelled: Callable[[str], str] = str) -> Iterator[str]:
    """The parts of a report, line by line, in so many columns; each text as it will be shown."""
    for part in parts:
        if isinstance(part, Table):
            if part.caption:
                yield from (*wrapped(spelled(part.caption), width), "")
            heads, rows = ([[*map(spelled, cells)] for cells in lines] for lines in (part.heads, part.rows))
            yield from _table_lines(replace(part, heads=heads, rows=rows), width)
        elif isinstance(part, Lines):
            for item in part.items:
                yield from wrapped(spelled(f"{part.mark} {item}"), width)
        else:
            yield from wrapped(spelled(str(part)), width)


def _table_lines(table: Table, width: int) -> Iterator[str]:
    """As it is where it fits; else names with texts that break, or several tables below each other."""
    sizes = [max(map(width_of, column)) for column in zip(*table.heads, *table.rows, strict=True)]
    if sum(sizes) + len(_BETWEEN) * (len(sizes) - 1) <= width:
        yield from _set(table, sizes)
    elif len(sizes) == 2 and not table.heads:
        yield from _names_with_texts(table.rows, min(sizes[0], width // 2), width)
    else:
        yield from _stacked(table, sizes, width)


def _set(table: Table, sizes: Sequence[int]) -> Iterator[str]:
    lefts = len(sizes) if table.lefts is None else table.lefts
    for cells in (*table.heads, *table.rows):
        padded = (
            _padded(cell, size, place < lefts)
            for place, (cell, size) in enumerate(zip(cells, sizes, strict=True))
        )
        yield _BETWEEN.join(padded).rstrip()


def _padded(cell: str, size: int, left: bool) -> str:
    blanks = " " * (size - width_of(cell))
    return cell + blanks if left else blanks + cell


def _names_with_texts(rows: Sequence[Sequence[str]], size: int, width: int) -> Iterator[str]:
    for name, text in rows:
        names = list(wrapped(name, size))
        texts = list(wrapped(text, max(width - size - len(_BETWEEN), 1)))
        for place in range(max(len(names), len(texts))):
            left = names[place] if place < len(names) else ""
            right = texts[place] if place < len(texts) else ""
            yield f"{_padded(left, size, True)}{_BETWEEN}{right}".rstrip()


def _stacked(table: Table, sizes: Sequence[int], width: int) -> Iterator[str]:
    """As many columns at a time as fit beside the first, which names the rows of each of the tables."""
    first, rest = [0], list(range(1, len(sizes)))
    while rest:
        taken = [rest.pop(0)]
        while rest and _together(sizes, [*first, *taken, rest[0]]) <= width:
            taken.append(rest.pop(0))
        places = [*first, *taken]
        if _together(sizes, places) > width:  # a column wider than the page: a line for each of its cells
            yield from _one_by_one(table, taken[0], width)
        else:
            lefts = sum(place < (len(sizes) if table.lefts is None else table.lefts) for place in places)
            heads, rows = (
                [[cells[p] for p in places] for cells in part] for part in (table.heads, table.rows)
            )
            yield from _set(Table(rows=rows, heads=heads, lefts=lefts), [sizes[p] for p in places])
        if rest:
            yield ""


def _together(sizes: Sequence[int], places: Sequence[int]) -> int:
    return sum(sizes[p] for p in places) + len(_BETWEEN) * (len(places) - 1)


def _one_by_one(table: Table, place: int, width: int) -> Iterator[str]:
    for cells in (*table.heads, *table.rows):
        text = f"{cells[0]}: {cells[place]}".strip(": ")
        if text:
            yield from wrapped(text, width)
