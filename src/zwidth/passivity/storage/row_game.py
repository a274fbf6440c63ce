"""The game of the worst hand for laws in a row: which board, which table, both sets of rules."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass, replace
from fractions import Fraction
from functools import cached_property
from math import ceil
from typing import Any

from zwidth.device.device import Device
from zwidth.device.friction import FrictionCurve
from zwidth.environment.environment import Environment
from zwidth.errors import InputError
from zwidth.passivity.scope import Contact, Hands, Law
from zwidth.passivity.storage.board import Domain
from zwidth.passivity.storage.domain import counts_of, losses_of
from zwidth.passivity.storage.gain import Gain
from zwidth.passivity.storage.hand_bounds import HandBounds, hand_bounds
from zwidth.passivity.storage.losses import Losses
from zwidth.passivity.storage.row_board import NO_LAW, RowBoard
from zwidth.passivity.storage.row_gain import row_gain
from zwidth.passivity.storage.row_law import RowLaw, row_law
from zwidth.passivity.storage.row_play import play_row
from zwidth.passivity.storage.row_storage import RowStorage
from zwidth.passivity.storage.row_table import MOST_STATES, DoesNotClose, Table, tabulate
from zwidth.passivity.storage.solve import Played
from zwidth.quantity.exact import RealLike

COUNTS = ((32, 16), (16, 8), (8, 4), (4, 2))
"""Counts on either side and counts a sample that are tried by default, until the law closes."""

USUAL_STATES = 20_000
"""States within which it has to close on one of them."""


@dataclass(frozen=True, eq=False)
class RowGame:
    """Laws in a row and one domain, to be played with either set of rules; as `hand.Game`."""

    device: Device
    environment: Environment
    law: RowLaw
    losses: Losses
    domain: Domain
    board: tuple[int, int]
    most: int

    @property
    def motion(self) -> str:
        """Linear or rotary."""
        return self.device.motion

    @property
    def too_large(self) -> None:
        """Nothing: a board that is too large has no table, and no game."""
        return

    @property
    def has_cells(self) -> bool:
        """False: a table has the states of single counts."""
        return False

    @property
    def is_large(self) -> bool:
        """True where a storage function takes its time: no closed form stands in for it."""
        return False

    def checking_time(self, steps: int) -> float:
        """How long the checker may take over a storage function [s]."""
        moves = self.table.successors.size * (steps + 1) ** 2
        return 0.02 + moves / 300_000_000

    @property
    def bounds(self) -> HandBounds:
        """Bounds on the hand, exact."""
        return hand_bounds(NO_LAW, self.losses, self.domain)

    @property
    def hands(self) -> Hands:
        """The hands that a proof covers: they begin at rest outside, or at the first count."""
        far = float(self.bounds.penetration)
        return replace(self.bounds.hands(False), outside=far)

    @property
    def contact(self) -> Contact:
        """What is covered of contact."""
        return "made and broken" if self.law.unilateral else "both sides"

    @property
    def actuator(self) -> tuple[bool, bool]:
        """Whether force limit and converter steps are counted in."""
        return self.law.limited, self.law.stepped

    @property
    def inexact(self) -> tuple[Law, ...]:
        """What of the law is not exact."""
        return ("table",)

    @cached_property
    def table(self) -> Table:
        """All states of the law."""
        return tabulate(self.law, self.domain, self.most)

    def prove(
        self, steps: int, deadline: float = float("inf"), tell: Any = None, on: str = "cpu"
    ) -> RowStorage | None:
        """A storage function on so many steps per count, or None."""
        played = self._play(steps, "generous", self.domain, self.table, deadline, tell, on)
        return None if played.value is None else RowStorage(played, self.motion, self.law)

    def prove_on_cells(self, cells: int, deadline: float = float("inf"), tell: Any = None) -> None:
        """Nothing: a table has the states of every count."""

    def refute(
        self, steps: int, deadline: float = float("inf"), tell: Any = None, on: str = "cpu"
    ) -> Gain | None:
        """A motion that gains, replayed by the simulator, or None."""
        within = self.domain.within
        if within.highest < 1:  # no reading inside lies within the bounds
            return None
        same = (within.lowest, within.highest) == (self.domain.lowest, self.domain.highest)
        table = self.table if same else tabulate(self.law, within, self.most)
        played = self._play(steps, "strict", within, table, deadline, tell, on)
        return row_gain(played, self.law, self.device, self.environment) if played.cycle else None

    def _play(
        self, steps: int, rules: Any, domain: Domain, table: Table, deadline: float, tell: Any, on: str
    ) -> Played:
        if on != "cpu":
            raise InputError("laws in a row are played on the processor: leave out on")
        return play_row(RowBoard(NO_LAW, self.losses, domain, steps, rules, table=table), deadline, tell)


def row_game(
    device: Device,
    environment: Environment,
    penetration: RealLike | None = None,
    speed: RealLike | None = None,
    force_limit: bool = False,
    force_resolution: bool = False,
    friction: FrictionCurve | None = None,
    boards: Sequence[tuple[int, int]] = COUNTS,
    most: int = MOST_STATES,
) -> RowGame:
    """The game of laws in a row; arguments as for `worst_hand`.

    `boards` are tried for what is not given: counts on either side, and counts a sample.  On the last
    of them the law may have so many states as `most`.

    Raises
    ------
    DoesNotClose
        If the law does not close on any of them.
    InputError
        If it cannot be played.
    """
    losses = losses_of(device, friction)
    deepest = counts_of("penetration", penetration, losses.resolution)
    fastest = counts_of("speed", speed, losses.resolution / losses.period)
    tried = boards if not (deepest and fastest) else boards[:1]
    for far, reach in tried:
        depth = deepest or Fraction(far)
        highest = max(1, ceil(depth) - 1)
        longest = ceil(fastest) if fastest else min(reach, 2 * highest + 1)
        domain = Domain(-highest - 1, highest, longest, depth, fastest or None)
        law = row_law(
            device, environment, domain.lowest, force_limit=force_limit, force_resolution=force_resolution
        )
        last = (far, reach) == tried[-1]
        most_states = most if last else USUAL_STATES
        game = RowGame(device, environment, law, losses, domain, (far, reach), most_states)
        try:
            _ = game.table
        except DoesNotClose:
            if last:
                raise
            continue
        return game
    raise AssertionError("the last board that is tried returns or raises")
