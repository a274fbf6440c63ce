"""What carries datagrams between two processes.

A channel may lose, delay, double and reorder what it is given; it never waits, and it never
fails because the other side is not there yet, or no longer.  The waves that cross it
bear all of that without creating energy, so nothing is sent twice and nothing is waited for.
"""

from __future__ import annotations

from abc import ABC, abstractmethod
from types import TracebackType
from typing import Self

LARGEST = 1400
"""Bytes of a datagram that pass every usual network in one piece."""


class Channel(ABC):
    """Both directions between two ends; closed by `close` or at the end of a ``with``."""

    @abstractmethod
    def send(self, datagram: bytes) -> None:
        """Give one datagram on its way; it may be lost."""

    @abstractmethod
    def receive(self) -> list[bytes]:
        """What has arrived since the last call, in the order of arrival; empty where nothing has."""

    @abstractmethod
    def close(self) -> None:
        """Give back what the system lent; a second time does nothing."""

    def __enter__(self) -> Self:
        return self

    def __exit__(
        self, kind: type[BaseException] | None, error: BaseException | None, trace: TracebackType | None
    ) -> None:
        self.close()
