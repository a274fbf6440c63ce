"""Datagrams between machines by Eclipse Zenoh: found by name, through routers, over whatever link there is.

Best effort, newest wins, dropped where the network is full: what a wave needs is to be
young, not to be complete.  Installed with ``pip install 'zwidth[networks]'``.
"""

from __future__ import annotations

import importlib
import json
from collections.abc import Sequence
from typing import Any

from zwidth.errors import InputError
from zwidth.machine.network.channel import Channel

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
        try:
            zenoh: Any = importlib.import_module("zenoh")
        except ImportError:
            raise InputError(
                "Eclipse Zenoh is not installed; pip install 'zwidth[networks]', or take UDP"
            ) from None
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
