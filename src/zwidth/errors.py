"""What zwidth raises when a person's input cannot be used.

One class, so that a program can catch it and the command line can print it: every message says what was
given, the bound, why the physics wants it and what to try.  Verdicts about nature are never exceptions.
"""

from __future__ import annotations

from zwidth.showing import printable


class InputError(ValueError):
    """A parameter, file or command that cannot be used as given; `command` is what to type first."""

    def __init__(self, message: object = "", command: str = "") -> None:
        said = f"{message}: {command}" if command else str(message)
        super().__init__(printable(said))  # it may quote a file or its name
        self.command = printable(command)
