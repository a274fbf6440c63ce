"""What a check would cost, reckoned from sizes before the work is done: too much is refused.

Costs are microseconds of an ordinary core, roughly: a product of whole numbers of p and q bits, p ≥ q, takes
some (p/1000) (q/1000)^0.8 of them, a sum or a small number a tenth.  What is spent on one document adds up.
"""

from __future__ import annotations

from collections.abc import Iterator
from contextlib import contextmanager
from contextvars import ContextVar

from .refusal import Invalid

MOST = 6_000_000.0
"""Of one document [µs]."""
MOST_ROOM = 900_000_000.0
"""At a time [bytes]."""

_spent: ContextVar[list[float] | None] = ContextVar("spent", default=None)


@contextmanager
def one_document() -> Iterator[None]:
    """Begin to count anew."""
    token = _spent.set([0.0])
    try:
        yield
    finally:
        _spent.reset(token)


def spend(steps: float, bits: float = 0, by: float | None = None) -> None:
    """Before so many products of `bits` and `by` bits, the same if not given: too many are refused."""
    cost = steps * (0.1 + bits / 1000 * ((bits if by is None else by) / 1000) ** 0.8)
    spent = _spent.get()
    if spent is not None:
        spent[0] += cost
        cost = spent[0]
    if cost > MOST:
        raise Invalid("the document is too large to be checked: too many numbers, or too many digits")


def reserve(room: float) -> None:
    """Before so many bytes are needed at a time: too many are refused."""
    if room > MOST_ROOM:
        size = f"{room / 1e9:.3g} GB"
        raise Invalid(f"the document is too large to be checked: too many numbers, {size} of them")
