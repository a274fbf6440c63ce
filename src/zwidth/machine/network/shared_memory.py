"""Datagrams between two processes of one machine, through memory that both see.

Two rings of places, one for each direction.  Each has one writer and one reader, who never wait for each
other: the writer numbers its places, the reader follows the numbers.  A place that is written while it
is read may come out mixed; the number beside it is read again afterwards and what changed is dropped, and
a frame that is mixed all the same fails its checksum.  A reader that is a whole ring behind loses the oldest.
"""

from __future__ import annotations

import mmap
import os
import stat
import tempfile
from contextlib import suppress
from pathlib import Path

from zwidth.errors import InputError
from zwidth.machine.network.channel import LARGEST, Channel

try:
    import fcntl
except ImportError:  # not on Windows
    fcntl = None  # type: ignore[assignment]

_RING_LENGTH = 256
_WORD = 8  # bytes; what is written at once
_PLACE = 2 + LARGEST // _WORD  # words: the number of the datagram, from 1; its length; itself
_RING = 1 + _RING_LENGTH * _PLACE  # words: the newest number; the places
_SIZE = 2 * _RING * _WORD
_OURS = 0o600
_FLAGS = os.O_RDWR | getattr(os, "O_NOFOLLOW", 0) | getattr(os, "O_BINARY", 0)


class SharedMemory(Channel):
    """Two ends of a piece of memory with a name, readable by this user alone.

    Parameters
    ----------
    name
        Letters, digits, "-" and "_"; both sides give the same.
    first
        True at the side that makes it and takes it away, False at the other.

    Raises
    ------
    InputError
        If the name holds anything else, the memory is in use already or not this user's alone, or for the
        second side not there yet.
    """

    def __init__(self, name: str, first: bool) -> None:
        self._path = _place(name)
        self._first = first
        self._file = _made(self._path, name) if first else _found(self._path, name)
        self._memory = mmap.mmap(self._file, _SIZE)
        if first:
            self._memory[:] = bytes(_SIZE)
        self._words = memoryview(self._memory).cast("Q")  # a word is written at once, not byte by byte
        self._out, self._in = (0, _RING) if first else (_RING, 0)
        self._sent = self._words[self._out]
        self._taken = self._words[self._in]

    def send(self, datagram: bytes) -> None:
        """Write it into the next place; the oldest there is lost."""
        if len(datagram) > LARGEST:
            return
        number = self._sent + 1
        at = self._out + 1 + number % _RING_LENGTH * _PLACE
        self._words[at] = 0  # no number: being written
        self._words[at + 1] = len(datagram)
        start = (at + 2) * _WORD
        self._memory[start : start + len(datagram)] = datagram
        self._words[at] = number
        self._words[self._out] = number
        self._sent = number

    def receive(self) -> list[bytes]:
        """What was written since the last call, a ring of 256 at most."""
        newest = self._words[self._in]
        found: list[bytes] = []
        for number in range(max(self._taken, newest - _RING_LENGTH) + 1, newest + 1):
            at = self._in + 1 + number % _RING_LENGTH * _PLACE
            if self._words[at] == number:
                start = (at + 2) * _WORD
                datagram = self._memory[start : start + min(self._words[at + 1], LARGEST)]
                if self._words[at] == number:
                    found.append(datagram)
        self._taken = newest
        return found

    def close(self) -> None:
        """Let go of the memory; the first side takes it away."""
        if self._memory.closed:
            return
        self._words.release()
        self._memory.close()
        os.close(self._file)
        if self._first:
            with suppress(OSError):
                self._path.unlink()


def _place(name: str) -> Path:
    if not name or not name.replace("-", "").replace("_", "").isalnum():
        raise InputError(
            f"the name of shared memory must be of letters, digits, - and _, such as left-arm, got {name!r}"
        )
    memory = Path("/dev/shm")
    return (memory if memory.is_dir() else Path(tempfile.gettempdir())) / f"zwidth-{name}"


def _made(path: Path, name: str) -> int:
    """New, or what one that was killed has left: that is not locked any more."""
    try:
        try:
            file = os.open(path, _FLAGS | os.O_CREAT | os.O_EXCL, _OURS)
        except FileExistsError:
            file = _ours(path, name)
        if fcntl is not None:
            fcntl.flock(file, fcntl.LOCK_EX | fcntl.LOCK_NB)
        os.truncate(file, _SIZE)
    except OSError as error:
        raise InputError(
            f"the shared memory {name!r} cannot be made: {error.strerror}; another process may use it: "
            "take another name"
        ) from None
    return file


def _found(path: Path, name: str) -> int:
    try:
        file = _ours(path, name)
    except OSError as error:
        raise InputError(
            f"there is no shared memory {name!r} to be opened: {error.strerror}; "
            "start the first side, which makes it, before this one"
        ) from None
    if os.fstat(file).st_size != _SIZE:
        os.close(file)
        raise InputError(f"the shared memory {name!r} is not ready; start the first side before this one")
    return file


def _ours(path: Path, name: str) -> int:
    """A file that is there already, if it is this user's and nobody else reads or writes it."""
    file = os.open(path, _FLAGS)
    found = os.fstat(file)  # of what was opened, whatever lies there now
    faults = {
        "is no file": not stat.S_ISREG(found.st_mode),
        "belongs to another user": hasattr(os, "getuid") and found.st_uid != os.getuid(),
        "is open to other users": os.name == "posix" and found.st_mode & 0o077 != 0,
        "has a second name": found.st_nlink > 1,
    }
    fault = next((said for said, so in faults.items() if so), None)
    if fault is not None:
        os.close(file)
        raise InputError(
            f"the shared memory {name!r} is not used: {path} {fault}, and what it holds would not be this "
            "user's alone; take another name, or remove that file"
        )
    return file
