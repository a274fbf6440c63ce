"""A file is written whole or not at all.

It is written beside its place under another name and put there when it is whole: a full disk
or a Ctrl-C leaves neither half a file nor the loss of an old one.
"""

from __future__ import annotations

import os
from collections.abc import Iterator
from contextlib import contextmanager, suppress
from pathlib import Path

from zwidth.errors import InputError


def check_target(path: Path, force: bool) -> None:
    """Refuse a place where nothing can be written, or a file would be lost.

    Raises
    ------
    InputError
        If so.
    """
    if path.is_dir():
        raise InputError(f"{path} is a directory; name a file")
    if path.exists() and not force:
        raise InputError(f"{path} exists; choose another name, or give force=True to replace it")
    if not path.parent.is_dir():
        raise InputError(f"{path} cannot be written: there is no directory {path.parent}")


@contextmanager
def writing_whole(path: Path) -> Iterator[Path]:
    """A name to write to; what is there at the end takes the place of `path`, of the file that a link names.

    What exists and is no file, such as /dev/null, keeps its place and is written itself.

    Raises
    ------
    InputError
        If writing fails for a reason of the disk; nothing is then left behind.
    """
    try:
        place = Path(os.path.realpath(path))
    except ValueError as error:  # a name that no file can have
        raise InputError(f"{path} cannot be written: {error}") from None
    device = place.exists() and not place.is_file()
    unfinished = place if device else place.with_name(f".{place.name}.{os.getpid()}.part")
    try:
        yield unfinished
        if device:
            return
        with open(unfinished, "rb+") as file:
            os.fsync(file.fileno())  # a full disk may show only here
        os.replace(unfinished, place)
    except OSError as error:
        reason = error.strerror or first_line(error)
        raise InputError(f"{path} cannot be written: {reason}; nothing was left there") from None
    finally:
        if not device:
            with suppress(OSError):
                unfinished.unlink()


def first_line(error: BaseException) -> str:
    """What an exception says, in a line."""
    return (str(error) or type(error).__name__).splitlines()[0][:200]
