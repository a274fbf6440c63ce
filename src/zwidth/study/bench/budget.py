"""How long values are iterated: in moves looked at, not in seconds, so that it ends alike anywhere."""

from __future__ import annotations

from dataclasses import dataclass

from zwidth.errors import InputError
from zwidth.passivity.storage.program import DynamicProgram

NODES = 9
"""Places in a cell, about."""


class Spent(Exception):
    """The budget is used up: the iteration was not finished."""


@dataclass
class Budget:
    """What is told of each round of an iteration, and stops it.

    Parameters
    ----------
    rounds
        How many there may be.
    """

    rounds: float

    def __call__(self, improved: int) -> None:
        """One round more."""
        self.rounds -= 1
        if self.rounds < 0:
            raise Spent


def budget_of(program: DynamicProgram, moves: float) -> Budget:
    """For so many moves against one law."""
    width = 2 * program.domain.reach + 1
    states = program.domain.cells * width ** (program.law.memory + program.losses.delay)
    if program.law.relaxing is not None:
        states *= program.domain.cells
    rounds = moves // (states * width * NODES)
    if rounds < 1:
        raise InputError(f"the grid of {states:,} states is too large to be iterated on here")
    return Budget(rounds)
