"""What a recorder asks of a loop: what live graphs ask, and what a file says besides."""

from __future__ import annotations

from typing import Any, Protocol

from zwidth.machine.servo.live.rows import Rows


class LoopRows(Rows, Protocol):
    """The rows of a loop, such as `servo.ring.Rows`, with what is known of it."""

    @property
    def about(self) -> dict[str, Any]:
        """What a file says of it, as JSON has it."""

    @property
    def events(self) -> list[dict[str, Any]]:
        """What happened so far."""
