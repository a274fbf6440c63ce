"""Datagrams between two addresses of a network, as the system sends them (UDP)."""

from __future__ import annotations

import socket

from zwidth.errors import InputError
from zwidth.machine.network.channel import LARGEST, Channel

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
