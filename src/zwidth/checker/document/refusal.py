"""Why a document is refused, and what a check would cost: reckoned before the work, too much is refused.

One count for a file.  Costs are microseconds of an ordinary core, roughly and rather too many: a product of
whole numbers of p and q bits, p ≥ q, takes some (p/1000) (q/1000)^0.8 of them, a sum or a small number a
tenth.  Reading, every piece of evidence, and every box, cell and corner in it add to one count; the same
evidence again is checked once.
"""

from __future__ import annotations

from collections.abc import Iterator
from contextlib import contextmanager
from contextvars import ContextVar
from typing import Any


class Invalid(Exception):
    """The document does not prove what it claims; the message says where."""


MOST = 5_000_000.0
"""Of one file [µs]."""
EACH = 4000
"""What a piece of evidence costs at least, whatever is in it, in steps of work."""
MOST_ROOM = 320_000_000.0
"""At a time [bytes]."""
_spent: ContextVar[list[float] | None] = ContextVar("spent", default=None)


@contextmanager
def one_document() -> Iterator[None]:
    """Begin to count; what is inside another one goes on with its count."""
    if _spent.get() is not None:
        yield
        return
    token = _spent.set([0.0])
    try:
        yield
    finally:
        _spent.reset(token)


def spent() -> float:
    """What was counted so far of the file that is being read."""
    return (_spent.get() or [0.0])[0]


def spend(steps: float, bits: float = 0, by: float | None = None, each: float = 0.1) -> None:
    """Before so many products of `bits` and `by` bits, the same if not given: too many are refused.

    `each` is what one costs where its numbers are small [µs].
    """
    cost = steps * (each + bits / 1000 * ((bits if by is None else by) / 1000) ** 0.8)
    count = _spent.get()
    if count is not None:
        count[0] += cost
        cost = count[0]
    if cost > MOST:
        raise Invalid(
            f"the document is too large to be checked: more effort than {MOST / 1e6:g} s of an ordinary "
            "core for all in it; give its proofs and motions in files of their own, or with fewer digits"
        )


def reserve(room: float) -> None:
    """Before so many bytes are needed at a time: too many are refused."""
    if room > MOST_ROOM:
        size = f"{room / 1e9:.3g} GB"
        raise Invalid(f"the document is too large to be checked: too many numbers, {size} of them")


def only_if(condition: object, value: Any, name: str) -> Any:
    """An entry that stands there exactly if a condition holds; None where it does not."""
    if condition and value is None:
        raise Invalid(f"{name} is missing")
    if not condition and value is not None:
        raise Invalid(f"entries that no proof of this kind has: {name} is of no use here")
    return value
