"""What a judge says of a document that the checker accepted."""

from __future__ import annotations

from typing import NamedTuple

AGREES, FALSE, OPEN = "agrees", "false", "cannot say"


class Opinion(NamedTuple):
    """`word` is one of the three above; `why` names the counterexample and its size, or what stays open."""

    word: str
    why: str = ""


def agrees() -> Opinion:
    """Nothing was found against it."""
    return Opinion(AGREES)


def false(why: str) -> Opinion:
    """The claim, or a premise of its theorem, does not hold."""
    return Opinion(FALSE, why)


def cannot_say(why: str) -> Opinion:
    """Too close, too long, or not looked at."""
    return Opinion(OPEN, why)


def first(*opinions: Opinion) -> Opinion:
    """The first that is false, else the first that is open."""
    for word in (FALSE, OPEN):
        for opinion in opinions:
            if opinion.word == word:
                return opinion
    return agrees()
