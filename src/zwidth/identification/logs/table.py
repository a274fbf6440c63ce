"""What every format of file gives: named columns, the units it states, and their values piece by piece."""

from __future__ import annotations

from collections.abc import Callable, Iterator, Mapping
from contextlib import contextmanager
from dataclasses import dataclass, field
from typing import Any

from numpy.typing import NDArray

from zwidth.errors import InputError
from zwidth.identification.logs.block import Finding

PIECE = 2**18
"""Rows that are read at once, where the format lets us choose."""

Values = NDArray[Any]


@dataclass(kw_only=True)
class Table:
    """Columns of a file.

    Parameters
    ----------
    source
        Name of the file, for messages.
    units
        Every column with the unit that the file states; None if it states none.
    read
        Gives the columns named, piece by piece: the same number of rows in each.
    attributes
        What the file says of itself.
    notes
        What was odd in the file; complete after `read` came to its end.
    """

    source: str
    units: Mapping[str, str | None]
    read: Callable[[tuple[str, ...]], Iterator[tuple[Values, ...]]]
    attributes: Mapping[str, Any] = field(default_factory=dict)
    notes: dict[str, Finding] = field(default_factory=dict)


@contextmanager
def readable(source: str) -> Iterator[None]:
    """Whatever a library says of foreign bytes becomes one message."""
    try:
        yield
    except (InputError, KeyboardInterrupt, GeneratorExit):
        raise
    except MemoryError:
        raise InputError(f"{source} cannot be read: it needs more memory than there is") from None
    except Exception as error:  # what the libraries raise on foreign bytes is not documented
        reason = (str(error) or type(error).__name__).splitlines()[0][:200]
        raise InputError(f"{source} cannot be read: {reason}") from None


def listed(names: Mapping[str, Any] | list[str]) -> str:
    """Column names in a message, not more than a person reads."""
    shown = [f'"{name}"' for name in list(names)[:30]]
    more = len(names) - len(shown)
    return ", ".join(shown) + (f" and {more} more" if more > 0 else "")
