"""A file is written whole or not at all.

It is written beside its place under a name that nobody can guess, which no file has yet, and put
in its place when it is whole: a full disk or a Ctrl-C leaves neither half a file nor the loss of an
old one, and nobody else who may write to the folder can lay a link where the new file begins.

A link stays a link: the file that it names is replaced, in its own folder.  The new file has the
permissions that the umask gives, none more than the file that it replaces; a file that may
not be written is not replaced either.
"""

from __future__ import annotations

import csv
import os
import secrets
import stat
from collections.abc import Iterable, Iterator
from contextlib import contextmanager, suppress
from pathlib import Path
from types import SimpleNamespace
from typing import IO

from zwidth.errors import InputError
from zwidth.installing import parquet

try:
    import fcntl
except ImportError:  # not on Windows
    fcntl = None  # type: ignore[assignment]

_NEW = os.O_WRONLY | os.O_CREAT | os.O_EXCL | getattr(os, "O_NOFOLLOW", 0) | getattr(os, "O_BINARY", 0)
_OURS = 0o600
_ANYBODY = 0o666
"""Permissions of a new file before the umask."""


def check_target(path: Path, force: bool, how: str = "force=True") -> None:
    """Refuse a place where nothing can be written, or a file would be lost, before anything is computed."""
    if path.suffix.lower() == ".parquet":
        parquet(f"{path} is not written")
    try:
        if b"\0" in os.fsencode(path):
            raise InputError(f"{path} cannot be written: a name has no zero bytes")
        if path.is_dir():
            raise InputError(f"{path} is a directory; name a file")
        if os.path.lexists(path) and not force:  # a link that leads nowhere is there too
            raise InputError(f"{path} exists; choose another name, or give {how} to replace it")
        place = Path(os.path.realpath(path))
        if not place.parent.is_dir():
            raise InputError(f"{path} cannot be written: there is no directory {place.parent}")
        there = place.exists()
        if there and not os.access(place, os.W_OK):
            raise InputError(f"{path} cannot be written: it is protected against that")
        if (place.is_file() or not there) and not os.access(place.parent, os.W_OK | os.X_OK):
            raise InputError(f"{path} cannot be written: nothing may be put into {place.parent}")
    except (OSError, ValueError) as error:
        if isinstance(error, InputError):
            raise
        raise InputError(f"{path} cannot be written: {_reason(error)}") from None


@contextmanager
def writing_whole(path: Path) -> Iterator[IO[bytes]]:
    """A file to write to; at the end it takes the place of `path`, or of the file that a link names.

    What exists and is no file, such as /dev/null, keeps its place and is written itself.
    """
    try:
        with _opened(path) as file:
            yield file
    except OSError as error:
        raise InputError(f"{path} cannot be written: {_reason(error)}; nothing was changed there") from None


@contextmanager
def _opened(path: Path) -> Iterator[IO[bytes]]:
    try:
        old = os.open(path, os.O_WRONLY)  # the system says whether this link and this file may be written
    except FileNotFoundError:
        mode = _ANYBODY
    except ValueError as error:  # a name that no file can have
        raise InputError(f"{path} cannot be written: {error}") from None
    else:
        with open(old, "wb") as there:
            mode = os.fstat(old).st_mode
            if not stat.S_ISREG(mode):
                yield there
                return
    with _replacing(Path(os.path.realpath(path)), mode & _ANYBODY) as file:
        yield file


@contextmanager
def _replacing(place: Path, mode: int) -> Iterator[IO[bytes]]:
    unfinished = place.with_name(f".zwidth-{secrets.token_hex(16)}.part")
    with open(os.open(unfinished, _NEW, mode), "wb") as file:
        try:
            yield file
            file.flush()
            os.fsync(file.fileno())  # a full disk may show only here
            file.close()
            os.replace(unfinished, place)
        except BaseException:
            _abandoned(file, unfinished)
            raise


def _abandoned(file: IO[bytes], unfinished: Path) -> None:
    """Leave nothing of what was begun; what is still to be written may fail as what was."""
    with suppress(OSError):
        file.close()
    with suppress(OSError):
        unfinished.unlink()


_OBEYED = ("=", "+", "-", "@", "\t", "\r", "\n", "＝", "＋", "－", "＠")
"""With which a spreadsheet takes a text for a formula, or cuts off what stands before one."""


def csv_text(rows: Iterable[Iterable[object]]) -> str:
    """Rows as CSV, in which a spreadsheet takes no text for a formula: such a one begins with an apostrophe.

    A number stays one, also as a text.  `csv_cell` takes the apostrophe away again.
    """
    written: list[str] = []
    lines = csv.writer(SimpleNamespace(write=written.append))  # its own line end: both signs of it are quoted
    for row in rows:
        lines.writerow(f"'{cell}" if isinstance(cell, str) and _is_formula(cell) else cell for cell in row)
    return "".join(line.removesuffix("\r\n") + "\n" for line in written)


def csv_cell(text: str) -> str:
    """What was written there by `csv_text`."""
    return text[1:] if text.startswith("'") and _is_formula(text[1:]) else text


def _is_formula(text: str) -> bool:
    """True of what may be taken for one, behind apostrophes or not."""
    try:
        float(text)
    except ValueError:
        return text.lstrip("'").startswith(_OBEYED)
    return False


@contextmanager
def alone(path: Path) -> Iterator[None]:
    """What grows at `path` grows by one process at a time; the lock of one that is killed is forgotten."""
    if path.is_symlink() and not path.exists():
        raise InputError(f"{path} is a link that leads nowhere; choose another name or remove it first")
    lock = path.with_name(f".{path.name}.lock")
    try:
        held = _locked(lock)
    except (BlockingIOError, FileExistsError, PermissionError) as error:
        if isinstance(error, PermissionError) and os.name == "posix":
            raise InputError(f"{path} cannot be written: {error.strerror}") from None
        raise InputError(
            f"{path} is being written by another process: wait until that has ended, and the same command "
            "goes on with what is there; or choose another name"
        ) from None
    except OSError as error:
        raise InputError(f"{path} cannot be written: {error.strerror}") from None
    try:
        yield
    finally:
        if fcntl is not None:
            with suppress(OSError):
                lock.unlink()
        os.close(held)


def _locked(lock: Path) -> int:
    if fcntl is None:  # Windows takes such a file away with the process
        return os.open(lock, _NEW | getattr(os, "O_TEMPORARY", 0), _OURS)
    while True:
        held = os.open(lock, os.O_RDWR | os.O_CREAT | os.O_NOFOLLOW, _OURS)
        try:
            fcntl.flock(held, fcntl.LOCK_EX | fcntl.LOCK_NB)
            if os.path.samestat(os.fstat(held), lock.lstat()):
                return held
        except FileNotFoundError:
            pass  # who had it has just taken it away: once more
        except BaseException:
            os.close(held)
            raise
        os.close(held)


def _reason(error: Exception) -> str:
    return getattr(error, "strerror", None) or first_line(error)


def first_line(error: BaseException) -> str:
    """What an exception says, in a line."""
    return (str(error) or type(error).__name__).splitlines()[0][:200]
