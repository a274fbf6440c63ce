"""Something that is served on this machine while a loop runs, and ends."""

from __future__ import annotations

from collections.abc import Callable
from types import TracebackType

from zwidth.errors import InputError

HOST = "127.0.0.1"
"""Nobody on another machine is answered."""


class Page:
    """What is served, until `close`; ``with`` closes it as well.

    Parameters
    ----------
    address
        Where, such as "http://localhost:5006/".
    close
        Ends it.
    """

    def __init__(self, address: str, close: Callable[[], None]) -> None:
        self.address = address
        self._close: Callable[[], None] | None = close

    def close(self) -> None:
        """End it; may be called again."""
        close, self._close = self._close, None
        if close is not None:
            close()

    def __enter__(self) -> Page:
        return self

    def __exit__(
        self, kind: type[BaseException] | None, error: BaseException | None, trace: TracebackType | None
    ) -> None:
        self.close()


def checked_port(port: int) -> int:
    """A port that can be asked for, 0 for any that is free.

    Raises
    ------
    InputError
        If it is none.
    """
    if isinstance(port, bool) or not isinstance(port, int) or not 0 <= port <= 65535:
        raise InputError(
            f"{port!r} is no port: give a whole number from 1 to 65535, or 0 for one that is free"
        )
    return port
