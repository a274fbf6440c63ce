"""Channels over ports of this machine that nobody uses."""

from __future__ import annotations

import socket
import uuid

import pytest


def free_ports(count: int) -> list[int]:
    """So many, of UDP; each another."""
    sockets = [socket.socket(socket.AF_INET, socket.SOCK_DGRAM) for _ in range(count)]
    for one in sockets:
        one.bind(("127.0.0.1", 0))
    found = [one.getsockname()[1] for one in sockets]
    for one in sockets:
        one.close()
    return found


def udp() -> str:
    """A channel of both ends over UDP."""
    one, other = free_ports(2)
    return f"udp:127.0.0.1:{one},127.0.0.1:{other}"


def zenoh() -> str:
    """A channel over Zenoh; the test is left out where that is not installed."""
    pytest.importorskip("zenoh", reason="Eclipse Zenoh is not installed")
    return f"zenoh:test/{uuid.uuid4().hex},udp/127.0.0.1:{free_ports(1)[0]}"
