"""What zwidth raises when a person's input cannot be used.

One class, so that a program can catch it and the command line can print it:
every message says what was given, the bound, why the physics wants it and
what to try.  Verdicts about nature are never exceptions.
"""

from __future__ import annotations

from zwidth.showing import printable


class InputError(ValueError):
    """A parameter, file or command that cannot be used as given."""

    def __init__(self, message: object = "") -> None:
        super().__init__(printable(str(message)))  # it may quote a file or its name
