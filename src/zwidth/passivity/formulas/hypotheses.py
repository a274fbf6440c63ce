"""The bounds under which a formula holds, checked on exact numbers."""

from __future__ import annotations

from fractions import Fraction

from zwidth.quantity.exact import Exact, RealLike
from zwidth.quantity.glossary import GLOSSARY
from zwidth.quantity.parameter import PLAIN, read_number

NEGATIVE_SPRING = "a negative spring gives out energy without end"
NO_CLOCK = "a sampled loop has a sample period"


def number(name: str, value: RealLike, bound: str = "", why: str = "", quantity: str = "") -> Fraction:
    """The exact value of a number, or of a text with the unit of the quantity, by default that of its name.

    A message names the argument, and `why` says what the bound is for.
    """
    what = GLOSSARY.get(quantity or name, PLAIN)
    read: Exact = read_number(value, what, name, bound=bound, why=why)
    return read.fraction


def nonnegative(name: str, value: RealLike, why: str, quantity: str = "") -> Fraction:
    """The same of an argument ≥ 0."""
    return number(name, value, "≥ 0", why, quantity)


def positive(name: str, value: RealLike, why: str, quantity: str = "") -> Fraction:
    """The same of an argument > 0."""
    return number(name, value, "> 0", why, quantity)
