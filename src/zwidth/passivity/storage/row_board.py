"""The board of laws in a row: the states of their table, and knots within each count.

The rules are those of `board`, generous and strict.  A state of the table is a vertex with a
count and a force; within the count the hand stands on a knot.
"""

from __future__ import annotations

from dataclasses import dataclass
from fractions import Fraction
from functools import cached_property
from math import floor

import numpy as np

from zwidth.passivity.storage.board import Board, Integers
from zwidth.passivity.storage.law import FiniteLaw
from zwidth.passivity.storage.row_table import Table

NO_LAW = FiniteLaw((), "none")
"""In place of a law that can be written down: its forces stand in the table."""


@dataclass(frozen=True, kw_only=True)
class RowBoard(Board):
    """A board whose states are those of a table.

    Parameters
    ----------
    table
        States, forces, and where each reading leads.
    """

    table: Table

    @property
    def _largest_force(self) -> Fraction:
        drag = self.losses.largest[1] / self.losses.period * (self.domain.reach + 1) * self.losses.resolution
        return Fraction(float(np.abs(self.table.forces).max())) + drag

    @property
    def rounding(self) -> int:
        """Units by which a force may be off: it is rounded down once."""
        return 1

    @cached_property
    def forces(self) -> Integers:
        """Force in units of each state."""
        several, where = np.unique(self.table.forces, return_inverse=True)
        units = np.array([floor(Fraction(float(f)) / self.force_unit) for f in several], dtype=np.int64)
        out: Integers = units[where.ravel()]
        return out

    @cached_property
    def first_guess(self) -> Integers:
        """Nothing."""
        return np.zeros((self.table.states, self.knots.size), np.int64)
