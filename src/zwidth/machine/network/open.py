"""A channel from one line of text, as an option or a file gives it.

udp:LOCAL,REMOTE       udp:127.0.0.1:7401,127.0.0.1:7402
memory:NAME            on one machine; the first side makes it
zenoh:NAME             found by multicast; or zenoh:NAME,ENDPOINT, where the first side listens
"""

from __future__ import annotations

import time

from zwidth.errors import InputError
from zwidth.machine.network.channel import Channel
from zwidth.machine.network.shared_memory import SharedMemory
from zwidth.machine.network.udp import UDP
from zwidth.machine.network.zenoh import Zenoh

_FORMS = (
    "udp:LOCAL,REMOTE such as udp:127.0.0.1:7401,127.0.0.1:7402; memory:NAME; "
    "or zenoh:NAME, perhaps with ,udp/192.168.0.7:7447, where the first side listens"
)


def open_channel(text: str, first: bool, *, wait: float = 0.0) -> Channel:
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
        return _memory(parts[0], first, time.monotonic() + wait)
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
