"""Channels of three kinds, and the one that a line of text names, as an option or a file gives it.

udp:LOCAL,REMOTE       udp:127.0.0.1:7401,127.0.0.1:7402
memory:NAME            on one machine; the first side makes it
zenoh:NAME             found by multicast; or zenoh:NAME,ENDPOINT, where the first side listens
"""

from __future__ import annotations

import json
import mmap
import os
import socket
import stat
import tempfile
import time
from collections.abc import Sequence
from contextlib import suppress
from pathlib import Path

from zwidth import installing
from zwidth.errors import InputError
from zwidth.machine.network.channel import LARGEST, Channel
from zwidth.quantity.exact import RealLike
from zwidth.quantity.parameter import read_number

_FORMS = (
    "udp:LOCAL,REMOTE such as udp:127.0.0.1:7401,127.0.0.1:7402; memory:NAME; "
    "or zenoh:NAME, perhaps with ,udp/192.168.0.7:7447, where the first side listens"
)


def open_channel(text: str, first: bool, *, wait: RealLike = 0.0) -> Channel:
    """The channel that a text names; `first` at one side, not at the other.

    Shared memory that is not there yet is waited for, `wait` seconds at most.

    Raises
    ------
    InputError
        If the text names none, or the channel cannot be opened.
    """
    kind, _, rest = text.partition(":")
    parts = [part.strip() for part in rest.split(",")]
    if kind == "udp" and len(parts) == 2:
        local, remote = parts if first else reversed(parts)
        return UDP(local, remote)
    if kind == "memory" and len(parts) == 1 and parts[0]:
        return _memory(parts[0], first, time.monotonic() + float(read_number(wait, "delay", "wait")))
    if kind == "zenoh" and all(parts):
        ends = parts[1:]
        return Zenoh(parts[0], first, listen=ends if first else (), connect=() if first else ends)
    raise InputError(f"no channel is called {text!r}; give {_FORMS}")


def _memory(name: str, first: bool, until: float) -> SharedMemory:
    while True:
        try:
            return SharedMemory(name, first)
        except InputError:
            if first or time.monotonic() >= until:
                raise
        time.sleep(0.05)


_AT_ONCE = 256
"""Datagrams taken at one call: a flood from the other side must not hold up the loop."""


class UDP(Channel):
    """From one address to one other; datagrams of anybody else are not read.

    Parameters
    ----------
    local
        Where to listen, "host:port" or ":port" for every interface of this machine.
    remote
        The other side, "host:port".

    Raises
    ------
    InputError
        If an address is none, not this machine's, or already taken.
    """

    def __init__(self, local: str, remote: str) -> None:
        here, there = _address(local, "local"), _address(remote, "remote")
        self._socket = socket.socket(socket.AF_INET, socket.SOCK_DGRAM)
        self._socket.setblocking(False)
        try:
            self._socket.bind(here)
            self._socket.connect(there)
        except OSError as error:
            self._socket.close()
            raise InputError(
                f"from {local} to {remote} nothing can be sent: {error.strerror}; "
                "give an address of this machine whose port is free, and one that can be reached"
            ) from None

    @property
    def local(self) -> str:
        """The address of this side, with the port that the system chose where 0 was asked for."""
        host, port = self._socket.getsockname()
        return f"{host}:{port}"

    def send(self, datagram: bytes) -> None:
        """Give it to the system; what it cannot take now is lost."""
        try:
            self._socket.send(datagram)
        except OSError:  # nobody listens there yet, or no longer, or the buffer is full: one more loss
            return

    def receive(self) -> list[bytes]:
        """What has arrived, 256 datagrams at most."""
        found: list[bytes] = []
        for _ in range(_AT_ONCE):
            try:
                found.append(self._socket.recv(LARGEST + 1))
            except BlockingIOError:
                break
            except OSError:  # the system reports here that an earlier datagram found nobody
                continue
        return found

    def close(self) -> None:
        """Give the port back."""
        self._socket.close()


def _address(text: str, name: str) -> tuple[str, int]:
    host, colon, port = text.rpartition(":")
    if not colon or not port.isdecimal() or int(port) > 65535:
        raise InputError(
            f"the {name} address must be host:port with a port from 0 to 65535, "
            f"such as 127.0.0.1:7401, got {text!r}"
        )
    try:
        return socket.getaddrinfo(host or "0.0.0.0", int(port), socket.AF_INET, socket.SOCK_DGRAM)[0][4]  # type: ignore[return-value]
    except OSError as error:
        raise InputError(f"the {name} address {text!r} is not known here: {error.strerror}") from None


_WAITING = 256


class Zenoh(Channel):
    """Two ends of a name: each publishes what the other subscribes to.

    Parameters
    ----------
    name
        Of the line, a Zenoh key such as "room/left-arm"; both sides give the same.
    first
        True at one side, False at the other.
    listen, connect
        Endpoints such as "udp/0.0.0.0:7447" and "udp/192.168.0.7:7447"; with neither the two sides find
        each other by multicast in the same network.

    Raises
    ------
    InputError
        If Zenoh is not installed, or refuses the name or an endpoint.
    """

    def __init__(
        self, name: str, first: bool, *, listen: Sequence[str] = (), connect: Sequence[str] = ()
    ) -> None:
        zenoh = installing.imported("zenoh", "Eclipse Zenoh", "networks", "take UDP")
        config = zenoh.Config()
        config.insert_json5("mode", '"peer"')
        if listen or connect:
            config.insert_json5("scouting/multicast/enabled", "false")
            config.insert_json5("listen/endpoints", json.dumps(list(listen)))
            config.insert_json5("connect/endpoints", json.dumps(list(connect)))
        out, back = ("there", "back") if first else ("back", "there")
        try:
            self._session = zenoh.open(config)
            self._publisher = self._session.declare_publisher(
                f"{name}/{out}",
                congestion_control=zenoh.CongestionControl.DROP,
                reliability=zenoh.Reliability.BEST_EFFORT,
                express=True,
            )
            self._subscriber = self._session.declare_subscriber(
                f"{name}/{back}", zenoh.handlers.RingChannel(_WAITING)
            )
        except zenoh.ZError as error:
            raise InputError(f"Zenoh refuses {name!r}: {_reason(error)}") from None

    def send(self, datagram: bytes) -> None:
        """Publish it; dropped where the network is full."""
        self._publisher.put(datagram)

    def receive(self) -> list[bytes]:
        """What has arrived, the newest 256 at most."""
        found: list[bytes] = []
        while (sample := self._subscriber.try_recv()) is not None:
            found.append(bytes(sample.payload))
        return found

    def close(self) -> None:
        """Leave the network."""
        if not self._session.is_closed():
            self._session.close()


def _reason(error: Exception) -> str:
    """What went wrong, without where in Zenoh's own sources."""
    return str(error).splitlines()[0].partition(" at /")[0].partition(": [")[0]


# Memory that both see: two rings of places, one for each direction.  Each has one writer and one reader,
# who never wait for each other: the writer numbers its places, the reader follows the numbers.  A place
# that is written while it is read may come out mixed; the number beside it is read again afterwards and
# what changed is dropped, and a frame that is mixed all the same fails its checksum.  A reader that is a
# whole ring behind loses the oldest.


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
