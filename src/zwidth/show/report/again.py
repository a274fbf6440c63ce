"""How to check a report again: the proof as a file, what re-proves it, and what made it."""

from __future__ import annotations

from hashlib import sha256

from zwidth.show.report.contents import Contents
from zwidth.show.report.made_with import versions
from zwidth.show.report.proof import NAME
from zwidth.showing import Lines, Part, Table


def how_to_check_again(said: Contents, attached: str, *libraries: str) -> list[Part]:
    """In words and numbers.

    Parameters
    ----------
    said
        The report.
    attached
        How the document comes with it.
    libraries
        Those that had a part in this kind of file.
    """
    steps = [
        f"{attached} It is the verdict with its evidence, every number digit for digit.",
        f"zwidth verify {NAME} re-proves it, by a checker that shares no code with what found the proof.",
    ]
    if said.command:
        steps.append(f"This report again, byte for byte with the same versions: {said.command}")
    rows = [
        (f"SHA-256 of {NAME}", sha256(said.document).hexdigest()),
        (f"bytes of {NAME}", str(len(said.document))),
        *versions(*libraries),
    ]
    return [Lines(steps), Table(rows=rows)]
