"""Writing to the terminal, to pipes and to files, whatever their encoding and however they end."""

from __future__ import annotations

import codecs
import json
import os
import sys
from collections.abc import Iterable, Iterator, Sequence
from contextlib import contextmanager
from pathlib import Path
from typing import Any, TextIO

from zwidth.cli.width import columns, fitted, wrapped
from zwidth.errors import InputError
from zwidth.model.specification.table import plain
from zwidth.showing import OBEYED, Part, printable
from zwidth.writing import check_target

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
            only_ascii = _asks_for_c() and stream.isatty()
            reconfigure(errors="zwidth", **({"encoding": "ascii"} if only_ascii else {}))


def _asks_for_c() -> bool:
    """True where the environment sets the locale of characters to C."""
    asked = next((v for name in ("LC_ALL", "LC_CTYPE", "LANG") if (v := os.environ.get(name))), "")
    return asked in ("C", "POSIX")


def spelled(text: str) -> str:
    """The text as standard output will show it: what its encoding lacks is spelled out."""
    if encodes(text):
        return text
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
            raise InputError(f"the output cannot be written: {_reason(error)}") from None


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


def print_message(message: object) -> None:
    """A message of this program on standard error, in lines that fit the terminal."""
    with quiet_pipe(sys.stderr):
        print("\n".join(message_lines(f"zwidth: {message}")), file=sys.stderr)


def message_lines(text: str) -> list[str]:
    """A message as it is broken into lines."""
    return [*wrapped(spelled(text), columns())]


def print_json(text: str) -> None:
    """Print JSON; escaped is what a terminal would obey, and what the encoding lacks."""
    text = OBEYED.sub(lambda found: f"\\u{ord(found[0]):04x}", text)
    if not encodes(text):
        text = "".join(c if c.isascii() else json.dumps(c)[1:-1] for c in text)
    with quiet_pipe():
        print(text)


def check_new(path: Path, force: bool) -> None:
    """Refuse a path that cannot be written, or where a file would be lost."""
    check_target(path, force, "--force")


def target(option: str, given: str | None, suffixes: Sequence[str], force: bool) -> Path | None:
    """The file of an option, checked before anything is computed; None where none was asked for."""
    if given is None:
        return None
    path = Path(given)
    if path.suffix.lower() not in suffixes:
        raise InputError(f"{option}: the file must end in {', '.join(suffixes)}, got {given!r}")
    check_new(path, force)
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
    check_new(document, force)
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
    in_short: Iterable[Part] | None = None,
) -> None:
    """Save a result and its picture where that was asked for, print it, and say what was written.

    `in_short` is what is printed in the place of its whole report.
    """
    if save is not None:
        found.save(save)
    if plot is not None:
        found.plot(plot)
    if as_json:
        print_json(found.to_json())
    else:
        print_report(found.report() if in_short is None else in_short)
        say_written(save, plot)


def _reason(error: Exception) -> str:
    return getattr(error, "strerror", None) or str(error)
